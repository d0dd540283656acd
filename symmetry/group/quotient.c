/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the quotient by a group H of automorphisms: the types of copies, darts and turns of
 * threadings that H maps to themselves (docs/method.md).
 *
 * A symmetric threading is an H-set of copies (passes) over the edges with an H-invariant pairing
 * of their darts (a dart is one end of a copy) at the nodes. Fewer conditions are wrong: an
 * H-invariant T-join with even degrees need not have an invariant pairing.
 *
 * copy type (e, K)  An orbit of copies over the orbit of edge e; K <= H_e, up to conjugacy in
 *                   H_e, maps one copy to itself. The orbit adds [H_e : K] passes to e. If an
 *                   element of K turns e round, the copy is a fold: its trail is mapped to its
 *                   reverse.
 * dart type (h, S)  An orbit of darts over half-edge h with stabilizer S <= H_h. A copy type
 *                   without fold has two dart orbits, of types (h, K) and (h ^ 1, K); with a fold
 *                   one, of type (h, S), where S has the elements of K that do not turn e round.
 * pair type         An orbit of turns at a node: darts a, b with equal stabilizers over half-edges
 *                   of one node; over one half-edge the cord turns back into its edge. If some g
 *                   in H_v maps a to b, a pair within one dart orbit (a "self" pair) needs such a g
 *                   that also maps b to a; it folds the trail at the node. Two different dart
 *                   orbits of one type can be paired in any case.
 * layer             The stabilizer of a dart, up to conjugacy, which all its trail has: a trail
 *                   over an edge in a mirror, passed by one fixed copy, stays in the mirror.
 *
 * In the quotient a trail's orbit is a path between two terminals (cord end or fold) or a circle.
 *
 * Example: an edge in a mirror has two copy types: one copy that the mirror fixes, and two that it
 * exchanges. */
#include "symmetry/group/group.h"
#include "graph/arrays.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* What is needed while a quotient is made. Sets of elements of G are arrays of bool by element
 * number. */
typedef struct {
  thr_quotient *quotient;
  const thr_limits *limits;
  int most;
  int *position; /* [order of G] of an element within H, -1 = not in H */
  int copies_capacity, darts_capacity, pairs_capacity;
  int *latest; /* [2 * n_edges] dart type over a half-edge that was added last, -1 = none */
  int *before; /* [n_darts] the one added over the same half-edge before that */
  int before_capacity;
  bool *set, *least;  /* [order of G] */
  int *normal, *at;   /* [order of H] places in H of the elements of N and of H_v (see add_pairs) */
  int n_normal, n_at; /* their numbers */
  thr_subgroup *s_class; /* [n_layers] least conjugate of each layer's stabilizers */
  int classes_capacity;
  thr_scratch own; /* the arrays */
} quotient_builder;

/* Returns by a by^-1. */
static int conjugated(const thr_group *group, int by, int a)
{
  return thr_group_product(group, thr_group_product(group, by, a), group->inverse[by]);
}

static thr_status fail_too_many(const quotient_builder *builder, thr_err *err)
{
  return thr_fail(err, THR_ELIMIT,
                  "a group of order %d makes more than %d types of passes and turns",
                  builder->quotient->h->order, builder->most);
}

/* Tells whether there are as many types as may be. */
static bool is_full(const quotient_builder *builder)
{
  return builder->quotient->n_copies + builder->quotient->n_darts + builder->quotient->n_pairs >=
         builder->most;
}

static thr_status check_time(const quotient_builder *builder, thr_err *err)
{
  return thr_limits_stop(builder->limits)
             ? thr_fail(err, THR_ELIMIT, "the time was too short for the types of passes and turns")
             : THR_OK;
}

/* ---- images and orbits ---- */

/* Returns the half-edge from one node to another, or -1. */
static int half_between(const thr_frame *frame, int from, int to)
{
  int e = thr_edge_joining(frame, from, to);
  return e < 0 ? -1 : 2 * e + (frame->edge[e][1] == from);
}

