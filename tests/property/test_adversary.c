/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An adversary of the checker: certificates that hill climbing looks for on small frameworks, to
 * have a bound accepted that is above the truth. The truth comes from trying all choices
 * (tests/truth.h). */
#include "graph/check/check.h"
#include "graph/plan/plan_measures.h"
#include "lp/length/postman.h"
#include "tests/attack.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/truth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is attacked ---- */

/* Options of every kind; lists of the framework's nodes are part of the structure. */
typedef struct {
  thr_frame f;
  thr_request o;
  bool end_node[TRUTH_NODES];
  int end_count[TRUTH_NODES];
  int n_components, component[TRUTH_NODES], loop[TRUTH_EDGES];
  int passes[TRUTH_EDGES]; /* that hold the cords and are the shortest */
  double base, least;      /* length of the passes that must be; of the shortest */
} request;

/* Lengths in which rounding and tolerances matter. */
static double odd_length(rng *r, int kind)
{
  static const double near_half[] = {0.51, 1, 1.51, 0.5001, 2.5, 0.50000001};
  switch (kind) {
  case 0: return near_half[rng_below(r, 6)];
  case 1: return rng_between(r, 1, 3) * (1 + 1e-7 * rng_between(r, -3, 3));
  case 2: return rng_between(r, 1, 3) * (1 + 1e-9 * rng_between(r, -9, 9));
  case 3: return pow(10, rng_between(r, -5, 4));
  case 4: return rng_between(r, 1, 4);
  case 5: return rng_between(r, 1, 4) * (1 + 1e-11 * rng_between(r, -12, 12));
  default: return 0.1 + rng_unit(r);
  }
}

static thr_frame small_frame(rng *r, int n, int extra)
{
  switch (rng_below(r, 4)) {
  case 0: return path_make(n);
  case 1: return star_make(n - 1);
  default: return random_frame(r, n, extra, LENGTHS_EUCLID);
  }
}

static thr_frame frame_of(rng *r)
{
  thr_frame f;
  if (rng_below(r, 4) == 0) {
    thr_frame a = small_frame(r, rng_between(r, 2, 4), 1),
              b = small_frame(r, rng_between(r, 2, 4), 1);
    f = side_by_side(&a, &b);
    thr_frame_destroy(&a);
    thr_frame_destroy(&b);
  } else {
    f = small_frame(r, rng_between(r, 2, 5), rng_below(r, 4));
  }
  int kind = rng_below(r, 7);
  for (int e = 0; e < f.n_edges; e++)
    f.length[e] = odd_length(r, rng_below(r, 5) ? kind : 3);
  f.own_lengths = true;
  return f;
}

static void limit_edges(rng *r, thr_frame *f)
{
  size_t m = (size_t)f->n_edges;
  if (rng_below(r, 3) == 0) f->cover = calloc(m, sizeof *f->cover);
  if (rng_below(r, 4) == 0) f->capacity = calloc(m, sizeof *f->capacity);
  for (int e = 0; e < f->n_edges; e++) {
    if (f->cover) f->cover[e] = rng_between(r, 1, 3);
    if (f->capacity) f->capacity[e] = rng_below(r, 2) ? 0 : rng_between(r, 3, 6);
  }
}

static void choose_options(rng *r, request *q)
{
  static const int many[] = {1, 2, 2, 3, 10, 100, 1000};
  thr_request *o = &q->o;
  *o = options_for((thr_ends)rng_below(r, 5), rng_between(r, 1, 2));
  want(o, rng_below(r, 4) ? "length" : "steps");
  o->cords = many[rng_below(r, 7)];
  o->cords_least = rng_below(r, 3) == 0 ? 1
                   : rng_below(r, 2)    ? o->cords
                                        : rng_between(r, 1, o->cords);
  o->capacity = rng_below(r, 6) ? 0 : rng_between(r, 3, 9);
  for (int v = 0; v < q->f.n_nodes; v++) {
    q->end_node[v] = rng_below(r, 2);
    q->end_count[v] = rng_below(r, 2) ? 0 : rng_between(r, 1, o->cords < 20 ? o->cords : 20);
    q->f.foot[v] = rng_below(r, 2);
  }
  if (o->ends == THR_ENDS_NODES) o->end_node = q->end_node;
  if (o->ends == THR_ENDS_COUNTS) o->end_count = q->end_count;
}

/* The numbers of ends in the components are even, not 0, and no more than the options' cords have.
 */
static bool counts_fit(const request *q)
{
  int ends[TRUTH_NODES] = {0};
  for (int v = 0; v < q->f.n_nodes; v++)
    ends[q->component[v]] += q->end_count[v];
  for (int k = 0; k < q->n_components; k++)
    if (ends[k] == 0 || ends[k] % 2 || ends[k] > 2 * q->o.cords) return false;
  return true;
}

static void request_destroy(request *q)
{
  thr_frame_destroy(&q->f);
}

static void find_loops(request *q)
{
  int edge[TRUTH_EDGES], work[2 * TRUTH_NODES] = {0};
  for (int e = 0; e < q->f.n_edges; e++)
    edge[e] = e;
  thr_prices_loops(&q->f, edge, q->f.n_edges, work, q->loop);
}

