/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of groups, the choice, and plans from it: published values, permutations followed node
 * by node, the checker. */
#include "graph/check/check.h"
#include "planner/planner.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const thr_limits no_limits = {0};

static thr_request asked(thr_ends ends, int cover)
{
  thr_request o = options_for(ends, cover);
  want(&o, "overlap,steps");
  return o;
}

static thr_symmetries table_of(const thr_frame *f, const thr_request *o)
{
  thr_symmetries t;
  thr_err err = {0};
  thr_status st = thr_symmetries_find(f, o, false, &no_limits, &t, &err);
  bool solved =
      st == THR_OK || st == THR_ELIMIT; /* the latter where plans count less than the programme */
  for (int i = 0; i < t.n && st == THR_ELIMIT; i++)
    solved = solved &&
             (t.row[i].why.code == THR_OK || (t.row[i].why.code == THR_ELIMIT && t.row[i].solved));
  ck_assert_msg(solved, "%s", err.text);
  return t;
}

/* Is b the same cord as the image of a: run either way, a closed one from any start? */
static bool is_image(const thr_frame *f, const int *image, const thr_cord *a, const thr_cord *b)
{
  int n = a->n_passes;
  if (b->n_passes != n || b->closed != a->closed) return false;
  for (int start = 0; start < (a->closed ? n : 1); start++)
    for (int back = 0; back < 2; back++) {
      bool same = true;
      for (int k = 0; k < n && same; k++) {
        int at = back ? (start + n - 1 - k) % n : (start + k) % n, h = b->half[at] ^ back;
        same = image[thr_tail(f, a->half[k])] == thr_tail(f, h) &&
               image[thr_head(f, a->half[k])] == thr_head(f, h);
      }
      if (same) return true;
    }
  return false;
}

/* Every element of the row's group is an automorphism and permutes the cords; the orbits are the
 * unique paths. */
static void check_row(const thr_frame *f, const thr_symmetries *t, const thr_symmetry_row *row)
{
  const thr_group *g = &t->group[row->group].all;
  int paths = 0, orbits = 0;
  ck_assert_int_eq(row->record.order, row->order);
  for (int c = 0; c < row->n_cords; c++)
    paths += row->record.unique[c] == c;
  ck_assert_int_eq(paths, row->record.unique_paths);
  for (int c = 0; c < row->n_cords; c++) {
    bool first = true;
    for (int i = 0; i < row->order; i++) {
      const int *image = &g->image[(size_t)row->elements.element[i] * (size_t)g->degree];
      int hits = 0;
      ck_assert(keeps_frame(f, NULL, image));
      for (int d = 0; d < row->n_cords; d++)
        if (is_image(f, image, &row->cord[c], &row->cord[d])) {
          hits++;
          first &= d >= c;
        }
      ck_assert_int_gt(hits, 0);
    }
    orbits += first;
  }
  ck_assert_int_le(orbits, paths); /* two alike over the same passes are one orbit here */
}

static const thr_symmetry_row *row_of(const thr_symmetries *t, const char *name, int nth)
{
  for (int i = 0; i < t->n; i++)
    if (strcmp(t->row[i].name, name) == 0 && nth-- == 0) return &t->row[i];
  ck_abort_msg("no row %s", name);
}

static void expect(const thr_symmetry_row *row, double percent, int paths, int cords, double steps)
{
  ck_assert_msg(fabs(100 * row->metrics.overlap / row->metrics.base_length - percent) < 0.15 &&
                    row->record.unique_paths == paths && row->n_cords == cords &&
                    fabs(row->record.steps - steps) < 1e-9,
                "%s: %.2f %%, %d paths, %d cords, %g steps", row->name,
                100 * row->metrics.overlap / row->metrics.base_length, row->record.unique_paths,
                row->n_cords, row->record.steps);
}

/* The thesis's Fig. 15: two unique paths, eight copies. */
START_TEST(six_by_six_dome)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 6, 0);
  thr_request o = asked(THR_ENDS_FEET, 1);
  thr_symmetries t = table_of(&f, &o);
  ck_assert(t.mantissa == 8 && t.exponent == 0 && t.listed && t.n == 8);
  ck_assert_int_eq(t.node_orbits, 6);
  ck_assert_int_eq(t.edge_orbits, 9);
  expect(row_of(&t, "C4v", 0), 20.2, 2, 8, 9);
  expect(row_of(&t, "C4", 0), 13.1, 1, 4, 17);
  expect(row_of(&t, "C2v", 0), 13.1, 1, 4, 17);
  ck_assert(t.chosen == 0 && t.within);
  for (int i = 0; i < t.n; i++) {
    check_row(&f, &t, &t.row[i]);
    ck_assert(i == 0 || t.row[i].order <= t.row[i - 1].order);
  }
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(eight_by_eight_dome_twice)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 8, 0);
  thr_request o = asked(THR_ENDS_FEET, 2);
  thr_symmetries t = table_of(&f, &o);
  expect(row_of(&t, "C4v", 0), 0, 1, 8, 28);
  ck_assert_int_eq(t.chosen, 0);
  check_row(&f, &t, &t.row[0]);
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

