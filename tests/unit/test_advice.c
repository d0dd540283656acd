/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Advice: pulls from turning, cords cut evenly against every other way of cutting them, the choice,
 * and the picture. */
#include "diagram/overview/charts.h"
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/number.h"
#include "graph/limits.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "planner/planner.h"
#include "planner/planner_parts.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tests/svg_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An open cord of n passes that never turns back, through a framework without leaves. */
static thr_cord wander(rng *r, const thr_frame *f, int n)
{
  thr_cord cord = {.id = "A", .n_passes = n, .half = thr_calloc((size_t)n, sizeof *cord.half)};
  ck_assert_ptr_nonnull(cord.half);
  cord.half[0] = rng_below(r, 2 * f->n_edges);
  for (int k = 1; k < n; k++) {
    int out;
    do
      out = rng_below(r, 2 * f->n_edges);
    while (thr_tail(f, out) != thr_head(f, cord.half[k - 1]) || out == (cord.half[k - 1] ^ 1));
    cord.half[k] = out;
  }
  cord.closed = thr_cord_start(f, &cord) == thr_cord_end(f, &cord);
  return cord;
}

/* The closed form of eval, which sums up in another way. */
START_TEST(pulls_are_those_of_the_closed_form)
{
  rng r = rng_make((uint64_t)_i);
  thr_frame f = solid_make((solid)(1 + _i % 4));
  thr_cord cord = wander(&r, &f, rng_between(&r, 1, 30));
  thr_eval_options options = thr_eval_options_default();
  thr_eval eval;
  double pull[THR_ADVICE_PULLS];
  options.physics = thr_physics_default();
  options.physics.mu = 0.05 + 0.5 * rng_unit(&r);
  options.physics.seating = 0.5 + rng_unit(&r);
  ck_assert_int_eq(
      thr_eval_plan(&f, &cord, 1, THR_CAPSTAN, &options, &(thr_limits){0}, &eval, NULL), THR_OK);
  thr_advice_pulls(&eval.record.physics, thr_cord_pulled_turning(&f, &cord), pull);
  ck_assert_double_eq_tol(pull[THR_ADVICE_MU], eval.record.largest, 1e-9 * eval.record.largest);
  ck_assert_double_eq_tol(pull[THR_ADVICE_LOW], eval.band[0], 1e-9 * eval.band[0]);
  ck_assert_double_eq_tol(pull[THR_ADVICE_HIGH], eval.band[1], 1e-9 * eval.band[1]);
  thr_eval_destroy(&eval);
  free(cord.half);
  thr_frame_destroy(&f);
}
END_TEST

/* Least largest turning of the parts of passes first .. last of a cord in exactly so many, by
 * trying every first cut. */
static double least_cut(const thr_frame *f, const thr_request *request, const thr_cord *cord,
                        int first, int parts)
{
  thr_cord part = {.n_passes = 0, .half = cord->half + first};
  double least = INFINITY;
  for (int last = first; last + parts <= cord->n_passes; last++) {
    bool end = last + 1 == cord->n_passes;
    part.n_passes = last + 1 - first;
    if ((parts == 1) != end ||
        (!end && !thr_plan_end_allowed(f, request, thr_head(f, cord->half[last]))))
      continue;
    double rest = parts == 1 ? 0 : least_cut(f, request, cord, last + 1, parts - 1);
    least = fmin(least, fmax(thr_cord_turning(f, &part, false), rest));
  }
  return least;
}

/* The parts make up the cord again, there are as many as asked for, and no other cuts leave less on
 * the worst. */
