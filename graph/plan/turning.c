/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prices turns, and numbers the columns of the programme for least turning
 * (graph/plan/turning_proof.h has the model).
 *
 * A price is a function of the turning angle that never falls as the angle grows. Prices become
 * integers, in units of 2^-THR_TURNING_BITS and rounded down, so that bounds of sums of prices are
 * exact and never too high.
 *
 * Columns are numbered kind after kind: turns (pairs of edges at a node), extra passes (one per
 * edge), cord ends (one per half-edge at a node where ends are allowed), U-turns. Example: a node
 * of d edges has d (d - 1) / 2 turns, of which the pair of its half-edges i < j is number i (2 d -
 * i - 1) / 2 + j - i - 1. */
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

/* Returns whether a turn has 90 degrees or more, to 1e-6 rad: its cosine is at most sin 1e-6, so in
 * . out <= 0, or its square at most 1e-12 |in|^2 |out|^2. No angle is computed, so that rounding
 * cannot decide. */
static bool is_step(const thr_frame *frame, int in, int out)
{
  double arriving[3], leaving[3];

  /* Scalar product, and the product of the squared lengths. */
  thr_direction(frame, in, arriving);
  thr_direction(frame, out, leaving);
  double dot = arriving[0] * leaving[0] + arriving[1] * leaving[1] + arriving[2] * leaving[2];
  double squares =
      (arriving[0] * arriving[0] + arriving[1] * arriving[1] + arriving[2] * arriving[2]) *
      (leaving[0] * leaving[0] + leaving[1] * leaving[1] + leaving[2] * leaving[2]);

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
  /* A U-turn's angle is exactly pi. */
  if (in == (out ^ 1)) return thr_turn_cost_of(cost, THR_PI);
  return thr_turn_counted(cost) ? costs[cost].counts(frame, in, out)
                                : thr_turn_cost_of(cost, thr_turn_angle(frame, in, out));
}

double thr_turn_closed(thr_turn_cost cost)
{
  return costs[cost].closed;
}

/* Passes of edge e at least, when every edge has cover: the framework may ask for more. */
static int turning_cover(const thr_frame *frame, int cover, int e)
{
  const thr_request options = {.cover = cover};
  return thr_plan_cover(frame, &options, e);
}

double thr_turning_base_length(const thr_frame *frame, int cover)
{
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++)
    sum += turning_cover(frame, cover, e) * frame->length[e];
  return sum;
}

int thr_turning_most_passes(const thr_frame *frame, int cover)
{
  int most = cover;
  for (int e = 0; e < frame->n_edges; e++)
    if (turning_cover(frame, cover, e) > most) most = turning_cover(frame, cover, e);
  return 4 * most + 4;
}

double thr_turning_extra_limit(const thr_frame *frame, int cover, double length_limit)
{
  /* Without a limit, -1; else with a little more than the difference. */
  if (length_limit < 0) return -1;
  return fmax(0, length_limit - thr_turning_base_length(frame, cover)) + 1e-11 * length_limit;
}

/* ---- columns ---- */

/* Returns a price as an integer, rounded down. */
static int64_t weight_of(double price)
{
  return (int64_t)floor(price * (double)(INT64_C(1) << THR_TURNING_BITS));
}

/* Computes the number of a turn from the places of its half-edges among those of the node. */
int thr_turning_column(const thr_turning_columns *turning_columns, int a, int b)
{
  int v = thr_tail(turning_columns->f, a), degree = thr_degree(turning_columns->f, v),
      i = turning_columns->position[a], j = turning_columns->position[b];

  /* Pairs are numbered with the lower place first. */
  if (i > j) {
    int larger = i;
    i = j;
    j = larger;
  }

  return turning_columns->pair_first[v] + i * (2 * degree - i - 1) / 2 + (j - i - 1);
}

bool thr_turning_open(const thr_turning_columns *turning_columns, int component)
{
  /* Any cord end in this component will do. */
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    if (turning_columns->component[v] == component &&
        turning_columns->supply[turning_columns->end_group[v]][1] > 0)
      return true;
  return false;
}

/* Returns the bound that the passes of the edges, or the ends of a node or component, put on a
 * column. */
int thr_turning_most(const thr_turning_columns *turning_columns, int column)
{
  int a = turning_columns->half[column][0] >> 1,
      b = turning_columns->half[column][1] >> 1; /* edges; b < 0 of an end */

  /* A turn has at most as many passes as either of its edges. */
  if (column < turning_columns->first_extra)
    return turning_columns->most[a] < turning_columns->most[b] ? turning_columns->most[a]
                                                               : turning_columns->most[b];

  /* Extra passes: what the cover leaves. */
  if (column < turning_columns->first_end)
    return turning_columns->most[a] - turning_columns->cover[a];

  /* A U-turn takes two passes of its edge. */
  if (column >= turning_columns->first_back) return turning_columns->most[a] / 2;

  /* Ends: as many as the equation of their node or component has. */
  int ends = turning_columns->supply[turning_columns->end_group[thr_tail(
      turning_columns->f, turning_columns->half[column][0])]][1];
  return ends < turning_columns->most[a] ? ends : turning_columns->most[a];
}

