/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of a plan as solids to print: nodes with an arm to the middle of each edge, or tubes
 * along edges, with a channel for every way that cords take through them (M. Nelson, thesis,
 * Cornell, chapter 1, "graph augmentation").
 *
 * The folder kit/ makes them. Reading order: kit.c (a kit from a plan: edges, then pieces, then
 * meshes), edges.c (width, bore and lanes of every edge), channels.c (curves through a piece),
 * body.c (the solid as a distance), capsules.c (only what is near counts), strokes.c (letters),
 * mesh.h with mesher.c, simplify.c and mesh.c (the surface of a solid), plates.c (pieces on the bed
 * of a printer), write_3mf.c, write_scad.c, kit_tables.c (files). Lengths are in mm, angles in rad,
 * masses in g. */
#ifndef THR_KIT_H
#define THR_KIT_H

#include "diagram/layout/layout.h"
#include "diagram/scene/scene.h"
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"
#include "kit/mesh.h"

#include <stdbool.h>

/* ---- what is asked for ---- */

typedef enum { THR_KIT_ROUND, THR_KIT_SQUARE, THR_KIT_HEX, THR_KIT_N_PROFILES } thr_kit_profile;
typedef enum { THR_KIT_NO_KEY, THR_KIT_CONE, THR_KIT_PIN, THR_KIT_N_KEYS } thr_kit_key;
typedef enum { THR_KIT_BORE, THR_KIT_LANES, THR_KIT_N_CHANNELS } thr_kit_channels;
typedef enum {
  THR_KIT_OF_PIECES,
  THR_KIT_OF_KINDS,
  THR_KIT_NO_NAMES,
  THR_KIT_N_NAMES
} thr_kit_names;
typedef enum { THR_KIT_MITRED, THR_KIT_ROUNDED, THR_KIT_N_TUBE_ENDS } thr_kit_tube_ends;

/* {0} is the usual kit. */
typedef struct {
  double width;     /* of arms and tubes; 0 = the bead diameter of the plan's physics */
  double taper;     /* width at the node as a part of that at the face; 0 = 1 */
  double fillet;    /* radius between arms; < 0 = none, 0 = 0.15 of the width */
  double gap;       /* between the faces of neighbours */
  double wall;      /* at least; 0 = 1.2, or less where the sizes were worked out and leave less */
  double density;   /* g/cm3; 0 = as the plan's physics says */
  double key_angle; /* rad, between a key's flank and its axis; 0 = 45 degrees, a pin's 5 */
  double letters;   /* height of capitals; 0 = 4 */
  double bed[2];    /* of the printer; 0 = 220 x 220 */
  double kind_tolerance; /* in units of the framework, as in thr_kinds_find; 0 = the usual one */
  thr_kit_profile profile;
  thr_kit_key key;
  thr_kit_channels channels;
  thr_kit_names names;
  thr_kit_tube_ends tube_ends;
  double coarse;     /* factor on the sizes of triangles, for pictures; 0 = 1 */
  bool knot_pockets; /* where cords end, a hollow for the knot */
} thr_kit_options;

/* Return the words of these options, in the order of the enumerations. */
const char *thr_kit_profile_name(int i);
const char *thr_kit_key_name(int i);
const char *thr_kit_channels_name(int i);
const char *thr_kit_names_name(int i);
const char *thr_kit_tube_ends_name(int i);

/* ---- edges.c: what both pieces of an edge agree on. */

enum { THR_KIT_MOST_LANES = 37, THR_KIT_MOST_ARMS = 64 };

/* An edge. Directions are those of half-edge 2 e, from its tail to its head. */
typedef struct {
  double along[3], up[3], side[3]; /* unit vectors at right angles; up: outwards of the framework */
  double length;                   /* between the nodes */
  double width, bore;              /* of its arms or tube, and of each of its channels */
  int n_lanes; /* passes; one bore holds all of them unless lanes are asked for */
  double lane[THR_KIT_MOST_LANES][2]; /* where a channel is on the face: along up and side */
} thr_kit_edge;

/* Where the passes of a plan are on the faces. */
typedef struct {
  thr_kit_edge *edge; /* [n_edges] */
  int *first_pass;    /* [n_cords + 1] */
  int *lane;          /* [passes of all cords] lane of a pass on its edge */
  thr_scratch own;    /* the arrays */
} thr_kit_edges;

/* Sizes in mm that the kit is made with. */
typedef struct {
  double mm; /* per unit */
  double cord, width, wall;
  bool wall_given; /* else it may be less where edges are narrow */
} thr_kit_sizes;

/* Fills edges->edge[n_edges], whose bores are set, with directions, widths that fit and lanes, and
 * gives each pass its lane. Edges that meet at an acute angle are made narrower, so that their
 * faces do not meet; notes say which. THR_EINPUT names the node, and the number that would do.
 * O(edges of a node squared). */
