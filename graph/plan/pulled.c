/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names which end of a cord is pulled, as plan.json and the command line have it. */
#include "graph/plan/physics.h"

#include <string.h>

static const char *const pull_name[] = {"start", "end", "both", "none"};

const char *thr_pull_name(int p)
{
  return pull_name[p];
}

int thr_pull_named(const char *name)
{
  for (int i = 0; name && i < THR_N_PULLS; i++)
    if (strcmp(name, pull_name[i]) == 0) return i;
  return -1;
}
