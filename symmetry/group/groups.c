/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses the groups of automorphisms that are offered for a framework, and makes a row of the
 * table for each.
 *
 * All subgroups up to conjugacy where they can be listed; else the isometries with their subgroups,
 * found from the coordinates, and the groups that one or two of nauty's generators make. If
 * isometries are asked for, the group that they generate, among the automorphisms that keep the
 * lengths of edges.
 *
 * Example: of the square's group C4v: C1, C2, C4, two classes of mirrors, two of C2v, and C4v
 * itself. */
#include "symmetry/group/groups.h"
#include "graph/arrays.h"
#include "symmetry/group/group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const double thr_symmetry_near = THR_ISOMETRY_NEAR;

/* The table that is filled. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  thr_symmetries *table;
  const thr_limits *limits;
  int capacity; /* of the table's rows */
} group_offer;

/* Returns the images of the nodes under an element of a group of the table. */
static const int *image_of(const thr_symmetries *symmetries, int group, int element)
{
  const thr_group *all = &symmetries->group[group].all;
  return &all->image[(size_t)element * (size_t)all->degree];
}

/* ---- rows ---- */

/* Fills the kinds, the residual and the name of a row. scratch: [row->order]. */
static void describe(const group_offer *offer, thr_symmetry_row *row, thr_isometry *scratch)
{
  const thr_isometry *iso = offer->table->group[row->group].isometry;
  for (int i = 0; i < row->order; i++) {
    scratch[i] = iso[row->elements.element[i]];
    row->kinds[scratch[i].kind]++;
    row->residual = fmax(row->residual, scratch[i].residual);
  }
  thr_point_group_name(scratch, row->order, row->name);
}

/* Tells whether two rows are the same permutations. In every group elements are numbered by their
 * images. */
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

/* Adds a row, unless the table has it already. Takes the elements over, on failure too. */
static thr_status add_row(group_offer *offer, int group, thr_subgroup *elements, int conjugates,
                          thr_err *err)
{
  thr_symmetries *symmetries = offer->table;
  thr_symmetry_row row = {
      .order = elements->order, .conjugates = conjugates, .group = group, .elements = *elements};
  *elements = (thr_subgroup){0};

  /* Is it there already? */
  for (int i = 0; i < symmetries->n; i++)
    if (same_row(symmetries, &symmetries->row[i], &row)) {
      thr_subgroup_destroy(&row.elements);
      return THR_OK;
    }

  /* A new row. */
  thr_isometry *scratch = thr_calloc((size_t)row.order, sizeof *scratch);
  thr_status st = scratch ? thr_grow(&symmetries->row, symmetries->n, &offer->capacity,
                                     sizeof *symmetries->row, err)
                          : thr_nomem(err);

  if (!st) {
    describe(offer, &row, scratch);
    symmetries->row[symmetries->n++] = row;
  } else {
    thr_subgroup_destroy(&row.elements);
  }

  free(scratch);
  return st;
}

/* Adds a group to the table with the isometries nearest to its elements. Takes the group over, on
 * failure too. */
static thr_status add_group(group_offer *offer, thr_group *listed, thr_err *err)
{
  thr_symmetries *symmetries = offer->table;
  thr_symmetry_group *group = thr_realloc(symmetries->group, (size_t)symmetries->n_groups + 1,
                                          sizeof *group),
                     added = {.all = *listed};
  *listed = (thr_group){0};

  /* One more place in the table; without memory the group is freed. */
  if (group) symmetries->group = group;
  if (!group || !(added.isometry = thr_calloc((size_t)added.all.order, sizeof *added.isometry))) {
    thr_group_destroy(&added.all);
    return thr_nomem(err);
  }
  symmetries->group[symmetries->n_groups++] = added;

  /* What its elements are in space. */
  for (int a = 0; a < added.all.order; a++)
    thr_isometry_of(offer->frame, image_of(symmetries, symmetries->n_groups - 1, a),
                    thr_symmetry_near, &added.isometry[a]);
  return THR_OK;
}

/* Tells, if isometries are asked for, whether all elements of a subgroup are within the tolerance:
 * products of isometries need not be. */
static bool keeps_shape(const group_offer *offer, int group, const thr_subgroup *subgroup)
{
  double tolerance = offer->request->symmetry.geometric;
  for (int i = 0; i < subgroup->order && tolerance >= 0; i++) {
    thr_motion motion;
    thr_procrustes(offer->frame, image_of(offer->table, group, subgroup->element[i]), &motion);
    if (motion.farthest > tolerance + THR_ISOMETRY_ROUNDING) return false;
  }
  return true;
}

