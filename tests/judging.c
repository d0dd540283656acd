/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program run on one case, and everything that it says. */
#define _POSIX_C_SOURCE 200809L

#include "tests/judging.h"
#include "tests/plans.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- running the program ---- */

static char program[512];
char judging_folder[64];

/* It is two folders above the tests. */
static void find_program(const char *self)
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

int judging_run(char *said, const char *format, ...)
{
  char words[3000], command[4000], errors[128];
  va_list list;
  va_start(list, format);
  vsnprintf(words, sizeof words, format, list);
  va_end(list);
  snprintf(errors, sizeof errors, "%s/errors", judging_folder);
  snprintf(command, sizeof command, "ulimit -t 60; exec %s %s >%s/output 2>%s", program, words,
           judging_folder, errors);
  int status = system(command);
  read_back(errors, said);
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

void judging_begin(const char *self)
{
  find_program(self);
  snprintf(judging_folder, sizeof judging_folder, "/tmp/thread-cross-XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(judging_folder));
}

void judging_end(void)
{
  static const char *const name[] = {"frame.json", "plan.json", "errors", "output"};
  char path[128];
  for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
    snprintf(path, sizeof path, "%s/%s", judging_folder, name[i]);
    remove(path);
  }
  ck_assert_int_eq(rmdir(judging_folder), 0);
}

/* ---- what is found ---- */

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
    printf("  cat >frame.json <<'END'\n%sEND\n  thread plan frame.json%s -o plan.json   # exit "
           "%d\n%s%s",
           frame, j->c.arguments, j->code, *j->said ? "  " : "", j->said);
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
    if (k && thr_head(f, c->half[k - 1]) != thr_tail(f, c->half[k]))
      finding(j, "cord %s is broken at pass %d", c->id, k);
  }
  ends[start]++;
  ends[end]++;
  if (c->closed != (start == end)) finding(j, "cord %s is not what it is said to be", c->id);
  if (j->c.o.ends == THR_ENDS_CLOSED && start != end) finding(j, "cord %s is open", c->id);
  if (!walks_may_end(f, &j->c.o, start) || !walks_may_end(f, &j->c.o, end))
    finding(j, "cord %s ends where it may not", c->id);
  if (j->c.o.max_length > 0 && length > j->c.o.max_length * (1 + 2e-9))
    finding(j, "cord %s is %.12g long", c->id, length);
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
      if (turns_back(&p->cord[i], k))
        finding(j, "cord %s turns back after pass %d", p->cord[i].id, k + 1);
      up[root(up, in)] = root(up, out);
    }
  for (int a = 0; a < 2 * f->n_edges; a++)
    for (int b = 0; b < a; b++)
      if (thr_tail(f, a) == thr_tail(f, b) && root(up, a) != root(up, b))
        finding(j, "node %d is not tied", thr_tail(f, a));
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
  if (asked > 0 && p->metrics.distinct != n)
    finding(j, "%d edges have their cords, but %d are said to", n, p->metrics.distinct);
  if (!j->whole && (j->code != 5 || !strstr(j->said, "no better cords were found")))
    finding(j, "edges lack different cords");
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
    if (passes[e] < walks_cover(f, o, e) || passes[e] > walks_capacity(f, o, e))
      finding(j, "edge %d: %d passes", e, passes[e]);
  for (int v = 0; v < f->n_nodes && o->ends == THR_ENDS_COUNTS; v++)
    if (ends[v] != o->end_count[v]) finding(j, "node %d has %d ends", v, ends[v]);
  for (int k = 0; k < j->n_pieces && thr_plan_counted(o); k++)
    if (cords[k] < o->cords_least || cords[k] > o->cords)
      finding(j, "piece %d has %d cords", k, cords[k]);
  if (o->joint == THR_JOINT_TUBE) judge_ties(j, p);
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

/* A proved bound above the plan's own value, or above the least of all; optimal, but it is not the
 * least. */
static void judge_bound(judged *j, const char *what, double bound, double value, bool optimal,
                        double least, double tolerance)
{
  if (bound > value + tolerance)
    finding(j, "%s: bound %.12g above the plan's own %.12g", what, bound, value);
  if (isnan(least)) return;
  if (j->whole && value < least - tolerance)
    finding(j, "%s: %.12g is less than the oracle's least, %.12g", what, value, least);
  if (bound > least + tolerance)
    finding(j, "%s: bound %.12g (%s), but %.12g exists", what, bound, optimal ? "optimal" : "bound",
            least);
  if (optimal && value > least + tolerance)
    finding(j, "%s: %.12g optimal, but %.12g exists", what, value, least);
}

