/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Libraries that few commands need are loaded when one of their functions is first called: what
 * starts `thread check` is small. The headers are used as ever; only calls go through pointers. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"

#include <dlfcn.h>
#include <string.h>

static thr_status failed(const char *library, thr_err *err)
{
  const char *reason = dlerror();
  return thr_fail(err, THR_ESOLVER,
                  "the library %s cannot be loaded (%s): install it as this program was built "
                  "with, or free memory",
                  library, reason ? reason : "no reason given");
}

thr_status thr_lazy_load(bool *loaded, const char *library, const thr_lazy_symbol *symbol, size_t n,
                         thr_err *err)
{
  if (*loaded) return THR_OK;
  void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  if (!handle) return failed(library, err);
  for (size_t i = 0; i < n; i++) {
    void *function = dlsym(handle, symbol[i].name);
    if (!function) return failed(library, err);
    memcpy(symbol[i].pointer, &function,
           sizeof function); /* ISO C has no conversion from one to the other, POSIX demands it */
  }
  *loaded = true;
  return THR_OK;
}
