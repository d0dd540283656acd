/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws whole plans: the overview page, steps in words, a poster, stills of the structure, the
 * tension plot, and the charts (charts.h).
 *
 * This folder turns a plan into SVG or text for people who thread it. A picture is made in three
 * steps: a layout says where each node goes on paper (diagram/layout), a scene says where
 * everything else goes, in mm (diagram/scene), and the files here write the scene as elements. All
 * of it is deterministic: the same plan and options give the same bytes.
 *
 * Order in which to read the files: svg.c (numbers, words, paths), draw_parts.c and draw.c (a scene
 * as elements), legend.c and overview.c (the page round the drawing), poster.c; crop.c with
 * crop_labels.c and crop_pieces.c (parts of a scene for the pages of a booklet), miniature.c;
 * guide.c, steps.c and tighten.c (words); still.c; chart.c and then tension.c and the charts.
 * overview_parts.h has what these files share with the other folders of diagram/. */
#ifndef THR_OVERVIEW_H
#define THR_OVERVIEW_H

#include "diagram/export/paper.h"
#include "diagram/layout/layout.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- overview.c: The overview page: one SVG picture of all cords of a plan, to be followed with a
 * finger from start to end. */

typedef enum {
  THR_COLOUR_CORD,
  THR_COLOUR_TENSION,
  THR_COLOUR_TURNING,
  THR_N_COLOURS
} thr_overview_colour;

/* Returns "cord", "tension" or "turning". */
const char *thr_overview_colour_name(int c);

typedef struct {
  const char *title; /* NULL or "": "Cord A: 49 pieces, 86 passes"; borrowed */
  double pitch_mm;   /* mm on paper for the median edge, 2 .. 200; 0 = automatic: 24 if the sheet
                        stays within A0 */
  const thr_layout *layout;   /* NULL: thr_layout_choose; borrowed */
  thr_overview_colour colour; /* what colours tell apart; tension needs the plan's evaluation */
  const char *const
      *motion; /* [n_cords] what moves a unique path to a copy: "turned by 90 degrees", or NULL if
                  no motion in space does; NULL: not said; borrowed */
} thr_overview_options;

thr_overview_options thr_overview_options_default(void);

/* Appends the picture to svg. Its size is physical (mm); no text is under 7 pt. Elements: <g
 * id="cord-A"> holds the passes, <g id="A-17"> is pass 17 (counted from 1), "piece-12" is node 12
 * (counted from 0; with tube joints edge 12) with its name in data-piece, "n-A-17" a pass's number.
 * Of more than 20,000 passes these elements are left out, which the heading says, but those of the
 * cords, whose passes are lines; not where turning is shown, which needs each of them. A cord's id
 * is used if it is capital letters only, else the id that its index would have. With turning shown,
 * a pass holds the halves of the turns before and after it as <path class="turn">: the curve with
 * the half lane that follows, and the other half lane; "t-A-17" marks a turn of more than 90
 * degrees to pass 17. Turns that do not count (graph/plan/plan.h) have no colour. Where colours
 * tell the cords apart, copies of a symmetric plan's unique paths are class="copy": pale, thin,
 * without numbers and with few arrows; the legend says how they repeat their path. The same plan
 * and options give the same bytes. THR_EINPUT with the cord and pass for cords that name edges out
 * of range or whose passes do not meet, for a pitch or layout that does not fit, and for colours of
 * tension without an evaluation. O(n log n + pairs of cords that share an edge). svg is unchanged
 * on failure. */
