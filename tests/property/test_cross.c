/* The whole program on small frameworks, every pair of options crossed, against exhaustive search over walks (tests/walks.h).
 *
 *     THREAD_CROSS_CASES=20000 THREAD_CROSS_SEED=7 CK_FORK=no build/release/tests/property/test_cross
 *
 * runs longer and prints how often each two options met; THREAD_CROSS_ONLY="tube symmetry" keeps to these values,
 * THREAD_CROSS_EDGES and THREAD_CROSS_STATES allow larger pieces. A finding is printed with the framework and the command that
 * shows it. */
#define _POSIX_C_SOURCE 200809L

#include "tests/crossing.h"
#include "tests/walks.h"
#include "tests/frameworks.h"
#include "graph/plan/plan.h"
#include "tests/plans.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PIECES = 3, MOST_CORDS = 10, OUTPUT = 4000 };

/* ---- running the program ---- */

static const char *self; /* as it was called */
static char program[512], folder[64];

/* It is two folders above the tests. */
static void find_program(void)
{
  const char *end = strstr(self, "tests/property/");
  ck_assert_ptr_nonnull(end);
  snprintf(program, sizeof program, "%.*sthread", (int)(end - self), self);
  ck_assert_msg(access(program, X_OK) == 0, "%s is not built", program);
}

static void read_back(const char *path, char *text)
{
  FILE *in = fopen(path, "r");
  size_t n = in ? fread(text, 1, OUTPUT - 1, in) : 0;
  text[n] = '\0';
  if (in) fclose(in);
}

