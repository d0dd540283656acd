/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the steps of a plan as plain text, row by row to be ticked off: each unique path once,
 * then how its copies repeat it.
 *
 * The needle is followed through all cords in the order of threading (thr_pieces_follow), which
 * gives a visit for every piece that it comes to. A row says what is done there. Copies of a path
 * are one row each, because whoever has threaded the path knows the steps.
 *
 * Example of a row, of pass 4 of a cord; long rows go on below their first word:
 *   [ ]  4  pick up X-10 (B5): in from A5, out to C5 */
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Columns of the text, and those before what belongs to a cord. */
enum { COLUMNS = 100, INDENT = 4 };

/* The text while it is written. Arrays are owned. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *frame;
  const char *const *motion;
  thr_guide guide;
  thr_copy *copy; /* [n_cords] */
  thr_pieces pieces;
  int n_parts;
  thr_part *part;   /* [n_parts] in the order of threading */
  thr_visit *visit; /* [n_visits] in that order */
  int n_visits;
  int *first; /* [n_cords] visit */
  int n_passes;
  thr_text *out;
} steps_list;

/* ---- lines ---- */

/* Writes the prefix and then the words, broken at blanks into lines of at most COLUMNS; further
 * lines begin below the first word. Destroys words. */
static void put_wrapped(steps_list *list, const char *prefix, thr_text *words)
{
  int indent = thr_text_columns(prefix, SIZE_MAX), column = indent;
  thr_text *text = list->out;
  thr_text_append(text, prefix);

  /* Word by word. A word that is wider than a line has one of its own. */
  for (const char *word = words->data ? words->data : ""; *word;) {
    size_t length = strcspn(word, " ");
    int width = thr_text_columns(word, length);
    if (column > indent && column + 1 + width > COLUMNS) {
      thr_text_printf(text, "\n%*s", indent, "");
      column = indent;
    } else if (column > indent) {
      thr_text_append(text, " ");
      column++;
    }
    thr_text_append_bytes(text, word, length);
    column += width;
    word += length + (word[length] == ' ');
  }

  thr_text_append(text, "\n");
  if (words->failed) text->failed = true;
  thr_text_destroy(words);
}

/* Writes a line of plain words, broken as above. */
static void put_line(steps_list *list, const char *line)
{
  thr_text words = {0};
  thr_text_append(&words, line);
  put_wrapped(list, "", &words);
}

/* ---- paths ---- */

/* Writes the row of visit i: a box to tick, the number of the pass that leads there (as in the
 * pictures; S: the cord starts there), and what is done. */
static void put_row(steps_list *list, const thr_cord *cord, int i)
{
  thr_text words = {0};
  char number[32], prefix[64];

  /* All numbers of a cord are as wide as that of its last pass. */
  int digits = snprintf(number, sizeof number, "%d", cord->n_passes);
  if (list->visit[i].number)
    snprintf(number, sizeof number, "%d", list->visit[i].number);
  else
    snprintf(number, sizeof number, "S");

  /* "[ ]  4  ", then what is done there. */
  snprintf(prefix, sizeof prefix, "[ ] %*s  ", digits, number);
  thr_pieces_say(&list->pieces, (const char(*)[THR_LABEL])list->guide.label, list->visit, i, NULL,
                 &words);
  put_wrapped(list, prefix, &words);
}

/* Returns the pass that the right needle begins with, where cord c is threaded from its fold with
 * two needles; 0: there is one needle. */
static int fold_of(const steps_list *list, int c)
{
  for (int i = 0; i < list->n_parts; i++)
    if (list->part[i].cord == c && list->part[i].begins) return list->part[i].first;
  return 0;
}

/* Writes all rows of a cord, with a line before them that says where to start, and one after them
 * where the needle comes out. A cord threaded from its fold has two parts: the right needle goes on
 * to the end, the left one back to the start. */
