/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the checker finds out about turning and says of claims about it: trees whose bound is known,
 * every number of a claim changed. */
#include "graph/number.h"
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define HALF 0.70710678118654752440 /* sin(pi / 4) */

/* ---- plans by hand ---- */

enum { MOST_WALK = 64 };

/* Appends a cord through these nodes, ending with -1. */
static void add_cord(thr_plan *p, const int *node)
{
  thr_cord c = {.half = calloc(MOST_WALK, sizeof(int))};
  ck_assert_ptr_nonnull(c.half);
  for (int i = 0; node[i + 1] >= 0; i++) {
    int e = thr_frame_edge_between(&p->frame, node[i], node[i + 1]);
    ck_assert(e >= 0 && c.n_passes < MOST_WALK);
    c.half[c.n_passes++] = 2 * e + (p->frame.edge[e][1] == node[i]);
  }
  thr_cord_id(p->n_cords, c.id);
  c.closed = thr_cord_start(&p->frame, &c) == thr_cord_end(&p->frame, &c);
  int component[MOST_WALK], n;
  ck_assert_int_eq(thr_frame_components(&p->frame, component, &n, NULL), THR_OK);
  c.component = component[node[0]];
  p->cord = realloc(p->cord, (size_t)(p->n_cords + 1) * sizeof *p->cord);
  ck_assert_ptr_nonnull(p->cord);
  p->cord[p->n_cords++] = c;
}

/* A tree of one leaf without multipliers; number of equations of the ends as in the model. */
static void empty_tree(thr_plan *p, int n_ends)
{
  thr_turning_proof *t = &p->turning.tree;
  *t = (thr_turning_proof){.n_nodes = 1,
                           .n_duals = 1,
                           .n_ends = n_ends,
                           .node = calloc(1, sizeof *t->node),
                           .dual = calloc(1, sizeof *t->dual)};
  t->dual->potential = calloc(2 * (size_t)p->frame.n_edges, sizeof(int64_t));
  t->dual->ends = calloc((size_t)n_ends, sizeof(int64_t));
  ck_assert(t->dual->potential && t->dual->ends);
}

/* A plan of this framework, which is taken, without cords; the claim's kind is the widest. */
static thr_plan plan_begin(thr_frame f, thr_ends ends, int cords, thr_turn_cost cost)
{
  thr_plan p = {0};
  thr_request o = options_for(ends, 1);
  int component[MOST_WALK], n;
  want(&o, "turning");
  o.cords = o.cords_least = cords;
  o.turning.cost = cost;
  o.turning.length_slack = -1;
  ck_assert_int_eq(thr_frame_components(&f, component, &n, NULL), THR_OK);
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  p.turning = (thr_turning_claim){
      .present = true, .most_passes = thr_turning_most_passes(&f, 1), .length_limit = -1};
  p.generator = thr_strdup("by hand");
  empty_tree(&p, n);
  thr_frame_destroy(&f);
  return p;
}

static thr_status find(const thr_plan *p, thr_turning_claim *found, thr_err *err)
{
  *err = (thr_err){0};
  return thr_check_turning(&p->frame, &p->options, p->cord, p->n_cords, &p->turning, found, err);
}

static thr_turning_claim found_of(const thr_plan *p)
{
  thr_turning_claim found;
  thr_err err;
  assert_ok(find(p, &found, &err), &err);
  return found;
}

static void assert_not_found(const thr_plan *p, const char *word)
{
  thr_turning_claim found;
  thr_err err;
  assert_status(find(p, &found, &err), THR_EVIOLATED, &err, word);
}

/* States what the checker finds; the plan then holds. */
static void state(thr_plan *p)
{
  thr_turning_proof tree = p->turning.tree;
  p->turning = found_of(p);
  p->turning.tree = tree;
  ck_assert_int_eq(thr_plan_measure(&p->frame, &p->options, p->cord, p->n_cords, &p->metrics, NULL),
                   THR_OK);
  assert_holds(p);
}

/* Unit spokes at these angles, in a plane that is askew, and away from the origin. Node 0 is the
 * hub. */
static thr_frame fan_make(int n, const double *angle)
{
  double xyz[MOST_WALK][3] = {{1, 2, 3}};
  int edge[MOST_WALK][2];
  for (int i = 0; i < n; i++) {
    xyz[i + 1][0] = 1 + cos(angle[i]), xyz[i + 1][1] = 2 + 0.6 * sin(angle[i]),
            xyz[i + 1][2] = 3 + 0.8 * sin(angle[i]);
    edge[i][0] = 0, edge[i][1] = i + 1;
  }
  return frame_make(n + 1, (const double(*)[3])xyz, n, (const int(*)[2])edge, NULL, NULL);
}

