/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks lower bounds on the turning or the length of cords that prices of walks prove, in
 * integers.
 *
 * The proof is explained in graph/plan/walk_proof.h: prices of edges and nodes are dual values of a
 * linear programme over walks. This file builds the graph in which walks are steps from place to
 * place, gives every step its reward (`worth`: the prices it collects less what it costs), and
 * finds the walk of largest reward within a number of units by a dynamic programme over places and
 * units. If all cords together have to collect more than K such walks can, no K cords exist within
 * the limit.
 *
 * Order of the file: steps by turning, steps by length, prices, the dynamic programme, the check,
 * and the bound that a single edge gives without prices (Bellman, Ford and Moore). */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/arrays.h"
#include "graph/status.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

__extension__ typedef __int128 wide;

/* Reward where there is no walk: sums with it stay below `lowest`, which no walk reaches. */
static const int64_t none = -(INT64_C(1) << 62);
static const int64_t lowest = -(INT64_C(1) << 61);

bool thr_walk_is_none(int64_t worth)
{
  return worth < lowest;
}

void thr_walk_memory_free(thr_walk_memory *memory, int n)
{
  for (int i = 0; memory && i < n; i++)
    free(memory[i].place);
  free(memory);
}

void thr_walk_proof_destroy(thr_walk_proof *proof)
{
  free(proof->edge);
  free(proof->node);
  thr_walk_memory_free(proof->memory, proof->n_memories);
  *proof = (thr_walk_proof){0};
}

/* ---- steps by turning ---- */

/* Lists the passes that may follow half-edge d, each with the weight of the turn, and returns their
 * number. A negative back[h] forbids the U-turn into h. out: [degree of d's head]. */
static int next_steps(const thr_turning_columns *columns, int d, const int64_t *back,
                      thr_walk_step *out)
{
  const thr_frame *frame = columns->f;
  int v = thr_head(frame, d), n = 0;

  /* At d's head node every other half-edge is a turn with a column of its own; d ^ 1 is the U-turn.
   */
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    int h = frame->half[i];
    if (h != (d ^ 1))
      out[n++] = (thr_walk_step){.half = h,
                                 .weight = columns->weight[thr_turning_column(columns, d ^ 1, h)]};
    else if (back[h] >= 0)
      out[n++] = (thr_walk_step){.half = h, .weight = back[h]};
  }
  return n;
}

/* Fills back[h] with the weight of a U-turn into half-edge h, -1 where none is allowed. anywhere:
 * U-turns are allowed at every node, not only where there is no other edge. */
static void fill_backs(const thr_turning_columns *columns, bool anywhere, int64_t *back)
{
  for (int h = 0; h < 2 * columns->f->n_edges; h++)
    back[h] = anywhere ? (int64_t)floor(ldexp(THR_PI, THR_TURNING_BITS) * (1 - 1e-15)) : -1;

  for (int j = columns->first_back; j < columns->n_columns; j++)
    back[columns->half[j][0]] = columns->weight[j];
}

/* Scratch arrays that live only while the steps are built. */
typedef struct {
  int64_t unit, *back; /* back: [2 * n_edges] */
  int *half,
      *waiting; /* [2 * n_edges] the half-edge at each place; steps that do not lead back yet */
  thr_walk_step *some; /* [largest degree] */
} step_builder;

/* Orders the places such that every step of less than `units` units leads to an earlier place (A.
 * B. Kahn 1962). Returns false if such steps form a cycle. */
static bool order_places(thr_walk_steps *steps, step_builder *builder, int units)
{
  const thr_turning_columns *columns = steps->c;
  const int64_t most = builder->unit < INT64_MAX / units ? units * builder->unit : INT64_MAX;
  int total = 0, placed = 0;

  /* Count for each half-edge of the component its small steps; those without any come first. */
  for (int d = 0; d < 2 * columns->f->n_edges; d++) {
    steps->place[d] = -1;
    builder->waiting[d] = 0;

    if (columns->component[thr_tail(columns->f, d)] != steps->component) continue;
    total++;
    for (int n = next_steps(columns, d, builder->back, builder->some); n > 0; n--)
      builder->waiting[d] += builder->some[n - 1].weight < most;
    if (builder->waiting[d] == 0) builder->half[placed++] = d;
  }

  /* Take places one by one and release their predecessors. Walks are reversible: what precedes d is
   * the reverse of what follows d ^ 1. */
  for (int i = 0; i < placed; i++) {
    int d = builder->half[i];
    steps->place[d] = i;
    for (int n = next_steps(columns, d ^ 1, builder->back, builder->some); n > 0; n--) {
      int before = builder->some[n - 1].half ^ 1;
      if (builder->some[n - 1].weight < most && --builder->waiting[before] == 0)
        builder->half[placed++] = before;
    }
  }

  steps->n = total;
  return placed == total;
}

/* Rounds the weight of a step down to whole units. */
static void count_units(thr_walk_steps *steps, thr_walk_step *step, int64_t unit)
{
  step->units = (int)(step->weight / unit);
  if (step->units > steps->most_units) steps->most_units = step->units;
}

