/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements lp/solver/solver.h with GLPK: the only file that knows this library.
 *
 * GLPK aborts on misuse and when memory runs out, so every call runs under guarded(), whose error
 * hook leaves it by longjmp. After that GLPK's environment must be freed, which destroys every
 * problem of the thread; each thr_lp remembers in which generation of the environment it was made.
 * Calls are therefore written as a struct of arguments and a function do_..() that takes it.
 *
 * Pivots are counted, not timed, so that the same input gives the same answer on every machine.
 * Exact simplex and branch and bound cannot be stopped, and run in a child process. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"
#include "graph/text.h"
#include "lp/solver/solver.h"

#include <glpk.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

struct thr_lp {
  glp_prob *problem;
  int generation;
  bool primal;   /* the next solve starts from a basis that was set */
  bool integer;  /* the last solve was by branch and bound, whose results GLPK keeps apart */
  double *exact; /* the numbers of the last solve if that was in a child, exact or by branch and
                    bound, else NULL; owned */
};

/* Of the thread, as GLPK's environment is. */
static _Thread_local int generation;
static _Thread_local jmp_buf escape;
static _Thread_local char message[160]; /* GLPK's last words */

/* Keeps the first line of what GLPK would print: the reason if it aborts. */
static int keep_text(void *unused, const char *text)
{
  (void)unused;

  size_t n = strcspn(text, "\n");
  if (n > 0) {
    if (n >= sizeof message) n = sizeof message - 1;
    memcpy(message, text, n);
    message[n] = '\0';
  }
  return 1; /* GLPK must not print it, either */
}

static void jump_out(void *unused)
{
  (void)unused;
  longjmp(escape, 1);
}

/* GLPK's environment belongs to the thread that made it, and nobody else frees it: it goes with the
 * thread. */
static pthread_key_t thread_end;
static pthread_once_t once = PTHREAD_ONCE_INIT;
static bool has_key;

static void free_environment(void *unused)
{
  (void)unused;
  glp_free_env();
}

/* Makes the key whose destructor frees the environment; without memory there is none. */
static void make_key(void)
{
  has_key = pthread_key_create(&thread_end, free_environment) == 0;
}

/* Has the environment freed when the thread ends; without memory for that it stays. */
static void free_with_the_thread(void)
{
  static const bool used = true;
  pthread_once(&once, make_key);

  /* The value only has to be something other than NULL. */
  if (has_key && !pthread_getspecific(thread_end)) pthread_setspecific(thread_end, &used);
}

/* Runs call(argument) with GLPK's aborts turned into THR_ESOLVER. The hooks are set anew each time
 * because igraph, which shares the library, may have set its own. */
static thr_status guarded(void (*call)(void *), void *argument, thr_err *err)
{
  message[0] = '\0';
  free_with_the_thread();

  /* Through keep_text: the reason of an abort passes here. */
  glp_term_out(GLP_ON);
  glp_term_hook(keep_text, NULL);

  /* After an abort the environment is not to be used again. */
  if (setjmp(escape)) {
    glp_free_env();
    generation++;
    return thr_fail(err, THR_ESOLVER, "GLPK gave up: %s", message);
  }

  glp_error_hook(jump_out, NULL);
  call(argument);

  glp_error_hook(NULL, NULL);
  glp_term_hook(NULL, NULL);
  return THR_OK;
}

/* Fails if the environment in which the programme was made is gone. */
static thr_status check_alive(const thr_lp *lp, thr_err *err)
{
  if (lp->problem && lp->generation == generation) return THR_OK;
  return thr_fail(err, THR_ESOLVER, "the linear programme was lost in an earlier failure of GLPK");
}

static void forget_exact(thr_lp *lp)
{
  free(lp->exact);
  lp->exact = NULL;
}

/* ---- building ---- */

typedef struct {
  thr_lp **lp;
  int n;
  const double *cost, *upper;
} create_call;

