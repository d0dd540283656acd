/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rules out columns of the programme of a symmetric cover: columns that no cover has, and columns
 * that some best cover does without. Their upper bound becomes 0, and a copy type that is then
 * alone in its edge orbit gets a lower bound.
 *
 * Ruled out are, in this order:
 *   - copies that are exchanged by elements which move no node of their component;
 *   - where every cord is open, copies whose trails come to no node where a cord may end;
 *   - with solid beads, turns back into an edge where other partners are certain;
 *   - copies whose trails get stuck: they can neither turn nor end.
 *
 * Example: an edge in a mirror that ends at a node with no other edge in the mirror. What passes it
 * once stays in the mirror, and is stuck at that node unless it may end or turn back there. */
#include "graph/arrays.h"
#include "symmetry/cover/cover.h"

#include <stdlib.h>
#include <string.h>

/* Sets moves[c * order + i] where the i-th element of h moves a node of component c. */
static void find_moves(const thr_quotient *quotient, const int *component, bool *moves)
{
  int order = quotient->h->order;
  for (int i = 0; i < order; i++) {
    const int *image =
        &quotient->group->image[(size_t)quotient->h->element[i] * (size_t)quotient->f->n_nodes];
    for (int node = 0; node < quotient->f->n_nodes; node++)
      if (image[node] != node) moves[(size_t)component[node] * (size_t)order + (size_t)i] = true;
  }
}

/* Rules out copies that are exchanged by an element which moves no node of their component: such an
 * element is to map the component's cords to themselves. That costs no cord: of several copies that
 * these elements exchange, each could do what its image does. */
static thr_status rule_out_exchanged(thr_programme *programme, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  int count = 0, order = quotient->h->order,
      *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  bool *fixed = thr_calloc((size_t)quotient->group->order, sizeof *fixed), *moves = NULL;
  thr_status st = component && fixed ? thr_frame_components(quotient->f, component, &count, err)
                                     : thr_nomem(err);

  /* With one component only the identity moves no node. */
  if (!st && count > 1) {
    moves = thr_calloc((size_t)count * (size_t)order, sizeof *moves);
    if (!moves) st = thr_nomem(err);
  }
  if (!st && moves) find_moves(quotient, component, moves);

  /* A copy type stays if its stabilizer has all elements that leave its component alone. */
  for (int copy = 0; copy < quotient->n_copies && !st && moves; copy++) {
    const thr_subgroup *subgroup = &quotient->copy[copy].stabilizer;
    const bool *moved =
        &moves[(size_t)component[quotient->f->edge[quotient->copy[copy].edge][0]] * (size_t)order];
    for (int i = 0; i < subgroup->order; i++)
      fixed[subgroup->element[i]] = true;
    for (int i = 0; i < order; i++)
      if (!moved[i] && !fixed[quotient->h->element[i]]) programme->most[copy] = 0;
    for (int i = 0; i < subgroup->order; i++)
      fixed[subgroup->element[i]] = false;
  }

  free(component);
  free(fixed);
  free(moves);
  return st;
}

/* ---- copy types by orbit ---- */

/* Returns the first copy type of every orbit of edges (copy types of one orbit follow one another):
 * first[n_edge_orbits], owned by the caller, or NULL without memory. */
static int *find_first_copies(const thr_quotient *quotient)
{
  int *first = thr_calloc((size_t)quotient->n_edge_orbits, sizeof *first);
  for (int copy = quotient->n_copies - 1; copy >= 0 && first; copy--)
    first[quotient->copy[copy].edge_orbit] = copy;
  return first;
}

/* Tells whether c is a copy type of this orbit of edges. */
static bool is_copy_of(const thr_quotient *quotient, int c, int orbit)
{
  return c < quotient->n_copies && quotient->copy[c].edge_orbit == orbit;
}

/* Returns the orbit of a dart type's edge. */
static int orbit_of(const thr_quotient *quotient, int dart)
{
  return quotient->edge_orbit[quotient->dart[dart].half >> 1];
}

/* ---- without ends ---- */

/* Rules out copies in a mirror or on an axis whose trails come to no node where cords may end,
 * where every cord is open. A component without any such node is left to others to name. */
static thr_status rule_out_closed(thr_programme *programme, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  const int n_darts = quotient->n_darts;
  int *parent = thr_calloc((size_t)n_darts, sizeof *parent);
  bool *ends = thr_calloc((size_t)n_darts, sizeof *ends);
  const thr_status st = parent && ends ? THR_OK : thr_nomem(err);

  /* Connect dart types by the columns that may be used: trails stay in their set. */
  for (int dart = 0; dart < n_darts && !st; dart++)
    parent[dart] = dart;
  for (int j = 0; j < programme->first_end && !st; j++)
    if (programme->most[j] != 0 && !thr_programme_terminal(programme, j))
      thr_disjoint_join(parent, programme->join[j][0], programme->join[j][1]);

  /* Sets where a trail may end. */
  for (int dart = 0; dart < n_darts && !st; dart++)
    if (programme->most[programme->first_end + dart] != 0)
      ends[thr_disjoint_find(parent, dart)] = true;

  /* Copies with a nontrivial stabilizer cannot leave their set. */
  for (int copy = 0; copy < quotient->n_copies && !st; copy++)
    if (quotient->copy[copy].stabilizer.order > 1 &&
        !ends[thr_disjoint_find(parent, quotient->copy[copy].dart[0])])
      programme->most[copy] = 0;

  free(parent);
  free(ends);
  return st;
}

