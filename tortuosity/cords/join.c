/* The multigraph of passes, and pairs as a point or cords say. */
#include "tortuosity/cords/join.h"
#include "graph/disjoint.h"
#include "tortuosity/tie/tie.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the multigraph ---- */

static void sort_darts(thr_multigraph *g)
{
  for (int d = 0; d < g->n_darts; d++)
    g->first[g->tail[d] + 2]++;
  for (int v = 1; v <= g->n_nodes; v++)
    g->first[v + 1] += g->first[v];
  for (int d = 0; d < g->n_darts; d++)
    g->dart[g->first[g->tail[d] + 1]++] = d;
}

static void add_copy(thr_multigraph *g, int *n, int half, int a, int b)
{
  g->half[*n] = half;
  g->tail[(*n)++] = a;
  g->half[*n] = half < 0 ? -1 : half ^ 1;
  g->tail[(*n)++] = b;
}

thr_status thr_join_init(thr_join *j, const thr_turning_columns *c, const int *passes, const int *ends, thr_err *err)
{
  const thr_frame *f = c->f;
  int64_t copies = 0;
  int n = 0;
  *j = (thr_join){.c = c};
  for (int e = 0; e < f->n_edges; e++)
    copies += passes[e];
  for (int v = 0; ends && v < f->n_nodes; v++)
    copies += ends[v];
  if (copies > INT_MAX / 4) return thr_fail(err, THR_EINPUT, "more than %d passes; use a smaller --cover", INT_MAX / 4);
  size_t darts = 2 * (size_t)copies;
  thr_multigraph *g = &j->g;
  *g = (thr_multigraph){.n_darts = (int)darts, .n_nodes = f->n_nodes + c->n_components};
  g->half = thr_calloc(darts, sizeof *g->half);
  g->tail = thr_calloc(darts, sizeof *g->tail);
  g->dart = thr_calloc(darts, sizeof *g->dart);
  g->first = thr_calloc((size_t)g->n_nodes + 2, sizeof *g->first);
  j->mate = thr_calloc(darts, sizeof *j->mate);
  if (!g->half || !g->tail || !g->dart || !g->first || !j->mate) {
    thr_join_destroy(j);
    return thr_nomem(err);
  }
  for (int e = 0; e < f->n_edges; e++)
    for (int k = 0; k < passes[e]; k++)
      add_copy(g, &n, 2 * e, f->edge[e][0], f->edge[e][1]);
  for (int v = 0; ends && v < f->n_nodes; v++)
    for (int k = 0; k < ends[v]; k++)
      add_copy(g, &n, -1, v, f->n_nodes + c->component[v]);
  sort_darts(g);
  for (int d = 0; d < g->n_darts; d++)
    j->mate[d] = -1;
  for (int v = 0; v < f->n_nodes; v++)
    if ((g->first[v + 1] - g->first[v]) % 2) {
      thr_join_destroy(j);
      thr_fail(err, THR_EINPUT, "node %s has an odd number of passes and ends", f->name[v]);
      return THR_EINPUT;
    }
  return THR_OK;
}

bool thr_join_open(const thr_join *j, int component)
{
  const int *first = j->g.first + j->c->f->n_nodes + component;
  return first[1] > first[0];
}

int thr_join_count(const thr_join *j)
{
  const int *first = j->g.first + j->c->f->n_nodes;
  int n = 0;
  for (int k = 0; k < j->c->n_components; k++)
    n += thr_join_open(j, k) ? (first[k + 1] - first[k]) / 2 : j->c->task->end_allowed ? 1 : j->c->task->cords;
  return n;
}

void thr_join_destroy(thr_join *j)
{
  thr_multigraph_destroy(&j->g);
  free(j->mate);
  *j = (thr_join){0};
}

double thr_join_price(const thr_join *j, int a, int b)
{
  int ha = j->g.half[a], hb = j->g.half[b];
  if (ha < 0 || hb < 0) return ha == hb ? thr_join_forbidden : 0;
  if (ha != hb) return (double)j->c->weight[thr_turning_column(j->c, ha, hb)] * 0x1p-44; /* 2^-THR_TURNING_BITS */
  return thr_degree(j->c->f, j->g.tail[a]) == 1 ? thr_turn_price(j->c->f, j->c->task->cost, ha ^ 1, ha) : thr_join_forbidden;
}

void thr_join_measure(thr_join *j)
{
  j->price = 0;
  for (int d = 0; d < j->g.n_darts; d++)
    if (j->mate[d] > d) j->price += thr_join_price(j, d, j->mate[d]);
}

static void set_pair(int *mate, int a, int b)
{
  mate[a] = b;
  mate[b] = a;
}

/* ---- pairs as given ---- */

