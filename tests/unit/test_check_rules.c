/* Rules of the checker, each against an answer that is worked out another way: what rounding takes off a bound, how short the
 * longest cord can be, and that no claim outlives a failure before it. */
#include "graph/check/check_parts.h"
#include "graph/angle.h"
#include "graph/plan/junction.h"
#include "lp/length/cords.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- rounding ---- */

/* Edges one after the other, the nodes being 0, 1, .. n. */
static thr_frame chain_make(int n, const double *length)
{
  double xyz[8][3] = {{0}};
  int edge[8][2];
  for (int e = 0; e < n; e++) {
    xyz[e + 1][0] = xyz[e][0] + length[e];
    edge[e][0] = e, edge[e][1] = e + 1;
  }
  return frame_make(n + 1, (const double(*)[3])xyz, n, (const int(*)[2])edge, NULL, NULL);
}

/* Appends so many cords there and back over an edge. */
static void add_loops(thr_cord *cord, int *n, int edge, int count)
{
  for (int i = 0; i < count; i++) {
    cord[*n] = (thr_cord){.closed = true, .n_passes = 2, .half = calloc(2, sizeof(int))};
    ck_assert_ptr_nonnull(cord[*n].half);
    thr_cord_id(*n, cord[*n].id);
    cord[*n].half[0] = 2 * edge;
    cord[(*n)++].half[1] = 2 * edge + 1;
  }
}

/* Closed cords on a chain run there and back: every edge needs a pair of passes, and every cord one. */
static double least_of_chain(const double *length, int n, int cords)
{
  double sum = 0, shortest = INFINITY;
  for (int e = 0; e < n; e++) {
    sum += 2 * length[e];
    shortest = fmin(shortest, length[e]);
  }
  return sum + 2 * shortest * (cords > n ? cords - n : 0);
}

/* The best bound of certificates without cuts, of a plan with so many cords on a chain: those that no edge needs run over edge
 * `over`. */
static double best_bound(const double *length, int n, int cords, double scale, int cover, int over)
{
  thr_frame f = chain_make(n, length);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, cover);
  thr_cord *cord = calloc((size_t)(cords + n), sizeof *cord);
  int n_cords = 0;
  double best = 0;
  for (int e = 0; e < n; e++)
    add_loops(cord, &n_cords, e, 1);
  add_loops(cord, &n_cords, over, cords - n);
  o.cords = o.cords_least = cords;
  for (int price = 0; price <= 2000; price += 250) {
    int64_t place = price;
    thr_certificate c = {.scale = scale, .denominator = 1000, .n_prices = 1, .place_price = &place};
    bool optimal;
    double bound;
    for (int e = 0; e < n; e++)
      c.join += thr_certificate_weight(&f, &c, e) * (2 - cover + (e == over ? 2 * (cords - n) : 0));
    thr_err err = {0};
    thr_status st = thr_check_length_proof(&f, &o, cord, cords, &c, 1, &optimal, &bound, &err);
    if (st) {
      ck_assert_msg(st == THR_EVIOLATED && (strstr(err.text, "bound") || strstr(err.text, "cheaper")), "%s", err.text);
    } else {
      ck_assert_double_le(bound, least_of_chain(length, n, cords) * (1 + 1e-12));
      best = fmax(best, bound);
    }
  }
  thr_cords_destroy(cord, n_cords);
  thr_frame_destroy(&f);
  return best;
}

/* A weight rounded up counts for each pass of each cord: 0.51 for 1, a thousand times. */
START_TEST(rounding_is_charged_for_every_cord)
{
  static const double length[2] = {0.51, 1}, even[2] = {1, 2};
  for (int cover = 1; cover <= 2; cover++)
    for (int cords = 2; cords <= 1000; cords *= 4) {
      for (int k = -2; k < 8; k++)
        for (int over = 0; over < 2; over++)
          best_bound(length, 2, cords, ldexp(1, k), cover, over);
      /* weights that are the lengths prove what is true */
      ck_assert_double_eq_tol(best_bound(even, 2, cords, 1, cover, 1), least_of_chain(even, 2, cords) - (cover < 2), 2);
    }
}
END_TEST

/* Of random lengths and scales, some of which round most of an edge away. */
START_TEST(rounding_never_adds_to_a_bound)
{
  rng r = rng_make((uint64_t)_i + 1);
  double length[3];
  int n = rng_between(&r, 1, 3);
  for (int e = 0; e < n; e++)
    length[e] = 0.05 + 2 * rng_unit(&r);
  double scale = ldexp(1, rng_below(&r, 5)) * (0.5 + rng_unit(&r));
  for (int over = 0; over < n; over++)
    best_bound(length, n, n + rng_below(&r, 6), scale, 1 + rng_below(&r, 2), over);
}
END_TEST

/* Two cords over one edge there and back, and an odd cut round its end: without prices one pass more is all that a shortest plan
 * may have, so the rounding of 0.51 to 1 is taken off once. */
START_TEST(rounding_is_charged_once_without_prices)
{
  static const double length[1] = {0.51};
  thr_frame f = chain_make(1, length);
  thr_cord *cord = calloc(2, sizeof *cord);
  int n = 0;
  bool optimal;
  double bound;
  add_loops(cord, &n, 0, 2);
  for (int cover = 1; cover <= 3; cover += 2) {
    thr_plan_options o = options_for(THR_ENDS_CLOSED, cover);
    thr_cut cut = {-1, 1, (int[]){0}, 1};
    int64_t price = 0;
    thr_certificate c = {.scale = 1, .denominator = 1, .join = 4 - cover, .sum = 1, .n_cuts = 1, .cut = &cut};
    o.cords = o.cords_least = 2;
    ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, 2, &c, 1, &optimal, &bound, NULL), THR_OK);
    ck_assert_double_eq_tol(bound, 0.51 * (cover + 1), 1e-12);
    ck_assert_int_eq(optimal, cover == 3);
    c.n_prices = 1, c.place_price = &price; /* then twice the cords less the cover, and at least once */
    ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, 2, &c, 1, &optimal, &bound, NULL), THR_OK);
    ck_assert_double_eq_tol(bound, cover == 3 ? 0.51 * 4 : 0.51, 1e-12); /* 1 - 3 * 0.49 is nothing */
  }
  thr_cords_destroy(cord, n);
  thr_frame_destroy(&f);
}
END_TEST

/* With prices a shortest plan may have twice the cords less the cover: 0.9 weighs 1, and a tenth is taken off for each of them.
 */