static void put_rows(steps_list *list, int c)
{
  thr_text words = {0};
  const thr_cord *cord = &list->plan->cord[c];
  char indent[INDENT + 1];
  int start = thr_cord_start(list->frame, cord), end = thr_cord_end(list->frame, cord);

  snprintf(indent, sizeof indent, "%*s", INDENT, "");

  /* Visits i .. left - 1 are the right needle's, left .. last - 1 the left one's, of which there
   * are none with one needle. A part that begins in a solid piece has one visit more than
   * passes. */
  int i = list->first[c], left = i + cord->n_passes - fold_of(list, c) + list->pieces.solid,
      last = i + cord->n_passes + list->pieces.solid;

  /* The only needle, or the right one. */
  if (left < last) thr_text_append(&words, "right needle, from the fold of the cord: ");
  thr_text_append(&words, "start at ");
  thr_guide_place(&list->guide,
                  left < last ? thr_tail(list->frame, cord->half[fold_of(list, c)]) : start,
                  &words);
  put_wrapped(list, indent, &words);

  /* Rows of the right needle's visits. */
  for (; i < left; i++)
    put_row(list, cord, i);

  /* Where the needle comes out. */
  thr_text_append(&words, "the needle comes out at ");
  thr_guide_place(&list->guide, end, &words);
  if (left == last && start == end) thr_text_append(&words, ", where it began");
  put_wrapped(list, indent, &words);

  /* With one needle that is all. */
  if (left == last) return;

  /* The left needle, from the fold back to the start. */
  thr_text_append(&words, "left needle, from the fold at ");
  thr_guide_place(&list->guide, thr_tail(list->frame, cord->half[fold_of(list, c)]), &words);
  thr_text_append(&words, ", numbers falling:");
  put_wrapped(list, indent, &words);
  for (; i < last; i++)
    put_row(list, cord, i);
  thr_text_append(&words, "the needle comes out at ");
  thr_guide_place(&list->guide, start, &words);
  put_wrapped(list, indent, &words);
}

/* Appends what a cord takes: ", 17 passes, 15 pieces to pick up, 510.0 mm". A piece is picked up by
 * the first visit of any cord (nth = 1). */
static void put_measure(const steps_list *list, int c, thr_text *text)
{
  char length[64];
  const thr_cord *cord = &list->plan->cord[c];
  int picked = 0;

  /* Count the visits that pick something up. */
  for (int i = list->first[c]; i < list->n_visits && list->visit[i].cord == c; i++)
    picked += list->visit[i].nth == 1;

  thr_svg_length(thr_cord_length(list->frame, cord), list->frame->units, length);
  thr_text_printf(text, ", %d pass%s, %d %s to pick up, %s", cord->n_passes,
                  cord->n_passes == 1 ? "" : "es", picked, thr_pieces_word(list->plan, picked),
                  length);
}

/* ---- copies ---- */

/* Returns whether every left turn of the path is a right one of its copy, and the other way round,
 * as in a mirror image. Not for copies threaded backwards, whose turns come in the opposite order,
 * too. */
static bool is_reflected(const steps_list *list, int c)
{
  const thr_copy *copy = &list->copy[c];
  const thr_cord *cord = &list->plan->cord[c], *path = &list->plan->cord[copy->of];
  bool some = false;

  /* Pass k of the copy is the image of pass start + k of the path; closed cords go round. */
  for (int k = 1; k < cord->n_passes && !copy->backward; k++) {
    int now = (copy->start + k) % path->n_passes, before = (copy->start + k - 1) % path->n_passes;
    thr_way own = thr_guide_way(&list->guide, cord->half[k - 1], cord->half[k]),
            model = thr_guide_way(&list->guide, path->half[before], path->half[now]);

    /* Only turns to a side say anything. */
    if (own != THR_WAY_LEFT && own != THR_WAY_RIGHT) continue;
    if (own == model) return false;

    some |= model == THR_WAY_LEFT || model == THR_WAY_RIGHT;
  }

  return some;
}

/* Writes a copy: one row that says by what motion in space it repeats its path; or all rows, if no
 * motion is known. */
