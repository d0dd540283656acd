/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tube joints (graph/plan/plan_measures.h) in the programme of a symmetric cover: at every node the
 * turns, as edges between its tubes, connect them all. Internal.
 *
 * A symmetric threading ties all nodes of an orbit or none, so one node stands for each: its star.
 * A turn column joins, there, every two tubes that one of its turns goes between. Where it is not
 * known which (symmetry/cover/contraction.c), its turns are only counted: between b blocks of tubes
 * there are b - 1. */
#include "graph/disjoint.h"
#include "symmetry/cover/cover.h"

#include <stdlib.h>

void thr_ties_destroy(thr_ties *ties)
{
  free(ties->node);
  free(ties->degree);
  free(ties->nodes);
  free(ties->star);
  free(ties->first);
  free(ties->pair);
  free(ties->turns);
  free(ties->join);
  free(ties->link);
  *ties = (thr_ties){0};
}

/* ---- stars ---- */

static thr_status allocate(thr_ties *ties, const thr_quotient *quotient, thr_err *err)
{
  size_t nodes = (size_t)quotient->f->n_nodes, pairs = (size_t)quotient->n_pairs;
  ties->node = thr_calloc(nodes, sizeof *ties->node);
  ties->degree = thr_calloc(nodes, sizeof *ties->degree);
  ties->nodes = thr_calloc(nodes, sizeof *ties->nodes);
  ties->star = thr_calloc((size_t)quotient->n_darts, sizeof *ties->star);
  ties->first = thr_calloc(nodes + 2, sizeof *ties->first);
  ties->pair = thr_calloc(pairs, sizeof *ties->pair);
  ties->turns = thr_calloc(pairs, sizeof *ties->turns);
  ties->join = thr_calloc(pairs + 1, sizeof *ties->join);
  return ties->node && ties->degree && ties->nodes && ties->star && ties->first && ties->pair &&
                 ties->turns && ties->join
             ? THR_OK
             : thr_nomem(err);
}

/* of_node: [n_nodes] scratch. */
static void number_stars(thr_ties *ties, const thr_quotient *quotient, const int *node_orbit,
                         int *of_node)
{
  const thr_frame *frame = quotient->f;
  for (int v = 0; v < frame->n_nodes; v++) {
    int lowest = node_orbit[v], degree = thr_degree(frame, v);
    if (lowest == v) {
      of_node[v] = degree > 1 ? ties->n : -1;
      if (degree < 2) continue;
      ties->node[ties->n] = v;
      ties->degree[ties->n++] = degree;
      if (degree > ties->most) ties->most = degree;
    }
    if (of_node[lowest] >= 0) ties->nodes[of_node[lowest]]++;
  }
  for (int d = 0; d < quotient->n_darts; d++)
    ties->star[d] = of_node[node_orbit[thr_tail(frame, quotient->dart[d].half)]];
}

static void list_pairs(thr_ties *ties, const thr_quotient *quotient)
{
  for (int y = 0; y < quotient->n_pairs; y++) {
    int star = ties->star[quotient->pair[y].dart[0]];
    if (star < 0) continue;
    ties->turns[y] = quotient->pair[y].turns / ties->nodes[star];
    ties->first[star + 2]++;
  }
  for (int i = 1; i <= ties->n; i++)
    ties->first[i + 1] += ties->first[i];
  for (int y = 0; y < quotient->n_pairs; y++)
    if (ties->star[quotient->pair[y].dart[0]] >= 0)
      ties->pair[ties->first[ties->star[quotient->pair[y].dart[0]] + 1]++] = y;
}

/* All but the links. */
static thr_status find_stars(thr_ties *ties, const thr_quotient *quotient, const int *node_orbit,
                             thr_err *err)
{
  *ties = (thr_ties){0};
  thr_status st = allocate(ties, quotient, err);
  int *of_node = thr_calloc((size_t)quotient->f->n_nodes, sizeof *of_node);
  if (!of_node) st = thr_nomem(err);
  if (!st) {
    number_stars(ties, quotient, node_orbit, of_node);
    list_pairs(ties, quotient);
  }
  free(of_node);
  return st;
}

/* ---- links ---- */

static int place_of(const thr_frame *frame, int half)
{
  int k = frame->first[thr_tail(frame, half)];
  while (frame->half[k] != half)
    k++;
  return k - frame->first[thr_tail(frame, half)];
}

