/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cli/guard.c for a system that has one process. The time ends a search as it does everywhere;
 * nobody ends what takes no heed of it. The memory is bounded where the program gets it from its
 * host. The best plan so far goes to the host, too, who may end the program whenever it likes. */
#include "cli/cli.h"
#include "graph/limits.h"
#include "graph/text.h"
#include "targets/host.h"

#include <stdio.h>

static double deadline; /* thr_clock() */
static thr_text kept;
static bool written, no_memory;
static double memory;

bool guard_fork(const guard_limits *l, guard_end *end)
{
  *end = (guard_end){0};
  deadline = l->seconds > 0 ? thr_clock() + l->seconds : 0;
  memory = l->memory;
  host_bound_memory(memory);
  return false;
}

/* A command that left no plan leaves the best that it had. */
bool guard_alone(int code, guard_end *end)
{
  if (written || kept.length == 0) return false;
  *end = (guard_end){.code = code, .reason = no_memory ? GUARD_MEMORY : GUARD_DONE, .kept = kept};
  kept = (thr_text){0};
  if (no_memory && memory > 0)
    snprintf(end->why, sizeof end->why, "out of memory (--memory allows %g MB)", memory / 1e6);
  else if (no_memory)
    snprintf(end->why, sizeof end->why, "out of memory");
  return true;
}

double guard_deadline(void)
{
  return deadline;
}

void guard_allow(double seconds)
{
  deadline = seconds > 0 ? thr_clock() + seconds : 0;
}

void guard_keep(const thr_text *text)
{
  if (text->failed) return;
  kept.length = 0;
  thr_text_append_bytes(&kept, text->data, text->length);
  host_plan(text->data, text->length);
}

void guard_writing(void) {}

void guard_written(int code)
{
  (void)code;
  written = true;
}

bool guard_no_memory(void)
{
  no_memory = true;
  return false;
}

void guard_answered(void) {}

bool guard_ending(int code, const char *error)
{
  (void)code, (void)error;
  return false;
}
