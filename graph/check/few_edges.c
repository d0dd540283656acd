/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the least cost of several cords through a component of few edges from tables over all
 * sets of edges. Gives no certificate. Private to the checker.
 *
 * One cord: one[S] is the least cost of a cord that passes at least the edges S. The dynamic
 * programme has the states (set of edges passed so far, half-edge passed last). Sets only grow, so
 * they are settled in ascending order, each by Dijkstra's method.
 *
 * The largest cost of n cords: n cords of cost at most L exist if n of the sets with one[S] <= L
 * have all edges as their union. Unions are computed for families of sets: pairs of a set of one
 * family and a set of another are counted by multiplying the zeta transforms of both families over
 * all subsets, in 2^n n (A. Bjoerklund, T. Husfeldt & M. Koivisto, "Set partitioning via
 * inclusion-exclusion", SIAM J. Computing 39, 2009). Bisection finds the least L.
 *
 * The sum: best_n[S] = min over T in S with its lowest edge of one[T] + best_(n-1)[S - T] (M. Held
 * & R. M. Karp 1962, with walks).
 *
 * Every edge needs one pass only, and nothing else that couples cords is asked: for requests with
 * further conditions the costs are lower bounds.
 *
 * Example: a ring of four unit edges, two open cords, ends anywhere: 4 together, the longer one 2.
 */
#include "graph/check/check_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STATES = 2 * THR_FEW_EDGES };

/* A transition from one half-edge to another. */
typedef struct {
  int to;
  double cost;
} step;

/* What fills the table of single cords. A half-edge of the component is a number: twice the
 * position of its edge in edge[n], plus its direction. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  bool turning;
  bool u_turns_anywhere; /* by turning: at nodes with other edges, too */
  double limit;
  int n, edge[THR_FEW_EDGES];
  int first[STATES + 1]; /* transitions of state s: step[first[s]] .. step[first[s + 1] - 1] */
  step step[STATES * STATES];
  double *cost; /* [2^n * 2 n] least cost of a walk by its set and last half-edge */
  thr_few_edges *table;
} table_builder;

/* Returns the half-edge of the framework that a number stands for. */
static int half_of(const table_builder *builder, int state)
{
  return 2 * builder->edge[state >> 1] + (state & 1);
}

/* Returns what a cord pays for half-edge `to` after half-edge `from`: the turn, or the length of
 * `to`; INFINITY if a cord cannot pass them one after the other. */
static double step_cost(const table_builder *builder, int from, int to)
{
  int a = half_of(builder, from), b = half_of(builder, to), v = thr_tail(builder->frame, b);
  bool back = b == (a ^ 1), tube = builder->request->joint == THR_JOINT_TUBE;
  if (thr_head(builder->frame, a) != v) return INFINITY;
  if (back && (tube || (builder->turning && !builder->u_turns_anywhere &&
                        thr_degree(builder->frame, v) > 1)))
    return INFINITY;

  return builder->turning ? thr_check_price(builder->frame, builder->request->turning.cost, a, b)
                          : builder->frame->length[builder->edge[to >> 1]];
}

/* Returns what a cord pays for its first half-edge. */
static double first_cost(const table_builder *builder, int state)
{
  return builder->turning ? 0 : builder->frame->length[builder->edge[state >> 1]];
}

/* Returns the costs of the walks that pass just this set, by their last half-edge. */
static double *costs_at(const table_builder *builder, unsigned set)
{
  return builder->cost + (size_t)set * 2 * (size_t)builder->n;
}

/* Lists the possible transitions from every half-edge, with their costs. */
static void list_steps(table_builder *builder)
{
  int n = 0;
  for (int state = 0; state < 2 * builder->n; state++) {
    builder->first[state] = n;
    for (int to = 0; to < 2 * builder->n; to++) {
      double cost = step_cost(builder, state, to);
      if (cost < INFINITY) builder->step[n++] = (step){to, cost};
    }
  }
  builder->first[2 * builder->n] = n;
}

