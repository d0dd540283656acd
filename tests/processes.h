/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For tests of processes: waiting, what is left behind, Ctrl-C, and few files. */
#ifndef THR_TEST_PROCESSES_H
#define THR_TEST_PROCESSES_H

#include <signal.h>

void pause_ms(long ms); /* whatever signals come */
void assert_no_children(void);
int open_files(void); /* files open below 256 */

/* As few files may be open as this process can; with 64 they are enough again. */
void allow_files(int most);

/* A handler of signals, and what it sets. */
extern volatile sig_atomic_t interrupted;
void interrupt(int signal_number);

#endif
