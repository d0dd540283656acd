/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene of a plan: where nodes, beads, cords, numbers and names lie on paper, before any format
 * is written; and what all drawings and tables share: pieces and their names, copies, colours,
 * places, cords as lines in space.
 *
 * Reading order: scene.c (the steps of thr_scene_build, with the sizes), then the steps: marks.c,
 * seams.c, lanes.c, scene_strands.c, labels.c, turns.c; below them boxes.c, places.c, palette.c,
 * outlines.c. pieces.c and copies.c stand by themselves, as do the small drawings (arms.c,
 * shadow.c) and the cords for CAD (cord_lines.c, polylines.c). On paper lengths are in mm, y goes
 * down; angles are in rad. */
#ifndef THR_SCENE_H
#define THR_SCENE_H

#include "diagram/layout/layout.h"
#include "graph/framework/frame.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/arrays.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- boxes.c: keeps what lies where on paper: rectangles in a grid, asked for overlaps when a
 * number or a name looks for room. */

/* A rectangle on paper. */
typedef struct {
  double x0, y0, x1, y1; /* mm, x0 <= x1, y0 <= y1 */
} thr_box;

/* Kinds of things, which can be added. */
enum {
  THR_BOX_BEAD = 1,
  THR_BOX_CORD = 2,
  THR_BOX_ARROW = 4,
  THR_BOX_MARK = 8,
  THR_BOX_NUMBER = 16,
  THR_BOX_NAME = 32,
  THR_BOX_FOOT = 64,
  THR_BOX_TURN = 128
};

/* All rectangles, and for each cell of the grid a list of those that touch it. */
typedef struct {
  thr_box bounds;
  double cell; /* mm */
  int columns, rows;
  int *head; /* [columns * rows] newest link of the cell, or -1 */
  int n_boxes, boxes_capacity, n_links, links_capacity;
  struct thr_boxes_item {
    thr_box box;
    int kind;
    unsigned asked; /* number of the last question that met it */
  } * item;
  struct thr_boxes_link {
    int item, next;
  } * link;
  unsigned question;
} thr_boxes;

/* Makes a grid without boxes. Boxes outside bounds are allowed and kept in the border cells.
 * Release with thr_boxes_destroy. */
thr_status thr_boxes_init(thr_boxes *boxes, thr_box bounds, double cell,
                          thr_err *err) THR_MUST_CHECK;
thr_status thr_boxes_add(thr_boxes *boxes, thr_box box, int kind, thr_err *err) THR_MUST_CHECK;
void thr_boxes_destroy(thr_boxes *boxes);

/* Returns the area in mm^2 that box shares with the boxes of the kinds (a sum of THR_BOX_..),
 * overlaps counted each time. Stops once it is enough (> 0). A place so crowded that 300 boxes were
 * met counts as taken. */
double thr_boxes_overlap(thr_boxes *boxes, thr_box box, int kinds, double enough);

thr_box thr_box_around(double x, double y, double half_width, double half_height);
void thr_box_extend(thr_box *box, thr_box other);
void thr_box_point(thr_box *box, const double at[2]); /* extends the box to a point */

/* Return whether two boxes overlap or touch, and whether a box lies wholly in another one. */
bool thr_box_touch(thr_box a, thr_box b);
bool thr_box_inside(thr_box outer, thr_box box);

/* ---- copies.c: finds which cords of a symmetric plan are copies of a unique path, and how they
 * run through it. */

/* Pass k of a copy is the image of pass start + k of its unique path; backward: of pass start - k,
 * run the other way. Closed cords go round. */
typedef struct {
  int of;   /* the cord that is the unique path; itself for one */
  int path; /* number of that path, 0, 1, .. by lowest cord */
  int start;
  bool backward;
} thr_copy;

/* Fills copy[plan->n_cords] from plan->symmetry, which is not trusted: a cord that is not the image
 * that it is said to be is a path of its own, and so is every cord of a plan that is not symmetric.
 * O(passes). */
thr_status thr_copies_find(const thr_plan *plan, thr_copy *copy, thr_err *err) THR_MUST_CHECK;

int thr_copies_paths(const thr_copy *copy, int n_cords);         /* different unique paths */
int thr_copies_count(const thr_copy *copy, int n_cords, int of); /* cords that are copies of one */

