/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prices of turns, and the columns of the turning model. */
#include "graph/plan/plan.h"
#include "graph/number.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

/* ---- prices ---- */

static double its_angle(double angle)
{
  return angle;
}

static double half_sine(double angle)
{
  return sin(angle / 2);
}

static double from_a_quarter(double angle)
{
  return angle >= THR_PI / 2 - 1e-6;
}

/* Is the turn one of 90 degrees or more, to 1e-6 rad? Then its cosine is at most sin 1e-6: in . out
 * <= 0, or its square at most 1e-12 |in|^2 |out|^2. */
static bool is_step(const thr_frame *frame, int in, int out)
{
  double a[3], b[3];
  thr_direction(frame, in, a);
  thr_direction(frame, out, b);
  double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  double squares =
      (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  return dot <= 0 || dot * dot <= 1e-12 * squares;
}

static double from_a_half(double angle)
{
  return angle >= THR_PI;
}

static bool is_back(const thr_frame *frame, int in, int out)
{
  (void)frame;
  return in == (out ^ 1);
}

/* All that there is to say of a cost of turns. No turn costs more than a sharper one. */
static const struct {
  const char *name;
  double (*of)(double angle);
  bool (*counts)(const thr_frame *frame, int in,
                 int out); /* which turns cost 1, the others 0; NULL: the angle says the price */
  double closed;           /* of a closed cord at least: a closed curve in space turns by 2 pi
                              (Fenchel 1929), and sin(x / 2) >= x / pi up to pi */
} costs[THR_N_TURN_COSTS] = {
    [THR_TURN_ANGLE] = {"angle", its_angle, NULL, 2 * THR_PI},
    [THR_TURN_SINE] = {"sine", half_sine, NULL, 2},
    [THR_TURN_STEP] = {"step", from_a_quarter, is_step, 0},
    [THR_TURN_UTURN] = {"uturn", from_a_half, is_back, 0},
};

const char *thr_turn_cost_name(int cost)
{
  return costs[cost].name;
}

double thr_turn_cost_of(thr_turn_cost cost, double angle)
{
  return costs[cost].of(angle);
}

bool thr_turn_counted(thr_turn_cost cost)
{
  return costs[cost].counts != NULL;
}

double thr_turn_price(const thr_frame *frame, thr_turn_cost cost, int in, int out)
{
  if (in == (out ^ 1)) return thr_turn_cost_of(cost, THR_PI);
  return thr_turn_counted(cost) ? costs[cost].counts(frame, in, out)
                                : thr_turn_cost_of(cost, thr_turn_angle(frame, in, out));
}

double thr_turn_closed(thr_turn_cost cost)
{
  return costs[cost].closed;
}

int thr_turning_cover(const thr_frame *frame, int cover, int e)
{
  const thr_request options = {.cover = cover};
  return thr_plan_cover(frame, &options, e);
}

double thr_turning_base_length(const thr_frame *frame, int cover)
{
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++)
    sum += thr_turning_cover(frame, cover, e) * frame->length[e];
  return sum;
}

int thr_turning_most_passes(const thr_frame *frame, int cover)
{
  int most = cover;
  for (int e = 0; e < frame->n_edges; e++)
    if (thr_turning_cover(frame, cover, e) > most) most = thr_turning_cover(frame, cover, e);
  return 4 * most + 4;
}

double thr_turning_extra_limit(const thr_frame *frame, int cover, double length_limit)
{
  if (length_limit < 0) return -1;
  return fmax(0, length_limit - thr_turning_base_length(frame, cover)) + 1e-11 * length_limit;
}

/* ---- columns ---- */

static int64_t weight_of(double price)
{
  return (int64_t)floor(price * (double)(INT64_C(1) << THR_TURNING_BITS));
}

