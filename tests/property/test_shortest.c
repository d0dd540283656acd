/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shortest cords of random frameworks against two oracles that know no linear programming, and what
 * must not change. */
#define _POSIX_C_SOURCE 200809L
#include "graph/check/check.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const thr_ends all_ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_NODES};

/* Everything that holds for a proved plan, whatever the framework. */
static void assert_proved(const thr_plan *p, double extra)
{
  double base = p->options.cover * thr_frame_total_length(&p->frame);
  ck_assert_double_eq_tol(p->metrics.length, base + extra, 1e-9 * base);
  ck_assert(p->proof.optimal);
  ck_assert_double_eq(p->proof.lower_bound, p->metrics.length);
  ck_assert_double_eq(p->proof.gap, 0);
  ck_assert_int_eq(verdict_by_sums(p), 2);
  ck_assert_int_eq(p->metrics.u_turns, forced_u_turns(p));
  assert_plan_sound(p);
}

static void compare_all_ends(rng *r, const thr_frame *f,
                             double (*oracle)(const thr_frame *, const thr_request *))
{
  bool end_node[64] = {false};
  for (int k = rng_between(r, 1, 4); k > 0; k--)
    end_node[rng_below(r, f->n_nodes)] = true;
  for (int i = 0; i < 4; i++) {
    thr_request o = options_for(all_ends[i], rng_between(r, 1, 3));
    if (all_ends[i] == THR_ENDS_NODES) o.end_node = end_node;
    thr_plan p = plan_make(f, &o);
    assert_proved(&p, oracle(f, &o));
    thr_plan_destroy(&p);
  }
}

