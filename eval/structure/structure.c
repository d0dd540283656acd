/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evaluates a plan by limit analysis: how hard must the ends be pulled so that the closed structure
 * of rigid beads can stand?
 *
 * Every cord's tensions follow the capstan law, T_out = T_in exp(mu theta), scaled to a pull of 1
 * at the harder end. Each face is pressed with the sum of its passes' tensions. The limit analysis
 * (holding.c) then finds the least factor, in N, with which the structure has an equilibrium.
 *
 * Friction has no memory of direction: over a turn with exponent e = mu theta, neighbouring
 * tensions are in equilibrium as long as T e^-e <= T' <= T e^e. The same question is therefore
 * asked of several states: while the cords are drawn in, with equal pulls at all ends, in any state
 * that friction keeps, and after a schedule. Each bound is proved at the frictions that are stated
 * with the bound, and asked again at both ends of their bands.
 *
 * Example: the 7 x 7 dome with one snaking cord, mu = 0.2, needs 4.14 N at the harder end while the
 * cord is drawn in, 3.47 N at both ends, and 0.0265 N in any state (docs/method.md, "Pull force").
 */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/process/process.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of beads for which bounds at the ends of the bands, and searches by bisection, are
 * computed: beyond, they would take longer than the answer itself. */
enum { BAND_LARGEST = 100 };

/* Returns the number of passes of the longest cord, at least 1. */
static int pass_count(const thr_evaluation *evaluation)
{
  int most = 1;
  for (int i = 0; i < evaluation->n_cords; i++)
    if (evaluation->cord[i].n_passes > most) most = evaluation->cord[i].n_passes;
  return most;
}

/* Computes the tensions of one cord at friction mu, scaled so that the harder pulled end has 1, and
 * the exponents of its turns. Turns are those of the taut cord where eval_cord->turn is filled in.
 * A cord that is not pulled is slack. */
static thr_status profile(const thr_frame *frame, const thr_cord *cord, const thr_physics *physics,
                          double mu, thr_eval_cord *eval_cord, thr_err *err)
{
  if (!eval_cord->exponent)
    eval_cord->exponent = thr_calloc((size_t)cord->n_passes, sizeof *eval_cord->exponent);
  double *exponent = eval_cord->exponent;
  if (!exponent) return thr_nomem(err);

  /* Exponents: friction times the angle of each turn, plus what wobble of the bore adds. */
  eval_cord->turning = eval_cord->taut_turning = 0;
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    const double turn = thr_turn_angle(frame, cord->half[k], cord->half[k + 1]),
                 counts = eval_cord->turn ? eval_cord->turn[k] : turn;
    exponent[k] = mu * counts + thr_profile_wobble(frame, physics, cord, k, mu);
    eval_cord->turning += turn;
    eval_cord->taut_turning += counts;
  }

  /* The tensions that follow from the capstan law with these exponents. */
  free(eval_cord->tension);
  eval_cord->tension = NULL;
  thr_status st = thr_profile_cord(eval_cord, cord, exponent, eval_cord->pull, 1,
                                   &(thr_friction){.power = 1}, err);
  if (st) return st;

  /* Scale to a pull of 1. */
  const bool pulled = eval_cord->pull != THR_PULL_NONE;
  const double force = pulled ? eval_cord->force : 1;
  for (int k = 0; k < cord->n_passes; k++)
    eval_cord->tension[k] /= force;
  eval_cord->other_force /= force;
  eval_cord->force = pulled ? 1 : 0;

  return THR_OK;
}

/* Computes the tensions of all cords at friction mu. tension[n_cords] receives pointers to these
 * arrays, which belong to the record. */
static thr_status profiles(const thr_frame *frame, const thr_cord *cord, double mu,
                           thr_evaluation *evaluation, const double **tension, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < evaluation->n_cords && !st; i++) {
    st = profile(frame, &cord[i], &evaluation->physics, mu, &evaluation->cord[i], err);
    tension[i] = evaluation->cord[i].tension;
  }

  return st;
}

/* ---- states that friction keeps ---- */

/* Names the states of a cord both of whose ends have the same force. DRAWN_IN: each turn lets in as
 * little tension as friction allows while both ends are pulled. KEPT: each turn keeps as much as
 * friction allows. LET_DOWN: as KEPT, but no pass has more than in the record, which the ends were
 * let down from. */
typedef enum { DRAWN_IN, KEPT, LET_DOWN } friction_state;

/* Computes the tensions of one cord, [n_passes], whose ends both have `force`, N: force x exp(-e)
 * in DRAWN_IN, force x exp(+e) in KEPT, where e is the sum of the exponents from the pass to the
 * nearer end. */
static void set_state(const thr_eval_cord *cord, friction_state which, double force, double *out)
{
  /* e^600 is more than any tension needs, and e^710 is past what a double holds. */
  const double largest_exponent = 600;
  double before = 0, total = 0;

  /* A cord that nobody pulls stays slack, whatever is done to the others. */
  if (cord->pull == THR_PULL_NONE) force = 0;

  /* The exponents of the whole cord, to know how far each pass is from the end behind it. */
  for (int k = 0; k + 1 < cord->n_passes; k++)
    total += cord->exponent[k];

  /* Each pass has the force of its nearer end, reduced or raised by the turns in between. */
  for (int k = 0; k < cord->n_passes; k++) {
    const double exponent_to_end = fmin(largest_exponent, fmin(before, total - before));
    out[k] = force > 0 ? force * exp(which == DRAWN_IN ? -exponent_to_end : exponent_to_end) : 0;
    if (which == LET_DOWN) out[k] = fmin(out[k], cord->tension[k]);
    if (k + 1 < cord->n_passes) before += cord->exponent[k];
  }
}

