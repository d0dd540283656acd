/* Exchanges between cords. */
#include "tortuosity/maxturn.h"
#include "graph/random.h"
#include "tortuosity/circuits.h"
#include "tortuosity/extra.h"
#include "tortuosity/improve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POWER = 8 };

/* A place on a cord: arriving by dart in, leaving by dart out; number i of cord k. before = price of the turns ahead of it. */
typedef struct {
  int cord, index, in, out;
  double before, price;
} place;

typedef struct {
  thr_join *j;
  int n_cords, n_places;
  int *first;    /* [n_cords + 1] places of cord k: place[first[k] .. first[k + 1] - 1] */
  place *place;  /* in order along the cords */
  int *at;       /* [n_darts] place that the dart is part of, -1 at end nodes */
  double *total; /* [n_cords] */
  double scale;  /* a total that counts as 1 */
  bool closed;
  int n_transitions; /* of all cords */
  uint64_t state;    /* of the random numbers */
} cords;

static void cords_destroy(cords *s)
{
  free(s->first);
  free(s->place);
  free(s->at);
  free(s->total);
}

static thr_status cords_init(cords *s, thr_join *j, double scale, thr_err *err)
{
  const thr_turning_columns *c = j->c;
  size_t darts = (size_t)j->g.n_darts, n = (size_t)c->task->cords * (size_t)c->n_components;
  *s = (cords){.j = j, .n_cords = (int)n, .scale = scale, .closed = !c->task->end_allowed, .state = 1};
  s->first = thr_calloc(n + 1, sizeof *s->first);
  s->place = thr_calloc(darts, sizeof *s->place);
  s->at = thr_calloc(darts, sizeof *s->at);
  s->total = thr_calloc(n, sizeof *s->total);
  s->n_transitions = j->g.first[c->f->n_nodes] / 2;
  return s->first && s->place && s->at && s->total ? THR_OK : thr_nomem(err);
}

static void follow(cords *s, int cord, int start)
{
  const thr_join *j = s->j;
  double sum = 0;
  int d = start;
  s->first[cord] = s->n_places;
  for (; j->mate[d ^ 1] >= 0; d = j->mate[d ^ 1]) {
    place *p = &s->place[s->n_places];
    *p = (place){cord, s->n_places - s->first[cord], d ^ 1, j->mate[d ^ 1], sum, thr_join_price(j, d ^ 1, j->mate[d ^ 1])};
    s->at[p->in] = s->at[p->out] = s->n_places++;
    sum += p->price;
    if (p->out == start) break;
  }
  if (j->mate[d ^ 1] < 0) s->at[d ^ 1] = -2; /* the far end: this cord is followed */
  s->total[cord] = sum;
}

/* All places from the pairs. false: there are circuits that are no cords, or not as many cords. */
static bool follow_all(cords *s)
{
  const thr_multigraph *g = &s->j->g;
  int cord = 0;
  s->n_places = 0;
  for (int d = 0; d < g->n_darts; d++)
    s->at[d] = -1;
  for (int d = 0; d < g->n_darts && s->closed; d++) {
    if (s->at[d] >= 0) continue;
    if (cord == s->n_cords) return false;
    follow(s, cord++, d);
  }
  for (int i = g->first[s->j->c->f->n_nodes]; i < g->first[g->n_nodes]; i++)
    if (s->at[g->dart[i]] != -2) follow(s, cord++, g->dart[i]);
  s->first[cord] = s->n_places;
  return cord == s->n_cords && s->n_places == s->n_transitions;
}

static double power(const cords *s, double total)
{
  return pow(total / s->scale, POWER);
}

static void pair(cords *s, int a, int b)
{
  s->j->mate[a] = b;
  s->j->mate[b] = a;
}

/* Price of the turns after place p on its cord. */
static double after(const cords *s, const place *p)
{
  return s->total[p->cord] - p->before - p->price;
}

