/* Rows: which edges leave which set. Basis: tight edges that span every level of the nest.
 *
 * For nested sets, let an edge's level be the smallest set that holds both of its ends (or the whole graph). Contract what lies
 * inside of a level's inner sets: the edges of the level then join inner sets to each other, or to the ground, which is all nodes
 * that lie directly in the level. Chosen edges make the columns of a basis if on every level each component that they span holds
 * the ground or has one odd cycle, and is a tree but for that: then, from the innermost level outwards, only zero duals load no
 * chosen edge. Where tight edges leave a component without both, it has two sides that the join matches. Its sets may grow on one
 * side and shrink on the other by the same amount at no cost, until a set is used up, whose slack is basic then (as good as an
 * edge to the ground), or a further edge is tight. */
#include "lp/cutbasis.h"
#include "graph/disjoint.h"

#include <stdlib.h>

__extension__ typedef __int128 wide;

/* ---- rows ---- */

typedef struct {
  thr_cut_rows *r;
  const thr_tjoin_problem *p;
  const thr_tjoin *t;
  int *first_cut, *holds; /* cuts that name node v: holds[first_cut[v] .. first_cut[v + 1] - 1] */
} row_maker;

void thr_cut_rows_destroy(thr_cut_rows *r)
{
  free(r->tree);
  free(r->first);
  free(r->edge);
  *r = (thr_cut_rows){0};
}

static thr_status list_places(row_maker *m, thr_err *err)
{
  const thr_tjoin *t = m->t;
  size_t n = (size_t)m->p->n_nodes, named = 0;
  m->r->tree = thr_calloc((size_t)t->n_cuts, sizeof *m->r->tree);
  m->first_cut = thr_calloc(n + 2, sizeof *m->first_cut);
  m->r->first = thr_calloc((size_t)t->n_cuts + 2, sizeof *m->r->first);
  if (!m->r->tree || !m->first_cut || !m->r->first) return thr_nomem(err);
  for (int i = t->n_cuts - 1; i >= 0; i--) {
    m->r->tree[i] = t->cut[i].parent < 0 ? i : m->r->tree[t->cut[i].parent];
    named += (size_t)t->cut[i].n_nodes;
    for (int k = 0; k < t->cut[i].n_nodes; k++)
      m->first_cut[t->cut[i].node[k] + 2]++;
  }
  for (size_t v = 1; v <= n; v++)
    m->first_cut[v + 1] += m->first_cut[v];
  m->holds = thr_calloc(named, sizeof *m->holds);
  if (!m->holds) return thr_nomem(err);
  for (int i = 0; i < t->n_cuts; i++)
    for (int k = 0; k < t->cut[i].n_nodes; k++)
      m->holds[m->first_cut[t->cut[i].node[k] + 1]++] = i;
  return THR_OK;
}

/* The cut of that tree that names node v, or -1. */
static int place_of(const row_maker *m, int v, int tree)
{
  for (int k = m->first_cut[v]; k < m->first_cut[v + 1]; k++)
    if (m->r->tree[m->holds[k]] == tree) return m->holds[k];
  return -1;
}

/* Takes one step on the way between the cuts a and b (-1: outside), out of the inner one, which it returns. */
static int step_out(const thr_cut *cut, int *a, int *b)
{
  int *inner = *b < 0 || (*a >= 0 && *a < *b) ? a : b, left = *inner; /* parents come later */
  *inner = cut[left].parent;
  return left;
}

/* Counts (edge NULL), or lists, edge e in all cuts of one tree that it leaves: those on the way between the cuts a and b. */
static void leave(thr_cut_rows *r, const thr_cut *cut, int e, int a, int b)
{
  while (a != b) {
    int left = step_out(cut, &a, &b);
    if (r->edge)
      r->edge[r->first[left + 1]++] = e;
    else
      r->first[left + 2]++;
  }
}

static void leave_all(row_maker *m)
{
  for (int e = 0; e < m->p->n_edges; e++) {
    int u = m->p->edge[e][0], v = m->p->edge[e][1];
    for (int k = m->first_cut[u]; k < m->first_cut[u + 1]; k++)
      leave(m->r, m->t->cut, e, m->holds[k], place_of(m, v, m->r->tree[m->holds[k]]));
    for (int k = m->first_cut[v]; k < m->first_cut[v + 1]; k++)
      if (place_of(m, u, m->r->tree[m->holds[k]]) < 0) leave(m->r, m->t->cut, e, -1, m->holds[k]);
  }
}

