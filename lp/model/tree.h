/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Branch and cut: a pool of rows, one node's search by cutting planes, and the tree of nodes. */
#ifndef THR_TREE_H
#define THR_TREE_H

#include "graph/limits.h"
#include "graph/status.h"
#include "lp/solver/lp.h"

#include <stdint.h>

/* ---- pool.c: The rows of a relaxation that separation has found: sum value x[column] >= lower (a
 * pool of cuts). */

typedef struct {
  uint64_t name; /* 0 = its columns, values and lower bound, which the pool then makes a name of */
  int kind, index; /* what it is the row of; the caller's */
  int n_members;  /* the same, where one number does not say it: a set, the blocks of a partition */
  int *member;    /* [n_members] or NULL; copied */
  double lower;   /* the right side; the rest is filled in by the pool */
  int n, *column; /* [n] in the order in which they were put */
  double *value;  /* [n]; NULL = all 1 */
  int idle;       /* consecutive looks at which it was slack */
} thr_row;

typedef struct {
  int n_columns, count, capacity;
  thr_row *row;
  uint64_t *seen; /* open-addressed set of names */
  int seen_size, seen_used;
  double *sum;   /* [n_columns] coefficients of the row that is being put together */
  bool *drafted; /* [n_columns] does it stand in draft? */
  int *draft, n_draft;
} thr_pool;

/* For points x[n_columns]. */
thr_status thr_pool_init(thr_pool *p, int n_columns, thr_err *err) THR_MUST_CHECK;
void thr_pool_destroy(thr_pool *p);

/* Adds all rows of another pool for the same columns. */
thr_status thr_pool_copy(thr_pool *p, const thr_pool *from, thr_err *err) THR_MUST_CHECK;

/* Adds value to the coefficient of a column, in the row that is being put together. */
void thr_pool_put(thr_pool *p, int column, double value);

/* Is there a row of this name? */
bool thr_pool_knows(const thr_pool *p, uint64_t name);

/* The row that was put together becomes one of the pool, whatever is there already. */
thr_status thr_pool_add(thr_pool *p, thr_row row, thr_err *err) THR_MUST_CHECK;

/* The same if it is new and x violates it by more than the tolerance, counted in *added; else it is
 * forgotten. */
thr_status thr_pool_offer(thr_pool *p, thr_row row, const double *x, double tolerance, int *added,
                          thr_err *err) THR_MUST_CHECK;

/* sum value x[column] */
double thr_row_sum(const thr_row *r, const double *x);

/* reduced[column] -= price * value: what a row of this price leaves of the costs. */
void thr_row_charge(const thr_row *r, double price, double *reduced);

/* Forgets the rows marked in drop[count], which may be found again; the others keep their order. */
void thr_pool_drop(thr_pool *p, const bool *drop);

/* Forgets those from number `first` on that x does not violate by more than the tolerance. *added
 * grows by the others. */
thr_status thr_pool_keep_violated(thr_pool *p, int first, const double *x, double tolerance,
                                  int *added, thr_err *err) THR_MUST_CHECK;

/* ---- search.c: Rounds of cutting: a linear programme is solved, its optimum is looked at, and
 * rows that it violates are added, until there are none or the bound suffices. */

/* Adds rows that the point violates to the pool, counted in *added. */
typedef thr_status thr_separator(void *user, int *added, thr_err *err);

/* When a separator is asked: only where those before have found none in this round; not when the
 * limits say stop, which ends the rounds. */
enum { THR_FALLBACK = 1, THR_SLOW = 2 };

typedef struct {
  thr_lp *lp;        /* owned */
  thr_pool pool;     /* its rows after the first n_fixed; the last of them may not be in it yet */
  int n_fixed, help; /* help: a column of value 1 in every row of the pool, which keeps it feasible;
                        at first -1: none */
  bool
      bare; /* the next solve begins without the pool's rows, for which its basis is not feasible */
  double *x;        /* [columns of lp] borrowed: the point of the last solve */
  int n_dual;       /* rows at the last solve */
  double *dual;     /* [n_dual] its multipliers; owned */
  double objective; /* its value */
  thr_lp_outcome
      outcome;        /* its outcome; THR_LP_STOPPED also where a slow separator was not begun */
  bool whole, enough; /* what thr_search_calls.look says of it */
  double at_drop;     /* objective when rows were last dropped */
  int n_separators;
  struct {
    thr_separator *find;
    void *user;
    int when;
  } separator[8];
} thr_search;

/* What is done in every round. */
typedef struct {
  void *user;
  const char *name; /* of a programme that always has an optimum: none is THR_ESOLVER; NULL = it may
                       have none */
  /* Solves s->lp; NULL = thr_lp_solve. */
  thr_status (*solve)(void *user, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err);
  /* Of the last solve, whatever its outcome: s->enough: no more rows are needed; s->whole: it is no
   * fractional point. */
  thr_status (*look)(void *user, thr_err *err);
  int most_rounds; /* for points that are not whole; 0 = any number */
  int patience;    /* rows slack for more rounds than this go, if all rows are the pool's; 0 = none
                      goes */
} thr_search_calls;