/* Do the new totals of two cords weigh less than the old? */
static bool better(const cords *s, int k, int l, double new_k, double new_l)
{
  return power(s, new_k) + power(s, new_l) < (power(s, s->total[k]) + power(s, s->total[l])) * (1 - 1e-9);
}

/* Two cords at one node change tails, or one takes the other's head turned round. */
static bool change_tails(cords *s, const place *p, const place *q)
{
  double tails[2] = {thr_join_price(s->j, p->in, q->out), thr_join_price(s->j, q->in, p->out)};
  if (better(s, p->cord, q->cord, p->before + tails[0] + after(s, q), q->before + tails[1] + after(s, p))) {
    pair(s, p->in, q->out);
    pair(s, q->in, p->out);
    return true;
  }
  double heads[2] = {thr_join_price(s->j, p->in, q->in), thr_join_price(s->j, p->out, q->out)};
  if (!better(s, p->cord, q->cord, p->before + heads[0] + q->before, after(s, p) + heads[1] + after(s, q))) return false;
  pair(s, p->in, q->in);
  pair(s, p->out, q->out);
  return true;
}

static bool run_backwards(cords *s, const place *p, const place *q)
{
  double now = thr_join_price(s->j, p->in, q->in) + thr_join_price(s->j, p->out, q->out);
  if (now >= p->price + q->price - 1e-9) return false;
  pair(s, p->in, q->in);
  pair(s, p->out, q->out);
  return true;
}

/* The part between p and q (of one cord, p first) as a circuit, joined to another cord where they meet. */
static bool hand_over(cords *s, const place *p, const place *q)
{
  const thr_multigraph *g = &s->j->g;
  int k = p->cord;
  double closing = thr_join_price(s->j, q->in, p->out), shortcut = thr_join_price(s->j, p->in, q->out);
  double part = q->before - p->before - p->price + closing, rest = s->total[k] - part + closing - p->price - q->price + shortcut;
  if (rest >= s->total[k]) return false;
  for (int x = s->first[k] + p->index + 1; x < s->first[k] + q->index; x++) {
    const place *m = &s->place[x];
    int v = g->tail[m->in];
    for (int i = g->first[v]; i < g->first[v + 1]; i++) {
      const place *z = &s->place[s->at[g->dart[i]]];
      if (z->cord == k || z->in != g->dart[i]) continue;
      double base = s->total[z->cord] - z->price + part - m->price;
      double same = thr_join_price(s->j, z->in, m->out) + thr_join_price(s->j, m->in, z->out);
      double turned = thr_join_price(s->j, z->in, m->in) + thr_join_price(s->j, m->out, z->out);
      if (!better(s, k, z->cord, rest, base + fmin(same, turned))) continue;
      int z_in = z->in, z_out = z->out, m_in = m->in, m_out = m->out;
      pair(s, q->in, p->out);
      pair(s, p->in, q->out);
      pair(s, z_in, same <= turned ? m_out : m_in);
      pair(s, z_out, same <= turned ? m_in : m_out);
      return true;
    }
  }
  return false;
}

/* One exchange at node v. */
static bool exchange_at(cords *s, int v)
{
  const thr_multigraph *g = &s->j->g;
  for (int i = g->first[v]; i < g->first[v + 1]; i++)
    for (int k = i + 1; k < g->first[v + 1]; k++) {
      const place *p = &s->place[s->at[g->dart[i]]], *q = &s->place[s->at[g->dart[k]]];
      if (p == q || p->in != g->dart[i] || q->in != g->dart[k]) continue;
      if (p->cord != q->cord) {
        if (!s->closed && change_tails(s, p, q)) return true;
        continue;
      }
      if (p->index > q->index) {
        const place *later = p;
        p = q;
        q = later;
      }
      if (run_backwards(s, p, q) || hand_over(s, p, q)) return true;
    }
  return false;
}

