/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compresses bytes for a PDF (FlateDecode) with zlib, which is loaded when it is first used. */
#include "diagram/export/export_parts.h"

#include "graph/process/process.h"

#include <stdlib.h>
#include <zlib.h>

#define FUNCTIONS(F) F(compress2) F(compressBound)

static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

thr_status thr_deflate_load(thr_err *err)
{
  static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};
  return thr_lazy_load(&lib.loaded, THR_LIBRARY_Z, symbol, sizeof symbol / sizeof *symbol, err);
}

thr_status thr_deflate(const char *bytes, size_t n, thr_deflate_level level, thr_text *out,
                       thr_err *err)
{
  uLongf size = lib.compressBound((uLong)n);

  /* zlib says beforehand how long the result may get. */
  Bytef *to = thr_realloc(NULL, size, 1);
  bool done = to && lib.compress2(to, &size, (const Bytef *)bytes, (uLong)n, (int)level) == Z_OK;

  if (done) thr_text_append_bytes(out, (const char *)to, size);
  free(to);
  return done && !out->failed ? THR_OK : thr_nomem(err);
}
