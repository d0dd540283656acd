/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says in words for the user what reading a framework merged, dropped or found odd, a line each,
 * and what was assumed where a file left something open. A line says what to do about it, as an
 * option of the program, where something can be done.
 *
 * Example:
 *   3 nodes merged into another within the weld tolerance
 *   the framework is in 2 separate components; each gets its own cord */
#include "lib/lib.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Appends a line "3 nodes dropped" if n is not 0. */
static void put_count(thr_text *out, int n, const char *one, const char *many, const char *what)
{
  if (n) thr_text_printf(out, "%d %s %s\n", n, n == 1 ? one : many, what);
}

/* Appends what reading merged, dropped or left out. */
static void put_report(thr_text *out, const thr_read_report *report)
{
  /* What welding and the rules for edges changed. */
  put_count(out, report->welded_nodes, "node", "nodes",
            "merged into another within the weld tolerance");
  put_count(out, report->zero_length_edges, "edge of zero length", "edges of zero length",
            "dropped");
  put_count(out, report->duplicate_edges, "edge that was there already",
            "edges that were there already", "dropped");
  if (report->parallel_edges)
    thr_text_printf(
        out, "%d of these %s longer than the one that is kept (%s); --parallel keep keeps all\n",
        report->parallel_edges, report->parallel_edges == 1 ? "is" : "are", report->parallel);

  put_count(out, report->isolated_nodes, "node without an edge", "nodes without an edge",
            "dropped");

  /* What the file has and a framework has not. */
  if (report->skipped_records)
    thr_text_printf(out, "%d %s not used (the first is %s)\n", report->skipped_records,
                    report->skipped_records == 1 ? "record" : "records", report->skipped_kind);
  if (report->hidden_edges)
    thr_text_printf(out, "%d %s on %d hidden %s %s left out: --layers all\n", report->hidden_edges,
                    report->hidden_edges == 1 ? "edge" : "edges", report->hidden_layers,
                    report->hidden_layers == 1 ? "layer" : "layers",
                    report->hidden_edges == 1 ? "is" : "are");

  put_count(out, report->unseen_records, "record", "records",
            "on paper or marked invisible left out");
  if (report->missing_blocks)
    thr_text_printf(out, "%d %s of blocks that are not in the file left out (the first is %s)\n",
                    report->missing_blocks,
                    report->missing_blocks == 1 ? "insertion" : "insertions",
                    report->missing_block);

  /* Edges cut at nodes, and columns of a table that say nothing of a framework. */
  put_count(out, report->split_edges, "edge", "edges", "cut where a node lies on it");
  if (report->unused[0]) thr_text_printf(out, "columns that are not used: %s\n", report->unused);

  /* Files may hold several frameworks. */
  const int left = report->frameworks - report->frameworks_read;
  if (report->frameworks_read > 1)
    thr_text_printf(out,
                    "%d frameworks of the file are read as one; --pick N reads the Nth alone\n",
                    report->frameworks_read);
  if (left)
    thr_text_printf(
        out, "%d more %s of the file %s not read; --pick reads another by its name or number\n",
        left, left == 1 ? "part" : "parts", left == 1 ? "is" : "are");
}

/* Appends a line on edges' own lengths that no cord can have, or that are hardly in the unit of the
 * coordinates. */
static void put_lengths(thr_text *out, const thr_frame *frame)
{
  enum { FAR = 10 }; /* times the straight line: not all edges of a framework are such curves */
  int n_short = 0, worst = 0;
  double least = INFINITY;

  /* The edge with the least ratio of its length to the straight line. */
  for (int e = 0; e < frame->n_edges && frame->own_lengths; e++) {
    const double *from = frame->xyz[frame->edge[e][0]], *to = frame->xyz[frame->edge[e][1]];
    const double straight =
        sqrt((from[0] - to[0]) * (from[0] - to[0]) + (from[1] - to[1]) * (from[1] - to[1]) +
             (from[2] - to[2]) * (from[2] - to[2]));
    const double ratio = frame->length[e] / straight;

    /* Rounding in a file makes lengths shorter by less than a thousandth. */
    n_short += ratio < 1 - 1e-3;
    if (!(ratio < least)) continue;
    least = ratio;
    worst = e;
  }

  /* Shorter than straight: the unit is wrong, or the length. All far longer: the unit is wrong. */
  if (n_short)
    thr_text_printf(
        out,
        "%d %s shorter than the straight line, which no cord can be (%s to %s: %.3g of it); are "
        "lengths in the unit of the coordinates?\n",
        n_short, n_short == 1 ? "edge is" : "edges are", frame->name[frame->edge[worst][0]],
        frame->name[frame->edge[worst][1]], least);
  else if (frame->own_lengths && least > FAR)
    thr_text_printf(out,
                    "all edges are more than %d times as long as their nodes are apart; are "
                    "lengths in the unit of the "
                    "coordinates?\n",
                    FAR);
}

