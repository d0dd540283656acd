/* Multipliers of partitions and groups by subgradient steps over matchings of passes. */
#include "tortuosity/proof/connect.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/process/threads.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/proof/pass_matching.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  ROWS = 300,    /* kept at a time */
  PATIENCE = 15, /* steps without a better bound until they are made smaller */
  SMALL = 3000,  /* columns of a framework whose programmes take less time than many steps */
  FEW_TURNS = 4, /* per edge; a node of four edges has three */
  FEW = 10,      /* steps for one closed cord where programmes take less time than many of them */
  MANY = 60,     /* at least for larger frameworks, and as many more as WORK allows */
  WORK = 2000000 /* columns that steps together look at */
};

/* A row with its multiplier, in units of 2^-THR_TURNING_BITS. */
typedef struct {
  bool group;
  uint64_t name;
  int *block; /* [n_edges] of the partition; of a group 1 in it, 0 outside; owned */
  double right;
  int n, room;
  int *column; /* [room] with a coefficient (blocks - 1) / (blocks * parts); blocks 0: 1; owned */
  int *blocks; /* [room] blocks * 2 + parts - 1; owned */
  int64_t value, best;
} row;

typedef struct {
  thr_branch *branch;
  thr_pass_matching *passes;
  const int64_t *base; /* [n_columns] prices without rows */
  const thr_limits *limits;
  int n_rows;
  row row[ROWS];
  int *part, n_parts;    /* [n_edges] of the last matching */
  int64_t *price, *left; /* [n_columns] */
  int *x;                /* [n_columns] */
  bool *even;            /* [n_edges] scratch */
  int *scratch;          /* [n_edges + n_components] */
  thr_turning_dual dual;
  double best;    /* bound */
  thr_branch own; /* beside the search: joins a matching while the next one is found */
  int *joined;    /* [n_columns] that matching */
} connect;

/* ---- rows ---- */

static void row_destroy(row *r)
{
  free(r->block);
  free(r->column);
  free(r->blocks);
  *r = (row){0};
}

static thr_status add_entry(row *r, int column, int blocks, int parts, thr_err *err)
{
  int room = r->room, again = r->room;
  thr_status st = thr_grow(&r->column, r->n, &room, sizeof *r->column, err);
  if (!st && room > again) st = thr_grow(&r->blocks, r->n, &again, sizeof *r->blocks, err);
  if (st) return st;
  r->room = room;
  r->column[r->n] = column;
  r->blocks[r->n++] = 2 * blocks + parts - 1;
  return THR_OK;
}

static double coefficient(const row *r, int i)
{
  int b = r->blocks[i] / 2;
  return b ? (b - 1.0) / (b * (r->blocks[i] % 2 + 1.0)) : 1;
}

/* As the checker takes it off a price: rounded up. */
static int64_t share(const row *r, int i)
{
  int64_t b = r->blocks[i] / 2, by = b * (r->blocks[i] % 2 + 1);
  return b ? r->value / by * (b - 1) + (r->value % by * (b - 1) + by - 1) / by : r->value;
}

/* The turns at node v between blocks; of a partition also the extra passes of blocks that have an even number there. */
static thr_status fill_node(connect *s, row *r, int v, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  const int *half = c->f->half + c->f->first[v];
  int d = thr_degree(c->f, v), odd, apart = 0;
  for (int i = 1; i < d; i++)
    apart |= r->block[half[i] >> 1] != r->block[half[0] >> 1];
  if (!apart) return THR_OK;
  int b = r->group ? 0 : thr_turning_blocks_at(c, r->block, v, &odd, s->even);
  thr_status st = THR_OK;
  for (int i = 0; i < d && !st; i++) {
    for (int k = i + 1; k < d && !st; k++)
      if (r->block[half[i] >> 1] != r->block[half[k] >> 1]) st = add_entry(r, thr_turning_column(c, half[i], half[k]), b, 1, err);
    if (!st && b && s->even[i]) st = add_entry(r, c->first_extra + (half[i] >> 1), b, 2, err);
  }
  if (b) r->right -= odd * (b - 1.0) / (2.0 * b);
  return st;
}

static thr_status fill_row(connect *s, row *r, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  thr_status st = THR_OK;
  r->right = r->group ? 2 : thr_turning_connections(c, r->block, s->scratch);
  for (int v = 0; v < c->f->n_nodes && !st; v++)
    st = fill_node(s, r, v, err);
  for (int j = c->first_end; j < c->first_back && r->group && !st; j++)
    if (r->block[c->half[j][0] >> 1]) st = add_entry(r, j, 0, 1, err);
  return st;
}

