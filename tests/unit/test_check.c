/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker against forged plans: each claim, altered once, is caught and named. Random
 * alterations are in tests/property/test_mutations.c. */
#include "graph/check/check.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_frame frame;
  thr_plan plan;
} fixture;

static fixture fixture_make(thr_frame f, thr_ends ends)
{
  fixture x = {f, plan_simple(&f, ends, 1)};
  return x;
}

static void fixture_destroy(fixture *x)
{
  thr_plan_destroy(&x->plan);
  thr_frame_destroy(&x->frame);
}

/* A plan that is sound but longer than need be: the closed cord first goes along its first edge and
 * back. */
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
  ck_assert_int_eq(thr_plan_measure(&p->frame, &p->options, p->cord, p->n_cords, &p->metrics, NULL),
                   THR_OK);
  p->proof.certificate[0].join +=
      2 * thr_certificate_weight(&p->frame, &p->proof.certificate[0], half[0] / 2);
}

static void drop_cuts(thr_certificate *c)
{
  for (int i = 0; i < c->n_cuts; i++)
    free(c->cut[i].node);
  c->n_cuts = 0;
  c->sum = 0;
}

START_TEST(longer_plan_keeps_its_bound_and_loses_optimal)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  thr_plan *p = &x.plan;
  add_detour(p);
  assert_violated(p, "proof.length");
  p->proof.optimal = false;
  assert_violated(p, "gap");
  p->proof.lower_bound = 16;
  p->proof.gap = 2.0 / 18;
  assert_holds(p);
  p->proof.lower_bound = 15; /* less than proved may be claimed */
  p->proof.gap = 3.0 / 18;
  assert_holds(p);
  p->proof.lower_bound = 16.001;
  p->proof.gap = 1.999 / 18;
  assert_violated(p, "lower_bound");
  p->proof.lower_bound = 18;
  p->proof.gap = 0;
  assert_violated(p, "lower_bound");
  fixture_destroy(&x);
}
END_TEST

/* Weights that round to nothing make every join weigh nothing: that must not pass for a proof. */
START_TEST(scale_that_rounds_all_away_proves_nothing)
{
  static const double scale[] = {1e-300, 1e-30, 0.49};
  for (size_t i = 0; i < sizeof scale / sizeof *scale; i++) {
    fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
    thr_plan *p = &x.plan;
    add_detour(p);
    drop_cuts(&p->proof.certificate[0]);
    p->proof.certificate[0].scale = scale[i];
    p->proof.certificate[0].join = 0;
    p->proof.lower_bound = p->metrics.length;
    p->proof.gap = 0;
    assert_violated(p, "proof.length");
    fixture_destroy(&x);
  }
}
END_TEST

/* A ring with a chord that costs next to nothing: passed to and fro it weighs nothing under a
 * coarse scale, and each pass rounds once more. Neither may pass for a proof, whichever edge the
 * chord is. */
START_TEST(passes_without_weight_prove_nothing)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int chord = 0; chord < 5; chord++) {
    int edge[5][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1}};
    double length[5] = {2.5, 2.5, 2.5, 2.5, 2.5};
    memcpy(edge[4], edge[chord], sizeof edge[4]);
    edge[chord][0] = 0, edge[chord][1] = 2;
    length[chord] = 9e-9;
    fixture x =
        fixture_make(frame_make(4, xyz, 5, (const int(*)[2])edge, length, NULL), THR_ENDS_CLOSED);
    thr_plan *p = &x.plan;
    thr_certificate *c = &p->proof.certificate[0];
    assert_holds(p);
    drop_cuts(c);
    c->scale = 2;
    c->join = 0;
    assert_violated(p, "optimal");
    fixture_destroy(&x);
  }
}
END_TEST

START_TEST(an_optimal_plan_is_its_own_bound)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  x.plan.proof.lower_bound = 0;
  x.plan.proof.gap = 1;
  assert_violated(&x.plan, "lower bound");
  fixture_destroy(&x);
}
END_TEST

