/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threadings that a group H of automorphisms maps to themselves, counted by orbits
 * (docs/method.md).
 *
 * A symmetric threading is an H-set of copies (passes) over the edges with an H-invariant pairing
 * of their darts (a dart is one end of a copy) at the nodes. Fewer conditions are wrong: an
 * H-invariant T-join with even degrees need not have an invariant pairing. copy type (e, K)  an
 * orbit of copies over the orbit of edge e; K <= H_e, up to conjugacy in H_e, maps one copy to
 * itself. It adds [H_e : K] passes to e. If an element of K turns e round, the copy is a fold: its
 * trail is mapped to its reverse. dart type (h, S)  an orbit of darts over half-edge h with
 * stabilizer S <= H_h. A copy type without fold has two dart orbits, of types (h, K) and (h ^ 1,
 * K); with a fold one, of type (h, S) with S = the elements of K that do not turn e round. pair
 * type         an orbit of turns at a node: darts a, b with equal stabilizers over half-edges of
 * one node; over one half-edge the cord turns back into its edge. If some g in H_v maps a to b, a
 * pair within one dart orbit (a "self" pair) needs such a g that also maps b to a; it folds the
 * trail at the node. Two different dart orbits of one type can be paired in any case. The
 * stabilizer of a dart is that of all its trail (the layer): a trail over an edge in a mirror,
 * passed by one fixed copy, stays in the mirror. In the quotient a trail's orbit is a path between
 * two terminals (cord end or fold) or a circle. */
#include "symmetry/group/group.h"
#include "graph/scratch.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Scratch of thr_quotient_init. Sets of elements of G are arrays of bool by element number. */
typedef struct {
  thr_quotient *q;
  const thr_limits *limits;
  int most;
  int *position; /* [order of G] of an element within H, -1 = not in H */
  int copies_capacity, darts_capacity, pairs_capacity;
  int *latest; /* [2 * n_edges] dart type over a half-edge that was added last, -1 = none */
  int *before; /* [n_darts] the one added before it over the same half-edge */
  int before_capacity;
  bool *set, *least;     /* [order of G] */
  int *normal, *at;      /* [order of H] positions: of N, of H_v (see add_pairs) */
  int n_normal, n_at;    /* how many */
  thr_subgroup *s_class; /* [n_layers] least conjugate of each layer's stabilizers */
  int classes_capacity;
  thr_scratch own; /* the arrays */
} build;

static int image(const thr_quotient *quotient, int i, int half)
{
  return quotient->half_image[(size_t)i * 2 * (size_t)quotient->f->n_edges + (size_t)half];
}

static int product(const thr_group *group, int a, int b)
{
  return group->product[(size_t)a * (size_t)group->order + (size_t)b];
}

static int conjugated(const thr_group *group, int by, int a)
{
  return product(group, product(group, by, a), group->inverse[by]);
}

static thr_status too_many(const build *b, thr_err *err)
{
  return thr_fail(err, THR_ELIMIT,
                  "a group of order %d makes more than %d types of passes and turns",
                  b->q->h->order, b->most);
}

static bool full(const build *b)
{
  return b->q->n_copies + b->q->n_darts + b->q->n_pairs >= b->most;
}

static thr_status check_time(const build *b, thr_err *err)
{
  return thr_limits_stop(b->limits)
             ? thr_fail(err, THR_ELIMIT, "the time was too short for the types of passes and turns")
             : THR_OK;
}

/* ---- images and orbits ---- */

static int half_between(const thr_frame *frame, int from, int to)
{
  int e = thr_edge_joining(frame, from, to);
  return e < 0 ? -1 : 2 * e + (frame->edge[e][1] == from);
}