/* Creates the problem with its columns; GLPK counts from 1. */
static void do_create(void *argument)
{
  create_call *call = argument;
  glp_prob *problem = (*call->lp)->problem = glp_create_prob();
  glp_set_obj_dir(problem, GLP_MIN);
  if (call->n > 0) glp_add_cols(problem, call->n);

  /* A column with an upper bound of 0 is fixed. */
  for (int j = 0; j < call->n; j++) {
    glp_set_obj_coef(problem, j + 1, call->cost[j]);
    if (call->upper)
      glp_set_col_bnds(problem, j + 1, call->upper[j] > 0 ? GLP_DB : GLP_FX, 0, call->upper[j]);
    else
      glp_set_col_bnds(problem, j + 1, GLP_LO, 0, 0);
  }

  /* All slacks are basic. */
  glp_std_basis(problem);
}

/* Makes *lp, whose problem call(argument) then creates; NULL on failure. */
static thr_status make(thr_lp **lp, void (*call)(void *), void *argument, thr_err *err)
{
  *lp = thr_calloc(1, sizeof **lp);
  if (!*lp) return thr_nomem(err);
  (*lp)->generation = generation;

  thr_status st = guarded(call, argument, err);
  if (st) {
    free(*lp);
    *lp = NULL;
  }
  return st;
}

thr_status thr_lp_create(thr_lp **lp, int n_columns, const double *cost, const double *upper,
                         thr_err *err)
{
  return make(lp, do_create, &(create_call){lp, n_columns, cost, upper}, err);
}

static void do_destroy(void *argument)
{
  glp_delete_prob(argument);
}

void thr_lp_destroy(thr_lp *lp)
{
  if (!lp) return;
  if (!check_alive(lp, NULL) && guarded(do_destroy, lp->problem, NULL)) lp->problem = NULL;
  forget_exact(lp);
  free(lp);
}

typedef struct {
  thr_lp **lp;
  const thr_lp *from;
} copy_call;

static void do_copy(void *argument)
{
  copy_call *call = argument;
  (*call->lp)->primal = call->from->primal;
  (*call->lp)->problem = glp_create_prob();
  glp_copy_prob((*call->lp)->problem, call->from->problem, GLP_OFF);
}

thr_status thr_lp_copy(thr_lp **lp, const thr_lp *from, thr_err *err)
{
  return make(lp, do_copy, &(copy_call){lp, from}, err);
}

typedef struct {
  thr_lp **lp;
  int n_rows, n_columns;
  const double *rhs, *cost, *value;
  const bool *free;
  const int *start, *row;
  int *index;    /* of one column, 1-based */
  double *entry; /* of one column, 1-based */
} equations_call;

/* Creates rows and columns with their entries. */
static void do_create_equations(void *argument)
{
  equations_call *call = argument;
  glp_prob *problem = (*call->lp)->problem = glp_create_prob();

  /* x >= 0, or unbounded both ways. */
  glp_set_obj_dir(problem, GLP_MIN);
  if (call->n_rows > 0) glp_add_rows(problem, call->n_rows);
  if (call->n_columns > 0) glp_add_cols(problem, call->n_columns);

  /* Rows are equations. */
  for (int i = 0; i < call->n_rows; i++)
    glp_set_row_bnds(problem, i + 1, GLP_FX, call->rhs[i], call->rhs[i]);

  /* Columns one by one, as GLPK takes them. */
  for (int j = 0; j < call->n_columns; j++) {
    int n = call->start[j + 1] - call->start[j];
    for (int k = 0; k < n; k++) {
      call->index[k + 1] = call->row[call->start[j] + k] + 1;
      call->entry[k + 1] = call->value[call->start[j] + k];
    }
    glp_set_obj_coef(problem, j + 1, call->cost[j]);
    glp_set_col_bnds(problem, j + 1, call->free && call->free[j] ? GLP_FR : GLP_LO, 0, 0);
    glp_set_mat_col(problem, j + 1, n, call->index, call->entry);
  }

  glp_std_basis(problem);
}

