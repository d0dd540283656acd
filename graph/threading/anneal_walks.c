/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the walks of simulated annealing, with what changes of them need to know, and makes a
 * change.
 *
 * Kept for each walk are running sums of its price; for each node the list of the visits that walks
 * pay to it, so that a place where two walks meet can be drawn at random in constant time; for each
 * edge its number of passes; and with tube joints how often each turn is made. A change is refused
 * if an edge would have fewer passes than its cover or more than its limit, or if a node would no
 * longer be tied.
 *
 * Example: walk 0 visits node 5 ahead of its pass 3. Then one of the entries visit[visit_first[5]]
 * .. of node 5 is {0, 3}, and walk[0].slot[3] is its number. */
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- walks ---- */

/* Returns the number of the first visit of a walk: an open one does not visit the node that it
 * starts from. */
static int first_visit(const thr_annealer *annealer)
{
  return annealer->closed ? 0 : 1;
}

/* Takes the visits of a walk out of the lists of their nodes: the last visit of the list fills each
 * gap. */
static void forget_visits(thr_annealer *annealer, const thr_anneal_walk *walk)
{
  for (int i = first_visit(annealer); i < walk->n; i++) {
    const int v = thr_tail(annealer->c->f, walk->half[i]),
              last = annealer->visit_first[v] + --annealer->n_visits[v];

    const thr_anneal_visit moved = annealer->visit[last];
    annealer->visit[walk->slot[i]] = moved;
    annealer->walk[moved.cord].slot[moved.at] = walk->slot[i];
  }
}

/* Appends the visits of walk `number` to the lists of their nodes. */
static void note_visits(thr_annealer *annealer, int number)
{
  thr_anneal_walk *walk = &annealer->walk[number];
  for (int i = first_visit(annealer); i < walk->n; i++) {
    const int v = thr_tail(annealer->c->f, walk->half[i]);
    walk->slot[i] = annealer->visit_first[v] + annealer->n_visits[v]++;
    annealer->visit[walk->slot[i]] = (thr_anneal_visit){number, i};
  }
}

/* Counts the passes half[n] up or down, and their length. */
static void add_passes(thr_annealer *annealer, const int *half, int n, int change)
{
  for (int i = 0; i < n; i++) {
    annealer->passes[half[i] >> 1] += change;
    annealer->extra += change * annealer->c->f->length[half[i] >> 1];
  }
}

/* Counts the turns of half[n] up or down, under both orders of their half-edges. */
static void add_turns(thr_annealer *annealer, const int *half, int n, int change)
{
  const thr_turning_columns *columns = annealer->c;
  for (int i = annealer->closed ? 0 : 1; i < n; i++) {
    const int in = half[i > 0 ? i - 1 : n - 1] ^ 1, out = half[i], v = thr_tail(columns->f, out);

    const int degree = thr_degree(columns->f, v), *position = columns->position;
    annealer->turns[annealer->pair_first[v] + position[in] * degree + position[out]] += change;
    annealer->turns[annealer->pair_first[v] + position[out] * degree + position[in]] += change;
  }
}

