/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All cords of small pieces, by dynamic programming over walks. */
#include "tests/walks.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- partitions of the edges at a node ----
 * Tables for up to WALKS_DEGREE edges, those of more blocks first, so that tying edges together
 * gives a later one. A partition is written as the lowest member of the block of each edge, in
 * base 8. */

enum { PARTITIONS = 52 };
typedef struct {
  int n, code[PARTITIONS];
  unsigned char tied[PARTITIONS][WALKS_DEGREE][WALKS_DEGREE]; /* by a turn between two edges */
} partitions;

static partitions tables[WALKS_DEGREE + 1];

static int block(int code, int i)
{
  return code >> 3 * i & 7;
}

static int blocks(int code, int d)
{
  int n = 0;
  for (int i = 0; i < d; i++)
    n += block(code, i) == i;
  return n;
}

static int merged(int code, int d, int i, int j)
{
  int a = block(code, i), b = block(code, j), low = a < b ? a : b, to = 0;
  for (int k = 0; k < d; k++) {
    int at = block(code, k);
    to |= (at == a || at == b ? low : at) << 3 * k;
  }
  return to;
}

static void make_table(int d)
{
  partitions *t = &tables[d];
  int all = 1;
  for (int i = 0; i < d; i++)
    all *= 8;
  for (int count = d; count >= 1 && t->n < PARTITIONS; count--)
    for (int code = 0; code < all; code++) {
      bool good = blocks(code, d) == count;
      for (int i = 0; i < d && good; i++)
        good = block(code, i) <= i && block(code, block(code, i)) == block(code, i);
      if (good) t->code[t->n++] = code;
    }
  for (int p = 0; p < t->n; p++)
    for (int i = 0; i < d; i++)
      for (int j = 0; j < d; j++)
        for (int q = 0, to = merged(t->code[p], d, i, j); q < t->n; q++)
          if (t->code[q] == to) t->tied[p][i][j] = (unsigned char)q;
}

static const partitions *table_of(int d)
{
  if (tables[d].n == 0) make_table(d);
  return &tables[d];
}

/* ---- what is asked ---- */

bool walks_may_end(const thr_frame *f, const thr_request *o, int v)
{
  switch (o->ends) {
  case THR_ENDS_FEET: return f->foot[v];
  case THR_ENDS_NODES: return o->end_node[v];
  case THR_ENDS_COUNTS: return o->end_count[v] > 0;
  default: return true;
  }
}

int walks_cover(const thr_frame *f, const thr_request *o, int e)
{
  return f->cover && f->cover[e] > o->cover ? f->cover[e] : o->cover;
}

int walks_capacity(const thr_frame *f, const thr_request *o, int e)
{
  int most = o->capacity > 0 ? o->capacity : INT_MAX;
  return f->capacity && f->capacity[e] > 0 && f->capacity[e] < most ? f->capacity[e] : most;
}

static double dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void vector(const thr_frame *f, int half, double *v)
{
  for (int i = 0; i < 3; i++)
    v[i] = f->xyz[thr_head(f, half)][i] - f->xyz[thr_tail(f, half)][i];
}

static void scale(double *v)
{
  double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
  for (int i = 0; i < 3; i++)
    v[i] /= largest;
}

