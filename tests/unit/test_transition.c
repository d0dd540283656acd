/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Multigraph, pairing, joining, tracing, and the cords made of them. */
#include "graph/number.h"
#include "graph/threading/threading.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- a multigraph and its pairing ---- */

typedef struct {
  thr_multigraph g;
  int *mate;
} tour_of_all;

static int *constant(int n, int value)
{
  int *a = calloc((size_t)n, sizeof *a);
  ck_assert(a != NULL);
  for (int i = 0; i < n; i++)
    a[i] = value;
  return a;
}

static tour_of_all thread_make(const thr_frame *f, const int *passes, const int (*end)[2],
                               int n_ends)
{
  tour_of_all t;
  thr_err err = {0};
  ck_assert_int_eq(thr_multigraph_init(&t.g, f, 0, passes, end, n_ends, &err), THR_OK);
  t.mate = constant(t.g.n_darts, -1);
  assert_ok(thr_transition_pair(f, &t.g, t.mate, NULL, &err), &err);
  return t;
}

static void thread_destroy(tour_of_all *t)
{
  thr_multigraph_destroy(&t->g);
  free(t->mate);
}

static void assert_pairing(const tour_of_all *t)
{
  for (int d = 0; d < t->g.n_darts; d++) {
    int m = t->mate[d];
    ck_assert(m >= 0 && m < t->g.n_darts && m != d);
    ck_assert_int_eq(t->mate[m], d);
    ck_assert_int_eq(t->g.tail[m], t->g.tail[d]);
  }
}

/* The price of a pair as its definition says it. */
static double price_of(const thr_frame *f, const thr_multigraph *g, int a, int b)
{
  double price = g->half[a] == g->half[b] ? THR_U_TURN_PRICE : 0;
  return g->half[a] < 0 || g->half[b] < 0 ? price
                                          : price + thr_turn_angle(f, g->half[a] ^ 1, g->half[b]);
}

static double price_at(const thr_frame *f, const tour_of_all *t, int v)
{
  double sum = 0;
  for (int i = t->g.first[v]; i < t->g.first[v + 1]; i++)
    sum += price_of(f, &t->g, t->g.dart[i], t->mate[t->g.dart[i]]) / 2;
  return sum;
}

static int count_u_turns(const tour_of_all *t)
{
  int n = 0;
  for (int d = 0; d < t->g.n_darts; d++)
    n += t->mate[d] > d && t->g.half[d] == t->g.half[t->mate[d]];
  return n;
}

static int count_circuits(const tour_of_all *t)
{
  int *out = constant(t->g.n_darts, 0), *seen = constant(t->g.n_darts, 0), circuits = 0, n;
  for (int d = 0; d < t->g.n_darts; d++) {
    if (seen[d]) continue;
    circuits++;
    thr_transition_trace(t->mate, d, out, &n);
    for (int i = 0; i < n; i++)
      seen[out[i]] = seen[out[i] ^ 1] = 1;
  }
  free(out);
  free(seen);
  return circuits;
}

/* ---- oracles ---- */

/* Cheapest perfect matching of n darts, by trying all; angle by acos of normalized vectors, not by
 * the program's atan2. */
static double angle(const thr_frame *f, int a, int b)
{
  double u[3], w[3], uw = 0, uu = 0, ww = 0;
  for (int i = 0; i < 3; i++) {
    u[i] = f->xyz[f->edge[a / 2][a % 2]][i] -
           f->xyz[f->edge[a / 2][1 - a % 2]][i]; /* towards the node: against dart a */
    w[i] = f->xyz[f->edge[b / 2][1 - b % 2]][i] - f->xyz[f->edge[b / 2][b % 2]][i];
    uw += u[i] * w[i], uu += u[i] * u[i], ww += w[i] * w[i];
  }
  return acos(fmax(-1, fmin(1, uw / sqrt(uu * ww))));
}

static double own_price(const thr_frame *f, const thr_multigraph *g, int a, int b)
{
  double price = g->half[a] == g->half[b] ? THR_U_TURN_PRICE : 0;
  return g->half[a] < 0 || g->half[b] < 0 ? price : price + angle(f, g->half[a], g->half[b]);
}

