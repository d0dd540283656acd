/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The viewer's page: what is in it is read back with the JSON library and compared with the plan,
 * names that could end the script do not, and failures leave nothing behind. What the page does is
 * tested in tests/viewer. */
#include "diagram/export/paper.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/evaluation.h"
#include "symmetry/symmetry.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static thr_plan dome_plan(void)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 5, 0);
  thr_plan p = plan_simple(&f, THR_ENDS_FEET, 1);
  thr_frame_destroy(&f);
  return p;
}

static thr_text page_of(const thr_plan *p, const char *const *motion)
{
  thr_text t = {0};
  thr_err err = {0};
  assert_ok(thr_viewer_html(p, motion, 0, 0, NULL, NULL, &t, &err), &err);
  return t;
}

/* The plan in the page, parsed. The rest of the page must be the built one. */
static thr_json *plan_in(const thr_text *page)
{
  const char *mark = strstr(thr_viewer_page, THR_VIEWER_MARK);
  thr_json *doc = NULL;
  thr_err err = {0};
  ck_assert_ptr_nonnull(mark);
  size_t before = (size_t)(mark - thr_viewer_page), after = strlen(mark + strlen(THR_VIEWER_MARK));
  ck_assert_ptr_null(strstr(mark + 1, THR_VIEWER_MARK));
  ck_assert_uint_gt(page->length, before + after);
  ck_assert_mem_eq(page->data, thr_viewer_page, before);
  ck_assert_mem_eq(page->data + page->length - after, mark + strlen(THR_VIEWER_MARK), after);
  assert_ok(thr_json_parse(&doc, page->data + before, page->length - before - after, "page", &err),
            &err);
  return doc;
}

static double number(const thr_json *v)
{
  double value = NAN;
  ck_assert(thr_json_number(v, &value));
  return value;
}

static void assert_string(const thr_json *v, const char *expected)
{
  ck_assert_ptr_nonnull(thr_json_string(v));
  ck_assert_str_eq(thr_json_string(v), expected);
}

static void assert_frame_kept(const thr_json *doc, const thr_frame *f)
{
  ck_assert_int_eq(thr_json_size(thr_json_get(doc, "nodes")), f->n_nodes);
  ck_assert_int_eq(thr_json_size(thr_json_get(doc, "labels")), f->n_nodes);
  ck_assert_int_eq(thr_json_size(thr_json_get(doc, "edges")), f->n_edges);
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++) {
      double x = number(thr_json_at(thr_json_at(thr_json_get(doc, "nodes"), v), i));
      ck_assert_double_le(fabs(x - f->xyz[v][i]), 1e-6 * fabs(f->xyz[v][i]));
    }
  for (int e = 0; e < f->n_edges; e++) {
    for (int i = 0; i < 2; i++)
      ck_assert_int_eq((int)number(thr_json_at(thr_json_at(thr_json_get(doc, "edges"), e), i)),
                       f->edge[e][i]);
    ck_assert_double_eq_tol(number(thr_json_at(thr_json_get(doc, "lengths"), e)), f->length[e],
                            1e-6 * f->length[e]);
  }
}

static void assert_cords_kept(const thr_json *doc, const thr_plan *p)
{
  const thr_json *cords = thr_json_get(doc, "cords");
  ck_assert_int_eq(thr_json_size(cords), p->n_cords);
  for (int c = 0; c < p->n_cords; c++) {
    const thr_json *cord = thr_json_at(cords, c);
    assert_string(thr_json_get(cord, "id"), p->cord[c].id);
    ck_assert_int_eq(thr_json_size(thr_json_get(cord, "half")), p->cord[c].n_passes);
    bool rigid = thr_json_true(thr_json_get(doc, "solid"));
    ck_assert_int_eq(rigid, p->options.joint == THR_JOINT_SOLID);
    ck_assert_int_eq(thr_json_size(thr_json_get(cord, "does")), p->cord[c].n_passes + rigid);
    for (int k = 0; k < p->cord[c].n_passes; k++)
      ck_assert_int_eq((int)number(thr_json_at(thr_json_get(cord, "half"), k)), p->cord[c].half[k]);
  }
}

START_TEST(page_holds_the_plan)
{
  thr_plan p = dome_plan();
  thr_text page = page_of(&p, NULL), again = page_of(&p, NULL);
  thr_json *doc = plan_in(&page);
  assert_frame_kept(doc, &p.frame);
  assert_cords_kept(doc, &p);
  ck_assert_ptr_null(thr_json_get(doc, "scale"));
  assert_same_text(&page, &again);
  thr_json_destroy(doc);
  thr_text_destroy(&page);
  thr_text_destroy(&again);
  thr_plan_destroy(&p);
}
END_TEST

