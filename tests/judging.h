/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Judging what the program says of a small framework against exhaustive search over walks
 * (tests/walks.h): whether its cords are a threading, its claims are true, its exit code fits.
 * Shared by property/test_cross.c and test_cross_known.c. */
#ifndef THR_TESTS_JUDGING_H
#define THR_TESTS_JUDGING_H

#include "graph/plan/plan.h"
#include "tests/crossing.h"
#include "tests/walks.h"

#include <stdbool.h>

enum { PIECES = 3, MOST_CORDS = 10, OUTPUT = 4000 };

typedef struct {
  crossing_case c;
  int n_pieces, code;
  thr_plan plan;
  bool written, whole; /* enough different cords pass every edge */
  char said[OUTPUT];
  int findings;
} judged;

typedef struct {
  long cases, planned, none, open, unsure, missed, findings;
} counts;

/* A folder for what is written; self: the test program as it was called, two folders below the
 * program. */
extern char judging_folder[64];
void judging_begin(const char *self);
void judging_end(void);

/* Exit code (128 + signal) of the program run with these words by a shell; what it said on standard
 * error. */
int judging_run(char *said, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool judging_one_line(const char *said);

/* A framework for these values; mostly one that has a plan. */
void judged_make(judged *j, rng *r, const int *value, const char *path, int most_edges);

/* Runs the program on a case and judges what comes of it. */
void judged_case(judged *j, counts *n);

/* ---- the least of all threadings (judging_least.c) ---- */

/* A case of this framework and request, of which the functions below tell the least: nothing is run
 * or written. Raises judged_most_states to most_states. Borrows f and what o points at. */
judged judged_of(const thr_frame *f, const thr_request *o, long most_states);

extern long judged_most_states;      /* of a piece that is not too large */
extern const double judged_rounding; /* of a cord's length */
extern const walks_weights judged_by_length, judged_by_turn;

/* What a number of cords can do in one piece: least[k] for k cords, reached with so many at most.
 */
typedef struct {
  double least[MOST_CORDS + 1];
  int n; /* last k; no more cords reach another state, or enough */
  bool known;
} judged_piece;

/* limit: see walks_one_more. Up to most cords. */
judged_piece judged_piece_find(const judged *j, int k, walks_back back, walks_weights weights,
                               double limit, int most);
double judged_between(const judged_piece *l, int least, int most);

/* Least weight of all pieces together; NAN if a piece is too large for the oracle. */
double judged_least(const judged *j, walks_back back, walks_weights weights, double limit);

/* Fewest cords of all pieces together that are no longer than the limit; INFINITY: none, NAN: not
 * known. */
double judged_fewest(const judged *j, double limit);

/* Least turning of plans no longer than longest; NAN: not known, INFINITY: there is none. */
double judged_least_turning(const judged *j, double longest, double limit_turn);

/* The least length of n cords in every piece of f together, and of the longest of them, asked as by
 * o but for their number and greatest length. INFINITY: there are none. */
double judged_together(const thr_frame *f, const thr_request *o, int n);
double judged_longest(const thr_frame *f, const thr_request *o, int n);

/* Tells whether n cords in every piece can each be no longer than limit. */
bool judged_possible(const thr_frame *f, const thr_request *o, int n, double limit);

#endif
