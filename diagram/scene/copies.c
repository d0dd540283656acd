/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds which cords of a symmetric plan are copies of a unique path, and how they run through it.
 *
 * A plan's symmetry says which image of a unique path a cord is. This file checks that by comparing
 * the cord's nodes with the images of the path's nodes: forwards and backwards, and for closed
 * cords from any start, which is a search for one text in another, twice as long (D. E. Knuth, J.
 * H. Morris & V. R. Pratt 1977). O(passes).
 *
 * Example: the path 0 1 2 3, closed, and the cord 7 4 5 6, closed, with the image 0 1 2 3 -> 4 5 6
 * 7: a copy that begins with its path's pass 4. */
#include "diagram/scene/scene.h"

#include <stdio.h>
#include <stdlib.h>

/* Returns node k of a cord: where its pass k leaves, or for the last one where the cord ends. */
static int node_at(const thr_frame *frame, const thr_cord *cord, int k)
{
  return k < cord->n_passes ? thr_tail(frame, cord->half[k])
                            : thr_head(frame, cord->half[cord->n_passes - 1]);
}

/* What is compared: the nodes of a unique path under an image, in either direction, with the nodes
 * of a cord. */
typedef struct {
  const thr_frame *f;
  const thr_cord *path, *cord;
  const int *image;
  bool backward;
  int n; /* nodes of either; of a closed cord each once */
} copy_pair;

/* Returns node i of the path's image, in the direction of comparison; round a closed path twice. */
static int node_of_image(const copy_pair *pair, int i)
{
  int k = pair->backward ? pair->n - 1 - i % pair->n : i % pair->n;
  return pair->image[node_at(pair->f, pair->path, k)];
}

/* Returns the first of the image's nodes from which on the cord's follow, or -1. failure: [n]
 * scratch, the failure function of the cord's nodes. */
static int find_start(const copy_pair *pair, int *failure)
{
  int matched = 0, text = pair->cord->closed ? 2 * pair->n - 1 : pair->n;

  /* failure[i]: length of the longest proper prefix of the cord's nodes that ends at node i. */
  failure[0] = 0;
  for (int i = 1, k = 0; i < pair->n; i++) {
    while (k > 0 && node_at(pair->f, pair->cord, i) != node_at(pair->f, pair->cord, k))
      k = failure[k - 1];
    k += node_at(pair->f, pair->cord, i) == node_at(pair->f, pair->cord, k);
    failure[i] = k;
  }

  /* Read the image's nodes, and fall back to a shorter prefix at each mismatch. */
  for (int i = 0; i < text; i++) {
    int node = node_of_image(pair, i);
    while (matched > 0 && node != node_at(pair->f, pair->cord, matched))
      matched = failure[matched - 1];
    matched += node == node_at(pair->f, pair->cord, matched);
    if (matched == pair->n) return i - pair->n + 1;
  }

  return -1;
}

const int *thr_copies_image(const thr_plan *plan, int c)
{
  return plan->symmetry.image + (size_t)plan->symmetry.element[c] * (size_t)plan->frame.n_nodes;
}

/* Finds how cord c runs through its unique path; leaves *copy as it is if the cord is no image of
 * the path. */
static void find_copy(const thr_plan *plan, int c, int *failure, thr_copy *copy)
{
  int unique = plan->symmetry.unique[c];
  const thr_cord *path = &plan->cord[unique], *cord = &plan->cord[c];

  /* A closed cord has each node once, an open one a node more than passes. */
  copy_pair pair = {.f = &plan->frame,
                    .path = path,
                    .cord = cord,
                    .image = thr_copies_image(plan, c),
                    .n = cord->n_passes + !cord->closed};

  if (path->n_passes != cord->n_passes || path->closed != cord->closed) return;

  /* Forwards first. */
  for (int backward = 0; backward < 2; backward++) {
    pair.backward = backward;
    int start = find_start(&pair, failure);
    if (start < 0) continue;

    /* Read backwards, node i of n is n - 1 - i, and the pass that leaves it there is the one
     * before. */
    int last = cord->closed ? 2 * cord->n_passes - 2 : cord->n_passes - 1;

    *copy = (thr_copy){.of = unique,
                       .start = backward ? (last - start) % cord->n_passes : start,
                       .backward = backward};
    return;
  }
}

thr_status thr_copies_find(const thr_plan *plan, thr_copy *copy, thr_err *err)
{
  const thr_symmetry_record *record = &plan->symmetry;
  int longest = 0, paths = 0;

  /* Every cord is a path of its own until it is found to be a copy. */
  for (int c = 0; c < plan->n_cords; c++) {
    copy[c] = (thr_copy){.of = c};
    if (plan->cord[c].n_passes > longest) longest = plan->cord[c].n_passes;
  }

  int *failure = record->present ? thr_calloc((size_t)longest + 1, sizeof *failure) : NULL;
  if (record->present && !failure) return thr_nomem(err);

  /* The record is not trusted: the unique path must be its own. */
  for (int c = 0; c < plan->n_cords && record->present; c++)
    if (record->unique[c] != c && record->unique[record->unique[c]] == record->unique[c])
      find_copy(plan, c, failure, &copy[c]);

  /* Number the paths, and let copies have the number of theirs. */
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

  /* The path's first pass in the direction of the copy: beginning there needs no words. */
  int first = how->backward ? plan->cord[how->of].n_passes - 1 : 0, n = 0;
  words[0] = '\0';

  /* The three lengths fit into 192 bytes. */
  if (motion)
    n = snprintf(words, 192, ", %.103s",
                 motion[c] ? motion[c] : "renumbered by the framework's symmetry (no motion)");

  if (how->backward) n += snprintf(words + n, (size_t)(192 - n), ", threaded backwards");
  if (how->start != first)
    snprintf(words + n, (size_t)(192 - n), ", beginning with its pass %d", how->start + 1);
}
