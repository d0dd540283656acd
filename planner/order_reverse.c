/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shortens the loose chains of one cord by running parts of the cord between two visits of a node
 * the other way round, or by exchanging two parts: the cord stays as long and runs through the
 * same passes.
 *
 * The search is simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983). The cost
 * of a cord is the squared excess of its chains over THR_HELD_WELL pieces, and its turning; a
 * change that crosses more channels is refused.
 *
 * Example: a cord visits node v after pass 3 and again after pass 9. Passes 4 .. 9 run backwards
 * begin and end at v as before, and thread their pieces in the opposite order. */
#include "graph/plan/physics.h"
#include "graph/arrays.h"
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A chain's pieces beyond those that a hand holds well count by their square, a turn of so many rad
 * as one piece. The annealing begins with heat_first, and ends with heat_last times as much. */
static const double turn_weight = 1, heat_first = 16, heat_last = 0.01;
static const double most_steps = 20000, most_visits = 8e6; /* of pieces: 30 ms */

enum { BEGINNINGS = 8 }; /* one step in so many begins the cord elsewhere */

typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  thr_turning_room room;
  thr_threaded *threaded;
  bool turns;       /* it may begin anywhere */
  bool feet;        /* at feet only */
  thr_cord now;     /* half: [n] owned */
  int *best, *half; /* [n] the best passes, scratch; owned */
  int *piece;       /* [n + 1] owned */
  int *chain;       /* [n + 1] scratch; owned */
  int *arm;         /* [2 n_edges] its number among those of its node; owned */
  size_t *row;      /* [n_nodes + 1] where the node's turns begin; owned */
  thr_channels
      channels;   /* of all cords: those of others count; empty = channels may cross; owned */
  int number;     /* of the cord */
  double *angle;  /* [row[n_nodes]] from arm to arm, rad; < 0 = not asked for yet; owned */
  uint64_t state; /* of the random numbers */
} cord_annealer;

/* ---- turns ---- */

enum { MOST_ANGLES = 1000000 };

static size_t count_angles(const thr_frame *frame)
{
  size_t n = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    n += (size_t)thr_degree(frame, v) * (size_t)thr_degree(frame, v);
  return n;
}

/* Allocates the angles, which are worked out when first asked for. False: out of memory. */
static bool has_angles(cord_annealer *annealer)
{
  const thr_frame *frame = annealer->frame;

  size_t n = count_angles(frame);
  annealer->arm = thr_calloc(2 * (size_t)frame->n_edges, sizeof *annealer->arm);
  annealer->row = thr_calloc((size_t)frame->n_nodes + 1, sizeof *annealer->row);
  annealer->angle = thr_calloc(n, sizeof *annealer->angle);
  if (!annealer->arm || !annealer->row || !annealer->angle) return false;

  for (size_t i = 0; i < n; i++)
    annealer->angle[i] = -1;

  /* Number the arms of every node; the angles of a node are a square of arm by arm. */
  for (int v = 0; v < frame->n_nodes; v++) {
    int degree = thr_degree(frame, v);
    annealer->row[v + 1] = annealer->row[v] + (size_t)degree * (size_t)degree;
    for (int i = 0; i < degree; i++)
      annealer->arm[frame->half[frame->first[v] + i]] = i;
  }
  return true;
}

/* Returns thr_turn_angle, which is computed once. */
static double angle_of(const cord_annealer *annealer, int in, int out)
{
  int v = thr_tail(annealer->frame, out);
  double *angle =
      &annealer->angle[annealer->row[v] +
                       (size_t)annealer->arm[in ^ 1] * (size_t)thr_degree(annealer->frame, v) +
                       (size_t)annealer->arm[out]];

  if (*angle < 0) *angle = thr_turn_angle(annealer->frame, in, out);
  return *angle;
}

