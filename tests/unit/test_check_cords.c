/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Claims about several cords in the checker: how short the longest can be, how few there can be,
 * how they are counted. */
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- several cords ---- */

/* Shortest distances by Floyd and Warshall, and the longest of: what edge must be gone over from
 * end to end or round; the cord that all need, shared out; in whole units, if lengths have one. */
static double longest_by_definition(const thr_frame *f, const thr_request *o, double base, int most,
                                    double unit)
{
  double far[22][22], bound = base / most;
  for (int a = 0; a < f->n_nodes; a++)
    for (int b = 0; b < f->n_nodes; b++)
      far[a][b] = a == b ? 0 : INFINITY;
  for (int e = 0; e < f->n_edges; e++)
    far[f->edge[e][0]][f->edge[e][1]] = far[f->edge[e][1]][f->edge[e][0]] = f->length[e];
  for (int k = 0; k < f->n_nodes; k++)
    for (int a = 0; a < f->n_nodes; a++)
      for (int b = 0; b < f->n_nodes; b++)
        far[a][b] = fmin(far[a][b], far[a][k] + far[k][b]);
  for (int e = 0; e < f->n_edges; e++) {
    int a = f->edge[e][0], b = f->edge[e][1];
    double to[2] = {INFINITY, INFINITY};
    for (int v = 0; v < f->n_nodes; v++)
      if (o->ends == THR_ENDS_ANY || (o->ends == THR_ENDS_FEET && f->foot[v])) {
        to[0] = fmin(to[0], far[v][a]);
        to[1] = fmin(to[1], far[v][b]);
      }
    bound = fmax(bound, f->length[e] + (o->ends == THR_ENDS_CLOSED ? far[a][b] : to[0] + to[1]));
  }
  return unit > 0 ? unit * ceil(bound / unit - 1e-6) : bound;
}

START_TEST(the_longest_cord_has_its_detour)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  static const length_kind kinds[] = {LENGTHS_RANDOM, LENGTHS_SMALL_INTEGERS, LENGTHS_EUCLID};
  rng r = rng_make((uint64_t)_i + 1);
  length_kind kind = kinds[_i % 3];
  thr_frame f = random_frame(&r, rng_between(&r, 20, 22), rng_below(&r, 9),
                             kind); /* more edges than all sets are tried of */
  thr_request o = options_for(ends[_i / 3 % 3], 1 + rng_below(&r, 2));
  o.cords = 1 + rng_below(&r, 6);
  o.cords_least = 1 + rng_below(&r, o.cords);
  thr_plan p;
  thr_cords_claim found;
  thr_err err = {0};
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
  if (st == THR_OK || st == THR_ELIMIT) {
    assert_ok(thr_check_cords(&f, &o, p.cord, p.n_cords, NULL, 0, NULL, &found, &err), &err);
    double longest = 0, base = 0;
    for (int i = 0; i < p.n_cords; i++)
      longest = fmax(longest, thr_cord_length(&f, &p.cord[i]));
    for (int e = 0; e < f.n_edges; e++)
      base += o.cover * f.length[e];
    double bound = longest_by_definition(&f, &o, base, o.cords,
                                         kind == LENGTHS_SMALL_INTEGERS ? thr_plan_unit(&f) : 0);
    ck_assert_double_eq_tol(found.longest, longest, 1e-9);
    ck_assert_double_eq_tol(found.longest_bound, fmin(longest, bound), 1e-9);
    ck_assert_int_eq(found.longest_optimal, bound > longest - 1e-9 * longest);
    ck_assert_int_eq(found.fewest, 0);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Every edge there and back by a cord of its own, on complete graphs where the way round is often
 * shorter than an edge. */
START_TEST(the_longest_closed_cord_has_its_detour)
{
  rng r = rng_make((uint64_t)_i + 1);
  const int n = 5 + _i % 12;
  double xyz[16][3], length[120], base = 0, longest = 0;
  int edge[120][2], m = 0, n_cords = 0;
  for (int v = 0; v < n; v++)
    for (int i = 0; i < 3; i++)
      xyz[v][i] = rng_unit(&r);
  for (int a = 0; a < n; a++)
    for (int b = 0; b < a; b++) {
      length[m] = exp(2.5 * rng_unit(&r));
      base += length[m];
      longest = fmax(longest, 2 * length[m]);
      edge[m][0] = a, edge[m++][1] = b;
    }
  thr_frame f = frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, length, NULL);
  thr_cord *cord = calloc((size_t)m, sizeof *cord);
  for (int e = 0; e < m; e++)
    add_loops(cord, &n_cords, e, 1);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = o.cords_least = m;
  thr_cords_claim found;
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, m, NULL, 0, NULL, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest, longest, 1e-12);
  ck_assert_double_eq_tol(found.longest_bound,
                          fmin(longest, longest_by_definition(&f, &o, base, m, 0)), 1e-9);
  thr_cords_destroy(cord, m);
  thr_frame_destroy(&f);
}
END_TEST