/* Exit code (128 + signal) of the program run with these words by a shell; what it said on standard error. */
static int run(char *said, const char *format, ...) __attribute__((format(printf, 2, 3)));
static int run(char *said, const char *format, ...)
{
  char words[3000], command[4000], errors[128];
  va_list list;
  va_start(list, format);
  vsnprintf(words, sizeof words, format, list);
  va_end(list);
  snprintf(errors, sizeof errors, "%s/errors", folder);
  snprintf(command, sizeof command, "ulimit -t 60; exec %s %s >%s/output 2>%s", program, words, folder, errors);
  int status = system(command);
  read_back(errors, said);
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/* ---- what is found ---- */

typedef struct {
  crossing_case c;
  int n_pieces, code;
  thr_plan plan;
  bool written, whole; /* enough different cords pass every edge */
  char said[OUTPUT];
  int findings;
} judged;

typedef struct {
  long cases, planned, none, open, unsure, missed, findings;
} counts;

/* Prints a finding once per case, with all it takes to see it again. */
static void finding(judged *j, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void finding(judged *j, const char *format, ...)
{
  char text[1000], frame[OUTPUT];
  va_list list;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  printf("FINDING %s\n", text);
  if (j->findings++ == 0) {
    read_back(j->c.frame_path, frame);
    printf("  cat >frame.json <<'END'\n%sEND\n  thread plan frame.json%s -o plan.json   # exit %d\n%s%s", frame, j->c.arguments,
           j->code, *j->said ? "  " : "", j->said);
  }
  fflush(stdout);
}

/* ---- is it a threading? ---- */

static int root(int *up, int i)
{
  while (up[i] != i)
    i = up[i];
  return i;
}

static bool turns_back(const thr_cord *c, int k)
{
  return c->half[k] == (c->half[(k + 1) % c->n_passes] ^ 1);
}

/* Turns that count: a closed cord's last one does with ends closed. */
static int turns_of(const thr_plan *p, const thr_cord *c)
{
  return p->options.ends == THR_ENDS_CLOSED ? c->n_passes : c->n_passes - 1;
}

static void judge_walk(judged *j, const thr_cord *c, int *passes, int *ends)
{
  const thr_frame *f = &j->c.f;
  int start = thr_tail(f, c->half[0]), end = thr_head(f, c->half[c->n_passes - 1]);
  double length = 0;
  for (int k = 0; k < c->n_passes; k++) {
    passes[c->half[k] >> 1]++;
    length += f->length[c->half[k] >> 1];
    if (k && thr_head(f, c->half[k - 1]) != thr_tail(f, c->half[k])) finding(j, "cord %s is broken at pass %d", c->id, k);
  }
  ends[start]++;
  ends[end]++;
  if (c->closed != (start == end)) finding(j, "cord %s is not what it is said to be", c->id);
  if (j->c.o.ends == THR_ENDS_CLOSED && start != end) finding(j, "cord %s is open", c->id);
  if (!walks_may_end(f, &j->c.o, start) || !walks_may_end(f, &j->c.o, end)) finding(j, "cord %s ends where it may not", c->id);
  if (j->c.o.max_length > 0 && length > j->c.o.max_length * (1 + 2e-9)) finding(j, "cord %s is %.12g long", c->id, length);
}

static void judge_ties(judged *j, const thr_plan *p)
{
  const thr_frame *f = &j->c.f;
  int up[128];
  for (int h = 0; h < 2 * f->n_edges; h++)
    up[h] = h;
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < turns_of(p, &p->cord[i]); k++) {
      int in = p->cord[i].half[k] ^ 1, out = p->cord[i].half[(k + 1) % p->cord[i].n_passes];
      if (turns_back(&p->cord[i], k)) finding(j, "cord %s turns back after pass %d", p->cord[i].id, k + 1);
      up[root(up, in)] = root(up, out);
    }
  for (int a = 0; a < 2 * f->n_edges; a++)
    for (int b = 0; b < a; b++)
      if (thr_tail(f, a) == thr_tail(f, b) && root(up, a) != root(up, b)) finding(j, "node %d is not tied", thr_tail(f, a));
}

/* Do so many different cords pass every edge? Else that is said. */
static void judge_different(judged *j, const thr_plan *p)
{
  int asked = j->c.o.distinct, n = 0;
  for (int e = 0; e < j->c.f.n_edges; e++) {
    int cords = 0;
    for (int i = 0; i < p->n_cords; i++) {
      bool here = false;
      for (int k = 0; k < p->cord[i].n_passes; k++)
        here = here || p->cord[i].half[k] >> 1 == e;
      cords += here;
    }
    n += cords >= asked;
  }
  j->whole = n == j->c.f.n_edges;
  if (asked > 0 && p->metrics.distinct != n) finding(j, "%d edges have their cords, but %d are said to", n, p->metrics.distinct);
  if (!j->whole && (j->code != 5 || !strstr(j->said, "no better cords were found"))) finding(j, "edges lack different cords");
}

static void judge_threading(judged *j, const thr_plan *p)
{
  judge_different(j, p);
  const thr_frame *f = &j->c.f;
  const thr_request *o = &j->c.o;
  int passes[64] = {0}, ends[64] = {0}, cords[PIECES] = {0};
  for (int i = 0; i < p->n_cords; i++) {
    judge_walk(j, &p->cord[i], passes, ends);
    cords[p->cord[i].component]++;
  }
  for (int e = 0; e < f->n_edges; e++)
    if (passes[e] < walks_cover(f, o, e) || passes[e] > walks_capacity(f, o, e)) finding(j, "edge %d: %d passes", e, passes[e]);
  for (int v = 0; v < f->n_nodes && o->ends == THR_ENDS_COUNTS; v++)
    if (ends[v] != o->end_count[v]) finding(j, "node %d has %d ends", v, ends[v]);
  for (int k = 0; k < j->n_pieces && thr_plan_counted(o); k++)
    if (cords[k] < o->cords_least || cords[k] > o->cords) finding(j, "piece %d has %d cords", k, cords[k]);
  if (o->joint == THR_JOINT_TUBE) judge_ties(j, p);
}

/* ---- the least of all threadings ---- */

static long most_states = 8000;

/* What a number of cords can do in one piece: least[k] for k cords, reached with so many at most. */
typedef struct {
  double least[MOST_CORDS + 1];
  int n; /* last k; no more cords reach another state, or enough */
  bool known;
} piece_least;

/* limit: see walks_one_more. Up to most cords. */
static piece_least piece_find(const judged *j, int k, walks_back back, walks_weights weights, double limit, int most)
{
  piece_least found = {.known = false};
  walks_piece w;
  if (!walks_piece_init(&w, &j->c.f, &j->c.o, k, back, j->c.o.turning.cost, INFINITY, most_states)) return found;
  double *in = calloc((size_t)w.n_states, sizeof *in), *out = calloc((size_t)w.n_states, sizeof *out);
  ck_assert(in != NULL && out != NULL);
  walks_begin(&w, in);
  found.known = true;
  found.least[0] = INFINITY;
  for (int i = 1; i <= most && i <= MOST_CORDS; i++) {
    double *swap = in;
    walks_one_more(&w, weights, limit, in, out);
    in = out;
    out = swap;
    found.least[i] = walks_least(&w, in);
    found.n = i;
  }
  free(in);
  free(out);
  return found;
}

static const double rounding = 1e-13; /* of a cord's length */
static const walks_weights by_length = {1, 0}, by_turn = {0, 1};

/* Cords of piece k, least and most, as the options say for this objective; with ends counted all of them are used. */
static void cords_of(const judged *j, int k, int *least, int *most)
{
  const thr_request *o = &j->c.o;
  int n, component[64], sum = 0;
  *least = thr_plan_cords_least(o);
  *most = !thr_plan_counted(o) || o->cords > MOST_CORDS ? MOST_CORDS : o->cords;
  if (o->ends != THR_ENDS_COUNTS) return;
  ck_assert_int_eq(thr_frame_components(&j->c.f, component, &n, NULL), THR_OK);
  for (int v = 0; v < j->c.f.n_nodes; v++)
    sum += component[v] == k ? o->end_count[v] : 0;
  *least = *most = sum / 2;
}

static double least_between(const piece_least *l, int least, int most)
{
  double best = INFINITY;
  for (int k = least; k <= most && k <= l->n; k++)
    best = fmin(best, l->least[k]);
  return best;
}

/* Least weight of all pieces together; NAN if a piece is too large for the oracle. */
static double least_of(const judged *j, walks_back back, walks_weights weights, double limit)
{
  double sum = 0;
  for (int k = 0; k < j->n_pieces && sum < INFINITY; k++) {
    int least, most;
    cords_of(j, k, &least, &most);
    piece_least l = piece_find(j, k, back, weights, limit, most);
    if (!l.known) return NAN;
    sum += least_between(&l, least, most);
  }
  return sum;
}

/* Fewest cords of all pieces together that are no longer than the limit; INFINITY: none, NAN: not known. */
static double fewest_of(const judged *j, double limit)
{
  double sum = 0;
  for (int k = 0; k < j->n_pieces; k++) {
    int least, most, i;
    cords_of(j, k, &least, &most);
    piece_least l = piece_find(j, k, BACK_ANYWHERE, by_length, limit, most);
    if (!l.known) return NAN;
    for (i = least; i <= most && l.least[i] == INFINITY;)
      i++;
    sum += i > most ? INFINITY : (double)i;
  }
  return sum;
}

/* ---- least turning of plans no longer than a limit ---- */

/* Least price of a piece by its length, ascending lengths, descending prices. */
enum { FRONT = 4000 };
typedef struct {
  int n;
  double length[FRONT], price[FRONT];
} front;

static int by_first(const void *a, const void *b)
{
  const double *x = a, *y = b;
  return x[0] != y[0] ? (x[0] > y[0]) - (x[0] < y[0]) : (x[1] > y[1]) - (x[1] < y[1]);
}

static void front_sort(front *f, double (*pair)[2], int n)
{
  qsort(pair, (size_t)n, sizeof *pair, by_first);
  f->n = 0;
  for (int i = 0; i < n; i++) {
    if (f->n && pair[i][1] >= f->price[f->n - 1]) continue;
    ck_assert_int_lt(f->n, FRONT);
    f->length[f->n] = pair[i][0];
    f->price[f->n++] = pair[i][1];
  }
}

/* limit_turn: of each cord, see walks_one_more. False: too large. */
static bool piece_front(const judged *j, int k, double longest, double limit_turn, front *f)
{
  walks_piece w;
  int least, most, n = 0;
  cords_of(j, k, &least, &most);
  if (!walks_piece_init(&w, &j->c.f, &j->c.o, k, BACK_AT_LEAVES, j->c.o.turning.cost, longest, most_states)) return false;
  double *in = calloc((size_t)w.n_states, sizeof *in), *out = calloc((size_t)w.n_states, sizeof *out);
  double(*pair)[2] = calloc((size_t)w.n_states * (size_t)(most - least + 1), sizeof *pair);
  ck_assert(in != NULL && out != NULL && pair != NULL);
  walks_begin(&w, in);
  for (int i = 1; i <= most; i++) {
    double *swap = in;
    walks_one_more(&w, by_turn, limit_turn, in, out);
    in = out;
    out = swap;
    for (long s = 0; s < w.n_states && i >= least; s++)
      if (in[s] < INFINITY && walks_complete(&w, s)) pair[n][0] = walks_length(&w, s), pair[n++][1] = in[s];
  }
  front_sort(f, pair, n);
  free(in);
  free(out);
  free(pair);
  return true;
}

/* Sums of both, no longer than longest. */
static void front_add(front *sum, const front *more, double longest)
{
  int n = 0;
  double(*pair)[2] = calloc((size_t)(sum->n * more->n + 1), sizeof *pair);
  ck_assert_ptr_nonnull(pair);
  for (int a = 0; a < sum->n; a++)
    for (int b = 0; b < more->n; b++)
      if (sum->length[a] + more->length[b] <= longest) {
        pair[n][0] = sum->length[a] + more->length[b];
        pair[n++][1] = sum->price[a] + more->price[b];
      }
  front_sort(sum, pair, n);
  free(pair);
}

/* Least turning of plans no longer than longest; NAN: not known, INFINITY: there is none. */
static double least_turning(const judged *j, double longest, double limit_turn)
{
  static front sum, more;
  const thr_frame *f = &j->c.f;
  double base = 0, own[PIECES] = {0};
  int n, component[64];
  if (!isfinite(longest)) return least_of(j, BACK_AT_LEAVES, by_turn, limit_turn);
  ck_assert_int_eq(thr_frame_components(f, component, &n, NULL), THR_OK);
  for (int e = 0; e < f->n_edges; e++) {
    base += walks_cover(f, &j->c.o, e) * f->length[e];
    own[component[f->edge[e][0]]] += walks_cover(f, &j->c.o, e) * f->length[e];
  }
  sum.n = 1;
  sum.length[0] = sum.price[0] = 0;
  for (int k = 0; k < j->n_pieces; k++) {
    if (!piece_front(j, k, longest - (base - own[k]), limit_turn, &more)) return NAN;
    front_add(&sum, &more, longest);
  }
  return sum.n ? sum.price[sum.n - 1] : INFINITY;
}

/* ---- claims ---- */

static double price_of_cord(const judged *j, const thr_plan *p, const thr_cord *c)
{
  double price = 0;
  for (int k = 0; k < turns_of(p, c); k++) {
    int next = c->half[(k + 1) % c->n_passes];
    price += walks_price(&j->c.f, j->c.o.turning.cost, c->half[k], next);
  }
  return price;
}

static double longest_of(const thr_frame *f, const thr_plan *p)
{
  double most = 0;
  for (int i = 0; i < p->n_cords; i++) {
    double length = 0;
    for (int k = 0; k < p->cord[i].n_passes; k++)
      length += f->length[p->cord[i].half[k] >> 1];
    most = fmax(most, length);
  }
  return most;
}

/* A proved bound above the plan's own value, or above the least of all; optimal, but it is not the least. */
static void judge_bound(judged *j, const char *what, double bound, double value, bool optimal, double least, double tolerance)
{
  if (bound > value + tolerance) finding(j, "%s: bound %.12g above the plan's own %.12g", what, bound, value);
  if (isnan(least)) return;
  if (j->whole && value < least - tolerance) finding(j, "%s: %.12g is less than the oracle's least, %.12g", what, value, least);
  if (bound > least + tolerance)
    finding(j, "%s: bound %.12g (%s), but %.12g exists", what, bound, optimal ? "optimal" : "bound", least);
  if (optimal && value > least + tolerance) finding(j, "%s: %.12g optimal, but %.12g exists", what, value, least);
}

static double length_of(const thr_frame *f, const thr_plan *p)
{
  double sum = 0;
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < p->cord[i].n_passes; k++)
      sum += f->length[p->cord[i].half[k] >> 1];
  return sum;
}

