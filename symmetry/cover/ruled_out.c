/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Columns of a symmetric cover that no cover needs, or has. */
#include "graph/disjoint.h"
#include "symmetry/cover/cover.h"

#include <stdlib.h>
#include <string.h>

/* Where h's i-th element moves a node of component c, moves[c * order + i]. */
static void find_moves(const thr_quotient *quotient, const int *component, bool *moves)
{
  int order = quotient->h->order;
  for (int i = 0; i < order; i++) {
    const int *to =
        &quotient->group->image[(size_t)quotient->h->element[i] * (size_t)quotient->f->n_nodes];
    for (int v = 0; v < quotient->f->n_nodes; v++)
      if (to[v] != v) moves[(size_t)component[v] * (size_t)order + (size_t)i] = true;
  }
}

/* Rules out copies that an element exchanges which moves no node of their component: it is to map
 * its cords to themselves. Such copies save no cord: of several that these elements exchange, each
 * could do what its image does. */
static thr_status rule_out_exchanged(thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  int count = 0, order = quotient->h->order,
      *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  bool *fixed = thr_calloc((size_t)quotient->group->order, sizeof *fixed), *moves = NULL;
  thr_status st = component && fixed ? thr_frame_components(quotient->f, component, &count, err)
                                     : thr_nomem(err);
  if (!st && count > 1) {
    moves = thr_calloc((size_t)count * (size_t)order, sizeof *moves);
    if (!moves) st = thr_nomem(err);
  }
  if (!st && moves) find_moves(quotient, component, moves);
  for (int c = 0; c < quotient->n_copies && !st && moves; c++) {
    const thr_subgroup *subgroup = &quotient->copy[c].stabilizer;
    const bool *moved =
        &moves[(size_t)component[quotient->f->edge[quotient->copy[c].edge][0]] * (size_t)order];
    for (int i = 0; i < subgroup->order; i++)
      fixed[subgroup->element[i]] = true;
    for (int i = 0; i < order; i++)
      if (!moved[i] && !fixed[quotient->h->element[i]]) p->most[c] = 0;
    for (int i = 0; i < subgroup->order; i++)
      fixed[subgroup->element[i]] = false;
  }
  free(component);
  free(fixed);
  free(moves);
  return st;
}

/* ---- lines in a mirror ---- */

/* Returns the first copy type of an orbit of edges, which follow one another: first[n_edge_orbits],
 * owned by the caller, or NULL without memory. */
static int *find_first_copies(const thr_quotient *quotient)
{
  int *first = thr_calloc((size_t)quotient->n_edge_orbits, sizeof *first);
  for (int c = quotient->n_copies - 1; c >= 0 && first; c--)
    first[quotient->copy[c].edge_orbit] = c;
  return first;
}

/* Tells whether there is a copy type c of this orbit of edges. */
static bool is_copy_of(const thr_quotient *quotient, int c, int orbit)
{
  return c < quotient->n_copies && quotient->copy[c].edge_orbit == orbit;
}

static int orbit_of(const thr_quotient *quotient, int d)
{
  return quotient->edge_orbit[quotient->dart[d].half >> 1];
}

/* Returns the only copy type with a dart of type d, if it is no fold and its darts are of two
 * types, or -1. */
static int only_copy(const thr_programme *p, const int *first, int d)
{
  const int orbit = orbit_of(p->q, d);
  int found = -1;
  for (int c = first[orbit]; is_copy_of(p->q, c, orbit); c++) {
    const thr_copy_type *type = &p->q->copy[c];
    if (type->dart[0] != d && type->dart[1] != d) continue;
    if (found >= 0 || type->fold || type->dart[0] == type->dart[1]) return -1;
    found = c;
  }
  return found;
}

/* Returns the only dart type that darts of type d turn into, but for turns back; d itself if there
 * is none, or only a turn into its own image that is its own inverse (*self), and -1 if there are
 * others. */
