/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of a plan in words, row by row to be ticked off: each unique path once, then how its
 * copies repeat it. */
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 100, INDENT = 4 };

typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
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
} steps;

/* ---- lines ---- */

/* Writes the prefix and then the words, broken at blanks; further lines begin below the first word.
 * Destroys words. */
static void put_wrapped(steps *s, const char *prefix, thr_text *words)
{
  int indent = thr_text_columns(prefix, SIZE_MAX), column = indent;
  thr_text *text = s->out;
  thr_text_append(text, prefix);
  for (const char *w = words->data ? words->data : ""; *w;) {
    size_t length = strcspn(w, " ");
    int wide = thr_text_columns(w, length);
    if (column > indent && column + 1 + wide > COLUMNS) {
      thr_text_printf(text, "\n%*s", indent, "");
      column = indent;
    } else if (column > indent) {
      thr_text_append(text, " ");
      column++;
    }
    thr_text_append_bytes(text, w, length);
    column += wide;
    w += length + (w[length] == ' ');
  }
  thr_text_append(text, "\n");
  if (words->failed) text->failed = true;
  thr_text_destroy(words);
}

static void put_line(steps *s, const char *line)
{
  thr_text words = {0};
  thr_text_append(&words, line);
  put_wrapped(s, "", &words);
}

/* ---- paths ---- */

/* One row: a visit. Rows are numbered as the passes are in the pictures; S: here the cord starts.
 */
static void put_row(steps *s, const thr_cord *cord, int i)
{
  thr_text words = {0};
  char number[32], prefix[64];
  int digits = snprintf(number, sizeof number, "%d", cord->n_passes);
  if (s->visit[i].number)
    snprintf(number, sizeof number, "%d", s->visit[i].number);
  else
    snprintf(number, sizeof number, "S");
  snprintf(prefix, sizeof prefix, "[ ] %*s  ", digits, number);
  thr_pieces_say(&s->pieces, (const char(*)[THR_LABEL])s->guide.label, s->visit, i, NULL, &words);
  put_wrapped(s, prefix, &words);
}

/* The pass that the right needle begins with; 0: there is but one needle. */
static int fold_of(const steps *s, int c)
{
  for (int i = 0; i < s->n_parts; i++)
    if (s->part[i].cord == c && s->part[i].begins) return s->part[i].first;
  return 0;
}

static void put_rows(steps *s, int c)
{
  thr_text words = {0};
  const thr_cord *cord = &s->plan->cord[c];
  char indent[INDENT + 1];
  int start = thr_cord_start(s->f, cord), end = thr_cord_end(s->f, cord);
  snprintf(indent, sizeof indent, "%*s", INDENT, "");
  int i = s->first[c], left = i + cord->n_passes - fold_of(s, c) + s->pieces.solid,
      last = i + cord->n_passes + s->pieces.solid;
  if (left < last) thr_text_append(&words, "right needle, from the fold of the cord: ");
  thr_text_append(&words, "start at ");
  thr_guide_place(&s->guide, left < last ? thr_tail(s->f, cord->half[fold_of(s, c)]) : start,
                  &words);
  put_wrapped(s, indent, &words);
  for (; i < left; i++)
    put_row(s, cord, i);
  thr_text_append(&words, "the needle comes out at ");
  thr_guide_place(&s->guide, end, &words);
  if (left == last && start == end) thr_text_append(&words, ", where it began");
  put_wrapped(s, indent, &words);
  if (left == last) return;
  thr_text_append(&words, "left needle, from the fold at ");
  thr_guide_place(&s->guide, thr_tail(s->f, cord->half[fold_of(s, c)]), &words);
  thr_text_append(&words, ", numbers falling:");
  put_wrapped(s, indent, &words);
  for (; i < last; i++)
    put_row(s, cord, i);
  thr_text_append(&words, "the needle comes out at ");
  thr_guide_place(&s->guide, start, &words);
  put_wrapped(s, indent, &words);
}

