/* Columns of a symmetric cover that no cover needs, or has. */
#include "graph/framework/frame.h"
#include "graph/status.h"
#include "symmetry/cover/programme.h"
#include "symmetry/group/group.h"
#include "symmetry/group/quotient.h"

#include <stdlib.h>
#include <string.h>

/* Where h's i-th element moves a node of component c, moves[c * order + i]. */
static void find_moves(const thr_quotient *quotient, const int *component, bool *moves)
{
  int order = quotient->h->order;
  for (int i = 0; i < order; i++) {
    const int *to = &quotient->group->image[(size_t)quotient->h->element[i] * (size_t)quotient->f->n_nodes];
    for (int v = 0; v < quotient->f->n_nodes; v++)
      if (to[v] != v) moves[(size_t)component[v] * (size_t)order + (size_t)i] = true;
  }
}

/* Rules out copies that an element exchanges which moves no node of their component: it is to map its cords to themselves. Such
 * copies save no cord: of several that these elements exchange, each could do what its image does. */
static thr_status rule_out_exchanged(thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  int count = 0, order = quotient->h->order, *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  bool *fixed = thr_calloc((size_t)quotient->group->order, sizeof *fixed), *moves = NULL;
  thr_status st = component && fixed ? thr_frame_components(quotient->f, component, &count, err) : thr_nomem(err);
  if (!st && count > 1) {
    moves = thr_calloc((size_t)count * (size_t)order, sizeof *moves);
    if (!moves) st = thr_nomem(err);
  }
  if (!st && moves) find_moves(quotient, component, moves);
  for (int c = 0; c < quotient->n_copies && !st && moves; c++) {
    const thr_subgroup *subgroup = &quotient->copy[c].stabilizer;
    const bool *moved = &moves[(size_t)component[quotient->f->edge[quotient->copy[c].edge][0]] * (size_t)order];
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

/* Can an orbit of this dart type neither turn nor end? live[d]: has the dart type copies that can? */
static bool is_stuck(const thr_programme *p, const bool *live, int d)
{
  if (p->most[p->first_end + d] != 0) return false;
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const int *dart = p->q->pair[p->incident[k]].dart;
    if (p->most[p->first_pair + p->incident[k]] != 0 && live[dart[0]] && live[dart[1]]) return false;
  }
  return true;
}

/* Copies whose trail gets stuck, in a mirror that it may not leave, are ruled out, and those that are left alone by that. */
static thr_status rule_out_stuck(thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  bool *live = thr_calloc((size_t)quotient->n_darts, sizeof *live);
  if (!live) return thr_nomem(err);
  for (bool more = true; more;) {
    more = false;
    memset(live, 0, (size_t)quotient->n_darts * sizeof *live);
    for (int i = 0; i < 2 * quotient->n_copies; i++)
      if (quotient->copy[i / 2].dart[i % 2] >= 0 && p->most[i / 2] != 0) live[quotient->copy[i / 2].dart[i % 2]] = true;
    for (int i = 0; i < 2 * quotient->n_copies; i++) {
      int d = quotient->copy[i / 2].dart[i % 2];
      if (d < 0 || p->most[i / 2] == 0 || !is_stuck(p, live, d)) continue;
      p->most[i / 2] = 0;
      more = true;
    }
  }
  for (int y = 0; y < quotient->n_pairs; y++)
    if (!live[quotient->pair[y].dart[0]] || !live[quotient->pair[y].dart[1]]) p->most[p->first_pair + y] = 0;
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
    for (end = c; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[c].edge; end++)
      if (p->most[end] != 0) {
        left = end;
        n++;
      }
    if (n == 1)
      p->least[left] =
          (p->cover[quotient->copy[left].edge_orbit] + quotient->copy[left].passes - 1) / quotient->copy[left].passes;
    if (n == 0 || (n == 1 && p->least[left] > p->most[left]))
      return thr_fail(err, THR_EINFEASIBLE,
                      "found no way to pass edge %d %d to %d times by cords that this group of order %d maps to cords",
                      quotient->copy[c].edge, p->cover[quotient->copy[c].edge_orbit], p->capacity[quotient->copy[c].edge_orbit],
                      quotient->h->order);
  }
  return THR_OK;
}

/* With tube joints a cord cannot turn back at a node with one tube. */
static thr_status check_leaves(const thr_programme *p, thr_err *err)
{
  const thr_frame *frame = p->q->f;
  for (int v = 0; v < frame->n_nodes && p->o->tube; v++)
    if (thr_degree(frame, v) == 1 && !thr_programme_end_allowed(p, v))
      return thr_fail(err, THR_EINFEASIBLE,
                      "node %s has one edge and no cord may end there: it would turn back, which ties nothing", frame->name[v]);
  return THR_OK;
}

thr_status thr_programme_rule_out(thr_programme *p, thr_err *err)
{
  thr_status st = check_leaves(p, err);
  if (!st) st = rule_out_exchanged(p, err);
  if (!st) st = rule_out_stuck(p, err);
  return st ? st : require(p, err);
}
