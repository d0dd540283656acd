/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The classical tours against a second Fleury on counts of passes, pairings by enumeration, and the
 * shortest length. */
#include "graph/framework/frame.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/tour/baseline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EDGES = 64 };

static const thr_tour tours[] = {THR_TOUR_FLEURY, THR_TOUR_HIERHOLZER};

static thr_least tour_make(const thr_frame *f, thr_ends ends, int cover, thr_tour tour, bool ignore)
{
  thr_least_options o = thr_least_options_default();
  const thr_request shortest = options_for(ends, cover);
  thr_shortest s;
  thr_err err = {0};
  thr_least l;
  o.request.ends = ends;
  o.request.cover = cover;
  assert_ok(thr_postman_shortest(f, &shortest, &(thr_limits){0}, &s, &err), &err);
  assert_ok(thr_baseline_tour(f, &o, tour, ignore, s.passes, &l, &err), &err);
  thr_shortest_destroy(&s);
  return l;
}

/* ---- what holds for every tour ---- */

/* Walks that hang together, close where they must, and pass every edge often enough; returns their
 * length. */
static double assert_tours(const thr_frame *f, const thr_least *l, thr_ends ends, int cover)
{
  int seen[MOST_EDGES] = {0};
  double length = 0, turning = 0;
  ck_assert_int_le(f->n_edges, MOST_EDGES);
  for (int i = 0; i < l->n_cords; i++) {
    const thr_cord *c = &l->cord[i];
    int last = c->half[c->n_passes - 1];
    for (int k = 0; k < c->n_passes; k++) {
      seen[c->half[k] >> 1]++;
      length += f->length[c->half[k] >> 1];
      if (k == 0) continue;
      ck_assert_int_eq(thr_head(f, c->half[k - 1]), thr_tail(f, c->half[k]));
      turning += thr_turn_angle(f, c->half[k - 1], c->half[k]);
    }
    if (ends == THR_ENDS_CLOSED) {
      ck_assert_int_eq(thr_head(f, last), thr_tail(f, c->half[0]));
      turning += thr_turn_angle(f, last, c->half[0]);
    }
    if (ends == THR_ENDS_FEET)
      ck_assert(f->foot[thr_tail(f, c->half[0])] && f->foot[thr_head(f, last)]);
  }
  for (int e = 0; e < f->n_edges; e++)
    ck_assert_int_ge(seen[e], cover);
  ck_assert_double_eq_tol(l->turning, turning, 1e-9 * (1 + turning));
  ck_assert_double_eq_tol(l->length, length, 1e-9 * length);
  ck_assert(!l->optimal);
  return length;
}

