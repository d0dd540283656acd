/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which groups of automorphisms are offered for a framework: all subgroups up to conjugacy where
 * they can be listed, else the isometries and what a few generators make. Internal to symmetry/.
 *
 * Example: of the square's group C4v: C1, C2, C4, two classes of mirrors, two of C2v, and C4v
 * itself.
 *
 * All subgroups where they can be listed, else the isometries and what a few generators make. */
#include "symmetry/group/groups.h"
#include "graph/disjoint.h"
#include "symmetry/group/group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const double thr_symmetry_near = THR_ISOMETRY_NEAR;

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  thr_symmetries *t;
  const thr_limits *limits;
  int capacity; /* rows that the table has room for */
} offer;

static const int *image_of(const thr_symmetries *symmetries, int group, int element)
{
  const thr_group *g = &symmetries->group[group].all;
  return &g->image[(size_t)element * (size_t)g->degree];
}

/* ---- rows ---- */

static void describe(const offer *x, thr_symmetry_row *row, thr_isometry *scratch)
{
  const thr_isometry *iso = x->t->group[row->group].isometry;
  for (int i = 0; i < row->order; i++) {
    scratch[i] = iso[row->elements.element[i]];
    row->kinds[scratch[i].kind]++;
    row->residual = fmax(row->residual, scratch[i].residual);
  }
  thr_point_group_name(scratch, row->order, row->name);
}

/* The same permutations? Elements are numbered by their images in any group. */
static bool same_row(const thr_symmetries *symmetries, const thr_symmetry_row *a,
                     const thr_symmetry_row *b)
{
  if (a->order != b->order) return false;
  for (int i = 0; i < a->order; i++)
    if (memcmp(image_of(symmetries, a->group, a->elements.element[i]),
               image_of(symmetries, b->group, b->elements.element[i]),
               (size_t)symmetries->group[a->group].all.degree * sizeof(int)) != 0)
      return false;
  return true;
}

/* Takes the elements over, on failure too. */
static thr_status add_row(offer *x, int group, thr_subgroup *elements, int conjugates, thr_err *err)
{
  thr_symmetries *symmetries = x->t;
  thr_symmetry_row row = {
      .order = elements->order, .conjugates = conjugates, .group = group, .elements = *elements};
  *elements = (thr_subgroup){0};
  for (int i = 0; i < symmetries->n; i++)
    if (same_row(symmetries, &symmetries->row[i], &row)) {
      thr_subgroup_destroy(&row.elements);
      return THR_OK;
    }
  thr_isometry *scratch = thr_calloc((size_t)row.order, sizeof *scratch);
  thr_status st = scratch ? thr_grow(&symmetries->row, symmetries->n, &x->capacity,
                                     sizeof *symmetries->row, err)
                          : thr_nomem(err);
  if (!st) {
    describe(x, &row, scratch);
    symmetries->row[symmetries->n++] = row;
  } else {
    thr_subgroup_destroy(&row.elements);
  }
  free(scratch);
  return st;
}

/* Takes the group over as one more of the table, on failure too. */
static thr_status add_group(offer *x, thr_group *g, thr_err *err)
{
  thr_symmetries *symmetries = x->t;
  thr_symmetry_group *group = thr_realloc(symmetries->group, (size_t)symmetries->n_groups + 1,
                                          sizeof *group),
                     added = {.all = *g};
  *g = (thr_group){0};
  if (group) symmetries->group = group;
  if (!group || !(added.isometry = thr_calloc((size_t)added.all.order, sizeof *added.isometry))) {
    thr_group_destroy(&added.all);
    return thr_nomem(err);
  }
  symmetries->group[symmetries->n_groups++] = added;
  for (int a = 0; a < added.all.order; a++)
    thr_isometry_of(x->f, image_of(symmetries, symmetries->n_groups - 1, a), thr_symmetry_near,
                    &added.isometry[a]);
  return THR_OK;
}

/* Asked for isometries: are all of these within the tolerance? Products of some that are need not
 * be. */
