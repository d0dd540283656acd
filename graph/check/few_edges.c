/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least of several cords through a component of few edges, without a proof: all sets of edges
 * are tried. Private to the checker.
 *
 *   one[S]: least cost of a cord that passes at least the edges S. States are (set passed so far,
 * half-edge passed last); sets only grow, so they are settled in ascending order, each by
 * Dijkstra's method. The dearest of n cords costs at most L if the sets of one[S] <= L have n whose
 * union is everything. The unions of a set of one family and a set of another are those that some
 * pair makes; pairs are counted by their zeta transforms over all subsets, which are multiplied, in
 * 2^n n (A. Bjoerklund, T. Husfeldt & M. Koivisto, "Set partitioning via inclusion-exclusion", SIAM
 * J. Computing 39, 2009). L is found by bisection.
 *   In all: best_n[S] = min over T in S with its lowest edge of one[T] + best_(n-1)[S - T] (M. Held
 * & R. M. Karp 1962, with walks). All covers count as 1, and nothing else that couples cords is
 * asked: lower bounds then.
 *
 * Example: a ring of four unit edges, two open cords, ends anywhere: 4 together, the longer one 2.
 */
#include "graph/check/edge_sets.h"
#include "graph/check/check_parts.h"
#include "graph/sort.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { STATES = 2 * THR_FEW_EDGES };

/* Going on from one half-edge with another. */
typedef struct {
  int to;
  double cost;
} step;

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  bool turning;
  bool back_anywhere; /* by turning: also at nodes with other edges */
  double limit;
  int n, edge[THR_FEW_EDGES];
  int first[STATES + 1]; /* steps of state s: step[first[s]] .. step[first[s + 1] - 1] */
  step step[STATES * STATES];
  double *cost; /* [2^n * 2 n] least to a set and half-edge */
  thr_few_edges *out;
} search;

/* The half-edge of the framework that state s stands for. */
static int half_of(const search *x, int s)
{
  return 2 * x->edge[s >> 1] + (s & 1);
}

static double step_cost(const search *x, int from, int to)
{
  int a = half_of(x, from), b = half_of(x, to), v = thr_tail(x->f, b);
  bool back = b == (a ^ 1), tube = x->o->joint == THR_JOINT_TUBE;
  if (thr_head(x->f, a) != v) return INFINITY;
  if (back && (tube || (x->turning && !x->back_anywhere && thr_degree(x->f, v) > 1)))
    return INFINITY;
  return x->turning ? thr_check_price(x->f, x->o->turning.cost, a, b)
                    : x->f->length[x->edge[to >> 1]];
}

static double first_cost(const search *x, int s)
{
  return x->turning ? 0 : x->f->length[x->edge[s >> 1]];
}

static double *costs_at(const search *x, unsigned set)
{
  return x->cost + (size_t)set * 2 * (size_t)x->n;
}

static void list_steps(search *x)
{
  int n = 0;
  for (int s = 0; s < 2 * x->n; s++) {
    x->first[s] = n;
    for (int to = 0; to < 2 * x->n; to++) {
      double cost = step_cost(x, s, to);
      if (cost < INFINITY) x->step[n++] = (step){to, cost};
    }
  }
  x->first[2 * x->n] = n;
}

/* Dijkstra's method over the half-edges of one set; steps to a further edge go to its set. Edges
 * below the lowest are left out.
 */
static void settle(const search *x, unsigned set, int lowest)
{
  double *cost = costs_at(x, set);
  bool done[STATES] = {false};
  for (;;) {
    int best = -1;
    for (int s = 2 * lowest; s < 2 * x->n; s++)
      if (!done[s] && cost[s] < INFINITY && (best < 0 || cost[s] < cost[best])) best = s;
    if (best < 0) return;
    done[best] = true;
    for (int k = x->first[best]; k < x->first[best + 1]; k++) {
      int s = x->step[k].to;
      double *to = &costs_at(x, set | 1u << (s >> 1))[s], here = cost[best] + x->step[k].cost;
      if (s >= 2 * lowest && here < *to && here <= x->limit) *to = here;
    }
  }
}

