/* Colours of cords: Okabe & Ito 2008 without yellow (too pale on paper) and black (text), told apart by colour-blind
 * readers; a dash pattern for every further six cords. */
#ifndef THR_PALETTE_H
#define THR_PALETTE_H

enum { THR_COLOURS = 6, THR_DASHES = 4 };

typedef struct {
  const char *hex;  /* "#0072B2" */
  const char *name; /* "blue" */
} thr_colour;

/* i >= 0; repeats every THR_COLOURS. */
thr_colour thr_palette(int i);

/* Dash pattern number i: on, off lengths in cord widths, 0-terminated; NULL for 0, the full line. Repeats. */
const double *thr_palette_dash(int i);

#endif