int thr_turning_column(const thr_turning_columns *turning_columns, int a, int b)
{
  int v = thr_tail(turning_columns->f, a), d = thr_degree(turning_columns->f, v),
      i = turning_columns->position[a], j = turning_columns->position[b];
  if (i > j) {
    int larger = i;
    i = j;
    j = larger;
  }
  return turning_columns->pair_first[v] + i * (2 * d - i - 1) / 2 + (j - i - 1);
}

bool thr_turning_open(const thr_turning_columns *turning_columns, int component)
{
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    if (turning_columns->component[v] == component &&
        turning_columns->supply[turning_columns->end_group[v]][1] > 0)
      return true;
  return false;
}

int thr_turning_most(const thr_turning_columns *turning_columns, int column)
{
  int a = turning_columns->half[column][0] >> 1,
      b = turning_columns->half[column][1] >> 1; /* edges; b < 0 of an end */
  if (column < turning_columns->first_extra)
    return turning_columns->most[a] < turning_columns->most[b] ? turning_columns->most[a]
                                                               : turning_columns->most[b];
  if (column < turning_columns->first_end)
    return turning_columns->most[a] - turning_columns->cover[a];
  if (column >= turning_columns->first_back) return turning_columns->most[a] / 2;
  int ends = turning_columns->supply[turning_columns->end_group[thr_tail(
      turning_columns->f, turning_columns->half[column][0])]][1];
  return ends < turning_columns->most[a] ? ends : turning_columns->most[a];
}

static void set_column(thr_turning_columns *turning_columns, int column, int a, int b, double price)
{
  const int64_t weight = weight_of(price), cut = turning_columns->task->cut;
  turning_columns->half[column][0] = a;
  turning_columns->half[column][1] = b;
  turning_columns->weight[column] = cut > 0 && weight > cut ? cut : weight;
}

/* Has the model U-turns at a node of so many edges? */
static bool turns_back(const thr_turning_task *task, int degree)
{
  return !task->tube && (degree == 1 || task->cut > 0);
}

/* The turns of node v, priced as thr_turn_price does it. out: [degree] scratch. */
static void fill_turns(thr_turning_columns *turning_columns, int v, double (*out)[3])
{
  const thr_turning_task *turning_task = turning_columns->task;
  const int *half = turning_columns->f->half + turning_columns->f->first[v];
  int d = thr_degree(turning_columns->f, v), column = turning_columns->pair_first[v];
  for (int i = 0; i < d; i++)
    thr_direction(turning_columns->f, half[i], out[i]);
  for (int i = 0; i < d; i++) {
    const double in[3] = {-out[i][0], -out[i][1], -out[i][2]};
    for (int j = i + 1; j < d; j++, column++) {
      double price = 0;
      if (thr_turn_counted(turning_task->cost) && !turning_task->free_turns)
        price = thr_turn_price(turning_columns->f, turning_task->cost, half[i] ^ 1, half[j]);
      else if (!turning_task->free_turns)
        price = thr_turn_cost_of(turning_task->cost, thr_angle_between(in, out[j]));
      set_column(turning_columns, column, half[i], half[j], price);
    }
  }
}

static thr_status fill_columns(thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  const thr_turning_task *turning_task = turning_columns->task;
  int end = turning_columns->first_end, back = turning_columns->first_back;
  const int most = thr_frame_largest_degree(frame);
  double(*out)[3] = thr_calloc((size_t)most, sizeof *out);
  if (!out) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++) {
    fill_turns(turning_columns, v, out);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int a = frame->half[i];
      turning_columns->end_column[a] = -1;
      if (turning_task->end_allowed && turning_task->end_allowed[v]) {
        turning_columns->end_column[a] = end;
        set_column(turning_columns, end++, a, -1, 0);
      }
      if (turns_back(turning_task, thr_degree(frame, v)))
        set_column(turning_columns, back++, a, a, thr_turn_cost_of(turning_task->cost, THR_PI));
    }
  }
  free(out);
  for (int e = 0; e < frame->n_edges; e++)
    set_column(turning_columns, turning_columns->first_extra + e, 2 * e, 2 * e + 1,
               turning_task->price_per_length * frame->length[e]);
  return THR_OK;
}

