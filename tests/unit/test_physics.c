/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Physical quantities: ranges, presets, JSON there and back, sizes from the framework, refusals. */
#define _POSIX_C_SOURCE 200809L
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const thr_physics_field *field(const char *key)
{
  const thr_physics_field *found = thr_physics_find(key);
  ck_assert_msg(found != NULL, "%s", key);
  return found;
}

static void set(thr_physics *p, const char *key, double value)
{
  thr_err err = {0};
  assert_ok(thr_physics_set(p, field(key), value, &err), &err);
}

static thr_status parse(thr_physics *p, const char *text, thr_err *err)
{
  thr_json *doc;
  thr_status st = thr_json_parse(&doc, text, strlen(text), "file", err);
  if (!st) st = thr_physics_from_json(p, doc, "file", err);
  thr_json_destroy(doc);
  return st;
}

static void assert_same(const thr_physics *a, const thr_physics *b)
{
  ck_assert_str_eq(a->preset, b->preset);
  for (int i = 0; i < thr_physics_n_fields; i++)
    ck_assert_msg(thr_physics_get(a, &thr_physics_fields[i]) ==
                      thr_physics_get(b, &thr_physics_fields[i]),
                  "%s", thr_physics_fields[i].key);
}

START_TEST(every_field_has_a_name_of_its_own)
{
  thr_physics p = thr_physics_default();
  ck_assert_int_eq(thr_physics_n_fields,
                   (int)((sizeof p - sizeof p.preset) / sizeof(double))); /* none forgotten */
  for (int i = 0; i < thr_physics_n_fields; i++) {
    const thr_physics_field *f = &thr_physics_fields[i];
    char dashed[40];
    snprintf(dashed, sizeof dashed, "%s", f->key);
    for (char *c = dashed; *c; c++)
      if (*c == '_') *c = '-';
    ck_assert(thr_physics_find(f->key) == f && thr_physics_find(dashed) == f);
    ck_assert(f->low < f->high && *f->help);
    set(&p, f->key, f->high);
    ck_assert_double_eq(thr_physics_get(&p, f), f->high);
  }
  ck_assert(!thr_physics_find("mu_") && !thr_physics_find("m") && !thr_physics_find("") &&
            !thr_physics_find("mu-low-"));
}
END_TEST

START_TEST(values_out_of_range_are_refused)
{
  for (int i = 0; i < thr_physics_n_fields; i++) {
    const thr_physics_field *f = &thr_physics_fields[i];
    const double wrong[] = {
        NAN, INFINITY, -INFINITY, -1, nextafter(f->high, INFINITY), f->positive ? 0 : -1e-300};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
      thr_physics p = thr_physics_default(), before = p;
      thr_err err = {0};
      ck_assert_int_eq(thr_physics_set(&p, f, wrong[k], &err), THR_EINPUT);
      assert_one_line(&err, f->key);
      ck_assert(strstr(err.text, "expected") != NULL);
      assert_same(&p, &before);
    }
  }
}
END_TEST

