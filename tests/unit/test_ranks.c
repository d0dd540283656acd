/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Connections counted exactly at nodes: forests against all sets of turns, and what they prove of a
 * sphere. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "tests/support.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- one node ---- */

typedef struct {
  thr_rank_node node;
  int64_t value[3];
  int block[3][THR_RANK_DEGREE];
} example;

static void example_make(rng *r, example *x)
{
  *x = (example){.node = {.degree = rng_between(r, 2, 5), .n_rows = rng_below(r, 4)}};
  x->node.value = x->value;
  x->node.block = x->block;
  for (int a = 0; a < x->node.degree; a++)
    for (int b = 0; b < a; b++)
      x->node.price[a][b] = x->node.price[b][a] = rng_below(r, 12);
  for (int i = 0; i < 3; i++) {
    x->value[i] = rng_below(r, 9);
    for (int a = 0; a < x->node.degree; a++)
      x->block[i][a] = 7 * rng_below(r, x->node.degree);
  }
}

/* Sets that n things fall into when those that are marked are together; the marks are completed. */
static int count_sets(bool (*together)[THR_RANK_DEGREE], int n)
{
  int sets = 0;
  for (int by = 0; by < n; by++)
    for (int a = 0; a < n; a++)
      for (int b = 0; b < n; b++)
        together[a][b] |= together[a][by] && together[by][b];
  for (int a = 0; a < n; a++) {
    bool first = true;
    for (int b = 0; b < a; b++)
      first &= !together[a][b];
    sets += first;
  }
  return sets;
}

/* The rank by its definition, for the turns whose bits are set, numbered as pairs a < b. */
static int rank_by_definition(const example *x, int row, int turns)
{
  bool together[THR_RANK_DEGREE][THR_RANK_DEGREE] = {{false}};
  int n = x->node.degree, pair = 0;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++)
      together[a][b] = x->block[row][a] == x->block[row][b];
  int blocks = count_sets(together, n);
  for (int a = 0; a < n; a++)
    for (int b = a + 1; b < n; b++, pair++)
      if (turns >> pair & 1) together[a][b] = together[b][a] = true;
  return blocks - count_sets(together, n);
}

static int64_t least_by_trying(const example *x)
{
  int n = x->node.degree;
  int64_t least = INT64_MAX;
  for (int turns = 0; turns < 1 << n * (n - 1) / 2; turns++) {
    int64_t price = 0;
    int pair = 0, reached = 0;
    for (int a = 0; a < n; a++)
      for (int b = a + 1; b < n; b++, pair++)
        if (turns >> pair & 1) {
          price += x->node.price[a][b];
          reached |= 1 << a | 1 << b;
        }
    if (reached != (1 << n) - 1) continue;
    for (int i = 0; i < x->node.n_rows; i++)
      price -= x->value[i] * rank_by_definition(x, i, turns);
    if (price < least) least = price;
  }
  return least;
}

START_TEST(a_forest_is_the_least_of_all_turns)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int round = 0; round < 25; round++) {
    example x;
    thr_rank_turns turns;
    example_make(&r, &x);
    int64_t least = thr_rank_least(&x.node, &turns), price = 0;
    ck_assert_int_eq(least, least_by_trying(&x));
    ck_assert_int_eq(least, thr_rank_least(&x.node, NULL));
    for (int i = 0; i < turns.n_turns; i++)
      price += x.node.price[turns.turn[i][0]][turns.turn[i][1]];
    for (int i = 0; i < x.node.n_rows; i++)
      price -= x.value[i] * thr_rank_of(&x.node, i, &turns);
    ck_assert_int_eq(price, least);
  }
}
END_TEST

