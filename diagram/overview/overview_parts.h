/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares what the files of this folder share with each other and with the other folders
 * of diagram/: drawing a scene, pictures of parts of a scene, the names of places and turns, the
 * legend, miniatures, and how cords are tightened. Private to diagram/.
 *
 * The sections are in the order in which a page uses them: a scene is drawn (draw.c), as a whole or
 * as a part (crop.c), with words for what is seen (guide.c) and a key (legend.c). */
#ifndef THR_OVERVIEW_PARTS_H
#define THR_OVERVIEW_PARTS_H

#include "diagram/layout/layout.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- draw.c: Draws a scene as SVG elements, in mm on paper: pads of feet, beads, cords with
 * casings, turns and arrows, ends, names of places and numbers. */

typedef enum {
  THR_DRAW_NOW,     /* in its colour, with arrow and number */
  THR_DRAW_EARLIER, /* grey, below all that are drawn now, without arrow and number */
  THR_DRAW_HIDDEN   /* not at all */
} thr_draw_state;

/* What is known of a piece when a picture is used by whoever threads a plan. */
typedef enum {
  THR_PIECE_PLAIN, /* nothing: pictures of the whole */
  THR_PIECE_LATER, /* it waits: white, its outline dashed */
  THR_PIECE_HELD,  /* it is on a cord: grey */
  THR_PIECE_NEW,   /* it is picked up now: pale yellow, its outline bold */
  THR_PIECE_STATES
} thr_piece_state;

/* How a scene is drawn. {0}: everything, as in the overview. Arrays are borrowed. An S mark is
 * drawn if its cord's first pass is, an E mark if the last one is. */
typedef struct {
  const unsigned char *state; /* [n_passes] thr_draw_state; NULL: all are drawn now */
  const thr_box *
      window; /* in mm of the scene: what lies outside is left out, not cut off; NULL: nothing is */
  bool anonymous; /* no ids and titles: a document may hold several pictures, and ids only once */
  const char
      *colour;    /* of the passes drawn now, all of one cord, in few elements; NULL: their own */
  bool no_pieces; /* the caller draws them and, before them, the pads of feet */
} thr_draw_style;

/* Appends the <style> element for everything below, within elements of a class: "thread" is that of
 * a whole document. */
void thr_draw_css(const thr_scene *scene, const char *scope, thr_text *text);

/* Appends the groups "feet", "pieces", one per cord ("cord-A", with a group "A-17" per pass),
 * "ends", with panels "seams", "places" and "numbers" (see thr_overview_svg). Letters and numbers
 * of a grid only with grid. */
void thr_draw_scene(const thr_scene *scene, const thr_draw_style *style, const thr_box *grid,
                    thr_text *text);

/* Appends the pads of feet alone. */
void thr_draw_feet(const thr_scene *scene, const thr_draw_style *style, thr_text *text);

/* Returns whether letters and numbers of places stand on all four sides of the whole picture. */
bool thr_draw_grid_both(const thr_scene *scene);

/* Append the parts that the legend shows, too, at a point in mm. A mark's ring has a colour of its
 * own; pale: of a copy. */
void thr_draw_mark(const thr_scene *scene, const thr_mark *mark, bool end, bool pale,
                   const char *ring, double x, double y, thr_text *text);
void thr_draw_pill(const thr_scene *scene, const char *number, const char *colour, double x,
                   double y, thr_text *text);
void thr_draw_seam(const thr_scene *scene, const thr_mark *mark, const char *colour,
                   thr_text *text); /* to or from the other panel */
void thr_draw_sharp(const thr_scene *scene, double x, double y,
                    thr_text *text); /* the sign of a sharp turn */
void thr_draw_foot_pad(const thr_scene *scene, double x, double y,
                       thr_text *text); /* under a node that is a foot */

/* Appends pieces in the look of a state: tubes of a width in mm, as lines with round ends, or
 * outlines. data are the path's. Outlines are thr_draw_outline mm wide, or bolder. */
void thr_draw_capsules(const thr_scene *scene, double width, thr_piece_state state,
                       const char *data, thr_text *text);
void thr_draw_outlines(const thr_scene *scene, thr_piece_state state, const char *data,
                       thr_text *text);
double thr_draw_outline(const thr_scene *scene);

/* Appends a small piece in the look of a state, for legends: a box in mm. */
void thr_draw_key(double x, double y, double width, double height, thr_piece_state state,
                  thr_text *text);

/* Appends the attribute that dashes a cord's line; nothing for a full line (NULL). */
void thr_draw_dash(const thr_scene *scene, const double *dash, thr_text *text);

