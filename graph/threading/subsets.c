/* The table and its combinations. */
#include "graph/threading/subsets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An entry is a set of items and a state: row[set] * n_states + state. Of groups only sets of the first items have a row. */
struct thr_subsets {
  const thr_subsets_model *m;
  const thr_limits *limits;
  uint32_t n_sets;
  int n_rows, *row; /* [n_sets] */
  uint32_t *plain;  /* [n_sets] the set with as many of every group, the first ones */
  double pairs;     /* of sets with a row and their parts */
  uint32_t item;    /* the first walk's; 0 = that of the set, the lowest */
  double *cost;     /* [n_rows * n_states] of the entries in the run at hand */
  int *before;      /* the entry before; -1 = it is a start */
  int *reached;     /* [n_rows] the last run that got there, from 1; 0 = none */
  int run;          /* at hand */
  double *f;        /* [n_sets] */
  int *last;        /* [n_sets] the entry that a walk of this cost ends with, */
  int *own_run;     /* in this run */
  uint32_t *like;   /* [n_sets] the set whose walk it is */
  int n_levels;     /* of g that there is room for, with level 0 */
  double *g;        /* [n_levels * n_sets] */
  double *work;     /* left */
  int n_parts;
  uint32_t *part; /* [n_parts] of what was found last: the items of every walk that is not the cheapest of all */
};

void thr_subsets_destroy(thr_subsets *x)
{
  if (!x) return;
  free(x->row);
  free(x->plain);
  free(x->cost);
  free(x->before);
  free(x->reached);
  free(x->f);
  free(x->last);
  free(x->own_run);
  free(x->like);
  free(x->g);
  free(x->part);
  free(x);
}

/* ---- one walk ---- */

/* May the run at hand enter this state? */
static bool in_run(const thr_subsets *x, int state)
{
  return !x->m->closed || state >= x->run;
}

static uint32_t lowest(uint32_t set)
{
  return set & (~set + 1);
}

static double *costs_at(const thr_subsets *x, uint32_t set)
{
  return x->cost + (size_t)x->row[set] * (size_t)x->m->n_states;
}

static int entry_of(const thr_subsets *x, uint32_t set, int state)
{
  return x->row[set] * x->m->n_states + state;
}

/* *set with what the step collects. False: it is all collected. */
static bool collect(const thr_subsets_model *m, const thr_subsets_step *step, uint32_t *set)
{
  for (int i = 0; i < 2; i++) {
    const uint32_t left = step->one_of[i] & ~*set;
    if (!left && (step->one_of[i] & m->once)) return false;
    *set |= lowest(left);
  }
  *set |= step->gains;
  return true;
}

static void reach(thr_subsets *x, uint32_t set, int state, double cost, int before)
{
  double *costs = costs_at(x, set);
  if (x->reached[x->row[set]] != x->run + 1) {
    x->reached[x->row[set]] = x->run + 1;
    for (int i = 0; i < x->m->n_states; i++)
      costs[i] = INFINITY;
  }
  if (cost >= costs[state]) return;
  costs[state] = cost;
  x->before[entry_of(x, set, state)] = before;
}

static void leave(thr_subsets *x, const int *first, uint32_t set, int state)
{
  const thr_subsets_model *m = x->m;
  const int entry = entry_of(x, set, state);
  for (int i = first[state]; i < first[state + 1]; i++) {
    uint32_t all = set;
    if (in_run(x, m->step[i].to) && collect(m, &m->step[i], &all))
      reach(x, all, m->step[i].to, x->cost[entry] + m->step[i].cost, entry);
  }
}

/* Dijkstra among the states at one set. done[n_states] is scratch. */
static void settle(thr_subsets *x, const int *first, uint32_t set, bool *done)
{
  const int n = x->m->n_states;
  const double *row = costs_at(x, set);
  memset(done, 0, (size_t)n * sizeof *done);
  for (int next = 0; next >= 0;) {
    next = -1;
    for (int i = 0; i < n; i++)
      if (!done[i] && row[i] < INFINITY && (next < 0 || row[i] < row[next])) next = i;
    if (next < 0) break;
    done[next] = true;
    leave(x, first, set, next);
  }
}

