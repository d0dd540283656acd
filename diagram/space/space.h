/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of steps in space, for frameworks that no flat picture shows without crossings: each
 * step from the direction in which its passes are best told apart, what is far away pale.
 *
 * Reading order: camera.h and camera.c (the choice of a direction), space.c (what a camera is asked
 * to show), space_draw.c (a step's picture, all pieces, one piece), space_labels.c (numbers,
 * arrows, names), space_locate.c (the whole in small beside a step), space_overview.c. On paper
 * lengths are in mm, y goes down; depths are in units of the framework, larger = nearer to the eye.
 */
#ifndef THR_SPACE_H
#define THR_SPACE_H

#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- Chooses from where a part of a framework in space is drawn: in parallel projection, upright,
 * from the direction in which the passes of a step are best told apart on paper. */

/* Unit vectors: to the right and up on paper, and from the framework to the eye. */
typedef struct {
  double right[3], up[3], eye[3];
} thr_camera;

/* How a camera sees it: mm per unit, and what of the plane of view is in the middle of the paper (x
 * to the right, y down). */
typedef struct {
  thr_camera camera;
  double scale, middle[2];
  double size[2]; /* of the paper, mm */
} thr_camera_view;

/* So many passes of a step are shown at most. */
enum { THR_CAMERA_PASSES = 32, THR_CAMERA_PLANES = 4 * THR_CAMERA_PASSES };

/* What is to be drawn: a line for every pass as the needle goes, from hub to hub. */
typedef struct {
  int n; /* 1 to THR_CAMERA_PASSES */
  double from[THR_CAMERA_PASSES][3], to[THR_CAMERA_PASSES][3];
  double outward[THR_CAMERA_PASSES][3]; /* unit vector from the inside of the framework to its
                                           outside at the pass; 0: none */
  int n_planes;
  double plane[THR_CAMERA_PLANES][3]; /* unit normals of planes of the framework at the passes,
                                         which are not to be seen edge-on */
  bool shell;                         /* passes on the far side are hidden */
  double pitch;                       /* median edge, units */
} thr_camera_scene;

/* A pass is at least so long on paper, mm; one that is less than half a pitch long in space, in
 * proportion. */
static const double THR_CAMERA_PASS = 9;

/* Returns whether there is a direction from which every pass is that long, and on a shell on the
 * near side, on paper of a size in mm. O(n) a direction, some hundred of them, of which number
 * *first comes first (0, or as it was left): it receives that of the one that is found, which is
 * likely the one for a little more of the same. */
bool thr_camera_legible(const thr_camera_scene *scene, const double size[2], int *first);

/* Returns the view from the best direction: penalized are passes that are too short on paper,
 * numbers that would lie on each other, passes that cross; then the least foreshortened, seen from
 * outside rather than from inside. Deterministic. O(n^2) a direction. */
thr_camera_view thr_camera_choose(const thr_camera_scene *scene, const double size[2]);

/* Returns the camera at an azimuth and elevation, rad. */
thr_camera thr_camera_at(double azimuth, double elevation);

/* Projects a point onto paper, mm from its upper left corner; at[2] is the depth, in units, larger
 * = nearer to the eye. */
void thr_camera_project(const thr_camera_view *view, const double point[3], double at[3]);

/* What pictures are made from. {0} is valid and empty. Passes are counted cord by cord as in a
 * scene. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  const char (*label)[THR_LABEL]; /* [n_nodes] borrowed */
  const double (*outward)[3];     /* [n_nodes] of a shell, unit vectors to its outside; NULL: it has
                                     none. Borrowed */
  bool solid;
  double pitch, middle[3]; /* median edge; mean of the nodes */
  int n_passes;
  int *half, *cord;   /* [n_passes] half-edge; cord */
  int *first_on, *on; /* passes on edge e: on[first_on[e] .. first_on[e + 1] - 1] */
} thr_space;

/* Plan, labels and outward (see thr_space) are borrowed and must outlive space. Release with
 * thr_space_destroy, after a failure too. */
