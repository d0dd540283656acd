/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The palette in numbers, for eyes of every kind and for grey print. */
#include "diagram/scene/scene.h"
#include "graph/number.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- colour ---- */

typedef enum { NORMAL, PROTANOPIA, DEUTERANOPIA, TRITANOPIA, GREY, N_EYES } eyes;

/* What people without one kind of cone see, in linear light: G. M. Machado, M. M. Oliveira, L. A.
 * F. Fernandes, "A physiologically-based model for simulation of color vision deficiency", IEEE
 * Trans. Vis. Comput. Graph. 15(6), 2009, severity
 * 1. Grey: the luminance of sRGB. */
static const double SEEN[N_EYES][3][3] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0.152286, 1.052583, -0.204868},
     {0.114503, 0.786281, 0.099216},
     {-0.003882, -0.048116, 1.051998}},
    {{0.367322, 0.860646, -0.227968},
     {0.280085, 0.672501, 0.047413},
     {-0.011820, 0.042940, 0.968881}},
    {{1.255528, -0.076749, -0.178779},
     {-0.078411, 0.930809, 0.147602},
     {0.004733, 0.691367, 0.303900}},
    {{0.2126, 0.7152, 0.0722}, {0.2126, 0.7152, 0.0722}, {0.2126, 0.7152, 0.0722}}};

static void linear_of(const char *hex, double rgb[3])
{
  unsigned c[3];
  ck_assert_int_eq(sscanf(hex, "#%2x%2x%2x", &c[0], &c[1], &c[2]), 3);
  for (int k = 0; k < 3; k++) {
    double v = c[k] / 255.0;
    rgb[k] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
  }
}

static double luminance(const char *hex)
{
  double rgb[3];
  linear_of(hex, rgb);
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* CIE L*a*b* (D65) of a colour as some eyes see it. */
static void lab_of(const char *hex, eyes who, double lab[3])
{
  static const double xyz[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                   {0.2126729, 0.7151522, 0.0721750},
                                   {0.0193339, 0.1191920, 0.9503041}},
                      white[3] = {0.95047, 1, 1.08883};
  double rgb[3], seen[3] = {0, 0, 0}, f[3];
  linear_of(hex, rgb);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      seen[i] += SEEN[who][i][j] * rgb[j];
    seen[i] = fmax(0, fmin(1, seen[i]));
  }
  for (int i = 0; i < 3; i++) {
    double t = (xyz[i][0] * seen[0] + xyz[i][1] * seen[1] + xyz[i][2] * seen[2]) / white[i];
    f[i] = t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  }
  lab[0] = 116 * f[1] - 16;
  lab[1] = 500 * (f[0] - f[1]);
  lab[2] = 200 * (f[1] - f[2]);
}

static double hue(double a, double b)
{
  double h = a == 0 && b == 0 ? 0 : atan2(b, a);
  return h < 0 ? h + 2 * THR_PI : h;
}

static double deg(double x)
{
  return x * THR_PI / 180;
}

/* CIEDE2000 (CIE 142-2001), in the notation of G. Sharma, W. Wu, E. N. Dalal, Color Res. Appl.
 * 30(1), 2005. */
static double delta_e(const double p[3], const double q[3])
{
  double mean = 0.5 * (hypot(p[1], p[2]) + hypot(q[1], q[2])),
         g = 0.5 * (1 - sqrt(pow(mean, 7) / (pow(mean, 7) + pow(25, 7))));
  double a1 = (1 + g) * p[1], a2 = (1 + g) * q[1], c1 = hypot(a1, p[2]), c2 = hypot(a2, q[2]);
  double h1 = hue(a1, p[2]), h2 = hue(a2, q[2]), dh = h2 - h1, hm = h1 + h2;
  if (c1 * c2 == 0) {
    dh = 0;
  } else if (fabs(h2 - h1) > THR_PI) {
    dh += dh > 0 ? -2 * THR_PI : 2 * THR_PI;
    hm += hm < 2 * THR_PI ? 2 * THR_PI : -2 * THR_PI;
  }
  if (c1 * c2 != 0) hm *= 0.5;
  double big_h = 2 * sqrt(c1 * c2) * sin(0.5 * dh), lm = 0.5 * (p[0] + q[0]), cm = 0.5 * (c1 + c2);
  double t = 1 - 0.17 * cos(hm - deg(30)) + 0.24 * cos(2 * hm) + 0.32 * cos(3 * hm + deg(6)) -
             0.20 * cos(4 * hm - deg(63));
  double sl = 1 + 0.015 * pow(lm - 50, 2) / sqrt(20 + pow(lm - 50, 2)), sc = 1 + 0.045 * cm,
         sh = 1 + 0.015 * cm * t;
  double x = (hm * 180 / THR_PI - 275) / 25,
         rt = -sin(deg(60) * exp(-x * x)) * 2 * sqrt(pow(cm, 7) / (pow(cm, 7) + pow(25, 7)));
  double l = (q[0] - p[0]) / sl, c = (c2 - c1) / sc, h = big_h / sh;
  return sqrt(l * l + c * c + h * h + rt * c * h);
}

