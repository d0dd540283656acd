#include "diagram/overview/steps.h"

#include "diagram/layout/layout.h"
#include "diagram/scene/copies.h"
#include "diagram/overview/guide.h"
#include "diagram/scene/scene.h"
#include "diagram/overview/svg.h"
#include "graph/framework/frame.h"

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
  thr_held held;  /* by the passes so far */
  int n_passes;
  thr_text *out;
} steps;

/* ---- lines ---- */

/* Writes the prefix and then the words, broken at blanks; further lines begin below the first word. Destroys words. */
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

/* Does pass k of a cord go straight on from the one before? */
static bool is_straight(const steps *s, const thr_cord *cord, int k)
{
  return k > 0 && thr_guide_way(&s->guide, cord->half[k - 1], cord->half[k]) == THR_WAY_STRAIGHT;
}

/* One row: the passes from first on that go straight on through beads that hold as many cords. Returns the pass after it. */
static int put_row(steps *s, const thr_cord *cord, int first)
{
  thr_text words = {0};
  char range[32], prefix[64], nth[16];
  int k = first, times = s->held.cords[cord->half[k] >> 1] + 1, digits = snprintf(range, sizeof range, "%d", cord->n_passes);
  if (k == 0)
    thr_text_append(&words, "go");
  else
    thr_guide_say(&s->guide, cord->half[k - 1], cord->half[k], &words);
  bool straight = is_straight(s, cord, k);
  thr_text_printf(&words, " to %s", s->guide.label[thr_head(s->f, cord->half[k])]);
  thr_held_pass(&s->held, cord->half[k++]);
  for (; k < cord->n_passes && is_straight(s, cord, k) && s->held.cords[cord->half[k] >> 1] + 1 == times; k++) {
    if (k == first + 1 && !straight) thr_text_append(&words, ", straight on to");
    thr_text_printf(&words, " %s", s->guide.label[thr_head(s->f, cord->half[k])]);
    thr_held_pass(&s->held, cord->half[k]);
  }
  thr_guide_ordinal(times, nth);
  if (times > 1) thr_text_printf(&words, " (%s pass)", nth);
  if (k == first + 1)
    snprintf(range, sizeof range, "%d", k);
  else
    snprintf(range, sizeof range, "%d-%d", first + 1, k);
  snprintf(prefix, sizeof prefix, "[ ] %*s  ", 2 * digits + 1, range);
  put_wrapped(s, prefix, &words);
  return k;
}

static void put_rows(steps *s, const thr_cord *cord)
{
  thr_text words = {0};
  char indent[INDENT + 1];
  int start = thr_cord_start(s->f, cord), end = thr_cord_end(s->f, cord);
  snprintf(indent, sizeof indent, "%*s", INDENT, "");
  thr_text_append(&words, "start at ");
  thr_guide_place(&s->guide, start, &words);
  put_wrapped(s, indent, &words);
  for (int k = 0; k < cord->n_passes;)
    k = put_row(s, cord, k);
  thr_text_append(&words, "the needle comes out at ");
  thr_guide_place(&s->guide, end, &words);
  if (start == end) thr_text_append(&words, ", where it began");
  put_wrapped(s, indent, &words);
}

/* ", 17 passes through 15 beads, 510.0 mm". A bead is counted at its first pass. */
static void put_measure(const steps *s, const thr_cord *cord, int *seen, int mark, thr_text *text)
{
  char length[64];
  int beads = 0;
  for (int k = 0; k < cord->n_passes; k++) {
    beads += seen[cord->half[k] >> 1] != mark;
    seen[cord->half[k] >> 1] = mark;
  }
  thr_svg_length(thr_cord_length(s->f, cord), s->f->units, length);
  thr_text_printf(text, ", %d pass%s through %d bead%s, %s", cord->n_passes, cord->n_passes == 1 ? "" : "es", beads,
                  beads == 1 ? "" : "s", length);
}

/* ---- copies ---- */