/* Least length with as many cords in every piece as the plan has, none longer than limit (see walks_one_more). */
static double least_with_its_cords(const judged *j, const thr_plan *p, double limit)
{
  int cords[PIECES] = {0};
  double sum = 0;
  for (int i = 0; i < p->n_cords; i++)
    cords[p->cord[i].component]++;
  for (int k = 0; k < j->n_pieces; k++) {
    if (cords[k] > MOST_CORDS) return NAN;
    piece_least l = piece_find(j, k, BACK_ANYWHERE, by_length, limit, cords[k]);
    if (!l.known) return NAN;
    sum += l.least[cords[k]];
  }
  return sum;
}

/* And, as the options say it, with at most so many as the piece that has most. */
static double least_with_at_most(const judged *j, int most)
{
  double sum = 0;
  for (int k = 0; k < j->n_pieces; k++) {
    piece_least l = piece_find(j, k, BACK_ANYWHERE, by_length, -1, most < MOST_CORDS ? most : MOST_CORDS);
    if (!l.known) return NAN;
    sum += least_between(&l, 1, l.n);
  }
  return sum;
}

static void judge_length(judged *j, const thr_plan *p, double least)
{
  double length = length_of(&j->c.f, p), tolerance = 2.1e-9 * length;
  if (!p->proof.present) return;
  if (!thr_plan_counted(&j->c.o)) {
    judge_bound(j, "length", p->proof.lower_bound, length, p->proof.optimal, least_with_its_cords(j, p, -1), tolerance);
    least = least_with_at_most(j, p->options.cords);
    if (p->proof.lower_bound > least + tolerance)
      finding(j, "length with at most %d cords: bound %.12g, but %.12g exists", p->options.cords, p->proof.lower_bound, least);
  } else {
    judge_bound(j, "length", p->proof.lower_bound, length, p->proof.optimal, least, tolerance);
  }
}

