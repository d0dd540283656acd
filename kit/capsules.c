/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the few of many capsules that may be nearest to a point: an octree (a quadtree in a plane)
 * of lists.
 *
 * Within a cell a capsule's distance differs by no more than half the diagonal, h, from that at the
 * centre. So of a cell's list only capsules are handed to one of its eight parts that are no
 * farther from the part's centre than the nearest one and 2 h. What a list gives is what all
 * capsules would give, to the last bit. Cells are parted when a point in them is first asked for,
 * as meshes ask for points near surfaces alone.
 *
 * Example: of the 72 segments of four bent channels, lists of 2 mm cells have some five. */
#include "kit/kit.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* So short a list is not worth parting; so deep is the tree at most. */
enum { SHORT = 3, DEEPEST = 12 };

double thr_capsule_distance(const thr_capsule *capsule, const double at[3], double *part)
{
  double off[3];
  thr_between(capsule->from, at, off);
  double along = thr_dot(off, capsule->along) * capsule->inverse;
  *part = along < 0 ? 0 : along > 1 ? 1 : along;
  thr_along(off, -*part, capsule->along, off);
  return sqrt(thr_dot(off, off));
}

/* Gives a cell those of its parent's list that may be nearest in it. */
static thr_status fill_cell(thr_capsules *tree, int number, const thr_capsule_cell *parent,
                            const double low[3], double side)
{
  double centre[3], reach = 0.5 * side * sqrt(tree->axes) * (1 + 1e-9), farthest = INFINITY;
  for (int k = 0; k < 3; k++)
    centre[k] = k < tree->axes ? low[k] + 0.5 * side : 0;

  while (tree->n_members + parent->n > tree->members_capacity) {
    thr_status st = thr_grow(&tree->member, tree->members_capacity, &tree->members_capacity,
                             sizeof *tree->member, &tree->failure);
    if (st) return st;
  }
  int begin = tree->n_members;
  for (int round = 0; round < 2; round++)
    for (int i = parent->first; i < parent->first + parent->n; i++) {
      int member = tree->member[i];
      const thr_capsule *capsule = &tree->capsule[member];
      double part, away = thr_capsule_distance(capsule, centre, &part);
      double thin = fmin(capsule->radius[0], capsule->radius[1]);
      double thick = fmax(capsule->radius[0], capsule->radius[1]) + capsule->more;
      if (round == 0)
        farthest = fmin(farthest, away + reach - thin);
      else if (away - reach - thick <= farthest)
        tree->member[tree->n_members++] = member;
    }
  tree->cell[number] =
      (thr_capsule_cell){.first = begin, .n = tree->n_members - begin, .child = -1};

  return THR_OK;
}

thr_status thr_capsules_add(thr_capsules *tree, const double from[3], const double to[3],
                            const thr_capsule *how, thr_err *err)
{
  thr_status st = thr_grow(&tree->capsule, tree->n_capsules, &tree->capsules_capacity,
                           sizeof *tree->capsule, err);
  if (st) return st;

  thr_capsule *capsule = &tree->capsule[tree->n_capsules++];
  *capsule = *how;
  for (int k = 0; k < 3; k++) {
    capsule->from[k] = from[k];
    capsule->along[k] = to[k] - from[k];
  }
  double length2 = thr_dot(capsule->along, capsule->along);
  capsule->inverse = length2 > 0 ? 1 / length2 : 0;
  return THR_OK;
}

thr_status thr_capsules_make(thr_capsules *tree, int axes, const double low[], const double high[],
                             double least, thr_err *err)
{
  tree->axes = axes;
  tree->least = least;
  tree->side = 0;
  for (int k = 0; k < axes; k++) {
    tree->low[k] = low[k];
    tree->side = fmax(tree->side, high[k] - low[k]);
  }

  /* The whole has all of them, and so have points outside. */
  thr_status st = thr_grow(&tree->cell, 0, &tree->cells_capacity, sizeof *tree->cell, err);
  for (int i = 0; i < tree->n_capsules && !st; i++) {
    st = thr_grow(&tree->member, i, &tree->members_capacity, sizeof *tree->member, err);
    if (!st) tree->member[tree->n_members++] = i;
  }
  if (st) return st;
  tree->n_cells = 1;
  tree->cell[0] = (thr_capsule_cell){.n = tree->n_capsules, .child = -1};
  return THR_OK;
}

/* Makes room for the parts of a cell, whose lists are not known yet. */
static thr_status part_cell(thr_capsules *tree, int number)
{
  int child = tree->n_cells;
  for (int i = 0; i < 1 << tree->axes; i++) {
    thr_status st = thr_grow(&tree->cell, tree->n_cells, &tree->cells_capacity, sizeof *tree->cell,
                             &tree->failure);
    if (st) return st;
    tree->cell[tree->n_cells++] = (thr_capsule_cell){.n = -1, .child = -1};
  }
  tree->cell[number].child = child;
  return THR_OK;
}

const int *thr_capsules_list(thr_capsules *tree, const double at[3], int *n)
{
  double low[3] = {0}, side = tree->side;
  int number = 0;
  *n = tree->n_capsules;
  for (int k = 0; k < tree->axes; k++) {
    low[k] = tree->low[k];
    if (at[k] < low[k] || at[k] > low[k] + side) return tree->member;
  }

  for (int depth = 0; depth < DEEPEST; depth++) {
    if (tree->cell[number].n <= SHORT || side <= tree->least) break;
    if (tree->cell[number].child < 0 && part_cell(tree, number)) break;
    side *= 0.5;
    int child = tree->cell[number].child;
    for (int k = 0; k < tree->axes; k++)
      if (at[k] >= low[k] + side) {
        low[k] += side;
        child += 1 << k;
      }
    const thr_capsule_cell parent = tree->cell[number];
    if (tree->cell[child].n < 0 && fill_cell(tree, child, &parent, low, side)) break;
    number = child;
  }
  *n = tree->cell[number].n;
  return tree->member + tree->cell[number].first;
}

void thr_capsules_destroy(thr_capsules *tree)
{
  free(tree->capsule);
  free(tree->cell);
  free(tree->member);
  *tree = (thr_capsules){0};
}
