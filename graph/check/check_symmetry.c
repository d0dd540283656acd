/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks the record of a plan's symmetry: the group permutes the cords, and copies are copies.
 *
 * Cords are compared as sequences of nodes in a normal form, the lexicographically least one of all
 * that read the same cord: from either end and, of closed cords, from any node. The image of a cord
 * under an element is then found by sorting and searching. The group itself is checked in
 * check_group.c.
 *
 * Example: the closed sequences 3 1 2 and 1 3 2 have the same normal form 1 2 3. */
#include "graph/check/check_parts.h"

#include <stdlib.h>

/* ---- cords as sequences of nodes ---- */

/* The node sequence of a cord, or of an image of it, in its normal form. That of a cord which runs
 * round leaves out the node where it ends. */
typedef struct {
  const int *node;
  int n, cord;
  bool closed;
} path;

/* Returns the start of the lexicographically least rotation of n numbers, read backwards if
 * reverse. Two candidates i and j overtake each other; k numbers agree from both. */
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

    /* The larger candidate, and the k after it, cannot be the least. */
    if (difference > 0)
      i += k + 1;
    else
      j += k + 1;

    if (i == j) j++;
    k = 0;
  }

  return i < j ? i : j;
}

/* Returns number i of the rotation of a[n] that begins at start. */
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

  /* The lesser of the least forward and the least backward reading. */
  while (i < n && at(a, n, start[0], false, i) == at(a, n, start[1], true, i))
    i++;
  bool reverse = i < n && at(a, n, start[1], true, i) < at(a, n, start[0], false, i);

  for (i = 0; i < n; i++)
    out[i] = at(a, n, start[reverse], reverse, i);
}

/* Orders paths by kind, length and nodes. */
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
  const thr_plan *plan;
  int *run;     /* the nodes of all cords, one after the other */
  int *form[2]; /* as long: normal forms of the cords, and of their images */
  int *scratch; /* [nodes of the longest cord] */
  path *cord,
      *moved; /* [n_cords] in the order of the cords, each pointing into form[0] and form[1] */
  path *sorted, *other; /* [n_cords] the same by their nodes */
  int *start;           /* [n_cords] of a cord in run and form */
  thr_scratch own;      /* the arrays */
} cord_paths;

/* Allocates the tables. Release own with thr_scratch_free, after a failure too. */
static thr_status paths_init(cord_paths *paths, const thr_plan *plan, thr_err *err)
{
  size_t n = (size_t)plan->n_cords, all = 0, longest = 0;
  for (int i = 0; i < plan->n_cords; i++) {
    size_t nodes = (size_t)plan->cord[i].n_passes + !thr_cord_runs_round(plan, &plan->cord[i]);
    all += nodes;
    if (nodes > longest) longest = nodes;
  }

  /* Normal forms are as long as the node sequences. */
  *paths = (cord_paths){.plan = plan};
  paths->run = thr_scratch_array(&paths->own, all, sizeof *paths->run);
  paths->form[0] = thr_scratch_array(&paths->own, all, sizeof *paths->form[0]);
  paths->form[1] = thr_scratch_array(&paths->own, all, sizeof *paths->form[1]);
  paths->scratch = thr_scratch_array(&paths->own, longest, sizeof *paths->scratch);
  paths->cord = thr_scratch_array(&paths->own, n, sizeof *paths->cord);
  paths->moved = thr_scratch_array(&paths->own, n, sizeof *paths->moved);
  paths->sorted = thr_scratch_array(&paths->own, n, sizeof *paths->sorted);
  paths->other = thr_scratch_array(&paths->own, n, sizeof *paths->other);
  paths->start = thr_scratch_array(&paths->own, n, sizeof *paths->start);

  return thr_scratch_check(&paths->own, err);
}

