/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solutions of a contraction with turns, and the other way round. */
#include "graph/disjoint.h"
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"

#include <stdlib.h>
#include <string.h>

/* Dart orbits of the cells that are still to be led on. */
typedef struct {
  const thr_contraction *c;
  int *value; /* of the whole programme */
  int *left;  /* [n_darts] */
  int *first,
      *types;   /* dart types of the cell with lowest type d: types[first[d] .. first[d + 1] - 1] */
  int *selves;  /* [n_darts] by lowest type: self pairs that are still to be taken */
  bool *failed; /* [n_darts] by lowest type */
  int n, *type; /* of the cell at hand */
  int *parent, *next; /* [ties->most] tubes of the star at hand, joined so far; scratch */
  bool stopped;       /* by the limits */
} lifting;

static void lifting_destroy(lifting *x)
{
  free(x->left);
  free(x->first);
  free(x->types);
  free(x->selves);
  free(x->failed);
  free(x->parent);
  free(x->next);
}

static thr_status lifting_init(lifting *x, const thr_contraction *contraction, const int *small,
                               int *value, thr_err *err)
{
  const thr_quotient *quotient = contraction->whole->q;
  size_t n = (size_t)quotient->n_darts,
         tubes = contraction->whole->ties ? (size_t)contraction->whole->ties->most : 0;
  *x = (lifting){.c = contraction, .value = value, .left = thr_calloc(n, sizeof *x->left)};
  x->first = thr_calloc(n + 2, sizeof *x->first);
  x->types = thr_calloc(n, sizeof *x->types);
  x->selves = thr_calloc(n, sizeof *x->selves);
  x->failed = thr_calloc(n, sizeof *x->failed);
  x->parent = thr_calloc(tubes, sizeof *x->parent);
  x->next = thr_calloc(tubes, sizeof *x->next);
  if (!x->left || !x->first || !x->types || !x->selves || !x->failed || !x->parent || !x->next)
    return thr_nomem(err);
  memset(value, 0, (size_t)contraction->whole->n * sizeof *value);
  for (int k = 0; k < quotient->n_copies; k++) {
    value[k] = small[k];
    for (int i = 0; i < (quotient->copy[k].fold ? 1 : 2); i++)
      x->left[quotient->copy[k].dart[i]] += small[k];
  }
  for (int d = 0; d < quotient->n_darts; d++)
    x->first[contraction->root[d] + 2]++;
  for (int d = 1; d < quotient->n_darts; d++)
    x->first[d + 1] += x->first[d];
  for (int d = 0; d < quotient->n_darts; d++)
    x->types[x->first[contraction->root[d] + 1]++] = d;
  return THR_OK;
}

static bool stop(lifting *x)
{
  x->stopped = x->stopped || thr_programme_check_time(x->c->whole) != THR_OK;
  return x->stopped;
}

static void enter_cell(lifting *x, int root)
{
  x->type = x->types + x->first[root];
  x->n = x->first[root + 1] - x->first[root];
}

/* ---- one cell ---- */

static int most_left(const lifting *x)
{
  int best = -1;
  for (int i = 0; i < x->n; i++)
    if (x->left[x->type[i]] > 0 && (best < 0 || x->left[x->type[i]] > x->left[best]))
      best = x->type[i];
  return best;
}

/* Returns the column that ends one of the trails of type d, a cord end or the cheapest self pair,
 * or -1 if there is none. */
static int terminal_of(const thr_programme *p, int d, bool self)
{
  const double *cost = p->cost[THR_AIM_TURNING];
  int best = -1;
  if (!self) return p->most[p->first_end + d] != 0 ? p->first_end + d : -1;
  for (int k = p->first[d]; k < p->first[d + 1]; k++) {
    const int j = p->first_pair + p->incident[k];
    if (p->q->pair[p->incident[k]].self && p->most[j] != 0 && (best < 0 || cost[j] < cost[best]))
      best = j;
  }
  return best;
}

/* So many ends or self pairs, always where most is left. */
static bool take_terminals(lifting *x, bool self, int count)
{
  const thr_programme *p = x->c->whole;
  for (; count > 0; count--) {
    int best = -1;
    for (int i = 0; i < x->n; i++) {
      int d = x->type[i];
      if (x->left[d] > 0 && terminal_of(p, d, self) >= 0 &&
          (best < 0 || x->left[d] > x->left[best]))
        best = d;
    }
    if (best < 0) return false;
    x->value[terminal_of(p, best, self)]++;
    x->left[best]--;
  }
  return true;
}

/* Can the rest be paired: does no type without a turn to itself have more than the others together?
 */
static bool can_go_on(const lifting *x)
{
  int sum = 0, selves = x->selves[x->c->root[x->type[0]]];
  for (int i = 0; i < x->n; i++)
    sum += x->left[x->type[i]];
  for (int i = 0; i < x->n; i++)
    if (2 * x->left[x->type[i]] > sum + selves && !thr_programme_loop(x->c->whole, x->type[i]))
      return false;
  return (sum - selves) % 2 == 0;
}

