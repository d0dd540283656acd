/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Subgroups of a listed group, and all of them up to conjugacy by extension (Neubueser 1960). */
#include "symmetry/group/group.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS = THR_GROUP_CAP / 64, MOST_GENERATORS = 16 };

/* A set of elements by bits, and how many it has. */
typedef struct {
  uint64_t bit[WORDS];
  int order;
} set;

static bool has(const set *s, int a)
{
  return s->bit[a / 64] >> a % 64 & 1;
}

static void add(set *s, int a)
{
  s->bit[a / 64] |= UINT64_C(1) << a % 64;
  s->order++;
}

static bool same(const set *a, const set *b)
{
  return memcmp(a->bit, b->bit, sizeof a->bit) == 0;
}

static int product(const thr_group *group, int a, int b)
{
  return group->product[(size_t)a * (size_t)group->order + (size_t)b];
}

/* Adds everything that the generators make. s holds the identity alone or, with the last generator
 * left out of the list, a group that the others generate: then only cosets of it are added. O(order
 * of the result * generators). */
static void close_set(const thr_group *group, set *s, const int *generator, int n)
{
  int member[THR_GROUP_CAP], count = 0, core[THR_GROUP_CAP], n_core = 0;
  for (int a = 0; a < group->order; a++)
    if (has(s, a)) core[n_core++] = a;
  member[count++] = 0; /* one of each coset of the core */
  for (int i = 0; i < count; i++)
    for (int k = 0; k < n; k++) {
      int a = product(group, generator[k], member[i]);
      if (has(s, a)) continue;
      member[count++] = a;
      for (int j = 0; j < n_core; j++)
        add(s, product(group, a, core[j]));
    }
}

static set trivial(void)
{
  set s = {{0}, 0};
  add(&s, 0);
  return s;
}

static thr_status copy_elements(const thr_group *group, const set *s, thr_subgroup *out,
                                thr_err *err)
{
  int n = 0;
  *out = (thr_subgroup){.order = s->order, .element = thr_calloc((size_t)s->order, sizeof(int))};
  if (!out->element) {
    *out = (thr_subgroup){0};
    return thr_nomem(err);
  }
  for (int a = 0; a < group->order; a++)
    if (has(s, a)) out->element[n++] = a;
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
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (subgroup->element[middle] < element)
      low = middle + 1;
    else
      high = middle;
  }
  return low < subgroup->order && subgroup->element[low] == element;
}