thr_status thr_cut_rows_init(thr_cut_rows *r, const thr_tjoin_problem *p, const thr_tjoin *t, thr_err *err)
{
  *r = (thr_cut_rows){0};
  row_maker m = {.r = r, .p = p, .t = t};
  thr_status st = list_places(&m, err);
  if (!st) leave_all(&m);
  for (int i = 1; i <= t->n_cuts && !st; i++)
    r->first[i + 1] += r->first[i];
  if (!st && !(r->edge = thr_calloc((size_t)r->first[t->n_cuts + 1], sizeof *r->edge))) st = thr_nomem(err);
  if (!st) leave_all(&m);
  free(m.first_cut);
  free(m.holds);
  return st;
}

/* ---- basis ---- */

typedef struct {
  const thr_cut_rows *r;
  const thr_tjoin_problem *p;
  const thr_tjoin *t;
  bool *row, *column; /* result */
  int *home;          /* [n_nodes] innermost cut that holds the node, or -1 */
  int64_t *reach;     /* [n_cuts] values of the cut and of all around it */
  int64_t *grown;     /* [n_cuts] of an outermost cut: by how much its value was changed */
  int *tied;          /* [2 n_cuts + 1] disjoint sets: duals that stand or fall together; 0 = the ground, then two a cut */
  int *next;          /* [n_cuts] ring of the cuts tied together */
  int *round;         /* [2 n_cuts + 1] of a root of tied: last round in which its cuts were changed */
} basis;

static void basis_destroy(basis *b)
{
  free(b->home);
  free(b->reach);
  free(b->grown);
  free(b->tied);
  free(b->next);
  free(b->round);
}

/* Also false: a node is named twice. */
static thr_status basis_init(basis *b, bool *nested, thr_err *err)
{
  const thr_tjoin *t = b->t;
  size_t n = (size_t)b->p->n_nodes, cuts = (size_t)t->n_cuts;
  b->home = thr_calloc(n, sizeof *b->home);
  b->reach = thr_calloc(cuts, sizeof *b->reach);
  b->grown = thr_calloc(cuts, sizeof *b->grown);
  b->tied = thr_calloc(2 * cuts + 1, sizeof *b->tied);
  b->next = thr_calloc(cuts, sizeof *b->next);
  b->round = thr_calloc(2 * cuts + 1, sizeof *b->round);
  if (!b->home || !b->reach || !b->grown || !b->tied || !b->next || !b->round) return thr_nomem(err);
  for (size_t v = 0; v < n; v++)
    b->home[v] = -1;
  for (int k = 0; k < 2 * t->n_cuts + 1; k++)
    b->tied[k] = k;
  for (int i = t->n_cuts - 1; i >= 0; i--) {
    int up = t->cut[i].parent;
    b->reach[i] = t->cut[i].value + (up < 0 ? 0 : b->reach[up]);
    b->next[i] = i;
    for (int k = 0; k < t->cut[i].n_nodes; k++) {
      *nested &= b->home[t->cut[i].node[k]] < 0;
      b->home[t->cut[i].node[k]] = i;
    }
  }
  return THR_OK;
}

/* A change of the dual of cut i, up or down; -1: of the ground, which has none. */
static int change(basis *b, int i, bool down)
{
  return thr_disjoint_find(b->tied, i < 0 ? 0 : 1 + 2 * i + down);
}

static bool grounded(basis *b, int i)
{
  return change(b, i, false) == change(b, -1, false);
}

/* An edge between cuts i and j of one level (-1: the ground): one's dual goes down as the other's goes up. False: that follows
 * from the edges before. */
static bool tie(basis *b, int i, int j)
{
  int up = change(b, i, false), down = change(b, i, true), other = change(b, j, false), k = i < 0 ? j : i;
  if (i >= 0 && j >= 0 && up != other && down != other) {
    int next = b->next[i];
    b->next[i] = b->next[j];
    b->next[j] = next;
  }
  int joined = thr_disjoint_join(b->tied, up, change(b, j, true));
  joined += thr_disjoint_join(b->tied, change(b, i, true), change(b, j, false));
  if (change(b, k, false) == change(b, k, true)) joined += thr_disjoint_join(b->tied, 0, change(b, k, false));
  return joined > 0;
}

/* The cuts that edge e joins on its level (-1: the ground, at either end). Returns what loads it. */
static int64_t level_ends(const basis *b, int e, int end[2])
{
  int at[2] = {b->home[b->p->edge[e][0]], b->home[b->p->edge[e][1]]};
  int64_t load = 0;
  end[0] = end[1] = -1;
  while (at[0] != at[1]) {
    bool first = at[1] < 0 || (at[0] >= 0 && at[0] < at[1]);
    int left = step_out(b->t->cut, &at[0], &at[1]);
    end[!first] = left;
    load += b->t->cut[left].value;
  }
  return load;
}

/* The join's edges, then others. */
static void tie_tight_edges(basis *b)
{
  for (int in_join = 1; in_join >= 0; in_join--)
    for (int e = 0; e < b->p->n_edges; e++) {
      int end[2];
      if (b->t->in_join[e] != in_join || level_ends(b, e, end) != (wide)b->p->weight[e] * THR_DUAL_DENOMINATOR) continue;
      if (end[0] >= 0 || end[1] >= 0) b->column[e] = tie(b, end[0], end[1]);
    }
}