/* Draws until there is a threading. */
static void request_make(rng *r, request *q)
{
  for (;; request_destroy(q)) {
    *q = (request){.f = frame_of(r)};
    limit_edges(r, &q->f);
    choose_options(r, q);
    ck_assert_int_eq(thr_frame_components(&q->f, q->component, &q->n_components, NULL), THR_OK);
    if (q->o.ends == THR_ENDS_COUNTS && !counts_fit(q)) continue;
    if (q->f.n_edges > TRUTH_EDGES) continue;
    thr_request asked =
        q->o; /* of a symmetric plan the number of cords is not asked for, but came out */
    if (thr_wants_symmetry(&q->o)) asked.cords_least = 1;
    bool fits = true;
    for (int e = 0; e < q->f.n_edges; e++)
      fits &= thr_plan_capacity(&q->f, &q->o, e) >= thr_plan_cover(&q->f, &q->o, e);
    if (fits && (q->least = truth_length(&q->f, &asked, q->passes)) < INFINITY) break;
  }
  for (int e = 0; e < q->f.n_edges; e++)
    q->base += q->f.length[e] * thr_plan_cover(&q->f, &q->o, e);
  find_loops(q);
}

static bool free_ends(const request *q)
{
  return q->o.ends != THR_ENDS_CLOSED && q->o.ends != THR_ENDS_COUNTS;
}

/* ---- certificates ---- */

enum { CUTS = 10, PIECES = 2 };

/* Of one component: what is free to choose. Multipliers follow: each set in turn takes the part
 * `share` of what its edges and nodes have left; then tamper is added to one of them. */
typedef struct {
  double scale;
  int64_t denominator, end_price, price[TRUTH_NODES];
  bool prices,
      even; /* are there prices of places? Are sets with an even number of odd nodes left in? */
  int n_cuts;
  unsigned set[CUTS];
  double share[CUTS];
  int64_t tamper;
} choice;

typedef struct {
  choice of[PIECES];
  int more[TRUTH_EDGES]; /* pairs of passes that the plan has beside those which must be */
  int filler; /* edge that gets the pairs without which there is no place for the cords */
} candidate;

/* A choice, worked out. */
typedef struct {
  thr_certificate c;
  thr_cut cut[CUTS];
  int node[CUTS][TRUTH_NODES];
  int64_t price[TRUTH_NODES];
  thr_wide left[TRUTH_EDGES], held[TRUTH_NODES];
  unsigned odd;
} worked;

static thr_wide weight_of(const request *q, const choice *x, int e)
{
  return (thr_wide)nearbyint(q->f.length[e] * x->scale) * x->denominator;
}

static int64_t price_at(const request *q, const choice *x, int v)
{
  if (!x->prices || !thr_plan_end_allowed(&q->f, &q->o, v)) return 0;
  return q->o.ends == THR_ENDS_COUNTS ? x->price[v] : x->price[0];
}

/* Nodes that are odd at these prices, and what edges and ends can bear. */
static void work_out_limits(const request *q, const choice *x, int k, worked *w)
{
  for (int v = 0; v < q->f.n_nodes; v++) {
    w->held[v] =
        free_ends(q) && thr_plan_end_allowed(&q->f, &q->o, v) ? x->end_price : (thr_wide)1 << 100;
    if (q->component[v] == k && q->o.ends == THR_ENDS_COUNTS)
      w->odd ^= (unsigned)(q->end_count[v] % 2) << v;
  }
  for (int e = 0; e < q->f.n_edges; e++) {
    const int *end = q->f.edge[e];
    if (q->component[end[0]] != k) continue;
    thr_wide of = (thr_wide)price_at(q, x, end[0]) + price_at(q, x, end[1]);
    if (q->o.ends == THR_ENDS_CLOSED) of = x->prices ? x->price[0] : 0;
    thr_priced p =
        thr_prices_edge(&q->f, &q->o, e, weight_of(q, x, e), of, x->prices ? q->loop[e] : 2);
    bool turned = (thr_plan_cover(&q->f, &q->o, e) % 2) ^ (p.room && x->prices && p.odd < p.even);
    w->left[e] = !p.room ? (thr_wide)1 << 100 : p.odd > p.even ? p.odd - p.even : p.even - p.odd;
    if (turned) w->odd ^= 1u << end[0] ^ 1u << end[1];
  }
}

/* The multiplier of cut i, and what it leaves. */
static void load(const request *q, const choice *x, int i, worked *w)
{
  thr_wide most = INT64_C(1) << 58;
  for (int e = 0; e < q->f.n_edges; e++)
    if ((x->set[i] >> q->f.edge[e][0] ^ x->set[i] >> q->f.edge[e][1]) & 1u && w->left[e] < most)
      most = w->left[e];
  for (int v = 0; v < q->f.n_nodes; v++)
    if (x->set[i] >> v & 1u && w->held[v] < most) most = w->held[v];
  int64_t value = x->share[i] >= 1 ? (int64_t)most : (int64_t)(x->share[i] * (double)most);
  for (int e = 0; e < q->f.n_edges; e++)
    if ((x->set[i] >> q->f.edge[e][0] ^ x->set[i] >> q->f.edge[e][1]) & 1u) w->left[e] -= value;
  for (int v = 0; v < q->f.n_nodes; v++)
    if (x->set[i] >> v & 1u) w->held[v] -= value;
  thr_cut *cut = &w->cut[w->c.n_cuts];
  *cut = (thr_cut){.parent = -1, .value = value, .node = w->node[w->c.n_cuts++]};
  for (int v = 0; v < q->f.n_nodes; v++)
    if (x->set[i] >> v & 1u) cut->node[cut->n_nodes++] = v;
}

