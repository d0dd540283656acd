/* Pairing at nodes, joining circuits by exchanging pairs (Kotzig 1968), and pairs from walks. */
#include "graph/threading/transition.h"
#include "graph/disjoint.h"
#include "graph/plan/plan.h"
#include "graph/threading/pairing.h"
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EXACT_DARTS = 12 }; /* largest node paired at least price: 2^12 subsets */

static bool same_pass_back(const thr_multigraph *multigraph, int a, int b)
{
  return multigraph->half[a] == multigraph->half[b]; /* both leave over one edge, or both are cord ends */
}

double thr_transition_price(const thr_frame *frame, const thr_multigraph *multigraph, int a, int b)
{
  double price = same_pass_back(multigraph, a, b) ? THR_U_TURN_PRICE : 0;
  if (multigraph->half[a] < 0 || multigraph->half[b] < 0) return price;
  return price + thr_turn_angle(frame, multigraph->half[a] ^ 1, multigraph->half[b]);
}

static thr_status pair_exactly(const thr_frame *frame, const thr_multigraph *multigraph, const int *dart, int n, int *mate,
                               thr_err *err)
{
  double price[EXACT_DARTS * EXACT_DARTS] = {0};
  int pair[EXACT_DARTS];
  for (int i = 0; i < n; i++)
    for (int j = i + 1; j < n; j++)
      price[i * n + j] = price[j * n + i] = thr_transition_price(frame, multigraph, dart[i], dart[j]);
  thr_status st = thr_pairing_best(n, price, pair, err);
  for (int i = 0; i < n && !st; i++)
    mate[dart[i]] = dart[pair[i]];
  return st;
}

/* Darts grouped by edge (copies of an edge are consecutive): dart i with dart i + n/2 differ in edge unless one edge has
 * more than half of all darts, and then U-turns are unavoidable. */
static void pair_by_halves(const int *dart, int n, int *mate)
{
  for (int i = 0; i < n / 2; i++)
    thr_set_pair(mate, dart[i], dart[i + n / 2]);
}

