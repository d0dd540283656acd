/* Cells of dart types: made and undone. */
#include "symmetry/contraction.h"
#include "graph/disjoint.h"

#include <stdlib.h>
#include <string.h>

/* ---- making ---- */

static bool allowed(const thr_programme *p, int pair)
{
  return p->most[p->first_pair + pair] != 0;
}

/* Types and turns of the cell with lowest type d: how many types, and does one turn into itself? */
static void find_cells(thr_contraction *c, int *count, bool *loop)
{
  const thr_quotient *q = c->whole->q;
  for (int d = 0; d < q->n_darts; d++)
    c->root[d] = d;
  for (int y = 0; y < q->n_pairs; y++)
    if (allowed(c->whole, y)) thr_disjoint_join(c->root, q->pair[y].dart[0], q->pair[y].dart[1]);
  for (int d = 0; d < q->n_darts; d++)
    count[c->root[d] = thr_disjoint_find(c->root, d)]++;
  for (int y = 0; y < q->n_pairs; y++)
    if (allowed(c->whole, y) && !q->pair[y].self && q->pair[y].dart[0] == q->pair[y].dart[1])
      loop[c->root[q->pair[y].dart[0]]] = true;
}

thr_status thr_contraction_init(thr_contraction *c, const thr_programme *whole, bool all, thr_err *err)
{
  *c = (thr_contraction){.whole = whole};
  size_t n = (size_t)whole->q->n_darts;
  int *count = thr_calloc(n, sizeof *count);
  bool *loop = thr_calloc(n, sizeof *loop);
  c->root = thr_calloc(n, sizeof *c->root);
  c->keep = thr_calloc(n, sizeof *c->keep);
  c->becomes = thr_calloc(n, sizeof *c->becomes);
  c->pair = thr_calloc((size_t)whole->q->n_pairs, sizeof *c->pair);
  thr_status st = count && loop && c->root && c->keep && c->becomes && c->pair ? THR_OK : thr_nomem(err);
  if (!st) {
    find_cells(c, count, loop);
    for (int d = 0; d < whole->q->n_darts; d++)
      c->keep[d] = !all && count[d] < 3 && !loop[d];
    st = thr_contraction_make(c, err);
  }
  free(count);
  free(loop);
  if (st) thr_contraction_destroy(c);
  return st;
}

static void unmake(thr_contraction *c)
{
  thr_programme_destroy(&c->p);
  free(c->q.copy);
  free(c->q.dart);
  free(c->q.pair);
  c->q = (thr_quotient){0};
}

void thr_contraction_destroy(thr_contraction *c)
{
  unmake(c);
  free(c->root);
  free(c->keep);
  free(c->becomes);
  free(c->pair);
  *c = (thr_contraction){0};
}

/* Of a contracted cell one turn and one self pair at most; made[2 * type + self] is 1 more than its number, 0 = none yet. */
static void contract_pairs(thr_contraction *c, int *made)
{
  const thr_quotient *q = c->whole->q;
  for (int y = 0; y < q->n_pairs; y++) {
    int root = c->root[q->pair[y].dart[0]], *known = &made[2 * root + q->pair[y].self];
    c->pair[y] = c->q.n_pairs;
    if (!c->keep[root]) {
      c->pair[y] = allowed(c->whole, y) ? (*known ? *known - 1 : c->q.n_pairs) : -1;
      if (c->pair[y] < c->q.n_pairs) continue;
      *known = c->q.n_pairs + 1;
    }
    thr_pair_type *t = &c->q.pair[c->q.n_pairs++];
    *t = q->pair[y];
    for (int i = 0; i < 2; i++)
      t->dart[i] = c->becomes[c->keep[root] ? t->dart[i] : root];
  }
}