static bool is_odd(unsigned set)
{
  return __builtin_popcount(set) % 2;
}

static void work_out(const request *q, const choice *x, int k, const int *passes, worked *w)
{
  *w = (worked){.c = {.component = k,
                      .scale = x->scale,
                      .denominator = x->denominator,
                      .end_price = x->end_price}};
  work_out_limits(q, x, k, w);
  w->c.cut = w->cut;
  w->c.place_price = w->price;
  for (int v = 0; v < q->f.n_nodes && x->prices; v++)
    if (q->component[v] == k && (q->o.ends == THR_ENDS_COUNTS || w->c.n_prices == 0))
      w->price[w->c.n_prices++] = q->o.ends == THR_ENDS_COUNTS ? x->price[v] : x->price[0];
  for (int i = 0; i < x->n_cuts; i++)
    if (x->even || is_odd(x->set[i] & w->odd)) load(q, x, i, w);
  if (x->tamper && w->c.n_cuts) w->cut[0].value += x->tamper;
  for (int i = 0; i < w->c.n_cuts; i++)
    w->c.sum += w->cut[i].value;
  for (int e = 0; e < q->f.n_edges; e++)
    if (q->component[q->f.edge[e][0]] == k)
      w->c.join += (int64_t)nearbyint(q->f.length[e] * x->scale) *
                   (passes[e] - thr_plan_cover(&q->f, &q->o, e));
}

/* ---- the search ---- */

static void choice_make(rng *r, const request *q, int k, choice *x)
{
  *x = (choice){.scale = rng_below(r, 2) ? 1 : pow(10, rng_between(r, -6, 9)),
                .denominator = 1 + rng_below(r, 1000)};
  x->prices = rng_below(r, 2);
  for (x->n_cuts = 0; x->n_cuts < CUTS; x->n_cuts++) {
    x->share[x->n_cuts] = 1;
    for (int v = 0; v < q->f.n_nodes; v++)
      if (q->component[v] == k && rng_below(r, 2)) x->set[x->n_cuts] |= 1u << v;
  }
}

/* A scale at which an edge's weight is about to be rounded up. */
static double scale_about(rng *r, const request *q)
{
  double length = q->f.length[rng_below(r, q->f.n_edges)],
         weight = rng_below(r, 4) ? rng_below(r, 4) : pow(10, rng_below(r, 10));
  return (floor(weight) + 0.5) / length * (1 + pow(10, -rng_between(r, 2, 14)));
}

static void change_scale(rng *r, const request *q, choice *x)
{
  double scale = rng_below(r, 3) ? x->scale * attack_factor(r) : scale_about(r, q), longest = 0;
  for (int e = 0; e < q->f.n_edges; e++)
    longest = fmax(longest, q->f.length[e]);
  if (scale > 1e-12 && scale * longest < 1e14) x->scale = scale;
}

/* Prices often are what an edge weighs, or half of it. */
static void change_price(rng *r, const request *q, choice *x, int64_t *price)
{
  int64_t weight = (int64_t)nearbyint(q->f.length[rng_below(r, q->f.n_edges)] * x->scale);
  double product = (double)weight * (double)x->denominator;
  switch (rng_below(r, 4)) {
  case 0: *price = product < 1e18 ? weight * x->denominator / (1 + rng_below(r, 2)) : 0; break;
  case 1: *price += attack_integer(r) >> rng_below(r, 62); break;
  case 2: *price = (int64_t)fmin(1e18, (double)*price * attack_factor(r)); break;
  default: *price = rng_below(r, 3) ? *price + rng_between(r, -1, 1) : 0;
  }
  if (*price < 0 && rng_below(r, 50)) *price = -*price;
  if (*price > INT64_C(1) << 61) *price = 0;
}

static void change_cut(rng *r, const request *q, int k, choice *x)
{
  int i = rng_below(r, CUTS), j = rng_below(r, CUTS), v = rng_below(r, q->f.n_nodes);
  unsigned kept = x->set[i];
  switch (rng_below(r, 3)) {
  case 0: x->set[i] = x->set[j], x->set[j] = kept; break;
  case 1: x->share[i] = rng_below(r, 2) ? 1 : rng_unit(r); break;
  default:
    if (q->component[v] == k || rng_below(r, 50) == 0) x->set[i] ^= 1u << v;
  }
}

static void change(rng *r, const void *target, void *what)
{
  const request *q = target;
  candidate *c = what;
  int k = rng_below(r, q->n_components), e = rng_below(r, q->f.n_edges);
  choice *x = &c->of[k];
  switch (rng_below(r, 8)) {
  case 0: change_scale(r, q, x); break;
  case 1:
    x->denominator = 1 + (int64_t)fmin(1e12, (double)x->denominator * attack_factor(r));
    break;
  case 2:
    if (free_ends(q) || rng_below(r, 50) == 0) change_price(r, q, x, &x->end_price);
    break;
  case 3:
  case 4:
    change_price(r, q, x, &x->price[q->o.ends == THR_ENDS_COUNTS ? rng_below(r, q->f.n_nodes) : 0]);
    break;
  case 5: c->more[e] = rng_below(r, 3) ? 0 : rng_below(r, 2) ? 1 : rng_below(r, 1000); break;
  case 6:
    if (rng_below(r, 4) == 0) x->prices = !x->prices;
    if (rng_below(r, 2) == 0) c->filler = e;
    if (rng_below(r, 8) == 0) x->even = !x->even;
    if (rng_below(r, 8) == 0)
      x->tamper = rng_below(r, 2) ? rng_between(r, -1, 1) : attack_integer(r);
    break;
  default: change_cut(r, q, k, x);
  }
}

