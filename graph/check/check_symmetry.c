/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The checker's part for symmetry: that the group (graph/check/check_group.c) permutes the cords,
 * and that every cord is the copy that it is said to be. Cords are compared by the nodes that they
 * come to. */
#include "graph/check/check_parts.h"

#include <stdlib.h>
#include <string.h>

/* ---- cords as sequences of nodes ---- */

/* The node sequence of a cord, or of an image of it, in its normal form: the lexicographically
 * least of those that start at its other end or, of one that runs round, anywhere, either way
 * round. Of the latter the node where it ends is left out. */
typedef struct {
  const int *node;
  int n, cord;
  bool closed;
} path;

/* Start of the least rotation of n numbers, read from the end if reverse (two candidates that
 * overtake each other). */
static int least_rotation(const int *a, int n, bool reverse)
{
  int i = 0, j = 1, k = 0;
  while (i < n && j < n && k < n) {
    int x = (i + k) % n, y = (j + k) % n;
    int difference = reverse ? a[n - 1 - x] - a[n - 1 - y] : a[x] - a[y];
    if (difference == 0) {
      k++;
      continue;
    }
    if (difference > 0)
      i += k + 1;
    else
      j += k + 1;
    if (i == j) j++;
    k = 0;
  }
  return i < j ? i : j;
}

static int at(const int *a, int n, int start, bool reverse, int i)
{
  int k = (start + i) % n;
  return a[reverse ? n - 1 - k : k];
}

/* Writes the normal form of a[n] to out. */
static void normalize(const int *a, int n, bool closed, int *out)
{
  int start[2] = {closed ? least_rotation(a, n, false) : 0,
                  closed ? least_rotation(a, n, true) : 0},
      i = 0;
  while (i < n && at(a, n, start[0], false, i) == at(a, n, start[1], true, i))
    i++;
  bool reverse = i < n && at(a, n, start[1], true, i) < at(a, n, start[0], false, i);
  for (i = 0; i < n; i++)
    out[i] = at(a, n, start[reverse], reverse, i);
}

static int compare(const path *a, const path *b)
{
  if (a->closed != b->closed) return a->closed ? 1 : -1;
  if (a->n != b->n) return a->n < b->n ? -1 : 1;
  for (int i = 0; i < a->n; i++)
    if (a->node[i] != b->node[i]) return a->node[i] < b->node[i] ? -1 : 1;
  return 0;
}

static int by_nodes(const void *a, const void *b)
{
  const path *p = a, *q = b;
  int order = compare(p, q);
  return order ? order : p->cord - q->cord;
}

/* All cords: as they run, and two tables of normal forms. */
typedef struct {
  const thr_plan *p;
  int *run;     /* the nodes of all cords, one after the other */
  int *form[2]; /* as long: normal forms of the cords, and of their images */
  int *scratch; /* [nodes of the longest cord] */
  path *cord,
      *moved; /* [n_cords] in the order of the cords, each pointing into form[0] and form[1] */
  path *sorted, *other; /* [n_cords] the same by their nodes */
  int *start;           /* [n_cords] of a cord in run and form */
  thr_scratch own;      /* the arrays */
} paths;

static void paths_destroy(paths *s)
{
  thr_scratch_free(&s->own);
}

static thr_status paths_init(paths *s, const thr_plan *plan, thr_err *err)
{
  size_t n = (size_t)plan->n_cords, all = 0, longest = 0;
  for (int i = 0; i < plan->n_cords; i++) {
    size_t nodes = (size_t)plan->cord[i].n_passes + !thr_cord_runs_round(plan, &plan->cord[i]);
    all += nodes;
    if (nodes > longest) longest = nodes;
  }
  *s = (paths){.p = plan};
  s->run = thr_scratch_array(&s->own, all, sizeof *s->run);
  s->form[0] = thr_scratch_array(&s->own, all, sizeof *s->form[0]);
  s->form[1] = thr_scratch_array(&s->own, all, sizeof *s->form[1]);
  s->scratch = thr_scratch_array(&s->own, longest, sizeof *s->scratch);
  s->cord = thr_scratch_array(&s->own, n, sizeof *s->cord);
  s->moved = thr_scratch_array(&s->own, n, sizeof *s->moved);
  s->sorted = thr_scratch_array(&s->own, n, sizeof *s->sorted);
  s->other = thr_scratch_array(&s->own, n, sizeof *s->other);
  s->start = thr_scratch_array(&s->own, n, sizeof *s->start);
  return thr_scratch_check(&s->own, err);
}

