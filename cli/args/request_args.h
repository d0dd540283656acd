/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of a request. */
#ifndef THR_REQUEST_ARGS_H
#define THR_REQUEST_ARGS_H

#include "cli/args/symmetry_args.h"
#include "cli/args/options.h"
#include "graph/framework/frame.h"

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

/* Is the pull of cords limited? */
bool request_args_limits_pull(const request_args *a);

/* Was nothing asked for but a short cord? */
bool request_args_usual(const request_args *a);

/* ---- end_counts.c: `--ends NAME:N,..`: how many cord ends there are at each node. */

/* Reads "A:2,B:1" into counts[n_nodes]. Returns -1 if no node comes with a number; EXIT_OK; or
 * prints what is wrong and returns the exit code. */
int end_counts_parse(const thr_frame *frame, const char *ends, int *counts);

/* Finds the least and the most number of cords of any component that these ends make. Returns
 * EXIT_OK, or prints and returns the exit code if some component has no end or an odd number of
 * them. */
int end_counts_cords(const thr_frame *frame, const int *counts, int *least, int *most);

#endif
