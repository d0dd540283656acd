/* Exchanges at one node or two: by descent, and by simulated annealing. */
#include "graph/threading/even.h"
#include "graph/random.h"
#include "graph/threading/multigraph.h"

#include <math.h>
#include <string.h>

enum { POWER = 8 };

bool thr_evener_follow(thr_evener *s)
{
  return thr_threading_follow(s->t, s->n_cords) && s->t->n_cords == s->n_cords;
}

static double power(const thr_evener *s, double total)
{
  return pow(total / s->scale, POWER);
}

double thr_evener_value(const thr_evener *s)
{
  double sum = 0;
  for (int k = 0; k < s->t->n_cords; k++)
    sum += power(s, s->t->total[k]);
  return sum;
}

double thr_evener_largest(const thr_evener *s)
{
  double largest = 0;
  for (int k = 0; k < s->t->n_cords; k++)
    largest = fmax(largest, s->t->total[k]);
  return largest;
}

static bool closed(const thr_evener *s)
{
  return thr_threading_closed(s->t, 0);
}

static double price(const thr_evener *s, int a, int b)
{
  return s->t->price(s->t->of, a, b);
}

/* ---- descent ---- */

/* Price of the pairs after place p on its cord. */
static double after(const thr_evener *s, const thr_place *p)
{
  return s->t->total[p->cord] - p->before - p->price;
}

/* Do the new totals of two cords weigh less than the old? */
static bool better(const thr_evener *s, int k, int l, double new_k, double new_l)
{
  return power(s, new_k) + power(s, new_l) < (power(s, s->t->total[k]) + power(s, s->t->total[l])) * (1 - 1e-9);
}

/* Two cords at one node change tails, or one takes the other's head turned round. */
static bool change_tails(thr_evener *s, const thr_place *p, const thr_place *q)
{
  thr_broken old = {0};
  const double tails[2] = {price(s, p->in, q->out), price(s, q->in, p->out)};
  if (better(s, p->cord, q->cord, p->before + tails[0] + after(s, q), q->before + tails[1] + after(s, p))) {
    thr_threading_pair(s->t, p->in, q->out, q->in, p->out, &old);
    if (thr_threading_keep(s->t, &old)) return true;
  }
  const double heads[2] = {price(s, p->in, q->in), price(s, p->out, q->out)};
  if (!better(s, p->cord, q->cord, p->before + heads[0] + q->before, after(s, p) + heads[1] + after(s, q))) return false;
  thr_threading_pair(s->t, p->in, q->in, p->out, q->out, &old);
  return thr_threading_keep(s->t, &old);
}

static bool run_backwards(thr_evener *s, const thr_place *p, const thr_place *q)
{
  thr_broken old = {0};
  if (price(s, p->in, q->in) + price(s, p->out, q->out) >= p->price + q->price - 1e-9) return false;
  thr_threading_pair(s->t, p->in, q->in, p->out, q->out, &old);
  return thr_threading_keep(s->t, &old);
}

/* The part between p and q (of one cord, p first) as a circuit, joined to another cord where they meet. */
static bool hand_over(thr_evener *s, const thr_place *p, const thr_place *q)
{
  thr_threading *t = s->t;
  const thr_multigraph *g = t->g;
  int k = p->cord;
  double closing = price(s, q->in, p->out), shortcut = price(s, p->in, q->out);
  double part = q->before - p->before - p->price + closing, rest = t->total[k] - part + closing - p->price - q->price + shortcut;
  if (rest >= t->total[k]) return false;
  for (const thr_place *m = p + 1; m < q; m++) {
    int v = g->tail[m->in];
    for (int i = g->first[v]; i < g->first[v + 1]; i++) {
      const thr_place *z = &t->place[t->at[g->dart[i]]];
      thr_broken old = {0};
      if (z->cord == k || z->in != g->dart[i]) continue;
      double base = t->total[z->cord] - z->price + part - m->price;
      double same = price(s, z->in, m->out) + price(s, m->in, z->out);
      double turned = price(s, z->in, m->in) + price(s, m->out, z->out);
      if (!better(s, k, z->cord, rest, base + fmin(same, turned))) continue;
      thr_threading_pair(t, q->in, p->out, p->in, q->out, &old);
      thr_threading_pair(t, z->in, same <= turned ? m->out : m->in, z->out, same <= turned ? m->in : m->out, &old);
      if (thr_threading_keep(t, &old)) return true;
    }
  }
  return false;
}

