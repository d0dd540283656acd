/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libthread: what is not of frames or plans. */
#include "eval/joint/world.h"
#include "lib/handles.h"
#include "lp/solver/lp.h"
#include "symmetry/group/group.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

void thr_library_lock(void)
{
  pthread_mutex_lock(&lock);
}

void thr_library_unlock(void)
{
  pthread_mutex_unlock(&lock);
}

int thread_version(void)
{
  return THREAD_VERSION;
}

const char *thread_libraries(void)
{
  static char text[200];
  int bullet = thr_bullet_version();
  thr_library_lock();
  snprintf(text, sizeof text, "thread %s, GLPK %s, igraph %s, nauty %s, Bullet %d.%d", THR_VERSION,
           thr_glpk_version(), thr_igraph_version(), thr_nauty_version(), bullet / 100,
           bullet % 100);
  thr_library_unlock();
  return text;
}

void thread_free(void *bytes)
{
  free(bytes);
}

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
  if (err) {
    snprintf(err->text, sizeof err->text, "%s", st ? from->text : "");
    thr_text_clean(err->text);
  }
  return same[st];
}

thr_status thr_library_options(void *own, size_t own_size, const void *theirs, const char *what,
                               thr_err *err)
{
  size_t size;
  if (!theirs) return THR_OK;
  memcpy(&size, theirs, sizeof size);
  if (size < 2 * sizeof size || size > 65536)
    return thr_fail(err, THR_EINPUT, "%s.size is %zu: call %s_init first", what, size, what);
  memcpy(own, theirs, size < own_size ? size : own_size);
  return THR_OK;
}

thr_status thr_library_give(thr_text *text, char **bytes, size_t *n, thr_err *err)
{
  thr_text_append_bytes(text, "", 0);
  if (text->failed || !text->data) {
    thr_text_destroy(text);
    return thr_nomem(err);
  }
  *bytes = text->data;
  if (n) *n = text->length;
  *text = (thr_text){0};
  return THR_OK;
}
