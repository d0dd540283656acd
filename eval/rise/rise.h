/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets a structure rise in simulation: loose pieces with real faces, cords through their mouths,
 * hands that pull the cords (M. Nelson, thesis, Cornell, chapters 6 and 7).
 *
 * Reading order: loose.c (pieces in Bullet, and where they begin), cable.c (how tension spreads
 * along a cord whose pieces move), hands.c (who pulls when, and the steps of a schedule), rise.c
 * (time passes: hands pull, pieces move, what is seen is written down), kinks.c (where faces are,
 * and their kinks), fit.c (how far the shape is from the drawn one). Contacts and friction are
 * those of Bullet's own solver, the bodies are convex parts, and nothing is known of the limit
 * analysis: a second opinion.
 *
 * Lengths are in mm, masses in g, forces in N, times in s, angles in rad; up is +z, and the ground
 * is z = 0. */
#ifndef THR_RISE_H
#define THR_RISE_H

#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/status.h"

/* ---- what rises ---- */

/* A piece as it is drawn in the closed structure. Arrays are owned by who made them. */
typedef struct {
  double centre[3];      /* its node */
  double mass;           /* g, > 0 */
  double mass_centre[3]; /* from the node */
  double moment;         /* g mm2 about the mass centre: the mean of those about three axes */
  int n_parts;           /* >= 1, convex */
  const int *n_corners;  /* [n_parts] of each part; those of all parts follow each other in .. */
  const double (*corner)[3]; /* .. this, from the node */
  bool held;                 /* it cannot move */
  bool down;                 /* it slides on the ground, but does not lift off or tip */
} thr_rise_piece;

/* A cord: pass k leads from piece[k] through the mouth mouth[k] to piece[k + 1]. */
typedef struct {
  int n_passes;
  const int *piece;         /* [n_passes + 1] */
  const double (*mouth)[3]; /* [n_passes] where the closed faces' mouths are */
  const double (*along)[3]; /* [n_passes] unit: the way the cord takes there */
  const double *wobble;     /* [n_passes - 1] exponents beside those of turns; NULL: none */
  bool pulled[2];           /* at its start, at its end; an end that is not is tied to its piece */
  bool slack;               /* nobody pulls it: it exerts nothing, and its faces do not count */
  const double (*place)[7]; /* [n_pieces] the node of each piece, and its rotation from where it was
                               drawn, x y z w, in the shape that this cord closes, which is that of
                               mouth and along; NULL: as drawn */
} thr_rise_cord;

typedef struct {
  int n_pieces, n_cords;
  const thr_rise_piece *piece;
  const thr_rise_cord *cord;
  const double (*laid)[7]; /* [n_pieces] as thr_rise_cord.place: where THR_RISE_LAID begins */
  const double (*mat)[7];  /* [n_pieces] where nodes lie when all is laid out flat, and how pieces
                              are  turned there, x y z w; NULL: as they are drawn; z is not read */
  double width;            /* of a typical face */
  bool stands_up;          /* on feet, below all else: what lies on its side has not come up */
  double mouth_depth;      /* how far inside the mouth the cord first touches its channel */
  thr_physics physics;     /* resolved: mu, mu_bead, mu_ground, gravity, stiffness and the law of
                              friction count */
} thr_rise_structure;

/* ---- how it is made to rise ---- */

typedef enum {
  THR_RISE_FLAT,  /* flat on the ground, spread as laid out for threading */
  THR_RISE_HEAP,  /* threaded with slack, and dropped: pieces lie as chance has them */
  THR_RISE_SHAPE, /* closed, as drawn */
  THR_RISE_LAID,  /* where structure->laid has them */
  THR_RISE_N_STARTS
} thr_rise_start;
const char *thr_rise_start_name(int start);

/* What hands do: pull all pulled ends, first gently, with up to `pull` N or until all faces have
 * been closed for a while; hold that, and shake the ground if they do; and let down, if they do,
 * until the structure has fallen. Or they do what a schedule says (graph/plan/plan.h), with cords
 * of a known stiffness. A hand may also lift a piece, or dent the structure while the pull is held.
 */