static int room_of(const request *q, const int *passes, int e)
{
  return thr_plan_capacity(&q->f, &q->o, e) - passes[e];
}

/* Pairs of passes that are missing for the cords: in component k, or at node v if numbers of ends
 * are given. */
static int pairs_missing(const request *q, const int *passes, int k, int v)
{
  int places = 0, cords = thr_wants_symmetry(&q->o) ? 1 : q->o.cords_least;
  for (int e = 0; e < q->f.n_edges; e++)
    for (int i = 0; i < 2; i++) {
      int u = q->f.edge[e][i];
      if (q->component[u] != k || (q->o.ends == THR_ENDS_COUNTS && u != v)) continue;
      if (q->o.ends == THR_ENDS_CLOSED)
        places += passes[e] / 2; /* pairs are circuits, each met from both nodes */
      else if (thr_plan_end_allowed(&q->f, &q->o, u))
        places += passes[e];
    }
  return ((q->o.ends == THR_ENDS_COUNTS ? q->end_count[v] : 2 * cords) - places + 1) / 2;
}

/* Adds pairs to the filler first, then to other edges, until there are enough. */
static void fill(const request *q, int filler, int k, int v, int *passes)
{
  for (int i = 0; i < q->f.n_edges; i++) {
    int e = (filler + i) % q->f.n_edges, missing = pairs_missing(q, passes, k, v),
        room = room_of(q, passes, e) / 2;
    const int *end = q->f.edge[e];
    bool of_use = q->o.ends == THR_ENDS_COUNTS ? end[0] == v || end[1] == v
                                               : q->o.ends == THR_ENDS_CLOSED ||
                                                     thr_plan_end_allowed(&q->f, &q->o, end[0]) ||
                                                     thr_plan_end_allowed(&q->f, &q->o, end[1]);
    if (missing > 0 && of_use && q->component[end[0]] == k)
      passes[e] += 2 * (missing < room ? missing : room);
  }
}

/* Parity as of the shortest passes. These, if there is no place for the cords else. */
static void passes_of(const request *q, const candidate *c, int *passes)
{
  bool enough = true;
  for (int e = 0; e < q->f.n_edges; e++) {
    int cover = thr_plan_cover(&q->f, &q->o, e);
    passes[e] = cover + (q->passes[e] - cover) % 2;
    passes[e] +=
        2 * (c->more[e] < room_of(q, passes, e) / 2 ? c->more[e] : room_of(q, passes, e) / 2);
  }
  for (int v = 0; v < q->f.n_nodes; v++)
    fill(q, c->filler, q->component[v], v, passes);
  for (int v = 0; v < q->f.n_nodes; v++)
    enough &= pairs_missing(q, passes, q->component[v], v) <= 0;
  if (!enough) memcpy(passes, q->passes, sizeof q->passes);
}

/* A length that is said to be least, or a bound, above the truth. */
static double judge_length(const void *target, const void *what)
{
  const request *q = target;
  const candidate *c = what;
  worked w[PIECES];
  thr_certificate certificate[PIECES];
  int passes[TRUTH_EDGES];
  bool optimal;
  double bound, length = 0, rounding = 0;
  passes_of(q, c, passes);
  for (int k = 0; k < q->n_components; k++) {
    work_out(q, &c->of[k], k, passes, &w[k]);
    certificate[k] = w[k].c;
  }
  thr_status st = thr_check_length_of_passes(&q->f, &q->o, passes, certificate, q->n_components,
                                             &optimal, &bound, NULL);
  if (st) return -INFINITY;
  for (int e = 0; e < q->f.n_edges; e++) {
    double scale = c->of[q->component[q->f.edge[e][0]]].scale;
    length += passes[e] * q->f.length[e];
    rounding += fabs(q->f.length[e] - nearbyint(q->f.length[e] * scale) / scale);
  }
  double above = (optimal ? fmax(length, bound) : bound) / q->least - 1;
  return bound > q->base * (1 + 1e-12)
             ? above
             : above - fmin(1, rounding / q->base); /* rounding may have eaten up a bound */
}

static const attack_kind of_length = {sizeof(candidate), change, judge_length, 3e-9};

static void say_hole(const request *q, const candidate *c, double above)
{
  printf("hole: %.17g above %.17g, ends %d, cords %d..%d, cover %d, capacity %d, objective %d\n",
         above, q->least, (int)q->o.ends, q->o.cords_least, q->o.cords, q->o.cover, q->o.capacity,
         (int)thr_aims_objective(&q->o));
  for (int e = 0; e < q->f.n_edges; e++)
    printf("  edge %d-%d %.17g cover %d capacity %d shortest %d more %d\n", q->f.edge[e][0],
           q->f.edge[e][1], q->f.length[e], thr_plan_cover(&q->f, &q->o, e),
           thr_plan_capacity(&q->f, &q->o, e), q->passes[e], c->more[e]);
  for (int k = 0; k < q->n_components; k++) {
    const choice *x = &c->of[k];
    printf("  scale %.17g denominator %lld end price %lld prices %d: %lld ..\n", x->scale,
           (long long)x->denominator, (long long)x->end_price, x->prices, (long long)x->price[0]);
  }
}