static uint64_t name_of(const int *block, int n, bool group)
{
  uint64_t name = group ? 2 : 1;
  for (int e = 0; e < n; e++)
    name = (name ^ (uint64_t)block[e]) * UINT64_C(0x9e3779b97f4a7c15) + 1;
  return name;
}

/* Drops rows without a multiplier where there is no room for another. */
static void make_room(connect *s)
{
  int kept = 0;
  for (int i = 0; i < s->n_rows; i++) {
    bool idle = s->row[i].value == 0 && s->row[i].best == 0;
    if (idle)
      row_destroy(&s->row[i]);
    else
      s->row[kept++] = s->row[i];
  }
  s->n_rows = kept;
}

static thr_status add_row(connect *s, bool group, const int *block, thr_err *err)
{
  size_t m = (size_t)s->branch->c->f->n_edges;
  row r = {.group = group, .name = name_of(block, (int)m, group)};
  for (int i = 0; i < s->n_rows; i++)
    if (s->row[i].name == r.name) return THR_OK;
  if (s->n_rows == ROWS) make_room(s);
  if (s->n_rows == ROWS) return THR_OK;
  if (!(r.block = thr_calloc(m, sizeof *r.block))) return thr_nomem(err);
  memcpy(r.block, block, m * sizeof *block);
  thr_status st = fill_row(s, &r, err);
  if (st)
    row_destroy(&r);
  else
    s->row[s->n_rows++] = r;
  return st;
}

/* Partitions on the way of Kruskal's method. */
static thr_status add_partition(void *user, const int *part, int n, thr_err *err)
{
  return n > 1 ? add_row(user, false, part, err) : THR_OK;
}

/* Every part that no cord ends in is a group, between closed cords too. */
static thr_status add_groups(connect *s, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  int m = c->f->n_edges, *block = thr_calloc((size_t)m, sizeof *block);
  bool *ended = thr_calloc((size_t)s->n_parts, sizeof *ended);
  thr_status st = block && ended ? THR_OK : thr_nomem(err);
  for (int j = c->first_end; j < c->first_back && !st; j++)
    if (s->x[j] > 0) ended[s->part[c->half[j][0] >> 1]] = true;
  for (int p = 0; p < s->n_parts && !st; p++) {
    for (int e = 0; e < m; e++)
      block[e] = s->part[e] == p;
    if (!ended[p]) st = add_row(s, true, block, err);
  }
  free(block);
  free(ended);
  return st;
}

static thr_status add_rows(connect *s, int step, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  bool open = c->task->end_allowed != NULL, single = c->task->cords == 1;
  thr_status st = THR_OK;
  if (s->n_parts <= c->n_components && !open) return THR_OK;
  if (!open && step % 10 == 0) st = thr_connect_chain(c, s->x, s->part, s->n_parts, add_partition, s, err);
  if (!st && !open) st = add_row(s, false, s->part, err);
  if (!st && (open || (single && step % 5 == 0 && s->n_parts > c->n_components && c->n_components == 1))) st = add_groups(s, err);
  return st;
}

/* ---- steps ---- */

/* What the multipliers pay too much for columns that the matching does not know, as often as a plan may have them. */
static thr_status overpaid(connect *s, double *sum, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  thr_status st = thr_pass_left(s->passes, s->price, &s->dual, 0, false, s->left, err);
  *sum = 0;
  for (int j = 0; j < c->first_back && !st; j++) {
    bool extra = j >= c->first_extra && j < c->first_end;
    if ((extra || !s->passes->listed[j]) && s->left[j] < 0) *sum -= (double)s->left[j] * thr_turning_most(c, j);
  }
  return st;
}

static thr_status solve(connect *s, double *bound, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  thr_turning_dual_drop_odd(&s->dual, 0);
  thr_status st = thr_pass_matching_solve(s->passes, s->price, s->limits, s->x, &s->dual, err);
  for (int j = 0; j < c->n_columns && !st; j++)
    *bound += s->x[j] * (double)s->price[j];
  return st;
}

/* The matching under the multipliers, of the copies that there are, or of more where that is better: its value, and what it
 * proves. */
