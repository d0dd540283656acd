/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed cords without crossing channels, against every shorter way to lead as many: walks over
 * every number of passes, which may not cross what went before. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <string.h>

enum { MOST_EDGES = 9, MOST_PASSES = 64, MOST_STEPS = 300000 };

typedef struct {
  const thr_frame *f;
  int rank[2 * MOST_EDGES], cords;
  int passes[MOST_EDGES]; /* that are left */
  int n;
  int channel[MOST_PASSES][2]; /* arms */
  double limit;
  int64_t steps;
} oracle;

static int between(const oracle *o, int arm, int a, int b)
{
  int low = o->rank[a] < o->rank[b] ? o->rank[a] : o->rank[b], high = o->rank[a] + o->rank[b] - low;
  return o->rank[arm] > low && o->rank[arm] < high;
}

static bool clashes(const oracle *o, int a, int b)
{
  for (int i = 0; i < o->n; i++) {
    const int c = o->channel[i][0], d = o->channel[i][1];
    if (thr_tail(o->f, c) != thr_tail(o->f, a) || a == b || c == d || a == c || a == d || b == c ||
        b == d)
      continue;
    if (between(o, c, a, b) != between(o, d, a, b)) return true;
  }
  return false;
}

static bool next_cord(oracle *o);

/* Goes on from half-edge at, of a cord that began with first. */
static bool walk(oracle *o, int first, int at)
{
  const int node = thr_head(o->f, at);
  if (++o->steps > MOST_STEPS) return false;
  o->channel[o->n][0] = at ^ 1;
  if (node == thr_tail(o->f, first) && !clashes(o, at ^ 1, first)) {
    o->channel[o->n++][1] = first;
    if (next_cord(o)) return true;
    o->n--;
  }
  for (int h = 0; h < 2 * o->f->n_edges; h++) {
    if (thr_tail(o->f, h) != node || o->passes[h >> 1] == 0 || clashes(o, at ^ 1, h)) continue;
    o->channel[o->n][0] = at ^ 1;
    o->channel[o->n++][1] = h;
    o->passes[h >> 1]--;
    if (walk(o, first, h)) return true;
    o->passes[h >> 1]++;
    o->n--;
  }
  return false;
}

/* Every closed cord over an edge may begin with that edge, in its direction. */
static bool next_cord(oracle *o)
{
  int e = 0;
  while (e < o->f->n_edges && o->passes[e] == 0)
    e++;
  if (e == o->f->n_edges || o->cords == 0) return e == o->f->n_edges && o->cords == 0;
  o->passes[e]--;
  o->cords--;
  if (walk(o, 2 * e, 2 * e)) return true;
  o->passes[e]++;
  o->cords++;
  return false;
}

/* Is there a way with fewer passes than the limit, the edges before e having theirs already? */
static bool is_shorter(oracle *o, const int *chosen, int e, double length)
{
  int passes[MOST_EDGES], degree[16] = {0}, cords = o->cords;
  if (length >= o->limit) return false;
  memcpy(passes, chosen, sizeof passes);
  if (e < o->f->n_edges) {
    for (; length < o->limit; length += o->f->length[e], passes[e]++)
      if (is_shorter(o, passes, e + 1, length)) return true;
    return false;
  }
  for (int i = 0; i < o->f->n_edges; i++) {
    degree[o->f->edge[i][0]] += passes[i];
    degree[o->f->edge[i][1]] += passes[i];
  }
  for (int v = 0; v < o->f->n_nodes; v++)
    if (degree[v] % 2) return false;
  memcpy(o->passes, passes, sizeof passes);
  o->n = 0;
  if (next_cord(o)) return true;
  o->cords = cords;
  return false;
}

START_TEST(closed_cords_are_as_short_as_without_crossings_they_can_be)
{
  rng r = rng_make((uint64_t)_i + 1);
  const int n = rng_between(&r, 4, 5);
  thr_err err = {0};
  thr_frame f =
      random_frame(&r, n, MOST_EDGES + 1 - n, _i % 2 ? LENGTHS_EUCLID : LENGTHS_SMALL_INTEGERS);
  thr_request request = thr_request_default();
  request.crossings = THR_CROSSINGS_FORBID;
  request.cords = request.cords_least = rng_between(&r, 2, 4);
  thr_plan plan;
  thr_status st = thr_plan_make(&f, &request, &(thr_limits){0}, &plan, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_int_eq(plan.n_cords, request.cords);
  ck_assert_int_eq(plan.metrics.crossings, 0);
  ck_assert_msg(!thr_check_plan(&plan, &err), "%s", err.text);

  int around[2 * MOST_EDGES], once[MOST_EDGES];
  double least = 0;
  oracle o = {.f = &f, .cords = request.cords, .limit = plan.metrics.length * (1 - 1e-9)};
  ck_assert_int_le(f.n_edges, MOST_EDGES);
  ck_assert_int_eq(thr_channels_around(&f, around, &err), THR_OK);
  for (int i = 0; i < 2 * f.n_edges; i++)
    o.rank[around[i]] = i;
  for (int e = 0; e < f.n_edges; e++) {
    once[e] = 1;
    least += f.length[e];
  }
  ck_assert_msg(!is_shorter(&o, once, 0, least),
                "example %d: %d cords are %g long, and need not be", _i, request.cords,
                plan.metrics.length);
  thr_plan_destroy(&plan);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("uncross least");
  ADD_EXAMPLES(s, 60, closed_cords_are_as_short_as_without_crossings_they_can_be, 400);
  return run_suite(s);
}
