/* The multipliers of the turning relaxation as integers. */
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "lp/model/pool.h"
#include "tortuosity/proof/project.h"
#include "tortuosity/proof/relax.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int64_t thr_relax_whole(double value)
{
  return (int64_t)nearbyint(ldexp(fmax(-1e4, fmin(1e4, value)), THR_TURNING_BITS));
}

static thr_status copy_members(int **to, const thr_row *row, thr_err *err)
{
  size_t n = (size_t)row->n_members;
  if (!(*to = thr_calloc(n, sizeof **to))) return thr_nomem(err);
  memcpy(*to, row->member, n * sizeof **to);
  return THR_OK;
}

static thr_status copy_cuts(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < r->pool.count && !st; i++) {
    int64_t value = thr_relax_whole(r->dual[r->n_equations + i]);
    const thr_row *row = &r->pool.row[i];
    if (value <= 0) continue;
    if (row->kind == THR_RELAX_ODD || row->kind == THR_RELAX_GROUP) {
      thr_turning_set *to = row->kind == THR_RELAX_ODD ? &d->odd[d->n_odd++] : &d->group[d->n_groups++];
      *to = (thr_turning_set){.n = row->n_members, .value = value};
      st = copy_members(&to->member, row, err);
    } else if (row->kind == THR_RELAX_PARTITION) {
      thr_turning_partition *to = &d->partition[d->n_partitions++];
      to->value = value;
      st = copy_members(&to->block, row, err);
    } else {
      thr_turning_junction *to = &d->junction[d->n_junctions++];
      *to = (thr_turning_junction){.node = row->index, .value = value};
      st = copy_members(&to->block, row, err);
    }
  }
  return st;
}

thr_status thr_relax_dual(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  int darts = 2 * c->f->n_edges, used[THR_RELAX_JUNCTION + 1] = {0};
  *d = (thr_turning_dual){0};
  if (r->projected) return thr_project_dual(r, d, err);
  for (int i = 0; i < r->pool.count; i++)
    used[r->pool.row[i].kind] += thr_relax_whole(r->dual[r->n_equations + i]) > 0;
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