START_TEST(presets_are_usable)
{
  thr_frame f = solid_make(CUBE);
  for (int v = 0; v < f.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      f.xyz[v][k] *= 50;
  ck_assert_int_ge(thr_physics_n_presets, 3);
  for (int i = 0; i < thr_physics_n_presets; i++) {
    const thr_physics_preset *preset = &thr_physics_presets[i];
    thr_physics p = thr_physics_default(), r;
    thr_err err = {0};
    assert_ok(thr_physics_set_preset(&p, preset->name, &err), &err);
    ck_assert_str_eq(p.preset, preset->name);
    ck_assert(strstr(preset->source, "estimate") != NULL);
    assert_ok(thr_physics_resolve(&p, &f, &r, &err), &err);
    ck_assert(r.mu_low < r.mu && r.mu < r.mu_high && r.seating > 0 && r.gravity > 9.7);
  }
  thr_physics p = thr_physics_default(), before = p;
  thr_err err = {0};
  ck_assert_int_eq(thr_physics_set_preset(&p, "silk", &err), THR_EINPUT);
  assert_one_line(&err, "silk");
  for (int i = 0; i < thr_physics_n_presets; i++)
    ck_assert(strstr(err.text, thr_physics_presets[i].name) != NULL);
  assert_same(&p, &before);
  thr_frame_destroy(&f);
}
END_TEST

/* mu alone brings a band of its own; a band that was set stays, whatever the order. */
START_TEST(band_of_mu)
{
  static const struct {
    const char *text;
    double low, high;
  } cases[] = {
      {"{}", 0.1, 0.3},
      {"{\"mu\": 0.4}", 0.2, 0.6},
      {"{\"mu\": 0}", 0, 0},
      {"{\"mu\": 2}", 1, 3},
      {"{\"mu\": 0.4, \"mu_high\": 0.5}", 0.2, 0.5},
      {"{\"mu_low\": 0.35, \"mu\": 0.4}", 0.35, 0.6},
      {"{\"preset\": \"wood-paracord\"}", 0.2, 0.4},
      {"{\"mu\": 0.8, \"preset\": \"wood-paracord\"}", 0.4, 1.2},
      {"{\"mu\": 0.3, \"preset\": \"wood-paracord\"}", 0.2, 0.4},
      {"{\"mu_low\": 0.7, \"mu\": 0.8, \"preset\": \"wood-paracord\", \"mu_high\": 0.9, \"note\": "
       "\"x\"}",
       0.7, 0.9},
  };
  thr_frame f = solid_make(CUBE);
  memcpy(f.units, "m", 2);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_physics p = thr_physics_default(), r;
    thr_err err = {0};
    assert_ok(parse(&p, cases[i].text, &err), &err);
    ck_assert_msg(thr_physics_resolve(&p, &f, &r, &err) == THR_OK, "%s: %s", cases[i].text,
                  err.text);
    ck_assert_msg(r.mu_low == cases[i].low && r.mu_high == cases[i].high, "%s: %.17g .. %.17g",
                  cases[i].text, r.mu_low, r.mu_high);
  }
  thr_physics p = thr_physics_default();
  ck_assert_int_eq(thr_physics_set_preset(&p, "wood-paracord", NULL), THR_OK);
  set(&p, "mu_low", 0.1);
  set(&p, "mu", 0.15);
  ck_assert_double_eq(p.mu_low, 0.1);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(json_there_and_back)
{
  rng r = rng_make((uint64_t)_i);
  thr_physics p = thr_physics_default(), q = thr_physics_default();
  if (_i % 2)
    ck_assert_int_eq(
        thr_physics_set_preset(&p, thr_physics_presets[_i % thr_physics_n_presets].name, NULL),
        THR_OK);
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (rng_below(&r, 2))
      set(&p, thr_physics_fields[i].key, thr_physics_fields[i].high * (1 - rng_unit(&r)));
  thr_text t = {0};
  thr_err err = {0};
  thr_physics_write(&p, &(thr_writer){.out = &t}, NULL);
  ck_assert(!t.failed && strchr(t.data, '\n') == NULL);
  assert_ok(parse(&q, t.data, &err), &err);
  assert_same(&p, &q);
  thr_text_destroy(&t);
}
END_TEST

START_TEST(nonsense_in_json_is_refused)
{
  static const struct {
    const char *text, *word;
  } wrong[] = {{"[]", "object"},
               {"{\"mu\": \"0.2\"}", "mu"},
               {"{\"mu\": null}", "mu"},
               {"{\"mu\": -0.1}", "0 to 2"},
               {"{\"mu\": 2.1}", "0 to 2"},
               {"{\"seating\": 0}", "more than 0 N"},
               {"{\"density\": 1e999}", ""},
               {"{\"cord-diameter\": 2}", "cord-diameter"},
               {"{\"friction\": 0.2}", "friction"},
               {"{\"preset\": 3}", "preset"},
               {"{\"preset\": \"silk\"}", "silk"},
               {"{\"note\": 3}", "note"},
               {"{\"mu\": 0.2, \"mu\": 0.3}", "mu"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_physics p = thr_physics_default(), before = p;
    thr_err err = {0};
    ck_assert_msg(parse(&p, wrong[i].text, &err) == THR_EINPUT, "%s", wrong[i].text);
    assert_one_line(&err, wrong[i].word);
    ck_assert(strncmp(err.text, "file:", 5) == 0);
    assert_same(&p, &before);
  }
}
END_TEST

START_TEST(files_are_read)
{
  char path[] = "/tmp/thread-test-XXXXXX";
  int fd = mkstemp(path);
  ck_assert_int_ge(fd, 0);
  static const char text[] =
      "{\"note\": \"measured by hand\",\n \"mu\": 0.35, \"cord_diameter\": 1.5}\n";
  ck_assert_int_eq(write(fd, text, sizeof text - 1), sizeof text - 1);
  close(fd);
  thr_physics p = thr_physics_default(), expected = p;
  thr_err err = {0};
  thr_status st = thr_physics_read(&p, path, &err);
  remove(path);
  assert_ok(st, &err);
  set(&expected, "mu", 0.35);
  set(&expected, "cord_diameter", 1.5);
  assert_same(&p, &expected);
  assert_status(thr_physics_read(&p, path, &err), THR_EIO, &err, path);
  assert_same(&p, &expected);
}
END_TEST

START_TEST(units)
{
  static const struct {
    const char *name;
    double mm;
  } known[] = {{"mm", 1},          {"cm", 10},       {"m", 1000},       {"in", 25.4},
               {"ft", 304.8},      {"meters", 1000}, {"millimetre", 1}, {"um", 0.001},
               {"Microns", 0.001}, {"MM", 1},        {"km", 1e6},       {"dm", 100},
               {"yards", 914.4},   {"Inch", 25.4}};
  double mm;
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    ck_assert_int_eq(thr_units_in_mm(known[i].name, &mm, NULL), THR_OK);
    ck_assert_double_eq(mm, known[i].mm);
  }
  static const char *const unknown[] = {"",    "furlong",     "unit", "mm ", "mm, verified",
                                        "m\n", "millimeterss"};
  for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
    thr_err err = {0};
    assert_status(thr_units_in_mm(unknown[i], &mm, &err), THR_EINPUT, &err, "--units");
  }
}
END_TEST

