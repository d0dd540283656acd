/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Holding pull: least pull at which the closed structure of rigid beads has any equilibrium while
 * the cords are being drawn in: their tension falls from the pulled ends inwards. A cord that was
 * pulled and let go keeps tension inside, since friction acts against either direction, and may
 * hold at a hundredth of it. Rigid-block limit analysis (R. K. Livesley, "Limit analysis of
 * structures formed from rigid blocks", 1978) as a linear programme.
 *
 * Minimize the pull P with: contact forces of every bead + P x wrenches of its cords + weight = 0,
 * contact forces within their (linearized) friction cones. Its dual is a mechanism, and the power
 * of that is the proved bound.
 *
 * Example: a bead of 1 N held by friction 0.5 between two faces needs a pressure of 1 N on each: 2
 * x 0.5 x 1 = 1.
 *
 * The least pull by the programme of eval/structure/blocks.h. What the solver says is not believed:
 * its dual values are made an exactly feasible mechanism (mechanism.c), whose power balance is the
 * bound.
 *
 * Beyond 1,000 beads contact forces are within the cones themselves: one programme then tells both
 * bounds, sooner than two with pyramids, which are the rest's, and what is left where that one
 * fails.
 *
 * Tensions may span more powers of ten than a double has digits. Two things are true whatever they
 * span, and keep the numbers tame: equilibrium with some tensions taken smaller is equilibrium (the
 * cords press a face together with what they draw its beads together; more of both changes nothing
 * else), and a mechanism in which some beads move as one is a mechanism. */

#include "eval/structure/blocks.h"

#include "graph/disjoint.h"
#include "graph/vector.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tensions are capped at so many times the least one, until the bound closes: further apart, the
 * solver loses the small ones. */
enum { CAPS = 5 };
static const double cap[CAPS] = {1e4, 1e6, 1e8, 1e10, 1e12};
/* Factors on what the unknown is counted in: rounding may spoil a programme in one scale and not in
 * another. */
enum { UNITS = 5 };
static const double unit[UNITS] = {1, 0.1, 10, 0.01, 100};
/* A bound has closed if it is that near to a pull that holds, relative, and no contact closes
 * faster. Where none does, by rounding, the best of those that are near is taken. */
static const double CLOSE = 1e-6, NEAR = 1e-3, STILL = 1e-13;

typedef struct {
  double pull;  /* N: the programme's optimum; INFINITY if its equilibrium is none */
  double lower; /* N: proved by velocity; INFINITY if the cords do not resist it */
  double gap;   /* relative, between the two */
  double residual;
  double (*velocity)[6]; /* owned */
  double *more;          /* [n_rises] N: of knotted cords; owned */
  double resists;        /* of a stretch */
} answer;

static void answer_destroy(answer *a)
{
  free(a->velocity);
  free(a->more);
  *a = (answer){0};
}

/* N, or N m: what the unknown is counted in. */
static double unit_of(const thr_blocks *s)
{
  return s->pull * (s->stretches ? s->length : 1);
}

/* What knotted cords do in a mechanism. */
typedef struct {
  double *apart, most; /* thr_mechanism_stretching */
  thr_knotted_pass *pass;
  double (*point)[2];
  thr_scratch own; /* the arrays */
} knotted;

static thr_status knotted_make(const thr_blocks *s, const double (*velocity)[6], knotted *k,
                               thr_err *err)
{
  const size_t n = (size_t)s->b->n_rises;
  *k = (knotted){0};
  k->apart = thr_scratch_array(&k->own, n + 1, sizeof *k->apart);
  k->pass = thr_scratch_array(&k->own, n + 1, sizeof *k->pass);
  k->point = thr_scratch_array(&k->own, n + 2, sizeof *k->point);
  const thr_status st = thr_scratch_check(&k->own, err);
  if (st)
    thr_scratch_free(&k->own);
  else
    k->most = thr_mechanism_stretching(s, velocity, k->apart);
  return st;
}

/* The stretch below which cords cannot resist the power `missing`: any price of a newton metre
 * tells one, and the best price is found by golden sections, as the bound has a single maximum over
 * its logarithm. At most `enough`, which bounds how far cords tighten: somewhat more than what the
 * programme finds, whose polygons round the bores are a little wide. *resists: that price.
 */
static double least_stretch(const thr_blocks *s, const knotted *k, double missing, double enough,
                            double *resists)
{
  enum { SECTIONS = 60 };
  const double part = 0.6180339887498949;
  double best = missing / k->most, low = -12, high = 0;
  *resists = k->most;
  for (int i = 0; i < SECTIONS && isfinite(enough); i++) {
    double found[2];
    for (int j = 0; j < 2; j++) {
      const double price =
          k->most * exp(j ? low + part * (high - low) : high - part * (high - low));
      found[j] =
          (missing - thr_mechanism_tightening(s->b, k->apart, price, enough, k->pass, k->point)) /
          price;
      if (found[j] > best) best = found[j], *resists = price;
    }
    if (found[0] > found[1])
      high = low + part * (high - low);
    else
      low = high - part * (high - low);
  }
  return fmin(best, enough);
}

/* Weak duality, in our own sums: the pull at which the cords' resistance makes up for the weights,
 * and for the load; or the load at which both make up for the cords. */
static thr_status certify(const thr_blocks *s, answer *a, thr_err *err)
{
  const double(*velocity)[6] = (const double(*)[6])a->velocity;
  thr_powers p = thr_mechanism_balance(s, velocity);
  const double given = p.falling + p.load;
  knotted k;
  const thr_status st = knotted_make(s, velocity, &k, err);
  if (st) return st;
  if (s->carries && thr_blocks_tightens(s))
    p.resistance += thr_mechanism_tightening(s->b, k.apart, 0, INFINITY, k.pass, k.point);
  a->residual = fmax(0, -thr_mechanism_opening(s, velocity));
  bool falls = given > THR_MECHANISM_DRIVE *
                           (p.all + p.all_loads); /* less is rounding: it stands by itself */
  a->lower = !falls ? 0 : p.resistance > 0 ? given / p.resistance : INFINITY;
  if (s->carries)
    a->lower = p.load > THR_MECHANISM_DRIVE * p.all_loads
                   ? fmax(0, (p.resistance - p.falling) / p.load)
                   : INFINITY;
  if (s->stretches) {
    const double missing = p.falling - p.resistance;
    falls = falls && missing > THR_MECHANISM_DRIVE * p.all;
    a->lower = !falls       ? 0
               : k.most > 0 ? least_stretch(s, &k, missing, 1.2 * a->pull, &a->resists)
                            : INFINITY;
  }
  double apart = s->carries
                     ? a->lower - a->pull
                     : a->pull - a->lower; /* polygons round a disc make it less than nothing */
  a->gap = isfinite(apart) ? fmax(0, apart) / (a->pull + 1e-3 * unit_of(s)) : 1;
  thr_scratch_free(&k.own);
  return THR_OK;
}

/* The least pull (if wanted) at which the solver found an equilibrium, and a mechanism with its
 * bound. */
static thr_status solve_pull(const thr_blocks *s, const thr_limits *limits, answer *a, thr_err *err)
{
  thr_blocks_solution o;
  a->velocity = thr_calloc((size_t)s->b->n_beads, sizeof *a->velocity);
  if (!a->more) a->more = thr_calloc((size_t)s->b->n_rises + 1, sizeof *a->more);
  if (!a->velocity || !a->more) return thr_nomem(err);
  if (s->n_rows == 0) return certify(s, a, err); /* all is held */
  thr_status st = thr_blocks_solve(s, false, limits, &o, err);
  if (!st) st = thr_mechanism_make(s, o.dual, limits, a->velocity, err);
  if (!st) {
    const double balanced =
        s->bound && s->n_bodies > THR_BLOCKS_LARGE ? 10 * THR_BLOCKS_UNMET : 1e-5;
    if (!s->merged)
      a->pull = o.imbalance < balanced
                    ? fmax(0, s->carries ? -o.objective : o.objective) * unit_of(s)
                    : INFINITY;
    if (a->pull < 1e-9 * unit_of(s)) a->pull = 0;
    const int unknown = (s->n_contacts + s->n_plays) * (s->round ? 3 : s->b->rays) + s->n_copies;
    const int columns = thr_blocks_columns_of_a_rise(s);
    for (int i = 0; i < s->n_rises; i++)
      a->more[i] = fmax(0, o.x[unknown + i * columns]) * (s->carries ? s->weight : s->pull);
    st = certify(s, a, err);
  }
  thr_blocks_solution_destroy(&o);
  if (st) answer_destroy(a);
  return st;
}

/* What all programmes of one structure have in common. */
typedef struct {
  const thr_beads *b;
  const thr_frame *f;
  const thr_physics *physics;
  const double *press;
  const double (*load)[3];
  bool carries, stretches;
  bool round;  /* cones of friction, not pyramids: one programme tells both bounds */
  double unit; /* factor on what the unknown is counted in */
  const thr_limits *limits;
  double least, largest; /* press of any face that is pressed */
  thr_warm warm; /* where the programme of a large structure may start: near the optimum of one that
                    differs little .. */
  double span;   /* .. its tensions, too */
  bool wants_way; /* keep the mechanism by which no pull holds it, as `way`, which whoever wants it
                     owns */
  double (*way)[6];
  int *weld[2]; /* [n_beads] what held feet wedge, with cones' pyramids inside them, and round them
                   (welds.c); owned */
} task;

static void task_destroy(task *t)
{
  thr_warm_destroy(&t->warm);
  free(t->weld[0]);
  free(t->weld[1]);
  t->weld[0] = t->weld[1] = NULL;
}

/* outside: all that may be, for what is proved. */
static thr_blocks part(const task *t, double most, bool merged, bool outside)
{
  return (thr_blocks){.b = t->b,
                      .f = t->f,
                      .physics = t->physics,
                      .press = t->press,
                      .load = t->load,
                      .carries = t->carries,
                      .stretches = t->stretches,
                      .most = most,
                      .merged = merged,
                      .outside = outside,
                      .weld = t->weld[outside && !t->round],
                      .round = t->round};
}

static thr_status find_welds(task *t, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < 2 && !st; i++) {
    const double widen = i ? thr_blocks_widening(t->b) : 1;
    const thr_blocks s = part(t, INFINITY, false, i == 1);
    int *weld = thr_calloc((size_t)t->b->n_beads, sizeof *weld);
    st = weld ? thr_welds_find(&s, widen, t->limits, weld, err) : thr_nomem(err);
    t->weld[i] = weld;
  }

  /* However tight knotted cords get: their faces do not open. */
  for (int i = 0; i < t->b->n_rises && t->carries && !(t->b->strength > 0) && !st; i++)
    thr_disjoint_join(t->weld[1], t->f->edge[t->b->rise[i].face][0],
                      t->f->edge[t->b->rise[i].face][1]);
  return st;
}

