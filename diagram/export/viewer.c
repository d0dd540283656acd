/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The viewer: the framework in space with the cords step by step, as one HTML file that needs no
 * network. Its page is built from viewer/ (`make viewer`) and lies built in
 * diagram/export/viewer_page.html, which becomes part of the program. */
#include "diagram/export/paper.h"

#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_measures.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TICKS = 4, RAMP = 24 };

typedef struct {
  const thr_plan *plan;
  const thr_frame *f;
  const char *const *motion;
  thr_guide guide;
  thr_copy *copy; /* [n_cords] */
  bool tension;   /* are there any? */
  double range[2];
  int needles; /* as in thr_cord_folded */
  thr_pieces pieces;
  thr_visit *visit; /* [n_visits] in the order of threading */
  int n_visits;
  thr_writer out;
} viewer;

/* ---- the framework ---- */

static void put_point(thr_writer *writer, int digits, const double at[3])
{
  thr_write_array(writer, NULL);
  for (int i = 0; i < 3; i++)
    thr_write_printf(writer, NULL, "%.*g", digits, at[i]);
  thr_write_close(writer);
}

/* The next member of the whole, on a line of its own. */
static thr_writer *next_line(viewer *s)
{
  thr_write_line(&s->out, 0);
  return &s->out;
}

static void put_nodes(viewer *s)
{
  const thr_frame *frame = s->f;
  thr_writer *writer = &s->out;
  thr_write_array(next_line(s), "nodes");
  for (int v = 0; v < frame->n_nodes; v++)
    put_point(writer, 7, frame->xyz[v]);
  thr_write_close(writer);
  thr_write_array(next_line(s), "outward");
  for (int v = 0; v < frame->n_nodes; v++)
    put_point(writer, 3, s->guide.outward[v]);
  thr_write_close(writer);
  thr_write_array(next_line(s), "labels");
  for (int v = 0; v < frame->n_nodes; v++)
    thr_write_string(writer, NULL, s->guide.label[v]);
  thr_write_close(writer);
  thr_write_array(next_line(s), "places");
  for (int v = 0; v < frame->n_nodes; v++) {
    thr_text place = {0};
    thr_guide_place(&s->guide, v, &place);
    thr_write_words(writer, NULL, &place);
  }
  thr_write_close(writer);
  thr_write_array(next_line(s), "feet");
  for (int v = 0; v < frame->n_nodes; v++)
    if (frame->foot && frame->foot[v]) thr_write_int(writer, NULL, v);
  thr_write_close(writer);
}

static void put_edges(viewer *s)
{
  const thr_frame *frame = s->f;
  thr_write_array(next_line(s), "edges");
  for (int e = 0; e < frame->n_edges; e++)
    thr_write_ints(&s->out, NULL, frame->edge[e], 2);
  thr_write_close(&s->out);
  thr_write_array(next_line(s), "lengths");
  for (int e = 0; e < frame->n_edges; e++)
    thr_write_printf(&s->out, NULL, "%.7g", frame->length[e]);
  thr_write_close(&s->out);
}

/* What a hand picks up: names and kinds. */
static void put_pieces(viewer *s)
{
  char kind[24];
  thr_write_array(next_line(s), "pieces");
  for (int i = 0; i < s->pieces.n; i++) {
    thr_text name = {0};
    thr_pieces_name(&s->pieces, (const char(*)[THR_LABEL])s->guide.label, i, &name);
    thr_write_words(&s->out, NULL, &name);
  }
  thr_write_close(&s->out);
  thr_write_array(next_line(s), "kinds");
  for (int i = 0; i < s->pieces.n; i++) {
    thr_pieces_kind_name(&s->pieces, s->pieces.kind[i], kind);
    thr_write_string(&s->out, NULL, kind);
  }
  thr_write_close(&s->out);
}

/* ---- the cords ---- */

