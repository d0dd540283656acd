/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the subgroups of a listed group up to conjugacy, by extension (J. Neubueser 1960).
 *
 * Every subgroup is reached from the trivial one by adding an element at a time. So the least
 * subgroup of every class is extended by every element, one of each coset; what is generated is
 * looked up by its hash among all conjugates of the subgroups so far, and makes a new class if it
 * is not there.
 *
 * Example: in the symmetric group of three points: the trivial group extended by a transposition
 * makes a class of three conjugates, by a cycle a class of one, and these two extended make the
 * whole. */
#include "symmetry/group/group.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS = THR_GROUP_CAP / 64, MOST_GENERATORS = 16 };

/* A set of elements as bits, and their number. */
typedef struct {
  uint64_t bit[WORDS];
  int order;
} element_set;

static bool has_element(const element_set *set, int a)
{
  return set->bit[a / 64] >> a % 64 & 1;
}

static void add_element(element_set *set, int a)
{
  set->bit[a / 64] |= UINT64_C(1) << a % 64;
  set->order++;
}

static bool is_same(const element_set *a, const element_set *b)
{
  return memcmp(a->bit, b->bit, sizeof a->bit) == 0;
}

/* Adds to a set everything that the generators generate. The set holds the identity alone, or a
 * group that all generators but the last one generate: then whole cosets of that are added. O(order
 * of the result * generators). */
static void close_set(const thr_group *group, element_set *set, const int *generator, int n)
{
  int member[THR_GROUP_CAP], count = 0, core[THR_GROUP_CAP], n_core = 0;
  for (int element = 0; element < group->order; element++)
    if (has_element(set, element)) core[n_core++] = element;

  /* Multiply one member of each coset of the core by every generator. */
  member[count++] = 0;
  for (int i = 0; i < count; i++)
    for (int k = 0; k < n; k++) {
      int element = thr_group_product(group, generator[k], member[i]);
      if (has_element(set, element)) continue;

      /* A new coset. */
      member[count++] = element;
      for (int j = 0; j < n_core; j++)
        add_element(set, thr_group_product(group, element, core[j]));
    }
}

/* Returns the set of the identity. */
static element_set trivial(void)
{
  element_set set = {{0}, 0};
  add_element(&set, 0);
  return set;
}

/* Copies the elements of a set, ascending, to a subgroup. */
static thr_status copy_elements(const thr_group *group, const element_set *set, thr_subgroup *out,
                                thr_err *err)
{
  int n_elements = 0;
  *out =
      (thr_subgroup){.order = set->order, .element = thr_calloc((size_t)set->order, sizeof(int))};
  if (!out->element) {
    *out = (thr_subgroup){0};
    return thr_nomem(err);
  }

  /* Ascending. */
  for (int element = 0; element < group->order; element++)
    if (has_element(set, element)) out->element[n_elements++] = element;
  return THR_OK;
}

void thr_subgroup_destroy(thr_subgroup *subgroup)
{
  free(subgroup->element);
  *subgroup = (thr_subgroup){0};
}

bool thr_subgroup_has(const thr_subgroup *subgroup, int element)
{
  int low = 0, high = subgroup->order;
  /* Bisection. */
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (subgroup->element[middle] < element)
      low = middle + 1;
    else
      high = middle;
  }
  return low < subgroup->order && subgroup->element[low] == element;
}

/* Chooses generators of a group greedily: elements that the ones before do not generate. Each at
 * least doubles the order, so that ten reach the cap. */
static int few_generators(const thr_group *group, const int *element, int n,
                          int generator[MOST_GENERATORS])
{
  element_set made = trivial();
  int count = 0;
  for (int i = 0; i < n && made.order < n; i++) {
    /* Only elements that are not made yet. */
    if (has_element(&made, element[i])) continue;
    generator[count++] = element[i];
    close_set(group, &made, generator, count);
  }
  return count;
}

int thr_subgroup_generators(const thr_group *group, const thr_subgroup *subgroup, int generator[16])
{
  return few_generators(group, subgroup->element, subgroup->order, generator);
}

/* ---- classes ---- */