static void exchange_all(cords *s, const thr_limits *limits)
{
  const thr_turning_columns *c = s->j->c;
  for (bool changed = true; changed && !thr_limits_stop(limits);) {
    changed = false;
    for (int v = 0; v < c->f->n_nodes && !thr_limits_stop(limits); v++)
      while (exchange_at(s, v)) {
        changed = true;
        follow_all(s);
      }
  }
}

static double largest_of(const double *total, int n)
{
  double largest = 0;
  for (int k = 0; k < n; k++)
    largest = fmax(largest, total[k]);
  return largest;
}

static int random_below(uint64_t *state, int n)
{
  return (int)(thr_random(state) % (uint64_t)n);
}

static double random_unit(uint64_t *state)
{
  return ldexp((double)(thr_random(state) >> 11), -53);
}

static double sum_of_powers(const cords *s)
{
  double sum = 0;
  for (int k = 0; k < s->n_cords; k++)
    sum += power(s, s->total[k]);
  return sum;
}

/* ---- annealing ---- */

/* Pairs that a trial has broken up. */
typedef struct {
  int n, pair[4][2];
} trail;

static void take_back(cords *s, const trail *t)
{
  for (int i = t->n - 1; i >= 0; i--)
    pair(s, t->pair[i][0], t->pair[i][1]);
}

/* Pairs the darts of two places anew: arriving with leaving, or arriving with arriving (crossed). */
static bool exchange(cords *s, trail *t, const place *p, const place *q, bool crossed)
{
  int c = crossed ? q->in : q->out, d = crossed ? q->out : q->in;
  if (thr_join_price(s->j, p->in, c) + thr_join_price(s->j, p->out, d) >= thr_join_forbidden) return false;
  t->pair[t->n][0] = p->in;
  t->pair[t->n++][1] = p->out;
  t->pair[t->n][0] = q->in;
  t->pair[t->n++][1] = q->out;
  pair(s, p->in, c);
  pair(s, p->out, d);
  return true;
}

/* A place at the same node as place i, or -1. */
static int other_at_node(cords *s, int i)
{
  const thr_multigraph *g = &s->j->g;
  int v = g->tail[s->place[i].in], n = g->first[v + 1] - g->first[v];
  int k = s->at[g->dart[g->first[v] + random_below(&s->state, n)]];
  return k == i ? -1 : k;
}

/* Two cords joined into one circuit are cut apart again somewhere else, and a part that an exchange cuts off one cord is joined
 * to another cord or elsewhere. false: nothing found. */
static bool put_right(cords *s, trail *t, const place *p, const place *q)
{
  enum { TRIES = 8 };
  bool joined = p->cord != q->cord;
  for (int tries = 0; tries < TRIES; tries++) {
    int from = p->index, to = q->index, cord = p->cord, i, k;
    if (joined) cord = random_below(&s->state, 2) ? p->cord : q->cord, from = -1, to = s->first[cord + 1] - s->first[cord];
    if (to - from < 2) return false;
    i = s->first[cord] + from + 1 + random_below(&s->state, to - from - 1);
    k = other_at_node(s, i);
    const place *m = &s->place[i], *z = k < 0 ? NULL : &s->place[k];
    if (!z || m == p || m == q || z == p || z == q) continue;
    if (joined ? z->cord != p->cord && z->cord != q->cord : z->cord == cord && z->index > from && z->index < to) continue;
    if (exchange(s, t, m, z, joined ? m->cord != z->cord && random_below(&s->state, 2) : random_below(&s->state, 2))) return true;
  }
  return false;
}

/* A change at random that keeps the number of cords, if *t is not empty and follow_all says so. */
static void propose(cords *s, trail *t)
{
  int i = random_below(&s->state, s->n_places), k = other_at_node(s, i);
  t->n = 0;
  if (k < 0) return;
  const place *p = &s->place[i], *q = &s->place[k];
  if (p->cord == q->cord && p->index > q->index) {
    const place *later = p;
    p = q;
    q = later;
  }
  bool crossed = random_below(&s->state, 2);
  if (!exchange(s, t, p, q, crossed)) return;
  bool same = p->cord == q->cord;
  if (same ? crossed : !s->closed) return;
  if (put_right(s, t, p, q)) return;
  take_back(s, t);
  t->n = 0;
}

