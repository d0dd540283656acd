/* Worth of walks, in integers. */
#include "graph/plan/walk_proof.h"
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <math.h>
#include <stdlib.h>

__extension__ typedef __int128 wide;

static const int64_t none = -(INT64_C(1) << 62); /* and so much less than any walk is worth that sums stay below 0 */

void thr_walk_proof_destroy(thr_walk_proof *proof)
{
  free(proof->edge);
  free(proof->node);
  *proof = (thr_walk_proof){0};
}

/* ---- steps ---- */

/* Calls per step from half-edge d: the next one and the weight of the turn. Returns their number; out: [degree of d's head]. */
static int next_steps(const thr_turning_columns *columns, int d, const int64_t *back, thr_walk_step *out)
{
  const thr_frame *frame = columns->f;
  int v = thr_head(frame, d), n = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    int h = frame->half[i];
    if (h != (d ^ 1))
      out[n++] = (thr_walk_step){.to = h, .weight = columns->weight[thr_turning_column(columns, d ^ 1, h)]};
    else if (back[h] >= 0)
      out[n++] = (thr_walk_step){.to = h, .weight = back[h]};
  }
  return n;
}

/* Weight of turning back into each half-edge; -1: that is not done. */
static void fill_backs(const thr_turning_columns *columns, int64_t *back)
{
  for (int h = 0; h < 2 * columns->f->n_edges; h++)
    back[h] = -1;
  for (int j = columns->first_back; j < columns->n_columns; j++)
    back[columns->half[j][0]] = columns->weight[j];
}

/* Places in an order in which every step of no unit leads back (A. B. Kahn 1962). waiting: [2 * n_edges] zeros; some: [largest
 * degree]. false: such steps go in a circle. */
static bool order_places(thr_walk_steps *steps, int component, int64_t unit, const int64_t *back, int *waiting,
                         thr_walk_step *some)
{
  const thr_turning_columns *columns = steps->c;
  int total = 0, placed = 0;
  for (int d = 0; d < 2 * columns->f->n_edges; d++) {
    steps->place[d] = -1;
    if (columns->component[thr_tail(columns->f, d)] != component) continue;
    total++;
    for (int n = next_steps(columns, d, back, some); n > 0; n--)
      waiting[d] += some[n - 1].weight < unit;
    if (waiting[d] == 0) steps->half[placed++] = d;
  }
  for (int i = 0; i < placed; i++) { /* what comes before d along a walk is what comes after it the other way */
    int d = steps->half[i];
    steps->place[d] = i;
    for (int n = next_steps(columns, d ^ 1, back, some); n > 0; n--)
      if (some[n - 1].weight < unit && --waiting[some[n - 1].to ^ 1] == 0) steps->half[placed++] = some[n - 1].to ^ 1;
  }
  steps->n = total;
  return placed == total;
}

static void fill_steps(thr_walk_steps *steps, int64_t unit, const int64_t *back)
{
  int n = 0;
  for (int i = 0; i < steps->n; i++) {
    int count = next_steps(steps->c, steps->half[i], back, steps->step + n);
    steps->first[i] = n;
    for (int k = n; k < n + count; k++) {
      steps->step[k].to = steps->place[steps->step[k].to];
      steps->step[k].units = (int)(steps->step[k].weight / unit);
      if (steps->step[k].units > steps->most_units) steps->most_units = steps->step[k].units;
    }
    n += count;
  }
  steps->first[steps->n] = n;
}

thr_status thr_walk_steps_init(thr_walk_steps *steps, const thr_turning_columns *columns, int component, int64_t unit,
                               thr_err *err)
{
  const thr_frame *frame = columns->f;
  size_t m2 = 2 * (size_t)frame->n_edges, squares = 0, most = 0;
  thr_scratch own = {0};
  *steps = (thr_walk_steps){.c = columns};
  for (int v = 0; v < frame->n_nodes; v++) {
    size_t degree = (size_t)thr_degree(frame, v);
    squares += degree * degree;
    if (degree > most) most = degree;
  }
  steps->half = thr_scratch_array(&steps->own, m2, sizeof *steps->half);
  steps->place = thr_scratch_array(&steps->own, m2, sizeof *steps->place);
  steps->first = thr_scratch_array(&steps->own, m2 + 1, sizeof *steps->first);
  steps->step = thr_scratch_array(&steps->own, squares, sizeof *steps->step);
  steps->pass = thr_scratch_array(&steps->own, m2, sizeof *steps->pass);
  steps->end = thr_scratch_array(&steps->own, m2, sizeof *steps->end);
  int64_t *back = thr_scratch_array(&own, m2, sizeof *back);
  int *waiting = thr_scratch_array(&own, m2, sizeof *waiting);
  thr_walk_step *some = thr_scratch_array(&own, most, sizeof *some);
  thr_status st = thr_scratch_check(&steps->own, err);
  if (!st) st = thr_scratch_check(&own, err);
  if (!st && (!columns->task->end_allowed || !thr_turning_open(columns, component)))
    st = thr_fail(err, THR_EVIOLATED, "walks: component %d has no cord ends", component);
  if (!st && (unit <= 0 || ldexp(4, THR_TURNING_BITS) / (double)unit > 1e9))
    st = thr_fail(err, THR_EVIOLATED, "walks: a unit of %lld is out of range", (long long)unit);
  if (!st) fill_backs(columns, back);
  if (!st && !order_places(steps, component, unit, back, waiting, some))
    st = thr_fail(err, THR_EVIOLATED, "walks: turns below one unit go round in a circle");
  if (!st) fill_steps(steps, unit, back);
  thr_scratch_free(&own);
  if (st) thr_walk_steps_destroy(steps);
  return st;
}

