/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses the colours of films and writes words into their pictures.
 *
 * All pictures of a film share one palette, so that equal pixels are equal numbers from picture to
 * picture: shades of the pieces' clay, and of each colour of tension shades towards the dark and
 * tints towards white, as they come about at the rims of cords.
 * Words are of the strokes that name the pieces of a kit, so that they need no font and are the
 * same everywhere.
 *
 * Example: "1.25 SEC  PULL 40 N  CLOSED 12/84", and a bar from 0 to 50 N. */
#include "kit/film.h"

#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CLAYS = 36, TONES = 6, MARKS = 15, STROKES = 1024, WORDS = 128 };

static const double DARK[3] = {0.40, 0.44, 0.52}, WHITE[3] = {1, 1, 1}; /* of clay */
static const double INK[3] = {0.15, 0.17, 0.2};

/* ---- colours ---- */

void thr_film_tensions(double colour[THR_FILM_TENSIONS][3])
{
  enum { STOPS = 5, KNOWN = THR_FILM_TENSIONS - 1 };
  static const double stop[STOPS][3] = {{0.11, 0.15, 0.52},
                                        {0.50, 0.10, 0.60},
                                        {0.84, 0.24, 0.38},
                                        {0.96, 0.54, 0.16},
                                        {0.99, 0.85, 0.20}};
  static const double unknown[3] = {0.55, 0.57, 0.60};
  for (int i = 0; i < KNOWN; i++) {
    double at = (double)i * (STOPS - 1) / (KNOWN - 1);
    int from = at < STOPS - 2 ? (int)at : STOPS - 2;
    thr_mix(stop[from], stop[from + 1], at - from, colour[i]);
  }
  memcpy(colour[KNOWN], unknown, sizeof unknown);
}

int thr_film_tension(double tension, double most)
{
  enum { KNOWN = THR_FILM_TENSIONS - 1 };
  if (!isfinite(tension) || most <= 0) return KNOWN;
  return (int)fmin(fmax(KNOWN * tension / most, 0), KNOWN - 1);
}

double thr_film_most(const thr_movement *movement)
{
  const size_t n_points = (size_t)movement->first[movement->n_cords];
  double most = 0;
  for (int c = 0; c < movement->n_cords; c++)
    for (int frame = 0; frame < movement->n_frames; frame++)
      for (int i = movement->first[c]; i + 1 < movement->first[c + 1]; i++) {
        double tension = movement->tension[(size_t)frame * n_points + (size_t)i];
        if (isfinite(tension)) most = fmax(most, tension);
      }
  if (most <= 0) return 0;
  double unit = pow(10, floor(log10(most)) - 1);
  return unit * ceil(most / unit - 1e-9);
}

/* Writes a colour, 0 to 1, as bytes. */
static void put_colour(const double colour[3], unsigned char *to)
{
  for (int k = 0; k < 3; k++)
    to[k] = (unsigned char)(255 * fmin(fmax(colour[k], 0), 1) + 0.5);
}

/* Mixes two colours: part of the second one. */
static void mix(const double a[3], const double b[3], double part, double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = (1 - part) * a[k] + part * b[k];
}

void thr_film_colours(thr_png_palette *palette)
{
  /* Light that is left at each tone of a colour, then the part of white in it. */
  static const double tone[TONES][2] = {{0.5, 0},  {0.75, 0}, {1, 0},
                                        {1, 0.25}, {1, 0.5},  {1, 0.75}};
  static const double black[3] = {0};
  double colour[3], tension[THR_FILM_TENSIONS][3];
  int n = 1;

  /* Clay, of which shadows and words are seen, too: with greys beside it of the same lightness
   * neighbours would be now of the one and now of the other, and files a tenth larger. */
  *palette = (thr_png_palette){0};
  for (int i = 0; i < CLAYS; i++, n++) {
    double part = (double)i / (CLAYS - 1);
    if (part < 0.4)
      mix(black, DARK, 0.25 + 0.75 * part / 0.4, colour);
    else
      mix(DARK, WHITE, (part - 0.4) / 0.6, colour);
    put_colour(colour, palette->colour[n]);
  }

  thr_film_tensions(tension);
  for (int i = 0; i < THR_FILM_TENSIONS - 1; i++)
    for (int j = 0; j < TONES; j++, n++) {
      mix(tension[i], WHITE, tone[j][1], colour);
      mix(black, colour, tone[j][0], colour);
      put_colour(colour, palette->colour[n]);
    }
  for (int i = 0; i < MARKS; i++, n++) {
    for (int k = 0; k < 3; k++)
      colour[k] = THR_MARKED[k] * (0.25 + 0.85 * i / (MARKS - 1));
    put_colour(colour, palette->colour[n]);
  }
}