static thr_status map_halves(const build *b, thr_err *err)
{
  thr_quotient *quotient = b->q;
  const thr_frame *frame = quotient->f;
  size_t halves = 2 * (size_t)frame->n_edges;
  quotient->half_image =
      thr_calloc((size_t)quotient->h->order * halves, sizeof *quotient->half_image);
  if (!quotient->half_image) return thr_nomem(err);
  for (int i = 0; i < quotient->h->order; i++) {
    thr_status st = check_time(b, err);
    if (st) return st;
    const int *to =
        &quotient->group->image[(size_t)quotient->h->element[i] * (size_t)quotient->group->degree];
    for (int h = 0; h < 2 * frame->n_edges; h += 2) {
      int half = half_between(frame, to[thr_tail(frame, h)], to[thr_head(frame, h)]);
      if (half < 0)
        return thr_fail(err, THR_EINPUT, "element %d of the group is no automorphism",
                        quotient->h->element[i]);
      quotient->half_image[(size_t)i * halves + (size_t)h] = half;
      quotient->half_image[(size_t)i * halves + (size_t)h + 1] = half ^ 1;
    }
  }
  return THR_OK;
}

static thr_status find_edge_orbits(thr_quotient *quotient, thr_err *err)
{
  size_t m = (size_t)quotient->f->n_edges;
  quotient->edge_orbit = thr_calloc(m, sizeof *quotient->edge_orbit);
  quotient->orbit_size = thr_calloc(m, sizeof *quotient->orbit_size);
  quotient->orbit_length = thr_calloc(m, sizeof *quotient->orbit_length);
  if (!quotient->edge_orbit || !quotient->orbit_size || !quotient->orbit_length)
    return thr_nomem(err);
  memset(quotient->edge_orbit, -1, m * sizeof *quotient->edge_orbit);
  for (int e = 0; e < quotient->f->n_edges; e++) {
    if (quotient->edge_orbit[e] >= 0) continue;
    int orbit = quotient->n_edge_orbits++;
    for (int i = 0; i < quotient->h->order; i++) {
      int to = image(quotient, i, 2 * e) >> 1;
      if (quotient->edge_orbit[to] >= 0) continue;
      quotient->edge_orbit[to] = orbit;
      quotient->orbit_size[orbit]++;
      quotient->orbit_length[orbit] += quotient->f->length[to];
    }
  }
  return THR_OK;
}

/* ---- sets of elements ---- */

static bool less_set(const bool *a, const bool *b, int n)
{
  for (int g = 0; g < n; g++)
    if (a[g] != b[g]) return a[g];
  return false;
}

/* Marks the conjugates of subgroup by an element in set[order of G]. */
static void mark_conjugate(const thr_group *group, int by, const thr_subgroup *subgroup, bool *set)
{
  memset(set, 0, (size_t)group->order * sizeof *set);
  for (int k = 0; k < subgroup->order; k++)
    set[conjugated(group, by, subgroup->element[k])] = true;
}

static thr_status collect(const bool *set, int order, thr_subgroup *out, thr_err *err)
{
  int n = 0;
  for (int g = 0; g < order; g++)
    n += set[g];
  *out = (thr_subgroup){n, thr_calloc((size_t)n, sizeof(int))};
  if (!out->element) return thr_nomem(err);
  for (int g = 0, k = 0; g < order; g++)
    if (set[g]) out->element[k++] = g;
  return THR_OK;
}

static bool holds_exactly(const bool *set, int order, const thr_subgroup *subgroup)
{
  int n = 0;
  for (int g = 0; g < order; g++)
    n += set[g];
  for (int k = 0; k < subgroup->order && n == subgroup->order; k++)
    if (!set[subgroup->element[k]]) return false;
  return n == subgroup->order;
}

/* Leaves the least conjugate of subgroup in b->least, by elements that move half to where no
 * element moves it lower (half < 0: by any element). Returns that lowest image. */
static int least_conjugate(const build *b, int half, const thr_subgroup *subgroup)
{
  const thr_quotient *quotient = b->q;
  int order = quotient->group->order, lowest = half;
  for (int i = 0; half >= 0 && i < quotient->h->order; i++)
    if (image(quotient, i, half) < lowest) lowest = image(quotient, i, half);
  bool first = true;
  for (int i = 0; i < quotient->h->order; i++) {
    if (half >= 0 && image(quotient, i, half) != lowest) continue;
    if (!first && subgroup->order == 1) break;
    mark_conjugate(quotient->group, quotient->h->element[i], subgroup, b->set);
    if (first || less_set(b->set, b->least, order))
      memcpy(b->least, b->set, (size_t)order * sizeof *b->least);
    first = false;
  }
  return lowest;
}

/* ---- darts ---- */