thr_status thr_contraction_make(thr_contraction *c, thr_err *err)
{
  const thr_quotient *q = c->whole->q;
  unmake(c);
  c->q = *q;
  c->q.n_darts = c->q.n_pairs = 0;
  c->q.copy = thr_calloc((size_t)q->n_copies, sizeof *c->q.copy);
  c->q.dart = thr_calloc((size_t)q->n_darts, sizeof *c->q.dart);
  c->q.pair = thr_calloc((size_t)q->n_pairs, sizeof *c->q.pair);
  int *made = thr_calloc(2 * (size_t)q->n_darts, sizeof *made);
  thr_status st = c->q.copy && c->q.dart && c->q.pair && made ? THR_OK : thr_nomem(err);
  for (int d = 0; d < q->n_darts && !st; d++) {
    c->becomes[d] = c->keep[c->root[d]] || c->root[d] == d ? c->q.n_darts : c->becomes[c->root[d]];
    if (c->becomes[d] == c->q.n_darts) c->q.dart[c->q.n_darts++] = q->dart[d];
  }
  for (int k = 0; k < q->n_copies && !st; k++) {
    c->q.copy[k] = q->copy[k];
    for (int i = 0; i < (q->copy[k].fold ? 1 : 2); i++)
      c->q.copy[k].dart[i] = c->becomes[q->copy[k].dart[i]];
  }
  if (!st) contract_pairs(c, made);
  free(made);
  if (!st) st = thr_programme_init(&c->p, &c->q, c->whole->o, err);
  if (st) return st;
  memcpy(c->p.least, c->whole->least, (size_t)q->n_copies * sizeof *c->p.least); /* turns that are gone ruled some out */
  memcpy(c->p.most, c->whole->most, (size_t)q->n_copies * sizeof *c->p.most);
  return THR_OK;
}

/* ---- lifting ---- */

/* Dart orbits of one cell that are still to be led on. */
typedef struct {
  const thr_contraction *c;
  int *value; /* of the whole programme */
  int *left;  /* [n_darts] */
  int n, *type;
} cell;

static int most_left(const cell *x)
{
  int best = -1;
  for (int i = 0; i < x->n; i++)
    if (x->left[x->type[i]] > 0 && (best < 0 || x->left[x->type[i]] > x->left[best])) best = x->type[i];
  return best;
}

/* Column that ends one of the trails of type d: cord end or self pair; -1 = none. */
static int terminal_of(const thr_programme *p, int d, bool self)
{
  if (!self) return p->most[p->first_end + d] != 0 ? p->first_end + d : -1;
  for (int k = p->first[d]; k < p->first[d + 1]; k++)
    if (p->q->pair[p->incident[k]].self) return p->first_pair + p->incident[k];
  return -1;
}

/* So many ends or self pairs, always where most is left. */
static bool take_terminals(cell *x, bool self, int count)
{
  const thr_programme *p = x->c->whole;
  for (; count > 0; count--) {
    int best = -1;
    for (int i = 0; i < x->n; i++) {
      int d = x->type[i];
      if (x->left[d] > 0 && terminal_of(p, d, self) >= 0 && (best < 0 || x->left[d] > x->left[best])) best = d;
    }
    if (best < 0) return false;
    x->value[terminal_of(p, best, self)]++;
    x->left[best]--;
  }
  return true;
}

/* Can the rest be paired: does no type without a turn to itself have more than the others together? */
static bool can_go_on(const cell *x)
{
  int sum = 0;
  for (int i = 0; i < x->n; i++)
    sum += x->left[x->type[i]];
  for (int i = 0; i < x->n; i++)
    if (2 * x->left[x->type[i]] > sum && !thr_programme_loop(x->c->whole, x->type[i])) return false;
  return sum % 2 == 0;
}

