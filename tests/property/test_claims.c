/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is claimed of rows must hold for threadings as plans count them, whatever comes first. */
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_parts.h"
#include "symmetry/group/group.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <string.h>

enum { SHAPES = 5, ORDERS = 6 };

static thr_frame shape_number(int i)
{
  switch (i) {
  case 0: return no_feet(star_make(4));
  case 1: return no_feet(path_make(4));
  case 2: return no_feet(ring_make(4));
  case 3: return no_feet(grid_make(3, 2));
  default: return solid_make(TETRAHEDRON);
  }
}

static const thr_aim orders[ORDERS][THR_N_AIMS] = {
    {THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_PATHS, THR_AIM_TURNING},
    {THR_AIM_PATHS, THR_AIM_STEPS, THR_AIM_OVERLAP, THR_AIM_TURNING},
    {THR_AIM_PATHS, THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_TURNING},
    {THR_AIM_STEPS, THR_AIM_OVERLAP, THR_AIM_PATHS, THR_AIM_TURNING},
    {THR_AIM_TURNING, THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_PATHS},
    {THR_AIM_TURNING, THR_AIM_PATHS, THR_AIM_STEPS, THR_AIM_OVERLAP},
};

/* What a plan counts of a cover. */
static void count(const thr_quotient *q, const thr_cover_options *o, const thr_cover *c,
                  double has[THR_N_AIMS])
{
  thr_request plan = options_for(o->ends, o->cover);
  thr_cord *cord;
  int n;
  thr_symmetry_record record;
  thr_metrics m;
  ck_assert_int_eq(thr_cover_cords(q, o, c, &cord, &n, &record, NULL), THR_OK);
  ck_assert_int_eq(thr_plan_measure(q->f, &plan, cord, n, &m, NULL), THR_OK);
  has[THR_AIM_OVERLAP] = m.overlap;
  has[THR_AIM_STEPS] = record.steps;
  has[THR_AIM_PATHS] = record.unique_paths;
  has[THR_AIM_TURNING] = m.turning;
  thr_cords_destroy(cord, n);
  thr_symmetry_record_destroy(&record);
}

/* Every cord once more. */
static void thread_twice(const thr_quotient *q, thr_cover *c)
{
  for (int i = 0; i < q->n_copies; i++)
    c->copies[i] *= 2;
  for (int i = 0; i < q->n_pairs; i++)
    c->pairs[i] *= 2;
  for (int i = 0; i < q->n_darts; i++)
    c->ends[i] *= 2;
}

/* Is another threading, of which a plan counts has, above all that is claimed of those like c's? */
static void assert_above(const thr_cover_options *o, const thr_claims *claims,
                         const double c[THR_N_AIMS], const double has[THR_N_AIMS])
{
  for (int k = 0; k < THR_N_AIMS; k++) {
    thr_aim a = o->prefer[k];
    ck_assert_msg(has[a] >= claims->least[a] - 1e-5,
                  "ends %s, cover %d, first %s: %s %g, claimed at least %g", thr_ends_name(o->ends),
                  o->cover, thr_aim_name(o->prefer[0]), thr_aim_name(a), has[a], claims->least[a]);
    if (has[a] > c[a] + 1e-6) return; /* the rest is claimed of threadings with no more of this */
  }
}

/* The claims of the best cover of each order of aims, against the best of every other order, and
 * half of it threaded twice. */
static void compare_orders(const thr_quotient *q, thr_ends ends, int cover)
{
  thr_cover c[ORDERS + 1];
  double has[ORDERS + 1][THR_N_AIMS];
  thr_cover_options o = cover_options(ends, cover);
  int n = 0;
  for (; n < ORDERS + (cover == 2); n++) {
    const thr_limits limits = {.deadline = thr_clock() + 1};
    thr_cover_options each = o;
    if (n < ORDERS)
      memcpy(each.prefer, orders[n], sizeof each.prefer);
    else
      each.cover = 1;
    thr_status st = thr_cover_find(q, &each, &limits, &c[n], NULL);
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    ck_assert_ptr_nonnull(c[n].copies);
    if (n == ORDERS) thread_twice(q, &c[n]);
    count(q, &o, &c[n], has[n]);
  }
  for (int i = 0; i < ORDERS; i++) {
    thr_claims claims;
    memcpy(o.prefer, orders[i], sizeof o.prefer);
    ck_assert_int_eq(thr_claims_make(q, &o, &c[i], has[i][THR_AIM_STEPS], &claims, NULL), THR_OK);
    for (int k = 0; k < n; k++)
      assert_above(&o, &claims, has[i], has[k]);
  }
  for (int i = 0; i < n; i++)
    thr_cover_destroy(&c[i]);
}

START_TEST(claims_leave_room_for_other_orders)
{
  setting s = setting_make(100, shape_number(_i));
  for (int k = 0; k < s.classes.n; k++) {
    thr_quotient q;
    ck_assert_int_eq(thr_quotient_init(&q, &s.f, &s.g, &s.classes.subgroup[k], 10000, NULL),
                     THR_OK);
    for (int cover = 1; cover <= 2; cover++) {
      compare_orders(&q, THR_ENDS_CLOSED, cover);
      compare_orders(&q, THR_ENDS_ANY, cover);
    }
    thr_quotient_destroy(&q);
  }
  setting_destroy(&s);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("claims");
  ADD_EXAMPLES(s, 120, claims_leave_room_for_other_orders, SHAPES);
  return run_suite(s);
}
