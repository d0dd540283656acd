/* Back from the reduced problem: nodes are put where the moats have room for them. */
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "lp/tjoin/cuts.h"
#include "lp/tjoin/shrink.h"
#include "lp/tjoin/tjoin.h"

#include <stdlib.h>

/* In how deep a set of one tree of cuts a block is: in this cut, not in its children. */
typedef struct {
  int cut;
  int next; /* of the block's places, in other trees; or -1 */
} place;

typedef struct {
  int parent, tree; /* tree: the number that all cuts of a tree share */
  int64_t value;
  int mark; /* the last search that came by */
} moat;

typedef struct {
  const thr_shrinking *s;
  bool *in_join; /* [p->n_edges] */
  int n_moats, moats_capacity, n_places, places_capacity, n_trees, search;
  moat *moat;
  place *place;
  int *first;  /* [n_blocks] first place of a block, or -1 */
  int64_t sum; /* of all values */
} lifter;

static thr_status add_moat(lifter *l, int parent, int tree, int64_t value, int *number, thr_err *err)
{
  thr_status st = thr_grow(&l->moat, l->n_moats, &l->moats_capacity, sizeof *l->moat, err);
  if (st) return st;
  *number = l->n_moats++;
  l->moat[*number] = (moat){.parent = parent, .tree = tree, .value = value};
  return THR_OK;
}

static thr_status add_place(lifter *l, int block, int cut, thr_err *err)
{
  thr_status st = thr_grow(&l->place, l->n_places, &l->places_capacity, sizeof *l->place, err);
  if (st) return st;
  l->place[l->n_places] = (place){cut, l->first[block]};
  l->first[block] = l->n_places++;
  return THR_OK;
}

/* ---- the nodes that were taken out ---- */

/* Node v gets in where x is; with a moat of its own if that is odd. */
static thr_status lift_beside(lifter *l, int v, int x, bool odd, int64_t weight, thr_err *err)
{
  int own = -1, around = l->first[x] < 0 ? -1 : l->place[l->first[x]].cut;
  int64_t value = weight * THR_DUAL_DENOMINATOR;
  thr_status st = THR_OK;
  if (odd && value > 0) {
    st = add_moat(l, around, around < 0 ? l->n_trees++ : l->moat[around].tree, value, &own, err);
    l->sum += value;
    if (!st) st = add_place(l, v, own, err);
  }
  for (int k = l->first[x]; k >= 0 && !st; k = l->place[k].next)
    if (own < 0 || l->place[k].cut != around) st = add_place(l, v, l->place[k].cut, err);
  return st;
}

/* Innermost moat around both, or -1; each may be -1: outside of the tree. Up from both in turn. */
static int common_moat(lifter *l, int a, int b)
{
  int search = ++l->search;
  while (a >= 0 || b >= 0) {
    if (a >= 0) {
      if (l->moat[a].mark == search) return a;
      l->moat[a].mark = search;
      a = l->moat[a].parent;
    }
    if (b >= 0) {
      if (l->moat[b].mark == search) return b;
      l->moat[b].mark = search;
      b = l->moat[b].parent;
    }
  }
  return -1;
}

static int64_t width_between(const lifter *l, int from, int around)
{
  int64_t width = 0;
  for (int c = from; c != around; c = l->moat[c].parent)
    width += l->moat[c].value;
  return width;
}

/* Node v gets in where one comes to after so much moat, going outwards from inside of a cut. */
static thr_status lift_to(lifter *l, int v, int from, int64_t way, thr_err *err)
{
  int c = from, outer;
  for (; c >= 0 && way >= l->moat[c].value; c = l->moat[c].parent)
    way -= l->moat[c].value;
  if (c < 0) return THR_OK;
  if (way == 0) return add_place(l, v, c, err);
  thr_status st = add_moat(l, l->moat[c].parent, l->moat[c].tree, l->moat[c].value - way, &outer, err);
  if (st) return st;
  l->moat[c].value = way;
  l->moat[c].parent = outer;
  return add_place(l, v, outer, err);
}

