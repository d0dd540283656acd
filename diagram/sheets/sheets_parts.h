/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files that lay out the booklet share: its state, and what each file adds to the pages.
 * Private to diagram/. Reading order: see sheets.h. */
#ifndef THR_SHEETS_PARTS_H
#define THR_SHEETS_PARTS_H

#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "diagram/sheets/sheets.h"
#include "diagram/space/space.h"
#include "diagram/tables/tables.h"
#include "graph/framework/frame.h"

/* Measures of a page, mm. Nothing is set smaller than THR_SHEET_SMALL: 7 pt are 2.47 mm. */
static const double THR_SHEET_MARGIN = 12; /* on all four sides */
static const double THR_SHEET_FOOT = 9;    /* kept free at the foot for the page's number */
static const double THR_SHEET_TEXT = 3;    /* font size of flowing text */
static const double THR_SHEET_SMALL = 2.6; /* font size of tables, rows and labels */
static const double THR_SHEET_LINE = 4.5;  /* from one line of flowing text to the next */

/* Which needle threads a part of a cord: the only one, or, from the fold, first right, then
 * left. */
typedef enum { THR_NEEDLE_ONLY, THR_NEEDLE_RIGHT, THR_NEEDLE_LEFT } thr_needle;

/* What goes with a visit of a needle to a piece (thr_visit). */
typedef struct {
  int part; /* of the cord, threaded in one go */
  thr_needle needle;
  double used; /* cord that this needle has used up by then, in units */
} thr_move;

typedef struct thr_step thr_step; /* sheets_parts.h */

/* What is known of the plan before pages are laid out, and does not change then. Visits are
 * numbered through all parts in the order of threading. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *f; /* the plan's */
  thr_sheets_options o;
  const thr_evaluation *evaluation; /* what is known of forces: the plan's, or that of the options;
                                       not present: nothing */
  thr_guide guide;                  /* what places and turns are called */
  thr_supplies supplies;            /* lengths to cut and to join, bores to make */
  thr_copy *copy;                   /* [n_cords] which cord repeats which */
  thr_pieces pieces;                /* what is threaded, and its kinds */
  int n_parts;
  thr_part *part; /* [n_parts] in the order of threading: every path, then its copies */
  int *fold;      /* [n_cords] pass at whose start the cord is folded; 0 = threaded from its end */
  int n_visits;
  thr_visit *visit; /* [n_visits] of the parts in order */
  thr_move *move;   /* [n_visits] */
  int *first_visit; /* [n_cords] a cord's visits follow each other from here on */
  int *threaded;    /* [pieces] the visit that picks it up */
  int n_passes;
  int *first_pass; /* [n_cords] in visited */
  int *visited;    /* [n_passes] the visit that each pass leads to, cord by cord as in a scene */
  bool in_space;   /* do steps have pictures in space, as no flat picture shows the framework whole
                      and without crossings? */
} thr_known;

/* The pages, and the place on the one that is being filled. Failures stick: the first one is kept
 * in why, and what comes after it does nothing. */
typedef struct {
  double size[2];           /* of a page, mm */
  char title[96];           /* of the booklet: "Step sheets: 49 pieces, 4 cords" */
  const thr_limits *limits; /* while pages are laid out */
  int n_pages, pages_capacity;
  thr_text *page;   /* [n_pages] bodies without page numbers, the title page's last; empty once they
                       were sent */
  thr_pages *pages; /* a PDF to which each page goes when it is finished, or NULL */
  double y;         /* where the next line goes, mm */
  char running[160]; /* heading of the pages that follow when this one is full */
  thr_err why;       /* the first failure */
} thr_flow;

/* The booklet being laid out. */
struct thr_sheets {
  thr_known known;
  thr_flow flow;
  thr_crops crops;  /* flat pictures at several scales */
  thr_space space;  /* pictures in space, if in_space */
  double map_pitch; /* mm, of the last map of a section; 0 = none yet */
  int *step;   /* [n_visits] the step in which it is; 0 = in none: of a copy, or not laid out yet */
  int n_steps; /* so far */
  int n_waiting, waiting_capacity;
  thr_step *waiting; /* steps for the next page, which is drawn when it is full */
};

