/* Bytes made small for PDF (FlateDecode): zlib, loaded when it is first used. Private to diagram/. */
#ifndef THR_DEFLATE_H
#define THR_DEFLATE_H

#include "graph/status.h"
#include "graph/text.h"

/* Loads zlib: before the first thr_deflate, in one thread. */
thr_status thr_deflate_load(thr_err *err) THR_MUST_CHECK;

/* Appends the bytes as a zlib stream (RFC 1950), the same wherever and whenever. Any thread. THR_ENOMEM. */
thr_status thr_deflate(const char *bytes, size_t n, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