static void fill_paths(paths *s)
{
  const thr_plan *plan = s->p;
  for (int i = 0, next = 0; i < plan->n_cords; i++) {
    const thr_cord *c = &plan->cord[i];
    bool closed = thr_cord_runs_round(plan, c);
    int n = c->n_passes + !closed, *run = s->run + next;
    for (int k = 0; k < n; k++)
      run[k] = k < c->n_passes ? thr_tail(&plan->frame, c->half[k]) : thr_cord_end(&plan->frame, c);
    normalize(run, n, closed, s->form[0] + next);
    s->start[i] = next;
    s->cord[i] = (path){s->form[0] + next, n, i, closed};
    s->moved[i] = (path){s->form[1] + next, n, i, closed};
    s->sorted[i] = s->cord[i];
    next += n;
  }
  qsort(s->sorted, (size_t)plan->n_cords, sizeof *s->sorted, by_nodes);
}

/* Sets moved[i] to the image of cord i. */
static const path *move(paths *s, int i, const int *image)
{
  const path *c = &s->cord[i];
  for (int k = 0; k < c->n; k++)
    s->scratch[k] = image[s->run[s->start[i] + k]];
  normalize(s->scratch, c->n, c->closed, s->form[1] + s->start[i]);
  return &s->moved[i];
}

/* Does the generator map the cords to the cords, those that run alike to as many? */
static thr_status check_permuted(paths *s, const int *image, int number, thr_err *err)
{
  int n = s->p->n_cords;
  for (int i = 0; i < n; i++)
    s->other[i] = *move(s, i, image);
  qsort(s->other, (size_t)n, sizeof *s->other, by_nodes);
  for (int i = 0; i < n; i++) {
    int order = compare(&s->other[i], &s->sorted[i]);
    if (order < 0)
      return thr_fail(
          err, THR_EVIOLATED,
          "symmetry.generators[%d]: takes cord %s to a path that no cord of its own runs", number,
          s->p->cord[s->other[i].cord].id);
    if (order > 0)
      return thr_fail(err, THR_EVIOLATED, "symmetry.generators[%d]: takes no cord to cord %s",
                      number, s->p->cord[s->sorted[i].cord].id);
  }
  return THR_OK;
}

/* ---- copies ---- */

static thr_status check_copy(paths *s, int i, thr_err *err)
{
  const thr_plan *plan = s->p;
  const thr_symmetry_record *record = &plan->symmetry;
  int u = record->unique[i], x = record->element[i];
  const char *id = plan->cord[i].id;
  if (u < 0 || u >= plan->n_cords || x < 0 || x >= record->n_images)
    return thr_fail(err, THR_EVIOLATED, "symmetry.cords[%d]: there is no such cord or image", i);
  if (record->unique[u] != u)
    return thr_fail(
        err, THR_EVIOLATED,
        "symmetry.cords[%d]: cord %s is said to be a copy of %s, which is a copy itself", i, id,
        plan->cord[u].id);
  if (u == i && x != 0)
    return thr_fail(err, THR_EVIOLATED, "symmetry.cords[%d]: a unique path is its own image 0", i);
  if (compare(move(s, u, record->image + (size_t)x * (size_t)plan->frame.n_nodes), &s->cord[i]) !=
      0)
    return thr_fail(err, THR_EVIOLATED, "symmetry.cords[%d]: cord %s is not image %d of cord %s", i,
                    id, x, plan->cord[u].id);
  return THR_OK;
}

static bool keeps_nodes(const paths *s, int i, const int *image)
{
  for (int k = 0; k < s->cord[i].n; k++)
    if (image[s->run[s->start[i] + k]] != s->run[s->start[i] + k]) return false;
  return true;
}

/* Of a closed path: after how many nodes it repeats itself, n if only after all (Knuth, Morris &
 * Pratt 1977; failure: [n] scratch). */
static int period_of(const int *node, int n, int *failure)
{
  failure[0] = 0;
  for (int i = 1, k = 0; i < n; i++) {
    while (k > 0 && node[i] != node[k])
      k = failure[k - 1];
    k += node[i] == node[k];
    failure[i] = k;
  }
  int period = n - failure[n - 1];
  return n % period ? n : period;
}