/* Sets the half-edges and the weight of a column. task->cut limits what a single turn counts
 * for. */
static void set_column(thr_turning_columns *turning_columns, int column, int a, int b, double price)
{
  const int64_t weight = weight_of(price), cut = turning_columns->task->cut;
  turning_columns->half[column][0] = a;
  turning_columns->half[column][1] = b;
  turning_columns->weight[column] = cut > 0 && weight > cut ? cut : weight;
}

/* Returns whether the model has U-turns at a node of this degree: with one edge, or with a cut at
 * any node. Tube joints have none. */
static bool turns_back(const thr_turning_task *task, int degree)
{
  return !task->tube && (degree == 1 || task->cut > 0);
}

/* Fills in the turns of node v, priced as thr_turn_price does it. out: [degree] scratch for the
 * directions. */
static void fill_turns(thr_turning_columns *turning_columns, int v, double (*out)[3])
{
  const thr_turning_task *task = turning_columns->task;
  const int *half = turning_columns->f->half + turning_columns->f->first[v];
  int degree = thr_degree(turning_columns->f, v), column = turning_columns->pair_first[v];

  /* Each direction is computed once. */
  for (int i = 0; i < degree; i++)
    thr_direction(turning_columns->f, half[i], out[i]);

  /* The turn from edge i to edge j: in along i, against its direction outwards. */
  for (int i = 0; i < degree; i++) {
    const double in[3] = {-out[i][0], -out[i][1], -out[i][2]};
    for (int j = i + 1; j < degree; j++, column++) {
      double price = 0;
      if (thr_turn_counted(task->cost) && !task->free_turns)
        price = thr_turn_price(turning_columns->f, task->cost, half[i] ^ 1, half[j]);
      else if (!task->free_turns)
        price = thr_turn_cost_of(task->cost, thr_angle_between(in, out[j]));
      set_column(turning_columns, column, half[i], half[j], price);
    }
  }
}

/* Fills in all columns. */
static thr_status fill_columns(thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  const thr_turning_task *task = turning_columns->task;
  int end = turning_columns->first_end, back = turning_columns->first_back;
  const int most = thr_frame_largest_degree(frame);

  double(*out)[3] = thr_calloc((size_t)most, sizeof *out);
  if (!out) return thr_nomem(err);

  /* By node: turns, ends, and U-turns, each in its own range of numbers. */
  for (int v = 0; v < frame->n_nodes; v++) {
    fill_turns(turning_columns, v, out);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int a = frame->half[i];
      turning_columns->end_column[a] = -1;
      if (task->end_allowed && task->end_allowed[v]) {
        turning_columns->end_column[a] = end;
        set_column(turning_columns, end++, a, -1, 0);
      }
      if (turns_back(task, thr_degree(frame, v)))
        set_column(turning_columns, back++, a, a, thr_turn_cost_of(task->cost, THR_PI));
    }
  }

  free(out);

  /* By edge: extra passes. */
  for (int e = 0; e < frame->n_edges; e++)
    set_column(turning_columns, turning_columns->first_extra + e, 2 * e, 2 * e + 1,
               task->price_per_length * frame->length[e]);

  return THR_OK;
}

/* Returns the length of the longest edge. */
static double longest_edge(const thr_frame *frame)
{
  double longest = 0;
  for (int e = 0; e < frame->n_edges; e++)
    longest = fmax(longest, frame->length[e]);
  return longest;
}

/* Fills in the lengths as integers, rounded down, relative to the longest edge. */
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

/* Numbers the columns, kind after kind. Turns are counted in 64 bits: a node of 100,000 edges has
 * 5e9 of them. */
static thr_status count_columns(thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  int64_t turns = 0;
  int ends = 0, backs = 0;

  /* Count turns, ends and U-turns; number the half-edges at each node. */
  for (int v = 0; v < frame->n_nodes; v++) {
    int degree = thr_degree(frame, v);
    turning_columns->pair_first[v] = (int)turns;
    turns += (int64_t)degree * (degree - 1) / 2;
    if (turns > INT_MAX / 8)
      return thr_fail(err, THR_EINPUT,
                      "more than %d possible turns at the nodes; node %s alone has %d edges",
                      INT_MAX / 8, frame->name[v], degree);
    ends +=
        turning_columns->task->end_allowed && turning_columns->task->end_allowed[v] ? degree : 0;
    backs += turns_back(turning_columns->task, degree) ? degree : 0;
    for (int i = 0; i < degree; i++)
      turning_columns->position[frame->half[frame->first[v] + i]] = i;
  }

  /* The ranges of numbers. */
  turning_columns->first_extra = (int)turns;
  turning_columns->first_end = turning_columns->first_extra + frame->n_edges;
  turning_columns->first_back = turning_columns->first_end + ends;
  turning_columns->n_columns = turning_columns->first_back + backs;

  return THR_OK;
}

