/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords of symmetric covers: for every class of subgroups of small frameworks, plans that the
 * checker agrees with. */
#include "graph/check/check.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TYPES = 20000 };

static thr_frame with_foot(thr_frame f)
{
  f.foot[0] = true;
  return f;
}

/* Two nodes joined by an edge and by three paths of two edges (K113). */
static thr_frame k113(void)
{
  double xyz[5][3] = {{0, 0, -1}, {0, 0, 1}};
  static const int edge[][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {0, 4}, {1, 4}};
  for (int i = 0; i < 3; i++) {
    xyz[2 + i][0] = cos(2.0943951023931953 * i);
    xyz[2 + i][1] = sin(2.0943951023931953 * i);
  }
  return no_feet(frame_make(5, (const double(*)[3])xyz, 7, edge, NULL, NULL));
}

static thr_frame frame_number(int i)
{
  switch (i) {
  case 0: return no_feet(path_make(4));
  case 1: return no_feet(ring_make(6));
  case 2: return with_foot(star_make(5));
  case 3: return no_feet(wheel_make(4));
  case 4: return grid_make(3, 3);
  case 5: return grid_make(4, 4);
  case 6: return grid_make(2, 5);
  case 7: return solid_make(TETRAHEDRON);
  case 8: return no_feet(solid_make(CUBE));
  case 9: return no_feet(solid_make(OCTAHEDRON));
  case 10: return k113();
  case 11: return triangles_make(2);
  case 12: return no_feet(grid_make(3, 3));
  default: return shape_make(THR_MAKE_HONEYCOMB, 3, 0); /* folds far from its feet */
  }
}
enum { N_FRAMES = 14 };

/* A plan of the cords, whose arrays it takes over. */
static thr_plan plan_of(const thr_frame *f, const thr_cover_options *c, thr_cord *cord, int n_cords,
                        thr_symmetry_record *r)
{
  thr_plan p = {0};
  thr_request o = options_for(c->ends, c->cover);
  int *count = calloc((size_t)f->n_nodes, sizeof *count);
  ck_assert(count != NULL);
  want(&o, "overlap,steps");
  for (int i = 0; i < n_cords; i++)
    if (++count[cord[i].component] > o.cords) o.cords = count[cord[i].component];
  free(count);
  ck_assert_int_eq(thr_plan_request(&p, f, &o, NULL), THR_OK);
  p.generator = thr_strdup("test");
  p.cord = cord;
  p.n_cords = n_cords;
  p.symmetry = *r;
  ck_assert_int_eq(thr_plan_measure(f, &o, cord, n_cords, &p.metrics, NULL), THR_OK);
  return p;
}

/* Every copy is the image of its unique path, pass by pass. */
static void assert_images(const thr_plan *p)
{
  const thr_frame *f = &p->frame;
  const thr_symmetry_record *r = &p->symmetry;
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i], *u = &p->cord[r->unique[i]];
    const int *image = r->image + (size_t)r->element[i] * (size_t)f->n_nodes;
    ck_assert_int_le(r->unique[i], i);
    ck_assert_int_eq(c->n_passes, u->n_passes);
    for (int k = 0; k < c->n_passes; k++) {
      ck_assert_int_eq(thr_tail(f, c->half[k]), image[thr_tail(f, u->half[k])]);
      ck_assert_int_eq(thr_head(f, c->half[k]), image[thr_head(f, u->half[k])]);
    }
    if (c == u) ck_assert_int_le(thr_cord_start(f, c), thr_cord_end(f, c));
    ck_assert(i == 0 || p->cord[i - 1].component <= c->component);
  }
}

static void assert_passes(const thr_plan *p, const thr_quotient *q, const thr_cover *c)
{
  int *passes = calloc((size_t)p->frame.n_edges, sizeof *passes);
  ck_assert(passes != NULL);
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < p->cord[i].n_passes; k++)
      passes[p->cord[i].half[k] >> 1]++;
  for (int i = 0; i < q->n_copies; i++)
    for (int e = 0; e < q->f->n_edges; e++)
      if (q->edge_orbit[e] == q->copy[i].edge_orbit) passes[e] -= q->copy[i].passes * c->copies[i];
  for (int e = 0; e < q->f->n_edges; e++)
    ck_assert_int_eq(passes[e], 0);
  free(passes);
}

/* Checks the values that the cover promises. Cords that run alike count once in a record, and what
 * is read both ways twice. */
static void assert_values(const thr_plan *p, const thr_cover *c, thr_ends ends)
{
  ck_assert_double_eq_tol(p->metrics.overlap, c->value[THR_AIM_OVERLAP], 1e-6);
  if (ends != THR_ENDS_ANY)
    ck_assert_double_eq_tol(p->metrics.turning, c->value[THR_AIM_TURNING], 1e-6);
  ck_assert_double_le(p->symmetry.steps,
                      (p->symmetry.retraced ? 2 : 1) * c->value[THR_AIM_STEPS] + 1e-6);
  ck_assert_double_le(p->symmetry.unique_paths, c->value[THR_AIM_PATHS] + 1e-6);
}