START_TEST(cords_are_cut_as_evenly_as_can_be)
{
  rng r = rng_make((uint64_t)_i + 1000);
  thr_frame f = solid_make((solid)(1 + _i % 4));
  thr_request request = thr_request_default();
  thr_plan plan = {0}, seed = {0};
  int n = rng_between(&r, 2, 12), parts = rng_between(&r, 1, 4), pass = 0;
  for (int v = 0; v < f.n_nodes; v++)
    f.foot[v] = rng_below(&r, 3) > 0;
  request.ends = rng_below(&r, 2) ? THR_ENDS_ANY : THR_ENDS_FEET;
  request.cords = request.cords_least = parts;
  ck_assert_int_eq(thr_plan_request(&plan, &f, &request, NULL), THR_OK);
  plan.cord = thr_calloc(1, sizeof *plan.cord);
  ck_assert_ptr_nonnull(plan.cord);
  plan.cord[plan.n_cords++] = wander(&r, &f, n);
  double least = least_cut(&f, &request, &plan.cord[0], 0, parts);
  ck_assert_int_eq(thr_cut_seed(&plan, &request, &seed, NULL), THR_OK);
  if (isinf(least)) {
    ck_assert_int_eq(seed.n_cords, 0);
  } else {
    ck_assert_int_eq(seed.n_cords, parts);
    ck_assert_double_eq_tol(seed.metrics.max_turning, least, 1e-9);
    for (int i = 0; i < parts; i++)
      for (int k = 0; k < seed.cord[i].n_passes; k++)
        ck_assert_int_eq(seed.cord[i].half[k], plan.cord[0].half[pass++]);
    ck_assert_int_eq(pass, n);
  }
  thr_plan_destroy(&seed);
  thr_plan_destroy(&plan);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- choice ---- */

static thr_advice advice_of(int n, const thr_advice_row *row)
{
  thr_advice advice = {.physics = {.mu = 0.2, .mu_low = 0.1, .mu_high = 0.3, .seating = 1},
                       .hand = 10,
                       .base_length = 90};
  advice.n = n;
  advice.row = thr_calloc((size_t)n, sizeof *advice.row);
  ck_assert_ptr_nonnull(advice.row);
  memcpy(advice.row, row, (size_t)n * sizeof *row);
  return advice;
}

START_TEST(the_fewest_at_the_feet_are_chosen)
{
  const thr_advice_row row[] = {
      {.cords = 3, .ends = THR_ENDS_ANY, .length = 100, .pull = {2, 4, 8}},
      {.cords = 4, .ends = THR_ENDS_FEET, .length = 110, .pull = {2, 4, 9}},
      {.cords = 8, .ends = THR_ENDS_FEET, .length = 110, .pull = {2, 3.9, 8}},
      {.cords = 2, .ends = THR_ENDS_FEET, .length = 110, .pull = {3, 12, 40}},
      {.cords = 6, .ends = THR_ENDS_FEET, .length = 100, .pull = {1.5, 2, 3}}};
  thr_advice advice = advice_of(5, row);
  thr_advice_settle(&advice);
  ck_assert_int_eq(advice.n, 4); /* 8 cords buy nothing that 6 do not */
  ck_assert_int_eq(advice.left_out, 1);
  ck_assert_int_eq(advice.row[0].cords, 2);
  ck_assert_int_eq(advice.chosen, 1);
  ck_assert_int_eq(advice.row[advice.chosen].cords, 4);
  ck_assert(!advice.row[1].frontier); /* 3 cords with ends anywhere have less of all */
  ck_assert(advice.row[2].frontier && advice.row[3].frontier);
  thr_advice_destroy(&advice);
  advice = advice_of(1, row);
  thr_advice_settle(&advice);
  ck_assert_int_eq(advice.chosen, 0); /* where none at the feet will do, others */
  advice.hand = 7;
  thr_advice_settle(&advice);
  ck_assert_int_eq(advice.chosen, -1);
  thr_advice_destroy(&advice);
  const thr_advice_row far[] = {
      {.cords = 3, .ends = THR_ENDS_ANY, .length = 100, .pull = {2, 4, 8}},
      {.cords = 4, .ends = THR_ENDS_FEET, .length = 160, .pull = {2, 4, 9}}};
  advice = advice_of(2, far);
  thr_advice_settle(&advice);
  ck_assert(advice.row[advice.chosen].ends ==
            THR_ENDS_ANY); /* ends at the feet take more than half as much cord again */
  thr_advice_destroy(&advice);
}
END_TEST

/* ---- advice for frameworks ---- */

static void check_advice(const thr_frame *f, const thr_advice *advice)
{
  for (int i = 0; i < advice->n; i++) {
    const thr_advice_row *row = &advice->row[i];
    ck_assert_int_ge(row->passes, f->n_edges);
    ck_assert(row->steps >= 1 &&
              row->steps <=
                  row->passes * (row->ends == THR_ENDS_ANY ? 3 : 1)); /* two ends to a pass */
    ck_assert_double_ge(row->length, advice->base_length * (1 - 1e-12));
    ck_assert_double_le(row->longest, row->length);
    ck_assert_double_ge(row->turning, row->bound * (1 - 1e-9));
    ck_assert_double_le(row->pull[THR_ADVICE_MU], advice->physics.seating *
                                                      exp(advice->physics.mu * row->turning) *
                                                      (1 + 1e-9));
    ck_assert(row->pull[THR_ADVICE_LOW] <= row->pull[THR_ADVICE_MU] &&
              row->pull[THR_ADVICE_MU] <= row->pull[THR_ADVICE_HIGH]);
    if (advice->chosen >= 0 && row->ends == advice->row[advice->chosen].ends &&
        row->cords < advice->row[advice->chosen].cords)
      ck_assert_double_gt(row->pull[THR_ADVICE_HIGH], advice->hand);
  }
  if (advice->chosen >= 0) ck_assert(thr_advice_within(advice, &advice->row[advice->chosen]));
}

/* Through a straight path from its foot and back is one turn of pi, which neither end slides over;
 * from end to end none; a ring turns by 2 pi. */
START_TEST(known_frameworks)
{
  const thr_request request = thr_request_default();
  const thr_advise_options options = {.hand = 10};
  thr_advice advice;
  thr_frame f = path_make(5);
  ck_assert_int_eq(thr_advise(&f, &request, &options, &(thr_limits){0}, &advice, NULL), THR_OK);
  check_advice(&f, &advice);
  ck_assert(advice.complete);
  ck_assert_int_eq(advice.row[advice.chosen].cords, 1);
  ck_assert_double_eq_tol(advice.row[advice.chosen].pull[THR_ADVICE_MU], 1,
                          1e-9); /* from its foot and back */
  ck_assert_int_eq(advice.row[advice.n - 1].ends, THR_ENDS_ANY);
  ck_assert_double_eq_tol(advice.row[advice.n - 1].pull[THR_ADVICE_MU], 1, 1e-9);
  thr_advice_destroy(&advice);
  thr_frame_destroy(&f);
  f = ring_make(12);
  ck_assert_int_eq(thr_advise(&f, &request, &options, &(thr_limits){0}, &advice, NULL), THR_OK);
  check_advice(&f, &advice);
  ck_assert_int_eq(advice.row[0].ends, THR_ENDS_CLOSED);
  ck_assert_double_eq_tol(advice.row[0].turning, 2 * THR_PI, 1e-9);
  ck_assert_double_eq_tol(advice.row[0].pull[THR_ADVICE_MU], exp(0.2 * 5 * THR_PI / 6), 1e-9);
  thr_advice_destroy(&advice);
  thr_frame_destroy(&f);
}
END_TEST

/* In the work that is usual, twice: the same rows. */
START_TEST(advice_for_random_frameworks)
{
  rng r = rng_make((uint64_t)_i + 5000);
  const thr_request request = thr_request_default();
  const thr_advise_options options = {.hand = 1 + 3 * rng_unit(&r)};
  double work = thr_advise_work;
  const thr_limits limits = thr_limits_counted(&(thr_limits){0}, &work);
  thr_advice advice, again;
  thr_frame f = random_frame(&r, rng_between(&r, 3, 7), 4, LENGTHS_EUCLID);
  ck_assert_int_eq(thr_advise(&f, &request, &options, &limits, &advice, NULL), THR_OK);
  check_advice(&f, &advice);
  work = thr_advise_work;
  ck_assert_int_eq(thr_advise(&f, &request, &options, &limits, &again, NULL), THR_OK);
  ck_assert_int_eq(again.n, advice.n);
  ck_assert_int_eq(again.chosen, advice.chosen);
  for (int i = 0; i < advice.n; i++) {
    ck_assert_int_eq(again.row[i].cords, advice.row[i].cords);
    ck_assert_int_eq(again.row[i].ends, advice.row[i].ends);
    ck_assert(again.row[i].length == advice.row[i].length &&
              again.row[i].turning == advice.row[i].turning);
  }
  thr_advice_destroy(&advice);
  thr_advice_destroy(&again);
  thr_frame_destroy(&f);
}
END_TEST

/* A ring of rings: a torus of 6 x 8 nodes, edges all around, without feet. */
static thr_frame torus_make(void)
{
  enum { AROUND = 8, ACROSS = 6, NODES = AROUND * ACROSS };
  double xyz[NODES][3];
  int edge[2 * NODES][2];
  for (int i = 0; i < AROUND; i++)
    for (int j = 0; j < ACROSS; j++) {
      const int v = i * ACROSS + j;
      const double a = 2 * THR_PI * i / AROUND, b = 2 * THR_PI * j / ACROSS, r = 3 + cos(b);
      memcpy(xyz[v], (double[3]){r * cos(a), r * sin(a), sin(b)}, sizeof xyz[v]);
      edge[2 * v][0] = edge[2 * v + 1][0] = v;
      edge[2 * v][1] = (i + 1) % AROUND * ACROSS + j;
      edge[2 * v + 1][1] = i * ACROSS + (j + 1) % ACROSS;
    }
  return frame_make(NODES, (const double(*)[3])xyz, 2 * NODES, (const int(*)[2])edge, 0, NULL);
}

/* The plan of every row has the cords, ends, length and pulls that the row says, and passes the
 * checker: of frameworks with feet, without, of several components, and too large for searches. */
START_TEST(rows_have_their_plans)
{
  const thr_request request = thr_request_default();
  const thr_advise_options options = {.hand = _i % 2 ? 10 : 2.5};
  double work = thr_advise_work;
  const thr_limits limits = thr_limits_counted(&(thr_limits){0}, &work);
  thr_advice advice;
  thr_err err = {0};
  thr_frame f = _i == 0   ? grid_make(5, 5)
                : _i == 1 ? ring_make(12)
                : _i == 2 ? torus_make()
                : _i == 3 ? triangles_make(3)
                : _i == 4 ? grid_make(3, 7)
                          : ring_make(5001);
  assert_ok(thr_advise(&f, &request, &options, &limits, &advice, &err), &err);
  for (int i = 0; i < advice.n; i++) {
    const thr_advice_row *row = &advice.row[i];
    double pull[THR_ADVICE_PULLS];
    thr_plan plan;
    assert_ok(thr_advice_plan(&f, &request, row, &plan, &err), &err);
    assert_ok(thr_check_plan(&plan, &err), &err);
    ck_assert_int_eq(plan.n_cords, row->all);
    ck_assert_int_eq(plan.options.ends, row->ends);
    ck_assert_double_eq_tol(plan.metrics.length, row->length, 1e-9 * row->length);
    ck_assert_double_eq_tol(plan.metrics.max_turning, row->turning, 1e-9);
    thr_plan_pulls(&plan, pull);
    for (int k = 0; k < THR_ADVICE_PULLS; k++)
      ck_assert(isinf(pull[k]) ? isinf(row->pull[k])
                               : fabs(pull[k] - row->pull[k]) <= 1e-9 * row->pull[k]);
    thr_plan_destroy(&plan);
  }
  thr_advice_destroy(&advice);
  thr_frame_destroy(&f);
}
END_TEST

/* From odd node to odd node no cord is passed twice: always a row, and of all with as few cords the
 * shortest. */
START_TEST(half_the_odd_nodes_are_a_row)
{
  const thr_request request = thr_request_default();
  const thr_advise_options options = {.hand = 10};
  double work = thr_advise_work;
  const thr_limits limits = thr_limits_counted(&(thr_limits){0}, &work);
  thr_frame f = grid_make(5, 5); /* 12 nodes of degree 3 */
  thr_advice advice;
  bool seen = false;
  ck_assert_int_eq(thr_advise(&f, &request, &options, &limits, &advice, NULL), THR_OK);
  for (int i = 0; i < advice.n; i++)
    seen |= advice.row[i].cords == 6 && advice.row[i].length <= advice.base_length * (1 + 1e-12);
  ck_assert(seen);
  thr_advice_destroy(&advice);
  thr_frame_destroy(&f);
}
END_TEST

/* A smaller hand never gets more cords than another plan with such ends within that hand has. */
START_TEST(no_row_within_the_hand_has_fewer_cords)
{
  const thr_request request = thr_request_default();
  const thr_advise_options options = {.hand = 2 + _i};
  double work = thr_advise_work;
  const thr_limits limits = thr_limits_counted(&(thr_limits){0}, &work);
  thr_frame f = grid_make(6, 6);
  thr_advice advice;
  ck_assert_int_eq(thr_advise(&f, &request, &options, &limits, &advice, NULL), THR_OK);
  check_advice(&f, &advice);
  ck_assert_int_ge(advice.chosen, 0);
  thr_advice_destroy(&advice);
  thr_frame_destroy(&f);
}
END_TEST

/* Of a framework that is too large for searches the shortest cord is cut: every row has as much
 * cord. */
START_TEST(large_frameworks_are_cut)
{
  const thr_request request = thr_request_default();
  const thr_advise_options options = {.hand = 10};
  thr_advice advice;
  thr_frame f = ring_make(5001);
  ck_assert_int_eq(thr_advise(&f, &request, &options, &(thr_limits){0}, &advice, NULL), THR_OK);
  check_advice(&f, &advice);
  for (int i = 0; i < advice.n; i++) {
    ck_assert(advice.row[i].ends != THR_ENDS_CLOSED && !advice.row[i].searched);
    ck_assert_double_eq_tol(advice.row[i].length, advice.base_length, 1e-9 * advice.base_length);
  }
  thr_advice_destroy(&advice);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- picture ---- */

static int count_class(const svg_tree *t, const char *word)
{
  int n = 0;
  for (int i = 0; i < t->n; i++)
    n += svg_has_class(t, i, word);
  return n;
}

/* Where the line of the recommended column runs, mm from the left; -1: there is none. */
static double chosen_x(const svg_tree *t)
{
  for (int i = 0; i < t->n; i++) {
    char d[256];
    if (svg_has_class(t, i, "chosen-line") && svg_attribute(t, i, "d", d))
      return strtod(d + 1, NULL);
  }
  return -1;
}

/* Up to 48 columns with pulls beyond any axis: texts stay on the sheet, off each other, and those
 * over a line off the line that marks a column. */
START_TEST(pictures_are_well_formed_and_texts_lie_apart)
{
  enum { MOST = 20 };
  static const int cords[MOST] = {1,  2,  3,  4,  5,  6,  7,  8,  12, 16,
                                  20, 24, 28, 32, 36, 40, 44, 46, 47, 48};
  thr_advice_row row[MOST];
  thr_text svg = {0};
  int n = 1 + _i % MOST;
  for (int i = 0; i < n; i++) {
    double turning = 60.0 * (1 + _i) / cords[i];
    row[i] = (thr_advice_row){
        .cords = cords[i], .ends = THR_ENDS_ANY, .length = 100 - i, .turning = turning};
    thr_advice_pulls(&(thr_physics){.mu = 0.2, .mu_low = 0.1, .mu_high = 0.3, .seating = 1},
                     turning / 2, row[i].pull);
  }
  thr_advice advice = advice_of(n, row);
  thr_advice_settle(&advice);
  const thr_advice_chart chart = {
      .name = "a <long> name, a long name, a long name, a long name, a long name, a long name",
      .units = "mm",
      .command = "thread plan "
                 "a_name_without_any_blank_that_is_longer_than_the_sheet_is_wide_and_so_has_to_be_"
                 "broken_somewhere_all_the_same.json --cords 12 --ends any"};
  ck_assert_int_eq(thr_advice_svg(&advice, &chart, &svg, NULL), THR_OK);
  svg_tree t = svg_parse(svg.data);
  ck_assert_int_eq(count_class(&t, "base"), advice.n);
  ck_assert_int_eq(count_class(&t, "flag"), advice.chosen >= 0);
  double marked = chosen_x(&t);
  for (int i = 0; i < t.n; i++) {
    double box[4], other[4];
    if (strcmp(t.element[i].name, "text") != 0) continue;
    svg_box(&t, i, box);
    ck_assert_msg(box[0] >= 0 && box[2] <= t.width && box[1] >= 0 && box[3] <= t.height, "%s",
                  t.element[i].text);
    if (svg_has_class(&t, i, "halo")) ck_assert(marked < box[0] || marked > box[2]);
    for (int j = 0; j < i; j++) {
      if (strcmp(t.element[j].name, "text") != 0) continue;
      svg_box(&t, j, other);
      ck_assert_msg(!svg_overlap(box, other, 0), "%s and %s", t.element[i].text, t.element[j].text);
    }
  }
  svg_tree_destroy(&t);
  thr_text_destroy(&svg);
  thr_advice_destroy(&advice);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("advice");
  ADD_EXAMPLES(s, 10, pulls_are_those_of_the_closed_form, 100);
  ADD_EXAMPLES(s, 20, cords_are_cut_as_evenly_as_can_be, 400);
  ADD_TEST(s, 5, the_fewest_at_the_feet_are_chosen);
  ADD_TEST(s, 30, known_frameworks);
  ADD_EXAMPLES(s, 60, rows_have_their_plans, 6);
  ADD_TEST(s, 30, half_the_odd_nodes_are_a_row);
  ADD_EXAMPLES(s, 30, no_row_within_the_hand_has_fewer_cords, 3);
  ADD_TEST(s, 30, large_frameworks_are_cut);
  ADD_EXAMPLES(s, 120, advice_for_random_frameworks, 40);
  ADD_EXAMPLES(s, 20, pictures_are_well_formed_and_texts_lie_apart, 40);
  return run_suite(s);
}
