/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fewest cords within a limit on the pull: plans against all sets of cords of small frameworks,
 * and forged claims. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/truth.h"

#include <math.h>
#include <stdlib.h>

enum { NODES = 8, MOST = 6, EDGES = TRUTH_TABLE_EDGES, SETS = 1 << EDGES, HALVES = 2 * EDGES };

typedef struct {
  thr_frame frame;
  thr_request o;
  bool end_node[NODES];
} instance;

/* ---- the truth: all sets of edges that a cord within the pull may pass ---- */

/* A side of a cord: its edges and last half-edge say where it stands in the list. */
typedef struct {
  int set, half;
  double length, turning;
} part;

/* For the sides that begin where a cord may end, or all at one node, and keep to the limit. */
typedef struct {
  const thr_frame *f;
  double most; /* rad */
  int n;
  part label[200000];
} parts;

static parts side; /* too large for the stack */

/* Is there one that is no worse? */
static bool is_dominated(const part *new)
{
  for (int i = 0; i < side.n; i++) {
    const part *old = &side.label[i];
    if (old->set == new->set && old->half == new->half && old->length <= new->length + 1e-12 &&
        old->turning <= new->turning + 1e-12)
      return true;
  }
  return false;
}

/* Lists all sides from where a cord may end; home >= 0: from there. They turn back anywhere. */
static void grow(const thr_request *o, int home)
{
  const thr_frame *f = side.f;
  side.n = 0;
  for (int h = 0; h < 2 * f->n_edges; h++) {
    const int v = thr_tail(f, h);
    if (home < 0 ? thr_plan_end_allowed(f, o, v) : v == home)
      side.label[side.n++] = (part){1 << (h >> 1), h, f->length[h >> 1], 0};
  }
  for (int i = 0; i < side.n; i++) {
    const part at = side.label[i];
    const int v = thr_head(f, at.half);
    for (int k = f->first[v]; k < f->first[v + 1]; k++) {
      const int h = f->half[k];
      const part next = {at.set | 1 << (h >> 1), h, at.length + f->length[h >> 1],
                         at.turning + thr_turn_angle(f, at.half, h)};
      if (next.turning > side.most || is_dominated(&next)) continue;
      ck_assert_int_lt(side.n, 200000);
      side.label[side.n++] = next;
    }
  }
}

/* Takes the cords whose two sides, of those listed, meet at some node: the turn there is cut, and
 * passed by neither end. */
static void join_sides(double shortest[SETS])
{
  static double length[NODES][SETS];
  for (int v = 0; v < side.f->n_nodes; v++)
    for (int set = 0; set < SETS; set++)
      length[v][set] = INFINITY;
  for (int i = 0; i < side.n; i++) {
    double *to = &length[thr_head(side.f, side.label[i].half)][side.label[i].set];
    *to = fmin(*to, side.label[i].length);
  }
  for (int v = 0; v < side.f->n_nodes; v++)
    for (int a = 0; a < SETS; a++)
      for (int b = 0; b <= a && isfinite(length[v][a]); b++)
        shortest[a | b] = fmin(shortest[a | b], length[v][a] + length[v][b]);
}

/* shortest[set]: length of the shortest cord within the pull over all edges of the set, INFINITY:
 * there is none. */
static void shortest_cords(const thr_frame *f, const thr_request *o, double shortest[SETS])
{
  const bool closed = o->ends == THR_ENDS_CLOSED;
  const double limit = log(o->max_pull) / o->physics.mu;
  side.f = f;
  side.most = limit + 1e-8 * (1 + limit);
  for (int set = 0; set < SETS; set++)
    shortest[set] = INFINITY;
  for (int home = closed ? 0 : -1; home < (closed ? f->n_nodes : 0); home++) {
    grow(o, home);
    join_sides(shortest);
  }
  for (int e = 0; e < f->n_edges && !closed; e++) /* of one pass */
    if (thr_plan_end_allowed(f, o, f->edge[e][0]) && thr_plan_end_allowed(f, o, f->edge[e][1]))
      shortest[1 << e] = fmin(shortest[1 << e], f->length[e]);
  for (int e = 0; e < f->n_edges; e++)
    for (int set = 0; set < SETS; set++)
      if (!(set >> e & 1)) shortest[set] = fmin(shortest[set], shortest[set | 1 << e]);
}