/* All subgroups so far: the conjugates of each class, found again by their hash. */
typedef struct {
  const thr_group *group;
  element_set *all; /* [n] those of a class stand together */
  int n, capacity;
  int *slot; /* [slots] subgroup or -1 */
  int slots; /* power of two, more than 2 * n */
  struct subgroup_class {
    int conjugates;
    element_set least; /* of them */
  } * class;
  int n_classes, classes_capacity, most;
} subgroup_atlas;

/* Returns the hash of a set. */
static unsigned hash_of(const element_set *set)
{
  uint64_t hash = 0;
  for (int i = 0; i < WORDS; i++) {
    hash = (hash ^ set->bit[i]) * UINT64_C(0x9e3779b97f4a7c15);
    hash ^= hash >> 29;
  }
  return (unsigned)(hash >> 8);
}

/* Returns the slot of a set, an empty one if the set is new. */
static int find_slot(const subgroup_atlas *atlas, const element_set *set)
{
  unsigned mask = (unsigned)atlas->slots - 1, i = hash_of(set) & mask;
  while (atlas->slot[i] >= 0 && !is_same(&atlas->all[atlas->slot[i]], set))
    i = (i + 1) & mask;
  return (int)i;
}

/* Grows the table of slots when it is half full, and enters all subgroups again. */
static thr_status grow_slots(subgroup_atlas *atlas, thr_err *err)
{
  if (atlas->n < atlas->slots / 2) return THR_OK;
  int slots = atlas->slots ? 2 * atlas->slots : 256;
  int *slot = thr_realloc(atlas->slot, (size_t)slots, sizeof *slot);
  if (!slot) return thr_nomem(err);

  /* All subgroups again, in a table of twice the size. */
  atlas->slot = slot;
  atlas->slots = slots;
  memset(slot, -1, (size_t)slots * sizeof *slot);
  for (int i = 0; i < atlas->n; i++)
    atlas->slot[find_slot(atlas, &atlas->all[i])] = i;
  return THR_OK;
}

/* Adds a set to the table if it is new. */
static thr_status add_if_new(subgroup_atlas *atlas, const element_set *set, thr_err *err)
{
  thr_status st = grow_slots(atlas, err);
  if (st) return st;

  int i = find_slot(atlas, set);
  if (atlas->slot[i] >= 0) return THR_OK;

  if ((st = thr_grow(&atlas->all, atlas->n, &atlas->capacity, sizeof *atlas->all, err))) return st;

  atlas->slot[i] = atlas->n;
  atlas->all[atlas->n++] = *set;
  return THR_OK;
}

/* Returns the set of all b a b^-1, for elements a of the set. */
static element_set conjugate(const thr_group *group, const element_set *set, int b)
{
  element_set conjugates = {{0}, 0};
  for (int a = 0; a < group->order; a++)
    if (has_element(set, a))
      add_element(&conjugates,
                  thr_group_product(group, thr_group_product(group, b, a), group->inverse[b]));
  return conjugates;
}

/* Compares sets by descending order, then by ascending elements. */
static int compare(const element_set *a, const element_set *b)
{
  if (a->order != b->order) return a->order > b->order ? -1 : 1;
  for (int i = 0; i < WORDS; i++) {
    uint64_t differ = a->bit[i] ^ b->bit[i];
    /* The set with the lowest element in which they differ comes first. */
    if (differ) return a->bit[i] & (differ & -differ) ? -1 : 1;
  }
  return 0;
}

/* Adds the class of a new set: all its conjugates, and the least of them. At the cap *complete
 * becomes false, without an error. */
static thr_status add_class(subgroup_atlas *atlas, const element_set *set, bool *complete,
                            thr_err *err)
{
  if (atlas->n_classes >= atlas->most) {
    *complete = false;
    return THR_OK;
  }

  thr_status st = thr_grow(&atlas->class, atlas->n_classes, &atlas->classes_capacity,
                           sizeof *atlas->class, err);
  struct subgroup_class added = {0, *set};
  int first = atlas->n;

  /* All conjugates. */
  for (int b = 0; b < atlas->group->order && !st; b++) {
    element_set image = conjugate(atlas->group, set, b);
    st = add_if_new(atlas, &image, err);
  }
  if (st) return st;

  /* The least one stands for the class. */
  for (int i = first; i < atlas->n; i++)
    if (compare(&atlas->all[i], &added.least) < 0) added.least = atlas->all[i];
  added.conjugates = atlas->n - first;
  atlas->class[atlas->n_classes++] = added;
  return THR_OK;
}

