/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes that leave all passes as they are: what they make of the totals is known from running
 * sums. */
#include "graph/random.h"
#include "graph/threading/anneal.h"

/* The passes before and after visit i; -1 where an open cord ends. */
static int before(const thr_annealer *x, const thr_anneal_walk *walk, int i)
{
  return i > 0 ? walk->half[i - 1] : x->closed ? walk->half[walk->n - 1] : -1;
}

static int after(const thr_annealer *x, const thr_anneal_walk *walk, int i)
{
  return i < walk->n ? walk->half[i] : x->closed ? walk->half[0] : -1;
}

/* Price of a turn, or of an end. */
static double turn(const thr_annealer *x, int in, int out)
{
  return in < 0    ? x->end_price[out >> 1]
         : out < 0 ? x->end_price[in >> 1]
                   : thr_anneal_turn(x, in, out);
}

/* Price of the turns between passes from .. end - 1. */
static double inside(const thr_anneal_walk *walk, int from, int end)
{
  return walk->sum[end - 1] - walk->sum[from];
}

/* The same of all before place i, and of all from there on, of an open cord. */
static double ahead(const thr_anneal_walk *walk, int i)
{
  return i > 0 ? walk->sum[i - 1] : 0;
}

static double behind(const thr_anneal_walk *walk, int i)
{
  return i < walk->n ? walk->total - walk->sum[i] : 0;
}

static int back(int half)
{
  return half < 0 ? -1 : half ^ 1;
}

/* Place j of an open cord b at a node: a visit, or an end of any cord. false: drawn was none. */
static bool draw_place(thr_annealer *x, int a, int node, thr_anneal_visit *at)
{
  const thr_frame *frame = x->c->f;
  const int n = x->n_visits[node];
  if (n > 0 && thr_random_below(&x->state, n + 1) < n) {
    *at = thr_anneal_visit_at(x, node);
    return true;
  }
  const int b = thr_random_below(&x->state, x->n_cords);
  const thr_anneal_walk *walk = &x->walk[b];
  if (b == a) return false;
  if (thr_tail(frame, walk->half[0]) == node)
    *at = (thr_anneal_visit){b, 0};
  else if (thr_head(frame, walk->half[walk->n - 1]) == node)
    *at = (thr_anneal_visit){b, walk->n};
  else
    return false;
  return true;
}

/* Two open cords go on as the other one does; turned: the second parts of neither are those of the
 * other. */
static bool change_tails(thr_annealer *x, thr_anneal_exchange *e)
{
  thr_anneal_change *change = &e->change;
  const thr_anneal_walk *a = &x->walk[change->cord[0]], *b = &x->walk[change->cord[1]];
  const int i = e->i, j = e->j;
  e->kind = THR_ANNEAL_TAILS;
  e->turned = thr_random_below(&x->state, 2);
  change->n_cords = 2;
  if (e->turned) {
    change->total[0] = ahead(a, i) + turn(x, before(x, a, i), back(before(x, b, j))) + ahead(b, j);
    change->total[1] = behind(a, i) + turn(x, back(after(x, a, i)), after(x, b, j)) + behind(b, j);
    return j > 0 || i > 0;
  }
  change->total[0] = ahead(a, i) + turn(x, before(x, a, i), after(x, b, j)) + behind(b, j);
  change->total[1] = ahead(b, j) + turn(x, before(x, b, j), after(x, a, i)) + behind(a, i);
  return true;
}

