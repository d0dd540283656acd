/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The documents that are made from a plan: overview, step sheets, tables, lines for CAD, mat and so
 * on. One table says what they are called and who makes them (documents.c), for the commands, the
 * pages and the library. handles.h says in which order to read the folder. */
#ifndef THR_DOCUMENTS_H
#define THR_DOCUMENTS_H

#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "diagram/scene/scene.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

int thr_documents_count(void);
const char *thr_document_type(int i);    /* as `thread draw --type` names it: "svg", "steps.csv" */
const char *thr_document_file(int i);    /* usual file name: "overview.svg" */
const char *thr_document_meaning(int i); /* what it is, for help */
int thr_document_find(const char *type); /* -1: there is none of that name */
int thr_document_sheets(void);           /* the one that takes longest: sheets.pdf */
bool thr_document_usual(int i);   /* is it one of those that "all" means? Not the mat, which needs a
                                     unit, nor others that few need */
bool thr_document_threads(int i); /* does it say, step by step, how the plan is threaded? */

/* How they are drawn; {0} is the usual way. */
typedef struct {
  double pitch_mm;            /* of the overview; 0 = automatic */
  thr_overview_colour colour; /* of the overview */
  double
      kind_tolerance; /* pieces that differ by no more are of a kind, in units; 0 = the usual one */
  double working_mm; /* cord that is worked with at a time, in the step sheets; 0 = the usual 2 m */
  int page;          /* of step sheets and mat: thr_page_size */
  int needles; /* that cords are threaded with in the step sheets: 1, 2 = from their middle; 0 = as
                  the plan says */
  thr_line_options lines;   /* of cords for CAD */
  const thr_layout *layout; /* of the plan's framework, by thr_layout_choose: what several documents
                               share; NULL: each lays out anew */
  void (*pages)(const char *file, int n); /* hears how many a file of pages has; NULL = nobody */
} thr_document_options;

/* Appends document i of the plan to out. THR_EINPUT: the plan has not what it shows, or an option
 * does not fit. out is for the caller to destroy in any case. */
thr_status thr_document_make(const thr_plan *plan, int i, const thr_document_options *options,
                             const thr_limits *limits, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