/* A start from a programme whose tensions were capped alike; else a fresh one, as others would
 * mislead. */
static thr_warm *warm_at(task *t, double most, bool merged)
{
  if (merged) return NULL;
  const double span = fmin(most, t->largest) / t->least;
  if (span > 2 * t->span || t->span > 2 * span) thr_warm_destroy(&t->warm);
  t->span = span;
  return &t->warm;
}

/* One programme: replaces the mechanism in a, if there was one. Merged, its pull is about a->pull.
 */
static thr_status pull_of(task *t, double most, bool merged, bool outside, answer *a, thr_err *err)
{
  const double widen = outside && !t->round ? thr_blocks_widening(t->b) : 1;
  const double plenty =
      3000; /* weights of a bead in what draws it: ten times what a dome of 2,000 beads needs */
  thr_blocks s = part(t, most, merged, outside);
  thr_status st = thr_blocks_make(&s, widen, err);
  if (st) return st;
  s.bound = widen > 1;
  if (merged) s.pull = a->pull / (s.stretches ? s.length : 1);
  s.guess = a->pull > 0 && isfinite(a->pull) ? a->pull : plenty * s.pull;
  s.pull *= t->unit;
  s.warm = warm_at(t, most, merged);
  free(a->velocity);
  a->velocity = NULL;
  st = solve_pull(&s, t->limits, a, err);
  thr_blocks_destroy(&s);
  return st;
}