static bool keeps_shape(const offer *x, int group, const thr_subgroup *subgroup)
{
  double tolerance = x->o->symmetry.geometric;
  for (int i = 0; i < subgroup->order && tolerance >= 0; i++) {
    thr_motion motion;
    thr_procrustes(x->f, image_of(x->t, group, subgroup->element[i]), &motion);
    if (motion.farthest > tolerance + THR_ISOMETRY_ROUNDING) return false;
  }
  return true;
}

/* A row for each class of subgroups of the group that was added last; without `partly` none if
 * there are too many. */
static thr_status add_classes(offer *x, bool partly, bool *complete, thr_err *err)
{
  thr_subgroup_classes classes = {0};
  int group = x->t->n_groups - 1;
  thr_status st =
      thr_subgroup_classes_find(&x->t->group[group].all, THR_SYMMETRY_CLASSES, &classes, err);
  *complete = classes.complete;
  for (int k = 0; k < classes.n && !st && (partly || classes.complete); k++)
    if (keeps_shape(x, group, &classes.subgroup[k]))
      st = add_row(x, group, &classes.subgroup[k], classes.conjugates[k], err);
  thr_subgroup_classes_destroy(&classes);
  return st;
}

/* ---- orbits ---- */

/* generator: [n_generators * n_nodes] images of the nodes. */
static thr_status count_orbits(offer *x, const int *generator, int n_generators, thr_err *err)
{
  const thr_frame *frame = x->f;
  int *node = thr_calloc((size_t)frame->n_nodes, sizeof *node),
      *edge = thr_calloc((size_t)frame->n_edges, sizeof *edge);
  x->t->node_orbits = frame->n_nodes;
  x->t->edge_orbits = frame->n_edges;
  for (int v = 0; node && v < frame->n_nodes; v++)
    node[v] = v;
  for (int e = 0; edge && e < frame->n_edges; e++)
    edge[e] = e;
  for (int g = 0; node && edge && g < n_generators; g++) {
    const int *to = &generator[(size_t)g * (size_t)frame->n_nodes];
    for (int v = 0; v < frame->n_nodes; v++)
      x->t->node_orbits -= thr_disjoint_join(node, v, to[v]);
    for (int e = 0; e < frame->n_edges; e++)
      x->t->edge_orbits -= thr_disjoint_join(
          edge, e, thr_edge_joining(frame, to[frame->edge[e][0]], to[frame->edge[e][1]]));
  }
  thr_status st = node && edge ? THR_OK : thr_nomem(err);
  free(node);
  free(edge);
  return st;
}

/* ---- isometries ---- */

/* Does it keep where cords may end, and what edges need and may have? */
static bool keeps_request(const offer *x, const int *image)
{
  for (int e = 0; e < x->f->n_edges; e++) {
    int to = thr_edge_joining(x->f, image[x->f->edge[e][0]], image[x->f->edge[e][1]]);
    if (thr_plan_cover(x->f, x->o, e) != thr_plan_cover(x->f, x->o, to) ||
        thr_plan_capacity(x->f, x->o, e) != thr_plan_capacity(x->f, x->o, to))
      return false;
  }
  for (int v = 0; x->o->ends == THR_ENDS_NODES && v < x->f->n_nodes; v++)
    if (x->o->end_node[v] != x->o->end_node[image[v]]) return false;
  return true;
}

static bool has_element(const thr_group *group, const int *image)
{
  int low = 0, high = group->order; /* the images ascend */
  while (low < high) {
    int middle = (low + high) / 2, i = 0;
    const int *at = &group->image[(size_t)middle * (size_t)group->degree];
    while (i < group->degree && at[i] == image[i])
      i++;
    if (i == group->degree) return true;
    if (at[i] < image[i])
      low = middle + 1;
    else
      high = middle;
  }
  return false;
}

/* The group that the rows of images generate, each a generator only if the earlier ones do not make
 * it. */