/* Fills the images of all half-edges under the elements of H. THR_EINPUT: some element is no
 * automorphism. */
static thr_status map_halves(const quotient_builder *builder, thr_err *err)
{
  thr_quotient *quotient = builder->quotient;
  const thr_frame *frame = quotient->f;
  size_t halves = 2 * (size_t)frame->n_edges;
  quotient->half_image =
      thr_calloc((size_t)quotient->h->order * halves, sizeof *quotient->half_image);
  if (!quotient->half_image) return thr_nomem(err);

  for (int i = 0; i < quotient->h->order; i++) {
    thr_status st = check_time(builder, err);
    if (st) return st;

    /* Half-edges go where their nodes go. */
    const int *nodes =
        &quotient->group->image[(size_t)quotient->h->element[i] * (size_t)quotient->group->degree];
    for (int h = 0; h < 2 * frame->n_edges; h += 2) {
      int half = half_between(frame, nodes[thr_tail(frame, h)], nodes[thr_head(frame, h)]);
      if (half < 0)
        return thr_fail(err, THR_EINPUT, "element %d of the group is no automorphism",
                        quotient->h->element[i]);
      quotient->half_image[(size_t)i * halves + (size_t)h] = half;
      quotient->half_image[(size_t)i * halves + (size_t)h + 1] = half ^ 1;
    }
  }
  return THR_OK;
}

/* Numbers the orbits of edges by their lowest edges. */
static thr_status find_edge_orbits(thr_quotient *quotient, thr_err *err)
{
  size_t n_edges = (size_t)quotient->f->n_edges;
  quotient->edge_orbit = thr_calloc(n_edges, sizeof *quotient->edge_orbit);
  quotient->orbit_size = thr_calloc(n_edges, sizeof *quotient->orbit_size);
  quotient->orbit_length = thr_calloc(n_edges, sizeof *quotient->orbit_length);
  if (!quotient->edge_orbit || !quotient->orbit_size || !quotient->orbit_length)
    return thr_nomem(err);

  memset(quotient->edge_orbit, -1, n_edges * sizeof *quotient->edge_orbit);

  /* The lowest edge without an orbit makes a new one. */
  for (int e = 0; e < quotient->f->n_edges; e++) {
    if (quotient->edge_orbit[e] >= 0) continue;
    /* All images of the edge. */
    int orbit = quotient->n_edge_orbits++;
    for (int i = 0; i < quotient->h->order; i++) {
      int to = thr_quotient_image(quotient, i, 2 * e) >> 1;
      if (quotient->edge_orbit[to] >= 0) continue;
      quotient->edge_orbit[to] = orbit;
      quotient->orbit_size[orbit]++;
      quotient->orbit_length[orbit] += quotient->f->length[to];
    }
  }

  return THR_OK;
}

/* ---- sets of elements ---- */

/* Tells whether set a has the lowest element in which both differ. */
static bool less_set(const bool *a, const bool *b, int n)
{
  for (int g = 0; g < n; g++)
    if (a[g] != b[g]) return a[g];
  return false;
}

/* Marks in set[order of G] the conjugates of a subgroup's elements by an element. */
static void mark_conjugate(const thr_group *group, int by, const thr_subgroup *subgroup, bool *set)
{
  memset(set, 0, (size_t)group->order * sizeof *set);
  for (int k = 0; k < subgroup->order; k++)
    set[conjugated(group, by, subgroup->element[k])] = true;
}

/* Makes a subgroup of the elements that are marked. */
static thr_status make_subgroup(const bool *set, int order, thr_subgroup *out, thr_err *err)
{
  int n = 0;
  /* How many are marked? */
  for (int g = 0; g < order; g++)
    n += set[g];

  *out = (thr_subgroup){n, thr_calloc((size_t)n, sizeof(int))};
  if (!out->element) return thr_nomem(err);

  for (int g = 0, k = 0; g < order; g++)
    if (set[g]) out->element[k++] = g;
  return THR_OK;
}

