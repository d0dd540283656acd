/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compresses bytes for PDF, PNG and ZIP with zlib, which is loaded when it is first used. */
#include "diagram/export/export_parts.h"

#include "graph/process/process.h"

#include <limits.h>
#include <stdlib.h>
#include <zlib.h>

#define FUNCTIONS(F) F(deflateInit2_) F(deflate) F(deflateEnd)

static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

thr_status thr_deflate_load(thr_err *err)
{
  static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};
  return thr_lazy_load(&lib.loaded, THR_LIBRARY_Z, symbol, sizeof symbol / sizeof *symbol, err);
}

struct thr_deflater {
  z_stream stream;
};

thr_status thr_deflater_make(thr_deflater **out, thr_deflate_level level, bool raw, thr_err *err)
{
  enum { MEMORY = 8 }; /* of zlib's own, as it is usual */
  thr_deflater *made = thr_calloc(1, sizeof *made);
  *out = made;
  if (!made) return thr_nomem(err);
  if (lib.deflateInit2_(&made->stream, (int)level, Z_DEFLATED, raw ? -MAX_WBITS : MAX_WBITS, MEMORY,
                        Z_DEFAULT_STRATEGY, ZLIB_VERSION, (int)sizeof made->stream) == Z_OK)
    return THR_OK;
  free(made);
  *out = NULL;
  return thr_nomem(err);
}

thr_status thr_deflater_put(thr_deflater *deflater, const char *bytes, size_t n, bool last,
                            thr_text *out, thr_err *err)
{
  z_stream *stream = &deflater->stream;
  Bytef ready[1 << 14];
  stream->next_in = (Bytef *)bytes; /* which it only reads */

  /* zlib counts in int; what is ready is taken until there is no more. */
  do {
    const size_t some = n < INT_MAX ? n : INT_MAX;
    stream->avail_in = (uInt)some;
    n -= some;
    do {
      stream->next_out = ready;
      stream->avail_out = sizeof ready;
      lib.deflate(stream, last && n == 0 ? Z_FINISH : Z_NO_FLUSH);
      thr_text_append_bytes(out, (const char *)ready, sizeof ready - stream->avail_out);
    } while (stream->avail_out == 0 && !out->failed);
  } while (n > 0 && !out->failed);

  return out->failed ? thr_nomem(err) : THR_OK;
}

void thr_deflater_destroy(thr_deflater *deflater)
{
  if (deflater) lib.deflateEnd(&deflater->stream);
  free(deflater);
}

thr_status thr_deflate(const char *bytes, size_t n, thr_deflate_level level, thr_text *out,
                       thr_err *err)
{
  thr_deflater *deflater;
  thr_status st = thr_deflater_make(&deflater, level, false, err);
  if (!st) st = thr_deflater_put(deflater, bytes, n, true, out, err);
  thr_deflater_destroy(deflater);
  return st;
}
