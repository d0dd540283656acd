/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libthread as other programs see it: what include/thread.h promises, without a look at anything
 * behind it. */
#define _XOPEN_SOURCE 700
#include "graph/status.h"
#include "include/thread.h"
#include "tests/support.h"

#include <check.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double DOME = 1995.248611; /* mm, the least length of dome7.json (data/README.md) */

/* A square with one diagonal: nodes 0 and 2 are odd. */
static const double square_xyz[] = {0, 0, 0, 30, 0, 0, 30, 40, 0, 0, 40, 0};
static const int square_ends[] = {0, 1, 1, 2, 2, 3, 3, 0, 0, 2};

static thread_frame *square(void)
{
  thread_frame *frame;
  thread_error err;
  ck_assert_msg(thread_frame_make(4, square_xyz, 5, square_ends, NULL, &frame, &err) == THREAD_OK,
                "%s", err.text);
  return frame;
}

/* The one shortest closed cord. */
static thread_plan_options one_cord(void)
{
  thread_plan_options o;
  thread_plan_options_init(&o, sizeof o);
  o.cords = 1;
  return o;
}

static void assert_refused(thread_status st, thread_status want, const thread_error *err,
                           const void *out, const char *word)
{
  ck_assert_int_eq((int)st, (int)want);
  ck_assert_ptr_null(out);
  ck_assert_msg(strstr(err->text, word) != NULL && !strchr(err->text, '\n'), "%s", err->text);
}

/* Do two nodes have an edge? By its list alone. */
static int edge_of(const thread_frame *frame, int a, int b)
{
  const int *ends;
  int n = thread_frame_edges(frame, &ends);
  for (int e = 0; e < n; e++)
    if ((ends[2 * e] == a && ends[2 * e + 1] == b) || (ends[2 * e] == b && ends[2 * e + 1] == a))
      return e;
  return -1;
}

/* Walks along all cords: every step is an edge, every edge is passed, and the steps are so long
 * together. */
static void assert_covers(const thread_plan *plan, double length)
{
  const thread_frame *frame = thread_plan_frame(plan);
  const double *xyz;
  int n = thread_frame_edges(frame, NULL), *passes = calloc((size_t)n, sizeof *passes);
  double sum = 0;
  ck_assert_ptr_nonnull(passes);
  thread_frame_nodes(frame, &xyz);
  for (int i = 0; i < thread_plan_cords(plan); i++) {
    const int *node;
    for (int k = 0, most = thread_plan_cord(plan, i, &node); k < most; k++) {
      int e = edge_of(frame, node[k], node[k + 1]);
      ck_assert_int_ge(e, 0);
      passes[e]++;
      const double *a = xyz + 3 * node[k], *b = xyz + 3 * node[k + 1];
      sum += hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
    }
  }
  for (int e = 0; e < n; e++)
    ck_assert_int_ge(passes[e], 1);
  ck_assert_double_eq_tol(sum, length, 1e-6);
  free(passes);
}