/* Cross products of tiny or huge sides would vanish or overflow. */
START_TEST(angles_do_not_depend_on_size)
{
  static const double size[] = {1e-90, 1, 1e90};
  for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
    double a = size[i], xyz[4][3] = {{0, 0, 0}, {a, 0, 0}, {a, a, 0}, {0, a, 0}};
    static const int edge[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    fixture x =
        fixture_make(frame_make(4, (const double(*)[3])xyz, 4, edge, NULL, NULL), THR_ENDS_CLOSED);
    ck_assert_double_eq_tol(x.plan.metrics.turning, 6.283185307179586, 1e-12);
    assert_holds(&x.plan);
    x.plan.metrics.turning = x.plan.metrics.max_turning = 0;
    assert_violated(&x.plan, "turning");
    fixture_destroy(&x);
  }
}
END_TEST

START_TEST(no_extra_pass_needs_no_proof)
{
  fixture x = fixture_make(solid_make(OCTAHEDRON), THR_ENDS_CLOSED);
  drop_cuts(&x.plan.proof.certificate[0]);
  assert_holds(&x.plan);
  fixture_destroy(&x);
}
END_TEST

START_TEST(forged_cords)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_ANY);
  thr_plan *p = &x.plan;
  thr_cord *c = &p->cord[0], kept = *c;
  c->closed = true;
  assert_violated(p, "cord A");
  *c = kept;
  c->component = 1;
  assert_violated(p, "component 1");
  *c = kept;
  memcpy(c->id, "B", 2);
  assert_violated(p, "called B");
  *c = kept;
  c->n_passes--; /* the last pass is the only one over its edge, or the cord ends elsewhere than it
                    says */
  assert_violated(p, NULL);
  *c = kept;
  c->half++, c->n_passes--;
  assert_violated(p, NULL);
  *c = kept;
  c->half[0] ^= 1;
  assert_violated(p, "pass 1");
  c->half[0] ^= 1;
  assert_holds(p);
  fixture_destroy(&x);
}
END_TEST

START_TEST(forged_ends)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_ANY);
  thr_plan *p = &x.plan;
  bool end_node[8] = {false};
  p->options.ends = THR_ENDS_CLOSED;
  assert_violated(p, "closed");
  p->options.ends = THR_ENDS_FEET; /* no foot at all */
  assert_violated(p, "no cord end is allowed");
  p->options.ends = THR_ENDS_NODES;
  p->options.end_node = end_node;
  end_node[thr_cord_start(&p->frame, p->cord)] = true;
  assert_violated(p, "ends at node");
  end_node[thr_cord_end(&p->frame, p->cord)] = true;
  assert_holds(p);
  p->options.end_node = NULL;
  fixture_destroy(&x);
}
END_TEST

START_TEST(forged_cover)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  x.plan.options.cover = 2;
  assert_violated(&x.plan, "1 of 2 passes");
  fixture_destroy(&x);
}
END_TEST

START_TEST(forged_counts)
{
  fixture x = fixture_make(triangles_make(3), THR_ENDS_CLOSED);
  thr_plan *p = &x.plan;
  p->n_cords = 2;
  assert_violated(p, "edge 6");
  p->n_cords = 3;
  p->options.cords = p->options.cords_least = 2;
  assert_violated(p, "component 0: has 1 cord; the plan's options say 2");
  p->options.cords = 3;
  assert_violated(p, "component 0: has 1 cord; the plan's options say 2 to 3");
  p->options.cords_least = 1;
  assert_holds(p); /* closed cords, no extra pass */
  p->options.cords = 1;
  p->proof.n_certificates = 2;
  assert_violated(p, "2 certificates");
  p->proof.n_certificates = 3;
  p->proof.certificate[1].component = 2;
  assert_violated(p, "certificate 1");
  p->proof.certificate[1].component = 1;
  p->cord[2].component = 1;
  assert_violated(p, "cord C");
  p->cord[2].component = 2;
  assert_holds(p);
  fixture_destroy(&x);
}
END_TEST

/* One cut alone that overloads nothing but breaks one rule; values of 1 keep it small. */
START_TEST(forged_cuts)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_ANY);
  thr_plan *p = &x.plan;
  thr_certificate *c = &p->proof.certificate[0];
  static const struct {
    int n, node[3];
    int64_t value;
    const char *word;
  } forged[] = {{0, {0}, 1, "even number of odd nodes"},
                {2, {0, 1}, 1, "even number of odd nodes"},
                {3, {0, 2, 1}, 1, "ascending"},
                {3, {0, 1, 1}, 1, "ascending"},
                {1, {6}, -1, "negative"}};
  for (size_t i = 0; i < sizeof forged / sizeof *forged; i++) {
    int node[3];
    memcpy(node, forged[i].node, sizeof node);
    thr_cut cut[1] = {{-1, forged[i].n, node, forged[i].value}};
    thr_certificate kept = *c;
    c->cut = cut;
    c->n_cuts = 1;
    assert_violated(p, forged[i].word);
    *c = kept;
  }
  assert_holds(p);
  fixture_destroy(&x);
}
END_TEST