/* Returns thr_cord_pulled_turning of the cord as it is. */
static double pulled_turning(const cord_annealer *annealer)
{
  const int *half = annealer->now.half;

  double whole = 0;
  for (int k = 0; k + 1 < annealer->now.n_passes; k++)
    whole += angle_of(annealer, half[k], half[k + 1]);

  thr_least_pull_walk walk = thr_least_pull_begin(whole);
  for (int k = 0; k + 1 < annealer->now.n_passes; k++)
    if (!thr_least_pull_next(&walk, angle_of(annealer, half[k], half[k + 1]))) break;
  return walk.larger;
}

/* The cost of a cord, in parts. */
typedef struct {
  double excess;  /* of pieces beyond THR_HELD_WELL in chains, squared */
  int longest;    /* >= THR_HELD_WELL */
  double turning; /* rad */
  double over;    /* by how much it is pulled through more than there is room for, rad */
} cord_cost;

/* Returns the cost of the cord as it is; turning is its turning, rad. */
static cord_cost measure(cord_annealer *annealer, double turning)
{
  cord_cost cost = {.longest = THR_HELD_WELL, .turning = turning};

  int n = thr_cord_pieces(annealer->frame, annealer->request->joint, &annealer->now,
                          annealer->piece),
      fold = thr_cord_fold(annealer->frame, annealer->request->needles, &annealer->now);
  int chains = thr_threaded_try(annealer->threaded, annealer->piece, n, fold, annealer->chain);

  /* Only the pieces beyond those that a hand holds well count, by the square of each chain's
   * excess. */
  for (int i = 0; i < chains; i++) {
    int beyond = annealer->chain[i] - THR_HELD_WELL;
    if (beyond <= 0) continue;
    cost.excess += (double)beyond * beyond;
    if (annealer->chain[i] > cost.longest) cost.longest = annealer->chain[i];
  }

  cost.over = fmax(0, pulled_turning(annealer) - annealer->room.pulled);
  return cost;
}

static bool is_better(const cord_cost *a, const cord_cost *b)
{
  return a->longest != b->longest ? a->longest < b->longest : a->turning < b->turning * (1 - 1e-9);
}

static double weigh(const cord_cost *cost)
{
  return cost->excess + turn_weight * (cost->turning + cost->over);
}

/* ---- changes ---- */

typedef enum { BEGIN, REVERSE, EXCHANGE } kind;

/* Of passes at[0] .. at[n] - 1. BEGIN: the cord begins with pass at[0]. REVERSE: they are run the
 * other way round. EXCHANGE: they are three parts, between visits of nodes v, w, v, w, of which the
 * first and the last change places. */
typedef struct {
  kind kind;
  int at[4];
  double turning; /* more, rad */
} cord_change;

/* Returns the turn from half-edge in to out, 0 at an end; INFINITY if a cord would turn back into
 * its edge. */
static double turn(const cord_annealer *annealer, int in, int out)
{
  if (in < 0 || out < 0) return 0;
  return out == (in ^ 1) ? INFINITY : angle_of(annealer, in, out);
}

/* Returns the half-edge of the pass before visit k, or of the one after it (out_of); -1 where the
 * cord ends. */
static int into(const cord_annealer *annealer, int k)
{
  return k > 0             ? annealer->now.half[k - 1]
         : annealer->turns ? annealer->now.half[annealer->now.n_passes - 1]
                           : -1;
}

static int out_of(const cord_annealer *annealer, int k)
{
  return k < annealer->now.n_passes ? annealer->now.half[k]
         : annealer->turns          ? annealer->now.half[0]
                                    : -1;
}

static double turn_at(const cord_annealer *annealer, int k)
{
  return angle_of(annealer, into(annealer, k), out_of(annealer, k));
}