/* A published number of classes, and Oh's and an order 16's threading. */
START_TEST(cube)
{
  thr_frame f = no_feet(solid_make(CUBE));
  thr_request o = asked(THR_ENDS_CLOSED, 1);
  thr_symmetries t = table_of(&f, &o);
  ck_assert(t.mantissa == 48 && t.n == 33);
  expect(row_of(&t, "Oh", 0), 100, 1, 6, 0.5);
  expect(row_of(&t, "D4h", 0), 33.3, 1, 4, 1);
  ck_assert_str_eq(t.row[t.chosen].name, "D4h");
  for (int i = 0; i < t.n; i++)
    check_row(&f, &t, &t.row[i]);
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

/* What the default choice promises, looked up among all rows. */
static void check_choice(const thr_symmetries *t)
{
  const thr_symmetry_row *c = &t->row[t->chosen];
  for (int i = 0; i < t->n; i++) {
    const thr_symmetry_row *row = &t->row[i];
    bool within = row->n_cords > 0 && row->metrics.length <= 1.1 * t->shortest + 1e-9;
    ck_assert(!within || t->within);
    if (within) ck_assert(row->record.steps >= c->record.steps - 1e-9);
    if (!t->within && row->n_cords > 0) ck_assert(row->metrics.length >= c->metrics.length - 1e-9);
  }
}

START_TEST(plans_pass_the_checker)
{
  const struct {
    thr_shape shape;
    int size, rings;
  } made[] = {{THR_MAKE_DOME, 5, 0},
              {THR_MAKE_TUBE, 6, 3},
              {THR_MAKE_HONEYCOMB, 2, 0},
              {THR_MAKE_SPHERE, 1, 0},
              {THR_MAKE_GEODESIC, 2, 0}};
  for (size_t i = 0; i < sizeof made / sizeof *made; i++)
    for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++)
      for (int cover = 1; cover <= 2; cover++) {
        thr_frame f = shape_make(made[i].shape, made[i].size, made[i].rings);
        thr_request o = asked((thr_ends)ends, cover);
        thr_symmetries t;
        thr_plan p;
        thr_err err = {0};
        int feet = 0;
        for (int v = 0; v < f.n_nodes; v++)
          feet += f.foot[v];
        if (feet || ends != THR_ENDS_FEET) {
          const thr_limits limits = {
              .deadline =
                  thr_clock() + 4}; /* what is not proved by then must be sound all the same */
          thr_status st = thr_symmetry_plan(&f, &o, &limits, &t, &p, &err);
          ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
          check_choice(&t);
          ck_assert(p.symmetry.present && p.symmetry.order == t.row[t.chosen].order);
          thr_err found = {0};
          assert_ok(thr_check_plan(&p, &found), &found);
          thr_plan_destroy(&p);
          thr_symmetries_destroy(&t);
        }
        thr_frame_destroy(&f);
      }
}
END_TEST

START_TEST(groups_by_number_and_name)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 6, 0);
  thr_request o = asked(THR_ENDS_FEET, 1);
  thr_symmetries t;
  thr_err err = {0};
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "4");
  t = table_of(&f, &o);
  ck_assert(t.chosen == 3 && t.n == 8 && t.row[3].n_cords == 4 && t.row[0].n_cords == 0 &&
            !t.row[0].why.code);
  thr_symmetries_destroy(&t);
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "C2v"); /* two classes: the better one */
  t = table_of(&f, &o);
  ck_assert(t.chosen == 1 && t.row[2].n_cords == 8);
  thr_symmetries_destroy(&t);
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "9");
  assert_status(thr_symmetries_find(&f, &o, false, &no_limits, &t, &err), THR_EINPUT, &err,
                "1 to 8");
  ck_assert(t.n == 0 && t.row == NULL);
  thr_frame_destroy(&f);
}
END_TEST