/* Adds to press[n_faces] (0 before) what cords in this state press each face with, N. */
static thr_status press_of_state(const thr_cord *cord, const thr_evaluation *evaluation,
                                 friction_state which, double force, double *press, thr_err *err)
{
  double *tension = thr_calloc((size_t)pass_count(evaluation), sizeof *tension);

  /* Add cord after cord, with one scratch array for all. */
  for (int i = 0; i < evaluation->n_cords && tension; i++) {
    set_state(&evaluation->cord[i], which, force, tension);
    thr_holding_press(&cord[i], 1, &(const double *){tension}, press);
  }

  const bool done = tension != NULL;

  free(tension);
  return done ? THR_OK : thr_nomem(err);
}

/* Computes by what the tensions of cords in this state may be multiplied: the bounds of
 * thr_holding_pull.
 *
 * Among all friction states with the same force at the ends, KEPT has the largest tensions and
 * presses most, and to press more never harms: if an equilibrium exists with some tensions, one
 * exists with larger ones. So what is proved of KEPT is proved of every state. */
static thr_status hold_state(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                             friction_state which, double force, bool want_upper,
                             const thr_limits *limits, const thr_evaluation *evaluation,
                             thr_holding *out, thr_err *err)
{
  double *press = thr_calloc((size_t)beads->n_faces, sizeof *press);
  thr_status st =
      press ? press_of_state(cord, evaluation, which, force, press, err) : thr_nomem(err);

  /* The unknown factor multiplies all tensions alike. */
  if (!st)
    st = thr_holding_pull(beads, frame, &evaluation->physics, press, want_upper, limits, out, err);

  free(press);
  return st;
}

/* Computes by what the load may be multiplied while the cords are in this state. out->first_bead is
 * -1 if that is not decided; only a lack of memory or time is a failure. */
static thr_status carry_state(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                              friction_state which, double force, const double (*load)[3],
                              bool want_carried, const thr_limits *limits,
                              const thr_evaluation *evaluation, thr_carry *out, thr_err *err)
{
  thr_err why = {0};
  double *press = thr_calloc((size_t)beads->n_faces, sizeof *press);
  thr_status st =
      press ? press_of_state(cord, evaluation, which, force, press, &why) : thr_nomem(&why);

  if (!st)
    st = thr_holding_carry(beads, frame, &evaluation->physics, press, load, want_carried, limits,
                           out, &why);

  /* What is not decided is no failure: the record just does not mention it. */
  free(press);
  if (st) *out = (thr_carry){.first_bead = -1};

  return st == THR_OK || st == THR_ESOLVER ? THR_OK : thr_fail(err, st, "%s", why.text);
}

/* ---- the band of the frictions of beads and ground, which are estimates ---- */

/* Returns whether the bounds are computed at both ends of the band, too. */
static bool has_bands(const thr_evaluation *record, const thr_beads *beads)
{
  return beads->n_beads <= BAND_LARGEST && record->physics.mu > 0;
}

/* Returns a shallow copy of the record with the frictions of beads and ground at one end of their
 * band (0: lower, 1: upper): scaled as the friction of the cords is, by mu_low / mu or mu_high /
 * mu. */
static thr_evaluation with_band_end(const thr_evaluation *record, int end)
{
  thr_evaluation other = *record;

  /* The same factor for both, as nothing better is known of how the three estimates are wrong.
   */
  const double times =
      (end ? record->physics.mu_high : record->physics.mu_low) / record->physics.mu;
  other.physics.mu_bead *= times;
  other.physics.mu_ground *= times;

  return other;
}

/* Returns the status of a question whose answers are "nothing holds it" and "not decided", too:
 * only a lack of memory or time is a failure, with the text of *why. Empties *why for the next
 * question, as thr_fail keeps the first text. */
static thr_status pass_failure(thr_status st, thr_err *why, thr_err *err)
{
  if (st && st != THR_EINFEASIBLE && st != THR_ESOLVER) return thr_fail(err, st, "%s", why->text);
  *why = (thr_err){0};
  return THR_OK;
}

/* Stores the proved bound of a solved question: INFINITY if nothing holds, NAN if that is not
 * decided. Frees *found. */
static thr_status take_bound(thr_status st, thr_holding *found, thr_err *why, double *bound,
                             thr_err *err)
{
  *bound = st == THR_OK ? found->lower : st == THR_EINFEASIBLE ? INFINITY : NAN;
  thr_holding_destroy(found);
  return pass_failure(st, why, err);
}

/* Computes the bound of hold_state at one end of the band. */
static thr_status bound_state(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                              friction_state which, double force, int end, const thr_limits *limits,
                              const thr_evaluation *record, double *bound, thr_err *err)
{
  const thr_evaluation other = with_band_end(record, end);
  thr_holding found = {0};
  thr_err why = {0};
  const thr_status st =
      hold_state(frame, cord, beads, which, force, false, limits, &other, &found, &why);

  return take_bound(st, &found, &why, bound, err);
}