START_TEST(rounding_is_charged_for_twice_the_cords_less_the_cover)
{
  static const double length[1] = {0.9};
  thr_frame f = chain_make(1, length);
  for (int cover = 1; cover <= 3; cover += 2)
    for (int cords = 2; cords <= 4; cords++) {
      thr_cord *cord = calloc((size_t)cords, sizeof *cord);
      int n = 0;
      add_loops(cord, &n, 0, cords);
      thr_plan_options o = options_for(THR_ENDS_CLOSED, cover);
      o.cords = o.cords_least = cords;
      thr_cut cut = {-1, 1, (int[]){0}, 1};
      int64_t price = 0;
      const thr_certificate c = {.scale = 1,
                                 .denominator = 1,
                                 .join = 2 * cords - cover,
                                 .sum = 1,
                                 .n_cuts = 1,
                                 .cut = &cut,
                                 .n_prices = 1,
                                 .place_price = &price};
      bool optimal;
      double bound;
      ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, cords, &c, 1, &optimal, &bound, NULL), THR_OK);
      ck_assert_int_eq(optimal, 2 * cords - cover == 1);
      ck_assert_double_eq_tol(bound, optimal ? 0.9 * 4 : 0.9 * cover + 1 - 0.1 * (2 * cords - cover), 1e-8);
      thr_cords_destroy(cord, n);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* One cord, six passes over an edge that needs three: a pass more would do, whatever the certificate's prices are. */
START_TEST(one_cord_is_charged_for_one_pass)
{
  static const double length[1] = {0.51};
  thr_frame f = chain_make(1, length);
  thr_cord cord = {.id = "A", .closed = true, .n_passes = 6, .half = (int[]){0, 1, 0, 1, 0, 1}};
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 3);
  thr_cut cut = {-1, 1, (int[]){0}, 1};
  int64_t price = 0;
  thr_certificate c = {
      .scale = 1, .denominator = 1, .join = 3, .sum = 1, .n_cuts = 1, .cut = &cut, .n_prices = 1, .place_price = &price};
  bool optimal;
  double bound;
  ck_assert_int_eq(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, &optimal, &bound, NULL), THR_OK);
  ck_assert_double_eq_tol(bound, 0.51 * 4, 1e-12);
  ck_assert(!optimal);
  thr_frame_destroy(&f);
}
END_TEST

/* A ring with a tail: the tail is passed twice. Every edge rounds up by a part of 4e-10, which together is far more than the part
 * of 5e-10 of the tail that may be taken off instead. */
START_TEST(rounding_of_what_is_passed_once_costs_little)
{
  enum { N = 200 };
  double xyz[N + 1][3] = {{0}}, length[N + 1];
  int edge[N + 1][2], half[N + 2];
  for (int v = 0; v < N; v++) {
    xyz[v][0] = cos(v * 0.01 * THR_PI), xyz[v][1] = sin(v * 0.01 * THR_PI);
    edge[v][0] = v, edge[v][1] = (v + 1) % N;
    half[v] = 2 * v;
  }
  xyz[N][0] = 3, edge[N][0] = 0, edge[N][1] = N;
  half[N] = 2 * N, half[N + 1] = 2 * N + 1;
  for (int e = 0; e <= N; e++)
    length[e] = 1 - 4e-10;
  thr_frame f = frame_make(N + 1, (const double(*)[3])xyz, N + 1, (const int(*)[2])edge, length, NULL);
  thr_cord cord = {.id = "A", .closed = true, .n_passes = N + 2, .half = half};
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  thr_cut cut = {-1, 1, (int[]){N}, 1};
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
  static const double part[] = {4e-10, 6e-10, 1e-7};
  for (int k = 0; k < 3; k++) {
    bool optimal;
    double bound, least = 0;
    for (int e = 0; e <= N; e++)
      least += f.length[e] = 1 - part[k];
    least += fmax(1 - (N + 1) * part[k], 1 - 5e-10 - (N + 1) * fmax(0, part[k] - 5e-10));
    ck_assert_int_eq(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, &optimal, &bound, NULL), THR_OK);
    ck_assert_int_eq(optimal, k < 2); /* within 1e-9 of the framework's length */
    if (!optimal) ck_assert_double_eq_tol(bound, least, 1e-10);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A weight rounded down leaves a gap of 1e-7 or 1e-10 of the framework's length. */
START_TEST(optimal_is_within_a_billionth)
{
  for (int k = 0; k < 2; k++) {
    double length[1] = {k ? 1 + 1e-10 : 1 + 1e-7}, bound;
    thr_frame f = chain_make(1, length);
    f.length[0] = length[0];
    thr_cord cord = {.id = "A", .closed = true, .n_passes = 2, .half = (int[]){0, 1}};
    thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
    thr_cut cut = {-1, 1, (int[]){0}, 1};
    thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
    bool optimal;
    ck_assert_int_eq(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, &optimal, &bound, NULL), THR_OK);
    ck_assert_int_eq(optimal, k);
    ck_assert_double_eq_tol(bound, k ? 2 * length[0] : length[0] + 1, 1e-15 + 1e-12);
    thr_err err = {0};
    c.scale = 2e18;
    ck_assert_int_eq(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, &optimal, &bound, &err), THR_EVIOLATED);
    assert_one_line(&err, "scale is too large");
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A ring and a tail of 1e9 in all. The tail weighs 4 of 5, which leaves a gap of a billionth exactly. */
START_TEST(a_gap_of_a_billionth_is_allowed)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  static const double length[4] = {333333330, 333333332, 333333333, 5};
  static const int edge[4][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}}, passes[4] = {1, 1, 1, 2};
  thr_frame f = frame_make(4, xyz, 4, edge, length, NULL);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  for (int k = 0; k < 2; k++) {
    thr_cut cut = {-1, 1, (int[]){3}, 2};
    const thr_certificate c = {.scale = 0.5, .denominator = 1, .join = 2, .sum = 2, .n_cuts = 1, .cut = &cut};
    bool optimal;
    double bound;
    f.length[0] -= k;
    ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL), THR_OK);
    ck_assert_int_eq(optimal, k == 0);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- prices ---- */

/* Price of the places that n passes of an edge are: one for each pass; closed, two for each pair, and of the other passes as many
 * as make a loop for every two places, rounded up. */
static int64_t places_price(bool closed, int64_t of, int loop, int n)
{
  if (!closed) return of * n;
  int64_t left = n % 2 ? 2 * of : 0;
  return 2 * of * (n / 2) + left / loop + (left % loop > 0);
}

/* Against every number of extra passes that there is room for, or the first few if there is no end. */
START_TEST(edges_at_their_price)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = path_make(2);
  for (int k = 0; k < 200; k++) {
    bool closed = rng_below(&r, 2), limited = rng_below(&r, 3) > 0;
    thr_plan_options o = options_for(closed ? THR_ENDS_CLOSED : THR_ENDS_FEET, 1 + rng_below(&r, 4));
    int room = rng_below(&r, 6), loop = rng_between(&r, 2, 10);
    int64_t weight = rng_below(&r, 20), of = rng_below(&r, 5) ? rng_below(&r, 30) : weight, best[2] = {INT64_MAX, INT64_MAX};
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
      ck_assert_int_eq(weight * p.passes[i] - places_price(closed, of, loop, o.cover + p.passes[i]) + held, best[i]);
    }
  }
  thr_plan_options o = options_for(THR_ENDS_COUNTS, 1);
  ck_assert_int_eq(thr_prices_number(&o, 7), 7);
  want(&o, "overlap,steps");
  ck_assert_int_eq(thr_prices_number(&o, 7), 0);
  o = options_for(THR_ENDS_FEET, 1);
  ck_assert_int_eq(thr_prices_number(&o, 7), 1);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- several cords ---- */

