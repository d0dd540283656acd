/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proposes changes of simulated annealing that keep all passes: sections of one cord or of two
 * cords are exchanged, cut off or turned round.
 *
 * The totals afterwards follow from the running sums of the walks and the few turns at the cuts, in
 * constant time; only an exchange that is taken is put together (thr_anneal_build), in time
 * proportional to its cords. Which exchange is proposed depends on a place of the cord and a second
 * place at the same node, both drawn at random:
 *
 *   both on one cord         the loop between them is reversed, or goes to a cord that it meets
 *   on two cords, at ends    the cords exchange what comes after the places (tails)
 *   on two cords, visits     tails, or the sections up to a second node where they meet (middles)
 */
#include "graph/threading/threading.h"

/* Return the passes before and after visit i; -1 where an open cord ends. */
static int before(const thr_annealer *annealer, const thr_anneal_walk *walk, int i)
{
  return i > 0 ? walk->half[i - 1] : annealer->closed ? walk->half[walk->n - 1] : -1;
}

static int after(const thr_annealer *annealer, const thr_anneal_walk *walk, int i)
{
  return i < walk->n ? walk->half[i] : annealer->closed ? walk->half[0] : -1;
}

/* Returns the price of a turn, or of an end where one of the half-edges is -1. */
static double turn(const thr_annealer *annealer, int in, int out)
{
  return in < 0    ? annealer->end_price[out >> 1]
         : out < 0 ? annealer->end_price[in >> 1]
                   : thr_anneal_turn(annealer, in, out);
}

/* Returns the price of the turns between passes from .. end - 1. */
static double inside(const thr_anneal_walk *walk, int from, int end)
{
  return walk->sum[end - 1] - walk->sum[from];
}

/* Return the price of all turns, and the end, before place i of an open cord, and of all from place
 * i on. */
static double ahead(const thr_anneal_walk *walk, int i)
{
  return i > 0 ? walk->sum[i - 1] : 0;
}

static double behind(const thr_anneal_walk *walk, int i)
{
  return i < walk->n ? walk->total - walk->sum[i] : 0;
}

/* Returns a half-edge the other way round; -1 stays a cord end. */
static int back(int half)
{
  return half < 0 ? -1 : half ^ 1;
}

/* Draws a place of a cord at a node: a visit, or the end of an open cord other than number except.
 * Returns false if the draw failed. */
static bool draw_place(thr_annealer *annealer, int except, int node, thr_anneal_visit *at)
{
  const thr_frame *frame = annealer->c->f;
  const int n = annealer->n_visits[node];

  /* All visits and one draw of an end are equally likely. */
  if (n > 0 && thr_random_below(&annealer->state, n + 1) < n) {
    *at = thr_anneal_visit_at(annealer, node);
    return true;
  }

  /* A random cord that ends at the node, at either end. */
  const int number = thr_random_below(&annealer->state, annealer->n_cords);
  const thr_anneal_walk *walk = &annealer->walk[number];
  if (number == except) return false;

  if (thr_tail(frame, walk->half[0]) == node)
    *at = (thr_anneal_visit){number, 0};
  else if (thr_head(frame, walk->half[walk->n - 1]) == node)
    *at = (thr_anneal_visit){number, walk->n};
  else
    return false;
  return true;
}

/* Proposes that two open cords exchange their parts after the places i and j. If turned, the first
 * part of each cord is joined to the first part of the other, and the second to the second. */
