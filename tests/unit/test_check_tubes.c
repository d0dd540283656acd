/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tube joints in the checker: which nodes are tied, and what proofs of tied length prove. */
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- tube joints ---- */

/* Two triangles that share node 0: neither a cord round each nor one round both ties all four edges
 * there. */
START_TEST(tube_joints_are_tied)
{
  static const double xyz[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  static const int half[6] = {0, 2, 4, 6, 8, 10};
  thr_frame f = frame_make(5, xyz, 6, edge, NULL, NULL);
  thr_plan p = {0};
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = 2;
  o.joint = THR_JOINT_TUBE;
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  p.cord = calloc(2, sizeof *p.cord);
  for (int i = 0; i < 2; i++) {
    p.cord[i] = (thr_cord){.closed = true, .n_passes = 3, .half = calloc(6, sizeof(int))};
    thr_cord_id(i, p.cord[i].id);
    memcpy(p.cord[i].half, half + 3 * i, 3 * sizeof(int));
  }
  p.n_cords = 2;
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 2, &p.metrics, NULL), THR_OK);
  assert_violated(&p, "node 0: the cords do not tie");
  p.n_cords = 1; /* once through all: 2 -> 3 and 4 -> 1 at node 0, which ties 0-2 to 0-3 and 0-4 to
                    0-1, and not these pairs */
  memcpy(p.cord[0].half, half, sizeof half);
  p.cord[0].n_passes = 6;
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 1, &p.metrics, NULL), THR_OK);
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
  p.options.joint = THR_JOINT_SOLID;
  assert_holds(&p);
  p.n_cords = 2;
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* An edge there and back: with closed cords the U-turn where it closes is one of its turns. */
START_TEST(no_cord_of_tube_joints_turns_back_where_it_closes)
{
  thr_frame f = path_make(2);
  thr_plan p = {0};
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.joint = THR_JOINT_TUBE;
  for (int ends = 0; ends < 2; ends++) {
    o.ends = ends ? THR_ENDS_ANY : THR_ENDS_CLOSED;
    ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
    int n = 0;
    p.cord = calloc(1, sizeof *p.cord);
    add_loops(p.cord, &n, 0, 1);
    p.n_cords = 1;
    if (ends) p.cord[0].n_passes = 1, p.cord[0].closed = false;
    ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 1, &p.metrics, NULL), THR_OK);
    thr_err err = {0};
    ck_assert_int_eq(thr_check_plan(&p, &err), ends ? THR_OK : THR_EVIOLATED);
    if (!ends) assert_one_line(&err, "turns back");
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Out and back over one edge, then over the other: the first of its turns goes back. */
START_TEST(no_cord_of_tube_joints_turns_back_first)
{
  static const double length[2] = {1, 2};
  thr_frame f = chain_make(2, length);
  thr_plan p = {0};
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.joint = THR_JOINT_TUBE;
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  int n = 0;
  p.cord = calloc(1, sizeof *p.cord);
  add_loops(p.cord, &n, 0, 1);
  free(p.cord[0].half);
  p.cord[0] = (thr_cord){.id = "A", .n_passes = 3, .half = calloc(3, sizeof(int))};
  memcpy(p.cord[0].half, (int[]){1, 0, 2}, 3 * sizeof(int));
  p.n_cords = 1;
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 1, &p.metrics, NULL), THR_OK);
  assert_violated(&p, "pass 1: turns back at node 0");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Is every edge at the node joined to every other by turns of the cords? By spreading from the
 * first until nothing is new. */
static bool tied_by_turns(const thr_frame *f, const thr_cord *cord, int n_cords, bool closing,
                          int v)
{
  bool reached[64] = {false}, more = true;
  reached[f->half[f->first[v]] / 2] = true;
  while (more) {
    more = false;
    for (int i = 0; i < n_cords; i++)
      for (int k = 0; k < cord[i].n_passes - !(closing && cord[i].closed); k++) {
        int a = cord[i].half[k], b = cord[i].half[(k + 1) % cord[i].n_passes];
        if (thr_head(f, a) != v || reached[a / 2] == reached[b / 2]) continue;
        reached[a / 2] = reached[b / 2] = more = true;
      }
  }
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    if (!reached[f->half[i] / 2]) return false;
  return true;
}

