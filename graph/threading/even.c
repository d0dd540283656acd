/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evens out the totals of a threading's cords by exchanges of pairs.
 *
 * What is minimized is the sum of the 8th powers of the totals, in which the largest total counts
 * most: by descent (thr_evener_even), where every exchange improves two cords, and by simulated
 * annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983; thr_evener_anneal), where some
 * changes worsen. The number of cords stays.
 *
 * Example: two open cords with totals 10 and 2 meet at a node after 7 of the first and 1 of the
 * second. If they exchange their tails, the totals are 8 and 4. */
#include "graph/threading/threading.h"

#include <math.h>
#include <string.h>

enum { POWER = 8 }; /* as power() has it */

bool thr_evener_follow(thr_evener *evener)
{
  return thr_threading_follow(evener->t, evener->n_cords) && evener->t->n_cords == evener->n_cords;
}

/* Returns the 8th power of a total, relative to the scale. */
static double power(const thr_evener *evener, double total)
{
  double ratio = total / evener->scale, two = ratio * ratio, four = two * two;
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

/* Returns whether the cords are closed: all of them are, or none is. */
static bool closed(const thr_evener *evener)
{
  return thr_threading_closed(evener->t, 0);
}

static double price(const thr_evener *evener, int a, int b)
{
  return evener->t->price(evener->t->of, a, b);
}

/* ---- descent ---- */

/* Returns the price of the pairs after place p on its cord. */
static double after(const thr_evener *evener, const thr_place *p)
{
  return evener->t->total[p->cord] - p->before - p->price;
}

/* Returns whether new totals of cords k and l have a smaller sum of powers than the old ones. */
static bool better(const thr_evener *evener, int k, int l, double new_k, double new_l)
{
  return power(evener, new_k) + power(evener, new_l) <
         (power(evener, evener->t->total[k]) + power(evener, evener->t->total[l])) * (1 - 1e-9);
}

/* Exchanges the tails of two open cords at one node, or joins head to head and tail to tail, if
 * either improves. */
static bool change_tails(thr_evener *evener, const thr_place *p, const thr_place *q)
{
  thr_broken old = {0};
  const double tails[2] = {price(evener, p->in, q->out), price(evener, q->in, p->out)};
  if (better(evener, p->cord, q->cord, p->before + tails[0] + after(evener, q),
             q->before + tails[1] + after(evener, p))) {
    thr_threading_pair(evener->t, p->in, q->out, q->in, p->out, &old);
    if (thr_threading_keep(evener->t, &old)) return true;
  }

  /* Otherwise the heads. */
  const double heads[2] = {price(evener, p->in, q->in), price(evener, p->out, q->out)};
  if (!better(evener, p->cord, q->cord, p->before + heads[0] + q->before,
              after(evener, p) + heads[1] + after(evener, q)))
    return false;

  thr_threading_pair(evener->t, p->in, q->in, p->out, q->out, &old);
  return thr_threading_keep(evener->t, &old);
}

/* Reverses the part between two places of one cord if this lowers the cord's total. */
static bool run_backwards(thr_evener *evener, const thr_place *p, const thr_place *q)
{
  thr_broken old = {0};
  if (price(evener, p->in, q->in) + price(evener, p->out, q->out) >= p->price + q->price - 1e-9)
    return false;

  thr_threading_pair(evener->t, p->in, q->in, p->out, q->out, &old);
  return thr_threading_keep(evener->t, &old);
}

/* Cuts the part between places p and q (of one cord, p first) off as a circuit, and joins the
 * circuit to another cord that meets it, if this improves. */
static bool hand_over(thr_evener *evener, const thr_place *p, const thr_place *q)
{
  thr_threading *threading = evener->t;
  const thr_multigraph *multigraph = threading->g;
  int k = p->cord;

  /* The part gains a closing pair, the rest a pair that skips the part. */
  double closing = price(evener, q->in, p->out), shortcut = price(evener, p->in, q->out);
  double part = q->before - p->before - p->price + closing,
         rest = threading->total[k] - part + closing - p->price - q->price + shortcut;

  if (rest >= threading->total[k]) return false;

  /* Wherever the part meets another cord, the circuit can be joined in either direction. */
  for (const thr_place *meeting = p + 1; meeting < q; meeting++) {
    int v = multigraph->tail[meeting->in];
    for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++) {
      const thr_place *other = &threading->place[threading->at[multigraph->dart[i]]];
      thr_broken old = {0};

      if (other->cord == k || other->in != multigraph->dart[i]) continue;

      double base = threading->total[other->cord] - other->price + part - meeting->price;
      double same = price(evener, other->in, meeting->out) + price(evener, meeting->in, other->out);
      double turned =
          price(evener, other->in, meeting->in) + price(evener, meeting->out, other->out);
      if (!better(evener, k, other->cord, rest, base + fmin(same, turned))) continue;

      /* Close the part, and open it at the place where it joins the other cord. */
      thr_threading_pair(threading, q->in, p->out, p->in, q->out, &old);
      thr_threading_pair(threading, other->in, same <= turned ? meeting->out : meeting->in,
                         other->out, same <= turned ? meeting->in : meeting->out, &old);
      if (thr_threading_keep(threading, &old)) return true;
    }
  }
  return false;
}