thr_status thr_lp_create_equations(thr_lp **lp, int n_rows, const double *rhs, int n_columns,
                                   const double *cost, const bool *free_columns, const int *start,
                                   const int *row, const double *value, thr_err *err)
{
  equations_call call = {lp,           n_rows, n_columns, rhs,  cost, value,
                         free_columns, start,  row,       NULL, NULL};

  /* Scratch for one column, from 1. */
  int longest = 0;
  for (int j = 0; j < n_columns; j++)
    if (start[j + 1] - start[j] > longest) longest = start[j + 1] - start[j];
  call.index = thr_calloc((size_t)longest + 1, sizeof *call.index);
  call.entry = thr_calloc((size_t)longest + 1, sizeof *call.entry);

  *lp = NULL;
  thr_status st =
      call.index && call.entry ? make(lp, do_create_equations, &call, err) : thr_nomem(err);

  free(call.index);
  free(call.entry);
  return st;
}

typedef struct {
  glp_prob *problem;
  int n, *index; /* both arrays are 1-based, as GLPK wants them */
  double *value, lower;
} row_call;

static void do_add_row(void *argument)
{
  row_call *call = argument;
  int row = glp_add_rows(call->problem, 1);
  glp_set_row_bnds(call->problem, row, GLP_LO, call->lower, 0);
  glp_set_mat_row(call->problem, row, call->n, call->index, call->value);
}

thr_status thr_lp_add_row(thr_lp *lp, int n, const int *column, const double *value, double lower,
                          thr_err *err)
{
  thr_status st = check_alive(lp, err);
  forget_exact(lp);
  if (st) return st;

  /* Copies from 1, as GLPK wants them. */
  row_call call = {lp->problem, n, thr_calloc((size_t)n + 1, sizeof(int)),
                   thr_calloc((size_t)n + 1, sizeof(double)), lower};
  if (!call.index || !call.value) {
    st = thr_nomem(err);
    goto done;
  }

  /* Values default to 1. */
  for (int i = 0; i < n; i++) {
    call.index[i + 1] = column[i] + 1;
    call.value[i + 1] = value ? value[i] : 1;
  }
  st = guarded(do_add_row, &call, err);

done:
  free(call.index);
  free(call.value);
  return st;
}

typedef struct {
  glp_prob *problem;
  int n, *row;
} drop_call;

static void do_drop(void *argument)
{
  drop_call *call = argument;
  glp_del_rows(call->problem, call->n, call->row);
}

thr_status thr_lp_drop_rows(thr_lp *lp, const bool *drop, thr_err *err)
{
  thr_status st = check_alive(lp, err);
  forget_exact(lp);
  if (st) return st;

  int n = glp_get_num_rows(lp->problem);
  drop_call call = {lp->problem, 0, thr_calloc((size_t)n + 1, sizeof(int))};
  if (!call.row) return thr_nomem(err);

  /* Numbers of the rows, from 1. */
  for (int i = 0; i < n; i++)
    if (drop[i]) call.row[++call.n] = i + 1;
  if (call.n > 0) st = guarded(do_drop, &call, err);

  free(call.row);
  return st;
}

bool thr_lp_row_basic(const thr_lp *lp, int row)
{
  return glp_get_row_stat(lp->problem, row + 1) == GLP_BS;
}

bool thr_lp_column_basic(const thr_lp *lp, int column)
{
  return glp_get_col_stat(lp->problem, column + 1) == GLP_BS;
}

typedef struct {
  glp_prob *problem;
  const bool *row, *column;
} basis_call;

