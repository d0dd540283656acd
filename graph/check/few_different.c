/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several different cords over every edge of a few: tables over what the edges still need. */
#include "graph/check/edge_sets.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- the shortest in all ---- */

/* Needs of all edges are the digits of a number to the base each + 1, the first edge's the lowest.
 */
typedef struct {
  const thr_few_edges *few;
  int base, needs; /* needs: how many numbers there are */
  int *offset;     /* [2^n] of a set: one pass less over each of its edges */
} sharing;

static unsigned edges_of(const sharing *x, int needs)
{
  unsigned set = 0;
  for (int i = 0; i < x->few->n; i++, needs /= x->base)
    if (needs % x->base > 0) set |= 1u << i;
  return set;
}

/* The best set for one cord, of those that hold the lowest edge with needs, and what it and the
 * others cost: best is of these. */
static double best_part(const sharing *x, int needs, const double *best, unsigned *cord)
{
  const unsigned set = edges_of(x, needs), lowest = set & (~set + 1), rest = set & ~lowest;
  double least = INFINITY;
  *cord = lowest;
  for (unsigned part = rest;; part = (part - 1) & rest) {
    const double cost = x->few->one[part | lowest] + best[needs - x->offset[part | lowest]];
    if (cost < least) {
      least = cost;
      *cord = part | lowest;
    }
    if (part == 0) return least;
  }
}

/* more: of one cord more than best is of. */
static void share_once_more(const sharing *x, const double *best, double *more)
{
  unsigned cord;
  for (int needs = 0; needs < x->needs; needs++)
    more[needs] = best_part(x, needs, best, &cord);
}

/* How many needs there are, and are the sets of them few enough? */
static bool is_small(int each, int n, int *needs)
{
  const double most = 400000;
  double sets = 1;
  *needs = 1;
  for (int i = 0; i < n && sets <= most; i++) {
    sets *= 2 * each + 1;
    *needs *= each + 1;
  }
  return sets <= most;
}

static void fill_offsets(sharing *x)
{
  for (unsigned set = 1; set < 1u << x->few->n; set++) {
    int stride = 1;
    for (int i = 0; !(set >> i & 1u); i++)
      stride *= x->base;
    x->offset[set] = x->offset[set & (set - 1)] + stride;
  }
}

/* best[n * needs]: of n cords, n = 0 .. most. */
static thr_status share_all(sharing *x, int most, double **best, thr_err *err)
{
  const size_t needs = (size_t)x->needs;
  x->offset = thr_calloc((size_t)1 << x->few->n, sizeof *x->offset);
  *best = thr_calloc(((size_t)most + 1) * needs, sizeof **best);
  if (!x->offset || !*best) return thr_nomem(err);
  fill_offsets(x);
  for (size_t i = 1; i < needs; i++)
    (*best)[i] = INFINITY;
  for (size_t n = 0; n < (size_t)most; n++)
    share_once_more(x, *best + n * needs, *best + (n + 1) * needs);
  return THR_OK;
}

thr_status thr_few_edges_different(const thr_few_edges *few, int each, int least, int most,
                                   double *cost, thr_err *err)
{
  const int enough = each * few->n,
            n = most < enough ? most : enough; /* more cords than that only cost more */
  sharing x = {.few = few, .base = each + 1};
  double *best = NULL;
  *cost = 0;
  if (!is_small(each, few->n, &x.needs)) return THR_OK;
  thr_status st = share_all(&x, n, &best, err);
  *cost = INFINITY;
  for (int k = least; k <= n && !st; k++)
    *cost = fmin(*cost, best[((size_t)k + 1) * (size_t)x.needs - 1]);
  if (!st && most > enough) {
    const int more = least > enough ? least - enough : 1;
    *cost = fmin(*cost, best[((size_t)n + 1) * (size_t)x.needs - 1] + more * few->one[0]);
  }
  free(x.offset);
  free(best);
  return st;
}

/* One edge that a cord passes at no more cost than any: what cords beyond those that are needed do.
 */
static unsigned cheapest_edge(const thr_few_edges *few)
{
  int best = 0;
  for (int e = 1; e < few->n; e++)
    if (few->one[1u << e] < few->one[1u << best]) best = e;
  return 1u << best;
}

thr_status thr_few_edges_sets(const thr_few_edges *few, int each, int cords, unsigned *set,
                              bool *found, thr_err *err)
{
  const int enough = each * few->n, n = cords < enough ? cords : enough;
  sharing x = {.few = few, .base = each + 1};
  double *best = NULL;
  *found = false;
  if (!is_small(each, few->n, &x.needs)) return THR_OK;
  thr_status st = share_all(&x, n, &best, err);
  int needs = x.needs - 1;
  *found = !st && best[(size_t)n * (size_t)x.needs + (size_t)needs] < INFINITY;
  for (int k = 0; k < cords && *found; k++) {
    set[k] = 0;
    if (k < n) best_part(&x, needs, best + (size_t)(n - k - 1) * (size_t)x.needs, &set[k]);
    needs -= x.offset[set[k]];
    if (set[k] == 0) set[k] = cheapest_edge(few);
  }
  free(x.offset);
  free(best);
  return st;
}

