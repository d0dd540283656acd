/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares the groups of options that several commands have.
 *
 * The folder cli/args parses command lines. Every option is a row of a table (options.h); a group
 * of rows writes into one struct below, and a function named .._apply or .._check then settles what
 * the struct comes to when the framework or the plan is known. Functions print what is wrong with
 * an option and return the exit code.
 *
 * Read in this order:
 *   options.h, options.c        rows, parser, help
 *   config.c                    --config: options from a file
 *   frame_args.c                how a framework is read
 *   request_args.c              what a plan is to be; end_counts.c: numbers of cord ends
 *   symmetry_args.c             symmetric plans
 *   physics_args.c, load_args.c cord and beads; loads on the structure */
#ifndef THR_ARGS_H
#define THR_ARGS_H

#include "cli/args/options.h"
#include "cli/cli.h"
#include "eval/eval.h"
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"
#include "graph/plan/request.h"

/* ---- config.c: --config FILE: options from a file, as if they stood before those of the command
 * line. */

/* A file of lines: "name = value" or "name", an option as on the command line without its dashes;
 * "[command]": what follows is for this command only; "# comment". What stands before any [command]
 * is for every command.
 *
 * Puts the file's options for the command argv[1] behind it, as --name=value, in place of --config
 * FILE; what else stands there comes after, and so wins. *argc and *argv are the new ones, which
 * live as long as the program. Returns EXIT_OK, or prints and returns the code. */
int cli_config(int *argc, char ***argv);

/* The name of the file that the word argv[i] of the command came from; NULL: the user typed it. */
const char *cli_config_of(int i);

/* ---- physics_args.c: The options that describe cord and beads, made from the table in
 * graph/plan/physics.h. Shared by eval, compare and plan. */

enum { CLI_PHYSICS_MOST = 64 };

/* What was given, in order. */
typedef struct {
  int n;
  struct {
    const cli_option *option;
    const char *value;
  } given[CLI_PHYSICS_MOST];
} cli_physics;

#define CLI_PHYSICS_HEADING "Cord and beads (default: what the plan says, else what stands here)"

/* The rows: a preset, a file, and a row for each quantity; into a cli_physics. */
const cli_option *cli_physics_options(void);

/* Lays what was given over *physics: presets and files first, then single quantities, each in the
 * order given. Returns EXIT_OK or prints and returns the code. */
int cli_physics_apply(const cli_physics *a, thr_physics *physics);

/* ---- Options of what acts on the structure beside weight and cords: loads, a tilted ground, held
 * feet.
 */

enum { LOAD_MOST_PULLS = 32 };

typedef struct {
  const char *load; /* as given; NULL = none */
  double pulls[LOAD_MOST_PULLS], tilt, azimuth;
  int n_pulls, rays;
  bool clamped, taut;
} load_args;

/* --load, --load-pulls, --tilt, --clamp-feet, --taut; --tune rays. */
extern const cli_option cli_load_options[], cli_load_tuned[];

/* Does anything act on the structure beside weight and cords? */
bool load_any(const load_args *a);
/* Sets options; *load receives [n_nodes] that the caller frees. EXIT_OK, or prints and returns the
 * code. */
int load_apply(const load_args *a, const thr_frame *frame, thr_eval_options *options,
               double (**load)[3]);

/* ---- The options of `thread symmetries` and of `thread plan --objective symmetry` that say which
 * symmetry, and what counts first. */

typedef struct {
  thr_symmetry_options options;
  thr_aim prefer[THR_N_AIMS]; /* what counts first, second, .. */
} symmetry_args;

symmetry_args symmetry_args_default(void);

/* --group, --geometric, --prefer. */
extern const cli_option cli_symmetry_options[];

/* ---- The options of a request. */

/* ---- request_args.c: The options of `thread plan` that say what the plan is to be: aims, cords,
 * ends, turning. */

typedef struct {
  thr_request asked;       /* rows of the table as they were given, the others as usual */
  const char *aims;        /* --aims; NULL: not said */
  thr_objective objective; /* what the aims come to */
  bool balance;            /* --balance, or --aims, wants a short longest cord */
  bool minimize;           /* --minimize, or --aims, says which: */
  bool largest, pull;      /* max-turning or pull; the latter */
  const char *ends;
  int least, most;     /* cords; 0: not said */
  bool automatic;      /* --cords auto */
  double max_pull;     /* N, or times the seating tension; 0: not said */
  bool pull_is_factor; /* the latter */
  double hand;         /* N; 0: not said */
  double strength;     /* N; 0: not said */
  int frontier;        /* points; 0: none */
  bool compare;        /* --compare-shortest */
  const char *plot;    /* where the picture of the frontier goes; NULL: nowhere */
} request_args;

request_args request_args_default(void);

/* The options, into a request_args: rows of their own, and those that the request's table makes
 * (graph/plan/request_fields.c): what is planned; what is about turning; what is for developers. */
typedef enum { REQUEST_PLANNED, REQUEST_TURNING, REQUEST_TUNED } request_rows;
const cli_option *request_options(request_rows rows);

/* The option that a member of the request has, "cover", into a thr_request: for other commands. */
cli_option request_option_of(const char *key);

/* Settles what --aims says, as the other options would, and checks whether all that was asked goes
 * together. *wanted becomes the request's aims, and what belongs to them. Returns -1, or prints and
 * returns the exit code. */
int request_args_check(request_args *a, symmetry_args *symmetry, thr_request *wanted);

/* Sets what was asked for that needs no framework in a request for an objective; what is about
 * turning or symmetry concerns that one objective only. */
void request_args_ask(const request_args *a, const symmetry_args *symmetry, thr_objective objective,
                      thr_request *request);

/* Sets what needs the framework: ends, numbers of cords, room, pull. The request holds cord and
 * beads already. Returns EXIT_OK or prints and returns the exit code. The caller frees
 * request->end_node and request->end_count. */
int request_args_apply(const request_args *a, const thr_frame *frame, thr_request *request);

/* Is neither an objective nor a number of cords said, nor what makes a number? Then the plan is the
 * recommended one (planner/recommend.c), with ends, joints and all else as they are given. ends: as
 * applied. */
bool request_args_unsaid(thr_ends ends);

/* ---- end_counts.c: `--ends NAME:N,..`: how many cord ends there are at each node. */

/* Reads "A:2,B:1" into counts[n_nodes]. Returns -1 if no node comes with a number; EXIT_OK; or
 * prints what is wrong and returns the exit code. */
int end_counts_parse(const thr_frame *frame, const char *ends, int *counts);

/* Finds the least and the most number of cords of any component that these ends make. Returns
 * EXIT_OK, or prints and returns the exit code if some component has no end or an odd number of
 * them. */
int end_counts_cords(const thr_frame *frame, const int *counts, int *least, int *most);

#endif