/* Shortest distances by Floyd and Warshall, and the longest of: what edge must be gone over from end to end or round; the cord
 * that all need, shared out; in whole units, if lengths have one. */
static double longest_by_definition(const thr_frame *f, const thr_plan_options *o, double base, int most, double unit)
{
  double far[16][16], bound = base / most;
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
  thr_frame f = random_frame(&r, rng_between(&r, 3, 9), rng_below(&r, 5), kind);
  thr_plan_options o = options_for(ends[_i / 3 % 3], 1 + rng_below(&r, 2));
  o.cords = 1 + rng_below(&r, 6);
  o.cords_least = 1 + rng_below(&r, o.cords);
  thr_plan p;
  thr_cords_claim found;
  thr_err err = {0};
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
  if (st == THR_OK || st == THR_ELIMIT) {
    ck_assert_msg(thr_check_cords(&f, &o, p.cord, p.n_cords, NULL, 0, &found, &err) == THR_OK, "%s", err.text);
    double longest = 0, base = 0;
    for (int i = 0; i < p.n_cords; i++)
      longest = fmax(longest, thr_cord_length(&f, &p.cord[i]));
    for (int e = 0; e < f.n_edges; e++)
      base += o.cover * f.length[e];
    double bound = longest_by_definition(&f, &o, base, o.cords, kind == LENGTHS_SMALL_INTEGERS ? thr_plan_unit(&f) : 0);
    ck_assert_double_eq_tol(found.longest, longest, 1e-9);
    ck_assert_double_eq_tol(found.longest_bound, fmin(longest, bound), 1e-9);
    ck_assert_int_eq(found.longest_optimal, bound > longest - 1e-9 * longest);
    ck_assert_int_eq(found.fewest, 0);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Every edge there and back by a cord of its own, on complete graphs where the way round is often shorter than an edge. */
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
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = o.cords_least = m;
  thr_cords_claim found;
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, m, NULL, 0, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest, longest, 1e-12);
  ck_assert_double_eq_tol(found.longest_bound, fmin(longest, longest_by_definition(&f, &o, base, m, 0)), 1e-9);
  thr_cords_destroy(cord, m);
  thr_frame_destroy(&f);
}
END_TEST

/* Three cords there and back share a chain of 1, 1 and 5: that over the last edge has 10, whatever comes before it. */
START_TEST(the_worst_edge_may_be_the_last)
{
  static const double length[3] = {1, 1, 5};
  thr_frame f = chain_make(3, length);
  thr_cord *cord = calloc(3, sizeof *cord);
  int n = 0;
  for (int e = 0; e < 3; e++)
    add_loops(cord, &n, e, 1);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = o.cords_least = 3;
  thr_cords_claim found;
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, 3, NULL, 0, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest_bound, 10, 1e-12);
  thr_cords_destroy(cord, 3);
  thr_frame_destroy(&f);
}
END_TEST

/* A bound of 5 and a little more is 6 where all lengths are whole, unless the little is rounding: a verdict about one cord there
 * and back on a chain 1, 2. */
START_TEST(bounds_are_whole_numbers_of_the_unit)
{
  static const double length[2] = {1, 2};
  static const struct {
    double bound, whole;
  } cases[] = {{5, 5}, {5 + 5e-10, 5}, {5 + 5e-6, 6}, {4.5, 5}};
  thr_frame f = chain_make(2, length);
  int half[4] = {0, 2, 3, 1}, component[3] = {0}, passes[2] = {2, 2};
  const thr_cord cord = {.id = "A", .closed = true, .n_passes = 4, .half = half};
  const thr_check_walked w = {1, component, passes};
  const thr_certificate c = {.scale = 1, .denominator = 1};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
    const thr_check_verdict verdict = {.extra = cases[i].bound - 3};
    thr_cords_claim found;
    ck_assert_int_eq(thr_check_several(&f, &o, &w, &cord, 1, &c, &verdict, NULL, &found, NULL), THR_OK);
    ck_assert_double_eq_tol(found.longest_bound, cases[i].whole, 1e-12);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Lengths have a common step, or none. */
START_TEST(cords_have_whole_numbers_of_the_unit)
{
  static const double whole[] = {6, 10, 15}, half[] = {1.5, 2.5, 4}, none[] = {1, 1.4142135623730951, 2};
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

/* Two cords there and back on a chain 1, 2: no fewer are allowed where they may have so much; the framework needs 6 in all. */
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
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = 2;
  o.cords_least = 1;
  ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, 2, &c, 1, &optimal, &bound, NULL), THR_OK);
  ck_assert(optimal);
  ck_assert_double_eq(bound, 6);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_cords_claim found;
    thr_err err = {0};
    o.max_length = cases[i].most;
    ck_assert_msg(thr_check_cords(&f, &o, cord, 2, &c, 1, &found, &err) == THR_OK, "%s", err.text);
    ck_assert_int_eq(found.fewest, cases[i].fewest);
    ck_assert_int_eq(found.fewest_optimal, cases[i].fewest == 2);
  }
  thr_cords_claim found;
  o.max_length = 100;
  o.cords = 3, o.cords_least = 2; /* no fewer are asked for */
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, &c, 1, &found, NULL), THR_OK);
  ck_assert_int_eq(found.fewest, 2);
  o.cords = 2, o.cords_least = 1;
  o.max_length = 4 - 1e-8; /* the cord over edge 1 is longer */
  ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, &c, 1, &found, NULL), THR_EVIOLATED);
  thr_cords_destroy(cord, 2);
  thr_frame_destroy(&f);
}
END_TEST

