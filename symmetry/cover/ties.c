/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tells whether a symmetric cover ties tube joints (graph/plan/plan_measures.h): at every node the
 * turns, as edges between its tubes, connect them all.
 *
 * A symmetric threading ties all nodes of an orbit or none, so one node stands for each orbit: its
 * star. A turn column links, at the star, every two tubes that one of its turns goes between. Where
 * these are not known (symmetry/cover/contraction.c), its turns are only counted: between b blocks
 * of tubes there are b - 1.
 *
 * Example: a star of three tubes under C3 about its node: one orbit of turns links all three pairs
 * of tubes. */
#include "graph/arrays.h"
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

/* Allocates all but the links; the caller destroys ties also on failure. */
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

/* Numbers the orbits of nodes with several tubes, and finds the star of every dart type. of_node:
 * [n_nodes] scratch. */
static void number_stars(thr_ties *ties, const thr_quotient *quotient, const int *node_orbit,
                         int *of_node)
{
  const thr_frame *frame = quotient->f;
  for (int node = 0; node < frame->n_nodes; node++) {
    /* The lowest node of an orbit comes first and gives the orbit its number. */
    int lowest = node_orbit[node], degree = thr_degree(frame, node);
    if (lowest == node) {
      of_node[node] = degree > 1 ? ties->n : -1;
      if (degree < 2) continue;
      ties->node[ties->n] = node;
      ties->degree[ties->n++] = degree;
      if (degree > ties->most) ties->most = degree;
    }

    /* Count the nodes of the orbit. */
    if (of_node[lowest] >= 0) ties->nodes[of_node[lowest]]++;
  }

  for (int dart = 0; dart < quotient->n_darts; dart++)
    ties->star[dart] = of_node[node_orbit[thr_tail(frame, quotient->dart[dart].half)]];
}

/* Lists the pair types by star, and counts the turns that one orbit of each has there. */
static void list_pairs(thr_ties *ties, const thr_quotient *quotient)
{
  /* Count, two places further on. */
  for (int pair = 0; pair < quotient->n_pairs; pair++) {
    int star = ties->star[quotient->pair[pair].dart[0]];
    if (star < 0) continue;
    ties->turns[pair] = quotient->pair[pair].turns / ties->nodes[star];
    ties->first[star + 2]++;
  }

  for (int i = 1; i <= ties->n; i++)
    ties->first[i + 1] += ties->first[i];

  /* Fill. */
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    if (ties->star[quotient->pair[pair].dart[0]] >= 0)
      ties->pair[ties->first[ties->star[quotient->pair[pair].dart[0]] + 1]++] = pair;
}

/* Makes ties without links: no pair type has any as yet. */
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

/* Returns the place of a half-edge among those of its node. */
static int place_of(const thr_frame *frame, int half)
{
  int k = frame->first[thr_tail(frame, half)];
  while (frame->half[k] != half)
    k++;
  return k - frame->first[thr_tail(frame, half)];
}

/* Adds a link between tubes a and b to the last pair type that has links, unless it has that one.
 */
static thr_status add_link(thr_ties *ties, int pair, int a, int b, int *capacity, thr_err *err)
{
  int end = ties->join[pair + 1], low = a < b ? a : b, high = a + b - low;
  for (int k = ties->join[pair]; k < end; k++)
    if (ties->link[k][0] == low && ties->link[k][1] == high) return THR_OK;

  thr_status st = thr_grow(&ties->link, end, capacity, sizeof *ties->link, err);
  if (st) return st;
  ties->link[end][0] = low;
  ties->link[end][1] = high;
  ties->join[pair + 1]++;
  return THR_OK;
}

thr_status thr_ties_init(thr_ties *ties, const thr_quotient *quotient, const int *node_orbit,
                         thr_err *err)
{
  const thr_frame *frame = quotient->f;
  int link_capacity = 0;
  thr_status st = find_stars(ties, quotient, node_orbit, err);

  /* The links of a pair type: its images at the star's own node. */
  for (int pair = 0; pair < quotient->n_pairs && !st; pair++) {
    const thr_pair_type *type = &quotient->pair[pair];
    int star = ties->star[type->dart[0]];
    ties->join[pair + 1] = ties->join[pair];
    for (int i = 0; i < quotient->h->order && star >= 0 && !st; i++) {
      const int *image = &quotient->half_image[(size_t)i * 2 * (size_t)frame->n_edges];
      if (thr_tail(frame, image[type->half[0]]) != ties->node[star]) continue;
      st = add_link(ties, pair, place_of(frame, image[type->half[0]]),
                    place_of(frame, image[type->half[1]]), &link_capacity, err);
    }
  }

  if (st) thr_ties_destroy(ties);
  return st;
}

thr_status thr_ties_contract(thr_ties *ties, const thr_ties *whole, int whole_pairs,
                             const thr_quotient *quotient, const int *node_orbit, const int *pair,
                             const bool *keep, thr_err *err)
{
  int link_capacity = 0;
  thr_status st = find_stars(ties, quotient, node_orbit, err);
  int *from = thr_calloc((size_t)quotient->n_pairs, sizeof *from);
  if (!from) st = thr_nomem(err);

  /* Where each pair type of the contraction that is kept comes from, plus 1. */
  for (int y = 0; y < whole_pairs && !st; y++)
    if (pair[y] >= 0 && keep[y]) from[pair[y]] = y + 1;

  /* Copy its links. */
  for (int y = 0; y < quotient->n_pairs && !st; y++) {
    ties->join[y + 1] = ties->join[y];
    if (!from[y]) continue;
    for (int k = whole->join[from[y] - 1]; k < whole->join[from[y]] && !st; k++)
      st = add_link(ties, y, whole->link[k][0], whole->link[k][1], &link_capacity, err);
  }

  free(from);
  if (st) thr_ties_destroy(ties);
  return st;
}

/* ---- ties ---- */

int thr_ties_blocks(const thr_ties *ties, int star, const double *value, double least, int *block)
{
  /* Every tube alone, then joined by links. */
  for (int i = 0; i < ties->degree[star]; i++)
    block[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int pair = ties->pair[i];
    for (int k = ties->join[pair]; k < ties->join[pair + 1] && value[pair] > least; k++)
      thr_disjoint_join(block, ties->link[k][0], ties->link[k][1]);
  }

  return thr_disjoint_number(block, ties->degree[star], block);
}

int thr_ties_between(const thr_ties *ties, int pair, const int *block)
{
  if (ties->join[pair] == ties->join[pair + 1]) return ties->turns[pair];

  /* Each link has as many turns, as they are images of each other. */
  int apart = 0, links = ties->join[pair + 1] - ties->join[pair];
  for (int k = ties->join[pair]; k < ties->join[pair + 1]; k++)
    apart += block[ties->link[k][0]] != block[ties->link[k][1]];
  return apart * (ties->turns[pair] / links);
}

bool thr_ties_tied(const thr_ties *ties, int star, const int *value, int *parent)
{
  long missing = ties->degree[star] - 1;

  /* Count down what is missing to a tree: every link that joins two blocks, and every turn that is
   * only counted. */
  for (int i = 0; i < ties->degree[star]; i++)
    parent[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1] && missing > 0; i++) {
    int pair = ties->pair[i];
    if (value[pair] > 0 && ties->join[pair] == ties->join[pair + 1])
      missing -= (long)value[pair] * ties->turns[pair];
    for (int k = ties->join[pair]; k < ties->join[pair + 1] && value[pair] > 0; k++)
      missing -= thr_disjoint_join(parent, ties->link[k][0], ties->link[k][1]);
  }

  return missing <= 0;
}