static void assert_same_cords(const thr_cord *a, const thr_cord *b, int n)
{
  for (int i = 0; i < n; i++) {
    ck_assert(a[i].n_passes == b[i].n_passes && strcmp(a[i].id, b[i].id) == 0);
    ck_assert(memcmp(a[i].half, b[i].half, (size_t)a[i].n_passes * sizeof *a[i].half) == 0);
  }
}

static void cords_destroy(thr_cord *cord, int n)
{
  for (int i = 0; i < n; i++)
    free(cord[i].half);
  free(cord);
}

/* Returns whether there is a cover with these ends. */
static bool try_group(const setting *s, int k, const thr_cover_options *o)
{
  thr_quotient q;
  thr_cover c;
  thr_err err = {0};
  thr_limits none = {0};
  ck_assert_int_eq(thr_quotient_init(&q, &s->f, &s->g, &s->classes.subgroup[k], MOST_TYPES, &err),
                   THR_OK);
  thr_status st = thr_cover_find(&q, o, &none, &c, &err);
  ck_assert_msg(st == THR_OK || st == THR_EINFEASIBLE, "class %d, %s: %s", k,
                thr_ends_name(o->ends), err.text);
  if (!st) {
    thr_cord *cord, *again;
    int n_cords, n_again;
    thr_symmetry_record r, r_again;
    st = thr_cover_cords(&q, o, &c, &cord, &n_cords, &r, &err);
    ck_assert_msg(st == THR_OK, "class %d of order %d, %s, cover %d: %s", k, q.h->order,
                  thr_ends_name(o->ends), o->cover, err.text);
    ck_assert_int_eq(thr_cover_cords(&q, o, &c, &again, &n_again, &r_again, NULL), THR_OK);
    ck_assert_int_eq(n_cords, n_again);
    assert_same_cords(cord, again, n_cords);
    cords_destroy(again, n_again);
    thr_symmetry_record_destroy(&r_again);
    thr_plan p = plan_of(&s->f, o, cord, n_cords, &r);
    ck_assert_msg(thr_check_plan(&p, &err) == THR_OK, "class %d of order %d, %s, cover %d: %s", k,
                  q.h->order, thr_ends_name(o->ends), o->cover, err.text);
    assert_plan_sound(&p);
    assert_images(&p);
    assert_passes(&p, &q, &c);
    assert_values(&p, &c, o->ends);
    thr_plan_destroy(&p);
    thr_cover_destroy(&c);
  }
  thr_quotient_destroy(&q);
  return st == THR_OK;
}

static int try_frame(thr_frame f, thr_ends ends, int cover)
{
  int made = 0;
  setting s = setting_make(1000, f);
  thr_cover_options o = cover_options(ends, cover);
  for (int k = 0; k < s.classes.n; k++)
    made += try_group(&s, k, &o);
  setting_destroy(&s);
  return made;
}

START_TEST(closed_cords_of_every_group)
{
  ck_assert_int_gt(try_frame(frame_number(_i / 2), THR_ENDS_CLOSED, 1 + _i % 2), 0);
}
END_TEST

START_TEST(open_and_closed_cords_of_every_group)
{
  ck_assert_int_gt(try_frame(frame_number(_i / 2), THR_ENDS_ANY, 1 + _i % 2), 0);
}
END_TEST

START_TEST(cords_from_foot_to_foot_of_every_group)
{
  thr_frame f = frame_number(_i / 2);
  bool feet = false;
  for (int v = 0; v < f.n_nodes; v++)
    feet |= f.foot[v];
  if (!feet) {
    thr_frame_destroy(&f);
    return;
  }
  ck_assert_int_gt(try_frame(f, THR_ENDS_FEET, 1 + _i % 2), 0);
}
END_TEST

/* The best cover of a framework under its whole group. */
static thr_plan whole_group_plan(thr_frame frame, thr_ends ends, int cover)
{
  setting s = setting_make(1000, frame);
  thr_cover_options o = cover_options(ends, cover);
  thr_limits none = {0};
  thr_err err = {0};
  thr_quotient q;
  thr_cover c;
  thr_cord *cord;
  int n;
  thr_symmetry_record r;
  ck_assert_int_eq(thr_quotient_init(&q, &s.f, &s.g, &s.classes.subgroup[0], MOST_TYPES, NULL),
                   THR_OK);
  assert_ok(thr_cover_find(&q, &o, &none, &c, &err), &err);
  assert_ok(thr_cover_cords(&q, &o, &c, &cord, &n, &r, &err), &err);
  thr_plan p = plan_of(&s.f, &o, cord, n, &r);
  thr_cover_destroy(&c);
  thr_quotient_destroy(&q);
  setting_destroy(&s);
  return p;
}

