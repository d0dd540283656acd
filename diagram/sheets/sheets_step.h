/* A step of the booklet: visits of the needle that have a picture and rows together. Private to diagram/sheets/. */
#ifndef THR_SHEETS_STEP_H
#define THR_SHEETS_STEP_H

#include "diagram/scene/arms.h"
#include "diagram/sheets/sheets_parts.h"
#include "diagram/space/camera.h"

enum { THR_STEP_VISITS = 24 };

/* mm: the heading with the small picture in its corner; the legend below the picture; the least picture. */
static const double THR_STEP_HEAD = 25, THR_STEP_LEGEND = 6, THR_STEP_PICTURE[2] = {90, 60};

/* Visits first .. end - 1. */
struct thr_step {
  int number, first, end;
  thr_crop_view view;            /* of a flat picture */
  double height;                 /* of its picture at least, mm */
  thr_text row[THR_STEP_VISITS]; /* words of the rows */
  int lines[THR_STEP_VISITS];    /* of them */
  int n_rows, left;              /* rows; those in the left column */
  double rows_height;            /* mm */
  thr_text before, after;
  int lines_before, lines_after;
};

/* ---- how a path is divided (sheets_divide.c) ---- */

/* Ends of the steps of path c, in visits: end[*n_steps], freed by the caller. As few steps as pictures allow in which every pass
 * is legible, that end where the cord turns rather than within a straight run, by dynamic programming. */
thr_status thr_step_divide(thr_sheets *sheets, int c, int **end, int *n_steps, thr_err *err) THR_MUST_CHECK;

/* Passes of the scene that visits come by, in their order; returns how many. */
int thr_step_now(const thr_sheets *sheets, int first, int end, int *now);

/* Is the visit the first, or the last, of its needle? */
bool thr_step_begins(const thr_sheets *sheets, int visit);
bool thr_step_ends(const thr_sheets *sheets, int visit);

/* ---- what is written (sheets_rows.c) ---- */

/* Of the passes drawn now: with one cord always the same, with several the cord's. */
const char *thr_step_colour(const thr_sheets *sheets, const thr_step *step);

/* Fills texts and lines; the steps of the visits up to its end are known. */
void thr_step_find_text(thr_sheets *sheets, thr_step *step);
void thr_step_destroy_text(thr_step *step);
void thr_step_put_heading(thr_sheets *sheets, const thr_step *step, double top);
void thr_step_put_legend(thr_sheets *sheets, double y, const char *what); /* what: "step", "section" */
void thr_step_put_rows(thr_sheets *sheets, const thr_step *step);

/* Lines that the row of a visit takes, more or less: what it says of other steps is not known yet. */
int thr_step_row_lines(thr_sheets *sheets, int visit);

/* Height of so many lines of rows in two columns and of what stands before and after them, mm. */
double thr_step_words_height(double rows_height, int lines_before, int lines_after);
double thr_step_rows_height(int lines, int rows);

/* ---- the string of pieces (sheets_strip.c) ---- */

double thr_step_strip_height(int visits); /* mm */

/* The arms of a node around arms->hub, the longest so many mm long; *in and *out: the numbers of those by which the needle comes
 * in and goes out by these half-edges, -1 = by none that is drawn. */
void thr_step_arms(const thr_sheets *sheets, const thr_camera *camera, int v, double reach, thr_arms *arms, int half_in,
                   int half_out, int *in, int *out);

/* The hub of most arms of a step, if any has very many, in a corner of the picture that is free of the points at which the step
 * is busy: busy[n_busy]. Nowhere if none is (sheets_hub.c). */
void thr_step_put_hub(thr_sheets *sheets, const thr_step *step, const thr_camera *camera, const char *colour, thr_box picture,
                      const double (*busy)[2], int n_busy);

/* The pieces in the order of threading as they lie in the picture, with the way of the cord through each. camera: of a picture in
 * space, else NULL. */
void thr_step_put_strip(thr_sheets *sheets, const thr_step *step, const thr_camera *camera, const char *colour);

#endif
