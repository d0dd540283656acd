/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/truth.h"
#include "graph/plan/turning_proof.h"
#include "tests/support.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- least length ---- */

/* A component and one choice of which edges have an extra pass. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  int n_edges, edge[TRUTH_EDGES];         /* of the component, by ascending length */
  signed char circuits[1 << TRUTH_EDGES]; /* most circuits that a set of edges falls into; -1: a
                                             node has an odd number */
  int passes[TRUTH_EDGES],
      least[TRUTH_EDGES]; /* by edge of the framework: as chosen; of the best choice */
  double best;
} piece;

static int need(const piece *p, int e)
{
  int own = p->f->cover ? p->f->cover[e] : 1;
  return own > p->o->cover ? own : p->o->cover;
}

/* How many passes more of the edge fit. */
static int room(const piece *p, int e)
{
  int own = p->f->capacity && p->f->capacity[e] ? p->f->capacity[e] : INT_MAX,
      all = p->o->capacity ? p->o->capacity : INT_MAX;
  return (own < all ? own : all) - p->passes[e];
}

static bool may_end(const thr_frame *f, const thr_request *o, int v)
{
  switch (o->ends) {
  case THR_ENDS_CLOSED: return false;
  case THR_ENDS_ANY: return true;
  case THR_ENDS_FEET: return f->foot[v];
  case THR_ENDS_NODES: return o->end_node[v];
  default: return o->end_count[v] > 0;
  }
}

static unsigned odd_nodes(const piece *p, unsigned edges)
{
  unsigned odd = 0;
  for (int i = 0; i < p->n_edges; i++)
    if (edges >> i & 1u) odd ^= 1u << p->f->edge[p->edge[i]][0] ^ 1u << p->f->edge[p->edge[i]][1];
  return odd;
}

/* Sets are met after their parts. Which part is one circuit needs no asking: a part that is several
 * counts for less. */
static void count_circuits(piece *p)
{
  for (unsigned s = 0; s < 1u << p->n_edges; s++) {
    p->circuits[s] = odd_nodes(p, s) ? -1 : s > 0;
    for (unsigned part = (s - 1) & s; part > 0 && p->circuits[s] > 0; part = (part - 1) & s) {
      int both = p->circuits[part] < 0 || p->circuits[s ^ part] < 0
                     ? 0
                     : p->circuits[part] + p->circuits[s ^ part];
      if (both > p->circuits[s]) p->circuits[s] = (signed char)both;
    }
  }
}

static void keep(piece *p)
{
  double length = 0;
  for (int i = 0; i < p->n_edges; i++)
    length += p->passes[p->edge[i]] * p->f->length[p->edge[i]];
  if (length >= p->best) return;
  p->best = length;
  memcpy(p->least, p->passes, sizeof p->least);
}

/* So many pairs of passes over the shortest edges that have `ends` nodes where a cord may end;
 * false: no room. ends < 0: any. */
static bool add_pairs(piece *p, int pairs, int ends)
{
  for (int i = 0; i < p->n_edges && pairs > 0; i++) {
    int e = p->edge[i],
        a = may_end(p->f, p->o, p->f->edge[e][0]) + may_end(p->f, p->o, p->f->edge[e][1]);
    if (ends >= 0 && a != ends) continue;
    int n = room(p, e) / 2 < pairs ? room(p, e) / 2 : pairs;
    p->passes[e] += 2 * n;
    pairs -= n;
  }
  return pairs <= 0;
}

static void try_closed(piece *p)
{
  unsigned odd = 0;
  int circuits = 0;
  for (int i = 0; i < p->n_edges; i++) {
    circuits += p->passes[p->edge[i]] / 2;
    odd |= (unsigned)(p->passes[p->edge[i]] % 2) << i;
  }
  if (p->circuits[odd] < 0) return;
  if (add_pairs(p, p->o->cords_least - circuits - p->circuits[odd], -1)) keep(p);
}

