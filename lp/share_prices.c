/* Prices of places: T-joins among priced edges. */
#include "lp/share_prices.h"
#include "graph/check.h"
#include "graph/disjoint.h"
#include "graph/prices.h"
#include "lp/cuts.h"
#include "lp/engine.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EDGES = 10000, MOST_ROUNDS = 60 };

typedef struct {
  const thr_share *s;
  const thr_limits *limits;
  bool closed, counts;
  int64_t unit;              /* parts of a weight that prices are whole numbers of */
  int n_edges, n_nodes;      /* of the component */
  int *edge, *node, *loop;   /* framework's edges and nodes, shortest loops over edges */
  int *local;                /* [f->n_nodes] position in node; where ends are free, n_nodes for all where they may be */
  int *part, *place;         /* [n_nodes + 1] disjoint sets joined by edges with room; position of a node in its part's problem */
  thr_certificate *c, trial; /* trial: the certificate at a price */
  thr_wide bound;            /* of c, in units of 1/denominator of it */
} pricing;

/* What a choice of passes weighs, in weights, and how many places it has: its bound is linear in the price. */
typedef struct {
  double weight, places;
} line;

static void pricing_destroy(pricing *p)
{
  free(p->edge);
  free(p->node);
  free(p->loop);
  free(p->local);
  free(p->part);
  free(p->place);
  thr_certificate_destroy(&p->trial);
}

/* Units in which loops of the usual lengths have whole prices, as long as sums fit. */
static int64_t choose_unit(const pricing *p)
{
  static const int64_t units[] = {840, 120, 24, 12, 4};
  double sum = 1;
  for (int i = 0; i < p->n_edges; i++)
    sum += (double)thr_certificate_weight(p->s->f, p->c, p->edge[i]);
  for (int i = 0; i < 5; i++)
    if (sum * (double)units[i] < 0x1p49) return units[i];
  return 2;
}

static thr_status pricing_init(pricing *p, int k, thr_err *err)
{
  const thr_frame *f = p->s->f;
  size_t n = (size_t)f->n_nodes, m = (size_t)f->n_edges;
  p->edge = thr_calloc(m, sizeof *p->edge);
  p->node = thr_calloc(n, sizeof *p->node);
  p->loop = thr_calloc(m, sizeof *p->loop);
  p->local = thr_calloc(n, sizeof *p->local);
  p->part = thr_calloc(n + 1, sizeof *p->part);
  p->place = thr_calloc(n + 1, sizeof *p->place);
  if (!p->edge || !p->node || !p->loop || !p->local || !p->part || !p->place) return thr_nomem(err);
  for (int v = 0; v < f->n_nodes; v++)
    if (p->s->component[v] == k) {
      p->local[v] = p->n_nodes;
      p->node[p->n_nodes++] = v;
    }
  for (int i = 0; i < p->n_nodes && !p->closed && !p->counts; i++)
    if (thr_plan_end_allowed(f, p->s->o, p->node[i])) p->local[p->node[i]] = p->n_nodes;
  for (int v = 0; v <= p->n_nodes; v++)
    p->part[v] = v;
  for (int e = 0; e < f->n_edges; e++) {
    const int *end = f->edge[e];
    if (p->s->component[end[0]] != k) continue;
    p->edge[p->n_edges++] = e;
    if (thr_plan_capacity(f, p->s->o, e) > thr_plan_cover(f, p->s->o, e))
      thr_disjoint_join(p->part, p->local[end[0]], p->local[end[1]]);
  }
  for (int v = 0; v <= p->n_nodes; v++)
    p->part[v] = thr_disjoint_find(p->part, v);
  p->unit = choose_unit(p);
  return p->closed ? thr_prices_loops(f, p->edge, p->n_edges, p->loop, err) : THR_OK;
}

/* Nodes of an edge where cords may end. */
static int ends_of(const pricing *p, int e)
{
  const int *end = p->s->f->edge[e];
  return (p->local[end[0]] == p->n_nodes) + (p->local[end[1]] == p->n_nodes);
}

