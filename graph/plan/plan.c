/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what a plan's cords come to: lengths, turning angles, pulls, metrics; copies and
 * releases plans; and says how far a plan is from what is proved.
 *
 * Lengths are in units of the framework, angles in rad. A turn from half-edge `in` to half-edge
 * `out` is the angle between their directions: 0 is straight on, pi a U-turn.
 *
 * Example: a cord around a square turns three times by pi / 2 between its ends, and a fourth time
 * where it closes. */
#include "graph/plan/plan.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_certificate_destroy(thr_certificate *certificate)
{
  for (int i = 0; i < certificate->n_cuts; i++)
    free(certificate->cut[i].node);
  free(certificate->cut);
  free(certificate->place_price);
  *certificate = (thr_certificate){0};
}

void thr_symmetry_record_destroy(thr_symmetry_record *record)
{
  free(record->generator);
  free(record->image);
  free(record->unique);
  free(record->element);
  *record = (thr_symmetry_record){0};
}

void thr_cords_destroy(thr_cord *cord, int n)
{
  for (int i = 0; cord && i < n; i++)
    free(cord[i].half);
  free(cord);
}

thr_status thr_cords_copy(const thr_cord *cord, int n, thr_cord **copy, thr_err *err)
{
  thr_cord *copied = *copy = thr_calloc((size_t)n, sizeof *copied);
  bool complete = copied != NULL;

  /* On failure the arrays that there are must be released. */
  for (int i = 0; i < n && complete; i++) {
    copied[i] = cord[i];
    complete =
        (copied[i].half = thr_calloc((size_t)cord[i].n_passes, sizeof *copied[i].half)) != NULL;
    if (complete)
      memcpy(copied[i].half, cord[i].half, (size_t)cord[i].n_passes * sizeof *copied[i].half);
  }

  /* Without all cords there is no copy. */
  if (complete) return THR_OK;
  thr_cords_destroy(copied, n);
  *copy = NULL;
  return thr_nomem(err);
}

void thr_cords_add_passes(const thr_cord *cord, int n, int by, int *passes)
{
  for (int c = 0; c < n; c++)
    for (int k = 0; k < cord[c].n_passes; k++)
      passes[cord[c].half[k] >> 1] += by;
}

void thr_pull_claim_destroy(thr_pull_claim *claim)
{
  for (int i = 0; i < claim->n_parts; i++)
    thr_pull_claim_destroy(&claim->part[i]);
  free(claim->part);
  thr_turning_proof_destroy(&claim->tree);
  thr_walk_proof_destroy(&claim->walks);
  *claim = (thr_pull_claim){0};
}

bool thr_pull_excludes(const thr_pull_claim *claim)
{
  return claim->excluded > 0;
}

void thr_plan_destroy(thr_plan *plan)
{
  thr_cords_destroy(plan->cord, plan->n_cords);
  for (int i = 0; i < plan->proof.n_certificates; i++)
    thr_certificate_destroy(&plan->proof.certificate[i]);

  /* All other arrays and records. */
  free(plan->proof.certificate);
  thr_turning_proof_destroy(&plan->proof.tied);
  thr_walk_proof_destroy(&plan->proof.walks);
  thr_walk_proof_destroy(&plan->proof.pulled);
  thr_turning_proof_destroy(&plan->turning.tree);
  thr_pull_claim_destroy(&plan->pull_claim);
  thr_symmetry_record_destroy(&plan->symmetry);
  thr_evaluation_destroy(&plan->evaluation);
  free(plan->options.end_node);
  free(plan->options.end_count);
  free(plan->generator);
  thr_frame_destroy(&plan->frame);
  *plan = (thr_plan){0};
}

