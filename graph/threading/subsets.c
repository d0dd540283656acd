/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the cheapest walks of a small component exactly, by a dynamic programme over subsets of
 * the items that the walks have to collect together.
 *
 * A walk goes from state to state; every step has a cost and collects items. With half-edges as
 * states, items are the passes that edges need, turns that tie a node, or cord ends. f[S] is the
 * least cost of one walk that collects the items S. Sets only grow along a walk, so the sets are
 * settled in ascending order, and the states at each set by Dijkstra's method. g_k[S], for k walks
 * together, is the minimum of f[T] + g_(k-1)[S - T], or of max(f[T], g_(k-1)[S - T]) where the most
 * expensive walk counts, over the parts T of S that hold one chosen item of S. This is Held and
 * Karp's method for the travelling salesman (1962), with shortest walks in place of single steps.
 *
 * Example: a path of two edges, 1 and 2 long, walks from anywhere to anywhere. f[{a}] = 1, f[{b}] =
 * 2, f[{a, b}] = 3. Two walks are together 3 long, the longer one 2. */
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An entry is a set of items and a state: row[set] * n_states + state. Of groups only sets of the
 * first items have a row. */
struct thr_subsets {
  const thr_subsets_model *model;
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
  uint32_t *part; /* [n_parts] of what was found last: the items of every walk that is not the
                     cheapest of all */
};

void thr_subsets_destroy(thr_subsets *subsets)
{
  if (!subsets) return;
  free(subsets->row);
  free(subsets->plain);
  free(subsets->cost);
  free(subsets->before);
  free(subsets->reached);
  free(subsets->f);
  free(subsets->last);
  free(subsets->own_run);
  free(subsets->like);
  free(subsets->g);
  free(subsets->part);
  free(subsets);
}

/* ---- one walk ---- */

/* Returns whether the current run may enter a state. For closed walks run r makes those whose
 * lowest state is r. */
/* May the run at hand enter this state? */
static bool in_run(const thr_subsets *subsets, int state)
{
  return !subsets->model->closed || state >= subsets->run;
}

/* Returns the lowest item of a set, as a set of one; 0 for the empty set. */
static uint32_t lowest(uint32_t set)
{
  return set & (~set + 1);
}

static double *costs_at(const thr_subsets *subsets, uint32_t set)
{
  return subsets->cost + (size_t)subsets->row[set] * (size_t)subsets->model->n_states;
}

static int entry_of(const thr_subsets *subsets, uint32_t set, int state)
{
  return subsets->row[set] * subsets->model->n_states + state;
}

/* Adds to *set what a step collects: one more item of each of two groups, and the step's gains.
 * Returns false if a group whose items are collected at most once has none left. */
static bool collect(const thr_subsets_model *subsets_model, const thr_subsets_step *step,
                    uint32_t *set)
{
  for (int i = 0; i < 2; i++) {
    const uint32_t left = step->one_of[i] & ~*set;
    if (!left && (step->one_of[i] & subsets_model->once)) return false;
    *set |= lowest(left);
  }
  *set |= step->gains;
  return true;
}

/* Records that a state is reached with a set of items at a cost, unless a cheaper walk is known.
 * before: the entry that the walk came from, or -1. */
static void reach(thr_subsets *subsets, uint32_t set, int state, double cost, int before)
{
  double *costs = costs_at(subsets, set);

  /* A row is cleared when a run first reaches it, and not all rows before each run. */
  if (subsets->reached[subsets->row[set]] != subsets->run + 1) {
    subsets->reached[subsets->row[set]] = subsets->run + 1;
    for (int i = 0; i < subsets->model->n_states; i++)
      costs[i] = INFINITY;
  }

  if (cost >= costs[state]) return;
  costs[state] = cost;
  subsets->before[entry_of(subsets, set, state)] = before;
}

/* Takes every step from a state, which is settled at this set. first[n_states + 1]: the steps by
 * the state that they leave. */
static void leave(thr_subsets *subsets, const int *first, uint32_t set, int state)
{
  const thr_subsets_model *subsets_model = subsets->model;
  const int entry = entry_of(subsets, set, state);
  for (int i = first[state]; i < first[state + 1]; i++) {
    uint32_t all = set;
    if (in_run(subsets, subsets_model->step[i].to) &&
        collect(subsets_model, &subsets_model->step[i], &all))
      reach(subsets, all, subsets_model->step[i].to,
            subsets->cost[entry] + subsets_model->step[i].cost, entry);
  }
}