/* MATHS: unique paths x copies, learned steps. */
START_TEST(known_covers_have_known_cords)
{
  thr_plan p =
      whole_group_plan(no_feet(solid_make(CUBE)), THR_ENDS_CLOSED, 1); /* O_h: round every face */
  ck_assert(p.symmetry.order == 48 && p.symmetry.unique_paths == 1 && p.n_cords == 6 &&
            p.symmetry.steps == 0.5);
  thr_plan_destroy(&p);
  p = whole_group_plan(truncated_icosahedron(), THR_ENDS_CLOSED, 1); /* I_h: round every hexagon */
  ck_assert(p.symmetry.order == 120 && p.symmetry.unique_paths == 1 && p.n_cords == 20 &&
            p.symmetry.steps == 1);
  thr_plan_destroy(&p);
  p = whole_group_plan(grid_make(6, 6), THR_ENDS_FEET,
                       1); /* the thesis's two unique paths, eight copies */
  ck_assert(p.symmetry.order == 8 && p.symmetry.unique_paths == 2 && p.n_cords == 8 &&
            p.symmetry.steps == 9);
  thr_plan_destroy(&p);
  p = whole_group_plan(grid_make(8, 8), THR_ENDS_FEET, 2);
  ck_assert(p.symmetry.order == 8 && p.symmetry.unique_paths == 1 && p.n_cords == 8 &&
            p.symmetry.steps == 28);
  ck_assert_double_eq(p.metrics.overlap, 0);
  thr_plan_destroy(&p);
}
END_TEST

/* Counts that are no cover, and closed cords where ends are asked for. */
START_TEST(wrong_covers_are_refused)
{
  setting s = setting_make(1000, grid_make(4, 4));
  thr_cover_options closed = cover_options(THR_ENDS_CLOSED, 1),
                    feet = cover_options(THR_ENDS_FEET, 1);
  thr_limits none = {0};
  for (int k = 0; k < s.classes.n; k++) {
    thr_quotient q;
    thr_cover c;
    ck_assert_int_eq(thr_quotient_init(&q, &s.f, &s.g, &s.classes.subgroup[k], MOST_TYPES, NULL),
                     THR_OK);
    ck_assert_int_eq(thr_cover_find(&q, &closed, &none, &c, NULL), THR_OK);
    for (int i = -1; i < q.n_copies + q.n_pairs + q.n_darts; i++) {
      thr_cord *cord;
      thr_symmetry_record r;
      int n;
      thr_err err = {0};
      int *count = i < 0                        ? NULL
                   : i < q.n_copies             ? &c.copies[i]
                   : i < q.n_copies + q.n_pairs ? &c.pairs[i - q.n_copies]
                                                : &c.ends[i - q.n_copies - q.n_pairs];
      if (count) ++*count;
      assert_status(thr_cover_cords(&q, count ? &closed : &feet, &c, &cord, &n, &r, &err),
                    THR_ESOLVER, &err, count ? "cover" : "would be closed");
      ck_assert(!cord && n == 0 && !r.unique && !r.image);
      if (count) --*count;
    }
    thr_cover_destroy(&c);
    thr_quotient_destroy(&q);
  }
  setting_destroy(&s);
}
END_TEST

START_TEST(every_failed_allocation_is_reported)
{
  setting s = setting_make(1000, frame_number(_i));
  thr_cover_options o = cover_options(s.f.foot[0] ? THR_ENDS_FEET : THR_ENDS_CLOSED, 1);
  thr_limits none = {0};
  thr_quotient q;
  thr_cover c;
  ck_assert_int_eq(thr_quotient_init(&q, &s.f, &s.g, &s.classes.subgroup[0], MOST_TYPES, NULL),
                   THR_OK);
  thr_status found = thr_cover_find(&q, &o, &none, &c, NULL);
  for (long k = 1; !found; k++) {
    thr_cord *cord;
    thr_symmetry_record r;
    int n;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    thr_status st = thr_cover_cords(&q, &o, &c, &cord, &n, &r, &err);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || (st == THR_ENOMEM && !cord && n == 0 && !r.generator && !r.unique));
    cords_destroy(cord, n);
    thr_symmetry_record_destroy(&r);
    if (!st) break;
  }
  thr_cover_destroy(&c);
  thr_quotient_destroy(&q);
  setting_destroy(&s);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("cords");
  ADD_LOOP(s, 60, closed_cords_of_every_group, 0, 2 * N_FRAMES);
  ADD_LOOP(s, 60, open_and_closed_cords_of_every_group, 0, 2 * N_FRAMES);
  ADD_LOOP(s, 60, cords_from_foot_to_foot_of_every_group, 0, 2 * N_FRAMES);
  ADD_TEST(s, 60, known_covers_have_known_cords);
  ADD_TEST(s, 60, wrong_covers_are_refused);
  ADD_LOOP(s, 20, every_failed_allocation_is_reported, 0, N_FRAMES);
  return run_suite(s);
}
