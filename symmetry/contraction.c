/* Cells of dart types: made, solved roughly, and undone. */
#include "symmetry/contraction.h"
#include "graph/disjoint.h"

#include <math.h>
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
    thr_disjoint_join(c->root, q->pair[y].dart[0], q->pair[y].dart[1]);
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
  thr_status st = count && loop && c->root && c->keep && c->becomes ? THR_OK : thr_nomem(err);
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
  *c = (thr_contraction){0};
}

/* Of a contracted cell one turn and one self pair at most, marked in done[2 * type + self]. */
static void contract_pairs(thr_contraction *c, bool *done)
{
  const thr_quotient *q = c->whole->q;
  for (int y = 0; y < q->n_pairs; y++) {
    thr_pair_type made = q->pair[y];
    int root = c->root[made.dart[0]];
    if (!c->keep[root]) {
      bool *known = &done[2 * root + made.self];
      if (*known || !allowed(c->whole, y)) continue;
      *known = true;
    }
    for (int i = 0; i < 2; i++)
      made.dart[i] = c->becomes[c->keep[root] ? made.dart[i] : root];
    c->q.pair[c->q.n_pairs++] = made;
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
  bool *done = thr_calloc(2 * (size_t)q->n_darts, sizeof *done);
  thr_status st = c->q.copy && c->q.dart && c->q.pair && done ? THR_OK : thr_nomem(err);
  for (int d = 0; d < q->n_darts && !st; d++) {
    c->becomes[d] = c->keep[c->root[d]] || c->root[d] == d ? c->q.n_darts : c->becomes[c->root[d]];
    if (c->becomes[d] == c->q.n_darts) c->q.dart[c->q.n_darts++] = q->dart[d];
  }
  for (int k = 0; k < q->n_copies && !st; k++) {
    c->q.copy[k] = q->copy[k];
    for (int i = 0; i < (q->copy[k].fold ? 1 : 2); i++)
      c->q.copy[k].dart[i] = c->becomes[q->copy[k].dart[i]];
  }
  if (!st) contract_pairs(c, done);
  free(done);
  return st ? st : thr_programme_init(&c->p, &c->q, c->whole->o, err);
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

static bool turns_into_itself(const thr_programme *p, int d)
{
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const thr_pair_type *t = &p->q->pair[p->incident[k]];
    if (!t->self && t->dart[0] == t->dart[1] && p->most[p->first_pair + p->incident[k]] != 0) return true;
  }
  return false;
}

/* Can the rest be paired: does no type without a turn to itself have more than the others together? */
static bool can_go_on(const cell *x)
{
  int sum = 0;
  for (int i = 0; i < x->n; i++)
    sum += x->left[x->type[i]];
  for (int i = 0; i < x->n; i++)
    if (2 * x->left[x->type[i]] > sum && !turns_into_itself(x->c->whole, x->type[i])) return false;
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

/* A cell that is left as it is has its turns already, in the order of its types' turns. */
static void copy_kept(const thr_contraction *c, const int *small, int *value)
{
  const thr_quotient *q = c->whole->q;
  int next = 0;
  for (int y = 0; y < q->n_pairs; y++) {
    int d = q->pair[y].dart[0];
    if (!c->keep[c->root[d]]) continue;
    const thr_quotient *s = &c->q;
    while (s->pair[next].half[0] != q->pair[y].half[0] || s->pair[next].half[1] != q->pair[y].half[1] ||
           s->pair[next].dart[0] != c->becomes[d] || s->pair[next].self != q->pair[y].self ||
           s->pair[next].dart[1] != c->becomes[q->pair[y].dart[1]])
      next++;
    value[c->whole->first_pair + y] = small[c->p.first_pair + next++];
  }
  for (int d = 0; d < q->n_darts; d++)
    if (c->keep[c->root[d]]) value[c->whole->first_end + d] = small[c->p.first_end + c->becomes[d]];
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

/* ---- a start ---- */

typedef struct {
  double cost;
  int column;
} candidate;

static int by_cost(const void *a, const void *b)
{
  const candidate *x = a, *y = b;
  if (x->cost < y->cost || x->cost > y->cost) return x->cost < y->cost ? -1 : 1;
  return x->column - y->column;
}

/* Orbits of a copy type by which it covers its edge alone, and the passes beyond the cover. */
static int needed(const thr_programme *p, int copy, int *over)
{
  int passes = p->q->copy[copy].passes, n = (p->o->cover + passes - 1) / passes;
  *over = n * passes - p->o->cover;
  return n;
}

/* One copy type for every edge orbit: that with least overlap, without folds if possible, or else the freest, once or twice. */
static void take_least(const thr_programme *p, thr_contraction_kind kind, int *small)
{
  const thr_quotient *q = p->q;
  for (int k = 0, end; k < q->n_copies; k = end) {
    int best = k, over, least;
    needed(p, k, &least);
    for (end = k; end < q->n_copies && q->copy[end].edge == q->copy[k].edge; end++) {
      needed(p, end, &over);
      bool cheaper = over < least || (over == least && q->copy[best].fold && !q->copy[end].fold);
      if (kind == THR_CONTRACTION_LEAST ? !cheaper : q->copy[end].passes <= q->copy[best].passes) continue;
      best = end;
      least = over;
    }
    small[best] = needed(p, best, &over) * (kind == THR_CONTRACTION_TWICE ? 2 : 1);
  }
}

/* The columns of a forest of least overlap, terminals first, folds among them or not: tree[n]; node n_darts is the root of all
 * terminals. */
static int find_forest(const thr_programme *p, bool folds, candidate *list, int *parent, int *tree)
{
  int n = 0, in_tree = 0;
  for (int d = 0; d <= p->q->n_darts; d++)
    parent[d] = d;
  for (int j = 0; j < p->first_circle; j++) {
    bool fold = thr_programme_terminal(p, j) && j < p->first_end;
    if (p->most[j] != 0 && p->join[j][0] != p->join[j][1] && (folds || !fold))
      list[n++] = (candidate){p->cost[THR_AIM_OVERLAP][j], j};
  }
  if (n > 0) qsort(list, (size_t)n, sizeof *list, by_cost);
  for (int i = 0; i < n; i++)
    if (thr_disjoint_join(parent, p->join[list[i].column][0], p->join[list[i].column][1])) tree[in_tree++] = list[i].column;
  return in_tree;
}

/* Takes leaf after leaf off the forest: an odd leaf's column is used once more. False if a tree has an odd sum and no terminal.
 */
static bool make_even(const thr_programme *p, int *tree, int n, bool *odd, int *degree, int *small)
{
  int terminals = p->q->n_darts;
  for (int i = 0; i < n; i++)
    for (int s = 0; s < 2; s++)
      degree[p->join[tree[i]][s]]++;
  for (int before = n + 1, left = n; left < before;) {
    before = left;
    for (int i = 0; i < n; i++)
      for (int s = 0; s < 2 && tree[i] >= 0; s++) {
        int leaf = p->join[tree[i]][s], other = p->join[tree[i]][1 - s];
        if (degree[leaf] != 1 || leaf == terminals) continue;
        small[tree[i]] += odd[leaf];
        odd[other] ^= odd[leaf];
        odd[leaf] = false;
        degree[leaf]--;
        degree[other]--;
        tree[i] = -1;
        left--;
      }
  }
  for (int d = 0; d < terminals; d++)
    if (odd[d]) return false;
  return true;
}

thr_status thr_contraction_start(const thr_contraction *c, thr_contraction_kind kind, int *small, bool *found, thr_err *err)
{
  const thr_programme *p = &c->p;
  size_t n = (size_t)p->q->n_darts + 1;
  candidate *list = thr_calloc((size_t)p->n, sizeof *list);
  int *parent = thr_calloc(n, sizeof *parent), *tree = thr_calloc(n, sizeof *tree), *degree = thr_calloc(n, sizeof *degree);
  bool *odd = thr_calloc(n, sizeof *odd);
  thr_status st = list && parent && tree && degree && odd ? THR_OK : thr_nomem(err);
  if (!st) {
    memset(small, 0, (size_t)p->n * sizeof *small);
    take_least(p, kind, small);
    for (int k = 0; k < p->first_pair; k++)
      for (int i = 0; i < 2; i++)
        odd[p->join[k][i]] ^= small[k] % 2;
    int columns = find_forest(p, kind == THR_CONTRACTION_LEAST, list, parent, tree);
    *found = make_even(p, tree, columns, odd, degree, small);
  }
  free(list);
  free(parent);
  free(tree);
  free(degree);
  free(odd);
  return st;
}
