/* The shortest passes that hold as many closed cords as asked for. */
#include "graph/disjoint.h"
#include "lp/length/share.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of two cords that pass an edge, one may have both passes and the other the rest of the two: so all pairs of passes count as
 * cords, and what is left, the edges with an odd number of passes, is a set of circuits without a repeated edge. These sets are
 * the sums of loops. */
enum { MOST_LOOPS = 12, MOST_EDGES = 64 };

typedef struct {
  const thr_share *s;
  int k, n; /* component, cords */
  int n_edges;
  int edge[MOST_EDGES];
  int n_loops;
  uint64_t loop[MOST_LOOPS]; /* as sets of edge[] */
  uint64_t *set;             /* [2^n_loops] all even sets */
  int *circuits;             /* [2^n_loops] most that a set falls into */
  int n_simple, *simple;     /* sets that are one circuit without a repeated node */
} few;

static bool in(uint64_t set, int i)
{
  return set >> i & 1;
}

/* The loop that every edge beyond a spanning tree closes. False: there are too many. */
static bool find_loops(few *x, int *parent, uint64_t *way)
{
  const thr_frame *f = x->s->f;
  bool grown = true;
  uint64_t tree = 0;
  for (int v = 0; v < f->n_nodes; v++)
    parent[v] = v;
  for (int i = 0; i < x->n_edges; i++)
    if (thr_disjoint_join(parent, f->edge[x->edge[i]][0], f->edge[x->edge[i]][1])) tree |= UINT64_C(1) << i;
  memset(way, 0, (size_t)f->n_nodes * sizeof *way);
  for (int v = 0; v < f->n_nodes; v++) /* now: is it reached from the first node? */
    parent[v] = v == f->edge[x->edge[0]][0];
  while (grown) {
    grown = false;
    for (int i = 0; i < x->n_edges; i++) {
      const int *e = f->edge[x->edge[i]];
      if (!in(tree, i) || parent[e[0]] == parent[e[1]]) continue;
      int from = parent[e[0]] ? e[0] : e[1], to = parent[e[0]] ? e[1] : e[0];
      way[to] = way[from] | UINT64_C(1) << i;
      parent[to] = grown = true;
    }
  }
  for (int i = 0; i < x->n_edges; i++) {
    if (in(tree, i)) continue;
    if (x->n_loops == MOST_LOOPS) return false;
    const int *e = f->edge[x->edge[i]];
    x->loop[x->n_loops++] = (way[e[0]] ^ way[e[1]]) | UINT64_C(1) << i;
  }
  return true;
}

/* Is an even set one circuit that visits no node twice? degree[n_nodes] is 0 before and after. */
static bool is_simple(const few *x, uint64_t set, int *degree)
{
  const thr_frame *f = x->s->f;
  int most = 0, size = 0, walked = 0, start = -1;
  for (int i = 0; i < x->n_edges; i++)
    for (int s = 0; s < 2 && in(set, i); s++) {
      int *d = &degree[f->edge[x->edge[i]][s]];
      ++*d;
      if (*d > most) most = *d;
      size += s;
      start = i;
    }
  for (int i = 0; i < x->n_edges; i++)
    for (int s = 0; s < 2 && in(set, i); s++)
      degree[f->edge[x->edge[i]][s]] = 0;
  if (most != 2) return false;
  int v = f->edge[x->edge[start]][1];
  for (int i = start, found = 1; found; walked++) {
    found = 0;
    for (int j = 0; j < x->n_edges && !found; j++) {
      const int *e = f->edge[x->edge[j]];
      if (!in(set, j) || j == i || (e[0] != v && e[1] != v)) continue;
      v = e[0] == v ? e[1] : e[0];
      i = j;
      found = i != start;
    }
  }
  return walked == size;
}