/* Three cords there and back share a chain of 1, 1 and 5: that over the last edge has 10, whatever
 * comes before it. */
START_TEST(the_worst_edge_may_be_the_last)
{
  static const double length[3] = {1, 1, 5};
  thr_frame f = chain_make(3, length);
  thr_cord *cord = calloc(3, sizeof *cord);
  int n = 0;
  for (int e = 0; e < 3; e++)
    add_loops(cord, &n, e, 1);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = o.cords_least = 3;
  thr_cords_claim found;
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, 3, NULL, 0, NULL, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest_bound, 10, 1e-12);
  thr_cords_destroy(cord, 3);
  thr_frame_destroy(&f);
}
END_TEST

/* A bound of 5 and a little more is 6 where all lengths are whole, unless the little is rounding: a
 * verdict about one cord there and back on a chain 1, 2. */
START_TEST(bounds_are_whole_numbers_of_the_unit)
{
  static const double length[2] = {1, 2};
  static const struct {
    double bound, whole;
  } cases[] = {{5, 5}, {5 + 5e-10, 5}, {5 + 5e-6, 6}, {4.5, 5}};
  thr_frame f = chain_make(2, length);
  int half[4] = {0, 2, 3, 1}, component[3] = {0}, passes[2] = {2, 2}, cords[1] = {1};
  const thr_cord cord = {.id = "A", .closed = true, .n_passes = 4, .half = half};
  const thr_check_walked w = {1, component, passes, cords};
  const thr_certificate c = {.scale = 1, .denominator = 1};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_request o = options_for(THR_ENDS_CLOSED, 1);
    const thr_check_verdict verdict = {.extra = cases[i].bound - 3};
    thr_cords_claim found;
    ck_assert_int_eq(
        thr_check_several(&f, &o, &w, &cord, 1, &c, &verdict, NULL, NULL, &found, NULL), THR_OK);
    ck_assert_double_eq_tol(found.longest_bound, cases[i].whole, 1e-12);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Lengths have a common step, or none. */
START_TEST(cords_have_whole_numbers_of_the_unit)
{
  static const double whole[] = {6, 10, 15}, half[] = {1.5, 2.5, 4},
                      none[] = {1, 1.4142135623730951, 2};
  const struct {
    const double *length;
    double unit;
  } cases[] = {{whole, 1}, {half, 0.5}, {none, 0}};
  for (int i = 0; i < 3; i++) {
    thr_frame f = chain_make(3, cases[i].length);
    ck_assert_double_eq_tol(thr_plan_unit(&f), cases[i].unit, 1e-9);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Two cords there and back on a chain 1, 2: no fewer are allowed where they may have so much; the
 * framework needs 6 in all. */
START_TEST(the_fewest_cords_have_room)
{
  static const double length[2] = {1, 2};
  static const struct {
    double most;
    int fewest;
  } cases[] = {{6, 1}, {6 - 1e-6, 2}, {5, 2}, {4, 2}, {4 - 2e-9, 2}};
  thr_frame f = chain_make(2, length);
  thr_cord *cord = calloc(2, sizeof *cord);
  int n = 0;
  bool optimal;
  double bound;
  add_loops(cord, &n, 0, 1);
  add_loops(cord, &n, 1, 1);
  thr_cut cut[2] = {{-1, 1, (int[]){0}, 2}, {-1, 1, (int[]){2}, 4}};
  thr_certificate c = {.scale = 2, .denominator = 1, .join = 6, .sum = 6, .n_cuts = 2, .cut = cut};
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = 2;
  o.cords_least = 1;
  ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, 2, &c, 1, NULL, &optimal, &bound, NULL),
                   THR_OK);
  ck_assert(optimal);
  ck_assert_double_eq(bound, 6);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_cords_claim found;
    thr_err err = {0};
    o.max_length = cases[i].most;
    assert_ok(thr_check_cords(&f, &o, cord, 2, &c, 1, NULL, &found, &err), &err);
    ck_assert_int_eq(found.fewest, cases[i].fewest);
    ck_assert_int_eq(found.fewest_optimal, cases[i].fewest == 2);
  }
  thr_cords_claim found;
  o.max_length = 100;
  o.cords = 3, o.cords_least = 2; /* no fewer are asked for */
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, &c, 1, NULL, &found, NULL), THR_OK);
  ck_assert_int_eq(found.fewest, 2);
  o.cords = 2, o.cords_least = 1;
  o.max_length = 4 - 1e-8; /* the cord over edge 1 is longer */
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, &c, 1, NULL, &found, NULL), THR_EVIOLATED);
  thr_cords_destroy(cord, 2);
  thr_frame_destroy(&f);
}
END_TEST