/* Walks that end at this set, or with what the end collects. */
static void finish(thr_subsets *x, uint32_t set)
{
  const thr_subsets_model *m = x->m;
  for (int i = 0; i < m->n_ends; i++) {
    const thr_subsets_step *s = &m->end[i];
    const int entry = entry_of(x, set, s->from);
    uint32_t all = set;
    if ((m->closed && s->to != x->run) || !collect(m, s, &all) || x->cost[entry] + s->cost >= x->f[all]) continue;
    x->f[all] = x->cost[entry] + s->cost;
    x->last[all] = entry;
    x->own_run[all] = x->run;
  }
}

/* All walks of a run: open ones from anywhere, closed ones from state number run. */
static bool make_run(thr_subsets *x, int run, const int *first, bool *done)
{
  const thr_subsets_model *m = x->m;
  x->run = run;
  for (int i = 0; i < m->n_starts; i++) {
    uint32_t set = 0;
    if ((!m->closed || m->start[i].to == run) && collect(m, &m->start[i], &set))
      reach(x, set, m->start[i].to, m->start[i].cost, -1);
  }
  for (uint32_t set = 0; set < x->n_sets; set++) {
    if (x->row[set] < 0 || x->reached[x->row[set]] != run + 1) continue;
    if (thr_limits_stop(x->limits)) return false;
    settle(x, first, set, done);
    finish(x, set);
  }
  return true;
}

/* f of all sets, and where collecting more costs less, that: of items that may be had again. */
static void take_larger(thr_subsets *x)
{
  for (uint32_t set = 0; set < x->n_sets; set++) {
    x->f[set] = x->f[x->plain[set]];
    x->like[set] = x->plain[set];
  }
  for (int i = 0; i < x->m->n_items; i++) {
    const uint32_t item = UINT32_C(1) << i;
    for (uint32_t set = 0; set < x->n_sets; set++) {
      if ((set & item) || (x->m->once & item) || x->f[set | item] >= x->f[set]) continue;
      x->f[set] = x->f[set | item];
      x->like[set] = x->like[set | item];
    }
  }
}

/* The runs from .. end - 1. *all: they were made. */
static thr_status make_runs(thr_subsets *x, int from, int end, bool *all, thr_err *err)
{
  const thr_subsets_model *m = x->m;
  int *first = thr_calloc((size_t)m->n_states + 1, sizeof *first);
  bool *done = thr_calloc((size_t)m->n_states, sizeof *done);
  thr_status st = first && done ? THR_OK : thr_nomem(err);
  *all = !st;
  for (int i = 0; i < m->n_steps && !st; i++)
    first[m->step[i].from + 1]++;
  for (int i = 0; i < m->n_states && !st; i++)
    first[i + 1] += first[i];
  for (int run = from; run < end && *all; run++)
    *all = make_run(x, run, first, done);
  free(first);
  free(done);
  return st;
}

/* Gives rows to the sets that have the first items of every group. */
static thr_status number_sets(thr_subsets *x, thr_err *err)
{
  const thr_subsets_model *m = x->m;
  x->row = thr_calloc(x->n_sets, sizeof *x->row);
  x->plain = thr_calloc(x->n_sets, sizeof *x->plain);
  if (!x->row || !x->plain) return thr_nomem(err);
  for (uint32_t set = 0; set < x->n_sets; set++) {
    double parts = 1;
    for (int i = 0, before = 0; i < m->n_items; i++) {
      if (m->first[i] == i) before = 0;
      if (!(set >> i & 1)) continue;
      x->plain[set] |= UINT32_C(1) << (m->first[i] + before++);
      parts *= 2;
    }
    x->row[set] = x->plain[set] == set ? x->n_rows++ : -1;
    if (x->plain[set] == set) x->pairs += parts;
  }
  return THR_OK;
}

/* A last item of a group that is required wholly: what is left of the group has the same row without it. */
static void choose_item(thr_subsets *x)
{
  const thr_subsets_model *m = x->m;
  for (int i = 0; i < m->n_items && !x->item; i++)
    if ((m->required >> i & 1) && (i + 1 == m->n_items || m->first[i + 1] == i + 1)) x->item = UINT32_C(1) << i;
}

