/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes by the geometry of the finished picture: which strands cross in a node is read from where
 * they enter and leave it. */
#include "diagram/layout/layout.h"
#include "diagram/scene/scene.h"
#include "graph/number.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CORDS = 8, MOST_PASSES = 200, MOST_STRANDS = 100, MOST_NODES = 130 };

/* A framework in the plane with cords that are built pass by pass. */
typedef struct {
  int n_nodes, n_edges;
  double xyz[MOST_NODES][3];
  int edge[2 * MOST_NODES][2];
  int half[MOST_CORDS][MOST_PASSES];
  thr_cord cord[MOST_CORDS];
  thr_plan plan;
  thr_layout layout;
  thr_scene scene;
} picture;

static int add_node(picture *p, double x, double y)
{
  ck_assert_int_lt(p->n_nodes, MOST_NODES);
  p->xyz[p->n_nodes][0] = x;
  p->xyz[p->n_nodes][1] = y;
  return p->n_nodes++;
}

/* The edge points either way. */
static void add_edge(picture *p, rng *r, int a, int b)
{
  int way = rng_below(r, 2);
  p->edge[p->n_edges][way] = a;
  p->edge[p->n_edges++][!way] = b;
}

static void go(picture *p, int c, int half)
{
  ck_assert_int_lt(p->cord[c].n_passes, MOST_PASSES);
  p->half[c][p->cord[c].n_passes++] = half;
}

/* Goes on from node a along an edge; returns where that leads. */
static int go_along(picture *p, int c, int a, int e)
{
  bool back = p->edge[e][1] == a;
  ck_assert(back || p->edge[e][0] == a);
  go(p, c, 2 * e + back);
  return p->edge[e][!back];
}

static void reverse(picture *p, int c)
{
  int n = p->cord[c].n_passes, *half = p->half[c];
  for (int i = 0; 2 * i < n; i++) {
    int t = half[i];
    half[i] = half[n - 1 - i] ^ 1;
    half[n - 1 - i] = t ^ 1;
  }
}

static void draw(picture *p, int n_cords)
{
  thr_err err = {0};
  p->plan = (thr_plan){.frame = frame_make(p->n_nodes, (const double(*)[3])p->xyz, p->n_edges,
                                           (const int(*)[2])p->edge, NULL, NULL),
                       .n_cords = n_cords,
                       .cord = p->cord};
  p->plan.options.ends = THR_ENDS_ANY;
  for (int c = 0; c < n_cords; c++) {
    p->cord[c].half = p->half[c];
    thr_cord_id(c, p->cord[c].id);
  }
  assert_ok(thr_layout_make(&p->layout, &p->plan.frame, THR_LAYOUT_PLAN, &err), &err);
  assert_ok(thr_scene_build(&p->scene, &p->plan, &p->layout, 0, false, &err), &err);
}

static void picture_destroy(picture *p)
{
  thr_scene_destroy(&p->scene);
  thr_layout_destroy(&p->layout);
  thr_frame_destroy(&p->plan.frame);
}

/* ---- what crosses ---- */

/* Where a pass begins or ends on paper; passes a and b have changed places in their bead (-1:
 * none). */
static const double *end_of(const thr_scene *s, int i, bool end, int a, int b)
{
  int other = i == a ? b : i == b ? a : i;
  bool same = s->pass[i].half == s->pass[other].half;
  return end == same ? s->pass[other].to : s->pass[other].from;
}

/* Places of the ways through point v round about it. */
static int strands_at(const thr_scene *s, int v, int a, int b, double strand[][2])
{
  int n = 0;
  for (int i = 0; i < s->n_passes; i++) {
    const double *from[2] = {NULL}, *to[2] = {NULL};
    const thr_mark *before = thr_scene_mark_before(s, i), *after = thr_scene_mark_after(s, i);
    if (before && before->point == v) from[0] = before->at, to[0] = end_of(s, i, false, a, b);
    if (thr_head(s->paper, s->pass[i].half) == v) {
      from[1] = end_of(s, i, true, a, b);
      to[1] = after ? after->at : end_of(s, i + 1, false, a, b);
    }
    for (int k = 0; k < 2; k++) {
      if (!from[k]) continue;
      ck_assert_int_lt(n, MOST_STRANDS);
      strand[n][0] = atan2(from[k][1] - s->at[v][1], from[k][0] - s->at[v][0]);
      strand[n++][1] = atan2(to[k][1] - s->at[v][1], to[k][0] - s->at[v][0]);
    }
  }
  return n;
}

static bool between(double x, const double strand[2])
{
  return (x > strand[0]) != (x > strand[1]);
}

/* Pairs of ways through point v that cross there. */
static int crossings_at(const thr_scene *s, int v, int a, int b)
{
  double strand[MOST_STRANDS][2];
  int n = strands_at(s, v, a, b, strand), count = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      count += between(strand[i][0], strand[j]) != between(strand[i][1], strand[j]);
  return count;
}