/* Returns how much more the cord turns, rad, once the part at[0] .. at[1] - 1 is run backwards. */
static double turning_of_reverse(const cord_annealer *annealer, const int at[4])
{
  if (at[0] == 0 && at[1] == annealer->now.n_passes) return 0;

  /* Two turns are replaced by two others: of the passes before and after the part. */
  double now = turn(annealer, into(annealer, at[0]), out_of(annealer, at[0])) +
               turn(annealer, into(annealer, at[1]), out_of(annealer, at[1]));

  return turn(annealer, into(annealer, at[0]), into(annealer, at[1]) ^ 1) +
         turn(annealer, out_of(annealer, at[0]) ^ 1, out_of(annealer, at[1])) - now;
}

/* Returns how much more the cord turns, rad, once the first and the last of three parts change
 * places. */
static double turning_of_exchange(const cord_annealer *annealer, const int at[4])
{
  /* Four turns go, and four come. */
  double now = turn(annealer, into(annealer, at[0]), out_of(annealer, at[0])) +
               turn_at(annealer, at[1]) + turn_at(annealer, at[2]) +
               turn(annealer, into(annealer, at[3]), out_of(annealer, at[3]));

  return turn(annealer, into(annealer, at[0]), out_of(annealer, at[2])) +
         turn(annealer, into(annealer, at[3]), out_of(annealer, at[1])) +
         turn(annealer, into(annealer, at[2]), out_of(annealer, at[0])) +
         turn(annealer, into(annealer, at[1]), out_of(annealer, at[3])) - now;
}

static int *append(int *to, const int *half, int from, int end)
{
  memcpy(to, half + from, (size_t)(end - from) * sizeof *to);
  return to + (end - from);
}

/* Makes a change in annealer->now; half is scratch. */
static void make(cord_annealer *annealer, const cord_change *change)
{
  int *half = annealer->now.half, *to = annealer->half;
  const int *at = change->at;

  if (change->kind == REVERSE) {
    thr_passes_reverse(half, at[0], at[1] - 1);
  } else if (change->kind == BEGIN) {
    thr_starts_turn(&annealer->now, at[0], false, annealer->half);
    memcpy(half, annealer->half, (size_t)annealer->now.n_passes * sizeof *half);
  } else {
    append(append(append(to, half, at[2], at[3]), half, at[1], at[2]), half, at[0], at[1]);
    memcpy(half + at[0], annealer->half, (size_t)(at[3] - at[0]) * sizeof *half);
  }
}

/* Undoes a change that was just made: a part reversed twice is as before, and the parts of an
 * exchange have new places. */
static void take_back(cord_annealer *annealer, const cord_change *change)
{
  cord_change back = *change;
  if (change->kind == BEGIN)
    back.at[0] = (annealer->now.n_passes - change->at[0]) % annealer->now.n_passes;

  if (change->kind == EXCHANGE) {
    back.at[1] = change->at[0] + change->at[3] - change->at[2];
    back.at[2] = change->at[0] + change->at[3] - change->at[1];
  }

  make(annealer, &back);
}

/* ---- at random ---- */

/* Returns another visit of the piece of visit k among from .. end - 1, searched from a random one
 * on; -1: there is none. */
static int other_visit(cord_annealer *annealer, int k, int from, int end)
{
  int n = end - from, first = n > 0 ? thr_random_below(&annealer->state, n) : 0;

  for (int i = 0; i < n; i++) {
    int other = from + (first + i < n ? first + i : first + i - n);
    if (other != k && annealer->piece[other] == annealer->piece[k]) return other;
  }
  return -1;
}

/* Returns a pass that the cord may begin with, searched from a random one on. */
static int choose_start(cord_annealer *annealer)
{
  int n = annealer->now.n_passes, s = thr_random_below(&annealer->state, n);
  for (int tried = 0; annealer->feet && tried < n && !annealer->frame->foot[annealer->piece[s]];
       tried++)
    s = (s + 1) % n;
  return s;
}

