/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fuzzes the reader of cached joints: the input as a whole file, and as the values of one whose key
 * and checksum are right. What is read must be finite, and write the same file again. */
#include "eval/joint/joint.h"
#include "fuzz.h"
#include "graph/text.h"

#include <inttypes.h>

static void read_back(const thr_text *file, const thr_text *key)
{
  thr_drag_result r = {.status = 7};
  thr_text again = {0};
  if (!thr_cache_parse(file->data, file->length, key, &r)) {
    MUST(r.status == 7);
    return;
  }
  MUST(isfinite(r.ratio) && isfinite(r.drift) && isfinite(r.scatter) && isfinite(r.taut) &&
       isfinite(r.steps));
  MUST(r.status == THR_DRAG_SETTLED || r.status == THR_DRAG_UNSETTLED ||
       r.status == THR_DRAG_OUT_OF_RANGE);
  thr_cache_write(key, &r, &again);
  MUST(!again.failed && again.length == file->length &&
       memcmp(again.data, file->data, again.length) == 0);
  thr_text_destroy(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  thr_text key = {0}, whole = {0}, signed_values = {0};
  thr_text_append(&key, "key\n");
  thr_text_append(&whole, "");
  thr_text_append_bytes(&whole, (const char *)data, size);
  read_back(&whole, &key);

  uint64_t hash = 14695981039346656037u; /* FNV-1a */
  thr_text_append(&signed_values, "key\n");
  thr_text_append_bytes(&signed_values, (const char *)data, size);
  for (size_t i = 0; i < signed_values.length; i++)
    hash = (hash ^ (unsigned char)signed_values.data[i]) * 1099511628211u;
  thr_text_printf(&signed_values, "check %016" PRIx64 "\n", hash);
  read_back(&signed_values, &key);
  thr_text_destroy(&key);
  thr_text_destroy(&whole);
  thr_text_destroy(&signed_values);
  return 0;
}