/* Without a programme. pool_columns: of the pool's rows. x must outlive it. */
thr_status thr_search_init(thr_search *s, int pool_columns, double *x, thr_err *err) THR_MUST_CHECK;
void thr_search_destroy(thr_search *s);

/* One more separator, asked after those before: at most 8. when: 0, THR_FALLBACK, THR_SLOW or both.
 */
void thr_search_use(thr_search *s, thr_separator *find, void *user, int when);

/* Adds the pool's rows that are not in the programme yet. */
thr_status thr_search_load(thr_search *s, thr_err *err) THR_MUST_CHECK;

/* Until no row is violated, the last look has found the bound enough, or there is no optimum:
 * outcome says which. */
thr_status thr_search_rounds(thr_search *s, const thr_search_calls *calls, const thr_limits *limits,
                             thr_err *err) THR_MUST_CHECK;

/* ---- tree.c: Branch and bound, best bound first, over whatever bounds are handed in. */

enum { THR_TREE_ANY = INT32_MAX }; /* a column that has no upper bound */

typedef struct {
  int parent, depth; /* the root: -1, 0 */
  int column, value; /* what it decides: column <= value, or >= value + 1 if high */
  int n_also, *also; /* if not high: other columns that are <= value as well; owned */
  bool high, first;  /* first: it is preferred to the other child */
  int child[2];      /* that with the lower values, the other one; 0 = none */
  double bound;      /* no solution here is worth less; at first its parent's */
  int proof; /* the caller's number of what proves that, -1 = nothing; at first its parent's */
} thr_tree_node;

/* What to decide at a node. */
typedef struct {
  int column, value; /* children: <= value, >= value + 1; column -1: no children */
  bool high;         /* the latter is preferred */
  int n_also; /* of other columns that the first child has <= value, since where one of them is more
                 there is a solution */
  const int *also; /* worth the same with this column more; borrowed until the node is split */
} thr_tree_branch;

/* Where nodes are solved, one after the other. */
typedef struct {
  int *low, *high; /* [n_columns] bounds in force; owned */
  int *next[2];    /* [n_columns] scratch: the same of the node to be entered; owned */
  int at;          /* at this node */
} thr_tree_place;

enum { THR_TREE_BATCH = 4 }; /* most nodes that are solved at once */

typedef struct {
  int n_columns, *least, *most; /* [n_columns] bounds of the root */
  double enough; /* nodes of this bound or more are closed; INFINITY = no solution is known */
  double
      grain; /* bounds are equal if they are in the same multiple of it; 0 = if they are the same */
  int most_nodes; /* at which it stops; at first any number */
  bool stopped;   /* by most_nodes, by the limits, or by the caller */
  int n_nodes, capacity, n_open, open_capacity;
  thr_tree_node *node; /* [n_nodes] the root first, children always after their parents */
  int *open;           /* [n_open] nodes to be solved: a heap */
  int n_solved, n_taken, taken[THR_TREE_BATCH]; /* solved so far; those being solved */
  thr_tree_place here;                          /* where one node at a time is solved */
} thr_tree;

typedef struct {
  void *user;
  const thr_limits *limits; /* NULL = none but those that the caller keeps itself. The root is
                               solved in any case */
  /* The bounds of a column from now on. */
  thr_status (*set)(void *user, int column, int low, int high, thr_err *err);
  /* Solves a node: may raise its bound and lower the tree's `enough`, and fills in the branch. */
  thr_status (*solve)(void *user, int node, thr_tree_branch *branch, thr_err *err);
  /* Solves n > 1 nodes, whose bounds the caller puts in force: the same for each. NULL = they are
   * solved one after the other. */
  thr_status (*solve_all)(void *user, int n, const int *node, thr_tree_branch *branch,
                          thr_err *err);
} thr_tree_calls;

/* With the root alone, of bound -INFINITY. least, most: [n_columns] bounds in force everywhere;
 * copied. least NULL: all 0. */
thr_status thr_tree_init(thr_tree *t, int n_columns, const int *least, const int *most,
                         thr_err *err) THR_MUST_CHECK;
void thr_tree_destroy(thr_tree *t);

/* Until all nodes are closed, or it is stopped. */
thr_status thr_tree_run(thr_tree *t, const thr_tree_calls *calls, thr_err *err) THR_MUST_CHECK;

/* Puts the bounds of a node in force: in t->here, or another place, of which calls.set and its user
 * are. */
thr_status thr_tree_enter(thr_tree *t, const thr_tree_calls *calls, int node,
                          thr_err *err) THR_MUST_CHECK;
thr_status thr_tree_enter_at(const thr_tree *t, const thr_tree_calls *calls, thr_tree_place *place,
                             int node, thr_err *err) THR_MUST_CHECK;

bool thr_tree_closed(const thr_tree *t, int node);

/* The column of first .. end - 1 to decide on at the point x: of those farther than the tolerance
 * from a whole number the farthest, of equal ones the first; -1 = none. Columns of decided[] > 0
 * are left out (NULL = none is). */
int thr_tree_undecided(const double *x, int first, int end, double tolerance, const int *decided);

/* The least bound of the nodes being solved and of those to be solved. */
double thr_tree_bound(const thr_tree *t);

#endif
