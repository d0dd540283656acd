/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchanges at the nodes of a whole solution: sets are joined, turning gets less. */
#include "graph/disjoint.h"
#include "symmetry/cover/cover.h"

#include <stdlib.h>

/* Of the columns out[] one less, of the columns in[] one more. */
typedef struct {
  int out[2], in[2];
  int type[2];    /* dart types of the two turns that are broken up */
  double turning; /* more than before */
} exchange;

/* Cheapest pair column between dart types a and b, -1 = none. */
static int pair_between(const thr_programme *p, int a, int b, bool self)
{
  int best = -1;
  for (int k = p->first[a]; k < p->first[a + 1]; k++) {
    const thr_pair_type *pair_type = &p->q->pair[p->incident[k]];
    int j = p->first_pair + p->incident[k];
    if (p->most[j] == 0 || pair_type->self != self ||
        pair_type->dart[0] + pair_type->dart[1] != a + b ||
        (pair_type->dart[0] != a && pair_type->dart[1] != a))
      continue;
    if (best < 0 || p->cost[THR_AIM_TURNING][j] < p->cost[THR_AIM_TURNING][best]) best = j;
  }
  return best;
}

static void apply(const exchange *x, int sign, int *value)
{
  for (int i = 0; i < 2; i++) {
    value[x->out[i]] -= sign;
    value[x->in[i]] += sign;
  }
}

/* Enough of what is taken out; and where joints are tied, the node stays so if it was. parent:
 * [p->ties->most] scratch. */
static bool possible(const thr_programme *p, const exchange *x, int *value, int *parent)
{
  if (value[x->out[0]] <= 0 || value[x->out[1]] <= (x->out[0] == x->out[1])) return false;
  int star = p->ties ? p->ties->star[x->type[0]] : -1;
  if (star < 0 || !thr_ties_tied(p->ties, star, value + p->first_pair, parent)) return true;
  apply(x, 1, value);
  bool tied = thr_ties_tied(p->ties, star, value + p->first_pair, parent);
  apply(x, -1, value);
  return tied;
}

/* What visits the exchanges; false = no more of this turn. */
typedef struct visitor {
  bool (*visit)(struct visitor *v, const exchange *x, thr_err *err, thr_status *st);
  const thr_programme *p;
  int *value;
  int *parent; /* as for possible() */
  thr_programme_parts parts;
  /* mending */
  exchange *list;
  int n, capacity;
  /* improving */
  const thr_limits *limits;
  double worth[THR_N_AIMS];
  bool better;
  /* trying */
  bool level; /* only what turns no more */
  thr_status (*attempt)(void *user, thr_err *err);
  void *user;
} visitor;

static thr_status visitor_init(visitor *v, thr_err *err)
{
  v->parent = thr_calloc(v->p->ties ? (size_t)v->p->ties->most : 0, sizeof *v->parent);
  return v->parent ? THR_OK : thr_nomem(err);
}

static bool offer(visitor *v, int out0, int out1, int in0, int in1, int a, int c, thr_err *err,
                  thr_status *st)
{
  const double *cost = v->p->cost[THR_AIM_TURNING];
  if (in0 < 0 || in1 < 0) return true;
  exchange x = {{out0, out1}, {in0, in1}, {a, c}, cost[in0] + cost[in1] - cost[out0] - cost[out1]};
  return !possible(v->p, &x, v->value, v->parent) || v->visit(v, &x, err, st);
}

/* The pair column j with dart types a and b, against everything that dart type c does. */
static bool against(visitor *v, int j, int a, int b, int c, thr_err *err, thr_status *st)
{
  const thr_programme *p = v->p;
  int with = pair_between(p, a, c, false), end = p->first_end + c;
  if (with < 0) return true;
  for (int k = p->first[c]; k < p->first[c + 1]; k++) {
    int y = p->first_pair + p->incident[k];
    const thr_pair_type *pair_type = &p->q->pair[p->incident[k]];
    if (v->value[y] <= 0) continue;
    int in = pair_type->self
                 ? pair_between(p, b, b, true)
                 : pair_between(p, b, pair_type->dart[0] + pair_type->dart[1] - c, false);
    if (!offer(v, j, y, with, in, a, c, err, st)) return false;
  }
  return v->value[end] <= 0 || p->most[p->first_end + b] == 0 ||
         offer(v, j, end, with, p->first_end + b, a, c, err, st);
}

