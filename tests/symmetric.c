/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frameworks whose symmetries are known. */
#include "tests/symmetric.h"
#include "tests/frameworks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

thr_frame shape_make(thr_shape shape, int size, int rings)
{
  thr_make_options o = thr_make_options_default(shape);
  thr_draft d = {0};
  thr_read_report report;
  thr_frame f;
  o.size = size;
  if (rings) o.rings = rings;
  ck_assert_int_eq(thr_make(&d, &o, NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &report, NULL), THR_OK);
  thr_draft_destroy(&d);
  return f;
}

thr_frame no_feet(thr_frame f)
{
  memset(f.foot, 0, (size_t)f.n_nodes * sizeof *f.foot);
  return f;
}

thr_frame box_make(double a, double b, double c, double shear)
{
  thr_frame cube = solid_make(CUBE);
  double xyz[8][3], side[3] = {a, b, c};
  for (int v = 0; v < 8; v++)
    for (int i = 0; i < 3; i++) {
      xyz[v][i] = 0;
      for (int j = 0; j < 3; j++)
        xyz[v][i] += side[j] * (i == j ? 1 : shear) * (cube.xyz[v][j] > 0);
    }
  thr_frame f =
      frame_make(8, (const double(*)[3])xyz, cube.n_edges, (const int(*)[2])cube.edge, NULL, NULL);
  thr_frame_destroy(&cube);
  return no_feet(f);
}

thr_frame truncated_icosahedron(void)
{
  thr_frame small = solid_make(ICOSAHEDRON);
  double xyz[60][3];
  int edge[90][2], m = 0;
  for (int h = 0; h < 60; h++)
    for (int i = 0; i < 3; i++) {
      double a = small.xyz[thr_tail(&small, h)][i], b = small.xyz[thr_head(&small, h)][i];
      xyz[h][i] = a + (b - a) / 3;
    }
  for (int a = 0; a < 60; a++)
    for (int b = a + 1; b < 60; b++) {
      double d = 0;
      for (int i = 0; i < 3; i++)
        d += (xyz[a][i] - xyz[b][i]) * (xyz[a][i] - xyz[b][i]);
      if (fabs(sqrt(d) - 1.0 / 3) < 1e-6) edge[m][0] = a, edge[m++][1] = b;
    }
  ck_assert_int_eq(m, 90);
  thr_frame_destroy(&small);
  return no_feet(frame_make(60, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, NULL));
}

/* Edge between two nodes, or -1, by looking at all of them. */
static int edge_of(const thr_frame *f, int a, int b)
{
  for (int e = 0; e < f->n_edges; e++)
    if ((f->edge[e][0] == a && f->edge[e][1] == b) || (f->edge[e][0] == b && f->edge[e][1] == a))
      return e;
  return -1;
}

bool keeps_frame(const thr_frame *f, const int *edge_colour, const int *image)
{
  bool *hit = calloc((size_t)f->n_nodes, sizeof *hit), good = true;
  ck_assert(hit != NULL);
  for (int v = 0; v < f->n_nodes; v++) {
    good &=
        image[v] >= 0 && image[v] < f->n_nodes && !hit[image[v]] && f->foot[image[v]] == f->foot[v];
    if (!good) break;
    hit[image[v]] = true;
  }
  for (int e = 0; e < f->n_edges && good; e++) {
    int to = edge_of(f, image[f->edge[e][0]], image[f->edge[e][1]]);
    good = to >= 0 && (!edge_colour || edge_colour[to] == edge_colour[e]);
  }
  free(hit);
  return good;
}

setting setting_make(int most, thr_frame f)
{
  setting s = {.f = f};
  thr_automorphism_options plain = {0};
  thr_automorphisms a;
  ck_assert_int_eq(thr_automorphisms_find(&f, &plain, &a, NULL), THR_OK);
  ck_assert_int_eq(thr_group_generate(a.n, a.generator, a.n_generators, THR_GROUP_CAP, &s.g, NULL),
                   THR_OK);
  ck_assert_int_eq(thr_subgroup_classes_find(&s.g, most, &s.classes, NULL), THR_OK);
  thr_automorphisms_destroy(&a);
  return s;
}

void setting_destroy(setting *s)
{
  thr_subgroup_classes_destroy(&s->classes);
  thr_group_destroy(&s->g);
  thr_frame_destroy(&s->f);
}

thr_cover_options cover_options(thr_ends ends, int cover)
{
  return (thr_cover_options){
      .cover = cover,
      .ends = ends,
      .prefer = {THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_PATHS, THR_AIM_TURNING}};
}