static double angle_between(const double *a, const double *b)
{
  double cross[3];
  for (int i = 0; i < 3; i++)
    cross[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  return atan2(sqrt(dot(cross, cross)), dot(a, b));
}

double walks_price(const thr_frame *f, thr_turn_cost cost, int in, int out)
{
  double a[3], b[3];
  bool back = in == (out ^ 1);
  vector(f, in, a);
  vector(f, out, b);
  if (cost == THR_TURN_UTURN) return back;
  if (cost == THR_TURN_STEP) {
    scale(a);
    scale(b);
    return back || dot(a, b) <= 0 || dot(a, b) * dot(a, b) <= 1e-12 * (dot(a, a) * dot(b, b));
  }
  double angle = back ? 2 * acos(0) : angle_between(a, b);
  return cost == THR_TURN_SINE ? sin(angle / 2) : angle;
}

/* ---- a piece ---- */

/* Nodes of the piece, local numbers in local[n_nodes of f], else -1. */
static bool take_nodes(walks_piece *w, const thr_frame *f, int k, int *local)
{
  int n, component[64];
  ck_assert_int_le(f->n_nodes, 64);
  ck_assert_int_eq(thr_frame_components(f, component, &n, NULL), THR_OK);
  for (int v = 0; v < f->n_nodes; v++) {
    local[v] = -1;
    if (component[v] != k) continue;
    if (w->n_nodes == WALKS_NODES) return false;
    local[v] = w->n_nodes;
    w->node[w->n_nodes++] = v;
  }
  return true;
}

static bool take_edges(walks_piece *w, const thr_frame *f, const thr_request *o, const int *local)
{
  for (int e = 0; e < f->n_edges; e++) {
    if (local[f->edge[e][0]] < 0) continue;
    if (w->n_edges == WALKS_EDGES) return false;
    int i = w->n_edges++;
    w->edge[i] = e;
    w->length[i] = f->length[e];
    w->least[i] = walks_cover(f, o, e);
    w->most[i] = walks_capacity(f, o, e);
    for (int s = 0; s < 2; s++) {
      int v = local[f->edge[e][s]];
      w->half_tail[2 * i + s] = v;
      w->slot[2 * i + s] = w->degree[v]++;
      if (w->degree[v] > WALKS_DEGREE) return false;
    }
  }
  return true;
}

static void take_turns(walks_piece *w, const thr_frame *f, walks_back back, thr_turn_cost cost)
{
  for (int in = 0; in < 2 * w->n_edges; in++)
    for (int out = 0; out < 2 * w->n_edges; out++) {
      int v = w->half_tail[in ^ 1];
      w->price[in][out] = INFINITY;
      if (v != w->half_tail[out]) continue;
      bool turns_back = in == (out ^ 1),
           may = back == BACK_ANYWHERE || (back == BACK_AT_LEAVES && w->degree[v] == 1);
      int far_in = 2 * w->edge[in >> 1] + (in & 1), far_out = 2 * w->edge[out >> 1] + (out & 1);
      if (!turns_back || may) w->price[in][out] = walks_price(f, cost, far_in, far_out);
    }
}

/* With tube joints an edge that is tied at one of its nodes has a pass. */
static bool tie_covers(const walks_piece *w, int e)
{
  bool is_tied = w->degree[w->half_tail[2 * e]] > 1 || w->degree[w->half_tail[2 * e + 1]] > 1;
  return w->tube && w->least[e] == 1 && w->most[e] == INT_MAX && is_tied;
}

/* As many passes as are needed are those of different cords. */
static bool cords_cover(const walks_piece *w, int e)
{
  return w->least[e] <= w->distinct && w->most[e] == INT_MAX;
}

/* How far passes are counted. */
static void take_tops(walks_piece *w, double count_all)
{
  double left = count_all;
  for (int e = 0; e < w->n_edges; e++)
    left -= w->least[e] * w->length[e];
  for (int e = 0; e < w->n_edges; e++) {
    w->top[e] = w->most[e] < INT_MAX ? w->most[e] : w->least[e];
    if (!isfinite(count_all) && (tie_covers(w, e) || cords_cover(w, e)))
      w->top[e] = w->least[e] = 0;
    if (!isfinite(count_all)) continue;
    int fit = w->least[e] + (left > 0 ? (int)floor(left / w->length[e] + 1e-6) : 0);
    w->top[e] = fit < w->most[e] ? fit : w->most[e];
    w->most[e] = w->top[e];
  }
}

/* Gives every digit its stride; false if there are too many states. */
static bool take_strides(walks_piece *w, long most_states)
{
  long n = 1;
  for (int e = 0; e < w->n_edges && n <= most_states; e++) {
    w->stride[e] = n;
    n *= w->top[e] + 1;
  }
  for (int v = 0; v < w->n_nodes && n <= most_states; v++) {
    w->end_stride[v] = n;
    n *= w->ends[v] > 0 ? w->ends[v] + 1 : 1;
    w->tie_stride[v] = n;
    if (w->tube) n *= table_of(w->degree[v])->n;
  }
  for (int e = 0; e < w->n_edges && n <= most_states && w->distinct > 0; e++) {
    w->cords_stride[e] = n;
    w->here_stride[e] = n * (w->distinct + 1);
    n *= 2 * (w->distinct + 1);
  }
  w->n_states = n;
  return n <= most_states;
}

bool walks_piece_init(walks_piece *w, const thr_frame *f, const thr_request *o, int k,
                      walks_back back, thr_turn_cost cost, double count_all, long most_states)
{
  int local[64];
  *w = (walks_piece){.closed = o->ends == THR_ENDS_CLOSED,
                     .tube = o->joint == THR_JOINT_TUBE,
                     .distinct = o->distinct};
  if (!take_nodes(w, f, k, local) || !take_edges(w, f, o, local)) return false;
  for (int v = 0; v < w->n_nodes; v++) {
    w->may_end[v] = walks_may_end(f, o, w->node[v]);
    w->ends[v] = o->ends == THR_ENDS_COUNTS ? o->end_count[w->node[v]] : -1;
  }
  take_turns(w, f, w->tube ? BACK_NEVER : back, cost);
  take_tops(w, count_all);
  return take_strides(w, most_states);
}

/* ---- states ---- */

static int digit(long state, long stride, int base)
{
  return (int)(state / stride % base);
}

/* The cord that walks passes edge e. */
static long with_cord(const walks_piece *w, long s, int e)
{
  if (w->distinct == 0 || digit(s, w->here_stride[e], 2)) return s;
  return s + w->here_stride[e] +
         (digit(s, w->cords_stride[e], w->distinct + 1) < w->distinct ? w->cords_stride[e] : 0);
}

/* It is at its end: another one walks next. */
static long without_cord(const walks_piece *w, long s)
{
  for (int e = 0; e < w->n_edges && w->distinct > 0; e++)
    s -= digit(s, w->here_stride[e], 2) * w->here_stride[e];
  return s;
}

/* The state with a pass of edge e more; -1: there is no room for it. */
static long with_pass(const walks_piece *w, long s, int e)
{
  s = with_cord(w, s, e);
  if (digit(s, w->stride[e], w->top[e] + 1) < w->top[e]) return s + w->stride[e];
  return w->most[e] == INT_MAX ? s : -1;
}

static long with_end(const walks_piece *w, long s, int v)
{
  if (s < 0 || !w->may_end[v] || w->ends[v] < 0) return w->may_end[v] ? s : -1;
  return digit(s, w->end_stride[v], w->ends[v] + 1) < w->ends[v] ? s + w->end_stride[v] : -1;
}

static long with_turn(const walks_piece *w, long s, int in, int out)
{
  int v = w->half_tail[out];
  if (!w->tube) return s;
  const partitions *t = table_of(w->degree[v]);
  int at = digit(s, w->tie_stride[v], t->n);
  return s + (t->tied[at][w->slot[in ^ 1]][w->slot[out]] - at) * w->tie_stride[v];
}

bool walks_complete(const walks_piece *w, long s)
{
  for (int e = 0; e < w->n_edges; e++) {
    if (digit(s, w->stride[e], w->top[e] + 1) < w->least[e]) return false;
    if (w->distinct > 0 && digit(s, w->cords_stride[e], w->distinct + 1) < w->distinct)
      return false;
  }
  for (int v = 0; v < w->n_nodes; v++) {
    if (w->ends[v] > 0 && digit(s, w->end_stride[v], w->ends[v] + 1) < w->ends[v]) return false;
    if (w->tube &&
        digit(s, w->tie_stride[v], table_of(w->degree[v])->n) < table_of(w->degree[v])->n - 1)
      return false;
  }
  return true;
}

double walks_length(const walks_piece *w, long s)
{
  double sum = 0;
  for (int e = 0; e < w->n_edges; e++)
    sum += digit(s, w->stride[e], w->top[e] + 1) * w->length[e];
  return sum;
}

double walks_least(const walks_piece *w, const double *cost)
{
  double best = INFINITY;
  for (long s = 0; s < w->n_states; s++)
    if (cost[s] < best && walks_complete(w, s)) best = cost[s];
  return best;
}

/* ---- cords ---- */

typedef struct {
  const walks_piece *w;
  walks_weights weights;
  double limit;
  int first; /* edge of a closed cord, none lower on it; -1 = open */
  double
      *at; /* [n_states * 2 * n_edges] least cost of a cord that has just passed this half-edge */
  double *out;
} walker;

static void reach(walker *x, long s, int h, double cost)
{
  long i;
  if (s < 0 || h >> 1 < x->first) return;
  s = with_pass(x->w, s, h >> 1);
  i = s * 2 * x->w->n_edges + h;
  cost += x->weights.length * x->w->length[h >> 1];
  if (s >= 0 && cost < x->at[i]) x->at[i] = cost;
}

static void finish(walker *x, long s, double cost)
{
  if (s < 0) return;
  s = without_cord(x->w, s);
  if (x->limit >= 0) cost = cost <= x->limit ? 0 : INFINITY;
  if (cost < x->out[s]) x->out[s] = cost;
}

/* All that may follow after half-edge h. */
static void leave(walker *x, long s, int h, double cost)
{
  const walks_piece *w = x->w;
  int start = 2 * x->first;
  if (x->limit >= 0 && cost > x->limit) return;
  if (x->first < 0)
    finish(x, with_end(w, s, w->half_tail[h ^ 1]), cost);
  else if (w->price[h][start] < INFINITY)
    finish(x, with_turn(w, s, h, start), cost + x->weights.turn * w->price[h][start]);
  for (int next = 0; next < 2 * w->n_edges; next++)
    if (w->price[h][next] < INFINITY)
      reach(x, with_turn(w, s, h, next), next, cost + x->weights.turn * w->price[h][next]);
}

/* The half-edges of one state in order of cost: passes that it does not count stay in it. */
static void settle(walker *x, long s)
{
  int n = 2 * x->w->n_edges;
  unsigned done = 0;
  for (;;) {
    const double *at = &x->at[s * n];
    int best = -1;
    for (int h = 0; h < n; h++)
      if (!(done >> h & 1) && at[h] < INFINITY && (best < 0 || at[h] < at[best])) best = h;
    if (best < 0) return;
    done |= 1u << best;
    leave(x, s, best, at[best]);
  }
}

static void walk(walker *x, const double *in)
{
  const walks_piece *w = x->w;
  int n = 2 * w->n_edges;
  for (long i = 0; i < w->n_states * n; i++)
    x->at[i] = INFINITY;
  for (long s = 0; s < w->n_states; s++) {
    if (in[s] == INFINITY) continue;
    double cost = x->limit >= 0 ? 0 : in[s];
    if (x->first >= 0) reach(x, s, 2 * x->first, cost);
    for (int h = 0; h < n && x->first < 0; h++)
      reach(x, with_end(w, s, w->half_tail[h]), h, cost);
  }
  for (long s = 0; s < w->n_states; s++)
    settle(x, s);
}

void walks_begin(const walks_piece *w, double *cost)
{
  for (long s = 0; s < w->n_states; s++)
    cost[s] = s == 0 ? 0 : INFINITY;
}

/* From each state that there is by itself, so that what the cord costs is known. */
static void one_more_of_each(const walks_piece *w, walks_weights weights, const double *in,
                             double *out)
{
  const double longest = weights.longest;
  double *from = calloc((size_t)w->n_states, sizeof *from),
         *to = calloc((size_t)w->n_states, sizeof *to);
  ck_assert(from && to);
  weights.longest = 0;
  for (long t = 0; t < w->n_states; t++)
    out[t] = INFINITY;
  for (long s = 0; s < w->n_states; s++) {
    if (in[s] == INFINITY) continue;
    for (long t = 0; t < w->n_states; t++)
      from[t] = t == s ? 0 : INFINITY;
    walks_one_more(w, weights, -1, from, to);
    for (long t = 0; t < w->n_states; t++)
      if (to[t] <= longest) out[t] = fmin(out[t], in[s] + to[t]);
  }
  free(from);
  free(to);
}

void walks_one_more(const walks_piece *w, walks_weights weights, double limit, const double *in,
                    double *out)
{
  if (weights.longest > 0 && limit < 0) {
    one_more_of_each(w, weights, in, out);
    return;
  }
  walker x = {.w = w, .weights = weights, .limit = limit, .first = -1, .out = out};
  x.at = malloc((size_t)w->n_states * 2 * (size_t)w->n_edges * sizeof *x.at);
  ck_assert_ptr_nonnull(x.at);
  for (long s = 0; s < w->n_states; s++)
    out[s] = INFINITY;
  if (!w->closed) walk(&x, in);
  for (x.first = 0; w->closed && x.first < w->n_edges; x.first++)
    walk(&x, in);
  free(x.at);
}

double walks_least_of(const thr_frame *f, const thr_request *o, int cords, walks_weights by)
{
  walks_piece w;
  const walks_back back = by.turn > 0 ? BACK_AT_LEAVES : BACK_ANYWHERE;
  ck_assert(walks_piece_init(&w, f, o, 0, back, o->turning.cost, INFINITY, 100000));
  double *in = calloc((size_t)w.n_states, sizeof *in),
         *out = calloc((size_t)w.n_states, sizeof *out);
  ck_assert(in && out);
  walks_begin(&w, in);
  for (int n = 0; n < cords; n++) {
    double *swap = in;
    walks_one_more(&w, by, -1, in, out);
    in = out;
    out = swap;
  }
  const double least = walks_least(&w, in);
  free(in);
  free(out);
  return least;
}
