/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the least turning without connectedness: one perfect matching over copies of passes.
 *
 * Node (h, k) of the matching is pass k of half-edge h's edge at h's node. Two passes of different
 * edges at one node may be matched, which is a turn, at its price. Passes k >= cover of an edge may
 * also be matched end to end: such a pass is not made. Every cord end is a node, too, that may be
 * matched with a pass where it may be; ends that need not be are also matched in pairs.
 *
 * The moats of a matching are multipliers of the turning proof: the moat of (h, 0) is the potential
 * of h, and a blossom is the odd set of the half-edges whose pass 0 is in it (J. Edmonds 1965). The
 * graph begins with few copies and the cheapest turns (column generation): the multipliers tell
 * which extra passes, turns and ends have a negative reduced price; these are added, and the
 * matching is repaired, until there are none.
 *
 * Example: a square, closed: each half-edge (h, 0) is matched with the other one at its node; the
 * copies (h, 1) stay end to end. */
#include "graph/arrays.h"
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  SMALL_NODE = 8,   /* edges of a node all of whose turns are listed at once */
  NEAREST = 6,      /* turns of every half-edge that are, at larger nodes */
  FINEST = 2,       /* the matching's unit is 2^FINEST of the prices' at least */
  MOST_ROUNDS = 30, /* matchings for the same prices */
  STEP = 2,         /* copies of an edge that are opened at a time, between small nodes */
  MOST_FAILED = 20, /* doublings of the turns that are listed */
  SPARE = 3         /* copies of an edge that have nodes, but are not open yet */
};

/* ---- the graph ---- */

/* Releases the graph and the state of the last matching. */
void thr_pass_matching_destroy(thr_pass_matching *passes)
{
  free(passes->open);
  free(passes->copies);
  free(passes->first);
  free(passes->listed);
  free(passes->edge);
  free(passes->column);
  free(passes->weight);
  free(passes->dual);
  free(passes->mate);
  *passes = (thr_pass_matching){0};
}

/* Returns the number of passes, or ends, of a place that every plan has. */
int thr_pass_needed(const thr_pass_matching *passes, int place)
{
  int halves = 2 * passes->c->f->n_edges;
  return place < halves ? passes->c->cover[place >> 1] : passes->c->supply[place - halves][0];
}

/* Returns the number of nodes of the matching. */
static int n_nodes(const thr_pass_matching *passes)
{
  return passes->first[passes->n_places];
}

/* Numbers the nodes place by place, from the copies of every edge and the numbers of ends. */
static void number_nodes(thr_pass_matching *passes)
{
  int halves = 2 * passes->c->f->n_edges;
  for (int i = 0; i < passes->n_places; i++)
    passes->first[i + 1] =
        passes->first[i] + (i < halves ? passes->copies[i >> 1] : passes->c->supply[i - halves][1]);
}

/* Lists the turns at node v that the matching knows from the start: all at small nodes, else the
 * NEAREST cheapest ones of every half-edge. */
static thr_status list_turns(thr_pass_matching *passes, int v, thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  const int *half = columns->f->half + columns->f->first[v];
  int d = thr_degree(columns->f, v);
  for (int i = 0; i < d * (d - 1) / 2 && d <= SMALL_NODE; i++)
    passes->listed[columns->pair_first[v] + i] = true;
  if (d <= SMALL_NODE) return THR_OK;

  /* Large nodes: the cheapest turns. */
  thr_nearest nearest;
  thr_status st = thr_nearest_find(columns, v, columns->weight, NEAREST, &nearest, err);
  for (int i = 0; i < d && !st; i++)
    for (int k = 0; k < nearest.n; k++)
      passes
          ->listed[thr_turning_column(columns, half[i], half[nearest.partner[i * nearest.n + k]])] =
          true;
  if (!st) thr_nearest_destroy(&nearest);
  return st;
}

/* Lists ends at nodes with an odd number of required passes, where an end saves an extra pass; and
 * all ends where their numbers are asked for. */
static void list_ends(thr_pass_matching *passes)
{
  const thr_turning_columns *columns = passes->c;
  for (int j = columns->first_end; j < columns->first_back; j++) {
    int v = thr_tail(columns->f, columns->half[j][0]), odd = 0;
    for (int i = columns->f->first[v]; i < columns->f->first[v + 1]; i++)
      odd ^= columns->cover[columns->f->half[i] >> 1] & 1;

    passes->listed[j] = odd || columns->task->end_count;
  }
}

