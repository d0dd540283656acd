/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a hand reads of a plan: instructions counted by hand. */
#include "graph/plan/plan_measures.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NODES = 80, MOST_CORDS = 4 };

/* Cords through places that are all different nodes, but that a closed cord comes back to its
 * first. */
typedef struct {
  double xyz[MOST_NODES][3];
  int n, first[MOST_CORDS], last[MOST_CORDS];
  bool closed[MOST_CORDS];
  int n_cords;
} sketch;

static void begin(sketch *s, bool closed)
{
  s->first[s->n_cords] = s->n;
  s->closed[s->n_cords++] = closed;
}

static void go(sketch *s, double x, double y)
{
  s->xyz[s->n][0] = x;
  s->xyz[s->n][1] = y;
  s->last[s->n_cords - 1] = s->n++;
}

static thr_reading read_with(const sketch *s, thr_ends ends, const thr_symmetry_record *record)
{
  int edge[MOST_NODES][2], half[MOST_NODES], m = 0;
  thr_cord cord[MOST_CORDS] = {0};
  for (int c = 0; c < s->n_cords; c++) {
    cord[c].closed = s->closed[c];
    cord[c].half = half + m;
    for (int v = s->first[c]; v < s->last[c] + s->closed[c]; v++) {
      edge[m][0] = v;
      edge[m][1] = v < s->last[c] ? v + 1 : s->first[c];
      half[m] = 2 * m;
      m++;
      cord[c].n_passes++;
    }
  }
  thr_plan p = {.frame = frame_make(s->n, s->xyz, m, (const int(*)[2])edge, NULL, NULL),
                .options = options_for(ends, 1)};
  for (int i = 0; i < m; i++) /* the frame may know an edge by another number */
    half[i] = 2 * thr_frame_edge_between(&p.frame, edge[i][0], edge[i][1]);
  for (int i = 0; i < m; i++)
    half[i] += p.frame.edge[half[i] >> 1][0] != edge[i][0];
  p.cord = cord;
  p.n_cords = s->n_cords;
  if (record) p.symmetry = *record;
  const thr_reading out = thr_reading_of(&p);
  thr_frame_destroy(&p.frame);
  return out;
}

static void assert_reads(const sketch *s, thr_ends ends, int instructions, int repeated, int moved)
{
  const thr_reading r = read_with(s, ends, NULL);
  ck_assert_msg(r.instructions == instructions && r.repeated == repeated && r.moved == moved,
                "%d instructions, %d, %d", r.instructions, r.repeated, r.moved);
}

static void stairs(sketch *s, double x, double y, int steps, double up)
{
  begin(s, false);
  go(s, x, y);
  for (int i = 0; i < steps; i++) {
    go(s, x + i + 1, y + up * i);
    go(s, x + i + 1, y + up * (i + 1));
  }
}

START_TEST(straight_on_is_one_instruction)
{
  sketch line = {0}, bent = {0};
  begin(&line, false);
  for (int i = 0; i < 8; i++)
    go(&line, i, 0);
  assert_reads(&line, THR_ENDS_FEET, 1, 0, 0);
  assert_reads(&line, THR_ENDS_ANY, 3, 0, 0);
  begin(&bent, false); /* 14, then 16 degrees */
  go(&bent, 0, 0);
  go(&bent, 1, 0);
  go(&bent, 1 + cos(14 * THR_STRAIGHT / 15), sin(14 * THR_STRAIGHT / 15));
  assert_reads(&bent, THR_ENDS_FEET, 1, 0, 0);
  go(&bent, bent.xyz[2][0] + cos(2 * THR_STRAIGHT), bent.xyz[2][1] + sin(2 * THR_STRAIGHT));
  assert_reads(&bent, THR_ENDS_FEET, 2, 0, 0);
}
END_TEST

/* Twelve turns of 30 degrees are read; 36 of 10 degrees are "go round". */
START_TEST(rings_are_read_once_round)
{
  for (int n = 12; n <= 36; n += 24) {
    sketch ring = {0};
    begin(&ring, true);
    for (int i = 0; i < n; i++)
      go(&ring, cos(24 * THR_STRAIGHT * i / n), sin(24 * THR_STRAIGHT * i / n));
    assert_reads(&ring, THR_ENDS_ANY, n == 12 ? 12 : 1, 0, 0);
    assert_reads(&ring, THR_ENDS_CLOSED, n == 12 ? 12 : 1, 0, 0);
  }
}
END_TEST

/* One step of the stairs is read, and how often it comes. Stairs that are once off are read to the
 * end. */
START_TEST(what_repeats_is_read_once)
{
  sketch s = {0}, warped = {0};
  stairs(&s, 0, 0, 5, 1);
  assert_reads(&s, THR_ENDS_FEET, 3, 1, 0);
  assert_reads(&s, THR_ENDS_ANY, 5, 1, 0);
  stairs(&warped, 0, 0, 5, 1);
  warped.xyz[6][1] += 0.04;
  assert_reads(&warped, THR_ENDS_FEET, 3, 1, 0);
  warped.xyz[6][1] += 0.03;
  assert_reads(&warped, THR_ENDS_FEET, 10, 0, 0);
  sketch once = {0};
  stairs(&once, 0, 0, 1, 1);
  assert_reads(&once, THR_ENDS_FEET, 2, 0, 0);
}
END_TEST

/* Two more flights as the first, one of them from its other end: one instruction. A flight that
 * goes down is another path. */