/* Runs Dijkstra's method among the states at one set. done[n_states] is scratch. */
static void settle(thr_subsets *subsets, const int *first, uint32_t set, bool *done)
{
  const int n = subsets->model->n_states;
  const double *row = costs_at(subsets, set);
  memset(done, 0, (size_t)n * sizeof *done);

  /* A search for the cheapest state that is open needs no heap: there are few states. */
  for (int next = 0; next >= 0;) {
    next = -1;
    for (int i = 0; i < n; i++)
      if (!done[i] && row[i] < INFINITY && (next < 0 || row[i] < row[next])) next = i;
    if (next < 0) break;
    done[next] = true;
    leave(subsets, first, set, next);
  }
}

/* Lowers f by the walks that end at this set, of this set and what the end itself collects. */
static void finish(thr_subsets *subsets, uint32_t set)
{
  const thr_subsets_model *subsets_model = subsets->model;
  for (int i = 0; i < subsets_model->n_ends; i++) {
    const thr_subsets_step *subsets_step = &subsets_model->end[i];
    const int entry = entry_of(subsets, set, subsets_step->from);
    uint32_t all = set;

    /* A closed walk ends by the step back to the state of the run. */
    if ((subsets_model->closed && subsets_step->to != subsets->run) ||
        !collect(subsets_model, subsets_step, &all) ||
        subsets->cost[entry] + subsets_step->cost >= subsets->f[all])
      continue;

    subsets->f[all] = subsets->cost[entry] + subsets_step->cost;
    subsets->last[all] = entry;
    subsets->own_run[all] = subsets->run;
  }
}

/* Makes all walks of a run: open ones from any start, closed ones from state number run. Returns
 * false where the limits stop the run. */
static bool make_run(thr_subsets *subsets, int run, const int *first, bool *done)
{
  const thr_subsets_model *subsets_model = subsets->model;
  subsets->run = run;

  /* Enter the first states. */
  for (int i = 0; i < subsets_model->n_starts; i++) {
    uint32_t set = 0;
    if ((!subsets_model->closed || subsets_model->start[i].to == run) &&
        collect(subsets_model, &subsets_model->start[i], &set))
      reach(subsets, set, subsets_model->start[i].to, subsets_model->start[i].cost, -1);
  }

  /* A step never leads to a smaller set: in ascending order no set is settled too early. */
  for (uint32_t set = 0; set < subsets->n_sets; set++) {
    if (subsets->row[set] < 0 || subsets->reached[subsets->row[set]] != run + 1) continue;
    if (thr_limits_stop(subsets->limits)) return false;
    settle(subsets, first, set, done);
    finish(subsets, set);
  }
  return true;
}

/* Completes f: gives sets without a row the cost of their plain set, and lets walks collect more
 * than asked for where this costs less, as far as items may be had again. */
static void take_larger(thr_subsets *subsets)
{
  for (uint32_t set = 0; set < subsets->n_sets; set++) {
    subsets->f[set] = subsets->f[subsets->plain[set]];
    subsets->like[set] = subsets->plain[set];
  }

  /* Minimum over supersets, one item at a time. */
  for (int i = 0; i < subsets->model->n_items; i++) {
    const uint32_t item = UINT32_C(1) << i;
    for (uint32_t set = 0; set < subsets->n_sets; set++) {
      if ((set & item) || (subsets->model->once & item) ||
          subsets->f[set | item] >= subsets->f[set])
        continue;
      subsets->f[set] = subsets->f[set | item];
      subsets->like[set] = subsets->like[set | item];
    }
  }
}

/* Makes the runs from .. end - 1. *all: no limit stopped them. */
static thr_status make_runs(thr_subsets *subsets, int from, int end, bool *all, thr_err *err)
{
  const thr_subsets_model *subsets_model = subsets->model;
  int *first = thr_calloc((size_t)subsets_model->n_states + 1, sizeof *first);
  bool *done = thr_calloc((size_t)subsets_model->n_states, sizeof *done);
  thr_status st = first && done ? THR_OK : thr_nomem(err);
  *all = !st;

  /* Steps ascend by the state that they leave: a prefix sum says where each state's begin. */
  for (int i = 0; i < subsets_model->n_steps && !st; i++)
    first[subsets_model->step[i].from + 1]++;
  for (int i = 0; i < subsets_model->n_states && !st; i++)
    first[i + 1] += first[i];

  for (int run = from; run < end && *all; run++)
    *all = make_run(subsets, run, first, done);

  free(first);
  free(done);
  return st;
}