START_TEST(a_dome_is_planned_checked_and_drawn)
{
  thread_error err;
  thread_frame *dome;
  thread_plan *plan;
  thread_summary s;
  char *svg;
  size_t n;
  const thread_plan_options one = one_cord();
  ck_assert_msg(thread_frame_shape("dome", 7, &dome, &err) == THREAD_OK, "%s", err.text);
  ck_assert_msg(thread_plan_make(dome, &one, &plan, &err) == THREAD_OK, "%s", err.text);
  thread_frame_free(dome); /* the plan has its own */
  ck_assert_int_eq((int)thread_check(plan, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_summary(plan, &s, sizeof s, &err), THREAD_OK);
  ck_assert_double_eq_tol(s.length, DOME, 5e-7);
  ck_assert_double_eq_tol(s.bound, DOME, 5e-7);
  ck_assert_int_eq(s.shortest, 1);
  assert_covers(plan, DOME);
  ck_assert_int_eq((int)thread_draw(plan, "svg", &svg, &n, &err), THREAD_OK);
  ck_assert(n > 10000 && strlen(svg) == n && strstr(svg, "</svg>"));
  thread_free(svg);
  thread_plan_free(plan);
}
END_TEST

/* The tensions of a cord by hand: seating x exp(mu x turning) from its slackest pass to both ends.
 */
START_TEST(cords_say_what_they_are)
{
  static const double cross[] = {0, 0, 0, 10, 0, 0, 20, 0, 0, 20, 30, 0};
  static const int row[] = {0, 1, 1, 2, 2, 3};
  static const double right_angle = 1.5707963267948966;
  thread_error err;
  thread_frame *frame;
  thread_plan *plan;
  thread_plan_options o;
  thread_cord cord;
  thread_summary s;
  thread_plan_options_init(&o, sizeof o);
  o.ends = THREAD_ANY;
  o.physics = "{\"mu\": 0.5, \"seating\": 2}";
  ck_assert_int_eq((int)thread_frame_make(4, cross, 3, row, NULL, &frame, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_make(frame, &o, &plan, &err), THREAD_OK);

  for (int evaluated = 0; evaluated < 2; evaluated++) {
    ck_assert_int_eq((int)thread_plan_cord_summary(plan, 0, &cord, sizeof cord, &err), THREAD_OK);
    ck_assert_str_eq(cord.name, "A");
    ck_assert_int_eq(cord.passes, 3);
    ck_assert(cord.from + cord.to == 3 && cord.from * cord.to == 0);
    ck_assert_double_eq_tol(cord.length, 50, 1e-9);
    ck_assert_double_eq_tol(cord.turning, right_angle, 1e-9);

    /* One turn: the slack side of it needs 2 N, and so does the end there; no turn lies between
     * the other end and its side, where each end does its own half. */
    ck_assert_double_eq_tol(cord.pull_start, cord.tension[0], 1e-12);
    ck_assert_double_eq_tol(cord.pull_end, cord.tension[2], 1e-12);
    ck_assert_double_eq_tol(fmin(cord.pull_start, cord.pull_end), 2, 1e-9);
    ck_assert(fmax(cord.pull_start, cord.pull_end) <= 2 * exp(0.5 * right_angle) + 1e-9);
    ck_assert_int_eq((int)thread_plan_summary(plan, &s, sizeof s, &err), THREAD_OK);
    ck_assert_double_eq_tol(s.pull, fmax(cord.pull_start, cord.pull_end), 1e-9);
    ck_assert_int_eq((int)thread_eval(plan, "capstan", 0, &err), THREAD_OK);
  }
  ck_assert_int_eq((int)thread_plan_cord_summary(plan, 1, &cord, sizeof cord, &err),
                   THREAD_BAD_INPUT);
  ck_assert(cord.size == sizeof cord && !cord.name && cord.passes == 0);
  thread_plan_free(plan);
  thread_frame_free(frame);
}
END_TEST

START_TEST(by_hand)
{
  /* The diagonal twice: 140 + 2 x 50. */
  thread_error err;
  thread_plan *plan;
  thread_summary s;
  thread_frame *frame = square();
  thread_plan_options o = one_cord();
  ck_assert_int_eq((int)thread_plan_make(frame, &o, &plan, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_summary(plan, &s, sizeof s, &err), THREAD_OK);
  assert_covers(plan, 240);
  ck_assert_int_eq(s.passes, 6);
  thread_plan_free(plan);
  thread_plan_options_init(&o, sizeof o);
  o.ends = THREAD_ANY; /* from one odd node to the other: no edge twice */
  ck_assert_int_eq((int)thread_plan_make(frame, &o, &plan, &err), THREAD_OK);
  assert_covers(plan, 190);
  thread_plan_free(plan);
  o.ends = THREAD_NODES;
  o.n_end_nodes = 2;
  o.end_node = (const int[]){1, 3};
  ck_assert_int_eq((int)thread_plan_make(frame, &o, &plan, &err), THREAD_OK);
  const int *node;
  int n = thread_plan_cord(plan, 0, &node);
  ck_assert(node[0] == 1 || node[0] == 3);
  ck_assert(node[n] == 1 || node[n] == 3);
  assert_covers(plan, 240); /* 0-2 again, both ends at one of them: 50; an end at each would take
                               0-1 and 2-3 again: 60 */
  thread_plan_free(plan);
  thread_frame_free(frame);
}
END_TEST

START_TEST(plans_are_written_and_read)
{
  thread_error err;
  thread_plan *plan, *again;
  thread_frame *frame = square();
  char *json, *second;
  size_t n, m;
  const thread_plan_options one = one_cord();
  ck_assert_int_eq((int)thread_plan_make(frame, &one, &plan, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_eval(plan, "capstan", 0, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_check(plan, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_write(plan, &json, &n, &err), THREAD_OK);
  ck_assert_msg(thread_plan_parse(json, n, NULL, &again, &err) == THREAD_OK, "%s", err.text);
  ck_assert_int_eq((int)thread_plan_write(again, &second, &m, &err), THREAD_OK);
  ck_assert(n == m && memcmp(json, second, n) == 0);
  thread_plan_free(again);
  thread_free(second);
  char *length = strstr(json, "\"length\": 240");
  ck_assert_ptr_nonnull(length);
  length[11] = '1'; /* 140: a lie */
  thread_status st = thread_plan_parse(json, n, NULL, &again, &err);
  if (st == THREAD_OK) st = thread_check(again, &err);
  ck_assert_int_eq((int)st, THREAD_VIOLATED);
  thread_plan_free(again);
  thread_free(json);
  thread_plan_free(plan);
  thread_frame_free(frame);
}
END_TEST

START_TEST(frames_are_written_and_read)
{
  static const char *const formats[] = {"json", "obj", "csv", "ply"};
  thread_error err;
  thread_frame *frame = square(), *again;
  ck_assert_str_eq(thread_frame_notes(frame), "");
  ck_assert_int_eq((int)thread_frame_set_feet_where(frame, "below=1km", &err), THREAD_OK);
  ck_assert_int_eq((int)thread_frame_set_feet_where(frame, "top", &err), THREAD_BAD_INPUT);
  ck_assert_str_eq(err.text, "top: expected lowest, rim or below=HEIGHT");
  ck_assert_int_eq((int)thread_frame_set_feet(frame, 2, (const int[]){0, 2}, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_frame_set_passes(frame, 4, 2, 3, &err), THREAD_OK);
  for (int i = 0; i < 4; i++) {
    char *bytes, name[16];
    const double *a, *b;
    size_t n;
    snprintf(name, sizeof name, "x.%s", formats[i]);
    ck_assert_int_eq((int)thread_frame_write(frame, formats[i], &bytes, &n, &err), THREAD_OK);
    ck_assert_msg(thread_frame_parse(bytes, n, name, NULL, &again, &err) == THREAD_OK, "%s",
                  err.text);
    ck_assert_int_eq(thread_frame_nodes(again, &a), thread_frame_nodes(frame, &b));
    ck_assert_int_eq(thread_frame_edges(again, NULL), 5);
    ck_assert(memcmp(a, b, sizeof square_xyz) == 0);
    ck_assert_int_eq(thread_frame_find(again, thread_frame_name(again, 3)), 3);
    thread_frame_free(again);
    thread_free(bytes);
  }
  ck_assert_ptr_null(thread_frame_name(frame, 4));
  ck_assert_int_eq(thread_frame_find(frame, "nobody"), -1);
  thread_frame_free(frame);
}
END_TEST

START_TEST(notes_say_what_was_merged)
{
  thread_error err;
  thread_frame *frame;
  static const char csv[] = "0,0,0,10,0,0\n10,0,0,10,10,0\n10,0,0,0,0,0\n50,0,0,60,0,0\n";
  thread_read_options o;
  thread_read_options_init(&o, sizeof o);
  o.scale = 2;
  ck_assert_msg(thread_frame_parse(csv, strlen(csv), "a.csv", &o, &frame, &err) == THREAD_OK, "%s",
                err.text);
  ck_assert_int_eq(thread_frame_edges(frame, NULL), 3);
  ck_assert_ptr_nonnull(
      strstr(thread_frame_notes(frame), "1 edge that was there already dropped\n"));
  ck_assert_ptr_nonnull(strstr(thread_frame_notes(frame), "2 separate components"));
  const double *xyz;
  thread_frame_nodes(frame, &xyz);
  ck_assert_double_eq(xyz[3], 20);
  thread_frame_free(frame);
  static const char cross[] = "0,0,0,20,0,0\n10,0,0,10,10,0\n"; /* a T whose bar is one edge */
  ck_assert_int_eq((int)thread_frame_parse(cross, strlen(cross), "t.csv", NULL, &frame, &err),
                   THREAD_OK);
  ck_assert_ptr_nonnull(strstr(thread_frame_notes(frame), ": split cuts such edges\n"));
  ck_assert_ptr_null(strstr(thread_frame_notes(frame), "--"));
  thread_frame_free(frame);
  thread_read_options_init(&o, sizeof o);
  o.split = 1;
  ck_assert_msg(thread_frame_parse(cross, strlen(cross), "t.csv", &o, &frame, &err) == THREAD_OK,
                "%s", err.text);
  ck_assert_int_eq(thread_frame_edges(frame, NULL), 3);
  thread_frame_free(frame);
}
END_TEST

START_TEST(what_is_wrong_is_said)
{
  thread_error err;
  thread_frame *frame = NULL, *good = square();
  thread_plan *plan = NULL;
  char *bytes = NULL;
  thread_plan_options o;
  thread_read_options r;
  const double twice[] = {0, 0, 0, 0, 0, 0};
  const int edge[] = {0, 1}, far[] = {0, 7}, doubled[] = {0, 1, 1, 0};
  assert_refused(thread_frame_make(2, twice, 1, edge, NULL, &frame, &err), THREAD_BAD_INPUT, &err,
                 frame, "");
  assert_refused(thread_frame_make(2, square_xyz, 1, far, NULL, &frame, &err), THREAD_BAD_INPUT,
                 &err, frame, "7");
  assert_refused(thread_frame_make(2, square_xyz, 2, doubled, NULL, &frame, &err), THREAD_BAD_INPUT,
                 &err, frame, "twice: 0 and 1 join node 1 to node 0");
  assert_refused(thread_frame_make(3, square_xyz, 1, edge, NULL, &frame, &err), THREAD_BAD_INPUT,
                 &err, frame, "no edge");
  assert_refused(thread_frame_make(2, square_xyz, 1, edge, "furlong", &frame, &err),
                 THREAD_BAD_INPUT, &err, frame, "furlong");
  assert_refused(thread_frame_make(0, NULL, 0, NULL, NULL, &frame, &err), THREAD_BAD_INPUT, &err,
                 frame, "");
  assert_refused(thread_frame_shape("cube", 0, &frame, &err), THREAD_BAD_INPUT, &err, frame,
                 "cube");
  assert_refused(thread_frame_shape("dome", 1, &frame, &err), THREAD_BAD_INPUT, &err, frame,
                 "size");
  assert_refused(thread_frame_read("no/such.obj", NULL, &frame, &err), THREAD_IO, &err, frame,
                 "no/such.obj");
  assert_refused(thread_frame_parse("v 1 2 x\n", 8, "a.obj", NULL, &frame, &err), THREAD_BAD_INPUT,
                 &err, frame, "a.obj:1");
  thread_read_options_init(&r, sizeof r);
  r.up = 'x';
  assert_refused(thread_frame_parse("0,1\n", 4, "a.csv", &r, &frame, &err), THREAD_BAD_INPUT, &err,
                 frame, "up");
  memset(&o, 0, sizeof o); /* nobody called init */
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan,
                 "thread_plan_options_init");
  thread_plan_options_init(&o, sizeof o);
  o.aims = "beauty";
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan, "beauty");
  o.aims = NULL;
  o.physics = "{\"mu\": -1}";
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan, "mu");
  o.physics = NULL;
  o.request = "{\"objective\": \"length\"";
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan, "request");
  o.request = NULL;
  o.cover = 3;
  o.capacity = 2;
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan, "cover");
  o.capacity = 0;
  o.gap = 101;
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan, "gap");
  o.gap = (double)NAN;
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan, "gap");
  o.gap = -1;
  o.cords = 0; /* not said is less than that */
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan,
                 "cords: 0 is not 1 to 1000");
  assert_refused(thread_report(good, "advice", &o, &bytes, NULL, &err), THREAD_BAD_INPUT, &err,
                 bytes, "cords: 0");
  o.cords = 1;
  o.cover = o.capacity = 1; /* the odd nodes need an extra pass */
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_INFEASIBLE, &err, plan, "");
  ck_assert_ptr_null(strstr(err.text, "--"));
  o.cover = 1;
  o.capacity = 0;
  o.ends = THREAD_FEET; /* the frame has none */
  assert_refused(thread_plan_make(good, &o, &plan, &err), THREAD_INFEASIBLE, &err, plan,
                 "thread_frame_set_feet");
  ck_assert_ptr_null(strstr(err.text, "--"));
  assert_refused(thread_plan_parse("{}", 2, "p.json", &plan, &err), THREAD_BAD_INPUT, &err, plan,
                 "p.json");
  assert_refused(thread_frame_write(good, "step", &bytes, NULL, &err), THREAD_BAD_INPUT, &err,
                 bytes, "step");
  ck_assert_int_eq((int)thread_frame_set_feet(good, 1, (const int[]){4}, &err), THREAD_BAD_INPUT);
  ck_assert_int_eq((int)thread_frame_set_passes(good, 5, 1, 0, &err), THREAD_BAD_INPUT);
  ck_assert_int_eq((int)thread_frame_set_passes(good, 0, 2, 1, NULL), THREAD_BAD_INPUT);
  ck_assert_int_eq((int)thread_plan_make(good, NULL, &plan, NULL), THREAD_OK);
  assert_refused(thread_draw(plan, "oil", &bytes, NULL, &err), THREAD_BAD_INPUT, &err, bytes,
                 "oil");
  ck_assert_int_eq((int)thread_eval(plan, "guess", 0, &err), THREAD_BAD_INPUT);
  thread_plan_free(plan);
  thread_frame_free(good);
  thread_frame_free(NULL);
  thread_plan_free(NULL);
  thread_free(NULL);
}
END_TEST

