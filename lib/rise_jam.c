/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds why a structure did not come up, and what may help (rise_pieces.h).
 *
 * What is measured is the moment when the hands stop: which faces are open, on which cord, and what
 * tension friction leaves of the pull in the slackest of their passes. Three causes can be told
 * apart by that:
 *
 * - pieces are too heavy: less tension is left than a piece weighs;
 * - the pull is lost on the way: less is left than a part LOST of it, as friction takes more of it
 *   the more a cord turns, and cords in open faces turn more than in closed ones;
 * - faces have met askew, or lean on other pieces, and friction holds them so.
 *
 * Example: a geodesic dome of 26 pieces, 200 mm wide, on 4 cords has 31 of 71 faces open at 50 N,
 * of which 3 N are left in the middle of cord B. On 8 cords it comes up at 37 N, on 4 at 340 N;
 * from a heap 5 faces close. */
#include "lib/rise_pieces.h"

#include <math.h>

static const double LOW = 0.8;  /* of the height: what is lower lies or leans */
static const double LOST = 0.1; /* of the pull, that is left in open faces: on recommended cords a
                                   fifth is left when all is closed */

const char *thr_rise_remedy_words(thr_rise_remedy remedy)
{
  static const char *const words[] = {
      "lighter pieces, by narrower arms or a smaller framework",
      "a hand that carries a piece up meanwhile",
      "more cords, each of which turns less",
      "more pull than that",
      "shaking the ground while the pull is held",
      "another disorder at the start",
      "pieces that are laid flat at the start",
  };
  return words[remedy];
}

/* Sets what may help, the likeliest first. each: N that a piece weighs. */
static void find_remedies(const thr_rise_record *record, const thr_rise_options *options,
                          double each, thr_rise_jam *jam)
{
  const bool heavy = jam->tension < each, lost = jam->tension < LOST * jam->pull;
  const bool low = record->moment[record->held - 1].height < LOW * record->drawn_height ||
                   2 * record->most_closed < record->n_counted;
  const struct {
    bool wanted;
    thr_rise_remedy remedy;
  } row[] = {
      {heavy, THR_RISE_LIGHTER},
      {options->start == THR_RISE_HEAP, THR_RISE_LAY_FLAT},
      {lost && !heavy, THR_RISE_MORE_CORDS},
      {low && !(options->lift > 0), THR_RISE_CARRY},
      {!heavy && !low, THR_RISE_MORE_PULL},
      {!heavy && !lost && !(options->shaken > 0), THR_RISE_SHAKE},
      {options->start != THR_RISE_SHAPE, THR_RISE_ANOTHER_SEED},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row && jam->n < THR_RISE_MOST_REMEDIES; i++)
    if (row[i].wanted) jam->remedy[jam->n++] = row[i].remedy;
}

bool thr_rise_jam_find(const thr_rise_pieces *pieces, const thr_rise_record *record,
                       const thr_rise_options *options, thr_rise_jam *jam)
{
  const thr_rise_structure *structure = &pieces->made.structure;
  *jam = (thr_rise_jam){0};
  if (record->held == 0 || !record->tension || options->schedule) return false;

  const double *tension = record->tension + (size_t)(record->held - 1) * (size_t)record->n_passes;
  jam->tension = INFINITY;
  for (int c = 0, i = 0; c < structure->n_cords; c++) {
    int on_cord = 0;
    for (int k = 0; k < structure->cord[c].n_passes; k++, i++) {
      if (!record->open[i]) continue;
      jam->tension = fmin(jam->tension, tension[i]);
      on_cord++;
    }
    jam->open += on_cord;
    if (on_cord > jam->on_cord) jam->cord = c;
    if (on_cord > jam->on_cord) jam->on_cord = on_cord;
  }
  if (jam->open == 0) return false;

  for (int p = 0; p < structure->n_pieces; p++)
    if (structure->piece[p].centre[2] > structure->piece[jam->top].centre[2]) jam->top = p;
  jam->pull = record->moment[record->held - 1].pull;
  find_remedies(record, options, record->weight / record->n_pieces, jam);
  return true;
}
