/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords of small components by a table over subsets, against all walks (tests/walks.h): length and
 * turning, together and the dearest, the fewest under a limit, for all ends, covers, capacities and
 * joints. */
#include "graph/threading/threading.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/walks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CORDS = 4 };

typedef struct {
  thr_frame f;
  thr_request o;
  bool turning;
  int cords;
  walks_piece w; /* the oracle's */
} example;

static void random_ends(rng *r, example *x)
{
  thr_request *o = &x->o;
  size_t n = (size_t)x->f.n_nodes;
  if (o->ends == THR_ENDS_NODES) {
    o->end_node = calloc(n, sizeof *o->end_node);
    ck_assert_ptr_nonnull(o->end_node);
    for (int i = 0; i < 2; i++)
      o->end_node[rng_below(r, x->f.n_nodes)] = true;
  }
  if (o->ends == THR_ENDS_COUNTS) {
    o->end_count = calloc(n, sizeof *o->end_count);
    ck_assert_ptr_nonnull(o->end_count);
    for (int i = 0; i < 2 * x->cords; i++)
      o->end_count[rng_below(r, x->f.n_nodes)]++;
  }
}

/* *known false: too large for the oracle. */
static example random_example(rng *r, bool *known)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_CLOSED, THR_ENDS_ANY,
                                  THR_ENDS_FEET,   THR_ENDS_NODES,  THR_ENDS_COUNTS};
  const bool tube = rng_below(r, 3) == 0;
  int nodes = rng_between(r, tube ? 3 : 2, 5);
  example x = {.f = random_frame(r, nodes, rng_below(r, 8 - nodes),
                                 (length_kind)rng_below(r, LENGTH_KINDS))};
  x.o = options_for(ends[rng_below(r, 6)], rng_below(r, 4) ? 1 : 2);
  x.o.joint = tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  x.o.capacity = rng_below(r, 3) ? 0 : x.o.cover + rng_below(r, 3);
  x.o.turning.cost = (thr_turn_cost)rng_below(r, THR_N_TURN_COSTS);
  x.turning = rng_below(r, 2);
  x.cords = rng_between(r, 1, 3);
  random_ends(r, &x);
  const walks_back back = tube ? BACK_NEVER : x.turning ? BACK_AT_LEAVES : BACK_ANYWHERE;
  *known = walks_piece_init(&x.w, &x.f, &x.o, 0, back, x.o.turning.cost, INFINITY, 1000);
  return x;
}

static void example_destroy(example *x)
{
  free(x->o.end_node);
  free(x->o.end_count);
  thr_frame_destroy(&x->f);
}

/* ---- the oracle ---- */

/* Least cost of 1 .. most cords, limit as in walks_one_more. */
static void all_least(const example *x, int most, double limit, double *least)
{
  const walks_weights by = {.length = !x->turning, .turn = x->turning};
  double *in = calloc((size_t)x->w.n_states, sizeof *in),
         *out = calloc((size_t)x->w.n_states, sizeof *out);
  ck_assert(in != NULL && out != NULL);
  walks_begin(&x->w, in);
  for (int n = 1; n <= most; n++) {
    double *swap = in;
    walks_one_more(&x->w, by, limit, in, out);
    in = out;
    out = swap;
    least[n] = walks_least(&x->w, in);
  }
  free(in);
  free(out);
}

static bool is_possible(const example *x, int n, double limit)
{
  double least[MOST_CORDS + 1];
  all_least(x, n, limit, least);
  return isfinite(least[n]);
}

/* ---- the cords ---- */

static double cost_of(const example *x, const int *half, int n)
{
  double cost = 0;
  const bool closed = x->o.ends == THR_ENDS_CLOSED;
  for (int i = 0; i < n; i++) {
    ck_assert(i + 1 < n || closed ? thr_head(&x->f, half[i]) == thr_tail(&x->f, half[(i + 1) % n])
                                  : true);
    if (!x->turning) cost += x->f.length[half[i] >> 1];
    if (x->turning && (i + 1 < n || closed))
      cost += walks_price(&x->f, x->o.turning.cost, half[i], half[(i + 1) % n]);
  }
  return cost;
}

