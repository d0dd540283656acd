/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the viewer: the framework in space with the cords step by step, as one HTML file that
 * needs no network.
 *
 * The page is built from viewer/ (`make viewer`) and lies built in diagram/export/viewer_page.html,
 * which viewer_page.S makes a part of the program. This file writes the plan as JSON and puts it in
 * place of the page's mark. The page computes no words: names of places, what is done at every
 * visit, and colours come from here, and so agree with the other documents.
 *
 * Example of the JSON: {"format":"thread-viewer","version":1, .. "nodes":[[0,0,0],[1,0,0], ..],
 * "edges":[[0,1], ..], "cords":[{"id":"A", .. "half":[0,2,5], ..}]} */
#include "diagram/export/paper.h"

#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "graph/io/json.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_measures.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  TICKS = 4, /* on the scale of tensions, about */
  RAMP = 24  /* steps of the scale's colours */
};

/* What the page is made from. Plan, frame and motion are borrowed. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *frame;
  const char *const *motion;     /* as in thr_overview_options */
  const thr_text *kit;           /* JSON of the pieces' meshes, or NULL */
  const thr_viewer_moves *moves; /* NULL: cords are threaded */
  thr_guide guide;
  thr_copy *copy;  /* [n_cords] which cord repeats which */
  bool tension;    /* does the plan say a tension of any cord? */
  double range[2]; /* N: least and largest tension */
  int needles;     /* as in thr_cord_folded */
  thr_pieces pieces;
  thr_visit *visit; /* [n_visits] in the order of threading */
  int n_visits;
  thr_writer out;
} plan_viewer;

/* ---- the framework ---- */

/* Appends a point as [x, y, z], with so many digits. */
static void put_point(thr_writer *writer, int digits, const double at[3])
{
  thr_write_array(writer, NULL);

  for (int i = 0; i < 3; i++)
    thr_write_printf(writer, NULL, "%.*g", digits, at[i]);
  thr_write_close(writer);
}

/* Begins a line for the next member of the whole. Returns the writer. */
static thr_writer *next_line(plan_viewer *viewer)
{
  thr_write_line(&viewer->out, 0);
  return &viewer->out;
}

/* Appends everything about nodes: coordinates, normals, names, places in words, feet. */
static void put_nodes(plan_viewer *viewer)
{
  const thr_frame *frame = viewer->frame;
  thr_writer *writer = &viewer->out;

  /* Seven digits are as exact as the page draws. */
  thr_write_array(next_line(viewer), "nodes");
  for (int v = 0; v < frame->n_nodes; v++)
    put_point(writer, 7, frame->xyz[v]);
  thr_write_close(writer);

  /* Directions need fewer; 0 0 0 where none is known. */
  thr_write_array(next_line(viewer), "outward");
  for (int v = 0; v < frame->n_nodes; v++)
    put_point(writer, 3, viewer->guide.outward[v]);
  thr_write_close(writer);

  /* "A1", as in the overview, and in words: "foot A1 (node 17)". */
  thr_write_array(next_line(viewer), "labels");
  for (int v = 0; v < frame->n_nodes; v++)
    thr_write_string(writer, NULL, viewer->guide.label[v]);
  thr_write_close(writer);

  thr_write_array(next_line(viewer), "places");
  for (int v = 0; v < frame->n_nodes; v++) {
    thr_text place = {0};

    thr_guide_place(&viewer->guide, v, &place);
    thr_write_words(writer, NULL, &place);
  }
  thr_write_close(writer);

  /* Numbers of the nodes that stand on the ground. */
  thr_write_array(next_line(viewer), "feet");
  for (int v = 0; v < frame->n_nodes; v++)
    if (frame->foot && frame->foot[v]) thr_write_int(writer, NULL, v);

  thr_write_close(writer);
}

/* Appends the ends of all edges, and their lengths in units. */
static void put_edges(plan_viewer *viewer)
{
  const thr_frame *frame = viewer->frame;

  /* By number, as half-edge 2 e and 2 e + 1 belong to edge e. */
  thr_write_array(next_line(viewer), "edges");
  for (int e = 0; e < frame->n_edges; e++)
    thr_write_ints(&viewer->out, NULL, frame->edge[e], 2);
  thr_write_close(&viewer->out);

  /* Lengths may differ from the distance between both ends. */
  thr_write_array(next_line(viewer), "lengths");
  for (int e = 0; e < frame->n_edges; e++)
    thr_write_printf(&viewer->out, NULL, "%.7g", frame->length[e]);
  thr_write_close(&viewer->out);
}