thr_status thr_kit_edges_make(thr_kit_edges *edges, const thr_plan *plan,
                              const thr_kit_options *options, thr_kit_sizes *sizes,
                              const char (*label)[THR_LABEL], thr_text *notes,
                              thr_err *err) THR_MUST_CHECK;

/* ---- a piece ---- */

/* An arm of a piece, or one half of a tube. */
typedef struct {
  int half; /* half-edge that leaves the node; of a tube that leads to its end */
  double along[3], up[3], side[3]; /* unit vectors at right angles; along: from the centre */
  double length;                   /* from the centre to the face */
  double width;                    /* at the face */
  bool key_out;                    /* its key stands out; the neighbour's is hollow */
  int n_mitres;                    /* of a tube's end: planes that cut it instead of its face */
  double tip;                      /* how far a tube's mitred end reaches beyond its length */
  double (*mitre)[4]; /* [n_mitres] unit normal outwards, and its distance from the centre */
} thr_kit_arm;

/* A hollow along a curve. */
typedef struct {
  int cord, pass;          /* by which the cord comes in; as in thr_channel */
  int in, out;             /* arms of the piece; -1 = outside: the cord ends here */
  double radius;           /* the least .. */
  double radii[2];         /* .. at its two ends; in between it changes evenly */
  int n;                   /* >= 2 */
  double (*point)[3];      /* [n] from the piece's centre; owned */
  double middle[3], reach; /* a ball that holds the curve */
  double bend;             /* least radius of the curve; INFINITY: straight */
  double wall;             /* least thickness of material beside the channel */
  bool mouth[2];           /* its first and last end is a mouth in a face, and is rounded */
} thr_kit_channel;

/* A letter's stroke, on the side of an arm that looks up: from .. to in mm along the arm and
 * across it. */
typedef struct {
  int arm;
  bool below; /* on the other side */
  double from[2], to[2];
} thr_kit_stroke;

/* A piece: what the body is made of. Arrays are owned. */
typedef struct {
  int piece;      /* node or edge of the framework */
  int kind, like; /* number of its kind, from 1; the piece whose mesh it shares, itself for one */
  int count;      /* of a piece with a mesh: how many pieces share it */
  double place[9], centre[3]; /* rotation by rows, and place: from the mesh to the assembly */
  bool tube, rounded;
  int n_arms, n_channels, n_strokes;
  thr_kit_arm *arm;
  thr_kit_channel *channel;
  thr_kit_stroke *stroke;
  double node_radius, fillet, taper, mouth; /* mouth: radius of the rounding */
  double coarse;                            /* factor on sizes of triangles */
  double wall;                              /* that there is at least */
  thr_kit_profile profile;
  thr_kit_key key;
  double key_slope, key_radius, key_height, key_play;
  double letter_width, letter_depth;
  bool foot;        /* it stands on a flat base .. */
  double base, pad; /* .. so far below its centre, of this radius */
  int n_pockets;
  double (*pocket)[8]; /* [n_pockets] a capsule: two ends, radius; owned */
} thr_kit_piece;

/* ---- capsules.c: which of many capsules are nearest to a point. */

/* A segment with a radius at each end. */
typedef struct {
  double from[3], along[3]; /* one end; from it to the other one */
  double inverse;           /* of the square of its length; 0 for a point */
  double radius[2];
  double more; /* how far beyond the radius what stands for it may reach */
  int of;      /* the caller's number */
  bool last;   /* it is at the second end of what it is of */
} thr_capsule;

/* A cell of an octree: its list is members first .. first + n - 1, not known yet if n is -1; its
 * first part, or -1. */
typedef struct {
  int first, n, child;
} thr_capsule_cell;

/* Lists of capsules for the cells of an octree. {0} is valid and empty. Arrays are owned. */
typedef struct {
  thr_capsule *capsule;
  thr_capsule_cell *cell; /* [0]: the whole */
  int *member;
  int axes;                   /* 3, or 2: all ends have z = 0 */
  double low[3], side, least; /* mm: the whole; so small cells are not parted */
  int n_capsules, n_cells, n_members, capsules_capacity, cells_capacity, members_capacity;
  thr_err failure; /* why it could not grow; its lists are longer then, and as right */
} thr_capsules;

/* Returns the distance of a point from the capsule's segment; *part: where on it, 0 .. 1. */
double thr_capsule_distance(const thr_capsule *capsule, const double at[3], double *part);

/* Appends a capsule between two points, before the tree is made; how: its other members.
 * THR_ENOMEM. */
thr_status thr_capsules_add(thr_capsules *tree, const double from[3], const double to[3],
                            const thr_capsule *how, thr_err *err) THR_MUST_CHECK;

/* Makes a tree of all capsules, for points in the cube (if axes is 2: square) from low to high.
 * THR_ENOMEM. */
