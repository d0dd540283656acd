/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes transition systems: at every node, which pass continues into which.
 *
 * Pairing at a node takes the least total price of turns by a dynamic programme over subsets, or
 * any pairing without avoidable U-turns at very large nodes. A transition system makes circuits;
 * where two of them meet at a node, exchanging two pairs joins them (Kotzig 1968). Exchanges are
 * chosen by their extra price as Kruskal's method chooses edges of a spanning tree, whose nodes are
 * the circuits. The other way round, a system is made from walks.
 *
 * Example: at a node with four straight passes a, b, a', b' (a opposite to a'), a continues into
 * a'. If these are two circuits, the exchange (a b)(a' b') makes one of them, for two turns more.
 */
#include "graph/threading/threading.h"
#include "graph/number.h"

#include <stdlib.h>
#include <string.h>

enum { EXACT_DARTS = 12 }; /* largest node paired at least price: 2^12 subsets */

/* Computes price[n * n]: of pairing each of at most EXACT_DARTS darts with each other one. The
 * angle between two passes at a node is half a turn less the angle between their directions out of
 * it. */
static void price_pairs(const thr_frame *frame, const thr_multigraph *multigraph, const int *dart,
                        int n, double *price)
{
  double out[EXACT_DARTS][3], in[EXACT_DARTS][3];
  for (int i = 0; i < n; i++) {
    /* A virtual dart has no direction, and no turn costs anything there. */
    const int half = multigraph->half[dart[i]];
    if (half >= 0) thr_direction(frame, half, out[i]);
    for (int k = 0; k < 3 && half >= 0; k++)
      in[i][k] = -out[i][k];

    for (int j = 0; j < i; j++) {
      const int other = multigraph->half[dart[j]];
      price[i * n + j] = (half == other ? THR_U_TURN_PRICE : 0) +
                         (half < 0 || other < 0 ? 0 : thr_angle_between(in[j], out[i]));
      price[j * n + i] = price[i * n + j];
    }
  }
}

/* Pairs four darts, of which there are three pairings: total[j - 1] receives the price of the one
 * that pairs the first dart with number j. The first of the cheapest is taken. */
static void pair_four(const thr_frame *frame, const thr_multigraph *multigraph, const int *dart,
                      double total[3], int *mate)
{
  double price[4][4];
  price_pairs(frame, multigraph, dart, 4, price[0]);

  total[0] = price[0][1] + price[2][3];
  total[1] = price[0][2] + price[1][3];
  total[2] = price[0][3] + price[1][2];

  const int best =
                total[1] < total[0] ? (total[2] < total[1] ? 3 : 2) : (total[2] < total[0] ? 3 : 1),
            other = best == 1 ? 2 : 1;
  thr_set_pair(mate, dart[0], dart[best]);
  thr_set_pair(mate, dart[other], dart[6 - best - other]);
}

/* Pairs at most EXACT_DARTS darts of one node at the least total price. */
static thr_status pair_exactly(const thr_frame *frame, const thr_multigraph *multigraph,
                               const int *dart, int n, int *mate, thr_err *err)
{
  double price[EXACT_DARTS * EXACT_DARTS];
  int pair[EXACT_DARTS];
  for (int i = 0; i < n; i++)
    price[i * n + i] = 0;

  price_pairs(frame, multigraph, dart, n, price);
  thr_status st = thr_pairing_best(n, price, pair, err);
  for (int i = 0; i < n && !st; i++)
    mate[dart[i]] = dart[pair[i]];
  return st;
}

/* Pairs many darts of one node. They are grouped by edge (copies of an edge are consecutive): dart
 * i and dart i + n/2 differ in edge unless one edge has more than half of all darts, and then
 * U-turns are unavoidable. */
static void pair_by_halves(const int *dart, int n, int *mate)
{
  for (int i = 0; i < n / 2; i++)
    thr_set_pair(mate, dart[i], dart[i + n / 2]);
}

thr_status thr_transition_pair(const thr_frame *frame, const thr_multigraph *multigraph, int *mate,
                               double (*four)[3], thr_err *err)
{
  double unused[3] = {0};
  thr_status st = THR_OK;

  /* Two darts have one pairing, four have three; larger nodes need a search. */
  for (int v = 0; v < multigraph->n_nodes && !st; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];

    int n = multigraph->first[v + 1] - multigraph->first[v];
    if (n % 2)
      return thr_fail(err, THR_EINPUT, "node %s has an odd number (%d) of passes and ends",
                      frame->name[v], n);

    if (n == 2)
      thr_set_pair(mate, dart[0], dart[1]);
    else if (n == 4)
      pair_four(frame, multigraph, dart, four ? four[v] : unused, mate);
    else if (n <= EXACT_DARTS)
      st = pair_exactly(frame, multigraph, dart, n, mate, err);
    else
      pair_by_halves(dart, n, mate);
  }
  return st;
}