START_TEST(programs_of_older_and_newer_headers_go_on_working)
{
  struct {
    thread_plan_options known;
    char later[64];
  } newer;
  thread_error err;
  thread_frame *frame = square();
  thread_plan *plan;
  const size_t small = offsetof(thread_plan_options, cover);
  thread_plan_options older;
  thread_summary part;
  memset(&older, 0xAA, sizeof older); /* what such a program has behind its own struct */
  thread_plan_options_init(&older, small);
  ck_assert_int_eq(older.cover, (int)0xAAAAAAAA);
  older.cords = 1;
  ck_assert_msg(thread_plan_make(frame, &older, &plan, &err) == THREAD_OK, "%s", err.text);
  assert_covers(plan, 240);
  memset(&part, 0xAA, sizeof part);
  ck_assert_int_eq((int)thread_plan_summary(plan, &part, offsetof(thread_summary, bound), &err),
                   THREAD_OK);
  ck_assert_double_eq_tol(part.length, 240, 1e-9);
  ck_assert_int_eq(part.passes, (int)0xAAAAAAAA);
  thread_plan_free(plan);
  thread_plan_options_init(&newer.known, sizeof newer);
  newer.known.cords = 1;
  ck_assert_msg(thread_plan_make(frame, &newer.known, &plan, &err) == THREAD_OK, "%s", err.text);
  thread_plan_free(plan);
  thread_frame_free(frame);
}
END_TEST