/* Gives rows to the sets that have the first items of every group: items of a group are alike, so
 * only their number matters. Computes the plain set of each set, and how many pairs of set and part
 * a level takes. */
static thr_status number_sets(thr_subsets *subsets, thr_err *err)
{
  const thr_subsets_model *subsets_model = subsets->model;
  subsets->row = thr_calloc(subsets->n_sets, sizeof *subsets->row);
  subsets->plain = thr_calloc(subsets->n_sets, sizeof *subsets->plain);
  if (!subsets->row || !subsets->plain) return thr_nomem(err);

  for (uint32_t set = 0; set < subsets->n_sets; set++) {
    double parts = 1;

    /* before: items of the group so far. */
    for (int i = 0, before = 0; i < subsets_model->n_items; i++) {
      if (subsets_model->first[i] == i) before = 0;
      if (!(set >> i & 1)) continue;
      subsets->plain[set] |= UINT32_C(1) << (subsets_model->first[i] + before++);
      parts *= 2;
    }

    subsets->row[set] = subsets->plain[set] == set ? subsets->n_rows++ : -1;
    if (subsets->plain[set] == set) subsets->pairs += parts;
  }
  return THR_OK;
}

/* Chooses the item of the first walk: the last item of a group that is required wholly, as what is
 * left of the group has the same row without this item. */
static void choose_item(thr_subsets *subsets)
{
  const thr_subsets_model *subsets_model = subsets->model;
  for (int i = 0; i < subsets_model->n_items && !subsets->item; i++)
    if ((subsets_model->required >> i & 1) &&
        (i + 1 == subsets_model->n_items || subsets_model->first[i + 1] == i + 1))
      subsets->item = UINT32_C(1) << i;
}

/* Allocates the table, and fills f by all runs. *all: no limit stopped them. */
static thr_status make_table(thr_subsets *subsets, bool *all, thr_err *err)
{
  const size_t n = subsets->n_sets,
               entries = (size_t)subsets->n_rows * (size_t)subsets->model->n_states;
  subsets->cost = thr_calloc(entries, sizeof *subsets->cost);
  subsets->before = thr_calloc(entries, sizeof *subsets->before);
  subsets->reached = thr_calloc((size_t)subsets->n_rows, sizeof *subsets->reached);
  subsets->f = thr_calloc(n, sizeof *subsets->f);
  subsets->last = thr_calloc(n, sizeof *subsets->last);
  subsets->own_run = thr_calloc(n, sizeof *subsets->own_run);
  subsets->like = thr_calloc(n, sizeof *subsets->like);
  if (!subsets->cost || !subsets->before || !subsets->reached || !subsets->f || !subsets->last ||
      !subsets->own_run || !subsets->like)
    return thr_nomem(err);

  /* No walk is known yet. */
  for (size_t i = 0; i < n; i++)
    subsets->f[i] = INFINITY;
  thr_status st =
      make_runs(subsets, 0, subsets->model->closed ? subsets->model->n_states : 1, all, err);
  if (!st && *all) take_larger(subsets);
  return st;
}

thr_status thr_subsets_create(const thr_subsets_model *subsets_model, const thr_limits *limits,
                              double *work, thr_subsets **out, thr_err *err)
{
  const double most_entries = 1e7;
  bool all = false;
  *out = NULL;
  if (subsets_model->n_items > THR_SUBSETS_MOST_ITEMS) return THR_OK;
  thr_subsets *subsets = thr_calloc(1, sizeof *subsets);
  if (!subsets) return thr_nomem(err);

  *subsets = (thr_subsets){.model = subsets_model,
                           .limits = limits,
                           .n_sets = UINT32_C(1) << subsets_model->n_items,
                           .work = work};

  thr_status st = number_sets(subsets, err);
  choose_item(subsets);

  /* Dijkstra's method looks at all states for each one that it settles. */
  const double entries = (double)subsets->n_rows * subsets_model->n_states;
  *work -= entries * subsets_model->n_states;
  if (!st && entries <= most_entries && *work >= 0) st = make_table(subsets, &all, err);

  if (!st && all)
    *out = subsets;
  else
    thr_subsets_destroy(subsets);
  return st;
}