/* The sets of edges from the lowest on: one after the other. */
static unsigned next_set(unsigned set, int lowest)
{
  return set + (1u << lowest);
}

static void forget(const search *x, int lowest)
{
  for (unsigned set = 0; set < 1u << x->n; set = next_set(set, lowest))
    for (int s = 0; s < 2 * x->n; s++)
      costs_at(x, set)[s] = INFINITY;
}

static void open_cords(const search *x)
{
  forget(x, 0);
  for (int s = 0; s < 2 * x->n; s++)
    if (thr_plan_end_allowed(x->f, x->o, thr_tail(x->f, half_of(x, s))))
      costs_at(x, 1u << (s >> 1))[s] = first_cost(x, s);
  for (unsigned set = 1; set < 1u << x->n; set++) {
    settle(x, set, 0);
    for (int s = 0; s < 2 * x->n; s++)
      if (thr_plan_end_allowed(x->f, x->o, thr_head(x->f, half_of(x, s))) &&
          costs_at(x, set)[s] <= x->limit)
        x->out->one[set] = fmin(x->out->one[set], costs_at(x, set)[s]);
  }
}

/* A closed cord, perhaps the other way round, passes its lowest edge from its first node to the
 * second. */
static void closed_cords(const search *x)
{
  for (int i = 0; i < x->n; i++) {
    forget(x, i);
    costs_at(x, 1u << i)[2 * i] = first_cost(x, 2 * i);
    for (unsigned set = 1u << i; set < 1u << x->n; set = next_set(set, i)) {
      if (!(set >> i & 1u)) continue;
      settle(x, set, i);
      for (int s = 2 * i; s < 2 * x->n; s++) {
        double cost =
            costs_at(x, set)[s] + step_cost(x, s, 2 * i) - (x->turning ? 0 : first_cost(x, 2 * i));
        if (cost <= x->limit) x->out->one[set] = fmin(x->out->one[set], cost);
      }
    }
  }
}

/* Passing more does no harm: the least over all larger sets. */
static void take_supersets(thr_few_edges *few)
{
  for (int i = 0; i < few->n; i++)
    for (unsigned set = 0; set < 1u << few->n; set++)
      if (!(set >> i & 1u)) few->one[set] = fmin(few->one[set], few->one[set | 1u << i]);
}

static int count_edges(const thr_frame *frame, const int *component, int number, int *edge)
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
  search x = {.f = frame, .o = options, .turning = turning, .limit = limit, .out = few};
  *few = (thr_few_edges){.n = x.n = count_edges(frame, component, number, x.edge)};
  if (x.n > 0 && 1 << x.n > sets) few->n = 0;
  if (few->n == 0) return THR_OK;
  if (x.n <= THR_FEW_SUMMED) x.limit = INFINITY;
  few->one = thr_calloc((size_t)1 << x.n, sizeof *few->one);
  x.cost = thr_calloc(((size_t)1 << x.n) * 2 * (size_t)x.n, sizeof *x.cost);
  if (!few->one || !x.cost) {
    free(x.cost);
    thr_few_edges_destroy(few);
    return thr_nomem(err);
  }
  for (unsigned set = 0; set < 1u << x.n; set++)
    few->one[set] = INFINITY;
  list_steps(&x);
  if (options->ends == THR_ENDS_CLOSED)
    closed_cords(&x);
  else
    open_cords(&x);
  take_supersets(few);
  free(x.cost);
  return THR_OK;
}

void thr_few_edges_destroy(thr_few_edges *few)
{
  free(few->one);
  *few = (thr_few_edges){0};
}

/* ---- the dearest of several cords ---- */

/* Families of sets that hold all parts of their sets, as 0 or 1 for each set. */
typedef struct {
  int n;
  size_t sets;
  int64_t *some, *all,
      *half; /* [sets] the sets below a limit; unions of some of them; of half of all */
  int64_t *other, *product; /* [sets] while unions are made */
  thr_scratch own;          /* the arrays */
} families;