/* Computes the multiple of the load that is too much for carry_state at one end of the band; NAN if
 * that is not decided. */
static thr_status bound_carried(const thr_frame *frame, const thr_cord *cord,
                                const thr_beads *beads, friction_state which, double force,
                                const double (*load)[3], int end, const thr_limits *limits,
                                const thr_evaluation *record, double *bound, thr_err *err)
{
  const thr_evaluation other = with_band_end(record, end);
  thr_carry found = {0};
  const thr_status st =

      carry_state(frame, cord, beads, which, force, load, false, limits, &other, &found, err);

  /* Only what is proved counts, not the load that was found to be carried. */
  *bound = !st && found.first_bead >= 0 ? found.beyond : NAN;
  thr_carry_destroy(&found);
  return st;
}

/* Holds the input of the questions about a load, which are answered in parallel. */
typedef struct {
  const thr_frame *frame;
  const thr_cord *cord;
  const thr_beads *beads;
  const double (*load)[3];
  thr_eval *out;
} loading;

/* Computes the pull of all ends at which the whole load is carried while the cords are drawn in,
 * with its bounds at both ends of the band. lower is INFINITY if no pull carries the load. */
static thr_status carry_all(const loading *jobs, const thr_limits *limits, thr_err *err)
{
  thr_err why = {0};
  const size_t n = (size_t)jobs->beads->n_beads;

  /* The load acts beside the weights, so that the holding pull of such beads is the answer. */
  thr_beads loaded = *jobs->beads;
  loaded.load = thr_calloc(n, sizeof *loaded.load);
  if (!loaded.load) return thr_nomem(err);
  memcpy(loaded.load, jobs->load, n * sizeof *loaded.load);
  thr_status st = hold_state(jobs->frame, jobs->cord, &loaded, DRAWN_IN, 1, true, limits,
                             &jobs->out->record, &jobs->out->loaded, &why);

  /* What is proved at both ends of the band. If no pull holds it at the stated frictions, one may
   * at others. */
  for (int end = 0;
       end < 2 && has_bands(&jobs->out->record, &loaded) && (st == THR_OK || st == THR_EINFEASIBLE);
       end++) {
    const thr_status more =
        bound_state(jobs->frame, jobs->cord, &loaded, DRAWN_IN, 1, end, limits, &jobs->out->record,
                    &jobs->out->band_beads[THR_ASKED_LOADED][end], err);
    if (more) st = more;
  }

  /* Neither "no pull does" nor "not decided" is a failure of the whole evaluation. */
  free(loaded.load);
  if (st == THR_EINFEASIBLE || st == THR_ESOLVER)
    jobs->out->loaded = (thr_holding){.present = true,
                                      .lower = st == THR_EINFEASIBLE ? INFINITY : 0,
                                      .upper = INFINITY,
                                      .first_bead = -1};
  return pass_failure(st, &why, err);
}

/* Answers one question: job 0, which pull carries the whole load; job k, what the k-th pull
 * carries. */
static thr_status carry_one(void *user, int job, const thr_limits *limits, thr_err *err)
{
  const loading *jobs = user;
  if (job == 0) return carry_all(jobs, limits, err);
  thr_load_point *point = &jobs->out->carries[job - 1];

  /* The bounds at the frictions that are stated .. */
  thr_status st = carry_state(jobs->frame, jobs->cord, jobs->beads, DRAWN_IN, point->pull,
                              jobs->load, true, limits, &jobs->out->record, &point->carry, err);

  /* .. and what is proved at both ends of their band. */
  for (int end = 0; end < 2 && has_bands(&jobs->out->record, jobs->beads) && !st; end++)
    st = bound_carried(jobs->frame, jobs->cord, jobs->beads, DRAWN_IN, point->pull, jobs->load, end,
                       limits, &jobs->out->record, &point->band_beads[end], err);

  return st;
}

/* Computes the load against the pull: for each of some pulls the multiple of the load that is
 * carried, and the pull that carries the load once. Pulls that were not asked for are 1 to 50 N, of
 * which the last is what a hand can pull. */
static thr_status carry_at_pulls(const thr_frame *frame, const thr_cord *cord,
                                 const thr_beads *beads, const thr_eval_options *options,
                                 const thr_limits *limits, thr_eval *out, thr_err *err)
{
  static const double usual[] = {1, 2, 5, 10, 20, 50}, few[] = {10, 50}; /* 50 N: a hand */

  /* Few pulls for a large structure, whose programmes take long. */
  const bool large = beads->n_beads > BAND_LARGEST;
  const double *pull = options->n_load_pulls > 0 ? options->load_pull : large ? few : usual;
  const int n = options->n_load_pulls > 0 ? options->n_load_pulls : large ? 2 : 6;

  if (!(out->carries = thr_calloc((size_t)n, sizeof *out->carries))) return thr_nomem(err);

  /* Where the time does not suffice for a pull, its answer stays "not decided". */
  out->n_carries = n;
  for (int i = 0; i < n; i++)
    out->carries[i] =
        (thr_load_point){.pull = pull[i], .carry = {.first_bead = -1}, .band_beads = {NAN, NAN}};

  /* Job 0 is the pull for the whole load. */
  loading jobs = {frame, cord, beads, options->load, out};

  return thr_threads_run(n + 1, carry_one, &jobs, limits, err);
}

