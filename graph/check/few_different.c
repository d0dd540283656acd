/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the least cost of several cords of which `each` different ones pass every edge of a
 * small component. Two methods use the costs one[S] of a single cord over every set of edges S
 * (few_edges.c). Neither gives a certificate.
 *
 * The sum: a dynamic programme over what the edges still need, with best_n[needs] = min over S of
 * one[S] + best_(n-1)[needs - S]. S is a set of edges with needs that holds the lowest of them.
 *
 * The largest cost: bisection over the costs that there are. Whether cords up to a limit suffice is
 * decided by a depth-first search over the maximal sets within the limit, with a hash table of
 * needs that failed and bounds from weights of the edges.
 *
 * Example: a ring of four unit edges, two closed cords, each = 2: both pass all of the ring, 8
 * together. */
#include "graph/check/check_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the least sum ---- */

/* The tables of the dynamic programme. Needs are a number: the passes that each edge still needs by
 * different cords are its digits to the base each + 1, with the first edge's the lowest. */
typedef struct {
  const thr_few_edges *few;
  int base, n_needs; /* n_needs: how many needs there are */
  int *offset; /* [2^n] the number whose digits are 1 for the edges of a set: one pass over each */
} needs_tables;

/* Returns the set of edges that still need passes. */
static unsigned edges_of(const needs_tables *tables, int needs)
{
  unsigned set = 0;
  for (int i = 0; i < tables->few->n; i++, needs /= tables->base)
    if (needs % tables->base > 0) set |= 1u << i;
  return set;
}

/* Finds the best set for one cord among those that hold the lowest edge with needs, with
 * best[n_needs] as the costs of the other cords. Returns the least cost of all of them; *cord
 * receives the set. */
static double find_best_set(const needs_tables *tables, int needs, const double *best,
                            unsigned *cord)
{
  const unsigned set = edges_of(tables, needs), lowest = set & (~set + 1), rest = set & ~lowest;
  double least = INFINITY;

  /* Enumerate the subsets of the other edges with needs. */
  *cord = lowest;
  for (unsigned part = rest;; part = (part - 1) & rest) {
    const double cost =
        tables->few->one[part | lowest] + best[needs - tables->offset[part | lowest]];
    if (cost < least) {
      least = cost;
      *cord = part | lowest;
    }
    if (part == 0) return least;
  }
}

/* Computes more[n_needs], the least sums of one cord more than best[n_needs] has. */
static void add_one_cord(const needs_tables *tables, const double *best, double *more)
{
  unsigned cord;
  for (int needs = 0; needs < tables->n_needs; needs++)
    more[needs] = find_best_set(tables, needs, best, &cord);
}

/* Returns whether the tables are small enough; *needs receives the number of needs. The work
 * for one cord more is the number of pairs of needs and a set of edges with needs: 1 + 2 each
 * possibilities for every edge. */
static bool is_small_enough(int each, int n, int *needs)
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

/* Computes the offsets of all sets from those of the sets without their lowest edge. */
static void fill_offsets(needs_tables *tables)
{
  for (unsigned set = 1; set < 1u << tables->few->n; set++) {
    int stride = 1;
    for (int i = 0; !(set >> i & 1u); i++)
      stride *= tables->base;
    tables->offset[set] = tables->offset[set & (set - 1)] + stride;
  }
}

/* Computes the least sums of n cords, for n = 0 .. most: table n begins at best[n * n_needs]. The
 * caller owns tables->offset and *best, after a failure, too. */
static thr_status tabulate_sums(needs_tables *tables, int most, double **best, thr_err *err)
{
  const size_t needs = (size_t)tables->n_needs;
  tables->offset = thr_calloc((size_t)1 << tables->few->n, sizeof *tables->offset);
  *best = thr_calloc(((size_t)most + 1) * needs, sizeof **best);
  if (!tables->offset || !*best) return thr_nomem(err);

  /* No cords serve no needs. */
  fill_offsets(tables);
  for (size_t i = 1; i < needs; i++)
    (*best)[i] = INFINITY;
  for (size_t n = 0; n < (size_t)most; n++)
    add_one_cord(tables, *best + n * needs, *best + (n + 1) * needs);

  return THR_OK;
}