/* Chooses a change at random. False: there is none where it was looked for. */
static bool choose(cord_annealer *annealer, cord_change *change)
{
  int n = annealer->now.n_passes;

  *change = (cord_change){.kind = REVERSE};

  /* Now and then begin the cord elsewhere. */
  if (annealer->turns && thr_random_below(&annealer->state, BEGINNINGS) == 0) {
    *change = (cord_change){BEGIN, {choose_start(annealer)}, 0};
    return true;
  }

  /* Choose a visit and another one of the same piece; the part lies between the two. */
  int one = thr_random_below(&annealer->state, n + 1), other = other_visit(annealer, one, 0, n + 1);
  if (other < 0) return false;
  change->at[0] = one < other ? one : other;
  change->at[1] = one < other ? other : one;

  /* Half of the parts that are long enough are exchanged with a part that follows: two visits of
   * another piece must alternate with the first two. */
  if (change->at[1] - change->at[0] > 1 && thr_random_below(&annealer->state, 2)) {
    change->kind = EXCHANGE;
    change->at[2] = change->at[1];
    change->at[1] =
        change->at[0] + 1 + thr_random_below(&annealer->state, change->at[2] - change->at[0] - 1);
    change->at[3] = other_visit(annealer, change->at[1], change->at[2] + 1, n + 1);
    if (change->at[3] < 0) return false;
  }

  change->turning = change->kind == REVERSE ? turning_of_reverse(annealer, change->at)
                                            : turning_of_exchange(annealer, change->at);
  return true;
}

/* ---- crossings ---- */

/* Returns the channel of visit k of the cord as it is; at the cord's ends one of the arms is
 * missing. */
static thr_channel channel_at(const cord_annealer *annealer, int k)
{
  int in = into(annealer, k);
  return (thr_channel){.in = in < 0 ? in : in ^ 1, .out = out_of(annealer, k)};
}

/* Visits of a cord that begins anywhere: the last is the first. */
static int count_visits(const cord_annealer *annealer)
{
  return annealer->now.n_passes + !annealer->turns;
}

/* Counts the pairs of channels of node v that cross, one of them or both of the cord; piece is up
 * to date. O(passes + channels^2). */
static int crossings_in(const cord_annealer *annealer, int v)
{
  int n = 0;
  for (int k = 0; k < count_visits(annealer); k++) {
    if (annealer->piece[k] != v) continue;
    thr_channel one = channel_at(annealer, k);
    if (one.in < 0 || one.out < 0) continue;

    /* Count the pairs of channels within the cord. */
    for (int i = k + 1; i < count_visits(annealer); i++) {
      thr_channel other = channel_at(annealer, i);
      n += annealer->piece[i] == v && other.in >= 0 && other.out >= 0 &&
           thr_channels_cross(annealer->channels.rank, &one, &other);
    }

    /* Count the pairs of a channel of the cord and one of another cord. */
    for (int i = annealer->channels.first[v]; i < annealer->channels.first[v + 1]; i++) {
      const thr_channel *other = &annealer->channels.channel[i];
      n += other->cord != annealer->number && other->in >= 0 && other->out >= 0 &&
           thr_channels_cross(annealer->channels.rank, &one, other);
    }
  }
  return n;
}

/* Counts the crossings in the nodes v and w, whose channels a change changes; 0 for a cord that
 * only begins elsewhere. */
static int crossings_of(const cord_annealer *annealer, const cord_change *change, int v, int w)
{
  if (!annealer->channels.rank || change->kind == BEGIN) return 0;
  return crossings_in(annealer, v) + (w == v ? 0 : crossings_in(annealer, w));
}

static bool has_channels(cord_annealer *annealer, const thr_plan *plan)
{
  return plan->options.crossings == THR_CROSSINGS_ALLOW ||
         thr_channels_make(&annealer->channels, plan, NULL) == THR_OK;
}

/* ---- annealing ---- */

/* Makes one change at random of the cord, whose cost is *now; takes it back if it is not
 * accepted. */