START_TEST(no_length_is_proved_above_the_least)
{
  enum { STEPS = 400, MOST_SAID = 10 };
  attack_tally tally = {.name = "length", .best = -INFINITY};
  long most = attack_number(400000);
  for (uint64_t seed = attack_seed(); tally.judged < most; seed++) {
    rng r = rng_make(seed);
    request q;
    candidate c;
    request_make(&r, &q);
    for (int again = 0; again < 3; again++) {
      memset(&c, 0, sizeof c);
      for (int k = 0; k < q.n_components; k++)
        choice_make(&r, &q, k, &c.of[k]);
      bool hole = attack_climb(&r, &of_length, &q, &c, STEPS, &tally);
      if (hole && tally.holes < MOST_SAID) say_hole(&q, &c, judge_length(&q, &c));
    }
    request_destroy(&q);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 10);
}
END_TEST

/* ---- claims of whole plans ---- */

enum { MOST_CORDS = 3 };

/* A plan with options that it was not made for, and what is true of them. */
typedef struct {
  request q; /* q.o: what the plan says it was asked for */
  thr_plan plan;
  double longest; /* least length of the longest cord */
  int fewest;     /* fewest cords in all */
} asked;

typedef struct {
  candidate c;
  int raise; /* how far above what the certificate proves the plan's words are */
} claim;

static void asked_destroy(asked *a)
{
  thr_frame_destroy(&a->q.f);
  thr_plan_destroy(&a->plan);
}

/* Component k as a framework of its own; node v becomes to[v]. */
static thr_frame piece_of(const request *q, int k, int *to)
{
  double xyz[TRUTH_NODES][3], length[TRUTH_EDGES];
  int edge[TRUTH_EDGES][2], n = 0, m = 0, list[TRUTH_EDGES];
  for (int v = 0; v < q->f.n_nodes; v++) {
    to[v] = q->component[v] == k ? n : -1;
    if (to[v] >= 0) memcpy(xyz[n++], q->f.xyz[v], sizeof *xyz);
  }
  for (int e = 0; e < q->f.n_edges; e++) {
    if (to[q->f.edge[e][0]] < 0) continue;
    edge[m][0] = to[q->f.edge[e][0]], edge[m][1] = to[q->f.edge[e][1]];
    list[m] = e;
    length[m++] = q->f.length[e];
  }
  thr_frame f = frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, length, NULL);
  f.cover = q->f.cover ? calloc((size_t)m, sizeof *f.cover) : NULL;
  f.capacity = q->f.capacity ? calloc((size_t)m, sizeof *f.capacity) : NULL;
  for (int i = 0; i < m; i++) {
    if (f.cover) f.cover[i] = q->f.cover[list[i]];
    if (f.capacity) f.capacity[i] = q->f.capacity[list[i]];
  }
  return f;
}

static int cords_in(const asked *a, int k)
{
  int n = 0;
  for (int i = 0; i < a->plan.n_cords; i++)
    n += a->plan.cord[i].component == k;
  return n;
}

/* The longest cord and the number of cords of one component, for every number that the options
 * allow; *length: the least of no more cords than the plan has there. */
static void find_truth_of_piece(asked *a, int k, int least, double *length)
{
  const request *q = &a->q;
  int to[TRUTH_NODES], fewest = q->o.cords;
  bool end_node[TRUTH_NODES];
  double shortest = INFINITY;
  thr_frame f = piece_of(q, k, to);
  thr_request o = q->o;
  for (int v = 0; v < q->f.n_nodes; v++)
    if (to[v] >= 0) {
      f.foot[to[v]] = q->f.foot[v];
      end_node[to[v]] = q->end_node[v];
    }
  if (o.end_node) o.end_node = end_node;
  truth_table t = truth_table_make(&f, &o, 2);
  for (int n = q->o.cords; n >= least; n--) {
    double longest = truth_longest(&t, n);
    shortest = fmin(shortest, longest);
    if (longest <= q->o.max_length * (1 + 1e-9)) fewest = n;
  }
  a->longest = fmax(a->longest, shortest);
  a->fewest += fewest;
  o.cords_least = least;
  o.cords = cords_in(a, k);
  *length += truth_length(&f, &o, NULL);
  truth_table_destroy(&t);
  thr_frame_destroy(&f);
}

/* There and back over the edge where the cord comes to it first, so often. */
static void add_detour(thr_cord *c, int at, int times)
{
  int *half = calloc((size_t)(c->n_passes + 2 * times), sizeof *half);
  ck_assert(half != NULL);
  memcpy(half, c->half, (size_t)at * sizeof *half);
  for (int i = 0; i < 2 * times; i++)
    half[at + i] = c->half[at] ^ (i & 1);
  memcpy(half + at + 2 * times, c->half + at, (size_t)(c->n_passes - at) * sizeof *half);
  free(c->half);
  c->half = half;
  c->n_passes += 2 * times;
}

static void lengthen(rng *r, asked *a)
{
  thr_plan *p = &a->plan;
  for (int tries = rng_below(r, 4); tries > 0; tries--) {
    thr_cord *c = &p->cord[rng_below(r, p->n_cords)];
    int at = rng_below(r, c->n_passes), passes = 0;
    for (int i = 0; i < p->n_cords; i++)
      for (int k = 0; k < p->cord[i].n_passes; k++)
        passes += p->cord[i].half[k] >> 1 == c->half[at] >> 1;
    int room = (thr_plan_capacity(&a->q.f, &a->q.o, c->half[at] >> 1) - passes) / 2,
        times = rng_between(r, 1, 3);
    add_detour(c, at, times < room ? times : room > 0 ? room : 0);
  }
}