/* Appends name and kind of every piece that a hand picks up. */
static void put_pieces(plan_viewer *viewer)
{
  char kind[24];

  /* Names as in beads.csv. */
  thr_write_array(next_line(viewer), "pieces");
  for (int i = 0; i < viewer->pieces.n; i++) {
    thr_text name = {0};
    thr_pieces_name(&viewer->pieces, (const char(*)[THR_LABEL])viewer->guide.label, i, &name);
    thr_write_words(&viewer->out, NULL, &name);
  }
  thr_write_close(&viewer->out);

  /* Kinds in the same order. */
  thr_write_array(next_line(viewer), "kinds");
  for (int i = 0; i < viewer->pieces.n; i++) {
    thr_pieces_kind_name(&viewer->pieces, viewer->pieces.kind[i], kind);
    thr_write_string(&viewer->out, NULL, kind);
  }
  thr_write_close(&viewer->out);
}

/* ---- the cords ---- */

/* Appends how a cord is pulled, and its tension in every pass, N and as a colour. */
static void put_tension(plan_viewer *viewer, const thr_eval_cord *cord)
{
  thr_writer *writer = &viewer->out;
  char text[32], words[64], hex[8];
  thr_svg_force(cord->force, text);

  /* Which end is pulled, and how hard. */
  if (cord->pull == THR_PULL_NONE)
    snprintf(words, sizeof words, "not pulled");
  else
    snprintf(words, sizeof words, "pull at %s: %s",
             cord->pull == THR_PULL_BOTH ? "both ends" : thr_pull_name(cord->pull), text);

  thr_write_line(writer, 1);
  thr_write_string(writer, "pull", words);

  /* Numbers to show, and the colours for the whole scale. */
  thr_write_array(writer, "tension");
  for (int k = 0; k < cord->n_passes; k++)
    thr_write_printf(writer, NULL, "%.4g", cord->tension[k]);
  thr_write_close(writer);

  thr_write_array(writer, "taut");
  for (int k = 0; k < cord->n_passes; k++) {
    thr_tension_colour(viewer->range, cord->tension[k], hex);
    thr_write_string(writer, NULL, hex);
  }
  thr_write_close(writer);
}

/* Appends what is done at every visit of cord c, in words; of solid pieces the first one is where
 * the cord starts. */
static void put_visits(plan_viewer *viewer, int c)
{
  int i = 0;

  /* The visits of a cord follow each other, in the order of threading. */
  while (viewer->visit[i].cord != c)
    i++;

  thr_write_line(&viewer->out, 1);
  thr_write_array(&viewer->out, "does");
  for (; i < viewer->n_visits && viewer->visit[i].cord == c; i++) {
    /* The same sentences as in the steps in words. */
    thr_text words = {0};
    thr_pieces_say(&viewer->pieces, (const char(*)[THR_LABEL])viewer->guide.label, viewer->visit, i,
                   NULL, &words);
    thr_write_words(&viewer->out, NULL, &words);
  }

  thr_write_close(&viewer->out);
}

/* Appends cord c: name, colours, which path it repeats and how, its half-edges, what is done at
 * visits. */
static void put_cord(plan_viewer *viewer, int c)
{
  const thr_cord *cord = &viewer->plan->cord[c];
  thr_writer *writer = &viewer->out;
  thr_colour colour = thr_palette(viewer->copy[c].path);
  char words[192] = "";

  if (viewer->copy[c].of != c)
    thr_copies_words(viewer->plan, viewer->copy, c, viewer->motion, words);

  /* The name, and how a copy repeats its path. */
  thr_write_object(next_line(viewer), NULL);
  thr_write_string(writer, "id", cord->id);
  thr_write_bool(writer, "closed", cord->closed);

  /* Copies are drawn pale, in the colour of their path. */
  thr_write_int(writer, "of", viewer->copy[c].of);
  thr_write_int(writer, "path", viewer->copy[c].path);
  thr_write_string(writer, "how", words);
  thr_write_string(writer, "colour", colour.hex);
  thr_write_string(writer, "pale", colour.pale);

  thr_svg_length(thr_cord_length(viewer->frame, cord), viewer->frame->units, words);
  thr_write_string(writer, "length", words);

  /* The exact sequence of half-edges, and the pass at whose start the cord is folded. */
  thr_write_line(writer, 1);
  thr_write_ints(writer, "half", cord->half, cord->n_passes);
  thr_write_int(writer, "fold", thr_cord_fold(viewer->frame, viewer->needles, cord));

  /* Tensions only of cords that were evaluated. */
  put_visits(viewer, c);
  if (viewer->tension && viewer->plan->evaluation.cord[c].known)
    put_tension(viewer, &viewer->plan->evaluation.cord[c]);
  thr_write_close(writer);
}

/* ---- the whole ---- */