/* Fills the places at which closed walks begin. By turning a walk begins at its lowest edge, in one
 * direction only, because both directions turn alike. With a pull it begins at the node where its
 * ends meet, which may be any node. */
static void fill_closed(thr_walk_steps *steps)
{
  const thr_frame *frame = steps->c->f;
  for (int e = 0; e < frame->n_edges && steps->measure == THR_WALK_TURNING; e++)
    if (steps->place[2 * e] >= 0)
      steps->begin[steps->n_begins++] = (thr_walk_step){.to = steps->place[2 * e], .half = 2 * e};

  /* With a pull: all half-edges that leave node v are the first passes of run number n_homes. */
  for (int v = 0; v < frame->n_nodes && steps->measure == THR_WALK_PULL; v++) {
    if (steps->c->component[v] != steps->component || thr_degree(frame, v) == 0) continue;
    for (int k = frame->first[v]; k < frame->first[v + 1]; k++)
      steps->begin[steps->n_begins++] =
          (thr_walk_step){.to = steps->place[frame->half[k]], .half = frame->half[k]};
    steps->from[++steps->n_homes] = steps->n_begins;
  }
}

/* Fills places and steps for walks measured by turning: a place is the half-edge that was passed
 * last. Returns false if steps of no unit form a cycle. */
static bool fill_turning(thr_walk_steps *steps, step_builder *builder)
{
  int n = 0;
  fill_backs(steps->c, steps->measure == THR_WALK_PULL, builder->back);

  /* Levels are computed THR_WALK_WIDTH at a time if the order allows it, otherwise one by one. */
  if (!order_places(steps, builder, THR_WALK_WIDTH) && !order_places(steps, builder, 1))
    return false;

  /* Append the steps from each place in the order of the places. */
  for (int i = 0; i < steps->n; i++) {
    int d = builder->half[i], count = next_steps(steps->c, d, builder->back, steps->step + n);
    bool may_begin = steps->c->end_column[d] >= 0;
    steps->first[i] = n;
    steps->group[i] = steps->measure == THR_WALK_PULL ? thr_head(steps->c->f, d) : d >> 1;
    steps->end[i] = steps->c->end_column[d ^ 1] >= 0 ? 0 : none;

    /* A step needs the number of the place, which order_places gave it. */
    for (int k = n; k < n + count; k++) {
      steps->step[k].to = steps->place[steps->step[k].half];
      count_units(steps, &steps->step[k], builder->unit);
    }

    if (!steps->closed && may_begin)
      steps->begin[steps->n_begins++] = (thr_walk_step){.to = i, .half = d};

    n += count;
  }

  steps->first[steps->n] = n;
  if (steps->closed) fill_closed(steps);
  return true;
}

/* ---- steps by length ---- */

int thr_walk_exponent(const thr_frame *frame, thr_walk_measure measure)
{
  double longest = 0;
  int exponent;
  if (measure != THR_WALK_LENGTH) return THR_TURNING_BITS;

  /* A power of two, so that the longest edge has about THR_TURNING_BITS bits. */
  for (int e = 0; e < frame->n_edges; e++)
    longest = fmax(longest, frame->length[e]);
  frexp(longest, &exponent);
  return THR_TURNING_BITS - exponent;
}

/* Fills places and steps for walks measured by length: a place is the node where the walk is.
 * Returns false if an edge is shorter than a unit. */
static bool fill_lengths(thr_walk_steps *steps, int64_t unit)
{
  const thr_frame *frame = steps->c->f;
  bool enough = true;
  int n = 0;

  /* Nodes of the component are numbered from 0. */
  for (int v = 0; v < frame->n_nodes; v++)
    steps->place[v] = steps->c->component[v] == steps->component ? steps->n++ : -1;

  for (int v = 0; v < frame->n_nodes; v++) {
    int i = steps->place[v];
    bool may_end =
        thr_degree(frame, v) > 0 && steps->c->end_column[frame->half[frame->first[v]]] >= 0;

    if (i < 0) continue;
    steps->first[i] = n;
    steps->group[i] = i;
    steps->end[i] = may_end ? 0 : none;

    /* One step over each edge at v. Units are rounded down, so that no walk is excluded wrongly;
     * the weight is rounded up, so that no reward is too small. */
    for (int k = frame->first[v]; k < frame->first[v + 1]; k++) {
      int h = frame->half[k];
      thr_walk_step *step = &steps->step[n++];
      double length = ldexp(frame->length[h >> 1], steps->exponent);
      *step = (thr_walk_step){
          .to = steps->place[thr_head(frame, h)], .half = h, .weight = (int64_t)floor(length)};
      count_units(steps, step, unit);
      step->weight = (int64_t)ceil(length);
      enough &= step->units > 0;
      if (!steps->closed && may_end) steps->begin[steps->n_begins++] = *step;
    }

    if (steps->closed) steps->begin[steps->n_begins++] = (thr_walk_step){.to = i};
  }

  steps->first[steps->n] = n;
  return enough;
}