/* Random walks, some of them closed. */
START_TEST(nodes_are_tied_by_turns)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, 6, 6, LENGTHS_EQUAL);
  int half[3][40];
  bool tied[8];
  thr_cord cord[3];
  for (int i = 0; i < 3; i++) {
    cord[i] = (thr_cord){.n_passes = rng_between(&r, 1, 40), .half = half[i]};
    half[i][0] = rng_below(&r, 2 * f.n_edges);
    for (int k = 1; k < cord[i].n_passes; k++) {
      int v = thr_head(&f, half[i][k - 1]);
      half[i][k] = f.half[f.first[v] + rng_below(&r, thr_degree(&f, v))];
    }
    cord[i].closed = thr_cord_start(&f, &cord[i]) == thr_cord_end(&f, &cord[i]);
  }
  for (int closing = 0; closing < 2; closing++) {
    ck_assert_int_eq(thr_junction_tied(&f, cord, 3, closing, tied, NULL), THR_OK);
    for (int v = 0; v < f.n_nodes; v++)
      ck_assert_int_eq(tied[v], tied_by_turns(&f, cord, 3, closing, v));
  }
  thr_frame_destroy(&f);
}
END_TEST

/* What a proof of length with tube joints is about; and with multipliers that prove an extra pass
 * of edge 0. */
START_TEST(proofs_of_tied_length_are_about_the_plan)
{
  static const double length[3] = {2, 3, 1};
  thr_frame f = chain_make(3, length);
  bool allowed[4];
  thr_turning_task t;
  int count[4] = {1, 0, 0, 1};
  f.foot[0] = true;
  for (int k = 0; k < 3; k++) {
    thr_request o = options_for(k == 0   ? THR_ENDS_CLOSED
                                : k == 1 ? THR_ENDS_FEET
                                         : THR_ENDS_COUNTS,
                                2);
    o.cords = 3, o.cords_least = 2, o.capacity = 9;
    if (k == 2) o.end_count = count;
    thr_tied_task(&f, &o, allowed, &t);
    ck_assert_int_eq(t.cover, 2);
    ck_assert_int_eq(t.capacity, 9);
    ck_assert_int_eq(t.cords, k ? 3 : 1);
    ck_assert_int_eq(t.cords_least, k ? 2 : 1);
    ck_assert_int_eq(t.most_passes, 2 * (2 + 2 + 2 * (k ? 3 : 1)) + 1);
    ck_assert(t.tube && t.free_turns && t.extra_limit < 0);
    ck_assert_ptr_eq(t.end_allowed, k ? allowed : NULL);
    ck_assert_ptr_eq(t.end_count, k == 2 ? count : NULL);
    ck_assert_double_eq_tol(t.price_per_length, 0.5, 1e-12); /* edges by length */
    for (int v = 0; v < 4; v++)
      ck_assert_int_eq(allowed[v], k == 0 ? true : k == 1 ? v == 0 : count[v] > 0);
  }
  thr_request o = options_for(THR_ENDS_FEET, 1);
  f.cover = calloc(3, sizeof *f.cover);
  for (int e = 0; e < 3; e++) {
    f.cover[0] = f.cover[1] = f.cover[2] = 1;
    f.cover[e] = 4;
    thr_tied_task(&f, &o, allowed, &t);
    ck_assert_int_eq(t.most_passes, 2 * (4 + 2 + 2) + 1);
  }
  free(f.cover);
  f.cover = NULL;
  int64_t potential[6] = {0}, ends[1] = {0};
  thr_turning_dual dual = {.potential = potential, .ends = ends};
  thr_turning_node leaf = {0};
  thr_turning_proof proof = {.n_nodes = 1, .n_duals = 1, .n_ends = 1, .node = &leaf, .dual = &dual};
  double least;
  ck_assert_int_eq(thr_tied_least(&f, &o, &proof, &least, NULL), THR_OK);
  ck_assert_double_eq_tol(least, 6, 1e-12);
  int member[1] = {0};
  thr_turning_set odd = {1, member, (int64_t)1 << 43};
  dual.odd = &odd, dual.n_odd = 1;
  o.ends = THR_ENDS_CLOSED; /* nothing but an extra pass leaves half-edge 0, alone at its node: 2 *
                               0.5 a pass, and 0.5 is taken */
  ck_assert_int_eq(thr_tied_least(&f, &o, &proof, &least, NULL), THR_OK);
  ck_assert_double_eq_tol(least, 6 + 0.5 / 0.5, 1e-9);
  odd.value = -1;
  ck_assert_int_eq(thr_tied_least(&f, &o, &proof, &least, NULL), THR_EVIOLATED);
  ck_assert_double_eq(least, 0);
  thr_frame_destroy(&f);
}
END_TEST