/* Keeps st if it is a failure and the first one. What failed may have told why already. */
void thr_sheets_fail(thr_flow *flow, thr_status st);

/* Sends the page that is being filled, which is finished, to flow->pages, if there are any
 * (sheets.c). */
void thr_sheets_send(thr_flow *flow);

/* ---- pages (sheets_page.c) ---- */

/* Return the SVG of the page that is being filled; the width between its margins, and the y below
 * which nothing is written, mm. */
thr_text *thr_sheets_out(thr_flow *flow);
double thr_sheets_width(const thr_flow *flow);
double thr_sheets_bottom(const thr_flow *flow);

/* Begins a page with a heading. running: the heading of pages that the text flows over to. */
void thr_sheets_page(thr_flow *flow, const char *heading, const char *running);

/* Goes on to another page unless there is room for a height of so many mm. Returns whether it
 * did. */
bool thr_sheets_room(thr_flow *flow, double height);

/* Returns how many bytes of words fit in a line of a width, broken at blanks, and how many lines
 * words take. Width and font size in mm. */
size_t thr_sheets_fit(const char *words, double width, double size);
int thr_sheets_lines(const char *words, double width, double size);

/* Moves the next line of words, at most 511 bytes, into line and *words on to the line after;
 * blanks at the break are dropped. */
void thr_sheets_next_line(const char **words, double width, double size, char line[512]);

/* Writes words from a point on, in as few lines as the width allows, THR_SHEET_LINE or 1.45 font
 * sizes apart. Returns the y of the line after them. */
double thr_sheets_text(thr_flow *flow, double x, double y, double size, double width,
                       const char *attributes, const char *words);

/* Draws the framework from the current height to the bottom (mm): in space, or flat with passes and
 * pieces in their states and the pitch as in thr_crop_whole. */
void thr_sheets_whole(thr_sheets *sheets, bool in_space, const unsigned char *state,
                      const unsigned char *piece, double bottom, double *pitch);

/* Blocks of text, which go on to further pages: a heading that stays with what follows, a
 * paragraph, a paragraph with a box to tick, a bold one. */
typedef enum { THR_BLOCK_TITLE, THR_BLOCK_PARAGRAPH, THR_BLOCK_TICK, THR_BLOCK_WARNING } thr_block;

/* Write a block: formatted words of at most 1023 bytes; a text, which is released. */
void thr_sheets_put(thr_flow *flow, thr_block block, const char *format, ...) THR_PRINTF(3, 4);
void thr_sheets_put_text(thr_flow *flow, thr_block block, thr_text *words);

/* Draw a frame with its upper left corner at (x, y); the box to tick alone, beside a line at y. */
void thr_sheets_frame(thr_text *text, double x, double y, double width, double height,
                      const char *attributes);
void thr_sheets_box(thr_text *text, double x, double y);

/* Writes a row of cells with tabs between them. column: mm from the margin to where each cell
 * begins; < 0: the cell is aligned at its right end -x. bold: a heading. */
void thr_sheets_cells(thr_flow *flow, const double *column, bool bold, const char *format, ...)
    THR_PRINTF(4, 5);

/* ---- what is on them ---- */

/* Computes parts and visits of the needles, and all that is indexed by them (sheets_moves.c). */
thr_status thr_sheets_follow(thr_known *known, thr_err *err) THR_MUST_CHECK;

/* Returns how long the length is cut that is joined on after visit i, in units of the framework,
 * whose size is known (sheets_lengths.c). */
double thr_sheets_joined_length(const thr_known *known, int i);

/* Returns the visit after the last one of cord c. */
int thr_sheets_end(const thr_known *known, int c);

/* Returns how many pieces are picked up in visits first .. end - 1. */
int thr_sheets_count_new(const thr_known *known, int first, int end);

/* Returns how pieces look in a picture of visits first .. end - 1: on a cord already, picked up
 * then, or later (thr_piece_state). Freed by the caller; NULL if memory ran out. */
