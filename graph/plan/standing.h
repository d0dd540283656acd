/* What the limit analysis found of a structure, in the form that is kept in plan.json: what acts on it, what was asked, and the
 * mechanisms that prove the answers. The checker adds up the powers of each mechanism itself (graph/check/check_standing.c).
 *
 * Example: "pulled at both ends while it is drawn in, nothing holds it below 4.14 N", with the velocities of all beads by which
 * it then falls. */
#ifndef THR_STANDING_H
#define THR_STANDING_H

#include "graph/io/json.h"
#include "graph/io/writer.h"
#include "graph/status.h"

/* What may be unknown: a pull of the cords, a factor on the tensions after a schedule, or a multiple of the load. */
typedef enum {
  THR_ASKED_HOLDING,       /* pull at the harder end of each cord while the cords are drawn in */
  THR_ASKED_EQUAL,         /* pull at all ends, the same, while the cords are drawn in */
  THR_ASKED_ANY_STATE,     /* force at all ends in any state that friction keeps */
  THR_ASKED_AFTER,         /* factor on the tensions that the schedule leaves */
  THR_ASKED_LOADED,        /* pull at all ends while the cords are drawn in, with the load */
  THR_ASKED_CARRIED,       /* multiple of the load at a given pull of all ends while the cords are drawn in */
  THR_ASKED_CARRIED_AFTER, /* multiple of the load with the tensions that the schedule leaves */
  THR_ASKED_STRETCH,       /* N m by which knotted cords have to stretch beyond the tensions that the schedule leaves */
  THR_ASKED_TIGHTEST,      /* N that some pass of a knotted cord has to have after the schedule */
  THR_N_ASKED
} thr_asked;

typedef struct {
  thr_asked asked;
  double pull;    /* N at all ends, of CARRIED; else 0 */
  double proved;  /* below it, or above it if a load is asked for, there is no equilibrium; 0, or INFINITY: nothing is proved */
  double found;   /* at it the solver found an equilibrium; INFINITY: it found none */
  double resists; /* 1/m, of STRETCH: the price of a newton metre by which it is proved; -1: the most that any face parts by */
  int n_beads;    /* that move in the mechanism, all of the framework; 0 if nothing is proved */
  double (*velocity)[6]; /* [n_beads] that proves it: translation of the mass centre, rotation (1/m); owned */
} thr_answer;

typedef struct {
  int node;
  double force[3]; /* N */
} thr_load;

/* How a cord is drawn in, which a schedule does not say: which ends (a thr_pull), and its slackest pass then. */
typedef struct {
  int pull, slackest;
} thr_drawn;

/* A still of how the structure comes up in simulation as its cords are drawn in (eval/structure/erect.h). */
typedef struct {
  double pull;          /* N, of the harder ends */
  double counterweight; /* N, carried from above */
  int seated;           /* gaps that open nowhere by more than THR_SEATED of a mean edge */
  int n_beads;          /* all of the framework */
  double (*pose)[7];    /* [n_beads] where the bead's node is (m), and its rotation from where it was drawn (x y z w); owned */
} thr_posed;

static const double THR_SEATED = 0.01;
enum { THR_STANDING_MODEL = 2 };

typedef struct {
  bool present;
  int model;            /* of bodies and cords: THR_STANDING_MODEL, or 1: square feet, cords in the middle of their bores */
  bool clamped;         /* the feet are held; else they stand on the ground */
  bool taut;            /* turns are those of the tight cord, and each cord states its exponents */
  double tilt, azimuth; /* rad: of the ground, and where it goes down (from x towards y) */
  double strength;      /* N: no pass of a knotted cord bears more; 0: any tension */
  double let_down;      /* N: to which all ends can be let down after the schedule; NAN: was not asked */
  int n_loads, n_cords, n_stills, n_answers;
  thr_load *load;     /* [n_loads] owned */
  thr_drawn *drawn;   /* [n_cords] owned */
  thr_posed *still;   /* [n_stills] owned */
  thr_answer *answer; /* [n_answers] owned */
} thr_standing;

const char *thr_asked_name(int asked);   /* "holding", "equal", .. as in plan.json */
bool thr_asked_of_load(thr_asked asked); /* is a multiple of the load what is unknown? */
bool thr_asked_after(thr_asked asked);   /* is it about the tensions that a schedule leaves? */

void thr_standing_destroy(thr_standing *standing);

/* The member "structure" of an evaluation, and reading it: shapes and ranges; nodes and numbers of beads are compared with the
 * framework by the checker. THR_EVIOLATED with place. */
void thr_standing_write(const thr_standing *standing, thr_writer *writer, const char *key);
thr_status thr_standing_from_json(thr_standing *standing, const thr_json *object, int n_cords, const char *place,
                                  thr_err *err) THR_MUST_CHECK;

#endif
