/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints which part of the gaps between pieces is closed by which pull, and by one cord or the
 * other, and from which pull on the pieces may hold.
 *
 * A gap between two pieces is seated when the tensions of all passes through it add up to the
 * seating tension T, N. While all pulled ends are drawn with the same force P, a pass has P times
 * the larger of its losses to the pulled ends, so that a gap is seated from P = T / (sum of these)
 * on (docs/method.md, "Which gaps close when"; thesis, Fig. 22).
 *
 * Seating knows no weight: the limit analysis says by which factor the seating tensions have to be
 * multiplied before anything can hold the pieces while the cords are drawn in.
 *
 * Example: one cord through the 7 x 7 dome seats 25 % of the gaps at 2.255 N, 50 % at 11.5 N, 75 %
 * at 51.85 N, all at 180.7 N. */
#include "cli/print/print.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ALONE = 8 }; /* cords, a line each */

/* Appends, for each cord that is pulled, how many gaps it seats while the others are slack, and the
 * pull that takes, N. pull: room for n_edges values. */
static thr_status put_alone(thr_text *text, const thr_plan *plan, double *pull)
{
  thr_status st = THR_OK;

  for (int i = 0; i < plan->n_cords && !st; i++) {
    int n = 0, seated = 0;
    char force[THR_PLAIN_NUMBER];
    if (plan->evaluation.cord[i].pull == THR_PULL_NONE) continue;

    /* Pulls ascend, and those of gaps that the cord does not seat are INFINITY. */
    st = thr_seating_pulls(&plan->frame, plan->cord, &plan->evaluation, i, pull, &n, NULL);
    while (seated < n && isfinite(pull[seated]))
      seated++;

    thr_text_printf(text, "  cord %s alone, the others slack: %d of %d gaps, the last at %s N\n",
                    plan->cord[i].id, seated, n,
                    thr_plain_number(seated > 0 ? pull[seated - 1] : 0, 4, force));
  }

  return st;
}

/* Appends the pulls from which on a quarter, a half, three quarters and all of the gaps are seated.
 * pull[n]: ascending, N. */
static void put_parts(thr_text *text, const double *pull, int n, double seating)
{
  static const int percent[] = {25, 50, 75, 100};
  char force[THR_PLAIN_NUMBER];
  int said = 0;

  thr_text_printf(text,
                  "gaps seated (pressed by %g N), with equal pulls at all pulled ends:", seating);

  /* A part of n gaps is rounded up to a whole gap. */
  for (size_t k = 0; k < sizeof percent / sizeof *percent; k++) {
    const int needed = (int)(((long)percent[k] * n + 99) / 100);
    if (isfinite(pull[needed - 1]))
      thr_text_printf(text, "%s %d %% at %s N", said++ ? "," : "", percent[k],
                      thr_plain_number(pull[needed - 1], 4, force));
  }

  /* Gaps that no pull seats are passed by slack cords only. */
  if (!isfinite(pull[n - 1]))
    thr_text_printf(text, "%s only slack cords go through the others", said ? ";" : "");
  thr_text_append(text, "\n");
}

void seated_put(thr_text *text, const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const double seating = evaluation->physics.seating;

  if (!evaluation->seated_known) return;

  /* After a schedule there is no pull to ask for: the tensions seat what they seat. */
  if (evaluation->schedule.n > 0) {
    thr_text_printf(text, "gaps seated (pressed by %g N): %.4g %%\n", seating,
                    100 * evaluation->seated);
    return;
  }

  /* All cords together. */
  int n = 0, pulled = 0;
  double *pull = thr_calloc((size_t)plan->frame.n_edges + 1, sizeof *pull);
  for (int i = 0; i < evaluation->n_cords; i++)
    pulled += evaluation->cord[i].pull != THR_PULL_NONE;

  thr_status st = pull ? thr_seating_pulls(&plan->frame, plan->cord, evaluation, -1, pull, &n, NULL)
                       : THR_ENOMEM;

  /* Alone, each cord seats only what it passes itself. */
  if (!st && n > 0) put_parts(text, pull, n, seating);
  if (!st && pulled > 1 && pulled <= MOST_ALONE) st = put_alone(text, plan, pull);
  if (st) text->failed = true;
  free(pull);
}