/* Gives nodes to the open copies of every edge and to SPARE more, which can be opened without
 * numbering the nodes anew. */
static void allot_copies(thr_pass_matching *passes)
{
  const thr_turning_columns *columns = passes->c;
  for (int e = 0; e < columns->f->n_edges; e++)
    passes->copies[e] =
        passes->open[e] + SPARE < columns->most[e] ? passes->open[e] + SPARE : columns->most[e];
  number_nodes(passes);
}

/* Returns how many copies of edge e are opened at a time: more between small nodes, where a copy
 * has few edges. */
static int step_of(const thr_turning_columns *columns, int e)
{
  const int *end = columns->f->edge[e];
  bool small =
      thr_degree(columns->f, end[0]) <= SMALL_NODE && thr_degree(columns->f, end[1]) <= SMALL_NODE;
  return small ? STEP : 1;
}

/* Returns how many copies of edge e are open at first. */
static int first_copies(const thr_turning_columns *columns, int e)
{
  int copies = columns->cover[e] + step_of(columns, e);
  return copies < columns->most[e] ? copies : columns->most[e];
}

/* Chooses the first copies, turns and ends. Edges are made when the first matching is asked for. On
 * failure passes is empty. */
thr_status thr_pass_matching_init(thr_pass_matching *passes,
                                  const thr_turning_columns *turning_columns, thr_err *err)
{
  size_t m = (size_t)turning_columns->f->n_edges;
  *passes =
      (thr_pass_matching){.c = turning_columns, .n_places = 2 * (int)m + turning_columns->n_ends};

  passes->open = thr_calloc(m, sizeof *passes->open);
  passes->copies = thr_calloc(m, sizeof *passes->copies);
  passes->first = thr_calloc((size_t)passes->n_places + 1, sizeof *passes->first);
  passes->listed = thr_calloc((size_t)turning_columns->n_columns, sizeof *passes->listed);
  thr_status st =
      passes->open && passes->copies && passes->first && passes->listed ? THR_OK : thr_nomem(err);

  /* The copies that are open at first, and the turns that are known. */
  for (size_t e = 0; e < m && !st; e++)
    passes->open[e] = first_copies(turning_columns, (int)e);
  for (int v = 0; v < turning_columns->f->n_nodes && !st; v++)
    st = list_turns(passes, v, err);
  if (st) {
    thr_pass_matching_destroy(passes);
    return st;
  }

  /* Extra passes and turns back are always listed. */
  list_ends(passes);
  for (int j = turning_columns->first_extra; j < turning_columns->n_columns; j++)
    passes->listed[j] |= j < turning_columns->first_end || j >= turning_columns->first_back;
  allot_copies(passes);
  return THR_OK;
}

/* Appends an edge of the matching between nodes a and b that stands for a column. The three arrays
 * have one capacity. */
static thr_status add_edge(thr_pass_matching *passes, int a, int b, int column, thr_err *err)
{
  int same = passes->room, room = same, again = same;
  thr_status st = thr_grow(&passes->edge, passes->n_edges, &room, sizeof *passes->edge, err);
  if (!st && room > same)
    st = thr_grow(&passes->column, passes->n_edges, &again, sizeof *passes->column, err);
  again = same;
  if (!st && room > same)
    st = thr_grow(&passes->weight, passes->n_edges, &again, sizeof *passes->weight, err);
  if (st) return st;

  /* Weights are computed later (weigh), because the unit may change. */
  passes->room = room;
  passes->edge[passes->n_edges][0] = a;
  passes->edge[passes->n_edges][1] = b;
  passes->column[passes->n_edges++] = column;
  return THR_OK;
}

/* Finds the two places of each of which a column takes one pass. */
static void places_of(const thr_pass_matching *passes, int j, int place[2])
{
  const thr_turning_columns *columns = passes->c;
  place[0] = columns->half[j][0];
  place[1] = columns->half[j][1] >= 0
                 ? columns->half[j][1]
                 : 2 * columns->f->n_edges + columns->end_group[thr_tail(columns->f, place[0])];
}