/* 1 % of noise: the group of the graph stays, that of the shape is gone but within a tolerance. */
START_TEST(noise)
{
  rng r = rng_make(5);
  thr_frame f = shape_make(THR_MAKE_DOME, 6, 0);
  double size = thr_frame_diagonal(&f);
  thr_request o = asked(THR_ENDS_FEET, 1);
  thr_symmetries true_table = table_of(&f, &o), t;
  for (int v = 0; v < f.n_nodes; v++)
    for (int i = 0; i < 3; i++)
      f.xyz[v][i] += 0.01 * size * (rng_unit(&r) - 0.5);
  t = table_of(&f, &o);
  ck_assert_int_eq(t.n, true_table.n);
  for (int i = 0; i < t.n; i++) { /* lengths are the old ones: the threadings must be, too */
    ck_assert_str_eq(t.row[i].name, true_table.row[i].name);
    ck_assert(fabs(t.row[i].metrics.overlap - true_table.row[i].metrics.overlap) < 1e-6);
    ck_assert(t.row[i].record.steps == true_table.row[i].record.steps &&
              t.row[i].n_cords == true_table.row[i].n_cords);
  }
  ck_assert_int_eq(t.chosen, true_table.chosen);
  thr_symmetries_destroy(&t);
  o.symmetry.geometric = 1e-6;
  t = table_of(&f, &o);
  ck_assert(t.n == 1 && t.mantissa == 1 && t.listed);
  thr_symmetries_destroy(&t);
  o.symmetry.geometric = 0.1;
  t = table_of(&f, &o);
  ck_assert(t.n == 8 && t.mantissa == 8 && t.node_orbits == true_table.node_orbits &&
            t.edge_orbits == true_table.edge_orbits);
  thr_symmetries_destroy(&t);
  thr_symmetries_destroy(&true_table);
  thr_frame_destroy(&f);
}
END_TEST

static void expect_shape(thr_frame f, const char *name, double isometries, double keep_lengths)
{
  thr_request o = asked(THR_ENDS_CLOSED, 1);
  o.symmetry.geometric = 1e-3;
  thr_symmetries t = table_of(&f, &o);
  ck_assert(t.listed && t.mantissa == isometries && t.keep_lengths[0] == keep_lengths &&
            t.keep_lengths[1] == 0);
  ck_assert_str_eq(t.row[0].name, name);
  ck_assert_int_eq(t.row[0].order, (int)isometries);
  for (int i = 0; i < t.n; i++)
    check_row(&f, &t, &t.row[i]);
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}

/* All of these have the graph of a cube, 48 automorphisms. */
START_TEST(shapes_of_the_cube)
{
  expect_shape(box_make(1, 1, 1, 0), "Oh", 48, 48);
  expect_shape(box_make(1, 1, 2, 0), "D4h", 16, 16);
  expect_shape(box_make(1, 2, 3, 0), "D2h", 8, 8);
  expect_shape(box_make(1, 1, 1, 0.2), "D3d", 12, 48); /* equal edges, but a longer diagonal */
  thr_frame f = box_make(1, 1, 1, 0);
  for (int e = 0; e < f.n_edges; e++) /* the cord runs zigzag where the picture is straight */
    if (f.xyz[f.edge[e][0]][2] != f.xyz[f.edge[e][1]][2]) f.length[e] = 2;
  expect_shape(f, "D4h", 16, 16);
}
END_TEST

/* Only what keeps the allowed end nodes: a mirror of the dome if they are one corner, by either way
 * to the group. */
START_TEST(end_nodes_are_kept)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 5, 0);
  bool *end_node = calloc((size_t)f.n_nodes, sizeof *end_node);
  thr_request o = asked(THR_ENDS_NODES, 1);
  ck_assert(end_node != NULL);
  end_node[0] = true;
  o.end_node = end_node;
  for (int way = 0; way < 2; way++) {
    o.symmetry.geometric = way ? 1e-6 : -1;
    thr_symmetries t = table_of(&f, &o);
    ck_assert(t.mantissa == 2 && t.n == 2);
    ck_assert_str_eq(t.row[0].name, "Cs");
    thr_symmetries_destroy(&t);
  }
  free(end_node);
  thr_frame_destroy(&f);
}
END_TEST