/* A symmetric plan whose group is the identity: every cord is a unique path. Passes are learned
 * and, where they may be anywhere, ends. That is less if the cord is the same read from another
 * pass on or backward: all such ways are tried. */
static double steps_of(const asked *a, const thr_cord *c)
{
  const thr_request *o = &a->q.o;
  bool back_there = c->half[0] >> 1 == c->half[c->n_passes - 1] >> 1;
  bool round =
      c->closed && (o->ends == THR_ENDS_CLOSED || (o->ends == THR_ENDS_ANY && !back_there));
  int n = c->n_passes, ways = 0;
  for (int back = 0; back < 2; back++)
    for (int from = 0; from < (round ? n : 1); from++) {
      bool same = true;
      for (int k = 0; k < n && same; k++)
        same = c->half[k] == (back ? c->half[(from + n - 1 - k) % n] ^ 1 : c->half[(from + k) % n]);
      ways += same;
    }
  return (double)(n + (o->ends == THR_ENDS_ANY && !round ? 2 : 0)) / ways;
}

static void make_symmetric(asked *a)
{
  thr_plan *p = &a->plan;
  thr_symmetry_record *s = &p->symmetry;
  *s =
      (thr_symmetry_record){.present = true, .order = 1, .n_images = 1, .unique_paths = p->n_cords};
  s->image = calloc((size_t)p->frame.n_nodes, sizeof *s->image);
  s->unique = calloc((size_t)p->n_cords, sizeof *s->unique);
  s->element = calloc((size_t)p->n_cords, sizeof *s->element);
  ck_assert(s->image && s->unique && s->element);
  for (int v = 0; v < p->frame.n_nodes; v++)
    s->image[v] = v;
  for (int i = 0; i < p->n_cords; i++) {
    s->unique[i] = i;
    s->steps += steps_of(a, &p->cord[i]);
  }
}

/* Two cords that run alike would be copies of one path. */
static bool run_alike(const thr_plan *p)
{
  int sum[PIECES * MOST_CORDS][TRUTH_EDGES] = {{0}};
  for (int i = 0; i < p->n_cords; i++) {
    for (int k = 0; k < p->cord[i].n_passes; k++)
      sum[i][p->cord[i].half[k] >> 1]++;
    for (int k = 0; k < i; k++)
      if (memcmp(sum[i], sum[k], sizeof *sum) == 0) return true;
  }
  return false;
}

/* Of component 1, the cords of a plan with fewer: in a symmetric plan the number may be another in
 * each. */
static void mix(asked *a, thr_plan *fewer)
{
  thr_plan *p = &a->plan;
  int n = 0, m = 0;
  for (int i = 0; i < p->n_cords; i++)
    if (p->cord[i].component == 0)
      p->cord[n++] = p->cord[i];
    else
      free(p->cord[i].half);
  for (int i = 0; i < fewer->n_cords; i++)
    if (fewer->cord[i].component == 1)
      p->cord[n++] = fewer->cord[i];
    else
      fewer->cord[m++] = fewer->cord[i];
  p->n_cords = n;
  fewer->n_cords = m;
  for (int i = 0; i < n; i++)
    thr_cord_id(i, p->cord[i].id);
}

static double longest_of(const thr_plan *p)
{
  double longest = 0;
  for (int i = 0; i < p->n_cords; i++)
    longest = fmax(longest, thr_cord_length(&p->frame, &p->cord[i]));
  return longest;
}

/* Options that the plan keeps to as well, some of them much wider. */
static void restate(rng *r, asked *a)
{
  thr_request *o = &a->q.o;
  double longest = longest_of(&a->plan);
  if (thr_wants_length(o) && !run_alike(&a->plan) && rng_below(r, 3) == 0) want(o, "overlap,steps");
  if (thr_wants_length(o) && rng_below(r, 4) == 0) want(o, "turning");
  o->turning.length_slack = rng_below(r, 3) * 0.1;
  if (o->ends == THR_ENDS_COUNTS) return;
  o->cords_least = rng_between(r, 1, o->cords);
  if (!thr_wants_symmetry(o)) o->cords = rng_between(r, o->cords, MOST_CORDS);
  if (rng_below(r, 4)) o->max_length = longest * (rng_below(r, 2) ? 1 : 1 + rng_unit(r));
}

/* The program's plan for exactly so many cords. */
static bool plan_cords(const request *q, int cords, thr_plan *p)
{
  thr_request o = q->o;
  thr_limits limits = {.deadline = thr_clock() + 5};
  want(&o, "length");
  o.cords = o.cords_least = cords;
  thr_status st = length_plan(&q->f, &o, &limits, p, NULL, NULL);
  return (st == THR_OK || st == THR_ELIMIT) && p->proof.present;
}

/* With given numbers of ends: even cords that the program finds. */
static void find_witnesses(asked *a)
{
  thr_request o = a->q.o;
  thr_limits limits = {.deadline = thr_clock() + 5};
  thr_plan p;
  want(&o, "length");
  want(&o, "longest");
  a->fewest = a->plan.n_cords;
  a->longest = longest_of(&a->plan);
  thr_status st = length_plan(&a->q.f, &o, &limits, &p, NULL, NULL);
  if (st && st != THR_ELIMIT) return;
  a->longest = fmin(a->longest, longest_of(&p));
  thr_plan_destroy(&p);
}