/* ---- crop.c: Pictures for pages: the whole plan or a part of it, at a scale at which nothing is
 * under 7 pt. */

/* Number of scales. */
enum { THR_CROP_SCALES = 20 };

/* Scenes of one plan at a few scales, each made when it is first asked for. */
typedef struct {
  const thr_plan *plan;
  const thr_layout *layout;
  double slender; /* height of the layout over its width, at most 1e6 */
  thr_scene scene[THR_CROP_SCALES];
  bool made[THR_CROP_SCALES];
  thr_text whole[THR_CROP_SCALES]; /* all edges in small (thr_crop_locate), empty until asked for;
                                      owned */
  thr_box whole_paper[THR_CROP_SCALES]; /* where they are */
} thr_crops;

/* Makes crops without a scene. Plan and layout are borrowed and must outlive crops. Release with
 * thr_crops_destroy. */
void thr_crops_make(thr_crops *crops, const thr_plan *p, const thr_layout *l);
void thr_crops_destroy(thr_crops *crops);

/* What a picture shows: passes and pieces in their states (thr_draw_state, thr_piece_state). Arrays
 * are borrowed. */
typedef struct {
  int number;                 /* of the picture, its own in the document */
  const unsigned char *state; /* [n_passes] */
  const unsigned char *piece; /* [pieces]; NULL: all are plain */
  const int *now; /* [n_now] the passes drawn now, in the order of threading; n_now >= 1 */
  int n_now;
  const char *colour; /* of the passes drawn now, "#rrggbb"; NULL: their own */
  bool backward; /* they are threaded against the plan's direction, from the last to the first */
} thr_crop;

/* How it is shown: a window on the scene. */
typedef struct {
  int scale;      /* number of the scene */
  double size[2]; /* mm */
} thr_crop_view;

/* Finds the largest scale at which the passes drawn now fit in room (width and height, mm) with a
 * ring of their neighbours around them, or else the smallest one. The window is at least as large
 * as least, if there is room for that. O(n_now), and O(n log n) the first time. */
thr_status thr_crop_fit(thr_crops *crops, const thr_crop *crop, const double room[2],
                        const double least[2], thr_crop_view *view, thr_err *err) THR_MUST_CHECK;

/* Makes the window larger, as far as there is anything more to show, up to room. */
void thr_crop_fill(const thr_crops *crops, thr_crop_view *view, const double room[2]);

/* Appends the picture with its top left corner at a point of the page: clipped, in a frame, each
 * pass that is drawn now with its number and arrow, names at the places that they come to. It is a
 * group of class "view-NUMBER" and brings its style. shown receives what of the scene the window
 * shows. The layout is in one panel. O(n). */
thr_status thr_crop_draw(thr_crops *crops, const thr_crop *crop, const thr_crop_view *view,
                         const double at[2], thr_box *shown, thr_text *text,
                         thr_err *err) THR_MUST_CHECK;

/* Appends where that is in the whole, within the paper and in its right upper corner: all beads as
 * thin lines or, where these would run together, the area that they cover; the passes drawn now, a
 * frame around what is shown. Needs no states; the picture must have been drawn. O(n) the first
 * time at a scale and place. */
void thr_crop_locate(thr_crops *crops, const thr_crop *crop, const thr_crop_view *view,
                     thr_box shown, thr_box paper, thr_text *text);

/* Appends the whole plan, at the largest scale that fits in the paper, with the numbers that this
 * scale has room for; passes and pieces in their states (NULL: all now; all plain). Brings the
 * style of the document. pitch, mm: it is no larger than that (0: any), and receives its own, so
 * that many pictures of one size are fitted once; NULL: any. O(n log n). THR_ELIMIT if it was
 * interrupted. */