thr_status thr_space_make(thr_space *space, const thr_plan *plan, const char (*label)[THR_LABEL],
                          const double (*outward)[3], thr_err *err) THR_MUST_CHECK;
void thr_space_destroy(thr_space *space);

/* A step's picture: a crop (see crop.c), the colour of its passes, and the half-edge into which the
 * needle points behind the last one, -1 = none. */
typedef struct {
  thr_crop crop;
  const char *colour;
  int next;
} thr_space_step;

/* Returns whether some view shows every pass drawn now at least THR_CAMERA_PASS long. first: as in
 * thr_camera_legible. O(n_now). */
bool thr_space_legible(const thr_space *space, const thr_crop *crop, const double room[2],
                       int *first);

/* Returns the best view for a picture that fills room (width and height, mm). O(n_now^2). */
thr_camera_view thr_space_fit(const thr_space *space, const thr_crop *crop, const double room[2]);

/* Appends the picture, in a frame, its top left corner at a point of the page: a group of class
 * "view-NUMBER". O(n). */
thr_status thr_space_draw(const thr_space *space, const thr_space_step *step,
                          const thr_camera_view *view, const double at[2], thr_text *text,
                          thr_err *err) THR_MUST_CHECK;

/* Appends the whole in small within the paper and in its right upper corner, from the same
 * direction, what is drawn now bold. */
thr_status thr_space_locate(const thr_space *space, const thr_space_step *step,
                            const thr_camera_view *view, thr_box paper, thr_text *text,
                            thr_err *err) THR_MUST_CHECK;

/* From where the whole is seen, and what of it. Everything is borrowed. */
typedef struct {
  double azimuth, elevation;  /* rad */
  const unsigned char *state; /* [pieces] how they look (thr_piece_state); NULL: held */
  bool cords;                 /* with the cords in them, each hidden by what is in front of it, and
                                 their ends and passes numbered where there is room */
  bool plain;                 /* without names and numbers */
  bool *named, *numbered; /* [n_nodes] [n_passes] what other views have named already, which comes
                             last, or is not repeated; NULL: each view for itself */
} thr_space_look;

/* Returns the look from the front and above, without cords. */
thr_space_look thr_space_front(void);

/* Appends all pieces as large as the paper takes, with the names of those that have room. O(n log
 * n). */
thr_status thr_space_whole(const thr_space *space, const thr_space_look *look, thr_box paper,
                           thr_text *text, thr_err *err) THR_MUST_CHECK;

/* Appends the piece at a node alone, from where its arms are told best, its hub at a point of the
 * page and its longest arm `reach` mm long at most, with the lengths of up to six arms. */
thr_status thr_space_piece(const thr_space *space, int node, const double at[2], double reach,
                           thr_text *text, thr_err *err) THR_MUST_CHECK;

/* ---- space_overview.c: The overview of a framework that no flat picture shows as it is. */

/* Appends a sheet with the framework and all cords from four sides, as thr_overview_svg. guide: of
 * the same layout. Elements: <g id="view-1"> to "view-4". THR_EINPUT as thr_overview_svg. */
thr_status thr_space_overview(const thr_plan *plan, const thr_guide *guide,
                              const thr_overview_options *options, thr_text *svg,
                              thr_err *err) THR_MUST_CHECK;

/* Returns the half-edge of pass i in the direction of the needle. */
int thr_space_half(const thr_space *space, const thr_crop *crop, int i);

/* ---- labels (space_labels.c) ---- */

/* A pass on paper: its lane between the turns at its ends, mm. */
typedef struct {
  double hub[2][2], from[2], to[2], along[2]; /* hubs of the pieces that it joins; unit vector */
  double length;
} thr_lane;

/* Appends numbers with leaders, arrows and names of the passes drawn now: lane[n_now]. at[n_nodes]:
 * the hubs. half_arm: half the width of an arm. */
thr_status thr_space_label(const thr_space *space, const thr_space_step *step, const thr_lane *lane,
                           const double (*at)[3], thr_box window, double half_arm, thr_text *text,
                           thr_err *err) THR_MUST_CHECK;

#endif
