/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Branch and cut (Padberg & Rinaldi, SIAM Review 33, 1991) in three parts that can be used alone: a
 * pool of rows, the cutting-plane method for one linear programme, and branch and bound. This
 * folder knows nothing about cords: callers hand in the columns, the separators that find rows, and
 * the function that solves a node.
 *
 * Read pool.c first, then search.c, which adds the pool's rows to a programme; tree.c needs
 * neither. Callers are lp/tjoin/tjoin.c for rounds without branching, tortuosity/ and symmetry/ for
 * trees. */
#ifndef THR_TREE_H
#define THR_TREE_H

#include "graph/limits.h"
#include "graph/status.h"
#include "lp/solver/solver.h"

/* ---- pool.c: the rows of a relaxation that separation has found ---- */

/* A row: sum of value[k] x[column[k]] >= lower. The caller fills in what comes before lower. */
typedef struct {
  uint64_t name;   /* 0: the pool computes a name from columns, values and lower bound */
  int kind, index; /* what the row belongs to; the caller's */
  int n_members;   /* the same, where one number is not enough: a set, the blocks of a partition */
  int *member;     /* [n_members] or NULL; copied */
  double lower;    /* the right side; the pool fills in the rest */
  int n, *column;  /* [n] in the order in which they were put */
  double *value;   /* [n]; NULL = all 1 */
  int idle;        /* number of consecutive rounds in which the row was slack */
} thr_row;

/* All rows of a relaxation, and the draft of the next one. */
typedef struct {
  int n_columns, count, capacity;
  thr_row *row;
  uint64_t *seen; /* open-addressed set of names, [seen_size] */
  int seen_size, seen_used;
  double *sum;         /* [n_columns] coefficients of the draft */
  bool *drafted;       /* [n_columns] is the column in the draft? */
  int *draft, n_draft; /* [n_draft] columns of the draft */
} thr_pool;

/* Makes an empty pool for points x[n_columns]. Release with thr_pool_destroy. */
thr_status thr_pool_init(thr_pool *p, int n_columns, thr_err *err) THR_MUST_CHECK;
void thr_pool_destroy(thr_pool *p);

/* Adds all rows of another pool for the same columns. */
thr_status thr_pool_copy(thr_pool *p, const thr_pool *from, thr_err *err) THR_MUST_CHECK;

/* Adds value to the coefficient of a column in the draft of the next row. */
void thr_pool_put(thr_pool *p, int column, double value);

/* Says whether there is a row of this name. */
bool thr_pool_knows(const thr_pool *p, uint64_t name);

/* Makes a row of the draft, even if there is one of the same name. The draft becomes empty. */
thr_status thr_pool_add(thr_pool *p, thr_row row, thr_err *err) THR_MUST_CHECK;

/* Makes a row of the draft if x violates it by more than the tolerance and the pool has none of
 * this name; *added counts the row. The draft is empty afterwards. */
thr_status thr_pool_offer(thr_pool *p, thr_row row, const double *x, double tolerance, int *added,
                          thr_err *err) THR_MUST_CHECK;

/* Returns the left side of a row, sum of value x[column]. */
double thr_row_sum(const thr_row *r, const double *x);

/* Subtracts price * value from the reduced cost of each column of a row: what the row's multiplier
 * leaves of the costs. */
void thr_row_charge(const thr_row *r, double price, double *reduced);

/* Removes the rows marked in drop[count], which may be found again; the others keep their order. */
void thr_pool_drop(thr_pool *p, const bool *drop);

/* Removes the rows from number first on that x does not violate by more than the tolerance. *added
 * grows by the number of the others. */
thr_status thr_pool_keep_violated(thr_pool *p, int first, const double *x, double tolerance,
                                  int *added, thr_err *err) THR_MUST_CHECK;

/* ---- search.c: rounds of the cutting-plane method ---- */

/* A separator: adds rows that the point violates to the pool, and counts them in *added. */
typedef thr_status thr_separator(void *user, int *added, thr_err *err);

/* When a separator is asked. THR_FALLBACK: only where the separators before have found no row in
 * this round. THR_SLOW: not when the limits say stop, which ends the rounds. */
enum { THR_FALLBACK = 1, THR_SLOW = 2 };

/* A linear programme, its rows, and what finds them. */
typedef struct {
  thr_lp *lp;    /* owned */
  thr_pool pool; /* rows of lp after the first n_fixed; the last rows of the pool may not be in lp
                    yet */
  int n_fixed;   /* rows that are not the pool's */
  int help;      /* a column of value 1 in every row of the pool, which keeps lp feasible; -1: none,
                    as at first */
  bool bare;     /* the next solve begins without the new rows of the pool, for which the basis is
                    not feasible */
  double *x;     /* [columns of lp] borrowed: the point of the last solve */
  int n_dual;    /* number of rows at the last solve */
  double *dual;  /* [n_dual] multipliers of the last solve; owned */
  double objective;       /* value of the last solve */
  thr_lp_outcome outcome; /* of the last solve; THR_LP_STOPPED also where a slow separator was not
                             begun */
  bool whole, enough;     /* what thr_search_calls.look says about the last solve */
  double at_drop;         /* objective when rows were last dropped */
  int n_separators;
  struct {
    thr_separator *find;
    void *user;
    int when;
  } separator[8];
} thr_search;

/* What the caller does in every round. */
typedef struct {
  void *user;
  const char *name; /* of a programme that always has an optimum: if there is none, THR_ESOLVER;
                       NULL = the programme may be infeasible */
  /* Solves s->lp; NULL = thr_lp_solve. */
  thr_status (*solve)(void *user, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err);
  /* Looks at the last solve, whatever its outcome. Sets s->enough if no more rows are needed, and
   * s->whole if the point is not fractional. */
  thr_status (*look)(void *user, thr_err *err);
  int most_rounds; /* for points that are not whole; 0 = any number */
  int patience;    /* rows that are slack for more rounds are dropped, if all rows are the pool's; 0
                      = no row is dropped */
} thr_search_calls;