/* Sets the status of rows and columns; what is not basic is at its lower bound. */
static void do_set_basis(void *argument)
{
  basis_call *call = argument;
  for (int i = 1; i <= glp_get_num_rows(call->problem); i++)
    glp_set_row_stat(call->problem, i, call->row[i - 1] ? GLP_BS : GLP_NL);
  for (int j = 1; j <= glp_get_num_cols(call->problem); j++)
    glp_set_col_stat(call->problem, j, call->column[j - 1] ? GLP_BS : GLP_NL);
}

thr_status thr_lp_set_basis(thr_lp *lp, const bool *row_basic, const bool *column_basic,
                            thr_err *err)
{
  thr_status st = check_alive(lp, err);
  basis_call call = {lp->problem, row_basic, column_basic};
  lp->primal = true;
  return st ? st : guarded(do_set_basis, &call, err);
}

int thr_lp_rows(const thr_lp *lp)
{
  return glp_get_num_rows(lp->problem);
}

typedef struct {
  glp_prob *problem;
  int column;
  double lower, upper;
} bounds_call;

static void do_set_bounds(void *argument)
{
  bounds_call *call = argument;
  /* GLPK tells one bound, two bounds and fixed columns apart. */
  int kind = isinf(call->upper) ? GLP_LO : call->lower < call->upper ? GLP_DB : GLP_FX;
  glp_set_col_bnds(call->problem, call->column + 1, kind, call->lower,
                   isinf(call->upper) ? 0 : call->upper);
}

thr_status thr_lp_set_bounds(thr_lp *lp, int column, double lower, double upper, thr_err *err)
{
  thr_status st = check_alive(lp, err);
  bounds_call call = {lp->problem, column, lower, upper};
  return st ? st : guarded(do_set_bounds, &call, err);
}

typedef struct {
  glp_prob *problem;
  const double *cost;
} cost_call;

static void do_set_costs(void *argument)
{
  cost_call *call = argument;
  for (int j = 1; j <= glp_get_num_cols(call->problem); j++)
    glp_set_obj_coef(call->problem, j, call->cost[j - 1]);
}

thr_status thr_lp_set_costs(thr_lp *lp, const double *cost, thr_err *err)
{
  thr_status st = check_alive(lp, err);
  cost_call call = {lp->problem, cost};
  return st ? st : guarded(do_set_costs, &call, err);
}

/* ---- solving ---- */

/* Pivots before the first look at the clock and the interrupt flag. Counted, not timed: where a
 * slice ends changes the path that the method takes, and the same input must give the same plan on
 * a slow machine as on a fast one. Every next slice is twice as long: where one ends GLPK takes
 * back the perturbed costs that lead it out of a degenerate corner. */
enum { SLICE = 500 };

typedef struct {
  glp_prob *problem;
  bool exact, primal;
  int slice;
  double left; /* seconds: a slice of a large problem may take longer than there is */
  int code;
} solve_call;

/* Runs one slice of the simplex method. */
static void do_solve(void *argument)
{
  solve_call *call = argument;
  glp_smcp options;
  glp_init_smcp(&options);
  options.msg_lev = GLP_MSG_OFF;

  /* After new rows the basis stays dual feasible. */
  options.meth = call->primal ? GLP_PRIMAL : GLP_DUALP;
  options.it_lim = call->slice;
  if (call->left < 1e6) options.tm_lim = 1 + (int)(1000 * call->left);

  /* The duals become certificates: GLPK's 1e-7 is too coarse to close them. */
  options.tol_dj = 1e-9;

  call->code =
      call->exact ? glp_exact(call->problem, &options) : glp_simplex(call->problem, &options);
}

static void do_reset_basis(void *argument)
{
  glp_std_basis(argument);
}

/* Returns what the last solve came to; undecided means stopped. */
static thr_lp_outcome outcome_of(glp_prob *problem)
{
  switch (glp_get_status(problem)) {
  case GLP_OPT: return THR_LP_OPTIMAL;
  case GLP_UNBND: return THR_LP_UNBOUNDED;
  case GLP_NOFEAS: return THR_LP_INFEASIBLE;
  default: return THR_LP_STOPPED;
  }
}