/* Tells whether exactly the elements of a subgroup are marked. */
static bool holds_exactly(const bool *set, int order, const thr_subgroup *subgroup)
{
  int n = 0;
  for (int g = 0; g < order; g++)
    n += set[g];
  for (int k = 0; k < subgroup->order && n == subgroup->order; k++)
    if (!set[subgroup->element[k]]) return false;
  return n == subgroup->order;
}

/* Computes the least conjugate of a subgroup by elements that move this half-edge to its lowest
 * image (half < 0: by any element), into builder->least. Returns that lowest image. */
static int least_conjugate(const quotient_builder *builder, int half, const thr_subgroup *subgroup)
{
  const thr_quotient *quotient = builder->quotient;
  int order = quotient->group->order, lowest = half;

  /* The lowest image. */
  for (int i = 0; half >= 0 && i < quotient->h->order; i++)
    if (thr_quotient_image(quotient, i, half) < lowest)
      lowest = thr_quotient_image(quotient, i, half);

  /* The least conjugate; of the trivial subgroup there is one. */
  bool first = true;
  for (int i = 0; i < quotient->h->order; i++) {
    if (half >= 0 && thr_quotient_image(quotient, i, half) != lowest) continue;
    /* Mark the conjugate, and keep it if it is the least so far. */
    if (!first && subgroup->order == 1) break;
    mark_conjugate(quotient->group, quotient->h->element[i], subgroup, builder->set);
    if (first || less_set(builder->set, builder->least, order))
      memcpy(builder->least, builder->set, (size_t)order * sizeof *builder->least);
    first = false;
  }
  return lowest;
}

/* ---- darts ---- */

/* Returns the type of the dart (half, subgroup), or -1. Leaves the least conjugate of its
 * stabilizer in builder->least, and the half-edge that goes with that in *lowest. */
static int find_dart(const quotient_builder *builder, int half, const thr_subgroup *subgroup,
                     int *lowest)
{
  *lowest = least_conjugate(builder, half, subgroup);
  for (int d = builder->latest[*lowest]; d >= 0; d = builder->before[d])
    if (holds_exactly(builder->least, builder->quotient->group->order,
                      &builder->quotient->dart[d].stabilizer))
      return d;
  return -1;
}

/* Finds the layer of a subgroup, a new one if need be. */
static thr_status find_layer(quotient_builder *builder, const thr_subgroup *subgroup, int *layer,
                             thr_err *err)
{
  thr_quotient *quotient = builder->quotient;
  int order = quotient->group->order;

  /* A layer is known by its least conjugate. */
  least_conjugate(builder, -1, subgroup);
  for (*layer = 0; *layer < quotient->n_layers; ++*layer)
    if (holds_exactly(builder->least, order, &builder->s_class[*layer])) return THR_OK;

  thr_status st = thr_grow(&builder->s_class, quotient->n_layers, &builder->classes_capacity,
                           sizeof *builder->s_class, err);
  if (!st) st = make_subgroup(builder->least, order, &builder->s_class[quotient->n_layers], err);
  if (!st) quotient->n_layers++;
  return st;
}

/* Finds the type of the dart (half, subgroup), and makes it if there is none. */
static thr_status add_dart(quotient_builder *builder, int half, const thr_subgroup *subgroup,
                           int *dart, thr_err *err)
{
  thr_quotient *quotient = builder->quotient;
  int lowest;
  thr_status st = check_time(builder, err);
  if (st) return st;

  *dart = find_dart(builder, half, subgroup, &lowest);
  if (*dart >= 0) return THR_OK;
  if (is_full(builder)) return fail_too_many(builder, err);

  /* A new type, with the least conjugate as its stabilizer. */
  assert(subgroup->order > 0);
  thr_dart_type made = {.half = lowest, .darts = quotient->h->order / subgroup->order};
  st = thr_grow(&quotient->dart, quotient->n_darts, &builder->darts_capacity,
                sizeof *quotient->dart, err);
  if (!st)
    st = thr_grow(&builder->before, quotient->n_darts, &builder->before_capacity,
                  sizeof *builder->before, err);
  if (!st) st = make_subgroup(builder->least, quotient->group->order, &made.stabilizer, err);
  if (!st) st = find_layer(builder, &made.stabilizer, &made.layer, err);

  if (st) {
    thr_subgroup_destroy(&made.stabilizer);
    return st;
  }

  /* The last one over its half-edge. */
  *dart = quotient->n_darts++;
  quotient->dart[*dart] = made;
  builder->before[*dart] = builder->latest[lowest];
  builder->latest[lowest] = *dart;
  return THR_OK;
}