thr_status thr_few_edges_different(const thr_few_edges *few, int each, int least, int most,
                                   double *cost, thr_err *err)
{
  const int enough = each * few->n,
            n = most < enough ? most : enough; /* more cords than that only cost more */
  needs_tables tables = {.few = few, .base = each + 1};
  double *best = NULL;
  *cost = 0;
  if (!is_small_enough(each, few->n, &tables.n_needs)) return THR_OK;

  /* All edges need `each` passes: the last entry of every table. */
  thr_status st = tabulate_sums(&tables, n, &best, err);
  *cost = INFINITY;
  for (int k = least; k <= n && !st; k++)
    *cost = fmin(*cost, best[((size_t)k + 1) * (size_t)tables.n_needs - 1]);

  /* Cords beyond each * n pass the cheapest edges. */
  if (!st && most > enough) {
    const int more = least > enough ? least - enough : 1;
    *cost = fmin(*cost, best[((size_t)n + 1) * (size_t)tables.n_needs - 1] + more * few->one[0]);
  }

  free(tables.offset);
  free(best);
  return st;
}

/* Returns the set of one edge that a cord can pass at least cost, for cords beyond those that are
 * needed. */
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
  needs_tables tables = {.few = few, .base = each + 1};
  double *best = NULL;
  *found = false;
  if (!is_small_enough(each, few->n, &tables.n_needs)) return THR_OK;
  thr_status st = tabulate_sums(&tables, n, &best, err);

  /* Read the sets from the tables, with one cord less each time. */
  int needs = tables.n_needs - 1;
  *found = !st && best[(size_t)n * (size_t)tables.n_needs + (size_t)needs] < INFINITY;
  for (int k = 0; k < cords && *found; k++) {
    set[k] = 0;
    if (k < n)
      find_best_set(&tables, needs, best + (size_t)(n - k - 1) * (size_t)tables.n_needs, &set[k]);
    needs -= tables.offset[set[k]];
    if (set[k] == 0) set[k] = cheapest_edge(few);
  }

  free(tables.offset);
  free(best);
  return st;
}

/* ---- the least largest cost ---- */

enum { SLOTS = 1 << 19, NONE = -1 };

/* How many pairs of needs and a set may be looked at for one limit, and for all limits together;
 * what is not decided by then stays open. */
static const double max_work = 1 << 27, max_total_work = 1 << 28;

/* Needs (a number to the base each + 1) that so many cords cannot serve. cords = 0 marks an empty
 * slot. */
typedef struct {
  int64_t needs;
  int cords;
} failure;

/* The depth-first search for cords, none above the limit, that serve all needs. The next cord
 * passes the edge in need that the fewest sets hold. Only maximal sets are tried, and needs that
 * failed before are left out. */
typedef struct {
  const thr_few_edges *few;
  int each, cords;
  double limit, work, total_work; /* pairs looked at for this limit, and for earlier ones */
  int64_t *offset;                /* [2^n] the number whose digits are 1 for the edges of a set */
  int n_sets;
  unsigned *set;              /* [2^n] the sets within the limit that are part of no other one */
  int holders[THR_FEW_EDGES]; /* number of these sets that hold an edge */
  int weight[THR_FEW_EDGES];  /* of an edge; any weights are valid */
  int heaviest;               /* weight of the heaviest set: no cord passes more */
  failure *failed;            /* [SLOTS] hash table by needs */
  int n_failed;
  unsigned *chosen; /* [cords] the sets of the cords, the last one first */
  thr_scratch own;
} cover_search;

/* Lists the sets within the limit that are part of no other one, and counts the sets that hold each
 * edge. */
static void list_maximal_sets(cover_search *search)
{
  const int n = search->few->n;
  search->n_sets = 0;
  memset(search->holders, 0, sizeof search->holders);
  for (unsigned set = 1; set < 1u << n; set++) {

    /* A set is maximal if no further edge keeps it within the limit. */
    bool most = search->few->one[set] <= search->limit;
    for (int i = 0; i < n && most; i++)
      most = set >> i & 1u || search->few->one[set | 1u << i] > search->limit;

    if (!most) continue;
    search->set[search->n_sets++] = set;
    for (int i = 0; i < n; i++)
      search->holders[i] += (int)(set >> i & 1u);
  }
}

/* Returns the set with the largest weight; *most receives the weight. */
static unsigned find_heaviest(const cover_search *search, const int *weight, int *most)
{
  unsigned heaviest = 0;
  *most = 0;
  for (int k = 0; k < search->n_sets; k++) {
    int sum = 0;
    for (int i = 0; i < search->few->n; i++)
      sum += (search->set[k] >> i & 1u) ? weight[i] : 0;
    if (sum <= *most) continue;
    *most = sum;
    heaviest = search->set[k];
  }

  return heaviest;
}

