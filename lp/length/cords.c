/* Passes, room for ends, walks, cords; once, or for more and more cords until none is too long. */
#include "lp/length/cords.h"
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "graph/threading/walks.h"
#include "lp/length/balance.h"
#include "lp/length/postman.h"
#include "lp/length/postman_parts.h"
#include "lp/length/share.h"
#include "lp/length/share_prices.h"
#include "lp/length/share_table.h"
#include "lp/length/ways.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_frame *f;
  const thr_plan_options *o;
  const thr_limits *limits;
  thr_share share;
  int n_components, *component;
  thr_walks *walks; /* [n_components] results */
  int *wanted;      /* [n_components] cords to be made of a component now; 0 = none */
  int *passes;      /* [n_edges] */
  bool least;       /* the passes are the shortest that hold the cords */
  bool certain;     /* the longest cord is as short as can be: the solver's word */
} several;

static void several_destroy(several *x)
{
  for (int k = 0; x->walks && k < x->n_components; k++)
    thr_walks_destroy(&x->walks[k]);
  free(x->walks);
  free(x->component);
  free(x->wanted);
  free(x->passes);
}

static thr_status several_init(several *x, thr_err *err)
{
  if (!(x->component = thr_calloc((size_t)x->f->n_nodes, sizeof *x->component))) return thr_nomem(err);
  thr_status st = thr_frame_components(x->f, x->component, &x->n_components, err);
  if (st) return st;
  size_t n = (size_t)x->n_components;
  x->walks = thr_calloc(n, sizeof *x->walks);
  x->wanted = thr_calloc(n, sizeof *x->wanted);
  x->passes = thr_calloc((size_t)x->f->n_edges, sizeof *x->passes);
  x->share = (thr_share){x->f, x->o, x->component};
  x->least = x->certain = true;
  return x->walks && x->wanted && x->passes ? THR_OK : thr_nomem(err);
}

static bool within(double length, double limit)
{
  return length <= limit * (1 + 1e-12);
}

static int component_of(const several *x, int e)
{
  return x->component[x->f->edge[e][0]];
}

/* ---- sharing out ---- */

/* Passes of component k alone, in numbers of all edges. */
static void only_wanted(const several *x, int *passes)
{
  for (int e = 0; e < x->f->n_edges; e++)
    passes[e] = x->wanted[component_of(x, e)] > 0 ? x->passes[e] : 0;
}

static const char *node_of(const several *x, int k)
{
  int v = 0;
  while (x->component[v] != k)
    v++;
  return x->f->name[v];
}

/* A closed cord through its passes again: its ends are where they were, where leaving out a turn saves most. */
static thr_status open_again(const several *x, thr_walk *w, int node, thr_err *err)
{
  int best = -1;
  double most = -1;
  for (int i = 0; i < w->n; i++) {
    double turn = thr_walk_turn(x->f, thr_walk_before(w, i), w->half[i]);
    if (thr_walk_node(x->f, w, i) != node || turn < most + 1e-9) continue;
    best = i;
    most = turn;
  }
  w->cyclic = false;
  return thr_walk_rotate(w, best, err);
}

/* Evening out takes the passes of a cord in any order: the same passes again with little turning. Each cord costs a look at the
 * whole framework; many cords of a large one stay as they are. */
static thr_status straighten(const several *x, int k, int *passes, thr_err *err)
{
  const double most = 1e8;
  const thr_frame *f = x->f;
  if ((double)x->walks[k].n_walks * f->n_edges > most) return THR_OK;
  thr_walks *one = thr_calloc((size_t)x->n_components, sizeof *one);
  thr_status st = one ? THR_OK : thr_nomem(err);
  for (int i = 0; i < x->walks[k].n_walks && !st; i++) {
    thr_walk *w = &x->walks[k].walk[i];
    int node = thr_walk_node(f, w, 0);
    bool cyclic = w->cyclic;
    memset(passes, 0, (size_t)f->n_edges * sizeof *passes);
    for (int j = 0; j < w->n; j++)
      passes[w->half[j] >> 1]++;
    st = thr_walks_trace(f, passes, x->component, x->n_components, one, err);
    if (st) break;
    free(w->half);
    *w = one[k].walk[0];
    one[k].walk[0].half = NULL;
    thr_walks_destroy(&one[k]);
    if (w->cyclic && !cyclic) st = open_again(x, w, node, err);
  }
  free(one);
  return st;
}