thr_status thr_overview_svg(const thr_plan *plan, const thr_overview_options *options,
                            thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* ---- steps.c: The steps of a plan in words, row by row to be ticked off: each unique path once,
 * then how its copies repeat it. */

/* Appends UTF-8 text of at most 100 columns. Places are called as in the overview. A path is a
 * heading, a line "start at PLACE", a row for every piece that the needle comes to, as
 * thr_pieces_say has it,
 *
 *   [ ]  S  start, pick up L-1 (A7): out to A6
 *   [ ]  4  pick up X-10 (B5): in from A5, out to C5
 *   [ ]  8  through F5, on cord A since its row 3: in from E5, out to G5
 *
 * numbered as the passes are that lead into them; and a line "the needle comes out at PLACE". Long
 * rows go on in indented lines. Copies are a row each, "Cord B: the same, ..", or listed in full if
 * no motion in space makes them. motion: as in thr_overview_options; tolerance: as in
 * thr_pieces_make; layout: as in thr_guide_make. The same plan gives the same bytes. needles: as in
 * thr_pieces_parts; of a cord that is threaded from its fold the rows of the right needle come
 * first, then, after a line, those of the left one. THR_EINPUT for a plan without cords and for
 * cords that do not fit the framework. O(n log n). out is unchanged on failure. */
thr_status thr_steps_text(const thr_plan *plan, const char *const *motion, double tolerance,
                          int needles, const thr_layout *layout, thr_text *out,
                          thr_err *err) THR_MUST_CHECK;

/* ---- poster.c: The overview over several sheets of paper, to be glued together: a poster for the
 * wall behind the table. */

enum { THR_POSTER_PAGES = 100 };

/* Appends a PDF of pages that show the picture in its own size, row by row, each with a strip that
 * the next ones are glued on. overview: of thr_overview_svg. *n receives the number of pages.
 * THR_EINPUT: more than THR_POSTER_PAGES of them. pdf is unchanged on failure. O(pages x bytes). */
thr_status thr_poster_pdf(const thr_text *overview, thr_page_size page, const thr_limits *limits,
                          int *n, thr_text *pdf, thr_err *err) THR_MUST_CHECK;

/* ---- still.c: Still pictures: rigid beads before and after something gave way, or as they come
 * up, side by side. */

/* Beads are a node's arms of square section to the middles of its edges, one side as level as the
 * edge allows. Lengths in units of the framework; everything is borrowed. */
typedef struct {
  const char *id;          /* of the panel's element */
  const char *caption;     /* below it */
  const double (*pose)[7]; /* [n_nodes] where the node is and how its bead is turned: position,
                              quaternion (x y z w) */
} thr_still_panel;

typedef struct {
  const char *title; /* for who puts the panels on a page, as the note */
  const char *note;
  double width;  /* of an arm */
  double ground; /* z of the ground */
  int n_panels;  /* at least 1 */
  const thr_still_panel *panel;
  int first_bead; /* in another colour; -1 = none */
} thr_still;

/* Appends the panels with their captions, two in a row, as large as paper takes with captions of a
 * line: all seen from one side, to one scale, faces shaded and drawn back to front; ends of arms
 * are pale, so that gaps show. What has gone far away from the first panel is cut off at the edge.
 * *bottom receives the y below them, mm. The same input gives the same bytes. THR_EINPUT for poses
 * that are not finite, a width <= 0 or a bead out of range. O(n log n). svg is unchanged on
 * failure.
 */
thr_status thr_still_panels(const thr_frame *frame, const thr_still *still, thr_box paper,
                            double *bottom, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* ---- tension.c: The tension plot: the tension of every pass along every cord. */

typedef struct {
  const char *title; /* NULL or "": "Tension along 3 cords"; borrowed */
  bool passes;       /* x counts passes, else it is distance along the cord */
  /* the same plan at both ends of the band of mu, between which a fan opens; NULL = no fan;
   * borrowed */
  const thr_evaluation *low, *high;
  bool hand;       /* lines at what a hand manages, time after time and at most */
  double strength; /* N, a line at what the cord bears; 0 = none */
} thr_tension_options;

thr_tension_options thr_tension_options_default(void);

/* Most cords that are shown: those with the largest force. */
enum { THR_TENSION_PANELS = 48 };

/* Appends the plot of plan->evaluation to svg: a step per pass, every cord in a panel of its own,
 * all axes alike, logarithmic where the tensions differ by more than a factor of 20. Sizes are
 * physical (mm); no text is under 7 pt. Elements: <g id="cord-A"> holds a cord's line, its pulled
 * ends and its slackest pass, <path id="fan-A"> its fan; cords are called by index as in the
 * overview. Lines of class "hand" and "strength" are drawn where they lie within the axis, which
 * reaches up to the nearest one that is at most 5 times as much as the pull. The same plan and
 * options give the same bytes. THR_EINPUT if the plan has no evaluation, no known cord, or one that
 * does not fit its cords. O(n). svg is unchanged on failure. */
thr_status thr_tension_svg(const thr_plan *plan, const thr_tension_options *options, thr_text *svg,
                           thr_err *err) THR_MUST_CHECK;

/* Checks that the plan's evaluation is there and has a tension per pass of every known cord;
 * THR_EINPUT with advice otherwise. */
thr_status thr_tension_usable(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* Returns what a method's tensions are: "joints measured in simulation, ..". */
const char *thr_tension_method_words(const thr_evaluation *evaluation);

/* ---- motion_picture.c: A motion of a framework of bars, as arrows. */

/* Says what is drawn. All borrowed. */
typedef struct {
  const thr_frame *frame;
  const double (*velocity)[3]; /* [n_nodes] of any scale, not all 0 */
  const bool *held, *cable;    /* [n_nodes], [n_edges]; NULL: none */
  const char *title, *note;
} thr_motion_picture;

/* Appends the picture to svg: <g id="motion"> with the edges, the nodes (squares where they are
 * held) and an arrow for every node that moves. Sizes are physical (mm); no text is under 7 pt. The
 * same input gives the same bytes. THR_EINPUT if nothing moves. svg is unchanged on failure. O(n
 * log n). */
thr_status thr_motion_svg(const thr_motion_picture *what, thr_text *svg,
                          thr_err *err) THR_MUST_CHECK;

/* ---- svg.c: Small pieces of SVG: numbers, text, paths. */

/* Rounds to the two decimals that are printed; the result is never -0. */
double thr_svg_round(double value);

/* Appends the document up to its description, in mm; title and description are escaped. The
 * caller closes it with </svg>. */
void thr_svg_open(thr_text *text, double width, double height, const char *title,
                  const char *description);

/* Appends <text> at the baseline point; attributes is put in as it is ("" for none), e.g. "
 * text-anchor=\"middle\"". */
void thr_svg_text(thr_text *text, double x, double y, double size, const char *attributes,
                  const char *s);

/* Appends the same in lines of at most width mm (estimated for a wide face), broken at spaces, but
 * for "mu = 0.2" and "1 N", and in a name that is too wide behind a slash; returns the y of the
 * next
 * line. */
double thr_svg_wrap(thr_text *text, double x, double y, double size, double width,
                    const char *attributes, const char *words);

/* Append path data: move to a point, a line there, a Bezier curve there with control points a and
 * b. */
void thr_svg_move(thr_text *text, const double at[2]);
void thr_svg_line(thr_text *text, const double at[2]);
void thr_svg_curve(thr_text *text, const double a[2], const double b[2], const double at[2]);

/* Writes a length in the frame's units with about four digits: "2413 mm", "12.35 m". */
void thr_svg_length(double value, const char *units, char text[64]);

/* Writes a force with about three digits: "12.3 N". */
void thr_svg_force(double newton, char text[32]);

/* Lists round values for an axis from low to high, at most `most` (>= 3) of them, ascending;
 * returns their number. Logarithmic (low > 0): powers of ten, with their 2 and 5 fold where these
 * are few; even steps where that leaves fewer than two. */
int thr_svg_ticks(double low, double high, bool logarithmic, int most, double *tick);

#endif