/* Is every left turn of the path a right one of its copy, and the other way round? Not for copies threaded backwards, whose turns
 * come in the opposite order too. */
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
    thr_text_printf(&words, "Cord %s: copy of path %d%s, in full:", cord->id, s->copy[c].path + 1, how);
    put_wrapped(s, "", &words);
    put_rows(s, cord);
    return;
  }
  thr_text_printf(&words, "Cord %s: the same%s%s: start at ", cord->id, how,
                  is_reflected(s, c) ? ", left and right turns exchanged" : "");
  thr_guide_place(&s->guide, thr_cord_start(s->f, cord), &words);
  thr_text_printf(&words, ", first to %s, end at ", s->guide.label[thr_head(s->f, cord->half[0])]);
  thr_guide_place(&s->guide, thr_cord_end(s->f, cord), &words);
  put_wrapped(s, "[ ] ", &words);
  for (int k = 0; k < cord->n_passes; k++)
    thr_held_pass(&s->held, cord->half[k]);
}

static void put_path(steps *s, int c, int n_paths, int *seen)
{
  thr_text words = {0};
  int copies = thr_copies_count(s->copy, s->plan->n_cords, c);
  thr_text_append(s->out, "\n");
  if (n_paths < s->plan->n_cords)
    thr_text_printf(&words, "Path %d of %d: cord ", s->copy[c].path + 1, n_paths);
  else
    thr_text_append(&words, "Cord ");
  thr_text_append(&words, s->plan->cord[c].id);
  put_measure(s, &s->plan->cord[c], seen, c + 1, &words);
  put_wrapped(s, "", &words);
  put_rows(s, &s->plan->cord[c]);
  if (!copies) return;
  thr_text_printf(s->out, "\nRepeat path %d with %d other cord%s:\n", s->copy[c].path + 1, copies, copies == 1 ? "" : "s");
  for (int i = 0; i < s->plan->n_cords; i++)
    if (i != c && s->copy[i].of == c) put_copy(s, i);
}

/* ---- the whole ---- */

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
  if (n_paths < n) thr_text_printf(&words, ", %d path%s to learn", n_paths, n_paths == 1 ? "" : "s");
  thr_text_printf(&words, ", %d beads, %d passes, %s of cord", s->f->n_edges, s->n_passes, length);
  put_wrapped(s, "", &words);
  thr_text_append(s->out, "\n");
  put_line(s, thr_layout_words(s->guide.layout.kind));
  put_line(s, !s->guide.sides ? "Turns have no left and right here: in this view beads cross that do not in space."
                              : "Left and right are meant as seen there, going with the needle. Over the curve: ahead, where the "
                                "surface bends.");
  put_line(s, "Rows: box to tick, passes, the nodes that they come to. Straight on: a turn of less than 15 degrees. Second pass: "
              "the beads hold a cord already.");
}

static thr_status prepare(steps *s, thr_err *err)
{
  const thr_plan *p = s->plan;
  thr_status st = thr_scene_check_cords(p, &s->n_passes, err);
  if (!st && !p->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  if (st) return st;
  s->copy = thr_calloc((size_t)p->n_cords, sizeof *s->copy);
  st = s->copy ? thr_held_make(&s->held, s->f->n_edges, err) : thr_nomem(err);
  if (!st) st = thr_guide_make(&s->guide, s->f, err);
  if (!st) st = thr_copies_find(p, s->copy, err);
  return st;
}

thr_status thr_steps_text(const thr_plan *p, const char *const *motion, thr_text *out, thr_err *err)
{
  thr_text text = {0};
  steps s = {.plan = p, .f = &p->frame, .motion = motion, .out = &text};
  int *seen = thr_calloc((size_t)p->frame.n_edges, sizeof *seen);
  thr_status st = seen ? prepare(&s, err) : thr_nomem(err);
  if (st) goto done;
  int n_paths = thr_copies_paths(s.copy, p->n_cords);
  put_heading(&s, n_paths);
  for (int c = 0; c < p->n_cords; c++)
    if (s.copy[c].of == c) put_path(&s, c, n_paths, seen);
  if (!text.failed) thr_text_append_bytes(out, text.data, text.length);
  if (text.failed || out->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&text);
  thr_guide_destroy(&s.guide);
  free(s.copy);
  thr_held_destroy(&s.held);
  free(seen);
  return st;
}