/* Returns how many passes of a place may be matched with others so far. */
static int open_nodes(const thr_pass_matching *passes, int place)
{
  return place < 2 * passes->c->f->n_edges ? passes->open[place >> 1]
                                           : passes->first[place + 1] - passes->first[place];
}

/* Adds an edge for every pair of open passes that column j stands for. only >= 0: of this place
 * only the passes from number `from` on. */
static thr_status add_column(thr_pass_matching *passes, int j, int only, int from, thr_err *err)
{
  int place[2];
  places_of(passes, j, place);
  bool back = place[0] == place[1];
  thr_status st = THR_OK;

  /* A turn back takes two different passes of one place. */
  for (int k = place[0] == only && !back ? from : 0; k < open_nodes(passes, place[0]) && !st; k++)
    for (int l = place[1] == only ? from : 0; l < open_nodes(passes, place[1]) && !st; l++)
      if (!back || l > k)
        st = add_edge(passes, passes->first[place[0]] + k, passes->first[place[1]] + l, j, err);
  return st;
}

/* Adds the edges that match the copies of edge e beyond its cover end to end. */
static thr_status add_idle(thr_pass_matching *passes, int e, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = passes->c->cover[e]; k < passes->copies[e] && !st; k++)
    st = add_edge(passes, passes->first[2 * e] + k, passes->first[2 * e + 1] + k,
                  passes->c->first_extra + e, err);
  return st;
}

/* Builds the graph anew. */
static thr_status build(thr_pass_matching *passes, thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  thr_status st = THR_OK;
  passes->n_edges = 0;
  for (int e = 0; e < columns->f->n_edges && !st; e++)
    st = add_idle(passes, e, err);

  /* Turns, ends and turns back that are listed. */
  for (int j = 0; j < columns->n_columns && !st; j++)
    if (passes->listed[j] && !(j >= columns->first_extra && j < columns->first_end))
      st = add_column(passes, j, -1, 0, err);

  /* Ends that need not be are matched in pairs, at no price. */
  for (int k = 0; k < columns->n_ends && !st; k++) {
    int place = 2 * columns->f->n_edges + k;
    for (int a = passes->first[place] + columns->supply[k][0];
         a + 1 < passes->first[place + 1] && !st; a += 2)
      st = add_edge(passes, a, a + 1, -1, err);
  }
  return st;
}

/* Opens one more copy of edge e: adds its edges to all that it may be matched with. */
static thr_status open_copy(thr_pass_matching *passes, int e, thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  int from = passes->open[e]++;
  thr_status st = THR_OK;
  for (int h = 2 * e; h < 2 * e + 2; h++) {
    int v = thr_tail(columns->f, h), end = columns->end_column[h];

    /* The listed turns at h, the end there, and the turn back at a node with one edge. */
    for (int i = columns->f->first[v]; i < columns->f->first[v + 1] && !st; i++) {
      int j = columns->f->half[i] == h ? -1 : thr_turning_column(columns, h, columns->f->half[i]);
      if (j >= 0 && passes->listed[j]) st = add_column(passes, j, h, from, err);
    }
    if (!st && end >= 0 && passes->listed[end]) st = add_column(passes, end, h, from, err);
    for (int j = columns->first_back;
         j < columns->n_columns && thr_degree(columns->f, v) == 1 && !st; j++)
      if (columns->half[j][0] == h) st = add_column(passes, j, h, from, err);
  }
  return st;
}

/* ---- prices ---- */

/* Returns the price of a matched edge that stands for column j; an extra pass costs when it is not
 * matched end to end. */
static int64_t price_of(const thr_turning_columns *columns, const int64_t *price, int j)
{
  return j < 0 ? 0 : j >= columns->first_extra && j < columns->first_end ? -price[j] : price[j];
}

/* Returns x / 2^bits, rounded down. */
static int64_t shifted(int64_t x, int bits)
{
  return x >= 0 ? x >> bits : -((-x + ((INT64_C(1) << bits) - 1)) >> bits);
}

/* Computes the weights of the edges from `from` on. Returns false if the lift leaves one negative.
 */
static bool weigh(thr_pass_matching *passes, const int64_t *price, int from)
{
  bool fit = true;
  for (int i = from; i < passes->n_edges; i++) {
    passes->weight[i] =
        shifted(price_of(passes->c, price, passes->column[i]), passes->bits) + passes->lift;
    fit &= passes->weight[i] >= 0;
  }
  return fit;
}

