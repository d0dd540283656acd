/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchanges that even out the totals of a threading's cords: the sum of their 8th powers, in which
 * the largest counts most, is made small by descent and by simulated annealing (S. Kirkpatrick, C.
 * D. Gelatt & M. P. Vecchi 1983). */
#include "graph/threading/threading.h"
#include "graph/random.h"

#include <math.h>
#include <string.h>

enum { POWER = 8 }; /* as power() has it */

bool thr_evener_follow(thr_evener *evener)
{
  return thr_threading_follow(evener->t, evener->n_cords) && evener->t->n_cords == evener->n_cords;
}

static double power(const thr_evener *evener, double total)
{
  double one = total / evener->scale, two = one * one, four = two * two;
  return four * four;
}

double thr_evener_value(const thr_evener *evener)
{
  double sum = 0;
  for (int k = 0; k < evener->t->n_cords; k++)
    sum += power(evener, evener->t->total[k]);
  return sum;
}

double thr_evener_largest(const thr_evener *evener)
{
  double largest = 0;
  for (int k = 0; k < evener->t->n_cords; k++)
    largest = fmax(largest, evener->t->total[k]);
  return largest;
}

static bool closed(const thr_evener *evener)
{
  return thr_threading_closed(evener->t, 0);
}

static double price(const thr_evener *evener, int a, int b)
{
  return evener->t->price(evener->t->of, a, b);
}

/* ---- descent ---- */

/* Price of the pairs after place p on its cord. */
static double after(const thr_evener *evener, const thr_place *p)
{
  return evener->t->total[p->cord] - p->before - p->price;
}

/* Do the new totals of two cords weigh less than the old? */
static bool better(const thr_evener *evener, int k, int l, double new_k, double new_l)
{
  return power(evener, new_k) + power(evener, new_l) <
         (power(evener, evener->t->total[k]) + power(evener, evener->t->total[l])) * (1 - 1e-9);
}

/* Two cords at one node change tails, or one takes the other's head turned round. */
static bool change_tails(thr_evener *evener, const thr_place *p, const thr_place *q)
{
  thr_broken old = {0};
  const double tails[2] = {price(evener, p->in, q->out), price(evener, q->in, p->out)};
  if (better(evener, p->cord, q->cord, p->before + tails[0] + after(evener, q),
             q->before + tails[1] + after(evener, p))) {
    thr_threading_pair(evener->t, p->in, q->out, q->in, p->out, &old);
    if (thr_threading_keep(evener->t, &old)) return true;
  }
  const double heads[2] = {price(evener, p->in, q->in), price(evener, p->out, q->out)};
  if (!better(evener, p->cord, q->cord, p->before + heads[0] + q->before,
              after(evener, p) + heads[1] + after(evener, q)))
    return false;
  thr_threading_pair(evener->t, p->in, q->in, p->out, q->out, &old);
  return thr_threading_keep(evener->t, &old);
}

static bool run_backwards(thr_evener *evener, const thr_place *p, const thr_place *q)
{
  thr_broken old = {0};
  if (price(evener, p->in, q->in) + price(evener, p->out, q->out) >= p->price + q->price - 1e-9)
    return false;
  thr_threading_pair(evener->t, p->in, q->in, p->out, q->out, &old);
  return thr_threading_keep(evener->t, &old);
}

/* The part between p and q (of one cord, p first) as a circuit, joined to another cord where they
 * meet. */
static bool hand_over(thr_evener *evener, const thr_place *p, const thr_place *q)
{
  thr_threading *threading = evener->t;
  const thr_multigraph *multigraph = threading->g;
  int k = p->cord;
  double closing = price(evener, q->in, p->out), shortcut = price(evener, p->in, q->out);
  double part = q->before - p->before - p->price + closing,
         rest = threading->total[k] - part + closing - p->price - q->price + shortcut;
  if (rest >= threading->total[k]) return false;
  for (const thr_place *m = p + 1; m < q; m++) {
    int v = multigraph->tail[m->in];
    for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++) {
      const thr_place *z = &threading->place[threading->at[multigraph->dart[i]]];
      thr_broken old = {0};
      if (z->cord == k || z->in != multigraph->dart[i]) continue;
      double base = threading->total[z->cord] - z->price + part - m->price;
      double same = price(evener, z->in, m->out) + price(evener, m->in, z->out);
      double turned = price(evener, z->in, m->in) + price(evener, m->out, z->out);
      if (!better(evener, k, z->cord, rest, base + fmin(same, turned))) continue;
      thr_threading_pair(threading, q->in, p->out, p->in, q->out, &old);
      thr_threading_pair(threading, z->in, same <= turned ? m->out : m->in, z->out,
                         same <= turned ? m->in : m->out, &old);
      if (thr_threading_keep(threading, &old)) return true;
    }
  }
  return false;
}

