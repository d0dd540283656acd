/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proof that cords need as many passes as they have beyond a shortest join, by prices of places
 * (graph/plan/plan_measures.h).
 *
 * Let every pass at a node where a cord may end be worth p, a place for its end, as if it made the
 * edge lighter, and let 2 K such places cost 2 K p: the least join at these prices, put together,
 * is a bound for K cords, and the best p is searched for.
 *
 * Example: docs/method.md, "Several cords". */
#include "graph/check/check.h"
#include "graph/disjoint.h"
#include "graph/plan/plan_measures.h"
#include "graph/scratch.h"
#include "lp/length/postman_parts.h"
#include "lp/solver/lp.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EDGES = 10000, MOST_ROUNDS = 60, MOST_PRICES = 30 };

typedef struct {
  const thr_decomposition *s;
  const thr_limits *limits;
  thr_scratch own; /* the arrays */
  bool closed, counts;
  int64_t unit; /* parts of a weight that prices are whole numbers of */
  int n_edges, n_nodes;
  int *loop;  /* [n_edges] shortest loops over edges */
  int *local; /* [n_nodes] the node; where ends are free, n_nodes for all where they may be */
  int *part, *place; /* [n_nodes + 1] disjoint sets joined by edges with room; position of a node in
                        its part's problem */
  thr_certificate *c, trial; /* trial: the certificate at a price */
  thr_wide bound;            /* of c, in units of 1/denominator of it */
} pricing;

/* What passes weigh, in weights, and how many places they have. */
typedef struct {
  double weight, places;
} line;

static void pricing_destroy(pricing *p)
{
  thr_scratch_free(&p->own);
  thr_certificate_destroy(&p->trial);
}

/* Units in which loops of the usual lengths have whole prices, as long as sums fit. */
static int64_t choose_unit(const pricing *p)
{
  static const int64_t units[] = {840, 120, 24, 12, 4};
  double sum = 1;
  for (int i = 0; i < p->n_edges; i++)
    sum += (double)thr_certificate_weight(p->s->f, p->c, i);
  for (int i = 0; i < 5; i++)
    if (sum * (double)units[i] < 0x1p49) return units[i];
  return 2;
}

static thr_status pricing_init(pricing *p, thr_err *err)
{
  const thr_frame *frame = p->s->f;
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  p->n_nodes = frame->n_nodes;
  p->n_edges = frame->n_edges;
  p->loop = thr_scratch_array(&p->own, m, sizeof *p->loop);
  p->local = thr_scratch_array(&p->own, n, sizeof *p->local);
  p->part = thr_scratch_array(&p->own, n + 1, sizeof *p->part);
  p->place = thr_scratch_array(&p->own, n + 1, sizeof *p->place);
  thr_status st = thr_scratch_check(&p->own, err);
  if (st) return st;
  for (int v = 0; v < p->n_nodes; v++)
    p->local[v] =
        !p->closed && !p->counts && thr_plan_end_allowed(frame, p->s->o, v) ? p->n_nodes : v;
  for (int v = 0; v <= p->n_nodes; v++)
    p->part[v] = v;
  for (int e = 0; e < p->n_edges; e++)
    if (thr_plan_capacity(frame, p->s->o, e) > thr_plan_cover(frame, p->s->o, e))
      thr_disjoint_join(p->part, p->local[frame->edge[e][0]], p->local[frame->edge[e][1]]);
  for (int v = 0; v <= p->n_nodes; v++)
    p->part[v] = thr_disjoint_find(p->part, v);
  p->unit = choose_unit(p);
  if (!p->closed) return THR_OK;
  int *work = thr_calloc(2 * n + m, sizeof *work);
  for (int e = 0; work && e < p->n_edges; e++)
    work[2 * n + (size_t)e] = e;
  if (work) thr_prices_loops(frame, work + 2 * n, p->n_edges, work, p->loop);
  free(work);
  return work ? THR_OK : thr_nomem(err);
}

/* Nodes of an edge where cords may end. */
static int ends_of(const pricing *p, int e)
{
  const int *end = p->s->f->edge[e];
  return (p->local[end[0]] == p->n_nodes) + (p->local[end[1]] == p->n_nodes);
}

static thr_priced edge_at(const pricing *p, int e)
{
  const thr_certificate *certificate = &p->trial;
  thr_wide of = p->closed ? certificate->place_price[0] : 0;
  for (int s = 0; s < 2 && !p->closed; s++) {
    int v = p->local[p->s->f->edge[e][s]];
    if (p->counts || v == p->n_nodes) of += certificate->place_price[p->counts ? v : 0];
  }
  return thr_prices_edge(p->s->f, p->s->o, e,
                         (thr_wide)thr_certificate_weight(p->s->f, certificate, e) *
                             certificate->denominator,
                         of, p->loop[e]);
}