static double close_enough(const task *t)
{
  return t->b->n_beads > THR_BLOCKS_LARGE ? 2 * THR_BLOCKS_ROUGH : CLOSE;
}

/* Where nothing is proved, as no pull is needed, no mechanism has to hold: the multipliers are all
 * about 0 then. */
static bool closed(const task *t, const answer *a, double within)
{
  return a->gap < within && (a->residual < STILL || (!t->carries && a->lower == 0));
}

/* Moves a to best if it is near and its bound the better one: the higher pull, the lower load. */
static void keep_better(const task *t, answer *a, double most, answer *best, double *best_most)
{
  if (!closed(t, a, NEAR) ||
      (best->velocity && (t->carries ? a->lower >= best->lower : a->lower <= best->lower)))
    return;
  answer_destroy(best);
  *best = *a;
  *best_most = most;
  a->velocity = NULL;
  a->more = NULL;
}

/* Is this proof that no pull holds it: nothing closes, no cord is drawn out, the weights go down?
 */
static bool gives_way(const thr_blocks *s, const double (*velocity)[6])
{
  thr_powers p = thr_mechanism_balance(s, velocity);
  if (!(thr_mechanism_opening(s, velocity) >= -STILL) || !(p.falling + p.load > 1e-6 * p.most))
    return false;
  const double still = 1e-6 * (p.falling + p.load) / p.most;
  bool still_all = true;
  for (int e = 0; e < s->b->n_faces; e++)
    still_all &= !(s->press[e] > 0) || thr_mechanism_parting(s, velocity, e) <= still;
  for (int i = 0; i < s->b->n_rises; i++)
    still_all &= thr_mechanism_parting(s, velocity, s->b->rise[i].face) <= still;
  return still_all;
}