static double cheapest(const thr_frame *f, const thr_multigraph *g, int *dart, int n)
{
  if (n == 0) return 0;
  double best = INFINITY;
  for (int j = 1; j < n; j++) {
    int kept = dart[j];
    dart[j] = dart[1];
    dart[1] = kept;
    best = fmin(best, own_price(f, g, dart[0], kept) + cheapest(f, g, dart + 2, n - 2));
    dart[1] = dart[j];
    dart[j] = kept;
  }
  return best;
}

/* Passes that make every degree even: cover plus the edges of a spanning tree as needed. Leaves the
 * two nodes of end odd. */
static int *even_passes(rng *r, const thr_frame *f, int cover, const int *end)
{
  int *passes = constant(f->n_edges, cover), *odd = constant(f->n_nodes, 0);
  for (int e = 0; e < f->n_edges; e++)
    passes[e] += 2 * (rng_below(r, 8) == 0);
  for (int v = 0; v < f->n_nodes; v++)
    odd[v] = cover * thr_degree(f, v) % 2;
  if (end) odd[end[0]] ^= 1, odd[end[1]] ^= 1;
  for (int v = f->n_nodes - 1; v > 0; v--) /* random_frame joins v to a lower node by edge v - 1 */
    if (odd[v]) {
      passes[v - 1]++;
      odd[v] = 0;
      odd[f->edge[v - 1][0]] ^= 1;
    }
  ck_assert_int_eq(odd[0], 0);
  free(odd);
  return passes;
}

/* ---- tests ---- */

START_TEST(multigraph_holds_every_pass)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, 9, 8, LENGTHS_EUCLID);
  int end[1][2] = {{2, 5}}, *passes = even_passes(&r, &f, 2, NULL),
      *copies = constant(f.n_edges, 0);
  thr_multigraph g;
  ck_assert_int_eq(thr_multigraph_init(&g, &f, 0, passes, (const int(*)[2])end, 1, NULL), THR_OK);
  for (int d = 0; d < g.n_darts; d++) {
    if (g.half[d] < 0) {
      ck_assert(g.tail[d] == end[0][d % 2]);
      continue;
    }
    ck_assert_int_eq(g.half[d ^ 1], g.half[d] ^ 1);
    ck_assert_int_eq(g.tail[d], f.edge[g.half[d] / 2][g.half[d] % 2]);
    copies[g.half[d] / 2]++;
  }
  for (int e = 0; e < f.n_edges; e++)
    ck_assert_int_eq(copies[e], 2 * passes[e]);
  for (int v = 0; v < f.n_nodes; v++)
    for (int i = g.first[v]; i < g.first[v + 1]; i++)
      ck_assert(g.tail[g.dart[i]] == v && (i == g.first[v] || g.dart[i] > g.dart[i - 1]));
  ck_assert_int_eq(g.first[f.n_nodes], g.n_darts);
  thr_multigraph_destroy(&g);
  thr_frame_destroy(&f);
  free(passes);
  free(copies);
}
END_TEST

