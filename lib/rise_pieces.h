/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces and cords of a kit as what can rise (eval/rise/rise.h): convex parts, masses, mouths;
 * and runs of what rises, shared by `thread rise`, `thread compare --method rise` and libthread. */
#ifndef THR_RISE_PIECES_OF_KIT_H
#define THR_RISE_PIECES_OF_KIT_H

#include "diagram/scene/movement.h"
#include "eval/eval.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/limits.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "kit/kit.h"

/* What feet can do. */
typedef enum {
  THR_RISE_FREE,   /* stand on the ground like all pieces, slide and lift off */
  THR_RISE_GROUND, /* slide on the ground, but neither lift off nor tip */
  THR_RISE_HELD,   /* stay where they are drawn */
  THR_RISE_N_FEET
} thr_rise_feet;
const char *thr_rise_feet_name(int feet);

/* A structure with all that it points to. {0} is valid. */
typedef struct {
  thr_rise_structure structure;
  thr_rise_piece *piece; /* those of structure, to be held .. */
  thr_rise_cord *cord;   /* .. or slack */
  thr_scratch own;
} thr_rise_kit;

/* Makes the structure of a kit of a plan with solid joints. Every arm is a convex part, a foot is
 * one more; masses and their centres are those of the meshes if the kit has them, else of the
 * parts. pull: [n_cords] which ends are pulled. Feet are the plan's. physics: resolved. THR_EINPUT:
 * the plan has tubes, pieces that overlap when all is closed, or no feet where these are to be held
 * or to stay down. Release with thr_rise_kit_destroy, after a failure too. O(pieces + passes). */
thr_status thr_rise_kit_make(thr_rise_kit *made, const thr_kit *kit, const thr_pull *pull,
                             thr_rise_feet feet, const thr_physics *physics,
                             thr_err *err) THR_MUST_CHECK;
void thr_rise_kit_destroy(thr_rise_kit *made);

/* The section of arms as a polygon: returns its number of sides; *radius: of its corners, as a part
 * of the width; *first: where the first one is, rad from arm.up towards arm.side. */
int thr_rise_section(thr_kit_profile profile, double *radius, double *first);

/* ---- rise_shapes.c: other shapes of the same pieces. shape: a framework with the nodes of the
 * plan, in the same order and unit, at other places; it is not kept. */

/* Lays pieces where the nodes of shape are, each turned along the edges there as well as can be,
 * for THR_RISE_LAID. THR_EINPUT: it has other nodes, or no edge where a piece has an arm. O(arms).
 */
thr_status thr_rise_kit_lay(thr_rise_kit *made, const thr_kit *kit, const thr_frame *shape,
                            thr_err *err) THR_MUST_CHECK;

/* Lets a cord close its faces towards shape. Pieces have there as many of their arms as they can
 * along the edges; a cord that takes no arm comes out of the side of one, which is the seat of the
 * neighbour's face. THR_EINPUT: as above, or the faces of a pass do not meet. O(arms^2). */
thr_status thr_rise_kit_shape(thr_rise_kit *made, const thr_kit *kit, int cord,
                              const thr_frame *shape, thr_err *err) THR_MUST_CHECK;

/* Makes of what was seen a movement that can be shown (kit/film.h). THR_ENOMEM. Release with
 * thr_movement_destroy, after a failure too. O(frames (pieces + passes)). */
thr_status thr_rise_movement(thr_movement *movement, const thr_kit *kit,
                             const thr_rise_record *record, thr_err *err) THR_MUST_CHECK;

/* ---- rise_runs.c: Runs of rising structures, and what several of them say together. */

enum { THR_RISE_MOST_SEEDS = 1000, THR_RISE_MOST_MOMENTS = 4000 };

/* Of the options of `thread rise`: N, the most that a hand pulls once; and the factor on the
 * triangles of pieces, which nobody prints. */
extern const double thr_rise_hand, thr_rise_coarse;

/* The pieces of a plan, what rises of them, and what is foretold of it. {0} is valid. */
typedef struct {
  thr_kit kit;
  thr_rise_kit made;
  thr_pull ends; /* which ends of every cord are pulled */
  double seated; /* N at every end that seat every pass, by the closed form; NAN: not known */
  double stands; /* N at every end below which nothing stands while cords are drawn in, by the limit
                    analysis of these very pieces in their closed shape; NAN: not known */
} thr_rise_pieces;