START_TEST(cuts_of_another_component)
{
  fixture x = fixture_make(triangles_make(2), THR_ENDS_ANY);
  int node[1] = {3};
  thr_cut cut[1] = {{-1, 1, node, 1}};
  thr_certificate *c = &x.plan.proof.certificate[0], kept = *c;
  c->cut = cut;
  c->n_cuts = 1;
  assert_violated(&x.plan, "node 3 is in component 1");
  *c = kept;
  assert_holds(&x.plan);
  fixture_destroy(&x);
}
END_TEST

/* {0} in {0, 1, 3}, and {5}: on a cube, where every node is odd and 0-1, 0-3 are edges. */
START_TEST(forged_trees)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  thr_plan *p = &x.plan;
  thr_certificate *c = &p->proof.certificate[0], kept = *c;
  int a[] = {0}, b[] = {1, 3}, d[] = {5}, e[] = {0, 1, 3};
  thr_cut cut[3] = {{1, 1, a, 1}, {-1, 2, b, 1}, {-1, 1, d, 1}};
  c->cut = cut;
  c->n_cuts = 3;
  c->sum = 3;
  assert_violated(p, "optimal"); /* they hold, and prove little */
  cut[0].parent = 0;
  assert_violated(p, "parent");
  cut[0].parent = 3;
  assert_violated(p, "parent");
  cut[0].parent = -2;
  assert_violated(p, "parent");
  cut[0].parent = 1;
  cut[2].parent = 1; /* before it: a circle would need one such */
  assert_violated(p, "parent");
  cut[2].parent = -1;
  cut[0].parent = 2; /* {0} in {0, 5} */
  assert_violated(p, "even");
  cut[1].node = e, cut[1].n_nodes = 3;
  cut[0].parent = 1; /* 0 is in the child and in the parent's own nodes */
  assert_violated(p, NULL);
  cut[2] = (thr_cut){-1, 3, e, 1};
  int f[] = {0, 1};
  cut[1] = (thr_cut){2, 2, f, 1};
  cut[0].parent = 2;
  assert_violated(p, NULL);
  *c = kept;
  assert_holds(p);
  fixture_destroy(&x);
}
END_TEST

/* A node twice in a tree of odd sets. */
START_TEST(nodes_twice_in_a_tree)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  thr_certificate *c = &x.plan.proof.certificate[0], kept = *c;
  int a[] = {0}, b[] = {0, 1}, d[] = {0, 1};
  thr_cut cut[2] = {{1, 1, a, 1}, {-1, 2, b, 1}},
          three[3] = {{2, 1, a, 0}, {2, 1, a, 0}, {-1, 1, d, 0}};
  c->cut = cut;
  c->n_cuts = 2;
  c->sum = 2;
  assert_violated(&x.plan, "node 0 is in cut 0, too");
  c->cut = three;
  c->n_cuts = 3;
  assert_violated(&x.plan, "node 0 is in cut");
  *c = kept;
  assert_holds(&x.plan);
  fixture_destroy(&x);
}
END_TEST

/* Of a price that is too low the sets round an end are too many, of one too high they prove too
 * little. */
START_TEST(forged_end_price)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_ANY),
          closed = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  thr_certificate *c = &x.plan.proof.certificate[0];
  int64_t kept = c->end_price;
  ck_assert_int_gt(kept, 0);
  c->end_price--;
  assert_violated(&x.plan, "end price");
  c->end_price = 0;
  assert_violated(&x.plan, "end price");
  c->end_price = -1;
  assert_violated(&x.plan, "end");
  c->end_price = kept + c->denominator;
  assert_violated(&x.plan, "optimal");
  c->end_price = INT64_MAX;
  assert_violated(&x.plan, "optimal");
  c->end_price = kept;
  assert_holds(&x.plan);
  closed.plan.proof.certificate[0].end_price = 1;
  assert_violated(&closed.plan, "end price");
  fixture_destroy(&x);
  fixture_destroy(&closed);
}
END_TEST