/* The highest price at which no edge is cheaper the more it is passed; or all that there is to be
 * had. *usual: where to look first. */
static int64_t highest_price(const pricing *p, int64_t *usual)
{
  double sum = 1, most = INFINITY, heaviest = 1;
  for (int e = 0; e < p->n_edges; e++) {
    int n = p->closed ? 1 : ends_of(p, e);
    double weight = (double)thr_certificate_weight(p->s->f, p->c, e);
    sum += weight;
    heaviest = fmax(heaviest, weight);
    if (n > 0 && thr_plan_capacity(p->s->f, p->s->o, e) == INT_MAX) most = fmin(most, weight / n);
  }
  *usual = (int64_t)(fmin(most, heaviest) * (double)p->unit);
  return (int64_t)floor(fmin(most, sum) * (double)p->unit);
}

/* ---- the bound at a price ---- */

/* The T-join problem of one part, nodes where cords may end being one, the last. */
typedef struct {
  thr_scratch own; /* the arrays */
  int n_nodes, n_edges;
  int *node; /* [n_nodes] of the framework; -1 = where cords may end */
  int (*edge)[2];
  int *number; /* [n_edges] in pricing.edge */
  int64_t *weight;
  bool *odd;
} problem;

static thr_status problem_init(problem *q, pricing *p, int part, const bool *odd, thr_err *err)
{
  size_t n = (size_t)p->n_nodes + 1, m = (size_t)p->n_edges;
  *q = (problem){0};
  q->node = thr_scratch_array(&q->own, n, sizeof *q->node);
  q->edge = thr_scratch_array(&q->own, m, sizeof *q->edge);
  q->number = thr_scratch_array(&q->own, m, sizeof *q->number);
  q->weight = thr_scratch_array(&q->own, m, sizeof *q->weight);
  q->odd = thr_scratch_array(&q->own, n, sizeof *q->odd);
  thr_status st = thr_scratch_check(&q->own, err);
  if (st) return st;
  for (int v = 0; v <= p->n_nodes; v++) {
    bool hub = v == p->n_nodes;
    if (p->part[v] != part || (!hub && p->local[v] != v)) continue;
    p->place[v] = q->n_nodes;
    q->odd[q->n_nodes] = odd[v];
    q->node[q->n_nodes++] = hub ? -1 : v;
  }
  for (int i = 0; i < p->n_edges; i++) {
    const int *end = p->s->f->edge[i];
    int a = p->local[end[0]], b = p->local[end[1]];
    thr_priced priced = edge_at(p, i);
    if (!priced.room || a == b || p->part[a] != part) continue;
    thr_wide more = priced.odd > priced.even ? priced.odd - priced.even : priced.even - priced.odd;
    q->edge[q->n_edges][0] = p->place[a];
    q->edge[q->n_edges][1] = p->place[b];
    q->number[q->n_edges] = i;
    q->weight[q->n_edges++] = (int64_t)(more / THR_DUAL_DENOMINATOR);
  }
  return THR_OK;
}

/* Adds the cuts of a part's join, which are moved, to the trial. */
static thr_status take_cuts(pricing *p, const problem *q, thr_tjoin *tjoin, thr_err *err)
{
  thr_certificate *certificate = &p->trial;
  thr_cuts cuts = {tjoin->n_cuts, q->n_nodes, tjoin->cut};
  thr_status st = THR_OK;
  tjoin->cut = NULL;
  tjoin->n_cuts = 0;
  if (q->node[q->n_nodes - 1] < 0) {
    st = thr_cuts_avoid_last(&cuts, err);
    if (!st) st = thr_cuts_nest(&cuts, err);
  }
  thr_cut *all =
      st ? NULL
         : thr_realloc(certificate->cut, (size_t)certificate->n_cuts + (size_t)cuts.n, sizeof *all);
  if (!st && !all) st = thr_nomem(err);
  if (all) certificate->cut = all;
  for (int i = 0; i < cuts.n && !st; i++) {
    thr_cut *to = &certificate->cut[certificate->n_cuts + i];
    *to = cuts.cut[i];
    if (to->parent >= 0) to->parent += certificate->n_cuts;
    for (int j = 0; j < to->n_nodes; j++)
      to->node[j] = q->node[to->node[j]]; /* which ascend */
    certificate->sum += to->value;
  }
  if (st) {
    thr_cuts_destroy(&cuts);
    return st;
  }
  certificate->n_cuts += cuts.n;
  free(cuts.cut);
  return THR_OK;
}

