/* The multipliers of the turning relaxation as integers. */
#include "tortuosity/proof/project.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int64_t thr_relax_whole(double value)
{
  return (int64_t)nearbyint(ldexp(fmax(-1e4, fmin(1e4, value)), THR_TURNING_BITS));
}

static thr_status copy_set(thr_turning_set *to, int n, const int *member, int64_t value, thr_err *err)
{
  *to = (thr_turning_set){n, thr_calloc((size_t)n, sizeof *to->member), value};
  if (!to->member) return thr_nomem(err);
  memcpy(to->member, member, (size_t)n * sizeof *member);
  return THR_OK;
}

static thr_status copy_blocks(const thr_relax *r, thr_turning_partition *to, const int *block, int64_t value, thr_err *err)
{
  size_t m = (size_t)r->c->f->n_edges;
  *to = (thr_turning_partition){thr_calloc(m, sizeof *to->block), value};
  if (!to->block) return thr_nomem(err);
  memcpy(to->block, block, m * sizeof *block);
  return THR_OK;
}

static thr_status copy_junction(const thr_relax *r, thr_turning_junction *to, const thr_relax_junction *from, int64_t value,
                                thr_err *err)
{
  size_t d = (size_t)thr_degree(r->c->f, from->node);
  *to = (thr_turning_junction){from->node, thr_calloc(d, sizeof *to->block), value};
  if (!to->block) return thr_nomem(err);
  memcpy(to->block, from->block, d * sizeof *to->block);
  return THR_OK;
}

static thr_status copy_cuts(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < r->n_cuts && !st; i++) {
    int64_t value = thr_relax_whole(r->dual[r->n_equations + i]);
    int k = r->cut[i].index;
    if (value <= 0) continue;
    if (r->cut[i].kind == THR_RELAX_JUNCTION)
      st = copy_junction(r, &d->junction[d->n_junctions++], &r->junction[k], value, err);
    else if (r->cut[i].kind == THR_RELAX_PARTITION)
      st = copy_blocks(r, &d->partition[d->n_partitions++], r->partition[k].block, value, err);
    else if (r->cut[i].kind == THR_RELAX_ODD)
      st = copy_set(&d->odd[d->n_odd++], r->pool.cut[k].n_nodes, r->pool.cut[k].node, value, err);
    else
      st = copy_set(&d->group[d->n_groups++], r->group[k].n_edges, r->group[k].edge, value, err);
  }
  return st;
}

thr_status thr_relax_dual(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  int darts = 2 * c->f->n_edges, used[THR_RELAX_JUNCTION + 1] = {0};
  *d = (thr_turning_dual){0};
  if (r->projected) return thr_project_dual(r, d, err);
  for (int i = 0; i < r->n_cuts; i++)
    used[r->cut[i].kind] += thr_relax_whole(r->dual[r->n_equations + i]) > 0;
  d->potential = thr_calloc((size_t)darts, sizeof *d->potential);
  d->ends = thr_calloc((size_t)c->n_ends, sizeof *d->ends);
  d->odd = thr_calloc((size_t)used[THR_RELAX_ODD], sizeof *d->odd);
  d->group = thr_calloc((size_t)used[THR_RELAX_GROUP], sizeof *d->group);
  d->partition = thr_calloc((size_t)used[THR_RELAX_PARTITION], sizeof *d->partition);
  d->junction = thr_calloc((size_t)used[THR_RELAX_JUNCTION], sizeof *d->junction);
  thr_status st = d->potential && d->ends && d->odd && d->group && d->partition && d->junction ? THR_OK : thr_nomem(err);
  for (int h = 0; h < darts && !st; h++)
    d->potential[h] = thr_relax_whole(r->dual[h]);
  for (int i = 0; c->task->end_allowed && i < c->n_ends && !st; i++)
    d->ends[i] = thr_relax_whole(r->dual[darts + i]);
  if (!st && c->extra_limit >= 0) d->length = thr_relax_whole(fmax(0, r->dual[r->n_equations - 1]));
  if (!st) st = copy_cuts(r, d, err);
  if (st) thr_turning_dual_destroy(d);
  return st;
}