/* ---- steps ---- */

/* Makes one place of every spot, which holds until walks are given a memory (walk_places.c). */
static thr_status fill_spots(thr_walk_steps *steps, thr_err *err)
{
  steps->n_spots = steps->n;
  steps->spot = thr_scratch_array(&steps->own, (size_t)steps->n, sizeof *steps->spot);
  steps->copy = thr_scratch_array(&steps->own, (size_t)steps->n + 1, sizeof *steps->copy);
  thr_status st = thr_scratch_check(&steps->own, err);

  for (int i = 0; i < steps->n && !st; i++)
    steps->spot[i] = steps->copy[i] = i;
  if (!st) steps->copy[steps->n] = steps->n;
  return st;
}

/* Allocates the arrays of the steps and, in own, those that are only needed while they are built.
 */
static thr_status allocate(thr_walk_steps *steps, step_builder *builder, thr_scratch *own,
                           thr_err *err)
{
  const thr_frame *frame = steps->c->f;
  size_t m2 = 2 * (size_t)frame->n_edges, n = (size_t)frame->n_nodes, squares = 0, most = 0;

  /* The number of steps: a pair of edges at a node by turning, one edge by length. */
  for (int v = 0; v < frame->n_nodes; v++) {
    size_t degree = (size_t)thr_degree(frame, v);
    squares += steps->measure == THR_WALK_LENGTH ? degree : degree * degree;
    if (degree > most) most = degree;
  }

  size_t places = m2 > n ? m2 : n;
  steps->place = thr_scratch_array(&steps->own, places, sizeof *steps->place);
  steps->group = thr_scratch_array(&steps->own, places, sizeof *steps->group);
  steps->first = thr_scratch_array(&steps->own, places + 1, sizeof *steps->first);
  steps->step = thr_scratch_array(&steps->own, squares, sizeof *steps->step);
  steps->move = thr_scratch_array(&steps->own, squares, sizeof *steps->move);
  steps->begin = thr_scratch_array(&steps->own, places, sizeof *steps->begin);
  steps->end = thr_scratch_array(&steps->own, places, sizeof *steps->end);
  steps->cut = thr_scratch_array(&steps->own, places, sizeof *steps->cut);
  steps->active = thr_scratch_array(&steps->own, places, sizeof *steps->active);
  steps->from = thr_scratch_array(&steps->own, n + 1, sizeof *steps->from);

  builder->back = thr_scratch_array(own, m2, sizeof *builder->back);
  builder->half = thr_scratch_array(own, m2, sizeof *builder->half);
  builder->waiting = thr_scratch_array(own, m2, sizeof *builder->waiting);
  builder->some = thr_scratch_array(own, most, sizeof *builder->some);

  thr_status st = thr_scratch_check(&steps->own, err);
  return st ? st : thr_scratch_check(own, err);
}

thr_status thr_walk_steps_init(thr_walk_steps *steps, const thr_turning_columns *columns,
                               thr_walk_measure measure, int component, int64_t unit, thr_err *err)
{
  thr_scratch own = {0};
  step_builder builder = {.unit = unit};
  *steps = (thr_walk_steps){.c = columns,
                            .measure = measure,
                            .component = component,
                            .exponent = thr_walk_exponent(columns->f, measure),
                            .closed = !columns->task->end_allowed};
  thr_status st = allocate(steps, &builder, &own, err);

  /* Refuse what a proof from a file may state wrongly. Units of a turn fit into an int, as no price
   * is above 4: the largest is pi. */
  if (!st && !steps->closed && !thr_turning_open(columns, component))
    st = thr_fail(err, THR_EVIOLATED, "walks: component %d has no cord ends", component);
  if (!st && (unit <= 0 || ldexp(4, THR_TURNING_BITS) / (double)unit > 1e9))
    st = thr_fail(err, THR_EVIOLATED, "walks: a unit of %lld is out of range", (long long)unit);

  /* Build the steps of the measure. */
  if (!st && measure != THR_WALK_LENGTH && !fill_turning(steps, &builder))
    st = thr_fail(err, THR_EVIOLATED, "walks: turns below one unit go round in a circle");
  if (!st && measure == THR_WALK_LENGTH && !fill_lengths(steps, unit))
    st = thr_fail(err, THR_EVIOLATED, "walks: an edge is shorter than a unit");
  if (!st) st = fill_spots(steps, err);

  thr_scratch_free(&own);
  if (st) thr_walk_steps_destroy(steps);
  return st;
}

void thr_walk_steps_destroy(thr_walk_steps *steps)
{
  thr_scratch_free(&steps->own);
  *steps = (thr_walk_steps){0};
}

int thr_walk_begun(const thr_walk_steps *steps, int half)
{
  for (int k = 0; k < steps->n_begins; k++)
    if (steps->begin[k].half == half) return steps->begin[k].to;
  return -1;
}

int thr_walk_closed(const thr_walk_steps *steps, int last)
{
  const bool length = steps->measure == THR_WALK_LENGTH;
  return steps->copy[steps->place[length ? thr_head(steps->c->f, last) : last]];
}