/* The largest numbers that a proof may have, at the largest node: sums stay in 64 bits. */
START_TEST(the_largest_numbers_fit)
{
  example x = {.node = {.degree = THR_RANK_DEGREE, .n_rows = 1}, .value = {INT64_C(1) << 58}};
  x.node.value = x.value;
  x.node.block = x.block;
  for (int a = 0; a < THR_RANK_DEGREE; a++) {
    x.block[0][a] = a;
    for (int b = 0; b < THR_RANK_DEGREE; b++)
      x.node.price[a][b] = INT64_C(1) << 58;
  }
  ck_assert_int_eq(thr_rank_least(&x.node, NULL), 0); /* a tree gains what it costs */
  x.value[0] = 0;
  ck_assert_int_eq(thr_rank_least(&x.node, NULL), INT64_C(1) << 60); /* four turns */
}
END_TEST

/* ---- a framework ---- */

typedef struct {
  thr_frame frame;
  thr_turning_task task;
  thr_turning_columns c;
  int *x;
  thr_turning_dual from, dual;
} shell;

/* The sphere of 120 edges, and its matching without connectedness. */
static void shell_make(shell *s, int cords)
{
  thr_limits none = {0};
  thr_pass_matching passes;
  thr_draft draft = {0};
  thr_read_report report;
  *s = (shell){.task = {.cover = 1, .most_passes = 8, .cords = cords, .extra_limit = -1}};
  thr_make_options make = thr_make_options_default(THR_MAKE_SPHERE);
  make.size = 2;
  ck_assert_int_eq(thr_make(&draft, &make, NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&draft, -1, &s->frame, &report, NULL), THR_OK);
  thr_draft_destroy(&draft);
  ck_assert_int_eq(thr_turning_columns_init(&s->c, &s->frame, &s->task, NULL), THR_OK);
  s->x = calloc((size_t)s->c.n_columns, sizeof *s->x);
  ck_assert_int_eq(thr_turning_dual_init(&s->from, &s->c, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_dual_init(&s->dual, &s->c, NULL), THR_OK);
  ck_assert_int_eq(thr_pass_matching_init(&passes, &s->c, NULL), THR_OK);
  ck_assert_int_eq(thr_pass_matching_solve(&passes, s->c.weight, &none, s->x, &s->from, NULL),
                   THR_OK);
  thr_pass_matching_destroy(&passes);
}

static void shell_destroy(shell *s)
{
  thr_turning_dual_destroy(&s->from);
  thr_turning_dual_destroy(&s->dual);
  thr_turning_columns_destroy(&s->c);
  thr_frame_destroy(&s->frame);
  free(s->x);
}

static double degrees(int64_t units)
{
  return ldexp((double)units, -THR_TURNING_BITS) * 180 / acos(-1);
}

/* ---- with symmetries ---- */

static int third_node(const thr_frame *f, int a, int b)
{
  for (int i = f->first[a]; i < f->first[a + 1]; i++)
    for (int k = f->first[b]; k < f->first[b + 1]; k++)
      if (thr_head(f, f->half[i]) == thr_head(f, f->half[k])) return thr_head(f, f->half[i]);
  ck_abort();
}

static void columns_of(const thr_frame *f, const int *node, double at[3][3])
{
  for (int i = 0; i < 3; i++)
    memcpy(at[i], f->xyz[node[i]], sizeof at[i]);
}

/* x = sum of t_i a_i; t by Cramer's rule. The three nodes and the centre of the sphere are in no
 * plane. */
static void coordinates(double a[3][3], const double *x, double *t)
{
#define DET(p, q, r)                                                                               \
  ((p)[0] * ((q)[1] * (r)[2] - (q)[2] * (r)[1]) - (p)[1] * ((q)[0] * (r)[2] - (q)[2] * (r)[0]) +   \
   (p)[2] * ((q)[0] * (r)[1] - (q)[1] * (r)[0]))
  const double all = DET(a[0], a[1], a[2]);
  t[0] = DET(x, a[1], a[2]) / all;
  t[1] = DET(a[0], x, a[2]) / all;
  t[2] = DET(a[0], a[1], x) / all;
#undef DET
}

static int node_at(const thr_frame *f, const double *x)
{
  for (int v = 0; v < f->n_nodes; v++)
    if (fabs(f->xyz[v][0] - x[0]) + fabs(f->xyz[v][1] - x[1]) + fabs(f->xyz[v][2] - x[2]) < 1e-6)
      return v;
  return -1;
}

static double apart(const double *a, const double *b)
{
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
              (a[2] - b[2]) * (a[2] - b[2]));
}

