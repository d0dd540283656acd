/* A child process that cannot harm its parent: what it prints is kept from the terminal, Ctrl-C is left to the parent, and it
 * dies when the parent dies. Everything that runs in a child is started here (graph/process/workers.h, graph/process/child.h),
 * but for commands as a whole (cli/guard.h). */
#ifndef THR_PROCESS_H
#define THR_PROCESS_H

#include "graph/status.h"

#include <sys/types.h>

/* {0} is valid: no child. */
typedef struct {
  pid_t pid; /* 0 = none */
  int pipe;  /* what the child writes to the descriptor that it is given arrives here */
  int words; /* what it or a library prints, of which thr_process_end quotes the first line */
} thr_process;

/* Forks. The child calls run(user, fd) and ends; nothing else of the program runs in it, neither buffered output nor exit
 * handlers of the parent. run returns whether its writing succeeded. THR_ESOLVER if the system gives no pipe or process. */
thr_status thr_process_start(thr_process *p, bool (*run)(void *user, int fd), void *user, thr_err *err) THR_MUST_CHECK;

/* Writes n bytes, in spite of signals. */
bool thr_process_send(int fd, const char *data, size_t n);

/* Waits for the end, closes the pipes and leaves *p empty. THR_ESOLVER if the child did not end by run returning true: the text
 * begins with `who`, says the signal and what was printed, and ends with `advice` (NULL: none). */
thr_status thr_process_end(thr_process *p, const char *who, const char *advice, thr_err *err);

/* In a child: it is killed when its parent dies, whose process it was told; at once if that is dead already. */
void thr_process_die_with(pid_t parent);

/* Ends it at once, whatever it does, and closes the pipes; nothing if there is no child. */
void thr_process_kill(thr_process *p);

#endif