/* ---- prices ---- */

int64_t thr_walk_needed_at(const thr_turning_columns *columns, int v)
{
  int64_t sum = 0;
  for (int i = columns->f->first[v]; i < columns->f->first[v + 1]; i++)
    sum += columns->cover[columns->f->half[i] >> 1];
  return sum;
}

/* Checks that the prices are not negative and belong to the component of the walks. Nodes may have
 * one only where the number of needed passes is odd (walk_proof.h). */
static thr_status check_prices(const thr_walk_steps *steps, const thr_walk_proof *proof,
                               thr_err *err)
{
  const thr_turning_columns *columns = steps->c;
  const thr_frame *frame = columns->f;
  if (proof->all < 0)
    return thr_fail(err, THR_EVIOLATED, "walks: a price of turning or length that is negative");

  for (int e = 0; e < frame->n_edges; e++)
    if (proof->edge[e] < 0 ||
        (proof->edge[e] > 0 && columns->component[frame->edge[e][0]] != steps->component))
      return thr_fail(err, THR_EVIOLATED,
                      "walks: the price of edge %d is negative, or of another component", e);

  for (int v = 0; v < frame->n_nodes; v++)
    if (proof->node[v] < 0 || (proof->node[v] > 0 && (thr_walk_needed_at(columns, v) % 2 == 0 ||
                                                      columns->component[v] != steps->component)))
      return thr_fail(err, THR_EVIOLATED,
                      "walks: the price of node %d is negative, of another component, or of an "
                      "even number of needed passes",
                      v);

  return THR_OK;
}

/* Returns the reward for a weight of turning or length, rounded up. */
static int64_t weight_reward(const thr_walk_proof *proof, int64_t weight)
{
  return (int64_t)(((wide)proof->all * weight + (INT64_C(1) << THR_TURNING_BITS) - 1) >>
                   THR_TURNING_BITS);
}

/* Returns the prices that a pass over half-edge h collects: of the edge and of both of its nodes.
 */
static wide pass_reward(const thr_walk_steps *steps, const thr_walk_proof *proof, int h)
{
  const thr_frame *frame = steps->c->f;
  return (wide)proof->edge[h >> 1] + proof->node[thr_tail(frame, h)] +
         proof->node[thr_head(frame, h)];
}

/* Returns the exponent of prices that are lengths (with a limit on the pull). */
static int length_exponent(const thr_walk_steps *steps, const thr_walk_proof *proof)
{
  return thr_walk_exponent(steps->c->f, THR_WALK_LENGTH) - THR_TURNING_BITS + proof->bits;
}

/* Returns what a pass costs: with a limit on the pull its length, rounded down; otherwise nothing.
 */
static int64_t pass_cost(const thr_walk_steps *steps, const thr_walk_proof *proof, int h)
{
  if (steps->measure != THR_WALK_PULL) return 0;
  return (int64_t)floor(ldexp(steps->c->f->length[h >> 1], length_exponent(steps, proof)));
}

/* Returns whether no sum of rewards or costs along a walk exceeds 64 bits. */
static bool add_up(const thr_walk_steps *steps, const thr_walk_proof *proof)
{
  const thr_frame *frame = steps->c->f;
  wide largest = 0,
       passes = ((wide)proof->units + 2) * (steps->n_spots + 1); /* of a walk at most */

  /* The largest reward and cost of one pass .. */
  for (int h = 0; h < 2 * frame->n_edges; h++) {
    wide sum =
        pass_reward(steps, proof, h) + proof->node[thr_head(frame, h)] + pass_cost(steps, proof, h);
    if (sum > largest) largest = sum;
  }

  /* .. times the largest number of passes. */
  return (largest + weight_reward(proof, INT64_C(4) << THR_TURNING_BITS)) * passes < (wide)1 << 61;
}

