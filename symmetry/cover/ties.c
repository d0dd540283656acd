/* Stars of tubes, and what joins them. */
#include "symmetry/cover/ties.h"
#include "graph/disjoint.h"
#include "graph/framework/frame.h"

#include <stdlib.h>

void thr_ties_destroy(thr_ties *t)
{
  free(t->node);
  free(t->degree);
  free(t->nodes);
  free(t->star);
  free(t->first);
  free(t->pair);
  free(t->turns);
  free(t->join);
  free(t->link);
  *t = (thr_ties){0};
}

/* ---- stars ---- */

static thr_status allocate(thr_ties *t, const thr_quotient *q, thr_err *err)
{
  size_t nodes = (size_t)q->f->n_nodes, pairs = (size_t)q->n_pairs;
  t->node = thr_calloc(nodes, sizeof *t->node);
  t->degree = thr_calloc(nodes, sizeof *t->degree);
  t->nodes = thr_calloc(nodes, sizeof *t->nodes);
  t->star = thr_calloc((size_t)q->n_darts, sizeof *t->star);
  t->first = thr_calloc(nodes + 2, sizeof *t->first);
  t->pair = thr_calloc(pairs, sizeof *t->pair);
  t->turns = thr_calloc(pairs, sizeof *t->turns);
  t->join = thr_calloc(pairs + 1, sizeof *t->join);
  return t->node && t->degree && t->nodes && t->star && t->first && t->pair && t->turns && t->join ? THR_OK : thr_nomem(err);
}

/* of_node: [n_nodes] scratch. */
static void number_stars(thr_ties *t, const thr_quotient *q, const int *node_orbit, int *of_node)
{
  const thr_frame *f = q->f;
  for (int v = 0; v < f->n_nodes; v++) {
    int lowest = node_orbit[v], degree = thr_degree(f, v);
    if (lowest == v) {
      of_node[v] = degree > 1 ? t->n : -1;
      if (degree < 2) continue;
      t->node[t->n] = v;
      t->degree[t->n++] = degree;
      if (degree > t->most) t->most = degree;
    }
    if (of_node[lowest] >= 0) t->nodes[of_node[lowest]]++;
  }
  for (int d = 0; d < q->n_darts; d++)
    t->star[d] = of_node[node_orbit[thr_tail(f, q->dart[d].half)]];
}

static void list_pairs(thr_ties *t, const thr_quotient *q)
{
  for (int y = 0; y < q->n_pairs; y++) {
    int star = t->star[q->pair[y].dart[0]];
    if (star < 0) continue;
    t->turns[y] = q->pair[y].turns / t->nodes[star];
    t->first[star + 2]++;
  }
  for (int i = 1; i <= t->n; i++)
    t->first[i + 1] += t->first[i];
  for (int y = 0; y < q->n_pairs; y++)
    if (t->star[q->pair[y].dart[0]] >= 0) t->pair[t->first[t->star[q->pair[y].dart[0]] + 1]++] = y;
}

/* All but the links. */
static thr_status find_stars(thr_ties *t, const thr_quotient *q, const int *node_orbit, thr_err *err)
{
  *t = (thr_ties){0};
  thr_status st = allocate(t, q, err);
  int *of_node = thr_calloc((size_t)q->f->n_nodes, sizeof *of_node);
  if (!of_node) st = thr_nomem(err);
  if (!st) {
    number_stars(t, q, node_orbit, of_node);
    list_pairs(t, q);
  }
  free(of_node);
  return st;
}

/* ---- links ---- */

static int place_of(const thr_frame *f, int half)
{
  int k = f->first[thr_tail(f, half)];
  while (f->half[k] != half)
    k++;
  return k - f->first[thr_tail(f, half)];
}

static thr_status add_link(thr_ties *t, int y, int a, int b, int *capacity, thr_err *err)
{
  int n = t->join[y + 1], low = a < b ? a : b, high = a + b - low;
  for (int k = t->join[y]; k < n; k++)
    if (t->link[k][0] == low && t->link[k][1] == high) return THR_OK;
  thr_status st = thr_grow(&t->link, n, capacity, sizeof *t->link, err);
  if (st) return st;
  t->link[n][0] = low;
  t->link[n][1] = high;
  t->join[y + 1]++;
  return THR_OK;
}