static thr_priced edge_at(const pricing *p, int i)
{
  const thr_certificate *c = &p->trial;
  int e = p->edge[i];
  thr_wide of = p->closed ? c->place_price[0] : 0;
  for (int s = 0; s < 2 && !p->closed; s++) {
    int v = p->local[p->s->f->edge[e][s]];
    if (p->counts || v == p->n_nodes) of += c->place_price[p->counts ? v : 0];
  }
  return thr_prices_edge(p->s->f, p->s->o, e, (thr_wide)thr_certificate_weight(p->s->f, c, e) * c->denominator, of, p->loop[i]);
}

/* The highest price at which no edge is cheaper the more it is passed; or all that there is to be had. */
static int64_t highest_price(const pricing *p)
{
  double sum = 1, most = INFINITY;
  for (int i = 0; i < p->n_edges; i++) {
    int e = p->edge[i], n = p->closed ? 1 : ends_of(p, e);
    double weight = (double)thr_certificate_weight(p->s->f, p->c, e);
    sum += weight;
    if (n > 0 && thr_plan_capacity(p->s->f, p->s->o, e) == INT_MAX) most = fmin(most, weight / n);
  }
  return (int64_t)floor(fmin(most, 2 * sum) * (double)p->unit);
}

/* ---- the bound at a price ---- */

/* The T-join problem of one part, nodes where cords may end being one, the last. */
typedef struct {
  int n_nodes, n_edges;
  int *node; /* [n_nodes] of the framework; -1 = where cords may end */
  int (*edge)[2];
  int *number; /* [n_edges] in pricing.edge */
  int64_t *weight;
  bool *odd;
} problem;

static void problem_destroy(problem *q)
{
  free(q->node);
  free(q->edge);
  free(q->number);
  free(q->weight);
  free(q->odd);
}

static thr_status problem_init(problem *q, pricing *p, int part, const bool *odd, thr_err *err)
{
  size_t n = (size_t)p->n_nodes + 1, m = (size_t)p->n_edges;
  *q = (problem){.node = thr_calloc(n, sizeof *q->node),
                 .edge = thr_calloc(m, sizeof *q->edge),
                 .number = thr_calloc(m, sizeof *q->number),
                 .weight = thr_calloc(m, sizeof *q->weight),
                 .odd = thr_calloc(n, sizeof *q->odd)};
  if (!q->node || !q->edge || !q->number || !q->weight || !q->odd) return thr_nomem(err);
  for (int v = 0; v <= p->n_nodes; v++) {
    bool hub = v == p->n_nodes;
    if (p->part[v] != part || (!hub && p->local[p->node[v]] != v)) continue;
    p->place[v] = q->n_nodes;
    q->odd[q->n_nodes] = odd[v];
    q->node[q->n_nodes++] = hub ? -1 : p->node[v];
  }
  for (int i = 0; i < p->n_edges; i++) {
    const int *end = p->s->f->edge[p->edge[i]];
    int a = p->local[end[0]], b = p->local[end[1]];
    thr_priced e = edge_at(p, i);
    if (!e.room || a == b || p->part[a] != part) continue;
    thr_wide more = e.odd > e.even ? e.odd - e.even : e.even - e.odd;
    q->edge[q->n_edges][0] = p->place[a];
    q->edge[q->n_edges][1] = p->place[b];
    q->number[q->n_edges] = i;
    q->weight[q->n_edges++] = (int64_t)(more / THR_DUAL_DENOMINATOR);
  }
  return THR_OK;
}

/* Adds the cuts of a part's join, which are moved, to the trial. */
static thr_status take_cuts(pricing *p, const problem *q, thr_tjoin *t, thr_err *err)
{
  thr_certificate *c = &p->trial;
  thr_cuts cuts = {t->n_cuts, q->n_nodes, t->cut};
  thr_status st = THR_OK;
  t->cut = NULL;
  t->n_cuts = 0;
  if (q->node[q->n_nodes - 1] < 0) {
    st = thr_cuts_avoid_last(&cuts, err);
    if (!st) st = thr_cuts_nest(&cuts, err);
  }
  thr_cut *all = st ? NULL : thr_realloc(c->cut, (size_t)c->n_cuts + (size_t)cuts.n, sizeof *all);
  if (!st && !all) st = thr_nomem(err);
  if (all) c->cut = all;
  for (int i = 0; i < cuts.n && !st; i++) {
    thr_cut *to = &c->cut[c->n_cuts + i];
    *to = cuts.cut[i];
    if (to->parent >= 0) to->parent += c->n_cuts;
    for (int j = 0; j < to->n_nodes; j++)
      to->node[j] = q->node[to->node[j]]; /* which ascend */
    c->sum += to->value;
  }
  if (st) {
    thr_cuts_destroy(&cuts);
    return st;
  }
  c->n_cuts += cuts.n;
  free(cuts.cut);
  return THR_OK;
}