/* ", 17 passes, 15 pieces to pick up, 510.0 mm" */
static void put_measure(const steps *s, int c, thr_text *text)
{
  char length[64];
  const thr_cord *cord = &s->plan->cord[c];
  int picked = 0;
  for (int i = s->first[c]; i < s->n_visits && s->visit[i].cord == c; i++)
    picked += s->visit[i].nth == 1;
  thr_svg_length(thr_cord_length(s->f, cord), s->f->units, length);
  thr_text_printf(text, ", %d pass%s, %d %s to pick up, %s", cord->n_passes,
                  cord->n_passes == 1 ? "" : "es", picked, thr_pieces_word(s->plan, picked),
                  length);
}

/* ---- copies ---- */

/* Is every left turn of the path a right one of its copy, and the other way round? Not for copies
 * threaded backwards, whose turns come in the opposite order too. */
static bool is_reflected(const steps *s, int c)
{
  const thr_copy *copy = &s->copy[c];
  const thr_cord *cord = &s->plan->cord[c], *path = &s->plan->cord[copy->of];
  bool some = false;
  for (int k = 1; k < cord->n_passes && !copy->backward; k++) {
    int now = (copy->start + k) % path->n_passes, before = (copy->start + k - 1) % path->n_passes;
    thr_way own = thr_guide_way(&s->guide, cord->half[k - 1], cord->half[k]),
            model = thr_guide_way(&s->guide, path->half[before], path->half[now]);
    if (own != THR_WAY_LEFT && own != THR_WAY_RIGHT) continue;
    if (own == model) return false;
    some |= model == THR_WAY_LEFT || model == THR_WAY_RIGHT;
  }
  return some;
}

static void put_copy(steps *s, int c)
{
  thr_text words = {0};
  char how[192];
  const thr_cord *cord = &s->plan->cord[c];
  thr_copies_words(s->plan, s->copy, c, s->motion, how);
  if (!s->motion || !s->motion[c]) {
    thr_text_printf(&words, "Cord %s: copy of path %d%s, in full:", cord->id, s->copy[c].path + 1,
                    how);
    put_wrapped(s, "", &words);
    put_rows(s, c);
    return;
  }
  thr_text_printf(&words, "Cord %s: the same%s%s: start at ", cord->id, how,
                  is_reflected(s, c) ? ", left and right turns exchanged" : "");
  thr_guide_place(&s->guide, thr_cord_start(s->f, cord), &words);
  thr_text_printf(&words, ", first to %s, end at ", s->guide.label[thr_head(s->f, cord->half[0])]);
  thr_guide_place(&s->guide, thr_cord_end(s->f, cord), &words);
  put_wrapped(s, "[ ] ", &words);
}

static void put_path(steps *s, int c, int n_paths)
{
  thr_text words = {0};
  int copies = thr_copies_count(s->copy, s->plan->n_cords, c);
  thr_text_append(s->out, "\n");
  if (n_paths < s->plan->n_cords)
    thr_text_printf(&words, "Path %d of %d: cord ", s->copy[c].path + 1, n_paths);
  else
    thr_text_append(&words, "Cord ");
  thr_text_append(&words, s->plan->cord[c].id);
  put_measure(s, c, &words);
  put_wrapped(s, "", &words);
  put_rows(s, c);
  if (!copies) return;
  thr_text_printf(s->out, "\nRepeat path %d with %d other cord%s:\n", s->copy[c].path + 1, copies,
                  copies == 1 ? "" : "s");
  for (int i = 0; i < s->plan->n_cords; i++)
    if (i != c && s->copy[i].of == c) put_copy(s, i);
}

/* ---- the whole ---- */

/* How kinds and names are told apart, by a piece that has both. */
static void put_example(steps *s)
{
  thr_text words = {0};
  char name[24];
  int i = 0;
  while (i < s->n_visits && s->pieces.members[s->pieces.kind[s->visit[i].piece]] == 1)
    i++;
  if (i == s->n_visits) return;
  int piece = s->visit[i].piece;
  thr_pieces_kind_name(&s->pieces, s->pieces.kind[piece], name);
  thr_pieces_pick(&s->pieces, (const char(*)[THR_LABEL])s->guide.label, piece, &words);
  thr_text_printf(&words, ": a %s of kind %s, which comes to ", thr_pieces_word(s->plan, 1), name);
  thr_pieces_name(&s->pieces, (const char(*)[THR_LABEL])s->guide.label, piece, &words);
  thr_text_append(&words, ". Kinds: beads.csv.");
  put_wrapped(s, "", &words);
}