static thr_status generate(const offer *x, const int *image, int count, thr_group *group,
                           thr_err *err)
{
  enum { MOST = 16 }; /* each at least doubles the group: 2^10 is the cap */
  int n = x->f->n_nodes, used = 0,
      *generator = thr_calloc((size_t)MOST * (size_t)n, sizeof *generator);
  *group = (thr_group){0};
  if (!generator) return thr_nomem(err);
  thr_status st = thr_group_generate(n, generator, 0, THR_GROUP_CAP, group, err);
  for (int i = 0; i < count && !st; i++) {
    const int *row = &image[(size_t)i * (size_t)n];
    if (!keeps_request(x, row) || has_element(group, row)) continue;
    memcpy(&generator[(size_t)used++ * (size_t)n], row, (size_t)n * sizeof *row);
    thr_group_destroy(group);
    st = thr_group_generate(n, generator, used, THR_GROUP_CAP, group, err);
  }
  free(generator);
  return st;
}

/* The isometries as one more group of the table; only the identity if they are too many. */
static thr_status add_isometries(offer *x, const thr_automorphism_options *colours,
                                 double tolerance, bool *all, thr_err *err)
{
  thr_err why = {0};
  thr_group group = {0};
  int *image = NULL, count = 0;
  thr_status st =
      thr_isometries_find(x->f, colours, tolerance, THR_GROUP_CAP, x->limits, &image, &count, &why);
  if (!st) st = generate(x, image, count, &group, &why);
  free(image);
  *all = !st;
  if (st == THR_ELIMIT)
    st = generate(x, NULL, 0, &group, err);
  else if (st)
    thr_fail(err, st, "%s", why.text);
  return st ? st : add_group(x, &group, err);
}

/* Those among all automorphisms of a, which are no more than can be listed, as one more group of
 * the table. */
static thr_status add_listed_isometries(offer *x, const thr_automorphisms *a, double tolerance,
                                        thr_err *err)
{
  thr_group listed, g = {0};
  int *image = NULL, count = 0;
  thr_status st =
      thr_group_generate(a->n, a->generator, a->n_generators, THR_GROUP_CAP, &listed, err);
  if (!st)
    st = thr_isometries_among(x->f, listed.image, listed.order, tolerance, &image, &count, err);
  if (!st) st = generate(x, image, count, &g, err);
  free(image);
  thr_group_destroy(&listed);
  return st ? st : add_group(x, &g, err);
}

/* The group that isometries make, among the automorphisms that keep the lengths of edges. */
static thr_status add_shape(offer *x, const thr_automorphisms *a, const int *edge_colour, bool *all,
                            thr_err *err)
{
  double tolerance = x->o->symmetry.geometric;
  const thr_automorphism_options colours = {a->orbit, edge_colour};
  x->t->keep_lengths[0] = a->mantissa;
  x->t->keep_lengths[1] = a->exponent;
  *all = true;
  if (a->exponent == 0 && a->mantissa <= THR_GROUP_CAP)
    return add_listed_isometries(x, a, tolerance, err);
  return add_isometries(x, &colours, tolerance, all, err);
}

/* Which nodes an automorphism may not mix up, beside feet and others. */
static void colour_ends(const offer *x, int *colour)
{
  for (int v = 0; v < x->f->n_nodes; v++)
    colour[v] = x->o->ends == THR_ENDS_NODES && x->o->end_node[v];
}

typedef struct {
  int length, cover, capacity, edge; /* length: a colour */
} edge_kind;

static int by_kind(const void *a, const void *b)
{
  const edge_kind *p = a, *q = b;
  const int x[] = {p->length, p->cover, p->capacity}, y[] = {q->length, q->cover, q->capacity};
  for (int i = 0; i < 3; i++)
    if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
  return 0;
}

/* Splits colours of edges by what the edges need and may have. */
static thr_status colour_passes(const offer *x, int *colour, thr_err *err)
{
  int n = x->f->n_edges;
  edge_kind *kind = thr_calloc((size_t)n, sizeof *kind);
  if (!kind) return thr_nomem(err);
  for (int e = 0; e < n; e++)
    kind[e] =
        (edge_kind){colour[e], thr_plan_cover(x->f, x->o, e), thr_plan_capacity(x->f, x->o, e), e};
  qsort(kind, (size_t)n, sizeof *kind, by_kind);
  for (int i = 0, made = 0; i < n; i++) {
    if (i > 0 && by_kind(&kind[i - 1], &kind[i])) made++;
    colour[kind[i].edge] = made;
  }
  free(kind);
  return THR_OK;
}