void thr_transition_trace(const int *mate, int start, int *out, int *count)
{
  int n = 0, d = start;
  do {
    out[n++] = d;
    d = mate[d ^ 1];
  } while (d >= 0 && d != start);
  *count = n;
}

/* ---- joining ---- */

/* An exchange of two pairs. */
typedef struct {
  double extra; /* price of the new pairs less that of the old */
  int a, c;     /* one dart of each pair; a < c */
  bool
      cross; /* new pairs (a d)(b c) instead of (a c)(b d), where b = mate of a and d = mate of c */
} exchange;

typedef struct {
  exchange *list;
  int count, capacity;
} exchanges;

/* Orders exchanges by extra price, then by their darts, so that the order is the same everywhere.
 */
static int by_extra(const void *a, const void *b)
{
  const exchange *one = a, *other = b;
  if (one->extra != other->extra) return one->extra < other->extra ? -1 : 1;
  if (one->a != other->a) return one->a < other->a ? -1 : 1;
  return (one->c > other->c) - (one->c < other->c);
}

/* Returns the cheaper of both exchanges of two pairs, from the total prices of the old pairs and of
 * both new ones. */
static exchange cheaper_exchange(int a, int c, double old, double straight_total,
                                 double cross_total)
{
  double straight = straight_total - old, cross = cross_total - old;
  return (exchange){straight <= cross ? straight : cross, a, c, cross < straight};
}

/* Returns the cheaper exchange of the pair of dart a and the pair of dart c. */
static exchange best_exchange(const thr_frame *frame, const thr_multigraph *multigraph,
                              const int *mate, int a, int c)
{
  const int dart[] = {a, mate[a], c, mate[c]};
  double price[4][4];
  price_pairs(frame, multigraph, dart, 4, price[0]);
  return cheaper_exchange(a, c, price[0][1] + price[2][3], price[0][2] + price[1][3],
                          price[0][3] + price[1][2]);
}

/* Does the same at a node with four darts, the first of them a, from the prices of their three
 * pairings. */
static exchange best_of_four(const int *dart, const double total[3], const int *mate, int c)
{
  double by_partner[3];
  const int partner[] = {mate[dart[0]], c, mate[c]};
  for (int i = 0; i < 3; i++)
    by_partner[i] = total[partner[i] == dart[1] ? 0 : partner[i] == dart[2] ? 1 : 2];
  return cheaper_exchange(dart[0], c, by_partner[0], by_partner[1], by_partner[2]);
}

/* Collects exchanges between different circuits at node v: all of them at a small node; at a large
 * one of each pair with the next pair only. */
static thr_status collect(const thr_frame *frame, const thr_multigraph *multigraph, const int *mate,
                          const double (*four)[3], const int *circuit, int v, exchanges *collected,
                          thr_err *err)
{
  int n = multigraph->first[v + 1] - multigraph->first[v];
  const int *dart = multigraph->dart + multigraph->first[v];

  /* Each pair is named by its lower dart. */
  for (int i = 0; i < n; i++) {
    if (mate[dart[i]] < dart[i]) continue;
    for (int j = i + 1, seen = 0; j < n && (n <= EXACT_DARTS || seen < 1); j++) {
      if (mate[dart[j]] < dart[j]) continue;

      seen++;
      if (circuit[dart[i]] == circuit[dart[j]]) continue;

      thr_status st = thr_grow(&collected->list, collected->count, &collected->capacity,
                               sizeof *collected->list, err);
      if (st) return st;

      collected->list[collected->count++] =
          four && n == 4 ? best_of_four(dart, four[v], mate, dart[j])
                         : best_exchange(frame, multigraph, mate, dart[i], dart[j]);
    }
  }
  return THR_OK;
}

/* Applies one round of Kruskal's rule over exchanges, `most` of them at most, and returns how many.
 * A pair takes part in at most one exchange a round, as an exchange changes the pairs that others
 * name. */