/* least[n]: length of n cords over all edges, each within the pull; INFINITY: there are none. */
static void least_lengths(const thr_frame *f, const thr_request *o, double least[MOST + 1])
{
  static double shortest[SETS], of[MOST + 1][SETS];
  shortest_cords(f, o, shortest);
  for (int set = 0; set < SETS; set++)
    of[0][set] = set ? INFINITY : 0;
  for (int n = 1; n <= MOST; n++)
    for (int set = 0; set < SETS; set++) {
      of[n][set] = INFINITY;
      for (int own = set;; own = (own - 1) & set) {
        of[n][set] = fmin(of[n][set], of[n - 1][set & ~own] + shortest[own]);
        if (own == 0) break;
      }
    }
  for (int n = 0; n <= MOST; n++)
    least[n] = of[n][(1 << f->n_edges) - 1];
}

/* The fewest cords within the pull; more than MOST: so few are not enough. */
static int fewest_possible(const instance *x, const thr_request *o)
{
  double least[MOST + 1];
  int n = 1;
  least_lengths(&x->frame, o, least);
  while (n <= MOST && isinf(least[n]))
    n++;
  return n;
}

/* Is there an edge over which no cord keeps to the pull, however many there are? */
static bool is_hopeless(const instance *x)
{
  static double shortest[SETS];
  bool none = false;
  shortest_cords(&x->frame, &x->o, shortest);
  for (int e = 0; e < x->frame.n_edges; e++)
    none |= isinf(shortest[1 << e]);
  return none;
}

/* The least length of the plan's cords, or fewer, within the pull. */
static double least_length(const thr_plan *p)
{
  double least[MOST + 1], most = INFINITY;
  least_lengths(&p->frame, &p->options, least);
  for (int n = p->options.cords_least; n <= p->options.cords && n <= MOST; n++)
    most = fmin(most, least[n]);
  return most;
}

/* ---- instances ---- */

/* false: too large to try. */
static bool instance_make(rng *r, instance *x)
{
  static const char *const aims[] = {"length", "turning", "max-turning", "longest,length",
                                     "turning:sine"};
  *x = (instance){.frame = random_frame(r, rng_between(r, 2, 5), rng_below(r, 3), LENGTHS_EUCLID)};
  bool small = x->frame.n_edges <= TRUTH_TABLE_EDGES;
  static const thr_ends ends[] = {THR_ENDS_ANY, THR_ENDS_NODES, THR_ENDS_CLOSED};
  x->o = options_for(ends[rng_below(r, 3)], 1);
  want(&x->o, aims[rng_below(r, 5)]);
  x->o.cords = MOST;
  x->o.max_pull = 1 + 3 * rng_unit(r) * rng_unit(r);
  for (int v = 0; v < x->frame.n_nodes; v++)
    x->end_node[v] = v == 0 || rng_below(r, 2);
  if (x->o.ends == THR_ENDS_NODES) x->o.end_node = x->end_node;
  return small;
}

/* The larger part of the turning, by trying every turn for the one that neither end slides over. */
static double pull_of(const thr_frame *f, const thr_cord *cord, double mu)
{
  double least = cord->n_passes > 1 ? INFINITY : 1;
  for (int free = 0; free + 1 < cord->n_passes; free++) {
    double pull[2] = {1, 1};
    for (int k = 0; k + 1 < cord->n_passes; k++)
      if (k != free)
        pull[k > free] *= exp(mu * thr_turn_angle(f, cord->half[k], cord->half[k + 1]));
    least = fmin(least, fmax(pull[0], pull[1]));
  }
  return least;
}

