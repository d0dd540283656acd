/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Welds: what held feet wedge. Private to the limit analysis.
 *
 * Between two beads that are held in place, contact forces may balance each other without any
 * weight or cord, and be as large as one likes (a self-stress). Faces that such forces press
 * everywhere do not move, in any mechanism, and carry whatever comes: their beads are one body.
 * Taken for that, nothing is lost, and the numbers of what is left have bounds again.
 *
 * Example: seven pieces in a row, both ends held: one body with the ground.
 *
 * Finds self-stresses one after the other, welds what they press, and looks again, until nothing
 * more is found. */
#include "eval/structure/blocks.h"

#include "graph/disjoint.h"

#include <math.h>

/* What hands still do for all contacts, of which each bears 1 on the mean, where they need do
 * nothing; the part of that mean that a pressed corner bears. */
static const double NOTHING = 1e-6, PRESSED = 1e-4;

/* Tells whether the self-stress presses every corner of the face that begins with contact i. */
static bool is_pressed(const thr_blocks *s, const thr_blocks_solution *o, int i)
{
  bool pressed = true;
  for (int corner = i; corner < i + THR_CORNERS; corner++) {
    double normal = 0;
    for (int e = 0; e < s->b->rays; e++)
      normal += o->x[corner * s->b->rays + e];
    pressed &= normal > PRESSED;
  }
  return pressed;
}

/* Welds the beads of every face that is pressed; returns the number of faces. */
static int weld_pressed(const thr_blocks *s, const thr_blocks_solution *o, int *weld)
{
  int n = 0;
  for (int i = 0; i < s->n_contacts && s->contact[i].other >= 0; i += THR_CORNERS)
    if (is_pressed(s, o, i)) n += thr_disjoint_join(weld, s->contact[i].bead, s->contact[i].other);
  return n;
}

static int count_held(const thr_beads *beads)
{
  int n = 0;
  for (int v = 0; v < beads->n_beads; v++)
    n += beads->fixed[v];
  return n;
}

thr_status thr_welds_find(const thr_blocks *s, double widen, const thr_limits *limits, int *weld,
                          thr_err *err)
{
  thr_status st = THR_OK;
  for (int v = 0; v < s->b->n_beads; v++)
    weld[v] = v;

  /* All beads can fly apart from a single one that is held: then there is no self-stress. */
  bool more = count_held(s->b) > 1;
  while (more && !st) {
    thr_blocks part = *s;
    thr_blocks_solution o = {0};
    part.round = false;
    part.weld = weld;
    st = thr_blocks_make(&part, widen, err);
    if (st) break;
    more = part.n_rows > 0 && part.n_contacts > 0;
    if (more) st = thr_blocks_self_stress(&part, limits, &o, err);
    more =
        more && !st && o.objective < NOTHING * part.n_contacts && weld_pressed(&part, &o, weld) > 0;
    thr_blocks_solution_destroy(&o);
    thr_blocks_destroy(&part);
  }
  for (int v = 0; v < s->b->n_beads; v++)
    weld[v] = thr_disjoint_find(weld, v);
  return st;
}