/* The type with most left gets the cheapest partner after which the rest can be paired. */
static bool pair_one(cell *x, int a)
{
  const thr_programme *p = x->c->whole;
  const double *cost = p->cost[THR_AIM_TURNING];
  int best = -1;
  for (int k = p->first[a]; k < p->first[a + 1]; k++) {
    const thr_pair_type *t = &p->q->pair[p->incident[k]];
    int j = p->first_pair + p->incident[k], b = t->dart[0] + t->dart[1] - a;
    if (t->self || p->most[j] == 0 || x->left[b] < 1 + (a == b) || (best >= 0 && cost[j] >= cost[best])) continue;
    x->left[a]--;
    x->left[b]--;
    if (can_go_on(x)) best = j;
    x->left[a]++;
    x->left[b]++;
  }
  if (best < 0) return false;
  x->value[best]++;
  x->left[p->join[best][0]]--;
  x->left[p->join[best][1]]--;
  return true;
}

static bool lift_cell(cell *x, const int *small)
{
  const thr_programme *p = &x->c->p;
  int d = x->c->becomes[x->type[0]];
  for (int k = p->first[d]; k < p->first[d + 1]; k++)
    if (p->q->pair[p->incident[k]].self && !take_terminals(x, true, small[p->first_pair + p->incident[k]])) return false;
  if (!take_terminals(x, false, small[p->first_end + d]) || !can_go_on(x)) return false;
  for (int a; (a = most_left(x)) >= 0;)
    if (!pair_one(x, a)) return false;
  return true;
}

/* A cell that is left as it is has its turns already. */
static void copy_kept(const thr_contraction *c, const int *small, int *value)
{
  const thr_quotient *q = c->whole->q;
  for (int y = 0; y < q->n_pairs; y++)
    if (c->keep[c->root[q->pair[y].dart[0]]]) value[c->whole->first_pair + y] = small[c->p.first_pair + c->pair[y]];
  for (int d = 0; d < q->n_darts; d++)
    if (c->keep[c->root[d]]) value[c->whole->first_end + d] = small[c->p.first_end + c->becomes[d]];
}

void thr_contraction_lower(const thr_contraction *c, const int *value, int *small)
{
  const thr_quotient *q = c->whole->q;
  memset(small, 0, (size_t)c->p.n * sizeof *small);
  memcpy(small, value, (size_t)q->n_copies * sizeof *small);
  for (int y = 0; y < q->n_pairs; y++)
    if (c->pair[y] >= 0) small[c->p.first_pair + c->pair[y]] += value[c->whole->first_pair + y];
  for (int d = 0; d < q->n_darts; d++)
    small[c->p.first_end + c->becomes[d]] += value[c->whole->first_end + d];
}

thr_status thr_contraction_lift(thr_contraction *c, const int *small, int *value, int *kept, thr_err *err)
{
  const thr_quotient *q = c->whole->q;
  size_t n = (size_t)q->n_darts;
  cell x = {c, value, thr_calloc(n, sizeof *x.left), 0, NULL};
  int *first = thr_calloc(n + 2, sizeof *first), *type = thr_calloc(n, sizeof *type);
  thr_status st = x.left && first && type ? THR_OK : thr_nomem(err);
  *kept = 0;
  memset(value, 0, (size_t)c->whole->n * sizeof *value);
  for (int k = 0; k < q->n_copies && !st; k++) {
    value[k] = small[k];
    for (int i = 0; i < (q->copy[k].fold ? 1 : 2); i++)
      x.left[q->copy[k].dart[i]] += small[k];
  }
  for (int d = 0; d < q->n_darts && !st; d++)
    first[c->root[d] + 2]++;
  for (int d = 1; d < q->n_darts && !st; d++)
    first[d + 1] += first[d];
  for (int d = 0; d < q->n_darts && !st; d++)
    type[first[c->root[d] + 1]++] = d;
  for (int d = 0; d < q->n_darts && !st; d++) {
    x.type = type + first[d];
    x.n = first[d + 1] - first[d];
    if (c->keep[d] || x.n == 0 || lift_cell(&x, small)) continue;
    c->keep[d] = true;
    ++*kept;
  }
  if (!st && *kept == 0) copy_kept(c, small, value);
  free(x.left);
  free(first);
  free(type);
  return st;
}
