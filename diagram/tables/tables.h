/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables for preparing and following the work: what each pass does, what to cut, what beads to
 * make, which channels they need.
 *
 * The pictures and sheets of diagram/ show a plan; this room counts and lists it for spreadsheets
 * and other programs, and holds what all documents count alike: how long each cord is cut, how wide
 * beads are bored, which beads are of one kind. Reading order: supplies.h (lengths to cut, bores),
 * kinds.h (which beads are alike), tables.c (the four tables).
 *
 * Tables are appended as CSV after RFC 4180 but with line feeds alone: a row of names first, text
 * with commas, quotes or line breaks in quotes, lengths in units of the framework unless a name
 * says mm. docs/outputs.md explains every column. layout: as in thr_guide_make. The same plan gives
 * the same bytes. Functions return THR_EINPUT for a plan without cords, for cords that do not fit
 * the framework, and for sizes of cord and beads that do not fit it; out is then unchanged. */
#ifndef THR_TABLES_H
#define THR_TABLES_H

#include "diagram/layout/layout.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends a field and a comma: text cleaned of control characters, with an apostrophe before what
 * would be a formula, in quotes where it holds a comma or a quote. */
void thr_table_text(thr_text *out, const char *text);

/* Appends steps.csv: a row per visit to a piece, in the order of thr_steps_text and in its words.
 * tolerance: as in thr_pieces_make; needles: as in thr_cord_folded. O(n log n). */
thr_status thr_table_steps(const thr_plan *plan, double tolerance, int needles,
                           const thr_layout *layout, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* Appends cords.csv, the cut list: a row per cord, with allowances as in diagram/tables/tables.h.
 * motion: as in thr_overview_options; needles: as in thr_cord_folded; working_mm: as in
 * thr_supplies_join. O(n log n). */
thr_status thr_table_cords(const thr_plan *plan, const char *const *motion, int needles,
                           double working_mm, const thr_layout *layout, thr_text *out,
                           thr_err *err) THR_MUST_CHECK;

/* Appends beads.csv, the bead schedule: a row per piece. Kinds as in diagram/scene/pieces.c, bores
 * as in graph/framework/bore.c for as many cords as there are passes. As thr_kinds_find. */
thr_status thr_table_beads(const thr_plan *plan, double tolerance, const thr_layout *layout,
                           thr_text *out, thr_err *err) THR_MUST_CHECK;

/* Appends channels.csv: a row per channel, piece by piece: from which arm to which, for which pass
 * (graph/plan/channels.c). */
thr_status thr_table_channels(const thr_plan *plan, double tolerance, const thr_layout *layout,
                              thr_text *out, thr_err *err) THR_MUST_CHECK;

/* ---- Which edges and which node beads are alike, so that a maker cuts or prints few kinds.
 * Private to diagram/. */

/* Lengths, and points of pieces, that differ by no more are equal unless a tolerance is given: a
 * hundredth of the median edge. */
static const double THR_KINDS_TOLERANCE = 0.01;

/* Node beads with more arms are each a kind of their own. */
enum { THR_KINDS_ARMS = 16 };

/* Numbers the kinds 1, 2, .. by their first edge or node. tolerance in units, 0 = the usual one;
 * either array may be NULL. edge[n_edges]: by length. node[n_nodes]: by the arms of its piece, from
 * the node to the middles of its edges: two beads are of a kind if one can be turned, but not
 * mirrored, so that with two of the arms on each other all arms' tips meet within the tolerance.
 * What is alike is measured against the first of a kind. Edges whose length is not that between
 * their nodes have arms of half that length. O(n log n) but for beads of nearly equal size whose
 * angles differ: these are compared with each other. */
thr_status thr_kinds_find(const thr_frame *frame, double tolerance, int *edge, int *node,
                          thr_err *err) THR_MUST_CHECK;

/* ---- What has to be at hand before threading: how much cord to cut, how wide beads must be bored.
 *
 * Sizes in mm are known if the framework's unit has a length and the physics of the plan is known
 * or can be worked out; else lengths are in units and allowances stay open. Private to diagram/. */

/* Cord and bores of a plan. {0} is valid and empty. Arrays are owned, the plan is borrowed. */
typedef struct {
  const thr_plan *plan;
  int *passes;        /* [n_edges] over it, of all cords */
  double mm;          /* per unit; 0 = sizes in mm are not known */
  double cord;        /* mm, diameter; > 0 if mm is */
  double bore, width; /* mm, of the plan: of channels; of arms or tubes */

  /* Where lengths are joined on (thr_supplies_join); NULL and 0 before. */
  double working; /* mm of cord that is worked with at a time */
  bool *joined;   /* [visits] is a new length joined on when the needle has come so far? */
  int *joins;     /* [n_cords] how often */
  bool late;      /* is some way without a foot longer than a length? */
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
 * is to be built, as a cord that fits its edges is hardly more than a thread. Then the
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

/* Returns the widest bore of all edges that a cord passes, or the narrowest one, in mm rounded up
 * as above; 0 where sizes are not known. */
double thr_supplies_extreme_bore(const thr_supplies *supplies, bool narrowest);

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

/* A maker who works with lengths of a cord joins a new one at the last foot that a length reaches,
 * where a knot keeps no faces apart. Each length has a tail and a knot at both of its ends, so that
 * every join takes two tails and two knots. Unless asked otherwise, the length is somewhat more
 * than both arms reach, or as many interfaces of the usual size as a page of steps has rows: with
 * pieces of metres, that one walks along, less would be knots rather than cord. */
static const double THR_SUPPLIES_WORKING = 2000; /* mm */
enum { THR_SUPPLIES_WORKING_EDGES = 24 };

/* Finds where lengths are joined on: working, joined, joins and late. part[n_parts] and
 * visit[n_visits]: as of thr_pieces_follow; solid: as in thr_pieces; working_mm: mm, 0 = the usual
 * length. Without sizes in mm nothing is joined. On failure supplies is to be destroyed as ever.
 * O(visits + edges log edges). */
thr_status thr_supplies_join(thr_supplies *supplies, bool solid, const thr_part *part, int n_parts,
                             const thr_visit *visit, int n_visits, double working_mm,
                             thr_err *err) THR_MUST_CHECK;

/* How a cut length adds up, in units. Where sizes in mm are not known, all but length is 0. */
typedef struct {
  double length;
  double tails, knots, turns; /* of both ends; of all turns */
  double joins;               /* tails and knots of all joins (thr_supplies_join) */
  double cut;                 /* all of these */
} thr_cut_length;

/* Returns how much of cord c to cut, in all of its lengths. */
thr_cut_length thr_supplies_cut(const thr_supplies *supplies, int c);

/* Returns the tail that is left at each end of a cord, mm: to hold it by and for the knot; without
 * the knot where the cord's size in mm is not known. */
double thr_supplies_tail(const thr_supplies *supplies);

/* Adds to visits[n_nodes] how often cords run through each node, start or end in it. */
void thr_supplies_visits(const thr_plan *p, int *visits);

#endif