/* Is this proof that no tensions within their strength let knotted cords hold it? */
static thr_status breaks(const thr_blocks *s, const double (*velocity)[6], bool *proved,
                         thr_err *err)
{
  const thr_powers p = thr_mechanism_balance(s, velocity);
  knotted k;
  thr_status st = knotted_make(s, velocity, &k, err);
  if (st) return st;
  const double more = thr_mechanism_tightening(s->b, k.apart, 0, INFINITY, k.pass, k.point);
  *proved = thr_mechanism_opening(s, velocity) >= -STILL &&
            p.falling - p.resistance - more > THR_MECHANISM_DRIVE * p.all;
  thr_scratch_free(&k.own);
  return THR_OK;
}

/* Finds the mechanism that the programme of some blocks, which are made here, prices; no bead moves
 * where there are no rows. */
static thr_status find_mechanism(const task *t, thr_blocks *s, double (*velocity)[6], thr_err *err)
{
  thr_blocks_solution o = {0};
  thr_status st = thr_blocks_make(s, thr_blocks_widening(t->b), err);
  if (!st && s->n_rows > 0) st = thr_blocks_solve(s, true, t->limits, &o, err);
  if (!st && s->n_rows > 0) st = thr_mechanism_make(s, o.dual, t->limits, velocity, err);
  thr_blocks_solution_destroy(&o);
  return st;
}

/* Keeps the movement as the one that the task is to show. */
static void take_way(task *t, double (**velocity)[6])
{
  free(t->way);
  t->way = *velocity;
  *velocity = NULL;
}

/* THR_EINFEASIBLE with t->way as the proof if knotted cords cannot hold the structure within their
 * strength: hands have to help.
 */