/* Two closed cords, or open ones, that meet at two nodes exchange what is between. */
static bool change_middles(thr_annealer *x, thr_anneal_exchange *e)
{
  enum { TRIES = 4 };
  thr_anneal_change *change = &e->change;
  const thr_anneal_walk *a = &x->walk[change->cord[0]], *b = &x->walk[change->cord[1]];
  const int first = x->closed ? 0 : 1;
  e->kind = THR_ANNEAL_MIDDLES;
  change->n_cords = 2;
  for (int tries = 0; tries < TRIES; tries++) {
    int i = e->i, i2 = first + thr_random_below(&x->state, a->n - first), j = e->j;
    if (i2 == i) continue;
    const thr_anneal_visit at = thr_anneal_visit_at(x, thr_tail(x->c->f, a->half[i2]));
    if (at.cord != change->cord[1] || at.at == j) continue;
    int j2 = at.at;
    e->turned = (i2 > i) != (j2 > j);
    e->i2 = i2 > i ? i2 : i;
    e->i = i2 > i ? i : i2;
    e->j2 = j2 > j ? j2 : j;
    e->j = j2 > j ? j : j2;
    const int ends_a[2] = {a->half[e->i], a->half[e->i2 - 1]},
              ends_b[2] = {b->half[e->j], b->half[e->j2 - 1]};
    const int new_a[2] = {e->turned ? ends_b[1] ^ 1 : ends_b[0],
                          e->turned ? ends_b[0] ^ 1 : ends_b[1]};
    const int new_b[2] = {e->turned ? ends_a[1] ^ 1 : ends_a[0],
                          e->turned ? ends_a[0] ^ 1 : ends_a[1]};
    const double in_a = inside(a, e->i, e->i2), in_b = inside(b, e->j, e->j2);
    const int from_a = before(x, a, e->i), to_a = after(x, a, e->i2), from_b = before(x, b, e->j),
              to_b = after(x, b, e->j2);
    change->total[0] = a->total - in_a - turn(x, from_a, ends_a[0]) - turn(x, ends_a[1], to_a) +
                       in_b + turn(x, from_a, new_a[0]) + turn(x, new_a[1], to_a);
    change->total[1] = b->total - in_b - turn(x, from_b, ends_b[0]) - turn(x, ends_b[1], to_b) +
                       in_a + turn(x, from_b, new_b[0]) + turn(x, new_b[1], to_b);
    return true;
  }
  return false;
}

/* What cord a turns by without the passes from i to i2 - 1, which lead back to where they begin. */
static double without(const thr_annealer *x, const thr_anneal_walk *a, int i, int i2)
{
  const int in = before(x, a, i), out = after(x, a, i2);
  return a->total - inside(a, i, i2) - turn(x, in, a->half[i]) - turn(x, a->half[i2 - 1], out) +
         turn(x, in, out);
}

/* A part that leads back to where it begins runs the other way round, or goes to another cord that
 * meets it. */
static bool change_loop(thr_annealer *x, thr_anneal_exchange *e)
{
  thr_anneal_change *change = &e->change;
  const thr_anneal_walk *a = &x->walk[change->cord[0]];
  const int i = e->i, i2 = e->j > i ? e->j : i;
  e->i = i2 == i ? e->j : i;
  e->i2 = i2;
  change->n_cords = 1;
  const int first = a->half[e->i], last = a->half[i2 - 1], in = before(x, a, e->i),
            out = after(x, a, i2);
  if (x->n_cords == 1 || thr_random_below(&x->state, 2)) {
    e->kind = THR_ANNEAL_REVERSE;
    change->total[0] = a->total + turn(x, in, last ^ 1) + turn(x, first ^ 1, out) -
                       turn(x, in, first) - turn(x, last, out);
    return true;
  }
  e->kind = THR_ANNEAL_LOOP;
  e->m = e->i + thr_random_below(&x->state, i2 - e->i);
  const thr_anneal_visit at = thr_anneal_visit_at(x, thr_tail(x->c->f, a->half[e->m]));
  if (at.cord < 0 || at.cord == change->cord[0]) return false;
  const thr_anneal_walk *b = &x->walk[at.cord];
  const bool within = e->m > e->i;
  const int enter = a->half[e->m], leave = within ? a->half[e->m - 1] : last;
  double loop = inside(a, e->i, i2);
  if (within) loop += turn(x, last, first) - turn(x, leave, enter);
  e->j = at.at;
  e->turned = thr_random_below(&x->state, 2);
  const int from = before(x, b, e->j), to = after(x, b, e->j);
  change->n_cords = 2;
  change->cord[1] = at.cord;
  change->total[0] = without(x, a, e->i, i2);
  change->total[1] = b->total - turn(x, from, to) + loop +
                     turn(x, from, e->turned ? leave ^ 1 : enter) +
                     turn(x, e->turned ? enter ^ 1 : leave, to);
  return true;
}