/* Four cords through a cube's twelve edges, three each: eight ends leave no edge to be passed twice, fewer would. */
START_TEST(ends_pay_for_extra_passes)
{
  thr_frame f = solid_make(CUBE);
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
  o.cords = o.cords_least = 4;
  thr_plan p = plan_of_cords(&f, &o);
  thr_cords_claim found;
  thr_err err = {0};
  ck_assert_double_eq_tol(p.metrics.length, 12, 1e-9);
  ck_assert_msg(thr_check_cords(&f, &o, p.cord, 4, p.proof.certificate, 1, &found, &err) == THR_OK, "%s", err.text);
  ck_assert_double_eq_tol(found.longest_bound, 3, 1e-9);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* All nodes of a tetrahedron are odd, and one end at each leaves no edge to be passed twice: two cords share six edges. */
START_TEST(given_ends_are_those_of_half_as_many_cords)
{
  int end_count[4] = {1, 1, 1, 1}, half[2][3];
  thr_frame f = solid_make(TETRAHEDRON);
  static const int walk[2][4] = {{0, 1, 2, 3}, {1, 3, 0, 2}};
  thr_cord cord[2];
  thr_plan_options o = options_for(THR_ENDS_COUNTS, 1);
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
  ck_assert_msg(thr_check_cords(&f, &o, cord, 2, NULL, 0, &found, &err) == THR_OK, "%s", err.text);
  ck_assert_double_eq_tol(found.longest_bound, 3 * f.length[0], 1e-9);
  ck_assert(found.longest_optimal);
  thr_frame_destroy(&f);
}
END_TEST

/* Nested odd sets of nodes of a complete graph, all of whose nodes are odd. The sum of the multipliers of the sets that hold one
 * end of an edge, added up set by set, may be as much as its weight, and no more. */
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
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
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

/* Where a place costs 13 and a pass 10, as many passes of edge 0 as fit are cheapest: two more or three. One less costs 3 more,
 * and so much may cuts over the edge add up to: round node 0, if two more leave it odd; round node 1, if three make it odd. */
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
      thr_plan_options o = options_for(THR_ENDS_FEET, 1);
      bool optimal;
      double bound;
      thr_err err = {0};
      f.foot[0] = true;
      o.capacity = 1 + room;
      c.join = 10 * (room - 1), c.n_prices = 1, c.place_price = &price;
      thr_status st = thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err);
      ck_assert_msg(st == (value > 3 ? THR_EVIOLATED : THR_OK), "%s", err.text);
      if (st) assert_one_line(&err, "the cuts over edge 0 add up");
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
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    int node[3], passes[2] = {2, 2};
    memcpy(node, cases[i].node, sizeof node);
    thr_cut cut = {-1, cases[i].n, node, 0};
    const thr_certificate c = {.scale = 1, .denominator = 1, .join = 2, .n_cuts = 1, .cut = &cut};
    bool optimal;
    double bound;
    thr_err err = {0};
    thr_status st = thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err);
    ck_assert_msg(st == (cases[i].said ? THR_EVIOLATED : THR_OK), "%s", err.text);
    if (st) assert_one_line(&err, cases[i].said);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Three edges by themselves: in none of them may a cut round an end have more than the price of an end. */
START_TEST(end_prices_hold_in_every_component)
{
  double xyz[6][3] = {{0}};
  static const int edge[3][2] = {{0, 1}, {2, 3}, {4, 5}}, passes[3] = {1, 1, 1};
  for (int v = 0; v < 6; v++)
    xyz[v][0] = v % 2, xyz[v][1] = v / 2;
  thr_frame f = frame_make(6, (const double(*)[3])xyz, 3, edge, NULL, NULL);
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
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
      c[i] = (thr_certificate){
          .component = i, .scale = 10, .denominator = 1, .sum = cut[i].value, .end_price = 1, .n_cuts = 1, .cut = &cut[i]};
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

/* Two cords there and back over one edge. At a price of 0.8 of the weight for each of their places a second pass of the edge
 * pays, so that both of its nodes are even; at none, they are odd, and either may be cut off. */
START_TEST(prices_change_the_parity_of_both_nodes)
{
  static const double length[1] = {1};
  thr_frame f = chain_make(1, length);
  thr_cord *cord = calloc(2, sizeof *cord);
  int n = 0;
  add_loops(cord, &n, 0, 2);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = o.cords_least = 2;
  for (int v = 0; v < 2; v++)
    for (int64_t price = 0; price <= 8; price += 8) {
      thr_cut cut = {-1, 1, &v, 1};
      thr_certificate c = {.scale = 10, .denominator = 1, .join = 30, .sum = 1, .n_cuts = 1, .cut = &cut};
      c.n_prices = 1, c.place_price = &price;
      bool optimal;
      double bound;
      thr_err err = {0};
      thr_status st = thr_check_length_proof(&f, &o, cord, 2, &c, 1, &optimal, &bound, &err);
      ck_assert_msg(st == (price ? THR_EVIOLATED : THR_OK), "%s", err.text);
      if (price) assert_one_line(&err, "even number of odd nodes");
    }
  thr_cords_destroy(cord, 2);
  thr_frame_destroy(&f);
}
END_TEST

/* Passes that one closed cord can run through are no two cords', whose places are worth more than these passes weigh. */
START_TEST(bounds_above_the_passes_are_refused)
{
  static const double length[1] = {1};
  static const int passes[1] = {2};
  thr_frame f = chain_make(1, length);
  for (int cords = 1; cords <= 2; cords++) {
    thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
    int64_t price = 1;
    const thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .n_prices = 1, .place_price = &price};
    bool optimal;
    double bound;
    thr_err err = {0};
    o.cords = o.cords_least = cords;
    thr_status st = thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err);
    ck_assert_msg(st == (cords > 1 ? THR_EVIOLATED : THR_OK), "%s", err.text);
    if (st) assert_one_line(&err, "its bound is above the weight of the plan's own extra passes");
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Three edges by themselves, there and back: each certificate weighs what its own component has. */
START_TEST(certificates_weigh_their_own_component)
{
  static const double xyz[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 9, 0}, {2, 9, 0}, {0, 18, 0}, {4, 18, 0}};
  static const int edge[3][2] = {{0, 1}, {2, 3}, {4, 5}}, passes[3] = {2, 2, 2};
  thr_frame f = frame_make(6, xyz, 3, edge, NULL, NULL);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
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
    ck_assert_msg(st == (wrong < 0 ? THR_OK : THR_EVIOLATED), "%s", err.text);
    if (st) assert_one_line(&err, "the extra passes do not weigh");
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
  } cases[] = {{1, 1, NULL},       {0, 1, "positive"},  {-1, 1, "positive"},        {NAN, 1, "positive"},
               {1, 0, "positive"}, {1, -1, "positive"}, {INFINITY, 1, "too large"}, {1e18, 1, "too large"}};
  static const double length[1] = {1};
  thr_frame f = chain_make(1, length);
  thr_cord *cord = calloc(1, sizeof *cord);
  int n = 0;
  add_loops(cord, &n, 0, 1);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    int64_t price = 0;
    thr_certificate c = {.scale = cases[i].scale, .denominator = cases[i].denominator, .join = 1, .place_price = &price};
    for (c.n_prices = 0; c.n_prices < 2; c.n_prices++) {
      bool optimal;
      double bound;
      thr_err err = {0};
      thr_status st = thr_check_length_proof(&f, &o, cord, 1, &c, 1, &optimal, &bound, &err);
      ck_assert_msg(st == (cases[i].said ? THR_EVIOLATED : THR_OK), "%s", err.text);
      if (st) assert_one_line(&err, cases[i].said);
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
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  ck_assert_int_eq(thr_plan_request(&p, &f, &o, NULL), THR_OK);
  p.cord = calloc(1, sizeof *p.cord);
  add_loops(p.cord, &p.n_cords, 0, 1);
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 1, &p.metrics, NULL), THR_OK);
  thr_cut cut = {-1, 1, (int[]){0}, 1};
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
  p.proof = (thr_length_proof){.present = true, .optimal = true, .lower_bound = 2, .n_certificates = 1, .certificate = &c};
  thr_err err = {0};
  ck_assert_msg(thr_check_plan(&p, &err) == THR_OK, "%s", err.text);
  p.proof.tied.n_nodes = 1;
  ck_assert_int_eq(thr_check_plan(&p, &err), THR_EVIOLATED);
  assert_one_line(&err, "has a proof, but the plan's joints are solid");
  p.proof = (thr_length_proof){0};
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A ring with an edge so short that it weighs nothing, and a tail, which is passed twice: that is optimal all the same. */
START_TEST(weightless_edges_passed_once_cost_nothing)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0.3, 0}, {-1, 0, 0}}, length[4] = {1, 0.3, 1, 1};
  static const int edge[4][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}};
  thr_frame f = frame_make(4, xyz, 4, edge, length, NULL);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  thr_cut cut = {-1, 1, (int[]){3}, 1};
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
  int passes[4] = {1, 1, 1, 2};
  bool optimal;
  double bound;
  thr_err err = {0};
  ck_assert_msg(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err) == THR_OK, "%s", err.text);
  ck_assert(optimal);
  ck_assert_double_eq_tol(bound, 4.3, 1e-12);
  passes[1] = 3; /* more of it than is needed, which no weight shows */
  ck_assert_msg(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err) == THR_OK, "%s", err.text);
  ck_assert(!optimal);
  ck_assert_double_eq_tol(bound, 4.3, 1e-12);
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
    thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
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