/* Appends what a file leaves unsaid and its user should look at: directions, empty coordinates,
 * units. */
static void put_unsaid(thr_text *out, const thr_frame *frame, const thr_read_report *report)
{
  /* mm: hardly anybody threads pieces outside of the first two, and nobody beyond the third. */
  enum { SHORT = 2, LONG = 1000, VAST = 50000 };
  int n_short = 0, n_long = 0, n_vast = 0;
  double mm;

  /* Which way is up. */
  if (report->up_from == THR_FROM_MAKER)
    thr_text_append(out, "made by Blender, which writes y upwards: turned so that y points up "
                         "(--up z leaves it as it is)\n");
  if (report->lies)
    thr_text_append(out, "z is taken to point up, and only a line of nodes is lowest; if y points "
                         "up in this file: --up y\n");

  /* Coordinates that are not there, or may be misread. */
  put_count(out, report->empty_z, "z is", "z are", "empty where others are not: taken as 0");
  if (report->thousands[0])
    thr_text_printf(out, "%s was read as %g; if the dot parts thousands, take it out\n",
                    report->thousands, strtod(report->thousands, NULL));
  if (report->no_z)
    thr_text_append(out, "no node has a z: the framework is taken to be flat, z = 0\n");

  if (report->units_of_file[0])
    thr_text_printf(out, "the file says that its unit is %s; --units %s is taken instead\n",
                    report->units_of_file, frame->units);

  /* Pieces that are hardly ever made: the unit may be another one. Of a unit of unknown length none
   * are vast. */
  if (thr_units_in_mm(frame->units, &mm, NULL)) mm = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    n_short += frame->length[e] < SHORT;
    n_long += frame->length[e] > LONG;
    n_vast += frame->length[e] * mm > VAST;
  }

  if (report->units_from == THR_FROM_NOBODY &&
      (n_short > frame->n_edges / 2 || n_long > frame->n_edges / 2))
    thr_text_printf(out,
                    "the file names no unit, and most of its edges are %s than %d mm; --units m "
                    "says what they are, "
                    "--scale 1000 makes them others\n",
                    n_short > n_long ? "shorter" : "longer", n_short > n_long ? SHORT : LONG);
  else if (mm > 1 && n_vast > frame->n_edges / 2)
    thr_text_printf(out,
                    "most edges are longer than %d m; if the numbers are millimetres: --units mm\n",
                    VAST / 1000);
}

/* Appends a line on nodes that are nearly one, and what welding them would come to. */
static void put_close(thr_text *out, const thr_frame *frame, const thr_near *near)
{
  /* The nearest pair, and the tolerance that merges it. */
  thr_text_printf(out, "%d %s of nodes nearly one (%s and %s: %.3g apart): --weld %g merges %d %s",
                  near->n_close, near->n_close == 1 ? "pair" : "pairs",
                  frame->name[near->closest[0]], frame->name[near->closest[1]], near->gap,
                  near->weld, near->n_welded, near->n_welded == 1 ? "node" : "nodes");

  /* What else would change: edges, components, edges of no length. */
  if (near->n_merged)
    thr_text_printf(out, " and %d %s", near->n_merged, near->n_merged == 1 ? "edge" : "edges");
  if (near->components_welded < near->components)
    thr_text_printf(out, ", %d %s instead of %d", near->components_welded,
                    near->components_welded == 1 ? "component" : "components", near->components);
  if (near->n_lost)
    thr_text_printf(out, ", but drops %d %s", near->n_lost, near->n_lost == 1 ? "edge" : "edges");
  thr_text_append(out, "\n");
}

/* Appends what the drawing nearly says (nodes that nearly meet an edge or each other, edges that
 * cross), and into how many components it falls, which are planned one by one. */
static thr_status put_near(thr_text *out, const thr_frame *frame, thr_err *err)
{
  thr_near near;
  thr_status st = thr_frame_near(frame, &near, err);
  if (st) return st;

  /* The first of each kind is named. */
  const int *on = frame->edge[near.on_edge[1]], *one = frame->edge[near.crossing[0]],
            *other = frame->edge[near.crossing[1]];
  if (near.components > 1)
    thr_text_printf(out, "the framework is in %d separate components; each gets its own cord\n",
                    near.components);

  if (near.n_close) put_close(out, frame, &near);
  if (near.n_on_edge)
    thr_text_printf(
        out, "%d %s on an edge that does not end there (%s on %s to %s): --split cuts such edges\n",
        near.n_on_edge, near.n_on_edge == 1 ? "node lies" : "nodes lie",
        frame->name[near.on_edge[0]], frame->name[on[0]], frame->name[on[1]]);

  /* Crossings are legal, and a mistake in many drawings. */
  if (near.n_crossings)
    thr_text_printf(out,
                    "%d %s of edges cross without a node (%s to %s and %s to %s); no cord turns "
                    "from one into the other there\n",
                    near.n_crossings, near.n_crossings == 1 ? "pair" : "pairs", frame->name[one[0]],
                    frame->name[one[1]], frame->name[other[0]], frame->name[other[1]]);
  if (near.tangled)
    thr_text_append(
        out,
        "too many edges pass close to each other to look at all places where they nearly meet\n");

  return THR_OK;
}