/* The smaller pull of the cord that needs the largest, by trying every turn. */
static double other_pull(const thr_plan *p, double mu)
{
  double most = 0, other = 1;
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *cord = &p->cord[i];
    const double larger = pull_of(&p->frame, cord, mu);
    if (larger <= most * (1 + 1e-12)) continue;
    most = larger;
    other = cord->n_passes > 1 ? INFINITY : 1;
    for (int free = 0; free + 1 < cord->n_passes; free++) {
      double pull[2] = {1, 1};
      for (int k = 0; k + 1 < cord->n_passes; k++)
        if (k != free)
          pull[k > free] *= exp(mu * thr_turn_angle(&p->frame, cord->half[k], cord->half[k + 1]));
      if (fmax(pull[0], pull[1]) <= larger * (1 + 1e-12))
        other = fmin(other, fmin(pull[0], pull[1]));
    }
  }
  return other;
}

START_TEST(plans_keep_to_the_pull_and_claim_what_is_true)
{
  rng r = rng_make((uint64_t)_i + 1);
  instance x;
  thr_plan p;
  thr_err err = {0};
  if (instance_make(&r, &x)) {
    const int fewest = fewest_possible(&x, &x.o);
    thr_status st = thr_plan_make(&x.frame, &x.o, &(thr_limits){0}, &p, NULL, &err);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
    ck_assert(st != THR_EINFEASIBLE || fewest > MOST);
    ck_assert(st == THR_EINFEASIBLE || !is_hopeless(&x));
    ck_assert(st != THR_OK || p.n_cords > 0);
    if (p.n_cords > 0) {
      assert_plan_sound(&p);
      ck_assert_int_le(p.pull_claim.fewest, p.n_cords);
      ck_assert_int_le(p.pull_claim.fewest, fewest);
      ck_assert_int_ge(p.n_cords, fewest);
      if (p.proof.present) ck_assert_double_le(p.proof.lower_bound, least_length(&p) * (1 + 1e-8));
      ck_assert(!p.pull_claim.optimal || p.pull_claim.fewest == p.n_cords);
      for (int i = 0; i < p.n_cords; i++) {
        double pull = pull_of(&x.frame, &p.cord[i], x.o.physics.mu);
        ck_assert_double_le(pull, x.o.max_pull * (1 + 1e-8));
        ck_assert_double_eq_tol(exp(x.o.physics.mu * thr_cord_pulled_turning(&x.frame, &p.cord[i])),
                                pull, 1e-9 * pull);
      }
    }
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&x.frame);
}
END_TEST

/* ---- the least pull ---- */

/* An instance whose largest pull is to be least, of some number of cords. */
static bool instance_least(rng *r, instance *x)
{
  const bool small = instance_make(r, x);
  want(&x->o, "pull");
  x->o.max_pull = 0;
  x->o.cords = x->o.cords_least = rng_between(r, 1, 4);
  return small;
}

/* Are there so many cords of which none has more turning on a side of its cut turn? */
static bool is_possible(const instance *x, double turning)
{
  thr_request o = x->o;
  o.max_pull = exp(fmax(0, turning) * o.physics.mu);
  return fewest_possible(x, &o) <= x->o.cords;
}

/* What is proved of the largest pull holds for all cords that turn back anywhere, and the plan is
 * one of them. */
