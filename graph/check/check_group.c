/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks the group of a symmetric plan: automorphisms, with the order and the name that are stated.
 *
 * Generators and images must be permutations of the nodes that keep edges, feet and cord ends. All
 * products of the generators are listed in a hash table and counted. A Schoenflies name is checked
 * by a census of the elements: their orders, and how many mirror, invert or have order 2.
 * Isometries are fitted to the permutations (Procrustes) to tell rotations from mirrors.
 *
 * Example: "D3h" has 12 elements: longest order 6, turns of order 3, 7 of order 2, 6 that mirror.
 */
#include "graph/check/check_parts.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_ELEMENTS = 1024 };

/* ---- single permutations ---- */

/* Checks that a row is a permutation which keeps edges, feet and the nodes where cords may end.
 * hit: [n_nodes] all false before and after. */
static thr_status check_automorphism(const thr_plan *plan, const int *image, const char *what,
                                     int number, bool *hit, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *options = &plan->options;
  bool bijective = true;

  /* Every node is hit once. */
  for (int v = 0; v < frame->n_nodes && bijective; v++) {
    bijective = image[v] >= 0 && image[v] < frame->n_nodes && !hit[image[v]];
    if (bijective) hit[image[v]] = true;
  }
  for (int v = 0; v < frame->n_nodes; v++)
    hit[v] = false;

  if (!bijective)
    return thr_fail(err, THR_EVIOLATED, "symmetry.%s[%d]: not a permutation of the nodes", what,
                    number);

  /* What nodes are stays. */
  for (int v = 0; v < frame->n_nodes; v++) {
    if (frame->foot[v] != frame->foot[image[v]])
      return thr_fail(err, THR_EVIOLATED,
                      "symmetry.%s[%d]: takes node %d to %d, but only one of them is a foot", what,
                      number, v, image[v]);

    if (thr_plan_end_allowed(frame, options, v) != thr_plan_end_allowed(frame, options, image[v]))
      return thr_fail(
          err, THR_EVIOLATED,
          "symmetry.%s[%d]: takes node %d to %d, but a cord may end at only one of them", what,
          number, v, image[v]);
  }

  /* Edges map to edges. */
  for (int e = 0; e < frame->n_edges; e++) {
    int a = image[frame->edge[e][0]], b = image[frame->edge[e][1]];
    if (thr_frame_edge_between(frame, a, b) < 0)
      return thr_fail(err, THR_EVIOLATED,
                      "symmetry.%s[%d]: takes edge %d to nodes %d and %d, which no edge joins",
                      what, number, e, a, b);
  }
  return THR_OK;
}

/* Checks n rows of images of the nodes. */
static thr_status check_automorphisms(const thr_plan *plan, const int *image, int n,
                                      const char *what, thr_err *err)
{
  size_t n_nodes = (size_t)plan->frame.n_nodes;
  bool *hit = thr_calloc(n_nodes, sizeof *hit);
  thr_status st = hit ? THR_OK : thr_nomem(err);

  for (int i = 0; i < n && !st; i++)
    st = check_automorphism(plan, image + (size_t)i * n_nodes, what, i, hit, err);

  free(hit);
  return st;
}

/* ---- the group ---- */

/* Its elements as they are found, the identity first, and a table to find them again. */
typedef struct {
  int n, order, capacity; /* nodes; elements */
  int *image;             /* [capacity * n] */
  int slot[4 * MOST_ELEMENTS];
} elements;

static const int *element(const elements *group, int i)
{
  return group->image + (size_t)i * (size_t)group->n;
}

/* Returns the slot of an element's number in the hash table (FNV-1a), which holds -1 if the element
 * is new. */
static int *find(elements *group, const int *image)
{
  uint32_t hash = 2166136261u;
  for (int v = 0; v < group->n; v++)
    hash = (hash ^ (uint32_t)image[v]) * 16777619u;

  /* Linear probing; the table is at most a quarter full. */
  uint32_t i = (hash ^ hash >> 15) % (4 * MOST_ELEMENTS);
  while (group->slot[i] >= 0 &&
         memcmp(element(group, group->slot[i]), image, (size_t)group->n * sizeof *image) != 0)
    i = (i + 1) % (4 * MOST_ELEMENTS);
  return &group->slot[i];
}

