/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the passes of a component are shared out among several cords (docs/method.md).
 *
 * Open cords: one walk, cut where cords may end, costs nothing. Closed cords: a walk that comes
 * twice past a node falls into two there; where no node is passed twice, further passes make more
 * circuits.
 *
 * Example: a figure of eight, two closed cords: cut at its middle. */
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/threading/anneal.h"
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

/* A place to cut: before pass number at of a walk. */
typedef struct {
  double turn; /* that the cut leaves out, rad */
  int walk, at, node;
} place;

typedef struct {
  thr_decomposition *s;
  thr_walks *w; /* its walks */
  int *left;    /* [n_nodes] THR_ENDS_COUNTS: cuts that are still to be made there; else NULL */
  place *list;
  int n, capacity;
} places;

static bool may_cut(const places *p, int v)
{
  return p->left ? p->left[v] > 0 : thr_plan_end_allowed(p->s->f, p->s->o, v);
}

/* Every cut adds two ends: what the counts ask for beyond the ends that the walks have. */
static thr_status count_cuts(places *p, int *cuts, thr_err *err)
{
  const thr_frame *frame = p->s->f;
  *cuts = 0;
  if (!(p->left = thr_calloc((size_t)frame->n_nodes, sizeof *p->left))) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++)
    p->left[v] = p->s->o->end_count[v];
  for (int i = 0; i < p->w->n_walks; i++) {
    const thr_walk *x = &p->w->walk[i];
    if (x->cyclic) continue;
    p->left[thr_tail(frame, x->half[0])]--;
    p->left[thr_head(frame, x->half[x->n - 1])]--;
  }
  for (int v = 0; v < frame->n_nodes; v++) {
    if (p->left[v] < 0 || p->left[v] % 2)
      return thr_fail(err, THR_ESOLVER,
                      "the passes do not leave as many ends at node %s as asked for",
                      frame->name[v]);
    p->left[v] /= 2;
    *cuts += p->left[v];
  }
  return THR_OK;
}

static thr_status find_places(places *p, thr_err *err)
{
  const thr_frame *frame = p->s->f;
  p->n = 0;
  for (int i = 0; i < p->w->n_walks; i++) {
    const thr_walk *x = &p->w->walk[i];
    for (int at = x->cyclic ? 0 : 1; at < x->n; at++) {
      int v = thr_tail(frame, x->half[at]);
      if (!may_cut(p, v)) continue;
      thr_status st = thr_grow(&p->list, p->n, &p->capacity, sizeof *p->list, err);
      if (st) return st;
      p->list[p->n++] =
          (place){thr_walk_turn(frame, thr_walk_before(x, at), x->half[at]), i, at, v};
    }
  }
  return THR_OK;
}

static int by_turn(const void *pa, const void *pb)
{
  const place *a = pa, *b = pb;
  if (fabs(a->turn - b->turn) > 1e-9)
    return a->turn > b->turn ? -1 : 1; /* equal ones in order, whatever the rounding */
  if (a->walk != b->walk) return a->walk < b->walk ? -1 : 1;
  return (a->at > b->at) - (a->at < b->at);
}

/* The last place of a walk first. */
static int by_place(const void *pa, const void *pb)
{
  const place *a = pa, *b = pb;
  if (a->walk != b->walk) return a->walk < b->walk ? -1 : 1;
  return (a->at < b->at) - (a->at > b->at);
}

/* Cuts at all places of the list. */
static thr_status cut_all(places *p, thr_err *err)
{
  thr_status st = THR_OK;
  if (p->n) qsort(p->list, (size_t)p->n, sizeof *p->list, by_place);
  for (int i = 0, end; i < p->n && !st; i = end) {
    thr_walk *x = &p->w->walk[p->list[i].walk];
    for (end = i; end < p->n && p->list[end].walk == p->list[i].walk;)
      end++;
    int last = end, shift = 0;
    if (x->cyclic) { /* the first place opens it */
      shift = p->list[--last].at;
      x->cyclic = false;
      st = thr_walk_rotate(x, shift, err);
    }
    for (int j = i; j < last && !st; j++)
      st = thr_splice_cut(p->w, p->s->f, p->list[j].walk, p->list[j].at - shift, err);
  }
  return st;
}

static thr_status too_few(const places *p, int wanted, thr_err *err)
{
  const thr_frame *frame = p->s->f;
  return thr_fail(err, THR_EINFEASIBLE,
                  "the component with node %s has too few places for the ends of %d cords",
                  frame->name[thr_tail(frame, p->w->walk[0].half[0])], wanted);
}