static double length_of(const thr_frame *f, const thr_plan *p)
{
  double sum = 0;
  for (int i = 0; i < p->n_cords; i++)
    for (int k = 0; k < p->cord[i].n_passes; k++)
      sum += f->length[p->cord[i].half[k] >> 1];
  return sum;
}

/* Least length with as many cords in every piece as the plan has, none longer than limit (see
 * walks_one_more). */
static double least_with_its_cords(const judged *j, const thr_plan *p, double limit)
{
  int cords[PIECES] = {0};
  double sum = 0;
  for (int i = 0; i < p->n_cords; i++)
    cords[p->cord[i].component]++;
  for (int k = 0; k < j->n_pieces; k++) {
    if (cords[k] > MOST_CORDS) return NAN;
    judged_piece l = judged_piece_find(j, k, BACK_ANYWHERE, judged_by_length, limit, cords[k]);
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
    judged_piece l = judged_piece_find(j, k, BACK_ANYWHERE, judged_by_length, -1,
                                       most < MOST_CORDS ? most : MOST_CORDS);
    if (!l.known) return NAN;
    sum += judged_between(&l, 1, l.n);
  }
  return sum;
}

static void judge_length(judged *j, const thr_plan *p, double least)
{
  double length = length_of(&j->c.f, p), tolerance = 2.1e-9 * length;
  if (!p->proof.present) return;
  if (!thr_plan_counted(&j->c.o)) {
    judge_bound(j, "length", p->proof.lower_bound, length, p->proof.optimal,
                least_with_its_cords(j, p, -1), tolerance);
    least = least_with_at_most(j, p->options.cords);
    if (p->proof.lower_bound > least + tolerance)
      finding(j, "length with at most %d cords: bound %.12g, but %.12g exists", p->options.cords,
              p->proof.lower_bound, least);
  } else {
    judge_bound(j, "length", p->proof.lower_bound, length, p->proof.optimal, least, tolerance);
  }
}

static void judge_cords(judged *j, const thr_plan *p)
{
  const thr_cords_claim *c = &p->cords_claim;
  double longest = longest_of(&j->c.f, p), tolerance = 3e-9 * longest,
         limit = c->longest_bound - tolerance;
  if (j->code == 0 && thr_wants_balance(&j->c.o) && !c->longest_optimal)
    finding(j, "exit 0, but the longest cord is not proved");
  if (!c->present || !thr_plan_counted(&j->c.o)) return;
  judge_bound(j, "longest", c->longest_bound, longest, c->longest_optimal, NAN, tolerance);
  if (c->longest_optimal && c->longest_bound < longest - tolerance)
    finding(j, "longest: optimal at %.12g, but bound %.12g", longest, c->longest_bound);
  if (limit > 0 && judged_least(j, BACK_ANYWHERE, judged_by_length, limit) == 0)
    finding(j, "longest: bound %.12g, but there are cords of at most %.12g", c->longest_bound,
            limit);
  if (c->fewest == 0) return;
  double fewest = judged_fewest(j, j->c.o.max_length * (1 + judged_rounding));
  if (p->n_cords < fewest)
    fewest =
        judged_fewest(j, j->c.o.max_length * (1 + 2e-9)); /* one of them is that little longer */
  judge_bound(j, "fewest", c->fewest, p->n_cords, c->fewest_optimal, fewest, 0);
}

/* What is printed as an integer programme's word, which counts as no better what is better by less
 * than 2e-5. */
static void judge_word(judged *j, const thr_plan *p)
{
  const double part = 1 - 3e-5;
  char path[128], text[OUTPUT];
  double longest = longest_of(&j->c.f, p), length = length_of(&j->c.f, p);
  snprintf(path, sizeof path, "%s/output", judging_folder);
  read_back(path, text);
  if (strstr(text, "none shorter exists") && least_with_its_cords(j, p, part * longest) == 0)
    finding(j, "the longest is %.12g by the solver's word, but there are as many of at most %.12g",
            longest, part * longest);
  if (strstr(text, "all other passes were ruled out") &&
      least_with_its_cords(j, p, -1) < part * length)
    finding(j, "%.12g is least by the solver's word, but %.12g exists", length,
            least_with_its_cords(j, p, -1));
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
  double tolerance = 1e-7 * (1 + price),
         longest = c->length_limit < 0 ? INFINITY : c->length_limit * (1 + 1e-9);
  if (fabs(price - c->price) > tolerance)
    finding(j, "turning: price %.12g, said to be %.12g", price, c->price);
  judge_bound(j, "turning", c->lower_bound, price, c->optimal, judged_least_turning(j, longest, -1),
              tolerance);
  judge_bound(j, "largest turning", c->largest_bound, largest, c->largest_optimal, NAN, tolerance);
  double limit = (c->largest_optimal ? largest : c->largest_bound) - tolerance;
  if (limit >= 0 && judged_least_turning(j, longest, limit) == 0)
    finding(j, "largest turning: %.12g is needed, but there are cords of at most %.12g",
            limit + tolerance, limit);
}

