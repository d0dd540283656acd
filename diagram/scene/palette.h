/* Colours of cords: Okabe & Ito 2008 without yellow (too pale on paper) and black (text), told apart by colour-blind
 * readers (least CIEDE2000 difference 22, without one kind of cone 10.9), but not in grey print; a dash pattern for every further
 * six cords. Copies of a cord have its hue, paler than any strong colour and darker than a bead, so that lightness alone tells
 * them apart. Colours of turns: a ramp whose lightness alone tells the order. */
#ifndef THR_PALETTE_H
#define THR_PALETTE_H

#include <stdbool.h>

enum { THR_COLOURS = 6, THR_DASHES = 4 };

typedef struct {
  const char *hex;  /* "#0072B2" */
  const char *pale; /* the same hue for copies: "#9ECDF5" */
  const char *name; /* "blue" */
} thr_colour;

/* i >= 0; repeats every THR_COLOURS. */
thr_colour thr_palette(int i);

/* A dark shade of a colour that is too pale on white (contrast below 3, WCAG 2.1) to line it with: contrast 4.5. false: it needs
 * none. */
bool thr_palette_rim(const char *hex, char rim[8]);

/* Dash pattern number i: on, off lengths in cord widths, 0-terminated; NULL for 0, the full line. Repeats. */
const double *thr_palette_dash(int i);

/* Colour of a turn by angle rad as "#rrggbb": equal steps in the Oklab space (B. Ottosson, 2020) from pale lilac for straight on
 * to dark violet, a hue that no cord has, for pi. */
void thr_turning_colour(double angle, char hex[8]);

#endif