/* Four cords through a cube's twelve edges, three each: eight ends leave no edge to be passed
 * twice, fewer would. */
START_TEST(ends_pay_for_extra_passes)
{
  thr_frame f = solid_make(CUBE);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.cords = o.cords_least = 4;
  thr_plan p = plan_of_cords(&f, &o);
  thr_cords_claim found;
  thr_err err = {0};
  ck_assert_double_eq_tol(p.metrics.length, 12, 1e-9);
  assert_ok(thr_check_cords(&f, &o, p.cord, 4, p.proof.certificate, 1, NULL, &found, &err), &err);
  ck_assert_double_eq_tol(found.longest_bound, 3, 1e-9);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* All nodes of a tetrahedron are odd, and one end at each leaves no edge to be passed twice: two
 * cords share six edges. */
START_TEST(given_ends_are_those_of_half_as_many_cords)
{
  int end_count[4] = {1, 1, 1, 1}, half[2][3];
  thr_frame f = solid_make(TETRAHEDRON);
  static const int walk[2][4] = {{0, 1, 2, 3}, {1, 3, 0, 2}};
  thr_cord cord[2];
  thr_request o = options_for(THR_ENDS_COUNTS, 1);
  o.end_count = end_count;
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 3; k++) {
      int e = thr_frame_edge_between(&f, walk[i][k], walk[i][k + 1]);
      half[i][k] = 2 * e + (f.edge[e][1] == walk[i][k]);
    }
    cord[i] = (thr_cord){.n_passes = 3, .half = half[i]};
    thr_cord_id(i, cord[i].id);
  }
  o.cords = o.cords_least = 2;
  thr_cords_claim found;
  thr_err err = {0};
  assert_ok(thr_check_cords(&f, &o, cord, 2, NULL, 0, NULL, &found, &err), &err);
  ck_assert_double_eq_tol(found.longest_bound, 3 * f.length[0], 1e-9);
  ck_assert(found.longest_optimal);
  thr_frame_destroy(&f);
}
END_TEST

/* The number of cords is one of the options only where something is claimed about it, or by it. */
START_TEST(cords_are_counted_for_claims)
{
  static const double length[2] = {1, 2};
  static const char *const aims[] = {"length", "turning"};
  thr_frame f = chain_make(2, length);
  for (int k = 0; k < 2; k++) {
    thr_plan p = {0};
    thr_request o = options_for(THR_ENDS_CLOSED, 1);
    want(&o, aims[k]);
    ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
    p.cord = calloc(2, sizeof *p.cord);
    add_loops(p.cord, &p.n_cords, 0, 1);
    add_loops(p.cord, &p.n_cords, 1, 1);
    ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 2, &p.metrics, NULL), THR_OK);
    thr_err err = {0};
    ck_assert_msg(thr_check_plan(&p, &err) == (k ? THR_EVIOLATED : THR_OK), "%s", err.text);
    if (k) assert_one_line(&err, "has 2 cords");
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Two edges, together as long as rounding lets a cord of 1 be, which then is enough; and longer by
 * as little as can be. */
START_TEST(a_cord_may_be_as_long_as_rounding_lets_it)
{
  const double most = 1 + 2e-9;
  for (int more = 0; more < 2; more++) {
    double length[2] = {most / 2, most / 2};
    thr_frame f = chain_make(2, length);
    int half[2] = {0, 2};
    thr_cord cord[2] = {{.id = "A", .n_passes = 1, .half = half},
                        {.id = "B", .n_passes = 1, .half = half + 1}};
    thr_request o = options_for(THR_ENDS_ANY, 1);
    thr_cords_claim found;
    o.cords = 2, o.cords_least = 1;
    o.max_length = 1;
    f.length[0] = most / 2;
    f.length[1] = more ? nextafter(most / 2, 1) : most / 2;
    ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, NULL, 0, NULL, &found, NULL), THR_OK);
    ck_assert_int_eq(found.fewest, 1 + more);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Cords that end anywhere on a star with six legs of 1: K of them leave 6 - 2 K tips that are no
 * ends, each of which costs an extra pass. As multipliers: 1 for every tip, 1 for every end. */