static void put_tension(viewer *s, const thr_eval_cord *cord)
{
  thr_writer *writer = &s->out;
  char text[32], words[64], hex[8];
  thr_svg_force(cord->force, text);
  if (cord->pull == THR_PULL_NONE)
    snprintf(words, sizeof words, "not pulled");
  else
    snprintf(words, sizeof words, "pull at %s: %s",
             cord->pull == THR_PULL_BOTH ? "both ends" : thr_pull_name(cord->pull), text);
  thr_write_line(writer, 1);
  thr_write_string(writer, "pull", words);
  thr_write_array(writer, "tension");
  for (int k = 0; k < cord->n_passes; k++)
    thr_write_printf(writer, NULL, "%.4g", cord->tension[k]);
  thr_write_close(writer);
  thr_write_array(writer, "taut");
  for (int k = 0; k < cord->n_passes; k++) {
    thr_tension_colour(s->range, cord->tension[k], hex);
    thr_write_string(writer, NULL, hex);
  }
  thr_write_close(writer);
}

/* What is done at every visit of a cord; of solid pieces the first is where it starts. */
static void put_visits(viewer *s, int c)
{
  int i = 0;
  while (s->visit[i].cord != c)
    i++;
  thr_write_line(&s->out, 1);
  thr_write_array(&s->out, "does");
  for (; i < s->n_visits && s->visit[i].cord == c; i++) {
    thr_text words = {0};
    thr_pieces_say(&s->pieces, (const char(*)[THR_LABEL])s->guide.label, s->visit, i, NULL, &words);
    thr_write_words(&s->out, NULL, &words);
  }
  thr_write_close(&s->out);
}

static void put_cord(viewer *s, int c)
{
  const thr_cord *cord = &s->plan->cord[c];
  thr_writer *writer = &s->out;
  thr_colour colour = thr_palette(s->copy[c].path);
  char words[192] = "";
  if (s->copy[c].of != c) thr_copies_words(s->plan, s->copy, c, s->motion, words);
  thr_write_object(next_line(s), NULL);
  thr_write_string(writer, "id", cord->id);
  thr_write_bool(writer, "closed", cord->closed);
  thr_write_int(writer, "of", s->copy[c].of);
  thr_write_int(writer, "path", s->copy[c].path);
  thr_write_string(writer, "how", words);
  thr_write_string(writer, "colour", colour.hex);
  thr_write_string(writer, "pale", colour.pale);
  thr_svg_length(thr_cord_length(s->f, cord), s->f->units, words);
  thr_write_string(writer, "length", words);
  thr_write_line(writer, 1);
  thr_write_ints(writer, "half", cord->half, cord->n_passes);
  thr_write_int(writer, "fold", thr_cord_fold(s->f, s->needles, cord));
  put_visits(s, c);
  if (s->tension && s->plan->evaluation.cord[c].known) put_tension(s, &s->plan->evaluation.cord[c]);
  thr_write_close(writer);
}

/* ---- the whole ---- */