thr_status thr_walk_steps_price(thr_walk_steps *steps, const thr_walk_proof *proof, thr_err *err)
{
  const thr_frame *frame = steps->c->f;
  thr_status st = check_prices(steps, proof, err);
  if (st) return st;
  if (proof->units < 0 || proof->units > INT_MAX / 2 || proof->all > INT64_C(1) << 56 ||
      proof->bits < 0 || proof->bits > THR_TURNING_BITS)
    return thr_fail(err, THR_EVIOLATED,
                    "walks: %d units, or a price of turning or length that is out of range",
                    proof->units);
  if (!add_up(steps, proof))
    return thr_fail(err, THR_EVIOLATED, "walks: prices are too large to be added up in 64 bits");

  /* Reward every step; an edge that the walk remembers is not rewarded again. */
  for (int i = 0; i < steps->n; i++)
    for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
      thr_walk_step *step = &steps->step[k];
      step->worth = (int64_t)pass_reward(steps, proof, step->half) +
                    weight_reward(proof, step->weight) - pass_cost(steps, proof, step->half);
      if (step->known) step->worth -= proof->edge[step->half >> 1];
      steps->move[k] = (thr_walk_move){.worth = step->worth, .to = step->to, .units = step->units};
      if (steps->end[step->to] >= 0)
        steps->end[step->to] = proof->node[thr_head(frame, step->half)];
    }

  /* First passes of closed walks with a pull. */
  for (int k = 0; k < steps->n_homes; k++)
    for (int i = steps->from[k]; i < steps->from[k + 1]; i++)
      steps->begin[i].worth = (int64_t)pass_reward(steps, proof, steps->begin[i].half) -
                              pass_cost(steps, proof, steps->begin[i].half);

  /* First passes of open walks collect the price of the node where they start, too. */
  for (int k = 0; k < steps->n_begins && !steps->closed; k++) {
    thr_walk_step *begin = &steps->begin[k];
    begin->worth = (int64_t)pass_reward(steps, proof, begin->half) +
                   proof->node[thr_tail(frame, begin->half)] + weight_reward(proof, begin->weight) -
                   pass_cost(steps, proof, begin->half);
    if (steps->end[begin->to] >= 0)
      steps->end[begin->to] = proof->node[thr_head(frame, begin->half)];
  }

  return THR_OK;
}

/* ---- the recursion ---- */

int thr_walk_runs(const thr_walk_steps *steps)
{
  return steps->n_homes > 0 ? steps->n_homes : steps->closed ? steps->n_begins : 1;
}

int thr_walk_levels(int units)
{
  return (units / THR_WALK_WIDTH + 1) * THR_WALK_WIDTH;
}

int thr_walk_few_levels(const thr_walk_steps *steps, int units)
{
  const int reached = thr_walk_levels(steps->most_units + THR_WALK_WIDTH - 1);
  return units < reached - THR_WALK_WIDTH ? thr_walk_levels(units) : reached;
}

/* Returns how many levels can be computed together: THR_WALK_WIDTH if all steps of fewer units lead
 * to earlier places, else 1. */
static int width_of(const thr_walk_steps *steps)
{
  for (int i = 0; i < steps->n; i++)
    for (int k = steps->first[i]; k < steps->first[i + 1]; k++)
      if (steps->step[k].units < THR_WALK_WIDTH && steps->step[k].to >= i) return 1;
  return THR_WALK_WIDTH;
}

/* Raises most[width], the best rewards at the levels from `level` on (r units left and more), to
 * what `move` leads to. column: the levels of the place that the move leads to; the table is a ring
 * of `levels` rows. */
THR_INLINE void take_more(int64_t *most, const thr_walk_move *move, int r, int level, int levels,
                          int width, const int64_t *column)
{
  const int units = move->units, back = level - units + (level < units ? levels : 0);

  /* All levels exist and do not wrap round the ring: a loop of fixed length that compilers
   * vectorize. */
  if (units <= r && width == THR_WALK_WIDTH && back + THR_WALK_WIDTH <= levels) {
    for (int k = 0; k < THR_WALK_WIDTH; k++) {
      const int64_t here = column[back + k] + move->worth;
      most[k] = here > most[k] ? here : most[k];
    }
    return;
  }

  /* The first levels, and those where the ring wraps. */
  for (int k = units > r ? units - r : 0; k < width; k++) {
    const int at = level + k - units;
    const int64_t here = column[at < 0 ? at + levels : at] + move->worth;
    if (here > most[k]) most[k] = here;
  }
}

/* Computes value at place i for `width` levels from `level` on: the largest reward of a walk from
 * there. worth: the reward if the walk ends here. */
THR_INLINE void from_place(const thr_walk_steps *steps, int64_t worth, int i, int r, int level,
                           int levels, int width, int64_t *value)
{
  const thr_walk_move *move = steps->move + steps->first[i],
                      *last = steps->move + steps->first[i + 1];
  int64_t most[THR_WALK_WIDTH];

  for (int k = 0; k < THR_WALK_WIDTH; k++)
    most[k] = worth;

  /* Moves of more units than any of these levels has do not count. */
  for (; move < last; move++)
    if (move->units < r + width)
      take_more(most, move, r, level, levels, width, value + (size_t)move->to * (size_t)levels);

  for (int k = 0; k < width; k++)
    value[(size_t)i * (size_t)levels + (size_t)(level + k)] = most[k];
}

/* Fills steps->active with the places that closed walks of this run may use, those of no lower
 * group than where they begin, and returns their number. Clears the table at places that only the
 * run before used. levels: rows of the table. */
static int choose_places(thr_walk_steps *steps, int run, int levels, int64_t *value)
{
  int home = steps->begin[run].to, n = 0, before = run ? steps->group[steps->begin[run - 1].to] : 0;

  for (int i = 0; i < steps->n; i++) {
    if (steps->group[i] >= steps->group[home])
      steps->active[n++] = i;
    else if (run == 0 || steps->group[i] >= before)
      for (int r = 0; r < levels; r++)
        value[thr_walk_entry(i, r, levels)] = none;
  }
  return n;
}

