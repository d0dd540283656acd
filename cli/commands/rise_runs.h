/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs of rising structures, and what several of them say together: shared by `thread rise` and
 * `thread compare --method rise`. */
#ifndef THR_RISE_RUNS_H
#define THR_RISE_RUNS_H

#include "cli/args/args.h"
#include "cli/cli.h"
#include "eval/rise/rise.h"
#include "graph/limits.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "kit/kit.h"
#include "lib/rise_pieces.h"

#include <stdbool.h>

enum { RISE_MOST_SEEDS = 1000, RISE_MOST_MOMENTS = 4000 };

/* Of the options of `thread rise`: N, the most that a hand pulls once; and the factor on the
 * triangles of pieces, which nobody prints. */
extern const double rise_hand, rise_coarse;

/* The pieces of a plan, what rises of them, and what is foretold of it. {0} is valid. */
typedef struct {
  thr_kit kit;
  thr_rise_kit made;
  thr_pull ends; /* which ends of every cord are pulled */
  double seated; /* N at every end that seat every pass, by the closed form; NAN: not known */
  double stands; /* N at every end below which nothing stands while cords are drawn in, by the limit
                    analysis of these very pieces in their closed shape; NAN: not known */
} rise_pieces;

/* What else counts: {THR_PULL_BOTH} is usual. */
typedef struct {
  thr_pull ends;
  thr_rise_feet feet;
  const thr_physics *physics; /* NULL: the plan's */
} rise_setting;

/* Makes the pieces of a plan, which stays the caller's and must outlive them; seated and stands are
 * NAN until rise_foretell. Release with rise_pieces_destroy, after a failure too. */
thr_status rise_pieces_make(rise_pieces *pieces, const thr_plan *plan,
                            const thr_kit_options *options, const rise_setting *setting,
                            const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void rise_pieces_destroy(rise_pieces *pieces);

/* Sets what the command line says of cord and beads, beside which sizes of an evaluation that the
 * plan keeps do not count. Returns an exit code. */
int rise_apply_physics(const cli_physics *physics, thr_plan *plan);

/* Computes seated and stands; what is not decided, or takes too long, stays NAN. */
void rise_foretell(rise_pieces *pieces, const thr_limits *limits);

/* Finds the names of the two pieces of a pass, counted over all cords. */
void rise_pass_names(const rise_pieces *pieces, int pass, const char *name[2]);

/* A run. */
typedef struct {
  const thr_rise_structure *structure; /* borrowed */
  thr_rise_options options;
  bool done;
  thr_rise_record record; /* without poses and tensions; owned */
  thr_status status;      /* why it is not done, and .. */
  thr_err why;            /* .. in words */
} rise_job;

/* Does n runs in parallel processes of their own. Those that are done when the limits stop the work
 * (THR_ELIMIT) have their records; what a single run fails by stands in its job alone. Release each
 * record, after a failure too. */
thr_status rise_jobs_run(rise_job *job, int n, const thr_limits *limits,
                         thr_err *err) THR_MUST_CHECK;

/* Returns the pull at which a run came up, N, or INFINITY; and the one below which it fell, or 0.
 */
double rise_pull_up(const thr_rise_record *record);
double rise_pull_down(const thr_rise_record *record);

/* Finds the least, the middle (of two: the lower) and the largest of n values, which are sorted. */
void rise_spread(double *value, int n, double out[3]);

/* ---- cmd_rise.c: What `thread rise PLAN` does, for `thread eval --method rise`. */

typedef struct {
  const cli_physics *physics;
  const guard_limits *guard;
  double newtons;   /* 0: as many as usual */
  double time_step; /* factor */
  int seed;         /* -1: the usual one */
} rise_usual;

/* Lets the plan of this file rise once, in a guarded child, and prints what was seen. Returns the
 * exit code. */
int rise_as_usual(const char *path, const rise_usual *asked);

#endif
