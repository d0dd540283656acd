/* Exchanges at one node or two: by descent, and by simulated annealing. */
#include "tortuosity/cords/maxturn_exchange.h"
#include "graph/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POWER = 8 };

void thr_evener_destroy(thr_evener *s)
{
  free(s->first);
  free(s->place);
  free(s->at);
  free(s->parent);
  free(s->total);
}

thr_status thr_evener_init(thr_evener *s, thr_join *j, double scale, thr_err *err)
{
  const thr_turning_columns *c = j->c;
  size_t darts = (size_t)j->g.n_darts, n = (size_t)thr_join_count(j);
  *s = (thr_evener){.j = j, .n_cords = (int)n, .scale = scale, .closed = !c->task->end_allowed, .state = 1};
  s->first = thr_calloc(n + 1, sizeof *s->first);
  s->place = thr_calloc(darts, sizeof *s->place);
  s->at = thr_calloc(darts, sizeof *s->at);
  s->parent = thr_calloc((size_t)c->f->n_edges, sizeof *s->parent);
  s->total = thr_calloc(n, sizeof *s->total);
  s->n_transitions = j->g.first[c->f->n_nodes] / 2;
  return s->first && s->place && s->at && s->parent && s->total ? THR_OK : thr_nomem(err);
}

static void follow(thr_evener *s, int cord, int start)
{
  const thr_join *j = s->j;
  double sum = 0;
  int d = start;
  s->first[cord] = s->n_places;
  for (; j->mate[d ^ 1] >= 0; d = j->mate[d ^ 1]) {
    thr_place *p = &s->place[s->n_places];
    *p = (thr_place){cord, s->n_places - s->first[cord], d ^ 1, j->mate[d ^ 1], sum, thr_join_price(j, d ^ 1, j->mate[d ^ 1])};
    s->at[p->in] = s->at[p->out] = s->n_places++;
    sum += p->price;
    if (p->out == start) break;
  }
  if (j->mate[d ^ 1] < 0) s->at[d ^ 1] = -2; /* the far end: this cord is followed */
  s->total[cord] = sum;
}

bool thr_evener_follow(thr_evener *s)
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

static double power(const thr_evener *s, double total)
{
  return pow(total / s->scale, POWER);
}

double thr_evener_value(const thr_evener *s)
{
  double sum = 0;
  for (int k = 0; k < s->n_cords; k++)
    sum += power(s, s->total[k]);
  return sum;
}

double thr_evener_largest(const thr_evener *s)
{
  double largest = 0;
  for (int k = 0; k < s->n_cords; k++)
    largest = fmax(largest, s->total[k]);
  return largest;
}

/* ---- pairs changed, and taken back ---- */

/* Pairs that an exchange has broken up. */
typedef struct {
  int n, pair[4][2];
} trail;

static void pair(thr_evener *s, int a, int b)
{
  s->j->mate[a] = b;
  s->j->mate[b] = a;
}

static void take_back(thr_evener *s, trail *t)
{
  while (t->n > 0) {
    t->n--;
    pair(s, t->pair[t->n][0], t->pair[t->n][1]);
  }
}

/* Pairs a with b and c with d, which were paired otherwise. */
static void pair_anew(thr_evener *s, trail *t, int a, int b, int c, int d)
{
  const int *mate = s->j->mate;
  t->pair[t->n][0] = a;
  t->pair[t->n++][1] = mate[a];
  t->pair[t->n][0] = b;
  t->pair[t->n++][1] = mate[b];
  pair(s, a, b);
  pair(s, c, d);
}

/* Are the nodes of the trail tied, if they must be? */
static bool is_tied(const thr_evener *s, const trail *t)
{
  for (int i = 0; i < t->n && s->j->c->task->tube; i += 2)
    if (!thr_join_tied(s->j, s->j->g.tail[t->pair[i][0]], s->parent)) return false;
  return true;
}

/* Takes the trail back unless it leaves its nodes tied. */
static bool keep_if_tied(thr_evener *s, trail *t)
{
  bool tied = is_tied(s, t);
  if (!tied) take_back(s, t);
  return tied;
}

/* ---- descent ---- */

/* Price of the turns after place p on its cord. */
static double after(const thr_evener *s, const thr_place *p)
{
  return s->total[p->cord] - p->before - p->price;
}