START_TEST(the_least_pull_is_bounded)
{
  rng r = rng_make((uint64_t)_i + 9000);
  instance x;
  thr_plan p;
  thr_err err = {0};
  if (instance_least(&r, &x)) {
    thr_status st = thr_plan_make(&x.frame, &x.o, &(thr_limits){.usual = true}, &p, NULL, &err);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
    if (p.n_cords > 0 && p.turning.present) {
      const double bound = p.turning.largest_bound, found = p.turning.largest;
      double largest = 1;
      assert_plan_sound(&p);
      for (int i = 0; i < p.n_cords; i++)
        largest = fmax(largest, pull_of(&x.frame, &p.cord[i], x.o.physics.mu));
      ck_assert_double_eq_tol(largest, exp(x.o.physics.mu * found), 1e-9 * largest);
      double other = 0;
      ck_assert_double_eq_tol(thr_cords_pulled_turnings(&x.frame, p.cord, p.n_cords, &other), found,
                              1e-9 * (1 + found));
      ck_assert_double_eq_tol(exp(x.o.physics.mu * other), other_pull(&p, x.o.physics.mu),
                              1e-9 * largest);
      ck_assert_double_le(bound, found + 1e-9);
      ck_assert(is_possible(&x, found));
      ck_assert(bound <= 1e-6 || !is_possible(&x, bound * (1 - 1e-7) - 1e-7));
      ck_assert(!p.turning.largest_optimal || fabs(bound - found) <= 1e-9 * (1 + found));
      ck_assert(st != THR_OK || p.turning.largest_optimal || bound > 0 || found > 0);

      /* Of few edges all is known but for how near the bisection comes. */
      const double near = found * 1e-3 + 1e-3;
      ck_assert(p.turning.largest_optimal || is_possible(&x, bound + near));
    }
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&x.frame);
}
END_TEST

/* ---- forged claims ---- */

/* A price, the unit, the number of units or of bits. */
static void forge_walks(rng *r, const thr_plan *p, thr_walk_proof *walks)
{
  if (!walks->unit) return;
  int64_t *price = rng_below(r, 2) ? &walks->edge[rng_below(r, p->frame.n_edges)]
                                   : &walks->node[rng_below(r, p->frame.n_nodes)];
  switch (rng_below(r, 5)) {
  case 0: *price += *price / 8 * rng_between(r, -4, 4); break;
  case 1: *price = rng_below(r, 2) ? 0 : *price + (INT64_C(1) << rng_below(r, 40)); break;
  case 2: walks->unit += walks->unit / 16 * rng_between(r, -8, 8); break;
  case 3: walks->units += rng_between(r, -3, 1); break;
  default: walks->bits += rng_between(r, -1, 1);
  }
}

/* A bound that is higher, with the gap that goes with it. */
static void forge_length(rng *r, thr_plan *p)
{
  p->proof.lower_bound += rng_unit(r) * (p->metrics.length - p->proof.lower_bound);
  p->proof.gap = (p->metrics.length - p->proof.lower_bound) / p->metrics.length;
}

static void save(const thr_walk_proof *walks, const thr_frame *f, int64_t *price)
{
  for (int e = 0; e < f->n_edges && walks->unit; e++)
    price[e] = walks->edge[e];
  for (int v = 0; v < f->n_nodes && walks->unit; v++)
    price[EDGES + v] = walks->node[v];
}

static void restore(thr_walk_proof *walks, const thr_walk_proof *from, const thr_frame *f,
                    const int64_t *price)
{
  if (from->unit) *walks = *from;
  for (int e = 0; e < f->n_edges && from->unit; e++)
    walks->edge[e] = price[e];
  for (int v = 0; v < f->n_nodes && from->unit; v++)
    walks->node[v] = price[EDGES + v];
}

