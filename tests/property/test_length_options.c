/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shortest plans under every combination of cover, capacity, ends and number of cords, against all
 * choices of extra passes. */
#include "graph/check/check.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* All choices of up to EXTRA passes more than the cover, of each of at most EDGES edges. */
enum { EXTRA = 3, EDGES = 6, NODES = 5, PASSES = 8, INSTANCES = 250 };

/* ---- the oracle ---- */

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  int passes[EDGES];
  signed char
      *circuits; /* [PASSES^EDGES] most circuits that these passes fall into, -1 = not known */
} oracle;

static int number_of(const oracle *x)
{
  int key = 0;
  for (int e = 0; e < x->f->n_edges; e++)
    key = key * PASSES + x->passes[e];
  return key;
}

static int most_circuits(oracle *x);

/* Goes on from node at to the goal by passes that are left, through no node twice: the most
 * circuits with this one. */
static int close_circuit(oracle *x, int at, int goal, unsigned visited)
{
  int best = -100;
  if (at == goal) return 1 + most_circuits(x);
  for (int e = 0; e < x->f->n_edges; e++) {
    const int *end = x->f->edge[e];
    if (x->passes[e] == 0 || (end[0] != at && end[1] != at)) continue;
    int to = end[0] == at ? end[1] : end[0];
    if (visited >> to & 1u) continue;
    x->passes[e]--;
    int n = close_circuit(x, to, goal, visited | 1u << to);
    if (n > best) best = n;
    x->passes[e]++;
  }
  return best;
}

/* Of x->passes, which are even at every node: the first pass that is left is in one of the
 * circuits. */
static int most_circuits(oracle *x)
{
  int e = 0, key = number_of(x);
  if (x->circuits[key] >= 0) return x->circuits[key];
  while (e < x->f->n_edges && x->passes[e] == 0)
    e++;
  int best = 0;
  if (e < x->f->n_edges) {
    const int *end = x->f->edge[e];
    x->passes[e]--;
    best = close_circuit(x, end[1], end[0], 1u << end[1]);
    x->passes[e]++;
  }
  x->circuits[key] = (signed char)best;
  return best;
}

/* Do the passes hold as many cords as asked for? With ends allowed: at every node as many ends as
 * passes at most, and an odd number of ends where the passes are odd in number. */
static bool holds(oracle *x)
{
  const thr_frame *f = x->f;
  const thr_request *o = x->o;
  int at[NODES] = {0}, odd = 0, room = 0;
  for (int e = 0; e < f->n_edges; e++)
    for (int s = 0; s < 2; s++)
      at[f->edge[e][s]] += x->passes[e];
  for (int v = 0; v < f->n_nodes; v++) {
    bool here = o->ends == THR_ENDS_ANY || (o->ends == THR_ENDS_FEET && f->foot[v]) ||
                (o->ends == THR_ENDS_NODES && o->end_node[v]);
    if (o->ends == THR_ENDS_COUNTS) {
      if (at[v] < o->end_count[v] || (at[v] - o->end_count[v]) % 2) return false;
      continue;
    }
    if (at[v] % 2 && !here) return false;
    odd += at[v] % 2;
    room += here ? at[v] : 0;
  }
  if (o->ends == THR_ENDS_COUNTS) return true;
  if (o->ends == THR_ENDS_CLOSED) return most_circuits(x) >= o->cords_least;
  return odd <= 2 * o->cords && room >= 2 * o->cords_least && room > 0;
}

/* Least length; INFINITY: no choice will do. */
static double least_length(const thr_frame *f, const thr_request *o, signed char *circuits)
{
  oracle x = {f, o, {0}, circuits};
  double best = INFINITY;
  int choices = 1, key = 1;
  for (int e = 0; e < f->n_edges; e++) {
    choices *= EXTRA + 1;
    key *= PASSES;
  }
  memset(circuits, -1, (size_t)key);
  for (int i = 0; i < choices; i++) {
    double length = 0;
    bool fits = true;
    for (int e = 0, rest = i; e < f->n_edges; e++, rest /= EXTRA + 1) {
      int cover = f->cover && f->cover[e] > o->cover ? f->cover[e] : o->cover;
      x.passes[e] = cover + rest % (EXTRA + 1);
      fits &= (o->capacity == 0 || x.passes[e] <= o->capacity) &&
              (!f->capacity || f->capacity[e] == 0 || x.passes[e] <= f->capacity[e]);
      length += x.passes[e] * f->length[e];
    }
    if (fits && length < best && holds(&x)) best = length;
  }
  return best;
}

