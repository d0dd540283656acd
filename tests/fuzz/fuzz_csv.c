/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fuzzes the CSV reader: one table, and a pair of tables if the byte | stands somewhere; and the
 * guess of the format. */
#include "fuzz.h"
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/status.h"
#include "graph/text.h"

static void fuzz_pair(const uint8_t *data, size_t size, const uint8_t *cut)
{
  thr_text nodes = {0}, edges = {0};
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  thr_text_append_bytes(&nodes, (const char *)data, (size_t)(cut - data));
  thr_text_append_bytes(&edges, (const char *)cut + 1, size - (size_t)(cut - data) - 1);
  thr_status st = thr_csv_parse_pair(&d, &r, &nodes, "nodes", &edges, "edges", &err);
  check_draft(st, &d, &r, &err);
  thr_text_destroy(&nodes);
  thr_text_destroy(&edges);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  const uint8_t *cut = size ? memchr(data, '|', size) : NULL;
  if (cut) fuzz_pair(data, size, cut);
  fuzz_one(data, size, thr_format_named("csv"));
  fuzz_one(data, size, NULL);
  return 0;
}
