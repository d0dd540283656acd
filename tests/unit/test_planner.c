/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans made by the library alone, and the proofs that come with every one. */
#define _XOPEN_SOURCE 700
#include "graph/check/check.h"
#include "graph/io/read.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "graph/limits.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"

static const char *const aims[] = {"length", "turning", "steps"}; /* of three plans */

/* Whatever is proved of them, their bounds hold, also once they were written and read. */
START_TEST(plans_for_every_objective_are_written_and_read)
{
  thr_frame f;
  thr_read_report read;
  thr_err e = {0};
  const thr_read_options how = thr_read_options_default();
  const thr_limits limits = {.deadline = thr_clock() + 20};
  thr_plan made = {0}, again;
  thr_text text = {0};
  thr_request o = thr_request_default();
  assert_ok(thr_frame_read(&f, &read, "data/dome7.json", &how, NULL, 0, &e), &e);
  want(&o, aims[_i]);
  const thr_status st = thr_plan_make(&f, &o, &limits, &made, NULL, &e);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", e.text);
  thr_plan_write(&made, &text);
  assert_ok(thr_plan_parse(&again, text.data, text.length, "again", &e), &e);
  assert_ok(thr_check_plan(&again, &e), &e);
  ck_assert_int_eq((int)thr_aims_objective(&again.options), _i);
  ck_assert(again.proof.present && again.proof.lower_bound > 0);
  thr_text_destroy(&text);
  thr_plan_destroy(&again);
  thr_plan_destroy(&made);
  thr_frame_destroy(&f);
}
END_TEST

/* As few cords as a hand can pull even at the upper end of the band of mu, with ends at the feet;
 * and the same ones again. */
