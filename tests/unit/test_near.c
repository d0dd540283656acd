/* Plans near the best one: never worse, single cords through everything, the same every time. */
#include "graph/framework/frame.h"
#include "graph/framework/make.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "tests/support.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/proof/connect.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  thr_frame frame;
  thr_turning_task task;
  thr_turning_columns c;
} shell;

static void shell_make(shell *s, int size)
{
  thr_draft draft = {0};
  thr_read_report report;
  *s = (shell){.task = {.cover = 1, .most_passes = 8, .cords = 1, .extra_limit = -1}};
  thr_make_options make = thr_make_options_default(THR_MAKE_SPHERE);
  make.size = size;
  ck_assert_int_eq(thr_make(&draft, &make, NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&draft, -1, &s->frame, &report, NULL), THR_OK);
  thr_draft_destroy(&draft);
  ck_assert_int_eq(thr_turning_columns_init(&s->c, &s->frame, &s->task, NULL), THR_OK);
}

static void shell_destroy(shell *s)
{
  thr_turning_columns_destroy(&s->c);
  thr_frame_destroy(&s->frame);
}

/* The cord as it runs: price of its turns; it passes every edge and turns back nowhere. */
static double follow(const shell *s, const thr_join *join)
{
  thr_cord *cord = calloc(1, sizeof *cord);
  double sum = 0;
  int *passes = calloc((size_t)s->frame.n_edges, sizeof *passes);
  ck_assert(passes && cord);
  ck_assert_int_eq(thr_join_count(join), 1);
  ck_assert_int_eq(thr_join_cords(join, cord, 1, NULL), THR_OK);
  for (int k = 0; k < cord->n_passes; k++) {
    const int in = cord->half[k], out = cord->half[(k + 1) % cord->n_passes];
    ck_assert_int_eq(thr_head(&s->frame, in), thr_tail(&s->frame, out));
    ck_assert_int_ne(in, out ^ 1);
    sum += thr_turn_price(&s->frame, THR_TURN_ANGLE, in, out);
    passes[in >> 1]++;
  }
  for (int e = 0; e < s->frame.n_edges; e++)
    ck_assert_int_ge(passes[e], 1);
  free(passes);
  thr_cords_destroy(cord, 1);
  return sum;
}

/* Prices of the matching's plan and of the one near it. */
static void look_near(const shell *s, int64_t *before, int64_t *after)
{
  const thr_limits none = {0};
  thr_branch b;
  ck_assert_int_eq(thr_branch_init(&b, &s->c, 1, &none, NULL), THR_OK);
  ck_assert_int_eq(thr_branch_begin(&b, NULL), THR_OK);
  ck_assert(b.found);
  *before = b.best_price;
  ck_assert_int_eq(thr_connect_near(&b, &none, NULL), THR_OK);
  *after = b.best_price;
  ck_assert_double_eq_tol(follow(s, &b.best), ldexp((double)b.best_price, -THR_TURNING_BITS), 1e-6);
  ck_assert_int_ge(b.best_price, (int64_t)b.tree.node[0].bound);
  thr_branch_destroy(&b);
}

START_TEST(plans_near_the_best_one)
{
  for (int size = 2; size <= 4; size += 2) {
    shell s;
    int64_t before, after[2];
    shell_make(&s, size);
    for (int again = 0; again < 2; again++)
      look_near(&s, &before, &after[again]);
    ck_assert(after[0] <= before && after[0] == after[1]);
    if (size == 4) ck_assert_msg(after[0] < before, "480 edges: 11235 degrees are near 11323");
    shell_destroy(&s);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("plans near the best one");
  ADD_TEST(s, 60, plans_near_the_best_one);
  return run_suite(s);
}
