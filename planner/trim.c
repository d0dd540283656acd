/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leaves off passes at the ends of cords that other cords make already.
 *
 * An edge with n passes that needs c of them can do without n - c. Where it can do without none,
 * its passes belong to the core of their cords. In front of a cord's core, and behind it, any
 * number of passes may go as long as the cord ends where ends may be. Which go is a search by
 * branch and bound over the cords' ends, longest piece first, so that the first leaf is a greedy
 * choice; no choice leaves off more than what all edges can do without.
 *
 * Example: two cords round one ring, 1 2 3 4 and 3 4 5 6: either leaves off 3 4. */
#include "graph/arrays.h"
#include "planner/planner_parts.h"

#include <math.h>
#include <string.h>

enum {
  MOST_CHOICES = 100000,
  MOST_DEEP = 10000 /* ends that are looked at: the search is recursive */
};

/* Ends 2 i and 2 i + 1 are the first and the last end of cord i. */
typedef struct {
  const thr_plan *plan;
  int *spare;      /* [n_edges] passes that an edge can do without now */
  int *cut, *best; /* [2 n_cords] passes left off at each end, now and in the best choice */
  int *most;       /* [2 n_cords] passes up to the core at most */
  double
      *rest; /* [2 n_cords + 1] length that these ends and all later ones can leave off at most */
  double removed, record,
      room; /* length left off now, in the best choice; that edges can still do without */
  long choices;
} trim_search;

/* Returns the k-th half-edge from an end, going inwards. */
static int pass_from(const trim_search *trimming, int end, int k)
{
  const thr_cord *cord = &trimming->plan->cord[end / 2];
  return end % 2 ? cord->half[cord->n_passes - 1 - k] : cord->half[k];
}

/* Returns the node where a cord ends once k passes are left off at an end. */
static int node_after(const trim_search *trimming, int end, int k)
{
  const int half = pass_from(trimming, end, k);
  return end % 2 ? thr_head(&trimming->plan->frame, half) : thr_tail(&trimming->plan->frame, half);
}

/* Chooses how much goes at this end and all later ones. */
static void choose(trim_search *trimming, int end)
{
  const thr_frame *frame = &trimming->plan->frame;
  if (trimming->removed > trimming->record * (1 + 1e-12)) {
    trimming->record = trimming->removed;
    memcpy(trimming->best, trimming->cut,
           2 * (size_t)trimming->plan->n_cords * sizeof *trimming->best);
    memset(trimming->best + end, 0,
           (2 * (size_t)trimming->plan->n_cords - (size_t)end) * sizeof *trimming->best);
  }
  while (end < 2 * trimming->plan->n_cords && trimming->most[end] == 0)
    end++;
  if (end == 2 * trimming->plan->n_cords || trimming->choices++ > MOST_CHOICES) return;
  if (trimming->removed + fmin(trimming->rest[end], trimming->room) <=
      trimming->record * (1 + 1e-12))
    return;

  /* Leaves off as much as the edges can do without; the cord keeps one pass. */
  const int keep =
      trimming->plan->cord[end / 2].n_passes - 1 - (end % 2 ? trimming->cut[end - 1] : 0);
  const double removed = trimming->removed, room = trimming->room;
  int k = 0;
  for (; k < trimming->most[end] && k < keep; k++) {
    const int e = pass_from(trimming, end, k) >> 1;
    if (trimming->spare[e] == 0) break;
    trimming->spare[e]--;
    trimming->removed += frame->length[e];
    trimming->room -= frame->length[e];
  }

  /* Takes passes back one by one, and goes on wherever the cord may end. */
  for (;; k--) {
    if (k == 0) {
      trimming->removed = removed;
      trimming->room = room;
    }
    if (k == 0 ||
        thr_plan_end_allowed(frame, &trimming->plan->options, node_after(trimming, end, k))) {
      trimming->cut[end] = k;
      choose(trimming, end + 1);
    }
    if (k == 0) break;
    const int e = pass_from(trimming, end, k - 1) >> 1;
    trimming->spare[e]++;
    trimming->removed -= frame->length[e];
    trimming->room += frame->length[e];
  }
  trimming->cut[end] = 0;
}

/* Counts what edges can do without, and what each end can leave off by that. */
static void prepare(trim_search *trimming)
{
  const thr_frame *frame = &trimming->plan->frame;

  /* Count the passes that no edge needs. */
  thr_cords_add_passes(trimming->plan->cord, trimming->plan->n_cords, 1, trimming->spare);
  for (int e = 0; e < frame->n_edges; e++) {
    trimming->spare[e] -= thr_plan_cover(frame, &trimming->plan->options, e);
    if (trimming->spare[e] > 0) trimming->room += trimming->spare[e] * frame->length[e];
  }

  /* From the last end to the first: how many passes up to the core, and how much length
   * together. */
  for (int end = 2 * trimming->plan->n_cords - 1, deep = 0; end >= 0; end--) {
    double length = 0;
    int k = 0;
    for (; deep < MOST_DEEP && k + 1 < trimming->plan->cord[end / 2].n_passes &&
           trimming->spare[pass_from(trimming, end, k) >> 1] > 0;
         k++)
      length += frame->length[pass_from(trimming, end, k) >> 1];
    trimming->most[end] = k;
    deep += k > 0;
    trimming->rest[end] = trimming->rest[end + 1] + length;
  }
}

/* Shortens the cords as the best choice says. */
static void cut_cords(thr_plan *plan, const int *cut)
{
  for (int i = 0; i < plan->n_cords; i++) {
    thr_cord *cord = &plan->cord[i];
    cord->n_passes -= cut[2 * i] + cut[2 * i + 1];
    memmove(cord->half, cord->half + cut[2 * i], (size_t)cord->n_passes * sizeof *cord->half);
    cord->closed = thr_cord_start(&plan->frame, cord) == thr_cord_end(&plan->frame, cord);
  }
}

thr_status thr_plan_trim(thr_plan *plan, bool *trimmed, thr_err *err)
{
  const thr_request *request = &plan->options;
  const bool free_ends = request->ends == THR_ENDS_ANY || request->ends == THR_ENDS_FEET ||
                         request->ends == THR_ENDS_NODES;
  thr_scratch scratch = {0};
  *trimmed = false;
  if (!free_ends || plan->n_cords < 1 || plan->symmetry.present ||
      request->joint == THR_JOINT_TUBE || request->distinct > 0 || plan->proof.optimal ||
      request->turning.tour != THR_TOUR_LEAST)
    return THR_OK;

  const size_t ends = 2 * (size_t)plan->n_cords;
  trim_search trimming = {
      .plan = plan,
      .spare = thr_scratch_array(&scratch, (size_t)plan->frame.n_edges, sizeof *trimming.spare),
      .cut = thr_scratch_array(&scratch, ends, sizeof *trimming.cut),
      .best = thr_scratch_array(&scratch, ends, sizeof *trimming.best),
      .most = thr_scratch_array(&scratch, ends, sizeof *trimming.most),
      .rest = thr_scratch_array(&scratch, ends + 1, sizeof *trimming.rest)};

  thr_status st = thr_scratch_check(&scratch, err);
  if (!st) {
    prepare(&trimming);
    choose(&trimming, 0);
    *trimmed = trimming.record > 1e-12 * plan->metrics.length;
  }
  if (*trimmed) cut_cords(plan, trimming.best);
  thr_scratch_free(&scratch);
  return st || !*trimmed ? st : thr_planner_prove_again(plan, err);
}
