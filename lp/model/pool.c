/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the rows of a relaxation that separation has found, sum value x[column] >= lower: a cut
 * pool (Padberg & Rinaldi, SIAM Review 33, 1991).
 *
 * The pool says whether a point x violates a row, refuses a row that it has already, and drops rows
 * that the caller no longer wants. Rows are recognized by a name of 64 bits, which is a hash of
 * their coefficients or comes from the caller, in an open-addressed table. The pool does not solve
 * anything: its rows may stand in a linear programme (lp/model/search.c) or carry the multipliers
 * of a Lagrangian relaxation.
 *
 * A row is drafted column by column and then added, or offered, which adds it only if a point
 * violates it and the pool has none like it. Example, x[3] + x[7] >= 1:
 *
 *   thr_pool_put(pool, 3, 1);
 *   thr_pool_put(pool, 7, 1);
 *   st = thr_pool_offer(pool, (thr_row){.lower = 1}, x, 1e-6, &added, err); */
#include "lp/model/tree.h"

#include <stdlib.h>
#include <string.h>

thr_status thr_pool_init(thr_pool *p, int n_columns, thr_err *err)
{
  /* The draft needs a sum per column, so that a column may be put twice. */
  size_t n = (size_t)n_columns;
  *p = (thr_pool){.n_columns = n_columns};
  p->sum = thr_calloc(n, sizeof *p->sum);
  p->drafted = thr_calloc(n, sizeof *p->drafted);
  p->draft = thr_calloc(n, sizeof *p->draft);

  if (p->sum && p->drafted && p->draft) return THR_OK;
  thr_pool_destroy(p);
  return thr_nomem(err);
}

static void row_destroy(thr_row *row)
{
  free(row->member);
  free(row->column);
  free(row->value);
}

void thr_pool_destroy(thr_pool *p)
{
  for (int i = 0; i < p->count; i++)
    row_destroy(&p->row[i]);
  free(p->row);
  free(p->seen);
  free(p->sum);
  free(p->drafted);
  free(p->draft);
  *p = (thr_pool){0};
}

/* ---- names of rows ---- */

/* Returns the slot of a name in the table, or the empty slot, 0, where it would go. */
static int slot_of(const thr_pool *p, uint64_t name)
{
  /* Probe linearly from the hash. */
  int i = (int)(name % (uint64_t)p->seen_size);
  while (p->seen[i] && p->seen[i] != name)
    i = i + 1 == p->seen_size ? 0 : i + 1;
  return i;
}

bool thr_pool_knows(const thr_pool *p, uint64_t name)
{
  return p->seen_size > 0 && p->seen[slot_of(p, name)] == name;
}

/* Fills the empty table with the names of all rows. */
static void name_all(thr_pool *p)
{
  p->seen_used = p->count;
  for (int i = 0; i < p->count; i++)
    p->seen[slot_of(p, p->row[i].name)] = p->row[i].name;
}

/* Adds a name to the table, which is doubled when it is half full. */
static thr_status remember(thr_pool *p, uint64_t name, thr_err *err)
{
  /* Names cannot be moved: the new table is filled from the rows. */
  if (2 * p->seen_used >= p->seen_size) {
    int size = p->seen_size ? 2 * p->seen_size : 1024;
    uint64_t *table = thr_calloc((size_t)size, sizeof *table);
    if (!table) return thr_nomem(err);
    free(p->seen);
    p->seen = table;
    p->seen_size = size;
    name_all(p);
  }

  p->seen[slot_of(p, name)] = name;
  p->seen_used++;
  return THR_OK;
}

/* Mixes one word into a hash. */
static uint64_t mix(uint64_t name, uint64_t word)
{
  name = (name ^ word) * UINT64_C(0x9e3779b97f4a7c15);
  return name ^ name >> 29;
}

/* Returns the bits of a number. Equal numbers have equal bits but for 0 and -0. */
static uint64_t word_of(double value)
{
  uint64_t word;
  memcpy(&word, &value, sizeof word);
  return word;
}

/* ---- the draft ---- */

void thr_pool_put(thr_pool *p, int column, double value)
{
  if (!p->drafted[column]) p->draft[p->n_draft++] = column;
  p->drafted[column] = true;
  p->sum[column] += value;
}

/* Empties the draft in time proportional to its columns. */
static void forget_draft(thr_pool *p)
{
  for (int i = 0; i < p->n_draft; i++) {
    p->sum[p->draft[i]] = 0;
    p->drafted[p->draft[i]] = false;
  }
  p->n_draft = 0;
}

/* Returns the hash of the draft's coefficients and lower bound, never 0. */
static uint64_t name_draft(const thr_pool *p, double lower)
{
  /* Columns whose coefficients cancel out are no part of the row. The order of columns counts. */
  uint64_t name = mix(1, word_of(lower));
  for (int i = 0; i < p->n_draft; i++)
    if (p->sum[p->draft[i]] != 0)
      name = mix(mix(name, (uint64_t)p->draft[i]), word_of(p->sum[p->draft[i]]));
  return name ? name : 1;
}

