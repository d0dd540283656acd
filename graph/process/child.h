/* One job in a child process, with an answer of any size: for libraries that may crash, end the program or take no heed of time.
 */
#ifndef THR_CHILD_H
#define THR_CHILD_H

#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

/* The child's way to its parent. */
typedef struct thr_sender thr_sender;

typedef struct {
  const char *what;   /* messages begin with it, e.g. "sheets.pdf" */
  const char *advice; /* what to do if the child dies, ends its message; NULL: nothing known */
  /* Runs in the child, with the deadline, progress and work of the parent's limits; an interrupt of the parent's reaches it too.
   * What it sends last is the answer. Returns a failure, whose text is carried back, or THR_ELIMIT with the best so far sent. */
  thr_status (*run)(void *user, const thr_limits *limits, thr_sender *to, thr_err *err);
  void *user;
} thr_child;

/* In the child: all bytes of `answer` in place of what was sent before. Sent now and then, it is the best so far that the parent
 * has when it must end the child. Fails if the text failed (THR_ENOMEM) or the parent no longer listens (THR_ESOLVER). */
thr_status thr_child_send(thr_sender *to, const thr_text *answer, thr_err *err) THR_MUST_CHECK;

/* Runs the job and waits. At the deadline or an interrupt the child is asked to stop and killed a third of a second later:
 * THR_ELIMIT. A child that dies is THR_ESOLVER. Whatever the status, *answer (empty before) holds what was sent last and arrived
 * whole, of length 0 if there is none; the caller frees it. What the child took of limits->work is taken here, unless it was
 * killed or died. */
thr_status thr_child_run(const thr_child *child, const thr_limits *limits, thr_text *answer, thr_err *err) THR_MUST_CHECK;

#endif