START_TEST(tours_have_the_shortest_length)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, 12, rng_below(&r, 12), LENGTHS_EUCLID);
  int cover = 1 + _i % 3;
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
    thr_request o = options_for((thr_ends)ends, cover);
    double shortest = cover * thr_frame_total_length(&f) + least_extra_by_matching(&f, &o);
    for (int k = 0; k < 4; k++) {
      thr_least l = tour_make(&f, (thr_ends)ends, cover, tours[k / 2], k % 2);
      ck_assert_int_eq(l.n_cords, 1);
      ck_assert_double_eq_tol(assert_tours(&f, &l, (thr_ends)ends, cover), shortest,
                              1e-9 * shortest);
      thr_least_destroy(&l);
    }
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_piece_has_its_tour)
{
  thr_frame f = triangles_make(3);
  for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++)
    for (int k = 0; k < 4; k++) {
      thr_least l = tour_make(&f, (thr_ends)ends, 1, tours[k / 2], k % 2);
      ck_assert_int_eq(l.n_cords, 3);
      ck_assert_double_eq_tol(assert_tours(&f, &l, (thr_ends)ends, 1), 9, 1e-9);
      thr_least_destroy(&l);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- a second Fleury ---- */

/* left[e] passes of edge e are not walked yet. partner[h] is the half-edge that goes with h at its
 * node, or partner is NULL. */
typedef struct {
  const thr_frame *f;
  const int *partner;
  int left[MOST_EDGES];
} counted;

static int left_at(const counted *c, int v)
{
  int n = 0;
  for (int i = c->f->first[v]; i < c->f->first[v + 1]; i++)
    n += c->left[c->f->half[i] >> 1];
  return n;
}

static int nodes_reached(const counted *c, int v, bool *seen)
{
  int n = 1;
  seen[v] = true;
  for (int i = c->f->first[v]; i < c->f->first[v + 1]; i++) {
    int h = c->f->half[i];
    if (c->left[h >> 1] && !seen[thr_head(c->f, h)]) n += nodes_reached(c, thr_head(c->f, h), seen);
  }
  return n;
}

/* Does taking a pass of half-edge h away leave its tail with fewer nodes to go to? */
static bool is_bridge(counted *c, int h)
{
  bool before[MOST_EDGES + 1] = {false}, after[MOST_EDGES + 1] = {false};
  int n = nodes_reached(c, thr_tail(c->f, h), before);
  c->left[h >> 1]--;
  bool fewer = nodes_reached(c, thr_tail(c->f, h), after) < n;
  c->left[h >> 1]++;
  return fewer;
}

/* The pass that Fleury's rule takes after arriving over half-edge h: no bridge unless nothing else
 * is left. */
static int next_by_rule(counted *c, int h)
{
  int v = thr_head(c->f, h), best = -1, n = left_at(c, v);
  double least = INFINITY;
  for (int i = c->f->first[v]; i < c->f->first[v + 1]; i++) {
    int next = c->f->half[i];
    double rank = !c->partner                 ? i
                  : next == c->partner[h ^ 1] ? -1
                  : next == (h ^ 1)           ? 1e9
                                              : thr_turn_angle(c->f, h, next);
    if (c->left[next >> 1] && (n == 1 || !is_bridge(c, next)) && rank < least)
      least = rank, best = next;
  }
  return best;
}

static int walk_by_rule(counted *c, int start, int *walk)
{
  int n = 0;
  for (int h = start; h >= 0; h = next_by_rule(c, h)) {
    c->left[h >> 1]--;
    walk[n++] = h;
  }
  return n;
}

/* Are two closed walks the same, wherever they start and whichever way they run? */
static bool same_circuit(int n, const int *a, const int *b)
{
  for (int shift = 0; shift < n; shift++) {
    bool forth = true, back = true;
    for (int k = 0; k < n; k++) {
      forth &= a[k] == b[(k + shift) % n];
      back &= a[k] == (b[(shift - k + n) % n] ^ 1);
    }
    if (forth || back) return true;
  }
  return false;
}

/* The tour of f, which passes each edge so often, must be what the rule walks from edge 0. */
static void assert_by_rule(const thr_frame *f, const int *partner, int cover)
{
  counted c = {.f = f, .partner = partner};
  int walk[8 * MOST_EDGES];
  thr_least l = tour_make(f, THR_ENDS_CLOSED, cover, THR_TOUR_FLEURY, !partner);
  for (int k = 0; k < l.cord[0].n_passes; k++)
    c.left[l.cord[0].half[k] >> 1]++;
  ck_assert_int_eq(walk_by_rule(&c, 0, walk), l.cord[0].n_passes);
  ck_assert(same_circuit(l.cord[0].n_passes, walk, l.cord[0].half));
  thr_least_destroy(&l);
}

START_TEST(fleury_in_the_edges_order)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int k = 0; k < 40; k++) {
    thr_frame f = random_frame(&r, rng_between(&r, 3, 12), rng_below(&r, 14), LENGTHS_EUCLID);
    assert_by_rule(&f, NULL, rng_between(&r, 1, 2));
    thr_frame_destroy(&f);
  }
}
END_TEST

/* ---- pairings by enumeration ---- */

/* Cheapest pairing of the half-edges at v that have no partner yet; best takes over partner where
 * it is cheaper. */
static double pair_at(const thr_frame *f, int v, int *partner, double price, double least,
                      int *best)
{
  int a = -1;
  const int *half = f->half + f->first[v];
  for (int i = 0; i < thr_degree(f, v) && a < 0; i++)
    if (partner[half[i]] < 0) a = half[i];
  if (price >= least) return least;
  if (a < 0) {
    for (int i = 0; i < thr_degree(f, v); i++)
      best[half[i]] = partner[half[i]];
    return price;
  }
  for (int i = 0; i < thr_degree(f, v); i++) {
    int b = half[i];
    if (b == a || partner[b] >= 0) continue;
    partner[a] = b, partner[b] = a;
    least = pair_at(f, v, partner, price + thr_turn_angle(f, a ^ 1, b), least, best);
    partner[a] = partner[b] = -1;
  }
  return least;
}

/* partner[2 * n_edges] in the cheapest pairings of a framework with even nodes; the price of all.
 */
static double pair_all(const thr_frame *f, int *partner)
{
  int free_half[2 * MOST_EDGES];
  double sum = 0;
  for (int h = 0; h < 2 * f->n_edges; h++)
    free_half[h] = -1;
  for (int v = 0; v < f->n_nodes; v++)
    sum += pair_at(f, v, free_half, 0, INFINITY, partner);
  return sum;
}

static int circuits_of(const thr_frame *f, const int *partner)
{
  bool seen[2 * MOST_EDGES] = {false};
  int n = 0;
  for (int start = 0; start < 2 * f->n_edges; start++) {
    n += !seen[start];
    for (int h = start; !seen[h]; h = partner[h ^ 1])
      seen[h] = seen[h ^ 1] = true;
  }
  return n;
}

static int turns_off(const thr_cord *c, const int *partner)
{
  int n = 0;
  for (int k = 0; k < c->n_passes; k++)
    n += partner[c->half[k] ^ 1] != c->half[(k + 1) % c->n_passes];
  return n;
}