START_TEST(multigraph_refuses_too_many_passes)
{
  thr_frame f = ring_make(3);
  int *passes = constant(3, 1 << 30);
  thr_multigraph g;
  thr_err err = {0};
  assert_status(thr_multigraph_init(&g, &f, 0, passes, NULL, 0, &err), THR_EINPUT, &err, "--cover");
  ck_assert(g.half == NULL);
  free(passes);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(small_nodes_are_paired_at_least_price)
{
  rng r = rng_make((uint64_t)_i + 100);
  thr_frame f = random_frame(&r, rng_between(&r, 4, 9), rng_below(&r, 12), LENGTHS_EUCLID);
  int end[1][2] = {{0, f.n_nodes - 1}},
      *passes = even_passes(&r, &f, rng_between(&r, 1, 2), end[0]);
  tour_of_all t = thread_make(&f, passes, (const int(*)[2])end, 1);
  assert_pairing(&t);
  for (int v = 0; v < f.n_nodes; v++) {
    int n = t.g.first[v + 1] - t.g.first[v];
    if (n > 10) continue;
    ck_assert_double_eq_tol(price_at(&f, &t, v), cheapest(&f, &t.g, t.g.dart + t.g.first[v], n),
                            1e-6);
  }
  thread_destroy(&t);
  thr_frame_destroy(&f);
  free(passes);
}
END_TEST

START_TEST(odd_nodes_are_refused)
{
  thr_frame f = star_make(3);
  int *passes = constant(3, 1), mate[6];
  thr_multigraph g;
  thr_err err = {0};
  ck_assert_int_eq(thr_multigraph_init(&g, &f, 0, passes, NULL, 0, NULL), THR_OK);
  assert_status(thr_transition_pair(&f, &g, mate, NULL, &err), THR_EINPUT, &err, "node 0");
  thr_multigraph_destroy(&g);
  free(passes);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(join_leaves_one_circuit_and_no_new_u_turn)
{
  rng r = rng_make((uint64_t)_i + 300);
  thr_frame f = random_frame(&r, rng_between(&r, 3, 30), rng_below(&r, 40), LENGTHS_EUCLID);
  int *passes = even_passes(&r, &f, rng_between(&r, 1, 3), NULL);
  tour_of_all t = thread_make(&f, passes, NULL, 0);
  int before = count_u_turns(&t), *again = constant(t.g.n_darts, -1);
  double(*four)[3] = calloc((size_t)f.n_nodes, sizeof *four);
  ck_assert_int_eq(thr_transition_pair(&f, &t.g, again, four, NULL), THR_OK);
  ck_assert(memcmp(again, t.mate, (size_t)t.g.n_darts * sizeof *again) == 0);
  ck_assert_int_eq(thr_transition_join(&f, &t.g, again, (const double(*)[3])four, 0, NULL), THR_OK);
  ck_assert_int_eq(thr_transition_join(&f, &t.g, t.mate, NULL, 0, NULL), THR_OK);
  ck_assert(memcmp(again, t.mate, (size_t)t.g.n_darts * sizeof *again) == 0);
  free(again);
  free(four);
  assert_pairing(&t);
  ck_assert_int_eq(count_circuits(&t), 1);
  ck_assert_int_le(count_u_turns(&t), before);
  thread_destroy(&t);
  thr_frame_destroy(&f);
  free(passes);
}
END_TEST

START_TEST(octahedron_pairs_straight_then_joins)
{
  thr_frame f = solid_make(OCTAHEDRON);
  int *passes = constant(12, 1);
  tour_of_all t = thread_make(&f, passes, NULL, 0);
  double turning = 0;
  for (int v = 0; v < 6; v++)
    turning += price_at(&f, &t, v);
  ck_assert_double_eq_tol(turning, 6 * THR_PI, 1e-9); /* 1080 degrees in three squares */
  ck_assert_int_eq(count_circuits(&t), 3);
  ck_assert_int_eq(thr_transition_join(&f, &t.g, t.mate, NULL, 0, NULL), THR_OK);
  ck_assert_int_eq(count_circuits(&t), 1);
  thread_destroy(&t);
  thr_frame_destroy(&f);
  free(passes);
}
END_TEST

/* ---- cords that change ---- */

typedef struct {
  const thr_frame *f;
  const thr_multigraph *g;
} priced;

static double turning_price(const void *of, int a, int b)
{
  const priced *p = of;
  return price_of(p->f, p->g, a, b);
}

static double sum_of_totals(const thr_threading *t)
{
  double sum = 0;
  for (int k = 0; k < t->n_cords; k++)
    sum += t->total[k];
  return sum;
}

/* By hand: from the first edge of node v on, over turns, as far as that goes. */
static bool hangs_together(const thr_threading *t, int v)
{
  const thr_frame *f = t->f;
  bool reached[64] = {true}, more = true, all = true;
  int d = thr_degree(f, v);
  ck_assert_int_le(d, 64);
  while (more) {
    more = false;
    for (int i = 0; i < t->n_places; i++) {
      int a = t->g->half[t->place[i].in], b = t->g->half[t->place[i].out], at[2] = {-1, -1};
      if (a < 0 || b < 0 || t->g->tail[t->place[i].in] != v) continue;
      for (int k = 0; k < d; k++) {
        if (f->half[f->first[v] + k] == a) at[0] = k;
        if (f->half[f->first[v] + k] == b) at[1] = k;
      }
      more |= reached[at[0]] != reached[at[1]];
      reached[at[0]] = reached[at[1]] = reached[at[0]] || reached[at[1]];
    }
  }
  for (int k = 0; k < d; k++)
    all &= reached[k];
  return all;
}

/* One exchange at random: what was said of it is what following the cords shows, and taken back it
 * has not been. */
static void try_exchange(rng *r, thr_threading *t)
{
  int here[64], cords = t->n_cords, v = rng_below(r, t->f->n_nodes),
                n = thr_threading_places(t, v, here);
  double before = sum_of_totals(t);
  if (n < 2) return;
  int i = rng_below(r, n), k = (i + 1 + rng_below(r, n - 1)) % n;
  thr_exchange x = thr_threading_exchange(t, here[i], here[k], rng_below(r, 2));
  thr_broken old = {0};
  thr_threading_make(t, &x, &old);
  ck_assert(thr_threading_follow(t, INT_MAX));
  ck_assert_int_eq(t->n_cords, cords + x.change);
  ck_assert_double_eq_tol(sum_of_totals(t), before + x.extra, 1e-6);
  ck_assert(thr_threading_tied(t, v) == hangs_together(t, v));
  if (rng_below(r, 2)) return;
  thr_threading_take_back(t, &old);
  ck_assert(thr_threading_follow(t, INT_MAX));
  ck_assert_int_eq(t->n_cords, cords);
  ck_assert_double_eq_tol(sum_of_totals(t), before, 1e-6);
}

START_TEST(exchanges_do_what_they_say)
{
  rng r = rng_make((uint64_t)_i + 1100);
  thr_frame f = random_frame(&r, rng_between(&r, 3, 12), rng_below(&r, 12), LENGTHS_EUCLID);
  int odd[2] = {0, rng_between(&r, 1, f.n_nodes - 1)},
      ends[2][2] = {{odd[0], f.n_nodes}, {odd[1], f.n_nodes}};
  bool open = _i % 2;
  int *passes = even_passes(&r, &f, rng_between(&r, 1, 2), open ? odd : NULL);
  tour_of_all made = {.mate = NULL};
  ck_assert_int_eq(
      thr_multigraph_init(&made.g, &f, 1, passes, (const int(*)[2])ends, open ? 2 : 0, NULL),
      THR_OK);
  made.mate = constant(made.g.n_darts, -1);
  ck_assert_int_eq(thr_transition_pair(&f, &made.g, made.mate, NULL, NULL), THR_OK);
  for (int i = made.g.first[f.n_nodes]; i < made.g.n_darts; i++)
    made.mate[made.g.dart[i]] = -1;
  priced p = {&f, &made.g};
  thr_threading t;
  ck_assert_int_eq(thr_threading_init(&t, &f, &made.g, made.mate, turning_price, &p, true, NULL),
                   THR_OK);
  ck_assert(thr_threading_follow(&t, INT_MAX));
  ck_assert(!thr_threading_closed(&t, 0) == open);
  int cords = t.n_cords;
  ck_assert(!thr_threading_follow(&t, cords - 1));
  ck_assert(thr_threading_follow(&t, cords));
  for (int i = 0; i < 40; i++)
    try_exchange(&r, &t);
  thr_threading_destroy(&t);
  thread_destroy(&made);
  thr_frame_destroy(&f);
  free(passes);
}
END_TEST

/* ---- walks that change ---- */

/* The turns counted on the way are those of the walks as they are now. */
static void assert_counted(const thr_junction_graphs *kept, const thr_frame *f, const thr_walks *w)
{
  thr_junction_graphs now;
  size_t n = 0;
  ck_assert_int_eq(thr_junction_graphs_init(&now, f, w, NULL), THR_OK);
  for (int v = 0; v < f->n_nodes; v++)
    n += (size_t)thr_degree(f, v) * (size_t)thr_degree(f, v);
  ck_assert_mem_eq(kept->count, now.count, n * sizeof *now.count);
  thr_junction_graphs_destroy(&now);
}

static void assert_closed_walks(const thr_frame *f, const thr_walks *w, const int *passes)
{
  int *made = constant(f->n_edges, 0);
  thr_walks_count(w, made);
  ck_assert_mem_eq(made, passes, (size_t)f->n_edges * sizeof *made);
  for (int i = 0; i < w->n_walks; i++) {
    const thr_walk *x = &w->walk[i];
    ck_assert(x->cyclic);
    ck_assert_double_eq_tol(x->length, thr_walk_length(f, x->half, x->n), 1e-9);
    for (int k = 0; k < x->n; k++)
      ck_assert_int_eq(thr_head(f, x->half[k]), thr_tail(f, x->half[(k + 1) % x->n]));
  }
  free(made);
}

/* Positions i < j of walk x at one node. */
static bool same_node(rng *r, const thr_frame *f, const thr_walk *x, int *i, int *j)
{
  for (int tries = 0; tries < 100; tries++) {
    *i = rng_below(r, x->n);
    *j = rng_below(r, x->n);
    if (*i < *j && thr_walk_node(f, x, *i) == thr_walk_node(f, x, *j)) return true;
  }
  return false;
}

/* Cut in two at a node that it visits twice, over a further pass there and back, and joined again
 * the other way round. */
START_TEST(spliced_walks_keep_their_passes_and_count_their_turns)
{
  rng r = rng_make((uint64_t)_i + 1300);
  thr_frame f = random_frame(&r, rng_between(&r, 3, 10), rng_below(&r, 12), LENGTHS_EUCLID);
  int *passes = even_passes(&r, &f, 2, NULL), i, j;
  thr_walks w;
  thr_junction_graphs ties;
  ck_assert_int_eq(thr_walks_trace(&f, passes, &w, NULL), THR_OK);
  ck_assert_int_eq(thr_junction_graphs_init(&ties, &f, &w, NULL), THR_OK);
  ck_assert(same_node(&r, &f, w.walk, &i, &j));
  int node = thr_walk_node(&f, w.walk, i), out = f.half[f.first[node]], way[2] = {out, out ^ 1};
  thr_splice s = thr_splice_of(true, w.walk, NULL);
  thr_splice_add(&s, 1, way, 2);
  thr_splice_put(&s, 0, 0, i, false);
  thr_splice_put(&s, 1, 0, 2, rng_below(&r, 2));
  thr_splice_put(&s, 0, j, w.walk->n, false);
  thr_splice_next(&s);
  thr_splice_put(&s, 0, i, j, rng_below(&r, 2));
  ck_assert_int_eq(thr_splice_make(&s, &f, &w, 0, -1, &ties, passes, NULL), THR_OK);
  ck_assert_int_eq(w.n_walks, 2);
  assert_closed_walks(&f, &w, passes);
  assert_counted(&ties, &f, &w);
  s = thr_splice_of(
      true, &w.walk[0],
      &w.walk[1]); /* walk 1 begins and ends at the node, so that its sections are one */
  thr_splice_put(&s, 0, 0, i, false);
  thr_splice_put(&s, 1, 0, w.walk[1].n, true);
  thr_splice_put(&s, 0, i, w.walk[0].n, false);
  ck_assert_int_eq(thr_splice_make(&s, &f, &w, 0, 1, &ties, NULL, NULL), THR_OK);
  ck_assert_int_eq(w.n_walks, 1);
  assert_closed_walks(&f, &w, passes);
  assert_counted(&ties, &f, &w);
  thr_walks_destroy(&w);
  thr_junction_graphs_destroy(&ties);
  thr_frame_destroy(&f);
  free(passes);
}
END_TEST

static double price_of_all(const thr_frame *f, const tour_of_all *t)
{
  double sum = 0;
  for (int v = 0; v < f->n_nodes; v++)
    sum += price_at(f, t, v);
  return sum;
}

/* Circuits as walks, and as pairs again, of copies in another order. */
START_TEST(circuits_as_walks_and_walks_as_circuits)
{
  rng r = rng_make((uint64_t)_i + 1500);
  thr_frame f = random_frame(&r, rng_between(&r, 3, 12), rng_below(&r, 16), LENGTHS_EUCLID);
  int *passes = even_passes(&r, &f, rng_between(&r, 1, 3), NULL), *next = constant(f.n_edges, 0);
  tour_of_all t = thread_make(&f, passes, NULL, 0);
  int wanted = count_circuits(&t);
  thr_walks w = {0}, again = {0};
  double price = price_of_all(&f, &t);
  ck_assert_int_eq(thr_walks_follow(&w, &f, &t.g, t.mate, NULL), THR_OK);
  ck_assert_int_eq(w.n_walks, wanted);
  assert_closed_walks(&f, &w, passes);
  thr_transition_copies(&f, &t.g, next);
  for (int i = w.n_walks - 1; i >= 0; i--)
    thr_transition_walk(&f, &t.g, w.walk[i].half, w.walk[i].n, false, next, t.mate);
  assert_pairing(&t);
  ck_assert_int_eq(count_circuits(&t), wanted);
  ck_assert_double_eq_tol(price_of_all(&f, &t), price, 1e-6);
  ck_assert_int_eq(thr_walks_follow(&again, &f, &t.g, t.mate, NULL), THR_OK);
  assert_closed_walks(&f, &again, passes);
  thr_walks_destroy(&w);
  thr_walks_destroy(&again);
  thread_destroy(&t);
  thr_frame_destroy(&f);
  free(passes);
  free(next);
}
END_TEST

/* Two passes of each edge round a ring, as two circuits: one afterwards, with the same turns. */
START_TEST(equal_passes_join_their_circuits)
{
  thr_frame f = ring_make(7);
  int *passes = constant(7, 2), circuit[28], parent[28], next[7];
  const int ring[] = {0, 2, 4, 6, 8, 10, 12};
  tour_of_all t = thread_make(&f, passes, NULL, 0);
  thr_transition_copies(&f, &t.g, next);
  for (int i = 0; i < 2; i++)
    thr_transition_walk(&f, &t.g, ring, 7, false, next, t.mate);
  ck_assert_int_eq(count_circuits(&t), 2);
  double price = price_of_all(&f, &t);
  for (int k = thr_threading_label(&t.g, t.mate, circuit) - 1; k >= 0; k--)
    parent[k] = k;
  thr_transition_join_equal(&t.g, circuit, parent, t.mate);
  ck_assert_int_eq(count_circuits(&t), 1);
  ck_assert_double_eq_tol(price_of_all(&f, &t), price, 1e-9);
  thread_destroy(&t);
  thr_frame_destroy(&f);
  free(passes);
}
END_TEST

/* ---- cords ---- */

static void assert_uses_all(const thr_frame *f, const int *passes, const thr_cord *cord, int n)
{
  int *left = constant(f->n_edges, 0);
  memcpy(left, passes, (size_t)f->n_edges * sizeof *left);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < cord[i].n_passes; k++) {
      left[cord[i].half[k] / 2]--;
      if (k) ck_assert_int_eq(thr_head(f, cord[i].half[k - 1]), thr_tail(f, cord[i].half[k]));
    }
  for (int e = 0; e < f->n_edges; e++)
    ck_assert_int_eq(left[e], 0);
  free(left);
}

START_TEST(open_cord_runs_from_end_to_end)
{
  rng r = rng_make((uint64_t)_i + 700);
  thr_frame f = random_frame(&r, rng_between(&r, 2, 20), rng_below(&r, 20), LENGTHS_EUCLID);
  int end[2] = {rng_below(&r, f.n_nodes), 0};
  while ((end[1] = rng_below(&r, f.n_nodes)) == end[0])
    ;
  int *passes = even_passes(&r, &f, 1, end);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_cord cord;
  ck_assert_int_eq(thr_tour_cord(&f, &o, passes, end, &cord, NULL), THR_OK);
  ck_assert(!cord.closed && thr_cord_start(&f, &cord) == end[0] &&
            thr_cord_end(&f, &cord) == end[1]);
  assert_uses_all(&f, passes, &cord, 1);
  free(cord.half);
  free(passes);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(closed_cord_starts_where_told_or_at_a_foot)
{
  rng r = rng_make((uint64_t)_i + 900);
  thr_frame f = random_frame(&r, rng_between(&r, 3, 20), rng_below(&r, 20), LENGTHS_EUCLID);
  int *passes = even_passes(&r, &f, 1, NULL), v = rng_below(&r, f.n_nodes);
  int at[2] = {v, v}, anywhere[2] = {-1, -1};
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_cord cord;
  ck_assert_int_eq(thr_tour_cord(&f, &o, passes, at, &cord, NULL), THR_OK);
  ck_assert(cord.closed && thr_cord_start(&f, &cord) == v && thr_cord_end(&f, &cord) == v);
  assert_uses_all(&f, passes, &cord, 1);
  free(cord.half);
  ck_assert_int_eq(thr_tour_cord(&f, &o, passes, anywhere, &cord, NULL), THR_OK);
  ck_assert(cord.closed && f.foot[thr_cord_start(&f, &cord)]);
  assert_uses_all(&f, passes, &cord, 1);
  free(cord.half);
  free(passes);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(odd_passes_are_refused)
{
  thr_frame f = path_make(3);
  int passes[2] = {1, 1}, ends[2] = {-1, -1};
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_cord cord;
  thr_err err = {0};
  ck_assert_int_eq(thr_tour_cord(&f, &o, passes, ends, &cord, &err), THR_EINPUT);
  ck_assert(cord.half == NULL);
  assert_one_line(&err, "node 0");
  thr_frame_destroy(&f);
}
END_TEST

/* ---- large nodes, many components: these only have to finish, and be right ---- */

START_TEST(star_of_3000_spokes)
{
  thr_frame f = star_make(3000);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  ck_assert_double_eq_tol(p.metrics.length, 6000, 1e-6);
  ck_assert_int_eq(p.metrics.u_turns, 3000);
  assert_plan_sound(&p);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(wheel_of_2000_spokes)
{
  thr_frame f = wheel_make(2000);
  int *passes = constant(f.n_edges, 2), ends[2] = {-1, -1};
  thr_request o = options_for(THR_ENDS_CLOSED, 2);
  thr_cord cord;
  thr_metrics m;
  ck_assert_int_eq(thr_tour_cord(&f, &o, passes, ends, &cord, NULL), THR_OK);
  assert_uses_all(&f, passes, &cord, 1);
  ck_assert_int_eq(thr_plan_measure(&f, &o, &cord, 1, &m, NULL), THR_OK);
  ck_assert_int_eq(m.u_turns, 0);
  free(cord.half);
  free(passes);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(hub_whose_darts_all_pair_badly_is_joined_fast)
{
  thr_frame f = star_make(20000);
  int *passes = constant(f.n_edges, 2);
  tour_of_all t = thread_make(&f, passes, NULL, 0);
  ck_assert_int_eq(thr_transition_join(&f, &t.g, t.mate, NULL, 0, NULL), THR_OK);
  ck_assert_int_eq(count_circuits(&t), 1);
  thread_destroy(&t);
  free(passes);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(two_thousand_components)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  thr_frame f = triangles_make(2000);
  for (size_t i = 0; i < 3; i++) {
    thr_plan p = plan_simple(&f, ends[i], 1);
    ck_assert_int_eq(p.n_cords, 2000);
    ck_assert_double_eq_tol(p.metrics.length, 6000, 1e-6);
    ck_assert_str_eq(p.cord[26].id, "AA");
    assert_plan_sound(&p);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("transition and tour");
  ADD_LOOP(s, 10, multigraph_holds_every_pass, 0, 10);
  ADD_TEST(s, 10, multigraph_refuses_too_many_passes);
  ADD_EXAMPLES(s, 10, small_nodes_are_paired_at_least_price, 100);
  ADD_TEST(s, 10, odd_nodes_are_refused);
  ADD_EXAMPLES(s, 10, join_leaves_one_circuit_and_no_new_u_turn, 100);
  ADD_TEST(s, 10, octahedron_pairs_straight_then_joins);
  ADD_EXAMPLES(s, 10, exchanges_do_what_they_say, 100);
  ADD_EXAMPLES(s, 10, spliced_walks_keep_their_passes_and_count_their_turns, 100);
  ADD_EXAMPLES(s, 10, circuits_as_walks_and_walks_as_circuits, 100);
  ADD_TEST(s, 10, equal_passes_join_their_circuits);
  ADD_EXAMPLES(s, 10, open_cord_runs_from_end_to_end, 50);
  ADD_EXAMPLES(s, 10, closed_cord_starts_where_told_or_at_a_foot, 50);
  ADD_TEST(s, 10, odd_passes_are_refused);
  ADD_TEST(s, 20, star_of_3000_spokes);
  ADD_TEST(s, 20, wheel_of_2000_spokes);
  ADD_TEST(s, 20, hub_whose_darts_all_pair_badly_is_joined_fast);
  ADD_TEST(s, 20, two_thousand_components);
  return run_suite(s);
}
