/* Tables over all sets of a few edges. */
#include "graph/check/few_edges.h"
#include "graph/check/check_parts.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <math.h>
#include <stdlib.h>

enum { STATES = 2 * THR_FEW_EDGES };

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  bool turning;
  int n, edge[THR_FEW_EDGES];
  double step[STATES][STATES]; /* cost of going on from one half-edge with another; INFINITY: that is not done */
  double *cost;                /* [2^n * 2 n] least to a set and half-edge */
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
  if (back && (tube || (x->turning && thr_degree(x->f, v) > 1))) return INFINITY;
  return x->turning ? thr_check_price(x->f, x->o->turning.cost, a, b) : x->f->length[x->edge[to >> 1]];
}

static double first_cost(const search *x, int s)
{
  return x->turning ? 0 : x->f->length[x->edge[s >> 1]];
}

static double *costs_at(const search *x, unsigned set)
{
  return x->cost + (size_t)set * 2 * (size_t)x->n;
}

/* Dijkstra's method over the half-edges of one set; steps to a further edge go to its set. Edges below the lowest are left out.
 */
static void settle(const search *x, unsigned set, int lowest)
{
  double *cost = costs_at(x, set);
  bool done[STATES] = {false};
  for (;;) {
    int best = -1;
    for (int s = 0; s < 2 * x->n; s++)
      if (!done[s] && cost[s] < INFINITY && (best < 0 || cost[s] < cost[best])) best = s;
    if (best < 0) return;
    done[best] = true;
    for (int s = 2 * lowest; s < 2 * x->n; s++) {
      double *to = &costs_at(x, set | 1u << (s >> 1))[s], here = cost[best] + x->step[best][s];
      if (here < *to) *to = here;
    }
  }
}

static void forget(const search *x)
{
  for (size_t i = 0; i < ((size_t)1 << x->n) * 2 * (size_t)x->n; i++)
    x->cost[i] = INFINITY;
}

static void open_cords(const search *x)
{
  forget(x);
  for (int s = 0; s < 2 * x->n; s++)
    if (thr_plan_end_allowed(x->f, x->o, thr_tail(x->f, half_of(x, s)))) costs_at(x, 1u << (s >> 1))[s] = first_cost(x, s);
  for (unsigned set = 1; set < 1u << x->n; set++) {
    settle(x, set, 0);
    for (int s = 0; s < 2 * x->n; s++)
      if (thr_plan_end_allowed(x->f, x->o, thr_head(x->f, half_of(x, s))))
        x->out->one[set] = fmin(x->out->one[set], costs_at(x, set)[s]);
  }
}

