/* Words as closed outlines, for programs that know no fonts: to cut, to engrave, to raise on a printed piece. Private to
 * diagram/. */
#ifndef THR_LETTERS_H
#define THR_LETTERS_H

#include "graph/status.h"
#include "graph/text.h"

typedef struct thr_letters_set thr_letters_set;

/* The bold face of pages. THR_ESOLVER where there are no fonts: in a browser. Release with thr_letters_close (NULL ok). */
thr_status thr_letters_open(thr_letters_set **set, thr_err *err) THR_MUST_CHECK;
void thr_letters_close(thr_letters_set *set);

/* Width of words whose capitals are 1 high. */
double thr_letters_width(const thr_letters_set *set, const char *words);

/* Appends words as data of an SVG path: from at, the left end of the base line, with capitals so high. */
void thr_letters_put(const thr_letters_set *set, const char *words, const double at[2], double height, thr_text *path);

#endif