/* An edge costs its part of all length, times their number; but no edge more than 5,000. Whatever
 * the unit of length is. */
START_TEST(prices_of_tied_length_are_moderate)
{
  enum { N = 6000 };
  thr_frame f = path_make(N + 1);
  bool *allowed = calloc(N + 1, sizeof *allowed);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_turning_task t;
  for (int at = 0; at < N; at += N - 1)
    for (double unit = 1e-6; unit < 1e7; unit *= 1000) {
      for (int e = 0; e < N; e++)
        f.length[e] = unit;
      thr_tied_task(&f, &o, allowed, &t);
      ck_assert_double_eq_tol(t.price_per_length * unit, 1, 1e-9);
      f.length[at] = 1e6 * unit;
      thr_tied_task(&f, &o, allowed, &t);
      ck_assert_double_eq_tol(t.price_per_length * f.length[at], 5000, 1e-6);
    }
  free(allowed);
  thr_frame_destroy(&f);
}
END_TEST

/* A chain of four edges of about 1, tied at three nodes, with K cords that end anywhere: twice the
 * passes less twice the turns, of which there are three or more, are 2 K ends, so that there are K
 * + 3 passes or more. As multipliers: half of the weight of a pass for the ends, less as much for
 * every half-edge, twice it for every junction. Cords of two edges at most: three are needed,
 * though two would be long enough for every edge once. */
START_TEST(the_fewest_cords_of_tube_joints)
{
  static const double length[4] = {1, 1.0003, 1.0007, 1.0011};
  const double all = 4.0021;
  thr_frame f = chain_make(4, length);
  thr_cord cord[3];
  int half[3][2] = {{0, 2}, {2, 4}, {4, 6}}, block[2] = {0, 1};
  for (int i = 0; i < 3; i++) {
    cord[i] = (thr_cord){.n_passes = 2, .half = half[i]};
    thr_cord_id(i, cord[i].id);
  }
  int64_t unit = (int64_t)floor(ldexp(4 / all, THR_TURNING_BITS)) / 2, potential[8],
          ends[1] = {unit};
  for (int h = 0; h < 8; h++)
    potential[h] = -unit;
  thr_turning_junction junction[3] = {
      {1, block, 2 * unit}, {2, block, 2 * unit}, {3, block, 2 * unit}};
  thr_turning_dual dual = {
      .potential = potential, .ends = ends, .n_junctions = 3, .junction = junction};
  thr_turning_node leaf = {0};
  thr_turning_proof proof = {.n_nodes = 1, .n_duals = 1, .n_ends = 1, .node = &leaf, .dual = &dual};
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_cords_claim found;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  o.max_length = 2.002;
  for (int most = 3; most <= 5; most++)
    for (int least = 1; least <= 3; least++) {
      o.cords = most, o.cords_least = least;
      assert_ok(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err), &err);
      ck_assert_double_eq_tol(found.longest, 2.0018, 1e-12);
      double two =
          most == 3 ? 2.0003 : 0; /* three cords: one has two edges; this all sets of edges show */
      ck_assert_double_eq_tol(found.longest_bound,
                              fmax(fmax(1.0011, two), (all + least - 1) / most), 1e-9);
      ck_assert_int_eq(found.fewest,
                       least < most ? 3 : 0); /* asked for exactly, they are not claimed */
      ck_assert_int_eq(found.fewest_optimal, least < most);
    }
  o.max_length = 0;
  ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err), THR_OK);
  ck_assert_int_eq(found.fewest, 0);
  o.cords = 4, o.cords_least = 1;
  o.max_length = 2.0018; /* (K + 3) of about 1 in K cords of that */
  ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err), THR_OK);
  ck_assert_int_eq(found.fewest, 3);
  o.cords = 2;
  assert_status(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err), THR_EVIOLATED, &err,
                "has 3 cords; the plan's options say 1 to 2");
  thr_frame_destroy(&f);
}
END_TEST