/* Writes how copy c repeats its path, to be put behind a name or a place: ", turned by 90 degrees,
 * threaded backwards". motion[c]: what moves the path there, NULL if no motion in space does;
 * motion NULL: not known. */
void thr_copies_words(const thr_plan *plan, const thr_copy *copy, int c, const char *const *motion,
                      char words[192]);

/* Returns the image that maps the unique path of cord c to it: [n_nodes], of plan->symmetry. c is a
 * copy.
 */
const int *thr_copies_image(const thr_plan *plan, int c);

/* ---- palette.c: colours of cords: Okabe & Ito 2008 without yellow (too pale on paper) and black
 * (text), told apart by colour-blind readers (least CIEDE2000 difference 22, without one kind of
 * cone 10.9), but not in grey print; a dash pattern for every further six cords. */

enum { THR_COLOURS = 6, THR_DASHES = 4 };

/* A colour of cords. */
typedef struct {
  const char *hex;  /* "#0072B2" */
  const char *pale; /* the same hue for copies: "#9ECDF5" */
  const char *name; /* "blue" */
} thr_colour;

/* Returns colour i >= 0; repeats every THR_COLOURS. */
thr_colour thr_palette(int i);

/* Writes a dark shade of a colour that is too pale on white (contrast below 3, WCAG 2.1) to line
 * the colour with: contrast 4.5. Returns false if the colour needs none. */
bool thr_palette_rim(const char *hex, char rim[8]);

/* Returns dash pattern number i: on, off lengths in cord widths, 0-terminated; NULL for 0, the full
 * line. Repeats. */
const double *thr_palette_dash(int i);

/* Writes the colour of a turn by angle rad as "#rrggbb": equal steps in the Oklab space (B.
 * Ottosson, 2020) from pale lilac for straight on to dark violet, a hue that no cord has, for pi.
 */
void thr_turning_colour(double angle, char hex[8]);

/* ---- places.c: letter and number places of grid-like pictures: column letters from left to right,
 * row numbers from the bottom up. */

/* {0} is valid and means: not a grid, places are called by the nodes' names. Arrays are owned. */
typedef struct {
  int n_columns, n_rows;
  double *x, *y;                   /* [n_columns], [n_rows] mean coordinates, ascending */
  char (*letter)[8], (*number)[8]; /* [n_columns], [n_rows] */
  int *column, *row;               /* [n_nodes] */
} thr_places;

/* Finds the grid in xy[frame->n_nodes] (+y up, median edge length given). Grid-like: coordinates
 * fall into clusters no wider than a tenth of the median, nine of ten edges stay in a row or
 * column, no two nodes share a place, and at least a third of the places is taken; otherwise places
 * is {0}. Names like "C4" that agree with the picture are taken over. O(n log n).
 */
thr_status thr_places_find(thr_places *places, const thr_frame *frame, const double (*xy)[2],
                           double median, thr_err *err) THR_MUST_CHECK;
void thr_places_destroy(thr_places *places);

/* Writes "C4" on a grid, else the node's name, cut to 40 bytes. */
void thr_places_name(const thr_places *places, const thr_frame *frame, int v, char name[48]);

/* Writes what the nodes are called in all documents into label[n_nodes]: as above, blanks as "_",
 * and names that are there several times with the node's number, "x#17". O(n log n). */
enum { THR_LABEL = 64 };
thr_status thr_places_labels(const thr_places *places, const thr_frame *frame,
                             char (*label)[THR_LABEL], thr_err *err) THR_MUST_CHECK;

/* ---- scene.c: The overview picture before it is written: everything in mm on paper, x to the
 * right, y down, the nodes' bounding box at the origin. */

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

/* One pass of a cord in the picture. */
typedef struct {
  int cord;              /* index in the plan */
  int number;            /* 1 .. n_passes of the cord */
  int half;              /* half-edge */
  int lane;              /* 0 .. on its edge, towards the edge's normal (-dy, dx) */
  double from[2], to[2]; /* the straight part, in the lane */
  int seam; /* number of the seam between the pass before and this one, -1 = none: they meet on
               paper */
  double turn[2][2];  /* Bezier control points of the curve that leads to from, out of the pass
                         before or of a mark */
  double leave[2][2]; /* and of the curve from to to a mark, if the cord does not go on from there
                         on paper */
  bool numbered;
  double pill[2];    /* centre of the number, if numbered */
  double arrow[2];   /* its middle */
  double arrow_size; /* its length; 0 = no room; < 0: it points against the pass */
  double turned; /* if turning is shown: angle of the turn to this pass, rad; a first pass's closes
                    the cord; -1 = none */
  bool sharp;    /* is that turn marked as a sharp one? */
  double sharp_at[2];
} thr_scene_pass;