/* ---- instances ---- */

typedef struct {
  thr_frame f;
  thr_request o;
  bool end_node[NODES];
  int end_count[NODES];
} instance;

static void choose_counts(rng *r, instance *x)
{
  int ends = 2 * rng_between(r, 1, 3);
  x->o.end_count = x->end_count;
  for (int i = 0; i < ends; i++)
    x->end_count[rng_below(r, rng_below(r, 2) ? x->f.n_nodes : 2)]++;
  x->o.cords = x->o.cords_least = ends / 2;
}

/* Some instances get a capacity of each edge that keeps the oracle's choices complete. */
static void choose_passes(rng *r, instance *x)
{
  thr_frame *f = &x->f;
  size_t m = (size_t)f->n_edges;
  x->o.cover = rng_between(r, 1, 4);
  if (rng_below(r, 3) == 0) ck_assert_ptr_nonnull(f->cover = thr_calloc(m, sizeof *f->cover));
  if (rng_below(r, 2) == 0) ck_assert_ptr_nonnull(f->capacity = thr_calloc(m, sizeof *f->capacity));
  if (rng_below(r, 4) == 0) x->o.capacity = x->o.cover + rng_between(r, 0, EXTRA);
  for (int e = 0; e < f->n_edges; e++) {
    if (f->cover) f->cover[e] = rng_between(r, 1, 4);
    int cover = f->cover && f->cover[e] > x->o.cover ? f->cover[e] : x->o.cover;
    if (f->capacity) f->capacity[e] = cover + rng_between(r, rng_below(r, 4) ? 1 : 0, EXTRA);
    if (x->o.capacity && x->o.capacity < cover) x->o.capacity = cover;
  }
}

static void choose(rng *r, instance *x)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_NODES,
                                  THR_ENDS_COUNTS};
  *x = (instance){0};
  int n = rng_between(r, 2, NODES), extra = rng_below(r, 4);
  x->f = random_frame(r, n, extra < EDGES - n + 1 ? extra : EDGES - n + 1,
                      (length_kind)rng_below(r, LENGTH_KINDS));
  x->o = options_for(ends[rng_below(r, 5)], 1);
  choose_passes(r, x);
  x->o.cords = rng_between(r, 1, 4);
  x->o.cords_least = rng_below(r, 2) ? x->o.cords : rng_between(r, 1, x->o.cords);
  if (x->o.ends == THR_ENDS_COUNTS) choose_counts(r, x);
  if (x->o.ends != THR_ENDS_NODES) return;
  x->o.end_node = x->end_node;
  x->end_node[rng_below(r, n)] = x->end_node[rng_below(r, n)] = true;
}

/* ---- what must hold ---- */

static void assert_counts(const thr_plan *p)
{
  int count[NODES] = {0};
  for (int i = 0; i < p->n_cords; i++) {
    count[thr_cord_start(&p->frame, &p->cord[i])]++;
    count[thr_cord_end(&p->frame, &p->cord[i])]++;
  }
  for (int v = 0; v < p->frame.n_nodes && p->options.ends == THR_ENDS_COUNTS; v++)
    ck_assert_int_eq(count[v], p->options.end_count[v]);
}

static int most_extra(const thr_plan *p)
{
  int passes[EDGES] = {0}, most = 0;
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < p->cord[i].n_passes; k++)
      passes[p->cord[i].half[k] >> 1]++;
  for (int e = 0; e < p->frame.n_edges; e++) {
    int extra = passes[e] - thr_plan_cover(&p->frame, &p->options, e);
    if (extra > most) most = extra;
  }
  return most;
}

/* What the checker makes of the plan's certificate, as it is now, is true. Returns whether it
 * accepts it. */
static bool bound_is_true(const thr_plan *p, double least)
{
  bool optimal;
  double bound;
  thr_status st = thr_check_length_proof(&p->frame, &p->options, p->cord, p->n_cords,
                                         p->proof.certificate, 1, NULL, &optimal, &bound, NULL);
  ck_assert(st == THR_OK || st == THR_EVIOLATED);
  if (!st) ck_assert_double_le(bound, least * (1 + 1e-9));
  if (!st && optimal) ck_assert_double_le(p->metrics.length, least * (1 + 1e-9));
  return !st;
}