thr_status thr_plan_request(thr_plan *plan, const thr_frame *frame, const thr_request *options,
                            thr_err *err)
{
  thr_status st = thr_frame_copy(&plan->frame, frame, err);
  if (st) return st;
  size_t n = (size_t)frame->n_nodes;

  /* Arrays by node are copied, the rest of the request is values. */
  plan->options = *options;
  plan->options.end_node = NULL;
  plan->options.end_count = NULL;

  /* Where ends may be, or how many there are. */
  if (options->end_node) {
    if (!(plan->options.end_node = thr_calloc(n, sizeof *plan->options.end_node)))
      return thr_nomem(err);
    memcpy(plan->options.end_node, options->end_node, n * sizeof *plan->options.end_node);
  }

  if (options->end_count) {
    if (!(plan->options.end_count = thr_calloc(n, sizeof *plan->options.end_count)))
      return thr_nomem(err);
    memcpy(plan->options.end_count, options->end_count, n * sizeof *plan->options.end_count);
  }

  return THR_OK;
}

bool thr_plan_take_evaluation(thr_plan *plan, thr_evaluation *evaluation)
{
  /* What an older version has proved within a pull does not hold by the newer definition, which the
   * evaluation uses. */
  const bool outdated = plan->left_out;
  thr_evaluation_destroy(&plan->evaluation);
  plan->evaluation = *evaluation;
  *evaluation = (thr_evaluation){0};
  plan->options.old_pull = plan->left_out = false;

  return outdated;
}

void thr_cord_id(int i, char id[12])
{
  char reversed[12];
  int n = 0;

  /* Digits to base 26 without a zero, the lowest first. */
  for (i++; i > 0; i = (i - 1) / 26)
    reversed[n++] = (char)('A' + (i - 1) % 26);
  for (int k = 0; k < n; k++)
    id[k] = reversed[n - 1 - k];

  id[n] = '\0';
}

int thr_length_proof_cuts(const thr_length_proof *proof)
{
  int cuts = 0;

  /* Certificates have odd cuts; a proof for tube joints has odd sets and junctions. */
  for (int i = 0; i < proof->n_certificates; i++)
    cuts += proof->certificate[i].n_cuts;
  for (int i = 0; i < proof->tied.n_duals; i++)
    cuts += proof->tied.dual[i].n_odd + proof->tied.dual[i].n_junctions;

  return cuts;
}

/* Returns the greatest common divisor of two lengths by Euclid's algorithm, where remainders below
 * `rounding`, or as close to the divisor, count as 0. */
static double common_step(double larger, double smaller, double rounding)
{
  /* A remainder just below the divisor is a multiple that rounding has made smaller. */
  while (smaller > rounding) {
    double rest = fmod(larger, smaller);
    larger = smaller;
    smaller = rest > smaller - rounding ? 0 : rest;
  }

  return larger;
}

/* Computes the greatest common divisor of the lengths, scales it so that the longest edge fits
 * best, and checks that all edges are multiples within 1e-10. */
double thr_plan_unit(const thr_frame *frame)
{
  enum { STEPS_MOST = 1000 };
  double longest = 0, unit = 0;

  /* Rounding is relative to the longest edge. */
  for (int e = 0; e < frame->n_edges; e++)
    longest = fmax(longest, frame->length[e]);

  /* The common divisor of all lengths so far; too small a one means that there is none. */
  for (int e = 0; e < frame->n_edges; e++) {
    unit = common_step(fmax(unit, frame->length[e]), fmin(unit, frame->length[e]), 1e-12 * longest);
    if (unit * STEPS_MOST < longest) return 0;
  }

  /* The longest edge tells the unit with the least relative error; then all others must agree. */
  if (unit > 0) unit = longest / round(longest / unit);
  for (int e = 0; e < frame->n_edges; e++)
    if (fabs(frame->length[e] - unit * round(frame->length[e] / unit)) > 1e-10 * frame->length[e])
      return 0;

  return unit;
}

int thr_cord_start(const thr_frame *frame, const thr_cord *cord)
{
  return thr_tail(frame, cord->half[0]);
}

int thr_cord_end(const thr_frame *frame, const thr_cord *cord)
{
  return thr_head(frame, cord->half[cord->n_passes - 1]);
}