/* Connected, every node even and of at most 8 edges, so that every edge is passed once. */
static thr_frame even_frame(rng *r)
{
  for (;;) {
    thr_frame f =
        random_frame_few_odd(r, rng_between(r, 5, 9), rng_between(r, 2, 12), LENGTHS_EUCLID, 0);
    bool fits = f.n_edges <= MOST_EDGES;
    for (int v = 0; v < f.n_nodes; v++)
      fits &= thr_degree(&f, v) % 2 == 0 && thr_degree(&f, v) <= 8;
    if (fits) return f;
    thr_frame_destroy(&f);
  }
}

/* Fleury walks as the rule says. Where the pairings are one circuit, both tours are that circuit
 * and attain the bound; elsewhere Hierholzer changes at most two pairs for each circuit that it
 * splices in. */
START_TEST(tours_keep_to_the_pairings)
{
  rng r = rng_make((uint64_t)_i + 100);
  int single = 0;
  for (int k = 0; k < 60; k++) {
    int partner[2 * MOST_EDGES];
    thr_frame f = even_frame(&r);
    double bound = pair_all(&f, partner);
    int n = circuits_of(&f, partner);
    assert_by_rule(&f, partner, 1);
    thr_least fleury = tour_make(&f, THR_ENDS_CLOSED, 1, THR_TOUR_FLEURY, false);
    thr_least hierholzer = tour_make(&f, THR_ENDS_CLOSED, 1, THR_TOUR_HIERHOLZER, false);
    ck_assert_int_le(turns_off(&hierholzer.cord[0], partner), 2 * (n - 1));
    ck_assert_double_ge(hierholzer.turning, bound - 1e-9);
    if (n == 1) {
      single++;
      ck_assert_int_eq(turns_off(&fleury.cord[0], partner), 0);
      ck_assert_double_eq_tol(fleury.turning, bound, 1e-9);
      ck_assert_double_eq_tol(hierholzer.turning, bound, 1e-9);
    }
    thr_least_destroy(&fleury);
    thr_least_destroy(&hierholzer);
    thr_frame_destroy(&f);
  }
  ck_assert_int_gt(single, 0);
}
END_TEST

START_TEST(pairings_spare_turns_on_domes)
{
  thr_frame f = shape_make(THR_MAKE_DOME, _i, 0);
  for (int k = 0; k < 2; k++)
    for (int ends = THR_ENDS_CLOSED; ends <= THR_ENDS_FEET; ends++) {
      thr_least keep = tour_make(&f, (thr_ends)ends, 1, tours[k], false);
      thr_least ignore = tour_make(&f, (thr_ends)ends, 1, tours[k], true);
      ck_assert_double_le(keep.turning, ignore.turning + 1e-9);
      thr_least_destroy(&keep);
      thr_least_destroy(&ignore);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- failures ---- */

START_TEST(what_is_no_classical_tour_is_refused)
{
  thr_frame f = ring_make(4);
  thr_least_options o = thr_least_options_default();
  const int once[] = {1, 1, 1, 1};
  thr_least l;
  thr_err err = {0}, cords = {0};
  assert_status(thr_baseline_tour(&f, &o, THR_TOUR_LEAST, false, once, &l, &err), THR_EINPUT, &err,
                "fleury");
  o.request.ends = THR_ENDS_ANY;
  o.request.cords = 2;
  assert_status(thr_baseline_tour(&f, &o, THR_TOUR_FLEURY, false, once, &l, &cords), THR_EINPUT,
                &cords, "--cords");
  ck_assert_ptr_null(l.cord);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(running_out_of_memory_leaves_nothing)
{
  thr_frame f = solid_make(CUBE);
  thr_least_options o = thr_least_options_default();
  int twice[MOST_EDGES];
  for (int e = 0; e < f.n_edges; e++)
    twice[e] = 2;
  thr_status st = THR_ENOMEM;
  for (long k = 1; st != THR_OK; k++) {
    thr_least l;
    thr_alloc_fail_at(k);
    st = thr_baseline_tour(&f, &o, tours[_i], false, twice, &l, NULL);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || (st == THR_ENOMEM && !l.cord));
    thr_least_destroy(&l);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("baseline");
  ADD_LOOP(s, 20, tours_have_the_shortest_length, 0, 9);
  ADD_TEST(s, 10, every_piece_has_its_tour);
  ADD_LOOP(s, 20, fleury_in_the_edges_order, 0, 3);
  ADD_LOOP(s, 20, tours_keep_to_the_pairings, 0, 3);
  ADD_LOOP(s, 20, pairings_spare_turns_on_domes, 3, 12);
  ADD_TEST(s, 10, what_is_no_classical_tour_is_refused);
  ADD_LOOP(s, 20, running_out_of_memory_leaves_nothing, 0, 2);
  return run_suite(s);
}