static void judge_cords(judged *j, const thr_plan *p)
{
  const thr_cords_claim *c = &p->cords_claim;
  double longest = longest_of(&j->c.f, p), tolerance = 3e-9 * longest, limit = c->longest_bound - tolerance;
  if (j->code == 0 && thr_wants_balance(&j->c.o) && !c->longest_optimal) finding(j, "exit 0, but the longest cord is not proved");
  if (!c->present || !thr_plan_counted(&j->c.o)) return;
  judge_bound(j, "longest", c->longest_bound, longest, c->longest_optimal, NAN, tolerance);
  if (c->longest_optimal && c->longest_bound < longest - tolerance)
    finding(j, "longest: optimal at %.12g, but bound %.12g", longest, c->longest_bound);
  if (limit > 0 && least_of(j, BACK_ANYWHERE, by_length, limit) == 0)
    finding(j, "longest: bound %.12g, but there are cords of at most %.12g", c->longest_bound, limit);
  if (c->fewest == 0) return;
  double fewest = fewest_of(j, j->c.o.max_length * (1 + rounding));
  if (p->n_cords < fewest) fewest = fewest_of(j, j->c.o.max_length * (1 + 2e-9)); /* one of them is that little longer */
  judge_bound(j, "fewest", c->fewest, p->n_cords, c->fewest_optimal, fewest, 0);
}

/* What is printed as an integer programme's word, which counts as no better what is better by less than 2e-5. */
static void judge_word(judged *j, const thr_plan *p)
{
  const double part = 1 - 3e-5;
  char path[128], text[OUTPUT];
  double longest = longest_of(&j->c.f, p), length = length_of(&j->c.f, p);
  snprintf(path, sizeof path, "%s/output", folder);
  read_back(path, text);
  if (strstr(text, "none shorter exists") && least_with_its_cords(j, p, part * longest) == 0)
    finding(j, "the longest is %.12g by the solver's word, but there are as many of at most %.12g", longest, part * longest);
  if (strstr(text, "all other passes were ruled out") && least_with_its_cords(j, p, -1) < part * length)
    finding(j, "%.12g is least by the solver's word, but %.12g exists", length, least_with_its_cords(j, p, -1));
}