/* ---- what cords turn ---- */

/* A bent path, its cord there and back: a quarter twice, and two U-turns at the ends. */
START_TEST(turns_are_added_up)
{
  static const double angle[2] = {0, THR_PI / 2},
                      price[][2] = {{3 * THR_PI, THR_PI / 2}, {2 + 2 * HALF, HALF}, {4, 1}, {2, 0}};
  for (int cost = 0; cost < THR_N_TURN_COSTS; cost++) {
    thr_plan closed = plan_begin(fan_make(2, angle), THR_ENDS_CLOSED, 1, (thr_turn_cost)cost);
    add_cord(&closed, (int[]){1, 0, 2, 0, 1, -1});
    thr_turning_claim found = found_of(&closed);
    ck_assert_double_eq_tol(found.price, price[cost][0], 1e-12);
    ck_assert_double_eq_tol(found.largest, price[cost][0], 1e-12);
    thr_plan open = plan_begin(fan_make(2, angle), THR_ENDS_ANY, 2, (thr_turn_cost)cost);
    add_cord(&open, (int[]){1, 0, 2, -1});
    add_cord(&open, (int[]){1, 0, 2, 0, -1}); /* ends once at the bend: there a pass goes with it */
    found = found_of(&open);
    double back = cost == THR_TURN_ANGLE ? THR_PI : 1;
    ck_assert_double_eq_tol(found.price, 2 * price[cost][1] + back, 1e-12);
    ck_assert_double_eq_tol(found.largest, price[cost][1] + back, 1e-12);
    thr_plan_destroy(&closed);
    thr_plan_destroy(&open);
  }
}
END_TEST

START_TEST(cords_turn_back_only_at_nodes_with_one_edge)
{
  thr_plan p = plan_begin(ring_make(4), THR_ENDS_ANY, 1, THR_TURN_ANGLE);
  add_cord(&p, (int[]){0, 1, 2, 3, 0, 3, -1});
  assert_not_found(&p, "turns back at node 0 after pass 4");
  thr_plan_destroy(&p);
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  static const int edge[5][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}};
  p = plan_begin(frame_make(4, xyz, 5, edge, NULL, NULL), THR_ENDS_CLOSED, 1, THR_TURN_ANGLE);
  add_cord(&p, (int[]){0, 1, 2, 3, 0, 2, 1, 0, -1}); /* where it closes */
  assert_not_found(&p, "turns back at node 0 after pass 7");
  thr_plan_destroy(&p);
}
END_TEST

/* One edge, to and fro: as many passes as the proof is about, and a cord as long as it may be, but
 * no more. */
START_TEST(cords_are_of_the_kind_that_the_proof_is_about)
{
  thr_plan p = plan_begin(path_make(2), THR_ENDS_CLOSED, 1, THR_TURN_ANGLE);
  add_cord(&p, (int[]){0, 1, 0, 1, 0, 1, 0, 1, 0, -1});
  ck_assert_int_eq(p.turning.most_passes, 8);
  found_of(&p);
  p.turning.most_passes = 7;
  assert_not_found(&p, "most_passes: 7");
  p.turning.most_passes = 9;
  p.turning.length_limit = 8;
  found_of(&p);
  p.turning.length_limit = 8 - 7e-9;
  found_of(&p);
  p.turning.length_limit = 8 - 9e-9;
  assert_not_found(&p, "8 long");
  p.turning.length_limit = 0;
  assert_not_found(&p, "8 long");
  p.turning.length_limit = -1;
  add_cord(&p, (int[]){0, 1, 0, -1});
  p.options.cords = p.options.cords_least = 2;
  assert_not_found(&p, "10 passes over edge 0");
  p.turning.most_passes = 10;
  found_of(&p);
  thr_plan_destroy(&p);
  thr_frame f = path_make(2);
  for (int most = 0; most <= 2; most++) {
    const thr_turning_task task = {.cover = 1, .most_passes = most, .cords = 1, .extra_limit = -1};
    thr_turning_columns c;
    ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), most ? THR_OK : THR_EINPUT);
    thr_turning_columns_destroy(&c);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Many cords along one edge: nothing turns. */