/* All even sets, smallest numbers of loops first, and the most circuits that each falls into. */
static thr_status tabulate(few *x, thr_err *err)
{
  int n = 1 << x->n_loops, *degree = thr_calloc((size_t)x->s->f->n_nodes, sizeof *degree);
  x->set = thr_calloc((size_t)n, sizeof *x->set);
  x->circuits = thr_calloc((size_t)n, sizeof *x->circuits);
  x->simple = thr_calloc((size_t)n, sizeof *x->simple);
  thr_status st = degree && x->set && x->circuits && x->simple ? THR_OK : thr_nomem(err);
  for (int a = 1; a < n && !st; a++) {
    int last = 0;
    while (a >> (last + 1))
      last++;
    x->set[a] = x->set[a ^ 1 << last] ^ x->loop[last];
    x->circuits[a] = -1;
    if (is_simple(x, x->set[a], degree)) x->simple[x->n_simple++] = a;
  }
  free(degree);
  return st;
}

/* Sums of loops are numbered so that taking one away is an exclusive or. *one: a circuit with its lowest edge that leaves the
 * most. */
static int most_circuits(few *x, int a, int *one)
{
  int best = 0;
  if (a == 0) return 0;
  if (x->circuits[a] >= 0 && !one) return x->circuits[a];
  uint64_t lowest = x->set[a] & (~x->set[a] + 1);
  for (int i = 0; i < x->n_simple; i++) {
    uint64_t c = x->set[x->simple[i]];
    if (!(c & lowest) || (c & ~x->set[a])) continue;
    int n = 1 + most_circuits(x, a ^ x->simple[i], NULL);
    if (n <= best) continue;
    best = n;
    if (one) *one = x->simple[i];
  }
  return x->circuits[a] = best;
}

/* Passes over edge i that its cover and the set ask for. */
static int passes_of(const few *x, uint64_t set, int i)
{
  int cover = thr_plan_cover(x->s->f, x->s->o, x->edge[i]);
  return cover + (cover % 2 != in(set, i));
}

/* What set number a costs, with further pairs of passes over the cheapest edges if it needs them; INFINITY if no room is left.
 * passes (NULL ok) receives them. */
static double cost(few *x, int a, int *passes)
{
  const thr_frame *f = x->s->f;
  double sum = 0;
  int cords = most_circuits(x, a, NULL);
  for (int i = 0; i < x->n_edges; i++) {
    int n = passes_of(x, x->set[a], i);
    if (n > thr_plan_capacity(f, x->s->o, x->edge[i])) return INFINITY;
    cords += n / 2;
    sum += n * f->length[x->edge[i]];
    if (passes) passes[x->edge[i]] = n;
  }
  for (uint64_t full = 0; cords < x->n;) {
    int best = -1;
    for (int i = 0; i < x->n_edges; i++)
      if (!in(full, i) && (best < 0 || f->length[x->edge[i]] < f->length[x->edge[best]])) best = i;
    if (best < 0) return INFINITY;
    full |= UINT64_C(1) << best;
    int room = (thr_plan_capacity(f, x->s->o, x->edge[best]) - passes_of(x, x->set[a], best)) / 2;
    int more = x->n - cords < room ? x->n - cords : room;
    sum += 2 * more * f->length[x->edge[best]];
    cords += more;
    if (passes) passes[x->edge[best]] += 2 * more;
  }
  return sum;
}

static thr_status add_pairs(const few *x, const int *passes, thr_walks *w, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < x->n_edges; i++)
    for (int n = passes[x->edge[i]] / 2; n > 0 && !st; n--) {
      thr_walk pair = {2, thr_calloc(2, sizeof *pair.half), 0, true};
      if (!pair.half) return thr_nomem(err);
      pair.half[0] = 2 * x->edge[i];
      pair.half[1] = pair.half[0] ^ 1;
      st = thr_walks_add(w, x->s->f, pair, err);
    }
  return st;
}