/* Returns the sum over all nodes of the cheapest edge's price above the least one: about what duals
 * grow to. scratch: [nodes]. */
static double pay_cheapest(const thr_pass_matching *passes, const int64_t *price, int64_t least,
                           int64_t *scratch)
{
  double sum = 0;
  for (int v = 0; v < n_nodes(passes); v++)
    scratch[v] = INT64_MAX;

  for (int i = 0; i < passes->n_edges; i++)
    for (int side = 0; side < 2; side++) {
      int64_t p = price_of(passes->c, price, passes->column[i]) - least,
              *own = &scratch[passes->edge[i][side]];
      if (p < *own) *own = p;
    }

  for (int v = 0; v < n_nodes(passes); v++)
    sum += scratch[v] < INT64_MAX ? (double)scratch[v] : 0;
  return sum;
}

/* Chooses the unit and the lift, and computes all weights: prices / 2^bits + lift. The lift makes
 * no weight negative; bits keep the sum of all duals far below 2^60. */
static void set_weights(thr_pass_matching *passes, const int64_t *price, int64_t *scratch)
{
  int64_t least = 0, most = 0;
  /* Range of the prices. */
  for (int i = 0; i < passes->n_edges; i++) {
    int64_t p = price_of(passes->c, price, passes->column[i]);
    if (p < least) least = p;
    if (p > most) most = p;
  }

  /* The finest unit that fits. */
  double sum = pay_cheapest(passes, price, least, scratch), range = (double)most - (double)least;
  passes->bits = FINEST;
  while (sum * exp2(-passes->bits) > 0x1p57 || range * exp2(-passes->bits) > 0x1p52)
    passes->bits++;

  passes->lift = -shifted(least, passes->bits);
  weigh(passes, price, 0);
}

/* ---- where a matching begins ---- */

/* Keeps duals and mates for the next matching: the duals without the lift, in the prices' unit,
 * limited to what 64 bits hold. */
static thr_status keep(thr_pass_matching *passes, const thr_matching *matching, thr_err *err)
{
  const int64_t most = (INT64_C(1) << 61) >> passes->bits;
  int n = n_nodes(passes);
  free(passes->dual);
  free(passes->mate);
  passes->dual = thr_calloc((size_t)n, sizeof *passes->dual);
  passes->mate = thr_calloc((size_t)n, sizeof *passes->mate);
  if (!passes->dual || !passes->mate) return thr_nomem(err);

  for (int v = 0; v < n; v++) {
    /* Duals are in halves of the matching's unit. */
    int64_t own = matching->dual[v] - passes->lift;
    passes->dual[v] = (own > most    ? most
                       : own < -most ? -most
                                     : own) *
                      (INT64_C(1) << (passes->bits - 1));
    passes->mate[v] = matching->mate[v];
  }
  return THR_OK;
}

/* Moves duals and mates to nodes that were numbered anew after copies were added. A new copy is
 * matched end to end and has the dual of the copy before. before: [n_places + 1] passes->first as
 * it was; moved: [nodes before] scratch. */
static void move_nodes(const thr_pass_matching *passes, const int *before, int *moved,
                       int64_t *dual, int *mate)
{
  for (int i = 0; i < passes->n_places; i++)
    for (int k = 0; passes->first[i] + k < passes->first[i + 1]; k++) {
      int had = before[i + 1] - before[i], to = passes->first[i] + k;
      dual[to] = passes->dual[before[i] + (k < had ? k : had - 1)];

      /* An old copy moves; a new one is matched end to end, at the other half-edge of its edge. */
      if (k < had)
        moved[before[i] + k] = to;
      else
        mate[to] = passes->first[i ^ 1] + k;
    }

  /* Mates of old nodes, by their new numbers. */
  for (int v = 0; v < before[passes->n_places]; v++)
    mate[moved[v]] = moved[passes->mate[v]];
}