/* A star of four legs, tied at its hub by three turns: at every tip the cords end that pass there,
 * so that there are six passes, and three cords. As multipliers: a large one off the ends, which
 * fewer cords have too few of, and what it takes for the junction to give that back. Two cords of 3
 * would be long enough for the passes. */
START_TEST(cords_have_too_few_ends_for_the_tips)
{
  static const double size[] = {1, 0.25};
  for (int k = 0; k < 2; k++) {
    thr_frame f = star_make(4);
    thr_cord cord[3];
    int half[3][2], block[4] = {0, 1, 2, 3};
    int64_t one = (int64_t)1 << THR_TURNING_BITS, potential[8], ends[1] = {-one};
    for (int e = 0; e < 4; e++) {
      f.length[e] = size[k];
      for (int i = 0; i < 2; i++)
        potential[2 * e + i] = f.edge[e][i] == 0 ? -2 * one : one;
    }
    for (int i = 0; i < 3; i++) {
      half[i][0] = 2 * i + (f.edge[i][0] == 0);
      half[i][1] = 2 * (i + 1) + (f.edge[i + 1][0] != 0);
      cord[i] = (thr_cord){.n_passes = 2, .half = half[i]};
      thr_cord_id(i, cord[i].id);
    }
    thr_turning_junction junction = {0, block, 4 * one};
    thr_turning_dual dual = {
        .potential = potential, .ends = ends, .n_junctions = 1, .junction = &junction};
    thr_turning_node leaf = {0};
    thr_turning_proof proof = {
        .n_nodes = 1, .n_duals = 1, .n_ends = 1, .node = &leaf, .dual = &dual};
    thr_request o = options_for(THR_ENDS_ANY, 1);
    thr_cords_claim found;
    thr_err err = {0};
    o.joint = THR_JOINT_TUBE;
    o.cords = 3, o.cords_least = 1;
    o.max_length = 3 * size[k];
    assert_ok(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err), &err);
    ck_assert_int_eq(found.fewest, 3);
    ck_assert_double_eq_tol(found.longest_bound, 2 * size[k], 1e-9);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Two chains of four edges, with three cords each: K cords or more in each of them have 2 (4 + K -
 * 1) or so together, and so many cords of the greatest length hold that. What may be too few cords
 * for one component says nothing about two. */
START_TEST(the_fewest_cords_of_two_components)
{
  static const double length[8] = {1, 1.0003, 1.0007, 1.0011, 1, 1.0003, 1.0007, 1.0011};
  const double all = 4.0021, two_each = 2 * (all + 1);
  const struct {
    double most;
    int least, fewest;
  } cases[] = {{two_each / 4 * (1 - 1e-6), 2, 5},
               {two_each / 4 * (1 - 1e-9), 2, 4},
               {two_each / 4, 2, 4},
               {two_each / 5 + 0.002, 2, 5},
               {4.01, 1, 2},
               {3.5, 1, 4}, /* each alone needs two, though three would hold all of it */
               {2.002, 1, 4}};
  double xyz[10][3] = {{0}};
  int edge[8][2], half[6][2], block[2] = {0, 1};
  for (int e = 0; e < 8; e++) {
    int v = e + e / 4;
    edge[e][0] = v, edge[e][1] = v + 1;
    xyz[v + 1][0] = xyz[v][0] + 1;
    xyz[v][1] = xyz[v + 1][1] = e / 4;
  }
  thr_frame f = frame_make(10, (const double(*)[3])xyz, 8, (const int(*)[2])edge, length, NULL);
  thr_cord cord[6];
  for (int i = 0; i < 6; i++) {
    half[i][0] = 2 * (i + i / 3), half[i][1] = half[i][0] + 2;
    cord[i] = (thr_cord){.component = i / 3, .n_passes = 2, .half = half[i]};
    thr_cord_id(i, cord[i].id);
  }
  int64_t unit = (int64_t)floor(ldexp(4 / all, THR_TURNING_BITS)) / 2, potential[16],
          ends[2] = {unit, unit};
  for (int h = 0; h < 16; h++)
    potential[h] = -unit;
  thr_turning_junction junction[6];
  for (int i = 0; i < 6; i++)
    junction[i] = (thr_turning_junction){i + 1 + 2 * (i / 3), block, 2 * unit};
  thr_turning_dual dual = {
      .potential = potential, .ends = ends, .n_junctions = 6, .junction = junction};
  thr_turning_node leaf = {0};
  thr_turning_proof proof = {.n_nodes = 1, .n_duals = 1, .n_ends = 2, .node = &leaf, .dual = &dual};
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.joint = THR_JOINT_TUBE;
  o.cords = 3;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_cords_claim found;
    thr_err err = {0};
    o.cords_least = cases[i].least;
    o.max_length = cases[i].most;
    assert_ok(thr_check_tied_cords(&f, &o, cord, 6, &proof, &found, &err), &err);
    ck_assert_int_eq(found.fewest, cases[i].fewest);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Cords of 2 over a chain of 1, 1, 1 and 1; a tree that proves no more than that every edge is
 * passed once. Two cords of 2 are enough, and of 2 less a rounding; and a tree that proves nothing
 * fails, however few cords there may be. */
START_TEST(rounding_needs_no_cord_more)
{
  static const double length[4] = {1, 1, 1, 1};
  int half[3][2] = {{0, 2}, {2, 4}, {4, 6}}, block[2] = {0, 1};
  thr_cord cord[3];
  for (int i = 0; i < 3; i++) {
    cord[i] = (thr_cord){.n_passes = 2, .half = half[i]};
    thr_cord_id(i, cord[i].id);
  }
  int64_t potential[8] = {0}, ends[1] = {0};
  thr_turning_junction junction = {1, block, -1};
  thr_turning_dual dual = {.potential = potential, .ends = ends, .junction = &junction};
  thr_turning_node leaf = {0};
  thr_turning_proof proof = {.n_nodes = 1, .n_duals = 1, .n_ends = 1, .node = &leaf, .dual = &dual};
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.joint = THR_JOINT_TUBE;
  o.cords_least = 1;
  for (int n = 3; n <= 4; n++) {
    thr_frame f = chain_make(n, length);
    thr_cords_claim found;
    o.cords = n - 1;
    o.max_length = n == 3 ? 2 : 2 * (1 - 0.5e-9);
    dual.n_junctions = 0;
    ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, n - 1, &proof, &found, NULL), THR_OK);
    ck_assert_int_eq(found.fewest, 2);
    o.max_length = 2;
    ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, n - 1, &proof, &found, NULL), THR_OK);
    ck_assert_int_eq(found.fewest, 2);
    dual.n_junctions = 1;
    ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, n - 1, &proof, &found, NULL),
                     THR_EVIOLATED);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* The same of two cords on two edges, over both and over the first: the multipliers take so much of
 * what a pass of that costs. */