/* Allocates one more element for the list if it is full, but no more than `most` in all. */
static thr_status grow_list(elements *group, int most, thr_err *err)
{
  if (group->order < group->capacity) return THR_OK;

  /* Double the list. */
  int wanted = 2 * group->capacity + 1 < most ? 2 * group->capacity + 1 : most;

  int *image = thr_realloc(group->image, (size_t)wanted * (size_t)group->n, sizeof *image);
  if (!image) return thr_nomem(err);
  group->image = image;
  group->capacity = wanted;
  return THR_OK;
}

/* Lists all products of the generators, and checks their number; at most one more than the stated
 * order. */
static thr_status list_elements(elements *group, const thr_symmetry_record *record, int n_nodes,
                                thr_err *err)
{
  group->n = n_nodes;
  memset(group->slot, -1, sizeof group->slot);
  thr_status st = grow_list(group, record->order + 1, err);
  if (st) return st;

  /* The identity, then every element times every generator until nothing is new. */
  for (int v = 0; v < n_nodes; v++)
    group->image[v] = v;
  *find(group, group->image) = group->order++;

  for (int i = 0; i < group->order; i++)
    for (int k = 0; k < record->n_generators; k++) {
      if ((st = grow_list(group, record->order + 1, err))) return st;

      /* The product is written behind the list, and stays there if it is new. */
      int *last = group->image + (size_t)group->order * (size_t)n_nodes;
      for (int v = 0; v < n_nodes; v++)
        last[v] = element(group, i)[record->generator[(size_t)k * (size_t)n_nodes + (size_t)v]];

      /* A product that was found before is overwritten by the next one. */
      int *number = find(group, last);
      if (*number < 0) *number = group->order++;

      /* Stop one beyond the stated order. */
      if (group->order > record->order)
        return thr_fail(err, THR_EVIOLATED,
                        "symmetry.order: stated %d, but the generators make more elements",
                        record->order);
    }

  if (group->order < record->order)
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.order: stated %d, but the generators make only %d elements",
                    record->order, group->order);
  return THR_OK;
}

/* What all point groups of one name have in common. */
typedef struct {
  int order;
  int longest;     /* order of the element of greatest order */
  int turn;        /* the same of those that do not mirror */
  int involutions; /* elements of order 2 */
  int improper;    /* elements that mirror */
  int inversions;  /* 1 if the inversion is an element */
  bool flat;       /* of a group found: whether its elements mirror is open */
} census;

/* Returns the least k > 0 such that the k-th power of a permutation is the identity: the least
 * common multiple of its cycles. */
static int order_of_element(const int *image, int n)
{
  int order = 1;
  for (int v = 0; v < n; v++) {
    int length = 1, w = image[v], multiple = order;

    /* Follow the cycle of v as long as v is its lowest node. */
    for (; w > v; w = image[w])
      length++;

    if (w < v) continue; /* counted at its lowest node */

    while (multiple % length)
      multiple += order;
    order = multiple;
  }
  return order;
}

/* Returns the census of a cyclic group of n elements. */
static census cyclic(int n)
{
  return (census){n, n, n, n % 2 == 0, 0, 0, false};
}

/* Returns the census of a dihedral group of 2 n elements: half turns or mirrors reverse the cyclic
 * ones. */
static census dihedral(int n)
{
  return (census){2 * n, n > 1 ? n : 2, n > 1 ? n : 2, n + (n % 2 == 0), 0, 0, false};
}

/* Returns the census of the product of a group with one of two elements that commutes with it. */
static census doubled(census c)
{
  return (census){
      2 * c.order, c.longest % 2 ? 2 * c.longest : c.longest, c.turn, 2 * c.involutions + 1, 0, 0,
      false};
}