/* in_join[n_edges] receives the part's join. *stopped: the limits did. */
static thr_status solve_part(pricing *p, int part, const bool *odd, bool *in_join, bool *stopped,
                             thr_err *err)
{
  problem q;
  thr_tjoin t = {0};
  thr_err why = {0};
  thr_status st = problem_init(&q, p, part, odd, err);
  double sum = 0;
  for (int i = 0; i < q.n_edges && !st; i++)
    sum += (double)q.weight[i];
  *stopped |= sum > 0x1p50; /* so high a price is not tried: the sums would not fit */
  if (!st && !*stopped && q.n_edges > 0) {
    thr_tjoin_problem tjoin = {q.n_nodes, q.n_edges, (const int(*)[2])q.edge, q.weight, q.odd, 0};
    st = thr_tjoin_minimum(&tjoin, p->s->o->engine, p->limits, &t, &why);
    *stopped |= st == THR_ELIMIT;
    if (st && st != THR_ELIMIT) st = thr_fail(err, st, "%s", why.text);
    for (int i = 0; i < q.n_edges && !*stopped && !st; i++)
      in_join[q.number[i]] = t.in_join[i];
    if (!*stopped && !st) st = take_cuts(p, &q, &t, err);
    if (st == THR_ELIMIT) st = THR_OK;
  }
  thr_tjoin_destroy(&t);
  thr_scratch_free(&q.own);
  return st;
}

/* Odd nodes at the trial's price, and what it is worth before any cuts. */
static void count_odd(const pricing *p, bool *odd, thr_wide *bound)
{
  const thr_request *options = p->s->o;
  *bound = p->counts ? 0 : 2 * (thr_wide)options->cords_least * p->trial.place_price[0];
  for (int v = 0; v < p->n_nodes && p->counts; v++) {
    *bound += (thr_wide)options->end_count[v] * p->trial.place_price[v];
    odd[v] ^= options->end_count[v] % 2;
  }
  for (int i = 0; i < p->n_edges; i++) {
    thr_priced priced = edge_at(p, i);
    bool flip = priced.room && priced.odd < priced.even;
    *bound += (flip ? priced.odd : priced.even) - priced.held;
    for (int s = 0; s < 2; s++)
      odd[p->local[p->s->f->edge[i][s]]] ^= flip ^ (thr_plan_cover(p->s->f, options, i) % 2);
  }
  bool sum = false;
  for (int v = 0; v < p->n_nodes; v++)
    sum ^= odd[v];
  odd[p->n_nodes] = sum; /* free: what makes the number even */
}

/* Weight and places of the passes that cost least at the trial's prices: a bound linear in the
 * prices. */
static void measure(const pricing *p, const bool *in_join, double *weight, double *places)
{
  *weight = 0;
  memset(places, 0, (size_t)p->trial.n_prices * sizeof *places);
  for (int e = 0; e < p->n_edges; e++) {
    thr_priced at = edge_at(p, e);
    int odd = at.room && (at.odd < at.even) != in_join[e], n = at.room ? at.passes[odd] : 0;
    *weight += n * (double)thr_certificate_weight(p->s->f, p->c, e);
    n += thr_plan_cover(p->s->f, p->s->o, e);
    for (int s = 0; s < 2 && p->counts; s++)
      places[p->local[p->s->f->edge[e][s]]] += n;
    if (!p->counts)
      places[0] += p->closed ? n - n % 2 + n % 2 * 2.0 / p->loop[e] : n * (double)ends_of(p, e);
  }
}

/* The bound at prices[n], in units; certificate becomes the trial where that is better. */
static thr_status try_prices(pricing *p, const int64_t *price, int n_prices, double *weight,
                             double *places, bool *stopped, thr_err *err)
{
  thr_certificate *certificate = &p->trial;
  size_t n = (size_t)p->n_nodes + 1, m = (size_t)p->n_edges;
  bool *odd = thr_calloc(n, sizeof *odd), *in_join = thr_calloc(m, sizeof *in_join);
  thr_certificate_destroy(certificate);
  *certificate = (thr_certificate){p->c->component, p->c->scale, p->unit * THR_DUAL_DENOMINATOR,
                                   .join = p->c->join, .n_prices = n_prices};
  certificate->place_price = thr_calloc((size_t)n_prices, sizeof *certificate->place_price);
  thr_status st = odd && in_join && certificate->place_price ? THR_OK : thr_nomem(err);
  if (!st) {
    thr_wide bound;
    for (int i = 0; i < n_prices; i++)
      certificate->place_price[i] = price[i] * THR_DUAL_DENOMINATOR;
    count_odd(p, odd, &bound);
    for (int v = 0; v <= p->n_nodes && !st && !*stopped; v++)
      if (p->part[v] == v) st = solve_part(p, v, odd, in_join, stopped, err);
    bound += certificate->sum;
    if (!st) measure(p, in_join, weight, places);
    if (!st && bound * p->c->denominator > p->bound * certificate->denominator) {
      thr_certificate keep = *p->c;
      *p->c = *certificate;
      *certificate = keep;
      p->bound = bound;
    }
  }
  free(odd);
  free(in_join);
  return st;
}