/* The images of all nodes when three are sent to three others; false: that is no motion onto
 * itself. */
static bool send(const thr_frame *f, const int *from, const int *to, int *image)
{
  double a[3][3], b[3][3];
  columns_of(f, from, a);
  columns_of(f, to, b);
  for (int i = 0; i < 3; i++)
    if (fabs(apart(a[i], a[(i + 1) % 3]) - apart(b[i], b[(i + 1) % 3])) > 1e-6) return false;
  for (int v = 0; v < f->n_nodes; v++) {
    double t[3], x[3];
    coordinates(a, f->xyz[v], t);
    for (int k = 0; k < 3; k++)
      x[k] = t[0] * b[0][k] + t[1] * b[1][k] + t[2] * b[2][k];
    if ((image[v] = node_at(f, x)) < 0) return false;
  }
  return true;
}

/* All motions of the framework onto itself: those that send three nodes of a triangle to three of
 * another, tried one by one. */
static thr_status all_motions(const thr_frame *f, const thr_limits *limits, int **image, int *n,
                              thr_err *err)
{
  (void)limits;
  (void)err;
  const size_t nodes = (size_t)f->n_nodes;
  *n = 0;
  ck_assert_ptr_nonnull(*image = calloc(500 * nodes, sizeof **image));
  const int a = f->edge[0][0], b = f->edge[0][1], c = third_node(f, a, b);
  for (int p = 0; p < f->n_nodes; p++)
    for (int q = 0; q < f->n_nodes; q++)
      for (int r = 0; r < f->n_nodes && *n < 500; r++)
        *n += send(f, (const int[]){a, b, c}, (const int[]){p, q, r}, *image + (size_t)*n * nodes);
  return THR_OK;
}

static double bound_by_orbits(shell *s, thr_orbits_motions *motions)
{
  const thr_limits none = {0};
  thr_orbits orbits;
  int64_t bound = 0;
  bool found;
  thr_turning_dual_destroy(&s->dual);
  ck_assert_int_eq(thr_orbits_init(&orbits, &s->c, motions, &none, NULL), THR_OK);
  ck_assert_int_eq(thr_orbit_ranks(&s->c, &orbits, s->x, &none, &s->dual, &found, NULL), THR_OK);
  if (found)
    ck_assert_int_eq(thr_turning_dual_bound(&s->c, &s->dual, NULL, NULL, &bound, NULL), THR_OK);
  ck_assert_int_eq(found, motions != NULL);
  thr_orbits_destroy(&orbits);
  return degrees(bound);
}

/* The optimum of the linear programme over all turns that the nodes may have, made symmetric by the
 * same motions, with the rank of the circuits and the groups that they are, is 5311.143037 degrees
 * (HiGHS). */
START_TEST(orbits_prove_what_the_linear_programme_does)
{
  shell s;
  shell_make(&s, 1);
  ck_assert_double_eq_tol(bound_by_orbits(&s, all_motions), 5311.143037, 1e-4);
  ck_assert_int_eq(s.dual.n_ranks, 1);
  ck_assert_int_eq(s.dual.n_groups,
                   6); /* the great circles; the rest of the edges as a group proves nothing */
  ck_assert_double_eq(bound_by_orbits(&s, NULL), 0);
  shell_destroy(&s);
}
END_TEST

/* Wherever the clock stops the cutting planes, what they have proved so far is a proof that the
 * checker takes: multipliers of rows that are not equations are not negative, however little. */