/* Gives nodes to all open copies, and carries the state of the last matching over. */
static thr_status renumber(thr_pass_matching *passes, thr_err *err)
{
  thr_scratch own = {0};
  int *before = thr_scratch_array(&own, (size_t)passes->n_places + 1, sizeof *before),
      *moved = thr_scratch_array(&own, (size_t)n_nodes(passes), sizeof *moved);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) memcpy(before, passes->first, ((size_t)passes->n_places + 1) * sizeof *before);
  if (!st) allot_copies(passes);

  int64_t *dual = thr_calloc((size_t)n_nodes(passes), sizeof *dual);
  int *mate = thr_calloc((size_t)n_nodes(passes), sizeof *mate);
  if (!st && (!dual || !mate)) st = thr_nomem(err);

  if (!st && passes->dual) {
    move_nodes(passes, before, moved, dual, mate);
    free(passes->dual);
    free(passes->mate);
    passes->dual = dual;
    passes->mate = mate;
    dual = NULL;
    mate = NULL;
  }

  free(dual);
  free(mate);
  thr_scratch_free(&own);
  return st;
}

/* ---- the matching ---- */

/* Builds the graph anew, and computes a matching that begins at the duals and mates of the last
 * one, if any. */
static thr_status match_anew(thr_pass_matching *passes, const int64_t *price,
                             const thr_limits *limits, thr_matching *out, thr_err *err)
{
  int n = n_nodes(passes);
  int64_t *dual = thr_calloc((size_t)n, sizeof *dual);
  thr_status st = dual ? build(passes, err) : thr_nomem(err);
  thr_matching_destroy(out);

  if (!st) {
    set_weights(passes, price, dual);
    for (int v = 0; v < n && passes->dual; v++)
      dual[v] = shifted(passes->dual[v], passes->bits - 1) + passes->lift;
    const thr_matching_problem problem = {n, passes->n_edges, (const int(*)[2])passes->edge,
                                          passes->weight};
    st = thr_matching_near(&problem, passes->dual ? dual : NULL, passes->mate, limits, out, err);
  }
  free(dual);
  return st;
}

/* Computes a matching. The last one is continued with the edges from number `known` on; if there is
 * none, or many edges are new, the graph is built anew. */
static thr_status match(thr_pass_matching *passes, const int64_t *price, int known,
                        const thr_limits *limits, thr_matching *out, thr_err *err)
{
  bool many = passes->n_edges - known > known / 2;
  passes->rounds++;

  /* A weight that would be negative needs another lift, and so new weights everywhere. */
  if (!out->state || many || !weigh(passes, price, known))
    return match_anew(passes, price, limits, out, err);

  const thr_matching_problem problem = {n_nodes(passes), passes->n_edges,
                                        (const int(*)[2])passes->edge, passes->weight};
  return thr_matching_again(&problem, limits, out, err);
}

/* Lists the turns at node v with the least reduced prices below few, `most` of every half-edge, and
 * adds their edges. left: reduced prices, INT64_MAX for turns that are listed already. *more is set
 * if there are any. */
static thr_status list_cheapest(thr_pass_matching *passes, int v, int64_t *left, int64_t few,
                                int most, bool *more, thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  const int *half = columns->f->half + columns->f->first[v];
  thr_nearest nearest;
  thr_status st = thr_nearest_find(columns, v, left, most, &nearest, err);
  if (st) return st;
  for (int i = 0; i < nearest.degree * nearest.n && !st; i++) {
    if (nearest.partner[i] < 0 || nearest.price[i] >= few) continue;

    int j = thr_turning_column(columns, half[i / nearest.n], half[nearest.partner[i]]);
    if (passes->listed[j]) continue; /* listed for its other half-edge */
    *more = passes->listed[j] = true;
    st = add_column(passes, j, -1, 0, err);
  }
  thr_nearest_destroy(&nearest);
  return st;
}

/* Lists turns of low reduced price at all large nodes, and all ends of low reduced price. */
static thr_status list_more(thr_pass_matching *passes, int64_t *left, int64_t few, int most,
                            bool *more, thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  thr_status st = THR_OK;
  for (int j = 0; j < columns->first_extra; j++)
    if (passes->listed[j]) left[j] = INT64_MAX;

  /* At small nodes all turns are listed from the start. */
  for (int v = 0; v < columns->f->n_nodes && !st; v++)
    if (thr_degree(columns->f, v) > SMALL_NODE)
      st = list_cheapest(passes, v, left, few, most, more, err);

  for (int j = columns->first_end; j < columns->first_back && !st; j++) {
    if (passes->listed[j] || left[j] >= few) continue;
    *more = passes->listed[j] = true;
    st = add_column(passes, j, -1, 0, err);
  }
  return st;
}