/* Type of the dart (half, s), or -1; leaves the canonical stabilizer in b->least and its half-edge
 * in *lowest. */
static int find_dart(const build *b, int half, const thr_subgroup *subgroup, int *lowest)
{
  *lowest = least_conjugate(b, half, subgroup);
  for (int d = b->latest[*lowest]; d >= 0; d = b->before[d])
    if (holds_exactly(b->least, b->q->group->order, &b->q->dart[d].stabilizer)) return d;
  return -1;
}

static thr_status find_layer(build *b, const thr_subgroup *subgroup, int *layer, thr_err *err)
{
  thr_quotient *quotient = b->q;
  int order = quotient->group->order;
  least_conjugate(b, -1, subgroup);
  for (*layer = 0; *layer < quotient->n_layers; ++*layer)
    if (holds_exactly(b->least, order, &b->s_class[*layer])) return THR_OK;
  thr_status st =
      thr_grow(&b->s_class, quotient->n_layers, &b->classes_capacity, sizeof *b->s_class, err);
  if (!st) st = collect(b->least, order, &b->s_class[quotient->n_layers], err);
  if (!st) quotient->n_layers++;
  return st;
}

static thr_status add_dart(build *b, int half, const thr_subgroup *subgroup, int *dart,
                           thr_err *err)
{
  thr_quotient *quotient = b->q;
  int lowest;
  thr_status st = check_time(b, err);
  if (st) return st;
  *dart = find_dart(b, half, subgroup, &lowest);
  if (*dart >= 0) return THR_OK;
  if (full(b)) return too_many(b, err);
  assert(subgroup->order > 0);
  thr_dart_type made = {.half = lowest, .darts = quotient->h->order / subgroup->order};
  st =
      thr_grow(&quotient->dart, quotient->n_darts, &b->darts_capacity, sizeof *quotient->dart, err);
  if (!st)
    st = thr_grow(&b->before, quotient->n_darts, &b->before_capacity, sizeof *b->before, err);
  if (!st) st = collect(b->least, quotient->group->order, &made.stabilizer, err);
  if (!st) st = find_layer(b, &made.stabilizer, &made.layer, err);
  if (st) {
    thr_subgroup_destroy(&made.stabilizer);
    return st;
  }
  *dart = quotient->n_darts++;
  quotient->dart[*dart] = made;
  b->before[*dart] = b->latest[lowest];
  b->latest[lowest] = *dart;
  return THR_OK;
}

/* ---- copies ---- */

/* The elements of H that map edge e to itself, as a group of their own: element k of it is
 * (*element)[k]. */
static thr_status edge_stabilizer(const build *b, int e, thr_group *own, int **element,
                                  thr_err *err)
{
  const thr_quotient *quotient = b->q;
  int n = 0, *number = thr_calloc((size_t)quotient->group->order, sizeof *number);
  *element = thr_calloc((size_t)quotient->h->order, sizeof **element);
  *own = (thr_group){0};
  thr_status st = number && *element ? THR_OK : thr_nomem(err);
  for (int i = 0; i < quotient->h->order && !st; i++)
    if (image(quotient, i, 2 * e) >> 1 == e) {
      number[quotient->h->element[i]] = n;
      (*element)[n++] = quotient->h->element[i];
    }
  own->order = n;
  if (!st) {
    own->product = thr_calloc((size_t)n * (size_t)n, sizeof *own->product);
    own->inverse = thr_calloc((size_t)n, sizeof *own->inverse);
    if (!own->product || !own->inverse) st = thr_nomem(err);
  }
  for (int i = 0; i < n && !st; i++) {
    own->inverse[i] = number[quotient->group->inverse[(*element)[i]]];
    for (int k = 0; k < n; k++)
      own->product[i * n + k] = number[product(quotient->group, (*element)[i], (*element)[k])];
  }
  free(number);
  return st;
}

/* The elements of subgroup that do not turn edge e round. */
static thr_status keepers(const build *b, int e, const thr_subgroup *subgroup, thr_subgroup *out,
                          thr_err *err)
{
  *out = (thr_subgroup){0, thr_calloc((size_t)subgroup->order, sizeof(int))};
  if (!out->element) return thr_nomem(err);
  for (int i = 0; i < subgroup->order; i++)
    if (image(b->q, b->position[subgroup->element[i]], 2 * e) == 2 * e)
      out->element[out->order++] = subgroup->element[i];
  return THR_OK;
}