START_TEST(small_ones_match_all_subsets)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int k = 0; k < 12; k++) {
    int n = rng_between(&r, 2, 9), extra = rng_below(&r, k == 0 ? 17 - n : 14 - n);
    thr_frame f = random_frame(&r, n, extra, (length_kind)(k % LENGTH_KINDS));
    compare_all_ends(&r, &f, least_extra_by_subsets);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(medium_ones_match_a_matching)
{
  rng r = rng_make((uint64_t)_i + 1000);
  for (int k = 0; k < 8; k++) {
    int n = rng_between(&r, 10, 60);
    thr_frame f = random_frame_few_odd(&r, n, rng_below(&r, 2 * n), (length_kind)(k % LENGTH_KINDS),
                                       k == 0 ? 16 : 12);
    compare_all_ends(&r, &f, least_extra_by_matching);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(oracles_agree)
{
  rng r = rng_make((uint64_t)_i + 2000);
  for (int k = 0; k < 20; k++) {
    thr_frame f =
        random_frame(&r, rng_between(&r, 2, 8), rng_below(&r, 5), (length_kind)(k % LENGTH_KINDS));
    for (int i = 0; i < 3; i++) {
      thr_request o = options_for(all_ends[i], 1 + k % 3);
      ck_assert_double_eq_tol(least_extra_by_subsets(&f, &o), least_extra_by_matching(&f, &o),
                              1e-9);
    }
    thr_frame_destroy(&f);
  }
}
END_TEST

/* ---- several cords in a component ---- */

static void compare_cords(rng *r, const thr_frame *f,
                          double (*oracle)(const thr_frame *, const thr_request *))
{
  bool end_node[64] = {false};
  for (int k = rng_between(r, 1, 9); k > 0; k--)
    end_node[rng_below(r, f->n_nodes)] = true;
  for (int i = 0; i < 4; i++)
    for (int cords = 1; cords <= 4; cords++) {
      thr_request o = options_for(all_ends[i], rng_between(r, 1, 3));
      double base = o.cover * thr_frame_total_length(f), bound;
      bool optimal;
      thr_shortest s;
      thr_err err = {0};
      o.cords = cords;
      if (all_ends[i] == THR_ENDS_NODES) o.end_node = end_node;
      ck_assert_msg(thr_postman_shortest(f, &o, &(thr_limits){0}, &s, &err) == THR_OK && s.optimal,
                    "%s", err.text);
      ck_assert_double_eq_tol(s.length, base + oracle(f, &o), 1e-9 * base);
      ck_assert_double_eq(s.lower_bound, s.length);
      s.passes[0]++; /* an odd number at both its nodes: too many ends, or the certificate does not
                        fit */
      ck_assert_int_eq(thr_check_length_of_passes(f, &o, s.passes, s.certificate, s.n_certificates,
                                                  &optimal, &bound, NULL),
                       THR_EVIOLATED);
      s.passes[0] = 0;
      ck_assert_int_eq(thr_check_length_of_passes(f, &o, s.passes, s.certificate, s.n_certificates,
                                                  &optimal, &bound, NULL),
                       THR_EVIOLATED);
      thr_shortest_destroy(&s);
    }
}

START_TEST(cords_of_small_ones_match_all_subsets)
{
  rng r = rng_make((uint64_t)_i + 7000);
  for (int k = 0; k < 8; k++) {
    int n = rng_between(&r, 2, 9);
    thr_frame f = random_frame(&r, n, rng_below(&r, 14 - n), (length_kind)(k % LENGTH_KINDS));
    compare_cords(&r, &f, least_extra_by_subsets);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(cords_of_medium_ones_match_a_matching)
{
  rng r = rng_make((uint64_t)_i + 8000);
  for (int k = 0; k < 5; k++) {
    int n = rng_between(&r, 10, 60);
    thr_frame f =
        random_frame_few_odd(&r, n, rng_below(&r, 2 * n), (length_kind)(k % LENGTH_KINDS), 14);
    compare_cords(&r, &f, least_extra_by_matching);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Free ends of a framework with 2 q odd nodes: q cords and more need no extra pass, however many
 * they are. */
START_TEST(enough_cords_need_no_extra_pass)
{
  static const int many[] = {0, 1, 5, 50};
  rng r = rng_make((uint64_t)_i + 9000);
  thr_frame f =
      random_frame(&r, rng_between(&r, 4, 20), rng_below(&r, 20), (length_kind)(_i % LENGTH_KINDS));
  int odd = 0;
  for (int v = 0; v < f.n_nodes; v++)
    odd += thr_degree(&f, v) % 2;
  for (int i = 0; i < 4 && odd > 0; i++) {
    thr_request o = options_for(THR_ENDS_ANY, 1);
    thr_shortest s;
    o.cords = odd / 2 + many[i];
    ck_assert_int_eq(thr_postman_shortest(&f, &o, &(thr_limits){0}, &s, NULL), THR_OK);
    for (int e = 0; e < f.n_edges; e++)
      ck_assert_int_eq(s.passes[e], 1);
    thr_shortest_destroy(&s);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Goes there and back over the first edge of the first cord once more. */
static void add_detour(thr_plan *p)
{
  thr_cord *c = &p->cord[0];
  int *half = calloc((size_t)c->n_passes + 2, sizeof *half);
  ck_assert(half != NULL);
  half[0] = c->half[0], half[1] = c->half[0] ^ 1;
  memcpy(half + 2, c->half, (size_t)c->n_passes * sizeof *half);
  free(c->half);
  c->half = half;
  c->n_passes += 2;
}

/* A plan that is longer than need be gets the shortest length as its bound: with equal beads to the
 * last digit. */
START_TEST(a_longer_plan_is_bounded_by_the_shortest)
{
  rng r = rng_make((uint64_t)_i + 10000);
  int n = rng_between(&r, 3, 9);
  thr_frame f = random_frame(&r, n, rng_below(&r, 14 - n), LENGTHS_EQUAL);
  double bead = f.length[0];
  for (int cords = 0; cords <= 3; cords++) {
    thr_request o = options_for(cords ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
    o.cords = cords > 1 && f.n_edges > 3 ? cords : 1;
    thr_plan p = cords ? plan_of_cords(&f, &o) : plan_make(&f, &o);
    thr_shortest s = {.certificate = p.proof.certificate, .n_certificates = 1};
    double least = o.cover * thr_frame_total_length(&f) + least_extra_by_subsets(&f, &o);
    thr_err err = {0};
    add_detour(&p);
    p.proof = (thr_length_proof){0};
    ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, p.n_cords, &p.metrics, NULL),
                     THR_OK);
    assert_ok(thr_postman_prove(&p.frame, &p.options, p.cord, p.n_cords, &s, &p.proof, &err), &err);
    ck_assert(!p.proof.optimal && s.certificate == NULL);
    ck_assert_double_eq_tol(p.metrics.length, least + 2 * bead, 1e-12 * least);
    ck_assert_double_eq_tol(p.proof.lower_bound, least, 1e-12 * least);
    assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* No oracle but the certificate. Seeds 77 and 111 once sent the cutting planes round in circles. */
START_TEST(larger_ones_are_proved)
{
  rng r = rng_make((uint64_t)_i);
  int n = rng_between(&r, 50, 300), extra = rng_below(&r, 300);
  thr_frame f = random_frame(&r, n, extra, (length_kind)(_i % LENGTH_KINDS));
  for (int i = 0; i < 3; i++) {
    thr_plan p = plan_simple(&f, all_ends[i], 1);
    assert_proved(&p, p.metrics.overlap);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- invariance ---- */

static double length_of(const thr_frame *f, thr_ends ends, int cover)
{
  thr_plan p = plan_simple(f, ends, cover);
  ck_assert_int_eq(p.metrics.u_turns, forced_u_turns(&p));
  double length = p.metrics.length;
  thr_plan_destroy(&p);
  return length;
}

START_TEST(names_and_order_do_not_matter)
{
  rng r = rng_make((uint64_t)_i + 3000);
  int to[40];
  thr_frame f =
      random_frame(&r, rng_between(&r, 5, 40), rng_below(&r, 50), (length_kind)(_i % LENGTH_KINDS));
  thr_frame g = shuffled_frame(&r, &f, to);
  for (int i = 0; i < 3; i++) {
    double length = length_of(&f, all_ends[i], 1);
    ck_assert_double_eq_tol(length_of(&g, all_ends[i], 1), length, 1e-9 * length);
  }
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
}
END_TEST

/* Turns about two axes, scales by s, then moves. */
static thr_frame moved(const thr_frame *f, double a, double b, double s, double shift)
{
  thr_frame g;
  double(*xyz)[3] = calloc((size_t)f->n_nodes, sizeof *xyz);
  ck_assert(xyz != NULL);
  for (int v = 0; v < f->n_nodes; v++) {
    const double *p = f->xyz[v];
    double x = cos(a) * p[0] - sin(a) * p[1], y = sin(a) * p[0] + cos(a) * p[1];
    xyz[v][0] = s * x + shift;
    xyz[v][1] = s * (cos(b) * y - sin(b) * p[2]) - shift;
    xyz[v][2] = s * (sin(b) * y + cos(b) * p[2]) + 2 * shift;
  }
  g = frame_make(f->n_nodes, (const double(*)[3])xyz, f->n_edges, (const int(*)[2])f->edge, NULL,
                 NULL);
  memcpy(g.foot, f->foot, (size_t)f->n_nodes * sizeof *g.foot);
  free(xyz);
  return g;
}

START_TEST(place_does_not_matter_and_size_scales)
{
  rng r = rng_make((uint64_t)_i + 4000);
  static const double scale[] = {1, 1e-3, 25.4, 1e6};
  thr_frame f = random_frame(&r, rng_between(&r, 5, 40), rng_below(&r, 50), LENGTHS_EUCLID);
  double s = scale[_i % 4];
  thr_frame g = moved(&f, rng_unit(&r) * 6, rng_unit(&r) * 6, s, s * 50 * rng_unit(&r));
  for (int i = 0; i < 3; i++) {
    double length = s * length_of(&f, all_ends[i], 1);
    ck_assert_double_eq_tol(length_of(&g, all_ends[i], 1), length, 1e-9 * length);
  }
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
}
END_TEST

START_TEST(more_freedom_is_never_longer)
{
  rng r = rng_make((uint64_t)_i + 5000);
  thr_frame f =
      random_frame(&r, rng_between(&r, 3, 50), rng_below(&r, 60), (length_kind)(_i % LENGTH_KINDS));
  double closed = length_of(&f, THR_ENDS_CLOSED, 1), feet = length_of(&f, THR_ENDS_FEET, 1),
         any = length_of(&f, THR_ENDS_ANY, 1);
  double total = thr_frame_total_length(&f), twice = length_of(&f, THR_ENDS_CLOSED, 2),
         thrice = length_of(&f, THR_ENDS_CLOSED, 3);
  ck_assert(any <= feet * (1 + 1e-9) && feet <= closed * (1 + 1e-9) &&
            closed <= 2 * total * (1 + 1e-9));
  ck_assert_double_eq_tol(twice, 2 * total, 1e-9 * total);
  ck_assert_double_eq_tol(thrice, closed + 2 * total, 1e-9 * total);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(same_input_gives_the_same_bytes)
{
  rng r = rng_make((uint64_t)_i + 6000);
  thr_frame f = random_frame(&r, 60, 70, (length_kind)(_i % LENGTH_KINDS)),
            other = random_frame(&r, 30, 30, LENGTHS_RANDOM);
  thr_plan p = plan_simple(&f, all_ends[_i % 3], 1), between = plan_simple(&other, THR_ENDS_ANY, 1),
           q = plan_simple(&f, all_ends[_i % 3], 1);
  thr_text a = plan_text(&p), b = plan_text(&q);
  assert_same_text(&a, &b);
  thr_text_destroy(&a);
  thr_text_destroy(&b);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_plan_destroy(&between);
  thr_frame_destroy(&f);
  thr_frame_destroy(&other);
}
END_TEST

/* ---- every framework file ---- */

static void assert_file_is_solved(const char *path)
{
  thr_frame f = frame_load(path, NULL);
  bool feet = false;
  for (int v = 0; v < f.n_nodes; v++)
    feet |= f.foot[v];
  for (int i = 0; i < 3; i++) {
    thr_plan p;
    thr_request o = options_for(all_ends[i], 1);
    thr_limits none = {0};
    thr_err err = {0};
    thr_status st = thr_postman_plan(&f, &o, &none, &p, &err);
    if (st == THR_EINFEASIBLE && all_ends[i] == THR_ENDS_FEET)
      continue; /* a component without feet: said so */
    ck_assert_msg(st == THR_OK && p.proof.optimal, "%s, ends %s: %s", path,
                  thr_ends_name(all_ends[i]), err.text);
    ck_assert(all_ends[i] != THR_ENDS_FEET || feet);
    ck_assert_double_eq(p.proof.lower_bound, p.metrics.length);
    ck_assert_int_eq(p.metrics.u_turns, forced_u_turns(&p));
    assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}

/* Solves what lies in a folder and below it; how many files. */
static int solve_folder(const char *folder)
{
  int solved = 0;
  struct dirent **list;
  int n = scandir(folder, &list, NULL, alphasort);
  for (int i = 0; i < n; i++) {
    char path[512];
    struct stat info;
    const char *name = list[i]->d_name, *dot = strrchr(name, '.');
    snprintf(path, sizeof path, "%s/%s", folder, name);
    bool framework = dot && (!strcmp(dot, ".json") || !strcmp(dot, ".obj") ||
                             (!strcmp(dot, ".csv") && !strstr(name, "edges")));
    if (name[0] != '.' && stat(path, &info) == 0) {
      if (S_ISDIR(info.st_mode)) {
        solved += solve_folder(path);
      } else if (framework) {
        assert_file_is_solved(path);
        solved++;
      }
    }
    free(list[i]);
  }
  if (n >= 0) free(list);
  return solved;
}

START_TEST(every_framework_in_data_is_solved)
{
  ck_assert_int_ge(solve_folder("data"), 10);
}
END_TEST

START_TEST(further_frameworks_are_solved_where_present)
{
  (void)solve_folder("../shared/frames");
}
END_TEST

int main(void)
{
  Suite *s = suite_create("shortest cords of random frameworks");
  ADD_EXAMPLES(s, 60, small_ones_match_all_subsets, 50);
  ADD_EXAMPLES(s, 60, medium_ones_match_a_matching, 25);
  ADD_EXAMPLES(s, 30, oracles_agree, 5);
  ADD_EXAMPLES(s, 60, cords_of_small_ones_match_all_subsets, 25);
  ADD_EXAMPLES(s, 60, cords_of_medium_ones_match_a_matching, 12);
  ADD_EXAMPLES(s, 30, enough_cords_need_no_extra_pass, 25);
  ADD_EXAMPLES(s, 30, a_longer_plan_is_bounded_by_the_shortest, 60);
  ADD_LOOP(s, 30, larger_ones_are_proved, 72, 112);
  ADD_EXAMPLES(s, 20, names_and_order_do_not_matter, 40);
  ADD_EXAMPLES(s, 20, place_does_not_matter_and_size_scales, 40);
  ADD_EXAMPLES(s, 20, more_freedom_is_never_longer, 40);
  ADD_EXAMPLES(s, 20, same_input_gives_the_same_bytes, 12);
  ADD_TEST(s, 60, every_framework_in_data_is_solved);
  ADD_TEST(s, 120, further_frameworks_are_solved_where_present);
  return run_suite(s);
}