static double longest_edge(const thr_frame *frame)
{
  double longest = 0;
  for (int e = 0; e < frame->n_edges; e++)
    longest = fmax(longest, frame->length[e]);
  return longest;
}

static void fill_lengths(thr_turning_columns *turning_columns)
{
  double longest = longest_edge(turning_columns->f);
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    turning_columns->length[e] =
        (int64_t)floor(ldexp(turning_columns->f->length[e] / longest, THR_LENGTH_BITS));
}

void thr_turning_limit(thr_turning_columns *turning_columns)
{
  double longest = longest_edge(turning_columns->f),
         limit = ceil(ldexp(turning_columns->task->extra_limit / longest, THR_LENGTH_BITS)) + 1;
  turning_columns->extra_limit = turning_columns->task->extra_limit < 0 || limit > 4e18
                                     ? -1
                                     : (int64_t)limit; /* so far above that it limits nothing */
}

/* Numbers the columns. Turns are counted in 64 bits: a node of 100,000 edges has 5e9 of them. */
static thr_status count_columns(thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  int64_t turns = 0;
  int ends = 0, backs = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    int d = thr_degree(frame, v);
    turning_columns->pair_first[v] = (int)turns;
    turns += (int64_t)d * (d - 1) / 2;
    if (turns > INT_MAX / 8)
      return thr_fail(err, THR_EINPUT,
                      "more than %d possible turns at the nodes; node %s alone has %d edges",
                      INT_MAX / 8, frame->name[v], d);
    ends += turning_columns->task->end_allowed && turning_columns->task->end_allowed[v] ? d : 0;
    backs += turns_back(turning_columns->task, d) ? d : 0;
    for (int i = 0; i < d; i++)
      turning_columns->position[frame->half[frame->first[v] + i]] = i;
  }
  turning_columns->first_extra = (int)turns;
  turning_columns->first_end = turning_columns->first_extra + frame->n_edges;
  turning_columns->first_back = turning_columns->first_end + ends;
  turning_columns->n_columns = turning_columns->first_back + backs;
  return THR_OK;
}

static thr_status check_task(const thr_turning_task *turning_task, thr_err *err)
{
  if (turning_task->cover < 1 || turning_task->most_passes < turning_task->cover ||
      turning_task->most_passes > 1000000 || turning_task->cords < 1 ||
      turning_task->cords > 1000000)
    return thr_fail(err, THR_EINPUT,
                    "cover %d, at most %d passes, %d cords: need 1 <= cover <= passes <= 1000000, "
                    "1 <= cords <= 1000000",
                    turning_task->cover, turning_task->most_passes, turning_task->cords);
  if (turning_task->cords_least < 0 || turning_task->cords_least > turning_task->cords ||
      turning_task->capacity < 0)
    return thr_fail(err, THR_EINPUT, "at least %d cords of at most %d, %d passes at most",
                    turning_task->cords_least, turning_task->cords, turning_task->capacity);
  if (!(turning_task->price_per_length >= 0) || !isfinite(turning_task->price_per_length) ||
      !(turning_task->extra_limit < INFINITY))
    return thr_fail(err, THR_EINPUT, "the price per length must be 0 or more, and finite");
  return THR_OK;
}