/* One exchange at node v. */
static bool exchange_at(thr_evener *s, int v, const thr_limits *limits)
{
  const thr_threading *t = s->t;
  const thr_multigraph *g = t->g;
  for (int i = g->first[v]; i < g->first[v + 1] && !thr_limits_stop(limits); i++)
    for (int k = i + 1; k < g->first[v + 1]; k++) {
      const thr_place *p = &t->place[t->at[g->dart[i]]], *q = &t->place[t->at[g->dart[k]]];
      if (p == q || p->in != g->dart[i] || q->in != g->dart[k]) continue;
      if (p->cord != q->cord) {
        if (!closed(s) && change_tails(s, p, q)) return true;
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
  for (bool changed = true; changed && !thr_limits_stop(limits);) {
    changed = false;
    for (int v = 0; v < s->t->f->n_nodes && !thr_limits_stop(limits); v++)
      while (exchange_at(s, v, limits)) {
        changed = true;
        thr_evener_follow(s);
      }
  }
}

/* ---- annealing ---- */

/* Pairs two places of one node anew, unless that is forbidden. */
static bool exchange(thr_evener *s, thr_broken *old, int i, int k, bool crossed)
{
  thr_exchange x = thr_threading_exchange(s->t, i, k, crossed);
  if (x.extra >= THR_FORBIDDEN / 2) return false;
  thr_threading_make(s->t, &x, old);
  return true;
}

/* A place at the same node as place i, or -1. */
static int other_at_node(thr_evener *s, int i)
{
  const thr_multigraph *g = s->t->g;
  int v = g->tail[s->t->place[i].in], n = g->first[v + 1] - g->first[v];
  int k = s->t->at[g->dart[g->first[v] + thr_random_below(&s->state, n)]];
  return k == i ? -1 : k;
}

/* Two cords joined into one circuit are cut apart again somewhere else, and a part that an exchange of places p and q cuts off
 * one cord is joined to another cord or elsewhere. false: nothing found. */
static bool put_right(thr_evener *s, thr_broken *old, int p, int q)
{
  enum { TRIES = 8 };
  const thr_threading *t = s->t;
  const thr_place *place = t->place;
  bool joined = place[p].cord != place[q].cord;
  for (int tries = 0; tries < TRIES; tries++) {
    int from = p, to = q, cord = place[p].cord;
    if (joined) {
      cord = place[thr_random_below(&s->state, 2) ? p : q].cord;
      from = t->first[cord] - 1;
      to = t->first[cord + 1];
    }
    if (to - from < 2) return false;
    int m = from + 1 + thr_random_below(&s->state, to - from - 1), z = other_at_node(s, m);
    if (z < 0 || m == p || m == q || z == p || z == q) continue;
    if (joined ? place[z].cord != place[p].cord && place[z].cord != place[q].cord : z > from && z < to) continue;
    bool crossed = joined ? place[m].cord != place[z].cord && thr_random_below(&s->state, 2) : thr_random_below(&s->state, 2);
    if (exchange(s, old, m, z, crossed)) return true;
  }
  return false;
}

/* A change at random that keeps the number of cords, if *old is not empty and thr_evener_follow says so. */
static void propose(thr_evener *s, thr_broken *old)
{
  int p = thr_random_below(&s->state, s->t->n_places), q = other_at_node(s, p);
  old->n = 0;
  if (q < 0) return;
  bool same = s->t->place[p].cord == s->t->place[q].cord;
  if (same && p > q) {
    int later = p;
    p = q;
    q = later;
  }
  bool crossed = thr_random_below(&s->state, 2);
  if (!exchange(s, old, p, q, crossed)) return;
  if (!(same ? crossed : !closed(s)) && !put_right(s, old, p, q))
    thr_threading_take_back(s->t, old);
  else
    thr_threading_keep(s->t, old);
}

void thr_evener_anneal(thr_evener *s, const thr_limits *limits, int steps, double bound, int *best)
{
  static const double hot = 0.05, cold = 0.002; /* of the norm */
  size_t bytes = (size_t)s->t->g->n_darts * sizeof *best;
  double now = thr_evener_value(s), least = now;
  memcpy(best, s->t->mate, bytes);
  for (int i = 0; i < steps && s->t->n_places > 1; i++) {
    thr_broken old;
    if (i % 64 == 0 && (thr_limits_stop(limits) || thr_evener_largest(s) <= bound * (1 + 1e-9))) break;
    double heat = hot * pow(cold / hot, (double)i / steps);
    propose(s, &old);
    if (old.n == 0) continue;
    double next = thr_evener_follow(s) ? thr_evener_value(s) : (double)INFINITY;
    if (next <= now || thr_random_unit(&s->state) < exp(-log(next / now) / POWER / heat)) {
      now = next;
      if (now >= least * (1 - 1e-12)) continue;
      least = now;
      memcpy(best, s->t->mate, bytes);
    } else {
      thr_threading_take_back(s->t, &old);
      thr_evener_follow(s);
    }
  }
  memcpy(s->t->mate, best, bytes);
  thr_evener_follow(s);
}