/* How far a component's duals may go in one direction, and what stops them: an edge that is tight then, or (-1) a cut used up. */
typedef struct {
  int64_t far;
  int cut, edge;
} event;

static void bring_forward(event *v, wide far, int cut, int edge)
{
  if (far < v->far) *v = (event){(int64_t)far, cut, edge};
}

/* The outermost cut that holds node v, or -1. */
static int outermost(const basis *b, int v)
{
  return b->home[v] < 0 ? -1 : b->r->tree[b->home[v]];
}

static int64_t reach_of(const basis *b, int v)
{
  return b->home[v] < 0 ? 0 : b->reach[b->home[v]] + b->grown[outermost(b, v)];
}

/* What comes first in the component of cut i if i grows (v[0]) or shrinks (v[1]). */
static void find_events(basis *b, int i, event v[2])
{
  int up = change(b, i, false), down = change(b, i, true), c = i;
  v[0] = v[1] = (event){INT64_MAX, -1, -1};
  do {
    bool with_other = change(b, c, false) != up; /* c grows when i shrinks */
    bring_forward(&v[!with_other], b->t->cut[c].value + b->grown[c], c, -1);
    for (int k = b->r->first[c]; k < b->r->first[c + 1]; k++) {
      int e = b->r->edge[k], x = b->p->edge[e][0], y = b->p->edge[e][1];
      wide slack = (wide)b->p->weight[e] * THR_DUAL_DENOMINATOR - reach_of(b, x) - reach_of(b, y);
      int far_end = outermost(b, x) == c ? outermost(b, y) : outermost(b, x), there = change(b, far_end, false);
      if (there != up && there != down)
        bring_forward(&v[with_other], slack, c, e);
      else if ((there != up) == with_other)
        bring_forward(&v[with_other], slack / 2, c, e);
    }
    c = b->next[c];
  } while (c != i);
}

/* Changes the duals of cut i's component until a cut or an edge ties it to what it is not tied to yet. */
static void move_component(basis *b, int i)
{
  event v[2];
  find_events(b, i, v);
  bool shrink = v[1].far < v[0].far;
  int up = change(b, i, false), c = i, e = v[shrink].edge;
  do {
    b->grown[c] += (change(b, c, false) == up) != shrink ? v[shrink].far : -v[shrink].far;
    c = b->next[c];
  } while (c != i);
  if (e < 0)
    b->row[v[shrink].cut] = tie(b, v[shrink].cut, -1);
  else
    b->column[e] = tie(b, outermost(b, b->p->edge[e][0]), outermost(b, b->p->edge[e][1]));
}

/* In every round each component that is not grounded is moved once at most: so every one left has grown by half or more. */
static void move_outermost(basis *b)
{
  bool moved = true;
  for (int round = 1; moved; round++) {
    moved = false;
    for (int i = 0; i < b->t->n_cuts; i++) {
      if (b->t->cut[i].parent >= 0 || grounded(b, i) || b->round[change(b, i, false)] == round) continue;
      move_component(b, i);
      b->round[change(b, i, false)] = b->round[change(b, i, true)] = round;
      moved = true;
    }
  }
}

/* Basic: every edge of the join that has a row for itself, one that no other edge of the join is in; and the slacks of all other
 * rows. */
static void span_by_join(const thr_cut_rows *r, const thr_tjoin *t, bool *row, bool *column)
{
  for (int i = 0; i < t->n_cuts; i++) {
    int joined = 0, e = -1;
    for (int k = r->first[i]; k < r->first[i + 1]; k++)
      if (t->in_join[r->edge[k]]) joined++, e = r->edge[k];
    row[i] = joined != 1 || column[e];
    if (!row[i]) column[e] = true;
  }
}

thr_status thr_cut_basis(const thr_cut_rows *r, const thr_tjoin_problem *p, const thr_tjoin *t, bool *row, bool *column,
                         thr_err *err)
{
  basis b = {.r = r, .p = p, .t = t, .row = row, .column = column};
  bool exact = t->sum == (wide)t->length * THR_DUAL_DENOMINATOR; /* so every set is left by one edge of the join */
  thr_status st = exact ? basis_init(&b, &exact, err) : THR_OK;
  if (!st && !exact) span_by_join(r, t, row, column);
  if (!st && exact) {
    tie_tight_edges(&b);
    move_outermost(&b);
    for (int i = 0; i < t->n_cuts; i++) /* inside others: moving them would change the load of edges farther out */
      if (!grounded(&b, i)) row[i] = tie(&b, i, -1);
  }
  basis_destroy(&b);
  return st;
}