double thr_cord_length(const thr_frame *frame, const thr_cord *cord)
{
  double sum = 0;
  for (int i = 0; i < cord->n_passes; i++)
    sum += frame->length[cord->half[i] >> 1];
  return sum;
}

int thr_cords_passes(const thr_cord *cord, int n)
{
  int passes = 0;
  for (int i = 0; i < n; i++)
    passes += cord[i].n_passes;
  return passes;
}

int thr_plan_components(const thr_plan *plan)
{
  int last = 0;
  for (int i = 0; i < plan->n_cords; i++)
    if (plan->cord[i].component > last) last = plan->cord[i].component;
  return last + 1;
}

double thr_cords_longest(const thr_frame *frame, const thr_cord *cord, int n)
{
  double longest = 0;
  for (int i = 0; i < n; i++)
    longest = fmax(longest, thr_cord_length(frame, &cord[i]));
  return longest;
}

double thr_turn_angle(const thr_frame *frame, int in, int out)
{
  double arriving[3], leaving[3];
  thr_direction(frame, in, arriving);
  thr_direction(frame, out, leaving);
  return thr_angle_between(arriving, leaving);
}

thr_turns thr_turns_begin(const thr_frame *frame, int half)
{
  thr_turns turns = {.frame = frame};
  thr_direction(frame, half, turns.way[0]);
  return turns;
}

double thr_turns_next(thr_turns *turns, int half)
{
  /* The two directions take turns. */
  const double *in = turns->way[turns->last];
  turns->last = 1 - turns->last;
  thr_direction(turns->frame, half, turns->way[turns->last]);
  return thr_angle_between(in, turns->way[turns->last]);
}

/* Sums the angles between consecutive passes, in rad. */
double thr_cord_turning(const thr_frame *frame, const thr_cord *cord, bool with_closure)
{
  double sum = 0;

  if (cord->n_passes == 0) return 0;
  thr_turns turns = thr_turns_begin(frame, cord->half[0]);

  /* Each direction is computed once. */
  for (int i = 0; i + 1 < cord->n_passes; i++)
    sum += thr_turns_next(&turns, cord->half[i + 1]);
  if (with_closure && cord->closed)
    sum += thr_turn_angle(frame, cord->half[cord->n_passes - 1], cord->half[0]);

  return sum;
}

int thr_cord_turns(const thr_request *options, const thr_cord *cord)
{
  return options->ends == THR_ENDS_CLOSED ? cord->n_passes : cord->n_passes - 1;
}

bool thr_cord_runs_round(const thr_plan *plan, const thr_cord *cord)
{
  const thr_request *options = &plan->options;

  /* Ends are free where they may be anywhere and tie nothing; older plans also demanded that the
   * cord does not turn back there. */
  if (!cord->closed || options->ends == THR_ENDS_CLOSED) return cord->closed;
  return options->ends == THR_ENDS_ANY && options->joint == THR_JOINT_SOLID &&
         (plan->symmetry.retraced || cord->half[0] >> 1 != cord->half[cord->n_passes - 1] >> 1);
}

bool thr_turn_over(double turn, double angle)
{
  return turn > angle + 1e-9;
}

int thr_plan_turns_over(const thr_plan *plan, double angle)
{
  int n = 0;

  /* As many turns as count with these ends. */
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];
    for (int k = 0; k < thr_cord_turns(&plan->options, cord); k++)
      n += thr_turn_over(
          thr_turn_angle(&plan->frame, cord->half[k], cord->half[(k + 1) % cord->n_passes]), angle);
  }

  return n;
}

double thr_turns_price(const thr_frame *frame, thr_turn_cost cost, const int *half, int n, int k)
{
  double sum = 0;
  for (int i = 0; i < k; i++)
    sum += thr_turn_price(frame, cost, half[i], half[(i + 1) % n]);
  return sum;
}

double thr_cord_price(const thr_frame *frame, const thr_request *options, const thr_cord *cord)
{
  return thr_turns_price(frame, options->turning.cost, cord->half, cord->n_passes,
                         thr_cord_turns(options, cord));
}

