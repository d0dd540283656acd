/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least that cords can do, by exhaustive search over walks. */
#include "tests/judging.h"

#include <math.h>
#include <stdlib.h>

/* ---- the least of all threadings ---- */

long judged_most_states = 8000;

judged judged_of(const thr_frame *f, const thr_request *o, long most_states)
{
  int component[64];
  judged j = {.c = {.f = *f, .o = *o}};
  ck_assert_int_eq(thr_frame_components(f, component, &j.n_pieces, NULL), THR_OK);
  judged_most_states = most_states;
  return j;
}

enum { MOST_APART = 600 }; /* states, where each cord has a limit of its own */

judged_piece judged_piece_find(const judged *j, int k, walks_back back, walks_weights weights,
                               double limit, int most)
{
  judged_piece found = {.known = false};
  walks_piece w;
  const bool apart = weights.length > 0 && limit < 0 && j->c.o.max_length > 0;
  if (apart) weights.longest = j->c.o.max_length * (1 + 1e-9);
  const long most_states =
      apart && judged_most_states > MOST_APART ? MOST_APART : judged_most_states;
  if (!walks_piece_init(&w, &j->c.f, &j->c.o, k, back, j->c.o.turning.cost, INFINITY, most_states))
    return found;
  double *in = calloc((size_t)w.n_states, sizeof *in),
         *out = calloc((size_t)w.n_states, sizeof *out);
  ck_assert(in != NULL && out != NULL);
  walks_begin(&w, in);
  found.known = true;
  found.least[0] = INFINITY;
  for (int i = 1; i <= most && i <= MOST_CORDS; i++) {
    double *swap = in;
    walks_one_more(&w, weights, limit, in, out);
    in = out;
    out = swap;
    found.least[i] = walks_least(&w, in);
    found.n = i;
  }
  free(in);
  free(out);
  return found;
}

const double judged_rounding = 1e-13; /* of a cord's length */
const walks_weights judged_by_length = {.length = 1}, judged_by_turn = {.turn = 1};

/* Cords of piece k, least and most, as the options say for this objective; with ends counted all of
 * them are used. */
static void cords_of(const judged *j, int k, int *least, int *most)
{
  const thr_request *o = &j->c.o;
  int n, component[64], sum = 0;
  *least = thr_plan_cords_least(o);
  *most = !thr_plan_counted(o) || o->cords > MOST_CORDS ? MOST_CORDS : o->cords;
  if (o->ends != THR_ENDS_COUNTS) return;
  ck_assert_int_eq(thr_frame_components(&j->c.f, component, &n, NULL), THR_OK);
  for (int v = 0; v < j->c.f.n_nodes; v++)
    sum += component[v] == k ? o->end_count[v] : 0;
  *least = *most = sum / 2;
}

double judged_between(const judged_piece *l, int least, int most)
{
  double best = INFINITY;
  for (int k = least; k <= most && k <= l->n; k++)
    best = fmin(best, l->least[k]);
  return best;
}

double judged_least(const judged *j, walks_back back, walks_weights weights, double limit)
{
  double sum = 0;
  for (int k = 0; k < j->n_pieces && sum < INFINITY; k++) {
    int least, most;
    cords_of(j, k, &least, &most);
    judged_piece l = judged_piece_find(j, k, back, weights, limit, most);
    if (!l.known) return NAN;
    sum += judged_between(&l, least, most);
  }
  return sum;
}

static judged judged_of_cords(const thr_frame *f, const thr_request *o, int n)
{
  judged j = judged_of(f, o, 400000);
  j.c.o.cords = j.c.o.cords_least = n;
  j.c.o.max_length = 0;
  return j;
}

double judged_together(const thr_frame *f, const thr_request *o, int n)
{
  const judged j = judged_of_cords(f, o, n);
  const double least = judged_least(&j, BACK_ANYWHERE, judged_by_length, -1);
  ck_assert(!isnan(least));
  return least;
}

bool judged_possible(const thr_frame *f, const thr_request *o, int n, double limit)
{
  const judged j = judged_of_cords(f, o, n);
  const double least = judged_least(&j, BACK_ANYWHERE, judged_by_length, limit);
  ck_assert(!isnan(least));
  return least == 0;
}

double judged_longest(const thr_frame *f, const thr_request *o, int n)
{
  double high = judged_together(f, o, n), low = high / n;
  for (int i = 0; i < 45 && isfinite(high); i++) {
    const double half = (low + high) / 2;
    *(judged_possible(f, o, n, half) ? &high : &low) = half;
  }
  return high;
}