/* Copies the draft into a row; value stays NULL if all coefficients are 1. */
static thr_status fill_row(const thr_pool *p, thr_row *row, thr_err *err)
{
  /* Count the columns that have not cancelled out. */
  bool ones = true;
  int n_used = 0;
  for (int i = 0; i < p->n_draft; i++) {
    n_used += p->sum[p->draft[i]] != 0;
    ones &= p->sum[p->draft[i]] == 0 || p->sum[p->draft[i]] == 1;
  }

  row->column = thr_calloc((size_t)n_used, sizeof *row->column);
  if (!ones) row->value = thr_calloc((size_t)n_used, sizeof *row->value);
  if (!row->column || (!ones && !row->value)) return thr_nomem(err);

  /* Copy them in the order in which they were put. */
  for (int i = 0; i < p->n_draft && row->n < n_used; i++) {
    int j = p->draft[i];
    if (p->sum[j] == 0) continue;
    if (row->value) row->value[row->n] = p->sum[j];
    row->column[row->n++] = j;
  }
  return THR_OK;
}

thr_status thr_pool_add(thr_pool *p, thr_row row, thr_err *err)
{
  /* The pool owns copies; until then the row has no members to be released. */
  const int *member = row.member;
  if (!row.name) row.name = name_draft(p, row.lower);
  row.member = NULL;

  thr_status st = thr_grow(&p->row, p->count, &p->capacity, sizeof *p->row, err);

  /* Copy the members and the draft. */
  if (!st && member && !(row.member = thr_calloc((size_t)row.n_members, sizeof *member)))
    st = thr_nomem(err);
  if (!st && row.n_members > 0 && member)
    memcpy(row.member, member, (size_t)row.n_members * sizeof *member);
  if (!st) st = fill_row(p, &row, err);

  if (!st) st = remember(p, row.name, err);

  /* On failure the pool is as before, without the draft. */
  if (st)
    row_destroy(&row);
  else
    p->row[p->count++] = row;
  forget_draft(p);
  return st;
}

thr_status thr_pool_offer(thr_pool *p, thr_row row, const double *x, double tolerance, int *added,
                          thr_err *err)
{
  /* Compute the left side at x. */
  double sum = 0;
  for (int i = 0; i < p->n_draft; i++)
    sum += p->sum[p->draft[i]] * x[p->draft[i]];

  bool violated = sum < row.lower - tolerance;
  if (violated && !row.name) row.name = name_draft(p, row.lower);

  /* Only rows that are violated and new are copied. */
  if (violated && !thr_pool_knows(p, row.name)) {
    ++*added;
    return thr_pool_add(p, row, err);
  }

  forget_draft(p);
  return THR_OK;
}

thr_status thr_pool_copy(thr_pool *p, const thr_pool *from, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < from->count && !st; i++) {
    /* Draft the row again. */
    thr_row row = from->row[i];
    for (int k = 0; k < row.n; k++)
      thr_pool_put(p, row.column[k], row.value ? row.value[k] : 1);

    /* thr_pool_add gives the copy arrays of its own. */
    row.n = 0;
    row.column = NULL;
    row.value = NULL;
    st = thr_pool_add(p, row, err);
  }
  return st;
}

/* ---- rows ---- */

double thr_row_sum(const thr_row *r, const double *x)
{
  double sum = 0;
  for (int k = 0; k < r->n; k++)
    sum += r->value ? r->value[k] * x[r->column[k]] : x[r->column[k]];
  return sum;
}

void thr_row_charge(const thr_row *r, double price, double *reduced)
{
  for (int k = 0; k < r->n && price != 0; k++)
    reduced[r->column[k]] -= r->value ? price * r->value[k] : price;
}

void thr_pool_drop(thr_pool *p, const bool *drop)
{
  /* Close the gaps. */
  int kept = 0;
  for (int i = 0; i < p->count; i++)
    if (drop[i])
      row_destroy(&p->row[i]);
    else
      p->row[kept++] = p->row[i];

  p->count = kept;

  /* Names cannot be removed from an open-addressed table: it is filled again. */
  if (p->seen_size == 0) return;
  memset(p->seen, 0, (size_t)p->seen_size * sizeof *p->seen);
  name_all(p);
}

thr_status thr_pool_keep_violated(thr_pool *p, int first, const double *x, double tolerance,
                                  int *added, thr_err *err)
{
  int kept = 0, found = p->count - first;
  bool *drop = thr_calloc((size_t)p->count, sizeof *drop);
  if (!drop) return thr_nomem(err);

  /* Mark the new rows that x satisfies. */
  for (int i = first; i < p->count; i++) {
    drop[i] = thr_row_sum(&p->row[i], x) >= p->row[i].lower - tolerance;
    kept += !drop[i];
  }

  if (kept < found) thr_pool_drop(p, drop);
  *added += kept;
  free(drop);
  return THR_OK;
}
