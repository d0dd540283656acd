/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The walks while they are annealed: what is known of them, and how they are changed. */
#include "graph/random.h"
#include "graph/threading/anneal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- walks ---- */

/* Numbers of the visits of a walk. */
static int first_visit(const thr_annealer *x)
{
  return x->closed ? 0 : 1;
}

static void forget_visits(thr_annealer *x, const thr_anneal_walk *walk)
{
  for (int i = first_visit(x); i < walk->n; i++) {
    const int v = thr_tail(x->c->f, walk->half[i]), last = x->visit_first[v] + --x->n_visits[v];
    const thr_anneal_visit moved = x->visit[last];
    x->visit[walk->slot[i]] = moved;
    x->walk[moved.cord].slot[moved.at] = walk->slot[i];
  }
}

static void note_visits(thr_annealer *x, int number)
{
  thr_anneal_walk *walk = &x->walk[number];
  for (int i = first_visit(x); i < walk->n; i++) {
    const int v = thr_tail(x->c->f, walk->half[i]);
    walk->slot[i] = x->visit_first[v] + x->n_visits[v]++;
    x->visit[walk->slot[i]] = (thr_anneal_visit){number, i};
  }
}

static void add_passes(thr_annealer *x, const int *half, int n, int change)
{
  for (int i = 0; i < n; i++) {
    x->passes[half[i] >> 1] += change;
    x->extra += change * x->c->f->length[half[i] >> 1];
  }
}

/* Counts the turns of half[n] up or down, under both orders of their half-edges. */
static void add_turns(thr_annealer *x, const int *half, int n, int change)
{
  const thr_turning_columns *c = x->c;
  for (int i = x->closed ? 0 : 1; i < n; i++) {
    const int in = half[i > 0 ? i - 1 : n - 1] ^ 1, out = half[i], v = thr_tail(c->f, out);
    const int degree = thr_degree(c->f, v), *position = c->position;
    x->turns[x->pair_first[v] + position[in] * degree + position[out]] += change;
    x->turns[x->pair_first[v] + position[out] * degree + position[in]] += change;
  }
}

/* Returns whether the turns at node v tie its edges together: all are reached from the first. */
static bool is_tied(thr_annealer *x, int v)
{
  const int degree = thr_degree(x->c->f, v), *turns = x->turns + x->pair_first[v];
  int n = 1, *reached = x->tied, *left = x->tied + degree;

  /* The half-edges that are not reached yet wait in left. */
  reached[0] = 0;
  for (int i = 1; i < degree; i++)
    left[i - 1] = i;

  for (int done = 0, n_left = degree - 1; done < n; done++)
    for (int i = 0; i < n_left;) {
      if (turns[reached[done] * degree + left[i]] == 0) {
        i++;
        continue;
      }
      reached[n++] = left[i];
      left[i] = left[--n_left];
    }
  return n == degree;
}

/* Counts the turns of the cords of a change in place of those that it would make. */
static void take_turns_back(thr_annealer *x, const thr_anneal_change *change)
{
  for (int i = 0; i < change->n_cords; i++) {
    add_turns(x, x->made[i], change->n[i], -1);
    add_turns(x, x->walk[change->cord[i]].half, x->walk[change->cord[i]].n, 1);
  }
}

/* Counts the turns of a change in place of those of its cords. Returns false, and counts nothing,
 * where a node that they pass would no longer be tied. */
static bool recount_turns(thr_annealer *x, const thr_anneal_change *change)
{
  bool tied = true;
  for (int i = 0; i < change->n_cords; i++) {
    add_turns(x, x->walk[change->cord[i]].half, x->walk[change->cord[i]].n, -1);
    add_turns(x, x->made[i], change->n[i], 1);
  }

  /* Only nodes that lost their last turn of a kind may have come apart. */
  for (int i = 0; i < change->n_cords && tied; i++) {
    const thr_anneal_walk *walk = &x->walk[change->cord[i]];
    for (int k = x->closed ? 0 : 1; k < walk->n && tied; k++) {
      const int in = walk->half[k > 0 ? k - 1 : walk->n - 1] ^ 1, out = walk->half[k];
      const int v = thr_tail(x->c->f, out), degree = thr_degree(x->c->f, v);
      const int at = x->c->position[in] * degree + x->c->position[out];
      if (x->turns[x->pair_first[v] + at] == 0) tied = is_tied(x, v);
    }
  }
  if (!tied) take_turns_back(x, change);
  return tied;
}

