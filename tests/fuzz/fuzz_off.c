/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fuzzes the OFF reader. */
#include "fuzz.h"
#include "graph/io/read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  fuzz_one(data, size, thr_format_named("off"));
  return 0;
}