static void put_ticks(viewer *s)
{
  thr_writer *writer = &s->out;
  double tick[TICKS];
  char text[32];
  int n = thr_svg_ticks(s->range[0], s->range[1], s->range[0] > 0, TICKS, tick);
  thr_write_array(writer, "ticks");
  for (int i = 0; i < n; i++) {
    thr_svg_force(tick[i], text);
    thr_write_array(writer, NULL);
    thr_write_printf(writer, NULL, "%.7g", tick[i]);
    thr_write_string(writer, NULL, text);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

static void put_scale(viewer *s)
{
  thr_writer *writer = &s->out;
  char hex[8];
  thr_write_object(next_line(s), "scale");
  thr_write_string(writer, "method", thr_tension_method_words(&s->plan->evaluation));
  thr_write_printf(writer, "low", "%.7g", s->range[0]);
  thr_write_printf(writer, "high", "%.7g", s->range[1]);
  put_ticks(s);
  thr_write_array(writer, "ramp");
  for (int i = 0; i <= RAMP; i++) { /* the colours are even over the logarithm */
    double part = (double)i / RAMP;
    thr_tension_colour(s->range, s->range[0] * pow(s->range[1] / s->range[0], part), hex);
    thr_write_string(writer, NULL, hex);
  }
  thr_write_close(writer);
  thr_write_close(writer);
}

static void put_head(viewer *s)
{
  const thr_plan *p = s->plan;
  thr_writer *writer = &s->out;
  thr_write_string(writer, "format", "thread-viewer");
  thr_write_int(writer, "version", 1);
  thr_write_hash(writer, "frame", thr_frame_hash(s->f));
  thr_write_string(writer, "units", s->f->units);
  thr_write_string(writer, "seen", thr_layout_words(s->guide.layout.kind));
  thr_write_bool(writer, "solid", s->pieces.solid);
  thr_write_int(writer, "paths", thr_copies_paths(s->copy, p->n_cords));
  /* one cord on its own changes its colour on the way, as in the overview */
  thr_write_int(next_line(s), "run", p->n_cords == 1 ? THR_COLOUR_PASSES : 0);
  thr_write_array(writer, "palette");
  for (int i = 0; i < THR_COLOURS; i++)
    thr_write_string(writer, NULL, thr_palette(i).hex);
  thr_write_close(writer);
}

static void put_plan(viewer *s)
{
  thr_write_object(&s->out, NULL);
  put_head(s);
  put_nodes(s);
  put_edges(s);
  put_pieces(s);
  if (s->tension) put_scale(s);
  thr_write_array(next_line(s), "cords");
  for (int c = 0; c < s->plan->n_cords; c++)
    put_cord(s, c);
  thr_write_close(&s->out);
  thr_write_close(&s->out);
}

/* Appends JSON as it may stand in a <script>: no "<", which only strings hold; line separators are
 * escaped in them already. */
static void put_in_script(const thr_text *json, thr_text *out)
{
  const char *from = json->data, *end = from + json->length;
  for (const char *at = from; at < end; at++) {
    if (*at != '<') continue;
    thr_text_append_bytes(out, from, (size_t)(at - from));
    thr_text_append(out, "\\u003c");
    from = at + 1;
  }
  thr_text_append_bytes(out, from, (size_t)(end - from));
}

static thr_status prepare(viewer *s, double tolerance, const thr_layout *layout, thr_err *err)
{
  const thr_plan *p = s->plan;
  int n_passes;
  thr_status st = thr_scene_check_cords(p, &n_passes, err);
  if (!st && !p->n_cords) st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");
  s->tension = !st && p->evaluation.present && thr_evaluation_range(&p->evaluation, s->range);
  if (s->tension) st = thr_tension_usable(p, err);
  if (st) return st;
  s->copy = thr_calloc((size_t)p->n_cords, sizeof *s->copy);
  thr_part *part = thr_calloc(2 * (size_t)p->n_cords, sizeof *part);
  st = s->copy && part ? thr_guide_make(&s->guide, s->f, layout, err) : thr_nomem(err);
  if (!st) st = thr_copies_find(p, s->copy, err);
  if (!st) st = thr_pieces_make(&s->pieces, p, tolerance, err);
  if (!st) {
    int parts = thr_pieces_parts(p, s->copy, s->needles, part);
    st = thr_pieces_follow(&s->pieces, part, parts, &s->visit, &s->n_visits, err);
  }
  free(part);
  return st;
}

thr_status thr_viewer_html(const thr_plan *p, const char *const *motion, double tolerance,
                           int needles, const thr_layout *layout, thr_text *html, thr_err *err)
{
  thr_text json = {0}, page = {0};
  viewer s = {.plan = p,
              .f = &p->frame,
              .motion = motion,
              .needles = needles,
              .out = {.out = &json, .compact = true}};
  const char *mark = strstr(thr_viewer_page, THR_VIEWER_MARK);
  assert(mark);
  thr_status st = prepare(&s, tolerance, layout, err);
  if (st) goto done;
  put_plan(&s);
  thr_text_append_bytes(&page, thr_viewer_page, (size_t)(mark - thr_viewer_page));
  if (!json.failed) put_in_script(&json, &page);
  thr_text_append(&page, mark + strlen(THR_VIEWER_MARK));
  if (!json.failed && !page.failed) thr_text_append_bytes(html, page.data, page.length);
  if (json.failed || page.failed || html->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&json);
  thr_text_destroy(&page);
  thr_guide_destroy(&s.guide);
  thr_pieces_destroy(&s.pieces);
  free(s.visit);
  free(s.copy);
  return st;
}