/* Do the turns tie the edges at every node? */
static bool tie_nodes(const example *x, const thr_small_cords *c)
{
  int part[2 * WALKS_EDGES];
  for (int h = 0; h < 2 * x->f.n_edges; h++)
    part[h] = h;
  for (int round = 0; round < 2 * x->f.n_edges; round++)
    for (int i = 0; i < c->n; i++)
      for (int j = x->o.ends == THR_ENDS_CLOSED ? 0 : 1; j < c->n_passes[i]; j++) {
        const int in = c->half[i][j ? j - 1 : c->n_passes[i] - 1] ^ 1, out = c->half[i][j];
        const int low = part[in] < part[out] ? part[in] : part[out];
        part[in] = part[out] = low;
      }
  for (int g = 0; g < 2 * x->f.n_edges; g++)
    for (int h = 0; h < g; h++)
      if (thr_tail(&x->f, g) == thr_tail(&x->f, h) && part[g] != part[h]) return false;
  return true;
}

/* Are they what is asked for? Their costs: the dearest and all. */
static void judge_cords(const example *x, const thr_small_cords *c, double *dearest, double *sum)
{
  const thr_frame *f = &x->f;
  int passes[WALKS_EDGES] = {0}, ends[WALKS_NODES] = {0};
  *dearest = *sum = 0;
  for (int i = 0; i < c->n; i++) {
    const int *half = c->half[i], n = c->n_passes[i];
    double cost = cost_of(x, half, n);
    *dearest = fmax(*dearest, cost);
    *sum += cost;
    for (int j = 0; j < n; j++)
      passes[half[j] >> 1]++;
    ends[thr_tail(f, half[0])]++;
    ends[thr_head(f, half[n - 1])]++;
  }
  for (int e = 0; e < f->n_edges; e++) {
    ck_assert_int_ge(passes[e], walks_cover(f, &x->o, e));
    ck_assert_int_le(passes[e], walks_capacity(f, &x->o, e));
  }
  for (int v = 0; v < f->n_nodes && x->o.ends != THR_ENDS_CLOSED; v++) {
    if (ends[v]) ck_assert(walks_may_end(f, &x->o, v));
    if (x->o.ends == THR_ENDS_COUNTS) ck_assert_int_eq(ends[v], x->o.end_count[v]);
  }
  if (x->o.joint == THR_JOINT_TUBE) ck_assert(tie_nodes(x, c));
}

/* Asks; false: not certain. */
static bool ask_for(const example *x, thr_small_ask ask, thr_small_cords *out)
{
  bool certain;
  ask.turning = x->turning;
  ck_assert_int_eq(thr_small_cords_find(&x->f, &x->o, &ask, &(thr_limits){0}, out, &certain, NULL),
                   THR_OK);
  return certain;
}

/* ---- the questions ---- */

static bool compare_sum(const example *x)
{
  thr_small_cords c;
  double least[MOST_CORDS + 1], dearest, sum;
  if (!ask_for(x, (thr_small_ask){.least = x->cords, .most = x->cords, .limit = INFINITY}, &c))
    return false;
  all_least(x, x->cords, -1, least);
  ck_assert_int_eq(c.n, isfinite(least[x->cords]) ? x->cords : 0);
  if (c.n) {
    judge_cords(x, &c, &dearest, &sum);
    ck_assert_double_eq_tol(sum, least[x->cords], 1e-9 * (1 + sum));
  }
  thr_small_cords_destroy(&c);
  return true;
}