typedef struct {
  thr_plan plan;
  int64_t potential[4], ends[1];
  int block[2];
  thr_turning_junction junction;
  thr_turning_dual dual;
  thr_turning_node leaf;
} tied_pair;

static void tied_pair_make(tied_pair *x, const double *length, double part)
{
  static const int half[3] = {0, 2, 0};
  thr_frame f = chain_make(2, length);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_plan *p = &x->plan;
  int64_t unit =
      (int64_t)floor(ldexp(part * (2 / (length[0] + length[1]) * length[0]), THR_TURNING_BITS)) / 2;
  *x = (tied_pair){.potential = {-unit, -unit, -unit, -unit}, .ends = {unit}, .block = {0, 1}};
  f.length[0] = length[0], f.length[1] = length[1];
  o.joint = THR_JOINT_TUBE;
  o.cords = o.cords_least = 2;
  ck_assert_int_eq(thr_plan_request(p, &f, &o, NULL), THR_OK);
  p->cord = calloc(2, sizeof *p->cord);
  p->n_cords = 2;
  for (int i = 0; i < 2; i++) {
    p->cord[i] = (thr_cord){.n_passes = 2 - i, .half = calloc(2, sizeof(int))};
    memcpy(p->cord[i].half, half + 2 * i, (size_t)(2 - i) * sizeof(int));
    thr_cord_id(i, p->cord[i].id);
  }
  x->junction = (thr_turning_junction){1, x->block, 2 * unit};
  x->dual = (thr_turning_dual){
      .potential = x->potential, .ends = x->ends, .n_junctions = 1, .junction = &x->junction};
  ck_assert_int_eq(thr_plan_measure(&f, &o, p->cord, 2, &p->metrics, NULL), THR_OK);
  p->proof = (thr_length_proof){
      .present = true,
      .optimal = true,
      .lower_bound = p->metrics.length,
      .tied = {.n_nodes = 1, .n_duals = 1, .n_ends = 1, .node = &x->leaf, .dual = &x->dual}};
  thr_frame_destroy(&f);
}