/* Takes over subgroup. stabilizers: of e in H. */
static thr_status add_copy(build *b, int e, int stabilizers, thr_subgroup *subgroup, thr_err *err)
{
  thr_quotient *quotient = b->q;
  thr_copy_type copy_type = {quotient->edge_orbit[e],
                             e,
                             stabilizers / subgroup->order,
                             quotient->h->order / subgroup->order,
                             false,
                             {-1, -1},
                             0,
                             *subgroup};
  thr_subgroup s = {0};
  *subgroup = (thr_subgroup){0};
  thr_status st = full(b) ? too_many(b, err) : keepers(b, e, &copy_type.stabilizer, &s, err);
  if (!st)
    st = thr_grow(&quotient->copy, quotient->n_copies, &b->copies_capacity, sizeof *quotient->copy,
                  err);
  if (!st) st = add_dart(b, 2 * e, &s, &copy_type.dart[0], err);
  copy_type.fold = s.order < copy_type.stabilizer.order;
  if (!st && !copy_type.fold) st = add_dart(b, 2 * e + 1, &s, &copy_type.dart[1], err);
  thr_subgroup_destroy(&s);
  if (st) {
    thr_subgroup_destroy(&copy_type.stabilizer);
    return st;
  }
  copy_type.layer = quotient->dart[copy_type.dart[0]].layer;
  quotient->copy[quotient->n_copies++] = copy_type;
  return THR_OK;
}

static thr_status add_copies(build *b, int e, thr_err *err)
{
  thr_group own = {0};
  thr_subgroup_classes classes = {0};
  int *element = NULL;
  thr_status st = edge_stabilizer(b, e, &own, &element, err);
  if (!st) st = thr_subgroup_classes_find(&own, b->most, &classes, err);
  if (!st && !classes.complete) st = too_many(b, err);
  for (int k = 0; k < classes.n && !st; k++) {
    for (int i = 0; i < classes.subgroup[k].order; i++)
      classes.subgroup[k].element[i] = element[classes.subgroup[k].element[i]];
    st = add_copy(b, e, own.order, &classes.subgroup[k], err);
  }
  thr_subgroup_classes_destroy(&classes);
  thr_group_destroy(&own);
  free(element);
  return st;
}

/* ---- order of the darts ---- */

typedef struct {
  thr_dart_type type;
  int was; /* its number before */
} numbered;

static int by_half(const void *a, const void *b)
{
  const thr_dart_type *dart_type = &((const numbered *)a)->type, *q = &((const numbered *)b)->type;
  if (dart_type->half != q->half) return dart_type->half < q->half ? -1 : 1;
  if (dart_type->stabilizer.order != q->stabilizer.order)
    return dart_type->stabilizer.order > q->stabilizer.order ? -1 : 1;
  for (int k = 0; k < dart_type->stabilizer.order; k++)
    if (dart_type->stabilizer.element[k] != q->stabilizer.element[k])
      return dart_type->stabilizer.element[k] < q->stabilizer.element[k] ? -1 : 1;
  return 0;
}

/* Numbers layers by their first dart, the trivial one first; becomes: [n_layers] scratch. */
static void number_layers(thr_quotient *quotient, int *becomes)
{
  int next = 0;
  for (int d = 0; d < quotient->n_darts; d++)
    if (quotient->dart[d].stabilizer.order == 1) next = 1;
  for (int l = 0; l < quotient->n_layers; l++)
    becomes[l] = -1;
  for (int d = 0; d < quotient->n_darts; d++) {
    int *layer = &quotient->dart[d].layer;
    if (becomes[*layer] < 0) becomes[*layer] = quotient->dart[d].stabilizer.order == 1 ? 0 : next++;
    *layer = becomes[*layer];
  }
  for (int c = 0; c < quotient->n_copies; c++)
    quotient->copy[c].layer = becomes[quotient->copy[c].layer];
}

