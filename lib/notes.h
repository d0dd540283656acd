/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Notes on how a framework was read, in words for its user: what was merged, dropped or found odd,
 * and what was assumed. handles.h says in which order to read the folder. */
#ifndef THR_NOTES_H
#define THR_NOTES_H

#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends a line for each note, or nothing. THR_ENOMEM. Takes as long as thr_frame_near. */
thr_status thr_read_notes(const thr_frame *frame, const thr_read_report *report, thr_text *out,
                          thr_err *err) THR_MUST_CHECK;

/* What was taken of something that a file may leave open, and why: "unit", "mm", THR_FROM_NOBODY,
 * "the file names none; --units".
 */
typedef struct {
  const char *what; /* static, as the other two */
  char value[48];
  double number; /* the same as a number, NAN where it is a word */
  thr_whence from;
  char why[120]; /* in words for the user, "" = from says it all */
} thr_assumption;

enum { THR_ASSUMPTIONS = 8 };

/* Fills row with what applies to this file and returns how many: its format, unit, which way is up,
 * scale and weld tolerance always; hidden layers, parts and parallel edges where it has such. The
 * scale's `from` is never THR_FROM_FILE. */
int thr_read_assumptions(const thr_read_options *options, const thr_frame *frame,
                         const thr_read_report *report, thr_assumption row[THR_ASSUMPTIONS]);

/* Returns "assumed", "maker", "file" or "option". */
const char *thr_whence_name(thr_whence from);

#endif