/* Certificates that were tampered with are refused, or prove no more than what is true. Returns how
 * many prices were accepted. */
static int tamper(rng *r, thr_plan *p, double least)
{
  thr_certificate *c = &p->proof.certificate[0], kept = *c;
  int n = p->options.ends == THR_ENDS_COUNTS ? p->frame.n_nodes : 1, accepted = 0;
  int64_t price[NODES] = {0},
          weight =
              thr_certificate_weight(&p->frame, c, rng_below(r, p->frame.n_edges)) * c->denominator;
  for (int i = 0; i < 4 && c->n_cuts + c->n_prices > 0; i++) {
    int which = rng_below(r, c->n_cuts + c->n_prices);
    int64_t *one = which < c->n_cuts ? &c->cut[which].value : &c->place_price[which - c->n_cuts],
            was = *one;
    int64_t change = (int64_t)((rng_unit(r) - 0.3) * (double)weight);
    *one += change;
    if (which < c->n_cuts) c->sum += change;
    bound_is_true(p, least);
    *one = was;
    c->sum = kept.sum;
  }
  *c = (thr_certificate){kept.component,    kept.scale,    kept.denominator,
                         .join = kept.join, .n_prices = n, .place_price = price};
  for (int i = 0; i < 4; i++) {
    for (int v = 0; v < n; v++)
      price[v] = rng_below(r, 3) ? (int64_t)(rng_unit(r) * (double)weight) : 0;
    accepted += bound_is_true(p, least);
  }
  *c = kept;
  return accepted;
}

/* *accepted: counts prices at random that the checker takes. */
static void compare(rng *r, instance *x, signed char *circuits, int *accepted)
{
  thr_plan p;
  thr_err err = {0};
  const thr_request *o = &x->o;
  double least = least_length(&x->f, o, circuits);
  thr_status st = length_plan(&x->f, o, &(thr_limits){0}, &p, NULL, &err);
  if (st == THR_EINFEASIBLE) {
    ck_assert_msg(isinf(least), "%s, but %g will do", err.text, least);
    assert_one_line(&err, NULL);
    return;
  }
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "status %d: %s", st, err.text);
  ck_assert_int_le(p.n_cords, o->cords);
  ck_assert_int_ge(p.n_cords, o->cords_least);
  assert_counts(&p);
  assert_plan_sound(&p);
  bool same = fabs(p.metrics.length - least) <= 1e-9 * least;
  ck_assert_msg(same || (most_extra(&p) > EXTRA && p.metrics.length < least),
                "%.17g, but %.17g will do; ends %s, cords %d to %d", p.metrics.length, least,
                thr_ends_name(o->ends), o->cords_least, o->cords);
  if (p.proof.optimal)
    ck_assert_double_eq_tol(p.proof.lower_bound, p.metrics.length, 1e-9 * p.metrics.length);
  ck_assert_double_le(p.proof.lower_bound, p.metrics.length * (1 + 1e-9));
  ck_assert_msg(p.proof.optimal || o->ends == THR_ENDS_CLOSED,
                "not proved; ends %s, cords %d to %d", thr_ends_name(o->ends), o->cords_least,
                o->cords);
  if (same) *accepted += tamper(r, &p, least);
  thr_plan_destroy(&p);
}

START_TEST(every_combination_is_least)
{
  rng r = rng_make((uint64_t)_i + 31000);
  int accepted = 0;
  size_t keys = 1;
  for (int e = 0; e < EDGES; e++)
    keys *= PASSES;
  signed char *circuits = thr_calloc(keys, 1);
  ck_assert_ptr_nonnull(circuits);
  for (int k = 0; k < INSTANCES; k++) {
    instance x;
    choose(&r, &x);
    compare(&r, &x, circuits, &accepted);
    thr_frame_destroy(&x.f);
  }
  ck_assert_int_gt(accepted, INSTANCES);
  free(circuits);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("length options");
  ADD_EXAMPLES(s, 120, every_combination_is_least, 16);
  return run_suite(s);
}