static void put_copy(steps_list *list, int c)
{
  thr_text words = {0};
  char how[192];
  const thr_cord *cord = &list->plan->cord[c];

  /* The motion in words: ", turned by 90 degrees". */
  thr_copies_words(list->plan, list->copy, c, list->motion, how);

  /* Without a motion the path cannot be carried over in one's head. */
  if (!list->motion || !list->motion[c]) {
    thr_text_printf(&words, "Cord %s: copy of path %d%s, in full:", cord->id,
                    list->copy[c].path + 1, how);
    put_wrapped(list, "", &words);
    put_rows(list, c);
    return;
  }

  /* The same path elsewhere: where it starts, where it goes first, where it ends. */
  thr_text_printf(&words, "Cord %s: the same%s%s: start at ", cord->id, how,
                  is_reflected(list, c) ? ", left and right turns exchanged" : "");
  thr_guide_place(&list->guide, thr_cord_start(list->frame, cord), &words);
  thr_text_printf(&words, ", first to %s, end at ",
                  list->guide.label[thr_head(list->frame, cord->half[0])]);
  thr_guide_place(&list->guide, thr_cord_end(list->frame, cord), &words);

  put_wrapped(list, "[ ] ", &words);
}

/* Writes a path: its heading, its rows, and its copies. */
static void put_path(steps_list *list, int c, int n_paths)
{
  thr_text words = {0};
  int copies = thr_copies_count(list->copy, list->plan->n_cords, c);
  thr_text_append(list->out, "\n");

  /* Of plans without copies a path is simply a cord. */
  if (n_paths < list->plan->n_cords)
    thr_text_printf(&words, "Path %d of %d: cord ", list->copy[c].path + 1, n_paths);
  else
    thr_text_append(&words, "Cord ");
  thr_text_append(&words, list->plan->cord[c].id);

  /* The heading says what the path takes; the rows follow. */
  put_measure(list, c, &words);
  put_wrapped(list, "", &words);
  put_rows(list, c);

  if (!copies) return;

  /* The copies, a row each if they can be said so. */
  thr_text_printf(list->out, "\nRepeat path %d with %d other cord%s:\n", list->copy[c].path + 1,
                  copies, copies == 1 ? "" : "s");
  for (int i = 0; i < list->plan->n_cords; i++)
    if (i != c && list->copy[i].of == c) put_copy(list, i);
}

/* ---- the whole ---- */

/* Explains how kinds and names are told apart, by a piece that has both; nothing if every kind is
 * called by its shape. */
static void put_example(steps_list *list)
{
  thr_text words = {0};
  char name[24];

  /* The first piece that is picked up of a kind that is called by its number. */
  int i = 0;
  while (i < list->n_visits &&
         thr_pieces_alone(&list->pieces, list->pieces.kind[list->visit[i].piece]))
    i++;
  if (i == list->n_visits) return;

  /* The words are an example of what the rows call this piece. */
  int piece = list->visit[i].piece;
  thr_pieces_kind_name(&list->pieces, list->pieces.kind[piece], name);
  thr_pieces_pick(&list->pieces, (const char(*)[THR_LABEL])list->guide.label, piece, &words);

  thr_text_printf(&words, ": a %s of kind %s, which comes to ", thr_pieces_word(list->plan, 1),
                  name);
  thr_pieces_name(&list->pieces, (const char(*)[THR_LABEL])list->guide.label, piece, &words);
  thr_text_append(&words, ". Kinds: beads.csv.");
  put_wrapped(list, "", &words);
}

/* Writes the heading: what the plan takes, how the pictures are seen, and how to read the rows. */
static void put_heading(steps_list *list, int n_paths)
{
  thr_text words = {0};
  char length[64];
  double total = 0;
  int n = list->plan->n_cords;

  /* The length of all cords together. */
  for (int c = 0; c < n; c++)
    total += thr_cord_length(list->frame, &list->plan->cord[c]);
  thr_svg_length(total, list->frame->units, length);

  /* The numbers of cords, paths, pieces and passes. */
  thr_text_printf(&words, "Steps: %d cord%s", n, n == 1 ? "" : "s");
  if (n_paths < n)
    thr_text_printf(&words, ", %d path%s to learn", n_paths, n_paths == 1 ? "" : "s");
  thr_text_printf(&words, ", %d %s, %d passes, %s of cord", list->pieces.n,
                  thr_pieces_word(list->plan, list->pieces.n), list->n_passes, length);

  put_wrapped(list, "", &words);
  thr_text_append(list->out, "\n");

  /* From where left and right are seen, and what a row means. */
  put_line(list, thr_layout_words(list->guide.layout.kind));
  put_line(list, list->pieces.solid
                     ? "Rows: box to tick, the number of the pass that leads into the "
                       "piece (S: the cord starts), whether the piece is new "
                       "or on a cord already, and by which arms the cord goes in and out: "
                       "an arm is called by the piece that it faces."
                     : "Rows: box to tick, the number of the pass, whether the tube is "
                       "new or on a cord already, and the places at which "
                       "the cord goes in and out. Back through: against the way of the "
                       "cord that came before.");

  put_example(list);
}