static void sum_turns(const thr_annealer *x, thr_anneal_walk *walk)
{
  walk->sum[0] = x->closed ? 0 : x->end_price[walk->half[0] >> 1];
  for (int i = 1; i < walk->n; i++)
    walk->sum[i] = walk->sum[i - 1] + thr_anneal_turn(x, walk->half[i - 1], walk->half[i]);
  const int last = walk->half[walk->n - 1];
  walk->total = walk->sum[walk->n - 1] +
                (x->closed ? thr_anneal_turn(x, last, walk->half[0]) : x->end_price[last >> 1]);
}

/* half[n] become cord number; closed ones begin anywhere, for changes to find other parts. */
static thr_status set_walk(thr_annealer *x, int number, const int *half, int n, thr_err *err)
{
  thr_anneal_walk *walk = &x->walk[number];
  if (n > walk->room) {
    const size_t room = 2 * (size_t)n;
    int *longer = thr_realloc(walk->half, room, sizeof *longer);
    if (!longer) return thr_nomem(err);
    walk->half = longer;
    if (!(longer = thr_realloc(walk->slot, room, sizeof *longer))) return thr_nomem(err);
    walk->slot = longer;
    double *sum = thr_realloc(walk->sum, room, sizeof *sum);
    if (!sum) return thr_nomem(err);
    walk->sum = sum;
    walk->room = (int)room;
  }
  const int from = x->closed ? thr_random_below(&x->state, n) : 0;
  memcpy(walk->half, half + from, (size_t)(n - from) * sizeof *half);
  memcpy(walk->half + (n - from), half, (size_t)from * sizeof *half);
  walk->n = n;
  sum_turns(x, walk);
  return THR_OK;
}

/* ---- set up ---- */

static void fill_prices(thr_annealer *x)
{
  const thr_frame *frame = x->c->f;
  const double angle = .05; /* rad */
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    sum += frame->length[e];
    if (x->measure == THR_WALK_LENGTH) x->end_price[e] = frame->length[e] / 2;
  }
  x->noise = x->measure == THR_WALK_LENGTH ? sum / frame->n_edges : angle;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int degree = thr_degree(frame, v), *half = frame->half + frame->first[v];
    for (int i = 0; i < degree * degree; i++) {
      const int in = half[i / degree] ^ 1, out = half[i % degree];
      const bool length = x->measure == THR_WALK_LENGTH;
      const bool back = in == (out ^ 1) && (x->tube || (!length && degree > 1));
      x->price[x->pair_first[v] + i] = back ? THR_FORBIDDEN
                                       : length
                                           ? (frame->length[in >> 1] + frame->length[out >> 1]) / 2
                                           : thr_turn_price(frame, x->c->task->cost, in, out);
    }
  }
}

/* Least prices to an end, by Bellman, Ford and Moore: those that fell wait in a ring. */
static void find_ends(thr_annealer *x)
{
  const thr_frame *frame = x->c->f;
  const int m2 = 2 * frame->n_edges;
  int first = 0, n = 0, *queue = x->queue, *waits = x->stamp;
  for (int h = 0; h < m2; h++) {
    const bool ends = x->c->task->end_allowed[thr_head(frame, h)];
    x->to_end[h] = ends ? x->end_price[h >> 1] : INFINITY;
    x->next[h] = -1;
    if ((waits[h] = ends)) queue[n++] = h;
  }
  for (; n > 0; n--, first = (first + 1) % m2) {
    const int h = queue[first], v = thr_tail(frame, h);
    waits[h] = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      const int before = frame->half[i] ^ 1;
      const double price = x->to_end[h] + thr_anneal_turn(x, before, h);
      if (price >= x->to_end[before] - 1e-12 || price >= THR_FORBIDDEN) continue;
      x->to_end[before] = price;
      x->next[before] = h;
      if (!waits[before]) queue[(first + n++) % m2] = before;
      waits[before] = 1;
    }
  }
  memset(waits, 0, (size_t)m2 * sizeof *waits);
}

/* Visits that a node has at most, as its edges have no more passes than they may, or than they
 * have. */