START_TEST(fewer_cords_have_fewer_ends)
{
  static const struct {
    double most;
    int fewest;
  } cases[] = {{10, 1}, {9.9, 2}, {4, 2}, {3.9, 3}, {2, 3}};
  thr_frame f = star_make(6);
  thr_cord cord[3];
  int half[3][2] = {{1, 2}, {5, 6}, {9, 10}};
  thr_cut cut[6];
  int tip[6];
  for (int i = 0; i < 6; i++) {
    tip[i] = f.edge[i][f.edge[i][0] == 0];
    cut[i] = (thr_cut){-1, 1, &tip[i], 1};
  }
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 2; k++)
      half[i][k] = 2 * (2 * i + k) + ((f.edge[2 * i + k][0] == 0) == (k == 0));
    cord[i] = (thr_cord){.n_passes = 2, .half = half[i]};
    thr_cord_id(i, cord[i].id);
  }
  const thr_certificate c = {
      .scale = 1, .denominator = 1, .sum = 6, .end_price = 1, .n_cuts = 6, .cut = cut};
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.cords = 3, o.cords_least = 1;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_cords_claim found;
    thr_err err = {0};
    o.max_length = cases[i].most;
    assert_ok(thr_check_cords(&f, &o, cord, 3, &c, 1, NULL, &found, &err), &err);
    ck_assert_int_eq(found.fewest, cases[i].fewest);
    ck_assert_double_eq_tol(found.longest_bound, 2, 1e-9);
    ck_assert(found.longest_optimal);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A chain 1, 1 there and back, and a proof that one of its edges is passed twice: 3 of 4. */