static thr_status match(connect *s, double *value, double *bound, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  double sum = 0, over = 0;
  memcpy(s->price, s->base, (size_t)c->n_columns * sizeof *s->price);
  for (int i = 0; i < s->n_rows; i++) {
    const row *r = &s->row[i];
    for (int k = 0; k < r->n && r->value > 0; k++)
      s->price[r->column[k]] -= share(r, k);
    sum += r->right * (double)r->value;
  }
  *bound = sum;
  s->passes->most_rounds = 1;
  thr_status st = solve(s, bound, err);
  if (!st) st = overpaid(s, &over, err);
  s->passes->most_rounds = 3;
  if (!st && over > 0 && *bound >= s->best) {
    *bound = sum;
    st = solve(s, bound, err);
    if (!st) st = overpaid(s, &over, err);
  }
  *value = *bound;
  *bound -= over;
  if (!st) s->n_parts = thr_connect_parts(c, s->x, s->part);
  return st;
}

/* How much a row lacks. */
static double lack(const connect *s, const row *r)
{
  double sum = 0;
  for (int k = 0; k < r->n; k++)
    if (s->x[r->column[k]]) sum += coefficient(r, k) * s->x[r->column[k]];
  return r->right - sum;
}

/* One step along what the rows lack; false: nothing is lacking. */
static bool move(connect *s, double value, double part)
{
  double slope[ROWS], squares = 0, target = (double)s->branch->best_price;
  if (!s->branch->found) target = 1.05 * value;
  for (int i = 0; i < s->n_rows; i++) {
    slope[i] = lack(s, &s->row[i]);
    if (slope[i] < 0 && s->row[i].value == 0) slope[i] = 0;
    squares += slope[i] * slope[i];
  }
  if (squares < 1e-12) return false;
  for (int i = 0; i < s->n_rows; i++)
    s->row[i].value = (int64_t)fmax(0, (double)s->row[i].value + part * fmax(0, target - value) / squares * slope[i]);
  return true;
}

static void keep_values(connect *s, bool back)
{
  for (int i = 0; i < s->n_rows; i++)
    *(back ? &s->row[i].value : &s->row[i].best) = back ? s->row[i].best : s->row[i].value;
}

static bool few_turns(const thr_turning_columns *c)
{
  return c->first_extra / FEW_TURNS <= c->f->n_edges;
}

bool thr_connect_later(const thr_turning_columns *turning_columns)
{
  return turning_columns->n_columns < SMALL || few_turns(turning_columns);
}

/* The first step makes a plan of the matching. */
static int steps_of(const thr_turning_columns *c)
{
  bool single = !c->task->end_allowed && c->task->cords == 1;
  if (!thr_connect_later(c)) return MANY + WORK / c->n_columns;
  return !single ? 0 : c->n_columns < SMALL ? FEW : 1;
}

/* Does the bound close the search? */
static bool is_enough(const connect *s)
{
  return s->branch->found && s->best >= (double)(s->branch->best_price - thr_branch_tolerance(s->branch) / 2);
}

/* The plan of a matching, and beside it the next matching. */
typedef struct {
  connect *s;
  int step;
  double *value, *bound;
} pair;

static thr_status join_or_match(void *user, int job, const thr_limits *limits, thr_err *err)
{
  const pair *p = user;
  connect *s = p->s;
  (void)limits;
  return job == 0 ? thr_branch_try_joined(&s->own, s->joined, (p->step - 1) % 50 == 0, err) : match(s, p->value, p->bound, err);
}

/* The matching of a step; the search has the plan of that before, and at once the plan of the first. */
static thr_status step_on(connect *s, int step, double *value, double *bound, thr_err *err)
{
  if (step == 0) return thr_branch_try_joined(s->branch, s->x, true, err);
  if (step == 1) {
    thr_status st = thr_branch_gather(s->branch, err);
    if (!st) st = thr_branch_init(&s->own, s->branch->c, 1, &s->branch->quiet, err);
    return st ? st : match(s, value, bound, err);
  }
  thr_branch_brief(&s->own, s->branch);
  const thr_status st = thr_team_share(s->branch->team, 2, join_or_match, &(pair){s, step, value, bound}, err);
  const thr_status taken = thr_branch_take(s->branch, &s->own, st ? NULL : err); /* of a stopped step, too */
  return st ? st : taken;
}