/* Appends round tensions for the scale, each as a number and in words with its unit. */
static void put_ticks(plan_viewer *viewer)
{
  thr_writer *writer = &viewer->out;
  double tick[TICKS];
  char text[32];

  int n = thr_svg_ticks(viewer->range[0], viewer->range[1], viewer->range[0] > 0, TICKS, tick);
  thr_write_array(writer, "ticks");
  for (int i = 0; i < n; i++) {
    /* "2.5 N", as force is written everywhere. */
    thr_svg_force(tick[i], text);
    thr_write_array(writer, NULL);
    thr_write_printf(writer, NULL, "%.7g", tick[i]);
    thr_write_string(writer, NULL, text);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

/* Appends the scale of tensions: method, range in N, ticks and colours. */
static void put_scale(plan_viewer *viewer)
{
  thr_writer *writer = &viewer->out;
  char hex[8];
  thr_write_object(next_line(viewer), "scale");

  /* The scale's range and what the tensions were computed by. */
  thr_write_string(writer, "method", thr_tension_method_words(&viewer->plan->evaluation));
  thr_write_printf(writer, "low", "%.7g", viewer->range[0]);
  thr_write_printf(writer, "high", "%.7g", viewer->range[1]);

  put_ticks(viewer);

  /* Colours at equal ratios of tension: the scale is even over the logarithm. */
  thr_write_array(writer, "ramp");
  for (int i = 0; i <= RAMP; i++) {
    double part = (double)i / RAMP;
    thr_tension_colour(viewer->range,
                       viewer->range[0] * pow(viewer->range[1] / viewer->range[0], part), hex);
    thr_write_string(writer, NULL, hex);
  }

  thr_write_close(writer);
  thr_write_close(writer);
}

/* Appends what the page asks for first: format, units, kind of layout, number of paths, palette. */
static void put_head(plan_viewer *viewer)
{
  const thr_plan *plan = viewer->plan;
  thr_writer *writer = &viewer->out;

  /* What the page checks before anything else. */
  thr_write_string(writer, "format", "thread-viewer");
  thr_write_int(writer, "version", 1);
  thr_write_hash(writer, "frame", thr_frame_hash(viewer->frame));

  /* How to speak of the framework. */
  thr_write_string(writer, "units", viewer->frame->units);
  thr_write_string(writer, "seen", thr_layout_words(viewer->guide.layout.kind));
  thr_write_bool(writer, "solid", viewer->pieces.solid);
  thr_write_int(writer, "paths", thr_copies_paths(viewer->copy, plan->n_cords));

  /* One cord on its own changes its colour on the way, as in the overview. */
  thr_write_int(next_line(viewer), "run", plan->n_cords == 1 ? THR_COLOUR_PASSES : 0);
  thr_write_array(writer, "palette");
  for (int i = 0; i < THR_COLOURS; i++)
    thr_write_string(writer, NULL, thr_palette(i).hex);
  thr_write_close(writer);
}

/* Appends a motion: words, the edges that are cord alone, and the coordinates of each frame in one
 * list. */
static void put_moves(plan_viewer *viewer)
{
  const thr_viewer_moves *moves = viewer->moves;
  const int n = viewer->frame->n_nodes;
  thr_writer *writer = &viewer->out;

  thr_write_object(next_line(viewer), "moves");
  thr_write_string(writer, "title", moves->title);
  thr_write_string(writer, "note", moves->note);
  thr_write_array(writer, "cables");
  for (int e = 0; e < viewer->frame->n_edges; e++)
    if (moves->cable && moves->cable[e]) thr_write_int(writer, NULL, e);
  thr_write_close(writer);

  thr_write_array(writer, "frames");
  for (int k = 0; k < moves->n_frames; k++) {
    thr_write_line(writer, 1);
    thr_write_array(writer, NULL);
    for (int i = 0; i < 3 * n; i++)
      thr_write_printf(writer, NULL, "%.7g", moves->at[k * n + i / 3][i % 3]);
    thr_write_close(writer);
  }
  thr_write_close(writer);
  thr_write_close(writer);
}

/* Appends the whole plan as one JSON object. */
static void put_plan(plan_viewer *viewer)
{
  thr_write_object(&viewer->out, NULL);
  put_head(viewer);
  put_nodes(viewer);
  put_edges(viewer);
  put_pieces(viewer);

  /* The pieces themselves, as they are. */
  if (viewer->kit) thr_write_json(next_line(viewer), "kit", viewer->kit);

  if (viewer->moves) put_moves(viewer);

  /* No scale without tensions. */
  if (viewer->tension) put_scale(viewer);

  /* Cords refer to nodes, edges and pieces by number. */
  thr_write_array(next_line(viewer), "cords");
  for (int c = 0; c < viewer->plan->n_cords; c++)
    put_cord(viewer, c);
  thr_write_close(&viewer->out);
  thr_write_close(&viewer->out);
}

/* Appends JSON as it may stand in a <script>: "<" is escaped, so that no name can end the script.
 * Only strings hold "<"; line separators are escaped in them already. */
static void put_in_script(const thr_text *json, thr_text *out)
{
  const char *from = json->data, *end = from + json->length;

  for (const char *at = from; at < end; at++) {
    if (*at != '<') continue;

    /* Copy up to here, then the escape. */
    thr_text_append_bytes(out, from, (size_t)(at - from));
    thr_text_append(out, "\\u003c");
    from = at + 1;
  }

  thr_text_append_bytes(out, from, (size_t)(end - from));
}

/* Makes everything that the page is made from. THR_EINPUT for plans that cannot be shown. */
static thr_status prepare(plan_viewer *viewer, double tolerance, const thr_layout *layout,
                          thr_err *err)
{
  const thr_plan *plan = viewer->plan;
  int n_passes;

  /* Cords must fit the framework, and there must be one. */
  thr_status st = thr_scene_check_cords(plan, &n_passes, err);
  if (!st && !plan->n_cords && !viewer->moves)
    st = thr_fail(err, THR_EINPUT, "the plan has no cord to thread");

  /* Tensions only if there is a range, and if they fit the cords. */
  viewer->tension =
      !st && plan->evaluation.present && thr_evaluation_range(&plan->evaluation, viewer->range);
  if (viewer->tension) st = thr_tension_usable(plan, err);

  if (st) return st;

  /* What every cord repeats, names of places, kinds of pieces. */
  viewer->copy = thr_calloc((size_t)plan->n_cords, sizeof *viewer->copy);
  thr_part *part = thr_calloc(2 * (size_t)plan->n_cords, sizeof *part);

  st = viewer->copy && part ? thr_guide_make(&viewer->guide, viewer->frame, layout, err)
                            : thr_nomem(err);
  if (!st) st = thr_copies_find(plan, viewer->copy, err);
  if (!st) st = thr_pieces_make(&viewer->pieces, plan, tolerance, err);
  if (!st) {
    /* Visits in the order of threading, for the words of every visit. */
    int parts = thr_pieces_parts(plan, viewer->copy, viewer->needles, part);
    st = thr_pieces_follow(&viewer->pieces, part, parts, &viewer->visit, &viewer->n_visits, err);
  }

  free(part);
  return st;
}

/* Appends the page with what the viewer is set to show, and releases the viewer. */
static thr_status make_page(plan_viewer *viewer, double tolerance, const thr_layout *layout,
                            thr_text *html, thr_err *err)
{
  thr_text json = {0}, page = {0};
  viewer->frame = &viewer->plan->frame;
  viewer->out = (thr_writer){.out = &json, .compact = true};

  /* The page was built with the mark in it. */
  const char *mark = strstr(thr_viewer_page, THR_VIEWER_MARK);
  assert(mark);

  thr_status st = prepare(viewer, tolerance, layout, err);
  if (st) goto done;
  put_plan(viewer);

  /* The page up to the mark, the plan, and the rest of the page. */
  thr_text_append_bytes(&page, thr_viewer_page, (size_t)(mark - thr_viewer_page));
  if (!json.failed) put_in_script(&json, &page);
  thr_text_append(&page, mark + strlen(THR_VIEWER_MARK));

  /* html changes only if all went well. */
  if (!json.failed && !page.failed) thr_text_append_bytes(html, page.data, page.length);
  if (json.failed || page.failed || html->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&json);
  thr_text_destroy(&page);
  thr_guide_destroy(&viewer->guide);
  thr_pieces_destroy(&viewer->pieces);
  free(viewer->visit);
  free(viewer->copy);
  return st;
}

thr_status thr_viewer_html(const thr_plan *plan, const char *const *motion, double tolerance,
                           int needles, const thr_layout *layout, const thr_text *kit,
                           thr_text *html, thr_err *err)
{
  plan_viewer viewer = {.plan = plan, .motion = motion, .needles = needles, .kit = kit};
  return make_page(&viewer, tolerance, layout, html, err);
}

thr_status thr_viewer_moves_html(const thr_frame *frame, const thr_viewer_moves *moves,
                                 thr_text *html, thr_err *err)
{
  /* A plan without cords, whose pieces are the edges; the framework stays the caller's. */
  const thr_plan plan = {.frame = *frame, .options.joint = THR_JOINT_TUBE};
  plan_viewer viewer = {.plan = &plan, .moves = moves};
  return make_page(&viewer, 0, NULL, html, err);
}
