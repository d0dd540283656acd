/* A child process that cannot harm its parent: what it prints is kept from the terminal, Ctrl-C is left to the parent, and it
 * dies when the parent dies. Everything that runs in a child is started here (graph/process/workers.h, graph/process/child.h),
 * but for commands as a whole (cli/guard.h). */
#ifndef THR_PROCESS_H
#define THR_PROCESS_H

#include "graph/status.h"
#include "graph/text.h"

#include <sys/types.h>

/* {0} is valid: no child. */
typedef struct {
  pid_t pid; /* 0 = none */
  int pipe;  /* what the child writes to the descriptor that it is given arrives here */
  int words; /* what it or a library prints, of which thr_process_end quotes the first line */
  int looks; /* of thr_process_stuck, since its processor time grew; that was: */
  double cpu;
} thr_process;

/* Forks. The child calls run(user, fd) and ends; nothing else of the program runs in it, neither buffered output nor exit
 * handlers of the parent. run returns whether its writing succeeded. THR_ESOLVER if the system gives no pipe or process. */
thr_status thr_process_start(thr_process *process, bool (*run)(void *user, int fd), void *user, thr_err *err) THR_MUST_CHECK;

/* Writes n bytes, in spite of signals. */
bool thr_process_send(int fd, const char *data, size_t n);

/* A message, followed by `length` bytes. What the others mean is up to sender and receiver. */
typedef struct {
  size_t length;
  double value[2];
  int32_t kind, code;
} thr_message;

bool thr_message_send(int fd, thr_message m, const char *bytes);

/* Reads what lies in the pipe, 64 KB at most, and hands over the messages that have arrived whole; `arrived` keeps what has not.
 * As read() returns; 0: the other end is closed. */
ssize_t thr_messages_receive(int fd, thr_text *arrived, void (*take)(void *user, const thr_message *m, const char *bytes),
                             void *user);

/* Waits for the end, closes the pipes and leaves *process empty. THR_ESOLVER if the child did not end by run returning true: the
 * text begins with `who`, says the signal and what was printed, and ends with `advice` (NULL: none). */
thr_status thr_process_end(thr_process *process, const char *who, const char *advice, thr_err *err);

/* In a child: it is killed when its parent dies, whose process it was told; at once if that is dead already. */
void thr_process_die_with(pid_t parent);

/* What a process has to end by itself after it should have begun to: so many seconds and as much of its own processor time, so
 * that a busy machine does not kill it before its word is out. {0} is valid: it shall go on. */
typedef struct {
  double from;        /* thr_clock() at which it is to begin; 0 = never */
  double begun, used; /* its processor time then, and at the last look, s; 0 before */
  double idle_from;   /* thr_clock() at which that last grew */
} thr_grace;

/* Is it over? At the latest after five times `seconds`; at once when it has done nothing but sleep for so long. To be called
 * every 0.1 s or so. */
bool thr_grace_over(thr_grace *grace, pid_t pid, double seconds);

/* Has it slept without any work for some 20 s (3 s under sanitizers) of such calls, one every 0.1 s? A library that waits for
 * itself where memory is out while it holds a lock never ends. */
bool thr_process_stuck(thr_process *process);

/* Ends it at once, whatever it does, and closes the pipes; nothing if there is no child. */
void thr_process_kill(thr_process *process);

#endif