thr_status thr_ties_init(thr_ties *t, const thr_quotient *q, const int *node_orbit, thr_err *err)
{
  const thr_frame *f = q->f;
  int capacity = 0;
  thr_status st = find_stars(t, q, node_orbit, err);
  for (int y = 0; y < q->n_pairs && !st; y++) {
    const thr_pair_type *p = &q->pair[y];
    int star = t->star[p->dart[0]];
    t->join[y + 1] = t->join[y];
    for (int i = 0; i < q->h->order && star >= 0 && !st; i++) {
      const int *to = &q->half_image[(size_t)i * 2 * (size_t)f->n_edges];
      if (thr_tail(f, to[p->half[0]]) != t->node[star]) continue;
      st = add_link(t, y, place_of(f, to[p->half[0]]), place_of(f, to[p->half[1]]), &capacity, err);
    }
  }
  if (st) thr_ties_destroy(t);
  return st;
}

thr_status thr_ties_contract(thr_ties *t, const thr_ties *whole, int whole_pairs, const thr_quotient *q, const int *node_orbit,
                             const int *pair, const bool *keep, thr_err *err)
{
  int capacity = 0;
  thr_status st = find_stars(t, q, node_orbit, err);
  int *from = thr_calloc((size_t)q->n_pairs, sizeof *from);
  if (!from) st = thr_nomem(err);
  for (int y = 0; y < whole_pairs && !st; y++)
    if (pair[y] >= 0 && keep[y]) from[pair[y]] = y + 1;
  for (int y = 0; y < q->n_pairs && !st; y++) {
    t->join[y + 1] = t->join[y];
    if (!from[y]) continue;
    for (int k = whole->join[from[y] - 1]; k < whole->join[from[y]] && !st; k++)
      st = add_link(t, y, whole->link[k][0], whole->link[k][1], &capacity, err);
  }
  free(from);
  if (st) thr_ties_destroy(t);
  return st;
}

/* ---- ties ---- */

int thr_ties_blocks(const thr_ties *t, int star, const double *value, double least, int *block)
{
  int n = 0;
  for (int i = 0; i < t->degree[star]; i++)
    block[i] = i;
  for (int i = t->first[star]; i < t->first[star + 1]; i++) {
    int y = t->pair[i];
    for (int k = t->join[y]; k < t->join[y + 1] && value[y] > least; k++)
      thr_disjoint_join(block, t->link[k][0], t->link[k][1]);
  }
  for (int i = 0; i < t->degree[star]; i++)
    block[i] = thr_disjoint_find(block, i);
  for (int i = 0; i < t->degree[star]; i++) /* a root is the lowest of its block, and has its number by then */
    block[i] = block[i] == i ? n++ : block[block[i]];
  return n;
}

int thr_ties_between(const thr_ties *t, int y, const int *block)
{
  if (t->join[y] == t->join[y + 1]) return t->turns[y];
  int n = 0, links = t->join[y + 1] - t->join[y];
  for (int k = t->join[y]; k < t->join[y + 1]; k++)
    n += block[t->link[k][0]] != block[t->link[k][1]];
  return n * (t->turns[y] / links); /* as many turns for each link: they are images of each other */
}

bool thr_ties_tied(const thr_ties *t, int star, const int *value, int *parent)
{
  long missing = t->degree[star] - 1;
  for (int i = 0; i < t->degree[star]; i++)
    parent[i] = i;
  for (int i = t->first[star]; i < t->first[star + 1] && missing > 0; i++) {
    int y = t->pair[i];
    if (value[y] > 0 && t->join[y] == t->join[y + 1]) missing -= (long)value[y] * t->turns[y];
    for (int k = t->join[y]; k < t->join[y + 1] && value[y] > 0; k++)
      missing -= thr_disjoint_join(parent, t->link[k][0], t->link[k][1]);
  }
  return missing <= 0;
}
