/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The physics of cord and bead, and what follows for one cord: friction, play, the least pull. */
#ifndef THR_PHYSICS_H
#define THR_PHYSICS_H

#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/status.h"

/* ---- physics.c: What the simulation is told about cord and beads: friction, sizes, weights. */

/* Lengths in mm whatever the framework's units. 0 where it says so means "work it out":
 * thr_physics_resolve. */
typedef struct {
  char preset[24];  /* name of the preset this began with, "" = none */
  double mu;        /* friction cord on bead */
  double mu_low;    /* honest band of mu: the sensitivity of every force is shown between them; 0 =
                       half of mu */
  double mu_high;   /* 0 = one and a half mu */
  double mu_bead;   /* friction bead on bead */
  double mu_ground; /* friction foot on ground */
  double cord_diameter; /* mm; 0 = a twentieth of the median edge within 1 .. 3, but no thicker than
                           arms of 0.35 median edge take (1/3 of them), and at most a quarter of
                           the shortest; rounded down to one that is sold (1, 1.2, 1.5, 2, 2.5, 3;
                           .., 0.4, 0.5, 0.6, 0.8) if the units are known */
  double bore;          /* mm, inner diameter of the channels; 0 = twice the cord */
  double bead_diameter; /* mm, outer width of a bead's arm; 0 = the larger of 0.35 median edge
                           and 1.5 bores */
  double density;       /* g/cm3 of the bead's material */
  double bead_mass;     /* g per bead; 0 = density x volume */
  double seating;       /* N: tension that must reach the slackest point of every cord */
  double gravity;       /* m/s2, along -z */
  double wobble;     /* rad per m of cord, added to its turning: bores are not straight (Eurocode 2:
                        0.005 to 0.01 for tendons) */
  double mu_power;   /* friction = a load^n: n, below 1: less friction for the load where that is
                        large; 0 or 1: the capstan law */
  double mu_tension; /* N: tension at which mu holds then; 0 = the seating tension */
  double stiffness;  /* N, EA of the cord: it is longer by force / EA; 0 = not known */
  double bead_strength; /* MPa that a bead's face bears; 0 = not known */
} thr_physics;

typedef struct {
  const char *key;  /* in JSON: "cord_diameter"; the option is the same with dashes */
  size_t offset;    /* of the double in thr_physics */
  double low, high; /* accepted, both inclusive unless positive */
  bool positive;    /* 0 itself is refused */
  bool optional;    /* 0 stays 0, and is not written */
  const char *unit; /* "mm", "" */
  const char *help; /* one line for --help and the docs */
} thr_physics_field;

extern const thr_physics_field thr_physics_fields[];
extern const int thr_physics_n_fields;

/* A named set of values with where each comes from. */
typedef struct {
  const char *name;   /* "pla-cotton", "eps-nylon", "wood-paracord" */
  const char *source; /* a sentence per value that was found, and which are estimates */
  thr_physics physics;
} thr_physics_preset;

extern const thr_physics_preset thr_physics_presets[];
extern const int thr_physics_n_presets;

thr_physics thr_physics_default(void);

/* Field by key ("cord_diameter" or "cord-diameter"), or NULL. */
const thr_physics_field *thr_physics_find(const char *key);
double thr_physics_get(const thr_physics *p, const thr_physics_field *field);
/* THR_EINPUT if out of the field's range or not finite: names the field, the value and what is
 * accepted. A new mu drops the band that came with a preset; a band that was set stays. */
thr_status thr_physics_set(thr_physics *p, const thr_physics_field *field, double value,
                           thr_err *err) THR_MUST_CHECK;
thr_status thr_physics_set_preset(thr_physics *p, const char *name, thr_err *err) THR_MUST_CHECK;

/* Reads an object {"preset": .., "mu": .., "note": ".."}: unknown members are errors. The preset
 * counts first, then mu. place is the file's name and what in it is read, for messages. On failure
 * p is unchanged. */
thr_status thr_physics_from_json(thr_physics *p, const thr_json *object, const char *place,
                                 thr_err *err) THR_MUST_CHECK;
/* A file that holds one such object. */
thr_status thr_physics_read(thr_physics *p, const char *path, thr_err *err) THR_MUST_CHECK;
/* That object, on one line. */
void thr_physics_write(const thr_physics *p, thr_writer *writer, const char *key);

/* Sizes of the edges of a framework, between their nodes. */
typedef struct {
  double median, shortest; /* mm; in units of the framework if nobody knows how long they are */
  int shortest_edge;
  bool in_mm; /* the units are known */
} thr_edge_sizes;