/* Sets the reward of ending at the places where closed walks of a run end: at their beginning. */
static void set_ends(thr_walk_steps *steps, int run, int64_t worth)
{
  const int homes = steps->n_homes, first = homes > 0 ? steps->from[run] : run,
            last = homes > 0 ? steps->from[run + 1] : run + 1;

  /* A spot has several places if walks have a memory. */
  for (int k = first; k < last; k++) {
    const int spot =
        homes > 0 ? steps->place[steps->begin[k].half ^ 1] : steps->spot[steps->begin[k].to];
    for (int i = steps->copy[spot]; i < steps->copy[spot + 1]; i++)
      steps->end[i] = worth;
  }
}

size_t thr_walk_tables(thr_walk_measure measure)
{
  return measure == THR_WALK_PULL ? 2 : 1;
}

/* Fills steps->cut from the last level of the table of what follows the cut turn (`after`). The cut
 * turn may be any turn and counts no units. */
static void fill_cuts(thr_walk_steps *steps, const int64_t *after, int levels)
{
  for (int i = 0; i < steps->n; i++) {
    int64_t most = steps->end[i];

    for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
      const int64_t on = after[(size_t)steps->move[k].to * (size_t)levels];
      if (!thr_walk_is_none(on) && on + steps->move[k].worth > most)
        most = on + steps->move[k].worth;
    }

    steps->cut[i] = most;
  }
}

THR_WIDE void thr_walk_run(thr_walk_steps *steps, int run, int units, int levels, int64_t *value)
{
  const bool chosen = steps->closed && steps->n_homes == 0,
             pulled = steps->measure == THR_WALK_PULL;
  const int n = chosen ? choose_places(steps, run, levels, value) : steps->n,
            width = width_of(steps);

  if (steps->closed) set_ends(steps, run, 0);

  /* With a pull, first the part behind the cut turn (table 1), then the part before it, whose walks
   * end in the best of the other table. */
  for (int part = pulled ? 1 : 0; part >= 0; part--) {
    int64_t *table = value + (size_t)part * (size_t)levels * (size_t)steps->n;

    for (int r = 0, level = 0; r <= units;
         r += width, level = level + width < levels ? level + width : 0)
      for (int k = 0; k < n; k++) {
        const int i = chosen ? steps->active[k] : k;
        from_place(steps, pulled && part == 0 ? steps->cut[i] : steps->end[i], i, r, level, levels,
                   width, table);
      }

    if (part > 0) fill_cuts(steps, table + units % levels, levels);
  }

  if (steps->closed) set_ends(steps, run, none);
}

int thr_walk_firsts(const thr_walk_steps *steps, int run, const thr_walk_step **first)
{
  int home = steps->closed ? steps->begin[run].to : -1;

  if (steps->n_homes > 0) {
    *first = steps->begin + steps->from[run];
    return steps->from[run + 1] - steps->from[run];
  }

  *first = steps->closed ? steps->step + steps->first[home] : steps->begin;
  return steps->closed ? steps->first[home + 1] - steps->first[home] : steps->n_begins;
}

int64_t thr_walk_worth(const thr_walk_step *first, int units, int levels, const int64_t *value)
{
  if (first->units > units) return none;
  const int64_t on = value[thr_walk_entry(first->to, units - first->units, levels)];
  return thr_walk_is_none(on) ? none : on + first->worth;
}

int64_t thr_walk_best(thr_walk_steps *steps, int units, int levels, int64_t *value)
{
  int64_t best = 0;
  for (int run = 0; run < thr_walk_runs(steps); run++) {
    const thr_walk_step *first;
    int n = thr_walk_firsts(steps, run, &first);

    thr_walk_run(steps, run, units, levels, value);

    /* The table has no first passes. */
    for (int k = 0; k < n; k++) {
      int64_t worth = thr_walk_worth(&first[k], units, levels, value);
      if (worth > best) best = worth;
    }
  }
  return best;
}

/* ---- the check ---- */

/* Converts a proved price or length to weights, rounded down. */
static int64_t in_weights(const thr_walk_steps *steps, double price)
{
  double weight = floor(ldexp(price, steps->exponent) * (1 - 1e-15));
  return weight > 0 ? weight < 4e18 ? (int64_t)weight : INT64_C(4000000000000000000) : 0;
}

/* Returns what all cords together have to collect: the price of every edge times its needed passes,
 * the price of an odd node times those plus 1, and the price of all turning or length times
 * `least`. */
static wide needed(const thr_walk_steps *steps, const thr_walk_proof *proof, double least)
{
  const thr_turning_columns *columns = steps->c;
  wide sum = ((wide)proof->all * in_weights(steps, least)) >> THR_TURNING_BITS;

  for (int e = 0; e < columns->f->n_edges; e++)
    sum += (wide)proof->edge[e] * columns->cover[e];

  for (int v = 0; v < columns->f->n_nodes; v++)
    if (proof->node[v] > 0) sum += (wide)proof->node[v] * (thr_walk_needed_at(columns, v) + 1);

  return sum;
}

