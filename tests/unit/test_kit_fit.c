/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What pieces of a kit must not do: channels that cut each other, thin walls, arms of strangers
 * that meet; each measured here by brute force. */
#include "graph/framework/frame.h"
#include "graph/number.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "kit/kit.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static thr_plan plan_of(thr_shape shape, int size)
{
  thr_frame f = shape_make(shape, size, 3);
  thr_request o = thr_request_default();
  thr_plan p = plan_make(&f, &o);
  thr_frame_destroy(&f);
  return p;
}

/* Shapes only: no meshes. */
static thr_kit shapes_of(const thr_plan *p, const thr_kit_options *options, bool meshes)
{
  thr_err err = {0};
  thr_kit kit;
  const thr_limits limits = {.threads = 1};
  ck_assert_msg(thr_kit_make(&kit, p, options, NULL, meshes, &limits, &err) == THR_OK, "%s",
                err.text);
  return kit;
}

START_TEST(the_distance_of_segments_is_that_of_many_points)
{
  enum { STEPS = 200 };
  rng r = rng_make((uint64_t)_i + 1);
  double a[2][3], b[2][3], part[2], least = INFINITY;
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) {
      a[i][k] = rng_unit(&r);
      /* Some are parallel, some are points. */
      b[i][k] = _i % 5 == 0 ? a[i][k] + 0.3 * k : _i % 7 == 0 ? 0.4 : rng_unit(&r);
    }
  double found = thr_kit_segments((const double(*)[3])a, (const double(*)[3])b, part);
  for (int i = 0; i <= STEPS; i++)
    for (int j = 0; j <= STEPS; j++) {
      double p[3], q[3];
      for (int k = 0; k < 3; k++) {
        p[k] = a[0][k] + (a[1][k] - a[0][k]) * i / STEPS;
        q[k] = b[0][k] + (b[1][k] - b[0][k]) * j / STEPS;
      }
      least = fmin(least, thr_distance(p, q));
    }
  ck_assert_double_le(found, least + 1e-12);
  ck_assert_double_ge(found, least - 0.01);
}
END_TEST

/* The point of a channel at a part 0 .. 1 of it, and its radius there. */
static double point_of(const thr_kit_channel *channel, double part, double at[3])
{
  int i = (int)fmin(part * (channel->n - 1), channel->n - 2);
  double rest = part * (channel->n - 1) - i;
  for (int k = 0; k < 3; k++)
    at[k] = channel->point[i][k] + rest * (channel->point[i + 1][k] - channel->point[i][k]);
  return channel->radii[0] + part * (channel->radii[1] - channel->radii[0]);
}

/* The least material between two channels, by many points; below 0 where they cut each other. */
static double between(const thr_kit_channel *a, const thr_kit_channel *b)
{
  enum { STEPS = 180 };
  double least = INFINITY;
  for (int i = 0; i <= STEPS; i++)
    for (int j = 0; j <= STEPS; j++) {
      double p[3], q[3];
      double both = point_of(a, (double)i / STEPS, p) + point_of(b, (double)j / STEPS, q);
      least = fmin(least, thr_distance(p, q) - both);
    }
  return least;
}

/* Do two channels share a face at the same place, or a way out? */
static bool share(const thr_kit_channel *a, const thr_kit_channel *b)
{
  const int arms[2][2] = {{a->in, a->out}, {b->in, b->out}};
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      if (arms[0][i] == arms[1][j] &&
          thr_distance(a->point[i ? a->n - 1 : 0], b->point[j ? b->n - 1 : 0]) < 0.01)
        return true;
  return false;
}

/* Plans and options of kits. */
static const struct {
  thr_shape shape;
  int size;
  thr_kit_options options;
} kits[] = {
    {THR_MAKE_DOME, 4, {.names = THR_KIT_NO_NAMES}},
    {THR_MAKE_DOME, 4, {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES}},
    {THR_MAKE_SPHERE, 1, {.names = THR_KIT_NO_NAMES}},
    {THR_MAKE_SPHERE, 1, {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES}},
    {THR_MAKE_DOME, 4, {.names = THR_KIT_NO_NAMES, .width = 14, .crossings = THR_KIT_APART}},
    {THR_MAKE_TUBE,
     5,
     {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES, .crossings = THR_KIT_APART}},
};
enum { KITS = sizeof kits / sizeof *kits };

START_TEST(pairs_of_channels_that_cut_each_other_are_counted)
{
  thr_plan p = plan_of(kits[_i].shape, kits[_i].size);
  thr_kit kit = shapes_of(&p, &kits[_i].options, false);
  for (int q = 0; q < kit.n_pieces; q++) {
    const thr_kit_piece *piece = &kit.piece[q];
    int sure = 0, doubtful = 0;
    for (int i = 0; i < piece->n_channels; i++)
      for (int j = 0; j < i; j++) {
        const thr_kit_channel *a = &piece->channel[i], *b = &piece->channel[j];
        if (share(a, b)) continue;
        double gap = between(a, b);
        sure += gap < -0.05;
        doubtful += gap >= -0.05 && gap < 0.05;
      }
    int found = piece->cuts + piece->crossings;
    ck_assert_msg(found >= sure && found <= sure + doubtful, "%s: %d, not %d to %d", kit.name[q],
                  found, sure, sure + doubtful);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(crossings_are_led_apart_where_there_is_room)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 4);
  thr_channels channels = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_channels_make(&channels, &p, &err), THR_OK);
  thr_kit_options options = {.names = THR_KIT_NO_NAMES, .width = 14};
  thr_kit meet = shapes_of(&p, &options, false);
  options.crossings = THR_KIT_APART;
  thr_kit apart = shapes_of(&p, &options, false);
  int crossings = 0;
  for (int q = 0; q < meet.n_pieces; q++) {
    const thr_kit_piece *before = &meet.piece[q], *after = &apart.piece[q];
    crossings += before->crossings;
    ck_assert_int_le(before->cuts, 0);
    ck_assert_int_le(after->cuts + after->crossings, 0);

    /* Mouths stay, and so do walls. */
    for (int i = 0; i < before->n_channels; i++) {
      const thr_kit_channel *a = &before->channel[i], *b = &after->channel[i];
      ck_assert_double_lt(thr_distance(a->point[0], b->point[0]), 1e-12);
      ck_assert_double_lt(thr_distance(a->point[a->n - 1], b->point[b->n - 1]), 1e-12);
      ck_assert_double_ge(b->wall, fmin(a->wall, 1.2) - 1e-9);
    }
  }
  ck_assert_int_gt(crossings, 0);
  ck_assert_int_le(crossings, (int)channels.crossings);
  thr_channels_destroy(&channels);
  thr_kit_destroy(&meet);
  thr_kit_destroy(&apart);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("kit_fit");
  ADD_LOOP(s, 30, the_distance_of_segments_is_that_of_many_points, 0, 40);
  ADD_LOOP(s, 120, pairs_of_channels_that_cut_each_other_are_counted, 0, KITS);
  ADD_TEST(s, 60, crossings_are_led_apart_where_there_is_room);
  return run_suite(s);
}