/* A closed cord, perhaps the other way round, passes its lowest edge from its first node to the second. */
static void closed_cords(const search *x)
{
  for (int i = 0; i < x->n; i++) {
    forget(x);
    costs_at(x, 1u << i)[2 * i] = first_cost(x, 2 * i);
    for (unsigned set = 1u << i; set < 1u << x->n; set += 1u << i) { /* sets without edges below i */
      if (!(set >> i & 1u)) continue;
      settle(x, set, i);
      for (int s = 2 * i; s < 2 * x->n; s++) {
        double back = x->step[s][2 * i] - (x->turning ? 0 : first_cost(x, 2 * i));
        x->out->one[set] = fmin(x->out->one[set], costs_at(x, set)[s] + back);
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

thr_status thr_few_edges_init(thr_few_edges *few, const thr_frame *frame, const thr_request *options, const int *component,
                              int number, bool turning, thr_err *err)
{
  search x = {.f = frame, .o = options, .turning = turning, .out = few};
  *few = (thr_few_edges){.n = x.n = count_edges(frame, component, number, x.edge)};
  if (x.n == 0) return THR_OK;
  few->one = thr_calloc((size_t)1 << x.n, sizeof *few->one);
  x.cost = thr_calloc(((size_t)1 << x.n) * 2 * (size_t)x.n, sizeof *x.cost);
  if (!few->one || !x.cost) {
    free(x.cost);
    thr_few_edges_destroy(few);
    return thr_nomem(err);
  }
  for (unsigned set = 0; set < 1u << x.n; set++)
    few->one[set] = INFINITY;
  for (int s = 0; s < 2 * x.n; s++)
    for (int to = 0; to < 2 * x.n; to++)
      x.step[s][to] = step_cost(&x, s, to);
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

/* ---- several cords ---- */

static double together(double one, double others, bool dearest)
{
  return dearest ? fmax(one, others) : one + others;
}

/* more[S]: one cord more than best[S] has. */
static void add_cord(const thr_few_edges *few, const double *best, bool dearest, double *more)
{
  more[0] = together(few->one[0], best[0], dearest);
  for (unsigned set = 1; set < 1u << few->n; set++) {
    unsigned lowest = set & (~set + 1), rest = set & ~lowest;
    more[set] = INFINITY;
    for (unsigned part = rest;; part = (part - 1) & rest) {
      more[set] = fmin(more[set], together(few->one[part | lowest], best[rest & ~part], dearest));
      if (part == 0) break;
    }
  }
}

/* of[k], k = 1 .. most: least cost of k cords. */
static thr_status costs_of(const thr_few_edges *few, int most, bool dearest, double *of, thr_err *err)
{
  thr_scratch own = {0};
  size_t sets = (size_t)1 << few->n;
  double *best = thr_scratch_array(&own, sets, sizeof *best), *more = thr_scratch_array(&own, sets, sizeof *more);
  thr_status st = thr_scratch_check(&own, err);
  for (size_t set = 0; set < sets && !st; set++)
    best[set] = few->one[set];
  for (int n = 1; n <= most && !st; n++) {
    of[n] = best[sets - 1];
    add_cord(few, best, dearest, more);
    double *swap = best;
    best = more;
    more = swap;
  }
  thr_scratch_free(&own);
  return st;
}

thr_status thr_few_edges_least(const thr_few_edges *few, int least, int most, bool dearest, double *cost, thr_err *err)
{
  double of[THR_FEW_EDGES + 1];
  int n = few->n;
  thr_status st = costs_of(few, most < n ? most : n, dearest, of, err);
  *cost = INFINITY;
  for (int k = least; k <= most && !st; k++) {
    double here = of[k < n ? k : n];
    if (k > n) here = dearest ? fmax(here, few->one[0]) : here + (k - n) * few->one[0];
    *cost = fmin(*cost, here);
    if (k > n) break; /* more cords than edges only cost more */
  }
  return st;
}

/* ---- all components ---- */

/* Cords that component number may have. */
static void cords_of(const thr_frame *frame, const thr_request *options, const int *component, int number, int *least, int *most)
{
  int ends = 0;
  *least = thr_plan_cords_least(options);
  *most = options->cords;
  if (options->ends != THR_ENDS_COUNTS) return;
  for (int v = 0; v < frame->n_nodes; v++)
    ends += component[v] == number ? options->end_count[v] : 0;
  *least = *most = ends / 2;
}

thr_status thr_few_edges_bounds(const thr_frame *frame, const thr_request *options, bool turning, double *sum, double *dearest,
                                thr_err *err)
{
  thr_scratch own = {0};
  int n, sets = THR_FEW_SETS, *component = thr_scratch_array(&own, (size_t)frame->n_nodes, sizeof *component);
  bool all = true;
  *sum = *dearest = 0;
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_frame_components(frame, component, &n, err);
  for (int c = 0; !st && c < n; c++) {
    thr_few_edges few = {0};
    double worst = 0, total = 0;
    int least, most;
    cords_of(frame, options, component, c, &least, &most);
    if (most > 1) st = thr_few_edges_init(&few, frame, options, component, c, turning, err);
    bool small = few.n > 0 && 1 << few.n <= sets;
    if (small) sets -= 1 << few.n;
    if (!st && small) st = thr_few_edges_least(&few, least, most, true, &worst, err);
    if (!st && small) st = thr_few_edges_least(&few, least, most, false, &total, err);
    all &= small;
    *dearest = fmax(*dearest, worst);
    *sum += total;
    thr_few_edges_destroy(&few);
  }
  if (!all) *sum = 0;
  thr_scratch_free(&own);
  return st;
}