/* The walks as they are, for whoever keeps the best cords so far. */
static thr_status tell(const several *x, thr_err *err)
{
  thr_plan p = {.frame = *x->f, .options = *x->o};
  if (!x->limits->found) return THR_OK;
  thr_walks *copy = thr_calloc((size_t)x->n_components, sizeof *copy);
  thr_status st = copy ? THR_OK : thr_nomem(err);
  for (int k = 0; k < x->n_components && !st; k++)
    for (int i = 0; i < x->walks[k].n_walks && !st; i++) {
      const thr_walk *w = &x->walks[k].walk[i];
      st = thr_walks_copy(&copy[k], x->f, w->half, w->n, w->cyclic, err);
    }
  if (!st) st = thr_walks_plan(copy, x->n_components, &p, err);
  if (!st) thr_limits_found(x->limits, p.cord, p.n_cords, NULL);
  thr_cords_destroy(p.cord, p.n_cords);
  for (int k = 0; copy && k < x->n_components; k++)
    thr_walks_destroy(&copy[k]);
  free(copy);
  return st;
}

/* What the table knows better, where the component is small: with a goal only if it was missed. */
static thr_status make_exact(several *x, int k, double goal, thr_err *err)
{
  const thr_plan_options *o = x->o;
  thr_walks *w = &x->walks[k];
  bool certain, counts = o->ends == THR_ENDS_COUNTS;
  thr_share_ask ask = {counts ? w->n_walks : o->cords_least, counts ? w->n_walks : o->cords, true, INFINITY};
  if (goal > 0 && within(thr_walks_longest(w), goal)) return THR_OK;
  if (goal > 0) ask = (thr_share_ask){ask.least, counts ? ask.most : x->wanted[k], false, goal};
  thr_status st = thr_share_table(&x->share, k, &ask, x->limits, w, x->passes, &certain, err);
  x->certain &= certain;
  return st;
}

/* So many closed cords of component k as its shortest passes do not hold. */
static thr_status make_more(several *x, int k, int n, thr_err *err)
{
  thr_walks *w = &x->walks[k];
  bool certain, found;
  thr_status st = thr_share_table(&x->share, k, &(thr_share_ask){n, n, false, INFINITY}, x->limits, w, x->passes, &certain, err);
  x->least &= certain;
  found = w->n_walks >= n;
  if (!st && !found && !certain) st = thr_share_more(&x->share, k, n, x->passes, w, &found, err);
  if (st || found) return st;
  return thr_fail(err, THR_EINFEASIBLE, "the component with node %s cannot hold %d closed cords: the capacities leave no room",
                  node_of(x, k), n);
}

/* Closed cords of component k from its circuit. scratch[n_edges]. */
static thr_status make_closed(several *x, int k, bool even, int *scratch, thr_err *err)
{
  bool enough;
  int n = x->wanted[k], must = x->o->cords_least;
  thr_status st = thr_share_circuits(&x->share, n, even, &x->walks[k], &enough, err);
  if (!st && !enough && even) st = thr_share_chords(&x->share, n, x->passes, &x->walks[k], err);
  if (st || enough || (even && x->walks[k].n_walks >= must)) return st;
  st = make_more(x, k, even ? must : n, err);
  return st ? st : straighten(x, k, scratch, err);
}

/* Room for the ends of as many cords as are wanted; without it there are none. */
static thr_status make_places(several *x, int k, const thr_certificate *c, thr_err *err)
{
  bool changed;
  thr_err why = {0};
  thr_status st = thr_share_places(&x->share, k, x->wanted[k], c, x->limits, x->passes, &changed, &why);
  return st ? thr_fail(err, st == THR_ELIMIT ? THR_EINFEASIBLE : st, "%s", why.text) : THR_OK;
}

/* The walks of all wanted components. */
static thr_status share_out(several *x, const thr_certificate *c, bool even, double goal, thr_err *err)
{
  thr_status st = THR_OK;
  int *passes = thr_calloc((size_t)x->f->n_edges, sizeof *passes);
  thr_walks *new = thr_calloc((size_t)x->n_components, sizeof *new);
  if (!passes || !new) st = thr_nomem(err);
  for (int k = 0; k < x->n_components && !st; k++)
    if (x->wanted[k]) st = make_places(x, k, &c[k], err);
  if (!st) only_wanted(x, passes);
  if (!st) st = thr_walks_trace(x->f, passes, x->component, x->n_components, new, err);
  for (int k = 0; k < x->n_components && !st; k++) {
    if (!x->wanted[k]) continue;
    thr_walks_destroy(&x->walks[k]);
    x->walks[k] = new[k];
    new[k] = (thr_walks){0};
    st = x->o->ends == THR_ENDS_CLOSED ? make_closed(x, k, even, passes, err)
                                       : thr_share_cut(&x->share, x->wanted[k], even, &x->walks[k], err);
  }
  if (!st && even) st = tell(x, err);
  for (int k = 0; k < x->n_components && even && !st; k++) {
    if (!x->wanted[k]) continue;
    st = thr_balance_walks(&x->share, &x->walks[k], goal, x->limits, x->passes, err);
    if (!st) st = make_exact(x, k, goal, err);
    if (!st) st = straighten(x, k, passes, err);
  }
  for (int k = 0; new &&k < x->n_components; k++)
    thr_walks_destroy(&new[k]);
  free(new);
  free(passes);
  return st;
}

