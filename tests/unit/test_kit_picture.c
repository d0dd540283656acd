/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a kit: a PNG whose chunks are whole, the same bytes twice, and pixels that are
 * known beforehand. The kit lies along x and is seen from the side: its cord runs through the
 * middle of the picture. */
#include "kit/picture.h"

#include "diagram/scene/scene.h"
#include "graph/number.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

/* Makes the kit of a path of so many edges. */
static void make_kit(thr_kit *kit, thr_plan *plan, int edges, thr_joint joint)
{
  static const thr_limits limits = {.threads = 1};
  thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  thr_err err = {0};
  thr_frame frame = path_make(edges + 1);
  for (int v = 0; v < frame.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      frame.xyz[v][k] *= 40;
  for (int e = 0; e < frame.n_edges; e++)
    frame.length[e] *= 40;
  frame.foot[0] = false;
  *plan = plan_simple(&frame, THR_ENDS_ANY, 1);
  plan->options.joint = joint;
  thr_frame_destroy(&frame);
  ck_assert_msg(thr_kit_make(kit, plan, &options, NULL, true, &limits, &err) == THR_OK, "%s",
                err.text);
}

/* Reads a number of four bytes, the largest first. */
static uint32_t number_at(const thr_text *png, size_t at)
{
  uint32_t number = 0;
  for (size_t i = 0; i < 4; i++)
    number = number << 8 | (unsigned char)png->data[at + i];
  return number;
}

/* Returns the check sum of n bytes, bit by bit (ISO 3309). */
static uint32_t sum_of(const char *bytes, size_t n)
{
  uint32_t sum = UINT32_MAX;
  for (size_t i = 0; i < 8 * n; i++) {
    uint32_t bit = (sum ^ (uint32_t)((unsigned char)bytes[i / 8] >> i % 8)) & 1;
    sum = sum >> 1 ^ (bit ? UINT32_C(0xedb88320) : 0);
  }
  return ~sum;
}

START_TEST(png_is_whole_and_the_same_twice)
{
  thr_kit kit;
  thr_plan plan;
  thr_err err = {0};
  make_kit(&kit, &plan, 1, THR_JOINT_TUBE);
  const thr_kit_view view = {.size = {120, 90}};
  thr_text png = {0}, again = {0};
  ck_assert_int_eq(thr_kit_picture(&kit, &view, &png, &err), THR_OK);
  ck_assert_int_eq(thr_kit_picture(&kit, &view, &again, &err), THR_OK);
  ck_assert_uint_eq(png.length, again.length);
  ck_assert_mem_eq(png.data, again.data, png.length);

  /* Signature, then chunks up to the end. */
  ck_assert_mem_eq(png.data, "\x89PNG\r\n\x1a\n", 8);
  ck_assert_uint_eq(number_at(&png, 16), 120);
  ck_assert_uint_eq(number_at(&png, 20), 90);
  size_t at = 8;
  int chunks = 0;
  for (; at < png.length; chunks++) {
    uint32_t n = number_at(&png, at);
    ck_assert_uint_le(at + 12 + n, png.length);
    ck_assert_uint_eq(number_at(&png, at + 8 + n), sum_of(png.data + at + 4, 4 + (size_t)n));
    at += 12 + n;
  }
  ck_assert_int_eq(chunks, 3);
  ck_assert_mem_eq(png.data + png.length - 8, "IEND", 4);

  thr_text_destroy(&png);
  thr_text_destroy(&again);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&plan);
}
END_TEST

/* Asserts how far a pixel's blue is from its red, of a picture from the side. */
static void assert_blue(const thr_kit *kit, bool opaque, const double at[2], int least, int most)
{
  const thr_kit_view view = {
      .size = {240, 180}, .from = true, .azimuth = -THR_PI / 2, .opaque = opaque};
  thr_err err = {0};
  unsigned char *pixel;
  int size[2];
  ck_assert_int_eq(thr_kit_pixels(kit, &view, &pixel, size, &err), THR_OK);
  ck_assert_int_eq(size[0], 240);
  ck_assert_int_eq(size[1], 180);
  const unsigned char *here = &pixel[3 * ((int)(at[1] * 180) * 240 + (int)(at[0] * 240))];
  ck_assert_int_ge(here[2] - here[0], least);
  ck_assert_int_le(here[2] - here[0], most);
  /* Behind everything it is white. */
  for (int k = 0; k < 3; k++)
    ck_assert_uint_eq(pixel[k], 255);
  free(pixel);
}

