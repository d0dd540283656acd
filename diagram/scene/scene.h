/* The overview picture before it is written: everything in mm on paper, x to the right, y down, the nodes' bounding box at
 * the origin. Private to diagram/. Built in steps, each in its own file: paper and beads (scene.c), the S and E marks
 * (marks.c), seams between
 * panels (seams.c), lanes (lanes.c), strands (strands.c), numbers, arrows and names (labels.c); if wanted, turns (turns.c). */
#ifndef THR_SCENE_H
#define THR_SCENE_H

#include "diagram/scene/boxes.h"
#include "diagram/scene/copies.h"
#include "diagram/layout/layout.h"
#include "diagram/scene/palette.h"
#include "diagram/scene/places.h"
#include "graph/plan/evaluation.h"
#include "graph/scratch.h"

/* Sizes in the picture, all in mm. */
typedef struct {
  double pitch;  /* median edge */
  double lane;   /* between neighbouring lanes of a bead, at most */
  double cord;   /* line width */
  double casing; /* white on each side of it */
  double bead;   /* width of a tube, or of a solid piece's arm, with one lane */
  double gap;    /* between a node and its tubes, and where cords begin to turn, at least */
  double arrow;  /* length */
  double foot;   /* half the side of a foot's pad */
  double text;   /* font size of numbers and names, >= 2.5 (7 pt = 2.47) */
} thr_sizes;

typedef struct {
  int cord;              /* index in the plan */
  int number;            /* 1 .. n_passes of the cord */
  int half;              /* half-edge */
  int lane;              /* 0 .. on its edge, towards the edge's normal (-dy, dx) */
  double from[2], to[2]; /* the straight part, in the lane */
  int seam;              /* number of the seam between the pass before and this one, -1 = none: they meet on paper */
  double turn[2][2];     /* Bezier control points of the curve that leads to from, out of the pass before or of a mark */
  double leave[2][2];    /* and of the curve from to to a mark, if the cord does not go on from there on paper */
  bool numbered;
  double pill[2];    /* centre of the number, if numbered */
  double arrow[2];   /* its middle */
  double arrow_size; /* its length; 0 = no room; < 0: it points against the pass */
  double turned;     /* if turning is shown: angle of the turn to this pass, rad; a first pass's closes the cord; -1 = none */
  bool sharp;        /* is that turn marked as a sharp one? */
  double sharp_at[2];
} thr_scene_pass;

/* Where a cord starts (S, a disc) or ends (E, a square), or goes over to the other panel ("to 17") or comes from there. */
typedef struct {
  int point;
  double at[2], radius;
  double half[2]; /* half its width and height */
  double angle;   /* direction from the point, rad; the point itself (at) when beside is false */
  bool beside;    /* beside the point, else on it */
  char text[24];
} thr_mark;

typedef struct {
  const thr_plan *plan;
  const thr_frame *frame;
  const thr_layout *layout;
  const thr_frame *paper;        /* what the beads join on paper (see thr_layout_paper) */
  const thr_evaluation *tension; /* colours show it over tension_range; NULL: colours tell the cords apart */
  double tension_range[2];       /* N */
  bool turning;                  /* turns have colours of their own along the cords */
  thr_copy *copy;                /* [n_cords] if copies are drawn pale and there are any, else NULL */
  bool lines;                    /* too many passes to be followed one by one: cords are lines (see THR_SCENE_LINES) */
  const char *const *motion;     /* [n_cords] what moves a unique path to a copy (see thr_copies_words), or NULL */
  thr_sizes size;
  bool solid; /* pieces are nodes with arms, not tubes along edges */
  thr_places places;
  char (*label)[THR_LABEL]; /* [n_nodes] their places in words (see thr_places_labels) */
  double scale;             /* mm per unit of the layout */
  double origin[2];         /* what of the layout lies at (0, 0): least x, greatest y */
  double width, height;     /* of the nodes' bounding box */
  double (*at)[2];          /* [points of the layout] */
  int *twin;                /* [points] the other point of its node, -1 = none */
  double *angle;            /* [2 * n_edges] direction in which a half-edge leaves its point, rad in (-pi, pi] */
  int *around;              /* [2 * n_edges] as paper->half, but by ascending angle within a point */
  int *rank;                /* [2 * n_edges] place of a half-edge among those at its point: around[first[p] + rank[h]] = h */
  double *gap;              /* [2 * n_edges] from the point at the half-edge's tail to the tube's end, and to where turns begin */
  double *lane;             /* [n_edges] between neighbouring lanes */
  double *bead;             /* [n_edges] width of the tube or the arms */
  int n_passes;
  thr_scene_pass *pass; /* [n_passes] of all cords in order */
  int *first_pass;      /* [n_cords + 1] */
  int *first_on, *on;   /* passes on edge e by lane: on[first_on[e] .. first_on[e + 1] - 1] */
  thr_mark (*mark)[2];  /* [n_cords] S and E */
  int n_seams;
  thr_mark (*seam)[2];  /* [n_seams] where a cord leaves a panel, and where it comes out on the other one; by pass */
  bool *seam_labelled;  /* [n_seams] was there room to say so in both places? */
  int unlabelled;       /* seams without */
  char (*id)[12];       /* [n_cords] for elements: capital letters only */
  int number_step;      /* every so many passes has a number */
  int dropped;          /* numbers for which there was no room */
  bool *named;          /* [points] is there room for the node's name? A node with two points is named at both or at neither */
  int nameless;         /* nodes without a name for want of room; 0 if none is to be named */
  double (*name_at)[2]; /* [points] its middle, if named */
  double caption[2][2]; /* of two panels: middle of what is written over each */
  thr_box extent;       /* of everything above */
  thr_boxes boxes;
  thr_scratch own; /* the arrays */
} thr_scene;