typedef struct {
  thr_rise_start start;
  uint64_t seed; /* of heaps, and of the small disorder of the others */
  double pull;   /* N, > 0 */
  double rate;   /* mm/s at which a hand draws cord in, with up to `pull` N; 0: by force alone */
  double spare;  /* mm of each cord that hands can give out beyond the start; 0: any */
  const thr_schedule *schedule; /* borrowed, of cords and passes that exist; NULL: none, all ends
                                   that cords are pulled at. Else any end can be pulled */
  double slower;                /* factor on the time that hands take; 0 = 1 */
  double hold;                  /* s before they let down; 0 = 1, and 4 with a dent */
  bool let_down;
  double time_step; /* factor on the usual one; 0 = 1 */
  int iterations;   /* of Bullet's solver, in every step; 0 = 60 */
  double lift;      /* N upwards at lifted; 0: no hand lifts */
  int lifted;       /* piece */
  bool carried;     /* .. but no more than brings it to its drawn height */
  double dent;      /* N at dented, towards the middle of all drawn nodes, where the
 counterforce is shared by all pieces; 0: no hand dents */
  int dented;       /* piece, which is pushed in the second quarter of holding */
  double shake;     /* mm that the ground and all that is held go to and fro .. */
  double beat;      /* .. so many times a second, each time in a direction by chance .. */
  double shaken;    /* .. for so many s from when the pull is held, before the hold; 0: never */
} thr_rise_options;

/* ---- what was seen ---- */

/* One moment. */
typedef struct {
  double time, pull; /* N at every pulled end; with a rate or a schedule the largest */
  double drawn;      /* cord that all ends have given out since the start */
  double height;     /* of the highest node over the ground */
  double lift;       /* N */
  double widest;     /* gap */
  double speed;      /* mm/s of the fastest piece */
  double tilt;       /* rad of up, after the best fit of the shape; 0 without stands_up */
  int closed;        /* passes whose faces have met */
} thr_rise_moment;

typedef struct {
  int n_pieces, n_passes, n_frames, room;
  int n_counted;           /* passes of cords that are not slack */
  double between;          /* s between frames */
  thr_rise_moment *moment; /* [n_frames] */
  double (*pose)[7];       /* [n_frames][n_pieces] where the node is, and the piece's rotation from
                              where it was drawn, x y z w */
  double *tension;         /* [n_frames][n_passes] N, cord after cord */

  double weight;       /* N, of all pieces that are not held */
  double drawn_height; /* of the highest node over the lowest */
  int closed;          /* first frame from which on, while the cords were drawn, all faces are
                          closed; -1: they never are */
  int came_up;         /* first one of these from which on it is upright, too; -1 */
  int most_closed;     /* the largest number of passes with closed faces */
  int loosest;         /* pass, counted over all cords, with the widest gap when most were closed */
  double off;    /* largest distance of a node from the drawn shape, after the best fit, at the
                    end of holding */
  double dented; /* the same while a hand dents it, at most */
  double *kink, *twist; /* [n_passes] then, rad: between the axes of the two faces of a pass, and
                           how far the one that it enters is turned about them, -pi to pi */
  bool *open;           /* [n_passes] whose faces have not met then; none of slack cords */
  int held;             /* frames until hands let down */
  bool scheduled;       /* it was pulled by a schedule .. */
  bool finished;        /* .. to its end; or all was seen that was asked for */
  bool stands; /* at the last of these all faces are closed, it is upright, and it is not lower
                  than when they were first, by a tenth of the height */
  int fell;    /* first frame after these that is lower by a tenth of the height; -1 */
} thr_rise_record;

/* Finds the two pieces that overlap most in the closed structure, where faces only touch: piece[2],
 * and *depth, mm; 0 if no two are in each other by more than a part in a hundred of an edge.
 * THR_ENOMEM. O(parts^2) at most. */
thr_status thr_rise_overlap(const thr_rise_structure *structure, int piece[2], double *depth,
                            thr_err *err) THR_MUST_CHECK;

/* Lets a structure rise. progress and time limits come by limits; what was seen until then is kept
 * where they stop it (THR_ELIMIT). THR_EINPUT says what cannot be simulated, and what to do.
 * THR_ESOLVER: the simulation diverged. Release with thr_rise_record_destroy, after a failure too.
 * O(steps (pieces + contacts) iterations). */
thr_status thr_rise_simulate(const thr_rise_structure *structure, const thr_rise_options *options,
                             const thr_limits *limits, thr_rise_record *record,
                             thr_err *err) THR_MUST_CHECK;
void thr_rise_record_destroy(thr_rise_record *record);

/* ---- fit.c */

/* Returns the largest distance between the points to[n] and the points from[n] after the rotation
 * and translation that make the sum of squares least (Horn 1987). rotation: x y z w, and shift:
 * what was done to from; either may be NULL. O(n). */
double thr_fit_points(const double (*from)[3], const double (*to)[3], int n, double rotation[4],
                      double shift[3]);

#endif