/* Nothing is claimed of plans that turn back elsewhere than at nodes with one edge. */
static void judge_turning(judged *j, const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  double price = 0, largest = 0;
  if (!c->present) return;
  for (int i = 0; i < p->n_cords; i++) {
    double own = price_of_cord(j, p, &p->cord[i]);
    price += own;
    largest = fmax(largest, own);
  }
  double tolerance = 1e-7 * (1 + price), longest = c->length_limit < 0 ? INFINITY : c->length_limit * (1 + 1e-9);
  if (fabs(price - c->price) > tolerance) finding(j, "turning: price %.12g, said to be %.12g", price, c->price);
  judge_bound(j, "turning", c->lower_bound, price, c->optimal, least_turning(j, longest, -1), tolerance);
  judge_bound(j, "largest turning", c->largest_bound, largest, c->largest_optimal, NAN, tolerance);
  double limit = (c->largest_optimal ? largest : c->largest_bound) - tolerance;
  if (limit >= 0 && least_turning(j, longest, limit) == 0)
    finding(j, "largest turning: %.12g is needed, but there are cords of at most %.12g", limit + tolerance, limit);
}

/* No more cord above the shortest than asked for. */
static void judge_slack(judged *j, const thr_plan *p)
{
  double slack = j->c.o.turning.length_slack, least = least_of(j, BACK_AT_LEAVES, by_length, -1);
  if (!thr_wants_turning(&j->c.o) || slack < 0 || isnan(least) || j->c.o.turning.tour != THR_TOUR_LEAST) return;
  double length = length_of(&j->c.f, p);
  if (length > least * (1 + slack) * (1 + 3e-9) && !strstr(j->said, "more than --length-slack"))
    finding(j, "slack %g: %.12g is %.3g %% above the shortest, %.12g", slack, length, 100 * (length / least - 1), least);
}

/* ---- one case ---- */

static double least_length(const judged *j, walks_back back)
{
  return least_of(j, back, by_length, -1);
}

/* Is there a plan, its longest cord that part longer than allowed? 1, 0, or -1: not known. */
static int exists(const judged *j, walks_back back, double part)
{
  const thr_request *o = &j->c.o;
  double limit = o->max_length > 0 ? o->max_length * (1 + part) : -1, least = least_of(j, back, by_length, limit);
  return isnan(least) ? -1 : isfinite(least);
}

/* Does the program say no more than that it found none? */
static bool admits(const char *said)
{
  return strstr(said, "did not find") || strstr(said, "was found") || strstr(said, "were found");
}

static void judge_none(judged *j, counts *n)
{
  walks_back back = thr_wants_length(&j->c.o) ? BACK_ANYWHERE : BACK_AT_LEAVES;
  int is_one = exists(j, back, rounding);
  n->none++;
  n->unsure += is_one < 0;
  if (is_one == 1) finding(j, "no plan, but there is one%s", admits(j->said) ? "; it is said that none was found" : "");
  n->missed += is_one == 1 && admits(j->said);
}

/* None was found, and nothing is claimed: of different cords that may be so where there is one. */
static void judge_missed(judged *j, counts *n)
{
  const bool is_one = exists(j, BACK_AT_LEAVES, rounding) == 1;
  n->missed += is_one;
  if (is_one && j->c.o.distinct == 0) finding(j, "no plan was found, but there is one");
}

static void judge_written(judged *j, counts *n)
{
  const thr_plan *p = &j->plan;
  char path[128];
  n->planned++;
  n->open += j->code == 5;
  judge_threading(j, p);
  if (j->whole && exists(j, BACK_ANYWHERE, 2e-9) == 0) finding(j, "a plan, but the oracle knows of none");
  double least = least_length(j, BACK_ANYWHERE);
  n->unsure += isnan(least);
  judge_length(j, p, least);
  judge_cords(j, p);
  judge_word(j, p);
  judge_turning(j, p);
  judge_slack(j, p);
  bool shortest = thr_wants_length(&j->c.o) && !thr_wants_balance(&j->c.o) && j->c.o.max_length == 0;
  if (j->code == 0 && shortest && !(p->proof.present && p->proof.optimal)) finding(j, "exit 0, but the length is not proved");
  snprintf(path, sizeof path, "%s/plan.json", folder);
  char said[OUTPUT];
  int code = run(said, "check %s", path);
  if (code) finding(j, "thread check says %d: %s", code, said);
}

static bool one_line(const char *said)
{
  const char *end = strchr(said, '\n');
  return end && end[1] == '\0';
}

static void drop_notes(char *said)
{
  static const char note[] = "thread: note:";
  while (strncmp(said, note, sizeof note - 1) == 0) {
    char *end = strchr(said, '\n');
    memmove(said, end ? end + 1 : said + strlen(said), strlen(end ? end + 1 : "") + 1);
  }
}