/* Adds a row for each class of subgroups of the group that was added last; without `partly` none if
 * there are too many. */
static thr_status add_classes(group_offer *offer, bool partly, bool *complete, thr_err *err)
{
  thr_subgroup_classes classes = {0};
  int group = offer->table->n_groups - 1;
  thr_status st = thr_subgroup_classes_find(&offer->table->group[group].all, THR_SYMMETRY_CLASSES,
                                            &classes, err);

  /* Rows for all classes, or none. */
  *complete = classes.complete;
  for (int k = 0; k < classes.n && !st && (partly || classes.complete); k++)
    if (keeps_shape(offer, group, &classes.subgroup[k]))
      st = add_row(offer, group, &classes.subgroup[k], classes.conjugates[k], err);

  thr_subgroup_classes_destroy(&classes);
  return st;
}

/* ---- orbits ---- */

/* Counts the orbits of nodes and of edges under generators ([n_generators * n_nodes] images of the
 * nodes). */
static thr_status count_orbits(group_offer *offer, const int *generator, int n_generators,
                               thr_err *err)
{
  const thr_frame *frame = offer->frame;
  int *node = thr_calloc((size_t)frame->n_nodes, sizeof *node),
      *edge = thr_calloc((size_t)frame->n_edges, sizeof *edge);
  offer->table->node_orbits = frame->n_nodes;
  offer->table->edge_orbits = frame->n_edges;

  /* Every node and edge for itself. */
  for (int v = 0; node && v < frame->n_nodes; v++)
    node[v] = v;
  for (int e = 0; edge && e < frame->n_edges; e++)
    edge[e] = e;

  /* Each join makes one orbit less. */
  for (int g = 0; node && edge && g < n_generators; g++) {
    const int *to = &generator[(size_t)g * (size_t)frame->n_nodes];
    for (int v = 0; v < frame->n_nodes; v++)
      offer->table->node_orbits -= thr_disjoint_join(node, v, to[v]);
    for (int e = 0; e < frame->n_edges; e++)
      offer->table->edge_orbits -= thr_disjoint_join(
          edge, e, thr_edge_joining(frame, to[frame->edge[e][0]], to[frame->edge[e][1]]));
  }

  thr_status st = node && edge ? THR_OK : thr_nomem(err);
  free(node);
  free(edge);
  return st;
}

/* ---- isometries ---- */

/* Tells whether an automorphism keeps where cords may end, and what edges need and may have. */
static bool keeps_request(const group_offer *offer, const int *image)
{
  /* Edges. */
  for (int e = 0; e < offer->frame->n_edges; e++) {
    int to = thr_edge_joining(offer->frame, image[offer->frame->edge[e][0]],
                              image[offer->frame->edge[e][1]]);
    if (thr_plan_cover(offer->frame, offer->request, e) !=
            thr_plan_cover(offer->frame, offer->request, to) ||
        thr_plan_capacity(offer->frame, offer->request, e) !=
            thr_plan_capacity(offer->frame, offer->request, to))
      return false;
  }

  /* Where cords may end. */
  for (int v = 0; offer->request->ends == THR_ENDS_NODES && v < offer->frame->n_nodes; v++)
    if (offer->request->end_node[v] != offer->request->end_node[image[v]]) return false;
  return true;
}

