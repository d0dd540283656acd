/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tension plot, the overview coloured by tension and by turning, and the still picture: heights
 * against tensions, lightness against angles, order against depth, rotated poses against a rotated
 * framework. */
#include "diagram/overview/overview.h"
#include "diagram/scene/scene.h"
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE "\xC2\xB0"

/* ---- plans with tensions ---- */

static thr_plan path_plan(int n_passes, int n_cords)
{
  thr_plan p = {.frame = path_make(n_passes + 1),
                .n_cords = n_cords,
                .cord = thr_calloc((size_t)n_cords, sizeof(thr_cord))};
  thr_evaluation *e = &p.evaluation;
  *e = (thr_evaluation){
      .present = true, .method = THR_JOINT, .physics = thr_physics_default(), .n_cords = n_cords};
  e->cord = thr_calloc((size_t)n_cords, sizeof *e->cord);
  ck_assert(p.cord && e->cord);
  for (int c = 0; c < n_cords; c++) {
    thr_cord_id(c, p.cord[c].id);
    p.cord[c].n_passes = n_passes;
    p.cord[c].half = thr_calloc((size_t)n_passes, sizeof(int));
    e->cord[c] = (thr_eval_cord){
        .known = true, .pull = THR_PULL_START, .n_passes = n_passes, .slackest = n_passes - 1};
    e->cord[c].tension = thr_calloc((size_t)n_passes, sizeof(double));
    ck_assert(p.cord[c].half && e->cord[c].tension);
    for (int k = 0; k < n_passes; k++)
      p.cord[c].half[k] = 2 * k;
  }
  return p;
}

/* Tension falls from pull to 1 by equal factors, pulled at the start. */
static void fill(thr_plan *p, int c, double pull)
{
  thr_eval_cord *r = &p->evaluation.cord[c];
  for (int k = 0; k < r->n_passes; k++)
    r->tension[k] = pow(pull, 1 - k / (double)(r->n_passes - 1));
  r->force = pull;
  r->loss = 1 - 1 / pull;
  thr_evaluation_sum(&p->evaluation);
}

static thr_text plot(const thr_plan *p)
{
  thr_text svg = {0};
  thr_err err = {0};
  thr_tension_options o = thr_tension_options_default();
  assert_ok(thr_tension_svg(p, &o, &svg, &err), &err);
  return svg;
}

/* Text of at least 7 pt everywhere. */
static void assert_legible(const char *svg)
{
  int n = 0;
  for (const char *s = strstr(svg, "font-size=\""); s; s = strstr(s + 1, "font-size=\"")) {
    ck_assert_double_ge(atof(s + 11), 7 * 25.4 / 72);
    n++;
  }
  ck_assert_int_gt(n, 3);
}

/* Heights of a cord's steps, from the path's M and V commands; returns their number. */
static int heights(const char *svg, const char *id, double *y)
{
  char group[40];
  snprintf(group, sizeof group, "<g id=\"cord-%s\">", id);
  const char *s = strstr(svg, group);
  ck_assert_ptr_nonnull(s);
  s = strstr(s, " d=\"M") + 5;
  double x;
  int n = 0;
  ck_assert_int_eq(sscanf(s, "%lf %lf", &x, &y[n++]), 2);
  for (; *s != '"'; s++)
    if (*s == 'V') y[n++] = atof(s + 1);
  return n;
}