/* Visits the exchanges of a turn with what meets it. */
static thr_status visit_turn(visitor *v, int y, thr_err *err)
{
  const thr_programme *p = v->p;
  const thr_pair_type *pair_type = &p->q->pair[y];
  thr_status st = THR_OK;
  bool go_on = !pair_type->self;
  for (int i = 0; i < 2 && go_on; i++) {
    int a = pair_type->dart[i], b = pair_type->dart[1 - i], last = -1;
    for (int k = p->first[a]; k < p->first[a + 1] && go_on; k++) {
      const thr_pair_type *r = &p->q->pair[p->incident[k]];
      int c = r->dart[0] + r->dart[1] - a;
      if (r->self || c == last) continue; /* turns between two types follow each other */
      last = c;
      go_on = against(v, p->first_pair + y, a, b, c, err, &st);
    }
  }
  return st;
}

/* ---- mending ---- */

static bool in_need(const visitor *v, int root)
{
  return (v->p->open ? v->parts.ends : v->parts.terminals)[root] == 0;
}

static bool collect(visitor *v, const exchange *x, thr_err *err, thr_status *st)
{
  const int *root = v->parts.root;
  if (root[x->type[1]] < 0 || root[x->type[1]] == root[x->type[0]]) return true;
  *st = thr_grow(&v->list, v->n, &v->capacity, sizeof *v->list, err);
  if (!*st) v->list[v->n++] = *x;
  return !*st;
}

static int by_turning(const void *a, const void *b)
{
  const exchange *x = a, *y = b;
  if (x->turning < y->turning || x->turning > y->turning) return x->turning < y->turning ? -1 : 1;
  for (int i = 0; i < 2; i++) {
    if (x->out[i] != y->out[i]) return x->out[i] < y->out[i] ? -1 : 1;
    if (x->in[i] != y->in[i]) return x->in[i] < y->in[i] ? -1 : 1;
  }
  return 0;
}

/* Joins two sets if one is in need. The sums of both stay with the root. */
static void join_sets(visitor *v, const exchange *x)
{
  thr_programme_parts *programme_parts = &v->parts;
  int a = thr_disjoint_find(programme_parts->root, x->type[0]),
      b = thr_disjoint_find(programme_parts->root, x->type[1]);
  if (a == b || !possible(v->p, x, v->value, v->parent) || (!in_need(v, a) && !in_need(v, b)))
    return;
  int terminals = programme_parts->terminals[a] + programme_parts->terminals[b],
      ends = programme_parts->ends[a] + programme_parts->ends[b];
  apply(x, 1, v->value);
  thr_disjoint_join(programme_parts->root, a, b);
  a = thr_disjoint_find(programme_parts->root, a);
  programme_parts->terminals[a] = terminals;
  programme_parts->ends[a] = ends;
}

static int count_in_need(const visitor *v)
{
  int n = 0;
  for (int d = 0; d < v->p->q->n_darts; d++)
    n += v->parts.root[d] == d && in_need(v, d);
  return n;
}

/* A set without terminals stays connected when a turn in it is broken up: its sets join for
 * certain. One with folds may fall apart, and leave as many sets in need as before: then this ends.
 */
thr_status thr_programme_mend(const thr_programme *p, int *value, thr_err *err)
{
  visitor v = {.visit = collect, .p = p, .value = value};
  thr_status st = visitor_init(&v, err);
  if (!st) st = thr_programme_parts_init(&v.parts, p, err);
  for (int before = -1; !st;) {
    thr_programme_parts_find(&v.parts, p, value);
    int now = count_in_need(&v);
    if (now == 0 || (before >= 0 && now >= before)) break;
    before = now;
    v.n = 0;
    for (int y = 0; y < p->q->n_pairs && !st; y++) {
      int root = v.parts.root[p->q->pair[y].dart[0]];
      if (value[p->first_pair + y] > 0 && in_need(&v, root)) st = visit_turn(&v, y, err);
    }
    if (v.n > 0) qsort(v.list, (size_t)v.n, sizeof *v.list, by_turning);
    for (int i = 0; i < v.n && !st; i++)
      join_sets(&v, &v.list[i]);
  }
  thr_programme_parts_destroy(&v.parts);
  free(v.list);
  free(v.parent);
  return st;
}

thr_status thr_programme_open(const thr_programme *p, int *value, thr_err *err)
{
  visitor v = {.p = p, .value = value};
  thr_programme_parts *programme_parts = &v.parts;
  thr_status st = visitor_init(&v, err);
  if (!st) st = thr_programme_parts_init(programme_parts, p, err);
  if (!st) thr_programme_parts_find(programme_parts, p, value);
  for (int y = 0; y < p->q->n_pairs && p->open && !st; y++) {
    const int *d = p->q->pair[y].dart;
    int root = programme_parts->root[d[0]], star = p->ties ? p->ties->star[d[0]] : -1,
        end[2] = {p->first_end + d[0], p->first_end + d[1]};
    if (value[p->first_pair + y] == 0 || p->q->pair[y].self || programme_parts->ends[root] > 0 ||
        p->most[end[0]] == 0)
      continue;
    value[p->first_pair + y]--;
    if (star >= 0 && !thr_ties_tied(p->ties, star, value + p->first_pair, v.parent)) {
      value[p->first_pair + y]++;
      continue;
    }
    value[end[0]]++;
    value[end[1]]++;
    programme_parts->ends[root] += 2;
  }
  thr_programme_parts_destroy(programme_parts);
  free(v.parent);
  return st;
}

