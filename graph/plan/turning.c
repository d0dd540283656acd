/* Prices of turns, and the columns of the turning model. */
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/angle.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* ---- prices ---- */

const char *thr_turn_cost_name(int cost)
{
  static const char *const name[] = {"angle", "sine", "step"};
  return name[cost];
}

double thr_turn_cost_of(thr_turn_cost cost, double angle)
{
  switch (cost) {
  case THR_TURN_SINE: return sin(angle / 2);
  case THR_TURN_STEP: return angle >= THR_PI / 2 - 1e-6;
  default: return angle;
  }
}

/* Is the turn one of 90 degrees or more, to 1e-6 rad? Then its cosine is at most sin 1e-6: in . out <= 0, or its square at most
 * 1e-12 |in|^2 |out|^2. Whoever prices steps asks here, for at the threshold two formulas would give two prices. */
static bool is_step(const thr_frame *f, int in, int out)
{
  double a[3], b[3];
  thr_direction(f, in, a);
  thr_direction(f, out, b);
  double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  double squares = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  return dot <= 0 || dot * dot <= 1e-12 * squares;
}

double thr_turn_price(const thr_frame *f, thr_turn_cost cost, int in, int out)
{
  if (in == (out ^ 1)) return thr_turn_cost_of(cost, THR_PI);
  return cost == THR_TURN_STEP ? is_step(f, in, out) : thr_turn_cost_of(cost, thr_turn_angle(f, in, out));
}

int thr_turning_cover(const thr_frame *f, int cover, int e)
{
  const thr_plan_options o = {.cover = cover};
  return thr_plan_cover(f, &o, e);
}

double thr_turning_base_length(const thr_frame *f, int cover)
{
  double sum = 0;
  for (int e = 0; e < f->n_edges; e++)
    sum += thr_turning_cover(f, cover, e) * f->length[e];
  return sum;
}

int thr_turning_most_passes(const thr_frame *f, int cover)
{
  int most = cover;
  for (int e = 0; e < f->n_edges; e++)
    if (thr_turning_cover(f, cover, e) > most) most = thr_turning_cover(f, cover, e);
  return 4 * most + 4;
}

double thr_turning_extra_limit(const thr_frame *f, int cover, double length_limit)
{
  if (length_limit < 0) return -1;
  return fmax(0, length_limit - thr_turning_base_length(f, cover)) + 1e-11 * length_limit;
}

/* ---- columns ---- */

static int64_t weight_of(double price)
{
  return (int64_t)floor(price * (double)(INT64_C(1) << THR_TURNING_BITS));
}

int thr_turning_column(const thr_turning_columns *c, int a, int b)
{
  int v = thr_tail(c->f, a), d = thr_degree(c->f, v), i = c->position[a], j = c->position[b];
  if (i > j) {
    int larger = i;
    i = j;
    j = larger;
  }
  return c->pair_first[v] + i * (2 * d - i - 1) / 2 + (j - i - 1);
}

bool thr_turning_open(const thr_turning_columns *c, int component)
{
  for (int v = 0; v < c->f->n_nodes; v++)
    if (c->component[v] == component && c->supply[c->end_group[v]][1] > 0) return true;
  return false;
}

int thr_turning_most(const thr_turning_columns *c, int column)
{
  int a = c->half[column][0] >> 1, b = c->half[column][1] >> 1; /* edges; b < 0 of an end */
  if (column < c->first_extra) return c->most[a] < c->most[b] ? c->most[a] : c->most[b];
  if (column < c->first_end) return c->most[a] - c->cover[a];
  if (column >= c->first_back) return c->most[a] / 2;
  int ends = c->supply[c->end_group[thr_tail(c->f, c->half[column][0])]][1];
  return ends < c->most[a] ? ends : c->most[a];
}

static void set_column(thr_turning_columns *c, int column, int a, int b, double price)
{
  c->half[column][0] = a;
  c->half[column][1] = b;
  c->weight[column] = weight_of(price);
}

