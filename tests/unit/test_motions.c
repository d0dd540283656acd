/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the words for copies say, against matrices whose geometry is known: x to the right, y to the
 * back, z up. */
#include "graph/number.h"
#include "graph/plan/plan.h"
#include "lib/lib.h"
#include "lib/motions.c"
#include "tests/frameworks.h"
#include "tests/symmetric.h"

#include <string.h>

enum { MOST_IMAGES = 24 };

typedef struct {
  double q[3][3];
  const char *words; /* NULL = none */
} known;

/* The node where q takes node v of a framework about the origin; -1 if there is none. */
static int moved(const thr_frame *f, const double q[3][3], int v)
{
  for (int w = 0; w < f->n_nodes; w++) {
    double away = 0;
    for (int i = 0; i < 3; i++) {
      double at = 0;
      for (int j = 0; j < 3; j++)
        at += q[i][j] * f->xyz[v][j];
      away = fmax(away, fabs(at - f->xyz[w][i]));
    }
    if (away < 1e-9) return w;
  }
  return -1;
}

/* A plan of which there is only what describing needs: cord k is image k of cord 0, and image 0 is
 * the identity. */
static thr_plan plan_with(thr_frame f, int n)
{
  thr_plan p = {.frame = f, .n_cords = n};
  thr_symmetry_record *r = &p.symmetry;
  r->present = true;
  r->n_images = n;
  r->image = calloc((size_t)n * (size_t)f.n_nodes, sizeof *r->image);
  r->unique = calloc((size_t)n, sizeof *r->unique);
  r->element = calloc((size_t)n, sizeof *r->element);
  ck_assert(r->image && r->unique && r->element);
  for (int k = 0; k < n; k++) {
    r->element[k] = k;
    for (int v = 0; v < f.n_nodes; v++)
      r->image[k * f.n_nodes + v] = v;
  }
  return p;
}

static void plan_release(thr_plan *p)
{
  free(p->symmetry.image);
  free(p->symmetry.unique);
  free(p->symmetry.element);
  thr_frame_destroy(&p->frame);
}

/* shape: where the nodes stand; number: which cords' words are looked at. */
static void expect_words(thr_frame shape, const known *k, int n)
{
  thr_motions c;
  thr_plan p = plan_with(shape, n + 1);
  for (int i = 0; i < n; i++)
    for (int v = 0; v < shape.n_nodes; v++) {
      int to = moved(&p.frame, k[i].q, v);
      ck_assert_msg(to >= 0, "%s: not a symmetry of the shape", k[i].words);
      p.symmetry.image[(i + 1) * shape.n_nodes + v] = to;
    }
  ck_assert_int_eq(thr_motions_describe(&p, &c, NULL), THR_OK);
  ck_assert_ptr_null(c.motion[0]); /* the unique path itself */
  for (int i = 0; i < n; i++) {
    ck_assert_msg(c.motion[i + 1] != NULL, "%s: no words", k[i].words);
    ck_assert_str_eq(c.motion[i + 1], k[i].words);
  }
  thr_motions_destroy(&c);
  plan_release(&p);
}

/* Nodes of the solid moved so that their middle is the origin. */
static thr_frame centred(thr_frame f)
{
  double middle[3] = {0};
  for (int v = 0; v < f.n_nodes; v++)
    for (int i = 0; i < 3; i++)
      middle[i] += f.xyz[v][i] / f.n_nodes;
  for (int v = 0; v < f.n_nodes; v++)
    for (int i = 0; i < 3; i++)
      f.xyz[v][i] -= middle[i];
  return no_feet(f);
}