static thr_status check_strength(task *t, thr_err *err)
{
  thr_blocks s = part(t, INFINITY, false, true);
  double(*velocity)[6] = thr_calloc((size_t)t->b->n_beads, sizeof *velocity);
  bool proved = false;
  if (!velocity) return thr_nomem(err);
  thr_status st = find_mechanism(t, &s, velocity, err);
  if (!st) st = breaks(&s, (const double(*)[6])velocity, &proved, err);
  if (proved) {
    st = thr_fail(err, THR_EINFEASIBLE, "knotted cords break before they hold the structure");
    take_way(t, &velocity);
  }
  thr_blocks_destroy(&s);
  free(velocity);
  return st;
}

/* THR_EINFEASIBLE with a proof that no pull holds the structure. However little the cords press a
 * face with friction, a large pull makes its beads one: what then gives way, without cords, gives
 * way at any pull, and nothing else does. */
static thr_status check_feasible(task *t, thr_err *err)
{
  bool friction = t->physics->mu_bead > 0;
  thr_blocks s = part(t, friction ? 0 : INFINITY, friction, true);
  s.round = false;
  double(*velocity)[6] = thr_calloc((size_t)t->b->n_beads, sizeof *velocity);
  if (!velocity) return thr_nomem(err);
  thr_status st = find_mechanism(t, &s, velocity, err);
  if (!st && gives_way(&s, (const double(*)[6])velocity)) {
    int v = thr_mechanism_fastest(t->b, (const double(*)[6])velocity);
    st = thr_fail(err, THR_EINFEASIBLE,
                  "no pull holds the structure: the bead at node %s gives way however hard the "
                  "cords are pulled; more friction "
                  "(mu_bead, mu_ground), other feet or a cord that presses this bead against its "
                  "neighbours may help",
                  v < 0 ? "?" : t->f->name[v]);
    if (t->wants_way) take_way(t, &velocity);
  }
  thr_blocks_destroy(&s);
  free(velocity);
  return st;
}

/* At one cap; merged too if the bound does not close otherwise. */
static thr_status lower_at(task *t, double most, answer *a, answer *best, double *best_most,
                           thr_err *err)
{
  thr_status st = pull_of(t, most, false, true, a, err);
  if (st || closed(t, a, close_enough(t))) return st;
  keep_better(t, a, most, best, best_most);
  if (t->largest <= most || !(a->pull > 0) || !isfinite(a->pull)) return THR_OK;
  st = pull_of(t, most, true, true, a, err);
  if (!st && !closed(t, a, close_enough(t))) keep_better(t, a, most, best, best_most);
  return st;
}

/* With the first cap on the tensions at which the bound closes. *most: that cap. */
static thr_status lower_pull_in(task *t, double *most, answer *a, thr_err *err)
{
  answer best = {0};
  double best_most = 0;
  thr_status st = THR_OK;
  for (int i = 0; i < CAPS; i++) {
    *most = t->least * cap[i];
    st = lower_at(t, *most, a, &best, &best_most, err);
    if (st || (a->velocity && closed(t, a, close_enough(t)))) goto done;
    if (i == 0 && !best.velocity && !t->carries && (st = check_feasible(t, err))) goto done;
    if (i == 0 && !best.velocity && t->stretches && t->b->strength > 0 &&
        (st = check_strength(t, err)))
      goto done;
    if (t->largest <= *most || (t->round && !isfinite(a->pull)))
      break; /* a greater span is no easier for cones */
  }
  if (best.velocity) {
    answer_destroy(a);
    *a = best;
    *most = best_most;
    return THR_OK;
  }
  const double span = t->least > 0 ? t->largest / t->least : 1;
  st = span > 1 / CLOSE ? thr_fail(err, THR_ESOLVER,
                                   "the holding pull is not decided: the solver's numbers do not "
                                   "suffice (tensions along the cords "
                                   "span a factor of %.0e); a smaller --mu or more cords, each "
                                   "with less turning, may help",
                                   span)
                        : thr_fail(err, THR_ESOLVER,
                                   "the holding pull is not decided: the solver's numbers do not "
                                   "suffice; other --tune rays may help");
done:
  answer_destroy(&best);
  return st;
}