/* Settles the costs of one set by Dijkstra's method over its half-edges. Transitions to an edge
 * outside the set offer a cost to the larger set. Edges below the lowest one are left out. */
static void settle_set(const table_builder *builder, unsigned set, int lowest)
{
  double *cost = costs_at(builder, set);
  bool done[STATES] = {false};

  /* Settle the cheapest state; there are too few of them for a heap. */
  for (;;) {
    int best = -1;
    for (int state = 2 * lowest; state < 2 * builder->n; state++)
      if (!done[state] && cost[state] < INFINITY && (best < 0 || cost[state] < cost[best]))
        best = state;
    if (best < 0) return;
    done[best] = true;

    /* Relax the transitions that start there. */
    for (int k = builder->first[best]; k < builder->first[best + 1]; k++) {
      int state = builder->step[k].to;
      double *to = &costs_at(builder, set | 1u << (state >> 1))[state],
             here = cost[best] + builder->step[k].cost;
      if (state >= 2 * lowest && here < *to && here <= builder->limit) *to = here;
    }
  }
}

/* Returns the set after this one among those without edges below the lowest. */
static unsigned next_set(unsigned set, int lowest)
{
  return set + (1u << lowest);
}

/* Resets the costs of all sets without edges below the lowest. */
static void reset_costs(const table_builder *builder, int lowest)
{
  for (unsigned set = 0; set < 1u << builder->n; set = next_set(set, lowest))
    for (int state = 0; state < 2 * builder->n; state++)
      costs_at(builder, set)[state] = INFINITY;
}

/* Fills table->one with the costs of open cords that pass just each set. */
static void tabulate_open_cords(const table_builder *builder)
{
  reset_costs(builder, 0);

  /* A cord begins with a half-edge that leaves a possible end. */
  for (int state = 0; state < 2 * builder->n; state++)
    if (thr_plan_end_allowed(builder->frame, builder->request,
                             thr_tail(builder->frame, half_of(builder, state))))
      costs_at(builder, 1u << (state >> 1))[state] = first_cost(builder, state);

  /* A cord ends with a half-edge that reaches a possible end. */
  for (unsigned set = 1; set < 1u << builder->n; set++) {
    settle_set(builder, set, 0);
    for (int state = 0; state < 2 * builder->n; state++)
      if (thr_plan_end_allowed(builder->frame, builder->request,
                               thr_head(builder->frame, half_of(builder, state))) &&
          costs_at(builder, set)[state] <= builder->limit)
        builder->table->one[set] = fmin(builder->table->one[set], costs_at(builder, set)[state]);
  }
}

/* Fills table->one with the costs of closed cords that pass just each set. Every closed cord has a
 * lowest edge i. In one of its directions it passes edge i from the edge's first node to the
 * second, and begins there without loss of generality. */
static void tabulate_closed_cords(const table_builder *builder)
{
  for (int i = 0; i < builder->n; i++) {
    reset_costs(builder, i);
    costs_at(builder, 1u << i)[2 * i] = first_cost(builder, 2 * i);

    /* All edges of the cord are at least i, and edge i is one of them. */
    for (unsigned set = 1u << i; set < 1u << builder->n; set = next_set(set, i)) {
      if (!(set >> i & 1u)) continue;
      settle_set(builder, set, i);

      /* Close the cord by the transition to half-edge 2 i, whose length was counted already. */
      for (int state = 2 * i; state < 2 * builder->n; state++) {
        double cost = costs_at(builder, set)[state] + step_cost(builder, state, 2 * i) -
                      (builder->turning ? 0 : first_cost(builder, 2 * i));
        if (cost <= builder->limit) builder->table->one[set] = fmin(builder->table->one[set], cost);
      }
    }
  }
}

/* Replaces one[S] by the least cost over all sets that hold S, as a cord may pass more edges than
 * it has to. */
