/* Turns that tie the nodes. */
#include "tortuosity/tie.h"
#include "graph/disjoint.h"
#include "tortuosity/pairing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int thr_tie_need(const thr_turning_columns *c, int v, const int *passes, const int *ends)
{
  const thr_frame *f = c->f;
  int z = ends ? ends[v] : 0, sum = 0, most = 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++) {
    int m = passes[f->half[i] >> 1];
    sum += m;
    if (m > most) most = m;
  }
  int few = 2 * (thr_degree(f, v) - 1) + z - sum, many = 2 * most - sum - z, need = few > many ? few : many;
  return need > 0 ? need : (sum + z) % 2;
}

/* Have the edges at every node room for the passes that tie them? */
static thr_status check_room(const thr_turning_columns *c, thr_err *err)
{
  const thr_frame *f = c->f;
  for (int v = 0; v < f->n_nodes; v++) {
    int64_t room = 0, needed = 2 * (thr_degree(f, v) - 1) + (c->task->end_count ? c->task->end_count[v] : 0);
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      room += c->most[f->half[i] >> 1];
    if (room < needed)
      return thr_fail(err, THR_EINFEASIBLE, "node %s: its edges have room for %d passes, but tying them together takes %d",
                      f->name[v], (int)room, (int)needed);
  }
  return THR_OK;
}

thr_status thr_tie_possible(const thr_turning_columns *c, thr_err *err)
{
  const thr_frame *f = c->f;
  int *loose = thr_calloc((size_t)c->n_ends, sizeof *loose); /* passes that end at nodes with one edge, by equation */
  if (!loose) return thr_nomem(err);
  thr_status st = THR_OK;
  for (int v = 0; v < f->n_nodes; v++)
    if (thr_degree(f, v) == 1) loose[c->end_group[v]] += c->cover[f->half[f->first[v]] >> 1];
  for (int v = 0; v < f->n_nodes && !st; v++) {
    int k = c->end_group[v];
    if (thr_degree(f, v) != 1) continue;
    if (c->end_column[f->half[f->first[v]]] < 0)
      st = thr_fail(err, THR_EINFEASIBLE, "node %s has one edge only: with tube joints a cord must end there, but none may",
                    f->name[v]);
    else if (loose[k] > c->supply[k][1])
      st = thr_fail(err, THR_EINFEASIBLE,
                    "nodes with one edge only, such as %s, take %d ends with tube joints, but there are no more than %d in their "
                    "piece; ask for more --cords",
                    f->name[v], loose[k], c->supply[k][1]);
  }
  free(loose);
  return st ? st : check_room(c, err);
}

thr_status thr_tie_holds(const thr_turning_columns *c, const int *x, bool *tied, thr_err *err)
{
  const thr_frame *f = c->f;
  int *parent = thr_calloc(2 * (size_t)f->n_edges, sizeof *parent), apart = 0;
  if (!parent) return thr_nomem(err);
  for (int h = 0; h < 2 * f->n_edges; h++)
    parent[h] = h;
  for (int v = 0; v < f->n_nodes; v++)
    apart += thr_degree(f, v) - 1;
  for (int j = 0; j < c->first_extra; j++)
    if (x[j] > 0) apart -= thr_disjoint_join(parent, c->half[j][0], c->half[j][1]);
  *tied = apart == 0;
  free(parent);
  return THR_OK;
}

/* As many ends as there must be? */
static thr_status count_ends(const thr_turning_columns *c, const int *ends, bool *fit, thr_err *err)
{
  int *sum = thr_calloc((size_t)c->n_ends, sizeof *sum);
  if (!sum) return thr_nomem(err);
  *fit = true;
  for (int v = 0; v < c->f->n_nodes; v++) {
    int n = ends ? ends[v] : 0;
    sum[c->end_group[v]] += n;
    *fit &= n == 0 || c->end_column[c->f->half[c->f->first[v]]] >= 0;
  }
  for (int k = 0; k < c->n_ends; k++)
    *fit &= sum[k] >= c->supply[k][0] && sum[k] <= c->supply[k][1];
  free(sum);
  return THR_OK;
}

/* ---- one node ---- */

enum { END = -1, EXACT = 10 }; /* largest node that begins with its cheapest pairing */

static const double forbidden = 1e6;

void thr_knot_destroy(thr_knot *k)
{
  free(k->half);
  free(k->edge);
  free(k->mate);
  free(k->parent);
  free(k->price);
}

thr_status thr_knot_init(thr_knot *k, const thr_turning_columns *c, int n, thr_err *err)
{
  *k = (thr_knot){.c = c, .most = n};
  if (n > 5000) return thr_fail(err, THR_EINPUT, "a node with %d passes is too large to tie", n);
  size_t most = (size_t)n;
  k->half = thr_calloc(most, sizeof *k->half);
  k->edge = thr_calloc(most, sizeof *k->edge);
  k->mate = thr_calloc(most, sizeof *k->mate);
  k->parent = thr_calloc(most, sizeof *k->parent);
  k->price = thr_calloc(most * most, sizeof *k->price);
  return k->half && k->edge && k->mate && k->parent && k->price ? THR_OK : thr_nomem(err);
}

static int count_knot(const thr_turning_columns *c, int v, const int *passes, const int *ends)
{
  const thr_frame *f = c->f;
  int n = ends ? ends[v] : 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    n += passes[f->half[i] >> 1];
  return n;
}

static double price_between(const thr_knot *k, int g, int h)
{
  if (g == h) return forbidden;
  return g == END || h == END ? 0 : thr_turn_price(k->c->f, k->c->task->cost, g ^ 1, h);
}

