/* TrueType fonts (ISO/IEC 14496-22, "OpenType"): which glyph a letter has, how wide it is, and a font of some glyphs alone for a
 * PDF. Bytes are read within the file's bounds whatever it holds. Private to diagram/. */
#ifndef THR_FONT_H
#define THR_FONT_H

#include "graph/status.h"
#include "graph/text.h"

#include <stdint.h>

enum { THR_FONT_LETTERS = 65536 }; /* the letters of Unicode's basic plane */

typedef struct {
  char name[64]; /* PostScript name, letters, digits and hyphens: DejaVuSans-Bold */
  thr_text file;
  size_t start;            /* of the font in the file, which may be a collection */
  int n_glyphs, n_metrics; /* n_metrics: glyphs with an advance of their own */
  int units;               /* per em */
  int ascent, descent;     /* units, from the base line upwards */
  int box[4];              /* of all glyphs: least x, least y, greatest x, greatest y; units */
  uint16_t *glyph;         /* [THR_FONT_LETTERS] of each letter; 0 = the box of a letter that it lacks */
} thr_font;

/* Reads font `index` of a file; its glyphs are TrueType outlines. THR_EIO, THR_ESOLVER if it is no such font, THR_ENOMEM. Release
 * with thr_font_destroy, after a failure too. O(bytes). */
thr_status thr_font_read(thr_font *font, const char *path, int index, const char *name, thr_err *err) THR_MUST_CHECK;
void thr_font_destroy(thr_font *font);

/* The next letter of UTF-8 text, which *words is moved beyond; what is beyond the basic plane, or no UTF-8, is U+FFFD. */
unsigned thr_font_letter(const char **words);

/* Advance of a glyph, in em. */
double thr_font_advance(const thr_font *font, int glyph);

/* Appends a font file with the same numbers of glyphs, of which only those with used[glyph], and those that they are composed of,
 * have an outline. used: [n_glyphs], extended by these. O(bytes). */
thr_status thr_font_subset(const thr_font *font, unsigned char *used, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* Appends the outline of a glyph to an SVG path: closed curves, quadratic ones, with numbers of three decimals. A point x, y of
 * it, in units, goes to place[0] x + place[2] y + place[4], place[1] x + place[3] y + place[5]. Nothing for a blank. O(points).
 */
void thr_font_outline(const thr_font *font, int glyph, const double place[6], thr_text *path);

/* The faces that pages are set in, found by fontconfig: DejaVu Sans or what it puts in its place. In a child process, as
 * fontconfig ends the program, or never ends, when memory runs out. */
enum { THR_FACE_BOLD = 1, THR_FACE_MONO = 2, THR_FACES = 4 }; /* a face is a sum of these */

/* Releases nothing on failure: thr_font_destroy for each of font[THR_FACES] (zeroed before). */
thr_status thr_fonts_find(thr_font *font, thr_err *err) THR_MUST_CHECK;

#endif