/* Changes to what a plan claims, or to what it is about: whatever the checker lets pass is true. */
START_TEST(no_forged_claim_is_verified)
{
  rng r = rng_make((uint64_t)_i + 5000);
  instance x;
  thr_plan p;
  int64_t price[2][EDGES + NODES];
  if (instance_make(&r, &x)) {
    thr_status st = thr_plan_make(&x.frame, &x.o, &(thr_limits){0}, &p, NULL, NULL);
    ck_assert(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE);
    save(&p.proof.pulled, &x.frame, price[0]);
    save(&p.pull_claim.walks, &x.frame, price[1]);
    for (int i = 0; i < 300 && p.n_cords > 0; i++) {
      thr_request asked = p.options;
      thr_pull_claim claim = p.pull_claim;
      const thr_length_proof proof = p.proof;
      p.turning.present = p.cords_claim.present = false;
      if (!proof.pulled.unit) p.proof.present = false;
      for (int k = rng_between(&r, 1, 3); k > 0; k--)
        switch (rng_below(&r, 9)) {
        case 8: p.pull_claim.cut = p.pull_claim.cut * rng_between(&r, 1, 16) / 8; break;
        case 6:
          forge_walks(&r, &p, p.pull_claim.walks.unit ? &p.pull_claim.walks : &p.proof.pulled);
          break;
        case 7: forge_length(&r, &p); break;
        case 0: p.pull_claim.fewest += rng_between(&r, -1, 2); break;
        case 1: p.pull_claim.excluded = rng_between(&r, 1, MOST); break;
        case 2:
          p.options.max_pull = fmax(1, p.options.max_pull * (1 + (rng_unit(&r) - .5) * .2));
          break;
        case 3: p.options.cords_least = rng_between(&r, 1, p.options.cords); break;
        case 4: p.pull_claim.most_passes += rng_between(&r, -4, 4); break;
        default: p.pull_claim.optimal = rng_below(&r, 2);
        }
      if (thr_check_plan(&p, NULL) == THR_OK) {
        int least = p.options.cords_least, fewest = fewest_possible(&x, &p.options);
        ck_assert_int_le(p.pull_claim.fewest, fewest > least ? fewest : least);
        ck_assert(!p.pull_claim.optimal || p.pull_claim.fewest == p.n_cords);
        if (p.proof.present)
          ck_assert_double_le(p.proof.lower_bound, least_length(&p) * (1 + 1e-8));
        for (int k = 0; k < p.n_cords; k++)
          ck_assert_double_le(pull_of(&x.frame, &p.cord[k], x.o.physics.mu),
                              p.options.max_pull * (1 + 1e-8));
      }
      p.options = asked;
      restore(&p.proof.pulled, &proof.pulled, &x.frame, price[0]);
      restore(&p.pull_claim.walks, &claim.walks, &x.frame, price[1]);
      p.proof = proof;
      p.pull_claim = claim;
    }
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&x.frame);
}
END_TEST

/* The same of the least pull. */
START_TEST(no_forged_least_pull_is_verified)
{
  rng r = rng_make((uint64_t)_i + 12000);
  instance x;
  thr_plan p;
  int64_t price[EDGES + NODES];
  if (instance_least(&r, &x)) {
    thr_status st = thr_plan_make(&x.frame, &x.o, &(thr_limits){.usual = true}, &p, NULL, NULL);
    ck_assert(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE);
    save(&p.turning.tree.walks, &x.frame, price);
    for (int i = 0; i < 100 && p.turning.present; i++) {
      const thr_turning_claim claim = p.turning;
      p.proof.present = p.cords_claim.present = false;
      p.turning.largest_bound += rng_unit(&r) * (p.turning.largest - p.turning.largest_bound);
      for (int k = rng_between(&r, 0, 2); k > 0; k--)
        switch (rng_below(&r, 3)) {
        case 0: p.turning.cut = (int64_t)ldexp(rng_unit(&r) * 3, THR_TURNING_BITS); break;
        case 1: forge_walks(&r, &p, &p.turning.tree.walks); break;
        default: p.turning.largest_optimal = rng_below(&r, 2);
        }
      const double bound = p.turning.largest_bound;
      if (thr_check_plan(&p, NULL) == THR_OK)
        ck_assert(bound <= 1e-6 || !is_possible(&x, bound * (1 - 1e-7) - 1e-7));
      restore(&p.turning.tree.walks, &claim.tree.walks, &x.frame, price);
      p.turning = claim;
    }
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&x.frame);
}
END_TEST

/* ---- several components ---- */

/* Two instances of one request as a framework of two components, some of whose nodes may have ends.
 */