static void try_free_ends(piece *p)
{
  int at[TRUTH_NODES] = {0}, places = 0, odd = 0, before[TRUTH_EDGES];
  for (int i = 0; i < p->n_edges; i++)
    for (int k = 0; k < 2; k++)
      at[p->f->edge[p->edge[i]][k]] += p->passes[p->edge[i]];
  for (int v = 0; v < p->f->n_nodes; v++) {
    if (at[v] % 2 && !may_end(p->f, p->o, v)) return;
    odd += at[v] % 2;
    if (may_end(p->f, p->o, v)) places += at[v];
  }
  int cords = odd / 2 > p->o->cords_least ? odd / 2 : p->o->cords_least;
  if (cords > p->o->cords) return;
  int missing = (2 * cords - places + 1) / 2; /* pairs, at one node where an end may be */
  memcpy(before, p->passes, sizeof before);
  for (int both = 0; both <= (missing > 0 ? (missing + 1) / 2 : 0); both++) {
    memcpy(p->passes, before, sizeof before);
    if (add_pairs(p, both, 2) && add_pairs(p, missing - 2 * both, 1)) keep(p);
  }
}

/* Pairs of passes for the first node that has fewer passes than ends, over each of its edges in
 * turn. */
static void try_counts(piece *p)
{
  int at[TRUTH_NODES] = {0}, before[TRUTH_EDGES], v = 0;
  for (int i = 0; i < p->n_edges; i++)
    for (int k = 0; k < 2; k++)
      at[p->f->edge[p->edge[i]][k]] += p->passes[p->edge[i]];
  for (int i = 0; i < 2 * p->n_edges; i++) {
    int u = p->f->edge[p->edge[i / 2]][i % 2];
    if ((at[u] - p->o->end_count[u]) % 2) return;
  }
  while (v < p->f->n_nodes && (at[v] == 0 || at[v] >= p->o->end_count[v]))
    v++;
  if (v == p->f->n_nodes) {
    keep(p);
    return;
  }
  memcpy(before, p->passes, sizeof before);
  for (int i = 0; i < p->n_edges; i++) {
    int e = p->edge[i], missing = (p->o->end_count[v] - at[v]) / 2,
        n = room(p, e) / 2 < missing ? room(p, e) / 2 : missing;
    if ((p->f->edge[e][0] != v && p->f->edge[e][1] != v) || n <= 0) continue;
    p->passes[e] += 2 * n;
    try_counts(p);
    memcpy(p->passes, before, sizeof before);
  }
}

/* Every choice of edges with an extra pass, and the cheapest pairs beside it. */
static double piece_length(piece *p)
{
  p->best = INFINITY;
  for (int i = 1; i < p->n_edges; i++) /* insertion sort */
    for (int k = i; k > 0 && p->f->length[p->edge[k]] < p->f->length[p->edge[k - 1]]; k--) {
      int e = p->edge[k];
      p->edge[k] = p->edge[k - 1];
      p->edge[k - 1] = e;
    }
  count_circuits(p);
  for (unsigned s = 0; s < 1u << p->n_edges; s++) {
    bool fits = true;
    for (int i = 0; i < p->n_edges; i++) {
      int e = p->edge[i];
      p->passes[e] = need(p, e) + (int)(s >> i & 1u);
      fits &= room(p, e) >= 0;
    }
    if (!fits) continue;
    if (p->o->ends == THR_ENDS_CLOSED)
      try_closed(p);
    else if (p->o->ends == THR_ENDS_COUNTS)
      try_counts(p);
    else
      try_free_ends(p);
  }
  return p->best;
}

double truth_length(const thr_frame *f, const thr_request *o, int *passes)
{
  int component[TRUTH_NODES], n;
  double sum = 0;
  piece *p = calloc(1, sizeof *p);
  ck_assert(p != NULL && f->n_nodes <= TRUTH_NODES && f->n_edges <= TRUTH_EDGES);
  ck_assert_int_eq(thr_frame_components(f, component, &n, NULL), THR_OK);
  for (int c = 0; c < n; c++) {
    *p = (piece){.f = f, .o = o};
    for (int e = 0; e < f->n_edges; e++)
      if (component[f->edge[e][0]] == c) p->edge[p->n_edges++] = e;
    sum += piece_length(p);
    for (int i = 0; i < p->n_edges && passes; i++)
      passes[p->edge[i]] = p->least[p->edge[i]];
  }
  free(p);
  return sum;
}

/* ---- tables ---- */

enum { MOST_HALF = 2 * TRUTH_TABLE_EDGES };

static int digit(const truth_table *t, int x, int e)
{
  for (; e > 0; e--)
    x /= t->most + 1;
  return x % (t->most + 1);
}

