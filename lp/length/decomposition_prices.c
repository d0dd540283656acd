/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proves that cords need as many passes as they have beyond a shortest join, by prices of places
 * (graph/plan/plan_measures.h).
 *
 * Let every pass at a node where a cord may end be worth p, a place for its end, as if it made the
 * edge lighter, and let 2 K such places cost 2 K p. The weight of a minimum T-join at these prices,
 * with what the places cost, is a lower bound for K cords, for every p (Lagrangian relaxation). The
 * bound is a concave function of p. With one price the best p is found where two of its lines meet;
 * where ends are counted at nodes, each node has a price, and they are found by cutting planes.
 *
 * Example: docs/method.md, "Sharing the passes out". */
#include "graph/check/check.h"
#include "graph/arrays.h"
#include "graph/plan/plan_measures.h"
#include "lp/length/postman_parts.h"
#include "lp/solver/solver.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_EDGES = 10000, MOST_ROUNDS = 60, MOST_PRICES = 30 };

/* The search for prices. */
typedef struct {
  const thr_decomposition *decomposition;
  const thr_limits *limits;
  thr_scratch own; /* the arrays */
  bool closed, counts;
  int64_t unit; /* parts of a weight that prices are whole numbers of */
  int n_edges, n_nodes;
  int *loop;  /* [n_edges] shortest loops over edges */
  int *local; /* [n_nodes] the node; where ends are free, n_nodes for all where they may be */
  int *part, *place; /* [n_nodes + 1] disjoint sets joined by edges with room; position of a node in
                        its part's problem */
  thr_certificate *certificate, trial; /* trial: the certificate at a price */
  thr_wide bound;                      /* of the certificate, in units of 1/denominator of it */
} place_pricing;

/* The passes that cost least at a price: what they weigh, and how many places they have. */
typedef struct {
  double weight, places;
} line;

static void pricing_destroy(place_pricing *pricing)
{
  thr_scratch_free(&pricing->own);
  thr_certificate_destroy(&pricing->trial);
}

/* Chooses units in which loops of the usual lengths have whole prices, as long as sums fit. */
static int64_t choose_unit(const place_pricing *pricing)
{
  static const int64_t units[] = {840, 120, 24, 12, 4};
  double sum = 1;
  for (int i = 0; i < pricing->n_edges; i++)
    sum += (double)thr_certificate_weight(pricing->decomposition->f, pricing->certificate, i);

  for (int i = 0; i < 5; i++)
    if (sum * (double)units[i] < 0x1p49) return units[i];
  return 2;
}

/* Allocates the arrays and finds the parts: nodes that edges with room for an extra pass join. */
static thr_status pricing_init(place_pricing *pricing, thr_err *err)
{
  const thr_frame *frame = pricing->decomposition->f;
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  pricing->n_nodes = frame->n_nodes;
  pricing->n_edges = frame->n_edges;
  pricing->loop = thr_scratch_array(&pricing->own, m, sizeof *pricing->loop);
  pricing->local = thr_scratch_array(&pricing->own, n, sizeof *pricing->local);
  pricing->part = thr_scratch_array(&pricing->own, n + 1, sizeof *pricing->part);
  pricing->place = thr_scratch_array(&pricing->own, n + 1, sizeof *pricing->place);

  thr_status st = thr_scratch_check(&pricing->own, err);
  if (st) return st;

  /* Nodes where cords may end freely are one node, the last. */
  for (int v = 0; v < pricing->n_nodes; v++)
    pricing->local[v] = !pricing->closed && !pricing->counts &&
                                thr_plan_end_allowed(frame, pricing->decomposition->o, v)
                            ? pricing->n_nodes
                            : v;

  for (int v = 0; v <= pricing->n_nodes; v++)
    pricing->part[v] = v;
  for (int e = 0; e < pricing->n_edges; e++)
    if (thr_plan_capacity(frame, pricing->decomposition->o, e) >
        thr_plan_cover(frame, pricing->decomposition->o, e))
      thr_disjoint_join(pricing->part, pricing->local[frame->edge[e][0]],
                        pricing->local[frame->edge[e][1]]);
  for (int v = 0; v <= pricing->n_nodes; v++)
    pricing->part[v] = thr_disjoint_find(pricing->part, v);

  pricing->unit = choose_unit(pricing);
  if (!pricing->closed) return THR_OK;

  /* Closed cords have places by loops. */
  int *work = thr_calloc(2 * n + m, sizeof *work);
  for (int e = 0; work && e < pricing->n_edges; e++)
    work[2 * n + (size_t)e] = e;
  if (work) thr_prices_loops(frame, work + 2 * n, pricing->n_edges, work, pricing->loop);
  free(work);
  return work ? THR_OK : thr_nomem(err);
}