/* Makes the first exchange at node v that improves; false: there is none. */
static bool exchange_at(thr_evener *evener, int v)
{
  const thr_threading *threading = evener->t;
  const thr_multigraph *multigraph = threading->g;

  for (int i = multigraph->first[v];
       i < multigraph->first[v + 1] && !thr_limits_stop(evener->limits); i++)
    for (int k = i + 1; k < multigraph->first[v + 1]; k++) {
      const thr_place *p = &threading->place[threading->at[multigraph->dart[i]]],
                      *q = &threading->place[threading->at[multigraph->dart[k]]];

      /* Every place is named by both its half-edges; only the one that it arrives against counts.
       */
      if (p == q || p->in != multigraph->dart[i] || q->in != multigraph->dart[k]) continue;

      /* Two open cords exchange tails. */
      if (p->cord != q->cord) {
        if (!closed(evener) && change_tails(evener, p, q)) return true;
        continue;
      }

      /* Within one cord the earlier place comes first. */
      if (p->index > q->index) {
        const thr_place *later = p;
        p = q;
        q = later;
      }

      if (run_backwards(evener, p, q) || hand_over(evener, p, q)) return true;
    }
  return false;
}

/* Makes an exchange at node v and follows the cords again, for thr_threading_descend. */
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

/* Adds an exchange of two places of one node to a change; false if the exchange is forbidden. */
static bool add_exchange(const thr_evener *evener, change *proposed, int i, int k, bool crossed)
{
  proposed->x[proposed->n] = thr_threading_exchange(evener->t, i, k, crossed);
  if (proposed->x[proposed->n].extra >= THR_FORBIDDEN / 2) return false;
  proposed->n++;
  return true;
}

/* Draws a place at the node of place i; -1 if this is place i itself. */
static int other_at_node(thr_evener *evener, int i)
{
  const thr_multigraph *multigraph = evener->t->g;
  int v = multigraph->tail[evener->t->place[i].in],
      n = multigraph->first[v + 1] - multigraph->first[v];
  int k =
      evener->t->at[multigraph->dart[multigraph->first[v] + thr_random_below(&evener->state, n)]];
  return k == i ? -1 : k;
}

/* Computes the totals of two open cords that exchange their parts after places p and q. crossed:
 * head is joined to head, and tail to tail. */
static void measure_tails(const thr_evener *evener, change *proposed, const thr_place *p,
                          const thr_place *q, bool crossed)
{
  const double here[2] = {price(evener, p->in, crossed ? q->in : q->out),
                          price(evener, p->out, crossed ? q->out : q->in)};

  proposed->n_cords = 2;
  proposed->cord[0] = p->cord;
  proposed->cord[1] = q->cord;
  proposed->total[0] = p->before + here[0] + (crossed ? q->before : after(evener, q));
  proposed->total[1] = after(evener, p) + here[1] + (crossed ? after(evener, q) : q->before);
}

/* Computes the totals where the part between places p and q of one cord is cut off and joined again
 * at place z, of the same cord or another. */
static void measure_part(const thr_evener *evener, change *proposed, const thr_place *p,
                         const thr_place *q, const thr_place *z)
{
  const double *total = evener->t->total;
  double inside = q->before - p->before - p->price,
         rest = total[p->cord] - inside - p->price - q->price + price(evener, p->in, q->out);

  double part = inside + price(evener, q->in, p->out) + proposed->x[1].extra;

  bool same = z->cord == p->cord;
  proposed->n_cords = same ? 1 : 2;
  proposed->cord[0] = p->cord;
  proposed->cord[1] = z->cord;
  proposed->total[0] = same ? rest + part : rest;
  proposed->total[1] = total[z->cord] + part;
}

/* Completes a change by a second exchange, so that the number of cords stays. If places p and q are
 * on two cords, their exchange joined both into one circuit, which is cut apart somewhere else.
 * Otherwise it cut a part off a cord, which is joined to another cord or elsewhere to its own.
 * Returns false if some draws found nothing. */