static int step_of(const truth_table *t, int e)
{
  int step = 1;
  for (; e > 0; e--)
    step *= t->most + 1;
  return step;
}

static bool one_cord(const truth_table *t, int x)
{
  const thr_frame *f = t->f;
  int at[TRUTH_NODES] = {0}, odd = 0;
  unsigned seen = 0, all = 0;
  bool end = t->o->ends == THR_ENDS_CLOSED;
  for (int e = 0; e < f->n_edges; e++)
    for (int k = 0, n = digit(t, x, e); k < 2; k++) {
      at[f->edge[e][k]] += n;
      if (n > 0) all |= 1u << f->edge[e][k];
    }
  for (int v = 0; v < f->n_nodes; v++) {
    if (at[v] % 2 && !may_end(f, t->o, v)) return false;
    odd += at[v] % 2;
    end |= at[v] > 0 && may_end(f, t->o, v);
    if (at[v] > 0 && !seen) seen = 1u << v;
  }
  for (int i = 0; i < f->n_nodes; i++)
    for (int e = 0; e < f->n_edges; e++) {
      unsigned both = 1u << f->edge[e][0] | 1u << f->edge[e][1];
      if (digit(t, x, e) > 0 && seen & both) seen |= both;
    }
  return x > 0 && end && odd <= 2 && seen == all;
}

static double turn(const truth_table *t, int in, int out)
{
  const thr_frame *f = t->f;
  if (in == (out ^ 1) && thr_degree(f, thr_tail(f, out)) > 1) return INFINITY;
  return thr_turn_price(f, t->o->turning.cost, in, out);
}

/* Walks from half-edge first, numbers of passes ascending: least[x * MOST_HALF + h] of those that
 * make passes x and arrive over h. */
static void walk_from(truth_table *t, int first, const double price[MOST_HALF][MOST_HALF],
                      long double *least)
{
  const thr_frame *f = t->f;
  bool closed = t->o->ends == THR_ENDS_CLOSED;
  for (int i = 0; i < t->size * MOST_HALF; i++)
    least[i] = INFINITY;
  least[step_of(t, first >> 1) * MOST_HALF + first] = 0;
  for (int x = 1; x < t->size; x++)
    for (int h = 0; h < 2 * f->n_edges; h++) {
      long double so_far = least[x * MOST_HALF + h];
      if (so_far == INFINITY) continue;
      double end = closed ? (thr_head(f, h) == thr_tail(f, first) ? price[h][first] : INFINITY)
                          : (may_end(f, t->o, thr_head(f, h)) ? 0 : INFINITY);
      t->price[x] = fminl(t->price[x], so_far + end);
      for (int g = 0; g < 2 * f->n_edges; g++) {
        if (thr_tail(f, g) != thr_head(f, h) || digit(t, x, g >> 1) == t->most) continue;
        long double *next = &least[(x + step_of(t, g >> 1)) * MOST_HALF + g];
        *next = fminl(*next, so_far + price[h][g]);
      }
    }
}

truth_table truth_table_make(const thr_frame *f, const thr_request *o, int most)
{
  truth_table t = {.f = f, .o = o, .most = most, .size = 1};
  double price[MOST_HALF][MOST_HALF];
  ck_assert_int_le(f->n_edges, TRUTH_TABLE_EDGES);
  t.size = step_of(&t, f->n_edges);
  t.length = calloc((size_t)t.size, sizeof *t.length);
  t.price = calloc((size_t)t.size, sizeof *t.price);
  t.runs = calloc((size_t)t.size, sizeof *t.runs);
  long double *least = calloc((size_t)t.size * MOST_HALF, sizeof *least);
  ck_assert(t.length && t.price && t.runs && least);
  for (int x = 0; x < t.size; x++) {
    t.price[x] = INFINITY;
    t.runs[x] = one_cord(&t, x);
    for (int e = 0; e < f->n_edges; e++)
      t.length[x] += digit(&t, x, e) * f->length[e];
  }
  for (int h = 0; h < 2 * f->n_edges; h++)
    for (int g = 0; g < 2 * f->n_edges; g++)
      price[h][g] = thr_head(f, h) == thr_tail(f, g) ? turn(&t, h, g) : INFINITY;
  for (int h = 0; h < 2 * f->n_edges; h++)
    if (o->ends == THR_ENDS_CLOSED || may_end(f, o, thr_tail(f, h)))
      walk_from(&t, h, (const double(*)[MOST_HALF])price, least);
  free(least);
  return t;
}