static thr_status make_table(thr_subsets *x, bool *all, thr_err *err)
{
  const size_t n = x->n_sets, entries = (size_t)x->n_rows * (size_t)x->m->n_states;
  x->cost = thr_calloc(entries, sizeof *x->cost);
  x->before = thr_calloc(entries, sizeof *x->before);
  x->reached = thr_calloc((size_t)x->n_rows, sizeof *x->reached);
  x->f = thr_calloc(n, sizeof *x->f);
  x->last = thr_calloc(n, sizeof *x->last);
  x->own_run = thr_calloc(n, sizeof *x->own_run);
  x->like = thr_calloc(n, sizeof *x->like);
  if (!x->cost || !x->before || !x->reached || !x->f || !x->last || !x->own_run || !x->like) return thr_nomem(err);
  for (size_t i = 0; i < n; i++)
    x->f[i] = INFINITY;
  thr_status st = make_runs(x, 0, x->m->closed ? x->m->n_states : 1, all, err);
  if (!st && *all) take_larger(x);
  return st;
}

thr_status thr_subsets_create(const thr_subsets_model *m, const thr_limits *limits, double *work, thr_subsets **out, thr_err *err)
{
  const double most_entries = 1e7;
  bool all = false;
  *out = NULL;
  if (m->n_items > THR_SUBSETS_MOST_ITEMS) return THR_OK;
  thr_subsets *x = thr_calloc(1, sizeof *x);
  if (!x) return thr_nomem(err);
  *x = (thr_subsets){.m = m, .limits = limits, .n_sets = UINT32_C(1) << m->n_items, .work = work};
  thr_status st = number_sets(x, err);
  choose_item(x);
  const double entries = (double)x->n_rows * m->n_states;
  *work -= entries * m->n_states;
  if (!st && entries <= most_entries && *work >= 0) st = make_table(x, &all, err);
  if (!st && all)
    *out = x;
  else
    thr_subsets_destroy(x);
  return st;
}

/* ---- several walks ---- */

typedef struct {
  bool sum;     /* of all, or of the dearest */
  double limit; /* of each */
} measure;

/* g_k of a set, from the level below. *part: the walk's that holds this one item of it (none of no items). */
static double best_part(const thr_subsets *x, measure by, const double *below, uint32_t set, uint32_t item, uint32_t *part)
{
  const uint32_t rest = set ^ item;
  double best = INFINITY;
  for (uint32_t t = rest;; t = (t - 1) & rest) {
    const double one = x->f[t | item], others = below[rest ^ t];
    const double all = by.sum ? one + others : one > others ? one : others;
    if (all < best && one <= by.limit) {
      best = all;
      *part = t | item;
    }
    if (t == 0) return best;
  }
}

/* Room for levels 0 .. n - 1, of which level 0 is made. */
static thr_status make_room(thr_subsets *x, int n, thr_err *err)
{
  if (n > x->n_levels) {
    double *g = thr_realloc(x->g, (size_t)n * x->n_sets, sizeof *g);
    if (!g) return thr_nomem(err);
    x->g = g;
    x->n_levels = n;
  }
  for (uint32_t set = 0; set < x->n_sets; set++)
    x->g[set] = set ? INFINITY : 0;
  return THR_OK;
}

static double *level(const thr_subsets *x, int k)
{
  return x->g + (size_t)k * x->n_sets;
}

/* Level k from the one below, of sets without the first walk's item. False: it takes too long. */
static bool fill(thr_subsets *x, measure by, int k)
{
  uint32_t part;
  *x->work -= x->pairs / 4;
  if (*x->work < 0) return false;
  for (uint32_t set = 0; set < x->n_sets; set++) {
    if (set % 1024 == 0 && thr_limits_stop(x->limits)) return false;
    if (set & x->item) continue;
    double *g = &level(x, k)[set];
    if (x->row[set] < 0) /* fewer in number, so that is known */
      *g = level(x, k)[x->plain[set]];
    else
      *g = k > 1 ? best_part(x, by, level(x, k - 1), set, lowest(set), &part) : x->f[set] <= by.limit ? x->f[set] : INFINITY;
  }
  return true;
}

/* What the first walk collects of a set that suffices. */
static uint32_t first_item(const thr_subsets *x, uint32_t set)
{
  return x->item ? x->item : lowest(set);
}