/* A path with edges of 1, 2, 4, 8 and 16 units: median 4, shortest 1. */
static thr_frame uneven_path(void)
{
  static const double xyz[6][3] = {{0, 0, 0},  {8, 0, 0},   {8, 16, 0},
                                   {8, 16, 1}, {12, 16, 1}, {12, 14, 1}};
  return frame_make(6, xyz, 5, (const int[5][2]){{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}, NULL,
                    NULL);
}

START_TEST(sizes_come_from_the_framework)
{
  thr_frame f = uneven_path();
  memcpy(f.units, "cm", 3);
  thr_physics p = thr_physics_default(), r, again;
  thr_err err = {0};
  assert_ok(thr_physics_resolve(&p, &f, &r, &err), &err);
  ck_assert_double_eq_tol(r.cord_diameter, 2, 1e-12); /* 40 mm / 20 */
  ck_assert_double_eq_tol(r.bore, 4, 1e-12);
  ck_assert_double_eq_tol(r.bead_diameter, 14, 1e-12);
  ck_assert_int_eq(thr_physics_resolve(&r, &f, &again, &err), THR_OK);
  assert_same(&r, &again);
  set(&p, "cord_diameter", 4.9);
  ck_assert_int_eq(thr_physics_resolve(&p, &f, &r, &err), THR_OK);
  ck_assert_double_eq_tol(r.bore, 9.8, 1e-12);
  ck_assert_double_eq_tol(r.bead_diameter, 14.7, 1e-12);
  memcpy(f.units, "m", 2); /* pieces of 4 m, and a cord that a hand can pull */
  p = thr_physics_default();
  ck_assert_int_eq(thr_physics_resolve(&p, &f, &r, &err), THR_OK);
  ck_assert_double_eq_tol(r.cord_diameter, 3, 1e-12);
  ck_assert_double_eq_tol(r.bead_diameter, 1400, 1e-9);
  memcpy(f.units, "span", 5); /* nobody knows how long; proportions are what matters then */
  p = thr_physics_default();
  ck_assert_int_eq(thr_physics_resolve(&p, &f, &r, &err), THR_OK);
  ck_assert_double_eq_tol(r.bore / r.cord_diameter, 2, 1e-12);
  ck_assert_double_eq_tol(r.cord_diameter, 0.2, 1e-12); /* 4 spans / 20 */
  set(&p, "bore", 0.5);
  assert_status(thr_physics_resolve(&p, &f, &r, &err), THR_EINPUT, &err, "span");
  thr_frame_destroy(&f);
}
END_TEST

/* The cord of edges of one length, which is rounded down to one that is sold. */
START_TEST(cords_are_as_they_are_sold)
{
  static const double edge_and_cord[][2] = {
      {1000, 3},    {60, 3},    {59.9, 2.5}, {49, 2},        {30, 1.5},  {29.9, 1.2},
      {20.6, 1},    {9, 1},     {8.5, 0.8},  {7, 0.8},       {5.9, 0.6}, {2.56, 0.25},
      {1.17, 0.12}, {0.9, 0.1}, {0.8, 0.08}, {0.1525, 0.015}};
  for (size_t i = 0; i < sizeof edge_and_cord / sizeof *edge_and_cord; i++) {
    const double xyz[2][3] = {{0, 0, 0}, {edge_and_cord[i][0], 0, 0}};
    thr_frame f = frame_make(2, xyz, 1, (const int[1][2]){{0, 1}}, NULL, NULL);
    memcpy(f.units, "mm", 3);
    thr_physics p = thr_physics_default(), r;
    thr_err err = {0};
    assert_ok(thr_physics_resolve(&p, &f, &r, &err), &err);
    ck_assert_double_eq(r.cord_diameter, edge_and_cord[i][1]);
    ck_assert_double_eq(r.bore, 2 * r.cord_diameter);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(sizes_that_are_left_open_always_fit)
{
  rng r = rng_make((uint64_t)_i);
  thr_frame f = random_frame(&r, 12, 8, LENGTHS_EUCLID);
  thr_physics p = thr_physics_default(), out;
  thr_err err = {0};
  assert_ok(thr_physics_resolve(&p, &f, &out, &err), &err);
  for (int e = 0; e < f.n_edges; e++) {
    const double *a = f.xyz[f.edge[e][0]], *b = f.xyz[f.edge[e][1]];
    ck_assert_double_lt(out.bore,
                        sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2)));
  }
  ck_assert(0 < out.cord_diameter && out.cord_diameter < out.bore && out.bore < out.bead_diameter);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(what_does_not_fit_is_refused)
{
  static const struct {
    const char *key[2];
    double value[2];
    const char *word[2];
  } wrong[] = {
      {{"bore", "cord_diameter"}, {2, 2}, {"bore", "--cord-diameter"}},
      {{"bore", "cord_diameter"}, {2, 3}, {"bore", "--bore"}},
      {{"bead_diameter", "bore"}, {3, 3}, {"bead_diameter", "--bore"}},
      {{"bore", "mu"}, {10, 0.2}, {"edge 2", "--units"}},
      {{"cord_diameter", "mu"}, {5, 0.2}, {"edge 2", "--cord-diameter"}},
      {{"mu", "mu_low"}, {0.2, 0.3}, {"mu_low", "0.2"}},
      {{"mu", "mu_high"}, {0.2, 0.1}, {"mu_low", "--mu-high"}},
      {{"density", "mu"}, {0, 0.2}, {"density", "--bead-mass"}},
  };
  thr_frame f = uneven_path(); /* in cm: the edge between nodes 2 and 3 is 10 mm long */
  memcpy(f.units, "cm", 3);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_physics p = thr_physics_default(), out = p;
    thr_err err = {0};
    for (int k = 0; k < 2; k++)
      set(&p, wrong[i].key[k], wrong[i].value[k]);
    ck_assert_msg(thr_physics_resolve(&p, &f, &out, &err) == THR_EINPUT, "case %d", (int)i);
    assert_one_line(&err, wrong[i].word[0]);
    ck_assert_msg(strstr(err.text, wrong[i].word[1]) != NULL, "%s", err.text);
    ck_assert(out.mu == 0 && out.seating == 0);
  }
  thr_physics p = thr_physics_default(), out;
  p.mu = NAN; /* past thr_physics_set */
  ck_assert_int_eq(thr_physics_resolve(&p, &f, &out, NULL), THR_EINPUT);
  p = thr_physics_default();
  p.seating = -1;
  ck_assert_int_eq(thr_physics_resolve(&p, &f, &out, NULL), THR_EINPUT);
  p = thr_physics_default();
  set(&p, "density", 0);
  set(&p, "bead_mass", 3);
  ck_assert_int_eq(thr_physics_resolve(&p, &f, &out, NULL), THR_OK);
  for (int v = 0; v < f.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      f.xyz[v][k] *= 1e9;
  thr_err err = {0};
  assert_status(thr_physics_resolve(&p, &f, &out, &err), THR_EINPUT, &err, "--units");
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("physics");
  ADD_TEST(s, 10, every_field_has_a_name_of_its_own);
  ADD_TEST(s, 10, values_out_of_range_are_refused);
  ADD_TEST(s, 10, presets_are_usable);
  ADD_TEST(s, 10, band_of_mu);
  ADD_LOOP(s, 10, json_there_and_back, 0, 20);
  ADD_TEST(s, 10, nonsense_in_json_is_refused);
  ADD_TEST(s, 10, files_are_read);
  ADD_TEST(s, 10, units);
  ADD_TEST(s, 10, sizes_come_from_the_framework);
  ADD_TEST(s, 10, cords_are_as_they_are_sold);
  ADD_LOOP(s, 10, sizes_that_are_left_open_always_fit, 0, 20);
  ADD_TEST(s, 10, what_does_not_fit_is_refused);
  return run_suite(s);
}