static int apply_cheapest(exchanges *collected, int *mate, const int *circuit, int *parent,
                          bool *moved, int most)
{
  int applied = 0;
  if (collected->count)
    qsort(collected->list, (size_t)collected->count, sizeof *collected->list, by_extra);

  /* Kruskal: an exchange whose circuits are joined already is left out. */
  for (int i = 0; i < collected->count && applied < most; i++) {
    int a = collected->list[i].a, c = collected->list[i].c, b = mate[a], d = mate[c];

    if (moved[a] || moved[c]) continue;
    if (!thr_disjoint_join(parent, circuit[a], circuit[c])) continue;

    thr_set_pair(mate, a, collected->list[i].cross ? d : c);
    thr_set_pair(mate, b, collected->list[i].cross ? c : d);
    moved[a] = moved[b] = moved[c] = moved[d] = true;
    applied++;
  }
  return applied;
}

thr_status thr_transition_join(const thr_frame *frame, const thr_multigraph *multigraph, int *mate,
                               const double (*four)[3], int enough, thr_err *err)
{
  thr_status st = THR_OK;
  int left;
  exchanges collected = {0};

  int *circuit = thr_calloc((size_t)multigraph->n_darts, sizeof *circuit);
  int *parent = thr_calloc((size_t)multigraph->n_darts, sizeof *parent);
  bool *moved = thr_calloc((size_t)multigraph->n_darts, sizeof *moved);
  if (!circuit || !parent || !moved) {
    st = thr_nomem(err);
    goto done;
  }

  /* Rounds, until no two circuits meet: number the circuits, collect exchanges between them, make
   * the cheapest. */
  do {
    collected.count = 0;
    left = thr_threading_label(multigraph, mate, circuit);
    memset(moved, 0, (size_t)multigraph->n_darts * sizeof *moved);
    for (int d = 0; d < multigraph->n_darts; d++)
      parent[d] = d;

    for (int v = 0; v < multigraph->n_nodes; v++)
      if ((st = collect(frame, multigraph, mate, four, circuit, v, &collected, err))) goto done;
  } while (apply_cheapest(&collected, mate, circuit, parent, moved, left - enough) > 0);
done:
  free(collected.list);
  free(circuit);
  free(parent);
  free(moved);
  return st;
}

void thr_transition_join_equal(const thr_multigraph *multigraph, const int *circuit, int *parent,
                               int *mate)
{
  for (int d = 0; d + 2 < multigraph->n_darts; d += 2) {
    /* Copies of an edge are consecutive, so passes of one edge are two darts apart. */
    if (multigraph->half[d] < 0 || multigraph->half[d] != multigraph->half[d + 2] ||
        !thr_disjoint_join(parent, circuit[d], circuit[d + 2]))
      continue;

    int a = mate[d], b = mate[d + 2];
    thr_set_pair(mate, d, b);
    thr_set_pair(mate, d + 2, a);
  }
}

/* ---- from walks ---- */

void thr_transition_copies(const thr_frame *frame, const thr_multigraph *multigraph, int *next)
{
  for (int d = multigraph->n_darts - 2; d >= 0; d -= 2)
    next[multigraph->half[d] >= 0 ? multigraph->half[d] >> 1
                                  : frame->n_edges + multigraph->tail[d]] = d;
}

/* Takes the next copy of an edge, or the next virtual edge of a node, and returns its first dart.
 */
static int take(int *next, int i)
{
  next[i] += 2;
  return next[i] - 2;
}

void thr_transition_walk(const thr_frame *frame, const thr_multigraph *multigraph, const int *half,
                         int n, bool open, int *next, int *mate)
{
  int first = -1, last = open ? take(next, frame->n_edges + thr_tail(frame, half[0])) : -1;

  /* Take a copy of each edge, and pair the dart where the walk arrives with the one by which it
   * leaves. */
  for (int i = 0; i < n; i++) {
    int copy = take(next, half[i] >> 1), d = multigraph->half[copy] == half[i] ? copy : copy ^ 1;

    if (first < 0) first = d;
    if (last >= 0) thr_set_pair(mate, last, d);
    last = d ^ 1;
  }

  /* Close the walk, or end it with a virtual edge. */
  thr_set_pair(mate, last,
               open ? take(next, frame->n_edges + thr_head(frame, half[n - 1])) : first);
}
