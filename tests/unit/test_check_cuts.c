/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Certificates of length in the checker: prices and cuts added up another way, and certificates
 * that are none. */
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- prices ---- */

/* Price of the places that n passes of an edge are: one for each pass; closed, two for each pair,
 * and of the other passes as many as make a loop for every two places, rounded up. */
static int64_t places_price(bool closed, int64_t of, int loop, int n)
{
  if (!closed) return of * n;
  int64_t left = n % 2 ? 2 * of : 0;
  return 2 * of * (n / 2) + left / loop + (left % loop > 0);
}

/* Against every number of extra passes that there is room for, or the first few if there is no end.
 */
START_TEST(edges_at_their_price)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = path_make(2);
  for (int k = 0; k < 200; k++) {
    bool closed = rng_below(&r, 2), limited = rng_below(&r, 3) > 0;
    thr_request o = options_for(closed ? THR_ENDS_CLOSED : THR_ENDS_FEET, 1 + rng_below(&r, 4));
    int room = rng_below(&r, 6), loop = rng_between(&r, 2, 10);
    int64_t weight = rng_below(&r, 20), of = rng_below(&r, 5) ? rng_below(&r, 30) : weight,
            best[2] = {INT64_MAX, INT64_MAX};
    if (limited) o.capacity = o.cover + room;
    thr_priced p = thr_prices_edge(&f, &o, 0, weight, of, loop);
    int64_t held = places_price(closed, of, loop, o.cover);
    ck_assert_int_eq((int64_t)p.held, held);
    ck_assert_int_eq(p.room, !limited || room > 0);
    ck_assert_int_eq(p.endless, !limited && of > weight);
    if (p.endless || !p.room) continue;
    for (int n = 0; n <= (limited ? room : 9); n++) {
      int64_t cost = weight * n - places_price(closed, of, loop, o.cover + n) + held;
      if (cost < best[n % 2]) best[n % 2] = cost;
    }
    for (int i = 0; i < 2; i++) {
      ck_assert_int_eq((int64_t)(i ? p.odd : p.even), best[i]);
      ck_assert_int_eq(p.passes[i] % 2, i);
      ck_assert_int_le(p.passes[i], limited ? room : 9);
      ck_assert_int_eq(weight * p.passes[i] -
                           places_price(closed, of, loop, o.cover + p.passes[i]) + held,
                       best[i]);
    }
  }
  thr_request o = options_for(THR_ENDS_COUNTS, 1);
  ck_assert_int_eq(thr_prices_number(&o, 7), 7);
  want(&o, "overlap,steps");
  ck_assert_int_eq(thr_prices_number(&o, 7), 0);
  o = options_for(THR_ENDS_FEET, 1);
  ck_assert_int_eq(thr_prices_number(&o, 7), 1);
  thr_frame_destroy(&f);
}
END_TEST

/* Nested odd sets of nodes of a complete graph, all of whose nodes are odd. The sum of the
 * multipliers of the sets that hold one end of an edge, added up set by set, may be as much as its
 * weight, and no more. */
