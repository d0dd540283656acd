/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of a cord between two visits of a node, run the other way round: as long, through the same
 * passes, and with less loose chains. */
#include "graph/plan/physics.h"
#include "graph/random.h"
#include "planner/planner_parts.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A chain's pieces beyond those that a hand holds well count by their square, a turn of so many rad
 * as one piece; heat at the beginning, and at the end of that. */
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
} annealer;

/* ---- turns ---- */

enum { MOST_ANGLES = 1000000 };

static size_t count_angles(const thr_frame *frame)
{
  size_t n = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    n += (size_t)thr_degree(frame, v) * (size_t)thr_degree(frame, v);
  return n;
}

static bool has_angles(annealer *x)
{
  const thr_frame *frame = x->frame;
  size_t n = count_angles(frame);
  x->arm = thr_calloc(2 * (size_t)frame->n_edges, sizeof *x->arm);
  x->row = thr_calloc((size_t)frame->n_nodes + 1, sizeof *x->row);
  x->angle = thr_calloc(n, sizeof *x->angle);
  if (!x->arm || !x->row || !x->angle) return false;
  for (size_t i = 0; i < n; i++)
    x->angle[i] = -1;
  for (int v = 0; v < frame->n_nodes; v++) {
    int degree = thr_degree(frame, v);
    x->row[v + 1] = x->row[v] + (size_t)degree * (size_t)degree;
    for (int i = 0; i < degree; i++)
      x->arm[frame->half[frame->first[v] + i]] = i;
  }
  return true;
}

/* thr_turn_angle, worked out once. */
static double angle_of(const annealer *x, int in, int out)
{
  int v = thr_tail(x->frame, out);
  double *angle = &x->angle[x->row[v] + (size_t)x->arm[in ^ 1] * (size_t)thr_degree(x->frame, v) +
                            (size_t)x->arm[out]];
  if (*angle < 0) *angle = thr_turn_angle(x->frame, in, out);
  return *angle;
}

/* thr_cord_pulled_turning of the cord as it is. */
static double pulled_turning(const annealer *x)
{
  const int *half = x->now.half;
  double whole = 0;
  for (int k = 0; k + 1 < x->now.n_passes; k++)
    whole += angle_of(x, half[k], half[k + 1]);
  thr_least_pull_walk walk = thr_least_pull_begin(whole);
  for (int k = 0; k + 1 < x->now.n_passes; k++)
    if (!thr_least_pull_next(&walk, angle_of(x, half[k], half[k + 1]))) break;
  return walk.larger;
}

/* What a cord is worth. */
typedef struct {
  double excess;  /* of pieces beyond THR_HELD_WELL in chains, squared */
  int longest;    /* >= THR_HELD_WELL */
  double turning; /* rad */
  double over;    /* by how much it is pulled through more than there is room for, rad */
} worth;

static worth measure(annealer *x, double turning)
{
  worth w = {.longest = THR_HELD_WELL, .turning = turning};
  int n = thr_cord_pieces(x->frame, x->request->joint, &x->now, x->piece),
      fold = thr_cord_fold(x->frame, x->request->needles, &x->now);
  int chains = thr_threaded_try(x->threaded, x->piece, n, fold, x->chain);
  for (int i = 0; i < chains; i++) {
    int beyond = x->chain[i] - THR_HELD_WELL;
    if (beyond <= 0) continue;
    w.excess += (double)beyond * beyond;
    if (x->chain[i] > w.longest) w.longest = x->chain[i];
  }
  w.over = fmax(0, pulled_turning(x) - x->room.pulled);
  return w;
}

static bool is_better(const worth *a, const worth *b)
{
  return a->longest != b->longest ? a->longest < b->longest : a->turning < b->turning * (1 - 1e-9);
}

static double weigh(const worth *w)
{
  return w->excess + turn_weight * (w->turning + w->over);
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
} change;

/* The turn from half-edge in to out, if there is one; INFINITY if a cord would turn back into its
 * edge. */
static double turn(const annealer *x, int in, int out)
{
  if (in < 0 || out < 0) return 0;
  return out == (in ^ 1) ? INFINITY : angle_of(x, in, out);
}

/* Half-edge of the pass before visit k, of the one after it; -1 where the cord ends. */
static int into(const annealer *x, int k)
{
  return k > 0 ? x->now.half[k - 1] : x->turns ? x->now.half[x->now.n_passes - 1] : -1;
}

static int out_of(const annealer *x, int k)
{
  return k < x->now.n_passes ? x->now.half[k] : x->turns ? x->now.half[0] : -1;
}

static double turn_at(const annealer *x, int k)
{
  return angle_of(x, into(x, k), out_of(x, k));
}

