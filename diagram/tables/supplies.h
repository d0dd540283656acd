/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What has to be at hand before threading: how much cord to cut, how wide beads must be bored.
 *
 * Sizes in mm are known if the framework's unit has a length and the physics of the plan is known
 * or can be worked out; else lengths are in units and allowances stay open. Private to diagram/. */
#ifndef THR_SUPPLIES_H
#define THR_SUPPLIES_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Cord and bores of a plan. {0} is valid and empty. The array is owned, the plan is borrowed. */
typedef struct {
  const thr_plan *plan;
  int *passes; /* [n_edges] over it, of all cords */
  double mm;   /* per unit; 0 = sizes in mm are not known */
  double cord; /* mm, diameter; > 0 if mm is */
  double bore; /* mm, of the plan */
} thr_supplies;

/* Counts passes; THR_EINPUT for a plan without cords and for cords that do not fit the framework.
 * Release with thr_supplies_destroy, after a failure too. O(passes). */
thr_status thr_supplies_make(thr_supplies *supplies, const thr_plan *p,
                             thr_err *err) THR_MUST_CHECK;
void thr_supplies_destroy(thr_supplies *supplies);

/* Finds mm, cord and bore: as the plan was evaluated, else as asked for, else worked out from the
 * framework. Where nothing was asked, a framework whose size is not known, or is no bead's, leaves
 * them open. THR_EINPUT for sizes that do not fit the framework. */
thr_status thr_supplies_find_sizes(thr_supplies *supplies, thr_err *err) THR_MUST_CHECK;

/* Returns whether cord and bores were worked out from a framework that is hardly the size of what
 * is to be built: a cord thinner than any thread, or thicker than a rope that a hand threads. Then
 * line asks for the size. False where sizes are not known or were given. */
bool thr_supplies_doubt(const thr_supplies *supplies, char line[160]);

/* Return the bore of edge e as it is printed, and the widest bore of node v, in cord diameters:
 * that of the plan (as evaluated or asked for, else THR_BORE_CORDS), or wider where the passes need
 * more to be drawn with ease (thr_bore_clear); 0 without a pass. */
double thr_supplies_bore(const thr_supplies *supplies, int e);
double thr_supplies_node_bore(const thr_supplies *supplies, int v);

/* Returns a bore of so many cord diameters in mm, rounded up to hundredths: a hundredth of a mm too
 * narrow is too narrow. 0 if sizes in mm are not known. */
double thr_supplies_bore_mm(const thr_supplies *supplies, double cords);

/* What is cut beside the way through the middles of the beads:
 *
 * At each of a cord's two ends (a closed cord has two, as well) a tail to hold and pull: six inches
 * are what bead weavers leave to tie and weave in. And a knot: a tight overhand knot takes up at
 * least 16.4 diameters of cord (V. Katritch et al., "Geometry and physics of knots", Nature 384,
 * 1996: 16.33 for the ideal trefoil, later computed as 16.37).
 *
 * In turns, beside other cords, a cord may lie at the outer wall of its bores all along: a line at
 * a distance r beside another one is longer by exactly r times the angle (rad) by which both turn,
 * here r = (bore - cord) / 2. */
static const double THR_SUPPLIES_TAIL = 150;  /* mm */
static const double THR_SUPPLIES_KNOT = 16.4; /* cord diameters */

/* How a cut length adds up, in units. Where sizes in mm are not known, all but length is 0. */
typedef struct {
  double length;
  double tails, knots, turns; /* of both ends; of all turns */
  double cut;                 /* all of these */
} thr_cut_length;

/* Returns how much of cord c to cut. */
thr_cut_length thr_supplies_cut(const thr_supplies *supplies, int c);

/* Adds to visits[n_nodes] how often cords run through each node, start or end in it. */
void thr_supplies_visits(const thr_plan *p, int *visits);

#endif