START_TEST(cuts_add_up_over_edges)
{
  enum { N = 8, EDGES = N * (N - 1) / 2 };
  rng r = rng_make((uint64_t)_i + 1);
  double xyz[N][3], length[EDGES];
  int edge[EDGES][2], passes[EDGES], own[N][N], m = 0, n_cuts = 0;
  bool inside[N][N] = {{false}}, used[N] = {false};
  thr_cut cut[N];
  thr_certificate c = {.scale = 1, .denominator = 1, .cut = cut};
  while (n_cuts < N) { /* the next set: nodes that are in none yet, and sets that are in none yet */
    int size = 0, k = 0, child[N], n_children = 0;
    memset(inside[n_cuts], 0, sizeof inside[n_cuts]);
    for (int v = 0; v < N; v++)
      if (!used[v] && rng_below(&r, 3) == 0) inside[n_cuts][v] = true, own[n_cuts][k++] = v, size++;
    for (int i = 0; i < n_cuts; i++)
      if (cut[i].parent < 0 && rng_below(&r, 2)) {
        child[n_children++] = i;
        for (int v = 0; v < N; v++)
          if (inside[i][v]) inside[n_cuts][v] = true, size++;
      }
    if (size % 2 == 0) {
      if (rng_below(&r, 30) == 0) break;
      continue;
    }
    for (int j = 0; j < k; j++)
      used[own[n_cuts][j]] = true;
    for (int j = 0; j < n_children; j++)
      cut[child[j]].parent = n_cuts;
    cut[n_cuts] = (thr_cut){-1, k, own[n_cuts], rng_below(&r, 4)};
    c.sum += cut[n_cuts++].value;
  }
  c.n_cuts = n_cuts;
  for (int v = 0; v < N; v++)
    for (int i = 0; i < 3; i++)
      xyz[v][i] = rng_unit(&r);
  for (int a = 0; a < N; a++)
    for (int b = 0; b < a; b++, m++) {
      int load = 0;
      for (int i = 0; i < n_cuts; i++)
        load += inside[i][a] != inside[i][b] ? (int)cut[i].value : 0;
      length[m] = load > 0 ? load : 1;
      edge[m][0] = a, edge[m][1] = b;
      passes[m] = 2;
    }
  thr_frame f = frame_make(N, (const double(*)[3])xyz, m, (const int(*)[2])edge, length, NULL);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  for (int less = -1; less < m; less++) {
    thr_err err = {0};
    bool optimal;
    double bound;
    if (less >= 0 && length[less] < 2) continue;
    if (less >= 0) f.length[less]--;
    c.join = 0;
    for (int e = 0; e < m; e++)
      c.join += (int64_t)f.length[e];
    thr_status st = thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err);
    ck_assert_msg(st == (less < 0 ? THR_OK : THR_EVIOLATED), "%s", err.text);
    if (less >= 0) {
      char said[48];
      snprintf(said, sizeof said, "the cuts over edge %d add up", less);
      assert_one_line(&err, said);
      f.length[less]++;
    }
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Where a place costs 13 and a pass 10, as many passes of edge 0 as fit are cheapest: two more or
 * three. One less costs 3 more, and so much may cuts over the edge add up to: round node 0, if two
 * more leave it odd; round node 1, if three make it odd. */
START_TEST(cuts_add_up_at_prices)
{
  static const double length[2] = {1, 1};
  for (int room = 2; room <= 3; room++)
    for (int64_t value = 2; value <= 4; value++) {
      thr_frame f = chain_make(room - 1, length);
      int node = 1, passes[2] = {2, 2};
      int64_t price = 13;
      thr_cut cut = {-1, 1, &node, value};
      thr_certificate c = {.scale = 10, .denominator = 1, .sum = value, .n_cuts = 1, .cut = &cut};
      thr_request o = options_for(THR_ENDS_FEET, 1);
      bool optimal;
      double bound;
      thr_err err = {0};
      f.foot[0] = true;
      o.capacity = 1 + room;
      c.join = 10 * (room - 1), c.n_prices = 1, c.place_price = &price;
      thr_status st = thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err);
      assert_status(st, value > 3 ? THR_EVIOLATED : THR_OK, &err, "the cuts over edge 0 add up");
      /* 2 places, what the passes of edge 0 cost less their places, and the cut */
      double extra = (2 * 13 + (room * (10 - 13) - 13) + (double)value) / 10;
      if (!st) ck_assert_double_eq_tol(bound, room - 1 + extra, 1e-12);
      if (!st) ck_assert_int_eq(optimal, room == 2 && value == 3);
      thr_frame_destroy(&f);
    }
}
END_TEST

/* The nodes of a cut ascend, from the first two on. */
START_TEST(nodes_of_cuts_ascend)
{
  static const double length[2] = {1, 1};
  static const struct {
    int n, node[3];
    const char *said;
  } cases[] = {{1, {0}, NULL},
               {2, {0, 1}, NULL},
               {2, {1, 0}, "ascending at 0"},
               {3, {0, 1, 1}, "ascending at 1"},
               {3, {0, 2, 1}, "ascending at 1"}};
  thr_frame f = chain_make(2, length);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    int node[3], passes[2] = {2, 2};
    memcpy(node, cases[i].node, sizeof node);
    thr_cut cut = {-1, cases[i].n, node, 0};
    const thr_certificate c = {.scale = 1, .denominator = 1, .join = 2, .n_cuts = 1, .cut = &cut};
    bool optimal;
    double bound;
    thr_err err = {0};
    assert_status(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err),
                  cases[i].said ? THR_EVIOLATED : THR_OK, &err, cases[i].said);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Three edges by themselves: in none of them may a cut round an end have more than the price of an
 * end. */