/* Two edges, together as long as rounding lets a cord of 1 be, which then is enough; and longer by as little as can be. */
START_TEST(a_cord_may_be_as_long_as_rounding_lets_it)
{
  const double most = 1 + 2e-9;
  for (int more = 0; more < 2; more++) {
    double length[2] = {most / 2, most / 2};
    thr_frame f = chain_make(2, length);
    int half[2] = {0, 2};
    thr_cord cord[2] = {{.id = "A", .n_passes = 1, .half = half}, {.id = "B", .n_passes = 1, .half = half + 1}};
    thr_plan_options o = options_for(THR_ENDS_ANY, 1);
    thr_cords_claim found;
    o.cords = 2, o.cords_least = 1;
    o.max_length = 1;
    f.length[0] = most / 2;
    f.length[1] = more ? nextafter(most / 2, 1) : most / 2;
    ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, NULL, 0, &found, NULL), THR_OK);
    ck_assert_int_eq(found.fewest, 1 + more);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Cords that end anywhere on a star with six legs of 1: K of them leave 6 - 2 K tips that are no ends, each of which costs an
 * extra pass. As multipliers: 1 for every tip, 1 for every end. */
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
  const thr_certificate c = {.scale = 1, .denominator = 1, .sum = 6, .end_price = 1, .n_cuts = 6, .cut = cut};
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
  o.cords = 3, o.cords_least = 1;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_cords_claim found;
    thr_err err = {0};
    o.max_length = cases[i].most;
    ck_assert_msg(thr_check_cords(&f, &o, cord, 3, &c, 1, &found, &err) == THR_OK, "%s", err.text);
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
  const thr_certificate c = {.scale = 1, .denominator = 1, .join = 2, .sum = 1, .n_cuts = 1, .cut = &cut};
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  thr_cords_claim found;
  ck_assert_int_eq(thr_check_cords(&f, &o, &cord, 1, &c, 1, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest, 4, 1e-12);
  ck_assert_double_eq_tol(found.longest_bound, 3, 1e-9);
  ck_assert(!found.longest_optimal);
  thr_frame_destroy(&f);
}
END_TEST

/* No proof that holds proves more than a plan has. Of verdicts that are said to, and of more cord than the options allow, the
 * checker tells: one cord there and back on a chain, which needs half of it. */
START_TEST(bounds_beyond_the_plan_are_refused)
{
  static const double length[2] = {1, 1.4142135623730951}, all = 2.4142135623730951;
  static const struct {
    double part, most;
    const char *said;
  } cases[] = {{2 + 0.9e-9, 0, NULL},
               {2 + 2.2e-9, 0, "the longest cord of any plan would have"},
               {3, 0, "the longest cord of any plan would have 7.24264068712 or more, but this plan's has 4.82842712475"},
               {1, 2, "any plan would have 2 cords or more, but this one has 1"},
               {1, 3, NULL}};
  thr_frame f = chain_make(2, length);
  int half[4] = {0, 2, 3, 1}, component[3] = {0}, passes[2] = {2, 2};
  const thr_cord cord = {.id = "A", .closed = true, .n_passes = 4, .half = half};
  const thr_check_walked w = {1, component, passes};
  const thr_certificate c = {.scale = 1, .denominator = 1};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
    const thr_check_verdict verdict = {.extra = (cases[i].part - 1) * all};
    thr_cords_claim found;
    thr_err err = {0};
    o.max_length = cases[i].most;
    o.cords = cases[i].most > 0 ? 3 : 1, o.cords_least = 1;
    thr_status st = thr_check_several(&f, &o, &w, &cord, 1, &c, &verdict, NULL, &found, &err);
    ck_assert_msg(st == (cases[i].said ? THR_EVIOLATED : THR_OK), "case %zu: %s", i, err.text);
    if (st) assert_one_line(&err, cases[i].said);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Of a symmetric plan the component with most cords has as many as asked for, whichever it is. */
START_TEST(symmetric_cords_are_counted_where_most_are)
{
  thr_frame f = triangles_make(2);
  for (int most = 0; most < 2; most++) {
    int half[3][3];
    thr_cord cord[3];
    for (int i = 0; i < 3; i++) {
      int component = i < 2 ? i : most;
      for (int k = 0; k < 3; k++)
        half[i][k] = 6 * component + 2 * k;
      for (int k = 0; k < 3; k++) /* each edge the way round */
        if (thr_head(&f, half[i][k]) != thr_tail(&f, half[i][(k + 1) % 3])) half[i][k] ^= 1;
      cord[i] = (thr_cord){.closed = true, .component = component, .n_passes = 3, .half = half[i]};
      thr_cord_id(i, cord[i].id);
    }
    thr_certificate c[2] = {{.scale = 1, .denominator = 1}, {.component = 1, .scale = 1, .denominator = 1}};
    c[most].join = 3;
    for (int cords = 1; cords <= 3; cords++) {
      thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
      bool optimal;
      double bound;
      thr_err err = {0};
      want(&o, "overlap,steps");
      o.cords = o.cords_least = cords;
      thr_status st = thr_check_length_proof(&f, &o, cord, 3, c, 2, &optimal, &bound, &err);
      ck_assert_msg(st == (cords == 2 ? THR_OK : THR_EVIOLATED), "%s", err.text);
      char said[64];
      snprintf(said, sizeof said, "component %d: has 2 cords; the plan's options say %d", most, cords);
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
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
  for (int twice = -1; twice < 2; twice++) {
    int half[3][3];
    thr_cord cord[3];
    for (int i = 0; i < 3; i++) {
      int component = i < 2 ? i : twice;
      for (int k = 0; k < 3 && component >= 0; k++)
        half[i][k] = 6 * component + 2 * k;
      for (int k = 0; k < 3 && component >= 0; k++) /* each edge the way round */
        if (thr_head(&f, half[i][k]) != thr_tail(&f, half[i][(k + 1) % 3])) half[i][k] ^= 1;
      cord[i] = (thr_cord){.closed = true, .component = component, .n_passes = 3, .half = half[i]};
      thr_cord_id(i, cord[i].id);
    }
    thr_cords_claim found;
    thr_err err = {0};
    thr_status st = thr_check_cords(&f, &o, cord, twice < 0 ? 2 : 3, NULL, 0, &found, &err);
    ck_assert_msg(st == (twice < 0 ? THR_OK : THR_EVIOLATED), "%s", err.text);
    char said[64];
    snprintf(said, sizeof said, "component %d: has 2 cords; the plan's options say 1", twice);
    if (st) assert_one_line(&err, said);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- failures last ---- */

/* What is wrong early is wrong whatever follows, and nothing is found then. */
START_TEST(failures_are_not_forgotten)
{
  static const double length[2] = {1, 2};
  thr_frame f = chain_make(2, length);
  thr_cord *cord = calloc(2, sizeof *cord);
  int n = 0, passes[2] = {2, 2};
  bool optimal;
  double bound;
  add_loops(cord, &n, 0, 1);
  add_loops(cord, &n, 1, 1);
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 3}, wrong = c;
  wrong.join = 2;
  for (int k = 0; k < 5; k++) {
    thr_plan_options o = options_for(THR_ENDS_CLOSED, k == 1 ? 3 : 1);
    o.cords = o.cords_least = k == 2 ? 1 : k == 3 ? 3 : 2;
    const thr_certificate *proof = k == 4 ? &wrong : &c;
    thr_status expected = k ? THR_EVIOLATED : THR_OK;
    thr_turning_proof tied = {0};
    thr_cords_claim found;
    ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, 2, proof, 1, &optimal, &bound, NULL), expected);
    ck_assert_int_eq(thr_check_cords(&f, &o, cord, 2, proof, 1, &found, NULL), expected);
    ck_assert_int_eq(found.present, k == 0);
    ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, 2, &tied, &found, NULL), THR_EVIOLATED); /* that proof is empty */
    ck_assert_int_eq(thr_check_length_proof(&f, &o, cord, 2, NULL, 0, &optimal, &bound, NULL), THR_EVIOLATED);
    if (k != 2 && k != 3)
      ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, proof, 1, &optimal, &bound, NULL), expected);
  }
  thr_cords_destroy(cord, 2);
  thr_frame_destroy(&f);
}
END_TEST