START_TEST(steps_are_as_high_as_the_logarithm)
{
  thr_plan p = path_plan(12, 2);
  double y[16];
  fill(&p, 0, 1000);
  fill(&p, 1, 50);
  thr_text svg = plot(&p);
  assert_legible(svg.data);
  for (int c = 0; c < 2; c++) {
    const thr_eval_cord *r = &p.evaluation.cord[c];
    ck_assert_int_eq(heights(svg.data, c ? "B" : "A", y), 12);
    double mm_per_log = (y[11] - y[0]) / log(r->tension[0] / r->tension[11]);
    for (int k = 0; k < 12; k++)
      ck_assert_double_eq_tol(y[11] - y[k], mm_per_log * log(r->tension[k] / r->tension[11]),
                              0.011);
  }
  ck_assert_ptr_nonnull(strstr(svg.data, ">1000<"));
  ck_assert_ptr_nonnull(strstr(svg.data, "log scale"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

/* Heights of the steps of a fan, there and back. */
static int fan_heights(const char *svg, const char *id, double *y)
{
  char name[40];
  int n = 0;
  snprintf(name, sizeof name, "<path id=\"fan-%s\"", id);
  const char *s = strstr(svg, name);
  ck_assert_ptr_nonnull(s);
  for (s = strstr(s, " d=\"M") + 5; *s != '"'; s++)
    if (*s == 'V') y[n++] = atof(s + 1);
  return n;
}

static double line_height(const char *svg, const char *word)
{
  char start[40];
  double x, y;
  snprintf(start, sizeof start, "<path class=\"%s\" d=\"M", word);
  const char *s = strstr(svg, start);
  ck_assert_ptr_nonnull(s);
  ck_assert_int_eq(sscanf(s + strlen(start), "%lf %lf", &x, &y), 2);
  return y;
}

/* The fan is as high as the tensions at both ends of the band, and the limits lie among them, on
 * the scale of the line's steps.
 */
START_TEST(the_fan_and_the_limits_are_to_scale)
{
  enum { N = 9 };
  thr_plan p = path_plan(N, 1), low = path_plan(N, 1), high = path_plan(N, 1);
  thr_tension_options o = thr_tension_options_default();
  thr_text svg = {0};
  double y[N + 1], fan[2 * N + 2];
  fill(&p, 0, 40);
  fill(&low, 0, 6);
  fill(&high, 0, 300);
  o.low = &low.evaluation;
  o.high = &high.evaluation;
  o.hand = true;
  o.strength = 80;
  ck_assert_int_eq(thr_tension_svg(&p, &o, &svg, NULL), THR_OK);
  assert_legible(svg.data);
  ck_assert_int_eq(heights(svg.data, "A", y), N);
  double mm_per_log = (y[N - 1] - y[0]) / log(40);
  ck_assert_int_eq(fan_heights(svg.data, "A", fan), 2 * N);
  for (int k = 0; k < N; k++) {
    ck_assert_double_eq_tol(y[N - 1] - fan[k], mm_per_log * log(high.evaluation.cord[0].tension[k]),
                            0.02);
    ck_assert_double_eq_tol(y[N - 1] - fan[N + k],
                            mm_per_log * log(low.evaluation.cord[0].tension[N - 1 - k]), 0.02);
  }
  ck_assert_double_eq_tol(y[N - 1] - line_height(svg.data, "strength"), mm_per_log * log(80), 0.02);
  ck_assert_double_eq_tol(y[N - 1] - line_height(svg.data, "hand"), mm_per_log * log(50), 0.02);
  ck_assert_ptr_nonnull(strstr(svg.data, ">80 N<"));
  ck_assert_ptr_nonnull(strstr(svg.data, ">10 N<"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
  thr_plan_destroy(&low);
  thr_plan_destroy(&high);
}
END_TEST

START_TEST(small_ratios_are_drawn_from_zero)
{
  thr_plan p = path_plan(5, 1);
  double y[8], x, top, width, height;
  fill(&p, 0, 8);
  thr_text svg = plot(&p);
  ck_assert_int_eq(heights(svg.data, "A", y), 5);
  const char *box = strstr(svg.data, "<rect class=\"axis\"");
  ck_assert_int_eq(sscanf(box,
                          "<rect class=\"axis\" x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"",
                          &x, &top, &width, &height),
                   4);
  for (int k = 0; k < 5; k++)
    ck_assert_double_eq_tol((top + height - y[k]) / (top + height - y[4]),
                            p.evaluation.cord[0].tension[k], 0.02);
  ck_assert_ptr_null(strstr(svg.data, "log scale"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

/* Every cord up to the limit has its group; beyond it the strongest do and a note tells the rest.
 */
START_TEST(many_cords)
{
  static const int counts[] = {1, 6, 7, 48, 70};
  for (int i = 0; i < 5; i++) {
    int n = counts[i], found = 0;
    thr_plan p = path_plan(3, n);
    for (int c = 0; c < n; c++)
      fill(&p, c, 2 + (c * 37) % 71);
    p.evaluation.cord[n - 1].known = n == 1;
    thr_text svg = plot(&p), again = plot(&p);
    assert_same_text(&svg, &again);
    assert_legible(svg.data);
    int known = n == 1 ? 1 : n - 1;
    for (int c = 0; c < n; c++) {
      char id[12], group[40];
      int stronger = 0;
      thr_cord_id(c, id);
      snprintf(group, sizeof group, "<g id=\"cord-%s\">", id);
      for (int k = 0; k < n; k++)
        stronger +=
            p.evaluation.cord[k].known && p.evaluation.cord[k].force > p.evaluation.cord[c].force;
      bool shown = strstr(svg.data, group) != NULL;
      ck_assert_int_eq(shown, p.evaluation.cord[c].known && stronger < THR_TENSION_PANELS);
      found += shown;
    }
    ck_assert_int_eq(found, known < THR_TENSION_PANELS ? known : THR_TENSION_PANELS);
    ck_assert_int_eq(strstr(svg.data, "largest pull, of") != NULL, known > THR_TENSION_PANELS);
    ck_assert_int_eq(strstr(svg.data, "are not known") != NULL, n > 1);
    thr_text_destroy(&svg);
    thr_text_destroy(&again);
    thr_plan_destroy(&p);
  }
}
END_TEST

START_TEST(extreme_tensions)
{
  static const double pulls[] = {1, 1 + 1e-12, 1e12, 1e290};
  for (int i = 0; i < 4; i++) {
    thr_plan p = path_plan(4, 1);
    fill(&p, 0, pulls[i]);
    snprintf(p.cord[0].id, sizeof p.cord[0].id, "<&\"");
    snprintf(p.frame.units, sizeof p.frame.units, "<m>");
    thr_text svg = plot(&p);
    ck_assert_ptr_null(strstr(svg.data, "nan"));
    ck_assert_ptr_null(strstr(svg.data, "inf"));
    ck_assert_ptr_null(strstr(svg.data, "<m>"));
    ck_assert_ptr_nonnull(strstr(svg.data, "&lt;&amp;&quot;"));
    thr_text_destroy(&svg);
    thr_plan_destroy(&p);
  }
}
END_TEST

/* Lines of the heading may break anywhere between words. */
static bool says(const char *svg, const char *words)
{
  thr_text flat = {0};
  for (const char *s = svg; *s; s++) {
    if (*s == '<')
      s += strcspn(s, ">");
    else
      thr_text_append_bytes(&flat, *s == '\n' ? " " : s, 1);
    if (!*s) break;
  }
  char *to = flat.data;
  for (const char *s = flat.data; *s; s++)
    if (*s != ' ' || s[1] != ' ') *to++ = *s;
  *to = '\0';
  bool there = strstr(flat.data, words) != NULL;
  thr_text_destroy(&flat);
  return there;
}

/* A turn by closed form takes the upper end off the error, in the words about the method too. */
START_TEST(turns_by_closed_form_are_said)
{
  thr_plan p = path_plan(4, 2);
  fill(&p, 0, 8);
  fill(&p, 1, 3);
  p.evaluation.cord[1].error = log(1.25);
  thr_text svg = plot(&p);
  ck_assert(says(svg.data, "each within 25 %"));
  ck_assert(!says(svg.data, "closed form"));
  thr_text_destroy(&svg);
  p.evaluation.cord[0].refused = 2;
  p.evaluation.cord[1].refused = 1;
  svg = plot(&p);
  ck_assert(says(svg.data, "error at least 25 %: 3 of the turns by closed form"));
  ck_assert(says(svg.data, "some turns by closed form"));
  ck_assert(!says(svg.data, "within"));
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(without_a_usable_evaluation)
{
  thr_plan p = path_plan(4, 2);
  thr_text svg = {0};
  thr_tension_options o = thr_tension_options_default();
  thr_overview_options colours = thr_overview_options_default();
  colours.colour = THR_COLOUR_TENSION;
  fill(&p, 0, 3);
  fill(&p, 1, 4);
  for (int i = 0; i < 4; i++) {
    static const char *const word[] = {"thread eval", "2 cords|1 cords", "passes", "stopped"};
    thr_evaluation keep = p.evaluation;
    thr_err err = {0}, again = {0};
    if (i == 0) p.evaluation.present = false;
    if (i == 1) p.evaluation.n_cords = 1;
    if (i == 2) p.evaluation.cord[1].n_passes = 3;
    if (i == 3) p.evaluation.cord[0].known = p.evaluation.cord[1].known = false;
    ck_assert_int_eq(thr_tension_svg(&p, &o, &svg, &err), THR_EINPUT);
    ck_assert_int_eq(thr_overview_svg(&p, &colours, &svg, &again), THR_EINPUT);
    assert_one_line(&err, i == 1 ? "evaluate it again" : word[i]);
    ck_assert_str_eq(err.text, again.text);
    p.evaluation = keep;
    p.evaluation.cord[1].n_passes = 4;
  }
  ck_assert_int_eq((int)svg.length, 0);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- overview ---- */

static int count(const char *s, const char *what)
{
  int n = 0;
  for (s = strstr(s, what); s; s = strstr(s + 1, what))
    n++;
  return n;
}

static const char *pass_colour(const char *svg, const char *pass)
{
  char key[64];
  snprintf(key, sizeof key, "<g id=\"%s\" stroke=\"", pass);
  const char *s = strstr(svg, key);
  ck_assert_ptr_nonnull(s);
  return s + strlen(key);
}

START_TEST(overview_shows_tension)
{
  thr_frame f = grid_make(3, 2);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_evaluation *e = &p.evaluation;
  *e = (thr_evaluation){.present = true,
                        .physics = thr_physics_default(),
                        .n_cords = 1,
                        .cord = thr_calloc(1, sizeof *e->cord)};
  ck_assert_ptr_nonnull(e->cord);
  int n = p.cord[0].n_passes;
  e->cord[0] = (thr_eval_cord){
      .known = true, .n_passes = n, .tension = thr_calloc((size_t)n, sizeof(double))};
  ck_assert_ptr_nonnull(e->cord[0].tension);
  for (int k = 0; k < n; k++)
    e->cord[0].tension[k] = 1 + k;
  thr_text plain = {0}, svg = {0};
  thr_overview_options o = thr_overview_options_default();
  ck_assert_int_eq(thr_overview_svg(&p, &o, &plain, NULL), THR_OK);
  o.colour = THR_COLOUR_TENSION;
  ck_assert_int_eq(thr_overview_svg(&p, &o, &svg, NULL), THR_OK);
  const double range[2] = {1, n};
  for (int k = 0; k < n; k++) {
    char hex[8], id[16];
    thr_tension_colour(range, 1 + k, hex);
    snprintf(id, sizeof id, "A-%d", k + 1);
    ck_assert_int_eq(strncmp(pass_colour(svg.data, id), hex, 7), 0);
    const char *lane = strstr(pass_colour(plain.data, id), "class=\"cord\""),
               *same = strstr(pass_colour(svg.data, id), "class=\"cord\"");
    ck_assert_int_eq(strncmp(lane, same, strcspn(lane, ">")), 0); /* nothing moves */
  }
  ck_assert_ptr_nonnull(strstr(svg.data, "id=\"tension-scale\""));
  ck_assert_ptr_null(strstr(plain.data, "id=\"tension-scale\""));
  assert_legible(svg.data);
  thr_text_destroy(&svg);
  thr_text_destroy(&plain);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- overview: turning ---- */

/* Linear light of a colour "#rrggbb". */
static void light_of(const char *hex, double light[3])
{
  unsigned value[3];
  ck_assert_int_eq(sscanf(hex, "#%2x%2x%2x", &value[0], &value[1], &value[2]), 3);
  for (int i = 0; i < 3; i++)
    light[i] =
        value[i] <= 10 ? value[i] / 255. / 12.92 : pow((value[i] / 255. + 0.055) / 1.055, 2.4);
}

/* Oklab by way of CIE XYZ, as its author defines it. */
static void oklab_of(const char *hex, double lab[3])
{
  static const double xyz_of[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                      {0.2126729, 0.7151522, 0.0721750},
                                      {0.0193339, 0.1191920, 0.9503041}};
  static const double cone_of[3][3] = {{0.8189330101, 0.3618667424, -0.1288597137},
                                       {0.0329845436, 0.9293118715, 0.0361456387},
                                       {0.0482003018, 0.2643662691, 0.6338517070}};
  static const double lab_of[3][3] = {{0.2104542553, 0.7936177850, -0.0040720468},
                                      {1.9779984951, -2.4285922050, 0.4505937099},
                                      {0.0259040371, 0.7827717662, -0.8086757660}};
  double light[3], xyz[3], cone[3];
  light_of(hex, light);
  for (int i = 0; i < 3; i++)
    xyz[i] = xyz_of[i][0] * light[0] + xyz_of[i][1] * light[1] + xyz_of[i][2] * light[2];
  for (int i = 0; i < 3; i++)
    cone[i] = cbrt(cone_of[i][0] * xyz[0] + cone_of[i][1] * xyz[1] + cone_of[i][2] * xyz[2]);
  for (int i = 0; i < 3; i++)
    lab[i] = lab_of[i][0] * cone[0] + lab_of[i][1] * cone[1] + lab_of[i][2] * cone[2];
}

/* CIE lightness, 0 .. 100, of a luminance 0 .. 1. */
static double lightness(double luminance)
{
  return 116 * cbrt(luminance) - 16;
}

/* Lightness as readers with normal vision, without red and without green cones see it (Vienot,
 * Brettel, Mollon 1999). */
static void lightness_seen(const char *hex, double seen[3])
{
  static const double sight[3][2] = {
      {0.2126729, 0.7151522}, {0.11238, 0.88762}, {0.29275, 0.70725}};
  double light[3];
  light_of(hex, light);
  seen[0] = lightness(sight[0][0] * light[0] + sight[0][1] * light[1] + 0.0721750 * light[2]);
  for (int i = 1; i < 3; i++) { /* red and green fall together; blue stays */
    double both = sight[i][0] * light[0] + sight[i][1] * light[1],
           rest = (i == 1 ? 0.00401 : -0.02234) * (light[0] - light[1]);
    seen[i] = lightness((sight[0][0] + sight[0][1]) * both + 0.0721750 * (rest + light[2]));
  }
}

START_TEST(turns_have_even_colours)
{
  double first[3], last[3], lab[3], seen[3], before[3] = {101, 101, 101};
  char hex[8];
  thr_turning_colour(0, hex);
  oklab_of(hex, first);
  thr_turning_colour(THR_PI, hex);
  oklab_of(hex, last);
  ck_assert_double_gt(first[0] - last[0], 0.6);
  for (int degrees = 0; degrees <= 180; degrees += 5) {
    thr_turning_colour(degrees * THR_PI / 180, hex);
    oklab_of(hex, lab);
    for (int i = 0; i < 3; i++)
      ck_assert_double_eq_tol(lab[i], first[i] + (last[i] - first[i]) * degrees / 180, 0.006);
    if (degrees % 30) continue;
    lightness_seen(hex, seen);
    for (int i = 0; i < 3; i++) {
      ck_assert_double_gt(before[i] - seen[i], 8);
      before[i] = seen[i];
    }
  }
  char more[8], less[8];
  thr_turning_colour(THR_PI, hex);
  thr_turning_colour(4, more);
  ck_assert_str_eq(hex, more);
  thr_turning_colour(0, hex);
  thr_turning_colour(-1, less);
  ck_assert_str_eq(hex, less);
}
END_TEST

/* Copies have their cord's hue, are lighter than any cord and darker than a bead, for every reader.
 */
START_TEST(pale_colours_stand_between_cords_and_beads)
{
  double bead[3], strong[3], pale[3], lab[3], paler[3];
  lightness_seen("#f3f1ea", bead);
  for (int i = 0; i < THR_COLOURS; i++) {
    oklab_of(thr_palette(i).hex, lab);
    oklab_of(thr_palette(i).pale, paler);
    ck_assert_double_lt(fabs(sin(atan2(lab[2], lab[1]) - atan2(paler[2], paler[1]))), 0.03);
    ck_assert_double_lt(hypot(paler[1], paler[2]), 0.75 * hypot(lab[1], lab[2]));
    lightness_seen(thr_palette(i).pale, pale);
    for (int k = 0; k < 3; k++)
      ck_assert_double_gt(bead[k] - pale[k], 7);
    for (int j = 0; j < THR_COLOURS; j++) {
      lightness_seen(thr_palette(j).hex, strong);
      for (int k = 0; k < 3; k++)
        ck_assert_double_gt(pale[k] - strong[k], i == j ? 8 : 3);
    }
  }
}
END_TEST

/* A cord along unit edges in the plane that turns by these degrees, left and right. */
static thr_plan bent_plan(int n_turns, const int *degrees)
{
  double xyz[16][3] = {{0}}, heading = 0;
  int edge[16][2];
  for (int k = 0; k <= n_turns; k++) {
    if (k) heading += (k % 2 ? 1 : -1) * degrees[k - 1] * THR_PI / 180;
    xyz[k + 1][0] = xyz[k][0] + cos(heading);
    xyz[k + 1][1] = xyz[k][1] + sin(heading);
    edge[k][0] = k;
    edge[k][1] = k + 1;
  }
  thr_plan p = {
      .n_cords = 1, .cord = thr_calloc(1, sizeof(thr_cord)), .options = thr_request_default()};
  ck_assert_ptr_nonnull(p.cord);
  p.frame = frame_make(n_turns + 2, (const double(*)[3])xyz, n_turns + 1, (const int(*)[2])edge,
                       NULL, NULL);
  p.options.ends = THR_ENDS_ANY;
  p.cord[0] = (thr_cord){
      .id = "A", .n_passes = n_turns + 1, .half = thr_calloc((size_t)n_turns + 1, sizeof(int))};
  ck_assert_ptr_nonnull(p.cord[0].half);
  for (int k = 0; k <= n_turns; k++)
    p.cord[0].half[k] = 2 * k;
  return p;
}

/* The angle in degrees that a colour stands for, from its lightness. */
static double angle_of_colour(const char *hex)
{
  double first[3], last[3], lab[3];
  char end[8];
  thr_turning_colour(0, end);
  oklab_of(end, first);
  thr_turning_colour(THR_PI, end);
  oklab_of(end, last);
  oklab_of(hex, lab);
  return 180 * (first[0] - lab[0]) / (first[0] - last[0]);
}

static thr_text overview(const thr_plan *p, thr_overview_colour colour)
{
  thr_text svg = {0};
  thr_err err = {0};
  thr_overview_options o = thr_overview_options_default();
  o.colour = colour;
  assert_ok(thr_overview_svg(p, &o, &svg, &err), &err);
  return svg;
}

/* Angles of the coloured pieces of a pass (at most 2) and their path data; returns their number. */
static int pieces_of(const char *svg, const char *pass, double angle[2], char data[2][200])
{
  int n = 0;
  const char *s = pass_colour(svg, pass), *end = strstr(s, "</g>");
  for (s = strstr(s, "class=\"turn\""); s && s < end; s = strstr(s + 1, "class=\"turn\""), n++) {
    ck_assert_int_lt(n, 2);
    angle[n] = angle_of_colour(strstr(s, "stroke=\"") + 8);
    ck_assert_int_eq(sscanf(s, "class=\"turn\" stroke=\"%*[^\"]\" d=\"%199[^\"]", data[n]), 1);
  }
  return n;
}

/* Both halves of every turn have its colour and meet; together they are the pass as it is drawn by
 * cord. */
START_TEST(overview_shows_turning)
{
  static const int degrees[] = {0, 30, 60, 90, 91, 120, 150, 17};
  enum { TURNS = sizeof degrees / sizeof *degrees };
  thr_plan p = bent_plan(TURNS, degrees);
  thr_text svg = overview(&p, THR_COLOUR_TURNING), plain = overview(&p, THR_COLOUR_CORD);
  for (int k = 0; k <= TURNS; k++) {
    char id[24], sharp[24], data[2][200], lane[300];
    double angle[2], start[2], end[2];
    snprintf(id, sizeof id, "A-%d", k + 1);
    int n = pieces_of(svg.data, id, angle, data), inner = k > 0 && k < TURNS;
    ck_assert_int_eq(n, 1 + inner);
    if (k > 0) ck_assert_double_eq_tol(angle[0], degrees[k - 1], 1.5);
    if (k < TURNS) ck_assert_double_eq_tol(angle[inner], degrees[k], 1.5);
    snprintf(sharp, sizeof sharp, "\"t-A-%d\"", k + 1);
    ck_assert_int_eq(strstr(svg.data, sharp) != NULL, k > 0 && degrees[k - 1] > 90);
    ck_assert_int_eq(sscanf(strstr(pass_colour(plain.data, id), "class=\"cord\""),
                            "class=\"cord\" d=\"%299[^\"]", lane),
                     1);
    if (!inner) continue;
    ck_assert_int_eq(strncmp(lane, data[0], strcspn(data[0], "L")), 0); /* the curve */
    ck_assert_str_eq(strrchr(lane, 'L'), strrchr(data[1], 'L'));        /* the end of the lane */
    ck_assert_int_eq(sscanf(strrchr(data[0], 'L'), "L%lf %lf", &start[0], &start[1]), 2);
    ck_assert_int_eq(sscanf(data[1], "M%lf %lf", &end[0], &end[1]), 2);
    ck_assert_double_eq_tol(hypot(start[0] - end[0], start[1] - end[1]), 0, 1e-9);
  }
  ck_assert_ptr_null(strstr(plain.data, "class=\"turn\""));
  ck_assert_ptr_null(strstr(plain.data, "turning-scale"));
  ck_assert_ptr_nonnull(strstr(svg.data, "id=\"turning-scale\""));
  for (int tick = 0; tick <= 180; tick += 30) {
    char label[32];
    snprintf(label, sizeof label, ">%d</text>", tick);
    ck_assert_ptr_nonnull(strstr(strstr(svg.data, "id=\"turning-scale\""), label));
  }
  ck_assert(says(svg.data, "turn in a piece"));
  ck_assert(says(svg.data, "558" DEGREE " of turning, sharpest turn 150" DEGREE ", 4 over 60" DEGREE
                           ", 3 over 90" DEGREE));
  assert_legible(svg.data);
  thr_text_destroy(&svg);
  thr_text_destroy(&plain);
  thr_plan_destroy(&p);
}
END_TEST

/* Rings: the turn that closes the cord counts with closed ends only, and then colours both ends. */
START_TEST(closing_turns)
{
  static const struct {
    int corners;
    thr_ends ends;
    const char *words;
  } table[] = {{3, THR_ENDS_CLOSED,
                "360" DEGREE " of turning, sharpest turn 120" DEGREE ", 3 over 60" DEGREE
                ", 3 over 90" DEGREE},
               {3, THR_ENDS_ANY,
                "240" DEGREE " of turning, sharpest turn 120" DEGREE ", 2 over 60" DEGREE
                ", 2 over 90" DEGREE},
               {4, THR_ENDS_CLOSED,
                "360" DEGREE " of turning, sharpest turn 90" DEGREE ", 4 over 60" DEGREE
                ", 0 over 90" DEGREE},
               {6, THR_ENDS_CLOSED,
                "360" DEGREE " of turning, sharpest turn 60" DEGREE ", 0 over 60" DEGREE
                ", 0 over 90" DEGREE}};
  int n = table[_i].corners;
  bool closed = table[_i].ends == THR_ENDS_CLOSED;
  thr_frame f = ring_make(n);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  ck_assert_int_eq(p.cord[0].n_passes, n);
  p.options.ends = table[_i].ends;
  thr_text svg = overview(&p, THR_COLOUR_TURNING);
  ck_assert_msg(says(svg.data, table[_i].words), "%s", table[_i].words);
  for (int k = 1; k <= n; k++) {
    char id[24], data[2][200];
    double angle[2];
    snprintf(id, sizeof id, "A-%d", k);
    int pieces = pieces_of(svg.data, id, angle, data);
    ck_assert_int_eq(pieces, closed || (k > 1 && k < n) ? 2 : 1);
    for (int i = 0; i < pieces; i++)
      ck_assert_double_eq_tol(angle[i], 360. / n, 1.5);
  }
  ck_assert_ptr_null(strstr(svg.data, "id=\"t-A-1\""));
  ck_assert_int_eq(strstr(svg.data, "id=\"t-A-2\"") != NULL, n == 3);
  ck_assert_int_eq(strstr(svg.data, "id=\"t-A-3\"") != NULL, n == 3);
  /* the turn that closes a cord is between its two ends: no curve to put a sign on */
  ck_assert_int_eq(strstr(svg.data, ">over 90" DEGREE " (not all)<") != NULL, n == 3 && closed);
  ck_assert_int_eq(strstr(svg.data, ">over 90" DEGREE "<") != NULL, n == 3 && !closed);
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Every cord keeps its colour beside those of its turns, and has its own sum; the sum of all is the
 * plan's. */
START_TEST(turning_of_several_cords)
{
  enum { CORDS = 3 };
  thr_frame f = triangles_make(CORDS);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_err err = {0};
  ck_assert_int_eq(p.n_cords, CORDS);
  p.options.ends = THR_ENDS_ANY;
  p.cord[1].n_passes = 2; /* turns once only */
  p.cord[1].closed = false;
  thr_text svg = overview(&p, THR_COLOUR_TURNING);
  for (int c = 0; c < CORDS; c++) {
    char id[24], number[24];
    snprintf(id, sizeof id, "%s-1", p.cord[c].id);
    snprintf(number, sizeof number, "n-%s-1", p.cord[c].id);
    ck_assert_int_eq(strncmp(pass_colour(svg.data, id), thr_palette(c).hex, 7), 0);
    const char *pill = strstr(svg.data, number);
    ck_assert_int_eq(strncmp(strstr(pill, "stroke=\"") + 8, thr_palette(c).hex, 7), 0);
  }
  thr_metrics m;
  ck_assert_int_eq(thr_plan_measure(&p.frame, &p.options, p.cord, CORDS, &m, &err), THR_OK);
  ck_assert_double_eq_tol(m.turning * 180 / THR_PI, 600, 1e-9);
  ck_assert(says(svg.data, "All cords: 600" DEGREE " of turning, sharpest turn 120" DEGREE
                           ", 5 over 60" DEGREE ", 5 over 90" DEGREE));
  ck_assert_int_eq(count(svg.data, ">240" DEGREE " of turning, sharpest turn 120" DEGREE
                                   ", 2 over 60" DEGREE ", 2 over 90" DEGREE "<"),
                   2);
  ck_assert_int_eq(count(svg.data, ">120" DEGREE " of turning, sharpest turn 120" DEGREE
                                   ", 1 over 60" DEGREE ", 1 over 90" DEGREE "<"),
                   1);
  assert_legible(svg.data);
  thr_text_destroy(&svg);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- still picture ---- */

static thr_text still_of(const thr_frame *f, const double (*pose)[7], int first)
{
  thr_text svg = {0};
  thr_err err = {0};
  const thr_still_panel panel[] = {{"before", "Before: whole", pose},
                                   {"after", "After: open", pose}};
  const thr_still s = {
      .width = 0.3, .ground = -0.15, .n_panels = 2, .panel = panel, .first_bead = first};
  double bottom;
  assert_ok(thr_still_panels(f, &s, (thr_box){0, 0, 268, 139}, &bottom, &svg, &err), &err);
  return svg;
}

static void rest_poses(const thr_frame *f, double (*pose)[7])
{
  for (int v = 0; v < f->n_nodes; v++) {
    memset(pose[v], 0, sizeof *pose);
    memcpy(pose[v], f->xyz[v], sizeof f->xyz[v]);
    pose[v][6] = 1;
  }
}

/* Two halves of one edge: of each box two sides face the eye, and of the two ends in the middle
 * exactly one. */
START_TEST(only_faces_that_can_be_seen)
{
  static const double ends[][2][3] = {{{0, 0, 0}, {1, 0.3, 0.2}},
                                      {{0, 0, 0}, {-1, 0.4, 0.1}},
                                      {{1, 2, 3}, {1.1, 2.9, 2.4}},
                                      {{0, 0, 0}, {0.2, 0.1, 1}}};
  for (int i = 0; i < 4; i++) {
    thr_frame f = frame_make(2, ends[i], 1, (const int[][2]){{0, 1}}, NULL, NULL);
    double pose[2][7];
    rest_poses(&f, pose);
    thr_text svg = still_of(&f, (const double(*)[7])pose, -1);
    ck_assert_int_eq(count(svg.data, "<path fill="), 2 * 5);
    thr_text_destroy(&svg);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* All numbers of a text that stand in paths, to compare two pictures. */
static int path_numbers(const char *svg, double *out, int most)
{
  int n = 0;
  for (const char *s = strstr(svg, " d=\"M"); s; s = strstr(s, " d=\"M"))
    for (s += 4; *s != '"';) {
      char *end;
      double x = strtod(s, &end);
      if (end == s) {
        s++;
        continue;
      }
      ck_assert_int_lt(n, most);
      out[n++] = x;
      s = end;
    }
  return n;
}

/* A quarter turn about the vertical, once in the poses and once in the framework: arms are level
 * either way. */
START_TEST(poses_turn_beads)
{
  enum { MOST = 8192 };
  rng r = rng_make(4);
  thr_frame f = random_frame(&r, 7, 3, LENGTHS_EUCLID), g = {0};
  ck_assert_int_eq(thr_frame_copy(&g, &f, NULL), THR_OK);
  double pose[7][7], rest[7][7], *a = thr_calloc(MOST, sizeof *a), *b = thr_calloc(MOST, sizeof *b);
  ck_assert(a && b);
  for (int v = 0; v < 7; v++) {
    g.xyz[v][0] = -f.xyz[v][1];
    g.xyz[v][1] = f.xyz[v][0];
  }
  rest_poses(&g, rest);
  memcpy(pose, rest, sizeof pose);
  for (int v = 0; v < 7; v++)
    pose[v][5] = pose[v][6] = sqrt(0.5);
  thr_text turned = still_of(&f, (const double(*)[7])pose, 3),
           straight = still_of(&g, (const double(*)[7])rest, 3);
  int n = path_numbers(turned.data, a, MOST);
  ck_assert_int_eq(path_numbers(straight.data, b, MOST), n);
  ck_assert_int_gt(n, 200);
  for (int i = 0; i < n; i++)
    ck_assert_double_eq_tol(a[i], b[i], 0.015);
  thr_text_destroy(&turned);
  thr_text_destroy(&straight);
  free(a);
  free(b);
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
}
END_TEST

/* Two bars, one in front of the other as seen from the eye (its direction: the plot's own faces
 * tell by who is painted last when they change places). */
START_TEST(the_nearer_is_painted_last)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, -3, 0}, {1, -3, 0}};
  thr_frame f = frame_make(4, xyz, 2, (const int[][2]){{0, 1}, {2, 3}}, NULL, NULL);
  double pose[4][7];
  for (int swapped = 0; swapped < 2; swapped++) {
    rest_poses(&f, pose);
    for (int v = 0; v < 4 && swapped; v++)
      pose[v][1] = v < 2 ? -3 : 0;
    thr_text svg = still_of(&f, (const double(*)[7])pose, 2); /* bead 2 is in another colour */
    const char *last = strstr(svg.data, "<g id=\"after\"");
    char colour[4][8] = {"", "", "", ""};
    for (const char *s = strstr(last, "<path fill=\""); s; s = strstr(s + 1, "<path fill=\"")) {
      memmove(colour[0], colour[1], sizeof colour[0] * 3);
      memcpy(colour[3], s + 12, 7);
    }
    /* the eye stands at negative y: the last faces are those of the bar at y = -3, bead 2's red
     * among them unless it is behind */
    int red = 0;
    for (int i = 0; i < 4; i++) {
      unsigned r, g, b;
      ck_assert_int_eq(sscanf(colour[i], "#%2x%2x%2x", &r, &g, &b), 3);
      red += r > 2 * b + 40 && g < r / 2 + 10;
    }
    ck_assert_int_eq(red > 0, !swapped);
    thr_text_destroy(&svg);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* Three panels, two in a row, stay within their paper, and the sheets go on below them. */
START_TEST(panels_stay_on_their_paper)
{
  thr_frame f = path_make(4);
  double pose[4][7], bottom = 0, low = HUGE_VAL, high = 0;
  rest_poses(&f, pose);
  thr_still_panel panel[3];
  for (int i = 0; i < 3; i++)
    panel[i] = (thr_still_panel){"panel", "two words", (const double(*)[7])pose};
  const thr_still still = {.width = 0.3, .n_panels = 3, .panel = panel, .first_bead = -1};
  thr_text svg = {0};
  thr_err err = {0};
  assert_ok(thr_still_panels(&f, &still, (thr_box){10, 20, 200, 120}, &bottom, &svg, &err), &err);
  const char *at = svg.data;
  int n = 0;
  for (; (at = strstr(at, "translate(")); at++, n++) {
    double x, y;
    ck_assert_int_eq(sscanf(at, "translate(%lf %lf)", &x, &y), 2);
    ck_assert(x >= 10 && x < 200 && y >= 20);
    low = fmin(low, y);
    high = fmax(high, y);
  }
  ck_assert_int_eq(n, 3);
  ck_assert(high > low && bottom > high && bottom <= 121);
  thr_text_destroy(&svg);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(still_refuses_nonsense)
{
  thr_frame f = path_make(3);
  double pose[3][7];
  rest_poses(&f, pose);
  const thr_still_panel panel[] = {{"before", "Before", (const double(*)[7])pose},
                                   {"after", "After", (const double(*)[7])pose}};
  thr_still s = {.width = 0.3, .n_panels = 2, .panel = panel, .first_bead = -1};
  thr_text svg = {0};
  for (int i = 0; i < 4; i++) {
    thr_still bad = s;
    thr_err err = {0};
    if (i == 0) bad.width = 0;
    if (i == 1) bad.width = NAN;
    if (i == 2) bad.first_bead = 3;
    if (i == 3) pose[1][4] = INFINITY;
    double bottom;
    assert_status(thr_still_panels(&f, &bad, (thr_box){0, 0, 268, 139}, &bottom, &svg, &err),
                  THR_EINPUT, &err, i < 2 ? "wide" : "bead");
  }
  ck_assert_int_eq((int)svg.length, 0);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(allocations_may_fail)
{
  thr_plan p = path_plan(5, 9);
  double pose[6][7];
  rest_poses(&p.frame, pose);
  const thr_still_panel panel[] = {{"before", "Before", (const double(*)[7])pose},
                                   {"after", "After", (const double(*)[7])pose}};
  const thr_still still = {.width = 0.3, .n_panels = 2, .panel = panel, .first_bead = 1};
  thr_tension_options o = thr_tension_options_default();
  for (int c = 0; c < 9; c++)
    fill(&p, c, 2 + c);
  for (int picture = 0; picture < 2; picture++) {
    thr_status st = THR_ENOMEM;
    long k = 0;
    while (st) {
      thr_text svg = {0};
      thr_err err = {0};
      thr_alloc_fail_at(++k);
      double bottom;
      st = picture
               ? thr_still_panels(&p.frame, &still, (thr_box){12, 20, 198, 80}, &bottom, &svg, &err)
               : thr_tension_svg(&p, &o, &svg, &err);
      thr_alloc_fail_at(0);
      if (st) {
        assert_status(st, THR_ENOMEM, &err, "memory");
      }
      thr_text_destroy(&svg);
    }
    ck_assert_int_gt(k, 4);
  }
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("pictures");
  ADD_TEST(s, 10, steps_are_as_high_as_the_logarithm);
  ADD_TEST(s, 10, small_ratios_are_drawn_from_zero);
  ADD_TEST(s, 20, many_cords);
  ADD_TEST(s, 10, the_fan_and_the_limits_are_to_scale);
  ADD_TEST(s, 10, extreme_tensions);
  ADD_TEST(s, 10, turns_by_closed_form_are_said);
  ADD_TEST(s, 10, without_a_usable_evaluation);
  ADD_TEST(s, 10, overview_shows_tension);
  ADD_TEST(s, 10, turns_have_even_colours);
  ADD_TEST(s, 10, pale_colours_stand_between_cords_and_beads);
  ADD_TEST(s, 10, overview_shows_turning);
  ADD_LOOP(s, 10, closing_turns, 0, 4);
  ADD_TEST(s, 10, turning_of_several_cords);
  ADD_TEST(s, 10, only_faces_that_can_be_seen);
  ADD_TEST(s, 10, poses_turn_beads);
  ADD_TEST(s, 10, the_nearer_is_painted_last);
  ADD_TEST(s, 10, panels_stay_on_their_paper);
  ADD_TEST(s, 10, still_refuses_nonsense);
  ADD_TEST(s, 20, allocations_may_fail);
  return run_suite(s);
}