/* Goes along the cord, from turn to turn, to where parting it is best. */
double thr_cord_pulled_turning(const thr_frame *frame, const thr_cord *cord)
{
  thr_least_pull_walk walk = thr_least_pull_begin(thr_cord_turning(frame, cord, false));

  if (cord->n_passes == 0) return 0;
  thr_turns turns = thr_turns_begin(frame, cord->half[0]);

  /* Parted at each turn in succession, until the first part is the larger one. */
  for (int k = 1; k < cord->n_passes; k++)
    if (!thr_least_pull_next(&walk, thr_turns_next(&turns, cord->half[k]))) break;

  return walk.larger;
}

double thr_cords_pulled_turning(const thr_frame *frame, const thr_cord *cord, int n)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = fmax(most, thr_cord_pulled_turning(frame, &cord[i]));
  return most;
}

/* Returns the smaller part of a cord's turning where the cord is parted so that the larger part is
 * `most`, the least possible. Several turns may do; the smallest part of them is taken. */
static double smaller_part(const thr_frame *frame, const thr_cord *cord, double most)
{
  const double whole = thr_cord_turning(frame, cord, false), rounding = 1e-12 * (1 + whole);
  double before = 0, least = INFINITY;

  if (cord->n_passes < 2) return 0;
  thr_turns turns = thr_turns_begin(frame, cord->half[0]);

  /* What is before a turn, and what is after it. */
  for (int k = 1; k < cord->n_passes; k++) {
    const double turn = thr_turns_next(&turns, cord->half[k]), after = whole - before - turn;
    if (fmax(before, after) <= most + rounding) least = fmin(least, fmin(before, after));
    before += turn;
  }

  return fmax(0, least);
}

/* Finds the largest pulled turning, and what is left for the other end of that cord. */
double thr_cords_pulled_turnings(const thr_frame *frame, const thr_cord *cord, int n, double *other)
{
  double most = -1;
  int hardest = 0;
  *other = 0;

  /* Find the cord that is hardest to pull. */
  for (int i = 0; i < n; i++) {
    const double here = thr_cord_pulled_turning(frame, &cord[i]);
    if (here > most) hardest = i;
    most = fmax(most, here);
  }

  /* Of cords that are equally hard the first one counts. */
  if (n > 0) *other = smaller_part(frame, &cord[hardest], most);
  return fmax(0, most);
}

bool thr_cords_within_pull(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                           int n)
{
  /* The planner keeps to a tenth of the checker's tolerance. */
  const double rounding = 1e-10;
  const double most = thr_request_most_pulled(options);
  return isinf(most) || thr_cords_pulled_turning(frame, cord, n) <=
                            most + rounding * (most + 1 / options->physics.mu);
}

/* Counts the edges that as many different cords pass as are asked for. met[n_edges] holds of each
 * edge the number of the last cord over it, from 1, and how many cords there were; zeros to begin
 * with. */
static void measure_distinct(const thr_request *options, const thr_cord *cord, int number,
                             int (*met)[2], thr_metrics *metrics)
{
  for (int i = 0; i < cord->n_passes && options->distinct > 0; i++) {
    int *edge = met[cord->half[i] >> 1];

    /* A second pass of the same cord. */
    if (edge[0] == number) continue;
    edge[0] = number;
    metrics->distinct += ++edge[1] == options->distinct;
  }
}

/* Goes through all passes; a second cord over an edge makes it SEVERAL. */
void thr_cords_only(const thr_frame *frame, const thr_cord *cord, int n, int *only)
{
  enum { NONE = -2, SEVERAL = -1 };

  /* No cord has been seen over any edge. */
  for (int e = 0; e < frame->n_edges; e++)
    only[e] = NONE;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < cord[i].n_passes; k++) {
      int *edge = &only[cord[i].half[k] >> 1];
      *edge = *edge == NONE || *edge == i ? i : SEVERAL;
    }

  /* Edges without a cord have no only cord either. */
  for (int e = 0; e < frame->n_edges; e++)
    if (only[e] == NONE) only[e] = SEVERAL;
}