/* One exchange at node v. */
static bool exchange_at(thr_evener *evener, int v)
{
  const thr_threading *threading = evener->t;
  const thr_multigraph *multigraph = threading->g;
  for (int i = multigraph->first[v];
       i < multigraph->first[v + 1] && !thr_limits_stop(evener->limits); i++)
    for (int k = i + 1; k < multigraph->first[v + 1]; k++) {
      const thr_place *p = &threading->place[threading->at[multigraph->dart[i]]],
                      *q = &threading->place[threading->at[multigraph->dart[k]]];
      if (p == q || p->in != multigraph->dart[i] || q->in != multigraph->dart[k]) continue;
      if (p->cord != q->cord) {
        if (!closed(evener) && change_tails(evener, p, q)) return true;
        continue;
      }
      if (p->index > q->index) {
        const thr_place *later = p;
        p = q;
        q = later;
      }
      if (run_backwards(evener, p, q) || hand_over(evener, p, q)) return true;
    }
  return false;
}

static bool improve_at(void *of, int v)
{
  thr_evener *evener = of;
  if (!exchange_at(evener, v)) return false;
  thr_evener_follow(evener);
  return true;
}

void thr_evener_even(thr_evener *evener)
{
  thr_threading_descend(evener->t, evener->limits, improve_at, evener);
}

/* ---- annealing ---- */

/* Pairs to be made, and what that makes of the totals of one cord or two; n_cords 0: that is found
 * out by following them all. */
typedef struct {
  int n, n_cords;
  thr_exchange x[2];
  int cord[2];
  double total[2];
} change;

/* Adds an exchange of two places of one node, unless that is forbidden. */
static bool add_exchange(const thr_evener *evener, change *c, int i, int k, bool crossed)
{
  c->x[c->n] = thr_threading_exchange(evener->t, i, k, crossed);
  if (c->x[c->n].extra >= THR_FORBIDDEN / 2) return false;
  c->n++;
  return true;
}

/* A place at the same node as place i, or -1. */
static int other_at_node(thr_evener *evener, int i)
{
  const thr_multigraph *multigraph = evener->t->g;
  int v = multigraph->tail[evener->t->place[i].in],
      n = multigraph->first[v + 1] - multigraph->first[v];
  int k =
      evener->t->at[multigraph->dart[multigraph->first[v] + thr_random_below(&evener->state, n)]];
  return k == i ? -1 : k;
}

/* Two open cords that meet in places p and q go on as the other does, or as it did before, turned
 * round. */
static void measure_tails(const thr_evener *evener, change *c, const thr_place *p,
                          const thr_place *q, bool crossed)
{
  const double here[2] = {price(evener, p->in, crossed ? q->in : q->out),
                          price(evener, p->out, crossed ? q->out : q->in)};
  c->n_cords = 2;
  c->cord[0] = p->cord;
  c->cord[1] = q->cord;
  c->total[0] = p->before + here[0] + (crossed ? q->before : after(evener, q));
  c->total[1] = after(evener, p) + here[1] + (crossed ? after(evener, q) : q->before);
}

/* The part between places p and q of one cord is cut off, and joined elsewhere to place z, of the
 * same cord or another. */
static void measure_part(const thr_evener *evener, change *c, const thr_place *p,
                         const thr_place *q, const thr_place *z)
{
  const double *total = evener->t->total;
  double inside = q->before - p->before - p->price,
         rest = total[p->cord] - inside - p->price - q->price + price(evener, p->in, q->out);
  double part = inside + price(evener, q->in, p->out) + c->x[1].extra;
  bool same = z->cord == p->cord;
  c->n_cords = same ? 1 : 2;
  c->cord[0] = p->cord;
  c->cord[1] = z->cord;
  c->total[0] = same ? rest + part : rest;
  c->total[1] = total[z->cord] + part;
}

/* Two cords joined into one circuit are cut apart again somewhere else, and a part that an exchange
 * of places p and q cuts off one cord is joined to another cord or elsewhere. false: nothing found.
 */