/* The turns of node v, priced as thr_turn_price does it. out: [degree] scratch. */
static void fill_turns(thr_turning_columns *c, int v, double (*out)[3])
{
  const thr_turning_task *t = c->task;
  const int *half = c->f->half + c->f->first[v];
  int d = thr_degree(c->f, v), column = c->pair_first[v];
  for (int i = 0; i < d; i++)
    thr_direction(c->f, half[i], out[i]);
  for (int i = 0; i < d; i++) {
    const double in[3] = {-out[i][0], -out[i][1], -out[i][2]};
    for (int j = i + 1; j < d; j++, column++) {
      double price = 0;
      if (t->cost == THR_TURN_STEP && !t->free_turns)
        price = thr_turn_price(c->f, t->cost, half[i] ^ 1, half[j]);
      else if (!t->free_turns)
        price = thr_turn_cost_of(t->cost, thr_angle_between(in, out[j]));
      set_column(c, column, half[i], half[j], price);
    }
  }
}

static thr_status fill_columns(thr_turning_columns *c, thr_err *err)
{
  const thr_frame *f = c->f;
  const thr_turning_task *t = c->task;
  int end = c->first_end, back = c->first_back, most = 0;
  for (int v = 0; v < f->n_nodes; v++)
    if (thr_degree(f, v) > most) most = thr_degree(f, v);
  double(*out)[3] = thr_calloc((size_t)most, sizeof *out);
  if (!out) return thr_nomem(err);
  for (int v = 0; v < f->n_nodes; v++) {
    fill_turns(c, v, out);
    for (int i = f->first[v]; i < f->first[v + 1]; i++) {
      int a = f->half[i];
      c->end_column[a] = -1;
      if (t->end_allowed && t->end_allowed[v]) {
        c->end_column[a] = end;
        set_column(c, end++, a, -1, 0);
      }
      if (thr_degree(f, v) == 1 && !t->tube) set_column(c, back++, a, a, thr_turn_cost_of(t->cost, THR_PI));
    }
  }
  free(out);
  for (int e = 0; e < f->n_edges; e++)
    set_column(c, c->first_extra + e, 2 * e, 2 * e + 1, t->price_per_length * f->length[e]);
  return THR_OK;
}

static double longest_edge(const thr_frame *f)
{
  double longest = 0;
  for (int e = 0; e < f->n_edges; e++)
    longest = fmax(longest, f->length[e]);
  return longest;
}

static void fill_lengths(thr_turning_columns *c)
{
  double longest = longest_edge(c->f);
  for (int e = 0; e < c->f->n_edges; e++)
    c->length[e] = (int64_t)floor(ldexp(c->f->length[e] / longest, THR_LENGTH_BITS));
}

void thr_turning_limit(thr_turning_columns *c)
{
  double longest = longest_edge(c->f), limit = ceil(ldexp(c->task->extra_limit / longest, THR_LENGTH_BITS)) + 1;
  c->extra_limit = c->task->extra_limit < 0 || limit > 4e18 ? -1 : (int64_t)limit; /* so far above that it limits nothing */
}

/* Numbers the columns. Turns are counted in 64 bits: a node of 100,000 edges has 5e9 of them. */
static thr_status count_columns(thr_turning_columns *c, thr_err *err)
{
  const thr_frame *f = c->f;
  int64_t turns = 0;
  int ends = 0, backs = 0;
  for (int v = 0; v < f->n_nodes; v++) {
    int d = thr_degree(f, v);
    c->pair_first[v] = (int)turns;
    turns += (int64_t)d * (d - 1) / 2;
    if (turns > INT_MAX / 8)
      return thr_fail(err, THR_EINPUT, "more than %d possible turns at the nodes; node %s alone has %d edges", INT_MAX / 8,
                      f->name[v], d);
    ends += c->task->end_allowed && c->task->end_allowed[v] ? d : 0;
    backs += d == 1 && !c->task->tube;
    for (int i = 0; i < d; i++)
      c->position[f->half[f->first[v] + i]] = i;
  }
  c->first_extra = (int)turns;
  c->first_end = c->first_extra + f->n_edges;
  c->first_back = c->first_end + ends;
  c->n_columns = c->first_back + backs;
  return THR_OK;
}

static thr_status check_task(const thr_turning_task *t, thr_err *err)
{
  if (t->cover < 1 || t->most_passes < t->cover || t->most_passes > 1000000 || t->cords < 1 || t->cords > 1000000)
    return thr_fail(err, THR_EINPUT,
                    "cover %d, at most %d passes, %d cords: need 1 <= cover <= passes <= 1000000, 1 <= cords <= 1000000",
                    t->cover, t->most_passes, t->cords);
  if (t->cords_least < 0 || t->cords_least > t->cords || t->capacity < 0)
    return thr_fail(err, THR_EINPUT, "at least %d cords of at most %d, %d passes at most", t->cords_least, t->cords, t->capacity);
  if (!(t->price_per_length >= 0) || !isfinite(t->price_per_length) || !(t->extra_limit < INFINITY))
    return thr_fail(err, THR_EINPUT, "the price per length must be 0 or more, and finite");
  return THR_OK;
}