START_TEST(weak_proofs_bound_the_longest)
{
  static const double length[2] = {1, 1};
  thr_frame f = chain_make(2, length);
  int half[4] = {0, 2, 3, 1};
  const thr_cord cord = {.id = "A", .closed = true, .n_passes = 4, .half = half};
  thr_cut cut = {-1, 1, (int[]){0}, 1};
  const thr_certificate c = {
      .scale = 1, .denominator = 1, .join = 2, .sum = 1, .n_cuts = 1, .cut = &cut};
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_cords_claim found;
  ck_assert_int_eq(thr_check_cords(&f, &o, &cord, 1, &c, 1, NULL, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest, 4, 1e-12);
  ck_assert_double_eq_tol(found.longest_bound, 3, 1e-9);
  ck_assert(!found.longest_optimal);
  thr_frame_destroy(&f);
}
END_TEST

/* No proof that holds proves more than a plan has. Of verdicts that are said to, and of more cord
 * than the options allow, the checker tells: one cord there and back on a chain, which needs half
 * of it. */
START_TEST(bounds_beyond_the_plan_are_refused)
{
  static const double length[2] = {1, 1.4142135623730951}, all = 2.4142135623730951;
  static const struct {
    double part, most;
    const char *said;
  } cases[] = {
      {2 + 0.9e-9, 0, NULL},
      {2 + 2.2e-9, 0, "the longest cord of any plan would have"},
      {3, 0,
       "the longest cord of any plan would have 7.24264068712 or more, but this plan's has "
       "4.82842712475"},
      {1, 2, "any plan would have 3 cords or more, but this one has 1"}, /* there and back over one
                                                                            edge is more */
      {1, 5, NULL}};
  thr_frame f = chain_make(2, length);
  int half[4] = {0, 2, 3, 1}, component[3] = {0}, passes[2] = {2, 2}, cords[1] = {1};
  const thr_cord cord = {.id = "A", .closed = true, .n_passes = 4, .half = half};
  const thr_check_walked w = {1, component, passes, cords};
  const thr_certificate c = {.scale = 1, .denominator = 1};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_request o = options_for(THR_ENDS_CLOSED, 1);
    const thr_check_verdict verdict = {.extra = (cases[i].part - 1) * all};
    thr_cords_claim found;
    thr_err err = {0};
    o.max_length = cases[i].most;
    o.cords = cases[i].most > 0 ? 3 : 1, o.cords_least = 1;
    thr_status st = thr_check_several(&f, &o, &w, &cord, 1, &c, &verdict, NULL, NULL, &found, &err);
    ck_assert_msg(st == (cases[i].said ? THR_EVIOLATED : THR_OK), "case %zu: %s", i, err.text);
    if (st) assert_one_line(&err, cases[i].said);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Makes three cords round two triangles, the third one round that of number twice. */
static void go_round(const thr_frame *f, int twice, int half[3][3], thr_cord cord[3])
{
  for (int i = 0; i < 3; i++) {
    const int component = i < 2 ? i : twice;
    for (int k = 0; k < 3; k++)
      half[i][k] = 6 * component + 2 * k;
    for (int k = 0; k < 3; k++) /* each edge the way round */
      if (thr_head(f, half[i][k]) != thr_tail(f, half[i][(k + 1) % 3])) half[i][k] ^= 1;
    cord[i] = (thr_cord){.closed = true, .component = component, .n_passes = 3, .half = half[i]};
    thr_cord_id(i, cord[i].id);
  }
}

/* Of a symmetric plan the component with most cords has as many as asked for, whichever it is. */
START_TEST(symmetric_cords_are_counted_where_most_are)
{
  thr_frame f = triangles_make(2);
  for (int most = 0; most < 2; most++) {
    int half[3][3];
    thr_cord cord[3];
    go_round(&f, most, half, cord);
    thr_certificate c[2] = {{.scale = 1, .denominator = 1},
                            {.component = 1, .scale = 1, .denominator = 1}};
    c[most].join = 3;
    for (int cords = 1; cords <= 3; cords++) {
      thr_request o = options_for(THR_ENDS_CLOSED, 1);
      bool optimal;
      double bound;
      thr_err err = {0};
      want(&o, "overlap,steps");
      o.cords = o.cords_least = cords;
      thr_status st = thr_check_length_proof(&f, &o, cord, 3, c, 2, NULL, &optimal, &bound, &err);
      ck_assert_msg(st == (cords == 2 ? THR_OK : THR_EVIOLATED), "%s", err.text);
      char said[64];
      snprintf(said, sizeof said, "component %d: has 2 cords; the plan's options say %d", most,
               cords);
      if (st) assert_one_line(&err, said);
      ck_assert(!st || !strstr(err.text, " to "));
    }
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Two triangles: in each of them there are as many cords as asked for. */
START_TEST(cords_are_counted_in_every_component)
{
  thr_frame f = triangles_make(2);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  for (int twice = -1; twice < 2; twice++) {
    int half[3][3];
    thr_cord cord[3];
    go_round(&f, twice < 0 ? 0 : twice, half, cord);
    thr_cords_claim found;
    thr_err err = {0};
    thr_status st = thr_check_cords(&f, &o, cord, twice < 0 ? 2 : 3, NULL, 0, NULL, &found, &err);
    ck_assert_msg(st == (twice < 0 ? THR_OK : THR_EVIOLATED), "%s", err.text);
    char said[64];
    snprintf(said, sizeof said, "component %d: has 2 cords; the plan's options say 1", twice);
    if (st) assert_one_line(&err, said);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("several cords in the checker");
  ADD_EXAMPLES(s, 20, the_longest_cord_has_its_detour, 90);
  ADD_EXAMPLES(s, 20, the_longest_closed_cord_has_its_detour, 200);
  ADD_TEST(s, 10, the_worst_edge_may_be_the_last);
  ADD_TEST(s, 10, bounds_are_whole_numbers_of_the_unit);
  ADD_TEST(s, 10, cords_have_whole_numbers_of_the_unit);
  ADD_TEST(s, 10, the_fewest_cords_have_room);
  ADD_TEST(s, 10, ends_pay_for_extra_passes);
  ADD_TEST(s, 10, given_ends_are_those_of_half_as_many_cords);
  ADD_TEST(s, 10, cords_are_counted_for_claims);
  ADD_TEST(s, 10, a_cord_may_be_as_long_as_rounding_lets_it);
  ADD_TEST(s, 10, fewer_cords_have_fewer_ends);
  ADD_TEST(s, 10, weak_proofs_bound_the_longest);
  ADD_TEST(s, 10, bounds_beyond_the_plan_are_refused);
  ADD_TEST(s, 10, symmetric_cords_are_counted_where_most_are);
  ADD_TEST(s, 10, cords_are_counted_in_every_component);
  return run_suite(s);
}