/* Finds weights of the edges by which many cords are needed: lowers those of the heaviest set again
 * and again, and keeps the weights for which all edges weigh most in units of the heaviest set (S.
 * Plotkin, D. Shmoys & E. Tardos, "Fast approximation algorithms for fractional packing and
 * covering problems", 1995). Any weights are valid. */
static void weigh(cover_search *search)
{
  enum { ROUNDS = 200, FIRST = 1 << 20, PART = 16, MOST = 1 << 14 };
  const int n = search->few->n;
  int weight[THR_FEW_EDGES];
  double best = 0;
  for (int i = 0; i < n; i++)
    weight[i] = FIRST;

  for (int round = 0; round < ROUNDS; round++) {
    int most, all = 0;
    const unsigned set = find_heaviest(search, weight, &most);
    for (int i = 0; i < n; i++)
      all += weight[i];

    /* Keep the best weights. */
    if (most > 0 && (double)all / most > best) {
      best = (double)all / most;
      memcpy(search->weight, weight, sizeof weight);
    }

    /* Lower the weights of the heaviest set. */
    for (int i = 0; i < n; i++)
      if (set >> i & 1u) weight[i] -= weight[i] / PART;
  }

  find_heaviest(search, search->weight, &search->heaviest);
}

/* Returns the slot of the hash table that holds these needs, or the empty one where they belong. */
static failure *find_failure(const cover_search *search, int64_t needs)
{
  uint64_t at = (uint64_t)needs * UINT64_C(0x9E3779B97F4A7C15) >> 45; /* 19 bits */
  while (search->failed[at].cords > 0 && search->failed[at].needs != needs)
    at = (at + 1) % SLOTS;
  return &search->failed[at];
}

/* Records that so many cords cannot serve the needs, unless the hash table is half full. Needs that
 * are not recorded are looked at again. */
static void record_failure(cover_search *search, int64_t needs, int cords)
{
  failure *at = find_failure(search, needs);
  if (at->cords == 0 && 2 * ++search->n_failed > SLOTS) return;
  *at = (failure){needs, cords};
}

/* Splits needs into their digits. *some receives the edges with needs; *all the edges that every
 * one of the cords left has to pass; *next the edge with needs that the fewest sets hold. Returns
 * false if the weights, a single edge or the edges *all prove that the cords cannot serve the
 * needs. */
static bool summarize_needs(const cover_search *search, int64_t needs, int left, unsigned *some,
                            unsigned *all, int *next)
{
  int64_t sum = 0;
  bool enough = true;
  *some = *all = 0;
  *next = NONE;
  for (int i = 0; i < search->few->n; i++, needs /= search->each + 1) {
    const int lacks = (int)(needs % (search->each + 1));
    sum += (int64_t)lacks * search->weight[i];
    enough &= lacks <= left;
    if (lacks > 0) *some |= 1u << i;
    if (lacks == left) *all |= 1u << i;
    if (lacks > 0 && (*next == NONE || search->holders[i] < search->holders[*next])) *next = i;
  }

  return enough && sum <= (int64_t)left * search->heaviest &&
         search->few->one[*all] <= search->limit;
}

/* Returns whether so many cords serve the needs, with their sets in chosen. Returns false, too, if
 * this takes too much work. */
static bool can_cover(cover_search *search, int64_t needs, int cords)
{
  unsigned some, all;
  int next;
  if (!summarize_needs(search, needs, cords, &some, &all, &next)) return false;

  /* summarize_needs has shown that a single cord can pass all edges that are left. */
  if (cords == 1 || some == 0) {
    memset(search->chosen, 0, (size_t)cords * sizeof *search->chosen);
    search->chosen[cords - 1] = some;
    return true;
  }

  /* Branch over what the next cord passes. It has to pass edge number next and the edges `all`; of
   * the last two cords, the second has to pass what the first does not. */
  if (find_failure(search, needs)->cords >= cords) return false;
  search->work += search->n_sets;
  for (int k = 0; k < search->n_sets && search->work <= max_work; k++) {
    const unsigned set = search->set[k] & some, rest = all | (some & ~set);
    search->chosen[cords - 1] = set;
    if (!(set >> next & 1u) || (all & ~set) != 0 ||
        !(search->few->one[cords == 2 ? rest : 0] <= search->limit))
      continue;
    if (can_cover(search, needs - search->offset[set], cords - 1)) return true;
  }

  if (search->work <= max_work) record_failure(search, needs, cords);
  return false;
}

