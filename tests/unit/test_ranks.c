/* Connections counted exactly at nodes: forests against all sets of turns, and what they prove of a sphere. */
#include "graph/framework/frame.h"
#include "graph/framework/make.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/turning_ranks.h"
#include "tests/support.h"
#include "tortuosity/proof/pass_matching.h"
#include "tortuosity/proof/ranks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- one node ---- */

typedef struct {
  thr_rank_node node;
  int64_t value[3];
  int block[3][THR_RANK_DEGREE];
} example;

static void example_make(rng *r, example *x)
{
  *x = (example){.node = {.degree = rng_between(r, 2, 5), .n_rows = rng_below(r, 4)}};
  x->node.value = x->value;
  x->node.block = x->block;
  for (int a = 0; a < x->node.degree; a++)
    for (int b = 0; b < a; b++)
      x->node.price[a][b] = x->node.price[b][a] = rng_below(r, 12);
  for (int i = 0; i < 3; i++) {
    x->value[i] = rng_below(r, 9);
    for (int a = 0; a < x->node.degree; a++)
      x->block[i][a] = 7 * rng_below(r, x->node.degree);
  }
}

/* Sets that n things fall into when those that are marked are together; the marks are completed. */
static int count_sets(bool (*together)[THR_RANK_DEGREE], int n)
{
  int sets = 0;
  for (int by = 0; by < n; by++)
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++)
        together[a][b] |= together[a][by] && together[by][b];
  for (int a = 0; a < n; a++) {
    bool first = true;
    for (int b = 0; b < a; b++)
      first &= !together[a][b];
    sets += first;
  }
  return sets;
}

/* The rank by its definition, for the turns whose bits are set, numbered as pairs a < b. */
static int rank_by_definition(const example *x, int row, int turns)
{
  bool together[THR_RANK_DEGREE][THR_RANK_DEGREE] = {{false}};
  int n = x->node.degree, pair = 0;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++)
      together[a][b] = x->block[row][a] == x->block[row][b];
  int blocks = count_sets(together, n);
  for (int a = 0; a < n; a++)
    for (int b = a + 1; b < n; b++, pair++)
      if (turns >> pair & 1) together[a][b] = together[b][a] = true;
  return blocks - count_sets(together, n);
}

static int64_t least_by_trying(const example *x)
{
  int n = x->node.degree;
  int64_t least = INT64_MAX;
  for (int turns = 0; turns < 1 << n * (n - 1) / 2; turns++) {
    int64_t price = 0;
    int pair = 0, reached = 0;
    for (int a = 0; a < n; a++)
      for (int b = a + 1; b < n; b++, pair++)
        if (turns >> pair & 1) {
          price += x->node.price[a][b];
          reached |= 1 << a | 1 << b;
        }
    if (reached != (1 << n) - 1) continue;
    for (int i = 0; i < x->node.n_rows; i++)
      price -= x->value[i] * rank_by_definition(x, i, turns);
    if (price < least) least = price;
  }
  return least;
}

START_TEST(a_forest_is_the_least_of_all_turns)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int round = 0; round < 25; round++) {
    example x;
    thr_rank_turns turns;
    example_make(&r, &x);
    int64_t least = thr_rank_least(&x.node, &turns), price = 0;
    ck_assert_int_eq(least, least_by_trying(&x));
    ck_assert_int_eq(least, thr_rank_least(&x.node, NULL));
    for (int i = 0; i < turns.n_turns; i++)
      price += x.node.price[turns.turn[i][0]][turns.turn[i][1]];
    for (int i = 0; i < x.node.n_rows; i++)
      price -= x.value[i] * thr_rank_of(&x.node, i, &turns);
    ck_assert_int_eq(price, least);
  }
}
END_TEST

/* The largest numbers that a proof may have, at the largest node: sums stay in 64 bits. */
START_TEST(the_largest_numbers_fit)
{
  example x = {.node = {.degree = THR_RANK_DEGREE, .n_rows = 1}, .value = {INT64_C(1) << 58}};
  x.node.value = x.value;
  x.node.block = x.block;
  for (int a = 0; a < THR_RANK_DEGREE; a++) {
    x.block[0][a] = a;
    for (int b = 0; b < THR_RANK_DEGREE; b++)
      x.node.price[a][b] = INT64_C(1) << 58;
  }
  ck_assert_int_eq(thr_rank_least(&x.node, NULL), 0); /* a tree gains what it costs */
  x.value[0] = 0;
  ck_assert_int_eq(thr_rank_least(&x.node, NULL), INT64_C(1) << 60); /* four turns */
}
END_TEST

/* ---- a framework ---- */

typedef struct {
  thr_frame frame;
  thr_turning_task task;
  thr_turning_columns c;
  int *x;
  thr_turning_dual from, dual;
} shell;