static bool change_tails(thr_annealer *annealer, thr_anneal_exchange *exchange)
{
  thr_anneal_change *change = &exchange->change;
  const thr_anneal_walk *walk = &annealer->walk[change->cord[0]],
                        *other = &annealer->walk[change->cord[1]];
  const int i = exchange->i, j = exchange->j;

  exchange->kind = THR_ANNEAL_TAILS;
  exchange->turned = thr_random_below(&annealer->state, 2);
  change->n_cords = 2;

  /* Head to head and tail to tail, or each head to the other tail. */
  if (exchange->turned) {
    change->total[0] = ahead(walk, i) +
                       turn(annealer, before(annealer, walk, i), back(before(annealer, other, j))) +
                       ahead(other, j);
    change->total[1] = behind(walk, i) +
                       turn(annealer, back(after(annealer, walk, i)), after(annealer, other, j)) +
                       behind(other, j);
    return j > 0 || i > 0;
  }

  change->total[0] = ahead(walk, i) +
                     turn(annealer, before(annealer, walk, i), after(annealer, other, j)) +
                     behind(other, j);
  change->total[1] = ahead(other, j) +
                     turn(annealer, before(annealer, other, j), after(annealer, walk, i)) +
                     behind(walk, i);
  return true;
}

/* Proposes that two cords, both closed or both open, exchange the sections between two nodes where
 * they meet. */
static bool change_middles(thr_annealer *annealer, thr_anneal_exchange *exchange)
{
  enum { TRIES = 4 };
  thr_anneal_change *change = &exchange->change;
  const thr_anneal_walk *walk = &annealer->walk[change->cord[0]],
                        *other = &annealer->walk[change->cord[1]];
  const int first = annealer->closed ? 0 : 1;

  exchange->kind = THR_ANNEAL_MIDDLES;
  change->n_cords = 2;

  for (int tries = 0; tries < TRIES; tries++) {
    int i = exchange->i, i2 = first + thr_random_below(&annealer->state, walk->n - first),
        j = exchange->j;
    if (i2 == i) continue;

    /* The second node: any visit of the first cord that the other cord pays, too. */
    const thr_anneal_visit at =
        thr_anneal_visit_at(annealer, thr_tail(annealer->c->f, walk->half[i2]));
    if (at.cord != change->cord[1] || at.at == j) continue;

    /* Put both places of each cord in order. The sections run in opposite directions if only one
     * pair had to be exchanged. */
    int j2 = at.at;
    exchange->turned = (i2 > i) != (j2 > j);
    exchange->i2 = i2 > i ? i2 : i;
    exchange->i = i2 > i ? i : i2;
    exchange->j2 = j2 > j ? j2 : j;
    exchange->j = j2 > j ? j : j2;

    /* The first and last passes of the sections, before and after they change cords (a: of walk, b:
     * of other). */
    const int ends_a[2] = {walk->half[exchange->i], walk->half[exchange->i2 - 1]},
              ends_b[2] = {other->half[exchange->j], other->half[exchange->j2 - 1]};
    const int new_a[2] = {exchange->turned ? ends_b[1] ^ 1 : ends_b[0],
                          exchange->turned ? ends_b[0] ^ 1 : ends_b[1]};
    const int new_b[2] = {exchange->turned ? ends_a[1] ^ 1 : ends_a[0],
                          exchange->turned ? ends_a[0] ^ 1 : ends_a[1]};

    const double in_a = inside(walk, exchange->i, exchange->i2),
                 in_b = inside(other, exchange->j, exchange->j2);
    const int from_a = before(annealer, walk, exchange->i),
              to_a = after(annealer, walk, exchange->i2),
              from_b = before(annealer, other, exchange->j),
              to_b = after(annealer, other, exchange->j2);

    /* A section leaves with its turns inside and those at its ends, and the other one comes. */
    change->total[0] = walk->total - in_a - turn(annealer, from_a, ends_a[0]) -
                       turn(annealer, ends_a[1], to_a) + in_b + turn(annealer, from_a, new_a[0]) +
                       turn(annealer, new_a[1], to_a);
    change->total[1] = other->total - in_b - turn(annealer, from_b, ends_b[0]) -
                       turn(annealer, ends_b[1], to_b) + in_a + turn(annealer, from_b, new_b[0]) +
                       turn(annealer, new_b[1], to_b);
    return true;
  }
  return false;
}