/* On a chain that is passed there and back, of whichever edge none or too many pairs are. */
START_TEST(every_edge_is_covered_and_has_room)
{
  static const double length[3] = {1, 1, 1};
  thr_frame f = chain_make(3, length);
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 2);
  o.capacity = 3;
  for (int e = -1; e < 3; e++)
    for (int more = -2; more <= 2; more += 4) {
      int passes[3] = {2, 2, 2};
      if (e >= 0) passes[e] += more;
      const thr_certificate c = {.scale = 1, .denominator = 1};
      bool optimal;
      double bound;
      thr_err err = {0};
      thr_status st = thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err);
      ck_assert_msg(st == (e < 0 ? THR_OK : THR_EVIOLATED), "%s", err.text);
      char said[96];
      snprintf(said, sizeof said, "edge %d (nodes %d and %d): %s", e, e, e + 1, more < 0 ? "0 of 2" : "4 passes, but only 3");
      if (st) assert_one_line(&err, said);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* Both ends of a cord are where ends may be; and a greatest length below 1 is one, too. */
START_TEST(cords_end_where_they_may_and_are_no_longer)
{
  static const double length[2] = {0.25, 0.5};
  thr_frame f = chain_make(2, length);
  int half[2][2] = {{0, 2}, {3, 1}};
  for (int foot = -1; foot < 3; foot += 2)
    for (int back = 0; back < 2; back++) {
      const thr_cord cord = {.id = "A", .n_passes = 2, .half = half[back]};
      thr_plan_options o = options_for(foot < 0 ? THR_ENDS_ANY : THR_ENDS_FEET, 1);
      thr_cords_claim found;
      thr_err err = {0};
      for (int v = 0; v < 3; v++)
        f.foot[v] = v == foot + 1; /* node 2 */
      o.max_length = foot < 0 ? 0.7 : 0.75;
      ck_assert_int_eq(thr_check_cords(&f, &o, &cord, 1, NULL, 0, &found, &err), THR_EVIOLATED);
      assert_one_line(&err, foot < 0 ? "0.75 long; the plan's options allow 0.7" : back ? "ends at node 0" : "starts at node 0");
    }
  const thr_cord cord = {.id = "A", .n_passes = 2, .half = half[0]};
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
  thr_cords_claim found;
  o.max_length = 0.75;
  ck_assert_int_eq(thr_check_cords(&f, &o, &cord, 1, NULL, 0, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.longest_bound, 0.75, 1e-9);
  thr_frame_destroy(&f);
}
END_TEST

/* So many odd nodes as there are cord ends in a component, and no more; given ends have the parity of their passes. */
START_TEST(passes_leave_ends_for_the_cords)
{
  thr_frame f = star_make(4); /* the tips are odd, the hub is even */
  int passes[4] = {1, 1, 1, 1}, end_count[5] = {0, 1, 1, 1, 1};
  bool optimal;
  double bound;
  for (int cords = 1; cords <= 3; cords++) {
    thr_plan_options o = options_for(THR_ENDS_ANY, 1);
    thr_certificate c = {.scale = 1, .denominator = 1};
    o.cords = o.cords_least = cords;
    ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL),
                     cords < 2 ? THR_EVIOLATED : THR_OK);
  }
  thr_plan_options o = options_for(THR_ENDS_COUNTS, 1);
  thr_certificate c = {.scale = 1, .denominator = 1};
  o.cords = o.cords_least = 2;
  o.end_count = end_count;
  ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL), THR_OK);
  end_count[1] = 2, end_count[0] = 1;
  ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL), THR_EVIOLATED);
  thr_frame_destroy(&f);
}
END_TEST

/* An edge passed once, and an end where a foot is: the other of its nodes is odd, and no cord ends there. */
START_TEST(every_odd_node_has_an_end)
{
  static const double length[1] = {1};
  static const int passes[1] = {1};
  thr_frame f = chain_make(1, length);
  for (int foot = 0; foot < 2; foot++) {
    thr_plan_options o = options_for(THR_ENDS_FEET, 1);
    const thr_certificate c = {.scale = 1, .denominator = 1};
    bool optimal;
    double bound;
    thr_err err = {0};
    f.foot[foot] = true, f.foot[!foot] = false;
    ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, &err), THR_EVIOLATED);
    assert_one_line(&err, foot ? "node 0: 1 passes" : "node 1: 1 passes");
  }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- tube joints ---- */