thr_status thr_transition_pair(const thr_frame *frame, const thr_multigraph *multigraph, int *mate, thr_err *err)
{
  thr_status st = THR_OK;
  for (int v = 0; v < multigraph->n_nodes && !st; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];
    int n = multigraph->first[v + 1] - multigraph->first[v];
    if (n % 2) return thr_fail(err, THR_EINPUT, "node %s has an odd number (%d) of passes and ends", frame->name[v], n);
    if (n == 2)
      thr_set_pair(mate, dart[0], dart[1]);
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

typedef struct {
  double extra; /* price of the new pairs less that of the old */
  int a, c;     /* one dart of each pair; a < c */
  bool cross;   /* new pairs (a d)(b c) instead of (a c)(b d), where b = mate of a and d = mate of c */
} exchange;

typedef struct {
  exchange *list;
  int count, capacity;
} exchanges;

static int by_extra(const void *pa, const void *pb)
{
  const exchange *x = pa, *y = pb;
  if (x->extra != y->extra) return x->extra < y->extra ? -1 : 1;
  if (x->a != y->a) return x->a < y->a ? -1 : 1;
  return (x->c > y->c) - (x->c < y->c);
}

static exchange best_exchange(const thr_frame *frame, const thr_multigraph *multigraph, const int *mate, int a, int c)
{
  int b = mate[a], d = mate[c];
  double old = thr_transition_price(frame, multigraph, a, b) + thr_transition_price(frame, multigraph, c, d);
  double straight = thr_transition_price(frame, multigraph, a, c) + thr_transition_price(frame, multigraph, b, d) - old;
  double cross = thr_transition_price(frame, multigraph, a, d) + thr_transition_price(frame, multigraph, b, c) - old;
  return (exchange){straight <= cross ? straight : cross, a, c, cross < straight};
}

/* Exchanges between different circuits at node v: all of them at a small node; at a large one each pair with the next. */
static thr_status collect(const thr_frame *frame, const thr_multigraph *multigraph, const int *mate, const int *circuit, int v,
                          exchanges *x, thr_err *err)
{
  int n = multigraph->first[v + 1] - multigraph->first[v];
  const int *dart = multigraph->dart + multigraph->first[v];
  for (int i = 0; i < n; i++) {
    if (mate[dart[i]] < dart[i]) continue;
    for (int j = i + 1, seen = 0; j < n && (n <= EXACT_DARTS || seen < 1); j++) {
      if (mate[dart[j]] < dart[j]) continue;
      seen++;
      if (circuit[dart[i]] == circuit[dart[j]]) continue;
      thr_status st = thr_grow(&x->list, x->count, &x->capacity, sizeof *x->list, err);
      if (st) return st;
      x->list[x->count++] = best_exchange(frame, multigraph, mate, dart[i], dart[j]);
    }
  }
  return THR_OK;
}

/* One round of Kruskal's rule over exchanges; a pair takes part in at most one exchange a round. */
static int apply_cheapest(exchanges *x, int *mate, const int *circuit, int *parent, bool *moved)
{
  int applied = 0;
  if (x->count) qsort(x->list, (size_t)x->count, sizeof *x->list, by_extra);
  for (int i = 0; i < x->count; i++) {
    int a = x->list[i].a, c = x->list[i].c, b = mate[a], d = mate[c];
    if (moved[a] || moved[c]) continue;
    if (!thr_disjoint_join(parent, circuit[a], circuit[c])) continue;
    thr_set_pair(mate, a, x->list[i].cross ? d : c);
    thr_set_pair(mate, b, x->list[i].cross ? c : d);
    moved[a] = moved[b] = moved[c] = moved[d] = true;
    applied++;
  }
  return applied;
}

thr_status thr_transition_join(const thr_frame *frame, const thr_multigraph *multigraph, int *mate, thr_err *err)
{
  thr_status st = THR_OK;
  exchanges x = {0};
  int *circuit = thr_calloc((size_t)multigraph->n_darts, sizeof *circuit);
  int *parent = thr_calloc((size_t)multigraph->n_darts, sizeof *parent);
  bool *moved = thr_calloc((size_t)multigraph->n_darts, sizeof *moved);
  if (!circuit || !parent || !moved) {
    st = thr_nomem(err);
    goto done;
  }
  do {
    x.count = 0;
    thr_threading_label(multigraph, mate, circuit);
    memset(moved, 0, (size_t)multigraph->n_darts * sizeof *moved);
    for (int d = 0; d < multigraph->n_darts; d++)
      parent[d] = d;
    for (int v = 0; v < multigraph->n_nodes; v++)
      if ((st = collect(frame, multigraph, mate, circuit, v, &x, err))) goto done;
  } while (apply_cheapest(&x, mate, circuit, parent, moved) > 0);
done:
  free(x.list);
  free(circuit);
  free(parent);
  free(moved);
  return st;
}

void thr_transition_join_equal(const thr_multigraph *multigraph, const int *circuit, int *parent, int *mate)
{
  for (int d = 0; d + 2 < multigraph->n_darts; d += 2) {
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
    next[multigraph->half[d] >= 0 ? multigraph->half[d] >> 1 : frame->n_edges + multigraph->tail[d]] = d;
}

/* The next number is taken. */
static int take(int *next, int i)
{
  next[i] += 2;
  return next[i] - 2;
}

void thr_transition_walk(const thr_frame *frame, const thr_multigraph *multigraph, const int *half, int n, bool open, int *next,
                         int *mate)
{
  int first = -1, last = open ? take(next, frame->n_edges + thr_tail(frame, half[0])) : -1;
  for (int i = 0; i < n; i++) {
    int copy = take(next, half[i] >> 1), d = multigraph->half[copy] == half[i] ? copy : copy ^ 1;
    if (first < 0) first = d;
    if (last >= 0) thr_set_pair(mate, last, d);
    last = d ^ 1;
  }
  thr_set_pair(mate, last, open ? take(next, frame->n_edges + thr_head(frame, half[n - 1])) : first);
}
