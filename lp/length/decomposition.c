/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shares out the passes of a component among several cords (docs/method.md).
 *
 * Open cords: one walk is cut where cords may end, which costs nothing. Closed cords: a walk that
 * visits a node twice is split there into two; where no node is visited twice, further passes make
 * more circuits (decomposition_circuits.c, decomposition_chord.c, decomposition_tied.c).
 *
 * Example: a figure of eight, two closed cords: it is cut at its middle. */
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "lp/length/postman_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

thr_status thr_decomposition_init(thr_decomposition *decomposition, const thr_frame *frame,
                                  const thr_request *options, const thr_limits *limits,
                                  thr_err *err)
{
  *decomposition = (thr_decomposition){
      .f = frame, .o = options, .limits = limits, .least = true, .certain = true};
  decomposition->passes = thr_calloc((size_t)frame->n_edges, sizeof *decomposition->passes);
  return decomposition->passes ? THR_OK : thr_nomem(err);
}

void thr_decomposition_destroy(thr_decomposition *decomposition)
{
  thr_walks_destroy(&decomposition->walks);
  free(decomposition->passes);
}

/* ---- cutting ---- */

/* A place where a walk can be cut: before its pass number at. */
typedef struct {
  double turn; /* that the cut leaves out, rad */
  int walk, at, node;
} cut_place;

/* The places of all walks. */
typedef struct {
  thr_decomposition *decomposition;
  thr_walks *walks; /* its walks */
  int *left;        /* [n_nodes] THR_ENDS_COUNTS: cuts that are still to be made there; else NULL */
  cut_place *list;
  int n, capacity;
} cut_places;

/* Returns whether a walk may still be cut at node v. */
static bool may_cut(const cut_places *places, int v)
{
  return places->left ? places->left[v] > 0
                      : thr_plan_end_allowed(places->decomposition->f, places->decomposition->o, v);
}

/* Computes how many cuts each node still needs where ends are counted. Every cut adds two ends;
 * some ends are there already, at the open walks' ends. */
static thr_status count_cuts(cut_places *places, int *cuts, thr_err *err)
{
  const thr_frame *frame = places->decomposition->f;
  *cuts = 0;
  if (!(places->left = thr_calloc((size_t)frame->n_nodes, sizeof *places->left)))
    return thr_nomem(err);

  /* All ends that are asked for, */
  for (int v = 0; v < frame->n_nodes; v++)
    places->left[v] = places->decomposition->o->end_count[v];

  /* less those that the open walks have, */
  for (int i = 0; i < places->walks->n_walks; i++) {
    const thr_walk *walk = &places->walks->walk[i];
    if (walk->cyclic) continue;
    places->left[thr_tail(frame, walk->half[0])]--;
    places->left[thr_head(frame, walk->half[walk->n - 1])]--;
  }

  /* in pairs, as a cut makes two ends at one node. */
  for (int v = 0; v < frame->n_nodes; v++) {
    if (places->left[v] < 0 || places->left[v] % 2)
      return thr_fail(err, THR_ESOLVER,
                      "the passes do not leave as many ends at node %s as asked for",
                      frame->name[v]);
    places->left[v] /= 2;
    *cuts += places->left[v];
  }
  return THR_OK;
}

/* Lists all places where walks may be cut. */
static thr_status find_places(cut_places *places, thr_err *err)
{
  const thr_frame *frame = places->decomposition->f;
  places->n = 0;
  for (int i = 0; i < places->walks->n_walks; i++) {
    const thr_walk *walk = &places->walks->walk[i];
    for (int at = walk->cyclic ? 0 : 1; at < walk->n; at++) {
      int v = thr_tail(frame, walk->half[at]);
      if (!may_cut(places, v)) continue;

      thr_status st =
          thr_grow(&places->list, places->n, &places->capacity, sizeof *places->list, err);
      if (st) return st;
      places->list[places->n++] =
          (cut_place){thr_walk_turn(frame, thr_walk_before(walk, at), walk->half[at]), i, at, v};
    }
  }
  return THR_OK;
}

/* Orders places by falling turn; those that turn alike by walk and place, whatever the rounding. */
static int by_turn(const void *a, const void *b)
{
  const cut_place *one = a, *other = b;
  if (fabs(one->turn - other->turn) > 1e-9)
    return one->turn > other->turn ? -1 : 1; /* equal ones in order, whatever the rounding */
  if (one->walk != other->walk) return one->walk < other->walk ? -1 : 1;
  return (one->at > other->at) - (one->at < other->at);
}

/* Orders places by walk, the last place of a walk first: a cut leaves what is before it in its
 * walk. */
static int by_place(const void *a, const void *b)
{
  const cut_place *one = a, *other = b;
  if (one->walk != other->walk) return one->walk < other->walk ? -1 : 1;
  return (one->at < other->at) - (one->at > other->at);
}

