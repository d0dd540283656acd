/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes words as closed outlines, for programs that know no fonts: to cut, to engrave, to raise on
 * a printed piece.
 *
 * Sizes are heights of capitals, as a maker measures them, not font sizes: DejaVu Sans has capitals
 * of 0.73 em, so that a height of 4 mm is a font size of 5.5 mm. */

#include "diagram/export/export_parts.h"

#include <stdlib.h>

/* The fonts that words are set in. */
struct thr_letters_set {
  thr_font font[THR_FACES];
  double em; /* of a line whose capitals are 1 high */
};

/* Returns the face that words are set in. */
static const thr_font *face(const thr_letters_set *set)
{
  return &set->font[THR_FACE_BOLD];
}

/* Returns the height of the letter H in em, from its outline; 0.7 for a font that has none. */
static double capitals(const thr_font *font)
{
  enum { TOP = 8 }; /* byte of an outline at which its greatest y stands */

  /* The outline's head holds its least and greatest coordinates. */
  const thr_font_part outline = thr_font_place(font, font->glyph['H']);
  const int top = font->glyph['H'] && outline.n ? thr_font_signed(font, outline.at + TOP) : 0;
  return top > 0 ? (double)top / font->units : 0.7;
}

thr_status thr_letters_open(thr_letters_set **out, thr_err *err)
{
  thr_letters_set *set = *out = thr_calloc(1, sizeof *set);
  if (!set) return thr_nomem(err);

  thr_status st = thr_fonts_find(set->font, err);

  /* A font size of em makes capitals 1 high. */
  if (!st) {
    set->em = 1 / capitals(face(set));
    return THR_OK;
  }

  /* Half a set is of no use. */
  thr_letters_close(set);
  *out = NULL;
  return st;
}

void thr_letters_close(thr_letters_set *set)
{
  for (int i = 0; set && i < THR_FACES; i++)
    thr_font_destroy(&set->font[i]);
  free(set);
}

double thr_letters_width(const thr_letters_set *set, const char *words)
{
  double width = 0;
  while (*words)
    width += set->em * thr_font_advance(face(set), face(set)->glyph[thr_font_letter(&words)]);
  return width;
}

void thr_letters_put(const thr_letters_set *set, const char *words, const double at[2],
                     double height, thr_text *path)
{
  const double size = height * set->em, unit = size / face(set)->units;

  /* From units of the font, y upwards, to the drawing's, y downwards. */
  double place[6] = {unit, 0, 0, -unit, at[0], at[1]};
  while (*words) {
    const int glyph = face(set)->glyph[thr_font_letter(&words)];
    thr_font_outline(face(set), glyph, place, path);

    /* The next letter begins an advance further right. */
    place[4] += size * thr_font_advance(face(set), glyph);
  }
}