/* What else counts: {THR_PULL_BOTH} is usual. */
typedef struct {
  thr_pull ends;
  thr_rise_feet feet;
  const thr_physics *physics; /* NULL: the plan's */
} thr_rise_setting;

/* Makes the pieces of a plan, which stays the caller's and must outlive them; seated and stands are
 * NAN until thr_rise_foretell. Release with thr_rise_pieces_destroy, after a failure too. */
thr_status thr_rise_pieces_make(thr_rise_pieces *pieces, const thr_plan *plan,
                                const thr_kit_options *options, const thr_rise_setting *setting,
                                const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_rise_pieces_destroy(thr_rise_pieces *pieces);

/* Computes seated and stands; what is not decided, or takes too long, stays NAN. */
void thr_rise_foretell(thr_rise_pieces *pieces, const thr_limits *limits);

/* Finds the names of the two pieces of a pass, counted over all cords. */
void thr_rise_pass_names(const thr_rise_pieces *pieces, int pass, const char *name[2]);

/* A run. */
typedef struct {
  const thr_rise_structure *structure; /* borrowed */
  thr_rise_options options;
  bool done;
  thr_rise_record record; /* without poses and tensions; owned */
  thr_status status;      /* why it is not done, and .. */
  thr_err why;            /* .. in words */
} thr_rise_job;

/* Does n runs in processes of their own, so many at a time. Those that are done when the limits
 * stop the work (THR_ELIMIT) have their records; what a single run fails by stands in its job
 * alone. Release each record, after a failure too. */
thr_status thr_rise_jobs_run(thr_rise_job *job, int n, int processes, const thr_limits *limits,
                             thr_err *err) THR_MUST_CHECK;

/* Returns the pull at which a run came up, N, or INFINITY; and the one below which it fell, or 0.
 */
double thr_rise_pull_up(const thr_rise_record *record);
double thr_rise_pull_down(const thr_rise_record *record);

/* Finds the least, the middle (of two: the lower) and the largest of n values, which are sorted. */
void thr_rise_spread(double *value, int n, double out[3]);

/* ---- rise_jam.c: why a structure did not come up. */

typedef enum {
  THR_RISE_LIGHTER,
  THR_RISE_CARRY,
  THR_RISE_MORE_CORDS,
  THR_RISE_MORE_PULL,
  THR_RISE_SHAKE,
  THR_RISE_ANOTHER_SEED,
  THR_RISE_LAY_FLAT
} thr_rise_remedy;

/* Returns what to change, in words without options. */
const char *thr_rise_remedy_words(thr_rise_remedy remedy);

/* What was measured when the hands stopped, and what may help. */
enum { THR_RISE_MOST_REMEDIES = 3 };
typedef struct {
  int open;          /* passes whose faces have not met .. */
  int cord, on_cord; /* .. most of them, so many, on this cord */
  double pull;       /* N of the hands .. */
  double tension;    /* .. of which so much is left in the slackest of these passes */
  int top;           /* the piece that is highest as drawn */
  int n;
  thr_rise_remedy remedy[THR_RISE_MOST_REMEDIES]; /* [n] the likeliest first */
} thr_rise_jam;

/* Looks at a run with tensions. Returns false, with an empty jam, where all faces closed or hands
 * did what a schedule says. O(passes). */
bool thr_rise_jam_find(const thr_rise_pieces *pieces, const thr_rise_record *record,
                       const thr_rise_options *options, thr_rise_jam *jam);

/* What was seen of a structure, to be written. */
typedef struct {
  const thr_rise_pieces *pieces;
  const thr_eval *after; /* what the closed form says that a schedule leaves; NULL: no schedule */
  const thr_rise_options *options; /* of the first run */
  bool dented, motion;             /* was a piece pushed; write the place of every piece, too? */
  int first_seed, n;
  const thr_rise_record *record; /* [n] of seeds from first_seed on */
} thr_rise_seen;

/* Writes the members of an open object: what rose, and every run with its moments, as `thread rise
 * --json`. */
void thr_rise_put_json(thr_writer *writer, const thr_rise_seen *seen);

#endif