START_TEST(forged_numbers)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  thr_plan *p = &x.plan;
  thr_certificate *c = &p->proof.certificate[0], kept = *c;
  static const double scale[] = {0, -1, 1e300, 2, 0.5};
  for (size_t i = 0; i < sizeof scale / sizeof *scale; i++) {
    c->scale = i < 3 ? scale[i] : kept.scale * scale[i];
    assert_violated(p, i < 4 ? "component 0"
                             : NULL); /* lengths of 1 may still weigh 1: then the rounding shows */
  }
  *c = kept;
  c->denominator *= 2;
  assert_violated(p, "optimal");
  *c = kept;
  c->denominator /= 2;
  assert_violated(p, "add up to more");
  *c = kept;
  c->sum++;
  assert_violated(p, "sum");
  *c = kept;
  c->join--;
  assert_violated(p, "weigh");
  *c = kept;
  c->cut[0].value++;
  assert_violated(p, "component 0");
  c->cut[0].value = INT64_MAX;
  assert_violated(p, "add up to more");
  *c = kept;
  fixture_destroy(&x);
}
END_TEST

START_TEST(each_metric_counts)
{
  fixture x = fixture_make(solid_make(CUBE), THR_ENDS_CLOSED);
  thr_plan *p = &x.plan;
  thr_metrics kept = p->metrics, *m = &p->metrics;
  double *real[] = {&m->length,  &m->base_length, &m->overlap,
                    &m->turning, &m->max_turning, &m->worst_turn};
  static const char *const real_name[] = {"metrics.length",      "metrics.base_length",
                                          "metrics.overlap",     "metrics.turning",
                                          "metrics.max_turning", "metrics.worst_turn"};
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 4; k++) {
      *m = kept;
      *real[i] = k == 0 ? 0 : k == 1 ? -*real[i] : *real[i] * (1 + (k == 2 ? 1e-6 : -1e-6));
      assert_violated(p, real_name[i]);
    }
  int *whole[] = {&m->passes, &m->most_passes, &m->u_turns};
  static const char *const whole_name[] = {"metrics.passes", "metrics.most_passes",
                                           "metrics.u_turns"};
  for (int i = 0; i < 3; i++)
    for (int k = -1; k < 2; k += 2) {
      *m = kept;
      *whole[i] += k;
      if (*whole[i] < 0) continue;
      assert_violated(p, whole_name[i]);
    }
  *m = kept;
  p->proof.gap = 1e-6;
  assert_violated(p, "gap");
  fixture_destroy(&x);
}
END_TEST

/* Without a proof of length only a plan for the least turning has to have as many cords as asked
 * for. */
START_TEST(cords_without_a_proof)
{
  fixture x = fixture_make(triangles_make(2), THR_ENDS_ANY);
  thr_plan *p = &x.plan;
  p->proof.present = false;
  p->options.cords = 3;
  assert_holds(p);
  p->options.cords_least = 3;
  want(&p->options, "turning");
  assert_violated(p, "component 0: has 1 cord; the plan's options say 3");
  fixture_destroy(&x);
}
END_TEST

/* Only where closed cords are asked for does a cord turn where it closes. */
START_TEST(the_turn_where_a_cord_closes)
{
  fixture x = fixture_make(ring_make(6), THR_ENDS_CLOSED),
          y = fixture_make(ring_make(6), THR_ENDS_ANY);
  ck_assert(x.plan.cord[0].closed && y.plan.cord[0].closed);
  ck_assert_double_eq_tol(x.plan.metrics.turning, 6.283185307179586, 1e-12);
  ck_assert_double_eq_tol(y.plan.metrics.turning, 6.283185307179586 * 5 / 6, 1e-12);
  assert_holds(&x.plan);
  assert_holds(&y.plan);
  x.plan.metrics.turning = x.plan.metrics.max_turning = y.plan.metrics.turning;
  assert_violated(&x.plan, "turning");
  fixture_destroy(&x);
  fixture_destroy(&y);
}
END_TEST

