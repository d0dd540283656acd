/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker's part for the group of a symmetric plan: that it is one of automorphisms, with the
 * order and the name stated. */
#include "graph/check/check_parts.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_ELEMENTS = 1024 };

/* ---- single permutations ---- */

/* Is the row a permutation that keeps edges, feet and where cords may end? hit: [n_nodes] all
 * false, and again after it. */
static thr_status check_automorphism(const thr_plan *plan, const int *image, const char *what,
                                     int number, bool *hit, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  const thr_request *options = &plan->options;
  bool bijective = true;
  for (int v = 0; v < frame->n_nodes && bijective; v++) {
    bijective = image[v] >= 0 && image[v] < frame->n_nodes && !hit[image[v]];
    if (bijective) hit[image[v]] = true;
  }
  for (int v = 0; v < frame->n_nodes; v++)
    hit[v] = false;
  if (!bijective)
    return thr_fail(err, THR_EVIOLATED, "symmetry.%s[%d]: not a permutation of the nodes", what,
                    number);
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
  for (int e = 0; e < frame->n_edges; e++) {
    int a = image[frame->edge[e][0]], b = image[frame->edge[e][1]];
    if (thr_frame_edge_between(frame, a, b) < 0)
      return thr_fail(err, THR_EVIOLATED,
                      "symmetry.%s[%d]: takes edge %d to nodes %d and %d, which no edge joins",
                      what, number, e, a, b);
  }
  return THR_OK;
}

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

static const int *element(const elements *g, int i)
{
  return g->image + (size_t)i * (size_t)g->n;
}

/* Place of an element's number, which is -1 if it is new. */
static int *find(elements *g, const int *image)
{
  uint32_t hash = 2166136261u;
  for (int v = 0; v < g->n; v++)
    hash = (hash ^ (uint32_t)image[v]) * 16777619u;
  uint32_t i = (hash ^ hash >> 15) % (4 * MOST_ELEMENTS);
  while (g->slot[i] >= 0 &&
         memcmp(element(g, g->slot[i]), image, (size_t)g->n * sizeof *image) != 0)
    i = (i + 1) % (4 * MOST_ELEMENTS);
  return &g->slot[i];
}

/* Room for one more element than there are, but no more than needed in the end. */
static thr_status make_room(elements *g, int most, thr_err *err)
{
  if (g->order < g->capacity) return THR_OK;
  int wanted = 2 * g->capacity + 1 < most ? 2 * g->capacity + 1 : most;
  int *image = thr_realloc(g->image, (size_t)wanted * (size_t)g->n, sizeof *image);
  if (!image) return thr_nomem(err);
  g->image = image;
  g->capacity = wanted;
  return THR_OK;
}

/* All products of the generators, one more than the stated order at most. */
static thr_status list_elements(elements *g, const thr_symmetry_record *record, int n_nodes,
                                thr_err *err)
{
  g->n = n_nodes;
  memset(g->slot, -1, sizeof g->slot);
  thr_status st = make_room(g, record->order + 1, err);
  if (st) return st;
  for (int v = 0; v < n_nodes; v++)
    g->image[v] = v;
  *find(g, g->image) = g->order++;
  for (int i = 0; i < g->order; i++)
    for (int k = 0; k < record->n_generators; k++) {
      if ((st = make_room(g, record->order + 1, err))) return st;
      int *last = g->image + (size_t)g->order * (size_t)n_nodes;
      for (int v = 0; v < n_nodes; v++)
        last[v] = element(g, i)[record->generator[(size_t)k * (size_t)n_nodes + (size_t)v]];
      int *number = find(g, last);
      if (*number < 0) *number = g->order++;
      if (g->order > record->order)
        return thr_fail(err, THR_EVIOLATED,
                        "symmetry.order: stated %d, but the generators make more elements",
                        record->order);
    }
  if (g->order < record->order)
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.order: stated %d, but the generators make only %d elements",
                    record->order, g->order);
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

/* Least k > 0 such that the k-th power of a permutation that is an element of the group is the
 * identity. */
static int order_of_element(const int *image, int n)
{
  int order = 1;
  for (int v = 0; v < n; v++) {
    int length = 1, w = image[v], multiple = order;
    for (; w > v; w = image[w])
      length++;
    if (w < v) continue; /* counted at its lowest node */
    while (multiple % length)
      multiple += order;
    order = multiple;
  }
  return order;
}

/* Turns by parts of 1 / n; the same with half turns or mirrors that reverse them; and either with
 * an element of order 2 that commutes with all. */
static census cyclic(int n)
{
  return (census){n, n, n, n % 2 == 0, 0, 0, false};
}

static census dihedral(int n)
{
  return (census){2 * n, n > 1 ? n : 2, n > 1 ? n : 2, n + (n % 2 == 0), 0, 0, false};
}