/* 8! automorphisms of a star's spokes: too many to list. */
START_TEST(huge_groups)
{
  thr_frame f = no_feet(star_make(8));
  thr_request o = asked(THR_ENDS_ANY, 1);
  thr_symmetries t = table_of(&f, &o);
  thr_plan p;
  thr_err err = {0};
  ck_assert(t.mantissa == 40320 && !t.listed && strstr(t.note, "16 within 5 %") &&
            t.row[0].order == 16);
  for (int i = 0; i < t.n; i++) {
    check_row(&f, &t, &t.row[i]);
    for (int k = 0; k < i; k++) /* no group twice */
      ck_assert(t.row[i].order != t.row[k].order || t.row[i].group != t.row[k].group ||
                memcmp(t.row[i].elements.element, t.row[k].elements.element,
                       (size_t)t.row[i].order * sizeof(int)) != 0);
  }
  assert_ok(thr_symmetries_plan(&t, t.chosen, &f, &o, &no_limits, &p, &err), &err);
  assert_ok(thr_check_plan(&p, &err), &err);
  thr_plan_destroy(&p);
  thr_symmetries_destroy(&t);
  o.symmetry.geometric =
      1e-6; /* more keep the lengths than can be listed: looked for by coordinates */
  t = table_of(&f, &o);
  ck_assert(t.mantissa == 16 && t.listed && t.keep_lengths[0] == 40320);
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

/* A square with mirrors across its edges: one closed cord, which cannot be opened at a corner
 * without its image. It does not turn where its ends come out, though the programme counts that
 * turn: not all of what it says is proved. */
START_TEST(closed_cords_do_not_turn_where_they_end)
{
  const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const int edge[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  thr_frame f = no_feet(frame_make(4, xyz, 4, edge, NULL, NULL));
  thr_request o = asked(THR_ENDS_ANY, 1);
  thr_symmetries t;
  ck_assert_int_eq(thr_symmetries_find(&f, &o, false, &no_limits, &t, NULL), THR_ELIMIT);
  const thr_symmetry_row *row = row_of(&t, "C2v", 1);
  double quarter = acos(0);
  ck_assert(row->n_cords == 1 && row->cord[0].closed && row->why.code == THR_ELIMIT);
  ck_assert_double_eq_tol(row->metrics.turning, 3 * quarter, 1e-9);
  ck_assert_double_le(row->bound[THR_AIM_TURNING], 3 * quarter + 1e-6);
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

/* There and back over a path: learned both ways, unless the group reverses it. */
START_TEST(there_and_back_is_learned_both_ways)
{
  thr_frame f = no_feet(path_make(5));
  thr_request o = asked(THR_ENDS_CLOSED, 1);
  thr_symmetries t = table_of(&f, &o);
  ck_assert_int_eq(t.n, 2);
  for (int i = 0; i < 2; i++) {
    ck_assert_double_eq(t.row[i].record.steps, i ? 8 : 4);
    ck_assert_double_eq_tol(t.row[i].bound[THR_AIM_STEPS], i ? 8 : 4, 1e-6);
  }
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(what_it_does_not_know)
{
  thr_frame f = no_feet(path_make(4));
  thr_request o = asked(THR_ENDS_CLOSED, 1);
  thr_symmetries t;
  thr_err err = {0};
  o.ends = THR_ENDS_COUNTS;
  ck_assert_int_eq(thr_symmetries_find(&f, &o, false, &no_limits, &t, &err), THR_EINPUT);
  ck_assert(strstr(err.text, "do not know") && t.n == 0);
  thr_frame_destroy(&f);
}
END_TEST

/* A ring of 600 turns in more ways than a group may have. */
START_TEST(too_many_isometries)
{
  thr_frame f = no_feet(ring_make(600));
  thr_request o = asked(THR_ENDS_CLOSED, 1);
  o.symmetry.geometric = 1e-6;
  thr_symmetries t = table_of(&f, &o);
  ck_assert(!t.listed && t.n == 1 && strstr(t.note, "too many"));
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(no_time)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 6, 0);
  thr_request o = asked(THR_ENDS_FEET, 1);
  const thr_limits over = {.deadline = thr_clock() - 1};
  thr_symmetries t;
  thr_plan p;
  thr_err err = {0};
  assert_status(thr_symmetries_find(&f, &o, false, &over, &t, &err), THR_ELIMIT, &err,
                "the time was too short");
  ck_assert_int_eq(t.n, 8);
  for (int i = 0; i < t.n; i++)
    ck_assert_int_eq(t.row[i].why.code, THR_ELIMIT);
  thr_symmetries_destroy(&t);
  ck_assert_int_eq(thr_symmetry_plan(&f, &o, &over, NULL, &p, NULL), THR_ELIMIT);
  if (p.n_cords) ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(no_node_for_an_end)
{
  thr_frame f = no_feet(ring_make(5));
  thr_request o = asked(THR_ENDS_FEET, 1);
  thr_symmetries t;
  thr_plan p;
  thr_err err = {0};
  assert_status(thr_symmetries_find(&f, &o, false, &no_limits, &t, &err), THR_EINFEASIBLE, &err,
                "no node");
  ck_assert_int_eq(thr_symmetry_plan(&f, &o, &no_limits, &t, &p, NULL), THR_EINFEASIBLE);
  ck_assert(p.n_cords == 0 && t.n == 0);
  thr_frame_destroy(&f);
}
END_TEST

/* Cords of one free orbit turn alike: what is least for the sum is least for the largest. A seed of
 * another kind changes nothing.
 */
START_TEST(seeds_for_the_largest_turning)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 8, 0);
  thr_request o = asked(THR_ENDS_FEET, 2), turning = options_for(THR_ENDS_FEET, 2);
  thr_symmetries t = table_of(&f, &o);
  thr_plan seed, p;
  thr_err err = {0};
  int row = thr_symmetries_even(&t, 8);
  ck_assert_int_eq(row, 0);
  ck_assert_int_eq(thr_symmetries_even(&t, 5), -1);
  thr_status taken = thr_symmetries_plan(&t, row, &f, &o, &no_limits, &seed, &err);
  ck_assert(taken == THR_OK || taken == THR_ELIMIT);
  ck_assert_int_eq(thr_symmetries_even(&t, 8), -1); /* its cords are taken */
  want(&turning, "max-turning");
  turning.cords = 8;
  assert_ok(thr_tortuosity_plan_from(&f, &turning, &seed, &no_limits, &p, &err), &err);
  ck_assert(p.turning.largest_optimal && p.metrics.max_turning <= seed.metrics.max_turning + 1e-9);
  assert_ok(thr_check_plan(&p, &err), &err);
  thr_plan_destroy(&p);
  turning.cords = 2;
  thr_plan alone;
  const thr_limits some_time = {.deadline = thr_clock() + 20};
  ck_assert_int_ne(thr_tortuosity_plan_from(&f, &turning, &seed, &some_time, &p, NULL), THR_ENOMEM);
  ck_assert_int_eq(p.n_cords, 2);
  ck_assert_int_ne(thr_tortuosity_plan(&f, &turning, &no_limits, &alone, NULL), THR_ENOMEM);
  ck_assert(fabs(alone.metrics.max_turning - p.metrics.max_turning) < 1e-9);
  thr_plan_destroy(&p);
  thr_plan_destroy(&alone);
  thr_plan_destroy(&seed);
  thr_symmetries_destroy(&t);
  thr_frame_destroy(&f);
}
END_TEST

static void fail_each(const thr_frame *f, const thr_request *o)
{
  thr_status st = THR_ENOMEM;
  int k = 0;
  while (st) {
    thr_symmetries t;
    thr_plan p;
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    st = thr_symmetry_plan(f, o, &no_limits, &t, &p, &err);
    thr_alloc_fail_at(0);
    if (!st) ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    if (st) ck_assert_int_eq(err.code, st);
    ck_assert(!st || st == THR_ENOMEM);
    ck_assert(!st || (t.n == 0 && p.n_cords == 0));
    thr_plan_destroy(&p);
    thr_symmetries_destroy(&t);
  }
  ck_assert_int_gt(k, 100);
}

START_TEST(every_allocation_fails_once)
{
  thr_frame f = no_feet(path_make(4)), star = no_feet(star_make(7));
  thr_request o = asked(THR_ENDS_ANY, 1);
  fail_each(&f, &o);
  o.symmetry.geometric = 1e-6;
  fail_each(&f, &o);
  o.symmetry.geometric = -1;
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "1");
  fail_each(&star, &o);
  thr_frame_destroy(&f);
  thr_frame_destroy(&star);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("symmetry");
  ADD_TEST(s, 20, six_by_six_dome);
  ADD_TEST(s, 20, eight_by_eight_dome_twice);
  ADD_TEST(s, 60, cube);
  ADD_TEST(s, 120, plans_pass_the_checker);
  ADD_TEST(s, 20, groups_by_number_and_name);
  ADD_TEST(s, 20, noise);
  ADD_TEST(s, 60, shapes_of_the_cube);
  ADD_TEST(s, 20, end_nodes_are_kept);
  ADD_TEST(s, 60, huge_groups);
  ADD_TEST(s, 20, closed_cords_do_not_turn_where_they_end);
  ADD_TEST(s, 20, there_and_back_is_learned_both_ways);
  ADD_TEST(s, 20, what_it_does_not_know);
  ADD_TEST(s, 60, too_many_isometries);
  ADD_TEST(s, 20, no_time);
  ADD_TEST(s, 20, no_node_for_an_end);
  ADD_TEST(s, 60, seeds_for_the_largest_turning);
  ADD_TEST(s, 120, every_allocation_fails_once);
  return run_suite(s);
}
