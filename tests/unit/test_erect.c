/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How structures come up: what stands without a cord comes up by itself, stills are what they say,
 * nonsense is refused, and equal input gives equal bits. */
#include "eval/structure/beads.h"

#include "graph/framework/frame.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_frame frame;
  thr_physics physics;
  thr_beads beads;
  thr_cord cord;
} column;

static int HALF[] = {0, 2, 4};
static const double EVEN[] = {1, 1, 1};

/* Four beads in a line, a tenth as wide as long; the first is held in place. */
static column column_of(const double direction[3])
{
  column c = {.physics = thr_physics_default(), .cord = {.id = "A", .n_passes = 3, .half = HALF}};
  double xyz[4][3];
  thr_err err = {0};
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++)
      xyz[i][k] = 0.4 * i * direction[k];
  c.frame = frame_make(4, (const double(*)[3])xyz, 3, (const int[][2]){{0, 1}, {1, 2}, {2, 3}},
                       NULL, NULL);
  memcpy(c.frame.units, "m", 2);
  c.physics.bead_diameter = 120;
  c.physics.bore = 10;
  assert_ok(thr_beads_make(&c.frame, &c.physics, &c.beads, &err), &err);
  thr_beads_clamp(&c.beads, (const bool[]){true, false, false, false});
  return c;
}

static void column_destroy(column *c)
{
  thr_beads_destroy(&c->beads);
  thr_frame_destroy(&c->frame);
}

static thr_status run(const column *c, double pull, thr_erect *out, thr_err *err)
{
  const thr_erect_options o = {.pull = pull, .time_step = 1, .iterations = 1, .seed = 1};
  return thr_erect_run(&c->beads, &c->frame, &c->cord, 1, (const double *const[]){EVEN},
                       &c->physics, &o, NULL, out, err);
}

static thr_erect erect_of(const column *c, double pull)
{
  thr_erect e;
  thr_err err = {0};
  assert_ok(run(c, pull, &e, &err), &err);
  ck_assert(e.present && e.pose && e.n_beads == 4 && e.n_gaps == 3);
  return e;
}

/* What needs no cord is never down: no counterweight, all faces closed from the start, as high as
 * drawn. */
START_TEST(what_stands_comes_up_by_itself)
{
  column c = column_of((const double[]){0, 0, 1});
  thr_erect e = erect_of(&c, 10 * c.beads.mass[1]);
  ck_assert(e.lift == 0);
  ck_assert_double_eq_tol(e.weight, 9.81 * (c.beads.mass[1] + c.beads.mass[2] + c.beads.mass[3]),
                          0.01 * e.weight);
  for (int i = 0; i < THR_ERECT_STILLS; i++) {
    ck_assert_int_eq(e.still[i].closed, 3);
    ck_assert_double_eq_tol(e.still[i].height, e.drawn, 0.01 * e.drawn);
  }
  thr_erect_destroy(&e);
  column_destroy(&c);
}
END_TEST

/* A cantilever hangs down from its wall under a slack cord and is drawn straight again: against its
 * weight if the cord draws hard enough, or else with a counterweight. Moments about the lower edge:
 * weight x arm = pull x half the width. */
START_TEST(a_cantilever_is_drawn_up)
{
  column c = column_of((const double[]){1, 0, 0});
  double moment = 0;
  for (int v = 1; v < 4; v++)
    moment += 9.81 * c.beads.mass[v] * (c.beads.mass_centre[v][0] - c.beads.middle[0][0]);
  thr_erect e = erect_of(&c, moment / (c.beads.width / 2));
  ck_assert(e.lift >= 0);
  const thr_erect_still *slack = &e.still[0], *last = &e.still[THR_ERECT_STILLS - 1];
  ck_assert_double_gt(slack->gap, 2);
  ck_assert_int_lt(slack->closed, 3);
  ck_assert_int_eq(last->closed, 3);
  ck_assert(slack->lift == 0 && last->lift == 0);
  for (int i = 1; i < THR_ERECT_STILLS; i++)
    ck_assert_double_ge(e.still[i].pull, e.still[i - 1].pull);
  const double(*down)[7] = (const double(*)[7])e.pose, (*up)[7] = down + 4 * (THR_ERECT_STILLS - 1);
  ck_assert_double_lt(down[3][2], up[3][2] - 0.06);
  ck_assert_double_eq_tol(up[3][2], c.beads.centre[3][2], 0.02);
  thr_erect again = erect_of(&c, moment / (c.beads.width / 2));
  ck_assert(memcmp(e.pose, again.pose, THR_ERECT_STILLS * 4 * sizeof *e.pose) == 0);
  thr_erect_destroy(&e);
  thr_erect_destroy(&again);
  column_destroy(&c);
}
END_TEST

START_TEST(nonsense_is_refused)
{
  column c = column_of((const double[]){0, 0, 1});
  const double wrong[] = {0, -1, NAN, INFINITY};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_erect e;
    thr_err err = {0};
    assert_status(run(&c, wrong[i], &e, &err), THR_EINPUT, &err, "pull");
    ck_assert(!e.present && !e.pose);
  }
  thr_erect_destroy(NULL);
  column_destroy(&c);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("erect");
  ADD_TEST(s, 120, what_stands_comes_up_by_itself);
  ADD_TEST(s, 120, a_cantilever_is_drawn_up);
  ADD_TEST(s, 10, nonsense_is_refused);
  return run_suite(s);
}