static thr_status climb(connect *s, double bound, thr_err *err)
{
  double part = 1, value = bound;
  int idle = 0, steps = steps_of(s->branch->c), step = 0;
  thr_status st = THR_OK;
  s->best = bound;
  for (; step < steps && !is_enough(s) && !thr_limits_stop(s->limits); step++) {
    if ((st = step_on(s, step, &value, &bound, err))) return st;
    memcpy(s->joined, s->x, (size_t)s->branch->c->n_columns * sizeof *s->x);
    idle = bound > s->best ? 0 : idle + 1;
    if (bound > s->best || step == 0) {
      s->best = bound;
      keep_values(s, false);
    }
    if ((st = add_rows(s, step, err))) return st;
    if (idle > PATIENCE) {
      part *= 0.6;
      idle = 0;
      keep_values(s, true);
    }
    if (!move(s, value, part)) break;
  }
  return step > 1 && !is_enough(s) ? thr_branch_try_joined(s->branch, s->joined, false, err) : THR_OK;
}

/* ---- the proof ---- */

static thr_status add_to_dual(thr_turning_dual *dual, const row *r, int n_edges, thr_err *err)
{
  int members = 0, *member = thr_calloc((size_t)n_edges, sizeof *member);
  if (!member) return thr_nomem(err);
  for (int e = 0; e < n_edges; e++)
    if (!r->group || r->block[e]) member[members++] = r->group ? e : r->block[e];
  if (r->group)
    dual->group[dual->n_groups++] = (thr_turning_set){members, member, r->value};
  else
    dual->partition[dual->n_partitions++] = (thr_turning_partition){member, r->value};
  return THR_OK;
}

/* The best multipliers once more, with the moats of their matching. */
static thr_status prove(connect *s, thr_err *err)
{
  double value, bound;
  thr_turning_dual dual;
  keep_values(s, true);
  thr_status st = match(s, &value, &bound, err);
  if (st) return st;
  dual = s->dual;
  s->dual = (thr_turning_dual){0};
  dual.group = thr_calloc((size_t)s->n_rows, sizeof *dual.group);
  dual.partition = thr_calloc((size_t)s->n_rows, sizeof *dual.partition);
  if (!dual.group || !dual.partition) st = thr_nomem(err);
  for (int i = 0; i < s->n_rows && !st; i++)
    if (s->row[i].value > 0) st = add_to_dual(&dual, &s->row[i], s->branch->c->f->n_edges, err);
  if (!st) return thr_branch_keep_dual(s->branch, 0, dual, NULL, NULL, err);
  thr_turning_dual_destroy(&dual);
  return st;
}

thr_status thr_connect(thr_branch *branch, thr_pass_matching *passes, const int64_t *price, const int *x,
                       const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *c = branch->c;
  size_t n = (size_t)c->n_columns, m = (size_t)c->f->n_edges;
  thr_scratch own = {0};
  thr_err why = {0};
  connect *s = thr_scratch_array(&own, 1, sizeof *s);
  if (!s) return thr_nomem(err);
  *s = (connect){.branch = branch,
                 .passes = passes,
                 .base = price,
                 .limits = limits,
                 .part = thr_scratch_array(&own, m, sizeof *s->part),
                 .price = thr_scratch_array(&own, n, sizeof *s->price),
                 .left = thr_scratch_array(&own, n, sizeof *s->left),
                 .x = thr_scratch_array(&own, n, sizeof *s->x),
                 .joined = thr_scratch_array(&own, n, sizeof *s->joined),
                 .even = thr_scratch_array(&own, m, sizeof *s->even),
                 .scratch = thr_scratch_array(&own, m + (size_t)c->n_components, sizeof *s->scratch)};
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_turning_dual_init(&s->dual, c, err);
  if (!st) {
    double bound = 0;
    memcpy(s->x, x, n * sizeof *x);
    for (size_t j = 0; j < n; j++)
      bound += x[j] * (double)price[j];
    s->n_parts = thr_connect_parts(c, x, s->part);
    thr_pass_matching_shrink(passes, x);
    st = climb(s, bound, &why);
    if (!st && s->best > bound) st = prove(s, &why);
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", why.text);
  }
  for (int i = 0; i < s->n_rows; i++)
    row_destroy(&s->row[i]);
  thr_turning_dual_destroy(&s->dual);
  thr_branch_destroy(&s->own);
  thr_scratch_free(&own);
  return st == THR_ELIMIT ? THR_OK : st;
}