static int only_partner(const thr_programme *p, int d, bool *self)
{
  const thr_group *group = p->q->group;
  int found = -1;
  *self = false;
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const thr_pair_type *type = &p->q->pair[p->incident[k]];
    if (!type->self && type->half[0] == type->half[1]) continue;
    if (found >= 0 || (type->dart[0] == type->dart[1] && !type->self)) return -1;
    if (type->self && type->half[0] == type->half[1]) return -1;
    if (type->self && group->product[(size_t)type->element * ((size_t)group->order + 1)] != 0)
      return -1;
    *self = type->self;
    found = type->dart[type->dart[0] == d];
  }
  return found < 0 ? d : found;
}

/* Returns in how many manners trails may end at a dart type at the end of a line: as cords, and
 * folded into their images. */
static int count_terminals(const thr_programme *p, int d)
{
  bool self;
  return (only_partner(p, d, &self) >= 0 && self) + (p->most[p->first_end + d] != 0);
}

/* Tells whether two orbits of copies of this type can become one of copies that no element maps to
 * themselves. */
static bool can_be_freed(const thr_programme *p, const int *first, int copy)
{
  const int orbit = p->q->copy[copy].edge_orbit;
  for (int c = first[orbit]; is_copy_of(p->q, c, orbit); c++)
    if (p->q->copy[c].stabilizer.order == 1 && p->most[c] != 0)
      return p->cover[orbit] <= p->q->copy[c].passes;
  return false;
}

/* Returns the dart type at the other end of the line that begins with dart type d, or -1 if it is
 * no such line, or has a node where cords may end between its ends. */
static int find_line_end(const thr_programme *p, const int *first, int d)
{
  for (int from = d;;) {
    const int copy = only_copy(p, first, from);
    if (copy < 0 || !can_be_freed(p, first, copy)) return -1;
    bool self;
    const int across = p->q->copy[copy].dart[p->q->copy[copy].dart[0] == from],
              next = only_partner(p, across, &self);
    if (next == across) return across;
    if (next < 0 || p->most[p->first_end + across] != 0 || p->most[p->first_end + next] != 0)
      return -1;
    from = next;
  }
}

/* Rules out copies on a line that one element leaves where it is, if trails may end at no more than
 * one end of the line, in one manner. A line begins at a dart type that turns into no other.
 *
 * Every trail on such a line turns back, and so passes its edges evenly. Two of its passes over an
 * edge become one orbit of copies that the element exchanges; a turn back becomes a fold, two other
 * turns one, two ends one. Overlap, turning and paths stay, and there are fewer steps. For a trail
 * that turns back more than it has to, so that it would get folds without an end, has four passes
 * over an edge where it turns back: without the two of that turn it is shorter, and turns no more.
 */
static void rule_out_lines(thr_programme *p, const int *first)
{
  const thr_quotient *quotient = p->q;
  bool self;
  for (int d = 0; d < quotient->n_darts; d++) {
    if (quotient->dart[d].stabilizer.order != 2 || only_partner(p, d, &self) != d) continue;
    const int last = find_line_end(p, first, d);
    if (last < 0 || count_terminals(p, d) + count_terminals(p, last) > 1) continue;
    for (int from = d, across = -1; across != last; from = only_partner(p, across, &self)) {
      const int copy = only_copy(p, first, from);
      across = quotient->copy[copy].dart[quotient->copy[copy].dart[0] == from];
      p->most[copy] = 0;
    }
  }
}

/* ---- without ends ---- */

/* Rules out copies that some element leaves where they are and whose trails come to no node where
 * cords may end, where every cord is open. A component without such a node is for others to name.
 */
static thr_status rule_out_closed(thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  const int n = quotient->n_darts;
  int *set = thr_calloc((size_t)n, sizeof *set);
  bool *ends = thr_calloc((size_t)n, sizeof *ends);
  const thr_status st = set && ends ? THR_OK : thr_nomem(err);
  for (int d = 0; d < n && !st; d++)
    set[d] = d;
  for (int j = 0; j < p->first_end && !st; j++)
    if (p->most[j] != 0 && !thr_programme_terminal(p, j))
      thr_disjoint_join(set, p->join[j][0], p->join[j][1]);
  for (int d = 0; d < n && !st; d++)
    if (p->most[p->first_end + d] != 0) ends[thr_disjoint_find(set, d)] = true;
  for (int c = 0; c < quotient->n_copies && !st; c++)
    if (quotient->copy[c].stabilizer.order > 1 &&
        !ends[thr_disjoint_find(set, quotient->copy[c].dart[0])])
      p->most[c] = 0;
  free(set);
  free(ends);
  return st;
}