/* The circuit of set number a as a walk. */
static thr_status add_circuit(const few *x, int a, thr_walks *w, thr_err *err)
{
  const thr_frame *f = x->s->f;
  int size = 0, n = 0;
  uint64_t left = x->set[a];
  for (int i = 0; i < x->n_edges; i++)
    size += in(left, i);
  thr_walk c = {size, thr_calloc((size_t)size, sizeof *c.half), 0, true};
  if (!c.half) return thr_nomem(err);
  for (int i = 0, at = -1; left; i = (i + 1) % x->n_edges) {
    const int *e = f->edge[x->edge[i]];
    if (!in(left, i) || (at >= 0 && e[0] != at && e[1] != at)) continue;
    int side = at >= 0 && e[1] == at;
    c.half[n++] = 2 * x->edge[i] + side;
    at = e[1 - side];
    left &= ~(UINT64_C(1) << i);
  }
  return thr_walks_add(w, f, c, err);
}

static thr_status solve(few *x, int *passes, thr_walks *w, bool *found, thr_err *err)
{
  int best = -1;
  double least = INFINITY;
  thr_walks new = {0};
  thr_status st = tabulate(x, err);
  for (int a = 0; a < 1 << x->n_loops && !st; a++) {
    double c = cost(x, a, NULL);
    if (c >= least * (1 - 1e-12)) continue;
    least = c;
    best = a;
  }
  *found = best >= 0;
  if (!*found) return st;
  cost(x, best, passes);
  st = add_pairs(x, passes, &new, err);
  for (int a = best, one = 0; a && !st; a ^= one) {
    most_circuits(x, a, &one);
    st = add_circuit(x, one, &new, err);
  }
  if (!st) st = thr_share_merge(x->s, x->n, &new, err);
  thr_walks_destroy(st ? &new : w);
  if (!st) *w = new;
  return st;
}

/* Too large for that: pairs of passes over the shortest edges with room for them. */
static thr_status add_shortest(few *x, int *passes, thr_walks *w, bool *found, thr_err *err)
{
  const thr_frame *f = x->s->f;
  thr_status st = THR_OK;
  *found = true;
  while (w->n_walks < x->n && !st) {
    int best = -1;
    for (int e = 0; e < f->n_edges; e++)
      if (x->s->component[f->edge[e][0]] == x->k && passes[e] + 2 <= thr_plan_capacity(f, x->s->o, e) &&
          (best < 0 || f->length[e] < f->length[best]))
        best = e;
    *found = best >= 0;
    if (!*found) return THR_OK;
    thr_walk pair = {2, thr_calloc(2, sizeof *pair.half), 0, true};
    if (!pair.half) return thr_nomem(err);
    pair.half[0] = 2 * best;
    pair.half[1] = pair.half[0] ^ 1;
    passes[best] += 2;
    st = thr_walks_add(w, f, pair, err);
  }
  return st;
}

thr_status thr_share_more(const thr_share *s, int k, int n, int *passes, thr_walks *w, bool *found, bool *least, thr_err *err)
{
  const thr_frame *f = s->f;
  few x = {.s = s, .k = k, .n = n};
  bool small = true;
  int *parent = thr_calloc((size_t)f->n_nodes, sizeof *parent);
  uint64_t *way = thr_calloc((size_t)f->n_nodes, sizeof *way);
  thr_status st = parent && way ? THR_OK : thr_nomem(err);
  for (int e = 0; e < f->n_edges && small; e++) {
    if (s->component[f->edge[e][0]] != k) continue;
    small = x.n_edges < MOST_EDGES;
    if (small) x.edge[x.n_edges++] = e;
  }
  if (!st) small = small && find_loops(&x, parent, way);
  if (!st) st = small ? solve(&x, passes, w, found, err) : add_shortest(&x, passes, w, found, err);
  *least = small;
  free(parent);
  free(way);
  free(x.set);
  free(x.circuits);
  free(x.simple);
  return st;
}