/* Tells whether a group has an element with these images; the images of a group ascend. */
static bool has_element(const thr_group *group, const int *image)
{
  int low = 0, high = group->order;

  while (low < high) {
    /* The first point where the images differ. */
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

/* Makes the group that rows of images generate, as far as they keep the request. A row becomes a
 * generator only if the rows before it do not generate it. */
static thr_status generate_from(const group_offer *offer, const int *image, int count,
                                thr_group *group, thr_err *err)
{
  enum { MOST_GENERATORS = 16 }; /* each at least doubles the group, and 2^10 is the cap */
  int n_nodes = offer->frame->n_nodes, used = 0,
      *generator = thr_calloc((size_t)MOST_GENERATORS * (size_t)n_nodes, sizeof *generator);
  *group = (thr_group){0};
  if (!generator) return thr_nomem(err);

  thr_status st = thr_group_generate(n_nodes, generator, 0, THR_GROUP_CAP, group, err);

  for (int i = 0; i < count && !st; i++) {
    const int *row = &image[(size_t)i * (size_t)n_nodes];
    if (!keeps_request(offer, row) || has_element(group, row)) continue;
    memcpy(&generator[(size_t)used++ * (size_t)n_nodes], row, (size_t)n_nodes * sizeof *row);
    thr_group_destroy(group);
    st = thr_group_generate(n_nodes, generator, used, THR_GROUP_CAP, group, err);
  }

  free(generator);
  return st;
}

/* Adds the isometries as one more group of the table; only the identity if they are too many (*all
 * = false). */
static thr_status add_isometries(group_offer *offer, const thr_automorphism_options *colours,
                                 double tolerance, bool *all, thr_err *err)
{
  thr_err why = {0};
  thr_group group = {0};
  int *image = NULL, count = 0;
  thr_status st = thr_isometries_find(offer->frame, colours, tolerance, THR_GROUP_CAP,
                                      offer->limits, &image, &count, &why);
  if (!st) st = generate_from(offer, image, count, &group, &why);
  free(image);

  /* Too many: only the identity. */
  *all = !st;
  if (st == THR_ELIMIT)
    st = generate_from(offer, NULL, 0, &group, err);
  else if (st)
    thr_fail(err, st, "%s", why.text);

  return st ? st : add_group(offer, &group, err);
}

/* Adds the isometries among all automorphisms, which can be listed, as one more group of the table.
 */
static thr_status add_listed_isometries(group_offer *offer, const thr_automorphisms *automorphisms,
                                        double tolerance, thr_err *err)
{
  thr_group listed, group = {0};
  int *image = NULL, count = 0;
  thr_status st = thr_group_generate(automorphisms->n, automorphisms->generator,
                                     automorphisms->n_generators, THR_GROUP_CAP, &listed, err);

  /* List all automorphisms, and choose the isometries among them. */
  if (!st)
    st = thr_isometries_among(offer->frame, listed.image, listed.order, tolerance, &image, &count,
                              err);
  if (!st) st = generate_from(offer, image, count, &group, err);

  free(image);
  thr_group_destroy(&listed);
  return st ? st : add_group(offer, &group, err);
}

/* Adds the group that the isometries generate, among the automorphisms that keep the lengths of
 * edges. */
static thr_status add_shape(group_offer *offer, const thr_automorphisms *automorphisms,
                            const int *edge_colour, bool *all, thr_err *err)
{
  double tolerance = offer->request->symmetry.geometric;
  const thr_automorphism_options colours = {automorphisms->orbit, edge_colour};
  offer->table->keep_lengths[0] = automorphisms->mantissa;
  offer->table->keep_lengths[1] = automorphisms->exponent;

  /* Can the automorphisms be listed? */
  *all = true;
  if (automorphisms->exponent == 0 && automorphisms->mantissa <= THR_GROUP_CAP)
    return add_listed_isometries(offer, automorphisms, tolerance, err);
  return add_isometries(offer, &colours, tolerance, all, err);
}

/* Colours nodes by whether cords may end there; feet are told apart in any case. */
static void colour_ends(const group_offer *offer, int *colour)
{
  for (int v = 0; v < offer->frame->n_nodes; v++)
    colour[v] = offer->request->ends == THR_ENDS_NODES && offer->request->end_node[v];
}

/* What tells an edge apart from others. */
typedef struct {
  int length, cover, capacity, edge; /* length: a colour */
} edge_kind;

/* Compares edges by length, cover and capacity, but not by number. */
static int by_kind(const void *a, const void *b)
{
  const edge_kind *first = a, *second = b;
  const int x[] = {first->length, first->cover, first->capacity},
            second_key[] = {second->length, second->cover, second->capacity};
  for (int i = 0; i < 3; i++)
    if (x[i] != second_key[i]) return x[i] < second_key[i] ? -1 : 1;
  return 0;
}

/* Splits the colours of edges by what the edges need and may have. */
static thr_status colour_passes(const group_offer *offer, int *colour, thr_err *err)
{
  int n_edges = offer->frame->n_edges;
  edge_kind *kind = thr_calloc((size_t)n_edges, sizeof *kind);
  if (!kind) return thr_nomem(err);

  /* Sort the edges by what tells them apart. */
  for (int e = 0; e < n_edges; e++)
    kind[e] = (edge_kind){colour[e], thr_plan_cover(offer->frame, offer->request, e),
                          thr_plan_capacity(offer->frame, offer->request, e), e};
  qsort(kind, (size_t)n_edges, sizeof *kind, by_kind);

  /* Equal edges follow each other. */
  for (int i = 0, made = 0; i < n_edges; i++) {
    if (i > 0 && by_kind(&kind[i - 1], &kind[i])) made++;
    colour[kind[i].edge] = made;
  }

  free(kind);
  return THR_OK;
}

/* Finds the group of isometries that are asked for: automorphisms that keep colours of lengths, and
 * among them isometries. */
static thr_status find_shape(group_offer *offer, bool *all, thr_err *err)
{
  int *edge = thr_calloc((size_t)offer->frame->n_edges, sizeof *edge),
      *node = thr_calloc((size_t)offer->frame->n_nodes, sizeof *node);
  thr_automorphisms automorphisms = {0};
  thr_status st =
      edge && node ? thr_length_colours(offer->frame, offer->request->symmetry.geometric, edge, err)
                   : thr_nomem(err);
  /* The colours. */
  if (!st) {
    colour_ends(offer, node);
    st = colour_passes(offer, edge, err);
  }

  /* The automorphisms, and the group. */
  bool found;
  if (!st)
    st = thr_automorphisms_within(offer->frame, &(thr_automorphism_options){node, edge},
                                  offer->limits, &found, &automorphisms, err);
  if (!st) st = add_shape(offer, &automorphisms, edge, all, err);
  if (!st) *all = *all && found;

  thr_automorphisms_destroy(&automorphisms);
  free(edge);
  free(node);
  return st;
}

/* Offers the isometries that are asked for, and their subgroups. */
static thr_status offer_isometries(group_offer *offer, thr_err *err)
{
  thr_symmetries *symmetries = offer->table;
  bool all, complete = true;
  double tolerance = offer->request->symmetry.geometric;
  /* Isometries, and subgroups of their group. */
  thr_status st = find_shape(offer, &all, err);
  if (!st) st = add_classes(offer, true, &complete, err);
  if (st) return st;

  /* What is said of the list. */
  symmetries->mantissa = symmetries->group[0].all.order;
  symmetries->listed = all && complete;
  if (!all && thr_limits_stop(offer->limits))
    snprintf(symmetries->note, sizeof symmetries->note,
             "too little time to look for isometries: only the identity");
  else if (!all)
    snprintf(symmetries->note, sizeof symmetries->note,
             "more than %d isometries within %g, too many to list: only the identity",
             THR_GROUP_CAP, tolerance);
  else if (!complete)
    snprintf(symmetries->note, sizeof symmetries->note,
             "more than %d classes of subgroups: the first of them", THR_SYMMETRY_CLASSES);

  return count_orbits(offer, symmetries->group[0].all.image, symmetries->group[0].all.order, err);
}

/* ---- a group that is too large ---- */

/* Adds the subgroups of what one or two generators generate, if that is a small group. */
static thr_status add_small(group_offer *offer, const int *generator, int n_generators,
                            thr_err *err)
{
  thr_group group;
  thr_err why = {0};
  bool complete;
  int before = offer->table->n;
  /* The group, if it is small. */
  thr_status st = thr_group_generate(offer->frame->n_nodes, generator, n_generators,
                                     THR_SYMMETRY_EXTRA_ORDER, &group, &why);
  if (st == THR_ELIMIT) return THR_OK;
  if (st) return thr_fail(err, st, "%s", why.text);

  st = add_group(offer, &group, err);
  if (!st) st = add_classes(offer, false, &complete, err);
  if (st || offer->table->n > before) return st;

  /* The group is not needed without a row of it. */
  offer->table->n_groups--;
  free(offer->table->group[offer->table->n_groups].isometry);
  thr_group_destroy(&offer->table->group[offer->table->n_groups].all);
  return THR_OK;
}

/* Adds the groups that each of the first generators makes, then every two of them, until there are
 * `most` rows. */
static thr_status add_extra(group_offer *offer, const thr_automorphisms *automorphisms, int most,
                            thr_err *err)
{
  enum { MOST_SINGLE = 8 };
  size_t row = (size_t)automorphisms->n;
  int count = automorphisms->n_generators < MOST_SINGLE ? automorphisms->n_generators : MOST_SINGLE,
      *both = thr_calloc(2 * row, sizeof *both);
  thr_status st = both ? THR_OK : thr_nomem(err);

  /* Single generators. */
  for (int i = 0; i < count && !st && offer->table->n < most && !thr_limits_stop(offer->limits);
       i++)
    st = add_small(offer, &automorphisms->generator[(size_t)i * row], 1, err);

  /* Two of them. */
  for (int i = 0; i < count && !st; i++)
    for (int j = i + 1;
         j < count && !st && offer->table->n < most && !thr_limits_stop(offer->limits); j++) {
      memcpy(both, &automorphisms->generator[(size_t)i * row], row * sizeof *both);
      memcpy(both + row, &automorphisms->generator[(size_t)j * row], row * sizeof *both);
      st = add_small(offer, both, 2, err);
    }

  free(both);
  return st;
}

/* Removes rows beyond `most`. */
static void drop_rows(thr_symmetries *symmetries, int most)
{
  while (symmetries->n > most)
    thr_subgroup_destroy(&symmetries->row[--symmetries->n].elements);
}

/* Offers what there is instead of all subgroups: isometries, and groups of a few generators. */
static thr_status offer_some(group_offer *offer, const thr_automorphisms *automorphisms,
                             thr_err *err)
{
  thr_symmetries *symmetries = offer->table;
  bool all, complete = true;
  int first = symmetries->n_groups;
  const thr_automorphism_options orbits = {.node_colour = automorphisms->orbit};
  /* Isometries, and their subgroups. */
  thr_status st = add_isometries(offer, &orbits, thr_symmetry_near, &all, err);
  if (!st) st = add_classes(offer, true, &complete, err);
  if (st) return st;

  if (thr_limits_stop(offer->limits)) {
    snprintf(symmetries->note, sizeof symmetries->note,
             "too many to list, and too little time to look for more than these");
    return THR_OK;
  }

  /* Small groups. */
  int isometries = symmetries->group[first].all.order, most = symmetries->n + THR_SYMMETRY_EXTRA;
  st = add_extra(offer, automorphisms, most, err);
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

/* Offers all automorphisms that keep the request. */
static thr_status offer_automorphisms(group_offer *offer, thr_err *err)
{
  thr_symmetries *symmetries = offer->table;
  thr_automorphisms automorphisms;
  thr_group group = {0};
  bool all = true;
  int *node = thr_calloc((size_t)offer->frame->n_nodes, sizeof *node),
      *edge = thr_calloc((size_t)offer->frame->n_edges, sizeof *edge);
  thr_status st = node && edge ? colour_passes(offer, edge, err) : thr_nomem(err);
  /* Colours, and the automorphisms that keep them. */
  if (!st) {
    colour_ends(offer, node);
    st = thr_automorphisms_within(offer->frame, &(thr_automorphism_options){node, edge},
                                  offer->limits, &all, &automorphisms, err);
  }
  free(node);
  free(edge);
  if (st) return st;

  /* All their subgroups, if they can be listed. */
  symmetries->mantissa = automorphisms.mantissa;
  symmetries->exponent = automorphisms.exponent;
  st = count_orbits(offer, automorphisms.generator, automorphisms.n_generators, err);
  if (!st && automorphisms.exponent == 0 && automorphisms.mantissa <= THR_GROUP_CAP) {
    st = thr_group_generate(automorphisms.n, automorphisms.generator, automorphisms.n_generators,
                            THR_GROUP_CAP, &group, err);
    if (!st) st = add_group(offer, &group, err);
    if (!st) st = add_classes(offer, false, &symmetries->listed, err);
  }

  /* Or some groups. */
  if (!st && !symmetries->listed) st = offer_some(offer, &automorphisms, err);

  /* What is said if not all were found. */
  if (!st && !all) {
    symmetries->listed = false;
    snprintf(symmetries->note, sizeof symmetries->note,
             "too little time to find the automorphisms: only the identity");
  }

  thr_automorphisms_destroy(&automorphisms);
  return st;
}

/* ---- the table ---- */

/* Sorts the rows by descending order; rows of one order stay as they were found. */
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

thr_status thr_symmetry_groups(const thr_frame *frame, const thr_request *request,
                               const thr_limits *limits, thr_symmetries *symmetries, thr_err *err)
{
  group_offer offer = {.frame = frame, .request = request, .table = symmetries, .limits = limits};
  thr_status st = request->symmetry.geometric >= 0 ? offer_isometries(&offer, err)
                                                   : offer_automorphisms(&offer, err);
  sort_rows(symmetries);
  return st;
}