/* Takes changes at random that make the norm of the totals less, or with falling probability more. Keeps the best in mate. */
static void anneal(cords *s, const thr_limits *limits, int steps, double bound, int *best)
{
  static const double hot = 0.05, cold = 0.002; /* of the norm */
  size_t bytes = (size_t)s->j->g.n_darts * sizeof *best;
  double now = sum_of_powers(s), least = now;
  memcpy(best, s->j->mate, bytes);
  for (int i = 0; i < steps && s->n_places > 1; i++) {
    trail t;
    if (i % 64 == 0 && (thr_limits_stop(limits) || largest_of(s->total, s->n_cords) <= bound * (1 + 1e-9))) break;
    double heat = hot * pow(cold / hot, (double)i / steps);
    propose(s, &t);
    if (t.n == 0) continue;
    bool whole = follow_all(s);
    double next = whole ? sum_of_powers(s) : (double)INFINITY;
    if (next <= now || random_unit(&s->state) < exp(-log(next / now) / POWER / heat)) {
      now = next;
      if (now >= least * (1 - 1e-12)) continue;
      least = now;
      memcpy(best, s->j->mate, bytes);
    } else {
      take_back(s, &t);
      follow_all(s);
    }
  }
  memcpy(s->j->mate, best, bytes);
  follow_all(s);
}

/* ---- starts ---- */

typedef struct {
  const thr_turning_columns *c;
  const thr_limits *limits;
  double bound, scale;
  thr_join best;
  double value; /* of best: the sum of the powers */
  int *passes, *ends;
  double *weight;
  uint64_t state;
} search;

/* Exchanges and annealing from j, which becomes the best or is released. */
static thr_status improve_from(search *x, thr_join *j, int steps, thr_err *err)
{
  cords s;
  int *best = thr_calloc((size_t)j->g.n_darts, sizeof *best);
  thr_status st = cords_init(&s, j, x->scale, err);
  if (!st && !best) st = thr_nomem(err);
  if (!st && follow_all(&s)) {
    s.state = thr_random(&x->state);
    exchange_all(&s, x->limits);
    anneal(&s, x->limits, s.n_cords > 1 ? steps : 0, x->bound, best);
    exchange_all(&s, x->limits);
    double value = sum_of_powers(&s);
    if (value < x->value * (1 - 1e-12)) {
      thr_join_destroy(&x->best);
      x->best = *j;
      *j = (thr_join){0};
      x->value = value;
    }
  }
  cords_destroy(&s);
  free(best);
  thr_join_destroy(j);
  return st;
}

/* The ends of the best cords; one of them moves to another node where it may be, or two to the same one. */
static void move_ends(search *x)
{
  const thr_turning_columns *c = x->c;
  const thr_multigraph *g = &x->best.g;
  int n = c->f->n_nodes, virtual_darts = g->n_darts - g->first[n], to = -1, moves = 1 + random_below(&x->state, 2);
  memset(x->ends, 0, (size_t)n * sizeof *x->ends);
  for (int d = 0; d < g->n_darts; d += 2)
    if (g->half[d] < 0) x->ends[g->tail[d]]++;
  for (int i = 0; i < moves; i++) {
    int end = g->tail[g->dart[g->first[n] + random_below(&x->state, virtual_darts)] ^ 1];
    while (to < 0 || !c->task->end_allowed[to] || (i == 0 && c->component[to] != c->component[end]))
      to = random_below(&x->state, n);
    if (x->ends[end] == 0 || c->component[to] != c->component[end]) continue;
    x->ends[end]--;
    x->ends[to]++;
  }
}

