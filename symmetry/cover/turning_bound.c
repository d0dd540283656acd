/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much the cords of a symmetric cover turn at least, known early and at any time. Internal.
 *
 * Both bounds take the nodes apart. What the turns in one cell (symmetry/cover/contraction.c) cost
 * at least is a convex function of how often each of its dart types is used and of how many trails
 * end there. */
#include "symmetry/cover/cover_parts.h"
#include "graph/scratch.h"
#include "lp/solver/lp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool allowed(const thr_programme *p, int pair)
{
  return p->most[p->first_pair + pair] != 0;
}

static bool comes_before_turning(const thr_programme *p, thr_aim aim)
{
  int k = 0;
  while (p->o->prefer[k] != aim && p->o->prefer[k] != THR_AIM_TURNING)
    k++;
  return p->o->prefer[k] == aim && aim != THR_AIM_TURNING;
}

/* ---- at once ---- */

static bool may_end(const thr_programme *p, int d)
{
  return p->most[p->first_end + d] != 0;
}

/* The most that u[d] can be with the others as they are; without a turn or an end, where no trail
 * can go, more than any price. */
static double room_for(const thr_programme *p, const double *u, int d)
{
  double room = INFINITY;
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const thr_pair_type *pair_type = &p->q->pair[p->incident[k]];
    double price = p->cost[THR_AIM_TURNING][p->first_pair + p->incident[k]];
    if (!allowed(p, p->incident[k])) continue;
    if (!pair_type->self)
      price = pair_type->dart[0] == pair_type->dart[1]
                  ? price / 2
                  : price - u[pair_type->dart[0] + pair_type->dart[1] - d];
    room = fmin(room, price);
  }
  if (isinf(room)) return may_end(p, d) ? 0 : 10 * p->scale[THR_AIM_TURNING];
  return fmax(0, room);
}

/* Half the cheapest turn to begin with; none where a trail may end for nothing. */
static void start_ascent(const thr_programme *p, bool free_ends, double *u)
{
  for (int d = 0; d < p->q->n_darts; d++) {
    double least = INFINITY;
    for (int k = p->first[d]; k < p->first[d + 1]; k++)
      if (allowed(p, p->incident[k]))
        least = fmin(least, p->cost[THR_AIM_TURNING][p->first_pair + p->incident[k]] / 2);
    u[d] = isinf(least) || (free_ends && may_end(p, d)) ? 0 : least;
  }
}

/* What the copies pay at least: u is of their darts. Of several copy types of an edge orbit any
 * mixture that covers it. */
static double paid(const thr_programme *p, const double *u)
{
  const thr_quotient *quotient = p->q;
  double sum = 0;
  for (int c = 0, end; c < quotient->n_copies; c = end) {
    double alone = 0, mixed = INFINITY;
    for (end = c; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[c].edge;
         end++) {
      const thr_copy_type *copy_type = &quotient->copy[end];
      double price = u[copy_type->dart[0]] + (copy_type->fold ? 0 : u[copy_type->dart[1]]);
      alone = price * p->least[end];
      int cover = p->cover[copy_type->edge_orbit];
      if (p->most[end] != 0)
        mixed =
            fmin(mixed, price * cover / (copy_type->passes < cover ? copy_type->passes : cover));
    }
    sum += end == c + 1 ? alone : mixed;
  }
  return sum;
}

static void ascend(const thr_programme *p, bool free_ends, double *u)
{
  start_ascent(p, free_ends, u);
  for (int d = 0; d < p->q->n_darts; d++)
    if (!free_ends || !may_end(p, d)) u[d] = room_for(p, u, d);
}

/* The largest where a trail may end. */
static double price_of_ends(const thr_programme *p, const double *u)
{
  double most = 0;
  for (int d = 0; d < p->q->n_darts; d++)
    if (may_end(p, d)) most = fmax(most, u[d]);
  return most;
}

/* A bound less what adding up may have put on it, and what a cover can have. */
static double made_safe(const thr_programme *p, double value)
{
  double unit = p->unit[THR_AIM_TURNING];
  value -= 1e-9 * (p->scale[THR_AIM_TURNING] + fabs(value));
  return unit > 0 ? unit * ceil(value / unit - 1e-4) : value;
}

