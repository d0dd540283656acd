/* SPDX-License-Identifier: GPL-3.0-or-later */
/* graph/process/lazy.c where the libraries are linked with the program. */
#include "graph/process/process.h"
#include "graph/status.h"

#include <string.h>

thr_status thr_lazy_load(bool *loaded, const char *library, const thr_lazy_symbol *symbol, size_t n,
                         thr_err *err)
{
  if (*loaded) return THR_OK;
  for (size_t i = 0; i < n; i++) {
    if (!symbol[i].linked)
      return thr_fail(err, THR_ESOLVER, "%s: %s is not linked with this program", library,
                      symbol[i].name);
    memcpy(symbol[i].pointer, &symbol[i].linked,
           sizeof symbol[i].linked); /* as in graph/process/lazy.c */
  }
  *loaded = true;
  return THR_OK;
}