static double turning_of_reverse(const annealer *x, const int at[4])
{
  if (at[0] == 0 && at[1] == x->now.n_passes) return 0;
  double now =
      turn(x, into(x, at[0]), out_of(x, at[0])) + turn(x, into(x, at[1]), out_of(x, at[1]));
  return turn(x, into(x, at[0]), into(x, at[1]) ^ 1) +
         turn(x, out_of(x, at[0]) ^ 1, out_of(x, at[1])) - now;
}

static double turning_of_exchange(const annealer *x, const int at[4])
{
  double now = turn(x, into(x, at[0]), out_of(x, at[0])) + turn_at(x, at[1]) + turn_at(x, at[2]) +
               turn(x, into(x, at[3]), out_of(x, at[3]));
  return turn(x, into(x, at[0]), out_of(x, at[2])) + turn(x, into(x, at[3]), out_of(x, at[1])) +
         turn(x, into(x, at[2]), out_of(x, at[0])) + turn(x, into(x, at[1]), out_of(x, at[3])) -
         now;
}

static void reverse(int *half, int from, int end)
{
  for (int last = end - 1; from <= last; from++, last--) {
    int one = half[from] ^ 1;
    half[from] = half[last] ^ 1;
    half[last] = one;
  }
}

static int *append(int *to, const int *half, int from, int end)
{
  memcpy(to, half + from, (size_t)(end - from) * sizeof *to);
  return to + (end - from);
}

static void make(annealer *x, const change *c)
{
  int *half = x->now.half, *to = x->half;
  const int *at = c->at;
  if (c->kind == REVERSE) {
    reverse(half, at[0], at[1]);
  } else if (c->kind == BEGIN) {
    thr_starts_turn(&x->now, at[0], false, x->half);
    memcpy(half, x->half, (size_t)x->now.n_passes * sizeof *half);
  } else {
    append(append(append(to, half, at[2], at[3]), half, at[1], at[2]), half, at[0], at[1]);
    memcpy(half + at[0], x->half, (size_t)(at[3] - at[0]) * sizeof *half);
  }
}

static void take_back(annealer *x, const change *c)
{
  change back = *c;
  if (c->kind == BEGIN) back.at[0] = (x->now.n_passes - c->at[0]) % x->now.n_passes;
  if (c->kind == EXCHANGE) {
    back.at[1] = c->at[0] + c->at[3] - c->at[2];
    back.at[2] = c->at[0] + c->at[3] - c->at[1];
  }
  make(x, &back);
}

/* ---- at random ---- */

/* Another visit of the piece of visit k, of those from .. end - 1, from a random one on; -1: there
 * is none. */
static int other_visit(annealer *x, int k, int from, int end)
{
  int n = end - from, first = n > 0 ? thr_random_below(&x->state, n) : 0;
  for (int i = 0; i < n; i++) {
    int other = from + (first + i < n ? first + i : first + i - n);
    if (other != k && x->piece[other] == x->piece[k]) return other;
  }
  return -1;
}

/* A pass that the cord may begin with, from a random one on. */
static int choose_start(annealer *x)
{
  int n = x->now.n_passes, s = thr_random_below(&x->state, n);
  for (int tried = 0; x->feet && tried < n && !x->frame->foot[x->piece[s]]; tried++)
    s = (s + 1) % n;
  return s;
}

/* False: there is no such change where it was looked for. */
static bool choose(annealer *x, change *c)
{
  int n = x->now.n_passes;
  *c = (change){.kind = REVERSE};
  if (x->turns && thr_random_below(&x->state, BEGINNINGS) == 0) {
    *c = (change){BEGIN, {choose_start(x)}, 0};
    return true;
  }
  int one = thr_random_below(&x->state, n + 1), other = other_visit(x, one, 0, n + 1);
  if (other < 0) return false;
  c->at[0] = one < other ? one : other;
  c->at[1] = one < other ? other : one;
  if (c->at[1] - c->at[0] > 1 && thr_random_below(&x->state, 2)) {
    c->kind = EXCHANGE;
    c->at[2] = c->at[1];
    c->at[1] = c->at[0] + 1 + thr_random_below(&x->state, c->at[2] - c->at[0] - 1);
    c->at[3] = other_visit(x, c->at[1], c->at[2] + 1, n + 1);
    if (c->at[3] < 0) return false;
  }
  c->turning = c->kind == REVERSE ? turning_of_reverse(x, c->at) : turning_of_exchange(x, c->at);
  return true;
}

/* ---- crossings ---- */

/* The channel of visit k of the cord as it is; without two arms at its ends. */
static thr_channel channel_at(const annealer *x, int k)
{
  int in = into(x, k);
  return (thr_channel){.in = in < 0 ? in : in ^ 1, .out = out_of(x, k)};
}

/* Visits of a cord that begins anywhere: the last is the first. */
static int count_visits(const annealer *x)
{
  return x->now.n_passes + !x->turns;
}