static void step(cord_annealer *annealer, double heat, cord_cost *now)
{
  cord_change change;
  if (!choose(annealer, &change) ||
      now->turning + change.turning > annealer->room.turning * (1 + 1e-12))
    return;

  int v = annealer->piece[change.at[0]], w = annealer->piece[change.at[1]],
      crossings = crossings_of(annealer, &change, v, w);

  make(annealer, &change);
  cord_cost then = measure(annealer, now->turning + change.turning);
  double worse =
      crossings_of(annealer, &change, v, w) > crossings ? HUGE_VAL : weigh(&then) - weigh(now);

  /* Metropolis: accept what is better, and what is worse with a probability that falls with the
   * heat. */
  if (worse <= 0 || thr_random_unit(&annealer->state) < exp(-worse / heat)) {
    *now = then;
    return;
  }

  take_back(annealer, &change);
  thr_cord_pieces(annealer->frame, annealer->request->joint, &annealer->now, annealer->piece);
}

/* Anneals the cord, with heat that falls geometrically, and leaves the best passes in
 * annealer->best. */
static void anneal(cord_annealer *annealer)
{
  int n = annealer->now.n_passes;
  long steps = (long)fmin(most_steps, most_visits / n);
  cord_cost now = measure(annealer,
                          thr_cord_turning(annealer->frame, &annealer->now, annealer->turns)),
            best = now;

  memcpy(annealer->best, annealer->now.half, (size_t)n * sizeof *annealer->best);

  for (long i = 0; i < steps; i++) {
    step(annealer, heat_first * pow(heat_last, (double)i / (double)steps), &now);

    /* Only cords that keep to their room count: exactly as much turning where a proof counts on it,
     * and no more pull. */
    if (annealer->room.exactly &&
        fabs(now.turning - annealer->room.turning) > 1e-10 * annealer->room.turning)
      continue;
    if (!is_better(&now, &best) || now.over > 1e-12 * annealer->room.pulled) continue;

    best = now;
    memcpy(annealer->best, annealer->now.half, (size_t)n * sizeof *annealer->best);
  }
}

thr_status thr_order_reverse(const thr_plan *plan, int c, thr_turning_room room,
                             thr_threaded *threaded, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *request = &plan->options;
  thr_cord *cord = &plan->cord[c];
  size_t n = (size_t)cord->n_passes;

  cord_annealer annealer = {.frame = frame,
                            .request = request,
                            .room = room,
                            .threaded = threaded,
                            .now = *cord,
                            .number = c};
  if (count_angles(frame) > MOST_ANGLES) return THR_OK;

  annealer.turns = thr_order_turns(request, cord);
  annealer.now.half = thr_calloc(n, sizeof *annealer.now.half);
  annealer.best = thr_calloc(n, sizeof *annealer.best);
  annealer.half = thr_calloc(n, sizeof *annealer.half);
  annealer.piece = thr_calloc(n + 1, sizeof *annealer.piece);
  annealer.chain = thr_calloc(n + 1, sizeof *annealer.chain);
  bool all =
      has_angles(&annealer) && has_channels(&annealer, plan) &&
      (annealer.now.half && annealer.best && annealer.half && annealer.piece && annealer.chain);

  /* A cord that comes by a foot begins at a foot. */
  for (size_t k = 0; k < n && all; k++)
    annealer.feet |= frame->foot[thr_tail(frame, cord->half[k])];

  if (all) {
    memcpy(annealer.now.half, cord->half, n * sizeof *cord->half);
    anneal(&annealer);
    memcpy(cord->half, annealer.best, n * sizeof *cord->half);
  }

  free(annealer.now.half);
  free(annealer.best);
  free(annealer.half);
  free(annealer.piece);
  free(annealer.chain);
  free(annealer.arm);
  free(annealer.row);
  free(annealer.angle);
  thr_channels_destroy(&annealer.channels);
  return all ? THR_OK : thr_nomem(err);
}
