/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what `thread eval` found of a plan as a JSON object.
 *
 * Member "evaluation" is the one that `-o` keeps in the plan (graph/plan/evaluation.h); beside it
 * stands what a plan does not keep: bands, errors, bounds of the limit analysis, and loads. Forces
 * are in N, angles in rad, lengths in mm where the name ends in _mm; what is not known is null. */
#include "cli/print/print.h"

/* Writes the name of a bead, or null if there is none (-1). */
static void put_bead(thr_writer *writer, const char *key, const thr_frame *frame, int bead)
{
  if (bead >= 0)
    thr_write_string(writer, key, frame->name[bead]);
  else
    thr_write_null(writer, key);
}

/* Writes the values at both ends of a band of friction. */
static void put_json_band(thr_writer *writer, const char *key, const double band[2])
{
  thr_write_array(writer, key);
  thr_write_number(writer, NULL, band[0]);
  thr_write_number(writer, NULL, band[1]);
  thr_write_close(writer);
}

/* Writes the bounds of one answer of the limit analysis: below `lower` nothing holds the structure
 * (proved), at `upper` an equilibrium was found. when: in which state of the cords. */
static void put_json_holding(thr_writer *writer, const thr_frame *frame, const char *key,
                             const thr_holding *holding, const double band[2], const char *when)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, key);
  thr_write_number(writer, "lower", holding->lower);
  thr_write_number(writer, "upper", holding->upper);
  thr_write_number(writer, "residual", holding->residual);

  /* What gives way first just below the lower bound. */
  put_bead(writer, "first_bead", frame, holding->first_bead);
  if (band) put_json_band(writer, "band_beads", band);
  thr_write_string(writer, "holds", when);
  thr_write_close(writer);
}

/* Writes the answers of the limit analysis, each with its band over the frictions of beads and
 * ground. */
static void put_json_answers(thr_writer *writer, const thr_frame *frame, const thr_eval *eval)
{
  const double(*band)[2] = eval->band_beads;

  put_json_holding(writer, frame, "holding", &eval->holding, band[THR_ASKED_HOLDING],
                   "while the cord is being drawn in");

  /* While the cords are drawn in, and in any state. */
  if (eval->equal.present)
    put_json_holding(writer, frame, "equal_pulls", &eval->equal, band[THR_ASKED_EQUAL],
                     "while the cord is being drawn in, with equal pulls at all ends");
  if (eval->loosest.present)
    put_json_holding(writer, frame, "any_state", &eval->loosest, band[THR_ASKED_ANY_STATE],
                     "force at all ends, whatever was done to the cords before");

  /* After a schedule. */
  if (eval->stretch.present)
    put_json_holding(writer, frame, "stretch", &eval->stretch, band[THR_ASKED_STRETCH],
                     "N m by which the tension of knotted cord grows, times its length");
  if (!eval->after.present) return;
  put_json_holding(writer, frame, "after", &eval->after, band[THR_ASKED_AFTER],
                   "factor on the tensions that the schedule leaves");
  thr_write_number(writer, "let_down", eval->let_down);
}

/* Writes how far the farthest piece can shift, as its bores are wider than the cord. */
static void put_json_play(thr_writer *writer, const thr_plan *plan)
{
  thr_play play;

  if (thr_play_find(&plan->frame, &plan->evaluation.physics, &play, NULL)) {
    writer->out->failed = true;
    return;
  }

  thr_write_line(writer, 1);
  thr_write_object(writer, "play");
  thr_write_number(writer, "gap_mm", play.gap);
  put_bead(writer, "piece", &plan->frame, play.piece);
  thr_write_int(writer, "gaps", play.gaps);

  /* If all gaps between the piece and the nearest foot add up. */
  thr_write_number(writer, "most_mm", play.most);
  thr_write_close(writer);
}

/* Writes why turns were not measured, and how good the interpolation is. */
static void put_json_joints(thr_writer *writer, const thr_eval *eval)
{
  thr_write_int(writer, "refused_sharp", eval->refused_sharp);
  thr_write_int(writer, "refused_unsettled", eval->refused_unsettled);
  thr_write_int(writer, "refused_outside", eval->refused_outside);
  thr_write_line(writer, 1);
  thr_write_object(writer, "joints");
  thr_write_int(writer, "unsettled", eval->joints_unsettled);
  thr_write_number(writer, "interpolation", eval->interpolation);
  thr_write_close(writer);
}

void eval_put_json(thr_text *text, const eval_view *view, const thr_plan *plan,
                   const thr_eval *eval)
{
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);
  thr_write_hash(&writer, "framework", thr_frame_hash(&plan->frame));
  thr_write_bool(&writer, "complete", eval->complete && !view->stopped);
  thr_evaluation_write(&plan->evaluation, &writer, "evaluation");
  thr_write_line(&writer, 1);

  /* The band of mu, and the error of measured pulls. */
  put_json_band(&writer, "band", eval->band);
  thr_write_number(&writer, "error", eval->error);
  thr_write_int(&writer, "refused", eval->refused);
  if (eval->complete) seated_put_holding_json(&writer, plan, &plan->evaluation);

  /* What one method alone says. */
  if (plan->evaluation.method == THR_JOINT) put_json_joints(&writer, eval);

  /* Limit analysis. */
  if (eval->holding.present) {
    thr_write_line(&writer, 1);
    put_json_band(&writer, "band_any_state", eval->band_any);
    put_json_band(&writer, "band_beads", eval->band_beads[THR_ASKED_HOLDING]);
  }

  if (eval->holding.present) put_json_answers(&writer, &plan->frame, eval);
  if (view->pieces) {
    thr_write_line(&writer, 1);
    thr_write_object(&writer, "pieces");
    thr_write_string(&writer, "as", "printed (kit)");
    thr_write_string(&writer, "profile", view->pieces);
    thr_write_close(&writer);
    if (eval->ideal.present)
      put_json_holding(&writer, &plan->frame, "ideal_pieces", &eval->ideal, NULL,
                       "while the cord is being drawn in, with ideal pieces");
  }
  if (eval->holding.present) put_json_play(&writer, plan);

  if (eval->n_carries) load_put_json(&writer, &plan->frame, eval);
  answer_put_files(&writer);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}
