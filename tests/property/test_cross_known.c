/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole program on frameworks and options that were wrong once, and on kinds of frameworks that
 * chance seldom makes, against exhaustive search over walks (tests/judging.h). */
#include "tests/judging.h"
#include "tests/crossing.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *self; /* as it was called */

/* A framework as JSON, and options in both forms; ends are any, feet, closed or counted. */
typedef struct {
  const char *nodes, *edges, *more; /* members of the frame */
  const char *arguments;
  thr_request o;
  int end_count[12];
} known_case;

#define CAPACITY(n) .capacity = (n)
#define CORDS(a, b) .cords_least = (a), .cords = (b)
#define TURNING(slack, price) .turning = {.length_slack = (slack), .cost = (price)}
#define AIM(what) .aims = {1, {THR_AIM_##what}}

static const known_case known[] = {
    /* The shortest passes need a full edge, or turn back: the slack was measured from them, and no
       plan found. */
    {"[71.06,75.96,42.594],[49.682,21.57,50.028],[98.593,81.205,36.736]",
     "[0,1],[0,2],[1,2]",
     "\"lengths\": [25.495,70.003,13.585], \"covers\": [1,1,3]",
     "--objective tortuosity --capacity 3 --length-slack 10 --turn-cost step --minimize "
     "max-turning --ends any",
     {AIM(MAX_TURNING), CAPACITY(3), CORDS(1, 1), TURNING(0.1, THR_TURN_STEP),
      .ends = THR_ENDS_ANY},
     {0}},
    {"[74,95,11],[86,98,6],[17,31,32]",
     "[1,0],[2,0]",
     "\"lengths\": [77.524,75.204], \"covers\": [1,2]",
     "--objective tortuosity --cords 2 --length-slack 40 --turn-cost step --ends 1:1,2:3",
     {AIM(TURNING), CORDS(2, 2), TURNING(0.4, THR_TURN_STEP), .ends = THR_ENDS_COUNTS},
     {0, 1, 3}},
    /* Every edge that a tour would need once more is full: it took one nevertheless. */
    {"[50,0,50],[0,100,50],[50,0,0],[100,0,0]",
     "[1,0],[2,1],[1,3],[3,0]",
     "\"capacities\": [1,null,3,null]",
     "--objective tortuosity --capacity 1 --length-slack 0 --tour fleury --ends any",
     {AIM(TURNING), CAPACITY(1), CORDS(1, 1), .turning = {.tour = THR_TOUR_FLEURY},
      .ends = THR_ENDS_ANY},
     {0}},
    /* One number of cords was tried for all pieces. */
    {"[0,0,0],[40,0,0],[80,0,0],[400,0,0],[440,0,0]",
     "[0,1],[1,2],[3,4]",
     "\"feet\": [0,1,2,3,4]",
     "--joint tube --cover 2 --capacity 2 --balance --cords 1..3 --ends feet",
     {.joint = THR_JOINT_TUBE,
      .cover = 2,
      CAPACITY(2),
      AIM(LONGEST),
      CORDS(1, 3),
      .ends = THR_ENDS_FEET},
     {0}},
    {"[0,0,0],[40,0,0],[80,0,0],[450,0,0],[375,43,0],[375,-43,0]",
     "[1,0],[1,2],[4,3],[4,5],[3,5]",
     "\"lengths\": [10,10,10,10,10], \"capacities\": [2,1,null,null,2], \"feet\": [0,2,3,4]",
     "--joint tube --capacity 3 --cords auto --max-length 39.5 --ends feet",
     {.joint = THR_JOINT_TUBE,
      CAPACITY(3),
      CORDS(1, 1000),
      .max_length = 39.5,
      .ends = THR_ENDS_FEET},
     {0}},
    {"[12,8,77],[24,84,13],[6,93,69],[406,8,31],[473,2,27],[435,34,7],[403,37,76]",
     "[0,1],[0,2],[2,1],[3,4],[3,5],[6,3],[6,5],[4,5],[6,4]",
     "\"lengths\": [10,10,10,10,10,10,10,10,10], \"feet\": [2,3,4,5,6]",
     "--capacity 1 --cords ..8 --max-length 69.5 --ends feet",
     {CAPACITY(1), CORDS(1, 8), .max_length = 69.5, .ends = THR_ENDS_FEET},
     {0}},
};
enum { N_KNOWN = sizeof known / sizeof *known };

static void write_frame(const char *path, const char *nodes, const char *edges, const char *more)
{
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  fprintf(out, "{\"nodes\": [%s], \"edges\": [%s]%s%s}\n", nodes, edges, *more ? ", " : "", more);
  ck_assert_int_eq(fclose(out), 0);
}