/* Makes the beads, as they are made if the options say so, with clamped feet, rays and tilt as the
 * options say. */
static thr_status make_beads(const thr_frame *frame, const thr_physics *physics,
                             const thr_eval_options *options, thr_beads *beads, thr_err *err)
{
  thr_status st = thr_beads_make(frame, physics, beads, err);
  if (!st && options->bodies)
    st = thr_beads_take(beads, frame, options->bodies, options->clamped, err);
  bool *held = st ? NULL : thr_calloc((size_t)beads->n_beads, sizeof *held);
  if (!st && !held) st = thr_nomem(err);
  for (int k = 0; !st && k < beads->n_feet; k++)
    held[beads->foot[k]] = true;

  /* Clamping takes the ground away, so that the feet must be listed before. */
  if (!st && options->clamped) thr_beads_clamp(beads, held);
  if (!st && options->rays > 0) beads->rays = options->rays;
  if (!st) thr_beads_tilt(beads, options->tilt, options->azimuth);

  free(held);
  return st;
}

/* Decides for cords whose ends were let down to `force`, N: *stands if an equilibrium was found. */
static thr_status stands_at(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                            double force, const thr_limits *limits,
                            const thr_evaluation *evaluation, bool *stands, thr_err *err)
{
  thr_holding holding = {0};
  thr_err why = {0};
  thr_status st =
      hold_state(frame, cord, beads, LET_DOWN, force, true, limits, evaluation, &holding, &why);

  /* A factor of at most 1 on the tensions is enough. */
  *stands = st == THR_OK && holding.upper <= 1;
  thr_holding_destroy(&holding);
  return st == THR_ENOMEM || st == THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Computes by bisection of the logarithm, to half a percent, to which force the ends can be let
 * down, N: the least force tried at which the structure stands. */
static thr_status let_down(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                           const thr_limits *limits, const thr_evaluation *evaluation, double *out,
                           thr_err *err)
{
  /* Begin with the largest force at any end, and a millionth of that. */
  double high = 0;
  for (int i = 0; i < evaluation->n_cords; i++)
    high = fmax(high, fmax(evaluation->cord[i].tension[0],
                           evaluation->cord[i].tension[evaluation->cord[i].n_passes - 1]));
  double low = 1e-6 * high;
  bool stands;

  /* The answer may be below all forces that are tried. */
  thr_status st = stands_at(frame, cord, beads, low, limits, evaluation, &stands, err);
  if (!st && stands) {
    *out = low;
    return THR_OK;
  }

  /* Invariant: low does not stand, high does. */
  while (!st && high > 1.005 * low) {
    const double middle = sqrt(low * high);
    st = stands_at(frame, cord, beads, middle, limits, evaluation, &stands, err);
    if (stands)
      high = middle;
    else
      low = middle;
  }

  *out = high;
  return st;
}

/* Lists in beads->rise the passes of the cords that are knotted at both ends, with their least
 * tensions (N), lengths (m) and exponents; the array belongs to *own. An exponent of -1 marks the
 * last pass of a cord. */
static thr_status set_rises(const thr_frame *frame, const thr_cord *cord,
                            const thr_evaluation *evaluation, double strength, thr_scratch *own,
                            thr_beads *beads, thr_err *err)
{
  size_t n = 1;
  for (int i = 0; i < evaluation->n_cords; i++)
    n += (size_t)cord[i].n_passes;

  /* The list, with one more than needed so that an empty one has memory. */
  beads->rise = thr_scratch_array(own, n, sizeof *beads->rise);
  beads->strength = strength;
  const thr_status st = thr_scratch_check(own, err);

  /* A turn separates a pass from the next one of its cord, but for the last one. */
  for (int i = 0; i < evaluation->n_cords && !st; i++) {
    if (!thr_schedule_knotted(&evaluation->schedule, i)) continue;
    for (int k = 0; k < cord[i].n_passes; k++) {
      const int e = cord[i].half[k] >> 1;
      const double *from = beads->centre[frame->edge[e][0]], *to = beads->centre[frame->edge[e][1]];
      beads->rise[beads->n_rises++] =
          (thr_rise){.face = e,
                     .least = evaluation->cord[i].tension[k],
                     .length = sqrt(pow(to[0] - from[0], 2) + pow(to[1] - from[1], 2) +
                                    pow(to[2] - from[2], 2)),
                     .exponent = k + 1 < cord[i].n_passes ? evaluation->cord[i].exponent[k] : -1};
    }
  }

  return st;
}

/* Raises the tensions by more[n_rises], and further where rounding left a pass with less than
 * friction over the turn demands, T' >= T exp(-e). Returns the sum of the increases times the
 * lengths of their passes, N m. *tightest receives the largest tension, N. */
static double raise_tensions(const thr_beads *beads, const double *more, double *tightest,
                             double *raised)
{
  const thr_rise *rise = beads->rise;
  const int n = beads->n_rises;
  double sum = 0;

  *tightest = 0;

  /* Begin with the tensions that the solver found. */
  for (int i = 0; i < n; i++)
    raised[i] = rise[i].least + more[i];

  /* Sweep forwards and backwards over each cord, so that no two neighbours differ by more than the
   * turn between them allows. */
  for (int i = 1; i < n; i++)
    if (rise[i - 1].exponent >= 0)
      raised[i] = fmax(raised[i], raised[i - 1] * exp(-rise[i - 1].exponent));
  for (int i = n - 2; i >= 0; i--)
    if (rise[i].exponent >= 0) raised[i] = fmax(raised[i], raised[i + 1] * exp(-rise[i].exponent));

  /* The stretch that these tensions take, and the largest of them. */
  for (int i = 0; i < n; i++) {
    sum += (raised[i] - rise[i].least) * rise[i].length;
    *tightest = fmax(*tightest, raised[i]);
  }

  return sum;
}

/* Turns "not decided" into bounds that say nothing (0 and INFINITY), since the rest of the
 * evaluation does not depend on this question. */
static thr_status undecided(thr_status st, thr_err *why, thr_holding *out, thr_err *err)
{
  if (st == THR_ESOLVER) *out = (thr_holding){.present = true, .upper = INFINITY, .first_bead = -1};
  return pass_failure(st, why, err);
}

/* Computes how far the knotted cords have to stretch so that the structure stands: the sum of the
 * tensions gained times the lengths, N m, which divided by EA is a length. The upper bound is
 * counted again from the tensions themselves. */
static thr_status stretch(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                          const thr_limits *limits, thr_eval *out, thr_err *err)
{
  const thr_evaluation *evaluation = &out->record;
  thr_scratch own = {0};
  thr_err why = {0};
  double *press = thr_scratch_array(&own, (size_t)beads->n_faces + 1, sizeof *press);
  double *more = thr_scratch_array(&own, (size_t)beads->n_rises + 1, sizeof *more);
  double *raised = thr_scratch_array(&own, (size_t)beads->n_rises + 1, sizeof *raised);
  thr_status st = thr_scratch_check(&own, err);
  if (st) return st;

  /* The passes have at least the tensions that the schedule left. */
  for (int i = 0; i < evaluation->n_cords; i++)
    thr_holding_press(&cord[i], 1, &(const double *){evaluation->cord[i].tension}, press);
  st = thr_holding_stretch(beads, frame, &evaluation->physics, press, limits, &out->stretch, more,
                           &why);

  /* Where the solver found an equilibrium, its tensions are made admissible and their sum is the
   * upper bound. */
  if (!st && out->stretch.upper > 0 && isfinite(out->stretch.upper))
    out->stretch.upper =
        fmax(out->stretch.lower, raise_tensions(beads, more, &out->tightest, raised));

  /* However much the cords are tightened, nothing holds the structure. */
  if (st == THR_EINFEASIBLE) {
    out->stretch.present = true;
    out->stretch.lower = out->stretch.upper = INFINITY;
    out->stretch.first_bead = -1;
  }
  st = undecided(st, &why, &out->stretch, err);

  /* The bound at both ends of the band. */
  for (int end = 0; end < 2 && has_bands(evaluation, beads) && !st; end++) {
    const thr_evaluation other = with_band_end(evaluation, end);
    thr_holding found = {0};
    st = thr_holding_stretch(beads, frame, &other.physics, press, limits, &found, more, &why);
    st = take_bound(st, &found, &why, &out->band_beads[THR_ASKED_STRETCH][end], err);
  }

  thr_scratch_free(&own);
  return st;
}

/* Answers what the schedule's tensions hold. Knotted cords are springs, which is a question of its
 * own; else: by what may the tensions be multiplied, and how far can the ends be let down? At last,
 * which load is carried. */
thr_status thr_structure_after(const thr_frame *frame, const thr_cord *cord,
                               const thr_eval_options *options, const thr_limits *limits,
                               thr_eval *out, thr_err *err)
{
  const thr_evaluation *evaluation = &out->record;
  thr_beads beads = {0};
  thr_scratch own = {0};
  thr_err why = {0};
  thr_status st = make_beads(frame, &evaluation->physics, options, &beads, err);
  if (!st) st = set_rises(frame, cord, evaluation, options->strength, &own, &beads, err);

  /* Does the structure stand? With knotted cords: how much must they stretch? */
  const bool knotted = beads.n_rises > 0;
  if (knotted) st = stretch(frame, cord, &beads, limits, out, err);

  /* Without: by what may the tensions be multiplied? */
  if (!st && !knotted) {
    st = hold_state(frame, cord, &beads, LET_DOWN, INFINITY, true, limits, evaluation, &out->after,
                    &why);
    if (st == THR_EINFEASIBLE)
      out->after =
          (thr_holding){.present = true, .lower = INFINITY, .upper = INFINITY, .first_bead = -1};
    st = undecided(st, &why, &out->after, err);

    /* The same at both ends of the band. */
    for (int end = 0; end < 2 && has_bands(evaluation, &beads) && !st; end++)
      st = bound_state(frame, cord, &beads, LET_DOWN, INFINITY, end, limits, evaluation,
                       &out->band_beads[THR_ASKED_AFTER][end], err);
  }

  /* How far can the ends be let down? */
  if (!st && !knotted && out->after.upper <= 1 && beads.n_beads <= BAND_LARGEST)
    st = let_down(frame, cord, &beads, limits, evaluation, &out->let_down, err);

  /* The load. If even tightening knotted cords without a limit leaves the question open, no load is
   * too much as far as can be proved, and what is carried is found with the least tensions. */
  if (!st && options->load)
    st = carry_state(frame, cord, &beads, LET_DOWN, INFINITY, options->load, true, limits,
                     evaluation, &out->after_carries, err);
  if (!st && options->load && knotted && !(options->strength > 0) &&
      out->after_carries.first_bead < 0) {
    beads.n_rises = 0;
    st = carry_state(frame, cord, &beads, LET_DOWN, INFINITY, options->load, true, limits,
                     evaluation, &out->after_carries, err);
    free(out->after_carries.velocity);
    out->after_carries.velocity = NULL;
    out->after_carries.beyond = INFINITY;
  }

  /* What is too much at both ends of the band. */
  for (int end = 0; end < 2 && options->load && isfinite(out->after_carries.beyond) &&
                    has_bands(evaluation, &beads) && !st;
       end++)
    st = bound_carried(frame, cord, &beads, LET_DOWN, INFINITY, options->load, end, limits,
                       evaluation, &out->band_beads[THR_ASKED_CARRIED_AFTER][end], err);

  thr_scratch_free(&own);
  thr_beads_destroy(&beads);
  return st;
}

/* ---- the pull ---- */

/* Computes by what the given tensions, which are those of a pull of 1, may be multiplied: the
 * bounds of the holding pull, N. */
static thr_status hold(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                       bool want_upper, const thr_limits *limits, const thr_evaluation *evaluation,
                       const double *const *tension, thr_holding *out, thr_err *err)
{
  double *press = thr_calloc((size_t)beads->n_faces, sizeof *press);
  if (!press) return thr_nomem(err);

  /* The unknown factor of these tensions is the pull, in N. */
  thr_holding_press(cord, evaluation->n_cords, tension, press);
  thr_status st =
      thr_holding_pull(beads, frame, &evaluation->physics, press, want_upper, limits, out, err);

  free(press);
  return st;
}

/* Computes below which pull, and below which force in any state, nothing holds at friction mu of
 * the cords. Leaves both as they are if the tensions span more than a double holds. Overwrites the
 * record's tensions. */
static thr_status hold_at(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                          double mu, const thr_limits *limits, thr_evaluation *evaluation,
                          const double **tension, double *pull, double *any_state, thr_err *err)
{
  thr_err why = {0};
  thr_holding drawn_in = {0}, kept = {0};
  thr_status st = profiles(frame, cord, mu, evaluation, tension, &why);
  if (st == THR_EINPUT) return THR_OK;

  /* While the cords are drawn in .. */
  if (!st) st = hold(frame, cord, beads, false, limits, evaluation, tension, &drawn_in, &why);
  st = take_bound(st, &drawn_in, &why, pull, err);

  /* .. and in any state that friction keeps. */
  if (!st) st = hold_state(frame, cord, beads, KEPT, 1, false, limits, evaluation, &kept, &why);

  return take_bound(st, &kept, &why, any_state, err);
}

/* Computes the bounds of hold_at on a copy of the record's cords, for one end of the band of mu. */
static thr_status band_end(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                           double mu, const thr_limits *limits, const thr_evaluation *evaluation,
                           double *pull, double *any_state, thr_err *err)
{
  thr_evaluation copy = *evaluation;
  const double **tension = thr_calloc((size_t)evaluation->n_cords, sizeof *tension);

  copy.cord = thr_calloc((size_t)evaluation->n_cords, sizeof *copy.cord);
  thr_status st = tension && copy.cord ? THR_OK : thr_nomem(err);

  /* The copy has tensions of its own and shares the turns with the record. */
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    copy.cord[i] = (thr_eval_cord){.pull = evaluation->cord[i].pull,
                                   .n_passes = evaluation->cord[i].n_passes,
                                   .turn = evaluation->cord[i].turn};
  if (!st) st = hold_at(frame, cord, beads, mu, limits, &copy, tension, pull, any_state, err);

  /* The turns belong to the record, and thr_evaluation_destroy must not free them. */
  free(tension);
  for (int i = 0; i < evaluation->n_cords && copy.cord; i++)
    copy.cord[i].turn = NULL;
  if (copy.cord) thr_evaluation_destroy(&copy);

  return st;
}

/* Computes below which pull nothing holds at one end of the band of the frictions of beads and
 * ground. */
static thr_status hold_beads(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                             int end, const thr_limits *limits, const thr_evaluation *record,
                             const double *const *tension, double *bound, thr_err *err)
{
  thr_err why = {0};
  thr_holding found = {0};
  const thr_evaluation other = with_band_end(record, end);
  const thr_status st = hold(frame, cord, beads, false, limits, &other, tension, &found, &why);
  return take_bound(st, &found, &why, bound, err);
}

/* Names the questions about cords while they are drawn in. Each is a programme of its own, so that
 * threads answer them in parallel. From PULL_BEADS on, each has two: the lower end of the band and
 * the upper one. */
typedef enum {
  PULL,
  EQUAL_PULLS,
  ANY_STATE,
  BAND_LOW,
  BAND_HIGH,
  PULL_BEADS, /* and one more: the upper end */
  EQUAL_BEADS = PULL_BEADS + 2,
  ANY_BEADS = EQUAL_BEADS + 2,
  N_QUESTIONS = ANY_BEADS + 2
} question;

/* Holds the questions of one evaluation and their input; n_answered are done. Answers go to places
 * of their own in `out`. */
typedef struct {
  const thr_frame *frame;
  const thr_cord *cord;
  const thr_beads *beads;
  const double *const *tension;
  thr_eval *out;
  int n_asked;
  question asked[N_QUESTIONS]; /* [n_asked] */
} question_set;

/* Answers one question, for thr_threads_run. */
static thr_status answer(void *user, int job, const thr_limits *limits, thr_err *err)
{
  const question_set *questions = user;
  const thr_evaluation *record = &questions->out->record;
  const int asked = (int)questions->asked[job], end = (asked - PULL_BEADS) % 2;
  double(*band)[2] = questions->out->band_beads;

  /* One programme for each question; `end` says which end of the band. */
  switch (asked) {
  case PULL:
    return hold(questions->frame, questions->cord, questions->beads, true, limits, record,
                questions->tension, &questions->out->holding, err);
  case EQUAL_PULLS:
    return hold_state(questions->frame, questions->cord, questions->beads, DRAWN_IN, 1, true,
                      limits, record, &questions->out->equal, err);
  case ANY_STATE:
    return hold_state(questions->frame, questions->cord, questions->beads, KEPT, 1, true, limits,
                      record, &questions->out->loosest, err);
  case BAND_LOW:
    return band_end(questions->frame, questions->cord, questions->beads, record->physics.mu_low,
                    limits, record, &questions->out->band[0], &questions->out->band_any[0], err);
  case PULL_BEADS:
  case PULL_BEADS + 1:
    return hold_beads(questions->frame, questions->cord, questions->beads, end, limits, record,
                      questions->tension, &band[THR_ASKED_HOLDING][end], err);
  case EQUAL_BEADS:
  case EQUAL_BEADS + 1:
    return bound_state(questions->frame, questions->cord, questions->beads, DRAWN_IN, 1, end,
                       limits, record, &band[THR_ASKED_EQUAL][end], err);
  case ANY_BEADS:
  case ANY_BEADS + 1:
    return bound_state(questions->frame, questions->cord, questions->beads, KEPT, 1, end, limits,
                       record, &band[THR_ASKED_ANY_STATE][end], err);
  default:
    return band_end(questions->frame, questions->cord, questions->beads, record->physics.mu_high,
                    limits, record, &questions->out->band[1], &questions->out->band_any[1], err);
  }
}

/* Turns the profiles of a pull of 1 into tensions, forces and losses at `pull`, N. */
static void fill_record(thr_evaluation *evaluation, double pull)
{
  for (int i = 0; i < evaluation->n_cords; i++) {
    thr_eval_cord *eval_cord = &evaluation->cord[i];

    /* Tensions and forces are proportional to the pull. */
    for (int k = 0; k < eval_cord->n_passes; k++)
      eval_cord->tension[k] *= pull;
    eval_cord->force *= pull;
    eval_cord->other_force *= pull;

    /* What follows from them: work per metre drawn out, and the part of the pull that friction
     * takes. */
    eval_cord->work = eval_cord->force + eval_cord->other_force;
    eval_cord->loss = thr_profile_loss(eval_cord->tension[eval_cord->slackest], eval_cord->force);
    eval_cord->known = true;
  }
}

/* Empties the records of all cords but for their pulls and passes, where nothing is known. */
static void clear_record(thr_evaluation *evaluation)
{
  for (int i = 0; i < evaluation->n_cords; i++) {
    free(evaluation->cord[i].tension);
    free(evaluation->cord[i].exponent);
    free(evaluation->cord[i].turn);
    evaluation->cord[i] =
        (thr_eval_cord){.pull = evaluation->cord[i].pull, .n_passes = evaluation->cord[i].n_passes};
  }
}

/* Returns whether both ends are pulled of every cord that is pulled at all. */
static bool all_both(const thr_evaluation *evaluation)
{
  bool both = true;
  for (int i = 0; i < evaluation->n_cords; i++)
    both &= evaluation->cord[i].pull == THR_PULL_BOTH || evaluation->cord[i].pull == THR_PULL_NONE;
  return both;
}

/* Lists the questions that the size of the structure allows, the most important first. */
static void ask(question_set *questions)
{
  const bool small = questions->beads->n_beads <= BAND_LARGEST,

             equal = small && all_both(&questions->out->record);

  /* The pull, then the states, then the band of mu. */
  questions->asked[questions->n_asked++] = PULL;
  if (equal) questions->asked[questions->n_asked++] = EQUAL_PULLS;
  questions->asked[questions->n_asked++] = ANY_STATE;
  if (small)
    questions->asked[questions->n_asked++] = BAND_LOW,
    questions->asked[questions->n_asked++] = BAND_HIGH;

  /* At last the bands of the frictions of beads and ground. */
  for (int asked = PULL_BEADS;
       asked < N_QUESTIONS && has_bands(&questions->out->record, questions->beads); asked++)
    if (equal || asked < EQUAL_BEADS || asked >= ANY_BEADS)
      questions->asked[questions->n_asked++] = (question)asked;
}

/* Computes the holding pull of the ideal pieces, beside that of those that are made. */
static thr_status hold_ideal(const question_set *questions, const thr_eval_options *options,
                             const thr_limits *limits, thr_err *err)
{
  thr_eval_options ideal = *options;
  thr_eval *out = questions->out;
  thr_beads beads = {0};
  thr_err why = {0};
  ideal.bodies = NULL;
  thr_status st = make_beads(questions->frame, &out->record.physics, &ideal, &beads, &why);
  if (!st)
    st = hold(questions->frame, questions->cord, &beads, true, limits, &out->record,
              questions->tension, &out->ideal, &why);
  if (st == THR_EINFEASIBLE)
    out->ideal = (thr_holding){.present = true, .lower = INFINITY, .upper = INFINITY};
  thr_beads_destroy(&beads);
  return pass_failure(st, &why, err);
}

/* Runs the whole method. The holding pull comes first and the other answers in order of their
 * importance, so that whoever stops the run early has lost least. Threads take them. */
static thr_status analyse(const thr_frame *frame, const thr_cord *cord, const thr_beads *beads,
                          const thr_eval_options *options, const thr_limits *limits,
                          const double **tension, thr_eval *out, thr_err *err)
{
  thr_evaluation *evaluation = &out->record;
  question_set questions = {
      .frame = frame, .cord = cord, .beads = beads, .tension = tension, .out = out};

  /* NAN: not known, as long as the question was not answered. */
  out->band[0] = out->band[1] = out->band_any[0] = out->band_any[1] = NAN;
  for (int i = 0; i < THR_N_ASKED; i++)
    out->band_beads[i][0] = out->band_beads[i][1] = NAN;

  thr_status st = profiles(frame, cord, evaluation->physics.mu, evaluation, tension, err);
  ask(&questions);
  if (!st) st = thr_threads_run(questions.n_asked, answer, &questions, limits, err);

  /* Without the holding pull nothing is known. */
  if (st && !out->holding.present) {
    thr_holding_destroy(&out->loosest); /* of another thread */
    clear_record(evaluation);
    return st;
  }

  /* Then the load. */
  if (!st && options->load) st = carry_at_pulls(frame, cord, beads, options, limits, out, err);
  if (!st && options->bodies) st = hold_ideal(&questions, options, limits, err);

  /* From tensions of a pull of 1 to those of the holding pull. */
  fill_record(evaluation, out->holding.lower);

  return st ? st : thr_structure_drawn(evaluation, options, err);
}

/* Computes the turns of the taut cords in their bores, rad, into the record. */
static thr_status take_taut_turns(const thr_frame *frame, const thr_cord *cord,
                                  const thr_limits *limits, thr_evaluation *evaluation,
                                  thr_err *err)
{
  double **turn = thr_calloc((size_t)evaluation->n_cords, sizeof *turn);
  thr_status st = turn ? thr_taut_turns(frame, cord, evaluation->n_cords, &evaluation->physics,
                                        limits, turn, err)
                       : thr_nomem(err);

  /* The turns belong to the record from here on, even if only some were found. */
  for (int i = 0; i < evaluation->n_cords && turn; i++)
    evaluation->cord[i].turn = turn[i];

  free(turn);
  return st;
}

/* Runs method structure; see eval.h. */
thr_status thr_structure_method(const thr_frame *frame, const thr_cord *cord,
                                const thr_eval_options *options, const thr_limits *limits,
                                thr_eval *out, thr_err *err)
{
  thr_beads beads = {0};
  const double **tension = thr_calloc((size_t)out->record.n_cords, sizeof *tension);

  thr_status st =
      tension ? make_beads(frame, &out->record.physics, options, &beads, err) : thr_nomem(err);
  if (!st && options->taut) st = take_taut_turns(frame, cord, limits, &out->record, err);
  if (!st) st = analyse(frame, cord, &beads, options, limits, tension, out, err);

  thr_beads_destroy(&beads);
  free(tension);
  return st;
}

/* Computes by what an evaluation's tensions must be multiplied at least; see eval.h. */
thr_status thr_eval_holds_from(const thr_frame *frame, const thr_cord *cord,
                               const thr_evaluation *evaluation, const thr_limits *limits,
                               double *times, thr_err *err)
{
  thr_eval_options usual = thr_eval_options_default();
  thr_err why = {0};
  thr_beads beads = {0};
  thr_holding holding = {0};
  usual.clamped = evaluation->standing.clamped;

  /* Larger structures take too long for a question that is asked in passing. */
  *times = NAN;
  if (frame->n_nodes > THR_HOLDS_LARGEST) return THR_OK;

  /* The beads as eval would make them by default, on feet that stand free or are held. */
  thr_status st = make_beads(frame, &evaluation->physics, &usual, &beads, &why);
  double *press = st ? NULL : thr_calloc((size_t)beads.n_faces + 1, sizeof *press);
  if (!st && !press) st = thr_nomem(&why);

  /* What the cords press the faces with as they are; the unknown is the multiple of this. */
  for (int i = 0; i < evaluation->n_cords && !st; i++)
    if (evaluation->cord[i].pull != THR_PULL_NONE)
      thr_holding_press(&cord[i], 1, &(const double *){evaluation->cord[i].tension}, press);

  /* Only a lack of memory or time is a failure; no pull at all is the multiple INFINITY. */
  if (!st)
    st =
        thr_holding_pull(&beads, frame, &evaluation->physics, press, false, limits, &holding, &why);
  if (!st) *times = holding.lower;
  if (st == THR_EINFEASIBLE) *times = INFINITY;

  free(press);
  thr_holding_destroy(&holding);
  thr_beads_destroy(&beads);
  return st == THR_ENOMEM || st == THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
