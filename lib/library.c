/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements what libthread (include/thread.h) needs beside frameworks and plans: versions, the
 * lock, and the translation of statuses, options and texts.
 *
 * Structs of options begin with their size, so that a program which was built with an older header,
 * and knows fewer members, goes on working: members that it does not know have their usual values.
 */
#include "eval/joint/world.h"
#include "lib/lib.h"
#include "lp/solver/solver.h"
#include "symmetry/group/group.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Held by calls that use what is not reentrant: nauty, GLPK. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

/* Waits until no other call uses what is not reentrant. */
void thr_library_lock(void)
{
  pthread_mutex_lock(&lock);
}

/* Lets the next call go on. */
void thr_library_unlock(void)
{
  pthread_mutex_unlock(&lock);
}

/* Returns the version of the library, as a number. */
int thread_version(void)
{
  return THREAD_VERSION;
}

/* Returns the versions of the library and of those that it uses, as text. */
const char *thread_libraries(void)
{
  static char text[200];
  int bullet = thr_bullet_version();

  /* The text is the same every time, but is written under the lock. */
  thr_library_lock();
  snprintf(text, sizeof text, "thread %s, GLPK %s, igraph %s, nauty %s, Bullet %d.%d", THR_VERSION,
           thr_glpk_version(), thr_igraph_version(), thr_nauty_version(), bullet / 100,
           bullet % 100);
  thr_library_unlock();

  return text;
}

/* Frees what a char ** received; NULL ok. */
void thread_free(void *bytes)
{
  free(bytes);
}

/* What texts for the command line call otherwise than a member of the options that is named alike;
 * tests/library/words.py finds what is missing here. */
static const struct {
  const char *option, *member;
} members[] = {{"--feet (try --feet lowest)", "thread_frame_set_feet"},
               {"; `thread eval --help` lists them (here with _ for -)", ""},
               {"--objective tortuosity", "turning among the aims"},
               {"--objective", "aims"},
               {"--balance", "longest among the aims"},
               {"--length-slack", "length+P% among the aims"},
               {"--layers all", "all_layers 1"},
               {"--parallel keep", "parallel 1"},
               {"plan --joint solid", "tube 0"},
               {", or --clamp-feet", ""},
               {"; other --tune rays may help", ""},
               {"a finer --tune time-step, ", ""},
               {"fewer --seeds", "fewer plans"},
               {"; draw it smaller: --pitch", ""},
               {"; --pitch says how large", ""},
               {"--width", "width of `thread kit`"},
               {"--wall", "wall of `thread kit`"},
               {"--letters", "letters of `thread kit`"},
               {"--channels", "channels of `thread kit`"},
               {"--tube-ends", "tube-ends of `thread kit`"},
               {"--bed", "bed of `thread kit`"}};

/* Copies a text for programs: options are called by members, --max-length is max_length. */
static void copy_text(char *to, size_t size, const char *from)
{
  size_t n = 0;
  while (*from && n + 1 < size) {
    size_t known = 0, i = 0;
    for (; i < sizeof members / sizeof *members && !known; i++)
      if (strncmp(from, members[i].option, strlen(members[i].option)) == 0)
        known = strlen(members[i].option);
    if (known) {
      n += (size_t)snprintf(to + n, size - n, "%s", members[i - 1].member);
      if (n >= size) n = size - 1;
      from += known;
    } else if (from[0] == '-' && from[1] == '-' && from[2] >= 'a' && from[2] <= 'z') {
      for (from += 2; (*from >= 'a' && *from <= 'z') || *from == '-'; from++)
        if (n + 1 < size) to[n++] = *from == '-' ? '_' : *from;
    } else
      to[n++] = *from++;
  }
  to[n] = '\0';
}

thr_status thr_library_words(thr_text *text, thr_err *err)
{
  enum { LONGER = 4 }; /* times at most: every member in the table above is shorter than that */
  const size_t size = LONGER * text->length + 1;
  if (text->length == 0) return THR_OK;

  char *words = thr_calloc(size, 1);
  if (!words) return thr_nomem(err);
  copy_text(words, size, text->data);
  text->length = 0;
  thr_text_append(text, words);
  free(words);
  return text->failed ? thr_nomem(err) : THR_OK;
}

/* Translates status and text; see lib.h. */
thread_status thr_library_status(thr_status st, const thr_err *from, thread_error *err)
{
  static const thread_status same[] = {[THR_OK] = THREAD_OK,
                                       [THR_ENOMEM] = THREAD_NO_MEMORY,
                                       [THR_EIO] = THREAD_IO,
                                       [THR_EINPUT] = THREAD_BAD_INPUT,
                                       [THR_EINFEASIBLE] = THREAD_INFEASIBLE,
                                       [THR_ELIMIT] = THREAD_NOT_PROVED,
                                       [THR_ESOLVER] = THREAD_SOLVER,
                                       [THR_EVIOLATED] = THREAD_VIOLATED};

  /* A text of one line, in UTF-8 even if a file was not. */
  if (err) {
    copy_text(err->text, sizeof err->text, st ? from->text : "");
    thr_text_clean(err->text);
  }

  return same[st];
}

thr_status thr_library_none(const char *kind, const char *given, const char *(*name)(int), int n,
                            thr_err *err)
{
  char list[400] = "";
  for (int i = 0; i < n; i++) {
    const size_t length = strlen(list);
    snprintf(list + length, sizeof list - length, "%s%s", i ? ", " : "", name(i));
  }
  return thr_fail(err, THR_EINPUT, "there is no %s %.60s, only %s", kind, given, list);
}

/* Copies a program's options over the usual ones; see lib.h. */
thr_status thr_library_options(void *own, size_t own_size, const void *theirs, const char *what,
                               thr_err *err)
{
  size_t size;
  if (!theirs) return THR_OK;

  /* The first member is the size that the program knows. */
  memcpy(&size, theirs, sizeof size);

  /* No struct of options has such a size: it was not initialized. */
  if (size < 2 * sizeof size || size > 65536)
    return thr_fail(err, THR_EINPUT, "%s.size is %zu: call %s_init first", what, size, what);
  memcpy(own, theirs, size < own_size ? size : own_size);

  return THR_OK;
}

/* Makes a text the caller's; see lib.h. */
thr_status thr_library_give(thr_text *text, char **bytes, size_t *n, thr_err *err)
{
  /* An empty text has a NUL, too. */
  thr_text_append_bytes(text, "", 0);
  if (text->failed || !text->data) {
    thr_text_destroy(text);
    return thr_nomem(err);
  }

  /* The caller frees it with thread_free. */
  *bytes = text->data;
  if (n) *n = text->length;
  *text = (thr_text){0};
  return THR_OK;
}