thr_status thr_turning_quick_bound(const thr_programme *p, const double worth[THR_N_AIMS],
                                   double *bound, thr_err *err)
{
  double *u = thr_calloc((size_t)p->q->n_darts, sizeof *u), value;
  if (!u) return thr_nomem(err);
  ascend(p, true, u);
  value = paid(p, u);
  if (comes_before_turning(p, THR_AIM_PATHS)) {
    ascend(p, false, u);
    value = fmax(value, paid(p, u) - 2 * worth[THR_AIM_PATHS] * price_of_ends(p, u));
  }
  *bound = fmax(0, made_safe(p, value));
  free(u);
  return THR_OK;
}

/* ---- cells ---- */

/* Dart types and turns of the contracted cells, cell by cell. */
typedef struct {
  const thr_contraction *c;
  thr_relaxation *r; /* of the contraction; extra columns: what the cell with that dart type costs,
                        in parts of the scale */
  double most; /* what no column without an upper bound has more of in a cover that turns less than
                  the known one */
  int n;
  int *type, *first_type; /* type[first_type[i] .. first_type[i + 1] - 1] */
  int *pair, *first_pair;
  int *place;        /* [n_darts] row of the type in its cell's programme */
  double *used;      /* [n_darts] darts of the type, of the point that is looked at */
  double *shift;     /* [n_darts] multipliers */
  int *first, *copy; /* copies by dart type: copy[first[d] .. first[d + 1] - 1] / 2 */
  const thr_limits *limits;
  double bound; /* the best so far */
  /* one cell's programme; room for the largest */
  int *start, *row;
  double *value, *cost, *rhs, *dual;
  thr_scratch own; /* the arrays */
} master;

/* Lists members by number, in[i] = -1: not at all. Those of number k: list[first[k] .. first[k + 1]
 * - 1]; first[n + 2] is zero */
static void bucket(int count, const int *in, int n, int *first, int *list)
{
  for (int i = 0; i < count; i++)
    if (in[i] >= 0) first[in[i] + 2]++;
  for (int k = 1; k <= n; k++)
    first[k + 1] += first[k];
  for (int i = 0; i < count; i++)
    if (in[i] >= 0) list[first[in[i] + 1]++] = i;
}

static thr_status list_cells(master *m, thr_err *err)
{
  const thr_programme *p = m->c->whole;
  size_t darts = (size_t)p->q->n_darts, pairs = (size_t)p->q->n_pairs;
  int *number = thr_calloc(darts, sizeof *number), *cell = thr_calloc(pairs, sizeof *cell);
  m->type = thr_scratch_array(&m->own, darts, sizeof *m->type);
  m->pair = thr_scratch_array(&m->own, pairs, sizeof *m->pair);
  m->place = thr_scratch_array(&m->own, darts, sizeof *m->place);
  m->used = thr_scratch_array(&m->own, darts, sizeof *m->used);
  m->shift = thr_scratch_array(&m->own, darts, sizeof *m->shift);
  m->first_type = thr_scratch_array(&m->own, darts + 2, sizeof *m->first_type);
  m->first_pair = thr_scratch_array(&m->own, darts + 2, sizeof *m->first_pair);
  thr_status st = number && cell ? thr_scratch_check(&m->own, err) : thr_nomem(err);
  for (int d = 0; d < p->q->n_darts && !st; d++)
    number[d] = m->c->keep[m->c->root[d]] ? -1
                : m->c->root[d] == d      ? m->n++
                                          : number[m->c->root[d]];
  for (int y = 0; y < p->q->n_pairs && !st; y++)
    cell[y] = allowed(p, y) ? number[p->q->pair[y].dart[0]] : -1;
  if (!st) {
    bucket(p->q->n_darts, number, m->n, m->first_type, m->type);
    bucket(p->q->n_pairs, cell, m->n, m->first_pair, m->pair);
  }
  for (int i = 0; i < m->n && !st; i++)
    for (int k = m->first_type[i]; k < m->first_type[i + 1]; k++)
      m->place[m->type[k]] = k - m->first_type[i];
  free(number);
  free(cell);
  return st;
}