/* ---- how many cords ---- */

/* Half of the passes that arrive where a cord may end: so many cords have room. */
static int most_cords(const several *x, const int *passes, int k)
{
  int64_t sum = 0;
  for (int v = 0; v < x->f->n_nodes; v++) {
    if (x->component[v] != k || !thr_plan_end_allowed(x->f, x->o, v)) continue;
    for (int i = x->f->first[v]; i < x->f->first[v + 1]; i++)
      sum += passes[x->f->half[i] >> 1];
  }
  return sum / 2 > INT_MAX ? INT_MAX : (int)(sum / 2);
}

static int counted_cords(const several *x, int k)
{
  int sum = 0;
  for (int v = 0; v < x->f->n_nodes; v++)
    if (x->component[v] == k) sum += x->o->end_count[v];
  return sum / 2;
}

static void choose_numbers(several *x)
{
  const thr_plan_options *o = x->o;
  for (int k = 0; k < x->n_components; k++) {
    int n = o->cords_least;
    if (o->ends == THR_ENDS_COUNTS) {
      n = counted_cords(x, k);
    } else if (thr_wants_balance(o)) {
      int room = most_cords(x, x->passes, k);
      n = room < n ? n : room < o->cords ? room : o->cords;
    }
    x->wanted[k] = n;
  }
}

/* ---- no cord longer than a limit ---- */

/* More and more cords: what is left to do. */
typedef struct {
  several *x;
  thr_shortest *best; /* certificates: of each component the one that rules out the most numbers of cords */
  double *length;     /* [n_components] of the shortest passes */
  bool *done;
} growing;

static void lengths_of(const several *x, const int *passes, double *length)
{
  memset(length, 0, (size_t)x->n_components * sizeof *length);
  for (int e = 0; e < x->f->n_edges; e++)
    length[component_of(x, e)] += passes[e] * x->f->length[e];
}

thr_status thr_cords_reach(const thr_frame *f, const thr_plan_options *o, thr_err *err)
{
  thr_ways w;
  bool closed = o->ends == THR_ENDS_CLOSED;
  double limit = o->max_length;
  thr_status st = thr_ways_init(&w, f, err);
  for (int v = 0; v < f->n_nodes && !st && !closed; v++)
    if (thr_plan_end_allowed(f, o, v)) st = thr_ways_start(&w, v, err);
  if (!st) st = thr_ways_spread(&w, o, NULL, 0, INFINITY, NULL, err);
  for (int e = 0; e < f->n_edges && !st; e++) {
    const int *end = f->edge[e];
    if (closed && within(2 * f->length[e], limit)) continue;
    if (closed) { /* there, and the shortest way back */
      thr_ways_clear(&w);
      st = thr_ways_start(&w, end[0], err);
      if (!st) st = thr_ways_spread(&w, o, NULL, 0, f->length[e], NULL, err);
      if (st) break;
    }
    double least = (closed ? 0 : w.far[end[0]]) + f->length[e] + w.far[end[1]];
    if (!within(least, limit))
      st = thr_fail(err, THR_EINFEASIBLE,
                    "no cord of at most %g %s can pass the edge between nodes %s and %s: %s over it takes %g %s", limit, f->units,
                    f->name[end[0]], f->name[end[1]],
                    closed ? "the shortest circuit" : "the shortest way between places where cords may end", least, f->units);
  }
  thr_ways_destroy(&w);
  return st;
}