/* Least of k walks that collect what is required, from level k - 1; *all: what they collect. */
static double least(const thr_subsets *x, measure by, int k, uint32_t *all)
{
  const uint32_t required = x->m->required, others = x->m->once & ~required;
  uint32_t part;
  double best = INFINITY;
  for (uint32_t more = others;; more = (more - 1) & others) {
    const bool plain = x->row[required | more] >= 0;
    double cost = plain ? best_part(x, by, level(x, k - 1), required | more, first_item(x, required | more), &part) : INFINITY;
    if (cost < best) {
      best = cost;
      *all = required | more;
    }
    if (more == 0) return best;
  }
}

/* More walks than items: the others are the cheapest of all. */
static int walks_with_items(const thr_subsets *x, int n)
{
  return n < x->m->n_items ? n : x->m->n_items;
}

thr_status thr_subsets_dearest(thr_subsets *x, int at_least, int most, double *cost, thr_err *err)
{
  const measure by = {false, INFINITY};
  const int levels = walks_with_items(x, most);
  uint32_t all;
  *cost = INFINITY;
  thr_status st = make_room(x, levels, err);
  for (int k = 1; k <= levels && !st; k++) {
    if (k > 1 && !fill(x, by, k - 1)) {
      *cost = NAN;
      return THR_OK;
    }
    if (k < at_least && k < levels) continue;
    double dearest = least(x, by, k, &all);
    if (k < at_least && x->f[0] > dearest) dearest = x->f[0];
    if (dearest < *cost) *cost = dearest;
  }
  return st;
}

/* The parts of k walks with items, from the levels below. */
static thr_status find_parts(thr_subsets *x, measure by, int k, uint32_t set, thr_err *err)
{
  free(x->part);
  x->n_parts = k;
  x->part = thr_calloc((size_t)k, sizeof *x->part);
  if (!x->part) return thr_nomem(err);
  for (int i = 0; i < k; i++) {
    best_part(x, by, level(x, k - 1 - i), set, i ? lowest(set) : first_item(x, set), &x->part[i]);
    set &= ~x->part[i];
  }
  return THR_OK;
}

/* Is there a walk of this cost for each item? Where all may be had again, there are enough walks then, else too few. */
static bool each_fits(const thr_subsets *x, double limit)
{
  bool fits = true;
  for (int i = 0; i < x->m->n_items && !x->m->once; i++)
    fits &= !(x->m->required >> i & 1) || x->f[UINT32_C(1) << i] <= limit;
  return fits;
}

thr_status thr_subsets_find(thr_subsets *x, int at_least, int most, bool fewest, double limit, int *n, double *cost, thr_err *err)
{
  const measure by = {true, limit};
  const int levels = walks_with_items(x, most);
  const double more = x->f[0] <= limit ? x->f[0] : INFINITY; /* one more walk */
  int best_k = 0;
  uint32_t all = 0, best_set = 0;
  *cost = INFINITY;
  *n = 0;
  if (!each_fits(x, limit)) return THR_OK;
  thr_status st = make_room(x, levels, err);
  for (int k = 1; k <= levels && !st && !(fewest && best_k); k++) {
    if (k > 1 && !fill(x, by, k - 1)) {
      *n = -1;
      return THR_OK;
    }
    if (k < at_least && k < levels) continue;
    int others = k < at_least ? at_least - k : 0;
    double sum = least(x, by, k, &all) + (others ? others * more : 0);
    if (!(sum < *cost * (1 - 1e-12))) continue;
    *cost = sum;
    *n = k + others;
    best_k = k;
    best_set = all;
  }
  return st || !best_k ? st : find_parts(x, by, best_k, best_set, err);
}

thr_status thr_subsets_walk(thr_subsets *x, int i, int **state, int *n, double *cost, thr_err *err)
{
  const uint32_t set = x->like[i < x->n_parts ? x->part[i] : 0];
  const int run = x->own_run[set];
  bool all = true;
  thr_status st = x->run == run ? THR_OK : make_runs(x, run, run + 1, &all, err);
  *n = 0;
  *state = NULL;
  *cost = x->f[set];
  if (st || !all) return st ? st : thr_fail(err, THR_ELIMIT, "stopped");
  for (int entry = x->last[set]; entry >= 0; entry = x->before[entry])
    ++*n;
  if (!(*state = thr_calloc((size_t)*n, sizeof **state))) return thr_nomem(err);
  for (int entry = x->last[set], at = *n; entry >= 0; entry = x->before[entry])
    (*state)[--at] = entry % x->m->n_states;
  return THR_OK;
}