/* ---- turns back ---- */

/* Tells whether two dart orbits of this type can turn into each other over different half-edges. */
static bool turns_into_own_image(const thr_programme *programme, int dart)
{
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++) {
    const thr_pair_type *type = &programme->q->pair[programme->incident[k]];
    if (!type->self && type->dart[0] == type->dart[1] && type->half[0] != type->half[1])
      return true;
  }
  return false;
}

/* Returns the largest number of dart orbits over one orbit of other edges that every cover has and
 * that darts of this type can turn into. partner: [n_darts] scratch, false. */
static int count_partners(const thr_programme *programme, const int *first, int dart, bool *partner)
{
  const thr_quotient *quotient = programme->q;
  int most = 0;
  /* Mark what this type turns into. */
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++)
    for (int i = 0; i < 2; i++)
      partner[quotient->pair[programme->incident[k]].dart[i]] = true;

  /* Look at the edge orbit of each: if every copy type there has a dart that is marked, every cover
   * has so many. */
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++) {
    const int *end_types = quotient->pair[programme->incident[k]].dart,
              orbit = orbit_of(quotient, end_types[end_types[0] == dart]);
    bool all = orbit != orbit_of(quotient, dart);
    int passes = 1;
    for (int c = first[orbit]; all && is_copy_of(quotient, c, orbit); c++) {
      const thr_copy_type *type = &quotient->copy[c];
      if (programme->most[c] == 0) continue;
      all = partner[type->dart[0]] || (type->dart[1] >= 0 && partner[type->dart[1]]);
      if (type->passes > passes) passes = type->passes;
    }
    const int orbits = (programme->cover[orbit] + passes - 1) / passes;
    if (all && orbits > most) most = orbits;
  }

  /* Clear the marks. */
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++)
    for (int i = 0; i < 2; i++)
      partner[quotient->pair[programme->incident[k]].dart[i]] = false;
  return most;
}

/* Returns the fewest passes that one orbit of copies with a dart of this type adds to an edge. */
static int fewest_passes(const thr_programme *programme, const int *first, int dart)
{
  const int orbit = orbit_of(programme->q, dart);
  int fewest = 0;
  for (int c = first[orbit]; is_copy_of(programme->q, c, orbit); c++) {
    const thr_copy_type *type = &programme->q->copy[c];
    if ((type->dart[0] == dart || type->dart[1] == dart) && (fewest == 0 || type->passes < fewest))
      fewest = type->passes;
  }
  return fewest;
}

/* Rules out turns of two orbits of darts back into each other's edge, which no best cover needs
 * where other darts at the node are for certain that they can turn into. For with two orbits d, d'
 * of a type that turn back into each other
 *   - and a turn of x and y, or an end of x, d turns into x and d' into y, or ends: this turns no
 * more (the angles are a metric);
 *   - and an x that turns into its own image, d' can do so, too, and d turn into x;
 *   - else all x turn into darts of the type of d, which are two more then: the copies of d and d'
 * are left out, and what they turn into at their other ends turns into one another. The edge keeps
 * as many passes as the x are. Where a type can turn into its own image over another half-edge,
 * that turn does as well as the one back. */
static thr_status rule_out_turns_back(thr_programme *programme, const int *first, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  bool *partner = thr_calloc((size_t)quotient->n_darts, sizeof *partner);
  if (!partner) return thr_nomem(err);

  /* Pair types of two orbits with the same half-edge are turns back. */
  for (int pair = 0; pair < quotient->n_pairs; pair++) {
    const thr_pair_type *type = &quotient->pair[pair];
    const int d = type->dart[0];
    if (type->self || type->half[0] != type->half[1]) continue;

    const int needed = programme->cover[quotient->edge_orbit[quotient->dart[d].half >> 1]];
    const int partners = count_partners(programme, first, d, partner);
    if (turns_into_own_image(programme, d) ||
        (partners > 0 && (long)partners * fewest_passes(programme, first, d) >= needed))
      programme->most[programme->first_pair + pair] = 0;
  }

  free(partner);
  return THR_OK;
}

/* ---- what gets stuck ---- */

/* Tells whether orbits of this dart type can neither turn nor end. live[dart]: has the type copies
 * that may be used? */
static bool is_stuck(const thr_programme *programme, const bool *live, int dart)
{
  if (programme->most[programme->first_end + dart] != 0) return false;
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++) {
    const int *end_types = programme->q->pair[programme->incident[k]].dart;
    if (programme->most[programme->first_pair + programme->incident[k]] != 0 &&
        live[end_types[0]] && live[end_types[1]])
      return false;
  }
  return true;
}