/* The largest turning of four cords through a dome is not proved in a fifth of a second, but some
 * bound is at hand. */
START_TEST(a_gap_ends_a_search)
{
  static const double gap[] = {0, 100};
  thread_error err;
  thread_frame *frame;
  ck_assert_msg(thread_frame_shape("dome", 8, &frame, &err) == THREAD_OK, "%s", err.text);
  for (int i = 0; i < 2; i++) {
    thread_plan_options o;
    thread_plan *plan = NULL;
    char *json;
    size_t n;
    thread_plan_options_init(&o, sizeof o);
    o.aims = "max-turning";
    o.ends = THREAD_ANY;
    o.cords_least = o.cords = 4;
    o.seconds = i ? 5 : 0.2;
    o.gap = gap[i];
    thread_status st = thread_plan_make(frame, &o, &plan, &err);
    ck_assert_int_eq((int)st, i ? THREAD_OK : THREAD_NOT_PROVED);
    ck_assert_ptr_nonnull(plan);
    ck_assert_int_eq((int)thread_check(plan, &err), THREAD_OK);

    /* The plan says what was asked for. */
    ck_assert_int_eq((int)thread_plan_write(plan, &json, &n, &err), THREAD_OK);
    ck_assert_ptr_nonnull(strstr(json, i ? "\"gap\": 100" : "\"gap\": 0"));
    thread_free(json);
    thread_plan_free(plan);
  }
  thread_frame_free(frame);
}
END_TEST

/* "options" of a plan's JSON, which the caller frees. */
static char *request_of(const thread_plan *plan)
{
  char *json, *end;
  size_t n;
  ck_assert_int_eq((int)thread_plan_write(plan, &json, &n, NULL), THREAD_OK);
  char *options = strstr(json, "\"options\":");
  ck_assert_ptr_nonnull(options);
  options += strlen("\"options\":");
  int depth = 0;
  for (end = options; *end; end++) {
    depth += *end == '{';
    if (*end == '}' && --depth == 0) break;
  }
  end[1] = '\0';
  memmove(json, options, strlen(options) + 1);
  return json;
}