/* The same between x and y, which are in cuts a and b of one tree: of the moats between, as much as *room holds is on the way to
 * x, the rest on the way to y. */
static thr_status lift_between(lifter *l, int v, int a, int b, int64_t *room, thr_err *err)
{
  int around = common_moat(l, a, b);
  int64_t to_x = width_between(l, a, around), to_y = width_between(l, b, around);
  int64_t part = to_x + to_y < *room ? to_x + to_y : *room;
  *room -= part;
  return part <= to_x ? lift_to(l, v, a, part, err) : lift_to(l, v, b, to_x + to_y - part, err);
}

static int place_in_tree(const lifter *l, int block, int tree)
{
  for (int k = l->first[block]; k >= 0; k = l->place[k].next)
    if (l->moat[l->place[k].cut].tree == tree) return l->place[k].cut;
  return -1;
}

static thr_status lift_even(lifter *l, const thr_shrink_step *step, thr_err *err)
{
  int64_t room = step->weight_a * THR_DUAL_DENOMINATOR;
  thr_status st = THR_OK;
  for (int k = l->first[step->x]; k >= 0 && !st; k = l->place[k].next) {
    int cut = l->place[k].cut;
    st = lift_between(l, step->node, cut, place_in_tree(l, step->y, l->moat[cut].tree), &room, err);
  }
  for (int k = l->first[step->y]; k >= 0 && !st; k = l->place[k].next) {
    int cut = l->place[k].cut;
    if (place_in_tree(l, step->x, l->moat[cut].tree) < 0) st = lift_between(l, step->node, -1, cut, &room, err);
  }
  return st;
}

static thr_status lift_steps(lifter *l, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = l->s->n_steps - 1; i >= 0 && !st; i--) {
    const thr_shrink_step *step = &l->s->step[i];
    if (step->kind == THR_SHRINK_EVEN) {
      l->in_join[step->b] = l->in_join[step->a];
      st = lift_even(l, step, err);
    } else {
      bool odd = step->kind == THR_SHRINK_ODD || step->odd;
      l->in_join[step->a] = step->kind == THR_SHRINK_ODD ? !l->in_join[step->b] : step->odd;
      st = lift_beside(l, step->node, step->x, odd, step->weight_a, err);
    }
  }
  return st;
}

/* ---- all together ---- */

static thr_status take_reduced(lifter *l, const thr_tjoin *small, thr_err *err)
{
  const thr_shrinking *shrinking = l->s;
  thr_status st = THR_OK;
  int number;
  l->sum = small->sum;
  for (int v = 0; v < shrinking->n_blocks; v++)
    l->first[v] = -1;
  for (int k = 0; k < shrinking->reduced.n_edges; k++)
    l->in_join[shrinking->origin[k]] = small->in_join[k];
  for (int i = 0; i < small->n_cuts && !st; i++) {
    const thr_cut *c = &small->cut[i];
    st = add_moat(l, c->parent, 0, c->value, &number, err);
    for (int k = 0; k < c->n_nodes && !st; k++)
      st = add_place(l, shrinking->kept[c->node[k]], i, err);
  }
  for (int i = small->n_cuts - 1; i >= 0 && !st; i--) /* parents come after their children */
    l->moat[i].tree = l->moat[i].parent < 0 ? l->n_trees++ : l->moat[l->moat[i].parent].tree;
  return st;
}

/* Bridges: each has the side below it as a set, in one tree of cuts. at[tjoin_problem->n_nodes] receives a node's place in that.
 */