/* Ends far apart, over all nodes where they may be or, if that is allowed, over the feet alone: often a symmetric choice. */
static void spread_ends(search *x, bool at_feet)
{
  const thr_frame *f = x->c->f;
  thr_turning_task task = *x->c->task;
  thr_turning_columns c = *x->c; /* with the other task, nothing more */
  int total = 0;
  for (int v = 0; v < f->n_nodes; v++)
    at_feet &= !f->foot[v] || task.end_allowed[v];
  if (at_feet) task.end_allowed = f->foot;
  c.task = &task;
  thr_extra_spread_ends(&c, x->ends);
  for (int v = 0; v < f->n_nodes; v++)
    total += x->ends[v];
  if (total < 2 * task.cords * c.n_components) thr_extra_spread_ends(x->c, x->ends); /* a component without feet */
}

/* Cords for these passes and ends, to start from. */
static thr_status make_cords(const search *x, thr_join *j, bool *found, thr_err *err)
{
  const thr_turning_task *t = x->c->task;
  thr_status st = thr_join_init(j, x->c, x->passes, t->end_allowed ? x->ends : NULL, err);
  *found = false;
  if (st) return st;
  st = thr_join_greedy(j, t->end_allowed ? 0 : t->cords - 1, err);
  if (!st) st = t->end_allowed ? thr_improve(j, x->limits, err) : thr_circuits_make(j, x->limits, found, err);
  *found = !st && (t->end_allowed || *found) && j->price < thr_join_forbidden;
  return st;
}

/* New cords for x->ends, over the shortest passes or nearly. */
static thr_status try_passes(search *x, bool shortest, int steps, thr_err *err)
{
  const thr_turning_columns *c = x->c;
  const thr_turning_task *t = c->task;
  thr_join j;
  bool found;
  for (int e = 0; e < c->f->n_edges; e++)
    x->weight[e] = c->f->length[e] * (shortest ? 1 : 1 + random_unit(&x->state));
  thr_status st = thr_extra_passes(c, x->weight, NULL, t->end_allowed != NULL, x->limits, x->passes, x->ends, err);
  if (st) return st;
  for (int e = 0; e < c->f->n_edges; e++)
    if (x->passes[e] > x->c->most[e]) return THR_OK;
  if (t->extra_limit >= 0 && thr_extra_length(c, x->passes) > t->extra_limit) return THR_OK;
  st = make_cords(x, &j, &found, err);
  if (found) return improve_from(x, &j, steps, err);
  thr_join_destroy(&j);
  return st;
}

static bool finished(const search *x, const cords *s)
{
  return thr_limits_stop(x->limits) || largest_of(s->total, s->n_cords) <= x->bound * (1 + 1e-9);
}

/* Is there nothing left to try? */
static thr_status is_finished(const search *x, bool *done, thr_err *err)
{
  cords s;
  thr_join j = x->best; /* only followed */
  thr_status st = cords_init(&s, &j, x->scale, err);
  if (!st) follow_all(&s);
  *done = st || s.n_cords == 1 || finished(x, &s);
  cords_destroy(&s);
  return st;
}

/* Copies the best, to go on from it. */
static thr_status copy_best(const search *x, thr_join *j, thr_err *err)
{
  thr_cord *cord = NULL;
  int n = x->c->task->cords * x->c->n_components;
  *j = (thr_join){0};
  if (!(cord = thr_calloc((size_t)n, sizeof *cord))) return thr_nomem(err);
  thr_status st = thr_join_cords(&x->best, cord, n, err);
  if (!st) st = thr_join_from_cords(j, x->c, cord, n, err);
  thr_cords_destroy(cord, n);
  return st;
}

/* From the plan itself; from other ends; and from the best of all these once more. Counted, not timed, so that the same input
 * gives the same cords. */
