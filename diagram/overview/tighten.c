/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says in words how cords are tightened: the steps of a plan's schedule (graph/plan/plan.h),
 * for steps.txt and the booklet.
 *
 * A schedule is a list of deeds: pull an end with a force (N), grip a pass and draw the cord from
 * one side or both, let an end down to a smaller force, tie a knot. Friction keeps what a pull at
 * the end does not reach, so a long cord is drawn in pass by pass.
 *
 * Example: "Cord A, pass 25: grip it between E5 and D5 and draw it from the side of its start, with
 * 15 N; hold it until the next has taken its slack." */
#include "diagram/overview/overview_parts.h"
#include "diagram/overview/overview.h"
#include "graph/plan/physics.h"

/* Appends the end or ends of a step by name and place: "its start, at A3", "both ends, at A3 and
 * C1". */
static void put_ends(const thr_plan *plan, const thr_guide *guide, const thr_schedule_step *step,
                     thr_text *words)
{
  const thr_cord *cord = &plan->cord[step->cord];
  const char *start = guide->label[thr_cord_start(&plan->frame, cord)],
             *end = guide->label[thr_cord_end(&plan->frame, cord)];

  /* A closed cord has both ends in one place. */
  if (step->end == THR_PULL_BOTH && cord->closed)
    thr_text_printf(words, "both ends, at %s", start);
  else if (step->end == THR_PULL_BOTH)
    thr_text_printf(words, "both ends, at %s and %s", start, end);
  else
    thr_text_printf(words, "its %s, at %s", thr_pull_name(step->end),
                    step->end == THR_PULL_START ? start : end);
}

/* Appends what is gripped and from which side the cord is drawn there. */
static void put_grip(const thr_plan *plan, const thr_guide *guide, const thr_schedule_step *step,
                     thr_text *words)
{
  const int half = plan->cord[step->cord].half[step->pass];
  char force[32];
  thr_svg_force(step->force, force);

  /* The pass by its number and by the places at both ends. */
  thr_text_printf(words, ", pass %d: grip it between %s and %s and draw it from ", step->pass + 1,
                  guide->label[thr_tail(&plan->frame, half)],
                  guide->label[thr_head(&plan->frame, half)]);

  if (step->end == THR_PULL_BOTH)
    thr_text_append(words, "both sides");
  else
    thr_text_printf(words, "the side of its %s", thr_pull_name(step->end));

  thr_text_printf(words, ", with %s; hold it until the next has taken its slack.", force);
}

/* Appends one step as a sentence. */
void thr_tighten_step(const thr_plan *plan, const thr_guide *guide, const thr_schedule_step *step,
                      thr_text *words)
{
  static const char *const verb[THR_N_DEEDS] = {
      [THR_DEED_PULL] = ": pull ", [THR_DEED_RELEASE] = ": let down ", [THR_DEED_KNOT] = ": tie "};
  char force[32];

  /* The cord, which may have nothing to be done to it. */
  thr_text_printf(words, "Cord %s", plan->cord[step->cord].id);
  if (step->deed == THR_DEED_NONE) {
    thr_text_append(words, ": leave it slack.");
    return;
  }

  /* Grips name a pass, all other deeds an end. */
  if (step->deed == THR_DEED_GRIP) {
    put_grip(plan, guide, step, words);
    return;
  }

  /* What is done to which end, and the force if there is one. */
  thr_text_append(words, verb[step->deed]);
  put_ends(plan, guide, step, words);
  thr_svg_force(step->force, force);
  if (step->deed == THR_DEED_PULL) thr_text_printf(words, ", with %s.", force);
  if (step->deed == THR_DEED_RELEASE) thr_text_printf(words, ", to %s.", force);
  if (step->deed == THR_DEED_KNOT) thr_text_append(words, ".");
}