static size_t place_visits(thr_annealer *x, const int *now)
{
  const thr_frame *frame = x->c->f;
  size_t sum = 0, squares = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int degree = thr_degree(frame, v);
    x->visit_first[v] = (int)sum;
    x->pair_first[v] = (int)squares;
    squares += (size_t)degree * (size_t)degree;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      const int e = frame->half[i] >> 1;
      sum += (size_t)(now[e] > x->c->most[e] ? now[e] : x->c->most[e]);
    }
  }
  return sum;
}

static thr_status allocate(thr_annealer *x, const thr_cord *cord, thr_err *err)
{
  const thr_frame *frame = x->c->f;
  const size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  size_t squares = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    squares += (size_t)thr_degree(frame, v) * (size_t)thr_degree(frame, v);
  x->walk = thr_scratch_array(&x->own, (size_t)x->n_cords, sizeof *x->walk);
  x->pair_first = thr_scratch_array(&x->own, n, sizeof *x->pair_first);
  x->visit_first = thr_scratch_array(&x->own, n, sizeof *x->visit_first);
  x->n_visits = thr_scratch_array(&x->own, n, sizeof *x->n_visits);
  x->price = thr_scratch_array(&x->own, squares, sizeof *x->price);
  x->turns = thr_scratch_array(&x->own, x->tube ? squares : 0, sizeof *x->turns);
  x->tied = thr_scratch_array(&x->own, x->tube ? 2 * m : 0, sizeof *x->tied);
  x->passes = thr_scratch_array(&x->own, m, sizeof *x->passes);
  x->count = thr_scratch_array(&x->own, m, sizeof *x->count);
  x->end_price = thr_scratch_array(&x->own, m, sizeof *x->end_price);
  x->to_end = thr_scratch_array(&x->own, 2 * m, sizeof *x->to_end);
  x->next = thr_scratch_array(&x->own, 2 * m, sizeof *x->next);
  x->reached = thr_scratch_array(&x->own, 2 * m, sizeof *x->reached);
  x->before = thr_scratch_array(&x->own, 2 * m, sizeof *x->before);
  x->hops = thr_scratch_array(&x->own, 2 * m, sizeof *x->hops);
  x->stamp = thr_scratch_array(&x->own, 2 * m, sizeof *x->stamp);
  x->queue = thr_scratch_array(&x->own, 2 * m, sizeof *x->queue);
  thr_status st = thr_scratch_check(&x->own, err);
  if (st) return st;
  for (int i = 0; i < x->n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      x->passes[cord[i].half[k] >> 1]++;
  const size_t visits = place_visits(x, x->passes);
  x->room = (int)visits + 2 * frame->n_edges; /* and one way to an end more */
  x->visit = thr_scratch_array(&x->own, visits, sizeof *x->visit);
  x->made[0] = thr_scratch_array(&x->own, (size_t)x->room, sizeof *x->made[0]);
  x->made[1] = thr_scratch_array(&x->own, (size_t)x->room, sizeof *x->made[1]);
  x->route = thr_scratch_array(&x->own, (size_t)x->room, sizeof *x->route);
  memset(x->passes, 0, m * sizeof *x->passes);
  return thr_scratch_check(&x->own, err);
}

thr_status thr_annealer_init(thr_annealer *x, const thr_turning_columns *columns,
                             thr_walk_measure measure, const thr_cord *cord, int n_cords,
                             thr_err *err)
{
  const thr_frame *frame = columns->f;
  *x = (thr_annealer){.c = columns,
                      .measure = measure,
                      .closed = !columns->task->end_allowed,
                      .fixed = columns->task->end_count != NULL,
                      .tube = columns->task->tube,
                      .n_cords = n_cords,
                      .state = 1};
  thr_status st = allocate(x, cord, err);
  if (st) return st;
  fill_prices(x);
  for (int e = 0; e < frame->n_edges; e++)
    x->extra -= columns->cover[e] * frame->length[e];
  for (int i = 0; i < n_cords && !st; i++) {
    st = set_walk(x, i, cord[i].half, cord[i].n_passes, err);
    if (st) break;
    note_visits(x, i);
    add_passes(x, cord[i].half, cord[i].n_passes, 1);
    if (x->tube) add_turns(x, cord[i].half, cord[i].n_passes, 1);
  }
  x->most_extra = columns->task->extra_limit < 0
                      ? INFINITY
                      : fmax(columns->task->extra_limit, x->extra) * (1 + 1e-12);
  if (!st && !x->closed) find_ends(x);
  return st;
}

void thr_annealer_destroy(thr_annealer *x)
{
  for (int i = 0; x->walk && i < x->n_cords; i++) {
    free(x->walk[i].half);
    free(x->walk[i].slot);
    free(x->walk[i].sum);
  }
  thr_scratch_free(&x->own);
}

/* ---- parts of changes ---- */

void thr_anneal_put(thr_annealer *x, thr_anneal_change *change, int i, const int *half, int from,
                    int end, bool backwards)
{
  int *out = x->made[i] + change->n[i];
  for (int k = from; k < end; k++)
    *out++ = backwards ? half[end - 1 - (k - from)] ^ 1 : half[k];
  change->n[i] += end - from;
}

double thr_anneal_total(const thr_annealer *x, const thr_anneal_change *change, int i)
{
  const int n = change->n[i], *half = x->made[i];
  double total = x->closed ? thr_anneal_turn(x, half[n - 1], half[0])
                           : x->end_price[half[0] >> 1] + x->end_price[half[n - 1] >> 1];
  for (int k = 1; k < n; k++)
    total += thr_anneal_turn(x, half[k - 1], half[k]);
  return total;
}

bool thr_anneal_spare(thr_annealer *x, const thr_anneal_walk *walk, int from, int end)
{
  bool spare = true;
  for (int k = from; k < end; k++) {
    const int e = walk->half[k] >> 1;
    spare &= x->passes[e] - ++x->count[e] >= x->c->cover[e];
  }
  for (int k = from; k < end; k++)
    x->count[walk->half[k] >> 1] = 0;
  return spare;
}

thr_anneal_visit thr_anneal_visit_at(thr_annealer *x, int node)
{
  if (x->n_visits[node] == 0) return (thr_anneal_visit){-1, -1};
  return x->visit[x->visit_first[node] + thr_random_below(&x->state, x->n_visits[node])];
}

/* Counts the passes of a change in place of those of its cords; false, and nothing is counted,
 * where edges would no longer keep to their covers and limits. */
static bool recount_passes(thr_annealer *x, const thr_anneal_change *change)
{
  const thr_turning_columns *c = x->c;
  const double extra = x->extra;
  bool right = true;
  for (int i = 0; i < change->n_cords; i++)
    add_passes(x, x->walk[change->cord[i]].half, x->walk[change->cord[i]].n, -1);
  for (int i = 0; i < change->n_cords; i++)
    add_passes(x, x->made[i], change->n[i], 1);
  for (int i = 0; i < change->n_cords; i++) {
    const thr_anneal_walk *walk = &x->walk[change->cord[i]];
    for (int k = 0; k < walk->n; k++)
      right &= x->passes[walk->half[k] >> 1] >= c->cover[walk->half[k] >> 1];
    for (int k = 0; k < change->n[i]; k++)
      right &= x->passes[x->made[i][k] >> 1] <= c->most[x->made[i][k] >> 1];
  }
  if (right && (x->extra <= x->most_extra || x->extra <= extra)) return true;
  for (int i = 0; i < change->n_cords; i++) {
    add_passes(x, x->made[i], change->n[i], -1);
    add_passes(x, x->walk[change->cord[i]].half, x->walk[change->cord[i]].n, 1);
  }
  x->extra = extra;
  return false;
}

thr_status thr_anneal_make(thr_annealer *x, const thr_anneal_change *change, thr_err *err)
{
  bool right = true;
  thr_status st = THR_OK;
  for (int i = 0; i < change->n_cords; i++)
    right &= change->n[i] > 0;
  if (!right || (x->tube && !recount_turns(x, change))) return THR_OK;
  if (!change->keeps && !recount_passes(x, change)) {
    if (x->tube) take_turns_back(x, change);
    return THR_OK;
  }
  for (int i = 0; i < change->n_cords; i++)
    forget_visits(x, &x->walk[change->cord[i]]);
  for (int i = 0; i < change->n_cords && !st; i++) {
    st = set_walk(x, change->cord[i], x->made[i], change->n[i], err);
    if (!st) note_visits(x, change->cord[i]);
  }
  return st;
}