static void tied_pair_destroy(tied_pair *x)
{
  x->plan.proof = (thr_length_proof){0};
  thr_plan_destroy(&x->plan);
}

/* The bound is what the plan has, or short of it by a part of 1e-10 or 1e-7. */
START_TEST(optimal_tied_lengths_are_within_a_billionth)
{
  static const double length[2] = {1, 2}, off[] = {0, 1e-10, 1e-7};
  for (int k = 0; k < 3; k++) {
    tied_pair x;
    tied_pair_make(&x, length, 1 - 4 * off[k]);
    thr_plan *p = &x.plan;
    thr_err err = {0};
    ck_assert_msg(thr_check_plan(p, &err) == (k < 2 ? THR_OK : THR_EVIOLATED), "%s", err.text);
    if (k == 2) assert_one_line(&err, "optimal");
    p->proof.optimal = false;
    p->proof.lower_bound = 4 - 4 * off[k];
    p->proof.gap = off[k];
    err = (thr_err){0};
    assert_holds(p);
    tied_pair_destroy(&x);
  }
}
END_TEST

/* What a tree proves may come out above the length of the cords, by rounding of sums. */
START_TEST(tied_lengths_are_proved_but_for_rounding)
{
  int above = 0;
  for (int i = 1; i <= 40; i++) {
    const double length[2] = {i / 10.0, 15 * (i / 10.0)};
    tied_pair x;
    double least;
    tied_pair_make(&x, length, 1);
    const thr_plan *p = &x.plan;
    ck_assert_int_eq(thr_tied_least(&p->frame, &p->options, &p->proof.tied, &least, NULL), THR_OK);
    above += least > 2 * length[0] + length[1];
    assert_holds(p);
    tied_pair_destroy(&x);
  }
  ck_assert_int_gt(above, 0);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("tube joints in the checker");
  ADD_EXAMPLES(s, 10, nodes_are_tied_by_turns, 60);
  ADD_TEST(s, 10, prices_of_tied_length_are_moderate);
  ADD_TEST(s, 10, optimal_tied_lengths_are_within_a_billionth);
  ADD_TEST(s, 10, tied_lengths_are_proved_but_for_rounding);
  ADD_TEST(s, 10, the_fewest_cords_of_tube_joints);
  ADD_TEST(s, 10, cords_have_too_few_ends_for_the_tips);
  ADD_TEST(s, 10, the_fewest_cords_of_two_components);
  ADD_TEST(s, 10, rounding_needs_no_cord_more);
  ADD_TEST(s, 10, proofs_of_tied_length_are_about_the_plan);
  ADD_TEST(s, 10, tube_joints_are_tied);
  ADD_TEST(s, 10, no_cord_of_tube_joints_turns_back_where_it_closes);
  ADD_TEST(s, 10, no_cord_of_tube_joints_turns_back_first);
  return run_suite(s);
}