/* in_join[n_edges] receives the part's join. *stopped: the limits did. */
static thr_status solve_part(pricing *p, int part, const bool *odd, bool *in_join, bool *stopped, thr_err *err)
{
  problem q;
  thr_tjoin t = {0};
  thr_err why = {0};
  thr_status st = problem_init(&q, p, part, odd, err);
  if (!st && q.n_edges > 0) {
    thr_tjoin_problem tjoin = {q.n_nodes, q.n_edges, (const int(*)[2])q.edge, q.weight, q.odd, 0};
    st = thr_tjoin_shrunk(&tjoin, p->s->o->engine, p->limits, &t, &why);
    *stopped |= st == THR_ELIMIT;
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", why.text);
    if (st == THR_ELIMIT) st = THR_OK;
    for (int i = 0; i < q.n_edges && !st; i++)
      in_join[q.number[i]] = t.in_join[i];
    if (!st) st = take_cuts(p, &q, &t, err);
  }
  thr_tjoin_destroy(&t);
  problem_destroy(&q);
  return st;
}

/* Odd nodes at the trial's price, and what it is worth before any cuts. */
static void count_odd(const pricing *p, bool *odd, thr_wide *bound)
{
  const thr_plan_options *o = p->s->o;
  *bound = p->counts ? 0 : 2 * (thr_wide)o->cords_least * p->trial.place_price[0];
  for (int v = 0; v < p->n_nodes && p->counts; v++) {
    *bound += (thr_wide)o->end_count[p->node[v]] * p->trial.place_price[v];
    odd[v] ^= o->end_count[p->node[v]] % 2;
  }
  for (int i = 0; i < p->n_edges; i++) {
    thr_priced e = edge_at(p, i);
    bool flip = e.room && e.odd < e.even;
    *bound += (flip ? e.odd : e.even) - e.held;
    for (int s = 0; s < 2; s++)
      odd[p->local[p->s->f->edge[p->edge[i]][s]]] ^= flip ^ (thr_plan_cover(p->s->f, o, p->edge[i]) % 2);
  }
  bool sum = false;
  for (int v = 0; v < p->n_nodes; v++)
    sum ^= odd[v];
  odd[p->n_nodes] = sum; /* free: what makes the number even */
}

/* Weight and places of the passes that cost least at the trial's price. */
static line line_of(const pricing *p, const bool *in_join)
{
  line l = {0, 0};
  for (int i = 0; i < p->n_edges; i++) {
    int e = p->edge[i];
    thr_priced at = edge_at(p, i);
    int odd = at.room && (at.odd < at.even) != in_join[i], n = at.room ? at.passes[odd] : 0;
    l.weight += n * (double)thr_certificate_weight(p->s->f, p->c, e);
    n += thr_plan_cover(p->s->f, p->s->o, e);
    l.places += p->closed ? n - n % 2 + n % 2 * 2.0 / p->loop[i] : n * (double)ends_of(p, e);
  }
  return l;
}