START_TEST(cord_is_seen_where_it_runs)
{
  thr_kit kit;
  thr_plan plan;
  make_kit(&kit, &plan, 1, THR_JOINT_SOLID);
  ck_assert_str_eq(thr_palette(0).hex, "#0072B2");

  /* In both pieces, but not if they are opaque, nor beside it. */
  const double left[2] = {0.4, 0.5}, right[2] = {0.6, 0.5}, beside[2] = {0.4, 0.54};
  assert_blue(&kit, false, left, 60, 178);
  assert_blue(&kit, false, right, 60, 178);
  assert_blue(&kit, true, left, -20, 30);
  assert_blue(&kit, false, beside, -20, 30);

  thr_kit_destroy(&kit);
  thr_plan_destroy(&plan);
}
END_TEST

START_TEST(cords_that_end_side_by_side_are_both_seen)
{
  thr_kit kit;
  thr_plan plan;
  thr_err err = {0};
  make_kit(&kit, &plan, 1, THR_JOINT_SOLID);
  thr_kit_destroy(&kit);

  /* Two cords over the same edge: their ends share a hollow. */
  int half[2] = {0, 0};
  thr_cord cord[2] = {plan.cord[0], plan.cord[0]}, *own = plan.cord;
  cord[1].half = &half[1];
  plan.cord = cord;
  plan.n_cords = 2;
  static const thr_limits limits = {.threads = 1};
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  ck_assert_int_eq(thr_kit_make(&kit, &plan, &options, NULL, true, &limits, &err), THR_OK);

  /* In their bore they lie at its sides. */
  double off[2][3];
  ck_assert_int_eq(thr_kit_edges_share(&kit.edges, &plan, kit.cord, off, &err), THR_OK);
  double apart = thr_distance(off[0], off[1]);
  ck_assert_double_eq_tol(apart, kit.edges.edge[0].bore - kit.cord, 1e-9);
  for (int k = 0; k < 3; k++)
    ck_assert_double_eq_tol(off[0][k], -off[1][k], 1e-9);

  /* Left of the node, where they come out: blue and vermilion. */
  const thr_kit_view view = {.size = {240, 180}, .from = true, .azimuth = -THR_PI / 2};
  unsigned char *pixel;
  int size[2], seen[2] = {0, 0};
  ck_assert_int_eq(thr_kit_pixels(&kit, &view, &pixel, size, &err), THR_OK);
  for (int y = 0; y < 180; y++)
    for (int x = 0; x < 30; x++) {
      const unsigned char *here = &pixel[3 * (240 * y + x)];
      seen[0] += here[2] - here[0] > 50;
      seen[1] += here[0] - here[2] > 50;
    }
  ck_assert_int_gt(seen[0], 10);
  ck_assert_int_gt(seen[1], 10);

  free(pixel);
  thr_kit_destroy(&kit);
  plan.cord = own;
  plan.n_cords = 1;
  thr_plan_destroy(&plan);
}
END_TEST

START_TEST(pieces_of_nodes_are_drawn_alone_and_apart)
{
  thr_kit kit;
  thr_plan plan;
  make_kit(&kit, &plan, 2, THR_JOINT_SOLID);
  thr_err err = {0};
  for (int i = 0; i < 3; i++) {
    const thr_kit_view view = {.size = {64, 48}, .alone = i, .explode = i == 0 ? 1.25 : 0};
    unsigned char *pixel;
    int size[2], dark = 0;
    ck_assert_int_eq(thr_kit_pixels(&kit, &view, &pixel, size, &err), THR_OK);
    for (int k = 0; k < 64 * 48; k++)
      dark += pixel[3 * k] < 230;
    ck_assert_int_gt(dark, 20);
    free(pixel);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&plan);
}
END_TEST

START_TEST(what_cannot_be_drawn_is_refused)
{
  thr_kit kit;
  thr_plan plan;
  make_kit(&kit, &plan, 1, THR_JOINT_SOLID);
  const thr_kit_view view[3] = {{.size = {15, 90}}, {.size = {90, 10001}}, {.alone = 3}};
  for (int i = 0; i < 3; i++) {
    thr_err err = {0};
    thr_text png = {0};
    ck_assert_int_eq(thr_kit_picture(&kit, &view[i], &png, &err), THR_EINPUT);
    assert_one_line(&err, i == 2 ? "pieces" : "px");
    ck_assert_uint_eq(png.length, 0);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&plan);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("kit picture");
  ADD_TEST(s, 20, png_is_whole_and_the_same_twice);
  ADD_TEST(s, 20, cord_is_seen_where_it_runs);
  ADD_TEST(s, 20, cords_that_end_side_by_side_are_both_seen);
  ADD_TEST(s, 20, pieces_of_nodes_are_drawn_alone_and_apart);
  ADD_TEST(s, 20, what_cannot_be_drawn_is_refused);
  return run_suite(s);
}
