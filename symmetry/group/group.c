/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists all elements of a finite permutation group, with tables of products, inverses and orders.
 *
 * Elements are found breadth first from the generators. Every element but the first is an earlier
 * one times a generator, g = h s, which gives the product table without multiplying out: a (h s) =
 * (a h) s. symmetry/group/subgroups.c finds the subgroups.
 *
 * Example: two generators of the square's group, a turn and a reflection, make its eight elements.
 */
#include "symmetry/group/group.h"
#include "graph/arrays.h"
#include "symmetry/group/groups.h"

#include <stdlib.h>
#include <string.h>

/* The elements in order of discovery, found again by their hash. */
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
} element_listing;

/* Returns the images of a listed element. */
static int *row_of(const element_listing *listing, int g)
{
  return &listing->image[(size_t)g * (size_t)listing->degree];
}

/* Returns the hash of an element (Fowler, Noll and Vo, with a last mixing step). */
static uint64_t hash_of(const int *image, int degree)
{
  uint64_t hash = UINT64_C(14695981039346656037);
  for (int point = 0; point < degree; point++)
    hash = (hash ^ (uint64_t)image[point]) * UINT64_C(1099511628211);
  return hash ^ hash >> 32;
}

/* Returns the number of the element in the row after the last, which becomes a new one if it is
 * none of the others. */
static int number_last(element_listing *listing)
{
  size_t bytes = (size_t)listing->degree * sizeof *listing->image;
  const int *last = row_of(listing, listing->order);

  /* Open addressing. */
  unsigned i = (unsigned)hash_of(last, listing->degree) & (listing->slots - 1);
  while (listing->slot[i] >= 0 && memcmp(row_of(listing, listing->slot[i]), last, bytes) != 0)
    i = (i + 1) & (listing->slots - 1);
  if (listing->slot[i] < 0) listing->slot[i] = listing->order++;
  return listing->slot[i];
}

/* Allocates one more row of images, if there is none left. */
static thr_status grow_images(element_listing *listing, thr_err *err)
{
  if (listing->order < listing->capacity) return THR_OK;
  int wanted =
      2 * listing->capacity + 1 < listing->cap + 1 ? 2 * listing->capacity + 1 : listing->cap + 1;
  int *image = thr_realloc(listing->image, (size_t)wanted * (size_t)listing->degree, sizeof *image);
  if (!image) return thr_nomem(err);
  listing->image = image;
  listing->capacity = wanted;
  return THR_OK;
}

/* Allocates the table and the arrays; the caller destroys listing also on failure. */
static thr_status listing_init(element_listing *listing, thr_err *err)
{
  /* More than twice as many slots as elements. */
  for (listing->slots = 4; listing->slots <= 2u * (unsigned)listing->cap;)
    listing->slots *= 2;

  listing->slot = thr_scratch_array(&listing->own, listing->slots, sizeof *listing->slot);
  listing->times = thr_scratch_array(
      &listing->own, (size_t)listing->cap * (size_t)listing->n_generators, sizeof *listing->times);
  listing->from = thr_scratch_array(&listing->own, (size_t)listing->cap + 1, sizeof *listing->from);
  listing->by = thr_scratch_array(&listing->own, (size_t)listing->cap + 1, sizeof *listing->by);

  thr_status st = thr_scratch_check(&listing->own, err);
  if (st) return st;

  /* All slots are empty, and there is a row for the identity. */
  memset(listing->slot, -1, listing->slots * sizeof *listing->slot);
  return grow_images(listing, err);
}

static void listing_destroy(element_listing *listing)
{
  free(listing->image);
  thr_scratch_free(&listing->own);
}

/* Lists the elements breadth first from the identity: each element times each generator.
 * THR_ELIMIT: there are more than the cap. */
static thr_status list_elements(element_listing *listing, thr_err *err)
{
  /* The identity. */
  for (int point = 0; point < listing->degree; point++)
    listing->image[point] = point;
  number_last(listing);

  /* Elements that are added are multiplied, too. */
  for (int element = 0; element < listing->order; element++)
    for (int by_generator = 0; by_generator < listing->n_generators; by_generator++) {
      thr_status st = grow_images(listing, err);
      if (st) return st;

      const int *first = &listing->generator[(size_t)by_generator * (size_t)listing->degree],
                *then = row_of(listing, element);
      int *last = row_of(listing, listing->order), before = listing->order;
      for (int point = 0; point < listing->degree; point++)
        last[point] = then[first[point]];

      /* Known, or new as this product. */
      int product = number_last(listing);
      if (listing->order > listing->cap)
        return thr_fail(err, THR_ELIMIT, "the group has more than %d elements", listing->cap);
      listing->times[(size_t)element * (size_t)listing->n_generators + (size_t)by_generator] =
          product;
      if (product < before) continue;
      listing->from[product] = element;
      listing->by[product] = by_generator;
    }
  return THR_OK;
}