/* Subtracts pivots from the work that is left. A pivot of a small programme takes as long as 3000
 * rows and columns do, one of a dense programme longer. */
static void spend(const thr_limits *limits, glp_prob *problem, int pivots)
{
  enum { SMALL = 3000 };
  const double each = 1e-8, of_entry = 3e-10; /* s for a row or a column, and for what is not 0 */
  const double size = SMALL + glp_get_num_rows(problem) + glp_get_num_cols(problem),
               entries = glp_get_num_nz(problem);
  thr_limits_spend(limits, pivots * (each * size + of_entry * entries));
}

/* Solves the programme slice by slice, until GLPK decides or the limits stop it. After a failure
 * the standard basis gets one more try. */
static thr_status solve(thr_lp *lp, bool exact, const thr_limits *limits, thr_lp_outcome *outcome,
                        thr_err *err)
{
  *outcome = THR_LP_STOPPED;
  thr_status st = check_alive(lp, err);
  lp->integer = false;
  forget_exact(lp);

  for (int restarts = 0, slice = SLICE; !st; slice = slice < INT_MAX / 2 ? 2 * slice : slice) {
    if (thr_limits_stop(limits)) return THR_OK;

    /* One slice. */
    solve_call call = {lp->problem,
                       exact,
                       lp->primal || restarts > 0,
                       slice,
                       thr_limits_left(limits, INFINITY),
                       0};
    int before = glp_get_it_cnt(lp->problem);
    if ((st = guarded(do_solve, &call, err))) return st;

    /* Work is counted after the fact. */
    spend(limits, lp->problem, glp_get_it_cnt(lp->problem) - before);

    /* Decided, or just at the end of a slice. */
    if (call.code == 0 && outcome_of(lp->problem) != THR_LP_STOPPED) {
      *outcome = outcome_of(lp->problem);
      lp->primal = false;
      return THR_OK;
    }

    /* A slice that ended is continued. */
    if (call.code == GLP_EITLIM || call.code == GLP_ETMLIM) continue;

    if (restarts++)
      return thr_fail(err, THR_ESOLVER, "GLPK's simplex method failed (code %d)", call.code);

    /* A singular basis is refused, not repaired; and the dual method calls an unbounded problem
     * undecided. */
    st = guarded(do_reset_basis, lp->problem, err);
  }
  return st;
}

thr_status thr_lp_solve(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err)
{
  return solve(lp, false, limits, outcome, err);
}

thr_status thr_lp_solve_exact_here(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                   thr_err *err)
{
  return solve(lp, true, limits, outcome, err);
}

typedef struct {
  glp_prob *problem;
  const thr_limits *limits;
  int pivots; /* made when last looked at */
  int code;
} integer_call;

/* Subtracts the choice of a branch from the work that is left: GLPK computes a row of the tableau
 * for every fractional column, each of which takes all entries of the matrix. */
static void spend_on_branching(const thr_limits *limits, glp_prob *problem, glp_tree *tree)
{
  const double each = 3e-9; /* s for an entry */
  int fractional = 0;

  for (int j = 1; j <= glp_get_num_cols(problem); j++)
    fractional += glp_ios_can_branch(tree, j) != 0;

  thr_limits_spend(limits, each * fractional * glp_get_num_nz(problem));
}

/* Counts the work of branch and bound, and stops it by the limits. Called by GLPK at every step of
 * the tree, which counts as a pivot, too. */
static void watch_tree(glp_tree *tree, void *user)
{
  integer_call *call = user;

  int pivots = glp_get_it_cnt(call->problem);
  spend(call->limits, call->problem, 1 + pivots - call->pivots);
  call->pivots = pivots;

  if (glp_ios_reason(tree) == GLP_IBRANCH) spend_on_branching(call->limits, call->problem, tree);
  if (thr_limits_stop(call->limits)) glp_ios_terminate(tree);
}