unsigned char *thr_sheets_piece_states(thr_flow *flow, const thr_known *known, int first, int end);

/* Returns the places of all nodes. */
const char (*thr_sheets_labels(const thr_known *known))[THR_LABEL];

/* Parts of the booklet that the title page names. */
typedef enum {
  THR_SHEET_PREPARE,
  THR_SHEET_CUT,
  THR_SHEET_NAMES,
  THR_SHEET_STEPS,
  THR_SHEET_LAST,
  THR_SHEET_PARTS
} thr_sheet_part;

/* Lays out the title page. first[THR_SHEET_PARTS]: number of pages before each part, without the
 * title page; -1: there is none (sheets_front.c). */
void thr_sheets_front(thr_sheets *sheets, const int *first);

/* Lay out how pieces are handled (sheets_making.c); what to cut and to make (sheets_prepare.c); how
 * much cord is drawn through, and where a length is joined on (sheets_lengths.c). */
void thr_sheets_making(thr_flow *flow, const thr_known *known);
void thr_sheets_prepare(thr_flow *flow, const thr_known *known);
void thr_sheets_lengths(thr_flow *flow, const thr_known *known);

/* Lay out drawings of solid pieces, kind by kind, and the names of all pieces, to stick on. Returns
 * the number of pages before the one with the first names, -1 if there are none (sheets_key.c). */
void thr_sheets_key(thr_sheets *sheets);
int thr_sheets_name_tags(thr_flow *flow, const thr_known *known);

/* Returns how many sections visits first .. end - 1 of a path have, 0 = no maps; lays out the page
 * before the nth section of n, which has so many steps (sheets_sections.c). */
int thr_sheets_sections(const thr_known *known, int first, int end);
void thr_sheets_section(thr_sheets *sheets, int nth, int n, int first, int end, int steps);

/* Lays out the steps of path c (sheets_steps.c). */
void thr_sheets_steps(thr_sheets *sheets, int c);

/* Draws the page of steps that is waiting; to be called before any other page (sheets_steps.c). */
void thr_sheets_flush(thr_sheets *sheets);

/* Lays out the copies of path c, if the path has any (sheets_copies.c). */
void thr_sheets_copies(thr_sheets *sheets, int c);

/* Lays out what to do when all cords are through (sheets_last.c). */
void thr_sheets_last(thr_flow *flow, const thr_known *known);

/* Returns the cord to pull tight first. */
int thr_sheets_hardest(const thr_known *known);

/* Returns what the harder end of cord c takes, N, where the evaluation knows it: so that the cord
 * is seated and, if a hand can do that, the pieces hold (thr_sheets_options.holding). */
double thr_sheets_pull(const thr_known *known, int c);

/* Appends that a hand does not manage so many newtons, or that the pieces have to be supported
 * meanwhile; nothing if a hand does both. */
void thr_sheets_too_hard(const thr_known *known, double newton, thr_text *words);

/* Writes the words of cord c: "Cord A (blue)", with its dash if it has one. */
void thr_sheets_cord_words(const thr_known *known, int c, char words[96]);

/* ---- a step: visits of a needle that have a picture and rows together. Private to
 * diagram/sheets/. ---- */

enum { THR_STEP_VISITS = 24 };

static const double THR_STEP_HEAD = 25;  /* mm: the heading, with the small picture beside it */
static const double THR_STEP_LEGEND = 6; /* mm: the legend below the picture */
static const double THR_STEP_PICTURE[2] = {90, 60}; /* mm: width and height of the least picture */

/* A step: visits first .. end - 1 of one needle. */
struct thr_step {
  int number, first, end;        /* number: from 1, through all paths */
  thr_crop_view view;            /* of a flat picture */
  double height;                 /* of its picture at least, mm */
  thr_text row[THR_STEP_VISITS]; /* words of the rows */
  int lines[THR_STEP_VISITS];    /* of each row */
  int n_rows, left;              /* rows; those in the left column */
  double rows_height;            /* of the higher column, mm */
  thr_text before, after;        /* what is done before the first row; the check after the last */
  int lines_before, lines_after;
};

