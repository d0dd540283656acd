/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loads libraries that few commands need when one of their functions is first called, so that what
 * starts `thread check` is small. The headers of a library are used as ever; only calls go through
 * pointers, which are listed once (THR_LAZY_POINTER, THR_LAZY_SYMBOL in process.h).
 *
 * Example: eval/structure/spqr.c lists five functions of CHOLMOD and SuiteSparseQR, and calls
 * lib.SuiteSparseQR_C(..).
 *
 * Where all libraries are linked with the program (THR_LINKED, in targets/ and web/) nothing is
 * loaded, and there need be no dlopen. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"

#ifndef THR_LINKED
#include <dlfcn.h>
#endif
#include <string.h>

#ifndef THR_LINKED
/* Records why a library is not loaded. */
static thr_status failed(const char *library, thr_err *err)
{
  const char *reason = dlerror();
  return thr_fail(err, THR_ESOLVER,
                  "the library %s cannot be loaded (%s): install it as this program was built "
                  "with, or free memory",
                  library, reason ? reason : "no reason given");
}
#endif

/* Loads a library and fills the pointers; see process.h. */
thr_status thr_lazy_load(bool *loaded, const char *library, const thr_lazy_symbol *symbol, size_t n,
                         thr_err *err)
{
  if (*loaded) return THR_OK;

  /* A library that is linked with the program is there. */
  if (symbol[0].linked) {
    for (size_t i = 0; i < n; i++)
      memcpy(symbol[i].pointer, &symbol[i].linked, sizeof symbol[i].linked);
    *loaded = true;
    return THR_OK;
  }

#ifdef THR_LINKED
  return thr_fail(err, THR_ESOLVER, "%s is not linked with this program", library);
#else
  /* Functions of the libraries that it needs itself are found, too. */
  void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  if (!handle) return failed(library, err);

  /* A function that is missing means another version of the library. */
  for (size_t i = 0; i < n; i++) {
    void *function = dlsym(handle, symbol[i].name);
    if (!function) return failed(library, err);

    /* ISO C has no conversion from a pointer to data to one to a function; POSIX demands it. */
    memcpy(symbol[i].pointer, &function, sizeof function);
  }

  *loaded = true;
  return THR_OK;
#endif
}