/* Free darts by half-edge: the next one of each is taken off its list. */
typedef struct {
  int *head;      /* [2 * n_edges] first free dart of a half-edge, -1 = none */
  int *next;      /* [n_darts] */
  int *end_first; /* [n_nodes] first free virtual dart */
} stock;

static int take(int *head, const int *next)
{
  int d = *head;
  if (d >= 0) *head = next[d];
  return d;
}

static void pair_columns(thr_join *j, const int *x, stock *s)
{
  const thr_turning_columns *c = j->c;
  for (int k = 0; k < c->n_columns; k++) {
    if (k >= c->first_extra && k < c->first_end) continue;
    for (int i = 0; i < x[k]; i++) {
      int half_a = c->half[k][0], half_b = c->half[k][1];
      int a = take(&s->head[half_a], s->next);
      int b = take(half_b >= 0 ? &s->head[half_b] : &s->end_first[thr_tail(c->f, half_a)], s->next);
      if (a >= 0 && b >= 0) set_pair(j->mate, a, b);
    }
  }
}

/* Numbers of circuits into circuit[] (by their first dart); a chain that ends at an end node has number n_darts + component. */
static void label_circuits(const thr_join *j, int *circuit)
{
  const thr_multigraph *g = &j->g;
  int nodes = j->c->f->n_nodes;
  for (int d = 0; d < g->n_darts; d++)
    circuit[d] = -1;
  for (int v = nodes; v < g->n_nodes; v++)
    for (int i = g->first[v]; i < g->first[v + 1]; i++)
      for (int d = g->dart[i]; d >= 0 && circuit[d] < 0; d = j->mate[d ^ 1])
        circuit[d] = circuit[d ^ 1] = g->n_darts + v - nodes;
  for (int start = 0; start < g->n_darts; start++)
    for (int d = start; circuit[d] < 0; d = j->mate[d ^ 1])
      circuit[d] = circuit[d ^ 1] = start;
}

/* Equal passes change their partners at one node if that joins two circuits: same turns, fewer circuits. */
static void join_equal_passes(thr_join *j, const int *circuit, int *parent)
{
  thr_multigraph *g = &j->g;
  for (int d = 0; d + 2 < g->n_darts; d += 2) {
    if (g->half[d] < 0 || g->half[d] != g->half[d + 2]) continue;
    if (!thr_disjoint_join(parent, circuit[d], circuit[d + 2])) continue;
    int a = j->mate[d], b = j->mate[d + 2];
    set_pair(j->mate, d, b);
    set_pair(j->mate, d + 2, a);
  }
}

/* Is every circuit the first of its component, or joined to the ends? */
static bool all_joined(const thr_join *j, const int *circuit, int *parent)
{
  const thr_turning_columns *c = j->c;
  bool joined = true;
  int *root = parent + j->g.n_darts; /* the entries of end nodes without ends are free */
  for (int k = 0; k < c->n_components; k++)
    if (!thr_join_open(j, k)) root[k] = -1;
  for (int d = 0; d < j->g.n_darts; d++) {
    int k = j->g.tail[d] < c->f->n_nodes ? c->component[j->g.tail[d]] : -1;
    if (k < 0) continue;
    int own = thr_disjoint_find(parent, circuit[d]);
    bool open = thr_join_open(j, k);
    if (!open && root[k] < 0) root[k] = own;
    joined &= own == (open ? thr_disjoint_find(parent, j->g.n_darts + k) : root[k]);
  }
  return joined;
}

thr_status thr_join_columns(thr_join *j, const int *x, bool *single, thr_err *err)
{
  const thr_frame *f = j->c->f;
  size_t darts = (size_t)j->g.n_darts, all = darts + (size_t)j->c->n_components;
  stock s = {thr_calloc(2 * (size_t)f->n_edges, sizeof *s.head), thr_calloc(darts, sizeof *s.next),
             thr_calloc((size_t)f->n_nodes, sizeof *s.end_first)};
  int *circuit = thr_calloc(darts, sizeof *circuit), *parent = thr_calloc(all, sizeof *parent);
  thr_status st = s.head && s.next && s.end_first && circuit && parent ? THR_OK : thr_nomem(err);
  *single = false;
  if (!st) {
    for (int h = 0; h < 2 * f->n_edges; h++)
      s.head[h] = -1;
    for (int v = 0; v < f->n_nodes; v++)
      s.end_first[v] = -1;
    for (int d = j->g.n_darts - 1; d >= 0; d--) {
      if (j->g.tail[d] >= f->n_nodes) continue;
      int *head = j->g.half[d] >= 0 ? &s.head[j->g.half[d]] : &s.end_first[j->g.tail[d]];
      s.next[d] = *head;
      *head = d;
    }
    pair_columns(j, x, &s);
    for (int d = 0; d < j->g.n_darts && !st; d++)
      if (j->mate[d] < 0 && j->g.tail[d] < f->n_nodes) st = thr_fail(err, THR_ESOLVER, "turns do not fit the passes");
  }
  if (!st) {
    for (size_t d = 0; d < all; d++)
      parent[d] = (int)d;
    label_circuits(j, circuit);
    join_equal_passes(j, circuit, parent);
    *single = all_joined(j, circuit, parent);
    thr_join_measure(j);
  }
  free(s.head);
  free(s.next);
  free(s.end_first);
  free(circuit);
  free(parent);
  return st;
}