/* ---- copies ---- */

/* Makes a group of the elements of H that map edge e to itself: element k of it is (*element)[k] of
 * H. */
static thr_status edge_stabilizer(const quotient_builder *builder, int e, thr_group *own,
                                  int **element, thr_err *err)
{
  const thr_quotient *quotient = builder->quotient;
  int count = 0, *number = thr_calloc((size_t)quotient->group->order, sizeof *number);
  *element = thr_calloc((size_t)quotient->h->order, sizeof **element);
  *own = (thr_group){0};
  thr_status st = number && *element ? THR_OK : thr_nomem(err);

  /* The elements, and their numbers in the new group. */
  for (int i = 0; i < quotient->h->order && !st; i++)
    if (thr_quotient_image(quotient, i, 2 * e) >> 1 == e) {
      number[quotient->h->element[i]] = count;
      (*element)[count++] = quotient->h->element[i];
    }
  own->order = count;

  /* Its products and inverses. */
  if (!st) {
    own->product = thr_calloc((size_t)count * (size_t)count, sizeof *own->product);
    own->inverse = thr_calloc((size_t)count, sizeof *own->inverse);
    if (!own->product || !own->inverse) st = thr_nomem(err);
  }
  for (int i = 0; i < count && !st; i++) {
    own->inverse[i] = number[quotient->group->inverse[(*element)[i]]];
    for (int k = 0; k < count; k++)
      own->product[i * count + k] =
          number[thr_group_product(quotient->group, (*element)[i], (*element)[k])];
  }

  free(number);
  return st;
}

/* Makes the subgroup of the elements that do not turn edge e round. */
static thr_status edge_keepers(const quotient_builder *builder, int e, const thr_subgroup *subgroup,
                               thr_subgroup *out, thr_err *err)
{
  *out = (thr_subgroup){0, thr_calloc((size_t)subgroup->order, sizeof(int))};
  if (!out->element) return thr_nomem(err);
  for (int i = 0; i < subgroup->order; i++)
    if (thr_quotient_image(builder->quotient, builder->position[subgroup->element[i]], 2 * e) ==
        2 * e)
      out->element[out->order++] = subgroup->element[i];
  return THR_OK;
}

/* Adds the copy type of edge e with this stabilizer, which is taken over, and its darts.
 * stabilizers: order of e's stabilizer in H. */
static thr_status add_copy(quotient_builder *builder, int e, int stabilizers,
                           thr_subgroup *subgroup, thr_err *err)
{
  thr_quotient *quotient = builder->quotient;
  thr_copy_type copy_type = {quotient->edge_orbit[e],
                             e,
                             stabilizers / subgroup->order,
                             quotient->h->order / subgroup->order,
                             false,
                             {-1, -1},
                             0,
                             *subgroup};
  thr_subgroup dart_stabilizer = {0};
  *subgroup = (thr_subgroup){0};

  /* The elements that keep the half-edge fix its dart. */
  thr_status st = is_full(builder)
                      ? fail_too_many(builder, err)
                      : edge_keepers(builder, e, &copy_type.stabilizer, &dart_stabilizer, err);
  if (!st)
    st = thr_grow(&quotient->copy, quotient->n_copies, &builder->copies_capacity,
                  sizeof *quotient->copy, err);

  /* A fold has one dart, any other copy two. */
  if (!st) st = add_dart(builder, 2 * e, &dart_stabilizer, &copy_type.dart[0], err);
  copy_type.fold = dart_stabilizer.order < copy_type.stabilizer.order;
  if (!st && !copy_type.fold)
    st = add_dart(builder, 2 * e + 1, &dart_stabilizer, &copy_type.dart[1], err);

  thr_subgroup_destroy(&dart_stabilizer);
  if (st) {
    thr_subgroup_destroy(&copy_type.stabilizer);
    return st;
  }

  copy_type.layer = quotient->dart[copy_type.dart[0]].layer;
  quotient->copy[quotient->n_copies++] = copy_type;
  return THR_OK;
}