/* Returns at how many nodes of an edge cords may end. */
static int ends_of(const place_pricing *pricing, int e)
{
  const int *end = pricing->decomposition->f->edge[e];
  return (pricing->local[end[0]] == pricing->n_nodes) +
         (pricing->local[end[1]] == pricing->n_nodes);
}

/* Returns what passes of an edge cost at the trial's prices. */
static thr_priced edge_at(const place_pricing *pricing, int e)
{
  const thr_certificate *certificate = &pricing->trial;
  thr_wide of = pricing->closed ? certificate->place_price[0] : 0;

  /* Open cords: a pass has a place at each of its ends that has a price. */
  for (int s = 0; s < 2 && !pricing->closed; s++) {
    int v = pricing->local[pricing->decomposition->f->edge[e][s]];
    if (pricing->counts || v == pricing->n_nodes)
      of += certificate->place_price[pricing->counts ? v : 0];
  }

  return thr_prices_edge(
      pricing->decomposition->f, pricing->decomposition->o, e,
      (thr_wide)thr_certificate_weight(pricing->decomposition->f, certificate, e) *
          certificate->denominator,
      of, pricing->loop[e]);
}

/* Returns the highest price at which no edge is cheaper the more it is passed; or the sum of all
 * weights if there is no such price. *usual receives a price to look at first. */
static int64_t highest_price(const place_pricing *pricing, int64_t *usual)
{
  double sum = 1, most = INFINITY, heaviest = 1;
  for (int e = 0; e < pricing->n_edges; e++) {
    int n = pricing->closed ? 1 : ends_of(pricing, e);
    double weight =
        (double)thr_certificate_weight(pricing->decomposition->f, pricing->certificate, e);
    sum += weight;
    heaviest = fmax(heaviest, weight);

    if (n > 0 &&
        thr_plan_capacity(pricing->decomposition->f, pricing->decomposition->o, e) == INT_MAX)
      most = fmin(most, weight / n);
  }

  *usual = (int64_t)(fmin(most, heaviest) * (double)pricing->unit);
  return (int64_t)floor(fmin(most, sum) * (double)pricing->unit);
}

/* ---- the bound at a price ---- */

/* The T-join problem of one part, nodes where cords may end being one, the last. */
typedef struct {
  thr_scratch own; /* the arrays */
  int n_nodes, n_edges;
  int *node; /* [n_nodes] of the framework; -1 = where cords may end */
  int (*edge)[2];
  int *number; /* [n_edges] of the framework */
  int64_t *weight;
  bool *odd;
} part_problem;

/* Makes the T-join problem of one part at the trial's prices. odd[n_nodes + 1]: the set T. */
static thr_status problem_init(part_problem *problem, place_pricing *pricing, int part,
                               const bool *odd, thr_err *err)
{
  size_t n = (size_t)pricing->n_nodes + 1, m = (size_t)pricing->n_edges;
  *problem = (part_problem){0};
  problem->node = thr_scratch_array(&problem->own, n, sizeof *problem->node);
  problem->edge = thr_scratch_array(&problem->own, m, sizeof *problem->edge);
  problem->number = thr_scratch_array(&problem->own, m, sizeof *problem->number);
  problem->weight = thr_scratch_array(&problem->own, m, sizeof *problem->weight);
  problem->odd = thr_scratch_array(&problem->own, n, sizeof *problem->odd);

  thr_status st = thr_scratch_check(&problem->own, err);
  if (st) return st;

  /* Number the nodes of the part. */
  for (int v = 0; v <= pricing->n_nodes; v++) {
    bool hub = v == pricing->n_nodes;
    if (pricing->part[v] != part || (!hub && pricing->local[v] != v)) continue;
    pricing->place[v] = problem->n_nodes;
    problem->odd[problem->n_nodes] = odd[v];
    problem->node[problem->n_nodes++] = hub ? -1 : v;
  }

  /* An edge weighs what the other parity of its passes costs more. */
  for (int i = 0; i < pricing->n_edges; i++) {
    const int *end = pricing->decomposition->f->edge[i];
    int a = pricing->local[end[0]], b = pricing->local[end[1]];
    thr_priced priced = edge_at(pricing, i);
    if (!priced.room || a == b || pricing->part[a] != part) continue;

    thr_wide more = priced.odd > priced.even ? priced.odd - priced.even : priced.even - priced.odd;
    problem->edge[problem->n_edges][0] = pricing->place[a];
    problem->edge[problem->n_edges][1] = pricing->place[b];
    problem->number[problem->n_edges] = i;
    problem->weight[problem->n_edges++] = (int64_t)(more / THR_DUAL_DENOMINATOR);
  }
  return THR_OK;
}