/* Writes how the cords are tightened, a row per step of the schedule, if the evaluation has one. */
static void put_tightening(steps_list *list)
{
  const thr_schedule *schedule = &list->plan->evaluation.schedule;
  if (schedule->n == 0) return;

  thr_text_append(list->out, "\nTightening:\n");
  for (int k = 0; k < schedule->n; k++) {
    thr_text words = {0};
    thr_tighten_step(list->plan, &list->guide, &schedule->step[k], &words);
    put_wrapped(list, "[ ] ", &words);
  }
}

/* Prepares what the rows are made of: names, copies, kinds of pieces, and the visits in the order
 * of threading. What is made is released by the caller, after a failure too. */
static thr_status prepare(steps_list *list, double tolerance, int needles, const thr_layout *layout,
                          thr_err *err)
{
  const thr_plan *plan = list->plan;

  /* A plan that cannot be threaded has no steps. */
  thr_status st = thr_scene_check_cords(plan, &list->n_passes, err);
  if (!st && !plan->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  if (st) return st;

  list->copy = thr_calloc((size_t)plan->n_cords, sizeof *list->copy);
  list->part = thr_calloc(2 * (size_t)plan->n_cords, sizeof *list->part);
  list->first = thr_calloc((size_t)plan->n_cords, sizeof *list->first);

  st = list->copy && list->part && list->first
           ? thr_guide_make(&list->guide, list->frame, layout, err)
           : thr_nomem(err);

  /* Which cords repeat others, and what the pieces are called. */
  if (!st) st = thr_copies_find(plan, list->copy, err);
  if (!st) st = thr_pieces_make(&list->pieces, plan, tolerance, err);
  if (st) return st;

  /* The parts of the cords in the order of threading, and where the needle comes in each. */
  list->n_parts = thr_pieces_parts(plan, list->copy, needles, list->part);
  st = thr_pieces_follow(&list->pieces, list->part, list->n_parts, &list->visit, &list->n_visits,
                         err);

  /* The first visit of each cord. */
  for (int i = list->n_visits - 1; i >= 0; i--)
    list->first[list->visit[i].cord] = i;

  return st;
}

/* Writes into a text of its own, so that out is unchanged on failure. */
thr_status thr_steps_text(const thr_plan *plan, const char *const *motion, double tolerance,
                          int needles, const thr_layout *layout, thr_text *out, thr_err *err)
{
  thr_text text = {0};
  steps_list list = {.plan = plan, .frame = &plan->frame, .motion = motion, .out = &text};
  thr_status st = prepare(&list, tolerance, needles, layout, err);

  if (st) goto done;

  /* Paths in the plan's order, each with its copies after it. */
  int n_paths = thr_copies_paths(list.copy, plan->n_cords);
  put_heading(&list, n_paths);
  for (int c = 0; c < plan->n_cords; c++)
    if (list.copy[c].of == c) put_path(&list, c, n_paths);
  put_tightening(&list);

  /* out gets all of the text or nothing. */
  if (!text.failed) thr_text_append_bytes(out, text.data, text.length);
  if (text.failed || out->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&text);
  thr_guide_destroy(&list.guide);
  free(list.copy);
  thr_pieces_destroy(&list.pieces);
  free(list.part);
  free(list.visit);
  free(list.first);
  return st;
}