/* Adds the copy types of edge e: a type for each class of subgroups of its stabilizer. */
static thr_status add_copies(quotient_builder *builder, int e, thr_err *err)
{
  thr_group own = {0};
  thr_subgroup_classes classes = {0};
  int *element = NULL;
  /* Subgroups of the edge's stabilizer, up to conjugacy in it. */
  thr_status st = edge_stabilizer(builder, e, &own, &element, err);
  if (!st) st = thr_subgroup_classes_find(&own, builder->most, &classes, err);
  if (!st && !classes.complete) st = fail_too_many(builder, err);

  /* A subgroup of the new group as one of H. */
  for (int k = 0; k < classes.n && !st; k++) {
    for (int i = 0; i < classes.subgroup[k].order; i++)
      classes.subgroup[k].element[i] = element[classes.subgroup[k].element[i]];
    st = add_copy(builder, e, own.order, &classes.subgroup[k], err);
  }

  thr_subgroup_classes_destroy(&classes);
  thr_group_destroy(&own);
  free(element);
  return st;
}

/* ---- order of the darts ---- */

/* A dart type with the number that it had before sorting. */
typedef struct {
  thr_dart_type type;
  int was; /* its number before */
} numbered;

/* Compares dart types by half-edge, then by descending order of the stabilizer, then by its
 * elements. */
static int by_half(const void *a, const void *b)
{
  const thr_dart_type *first = &((const numbered *)a)->type, *second = &((const numbered *)b)->type;

  /* By half-edge, then by order. */
  if (first->half != second->half) return first->half < second->half ? -1 : 1;
  if (first->stabilizer.order != second->stabilizer.order)
    return first->stabilizer.order > second->stabilizer.order ? -1 : 1;

  for (int k = 0; k < first->stabilizer.order; k++)
    if (first->stabilizer.element[k] != second->stabilizer.element[k])
      return first->stabilizer.element[k] < second->stabilizer.element[k] ? -1 : 1;
  return 0;
}

/* Numbers the layers by their first dart types, the trivial one first; becomes: [n_layers] scratch.
 */
static void number_layers(thr_quotient *quotient, int *becomes)
{
  int next = 0;
  /* The trivial layer is 0 if there is one. */
  for (int d = 0; d < quotient->n_darts; d++)
    if (quotient->dart[d].stabilizer.order == 1) next = 1;

  for (int l = 0; l < quotient->n_layers; l++)
    becomes[l] = -1;

  /* In the order of the darts. */
  for (int d = 0; d < quotient->n_darts; d++) {
    int *layer = &quotient->dart[d].layer;
    if (becomes[*layer] < 0) becomes[*layer] = quotient->dart[d].stabilizer.order == 1 ? 0 : next++;
    *layer = becomes[*layer];
  }

  /* Copies follow their darts. */
  for (int c = 0; c < quotient->n_copies; c++)
    quotient->copy[c].layer = becomes[quotient->copy[c].layer];
}