/* Returns the factor on the pulls below which nothing holds the pieces (thr_eval_holding_factor),
 * on feet that stand free or are held. */
static double compute_holding_factor(thr_text *text, const thr_plan *plan,
                                     const thr_evaluation *evaluation, bool clamped)
{
  double times;
  thr_evaluation standing = *evaluation;
  standing.standing.clamped = clamped;
  if (thr_eval_holding_factor(plan, &standing, &times, NULL)) text->failed = true;
  return times;
}

/* Appends what pieces whose feet are held take, where that is less than `times` the pulls. */
static void put_clamped(thr_text *text, const thr_plan *plan, const thr_evaluation *evaluation,
                        double times)
{
  char force[64];
  if (thr_frame_feet(&plan->frame) == 0) return;

  const double clamped = compute_holding_factor(text, plan, evaluation, true);
  if (!(clamped < 0.99 * times)) return;
  if (clamped > 1)
    thr_text_printf(text, "; with held feet (thread eval --clamp-feet) only from %s",
                    plain_force(clamped * evaluation->largest, force));
  else
    thr_text_append(text,
                    "; with held feet (thread eval --clamp-feet) what seats the cords may do");
}

double seated_put_holding(thr_text *text, const char *label, const thr_plan *plan,
                          const thr_evaluation *evaluation)
{
  const double times = compute_holding_factor(text, plan, evaluation, false),
               largest = evaluation->largest;
  const thr_physics *physics = &evaluation->physics;
  double least = INFINITY;
  char from[THR_PLAIN_NUMBER], to[THR_PLAIN_NUMBER], factor[THR_PLAIN_NUMBER], needed[64];

  /* Beyond some size the programme takes too long for a line in passing. */
  if (plan->frame.n_nodes > THR_HOLDS_LARGEST && plan->options.joint != THR_JOINT_TUBE) {
    thr_text_printf(text,
                    "%swhat holding takes is not computed for more than %d pieces: thread eval "
                    "--method structure\n",
                    label, THR_HOLDS_LARGEST);
    return NAN;
  }

  if (!(times > 1)) return times * largest;

  /* The pulls that seat the cords, as one number if they are one. */
  for (int i = 0; i < evaluation->n_cords; i++)
    if (evaluation->cord[i].pull != THR_PULL_NONE) least = fmin(least, evaluation->cord[i].force);
  thr_plain_newtons(least, from);
  thr_plain_newtons(largest, to);

  thr_text_printf(text, "%sseated by %s%s%s N, but while the cords are drawn in %s hold ", label,
                  from, strcmp(from, to) ? " to " : "", strcmp(from, to) ? to : "",
                  thr_frame_feet(&plan->frame) > 0 ? "the pieces, their feet standing free,"
                                                   : "the pieces, on the lowest of them,");

  /* From which pull on: a factor where the cords need different pulls. */
  if (!isfinite(times))
    thr_text_append(text, "at no pull");
  else if (strcmp(from, to) == 0)
    thr_text_printf(text, "only from %s", plain_force(times * largest, needed));
  else
    thr_text_printf(text, "only from %s times that, %s at the hardest",
                    thr_plain_number(times, 3, factor), plain_force(times * largest, needed));

  /* A proof holds at the frictions that are stated with it. */
  thr_text_printf(
      text, " (proved at frictions of %g bead on bead, %g on the ground, %g of the cord)%s",
      physics->mu_bead, physics->mu_ground, physics->mu,
      !isfinite(times)                   ? ": thread eval --method structure says which give way"
      : times * largest <= thr_hand_most ? ": pull that much"
                                         : ": support the pieces until all knots are tied");
  put_clamped(text, plan, evaluation, times);
  thr_text_append(text, "\n");
  return times * largest;
}

void seated_put_holding_json(thr_writer *writer, const thr_plan *plan,
                             const thr_evaluation *evaluation)
{
  const double times = compute_holding_factor(writer->out, plan, evaluation, false);
  if (isnan(times)) return;
  thr_write_number(writer, "holds_from", times * evaluation->largest);
}
