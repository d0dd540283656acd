/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds welds: sets of beads that held feet wedge, so that they move as one body.
 *
 * Between two beads that are held in place, contact forces may balance each other without any
 * weight or cord, and be arbitrarily large (a self-stress). Faces that a self-stress presses at all
 * of their corners do not move in any mechanism, and carry whatever comes. The beads on both sides
 * of such a face can be taken for one body: no mechanism is lost, and the forces in the programme
 * have bounds again.
 *
 * Finds self-stresses one after the other, welds the faces that they press, and looks again, until
 * nothing more is found.
 *
 * Example: seven pieces in a row, both ends held: one body with the ground. */
#include "eval/structure/blocks.h"

#include <math.h>

/* NOTHING: cost of the hands at which the contact forces balance each other, for every contact, of
 * which each bears 1 on the mean. PRESSED: part of that mean that a pressed corner bears. */
static const double NOTHING = 1e-6, PRESSED = 1e-4;

/* Returns whether the self-stress presses every corner of the face that begins with contact i. */
static bool is_pressed(const thr_blocks *blocks, const thr_blocks_solution *solution, int i)
{
  bool pressed = true;

  /* The normal force of a corner is the sum over its rays, whose normal parts are 1. */
  for (int corner = i; corner < i + thr_beads_corners(blocks->b); corner++) {
    double normal = 0;
    for (int e = 0; e < blocks->b->rays; e++)
      normal += solution->x[corner * blocks->b->rays + e];
    pressed &= normal > PRESSED;
  }

  return pressed;
}

/* Welds the beads of every face that is pressed; returns the number of faces. */
static int weld_pressed(const thr_blocks *blocks, const thr_blocks_solution *solution, int *weld)
{
  int n = 0;
  for (int i = 0; i < blocks->n_contacts && blocks->contact[i].other >= 0;
       i += thr_beads_corners(blocks->b))
    if (is_pressed(blocks, solution, i))
      n += thr_disjoint_join(weld, blocks->contact[i].bead, blocks->contact[i].other);
  return n;
}

/* Returns the number of beads that are held. */
static int count_held(const thr_beads *beads)
{
  int n = 0;
  for (int v = 0; v < beads->n_beads; v++)
    n += beads->fixed[v];
  return n;
}

/* Finds the welds; see blocks.h. */
thr_status thr_welds_find(const thr_blocks *blocks, double widen, const thr_limits *limits,
                          int *weld, thr_err *err)
{
  thr_status st = THR_OK;
  for (int v = 0; v < blocks->b->n_beads; v++)
    weld[v] = v;

  /* All beads can fly apart from a single one that is held: there is no self-stress then. */
  bool more = count_held(blocks->b) > 1;

  while (more && !st) {
    thr_blocks part = *blocks;
    thr_blocks_solution solution = {0};
    part.round = false;
    part.weld = weld;

    /* The structure with the welds so far. */
    st = thr_blocks_make(&part, widen, err);
    if (st) break;
    more = part.n_rows > 0 && part.n_contacts > 0;
    if (more) st = thr_blocks_self_stress(&part, limits, &solution, err);

    /* A self-stress exists if hands need do nothing. */
    more = more && !st && solution.objective < NOTHING * part.n_contacts &&
           weld_pressed(&part, &solution, weld) > 0;

    thr_blocks_solution_destroy(&solution);
    thr_blocks_destroy(&part);
  }

  /* Each bead names the root of its set. */
  for (int v = 0; v < blocks->b->n_beads; v++)
    weld[v] = thr_disjoint_find(weld, v);

  return st;
}
