/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Worth of walks, in integers. */
#include "graph/angle.h"
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "graph/wide.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

__extension__ typedef __int128 wide;

static const int64_t none =
    -(INT64_C(1) << 62); /* and so much less than any walk is worth that sums stay below */
static const int64_t lowest = -(INT64_C(1) << 61); /* what no walk is worth */

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

/* Calls per step from half-edge d: the next one and the weight of the turn. Returns their number;
 * out: [degree of d's head]. */
static int next_steps(const thr_turning_columns *columns, int d, const int64_t *back,
                      thr_walk_step *out)
{
  const thr_frame *frame = columns->f;
  int v = thr_head(frame, d), n = 0;
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

/* Weight of turning back into each half-edge; -1: that is not done. anywhere: also at nodes with
 * other edges. */
static void fill_backs(const thr_turning_columns *columns, bool anywhere, int64_t *back)
{
  for (int h = 0; h < 2 * columns->f->n_edges; h++)
    back[h] = anywhere ? (int64_t)floor(ldexp(THR_PI, THR_TURNING_BITS) * (1 - 1e-15)) : -1;
  for (int j = columns->first_back; j < columns->n_columns; j++)
    back[columns->half[j][0]] = columns->weight[j];
}

/* What the steps are made with. */
typedef struct {
  int64_t unit, *back; /* back: [2 * n_edges] */
  int *half,
      *waiting; /* [2 * n_edges] the half-edge at each place; steps that do not lead back yet */
  thr_walk_step *some; /* [largest degree] */
} making;

/* Places in an order in which every step of fewer units leads back (A. B. Kahn 1962). false: such
 * steps go in a circle. */
static bool order_places(thr_walk_steps *steps, making *m, int units)
{
  const thr_turning_columns *columns = steps->c;
  const int64_t most = m->unit < INT64_MAX / units ? units * m->unit : INT64_MAX;
  int total = 0, placed = 0;
  for (int d = 0; d < 2 * columns->f->n_edges; d++) {
    steps->place[d] = -1;
    m->waiting[d] = 0;
    if (columns->component[thr_tail(columns->f, d)] != steps->component) continue;
    total++;
    for (int n = next_steps(columns, d, m->back, m->some); n > 0; n--)
      m->waiting[d] += m->some[n - 1].weight < most;
    if (m->waiting[d] == 0) m->half[placed++] = d;
  }
  for (int i = 0; i < placed;
       i++) { /* what comes before d along a walk is what comes after it the other way */
    int d = m->half[i];
    steps->place[d] = i;
    for (int n = next_steps(columns, d ^ 1, m->back, m->some); n > 0; n--) {
      int before = m->some[n - 1].half ^ 1;
      if (m->some[n - 1].weight < most && --m->waiting[before] == 0) m->half[placed++] = before;
    }
  }
  steps->n = total;
  return placed == total;
}

static void count_units(thr_walk_steps *steps, thr_walk_step *step, int64_t unit)
{
  step->units = (int)(step->weight / unit);
  if (step->units > steps->most_units) steps->most_units = step->units;
}

/* Closed walks begin at their first edge, both ways alike, or where a pull counts at the node where
 * their ends are. */
static void fill_closed(thr_walk_steps *steps)
{
  const thr_frame *frame = steps->c->f;
  for (int e = 0; e < frame->n_edges && steps->measure == THR_WALK_TURNING; e++)
    if (steps->place[2 * e] >= 0)
      steps->begin[steps->n_begins++] = (thr_walk_step){.to = steps->place[2 * e], .half = 2 * e};
  for (int v = 0; v < frame->n_nodes && steps->measure == THR_WALK_PULL; v++) {
    if (steps->c->component[v] != steps->component || thr_degree(frame, v) == 0) continue;
    for (int k = frame->first[v]; k < frame->first[v + 1]; k++)
      steps->begin[steps->n_begins++] =
          (thr_walk_step){.to = steps->place[frame->half[k]], .half = frame->half[k]};
    steps->from[++steps->n_homes] = steps->n_begins;
  }
}

static bool fill_turning(thr_walk_steps *steps, making *m)
{
  int n = 0;
  fill_backs(steps->c, steps->measure == THR_WALK_PULL, m->back);
  if (!order_places(steps, m, THR_WALK_WIDTH) && !order_places(steps, m, 1)) return false;
  for (int i = 0; i < steps->n; i++) {
    int d = m->half[i], count = next_steps(steps->c, d, m->back, steps->step + n);
    bool may_begin = steps->c->end_column[d] >= 0;
    steps->first[i] = n;
    steps->group[i] = steps->measure == THR_WALK_PULL ? thr_head(steps->c->f, d) : d >> 1;
    steps->end[i] = steps->c->end_column[d ^ 1] >= 0 ? 0 : none;
    for (int k = n; k < n + count; k++) {
      steps->step[k].to = steps->place[steps->step[k].half];
      count_units(steps, &steps->step[k], m->unit);
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
  for (int e = 0; e < frame->n_edges; e++)
    longest = fmax(longest, frame->length[e]);
  frexp(longest, &exponent);
  return THR_TURNING_BITS - exponent;
}

/* false: an edge is shorter than a unit. */
static bool fill_lengths(thr_walk_steps *steps, int64_t unit)
{
  const thr_frame *frame = steps->c->f;
  bool enough = true;
  int n = 0;
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
    for (int k = frame->first[v]; k < frame->first[v + 1]; k++) {
      int h = frame->half[k];
      thr_walk_step *step = &steps->step[n++];
      double length = ldexp(frame->length[h >> 1], steps->exponent);
      *step = (thr_walk_step){
          .to = steps->place[thr_head(frame, h)], .half = h, .weight = (int64_t)floor(length)};
      count_units(steps, step, unit);
      step->weight = (int64_t)ceil(length); /* what it is worth is rounded up */
      enough &= step->units > 0;
      if (!steps->closed && may_end) steps->begin[steps->n_begins++] = *step;
    }
    if (steps->closed) steps->begin[steps->n_begins++] = (thr_walk_step){.to = i};
  }
  steps->first[steps->n] = n;
  return enough;
}

/* ---- steps ---- */

/* Every spot is one place until something is remembered. */
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

static thr_status allocate(thr_walk_steps *steps, making *m, thr_scratch *own, thr_err *err)
{
  const thr_frame *frame = steps->c->f;
  size_t m2 = 2 * (size_t)frame->n_edges, n = (size_t)frame->n_nodes, squares = 0, most = 0;
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
  m->back = thr_scratch_array(own, m2, sizeof *m->back);
  m->half = thr_scratch_array(own, m2, sizeof *m->half);
  m->waiting = thr_scratch_array(own, m2, sizeof *m->waiting);
  m->some = thr_scratch_array(own, most, sizeof *m->some);
  thr_status st = thr_scratch_check(&steps->own, err);
  return st ? st : thr_scratch_check(own, err);
}

thr_status thr_walk_steps_init(thr_walk_steps *steps, const thr_turning_columns *columns,
                               thr_walk_measure measure, int component, int64_t unit, thr_err *err)
{
  thr_scratch own = {0};
  making m = {.unit = unit};
  *steps = (thr_walk_steps){.c = columns,
                            .measure = measure,
                            .component = component,
                            .exponent = thr_walk_exponent(columns->f, measure),
                            .closed = !columns->task->end_allowed};
  thr_status st = allocate(steps, &m, &own, err);
  if (!st && !steps->closed && !thr_turning_open(columns, component))
    st = thr_fail(err, THR_EVIOLATED, "walks: component %d has no cord ends", component);
  if (!st && (unit <= 0 || ldexp(4, THR_TURNING_BITS) / (double)unit > 1e9))
    st = thr_fail(err, THR_EVIOLATED, "walks: a unit of %lld is out of range", (long long)unit);
  if (!st && measure != THR_WALK_LENGTH && !fill_turning(steps, &m))
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

/* 0 or more, and in the component of the walks. */
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

static int64_t all_worth(const thr_walk_proof *proof, int64_t weight)
{
  return (int64_t)(((wide)proof->all * weight + (INT64_C(1) << THR_TURNING_BITS) - 1) >>
                   THR_TURNING_BITS);
}

static wide pass_worth(const thr_walk_steps *steps, const thr_walk_proof *proof, int h)
{
  const thr_frame *frame = steps->c->f;
  return (wide)proof->edge[h >> 1] + proof->node[thr_tail(frame, h)] +
         proof->node[thr_head(frame, h)];
}

/* Where a pull counts, exponent of the prices: those are lengths. */
static int length_exponent(const thr_walk_steps *steps, const thr_walk_proof *proof)
{
  return thr_walk_exponent(steps->c->f, THR_WALK_LENGTH) - THR_TURNING_BITS + proof->bits;
}

/* What a pass costs. */
static int64_t pass_cost(const thr_walk_steps *steps, const thr_walk_proof *proof, int h)
{
  if (steps->measure != THR_WALK_PULL) return 0;
  return (int64_t)floor(ldexp(steps->c->f->length[h >> 1], length_exponent(steps, proof)));
}

/* No sum of a walk's worths, or of its costs, is larger than 64 bits hold. */
static bool add_up(const thr_walk_steps *steps, const thr_walk_proof *proof)
{
  const thr_frame *frame = steps->c->f;
  wide largest = 0,
       passes = ((wide)proof->units + 2) * (steps->n_spots + 1); /* of a walk at most */
  for (int h = 0; h < 2 * frame->n_edges; h++) {
    wide sum =
        pass_worth(steps, proof, h) + proof->node[thr_head(frame, h)] + pass_cost(steps, proof, h);
    if (sum > largest) largest = sum;
  }
  return (largest + all_worth(proof, INT64_C(4) << THR_TURNING_BITS)) * passes < (wide)1 << 61;
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
  for (int i = 0; i < steps->n; i++)
    for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
      thr_walk_step *step = &steps->step[k];
      step->worth = (int64_t)pass_worth(steps, proof, step->half) + all_worth(proof, step->weight) -
                    pass_cost(steps, proof, step->half);
      if (step->known) step->worth -= proof->edge[step->half >> 1];
      steps->move[k] = (thr_walk_move){.worth = step->worth, .to = step->to, .units = step->units};
      if (steps->end[step->to] >= 0)
        steps->end[step->to] = proof->node[thr_head(frame, step->half)];
    }
  for (int k = 0; k < steps->n_homes; k++)
    for (int i = steps->from[k]; i < steps->from[k + 1]; i++)
      steps->begin[i].worth = (int64_t)pass_worth(steps, proof, steps->begin[i].half) -
                              pass_cost(steps, proof, steps->begin[i].half);
  for (int k = 0; k < steps->n_begins && !steps->closed; k++) {
    thr_walk_step *begin = &steps->begin[k];
    begin->worth = (int64_t)pass_worth(steps, proof, begin->half) +
                   proof->node[thr_tail(frame, begin->half)] + all_worth(proof, begin->weight) -
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

/* Levels that are found together: all that steps of few units lead to has been found then. */
static int width_of(const thr_walk_steps *steps)
{
  for (int i = 0; i < steps->n; i++)
    for (int k = steps->first[i]; k < steps->first[i + 1]; k++)
      if (steps->step[k].units < THR_WALK_WIDTH && steps->step[k].to >= i) return 1;
  return THR_WALK_WIDTH;
}

/* What is worth more, here or with a move, at the levels from number level on, which are r units
 * and more. column: the levels of the place that the move leads to. */
THR_INLINE void take_more(int64_t *most, const thr_walk_move *move, int r, int level, int levels,
                          int width, const int64_t *column)
{
  const int units = move->units, back = level - units + (level < units ? levels : 0);
  if (units <= r && width == THR_WALK_WIDTH && back + THR_WALK_WIDTH <= levels) {
    for (int k = 0; k < THR_WALK_WIDTH; k++) {
      const int64_t here = column[back + k] + move->worth;
      most[k] = here > most[k] ? here : most[k];
    }
    return;
  }
  for (int k = units > r ? units - r : 0; k < width; k++) {
    const int at = level + k - units;
    const int64_t here = column[at < 0 ? at + levels : at] + move->worth;
    if (here > most[k]) most[k] = here;
  }
}

/* The most from place i on at these levels; worth: if it goes no further. */
THR_INLINE void from_place(const thr_walk_steps *steps, int64_t worth, int i, int r, int level,
                           int levels, int width, int64_t *value)
{
  const thr_walk_move *move = steps->move + steps->first[i],
                      *last = steps->move + steps->first[i + 1];
  int64_t most[THR_WALK_WIDTH];
  for (int k = 0; k < THR_WALK_WIDTH; k++)
    most[k] = worth;
  for (; move < last; move++)
    if (move->units < r + width)
      take_more(most, move, r, level, levels, width, value + (size_t)move->to * (size_t)levels);
  for (int k = 0; k < width; k++)
    value[(size_t)i * (size_t)levels + (size_t)(level + k)] = most[k];
}

/* The places of closed walks that begin at home, and those no longer. levels: rows of the table.
 * Returns the number of the former. */
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

/* Where closed walks of a recursion may end. */
static void set_ends(thr_walk_steps *steps, int run, int64_t worth)
{
  const int homes = steps->n_homes, first = homes > 0 ? steps->from[run] : run,
            last = homes > 0 ? steps->from[run + 1] : run + 1;
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

/* Fills steps->cut from the last level of the table of what comes after the cut turn: that turn may
 * be any, and has no units. */
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
    for (int k = 0; k < n; k++) {
      int64_t worth = thr_walk_worth(&first[k], units, levels, value);
      if (worth > best) best = worth;
    }
  }
  return best;
}

/* ---- the check ---- */

/* Rounded down. */
static int64_t in_weights(const thr_walk_steps *steps, double price)
{
  double weight = floor(ldexp(price, steps->exponent) * (1 - 1e-15));
  return weight > 0 ? weight < 4e18 ? (int64_t)weight : INT64_C(4000000000000000000) : 0;
}

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
  for (int v = 0; v < frame->n_nodes; v++)
    end_allowed[v] = thr_plan_end_allowed(frame, options, v);
  return (thr_turning_task){.cover = options->cover,
                            .capacity = options->capacity,
                            .most_passes = thr_request_most_passes(frame, options),
                            .cords = options->cords,
                            .cords_least = options->cords_least,
                            .end_allowed = options->ends == THR_ENDS_CLOSED ? NULL : end_allowed,
                            .end_count =
                                options->ends == THR_ENDS_COUNTS ? options->end_count : NULL,
                            .extra_limit = -1};
}

int thr_walk_component(const thr_turning_columns *columns, const thr_walk_proof *proof)
{
  for (int e = 0; e < columns->f->n_edges; e++)
    if (proof->edge[e] > 0) return columns->component[columns->f->edge[e][0]];
  for (int v = 0; v < columns->f->n_nodes; v++)
    if (proof->node[v] > 0) return columns->component[v];
  return 0;
}

/* The most that a walk is worth. */
static thr_status best_of(thr_walk_steps *steps, const thr_walk_proof *proof, int64_t *best,
                          thr_err *err)
{
  const double most_work = 5e8,
               most_values =
                   1 << 26; /* steps of the recursion, and of its table; makers keep below both */
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
  st = thr_walk_steps_remember(&steps, proof->memory, proof->n_memories, err);
  if (!st) st = thr_walk_steps_price(&steps, proof, err);
  if (!st) st = best_of(&steps, proof, &best, err);
  if (!st && needed(&steps, proof, least) <= (wide)best * cords)
    st = thr_fail(err, THR_EVIOLATED, "walks: their prices prove nothing");
  if (!st)
    *bound = ldexp((double)proof->unit * ((double)proof->units + 1), -steps.exponent) * (1 - 1e-15);
  thr_walk_steps_destroy(&steps);
  return st;
}

/* ---- the length within a limit on the pull ---- */

thr_turning_task thr_walk_pull_task(const thr_frame *frame, const thr_request *options,
                                    bool *end_allowed)
{
  return thr_walk_length_task(frame, options, end_allowed); /* angles are what turns cost */
}

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

/* *length: of at most so many cords of the proof's component together that have no more units than
 * the proof says on either side of their cut turn. */
static thr_status length_within(const thr_turning_columns *columns, const thr_walk_proof *proof,
                                int cords, double *length, thr_err *err)
{
  thr_walk_steps steps;
  int64_t best = 0;
  *length = 0;
  thr_status st = thr_walk_steps_init(&steps, columns, THR_WALK_PULL,
                                      thr_walk_component(columns, proof), proof->unit, err);
  if (st) return st;
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
  if (!proof->pulled || proof->bits != 0)
    return thr_fail(err, THR_EVIOLATED, "walks: they are not within a pull");
  thr_status st = length_within(columns, proof, cords, &length, err);
  if (!st && length <= 0) st = thr_fail(err, THR_EVIOLATED, "walks: their prices prove nothing");
  if (!st)
    *bound =
        ldexp((double)proof->unit * ((double)proof->units + 1), -THR_TURNING_BITS) * (1 - 1e-15);
  return st;
}

/* ---- what a single edge forces ---- */

/* least[d]: of the turns from half-edge d on to an end. Those that fell wait in a ring, queue[2 *
 * n_edges], until what leads to them is looked at: the method of Bellman, Ford and Moore. */
static void least_to_end(const thr_turning_columns *columns, const int64_t *back,
                         thr_walk_step *some, int64_t *least, int *queue, bool *waits)
{
  int m2 = 2 * columns->f->n_edges, first = 0, n = 0;
  for (int d = 0; d < m2; d++) {
    bool ends = columns->end_column[d ^ 1] >= 0;
    least[d] = ends ? 0 : INT64_MAX / 4;
    waits[d] = ends;
    if (ends) queue[n++] = d;
  }
  for (; n > 0; n--, first = (first + 1) % m2) {
    int d = queue[first];
    waits[d] = false;
    for (int k = next_steps(columns, d ^ 1, back, some); k > 0;
         k--) { /* what leads to d is what d the other way leads to */
      int from = some[k - 1].half ^ 1;
      if (least[d] + some[k - 1].weight >= least[from]) continue;
      least[from] = least[d] + some[k - 1].weight;
      if (!waits[from]) queue[(first + n++) % m2] = from;
      waits[from] = true;
    }
  }
}

/* What least says of the cords over edge e. */
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
    for (int e = 0; e < frame->n_edges; e++) {
      const int64_t here = forced_by(least, e, pulled);
      if (here > largest && here < INT64_MAX / 8) largest = here;
    }
    *bound = ldexp((double)largest, -THR_TURNING_BITS) * (1 - 1e-15);
  }
  thr_scratch_free(&own);
  return st;
}