/* Pieces and what is done with them: nodes, or edges. */
START_TEST(pieces_are_those_of_the_joint)
{
  for (int tube = 0; tube < 2; tube++) {
    thr_plan p = dome_plan();
    p.options.joint = tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
    thr_text page = page_of(&p, NULL);
    thr_json *doc = plan_in(&page);
    int n = tube ? p.frame.n_edges : p.frame.n_nodes, picked = 0;
    ck_assert_int_eq(thr_json_size(thr_json_get(doc, "pieces")), n);
    ck_assert_int_eq(thr_json_size(thr_json_get(doc, "kinds")), n);
    assert_cords_kept(doc, &p);
    const thr_json *does = thr_json_get(thr_json_at(thr_json_get(doc, "cords"), 0), "does");
    for (int i = 0; i < thr_json_size(does); i++)
      picked += strstr(thr_json_string(thr_json_at(does, i)), "pick up ") != NULL;
    ck_assert_int_eq(picked, n);
    thr_json_destroy(doc);
    thr_text_destroy(&page);
    thr_plan_destroy(&p);
  }
}
END_TEST

START_TEST(copies_are_named)
{
  thr_plan p = {0};
  thr_err err = {0};
  thr_limits none = {0};
  thr_frame f = shape_make(THR_MAKE_DOME, 6, 0);
  thr_request o = options_for(THR_ENDS_FEET, 1);
  want(&o, "overlap,steps");
  assert_ok(thr_symmetry_plan(&f, &o, &none, NULL, &p, &err), &err);
  const char **motion = calloc((size_t)p.n_cords, sizeof *motion);
  ck_assert_ptr_nonnull(motion);
  for (int c = 0; c < p.n_cords; c++)
    motion[c] = "moved";
  thr_text page = page_of(&p, motion);
  thr_json *doc = plan_in(&page);
  int paths = 0;
  for (int c = 0; c < p.n_cords; c++) {
    const thr_json *cord = thr_json_at(thr_json_get(doc, "cords"), c);
    bool unique = p.symmetry.unique[c] == c;
    paths += unique;
    ck_assert_int_eq((int)number(thr_json_get(cord, "of")), p.symmetry.unique[c]);
    ck_assert_int_eq(strncmp(thr_json_string(thr_json_get(cord, "how")), ", moved", 7) == 0,
                     !unique);
  }
  ck_assert_int_lt(paths, p.n_cords);
  ck_assert_int_eq((int)number(thr_json_get(doc, "paths")), paths);
  thr_json_destroy(doc);
  thr_text_destroy(&page);
  free(motion);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Tensions that double from pass to pass. */
static void evaluate(thr_plan *p, int n_passes)
{
  p->evaluation = (thr_evaluation){.present = true, .method = THR_CAPSTAN, .n_cords = p->n_cords};
  p->evaluation.cord = calloc((size_t)p->n_cords, sizeof *p->evaluation.cord);
  ck_assert_ptr_nonnull(p->evaluation.cord);
  thr_eval_cord *r = &p->evaluation.cord[0];
  *r = (thr_eval_cord){.known = true,
                       .n_passes = n_passes,
                       .force = 8,
                       .tension = calloc((size_t)n_passes, sizeof(double))};
  ck_assert_ptr_nonnull(r->tension);
  for (int k = 0; k < n_passes; k++)
    r->tension[k] = ldexp(1, k % 4);
}

START_TEST(tension_has_colours_and_a_scale)
{
  thr_plan p = dome_plan();
  evaluate(&p, p.cord[0].n_passes);
  thr_text page = page_of(&p, NULL);
  thr_json *doc = plan_in(&page);
  const thr_json *scale = thr_json_get(doc, "scale"),
                 *cord = thr_json_at(thr_json_get(doc, "cords"), 0);
  const thr_json *ramp = thr_json_get(scale, "ramp"), *taut = thr_json_get(cord, "taut");
  ck_assert_double_eq(number(thr_json_get(scale, "low")), 1);
  ck_assert_double_eq(number(thr_json_get(scale, "high")), 8);
  ck_assert_int_ge(thr_json_size(thr_json_get(scale, "ticks")), 2);
  for (int k = 0; k < p.cord[0].n_passes; k++) {
    ck_assert_double_eq(number(thr_json_at(thr_json_get(cord, "tension"), k)), ldexp(1, k % 4));
    /* even over the logarithm: doubling is a third of the ramp */
    assert_string(thr_json_at(taut, k),
                  thr_json_string(thr_json_at(ramp, k % 4 * (thr_json_size(ramp) - 1) / 3)));
  }
  thr_json_destroy(doc);
  thr_text_destroy(&page);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(names_cannot_end_the_script)
{
  static const char *const bad[] = {"</script><b>", "<!--<script",
                                    "a\xE2\x80\xA8"
                                    "b\xE2\x80\xA9",
                                    "\"'\\&@PLAN@"};
  static const double xyz[][3] = {{0, 0, 0}, {1, 0.2, 0}, {1.7, 1, 0.5}, {0, 1, 1.1}};
  static const int edge[][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, feet[] = {0, -1};
  thr_frame f = frame_make(4, xyz, 4, edge, NULL, feet);
  name_nodes(&f, bad, 4);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_text page = page_of(&p, NULL);
  thr_json *doc = plan_in(&page);
  const char *from = strstr(page.data, "id=\"plan\">") + 10, *end = strstr(from, "</script>");
  ck_assert_ptr_null(memchr(from, '<', (size_t)(end - from)));
  ck_assert_int_eq(end[-1], '}');
  for (const char *at = from; at < end; at++)
    ck_assert(memcmp(at, "\xE2\x80\xA8", 3) != 0 && memcmp(at, "\xE2\x80\xA9", 3) != 0);
  for (int v = 0; v < 4; v++) {
    const char *place = thr_json_string(thr_json_at(thr_json_get(doc, "places"), v));
    ck_assert_msg(strstr(place, v == 2 ? "a_b_" : bad[v]) != NULL, "%s",
                  place); /* separators are cleaned away */
  }
  thr_json_destroy(doc);
  thr_text_destroy(&page);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

static void assert_refused(const thr_plan *p, const char *word)
{
  thr_text t = {0};
  thr_err err = {0};
  thr_text_append(&t, "kept");
  assert_status(thr_viewer_html(p, NULL, 0, 0, NULL, NULL, &t, &err), THR_EINPUT, &err, word);
  ck_assert_str_eq(t.data, "kept");
  thr_text_destroy(&t);
}

START_TEST(misfits_are_refused)
{
  thr_plan p = dome_plan();
  int n_cords = p.n_cords, half = p.cord[0].half[1];
  p.n_cords = 0;
  assert_refused(&p, "no cord");
  p.n_cords = n_cords;
  p.cord[0].half[1] = 2 * p.frame.n_edges;
  assert_refused(&p, "edge");
  p.cord[0].half[1] = half;
  evaluate(&p, p.cord[0].n_passes - 1);
  assert_refused(&p, "evaluation");
  thr_plan_destroy(&p);
}
END_TEST

/* A framework that moves: its frames, and no cords. */
START_TEST(motion_in_the_page)
{
  thr_frame f = ring_make(4);
  static const bool cable[4] = {[2] = true};
  double at[8][3];
  thr_status st = THR_ENOMEM;
  memcpy(at, f.xyz, 4 * sizeof *at);
  memcpy(at + 4, f.xyz, 4 * sizeof *at);
  at[7][2] = 0.5;
  const thr_viewer_moves moves = {2, (const double(*)[3])at, cable, "Motion </script>", "note"};

  for (long k = 1; st; k++) {
    thr_text t = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = thr_viewer_moves_html(&f, &moves, &t, &err);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || st == THR_ENOMEM);
    ck_assert(!st || t.length == 0);
    if (!st) {
      thr_json *doc = plan_in(&t);
      const thr_json *in = thr_json_get(doc, "moves");
      ck_assert_int_eq(thr_json_size(thr_json_get(doc, "cords")), 0);
      assert_string(thr_json_get(in, "title"), "Motion </script>");
      ck_assert(number(thr_json_at(thr_json_get(in, "cables"), 0)) == 2);
      ck_assert_int_eq(thr_json_size(thr_json_get(in, "frames")), 2);
      ck_assert(number(thr_json_at(thr_json_at(thr_json_get(in, "frames"), 1), 11)) == 0.5);
      thr_json_destroy(doc);
    }
    thr_text_destroy(&t);
    ck_assert_int_lt(k, 10000);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_allocation_fails_once)
{
  thr_plan p = dome_plan();
  thr_status st = THR_ENOMEM;
  long k = 0;
  evaluate(&p, p.cord[0].n_passes);
  while (st) {
    thr_text t = {0};
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    st = thr_viewer_html(&p, NULL, 0, 0, NULL, NULL, &t, &err);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_msg(st == THR_ENOMEM, "allocation %ld: status %d, %s", k, (int)st, err.text);
      ck_assert_uint_eq(t.length, 0);
    }
    thr_text_destroy(&t);
    ck_assert_int_lt(k, 10000);
  }
  ck_assert_int_gt(k, 10); /* it did count */
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("viewer");
  ADD_TEST(s, 10, page_holds_the_plan);
  ADD_TEST(s, 10, pieces_are_those_of_the_joint);
  ADD_TEST(s, 30, copies_are_named);
  ADD_TEST(s, 10, tension_has_colours_and_a_scale);
  ADD_TEST(s, 10, names_cannot_end_the_script);
  ADD_TEST(s, 10, misfits_are_refused);
  ADD_TEST(s, 60, motion_in_the_page);
  ADD_TEST(s, 60, every_allocation_fails_once);
  return run_suite(s);
}
