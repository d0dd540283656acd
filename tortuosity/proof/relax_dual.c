/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Turns the multipliers of the turning relaxation's last solve into integers.
 *
 * The solver's multipliers are doubles, and so only nearly optimal. Multiplied by
 * 2^THR_TURNING_BITS and rounded they are integers, for which the checker computes a valid bound in
 * exact arithmetic whatever their values are (graph/plan/turning_proof.h). Rows with a multiplier
 * of 0 are left out of the proof.
 *
 * Example: an odd row with multiplier 0.25 becomes a thr_turning_set with value 2^42. */
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <string.h>

/* Returns a multiplier in units of 2^-THR_TURNING_BITS, limited to 10,000, so that sums stay within
 * 64 bits. */
int64_t thr_relax_whole(double value)
{
  return (int64_t)nearbyint(ldexp(fmax(-1e4, fmin(1e4, value)), THR_TURNING_BITS));
}

/* Allocates *to and copies the members of a row there. */
static thr_status copy_members(int **to, const thr_row *row, thr_err *err)
{
  size_t n = (size_t)row->n_members;
  if (!(*to = thr_calloc(n, sizeof **to))) return thr_nomem(err);
  memcpy(*to, row->member, n * sizeof **to);
  return THR_OK;
}

/* Appends every row of the pool with a positive multiplier to the list of its kind in the dual. */
static thr_status copy_cuts(const thr_relax *relax, thr_turning_dual *dual, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < relax->search.pool.count && !st; i++) {
    int64_t value = thr_relax_whole(relax->search.dual[relax->search.n_fixed + i]);
    const thr_row *row = &relax->search.pool.row[i];
    if (value <= 0) continue;

    if (row->kind == THR_RELAX_ODD || row->kind == THR_RELAX_GROUP) {
      thr_turning_set *to =
          row->kind == THR_RELAX_ODD ? &dual->odd[dual->n_odd++] : &dual->group[dual->n_groups++];
      *to = (thr_turning_set){.n = row->n_members, .value = value};
      st = copy_members(&to->member, row, err);
    } else if (row->kind == THR_RELAX_PARTITION) {
      thr_turning_partition *to = &dual->partition[dual->n_partitions++];
      to->value = value;
      st = copy_members(&to->block, row, err);
    } else {
      thr_turning_junction *to = &dual->junction[dual->n_junctions++];
      *to = (thr_turning_junction){.node = row->index, .value = value};
      st = copy_members(&to->block, row, err);
    }
  }
  return st;
}

/* Makes the multipliers of all fixed rows and of the pool's rows. On failure dual is empty. */
thr_status thr_relax_dual(const thr_relax *relax, thr_turning_dual *dual, thr_err *err)
{
  const thr_turning_columns *turning_columns = relax->c;
  int darts = 2 * turning_columns->f->n_edges, used[THR_RELAX_JUNCTION + 1] = {0};

  if (relax->projected) return thr_project_dual(relax, dual, err);

  /* Count the rows of each kind that have a multiplier, to allocate the lists. */
  for (int i = 0; i < relax->search.pool.count; i++)
    used[relax->search.pool.row[i].kind] +=
        thr_relax_whole(relax->search.dual[relax->search.n_fixed + i]) > 0;

  thr_status st = thr_turning_dual_init(dual, turning_columns, err);
  if (st) return st;

  /* One list for every kind of row. */
  dual->odd = thr_calloc((size_t)used[THR_RELAX_ODD], sizeof *dual->odd);
  dual->group = thr_calloc((size_t)used[THR_RELAX_GROUP], sizeof *dual->group);
  dual->partition = thr_calloc((size_t)used[THR_RELAX_PARTITION], sizeof *dual->partition);
  dual->junction = thr_calloc((size_t)used[THR_RELAX_JUNCTION], sizeof *dual->junction);
  if (!dual->odd || !dual->group || !dual->partition || !dual->junction) st = thr_nomem(err);

  /* The fixed rows: half-edges, then ends, then the limit on the length, which is the last one. */
  for (int h = 0; h < darts && !st; h++)
    dual->potential[h] = thr_relax_whole(relax->search.dual[h]);
  for (int i = 0; turning_columns->task->end_allowed && i < turning_columns->n_ends && !st; i++)
    dual->ends[i] = thr_relax_whole(relax->search.dual[darts + i]);
  if (!st && turning_columns->extra_limit >= 0)
    dual->length = thr_relax_whole(fmax(0, relax->search.dual[relax->search.n_fixed - 1]));

  if (!st) st = copy_cuts(relax, dual, err);
  if (st) thr_turning_dual_destroy(dual);
  return st;
}