static thr_status list_copies(master *m, thr_err *err)
{
  const thr_quotient *quotient = m->c->whole->q;
  size_t both = 2 * (size_t)quotient->n_copies;
  int *in = thr_calloc(both, sizeof *in);
  m->first = thr_scratch_array(&m->own, (size_t)quotient->n_darts + 2, sizeof *m->first);
  m->copy = thr_scratch_array(&m->own, both, sizeof *m->copy);
  thr_status st = in ? thr_scratch_check(&m->own, err) : thr_nomem(err);
  for (int k = 0; k < 2 * quotient->n_copies && !st; k++)
    in[k] = quotient->copy[k / 2].dart[k % 2]; /* a fold's second is -1 */
  if (!st) bucket(2 * quotient->n_copies, in, quotient->n_darts, m->first, m->copy);
  free(in);
  return st;
}

/* Rows of a cell: its types, its ends, its self pairs; columns: its turns, ends by type, and two
 * artificial ones per row. */
static thr_status make_room(master *m, thr_err *err)
{
  size_t rows = 0, columns = 0;
  for (int i = 0; i < m->n; i++) {
    size_t types = (size_t)(m->first_type[i + 1] - m->first_type[i]),
           pairs = (size_t)(m->first_pair[i + 1] - m->first_pair[i]);
    if (types + 2 > rows) rows = types + 2;
    if (pairs + types + 2 * (types + 2) > columns) columns = pairs + types + 2 * (types + 2);
  }
  m->start = thr_scratch_array(&m->own, columns + 1, sizeof *m->start);
  m->row = thr_scratch_array(&m->own, 2 * columns, sizeof *m->row);
  m->value = thr_scratch_array(&m->own, 2 * columns, sizeof *m->value);
  m->cost = thr_scratch_array(&m->own, columns, sizeof *m->cost);
  m->rhs = thr_scratch_array(&m->own, rows, sizeof *m->rhs);
  m->dual = thr_scratch_array(&m->own, rows, sizeof *m->dual);
  return thr_scratch_check(&m->own, err);
}

/* Costs of the contraction's programme: kept cells' turns, and what the others cost. */
static thr_status set_costs(master *m, thr_err *err)
{
  const thr_programme *small = &m->c->p;
  double scale = m->c->whole->scale[THR_AIM_TURNING];
  double *cost = thr_calloc((size_t)small->n + (size_t)m->r->extra, sizeof *cost);
  if (!cost) return thr_nomem(err);
  for (int y = 0; y < small->q->n_pairs; y++)
    cost[small->first_pair + y] = small->cost[THR_AIM_TURNING][small->first_pair + y] / scale;
  for (int i = 0; i < m->n; i++) {
    int d = m->c->becomes[m->type[m->first_type[i]]];
    for (int k = small->first[d]; k < small->first[d + 1]; k++)
      cost[small->first_pair + small->incident[k]] = 0;
    cost[small->n + d] = 1;
  }
  thr_status st = thr_lp_set_costs(m->r->search.lp, cost, err);
  free(cost);
  return st;
}

/* No cell has more darts, no cell of a better cover costs more. */
static thr_status find_most(master *m, const double *worth, thr_err *err)
{
  const thr_programme *p = m->c->whole;
  double *darts = thr_calloc((size_t)p->q->n_darts, sizeof *darts);
  if (!darts) return thr_nomem(err);
  m->most = worth[THR_AIM_TURNING] / p->scale[THR_AIM_TURNING];
  for (int k = 0; k < p->q->n_copies; k++)
    for (int i = 0; i < (p->q->copy[k].fold ? 1 : 2); i++) {
      int root = m->c->root[p->q->copy[k].dart[i]];
      m->most = fmax(m->most, darts[root] += p->most[k]);
    }
  free(darts);
  return THR_OK;
}