/* Returns a census with as many mirrors, rotoreflections and inversions as rotations. */
static census mirrored(census c, int turn, bool inversion)
{
  c.turn = turn;
  c.improper = c.order / 2;
  c.inversions = inversion;
  return c;
}

/* Returns the census of a group with a main axis: S, C or D with n and a suffix; order 0 if there
 * is none. */
static census census_of_axis(char letter, int n, const char *end)
{
  const census none = {0};
  bool plain = !*end, even = n % 2 == 0;
  char more = !plain && !end[1] ? *end : '\0';

  /* Sn is cyclic and its turns have half the order. */
  if (letter == 'S') return plain && even ? mirrored(cyclic(n), n / 2, n % 4 == 2) : none;

  /* Cn, Dn; Cnv as Dn with mirrors; the product with a horizontal mirror; Dnd has rotoreflections
   * of order 2 n. */
  if (letter == 'C' && plain) return cyclic(n);
  if (letter == 'D' && plain) return dihedral(n);
  if (letter == 'C' && more == 'v') return mirrored(dihedral(n), n, false);
  if (letter == 'C' && more == 'h') return mirrored(doubled(cyclic(n)), n, even);
  if (letter == 'D' && more == 'h') return mirrored(doubled(dihedral(n)), dihedral(n).turn, even);
  return letter == 'D' && more == 'd' ? mirrored(dihedral(2 * n), dihedral(n).turn, !even) : none;
}

/* Returns the census of the point group of a Schoenflies name; order 0 if there is none. */
static census census_of_name(const char *name)
{
  static const struct {
    const char *name;
    census census;
  } single[] = {{"Cs", {2, 2, 1, 1, 1, 0, false}},     {"Ci", {2, 2, 1, 1, 1, 1, false}},
                {"T", {12, 3, 3, 3, 0, 0, false}},     {"Td", {24, 4, 3, 9, 12, 0, false}},
                {"Th", {24, 6, 3, 7, 12, 1, false}},   {"O", {24, 4, 4, 9, 0, 0, false}},
                {"Oh", {48, 6, 4, 19, 24, 1, false}},  {"I", {60, 5, 5, 15, 0, 0, false}},
                {"Ih", {120, 10, 5, 31, 60, 1, false}}};

  const census none = {0};
  for (size_t i = 0; i < sizeof single / sizeof *single; i++)
    if (strcmp(name, single[i].name) == 0) return single[i].census;

  /* A letter, a number and a suffix. */
  char *end;
  bool number = name[0] && name[1] >= '1' && name[1] <= '9';
  long n = number ? strtol(name + 1, &end, 10) : 0;
  return n >= 1 && n <= MOST_ELEMENTS ? census_of_axis(name[0], (int)n, end) : none;
}

/* Computes the census of the group from the motions that fit its elements. A name, and the option
 * to keep to isometries, claim that all elements are isometries. */
static thr_status take_census(const elements *group, const thr_plan *plan, census *found,
                              thr_err *err)
{
  double within = plan->options.symmetry.geometric;
  *found = (census){.order = group->order};

  for (int i = 0; i < group->order; i++) {
    int order = order_of_element(element(group, i), group->n);
    thr_motion motion;
    thr_procrustes(&plan->frame, element(group, i), &motion);

    /* Isometries leave a residual of rounding only. */
    if (*plan->symmetry.name && motion.residual > THR_ISOMETRY_NEAR + THR_ISOMETRY_ROUNDING)
      return thr_fail(err, THR_EVIOLATED,
                      "symmetry.name: \"%s\", but an element of order %d is no isometry: it moves "
                      "the nodes past their images by "
                      "%.3g of the framework's size",
                      plan->symmetry.name, order, motion.residual);

    if (within >= 0 && motion.farthest > within + 2 * THR_ISOMETRY_ROUNDING)
      return thr_fail(err, THR_EVIOLATED,
                      "options.symmetry.geometric: isometries within %.12g, but an element of "
                      "order %d moves a node past its image "
                      "by %.12g of the framework's size",
                      within, order, motion.farthest);

    if (order > found->longest) found->longest = order;
    if (motion.proper && order > found->turn) found->turn = order;

    /* The inversion is the element of order 2 with trace -3. */
    found->involutions += order == 2;
    found->improper += !motion.proper;
    found->flat |= motion.flat;
    found->inversions += order == 2 && motion.q[0][0] + motion.q[1][1] + motion.q[2][2] < -2;
  }
  return THR_OK;
}