/* Judges one case with these options; the lists of o belong to the caller. */
static void judge_given(const char *path, const thr_request *o, const char *arguments)
{
  static judged j;
  counts n = {0};
  int component[64];
  memset(&j, 0, sizeof j);
  j.c.f = frame_load(path, NULL);
  j.c.o = *o;
  if (j.c.o.cover == 0) j.c.o.cover = 1;
  snprintf(j.c.frame_path, sizeof j.c.frame_path, "%s", path);
  snprintf(j.c.arguments, sizeof j.c.arguments, " %s", arguments);
  ck_assert_int_eq(thr_frame_components(&j.c.f, component, &j.n_pieces, NULL), THR_OK);
  judged_case(&j, &n);
  thr_frame_destroy(&j.c.f);
  ck_assert_int_eq(n.unsure, 0);
  ck_assert_int_eq(n.findings, 0);
}

START_TEST(what_was_wrong_once)
{
  const known_case *k = &known[_i];
  thr_request o = k->o;
  int end_count[12];
  char path[128];
  judging_begin(self);
  snprintf(path, sizeof path, "%s/frame.json", judging_folder);
  write_frame(path, k->nodes, k->edges, k->more);
  memcpy(end_count, k->end_count, sizeof end_count);
  o.end_count = end_count;
  if (!thr_wants_turning(&o)) o.turning.length_slack = -1;
  judge_given(path, &o, k->arguments);
  judging_end();
}
END_TEST

/* A tetrahedron and a triangle: symmetric plans have two cords in one and one in the other. */
START_TEST(symmetric_pieces_have_numbers_of_their_own)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_request o = thr_request_default();
  char path[128], nodes[400] = "";
  judging_begin(self);
  snprintf(path, sizeof path, "%s/frame.json", judging_folder);
  for (int v = 0; v < 7; v++) {
    size_t n = strlen(nodes);
    snprintf(nodes + n, sizeof nodes - n, "%s[%d,%d,%d]", v ? "," : "",
             (v < 4 ? 0 : 400) + rng_below(&r, 101), rng_below(&r, 101), rng_below(&r, 101));
  }
  write_frame(path, nodes, "[0,1],[0,2],[0,3],[1,2],[1,3],[2,3],[4,5],[5,6],[6,4]",
              "\"feet\": [0,1,4,5]");
  want(&o, "overlap,steps");
  o.joint = THR_JOINT_TUBE;
  o.ends = _i % 2 ? THR_ENDS_ANY : THR_ENDS_FEET;
  judge_given(path, &o,
              _i % 2 ? "--objective symmetry --joint tube --ends any"
                     : "--objective symmetry --joint tube --ends feet");
  judging_end();
}
END_TEST

/* Two unit vectors at right angles. */
static void right_angle(rng *r, double x[3], double y[3])
{
  double along = 0, size = 0, width = 0;
  for (int i = 0; i < 3; i++) {
    x[i] = rng_unit(r) - 0.5;
    y[i] = rng_unit(r) - 0.5;
    size += x[i] * x[i];
    along += x[i] * y[i];
  }
  for (int i = 0; i < 3; i++) {
    y[i] -= along / size * x[i];
    width += y[i] * y[i];
  }
  for (int i = 0; i < 3; i++) {
    x[i] /= sqrt(size);
    y[i] /= sqrt(width);
  }
}

/* A star of three or four spokes, most pairs of which turn by 90 degrees less 1e-6, give or take
 * some of the last digits: whoever prices steps must price all of them alike. */
START_TEST(steps_at_their_threshold)
{
  enum { SPOKES = 4 };
  rng r = rng_make((uint64_t)_i + 1);
  thr_request o = thr_request_default();
  char path[128], nodes[600] = "[0,0,0]";
  double x[3], y[3], size = 1 + 99 * rng_unit(&r),
                     angle = acos(0) - 1e-6 * (1 + 1e-10 * rng_between(&r, -3, 3));
  judging_begin(self);
  snprintf(path, sizeof path, "%s/frame.json", judging_folder);
  right_angle(&r, x, y);
  for (int k = 0; k < SPOKES;
       k++) { /* those of even number are opposite to each other, as are the others */
    double at[3];
    for (int i = 0; i < 3; i++)
      at[i] = (k < 2 ? size : -size) * (k % 2 ? sin(angle) * y[i] - cos(angle) * x[i] : x[i]);
    size_t n = strlen(nodes);
    snprintf(nodes + n, sizeof nodes - n, ",[%.17g,%.17g,%.17g]", at[0], at[1], at[2]);
  }
  write_frame(path, nodes, _i % 2 ? "[0,1],[0,2],[3,0],[4,0]" : "[0,1],[2,0],[0,3]", "");
  want(&o, "turning");
  o.ends = THR_ENDS_ANY;
  o.turning.cost = THR_TURN_STEP;
  judge_given(path, &o, "--objective tortuosity --turn-cost step --ends any --weld 0");
  judging_end();
}
END_TEST

int main(int argc, char **argv)
{
  (void)argc;
  self = argv[0];
  Suite *s = suite_create("known cases");
  ADD_LOOP(s, 60, what_was_wrong_once, 0, N_KNOWN);
  ADD_EXAMPLES(s, 60, symmetric_pieces_have_numbers_of_their_own, 8);
  ADD_LOOP(s, 30, steps_at_their_threshold, 0, 24);
  return run_suite(s);
}
