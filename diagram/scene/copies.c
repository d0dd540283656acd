/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which cords of a symmetric plan are copies of a unique path, and how they run through it. Private
 * to diagram/ and to what makes words of it. */
#include "diagram/scene/scene.h"

#include <stdio.h>
#include <stdlib.h>

/* Node k of a cord: where its pass k leaves, or for the last one where the cord ends. */
static int node_at(const thr_frame *frame, const thr_cord *c, int k)
{
  return k < c->n_passes ? thr_tail(frame, c->half[k]) : thr_head(frame, c->half[c->n_passes - 1]);
}

/* What is compared: the nodes of a unique path under an image, in either direction and for closed
 * ones from any start. */
typedef struct {
  const thr_frame *f;
  const thr_cord *path, *cord;
  const int *image;
  bool backward;
  int n; /* nodes of either; of a closed cord each once */
} pair;

static int node_of_image(const pair *x, int i)
{
  int k = x->backward ? x->n - 1 - i % x->n : i % x->n;
  return x->image[node_at(x->f, x->path, k)];
}

/* First of the image's nodes from which on the cord's follow, or -1 (Knuth, Morris & Pratt 1977;
 * failure: [n] scratch). */
static int find_start(const pair *x, int *failure)
{
  int matched = 0, text = x->cord->closed ? 2 * x->n - 1 : x->n;
  failure[0] = 0;
  for (int i = 1, k = 0; i < x->n; i++) {
    while (k > 0 && node_at(x->f, x->cord, i) != node_at(x->f, x->cord, k))
      k = failure[k - 1];
    k += node_at(x->f, x->cord, i) == node_at(x->f, x->cord, k);
    failure[i] = k;
  }
  for (int i = 0; i < text; i++) {
    int node = node_of_image(x, i);
    while (matched > 0 && node != node_at(x->f, x->cord, matched))
      matched = failure[matched - 1];
    matched += node == node_at(x->f, x->cord, matched);
    if (matched == x->n) return i - x->n + 1;
  }
  return -1;
}

const int *thr_copies_image(const thr_plan *plan, int c)
{
  return plan->symmetry.image + (size_t)plan->symmetry.element[c] * (size_t)plan->frame.n_nodes;
}

/* Finds how cord c runs through its unique path; leaves *copy as it is if it does not. */
static void find_copy(const thr_plan *plan, int c, int *failure, thr_copy *copy)
{
  int u = plan->symmetry.unique[c];
  const thr_cord *path = &plan->cord[u], *cord = &plan->cord[c];
  pair x = {.f = &plan->frame,
            .path = path,
            .cord = cord,
            .image = thr_copies_image(plan, c),
            .n = cord->n_passes + !cord->closed};
  if (path->n_passes != cord->n_passes || path->closed != cord->closed) return;
  for (int backward = 0; backward < 2; backward++) {
    x.backward = backward;
    int start = find_start(&x, failure);
    if (start < 0) continue;
    /* read backward, node i of n is n - 1 - i, and the pass that leaves it there is the one before
     */
    int last = cord->closed ? 2 * cord->n_passes - 2 : cord->n_passes - 1;
    *copy = (thr_copy){
        .of = u, .start = backward ? (last - start) % cord->n_passes : start, .backward = backward};
    return;
  }
}

thr_status thr_copies_find(const thr_plan *plan, thr_copy *copy, thr_err *err)
{
  const thr_symmetry_record *record = &plan->symmetry;
  int longest = 0, paths = 0;
  for (int c = 0; c < plan->n_cords; c++) {
    copy[c] = (thr_copy){.of = c};
    if (plan->cord[c].n_passes > longest) longest = plan->cord[c].n_passes;
  }
  int *failure = record->present ? thr_calloc((size_t)longest + 1, sizeof *failure) : NULL;
  if (record->present && !failure) return thr_nomem(err);
  for (int c = 0; c < plan->n_cords && record->present; c++)
    if (record->unique[c] != c && record->unique[record->unique[c]] == record->unique[c])
      find_copy(plan, c, failure, &copy[c]);
  for (int c = 0; c < plan->n_cords; c++)
    if (copy[c].of == c) copy[c].path = paths++;
  for (int c = 0; c < plan->n_cords; c++)
    copy[c].path = copy[copy[c].of].path;
  free(failure);
  return THR_OK;
}

int thr_copies_paths(const thr_copy *copy, int n_cords)
{
  int n = 0;
  for (int c = 0; c < n_cords; c++)
    n += copy[c].of == c;
  return n;
}

int thr_copies_count(const thr_copy *copy, int n_cords, int of)
{
  int n = 0;
  for (int c = 0; c < n_cords; c++)
    n += c != of && copy[c].of == of;
  return n;
}

void thr_copies_words(const thr_plan *plan, const thr_copy *copy, int c, const char *const *motion,
                      char words[192])
{
  const thr_copy *how = &copy[c];
  int first = how->backward ? plan->cord[how->of].n_passes - 1 : 0, n = 0;
  words[0] = '\0';
  if (motion)
    n = snprintf(words, 192, ", %.103s",
                 motion[c] ? motion[c] : "renumbered by the framework's symmetry (no motion)");
  if (how->backward) n += snprintf(words + n, (size_t)(192 - n), ", threaded backwards");
  if (how->start != first)
    snprintf(words + n, (size_t)(192 - n), ", beginning with its pass %d", how->start + 1);
}