/* Returns the total of a cord without the passes from i to i2 - 1, which lead back to where they
 * begin. */
static double without(const thr_annealer *annealer, const thr_anneal_walk *walk, int i, int i2)
{
  const int in = before(annealer, walk, i), out = after(annealer, walk, i2);
  return walk->total - inside(walk, i, i2) - turn(annealer, in, walk->half[i]) -
         turn(annealer, walk->half[i2 - 1], out) + turn(annealer, in, out);
}

/* Proposes for a section that leads back to where it begins (a loop) that it runs the other way
 * round, or goes to another cord that meets it. */
static bool change_loop(thr_annealer *annealer, thr_anneal_exchange *exchange)
{
  thr_anneal_change *change = &exchange->change;
  const thr_anneal_walk *walk = &annealer->walk[change->cord[0]];
  const int i = exchange->i, i2 = exchange->j > i ? exchange->j : i;

  exchange->i = i2 == i ? exchange->j : i;
  exchange->i2 = i2;
  change->n_cords = 1;

  const int first = walk->half[exchange->i], last = walk->half[i2 - 1],
            in = before(annealer, walk, exchange->i), out = after(annealer, walk, i2);

  if (annealer->n_cords == 1 || thr_random_below(&annealer->state, 2)) {
    exchange->kind = THR_ANNEAL_REVERSE;
    change->total[0] = walk->total + turn(annealer, in, last ^ 1) + turn(annealer, first ^ 1, out) -
                       turn(annealer, in, first) - turn(annealer, last, out);
    return true;
  }

  /* The loop is entered at a random visit m, where another cord has to pass. */
  exchange->kind = THR_ANNEAL_LOOP;
  exchange->m = exchange->i + thr_random_below(&annealer->state, i2 - exchange->i);
  const thr_anneal_visit at =
      thr_anneal_visit_at(annealer, thr_tail(annealer->c->f, walk->half[exchange->m]));
  if (at.cord < 0 || at.cord == change->cord[0]) return false;

  /* Opened at m, the loop gains its closing turn and loses the turn at m. */
  const thr_anneal_walk *other = &annealer->walk[at.cord];
  const bool within = exchange->m > exchange->i;
  const int enter = walk->half[exchange->m], leave = within ? walk->half[exchange->m - 1] : last;
  double loop = inside(walk, exchange->i, i2);
  if (within) loop += turn(annealer, last, first) - turn(annealer, leave, enter);

  exchange->j = at.at;
  exchange->turned = thr_random_below(&annealer->state, 2);
  const int from = before(annealer, other, exchange->j), to = after(annealer, other, exchange->j);

  change->n_cords = 2;
  change->cord[1] = at.cord;
  change->total[0] = without(annealer, walk, exchange->i, i2);
  change->total[1] = other->total - turn(annealer, from, to) + loop +
                     turn(annealer, from, exchange->turned ? leave ^ 1 : enter) +
                     turn(annealer, exchange->turned ? enter ^ 1 : leave, to);
  return true;
}

bool thr_anneal_exchanges(thr_annealer *annealer, int cord, thr_anneal_exchange *exchange)
{
  const thr_anneal_walk *walk = &annealer->walk[cord];
  const int first = annealer->closed ? 0 : 1;
  thr_anneal_visit at;
  if (walk->n < 2) return false;

  /* Draw the first place on the cord, and the second one at the same node. */
  const int i = first + thr_random_below(&annealer->state, walk->n - first),
            node = thr_tail(annealer->c->f, walk->half[i]);
  *exchange = (thr_anneal_exchange){.i = i};

  if (annealer->closed)
    at = thr_anneal_visit_at(annealer, node);
  else if (!draw_place(annealer, cord, node, &at))
    return false;

  exchange->change.cord[0] = cord;
  exchange->change.cord[1] = at.cord;
  exchange->j = at.at;
  if (at.cord == cord) return at.at != i && change_loop(annealer, exchange);

  const bool visited = annealer->closed || (at.at > 0 && at.at < annealer->walk[at.cord].n);
  if (visited && (annealer->closed || thr_random_below(&annealer->state, 4) == 0))
    return change_middles(annealer, exchange);
  return change_tails(annealer, exchange);
}