static thr_status find_shape(offer *x, bool *all, thr_err *err)
{
  int *edge = thr_calloc((size_t)x->f->n_edges, sizeof *edge),
      *node = thr_calloc((size_t)x->f->n_nodes, sizeof *node);
  thr_automorphisms a = {0};
  thr_status st =
      edge && node ? thr_length_colours(x->f, x->o->symmetry.geometric, edge, err) : thr_nomem(err);
  if (!st) {
    colour_ends(x, node);
    st = colour_passes(x, edge, err);
  }
  bool found;
  if (!st)
    st = thr_automorphisms_within(x->f, &(thr_automorphism_options){node, edge}, x->limits, &found,
                                  &a, err);
  if (!st) st = add_shape(x, &a, edge, all, err);
  if (!st) *all = *all && found;
  thr_automorphisms_destroy(&a);
  free(edge);
  free(node);
  return st;
}

static thr_status offer_isometries(offer *x, thr_err *err)
{
  thr_symmetries *symmetries = x->t;
  bool all, complete = true;
  double tolerance = x->o->symmetry.geometric;
  thr_status st = find_shape(x, &all, err);
  if (!st) st = add_classes(x, true, &complete, err);
  if (st) return st;
  symmetries->mantissa = symmetries->group[0].all.order;
  symmetries->listed = all && complete;
  if (!all && thr_limits_stop(x->limits))
    snprintf(symmetries->note, sizeof symmetries->note,
             "too little time to look for isometries: only the identity");
  else if (!all)
    snprintf(symmetries->note, sizeof symmetries->note,
             "more than %d isometries within %g, too many to list: only the identity",
             THR_GROUP_CAP, tolerance);
  else if (!complete)
    snprintf(symmetries->note, sizeof symmetries->note,
             "more than %d classes of subgroups: the first of them", THR_SYMMETRY_CLASSES);
  return count_orbits(x, symmetries->group[0].all.image, symmetries->group[0].all.order, err);
}

/* ---- a group that is too large ---- */

/* The subgroups of what one or two generators make, if that is small. */
static thr_status add_small(offer *x, const int *generator, int n, thr_err *err)
{
  thr_group group;
  thr_err why = {0};
  bool complete;
  int before = x->t->n;
  thr_status st =
      thr_group_generate(x->f->n_nodes, generator, n, THR_SYMMETRY_EXTRA_ORDER, &group, &why);
  if (st == THR_ELIMIT) return THR_OK;
  if (st) return thr_fail(err, st, "%s", why.text);
  st = add_group(x, &group, err);
  if (!st) st = add_classes(x, false, &complete, err);
  if (st || x->t->n > before) return st;
  x->t->n_groups--; /* nothing new */
  free(x->t->group[x->t->n_groups].isometry);
  thr_group_destroy(&x->t->group[x->t->n_groups].all);
  return THR_OK;
}

/* Among the first generators: each, then two and two. */
static thr_status add_extra(offer *x, const thr_automorphisms *a, int most, thr_err *err)
{
  enum { FIRST = 8 };
  size_t row = (size_t)a->n;
  int count = a->n_generators < FIRST ? a->n_generators : FIRST,
      *two = thr_calloc(2 * row, sizeof *two);
  thr_status st = two ? THR_OK : thr_nomem(err);
  for (int i = 0; i < count && !st && x->t->n < most && !thr_limits_stop(x->limits); i++)
    st = add_small(x, &a->generator[(size_t)i * row], 1, err);
  for (int i = 0; i < count && !st; i++)
    for (int j = i + 1; j < count && !st && x->t->n < most && !thr_limits_stop(x->limits); j++) {
      memcpy(two, &a->generator[(size_t)i * row], row * sizeof *two);
      memcpy(two + row, &a->generator[(size_t)j * row], row * sizeof *two);
      st = add_small(x, two, 2, err);
    }
  free(two);
  return st;
}

