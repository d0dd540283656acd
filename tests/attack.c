/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/attack.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool attack_climb(rng *r, const attack_kind *kind, const void *target, void *candidate, int steps,
                  attack_tally *tally)
{
  void *next = malloc(kind->size);
  ck_assert(next != NULL);
  double best = kind->judge(target, candidate);
  for (int i = 0; i < steps && best <= kind->false_above; i++) {
    memcpy(next, candidate, kind->size);
    for (int changes = 1 + (rng_below(r, 3) == 0); changes > 0; changes--)
      kind->change(r, target, next);
    double value = kind->judge(target, next);
    tally->judged++;
    tally->accepted += value > -INFINITY;
    if (value < best) continue;
    best = value;
    memcpy(candidate, next, kind->size);
  }
  free(next);
  if (best > tally->best) tally->best = best;
  tally->holes += best > kind->false_above;
  return best > kind->false_above;
}

long attack_number(long usual)
{
  const char *text = getenv("THREAD_ADVERSARY_ATTACKS");
  return text ? strtol(text, NULL, 10) : share_of((int)usual);
}

uint64_t attack_seed(void)
{
  const char *text = getenv("THREAD_ADVERSARY_SEED");
  return text ? strtoull(text, NULL, 10) : 1;
}

void attack_report(const attack_tally *t)
{
  if (!getenv("THREAD_ADVERSARY_ATTACKS")) return;
  printf("%-10s %10ld attacks, %10ld accepted, %ld holes, best %+.3g of the truth\n", t->name,
         t->judged, t->accepted, t->holes, t->best);
  fflush(stdout);
}

double attack_factor(rng *r)
{
  switch (rng_below(r, 6)) {
  case 0: return 2;
  case 1: return 0.5;
  case 2: return 1 + (rng_unit(r) - 0.5) * pow(10, -rng_between(r, 0, 12));
  case 3: return pow(10, rng_between(r, -6, 6));
  case 4: return 1 + rng_unit(r);
  default: return rng_unit(r) + 1e-3;
  }
}

int64_t attack_integer(rng *r)
{
  int64_t size = INT64_C(1) << rng_below(r, 62);
  size += (int64_t)(rng_unit(r) * (double)size);
  return rng_below(r, 2) ? size : -size;
}