/* ---- turns back ---- */

/* Tells whether darts of type d can turn into others of type d over another half-edge. */
static bool turns_into_own_image(const thr_programme *p, int d)
{
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const thr_pair_type *type = &p->q->pair[p->incident[k]];
    if (!type->self && type->dart[0] == type->dart[1] && type->half[0] != type->half[1])
      return true;
  }
  return false;
}

/* Returns how many orbits of darts that those of type d can turn into every cover has, at least,
 * over one orbit of other edges. partner: [n_darts] scratch, false. */
static int count_partners(const thr_programme *p, const int *first, int d, bool *partner)
{
  const thr_quotient *quotient = p->q;
  int most = 0;
  for (int k = p->first[d]; k < p->first[d + 1]; k++)
    for (int i = 0; i < 2; i++)
      partner[quotient->pair[p->incident[k]].dart[i]] = true;
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const int *dart = quotient->pair[p->incident[k]].dart,
              orbit = orbit_of(quotient, dart[dart[0] == d]);
    bool all = orbit != orbit_of(quotient, d);
    int passes = 1;
    for (int c = first[orbit]; all && is_copy_of(quotient, c, orbit); c++) {
      const thr_copy_type *type = &quotient->copy[c];
      if (p->most[c] == 0) continue;
      all = partner[type->dart[0]] || (type->dart[1] >= 0 && partner[type->dart[1]]);
      if (type->passes > passes) passes = type->passes;
    }
    const int orbits = (p->cover[orbit] + passes - 1) / passes;
    if (all && orbits > most) most = orbits;
  }
  for (int k = p->first[d]; k < p->first[d + 1]; k++)
    for (int i = 0; i < 2; i++)
      partner[quotient->pair[p->incident[k]].dart[i]] = false;
  return most;
}