START_TEST(stopped_at_any_round_the_proof_holds)
{
  enum { MOST_ROUNDS = 60 };
  const double round = 1e-5; /* s of work that one question to the limits counts as */
  const thr_limits none = {0};
  thr_orbits orbits;
  shell s;
  shell_make(&s, 1);
  ck_assert_int_eq(thr_orbits_init(&orbits, &s.c, all_motions, &none, NULL), THR_OK);
  for (int rounds = 1; rounds <= MOST_ROUNDS; rounds++) {
    double work = (rounds + 0.5) * round;
    const thr_limits some = thr_limits_counted(&none, &work);
    bool found;
    int64_t bound;
    thr_err err = {0};
    thr_turning_dual_destroy(&s.dual);
    ck_assert_int_eq(thr_orbit_ranks(&s.c, &orbits, s.x, &some, &s.dual, &found, NULL), THR_OK);
    if (!found) continue;
    ck_assert_msg(thr_turning_dual_bound(&s.c, &s.dual, NULL, NULL, &bound, &err) == THR_OK,
                  "%d rounds: %s", rounds, err.text);
    for (int i = 0; i < s.dual.n_ranks; i++)
      ck_assert_int_ge(s.dual.rank[i].value, 0);
  }
  thr_orbits_destroy(&orbits);
  shell_destroy(&s);
}
END_TEST

/* Multipliers that the checker refuses end no search: the node keeps those that it had, or
 * multipliers of 0. */
START_TEST(a_search_drops_multipliers_that_do_not_hold)
{
  const thr_limits none = {0};
  shell s;
  thr_branch branch;
  thr_turning_dual wrong;
  shell_make(&s, 1);
  for (int first = 0; first < 2; first++) {
    ck_assert_int_eq(thr_branch_init(&branch, &s.c, 1, &none, NULL), THR_OK);
    ck_assert_int_eq((first ? thr_branch_init_tree : thr_branch_begin)(&branch, NULL), THR_OK);
    const double before = branch.tree.node[0].bound;
    ck_assert_int_eq(thr_turning_dual_init(&wrong, &s.c, NULL), THR_OK);
    wrong.rank = calloc(1, sizeof *wrong.rank);
    wrong.rank[0] =
        (thr_turning_partition){calloc((size_t)s.frame.n_edges, sizeof *wrong.rank->block), -1};
    wrong.n_ranks = 1;
    ck_assert_int_eq(thr_branch_keep_dual(&branch, 0, wrong, NULL, NULL, NULL), THR_OK);
    ck_assert_int_ge(branch.tree.node[0].proof, 0);
    ck_assert_double_eq(branch.tree.node[0].bound, first ? 0 : before);
    thr_branch_destroy(&branch);
  }
  shell_destroy(&s);
}
END_TEST

START_TEST(orbits_without_memory_fail)
{
  const thr_limits none = {0};
  thr_orbits orbits;
  thr_status st = THR_ENOMEM;
  shell s;
  shell_make(&s, 1);
  ck_assert_int_eq(thr_orbits_init(&orbits, &s.c, all_motions, &none, NULL), THR_OK);
  for (long k = 1; st != THR_OK; k++) {
    const thr_limits past = {.deadline = 1e-9};
    bool found;
    thr_turning_dual_destroy(&s.dual);
    thr_alloc_fail_at(k);
    st = thr_orbit_ranks(&s.c, &orbits, s.x, &past, &s.dual, &found, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || st == THR_ENOMEM);
  }
  thr_orbits_destroy(&orbits);
  shell_destroy(&s);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("ranks of nodes");
  ADD_EXAMPLES(s, 20, a_forest_is_the_least_of_all_turns, 20);
  ADD_TEST(s, 20, the_largest_numbers_fit);
  ADD_TEST(s, 60, orbits_prove_what_the_linear_programme_does);
  ADD_TEST(s, 60, stopped_at_any_round_the_proof_holds);
  ADD_TEST(s, 60, a_search_drops_multipliers_that_do_not_hold);
  ADD_TEST(s, 60, orbits_without_memory_fail);
  return run_suite(s);
}