/* Prices the columns that the matching does not know, and adds those of negative reduced price:
 * turns and ends first and, where there are none, copies of extra passes. dual NULL: there was no
 * matching; then the cheapest turns are added, twice as many every time, and from the second time
 * on copies, too. *more: whether anything was added; *fit: whether the nodes were enough for it. */
static thr_status price_out(thr_pass_matching *passes, const int64_t *price,
                            const thr_turning_dual *dual, int first_odd, bool *more, bool *fit,
                            thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  thr_scratch own = {0};
  int64_t *left = thr_scratch_array(&own, (size_t)columns->n_columns, sizeof *left),
          few = dual ? -(INT64_C(4) << passes->bits) : INT64_MAX;
  thr_status st = thr_scratch_check(&own, err);

  /* The reduced prices. Very small negative ones may come from rounding. */
  if (!st && dual) st = thr_pass_left(passes, price, dual, first_odd, false, left, err);
  if (!st && !dual) memcpy(left, price, (size_t)columns->n_columns * sizeof *left);
  *more = false;
  *fit = true;

  /* Turns and ends; they may make more copies unnecessary. */
  if (!dual && passes->failed < MOST_FAILED) passes->failed++;
  if (!st) st = list_more(passes, left, few, dual ? NEAREST : NEAREST << passes->failed, more, err);

  bool copies = dual ? !*more : !*more || passes->failed > 1;

  /* Copies: spare ones have nodes already, others need the nodes to be numbered anew. */
  for (int e = 0; e < columns->f->n_edges && !st && copies; e++)
    for (int k = 0; k < step_of(columns, e) && passes->open[e] < columns->most[e] &&
                    left[columns->first_extra + e] < few && !st;
         k++) {
      *more = true;
      if (passes->open[e] < passes->copies[e])
        st = open_copy(passes, e, err);
      else {
        passes->open[e]++;
        *fit = false;
      }
    }

  thr_scratch_free(&own);
  return st || *fit ? st : renumber(passes, err);
}

/* Fills x[n_columns] with how often the matching takes every column. Extra passes are the copies
 * less those that are matched end to end. */
static void count_columns(const thr_pass_matching *passes, const thr_matching *matching, int *x)
{
  const thr_turning_columns *columns = passes->c;
  memset(x, 0, (size_t)columns->n_columns * sizeof *x);

  /* As if all copies were made; edges that match copies end to end take them off again. */
  for (int e = 0; e < columns->f->n_edges; e++)
    x[columns->first_extra + e] = passes->copies[e] - columns->cover[e];

  for (int v = 0; v < n_nodes(passes); v++) {
    int j = passes->column[matching->mate_edge[v]];
    if (matching->mate[v] < v || j < 0) continue;
    x[j] += j >= columns->first_extra && j < columns->first_end ? -1 : 1;
  }
}

/* Lowers potentials until no turn or end has a negative reduced price. left, less: scratch; less
 * must be 0. */
static thr_status settle_turns(const thr_pass_matching *passes, const int64_t *price,
                               thr_turning_dual *dual, int first_odd, int64_t *left, int64_t *less,
                               thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  thr_status st = thr_pass_left(passes, price, dual, first_odd, true, left, err);
  for (int j = 0; j < columns->first_back && !st; j++) {
    int a = columns->half[j][0], b = columns->half[j][1];
    int64_t over = -left[j] - less[a] - (b >= 0 ? less[b] : 0);
    if (over > 0 && (j < columns->first_extra || j >= columns->first_end)) less[a] += over;
  }

  /* All changes were collected first, because every turn counts what its half-edges lost. */
  for (int h = 0; h < 2 * columns->f->n_edges && !st; h++)
    dual->potential[h] -= less[h];
  return st;
}

/* Lowers the values of odd sets that leave an extra pass a negative reduced price. The bound loses
 * no more than by these extra passes, of which there may be several. left: scratch. member: all
 * false. */
