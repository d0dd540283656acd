/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of a plan as solids to print: nodes with an arm to the middle of each edge, or tubes
 * along edges, with a channel for every way that cords take through them (M. Nelson, thesis,
 * Cornell, chapter 1, "graph augmentation").
 *
 * The folder kit/ makes them. Reading order: kit.c (a kit from a plan: edges, then pieces, then
 * meshes), edges.c (width, bore and lanes of every edge), channels.c (curves through a piece),
 * cuts.c and walls.c (those that cut each other; what is thin), body.c (the solid as a distance),
 * capsules.c (only what is near counts), strokes.c (letters), estimate.c (the kit without meshes),
 * mesh.h with mesher.c, simplify.c and mesh.c (the surface of a solid), bodies.c (what eval/
 * takes), plates.c (pieces on the bed of a printer), write_3mf.c, write_scad.c, kit_tables.c
 * (files). Lengths are in mm, angles in rad, masses in g. */
#ifndef THR_KIT_H
#define THR_KIT_H

#include "diagram/layout/layout.h"
#include "diagram/scene/scene.h"
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/text.h"
#include "kit/mesh.h"

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
typedef enum { THR_KIT_MEET, THR_KIT_APART, THR_KIT_N_CROSSINGS } thr_kit_crossings;
typedef enum { THR_KIT_HOLE, THR_KIT_HOOK, THR_KIT_N_FEET } thr_kit_foot;
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
  thr_kit_crossings crossings; /* of channels that the plan crosses in a piece */
  thr_kit_names names;
  thr_kit_tube_ends tube_ends;
  thr_kit_foot foot; /* what holds a cord that ends at one */
  double coarse;     /* factor on the sizes of triangles, for pictures; 0 = 1 */
  bool knot_pockets; /* where cords end, a hollow for the knot */
  bool to_print;     /* before any mesh is made, pieces larger than the bed are refused */
  const char *only;  /* name of the piece that alone gets its mesh, for pictures; NULL = all */
} thr_kit_options;

/* Return the words of these options, in the order of the enumerations. */
const char *thr_kit_profile_name(int i);
const char *thr_kit_key_name(int i);
const char *thr_kit_channels_name(int i);
const char *thr_kit_crossings_name(int i);
const char *thr_kit_names_name(int i);
const char *thr_kit_foot_name(int i);
const char *thr_kit_tube_ends_name(int i);

/* ---- edges.c: what both pieces of an edge agree on. */

enum { THR_KIT_MOST_LANES = 37, THR_KIT_MOST_ARMS = 64 };

/* An edge. Directions are those of half-edge 2 e, from its tail to its head. */
typedef struct {
  double along[3], up[3], side[3]; /* unit vectors at right angles; up: to the side of the
                                      framework that the booklet shows */
  double length;                   /* between the nodes */
  double width, bore;              /* of its arms or tube, and of each of its channels */
  int beside;                      /* edge beside which it is narrower than asked for, if it is */
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
  double node;     /* radius of a node, as a part of the width */
  bool wall_given; /* else it may be less where edges are narrow */
  double roomy;    /* width at which it would not be; 0: none is, beside other edges */
} thr_kit_sizes;

/* Fills edges->edge[n_edges], whose bores are set, with directions, widths that fit and lanes, and
 * gives each pass its lane. shown[n_nodes]: unit vectors towards the viewer of the booklet's
 * pictures, 0 where none is known; NULL: none is. Edges that meet at an acute angle, or come near
 * an edge of other nodes, are made narrower, so that pieces do not meet; notes say which.
 * THR_EINPUT names both edges, and the number that would do. O(edges of a node squared + edges near
 * each other). */
thr_status thr_kit_edges_make(thr_kit_edges *edges, const thr_plan *plan,
                              const thr_kit_options *options, thr_kit_sizes *sizes,
                              const char (*label)[THR_LABEL], const double (*shown)[3],
                              thr_text *notes, thr_err *err) THR_MUST_CHECK;

/* Fills off[passes of all cords] with how far each pass lies from the axis of its bore, mm: passes
 * that share one lie around it, so that cords of a diameter are told apart. O(passes + edges).
 * THR_ENOMEM. */
thr_status thr_kit_edges_share(const thr_kit_edges *edges, const thr_plan *plan, double cord,
                               double (*off)[3], thr_err *err) THR_MUST_CHECK;

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
  double wall;             /* least thickness of material beside its bend */
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
  double wall;                              /* that there is to be at least */
  double thinnest;                          /* wall of the finished solid; 0: not measured */
  thr_kit_profile profile;
  thr_kit_key key;
  double key_slope, key_radius, key_height, key_play;
  double letter_width, letter_depth;
  bool foot;                      /* it stands on a flat base, below all of its arms .. */
  double base, pad;               /* .. so far below its centre, of this radius */
  double hook[3][3], hook_radius; /* a bar from the foot, out and up; radius 0: it has none */
  int cuts, crossings; /* pairs of channels that open into each other where the plan has no
                          crossing, and where it has */
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

/* Radius of the rounded corners of a profile, as a part of that of its inner circle. */
static const double THR_KIT_ROUNDING = 0.25;

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
 * inside. *arm receives the nearest arm, -1: the node, -2: the foot, -3: its hook. NULL ok. */
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