/* Sums over all parts of every set; or back. */
static void add_parts(int64_t *f, int n, int64_t sign)
{
  for (int i = 0; i < n; i++)
    for (size_t block = 0; block < (size_t)1 << n; block += (size_t)2 << i)
      for (size_t k = block; k < block + ((size_t)1 << i); k++)
        f[k + ((size_t)1 << i)] += sign * f[k];
}

/* *of: the unions of two of its sets; or of one of them and one below the limit. There are at most
 * 4^n pairs. */
static void unite(families *x, bool itself)
{
  memcpy(x->product, x->all, x->sets * sizeof *x->product);
  memcpy(x->other, itself ? x->all : x->some, x->sets * sizeof *x->other);
  add_parts(x->product, x->n, 1);
  add_parts(x->other, x->n, 1);
  for (size_t set = 0; set < x->sets; set++)
    x->product[set] *= x->other[set];
  add_parts(x->product, x->n, -1);
  for (size_t set = 0; set < x->sets; set++)
    x->all[set] = x->product[set] > 0;
}

/* Do so many cords, none above the limit, pass everything? Half of them pass a set, and the others
 * what is left. */
static bool suffice(families *x, const thr_few_edges *few, int cords, double limit)
{
  const int half = cords / 2;
  int highest = 1;
  for (size_t set = 0; set < x->sets; set++)
    x->some[set] = x->all[set] = few->one[set] <= limit;
  if (half == 0) return x->some[x->sets - 1];
  while (2 * highest <= half)
    highest *= 2;
  for (int bit = highest / 2; bit > 0; bit /= 2) {
    unite(x, true);
    if (half & bit) unite(x, false);
  }
  memcpy(x->half, x->all, x->sets * sizeof *x->half);
  if (cords % 2) unite(x, false);
  for (size_t set = 0; set < x->sets; set++)
    if (x->half[set] && x->all[x->sets - 1 - set]) return true;
  return false;
}

thr_status thr_few_edges_costs(const thr_few_edges *few, double **value, size_t *n, thr_err *err)
{
  size_t sets = (size_t)1 << few->n, all = 0;
  *n = 0;
  if (!(*value = thr_calloc(sets, sizeof **value))) return thr_nomem(err);
  for (size_t set = 0; set < sets; set++)
    if (few->one[set] < INFINITY) (*value)[all++] = few->one[set];
  thr_sort_doubles(*value, all);
  for (size_t k = 0; k < all; k++)
    if (*n == 0 || (*value)[k] > (*value)[*n - 1]) (*value)[(*n)++] = (*value)[k];
  return THR_OK;
}

thr_status thr_few_edges_dearest(const thr_few_edges *few, int cords, double *cost, thr_err *err)
{
  families x = {.n = few->n, .sets = (size_t)1 << few->n};
  size_t low = 0, n = 0;
  double *value = NULL;
  x.some = thr_scratch_array(&x.own, x.sets, sizeof *x.some);
  x.all = thr_scratch_array(&x.own, x.sets, sizeof *x.all);
  x.half = thr_scratch_array(&x.own, x.sets, sizeof *x.half);
  x.other = thr_scratch_array(&x.own, x.sets, sizeof *x.other);
  x.product = thr_scratch_array(&x.own, x.sets, sizeof *x.product);
  if (cords > few->n) cords = few->n; /* more cords than edges cost no less */
  thr_status st = thr_scratch_check(&x.own, err);
  if (!st) st = thr_few_edges_costs(few, &value, &n, err);
  for (size_t high = n; !st && low < high;) {
    size_t middle = low + (high - low) / 2;
    if (suffice(&x, few, cords, value[middle]))
      high = middle;
    else
      low = middle + 1;
  }
  *cost = !st && low < n ? value[low] : (double)INFINITY;
  free(value);
  thr_scratch_free(&x.own);
  return st;
}

/* ---- several cords in all ---- */

/* more[S]: one cord more than best[S] has. */
static void add_cord(const thr_few_edges *few, const double *best, double *more)
{
  more[0] = few->one[0] + best[0];
  for (unsigned set = 1; set < 1u << few->n; set++) {
    unsigned lowest = set & (~set + 1), rest = set & ~lowest;
    more[set] = INFINITY;
    for (unsigned part = rest;; part = (part - 1) & rest) {
      more[set] = fmin(more[set], few->one[part | lowest] + best[rest & ~part]);
      if (part == 0) break;
    }
  }
}

