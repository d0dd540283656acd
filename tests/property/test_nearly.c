/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a drawing nearly says, on random frameworks in a square lattice: where edges cross and which
 * nodes lie on edges is decided there by signs of integers; nodes drawn twice at a hair's breadth
 * are known from the making. */
#include "graph/framework/frame.h"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 9, EDGES = 14 };

typedef struct {
  int x, y;
} point;

typedef struct {
  point at[2 * EDGES];
  int n_nodes, n_edges, edge[EDGES][2];
} lattice;

static int node_at(lattice *l, point p)
{
  for (int v = 0; v < l->n_nodes; v++)
    if (l->at[v].x == p.x && l->at[v].y == p.y) return v;
  l->at[l->n_nodes] = p;
  return l->n_nodes++;
}

static lattice make_lattice(void)
{
  lattice l = {0};
  while (l.n_edges < EDGES) {
    const point p = {rand() % SIDE, rand() % SIDE}, q = {rand() % SIDE, rand() % SIDE};
    if (abs(p.x - q.x) + abs(p.y - q.y) < 2) continue;
    const int a = node_at(&l, p), b = node_at(&l, q);
    bool twice = false;
    for (int e = 0; e < l.n_edges; e++)
      twice |= (l.edge[e][0] == a && l.edge[e][1] == b) || (l.edge[e][0] == b && l.edge[e][1] == a);
    if (twice) continue;
    l.edge[l.n_edges][0] = a;
    l.edge[l.n_edges++][1] = b;
  }
  return l;
}

/* Twice the area of a triangle, with its sign. */
static int turn(point a, point b, point c)
{
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static int sign(int x)
{
  return (x > 0) - (x < 0);
}

static bool lies_on(const lattice *l, int v, int e)
{
  const point a = l->at[l->edge[e][0]], b = l->at[l->edge[e][1]], p = l->at[v];
  const int dot = (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y);
  const int all = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
  return turn(a, b, p) == 0 && dot > 0 && dot < all;
}

static bool cross(const lattice *l, int e, int f)
{
  const point a = l->at[l->edge[e][0]], b = l->at[l->edge[e][1]], c = l->at[l->edge[f][0]],
              d = l->at[l->edge[f][1]];
  return sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 &&
         sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0;
}

static int count_on_edges(const lattice *l)
{
  int n = 0;
  for (int v = 0; v < l->n_nodes; v++)
    for (int e = 0; e < l->n_edges; e++)
      n += lies_on(l, v, e);
  return n;
}

static int count_crossings(const lattice *l)
{
  int n = 0;
  for (int e = 0; e < l->n_edges; e++)
    for (int f = 0; f < e; f++)
      n += cross(l, e, f);
  return n;
}

/* The lattice in space, turned and moved; some ends of edges get a node of their own a
 * ten-thousandth away. */
static thr_frame build(const lattice *l, bool torn, int *n_torn)
{
  thr_draft d = {0};
  thr_frame f;
  thr_read_report r = {0};
  bool kept[2 * EDGES] = {false},
                done[2 * EDGES] = {
                    false}; /* some edge ends at the node itself; another was torn off */
  *n_torn = 0;
  for (int v = 0; v < l->n_nodes; v++) {
    const double xyz[3] = {0.6 * l->at[v].x + 7, 0.8 * l->at[v].x - 3, l->at[v].y};
    ck_assert_int_eq(thr_draft_add_node(&d, xyz, NULL, false, NULL), THR_OK);
  }
  for (int e = 0; e < l->n_edges; e++) {
    int a = l->edge[e][0];
    kept[l->edge[e][1]] = true;
    if (torn && kept[a] && !done[a] && rand() % 4 == 0) {
      double xyz[3];
      memcpy(xyz, d.node[a].xyz, sizeof xyz);
      xyz[0] += 1e-4;
      done[a] = true;
      a = d.n_nodes;
      ck_assert_int_eq(thr_draft_add_node(&d, xyz, NULL, false, NULL), THR_OK);
      ++*n_torn;
    } else {
      kept[a] = true;
    }
    ck_assert_int_eq(thr_draft_add_edge(&d, a, l->edge[e][1], 0, NULL), THR_OK);
  }
  ck_assert_int_eq(thr_draft_build(&d, 0, &f, &r, NULL), THR_OK);
  thr_draft_destroy(&d);
  return f;
}

START_TEST(finds_what_signs_of_integers_say)
{
  srand((unsigned)_i + 1);
  int n_torn;
  const lattice l = make_lattice();
  thr_frame f = build(&l, false, &n_torn);
  thr_near near;
  ck_assert_int_eq(thr_frame_near(&f, &near, NULL), THR_OK);
  ck_assert_int_eq(near.n_on_edge, count_on_edges(&l));
  ck_assert_int_eq(near.n_crossings, count_crossings(&l));
  ck_assert_int_eq(near.n_close, 0);
  ck_assert(!near.tangled);
  if (near.n_on_edge) ck_assert(lies_on(&l, near.on_edge[0], near.on_edge[1]));
  if (near.n_crossings) ck_assert(cross(&l, near.crossing[0], near.crossing[1]));
  thr_frame_destroy(&f);
}
END_TEST

/* Afterwards no node lies on an edge; what a cut adds is a part more, unless that part was an edge
 * already. */
START_TEST(cuts_edges_at_the_nodes_on_them)
{
  srand((unsigned)_i + 1);
  int n_torn, n_cut, expected = 0;
  const lattice l = make_lattice();
  thr_frame f = build(&l, false, &n_torn);
  thr_near near;
  thr_read_report r = {0};
  const int on_edges = count_on_edges(&l);
  for (int e = 0; e < l.n_edges; e++) {
    bool is_cut = false;
    for (int v = 0; v < l.n_nodes; v++)
      is_cut |= lies_on(&l, v, e);
    expected += is_cut;
  }
  ck_assert_int_eq(thr_frame_split(&f, &n_cut, &r, NULL), THR_OK);
  ck_assert_int_eq(n_cut, expected);
  ck_assert_int_eq(f.n_edges, l.n_edges + on_edges - r.duplicate_edges);
  ck_assert_int_eq(thr_frame_near(&f, &near, NULL), THR_OK);
  ck_assert_int_eq(near.n_on_edge, 0);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(says_what_welding_joins)
{
  srand((unsigned)_i + 1);
  int n_torn, none, count;
  const lattice l = make_lattice();
  thr_frame torn = build(&l, true, &n_torn), whole = build(&l, false, &none);
  int *component = calloc((size_t)whole.n_nodes, sizeof *component);
  thr_near near;
  ck_assert_int_eq(thr_frame_components(&whole, component, &count, NULL), THR_OK);
  ck_assert_int_eq(thr_frame_near(&torn, &near, NULL), THR_OK);
  ck_assert_int_eq(near.n_close, n_torn);
  if (n_torn) {
    ck_assert_double_eq_tol(near.gap, 1e-4, 1e-12);
    ck_assert_double_eq_tol(near.weld, 1e-3, 1e-12);
    ck_assert_int_eq(near.n_welded, n_torn);
    ck_assert_int_eq(near.components_welded, count);
    ck_assert_int_eq(near.n_lost + near.n_merged, 0);
  }
  free(component);
  thr_frame_destroy(&torn);
  thr_frame_destroy(&whole);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("nearly");
  ADD_EXAMPLES(s, 60, finds_what_signs_of_integers_say, 500);
  ADD_EXAMPLES(s, 60, cuts_edges_at_the_nodes_on_them, 300);
  ADD_EXAMPLES(s, 60, says_what_welding_joins, 300);
  return run_suite(s);
}