/* Passes of every edge, and ends of every equation. */
static thr_status fill_limits(thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  const thr_turning_task *turning_task = turning_columns->task;
  const thr_request options = {.cover = turning_task->cover, .capacity = turning_task->capacity};
  turning_columns->n_ends =
      turning_task->end_count ? frame->n_nodes : turning_columns->n_components;
  turning_columns->supply = thr_scratch_array(
      &turning_columns->own, (size_t)turning_columns->n_ends, sizeof *turning_columns->supply);
  if (!turning_columns->supply) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges; e++) {
    int capacity = thr_plan_capacity(frame, &options, e);
    turning_columns->cover[e] = thr_plan_cover(frame, &options, e);
    turning_columns->most[e] =
        capacity < turning_task->most_passes ? capacity : turning_task->most_passes;
    if (turning_columns->cover[e] > turning_columns->most[e])
      return thr_fail(err, capacity < turning_columns->cover[e] ? THR_EINFEASIBLE : THR_EINPUT,
                      "edge %s-%s needs %d passes, but has room for %d",
                      frame->name[frame->edge[e][0]], frame->name[frame->edge[e][1]],
                      turning_columns->cover[e], turning_columns->most[e]);
  }
  for (int v = 0; v < frame->n_nodes; v++) {
    turning_columns->end_group[v] = turning_task->end_count ? v : turning_columns->component[v];
    if (turning_task->end_count)
      turning_columns->supply[v][0] = turning_columns->supply[v][1] = turning_task->end_count[v];
  }
  for (int k = 0;
       k < turning_columns->n_ends && turning_task->end_allowed && !turning_task->end_count; k++) {
    turning_columns->supply[k][0] =
        2 * (turning_task->cords_least ? turning_task->cords_least : turning_task->cords);
    turning_columns->supply[k][1] = 2 * turning_task->cords;
  }
  return THR_OK;
}

thr_status thr_turning_columns_init(thr_turning_columns *turning_columns, const thr_frame *frame,
                                    const thr_turning_task *task, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  *turning_columns = (thr_turning_columns){.f = frame, .task = task};
  thr_status st = check_task(task, err);
  if (st) return st;
  turning_columns->component =
      thr_scratch_array(&turning_columns->own, n, sizeof *turning_columns->component);
  turning_columns->pair_first =
      thr_scratch_array(&turning_columns->own, n, sizeof *turning_columns->pair_first);
  turning_columns->position =
      thr_scratch_array(&turning_columns->own, 2 * m, sizeof *turning_columns->position);
  turning_columns->end_column =
      thr_scratch_array(&turning_columns->own, 2 * m, sizeof *turning_columns->end_column);
  turning_columns->end_group =
      thr_scratch_array(&turning_columns->own, n, sizeof *turning_columns->end_group);
  turning_columns->cover =
      thr_scratch_array(&turning_columns->own, m, sizeof *turning_columns->cover);
  turning_columns->most =
      thr_scratch_array(&turning_columns->own, m, sizeof *turning_columns->most);
  turning_columns->length =
      thr_scratch_array(&turning_columns->own, m, sizeof *turning_columns->length);
  st = thr_scratch_check(&turning_columns->own, err);
  if (!st)
    st = thr_frame_components(frame, turning_columns->component, &turning_columns->n_components,
                              err);
  if (!st) st = fill_limits(turning_columns, err);
  if (!st) st = count_columns(turning_columns, err);
  if (!st) {
    turning_columns->half = thr_scratch_array(
        &turning_columns->own, (size_t)turning_columns->n_columns, sizeof *turning_columns->half);
    turning_columns->weight = thr_scratch_array(
        &turning_columns->own, (size_t)turning_columns->n_columns, sizeof *turning_columns->weight);
    st = thr_scratch_check(&turning_columns->own, err);
  }
  for (size_t e = 0; e < m && !st; e++)
    if (!(frame->length[e] * task->price_per_length < 1e4))
      st = thr_fail(err, THR_EINPUT, "the price per length makes edge %zu cost more than 10000", e);
  if (!st) st = fill_columns(turning_columns, err);
  if (!st) fill_lengths(turning_columns);
  if (!st) thr_turning_limit(turning_columns);
  if (st) thr_turning_columns_destroy(turning_columns);
  return st;
}

void thr_turning_columns_destroy(thr_turning_columns *turning_columns)
{
  thr_scratch_free(&turning_columns->own);
  *turning_columns = (thr_turning_columns){0};
}