/* ---- several walks ---- */

/* What is minimized over several walks. */
typedef struct {
  bool sum;     /* of all costs, or the largest cost */
  double limit; /* of each */
} objective;

/* Computes g_k of a set from the level below. *part receives the items of the walk that collects
 * the given item of the set (unchanged if there is no such walk). */
static double best_part(const thr_subsets *subsets, objective by, const double *below, uint32_t set,
                        uint32_t item, uint32_t *part)
{
  const uint32_t rest = set ^ item;
  double best = INFINITY;

  /* All subsets of rest in descending order, each as the rest of one walk. */
  for (uint32_t t = rest;; t = (t - 1) & rest) {
    const double one = subsets->f[t | item], others = below[rest ^ t];
    const double all = by.sum ? one + others : one > others ? one : others;

    if (all < best && one <= by.limit) {
      best = all;
      *part = t | item;
    }
    if (t == 0) return best;
  }
}

/* Makes sure that levels 0 .. n - 1 of g have memory, and fills level 0: without walks only the
 * empty set is collected. */
static thr_status make_room(thr_subsets *subsets, int n, thr_err *err)
{
  if (n > subsets->n_levels) {
    double *g = thr_realloc(subsets->g, (size_t)n * subsets->n_sets, sizeof *g);
    if (!g) return thr_nomem(err);
    subsets->g = g;
    subsets->n_levels = n;
  }

  for (uint32_t set = 0; set < subsets->n_sets; set++)
    subsets->g[set] = set ? INFINITY : 0;
  return THR_OK;
}

/* Returns g_k of all sets. */
static double *level(const thr_subsets *subsets, int k)
{
  return subsets->g + (size_t)k * subsets->n_sets;
}

/* Fills level k from the one below, for the sets without the item of the first walk. Returns false
 * if the work or the limits do not allow it. */
static bool fill(thr_subsets *subsets, objective by, int k)
{
  uint32_t part;
  *subsets->work -= subsets->pairs / 4;
  if (*subsets->work < 0) return false;

  for (uint32_t set = 0; set < subsets->n_sets; set++) {
    if (set % 1024 == 0 && thr_limits_stop(subsets->limits)) return false;
    if (set & subsets->item) continue;
    double *g = &level(subsets, k)[set];

    /* Another set with as many items of every group is below this one, and known already. */
    if (subsets->row[set] < 0)
      *g = level(subsets, k)[subsets->plain[set]];
    else
      *g = k > 1 ? best_part(subsets, by, level(subsets, k - 1), set, lowest(set), &part)
           : subsets->f[set] <= by.limit ? subsets->f[set]
                                         : INFINITY;
  }
  return true;
}

/* Returns the item that the first walk collects of a set that suffices. */
static uint32_t first_item(const thr_subsets *subsets, uint32_t set)
{
  return subsets->item ? subsets->item : lowest(set);
}

/* Computes the least cost of k walks that collect what is required, from level k - 1. *all receives
 * the items that they collect. */
static double least(const thr_subsets *subsets, objective by, int k, uint32_t *all)
{
  const uint32_t required = subsets->model->required, others = subsets->model->once & ~required;
  uint32_t part;
  double best = INFINITY;

  /* They may also collect items that are not required, but are to be had once. */
  for (uint32_t more = others;; more = (more - 1) & others) {
    const bool plain = subsets->row[required | more] >= 0;
    double cost = plain ? best_part(subsets, by, level(subsets, k - 1), required | more,
                                    first_item(subsets, required | more), &part)
                        : INFINITY;

    if (cost < best) {
      best = cost;
      *all = required | more;
    }
    if (more == 0) return best;
  }
}

/* Returns how many of n walks can have an item of their own. Walks beyond the number of items are
 * the cheapest walk of all. */
static int walks_with_items(const thr_subsets *subsets, int n)
{
  return n < subsets->model->n_items ? n : subsets->model->n_items;
}