/* Where a cord starts (S, a disc) or ends (E, a square), or goes over to the other panel ("to 17")
 * or comes from there. */
typedef struct {
  int point;
  double at[2], radius;
  double half[2]; /* half its width and height */
  double angle;   /* direction from the point, rad; the point itself (at) when beside is false */
  bool beside;    /* beside the point, else on it */
  char text[24];
} thr_mark;

/* The picture. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *frame;
  const thr_layout *layout;
  const thr_frame *paper; /* what the beads join on paper (see thr_layout_paper) */
  const thr_evaluation
      *tension; /* colours show it over tension_range; NULL: colours tell the cords apart */
  double tension_range[2]; /* N */
  thr_copy *copy;          /* [n_cords] if copies are drawn pale and there are any, else NULL */
  bool turning;            /* turns have colours of their own along the cords */
  bool solid;              /* pieces are nodes with arms, not tubes along edges */
  bool lines; /* too many passes to be followed one by one: cords are lines (see THR_SCENE_LINES) */
  const char *const
      *motion; /* [n_cords] what moves a unique path to a copy (see thr_copies_words), or NULL */
  thr_sizes size;
  thr_places places;
  char (*label)[THR_LABEL]; /* [n_nodes] their places in words (see thr_places_labels) */
  double scale;             /* mm per unit of the layout */
  double origin[2];         /* what of the layout lies at (0, 0): least x, greatest y */
  double width, height;     /* of the nodes' bounding box */
  double (*at)[2];          /* [points of the layout] */
  int *twin;                /* [points] the other point of its node, -1 = none */
  double
      *angle;  /* [2 * n_edges] direction in which a half-edge leaves its point, rad in (-pi, pi] */
  int *around; /* [2 * n_edges] as paper->half, but by ascending angle within a point */
  int *rank;   /* [2 * n_edges] place of a half-edge among those at its point: around[first[p] +
                  rank[h]] = h */
  double *gap; /* [2 * n_edges] from the point at the half-edge's tail to the tube's end, and to
                  where turns begin */
  double *lane; /* [n_edges] between neighbouring lanes */
  double *bead; /* [n_edges] width of the tube or the arms */
  int n_passes;
  thr_scene_pass *pass; /* [n_passes] of all cords in order */
  int *first_pass;      /* [n_cords + 1] */
  int *first_on, *on;   /* passes on edge e by lane: on[first_on[e] .. first_on[e + 1] - 1] */
  thr_mark (*mark)[2];  /* [n_cords] S and E */
  int n_seams;
  thr_mark (*seam)[2]; /* [n_seams] where a cord leaves a panel, and where it comes out on the other
                          one; by pass */
  bool *seam_labelled; /* [n_seams] was there room to say so in both places? */
  int unlabelled;      /* seams without */
  char (*id)[12];      /* [n_cords] for elements: capital letters only */
  int number_step;     /* every so many passes has a number */
  int dropped;         /* numbers for which there was no room */
  bool *named;  /* [points] is there room for the node's name? A node with two points is named at
                   both or at neither */
  int nameless; /* nodes without a name for want of room; 0 if none is to be named */
  double (*name_at)[2]; /* [points] its middle, if named */
  double caption[2][2]; /* of two panels: middle of what is written over each */
  thr_box extent;       /* of everything above */
  thr_boxes boxes;
  thr_scratch own; /* the arrays */
} thr_scene;

/* Builds everything up to the labels, copies of cords pale and without numbers if wanted. layout
 * and plan are borrowed and must outlive the scene. */
thr_status thr_scene_build(thr_scene *scene, const thr_plan *plan, const thr_layout *layout,
                           double pitch_mm, bool pale_copies, thr_err *err) THR_MUST_CHECK;
void thr_scene_destroy(thr_scene *scene);

/* Checks the cords: THR_EINPUT for half-edges out of range and consecutive passes that do not meet;
 * counts the passes of all cords. */
