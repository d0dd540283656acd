/* Friction of a cord dragged through bead joints, measured in Bullet: a chain of small spheres linked by one-row distance
 * constraints, in channels of convex walls. The capstan law chooses the length of the steps and enters nothing else that is
 * measured.
 *
 * Measured is the ratio T(out) / T(in) of the tensions on both sides once it no longer changes; its logarithm over mu is the
 * turning that the cord felt (Euler 1769, Eytelwein 1808: ratio = exp(mu x angle)).
 *
 * Example: a mitred turn of 90 degrees with mu 0.1 should give exp(0.157) = 1.17 (docs/validation.md). */
#ifndef THR_DRAG_H
#define THR_DRAG_H

#include "graph/limits.h"
#include "graph/status.h"

/* All lengths in cord radii, forces in hold-back tensions. */
typedef struct {
  int n_turns;        /* 1 for a joint; more for the validation of whole cords */
  const double *turn; /* [n_turns] rad, 0 .. pi; borrowed */
  const double
      *twist; /* [n_turns] rad, rotation of each turn's plane about the channel before it; NULL = all in one plane; borrowed */
  double segment; /* length of the channel between two turns; 0 = the protocol's */
  double bore;    /* bore diameter / cord diameter, > 1 */
  double mu;      /* cord on bead, >= 0 */
  uint64_t seed;
  double time_step, iterations, spacing; /* factors on the protocol's, 1 */
  int sides;                             /* of the polygonal bore; 0 = the protocol's */
  double settle;                         /* factor on the travel before averaging; 0 = 1 */
} thr_drag;

/* Out of range: a turn above thr_drag_largest_turn, mu above 1, bore below 1.01, bore cos(turn / 2) below 0.7 (deeply wedged), a
 * ratio expected above exp(4), straights too short for the turns, more than 100,000 spheres. Nothing is measured then. */
typedef enum { THR_DRAG_SETTLED, THR_DRAG_UNSETTLED, THR_DRAG_OUT_OF_RANGE } thr_drag_status;

typedef struct {
  int status;     /* thr_drag_status */
  double ratio;   /* mean tension at the drag end / at the hold end, in steady sliding; 0 if out of range */
  double drift;   /* relative change of the ratio between the two halves of the averaging window: its settling error */
  double scatter; /* standard error of the ratio's mean over blocks, relative */
  double taut;    /* rad, turning of the mean path of the cord while averaging */
  double steps;   /* taken */
} thr_drag_result;

/* What the protocol was validated for: the largest single turn, rad; bore diameter / cord diameter. */
extern const double thr_drag_largest_turn, thr_drag_least_bore, thr_drag_largest_bore;

/* Largest turn, rad, that a cord takes in one line of contact in a bore of so many cord diameters: 2 acos(1 / bore). The opening
 * of a mitred round bore is an ellipse whose end is as round as the cord there; in sharper turns the cord wedges between two
 * points of the rim, and its friction exceeds the capstan law (bore 2: 120 degrees, bore 1.1: 49). Wedged joints are measured
 * like others; no closed form confirms them. */
double thr_drag_round_turn(double bore);

/* Relative error of a measured ratio: drift, twice the scatter, and bounds of what they do not show (the chain's polygon, its
 * inertia and impacts, the flat sides of the bore where the cord wedges). */
double thr_drag_error(const thr_drag *drag, const thr_drag_result *result);

/* Changes whenever a number of the protocol does: part of the cache's key. */
const char *thr_drag_protocol(void);

/* Measures. THR_EINPUT for absurd values, THR_ELIMIT when stopped. Deterministic on one machine. 0.1 to 0.3 s a joint up to mu
 * 0.5, up to 10 s beyond or where the cord wedges. Channels of more turns must not cross one another. */
thr_status thr_drag_measure(const thr_drag *drag, const thr_limits *limits, thr_drag_result *out, thr_err *err) THR_MUST_CHECK;

#endif