/* Everything up to the labels, copies of cords pale and without numbers if wanted. layout and plan are borrowed and must outlive
 * the scene. */
thr_status thr_scene_build(thr_scene *scene, const thr_plan *p, const thr_layout *l, double pitch_mm, bool pale_copies,
                           thr_err *err) THR_MUST_CHECK;
void thr_scene_destroy(thr_scene *scene);

/* THR_EINPUT for half-edges out of range and consecutive passes that do not meet; counts the passes of all cords. */
thr_status thr_scene_check_cords(const thr_plan *p, int *n_passes, thr_err *err) THR_MUST_CHECK;

/* What elements and objects of a cord are called by: its id if it is capital letters only, else the id that its index has. */
void thr_scene_cord_id(const thr_plan *p, int c, char id[12]);

/* Is cord c drawn as a copy? Which of the hues has it: those of unique paths and copies are alike. */
bool thr_scene_is_copy(const thr_scene *scene, int c);
int thr_scene_hue(const thr_scene *scene, int c);

/* Its colour as "#rrggbb", where colours tell the cords apart. */
const char *thr_scene_cord_colour(const thr_scene *scene, int c);

/* Colour of pass i as "#rrggbb": of its cord; when there is one cord only, of its twenty passes, or grey if turning is shown. Or
 * of its tension (grey if not known). */
void thr_scene_colour(const thr_scene *scene, int i, char hex[8]);
enum { THR_COLOUR_PASSES = 20 };

/* Is cord c, in a colour, lined with a darker rim (see thr_palette_rim)? Copies are meant to be pale, and turns have colours that
 * need none. */
bool thr_scene_rim(const thr_scene *scene, int c, const char *colour, char rim[8]);

/* More passes are drawn as lines, without pieces, numbers, arrows and ids: 20,000 take some 13 MB of SVG one by one. */
enum { THR_SCENE_LINES = 20000 };

/* Smallest pitch at which places that are not in a grid are named, mm. */
static const double THR_SCENE_NAMED = 8;

/* Dash pattern of cord c (see thr_palette_dash). */
const double *thr_scene_dash(const thr_scene *scene, int c);

/* The steps of thr_scene_build, in order. */
thr_status thr_scene_place_marks(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
thr_status thr_scene_place_seams(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
thr_status thr_scene_order_lanes(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
void thr_scene_lay_strands(thr_scene *scene);
thr_status thr_scene_name_seams(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
thr_status thr_scene_place_labels(thr_scene *scene, thr_err *err) THR_MUST_CHECK;

/* Tells the boxes where the strands run through nodes and where the feet are, so that names keep off them. */
thr_status thr_scene_box_strands(thr_scene *scene, thr_err *err) THR_MUST_CHECK;

/* After these, to show turning: finds the turns' angles, and places for the signs of those sharper than THR_SCENE_SHARP. */
thr_status thr_scene_find_turns(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
static const double THR_SCENE_SHARP = 1.57079632679489661923; /* rad */

/* Angle of the turn from pass i to the next, rad; that of a closed cord's last pass closes it. -1 = none. */
double thr_scene_turn_after(const thr_scene *scene, int i);

/* Half the diagonal of the sign of a sharp turn, mm. */
double thr_scene_sharp_size(const thr_scene *scene);

/* Point at t of the Bezier curve from a by b and c to d. */
void thr_scene_curve_at(const double a[2], const double b[2], const double c[2], const double d[2], double t, double at[2]);

/* Unit vector along half-edge h on paper; (1, 0) if it has no length there. */
void thr_scene_direction(const thr_scene *scene, int h, double d[2]);
double thr_scene_edge_length(const thr_scene *scene, int e);

/* Angle in [0, 2 pi) by which one turns, with rising angle, from direction a to direction b. */
double thr_scene_sweep(double a, double b);

/* Is pass i followed by pass i + 1 of the same cord? */
bool thr_scene_continues(const thr_scene *scene, int i);

/* The mark that pass i comes from, or NULL: it comes from the pass before. The mark that it goes to, or NULL: to the next pass.
 */
const thr_mark *thr_scene_mark_before(const thr_scene *scene, int i);
const thr_mark *thr_scene_mark_after(const thr_scene *scene, int i);

/* Where the curve starts that leads to pass i: the end of the pass before, or a mark. */
const double *thr_scene_turn_start(const thr_scene *scene, int i);

/* Are cords labelled where they go over to the other panel? Not at a small scale, where only the places on the rims are named. */
bool thr_scene_labels_seams(const thr_scene *scene);

/* What is written over panel 0 or 1: "from above". */
const char *thr_scene_caption(const thr_scene *scene, int panel);

/* The name of the place that a point of the layout shows. */
void thr_scene_place_name(const thr_scene *scene, int point, char name[48]);

/* Estimated width of a text in mm. */
double thr_scene_text_width(const char *text, double font_size);

/* Size of the pill behind a number, mm. */
double thr_scene_pill_width(const thr_scene *scene, const char *text);
double thr_scene_pill_height(const thr_scene *scene);

/* The text of a pass's number: "17", or "A17" when there are several cords. */
void thr_scene_number(const thr_scene *scene, int pass, char text[32]);

#endif