/* ---- improving ---- */

static bool take(visitor *v, const exchange *x, thr_err *err, thr_status *st)
{
  (void)err;
  (void)st;
  if (x->turning >= -thr_programme_tolerance(v->p, THR_AIM_TURNING)) return true;
  apply(x, 1, v->value);
  v->better = true;
  return false;
}

/* Of several turns between two types the cheapest, unless they tie what it does not. */
static void take_cheapest(visitor *v)
{
  const thr_programme *p = v->p;
  for (int y = 0; y < p->q->n_pairs; y++) {
    const thr_pair_type *pair_type = &p->q->pair[y];
    int from = p->first_pair + y,
        to = pair_between(p, pair_type->dart[0], pair_type->dart[1], pair_type->self),
        moved = v->value[from];
    int star = p->ties ? p->ties->star[pair_type->dart[0]] : -1;
    if (moved == 0 || to < 0 || to == from) continue;
    bool tied = star >= 0 && thr_ties_tied(p->ties, star, v->value + p->first_pair, v->parent);
    v->value[from] = 0;
    v->value[to] += moved;
    if (!tied || thr_ties_tied(p->ties, star, v->value + p->first_pair, v->parent)) continue;
    v->value[from] = moved;
    v->value[to] -= moved;
  }
}

thr_status thr_programme_straighten(const thr_programme *p, const thr_limits *limits, int *value,
                                    thr_err *err)
{
  visitor v = {.visit = take, .p = p, .value = value, .better = true};
  thr_status st = visitor_init(&v, err);
  if (!st) take_cheapest(&v);
  while (v.better && !st) {
    v.better = false;
    for (int y = 0; y < p->q->n_pairs && !st && !thr_limits_stop(limits); y++)
      if (value[p->first_pair + y] > 0) st = visit_turn(&v, y, err);
  }
  free(v.parent);
  return st;
}

static bool improve(visitor *v, const exchange *x, thr_err *err, thr_status *st)
{
  double worth[THR_N_AIMS];
  bool valid;
  if (x->turning >= -thr_programme_tolerance(v->p, THR_AIM_TURNING)) return true;
  if (thr_limits_stop(v->limits)) return false;
  apply(x, 1, v->value);
  *st = thr_programme_value(v->p, v->value, worth, &valid, err);
  if (!*st && valid && thr_programme_compare(v->p, worth, v->worth) < 0) {
    for (int a = 0; a < THR_N_AIMS; a++)
      v->worth[a] = worth[a];
    v->better = true;
    return false;
  }
  apply(x, -1, v->value);
  return !*st;
}

thr_status thr_programme_improve(const thr_programme *p, const thr_limits *limits, int *value,
                                 thr_err *err)
{
  visitor v = {.visit = improve, .p = p, .value = value, .limits = limits, .better = true};
  bool valid = true;
  thr_status st = visitor_init(&v, err);
  if (!st) take_cheapest(&v);
  if (!st) st = thr_programme_value(p, value, v.worth, &valid, err);
  while (v.better && !st && valid) {
    v.better = false;
    for (int y = 0; y < p->q->n_pairs && !st && !thr_limits_stop(limits); y++)
      if (value[p->first_pair + y] > 0) st = visit_turn(&v, y, err);
  }
  free(v.parent);
  return st;
}

/* ---- trying ---- */

static bool attempt(visitor *v, const exchange *x, thr_err *err, thr_status *st)
{
  if (v->level && x->turning > thr_programme_tolerance(v->p, THR_AIM_TURNING)) return true;
  apply(x, 1, v->value);
  *st = v->attempt(v->user, err);
  apply(x, -1, v->value);
  return !*st;
}

thr_status thr_programme_attempt(const thr_programme *p, int *value, bool level,
                                 thr_status (*attempt_one)(void *user, thr_err *err), void *user,
                                 thr_err *err)
{
  visitor v = {.visit = attempt,
               .p = p,
               .value = value,
               .level = level,
               .attempt = attempt_one,
               .user = user};
  thr_status st = visitor_init(&v, err);
  for (int y = 0; y < p->q->n_pairs && !st; y++)
    if (value[p->first_pair + y] > 0) st = visit_turn(&v, y, err);
  free(v.parent);
  return st;
}