static void put_heading(steps *s, int n_paths)
{
  thr_text words = {0};
  char length[64];
  double total = 0;
  int n = s->plan->n_cords;
  for (int c = 0; c < n; c++)
    total += thr_cord_length(s->f, &s->plan->cord[c]);
  thr_svg_length(total, s->f->units, length);
  thr_text_printf(&words, "Steps: %d cord%s", n, n == 1 ? "" : "s");
  if (n_paths < n)
    thr_text_printf(&words, ", %d path%s to learn", n_paths, n_paths == 1 ? "" : "s");
  thr_text_printf(&words, ", %d %s, %d passes, %s of cord", s->pieces.n,
                  thr_pieces_word(s->plan, s->pieces.n), s->n_passes, length);
  put_wrapped(s, "", &words);
  thr_text_append(s->out, "\n");
  put_line(s, thr_layout_words(s->guide.layout.kind));
  put_line(s, s->pieces.solid ? "Rows: box to tick, the number of the pass that leads into the "
                                "piece (S: the cord starts), whether the piece is new "
                                "or on a cord already, and by which arms the cord goes in and out: "
                                "an arm is called by the piece that it faces."
                              : "Rows: box to tick, the number of the pass, whether the tube is "
                                "new or on a cord already, and the places at which "
                                "the cord goes in and out. Back through: against the way of the "
                                "cord that came before.");
  put_example(s);
}

/* How the cords are tightened, if an evaluation says so. */
static void put_tightening(steps *s)
{
  const thr_schedule *schedule = &s->plan->evaluation.schedule;
  if (schedule->n == 0) return;
  thr_text_append(s->out, "\nTightening:\n");
  for (int k = 0; k < schedule->n; k++) {
    thr_text words = {0};
    thr_tighten_step(s->plan, &s->guide, &schedule->step[k], &words);
    put_wrapped(s, "[ ] ", &words);
  }
}

static thr_status prepare(steps *s, double tolerance, int needles, const thr_layout *layout,
                          thr_err *err)
{
  const thr_plan *p = s->plan;
  thr_status st = thr_scene_check_cords(p, &s->n_passes, err);
  if (!st && !p->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  if (st) return st;
  s->copy = thr_calloc((size_t)p->n_cords, sizeof *s->copy);
  s->part = thr_calloc(2 * (size_t)p->n_cords, sizeof *s->part);
  s->first = thr_calloc((size_t)p->n_cords, sizeof *s->first);
  st = s->copy && s->part && s->first ? thr_guide_make(&s->guide, s->f, layout, err)
                                      : thr_nomem(err);
  if (!st) st = thr_copies_find(p, s->copy, err);
  if (!st) st = thr_pieces_make(&s->pieces, p, tolerance, err);
  if (st) return st;
  s->n_parts = thr_pieces_parts(p, s->copy, needles, s->part);
  st = thr_pieces_follow(&s->pieces, s->part, s->n_parts, &s->visit, &s->n_visits, err);
  for (int i = s->n_visits - 1; i >= 0; i--)
    s->first[s->visit[i].cord] = i;
  return st;
}

thr_status thr_steps_text(const thr_plan *p, const char *const *motion, double tolerance,
                          int needles, const thr_layout *layout, thr_text *out, thr_err *err)
{
  thr_text text = {0};
  steps s = {.plan = p, .f = &p->frame, .motion = motion, .out = &text};
  thr_status st = prepare(&s, tolerance, needles, layout, err);
  if (st) goto done;
  int n_paths = thr_copies_paths(s.copy, p->n_cords);
  put_heading(&s, n_paths);
  for (int c = 0; c < p->n_cords; c++)
    if (s.copy[c].of == c) put_path(&s, c, n_paths);
  put_tightening(&s);
  if (!text.failed) thr_text_append_bytes(out, text.data, text.length);
  if (text.failed || out->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&text);
  thr_guide_destroy(&s.guide);
  free(s.copy);
  thr_pieces_destroy(&s.pieces);
  free(s.part);
  free(s.visit);
  free(s.first);
  return st;
}