/* Pairs of channels of node v that cross, one of them or both of the cord; piece is up to date.
 * O(passes + channels^2). */
static int crossings_in(const annealer *x, int v)
{
  int n = 0;
  for (int k = 0; k < count_visits(x); k++) {
    if (x->piece[k] != v) continue;
    thr_channel one = channel_at(x, k);
    if (one.in < 0 || one.out < 0) continue;
    for (int i = k + 1; i < count_visits(x); i++) {
      thr_channel other = channel_at(x, i);
      n += x->piece[i] == v && other.in >= 0 && other.out >= 0 &&
           thr_channels_cross(x->channels.rank, &one, &other);
    }
    for (int i = x->channels.first[v]; i < x->channels.first[v + 1]; i++) {
      const thr_channel *other = &x->channels.channel[i];
      n += other->cord != x->number && other->in >= 0 && other->out >= 0 &&
           thr_channels_cross(x->channels.rank, &one, other);
    }
  }
  return n;
}

/* Those in the nodes v and w whose channels a change changes; none for a cord that is only begun
 * elsewhere. */
static int crossings_of(const annealer *x, const change *c, int v, int w)
{
  if (!x->channels.rank || c->kind == BEGIN) return 0;
  return crossings_in(x, v) + (w == v ? 0 : crossings_in(x, w));
}

static bool has_channels(annealer *x, const thr_plan *plan)
{
  return plan->options.crossings == THR_CROSSINGS_ALLOW ||
         thr_channels_make(&x->channels, plan, NULL) == THR_OK;
}

/* ---- annealing ---- */

/* One change at random of the cord that is worth *now; taken back if it is not accepted. */
static void step(annealer *x, double heat, worth *now)
{
  change c;
  if (!choose(x, &c) || now->turning + c.turning > x->room.turning * (1 + 1e-12)) return;
  int v = x->piece[c.at[0]], w = x->piece[c.at[1]], crossings = crossings_of(x, &c, v, w);
  make(x, &c);
  worth then = measure(x, now->turning + c.turning);
  double worse = crossings_of(x, &c, v, w) > crossings ? HUGE_VAL : weigh(&then) - weigh(now);
  if (worse <= 0 || thr_random_unit(&x->state) < exp(-worse / heat)) {
    *now = then;
    return;
  }
  take_back(x, &c);
  thr_cord_pieces(x->frame, x->request->joint, &x->now, x->piece);
}

static void anneal(annealer *x)
{
  int n = x->now.n_passes;
  long steps = (long)fmin(most_steps, most_visits / n);
  worth now = measure(x, thr_cord_turning(x->frame, &x->now, x->turns)), best = now;
  memcpy(x->best, x->now.half, (size_t)n * sizeof *x->best);
  for (long i = 0; i < steps; i++) {
    step(x, heat_first * pow(heat_last, (double)i / (double)steps), &now);
    if (x->room.exactly && fabs(now.turning - x->room.turning) > 1e-10 * x->room.turning) continue;
    if (!is_better(&now, &best) || now.over > 1e-12 * x->room.pulled) continue;
    best = now;
    memcpy(x->best, x->now.half, (size_t)n * sizeof *x->best);
  }
}

thr_status thr_order_reverse(const thr_plan *plan, int c, thr_turning_room room,
                             thr_threaded *threaded, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *request = &plan->options;
  thr_cord *cord = &plan->cord[c];
  size_t n = (size_t)cord->n_passes;
  annealer x = {.frame = frame,
                .request = request,
                .room = room,
                .threaded = threaded,
                .now = *cord,
                .number = c};
  if (count_angles(frame) > MOST_ANGLES) return THR_OK;
  x.turns = thr_order_turns(request, cord);
  x.now.half = thr_calloc(n, sizeof *x.now.half);
  x.best = thr_calloc(n, sizeof *x.best);
  x.half = thr_calloc(n, sizeof *x.half);
  x.piece = thr_calloc(n + 1, sizeof *x.piece);
  x.chain = thr_calloc(n + 1, sizeof *x.chain);
  bool all = has_angles(&x) && has_channels(&x, plan) &&
             (x.now.half && x.best && x.half && x.piece && x.chain);
  for (size_t k = 0; k < n && all; k++)
    x.feet |= frame->foot[thr_tail(frame, cord->half[k])];
  if (all) {
    memcpy(x.now.half, cord->half, n * sizeof *cord->half);
    anneal(&x);
    memcpy(cord->half, x.best, n * sizeof *cord->half);
  }
  free(x.now.half);
  free(x.best);
  free(x.half);
  free(x.piece);
  free(x.chain);
  free(x.arm);
  free(x.row);
  free(x.angle);
  thr_channels_destroy(&x.channels);
  return all ? THR_OK : thr_nomem(err);
}