/* No more cord above the shortest than asked for. */
static void judge_slack(judged *j, const thr_plan *p)
{
  double slack = j->c.o.turning.length_slack,
         least = judged_least(j, BACK_AT_LEAVES, judged_by_length, -1);
  if (!thr_wants_turning(&j->c.o) || slack < 0 || isnan(least) ||
      j->c.o.turning.tour != THR_TOUR_LEAST)
    return;
  double length = length_of(&j->c.f, p);
  if (length > least * (1 + slack) * (1 + 3e-9) && !strstr(j->said, "more than --length-slack"))
    finding(j, "slack %g: %.12g is %.3g %% above the shortest, %.12g", slack, length,
            100 * (length / least - 1), least);
}

/* ---- one case ---- */

static double least_length(const judged *j, walks_back back)
{
  return judged_least(j, back, judged_by_length, -1);
}

/* Is there a plan, its longest cord that part longer than allowed? 1, 0, or -1: not known. */
static int exists(const judged *j, walks_back back, double part)
{
  const thr_request *o = &j->c.o;
  double limit = o->max_length > 0 ? o->max_length * (1 + part) : -1,
         least = judged_least(j, back, judged_by_length, limit);
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
  int is_one = exists(j, back, judged_rounding);
  n->none++;
  n->unsure += is_one < 0;
  if (is_one == 1)
    finding(j, "no plan, but there is one%s",
            admits(j->said) ? "; it is said that none was found" : "");
  n->missed += is_one == 1 && admits(j->said);
}

/* None was found, and nothing is claimed: of different cords that may be so where there is one. */
static void judge_missed(judged *j, counts *n)
{
  const bool is_one = exists(j, BACK_AT_LEAVES, judged_rounding) == 1;
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
  if (j->whole && exists(j, BACK_ANYWHERE, 2e-9) == 0)
    finding(j, "a plan, but the oracle knows of none");
  double least = least_length(j, BACK_ANYWHERE);
  n->unsure += isnan(least);
  judge_length(j, p, least);
  judge_cords(j, p);
  judge_word(j, p);
  judge_turning(j, p);
  judge_slack(j, p);
  bool shortest =
      thr_wants_length(&j->c.o) && !thr_wants_balance(&j->c.o) && j->c.o.max_length == 0;
  if (j->code == 0 && shortest && !(p->proof.present && p->proof.optimal))
    finding(j, "exit 0, but the length is not proved");
  snprintf(path, sizeof path, "%s/plan.json", judging_folder);
  char said[OUTPUT];
  int code = judging_run(said, "check %s", path);
  if (code) finding(j, "thread check says %d: %s", code, said);
}

bool judging_one_line(const char *said)
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

void judged_case(judged *j, counts *n)
{
  char plan[128];
  thr_err err = {0};
  snprintf(plan, sizeof plan, "%s/plan.json", judging_folder);
  remove(plan);
  j->code =
      judging_run(j->said, "plan %s%s --time-limit 5 -o %s", j->c.frame_path, j->c.arguments, plan);
  drop_notes(j->said);
  j->written = access(plan, F_OK) == 0;
  n->cases++;
  bool none = j->code == 5 && !j->written && admits(j->said);
  if (!none && j->written != (j->code == 0 || j->code == 5))
    finding(j, "exit code %d, plan written: %d", j->code, j->written);
  if (j->code && j->code != 5 && !judging_one_line(j->said))
    finding(j, "not one line on standard error");
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

void judged_make(judged *j, rng *r, const int *value, const char *path, int most_edges)
{
  enum { TRIES = 4 };
  int component[64];
  for (int i = 0; i < TRIES; i++) {
    memset(j, 0, sizeof *j);
    j->c = crossing_make(r, value, path, most_edges);
    ck_assert_int_eq(thr_frame_components(&j->c.f, component, &j->n_pieces, NULL), THR_OK);
    if (i == TRIES - 1 || exists(j, BACK_AT_LEAVES, judged_rounding) != 0) return;
    crossing_destroy(&j->c);
  }
}