/* Moves the cuts of a part's join to the trial. The node that stands for all free ends must not be
 * in a cut. */
static thr_status take_cuts(place_pricing *pricing, const part_problem *problem, thr_tjoin *tjoin,
                            thr_err *err)
{
  thr_certificate *certificate = &pricing->trial;
  thr_cuts cuts = {tjoin->n_cuts, problem->n_nodes, tjoin->cut};
  thr_status st = THR_OK;

  tjoin->cut = NULL;
  tjoin->n_cuts = 0;
  if (problem->node[problem->n_nodes - 1] < 0) {
    st = thr_cuts_avoid_last(&cuts, err);
    if (!st) st = thr_cuts_nest(&cuts, err);
  }

  thr_cut *all =
      st ? NULL
         : thr_realloc(certificate->cut, (size_t)certificate->n_cuts + (size_t)cuts.n, sizeof *all);
  if (!st && !all) st = thr_nomem(err);
  if (all) certificate->cut = all;

  /* The cuts name the framework's nodes, and their parents by new numbers. */
  for (int i = 0; i < cuts.n && !st; i++) {
    thr_cut *to = &certificate->cut[certificate->n_cuts + i];
    *to = cuts.cut[i];
    if (to->parent >= 0) to->parent += certificate->n_cuts;
    for (int j = 0; j < to->n_nodes; j++)
      to->node[j] = problem->node[to->node[j]]; /* which ascend */
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

/* Solves the T-join problem of a part: in_join[n_edges] receives its join. *stopped: the limits did
 * not suffice. */
static thr_status solve_part(place_pricing *pricing, int part, const bool *odd, bool *in_join,
                             bool *stopped, thr_err *err)
{
  part_problem problem;
  thr_tjoin join = {0};
  thr_err why = {0};
  thr_status st = problem_init(&problem, pricing, part, odd, err);

  double sum = 0;
  for (int i = 0; i < problem.n_edges && !st; i++)
    sum += (double)problem.weight[i];
  *stopped |= sum > 0x1p50; /* so high a price is not tried: the sums would not fit */
  if (!st && !*stopped && problem.n_edges > 0) {
    thr_tjoin_problem tjoin_problem = {
        problem.n_nodes, problem.n_edges, (const int(*)[2])problem.edge,
        problem.weight,  problem.odd,     0};
    st = thr_tjoin_minimum(&tjoin_problem, pricing->decomposition->o->engine, pricing->limits,
                           &join, &why);
    *stopped |= st == THR_ELIMIT;
    if (st && st != THR_ELIMIT) st = thr_fail(err, st, "%s", why.text);

    for (int i = 0; i < problem.n_edges && !*stopped && !st; i++)
      in_join[problem.number[i]] = join.in_join[i];
    if (!*stopped && !st) st = take_cuts(pricing, &problem, &join, err);
    if (st == THR_ELIMIT) st = THR_OK;
  }

  thr_tjoin_destroy(&join);
  thr_scratch_free(&problem.own);
  return st;
}

/* Finds the odd nodes, the set T, if every edge has the passes that cost least at the trial's
 * prices, and what these passes and the places cost together. */
static void count_odd(const place_pricing *pricing, bool *odd, thr_wide *bound)
{
  const thr_request *options = pricing->decomposition->o;

  *bound = pricing->counts ? 0 : 2 * (thr_wide)options->cords_least * pricing->trial.place_price[0];
  for (int v = 0; v < pricing->n_nodes && pricing->counts; v++) {
    *bound += (thr_wide)options->end_count[v] * pricing->trial.place_price[v];
    odd[v] ^= options->end_count[v] % 2;
  }

  for (int i = 0; i < pricing->n_edges; i++) {
    thr_priced priced = edge_at(pricing, i);
    bool flip = priced.room && priced.odd < priced.even;
    *bound += (flip ? priced.odd : priced.even) - priced.held;
    for (int s = 0; s < 2; s++)
      odd[pricing->local[pricing->decomposition->f->edge[i][s]]] ^=
          flip ^ (thr_plan_cover(pricing->decomposition->f, options, i) % 2);
  }

  bool sum = false;
  for (int v = 0; v < pricing->n_nodes; v++)
    sum ^= odd[v];
  odd[pricing->n_nodes] = sum; /* free: what makes the number even */
}

/* Computes weight and places of the passes that cost least at the trial's prices. They give a bound
 * that is linear in the prices. */
static void measure(const place_pricing *pricing, const bool *in_join, double *weight,
                    double *places)
{
  *weight = 0;
  memset(places, 0, (size_t)pricing->trial.n_prices * sizeof *places);
  for (int e = 0; e < pricing->n_edges; e++) {
    thr_priced at = edge_at(pricing, e);

    /* An edge in the join has the parity that is not the cheapest one. */
    int odd = at.room && (at.odd < at.even) != in_join[e], n = at.room ? at.passes[odd] : 0;
    *weight +=
        n * (double)thr_certificate_weight(pricing->decomposition->f, pricing->certificate, e);

    n += thr_plan_cover(pricing->decomposition->f, pricing->decomposition->o, e);
    for (int s = 0; s < 2 && pricing->counts; s++)
      places[pricing->local[pricing->decomposition->f->edge[e][s]]] += n;
    if (!pricing->counts)
      places[0] += pricing->closed ? n - n % 2 + n % 2 * 2.0 / pricing->loop[e]
                                   : n * (double)ends_of(pricing, e);
  }
}

/* Computes the bound at price[n_prices], in units; the certificate becomes the trial if this bound
 * is better. */
static thr_status try_prices(place_pricing *pricing, const int64_t *price, int n_prices,
                             double *weight, double *places, bool *stopped, thr_err *err)
{
  thr_certificate *certificate = &pricing->trial;
  size_t n = (size_t)pricing->n_nodes + 1, m = (size_t)pricing->n_edges;
  bool *odd = thr_calloc(n, sizeof *odd), *in_join = thr_calloc(m, sizeof *in_join);

  /* The trial starts without cuts. */
  thr_certificate_destroy(certificate);
  *certificate = (thr_certificate){pricing->certificate->component, pricing->certificate->scale,
                                   pricing->unit * THR_DUAL_DENOMINATOR,
                                   .join = pricing->certificate->join, .n_prices = n_prices};
  certificate->place_price = thr_calloc((size_t)n_prices, sizeof *certificate->place_price);
  thr_status st = odd && in_join && certificate->place_price ? THR_OK : thr_nomem(err);

  /* The set T and what the cheapest passes cost, then the join of every part. */
  if (!st) {
    thr_wide bound;
    for (int i = 0; i < n_prices; i++)
      certificate->place_price[i] = price[i] * THR_DUAL_DENOMINATOR;
    count_odd(pricing, odd, &bound);

    for (int v = 0; v <= pricing->n_nodes && !st && !*stopped; v++)
      if (pricing->part[v] == v) st = solve_part(pricing, v, odd, in_join, stopped, err);
    bound += certificate->sum;

    if (!st) measure(pricing, in_join, weight, places);
    if (!st &&
        bound * pricing->certificate->denominator > pricing->bound * certificate->denominator) {
      /* The trial is better: exchange it for the certificate. */
      thr_certificate keep = *pricing->certificate;
      *pricing->certificate = *certificate;
      *certificate = keep;
      pricing->bound = bound;
    }
  }

  free(odd);
  free(in_join);
  return st;
}

/* Returns whether the bound is above the weight of the join less one, which is enough as weights
 * are integers. */
static bool proved(const place_pricing *pricing)
{
  return pricing->bound >
         (pricing->certificate->join - 1) * (thr_wide)pricing->certificate->denominator;
}

/* ---- the best price ---- */

/* Searches the best price. Where the lines of too few and of enough places meet is the highest
 * bound that both lines allow: if the true bound at this price is as high, the price is the best
 * one; otherwise it gives a new line. */
static thr_status search(place_pricing *pricing, thr_err *err)
{
  const double need = 2.0 * pricing->decomposition->o->cords_least;
  int64_t low = 0, high, top = highest_price(pricing, &high);
  bool stopped = false;
  line few = {0}, many = {0}, middle;

  thr_status st = try_prices(pricing, &low, 1, &few.weight, &few.places, &stopped, err);
  if (!st) st = try_prices(pricing, &high, 1, &many.weight, &many.places, &stopped, err);

  /* Raise the high price until its passes have enough places. */
  while (!st && !stopped && many.places < need && high < top) {
    few = many;
    low = high;
    high = high < top / 2 ? 2 * high : top;
    st = try_prices(pricing, &high, 1, &many.weight, &many.places, &stopped, err);
  }

  for (int round = 0; !st && !stopped && few.places < need && many.places > need &&
                      !proved(pricing) && round < MOST_ROUNDS;
       round++) {
    double price = (many.weight - few.weight) / (many.places - few.places);
    int64_t next = (int64_t)nearbyint(price * (double)pricing->unit);
    if (next <= low || next >= high) break;

    st = try_prices(pricing, &next, 1, &middle.weight, &middle.places, &stopped, err);
    if (st) break;

    if (middle.places >= need) {
      many = middle;
      high = next;
    } else {
      few = middle;
      low = next;
    }
  }
  return st;
}

/* The linear programme of the prices where ends are counted at nodes: a price for each node whose
 * edges need fewer passes than there are ends. */
typedef struct {
  place_pricing *pricing;
  thr_scratch own;   /* the arrays */
  int n;             /* such nodes */
  int *node, *local; /* [n] and [pricing->n_nodes], -1 = none */
  thr_lp *lp;        /* columns: prices, in weights; how far the bound is below the join */
  int *column;
  double *value, *solution;
} price_programme;

static void programme_destroy(price_programme *programme)
{
  thr_lp_destroy(programme->lp);
  thr_scratch_free(&programme->own);
}

/* Finds the nodes whose edges need fewer passes than there are ends. */
static thr_status find_short(price_programme *programme, thr_err *err)
{
  const place_pricing *pricing = programme->pricing;
  const thr_frame *frame = pricing->decomposition->f;
  size_t n = (size_t)pricing->n_nodes;
  programme->node = thr_scratch_array(&programme->own, n, sizeof *programme->node);
  programme->local = thr_scratch_array(&programme->own, n, sizeof *programme->local);
  programme->column = thr_scratch_array(&programme->own, n + 1, sizeof *programme->column);
  programme->value = thr_scratch_array(&programme->own, n + 1, sizeof *programme->value);
  programme->solution = thr_scratch_array(&programme->own, n + 1, sizeof *programme->solution);

  thr_status st = thr_scratch_check(&programme->own, err);
  if (st) return st;

  /* A node with enough passes by its covers needs no price. */
  for (int v = 0; v < pricing->n_nodes; v++) {
    int places = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      places += thr_plan_cover(frame, pricing->decomposition->o, frame->half[i] >> 1);
    programme->local[v] = places < pricing->decomposition->o->end_count[v] ? programme->n : -1;
    if (programme->local[v] >= 0) programme->node[programme->n++] = v;
  }
  return THR_OK;
}

/* Makes the programme: minimize how far the bound is below the join, with prices at which no edge
 * is cheaper the more it is passed. */
static thr_status build(price_programme *programme, thr_err *err)
{
  const place_pricing *pricing = programme->pricing;
  const thr_frame *frame = pricing->decomposition->f;
  double *cost = thr_calloc((size_t)programme->n + 1, sizeof *cost),
         *upper = thr_calloc((size_t)programme->n + 1, sizeof *upper);
  thr_status st = cost && upper ? THR_OK : thr_nomem(err);

  int64_t usual;

  /* No price is above the highest one. */
  for (int i = 0; i <= programme->n && !st; i++)
    upper[i] = (double)highest_price(pricing, &usual) / (double)pricing->unit;
  if (!st) cost[programme->n] = 1;
  if (!st) st = thr_lp_create(&programme->lp, programme->n + 1, cost, upper, err);

  /* The prices at both ends of an edge are no more than its weight, if it may have any passes. */
  for (int e = 0; e < pricing->n_edges && !st; e++) {
    int n = 0;
    for (int s = 0; s < 2; s++) {
      programme->column[n] = programme->local[pricing->local[frame->edge[e][s]]];
      programme->value[n] = -1;
      n += programme->column[n] >= 0;
    }

    if (n > 0 && thr_plan_capacity(frame, pricing->decomposition->o, e) == INT_MAX)
      st = thr_lp_add_row(programme->lp, n, programme->column, programme->value,
                          -(double)thr_certificate_weight(frame, pricing->certificate, e), err);
  }
  free(cost);
  free(upper);
  return st;
}

/* Adds a row for passes that were found: they hold the bound down at all prices. */
static thr_status add_passes(price_programme *programme, double weight, const double *places,
                             thr_err *err)
{
  const place_pricing *pricing = programme->pricing;
  for (int i = 0; i < programme->n; i++) {
    programme->column[i] = i;
    programme->value[i] =
        pricing->decomposition->o->end_count[programme->node[i]] - places[programme->node[i]];
  }

  programme->column[programme->n] = programme->n;
  programme->value[programme->n] = 1;
  return thr_lp_add_row(programme->lp, programme->n + 1, programme->column, programme->value,
                        (double)pricing->certificate->join - weight, err);
}

/* Rounds the prices of the programme. Prices that the rounding made too high for an edge are
 * lowered. */
static void take_prices(price_programme *programme, int64_t *price)
{
  const place_pricing *pricing = programme->pricing;
  thr_lp_primal(programme->lp, programme->solution);

  for (int i = 0; i < programme->n; i++)
    price[programme->node[i]] =
        (int64_t)nearbyint(fmax(0, programme->solution[i]) * (double)pricing->unit);

  /* An edge without a limit must not weigh less than nothing. */
  for (int i = 0; i < pricing->n_edges; i++) {
    const int *end = pricing->decomposition->f->edge[i];
    int64_t *a = &price[pricing->local[end[0]]], *b = &price[pricing->local[end[1]]];

    int64_t most =
        thr_certificate_weight(pricing->decomposition->f, pricing->certificate, i) * pricing->unit;
    if (thr_plan_capacity(pricing->decomposition->f, pricing->decomposition->o, i) < INT_MAX ||
        *a + *b <= most)
      continue;

    if (*a > most) *a = most;
    *b = most - *a;
  }
}

/* Searches the best prices by Kelley's cutting-plane method: the programme's prices show passes
 * that hold the bound below what the programme hopes, until they do not. */
static thr_status search_each(place_pricing *pricing, thr_err *err)
{
  price_programme programme = {.pricing = pricing};
  bool stopped = false;
  double weight, *places = thr_calloc((size_t)pricing->n_nodes, sizeof *places);
  int64_t *price = thr_calloc((size_t)pricing->n_nodes, sizeof *price);
  thr_lp_outcome outcome = THR_LP_OPTIMAL;
  thr_status st = places && price ? find_short(&programme, err) : thr_nomem(err);

  if (!st && programme.n > 0 && programme.n <= MOST_PRICES) {
    st = build(&programme, err);
    for (int round = 0; !st && !proved(pricing) && round < MOST_ROUNDS; round++) {
      st = try_prices(pricing, price, pricing->n_nodes, &weight, places, &stopped, err);
      if (st || stopped || proved(pricing)) break;

      st = add_passes(&programme, weight, places, err);
      if (!st) st = thr_lp_solve(programme.lp, pricing->limits, &outcome, err);
      if (!st && outcome == THR_LP_OPTIMAL)
        st = thr_lp_solve_exact(programme.lp, pricing->limits, &outcome, err);
      if (st || outcome != THR_LP_OPTIMAL) break;
      take_prices(&programme, price);
    }
  }

  programme_destroy(&programme);
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
  place_pricing pricing = {.decomposition = decomposition,
                           .limits = &quiet,
                           .closed = decomposition->o->ends == THR_ENDS_CLOSED,
                           .counts = decomposition->o->ends == THR_ENDS_COUNTS,
                           .certificate = certificate};

  pricing.bound = (thr_wide)certificate->sum - 2 * (thr_wide)cords * certificate->end_price;
  if (proved(&pricing) || thr_limits_stop(decomposition->limits)) return THR_OK;

  thr_status st = pricing_init(&pricing, err);
  if (!st && pricing.n_edges <= MOST_EDGES)
    st = pricing.counts ? search_each(&pricing, err) : search(&pricing, err);
  pricing_destroy(&pricing);
  return st;
}