START_TEST(a_plan_is_made_again_by_its_own_request)
{
  thread_error err;
  thread_frame *frame;
  thread_plan *plan, *again;
  thread_plan_options o;
  char *first, *second;
  ck_assert_int_eq((int)thread_frame_shape("dome", 4, &frame, &err), THREAD_OK);
  thread_plan_options_init(&o, sizeof o);
  o.cords_least = o.cords = 2;
  o.ends = THREAD_FEET;
  o.physics = "{\"mu\": 0.25}";
  ck_assert_msg(thread_plan_make(frame, &o, &plan, &err) == THREAD_OK, "%s", err.text);
  ck_assert_int_eq(thread_plan_cords(plan), 2);
  char *request = request_of(plan);
  thread_plan_options_init(&o, sizeof o);
  o.request = request;
  ck_assert_msg(thread_plan_make(frame, &o, &again, &err) == THREAD_OK, "%s", err.text);
  ck_assert_int_eq((int)thread_plan_write(plan, &first, NULL, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_write(again, &second, NULL, &err), THREAD_OK);
  ck_assert_str_eq(first, second);
  thread_free(first);
  thread_free(second);
  thread_free(request);
  thread_plan_free(plan);
  thread_plan_free(again);
  thread_frame_free(frame);
}
END_TEST

static int stop_at_once(void *user, const char *what, double best, double bound)
{
  (void)best;
  (void)bound;
  ck_assert_ptr_nonnull(what);
  ++*(int *)user;
  return 1;
}

START_TEST(a_listener_may_stop)
{
  int heard = 0;
  thread_error err;
  thread_frame *frame;
  thread_plan *plan;
  thread_plan_options o;
  ck_assert_int_eq((int)thread_frame_shape("dome", 8, &frame, &err), THREAD_OK);
  thread_plan_options_init(&o, sizeof o);
  o.aims = "max-turning";
  o.cords_least = o.cords = 4;
  o.ends = THREAD_FEET;
  o.seconds = 0;
  o.progress = stop_at_once;
  o.user = &heard;
  ck_assert_int_eq((int)thread_plan_make(frame, &o, &plan, &err), THREAD_NOT_PROVED);
  ck_assert_int_eq(heard, 1); /* who has said stop is not asked again */
  if (plan) ck_assert_int_eq((int)thread_check(plan, &err), THREAD_OK);
  thread_plan_free(plan);
  thread_frame_free(frame);
}
END_TEST

/* The longest silence, s; a call from another thread, or values that cannot be, fail. */
typedef struct {
  pthread_t caller;
  double at, gap;
  int calls, stop_at; /* the call that ends it, from 1; 0 = none */
} hearing;

static double seconds_now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int hear(void *user, const char *what, double best, double bound)
{
  hearing *h = user;
  const double now = seconds_now();
  ck_assert(pthread_equal(h->caller, pthread_self()) && *what && bound <= best && bound >= 0);
  h->gap = fmax(h->gap, now - h->at);
  h->at = now;
  return ++h->calls == h->stop_at;
}

/* Searches whose time goes into simplex pivots, blossoms, groups, exchanges and walks. The bound on
 * the silence is generous, as machines are busy; a search that tells nothing takes longer. */
START_TEST(whoever_listens_hears_of_every_search)
{
  static const struct {
    const char *aims;
    int cords, tube;
    thread_ends ends;
    double max_pull, max_length;
  } search[] = {{.cords = -1, .ends = THREAD_UNSAID},
                {"turning", 4, .ends = THREAD_FEET},
                {"max-turning", 4, .ends = THREAD_FEET},
                {"pull", 3, .ends = THREAD_ANY},
                {"longest", 20, .ends = THREAD_ANY},
                {"overlap,steps", -1, .ends = THREAD_ANY},
                {"length", 1, .tube = 1, .ends = THREAD_ANY},
                {NULL, 6, .ends = THREAD_ANY, .max_length = 600}};
  thread_error err;
  thread_frame *frame;
  ck_assert_int_eq((int)thread_frame_shape("dome", 7, &frame, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_frame_set_feet(frame, -1, NULL, &err), THREAD_OK);
  for (size_t i = 0; i < sizeof search / sizeof *search; i++) {
    hearing h = {.caller = pthread_self(), .at = seconds_now()};
    thread_plan_options o;
    thread_plan *plan;
    thread_plan_options_init(&o, sizeof o);
    o.aims = search[i].aims;
    o.cords = search[i].cords;
    if (search[i].max_length > 0) o.cords_least = 1;
    o.tube = search[i].tube;
    o.ends = search[i].ends;
    o.max_length = search[i].max_length;
    o.seconds = 1.5;
    o.progress = hear;
    o.user = &h;
    const double began = seconds_now();
    const thread_status st = thread_plan_make(frame, &o, &plan, &err);
    const double took = seconds_now() - began;
    ck_assert_msg(st == THREAD_OK || st == THREAD_NOT_PROVED || st == THREAD_INFEASIBLE, "%zu: %s",
                  i, err.text);
    if (plan) ck_assert_msg(thread_check(plan, &err) == THREAD_OK, "%zu: %s", i, err.text);
    ck_assert_msg(h.calls >= 1 + (int)(took / 1) && h.gap < 1, "%zu: %d calls in %g s, gap %g s", i,
                  h.calls, took, h.gap);
    thread_plan_free(plan);
  }
  thread_frame_free(frame);
}
END_TEST

/* A call takes the time that it is given, whatever it is asked: a tenth and 0.2 s more, and here as
 * much again for a busy machine. What is recommended says if it is beyond a
 * hand's force by then. */
START_TEST(seconds_are_kept)
{
  static const char *const aims[] = {NULL, "max-turning", "longest", "overlap,steps"};
  static const double seconds[] = {0.5, 1};
  thread_error err;
  thread_frame *frame;
  ck_assert_int_eq((int)thread_frame_shape("dome", 16, &frame, &err), THREAD_OK);
  for (int i = 0; i < 10; i++) {
    const double time = seconds[i % 2], began = seconds_now();
    thread_plan_options o;
    thread_plan *plan = NULL;
    char *bytes = NULL;
    thread_plan_options_init(&o, sizeof o);
    o.seconds = time;
    if (i < 8) {
      o.aims = aims[i / 2];
      o.cords = i < 2 ? -1 : 4;
    }
    const thread_status st = i < 8 ? thread_plan_make(frame, &o, &plan, &err)
                                   : thread_report(frame, "advice", &o, &bytes, NULL, &err);
    const double took = seconds_now() - began;
    ck_assert_msg(st == THREAD_OK || st == THREAD_NOT_PROVED, "%d: %s", i, err.text);
    ck_assert_msg(took < 2 * (1.1 * time + 0.2), "%d: %g s of %g", i, took, time);
    if (plan && i < 2) {
      thread_summary s;
      thread_plan_summary(plan, &s, sizeof s, NULL);
      ck_assert_msg(st == THREAD_NOT_PROVED && s.stopped == 1, "%d", i);
      ck_assert_msg(s.pull <= 10 || strstr(err.text, "of a hand"), "%g N: %s", s.pull, err.text);
    }
    if (plan) ck_assert_msg(thread_check(plan, &err) == THREAD_OK, "%d: %s", i, err.text);
    thread_free(bytes);
    thread_plan_free(plan);
  }
  thread_frame_free(frame);
}
END_TEST

/* Whoever listens gets the same plan as whoever does not. */
START_TEST(listening_changes_nothing)
{
  thread_error err;
  thread_frame *frame;
  char *json[2], *svg[2];
  ck_assert_int_eq((int)thread_frame_shape("dome", 5, &frame, &err), THREAD_OK);
  for (int listens = 0; listens < 2; listens++) {
    hearing h = {.caller = pthread_self(), .at = seconds_now()};
    thread_plan_options o;
    thread_plan *plan;
    thread_plan_options_init(&o, sizeof o);
    o.progress = listens ? hear : NULL;
    o.user = &h;
    ck_assert_msg(thread_plan_make(frame, &o, &plan, &err) == THREAD_OK, "%s", err.text);
    ck_assert_msg(thread_eval_with(plan, "structure", &o, &err) == THREAD_OK, "%s", err.text);
    ck_assert_int_eq((int)thread_plan_write(plan, &json[listens], NULL, &err), THREAD_OK);
    ck_assert_int_eq((int)thread_draw_with(plan, "svg", &o, &svg[listens], NULL, &err), THREAD_OK);
    ck_assert_int_eq(h.calls > 0, listens);
    thread_plan_free(plan);
  }
  ck_assert_str_eq(json[0], json[1]);
  ck_assert_str_eq(svg[0], svg[1]);
  for (int i = 0; i < 2; i++) {
    thread_free(json[i]);
    thread_free(svg[i]);
  }
  thread_frame_free(frame);
}
END_TEST

/* A search that would take minutes ends soon after the call that says so. */
START_TEST(a_listener_may_stop_at_any_call)
{
  static const int stop_at[] = {1, 2, 5, 20};
  thread_error err;
  thread_frame *frame;
  ck_assert_int_eq((int)thread_frame_shape("dome", 10, &frame, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_frame_set_feet(frame, -1, NULL, &err), THREAD_OK);
  for (int i = 0; i < 4; i++) {
    hearing h = {.caller = pthread_self(), .at = seconds_now(), .stop_at = stop_at[i]};
    thread_plan_options o;
    thread_plan *plan;
    thread_plan_options_init(&o, sizeof o);
    o.aims = "max-turning";
    o.cords = 3;
    o.ends = THREAD_FEET;
    o.seconds = 0;
    o.gap = 0;
    o.progress = hear;
    o.user = &h;
    ck_assert_int_eq((int)thread_plan_make(frame, &o, &plan, &err), THREAD_NOT_PROVED);
    ck_assert_msg(strstr(err.text, "stopped by progress") != NULL, "%s", err.text);
    ck_assert_msg(h.calls >= stop_at[i] && seconds_now() - h.at < 10, "%d calls", h.calls);
    if (plan) ck_assert_msg(thread_check(plan, &err) == THREAD_OK, "%s", err.text);
    thread_plan_free(plan);
  }
  thread_frame_free(frame);
}
END_TEST

/* Nothing said: what a hand can pull, from the best ends. A number of cords alone: exactly so many.
 */
START_TEST(what_is_not_said_is_chosen_well)
{
  thread_error err;
  thread_frame *frame;
  thread_plan *plan;
  thread_cord cord;
  thread_plan_options o;
  ck_assert_int_eq((int)thread_frame_shape("dome", 7, &frame, &err), THREAD_OK);
  ck_assert_msg(thread_plan_make(frame, NULL, &plan, &err) == THREAD_OK, "%s", err.text);
  ck_assert_int_gt(thread_plan_cords(plan), 1);
  for (int i = 0; i < thread_plan_cords(plan); i++) {
    const int *node;
    ck_assert_int_eq((int)thread_plan_cord_summary(plan, i, &cord, sizeof cord, &err), THREAD_OK);
    ck_assert(cord.pull_start <= 10 && cord.pull_end <= 10 && cord.grips == 0);
    ck_assert_int_eq(thread_plan_cord(plan, i, &node), cord.passes);
    ck_assert_ptr_eq(node, cord.node);
  }
  thread_plan_free(plan);

  thread_plan_options_init(&o, sizeof o);
  o.cords = 4;
  ck_assert_msg(thread_plan_make(frame, &o, &plan, &err) == THREAD_OK, "%s", err.text);
  ck_assert_int_eq(thread_plan_cords(plan), 4);
  thread_plan_free(plan);

  /* A hand of one end a cord at four nodes. */
  int n = thread_frame_nodes(frame, NULL), *count = calloc((size_t)n, sizeof *count);
  ck_assert_ptr_nonnull(count);
  count[0] = count[6] = 1;
  count[n - 1] = 2;
  thread_plan_options_init(&o, sizeof o);
  o.ends = THREAD_COUNTS;
  o.end_count = count;
  ck_assert_msg(thread_plan_make(frame, &o, &plan, &err) == THREAD_OK, "%s", err.text);
  ck_assert_int_eq(thread_plan_cords(plan), 2);
  for (int i = 0; i < 2; i++) {
    thread_plan_cord_summary(plan, i, &cord, sizeof cord, &err);
    count[cord.from]--;
    count[cord.to]--;
  }
  ck_assert(count[0] == 0 && count[6] == 0 && count[n - 1] == 0);
  thread_plan_free(plan);
  count[0] = 1;
  plan = NULL;
  assert_refused(thread_plan_make(frame, &o, &plan, &err), THREAD_INFEASIBLE, &err, plan, "ends: ");
  o.end_count = NULL;
  assert_refused(thread_plan_make(frame, &o, &plan, &err), THREAD_BAD_INPUT, &err, plan,
                 "end_count");
  free(count);
  thread_frame_free(frame);
}
END_TEST

/* What is said of a plan is of its last evaluation. */
START_TEST(a_summary_is_of_the_last_evaluation)
{
  static const char *const method[] = {"capstan", "structure", "capstan"};
  thread_error err;
  thread_frame *frame;
  thread_plan *plan;
  double pull[3];
  ck_assert_int_eq((int)thread_frame_shape("dome", 4, &frame, &err), THREAD_OK);
  ck_assert_msg(thread_plan_make(frame, NULL, &plan, &err) == THREAD_OK, "%s", err.text);
  for (int m = 0; m < 3; m++) {
    thread_summary s;
    double largest = 0;
    ck_assert_msg(thread_eval(plan, method[m], 0, &err) == THREAD_OK, "%s", err.text);
    ck_assert_int_eq((int)thread_plan_summary(plan, &s, sizeof s, &err), THREAD_OK);
    for (int i = 0; i < thread_plan_cords(plan); i++) {
      thread_cord cord;
      thread_plan_cord_summary(plan, i, &cord, sizeof cord, &err);
      largest = fmax(largest, fmax(cord.pull_start, cord.pull_end));
    }
    ck_assert_double_eq_tol(s.pull, largest, 1e-9 * largest);
    pull[m] = s.pull;
  }
  ck_assert_double_eq(pull[0], pull[2]);
  thread_plan_free(plan);
  thread_frame_free(frame);
}
END_TEST

START_TEST(reports_say_what_a_frame_allows)
{
  static const char *const what[] = {"advice", "symmetries"}, *const word[] = {"\"recommended\": ",
                                                                               "\"groups\": ["};
  thread_error err;
  thread_frame *frame;
  thread_plan_options o;
  char *bytes;
  size_t n;
  ck_assert_int_eq((int)thread_frame_shape("dome", 4, &frame, &err), THREAD_OK);
  thread_plan_options_init(&o, sizeof o);
  for (int i = 0; i < 2; i++) {
    const thread_status st = thread_report(frame, what[i], &o, &bytes, &n, &err);
    ck_assert_msg(st == THREAD_OK || (i && st == THREAD_NOT_PROVED), "%s", err.text);
    ck_assert_ptr_nonnull(bytes);
    o.seconds = 2;
    ck_assert(strlen(bytes) == n && strstr(bytes, word[i]) && strstr(bytes, "\"edges\": 24"));
    ck_assert_ptr_null(strstr(bytes, "command"));
    thread_free(bytes);
  }
  bytes = NULL;
  assert_refused(thread_report(frame, "row", NULL, &bytes, &n, &err), THREAD_BAD_INPUT, &err, bytes,
                 "cords");
  assert_refused(thread_report(frame, "weather", NULL, &bytes, &n, &err), THREAD_BAD_INPUT, &err,
                 bytes, "weather");
  thread_frame_free(frame);
}
END_TEST

/* Reports of plans: the best of each row, ranks; whoever stops one hears no more of it soon. */
START_TEST(reports_say_what_plans_are_worth)
{
  thread_error err;
  thread_frame *frame, *other;
  thread_plan *plan[3];
  char *bytes;
  size_t n;
  const thread_plan_options one = one_cord();
  ck_assert_int_eq((int)thread_frame_shape("dome", 4, &frame, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_frame_shape("dome", 3, &other, &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_make(frame, &one, &plan[0], &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_make(frame, NULL, &plan[1], &err), THREAD_OK);
  ck_assert_int_eq((int)thread_plan_make(other, NULL, &plan[2], &err), THREAD_OK);
  const thread_plan *const *plans = (const thread_plan *const *)plan;

  ck_assert_msg(thread_report_plans(plans, 2, "compare capstan", NULL, &bytes, &n, &err) ==
                    THREAD_OK,
                "%s", err.text);
  ck_assert(strlen(bytes) == n && strstr(bytes, "{\"plan\": \"plan 2\", \"framework\": "));
  ck_assert_ptr_nonnull(strstr(bytes, "\"order\": [{\"plan\": \"plan 2\", "));
  thread_free(bytes);

  /* Time and progress end them, whatever there is by then. */
  static const char *const what[] = {"rise", "compare rise", "compare"};
  for (int i = 0; i < 6; i++) {
    hearing h = {.caller = pthread_self(), .at = seconds_now(), .stop_at = i % 2 ? 8 : 0};
    thread_plan_options o;
    thread_plan_options_init(&o, sizeof o);
    o.seconds = i % 2 ? 0 : 1;
    o.progress = hear;
    o.user = &h;
    const double began = seconds_now();
    const thread_status st =
        thread_report_plans(plans, i / 2 ? 2 : 1, what[i / 2], &o, &bytes, &n, &err);
    const double now = seconds_now();
    ck_assert_msg(st == THREAD_NOT_PROVED || (st == THREAD_OK && bytes), "%s: %s", what[i / 2],
                  err.text);
    ck_assert_msg(h.gap < 1 && (i % 2 ? now - h.at < 1 : now - began < 2.6), "%s: %g s, gap %g s",
                  what[i / 2], now - began, h.gap);
    ck_assert(!bytes || strlen(bytes) == n);
    thread_free(bytes);
  }

  bytes = NULL;
  assert_refused(thread_report_plans(plans, 2, "rise", NULL, &bytes, &n, &err), THREAD_BAD_INPUT,
                 &err, bytes, "not of 2");
  assert_refused(thread_report_plans(plans, 3, "compare capstan", NULL, &bytes, &n, &err),
                 THREAD_BAD_INPUT, &err, bytes, "plan 3 is for another framework");
  assert_refused(thread_report_plans(plans, 0, "compare", NULL, &bytes, &n, &err), THREAD_BAD_INPUT,
                 &err, bytes, "not of 0");
  assert_refused(thread_report_plans(plans, 1, "advice", NULL, &bytes, &n, &err), THREAD_BAD_INPUT,
                 &err, bytes, "advice");
  for (int i = 0; i < 3; i++)
    thread_plan_free(plan[i]);
  thread_frame_free(frame);
  thread_frame_free(other);
}
END_TEST

static void *plan_a_dome(void *user)
{
  thread_frame *frame;
  thread_plan *plan;
  char **json = user;
  if (thread_frame_shape("dome", 5, &frame, NULL) == THREAD_OK &&
      thread_plan_make(frame, NULL, &plan, NULL) == THREAD_OK &&
      thread_check(plan, NULL) == THREAD_OK &&
      thread_plan_write(plan, json, NULL, NULL) == THREAD_OK) {
    thread_plan_free(plan);
    thread_frame_free(frame);
  }
  return NULL;
}

START_TEST(threads_plan_the_same)
{
  enum { N = 4 };
  pthread_t thread[N];
  char *json[N] = {NULL};
  for (int i = 0; i < N; i++)
    ck_assert_int_eq(pthread_create(&thread[i], NULL, plan_a_dome, &json[i]), 0);
  for (int i = 0; i < N; i++) {
    pthread_join(thread[i], NULL);
    ck_assert_ptr_nonnull(json[i]);
    ck_assert_str_eq(json[i], json[0]);
  }
  for (int i = 0; i < N; i++)
    thread_free(json[i]);
}
END_TEST

/* One after another, every allocation fails once. */
START_TEST(memory_may_run_out)
{
  thread_status st = THREAD_NO_MEMORY;
  long k = 0;
  const thread_plan_options one = one_cord();
  while (st == THREAD_NO_MEMORY) {
    thread_frame *frame = NULL;
    thread_plan *plan = NULL;
    thread_error err;
    char *bytes = NULL;
    thr_alloc_fail_once(++k);
    st = thread_frame_make(4, square_xyz, 5, square_ends, NULL, &frame, &err);
    if (!st) st = thread_plan_make(frame, &one, &plan, &err);
    if (!st)
      st = thread_report_plans((const thread_plan *const *)&plan, 1, "compare capstan", NULL,
                               &bytes, NULL, &err);
    thread_free(bytes);
    bytes = NULL;
    if (!st) st = thread_draw(plan, "cords.csv", &bytes, NULL, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THREAD_OK || st == THREAD_NO_MEMORY, "allocation %ld: %d %s", k, (int)st,
                  err.text);
    ck_assert((st == THREAD_OK) == (bytes != NULL));
    thread_free(bytes);
    thread_plan_free(plan);
    thread_frame_free(frame);
  }
  ck_assert_int_gt(k, 50);
}
END_TEST

START_TEST(it_says_what_it_is)
{
  ck_assert_int_eq(thread_version(), THREAD_VERSION);
  ck_assert_ptr_nonnull(strstr(thread_libraries(), "GLPK"));
}
END_TEST

int main(void)
{
  Suite *s = suite_create("library");
  ADD_TEST(s, 60, whoever_listens_hears_of_every_search);
  ADD_TEST(s, 60, seconds_are_kept);
  ADD_TEST(s, 60, listening_changes_nothing);
  ADD_TEST(s, 60, a_listener_may_stop_at_any_call);
  ADD_TEST(s, 20, what_is_not_said_is_chosen_well);
  ADD_TEST(s, 20, a_summary_is_of_the_last_evaluation);
  ADD_TEST(s, 100, reports_say_what_a_frame_allows);
  ADD_TEST(s, 60, reports_say_what_plans_are_worth);
  ADD_TEST(s, 20, a_dome_is_planned_checked_and_drawn);
  ADD_TEST(s, 20, cords_say_what_they_are);
  ADD_TEST(s, 20, by_hand);
  ADD_TEST(s, 20, plans_are_written_and_read);
  ADD_TEST(s, 20, frames_are_written_and_read);
  ADD_TEST(s, 20, notes_say_what_was_merged);
  ADD_TEST(s, 20, what_is_wrong_is_said);
  ADD_TEST(s, 20, programs_of_older_and_newer_headers_go_on_working);
  ADD_TEST(s, 20, a_gap_ends_a_search);
  ADD_TEST(s, 20, a_plan_is_made_again_by_its_own_request);
  ADD_TEST(s, 60, a_listener_may_stop);
  ADD_TEST(s, 20, threads_plan_the_same);
  ADD_TEST(s, 20, memory_may_run_out);
  ADD_TEST(s, 20, it_says_what_it_is);
  return run_suite(s);
}