/* Appends all notes; see notes.h. */
thr_status thr_read_notes(const thr_frame *frame, const thr_read_report *report, thr_text *out,
                          thr_err *err)
{
  put_report(out, report);
  put_unsaid(out, frame, report);
  put_lengths(out, frame);

  /* An append that failed for lack of memory is only visible in the text. */
  thr_status st = put_near(out, frame, err);

  return !st && out->failed ? thr_nomem(err) : st;
}

/* Returns the name of an origin; see notes.h. */
const char *thr_whence_name(thr_whence from)
{
  static const char *const names[] = {"assumed", "maker", "file", "option"};
  return names[from];
}

/* Returns a row without a value. */
static thr_assumption assume(const char *what, thr_whence from, const char *why)
{
  thr_assumption assumption = {.what = what, .number = NAN, .from = from};
  snprintf(assumption.why, sizeof assumption.why, "%s", why);
  return assumption;
}

/* Lists what was assumed; see notes.h. */
int thr_read_assumptions(const thr_read_options *options, const thr_frame *frame,
                         const thr_read_report *report, thr_assumption row[THR_ASSUMPTIONS])
{
  int n = 0;

  /* Format, unit, and which way is up, always. */
  row[n] = assume("format", THR_FROM_FILE, "");
  snprintf(row[n++].value, sizeof row->value, "%s", report->format);
  row[n] =
      assume("unit", report->units_from, report->units_from ? "" : "the file names none; --units");
  snprintf(row[n++].value, sizeof row->value, "%s", frame->units);
  row[n] = assume("up", report->up_from,
                  report->up_from == THR_FROM_NOBODY  ? "the file does not say; --up y"
                  : report->up_from == THR_FROM_MAKER ? "Blender writes y upwards; --up z"
                                                      : "");
  snprintf(row[n++].value, sizeof row->value, "%s", report->y_up ? "y" : "z");

  /* Scale and weld tolerance, always; their values are numbers. */
  row[n] = assume("scale", options->scale == 1 ? THR_FROM_NOBODY : THR_FROM_USER,
                  options->scale == 1 ? "the numbers as they are; --scale" : "");
  row[n++].number = options->scale;
  row[n] = assume("weld", options->weld < 0 ? THR_FROM_NOBODY : THR_FROM_USER, "");
  row[n].number = report->weld_tolerance;

  /* How many nodes were welded, in the same row. */
  char welded[12] = "no";
  if (report->welded_nodes) snprintf(welded, sizeof welded, "%d", report->welded_nodes);
  snprintf(row[n].why, sizeof row->why, "%s %s so close to another%s", welded,
           report->welded_nodes > 1 ? "nodes were" : "node was",
           options->weld < 0 ? "; --weld" : "");
  n++;

  /* Hidden layers, several frameworks and parallel edges, where there are any. */
  if (report->hidden_layers || options->all_layers) {
    row[n] = assume("layers", options->all_layers ? THR_FROM_USER : THR_FROM_FILE, "");
    snprintf(row[n].value, sizeof row->value, "%s", options->all_layers ? "all" : "shown");
    if (!options->all_layers)
      snprintf(row[n].why, sizeof row->why, "%d %s on %d hidden left out; --layers all",
               report->hidden_edges, report->hidden_edges == 1 ? "edge" : "edges",
               report->hidden_layers);
    n++;
  }

  if (report->frameworks > 1) {
    row[n] = assume("parts", options->pick ? THR_FROM_USER : THR_FROM_NOBODY,
                    options->pick ? "" : "--pick NAME or N");
    snprintf(row[n++].value, sizeof row->value, "%d of %d", report->frameworks_read,
             report->frameworks);
  }

  if (report->parallel_edges || options->parallel) {
    row[n] = assume("parallel", options->parallel ? THR_FROM_USER : THR_FROM_NOBODY, "");
    snprintf(row[n].value, sizeof row->value, "%s", options->parallel ? "keep" : "shortest");
    if (!options->parallel)
      snprintf(row[n].why, sizeof row->why, "%d longer %s left out; --parallel keep",
               report->parallel_edges, report->parallel_edges == 1 ? "edge" : "edges");
    n++;
  }

  /* Numbers become text at last. */
  for (int i = 0; i < n; i++)
    if (!isnan(row[i].number)) snprintf(row[i].value, sizeof row->value, "%.3g", row[i].number);

  return n;
}