START_TEST(motions_of_a_cube)
{
  static const known k[] = {
      {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, "in the same place"},
      /* half turns: about z nothing is turned over, about a level axis the lower side comes up */
      {{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, "turned by 180 degrees"},
      {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, "turned over about the x axis"},
      {{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, "turned over about the y axis"},
      {{{0, 1, 0}, {1, 0, 0}, {0, 0, -1}}, "turned over about a level axis"},
      {{{0, 0, 1}, {0, -1, 0}, {1, 0, 0}}, "turned by 180 degrees about a slanted axis"},
      /* x goes to y: to the back, seen from above against the clock */
      {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}, "turned by 90 degrees counter-clockwise from above"},
      {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, "turned by 90 degrees clockwise from above"},
      /* y goes to z; seen from +x, with z up, y is to the right: against the clock */
      {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, "turned by 90 degrees counter-clockwise from the right"},
      {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, "turned by 90 degrees clockwise from the right"},
      /* x goes to z; seen from +y, with z up, x is to the left: with the clock */
      {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, "turned by 90 degrees clockwise from behind"},
      {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, "turned by 120 degrees about a slanted axis"},
      {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, "mirrored left to right"},
      {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, "mirrored front to back"},
      {{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, "mirrored upside down"},
      {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}, "mirrored"},
      {{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}, "mirrored"},
      {{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, "inverted (mirrored at the middle point)"},
      /* rotoreflections: the turn with its axis' coordinate negated */
      {{{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
       "mirrored upside down and turned by 90 degrees counter-clockwise from above"},
      {{{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}},
       "mirrored upside down and turned by 90 degrees clockwise from above"},
      {{{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
       "mirrored left to right and turned by 90 degrees counter-clockwise from the right"},
      {{{0, -1, 0}, {0, 0, -1}, {-1, 0, 0}},
       "mirrored and turned by 60 degrees about a slanted axis"},
  };
  ck_assert_int_le((int)(sizeof k / sizeof *k), MOST_IMAGES);
  expect_words(centred(solid_make(CUBE)), k, sizeof k / sizeof *k);
}
END_TEST

/* Turns by a seventh, and with a mirror: the longest words. */
START_TEST(turns_of_a_tube)
{
  known k[3];
  double s = sin(2 * THR_PI / 7), c = cos(2 * THR_PI / 7);
  const known made[3] = {
      {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, "turned by 51.43 degrees counter-clockwise from above"},
      {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}, "turned by 51.43 degrees clockwise from above"},
      {{{c, s, 0}, {-s, c, 0}, {0, 0, -1}},
       "mirrored upside down and turned by 51.43 degrees clockwise from above"}};
  memcpy(k, made, sizeof k);
  expect_words(centred(shape_make(THR_MAKE_TUBE, 7, 2)), k, 3);
}
END_TEST

/* A box whose edges differ: what turns a cube is no motion of it. And rows that are no permutation,
 * as a plan may have. */
START_TEST(no_motion_no_words)
{
  thr_frame f = centred(solid_make(CUBE));
  const double turn[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
  thr_plan p = plan_with(f, 4);
  int n = f.n_nodes, *image = p.symmetry.image;
  thr_motions c;
  for (int v = 0; v < n; v++)
    image[n + v] = moved(&f, turn, v);
  for (int v = 0; v < n; v++)
    p.frame.xyz[v][0] *= 3;
  image[2 * n] = image[2 * n + 1];
  image[3 * n + 2] = n;
  ck_assert_int_eq(thr_motions_describe(&p, &c, NULL), THR_OK);
  for (int i = 0; i < 4; i++)
    ck_assert_ptr_null(c.motion[i]);
  thr_motions_destroy(&c);
  plan_release(&p);
}
END_TEST

START_TEST(every_allocation_fails_once)
{
  thr_plan p = plan_with(centred(solid_make(CUBE)), 2);
  thr_status st = THR_ENOMEM;
  long k = 0;
  while (st) {
    thr_motions c;
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    st = thr_motions_describe(&p, &c, &err);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || (st == THR_ENOMEM && !c.motion && !c.words));
    thr_motions_destroy(&c);
  }
  ck_assert_int_gt(k, 3);
  plan_release(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("copies");
  ADD_TEST(s, 10, motions_of_a_cube);
  ADD_TEST(s, 10, turns_of_a_tube);
  ADD_TEST(s, 10, no_motion_no_words);
  ADD_TEST(s, 10, every_allocation_fails_once);
  return run_suite(s);
}