/* Cuts at all places of the list. */
static thr_status cut_all(cut_places *places, thr_err *err)
{
  thr_status st = THR_OK;
  if (places->n) qsort(places->list, (size_t)places->n, sizeof *places->list, by_place);
  for (int i = 0, end; i < places->n && !st; i = end) {
    thr_walk *walk = &places->walks->walk[places->list[i].walk];

    /* All places of one walk. */
    for (end = i; end < places->n && places->list[end].walk == places->list[i].walk;)
      end++;

    int last = end, shift = 0;

    if (walk->cyclic) { /* the first cut_place opens it */
      shift = places->list[--last].at;
      walk->cyclic = false;
      st = thr_walk_rotate(walk, shift, err);
    }

    /* Cut from the last place on, so that the earlier ones keep their numbers. */
    for (int j = i; j < last && !st; j++)
      st = thr_splice_cut(places->walks, places->decomposition->f, places->list[j].walk,
                          places->list[j].at - shift, err);
  }
  return st;
}

/* Says that there are too few places for the ends of so many cords. */
static thr_status too_few(const cut_places *places, int wanted, thr_err *err)
{
  const thr_frame *frame = places->decomposition->f;
  return thr_fail(err, THR_EINFEASIBLE,
                  "the component with node %s has too few places for the ends of %d cords",
                  frame->name[thr_tail(frame, places->walks->walk[0].half[0])], wanted);
}

/* Makes so many cuts, where the walks turn most. wanted: the number of cords, for the message. */
static thr_status cut_sharpest(cut_places *places, int cuts, int wanted, thr_err *err)
{
  int taken = 0;
  thr_status st = find_places(places, err);
  if (st) return st;

  if (places->n) qsort(places->list, (size_t)places->n, sizeof *places->list, by_turn);

  /* A node with counted ends is only cut as often as it has ends to give. */
  for (int i = 0; i < places->n && taken < cuts; i++) {
    if (!may_cut(places, places->list[i].node)) continue;
    if (places->left) places->left[places->list[i].node]--;
    places->list[taken++] = places->list[i];
  }

  if (taken < cuts) return too_few(places, wanted, err);
  places->n = taken;
  return cut_all(places, err);
}

/* Returns where an open walk is cut into the most equal parts; 0 = nowhere. A cyclic one: where it
 * may be opened; -1 = nowhere. */
static int middle(const cut_places *places, const thr_walk *walk)
{
  double sum = 0, best = INFINITY;
  int at = walk->cyclic ? -1 : 0;
  for (int i = 0; i < walk->n; i++) {
    if ((walk->cyclic || i) && may_cut(places, thr_tail(places->decomposition->f, walk->half[i]))) {
      double off = walk->cyclic ? 0 : fabs(sum - walk->length / 2);
      if (off < best) {
        best = off;
        at = i;
      }
    }
    sum += places->decomposition->f->length[walk->half[i] >> 1];
  }
  return at;
}

/* Cuts the longest walk that can be cut in its middle; again and again. */
static thr_status cut_longest(cut_places *places, int cuts, int wanted, thr_err *err)
{
  thr_status st = THR_OK;
  for (int done = 0; done < cuts && !st; done++) {
    int best = -1, best_at = 0;
    for (int i = 0; i < places->walks->n_walks; i++) {
      thr_walk *walk = &places->walks->walk[i];
      if (best >= 0 && walk->length <= places->walks->walk[best].length * (1 + 1e-12)) continue;

      /* Only a walk that has a place for a cut counts. */
      int at = middle(places, walk);
      if (at < (walk->cyclic ? 0 : 1)) continue;
      best = i;
      best_at = at;
    }

    if (best < 0) return too_few(places, wanted, err);
    thr_walk *walk = &places->walks->walk[best];

    /* The first cut of a cyclic walk opens it. */
    if (walk->cyclic) {
      st = thr_walk_rotate(walk, best_at, err);
      walk->cyclic = false;
    } else {
      st = thr_splice_cut(places->walks, places->decomposition->f, best, best_at, err);
    }
  }
  return st;
}

thr_status thr_decomposition_cut(thr_decomposition *decomposition, int n, bool even, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  cut_places places = {.decomposition = decomposition, .walks = &decomposition->walks};
  bool counts = decomposition->o->ends == THR_ENDS_COUNTS;
  int open = 0, cuts = 0;
  thr_status st = THR_OK;

  /* Every open walk is a cord already. */
  for (int i = 0; i < walks->n_walks; i++)
    open += !walks->walk[i].cyclic;
  if (counts) st = count_cuts(&places, &cuts, err);
  if (!counts && n > open) cuts = n - open;

  /* Counted ends leave no choice of a middle. */
  if (!st && cuts)
    st = even && !counts ? cut_longest(&places, cuts, n, err)
                         : cut_sharpest(&places, cuts, open + cuts, err);

  free(places.left);
  free(places.list);
  return st;
}

