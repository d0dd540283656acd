/* Draws a scene as SVG elements, in mm on paper: pads of feet, beads, cords with casings, turns and arrows, ends, names of places
 * and numbers. All of it for the overview; for a page about some passes the same scene with a state per pass. Private to
 * diagram/. */
#ifndef THR_DRAW_H
#define THR_DRAW_H

#include "diagram/scene/boxes.h"
#include "diagram/scene/scene.h"
#include "graph/text.h"

typedef enum {
  THR_DRAW_NOW,     /* in its colour, with arrow and number */
  THR_DRAW_EARLIER, /* grey, below all that are drawn now, without arrow and number */
  THR_DRAW_HIDDEN   /* not at all */
} thr_draw_state;

/* What is known of a piece when a picture is used. */
typedef enum {
  THR_PIECE_PLAIN, /* nothing: pictures of the whole */
  THR_PIECE_LATER, /* it waits: white, its outline dashed */
  THR_PIECE_HELD,  /* it is on a cord: grey */
  THR_PIECE_NEW,   /* it is picked up now: pale yellow, its outline bold */
  THR_PIECE_STATES
} thr_piece_state;

/* {0}: everything, as in the overview. Arrays are borrowed. An S mark is drawn if its cord's first pass is, an E mark if the last
 * one is. */
typedef struct {
  const unsigned char *state; /* [n_passes] thr_draw_state; NULL: all are drawn now */
  const thr_box *window;      /* in mm of the scene: what lies outside is left out, not cut off; NULL: nothing is */
  bool anonymous;             /* no ids and titles: a document may hold several pictures, and ids only once */
  const char *colour;         /* of the passes drawn now, all of one cord, in few elements; NULL: their own */
  bool no_pieces;             /* the caller draws them and, before them, the pads of feet */
} thr_draw_style;

/* Appends the <style> element for everything below, within elements of a class: "thread" is that of a whole document. */
void thr_draw_css(const thr_scene *scene, const char *scope, thr_text *text);

/* Appends the groups "feet", "pieces", one per cord ("cord-A", with a group "A-17" per pass), "ends", with panels "seams",
 * "places" and "numbers" (see thr_overview_svg). Letters and numbers of a grid only with grid. */
void thr_draw_scene(const thr_scene *scene, const thr_draw_style *style, const thr_box *grid, thr_text *text);

/* Appends the pads of feet alone. */
void thr_draw_feet(const thr_scene *scene, const thr_draw_style *style, thr_text *text);

/* Are letters and numbers of places wanted on all four sides of the whole picture? */
bool thr_draw_grid_both(const thr_scene *scene);

/* Parts that the legend shows, too. A mark's ring has a colour of its own; pale: of a copy. */
void thr_draw_mark(const thr_scene *scene, const thr_mark *mark, bool end, bool pale, const char *ring, double x, double y,
                   thr_text *text);
void thr_draw_pill(const thr_scene *scene, const char *number, const char *colour, double x, double y, thr_text *text);
void thr_draw_seam(const thr_scene *scene, const thr_mark *mark, const char *colour,
                   thr_text *text);                                                 /* to or from the other panel */
void thr_draw_sharp(const thr_scene *scene, double x, double y, thr_text *text);    /* the sign of a sharp turn */
void thr_draw_foot_pad(const thr_scene *scene, double x, double y, thr_text *text); /* under a node that is a foot */

/* Appends pieces in the look of a state: tubes of a width in mm, as lines with round ends, or outlines. data are the path's.
 * Outlines are thr_draw_outline mm wide, or bolder. */
void thr_draw_capsules(const thr_scene *scene, double width, thr_piece_state state, const char *data, thr_text *text);
void thr_draw_outlines(const thr_scene *scene, thr_piece_state state, const char *data, thr_text *text);
double thr_draw_outline(const thr_scene *scene);

/* Appends a small piece in the look of a state, for legends: a box in mm. */
void thr_draw_key(double x, double y, double width, double height, thr_piece_state state, thr_text *text);

/* Appends the attribute that dashes a cord's line; nothing for a full line (NULL). */
void thr_draw_dash(const thr_scene *scene, const double *dash, thr_text *text);

#endif