static void fill_knot(thr_knot *k, int v, const int *passes, int ends)
{
  const thr_frame *f = k->c->f;
  k->n = 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    for (int p = passes[f->half[i] >> 1]; p > 0; p--) {
      k->edge[k->n] = i - f->first[v];
      k->half[k->n++] = f->half[i];
    }
  for (; ends > 0; ends--)
    k->half[k->n++] = END;
  for (int a = 0; a < k->n; a++)
    for (int b = 0; b < k->n; b++) {
      double *row = k->price + a * k->n;
      if (a > 0 && k->half[a] == k->half[a - 1])
        row[b] = row[b - k->n]; /* passes of one edge are alike */
      else
        row[b] = b > 0 && k->half[b] == k->half[b - 1] ? row[b - 1] : price_between(k, k->half[a], k->half[b]);
    }
}

/* Does the pair turn, rather than end? */
static bool turns(const thr_knot *k, int a)
{
  return k->half[a] != END && k->half[k->mate[a]] != END;
}

/* Disjoint sets of the edges under all pairs but those of a and b (-1: none left out); how many of d edges. */
static int parts(thr_knot *k, int d, int a, int b)
{
  int left = d;
  for (int i = 0; i < d; i++)
    k->parent[i] = i;
  for (int i = 0; i < k->n; i++) {
    if (k->mate[i] < i || !turns(k, i) || i == a || i == b || k->mate[i] == a || k->mate[i] == b) continue;
    left -= thr_disjoint_join(k->parent, k->edge[i], k->edge[k->mate[i]]);
  }
  return left;
}

static void set_pair(thr_knot *k, int a, int b)
{
  k->mate[a] = b;
  k->mate[b] = a;
}

static double price_of(const thr_knot *k, int a, int b)
{
  return k->price[a * k->n + b];
}

/* Parts of the node's edges if pairs (a, mate) and (c, mate) became (a, c) and the mates. */
static int parts_after(thr_knot *k, int d, int a, int c)
{
  int b = k->mate[a], e = k->mate[c], left = parts(k, d, a, c);
  if (k->half[a] != END && k->half[c] != END) left -= thr_disjoint_join(k->parent, k->edge[a], k->edge[c]);
  if (k->half[b] != END && k->half[e] != END) left -= thr_disjoint_join(k->parent, k->edge[b], k->edge[e]);
  return left;
}

/* The cheapest exchange of two pairs that leaves fewer parts, or, if there is one part only, leaves it and saves. */
static bool exchange(thr_knot *k, int d, int now)
{
  double least = now > 1 ? forbidden : -1e-9;
  int best_a = -1, best_c = -1;
  for (int a = 0; a < k->n; a++) {
    int b = k->mate[a];
    for (int c = a + 1; c < k->n; c++) { /* (a c) and the mates: of both ways to exchange, as a and c run over all */
      int e = k->mate[c];
      if (c == b || b < a) continue;
      double extra = price_of(k, a, c) + price_of(k, b, e) - price_of(k, a, b) - price_of(k, c, e);
      if (extra >= least) continue;
      int after = parts_after(k, d, a, c);
      if (now > 1 ? after >= now : after > 1) continue;
      least = extra;
      best_a = a;
      best_c = c;
    }
  }
  if (best_a < 0) return false;
  int b = k->mate[best_a], e = k->mate[best_c];
  set_pair(k, best_a, best_c);
  set_pair(k, b, e);
  return true;
}

thr_status thr_knot_tie(thr_knot *k, int v, const int *passes, const int *ends, bool *tied, thr_err *err)
{
  int d = thr_degree(k->c->f, v);
  *tied = thr_tie_need(k->c, v, passes, ends) == 0 && count_knot(k->c, v, passes, ends) <= k->most;
  if (!*tied) return THR_OK;
  fill_knot(k, v, passes, ends ? ends[v] : 0);
  thr_status st = k->n <= EXACT ? thr_pairing_best(k->n, k->price, k->mate, err) : THR_OK;
  if (st) return st;
  for (int a = 0; a < k->n / 2 && k->n > EXACT; a++)
    set_pair(k, a, a + k->n / 2); /* no edge has more than half of all */
  int now = parts(k, d, -1, -1);
  while (d > 1 && exchange(k, d, now))
    now = parts(k, d, -1, -1);
  k->turning = thr_pairing_price(k->n, k->price, k->mate);
  *tied = (d == 1 || now == 1) && k->turning < forbidden;
  return THR_OK;
}

static void count_turns(const thr_knot *k, int *x)
{
  for (int a = 0; a < k->n; a++) {
    int b = k->mate[a], g = k->half[a], h = k->half[b];
    if (b < a) continue;
    if (h == END)
      x[k->c->end_column[g]]++;
    else
      x[thr_turning_column(k->c, g, h)]++;
  }
}

thr_status thr_tie_pair(const thr_turning_columns *c, const int *passes, const int *ends, int *x, bool *found, thr_err *err)
{
  const thr_frame *f = c->f;
  thr_knot k = {0};
  int most = 0;
  thr_status st = count_ends(c, ends, found, err);
  for (int v = 0; v < f->n_nodes && !st && *found; v++) {
    int n = count_knot(c, v, passes, ends);
    if (n > most) most = n;
    *found = thr_tie_need(c, v, passes, ends) == 0;
  }
  if (st || !*found) return st;
  memset(x, 0, (size_t)c->first_extra * sizeof *x);
  memset(x + c->first_end, 0, (size_t)(c->n_columns - c->first_end) * sizeof *x);
  st = thr_knot_init(&k, c, most, err);
  for (int v = 0; v < f->n_nodes && !st && *found; v++) {
    st = thr_knot_tie(&k, v, passes, ends, found, err);
    if (!st && *found) count_turns(&k, x);
  }
  thr_knot_destroy(&k);
  return st;
}