/* What a decision finds: OPEN if the work did not suffice. */
typedef enum { IMPOSSIBLE, POSSIBLE, OPEN } verdict;

/* Decides whether cords, none above the limit, serve the needs of all edges. */
static verdict decide(cover_search *search, double limit)
{
  if (search->total_work > max_total_work) return OPEN;
  search->limit = limit;
  search->work = 0;
  search->n_failed = 0;

  /* The sets, their weights and the failures depend on the limit. */
  list_maximal_sets(search);
  weigh(search);
  memset(search->failed, 0, SLOTS * sizeof *search->failed);

  /* At the start every edge needs `each` passes. */
  const bool enough =
      can_cover(search, search->each * search->offset[(1u << search->few->n) - 1], search->cords);
  search->total_work += search->work;
  return enough ? POSSIBLE : search->work <= max_work ? IMPOSSIBLE : OPEN;
}

/* Allocates the arrays, and computes the offsets of all sets. */
static thr_status cover_search_init(cover_search *search, thr_err *err)
{
  const size_t sets = (size_t)1 << search->few->n;
  search->offset = thr_scratch_array(&search->own, sets, sizeof *search->offset);
  search->set = thr_scratch_array(&search->own, sets, sizeof *search->set);
  search->failed = thr_scratch_array(&search->own, SLOTS, sizeof *search->failed);
  search->chosen = thr_scratch_array(&search->own, (size_t)search->cords, sizeof *search->chosen);
  thr_status st = thr_scratch_check(&search->own, err);

  /* A single edge has a power of the base; the offset of a larger set is a sum. */
  int64_t stride = 1;
  for (unsigned set = 1; set < sets && !st; set++) {
    if ((set & (set - 1)) == 0) {
      search->offset[set] = stride;
      stride *= search->each + 1;
    } else
      search->offset[set] = search->offset[set & (set - 1)] + search->offset[set & (~set + 1)];
  }

  return st;
}

/* Bisects over value[n], ascending. *low receives the number of the first value that is not
 * excluded (n: all are excluded); *high the first that is known to be possible (n: none is);
 * set[cords] (NULL: not wanted) the sets of its cords. The first decision is on the value just
 * below the known cost, as this one mostly is excluded. */
static void bisect(cover_search *search, const double *value, size_t n, double known, unsigned *set,
                   size_t *low, size_t *high)
{
  size_t open = n, probe = 0;
  *low = 0;
  *high = n;
  while (probe < n && value[probe] < known * (1 - 1e-9))
    probe++;

  /* Values below number *low are impossible, and from number open on possible or undecided. */
  while (*low < open) {
    const size_t middle = probe > 0 ? probe - 1 : *low + (open - *low) / 2;
    probe = 0;
    const verdict found = decide(search, value[middle]);
    if (found == IMPOSSIBLE)
      *low = middle + 1;
    else
      open = middle;

    /* Keep the cords of the least value that is possible. */
    if (found != POSSIBLE) continue;
    *high = middle;
    if (set) memcpy(set, search->chosen, (size_t)search->cords * sizeof *set);
  }
}

thr_status thr_few_edges_different_dearest(const thr_few_edges *few, int each, int cords,
                                           double known, unsigned *set, double *proved,
                                           double *found, thr_err *err)
{
  const int enough = each * few->n;
  cover_search search = {
      .few = few, .each = each, .cords = cords < enough ? cords : enough}; /* more cost no less */
  double *value = NULL;
  size_t n = 0, low = 0, high = 0;
  *proved = 0;
  *found = INFINITY;

  /* Needs have to fit into 62 bits. */
  if (few->n * log2(each + 1) > 62) return THR_OK;

  thr_status st = cover_search_init(&search, err);
  if (!st) st = thr_few_edges_costs(few, &value, &n, err);

  /* Cords that are not needed, or have nothing left to pass, take the cheapest edge. */
  if (!st) {
    bisect(&search, value, n, known, set, &low, &high);
    for (int k = 0; k < cords && set; k++)
      if (k >= search.cords || set[k] == 0) set[k] = cheapest_edge(few);
    *proved = low < n ? value[low] : (double)INFINITY;
    *found = high < n ? value[high] : (double)INFINITY;
  }

  free(value);
  thr_scratch_free(&search.own);
  return st;
}