void thr_walk_steps_destroy(thr_walk_steps *steps)
{
  thr_scratch_free(&steps->own);
  *steps = (thr_walk_steps){0};
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
static thr_status check_prices(const thr_walk_steps *steps, const thr_walk_proof *proof, thr_err *err)
{
  const thr_frame *frame = steps->c->f;
  if (proof->turning < 0 || (proof->turning > 0 && steps->c->n_components > 1))
    return thr_fail(err, THR_EVIOLATED, "walks: a price of turning that is negative, or of several components");
  for (int e = 0; e < frame->n_edges; e++)
    if (proof->edge[e] < 0 || (proof->edge[e] > 0 && steps->place[2 * e] < 0))
      return thr_fail(err, THR_EVIOLATED, "walks: the price of edge %d is negative, or of another component", e);
  for (int v = 0; v < frame->n_nodes; v++)
    if (proof->node[v] < 0 ||
        (proof->node[v] > 0 && (thr_walk_needed_at(steps->c, v) % 2 == 0 || steps->place[frame->half[frame->first[v]]] < 0)))
      return thr_fail(err, THR_EVIOLATED,
                      "walks: the price of node %d is negative, of another component, or of an even number of needed passes", v);
  return THR_OK;
}

static int64_t turn_worth(const thr_walk_proof *proof, int64_t weight)
{
  return (int64_t)(((wide)proof->turning * weight + (INT64_C(1) << THR_TURNING_BITS) - 1) >> THR_TURNING_BITS);
}

thr_status thr_walk_steps_price(thr_walk_steps *steps, const thr_walk_proof *proof, thr_err *err)
{
  const thr_turning_columns *columns = steps->c;
  wide largest = 0, passes = ((wide)proof->units + 2) * (steps->n + 1); /* of a walk at most */
  thr_status st = check_prices(steps, proof, err);
  if (st) return st;
  if (proof->units < 0 || proof->turning > INT64_C(1) << 56)
    return thr_fail(err, THR_EVIOLATED, "walks: %d units, or a price of turning that is out of range", proof->units);
  for (int i = 0; i < steps->n; i++) {
    int d = steps->half[i], from = thr_tail(columns->f, d), to = thr_head(columns->f, d);
    wide pass = (wide)proof->edge[d >> 1] + proof->node[from] + proof->node[to], sum = pass + proof->node[to];
    steps->end[i] = columns->end_column[d ^ 1] >= 0 ? proof->node[to] : none;
    for (int k = steps->first[i]; k < steps->first[i + 1]; k++)
      steps->step[k].worth = turn_worth(proof, steps->step[k].weight);
    if (sum > largest) largest = sum;
    steps->pass[i] = sum < INT64_MAX ? (int64_t)pass : 0;
  }
  if ((largest + turn_worth(proof, INT64_C(4) << THR_TURNING_BITS)) * passes >= (wide)1 << 61)
    return thr_fail(err, THR_EVIOLATED, "walks: prices are too large to be added up in 64 bits");
  return THR_OK;
}

/* ---- the recursion ---- */

/* Most from place i on in the row of r units. */
static int64_t from_place(const thr_walk_steps *steps, int i, int r, int levels, const int64_t *value)
{
  int64_t most = steps->end[i];
  for (int k = steps->first[i]; k < steps->first[i + 1]; k++) {
    const thr_walk_step *step = &steps->step[k];
    int row = r % levels - step->units;
    if (step->units > r) continue;
    int64_t here = value[(size_t)(row < 0 ? row + levels : row) * (size_t)steps->n + (size_t)step->to] + step->worth;
    if (here > most) most = here;
  }
  return most + steps->pass[i];
}

int64_t thr_walk_best(const thr_walk_steps *steps, int units, int levels, int64_t *value)
{
  int64_t best = 0;
  for (int r = 0; r <= units; r++)
    for (int i = 0; i < steps->n; i++)
      value[(size_t)(r % levels) * (size_t)steps->n + (size_t)i] = from_place(steps, i, r, levels, value);
  const int64_t *last = value + (size_t)(units % levels) * (size_t)steps->n;
  for (int i = 0; i < steps->n; i++) {
    int64_t start = steps->end[steps->place[steps->half[i] ^ 1]]; /* the price at the head of the other one: its own tail */
    if (start >= 0 && last[i] >= 0 && last[i] + start > best) best = last[i] + start;
  }
  return best;
}

static int64_t in_weights(double price)
{
  double weight = floor(ldexp(price, THR_TURNING_BITS) * (1 - 1e-15));
  return weight < 0 ? 0 : weight > 4e18 ? INT64_C(4000000000000000000) : (int64_t)weight;
}

/* Rounded down. */
static wide needed(const thr_walk_steps *steps, const thr_walk_proof *proof, double least)
{
  const thr_turning_columns *columns = steps->c;
  wide sum = ((wide)proof->turning * in_weights(least)) >> THR_TURNING_BITS;
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

/* ---- the check ---- */

static int component_of(const thr_turning_columns *columns, const thr_walk_proof *proof)
{
  for (int e = 0; e < columns->f->n_edges; e++)
    if (proof->edge[e] > 0) return columns->component[columns->f->edge[e][0]];
  return 0;
}

thr_status thr_walk_proof_check(const thr_turning_columns *columns, const thr_walk_proof *proof, int cords, double least,
                                double *bound, thr_err *err)
{
  const double most_work = 4e9; /* steps of the recursion; makers keep to a hundredth of it */
  thr_walk_steps steps;
  int64_t *value = NULL;
  *bound = 0;
  thr_status st = thr_walk_steps_init(&steps, columns, component_of(columns, proof), proof->unit, err);
  if (!st) st = thr_walk_steps_price(&steps, proof, err);
  int levels = proof->units < steps.most_units ? proof->units + 1 : steps.most_units + 1;
  if (!st && ((double)proof->units * steps.first[steps.n] > most_work || (double)levels * steps.n > 1e9))
    st = thr_fail(err, THR_EVIOLATED, "walks: %d units are more than can be checked", proof->units);
  if (!st && !(value = thr_calloc((size_t)levels * (size_t)steps.n, sizeof *value))) st = thr_nomem(err);
  if (!st && needed(&steps, proof, least) <= (wide)thr_walk_best(&steps, proof->units, levels, value) * cords)
    st = thr_fail(err, THR_EVIOLATED, "walks: their prices prove nothing");
  if (!st) *bound = ldexp((double)proof->unit * ((double)proof->units + 1), -THR_TURNING_BITS) * (1 - 1e-15);
  free(value);
  thr_walk_steps_destroy(&steps);
  return st;
}

/* ---- what a single edge forces ---- */

/* least[d]: of the turns from half-edge d on to an end. Those that fell wait in a ring, queue[2 * n_edges], until what leads to
 * them is looked at: the method of Bellman, Ford and Moore. */
static void least_to_end(const thr_turning_columns *columns, const int64_t *back, thr_walk_step *some, int64_t *least, int *queue,
                         bool *waits)
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
    for (int k = next_steps(columns, d ^ 1, back, some); k > 0; k--) { /* what leads to d is what d the other way leads to */
      int from = some[k - 1].to ^ 1;
      if (least[d] + some[k - 1].weight >= least[from]) continue;
      least[from] = least[d] + some[k - 1].weight;
      if (!waits[from]) queue[(first + n++) % m2] = from;
      waits[from] = true;
    }
  }
}