/* Fills node sequences and normal forms of all cords, and sorts them. */
static void fill_paths(cord_paths *paths)
{
  const thr_plan *plan = paths->plan;
  for (int i = 0, next = 0; i < plan->n_cords; i++) {
    const thr_cord *c = &plan->cord[i];
    bool closed = thr_cord_runs_round(plan, c);

    /* An open cord has one node more than passes. */
    int n = c->n_passes + !closed, *run = paths->run + next;
    for (int k = 0; k < n; k++)
      run[k] = k < c->n_passes ? thr_tail(&plan->frame, c->half[k]) : thr_cord_end(&plan->frame, c);

    normalize(run, n, closed, paths->form[0] + next);
    paths->start[i] = next;
    paths->cord[i] = (path){paths->form[0] + next, n, i, closed};
    paths->moved[i] = (path){paths->form[1] + next, n, i, closed};

    /* Sorted once; images are looked up in this order. */
    paths->sorted[i] = paths->cord[i];
    next += n;
  }

  qsort(paths->sorted, (size_t)plan->n_cords, sizeof *paths->sorted, by_nodes);
}

/* Sets moved[i] to the image of cord i under a permutation of the nodes. */
static const path *move(cord_paths *paths, int i, const int *image)
{
  const path *c = &paths->cord[i];
  for (int k = 0; k < c->n; k++)
    paths->scratch[k] = image[paths->run[paths->start[i] + k]];

  /* The form has room at the place of cord i. */
  normalize(paths->scratch, c->n, c->closed, paths->form[1] + paths->start[i]);
  return &paths->moved[i];
}

/* Checks that the generator maps the cords to the cords, those that run alike to as many that do.
 */
static thr_status check_permuted(cord_paths *paths, const int *image, int number, thr_err *err)
{
  int n = paths->plan->n_cords;
  for (int i = 0; i < n; i++)
    paths->other[i] = *move(paths, i, image);

  /* Sort the images of all cords. */
  qsort(paths->other, (size_t)n, sizeof *paths->other, by_nodes);

  /* Both sorted lists must be the same. */
  for (int i = 0; i < n; i++) {
    int order = compare(&paths->other[i], &paths->sorted[i]);
    if (order < 0)
      return thr_fail(
          err, THR_EVIOLATED,
          "symmetry.generators[%d]: takes cord %s to a path that no cord of its own runs", number,
          paths->plan->cord[paths->other[i].cord].id);
    if (order > 0)
      return thr_fail(err, THR_EVIOLATED, "symmetry.generators[%d]: takes no cord to cord %s",
                      number, paths->plan->cord[paths->sorted[i].cord].id);
  }
  return THR_OK;
}

/* ---- copies ---- */

/* Checks that cord i is the copy of another one that it is said to be. */
static thr_status check_copy(cord_paths *paths, int i, thr_err *err)
{
  const thr_plan *plan = paths->plan;
  const thr_symmetry_record *record = &plan->symmetry;
  int u = record->unique[i], x = record->element[i];
  const char *id = plan->cord[i].id;

  if (u < 0 || u >= plan->n_cords || x < 0 || x >= record->n_images)
    return thr_fail(err, THR_EVIOLATED, "symmetry.cords[%d]: there is no such cord or image", i);

  /* Copies are of unique paths, and these are their own images. */
  if (record->unique[u] != u)
    return thr_fail(
        err, THR_EVIOLATED,
        "symmetry.cords[%d]: cord %s is said to be a copy of %s, which is a copy itself", i, id,
        plan->cord[u].id);

  if (u == i && x != 0)
    return thr_fail(err, THR_EVIOLATED, "symmetry.cords[%d]: a unique path is its own image 0", i);

  /* The image of the unique path must be this cord. */
  if (compare(move(paths, u, record->image + (size_t)x * (size_t)plan->frame.n_nodes),
              &paths->cord[i]) != 0)
    return thr_fail(err, THR_EVIOLATED, "symmetry.cords[%d]: cord %s is not image %d of cord %s", i,
                    id, x, plan->cord[u].id);
  return THR_OK;
}

/* Returns whether a permutation fixes all nodes of cord i. */
static bool keeps_nodes(const cord_paths *paths, int i, const int *image)
{
  for (int k = 0; k < paths->cord[i].n; k++)
    if (image[paths->run[paths->start[i] + k]] != paths->run[paths->start[i] + k]) return false;
  return true;
}

/* Returns after how many nodes a closed path repeats itself, n if only after all (Knuth, Morris &
 * Pratt 1977). failure: [n] scratch. */
static int period_of(const int *node, int n, int *failure)
{
  failure[0] = 0;

  /* The failure function of the sequence. */
  for (int i = 1, k = 0; i < n; i++) {
    while (k > 0 && node[i] != node[k])
      k = failure[k - 1];
    k += node[i] == node[k];
    failure[i] = k;
  }

  /* A period counts only if it divides the length. */
  int period = n - failure[n - 1];
  return n % period ? n : period;
}