/* Adds the classes of the groups that the least subgroup of class k and one more element generate.
 */
static thr_status extend(subgroup_atlas *atlas, int k, bool *complete, thr_err *err)
{
  const thr_group *group = atlas->group;
  element_set from = atlas->class[k].least, tried = from;
  int element[THR_GROUP_CAP] = {0}, generator[MOST_GENERATORS], n_elements = 0;

  /* The subgroup's elements, and generators of it. */
  for (int a = 0; a < group->order; a++)
    if (has_element(&from, a)) element[n_elements++] = a;
  int count = few_generators(group, element, n_elements, generator);
  assert(count < MOST_GENERATORS);

  for (int extension = 0; extension < group->order; extension++) {
    if (has_element(&tried, extension)) continue;

    /* The whole coset generates the same group. */
    for (int i = 0; i < n_elements; i++)
      add_element(&tried, thr_group_product(group, extension, element[i]));

    /* The extension, unless it is known. */
    element_set made = from;
    generator[count] = extension;
    close_set(group, &made, generator, count + 1);
    if (atlas->slot[find_slot(atlas, &made)] >= 0) continue;
    thr_status st = add_class(atlas, &made, complete, err);
    if (st || !*complete) return st;
  }
  return THR_OK;
}

/* Compares classes by their least subgroups. */
static int by_least(const void *a, const void *b)
{
  const struct subgroup_class *first = a, *second = b;
  return compare(&first->least, &second->least);
}

/* Sorts the classes, and copies the least subgroup of each. */
static thr_status fill_classes(subgroup_atlas *atlas, thr_subgroup_classes *out, thr_err *err)
{
  thr_status st = THR_OK;
  qsort(atlas->class, (size_t)atlas->n_classes, sizeof *atlas->class, by_least);

  /* One subgroup of each class. */
  out->subgroup = thr_calloc((size_t)atlas->n_classes, sizeof *out->subgroup);
  out->conjugates = thr_calloc((size_t)atlas->n_classes, sizeof *out->conjugates);
  if (!out->subgroup || !out->conjugates) return thr_nomem(err);

  for (int k = 0; k < atlas->n_classes && !st; k++, out->n++) {
    out->conjugates[k] = atlas->class[k].conjugates;
    st = copy_elements(atlas->group, &atlas->class[k].least, &out->subgroup[k], err);
  }
  return st;
}

thr_status thr_subgroup_classes_find(const thr_group *group, int most, thr_subgroup_classes *out,
                                     thr_err *err)
{
  subgroup_atlas atlas = {.group = group, .most = most < 1 ? 1 : most};
  thr_subgroup_classes classes = {.complete = true};
  element_set least = trivial(), whole = {{0}, 0};
  /* The whole group and the trivial one are there in any case. */
  for (int a = 0; a < group->order; a++)
    add_element(&whole, a);
  thr_status st = add_class(&atlas, &whole, &classes.complete, err);
  if (!st && group->order > 1) st = add_class(&atlas, &least, &classes.complete, err);

  /* Extend every class, also those that this adds. */
  for (int k = 1; k < atlas.n_classes && classes.complete && !st; k++)
    st = extend(&atlas, k, &classes.complete, err);
  if (!st) st = fill_classes(&atlas, &classes, err);

  free(atlas.all);
  free(atlas.slot);
  free(atlas.class);
  if (st) thr_subgroup_classes_destroy(&classes);
  *out = classes;
  return st;
}

void thr_subgroup_classes_destroy(thr_subgroup_classes *classes)
{
  for (int k = 0; k < classes->n; k++)
    thr_subgroup_destroy(&classes->subgroup[k]);
  free(classes->subgroup);
  free(classes->conjugates);
  *classes = (thr_subgroup_classes){0};
}