START_TEST(what_is_moved_along_is_not_read_again)
{
  sketch s = {0};
  stairs(&s, 0, 0, 3, 1);
  stairs(&s, 10, 0, 3, 1);
  stairs(&s, 0, 20, 3, 1);
  for (int i = 0; i < 3; i++) /* turned round */
    for (int k = 0; k < 3; k++) {
      double kept = s.xyz[s.first[2] + i][k];
      s.xyz[s.first[2] + i][k] = s.xyz[s.last[2] - i][k];
      s.xyz[s.last[2] - i][k] = kept;
    }
  assert_reads(&s, THR_ENDS_FEET, 4, 1, 2);
  stairs(&s, 30, 20, 3, -1);
  assert_reads(&s, THR_ENDS_FEET, 7, 2, 2);
  sketch rings = {0};
  for (int r = 0; r < 2; r++) { /* a square, and it again from another corner the other way round */
    begin(&rings, true);
    for (int i = 0; i < 4; i++) {
      const int corner = r ? (6 - i) % 4 : i;
      go(&rings, 5 * r + (corner == 1 || corner == 2), corner >= 2);
    }
  }
  assert_reads(&rings, THR_ENDS_ANY, 5, 0, 1);
}
END_TEST

/* ---- paths that a group maps to themselves ---- */

static thr_reading read_with_group(const sketch *s, thr_ends ends, int n_generators,
                                   const int *generator, int n_images, const int *image,
                                   int *unique, int *element)
{
  const thr_symmetry_record record = {.present = true,
                                      .n_generators = n_generators,
                                      .generator = (int *)generator,
                                      .n_images = n_images,
                                      .image = (int *)image,
                                      .unique = unique,
                                      .element = element};
  return read_with(s, ends, &record);
}

static void star_ring(sketch *s, double x, int tips)
{
  begin(s, true);
  for (int i = 0; i < 2 * tips; i++) {
    const double radius = i % 2 ? 1 : 2, angle = 12 * THR_STRAIGHT * i / tips;
    go(s, x + radius * cos(angle), radius * sin(angle));
  }
}

/* A star of six tips: turned, tip and valley are read; mirrored, one edge. Without a group all
 * twelve. */
START_TEST(a_star_is_read_for_one_tip)
{
  enum { N = 12 };
  sketch s = {0};
  int generator[2 * N], identity[N], unique[] = {0}, element[] = {0};
  star_ring(&s, 0, N / 2);
  for (int v = 0; v < N; v++) {
    generator[v] = (v + 2) % N;
    generator[N + v] = (N - v) % N;
    identity[v] = v;
  }
  assert_reads(&s, THR_ENDS_CLOSED, N, 0, 0);
  thr_reading r = read_with_group(&s, THR_ENDS_CLOSED, 1, generator, 1, identity, unique, element);
  ck_assert_msg(r.instructions == 3 && r.mapped == 1, "%d", r.instructions);
  r = read_with_group(&s, THR_ENDS_CLOSED, 2, generator, 1, identity, unique, element);
  ck_assert_msg(r.instructions == 2 && r.mapped == 1, "%d", r.instructions);
  r = read_with_group(&s, THR_ENDS_CLOSED, 1, generator + N, 1, identity, unique,
                      element); /* five tips and valleys between mirrors */
  ck_assert_msg(r.instructions == 7 && r.mapped == 1, "%d", r.instructions);
}
END_TEST

/* Two stars, and one element that takes the first to the second and, turned by a tip, back: only
 * doing it twice maps a star to itself. */
START_TEST(what_turns_a_path_may_go_by_its_copy)
{
  enum { N = 12 };
  sketch s = {0};
  int generator[2 * N], image[4 * N], unique[] = {0, 0}, element[] = {0, 1};
  star_ring(&s, 0, N / 2);
  star_ring(&s, 10, N / 2);
  for (int v = 0; v < N; v++) {
    generator[v] = N + v;
    generator[N + v] = (v + 4) % N;
  }
  for (int v = 0; v < 2 * N; v++) {
    image[v] = v;
    image[2 * N + v] = generator[v];
  }
  const thr_reading r =
      read_with_group(&s, THR_ENDS_CLOSED, 1, generator, 2, image, unique, element);
  ck_assert_msg(r.instructions == 5 && r.mapped == 1 && r.moved == 0, "%d", r.instructions);
}
END_TEST

/* A zigzag of six passes and five turns, mirrored at its middle: three passes and "back as you
 * came"; of two ends one. */
START_TEST(an_open_path_is_read_to_its_middle)
{
  enum { N = 7 };
  sketch s = {0};
  int generator[N], identity[N], unique[] = {0}, element[] = {0};
  static const double y[N] = {0, 1, 0.5, 2, 0.5, 1, 0};
  begin(&s, false);
  for (int v = 0; v < N; v++) {
    go(&s, v, y[v]);
    generator[v] = N - 1 - v;
    identity[v] = v;
  }
  assert_reads(&s, THR_ENDS_ANY, 8, 0, 0);
  const thr_reading feet = read_with_group(&s, THR_ENDS_FEET, 1, generator, 1, identity, unique,
                                           element),
                    any = read_with_group(&s, THR_ENDS_ANY, 1, generator, 1, identity, unique,
                                          element);
  ck_assert_msg(feet.instructions == 4 && any.instructions == 5, "%d, %d", feet.instructions,
                any.instructions);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("reading");
  ADD_TEST(s, 10, straight_on_is_one_instruction);
  ADD_TEST(s, 10, rings_are_read_once_round);
  ADD_TEST(s, 10, what_repeats_is_read_once);
  ADD_TEST(s, 10, what_is_moved_along_is_not_read_again);
  ADD_TEST(s, 10, a_star_is_read_for_one_tip);
  ADD_TEST(s, 10, what_turns_a_path_may_go_by_its_copy);
  ADD_TEST(s, 10, an_open_path_is_read_to_its_middle);
  return run_suite(s);
}