/* Makes a search without a programme, which the caller creates as s->lp. pool_columns: of the
 * pool's rows. x must outlive the search. */
thr_status thr_search_init(thr_search *s, int pool_columns, double *x, thr_err *err) THR_MUST_CHECK;
void thr_search_destroy(thr_search *s);

/* Appends a separator, asked after the others; at most 8. when: THR_FALLBACK | THR_SLOW or 0. */
void thr_search_use(thr_search *s, thr_separator *find, void *user, int when);

/* Runs rounds until no row is violated, look has found the bound enough, or there is no optimum:
 * s->outcome says which. */
thr_status thr_search_rounds(thr_search *s, const thr_search_calls *calls, const thr_limits *limits,
                             thr_err *err) THR_MUST_CHECK;

/* ---- tree.c: branch and bound ---- */

/* The upper bound of a column that has none. */
enum { THR_TREE_ANY = INT32_MAX };

/* A node of the tree. */
typedef struct {
  int parent, depth; /* the root: -1, 0 */
  int column, value; /* the decision: column <= value, or >= value + 1 if high */
  int n_also, *also; /* if not high: other columns that are <= value as well; owned */
  bool high, first;  /* first: preferred to the other child */
  int child[2];      /* the child with the lower values, and the other one; 0 = none */
  double bound;      /* no solution of the node has a lower value; at first the parent's bound */
  int proof; /* the caller's number of what proves the bound, -1 = nothing; at first the parent's */
} thr_tree_node;

/* How to branch at a node. */
typedef struct {
  int column, value; /* children: column <= value, column >= value + 1; column -1: no children */
  bool high;         /* the second child is preferred */
  int n_also;        /* number of other columns that are <= value in the first child, too: if one of
                        them is more in a solution, an image of this solution, of equal value, has
                        the column itself more */
  const int *also;   /* [n_also] borrowed until the node is split */
} thr_tree_branch;

/* The bounds on columns where nodes are solved, one after the other. */
typedef struct {
  int *low, *high; /* [n_columns] bounds in force; owned */
  int *next[2];    /* [n_columns] scratch: the bounds of the node to be entered; owned */
  int at;          /* node whose bounds are in force */
} thr_tree_place;

enum { THR_TREE_BATCH = 4 }; /* most nodes that are solved at the same time */

typedef struct {
  int n_columns, *least, *most; /* [n_columns] bounds of the root */
  double enough;  /* nodes of this bound or more are closed: the value of the incumbent, or a little
                     less; INFINITY = no solution is known */
  double grain;   /* bounds in the same multiple of grain are equal in the order of nodes; 0 = only
                     if they are the same */
  int most_nodes; /* number of nodes at which the tree stops; at first any number */
  bool stopped;   /* by most_nodes, by the limits, or by the caller */
  int n_nodes, capacity, n_open, open_capacity;
  thr_tree_node *node; /* [n_nodes] the root first, children always after their parents */
  int *open;           /* [n_open] nodes to be solved: a heap */
  int n_solved;        /* number of nodes solved or being solved */
  int n_taken, taken[THR_TREE_BATCH]; /* nodes of the present batch */
  thr_tree_place here;                /* where one node at a time is solved */
} thr_tree;

/* What the caller does at a node. */
typedef struct {
  void *user;
  const thr_limits *limits; /* NULL = the caller looks at the limits. The root is solved in any
                               case */
  /* Puts the bounds of a column in force. */
  thr_status (*set)(void *user, int column, int low, int high, thr_err *err);
  /* Solves a node: may raise its bound, lowers tree.enough when there is a better solution, and
   * fills in the branch. */
  thr_status (*solve)(void *user, int node, thr_tree_branch *branch, thr_err *err);
  /* Solves n > 1 nodes in the same way, after putting the bounds of each in force. NULL = nodes are
   * solved one after the other. */
  thr_status (*solve_all)(void *user, int n, const int *node, thr_tree_branch *branch,
                          thr_err *err);
} thr_tree_calls;

/* Makes a tree of the root alone, with bound -INFINITY. least, most: [n_columns] bounds in force at
 * all nodes; copied. least NULL: all 0. Release with thr_tree_destroy. */
thr_status thr_tree_init(thr_tree *t, int n_columns, const int *least, const int *most,
                         thr_err *err) THR_MUST_CHECK;
void thr_tree_destroy(thr_tree *t);

/* Solves and splits nodes until all are closed or the tree is stopped. */
thr_status thr_tree_run(thr_tree *t, const thr_tree_calls *calls, thr_err *err) THR_MUST_CHECK;

/* Puts the bounds of a node in force: in t->here, or in another place, to which calls.set and
 * calls.user must belong. */
thr_status thr_tree_enter(thr_tree *t, const thr_tree_calls *calls, int node,
                          thr_err *err) THR_MUST_CHECK;
thr_status thr_tree_enter_at(const thr_tree *t, const thr_tree_calls *calls, thr_tree_place *place,
                             int node, thr_err *err) THR_MUST_CHECK;

/* Returns the column of first .. end - 1 to branch on at the point x: of the columns farther than
 * the tolerance from a whole number the farthest, of equal ones the first; -1 = none. Columns with
 * decided[] > 0 are left out (decided NULL: none is). */
int thr_tree_undecided(const double *x, int first, int end, double tolerance, const int *decided);

/* Returns the least bound of the open nodes and of the present batch. */
double thr_tree_bound(const thr_tree *t);

#endif