static void minimize_over_supersets(thr_few_edges *few)
{
  for (int i = 0; i < few->n; i++)
    for (unsigned set = 0; set < 1u << few->n; set++)
      if (!(set >> i & 1u)) few->one[set] = fmin(few->one[set], few->one[set | 1u << i]);
}

/* Lists the edges of a component. Returns how many there are, or 0 if there are more than
 * THR_FEW_EDGES. */
static int list_edges(const thr_frame *frame, const int *component, int number, int *edge)
{
  int n = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    if (component[frame->edge[e][0]] != number) continue;
    if (n == THR_FEW_EDGES) return 0;
    edge[n++] = e;
  }
  return n;
}

thr_status thr_few_edges_init(thr_few_edges *few, const thr_frame *frame,
                              const thr_request *options, const int *component, int number,
                              bool turning, double limit, int sets, thr_err *err)
{
  table_builder builder = {
      .frame = frame, .request = options, .turning = turning, .limit = limit, .table = few};
  *few = (thr_few_edges){.n = builder.n = list_edges(frame, component, number, builder.edge)};
  if (builder.n > 0 && 1 << builder.n > sets) few->n = 0;
  if (few->n == 0) return THR_OK;

  /* Small tables serve sums, too, which need the costs above the limit. */
  if (builder.n <= THR_FEW_SUMMED) builder.limit = INFINITY;
  few->one = thr_calloc((size_t)1 << builder.n, sizeof *few->one);
  builder.cost = thr_calloc(((size_t)1 << builder.n) * 2 * (size_t)builder.n, sizeof *builder.cost);
  if (!few->one || !builder.cost) {
    free(builder.cost);
    thr_few_edges_destroy(few);
    return thr_nomem(err);
  }

  for (unsigned set = 0; set < 1u << builder.n; set++)
    few->one[set] = INFINITY;
  list_steps(&builder);
  if (options->ends == THR_ENDS_CLOSED)
    tabulate_closed_cords(&builder);
  else
    tabulate_open_cords(&builder);

  minimize_over_supersets(few);
  free(builder.cost);
  return THR_OK;
}

void thr_few_edges_destroy(thr_few_edges *few)
{
  free(few->one);
  *few = (thr_few_edges){0};
}

/* ---- the least largest cost of several cords ---- */

/* Families of sets of edges, as 0 or 1 for each set. With a set they contain all of its subsets. */
typedef struct {
  int n;
  size_t sets;
  int64_t *some;            /* [sets] sets that one cord within the limit can pass */
  int64_t *all;             /* [sets] sets that as many cords as were united can pass */
  int64_t *half;            /* [sets] sets that half of the cords can pass */
  int64_t *other, *product; /* [sets] scratch of unite */
  thr_scratch own;          /* the arrays */
} set_families;

/* Replaces each value of a set by the sum over its subsets (sign 1: zeta transform), or reverts
 * this (sign -1: Moebius transform). */
static void sum_over_subsets(int64_t *value, int n, int64_t sign)
{
  for (int i = 0; i < n; i++)
    for (size_t block = 0; block < (size_t)1 << n; block += (size_t)2 << i)
      for (size_t k = block; k < block + ((size_t)1 << i); k++)
        value[k + ((size_t)1 << i)] += sign * value[k];
}

/* Replaces families->all by the unions of two of its sets (itself), or of one of them and one of
 * families->some. Counts pairs of sets by their union; there are at most 4^n. */
static void unite(set_families *families, bool itself)
{
  memcpy(families->product, families->all, families->sets * sizeof *families->product);
  memcpy(families->other, itself ? families->all : families->some,
         families->sets * sizeof *families->other);

  /* After the zeta transforms, the product counts the pairs whose union is part of a set. */
  sum_over_subsets(families->product, families->n, 1);
  sum_over_subsets(families->other, families->n, 1);
  for (size_t set = 0; set < families->sets; set++)
    families->product[set] *= families->other[set];

  /* The Moebius transform leaves the pairs whose union is the set. */
  sum_over_subsets(families->product, families->n, -1);
  for (size_t set = 0; set < families->sets; set++)
    families->all[set] = families->product[set] > 0;
}