/* Sorts the dart types, and renumbers them in the copy types and in the lists over half-edges. */
static thr_status sort_darts(quotient_builder *builder, thr_err *err)
{
  thr_quotient *quotient = builder->quotient;
  size_t n = (size_t)quotient->n_darts;
  numbered *list = thr_calloc(n, sizeof *list);
  int *becomes = thr_calloc(n, sizeof *becomes); /* there are at most as many layers as darts */
  thr_status st = list && becomes ? THR_OK : thr_nomem(err);
  if (!st) {
    for (int d = 0; d < quotient->n_darts; d++)
      list[d] = (numbered){quotient->dart[d], d};
    qsort(list, n, sizeof *list, by_half);

    /* New numbers, and the lists over half-edges again. */
    memset(builder->latest, -1, 2 * (size_t)quotient->f->n_edges * sizeof *builder->latest);
    assert(builder->before || n == 0);
    for (int d = 0; d < quotient->n_darts; d++) {
      quotient->dart[d] = list[d].type;
      becomes[list[d].was] = d;
      builder->before[d] = builder->latest[quotient->dart[d].half];
      builder->latest[quotient->dart[d].half] = d;
    }

    /* Copies. */
    for (int c = 0; c < quotient->n_copies; c++)
      for (int i = 0; i < 2; i++)
        if (quotient->copy[c].dart[i] >= 0)
          quotient->copy[c].dart[i] = becomes[quotient->copy[c].dart[i]];
    number_layers(quotient, becomes);
  }

  free(list);
  free(becomes);
  return st;
}

/* ---- turns ---- */

/* Returns the mean angle of a turn over its images. */
static double mean_angle(const thr_quotient *quotient, int a, int b)
{
  double sum = 0;
  for (int i = 0; i < quotient->h->order; i++)
    sum += thr_turn_angle(quotient->f, thr_quotient_image(quotient, i, a) ^ 1,
                          thr_quotient_image(quotient, i, b));
  return sum / quotient->h->order;
}

/* Tells whether the i-th element of H normalizes a subgroup. */
static bool normalizes(const quotient_builder *builder, int i, const thr_subgroup *subgroup)
{
  const thr_quotient *quotient = builder->quotient;
  for (int k = 0; k < subgroup->order; k++)
    if (!thr_subgroup_has(
            subgroup, conjugated(quotient->group, quotient->h->element[i], subgroup->element[k])))
      return false;
  return true;
}

/* Returns the lowest image of a half-edge under the elements of N. */
static int lowest_by_normal(const quotient_builder *builder, int half)
{
  int lowest = half;
  for (int k = 0; k < builder->n_normal; k++) {
    int to = thr_quotient_image(builder->quotient, builder->normal[k], half);
    if (to < lowest) lowest = to;
  }
  return lowest;
}

/* Returns an element that exchanges the darts (own_half, subgroup) and (other_half, subgroup) and
 * is not in the subgroup itself; -1 = none. */
static int find_exchange(const quotient_builder *builder, int own_half, int other_half,
                         const thr_subgroup *subgroup)
{
  const thr_quotient *quotient = builder->quotient;
  for (int k = 0; k < builder->n_at; k++) {
    int i = builder->at[k], g = quotient->h->element[i];
    /* It exchanges the half-edges, is an involution modulo the subgroup, and normalizes it. */
    if (thr_quotient_image(quotient, i, own_half) == other_half &&
        thr_quotient_image(quotient, i, other_half) == own_half && !thr_subgroup_has(subgroup, g) &&
        thr_subgroup_has(subgroup, thr_group_product(quotient->group, g, g)) &&
        normalizes(builder, i, subgroup))
      return g;
  }
  return -1;
}

/* Tells whether the turn from own_half to other_half, both with this stabilizer and of one type, is
 * listed as seen from own_half. The turn seen the other way round is the same one: the lower of the
 * two stands for both. */
static bool lower_side(const quotient_builder *builder, int own_half, int other_half,
                       const thr_subgroup *subgroup)
{
  for (int k = 0; k < builder->n_at; k++)
    if (thr_quotient_image(builder->quotient, builder->at[k], other_half) == own_half &&
        normalizes(builder, builder->at[k], subgroup))
      return other_half <= lowest_by_normal(builder, thr_quotient_image(builder->quotient,
                                                                        builder->at[k], own_half));
  return false;
}