/* Tries n cords in every component that may do with so few; *left: how many are still to be done. */
static thr_status try_number(growing *g, int n, int *left, thr_err *err)
{
  several *x = g->x;
  thr_plan_options o = *x->o;
  thr_shortest s;
  o.cords = n;
  thr_err why = {0};
  thr_status st = thr_postman_shortest(x->f, &o, x->limits, &s, &why);
  if (st == THR_EINFEASIBLE) return THR_OK; /* full edges make more cords end than n: the largest number was found possible */
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", why.text);
  lengths_of(x, s.passes, g->length);
  for (int e = 0; e < x->f->n_edges; e++)
    if (!g->done[component_of(x, e)]) x->passes[e] = s.passes[e];
  for (int k = 0; k < x->n_components; k++) {
    bool possible = g->length[k] <= n * x->o->max_length * (1 + 1e-9);
    x->wanted[k] = !g->done[k] && possible ? n : 0;
    if (g->done[k] || possible) continue;
    thr_certificate swap = g->best->certificate[k];
    g->best->certificate[k] = s.certificate[k];
    s.certificate[k] = swap;
  }
  st = share_out(x, s.certificate, true, x->o->max_length, err);
  *left = 0;
  for (int k = 0; k < x->n_components && !st; k++) {
    if (x->wanted[k]) g->done[k] = within(thr_walks_longest(&x->walks[k]), x->o->max_length);
    *left += !g->done[k];
  }
  thr_shortest_destroy(&s);
  return st;
}

static thr_status none_found(const growing *g, int most, thr_err *err)
{
  const several *x = g->x;
  int k = 0;
  while (g->done[k])
    k++;
  const char *cords = most == 1 ? "cord" : "cords", *units = x->f->units;
  double length = x->o->max_length, found = thr_walks_longest(&x->walks[k]);
  if (x->walks[k].n_walks == 0)
    return thr_fail(err, THR_EINFEASIBLE, "the component with node %s needs %g %s of cord: %d %s of at most %g %s are too few",
                    node_of(x, k), g->length[k], units, most, cords, length, units);
  return thr_fail(err, THR_EINFEASIBLE,
                  "the component with node %s: did not find %s%d %s with none longer than %g %s, but one of %g %s", node_of(x, k),
                  x->o->cords_least == most ? "" : "up to ", most, cords, length, units, found, units);
}

enum { IN_SINGLE_STEPS = 12 };

/* best holds the shortest passes with most cords, which are the shortest of all. */
static thr_status grow(several *x, thr_shortest *best, thr_err *err)
{
  growing g = {x, best, thr_calloc((size_t)x->n_components, sizeof *g.length),
               thr_calloc((size_t)x->n_components, sizeof *g.done)};
  int left = x->n_components, n = x->o->cords;
  thr_status st = g.length && g.done ? THR_OK : thr_nomem(err);
  if (!st) lengths_of(x, best->passes, g.length);
  for (int k = 0; k < x->n_components && !st; k++) {
    double least = ceil(g.length[k] / x->o->max_length * (1 - 1e-9));
    if (least < n) n = least > x->o->cords_least ? (int)least : x->o->cords_least;
  }
  if (!st && x->o->ends == THR_ENDS_COUNTS) n = x->o->cords;
  if (!st) st = thr_cords_reach(x->f, x->o, err);
  for (int tried = 0, step = 1; !st && left && n <= x->o->cords; n += step) { /* larger steps where many numbers are too small */
    st = try_number(&g, n, &left, err);
    if (++tried > IN_SINGLE_STEPS && n < x->o->cords) step = 2 * step < x->o->cords - n ? 2 * step : x->o->cords - n;
  }
  if (!st && left) st = none_found(&g, x->o->cords, err);
  free(g.length);
  free(g.done);
  return st;
}

/* ---- the plan ---- */

static thr_status make(several *x, thr_shortest *s, thr_err *err)
{
  memcpy(x->passes, s->passes, (size_t)x->f->n_edges * sizeof *x->passes);
  if (x->o->max_length > 0) return grow(x, s, err);
  choose_numbers(x);
  return share_out(x, s->certificate, thr_wants_balance(x->o), 0, err);
}

thr_status thr_cords_judge(const thr_plan *plan, const thr_err *unproved, thr_err *err)
{
  const thr_plan_options *o = &plan->options;
  const thr_cords_claim *c = &plan->cords_claim;
  const char *why = unproved->code ? unproved->text : "", *colon = unproved->code ? ": " : "";
  if (thr_wants_balance(o) && !c->longest_optimal)
    return thr_fail(err, THR_ELIMIT, "%s%sthe longest cord is proved to be within %.3g %% of the shortest possible", why, colon,
                    100 * (c->longest - c->longest_bound) / c->longest);
  if (!thr_wants_balance(o) && o->max_length > 0 && c->fewest && !c->fewest_optimal)
    return thr_fail(err, THR_ELIMIT, "%s%sat least %d cords are needed; these are %d", why, colon, c->fewest, plan->n_cords);
  if (thr_wants_balance(o) || (o->max_length > 0 && c->fewest) || plan->proof.optimal) return THR_OK;
  return thr_fail(err, THR_ELIMIT, "%s%sthe cords are proved to be within %.3g %% of the shortest", why, colon,
                  100 * plan->proof.gap);
}

