/* Pictures for pages: the whole plan or a part of it, at a scale at which nothing is under 7 pt. Private to diagram/. */
#ifndef THR_CROP_H
#define THR_CROP_H

#include "diagram/layout/layout.h"
#include "diagram/overview/draw.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

/* Scenes of one plan at a few scales, each made when it is first asked for. */
enum { THR_CROP_SCALES = 20 };

typedef struct {
  const thr_plan *plan;
  const thr_layout *layout;
  double slender; /* height of the layout over its width, at most 1e6 */
  thr_scene scene[THR_CROP_SCALES];
  bool made[THR_CROP_SCALES];
  thr_text whole[THR_CROP_SCALES];      /* all edges in small (thr_crop_locate), empty until asked for; owned */
  thr_box whole_paper[THR_CROP_SCALES]; /* where they are */
} thr_crops;

/* Plan and layout are borrowed and must outlive crops. */
void thr_crops_make(thr_crops *crops, const thr_plan *p, const thr_layout *l);
void thr_crops_destroy(thr_crops *crops);

/* What a picture shows: passes and pieces in their states (thr_draw_state, thr_piece_state). Arrays are borrowed. */
typedef struct {
  int number;                 /* of the picture, its own in the document */
  const unsigned char *state; /* [n_passes] */
  const unsigned char *piece; /* [pieces]; NULL: all are plain */
  const int *now;             /* [n_now] the passes drawn now, in the order of threading; n_now >= 1 */
  int n_now;
  const char *colour; /* of the passes drawn now, "#rrggbb"; NULL: their own */
  bool backward;      /* they are threaded against the plan's direction, from the last to the first */
} thr_crop;

/* How it is shown: a window on the scene. */
typedef struct {
  int scale;      /* number of the scene; THR_CROP_SCALES: none is small enough */
  double size[2]; /* mm */
} thr_crop_view;

/* The largest scale at which the passes drawn now fit in room (width and height, mm) with a ring of their neighbours around them.
 * The window is at least as large as least, if there is room for that. O(n_now), and O(n log n) the first time. */
thr_status thr_crop_fit(thr_crops *crops, const thr_crop *crop, const double room[2], const double least[2], thr_crop_view *view,
                        thr_err *err) THR_MUST_CHECK;

/* Makes the window larger, as far as there is anything more to show, up to room. */
void thr_crop_fill(const thr_crops *crops, thr_crop_view *view, const double room[2]);

/* Appends the picture with its top left corner at a point of the page: clipped, in a frame, each pass that is drawn now with its
 * number and arrow, names at the places that they come to. It is a group of class "view-NUMBER" and brings its style. shown
 * receives what of the scene the window shows. The view's scale is below THR_CROP_SCALES. The layout is in one panel. O(n). */
thr_status thr_crop_draw(thr_crops *crops, const thr_crop *crop, const thr_crop_view *view, const double at[2], thr_box *shown,
                         thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Appends where that is in the whole, within the paper and in its right upper corner: all beads as thin lines or, where these
 * would run together, the area that they cover; the passes drawn now, a frame around what is shown. Needs no states; the picture
 * must have been drawn. O(n) the first time at a scale and place. */
void thr_crop_locate(thr_crops *crops, const thr_crop *crop, const thr_crop_view *view, thr_box shown, thr_box paper,
                     thr_text *text);

/* Appends the whole plan, at the largest scale that fits in the paper, with the numbers that this scale has room for; passes and
 * pieces in their states (NULL: all now; all plain). Brings the style of the document. pitch, mm: it is no larger than
 * that (0: any), and receives its own, so that many pictures of one size are fitted once; NULL: any. O(n log n). THR_ELIMIT if it
 * was interrupted. */
thr_status thr_crop_whole(const thr_plan *p, const thr_layout *l, const unsigned char *state, const unsigned char *piece,
                          thr_box paper, double *pitch, const thr_limits *limits, thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Appends a solid piece alone, as it lies in the picture: its hub at a point of the page, at the largest scale at which it is
 * within room mm of it. *scene receives the scene at that scale, *point the point that is drawn: of a node with two that with
 * more arms. */
thr_status thr_crop_piece(thr_crops *crops, int node, const double at[2], double room, const thr_scene **scene, int *point,
                          thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Places numbers, arrows and names of the passes drawn now where they hide least in a window of the scene; all others have none
 * then (crop_labels.c). */
thr_status thr_crop_label(thr_scene *s, const thr_crop *crop, thr_box window, thr_err *err) THR_MUST_CHECK;

/* Appends the pieces in a window of the scene, in few elements, for pages would take ten times as long with one for each
 * (crop_pieces.c). state: as piece in thr_crop. O(n log n). */
thr_status thr_crop_pieces(const thr_scene *s, const unsigned char *state, const thr_box *window, thr_text *text,
                           thr_err *err) THR_MUST_CHECK;

#endif
