/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what part of a load the structure carries, in words and as JSON.
 *
 * At a pull of all ends the limit analysis finds two multiples of the load: `carried`, at which an
 * equilibrium exists, and `beyond` (printed "too much"), above which none does, proved by a
 * collapse mechanism. The band gives the second one with mu_bead and mu_ground multiplied by mu_low
 * / mu and by mu_high / mu (docs/method.md, "Pull force").
 *
 * Example, a load of 0.1 N at the apex of the 7 x 7 dome with one cord:
 *
 *      pull (N)     carried    too much    at 0.125    at 0.375  moves first
 *            5       2.189       3.547           0       12.38  A7
 *           10       10.43        12.7       2.724       29.08  A7 */
#include "cli/print/print.h"

#include <math.h>
#include <stdio.h>

/* Appends the multiple that is too much at each end of the band of the frictions of beads and
 * ground; nothing where that was not asked. */
static void put_band(thr_text *text, const double band[2], bool banded)
{
  for (int end = 0; end < 2 && banded; end++)
    if (isnan(band[end]))
      thr_text_append(text, "         -  ");
    else if (isfinite(band[end]))
      thr_text_printf(text, "%10.4g  ", band[end]);
    else
      thr_text_append(text, "      none  ");
}

/* Appends what is carried, what is too much, the band, and the bead that moves first in the
 * collapse. */
static void put_carry(thr_text *text, const thr_frame *frame, const thr_carry *carry,
                      const double band[2], bool banded)
{
  if (carry->first_bead < 0) {
    thr_text_append(text,
                    "not decided: more than cords can tell, or than the solver's numbers can\n");
    return;
  }

  /* beyond 0: without any load there is no equilibrium either. */
  if (carry->beyond > 0 && !isfinite(carry->carried)) {
    thr_text_printf(text, "%10s  ", "none found");
    thr_text_printf(text, isfinite(carry->beyond) ? "%10.4g  " : "      none  ", carry->beyond);
  } else if (carry->beyond > 0)
    thr_text_printf(text, isfinite(carry->beyond) ? "%10.4g  %10.4g  " : "%10.4g        none  ",
                    carry->carried, carry->beyond);
  else
    thr_text_append(text, "does not stand as it is ");

  put_band(text, band, banded);
  thr_text_append_clean(text, frame->name[carry->first_bead]);
  thr_text_append(text, "\n");
}

/* Appends the pull at all ends that carries the whole load, N, and the same at other frictions.
 * loaded: from the proved lower bound to where an equilibrium was found. */
static void put_needed(thr_text *text, const thr_physics *physics, const thr_holding *loaded,
                       const double band[2])
{
  char number[THR_PLAIN_NUMBER], other[THR_PLAIN_NUMBER];
  thr_text_append(text, "\nload           ");

  /* Found, excluded, or neither. */
  if (isfinite(loaded->upper))
    thr_text_printf(
        text, "all of it is carried with %s N at all ends; less than %s N is too little (proved)",
        thr_plain_number(loaded->upper, 4, number), thr_plain_number(loaded->lower, 4, other));
  else if (!isfinite(loaded->lower))
    thr_text_append(text, "no pull carries all of it: something gives way however hard the cords "
                          "are pulled (proved)");
  else
    thr_text_append(text, "whether any pull carries all of it is not decided");

  /* The ends of the band, if both are decided. */
  for (int end = 0; end < 2 && !isnan(band[0]) && !isnan(band[1]); end++) {
    const double times = (end ? physics->mu_high : physics->mu_low) / physics->mu;
    thr_text_printf(text,
                    end ? "; %.3g, %.3g: " : "; with bead on bead %.3g, foot on ground %.3g: ",
                    times * physics->mu_bead, times * physics->mu_ground);
    if (isfinite(band[end]))
      thr_text_printf(text, "%s N", thr_plain_number(band[end], 4, number));
    else
      thr_text_append(text, "no pull does");
  }

  thr_text_append(text, "\n");
}