/* Do the new totals of two cords weigh less than the old? */
static bool better(const thr_evener *s, int k, int l, double new_k, double new_l)
{
  return power(s, new_k) + power(s, new_l) < (power(s, s->total[k]) + power(s, s->total[l])) * (1 - 1e-9);
}

/* Two cords at one node change tails, or one takes the other's head turned round. */
static bool change_tails(thr_evener *s, const thr_place *p, const thr_place *q)
{
  trail t = {0};
  const double tails[2] = {thr_join_price(s->j, p->in, q->out), thr_join_price(s->j, q->in, p->out)};
  if (better(s, p->cord, q->cord, p->before + tails[0] + after(s, q), q->before + tails[1] + after(s, p))) {
    pair_anew(s, &t, p->in, q->out, q->in, p->out);
    if (keep_if_tied(s, &t)) return true;
  }
  const double heads[2] = {thr_join_price(s->j, p->in, q->in), thr_join_price(s->j, p->out, q->out)};
  if (!better(s, p->cord, q->cord, p->before + heads[0] + q->before, after(s, p) + heads[1] + after(s, q))) return false;
  pair_anew(s, &t, p->in, q->in, p->out, q->out);
  return keep_if_tied(s, &t);
}

static bool run_backwards(thr_evener *s, const thr_place *p, const thr_place *q)
{
  trail t = {0};
  double now = thr_join_price(s->j, p->in, q->in) + thr_join_price(s->j, p->out, q->out);
  if (now >= p->price + q->price - 1e-9) return false;
  pair_anew(s, &t, p->in, q->in, p->out, q->out);
  return keep_if_tied(s, &t);
}

/* The part between p and q (of one cord, p first) as a circuit, joined to another cord where they meet. */
static bool hand_over(thr_evener *s, const thr_place *p, const thr_place *q)
{
  const thr_multigraph *g = &s->j->g;
  int k = p->cord;
  double closing = thr_join_price(s->j, q->in, p->out), shortcut = thr_join_price(s->j, p->in, q->out);
  double part = q->before - p->before - p->price + closing, rest = s->total[k] - part + closing - p->price - q->price + shortcut;
  if (rest >= s->total[k]) return false;
  for (int x = s->first[k] + p->index + 1; x < s->first[k] + q->index; x++) {
    const thr_place *m = &s->place[x];
    int v = g->tail[m->in];
    for (int i = g->first[v]; i < g->first[v + 1]; i++) {
      const thr_place *z = &s->place[s->at[g->dart[i]]];
      trail t = {0};
      if (z->cord == k || z->in != g->dart[i]) continue;
      double base = s->total[z->cord] - z->price + part - m->price;
      double same = thr_join_price(s->j, z->in, m->out) + thr_join_price(s->j, m->in, z->out);
      double turned = thr_join_price(s->j, z->in, m->in) + thr_join_price(s->j, m->out, z->out);
      if (!better(s, k, z->cord, rest, base + fmin(same, turned))) continue;
      pair_anew(s, &t, q->in, p->out, p->in, q->out);
      pair_anew(s, &t, z->in, same <= turned ? m->out : m->in, z->out, same <= turned ? m->in : m->out);
      if (keep_if_tied(s, &t)) return true;
    }
  }
  return false;
}

/* One exchange at node v. */
static bool exchange_at(thr_evener *s, int v, const thr_limits *limits)
{
  const thr_multigraph *g = &s->j->g;
  for (int i = g->first[v]; i < g->first[v + 1] && !thr_limits_stop(limits); i++)
    for (int k = i + 1; k < g->first[v + 1]; k++) {
      const thr_place *p = &s->place[s->at[g->dart[i]]], *q = &s->place[s->at[g->dart[k]]];
      if (p == q || p->in != g->dart[i] || q->in != g->dart[k]) continue;
      if (p->cord != q->cord) {
        if (!s->closed && change_tails(s, p, q)) return true;
        continue;
      }
      if (p->index > q->index) {
        const thr_place *later = p;
        p = q;
        q = later;
      }
      if (run_backwards(s, p, q) || hand_over(s, p, q)) return true;
    }
  return false;
}

void thr_evener_even(thr_evener *s, const thr_limits *limits)
{
  const thr_turning_columns *c = s->j->c;
  for (bool changed = true; changed && !thr_limits_stop(limits);) {
    changed = false;
    for (int v = 0; v < c->f->n_nodes && !thr_limits_stop(limits); v++)
      while (exchange_at(s, v, limits)) {
        changed = true;
        thr_evener_follow(s);
      }
  }
}