thr_status thr_scene_check_cords(const thr_plan *plan, int *n_passes, thr_err *err) THR_MUST_CHECK;

/* Writes what elements and objects of a cord are called by: its id if it is capital letters only,
 * else the id that its index has. */
void thr_scene_cord_id(const thr_plan *plan, int c, char id[12]);

/* Return whether cord c is drawn as a copy, and which of the hues it has: those of unique paths and
 * copies are alike. */
bool thr_scene_is_copy(const thr_scene *scene, int c);
int thr_scene_hue(const thr_scene *scene, int c);

/* Returns the colour of cord c as "#rrggbb", where colours tell the cords apart. */
const char *thr_scene_cord_colour(const thr_scene *scene, int c);

/* Writes the colour of pass i as "#rrggbb": of its cord; when there is one cord only, of its twenty
 * passes, or grey if turning is shown. Or of its tension (grey if not known). */
void thr_scene_colour(const thr_scene *scene, int i, char hex[8]);
enum { THR_COLOUR_PASSES = 20 };

/* Returns whether cord c, in a colour, is lined with a darker rim (see thr_palette_rim). Copies are
 * meant to be pale, and turns have colours that need none. */
bool thr_scene_rim(const thr_scene *scene, int c, const char *colour, char rim[8]);

/* More passes are drawn as lines, without pieces, numbers, arrows and ids: 20,000 take some 13 MB
 * of SVG one by one. */
enum { THR_SCENE_LINES = 20000 };

/* Smallest pitch at which places that are not in a grid are named, mm. */
static const double THR_SCENE_NAMED = 8;

/* Returns the dash pattern of cord c (see thr_palette_dash). */
const double *thr_scene_dash(const thr_scene *scene, int c);

