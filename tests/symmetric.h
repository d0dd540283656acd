/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frameworks whose symmetries are known, and a look at permutations that shares no code with the
 * program. */
#ifndef THR_TEST_SYMMETRIC_H
#define THR_TEST_SYMMETRIC_H

#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"
#include "tests/support.h"

thr_frame shape_make(thr_shape shape, int size, int rings); /* as `thread make` does */
thr_frame truncated_icosahedron(void);                      /* 60 nodes of degree 3, no feet */
/* A cube with edges of these lengths along the axes, each axis sheared by as much along the others;
 * no feet. */
thr_frame box_make(double a, double b, double c, double shear);
thr_frame no_feet(thr_frame f); /* the same framework, whose feet it takes away */

/* Does the permutation keep edges, feet and, where given, the colours of edges? */
bool keeps_frame(const thr_frame *f, const int *edge_colour, const int *image);

/* A framework with its whole group and that group's classes of subgroups. */
typedef struct {
  thr_frame f;
  thr_group g;
  thr_subgroup_classes classes;
} setting;

setting setting_make(int most, thr_frame f); /* at most so many classes; takes f over */
void setting_destroy(setting *s);

/* Aims in their usual order. */
thr_cover_options cover_options(thr_ends ends, int cover);

#endif
