/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Applies symmetries of a task of least turning: images of half-edges, and the columns that follow.
 *
 * A symmetry is given by the images of the half-edges 2e; those of 2e + 1 run the other way. Any
 * numbers from a file are tested: a symmetry permutes the edges, keeps half-edges of one node
 * together, and keeps what edges and nodes need and allow. thr_turning_lower joins the columns that
 * symmetries map to each other to orbits (disjoint sets) and gives all of them the least price and
 * length. */
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

#include <stdlib.h>
#include <string.h>

/* Returns the image of a half-edge. */
static int image_of(const int *image, int half)
{
  return image[half >> 1] ^ (half & 1);
}

/* Returns the column of the U-turn at a half-edge; these columns are in the order of their nodes,
 * and of the half-edges there. */
static int back_at(const thr_turning_columns *c, int half)
{
  int low = c->first_back, high = c->n_columns - 1, v = thr_tail(c->f, half);

  /* Find the first U-turn at the node by halving. */
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (thr_tail(c->f, c->half[middle][0]) < v)
      low = middle + 1;
    else
      high = middle;
  }

  return low + c->position[half];
}

int thr_turning_image(const thr_turning_columns *turning_columns, const int *image, int column)
{
  const thr_turning_columns *c = turning_columns;
  int a = image_of(image, c->half[column][0]);

  /* Turns, extra passes, cord ends, U-turns. */
  if (column < c->first_extra) return thr_turning_column(c, a, image_of(image, c->half[column][1]));
  if (column < c->first_end) return c->first_extra + (a >> 1);
  return column < c->first_back ? c->end_column[a] : back_at(c, a);
}

/* Returns whether each edge is the image of one edge, and all half-edges of a node map to those of
 * one node. edge: [n_edges] all false; node: [2 * n_nodes] all -1. */
static bool is_one_to_one(const thr_frame *frame, const int *image, bool *edge, int *node)
{
  int *from = node + frame->n_nodes;

  for (int e = 0; e < frame->n_edges; e++) {
    if (image[e] < 0 || image[e] >= 2 * frame->n_edges || edge[image[e] >> 1]) return false;
    edge[image[e] >> 1] = true;
  }

  /* The first half-edge of a node decides where the node maps to. */
  for (int h = 0; h < 2 * frame->n_edges; h++) {
    int v = thr_tail(frame, h), w = thr_tail(frame, image_of(image, h));
    if (node[v] < 0 && from[w] < 0) {
      node[v] = w;
      from[w] = v;
    }

    if (node[v] != w || from[w] != v) return false;
  }
  return true;
}

/* Returns whether an image needs and allows the same passes and ends. */
static bool keeps_task(const thr_turning_columns *c, const int *image)
{
  for (int h = 0; h < 2 * c->f->n_edges; h++) {
    int g = image_of(image, h);
    const int *own = c->supply[c->end_group[thr_tail(c->f, h)]],
              *other = c->supply[c->end_group[thr_tail(c->f, g)]];

    if (c->cover[h >> 1] != c->cover[g >> 1] || c->most[h >> 1] != c->most[g >> 1] ||
        own[0] != other[0] || own[1] != other[1] ||
        (c->end_column[h] >= 0) != (c->end_column[g] >= 0))
      return false;
  }
  return true;
}

thr_status thr_turning_symmetric(const thr_turning_columns *turning_columns, const int *image,
                                 bool *yes, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  thr_scratch own = {0};
  bool *edge = thr_scratch_array(&own, (size_t)frame->n_edges, sizeof *edge);
  int *node = thr_scratch_array(&own, 2 * (size_t)frame->n_nodes, sizeof *node);

  thr_status st = thr_scratch_check(&own, err);
  for (int i = 0; i < 2 * frame->n_nodes && !st; i++)
    node[i] = -1;

  *yes = !st && is_one_to_one(frame, image, edge, node) && keeps_task(turning_columns, image);

  thr_scratch_free(&own);
  return st;
}

/* Sets every column's price, and every extra pass's length, to the least of its orbit. */
static void take_least(const thr_turning_columns *from, int *orbit, thr_turning_columns *to)
{
  memcpy(to->weight, from->weight, (size_t)from->n_columns * sizeof *to->weight);
  memcpy(to->length, from->length, (size_t)from->f->n_edges * sizeof *to->length);

  /* The root of an orbit, its lowest column, collects the least values. */
  for (int j = 0; j < from->n_columns; j++) {
    int root = thr_disjoint_find(orbit, j), e = j - from->first_extra, r = root - from->first_extra;

    if (from->weight[j] < to->weight[root]) to->weight[root] = from->weight[j];
    if (j >= from->first_extra && j < from->first_end && from->length[e] < to->length[r])
      to->length[r] = from->length[e];
  }

  /* Then all of the orbit take them over. */
  for (int j = 0; j < from->n_columns; j++) {
    int root = thr_disjoint_find(orbit, j);
    to->weight[j] = to->weight[root];
    if (j >= from->first_extra && j < from->first_end)
      to->length[j - from->first_extra] = to->length[root - from->first_extra];
  }
}

thr_status thr_turning_lower(const thr_turning_columns *turning_columns, const int *image, int n,
                             thr_turning_columns *lower, thr_err *err)
{
  const thr_turning_columns *c = turning_columns;
  const size_t m = (size_t)c->f->n_edges;
  *lower = *c;
  lower->own = (thr_scratch){0};

  /* Prices and lengths are copies; everything else is borrowed. */
  lower->weight = thr_scratch_array(&lower->own, (size_t)c->n_columns, sizeof *lower->weight);
  lower->length = thr_scratch_array(&lower->own, m, sizeof *lower->length);
  int *orbit = thr_calloc((size_t)c->n_columns, sizeof *orbit);

  thr_status st = orbit ? thr_scratch_check(&lower->own, err) : thr_nomem(err);
  for (int j = 0; j < c->n_columns && !st; j++)
    orbit[j] = j;

  /* Join every column with its images. */
  for (int i = 0; i < n && !st; i++)
    for (int j = 0; j < c->n_columns; j++)
      thr_disjoint_join(orbit, j, thr_turning_image(c, image + (size_t)i * m, j));

  if (!st) take_least(c, orbit, lower);

  free(orbit);
  if (st) thr_turning_columns_destroy(lower);
  return st;
}