/* Returns the passes of an orbit of the copies that have a dart of type d: the fewest. */
static int fewest_passes(const thr_programme *p, const int *first, int d)
{
  const int orbit = orbit_of(p->q, d);
  int fewest = 0;
  for (int c = first[orbit]; is_copy_of(p->q, c, orbit); c++) {
    const thr_copy_type *type = &p->q->copy[c];
    if ((type->dart[0] == d || type->dart[1] == d) && (fewest == 0 || type->passes < fewest))
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
static thr_status rule_out_turns_back(thr_programme *p, const int *first, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  bool *partner = thr_calloc((size_t)quotient->n_darts, sizeof *partner);
  if (!partner) return thr_nomem(err);
  for (int y = 0; y < quotient->n_pairs; y++) {
    const thr_pair_type *type = &quotient->pair[y];
    const int d = type->dart[0];
    if (type->self || type->half[0] != type->half[1]) continue;
    const int needed = p->cover[quotient->edge_orbit[quotient->dart[d].half >> 1]];
    const int partners = count_partners(p, first, d, partner);
    if (turns_into_own_image(p, d) ||
        (partners > 0 && (long)partners * fewest_passes(p, first, d) >= needed))
      p->most[p->first_pair + y] = 0;
  }
  free(partner);
  return THR_OK;
}

/* ---- what gets stuck ---- */

/* Can an orbit of this dart type neither turn nor end? live[d]: has the dart type copies that can?
 */
static bool is_stuck(const thr_programme *p, const bool *live, int d)
{
  if (p->most[p->first_end + d] != 0) return false;
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const int *dart = p->q->pair[p->incident[k]].dart;
    if (p->most[p->first_pair + p->incident[k]] != 0 && live[dart[0]] && live[dart[1]])
      return false;
  }
  return true;
}

/* Copies whose trail gets stuck, in a mirror that it may not leave, are ruled out, and those that
 * are left alone by that. */
static thr_status rule_out_stuck(thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  bool *live = thr_calloc((size_t)quotient->n_darts, sizeof *live);
  if (!live) return thr_nomem(err);
  for (bool more = true; more;) {
    more = false;
    memset(live, 0, (size_t)quotient->n_darts * sizeof *live);
    for (int i = 0; i < 2 * quotient->n_copies; i++)
      if (quotient->copy[i / 2].dart[i % 2] >= 0 && p->most[i / 2] != 0)
        live[quotient->copy[i / 2].dart[i % 2]] = true;
    for (int i = 0; i < 2 * quotient->n_copies; i++) {
      int d = quotient->copy[i / 2].dart[i % 2];
      if (d < 0 || p->most[i / 2] == 0 || !is_stuck(p, live, d)) continue;
      p->most[i / 2] = 0;
      more = true;
    }
  }
  for (int y = 0; y < quotient->n_pairs; y++)
    if (!live[quotient->pair[y].dart[0]] || !live[quotient->pair[y].dart[1]])
      p->most[p->first_pair + y] = 0;
  for (int d = 0; d < quotient->n_darts; d++)
    if (!live[d]) p->most[p->first_end + d] = p->most[p->first_circle + d] = 0;
  free(live);
  return THR_OK;
}

/* An edge orbit with one copy type left has it so often at least. */
static thr_status require(thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  for (int c = 0, end; c < quotient->n_copies; c = end) {
    int left = -1, n = 0;
    for (end = c; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[c].edge;
         end++)
      if (p->most[end] != 0) {
        left = end;
        n++;
      }
    if (n == 1)
      p->least[left] =
          (p->cover[quotient->copy[left].edge_orbit] + quotient->copy[left].passes - 1) /
          quotient->copy[left].passes;
    if (n == 0 || (n == 1 && p->least[left] > p->most[left]))
      return thr_fail(err, THR_EINFEASIBLE,
                      "found no way to pass edge %d %d to %d times by cords that this group of "
                      "order %d maps to cords",
                      quotient->copy[c].edge, p->cover[quotient->copy[c].edge_orbit],
                      p->capacity[quotient->copy[c].edge_orbit], quotient->h->order);
  }
  return THR_OK;
}

/* With tube joints a cord cannot turn back at a node with one tube, and d tubes are tied by d - 1
 * turns, each of two passes; where every cord is open, there are ends as well. */
static thr_status check_tubes(const thr_programme *p, thr_err *err)
{
  const thr_frame *frame = p->q->f;
  long left = 0;
  for (int v = 0; v < frame->n_nodes && p->o->tube; v++) {
    long room = 0;
    for (int k = frame->first[v]; k < frame->first[v + 1]; k++)
      room += p->capacity[p->q->edge_orbit[frame->half[k] >> 1]];
    if (thr_degree(frame, v) == 1 && !thr_programme_end_allowed(p, v))
      return thr_fail(
          err, THR_EINFEASIBLE,
          "node %s has one edge and no cord may end there: it would turn back, which ties nothing",
          frame->name[v]);
    if (room < 2L * (thr_degree(frame, v) - 1))
      return thr_fail(
          err, THR_EINFEASIBLE,
          "node %s: its edges have room for %ld passes, but tying them together takes %d",
          frame->name[v], room, 2 * (thr_degree(frame, v) - 1));
    left += room - 2L * (thr_degree(frame, v) - 1);
  }
  if (p->o->tube && p->open && left < 2)
    return thr_fail(err, THR_EINFEASIBLE,
                    "the passes that fit are just enough to tie all nodes: none is left for the "
                    "ends of a cord");
  return THR_OK;
}

thr_status thr_programme_rule_out(thr_programme *p, thr_err *err)
{
  int *first = find_first_copies(p->q);
  thr_status st = first ? check_tubes(p, err) : thr_nomem(err);
  if (!st) st = rule_out_exchanged(p, err);
  if (!st && p->open) st = rule_out_closed(p, err);
  if (!st && !p->o->tube) rule_out_lines(p, first);
  if (!st && !p->o->tube) st = rule_out_turns_back(p, first, err);
  free(first);
  if (!st) st = rule_out_stuck(p, err);
  return st ? st : require(p, err);
}