/* Adds a turn from the representative of a dart type to this half-edge of type `other`; element >=
 * 0: a self pair, whose orbits have half as many turns as darts. */
static thr_status add_pair(quotient_builder *builder, int dart, int other, int half, int element,
                           thr_err *err)
{
  thr_quotient *quotient = builder->quotient;
  if (is_full(builder)) return fail_too_many(builder, err);
  thr_status st = thr_grow(&quotient->pair, quotient->n_pairs, &builder->pairs_capacity,
                           sizeof *quotient->pair, err);
  if (st) return st;

  /* One orbit of darts makes as many turns, a self pair half as many. */
  thr_pair_type pair_type = {
      {dart, other}, {quotient->dart[dart].half, half}, element >= 0, quotient->dart[dart].darts, 0,
      element};
  if (pair_type.self) pair_type.turns /= 2;
  pair_type.angle = mean_angle(quotient, pair_type.half[0], half);

  quotient->pair[quotient->n_pairs++] = pair_type;
  return THR_OK;
}

/* Adds the turns from the representative of a dart type to darts of its own and of later types.
 * Each stands for all its images under N, the elements that fix the half-edge and normalize the
 * stabilizer S. */
static thr_status add_pairs(quotient_builder *builder, int dart, thr_err *err)
{
  const thr_quotient *quotient = builder->quotient;
  const thr_frame *frame = quotient->f;
  const thr_subgroup *subgroup = &quotient->dart[dart].stabilizer;
  int own_half = quotient->dart[dart].half, node = thr_tail(frame, own_half), lowest;
  thr_status st = check_time(builder, err);

  /* H_v, and N within it. */
  builder->n_at = builder->n_normal = 0;
  for (int i = 0; i < quotient->h->order; i++) {
    if (thr_tail(frame, thr_quotient_image(quotient, i, own_half)) != node) continue;
    builder->at[builder->n_at++] = i;
    if (thr_quotient_image(quotient, i, own_half) == own_half && normalizes(builder, i, subgroup))
      builder->normal[builder->n_normal++] = i;
  }

  /* To half-edges of the node that S fixes, the lowest under N each. */
  for (int k = frame->first[node]; k < frame->first[node + 1] && !st; k++) {
    int half = frame->half[k];
    bool fixed = lowest_by_normal(builder, half) == half;
    for (int i = 0; i < subgroup->order && fixed; i++)
      fixed = thr_quotient_image(quotient, builder->position[subgroup->element[i]], half) == half;
    if (!fixed) continue;

    int other = find_dart(builder, half, subgroup, &lowest);
    assert(other >= 0); /* a subgroup of the edge's stabilizer, so it made a copy type */
    if (other < dart || (other == dart && !lower_side(builder, own_half, half, subgroup))) continue;

    st = add_pair(builder, dart, other, half, -1, err);
    int element = other == dart ? find_exchange(builder, own_half, half, subgroup) : -1;
    if (!st && element >= 0) st = add_pair(builder, dart, dart, half, element, err);
  }
  return st;
}

/* Compares pair types by their dart types, then by the second half-edge, self pairs last. */
static int by_darts(const void *a, const void *b)
{
  const thr_pair_type *first = a, *second = b;
  int key[4] = {first->dart[0] - second->dart[0], first->dart[1] - second->dart[1],
                first->half[1] - second->half[1], first->self - second->self};
  for (int i = 0; i < 4; i++)
    if (key[i] != 0) return key[i];
  return 0;
}

/* ---- the quotient ---- */