/* Pair column j once more, or once less. */
static void use(lifting *x, int j, int sign)
{
  const int *type = x->c->whole->join[j];
  bool self = thr_programme_terminal(x->c->whole, j);
  x->value[j] += sign;
  x->left[type[0]] -= sign;
  if (self) x->selves[x->c->root[type[0]]] -= sign;
  if (!self) x->left[type[1]] -= sign;
}

static bool is_left(const lifting *x, int j)
{
  int a = x->c->whole->join[j][0], b = x->c->whole->join[j][1];
  if (x->c->whole->most[j] == 0) return false;
  if (thr_programme_terminal(x->c->whole, j)) return x->left[a] > 0 && x->selves[x->c->root[a]] > 0;
  return x->left[a] > (a == b) && x->left[b] > 0;
}

/* The type with most left gets the cheapest partner after which the rest can be paired. */
static bool pair_one(lifting *x, int a)
{
  const thr_programme *p = x->c->whole;
  const double *cost = p->cost[THR_AIM_TURNING];
  int best = -1;
  for (int k = p->first[a]; k < p->first[a + 1]; k++) {
    int j = p->first_pair + p->incident[k];
    if (p->q->pair[p->incident[k]].self || !is_left(x, j) || (best >= 0 && cost[j] >= cost[best]))
      continue;
    use(x, j, 1);
    if (can_go_on(x)) best = j;
    use(x, j, -1);
  }
  if (best < 0) return false;
  use(x, best, 1);
  return true;
}

/* The ends; and how many self pairs are to be taken. */
static bool end_trails(lifting *x, const int *small)
{
  const thr_programme *p = &x->c->p;
  int d = x->c->becomes[x->type[0]], *selves = &x->selves[x->c->root[x->type[0]]];
  for (int k = p->first[d]; k < p->first[d + 1]; k++)
    if (p->q->pair[p->incident[k]].self) *selves += small[p->first_pair + p->incident[k]];
  return take_terminals(x, false, small[p->first_end + d]) && can_go_on(x);
}

static bool pair_rest(lifting *x)
{
  int *selves = &x->selves[x->c->root[x->type[0]]], count = *selves;
  *selves = 0;
  if (!take_terminals(x, true, count) || !can_go_on(x)) return false;
  for (int a; (a = most_left(x)) >= 0;)
    if (stop(x) || !pair_one(x, a)) return false;
  return true;
}

/* ---- tubes ---- */

static bool cell_kept(const thr_contraction *contraction, int y)
{
  return contraction->keep[contraction->root[contraction->whole->q->pair[y].dart[0]]];
}

static int join_tubes(const thr_ties *ties, int y, int *parent)
{
  int n = 0;
  for (int k = ties->join[y]; k < ties->join[y + 1]; k++)
    n += thr_disjoint_join(parent, ties->link[k][0], ties->link[k][1]);
  return n;
}

/* May turn y be used with what is left: can all blocks of tubes still be joined, and the rest be
 * paired? */
static bool leaves_room(lifting *x, int star, int y)
{
  const thr_programme *p = x->c->whole;
  const thr_ties *ties = p->ties;
  int blocks = 0, open = 0;
  memcpy(x->next, x->parent, (size_t)ties->degree[star] * sizeof *x->next);
  join_tubes(ties, y, x->next);
  for (int i = 0; i < ties->degree[star]; i++)
    blocks += x->next[i] == i;
  use(x, p->first_pair + y, 1);
  bool good = can_go_on(x);
  for (int i = ties->first[star]; i < ties->first[star + 1] && good && blocks > 1; i++) {
    int other = ties->pair[i], j = p->first_pair + other;
    if (cell_kept(x->c, other) || !is_left(x, j)) continue;
    for (int k = ties->join[other]; k < ties->join[other + 1];
         k++) { /* -1 - root: this block can be joined */
      int a = ties->link[k][0], b = ties->link[k][1];
      while (x->next[a] >= 0 && x->next[a] != a)
        a = x->next[a];
      while (x->next[b] >= 0 && x->next[b] != b)
        b = x->next[b];
      if (a == b) continue;
      x->next[a] = -1 - a;
      x->next[b] = -1 - b;
    }
  }
  for (int i = 0; i < ties->degree[star]; i++)
    open += x->next[i] < 0;
  use(x, p->first_pair + y, -1);
  return good && (blocks == 1 || open == blocks);
}

/* How many joins of tubes turn y would add. */
static int count_joins(lifting *x, int star, int y)
{
  const thr_ties *ties = x->c->whole->ties;
  bool any = false;
  for (int k = ties->join[y]; k < ties->join[y + 1]; k++)
    any = any || thr_disjoint_find(x->parent, ties->link[k][0]) !=
                     thr_disjoint_find(x->parent, ties->link[k][1]);
  if (!any) return 0;
  memcpy(x->next, x->parent, (size_t)ties->degree[star] * sizeof *x->next);
  return join_tubes(ties, y, x->next);
}

