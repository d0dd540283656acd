/* Columns, and a basis: tight edges that span every level of the nest.
 *
 * For nested sets, let an edge's level be the smallest set that holds both of its ends (or the whole graph). Contract what lies
 * inside of a level's inner sets: the edges of the level then join inner sets to each other, or to the ground, which is all nodes
 * that lie directly in the level. Chosen edges make the columns of a basis if on every level each component that they span holds
 * the ground or has one odd cycle, and is a tree but for that: then, from the innermost level outwards, only duals of 0 load no
 * chosen edge. Where tight edges leave a component without both, it has two sides that the join matches. Its sets may grow on one
 * side and shrink on the other by the same amount at no cost, until a set is used up, whose slack is basic then (as good as an
 * edge to the ground), or a further edge is tight. */
#include "lp/tjoin/cutbasis.h"
#include "graph/disjoint.h"
#include "graph/plan/plan.h"
#include "graph/scratch.h"

#include <stdlib.h>

__extension__ typedef __int128 wide;

/* ---- where the nodes are ---- */

typedef struct {
  const thr_tjoin_problem *p;
  const thr_tjoin *t;
  int *tree;          /* [n_cuts] the outermost cut round it, or itself */
  int *first, *holds; /* cuts that name node v: holds[first[v] .. first[v + 1] - 1], in one tree each */
  bool nested;        /* no node is named twice */
  thr_scratch own;    /* the arrays */
} places;

static void places_destroy(places *s)
{
  thr_scratch_free(&s->own);
}

static thr_status places_init(places *s, const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin, thr_err *err)
{
  size_t n = (size_t)tjoin_problem->n_nodes, named = 0;
  *s = (places){.p = tjoin_problem, .t = tjoin, .nested = true};
  s->tree = thr_scratch_array(&s->own, (size_t)tjoin->n_cuts, sizeof *s->tree);
  s->first = thr_scratch_array(&s->own, n + 2, sizeof *s->first);
  if (thr_scratch_check(&s->own, err)) return THR_ENOMEM;
  for (int i = tjoin->n_cuts - 1; i >= 0; i--) {
    s->tree[i] = tjoin->cut[i].parent < 0 ? i : s->tree[tjoin->cut[i].parent];
    named += (size_t)tjoin->cut[i].n_nodes;
    for (int k = 0; k < tjoin->cut[i].n_nodes; k++)
      s->nested &= s->first[tjoin->cut[i].node[k] + 2]++ == 0;
  }
  for (size_t v = 1; v <= n; v++)
    s->first[v + 1] += s->first[v];
  s->holds = thr_scratch_array(&s->own, named, sizeof *s->holds);
  if (thr_scratch_check(&s->own, err)) return THR_ENOMEM;
  for (int i = 0; i < tjoin->n_cuts; i++)
    for (int k = 0; k < tjoin->cut[i].n_nodes; k++)
      s->holds[s->first[tjoin->cut[i].node[k] + 1]++] = i;
  return THR_OK;
}

/* The cut of that tree that names node v, or -1. */
static int place_in(const places *s, int v, int tree)
{
  for (int k = s->first[v]; k < s->first[v + 1]; k++)
    if (s->tree[s->holds[k]] == tree) return s->holds[k];
  return -1;
}

/* Of the k-th tree that names an end of edge e: the cuts that do so, -1 for an end that it does not name; a tree that came
 * before: -1 for both. False: there are not so many. */
static bool ends_in_tree(const places *s, int e, int k, int at[2])
{
  int u = s->p->edge[e][0], v = s->p->edge[e][1], of_u = s->first[u + 1] - s->first[u];
  bool second = k >= of_u;
  if (second && k - of_u >= s->first[v + 1] - s->first[v]) return false;
  at[second] = s->holds[second ? s->first[v] + k - of_u : s->first[u] + k];
  at[!second] = place_in(s, second ? u : v, s->tree[at[second]]);
  if (second && at[0] >= 0) at[0] = at[1] = -1;
  return true;
}

/* One step on the way between the cuts at[0] and at[1] (-1: outside), out of the inner one, which it returns. */
static int step_out(const thr_cut *cut, int at[2])
{
  bool second = at[0] < 0 || (at[1] >= 0 && at[1] < at[0]); /* parents come later */
  int left = at[second];
  at[second] = cut[left].parent;
  return left;
}