/* Returns whether the turns at node v tie its edges together: all are reached from the first. */
static bool is_tied(thr_annealer *annealer, int v)
{
  const int degree = thr_degree(annealer->c->f, v),
            *turns = annealer->turns + annealer->pair_first[v];
  int n = 1, *reached = annealer->tied, *left = annealer->tied + degree;

  /* The half-edges that are not reached yet wait in left. */
  reached[0] = 0;
  for (int i = 1; i < degree; i++)
    left[i - 1] = i;

  /* A breadth-first search; reached is the queue. */
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
static void take_turns_back(thr_annealer *annealer, const thr_anneal_change *change)
{
  for (int i = 0; i < change->n_cords; i++) {
    add_turns(annealer, annealer->made[i], change->n[i], -1);
    add_turns(annealer, annealer->walk[change->cord[i]].half, annealer->walk[change->cord[i]].n, 1);
  }
}

/* Counts the turns of a change in place of those of its cords. Returns false, and counts nothing,
 * where a node that they pass would no longer be tied. */
static bool recount_turns(thr_annealer *annealer, const thr_anneal_change *change)
{
  bool tied = true;
  for (int i = 0; i < change->n_cords; i++) {
    add_turns(annealer, annealer->walk[change->cord[i]].half, annealer->walk[change->cord[i]].n,
              -1);
    add_turns(annealer, annealer->made[i], change->n[i], 1);
  }

  /* Only nodes that lost their last turn of a kind may have come apart. */
  for (int i = 0; i < change->n_cords && tied; i++) {
    const thr_anneal_walk *walk = &annealer->walk[change->cord[i]];
    for (int k = annealer->closed ? 0 : 1; k < walk->n && tied; k++) {
      const int in = walk->half[k > 0 ? k - 1 : walk->n - 1] ^ 1, out = walk->half[k];
      const int v = thr_tail(annealer->c->f, out), degree = thr_degree(annealer->c->f, v);
      const int at = annealer->c->position[in] * degree + annealer->c->position[out];
      if (annealer->turns[annealer->pair_first[v] + at] == 0) tied = is_tied(annealer, v);
    }
  }

  if (!tied) take_turns_back(annealer, change);
  return tied;
}

/* Computes the running sums of a walk's price, and its total with the closing turn or the two ends.
 */
static void sum_turns(const thr_annealer *annealer, thr_anneal_walk *walk)
{
  walk->sum[0] = annealer->closed ? 0 : annealer->end_price[walk->half[0] >> 1];
  for (int i = 1; i < walk->n; i++)
    walk->sum[i] = walk->sum[i - 1] + thr_anneal_turn(annealer, walk->half[i - 1], walk->half[i]);

  const int last = walk->half[walk->n - 1];
  walk->total =
      walk->sum[walk->n - 1] + (annealer->closed ? thr_anneal_turn(annealer, last, walk->half[0])
                                                 : annealer->end_price[last >> 1]);
}

/* Makes half[n] the walk of cord `number`. Closed walks begin at a random pass, so that later
 * changes find other sections. */
static thr_status set_walk(thr_annealer *annealer, int number, const int *half, int n, thr_err *err)
{
  thr_anneal_walk *walk = &annealer->walk[number];

  /* Twice the length that is needed, so that walks which grow are seldom moved. */
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

  const int from = annealer->closed ? thr_random_below(&annealer->state, n) : 0;
  memcpy(walk->half, half + from, (size_t)(n - from) * sizeof *half);
  memcpy(walk->half + (n - from), half, (size_t)from * sizeof *half);

  walk->n = n;
  sum_turns(annealer, walk);
  return THR_OK;
}

/* ---- set up ---- */

/* Fills the prices of all turns and ends. By length a turn costs half of both its passes, and an
 * end half of its pass, so that the sum over a walk is its length. */
static void fill_prices(thr_annealer *annealer)
{
  const thr_frame *frame = annealer->c->f;
  const double angle = .05; /* rad */
  double sum = 0;

  for (int e = 0; e < frame->n_edges; e++) {
    sum += frame->length[e];
    if (annealer->measure == THR_WALK_LENGTH) annealer->end_price[e] = frame->length[e] / 2;
  }

  /* A route is disturbed by at most an average edge, or by a small angle. */
  annealer->noise = annealer->measure == THR_WALK_LENGTH ? sum / frame->n_edges : angle;

  /* The price of each turn at each node. */
  for (int v = 0; v < frame->n_nodes; v++) {
    const int degree = thr_degree(frame, v), *half = frame->half + frame->first[v];
    for (int i = 0; i < degree * degree; i++) {
      const int in = half[i / degree] ^ 1, out = half[i % degree];
      const bool length = annealer->measure == THR_WALK_LENGTH;

      /* With tube joints nothing turns back; for turnings only at nodes of one edge. */
      const bool back = in == (out ^ 1) && (annealer->tube || (!length && degree > 1));
      annealer->price[annealer->pair_first[v] + i] =
          back     ? THR_FORBIDDEN
          : length ? (frame->length[in >> 1] + frame->length[out >> 1]) / 2
                   : thr_turn_price(frame, annealer->c->task->cost, in, out);
    }
  }
}

/* Computes the least price from every half-edge to an end of a cord, by the method of Bellman, Ford
 * and Moore: half-edges whose price fell wait in a ring. */
static void find_ends(thr_annealer *annealer)
{
  const thr_frame *frame = annealer->c->f;
  const int m2 = 2 * frame->n_edges;
  int first = 0, n = 0, *queue = annealer->queue, *waits = annealer->stamp;

  /* Half-edges whose head allows a cord end need no further passes. */
  for (int h = 0; h < m2; h++) {
    const bool ends = annealer->c->task->end_allowed[thr_head(frame, h)];
    annealer->to_end[h] = ends ? annealer->end_price[h >> 1] : INFINITY;
    annealer->next[h] = -1;
    if ((waits[h] = ends)) queue[n++] = h;
  }

  /* Relax the turns into the half-edge that waits longest. */
  for (; n > 0; n--, first = (first + 1) % m2) {
    const int h = queue[first], v = thr_tail(frame, h);

    waits[h] = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      const int before = frame->half[i] ^ 1;
      const double price = annealer->to_end[h] + thr_anneal_turn(annealer, before, h);
      if (price >= annealer->to_end[before] - 1e-12 || price >= THR_FORBIDDEN) continue;

      annealer->to_end[before] = price;
      annealer->next[before] = h;
      if (!waits[before]) queue[(first + n++) % m2] = before;
      waits[before] = 1;
    }
  }

  /* find_route uses the same array for its time stamps, which begin at 0. */
  memset(waits, 0, (size_t)m2 * sizeof *waits);
}