static thr_status master_init(master *m, const thr_contraction *contraction,
                              thr_relaxation *relaxation, int kept, const double *worth,
                              const thr_limits *limits, thr_err *err)
{
  const thr_aim *prefer = contraction->whole->o->prefer;
  *m = (master){.c = contraction, .r = relaxation, .limits = limits};
  thr_status st = list_cells(m, err);
  if (!st) st = list_copies(m, err);
  if (!st) st = make_room(m, err);
  if (!st) st = find_most(m, worth, err);
  if (!st && !relaxation->p)
    st = thr_relaxation_init(relaxation, &contraction->p, contraction->p.q->n_darts, limits, err);
  for (int k = kept; !st && prefer[k] != THR_AIM_TURNING; k++) {
    st = thr_relaxation_aim(relaxation, prefer[k], err);
    if (!st) st = thr_relaxation_fix(relaxation, worth[prefer[k]], err);
  }
  return st ? st : set_costs(m, err);
}

/* ---- cuts ---- */

/* Darts by type, of copies x. */
static void count_darts(master *m, const double *x)
{
  const thr_quotient *quotient = m->c->whole->q;
  for (int d = 0; d < quotient->n_darts; d++)
    m->used[d] = 0;
  for (int k = 0; k < quotient->n_copies; k++)
    for (int i = 0; i < (quotient->copy[k].fold ? 1 : 2); i++)
      m->used[quotient->copy[k].dart[i]] += x[k];
}

static int put(master *m, int n, int row, double value)
{
  m->row[n] = row;
  m->value[n] = value;
  return n + 1;
}

/* What a cell's own programme gives: multipliers of its types (shift), of ends and of self pairs
 * (before scaling). */
typedef struct {
  double ends, self;
} terminals;

/* Columns of the cell's programme; returns how many. */
static int fill_cell(master *m, int i)
{
  const thr_programme *p = m->c->whole;
  int types = m->first_type[i + 1] - m->first_type[i], columns = 0, n = 0;
  double price = 4 * p->scale[THR_AIM_TURNING]; /* of what does not fit: a cover never pays it */
  for (int k = m->first_pair[i]; k < m->first_pair[i + 1]; k++) {
    const thr_pair_type *pair_type = &p->q->pair[m->pair[k]];
    int a = m->place[pair_type->dart[0]], b = m->place[pair_type->dart[1]];
    m->start[columns] = n;
    m->cost[columns++] = p->cost[THR_AIM_TURNING][p->first_pair + m->pair[k]];
    n = put(m, n, a, pair_type->self || a != b ? 1 : 2);
    if (pair_type->self || a != b) n = put(m, n, pair_type->self ? types + 1 : b, 1);
  }
  for (int k = 0; k < types && may_end(p, m->type[m->first_type[i]]); k++) {
    m->start[columns] = n;
    m->cost[columns++] = 0;
    n = put(m, put(m, n, k, 1), types, 1);
  }
  for (int k = 0; k < 2 * (types + 2); k++) {
    m->start[columns] = n;
    m->cost[columns++] = price;
    n = put(m, n, k / 2, k % 2 ? 1 : -1);
  }
  m->start[columns] = n;
  return columns;
}

/* Lowers the multipliers by what rounding has left them above a column's cost. */
static void make_feasible(master *m, int columns, int rows)
{
  double above = 0;
  for (int j = 0; j < columns; j++) {
    double sum = -m->cost[j];
    for (int k = m->start[j]; k < m->start[j + 1]; k++)
      sum += m->value[k] * m->dual[m->row[k]];
    if (m->value[m->start[j]] > 0) above = fmax(above, sum);
  }
  for (int r = 0; r < rows; r++)
    m->dual[r] -= above;
}

/* Solves cell i at the point in m->used, with so many ends and self pairs. *value: what the
 * multipliers say. */
static thr_status solve_cell(master *m, int i, terminals at, double *value, terminals *mu,
                             thr_err *err)
{
  int first = m->first_type[i], types = m->first_type[i + 1] - first, columns = fill_cell(m, i);
  thr_lp *lp = NULL;
  thr_lp_outcome outcome = THR_LP_STOPPED;
  for (int k = 0; k < types; k++)
    m->rhs[k] = m->used[m->type[first + k]];
  m->rhs[types] = at.ends;
  m->rhs[types + 1] = at.self;
  thr_status st = thr_lp_create_equations(&lp, types + 2, m->rhs, columns, m->cost, NULL, m->start,
                                          m->row, m->value, err);
  if (!st) st = thr_lp_solve(lp, m->limits, &outcome, err);
  if (!st && outcome != THR_LP_OPTIMAL) st = THR_ELIMIT; /* it always has an optimum */
  if (!st) {
    thr_lp_dual(lp, m->dual);
    make_feasible(m, columns, types + 2);
    *value = 0;
    for (int k = 0; k < types + 2; k++)
      *value += m->dual[k] * m->rhs[k];
    for (int k = 0; k < types; k++)
      m->shift[m->type[first + k]] = m->dual[k];
    *mu = (terminals){m->dual[types], m->dual[types + 1]};
  }
  thr_lp_destroy(lp);
  return st;
}

