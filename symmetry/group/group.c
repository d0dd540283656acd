/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A finite permutation group with all its elements listed, and its subgroups up to conjugacy.
 *
 * Elements are found breadth first from the generators, with a table of products; subgroups by
 * extension: each one is extended by one more element, and one of each class of conjugates is kept
 * (J. Neubueser 1960).
 *
 * Example: the eight elements of the square's group have 10 subgroups in 8 classes. */
#include "symmetry/group/group.h"
#include "graph/scratch.h"
#include "symmetry/group/groups.h"

#include <stdlib.h>
#include <string.h>

/* The elements in order of discovery, found again by their hash. Every element but the first is an
 * earlier one times a generator, which gives the product table without multiplying out: g * (h * s)
 * = (g * h) * s. */
typedef struct {
  int degree, cap, n_generators;
  const int *generator;
  int order, capacity;
  int *image;      /* [capacity * degree] */
  thr_scratch own; /* all other arrays */
  int *slot;       /* [slots] element or -1; slots is a power of two and more than 2 * cap */
  unsigned slots;  /* of the hash table */
  int *times;      /* [cap * n_generators] number of the element g * s */
  int *from, *by;  /* [cap] element g = from[g] * generator by[g] */
} listing;

static int *row_of(const listing *l, int g)
{
  return &l->image[(size_t)g * (size_t)l->degree];
}

static uint64_t hash_of(const int *image, int degree)
{
  uint64_t h = UINT64_C(14695981039346656037);
  for (int x = 0; x < degree; x++)
    h = (h ^ (uint64_t)image[x]) * UINT64_C(1099511628211);
  return h ^ h >> 32;
}

/* Number of the element in the row after the last, which becomes a new one if it is none of the
 * others. */
static int number_last(listing *l)
{
  size_t bytes = (size_t)l->degree * sizeof *l->image;
  const int *last = row_of(l, l->order);
  unsigned i = (unsigned)hash_of(last, l->degree) & (l->slots - 1);
  while (l->slot[i] >= 0 && memcmp(row_of(l, l->slot[i]), last, bytes) != 0)
    i = (i + 1) & (l->slots - 1);
  if (l->slot[i] < 0) l->slot[i] = l->order++;
  return l->slot[i];
}

static thr_status make_room(listing *l, thr_err *err)
{
  if (l->order < l->capacity) return THR_OK;
  int wanted = 2 * l->capacity + 1 < l->cap + 1 ? 2 * l->capacity + 1 : l->cap + 1;
  int *image = thr_realloc(l->image, (size_t)wanted * (size_t)l->degree, sizeof *image);
  if (!image) return thr_nomem(err);
  l->image = image;
  l->capacity = wanted;
  return THR_OK;
}

static thr_status listing_init(listing *l, thr_err *err)
{
  for (l->slots = 4; l->slots <= 2u * (unsigned)l->cap;)
    l->slots *= 2;
  l->slot = thr_scratch_array(&l->own, l->slots, sizeof *l->slot);
  l->times = thr_scratch_array(&l->own, (size_t)l->cap * (size_t)l->n_generators, sizeof *l->times);
  l->from = thr_scratch_array(&l->own, (size_t)l->cap + 1, sizeof *l->from);
  l->by = thr_scratch_array(&l->own, (size_t)l->cap + 1, sizeof *l->by);
  thr_status st = thr_scratch_check(&l->own, err);
  if (st) return st;
  memset(l->slot, -1, l->slots * sizeof *l->slot);
  return make_room(l, err);
}

static void listing_destroy(listing *l)
{
  free(l->image);
  thr_scratch_free(&l->own);
}

/* Breadth first from the identity: each element times each generator. */
static thr_status list_elements(listing *l, thr_err *err)
{
  for (int x = 0; x < l->degree; x++)
    l->image[x] = x;
  number_last(l);
  for (int g = 0; g < l->order; g++)
    for (int s = 0; s < l->n_generators; s++) {
      thr_status st = make_room(l, err);
      if (st) return st;
      const int *first = &l->generator[(size_t)s * (size_t)l->degree], *then = row_of(l, g);
      int *last = row_of(l, l->order), before = l->order;
      for (int x = 0; x < l->degree; x++)
        last[x] = then[first[x]];
      int h = number_last(l);
      if (l->order > l->cap)
        return thr_fail(err, THR_ELIMIT, "the group has more than %d elements", l->cap);
      l->times[(size_t)g * (size_t)l->n_generators + (size_t)s] = h;
      if (h < before) continue;
      l->from[h] = g;
      l->by[h] = s;
    }
  return THR_OK;
}