/* Returns whether so many cords, none above the limit, pass all edges: half of them pass a set, and
 * the others its complement. */
static bool can_cover(set_families *families, const thr_few_edges *few, int cords, double limit)
{
  const int half = cords / 2;
  int highest = 1;
  for (size_t set = 0; set < families->sets; set++)
    families->some[set] = families->all[set] = few->one[set] <= limit;
  if (half == 0) return families->some[families->sets - 1];

  /* Unite as many sets as half of the cords, by repeated doubling. */
  while (2 * highest <= half)
    highest *= 2;
  for (int bit = highest / 2; bit > 0; bit /= 2) {
    unite(families, true);
    if (half & bit) unite(families, false);
  }

  memcpy(families->half, families->all, families->sets * sizeof *families->half);
  if (cords % 2) unite(families, false);
  for (size_t set = 0; set < families->sets; set++)
    if (families->half[set] && families->all[families->sets - 1 - set]) return true;

  return false;
}

thr_status thr_few_edges_costs(const thr_few_edges *few, double **value, size_t *n, thr_err *err)
{
  size_t sets = (size_t)1 << few->n, all = 0;
  *n = 0;
  if (!(*value = thr_calloc(sets, sizeof **value))) return thr_nomem(err);
  for (size_t set = 0; set < sets; set++)
    if (few->one[set] < INFINITY) (*value)[all++] = few->one[set];

  /* Keep one of equal costs. */
  thr_sort_doubles(*value, all);
  for (size_t k = 0; k < all; k++)
    if (*n == 0 || (*value)[k] > (*value)[*n - 1]) (*value)[(*n)++] = (*value)[k];

  return THR_OK;
}

thr_status thr_few_edges_dearest(const thr_few_edges *few, int cords, double *cost, thr_err *err)
{
  set_families families = {.n = few->n, .sets = (size_t)1 << few->n};
  size_t low = 0, n = 0;
  double *value = NULL;

  families.some = thr_scratch_array(&families.own, families.sets, sizeof *families.some);
  families.all = thr_scratch_array(&families.own, families.sets, sizeof *families.all);
  families.half = thr_scratch_array(&families.own, families.sets, sizeof *families.half);
  families.other = thr_scratch_array(&families.own, families.sets, sizeof *families.other);
  families.product = thr_scratch_array(&families.own, families.sets, sizeof *families.product);

  if (cords > few->n) cords = few->n; /* more cords than edges cost no less */
  thr_status st = thr_scratch_check(&families.own, err);
  if (!st) st = thr_few_edges_costs(few, &value, &n, err);

  /* Bisect over the costs that there are. */
  for (size_t high = n; !st && low < high;) {
    size_t middle = low + (high - low) / 2;
    if (can_cover(&families, few, cords, value[middle]))
      high = middle;
    else
      low = middle + 1;
  }

  *cost = !st && low < n ? value[low] : (double)INFINITY;
  free(value);
  thr_scratch_free(&families.own);
  return st;
}

/* ---- the least sum of several cords ---- */

/* Computes more[S], the least sum of one cord more than best[S] has. The new cord is the one that
 * passes the lowest edge of S. */
static void add_one_cord(const thr_few_edges *few, const double *best, double *more)
{
  more[0] = few->one[0] + best[0];
  for (unsigned set = 1; set < 1u << few->n; set++) {
    unsigned lowest = set & (~set + 1), rest = set & ~lowest;
    more[set] = INFINITY;

    /* Enumerate the subsets of the other edges. */
    for (unsigned part = rest;; part = (part - 1) & rest) {
      more[set] = fmin(more[set], few->one[part | lowest] + best[rest & ~part]);
      if (part == 0) break;
    }
  }
}

