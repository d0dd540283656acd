/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random numbers that are the same everywhere: SplitMix64 (Steele, Lea and Flood, "Fast splittable
 * pseudorandom number generators", OOPSLA 2014). */
#ifndef THR_RANDOM_H
#define THR_RANDOM_H

#include <stdint.h>

/* The next number of the sequence that *state stands in; any state will do to begin with. */
static inline uint64_t thr_random(uint64_t *state)
{
  uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
  return z ^ z >> 31;
}

/* One of 0 .. n - 1, n > 0. */
static inline int thr_random_below(uint64_t *state, int n)
{
  return (int)(thr_random(state) % (uint64_t)n);
}

/* Even in [0, 1). */
static inline double thr_random_unit(uint64_t *state)
{
  return (double)(thr_random(state) >> 11) * 0x1p-53;
}

/* Even in [-1, 1). */
static inline double thr_random_disorder(uint64_t *state)
{
  return (double)(thr_random(state) >> 11) * 0x1p-52 - 1;
}

#endif