/* Two triangles that share node 0: neither a cord round each nor one round both ties all four edges there. */
START_TEST(tube_joints_are_tied)
{
  static const double xyz[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  static const int half[6] = {0, 2, 4, 6, 8, 10};
  thr_frame f = frame_make(5, xyz, 6, edge, NULL, NULL);
  thr_plan p = {0};
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
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
  thr_err err = {0};
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 2, &p.metrics, NULL), THR_OK);
  ck_assert_int_eq(thr_check_plan(&p, &err), THR_EVIOLATED);
  assert_one_line(&err, "node 0: the cords do not tie");
  p.n_cords = 1; /* once through all: 2 -> 3 and 4 -> 1 at node 0, which ties 0-2 to 0-3 and 0-4 to 0-1, and not these pairs */
  memcpy(p.cord[0].half, half, sizeof half);
  p.cord[0].n_passes = 6;
  ck_assert_int_eq(thr_plan_measure(&f, &o, p.cord, 1, &p.metrics, NULL), THR_OK);
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
  p.options.joint = THR_JOINT_SOLID;
  err = (thr_err){0};
  ck_assert_msg(thr_check_plan(&p, &err) == THR_OK, "%s", err.text);
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
  thr_plan_options o = options_for(THR_ENDS_CLOSED, 1);
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
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
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
  thr_err err = {0};
  ck_assert_int_eq(thr_check_plan(&p, &err), THR_EVIOLATED);
  assert_one_line(&err, "pass 1: turns back at node 0");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Is every edge at the node joined to every other by turns of the cords? By spreading from the first until nothing is new. */
static bool tied_by_turns(const thr_frame *f, const thr_cord *cord, int n_cords, bool closing, int v)
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

/* What a proof of length with tube joints is about; and with multipliers that prove an extra pass of edge 0. */
START_TEST(proofs_of_tied_length_are_about_the_plan)
{
  static const double length[3] = {2, 3, 1};
  thr_frame f = chain_make(3, length);
  bool allowed[4];
  thr_turning_task t;
  int count[4] = {1, 0, 0, 1};
  f.foot[0] = true;
  for (int k = 0; k < 3; k++) {
    thr_plan_options o = options_for(k == 0 ? THR_ENDS_CLOSED : k == 1 ? THR_ENDS_FEET : THR_ENDS_COUNTS, 2);
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
  thr_plan_options o = options_for(THR_ENDS_FEET, 1);
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
  thr_turning_proof proof = {1, 1, 1, &leaf, &dual};
  double least;
  ck_assert_int_eq(thr_tied_least(&f, &o, &proof, &least, NULL), THR_OK);
  ck_assert_double_eq_tol(least, 6, 1e-12);
  int member[1] = {0};
  thr_turning_set odd = {1, member, (int64_t)1 << 43};
  dual.odd = &odd, dual.n_odd = 1;
  o.ends =
      THR_ENDS_CLOSED; /* nothing but an extra pass leaves half-edge 0, alone at its node: 2 * 0.5 a pass, and 0.5 is taken */
  ck_assert_int_eq(thr_tied_least(&f, &o, &proof, &least, NULL), THR_OK);
  ck_assert_double_eq_tol(least, 6 + 0.5 / 0.5, 1e-9);
  odd.value = -1;
  ck_assert_int_eq(thr_tied_least(&f, &o, &proof, &least, NULL), THR_EVIOLATED);
  ck_assert_double_eq(least, 0);
  thr_frame_destroy(&f);
}
END_TEST

/* An edge costs its part of all length, times their number; but no edge more than 5,000. Whatever the unit of length is. */
START_TEST(prices_of_tied_length_are_moderate)
{
  enum { N = 6000 };
  thr_frame f = path_make(N + 1);
  bool *allowed = calloc(N + 1, sizeof *allowed);
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
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

/* A chain of four edges of about 1, tied at three nodes, with K cords that end anywhere: twice the passes less twice the turns,
 * of which there are three or more, are 2 K ends, so that there are K + 3 passes or more. As multipliers: half of the weight of a
 * pass for the ends, less as much for every half-edge, twice it for every junction. Cords of two edges at most: three are needed,
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
  int64_t unit = (int64_t)floor(ldexp(4 / all, THR_TURNING_BITS)) / 2, potential[8], ends[1] = {unit};
  for (int h = 0; h < 8; h++)
    potential[h] = -unit;
  thr_turning_junction junction[3] = {{1, block, 2 * unit}, {2, block, 2 * unit}, {3, block, 2 * unit}};
  thr_turning_dual dual = {.potential = potential, .ends = ends, .n_junctions = 3, .junction = junction};
  thr_turning_node leaf = {0};
  thr_turning_proof proof = {1, 1, 1, &leaf, &dual};
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
  thr_cords_claim found;
  thr_err err = {0};
  o.joint = THR_JOINT_TUBE;
  o.max_length = 2.002;
  for (int most = 3; most <= 5; most++)
    for (int least = 1; least <= 3; least++) {
      o.cords = most, o.cords_least = least;
      ck_assert_msg(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err) == THR_OK, "%s", err.text);
      ck_assert_double_eq_tol(found.longest, 2.0018, 1e-12);
      ck_assert_double_eq_tol(found.longest_bound, fmax(1.0011, (all + least - 1) / most), 1e-9);
      ck_assert_int_eq(found.fewest, least < most ? 3 : 0); /* asked for exactly, they are not claimed */
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
  ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err), THR_EVIOLATED);
  assert_one_line(&err, "has 3 cords; the plan's options say 1 to 2");
  thr_frame_destroy(&f);
}
END_TEST

/* A star of four legs, tied at its hub by three turns: at every tip the cords end that pass there, so that there are six passes,
 * and three cords. As multipliers: a large one off the ends, which fewer cords have too few of, and what it takes for the
 * junction to give that back. Two cords of 3 would be long enough for the passes. */
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
    thr_turning_dual dual = {.potential = potential, .ends = ends, .n_junctions = 1, .junction = &junction};
    thr_turning_node leaf = {0};
    thr_turning_proof proof = {1, 1, 1, &leaf, &dual};
    thr_plan_options o = options_for(THR_ENDS_ANY, 1);
    thr_cords_claim found;
    thr_err err = {0};
    o.joint = THR_JOINT_TUBE;
    o.cords = 3, o.cords_least = 1;
    o.max_length = 3 * size[k];
    ck_assert_msg(thr_check_tied_cords(&f, &o, cord, 3, &proof, &found, &err) == THR_OK, "%s", err.text);
    ck_assert_int_eq(found.fewest, 3);
    ck_assert_double_eq_tol(found.longest_bound, 2 * size[k], 1e-9);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Two chains of four edges, with three cords each: K cords or more in each of them have 2 (4 + K - 1) or so together, and so many
 * cords of the greatest length hold that. What may be too few cords for one component says nothing about two. */
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
  int64_t unit = (int64_t)floor(ldexp(4 / all, THR_TURNING_BITS)) / 2, potential[16], ends[2] = {unit, unit};
  for (int h = 0; h < 16; h++)
    potential[h] = -unit;
  thr_turning_junction junction[6];
  for (int i = 0; i < 6; i++)
    junction[i] = (thr_turning_junction){i + 1 + 2 * (i / 3), block, 2 * unit};
  thr_turning_dual dual = {.potential = potential, .ends = ends, .n_junctions = 6, .junction = junction};
  thr_turning_node leaf = {0};
  thr_turning_proof proof = {1, 1, 2, &leaf, &dual};
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
  o.joint = THR_JOINT_TUBE;
  o.cords = 3;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    thr_cords_claim found;
    thr_err err = {0};
    o.cords_least = cases[i].least;
    o.max_length = cases[i].most;
    ck_assert_msg(thr_check_tied_cords(&f, &o, cord, 6, &proof, &found, &err) == THR_OK, "%s", err.text);
    ck_assert_int_eq(found.fewest, cases[i].fewest);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Cords of 2 over a chain of 1, 1, 1 and 1; a tree that proves no more than that every edge is passed once. Two cords of 2 are
 * enough, and of 2 less a rounding; and a tree that proves nothing fails, however few cords there may be. */
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
  thr_turning_proof proof = {1, 1, 1, &leaf, &dual};
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
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
    ck_assert_int_eq(thr_check_tied_cords(&f, &o, cord, n - 1, &proof, &found, NULL), THR_EVIOLATED);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* The same of two cords on two edges, over both and over the first: the multipliers take so much of what a pass of that costs. */
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
  thr_plan_options o = options_for(THR_ENDS_ANY, 1);
  thr_plan *p = &x->plan;
  int64_t unit = (int64_t)floor(ldexp(part * (2 / (length[0] + length[1]) * length[0]), THR_TURNING_BITS)) / 2;
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
  x->dual = (thr_turning_dual){.potential = x->potential, .ends = x->ends, .n_junctions = 1, .junction = &x->junction};
  ck_assert_int_eq(thr_plan_measure(&f, &o, p->cord, 2, &p->metrics, NULL), THR_OK);
  p->proof = (thr_length_proof){
      .present = true, .optimal = true, .lower_bound = p->metrics.length, .tied = {1, 1, 1, &x->leaf, &x->dual}};
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
    ck_assert_msg(thr_check_plan(p, &err) == THR_OK, "%s", err.text);
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
    thr_err err = {0};
    tied_pair_make(&x, length, 1);
    const thr_plan *p = &x.plan;
    ck_assert_int_eq(thr_tied_least(&p->frame, &p->options, &p->proof.tied, &least, NULL), THR_OK);
    above += least > 2 * length[0] + length[1];
    ck_assert_msg(thr_check_plan(p, &err) == THR_OK, "%s", err.text);
    tied_pair_destroy(&x);
  }
  ck_assert_int_gt(above, 0);
}
END_TEST