/* Computes least_cost[k] for k = 1 .. most: the least sum of k cords that pass all edges. */
static thr_status compute_sums(const thr_few_edges *few, int most, double *least_cost, thr_err *err)
{
  thr_scratch own = {0};
  size_t sets = (size_t)1 << few->n;
  double *best = thr_scratch_array(&own, sets, sizeof *best),
         *more = thr_scratch_array(&own, sets, sizeof *more);
  thr_status st = thr_scratch_check(&own, err);

  /* One cord at first, then one more in every round. */
  for (size_t set = 0; set < sets && !st; set++)
    best[set] = few->one[set];
  for (int n = 1; n <= most && !st; n++) {
    least_cost[n] = best[sets - 1];
    add_one_cord(few, best, more);
    double *swap = best;
    best = more;
    more = swap;
  }

  thr_scratch_free(&own);
  return st;
}

thr_status thr_few_edges_sum(const thr_few_edges *few, int least, int most, double *cost,
                             thr_err *err)
{
  double least_cost[THR_FEW_SUMMED + 1];
  int n = few->n;
  thr_status st = compute_sums(few, most < n ? most : n, least_cost, err);
  *cost = INFINITY;

  /* Cords beyond one for each edge pass the cheapest edges. */
  for (int k = least; k <= most && !st; k++) {
    *cost = fmin(*cost, k > n ? least_cost[n] + (k - n) * few->one[0] : least_cost[k]);
    if (k > n) break; /* more cords than edges only cost more */
  }

  return st;
}

/* ---- bounds of a framework, component by component ---- */

void thr_few_edges_cords(const thr_frame *frame, const thr_request *options, const int *component,
                         int number, int *least, int *most)
{
  int ends = 0;
  *least = thr_plan_cords_least(options);
  *most = options->cords;

  /* Given numbers of ends tell the number of cords. */
  if (options->ends != THR_ENDS_COUNTS) return;
  for (int v = 0; v < frame->n_nodes; v++)
    ends += component[v] == number ? options->end_count[v] : 0;
  *least = *most = ends / 2;
}

/* Counts the edges of each component; the caller owns *edges. */
static thr_status count_all_edges(const thr_frame *frame, const int *component, int n_components,
                                  int **edges, thr_err *err)
{
  if (!(*edges = thr_calloc((size_t)n_components, sizeof **edges))) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges; e++)
    (*edges)[component[frame->edge[e][0]]]++;
  return THR_OK;
}

/* Removes the cords that are longer than the request allows, up to rounding. */
static void exclude_longer_cords(thr_few_edges *few, const thr_request *options)
{
  const double longest = options->max_length > 0 ? options->max_length * (1 + 2e-9) : INFINITY;
  for (unsigned set = 0; few->n > 0 && set < 1u << few->n; set++)
    if (few->one[set] > longest) few->one[set] = INFINITY;
}

thr_status thr_few_edges_lengths(const thr_frame *frame, const thr_request *options,
                                 const int *component, int n_components, const int *cords, int each,
                                 double *least, thr_err *err)
{
  int sets = THR_FEW_SETS, *edges = NULL;
  thr_status st = count_all_edges(frame, component, n_components, &edges, err);
  for (int c = 0; c < n_components && !st; c++) {
    thr_few_edges few = {0};
    int from, to;
    least[c] = 0;

    /* Make the table of this component while sets are left. */
    if (edges[c] > THR_FEW_SUMMED) continue;
    thr_few_edges_cords(frame, options, component, c, &from, &to);
    if (cords) to = cords[c];
    if (to > 1)
      st = thr_few_edges_init(&few, frame, options, component, c, false, INFINITY, sets, err);
    if (few.n > 0) sets -= 1 << few.n;

    /* Different cords over every edge cost more; without their table, the plain sum still is a
     * bound. */
    if (!st) exclude_longer_cords(&few, options);
    if (!st && few.n > 0 && each > 1)
      st = thr_few_edges_different(&few, each, from, to, &least[c], err);
    if (!st && few.n > 0 && least[c] == 0) st = thr_few_edges_sum(&few, from, to, &least[c], err);

    thr_few_edges_destroy(&few);
  }

  free(edges);
  return st;
}