static void judge_case(judged *j, counts *n)
{
  char plan[128];
  thr_err err = {0};
  snprintf(plan, sizeof plan, "%s/plan.json", folder);
  remove(plan);
  j->code = run(j->said, "plan %s%s --time-limit 5 -o %s", j->c.frame_path, j->c.arguments, plan);
  drop_notes(j->said);
  j->written = access(plan, F_OK) == 0;
  n->cases++;
  bool none = j->code == 5 && !j->written && admits(j->said);
  if (!none && j->written != (j->code == 0 || j->code == 5)) finding(j, "exit code %d, plan written: %d", j->code, j->written);
  if (j->code && j->code != 5 && !one_line(j->said)) finding(j, "not one line on standard error");
  if (j->written && thr_plan_read(&j->plan, plan, &err) != THR_OK)
    finding(j, "the plan cannot be read: %s", err.text);
  else if (j->written)
    judge_written(j, n);
  else if (j->code == 4)
    judge_none(j, n);
  else if (none)
    judge_missed(j, n);
  else
    finding(j, "exit code %d", j->code);
  n->findings += j->findings > 0;
  thr_plan_destroy(&j->plan);
}

/* A framework for these values; mostly one that has a plan. */
static void make_case(judged *j, rng *r, const int *value, const char *path, int most_edges)
{
  enum { TRIES = 4 };
  int component[64];
  for (int i = 0; i < TRIES; i++) {
    memset(j, 0, sizeof *j);
    j->c = crossing_make(r, value, path, most_edges);
    ck_assert_int_eq(thr_frame_components(&j->c.f, component, &j->n_pieces, NULL), THR_OK);
    if (i == TRIES - 1 || exists(j, BACK_AT_LEAVES, rounding) != 0) return;
    crossing_destroy(&j->c);
  }
}

/* ---- the tests ---- */

static long from_environment(const char *name, long usual)
{
  const char *text = getenv(name);
  return text ? strtol(text, NULL, 10) : usual;
}

static void open_folder(void)
{
  find_program();
  snprintf(folder, sizeof folder, "/tmp/thread-cross-XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(folder));
}

static void close_folder(void)
{
  static const char *const name[] = {"frame.json", "plan.json", "errors", "output"};
  char path[128];
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
    snprintf(path, sizeof path, "%s/%s", folder, name[i]);
    remove(path);
  }
  ck_assert_int_eq(rmdir(folder), 0);
}

/* ---- cases that were wrong once ---- */

/* A framework as JSON, and options in both forms; ends are any, feet, closed or counted. */
typedef struct {
  const char *nodes, *edges, *more; /* members of the frame */
  const char *arguments;
  thr_request o;
  int end_count[12];
} known_case;

#define CAPACITY(n) .capacity = (n)
#define CORDS(a, b) .cords_least = (a), .cords = (b)
#define TURNING(slack, price) .turning = {.length_slack = (slack), .cost = (price)}
#define AIM(what) .aims = {1, {THR_AIM_##what}}

static const known_case known[] = {
    /* The shortest passes need a full edge, or turn back: the slack was measured from them, and no plan found. */
    {"[71.06,75.96,42.594],[49.682,21.57,50.028],[98.593,81.205,36.736]",
     "[0,1],[0,2],[1,2]",
     "\"lengths\": [25.495,70.003,13.585], \"covers\": [1,1,3]",
     "--objective tortuosity --capacity 3 --length-slack 10 --turn-cost step --minimize max-turning --ends any",
     {AIM(MAX_TURNING), CAPACITY(3), CORDS(1, 1), TURNING(0.1, THR_TURN_STEP), .ends = THR_ENDS_ANY},
     {0}},
    {"[74,95,11],[86,98,6],[17,31,32]",
     "[1,0],[2,0]",
     "\"lengths\": [77.524,75.204], \"covers\": [1,2]",
     "--objective tortuosity --cords 2 --length-slack 40 --turn-cost step --ends 1:1,2:3",
     {AIM(TURNING), CORDS(2, 2), TURNING(0.4, THR_TURN_STEP), .ends = THR_ENDS_COUNTS},
     {0, 1, 3}},
    /* Every edge that a tour would need once more is full: it took one nevertheless. */
    {"[50,0,50],[0,100,50],[50,0,0],[100,0,0]",
     "[1,0],[2,1],[1,3],[3,0]",
     "\"capacities\": [1,null,3,null]",
     "--objective tortuosity --capacity 1 --length-slack 0 --tour fleury --ends any",
     {AIM(TURNING), CAPACITY(1), CORDS(1, 1), .turning = {.tour = THR_TOUR_FLEURY}, .ends = THR_ENDS_ANY},
     {0}},
    /* One number of cords was tried for all pieces. */
    {"[0,0,0],[40,0,0],[80,0,0],[400,0,0],[440,0,0]",
     "[0,1],[1,2],[3,4]",
     "\"feet\": [0,1,2,3,4]",
     "--joint tube --cover 2 --capacity 2 --balance --cords 1..3 --ends feet",
     {.joint = THR_JOINT_TUBE, .cover = 2, CAPACITY(2), AIM(LONGEST), CORDS(1, 3), .ends = THR_ENDS_FEET},
     {0}},
    {"[0,0,0],[40,0,0],[80,0,0],[450,0,0],[375,43,0],[375,-43,0]",
     "[1,0],[1,2],[4,3],[4,5],[3,5]",
     "\"lengths\": [10,10,10,10,10], \"capacities\": [2,1,null,null,2], \"feet\": [0,2,3,4]",
     "--joint tube --capacity 3 --cords auto --max-length 39.5 --ends feet",
     {.joint = THR_JOINT_TUBE, CAPACITY(3), CORDS(1, 1000), .max_length = 39.5, .ends = THR_ENDS_FEET},
     {0}},
    {"[12,8,77],[24,84,13],[6,93,69],[406,8,31],[473,2,27],[435,34,7],[403,37,76]",
     "[0,1],[0,2],[2,1],[3,4],[3,5],[6,3],[6,5],[4,5],[6,4]",
     "\"lengths\": [10,10,10,10,10,10,10,10,10], \"feet\": [2,3,4,5,6]",
     "--capacity 1 --cords ..8 --max-length 69.5 --ends feet",
     {CAPACITY(1), CORDS(1, 8), .max_length = 69.5, .ends = THR_ENDS_FEET},
     {0}},
};
enum { N_KNOWN = sizeof known / sizeof *known };