double judged_fewest(const judged *j, double limit)
{
  double sum = 0;
  for (int k = 0; k < j->n_pieces; k++) {
    int least, most, i;
    cords_of(j, k, &least, &most);
    judged_piece l = judged_piece_find(j, k, BACK_ANYWHERE, judged_by_length, limit, most);
    if (!l.known) return NAN;
    for (i = least; i <= most && l.least[i] == INFINITY;)
      i++;
    sum += i > most ? INFINITY : (double)i;
  }
  return sum;
}

/* ---- least turning of plans no longer than a limit ---- */

/* Least price of a piece by its length, ascending lengths, descending prices. */
enum { FRONT = 4000 };
typedef struct {
  int n;
  double length[FRONT], price[FRONT];
} front;

static int by_first(const void *a, const void *b)
{
  const double *x = a, *y = b;
  return x[0] != y[0] ? (x[0] > y[0]) - (x[0] < y[0]) : (x[1] > y[1]) - (x[1] < y[1]);
}

static void front_sort(front *f, double (*pair)[2], int n)
{
  qsort(pair, (size_t)n, sizeof *pair, by_first);
  f->n = 0;
  for (int i = 0; i < n; i++) {
    if (f->n && pair[i][1] >= f->price[f->n - 1]) continue;
    ck_assert_int_lt(f->n, FRONT);
    f->length[f->n] = pair[i][0];
    f->price[f->n++] = pair[i][1];
  }
}

/* limit_turn: of each cord, see walks_one_more. False: too large. */
static bool piece_front(const judged *j, int k, double longest, double limit_turn, front *f)
{
  walks_piece w;
  int least, most, n = 0;
  cords_of(j, k, &least, &most);
  if (!walks_piece_init(&w, &j->c.f, &j->c.o, k, BACK_AT_LEAVES, j->c.o.turning.cost, longest,
                        judged_most_states))
    return false;
  double *in = calloc((size_t)w.n_states, sizeof *in),
         *out = calloc((size_t)w.n_states, sizeof *out);
  double(*pair)[2] = calloc((size_t)w.n_states * (size_t)(most - least + 1), sizeof *pair);
  ck_assert(in != NULL && out != NULL && pair != NULL);
  walks_begin(&w, in);
  for (int i = 1; i <= most; i++) {
    double *swap = in;
    walks_one_more(&w, judged_by_turn, limit_turn, in, out);
    in = out;
    out = swap;
    for (long s = 0; s < w.n_states && i >= least; s++)
      if (in[s] < INFINITY && walks_complete(&w, s))
        pair[n][0] = walks_length(&w, s), pair[n++][1] = in[s];
  }
  front_sort(f, pair, n);
  free(in);
  free(out);
  free(pair);
  return true;
}

/* Sums of both, no longer than longest. */
static void front_add(front *sum, const front *more, double longest)
{
  int n = 0;
  double(*pair)[2] = calloc((size_t)(sum->n * more->n + 1), sizeof *pair);
  ck_assert_ptr_nonnull(pair);
  for (int a = 0; a < sum->n; a++)
    for (int b = 0; b < more->n; b++)
      if (sum->length[a] + more->length[b] <= longest) {
        pair[n][0] = sum->length[a] + more->length[b];
        pair[n++][1] = sum->price[a] + more->price[b];
      }
  front_sort(sum, pair, n);
  free(pair);
}

double judged_least_turning(const judged *j, double longest, double limit_turn)
{
  static front sum, more;
  const thr_frame *f = &j->c.f;
  double base = 0, own[PIECES] = {0};
  int n, component[64];
  if (!isfinite(longest)) return judged_least(j, BACK_AT_LEAVES, judged_by_turn, limit_turn);
  ck_assert_int_eq(thr_frame_components(f, component, &n, NULL), THR_OK);
  for (int e = 0; e < f->n_edges; e++) {
    base += walks_cover(f, &j->c.o, e) * f->length[e];
    own[component[f->edge[e][0]]] += walks_cover(f, &j->c.o, e) * f->length[e];
  }
  sum.n = 1;
  sum.length[0] = sum.price[0] = 0;
  for (int k = 0; k < j->n_pieces; k++) {
    if (!piece_front(j, k, longest - (base - own[k]), limit_turn, &more)) return NAN;
    front_add(&sum, &more, longest);
  }
  return sum.n ? sum.price[sum.n - 1] : INFINITY;
}