void load_put(thr_text *text, const thr_plan *plan, const thr_eval *eval)
{
  const thr_frame *frame = &plan->frame;
  const thr_physics *physics = &plan->evaluation.physics;
  bool banded = false;

  /* The columns of the band are there if any point has one. */
  for (int i = 0; i < eval->n_carries; i++)
    banded |= !isnan(eval->carries[i].band_beads[0]) || !isnan(eval->carries[i].band_beads[1]);

  /* First the pull for all of the load. */
  put_needed(text, physics, &eval->loaded, eval->band_beads[THR_ASKED_LOADED]);

  /* Then a table: what is carried at each pull. */
  thr_text_printf(
      text,
      "with equal pulls at all ends, while the cords are drawn in, so many times the load%s:\n",
      banded ? "; at: what is too much with such friction of bead on bead, and of the ground in "
               "proportion"
             : "");
  thr_text_append(text, "  pull (N)     carried    too much  ");

  /* Columns of the band. */
  for (int end = 0; end < 2 && banded; end++) {
    char cell[40];
    snprintf(cell, sizeof cell, "at %.3g",
             physics->mu_bead * (end ? physics->mu_high : physics->mu_low) / physics->mu);
    thr_text_printf(text, "%10s  ", cell);
  }

  thr_text_append(text, "moves first\n");

  for (int i = 0; i < eval->n_carries; i++) {
    thr_text_printf(text, "%10.4g  ", eval->carries[i].pull);
    put_carry(text, frame, &eval->carries[i].carry, eval->carries[i].band_beads, banded);
  }

  /* What is carried with the tensions that a schedule leaves. */
  if (!eval->after.present && !eval->stretch.present) return;
  thr_text_append(text, " afterwards ");
  put_carry(text, frame, &eval->after_carries, eval->band_beads[THR_ASKED_CARRIED_AFTER], banded);
}

/* Writes the values at both ends of the band of the frictions of beads and ground. */
static void put_band_json(thr_writer *writer, const double band[2])
{
  thr_write_array(writer, "band_beads");
  thr_write_number(writer, NULL, band[0]);
  thr_write_number(writer, NULL, band[1]);
  thr_write_close(writer);
}

/* Writes what is carried as members of an open object; null where nothing is decided. */
static void put_members(thr_writer *writer, const thr_frame *frame, const thr_carry *carry,
                        const double band[2])
{
  const bool decided = carry->first_bead >= 0;

  thr_write_number(writer, "carried", decided ? carry->carried : NAN);
  thr_write_number(writer, "too_much", decided ? carry->beyond : NAN);

  /* The bead that moves fastest in the collapse at the bound. */
  if (decided)
    thr_write_string(writer, "first_bead", frame->name[carry->first_bead]);
  else
    thr_write_null(writer, "first_bead");
  put_band_json(writer, band);
}

void load_put_json(thr_writer *writer, const thr_frame *frame, const thr_eval *eval)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, "load");

  /* The pull that carries all of the load. */
  thr_write_number(writer, "needs", eval->loaded.upper);
  thr_write_number(writer, "needs_at_least", eval->loaded.lower);
  put_band_json(writer, eval->band_beads[THR_ASKED_LOADED]);

  /* The table. */
  thr_write_array(writer, "pulls");
  for (int i = 0; i < eval->n_carries; i++) {
    thr_write_object(writer, NULL);
    thr_write_number(writer, "pull", eval->carries[i].pull);
    put_members(writer, frame, &eval->carries[i].carry, eval->carries[i].band_beads);
    thr_write_close(writer);
  }
  thr_write_close(writer);

  if (eval->after.present || eval->stretch.present) {
    thr_write_object(writer, "after");
    put_members(writer, frame, &eval->after_carries, eval->band_beads[THR_ASKED_CARRIED_AFTER]);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}