/* Self pair of a contracted cell, as a column of the contraction; -1 = none. */
static int self_column(const master *m, int d)
{
  const thr_programme *small = &m->c->p;
  for (int k = small->first[d]; k < small->first[d + 1]; k++)
    if (small->q->pair[small->incident[k]].self) return small->first_pair + small->incident[k];
  return -1;
}

/* The row of cell i with the multipliers in m->shift. */
static thr_status add_cut(master *m, int i, terminals mu, thr_err *err)
{
  const thr_programme *small = &m->c->p;
  double scale = m->c->whole->scale[THR_AIM_TURNING];
  int d = m->c->becomes[m->type[m->first_type[i]]], self = self_column(m, d);
  for (int k = m->first_type[i]; k < m->first_type[i + 1]; k++)
    for (int l = m->first[m->type[k]]; l < m->first[m->type[k] + 1]; l++)
      thr_pool_put(&m->r->search.pool, m->copy[l] / 2, -m->shift[m->type[k]] / scale);
  thr_pool_put(&m->r->search.pool, small->first_end + d, -mu.ends / scale);
  if (self >= 0) thr_pool_put(&m->r->search.pool, self, -mu.self / scale);
  thr_pool_put(&m->r->search.pool, small->n + d, 1);
  return thr_relaxation_add_row(m->r, 0, err);
}

/* Cuts for the cells that cost more than x says; x: [small->n + extra] of the contraction. */
static thr_status add_cuts(master *m, const double *x, int *added, thr_err *err)
{
  const thr_programme *small = &m->c->p;
  double scale = m->c->whole->scale[THR_AIM_TURNING];
  thr_status st = THR_OK;
  count_darts(m, x);
  for (int i = 0; i < m->n && !st; i++) {
    int d = m->c->becomes[m->type[m->first_type[i]]], self = self_column(m, d);
    double value;
    terminals mu;
    st = thr_limits_stop(m->limits) ? THR_ELIMIT : THR_OK;
    if (!st)
      st = solve_cell(m, i, (terminals){x[small->first_end + d], self < 0 ? 0 : x[self]}, &value,
                      &mu, err);
    if (st || value / scale <= x[small->n + d] + 1e-6) continue;
    st = add_cut(m, i, mu, err);
    ++*added;
  }
  return st;
}

/* The cover as a point of the contraction's programme. */
static void contract_cover(const master *m, const int *cover, double *x)
{
  const thr_programme *p = m->c->whole, *small = &m->c->p;
  for (int k = 0; k < p->first_pair; k++)
    x[k] = cover[k];
  for (int d = 0; d < p->q->n_darts; d++)
    x[small->first_end + m->c->becomes[d]] += cover[p->first_end + d];
  for (int y = 0; y < p->q->n_pairs; y++) {
    int self = p->q->pair[y].self ? self_column(m, m->c->becomes[p->q->pair[y].dart[0]]) : -1;
    if (self >= 0) x[self] += cover[p->first_pair + y];
  }
}

static thr_status find_cuts(void *user, int *added, thr_err *err)
{
  master *m = user;
  return add_cuts(m, m->r->x, added, err);
}

/* A round: what its multipliers prove. */
static thr_status look(void *user, thr_err *err)
{
  master *m = user;
  const thr_programme *p = m->c->whole;
  double value;
  if (m->r->search.outcome != THR_LP_OPTIMAL && m->r->search.outcome != THR_LP_STOPPED)
    return THR_OK; /* rounding: the cover fits */
  thr_relaxation_look(m->r);
  thr_status st = thr_lp_proved(m->r->search.lp, m->most, &value, err);
  if (!st) m->bound = fmax(m->bound, made_safe(p, value * p->scale[THR_AIM_TURNING]));
  return st;
}