static bool plan_and_mix(rng *r, asked *a)
{
  const request *q = &a->q;
  thr_plan fewer = {0};
  bool counts = q->o.ends == THR_ENDS_COUNTS,
       fits = q->f.n_edges / q->n_components <= 4 && (!counts || counts_fit(q));
  if (!fits || !plan_cords(q, q->o.cords, &a->plan)) return false;
  if (q->n_components == 1 || counts || !plan_cords(q, rng_between(r, 1, q->o.cords), &fewer))
    return true;
  if (fewer.n_cords < a->plan.n_cords) want(&a->q.o, "overlap,steps");
  if (fewer.n_cords < a->plan.n_cords) mix(a, &fewer);
  thr_plan_destroy(&fewer);
  return true;
}

static bool asked_make(rng *r, asked *a)
{
  *a = (asked){.longest = 0};
  request_make(r, &a->q);
  request *q = &a->q;
  want(&q->o, "length");
  q->o.cords = q->o.cords_least = rng_between(r, 1, MOST_CORDS);
  if (!plan_and_mix(r, a) || (thr_wants_symmetry(&q->o) && run_alike(&a->plan))) {
    asked_destroy(a);
    return false;
  }
  lengthen(r, a);
  restate(r, a);
  thr_request true_options = q->o;
  if (thr_wants_symmetry(&q->o)) true_options.cords_least = 1, make_symmetric(a);
  a->plan.options.aims = q->o.aims;
  a->plan.options.cords = q->o.cords;
  a->plan.options.cords_least = q->o.cords_least;
  a->plan.options.max_length = q->o.max_length;
  a->plan.options.turning.length_slack = q->o.turning.length_slack;
  ck_assert_int_eq(
      thr_plan_measure(&q->f, &q->o, a->plan.cord, a->plan.n_cords, &a->plan.metrics, NULL),
      THR_OK);
  double few_length = 0;
  q->least = truth_length(&q->f, &true_options, NULL);
  for (int k = 0; k < q->n_components && q->o.ends != THR_ENDS_COUNTS; k++)
    find_truth_of_piece(a, k, true_options.cords_least, &few_length);
  if (q->o.max_length > 0 && q->o.cords_least < q->o.cords && thr_plan_counted(&q->o))
    q->least = few_length;
  if (q->o.ends == THR_ENDS_COUNTS) find_witnesses(a);
  memset(q->passes, 0, sizeof q->passes);
  for (int i = 0; i < a->plan.n_cords; i++)
    for (int k = 0; k < a->plan.cord[i].n_passes; k++)
      q->passes[a->plan.cord[i].half[k] >> 1]++;
  return true;
}

static void change_claim(rng *r, const void *target, void *what)
{
  claim *c = what;
  const asked *a = target;
  if (rng_below(r, 10) == 0)
    c->raise = rng_below(r, 5);
  else
    change(r, &a->q, &c->c);
}

/* The plan's words: what the checker says is proved, and a little more. */
static thr_status state(thr_plan *p, int raise)
{
  static const double part[] = {0, 9e-10, 1e-8, 3e-7, 1e-4};
  thr_length_proof *l = &p->proof;
  thr_cords_claim *c = &p->cords_claim;
  thr_status st =
      thr_check_length_proof(&p->frame, &p->options, p->cord, p->n_cords, l->certificate,
                             l->n_certificates, NULL, &l->optimal, &l->lower_bound, NULL);
  if (!st)
    st = thr_check_cords(&p->frame, &p->options, p->cord, p->n_cords, l->certificate,
                         l->n_certificates, NULL, c, NULL);
  if (!l->optimal) l->lower_bound *= 1 + part[raise];
  if (!c->longest_optimal) c->longest_bound *= 1 + part[raise];
  if (raise == 4 && c->fewest > 0) c->fewest++;
  l->gap = (p->metrics.length - l->lower_bound) / p->metrics.length;
  return st;
}

/* The plan with the certificates and claims of the candidate, which borrow from the rest. */
typedef struct {
  worked w[PIECES];
  thr_certificate certificate[PIECES];
  thr_plan plan;
} forgery;

static thr_status forge(const asked *a, const claim *c, forgery *x)
{
  x->plan = a->plan;
  for (int k = 0; k < a->q.n_components; k++) {
    work_out(&a->q, &c->c.of[k], k, a->q.passes, &x->w[k]);
    x->certificate[k] = x->w[k].c;
  }
  x->plan.proof = (thr_length_proof){
      .present = true, .n_certificates = a->q.n_components, .certificate = x->certificate};
  return state(&x->plan, c->raise);
}

static double judge_claim(const void *target, const void *what)
{
  const asked *a = target;
  const claim *c = what;
  forgery x;
  if (forge(a, c, &x) || thr_check_plan(&x.plan, NULL)) return -INFINITY;
  const thr_plan p = x.plan;
  double above = p.proof.lower_bound / a->q.least - 1,
         longest = p.cords_claim.longest_bound / a->longest - 1;
  bool within = p.metrics.length <= (1 + p.options.turning.length_slack) * a->q.least * (1 + 4e-9);
  if (p.cords_claim.fewest > a->fewest || (thr_wants_turning(&p.options) && !within)) return 1;
  return fmax(above, longest);
}