/* Values of table 1 of that paper. */
START_TEST(differences_are_those_published)
{
  static const struct {
    double p[3], q[3], difference;
  } table[] = {{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
               {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
               {{50, 0, 0}, {50, -1, 2}, 2.3669},
               {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
               {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
               {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
               {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
               {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};
  for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
    ck_assert_double_eq_tol(delta_e(table[i].p, table[i].q), table[i].difference, 5e-5);
}
END_TEST

/* ---- the palette ---- */

static double difference(const char *a, const char *b, eyes who)
{
  double p[3], q[3];
  lab_of(a, who, p);
  lab_of(b, who, q);
  return delta_e(p, q);
}

/* Whatever the eyes, any two cords' colours differ by many times what is just seen (about 1). In
 * grey they do not (sky blue and orange: 0.6), so the overview has letters (see test_overview.c).
 */
START_TEST(colours_differ_to_all_eyes)
{
  static const double least[GREY] = {22, 12, 12, 10.5};
  for (int i = 0; i < THR_COLOURS; i++)
    for (int j = 0; j < i; j++) {
      double d = difference(thr_palette(i).hex, thr_palette(j).hex, (eyes)_i);
      ck_assert_msg(d >= least[_i], "%s and %s: %.1f", thr_palette(i).name, thr_palette(j).name, d);
    }
}
END_TEST

/* WCAG 2.1 contrast. */
static double contrast(const char *a, const char *b)
{
  double x = luminance(a) + 0.05, y = luminance(b) + 0.05;
  return fmax(x, y) / fmin(x, y);
}

/* Cords stand out from white paper and from the beads; copies less, but they do. */
START_TEST(colours_stand_out_from_paper)
{
  for (int i = 0; i < THR_COLOURS; i++) {
    ck_assert_double_ge(contrast(thr_palette(i).hex, "#ffffff"), 2.2);
    ck_assert_double_ge(contrast(thr_palette(i).hex, "#f3f1ea"), 1.9);
    ck_assert_double_ge(contrast(thr_palette(i).pale, "#ffffff"), 1.4);
    ck_assert_double_ge(difference(thr_palette(i).pale, "#f3f1ea", GREY), 5);
  }
}
END_TEST

/* A cord that is too pale on white has a rim that is not; like its hue, only darker. */
START_TEST(pale_cords_have_a_dark_rim)
{
  int pale = 0;
  for (int i = 0; i < THR_COLOURS; i++) {
    const char *hex = thr_palette(i).hex;
    double cord[3], line[3], less = contrast(hex, "#ffffff");
    char rim[8];
    ck_assert_int_eq(thr_palette_rim(hex, rim), less < 3);
    if (less >= 3) continue;
    pale++;
    ck_assert_double_eq_tol(contrast(rim, "#ffffff"), 4.5, 0.1);
    ck_assert_double_ge(contrast(rim, "#f3f1ea"), 3);
    linear_of(hex, cord);
    linear_of(rim, line);
    for (int k = 0; k < 3; k++)
      ck_assert_double_eq_tol(line[k] * luminance(hex), cord[k] * luminance(rim), 0.005);
  }
  ck_assert_int_eq(pale, 2); /* sky blue and orange */
}
END_TEST

/* A copy is paler than every cord, also in grey. */
START_TEST(copies_are_paler_in_grey)
{
  for (int i = 0; i < THR_COLOURS; i++)
    for (int j = 0; j < THR_COLOURS; j++) {
      double strong[3], pale[3];
      lab_of(thr_palette(i).hex, GREY, strong);
      lab_of(thr_palette(j).pale, GREY, pale);
      ck_assert_double_gt(pale[0], strong[0] + 4);
    }
}
END_TEST

/* No two of the first cords have colour and dash alike. */
START_TEST(dashes_tell_equal_colours_apart)
{
  for (int i = 0; i < THR_COLOURS * THR_DASHES; i++)
    for (int j = 0; j < i; j++) {
      const double *a = thr_palette_dash(i / THR_COLOURS), *b = thr_palette_dash(j / THR_COLOURS);
      bool dashed_alike = a == b;
      for (int k = 0; a && b && !dashed_alike; k++) {
        if (a[k] != b[k]) break;
        dashed_alike = a[k] == 0;
      }
      ck_assert(!dashed_alike || strcmp(thr_palette(i).hex, thr_palette(j).hex) != 0);
    }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("palette");
  ADD_TEST(s, 10, differences_are_those_published);
  ADD_LOOP(s, 10, colours_differ_to_all_eyes, 0, GREY);
  ADD_TEST(s, 10, colours_stand_out_from_paper);
  ADD_TEST(s, 10, pale_cords_have_a_dark_rim);
  ADD_TEST(s, 10, copies_are_paler_in_grey);
  ADD_TEST(s, 10, dashes_tell_equal_colours_apart);
  return run_suite(s);
}