static void write_frame(const char *path, const char *nodes, const char *edges, const char *more)
{
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  fprintf(out, "{\"nodes\": [%s], \"edges\": [%s]%s%s}\n", nodes, edges, *more ? ", " : "", more);
  ck_assert_int_eq(fclose(out), 0);
}

/* Judges one case with these options; the lists of o belong to the caller. */
static void judge_given(const char *path, const thr_request *o, const char *arguments)
{
  static judged j;
  counts n = {0};
  int component[64];
  memset(&j, 0, sizeof j);
  j.c.f = frame_load(path, NULL);
  j.c.o = *o;
  if (j.c.o.cover == 0) j.c.o.cover = 1;
  snprintf(j.c.frame_path, sizeof j.c.frame_path, "%s", path);
  snprintf(j.c.arguments, sizeof j.c.arguments, " %s", arguments);
  ck_assert_int_eq(thr_frame_components(&j.c.f, component, &j.n_pieces, NULL), THR_OK);
  judge_case(&j, &n);
  thr_frame_destroy(&j.c.f);
  ck_assert_int_eq(n.unsure, 0);
  ck_assert_int_eq(n.findings, 0);
}

START_TEST(what_was_wrong_once)
{
  const known_case *k = &known[_i];
  thr_request o = k->o;
  int end_count[12];
  char path[128];
  open_folder();
  snprintf(path, sizeof path, "%s/frame.json", folder);
  write_frame(path, k->nodes, k->edges, k->more);
  memcpy(end_count, k->end_count, sizeof end_count);
  o.end_count = end_count;
  if (!thr_wants_turning(&o)) o.turning.length_slack = -1;
  judge_given(path, &o, k->arguments);
  close_folder();
}
END_TEST

/* A tetrahedron and a triangle: symmetric plans have two cords in one and one in the other. */
START_TEST(symmetric_pieces_have_numbers_of_their_own)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_request o = thr_request_default();
  char path[128], nodes[400] = "";
  open_folder();
  snprintf(path, sizeof path, "%s/frame.json", folder);
  for (int v = 0; v < 7; v++) {
    size_t n = strlen(nodes);
    snprintf(nodes + n, sizeof nodes - n, "%s[%d,%d,%d]", v ? "," : "", (v < 4 ? 0 : 400) + rng_below(&r, 101),
             rng_below(&r, 101), rng_below(&r, 101));
  }
  write_frame(path, nodes, "[0,1],[0,2],[0,3],[1,2],[1,3],[2,3],[4,5],[5,6],[6,4]", "\"feet\": [0,1,4,5]");
  want(&o, "overlap,steps");
  o.joint = THR_JOINT_TUBE;
  o.ends = _i % 2 ? THR_ENDS_ANY : THR_ENDS_FEET;
  judge_given(path, &o,
              _i % 2 ? "--objective symmetry --joint tube --ends any" : "--objective symmetry --joint tube --ends feet");
  close_folder();
}
END_TEST

/* Two unit vectors at right angles. */
static void right_angle(rng *r, double x[3], double y[3])
{
  double along = 0, size = 0, width = 0;
  for (int i = 0; i < 3; i++) {
    x[i] = rng_unit(r) - 0.5;
    y[i] = rng_unit(r) - 0.5;
    size += x[i] * x[i];
    along += x[i] * y[i];
  }
  for (int i = 0; i < 3; i++) {
    y[i] -= along / size * x[i];
    width += y[i] * y[i];
  }
  for (int i = 0; i < 3; i++) {
    x[i] /= sqrt(size);
    y[i] /= sqrt(width);
  }
}

/* A star of three or four spokes, most pairs of which turn by 90 degrees less 1e-6, give or take some of the last digits: whoever
 * prices steps must price all of them alike. */