static thr_status settle_sets(const thr_pass_matching *passes, const int64_t *price,
                              thr_turning_dual *dual, int first_odd, int64_t *left, bool *member,
                              thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  const int halves = 2 * columns->f->n_edges;
  thr_status st = thr_pass_left(passes, price, dual, first_odd, true, left, err);
  for (int i = first_odd; i < dual->n_odd && !st; i++) {
    thr_turning_set *set = &dual->odd[i];

    int64_t over = 0;
    for (int k = 0; k < set->n; k++)
      member[set->member[k]] = true;

    /* The most that an extra pass leaving the set is below 0. */
    for (int k = 0; k < set->n && set->member[k] < halves; k++) {
      int h = set->member[k], e = h >> 1;
      if (!member[h ^ 1] && columns->most[e] > columns->cover[e] &&
          -left[columns->first_extra + e] > over)
        over = -left[columns->first_extra + e];
    }

    if (over > set->value) over = set->value;
    set->value -= over;
    for (int k = 0; k < set->n && set->member[k] < halves; k++)
      if (!member[set->member[k] ^ 1]) left[columns->first_extra + (set->member[k] >> 1)] += over;
    for (int k = 0; k < set->n; k++)
      member[set->member[k]] = false;
  }
  return st;
}

/* Makes the multipliers prove what they can where no further matching will be made. */
static thr_status settle(const thr_pass_matching *passes, const int64_t *price,
                         thr_turning_dual *dual, int first_odd, thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  thr_scratch own = {0};
  int64_t *left = thr_scratch_array(&own, (size_t)columns->n_columns, sizeof *left),
          *less = thr_scratch_array(&own, 2 * (size_t)columns->f->n_edges, sizeof *less);
  bool *member = thr_scratch_array(&own, (size_t)passes->n_places, sizeof *member);
  thr_status st = thr_scratch_check(&own, err);

  if (!st) st = settle_turns(passes, price, dual, first_odd, left, less, err);
  if (!st) st = settle_sets(passes, price, dual, first_odd, left, member, err);

  thr_scratch_free(&own);
  return st;
}

/* Takes over a matching: its columns, its multipliers, and what is to be added to the graph. The
 * odd sets of the matching before are dropped. */
static thr_status take(thr_pass_matching *passes, const int64_t *price,
                       const thr_matching *matching, int first_odd, int *x, thr_turning_dual *dual,
                       bool *more, bool *fit, thr_err *err)
{
  thr_turning_dual_drop_odd(dual, first_odd);
  count_columns(passes, matching, x);

  thr_status st = keep(passes, matching, err);
  if (!st) st = thr_pass_dual(passes, matching, price, dual, err);
  *more = false;
  return st ? st : price_out(passes, price, dual, first_odd, more, fit, err);
}

/* Computes matchings and adds columns in turn, until no column has a negative reduced price. */
thr_status thr_pass_matching_solve(thr_pass_matching *passes, const int64_t *price,
                                   const thr_limits *limits, int *x, thr_turning_dual *dual,
                                   thr_err *err)
{
  int first_odd = dual->n_odd, known = 0, round = 0;
  thr_matching matching = {0};
  thr_status st = THR_OK;

  for (bool more = true, fit = true; more && !st && round < MOST_ROUNDS; round++) {
    thr_err why = {0};
    st = match(passes, price, known, limits, &matching, &why);
    known = passes->n_edges;

    /* Without a perfect matching there are no multipliers: add columns by price alone. */
    if (st == THR_EINFEASIBLE) {
      st = price_out(passes, price, NULL, 0, &more, &fit, err);
      if (!st && !more) st = thr_fail(err, THR_EINFEASIBLE, "%s", why.text);
    } else if (st)
      thr_fail(err, st, "%s", why.text);
    else
      st = take(passes, price, &matching, first_odd, x, dual, &more, &fit, err);

    /* New numbers of nodes: the matching cannot be continued. */
    if (!fit) thr_matching_destroy(&matching);
    if (!more && !st) break;
  }

  /* Stopped or out of rounds: the multipliers of the last matching, lowered, still prove a bound.
   */
  thr_matching_destroy(&matching);
  if (round == MOST_ROUNDS || (st == THR_ELIMIT && round > 0)) {
    thr_status settled = settle(passes, price, dual, first_odd, err);
    if (settled) st = settled;
  }
  return st;
}
