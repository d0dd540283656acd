/* Prices of turns, and the columns of the turning model. */
#include "graph/plan.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* ---- prices ---- */

const char *thr_turn_cost_name(thr_turn_cost cost)
{
  static const char *const name[] = {"angle", "sine", "step"};
  return name[cost];
}

double thr_turn_cost_of(thr_turn_cost cost, double angle)
{
  switch (cost) {
  case THR_TURN_SINE: return sin(angle / 2);
  case THR_TURN_STEP: return angle >= pi / 2 - 1e-6;
  default: return angle;
  }
}

double thr_turn_price(const thr_frame *f, thr_turn_cost cost, int in, int out)
{
  return thr_turn_cost_of(cost, in == (out ^ 1) ? pi : thr_turn_angle(f, in, out));
}

int thr_turning_most_passes(int cover)
{
  return 4 * cover + 4;
}

double thr_turning_extra_limit(const thr_frame *f, int cover, double length_limit)
{
  if (length_limit < 0) return -1;
  return fmax(0, length_limit - cover * thr_frame_total_length(f)) + 1e-11 * length_limit;
}

/* ---- columns ---- */

static int64_t weight_of(double price)
{
  return (int64_t)floor(ldexp(price, THR_TURNING_BITS));
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

int thr_turning_most(const thr_turning_columns *c, int column)
{
  const thr_turning_task *t = c->task;
  if (column < c->first_extra) return t->most_passes;
  if (column < c->first_end) return t->most_passes - t->cover;
  if (column < c->first_back) return t->cords > t->most_passes / 2 ? t->most_passes : 2 * t->cords;
  return t->most_passes / 2;
}

static void set_column(thr_turning_columns *c, int column, int a, int b, double price)
{
  c->half[column][0] = a;
  c->half[column][1] = b;
  c->weight[column] = weight_of(price);
}

static void fill_columns(thr_turning_columns *c)
{
  const thr_frame *f = c->f;
  const thr_turning_task *t = c->task;
  int end = c->first_end, back = c->first_back;
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = f->first[v]; i < f->first[v + 1]; i++) {
      int a = f->half[i];
      for (int j = i + 1; j < f->first[v + 1]; j++)
        set_column(c, thr_turning_column(c, a, f->half[j]), a, f->half[j], thr_turn_price(f, t->cost, a ^ 1, f->half[j]));
      c->end_column[a] = -1;
      if (t->end_allowed && t->end_allowed[v]) {
        c->end_column[a] = end;
        set_column(c, end++, a, -1, 0);
      }
      if (thr_degree(f, v) == 1) set_column(c, back++, a, a, thr_turn_cost_of(t->cost, pi));
    }
  for (int e = 0; e < f->n_edges; e++)
    set_column(c, c->first_extra + e, 2 * e, 2 * e + 1, t->price_per_length * f->length[e]);
}

static void fill_lengths(thr_turning_columns *c)
{
  double longest = 0;
  for (int e = 0; e < c->f->n_edges; e++)
    longest = fmax(longest, c->f->length[e]);
  for (int e = 0; e < c->f->n_edges; e++)
    c->length[e] = (int64_t)floor(ldexp(c->f->length[e] / longest, THR_LENGTH_BITS));
  double limit = ceil(ldexp(c->task->extra_limit / longest, THR_LENGTH_BITS)) + 1;
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
    backs += d == 1;
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
  if (!(t->price_per_length >= 0) || !isfinite(t->price_per_length) || !(t->extra_limit < INFINITY))
    return thr_fail(err, THR_EINPUT, "the price per length must be 0 or more, and finite");
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
  c->length = thr_calloc(m, sizeof *c->length);
  st = c->component && c->pair_first && c->position && c->end_column && c->length ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(f, c->component, &c->n_components, err);
  if (!st) st = count_columns(c, err);
  if (!st) {
    c->half = thr_calloc((size_t)c->n_columns, sizeof *c->half);
    c->weight = thr_calloc((size_t)c->n_columns, sizeof *c->weight);
    if (!c->half || !c->weight) st = thr_nomem(err);
  }
  for (size_t e = 0; e < m && !st; e++)
    if (!(f->length[e] * task->price_per_length < 1e4))
      st = thr_fail(err, THR_EINPUT, "the price per length makes edge %zu cost more than 10000", e);
  if (st) {
    thr_turning_columns_destroy(c);
    return st;
  }
  fill_columns(c);
  fill_lengths(c);
  return THR_OK;
}

void thr_turning_columns_destroy(thr_turning_columns *c)
{
  free(c->component);
  free(c->pair_first);
  free(c->position);
  free(c->end_column);
  free(c->half);
  free(c->weight);
  free(c->length);
  *c = (thr_turning_columns){0};
}