/* Where the cords need more passes than a join has, what proves more of that. */
static thr_status prove_places(const several *x, thr_plan *plan, thr_err *err)
{
  const thr_frame *f = &plan->frame;
  thr_length_proof *proof = &plan->proof;
  thr_err found = {0};
  thr_status st = THR_OK;
  if (proof->optimal) return THR_OK;
  for (int k = 0; k < proof->n_certificates && !st; k++) {
    st = thr_share_prices(&x->share, k, x->limits, &proof->certificate[k], err);
    proof->unconfirmed += proof->certificate[k].n_prices > 0; /* GLPK was asked about other passes */
  }
  if (st) return st;
  st = thr_check_length_proof(f, &plan->options, plan->cord, plan->n_cords, proof->certificate, proof->n_certificates,
                              &proof->optimal, &proof->lower_bound, &found);
  proof->gap = (plan->metrics.length - proof->lower_bound) / plan->metrics.length;
  return thr_postman_own_check(st, &found, err);
}

static thr_status prove(const several *x, thr_plan *plan, thr_shortest *s, thr_err *err)
{
  const thr_frame *f = &plan->frame;
  const thr_plan_options *o = &plan->options;
  thr_status st = thr_plan_measure(f, o, plan->cord, plan->n_cords, &plan->metrics, err);
  if (!st) st = thr_postman_prove(f, o, plan->cord, plan->n_cords, s, &plan->proof, err);
  if (!st) st = prove_places(x, plan, err);
  if (!st)
    st = thr_check_cords(f, o, plan->cord, plan->n_cords, plan->proof.certificate, plan->proof.n_certificates, &plan->cords_claim,
                         err);
  return st;
}

typedef struct {
  several *x;
  thr_shortest *shortest; /* whose certificates become those of the components */
} by_component;

/* One component by itself: it may need more cords than another, or hold fewer. */
static thr_status plan_component(void *user, const thr_components *p, int k, const thr_plan *asked, thr_plan *made, thr_err *err)
{
  const by_component *b = user;
  thr_limits quiet = *b->x->limits;
  thr_cords_word word = {0};
  thr_err why = {0};
  quiet.found = NULL; /* cords of a component are no plan */
  thr_status st = thr_cords_plan(&asked->frame, &asked->options, &quiet, made, &word, &why);
  b->x->least &= word.passes_least;
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", why.text);
  thr_component_give_certificate(p, k, made, &b->shortest->certificate[k]);
  return THR_OK;
}

static thr_status plan_components(several *x, thr_shortest *s, thr_plan *plan, thr_err *err)
{
  return thr_components_plan(x->f, x->o, plan_component, &(by_component){x, s}, plan, err);
}

static thr_status plan_all(several *x, thr_shortest *s, thr_plan *plan, thr_err *err)
{
  if (x->o->max_length > 0 && x->n_components > 1) return plan_components(x, s, plan, err);
  thr_status st = make(x, s, err);
  return st ? st : thr_walks_plan(x->walks, x->n_components, plan, err);
}

thr_status thr_cords_plan(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *plan,
                          thr_cords_word *word, thr_err *err)
{
  thr_shortest s = {0};
  thr_err why = {0};
  several x = {.limits = limits};
  *plan = (thr_plan){0};
  if (word) *word = (thr_cords_word){0};
  bool one = o->cords == 1 && o->max_length == 0 && o->ends != THR_ENDS_COUNTS;
  if (one) return thr_postman_plan(f, o, limits, plan, err);
  thr_status proved = thr_postman_shortest(f, o, limits, &s, &why);
  if (proved && proved != THR_ELIMIT) return thr_fail(err, proved, "%s", why.text);
  thr_status st = thr_plan_request(plan, f, o, err);
  x.f = &plan->frame;
  x.o = &plan->options;
  if (!st) st = several_init(&x, err);
  if (!st) st = plan_all(&x, &s, plan, err);
  if (!st) st = prove(&x, plan, &s, err);
  if (word) *word = (thr_cords_word){x.least, x.certain && thr_wants_balance(o)};
  if (st)
    thr_plan_destroy(plan);
  else
    st = thr_cords_judge(plan, &why, err);
  several_destroy(&x);
  thr_shortest_destroy(&s);
  return st;
}