/* In how many ways a path is the same, read from another start or backward. */
static int ways_to_read(paths *s, const path *c)
{
  bool backward = true;
  if (!c->closed) {
    for (int i = 0; i < c->n; i++)
      backward &= c->node[i] == c->node[c->n - 1 - i];
    return 1 + backward;
  }
  int start = least_rotation(c->node, c->n, true);
  for (int i = 0; i < c->n; i++) /* the normal form starts at its least rotation */
    backward &= c->node[i] == at(c->node, c->n, start, true, i);
  return c->n / period_of(c->node, c->n, s->scratch) * (1 + backward);
}

static const int *element(const thr_check_elements *check_elements, int i)
{
  return check_elements->image + (size_t)i * (size_t)check_elements->n;
}

/* Passes of unique path u and, where they may be anywhere, ends, over the number of elements that
 * map it to itself; as many as fix all its nodes do so alike. Older plans count the ways of each.
 * No other unique path may be an image. */
static thr_status add_steps(paths *s, const thr_check_elements *check_elements, int u,
                            double *steps, thr_err *err)
{
  const thr_symmetry_record *record = &s->p->symmetry;
  int mapped = 0, fixed = 0;
  for (int i = 0; i < check_elements->order; i++) {
    const path *image = move(s, u, element(check_elements, i));
    mapped += compare(image, &s->cord[u]) == 0;
    fixed += keeps_nodes(s, u, element(check_elements, i));
    int low = 0, high = s->p->n_cords; /* the first cord that runs so, and those after it */
    while (low < high) {
      int middle = low + (high - low) / 2;
      if (compare(&s->sorted[middle], image) < 0)
        low = middle + 1;
      else
        high = middle;
    }
    for (; low < s->p->n_cords && compare(&s->sorted[low], image) == 0; low++)
      if (record->unique[s->sorted[low].cord] != u)
        return thr_fail(
            err, THR_EVIOLATED,
            "symmetry.cords[%d]: cord %s is an image of cord %s, but said to be one of cord %s",
            s->sorted[low].cord, s->p->cord[s->sorted[low].cord].id, s->p->cord[u].id,
            s->p->cord[record->unique[s->sorted[low].cord]].id);
  }
  const int ends = s->p->options.ends == THR_ENDS_ANY && !s->cord[u].closed ? 2 : 0;
  const int ways = record->retraced ? 1 : ways_to_read(s, &s->cord[u]);
  *steps += (double)(s->p->cord[u].n_passes + ends) * fixed / mapped / ways;
  return THR_OK;
}

static thr_status check_copies(paths *s, const thr_check_elements *check_elements, thr_err *err)
{
  const thr_symmetry_record *record = &s->p->symmetry;
  int unique_paths = 0;
  double steps = 0;
  thr_status st = THR_OK;
  for (int i = 0; i < s->p->n_cords && !st; i++)
    st = check_copy(s, i, err);
  for (int i = 0; i < s->p->n_cords && !st; i++) {
    if (record->unique[i] != i) continue;
    st = add_steps(s, check_elements, i, &steps, err);
    unique_paths++;
  }
  if (st) return st;
  if (record->unique_paths != unique_paths)
    return thr_fail(err, THR_EVIOLATED, "symmetry.unique_paths: stated %d, but there are %d",
                    record->unique_paths, unique_paths);
  if (!thr_check_close(record->steps, steps, steps))
    return thr_fail(err, THR_EVIOLATED,
                    "symmetry.steps: stated %.12g, but the unique paths give %.12g", record->steps,
                    steps);
  return THR_OK;
}

/* ---- the whole record ---- */

thr_status thr_check_symmetry(const thr_plan *plan, thr_err *err)
{
  const thr_symmetry_record *record = &plan->symmetry;
  paths s = {0};
  thr_check_elements check_elements = {0};
  thr_status st = thr_check_group(plan, &check_elements, err);
  if (!st) st = paths_init(&s, plan, err);
  if (!st) fill_paths(&s);
  for (int k = 0; k < record->n_generators && !st; k++)
    st = check_permuted(&s, record->generator + (size_t)k * (size_t)plan->frame.n_nodes, k, err);
  if (!st) st = check_copies(&s, &check_elements, err);
  paths_destroy(&s);
  free(check_elements.image);
  return st;
}