void truth_table_destroy(truth_table *t)
{
  free(t->length);
  free(t->price);
  free(t->runs);
  *t = (truth_table){0};
}

/* ---- several cords ---- */

/* Of the passes of all cords, what is more than cover is not told apart, unless there are
 * capacities. */
typedef struct {
  const truth_table *t;
  int base, size, cover[TRUTH_TABLE_EDGES], most[TRUTH_TABLE_EDGES];
} sums;

static sums sums_make(const truth_table *t)
{
  sums s = {.t = t, .base = 2, .size = 1};
  const piece p = {.f = t->f, .o = t->o};
  for (int e = 0; e < t->f->n_edges; e++) {
    s.cover[e] = need(&p, e);
    s.most[e] = room(&p, e);
    if (s.cover[e] + 1 > s.base) s.base = s.cover[e] + 1;
    if (s.most[e] < INT_MAX && s.most[e] + 1 > s.base) s.base = s.most[e] + 1;
  }
  for (int e = 0; e < t->f->n_edges; e++)
    s.size *= s.base;
  return s;
}

/* Of the sum and one cord more; -1: an edge has no room. */
static int plus(const sums *s, int sum, int x)
{
  int out = 0;
  for (int e = 0, step = 1; e < s->t->f->n_edges; e++, step *= s->base) {
    int n = sum / step % s->base + digit(s->t, x, e);
    if (n > s->most[e]) return -1;
    out += step * (s->most[e] == INT_MAX && n > s->cover[e] ? s->cover[e] : n);
  }
  return out;
}

static bool covered(const sums *s, int sum)
{
  for (int e = 0, step = 1; e < s->t->f->n_edges; e++, step *= s->base)
    if (sum / step % s->base < s->cover[e]) return false;
  return true;
}

/* The least of the largest value of n cords. */
static long double least_largest(const truth_table *t, int n, const long double *value)
{
  sums s = sums_make(t);
  long double best = INFINITY, *now = calloc((size_t)s.size, sizeof *now),
              *next = calloc((size_t)s.size, sizeof *next);
  ck_assert(now && next);
  for (int i = 0; i < s.size; i++)
    now[i] = i ? INFINITY : 0;
  for (; n > 0; n--) {
    for (int i = 0; i < s.size; i++)
      next[i] = INFINITY;
    for (int i = 0; i < s.size; i++)
      for (int x = 1; x < t->size && now[i] < INFINITY; x++) {
        int sum = value[x] < INFINITY ? plus(&s, i, x) : -1;
        if (sum >= 0) next[sum] = fminl(next[sum], fmaxl(now[i], value[x]));
      }
    memcpy(now, next, (size_t)s.size * sizeof *now);
  }
  for (int i = 0; i < s.size; i++)
    if (covered(&s, i)) best = fminl(best, now[i]);
  free(now);
  free(next);
  return best;
}

double truth_longest(const truth_table *t, int n)
{
  long double *value = calloc((size_t)t->size, sizeof *value);
  ck_assert(value != NULL);
  for (int x = 0; x < t->size; x++)
    value[x] = t->runs[x] ? t->length[x] : INFINITY;
  double least = (double)least_largest(t, n, value);
  free(value);
  return least;
}

/* left cords more, none before x in the table. */
static void choose(const sums *s, int left, int from, int sum, long double price, double length,
                   double limit, long double *best)
{
  const truth_table *t = s->t;
  if (price >= *best || (limit >= 0 && length > limit)) return;
  if (left == 0) {
    if (covered(s, sum)) *best = price;
    return;
  }
  for (int x = from; x < t->size; x++) {
    int more = t->price[x] < INFINITY ? plus(s, sum, x) : -1;
    if (more >= 0)
      choose(s, left - 1, x, more, price + t->price[x], length + t->length[x], limit, best);
  }
}

long double truth_price(const truth_table *t, int n, bool largest, double length_limit)
{
  long double best = INFINITY;
  if (largest) return least_largest(t, n, t->price);
  sums s = sums_make(t);
  choose(&s, n, 1, 0, 0, 0, length_limit, &best);
  return best;
}