/* ---- how a path is divided (sheets_divide.c) ---- */

/* Computes the ends of the steps of path c, in visits: end[*n_steps], freed by the caller. As few
 * steps as pictures allow in which every pass is legible, with ends where the cord turns rather
 * than within a straight run, by dynamic programming. */
thr_status thr_step_divide(thr_sheets *sheets, int c, int **end, int *n_steps,
                           thr_err *err) THR_MUST_CHECK;

/* Lists the passes of the scene by which visits first .. end - 1 come, in their order; now has a
 * place for each visit. Returns how many. */
int thr_step_now(const thr_known *known, int first, int end, int *now);

/* Return whether a visit is the first, or the last, of its needle. */
bool thr_step_begins(const thr_known *known, int visit);
bool thr_step_ends(const thr_known *known, int visit);

/* ---- what is written (sheets_rows.c) ---- */

/* Returns the colour of the passes drawn now, "#rrggbb": with one cord always the same, with
 * several the cord's. */
const char *thr_step_colour(const thr_known *known, const thr_step *step);

/* Fills texts and lines; the steps of the visits up to its end must be known. */
void thr_step_find_text(thr_sheets *sheets, thr_step *step);
void thr_step_destroy_text(thr_step *step);

/* Write number, cord, passes and tally of a step at height top; what the looks of pieces mean, what
 * being "step" or "section"; the rows, from flow->y on. */
void thr_step_put_heading(thr_flow *flow, const thr_known *known, const thr_step *step, double top);
void thr_step_put_legend(thr_flow *flow, double y, const char *what);
void thr_step_put_rows(thr_flow *flow, const thr_known *known, const thr_step *step);

/* Returns how many lines the row of a visit takes, more or less: what the row says of other steps
 * is not known yet. */
int thr_step_row_lines(thr_sheets *sheets, int visit);

/* Return the height of rows with the text before and after them, and of so many lines in so many
 * rows in two columns, mm. */
double thr_step_words_height(double rows_height, int lines_before, int lines_after);
double thr_step_rows_height(int lines, int rows);

/* ---- the string of pieces (sheets_strip.c) ---- */

/* Returns the height of the string of so many visits, mm. */
double thr_step_strip_height(int visits);

/* Computes the arms of node v around arms->hub, the longest `reach` mm long. *in and *out receive
 * the arms by which the needle comes in and goes out along these half-edges, -1 = by none that is
 * drawn. */
void thr_step_arms(const thr_known *known, const thr_camera *camera, int v, double reach,
                   thr_arms *arms, int half_in, int half_out, int *in, int *out);

/* Appends path data as an element with a look, nothing if the data are empty, and releases the
 * data. */
void thr_step_put_path(thr_text *data, const char *fill, const char *stroke, double width,
                       thr_text *text);

/* Draws the hub with the most arms of a step, if any has very many, in a corner of the picture that
 * is free of the points busy[n_busy]; nothing if no corner is (sheets_hub.c). */
void thr_step_put_hub(thr_flow *flow, const thr_known *known, const thr_step *step,
                      const thr_camera *camera, const char *colour, thr_box picture,
                      const double (*busy)[2], int n_busy);

/* Draws the icon of a visit alone, the longest arm `reach` mm long, as it lies in the layout; of a
 * visit that comes and goes by arms, with the names of both pieces that they face (sheets_hub.c).
 */
void thr_step_put_icon(const thr_known *known, int visit, const double hub[2], double reach,
                       const char *colour, thr_text *text);
void thr_step_put_example(const thr_known *known, int visit, const double hub[2], double reach,
                          const char *colour, thr_text *text);

/* Draws the pieces in the order of threading as they lie in the picture, with the way of the cord
 * through each. camera: of a picture in space, else NULL. */
void thr_step_put_strip(thr_flow *flow, const thr_known *known, const thr_step *step,
                        const thr_camera *camera, const char *colour);

#endif