/* Joins the tubes of a star with turns of the cells that are not kept: those that join most, of
 * several the cheapest. */
static void tie_star(lifting *x, int star, const int *small)
{
  const thr_contraction *contraction = x->c;
  const thr_programme *p = contraction->whole;
  const thr_ties *ties = p->ties;
  const double *cost = p->cost[THR_AIM_TURNING] + p->first_pair;
  for (int i = 0; i < ties->degree[star]; i++)
    x->parent[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int y = ties->pair[i];
    if ((cell_kept(contraction, y) ? small[contraction->p.first_pair + contraction->pair[y]]
                                   : x->value[p->first_pair + y]) > 0)
      join_tubes(ties, y, x->parent);
  }
  for (int best = 0; best >= 0;) {
    int most = 0;
    best = -1;
    for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
      int y = ties->pair[i], j = p->first_pair + y;
      if (cell_kept(contraction, y) || !is_left(x, j)) continue;
      int joins = count_joins(x, star, y);
      if (joins == 0 || joins < most || (joins == most && cost[y] >= cost[best])) continue;
      if (stop(x)) return;
      enter_cell(x, contraction->root[p->q->pair[y].dart[0]]);
      if (!leaves_room(x, star, y)) continue;
      most = joins;
      best = y;
    }
    if (best < 0) break;
    use(x, p->first_pair + best, 1);
    join_tubes(ties, best, x->parent);
  }
}

/* Is the star not tied? Then its cells have failed. */
static void check_star(lifting *x, int star, const int *small)
{
  const thr_contraction *contraction = x->c;
  const thr_ties *ties = contraction->whole->ties;
  bool tied = true;
  for (int i = 0; i < ties->degree[star]; i++)
    x->parent[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int y = ties->pair[i];
    if ((cell_kept(contraction, y) ? small[contraction->p.first_pair + contraction->pair[y]]
                                   : x->value[contraction->whole->first_pair + y]) > 0)
      join_tubes(ties, y, x->parent);
  }
  for (int i = 1; i < ties->degree[star]; i++)
    tied = tied && thr_disjoint_find(x->parent, i) == thr_disjoint_find(x->parent, 0);
  for (int i = ties->first[star]; i < ties->first[star + 1] && !tied; i++)
    x->failed[contraction->root[contraction->whole->q->pair[ties->pair[i]].dart[0]]] = true;
}

/* ---- all ---- */

/* A cell that is left as it is has its turns already. */
static void copy_kept(const thr_contraction *contraction, const int *small, int *value)
{
  const thr_quotient *quotient = contraction->whole->q;
  for (int y = 0; y < quotient->n_pairs; y++)
    if (contraction->keep[contraction->root[quotient->pair[y].dart[0]]])
      value[contraction->whole->first_pair + y] =
          small[contraction->p.first_pair + contraction->pair[y]];
  for (int d = 0; d < quotient->n_darts; d++)
    if (contraction->keep[contraction->root[d]])
      value[contraction->whole->first_end + d] =
          small[contraction->p.first_end + contraction->becomes[d]];
}

void thr_contraction_lower(const thr_contraction *contraction, const int *value, int *small)
{
  const thr_quotient *quotient = contraction->whole->q;
  memset(small, 0, (size_t)contraction->p.n * sizeof *small);
  memcpy(small, value, (size_t)quotient->n_copies * sizeof *small);
  for (int y = 0; y < quotient->n_pairs; y++)
    if (contraction->pair[y] >= 0)
      small[contraction->p.first_pair + contraction->pair[y]] +=
          value[contraction->whole->first_pair + y];
  for (int d = 0; d < quotient->n_darts; d++)
    small[contraction->p.first_end + contraction->becomes[d]] +=
        value[contraction->whole->first_end + d];
}

thr_status thr_contraction_lift(thr_contraction *contraction, const int *small, int *value,
                                int *kept, thr_err *err)
{
  const int n = contraction->whole->q->n_darts,
            stars = contraction->whole->ties ? contraction->whole->ties->n : 0;
  lifting x;
  *kept = 0;
  thr_status st = lifting_init(&x, contraction, small, value, err);
  for (int d = 0; d < n && !st; d++) {
    enter_cell(&x, d);
    if (!contraction->keep[d] && x.n > 0) x.failed[d] = !end_trails(&x, small);
  }
  for (int i = 0; i < stars && !st; i++)
    tie_star(&x, i, small);
  for (int d = 0; d < n && !st; d++) {
    enter_cell(&x, d);
    if (!contraction->keep[d] && x.n > 0) x.failed[d] = x.failed[d] || !pair_rest(&x);
  }
  for (int i = 0; i < stars && !st; i++)
    check_star(&x, i, small);
  for (int d = 0; d < n && !st; d++) {
    if (contraction->keep[d] || !x.failed[d]) continue;
    contraction->keep[d] = true;
    ++*kept;
  }
  if (x.stopped && !st) st = THR_ELIMIT;
  if (!st && *kept == 0) copy_kept(contraction, small, value);
  lifting_destroy(&x);
  return st;
}