START_TEST(what_is_recommended_stays_within_the_hand)
{
  thr_frame f;
  thr_read_report read;
  thr_err e = {0};
  const thr_read_options how = thr_read_options_default();
  const thr_request o = thr_request_default();
  const double hand = _i ? 0.5 : thr_hand_always;
  double pull[THR_ADVICE_PULLS];
  thr_plan p, again;
  thr_report r, other;
  thr_physics physics;
  assert_ok(thr_frame_read(&f, &read, "data/dome7.json", &how, NULL, 0, &e), &e);
  assert_ok(thr_plan_recommended(&f, &o, &(thr_recommend_options){.hand = hand}, &(thr_limits){0},
                                 &p, &r, &e),
            &e);
  assert_ok(thr_check_plan(&p, &e), &e);
  assert_ok(thr_physics_resolve(&o.physics, &f, &physics, &e), &e);
  thr_advice_pulls(&physics, thr_cords_pulled_turning(&p.frame, p.cord, p.n_cords), pull);

  /* Nothing stays within less than the seating tension: the shortest closed cord. */
  ck_assert_int_eq(p.options.ends, _i ? THR_ENDS_CLOSED : THR_ENDS_FEET);
  ck_assert(_i ? p.n_cords == 1 && p.proof.optimal : pull[THR_ADVICE_HIGH] <= hand * (1 + 1e-9));

  assert_ok(thr_plan_recommended(&f, &o, &(thr_recommend_options){.hand = hand},
                                 &(thr_limits){.threads = 2}, &again, &other, &e),
            &e);
  ck_assert_int_eq(again.n_cords, p.n_cords);
  ck_assert_double_eq(again.metrics.max_turning, p.metrics.max_turning);

  thr_report_destroy(&other);
  thr_plan_destroy(&again);
  thr_report_destroy(&r);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Ends that are given stay where they are, also where only one node may have any, and tubes are
 * tied. */
START_TEST(what_is_recommended_keeps_ends_and_joints)
{
  thr_frame f = grid_make(4, 4);
  bool first[16] = {true};
  thr_request o = thr_request_default();
  thr_plan p;
  thr_report r;
  thr_err e = {0};
  o.ends = _i == 0 ? THR_ENDS_CLOSED : _i == 1 ? THR_ENDS_NODES : THR_ENDS_ANY;
  o.end_node = _i == 1 ? first : NULL;
  o.joint = _i == 2 ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  assert_ok(thr_plan_recommended(&f, &o, &(thr_recommend_options){.hand = 4, .ends_given = true},
                                 &(thr_limits){0}, &p, &r, &e),
            &e);
  assert_ok(thr_check_plan(&p, &e), &e);
  ck_assert_int_eq(p.options.ends, o.ends);
  ck_assert_int_eq(p.options.joint, o.joint);
  ck_assert_int_gt(p.n_cords, 1);
  ck_assert_double_le(thr_cords_pulled_turning(&p.frame, p.cord, p.n_cords),
                      log(4) / 0.3 * (1 + 1e-9));
  thr_report_destroy(&r);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Where no edge has room for a second pass, a cord ends at each of the eight odd nodes of a grid.
 */
START_TEST(what_is_recommended_ends_at_odd_nodes)
{
  thr_frame f = grid_make(4, 4);
  thr_request o = thr_request_default();
  thr_plan p;
  thr_report r;
  thr_err e = {0};
  o.capacity = 1;
  assert_ok(thr_plan_recommended(&f, &o, &(thr_recommend_options){.hand = thr_hand_always},
                                 &(thr_limits){0}, &p, &r, &e),
            &e);
  assert_ok(thr_check_plan(&p, &e), &e);
  ck_assert_int_eq(p.n_cords, 4);
  ck_assert_int_eq(p.options.ends, THR_ENDS_ANY);
  ck_assert_int_eq(p.metrics.most_passes, 1);
  thr_report_destroy(&r);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A grid takes several cords, and one edge beside it, a component for itself, only one. */
START_TEST(what_is_recommended_counts_cords_in_every_component)
{
  thr_frame grid = grid_make(7, 7), edge = path_make(2), f = side_by_side(&grid, &edge);
  const thr_request o = thr_request_default();
  thr_plan p;
  thr_report r;
  thr_err e = {0};
  int of_grid = 0;
  assert_ok(thr_plan_recommended(&f, &o, &(thr_recommend_options){.hand = thr_hand_always},
                                 &(thr_limits){0}, &p, &r, &e),
            &e);
  assert_ok(thr_check_plan(&p, &e), &e);
  for (int i = 0; i < p.n_cords; i++)
    of_grid += p.cord[i].component == 0;
  ck_assert_int_gt(of_grid, 1);
  ck_assert_int_eq(p.n_cords, of_grid + 1);
  ck_assert_double_le(thr_cords_pulled_turning(&p.frame, p.cord, p.n_cords),
                      log(thr_hand_always) / 0.3 * (1 + 1e-9)); /* 1 N seats, mu up to 0.3 */
  thr_report_destroy(&r);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
  thr_frame_destroy(&edge);
  thr_frame_destroy(&grid);
}
END_TEST

START_TEST(every_plan_comes_with_proofs)
{
  const thr_joint joint = _i % 2 ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  thr_frame f = solid_make(OCTAHEDRON);
  thr_request o = thr_request_default();
  const thr_limits limits = {.deadline = thr_clock() + 5};
  thr_plan p;
  thr_report r;
  thr_err e = {0};
  want(&o, aims[_i / 2]);
  o.joint = joint;
  thr_status st = thr_plan_make(&f, &o, &limits, &p, &r, &e);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", e.text);
  ck_assert_int_gt(p.n_cords, 0);
  ck_assert_ptr_nonnull(p.generator);
  ck_assert_ptr_nonnull(strstr(p.generator, "GLPK"));
  e = (thr_err){0};
  assert_ok(thr_check_plan(&p, &e), &e);
  ck_assert(p.proof.present);
  ck_assert_double_ge(p.proof.lower_bound, thr_frame_total_length(&f) * (1 - 1e-9));
  ck_assert(p.symmetry.present == (thr_wants_symmetry(&o)));
  ck_assert(p.turning.present == (thr_wants_turning(&o)));
  ck_assert((r.symmetries.n > 0) == (thr_wants_symmetry(&o)));
  thr_report_destroy(&r);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A classical tour of f with a deadline (0 = none), as text. */
static thr_text tour_text(const thr_frame *f, const thr_request *o, double deadline)
{
  const thr_limits limits = {.deadline = deadline};
  thr_text text = {0};
  thr_plan p;
  thr_err e = {0};
  assert_ok(thr_plan_make(f, o, &limits, &p, NULL, &e), &e);
  ck_assert_msg(p.proof.optimal && thr_check_plan(&p, &e) == THR_OK, "%s", e.text);
  thr_plan_write(&p, &text);
  ck_assert(!text.failed);
  thr_plan_destroy(&p);
  return text;
}

/* Whatever the time that is left, and none at all, the same bytes. */
START_TEST(classical_tours_take_no_notice_of_time)
{
  static const thr_tour tours[] = {THR_TOUR_FLEURY, THR_TOUR_HIERHOLZER};
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i);
  for (int i = 0; i < 12; i++) {
    thr_frame f = random_frame(&r, rng_between(&r, 3, 60), rng_below(&r, 60), LENGTHS_EUCLID);
    thr_request o = options_for(ends[i % 3], 1 + i / 6);
    want(&o, "turning");
    o.turning.tour = tours[i / 3 % 2];
    thr_text without = tour_text(&f, &o, 0), past = tour_text(&f, &o, thr_clock() - 1),
             soon = tour_text(&f, &o, thr_clock() + 1e-4);
    ck_assert_str_eq(without.data, past.data);
    ck_assert_str_eq(without.data, soon.data);
    thr_text_destroy(&without);
    thr_text_destroy(&past);
    thr_text_destroy(&soon);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Does it turn back where there is another way? */
static bool turns_back(const thr_frame *f, const thr_plan *p)
{
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    for (int k = p->options.ends != THR_ENDS_CLOSED; k < c->n_passes; k++)
      if (c->half[k] == (c->half[(k + c->n_passes - 1) % c->n_passes] ^ 1) &&
          thr_degree(f, thr_tail(f, c->half[k])) > 1)
        return true;
  }
  return false;
}

/* Turning of all cords of a plan within the limits; INFINITY if there is none, or if one of several
 * cords turns back, as no plan of the least turning may. (Of a single cord an exchange takes such
 * turns away, and others do not cost more.) */
static double turning_of(const thr_frame *f, const thr_request *o, const thr_limits *limits)
{
  thr_plan p;
  thr_err e = {0};
  thr_status st = thr_plan_make(f, o, limits, &p, NULL, &e);
  double turning = p.metrics.turning;
  if (st && st != THR_ELIMIT) return INFINITY;
  assert_ok(thr_check_plan(&p, &e), &e);
  if (o->cords > 1 && turns_back(f, &p)) turning = INFINITY;
  thr_plan_destroy(&p);
  return turning;
}

/* Is the least turning, searched for without any time, no more than that of the tours and of the
 * shortest cords? */
static void assert_begins_with_all(const thr_frame *f, thr_ends ends, int cords, const char *name)
{
  const thr_limits no_limit = {0}, no_time = {.deadline = thr_clock() - 1};
  thr_request o = options_for(ends, 1);
  double least;
  o.cords = o.cords_least = cords;
  want(&o, "length");
  least = turning_of(f, &o, &no_limit);
  want(&o, "turning");
  for (int tour = 0; tour < 2 && cords == 1; tour++) {
    o.turning.tour = tour ? THR_TOUR_FLEURY : THR_TOUR_HIERHOLZER;
    least = fmin(least, turning_of(f, &o, &no_limit));
  }
  o.turning.tour = THR_TOUR_LEAST;
  if (least < INFINITY)
    ck_assert_msg(turning_of(f, &o, &no_time) <= least + 1e-6, "%s, ends %d, %d cords", name, ends,
                  cords);
}

static void assert_begins(const thr_frame *f, const char *name)
{
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++)
    for (int cords = 1; cords <= 3; cords += 2)
      assert_begins_with_all(f, (thr_ends)ends, cords, name);
}

START_TEST(turning_begins_with_tours_and_the_shortest_cords)
{
  rng r = rng_make((uint64_t)_i);
  for (int i = 0; i < 10; i++) {
    thr_frame f = random_frame(&r, rng_between(&r, 3, 60), rng_below(&r, 90), LENGTHS_EUCLID);
    assert_begins(&f, "random");
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(turning_of_data_begins_so)
{
  static const char *const paths[] = {
      "data/dome7.json",
      "data/dome7-stairs.json",
      "data/assembly-instances/C_shape.json",
      "data/assembly-instances/fandisk.json",
      "data/assembly-instances/klein_bottle_trail.json",
      "data/assembly-instances/robarch_tree_S.json",
      "data/assembly-instances/semi_sphere.json",
      "data/assembly-instances/topopt-100_S1_03-14-2019_w_layer.json",
      "data/assembly-instances/voronoi_S1_03-14-2019_w_layer.json",
      "data/conmech/four-frame.json",
      "data/conmech/tower_3D.json",
      "data/jax_fdm/barrel.obj",
      "data/jax_fdm/creased_shell.json",
      "data/jax_fdm/liew_dome.json",
      "data/jax_fdm/monkey_saddle.json"};
  const thr_read_options options = thr_read_options_default();
  thr_read_report report;
  thr_frame f;
  thr_err e = {0};
  assert_ok(thr_frame_read(&f, &report, paths[_i], &options, NULL, 0, &e), &e);
  assert_begins(&f, paths[_i]);
  thr_frame_destroy(&f);
}
END_TEST

static int heard;

static void hear(void *user, const thr_cord *cord, int n_cords, const thr_symmetry_record *symmetry)
{
  (void)user;
  (void)cord;
  (void)symmetry;
  heard += n_cords > 0;
}

START_TEST(some_cords_are_heard_of_early)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = thr_request_default();
  const thr_limits limits = {.deadline = thr_clock() + 5, .found = hear};
  thr_plan p;
  thr_err e = {0};
  want(&o, aims[_i]);
  heard = 0;
  thr_status st = thr_plan_make(&f, &o, &limits, &p, NULL, &e);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", e.text);
  ck_assert_int_gt(heard, 0);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(time_is_shared_out)
{
  thr_request o = thr_request_default();
  ck_assert_double_eq(thr_dispatch_usual_seconds(&o), 0);
  o.joint = THR_JOINT_TUBE;
  ck_assert_double_eq(thr_dispatch_usual_seconds(&o), 20);
  ck_assert_double_eq(thr_dispatch_search_seconds(10, true), 5);
  ck_assert_double_eq(thr_dispatch_work(&o), 0);
  o = thr_request_default();
  o.aims = thr_aims_straightest;
  ck_assert(thr_dispatch_work(&o) > 0 && thr_dispatch_patience(&o) > 1);
  o.gap = 0.01;
  ck_assert(thr_dispatch_work(&o) == 0 &&
            thr_dispatch_patience(&o) == 1); /* who asks for a gap waits for it */
  o.gap = -1;
  o.aims = (thr_aims){1, {THR_AIM_MAX_TURNING}};
  o.cords = o.cords_least = 4;
  o.time_limit = 20;
  ck_assert(thr_dispatch_work(&o) > 0 && thr_dispatch_work(&o) < 20 &&
            thr_dispatch_patience(&o) > 1);
  ck_assert_double_eq(thr_dispatch_search_seconds(10, false), 9.5);
  ck_assert_double_ge(thr_dispatch_search_seconds(1000, false), 997);
  for (int i = 0; i < THR_N_STEPS; i++) {
    const double now = thr_clock();
    const thr_limits all = {.deadline = now + 100};
    const thr_limits share = thr_dispatch_share(&all, (thr_step)i);
    ck_assert(share.deadline > now + 1 && share.deadline < all.deadline);
    double work = 8; /* where it is counted, it alone is shared out */
    const thr_limits counted = thr_limits_counted(&all, &work),
                     part = thr_dispatch_share(&counted, (thr_step)i);
    ck_assert(part.deadline == all.deadline && part.work == &work && part.work_kept > 0 &&
              part.work_kept < work);
  }
}
END_TEST

/* ---- proofs that do not hold ---- */

/* A plan of an octahedron that is proved to be best. */
static void make_proved(thr_plan *plan, const char *aims_of_plan)
{
  thr_frame frame = solid_make(OCTAHEDRON);
  thr_request request = thr_request_default();
  const thr_limits limits = {.deadline = thr_clock() + 20};
  thr_err err = {0};
  want(&request, aims_of_plan);
  assert_ok(thr_plan_make(&frame, &request, &limits, plan, NULL, &err), &err);
  thr_frame_destroy(&frame);
}

/* The claims that thr_plan_confirm drops of the plan as it is; what is left passes the check, as it
 * is written, too. */
static int dropped_of(thr_plan *plan)
{
  thr_text text = {0};
  thr_plan again;
  thr_err err = {0};
  int dropped = -1;
  thr_plan_write(plan, &text);
  assert_ok(thr_plan_confirm(plan, &text, "plan", &dropped, &err), &err);
  ck_assert_int_eq(thr_check_plan(plan, NULL), THR_OK);
  ck_assert_int_eq(thr_plan_parse(&again, text.data, text.length, "again", NULL), THR_OK);
  ck_assert_int_eq(thr_check_plan(&again, NULL), THR_OK);
  ck_assert(again.turning.present == plan->turning.present &&
            again.proof.present == plan->proof.present);
  thr_plan_destroy(&again);
  thr_text_destroy(&text);
  return dropped;
}

/* Of a wrong proof only its claim is dropped, whether the reader refuses it or the checker does. */
START_TEST(what_does_not_hold_is_dropped_and_the_rest_is_kept)
{
  thr_plan plan;
  make_proved(&plan, "turning");
  ck_assert_int_eq(dropped_of(&plan), 0);
  ck_assert(plan.turning.optimal && plan.proof.optimal);

  /* A negative multiplier, which is not read. */
  thr_turning_dual *dual = &plan.turning.tree.dual[0];
  dual->rank = calloc(1, sizeof *dual->rank);
  dual->rank[0] =
      (thr_turning_partition){calloc((size_t)plan.frame.n_edges, sizeof *dual->rank->block), -1};
  dual->n_ranks = 1;
  ck_assert_int_eq(dropped_of(&plan), THR_CLAIM_TURNING);
  ck_assert(plan.proof.optimal && !plan.turning.present);

  /* Multipliers that prove less than is claimed, by more than the angle that all turns are
   * multiples of. */
  thr_plan_destroy(&plan);
  make_proved(&plan, "turning");
  plan.turning.tree.dual[0].potential[0] -= INT64_C(1) << 46;
  ck_assert_int_eq(dropped_of(&plan), THR_CLAIM_TURNING);

  /* Both claims. */
  thr_plan_destroy(&plan);
  make_proved(&plan, "turning");
  plan.turning.tree.dual[0].potential[0] -= INT64_C(1) << 46;
  plan.proof.certificate[0].sum++;
  ck_assert_int_eq(dropped_of(&plan), THR_CLAIM_TURNING + THR_CLAIM_LENGTH);
  thr_plan_destroy(&plan);
}
END_TEST

START_TEST(a_broken_plan_is_not_kept)
{
  thr_plan plan;
  thr_text text = {0};
  thr_err err = {0};
  int dropped;
  make_proved(&plan, "length");
  plan.metrics.length *= 2;
  thr_plan_write(&plan, &text);
  ck_assert_int_eq(thr_plan_confirm(&plan, &text, "plan", &dropped, &err), THR_ESOLVER);
  ck_assert_ptr_nonnull(strstr(err.text, "metrics.length"));
  ck_assert_int_eq(plan.n_cords, 0);
  thr_text_destroy(&text);
  thr_plan_destroy(&plan);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("planner");
  add_case(s, "objectives", 60, plans_for_every_objective_are_written_and_read, 0,
           THR_N_OBJECTIVES);
  add_case(s, "recommended", 60, what_is_recommended_stays_within_the_hand, 0, 2);
  add_case(s, "recommended as given", 60, what_is_recommended_keeps_ends_and_joints, 0, 3);
  ADD_TEST(s, 60, what_is_recommended_ends_at_odd_nodes);
  add_case(s, "recommended by parts", 60, what_is_recommended_counts_cords_in_every_component, 0,
           1);
  add_case(s, "proofs", 60, every_plan_comes_with_proofs, 0, 2 * THR_N_OBJECTIVES);
  add_case(s, "tours", 20, classical_tours_take_no_notice_of_time, 0, 4);
  add_case(s, "starts", 60, turning_begins_with_tours_and_the_shortest_cords, 0, 4);
  add_case(s, "data", 60, turning_of_data_begins_so, 0, 15);
  add_case(s, "heard", 60, some_cords_are_heard_of_early, 0, THR_N_OBJECTIVES);
  add_case(s, "dropped", 60, what_does_not_hold_is_dropped_and_the_rest_is_kept, 0, 1);
  add_case(s, "broken", 60, a_broken_plan_is_not_kept, 0, 1);
  add_case(s, "time", 10, time_is_shared_out, 0, 1);
  return run_suite(s);
}