static bool put_right(thr_evener *evener, change *proposed, int p, int q)
{
  enum { TRIES = 8 };
  const thr_threading *threading = evener->t;
  const thr_place *place = threading->place;
  bool joined = place[p].cord != place[q].cord;

  for (int tries = 0; tries < TRIES; tries++) {
    int from = p, to = q;

    /* The second place is drawn on the circuit, or within the part that was cut off. */
    if (joined) {
      const int cord = place[thr_random_below(&evener->state, 2) ? p : q].cord;
      from = threading->first[cord] - 1;
      to = threading->first[cord + 1];
    }

    if (to - from < 2) return false;

    int drawn = from + 1 + thr_random_below(&evener->state, to - from - 1),
        other = other_at_node(evener, drawn);

    if (other < 0 || drawn == p || drawn == q || other == p || other == q) continue;

    /* A cut needs both places on the circuit; a join needs one place outside of the part. */
    if (joined ? place[other].cord != place[p].cord && place[other].cord != place[q].cord
               : other > from && other < to)
      continue;

    bool crossed =
        joined ? place[drawn].cord != place[other].cord && thr_random_below(&evener->state, 2)
               : thr_random_below(&evener->state, 2);

    if (!add_exchange(evener, proposed, drawn, other, crossed)) continue;
    if (!joined) measure_part(evener, proposed, &place[p], &place[q], &place[other]);
    return true;
  }
  return false;
}

/* Draws a change at place p that keeps the number of cords, if thr_evener_follow says so
 * afterwards; false: there is none. */
static bool propose(thr_evener *evener, int p, change *proposed)
{
  int q = other_at_node(evener, p);

  *proposed = (change){0};
  if (q < 0) return false;
  const thr_place *place = evener->t->place;

  bool same = place[p].cord == place[q].cord;
  if (same && p > q) {
    int later = p;
    p = q;
    q = later;
  }

  bool crossed = thr_random_below(&evener->state, 2);
  if (!add_exchange(evener, proposed, p, q, crossed)) return false;

  /* One exchange suffices if it reverses a part of a cord or two open cords exchange their ends. */
  if (!(same ? crossed : !closed(evener))) return put_right(evener, proposed, p, q);

  if (!same) measure_tails(evener, proposed, &place[p], &place[q], crossed);
  if (same) {
    proposed->n_cords = 1;
    proposed->cord[0] = place[p].cord;
    proposed->total[0] = evener->t->total[place[p].cord] + proposed->x[0].extra;
  }
  return true;
}

/* Returns the value after a change whose totals are known. */
static double value_after(const thr_evener *evener, const change *proposed, double now)
{
  for (int i = 0; i < proposed->n_cords; i++)
    now += power(evener, proposed->total[i]) - power(evener, evener->t->total[proposed->cord[i]]);
  return now;
}

/* Makes a change if its nodes stay tied; otherwise leaves the pairs as they were. */
static bool make(thr_evener *evener, const change *proposed, thr_broken *old)
{
  *old = (thr_broken){0};
  for (int i = 0; i < proposed->n; i++)
    thr_threading_make(evener->t, &proposed->x[i], old);
  return thr_threading_keep(evener->t, old);
}

void thr_evener_propose(thr_evener *evener, int place, thr_broken *old)
{
  change proposed;
  *old = (thr_broken){0};
  if (propose(evener, place, &proposed)) make(evener, &proposed, old);
}

/* Decides whether a new value is taken at this heat. The heat is relative to the norm, the 8th root
 * of the value. */
static bool is_taken(thr_evener *evener, double now, double next, double heat)
{
  return next <= now || thr_random_unit(&evener->state) < exp(-log(next / now) / POWER / heat);
}

/* Draws one change and makes it if it is taken. *now: the value, which is updated. */
static void try_change(thr_evener *evener, double heat, double *now)
{
  change proposed;
  thr_broken old;

  if (!propose(evener, thr_random_below(&evener->state, evener->t->n_places), &proposed)) return;

  /* Changes whose totals are known are refused without following the cords. */
  const bool known = proposed.n_cords > 0;
  if (known && !is_taken(evener, *now, value_after(evener, &proposed, *now), heat)) return;

  if (!make(evener, &proposed, &old)) return;

  /* Follow all cords: a change whose totals were not known is judged now. */
  const double next = thr_evener_follow(evener) ? thr_evener_value(evener) : (double)INFINITY;
  if (next < INFINITY && (known || is_taken(evener, *now, next, heat))) {
    *now = next;
    return;
  }

  thr_threading_take_back(evener->t, &old);
  thr_threading_unfollow(evener->t);
}

void thr_evener_anneal(thr_evener *evener, int steps, double bound, int *best)
{
  const double hot = fmin(0.05, fmax(0.024 / evener->n_cords, 2.4 / fmax(1, evener->t->n_places))),
               cold = hot / 10; /* of the norm: some turns of one cord */
  size_t bytes = (size_t)evener->t->g->n_darts * sizeof *best;
  double now = thr_evener_value(evener), least = now, heat = hot;
  memcpy(best, evener->t->mate, bytes);

  /* The heat falls by equal factors, and is set now and then. */
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

  /* End with the best pairs. */
  memcpy(evener->t->mate, best, bytes);
  thr_evener_follow(evener);
}
