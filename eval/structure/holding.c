/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the holding pull: the least pull at which the closed structure of rigid beads has any
 * equilibrium while the cords are being drawn in, when tension falls from the pulled ends inwards.
 * (A cord that was pulled and let go keeps tension inside, since friction acts against either
 * direction, and may hold at a hundredth of this pull.)
 *
 * Source: rigid-block limit analysis (R. K. Livesley, "Limit analysis of structures formed from
 * rigid blocks", 1978), as a linear programme:
 *
 *   minimize the pull P such that, for every bead,
 *     contact forces + P x wrenches of its cords at a pull of 1 + weight = 0,
 *     contact forces within their friction cones (linearized: pyramids).
 *
 * The dual of the programme is a collapse mechanism: velocities with which no contact closes. By
 * weak duality, P >= power of the weights / power that the cords resist with per newton. The solver
 * is not trusted: its multipliers are made an exactly feasible mechanism (mechanism.c), and the
 * balance of powers, computed here, is the proved bound.
 *
 * Example: a bead of 1 N held by friction 0.5 between two faces needs a pressure of 1 N on each: 2
 * x 0.5 x 1 = 1.
 *
 * Two bounds: pyramids round the cones prove the lower one, pyramids inside the cones give an
 * equilibrium, the upper one. Beyond 1,000 beads contact forces are within the cones themselves:
 * one programme then gives both bounds, sooner than two with pyramids, which serve where the one
 * with cones fails.
 *
 * Tensions may span more powers of ten than a double has digits. Two facts keep the numbers of the
 * programme near each other. (1) If an equilibrium exists with some tensions taken smaller, one
 * exists: the cords press a face together by what they draw its beads together with, and more of
 * both changes nothing else. So tensions may be capped. (2) A mechanism in which some beads move as
 * one body is a mechanism. So the beads on both sides of a face with a capped tension may be
 * merged.
 *
 * The same programme answers two more questions: by what a load may be multiplied at given tensions
 * (thr_holding_carry), and by how much knotted cords have to stretch (thr_holding_stretch). */

#include "eval/structure/blocks.h"

#include "graph/number.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Caps on the tensions, as multiples of the least one, which are tried in turn until the bound
 * closes: further apart, the solver loses the small tensions. */
enum { CAPS = 5 };
static const double cap[CAPS] = {1e4, 1e6, 1e8, 1e10, 1e12};
/* Factors on the unit of the unknown, tried in turn: rounding may spoil a programme in one scale
 * and not in another. */
enum { UNITS = 5 };
static const double unit[UNITS] = {1, 0.1, 10, 0.01, 100};
/* CLOSE: relative gap between the bound and a pull that holds at which the bound is accepted. NEAR:
 * gap at which the best bound is taken where rounding lets none close. STILL: speed at which a
 * contact of a mechanism may close, relative to the fastest bead. */
static const double CLOSE = 1e-6, NEAR = 1e-3, STILL = 1e-13;

/* Holds the optimum of one programme, and what its mechanism proves. */
typedef struct {
  double pull;  /* N: the programme's optimum; INFINITY if its equilibrium is none */
  double lower; /* N: proved by velocity; INFINITY if the cords do not resist it */
  double gap;   /* relative, between the two */
  double residual;
  double (*velocity)[6]; /* owned */
  double *more;          /* [n_rises] N: of knotted cords; owned */
  double resists;        /* of a stretch */
} programme_result;

/* Frees the arrays. */
static void result_destroy(programme_result *result)
{
  free(result->velocity);
  free(result->more);
  result->velocity = NULL;
  result->more = NULL;
}

/* Returns the unit of the unknown, N; of a stretch, N m. */
static double unit_of(const thr_blocks *blocks)
{
  return blocks->pull * (blocks->stretches ? blocks->length : 1);
}

/* Says how the passes of knotted cords stretch in a mechanism. */
typedef struct {
  double *apart, most; /* thr_mechanism_stretching */
  thr_knotted_pass *pass;
  double (*point)[2];
  thr_scratch own; /* the arrays */
} knotted_cords;

/* Computes how the passes of knotted cords stretch in a mechanism. Release with
 * thr_scratch_free(&knots->own). */
static thr_status knotted_make(const thr_blocks *blocks, const double (*velocity)[6],
                               knotted_cords *knots, thr_err *err)
{
  const size_t n = (size_t)blocks->b->n_rises;
  *knots = (knotted_cords){0};
  knots->apart = thr_scratch_array(&knots->own, n + 1, sizeof *knots->apart);
  knots->pass = thr_scratch_array(&knots->own, n + 1, sizeof *knots->pass);
  knots->point = thr_scratch_array(&knots->own, n + 2, sizeof *knots->point);

  /* The mechanism says how fast each pass parts its beads. */
  const thr_status st = thr_scratch_check(&knots->own, err);
  if (st)
    thr_scratch_free(&knots->own);
  else
    knots->most = thr_mechanism_stretching(blocks, velocity, knots->apart);

  return st;
}

/* Computes the least stretch, N m, below which knotted cords cannot resist the power `missing`, W.
 *
 * Lagrangian bound: with a price of each newton metre, the cords resist at most `tightening(price)`
 * beyond what the price takes off, so stretch >= (missing - tightening(price)) / price for any
 * price > 0. This bound has a single maximum over the logarithm of the price, which is found by
 * golden sections. The result is at most `enough`, which also limits how far cords tighten:
 * somewhat more than what the programme finds, whose polygons round the bores are a little wide.
 * *resists receives the best price, 1/m.
 */
static double least_stretch(const thr_blocks *blocks, const knotted_cords *knots, double missing,
                            double enough, double *resists)
{
  enum { SECTIONS = 60 };
  const double part = 0.6180339887498949;

  /* The highest price with any stretch at all resists with the pass that stretches fastest, alone.
   */
  double best = missing / knots->most, low = -12, high = 0;
  *resists = knots->most;

  /* Maximize over log(price) in [-12, 0], relative to this price. */
  for (int i = 0; i < SECTIONS && isfinite(enough); i++) {
    double found[2];
    for (int j = 0; j < 2; j++) {
      const double price =
          knots->most * exp(j ? low + part * (high - low) : high - part * (high - low));
      found[j] = (missing - thr_mechanism_tightening(blocks->b, knots->apart, price, enough,
                                                     knots->pass, knots->point)) /
                 price;
      if (found[j] > best) best = found[j], *resists = price;
    }

    /* Keep the part of the bracket with the larger value. */
    if (found[0] > found[1])
      high = low + part * (high - low);
    else
      low = high - part * (high - low);
  }

  /* The prices only count stretches up to `enough`. */
  return fmin(best, enough);
}

/* Certifies a mechanism by weak duality, in sums that use nothing of the solver. result->lower
 * receives the pull at which the resistance of the cords makes up for weights and load; where the
 * load is unknown, the multiple of the load at which weights and load make up for the resistance of
 * the cords; of a stretch, least_stretch. result->gap: relative distance from the programme's
 * optimum. */
static thr_status certify(const thr_blocks *blocks, programme_result *result, thr_err *err)
{
  const double(*velocity)[6] = (const double(*)[6])result->velocity;
  thr_powers powers = thr_mechanism_balance(blocks, velocity);
  const double given = powers.falling + powers.load;
  knotted_cords knots;
  const thr_status st = knotted_make(blocks, velocity, &knots, err);
  if (st) return st;

  /* At given tensions, knotted cords resist with what they can tighten by, too. */
  if (blocks->carries && thr_blocks_tightens(blocks))
    powers.resistance +=
        thr_mechanism_tightening(blocks->b, knots.apart, 0, INFINITY, knots.pass, knots.point);

  /* How fast a contact closes, which should be 0. */
  result->residual = fmax(0, -thr_mechanism_opening(blocks, velocity));

  /* The pull. If what drives the mechanism is only rounding, the structure stands by itself. */
  bool falls = given > THR_MECHANISM_DRIVE * (powers.all + powers.all_loads);
  result->lower = !falls ? 0 : powers.resistance > 0 ? given / powers.resistance : INFINITY;

  /* The multiple of the load. A mechanism that the load does not drive proves nothing. */
  if (blocks->carries)
    result->lower = powers.load > THR_MECHANISM_DRIVE * powers.all_loads
                        ? fmax(0, (powers.resistance - powers.falling) / powers.load)
                        : INFINITY;

  /* The stretch: what power is missing at the least tensions? */
  if (blocks->stretches) {
    const double missing = powers.falling - powers.resistance;
    falls = falls && missing > THR_MECHANISM_DRIVE * powers.all;
    result->lower = !falls           ? 0
                    : knots.most > 0 ? least_stretch(blocks, &knots, missing, 1.2 * result->pull,
                                                     &result->resists)
                                     : INFINITY;
  }

  /* The gap. Polygons round a disc may make the difference negative. */
  double apart = blocks->carries ? result->lower - result->pull : result->pull - result->lower;
  result->gap = isfinite(apart) ? fmax(0, apart) / (result->pull + 1e-3 * unit_of(blocks)) : 1;

  thr_scratch_free(&knots.own);
  return THR_OK;
}

/* Solves the programme of some blocks: computes the optimum at which the solver found an
 * equilibrium (unless bodies are merged, where the optimum is no equilibrium of the structure), and
 * a certified mechanism. */
static thr_status solve_pull(const thr_blocks *blocks, const thr_limits *limits,
                             programme_result *result, thr_err *err)
{
  thr_blocks_solution solution;
  result->velocity = thr_calloc((size_t)blocks->b->n_beads, sizeof *result->velocity);
  if (!result->more)
    result->more = thr_calloc((size_t)blocks->b->n_rises + 1, sizeof *result->more);
  if (!result->velocity || !result->more) return thr_nomem(err);

  /* All beads are held: there is nothing to solve. */
  if (blocks->n_rows == 0) return certify(blocks, result, err);

  /* The multipliers of the equations, as velocities. */
  thr_status st = thr_blocks_solve(blocks, false, limits, &solution, err);
  if (!st) st = thr_mechanism_make(blocks, solution.dual, limits, result->velocity, err);
  if (!st) {
    /* An optimum whose equations are not met is no equilibrium. */
    const double balanced =
        blocks->bound && blocks->n_bodies > THR_BLOCKS_LARGE ? 10 * THR_BLOCKS_UNMET : 1e-5;
    if (!blocks->merged)
      result->pull = solution.imbalance < balanced
                         ? fmax(0, blocks->carries ? -solution.objective : solution.objective) *
                               unit_of(blocks)
                         : INFINITY;
    if (result->pull < 1e-9 * unit_of(blocks)) result->pull = 0;

    /* By how much the tension of each knotted pass grew, N. */
    const int unknown =
        (blocks->n_contacts + blocks->n_plays) * (blocks->round ? 3 : blocks->b->rays) +
        blocks->n_copies;
    const int columns = thr_blocks_columns_of_a_rise(blocks);
    for (int i = 0; i < blocks->n_rises; i++)
      result->more[i] = fmax(0, solution.x[unknown + i * columns]) *
                        (blocks->carries ? blocks->weight : blocks->pull);

    /* What the solver proposed becomes a bound only here. */
    st = certify(blocks, result, err);
  }
  thr_blocks_solution_destroy(&solution);
  if (st) result_destroy(result);

  return st;
}

/* Holds what all programmes of one question to a structure have in common. */
typedef struct {
  const thr_beads *beads;
  const thr_frame *frame;
  const thr_physics *physics;
  const double *press;
  const double (*load)[3];
  bool carries, stretches;
  bool round;  /* contact forces within cones, not pyramids: one programme gives both bounds */
  double unit; /* factor on the unit of the unknown */
  const thr_limits *limits;
  double least, largest; /* press of any face that is pressed */
  thr_warm warm;  /* where the programme of a large structure may start: near the optimum of a
                     similar one .. */
  double span;    /* .. whose largest and least tension had this ratio */
  bool wants_way; /* keep the mechanism that proves that no pull holds the structure as `way`; the
                     caller owns it then */
  double (*way)[6];
  int *weld[2]; /* [n_beads] bodies that held feet wedge, with pyramids inside the cones, and round
                   them (welds.c); owned */
} limit_analysis;

/* Frees what a question owns, but for `way`. */
static void analysis_destroy(limit_analysis *analysis)
{
  thr_warm_destroy(&analysis->warm);
  free(analysis->weld[0]);
  free(analysis->weld[1]);
  analysis->weld[0] = analysis->weld[1] = NULL;
}

/* Returns the blocks of a question before they are made. Tensions are capped at `most`, and beads
 * on both sides of a capped face merged if wanted. outside: cords anywhere within their bores and
 * feet on polygons round their discs, for what is proved. */
static thr_blocks part(const limit_analysis *analysis, double most, bool merged, bool outside)
{
  return (thr_blocks){.b = analysis->beads,
                      .f = analysis->frame,
                      .physics = analysis->physics,
                      .press = analysis->press,
                      .load = analysis->load,
                      .carries = analysis->carries,
                      .stretches = analysis->stretches,
                      .most = most,
                      .merged = merged,
                      .outside = outside,
                      .weld = analysis->weld[outside && !analysis->round],
                      .round = analysis->round};
}

/* Finds the welds for both kinds of pyramids: what held feet wedge with any force moves as one
 * body. */
static thr_status find_welds(limit_analysis *analysis, thr_err *err)
{
  /* First inside the cones, then round them. */
  thr_status st = THR_OK;
  for (int i = 0; i < 2 && !st; i++) {
    const double widen = i ? thr_blocks_widening(analysis->beads) : 1;
    const thr_blocks blocks = part(analysis, INFINITY, false, i == 1);
    int *weld = thr_calloc((size_t)analysis->beads->n_beads, sizeof *weld);
    st = weld ? thr_welds_find(&blocks, widen, analysis->limits, weld, err) : thr_nomem(err);
    analysis->weld[i] = weld;
  }

  /* A load that is too much is so for knotted cords of any tension: their faces do not open, unless
   * the strength of the cord is known. */
  for (int i = 0;
       i < analysis->beads->n_rises && analysis->carries && !(analysis->beads->strength > 0) && !st;
       i++)
    thr_disjoint_join(analysis->weld[1], analysis->frame->edge[analysis->beads->rise[i].face][0],
                      analysis->frame->edge[analysis->beads->rise[i].face][1]);

  return st;
}

/* Returns the warm start for a programme: that of a programme whose tensions were capped alike,
 * within a factor of 2, else an empty one, as others would mislead. NULL: merged blocks start cold.
 */
static thr_warm *warm_at(limit_analysis *analysis, double most, bool merged)
{
  if (merged) return NULL;
  const double span = fmin(most, analysis->largest) / analysis->least;

  if (span > 2 * analysis->span || analysis->span > 2 * span) thr_warm_destroy(&analysis->warm);
  analysis->span = span;

  return &analysis->warm;
}

/* Solves one programme, and replaces the mechanism in *result if there was one. Of merged blocks,
 * result->pull stays: the optimum of the unmerged ones, which is about theirs. */
static thr_status pull_of(limit_analysis *analysis, double most, bool merged, bool outside,
                          programme_result *result, thr_err *err)
{
  const double widen = outside && !analysis->round ? thr_blocks_widening(analysis->beads) : 1;

  /* A pull that is enough for the start of the programme with cones, in weights of a bead: ten
   * times what a dome of 2,000 beads needs. */
  const double plenty = 3000;

  thr_blocks blocks = part(analysis, most, merged, outside);
  thr_status st = thr_blocks_make(&blocks, widen, err);
  if (st) return st;

  /* Units near the optimum keep the numbers of the solver near 1. */
  blocks.bound = widen > 1;
  if (merged) blocks.pull = result->pull / (blocks.stretches ? blocks.length : 1);
  blocks.guess = result->pull > 0 && isfinite(result->pull) ? result->pull : plenty * blocks.pull;
  blocks.pull *= analysis->unit;
  blocks.warm = warm_at(analysis, most, merged);

  /* The mechanism of the programme before is replaced. */
  free(result->velocity);
  result->velocity = NULL;
  st = solve_pull(&blocks, analysis->limits, result, err);

  thr_blocks_destroy(&blocks);
  return st;
}

/* Returns the gap at which a bound is accepted: the large programmes are solved less exactly. */
static double close_enough(const limit_analysis *analysis)
{
  return analysis->beads->n_beads > THR_BLOCKS_LARGE ? 2 * THR_BLOCKS_ROUGH : CLOSE;
}

/* Returns whether a bound is accepted. Where no pull is needed, nothing is proved and no mechanism
 * has to hold: all multipliers are about 0 then. */
static bool closed(const limit_analysis *analysis, const programme_result *result, double within)
{
  return result->gap < within &&
         (result->residual < STILL || (!analysis->carries && result->lower == 0));
}

/* Moves *result to *best if it is near and its bound is better: a higher pull or a lower load. */
static void keep_better(const limit_analysis *analysis, programme_result *result, double most,
                        programme_result *best, double *best_most)
{
  if (!closed(analysis, result, NEAR) ||
      (best->velocity &&
       (analysis->carries ? result->lower >= best->lower : result->lower <= best->lower)))
    return;

  /* The mechanism moves with the result. */
  result_destroy(best);
  *best = *result;
  *best_most = most;
  result->velocity = NULL;
  result->more = NULL;
}

/* Returns whether a mechanism proves that no pull holds the structure: no contact closes, no cord
 * is drawn out of its beads, and weights and load do work. Then the cords do not resist, however
 * hard they are pulled. */
static bool gives_way(const thr_blocks *blocks, const double (*velocity)[6])
{
  thr_powers powers = thr_mechanism_balance(blocks, velocity);

  /* Contacts must not close, and something must drive the mechanism. */
  if (!(thr_mechanism_opening(blocks, velocity) >= -STILL) ||
      !(powers.falling + powers.load > 1e-6 * powers.most))
    return false;

  /* Below this speed the opening of a face is rounding. */
  const double still = 1e-6 * (powers.falling + powers.load) / powers.most;
  bool still_all = true;
  for (int e = 0; e < blocks->b->n_faces; e++)
    still_all &= !(blocks->press[e] > 0) || thr_mechanism_parting(blocks, velocity, e) <= still;

  /* The same for the faces of knotted cords, which tighten as they open. */
  for (int i = 0; i < blocks->b->n_rises; i++)
    still_all &= thr_mechanism_parting(blocks, velocity, blocks->b->rise[i].face) <= still;

  return still_all;
}

/* Decides whether a mechanism proves that knotted cords of any tension up to their strength do not
 * hold the structure: what they resist with at most is less than what the weights do. */
static thr_status breaks(const thr_blocks *blocks, const double (*velocity)[6], bool *proved,
                         thr_err *err)
{
  const thr_powers powers = thr_mechanism_balance(blocks, velocity);
  knotted_cords knots;
  thr_status st = knotted_make(blocks, velocity, &knots, err);
  if (st) return st;

  /* The most that the cords can resist with beyond their least tensions: no price, any stretch. */
  const double more =
      thr_mechanism_tightening(blocks->b, knots.apart, 0, INFINITY, knots.pass, knots.point);
  *proved = thr_mechanism_opening(blocks, velocity) >= -STILL &&
            powers.falling - powers.resistance - more > THR_MECHANISM_DRIVE * powers.all;

  thr_scratch_free(&knots.own);
  return THR_OK;
}

/* Computes the mechanism of the programme "least help by hands" for some blocks, which are made
 * here: where the cost is positive, the multipliers are a mechanism. Velocities stay 0 where there
 * are no rows. */
static thr_status find_mechanism(const limit_analysis *analysis, thr_blocks *blocks,
                                 double (*velocity)[6], thr_err *err)
{
  thr_blocks_solution solution = {0};
  thr_status st = thr_blocks_make(blocks, thr_blocks_widening(analysis->beads), err);
  if (!st && blocks->n_rows > 0)
    st = thr_blocks_solve(blocks, true, analysis->limits, &solution, err);
  if (!st && blocks->n_rows > 0)
    st = thr_mechanism_make(blocks, solution.dual, analysis->limits, velocity, err);

  thr_blocks_solution_destroy(&solution);
  return st;
}

/* Keeps the mechanism as the proof that the question returns. */
static void take_way(limit_analysis *analysis, double (**velocity)[6])
{
  free(analysis->way);
  analysis->way = *velocity;
  *velocity = NULL;
}

/* Returns THR_EINFEASIBLE, with the proof in way, if knotted cords within their strength cannot
 * hold the structure. */
static thr_status check_strength(limit_analysis *analysis, thr_err *err)
{
  thr_blocks blocks = part(analysis, INFINITY, false, true);
  double(*velocity)[6] = thr_calloc((size_t)analysis->beads->n_beads, sizeof *velocity);
  bool proved = false;

  if (!velocity) return thr_nomem(err);

  thr_status st = find_mechanism(analysis, &blocks, velocity, err);
  if (!st) st = breaks(&blocks, (const double(*)[6])velocity, &proved, err);
  if (proved) {
    st = thr_fail(err, THR_EINFEASIBLE, "knotted cords break before they hold the structure");
    take_way(analysis, &velocity);
  }

  thr_blocks_destroy(&blocks);
  free(velocity);
  return st;
}

/* Returns THR_EINFEASIBLE if it is proved that no pull holds the structure. With friction, however
 * little the cords press a face, a large pull makes its two beads one body. So the structure
 * without cords whose pressed faces are merged gives way if and only if the structure does at any
 * pull. */
static thr_status check_feasible(limit_analysis *analysis, thr_err *err)
{
  bool friction = analysis->physics->mu_bead > 0;
  thr_blocks blocks = part(analysis, friction ? 0 : INFINITY, friction, true);

  blocks.round = false;
  double(*velocity)[6] = thr_calloc((size_t)analysis->beads->n_beads, sizeof *velocity);
  if (!velocity) return thr_nomem(err);

  /* The mechanism that costs hands least, and whether it proves that no pull holds. */
  thr_status st = find_mechanism(analysis, &blocks, velocity, err);
  if (!st && gives_way(&blocks, (const double(*)[6])velocity)) {
    int v = thr_mechanism_fastest(analysis->beads, (const double(*)[6])velocity);
    st = thr_fail(err, THR_EINFEASIBLE,
                  "no pull holds the structure: the bead at node %s gives way however hard the "
                  "cords are pulled; more friction "
                  "(mu_bead, mu_ground), other feet or a cord that presses this bead against its "
                  "neighbours may help",
                  v < 0 ? "?" : analysis->frame->name[v]);
    if (analysis->wants_way) take_way(analysis, &velocity);
  }

  thr_blocks_destroy(&blocks);
  free(velocity);
  return st;
}

/* Computes the lower bound at one cap on the tensions, with merged blocks if the bound does not
 * close otherwise. *best keeps the best bound that came near. */
static thr_status lower_at(limit_analysis *analysis, double most, programme_result *result,
                           programme_result *best, double *best_most, thr_err *err)
{
  thr_status st = pull_of(analysis, most, false, true, result, err);
  if (st || closed(analysis, result, close_enough(analysis))) return st;
  keep_better(analysis, result, most, best, best_most);

  /* Merging makes sense where a tension is capped and the pull is known roughly. */
  if (analysis->largest <= most || !(result->pull > 0) || !isfinite(result->pull)) return THR_OK;
  st = pull_of(analysis, most, true, true, result, err);
  if (!st && !closed(analysis, result, close_enough(analysis)))
    keep_better(analysis, result, most, best, best_most);

  return st;
}

/* Computes the lower bound with the first cap at which it closes, else the best that came near.
 * *most receives the cap. THR_ESOLVER if none came near, THR_EINFEASIBLE if no pull holds. */
static thr_status lower_pull_in(limit_analysis *analysis, double *most, programme_result *result,
                                thr_err *err)
{
  programme_result best = {0};
  double best_most = 0;
  thr_status st = THR_OK;

  for (int i = 0; i < CAPS; i++) {
    *most = analysis->least * cap[i];
    st = lower_at(analysis, *most, result, &best, &best_most, err);
    if (st || (result->velocity && closed(analysis, result, close_enough(analysis)))) goto done;

    /* After the first cap: does any pull hold the structure? */
    if (i == 0 && !best.velocity && !analysis->carries && (st = check_feasible(analysis, err)))
      goto done;
    if (i == 0 && !best.velocity && analysis->stretches && analysis->beads->strength > 0 &&
        (st = check_strength(analysis, err)))
      goto done;

    /* No tension is above this cap, or the programme has cones, for which a greater span is no
     * easier. */
    if (analysis->largest <= *most || (analysis->round && !isfinite(result->pull))) break;
  }

  /* A bound that came near is better than none. */
  if (best.velocity) {
    result_destroy(result);
    *result = best;
    *most = best_most;
    return THR_OK;
  }

  /* Nothing came near: say whether the span of the tensions or the programme is to blame. */
  const double span = analysis->least > 0 ? analysis->largest / analysis->least : 1;
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
  result_destroy(&best);
  return st;
}

/* Computes the lower bound as lower_pull_in does, in several units of the unknown until one is
 * decided. Beyond a thousand beads a third try takes too long. */
static thr_status lower_pull(limit_analysis *analysis, double *most, programme_result *result,
                             thr_err *err)
{
  const int tries = analysis->beads->n_beads > THR_BLOCKS_LARGE ? 2 : UNITS;
  thr_err why = {0};
  thr_status st = THR_ESOLVER;

  for (int i = 0; i < tries && st == THR_ESOLVER; i++) {
    result_destroy(result);
    analysis->unit = unit[i];
    st = lower_pull_in(analysis, most, result, &why);
  }

  /* The reason is that of the last unit. */
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Adds up the tensions of the passes through each face. */
void thr_holding_press(const thr_cord *cord, int n_cords, const double *const *tension,
                       double *press)
{
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      press[cord[i].half[k] >> 1] += tension[i][k];
}

/* Computes the pull at which an equilibrium within pyramids inside the cones exists: with the rays
 * that are asked for in several units, then with as many rays as there may be. */
static thr_status upper_pull(limit_analysis *analysis, double most, programme_result *result,
                             thr_err *err)
{
  const thr_beads *usual = analysis->beads;
  thr_beads finer = *usual;
  finer.rays = THR_MOST_RAYS;
  thr_status st = THR_OK;

  /* The second round over the units has as many rays as there may be, where that is affordable. */
  for (int i = 0; i < 2 * UNITS && !st && !(i > 0 && isfinite(result->pull)); i++) {
    if (i == UNITS && (usual->rays == THR_MOST_RAYS || usual->n_beads > THR_BLOCKS_LARGE)) break;
    analysis->beads = i < UNITS ? usual : &finer;
    analysis->unit = unit[i % UNITS];
    result->pull = 0;
    st = pull_of(analysis, most, false, false, result, err);
  }
  analysis->beads = usual;

  return st;
}

/* Computes both bounds. *upper: the pull at which an equilibrium within the cones exists, 0 if not
 * wanted. Where a programme with cones is not decided, pyramids are tried. more[n_rises] receives
 * by how much the tension of each knotted pass grew, N; NULL ok. */
static thr_status bounds(limit_analysis *analysis, bool want_upper, programme_result *result,
                         double *upper, double *more, thr_err *err)
{
  programme_result inside_cones = {0};
  double most;

  *upper = 0;

  /* Cones: one programme gives both bounds, but what is found must have the cords in the middle. */
  if (analysis->round) {
    thr_status st = lower_pull_in(analysis, &most, result, err);
    if (!st && want_upper) st = pull_of(analysis, most, false, false, &inside_cones, err);
    *upper = inside_cones.pull;
    result_destroy(&inside_cones);
    if (st != THR_ESOLVER) return st;
    result_destroy(result);
    analysis->round = false;
  }

  /* Pyramids round the cones, then inside them. */
  thr_status st = lower_pull(analysis, &most, result, err);
  if (!st && want_upper) st = upper_pull(analysis, most, &inside_cones, err);

  /* What an equilibrium with pyramids inside the cones needs is an upper bound of the same
   * question. */
  *upper = inside_cones.pull;
  if (more && inside_cones.more)
    memcpy(more, inside_cones.more, (size_t)analysis->beads->n_rises * sizeof *more);
  result_destroy(&inside_cones);

  return st;
}

/* Answers a question: welds, both bounds, and the record of them. more[n_rises]: as of `bounds`.
 * Frees what the question owns. */
static thr_status hold(limit_analysis *analysis, bool want_upper, thr_holding *holding,
                       double *more, thr_err *err)
{
  programme_result result = {0};
  double upper = 0;
  thr_status st = find_welds(analysis, err);
  if (!st) st = bounds(analysis, want_upper, &result, &upper, more, err);

  /* The bounds and the mechanism become the caller's. */
  if (!st) {
    assert(result.velocity);
    holding->present = true;
    holding->lower = result.lower;
    holding->upper = upper;
    holding->residual = result.residual;
    holding->first_bead =
        result.lower > 0 || analysis->carries
            ? thr_mechanism_fastest(analysis->beads, (const double(*)[6])result.velocity)
            : -1;
    holding->velocity = result.velocity;
    holding->resists = result.resists;
    result.velocity = NULL;
  }

  result_destroy(&result);
  analysis_destroy(analysis);

  return st;
}

/* Returns a question with the range of the presses of its faces. */
static limit_analysis analysis_of(const thr_beads *beads, const thr_frame *frame,
                                  const thr_physics *physics, const double *press,
                                  const thr_limits *limits)
{
  limit_analysis analysis = {.beads = beads,
                             .frame = frame,
                             .physics = physics,
                             .press = press,
                             .limits = limits,
                             .least = INFINITY,
                             .unit = 1};

  /* Large structures have cones unless other rays were asked for. */
  analysis.round = beads->n_beads > THR_BLOCKS_LARGE && beads->rays == THR_USUAL_RAYS;

  /* The range of the presses, which the caps divide. */
  for (int e = 0; e < beads->n_faces; e++) {
    if (press[e] > 0) analysis.least = fmin(analysis.least, press[e]);
    analysis.largest = fmax(analysis.largest, press[e]);
  }

  return analysis;
}

/* Computes the holding pull; see beads.h. */
thr_status thr_holding_pull(const thr_beads *beads, const thr_frame *frame,
                            const thr_physics *physics, const double *press, bool want_upper,
                            const thr_limits *limits, thr_holding *out, thr_err *err)
{
  limit_analysis analysis = analysis_of(beads, frame, physics, press, limits);
  analysis.load = (const double(*)[3])beads->load;
  *out = (thr_holding){0};
  return hold(&analysis, want_upper, out, NULL, err);
}

/* Holds a mechanism in which the structure gives way under some multiple of the load, with the
 * tensions of the cords as they are. Such a mechanism excludes every multiple with excess +
 * multiple x load > 0. */
typedef struct {
  double (*velocity)[6]; /* owned */
  double excess;         /* W: power of the weights less what the cords resist with */
  double load;           /* W: power of the load, once */
} yielding;

/* Computes the powers of a mechanism. */
static void weigh_powers(const thr_blocks *blocks, yielding *mechanism)
{
  const thr_powers powers = thr_mechanism_balance(blocks, (const double(*)[6])mechanism->velocity);
  mechanism->excess = powers.falling - powers.resistance;
  mechanism->load = powers.load;
}

/* Finds a mechanism that excludes a multiple of the load. THR_ESOLVER if there is none, or none was
 * found. */
static thr_status yield_at(const thr_blocks *blocks, double multiple, const thr_limits *limits,
                           yielding *out, thr_err *err)
{
  const size_t n = (size_t)blocks->b->n_beads;
  thr_holding found = {0};
  double(*load)[3] = thr_calloc(n, sizeof *load);

  if (!load) return thr_nomem(err);

  /* A plain holding question, with the load multiplied. */
  for (size_t v = 0; v < n; v++)
    for (int k = 0; k < 3; k++)
      load[v][k] = multiple * blocks->load[v][k];

  /* The mechanism excludes the multiple if no pull holds the structure, or only more than the
   * tensions that there are (a factor above 1). */
  limit_analysis analysis =
      analysis_of(blocks->b, blocks->f, blocks->physics, blocks->press, limits);
  analysis.load = (const double(*)[3])load;
  analysis.wants_way = true;
  thr_status st = hold(&analysis, false, &found, NULL, err);
  free(load);
  if (st == THR_EINFEASIBLE || (!st && found.lower > 1)) {
    out->velocity = st ? analysis.way : found.velocity;
    weigh_powers(blocks, out);
    return THR_OK;
  }

  free(analysis.way);
  thr_holding_destroy(&found);
  return st == THR_ENOMEM || st == THR_ELIMIT ? st : THR_ESOLVER;
}

/* Adds a part of *high, a mechanism that the load drives, to *low. Mechanisms form a convex cone,
 * and the resistance of the cords is convex, so the sum is a mechanism whose excess is at least the
 * sum of both. */
static void combine(const thr_blocks *blocks, yielding *low, const yielding *high, double part)
{
  double fastest = 0;
  for (int v = 0; v < blocks->b->n_beads; v++) {
    for (int k = 0; k < 6; k++)
      low->velocity[v][k] += part * high->velocity[v][k];
    fastest = fmax(fastest, sqrt(thr_dot(low->velocity[v], low->velocity[v])));
  }

  /* Scale to a largest translation of 1. */
  for (int v = 0; v < blocks->b->n_beads && fastest > 0; v++)
    for (int k = 0; k < 6; k++)
      low->velocity[v][k] /= fastest;
  weigh_powers(blocks, low);
}

/* Decides whether no multiple of the load has an equilibrium, in which case the programme for the
 * largest multiple has no solution.
 *
 * By mechanisms: one that gives way without the load, and that the load holds back, excludes all
 * multiples up to some `enough`. The mechanism at `enough` excludes more of them; if the load
 * drives it, it excludes all that are larger, and a sum of both excludes all. *carry stays as it
 * is, and the result is THR_ESOLVER, where that is not decided. */
static thr_status carry_nothing(const thr_beads *beads, const thr_frame *frame,
                                const thr_physics *physics, const double *press,
                                const double (*load)[3], const thr_limits *limits, thr_carry *carry,
                                thr_err *err)
{
  enum { TRIES = 12 };
  limit_analysis analysis = analysis_of(beads, frame, physics, press, limits);
  thr_blocks blocks = part(&analysis, INFINITY, false, true);
  blocks.load = load;
  blocks.carries = true;
  thr_err why = {0};
  yielding low = {0}, high = {0};
  thr_status st = thr_blocks_make(&blocks, 1, err);
  if (st) return st;

  /* Begin with a mechanism that gives way without the load. */
  st = yield_at(&blocks, 0, limits, &low, &why);

  /* The load may hardly act on what gives way, by rounding or by symmetry. Then add some of the
   * mechanism that a large load moves. */
  const thr_powers at_rest =
      st ? (thr_powers){0} : thr_mechanism_balance(&blocks, (const double(*)[6])low.velocity);
  if (!st && fabs(low.load) < 1e-6 * at_rest.all_loads) {
    st = yield_at(&blocks, 100 * at_rest.all / at_rest.all_loads, limits, &high, &why);
    if (!st && high.load > 0)
      combine(&blocks, &low, &high, high.excess < 0 ? 0.5 * low.excess / -high.excess : 1);
    free(high.velocity);
    high.velocity = NULL;
  }

  /* Raise the least multiple that is not excluded, until the load no longer holds the mechanism
   * back. */
  for (int i = 0; i < TRIES && !st && low.load < 0; i++) {
    const double enough = low.excess / -low.load;
    st = yield_at(&blocks, enough * (1 + 1e-6), limits, &high, &why);
    if (!st && high.load > 0) combine(&blocks, &low, &high, 1.02 * -low.load / high.load);
    if (!st && high.load <= 0) {
      free(low.velocity);
      low = high;
      high.velocity = NULL;
    }
    free(high.velocity);
    high.velocity = NULL;
  }

  /* The sum is judged as every other bound is: nothing holds even a load of 0. */
  programme_result result = {.velocity = low.velocity, .lower = INFINITY};
  if (!st) st = certify(&blocks, &result, &why);
  if (!st && result.lower == 0 && result.residual < STILL) {
    *carry =
        (thr_carry){.first_bead = thr_mechanism_fastest(beads, (const double(*)[6])low.velocity),
                    .velocity = low.velocity};
  } else {
    free(low.velocity);
    if (!st) st = THR_ESOLVER;
  }

  thr_blocks_destroy(&blocks);
  return st == THR_ESOLVER || !st ? st : thr_fail(err, st, "%s", why.text);
}

/* Computes the largest multiple of a load; see beads.h. */
thr_status thr_holding_carry(const thr_beads *beads, const thr_frame *frame,
                             const thr_physics *physics, const double *press,
                             const double (*load)[3], bool want_carried, const thr_limits *limits,
                             thr_carry *out, thr_err *err)
{
  thr_holding found = {0};
  limit_analysis analysis = analysis_of(beads, frame, physics, press, limits);

  /* Programmes with cones do not know cords that tighten. */
  analysis.load = load;
  analysis.carries = true;
  analysis.round &= beads->n_rises == 0;
  *out = (thr_carry){0};

  /* The bounds of a factor on the load: lower is what is too much, upper what is carried. */
  thr_status st = hold(&analysis, want_carried, &found, NULL, err);
  if (!st)
    *out = (thr_carry){.beyond = found.lower,
                       .carried = found.upper,
                       .first_bead = found.first_bead,
                       .velocity = found.velocity};

  /* Without knotted cords, an undecided programme may mean that no multiple at all is carried. */
  return st == THR_ESOLVER && beads->n_rises == 0
             ? carry_nothing(beads, frame, physics, press, load, limits, out, err)
             : st;
}

/* Computes the stretch of knotted cords; see beads.h. */
thr_status thr_holding_stretch(const thr_beads *beads, const thr_frame *frame,
                               const thr_physics *physics, const double *press,
                               const thr_limits *limits, thr_holding *out, double *more,
                               thr_err *err)
{
  limit_analysis analysis = analysis_of(beads, frame, physics, press, limits);
  analysis.stretches = true;
  analysis.round = false;
  analysis.wants_way = true;
  *out = (thr_holding){0};
  thr_status st = hold(&analysis, true, out, more, err);

  /* No stretch holds the structure. Does the mechanism prove the same of cords within their
   * strength, where faces may open? */
  if (st == THR_EINFEASIBLE && analysis.way && beads->strength > 0) {
    thr_blocks blocks = part(&analysis, INFINITY, false, true);
    bool proved = false;
    thr_err why = {0};
    thr_status again = thr_blocks_make(&blocks, thr_blocks_widening(beads), &why);

    /* The mechanism must balance even with what the cords can tighten by. */
    if (!again) again = breaks(&blocks, (const double(*)[6])analysis.way, &proved, &why);
    thr_blocks_destroy(&blocks);
    if (again) st = thr_fail(err, again, "%s", why.text);

    /* The proof becomes the caller's. */
    if (proved) out->velocity = analysis.way, analysis.way = NULL;
  }

  free(analysis.way);
  return st;
}

/* Frees the mechanism. */
void thr_carry_destroy(thr_carry *carry)
{
  free(carry->velocity);
  *carry = (thr_carry){.first_bead = -1};
}

/* Frees the mechanism. */
void thr_holding_destroy(thr_holding *holding)
{
  if (!holding) return;
  free(holding->velocity);
  *holding = (thr_holding){0};
}