static int crossings(const thr_scene *s)
{
  int count = 0;
  for (int v = 0; v < s->layout->n_points; v++)
    count += crossings_at(s, v, -1, -1);
  return count;
}

/* Every pass has a lane of its own in its bead, and the list of the bead is by lane. */
static void assert_lanes_are_taken_once(const thr_scene *s)
{
  int seen = 0;
  for (int e = 0; e < s->frame->n_edges; e++)
    for (int i = s->first_on[e]; i < s->first_on[e + 1]; i++, seen++)
      ck_assert(s->pass[s->on[i]].half / 2 == e && s->pass[s->on[i]].lane == i - s->first_on[e]);
  ck_assert_int_eq(seen, s->n_passes);
}

/* ---- parallel runs ---- */

/* Cords run side by side along a winding way of `length` edges, from n places fanned out at one end
 * to n at the other: cord i from the i-th from above to the place[i]-th. */
static void make_run(picture *p, rng *r, int length, int n, const int *place)
{
  double x = 0, y = 0;
  int way = add_node(p, x, y), m = length + 2 * n, ends[2 * MOST_NODES][2], order[2 * MOST_NODES],
      number[2 * MOST_NODES];
  for (int i = 0; i < length; i++) {
    double a = 1.6 * rng_unit(r) - 0.8;
    int next = add_node(p, x += cos(a), y += sin(a));
    ends[i][0] = next - 1, ends[i][1] = next;
  }
  for (int i = 0; i < 2 * n; i++) {
    double a = THR_PI / 2 - THR_PI * (i % n + 0.5) / n;
    int end = i / n, hub = end ? way + length : way;
    ends[length + i][0] = hub;
    ends[length + i][1] =
        add_node(p, p->xyz[hub][0] + (end ? 2 : -2) * cos(a), p->xyz[hub][1] + 2 * sin(a));
  }
  for (int i = 0; i < m; i++)
    order[i] = i;
  rng_shuffle(r, order, m);
  for (int i = 0; i < m; i++) {
    number[order[i]] = i;
    add_edge(p, r, ends[order[i]][0], ends[order[i]][1]);
  }
  for (int c = 0; c < n; c++) {
    int at = go_along(p, c, ends[length + c][1], number[length + c]);
    for (int i = 0; i < length; i++)
      at = go_along(p, c, at, number[i]);
    go_along(p, c, at, number[length + n + place[c]]);
  }
}

static int inversions(const int *place, int n)
{
  int count = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      count += place[j] > place[i];
  return count;
}

/* Two cords must cross if they change sides, and need not do so twice. */
START_TEST(parallel_cords_cross_only_if_they_change_sides)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int k = 0; k < 12; k++) {
    picture *p = calloc(1, sizeof *p);
    int n = 2 + k % 4, length = rng_between(&r, 1, 100),
        place[MOST_CORDS] = {0, 1, 2, 3, 4, 5, 6, 7};
    rng_shuffle(&r, place, n);
    make_run(p, &r, length, n, place);
    for (int c = 0; c < n; c++)
      if (k % 3 == 1 || (n == 2 && rng_below(&r, 2))) reverse(p, c);
    draw(p, n);
    assert_lanes_are_taken_once(&p->scene);
    ck_assert_msg(crossings(&p->scene) == inversions(place, n),
                  "%d cords over %d edges: %d crossings, needed are %d", n, length,
                  crossings(&p->scene), inversions(place, n));
    picture_destroy(p);
    free(p);
  }
}
END_TEST

/* ---- any cords ---- */

/* Cords that go along edges at random, turning back at times. */
static void wander(picture *p, rng *r, int n_cords, int n_passes)
{
  for (int c = 0; c < n_cords; c++)
    for (int i = 0, at = rng_below(r, p->n_nodes); i < n_passes;) {
      int e = rng_below(r, p->n_edges);
      if (p->edge[e][0] != at && p->edge[e][1] != at) continue;
      at = go_along(p, c, at, e);
      i++;
    }
}

/* A star of three or four edges, or a wheel. */
static void make_wheel(picture *p, rng *r, bool star)
{
  int rim = star ? rng_between(r, 3, 4) : rng_between(r, 4, 7);
  add_node(p, 0, 0);
  for (int i = 0; i < rim; i++)
    add_node(p, 3 * cos(2 * THR_PI * i / rim + 0.3), 3 * sin(2 * THR_PI * i / rim + 0.3));
  for (int i = 0; i < rim; i++) {
    add_edge(p, r, 0, 1 + i);
    if (!star) add_edge(p, r, 1 + i, 1 + (i + 1) % rim);
  }
}

/* A way of one to three edges, and cords over all of it or a part: their marks share what room
 * there is beside a node. */