/* Beyond a thousand beads a third try takes too long. */
static thr_status lower_pull(task *t, double *most, answer *a, thr_err *err)
{
  const int tries = t->b->n_beads > THR_BLOCKS_LARGE ? 2 : UNITS;
  thr_err why = {0};
  thr_status st = THR_ESOLVER;
  for (int i = 0; i < tries && st == THR_ESOLVER; i++) {
    answer_destroy(a);
    t->unit = unit[i];
    st = lower_pull_in(t, most, a, &why);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

void thr_holding_press(const thr_cord *cord, int n_cords, const double *const *tension,
                       double *press)
{
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      press[cord[i].half[k] >> 1] += tension[i][k];
}

/* The pull at which there is an equilibrium within pyramids inside the cones: of the rays that are
 * asked for, then of as many as there may be. */
static thr_status upper_pull(task *t, double most, answer *a, thr_err *err)
{
  const thr_beads *usual = t->b;
  thr_beads finer = *usual;
  finer.rays = THR_MOST_RAYS;
  thr_status st = THR_OK;
  for (int i = 0; i < 2 * UNITS && !st && !(i > 0 && isfinite(a->pull)); i++) {
    if (i == UNITS && (usual->rays == THR_MOST_RAYS || usual->n_beads > THR_BLOCKS_LARGE)) break;
    t->b = i < UNITS ? usual : &finer;
    t->unit = unit[i % UNITS];
    a->pull = 0;
    st = pull_of(t, most, false, false, a, err);
  }
  t->b = usual;
  return st;
}

/* upper: at which there is an equilibrium within the cones. Where a programme with cones is not
 * decided, one with pyramids inside them tells it, if it is wanted. */
static thr_status bounds(task *t, bool want_upper, answer *a, double *upper, double *more,
                         thr_err *err)
{
  answer inside_cones = {0};
  double most;
  *upper = 0;
  if (t->round) {
    thr_status st = lower_pull_in(t, &most, a, err);
    if (!st && want_upper) st = pull_of(t, most, false, false, &inside_cones, err);
    *upper = inside_cones.pull;
    answer_destroy(&inside_cones);
    if (st != THR_ESOLVER) return st;
    answer_destroy(a);
    t->round = false;
  }
  thr_status st = lower_pull(t, &most, a, err);
  if (!st && want_upper) st = upper_pull(t, most, &inside_cones, err);
  *upper = inside_cones.pull;
  if (more && inside_cones.more)
    memcpy(more, inside_cones.more, (size_t)t->b->n_rises * sizeof *more);
  answer_destroy(&inside_cones);
  return st;
}

/* more[n_rises] receives what a stretch adds; NULL ok. */
static thr_status hold(task *t, bool want_upper, thr_holding *holding, double *more, thr_err *err)
{
  answer a = {0};
  double upper = 0;
  thr_status st = find_welds(t, err);
  if (!st) st = bounds(t, want_upper, &a, &upper, more, err);
  if (!st) {
    assert(a.velocity);
    holding->present = true;
    holding->lower = a.lower;
    holding->upper = upper;
    holding->residual = a.residual;
    holding->first_bead = a.lower > 0 || t->carries
                              ? thr_mechanism_fastest(t->b, (const double(*)[6])a.velocity)
                              : -1;
    holding->velocity = a.velocity;
    holding->resists = a.resists;
    a.velocity = NULL;
  }
  answer_destroy(&a);
  task_destroy(t);
  return st;
}

static task task_of(const thr_beads *beads, const thr_frame *frame, const thr_physics *physics,
                    const double *press, const thr_limits *limits)
{
  task t = {.b = beads,
            .f = frame,
            .physics = physics,
            .press = press,
            .limits = limits,
            .least = INFINITY,
            .unit = 1};
  t.round = beads->n_beads > THR_BLOCKS_LARGE && beads->rays == THR_USUAL_RAYS;
  for (int e = 0; e < beads->n_faces; e++) {
    if (press[e] > 0) t.least = fmin(t.least, press[e]);
    t.largest = fmax(t.largest, press[e]);
  }
  return t;
}

thr_status thr_holding_pull(const thr_beads *beads, const thr_frame *frame,
                            const thr_physics *physics, const double *press, bool want_upper,
                            const thr_limits *limits, thr_holding *out, thr_err *err)
{
  task t = task_of(beads, frame, physics, press, limits);
  t.load = (const double(*)[3])beads->load;
  *out = (thr_holding){0};
  return hold(&t, want_upper, out, NULL, err);
}

/* A mechanism in which the structure gives way under some multiple of the load, with the cords as
 * they are: it does under all multiples for which excess + multiple x load is more than 0. */
typedef struct {
  double (*velocity)[6]; /* owned */
  double excess, load;   /* W: of the weights less what the cords resist; of the load once */
} yielding;

static void weigh_powers(const thr_blocks *s, yielding *y)
{
  const thr_powers p = thr_mechanism_balance(s, (const double(*)[6])y->velocity);
  y->excess = p.falling - p.resistance;
  y->load = p.load;
}

/* Finds one at a multiple of the load. THR_ESOLVER if there is none, or none was found. */
static thr_status yield_at(const thr_blocks *s, double multiple, const thr_limits *limits,
                           yielding *out, thr_err *err)
{
  const size_t n = (size_t)s->b->n_beads;
  thr_holding found = {0};
  double(*load)[3] = thr_calloc(n, sizeof *load);
  if (!load) return thr_nomem(err);
  for (size_t v = 0; v < n; v++)
    for (int k = 0; k < 3; k++)
      load[v][k] = multiple * s->load[v][k];
  task t = task_of(s->b, s->f, s->physics, s->press, limits);
  t.load = (const double(*)[3])load;
  t.wants_way = true;
  thr_status st = hold(&t, false, &found, NULL, err);
  free(load);
  if (st == THR_EINFEASIBLE || (!st && found.lower > 1)) {
    out->velocity = st ? t.way : found.velocity;
    weigh_powers(s, out);
    return THR_OK;
  }
  free(t.way);
  thr_holding_destroy(&found);
  return st == THR_ENOMEM || st == THR_ELIMIT ? st : THR_ESOLVER;
}

/* Adds a part of `high`, which the load drives, to `low`: as mechanisms form a cone, and what the
 * cords resist is convex, the sum is a mechanism whose excess is at least the sum of both. */
static void combine(const thr_blocks *s, yielding *low, const yielding *high, double part)
{
  double fastest = 0;
  for (int v = 0; v < s->b->n_beads; v++) {
    for (int k = 0; k < 6; k++)
      low->velocity[v][k] += part * high->velocity[v][k];
    fastest = fmax(fastest, sqrt(thr_dot(low->velocity[v], low->velocity[v])));
  }
  for (int v = 0; v < s->b->n_beads && fastest > 0; v++)
    for (int k = 0; k < 6; k++)
      low->velocity[v][k] /= fastest;
  weigh_powers(s, low);
}

/* Where no multiple of the load has an equilibrium the programme for the largest one has no
 * solution. Decides that case by mechanisms: one that gives way without the load and that the load
 * holds back excludes the multiples up to some `enough`; the one at `enough` excludes more of them,
 * or all that are larger, and then both together exclude all. *st stays where that does not tell
 * it. */
static thr_status carry_nothing(const thr_beads *beads, const thr_frame *frame,
                                const thr_physics *physics, const double *press,
                                const double (*load)[3], const thr_limits *limits, thr_carry *carry,
                                thr_err *err)
{
  enum { TRIES = 12 };
  task t = task_of(beads, frame, physics, press, limits);
  thr_blocks s = part(&t, INFINITY, false, true);
  s.load = load;
  s.carries = true;
  thr_err why = {0};
  yielding low = {0}, high = {0};
  thr_status st = thr_blocks_make(&s, 1, err);
  if (st) return st;
  st = yield_at(&s, 0, limits, &low, &why);

  /* A load that hardly acts on what gives way, by rounding or by symmetry: some of what it does
   * move where it is large. */
  const thr_powers at_rest =
      st ? (thr_powers){0} : thr_mechanism_balance(&s, (const double(*)[6])low.velocity);
  if (!st && fabs(low.load) < 1e-6 * at_rest.all_loads) {
    st = yield_at(&s, 100 * at_rest.all / at_rest.all_loads, limits, &high, &why);
    if (!st && high.load > 0)
      combine(&s, &low, &high, high.excess < 0 ? 0.5 * low.excess / -high.excess : 1);
    free(high.velocity);
    high.velocity = NULL;
  }

  for (int i = 0; i < TRIES && !st && low.load < 0; i++) {
    const double enough = low.excess / -low.load;
    st = yield_at(&s, enough * (1 + 1e-6), limits, &high, &why);
    if (!st && high.load > 0) combine(&s, &low, &high, 1.02 * -low.load / high.load);
    if (!st && high.load <= 0) {
      free(low.velocity);
      low = high;
      high.velocity = NULL;
    }
    free(high.velocity);
    high.velocity = NULL;
  }

  /* What is kept is judged as every other bound is. */
  answer a = {.velocity = low.velocity, .lower = INFINITY};
  if (!st) st = certify(&s, &a, &why);
  if (!st && a.lower == 0 && a.residual < STILL) {
    *carry =
        (thr_carry){.first_bead = thr_mechanism_fastest(beads, (const double(*)[6])low.velocity),
                    .velocity = low.velocity};
  } else {
    free(low.velocity);
    if (!st) st = THR_ESOLVER;
  }
  thr_blocks_destroy(&s);
  return st == THR_ESOLVER || !st ? st : thr_fail(err, st, "%s", why.text);
}

thr_status thr_holding_carry(const thr_beads *beads, const thr_frame *frame,
                             const thr_physics *physics, const double *press,
                             const double (*load)[3], bool want_carried, const thr_limits *limits,
                             thr_carry *out, thr_err *err)
{
  thr_holding found = {0};
  task t = task_of(beads, frame, physics, press, limits);
  t.load = load;
  t.carries = true;
  t.round &= beads->n_rises == 0;
  *out = (thr_carry){0};
  thr_status st = hold(&t, want_carried, &found, NULL, err);
  if (!st)
    *out = (thr_carry){.beyond = found.lower,
                       .carried = found.upper,
                       .first_bead = found.first_bead,
                       .velocity = found.velocity};
  return st == THR_ESOLVER && beads->n_rises == 0
             ? carry_nothing(beads, frame, physics, press, load, limits, out, err)
             : st;
}

thr_status thr_holding_stretch(const thr_beads *beads, const thr_frame *frame,
                               const thr_physics *physics, const double *press,
                               const thr_limits *limits, thr_holding *out, double *more,
                               thr_err *err)
{
  task t = task_of(beads, frame, physics, press, limits);
  t.stretches = true;
  t.round = false;
  t.wants_way = true;
  *out = (thr_holding){0};
  thr_status st = hold(&t, true, out, more, err);
  if (st == THR_EINFEASIBLE && t.way &&
      beads->strength > 0) { /* does it prove as much of the strength? */
    thr_blocks s = part(&t, INFINITY, false, true);
    bool proved = false;
    thr_err why = {0};
    thr_status again = thr_blocks_make(&s, thr_blocks_widening(beads), &why);
    if (!again) again = breaks(&s, (const double(*)[6])t.way, &proved, &why);
    thr_blocks_destroy(&s);
    if (again) st = thr_fail(err, again, "%s", why.text);
    if (proved) out->velocity = t.way, t.way = NULL;
  }
  free(t.way);
  return st;
}

void thr_carry_destroy(thr_carry *carry)
{
  free(carry->velocity);
  *carry = (thr_carry){.first_bead = -1};
}

void thr_holding_destroy(thr_holding *holding)
{
  if (!holding) return;
  free(holding->velocity);
  *holding = (thr_holding){0};
}
