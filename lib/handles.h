/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libthread, the library that other programs link (include/thread.h), and what its users and the
 * commands both need: the table of documents, the notes on reading, the names of motions.
 *
 * Read include/thread.h first, then library.c (versions, lock, statuses), library_frame.c and
 * library_plan.c (a call is checked, translated, and handed to graph/, planner/, eval/ or
 * diagram/). documents.c, notes.c and motions.c stand by themselves; cli/ uses the first two, too.
 *
 * This header says what the files of libthread share. */
#ifndef THR_HANDLES_H
#define THR_HANDLES_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"
#include "include/thread.h"

/* ---- What is behind the opaque types of include/thread.h, and how statuses and texts get there.
 */

/* A framework of a program. */
struct thread_frame {
  thr_frame frame;
  thr_text notes; /* what reading did and found odd */
};

/* A plan of a program. */
struct thread_plan {
  thr_plan plan;
  thread_frame lent; /* the plan's framework, for thread_plan_frame: a shallow copy */
  int **node;        /* [n_cords] where each cord runs; owned */
};

/* Lets calls that use what is not reentrant come one after another. */
void thr_library_lock(void);
void thr_library_unlock(void);

/* Returns a status of the program as that of the library, with its text in *err (NULL ok). */
thread_status thr_library_status(thr_status st, const thr_err *from, thread_error *err);

/* Copies a program's options over the usual ones in *own. The first member of both is their size,
 * and a program knows only so many bytes; theirs may be NULL. THR_EINPUT if the size is absurd.
 * what: the name of the struct. */
thr_status thr_library_options(void *own, size_t own_size, const void *theirs, const char *what,
                               thr_err *err) THR_MUST_CHECK;

/* Makes a text the caller's, and leaves it empty. THR_ENOMEM if an append failed. */
thr_status thr_library_give(thr_text *text, char **bytes, size_t *n, thr_err *err) THR_MUST_CHECK;

/* ---- motions.c: What takes a unique path of a symmetric plan to its copies, in words for who
 * threads. */

/* The motions of a plan in words. */
typedef struct {
  const char **motion; /* [n_cords] "turned by 90 degrees .."; NULL for no copy, and for one that no
                          motion makes; owned */
  char (*words)[104];  /* [n_images] owned */
} thr_motions;

/* Describes for each image the motion in space that is nearest to it, if it is within
 * thr_symmetry_near. Plans that are not symmetric have no words. Release with thr_motions_destroy.
 * O(images * n). */
thr_status thr_motions_describe(const thr_plan *plan, thr_motions *out,
                                thr_err *err) THR_MUST_CHECK;
void thr_motions_destroy(thr_motions *motions);

#endif