static thr_status sort_darts(build *b, thr_err *err)
{
  thr_quotient *quotient = b->q;
  size_t n = (size_t)quotient->n_darts;
  numbered *list = thr_calloc(n, sizeof *list);
  int *becomes = thr_calloc(n, sizeof *becomes); /* at most as many layers as darts */
  thr_status st = list && becomes ? THR_OK : thr_nomem(err);
  if (!st) {
    for (int d = 0; d < quotient->n_darts; d++)
      list[d] = (numbered){quotient->dart[d], d};
    qsort(list, n, sizeof *list, by_half);
    memset(b->latest, -1, 2 * (size_t)quotient->f->n_edges * sizeof *b->latest);
    assert(b->before || n == 0);
    for (int d = 0; d < quotient->n_darts; d++) {
      quotient->dart[d] = list[d].type;
      becomes[list[d].was] = d;
      b->before[d] = b->latest[quotient->dart[d].half];
      b->latest[quotient->dart[d].half] = d;
    }
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

static double mean_angle(const thr_quotient *quotient, int a, int b)
{
  double sum = 0;
  for (int i = 0; i < quotient->h->order; i++)
    sum += thr_turn_angle(quotient->f, image(quotient, i, a) ^ 1, image(quotient, i, b));
  return sum / quotient->h->order;
}

static bool normalizes(const build *b, int i, const thr_subgroup *subgroup)
{
  const thr_quotient *quotient = b->q;
  for (int k = 0; k < subgroup->order; k++)
    if (!thr_subgroup_has(
            subgroup, conjugated(quotient->group, quotient->h->element[i], subgroup->element[k])))
      return false;
  return true;
}

static int lowest_by_normal(const build *b, int half)
{
  int lowest = half;
  for (int k = 0; k < b->n_normal; k++) {
    int to = image(b->q, b->normal[k], half);
    if (to < lowest) lowest = to;
  }
  return lowest;
}

/* An element that exchanges the darts (a, s) and (b2, s), without being in subgroup itself; -1 =
 * none. */
static int find_exchange(const build *b, int a, int b2, const thr_subgroup *subgroup)
{
  const thr_quotient *quotient = b->q;
  for (int k = 0; k < b->n_at; k++) {
    int i = b->at[k], g = quotient->h->element[i];
    if (image(quotient, i, a) == b2 && image(quotient, i, b2) == a &&
        !thr_subgroup_has(subgroup, g) &&
        thr_subgroup_has(subgroup, product(quotient->group, g, g)) && normalizes(b, i, subgroup))
      return g;
  }
  return -1;
}

/* Is the turn from half-edge a to b2, both with stabilizer subgroup and of one type, to be listed
 * as seen from a? The turn seen the other way round is the same one: the lower of the two stands
 * for both. */
static bool lower_side(const build *b, int a, int b2, const thr_subgroup *subgroup)
{
  for (int k = 0; k < b->n_at; k++)
    if (image(b->q, b->at[k], b2) == a && normalizes(b, b->at[k], subgroup))
      return b2 <= lowest_by_normal(b, image(b->q, b->at[k], a));
  return false;
}

static thr_status add_pair(build *b, int d, int other, int half, int element, thr_err *err)
{
  thr_quotient *quotient = b->q;
  if (full(b)) return too_many(b, err);
  thr_status st =
      thr_grow(&quotient->pair, quotient->n_pairs, &b->pairs_capacity, sizeof *quotient->pair, err);
  if (st) return st;
  thr_pair_type pair_type = {
      {d, other}, {quotient->dart[d].half, half}, element >= 0, quotient->dart[d].darts, 0,
      element};
  if (pair_type.self) pair_type.turns /= 2;
  pair_type.angle = mean_angle(quotient, pair_type.half[0], half);
  quotient->pair[quotient->n_pairs++] = pair_type;
  return THR_OK;
}

/* The turns from the representative of dart type d to darts of its own and later types. */
static thr_status add_pairs(build *b, int d, thr_err *err)
{
  const thr_quotient *quotient = b->q;
  const thr_frame *frame = quotient->f;
  const thr_subgroup *subgroup = &quotient->dart[d].stabilizer;
  int a = quotient->dart[d].half, v = thr_tail(frame, a), lowest;
  thr_status st = check_time(b, err);
  b->n_at = b->n_normal = 0;
  for (int i = 0; i < quotient->h->order; i++) {
    if (thr_tail(frame, image(quotient, i, a)) != v) continue;
    b->at[b->n_at++] = i;
    if (image(quotient, i, a) == a && normalizes(b, i, subgroup)) b->normal[b->n_normal++] = i;
  }
  for (int k = frame->first[v]; k < frame->first[v + 1] && !st; k++) {
    int half = frame->half[k];
    bool fixed = lowest_by_normal(b, half) == half;
    for (int i = 0; i < subgroup->order && fixed; i++)
      fixed = image(quotient, b->position[subgroup->element[i]], half) == half;
    if (!fixed) continue;
    int other = find_dart(b, half, subgroup, &lowest);
    assert(other >= 0); /* a subgroup of the edge's stabilizer, so it made a copy type */
    if (other < d || (other == d && !lower_side(b, a, half, subgroup))) continue;
    st = add_pair(b, d, other, half, -1, err);
    int element = other == d ? find_exchange(b, a, half, subgroup) : -1;
    if (!st && element >= 0) st = add_pair(b, d, d, half, element, err);
  }
  return st;
}

static int by_darts(const void *a, const void *b)
{
  const thr_pair_type *pair_type = a, *q = b;
  int key[4] = {pair_type->dart[0] - q->dart[0], pair_type->dart[1] - q->dart[1],
                pair_type->half[1] - q->half[1], pair_type->self - q->self};
  for (int i = 0; i < 4; i++)
    if (key[i] != 0) return key[i];
  return 0;
}

/* ---- all ---- */

static thr_status build_init(build *b, thr_err *err)
{
  const thr_quotient *quotient = b->q;
  size_t order = (size_t)quotient->group->order, halves = 2 * (size_t)quotient->f->n_edges;
  b->position = thr_scratch_array(&b->own, order, sizeof *b->position);
  b->latest = thr_scratch_array(&b->own, halves, sizeof *b->latest);
  b->set = thr_scratch_array(&b->own, order, sizeof *b->set);
  b->least = thr_scratch_array(&b->own, order, sizeof *b->least);
  b->normal = thr_scratch_array(&b->own, (size_t)quotient->h->order, sizeof *b->normal);
  b->at = thr_scratch_array(&b->own, (size_t)quotient->h->order, sizeof *b->at);
  if (thr_scratch_check(&b->own, err)) return THR_ENOMEM;
  memset(b->position, -1, order * sizeof *b->position);
  memset(b->latest, -1, halves * sizeof *b->latest);
  for (int i = 0; i < quotient->h->order; i++)
    b->position[quotient->h->element[i]] = i;
  return THR_OK;
}

static void build_destroy(build *b)
{
  for (int l = 0; b->s_class && l < b->q->n_layers; l++)
    thr_subgroup_destroy(&b->s_class[l]);
  free(b->s_class);
  thr_scratch_free(&b->own);
  free(b->before);
}

thr_status thr_quotient_make(thr_quotient *quotient, const thr_frame *frame, const thr_group *group,
                             const thr_subgroup *subgroup, int most, const thr_limits *limits,
                             thr_err *err)
{
  *quotient = (thr_quotient){.f = frame, .group = group, .h = subgroup};
  build b = {.q = quotient, .limits = limits, .most = most};
  if (group->degree != frame->n_nodes) {
    *quotient = (thr_quotient){0};
    thr_fail(err, THR_EINPUT, "the group permutes %d nodes, the framework has %d", group->degree,
             frame->n_nodes);
    return THR_EINPUT;
  }
  thr_status st = build_init(&b, err);
  if (!st) st = map_halves(&b, err);
  if (!st) st = find_edge_orbits(quotient, err);
  for (int e = 0, orbit = 0; e < frame->n_edges && !st; e++)
    if (quotient->edge_orbit[e] == orbit) {
      st = add_copies(&b, e, err);
      orbit++;
    }
  if (!st) st = sort_darts(&b, err);
  for (int d = 0; d < quotient->n_darts && !st; d++)
    st = add_pairs(&b, d, err);
  if (!st && quotient->n_pairs > 0)
    qsort(quotient->pair, (size_t)quotient->n_pairs, sizeof *quotient->pair, by_darts);
  build_destroy(&b);
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