/* Checks that the group has the census of its name. */
static thr_status check_name(const elements *group, const thr_plan *plan, thr_err *err)
{
  const char *name = plan->symmetry.name;
  census stated = census_of_name(name), found;
  thr_status st = take_census(group, plan, &found, err);
  if (st || !*name) return st;

  if (stated.order != found.order)
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.name: \"%s\" is not the name of a point group of order %d", name,
                    found.order);

  /* Orders do not depend on the embedding. */
  if (stated.longest != found.longest || stated.involutions != found.involutions)
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.name: \"%s\" has %d elements of order 2 and one of order %d; the "
                    "group has %d, and one of order %d",
                    name, stated.involutions, stated.longest, found.involutions, found.longest);

  /* In a plane, mirrors cannot be told from half turns. */
  if (!found.flat && (stated.improper != found.improper || stated.inversions != found.inversions ||
                      stated.turn != found.turn))
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.name: \"%s\" has %d elements that mirror, %s inversion, and turns of "
                    "order %d; the group has %d, %s "
                    "inversion, and of order %d",
                    name, stated.improper, stated.inversions ? "with the" : "no", stated.turn,
                    found.improper, found.inversions ? "with the" : "no", found.turn);
  return THR_OK;
}

/* Checks that a group which was asked for by name is the plan's; the number of a row of the list
 * says nothing that could be verified. */
static thr_status check_asked(const thr_plan *plan, thr_err *err)
{
  const char *asked = plan->options.symmetry.group;
  if (!*asked || strspn(asked, "0123456789") == strlen(asked) ||
      strcmp(asked, plan->symmetry.name) == 0)
    return THR_OK;
  return thr_fail(err, THR_EVIOLATED,
                  "options.symmetry.group: \"%s\" was asked for, but the plan's group is \"%s\"",
                  asked, plan->symmetry.name);
}

/* Checks the record of the group: generators, images, order and name. */
static thr_status check_record(elements *group, const thr_plan *plan, thr_err *err)
{
  const thr_symmetry_record *record = &plan->symmetry;
  if (record->order < 1 || record->order > MOST_ELEMENTS)
    return thr_fail(err, THR_EVIOLATED, "symmetry.order: %d; expected 1 to %d", record->order,
                    MOST_ELEMENTS);

  thr_status st =
      check_automorphisms(plan, record->generator, record->n_generators, "generators", err);
  if (!st) st = check_automorphisms(plan, record->image, record->n_images, "images", err);

  if (!st) st = list_elements(group, record, plan->frame.n_nodes, err);

  /* Image 0 is the identity, and every image is an element. */
  for (int i = 0; i < record->n_images && !st; i++) {
    int number = *find(group, record->image + (size_t)i * (size_t)group->n);
    if (number < 0)
      st = thr_fail(err, THR_EVIOLATED, "symmetry.images[%d]: not an element of the group", i);
    if (i == 0 && number > 0)
      st = thr_fail(err, THR_EVIOLATED, "symmetry.images[0]: not the identity");
  }

  if (!st) st = check_name(group, plan, err);
  if (!st) st = check_asked(plan, err);
  return st;
}

thr_status thr_check_group(const thr_plan *plan, thr_check_elements *out, thr_err *err)
{
  elements *group = thr_calloc(1, sizeof *group);
  *out = (thr_check_elements){0};
  if (!group) return thr_nomem(err);

  thr_status st = check_record(group, plan, err);
  if (!st)
    *out = (thr_check_elements){group->n, group->order, group->image};
  else
    free(group->image);

  free(group);
  return st;
}
