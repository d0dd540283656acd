/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/matchings.h"
#include "graph/limits.h"

#include <math.h>
#include <stdlib.h>

__extension__ typedef __int128 wide;

thr_matching_problem view(const instance *g)
{
  return (thr_matching_problem){g->n_nodes, g->n_edges, g->edge, g->weight};
}

void join(instance *g, int u, int v, int64_t weight)
{
  ck_assert_int_lt(g->n_edges, INSTANCE_EDGES);
  g->edge[g->n_edges][0] = u;
  g->edge[g->n_edges][1] = v;
  g->weight[g->n_edges++] = weight;
}

int64_t random_weight(rng *r, int64_t most)
{
  int64_t w = (int64_t)(rng_unit(r) * ((double)most + 1));
  return w > most ? most : w;
}

void join_pairs(instance *g, rng *r, int64_t most)
{
  int *order = calloc((size_t)g->n_nodes, sizeof *order);
  for (int v = 0; v < g->n_nodes; v++)
    order[v] = v;
  rng_shuffle(r, order, g->n_nodes);
  for (int v = 0; v < g->n_nodes; v += 2)
    join(g, order[v], order[v + 1], random_weight(r, most));
  free(order);
}

void join_randomly(instance *g, rng *r, int n_edges, int64_t most)
{
  for (int e = 0; e < n_edges; e++) {
    int u = rng_below(r, g->n_nodes), v = rng_below(r, g->n_nodes - 1);
    join(g, u, v + (v >= u), random_weight(r, most));
  }
}

/* ---- the proof ---- */

/* Each of these says what is wrong, or NULL: one assertion for all, as Check notes each in a pipe.
 */
static const char *fault_of_pairs(const instance *g, const thr_matching *m)
{
  int64_t twice = 0;
  for (int v = 0; v < g->n_nodes; v++) {
    int mate = m->mate[v], e = m->mate_edge[v];
    if (mate < 0 || mate >= g->n_nodes || e < 0 || e >= g->n_edges)
      return "mate or edge out of range";
    if (m->mate[mate] != v || m->mate_edge[mate] != e) return "not each other's mates";
    if (g->edge[e][0] != v && g->edge[e][1] != v) return "mated by another's edge";
    if (g->edge[e][0] != mate && g->edge[e][1] != mate) return "mated by an edge to another";
    twice += g->weight[e];
  }
  return twice == 2 * m->weight ? NULL : "not the weight";
}

static const char *fault_of_sets(const instance *g, const thr_matching *m, int *depth)
{
  int *size = calloc((size_t)m->n_blossoms + 1, sizeof *size);
  const char *fault = NULL;
  for (int v = 0; v < g->n_nodes && !fault; v++) {
    int b = m->node_blossom[v];
    if (b < -1 || b >= m->n_blossoms) fault = "a node in a blossom that is none";
    if (b >= 0 && !fault) size[b]++;
  }
  for (int b = 0; b < m->n_blossoms && !fault; b++) {
    int parent = m->blossom_parent[b];
    if (m->blossom_dual[b] <= 0) fault = "a blossom without a dual";
    if (size[b] % 2 == 0 || size[b] < 3) fault = "a blossom that is not odd";
    if (parent != -1 && (parent <= b || parent >= m->n_blossoms))
      fault = "not children before parents";
    if (parent >= 0 && !fault) size[parent] += size[b];
  }
  for (int b = m->n_blossoms - 1; b >= 0 && !fault; b--)
    depth[b] = m->blossom_parent[b] < 0 ? 1 : depth[m->blossom_parent[b]] + 1;
  free(size);
  return fault;
}

/* What the blossoms that an edge leaves load it with; counts it in leaving[] of each, unless that
 * is NULL. */
static wide load_of_blossoms(const instance *g, const thr_matching *m, const int *depth, int e,
                             int *leaving)
{
  wide load = 0;
  for (int a = m->node_blossom[g->edge[e][0]], b = m->node_blossom[g->edge[e][1]]; a != b;) {
    bool first = b < 0 || (a >= 0 && depth[a] >= depth[b]);
    int *deeper = first ? &a : &b;
    load += m->blossom_dual[*deeper];
    if (leaving) leaving[*deeper]++;
    *deeper = m->blossom_parent[*deeper];
  }
  return load;
}

static const char *fault_of_duals(const instance *g, const thr_matching *m, const int *depth,
                                  int *leaving)
{
  wide sum = 0;
  for (int e = 0; e < g->n_edges; e++) {
    bool matched = m->mate_edge[g->edge[e][0]] == e;
    wide load = (wide)m->dual[g->edge[e][0]] + m->dual[g->edge[e][1]];
    load += load_of_blossoms(g, m, depth, e, matched ? leaving : NULL);
    if (load > 2 * g->weight[e]) return "an edge loaded too much";
    if (matched && load < 2 * g->weight[e]) return "a matched edge that is not tight";
  }
  for (int v = 0; v < g->n_nodes; v++)
    sum += m->dual[v];
  for (int b = 0; b < m->n_blossoms; b++) {
    if (leaving[b] != 1) return "a blossom that not one matched edge leaves";
    sum += m->blossom_dual[b];
  }
  return sum == 2 * (wide)m->weight ? NULL : "duals that are not the weight";
}

void assert_lightest(const instance *g, const thr_matching *m)
{
  int *depth = calloc((size_t)m->n_blossoms + 1, sizeof *depth),
      *leaving = calloc((size_t)m->n_blossoms + 1, sizeof *leaving);
  const char *fault = fault_of_pairs(g, m);
  if (!fault) fault = fault_of_sets(g, m, depth);
  if (!fault) fault = fault_of_duals(g, m, depth, leaving);
  ck_assert_msg(!fault, "%d nodes, %d edges: %s", g->n_nodes, g->n_edges, fault);
  free(depth);
  free(leaving);
}

/* ---- brute force ---- */

/* The first node that is free is matched in every way. */
static int64_t lightest_from(const instance *g, unsigned matched, int64_t so_far, int64_t best)
{
  int v = 0;
  while (v < g->n_nodes && matched >> v & 1)
    v++;
  if (v == g->n_nodes) return best < 0 || so_far < best ? so_far : best;
  for (int e = 0; e < g->n_edges; e++) {
    int other = g->edge[e][0] == v ? g->edge[e][1] : g->edge[e][1] == v ? g->edge[e][0] : v;
    if (!(matched >> other & 1) && other != v)
      best = lightest_from(g, matched | 1U << v | 1U << other, so_far + g->weight[e], best);
  }
  return best;
}

int64_t lightest_by_force(const instance *g)
{
  ck_assert_int_le(g->n_nodes, 20);
  return lightest_from(g, 0, 0, -1);
}

/* ---- pairings ---- */

double pairing_price(int n, const double *price, const int *mate)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    if (mate[i] > i) sum += price[i * n + mate[i]];
  return sum;
}

double least_pairing(int n, const double *price)
{
  static instance g;
  thr_matching m;
  g.n_nodes = n;
  g.n_edges = 0;
  for (int i = 0; i < n; i++)
    for (int j = i + 1; j < n; j++)
      join(&g, i, j, (int64_t)llround(1e12 * price[i * n + j]));
  const thr_matching_problem p = view(&g);
  ck_assert_int_eq(thr_matching_solve(&p, &(thr_limits){0}, &m, NULL), THR_OK);
  double least = pairing_price(n, price, m.mate);
  thr_matching_destroy(&m);
  return least;
}
