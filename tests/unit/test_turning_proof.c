/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Multipliers, trees and tasks that are no proof, or none that is allowed. */
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The square with a diagonal, and a triangle: two components. Closed cords, but end_allowed can be
 * set. */
typedef struct {
  thr_frame frame;
  thr_turning_task task;
  bool anywhere[7];
  thr_turning_dual dual;
  int64_t potential[16], ends[7];
  thr_turning_node node[5];
  int n_symmetries, symmetry[16];
} small;

static void small_make(small *s)
{
  static const double xyz[7][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
  static const int edge[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {4, 5}, {5, 6}, {6, 4}};
  *s = (small){.frame = frame_make(7, xyz, 8, edge, NULL, NULL),
               .task = {.cover = 1, .most_passes = 8, .cords = 1}};
  memset(s->anywhere, true, sizeof s->anywhere);
  s->task.extra_limit = -1;
  s->dual.potential = s->potential;
  s->dual.ends = s->ends;
}

static thr_status small_check(const small *s, thr_err *err)
{
  bool branches = s->node[0].low || s->node[0].high,
       twice = s->node[1].low > 2 || s->node[2].low > 2;
  thr_turning_dual dual = s->dual;
  thr_turning_proof p = {.n_nodes = twice      ? 5
                                    : branches ? 3
                                               : 1,
                         .n_duals = 1,
                         .n_ends = 2,
                         .n_symmetries = s->n_symmetries,
                         .node = (thr_turning_node *)s->node,
                         .symmetry = (int *)s->symmetry,
                         .dual = &dual};
  double bound;
  *err = (thr_err){0};
  thr_status st = thr_turning_proof_check(&s->frame, &s->task, &p, &bound, err);
  if (st) ck_assert_double_eq(bound, 0);
  return st;
}

static void assert_small(const small *s, const char *word)
{
  thr_err err;
  thr_status st = small_check(s, &err);
  if (!word) {
    assert_ok(st, &err);
    return;
  }
  ck_assert_msg(st == THR_EVIOLATED, "%s: %s", word, err.text);
  assert_one_line(&err, word);
}

/* One set, as an odd set and as a group. */
START_TEST(sets_that_prove_nothing)
{
  static const struct {
    int n, member[8];
    int64_t value;
    const char *odd, *group;
  } set[] = {
      {1, {0}, 0, NULL, NULL},
      {1, {0}, 1, NULL, NULL},
      {1, {0}, -1, "negative", "negative"},
      {0, {0}, 1, "empty", "empty"},
      {1, {-1}, 1, "out of range", "out of range"},
      {1, {7}, 1, NULL, NULL},
      {1, {8}, 1, NULL, "out of range"},
      {1, {15}, 1, NULL, "out of range"},
      {1, {16}, 1, "even", "out of range"}, /* the ends of a component, of which there are none */
      {2, {0, 17}, 1, NULL, "out of range"},
      {1, {18}, 1, "out of range", "out of range"},
      {2, {0, 1}, 1, "even", NULL},
      {3, {0, 2, 1}, 1, "out of order", "out of order"},
      {3, {0, 0, 1}, 1, "out of order", "out of order"},
      {3, {0, 1, 2}, 1, NULL, NULL},
      {2, {0, 5}, 1, "even", "two components"},
      {2, {5, 6}, 1, "even", NULL},
      {3, {5, 6, 7}, 1, NULL, "a whole component"},
      {5, {0, 1, 2, 3, 4}, 1, NULL, "a whole component"},
      {4, {0, 1, 2, 3}, 1, "even", NULL},
  };
  small s;
  small_make(&s);
  for (size_t i = 0; i < sizeof set / sizeof *set; i++) {
    thr_turning_set one = {set[i].n, (int *)set[i].member, set[i].value};
    s.dual.odd = &one, s.dual.n_odd = 1;
    assert_small(&s, set[i].odd);
    s.dual.n_odd = 0, s.dual.group = &one, s.dual.n_groups = 1;
    assert_small(&s, set[i].group);
    s.task.cords = 2; /* one of them may be all that is in the group */
    if (!set[i].group) assert_small(&s, "several closed cords");
    s.task.end_allowed = s.anywhere;
    if (!set[i].group || strstr("a whole component, two components", set[i].group))
      assert_small(&s, NULL);
    s.task.end_allowed = NULL, s.task.cords = 1, s.dual.n_groups = 0;
  }
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(partitions_that_prove_nothing)
{
  static const struct {
    int block[8];
    int64_t value;
    const char *word;
  } partition[] = {
      {{0, 0, 0, 0, 0, 1, 1, 1}, 1, NULL},
      {{0, 0, 0, 0, 0, 1, 1, 1}, 0, NULL},
      {{0, 0, 0, 0, 0, 1, 1, 1}, -1, "negative"},
      {{0, 1, 2, 3, 4, 5, 6, 7}, 1, NULL},
      {{7, 6, 5, 4, 3, 2, 1, 0}, 1, NULL},
      {{0, 1, 2, 3, 4, 5, 6, 8}, 1, "bad block numbers"},
      {{0, 1, 2, 3, 4, 5, 6, -1}, 1, "bad block numbers"},
      {{-1, 0, 0, 0, 0, 1, 1, 1}, 1, "bad block numbers"},
      {{1, 1, 1, 1, 1, 2, 2, 2}, 1, "bad block numbers"},
      {{0, 0, 0, 0, 0, 2, 2, 2}, 1, "bad block numbers"},
      {{0, 0, 0, 0, 0, 0, 0, 0}, 1, "bad block numbers"},
      {{0, 0, 0, 0, 1, 1, 2, 2}, 1, "bad block numbers"},
  };
  small s;
  small_make(&s);
  for (size_t i = 0; i < sizeof partition / sizeof *partition; i++) {
    thr_turning_partition one = {(int *)partition[i].block, partition[i].value};
    for (int rank = 0; rank < 2; rank++) {
      s.dual.partition = s.dual.rank = &one, s.dual.n_partitions = !rank, s.dual.n_ranks = rank;
      assert_small(&s, partition[i].word);
      s.task.end_allowed = s.anywhere;
      assert_small(&s, partition[i].value < 0 ? "negative" : "closed cords only");
      s.task.end_allowed = NULL;
    }
  }
  thr_turning_columns c; /* 5 blocks of one component and 3 of the other: 4 + 2 connections,
                            whatever the room held before */
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &s.task, NULL), THR_OK);
  int scratch[10];
  for (int i = 0; i < 10; i++)
    scratch[i] = 1000;
  ck_assert_int_eq(thr_turning_connections(&c, (int[]){0, 1, 2, 3, 4, 5, 6, 7}, scratch), 6);
  thr_turning_columns_destroy(&c);
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(junctions_that_prove_nothing)
{
  static const struct {
    int node, block[3];
    int64_t value;
    const char *word;
  } junction[] = {
      {0, {0, 1, 2}, 1, NULL},
      {0, {2, 1, 0}, 0, NULL},
      {6, {0, 1, 0}, 1, NULL},
      {0, {0, 0, 0}, 1, NULL},
      {0, {0, 1, 2}, -1, "negative"},
      {-1, {0, 1, 2}, 1, "no node"},
      {7, {0, 1, 2}, 1, "no node"},
      {0, {0, 1, 3}, 1, "bad block numbers"},
      {0, {0, 1, -1}, 1, "bad block numbers"},
      {0, {1, 1, 2}, 1, "bad block numbers"},
      {0, {0, 2, 2}, 1, "bad block numbers"},
      {0, {0, 0, 2}, 1, "bad block numbers"},
      {1, {0, 2, 0}, 1, "bad block numbers"},
      {0, {-1, 0, 1}, 1, "bad block numbers"},
      {0, {3, 0, 1}, 1, "bad block numbers"},
  };
  small s;
  small_make(&s);
  for (size_t i = 0; i < sizeof junction / sizeof *junction; i++) {
    thr_turning_junction one = {junction[i].node, (int *)junction[i].block, junction[i].value};
    s.dual.junction = &one, s.dual.n_junctions = 1;
    s.task.tube = true;
    assert_small(&s, junction[i].word);
    s.task.tube = false;
    assert_small(&s, junction[i].value < 0 ? "negative" : "only tube joints");
  }
  thr_frame_destroy(&s.frame);
}
END_TEST

/* Multipliers of 2^58, and sets of 2^61 together, are the largest: no sum of them overflows. */
START_TEST(multipliers_that_are_too_large)
{
  const int64_t most = (int64_t)1 << 58;
  int member[1] = {0}, block[8] = {0, 0, 0, 0, 0, 1, 1, 1}, corner[3] = {0};
  thr_turning_set odd[1] = {{1, member, 2 * most}}, group[1] = {{1, member, 2 * most}};
  thr_turning_partition partition[1] = {{block, 2 * most}};
  thr_turning_junction junction[1] = {{0, corner, 2 * most}};
  small s;
  small_make(&s);
  s.task.tube = true;
  int64_t *const at[] = {&s.potential[0], &s.potential[15], &s.ends[0], &s.ends[1], &s.dual.length};
  for (int i = 0; i < 5; i++) {
    *at[i] = most;
    assert_small(&s, NULL);
    *at[i] = most + 1;
    assert_small(&s, "too large");
    *at[i] = -most;
    assert_small(&s, i < 4 ? NULL : "length negative");
    *at[i] = -most - 1;
    assert_small(&s, i < 4 ? "too large" : "length negative");
    *at[i] = 0;
  }
  s.dual.length = -1;
  assert_small(&s, "length negative");
  s.dual.length = 0;
  s.dual.odd = odd, s.dual.group = group, s.dual.partition = partition, s.dual.junction = junction;
  s.dual.n_odd = s.dual.n_groups = s.dual.n_partitions = s.dual.n_junctions = 1;
  assert_small(&s, NULL);
  int64_t *const sets[] = {&odd[0].value, &group[0].value, &partition[0].value, &junction[0].value};
  for (int i = 0; i < 4; i++) {
    ++*sets[i];
    assert_small(&s, "too large");
    --*sets[i];
  }
  thr_turning_partition rank[2] = {{block, most - 1}, {block, 1}}; /* ranks 2^58 together */
  s.dual.rank = rank, s.dual.n_ranks = 2;
  assert_small(&s, NULL);
  rank[1].value++;
  assert_small(&s, "too large");
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(trees_that_prove_nothing)
{
  small s;
  small_make(&s);
  s.task.most_passes = 3;
  s.node[0] = (thr_turning_node){.low = 1, .high = 2, .a = 0, .b = 1};
  assert_small(&s, NULL);
  static const struct {
    int a, b;
    const char *word;
  } branch[] = {{0, 1, NULL},       {1, 0, NULL},        {15, 14, NULL},     {0, 7, NULL},
                {0, 8, NULL},       {-1, 0, "nothing"},  {16, 0, "nothing"}, {0, 16, "nothing"},
                {0, -1, "nothing"}, {0, -2, "nothing"},  {0, 0, "nothing"},  {0, 2, "nothing"},
                {0, 12, "nothing"}, {15, 17, "nothing"}, {7, 7, "nothing"}};
  for (size_t i = 0; i < sizeof branch / sizeof *branch; i++) {
    s.node[0].a = branch[i].a, s.node[0].b = branch[i].b;
    assert_small(&s, branch[i].word);
  }
  s.node[0].a = 0, s.node[0].b = -1; /* an end, where one is allowed */
  s.task.end_allowed = s.anywhere;
  assert_small(&s, NULL);
  static const int beyond[][2] = {{16, 17}, {17, 16}, {16, -1}, {16, 0},
                                  {-1, -1}, {-1, -2}, {0, 16}};
  for (size_t i = 0; i < sizeof beyond / sizeof *beyond;
       i++) { /* numbers that half-edges after the last would have */
    s.node[0].a = beyond[i][0], s.node[0].b = beyond[i][1];
    assert_small(&s, "nothing");
  }
  s.node[0].a = 0, s.node[0].b = -1;
  s.anywhere[0] = false;
  assert_small(&s, "nothing");
  s.task.end_allowed = NULL;
  static const int child[][2] = {{1, 1}, {2, 2}, {0, 1}, {1, 0}, {1, 3}, {3, 2}, {-1, 2}, {2, -1}};
  for (size_t i = 0; i < sizeof child / sizeof *child; i++) {
    s.node[0] = (thr_turning_node){.low = child[i][0], .high = child[i][1], .a = 0, .b = 1};
    assert_small(&s, "bad child");
  }
  s.node[0] = (thr_turning_node){.low = 1, .high = 2, .a = 0, .b = 1};
  for (int i = 1; i < 3; i++) {
    s.node[i].dual = 1;
    assert_small(&s, "no multipliers");
    s.node[i].dual = -1;
    assert_small(&s, "no multipliers");
    s.node[i].dual = 0;
  }
  s.node[1] = (thr_turning_node){.low = 2, .high = 2, .a = 0, .b = 1};
  assert_small(&s, "bad child");
  thr_frame_destroy(&s.frame);
}
END_TEST

/* Edges 0 .. 3 run round the square, edge 4 across it; its half turn swaps 0 with 2 and 1 with 3,
 * and turns 4 round. */
static const int half_turn[8] = {4, 6, 0, 2, 9, 10, 12, 14};

START_TEST(symmetries_that_map_no_plans_to_plans)
{
  small s;
  small_make(&s);
  s.n_symmetries = 1;
  memcpy(s.symmetry, half_turn, sizeof half_turn);
  assert_small(&s, NULL);
  static const struct {
    int edge, image;
  } wrong[] = {{0, -1}, {0, 16}, {0, 5}, {0, 6}, {4, 8}, {4, 0}, {5, 11}, {5, 12}, {7, 0}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    s.symmetry[wrong[i].edge] = wrong[i].image;
    assert_small(&s, "plans to plans");
    s.symmetry[wrong[i].edge] = half_turn[wrong[i].edge];
  }
  int cover[8] = {1, 1, 2, 1, 1, 1, 1, 1}, capacity[8] = {0, 0, 3, 0, 0, 0, 0, 0};
  s.frame.cover = cover;
  assert_small(&s, "plans to plans");
  s.frame.cover = NULL;
  s.frame.capacity = capacity;
  assert_small(&s, "plans to plans");
  s.frame.capacity = NULL;
  s.task.end_allowed = s.anywhere;
  assert_small(&s, NULL);
  s.anywhere[2] = false;
  assert_small(&s, "plans to plans");
  s.task.end_allowed = NULL;
  const int square_to_triangle[8] = {10, 12, 14, 0, 2, 4, 6, 8};
  memcpy(s.symmetry, square_to_triangle, sizeof square_to_triangle);
  assert_small(&s, "plans to plans");
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(orbits_that_hide_plans)
{
  small s;
  int first[2] = {0, 0}, second[1] = {0};
  small_make(&s);
  s.n_symmetries = 1;
  memcpy(s.symmetry, half_turn, sizeof half_turn);
  s.node[0] = (thr_turning_node){.low = 1, .high = 2, .a = 0, .b = 1, .n_orbit = 1, .orbit = first};
  assert_small(&s, NULL);
  s.node[0].n_orbit = 2; /* twice the same: no harm */
  assert_small(&s, NULL);
  first[1] = 1;
  assert_small(&s, "no symmetry 1");
  first[1] = -1;
  assert_small(&s, "no symmetry -1");
  s.node[0].n_orbit = 1;
  s.node[2].n_orbit = 1; /* a leaf decides nothing */
  s.node[2].orbit = second;
  assert_small(&s, "an orbit");
  s.node[2] = (thr_turning_node){0};
  s.node[1] =
      (thr_turning_node){.low = 3, .high = 4, .a = 2, .b = 3, .n_orbit = 1, .orbit = second};
  assert_small(&s, NULL); /* edges 0 and 2 have no extra pass: the half turn keeps that */
  s.node[0].n_orbit = 0;
  assert_small(&s, "does not keep");
  s.node[0].a = 8, s.node[0].b = 9; /* edge 4 is its own image */
  assert_small(&s, NULL);
  s.node[2] = s.node[1]; /* below the other side */
  s.node[1] = (thr_turning_node){0};
  assert_small(&s, NULL);
  s.node[0].a = 0, s.node[0].b = 1, s.node[0].n_orbit = 1; /* edge 0 alone has an extra pass */
  assert_small(&s, "does not keep");
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(proofs_of_another_shape)
{
  small s;
  thr_err err = {0};
  double bound;
  small_make(&s);
  static const struct {
    int n_nodes, n_ends;
    bool potential, ends;
    const char *word;
  } shape[] = {{1, 1, true, true, "sums of ends"},    {1, 3, true, true, "sums of ends"},
               {0, 2, true, true, "no tree"},         {2, 2, true, true, "hangs nowhere"},
               {1, 2, false, true, "no multipliers"}, {1, 2, true, false, "no multipliers"}};
  for (size_t i = 0; i < sizeof shape / sizeof *shape; i++) {
    thr_turning_dual dual = {.potential = shape[i].potential ? s.potential : NULL,
                             .ends = shape[i].ends ? s.ends : NULL};
    thr_turning_proof p = {.n_nodes = shape[i].n_nodes,
                           .n_duals = 1,
                           .n_ends = shape[i].n_ends,
                           .node = s.node,
                           .dual = &dual};
    assert_status(thr_turning_proof_check(&s.frame, &s.task, &p, &bound, &err), THR_EVIOLATED, &err,
                  shape[i].word);
  }
  thr_turning_set bad = {0, NULL, 1}; /* an empty set, in multipliers that no leaf has */
  thr_turning_dual dual[2] = {s.dual, s.dual};
  thr_turning_proof nothing = {
      .n_nodes = 1, .n_duals = 2, .n_ends = 2, .node = s.node, .dual = dual};
  thr_turning_columns c;
  dual[1].odd = &bad, dual[1].n_odd = 1;
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &s.task, NULL), THR_OK);
  bound = 7; /* nothing is left over from before */
  ck_assert_int_eq(thr_turning_proof_check_columns(&c, &nothing, &bound, NULL, NULL), THR_OK);
  ck_assert_double_eq(bound, 0);
  thr_turning_columns_destroy(&c);
  s.task.cords = 0, bound = 7;
  ck_assert_int_eq(thr_turning_proof_check(&s.frame, &s.task, &nothing, &bound, NULL), THR_EINPUT);
  ck_assert_double_eq(bound, 0);
  thr_frame_destroy(&s.frame);
}
END_TEST

START_TEST(tasks_out_of_range)
{
  small s;
  thr_turning_columns c;
  small_make(&s);
  const thr_turning_task good = {
      .cover = 1, .most_passes = 1000000, .cords = 1000000, .cords_least = 1000000};
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &good, NULL), THR_OK);
  ck_assert_int_eq(c.extra_limit, 1); /* a limit of 0, rounded up */
  thr_turning_columns_destroy(&c);
  thr_turning_task bad[] = {good, good, good, good, good, good, good, good, good, good, good, good};
  bad[0].cover = 0;
  bad[1].most_passes = 0;
  bad[2].most_passes++;
  bad[3].cords++;
  bad[4].cords = bad[4].cords_least = 0;
  bad[5].cords_least++;
  bad[6].cords_least = -1;
  bad[7].capacity = -1;
  bad[8].price_per_length = -1e-9;
  bad[9].price_per_length = INFINITY;
  bad[10].extra_limit = INFINITY;
  bad[11].price_per_length = 1e4;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_err err = {0};
    assert_status(thr_turning_columns_init(&c, &s.frame, &bad[i], &err), THR_EINPUT, &err, NULL);
    ck_assert_ptr_null(c.weight);
  }
  thr_turning_task dear = good; /* one edge, at a price of 10000 */
  dear.price_per_length = 1e4;
  for (int e = 0; e < s.frame.n_edges; e++) {
    for (int k = 0; k < s.frame.n_edges; k++)
      s.frame.length[k] = k == e ? 1 : 0.5;
    ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &dear, NULL), THR_EINPUT);
    s.frame.length[e] = nextafter(1, 0);
    ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &dear, NULL), THR_OK);
    thr_turning_columns_destroy(&c);
  }
  thr_turning_task full = good;
  full.cover = full.capacity = 2;
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &full, NULL), THR_OK);
  thr_turning_columns_destroy(&c);
  full.cover = 3;
  ck_assert_int_eq(thr_turning_columns_init(&c, &s.frame, &full, NULL), THR_EINFEASIBLE);
  thr_frame_destroy(&s.frame);
  thr_err err = {0};
  thr_frame hub = star_make(50000); /* 1.2e9 turns */
  assert_status(thr_turning_columns_init(&c, &hub, &good, &err), THR_EINPUT, &err,
                "possible turns at the nodes");
  thr_frame_destroy(&hub);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("what is no proof of turning");
  ADD_TEST(s, 20, sets_that_prove_nothing);
  ADD_TEST(s, 20, partitions_that_prove_nothing);
  ADD_TEST(s, 20, junctions_that_prove_nothing);
  ADD_TEST(s, 20, multipliers_that_are_too_large);
  ADD_TEST(s, 20, trees_that_prove_nothing);
  ADD_TEST(s, 20, symmetries_that_map_no_plans_to_plans);
  ADD_TEST(s, 20, orbits_that_hide_plans);
  ADD_TEST(s, 20, proofs_of_another_shape);
  ADD_TEST(s, 20, tasks_out_of_range);
  return run_suite(s);
}