/* The bound at prices[n], in units; c becomes the trial where that is better. */
static thr_status try_prices(pricing *p, const int64_t *price, int n_prices, line *l, bool *stopped, thr_err *err)
{
  thr_certificate *c = &p->trial;
  size_t n = (size_t)p->n_nodes + 1, m = (size_t)p->n_edges;
  bool *odd = thr_calloc(n, sizeof *odd), *in_join = thr_calloc(m, sizeof *in_join);
  thr_certificate_destroy(c);
  *c = (thr_certificate){p->c->component, p->c->scale, p->unit * THR_DUAL_DENOMINATOR, .join = p->c->join, .n_prices = n_prices};
  c->place_price = thr_calloc((size_t)n_prices, sizeof *c->place_price);
  thr_status st = odd && in_join && c->place_price ? THR_OK : thr_nomem(err);
  if (!st) {
    thr_wide bound;
    for (int i = 0; i < n_prices; i++)
      c->place_price[i] = price[i] * THR_DUAL_DENOMINATOR;
    count_odd(p, odd, &bound);
    for (int v = 0; v <= p->n_nodes && !st && !*stopped; v++)
      if (p->part[v] == v) st = solve_part(p, v, odd, in_join, stopped, err);
    bound += c->sum;
    if (!st) *l = line_of(p, in_join);
    if (!st && bound * p->c->denominator > p->bound * c->denominator) {
      thr_certificate keep = *p->c;
      *p->c = *c;
      *c = keep;
      p->bound = bound;
    }
  }
  free(odd);
  free(in_join);
  return st;
}

/* ---- the best price ---- */

/* Where the lines of too few and of enough places meet is the highest bound that they allow: a price that keeps it is the best,
 * any other shows a new line. */
static thr_status search(pricing *p, thr_err *err)
{
  const double need = 2.0 * p->s->o->cords_least;
  int64_t low = 0, high = highest_price(p);
  bool stopped = false;
  line few, many, l;
  thr_status st = try_prices(p, &low, 1, &few, &stopped, err);
  if (!st) st = try_prices(p, &high, 1, &many, &stopped, err);
  for (int round = 0; !st && !stopped && few.places < need && many.places > need && round < MOST_ROUNDS; round++) {
    double price = (many.weight - few.weight) / (many.places - few.places);
    int64_t next = (int64_t)nearbyint(price * (double)p->unit);
    if (next <= low || next >= high) break;
    st = try_prices(p, &next, 1, &l, &stopped, err);
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

/* With numbers of ends given at nodes every node has its price: in halves of a weight. */
static thr_status search_counts(pricing *p, const int64_t *price, thr_err *err)
{
  const thr_frame *f = p->s->f;
  const thr_plan_options *o = p->s->o;
  bool stopped = false;
  line l;
  int64_t *at = thr_calloc((size_t)p->n_nodes, sizeof *at);
  if (!at) return thr_nomem(err);
  for (int v = 0; v < p->n_nodes; v++) {
    int u = p->node[v], places = 0;
    for (int i = f->first[u]; i < f->first[u + 1]; i++)
      places += thr_plan_cover(f, o, f->half[i] >> 1);
    if (places < o->end_count[u]) at[v] = price[u] * (p->unit / 2);
  }
  for (int i = 0; i < p->n_edges; i++) { /* none may be cheaper the more it is passed */
    int a = p->local[f->edge[p->edge[i]][0]], b = p->local[f->edge[p->edge[i]][1]];
    int64_t most = thr_certificate_weight(f, p->c, p->edge[i]) * p->unit;
    if (thr_plan_capacity(f, o, p->edge[i]) < INT_MAX || at[a] + at[b] <= most) continue;
    if (at[a] > most) at[a] = most;
    at[b] = most - at[a];
  }
  thr_status st = try_prices(p, at, p->n_nodes, &l, &stopped, err);
  free(at);
  return st;
}

thr_status thr_share_prices(const thr_share *s, int k, const int64_t *price, const thr_limits *limits, thr_certificate *c,
                            thr_err *err)
{
  thr_limits quiet = *limits; /* a bound at a price is not one on the weight */
  quiet.progress = NULL;
  pricing p = {
      .s = s, .limits = &quiet, .closed = s->o->ends == THR_ENDS_CLOSED, .counts = s->o->ends == THR_ENDS_COUNTS, .c = c};
  p.bound = (thr_wide)c->sum - 2 * (thr_wide)s->o->cords * c->end_price;
  if (p.bound > (c->join - 1) * (thr_wide)c->denominator) return THR_OK;
  thr_status st = pricing_init(&p, k, err);
  if (!st && p.n_edges <= MOST_EDGES) st = p.counts ? search_counts(&p, price, err) : search(&p, err);
  pricing_destroy(&p);
  return st;
}