/* Runs branch and bound with all columns integer. */
static void do_integer(void *argument)
{
  integer_call *call = argument;
  glp_iocp options;
  glp_init_iocp(&options);
  options.msg_lev = GLP_MSG_OFF;
  options.cb_func = watch_tree;
  options.cb_info = call;

  for (int j = 1; j <= glp_get_num_cols(call->problem); j++)
    glp_set_col_kind(call->problem, j, GLP_IV);

  call->code = glp_intopt(call->problem, &options);
}

/* Runs branch and bound in this process, from the optimum of the last solve. */
static thr_status solve_integer(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                thr_err *err)
{
  *outcome = THR_LP_STOPPED;
  thr_status st = check_alive(lp, err);
  forget_exact(lp);

  integer_call call = {lp->problem, limits, 0, 0};
  if (!st) call.pivots = glp_get_it_cnt(lp->problem);
  if (!st) st = guarded(do_integer, &call, err);

  /* Stopped by the limits: undecided, and no failure. */
  if (st || call.code == GLP_ESTOP) return st;
  if (call.code)
    return thr_fail(err, THR_ESOLVER, "GLPK's branch and bound failed (code %d)", call.code);

  lp->integer = true;
  *outcome = glp_mip_status(lp->problem) == GLP_OPT ? THR_LP_OPTIMAL : THR_LP_INFEASIBLE;
  return THR_OK;
}

/* ---- methods that cannot be stopped, in a child process ---- */

/* Numbers of a solution: outcome, objective, column values, row multipliers. */
enum { OUTCOME, OBJECTIVE, VALUES };

static size_t count_numbers(const thr_lp *lp)
{
  return VALUES + (size_t)glp_get_num_cols(lp->problem) + (size_t)glp_get_num_rows(lp->problem);
}

/* Appends the numbers of the solution, and a byte for each row and column with its place in the
 * basis. */
static thr_status put_solution(const thr_lp *lp, thr_lp_outcome outcome, thr_text *text,
                               thr_err *err)
{
  int n = glp_get_num_cols(lp->problem), m = glp_get_num_rows(lp->problem);
  double *number = thr_calloc(count_numbers(lp), sizeof *number);
  if (!number) return thr_nomem(err);

  /* Numbers in the order of the enum. */
  number[OUTCOME] = outcome;
  number[OBJECTIVE] = thr_lp_objective(lp);
  thr_lp_primal(lp, number + VALUES);
  thr_lp_dual(lp, number + VALUES + n);
  thr_text_append_bytes(text, (const char *)number, count_numbers(lp) * sizeof *number);
  free(number);

  /* The basis. */
  for (int i = 1; i <= m + n; i++) {
    const char stand =
        (char)(i <= m ? glp_get_row_stat(lp->problem, i) : glp_get_col_stat(lp->problem, i - m));
    thr_text_append_bytes(text, &stand, 1);
  }

  return text->failed ? thr_nomem(err) : THR_OK;
}

typedef struct {
  thr_lp *lp;
  thr_status (*solve)(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err);
} child_job;

/* Solves in the child process, and sends the solution to the parent. */
static thr_status solve_and_send(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const child_job *job = user;
  thr_lp_outcome outcome;
  thr_text text = {0};
  thr_status st = job->solve(job->lp, limits, &outcome, err);

  if (!st) st = put_solution(job->lp, outcome, &text, err);
  if (!st) st = thr_child_send(to, &text, err);

  thr_text_destroy(&text);
  return st;
}

typedef struct {
  glp_prob *problem;
  const char *stand; /* of rows, then of columns */
} stand_call;