/* Puts together two cords that exchange tails. */
static void build_tails(thr_annealer *annealer, thr_anneal_exchange *exchange)
{
  thr_anneal_change *change = &exchange->change;
  const thr_anneal_walk *walk = &annealer->walk[change->cord[0]],
                        *other = &annealer->walk[change->cord[1]];

  thr_anneal_put(annealer, change, 0, walk->half, 0, exchange->i, false);

  if (exchange->turned) {
    thr_anneal_put(annealer, change, 0, other->half, 0, exchange->j, true);
    thr_anneal_put(annealer, change, 1, walk->half, exchange->i, walk->n, true);
  } else {
    thr_anneal_put(annealer, change, 0, other->half, exchange->j, other->n, false);
    thr_anneal_put(annealer, change, 1, other->half, 0, exchange->j, false);
  }
  if (exchange->turned)
    thr_anneal_put(annealer, change, 1, other->half, exchange->j, other->n, false);
  else
    thr_anneal_put(annealer, change, 1, walk->half, exchange->i, walk->n, false);
}

/* Puts together a cord without its loop, and the cord that the loop goes to. */
static void build_loop(thr_annealer *annealer, thr_anneal_exchange *exchange)
{
  thr_anneal_change *change = &exchange->change;
  const thr_anneal_walk *walk = &annealer->walk[change->cord[0]],
                        *other = &annealer->walk[change->cord[1]];

  thr_anneal_put(annealer, change, 0, walk->half, 0, exchange->i, false);
  thr_anneal_put(annealer, change, 0, walk->half, exchange->i2, walk->n, false);

  /* The second cord up to place j, the loop from m round to m again, and the rest. */
  thr_anneal_put(annealer, change, 1, other->half, 0, exchange->j, false);
  thr_anneal_put(annealer, change, 1, walk->half, exchange->turned ? exchange->i : exchange->m,
                 exchange->turned ? exchange->m : exchange->i2, exchange->turned);
  thr_anneal_put(annealer, change, 1, walk->half, exchange->turned ? exchange->m : exchange->i,
                 exchange->turned ? exchange->i2 : exchange->m, exchange->turned);
  thr_anneal_put(annealer, change, 1, other->half, exchange->j, other->n, false);
}

void thr_anneal_build(thr_annealer *annealer, thr_anneal_exchange *exchange)
{
  thr_anneal_change *change = &exchange->change;
  const thr_anneal_walk *walk = &annealer->walk[change->cord[0]],
                        *other = &annealer->walk[change->cord[1]];
  change->keeps = true;

  if (exchange->kind == THR_ANNEAL_TAILS) {
    build_tails(annealer, exchange);
    return;
  }
  if (exchange->kind == THR_ANNEAL_LOOP) {
    build_loop(annealer, exchange);
    return;
  }

  const bool middles = exchange->kind == THR_ANNEAL_MIDDLES;

  /* The middle of the first cord becomes that of the second, or its own backwards. */
  thr_anneal_put(annealer, change, 0, walk->half, 0, exchange->i, false);
  thr_anneal_put(annealer, change, 0, middles ? other->half : walk->half,
                 middles ? exchange->j : exchange->i, middles ? exchange->j2 : exchange->i2,
                 middles ? exchange->turned : true);
  thr_anneal_put(annealer, change, 0, walk->half, exchange->i2, walk->n, false);

  if (!middles) return;
  thr_anneal_put(annealer, change, 1, other->half, 0, exchange->j, false);
  thr_anneal_put(annealer, change, 1, walk->half, exchange->i, exchange->i2, exchange->turned);
  thr_anneal_put(annealer, change, 1, other->half, exchange->j2, other->n, false);
}