static census doubled(census c)
{
  return (census){
      2 * c.order, c.longest % 2 ? 2 * c.longest : c.longest, c.turn, 2 * c.involutions + 1, 0, 0,
      false};
}

/* With as many mirrors, rotoreflections and inversions as rotations. */
static census mirrored(census c, int turn, bool inversion)
{
  c.turn = turn;
  c.improper = c.order / 2;
  c.inversions = inversion;
  return c;
}

static census census_of_axis(char letter, int n, const char *end)
{
  const census none = {0};
  bool plain = !*end, even = n % 2 == 0;
  char more = !plain && !end[1] ? *end : '\0';
  if (letter == 'S') return plain && even ? mirrored(cyclic(n), n / 2, n % 4 == 2) : none;
  if (letter == 'C' && plain) return cyclic(n);
  if (letter == 'D' && plain) return dihedral(n);
  if (letter == 'C' && more == 'v') return mirrored(dihedral(n), n, false);
  if (letter == 'C' && more == 'h') return mirrored(doubled(cyclic(n)), n, even);
  if (letter == 'D' && more == 'h') return mirrored(doubled(dihedral(n)), dihedral(n).turn, even);
  return letter == 'D' && more == 'd' ? mirrored(dihedral(2 * n), dihedral(n).turn, !even) : none;
}

/* Of the point group of that Schoenflies name; order 0 if there is none. */
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
  char *end;
  bool number = name[0] && name[1] >= '1' && name[1] <= '9';
  long n = number ? strtol(name + 1, &end, 10) : 0;
  return n >= 1 && n <= MOST_ELEMENTS ? census_of_axis(name[0], (int)n, end) : none;
}

/* Of the group, its elements being motions of the framework. A name, and the option to keep to
 * isometries, say that they are. */
static thr_status take_census(const elements *g, const thr_plan *plan, census *c, thr_err *err)
{
  double within = plan->options.symmetry.geometric;
  *c = (census){.order = g->order};
  for (int i = 0; i < g->order; i++) {
    int order = order_of_element(element(g, i), g->n);
    thr_motion motion;
    thr_procrustes(&plan->frame, element(g, i), &motion);
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
    if (order > c->longest) c->longest = order;
    if (motion.proper && order > c->turn) c->turn = order;
    c->involutions += order == 2;
    c->improper += !motion.proper;
    c->flat |= motion.flat;
    c->inversions += order == 2 && motion.q[0][0] + motion.q[1][1] + motion.q[2][2] < -2;
  }
  return THR_OK;
}

static thr_status check_name(const elements *g, const thr_plan *plan, thr_err *err)
{
  const char *name = plan->symmetry.name;
  census stated = census_of_name(name), found;
  thr_status st = take_census(g, plan, &found, err);
  if (st || !*name) return st;
  if (stated.order != found.order)
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.name: \"%s\" is not the name of a point group of order %d", name,
                    found.order);
  if (stated.longest != found.longest || stated.involutions != found.involutions)
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.name: \"%s\" has %d elements of order 2 and one of order %d; the "
                    "group has %d, and one of order %d",
                    name, stated.involutions, stated.longest, found.involutions, found.longest);
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

/* A group that was asked for by name is the plan's; a row's number says nothing that could be
 * verified. */
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

static thr_status check_record(elements *g, const thr_plan *plan, thr_err *err)
{
  const thr_symmetry_record *record = &plan->symmetry;
  if (record->order < 1 || record->order > MOST_ELEMENTS)
    return thr_fail(err, THR_EVIOLATED, "symmetry.order: %d; expected 1 to %d", record->order,
                    MOST_ELEMENTS);
  thr_status st =
      check_automorphisms(plan, record->generator, record->n_generators, "generators", err);
  if (!st) st = check_automorphisms(plan, record->image, record->n_images, "images", err);
  if (!st) st = list_elements(g, record, plan->frame.n_nodes, err);
  for (int i = 0; i < record->n_images && !st; i++) {
    int number = *find(g, record->image + (size_t)i * (size_t)g->n);
    if (number < 0)
      st = thr_fail(err, THR_EVIOLATED, "symmetry.images[%d]: not an element of the group", i);
    if (i == 0 && number > 0)
      st = thr_fail(err, THR_EVIOLATED, "symmetry.images[0]: not the identity");
  }
  if (!st) st = check_name(g, plan, err);
  if (!st) st = check_asked(plan, err);
  return st;
}

thr_status thr_check_group(const thr_plan *plan, thr_check_elements *out, thr_err *err)
{
  elements *g = thr_calloc(1, sizeof *g);
  *out = (thr_check_elements){0};
  if (!g) return thr_nomem(err);
  thr_status st = check_record(g, plan, err);
  if (!st)
    *out = (thr_check_elements){g->n, g->order, g->image};
  else
    free(g->image);
  free(g);
  return st;
}
