/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses colours of cords and of turns.
 *
 * Cords: Okabe & Ito 2008 without yellow (too pale on paper) and black (text), told apart by
 * colour-blind readers (least CIEDE2000 difference 22, without one kind of cone 10.9), but not in
 * grey print; a dash pattern for every further six cords. Copies of a cord have its hue, paler than
 * any strong colour and darker than a bead, so that lightness alone tells them apart.
 *
 * Turns: a ramp in the Oklab space whose lightness alone tells the order. */
#include "diagram/scene/scene.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

thr_colour thr_palette(int i)
{
  /* Neighbours in this order differ most: vermillion and orange are kept apart. */
  static const thr_colour colour[THR_COLOURS] = {
      {"#0072B2", "#9ECDF5", "blue"},     {"#D55E00", "#F1B99E", "vermillion"},
      {"#009E73", "#99D7BC", "green"},    {"#CC79A7", "#ECB4D1", "pink"},
      {"#56B4E9", "#A5DDFF", "sky blue"}, {"#E69F00", "#F1CE9D", "orange"}};
  return colour[i % THR_COLOURS];
}

const double *thr_palette_dash(int i)
{
  /* Lengths in cord widths: on, off, .., 0. */
  static const double dash[THR_DASHES - 1][5] = {{3, 1, 0}, {1, 1, 0}, {4, 1, 1, 1, 0}};
  i %= THR_DASHES;
  return i ? dash[i - 1] : NULL;
}

/* Returns the sRGB value, 0 .. 255, of linear light, 0 .. 1 (IEC 61966-2-1). */
static unsigned from_light(double light)
{
  double value = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
  return (unsigned)nearbyint(255 * fmin(fmax(value, 0), 1));
}

/* Returns the linear light, 0 .. 1, of an sRGB value (IEC 61966-2-1). */
static double to_light(unsigned value)
{
  double signal = value / 255.0;
  return signal <= 0.04045 ? signal / 12.92 : pow((signal + 0.055) / 1.055, 2.4);
}

bool thr_palette_rim(const char *hex, char rim[8])
{
  /* WCAG 2.1: contrast with white is 1.05 / (luminance + 0.05). */
  static const double part[3] = {0.2126, 0.7152, 0.0722}, most = 1.05 / 3 - 0.05,
                      wanted = 1.05 / 4.5 - 0.05; /* luminance */

  unsigned value[3] = {0, 0, 0};
  double light[3], sum = 0;

  if (sscanf(hex, "#%2x%2x%2x", &value[0], &value[1], &value[2]) != 3) return false;

  /* Relative luminance of the colour. */
  for (int k = 0; k < 3; k++) {
    light[k] = to_light(value[k]);
    sum += part[k] * light[k];
  }

  /* Pale enough to need a rim: scale its light down to the rim's luminance. */
  if (sum <= most) return false;
  double shade = wanted / sum;
  snprintf(rim, 8, "#%02x%02x%02x", from_light(shade * light[0]), from_light(shade * light[1]),
           from_light(shade * light[2]));
  return true;
}

void thr_turning_colour(double angle, char hex[8])
{
  /* Two colours in Oklab, and a part of the way between them. */
  static const double pale[3] = {0.94, 0.0100, -0.0173},
                      dark[3] = {0.27, 0.0700, -0.1212}; /* lightness, a, b */
  double part = fmin(fmax(angle / THR_PI, 0), 1), at[3], cone[3];

  thr_mix(pale, dark, part, at);

  /* From Oklab to the responses of the three kinds of cones, and on to linear sRGB. */
  cone[0] = pow(at[0] + 0.3963377774 * at[1] + 0.2158037573 * at[2], 3);
  cone[1] = pow(at[0] - 0.1055613458 * at[1] - 0.0638541728 * at[2], 3);
  cone[2] = pow(at[0] - 0.0894841775 * at[1] - 1.2914855480 * at[2], 3);

  snprintf(hex, 8, "#%02x%02x%02x",
           from_light(4.0767416621 * cone[0] - 3.3077115913 * cone[1] + 0.2309699292 * cone[2]),
           from_light(-1.2684380046 * cone[0] + 2.6097574011 * cone[1] - 0.3413193965 * cone[2]),
           from_light(-0.0041960863 * cone[0] - 0.7034186147 * cone[1] + 1.7076147010 * cone[2]));
}