/* Each generator at least doubles the order, so that ten reach the cap. */
static int few_generators(const thr_group *group, const int *element, int n,
                          int generator[MOST_GENERATORS])
{
  set made = trivial();
  int count = 0;
  for (int i = 0; i < n && made.order < n; i++) {
    if (has(&made, element[i])) continue;
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

/* Every subgroup met so far: the conjugates of each class, found again by their hash. */
typedef struct {
  const thr_group *g;
  set *all; /* [n] those of a class stand together */
  int n, capacity;
  int *slot; /* [slots] subgroup or -1 */
  int slots; /* power of two, more than 2 * n */
  struct class_of {
    int conjugates;
    set least; /* of them */
  } * class;
  int n_classes, classes_capacity, most;
} atlas;

static unsigned hash_of(const set *s)
{
  uint64_t h = 0;
  for (int i = 0; i < WORDS; i++) {
    h = (h ^ s->bit[i]) * UINT64_C(0x9e3779b97f4a7c15);
    h ^= h >> 29;
  }
  return (unsigned)(h >> 8);
}

static int find_slot(const atlas *t, const set *s)
{
  unsigned mask = (unsigned)t->slots - 1, i = hash_of(s) & mask;
  while (t->slot[i] >= 0 && !same(&t->all[t->slot[i]], s))
    i = (i + 1) & mask;
  return (int)i;
}

static thr_status grow_slots(atlas *t, thr_err *err)
{
  if (t->n < t->slots / 2) return THR_OK;
  int slots = t->slots ? 2 * t->slots : 256;
  int *slot = thr_realloc(t->slot, (size_t)slots, sizeof *slot);
  if (!slot) return thr_nomem(err);
  t->slot = slot;
  t->slots = slots;
  memset(slot, -1, (size_t)slots * sizeof *slot);
  for (int i = 0; i < t->n; i++)
    t->slot[find_slot(t, &t->all[i])] = i;
  return THR_OK;
}

static thr_status add_if_new(atlas *t, const set *s, thr_err *err)
{
  thr_status st = grow_slots(t, err);
  if (st) return st;
  int i = find_slot(t, s);
  if (t->slot[i] >= 0) return THR_OK;
  if ((st = thr_grow(&t->all, t->n, &t->capacity, sizeof *t->all, err))) return st;
  t->slot[i] = t->n;
  t->all[t->n++] = *s;
  return THR_OK;
}

/* The elements b * a * b^-1 of s. */
static set conjugate(const thr_group *group, const set *s, int b)
{
  set c = {{0}, 0};
  for (int a = 0; a < group->order; a++)
    if (has(s, a)) add(&c, product(group, product(group, b, a), group->inverse[b]));
  return c;
}

/* Does a stand before b: by descending order, then by ascending elements? */
static int compare(const set *a, const set *b)
{
  if (a->order != b->order) return a->order > b->order ? -1 : 1;
  for (int i = 0; i < WORDS; i++) {
    uint64_t differ = a->bit[i] ^ b->bit[i];
    if (differ)
      return a->bit[i] & (differ & -differ) ? -1
                                            : 1; /* has the lowest element in which they differ */
  }
  return 0;
}

/* s is new: its class. Stops at the cap without an error. */
static thr_status add_class(atlas *t, const set *s, bool *complete, thr_err *err)
{
  if (t->n_classes >= t->most) {
    *complete = false;
    return THR_OK;
  }
  thr_status st = thr_grow(&t->class, t->n_classes, &t->classes_capacity, sizeof *t->class, err);
  struct class_of c = {0, *s};
  int first = t->n;
  for (int b = 0; b < t->g->order && !st; b++) {
    set image = conjugate(t->g, s, b);
    st = add_if_new(t, &image, err);
  }
  if (st) return st;
  for (int i = first; i < t->n; i++)
    if (compare(&t->all[i], &c.least) < 0) c.least = t->all[i];
  c.conjugates = t->n - first;
  t->class[t->n_classes++] = c;
  return THR_OK;
}

/* The groups that the least of class k and one more element generate. */
static thr_status extend(atlas *t, int k, bool *complete, thr_err *err)
{
  const thr_group *group = t->g;
  set from = t->class[k].least, tried = from;
  int element[THR_GROUP_CAP] = {0}, generator[MOST_GENERATORS], n = 0;
  for (int a = 0; a < group->order; a++)
    if (has(&from, a)) element[n++] = a;
  int count = few_generators(group, element, n, generator);
  assert(count < MOST_GENERATORS);
  for (int a = 0; a < group->order; a++) {
    if (has(&tried, a)) continue;
    for (int i = 0; i < n; i++) /* the whole coset generates the same */
      add(&tried, product(group, a, element[i]));
    set made = from;
    generator[count] = a;
    close_set(group, &made, generator, count + 1);
    if (t->slot[find_slot(t, &made)] >= 0) continue;
    thr_status st = add_class(t, &made, complete, err);
    if (st || !*complete) return st;
  }
  return THR_OK;
}

static int by_least(const void *a, const void *b)
{
  const struct class_of *p = a, *q = b;
  return compare(&p->least, &q->least);
}

static thr_status hand_over(atlas *t, thr_subgroup_classes *out, thr_err *err)
{
  thr_status st = THR_OK;
  qsort(t->class, (size_t)t->n_classes, sizeof *t->class, by_least);
  out->subgroup = thr_calloc((size_t)t->n_classes, sizeof *out->subgroup);
  out->conjugates = thr_calloc((size_t)t->n_classes, sizeof *out->conjugates);
  if (!out->subgroup || !out->conjugates) return thr_nomem(err);
  for (int k = 0; k < t->n_classes && !st; k++, out->n++) {
    out->conjugates[k] = t->class[k].conjugates;
    st = copy_elements(t->g, &t->class[k].least, &out->subgroup[k], err);
  }
  return st;
}

thr_status thr_subgroup_classes_find(const thr_group *group, int most, thr_subgroup_classes *out,
                                     thr_err *err)
{
  atlas t = {.g = group, .most = most < 1 ? 1 : most};
  thr_subgroup_classes classes = {.complete = true};
  set least = trivial(), whole = {{0}, 0};
  for (int a = 0; a < group->order; a++)
    add(&whole, a);
  thr_status st = add_class(&t, &whole, &classes.complete, err);
  if (!st && group->order > 1) st = add_class(&t, &least, &classes.complete, err);
  for (int k = 1; k < t.n_classes && classes.complete && !st; k++)
    st = extend(&t, k, &classes.complete, err);
  if (!st) st = hand_over(&t, &classes, err);
  free(t.all);
  free(t.slot);
  free(t.class);
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