thr_status thr_few_edges_bounds(const thr_frame *frame, const thr_request *options, double limit,
                                double *sum, double *dearest, thr_err *err)
{
  thr_scratch own = {0};
  int n, sets = THR_FEW_SETS,
         *component = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *component);
  bool all = true;
  *sum = *dearest = 0;

  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_frame_components(frame, component, &n, err);
  for (int c = 0; !st && c < n; c++) {
    thr_few_edges few = {0};
    double worst = 0, total = 0;
    int least, most;

    /* Make the table of this component while sets are left. */
    thr_few_edges_cords(frame, options, component, c, &least, &most);
    if (most > 1)
      st = thr_few_edges_init(&few, frame, options, component, c, true, limit, sets, err);
    if (few.n > 0) sets -= 1 << few.n;

    /* The largest cost counts for all tables, the sum for small ones. */
    bool summed = few.n > 0 && few.n <= THR_FEW_SUMMED;
    if (!st && few.n > 0) st = thr_few_edges_dearest(&few, most, &worst, err);
    if (!st && summed) st = thr_few_edges_sum(&few, least, most, &total, err);

    /* The framework has the largest cost of its components, and the sum of their sums. */
    all &= summed;
    *dearest = fmax(*dearest, worst);
    *sum += total;
    thr_few_edges_destroy(&few);
  }

  if (!all) *sum = 0;
  thr_scratch_free(&own);
  return st;
}

/* ---- the fewest cords within a pull ---- */

/* The sides of cords, from one end or from any, and the sets of edges that cords of two sides pass.
 */
typedef struct {
  table_builder builder;
  const int *component;
  int number;
  int64_t *side;       /* [2^n] 1 if a side to the node at hand passes just the set */
  int64_t *pairs;      /* [2^n] number of pairs of such sides by their union */
  thr_few_edges cords; /* one[S] is 0 if a cord within the pull passes S, else INFINITY */
} pull_sides;

/* Computes the least turning of walks by their set and last half-edge. The walks begin at node
 * home, or (home < 0) wherever a cord may end. */
static void tabulate_sides(pull_sides *pull, int home)
{
  reset_costs(&pull->builder, 0);
  for (int state = 0; state < 2 * pull->builder.n; state++) {
    const int v = thr_tail(pull->builder.frame, half_of(&pull->builder, state));
    if (home < 0 ? thr_plan_end_allowed(pull->builder.frame, pull->builder.request, v) : v == home)
      costs_at(&pull->builder, 1u << (state >> 1))[state] = 0;
  }
  for (unsigned set = 1; set < 1u << pull->builder.n; set++)
    settle_set(&pull->builder, set, 0);
}

/* Marks in cords.one the unions of two sets that sides to node v pass within the limit. */
static void join_sides_at(pull_sides *pull, int v)
{
  const unsigned sets = 1u << pull->builder.n;

  /* Find the sets of single sides. */
  for (unsigned set = 0; set < sets; set++) {
    pull->side[set] = 0;
    for (int state = 0; state < 2 * pull->builder.n; state++)
      if (thr_head(pull->builder.frame, half_of(&pull->builder, state)) == v &&
          costs_at(&pull->builder, set)[state] <= pull->builder.limit)
        pull->side[set] = 1;
  }

  /* Count pairs by their unions, as unite does. */
  memcpy(pull->pairs, pull->side, sets * sizeof *pull->pairs);
  sum_over_subsets(pull->pairs, pull->builder.n, 1);
  for (unsigned set = 0; set < sets; set++)
    pull->pairs[set] *= pull->pairs[set];
  sum_over_subsets(pull->pairs, pull->builder.n, -1);
  for (unsigned set = 0; set < sets; set++)
    if (pull->pairs[set] > 0) pull->cords.one[set] = 0;
}