bool thr_anneal_exchanges(thr_annealer *x, int a, thr_anneal_exchange *e)
{
  const thr_anneal_walk *walk = &x->walk[a];
  const int first = x->closed ? 0 : 1;
  thr_anneal_visit at;
  if (walk->n < 2) return false;
  const int i = first + thr_random_below(&x->state, walk->n - first),
            node = thr_tail(x->c->f, walk->half[i]);
  *e = (thr_anneal_exchange){.i = i};
  if (x->closed)
    at = thr_anneal_visit_at(x, node);
  else if (!draw_place(x, a, node, &at))
    return false;
  e->change.cord[0] = a;
  e->change.cord[1] = at.cord;
  e->j = at.at;
  if (at.cord == a) return at.at != i && change_loop(x, e);
  const bool visited = x->closed || (at.at > 0 && at.at < x->walk[at.cord].n);
  if (visited && (x->closed || thr_random_below(&x->state, 4) == 0)) return change_middles(x, e);
  return change_tails(x, e);
}

/* Two cords that exchange tails, as sections. */
static void build_tails(thr_annealer *x, thr_anneal_exchange *e)
{
  thr_anneal_change *change = &e->change;
  const thr_anneal_walk *a = &x->walk[change->cord[0]], *b = &x->walk[change->cord[1]];
  thr_anneal_put(x, change, 0, a->half, 0, e->i, false);
  if (e->turned) {
    thr_anneal_put(x, change, 0, b->half, 0, e->j, true);
    thr_anneal_put(x, change, 1, a->half, e->i, a->n, true);
  } else {
    thr_anneal_put(x, change, 0, b->half, e->j, b->n, false);
    thr_anneal_put(x, change, 1, b->half, 0, e->j, false);
  }
  if (e->turned)
    thr_anneal_put(x, change, 1, b->half, e->j, b->n, false);
  else
    thr_anneal_put(x, change, 1, a->half, e->i, a->n, false);
}

static void build_loop(thr_annealer *x, thr_anneal_exchange *e)
{
  thr_anneal_change *change = &e->change;
  const thr_anneal_walk *a = &x->walk[change->cord[0]], *b = &x->walk[change->cord[1]];
  thr_anneal_put(x, change, 0, a->half, 0, e->i, false);
  thr_anneal_put(x, change, 0, a->half, e->i2, a->n, false);
  thr_anneal_put(x, change, 1, b->half, 0, e->j, false);
  thr_anneal_put(x, change, 1, a->half, e->turned ? e->i : e->m, e->turned ? e->m : e->i2,
                 e->turned);
  thr_anneal_put(x, change, 1, a->half, e->turned ? e->m : e->i, e->turned ? e->i2 : e->m,
                 e->turned);
  thr_anneal_put(x, change, 1, b->half, e->j, b->n, false);
}

void thr_anneal_build(thr_annealer *x, thr_anneal_exchange *e)
{
  thr_anneal_change *change = &e->change;
  const thr_anneal_walk *a = &x->walk[change->cord[0]], *b = &x->walk[change->cord[1]];
  change->keeps = true;
  if (e->kind == THR_ANNEAL_TAILS) {
    build_tails(x, e);
    return;
  }
  if (e->kind == THR_ANNEAL_LOOP) {
    build_loop(x, e);
    return;
  }
  const bool middles = e->kind == THR_ANNEAL_MIDDLES;
  thr_anneal_put(x, change, 0, a->half, 0, e->i, false);
  thr_anneal_put(x, change, 0, middles ? b->half : a->half, middles ? e->j : e->i,
                 middles ? e->j2 : e->i2, middles ? e->turned : true);
  thr_anneal_put(x, change, 0, a->half, e->i2, a->n, false);
  if (!middles) return;
  thr_anneal_put(x, change, 1, b->half, 0, e->j, false);
  thr_anneal_put(x, change, 1, a->half, e->i, e->i2, e->turned);
  thr_anneal_put(x, change, 1, b->half, e->j2, b->n, false);
}