/* Fills the product table. number[element as listed]: its number in the group; listed: [order]
 * scratch. */
static void fill_products(const element_listing *listing, const int *number, int *listed,
                          thr_group *group)
{
  for (int element = 0; element < group->order; element++) {
    int *row = &group->product[(size_t)number[element] * (size_t)group->order];

    /* element * factor for every factor, from those before it. */
    listed[0] = element;
    for (int factor = 1; factor < group->order; factor++)
      listed[factor] =
          listing->times[(size_t)listed[listing->from[factor]] * (size_t)listing->n_generators +
                         (size_t)listing->by[factor]];

    /* Renumbered. */
    for (int factor = 0; factor < group->order; factor++)
      row[number[factor]] = number[listed[factor]];
  }
}

/* Fills the orders and inverses of all elements, by their powers. */
static void fill_orders(thr_group *group)
{
  for (int element = 0; element < group->order; element++) {
    /* Powers, until the identity comes. */
    int k = 1, last = 0, power = element;
    for (; power != 0; k++) {
      last = power;
      power = group->product[(size_t)power * (size_t)group->order + (size_t)element];
    }

    group->power_order[element] = k;
    group->inverse[element] = last; /* the power before the identity; the identity's own */
  }
}

/* Makes the tables of the group, with elements in lexicographic order. Takes the list of images
 * over. */
static thr_status make_tables(element_listing *listing, thr_group *group, thr_err *err)
{
  size_t order = (size_t)listing->order;
  int *listed = thr_scratch_array(&listing->own, order, sizeof *listed),
      *number = thr_scratch_array(&listing->own, order, sizeof *number);

  /* The images change hands. */
  *group = (thr_group){.degree = listing->degree, .order = listing->order, .image = listing->image};
  listing->image = NULL;

  group->product = thr_calloc(order * order, sizeof *group->product);
  group->inverse = thr_calloc(order, sizeof *group->inverse);
  group->power_order = thr_calloc(order, sizeof *group->power_order);
  thr_status st = group->product && group->inverse && group->power_order
                      ? thr_scratch_check(&listing->own, err)
                      : thr_nomem(err);

  /* Numbers in the order of the images. */
  if (!st) st = thr_rows_sort(group->image, group->order, group->degree, listed, err);
  if (!st) {
    for (int a = 0; a < group->order; a++)
      number[listed[a]] = a;
    fill_products(listing, number, listed, group);
    fill_orders(group);
  }
  return st;
}

/* Fails with THR_EINPUT if some generator is no permutation. */
static thr_status check_generators(int degree, const int *generator, int n, thr_err *err)
{
  bool *hit = thr_calloc((size_t)degree, sizeof *hit), good = true;
  if (!hit) return thr_nomem(err);
  for (int number = 0; number < n && good; number++) {
    /* Every image once. */
    memset(hit, 0, (size_t)degree * sizeof *hit);
    for (int point = 0; point < degree && good; point++) {
      int image = generator[(size_t)number * (size_t)degree + (size_t)point];
      good = image >= 0 && image < degree && !hit[image];
      if (good) hit[image] = true;
    }

    if (!good)
      thr_fail(err, THR_EINPUT, "generator %d is not a permutation of %d points", number, degree);
  }

  free(hit);
  return good ? THR_OK : THR_EINPUT;
}

thr_status thr_group_generate(int degree, const int *generator, int n_generators, int cap,
                              thr_group *out, thr_err *err)
{
  element_listing listing = {
      .degree = degree, .generator = generator, .n_generators = n_generators};
  thr_group group = {0};
  listing.cap = cap < 1 ? 1 : cap > THR_GROUP_CAP ? THR_GROUP_CAP : cap;

  /* Check, list, and make tables. */
  thr_status st = check_generators(degree, generator, n_generators, err);
  if (!st) st = listing_init(&listing, err);
  if (!st) st = list_elements(&listing, err);
  if (!st) st = make_tables(&listing, &group, err);

  listing_destroy(&listing);
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