thr_status thr_walk_forced(const thr_turning_columns *columns, double *bound, thr_err *err)
{
  const thr_frame *frame = columns->f;
  size_t m2 = 2 * (size_t)frame->n_edges, most = 0;
  thr_scratch own = {0};
  int64_t largest = 0;
  *bound = 0;
  if (!columns->task->end_allowed) return THR_OK;
  for (int v = 0; v < frame->n_nodes; v++)
    if ((size_t)thr_degree(frame, v) > most) most = (size_t)thr_degree(frame, v);
  int64_t *back = thr_scratch_array(&own, m2, sizeof *back), *least = thr_scratch_array(&own, m2, sizeof *least);
  int *queue = thr_scratch_array(&own, m2, sizeof *queue);
  bool *waits = thr_scratch_array(&own, m2, sizeof *waits);
  thr_walk_step *some = thr_scratch_array(&own, most, sizeof *some);
  thr_status st = thr_scratch_check(&own, err);
  if (!st) {
    fill_backs(columns, back);
    least_to_end(columns, back, some, least, queue, waits);
    for (int e = 0; e < frame->n_edges; e++)
      if (least[2 * e] < INT64_MAX / 8 && least[2 * e + 1] < INT64_MAX / 8 && least[2 * e] + least[2 * e + 1] > largest)
        largest = least[2 * e] + least[2 * e + 1];
    *bound = ldexp((double)largest, -THR_TURNING_BITS) * (1 - 1e-15);
  }
  thr_scratch_free(&own);
  return st;
}