static void drop_rows(thr_symmetries *symmetries, int most)
{
  while (symmetries->n > most)
    thr_subgroup_destroy(&symmetries->row[--symmetries->n].elements);
}

/* Instead of all subgroups. */
static thr_status offer_some(offer *x, const thr_automorphisms *a, thr_err *err)
{
  thr_symmetries *symmetries = x->t;
  bool all, complete = true;
  int first = symmetries->n_groups;
  const thr_automorphism_options orbits = {.node_colour = a->orbit};
  thr_status st = add_isometries(x, &orbits, thr_symmetry_near, &all, err);
  if (!st) st = add_classes(x, true, &complete, err);
  if (st) return st;
  if (thr_limits_stop(x->limits)) {
    snprintf(symmetries->note, sizeof symmetries->note,
             "too many to list, and too little time to look for more than these");
    return THR_OK;
  }
  int isometries = symmetries->group[first].all.order, most = symmetries->n + THR_SYMMETRY_EXTRA;
  st = add_extra(x, a, most, err);
  drop_rows(symmetries, most);
  snprintf(
      symmetries->note, sizeof symmetries->note,
      "too many to list. Instead: %s %d%s within %g %% of an isometry%s, and small groups that one "
      "or two generators make",
      all ? "the" : "more than", all ? isometries : THR_GROUP_CAP, all ? "" : " that are",
      100 * thr_symmetry_near,
      !all       ? " are left out"
      : complete ? " with all their subgroups"
                 : " with the first subgroups");
  return st;
}

static thr_status offer_automorphisms(offer *x, thr_err *err)
{
  thr_symmetries *symmetries = x->t;
  thr_automorphisms a;
  thr_group group = {0};
  bool all = true;
  int *node = thr_calloc((size_t)x->f->n_nodes, sizeof *node),
      *edge = thr_calloc((size_t)x->f->n_edges, sizeof *edge);
  thr_status st = node && edge ? colour_passes(x, edge, err) : thr_nomem(err);
  if (!st) {
    colour_ends(x, node);
    st = thr_automorphisms_within(x->f, &(thr_automorphism_options){node, edge}, x->limits, &all,
                                  &a, err);
  }
  free(node);
  free(edge);
  if (st) return st;
  symmetries->mantissa = a.mantissa;
  symmetries->exponent = a.exponent;
  st = count_orbits(x, a.generator, a.n_generators, err);
  if (!st && a.exponent == 0 && a.mantissa <= THR_GROUP_CAP) {
    st = thr_group_generate(a.n, a.generator, a.n_generators, THR_GROUP_CAP, &group, err);
    if (!st) st = add_group(x, &group, err);
    if (!st) st = add_classes(x, false, &symmetries->listed, err);
  }
  if (!st && !symmetries->listed) st = offer_some(x, &a, err);
  if (!st && !all) {
    symmetries->listed = false;
    snprintf(symmetries->note, sizeof symmetries->note,
             "too little time to find the automorphisms: only the identity");
  }
  thr_automorphisms_destroy(&a);
  return st;
}

/* ---- all ---- */

/* By descending order, those of one order as they were found. */
static void sort_rows(thr_symmetries *symmetries)
{
  for (int i = 1; i < symmetries->n; i++) {
    thr_symmetry_row row = symmetries->row[i];
    int k = i;
    for (; k > 0 && symmetries->row[k - 1].order < row.order; k--)
      symmetries->row[k] = symmetries->row[k - 1];
    symmetries->row[k] = row;
  }
}

thr_status thr_symmetry_groups(const thr_frame *frame, const thr_request *options,
                               const thr_limits *limits, thr_symmetries *symmetries, thr_err *err)
{
  offer x = {.f = frame, .o = options, .t = symmetries, .limits = limits};
  thr_status st =
      options->symmetry.geometric >= 0 ? offer_isometries(&x, err) : offer_automorphisms(&x, err);
  sort_rows(symmetries);
  return st;
}