/* Divides the visits and the turns among the nodes, and returns how many visits there can be: an
 * edge never has more passes than its limit, or than it has now. */
static size_t place_visits(thr_annealer *annealer, const int *now)
{
  const thr_frame *frame = annealer->c->f;
  size_t sum = 0, squares = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int degree = thr_degree(frame, v);

    annealer->visit_first[v] = (int)sum;
    annealer->pair_first[v] = (int)squares;
    squares += (size_t)degree * (size_t)degree;

    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      const int e = frame->half[i] >> 1;
      sum += (size_t)(now[e] > annealer->c->most[e] ? now[e] : annealer->c->most[e]);
    }
  }
  return sum;
}

/* Allocates the arrays. passes is used to count the cords' passes, and left at 0. */
static thr_status allocate(thr_annealer *annealer, const thr_cord *cord, thr_err *err)
{
  const thr_frame *frame = annealer->c->f;
  const size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;

  size_t squares = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    squares += (size_t)thr_degree(frame, v) * (size_t)thr_degree(frame, v);

  annealer->walk =
      thr_scratch_array(&annealer->own, (size_t)annealer->n_cords, sizeof *annealer->walk);
  annealer->pair_first = thr_scratch_array(&annealer->own, n, sizeof *annealer->pair_first);
  annealer->visit_first = thr_scratch_array(&annealer->own, n, sizeof *annealer->visit_first);
  annealer->n_visits = thr_scratch_array(&annealer->own, n, sizeof *annealer->n_visits);
  annealer->price = thr_scratch_array(&annealer->own, squares, sizeof *annealer->price);
  annealer->turns =
      thr_scratch_array(&annealer->own, annealer->tube ? squares : 0, sizeof *annealer->turns);
  annealer->tied =
      thr_scratch_array(&annealer->own, annealer->tube ? 2 * m : 0, sizeof *annealer->tied);
  annealer->passes = thr_scratch_array(&annealer->own, m, sizeof *annealer->passes);
  annealer->count = thr_scratch_array(&annealer->own, m, sizeof *annealer->count);
  annealer->end_price = thr_scratch_array(&annealer->own, m, sizeof *annealer->end_price);
  annealer->to_end = thr_scratch_array(&annealer->own, 2 * m, sizeof *annealer->to_end);
  annealer->next = thr_scratch_array(&annealer->own, 2 * m, sizeof *annealer->next);
  annealer->reached = thr_scratch_array(&annealer->own, 2 * m, sizeof *annealer->reached);
  annealer->before = thr_scratch_array(&annealer->own, 2 * m, sizeof *annealer->before);
  annealer->hops = thr_scratch_array(&annealer->own, 2 * m, sizeof *annealer->hops);
  annealer->stamp = thr_scratch_array(&annealer->own, 2 * m, sizeof *annealer->stamp);
  annealer->queue = thr_scratch_array(&annealer->own, 2 * m, sizeof *annealer->queue);

  thr_status st = thr_scratch_check(&annealer->own, err);
  if (st) return st;

  /* The room for visits depends on the passes that there are. */
  for (int i = 0; i < annealer->n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      annealer->passes[cord[i].half[k] >> 1]++;
  const size_t visits = place_visits(annealer, annealer->passes);
  annealer->room = (int)visits + 2 * frame->n_edges; /* and one way to an end more */
  annealer->visit = thr_scratch_array(&annealer->own, visits, sizeof *annealer->visit);
  annealer->made[0] =
      thr_scratch_array(&annealer->own, (size_t)annealer->room, sizeof *annealer->made[0]);
  annealer->made[1] =
      thr_scratch_array(&annealer->own, (size_t)annealer->room, sizeof *annealer->made[1]);
  annealer->route =
      thr_scratch_array(&annealer->own, (size_t)annealer->room, sizeof *annealer->route);
  memset(annealer->passes, 0, m * sizeof *annealer->passes);
  return thr_scratch_check(&annealer->own, err);
}

thr_status thr_annealer_init(thr_annealer *annealer, const thr_turning_columns *columns,
                             thr_walk_measure measure, const thr_cord *cord, int n_cords,
                             thr_err *err)
{
  const thr_frame *frame = columns->f;
  *annealer = (thr_annealer){.c = columns,
                             .measure = measure,
                             .closed = !columns->task->end_allowed,
                             .fixed = columns->task->end_count != NULL,
                             .tube = columns->task->tube,
                             .n_cords = n_cords,
                             .state = 1};

  thr_status st = allocate(annealer, cord, err);
  if (st) return st;
  fill_prices(annealer);

  /* The extra length is what the walks have beyond the covers. */
  for (int e = 0; e < frame->n_edges; e++)
    annealer->extra -= columns->cover[e] * frame->length[e];

  /* Each cord becomes a walk, with its visits, passes and turns. */
  for (int i = 0; i < n_cords && !st; i++) {
    st = set_walk(annealer, i, cord[i].half, cord[i].n_passes, err);
    if (st) break;
    note_visits(annealer, i);
    add_passes(annealer, cord[i].half, cord[i].n_passes, 1);
    if (annealer->tube) add_turns(annealer, cord[i].half, cord[i].n_passes, 1);
  }

  /* Cords that are longer than the limit already may keep their length. */
  annealer->most_extra = columns->task->extra_limit < 0
                             ? INFINITY
                             : fmax(columns->task->extra_limit, annealer->extra) * (1 + 1e-12);
  if (!st && !annealer->closed) find_ends(annealer);
  return st;
}

void thr_annealer_destroy(thr_annealer *annealer)
{
  for (int i = 0; annealer->walk && i < annealer->n_cords; i++) {
    free(annealer->walk[i].half);
    free(annealer->walk[i].slot);
    free(annealer->walk[i].sum);
  }
  thr_scratch_free(&annealer->own);
}

/* ---- parts of changes ---- */

void thr_anneal_put(thr_annealer *annealer, thr_anneal_change *change, int i, const int *half,
                    int from, int end, bool backwards)
{
  int *out = annealer->made[i] + change->n[i];
  for (int k = from; k < end; k++)
    *out++ = backwards ? half[end - 1 - (k - from)] ^ 1 : half[k];
  change->n[i] += end - from;
}

double thr_anneal_total(const thr_annealer *annealer, const thr_anneal_change *change, int i)
{
  const int n = change->n[i], *half = annealer->made[i];

  double total = annealer->closed
                     ? thr_anneal_turn(annealer, half[n - 1], half[0])
                     : annealer->end_price[half[0] >> 1] + annealer->end_price[half[n - 1] >> 1];
  for (int k = 1; k < n; k++)
    total += thr_anneal_turn(annealer, half[k - 1], half[k]);
  return total;
}

bool thr_anneal_spare(thr_annealer *annealer, const thr_anneal_walk *walk, int from, int end)
{
  bool spare = true;

  /* count sees edges that the section passes several times. */
  for (int k = from; k < end; k++) {
    const int e = walk->half[k] >> 1;
    spare &= annealer->passes[e] - ++annealer->count[e] >= annealer->c->cover[e];
  }

  for (int k = from; k < end; k++)
    annealer->count[walk->half[k] >> 1] = 0;
  return spare;
}

thr_anneal_visit thr_anneal_visit_at(thr_annealer *annealer, int node)
{
  if (annealer->n_visits[node] == 0) return (thr_anneal_visit){-1, -1};
  return annealer->visit[annealer->visit_first[node] +
                         thr_random_below(&annealer->state, annealer->n_visits[node])];
}

/* Counts the passes of a change in place of those of its cords. Returns false, and counts nothing,
 * where an edge would have fewer passes than its cover or more than its limit, or where the extra
 * length would rise above its limit. */
static bool recount_passes(thr_annealer *annealer, const thr_anneal_change *change)
{
  const thr_turning_columns *columns = annealer->c;
  const double extra = annealer->extra;
  bool right = true;

  /* Count the new walks in place of the old ones. */
  for (int i = 0; i < change->n_cords; i++)
    add_passes(annealer, annealer->walk[change->cord[i]].half, annealer->walk[change->cord[i]].n,
               -1);
  for (int i = 0; i < change->n_cords; i++)
    add_passes(annealer, annealer->made[i], change->n[i], 1);

  /* Only edges of the old walks can have lost passes, only edges of the new ones gained some. */
  for (int i = 0; i < change->n_cords; i++) {
    const thr_anneal_walk *walk = &annealer->walk[change->cord[i]];
    for (int k = 0; k < walk->n; k++)
      right &= annealer->passes[walk->half[k] >> 1] >= columns->cover[walk->half[k] >> 1];
    for (int k = 0; k < change->n[i]; k++)
      right &=
          annealer->passes[annealer->made[i][k] >> 1] <= columns->most[annealer->made[i][k] >> 1];
  }

  /* An extra length above its limit may stay or fall. */
  if (right && (annealer->extra <= annealer->most_extra || annealer->extra <= extra)) return true;

  for (int i = 0; i < change->n_cords; i++) {
    add_passes(annealer, annealer->made[i], change->n[i], -1);
    add_passes(annealer, annealer->walk[change->cord[i]].half, annealer->walk[change->cord[i]].n,
               1);
  }
  annealer->extra = extra;
  return false;
}

thr_status thr_anneal_make(thr_annealer *annealer, const thr_anneal_change *change, thr_err *err)
{
  bool right = true;
  thr_status st = THR_OK;

  /* A change that leaves a walk without passes is refused. */
  for (int i = 0; i < change->n_cords; i++)
    right &= change->n[i] > 0;

  if (!right || (annealer->tube && !recount_turns(annealer, change))) return THR_OK;

  if (!change->keeps && !recount_passes(annealer, change)) {
    if (annealer->tube) take_turns_back(annealer, change);
    return THR_OK;
  }

  /* All visits are forgotten before the walks are replaced: the lists refer to both. */
  for (int i = 0; i < change->n_cords; i++)
    forget_visits(annealer, &annealer->walk[change->cord[i]]);
  for (int i = 0; i < change->n_cords && !st; i++) {
    st = set_walk(annealer, change->cord[i], annealer->made[i], change->n[i], err);
    if (!st) note_visits(annealer, change->cord[i]);
  }
  return st;
}
