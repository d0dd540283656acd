/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a kit is written to: plates on which pieces lie apart, packages and meshes that are read
 * back, tables worked out again by hand. tests/kit/run.sh asks other programs. */
#include "graph/number.h"
#include "kit/files.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A kit, and the plan that it is of. */
typedef struct {
  thr_plan plan;
  thr_kit kit;
  thr_kit_plates plates;
} made;

/* Makes the kit of a framework, which is taken, with edges so many times as long. */
static void make(made *m, thr_frame f, double pitch, bool tubes, const thr_kit_options *options)
{
  thr_request o = thr_request_default();
  snprintf(f.units, sizeof f.units, "mm");
  for (int v = 0; v < f.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      f.xyz[v][k] *= pitch;
  for (int e = 0; e < f.n_edges; e++)
    f.length[e] *= pitch;
  m->plan = plan_make(&f, &o);
  m->plan.options.joint = tubes ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  thr_frame_destroy(&f);

  thr_err err = {0};
  thr_limits limits = {0};
  ck_assert_msg(!thr_kit_make(&m->kit, &m->plan, options, NULL, true, &limits, &err), "%s",
                err.text);
  ck_assert_msg(!thr_kit_plates_make(&m->plates, &m->kit, &err), "%s", err.text);
}

static void release(made *m)
{
  thr_kit_plates_destroy(&m->plates);
  thr_kit_destroy(&m->kit);
  thr_plan_destroy(&m->plan);
}

static const thr_kit_options plain = {.names = THR_KIT_NO_NAMES};

/* ---- plates ---- */

/* Returns the coordinate of a point of a piece on its bed. */
static double on_bed(const made *m, int p, const double at[3], int k)
{
  const thr_kit_stand *stand = &m->plates.stand[m->kit.piece[p].like];
  return thr_dot(&stand->turn[3 * k], at) - stand->low[k] + (k < 2 ? m->plates.at[p][k] : 0);
}

START_TEST(test_pieces_lie_apart_inside_their_beds)
{
  thr_kit_options options = plain;
  options.bed[0] = 60;
  options.bed[1] = 45;
  made m;
  make(&m, shape_make(THR_MAKE_DOME, 3, 0), 1, false, &options);
  ck_assert_int_gt(m.plates.n_plates, 1);

  for (int p = 0; p < m.kit.n_pieces; p++) {
    const thr_mesh *mesh = &m.kit.mesh[m.kit.piece[p].like];
    const thr_kit_stand *stand = &m.plates.stand[m.kit.piece[p].like];
    double lowest = INFINITY;
    for (int i = 0; i < mesh->n_points; i++) {
      for (int k = 0; k < 2; k++) {
        double at = on_bed(&m, p, mesh->point[i], k);
        ck_assert(at > 5 - 1e-6 && at < options.bed[k] - 5 + 1e-6);
      }
      lowest = fmin(lowest, on_bed(&m, p, mesh->point[i], 2));
    }
    ck_assert_double_le(fabs(lowest), 1e-9);
    ck_assert_double_gt(stand->contact, 0);

    for (int q = 0; q < p; q++) {
      bool apart = m.plates.plate[p] != m.plates.plate[q];
      const double *other = m.plates.stand[m.kit.piece[q].like].size;
      for (int k = 0; k < 2; k++)
        apart |= m.plates.at[p][k] >= m.plates.at[q][k] + other[k] + 3 - 1e-9 ||
                 m.plates.at[q][k] >= m.plates.at[p][k] + stand->size[k] + 3 - 1e-9;
      ck_assert(apart);
    }
  }
  release(&m);
}
END_TEST

START_TEST(test_rod_stands_on_its_face)
{
  /* Upright nothing hangs over but the rounding of the mouth; lying a quarter of the skin does. */
  made m;
  make(&m, path_make(3), 20, false, &plain);
  for (int p = 0; p < m.kit.n_pieces; p++)
    if (m.kit.piece[p].n_arms == 2) {
      const thr_kit_stand *stand = &m.plates.stand[m.kit.piece[p].like];
      double width = m.kit.piece[p].arm[0].width;
      ck_assert_int_ge(stand->arm, 0);
      ck_assert_double_lt(fabs(stand->size[2] - 20), 1e-6);
      ck_assert_double_lt(stand->overhang, width * width);
    }
  release(&m);
}
END_TEST

START_TEST(test_named_bed_is_large_enough)
{
  made m;
  make(&m, shape_make(THR_MAKE_DOME, 3, 0), 1, false, &plain);
  thr_kit_plates plates;
  thr_err err = {0};
  m.kit.options.bed[0] = m.kit.options.bed[1] = 24;
  ck_assert_int_eq(thr_kit_plates_make(&plates, &m.kit, &err), THR_EINPUT);
  thr_kit_plates_destroy(&plates);
  assert_one_line(&err, m.kit.name[0]);

  double *bed = m.kit.options.bed;
  const char *said = strstr(err.text, "--bed ");
  ck_assert_ptr_nonnull(said);
  ck_assert_int_eq(sscanf(said, "--bed %lfx%lf would do", &bed[0], &bed[1]), 2);
  err = (thr_err){0};
  thr_status st = thr_kit_plates_make(&plates, &m.kit, &err);
  ck_assert(st == THR_OK || !strstr(err.text, m.kit.name[0]));
  thr_kit_plates_destroy(&plates);
  release(&m);
}
END_TEST

/* Before there are meshes a bed is refused only if plates refuse it, too; and the one that is named
 * is large enough for all pieces. */
START_TEST(test_beds_are_refused_before_meshes_are_made)
{
  made m;
  thr_kit_options options = plain;
  options.key = _i == 1 ? THR_KIT_CONE : THR_KIT_NO_KEY;
  options.profile = _i == 1 ? THR_KIT_SQUARE : THR_KIT_ROUND;
  make(&m, shape_make(_i == 2 ? THR_MAKE_TUBE : THR_MAKE_DOME, 4, 3), 1, _i == 2, &options);
  double *bed = m.kit.options.bed;
  int refused = 0;
  for (int side = 20; side < 60; side++) {
    thr_kit_plates plates;
    thr_err early = {0}, late = {0};
    bed[0] = side;
    bed[1] = 0.8 * side;
    const thr_status before = thr_kit_plates_check(&m.kit, &early);
    const thr_status st = thr_kit_plates_make(&plates, &m.kit, &late);
    thr_kit_plates_destroy(&plates);
    if (!before) continue;
    refused++;
    ck_assert_int_eq(st, THR_EINPUT);
    assert_one_line(&early, "however it is laid");

    const char *said = strstr(early.text, "--bed ");
    ck_assert_ptr_nonnull(said);
    ck_assert_int_eq(sscanf(said, "--bed %lfx%lf would do", &bed[0], &bed[1]), 2);
    thr_err why = {0};
    assert_ok(thr_kit_plates_make(&plates, &m.kit, &why), &why);
    thr_kit_plates_destroy(&plates);
  }
  ck_assert_int_gt(refused, 0);
  release(&m);
}
END_TEST

/* ---- packages and meshes ---- */

static unsigned number_at(const thr_text *t, size_t at, int bytes)
{
  unsigned value = 0;
  for (int i = bytes - 1; i >= 0; i--)
    value = value << 8 | (unsigned char)t->data[at + (size_t)i];
  return value;
}

START_TEST(test_package_has_its_members)
{
  static const char *const name[] = {"[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"};
  made m;
  make(&m, ring_make(4), 20, true, &plain);
  thr_text t = {0}, again = {0};
  ck_assert_int_eq(thr_kit_3mf(&m.plates, -1, &t, NULL), THR_OK);
  ck_assert_int_eq(thr_kit_3mf(&m.plates, -1, &again, NULL), THR_OK);
  ck_assert_uint_eq(t.length, again.length);
  ck_assert_int_eq(memcmp(t.data, again.data, t.length), 0);

  /* The directory is where the end says, and members are where the directory says. */
  size_t end = t.length - 22;
  ck_assert_int_eq(memcmp(t.data + end, "PK\5\6", 4), 0);
  ck_assert_uint_eq(number_at(&t, end + 10, 2), 3);
  size_t at = number_at(&t, end + 16, 4);
  ck_assert_uint_eq(at + number_at(&t, end + 12, 4), end);
  for (int i = 0; i < 3; i++) {
    size_t member = number_at(&t, at + 42, 4), length = strlen(name[i]);
    ck_assert_int_eq(memcmp(t.data + at, "PK\1\2", 4), 0);
    ck_assert_int_eq(memcmp(t.data + member, "PK\3\4", 4), 0);
    ck_assert_int_eq(memcmp(t.data + at + 46, name[i], length), 0);
    ck_assert_int_eq(memcmp(t.data + member + 30, name[i], length), 0);
    ck_assert_int_eq(memcmp(t.data + at + 6, t.data + member + 4, 26), 0);
    ck_assert_uint_eq(number_at(&t, at + 12, 4), 0x00210000);
    at += 46 + length;
  }
  ck_assert_uint_eq(at, end);
  thr_text_destroy(&t);
  thr_text_destroy(&again);
  release(&m);
}
END_TEST

START_TEST(test_stl_has_the_volume)
{
  made m;
  make(&m, star_make(3), 20, false, &plain);
  for (int p = 0; p < m.kit.n_pieces; p++) {
    const thr_mesh *mesh = &m.kit.mesh[m.kit.piece[p].like];
    thr_text t = {0};
    thr_kit_stl(&m.plates, p, &t);
    ck_assert_uint_eq(t.length, 84 + 50 * (size_t)mesh->n_triangles);
    ck_assert_uint_eq(number_at(&t, 80, 4), (unsigned)mesh->n_triangles);
    ck_assert_int_ne(memcmp(t.data, "solid", 5), 0);

    double volume = 0, lowest[3] = {INFINITY, INFINITY, INFINITY};
    for (int i = 0; i < mesh->n_triangles; i++) {
      float bits[12];
      double corner[3][3], along[2][3], across[3];
      memcpy(bits, t.data + 84 + 50 * i, sizeof bits);
      for (int k = 0; k < 9; k++)
        corner[k / 3][k % 3] = bits[3 + k];
      thr_cross(corner[1], corner[2], across);
      volume += thr_dot(corner[0], across) / 6;

      /* It stands on the bed as on its plate, and normals have turned with it. */
      for (int k = 0; k < 9; k++) {
        lowest[k % 3] = fmin(lowest[k % 3], corner[k / 3][k % 3]);
        if (k < 6) along[k / 3][k % 3] = corner[k / 3 + 1][k % 3] - corner[0][k % 3];
      }
      thr_cross(along[0], along[1], across);
      const double twice = thr_normalize(across);
      for (int k = 0; k < 3 && twice > 1e-3; k++)
        ck_assert_double_lt(fabs(bits[k] - across[k]), 1e-2);
    }
    double known = m.kit.report[m.kit.piece[p].like].volume;
    ck_assert_double_lt(fabs(volume - known), 1e-5 * known);
    for (int k = 0; k < 3; k++)
      ck_assert_double_lt(fabs(lowest[k]), 1e-4);
    thr_text_destroy(&t);

    char name[64];
    thr_kit_stl_name(&m.kit, p, name);
    ck_assert_ptr_nonnull(strstr(name, ".stl"));
  }
  snprintf(m.kit.kind_name[1], sizeof m.kit.kind_name[1], "a/b:c");
  char name[64];
  thr_kit_stl_name(&m.kit, 0, name);
  ck_assert_str_eq(name, "a_b_c-print-1x.stl");
  release(&m);
}
END_TEST

/* ---- tables ---- */

START_TEST(test_rows_of_pieces)
{
  made m;
  make(&m, shape_make(THR_MAKE_DOME, 3, 0), 1, false, &plain);
  thr_text t = {0};
  ck_assert_int_eq(thr_kit_table(&m.plates, NULL, &t, NULL), THR_OK);

  /* A row each; masses add up. */
  int rows = 0, bases = 0;
  double mass = 0;
  char *line = strchr(t.data, '\n') + 1;
  for (char *next; *line; line = next + 1, rows++) {
    next = strchr(line, '\n');
    *next = '\0';
    int commas = 0;
    for (char *c = line; *c; c++) {
      if (*c != ',' || ++commas != 5) continue;
      mass += strtod(c + 1, NULL);
    }
    ck_assert_int_eq(commas, 15);
    bases += strstr(line, ",base,") != NULL;
  }
  ck_assert_int_eq(rows, m.kit.n_pieces);
  ck_assert_double_lt(fabs(mass - m.kit.mass), 1e-3 * rows);
  ck_assert_int_gt(bases, 0);
  thr_text_destroy(&t);

  thr_err err = {0};
  ck_assert_int_eq(thr_kit_tubes_table(&m.kit, &t, &err), THR_EINPUT);
  assert_one_line(&err, "nodes");
  release(&m);
}
END_TEST

START_TEST(test_square_of_tubes_is_mitred_by_45_degrees)
{
  made m;
  make(&m, ring_make(4), 20, true, &plain);
  thr_text t = {0};
  ck_assert_int_eq(thr_kit_tubes_table(&m.kit, &t, NULL), THR_OK);
  const char *line = strchr(t.data, '\n') + 1;
  for (int e = 0; e < 4; e++, line = strchr(line, '\n') + 1) {
    double axis, longest, outer;
    const char *size = line;
    for (int i = 0; i < 3; i++)
      size = strchr(size, ',') + 1;
    ck_assert_int_eq(sscanf(size, "%lf,%lf,%lf", &axis, &longest, &outer), 3);
    ck_assert_double_lt(fabs(axis - 20), 1e-6);
    ck_assert_double_lt(fabs(longest - 20 - outer), 0.05 * outer);
    const char *mitres = ",1,45.00,0.00,1,45.00,0.00\n";
    const char *found = strstr(line, mitres);
    ck_assert_msg(found && strchr(line, '\n') == found + strlen(mitres) - 1, "%s", line);
  }
  thr_text_destroy(&t);
  release(&m);
}
END_TEST

START_TEST(test_mitres_that_cut_nothing_are_not_listed)
{
  /* Of four tubes in a cross the opposite one cuts nothing off that the others leave. */
  made m;
  make(&m, star_make(4), 20, true, &plain);
  thr_text t = {0};
  ck_assert_int_eq(thr_kit_tubes_table(&m.kit, &t, NULL), THR_OK);
  const char *line = strchr(t.data, '\n') + 1;
  for (int e = 0; e < 4; e++, line = strchr(line, '\n') + 1) {
    const char *mitres = ",2,45.00 45.00,0.00 180.00,0,,\n";
    const char *found = strstr(line, mitres);
    ck_assert_msg(found && strchr(line, '\n') == found + strlen(mitres) - 1, "%s", line);
  }
  thr_text_destroy(&t);
  release(&m);
}
END_TEST

/* ---- OpenSCAD, memory ---- */

START_TEST(test_scad_has_all_kinds_and_places)
{
  made m;
  make(&m, ring_make(4), 20, true, &plain);
  thr_text t = {0};
  thr_kit_scad(&m.kit, &t);
  const char *kinds = strstr(t.data, "kinds = [\n"), *places = strstr(t.data, "places = [\n");
  ck_assert(kinds && places);
  int depth = 0, n[2] = {0, 0};
  for (const char *c = kinds; *c; c++) {
    n[c > places] += strncmp(c, "\n  [\"", 5) == 0;
    depth += (*c == '[') - (*c == ']');
  }
  ck_assert_int_eq(depth, 0);
  ck_assert_int_eq(n[0], m.kit.n_meshes);
  ck_assert_int_eq(n[1], m.kit.n_pieces);
  thr_text_destroy(&t);
  release(&m);
}
END_TEST

/* Each file leaves a text as it was when it fails; of several there is nothing then. */
static thr_status write_all(const void *user, thr_text *t, thr_err *err)
{
  thr_kit_plates plates;
  thr_status st = thr_kit_plates_make(&plates, user, err);
  if (!st) st = thr_kit_3mf(&plates, -1, t, err);
  if (!st) st = thr_kit_table(&plates, NULL, t, err);
  if (!st) st = thr_kit_tubes_table(user, t, err);
  thr_kit_plates_destroy(&plates);
  if (st) thr_text_destroy(t);
  return st;
}

START_TEST(test_without_memory)
{
  made m;
  make(&m, ring_make(4), 20, true, &plain);
  assert_allocations_may_fail(write_all, &m.kit, 2000);
  release(&m);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("kit_files");
  ADD_TEST(s, 60, test_pieces_lie_apart_inside_their_beds);
  ADD_TEST(s, 60, test_rod_stands_on_its_face);
  ADD_TEST(s, 60, test_named_bed_is_large_enough);
  ADD_LOOP(s, 120, test_beds_are_refused_before_meshes_are_made, 0, 3);
  ADD_TEST(s, 60, test_package_has_its_members);
  ADD_TEST(s, 60, test_stl_has_the_volume);
  ADD_TEST(s, 60, test_rows_of_pieces);
  ADD_TEST(s, 60, test_square_of_tubes_is_mitred_by_45_degrees);
  ADD_TEST(s, 60, test_mitres_that_cut_nothing_are_not_listed);
  ADD_TEST(s, 60, test_scad_has_all_kinds_and_places);
  ADD_TEST(s, 120, test_without_memory);
  return run_suite(s);
}