static thr_status run(search *x, thr_err *err)
{
  enum { ROUNDS = 48, LAST = 2 };
  const thr_turning_columns *c = x->c;
  double darts = x->best.g.n_darts;
  int steps = (int)fmax(2000, fmin(1000 * darts, 4e7 / darts));
  bool done = false;
  thr_join j;
  thr_status st = copy_best(x, &j, err);
  if (!st) st = improve_from(x, &j, steps, err);
  if (!st) st = is_finished(x, &done, err);
  for (int i = 0; i < ROUNDS && !st && !done; i++) {
    if (c->task->end_allowed) {
      if (i < 2)
        spread_ends(x, i == 0);
      else
        move_ends(x);
    }
    st = try_passes(x, i % 2 == 0 || i < 2, steps / ROUNDS * 2, err);
    if (!st) st = is_finished(x, &done, err);
  }
  for (int i = 0; i < LAST && !st && !done; i++) {
    st = copy_best(x, &j, err);
    if (!st) st = improve_from(x, &j, steps, err);
    if (!st) st = is_finished(x, &done, err);
  }
  return st;
}

/* The cords of j take the place of the plan's. */
static thr_status take_cords(const thr_frame *f, const thr_join *j, thr_least *plan, thr_err *err)
{
  thr_least made = {.task = plan->task, .end_allowed = plan->end_allowed};
  thr_status st = thr_least_cords(f, j, &made, err);
  if (st) {
    free(made.cord);
    return st;
  }
  thr_cords_destroy(plan->cord, plan->n_cords);
  plan->cord = made.cord;
  plan->length = made.length;
  plan->price = made.price;
  plan->turning = made.turning;
  thr_least_judge(plan, plan->open ? plan->open : "cords that turn most evenly may turn more together");
  return THR_OK;
}

static double price_of(const thr_frame *f, const thr_least *plan, const thr_cord *cord)
{
  double price = 0;
  for (int k = 0; k < cord->n_passes - (plan->end_allowed != NULL); k++)
    price += thr_turn_price(f, plan->task.cost, cord->half[k], cord->half[(k + 1) % cord->n_passes]);
  return price;
}

static double largest_price(const thr_frame *f, const thr_least *plan)
{
  double largest = 0;
  for (int i = 0; i < plan->n_cords; i++)
    largest = fmax(largest, price_of(f, plan, &plan->cord[i]));
  return largest;
}

static thr_status search_init(search *x, const thr_turning_columns *c, const thr_limits *limits, const thr_least *plan,
                              double largest, double bound, thr_err *err)
{
  size_t m = (size_t)c->f->n_edges;
  *x = (search){.c = c, .limits = limits, .bound = bound, .scale = fmax(1e-9, largest), .value = INFINITY, .state = 1};
  x->passes = thr_calloc(m, sizeof *x->passes);
  x->weight = thr_calloc(m, sizeof *x->weight);
  x->ends = thr_calloc((size_t)c->f->n_nodes, sizeof *x->ends);
  if (!x->passes || !x->weight || !x->ends) return thr_nomem(err);
  return thr_join_from_cords(&x->best, c, plan->cord, plan->n_cords, err);
}

static void search_destroy(search *x)
{
  thr_join_destroy(&x->best);
  free(x->passes);
  free(x->weight);
  free(x->ends);
}

thr_status thr_max_turning_improve(const thr_frame *f, const thr_limits *limits, thr_least *plan, thr_max_turning *out,
                                   thr_err *err)
{
  thr_turning_columns c = {0};
  search x = {0};
  *out = (thr_max_turning){.bound = plan->bound / plan->n_cords};
  thr_status st = thr_turning_columns_init(&c, f, &plan->task, err);
  if (!st) st = search_init(&x, &c, limits, plan, largest_price(f, plan), out->bound, err);
  if (!st) st = run(&x, err);
  if (!st) {
    thr_join_measure(&x.best);
    st = take_cords(f, &x.best, plan, err);
  }
  if (!st) out->largest = largest_price(f, plan);
  search_destroy(&x);
  thr_turning_columns_destroy(&c);
  return st;
}