/* ---- columns ---- */

static void add_entry(thr_cut_programme *cut_programme, int *n, int row, double value)
{
  cut_programme->row[*n] = row;
  cut_programme->value[(*n)++] = value;
}

/* An edge stands in the equations of the innermost cuts that it leaves, at either end, and of the one that holds all of them. */
static void add_edge(thr_cut_programme *cut_programme, const places *s, int e, int *n)
{
  int at[2];
  for (int k = 0; ends_in_tree(s, e, k, at); k++) {
    int inner[2] = {at[0], at[1]}, leaves = 0;
    while (at[0] != at[1])
      step_out(s->t->cut, at);
    for (int i = 0; i < 2; i++) {
      if (inner[i] == at[0]) continue;
      add_entry(cut_programme, n, inner[i], 1);
      leaves++;
    }
    if (leaves > 0 && at[0] >= 0) add_entry(cut_programme, n, at[0], -leaves);
  }
}

static thr_status columns_init(thr_cut_programme *cut_programme, const places *s, thr_err *err)
{
  const thr_cut *cut = s->t->cut;
  size_t most = 2 * (size_t)cut_programme->n_rows;
  int n = 0;
  for (int e = 0; e < s->p->n_edges; e++)
    for (int i = 0; i < 2; i++)
      most += 3 * (size_t)(s->first[s->p->edge[e][i] + 1] - s->first[s->p->edge[e][i]]);
  cut_programme->rhs = thr_calloc((size_t)cut_programme->n_rows, sizeof *cut_programme->rhs);
  cut_programme->start = thr_calloc((size_t)cut_programme->n_columns + 1, sizeof *cut_programme->start);
  cut_programme->row = thr_calloc(most, sizeof *cut_programme->row);
  cut_programme->value = thr_calloc(most, sizeof *cut_programme->value);
  if (!cut_programme->rhs || !cut_programme->start || !cut_programme->row || !cut_programme->value) return thr_nomem(err);
  for (int e = 0; e < s->p->n_edges; e++) {
    add_edge(cut_programme, s, e, &n);
    cut_programme->start[e + 1] = n;
  }
  for (int i = 0; i < cut_programme->n_rows; i++) {
    add_entry(cut_programme, &n, i, -1);
    cut_programme->rhs[i] += 1;
    if (cut[i].parent >= 0) {
      add_entry(cut_programme, &n, cut[i].parent, 1);
      cut_programme->rhs[cut[i].parent] -= 1;
    }
    cut_programme->start[s->p->n_edges + i + 1] = n;
  }
  return THR_OK;
}

/* ---- the basis of nested sets ---- */

typedef struct {
  const places *s;
  bool *edge, *slack;   /* result: what is basic */
  int *leaving, *leave; /* edges that leave an outermost cut i: leave[leaving[i] .. leaving[i + 1] - 1] */
  int64_t *reach;       /* [n_cuts] values of the cut and of all around it */
  int64_t *grown;       /* [n_cuts] of an outermost cut: by how much its value was changed */
  int *tied;            /* [2 n_cuts + 1] disjoint sets: duals that stand or fall together; 0 = the ground, then two a cut */
  int *next;            /* [n_cuts] ring of the cuts tied together */
  int *round;           /* [2 n_cuts + 1] of a root of tied: last round in which its cuts were changed */
  thr_scratch own;      /* the arrays */
} basis;

static void basis_destroy(basis *b)
{
  thr_scratch_free(&b->own);
}

/* Innermost and outermost cut that hold node v, or -1. */
static int home_of(const places *s, int v)
{
  return s->first[v] < s->first[v + 1] ? s->holds[s->first[v]] : -1;
}

static int outermost(const places *s, int v)
{
  int home = home_of(s, v);
  return home < 0 ? -1 : s->tree[home];
}

/* Counts (leave NULL), or lists, the edges that leave outermost cuts. */
static void list_leaving(basis *b)
{
  const places *s = b->s;
  for (int e = 0; e < s->p->n_edges; e++) {
    int top[2] = {outermost(s, s->p->edge[e][0]), outermost(s, s->p->edge[e][1])};
    for (int i = 0; i < 2 && top[0] != top[1]; i++) {
      if (top[i] < 0) continue;
      if (b->leave)
        b->leave[b->leaving[top[i] + 1]++] = e;
      else
        b->leaving[top[i] + 2]++;
    }
  }
}