START_TEST(nothing_turns_where_cords_end)
{
  enum { CORDS = 300 };
  thr_plan p = plan_begin(path_make(2), THR_ENDS_ANY, CORDS, THR_TURN_ANGLE);
  for (int i = 0; i < CORDS; i++)
    add_cord(&p, (int[]){0, 1, -1});
  p.turning.most_passes = CORDS;
  thr_turning_claim found = found_of(&p);
  ck_assert_double_eq(found.price, 0);
  ck_assert(found.optimal);
  thr_plan_destroy(&p);
}
END_TEST

/* No cords turn nothing, which is proved without any rounding. */
START_TEST(no_cords_turn_nothing)
{
  thr_plan p = plan_begin(path_make(3), THR_ENDS_ANY, 1, THR_TURN_ANGLE);
  thr_turning_claim found = found_of(&p);
  ck_assert_double_eq(found.price, 0);
  ck_assert_double_eq(found.lower_bound, 0);
  ck_assert(found.optimal && found.largest_optimal);
  thr_plan_destroy(&p);
}
END_TEST

/* To and fro over one edge, 65,536 times. */
START_TEST(many_passes_turn_back)
{
  enum { PASSES = 65536 };
  thr_plan p = plan_begin(path_make(2), THR_ENDS_CLOSED, 1, THR_TURN_ANGLE);
  add_cord(&p, (int[]){0, 1, 0, -1});
  free(p.cord->half);
  p.cord->half = calloc(PASSES, sizeof(int));
  ck_assert_ptr_nonnull(p.cord->half);
  p.cord->n_passes = p.turning.most_passes = PASSES;
  for (int i = 0; i < PASSES; i++)
    p.cord->half[i] = i % 2;
  ck_assert_double_eq_tol(found_of(&p).price, PASSES * THR_PI, 1e-6);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- what the tree proves ---- */

/* A bend by so much must be turned: its half-edges' potentials, half of the price each, prove that.
 */
static thr_plan bend_make(double turn, thr_turn_cost cost, int64_t weight)
{
  const double angle[2] = {0, THR_PI - turn};
  static int ends[3] = {0, 1, 1};
  thr_request o;
  thr_plan p = plan_begin(fan_make(2, angle), THR_ENDS_ANY, 1, cost);
  o = p.options;
  o.ends = THR_ENDS_COUNTS;
  o.end_count = ends;
  thr_frame f = {0};
  thr_turning_claim claim = p.turning;
  ck_assert_int_eq(thr_frame_copy(&f, &p.frame, NULL), THR_OK);
  p.turning = (thr_turning_claim){0};
  thr_plan_destroy(&p);
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  thr_turning_proof_destroy(&claim.tree);
  p.turning = claim;
  p.generator = thr_strdup("by hand");
  empty_tree(&p, 3);
  p.turning.tree.dual->potential[0] = weight / 2;
  p.turning.tree.dual->potential[2] = weight - weight / 2;
  add_cord(&p, (int[]){1, 0, 2, -1});
  thr_frame_destroy(&f);
  return p;
}

/* Weights of turns are rounded down: a unit more is above what all plans pay. */
START_TEST(bends_prove_what_they_cost)
{
  static const double turn[] = {0.1, 0.5, 1, 2, 3};
  for (int i = 0; i < 5; i++) {
    int64_t down = (int64_t)floor(ldexp(turn[i], THR_TURNING_BITS));
    for (int more = -1; more <= 1; more++) {
      thr_plan p = bend_make(turn[i], THR_TURN_ANGLE, down + more);
      thr_turning_task task = {.cover = 1,
                               .most_passes = 8,
                               .cords = 1,
                               .end_allowed = (bool[]){false, true, true},
                               .extra_limit = -1};
      double bound;
      task.end_count = p.options.end_count;
      ck_assert_int_eq(thr_turning_proof_check(&p.frame, &task, &p.turning.tree, &bound, NULL),
                       THR_OK);
      ck_assert_double_le(bound, turn[i]);
      ck_assert_double_ge(bound, turn[i] - ldexp(12, -THR_TURNING_BITS));
      ck_assert(found_of(&p).optimal);
      thr_plan_destroy(&p);
    }
  }
  thr_plan p = bend_make(1, THR_TURN_ANGLE, 1); /* a single unit is a bound, too */
  ck_assert_double_eq(found_of(&p).lower_bound, ldexp(1, -THR_TURNING_BITS));
  thr_plan_destroy(&p);
}
END_TEST

/* Within 2e-9 of a U-turn for each pass the bound meets the price. */
START_TEST(bounds_are_optimal_within_rounding)
{
  static const double off[] = {0, 1.2e-8, 1.3e-8}; /* 2 passes: 4 pi 1e-9 = 1.257e-8 */
  for (int i = 0; i < 3; i++) {
    thr_plan p = bend_make(1, THR_TURN_ANGLE, (int64_t)floor(ldexp(1 - off[i], THR_TURNING_BITS)));
    thr_turning_claim found = found_of(&p);
    ck_assert_int_eq(found.optimal, i < 2);
    ck_assert(found.largest_optimal); /* the single turn is forced, whatever the tree proves */
    ck_assert_double_eq(found.price, found.largest);
    ck_assert_double_eq_tol(found.lower_bound, i < 2 ? found.price : 1 - off[i], 1e-12);
    ck_assert_double_eq_tol(found.gap, i < 2 ? 0 : off[i], 1e-12);
    ck_assert_double_eq(found.largest_bound, found.largest);
    thr_plan_destroy(&p);
  }
}
END_TEST

/* A bound above the turns of the plan itself is no bound: here of two closed cords, where the plan
 * has one. */
START_TEST(no_tree_proves_more_than_the_plan_turns)
{
  thr_plan p = plan_begin(ring_make(5), THR_ENDS_CLOSED, 2, THR_TURN_ANGLE);
  add_cord(&p, (int[]){0, 1, 2, 3, 4, 0, -1});
  assert_not_found(&p, "more than the turns of this plan");
  thr_plan_destroy(&p);
}
END_TEST

/* Cords from tip to tip of a bend, and as many along a straight chain, of too many edges for all
 * sets to be tried. The ends at the bend's tips, paid by half a turn each, prove all turns; a bound
 * within 2e-9 of a U-turn for each pass is optimal, and more passes of an edge than twice those
 * that it needs do not widen that. */
START_TEST(rounding_is_that_of_twice_the_passes_needed)
{
  enum { CHAIN = 14 };
  static const double part[] = {0, 0.96, 1.04}, angle[2] = {0, THR_PI - 1};
  int along[CHAIN + 1];
  for (int k = 0; k < CHAIN; k++)
    along[k] = 3 + k;
  along[CHAIN] = -1;
  for (int i = 0; i < 3; i++)
    for (int cover = 1; cover <= 2; cover++)
      for (int cords = 2; cords <= 4; cords++) {
        int ends[3 + CHAIN] = {0, cords, cords},
                     counted = (cords < 2 * cover ? cords : 2 * cover) * (2 + CHAIN - 1);
        thr_frame bend = fan_make(2, angle), chain = path_make(CHAIN);
        thr_plan p =
            plan_begin(side_by_side(&bend, &chain), THR_ENDS_COUNTS, cords, THR_TURN_ANGLE);
        ends[3] = ends[3 + CHAIN - 1] = cords;
        p.options.end_count = ends;
        p.options.cover = cover;
        p.turning.most_passes = 4 * cover + 4;
        for (int k = 0; k < cords; k++) {
          add_cord(&p, (int[]){1, 0, 2, -1});
          add_cord(&p, along);
        }
        double off = part[i] * counted * 2e-9 * THR_PI;
        int64_t half = (int64_t)floor(ldexp((1 - off / cords) / 2, THR_TURNING_BITS));
        thr_turning_proof_destroy(&p.turning.tree);
        empty_tree(&p, 3 + CHAIN);
        int64_t *potential = p.turning.tree.dual->potential;
        potential[0] = potential[2] = half, potential[1] = potential[3] = -half;
        p.turning.tree.dual->ends[1] = p.turning.tree.dual->ends[2] = half;
        thr_turning_claim found = found_of(&p);
        ck_assert_double_eq_tol(found.price, cords, 1e-12);
        ck_assert_int_eq(found.optimal, i < 2);
        ck_assert_double_eq_tol(found.lower_bound, i < 2 ? cords : cords - off, 1e-11);
        p.options.end_count = NULL;
        thr_plan_destroy(&p);
        thr_frame_destroy(&bend);
        thr_frame_destroy(&chain);
      }
}
END_TEST

/* ---- limits on the length ---- */

static void scale(thr_frame *f, double by)
{
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      f->xyz[v][i] *= by;
  for (int e = 0; e < f->n_edges; e++)
    f->length[e] *= by;
}

/* Three spokes that all but coincide, and one opposite to them: unless that one is passed three
 * times, two of the three turn into each other, which is a step. Half a step for each of the three,
 * less half of one for the fourth, prove it, if the length takes back what extra passes of the
 * fourth save: 1 - (limit - 4) / 2. Without a limit they prove nothing. */
START_TEST(limits_on_the_length_prove_turns)
{
  static const double angle[4] = {-0.1, 0, 0.1, THR_PI}, size[] = {1 / 16.0, 1, 3};
  static const double limit[][2] = {
      {4, 1}, {4.5, 0.75}, {5, 0.5}, {6, 0}, {-1, 0}}; /* and the bound */
  bool allowed[5] = {false, true, true, true, true};
  for (int k = 0; k < 3; k++)
    for (size_t i = 0; i < sizeof limit / sizeof *limit; i++) {
      thr_plan p = plan_begin(fan_make(4, angle), THR_ENDS_NODES, 3, THR_TURN_STEP);
      thr_turning_dual *d = p.turning.tree.dual;
      bool *kept = p.options.end_node;
      scale(&p.frame, size[k]);
      p.options.end_node = allowed;
      p.options.cords_least = 2;
      add_cord(&p, (int[]){1, 0, 4, -1});
      add_cord(&p, (int[]){2, 0, 3, -1});
      d->length = (int64_t)1 << (THR_TURNING_BITS - 1);
      d->potential[0] = d->potential[2] = d->potential[4] = d->length;
      d->potential[6] = -d->length;
      p.turning.length_limit = limit[i][0] < 0 ? -1 : limit[i][0] * size[k];
      thr_turning_claim found = found_of(&p);
      ck_assert_double_eq(found.price, 1);
      ck_assert_double_eq_tol(found.lower_bound, limit[i][1], 1e-9);
      ck_assert_int_eq(found.optimal, i == 0);
      p.options.end_node = kept;
      thr_plan_destroy(&p);
    }
}
END_TEST

/* Three cords along one edge, with as many ends at both: three passes there must be, so a limit
 * that is less by rounding, which is let through, and large multipliers would prove turns where
 * nothing turns. The limit is no less than the cords. */
START_TEST(a_limit_just_below_the_cords_proves_nothing)
{
  static const double size[] = {1 / 16.0, 1, 3};
  for (int k = 0; k < 3; k++) {
    int ends[2] = {3, 3};
    thr_plan p = plan_begin(path_make(2), THR_ENDS_ANY, 3, THR_TURN_ANGLE);
    scale(&p.frame, size[k]);
    thr_turning_proof_destroy(&p.turning.tree);
    empty_tree(&p, 2);
    p.options.ends = THR_ENDS_COUNTS;
    p.options.end_count = ends;
    for (int i = 0; i < 3; i++)
      add_cord(&p, (int[]){0, 1, -1});
    thr_turning_dual *d = p.turning.tree.dual;
    d->length = d->ends[1] = (int64_t)1 << 57;
    d->potential[1] = -d->length;
    p.turning.length_limit = (3 - 2e-9) * size[k];
    thr_turning_claim found = found_of(&p);
    ck_assert_double_eq(found.price, 0);
    ck_assert_double_eq(found.lower_bound, 0);
    ck_assert(found.optimal);
    p.turning.length_limit = (3 - 4e-9) * size[k];
    assert_not_found(&p, "long");
    p.options.ends = THR_ENDS_ANY;
    p.options.end_count = NULL;
    thr_plan_destroy(&p);
  }
}
END_TEST

/* Branches on the one turn of a bend, one below the other: the narrowest bounds count, in whichever
 * order they come. Multipliers above the price need the turn to be made at most once, those that
 * ask for passes need it to be made four times. */
START_TEST(branches_on_one_turn_narrow_it)
{
  static const struct {
    int low, high, value, dual;
  } tree[][5] = {{{1, 2, 3, 0}, {3, 4, 1, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 1}},
                 {{1, 2, 0, 0}, {0, 0, 0, 0}, {3, 4, 3, 0}, {0, 0, 0, 1}, {0, 0, 0, 2}},
                 {{1, 2, INT_MAX, 0}, {0, 0, 0, 1}, {0, 0, 0, 2}}};
  for (int k = 0; k < 3; k++) {
    thr_plan p = bend_make(1, THR_TURN_ANGLE, (int64_t)3 << (THR_TURNING_BITS - 1));
    thr_turning_proof *t = &p.turning.tree;
    t->n_nodes = k < 2 ? 5 : 3;
    t->n_duals = 3;
    t->node = realloc(t->node, (size_t)t->n_nodes * sizeof *t->node);
    t->dual = realloc(t->dual, 3 * sizeof *t->dual);
    ck_assert(t->node && t->dual);
    for (int i = 0; i < t->n_nodes; i++)
      t->node[i] = (thr_turning_node){.low = tree[k][i].low,
                                      .high = tree[k][i].high,
                                      .b = tree[k][i].low ? 2 : 0,
                                      .value = tree[k][i].value,
                                      .dual = tree[k][i].dual};
    for (int d = 1; d < 3; d++) {
      t->dual[d] = (thr_turning_dual){.potential = calloc(4, sizeof(int64_t)),
                                      .ends = calloc(3, sizeof(int64_t))};
      ck_assert(t->dual[d].potential && t->dual[d].ends);
    }
    t->dual[2].potential[0] = -((int64_t)1 << (THR_TURNING_BITS - 1));
    if (k == 2)
      t->dual[1].potential[0] = t->dual[1].potential[2] = (int64_t)1 << (THR_TURNING_BITS - 1);
    thr_turning_claim found = found_of(&p);
    ck_assert_double_eq_tol(found.lower_bound, 1, 1e-9);
    ck_assert(found.optimal);
    thr_plan_destroy(&p);
  }
}
END_TEST

/* Where cords may end at the bend, no turn is needed there: the same multipliers prove nothing. */
START_TEST(ends_are_where_the_options_allow_them)
{
  const double angle[2] = {0, THR_PI - 1};
  for (int hub = 0; hub < 2; hub++) {
    thr_plan p = plan_begin(fan_make(2, angle), THR_ENDS_NODES, 1, THR_TURN_ANGLE);
    bool allowed[3] = {hub, true, true}, *kept = p.options.end_node;
    p.options.end_node = allowed;
    int64_t weight = (int64_t)floor(ldexp(1, THR_TURNING_BITS));
    p.turning.tree.dual->potential[0] = p.turning.tree.dual->potential[2] = weight / 2;
    add_cord(&p, (int[]){1, 0, 2, -1});
    thr_turning_claim found = found_of(&p);
    ck_assert_int_eq(found.optimal, !hub);
    ck_assert_double_eq_tol(found.lower_bound, !hub, 1e-9);
    p.options.end_node = kept;
    thr_plan_destroy(&p);
  }
}
END_TEST

/* A closed cord turns round once, whatever the tree says; with prices sin(angle / 2) it pays 2;
 * steps and U-turns it may need none. */
START_TEST(closed_cords_turn_round)
{
  static const double least[] = {2 * THR_PI, 2, 0, 0},
                      round[] = {2 * THR_PI, 3 * 0.86602540378443864676, 3, 0};
  for (int cost = 0; cost < THR_N_TURN_COSTS; cost++)
    for (int cords = 1; cords <= 2; cords++) {
      thr_plan p = plan_begin(triangles_make(2), THR_ENDS_CLOSED, cords, (thr_turn_cost)cost);
      for (int i = 0; i < cords; i++) {
        add_cord(&p, (int[]){0, 1, 2, 0, -1});
        add_cord(&p, (int[]){3, 4, 5, 3, -1});
      }
      thr_turning_claim found = found_of(&p);
      double known = cords > 1
                         ? round[cost]
                         : least[cost]; /* of several cords through few edges all sets are tried */
      bool optimal = known >= round[cost] - 1e-9;
      ck_assert_double_eq_tol(found.price, 2 * cords * round[cost], 1e-9);
      ck_assert_double_eq_tol(found.lower_bound, 2 * cords * known, 1e-9);
      ck_assert_double_eq_tol(found.largest_bound, known, 1e-9);
      ck_assert_double_eq_tol(found.gap, optimal ? 0 : 1 - known / round[cost], 1e-9);
      ck_assert_int_eq(found.optimal, optimal);
      ck_assert_int_eq(found.largest_optimal, optimal);
      p.options.cords_least = 1; /* then only so many are sure to turn */
      if (cords == 2) {
        found = found_of(&p);
        ck_assert_double_eq_tol(found.lower_bound, 2 * round[cost], 1e-9);
        ck_assert_double_eq_tol(found.largest_bound, round[cost], 1e-9);
      }
      thr_plan_destroy(&p);
    }
  thr_plan open = plan_begin(ring_make(3), THR_ENDS_ANY, 1, THR_TURN_ANGLE);
  add_cord(&open, (int[]){0, 1, 2, 0, -1});
  ck_assert_double_eq(found_of(&open).lower_bound, 0); /* its two turns are no round */
  thr_plan_destroy(&open);
}
END_TEST

/* Steps are those of one definition, on either side of the quarter. */
START_TEST(steps_begin_at_a_quarter_less_a_millionth)
{
  static const double turn[] = {
      THR_PI / 2 - 1.1e-6, THR_PI / 2 - 0.9e-6, THR_PI / 2, THR_PI / 2 + 1e-5, 3, 1};
  static const int step[] = {0, 1, 1, 1, 1, 0};
  ck_assert_double_eq(thr_turn_cost_of(THR_TURN_STEP, THR_PI / 2 - 1e-6), 1);
  for (int i = 0; i < 6; i++) {
    thr_plan p = bend_make(turn[i], THR_TURN_STEP, (int64_t)step[i] << THR_TURNING_BITS);
    thr_turning_claim found = found_of(&p);
    ck_assert_double_eq(found.price, step[i]);
    ck_assert_double_eq(found.lower_bound, step[i]);
    ck_assert(found.optimal);
    thr_plan_destroy(&p);
  }
}
END_TEST

/* Bends within some roundings of where steps begin: every price is that of the one definition. */
START_TEST(steps_have_one_definition)
{
  for (int i = -200; i <= 200; i++) {
    thr_plan p = bend_make(THR_PI / 2 - 1e-6 + i * 1e-17 * (1 << abs(i) % 8), THR_TURN_STEP,
                           (int64_t)1 << THR_TURNING_BITS);
    double step = thr_turn_price(&p.frame, THR_TURN_STEP, p.cord[0].half[0], p.cord[0].half[1]);
    thr_turning_claim found = found_of(&p);
    ck_assert_double_eq(found.price, step);
    ck_assert_double_eq(found.lower_bound, step);
    thr_plan_destroy(&p);
  }
}
END_TEST

/* ---- claims ---- */

/* Each number of a claim that holds may be off by rounding, not by more; bounds may be lower. */
START_TEST(every_number_of_a_claim_counts)
{
  thr_plan p = plan_begin(triangles_make(2), THR_ENDS_CLOSED, 1, THR_TURN_SINE);
  add_cord(&p, (int[]){0, 1, 2, 0, -1});
  add_cord(&p, (int[]){3, 4, 5, 3, -1});
  state(&p);
  thr_turning_claim good = p.turning, *c = &p.turning;
  double tolerance = 1e-9 * (1 + good.price);
  const struct {
    double *at;
    double tolerance;
    bool bound;
    const char *word;
  } number[] = {{&c->price, tolerance, false, "turning.price"},
                {&c->largest, tolerance, false, "largest.price"},
                {&c->lower_bound, 1e-9 * (1 + good.lower_bound), true, "turning.lower_bound"},
                {&c->largest_bound, 1e-9 * (1 + good.largest_bound), true, "largest.lower_bound"},
                {&c->gap, 1e-9, false, "gap"}};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++)
    for (int sign = -1; sign <= 1; sign += 2) {
      double kept = *number[i].at, gap = c->gap;
      *number[i].at = kept + sign * 0.3 * number[i].tolerance;
      assert_holds(&p);
      *number[i].at = kept + sign * 1.2 * number[i].tolerance;
      if (number[i].at == &c->lower_bound) c->gap = (c->price - c->lower_bound) / c->price;
      if (number[i].bound && sign < 0)
        assert_holds(&p);
      else
        assert_violated(&p, number[i].word);
      c->gap = gap;
      *number[i].at = kept;
    }
  c->lower_bound = 0;
  assert_violated(&p, "gap");
  c->gap = 1;
  assert_holds(&p);
  c->largest_bound = 0;
  assert_holds(&p);
  c->optimal = true;
  assert_violated(&p, "says optimal, but the tree only proves");
  c->optimal = false, c->largest_optimal = true;
  assert_violated(&p, "largest: says optimal, but only");
  *c = good;
  p.options.turning.tour = THR_TOUR_FLEURY;
  assert_violated(&p, "classical tour");
  p.options.turning.tour = THR_TOUR_LEAST;
  c->length_limit = 10;
  assert_violated(&p, "any length");
  c->length_limit = 0;
  assert_violated(&p, "any length");
  *c = good;
  assert_holds(&p);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(an_optimal_claim_states_its_price)
{
  thr_plan p = bend_make(1, THR_TURN_ANGLE, (int64_t)1 << THR_TURNING_BITS);
  state(&p);
  thr_turning_claim good = p.turning;
  ck_assert(good.optimal && good.largest_optimal);
  p.turning.lower_bound = 0.9, p.turning.gap = 0.1;
  assert_violated(&p, "is not the price");
  p.turning.optimal = false;
  assert_holds(&p);
  p.turning.largest_bound = 0.9;
  assert_violated(&p, "largest: says optimal, but its lower bound");
  p.turning.largest_optimal = false;
  assert_holds(&p);
  p.turning = good;
  assert_holds(&p);
  thr_plan_destroy(&p);
}
END_TEST

/* Nothing turns, and nothing is left to prove. */
START_TEST(a_price_of_nothing_has_no_gap)
{
  thr_plan p = plan_begin(path_make(3), THR_ENDS_ANY, 1, THR_TURN_ANGLE);
  add_cord(&p, (int[]){0, 1, 2, -1});
  state(&p);
  ck_assert_double_eq(p.turning.price, 0);
  p.turning.gap = 0;
  assert_holds(&p);
  p.turning.gap = 1;
  assert_violated(&p, "gap");
  p.turning.gap = 0;
  p.turning.price = p.turning.largest = 5e-10; /* rounding */
  assert_holds(&p);
  thr_plan_destroy(&p);
}
END_TEST

/* The limit must let in what the options allow, by the length that is proved. */
START_TEST(limits_let_in_what_the_options_allow)
{
  thr_plan p = bend_make(1, THR_TURN_ANGLE, (int64_t)1 << THR_TURNING_BITS);
  state(&p);
  p.options.turning.length_slack = 0.5;
  assert_holds(&p); /* the claim is about plans of any length */
  p.turning.length_limit = 3;
  ck_assert_int_eq(thr_check_turning_claim(&p, 2, NULL),
                   THR_EVIOLATED); /* nothing says that 2 is the least */
  p.proof.present = true;
  static const struct {
    double limit, least;
    bool holds;
  } cases[] = {{3, 2, true},         {4, 2, true},  {3 - 1e-11, 2, true},
               {3 - 1e-9, 2, false}, {2, 2, false}, {3, 1, true},
               {3, 2.1, false},      {0, 2, false}, {-1, 2, true}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_err err = {0};
    p.turning.length_limit = cases[i].limit;
    ck_assert_int_eq(thr_check_turning_claim(&p, cases[i].least, &err),
                     cases[i].holds ? THR_OK : THR_EVIOLATED);
    if (!cases[i].holds) assert_one_line(&err, "shuts out");
  }
  thr_err err = {0};
  p.turning.length_limit = 0; /* lets in all plans of length 0, but not the cords */
  assert_status(thr_check_turning_claim(&p, 0, &err), THR_EVIOLATED, &err, "2 long");
  thr_certificate c = {.scale = 1, .denominator = 1}; /* every edge once: 2 */
  p.proof = (thr_length_proof){
      .present = true, .optimal = true, .lower_bound = 2, .n_certificates = 1, .certificate = &c};
  for (p.turning.length_limit = 2; p.turning.length_limit <= 3; p.turning.length_limit++) {
    assert_status(thr_check_plan(&p, &err), p.turning.length_limit < 3 ? THR_EVIOLATED : THR_OK,
                  &err, "shuts out");
  }
  p.proof = (thr_length_proof){0};
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("checker of turning");
  ADD_TEST(s, 10, turns_are_added_up);
  ADD_TEST(s, 10, cords_turn_back_only_at_nodes_with_one_edge);
  ADD_TEST(s, 10, cords_are_of_the_kind_that_the_proof_is_about);
  ADD_TEST(s, 10, nothing_turns_where_cords_end);
  ADD_TEST(s, 10, no_cords_turn_nothing);
  ADD_TEST(s, 10, many_passes_turn_back);
  ADD_TEST(s, 10, bends_prove_what_they_cost);
  ADD_TEST(s, 10, bounds_are_optimal_within_rounding);
  ADD_TEST(s, 10, no_tree_proves_more_than_the_plan_turns);
  ADD_TEST(s, 10, rounding_is_that_of_twice_the_passes_needed);
  ADD_TEST(s, 10, limits_on_the_length_prove_turns);
  ADD_TEST(s, 10, a_limit_just_below_the_cords_proves_nothing);
  ADD_TEST(s, 10, branches_on_one_turn_narrow_it);
  ADD_TEST(s, 10, ends_are_where_the_options_allow_them);
  ADD_TEST(s, 10, closed_cords_turn_round);
  ADD_TEST(s, 10, steps_begin_at_a_quarter_less_a_millionth);
  ADD_TEST(s, 10, steps_have_one_definition);
  ADD_TEST(s, 10, every_number_of_a_claim_counts);
  ADD_TEST(s, 10, an_optimal_claim_states_its_price);
  ADD_TEST(s, 10, a_price_of_nothing_has_no_gap);
  ADD_TEST(s, 10, limits_let_in_what_the_options_allow);
  return run_suite(s);
}