/* Rules out copies whose trail gets stuck at either end, again and again until none is left, and
 * then the columns of the dart types that have no copies any more. */
static thr_status rule_out_stuck(thr_programme *programme, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  bool *live = thr_calloc((size_t)quotient->n_darts, sizeof *live);
  if (!live) return thr_nomem(err);

  /* Each round may leave other dart types without partners. */
  for (bool more = true; more;) {
    more = false;
    memset(live, 0, (size_t)quotient->n_darts * sizeof *live);

    /* Types with copies. */
    for (int i = 0; i < 2 * quotient->n_copies; i++)
      if (quotient->copy[i / 2].dart[i % 2] >= 0 && programme->most[i / 2] != 0)
        live[quotient->copy[i / 2].dart[i % 2]] = true;

    /* Copies that get stuck. */
    for (int i = 0; i < 2 * quotient->n_copies; i++) {
      int dart = quotient->copy[i / 2].dart[i % 2];
      if (dart < 0 || programme->most[i / 2] == 0 || !is_stuck(programme, live, dart)) continue;
      programme->most[i / 2] = 0;
      more = true;
    }
  }

  /* Columns of types without copies. */
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    if (!live[quotient->pair[pair].dart[0]] || !live[quotient->pair[pair].dart[1]])
      programme->most[programme->first_pair + pair] = 0;
  for (int dart = 0; dart < quotient->n_darts; dart++)
    if (!live[dart])
      programme->most[programme->first_end + dart] =
          programme->most[programme->first_circle + dart] = 0;

  free(live);
  return THR_OK;
}

/* Sets lower bounds: an edge orbit with one copy type left has so many that the edge is covered.
 * THR_EINFEASIBLE: no type is left, or the last one does not fit into the capacity. */
static thr_status require_last_types(thr_programme *programme, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  for (int copy = 0, end; copy < quotient->n_copies; copy = end) {
    int left = -1, n_left = 0;
    /* Which types of this orbit are left? */
    for (end = copy;
         end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[copy].edge; end++)
      if (programme->most[end] != 0) {
        left = end;
        n_left++;
      }

    /* The last one has to cover the edge. */
    if (n_left == 1)
      programme->least[left] =
          (programme->cover[quotient->copy[left].edge_orbit] + quotient->copy[left].passes - 1) /
          quotient->copy[left].passes;

    /* No cover. */
    if (n_left == 0 || (n_left == 1 && programme->least[left] > programme->most[left]))
      return thr_fail(err, THR_EINFEASIBLE,
                      "found no way to pass edge %d %d to %d times by cords that this group of "
                      "order %d maps to cords",
                      quotient->copy[copy].edge, programme->cover[quotient->copy[copy].edge_orbit],
                      programme->capacity[quotient->copy[copy].edge_orbit], quotient->h->order);
  }
  return THR_OK;
}

/* Fails with THR_EINFEASIBLE if tube joints cannot be tied: a cord cannot turn back at a node with
 * one tube; the d tubes of a node take d - 1 turns, each of two passes; and where every cord is
 * open, two passes must be left for ends. */
static thr_status check_tubes(const thr_programme *programme, thr_err *err)
{
  const thr_frame *frame = programme->q->f;
  long spare = 0;
  for (int node = 0; node < frame->n_nodes && programme->o->tube; node++) {
    /* Passes that fit at the node. */
    long capacity = 0;
    for (int k = frame->first[node]; k < frame->first[node + 1]; k++)
      capacity += programme->capacity[programme->q->edge_orbit[frame->half[k] >> 1]];

    if (thr_degree(frame, node) == 1 && !thr_programme_end_allowed(programme, node))
      return thr_fail(
          err, THR_EINFEASIBLE,
          "node %s has one edge and no cord may end there: it would turn back, which ties nothing",
          frame->name[node]);
    if (capacity < 2L * (thr_degree(frame, node) - 1))
      return thr_fail(
          err, THR_EINFEASIBLE,
          "node %s: its edges have room for %ld passes, but tying them together takes %d",
          frame->name[node], capacity, 2 * (thr_degree(frame, node) - 1));

    spare += capacity - 2L * (thr_degree(frame, node) - 1);
  }

  if (programme->o->tube && programme->open && spare < 2)
    return thr_fail(err, THR_EINFEASIBLE,
                    "the passes that fit are just enough to tie all nodes: none is left for the "
                    "ends of a cord");
  return THR_OK;
}

thr_status thr_programme_rule_out(thr_programme *programme, thr_err *err)
{
  int *first = find_first_copies(programme->q);
  thr_status st = first ? check_tubes(programme, err) : thr_nomem(err);
  if (!st) st = rule_out_exchanged(programme, err);
  if (!st && programme->open) st = rule_out_closed(programme, err);
  if (!st && !programme->o->tube) st = rule_out_turns_back(programme, first, err);
  free(first);
  if (!st) st = rule_out_stuck(programme, err);
  return st ? st : require_last_types(programme, err);
}