static thr_status basis_init(basis *b, thr_err *err)
{
  const thr_cut *cut = b->s->t->cut;
  int n = b->s->t->n_cuts;
  size_t cuts = (size_t)n;
  b->leaving = thr_scratch_array(&b->own, cuts + 2, sizeof *b->leaving);
  b->reach = thr_scratch_array(&b->own, cuts, sizeof *b->reach);
  b->grown = thr_scratch_array(&b->own, cuts, sizeof *b->grown);
  b->tied = thr_scratch_array(&b->own, 2 * cuts + 1, sizeof *b->tied);
  b->next = thr_scratch_array(&b->own, cuts, sizeof *b->next);
  b->round = thr_scratch_array(&b->own, 2 * cuts + 1, sizeof *b->round);
  if (thr_scratch_check(&b->own, err)) return THR_ENOMEM;
  list_leaving(b);
  for (int i = 1; i <= n; i++)
    b->leaving[i + 1] += b->leaving[i];
  b->leave = thr_scratch_array(&b->own, (size_t)b->leaving[n + 1], sizeof *b->leave);
  if (thr_scratch_check(&b->own, err)) return THR_ENOMEM;
  list_leaving(b);
  for (int k = 0; k < 2 * n + 1; k++)
    b->tied[k] = k;
  for (int i = n - 1; i >= 0; i--) {
    b->reach[i] = cut[i].value + (cut[i].parent < 0 ? 0 : b->reach[cut[i].parent]);
    b->next[i] = i;
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
  int up = change(b, i, false), down = change(b, i, true), other = change(b, j, false), cut = i < 0 ? j : i;
  if (i >= 0 && j >= 0 && up != other && down != other) {
    int next = b->next[i];
    b->next[i] = b->next[j];
    b->next[j] = next;
  }
  int joined = thr_disjoint_join(b->tied, up, change(b, j, true));
  joined += thr_disjoint_join(b->tied, change(b, i, true), change(b, j, false));
  if (change(b, cut, false) == change(b, cut, true)) joined += thr_disjoint_join(b->tied, 0, change(b, cut, false));
  return joined > 0;
}

/* The cuts that edge e joins on its level (-1: the ground). Returns what loads it. */
static int64_t level_ends(const places *s, int e, int end[2])
{
  int at[2] = {home_of(s, s->p->edge[e][0]), home_of(s, s->p->edge[e][1])};
  int64_t load = 0;
  end[0] = end[1] = -1;
  while (at[0] != at[1]) {
    int before = at[0], left = step_out(s->t->cut, at);
    end[left != before] = left;
    load += s->t->cut[left].value;
  }
  return load;
}

/* The join's edges, then others. */
static void tie_tight_edges(basis *b)
{
  const thr_tjoin_problem *tjoin_problem = b->s->p;
  for (int in_join = 1; in_join >= 0; in_join--)
    for (int e = 0; e < tjoin_problem->n_edges; e++) {
      int end[2];
      if (b->s->t->in_join[e] != in_join || level_ends(b->s, e, end) != (wide)tjoin_problem->weight[e] * THR_DUAL_DENOMINATOR)
        continue;
      if (end[0] >= 0 || end[1] >= 0) b->edge[e] = tie(b, end[0], end[1]);
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

static int64_t reach_of(const basis *b, int v)
{
  int home = home_of(b->s, v);
  return home < 0 ? 0 : b->reach[home] + b->grown[b->s->tree[home]];
}

/* What comes first in the component of cut i if i grows (v[0]) or shrinks (v[1]). */
static void find_events(basis *b, int i, event v[2])
{
  const thr_tjoin_problem *tjoin_problem = b->s->p;
  int up = change(b, i, false), down = change(b, i, true), c = i;
  v[0] = v[1] = (event){INT64_MAX, -1, -1};
  do {
    bool with_other = change(b, c, false) != up; /* c grows when i shrinks */
    bring_forward(&v[!with_other], b->s->t->cut[c].value + b->grown[c], c, -1);
    for (int k = b->leaving[c]; k < b->leaving[c + 1]; k++) {
      int e = b->leave[k], x = tjoin_problem->edge[e][0], y = tjoin_problem->edge[e][1];
      wide slack = (wide)tjoin_problem->weight[e] * THR_DUAL_DENOMINATOR - reach_of(b, x) - reach_of(b, y);
      int there = change(b, outermost(b->s, outermost(b->s, x) == c ? y : x), false);
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
    b->slack[v[shrink].cut] = tie(b, v[shrink].cut, -1);
  else
    b->edge[e] = tie(b, outermost(b->s, b->s->p->edge[e][0]), outermost(b->s, b->s->p->edge[e][1]));
}

/* In every round each component that is not grounded is moved, or another one to it: so those left are half as many at most. */
static void move_outermost(basis *b)
{
  bool moved = true;
  for (int round = 1; moved; round++) {
    moved = false;
    for (int i = 0; i < b->s->t->n_cuts; i++) {
      if (b->s->t->cut[i].parent >= 0 || grounded(b, i) || b->round[change(b, i, false)] == round) continue;
      move_component(b, i);
      b->round[change(b, i, false)] = b->round[change(b, i, true)] = round;
      moved = true;
    }
  }
}

static thr_status span_levels(const places *s, bool *edge, bool *slack, thr_err *err)
{
  basis b = {.s = s, .edge = edge, .slack = slack};
  thr_status st = basis_init(&b, err);
  if (!st) {
    tie_tight_edges(&b);
    move_outermost(&b);
    for (int i = 0; i < s->t->n_cuts; i++) /* inside of others: moving them would change the load of edges farther out */
      if (!grounded(&b, i)) slack[i] = tie(&b, i, -1);
  }
  basis_destroy(&b);
  return st;
}

/* ---- any basis ---- */

/* Every edge of the join that has a row for itself, one that no other edge of the join is in; and the slacks of all other rows.
 */
static thr_status span_by_join(const places *s, bool *edge, bool *slack, thr_err *err)
{
  thr_scratch own = {0};
  size_t n = (size_t)s->t->n_cuts;
  int *joined = thr_scratch_array(&own, n, sizeof *joined), *by = thr_scratch_array(&own, n, sizeof *by), at[2];
  thr_status st = thr_scratch_check(&own, err);
  for (int e = 0; e < s->p->n_edges && !st; e++)
    for (int k = 0; s->t->in_join[e] && ends_in_tree(s, e, k, at); k++)
      while (at[0] != at[1]) {
        int left = step_out(s->t->cut, at);
        joined[left]++;
        by[left] = e;
      }
  for (int i = 0; i < s->t->n_cuts && !st; i++) {
    slack[i] = joined[i] != 1 || edge[by[i]];
    if (!slack[i]) edge[by[i]] = true;
  }
  thr_scratch_free(&own);
  return st;
}

void thr_cut_programme_destroy(thr_cut_programme *cut_programme)
{
  free(cut_programme->rhs);
  free(cut_programme->start);
  free(cut_programme->row);
  free(cut_programme->value);
  free(cut_programme->basic);
  *cut_programme = (thr_cut_programme){0};
}

thr_status thr_cut_programme_init(thr_cut_programme *cut_programme, const thr_tjoin_problem *tjoin_problem,
                                  const thr_tjoin *tjoin, thr_err *err)
{
  places s;
  *cut_programme = (thr_cut_programme){.n_rows = tjoin->n_cuts, .n_columns = tjoin_problem->n_edges + tjoin->n_cuts};
  cut_programme->basic = thr_calloc((size_t)cut_programme->n_columns, sizeof *cut_programme->basic);
  thr_status st = places_init(&s, tjoin_problem, tjoin, err);
  if (!st && !cut_programme->basic) st = thr_nomem(err);
  if (!st) st = columns_init(cut_programme, &s, err);
  if (!st) { /* proved to the last unit: every cut is left by one edge of the join */
    bool exact = tjoin->sum == (wide)tjoin->length * THR_DUAL_DENOMINATOR;
    st = (exact && s.nested ? span_levels : span_by_join)(&s, cut_programme->basic, cut_programme->basic + tjoin_problem->n_edges,
                                                          err);
  }
  places_destroy(&s);
  if (st) thr_cut_programme_destroy(cut_programme);
  return st;
}