/* The steps of thr_scene_build, in order. */
thr_status thr_scene_place_marks(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
thr_status thr_scene_place_seams(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
thr_status thr_scene_order_lanes(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
void thr_scene_lay_strands(thr_scene *scene);
thr_status thr_scene_name_seams(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
thr_status thr_scene_place_labels(thr_scene *scene, thr_err *err) THR_MUST_CHECK;

/* Tells the boxes where the strands run through nodes and where the feet are, so that names keep
 * off them. */
thr_status thr_scene_box_strands(thr_scene *scene, thr_err *err) THR_MUST_CHECK;

/* After these, to show turning: finds the turns' angles, and places for the signs of those sharper
 * than THR_SCENE_SHARP. */
thr_status thr_scene_find_turns(thr_scene *scene, thr_err *err) THR_MUST_CHECK;
static const double THR_SCENE_SHARP = 1.57079632679489661923; /* rad */

/* Returns the angle of the turn from pass i to the next, rad; that of a closed cord's last pass
 * closes it. -1 = none. */
double thr_scene_turn_after(const thr_scene *scene, int i);

/* Returns half the diagonal of the sign of a sharp turn, mm. */
double thr_scene_sharp_size(const thr_scene *scene);

/* Computes the point at t of the Bezier curve from a by b and c to d. */
void thr_scene_curve_at(const double a[2], const double b[2], const double c[2], const double d[2],
                        double t, double at[2]);

/* Computes the unit vector along half-edge h on paper; (1, 0) if it has no length there. */
void thr_scene_direction(const thr_scene *scene, int h, double d[2]);
double thr_scene_edge_length(const thr_scene *scene, int e);

/* Returns the angle in [0, 2 pi) by which one turns, with rising angle, from direction a to
 * direction b. */
double thr_scene_sweep(double a, double b);

/* Returns whether pass i is followed by pass i + 1 of the same cord. */
bool thr_scene_continues(const thr_scene *scene, int i);

/* Return the mark that pass i comes from, or NULL if the pass before; and the mark that pass i goes
 * to, or NULL if the next pass. */
const thr_mark *thr_scene_mark_before(const thr_scene *scene, int i);
const thr_mark *thr_scene_mark_after(const thr_scene *scene, int i);

/* Returns where the curve starts that leads to pass i: the end of the pass before, or a mark. */
const double *thr_scene_turn_start(const thr_scene *scene, int i);

/* Returns whether cords are labelled where they go over to the other panel. At a small scale only
 * the places on the rims are named. */
bool thr_scene_labels_seams(const thr_scene *scene);

/* Returns what is written over panel 0 or 1: "from above". */
const char *thr_scene_caption(const thr_scene *scene, int panel);

/* Writes the name of the place that a point of the layout shows. */
void thr_scene_place_name(const thr_scene *scene, int point, char name[48]);

/* Returns the estimated width of a text in mm. */
double thr_scene_text_width(const char *text, double font_size);

/* Return the size of the pill behind a number, mm. */
double thr_scene_pill_width(const thr_scene *scene, const char *text);
double thr_scene_pill_height(const thr_scene *scene);

/* Write what a pass is called on paper: "17", or "A:17" when there are several cords, since A17 is
 * a place. number: from 1. */
void thr_scene_number(const thr_scene *scene, int pass, char text[32]);
void thr_scene_pass_name(const thr_plan *plan, int c, int number, char text[32]);

/* ---- pieces.c: the pieces of a plan: what a hand picks up. */

/* {0} is valid and empty. Arrays are owned, the plan is borrowed. A kind is called by the letter of
 * its shape, a hyphen and its number: P has one arm, I and L have two (I: in line, over
 * THR_PIECES_IN_LINE), T and Y three (T: two of them in line), X four; from five on the number of
 * arms stands for the letter. Kinds are numbered over all shapes, in this order. Tubes have no
 * letter.
 */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  bool solid;
  int n;
  int n_kinds;
  int *kind;    /* [n] from 1 */
  int *members; /* [n_kinds + 1] pieces of a kind */
  int *model;   /* [n_kinds + 1] its first piece */
  int single;   /* kinds of one member */
} thr_pieces;

enum {
  THR_PIECES_SINGLE = 12 /* more solid kinds of one member than these are called by their shapes */
};

static const double THR_PIECES_IN_LINE = 2.6179938779914943654; /* rad, 150 degrees */

/* Return how many pieces there are, and what one is called: "piece" or "tube". */
int thr_pieces_count(const thr_plan *plan);
const char *thr_pieces_word(const thr_plan *plan, int n); /* "piece", "pieces" */

/* Finds kinds (diagram/tables/tables.h) with a tolerance in units; 0 = the usual one. Release with
 * thr_pieces_destroy, after a failure too. As thr_kinds_find. */
thr_status thr_pieces_make(thr_pieces *pieces, const thr_plan *plan, double tolerance,
                           thr_err *err) THR_MUST_CHECK;
void thr_pieces_destroy(thr_pieces *pieces);

int thr_pieces_arms(const thr_pieces *pieces, int piece); /* of a tube: 2 */
char thr_pieces_letter(const thr_pieces *pieces,
                       int piece); /* of its shape; 0 = none: a tube, or five arms and more */

/* Returns whether a kind is one of very many that have one member each: those are called by their
 * places and their shapes, and counted together. */
bool thr_pieces_alone(const thr_pieces *pieces, int kind);

/* "X-10", "6-14"; of tubes "3". */
void thr_pieces_kind_name(const thr_pieces *pieces, int kind, char name[24]);

/* Appends the name of a piece: the place of a node, both places of an edge, "A1-A2". label[n_nodes]
 * as in thr_guide. */
void thr_pieces_name(const thr_pieces *pieces, const char (*label)[THR_LABEL], int piece,
                     thr_text *text);

/* Appends it with its kind, as it is looked for in the box: "X-10 (B5)"; of a kind that is called
 * by its shape (thr_pieces_alone) "24 (an X)". */
void thr_pieces_pick(const thr_pieces *pieces, const char (*label)[THR_LABEL], int piece,
                     thr_text *text);

/* Appends how many there are of which shape: "4 L, 20 T, 25 X"; nothing of tubes. */
void thr_pieces_shapes(const thr_pieces *pieces, thr_text *text);

/* ---- threading ---- */

/* A part of a cord, threaded in one go: passes first .. end - 1 in the plan's direction, or end - 1
 * .. first against it. A part that begins is the first of its cord: it begins in a piece, all
 * others in one that holds the cord. */
typedef struct {
  int cord, first, end;
  bool backward, begins;
} thr_part;

/* One stay of the needle in a piece. */
typedef struct {
  int cord;
  int number; /* of the pass by which the needle comes in, from 1, as in pictures; 0 = it begins
                 here */
  int piece;
  int in, out; /* half-edges as the needle goes: by which it comes in, by which it goes out; -1 =
                  none. Of a tube both are its own */
  int nth;   /* how many stays of cords in this piece there have been by then, with this one: 1 = it
                is picked up */
  int since; /* the visit that picked it up */
  bool back; /* of a tube: against the way of the cord that came before */
} thr_visit;

/* Follows the needle through parts in the order of threading; visits receives *n of them, freed by
 * the caller. With solid joints a part that begins has one more visit than passes. O(passes +
 * pieces). */
thr_status thr_pieces_follow(const thr_pieces *pieces, const thr_part *parts, int n_parts,
                             thr_visit **visits, int *n, thr_err *err) THR_MUST_CHECK;

/* Fills part[2 * n_cords] with all cords in the order of threading, every path before its copies:
 * each from its start to its end, or, if so many needles thread it from its fold (thr_cord_fold),
 * on to its end and then back to its start. Returns how many parts. */
int thr_pieces_parts(const thr_plan *plan, const thr_copy *copy, int needles, thr_part *part);

/* Appends what is done at a visit: "start, pick up L-1 (A7): out to A6", "pick up X-10 (B5): in
 * from A5, out to C5", "through F5, on cord A since its row 3: in from E5, out to G5", "pick up
 * tube 2 (A1-A2): in at A1, out at A2". Arms are called by the piece that they face. step: [visits]
 * the step of each, for pages that are divided into steps: what is on a cord already is then said
 * to be "on cord A", "on since step 3" or "your row 5". NULL: there are none. */
void thr_pieces_say(const thr_pieces *pieces, const char (*label)[THR_LABEL],
                    const thr_visit *visit, int i, const int *step, thr_text *text);

/* ---- cord_lines.c: where a cord runs in space, as a line through the nodes or with a lane for
 * each of its passes. */

/* How cords are drawn for CAD. {0}: through the nodes, z upwards. */
typedef struct {
  bool lanes; /* the passes of an edge run beside each other, so that none coincide */
  bool up_y;  /* y points up: a point at x, y, z stands at x, z, -y */
  const char (*label)[THR_LABEL]; /* [n_nodes] places of the nodes, which OBJ lists in a comment
                                     and DXF writes beside them; NULL: not; borrowed */
} thr_line_options;

/* The cords of a plan, to be asked for one after the other. */
typedef struct {
  const thr_plan *plan;
  thr_line_options options;
  double spacing; /* between lanes, in units */
  int *passes;    /* [n_edges] of all cords */
  int *seen;      /* [n_edges] of the cords that were asked for */
  double (*point)[3];
  int n_points; /* of the cord asked for last */
} thr_cord_lines;

/* Begins with a plan's cords; lines is to be ended even after a failure. The distance of lanes is
 * 0.115 of the median edge, less on edges that are short or have many passes: all lanes of an edge
 * lie within half its length. */
thr_status thr_cord_lines_begin(thr_cord_lines *lines, const thr_plan *plan,
                                const thr_line_options *options, thr_err *err) THR_MUST_CHECK;

/* Sets point and n_points to those of cord c; cords are asked for in order. Without lanes the nodes
 * along the cord; with lanes, of an edge with several passes two points for each pass, side by
 * side, and no node between two of these. */
void thr_cord_lines_next(thr_cord_lines *lines, int c);

/* Turns xyz as the options say which way is up. */
void thr_cord_lines_turn(const thr_line_options *options, const double xyz[3], double out[3]);

void thr_cord_lines_end(thr_cord_lines *lines);

/* ---- polylines.c: writes the cords as lines through the nodes, for CAD and for pictures made
 * elsewhere. */

/* Writes Wavefront OBJ in the framework's units: all nodes, then per cord an object with a
 * two-vertex l record per pass, in order (Blender takes no more than the first two vertices of an l
 * for an edge); with lanes the points of the cords instead of the nodes. The reader of frameworks
 * reads it back, turned if y is up, which a comment says. */
thr_status thr_polylines_obj(const thr_plan *plan, const thr_line_options *options, thr_text *out,
                             thr_err *err) THR_MUST_CHECK;

/* Writes glTF 2.0 (Khronos 2021) in one JSON file with its buffer inside: a node, a mesh of one
 * LINE_STRIP and a material per cord, in metres, y upwards whatever the options say: (x, y, z) of
 * the framework becomes (x, z, -y), a quarter turn about x. Units that thr_units_in_mm does not
 * know count as mm; asset.extras says how many metres a unit was. Colours as in the overview.
 * THR_EINPUT also for coordinates that are too large for its 32-bit numbers. */
thr_status thr_polylines_gltf(const thr_plan *plan, const thr_line_options *options, thr_text *out,
                              thr_err *err) THR_MUST_CHECK;

/* Writes DXF of release 12 with $INSUNITS: per cord a layer in the colour nearest to the overview's
 * and a polyline in space, its vertices in the order of the passes; the labels of the options as
 * texts on a layer "places". */
thr_status thr_polylines_dxf(const thr_plan *plan, const thr_line_options *options, thr_text *out,
                             thr_err *err) THR_MUST_CHECK;

/* Writes JSON as COMPAS loads it: {"units": .., "up": .., "cords": [ .. ]}, each cord a
 * compas.geometry/Polyline with its name. */
thr_status thr_polylines_compas(const thr_plan *plan, const thr_line_options *options,
                                thr_text *out, thr_err *err) THR_MUST_CHECK;

/* ---- outlines.c: draws what pieces look like on paper. */

/* Appends the outline of the solid piece at a point as path data: arms to the middles of its edges,
 * less half the gap between two faces; between neighbouring arms the corner where their sides meet.
 * Arms that stand too close for their width are narrower. */
void thr_outline_solid(const thr_scene *scene, int point, thr_text *data);

/* Returns a box around the arms of the piece at a point. */
thr_box thr_outline_box(const thr_scene *scene, int point);

/* Computes the ends of the middle line of edge e's tube, half its width from its round ends. */
void thr_outline_tube(const thr_scene *scene, int e, double width, double end[2][2]);

/* ---- arms.c: draws a solid piece with a pen: strokes from its hub to the ends of its arms, for
 * small pictures and for views in space, where an outline in one line would have arms in front of
 * each other. */

enum { THR_ARMS = 64 }; /* of a piece are drawn, at most */

/* A piece on paper. */
typedef struct {
  double hub[2];           /* mm on paper */
  int n;                   /* arms, at most THR_ARMS */
  double end[THR_ARMS][2]; /* where they end */
  double width;            /* of an arm */
  const char *fill, *outline;
  double line; /* width of the outline */
} thr_arms;

/* Appends the piece in two elements. */
void thr_arms_draw(const thr_arms *arms, thr_text *text);

/* Appends path data of its strokes, whose ends are so far from the ends of its arms; {0} of a piece
 * without arms. */
void thr_arms_strokes(const thr_arms *arms, double back, thr_text *data);

/* Appends path data of the way of a cord through it: in by arm `in`, out by arm `out`; -1: it
 * starts or ends at the hub. And of the tip at the end of that way. width: of the cord, mm. */
void thr_arms_way(const thr_arms *arms, int in, int out, double width, thr_text *data);
void thr_arms_tip(const thr_arms *arms, int out, double width, thr_text *data);

/* ---- shadow.c: draws the whole of a framework in so small a picture that its lines would run
 * together: as the area that the lines cover. */

enum { THR_SHADOW_CELLS = 64 }; /* across, at most */

/* The cells that lines cover. */
typedef struct {
  thr_box paper;
  double cell; /* mm */
  bool covered[THR_SHADOW_CELLS][THR_SHADOW_CELLS];
} thr_shadow;

/* Returns a shadow of nothing. */
thr_shadow thr_shadow_on(thr_box paper);

/* Adds a line; what is beyond the paper counts as on its edge. O(its length). */
void thr_shadow_line(thr_shadow *shadow, const double a[2], const double b[2]);

/* Appends the area as one element. */
void thr_shadow_put(const thr_shadow *shadow, const char *colour, thr_text *text);

/* Appends the edges of a framework in small, within the paper: lines of their own if the pitch on
 * paper, mm, leaves room between them, else the area that they cover. Node v lies at at[stride *
 * v], mm. O(edges). */
void thr_shadow_edges(const thr_frame *frame, const double *at, int stride, double pitch,
                      thr_box paper, thr_text *text);

#endif