/* Measures a curve after its points were set: the least wall beside its bend, its least radius,
 * the ball round it. */
void thr_kit_channel_measure(const thr_kit_piece *piece, thr_kit_channel *channel);

/* ---- cuts.c: channels that cut each other. */

/* Returns the least distance between two segments, by their ends; part[2] receives where on each,
 * 0 .. 1. */
double thr_kit_segments(const double a[2][3], const double b[2][3], double part[2]);

/* Returns how much material is between two channels; below 0 where they open into each other;
 * INFINITY if they are far apart. */
double thr_kit_gap(const thr_kit_channel *a, const thr_kit_channel *b);

/* Do two channels begin or end in the same mouth, or both leave the piece in the same way? */
bool thr_kit_same_mouth(const thr_kit_channel *a, const thr_kit_channel *b);

/* Moves channels of a node's piece apart that cut each other without need, or at all if they are to
 * be apart, as far as `wall` stays between them and beside them, and counts the pairs that cut each
 * other then. rank: as in thr_channels. O(channels squared). */
void thr_kit_cuts(thr_kit_piece *piece, const int *rank, bool apart, double wall);

/* ---- walls.c */

/* Measures the thinnest wall of a piece in mm, by rays through the solid; INFINITY if it has no
 * channels. THR_ENOMEM. O(channels (points + channels)) samples. */
thr_status thr_kit_thinnest(const thr_kit_piece *piece, double *thinnest,
                            thr_err *err) THR_MUST_CHECK;

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
  int only;                /* the piece of this name in the options, from 1; 0 = all */
  int n_unnamed_kinds;     /* kinds if the pieces had no letters */
  int n_shapes;            /* kinds by shape alone, as in all other documents */
  thr_kit_piece *piece;    /* [n_pieces] */
  thr_mesh *mesh;          /* [n_pieces] empty where another piece's is shared */
  thr_mesh_report *report; /* [n_pieces] of those that have one */
  char (*name)[64];        /* [n_pieces] as in all documents */
  char (*kind_name)[24];   /* [n_kinds + 1] */
  thr_text notes;          /* what a maker should know, a line each */
  double volume, mass;     /* of all pieces, mm3 and g */
} thr_kit;

/* Makes the pieces of a plan: shapes, and the meshes too if asked for, in limits->threads threads.
 * THR_EINPUT says which piece does not fit and the number that would do, or that none is called so.
 * THR_ELIMIT when stopped. Release with thr_kit_destroy, after a failure too. O(pieces). */
thr_status thr_kit_make(thr_kit *kit, const thr_plan *plan, const thr_kit_options *options,
                        const thr_layout *layout, bool meshes, const thr_limits *limits,
                        thr_err *err) THR_MUST_CHECK;
void thr_kit_destroy(thr_kit *kit);

/* ---- bodies.c: pieces for the limit analysis. */

/* Fills outline[0] with a polygon of n <= THR_MOST_CORNERS corners inside a profile, and outline[1]
 * with one round it, in halves of the width along up and side; returns n. */
int thr_kit_outline(thr_kit_profile profile, double outline[2][THR_MOST_CORNERS][2]);

/* Measures the pieces of a kit of nodes, which has its meshes: masses and mass centres by the
 * meshes, faces by their profile. THR_EINPUT for a kit of tubes, *out is empty
 * on failure. */
thr_status thr_kit_bodies(const thr_kit *kit, thr_bodies *out, thr_err *err) THR_MUST_CHECK;

/* Fills place with a point of a piece's mesh in the assembled framework, mm. */
void thr_kit_place(const thr_kit_piece *piece, const double at[3], double place[3]);

/* ---- estimate.c: what a kit will be, without meshes. */

/* What is known of the kit without options. 0: not known, as for frameworks of more than 1000
 * pieces, and where the framework's unit has no length. */
typedef struct {
  bool solid;          /* else pieces are tubes */
  int pieces, shapes;  /* shapes: kinds of pieces without channels, as in all other documents */
  int kinds;           /* with their channels, but without names */
  double width;        /* of arms or tubes, mm */
  double volume;       /* of all pieces, mm3, within 1 % */
  double mass;         /* g, of the volume and the density */
  thr_physics physics; /* as the plan asks for, of which the kit knows no bead_mass: 0 */
  thr_err refused; /* why no kit can be made with the usual sizes, or, where the volume is known,
                      why some pieces do not fit the usual bed; code 0: it can */
} thr_kit_estimate;

/* Estimates the kit of a plan. THR_ENOMEM, and THR_EINPUT for a plan without cords. Takes some
 * tenths of a second at most. */
thr_status thr_kit_estimate_make(thr_kit_estimate *estimate, const thr_plan *plan,
                                 thr_err *err) THR_MUST_CHECK;

/* Returns what all pieces of an estimate weigh, N: solid, of the mass that physics give each, else
 * of their density. The pull that holds pieces is in proportion to it. 0 where it is not known. */
double thr_kit_weight(const thr_kit_estimate *estimate, const thr_physics *physics);

/* Fills volume with that of all pieces in mm3, sampled within 1 % from their shapes. The kit needs
 * no meshes. THR_ENOMEM. */
thr_status thr_kit_sampled_volume(const thr_kit *kit, double *volume, thr_err *err) THR_MUST_CHECK;

#endif