static thr_status cut_sharpest(places *p, int cuts, int wanted, thr_err *err)
{
  int taken = 0;
  thr_status st = find_places(p, err);
  if (st) return st;
  if (p->n) qsort(p->list, (size_t)p->n, sizeof *p->list, by_turn);
  for (int i = 0; i < p->n && taken < cuts; i++) {
    if (!may_cut(p, p->list[i].node)) continue;
    if (p->left) p->left[p->list[i].node]--;
    p->list[taken++] = p->list[i];
  }
  if (taken < cuts) return too_few(p, wanted, err);
  p->n = taken;
  return cut_all(p, err);
}

/* Where an open walk is cut into the most equal parts; 0 = nowhere. A cyclic one: where it may be
 * opened; -1 = nowhere. */
static int middle(const places *p, const thr_walk *x)
{
  double sum = 0, best = INFINITY;
  int at = x->cyclic ? -1 : 0;
  for (int i = 0; i < x->n; i++) {
    if ((x->cyclic || i) && may_cut(p, thr_tail(p->s->f, x->half[i]))) {
      double off = x->cyclic ? 0 : fabs(sum - x->length / 2);
      if (off < best) {
        best = off;
        at = i;
      }
    }
    sum += p->s->f->length[x->half[i] >> 1];
  }
  return at;
}

/* The longest walk that can be cut, in the middle; again and again. */
static thr_status cut_longest(places *p, int cuts, int wanted, thr_err *err)
{
  thr_status st = THR_OK;
  for (int done = 0; done < cuts && !st; done++) {
    int best = -1, best_at = 0;
    for (int i = 0; i < p->w->n_walks; i++) {
      thr_walk *x = &p->w->walk[i];
      if (best >= 0 && x->length <= p->w->walk[best].length * (1 + 1e-12)) continue;
      int at = middle(p, x);
      if (at < (x->cyclic ? 0 : 1)) continue;
      best = i;
      best_at = at;
    }
    if (best < 0) return too_few(p, wanted, err);
    thr_walk *x = &p->w->walk[best];
    if (x->cyclic) {
      st = thr_walk_rotate(x, best_at, err);
      x->cyclic = false;
    } else {
      st = thr_splice_cut(p->w, p->s->f, best, best_at, err);
    }
  }
  return st;
}

thr_status thr_decomposition_cut(thr_decomposition *decomposition, int n, bool even, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  places p = {.s = decomposition, .w = &decomposition->walks};
  bool counts = decomposition->o->ends == THR_ENDS_COUNTS;
  int open = 0, cuts = 0;
  thr_status st = THR_OK;
  for (int i = 0; i < walks->n_walks; i++)
    open += !walks->walk[i].cyclic;
  if (counts) st = count_cuts(&p, &cuts, err);
  if (!counts && n > open) cuts = n - open;
  if (!st && cuts)
    st = even && !counts ? cut_longest(&p, cuts, n, err) : cut_sharpest(&p, cuts, open + cuts, err);
  free(p.left);
  free(p.list);
  return st;
}

/* ---- evening out ---- */

/* What the table knows better, where the framework is small. With a goal only if it was missed, and
 * then the fewest cords. */
static thr_status make_exact(thr_decomposition *decomposition, double goal, thr_err *err)
{
  const thr_request *options = decomposition->o;
  bool certain, counts = options->ends == THR_ENDS_COUNTS;
  const int n = decomposition->walks.n_walks;
  thr_decomposition_ask ask = {counts ? n : options->cords_least, counts ? n : options->cords, true,
                               INFINITY};
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

/* The annealed cords as the walks. */
static thr_status take_cords(thr_decomposition *decomposition, const thr_cord *cord, int n,
                             thr_err *err)
{
  const bool closed = decomposition->o->ends == THR_ENDS_CLOSED;
  thr_walks walks = {0};
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    st = thr_walks_copy(&walks, decomposition->f, cord[i].half, cord[i].n_passes, closed, err);
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

  /* First without further passes, as no cords are shorter together; then with them. */
  const double mean = thr_walks_length(walks) / n;
  const int steps = st ? 0 : STEPS + STEPS_PER_PASS * thr_cords_passes(cord, n);
  thr_anneal_task annealing = {.measure = THR_WALK_LENGTH,
                               .steps = steps < STEPS_MOST ? steps : STEPS_MOST,
                               .rounds = 1,
                               .enough = fmax(goal, mean * (1 + 1e-12))};
  for (int i = 0; i < 2 && !st; i++) {
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
  thr_status st = anneal(decomposition, goal, err);
  return st ? st : make_exact(decomposition, goal, err);
}
