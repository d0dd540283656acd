/* SPDX-License-Identifier: GPL-3.0-or-later */
/* No PDF: there are no fonts to set its words in; and no zlib to compress by: streams
 * hold their bytes as they are. */
#include "diagram/export/export_parts.h"
#include "diagram/export/paper.h"

#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

bool thr_pages_exist(void)
{
  return false;
}

thr_status thr_pages_open(thr_pages **pages, const char *name, thr_page_size size,
                          const char *title, const thr_limits *limits, thr_err *err)
{
  (void)size;
  (void)title;
  (void)limits;
  *pages = NULL;
  return thr_fail(err, THR_ESOLVER,
                  "the %s as PDF: this build of thread makes no PDF; the installed program draws "
                  "it from the same plan",
                  name);
}

void thr_pages_destroy(thr_pages *pages)
{
  (void)pages;
}

thr_status thr_pages_add(thr_pages *pages, int page, thr_text *svg, thr_err *err)
{
  (void)pages;
  (void)page;
  thr_text_destroy(svg);
  return thr_fail(err, THR_ESOLVER, "this program makes no PDF");
}

thr_status thr_pages_close(thr_pages *pages, bool last_first, thr_text *out, thr_err *err)
{
  (void)pages;
  (void)last_first;
  (void)out;
  return thr_fail(err, THR_ESOLVER, "this program makes no PDF");
}

thr_status thr_deflate_load(thr_err *err)
{
  (void)err;
  return THR_OK;
}

/* Appends a zlib stream (RFC 1950) of bytes as they are, in blocks (RFC 1951, 3.2.4), at any level.
 */
thr_status thr_deflate(const char *bytes, size_t n, thr_deflate_level level, thr_text *out,
                       thr_err *err)
{
  (void)level;
  enum { BLOCK = 65535, MODULUS = 65521 };
  unsigned long low = 1, high = 0;
  thr_text_append_bytes(out, "\x78\x01", 2);

  for (size_t at = 0; at == 0 || at < n; at += BLOCK) {
    size_t here = n - at < BLOCK ? n - at : BLOCK;
    const char head[5] = {at + here == n, (char)(here & 255), (char)(here >> 8),
                          (char)(~here & 255), (char)(~here >> 8 & 255)};
    thr_text_append_bytes(out, head, sizeof head);
    thr_text_append_bytes(out, bytes + at, here);
  }

  /* The checksum of Adler: the sum of the bytes, and the sum of these sums. */
  for (size_t i = 0; i < n; i++) {
    low = (low + (unsigned char)bytes[i]) % MODULUS;
    high = (high + low) % MODULUS;
  }
  const char sum[4] = {(char)(high >> 8), (char)(high & 255), (char)(low >> 8), (char)(low & 255)};
  thr_text_append_bytes(out, sum, sizeof sum);

  return out->failed ? thr_nomem(err) : THR_OK;
}