static bool put_right(thr_evener *evener, change *c, int p, int q)
{
  enum { TRIES = 8 };
  const thr_threading *threading = evener->t;
  const thr_place *place = threading->place;
  bool joined = place[p].cord != place[q].cord;
  for (int tries = 0; tries < TRIES; tries++) {
    int from = p, to = q, cord = place[p].cord;
    if (joined) {
      cord = place[thr_random_below(&evener->state, 2) ? p : q].cord;
      from = threading->first[cord] - 1;
      to = threading->first[cord + 1];
    }
    if (to - from < 2) return false;
    int m = from + 1 + thr_random_below(&evener->state, to - from - 1),
        z = other_at_node(evener, m);
    if (z < 0 || m == p || m == q || z == p || z == q) continue;
    if (joined ? place[z].cord != place[p].cord && place[z].cord != place[q].cord
               : z > from && z < to)
      continue;
    bool crossed = joined ? place[m].cord != place[z].cord && thr_random_below(&evener->state, 2)
                          : thr_random_below(&evener->state, 2);
    if (!add_exchange(evener, c, m, z, crossed)) continue;
    if (!joined) measure_part(evener, c, &place[p], &place[q], &place[z]);
    return true;
  }
  return false;
}

/* A change at random at a place that keeps the number of cords, if thr_evener_follow says so;
 * false: none. */
static bool propose(thr_evener *evener, int p, change *c)
{
  int q = other_at_node(evener, p);
  *c = (change){0};
  if (q < 0) return false;
  const thr_place *place = evener->t->place;
  bool same = place[p].cord == place[q].cord;
  if (same && p > q) {
    int later = p;
    p = q;
    q = later;
  }
  bool crossed = thr_random_below(&evener->state, 2);
  if (!add_exchange(evener, c, p, q, crossed)) return false;
  if (!(same ? crossed : !closed(evener))) return put_right(evener, c, p, q);
  if (!same) measure_tails(evener, c, &place[p], &place[q], crossed);
  if (same) {
    c->n_cords = 1;
    c->cord[0] = place[p].cord;
    c->total[0] = evener->t->total[place[p].cord] + c->x[0].extra;
  }
  return true;
}

/* The value after a change whose totals are known. */
static double value_after(const thr_evener *evener, const change *c, double now)
{
  for (int i = 0; i < c->n_cords; i++)
    now += power(evener, c->total[i]) - power(evener, evener->t->total[c->cord[i]]);
  return now;
}

/* Makes a change, if its nodes stay tied. */
static bool make(thr_evener *evener, const change *c, thr_broken *old)
{
  *old = (thr_broken){0};
  for (int i = 0; i < c->n; i++)
    thr_threading_make(evener->t, &c->x[i], old);
  return thr_threading_keep(evener->t, old);
}

void thr_evener_propose(thr_evener *evener, int place, thr_broken *old)
{
  change c;
  *old = (thr_broken){0};
  if (propose(evener, place, &c)) make(evener, &c, old);
}

/* Is a value that may be higher taken, at this heat? */
static bool is_taken(thr_evener *evener, double now, double next, double heat)
{
  return next <= now || thr_random_unit(&evener->state) < exp(-log(next / now) / POWER / heat);
}

/* One change, or none; *now: the value. */
static void try_change(thr_evener *evener, double heat, double *now)
{
  change c;
  thr_broken old;
  if (!propose(evener, thr_random_below(&evener->state, evener->t->n_places), &c)) return;
  const bool known = c.n_cords > 0;
  if (known && !is_taken(evener, *now, value_after(evener, &c, *now), heat)) return;
  if (!make(evener, &c, &old)) return;
  const double next = thr_evener_follow(evener) ? thr_evener_value(evener) : (double)INFINITY;
  if (next < INFINITY && (known || is_taken(evener, *now, next, heat))) {
    *now = next;
    return;
  }
  thr_threading_take_back(evener->t, &old);
  thr_evener_follow(evener);
}

void thr_evener_anneal(thr_evener *evener, int steps, double bound, int *best)
{
  const double hot = fmin(0.05, fmax(0.024 / evener->n_cords, 2.4 / fmax(1, evener->t->n_places))),
               cold = hot / 10; /* of the norm: some turns of one cord */
  size_t bytes = (size_t)evener->t->g->n_darts * sizeof *best;
  double now = thr_evener_value(evener), least = now, heat = hot;
  memcpy(best, evener->t->mate, bytes);
  for (int i = 0; i < steps && evener->t->n_places > 1; i++) {
    if (i % 64 == 0) {
      if (thr_limits_stop(evener->limits) || thr_evener_largest(evener) <= bound * (1 + 1e-9))
        break;
      heat = hot * pow(cold / hot, (double)i / steps);
    }
    try_change(evener, heat, &now);
    if (now >= least * (1 - 1e-12)) continue;
    least = now;
    memcpy(best, evener->t->mate, bytes);
  }
  memcpy(evener->t->mate, best, bytes);
  thr_evener_follow(evener);
}
