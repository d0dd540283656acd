/* Branch and bound, best bound first, over whatever bounds are handed in.
 *
 * Land & Doig, Econometrica 28, 1960; Dakin, Computer Journal 8, 1965. A node of the tree is a set of solutions: those that keep
 * the decisions  x[column] <= value  or  x[column] >= value + 1  on the way from the root to it. A function says what they are
 * worth at least, by a linear programme, a matching or an ascent, and which column to decide on next. A node whose bound reaches
 * what the best solution known is worth is closed: nothing below it is looked at. So  least open bound <= optimum <= best known,
 * and when all are closed the best known is the optimum.
 *
 * Solutions may have images of the same worth. Where the image of a decision is as good as that, one side decides for all images
 * at once (orbital branching: Ostrowski, Linderoth, Rossi & Smriglio, Math. Programming 126, 2011).
 *
 * The node of least bound comes first; of equal ones the deepest, then the youngest, then the side that was preferred. Several
 * may be solved at once, each in a place of its own, so that they can be given to threads: how many depends on the tree alone.
 *   thr_tree_init(&tree, n, least, most, &err);
 *   thr_tree_run(&tree, &calls, &err);   whose solve sets tree.node[node].bound, and tree.enough when it finds a solution
 *   if (!tree.stopped) ..                nothing is worth less than tree.enough */
#ifndef THR_TREE_H
#define THR_TREE_H

#include "graph/limits.h"
#include "graph/status.h"

enum { THR_TREE_ANY = INT32_MAX }; /* a column that has no upper bound */

typedef struct {
  int parent, depth; /* the root: -1, 0 */
  int column, value; /* what it decides: column <= value, or >= value + 1 if high */
  int n_also, *also; /* if not high: other columns that are <= value as well; owned */
  bool high, first;  /* first: it is preferred to the other child */
  int child[2];      /* that with the lower values, the other one; 0 = none */
  double bound;      /* no solution here is worth less; at first its parent's */
  int proof;         /* the caller's number of what proves that, -1 = nothing; at first its parent's */
} thr_tree_node;

/* What to decide at a node. */
typedef struct {
  int column, value; /* children: <= value, >= value + 1; column -1: no children */
  bool high;         /* the latter is preferred */
  int n_also;        /* of other columns that the first child has <= value, since where one of them is more there is a solution */
  const int *also;   /* worth the same with this column more; borrowed until the node is split */
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
  double enough;                /* nodes of this bound or more are closed; INFINITY = no solution is known */
  double grain;                 /* bounds are equal if they are in the same multiple of it; 0 = if they are the same */
  int most_nodes;               /* at which it stops; at first any number */
  bool stopped;                 /* by most_nodes, by the limits, or by the caller */
  int n_nodes, capacity, n_open, open_capacity;
  thr_tree_node *node;                          /* [n_nodes] the root first, children always after their parents */
  int *open;                                    /* [n_open] nodes to be solved: a heap */
  int n_solved, n_taken, taken[THR_TREE_BATCH]; /* solved so far; those being solved */
  thr_tree_place here;                          /* where one node at a time is solved */
} thr_tree;

typedef struct {
  void *user;
  const thr_limits *limits; /* NULL = none but those that the caller keeps itself. The root is solved in any case */
  /* The bounds of a column from now on. */
  thr_status (*set)(void *user, int column, int low, int high, thr_err *err);
  /* Solves a node: may raise its bound and lower the tree's `enough`, and fills in the branch. */
  thr_status (*solve)(void *user, int node, thr_tree_branch *branch, thr_err *err);
  /* Solves n > 1 nodes, whose bounds the caller puts in force: the same for each. NULL = they are solved one after the other. */
  thr_status (*solve_all)(void *user, int n, const int *node, thr_tree_branch *branch, thr_err *err);
} thr_tree_calls;

/* With the root alone, of bound -INFINITY. least, most: [n_columns] bounds in force everywhere; copied. least NULL: all 0. */
thr_status thr_tree_init(thr_tree *t, int n_columns, const int *least, const int *most, thr_err *err) THR_MUST_CHECK;
void thr_tree_destroy(thr_tree *t);

/* Until all nodes are closed, or it is stopped. */
thr_status thr_tree_run(thr_tree *t, const thr_tree_calls *calls, thr_err *err) THR_MUST_CHECK;

/* Puts the bounds of a node in force: in t->here, or another place, of which calls.set and its user are. */
thr_status thr_tree_enter(thr_tree *t, const thr_tree_calls *calls, int node, thr_err *err) THR_MUST_CHECK;
thr_status thr_tree_enter_at(const thr_tree *t, const thr_tree_calls *calls, thr_tree_place *place, int node,
                             thr_err *err) THR_MUST_CHECK;

bool thr_tree_closed(const thr_tree *t, int node);

/* The column of first .. end - 1 to decide on at the point x: of those farther than the tolerance from a whole number the
 * farthest, of equal ones the first; -1 = none. Columns of decided[] > 0 are left out (NULL = none is). */
int thr_tree_undecided(const double *x, int first, int end, double tolerance, const int *decided);

/* The least bound of the nodes being solved and of those to be solved. */
double thr_tree_bound(const thr_tree *t);

#endif