/* ---- annealing ---- */

/* Pairs the darts of two places anew: arriving with leaving, or arriving with arriving (crossed). */
static bool exchange(thr_evener *s, trail *t, const thr_place *p, const thr_place *q, bool crossed)
{
  int c = crossed ? q->in : q->out, d = crossed ? q->out : q->in;
  if (thr_join_price(s->j, p->in, c) + thr_join_price(s->j, p->out, d) >= thr_join_forbidden) return false;
  pair_anew(s, t, p->in, c, p->out, d);
  return true;
}

/* A place at the same node as place i, or -1. */
static int other_at_node(thr_evener *s, int i)
{
  const thr_multigraph *g = &s->j->g;
  int v = g->tail[s->place[i].in], n = g->first[v + 1] - g->first[v];
  int k = s->at[g->dart[g->first[v] + thr_random_below(&s->state, n)]];
  return k == i ? -1 : k;
}

/* Two cords joined into one circuit are cut apart again somewhere else, and a part that an exchange cuts off one cord is joined
 * to another cord or elsewhere. false: nothing found. */
static bool put_right(thr_evener *s, trail *t, const thr_place *p, const thr_place *q)
{
  enum { TRIES = 8 };
  bool joined = p->cord != q->cord;
  for (int tries = 0; tries < TRIES; tries++) {
    int from = p->index, to = q->index, cord = p->cord, i, k;
    if (joined) cord = thr_random_below(&s->state, 2) ? p->cord : q->cord, from = -1, to = s->first[cord + 1] - s->first[cord];
    if (to - from < 2) return false;
    i = s->first[cord] + from + 1 + thr_random_below(&s->state, to - from - 1);
    k = other_at_node(s, i);
    const thr_place *m = &s->place[i], *z = k < 0 ? NULL : &s->place[k];
    if (!z || m == p || m == q || z == p || z == q) continue;
    if (joined ? z->cord != p->cord && z->cord != q->cord : z->cord == cord && z->index > from && z->index < to) continue;
    bool crossed = joined ? m->cord != z->cord && thr_random_below(&s->state, 2) : thr_random_below(&s->state, 2);
    if (exchange(s, t, m, z, crossed)) return true;
  }
  return false;
}

/* A change at random that keeps the number of cords, if *t is not empty and thr_evener_follow says so. */
static void propose(thr_evener *s, trail *t)
{
  int i = thr_random_below(&s->state, s->n_places), k = other_at_node(s, i);
  t->n = 0;
  if (k < 0) return;
  const thr_place *p = &s->place[i], *q = &s->place[k];
  if (p->cord == q->cord && p->index > q->index) {
    const thr_place *later = p;
    p = q;
    q = later;
  }
  bool crossed = thr_random_below(&s->state, 2);
  if (!exchange(s, t, p, q, crossed)) return;
  bool same = p->cord == q->cord;
  if (!(same ? crossed : !s->closed) && !put_right(s, t, p, q))
    take_back(s, t);
  else
    keep_if_tied(s, t);
}

void thr_evener_anneal(thr_evener *s, const thr_limits *limits, int steps, double bound, int *best)
{
  static const double hot = 0.05, cold = 0.002; /* of the norm */
  size_t bytes = (size_t)s->j->g.n_darts * sizeof *best;
  double now = thr_evener_value(s), least = now;
  memcpy(best, s->j->mate, bytes);
  for (int i = 0; i < steps && s->n_places > 1; i++) {
    trail t;
    if (i % 64 == 0 && (thr_limits_stop(limits) || thr_evener_largest(s) <= bound * (1 + 1e-9))) break;
    double heat = hot * pow(cold / hot, (double)i / steps);
    propose(s, &t);
    if (t.n == 0) continue;
    bool whole = thr_evener_follow(s);
    double next = whole ? thr_evener_value(s) : (double)INFINITY;
    if (next <= now || thr_random_unit(&s->state) < exp(-log(next / now) / POWER / heat)) {
      now = next;
      if (now >= least * (1 - 1e-12)) continue;
      least = now;
      memcpy(best, s->j->mate, bytes);
    } else {
      take_back(s, &t);
      thr_evener_follow(s);
    }
  }
  memcpy(s->j->mate, best, bytes);
  thr_evener_follow(s);
}