/* ---- the dearest as cheap as can be ---- */

enum { PLACES = 1 << 19, NONE = -1 };

/* Pairs of what edges need and a set that are looked at: for one limit, and for all. What is not
 * decided then stays open. */
static const double most_work = 1 << 27, most_in_all = 1 << 28;

/* What so many cords cannot do: pass what the edges need, a number to the base each + 1; cords 0:
 * an empty place. */
typedef struct {
  int64_t needs;
  int cords;
} failure;

/* Can so many cords, none above the limit, pass everything often enough? The next cord passes the
 * edge in need that the fewest sets hold; a set that is part of another below the limit is left
 * out, and what failed before as well. */
typedef struct {
  const thr_few_edges *few;
  int each, cords;
  double limit, work, in_all;
  int64_t *offset;            /* [2^n] of a set: one pass less over each of its edges */
  int n_sets;                 /* below the limit and part of no other */
  unsigned *set;              /* [2^n] */
  int holders[THR_FEW_EDGES]; /* sets that hold an edge */
  int weight[THR_FEW_EDGES]; /* of an edge, such that the sets weigh little for what all edges do */
  int heaviest;              /* weight of the heaviest set: no cord passes more */
  failure *failed;           /* [PLACES] hashed by needs */
  int n_failed;
  unsigned *chosen; /* [cords] the sets of the cords, the last one first */
  thr_scratch own;
} decision;

static void list_sets(decision *x)
{
  const int n = x->few->n;
  x->n_sets = 0;
  memset(x->holders, 0, sizeof x->holders);
  for (unsigned set = 1; set < 1u << n; set++) {
    bool most = x->few->one[set] <= x->limit;
    for (int i = 0; i < n && most; i++)
      most = set >> i & 1u || x->few->one[set | 1u << i] > x->limit;
    if (!most) continue;
    x->set[x->n_sets++] = set;
    for (int i = 0; i < n; i++)
      x->holders[i] += (int)(set >> i & 1u);
  }
}

/* The set of the most weight, and *most of it. */
static unsigned find_heaviest(const decision *x, const int *weight, int *most)
{
  unsigned heaviest = 0;
  *most = 0;
  for (int k = 0; k < x->n_sets; k++) {
    int sum = 0;
    for (int i = 0; i < x->few->n; i++)
      sum += (x->set[k] >> i & 1u) ? weight[i] : 0;
    if (sum <= *most) continue;
    *most = sum;
    heaviest = x->set[k];
  }
  return heaviest;
}

/* Weights for which cords are many: edges of the heaviest set get lighter, again and again (S.
 * Plotkin, D. Shmoys & E. Tardos, "Fast approximation algorithms for fractional packing and
 * covering problems", 1995). Any weights would be right. */
static void weigh(decision *x)
{
  enum { ROUNDS = 200, FIRST = 1 << 20, PART = 16, MOST = 1 << 14 };
  const int n = x->few->n;
  int weight[THR_FEW_EDGES];
  double best = 0;
  for (int i = 0; i < n; i++)
    weight[i] = FIRST;
  for (int round = 0; round < ROUNDS; round++) {
    int most, all = 0;
    const unsigned set = find_heaviest(x, weight, &most);
    for (int i = 0; i < n; i++)
      all += weight[i];
    if (most > 0 && (double)all / most > best) {
      best = (double)all / most;
      memcpy(x->weight, weight, sizeof weight);
    }
    for (int i = 0; i < n; i++)
      if (set >> i & 1u) weight[i] -= weight[i] / PART;
  }
  find_heaviest(x, x->weight, &x->heaviest);
}

/* Where these needs are, or would be. */
static failure *find_failure(const decision *x, int64_t needs)
{
  uint64_t at = (uint64_t)needs * UINT64_C(0x9E3779B97F4A7C15) >> 45; /* 19 bits */
  while (x->failed[at].cords > 0 && x->failed[at].needs != needs)
    at = (at + 1) % PLACES;
  return &x->failed[at];
}

static void note_failure(decision *x, int64_t needs, int cords)
{
  failure *at = find_failure(x, needs);
  if (at->cords == 0 && 2 * ++x->n_failed > PLACES)
    return; /* there is no room, and it is found out again */
  *at = (failure){needs, cords};
}

/* What the edges are to the cords that are left: *some: those with needs; *all: those that every
 * one of them has to pass; *next: the one of the first with the fewest sets. False: they cannot do.
 */
static bool look_at(const decision *x, int64_t needs, int left, unsigned *some, unsigned *all,
                    int *next)
{
  int64_t sum = 0;
  bool enough = true;
  *some = *all = 0;
  *next = NONE;
  for (int i = 0; i < x->few->n; i++, needs /= x->each + 1) {
    const int lacks = (int)(needs % (x->each + 1));
    sum += (int64_t)lacks * x->weight[i];
    enough &= lacks <= left;
    if (lacks > 0) *some |= 1u << i;
    if (lacks == left) *all |= 1u << i;
    if (lacks > 0 && (*next == NONE || x->holders[i] < x->holders[*next])) *next = i;
  }
  return enough && sum <= (int64_t)left * x->heaviest && x->few->one[*all] <= x->limit;
}