/* of[k], k = 1 .. most: least cost of k cords. */
static thr_status costs_of(const thr_few_edges *few, int most, double *of, thr_err *err)
{
  thr_scratch own = {0};
  size_t sets = (size_t)1 << few->n;
  double *best = thr_scratch_array(&own, sets, sizeof *best),
         *more = thr_scratch_array(&own, sets, sizeof *more);
  thr_status st = thr_scratch_check(&own, err);
  for (size_t set = 0; set < sets && !st; set++)
    best[set] = few->one[set];
  for (int n = 1; n <= most && !st; n++) {
    of[n] = best[sets - 1];
    add_cord(few, best, more);
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
  double of[THR_FEW_SUMMED + 1];
  int n = few->n;
  thr_status st = costs_of(few, most < n ? most : n, of, err);
  *cost = INFINITY;
  for (int k = least; k <= most && !st; k++) {
    *cost = fmin(*cost, k > n ? of[n] + (k - n) * few->one[0] : of[k]);
    if (k > n) break; /* more cords than edges only cost more */
  }
  return st;
}

/* ---- all components ---- */

void thr_few_edges_cords(const thr_frame *frame, const thr_request *options, const int *component,
                         int number, int *least, int *most)
{
  int ends = 0;
  *least = thr_plan_cords_least(options);
  *most = options->cords;
  if (options->ends != THR_ENDS_COUNTS) return;
  for (int v = 0; v < frame->n_nodes; v++)
    ends += component[v] == number ? options->end_count[v] : 0;
  *least = *most = ends / 2;
}

/* Edges of each component. */
static thr_status count_all_edges(const thr_frame *frame, const int *component, int n_components,
                                  int **edges, thr_err *err)
{
  if (!(*edges = thr_calloc((size_t)n_components, sizeof **edges))) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges; e++)
    (*edges)[component[frame->edge[e][0]]]++;
  return THR_OK;
}

/* Forgets the cords that are too long for what is asked. */
static void keep_to_length(thr_few_edges *few, const thr_request *options)
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
    if (edges[c] > THR_FEW_SUMMED) continue;
    thr_few_edges_cords(frame, options, component, c, &from, &to);
    if (cords) to = cords[c];
    if (to > 1)
      st = thr_few_edges_init(&few, frame, options, component, c, false, INFINITY, sets, err);
    if (few.n > 0) sets -= 1 << few.n;
    if (!st) keep_to_length(&few, options);
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
    thr_few_edges_cords(frame, options, component, c, &least, &most);
    if (most > 1)
      st = thr_few_edges_init(&few, frame, options, component, c, true, limit, sets, err);
    if (few.n > 0) sets -= 1 << few.n;
    bool summed = few.n > 0 && few.n <= THR_FEW_SUMMED;
    if (!st && few.n > 0) st = thr_few_edges_dearest(&few, most, &worst, err);
    if (!st && summed) st = thr_few_edges_sum(&few, least, most, &total, err);
    all &= summed;
    *dearest = fmax(*dearest, worst);
    *sum += total;
    thr_few_edges_destroy(&few);
  }
  if (!all) *sum = 0;
  thr_scratch_free(&own);
  return st;
}

/* ---- within a pull ---- */

/* What the sides of cords from one end, or from any, pass. */
typedef struct {
  search x;
  const int *component;
  int number;
  int64_t *side, *pairs; /* [2^n] sets that sides to one node pass; pairs of them with this union */
  thr_few_edges cords;   /* one[S] is 0 where a cord within the pull passes S, else INFINITY */
} pulled;

static void begin_sides(pulled *p, int home)
{
  forget(&p->x, 0);
  for (int s = 0; s < 2 * p->x.n; s++) {
    const int v = thr_tail(p->x.f, half_of(&p->x, s));
    if (home < 0 ? thr_plan_end_allowed(p->x.f, p->x.o, v) : v == home)
      costs_at(&p->x, 1u << (s >> 1))[s] = 0;
  }
  for (unsigned set = 1; set < 1u << p->x.n; set++)
    settle(&p->x, set, 0);
}

