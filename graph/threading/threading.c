/* The cords of a transition system, in order, and exchanges of pairs. */
#include "graph/threading/threading.h"
#include "graph/disjoint.h"

#include <stdlib.h>
#include <string.h>

void thr_threading_destroy(thr_threading *t)
{
  free(t->first);
  free(t->place);
  free(t->at);
  free(t->total);
  free(t->parent);
}

thr_status thr_threading_init(thr_threading *t, const thr_frame *f, const thr_multigraph *g, int *mate, thr_pair_price *price,
                              const void *of, bool tied, thr_err *err)
{
  size_t passes = (size_t)g->n_darts / 2; /* no fewer than cords, or places */
  *t = (thr_threading){.f = f, .g = g, .mate = mate, .price = price, .of = of, .tied = tied};
  t->first = thr_calloc(passes + 1, sizeof *t->first);
  t->place = thr_calloc(passes, sizeof *t->place);
  t->at = thr_calloc((size_t)g->n_darts, sizeof *t->at);
  t->total = thr_calloc(passes, sizeof *t->total);
  t->parent = thr_calloc((size_t)f->n_edges, sizeof *t->parent);
  return t->first && t->place && t->at && t->total && t->parent ? THR_OK : thr_nomem(err);
}

/* ---- tracing ---- */

enum { NOT_SEEN = -1, END = -2 };

static double price_of(const thr_threading *t, int a, int b)
{
  return t->price ? t->price(t->of, a, b) : 0;
}

static void follow_cord(thr_threading *t, int start)
{
  int k = t->n_cords++, d = start, first = t->first[k] = t->n_places;
  double sum = 0;
  if (t->mate[start] < 0) t->at[start] = END;
  for (int next; (next = t->mate[d ^ 1]) >= 0; d = next) {
    thr_place *p = &t->place[t->n_places];
    *p = (thr_place){k, t->n_places - first, d ^ 1, next, sum, price_of(t, d ^ 1, next)};
    t->at[p->in] = t->at[p->out] = t->n_places++;
    sum += p->price;
    if (next == start) break;
  }
  if (t->mate[d ^ 1] < 0) t->at[d ^ 1] = END;
  t->total[k] = sum;
}

bool thr_threading_follow(thr_threading *t, int most)
{
  const thr_multigraph *g = t->g;
  t->n_cords = t->n_places = 0;
  for (int d = 0; d < g->n_darts; d++)
    t->at[d] = NOT_SEEN;
  for (int i = g->first[t->f->n_nodes]; i < g->n_darts; i++)
    if (t->mate[g->dart[i]] < 0 && t->at[g->dart[i]] == NOT_SEEN) follow_cord(t, g->dart[i]);
  bool all = t->n_cords <= most;
  for (int d = 0; d < g->n_darts && all; d++)
    if (t->at[d] == NOT_SEEN && (all = t->n_cords < most)) follow_cord(t, d);
  t->first[t->n_cords] = t->n_places;
  return all;
}

static void label_cord(const int *mate, int start, int label, int *cord)
{
  for (int d = start; d >= 0 && cord[d] < 0; d = mate[d ^ 1])
    cord[d] = cord[d ^ 1] = label;
}

int thr_threading_label(const thr_multigraph *g, const int *mate, int *cord)
{
  int n = 0;
  for (int d = 0; d < g->n_darts; d++)
    cord[d] = -1;
  for (int d = 0; d < g->n_darts; d++)
    if (mate[d] < 0 && cord[d] < 0) label_cord(mate, d, n++, cord);
  for (int d = 0; d < g->n_darts; d++)
    if (cord[d] < 0) label_cord(mate, d, n++, cord);
  return n;
}

/* ---- pairs changed, and taken back ---- */

int thr_threading_places(const thr_threading *t, int v, int *place)
{
  const thr_multigraph *g = t->g;
  int n = 0;
  for (int i = g->first[v]; i < g->first[v + 1]; i++) {
    int p = t->at[g->dart[i]];
    if (t->place[p].in == g->dart[i]) place[n++] = p;
  }
  return n;
}

bool thr_threading_tied(const thr_threading *t, int v)
{
  const thr_frame *f = t->f;
  const thr_multigraph *g = t->g;
  int apart = thr_degree(f, v) - 1;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    t->parent[f->half[i] >> 1] = f->half[i] >> 1;
  for (int i = g->first[v]; i < g->first[v + 1] && apart > 0; i++) {
    int a = g->dart[i], b = t->mate[a];
    if (b > a && g->half[a] >= 0 && g->half[b] >= 0) apart -= thr_disjoint_join(t->parent, g->half[a] >> 1, g->half[b] >> 1);
  }
  return apart == 0;
}

void thr_threading_pair(thr_threading *t, int a, int b, int c, int d, thr_broken *old)
{
  for (int i = 0; i < 2 && old; i++) {
    int one = i ? b : a;
    old->pair[old->n][0] = one;
    old->pair[old->n++][1] = t->mate[one];
  }
  thr_set_pair(t->mate, a, b);
  thr_set_pair(t->mate, c, d);
}

void thr_threading_take_back(thr_threading *t, thr_broken *old)
{
  while (old->n > 0) {
    old->n--;
    thr_set_pair(t->mate, old->pair[old->n][0], old->pair[old->n][1]);
  }
}

bool thr_threading_keep(thr_threading *t, thr_broken *old)
{
  bool tied = true;
  for (int i = 0; i < old->n && t->tied && tied; i += 2)
    tied = thr_threading_tied(t, t->g->tail[old->pair[i][0]]);
  if (!tied) thr_threading_take_back(t, old);
  return tied;
}

/* ---- exchanges of two places ---- */

thr_exchange thr_threading_exchange(const thr_threading *t, int i, int k, bool crossed)
{
  const thr_place *p = &t->place[i], *q = &t->place[k];
  int b = crossed ? q->in : q->out, d = crossed ? q->out : q->in, change = crossed ? 0 : 1;
  if (p->cord != q->cord) change = thr_threading_closed(t, p->cord) || thr_threading_closed(t, q->cord) ? -1 : 0;
  double old = p->price + q->price, now = price_of(t, p->in, b) + price_of(t, p->out, d);
  return (thr_exchange){{p->in, b, p->out, d}, now - old, change};
}

void thr_threading_make(thr_threading *t, const thr_exchange *x, thr_broken *old)
{
  thr_threading_pair(t, x->made[0], x->made[1], x->made[2], x->made[3], old);
}

bool thr_threading_allows(thr_threading *t, const thr_exchange *x)
{
  thr_broken old = {0};
  if (x->extra >= THR_FORBIDDEN / 2) return false;
  if (!t->tied) return true;
  thr_threading_make(t, x, &old);
  if (!thr_threading_keep(t, &old)) return false;
  thr_threading_take_back(t, &old);
  return true;
}