static bool instances_make(rng *r, instance both[2], thr_frame *frame, bool *end_node,
                           thr_request *o)
{
  const bool small[2] = {instance_make(r, &both[0]), instance_make(r, &both[1])};
  *frame = side_by_side(&both[0].frame, &both[1].frame);
  *o = both[0].o;
  for (int i = 0, v = 0; i < 2; i++)
    for (int k = 0; k < both[i].frame.n_nodes; k++)
      end_node[v++] = both[i].end_node[k];
  if (o->ends == THR_ENDS_NODES) o->end_node = end_node;
  return small[0] && small[1];
}

/* The fewest cords of both, each as many as it takes; more than so many: there are none. */
static int fewest_of_both(instance both[2], const thr_request *o)
{
  int sum = 0;
  for (int i = 0; i < 2; i++) {
    thr_request own = *o;
    if (o->end_node) own.end_node = both[i].end_node;
    const int fewest = fewest_possible(&both[i], &own);
    sum += fewest > o->cords_least ? fewest : o->cords_least;
  }
  return sum;
}

/* Changes to what is claimed of the components. */
static void forge_parts(rng *r, thr_pull_claim *claim)
{
  thr_pull_claim *own = &claim->part[rng_below(r, claim->n_parts)];
  switch (rng_below(r, 5)) {
  case 0: own->fewest += rng_between(r, -1, 1); break;
  case 1: own->excluded = rng_between(r, 0, MOST); break;
  case 2: own->optimal = rng_below(r, 2); break;
  case 3: claim->fewest += rng_between(r, -1, 1); break;
  default: claim->fewest++; own->fewest++;
  }
}

START_TEST(every_component_has_as_few_as_it_takes)
{
  rng r = rng_make((uint64_t)_i + 20000);
  instance both[2];
  thr_frame frame;
  thr_request o;
  thr_plan p;
  thr_err err = {0};
  bool end_node[2 * NODES];
  if (instances_make(&r, both, &frame, end_node, &o)) {
    const int fewest = fewest_of_both(both, &o);
    thr_status st = thr_plan_make(&frame, &o, &(thr_limits){0}, &p, NULL, &err);
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
    ck_assert(st != THR_EINFEASIBLE || fewest > MOST);
    if (p.n_cords > 0) {
      assert_plan_sound(&p);
      ck_assert_int_le(p.pull_claim.fewest, fewest);
      ck_assert_int_ge(p.n_cords, fewest);
      ck_assert_int_eq(p.pull_claim.n_parts, 2);
    }
    for (int i = 0; i < 40 && p.n_cords > 0; i++) {
      const thr_pull_claim kept[2] = {p.pull_claim.part[0], p.pull_claim.part[1]},
                           claim = p.pull_claim;
      p.turning.present = p.cords_claim.present = p.proof.present = false;
      for (int k = rng_between(&r, 1, 3); k > 0; k--)
        forge_parts(&r, &p.pull_claim);
      if (thr_check_plan(&p, NULL) == THR_OK) {
        ck_assert_int_le(p.pull_claim.fewest, fewest);
        ck_assert(!p.pull_claim.optimal || p.pull_claim.fewest == p.n_cords);
      }
      p.pull_claim = claim;
      p.pull_claim.part[0] = kept[0];
      p.pull_claim.part[1] = kept[1];
    }
    thr_plan_destroy(&p);
  }
  for (int i = 0; i < 2; i++)
    thr_frame_destroy(&both[i].frame);
  thr_frame_destroy(&frame);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("pull limit");
  ADD_EXAMPLES(s, 40, every_component_has_as_few_as_it_takes, 30);
  ADD_EXAMPLES(s, 60, plans_keep_to_the_pull_and_claim_what_is_true, 300);
  ADD_EXAMPLES(s, 60, the_least_pull_is_bounded, 300);
  ADD_EXAMPLES(s, 40, no_forged_claim_is_verified, 150);
  ADD_EXAMPLES(s, 40, no_forged_least_pull_is_verified, 100);
  return run_suite(s);
}
