/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction of joints by simulation: a cord is dragged through one bead joint in Bullet, and cords
 * are composed of joints measured like this (method joint).
 *
 * Reading order: drag.c (one experiment: protocol, channels, chain, measuring), joint.c (a table of
 * joints, and the exponents of whole cords from it), cache.c (joints measured before). Below them:
 * world.h and bullet.cpp (rigid bodies in Bullet behind a C interface). */
#ifndef THR_JOINT_H
#define THR_JOINT_H

#include "eval/eval.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- drag.c: measures the friction of a cord dragged through bead joints in Bullet: a chain of
 * small spheres linked by one-row distance constraints, in channels of convex walls. */

/* An experiment. All lengths in cord radii, forces in hold-back tensions. */
typedef struct {
  int n_turns;         /* 1 for a joint; more for the validation of whole cords */
  const double *turn;  /* [n_turns] rad, 0 .. pi; borrowed */
  const double *twist; /* [n_turns] rad, rotation of each turn's plane about the channel before it;
                          NULL = all in one plane; borrowed */
  double segment;      /* length of the channel between two turns; 0 = the protocol's */
  double bore;         /* bore diameter / cord diameter, > 1 */
  double mu;           /* cord on bead, >= 0 */
  uint64_t seed;
  double time_step, iterations, spacing; /* factors on the protocol's, 1 */
  int sides;                             /* of the polygonal bore; 0 = the protocol's */
  double settle;                         /* factor on the travel before averaging; 0 = 1 */
} thr_drag;

/* Out of range: a turn above thr_drag_largest_turn, mu above 1, bore below 1.01, bore cos(turn / 2)
 * below 0.7 (deeply wedged), a ratio expected above exp(4), straights too short for the turns, more
 * than 100,000 spheres. Nothing is measured then. */
typedef enum { THR_DRAG_SETTLED, THR_DRAG_UNSETTLED, THR_DRAG_OUT_OF_RANGE } thr_drag_status;

/* What an experiment gave. */
typedef struct {
  int status;   /* thr_drag_status */
  double ratio; /* mean tension at the drag end / at the hold end, in steady sliding; 0 if out of
                   range */
  double drift; /* relative change of the ratio between the two halves of the averaging window: its
                   settling error */
  double scatter; /* standard error of the ratio's mean over blocks, relative */
  double taut;    /* rad, turning of the mean path of the cord while averaging */
  double steps;   /* taken */
} thr_drag_result;

/* What the protocol was validated for: the largest single turn, rad; bore diameter / cord diameter.
 */
extern const double thr_drag_largest_turn, thr_drag_least_bore, thr_drag_largest_bore;

/* Returns the largest turn, rad, that a cord takes in one line of contact in a bore of so many cord
 * diameters: 2 acos(1 / bore). The opening of a mitred round bore is an ellipse whose end is as
 * round as the cord there; in sharper turns the cord wedges between two points of the rim, and its
 * friction exceeds the capstan law (bore 2: 120 degrees, bore 1.1: 49). Wedged joints are measured
 * like others; no closed form confirms them. */
double thr_drag_round_turn(double bore);

/* Returns the relative error of a measured ratio: the sum of drift, twice the scatter, and bounds
 * of what they do not show (the chain's polygon, its inertia and impacts, the flat sides of the
 * bore where the cord wedges).
 */
double thr_drag_error(const thr_drag *drag, const thr_drag_result *result);

/* Returns the numbers of the protocol as text, which is a part of the cache's key. */
const char *thr_drag_protocol(void);

/* Runs an experiment. THR_EINPUT for absurd values, THR_ELIMIT when stopped. Deterministic on one
 * machine. 0.1 to 0.3 s a joint up to mu 0.5, up to 10 s beyond or where the cord wedges. Channels
 * of more turns must not cross one another. */
thr_status thr_drag_measure(const thr_drag *drag, const thr_limits *limits, thr_drag_result *out,
                            thr_err *err) THR_MUST_CHECK;

/* ---- joint.c: composes measured joints along taut cords, with the measuring function as a
 * parameter. */

/* Where the friction of one joint comes from: thr_drag_measure, or in tests a law that is known
 * exactly. Called in a child process, without limits. */
typedef struct {
  thr_status (*measure)(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                        thr_err *err);
  double (*error)(const thr_drag *, const thr_drag_result *); /* relative, of a measured ratio */
  double largest_turn;                                        /* rad, that it is good for */
  double least_bore, largest_bore; /* bore / cord diameter, that it is good for */
} thr_joint_source;

/* Step of the grid of angles that are measured, rad; what lies between is interpolated. */
extern const double thr_joint_step;

/* Evaluates a plan like thr_joint_method, with another source. A joint's friction per rad,
 * ln(ratio) / turn, belongs to its shape: it is that of its nominal turn, interpolated linearly
 * between measured angles (below the smallest one: that one's). It is paid for the rad by which the
 * taut cord turns there. A turn that needs a joint above largest_turn, or one that is out of range
 * or did not settle, takes the closed form mu x taut turn and counts as refused; taut turns below
 * 1e-6 rad cost nothing.
 *
 * A cord's error is the sum over the turns between its slackest pass and an end (the larger of
 * both) of the errors of the exponents, as if all erred to one side. Each is made of the source's
 * error of the joints; the error of interpolation, as seen at measured angles when they are left
 * out (that is over twice the step: for a smooth law four times the error made; where the third did
 * not settle, the difference of the two); and the difference between the friction per rad at the
 * nominal and at the taut turn, which is what the shape of the joint makes out. Of a refused turn's
 * error nothing is known: that of its cord is the other turns' only. THR_EINPUT if the bore is out
 * of the source's range, or if every turn that costs anything is refused, so that nothing was
 * measured. O(passes) but for the joints.
 */
thr_status thr_joint_compose(const thr_frame *frame, const thr_cord *cord,
                             const thr_eval_options *options, const thr_limits *limits,
                             const thr_joint_source *source, thr_eval *out,
                             thr_err *err) THR_MUST_CHECK;

/* ---- cache.c: keeps measured joints, one small text file each in a folder. */

/* Appends the key: everything that a measurement depends on, in plain text: the protocol, Bullet's
 * version, and all of drag (n_turns must be 1).
 */
void thr_cache_key(const thr_drag *drag, thr_text *key);

/* Appends a file's contents: the key, the values with as many digits as reading them back exactly
 * needs, and a checksum. */
void thr_cache_write(const thr_text *key, const thr_drag_result *result, thr_text *out);

/* Reads n bytes back. Returns false, and *out unchanged, unless they are exactly what
 * thr_cache_write makes of this key and some finite result. */
bool thr_cache_parse(const char *text, size_t n, const thr_text *key, thr_drag_result *out);

/* Reads the file of a joint. Returns false if the folder holds no sound file for drag. */
bool thr_cache_load(const char *folder, const thr_drag *drag, thr_drag_result *out);

/* Makes the folder if need be, and writes the file of a joint whole or not at all. THR_EIO if it
 * cannot; THR_EINPUT for a result that is not finite. */
thr_status thr_cache_store(const char *folder, const thr_drag *drag, const thr_drag_result *result,
                           thr_err *err) THR_MUST_CHECK;

#endif
