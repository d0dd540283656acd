/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/plans.h"
#include "graph/check/check.h"
#include "planner/planner_parts.h"
#include "tests/walks.h"

#include <stdlib.h>
#include <string.h>

/* ---- requests ---- */

void want(thr_request *o, const char *aims)
{
  thr_err err = {0};
  const thr_turning_options turning = o->turning;
  ck_assert_msg(thr_aims_parse(aims, o, &err) == THR_OK, "%s: %s", aims, err.text);
  o->turning = turning;
}

thr_status length_plan(const thr_frame *f, const thr_request *o, const thr_limits *limits,
                       thr_plan *p, thr_cords_word *word, thr_err *err)
{
  thr_report r = {0};
  thr_status st = thr_planner_length(f, o, limits, p, &r, err);
  if (word) *word = r.word;
  return st;
}

/* ---- plans ---- */

thr_request options_for(thr_ends ends, int cover)
{
  thr_request o = thr_request_default();
  o.ends = ends;
  o.cover = cover;
  return o;
}

thr_plan plan_make(const thr_frame *f, const thr_request *o)
{
  thr_plan p;
  thr_err err = {0};
  thr_limits none = {0};
  thr_status st = thr_postman_plan(f, o, &none, &p, &err);
  ck_assert_msg(st == THR_OK, "status %d: %s", (int)st, err.text);
  return p;
}

thr_plan plan_simple(const thr_frame *f, thr_ends ends, int cover)
{
  thr_request o = options_for(ends, cover);
  return plan_make(f, &o);
}

/* One closed walk (Hierholzer) over passes and links: from odd node v a link leads to link[v],
 * which is -1 elsewhere. walk receives half-edges, and -1 for a link; left and link are used up.
 * Returns how many. */
static int euler_walk(const thr_frame *f, int *left, int *link, int start, int room, int *walk)
{
  int *node = calloc((size_t)room + 1, sizeof *node),
      *came = calloc((size_t)room + 1, sizeof *came), top = 0, n = 0;
  ck_assert(node && came);
  node[0] = start;
  while (top >= 0) {
    int v = node[top], next = link[v], h = -1;
    if (next >= 0) {
      link[v] = link[next] = -1;
    } else {
      for (int i = f->first[v]; i < f->first[v + 1] && next < 0; i++)
        if (left[f->half[i] / 2] > 0) h = f->half[i], next = thr_head(f, h);
      if (next >= 0) left[h / 2]--;
    }
    if (next < 0) {
      if (top > 0)
        walk[n++] = came[top] < 0 ? -1 : came[top] ^ 1; /* the walk comes out backwards */
      top--;
      continue;
    }
    ck_assert_int_lt(top, room);
    node[++top] = next;
    came[top] = h;
  }
  free(node);
  free(came);
  return n;
}

static void add_piece(thr_plan *p, const int *half, int n)
{
  thr_cord *c = &p->cord[p->n_cords];
  ck_assert_int_gt(n, 0);
  *c = (thr_cord){.n_passes = n, .half = calloc((size_t)n, sizeof *c->half)};
  ck_assert(c->half != NULL);
  memcpy(c->half, half, (size_t)n * sizeof *half);
  c->closed = thr_cord_start(&p->frame, c) == thr_cord_end(&p->frame, c);
  thr_cord_id(p->n_cords++, c->id);
}

/* Cuts the walk at its links and, as long as more pieces are wanted, at the first places where an
 * end may be. */
static void cut_walk(thr_plan *p, const int *walk, int n, int n_links)
{
  int more = p->options.cords - (n_links ? n_links : 1), from = 0;
  for (int i = 0; i < n; i++) {
    bool link = i + 1 < n && walk[i + 1] < 0, last = i + 1 == n;
    if (walk[i] < 0) {
      from = i + 1;
    } else if (link || last ||
               (more > 0 && walks_may_end(&p->frame, &p->options, thr_head(&p->frame, walk[i])))) {
      more -= !link && !last;
      add_piece(p, walk + from, i + 1 - from);
      from = i + 1;
    }
  }
}