static const attack_kind of_claims = {sizeof(claim), change_claim, judge_claim, 4e-9};

static void say_false_claim(const asked *a, const claim *c)
{
  printf("longest %.17g, fewest %d, %d cords, %d components, max_length %.17g, raise %d\n",
         a->longest, a->fewest, a->plan.n_cords, a->q.n_components, a->q.o.max_length, c->raise);
  say_hole(&a->q, &c->c, judge_claim(a, c));
  const char *path = getenv("THREAD_ADVERSARY_PLAN");
  FILE *file = path ? fopen(path, "w") : NULL;
  forgery x;
  if (!file || forge(a, c, &x)) return;
  thr_text text = plan_text(&x.plan);
  fwrite(text.data, 1, text.length, file);
  thr_text_destroy(&text);
  fclose(file);
}

START_TEST(no_claim_of_a_plan_is_above_the_truth)
{
  enum { STEPS = 300, MOST_SAID = 10 };
  attack_tally tally = {.name = "claims", .best = -INFINITY};
  long most = attack_number(100000);
  for (uint64_t seed = attack_seed(); tally.judged < most; seed++) {
    rng r = rng_make(seed);
    asked a;
    claim c;
    if (!asked_make(&r, &a)) continue;
    for (int again = 0; again < 3; again++) {
      memset(&c, 0, sizeof c);
      for (int k = 0; k < a.q.n_components; k++)
        choice_make(&r, &a.q, k, &c.c.of[k]);
      bool hole = attack_climb(&r, &of_claims, &a, &c, STEPS, &tally);
      if (hole && tally.holes < MOST_SAID) say_false_claim(&a, &c);
    }
    asked_destroy(&a);
  }
  attack_report(&tally);
  ck_assert_int_eq(tally.holes, 0);
  ck_assert(tally.accepted > tally.judged / 10);
}
END_TEST

/* ---- single forgeries ---- */

/* Two edges of 0.51 and 1 and 1,000 closed cords: pairs of passes over the short edge are the
 * shortest. The weights of both are 1 at scale 1, so that at the price of a whole weight passes
 * over either cost the same: each adds its rounding to the bound. */
START_TEST(rounding_counts_for_every_pass_of_any_plan)
{
  request q = {
      .f = path_make(3), .o = options_for(THR_ENDS_CLOSED, 1), .n_components = 1, .base = 1.51};
  candidate c = {.of = {{.scale = 1, .denominator = 1000, .prices = true, .price = {1000}}},
                 .filler = 1};
  attack_tally tally = {.name = "forgery", .best = -INFINITY};
  rng r = rng_make(attack_seed());
  q.f.length[0] = 0.51;
  q.f.own_lengths = true;
  q.o.cords = q.o.cords_least = 1000;
  q.least = truth_length(&q.f, &q.o, q.passes);
  find_loops(&q);
  ck_assert_double_eq_tol(q.least, 2 * 1.51 + 998 * 2 * 0.51, 1e-9);
  ck_assert_double_le(judge_length(&q, &c), of_length.false_above);
  ck_assert(!attack_climb(&r, &of_length, &q, &c, 2000, &tally));
  request_destroy(&q);
}
END_TEST

/* A stem in a mirror, and two arms that it exchanges: the cord in the stem stays as it is under the
 * mirror, which is no reason to learn half of it only; of the one from arm to arm half is enough.
 */
START_TEST(what_a_mirror_keeps_is_learned_whole)
{
  static const double xyz[][3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 2}, {-1, 0, 2}};
  static const int edge[][2] = {{0, 1}, {1, 2}, {1, 3}};
  int stem[] = {0}, arms[] = {3, 4}, mirror[] = {0, 1, 3, 2}, identity[] = {0, 1, 2, 3},
      unique[] = {0, 1}, element[] = {0, 0};
  thr_cord cord[] = {{.id = "A", .n_passes = 1, .half = stem},
                     {.id = "B", .n_passes = 2, .half = arms}};
  thr_plan p = {.frame = frame_make(4, xyz, 3, edge, NULL, NULL),
                .options = options_for(THR_ENDS_ANY, 1),
                .n_cords = 2,
                .cord = cord};
  want(&p.options, "overlap,steps");
  p.options.cords = p.options.cords_least = 2;
  p.symmetry = (thr_symmetry_record){
      .present = true, .order = 2, .n_generators = 1, .generator = mirror, .n_images = 1};
  p.symmetry.image = identity, p.symmetry.unique = unique, p.symmetry.element = element,
  p.symmetry.unique_paths = 2;
  ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, cord, 2, &p.metrics, NULL), THR_OK);
  for (int half_steps = 1; half_steps <= 12; half_steps++) {
    p.symmetry.steps = half_steps / 2.0;
    ck_assert_int_eq(thr_check_plan(&p, NULL), half_steps == 10 ? THR_OK : THR_EVIOLATED);
  }
  thr_frame_destroy(&p.frame);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("adversary");
  ADD_TEST(s, 100000, no_length_is_proved_above_the_least);
  ADD_TEST(s, 100000, no_claim_of_a_plan_is_above_the_truth);
  ADD_TEST(s, 60, rounding_counts_for_every_pass_of_any_plan);
  ADD_TEST(s, 60, what_a_mirror_keeps_is_learned_whole);
  return run_suite(s);
}
