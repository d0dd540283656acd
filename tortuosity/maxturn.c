/* Exchanges between cords. */
#include "tortuosity/maxturn.h"

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
  double scale;  /* largest total at the start */
} cords;

static void cords_destroy(cords *s)
{
  free(s->first);
  free(s->place);
  free(s->at);
  free(s->total);
}

static thr_status cords_init(cords *s, thr_join *j, int n_cords, thr_err *err)
{
  size_t darts = (size_t)j->g.n_darts, n = (size_t)n_cords;
  *s = (cords){.j = j, .n_cords = n_cords};
  s->first = thr_calloc(n + 1, sizeof *s->first);
  s->place = thr_calloc(darts, sizeof *s->place);
  s->at = thr_calloc(darts, sizeof *s->at);
  s->total = thr_calloc(n, sizeof *s->total);
  return s->first && s->place && s->at && s->total ? THR_OK : thr_nomem(err);
}

static void follow(cords *s, int cord, int d)
{
  const thr_join *j = s->j;
  double sum = 0;
  s->first[cord] = s->n_places;
  for (; j->mate[d ^ 1] >= 0; d = j->mate[d ^ 1]) {
    place *p = &s->place[s->n_places];
    *p = (place){cord, s->n_places - s->first[cord], d ^ 1, j->mate[d ^ 1], sum, thr_join_price(j, d ^ 1, j->mate[d ^ 1])};
    s->at[p->in] = s->at[p->out] = s->n_places++;
    sum += p->price;
  }
  s->at[d ^ 1] = -2; /* the far end: this cord is followed */
  s->total[cord] = sum;
}

/* All places from the pairs. */
static void follow_all(cords *s)
{
  const thr_multigraph *g = &s->j->g;
  int cord = 0;
  s->n_places = 0;
  for (int d = 0; d < g->n_darts; d++)
    s->at[d] = -1;
  for (int v = s->j->c->f->n_nodes; v < g->n_nodes; v++)
    for (int i = g->first[v]; i < g->first[v + 1]; i++)
      if (s->at[g->dart[i]] != -2) follow(s, cord++, g->dart[i]);
  s->first[cord] = s->n_places;
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
        if (change_tails(s, p, q)) return true;
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

static uint64_t next_random(uint64_t *state)
{
  uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
  return z ^ z >> 31;
}

/* Some changes of tails at random, whatever they cost. */
static void kick(cords *s, uint64_t *state)
{
  enum { KICKS = 4, TRIES = 50 };
  const thr_multigraph *g = &s->j->g;
  for (int done = 0, tries = 0; done < KICKS && s->n_places > 0 && tries < TRIES; tries++) {
    const place *p = &s->place[next_random(state) % (uint64_t)s->n_places];
    int v = g->tail[p->in], n = g->first[v + 1] - g->first[v];
    const place *q = &s->place[s->at[g->dart[g->first[v] + (int)(next_random(state) % (uint64_t)n)]]];
    if (p->cord == q->cord) continue;
    if (thr_join_price(s->j, p->in, q->out) + thr_join_price(s->j, q->in, p->out) >= thr_join_forbidden) continue;
    int q_in = q->in, p_out = p->out;
    pair(s, p->in, q->out);
    pair(s, q_in, p_out);
    follow_all(s);
    done++;
  }
}

static double sum_of_powers(const cords *s)
{
  double sum = 0;
  for (int k = 0; k < s->n_cords; k++)
    sum += power(s, s->total[k]);
  return sum;
}

/* Kicks, and exchanges from there; what is worse is taken back. Counted, not timed, so that the same input gives the same cords.
 */
static thr_status search(cords *s, const thr_limits *limits, double bound, thr_err *err)
{
  size_t darts = (size_t)s->j->g.n_darts;
  int rounds = (int)fmax(200, fmin(4000, 2e6 / (double)darts));
  uint64_t state = 1;
  int *best = thr_calloc(darts, sizeof *best);
  if (!best) return thr_nomem(err);
  exchange_all(s, limits);
  memcpy(best, s->j->mate, darts * sizeof *best);
  double least = sum_of_powers(s);
  for (int i = 0; i < rounds && s->n_cords > 1 && !thr_limits_stop(limits); i++) {
    if (largest_of(s->total, s->n_cords) <= bound * (1 + 1e-9)) break;
    kick(s, &state);
    exchange_all(s, limits);
    double now = sum_of_powers(s);
    if (now < least * (1 - 1e-12)) {
      least = now;
      memcpy(best, s->j->mate, darts * sizeof *best);
    } else {
      memcpy(s->j->mate, best, darts * sizeof *best);
      follow_all(s);
    }
  }
  memcpy(s->j->mate, best, darts * sizeof *best);
  follow_all(s);
  free(best);
  return THR_OK;
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
  for (int i = 0; i < plan->n_cords; i++)
    free(plan->cord[i].half);
  free(plan->cord);
  plan->cord = made.cord;
  plan->price = made.price;
  plan->turning = made.turning;
  plan->optimal &= made.price <= plan->bound + 1e-7;
  return THR_OK;
}

thr_status thr_max_turning_improve(const thr_frame *f, const thr_limits *limits, thr_least *plan, thr_max_turning *out,
                                   thr_err *err)
{
  thr_turning_columns c = {0};
  thr_join j = {0};
  cords s = {0};
  *out = (thr_max_turning){.bound = plan->bound / plan->n_cords};
  thr_status st = thr_turning_columns_init(&c, f, &plan->task, err);
  if (!st) st = thr_join_from_cords(&j, &c, plan->cord, plan->n_cords, err);
  if (!st && plan->end_allowed) {
    st = cords_init(&s, &j, plan->n_cords, err);
    if (!st) {
      follow_all(&s);
      s.scale = fmax(1e-9, largest_of(s.total, s.n_cords));
      st = search(&s, limits, out->bound, err);
    }
    if (!st) {
      thr_join_measure(&j);
      st = take_cords(f, &j, plan, err);
    }
  }
  for (int i = 0; i < plan->n_cords && !st; i++) {
    const thr_cord *cord = &plan->cord[i];
    double price = 0;
    for (int k = 0; k < cord->n_passes - (plan->end_allowed != NULL); k++)
      price += thr_turn_price(f, plan->task.cost, cord->half[k], cord->half[(k + 1) % cord->n_passes]);
    out->largest = fmax(out->largest, price);
  }
  cords_destroy(&s);
  thr_join_destroy(&j);
  thr_turning_columns_destroy(&c);
  return st;
}