/* number[element as listed] is its number in the group; listed: [order] scratch. */
static void fill_products(const listing *l, const int *number, int *listed, thr_group *group)
{
  for (int a = 0; a < group->order; a++) {
    int *row = &group->product[(size_t)number[a] * (size_t)group->order];
    listed[0] = a; /* a * h, for every h */
    for (int h = 1; h < group->order; h++)
      listed[h] = l->times[(size_t)listed[l->from[h]] * (size_t)l->n_generators + (size_t)l->by[h]];
    for (int h = 0; h < group->order; h++)
      row[number[h]] = number[listed[h]];
  }
}

static void fill_orders(thr_group *group)
{
  for (int a = 0; a < group->order; a++) {
    int k = 1, last = 0, power = a;
    for (; power != 0; k++) {
      last = power;
      power = group->product[(size_t)power * (size_t)group->order + (size_t)a];
    }
    group->power_order[a] = k;
    group->inverse[a] = last; /* the power before the identity; of the identity: itself */
  }
}

/* Takes the list of images over. */
static thr_status tabulate(listing *l, thr_group *group, thr_err *err)
{
  size_t order = (size_t)l->order;
  int *listed = thr_scratch_array(&l->own, order, sizeof *listed),
      *number = thr_scratch_array(&l->own, order, sizeof *number);
  *group = (thr_group){.degree = l->degree, .order = l->order, .image = l->image};
  l->image = NULL;
  group->product = thr_calloc(order * order, sizeof *group->product);
  group->inverse = thr_calloc(order, sizeof *group->inverse);
  group->power_order = thr_calloc(order, sizeof *group->power_order);
  thr_status st = group->product && group->inverse && group->power_order
                      ? thr_scratch_check(&l->own, err)
                      : thr_nomem(err);
  if (!st) st = thr_rows_sort(group->image, group->order, group->degree, listed, err);
  if (!st) {
    for (int a = 0; a < group->order; a++)
      number[listed[a]] = a;
    fill_products(l, number, listed, group);
    fill_orders(group);
  }
  return st;
}

/* Is every generator a permutation? */
static thr_status check_generators(int degree, const int *generator, int n, thr_err *err)
{
  bool *hit = thr_calloc((size_t)degree, sizeof *hit), good = true;
  if (!hit) return thr_nomem(err);
  for (int s = 0; s < n && good; s++) {
    memset(hit, 0, (size_t)degree * sizeof *hit);
    for (int x = 0; x < degree && good; x++) {
      int y = generator[(size_t)s * (size_t)degree + (size_t)x];
      good = y >= 0 && y < degree && !hit[y];
      if (good) hit[y] = true;
    }
    if (!good)
      thr_fail(err, THR_EINPUT, "generator %d is not a permutation of %d points", s, degree);
  }
  free(hit);
  return good ? THR_OK : THR_EINPUT;
}

thr_status thr_group_generate(int degree, const int *generator, int n_generators, int cap,
                              thr_group *out, thr_err *err)
{
  listing l = {.degree = degree, .generator = generator, .n_generators = n_generators};
  thr_group group = {0};
  l.cap = cap < 1 ? 1 : cap > THR_GROUP_CAP ? THR_GROUP_CAP : cap;
  thr_status st = check_generators(degree, generator, n_generators, err);
  if (!st) st = listing_init(&l, err);
  if (!st) st = list_elements(&l, err);
  if (!st) st = tabulate(&l, &group, err);
  listing_destroy(&l);
  if (st) thr_group_destroy(&group);
  *out = group;
  return st;
}

void thr_group_destroy(thr_group *group)
{
  free(group->image);
  free(group->product);
  free(group->inverse);
  free(group->power_order);
  *group = (thr_group){0};
}
