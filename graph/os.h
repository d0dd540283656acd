/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What systems differ in, and nothing else: files and folders, signals, processors, pages of
 * memory. os.c for POSIX. */
#ifndef THR_OS_H
#define THR_OS_H

#include <stdbool.h>
#include <stddef.h>

/* ---- files; paths are UTF-8 ---- */

/* What follows the last separator of a path, within it: "a/b.obj": "b.obj". */
const char *thr_os_name(const char *path);
bool thr_os_is_separator(char c);

/* Links are followed: a link to a folder is one. */
bool thr_os_is_folder(const char *path);
bool thr_os_is_file(const char *path);

/* Is something there that is no regular file, be it a link to one? */
bool thr_os_is_no_file(const char *path);

/* Do both paths lead to one regular file, over links of either kind and whatever the spelling? Of
 * files that are not there yet: would they be one? */
bool thr_os_is_same_file(const char *a, const char *b);

/* One new folder, in one that exists; false with errno. Removing takes an empty one. */
bool thr_os_make_folder(const char *path);
bool thr_os_remove_folder(const char *path);

/* Tries whether thr_os_write can write to path, and leaves all as it was; false with errno. */
bool thr_os_can_write(const char *path);

/* Writes n bytes through a temporary file in the same folder and rename, so that path is either the
 * old file or the whole new one, and after a loss of power as well. The file keeps its rights, a
 * link stays a link, be there a file at its end or not yet, a device or pipe is written to. False
 * with errno: ENOMEM if there was no memory. */
bool thr_os_write(const char *path, const char *data, size_t n);

/* Length of the regular file at path, whose bytes are then in data, if it is less than size; else
 * -1. Waits for no pipe. */
int thr_os_read_small(const char *path, char *data, int size);

/* Where a user's programs keep what they can make again: with thread's own folder appended; "" if
 * there is no such place. */
void thr_os_cache_folder(char *path, size_t size);

/* ---- processes ---- */

/* Calls on_stop at Ctrl-C, when the program is told to end and when its terminal closes, every
 * time. What the terminal took with it ends nothing then: nobody reading is no reason to end. A
 * program that was told to outlive its terminal (nohup) does. */
enum { THR_OS_HANGUP = 1 }; /* what on_stop hears then */
void thr_os_heed_stop(void (*on_stop)(int signal));

/* Calls on_tick every so many seconds from now on, in the midst of whatever is computed: it may do
 * no more than a signal handler. 0 s: no more. Nothing is called where the system has no such
 * clock. */
void thr_os_tick(int seconds, void (*on_tick)(int signal));

int thr_os_processors(void);

/* Columns of the terminal that an open file is; 0: it is none. */
int thr_os_columns(int file);

/* Processor time, user and system, s, of this process and of its children that have ended. */
double thr_os_processor_seconds(void);

/* ---- memory ---- */

/* Asks for large pages under a large block, before it is touched: a wish that the system may leave
 * unheard. Returns the block; errno is what it was. */
void *thr_os_on_large_pages(void *block, size_t bytes);

#endif
