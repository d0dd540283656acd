/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/threadings.h"
#include "tests/plans.h"

#include <stdlib.h>

const char *const threading_name[N_THREADINGS] = {"lines", "stairs", "snake"};

/* Adds a cord through the nodes node[n_nodes]. */
static void add_cord(thr_plan *p, const int *node, int n_nodes)
{
  const thr_frame *f = &p->frame;
  p->cord = realloc(p->cord, (size_t)(p->n_cords + 1) * sizeof *p->cord);
  ck_assert_ptr_nonnull(p->cord);
  thr_cord *c = &p->cord[p->n_cords];
  *c = (thr_cord){.n_passes = n_nodes - 1,
                  .closed = node[0] == node[n_nodes - 1],
                  .half = calloc((size_t)n_nodes, sizeof *c->half)};
  ck_assert_ptr_nonnull(c->half);
  thr_cord_id(p->n_cords++, c->id);
  for (int k = 0; k + 1 < n_nodes; k++) {
    int e = thr_frame_edge_between(f, node[k], node[k + 1]);
    ck_assert_int_ge(e, 0);
    c->half[k] = 2 * e + (f->edge[e][0] != node[k]);
  }
}

static int at(int n, int i, int j, bool turned)
{
  return turned ? j * n + i : i * n + j;
}

static void add_lines(thr_plan *p, int n, int *node)
{
  for (int turned = 0; turned < 2; turned++)
    for (int i = 0; i < n; i++) {
      for (int j = 0; j < n; j++)
        node[j] = at(n, i, j, turned);
      add_cord(p, node, n);
    }
}

/* Staircase d alternates between the diagonals i - j = d and d + 1. */
static void add_stairs(thr_plan *p, int n, int *node)
{
  for (int d = 1 - n; d < n - 1; d++) {
    int count = 0, i = d >= 0 ? d : 0, j = d >= 0 ? 0 : -d - 1;
    while (i < n && j < n) {
      node[count++] = at(n, i, j, false);
      if (i - j == d)
        i++;
      else
        j++;
    }
    add_cord(p, node, count);
  }
}

static void add_snake(thr_plan *p, int n, int *node)
{
  ck_assert_int_eq(n % 2, 1); /* else the rows do not end in the corner where the columns begin */
  int last = n * n - 1;
  for (int k = 0; k <= last; k++) {
    int i = k / n, j = i % 2 ? n - 1 - k % n : k % n;
    node[k] = at(n, i, j, false);
    node[2 * last - k] = at(n, i, j, true);
  }
  add_cord(p, node, 2 * last + 1);
}

thr_plan threading_make(const thr_frame *dome, int n, threading_kind kind)
{
  thr_plan p = {.options = options_for(THR_ENDS_ANY, 1)};
  p.options.order = THR_ORDER_PLANNED;
  ck_assert_int_eq(dome->n_nodes, n * n);
  ck_assert_int_eq(thr_frame_copy(&p.frame, dome, NULL), THR_OK);
  int *node = calloc((size_t)(2 * n * n), sizeof *node);
  ck_assert_ptr_nonnull(node);
  if (kind == THREAD_LINES)
    add_lines(&p, n, node);
  else if (kind == THREAD_STAIRS)
    add_stairs(&p, n, node);
  else
    add_snake(&p, n, node);
  free(node);
  ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, p.n_cords, &p.metrics, NULL),
                   THR_OK);
  return p;
}