/* Passes of every edge, and ends of every equation. */
static thr_status fill_limits(thr_turning_columns *c, thr_err *err)
{
  const thr_frame *f = c->f;
  const thr_turning_task *t = c->task;
  const thr_plan_options o = {.cover = t->cover, .capacity = t->capacity};
  c->n_ends = t->end_count ? f->n_nodes : c->n_components;
  c->supply = thr_calloc((size_t)c->n_ends, sizeof *c->supply);
  if (!c->supply) return thr_nomem(err);
  for (int e = 0; e < f->n_edges; e++) {
    int capacity = thr_plan_capacity(f, &o, e);
    c->cover[e] = thr_plan_cover(f, &o, e);
    c->most[e] = capacity < t->most_passes ? capacity : t->most_passes;
    if (c->cover[e] > c->most[e])
      return thr_fail(err, capacity < c->cover[e] ? THR_EINFEASIBLE : THR_EINPUT,
                      "edge %s-%s needs %d passes, but has room for %d", f->name[f->edge[e][0]], f->name[f->edge[e][1]],
                      c->cover[e], c->most[e]);
  }
  for (int v = 0; v < f->n_nodes; v++) {
    c->end_group[v] = t->end_count ? v : c->component[v];
    if (t->end_count) c->supply[v][0] = c->supply[v][1] = t->end_count[v];
  }
  for (int k = 0; k < c->n_ends && t->end_allowed && !t->end_count; k++) {
    c->supply[k][0] = 2 * (t->cords_least ? t->cords_least : t->cords);
    c->supply[k][1] = 2 * t->cords;
  }
  return THR_OK;
}

thr_status thr_turning_columns_init(thr_turning_columns *c, const thr_frame *f, const thr_turning_task *task, thr_err *err)
{
  size_t n = (size_t)f->n_nodes, m = (size_t)f->n_edges;
  *c = (thr_turning_columns){.f = f, .task = task};
  thr_status st = check_task(task, err);
  if (st) return st;
  c->component = thr_calloc(n, sizeof *c->component);
  c->pair_first = thr_calloc(n, sizeof *c->pair_first);
  c->position = thr_calloc(2 * m, sizeof *c->position);
  c->end_column = thr_calloc(2 * m, sizeof *c->end_column);
  c->end_group = thr_calloc(n, sizeof *c->end_group);
  c->cover = thr_calloc(m, sizeof *c->cover);
  c->most = thr_calloc(m, sizeof *c->most);
  c->length = thr_calloc(m, sizeof *c->length);
  st = c->component && c->pair_first && c->position && c->end_column && c->end_group && c->cover && c->most && c->length
           ? THR_OK
           : thr_nomem(err);
  if (!st) st = thr_frame_components(f, c->component, &c->n_components, err);
  if (!st) st = fill_limits(c, err);
  if (!st) st = count_columns(c, err);
  if (!st) {
    c->half = thr_calloc((size_t)c->n_columns, sizeof *c->half);
    c->weight = thr_calloc((size_t)c->n_columns, sizeof *c->weight);
    if (!c->half || !c->weight) st = thr_nomem(err);
  }
  for (size_t e = 0; e < m && !st; e++)
    if (!(f->length[e] * task->price_per_length < 1e4))
      st = thr_fail(err, THR_EINPUT, "the price per length makes edge %zu cost more than 10000", e);
  if (!st) st = fill_columns(c, err);
  if (!st) fill_lengths(c);
  if (!st) thr_turning_limit(c);
  if (st) thr_turning_columns_destroy(c);
  return st;
}

void thr_turning_columns_destroy(thr_turning_columns *c)
{
  free(c->component);
  free(c->pair_first);
  free(c->position);
  free(c->end_column);
  free(c->end_group);
  free(c->cover);
  free(c->most);
  free(c->supply);
  free(c->half);
  free(c->weight);
  free(c->length);
  *c = (thr_turning_columns){0};
}