START_TEST(end_prices_hold_in_every_component)
{
  double xyz[6][3] = {{0}};
  static const int edge[3][2] = {{0, 1}, {2, 3}, {4, 5}}, passes[3] = {1, 1, 1};
  for (int v = 0; v < 6; v++)
    xyz[v][0] = v % 2, xyz[v][1] = v / 2;
  thr_frame f = frame_make(6, (const double(*)[3])xyz, 3, edge, NULL, NULL);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  for (int dear = -1; dear < 6; dear++) {
    thr_cut cut[3];
    thr_certificate c[3];
    int node[3];
    bool optimal;
    double bound;
    thr_err err = {0};
    for (int i = 0; i < 3; i++) {
      bool here = dear >= 0 && dear / 2 == i;
      node[i] = here ? dear : 2 * i;
      cut[i] = (thr_cut){-1, 1, &node[i], here ? 2 : 1};
      c[i] = (thr_certificate){.component = i,
                               .scale = 10,
                               .denominator = 1,
                               .sum = cut[i].value,
                               .end_price = 1,
                               .n_cuts = 1,
                               .cut = &cut[i]};
    }
    thr_status st = thr_check_length_of_passes(&f, &o, passes, c, 3, &optimal, &bound, &err);
    ck_assert_msg(st == (dear < 0 ? THR_OK : THR_EVIOLATED), "%s", err.text);
    char said[64];
    snprintf(said, sizeof said, "the cuts round node %d add up", dear);
    if (st) assert_one_line(&err, said);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Two cords there and back over one edge. At a price of 0.8 of the weight for each of their places
 * a second pass of the edge pays, so that both of its nodes are even; at none, they are odd, and
 * either may be cut off. */
START_TEST(prices_change_the_parity_of_both_nodes)
{
  static const double length[1] = {1};
  thr_frame f = chain_make(1, length);
  thr_cord *cord = calloc(2, sizeof *cord);
  int n = 0;
  add_loops(cord, &n, 0, 2);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = o.cords_least = 2;
  for (int v = 0; v < 2; v++)
    for (int64_t price = 0; price <= 8; price += 8) {
      thr_cut cut = {-1, 1, &v, 1};
      thr_certificate c = {
          .scale = 10, .denominator = 1, .join = 30, .sum = 1, .n_cuts = 1, .cut = &cut};
      c.n_prices = 1, c.place_price = &price;
      bool optimal;
      double bound;
      thr_err err = {0};
      thr_status st = thr_check_length_proof(&f, &o, cord, 2, &c, 1, NULL, &optimal, &bound, &err);
      ck_assert_msg(st == (price ? THR_EVIOLATED : THR_OK), "%s", err.text);
      if (price) assert_one_line(&err, "even number of odd nodes");
    }
  thr_cords_destroy(cord, 2);
  thr_frame_destroy(&f);
}
END_TEST

/* Passes that one closed cord can run through are no two cords', whose places are worth more than
 * these passes weigh. */
START_TEST(bounds_above_the_passes_are_refused)
{
  static const double length[1] = {1};
  static const int passes[1] = {2};
  thr_frame f = chain_make(1, length);
  for (int cords = 1; cords <= 2; cords++) {
    thr_request o = options_for(THR_ENDS_CLOSED, 1);
    int64_t price = 1;
    const thr_certificate c = {
        .scale = 1, .denominator = 1, .join = 1, .n_prices = 1, .place_price = &price};
    bool optimal;
    double bound;
    thr_err err = {0};
    o.cords = o.cords_least = cords;
    assert_status(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err),
                  cords > 1 ? THR_EVIOLATED : THR_OK, &err,
                  "its bound is above the weight of the plan's own extra passes");
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Three edges by themselves, there and back: each certificate weighs what its own component has. */
START_TEST(certificates_weigh_their_own_component)
{
  static const double xyz[6][3] = {{0, 0, 0}, {1, 0, 0},  {0, 9, 0},
                                   {2, 9, 0}, {0, 18, 0}, {4, 18, 0}};
  static const int edge[3][2] = {{0, 1}, {2, 3}, {4, 5}}, passes[3] = {2, 2, 2};
  thr_frame f = frame_make(6, xyz, 3, edge, NULL, NULL);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  for (int wrong = -1; wrong < 3; wrong++) {
    int node[3] = {0, 2, 4};
    thr_cut cut[3];
    thr_certificate c[3];
    bool optimal;
    double bound;
    thr_err err = {0};
    for (int i = 0; i < 3; i++) {
      cut[i] = (thr_cut){-1, 1, &node[i], 1 << i};
      c[i] = (thr_certificate){.component = i,
                               .scale = 1,
                               .denominator = 1,
                               .join = (1 << i) + (i == wrong),
                               .sum = 1 << i,
                               .n_cuts = 1,
                               .cut = &cut[i]};
    }
    thr_status st = thr_check_length_of_passes(&f, &o, passes, c, 3, &optimal, &bound, &err);
    assert_status(st, wrong < 0 ? THR_OK : THR_EVIOLATED, &err, "the extra passes do not weigh");
    if (!st) ck_assert(optimal);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Scales and denominators are positive, and weights stay below 1e18. */
START_TEST(certificates_have_a_scale)
{
  static const struct {
    double scale;
    int64_t denominator;
    const char *said;
  } cases[] = {
      {1, 1, NULL},       {0, 1, "positive"},  {-1, 1, "positive"},        {NAN, 1, "positive"},
      {1, 0, "positive"}, {1, -1, "positive"}, {INFINITY, 1, "too large"}, {1e18, 1, "too large"}};
  static const double length[1] = {1};
  thr_frame f = chain_make(1, length);
  thr_cord *cord = calloc(1, sizeof *cord);
  int n = 0;
  add_loops(cord, &n, 0, 1);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    int64_t price = 0;
    thr_certificate c = {.scale = cases[i].scale,
                         .denominator = cases[i].denominator,
                         .join = 1,
                         .place_price = &price};
    for (c.n_prices = 0; c.n_prices < 2; c.n_prices++) {
      bool optimal;
      double bound;
      thr_err err = {0};
      assert_status(thr_check_length_proof(&f, &o, cord, 1, &c, 1, NULL, &optimal, &bound, &err),
                    cases[i].said ? THR_EVIOLATED : THR_OK, &err, cases[i].said);
    }
  }
  thr_cords_destroy(cord, 1);
  thr_frame_destroy(&f);
}
END_TEST

/* A certificate is for solid joints, a tree for tubes: a plan has the one or the other. */
START_TEST(proofs_are_those_of_the_joint)
{
  static const double length[1] = {1};
  thr_frame f = chain_make(1, length);
  thr_plan p = {0};
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  p.cord = calloc(1, sizeof *p.cord);
  add_loops(p.cord, &p.n_cords, 0, 1);
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 1, &p.metrics, NULL), THR_OK);
  thr_cut cut = {-1, 1, (int[]){0}, 1};
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
  p.proof = (thr_length_proof){
      .present = true, .optimal = true, .lower_bound = 2, .n_certificates = 1, .certificate = &c};
  thr_err err = {0};
  assert_ok(thr_check_plan(&p, &err), &err);
  p.proof.tied.n_nodes = 1;
  assert_status(thr_check_plan(&p, &err), THR_EVIOLATED, &err,
                "has a proof, but the plan's joints are solid");
  p.proof = (thr_length_proof){0};
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A ring with an edge so short that it weighs nothing, and a tail, which is passed twice: that is
 * optimal all the same. */
START_TEST(weightless_edges_passed_once_cost_nothing)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0.3, 0}, {-1, 0, 0}},
                      length[4] = {1, 0.3, 1, 1};
  static const int edge[4][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}};
  thr_frame f = frame_make(4, xyz, 4, edge, length, NULL);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_cut cut = {-1, 1, (int[]){3}, 1};
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
  int passes[4] = {1, 1, 1, 2};
  bool optimal;
  double bound;
  thr_err err = {0};
  assert_ok(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err), &err);
  ck_assert(optimal);
  ck_assert_double_eq_tol(bound, 4.3, 1e-12);
  passes[1] = 3; /* more of it than is needed, which no weight shows */
  assert_ok(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err), &err);
  ck_assert(!optimal);
  ck_assert_double_eq_tol(bound, 4.3, 1e-12);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("cuts in the checker");
  ADD_LOOP(s, 10, edges_at_their_price, 0, 10);
  ADD_EXAMPLES(s, 10, cuts_add_up_over_edges, 60);
  ADD_TEST(s, 10, cuts_add_up_at_prices);
  ADD_TEST(s, 10, nodes_of_cuts_ascend);
  ADD_TEST(s, 10, end_prices_hold_in_every_component);
  ADD_TEST(s, 10, prices_change_the_parity_of_both_nodes);
  ADD_TEST(s, 10, bounds_above_the_passes_are_refused);
  ADD_TEST(s, 10, certificates_weigh_their_own_component);
  ADD_TEST(s, 10, certificates_have_a_scale);
  ADD_TEST(s, 10, proofs_are_those_of_the_joint);
  ADD_TEST(s, 10, weightless_edges_passed_once_cost_nothing);
  return run_suite(s);
}
