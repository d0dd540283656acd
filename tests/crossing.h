/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random cases for the planner: a small framework and a value of every option, so that all pairs of
 * values are met. */
#ifndef THR_CROSSING_H
#define THR_CROSSING_H

#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "tests/support.h"

/* What a case chooses. */
typedef enum {
  BY_OBJECTIVE,
  BY_JOINT,
  BY_ENDS,
  BY_PIECES,
  BY_CORDS,
  BY_COVER,
  BY_CAPACITY,
  BY_PASSES, /* covers and capacities of single edges */
  BY_LENGTHS,
  BY_SHAPE,
  BY_LIMIT,
  BY_BALANCE,
  BY_SLACK,
  BY_COST,
  BY_MINIMIZE,
  BY_TOUR,
  BY_ENGINE,
  BY_PREFER,
  BY_GEOMETRIC,
  BY_DISTINCT,
  N_CHOICES
} crossing_choice;

enum { CROSSING_VALUES = 7 };

/* Names of the values of each choice, and how many there are; value 0 is what the program does if
 * it is not told. */
extern const char *const crossing_value[N_CHOICES][CROSSING_VALUES];
extern const char *const crossing_name[N_CHOICES];
int crossing_values(crossing_choice c);

/* The program refuses these two values together with exit code 2. */
typedef struct {
  crossing_choice a;
  int value_a;
  crossing_choice b;
  int value_b;
} crossing_refused;
extern const crossing_refused crossing_refusals[];
extern const int n_crossing_refusals;

typedef struct {
  int value[N_CHOICES];
  thr_frame f;
  thr_request o;        /* as asked for */
  char frame_path[256]; /* the file that f was read from */
  char arguments[1024]; /* of thread plan, after the frame */
} crossing_case;

/* How often values of two choices met. */
typedef struct {
  int met[N_CHOICES][CROSSING_VALUES][N_CHOICES][CROSSING_VALUES];
} crossing_tally;

/* Is a pair of the case's values refused? */
bool crossing_is_refused(const int *value);

/* Can no case have both values, because something else refuses every case with both? */
bool crossing_never_meet(crossing_choice a, int value_a, crossing_choice b, int value_b);

/* Values that are not refused, chosen at random among those that meet pairs which met least. only:
 * names of values that all cases have, separated by spaces; NULL: none. */
void crossing_choose(rng *r, const crossing_tally *t, const char *only, int *value);
void crossing_count(crossing_tally *t, const int *value);
void crossing_print(const crossing_tally *t);

/* A random framework for these values, written to path and read again, and the options in both
 * forms. */
crossing_case crossing_make(rng *r, const int *value, const char *path, int most_edges);
void crossing_destroy(crossing_case *c);

#endif