/* And what is known to be as good is not given again. */
static bool compare_dearest(const example *x)
{
  thr_small_cords c, again;
  double dearest, sum;
  thr_small_ask ask = {.least = x->cords, .most = x->cords, .even = true, .limit = INFINITY};
  if (!ask_for(x, ask, &c)) return false;
  if (c.n == 0) ck_assert(!is_possible(x, x->cords, 1e9));
  if (c.n) {
    judge_cords(x, &c, &dearest, &sum);
    ck_assert(is_possible(x, x->cords, dearest + 1e-9));
    if (dearest > 1e-3) ck_assert(!is_possible(x, x->cords, dearest * (1 - 1e-6)));
    ask.known = c.n;
    ask.known_dearest = dearest;
    ask.known_sum = sum;
    ck_assert(ask_for(x, ask, &again) && again.n == 0);
  }
  thr_small_cords_destroy(&c);
  return true;
}

static bool compare_fewest(rng *r, const example *x)
{
  thr_small_cords c;
  double one[MOST_CORDS + 1], dearest, sum;
  all_least(x, 1, -1, one);
  const bool counts = x->o.ends == THR_ENDS_COUNTS;
  const double limit = (isfinite(one[1]) ? one[1] : 5) * (0.2 + rng_unit(r));
  const int least = counts ? x->cords : 1, most = counts ? x->cords : MOST_CORDS;
  int few = least;
  if (!ask_for(x, (thr_small_ask){.least = least, .most = most, .limit = limit}, &c)) return false;
  while (few <= most && !is_possible(x, few, limit))
    few++;
  ck_assert_int_eq(c.n, few <= most ? few : 0);
  if (c.n) {
    judge_cords(x, &c, &dearest, &sum);
    ck_assert_double_le(dearest, limit * (1 + 1e-9));
  }
  thr_small_cords_destroy(&c);
  return true;
}

START_TEST(tables_and_walks_agree)
{
  rng r = rng_make((uint64_t)_i + 7000);
  int asked = 0, certain = 0;
  while (asked < 90) {
    bool known;
    example x = random_example(&r, &known);
    if (known) {
      asked += 3;
      certain += compare_sum(&x);
      certain += compare_dearest(&x);
      certain += compare_fewest(&r, &x);
    }
    example_destroy(&x);
  }
  ck_assert_int_ge(certain, asked - 18);
}
END_TEST

START_TEST(every_allocation_may_fail)
{
  thr_frame f = wheel_make(4);
  thr_request o = options_for(_i ? THR_ENDS_CLOSED : THR_ENDS_ANY, 1);
  thr_status st = THR_ENOMEM;
  o.joint = _i ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  o.capacity = _i ? 0 : 2;
  for (long k = 1; st != THR_OK; k++) {
    thr_small_cords c;
    bool certain;
    const thr_small_ask ask = {.least = 2, .most = 3, .even = true, .limit = INFINITY};
    thr_alloc_fail_at(k);
    st = thr_small_cords_find(&f, &o, &ask, &(thr_limits){0}, &c, &certain, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_ENOMEM ? c.n == 0 && !certain : st == THR_OK && c.n >= 2);
    thr_small_cords_destroy(&c);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A cube has 12 edges, more than the walks of the oracle. All 8 nodes are odd, four stay so where
 * two cords end: two edges are passed twice. */
START_TEST(a_cube_and_two_cords_by_hand)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_small_cords c;
  bool certain;
  const thr_small_ask ask = {.least = 2, .most = 2, .even = true, .limit = INFINITY};
  ck_assert_int_eq(thr_small_cords_find(&f, &o, &ask, &(thr_limits){0}, &c, &certain, NULL),
                   THR_OK);
  ck_assert(certain && c.n == 2);
  ck_assert_int_eq(c.n_passes[0] + c.n_passes[1], 14);
  ck_assert_int_eq(c.n_passes[0], 7);
  thr_small_cords_destroy(&c);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("small cords");
  ADD_EXAMPLES(s, 60, tables_and_walks_agree, 40);
  ADD_TEST(s, 10, a_cube_and_two_cords_by_hand);
  ADD_LOOP(s, 60, every_allocation_may_fail, 0, 2);
  return run_suite(s);
}