/* The sphere of 120 edges, and its matching without connectedness. */
static void shell_make(shell *s, int cords)
{
  thr_limits none = {0};
  thr_pass_matching passes;
  thr_draft draft = {0};
  thr_read_report report;
  *s = (shell){.task = {.cover = 1, .most_passes = 8, .cords = cords, .extra_limit = -1}};
  thr_make_options make = thr_make_options_default(THR_MAKE_SPHERE);
  make.size = 2;
  ck_assert_int_eq(thr_make(&draft, &make, NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&draft, -1, &s->frame, &report, NULL), THR_OK);
  thr_draft_destroy(&draft);
  ck_assert_int_eq(thr_turning_columns_init(&s->c, &s->frame, &s->task, NULL), THR_OK);
  s->x = calloc((size_t)s->c.n_columns, sizeof *s->x);
  ck_assert_int_eq(thr_turning_dual_init(&s->from, &s->c, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_dual_init(&s->dual, &s->c, NULL), THR_OK);
  ck_assert_int_eq(thr_pass_matching_init(&passes, &s->c, NULL), THR_OK);
  ck_assert_int_eq(thr_pass_matching_solve(&passes, s->c.weight, &none, s->x, &s->from, NULL), THR_OK);
  thr_pass_matching_destroy(&passes);
}

static void shell_destroy(shell *s)
{
  thr_turning_dual_destroy(&s->from);
  thr_turning_dual_destroy(&s->dual);
  thr_turning_columns_destroy(&s->c);
  thr_frame_destroy(&s->frame);
  free(s->x);
}

static double degrees(int64_t units)
{
  return ldexp((double)units, -THR_TURNING_BITS) * 180 / acos(-1);
}

/* Its matching turns by 5016.47 degrees, the programme with all its rows proves 5262.03, and the best cord known turns by
 * 5409.83. */
START_TEST(a_sphere_is_proved_within_two_percent)
{
  const double best = 5409.83232;
  thr_limits none = {0};
  shell s;
  int64_t bound;
  shell_make(&s, 1);
  double target = ldexp(best * acos(-1) / 180, THR_TURNING_BITS);
  ck_assert_int_eq(thr_ranks_run(&s.c, s.x, &s.from, target, &none, &s.dual, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_dual_bound(&s.c, &s.dual, NULL, NULL, &bound, NULL), THR_OK);
  ck_assert_double_ge(degrees(bound), 5310);
  ck_assert_double_le(degrees(bound), best);
  shell_destroy(&s);
}
END_TEST

/* Two cords need one connection less, and no group; and with no time at all there is still a bound. */
START_TEST(several_cords_and_no_time)
{
  thr_limits none = {0}, past = {.deadline = 1e-9};
  shell s;
  int64_t bound;
  shell_make(&s, 2);
  ck_assert_int_eq(thr_ranks_run(&s.c, s.x, &s.from, 1e17, &none, &s.dual, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_dual_bound(&s.c, &s.dual, NULL, NULL, &bound, NULL), THR_OK);
  ck_assert_int_eq(s.dual.n_groups, 0);
  ck_assert_double_ge(degrees(bound), 5016.47);
  thr_turning_dual_destroy(&s.dual);
  ck_assert_int_eq(thr_turning_dual_init(&s.dual, &s.c, NULL), THR_OK);
  ck_assert_int_eq(thr_ranks_run(&s.c, s.x, &s.from, 1e17, &past, &s.dual, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_dual_bound(&s.c, &s.dual, NULL, NULL, &bound, NULL), THR_OK);
  ck_assert_double_ge(degrees(bound), 4000);
  shell_destroy(&s);
}
END_TEST

/* Every allocation that fails is told, and nothing is lost. */
START_TEST(a_run_without_memory_fails)
{
  thr_limits past = {.deadline = 1e-9};
  shell s;
  thr_status st = THR_ENOMEM;
  shell_make(&s, 1);
  for (long k = 1; st != THR_OK; k++) {
    thr_turning_dual_destroy(&s.dual);
    ck_assert_int_eq(thr_turning_dual_init(&s.dual, &s.c, NULL), THR_OK);
    thr_alloc_fail_at(k);
    st = thr_ranks_run(&s.c, s.x, &s.from, 1e17, &past, &s.dual, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || st == THR_ENOMEM);
  }
  shell_destroy(&s);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("ranks of nodes");
  ADD_EXAMPLES(s, 20, a_forest_is_the_least_of_all_turns, 20);
  ADD_TEST(s, 20, the_largest_numbers_fit);
  ADD_TEST(s, 60, a_sphere_is_proved_within_two_percent);
  ADD_TEST(s, 60, several_cords_and_no_time);
  ADD_TEST(s, 60, a_run_without_memory_fails);
  return run_suite(s);
}