/* Returns in how many ways a path is the same, read from another start or backwards. */
static int ways_to_read(cord_paths *paths, const path *c)
{
  bool backward = true;

  /* An open path is read from either end. */
  if (!c->closed) {
    for (int i = 0; i < c->n; i++)
      backward &= c->node[i] == c->node[c->n - 1 - i];
    return 1 + backward;
  }

  /* A closed one backwards, and once for each period. */
  int start = least_rotation(c->node, c->n, true);
  for (int i = 0; i < c->n; i++) /* the normal form starts at its least rotation */
    backward &= c->node[i] == at(c->node, c->n, start, true, i);

  return c->n / period_of(c->node, c->n, paths->scratch) * (1 + backward);
}

static const int *element(const thr_check_elements *check_elements, int i)
{
  return check_elements->image + (size_t)i * (size_t)check_elements->n;
}

/* Adds the passes of unique path u and, where they may be anywhere, its ends, over the number of
 * elements that map it to itself; as many of these as fix all its nodes do so alike. Plans of older
 * versions count the ways of reading each. No other unique path may be an image of u. */
static thr_status add_steps(cord_paths *paths, const thr_check_elements *check_elements, int u,
                            double *steps, thr_err *err)
{
  const thr_symmetry_record *record = &paths->plan->symmetry;
  int mapped = 0, fixed = 0;

  for (int i = 0; i < check_elements->order; i++) {
    const path *image = move(paths, u, element(check_elements, i));
    mapped += compare(image, &paths->cord[u]) == 0;
    fixed += keeps_nodes(paths, u, element(check_elements, i));

    /* Find the cords that run like the image, by halving. */
    int low = 0, high = paths->plan->n_cords;
    while (low < high) {
      int middle = low + (high - low) / 2;
      if (compare(&paths->sorted[middle], image) < 0)
        low = middle + 1;
      else
        high = middle;
    }

    /* All of them must be copies of u. */
    for (; low < paths->plan->n_cords && compare(&paths->sorted[low], image) == 0; low++)
      if (record->unique[paths->sorted[low].cord] != u)
        return thr_fail(
            err, THR_EVIOLATED,
            "symmetry.cords[%d]: cord %s is an image of cord %s, but said to be one of cord %s",
            paths->sorted[low].cord, paths->plan->cord[paths->sorted[low].cord].id,
            paths->plan->cord[u].id, paths->plan->cord[record->unique[paths->sorted[low].cord]].id);
  }

  /* Ends that may be anywhere are steps, too. */
  const int ends = paths->plan->options.ends == THR_ENDS_ANY && !paths->cord[u].closed ? 2 : 0;
  const int ways = record->retraced ? 1 : ways_to_read(paths, &paths->cord[u]);
  *steps += (double)(paths->plan->cord[u].n_passes + ends) * fixed / mapped / ways;
  return THR_OK;
}

/* Checks every copy, the number of unique paths, and the number of steps. */
static thr_status check_copies(cord_paths *paths, const thr_check_elements *check_elements,
                               thr_err *err)
{
  const thr_symmetry_record *record = &paths->plan->symmetry;
  int unique_paths = 0;
  double steps = 0;
  thr_status st = THR_OK;

  for (int i = 0; i < paths->plan->n_cords && !st; i++)
    st = check_copy(paths, i, err);

  for (int i = 0; i < paths->plan->n_cords && !st; i++) {
    if (record->unique[i] != i) continue;
    st = add_steps(paths, check_elements, i, &steps, err);
    unique_paths++;
  }
  if (st) return st;

  /* Compare what is stated. */
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
  cord_paths paths = {0};
  thr_check_elements check_elements = {0};

  thr_status st = thr_check_group(plan, &check_elements, err);
  if (!st) st = paths_init(&paths, plan, err);
  if (!st) fill_paths(&paths);

  for (int k = 0; k < record->n_generators && !st; k++)
    st =
        check_permuted(&paths, record->generator + (size_t)k * (size_t)plan->frame.n_nodes, k, err);

  if (!st) st = check_copies(&paths, &check_elements, err);

  thr_scratch_free(&paths.own);
  free(check_elements.image);
  return st;
}