/* Checks that the numbers of a task make sense. */
static thr_status check_task(const thr_turning_task *task, thr_err *err)
{
  /* Passes and cords. */
  if (task->cover < 1 || task->most_passes < task->cover || task->most_passes > 1000000 ||
      task->cords < 1 || task->cords > 1000000)
    return thr_fail(err, THR_EINPUT,
                    "cover %d, at most %d passes, %d cords: need 1 <= cover <= passes <= 1000000, "
                    "1 <= cords <= 1000000",
                    task->cover, task->most_passes, task->cords);

  /* Numbers that are 0 if nothing is said. */
  if (task->cords_least < 0 || task->cords_least > task->cords || task->capacity < 0)
    return thr_fail(err, THR_EINPUT, "at least %d cords of at most %d, %d passes at most",
                    task->cords_least, task->cords, task->capacity);

  /* NaN fails these tests, too. */
  if (!(task->price_per_length >= 0) || !isfinite(task->price_per_length) ||
      !(task->extra_limit < INFINITY))
    return thr_fail(err, THR_EINPUT, "the price per length must be 0 or more, and finite");

  return THR_OK;
}

/* Fills in the limits: passes of every edge, and cord ends of every equation. */
static thr_status fill_limits(thr_turning_columns *turning_columns, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  const thr_turning_task *task = turning_columns->task;
  const thr_request options = {.cover = task->cover, .capacity = task->capacity};

  turning_columns->n_ends = task->end_count ? frame->n_nodes : turning_columns->n_components;
  turning_columns->supply = thr_scratch_array(
      &turning_columns->own, (size_t)turning_columns->n_ends, sizeof *turning_columns->supply);
  if (!turning_columns->supply) return thr_nomem(err);

  /* The cover must not exceed the capacity. */
  for (int e = 0; e < frame->n_edges; e++) {
    int capacity = thr_plan_capacity(frame, &options, e);
    turning_columns->cover[e] = thr_plan_cover(frame, &options, e);
    turning_columns->most[e] = capacity < task->most_passes ? capacity : task->most_passes;
    if (turning_columns->cover[e] > turning_columns->most[e])
      return thr_fail(err, capacity < turning_columns->cover[e] ? THR_EINFEASIBLE : THR_EINPUT,
                      "edge %s-%s needs %d passes, but has room for %d",
                      frame->name[frame->edge[e][0]], frame->name[frame->edge[e][1]],
                      turning_columns->cover[e], turning_columns->most[e]);
  }

  /* Equations of ends: by node if the ends are counted there, else by component. */
  for (int v = 0; v < frame->n_nodes; v++) {
    turning_columns->end_group[v] = task->end_count ? v : turning_columns->component[v];
    if (task->end_count)
      turning_columns->supply[v][0] = turning_columns->supply[v][1] = task->end_count[v];
  }

  /* In a component the cords have two ends each. */
  for (int k = 0; k < turning_columns->n_ends && task->end_allowed && !task->end_count; k++) {
    turning_columns->supply[k][0] = 2 * (task->cords_least ? task->cords_least : task->cords);
    turning_columns->supply[k][1] = 2 * task->cords;
  }

  return THR_OK;
}

/* Makes the columns: checks the task, finds limits, numbers the columns, and prices them. */
thr_status thr_turning_columns_init(thr_turning_columns *turning_columns, const thr_frame *frame,
                                    const thr_turning_task *task, thr_err *err)
{
  /* Arrays that depend on nodes and edges, then those that depend on columns. */
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  *turning_columns = (thr_turning_columns){.f = frame, .task = task};
  thr_status st = check_task(task, err);
  if (st) return st;

  /* By node, by half-edge, by edge. */
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

  /* The components tell which ends belong together. */
  if (!st)
    st = thr_frame_components(frame, turning_columns->component, &turning_columns->n_components,
                              err);

  if (!st) st = fill_limits(turning_columns, err);
  if (!st) st = count_columns(turning_columns, err);

  /* The number of columns is known only now. */
  if (!st) {
    turning_columns->half = thr_scratch_array(
        &turning_columns->own, (size_t)turning_columns->n_columns, sizeof *turning_columns->half);
    turning_columns->weight = thr_scratch_array(
        &turning_columns->own, (size_t)turning_columns->n_columns, sizeof *turning_columns->weight);
    st = thr_scratch_check(&turning_columns->own, err);
  }

  /* Prices of lengths must fit into 64 bits with their bits below the point. */
  for (size_t e = 0; e < m && !st; e++)
    if (!(frame->length[e] * task->price_per_length < 1e4))
      st = thr_fail(err, THR_EINPUT, "the price per length makes edge %zu cost more than 10000", e);

  /* Prices and lengths as integers. */
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