/* ---- evening out ---- */

/* Takes the cords of the exact table, where the framework is small. With a goal only if it was
 * missed, and then the fewest cords. */
static thr_status make_exact(thr_decomposition *decomposition, double goal, thr_err *err)
{
  const thr_request *options = decomposition->o;
  bool certain, counts = options->ends == THR_ENDS_COUNTS;
  const int n = decomposition->walks.n_walks;

  thr_decomposition_ask ask = {counts ? n : options->cords_least, counts ? n : options->cords, true,
                               INFINITY};

  /* The table is asked once, and only where the goal was missed. */
  if (goal > 0 && (decomposition->asked ||
                   thr_decomposition_within(thr_walks_most(&decomposition->walks), goal)))
    return THR_OK;

  if (goal > 0) ask = (thr_decomposition_ask){ask.least, ask.most, false, goal};
  decomposition->asked = goal > 0;
  thr_status st = thr_decomposition_table(decomposition, &ask, &certain, err);

  decomposition->certain &= certain;
  decomposition->none =
      goal > 0 && certain && !thr_decomposition_within(thr_walks_most(&decomposition->walks), goal);
  return st;
}

/* Makes the annealed cords the walks, and counts their passes. */
static thr_status take_cords(thr_decomposition *decomposition, const thr_cord *cord, int n,
                             thr_err *err)
{
  const bool closed = decomposition->o->ends == THR_ENDS_CLOSED;
  thr_walks walks = {0};
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    st = thr_walks_copy(&walks, decomposition->f, cord[i].half, cord[i].n_passes, closed, err);

  /* On failure the walks stay. */
  if (st) {
    thr_walks_destroy(&walks);
    return st;
  }

  thr_walks_destroy(&decomposition->walks);
  decomposition->walks = walks;
  memset(decomposition->passes, 0, (size_t)decomposition->f->n_edges * sizeof(int));
  thr_walks_count(&decomposition->walks, decomposition->passes);
  return THR_OK;
}

/* Anneals the walks until none is longer than the goal, or than the shortest passes shared evenly.
 */
static thr_status anneal(thr_decomposition *decomposition, double goal, thr_err *err)
{
  enum { STEPS = 20000, STEPS_PER_PASS = 3000, STEPS_MOST = 600000 };
  const thr_frame *frame = decomposition->f;
  const thr_walks *walks = &decomposition->walks;
  thr_turning_columns columns = {0};
  thr_cord *cord = NULL;
  int n = walks->n_walks;
  bool better = false;

  if (n < 2) return THR_OK;

  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);

  /* What is asked of the cords, as columns. */
  thr_turning_task task = thr_walk_length_task(frame, decomposition->o, end_allowed);
  task.tube = decomposition->o->joint == THR_JOINT_TUBE;
  thr_status st = thr_turning_columns_init(&columns, frame, &task, err);

  /* The walks as cords. */
  thr_walks copy = {0};
  for (int i = 0; i < n && !st; i++)
    st = thr_walks_copy(&copy, frame, walks->walk[i].half, walks->walk[i].n, walks->walk[i].cyclic,
                        err);
  if (!st) st = thr_walks_cords(&copy, frame, decomposition->o, &cord, &n, err);

  /* First without further passes, as no cords are shorter together; then with them, if that may
   * cost length. */
  const thr_request *options = decomposition->o;
  const int rounds = thr_wants_balance(options) || options->max_length > 0 ? 2 : 1;
  const double mean = thr_walks_length(walks) / n;
  const int steps = st ? 0 : STEPS + STEPS_PER_PASS * thr_cords_passes(cord, n);
  thr_anneal_task annealing = {.measure = THR_WALK_LENGTH,
                               .steps = steps < STEPS_MOST ? steps : STEPS_MOST,
                               .rounds = 1,
                               .enough = fmax(goal, mean * (1 + 1e-12))};
  for (int i = 0; i < rounds && !st; i++) {
    bool fell;
    task.extra_limit = i == 0 ? 0 : -1;
    annealing.first = i;
    st = thr_anneal(&columns, &annealing, decomposition->limits, cord, n, &fell, err);
    better |= fell;
  }

  if (!st && better) st = take_cords(decomposition, cord, n, err);
  thr_cords_destroy(cord, cord ? n : 0);
  thr_walks_destroy(&copy);
  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}

thr_status thr_decomposition_even(thr_decomposition *decomposition, double goal, thr_err *err)
{
  const bool length_only = goal == 0 && !thr_wants_balance(decomposition->o);
  const thr_status st = anneal(decomposition, goal, err);
  return st || length_only ? st : make_exact(decomposition, goal, err);
}