/* ---- tied ---- */

thr_status thr_join_tie(thr_join *j, const thr_turning_columns *c, const int *passes, const int *ends, bool *found, thr_err *err)
{
  bool single;
  int *x = thr_calloc((size_t)c->n_columns, sizeof *x);
  *j = (thr_join){0};
  thr_status st = x ? thr_tie_pair(c, passes, ends, x, found, err) : thr_nomem(err);
  if (!st && *found) st = thr_join_init(j, c, passes, ends, err);
  if (!st && *found) st = thr_join_columns(j, x, &single, err);
  if (st) thr_join_destroy(j);
  free(x);
  return st;
}

bool thr_join_tied(const thr_join *j, int v, int *parent)
{
  const thr_turning_columns *c = j->c;
  const thr_multigraph *g = &j->g;
  int d = thr_degree(c->f, v), apart = d - 1;
  for (int i = 0; i < d; i++)
    parent[i] = i;
  for (int i = g->first[v]; i < g->first[v + 1] && apart > 0; i++) {
    int a = g->dart[i], b = j->mate[a];
    if (b > a && g->half[a] >= 0 && g->half[b] >= 0)
      apart -= thr_disjoint_join(parent, c->position[g->half[a]], c->position[g->half[b]]);
  }
  return apart == 0;
}

/* ---- from cords ---- */

/* Takes the next free copy of an edge (or virtual edge at a node) and gives the dart that runs along half-edge h. */
static int next_copy(const thr_multigraph *g, int *cursor, int h)
{
  int d = cursor[h >> 1];
  cursor[h >> 1] += 2;
  return g->half[d] == h ? d : d ^ 1;
}

/* first_copy[e] = first dart of edge e; after the edges, of the virtual edges at node v. */
static void find_copies(const thr_join *j, int *first_copy)
{
  int m = j->c->f->n_edges;
  for (int d = j->g.n_darts - 2; d >= 0; d -= 2)
    first_copy[j->g.half[d] >= 0 ? j->g.half[d] >> 1 : m + j->g.tail[d]] = d;
}

static void pair_cord(thr_join *j, const thr_cord *c, int *cursor)
{
  const thr_frame *f = j->c->f;
  bool open = j->c->task->end_allowed != NULL;
  int first = -1, last = -1;
  if (open) {
    int *from = &cursor[f->n_edges + thr_tail(f, c->half[0])];
    last = *from;
    *from += 2;
  }
  for (int i = 0; i < c->n_passes; i++) {
    int d = next_copy(&j->g, cursor, c->half[i]);
    if (first < 0) first = d;
    if (last >= 0) set_pair(j->mate, last, d);
    last = d ^ 1;
  }
  set_pair(j->mate, last, open ? cursor[f->n_edges + thr_head(f, c->half[c->n_passes - 1])] : first);
  if (open) cursor[f->n_edges + thr_head(f, c->half[c->n_passes - 1])] += 2;
}

thr_status thr_join_from_cords(thr_join *j, const thr_turning_columns *c, const thr_cord *cord, int n_cords, thr_err *err)
{
  const thr_frame *f = c->f;
  size_t m = (size_t)f->n_edges, n = (size_t)f->n_nodes;
  int *count = thr_calloc(m + n, sizeof *count), *cursor = thr_calloc(m + n, sizeof *cursor);
  thr_status st = count && cursor ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n_cords && !st; i++) {
    for (int k = 0; k < cord[i].n_passes; k++)
      count[cord[i].half[k] >> 1]++;
    if (!c->task->end_allowed) continue;
    count[m + (size_t)thr_cord_start(f, &cord[i])]++;
    count[m + (size_t)thr_cord_end(f, &cord[i])]++;
  }
  if (!st) st = thr_join_init(j, c, count, count + m, err);
  if (!st) {
    find_copies(j, cursor);
    for (int i = 0; i < n_cords; i++)
      pair_cord(j, &cord[i], cursor);
    thr_join_measure(j);
  }
  free(count);
  free(cursor);
  return st;
}