START_TEST(steps_at_their_threshold)
{
  enum { SPOKES = 4 };
  rng r = rng_make((uint64_t)_i + 1);
  thr_request o = thr_request_default();
  char path[128], nodes[600] = "[0,0,0]";
  double x[3], y[3], size = 1 + 99 * rng_unit(&r), angle = acos(0) - 1e-6 * (1 + 1e-10 * rng_between(&r, -3, 3));
  open_folder();
  snprintf(path, sizeof path, "%s/frame.json", folder);
  right_angle(&r, x, y);
  for (int k = 0; k < SPOKES; k++) { /* those of even number are opposite to each other, as are the others */
    double at[3];
    for (int i = 0; i < 3; i++)
      at[i] = (k < 2 ? size : -size) * (k % 2 ? sin(angle) * y[i] - cos(angle) * x[i] : x[i]);
    size_t n = strlen(nodes);
    snprintf(nodes + n, sizeof nodes - n, ",[%.17g,%.17g,%.17g]", at[0], at[1], at[2]);
  }
  write_frame(path, nodes, _i % 2 ? "[0,1],[0,2],[3,0],[4,0]" : "[0,1],[2,0],[0,3]", "");
  want(&o, "turning");
  o.ends = THR_ENDS_ANY;
  o.turning.cost = THR_TURN_STEP;
  judge_given(path, &o, "--objective tortuosity --turn-cost step --ends any --weld 0");
  close_folder();
}
END_TEST

/* The two values alone, with what else they need. */
START_TEST(refused_together)
{
  const crossing_refused *p = &crossing_refusals[_i];
  int value[N_CHOICES] = {0};
  rng r = rng_make((uint64_t)_i + 1);
  char path[128], said[OUTPUT];
  bool turning = p->a == BY_TOUR || p->a == BY_SLACK;
  open_folder();
  snprintf(path, sizeof path, "%s/frame.json", folder);
  if (turning) value[BY_OBJECTIVE] = 1;
  if (p->a == BY_BALANCE) value[BY_CORDS] = 1;
  value[p->a] = p->value_a;
  value[p->b] = p->value_b;
  ck_assert(crossing_is_refused(value));
  crossing_case c = crossing_make(&r, value, path, 4);
  int code = run(said, "plan %s%s -q -o %s/plan.json", path, c.arguments, folder);
  ck_assert_msg(code == 2 && one_line(said), "thread plan%s: exit code %d, %s", c.arguments, code, said);
  crossing_destroy(&c);
  close_folder();
}
END_TEST

/* Every pair that is not refused was met. */
static void assert_all_met(const crossing_tally *t)
{
  for (int a = 0; a < N_CHOICES; a++)
    for (int b = 0; b < a; b++)
      for (int i = 0; i < crossing_values((crossing_choice)a); i++)
        for (int k = 0; k < crossing_values((crossing_choice)b); k++)
          ck_assert_msg(t->met[a][i][b][k] > 0 || crossing_never_meet((crossing_choice)a, i, (crossing_choice)b, k),
                        "%s %s never met %s %s", crossing_name[a], crossing_value[a][i], crossing_name[b], crossing_value[b][k]);
}

START_TEST(pairs_of_options_agree_with_all_walks)
{
  static crossing_tally tally;
  static judged j;
  long cases = from_environment("THREAD_CROSS_CASES", share_of(1000)), seed = from_environment("THREAD_CROSS_SEED", 1);
  long most_edges = from_environment("THREAD_CROSS_EDGES", 5);
  counts n = {0};
  char path[128];
  open_folder();
  most_states = from_environment("THREAD_CROSS_STATES", most_states);
  snprintf(path, sizeof path, "%s/frame.json", folder);
  for (long i = 0; i < cases; i++) {
    rng r = rng_make((uint64_t)(seed * 1000003 + i));
    int value[N_CHOICES];
    crossing_choose(&r, &tally, getenv("THREAD_CROSS_ONLY"), value);
    crossing_count(&tally, value);
    make_case(&j, &r, value, path, (int)most_edges);
    judge_case(&j, &n);
    crossing_destroy(&j.c);
  }
  close_folder();
  if (getenv("THREAD_CROSS_CASES")) crossing_print(&tally);
  printf(
      "%ld cases: %ld planned (%ld not proved), %ld without a plan, %ld too large for the oracle; %ld with findings, %ld of them "
      "plans missed\n",
      n.cases, n.planned, n.open, n.none, n.unsure, n.findings, n.missed);
  if (cases >= 600 && !getenv("THREAD_CROSS_ONLY")) assert_all_met(&tally);
  ck_assert_int_eq(n.findings, 0);
}
END_TEST

int main(int argc, char **argv)
{
  (void)argc;
  self = argv[0];
  Suite *s = suite_create("cross");
  ADD_LOOP(s, 30, refused_together, 0, n_crossing_refusals);
  ADD_LOOP(s, 60, what_was_wrong_once, 0, N_KNOWN);
  ADD_EXAMPLES(s, 60, symmetric_pieces_have_numbers_of_their_own, 8);
  ADD_LOOP(s, 30, steps_at_their_threshold, 0, 24);
  ADD_TEST(s, 600, pairs_of_options_agree_with_all_walks);
  return run_suite(s);
}