/* ---- metrics ---- */

/* Of a straight cord, which turns by nothing: angles are compared with 1, too. */
START_TEST(angles_of_a_straight_cord_may_round)
{
  thr_frame f = path_make(4);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  double *const angle[] = {&p.metrics.turning, &p.metrics.max_turning, &p.metrics.worst_turn};
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  for (int i = 0; i < 3; i++) {
    double kept = *angle[i];
    ck_assert_double_eq(kept, 0);
    *angle[i] = 0.9e-9;
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    *angle[i] = 1.1e-9;
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
    *angle[i] = kept;
  }
  double *const size[] = {&p.metrics.length, &p.metrics.base_length};
  for (int i = 0; i < 2; i++) {
    double kept = *size[i];
    *size[i] = kept * (1 + 0.9e-9);
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
    *size[i] = kept * (1 + 1.1e-9);
    ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
    *size[i] = kept;
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("rules of the checker");
  ADD_TEST(s, 20, rounding_is_charged_for_every_cord);
  ADD_LOOP(s, 20, rounding_never_adds_to_a_bound, 0, 200);
  ADD_TEST(s, 10, rounding_is_charged_once_without_prices);
  ADD_TEST(s, 10, rounding_is_charged_for_twice_the_cords_less_the_cover);
  ADD_TEST(s, 10, one_cord_is_charged_for_one_pass);
  ADD_TEST(s, 10, rounding_of_what_is_passed_once_costs_little);
  ADD_TEST(s, 10, optimal_is_within_a_billionth);
  ADD_TEST(s, 10, a_gap_of_a_billionth_is_allowed);
  ADD_LOOP(s, 10, edges_at_their_price, 0, 10);
  ADD_LOOP(s, 10, nodes_are_tied_by_turns, 0, 60);
  ADD_TEST(s, 10, prices_of_tied_length_are_moderate);
  ADD_TEST(s, 10, optimal_tied_lengths_are_within_a_billionth);
  ADD_TEST(s, 10, tied_lengths_are_proved_but_for_rounding);
  ADD_TEST(s, 10, the_fewest_cords_of_tube_joints);
  ADD_TEST(s, 10, cords_have_too_few_ends_for_the_tips);
  ADD_TEST(s, 10, the_fewest_cords_of_two_components);
  ADD_TEST(s, 10, rounding_needs_no_cord_more);
  ADD_TEST(s, 10, proofs_of_tied_length_are_about_the_plan);
  ADD_LOOP(s, 20, the_longest_cord_has_its_detour, 0, 90);
  ADD_LOOP(s, 20, the_longest_closed_cord_has_its_detour, 0, 200);
  ADD_TEST(s, 10, the_worst_edge_may_be_the_last);
  ADD_TEST(s, 10, bounds_are_whole_numbers_of_the_unit);
  ADD_TEST(s, 10, cords_have_whole_numbers_of_the_unit);
  ADD_TEST(s, 10, the_fewest_cords_have_room);
  ADD_TEST(s, 10, ends_pay_for_extra_passes);
  ADD_TEST(s, 10, given_ends_are_those_of_half_as_many_cords);
  ADD_LOOP(s, 10, cuts_add_up_over_edges, 0, 60);
  ADD_TEST(s, 10, cuts_add_up_at_prices);
  ADD_TEST(s, 10, nodes_of_cuts_ascend);
  ADD_TEST(s, 10, end_prices_hold_in_every_component);
  ADD_TEST(s, 10, prices_change_the_parity_of_both_nodes);
  ADD_TEST(s, 10, bounds_above_the_passes_are_refused);
  ADD_TEST(s, 10, certificates_weigh_their_own_component);
  ADD_TEST(s, 10, certificates_have_a_scale);
  ADD_TEST(s, 10, proofs_are_those_of_the_joint);
  ADD_TEST(s, 10, weightless_edges_passed_once_cost_nothing);
  ADD_TEST(s, 10, cords_are_counted_for_claims);
  ADD_TEST(s, 10, a_cord_may_be_as_long_as_rounding_lets_it);
  ADD_TEST(s, 10, fewer_cords_have_fewer_ends);
  ADD_TEST(s, 10, weak_proofs_bound_the_longest);
  ADD_TEST(s, 10, bounds_beyond_the_plan_are_refused);
  ADD_TEST(s, 10, symmetric_cords_are_counted_where_most_are);
  ADD_TEST(s, 10, cords_are_counted_in_every_component);
  ADD_TEST(s, 10, failures_are_not_forgotten);
  ADD_TEST(s, 10, every_edge_is_covered_and_has_room);
  ADD_TEST(s, 10, cords_end_where_they_may_and_are_no_longer);
  ADD_TEST(s, 10, passes_leave_ends_for_the_cords);
  ADD_TEST(s, 10, every_odd_node_has_an_end);
  ADD_TEST(s, 10, tube_joints_are_tied);
  ADD_TEST(s, 10, no_cord_of_tube_joints_turns_back_where_it_closes);
  ADD_TEST(s, 10, no_cord_of_tube_joints_turns_back_first);
  ADD_TEST(s, 10, angles_of_a_straight_cord_may_round);
  return run_suite(s);
}