/* Passes that no cords can run through are no plan's, whatever is proved about shorter ones. */
START_TEST(passes_without_cords)
{
  thr_frame f = grid_make(4, 4);
  thr_request o = options_for(THR_ENDS_FEET, 1);
  thr_shortest s;
  thr_err err = {0};
  bool optimal;
  double bound;
  o.cords = 2;
  ck_assert_int_eq(thr_postman_shortest(&f, &o, &(thr_limits){0}, &s, NULL), THR_OK);
  s.passes[3]++;
  assert_status(
      thr_check_length_of_passes(&f, &o, s.passes, s.certificate, 1, &optimal, &bound, &err),
      THR_EVIOLATED, &err, "no cord can end there");
  s.passes[3] = 0;
  assert_status(
      thr_check_length_of_passes(&f, &o, s.passes, s.certificate, 1, &optimal, &bound, &err),
      THR_EVIOLATED, &err, "0 of 1 passes");
  thr_shortest_destroy(&s);
  thr_frame_destroy(&f);
}
END_TEST

/* A path there and back needs every edge twice: the sets {0}, {0, 1}, {0, 1, 2}, .. prove it, each
 * round the one before. They are checked and stored in about linear time and space. */
START_TEST(many_nested_sets)
{
  enum { N = 20001 };
  thr_frame f = path_make(N);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan p = {0};
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  p.n_cords = 1;
  p.cord = calloc(1, sizeof *p.cord);
  *p.cord = (thr_cord){
      .id = "A", .closed = true, .n_passes = 2 * (N - 1), .half = calloc(2 * (N - 1), sizeof(int))};
  for (int e = 0; e < N - 1; e++) {
    p.cord->half[e] = 2 * e;
    p.cord->half[2 * (N - 1) - 1 - e] = 2 * e + 1;
  }
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 1, &p.metrics, NULL), THR_OK);
  p.proof = (thr_length_proof){.present = true,
                               .optimal = true,
                               .lower_bound = p.metrics.length,
                               .n_certificates = 1,
                               .certificate = calloc(1, sizeof(thr_certificate))};
  thr_certificate *c = p.proof.certificate;
  *c = (thr_certificate){.scale = 1,
                         .denominator = 1,
                         .join = N - 1,
                         .sum = N - 1,
                         .n_cuts = N - 1,
                         .cut = calloc(N - 1, sizeof(thr_cut))};
  for (int i = 0; i < N - 1; i++) {
    c->cut[i] = (thr_cut){i + 1 < N - 1 ? i + 1 : -1, 1, calloc(1, sizeof(int)), 1};
    c->cut[i].node[0] = i;
  }
  assert_plan_sound(&p);
  thr_text t = plan_text(&p);
  ck_assert_uint_lt(t.length, 200 * N);
  c->cut[N / 2].value++, c->sum++;
  assert_violated(&p, "edge 10000"); /* the one that this set leaves */
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(weight_is_rounded_length)
{
  thr_frame f = path_make(3);
  f.length[0] = 1.26;
  thr_certificate c = {.scale = 10};
  ck_assert_int_eq(thr_certificate_weight(&f, &c, 0), 13);
  ck_assert_int_eq(thr_certificate_weight(&f, &c, 1), 10);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("checker");
  ADD_TEST(s, 10, longer_plan_keeps_its_bound_and_loses_optimal);
  ADD_TEST(s, 10, scale_that_rounds_all_away_proves_nothing);
  ADD_TEST(s, 10, passes_without_weight_prove_nothing);
  ADD_TEST(s, 10, an_optimal_plan_is_its_own_bound);
  ADD_TEST(s, 10, angles_do_not_depend_on_size);
  ADD_TEST(s, 10, no_extra_pass_needs_no_proof);
  ADD_TEST(s, 10, forged_cords);
  ADD_TEST(s, 10, forged_ends);
  ADD_TEST(s, 10, forged_cover);
  ADD_TEST(s, 10, forged_counts);
  ADD_TEST(s, 10, forged_cuts);
  ADD_TEST(s, 10, cuts_of_another_component);
  ADD_TEST(s, 10, forged_trees);
  ADD_TEST(s, 10, nodes_twice_in_a_tree);
  ADD_TEST(s, 10, forged_end_price);
  ADD_TEST(s, 10, forged_numbers);
  ADD_TEST(s, 10, each_metric_counts);
  ADD_TEST(s, 10, cords_without_a_proof);
  ADD_TEST(s, 10, the_turn_where_a_cord_closes);
  ADD_TEST(s, 10, passes_without_cords);
  ADD_TEST(s, 60, many_nested_sets);
  ADD_TEST(s, 10, weight_is_rounded_length);
  return run_suite(s);
}