thr_status thr_subsets_dearest(thr_subsets *subsets, int at_least, int most, double *cost,
                               thr_err *err)
{
  const objective by = {false, INFINITY};
  const int levels = walks_with_items(subsets, most);
  uint32_t all;
  *cost = INFINITY;

  thr_status st = make_room(subsets, levels, err);
  for (int k = 1; k <= levels && !st; k++) {
    /* Each number of walks needs one more level. */
    if (k > 1 && !fill(subsets, by, k - 1)) {
      *cost = NAN;
      return THR_OK;
    }

    /* Further walks that have no item of their own are possible at the last level only. */
    if (k < at_least && k < levels) continue;
    double largest = least(subsets, by, k, &all);
    if (k < at_least && subsets->f[0] > largest) largest = subsets->f[0];
    if (largest < *cost) *cost = largest;
  }
  return st;
}

/* Finds the items of each of k walks, again from the levels below. */
static thr_status find_parts(thr_subsets *subsets, objective by, int k, uint32_t set, thr_err *err)
{
  free(subsets->part);
  subsets->n_parts = k;
  subsets->part = thr_calloc((size_t)k, sizeof *subsets->part);
  if (!subsets->part) return thr_nomem(err);

  for (int i = 0; i < k; i++) {
    best_part(subsets, by, level(subsets, k - 1 - i), set,
              i ? lowest(set) : first_item(subsets, set), &subsets->part[i]);
    set &= ~subsets->part[i];
  }
  return THR_OK;
}

/* Returns false if some required item has no walk within the limit: then no number of walks
 * suffices. If each item has one, enough of them do, as long as items may be had again; where some
 * may not, nothing is tested, and true is returned. */
static bool each_fits(const thr_subsets *subsets, double limit)
{
  bool fits = true;
  for (int i = 0; i < subsets->model->n_items && !subsets->model->once; i++)
    fits &= !(subsets->model->required >> i & 1) || subsets->f[UINT32_C(1) << i] <= limit;
  return fits;
}

thr_status thr_subsets_find(thr_subsets *subsets, int at_least, int most, bool fewest, double limit,
                            int *n, double *cost, thr_err *err)
{
  const objective by = {true, limit};
  const int levels = walks_with_items(subsets, most);
  const double more = subsets->f[0] <= limit ? subsets->f[0] : INFINITY; /* one more walk */
  int best_k = 0;
  uint32_t all = 0, best_set = 0;
  *cost = INFINITY;
  *n = 0;
  if (!each_fits(subsets, limit)) return THR_OK;

  thr_status st = make_room(subsets, levels, err);
  for (int k = 1; k <= levels && !st && !(fewest && best_k); k++) {
    /* Each number of walks needs one more level. */
    if (k > 1 && !fill(subsets, by, k - 1)) {
      *n = -1;
      return THR_OK;
    }

    /* Walks beyond k have no item of their own: each costs as much as the cheapest walk. */
    if (k < at_least && k < levels) continue;
    int others = k < at_least ? at_least - k : 0;

    double sum = least(subsets, by, k, &all) + (others ? others * more : 0);

    if (!(sum < *cost * (1 - 1e-12))) continue;
    *cost = sum;
    *n = k + others;
    best_k = k;
    best_set = all;
  }
  return st || !best_k ? st : find_parts(subsets, by, best_k, best_set, err);
}

thr_status thr_subsets_walk(thr_subsets *subsets, int i, int **state, int *n, double *cost,
                            thr_err *err)
{
  const uint32_t set = subsets->like[i < subsets->n_parts ? subsets->part[i] : 0];
  const int run = subsets->own_run[set];
  bool all = true;

  /* The table holds the entries of one run only, so another run is made again. */
  thr_status st = subsets->run == run ? THR_OK : make_runs(subsets, run, run + 1, &all, err);

  *n = 0;
  *state = NULL;
  *cost = subsets->f[set];
  if (st || !all) return st ? st : thr_fail(err, THR_ELIMIT, "stopped");

  /* Count the states back to the start, then list them. */
  for (int entry = subsets->last[set]; entry >= 0; entry = subsets->before[entry])
    ++*n;
  if (!(*state = thr_calloc((size_t)*n, sizeof **state))) return thr_nomem(err);
  for (int entry = subsets->last[set], at = *n; entry >= 0; entry = subsets->before[entry])
    (*state)[--at] = entry % subsets->model->n_states;
  return THR_OK;
}