/* Adds what one cord comes to. */
static void measure_cord(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                         int *passes, thr_metrics *metrics)
{
  double turning = 0;

  /* Length, passes, and the largest number of passes over one edge. */
  metrics->length += thr_cord_length(frame, cord);
  metrics->passes += cord->n_passes;
  for (int i = 0; i < cord->n_passes; i++)
    if (++passes[cord->half[i] >> 1] > metrics->most_passes)
      metrics->most_passes = passes[cord->half[i] >> 1];

  /* Turns; the closing turn of a closed cord counts in its sum even where cords may have ends. */
  thr_turns turns = thr_turns_begin(frame, cord->half[0]);
  for (int i = 0; i < thr_cord_turns(options, cord); i++) {
    int next = cord->half[i + 1 < cord->n_passes ? i + 1 : 0];
    double angle = thr_turns_next(&turns, next);
    if (i + 1 < cord->n_passes || cord->closed) turning += angle;
    if (angle > metrics->worst_turn) metrics->worst_turn = angle;
    if (next == (cord->half[i] ^ 1)) metrics->u_turns++;
  }

  metrics->turning += turning;
  if (turning > metrics->max_turning) metrics->max_turning = turning;
}

/* Adds up the metrics cord by cord, and the overlap edge by edge: the sum of (passes - cover) x
 * length. */
thr_status thr_plan_measure(const thr_frame *frame, const thr_request *options,
                            const thr_cord *cord, int n_cords, thr_metrics *metrics, thr_err *err)
{
  *metrics = (thr_metrics){0};
  int *passes = thr_calloc((size_t)frame->n_edges, sizeof *passes),
      (*met)[2] = thr_calloc((size_t)frame->n_edges, sizeof *met);

  if (!passes || !met) {
    free(passes);
    free(met);
    return thr_nomem(err);
  }

  /* Cords are numbered from 1, because 0 means none in met. */
  for (int i = 0; i < n_cords; i++) {
    measure_cord(frame, options, &cord[i], passes, metrics);
    measure_distinct(options, &cord[i], i + 1, met, metrics);
  }

  /* Extra cord edge by edge, so that the sum is exactly 0 without any. */
  for (int e = 0; e < frame->n_edges; e++) {
    int cover = thr_plan_cover(frame, options, e);
    metrics->base_length += cover * frame->length[e];
    metrics->overlap += (passes[e] - cover) * frame->length[e];
  }

  free(passes);
  free(met);
  return THR_OK;
}

/* Returns the share by which a value is above its bound: 0 if the value is proved to be least,
 * INFINITY if nothing is proved. */
static double gap_of(bool present, bool optimal, double value, double bound)
{
  if (!present) return INFINITY;
  return optimal || value <= bound ? 0 : bound > 0 ? value / bound - 1 : INFINITY;
}

/* Returns the gap of what the request minimizes first. */
double thr_plan_gap(const thr_plan *plan)
{
  const thr_cords_claim *cords = &plan->cords_claim;
  const thr_turning_claim *turning = &plan->turning;
  const thr_length_proof *length = &plan->proof;

  /* The bound that belongs to what is minimized first. */
  if (thr_wants_symmetry(&plan->options)) return INFINITY;
  if (thr_wants_balance(&plan->options))
    return gap_of(cords->present, cords->longest_optimal, cords->longest, cords->longest_bound);

  /* Then the least of length, of the hardest cord, or of all turns. */
  if (thr_wants_length(&plan->options))
    return gap_of(length->present, length->optimal, plan->metrics.length, length->lower_bound);
  if (thr_wants_largest(&plan->options))
    return gap_of(turning->present, turning->largest_optimal, turning->largest,
                  turning->largest_bound);

  return gap_of(turning->present, turning->optimal, turning->price, turning->lower_bound);
}