/* Do so many cords pass what the edges need? Of the last two the second has to pass what the first
 * does not. False also where that is too much work. */
static bool suffice(decision *x, int64_t needs, int cords)
{
  unsigned some, all;
  int next;
  if (!look_at(x, needs, cords, &some, &all, &next)) return false;
  if (cords == 1 || some == 0) {
    memset(x->chosen, 0, (size_t)cords * sizeof *x->chosen);
    x->chosen[cords - 1] = some;
    return true;
  }
  if (find_failure(x, needs)->cords >= cords) return false;
  x->work += x->n_sets;
  for (int k = 0; k < x->n_sets && x->work <= most_work; k++) {
    const unsigned set = x->set[k] & some, rest = all | (some & ~set);
    x->chosen[cords - 1] = set;
    if (!(set >> next & 1u) || (all & ~set) != 0 ||
        !(x->few->one[cords == 2 ? rest : 0] <= x->limit))
      continue;
    if (suffice(x, needs - x->offset[set], cords - 1)) return true;
  }
  if (x->work <= most_work) note_failure(x, needs, cords);
  return false;
}

typedef enum { IMPOSSIBLE, POSSIBLE, OPEN } verdict;

static verdict decide(decision *x, double limit)
{
  if (x->in_all > most_in_all) return OPEN;
  x->limit = limit;
  x->work = 0;
  x->n_failed = 0;
  list_sets(x);
  weigh(x);
  memset(x->failed, 0, PLACES * sizeof *x->failed);
  const bool enough = suffice(x, x->each * x->offset[(1u << x->few->n) - 1], x->cords);
  x->in_all += x->work;
  return enough ? POSSIBLE : x->work <= most_work ? IMPOSSIBLE : OPEN;
}

static thr_status decision_init(decision *x, thr_err *err)
{
  const size_t sets = (size_t)1 << x->few->n;
  x->offset = thr_scratch_array(&x->own, sets, sizeof *x->offset);
  x->set = thr_scratch_array(&x->own, sets, sizeof *x->set);
  x->failed = thr_scratch_array(&x->own, PLACES, sizeof *x->failed);
  x->chosen = thr_scratch_array(&x->own, (size_t)x->cords, sizeof *x->chosen);
  thr_status st = thr_scratch_check(&x->own, err);
  int64_t stride = 1;
  for (unsigned set = 1; set < sets && !st; set++) {
    if ((set & (set - 1)) == 0) {
      x->offset[set] = stride;
      stride *= x->each + 1;
    } else
      x->offset[set] = x->offset[set & (set - 1)] + x->offset[set & (~set + 1)];
  }
  return st;
}

/* Of values[n], ascending, the first that is not excluded, *low, n: all are; and the first that is
 * possible, *high, n: none is known to be; set receives the sets of its cords (NULL: not wanted).
 * What is just below the known cost comes first: mostly it is excluded, or should be. */
static void bisect(decision *x, const double *value, size_t n, double known, unsigned *set,
                   size_t *low, size_t *high)
{
  size_t open = n, probe = 0;
  *low = 0;
  *high = n;
  while (probe < n && value[probe] < known * (1 - 1e-9))
    probe++;
  while (*low < open) {
    const size_t middle = probe > 0 ? probe - 1 : *low + (open - *low) / 2;
    probe = 0;
    const verdict found = decide(x, value[middle]);
    if (found == IMPOSSIBLE)
      *low = middle + 1;
    else
      open = middle;
    if (found != POSSIBLE) continue;
    *high = middle;
    if (set) memcpy(set, x->chosen, (size_t)x->cords * sizeof *set);
  }
}

thr_status thr_few_edges_different_dearest(const thr_few_edges *few, int each, int cords,
                                           double known, unsigned *set, double *proved,
                                           double *found, thr_err *err)
{
  const int enough = each * few->n;
  decision x = {
      .few = few, .each = each, .cords = cords < enough ? cords : enough}; /* more cost no less */
  double *value = NULL;
  size_t n = 0, low = 0, high = 0;
  *proved = 0;
  *found = INFINITY;
  if (few->n * log2(each + 1) > 62) return THR_OK;
  thr_status st = decision_init(&x, err);
  if (!st) st = thr_few_edges_costs(few, &value, &n, err);
  if (!st) {
    bisect(&x, value, n, known, set, &low, &high);
    for (int k = 0; k < cords && set; k++)
      if (k >= x.cords || set[k] == 0) set[k] = cheapest_edge(few);
    *proved = low < n ? value[low] : (double)INFINITY;
    *found = high < n ? value[high] : (double)INFINITY;
  }
  free(value);
  thr_scratch_free(&x.own);
  return st;
}