/* ---- words ---- */

/* Returns the height of capitals, px. */
static double letter_height(const int size[2])
{
  return fmax(0.0145 * fmin(size[0], 4.0 / 3 * size[1]), 5);
}

int thr_film_strip(const int size[2])
{
  return (int)ceil(2.8 * letter_height(size));
}

/* Darkens the pixels near a line between two points, px, as far as it covers them. */
static void draw_line(thr_film_canvas *canvas, const double from[2], const double to[2],
                      double radius)
{
  int low[2], high[2];
  for (int k = 0; k < 2; k++) {
    low[k] = (int)fmax(floor(fmin(from[k], to[k]) - radius - 1), 0);
    high[k] = (int)fmin(ceil(fmax(from[k], to[k]) + radius + 1), canvas->size[k] - 1);
  }
  double along[2] = {to[0] - from[0], to[1] - from[1]};
  double square = along[0] * along[0] + along[1] * along[1];
  for (int y = low[1]; y <= high[1]; y++)
    for (int x = low[0]; x <= high[0]; x++) {
      double off[2] = {x + 0.5 - from[0], y + 0.5 - from[1]};
      double part = square > 0 ? (off[0] * along[0] + off[1] * along[1]) / square : 0;
      part = fmin(fmax(part, 0), 1);
      double far = hypot(off[0] - part * along[0], off[1] - part * along[1]);
      double cover = fmin(fmax(radius + 0.5 - far, 0), 1);
      unsigned char *pixel = canvas->pixel + 3 * ((size_t)y * (size_t)canvas->size[0] + (size_t)x);
      for (int k = 0; k < 3; k++) {
        double ink = 255 * ((1 - cover) + cover * INK[k]);
        if (ink < pixel[k]) pixel[k] = (unsigned char)(ink + 0.5);
      }
    }
}

/* Returns the width of words, px. */
static double measure(const char *words, double height)
{
  double room;
  (void)thr_kit_strokes(words, height, NULL, 0, &room);
  return room;
}

/* Writes words from x on, their middle at height y. */
static void write_words(thr_film_canvas *canvas, const char *words, double x, double y,
                        double height)
{
  thr_kit_stroke stroke[STROKES];
  double room;
  int n = thr_kit_strokes(words, height, stroke, STROKES, &room);
  for (int i = 0; i < n && i < STROKES; i++)
    draw_line(canvas, (const double[]){x + stroke[i].from[0], y - stroke[i].from[1]},
              (const double[]){x + stroke[i].to[0], y - stroke[i].to[1]}, 0.07 * height);
}

/* Writes what a frame says. */
static void print_state(const thr_movement *movement, int frame, char words[WORDS])
{
  const thr_movement_state *state = &movement->state[frame];
  int n = snprintf(words, WORDS, "%.2f sec", state->time);
  if (isfinite(state->pull))
    n += snprintf(words + n, (size_t)(WORDS - n), "  pull %.3g N", state->pull);
  if (isfinite(state->drawn) && n < WORDS)
    n += snprintf(words + n, (size_t)(WORDS - n), "  %s %.0f mm",
                  state->drawn < 0 ? "given out" : "drawn", fabs(state->drawn));
  if (movement->n_faces && n < WORDS)
    snprintf(words + n, (size_t)(WORDS - n), "  closed %d/%d", state->closed, movement->n_faces);
}

void thr_film_caption(thr_film_canvas *canvas, const thr_movement *movement, int frame, double most)
{
  double height = letter_height(canvas->size), margin = 1.2 * height;
  double middle = canvas->size[1] - 0.5 * thr_film_strip(canvas->size);
  char words[WORDS];
  print_state(movement, frame, words);
  write_words(canvas, words, margin, middle, height);
  if (most <= 0) return;

  /* From the right: the largest tension, the bar of colours, 0. */
  char number[WORDS];
  double colour[THR_FILM_TENSIONS][3], gap = 0.7 * height;
  int cell = (int)ceil(0.6 * height);
  snprintf(number, sizeof number, "%.3g N", most);
  double right = canvas->size[0] - margin - measure(number, height);
  write_words(canvas, number, right, middle, height);
  int left = (int)(right - gap) - cell * (THR_FILM_TENSIONS - 1);
  write_words(canvas, "0", left - gap - measure("0", height), middle, height);
  thr_film_tensions(colour);
  for (int i = 0; i < cell * (THR_FILM_TENSIONS - 1); i++)
    for (int y = (int)(middle - 0.5 * height); y < middle + 0.5 * height; y++) {
      int x = left + i;
      if (x < 0) continue;
      put_colour(colour[i / cell],
                 canvas->pixel + 3 * ((size_t)y * (size_t)canvas->size[0] + (size_t)x));
    }
}