/* Sets the basis that a child sent. */
static void do_stand(void *argument)
{
  const stand_call *call = argument;
  int m = glp_get_num_rows(call->problem);

  for (int i = 0; i < m; i++)
    glp_set_row_stat(call->problem, i + 1, call->stand[i]);
  for (int j = 0; j < glp_get_num_cols(call->problem); j++)
    glp_set_col_stat(call->problem, j + 1, call->stand[m + j]);
}

/* Takes over the solution and the basis that a child sent. */
static thr_status take_solution(thr_lp *lp, const thr_text *text, thr_lp_outcome *outcome,
                                thr_err *err)
{
  size_t n = count_numbers(lp);
  double *number = thr_calloc(n, sizeof *number);
  stand_call call = {lp->problem, text->data + n * sizeof *number};
  thr_status st = number ? guarded(do_stand, &call, err) : thr_nomem(err);

  /* Without a basis the solution is of no use. */
  if (st) {
    free(number);
    return st;
  }

  /* The numbers stay with the programme, as GLPK itself has none. */
  memcpy(number, text->data, n * sizeof *number);
  *outcome = (thr_lp_outcome)(int)number[OUTCOME];

  lp->integer = false;
  if (*outcome == THR_LP_OPTIMAL) lp->primal = false;
  forget_exact(lp);
  lp->exact = number;
  return THR_OK;
}

/* Solves in a child process; a child that the limits stopped is no failure. */
static thr_status solve_in_child(child_job job, const char *what, const thr_limits *limits,
                                 thr_lp_outcome *outcome, thr_err *err)
{
  const thr_child child = {.what = what, .run = solve_and_send, .user = &job};
  thr_lp *lp = job.lp;
  thr_err failure = {0};
  thr_text answer = {0};
  *outcome = THR_LP_STOPPED;

  thr_status st = check_alive(lp, err);
  if (st || thr_limits_stop(limits)) return st;

  st = thr_child_run(&child, limits, &answer, &failure);
  if (!st)
    st = take_solution(lp, &answer, outcome, err);
  else if (st == THR_ELIMIT)
    st = THR_OK;
  else
    thr_fail(err, st, "%s", failure.text);

  thr_text_destroy(&answer);
  return st;
}

thr_status thr_lp_solve_exact(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                              thr_err *err)
{
  return solve_in_child((child_job){lp, thr_lp_solve_exact_here}, "GLPK's exact method", limits,
                        outcome, err);
}

/* Runs branch and bound in a child if there are limits to keep, as GLPK solves the programmes at
 * the tree's nodes without a limit, and they may cycle. */
thr_status thr_lp_solve_integer(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                thr_err *err)
{
  if (limits->deadline == 0 && !limits->interrupted) return solve_integer(lp, limits, outcome, err);
  return solve_in_child((child_job){lp, solve_integer}, "GLPK's branch and bound", limits, outcome,
                        err);
}

void thr_lp_primal(const thr_lp *lp, double *x)
{
  int n = glp_get_num_cols(lp->problem);
  if (lp->exact) memcpy(x, lp->exact + VALUES, (size_t)n * sizeof *x);
  for (int j = 1; j <= n && !lp->exact; j++)
    x[j - 1] = lp->integer ? glp_mip_col_val(lp->problem, j) : glp_get_col_prim(lp->problem, j);
}

void thr_lp_dual(const thr_lp *lp, double *dual)
{
  int m = glp_get_num_rows(lp->problem);
  if (lp->exact)
    memcpy(dual, lp->exact + VALUES + glp_get_num_cols(lp->problem), (size_t)m * sizeof *dual);
  for (int i = 1; i <= m && !lp->exact; i++)
    dual[i - 1] = glp_get_row_dual(lp->problem, i);
}

double thr_lp_objective(const thr_lp *lp)
{
  if (lp->exact) return lp->exact[OBJECTIVE];
  return lp->integer ? glp_mip_obj_val(lp->problem) : glp_get_obj_val(lp->problem);
}

const char *thr_glpk_version(void)
{
  return glp_version();
}