static thr_status add_bridges(lifter *l, int *at, thr_err *err)
{
  const thr_shrinking *shrinking = l->s;
  const thr_tjoin_problem *tjoin_problem = shrinking->p;
  int tree = l->n_trees++;
  thr_status st = THR_OK;
  for (int i = 0; i < tjoin_problem->n_nodes && !st; i++) {
    int v = shrinking->order[i], e = shrinking->up[v];
    at[v] = e < 0 ? -1 : at[tjoin_problem->edge[e][0] == v ? tjoin_problem->edge[e][1] : tjoin_problem->edge[e][0]];
    if (!shrinking->odd_bridge[v]) continue;
    l->in_join[e] = true;
    int64_t value = tjoin_problem->weight[e] * THR_DUAL_DENOMINATOR;
    if (value == 0) continue;
    l->sum += value;
    st = add_moat(l, at[v], tree, value, &at[v], err);
  }
  return st;
}

/* The cuts with the nodes of the problem: its own, as blocks and bridges say. */
static thr_status write_cuts(const lifter *l, const int *at, thr_cuts *cuts, thr_err *err)
{
  const thr_shrinking *shrinking = l->s;
  cuts->n_nodes = shrinking->p->n_nodes;
  cuts->cut = thr_calloc((size_t)l->n_moats, sizeof *cuts->cut);
  if (!cuts->cut) return thr_nomem(err);
  for (int v = 0; v < shrinking->p->n_nodes; v++) {
    for (int k = l->first[shrinking->block[v]]; k >= 0; k = l->place[k].next)
      cuts->cut[l->place[k].cut].n_nodes++;
    if (at[v] >= 0) cuts->cut[at[v]].n_nodes++;
  }
  for (; cuts->n < l->n_moats; cuts->n++) {
    thr_cut *c = &cuts->cut[cuts->n];
    c->parent = l->moat[cuts->n].parent;
    c->value = l->moat[cuts->n].value;
    c->node = thr_calloc((size_t)c->n_nodes, sizeof *c->node);
    if (!c->node) return thr_nomem(err);
    c->n_nodes = 0;
  }
  for (int v = 0; v < shrinking->p->n_nodes; v++) {
    for (int k = l->first[shrinking->block[v]]; k >= 0; k = l->place[k].next) {
      thr_cut *c = &cuts->cut[l->place[k].cut];
      c->node[c->n_nodes++] = v;
    }
    if (at[v] >= 0) cuts->cut[at[v]].node[cuts->cut[at[v]].n_nodes++] = v;
  }
  return thr_cuts_nest(cuts, err);
}

thr_status thr_shrinking_lift(const thr_shrinking *shrinking, thr_tjoin *small, thr_tjoin *out, thr_err *err)
{
  lifter l = {.s = shrinking, .moats_capacity = small->n_cuts + 1, .places_capacity = shrinking->n_blocks};
  thr_cuts cuts = {0};
  int *at = thr_calloc((size_t)shrinking->p->n_nodes, sizeof *at);
  *out = (thr_tjoin){0};
  l.in_join = out->in_join = thr_calloc((size_t)shrinking->p->n_edges, sizeof *out->in_join);
  l.first = thr_calloc((size_t)shrinking->n_blocks, sizeof *l.first);
  l.moat = thr_calloc((size_t)l.moats_capacity, sizeof *l.moat);
  l.place = thr_calloc((size_t)l.places_capacity, sizeof *l.place);
  thr_status st = at && out->in_join && l.first && l.moat && l.place ? THR_OK : thr_nomem(err);
  if (!st) st = take_reduced(&l, small, err);
  if (!st) st = lift_steps(&l, err);
  if (!st) st = add_bridges(&l, at, err);
  if (!st) st = write_cuts(&l, at, &cuts, err);
  for (int e = 0; e < shrinking->p->n_edges && !st; e++)
    if (out->in_join[e]) out->length += shrinking->p->weight[e];
  free(at);
  free(l.first);
  free(l.moat);
  free(l.place);
  out->cut = cuts.cut;
  out->n_cuts = cuts.n;
  out->sum = l.sum;
  out->optimal = small->optimal;
  thr_tjoin_destroy(small);
  if (st) thr_tjoin_destroy(out);
  return st;
}