/* Weights being integers. */
static bool proved(const pricing *p)
{
  return p->bound > (p->c->join - 1) * (thr_wide)p->c->denominator;
}

/* ---- the best price ---- */

/* Where the lines of too few and of enough places meet is the highest bound that they allow: a
 * price that keeps it is the best, any other shows a new line. */
static thr_status search(pricing *p, thr_err *err)
{
  const double need = 2.0 * p->s->o->cords_least;
  int64_t low = 0, high, top = highest_price(p, &high);
  bool stopped = false;
  line few = {0}, many = {0}, l;
  thr_status st = try_prices(p, &low, 1, &few.weight, &few.places, &stopped, err);
  if (!st) st = try_prices(p, &high, 1, &many.weight, &many.places, &stopped, err);
  while (!st && !stopped && many.places < need && high < top) {
    few = many;
    low = high;
    high = high < top / 2 ? 2 * high : top;
    st = try_prices(p, &high, 1, &many.weight, &many.places, &stopped, err);
  }
  for (int round = 0; !st && !stopped && few.places < need && many.places > need && !proved(p) &&
                      round < MOST_ROUNDS;
       round++) {
    double price = (many.weight - few.weight) / (many.places - few.places);
    int64_t next = (int64_t)nearbyint(price * (double)p->unit);
    if (next <= low || next >= high) break;
    st = try_prices(p, &next, 1, &l.weight, &l.places, &stopped, err);
    if (st) break;
    if (l.places >= need) {
      many = l;
      high = next;
    } else {
      few = l;
      low = next;
    }
  }
  return st;
}

/* Ends given at nodes: prices of those whose edges need fewer passes than there are ends, by a
 * programme. */
typedef struct {
  pricing *p;
  thr_scratch own;   /* the arrays */
  int n;             /* such nodes */
  int *node, *local; /* [n] and [p->n_nodes], -1 = none */
  thr_lp *lp;        /* columns: prices, in weights; how far the bound is below the join */
  int *column;
  double *value, *x;
} programme;

static void programme_destroy(programme *q)
{
  thr_lp_destroy(q->lp);
  thr_scratch_free(&q->own);
}

static thr_status find_short(programme *q, thr_err *err)
{
  const pricing *p = q->p;
  const thr_frame *frame = p->s->f;
  size_t n = (size_t)p->n_nodes;
  q->node = thr_scratch_array(&q->own, n, sizeof *q->node);
  q->local = thr_scratch_array(&q->own, n, sizeof *q->local);
  q->column = thr_scratch_array(&q->own, n + 1, sizeof *q->column);
  q->value = thr_scratch_array(&q->own, n + 1, sizeof *q->value);
  q->x = thr_scratch_array(&q->own, n + 1, sizeof *q->x);
  thr_status st = thr_scratch_check(&q->own, err);
  if (st) return st;
  for (int v = 0; v < p->n_nodes; v++) {
    int places = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      places += thr_plan_cover(frame, p->s->o, frame->half[i] >> 1);
    q->local[v] = places < p->s->o->end_count[v] ? q->n : -1;
    if (q->local[v] >= 0) q->node[q->n++] = v;
  }
  return THR_OK;
}