thr_plan plan_of_cords(const thr_frame *f, const thr_request *o)
{
  thr_plan p = {0};
  thr_shortest s;
  thr_err err = {0};
  int n_links = 0, room = 0, start = -1, *link = calloc((size_t)f->n_nodes, sizeof *link);
  assert_ok(thr_postman_shortest(f, o, &(thr_limits){0}, &s, &err), &err);
  ck_assert(link && thr_plan_request(&p, f, o, NULL) == THR_OK);
  for (int e = 0; e < f->n_edges; e++)
    room += s.passes[e];
  for (int v = 0, odd = -1; v < f->n_nodes; v++) {
    int sum = 0;
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      sum += s.passes[f->half[i] / 2];
    link[v] = -1;
    if (start < 0 && walks_may_end(f, o, v)) start = v;
    if (sum % 2 == 0) continue;
    if (odd >= 0)
      link[v] = odd, link[odd] = v, n_links++, odd = -1;
    else
      odd = v;
    start = v;
  }
  int *walk = calloc((size_t)(room + n_links) + 1, sizeof *walk),
      *left = calloc((size_t)f->n_edges, sizeof *left);
  p.cord = calloc((size_t)o->cords, sizeof *p.cord);
  ck_assert(walk && left && p.cord);
  memcpy(left, s.passes, (size_t)f->n_edges * sizeof *left);
  cut_walk(&p, walk, euler_walk(f, left, link, start, room + n_links, walk), n_links);
  ck_assert_int_eq(p.n_cords, o->cords);
  p.options.cords_least = o->cords;
  ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, p.n_cords, &p.metrics, NULL),
                   THR_OK);
  assert_ok(thr_postman_prove(&p.frame, &p.options, p.cord, p.n_cords, &s, &p.proof, &err), &err);
  thr_shortest_destroy(&s);
  free(walk);
  free(left);
  free(link);
  return p;
}

void add_loops(thr_cord *cord, int *n, int edge, int count)
{
  for (int i = 0; i < count; i++) {
    cord[*n] = (thr_cord){.closed = true, .n_passes = 2, .half = calloc(2, sizeof(int))};
    ck_assert_ptr_nonnull(cord[*n].half);
    thr_cord_id(*n, cord[*n].id);
    cord[*n].half[0] = 2 * edge;
    cord[(*n)++].half[1] = 2 * edge + 1;
  }
}

thr_text plan_text(const thr_plan *p)
{
  thr_text t = {0};
  thr_plan_write(p, &t);
  ck_assert(!t.failed && t.length > 0);
  return t;
}

thr_plan plan_from(const char *text)
{
  thr_plan p;
  thr_err err = {0};
  assert_ok(thr_plan_parse(&p, text, strlen(text), "plan", &err), &err);
  return p;
}

void assert_same_text(const thr_text *a, const thr_text *b)
{
  size_t i = 0;
  while (a->data[i] && a->data[i] == b->data[i])
    i++;
  ck_assert_msg(a->length == b->length && i == a->length,
                "texts differ from byte %d on: %.60s | %.60s", (int)i, a->data + i, b->data + i);
}

void assert_plan_sound(const thr_plan *p)
{
  thr_err err = {0};
  assert_ok(thr_check_plan(p, &err), &err);
  thr_text once = plan_text(p);
  thr_plan back = plan_from(once.data);
  assert_ok(thr_check_plan(&back, &err), &err);
  thr_text twice = plan_text(&back);
  assert_same_text(&once, &twice);
  thr_plan_destroy(&back);
  thr_text_destroy(&once);
  thr_text_destroy(&twice);
}

thr_status judge_text(const char *text, size_t n, thr_err *err)
{
  thr_plan p;
  thr_status st = thr_plan_parse(&p, text, n, "plan", err);
  if (!st) st = thr_check_plan(&p, err);
  thr_plan_destroy(&p);
  return st;
}

thr_status judge_plan(const thr_plan *p, thr_err *err)
{
  thr_text t = plan_text(p);
  thr_status st = judge_text(t.data, t.length, err);
  thr_text_destroy(&t);
  return st;
}

void assert_violated(const thr_plan *p, const char *word)
{
  thr_err err = {0};
  ck_assert_msg(thr_check_plan(p, &err) == THR_EVIOLATED, "%s", word);
  assert_one_line(&err, word);
  err = (thr_err){0};
  assert_status(judge_plan(p, &err), THR_EVIOLATED, &err, NULL);
}

void assert_holds(const thr_plan *p)
{
  thr_err err = {0};
  assert_ok(thr_check_plan(p, &err), &err);
}