/* Measures the edges. THR_EINPUT if they have no size of beads, which most often means wrong units.
 * O(m log m). */
thr_status thr_measure_edges(const thr_frame *frame, thr_edge_sizes *out,
                             thr_err *err) THR_MUST_CHECK;

/* Returns the diameter of the cord that is taken if none is given and if no edge is very short: mm,
 * as it is sold; in units of the framework, as it comes, if these are not known. */
double thr_usual_cord(const thr_edge_sizes *sizes);

/* Fills in what is 0 = "work it out" and checks that the parts fit: bore > cord, bead > bore,
 * shortest edge > bore, mu_low <= mu <= mu_high, some mass. THR_EINPUT says which value does not
 * fit and what to change. Edges are measured between their nodes. With units that thr_units_in_mm
 * does not know, sizes that were asked for in mm are an error; else a unit counts as a mm, and what
 * needs a true size must ask thr_units_in_mm itself. Resolving twice changes nothing. O(m log m).
 */
thr_status thr_physics_resolve(const thr_physics *p, const thr_frame *frame, thr_physics *out,
                               thr_err *err) THR_MUST_CHECK;

/* ---- friction.c: How the tension of a cord falls over its turns: by a factor, or, where friction
 * grows with less than the load, by more where it is slack. */

typedef struct {
  double power; /* n; 1: the capstan law */
  double at;    /* N: T0 */
} thr_friction;

thr_friction thr_friction_of(const thr_physics *physics);

/* The larger and the smaller tension that turns with this exponent hold apart from tension; 0 where
 * it does not get so far. */
double thr_friction_more(const thr_friction *friction, double tension, double exponent);
double thr_friction_less(const thr_friction *friction, double tension, double exponent);

/* The exponent that holds them apart, 0 < less <= more. */
double thr_friction_exponent(const thr_friction *friction, double more, double less);

/* ---- play.c: How far pieces can shift where their bores are wider than the cord (thesis,
 * Fig. 14). */

typedef struct {
  double gap;  /* mm, at one gap */
  int piece;   /* the first of those farthest from a foot; -1: there is none */
  int gaps;    /* between it and the nearest foot */
  double most; /* mm, if all of them add up */
} thr_play;

/* physics: resolved. Feet are the framework's, or its lowest nodes. O(nodes + edges); THR_ENOMEM.
 */
thr_status thr_play_find(const thr_frame *frame, const thr_physics *physics, thr_play *out,
                         thr_err *err) THR_MUST_CHECK;

/* ---- least_pull.c: Computes the least pull that seats every pass of a cord whose ends are both
 * pulled. */

/* A cord parted at turn `turn`, which lies between the passes `turn` and `turn` + 1, counted from
 * 0. A cord of one pass has no turn; `turn` is that pass then. The sums of the turns before and
 * after it are left to the cord's start and end. */
typedef struct {
  int turn;
  double start, end;
} thr_parting;

/* Returns the larger sum of a parting, which says how hard the cord has to be pulled. */
double thr_parting_larger(const thr_parting *parting);

/* Returns the best parting of passes first .. last of a cord. sum[k] is the sum of the turns before
 * pass k, counted from any turn on; it never falls. O(log passes). */
thr_parting thr_least_pull(const double *sum, int first, int last);

/* Returns the smaller sum of the best parting of passes first .. last, the least where there are
 * several. O(passes). */
double thr_least_pull_other(const double *sum, int first, int last);

/* Returns the best parting of a whole cord, half[n_passes], where there may be several: the one
 * with the smaller smaller sum, of these the one nearest to the middle, and of two as near the one
 * whose inner pass, or whose passes further out, have the lower edge. Sums count as equal within
 * 1e-12. So it does not depend on which end is called the start. O(n_passes). */
thr_parting thr_least_pull_of(const double *sum, const int *half, int n_passes);

/* Computes the larger sum of the best parting where the sums are not at hand. Begun with the sum of
 * all turns, `thr_least_pull_next` takes one turn after the other, and returns false as soon as no
 * later turn can be better; `larger` is then the answer. O(1) each. */
typedef struct {
  double whole, before, larger;
} thr_least_pull_walk;

thr_least_pull_walk thr_least_pull_begin(double whole);
bool thr_least_pull_next(thr_least_pull_walk *walk, double turn);

/* ---- pulled.c: Which end of a cord is pulled. */

typedef enum { THR_PULL_START, THR_PULL_END, THR_PULL_BOTH, THR_PULL_NONE, THR_N_PULLS } thr_pull;

const char *thr_pull_name(int p); /* "start", "end", "both", "none" */

/* The one with this name, or -1; NULL has none. */
int thr_pull_named(const char *name);

#endif