static thr_status add_link(thr_ties *ties, int y, int a, int b, int *capacity, thr_err *err)
{
  int n = ties->join[y + 1], low = a < b ? a : b, high = a + b - low;
  for (int k = ties->join[y]; k < n; k++)
    if (ties->link[k][0] == low && ties->link[k][1] == high) return THR_OK;
  thr_status st = thr_grow(&ties->link, n, capacity, sizeof *ties->link, err);
  if (st) return st;
  ties->link[n][0] = low;
  ties->link[n][1] = high;
  ties->join[y + 1]++;
  return THR_OK;
}

thr_status thr_ties_init(thr_ties *ties, const thr_quotient *quotient, const int *node_orbit,
                         thr_err *err)
{
  const thr_frame *frame = quotient->f;
  int capacity = 0;
  thr_status st = find_stars(ties, quotient, node_orbit, err);
  for (int y = 0; y < quotient->n_pairs && !st; y++) {
    const thr_pair_type *type = &quotient->pair[y];
    int star = ties->star[type->dart[0]];
    ties->join[y + 1] = ties->join[y];
    for (int i = 0; i < quotient->h->order && star >= 0 && !st; i++) {
      const int *to = &quotient->half_image[(size_t)i * 2 * (size_t)frame->n_edges];
      if (thr_tail(frame, to[type->half[0]]) != ties->node[star]) continue;
      st = add_link(ties, y, place_of(frame, to[type->half[0]]), place_of(frame, to[type->half[1]]),
                    &capacity, err);
    }
  }
  if (st) thr_ties_destroy(ties);
  return st;
}

thr_status thr_ties_contract(thr_ties *ties, const thr_ties *whole, int whole_pairs,
                             const thr_quotient *quotient, const int *node_orbit, const int *pair,
                             const bool *keep, thr_err *err)
{
  int capacity = 0;
  thr_status st = find_stars(ties, quotient, node_orbit, err);
  int *from = thr_calloc((size_t)quotient->n_pairs, sizeof *from);
  if (!from) st = thr_nomem(err);
  for (int y = 0; y < whole_pairs && !st; y++)
    if (pair[y] >= 0 && keep[y]) from[pair[y]] = y + 1;
  for (int y = 0; y < quotient->n_pairs && !st; y++) {
    ties->join[y + 1] = ties->join[y];
    if (!from[y]) continue;
    for (int k = whole->join[from[y] - 1]; k < whole->join[from[y]] && !st; k++)
      st = add_link(ties, y, whole->link[k][0], whole->link[k][1], &capacity, err);
  }
  free(from);
  if (st) thr_ties_destroy(ties);
  return st;
}

/* ---- ties ---- */

int thr_ties_blocks(const thr_ties *ties, int star, const double *value, double least, int *block)
{
  for (int i = 0; i < ties->degree[star]; i++)
    block[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int y = ties->pair[i];
    for (int k = ties->join[y]; k < ties->join[y + 1] && value[y] > least; k++)
      thr_disjoint_join(block, ties->link[k][0], ties->link[k][1]);
  }
  return thr_disjoint_number(block, ties->degree[star], block);
}

int thr_ties_between(const thr_ties *ties, int y, const int *block)
{
  if (ties->join[y] == ties->join[y + 1]) return ties->turns[y];
  int n = 0, links = ties->join[y + 1] - ties->join[y];
  for (int k = ties->join[y]; k < ties->join[y + 1]; k++)
    n += block[ties->link[k][0]] != block[ties->link[k][1]];
  return n *
         (ties->turns[y] / links); /* as many turns for each link: they are images of each other */
}

bool thr_ties_tied(const thr_ties *ties, int star, const int *value, int *parent)
{
  long missing = ties->degree[star] - 1;
  for (int i = 0; i < ties->degree[star]; i++)
    parent[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1] && missing > 0; i++) {
    int y = ties->pair[i];
    if (value[y] > 0 && ties->join[y] == ties->join[y + 1])
      missing -= (long)value[y] * ties->turns[y];
    for (int k = ties->join[y]; k < ties->join[y + 1] && value[y] > 0; k++)
      missing -= thr_disjoint_join(parent, ties->link[k][0], ties->link[k][1]);
  }
  return missing <= 0;
}