thr_status thr_capsules_make(thr_capsules *tree, int axes, const double low[], const double high[],
                             double least, thr_err *err) THR_MUST_CHECK;

/* Returns the numbers, ascending, of n capsules. Each that may be nearest to the point is among
 * them: the distance is from the segment, less the radius, less `more` at most. The tree grows, so
 * that one thread at a time may ask. O(depth of the tree). */
const int *thr_capsules_list(thr_capsules *tree, const double at[3], int *n);

void thr_capsules_destroy(thr_capsules *tree);

/* ---- body.c: a piece as a distance. */

/* A piece with what makes its distance fast to compute. {0} is valid and empty. */
typedef struct {
  const thr_kit_piece *piece; /* borrowed */
  double thinnest;            /* of its arms */
  thr_capsules hollow;        /* segments of channels, and pockets (of = -1) */
  thr_capsules *letters;      /* [2 * n_arms] strokes on either side of each arm, or NULL */
} thr_kit_solid;

/* Makes the solid of a piece. Empty on failure. THR_ENOMEM. */
thr_status thr_kit_solid_make(thr_kit_solid *solid, const thr_kit_piece *piece,
                              thr_err *err) THR_MUST_CHECK;

/* THR_ENOMEM if one of its trees could not grow. */
thr_status thr_kit_solid_check(const thr_kit_solid *solid, thr_err *err) THR_MUST_CHECK;
void thr_kit_solid_destroy(thr_kit_solid *solid);

/* Distance to the surface of the piece without its channels, faces, letters and base, mm; below 0
 * inside. *arm receives the nearest arm, -1: the node, -2: the foot. NULL ok. */
double thr_kit_body(const thr_kit_piece *piece, const double at[3], int *arm);

/* Sample of the whole piece, for thr_mesh_make; user: a thr_kit_solid, whose trees grow. */
void thr_kit_sample(void *user, const double at[3], thr_solid_sample *out);

/* ---- channels.c: curves through a piece. */

/* Makes the curve of a channel whose arms, cord, pass and radius are set, from the lanes start and
 * end (in the two arms, along up and side). out: the direction of an end outside. The curve bends
 * as little as the material allows. THR_ENOMEM. */
thr_status thr_kit_channel_make(const thr_kit_piece *piece, thr_kit_channel *channel,
                                const double start[2], const double end[2], const double out[3],
                                double wall, thr_err *err) THR_MUST_CHECK;

/* ---- alike.c: pieces that are the same solid. */

/* Can `other` be turned, not mirrored, so that it is `piece` with all arms, channels and feet,
 * within a tolerance in mm? rotation[9], by rows, then takes `piece` to `other`. Pieces with
 * letters are never alike. O(arms^3). */
bool thr_kit_alike(const thr_kit_piece *piece, const thr_kit_piece *other, double tolerance,
                   double rotation[9]);

/* ---- strokes.c: letters of single strokes. */

/* Appends the strokes of words on an arm, from `at` along it, of capitals of a height; *room
 * receives the length of the words, also if stroke is NULL. Letters that it does not know are
 * boxes. */
int thr_kit_strokes(const char *words, double height, thr_kit_stroke *stroke, int most,
                    double *room);

/* ---- kit.c ---- */

/* All pieces of a plan. {0} is valid and empty. Arrays are owned; the plan is borrowed. */
typedef struct {
  const thr_plan *plan;
  thr_kit_options options; /* with what was worked out */
  double mm;               /* per unit of the framework */
  double cord;             /* diameter */
  thr_kit_edges edges;
  int n_pieces, n_meshes, n_kinds;
  thr_kit_piece *piece;    /* [n_pieces] */
  thr_mesh *mesh;          /* [n_pieces] empty where another piece's is shared */
  thr_mesh_report *report; /* [n_pieces] of those that have one */
  char (*name)[64];        /* [n_pieces] as in all documents */
  char (*kind_name)[24];   /* [n_kinds + 1] */
  thr_text notes;          /* what a maker should know, a line each */
  double volume, mass;     /* of all pieces, mm3 and g */
} thr_kit;

/* Makes the pieces of a plan: shapes, and the meshes too if asked for, in limits->threads threads.
 * THR_EINPUT says which piece does not fit and the number that would do. THR_ELIMIT when stopped.
 * Release with thr_kit_destroy, after a failure too. O(pieces). */
thr_status thr_kit_make(thr_kit *kit, const thr_plan *plan, const thr_kit_options *options,
                        const thr_layout *layout, bool meshes, const thr_limits *limits,
                        thr_err *err) THR_MUST_CHECK;
void thr_kit_destroy(thr_kit *kit);

/* Fills place with a point of a piece's mesh in the assembled framework, mm. */
void thr_kit_place(const thr_kit_piece *piece, const double at[3], double place[3]);

#endif