/* Marks the sets of all cords both of whose sides begin at home, or (home < 0) at any ends. */
static void join_sides_from(pull_sides *pull, int home)
{
  tabulate_sides(pull, home);
  for (int v = 0; v < pull->builder.frame->n_nodes; v++)
    if (pull->component[v] == pull->number) join_sides_at(pull, v);
}

/* Allocates the tables, for builder.n edges, and lists the transitions. */
static thr_status pull_sides_init(pull_sides *pull, thr_err *err)
{
  const size_t sets = (size_t)1 << pull->builder.n;
  pull->cords.n = pull->builder.n;
  pull->cords.one = thr_calloc(sets, sizeof *pull->cords.one);
  pull->side = thr_calloc(sets, sizeof *pull->side);
  pull->pairs = thr_calloc(sets, sizeof *pull->pairs);
  pull->builder.cost = thr_calloc(sets * 2 * (size_t)pull->builder.n, sizeof *pull->builder.cost);
  if (!pull->cords.one || !pull->side || !pull->pairs || !pull->builder.cost) return thr_nomem(err);
  for (size_t set = 0; set < sets; set++)
    pull->cords.one[set] = INFINITY;
  list_steps(&pull->builder);
  return THR_OK;
}

static void pull_sides_destroy(pull_sides *pull)
{
  free(pull->side);
  free(pull->pairs);
  free(pull->builder.cost);
  thr_few_edges_destroy(&pull->cords);
}

/* Raises *fewest to the least number of cords that pass all edges of the component, or to enough.
 */
static thr_status component_within(pull_sides *pull, int enough, int *fewest, thr_err *err)
{
  double dearest = INFINITY;
  thr_status st = pull_sides_init(pull, err);

  /* Both sides of a closed cord begin at the same node. */
  for (int v = 0;
       v < pull->builder.frame->n_nodes && !st && pull->builder.request->ends == THR_ENDS_CLOSED;
       v++)
    if (pull->component[v] == pull->number) join_sides_from(pull, v);
  if (!st && pull->builder.request->ends != THR_ENDS_CLOSED) join_sides_from(pull, -1);

  if (!st) minimize_over_supersets(&pull->cords);

  /* Fewer cords than are needed have no finite cost. */
  while (!st && *fewest < enough) {
    st = thr_few_edges_dearest(&pull->cords, *fewest, &dearest, err);
    if (st || dearest < INFINITY) break;
    ++*fewest;
  }

  pull_sides_destroy(pull);
  return st;
}

thr_status thr_few_edges_within(const thr_frame *frame, const thr_request *options, double allowed,
                                const int *enough, int *fewest, thr_err *err)
{
  thr_scratch own = {0};
  int n, *component = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *component);
  double sets = 0;

  /* Pull depends on angles, whatever the request's price of turns. */
  thr_request by_angle = *options;
  by_angle.turning.cost = THR_TURN_ANGLE;
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_frame_components(frame, component, &n, err);

  for (int c = 0; !st && c < n; c++) {
    pull_sides pull = {.builder = {.frame = frame,
                                   .request = &by_angle,
                                   .turning = true,
                                   .u_turns_anywhere = true,
                                   .limit = allowed},
                       .component = component,
                       .number = c};

    /* Closed cords take one run for each node. */
    int nodes = 0;
    pull.builder.n = list_edges(frame, component, c, pull.builder.edge);
    for (int v = 0; v < frame->n_nodes; v++)
      nodes += component[v] == c;

    /* Leave out large components, and the others once the sets are used up. */
    if (pull.builder.n == 0 || pull.builder.n > THR_FEW_SUMMED) continue;
    sets += ldexp(options->ends == THR_ENDS_CLOSED ? nodes : 1, pull.builder.n);
    if (sets <= THR_PULL_SETS) st = component_within(&pull, enough[c], &fewest[c], err);
  }

  thr_scratch_free(&own);
  return st;
}