/* Solves, cuts, and so on until nothing is violated. */
static thr_status raise_bound(master *m, thr_err *err)
{
  thr_search *search = &m->r->search;
  const int separators = search->n_separators;
  const thr_search_calls calls = {.user = m, .look = look};
  thr_search_use(search, find_cuts, m, 0);
  thr_status st = thr_search_rounds(search, &calls, m->limits, err);
  search->n_separators = separators;
  return !st && search->outcome == THR_LP_STOPPED ? THR_ELIMIT : st;
}

/* The last basis with the columns of the cells whose cuts are the last rows: those hold with
 * equality at the known cover. */
static thr_status start_basis(master *m, int cuts, const bool *cut, thr_err *err)
{
  int rows = thr_lp_rows(m->r->search.lp), n = m->c->p.n + m->r->extra;
  bool *row = thr_calloc((size_t)rows, sizeof *row),
       *column = thr_calloc((size_t)n, sizeof *column);
  thr_status st = row && column ? THR_OK : thr_nomem(err);
  for (int i = 0; i < rows - cuts && !st; i++)
    row[i] = thr_lp_row_basic(m->r->search.lp, i);
  for (int j = 0; j < n && !st; j++)
    column[j] = thr_lp_column_basic(m->r->search.lp, j) || (j >= m->c->p.n && cut[j - m->c->p.n]);
  if (!st) st = thr_lp_set_basis(m->r->search.lp, row, column, err);
  free(row);
  free(column);
  return st;
}

/* Every cell's cut that the multipliers of the quick bound give: no programme whose columns cost
 * that much says less. */
static thr_status add_quick_cuts(master *m, thr_err *err)
{
  const thr_programme *p = m->c->whole;
  thr_status st = THR_OK;
  ascend(p, false, m->shift);
  for (int i = 0; i < m->n && !st; i++) {
    double most = 0;
    for (int k = m->first_type[i]; k < m->first_type[i + 1]; k++)
      most = fmax(most, m->shift[m->type[k]]);
    st = add_cut(m, i, (terminals){-most, 0}, err);
  }
  return st;
}

/* Cuts at the known cover, and a basis with them if there was a solve before. */
static thr_status add_first_cuts(master *m, const int *cover, bool solved, thr_err *err)
{
  const thr_contraction *contraction = m->c;
  int before, added = 0;
  double *x = thr_calloc((size_t)contraction->p.n + (size_t)m->r->extra, sizeof *x);
  bool *cut = thr_calloc((size_t)m->r->extra, sizeof *cut);
  thr_status st = x && cut ? add_quick_cuts(m, err) : thr_nomem(err);
  before = m->r->search.pool.count;
  if (!st) {
    contract_cover(m, cover, x);
    for (int i = 0; i < m->n; i++) /* every cell gets one, whatever it costs */
      x[contraction->p.n + contraction->becomes[m->type[m->first_type[i]]]] = -1;
    st = add_cuts(m, x, &added, err);
  }
  for (int i = 0; i < m->n && !st; i++)
    cut[contraction->becomes[m->type[m->first_type[i]]]] = true;
  if (!st && solved) st = thr_search_load(&m->r->search, err);
  if (!st && solved) st = start_basis(m, m->r->search.pool.count - before, cut, err);
  free(x);
  free(cut);
  return st;
}

thr_status thr_turning_bound(const thr_contraction *contraction, thr_relaxation *relaxation,
                             int kept, const int *cover, const double worth[THR_N_AIMS],
                             const thr_limits *limits, double *bound, thr_err *err)
{
  bool solved = relaxation->p;
  master m;
  thr_status st = master_init(&m, contraction, relaxation, kept, worth, limits, err);
  m.bound = *bound;
  if (!st) st = add_first_cuts(&m, cover, solved, err);
  if (!st) st = raise_bound(&m, err);
  *bound = m.bound;
  thr_scratch_free(&m.own);
  return st;
}
