/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Working memory of searches: arrays that grow and are kept, sorting, disjoint sets, and random
 * numbers that are the same everywhere. */
#ifndef THR_ARRAYS_H
#define THR_ARRAYS_H

#include "graph/status.h"

/* ---- Arrays that live as long as a call or an object: taken as they are needed, asked about once,
 * freed at once.
 *
 *   thr_scratch own = {0};
 *   int *parent = thr_scratch_array(&own, n, sizeof *parent);
 *   bool *seen = thr_scratch_array(&own, n, sizeof *seen);
 *   thr_status st = thr_scratch_check(&own, err);
 *   ..
 *   thr_scratch_free(&own); */

/* {0} is valid and empty. */
typedef struct {
  struct thr_scratch_array *last;
  bool failed;
} thr_scratch;

/* Zeroed array of n elements of size bytes, as thr_calloc gives it: an allocation of its own, so
 * that tests and sanitizers see each one. NULL when memory runs out, and from then on. Never freed
 * or made longer by itself. */
void *thr_scratch_array(thr_scratch *scratch, size_t n, size_t size) THR_MUST_CHECK;

/* THR_ENOMEM if any of the arrays so far is missing. */
thr_status thr_scratch_check(const thr_scratch *scratch, thr_err *err) THR_MUST_CHECK;

/* Frees them all; it is empty then. */
void thr_scratch_free(thr_scratch *scratch);

/* ---- Sorts numbers in ascending order. */

void thr_sort_ints(int *list, size_t n);
void thr_sort_doubles(double *list, size_t n);

/* What has this index, and the key that it is sorted by: equal keys by index. */
typedef struct {
  double key;
  int index;
} thr_ranked;

void thr_sort_ranked(thr_ranked *list, size_t n);

/* ---- Disjoint sets in an array of parents (parent[v] == v: a root), with path halving; the lowest
 * member stays root. */

static inline int thr_disjoint_find(int *parent, int v)
{
  while (parent[v] != v)
    v = parent[v] = parent[parent[v]];
  return v;
}

/* Joins the sets of a and b; returns 0 if they were one set already, else 1. */
static inline int thr_disjoint_join(int *parent, int a, int b)
{
  a = thr_disjoint_find(parent, a);
  b = thr_disjoint_find(parent, b);
  if (a == b) return 0;
  parent[a < b ? b : a] = a < b ? a : b;
  return 1;
}

/* number[n] receives the number of the set of each member of parent[n], in the order of the sets'
 * lowest members; returns how many there are. number may be parent itself, which is no forest any
 * more then. */
static inline int thr_disjoint_number(int *parent, int n, int *number)
{
  int count = 0;
  for (int v = 0; v < n; v++)
    number[v] = thr_disjoint_find(parent, v);
  for (int v = 0; v < n; v++) /* roots are the lowest of their sets, so their numbers are known */
    number[v] = number[v] == v ? count++ : number[number[v]];
  return count;
}

/* ---- Random numbers that are the same everywhere: SplitMix64 (Steele, Lea and Flood, "Fast
 * splittable pseudorandom number generators", OOPSLA 2014). */

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