double thr_walk_needed(const thr_walk_steps *steps, const thr_walk_proof *proof, double least)
{
  return (double)needed(steps, proof, least);
}

thr_turning_task thr_walk_length_task(const thr_frame *frame, const thr_request *options,
                                      bool *end_allowed)
{
  thr_turning_task task = thr_turning_task_of(frame, options, end_allowed);

  /* Walks may turn anywhere, back too: tube joints only narrow that. */
  task.tube = false;
  task.cost = THR_TURN_ANGLE;
  task.most_passes = thr_request_most_passes(frame, options);
  return task;
}

int thr_walk_component(const thr_turning_columns *columns, const thr_walk_proof *proof)
{
  for (int e = 0; e < columns->f->n_edges; e++)
    if (proof->edge[e] > 0) return columns->component[columns->f->edge[e][0]];
  for (int v = 0; v < columns->f->n_nodes; v++)
    if (proof->node[v] > 0) return columns->component[v];
  return 0;
}

/* Computes the largest reward of a walk of at most proof->units units. Refuses proofs that would
 * take too long to check. */
static thr_status best_of(thr_walk_steps *steps, const thr_walk_proof *proof, int64_t *best,
                          thr_err *err)
{
  const double most_work = 5e8,
               most_values =
                   1 << 26; /* steps and values of the table; the planner stays below both */

  /* A ring of rows is enough, as no walk is traced. */
  const int levels = thr_walk_few_levels(steps, proof->units);
  double work = (double)proof->units * steps->first[steps->n] * thr_walk_runs(steps);

  if (work > most_work || (double)levels * steps->n > most_values)
    return thr_fail(err, THR_EVIOLATED, "walks: %d units are more than can be checked",
                    proof->units);

  int64_t *value = thr_calloc((size_t)levels * (size_t)steps->n * thr_walk_tables(steps->measure),
                              sizeof *value);
  if (!value) return thr_nomem(err);

  *best = thr_walk_best(steps, proof->units, levels, value);
  free(value);
  return THR_OK;
}

thr_status thr_walk_proof_check(const thr_turning_columns *columns, thr_walk_measure measure,
                                const thr_walk_proof *proof, int cords, double least, double *bound,
                                thr_err *err)
{
  thr_walk_steps steps;
  int64_t best = 0;
  *bound = 0;

  thr_status st = thr_walk_steps_init(&steps, columns, measure, thr_walk_component(columns, proof),
                                      proof->unit, err);
  if (st) return st;

  /* Find the largest reward of a walk. */
  st = thr_walk_steps_remember(&steps, proof->memory, proof->n_memories, err);
  if (!st) st = thr_walk_steps_price(&steps, proof, err);
  if (!st) st = best_of(&steps, proof, &best, err);

  /* K walks of at most `units` units cannot collect enough: some cord has a unit more. */
  if (!st && needed(&steps, proof, least) <= (wide)best * cords)
    st = thr_fail(err, THR_EVIOLATED, "walks: their prices prove nothing");
  if (!st)
    *bound = ldexp((double)proof->unit * ((double)proof->units + 1), -steps.exponent) * (1 - 1e-15);

  thr_walk_steps_destroy(&steps);
  return st;
}

/* ---- the length within a limit on the pull ---- */

int thr_walk_pull_units(const thr_request *options, int64_t unit)
{
  const double rounding = 1e-9, most = log(options->max_pull); /* twice what cords are allowed */
  const double weight =
      ldexp((most + 2 * rounding * (1 + most)) / options->physics.mu, THR_TURNING_BITS);

  const double units = floor(weight / (double)unit * (1 + 1e-15));
  return units < INT_MAX / 2 ? (int)units : INT_MAX / 2;
}

double thr_walk_pull_bound(const thr_walk_steps *steps, const thr_walk_proof *proof, int cords,
                           int64_t best)
{
  const wide sum = needed(steps, proof, 0) - (wide)best * cords;
  return sum <= 0 ? 0 : ldexp((double)sum * (1 - 1e-15), -length_exponent(steps, proof));
}

/* Computes a lower bound *length on the length of at most so many cords of the proof's component
 * that have no more units than the proof says on either side of their cut turn. */
static thr_status length_within(const thr_turning_columns *columns, const thr_walk_proof *proof,
                                int cords, double *length, thr_err *err)
{
  thr_walk_steps steps;
  int64_t best = 0;
  *length = 0;

  thr_status st = thr_walk_steps_init(&steps, columns, THR_WALK_PULL,
                                      thr_walk_component(columns, proof), proof->unit, err);
  if (st) return st;

  /* Lengths are in the rewards already, so that a price of all turning has no meaning. */
  if (proof->all != 0)
    st = thr_fail(err, THR_EVIOLATED, "walks: a price of all turns within a pull");
  if (!st) st = thr_walk_steps_remember(&steps, proof->memory, proof->n_memories, err);
  if (!st) st = thr_walk_steps_price(&steps, proof, err);
  if (!st) st = best_of(&steps, proof, &best, err);

  if (!st) *length = thr_walk_pull_bound(&steps, proof, cords, best);
  thr_walk_steps_destroy(&steps);
  return st;
}