/* Notes the unions of two sets that sides to node v pass. */
static void join_sides(pulled *p, int v)
{
  const unsigned sets = 1u << p->x.n;
  for (unsigned set = 0; set < sets; set++) {
    p->side[set] = 0;
    for (int s = 0; s < 2 * p->x.n; s++)
      if (thr_head(p->x.f, half_of(&p->x, s)) == v && costs_at(&p->x, set)[s] <= p->x.limit)
        p->side[set] = 1;
  }
  memcpy(p->pairs, p->side, sets * sizeof *p->pairs);
  add_parts(p->pairs, p->x.n, 1);
  for (unsigned set = 0; set < sets; set++)
    p->pairs[set] *= p->pairs[set];
  add_parts(p->pairs, p->x.n, -1);
  for (unsigned set = 0; set < sets; set++)
    if (p->pairs[set] > 0) p->cords.one[set] = 0;
}

static void join_all(pulled *p, int home)
{
  begin_sides(p, home);
  for (int v = 0; v < p->x.f->n_nodes; v++)
    if (p->component[v] == p->number) join_sides(p, v);
}

static thr_status pulled_init(pulled *p, thr_err *err)
{
  const size_t sets = (size_t)1 << p->x.n;
  p->cords.n = p->x.n;
  p->cords.one = thr_calloc(sets, sizeof *p->cords.one);
  p->side = thr_calloc(sets, sizeof *p->side);
  p->pairs = thr_calloc(sets, sizeof *p->pairs);
  p->x.cost = thr_calloc(sets * 2 * (size_t)p->x.n, sizeof *p->x.cost);
  if (!p->cords.one || !p->side || !p->pairs || !p->x.cost) return thr_nomem(err);
  for (size_t set = 0; set < sets; set++)
    p->cords.one[set] = INFINITY;
  list_steps(&p->x);
  return THR_OK;
}

static void pulled_destroy(pulled *p)
{
  free(p->side);
  free(p->pairs);
  free(p->x.cost);
  thr_few_edges_destroy(&p->cords);
}

/* Raises *fewest to the number of cords that pass all edges of the component, or to enough. */
static thr_status component_within(pulled *p, int enough, int *fewest, thr_err *err)
{
  double dearest = INFINITY;
  thr_status st = pulled_init(p, err);
  for (int v = 0; v < p->x.f->n_nodes && !st && p->x.o->ends == THR_ENDS_CLOSED; v++)
    if (p->component[v] == p->number) join_all(p, v);
  if (!st && p->x.o->ends != THR_ENDS_CLOSED) join_all(p, -1);
  if (!st) take_supersets(&p->cords);
  while (!st && *fewest < enough) {
    st = thr_few_edges_dearest(&p->cords, *fewest, &dearest, err);
    if (st || dearest < INFINITY) break;
    ++*fewest;
  }
  pulled_destroy(p);
  return st;
}

thr_status thr_few_edges_within(const thr_frame *frame, const thr_request *options, double allowed,
                                const int *enough, int *fewest, thr_err *err)
{
  thr_scratch own = {0};
  int n, *component = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *component);
  double sets = 0;
  thr_request by_angle = *options;
  by_angle.turning.cost = THR_TURN_ANGLE;
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_frame_components(frame, component, &n, err);
  for (int c = 0; !st && c < n; c++) {
    pulled p = {
        .x = {.f = frame, .o = &by_angle, .turning = true, .back_anywhere = true, .limit = allowed},
        .component = component,
        .number = c};
    int nodes = 0;
    p.x.n = count_edges(frame, component, c, p.x.edge);
    for (int v = 0; v < frame->n_nodes; v++)
      nodes += component[v] == c;
    if (p.x.n == 0 || p.x.n > THR_FEW_SUMMED) continue;
    sets += ldexp(options->ends == THR_ENDS_CLOSED ? nodes : 1, p.x.n);
    if (sets <= THR_PULL_SETS) st = component_within(&p, enough[c], &fewest[c], err);
  }
  thr_scratch_free(&own);
  return st;
}