/* Allocates what the builder needs; the caller destroys it also on failure. */
static thr_status build_init(quotient_builder *builder, thr_err *err)
{
  const thr_quotient *quotient = builder->quotient;
  size_t order = (size_t)quotient->group->order, halves = 2 * (size_t)quotient->f->n_edges;
  builder->position = thr_scratch_array(&builder->own, order, sizeof *builder->position);
  builder->latest = thr_scratch_array(&builder->own, halves, sizeof *builder->latest);
  builder->set = thr_scratch_array(&builder->own, order, sizeof *builder->set);
  builder->least = thr_scratch_array(&builder->own, order, sizeof *builder->least);
  builder->normal =
      thr_scratch_array(&builder->own, (size_t)quotient->h->order, sizeof *builder->normal);
  builder->at = thr_scratch_array(&builder->own, (size_t)quotient->h->order, sizeof *builder->at);

  if (thr_scratch_check(&builder->own, err)) return THR_ENOMEM;

  /* No element has a place, and no half-edge a dart type yet. */
  memset(builder->position, -1, order * sizeof *builder->position);
  memset(builder->latest, -1, halves * sizeof *builder->latest);
  for (int i = 0; i < quotient->h->order; i++)
    builder->position[quotient->h->element[i]] = i;
  return THR_OK;
}

static void build_destroy(quotient_builder *builder)
{
  for (int layer = 0; builder->s_class && layer < builder->quotient->n_layers; layer++)
    thr_subgroup_destroy(&builder->s_class[layer]);
  free(builder->s_class);
  thr_scratch_free(&builder->own);
  free(builder->before);
}

thr_status thr_quotient_make(thr_quotient *quotient, const thr_frame *frame, const thr_group *group,
                             const thr_subgroup *subgroup, int most, const thr_limits *limits,
                             thr_err *err)
{
  *quotient = (thr_quotient){.f = frame, .group = group, .h = subgroup};
  quotient_builder builder = {.quotient = quotient, .limits = limits, .most = most};

  /* The group must be one of the framework's nodes. */
  if (group->degree != frame->n_nodes) {
    *quotient = (thr_quotient){0};
    thr_fail(err, THR_EINPUT, "the group permutes %d nodes, the framework has %d", group->degree,
             frame->n_nodes);
    return THR_EINPUT;
  }

  /* Images and orbits, then copies with their darts, edge orbit by edge orbit. */
  thr_status st = build_init(&builder, err);
  if (!st) st = map_halves(&builder, err);
  if (!st) st = find_edge_orbits(quotient, err);
  for (int e = 0, orbit = 0; e < frame->n_edges && !st; e++)
    if (quotient->edge_orbit[e] == orbit) {
      st = add_copies(&builder, e, err);
      orbit++;
    }

  /* Darts in their order, then the turns between them. */
  if (!st) st = sort_darts(&builder, err);
  for (int d = 0; d < quotient->n_darts && !st; d++)
    st = add_pairs(&builder, d, err);
  if (!st && quotient->n_pairs > 0)
    qsort(quotient->pair, (size_t)quotient->n_pairs, sizeof *quotient->pair, by_darts);

  build_destroy(&builder);
  if (st) thr_quotient_destroy(quotient);
  return st;
}

thr_status thr_quotient_init(thr_quotient *quotient, const thr_frame *frame, const thr_group *group,
                             const thr_subgroup *subgroup, int most, thr_err *err)
{
  const thr_limits none = {0};
  return thr_quotient_make(quotient, frame, group, subgroup, most, &none, err);
}

void thr_quotient_destroy(thr_quotient *quotient)
{
  for (int c = 0; c < quotient->n_copies; c++)
    thr_subgroup_destroy(&quotient->copy[c].stabilizer);
  for (int d = 0; d < quotient->n_darts; d++)
    thr_subgroup_destroy(&quotient->dart[d].stabilizer);
  free(quotient->half_image);
  free(quotient->edge_orbit);
  free(quotient->orbit_size);
  free(quotient->orbit_length);
  free(quotient->copy);
  free(quotient->dart);
  free(quotient->pair);
  *quotient = (thr_quotient){0};
}
