/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The only file that knows GLPK. GLPK aborts on misuse and when memory runs out: every call runs
 * under guarded(), whose error hook jumps out. After that GLPK's environment must be freed, which
 * kills every problem of the process; each thr_lp remembers in which generation of the environment
 * it was born. */
#define _POSIX_C_SOURCE 200809L
#include "graph/process/process.h"
#include "graph/text.h"
#include "lp/solver/lp.h"

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

static int keep_text(void *unused, const char *text)
{
  (void)unused;
  size_t n = strcspn(text, "\n");
  if (n > 0) {
    if (n >= sizeof message) n = sizeof message - 1;
    memcpy(message, text, n);
    message[n] = '\0';
  }
  return 1; /* printed nothing, and GLPK must not either */
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

static void make_key(void)
{
  has_key = pthread_key_create(&thread_end, free_environment) == 0;
}

static void free_with_the_thread(void)
{
  static const bool used = true;
  pthread_once(&once, make_key);
  if (has_key && !pthread_getspecific(thread_end))
    pthread_setspecific(thread_end, &used); /* without memory for it, it is kept */
}

/* Runs call(argument) with GLPK's aborts turned into THR_ESOLVER. The hooks are set anew each time
 * because igraph, which shares the library, may have set its own. */
static thr_status guarded(void (*call)(void *), void *argument, thr_err *err)
{
  message[0] = '\0';
  free_with_the_thread();
  glp_term_out(GLP_ON); /* through keep_text: an abort's reason passes here */
  glp_term_hook(keep_text, NULL);
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
  thr_lp *lp;
  int n;
  const double *cost, *upper;
} create_call;

static void do_create(void *argument)
{
  create_call *c = argument;
  glp_prob *p = c->lp->problem = glp_create_prob();
  glp_set_obj_dir(p, GLP_MIN);
  if (c->n > 0) glp_add_cols(p, c->n);
  for (int j = 0; j < c->n; j++) {
    glp_set_obj_coef(p, j + 1, c->cost[j]);
    if (c->upper)
      glp_set_col_bnds(p, j + 1, c->upper[j] > 0 ? GLP_DB : GLP_FX, 0, c->upper[j]);
    else
      glp_set_col_bnds(p, j + 1, GLP_LO, 0, 0);
  }
  glp_std_basis(p);
}

thr_status thr_lp_create(thr_lp **lp, int n_columns, const double *cost, const double *upper,
                         thr_err *err)
{
  *lp = NULL;
  thr_lp *made = thr_calloc(1, sizeof *made);
  if (!made) return thr_nomem(err);
  made->generation = generation;
  create_call c = {made, n_columns, cost, upper};
  thr_status st = guarded(do_create, &c, err);
  if (st) {
    free(made);
    return st;
  }
  *lp = made;
  return THR_OK;
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
  thr_lp *lp;
  glp_prob *from;
} copy_call;

static void do_copy(void *argument)
{
  copy_call *c = argument;
  c->lp->problem = glp_create_prob();
  glp_copy_prob(c->lp->problem, c->from, GLP_OFF);
}

thr_status thr_lp_copy(thr_lp **lp, const thr_lp *from, thr_err *err)
{
  *lp = NULL;
  thr_lp *made = thr_calloc(1, sizeof *made);
  if (!made) return thr_nomem(err);
  made->generation = generation;
  made->primal = from->primal;
  copy_call c = {made, from->problem};
  thr_status st = guarded(do_copy, &c, err);
  if (st) {
    free(made);
    return st;
  }
  *lp = made;
  return THR_OK;
}

typedef struct {
  thr_lp *lp;
  int n_rows, n_columns;
  const double *rhs, *cost, *value;
  const bool *free;
  const int *start, *row;
  int *index;    /* of one column, 1-based */
  double *entry; /* of one column, 1-based */
} equations_call;

static void do_create_equations(void *argument)
{
  equations_call *c = argument;
  glp_prob *p = c->lp->problem = glp_create_prob();
  glp_set_obj_dir(p, GLP_MIN);
  if (c->n_rows > 0) glp_add_rows(p, c->n_rows);
  if (c->n_columns > 0) glp_add_cols(p, c->n_columns);
  for (int i = 0; i < c->n_rows; i++)
    glp_set_row_bnds(p, i + 1, GLP_FX, c->rhs[i], c->rhs[i]);
  for (int j = 0; j < c->n_columns; j++) {
    int n = c->start[j + 1] - c->start[j];
    for (int k = 0; k < n; k++) {
      c->index[k + 1] = c->row[c->start[j] + k] + 1;
      c->entry[k + 1] = c->value[c->start[j] + k];
    }
    glp_set_obj_coef(p, j + 1, c->cost[j]);
    glp_set_col_bnds(p, j + 1, c->free && c->free[j] ? GLP_FR : GLP_LO, 0, 0);
    glp_set_mat_col(p, j + 1, n, c->index, c->entry);
  }
  glp_std_basis(p);
}

thr_status thr_lp_create_equations(thr_lp **lp, int n_rows, const double *rhs, int n_columns,
                                   const double *cost, const bool *free_columns, const int *start,
                                   const int *row, const double *value, thr_err *err)
{
  *lp = NULL;
  thr_lp *made = thr_calloc(1, sizeof *made);
  equations_call c = {made,         n_rows, n_columns, rhs,  cost, value,
                      free_columns, start,  row,       NULL, NULL};
  int longest = 0;
  for (int j = 0; j < n_columns; j++)
    if (start[j + 1] - start[j] > longest) longest = start[j + 1] - start[j];
  c.index = thr_calloc((size_t)longest + 1, sizeof *c.index);
  c.entry = thr_calloc((size_t)longest + 1, sizeof *c.entry);
  thr_status st = made && c.index && c.entry ? THR_OK : thr_nomem(err);
  if (!st) {
    made->generation = generation;
    st = guarded(do_create_equations, &c, err);
  }
  free(c.index);
  free(c.entry);
  if (st) {
    free(made);
    return st;
  }
  *lp = made;
  return THR_OK;
}

typedef struct {
  glp_prob *problem;
  int n, *index; /* both arrays are 1-based, as GLPK wants them */
  double *value, lower;
} row_call;

static void do_add_row(void *argument)
{
  row_call *c = argument;
  int row = glp_add_rows(c->problem, 1);
  glp_set_row_bnds(c->problem, row, GLP_LO, c->lower, 0);
  glp_set_mat_row(c->problem, row, c->n, c->index, c->value);
}

thr_status thr_lp_add_row(thr_lp *lp, int n, const int *column, const double *value, double lower,
                          thr_err *err)
{
  thr_status st = check_alive(lp, err);
  forget_exact(lp);
  if (st) return st;
  row_call c = {lp->problem, n, thr_calloc((size_t)n + 1, sizeof(int)),
                thr_calloc((size_t)n + 1, sizeof(double)), lower};
  if (!c.index || !c.value) {
    st = thr_nomem(err);
    goto done;
  }
  for (int i = 0; i < n; i++) {
    c.index[i + 1] = column[i] + 1;
    c.value[i + 1] = value ? value[i] : 1;
  }
  st = guarded(do_add_row, &c, err);
done:
  free(c.index);
  free(c.value);
  return st;
}

typedef struct {
  glp_prob *problem;
  int n, *row;
} drop_call;

static void do_drop(void *argument)
{
  drop_call *c = argument;
  glp_del_rows(c->problem, c->n, c->row);
}

thr_status thr_lp_drop_rows(thr_lp *lp, const bool *drop, thr_err *err)
{
  thr_status st = check_alive(lp, err);
  forget_exact(lp);
  if (st) return st;
  int n = glp_get_num_rows(lp->problem);
  drop_call c = {lp->problem, 0, thr_calloc((size_t)n + 1, sizeof(int))};
  if (!c.row) return thr_nomem(err);
  for (int i = 0; i < n; i++)
    if (drop[i]) c.row[++c.n] = i + 1;
  if (c.n > 0) st = guarded(do_drop, &c, err);
  free(c.row);
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

static void do_set_basis(void *argument)
{
  basis_call *c = argument;
  for (int i = 1; i <= glp_get_num_rows(c->problem); i++)
    glp_set_row_stat(c->problem, i, c->row[i - 1] ? GLP_BS : GLP_NL);
  for (int j = 1; j <= glp_get_num_cols(c->problem); j++)
    glp_set_col_stat(c->problem, j, c->column[j - 1] ? GLP_BS : GLP_NL);
}

thr_status thr_lp_set_basis(thr_lp *lp, const bool *row_basic, const bool *column_basic,
                            thr_err *err)
{
  thr_status st = check_alive(lp, err);
  basis_call c = {lp->problem, row_basic, column_basic};
  lp->primal = true;
  return st ? st : guarded(do_set_basis, &c, err);
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
  bounds_call *c = argument;
  int kind = isinf(c->upper) ? GLP_LO : c->lower < c->upper ? GLP_DB : GLP_FX;
  glp_set_col_bnds(c->problem, c->column + 1, kind, c->lower, isinf(c->upper) ? 0 : c->upper);
}

thr_status thr_lp_set_bounds(thr_lp *lp, int column, double lower, double upper, thr_err *err)
{
  thr_status st = check_alive(lp, err);
  bounds_call c = {lp->problem, column, lower, upper};
  return st ? st : guarded(do_set_bounds, &c, err);
}

typedef struct {
  glp_prob *problem;
  const double *cost;
} cost_call;

static void do_set_costs(void *argument)
{
  cost_call *c = argument;
  for (int j = 1; j <= glp_get_num_cols(c->problem); j++)
    glp_set_obj_coef(c->problem, j, c->cost[j - 1]);
}

thr_status thr_lp_set_costs(thr_lp *lp, const double *cost, thr_err *err)
{
  thr_status st = check_alive(lp, err);
  cost_call c = {lp->problem, cost};
  return st ? st : guarded(do_set_costs, &c, err);
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

static void do_solve(void *argument)
{
  solve_call *c = argument;
  glp_smcp options;
  glp_init_smcp(&options);
  options.msg_lev = GLP_MSG_OFF;
  options.meth =
      c->primal ? GLP_PRIMAL : GLP_DUALP; /* after new rows the basis stays dual feasible */
  options.it_lim = c->slice;
  if (c->left < 1e6) options.tm_lim = 1 + (int)(1000 * c->left);
  options.tol_dj =
      1e-9; /* the duals become certificates: GLPK's 1e-7 is too coarse to close them */
  c->code = c->exact ? glp_exact(c->problem, &options) : glp_simplex(c->problem, &options);
}

static void do_reset_basis(void *argument)
{
  glp_std_basis(argument);
}

static thr_lp_outcome outcome_of(glp_prob *problem)
{
  switch (glp_get_status(problem)) {
  case GLP_OPT: return THR_LP_OPTIMAL;
  case GLP_UNBND: return THR_LP_UNBOUNDED;
  case GLP_NOFEAS: return THR_LP_INFEASIBLE;
  default: return THR_LP_STOPPED;
  }
}

/* Takes pivots from the work that is left: of a small programme one takes as long as 3000 rows and
 * columns do, of a dense one longer. */
static void spend(const thr_limits *limits, glp_prob *p, int pivots)
{
  enum { SMALL = 3000 };
  const double each = 1e-8, of_entry = 3e-10; /* s for a row or a column, and for what is not 0 */
  const double size = SMALL + glp_get_num_rows(p) + glp_get_num_cols(p),
               entries = glp_get_num_nz(p);
  thr_limits_spend(limits, pivots * (each * size + of_entry * entries));
}

static thr_status solve(thr_lp *lp, bool exact, const thr_limits *limits, thr_lp_outcome *outcome,
                        thr_err *err)
{
  *outcome = THR_LP_STOPPED;
  thr_status st = check_alive(lp, err);
  lp->integer = false;
  forget_exact(lp);
  for (int restarts = 0, slice = SLICE; !st; slice = slice < INT_MAX / 2 ? 2 * slice : slice) {
    if (thr_limits_stop(limits)) return THR_OK;
    solve_call c = {lp->problem,
                    exact,
                    lp->primal || restarts > 0,
                    slice,
                    thr_limits_left(limits, INFINITY),
                    0};
    int before = glp_get_it_cnt(lp->problem);
    if ((st = guarded(do_solve, &c, err))) return st;
    spend(limits, lp->problem, glp_get_it_cnt(lp->problem) - before);
    if (c.code == 0 && outcome_of(lp->problem) != THR_LP_STOPPED) {
      *outcome = outcome_of(lp->problem);
      lp->primal = false;
      return THR_OK;
    }
    if (c.code == GLP_EITLIM || c.code == GLP_ETMLIM) continue;
    if (restarts++)
      return thr_fail(err, THR_ESOLVER, "GLPK's simplex method failed (code %d)", c.code);
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

/* Where to branch is found by a row of the tableau for every fractional column, each of which takes
 * all entries of the matrix. */
static void spend_on_branching(const thr_limits *limits, glp_prob *p, glp_tree *tree)
{
  const double each = 3e-9; /* s for an entry */
  int fractional = 0;
  for (int j = 1; j <= glp_get_num_cols(p); j++)
    fractional += glp_ios_can_branch(tree, j) != 0;
  thr_limits_spend(limits, each * fractional * glp_get_num_nz(p));
}

/* At every step of the tree, which counts as a pivot too. */
static void watch_tree(glp_tree *tree, void *call)
{
  integer_call *c = call;
  int pivots = glp_get_it_cnt(c->problem);
  spend(c->limits, c->problem, 1 + pivots - c->pivots);
  c->pivots = pivots;
  if (glp_ios_reason(tree) == GLP_IBRANCH) spend_on_branching(c->limits, c->problem, tree);
  if (thr_limits_stop(c->limits)) glp_ios_terminate(tree);
}

static void do_integer(void *argument)
{
  integer_call *c = argument;
  glp_iocp options;
  glp_init_iocp(&options);
  options.msg_lev = GLP_MSG_OFF;
  options.cb_func = watch_tree;
  options.cb_info = c;
  for (int j = 1; j <= glp_get_num_cols(c->problem); j++)
    glp_set_col_kind(c->problem, j, GLP_IV);
  c->code = glp_intopt(c->problem, &options);
}

static thr_status solve_integer(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                thr_err *err)
{
  *outcome = THR_LP_STOPPED;
  thr_status st = check_alive(lp, err);
  forget_exact(lp);
  integer_call c = {lp->problem, limits, 0, 0};
  if (!st) c.pivots = glp_get_it_cnt(lp->problem);
  if (!st) st = guarded(do_integer, &c, err);
  if (st || c.code == GLP_ESTOP) return st;
  if (c.code) return thr_fail(err, THR_ESOLVER, "GLPK's branch and bound failed (code %d)", c.code);
  lp->integer = true;
  *outcome = glp_mip_status(lp->problem) == GLP_OPT ? THR_LP_OPTIMAL : THR_LP_INFEASIBLE;
  return THR_OK;
}

/* ---- methods that take no heed of time, in a child ---- */

/* Numbers of a solution: outcome, objective, column values, row multipliers. */
enum { OUTCOME, OBJECTIVE, VALUES };

static size_t count_numbers(const thr_lp *lp)
{
  return VALUES + (size_t)glp_get_num_cols(lp->problem) + (size_t)glp_get_num_rows(lp->problem);
}

/* They, and a byte for each row and column that says where it stands in the basis. */
static thr_status put_solution(const thr_lp *lp, thr_lp_outcome outcome, thr_text *text,
                               thr_err *err)
{
  int n = glp_get_num_cols(lp->problem), m = glp_get_num_rows(lp->problem);
  double *number = thr_calloc(count_numbers(lp), sizeof *number);
  if (!number) return thr_nomem(err);
  number[OUTCOME] = outcome;
  number[OBJECTIVE] = thr_lp_objective(lp);
  thr_lp_primal(lp, number + VALUES);
  thr_lp_dual(lp, number + VALUES + n);
  thr_text_append_bytes(text, (const char *)number, count_numbers(lp) * sizeof *number);
  free(number);
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

static void do_stand(void *argument)
{
  const stand_call *c = argument;
  int m = glp_get_num_rows(c->problem);
  for (int i = 0; i < m; i++)
    glp_set_row_stat(c->problem, i + 1, c->stand[i]);
  for (int j = 0; j < glp_get_num_cols(c->problem); j++)
    glp_set_col_stat(c->problem, j + 1, c->stand[m + j]);
}

static thr_status take_solution(thr_lp *lp, const thr_text *text, thr_lp_outcome *outcome,
                                thr_err *err)
{
  size_t n = count_numbers(lp);
  double *number = thr_calloc(n, sizeof *number);
  stand_call c = {lp->problem, text->data + n * sizeof *number};
  thr_status st = number ? guarded(do_stand, &c, err) : thr_nomem(err);
  if (st) {
    free(number);
    return st;
  }
  memcpy(number, text->data, n * sizeof *number);
  *outcome = (thr_lp_outcome)(int)number[OUTCOME];
  lp->integer = false;
  if (*outcome == THR_LP_OPTIMAL) lp->primal = false;
  forget_exact(lp);
  lp->exact = number;
  return THR_OK;
}

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

/* The programmes at the tree's nodes are solved without a limit, and may go round in circles. Where
 * nobody sets limits, there is nothing to end. */
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

/* Multiplier of row i, 0 if the row's bound would not carry it; *bound: the bound that it does. */
static double carried(glp_prob *p, int i, double *bound)
{
  double dual = glp_get_row_dual(p, i);
  int kind = glp_get_row_type(p, i); /* rows here: equations and lower bounds */
  *bound = glp_get_row_lb(p, i);
  return kind == GLP_FX || (kind == GLP_LO && dual > 0) ? dual : 0;
}

thr_status thr_lp_proved(const thr_lp *lp, double most, double *bound, thr_err *err)
{
  glp_prob *p = lp->problem;
  int n = glp_get_num_cols(p), *index = thr_calloc((size_t)n + 1, sizeof *index);
  double *value = thr_calloc((size_t)n + 1, sizeof *value),
         *reduced = thr_calloc((size_t)n + 1, sizeof *reduced), sum = 0;
  thr_status st = index && value && reduced ? THR_OK : thr_nomem(err);
  for (int j = 1; j <= n && !st; j++)
    reduced[j] = glp_get_obj_coef(p, j);
  for (int i = 1; i <= glp_get_num_rows(p) && !st; i++) {
    double lower, dual = carried(p, i, &lower);
    int entries = dual != 0 ? glp_get_mat_row(p, i, index, value) : 0;
    if (dual != 0) sum += dual * lower;
    for (int k = 1; k <= entries; k++)
      reduced[index[k]] -= dual * value[k];
  }
  for (int j = 1; j <= n && !st; j++) {
    int kind = glp_get_col_type(p, j); /* columns: lower bounds, some with upper ones or fixed */
    double upper = kind == GLP_LO   ? most
                   : kind == GLP_FX ? glp_get_col_lb(p, j)
                                    : glp_get_col_ub(p, j);
    sum += reduced[j] * (reduced[j] > 0 ? glp_get_col_lb(p, j) : upper);
  }
  if (!st) *bound = sum;
  free(index);
  free(value);
  free(reduced);
  return st;
}

const char *thr_glpk_version(void)
{
  return glp_version();
}
