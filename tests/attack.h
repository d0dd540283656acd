/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The adversary's search: candidates are changed a little at a time, and what the checker would
 * prove from them is to rise. */
#ifndef THR_ATTACK_H
#define THR_ATTACK_H

#include "tests/support.h"

/* A candidate is a plain structure that can be copied. change alters it. judge lets the checker
 * have it and returns by how much what is proved is above the truth, as a part of it, or less:
 * -INFINITY if nothing is proved. */
typedef struct {
  size_t size;
  void (*change)(rng *r, const void *target, void *candidate);
  double (*judge)(const void *target, const void *candidate);
  double false_above; /* what is above the truth by more is a hole */
} attack_kind;

/* What came of the attacks so far. */
typedef struct {
  const char *name;
  long judged, accepted, holes;
  double best; /* of what judge said */
} attack_tally;

/* Climbs from a candidate, which ends as the best one: a change that is no worse is kept. Returns
 * true as soon as there is a hole. */
bool attack_climb(rng *r, const attack_kind *kind, const void *target, void *candidate, int steps,
                  attack_tally *tally);

/* How many attacks to make (THREAD_ADVERSARY_ATTACKS in the environment; otherwise a part of the
 * usual number), and the first seed (THREAD_ADVERSARY_SEED). */
long attack_number(long usual);
uint64_t attack_seed(void);

/* Prints the tally if THREAD_ADVERSARY_ATTACKS is set. */
void attack_report(const attack_tally *tally);

/* A factor or number that is often extreme. */
double attack_factor(rng *r);
int64_t attack_integer(rng *r);

#endif