thr_status thr_crop_whole(const thr_plan *p, const thr_layout *l, const unsigned char *state,
                          const unsigned char *piece, thr_box paper, double *pitch,
                          const thr_limits *limits, thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Appends a solid piece alone, as it lies in the picture: its hub at a point of the page, at the
 * largest scale at which it is within room mm of it. *scene receives the scene at that scale,
 * *point the point that is drawn: of a node with two that with more arms. */
thr_status thr_crop_piece(thr_crops *crops, int node, const double at[2], double room,
                          const thr_scene **scene, int *point, thr_text *text,
                          thr_err *err) THR_MUST_CHECK;

/* Places numbers, arrows and names of the passes drawn now where they hide least in a window of the
 * scene; all others have none then (crop_labels.c). */
thr_status thr_crop_label(thr_scene *s, const thr_crop *crop, thr_box window,
                          thr_err *err) THR_MUST_CHECK;

/* Appends the pieces in a window of the scene, in few elements, for pages would take ten times as
 * long with one for each (crop_pieces.c). state: as piece in thr_crop. O(n log n). */
thr_status thr_crop_pieces(const thr_scene *s, const unsigned char *state, const thr_box *window,
                           thr_text *text, thr_err *err) THR_MUST_CHECK;

/* ---- guide.c: What nodes and turns are called for whoever threads a plan, the same in every
 * document. */

/* {0} is valid and empty. Arrays are owned, the frame is borrowed. */
typedef struct {
  const thr_frame *f;
  thr_layout layout;
  thr_places places;
  bool sides; /* have left and right a meaning? Not where the layout shows beads that cross, or is
                 only drawn */
  bool flat;  /* do flat pictures show it as the surface that it is (thr_layout_is_surface), with an
                 outside at every piece of two arms and more? Else it is drawn in space */
  double (*outward)[3]; /* [n_nodes] unit normal towards the viewer of the layout; 0 where none is
                           known */
  char (*label)[THR_LABEL]; /* [n_nodes] the node's place as in the overview; all different, without
                               blanks */
} thr_guide;

/* Lays the framework out as the overview does: as layout, which is copied, or, NULL, as
 * thr_layout_choose. O(n log n). Release with thr_guide_destroy, after a failure too. */
thr_status thr_guide_make(thr_guide *guide, const thr_frame *frame, const thr_layout *layout,
                          thr_err *err) THR_MUST_CHECK;
void thr_guide_destroy(thr_guide *guide);

/* Appends "foot A1 (node 17)": the node's own name where it is called by its place. */
void thr_guide_place(const thr_guide *guide, int v, thr_text *text);

/* Lists the half-edges that leave each node in around[2 * n_edges], as frame->half, but clockwise
 * as seen from outside where that is known, from the one on that points up most nearly in the
 * picture. O(n log n). */
thr_status thr_guide_around(const thr_guide *guide, int *around, thr_err *err) THR_MUST_CHECK;

/* How half-edge out goes on from half-edge in (head(in) = tail(out)). */
typedef enum {
  THR_WAY_STRAIGHT,
  THR_WAY_LEFT, /* as seen from outside, going with the needle */
  THR_WAY_RIGHT,
  THR_WAY_OVER, /* ahead, where the surface bends */
  THR_WAY_TURN, /* to a side that cannot be told */
  THR_WAY_BACK  /* into the same edge */
} thr_way;

/* Returns which way the turn goes. */
thr_way thr_guide_way(const thr_guide *guide, int in, int out);

/* ---- legend.c: What is written around the overview picture: heading, key, one line per cord,
 * scale bar. */

/* Writes the title to show: the given one, or one made from the counts. */
void thr_legend_title(const thr_scene *scene, const char *given, char title[160]);

/* Appends title and explanations within width mm from the left margin x; returns the y below
 * them. */
double thr_legend_heading(const thr_scene *scene, const char *title, double x, double y,
                          double width, thr_text *text);

/* Appends scale bar, key and the lines of the cords; *bottom receives the y below them. */
thr_status thr_legend_foot(const thr_scene *scene, double x, double y, double width, thr_text *text,
                           double *bottom, thr_err *err) THR_MUST_CHECK;

/* Width that the longest line of the legend needs, mm. */
enum { THR_LEGEND_WIDTH = 165 };

/* ---- miniature.c: A plan as small as a stamp: its cords alone, without names and numbers. */

/* Appends the cords in their colours and dashes within a square of `side` mm with its upper left
 * corner at x, y, beads pale below them. layout: of the plan's framework. THR_EINPUT as
 * thr_scene_build. O(passes). */
thr_status thr_miniature_put(const thr_plan *plan, const thr_layout *layout, double x, double y,
                             double side, thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Appends beads and cords of a scene as they lie, in an element or two for each cord. O(passes). */
void thr_miniature_draw(const thr_scene *scene, thr_text *text);

/* ---- tighten.c: How cords are tightened, in words: the steps of a plan's schedule
 * (graph/plan/plan.h), for steps.txt and the booklet. */

/* Appends a step as a sentence: "Cord A, pass 25: grip it between E5 and D5 and draw it from the
 * side of its start, with 15 N; hold it until the next has taken its slack." Places are the
 * guide's. */
void thr_tighten_step(const thr_plan *plan, const thr_guide *guide, const thr_schedule_step *step,
                      thr_text *words);

#endif