/* No edge may be cheaper the more it is passed. */
static thr_status build(programme *q, thr_err *err)
{
  const pricing *p = q->p;
  const thr_frame *frame = p->s->f;
  double *cost = thr_calloc((size_t)q->n + 1, sizeof *cost),
         *upper = thr_calloc((size_t)q->n + 1, sizeof *upper);
  thr_status st = cost && upper ? THR_OK : thr_nomem(err);
  int64_t usual;
  for (int i = 0; i <= q->n && !st; i++)
    upper[i] = (double)highest_price(p, &usual) / (double)p->unit;
  if (!st) cost[q->n] = 1;
  if (!st) st = thr_lp_create(&q->lp, q->n + 1, cost, upper, err);
  for (int e = 0; e < p->n_edges && !st; e++) {
    int n = 0;
    for (int s = 0; s < 2; s++) {
      q->column[n] = q->local[p->local[frame->edge[e][s]]];
      q->value[n] = -1;
      n += q->column[n] >= 0;
    }
    if (n > 0 && thr_plan_capacity(frame, p->s->o, e) == INT_MAX)
      st = thr_lp_add_row(q->lp, n, q->column, q->value,
                          -(double)thr_certificate_weight(frame, p->c, e), err);
  }
  free(cost);
  free(upper);
  return st;
}

/* These passes hold the bound down. */
static thr_status add_passes(programme *q, double weight, const double *places, thr_err *err)
{
  const pricing *p = q->p;
  for (int i = 0; i < q->n; i++) {
    q->column[i] = i;
    q->value[i] = p->s->o->end_count[q->node[i]] - places[q->node[i]];
  }
  q->column[q->n] = q->n;
  q->value[q->n] = 1;
  return thr_lp_add_row(q->lp, q->n + 1, q->column, q->value, (double)p->c->join - weight, err);
}

/* The programme's prices, rounded; ones too high for an edge are lowered. */
static void take_prices(programme *q, int64_t *price)
{
  const pricing *p = q->p;
  thr_lp_primal(q->lp, q->x);
  for (int i = 0; i < q->n; i++)
    price[q->node[i]] = (int64_t)nearbyint(fmax(0, q->x[i]) * (double)p->unit);
  for (int i = 0; i < p->n_edges; i++) {
    const int *end = p->s->f->edge[i];
    int64_t *a = &price[p->local[end[0]]], *b = &price[p->local[end[1]]];
    int64_t most = thr_certificate_weight(p->s->f, p->c, i) * p->unit;
    if (thr_plan_capacity(p->s->f, p->s->o, i) < INT_MAX || *a + *b <= most) continue;
    if (*a > most) *a = most;
    *b = most - *a;
  }
}

/* Kelley's method: the programme's prices show passes that hold the bound below what it hopes,
 * until they do not. */
static thr_status search_each(pricing *p, thr_err *err)
{
  programme q = {.p = p};
  bool stopped = false;
  double weight, *places = thr_calloc((size_t)p->n_nodes, sizeof *places);
  int64_t *price = thr_calloc((size_t)p->n_nodes, sizeof *price);
  thr_lp_outcome outcome = THR_LP_OPTIMAL;
  thr_status st = places && price ? find_short(&q, err) : thr_nomem(err);
  if (!st && q.n > 0 && q.n <= MOST_PRICES) {
    st = build(&q, err);
    for (int round = 0; !st && !proved(p) && round < MOST_ROUNDS; round++) {
      st = try_prices(p, price, p->n_nodes, &weight, places, &stopped, err);
      if (st || stopped || proved(p)) break;
      st = add_passes(&q, weight, places, err);
      if (!st) st = thr_lp_solve(q.lp, p->limits, &outcome, err);
      if (!st && outcome == THR_LP_OPTIMAL) st = thr_lp_solve_exact(q.lp, p->limits, &outcome, err);
      if (st || outcome != THR_LP_OPTIMAL) break;
      take_prices(&q, price);
    }
  }
  programme_destroy(&q);
  free(places);
  free(price);
  if (st == THR_ESOLVER) { /* GLPK gave up: what was found stands */
    if (err) *err = (thr_err){0};
    st = THR_OK;
  }
  return st;
}

thr_status thr_decomposition_prices(const thr_decomposition *decomposition, int cords,
                                    thr_certificate *certificate, thr_err *err)
{
  thr_limits quiet = *decomposition->limits; /* a bound at a price is not one on the weight */
  quiet.progress = NULL;
  pricing p = {.s = decomposition,
               .limits = &quiet,
               .closed = decomposition->o->ends == THR_ENDS_CLOSED,
               .counts = decomposition->o->ends == THR_ENDS_COUNTS,
               .c = certificate};
  p.bound = (thr_wide)certificate->sum - 2 * (thr_wide)cords * certificate->end_price;
  if (proved(&p) || thr_limits_stop(decomposition->limits)) return THR_OK;
  thr_status st = pricing_init(&p, err);
  if (!st && p.n_edges <= MOST_EDGES) st = p.counts ? search_each(&p, err) : search(&p, err);
  pricing_destroy(&p);
  return st;
}