static void make_way(picture *p, rng *r, int n_cords)
{
  int length = rng_between(r, 1, 3);
  for (int i = 0; i <= length; i++)
    add_node(p, i, 0.5 * rng_unit(r));
  for (int i = 0; i < length; i++)
    add_edge(p, r, i, i + 1);
  for (int c = 0; c < n_cords; c++) {
    for (int i = rng_below(r, length), at = i; i < length; i++)
      at = go_along(p, c, at, i);
    if (rng_below(r, 2)) reverse(p, c);
  }
}

/* Is a direction, which is `off` from its own bead's, as near to a mark's at point v? */
static bool near_a_mark(const thr_scene *s, int v, double seen, double off)
{
  for (int c = 0; c < s->plan->n_cords; c++)
    for (int k = 0; k < 2; k++) {
      const thr_mark *m = &s->mark[c][k];
      if (m->point == v && (!m->beside || fabs(remainder(seen - m->angle, 2 * THR_PI)) <= off))
        return true;
    }
  return false;
}

/* Does every lane reach its node nearer to its own bead's direction than to another's, or a mark's?
 * Else what is seen there is no order. */
static bool beads_are_apart(const thr_scene *s)
{
  for (int i = 0; i < s->n_passes; i++)
    for (int k = 0; k < 2; k++) {
      int h = s->pass[i].half ^ k, v = thr_tail(s->paper, h), first = s->paper->first[v],
          degree = thr_degree(s->paper, v);
      const double *at = k ? s->pass[i].to : s->pass[i].from;
      double seen = atan2(at[1] - s->at[v][1], at[0] - s->at[v][0]),
             off = fabs(remainder(seen - s->angle[h], 2 * THR_PI));
      for (int j = first; j < first + degree; j++)
        if (s->around[j] != h && fabs(remainder(seen - s->angle[s->around[j]], 2 * THR_PI)) <= off)
          return false;
      if (near_a_mark(s, v, seen, off)) return false;
    }
  return true;
}

/* No two passes in a bead could change places so that fewer strands cross in its two nodes. */
START_TEST(no_two_lanes_had_better_be_swapped)
{
  rng r = rng_make((uint64_t)_i + 1000);
  int seen = 0;
  for (int k = 0; seen < 40; k++) {
    ck_assert_int_lt(k, 400);
    picture *p = calloc(1, sizeof *p);
    int n_cords = 1 + k / 3 % 4;
    if (k % 3 == 0) {
      make_way(p, &r, n_cords);
    } else {
      make_wheel(p, &r, k % 3 == 1);
      wander(p, &r, n_cords, rng_between(&r, 4, 14));
    }
    draw(p, n_cords);
    const thr_scene *s = &p->scene;
    assert_lanes_are_taken_once(s);
    bool apart = beads_are_apart(s);
    seen += apart;
    for (int e = 0; e < p->n_edges && apart; e++) {
      const int *end = s->paper->edge[e];
      int now = crossings_at(s, end[0], -1, -1) + crossings_at(s, end[1], -1, -1);
      for (int i = s->first_on[e]; i < s->first_on[e + 1]; i++)
        for (int j = s->first_on[e]; j < i; j++) {
          int then = crossings_at(s, end[0], s->on[i], s->on[j]) +
                     crossings_at(s, end[1], s->on[i], s->on[j]);
          ck_assert_msg(then >= now,
                        "picture %d: lanes %d and %d of edge %d: %d crossings, %d when swapped", k,
                        s->pass[s->on[i]].lane, s->pass[s->on[j]].lane, e, now, then);
        }
    }
    picture_destroy(p);
    free(p);
  }
}
END_TEST

/* More lanes in a bead, and ways through a node, than are compared: drawn all the same, each in its
 * lane. */
START_TEST(very_many_lanes_are_numbered)
{
  rng other = rng_make(8);
  for (int n = 40; n <= 180; n += 20) {
    picture *p = calloc(1, sizeof *p);
    make_wheel(p, &other, true);
    wander(p, &other, 1, n);
    draw(p, 1);
    assert_lanes_are_taken_once(&p->scene);
    picture_destroy(p);
    free(p);
  }
  rng r = rng_make(7);
  for (int n = 20; n <= 60; n++) {
    picture *p = calloc(1, sizeof *p);
    add_node(p, 0, 0);
    add_node(p, 1, 0);
    add_node(p, 0, 1);
    add_edge(p, &r, 0, 1);
    add_edge(p, &r, 2, 0);
    int at = go_along(p, 0, 2, 1);
    for (int i = 0; i < n; i++)
      at = go_along(p, 0, at, 0);
    draw(p, 1);
    assert_lanes_are_taken_once(&p->scene);
    picture_destroy(p);
    free(p);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("lanes");
  ADD_LOOP(s, 20, parallel_cords_cross_only_if_they_change_sides, 0, 10);
  ADD_LOOP(s, 20, no_two_lanes_had_better_be_swapped, 0, 10);
  ADD_TEST(s, 20, very_many_lanes_are_numbered);
  return run_suite(s);
}