thr_status thr_walk_pull_check(const thr_turning_columns *columns, const thr_request *options,
                               const thr_walk_proof *proof, int cords, double *bound, thr_err *err)
{
  *bound = 0;

  if (options->max_pull <= 0 || options->physics.mu <= 0)
    return thr_fail(err, THR_EVIOLATED, "walks: there is no limit on the pull");

  /* Walks of fewer units are not all that the limit allows. */
  if (proof->unit <= 0 || proof->units < thr_walk_pull_units(options, proof->unit))
    return thr_fail(err, THR_EVIOLATED, "walks: %d units leave out cords that are within the pull",
                    proof->units);

  return length_within(columns, proof, cords, bound, err);
}

thr_status thr_walk_pull_least(const thr_turning_columns *columns, const thr_walk_proof *proof,
                               int cords, double *bound, thr_err *err)
{
  double length = 0;
  *bound = 0;

  /* Prices without bits are no lengths: they only say whether the cords exist. */
  if (!proof->pulled || proof->bits != 0)
    return thr_fail(err, THR_EVIOLATED, "walks: they are not within a pull");

  /* Prices without lengths: any length > 0 says that the cords do not exist. */
  thr_status st = length_within(columns, proof, cords, &length, err);
  if (!st && length <= 0) st = thr_fail(err, THR_EVIOLATED, "walks: their prices prove nothing");
  if (!st)
    *bound =
        ldexp((double)proof->unit * ((double)proof->units + 1), -THR_TURNING_BITS) * (1 - 1e-15);

  return st;
}

/* ---- what a single edge forces ---- */

/* Computes least[d], the least price of the turns from half-edge d on to a cord end, by the method
 * of Bellman, Ford and Moore. queue: [2 * n_edges] a ring of the half-edges whose value fell. */
static void least_to_end(const thr_turning_columns *columns, const int64_t *back,
                         thr_walk_step *some, int64_t *least, int *queue, bool *waits)
{
  int m2 = 2 * columns->f->n_edges, first = 0, n = 0;

  /* Half-edges at whose head a cord may end are at 0. */
  for (int d = 0; d < m2; d++) {
    bool ends = columns->end_column[d ^ 1] >= 0;
    least[d] = ends ? 0 : INT64_MAX / 4;
    waits[d] = ends;
    if (ends) queue[n++] = d;
  }

  /* Relax what precedes d: the reverse of what follows d ^ 1. */
  for (; n > 0; n--, first = (first + 1) % m2) {
    int d = queue[first];
    waits[d] = false;
    for (int k = next_steps(columns, d ^ 1, back, some); k > 0; k--) {
      int from = some[k - 1].half ^ 1;
      if (least[d] + some[k - 1].weight >= least[from]) continue;

      /* A half-edge waits at most once in the ring. */
      least[from] = least[d] + some[k - 1].weight;
      if (!waits[from]) queue[(first + n++) % m2] = from;
      waits[from] = true;
    }
  }
}

/* Returns the least turning of a cord over edge e: from the edge to an end on both sides or, with a
 * pull, on the cheaper one. */
static int64_t forced_by(const int64_t *least, int e, bool pulled)
{
  const int64_t a = least[2 * e], b = least[2 * e + 1],
                none_yet = INT64_MAX / 8; /* no end is reached */
  if (pulled) return a < b ? a : b;
  return a < none_yet && b < none_yet ? a + b : 0;
}

thr_status thr_walk_forced(const thr_turning_columns *columns, bool pulled, double *bound,
                           thr_err *err)
{
  const thr_frame *frame = columns->f;
  size_t m2 = 2 * (size_t)frame->n_edges, most = 0;
  thr_scratch own = {0};
  int64_t largest = 0;
  *bound = 0;
  if (!columns->task->end_allowed) return THR_OK;

  for (int v = 0; v < frame->n_nodes; v++)
    if ((size_t)thr_degree(frame, v) > most) most = (size_t)thr_degree(frame, v);
  int64_t *back = thr_scratch_array(&own, m2, sizeof *back),
          *least = thr_scratch_array(&own, m2, sizeof *least);
  int *queue = thr_scratch_array(&own, m2, sizeof *queue);
  bool *waits = thr_scratch_array(&own, m2, sizeof *waits);
  thr_walk_step *some = thr_scratch_array(&own, most, sizeof *some);

  thr_status st = thr_scratch_check(&own, err);

  if (!st) {
    fill_backs(columns, pulled && !columns->task->tube, back);
    least_to_end(columns, back, some, least, queue, waits);

    /* The bound is the largest over all edges: some cord passes each of them. */
    for (int e = 0; e < frame->n_edges; e++) {
      const int64_t here = forced_by(least, e, pulled);
      if (here > largest && here < INT64_MAX / 8) largest = here;
    }

    *bound = ldexp((double)largest, -THR_TURNING_BITS) * (1 - 1e-15);
  }

  thr_scratch_free(&own);
  return st;
}
