/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what `thread info` found out about a framework: counts, lengths, whether it moves as a
 * framework of bars, which joints the cords of a plan do not tie, and what the reader assumed. */
#include "cli/print/print.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>

enum { MOST_NAMES = 20 };

/* Appends whether the framework of bars moves, in space, within its plane if it is flat, and with
 * its feet held. */
static void put_motions(thr_text *text, const frame_facts *info)
{
  const thr_rigidity *rigidity = &info->rigidity;

  /* A rigid framework with more edges than it needs is stressed by its own lengths. */
  if (rigidity->motions == 0)
    thr_text_printf(text, "hinged      rigid, %d %s more than it needs", rigidity->self_stresses,
                    rigidity->self_stresses == 1 ? "edge" : "edges");
  else
    thr_text_printf(text, "hinged      %d %s to move without stretching an edge", rigidity->motions,
                    rigidity->motions == 1 ? "way" : "ways");

  /* A flat framework moves out of its plane at least; what counts are motions within it. */
  if (rigidity->flat) thr_text_printf(text, "; %d within its plane", rigidity->plane_motions);
  if (info->feet) thr_text_printf(text, "; %d with its feet held", rigidity->pinned);
  thr_text_printf(text, "%s\n", rigidity->unclear ? " (a close call: rounding decides)" : "");
}

/* Appends rigidity, untied joints (at most 20 by name) and crossings. */
static void put_rigidity(thr_text *text, const thr_frame *frame, const frame_facts *info)
{
  if (info->analysed)
    put_motions(text, info);
  else
    thr_text_append(text, "hinged      not worked out for so many edges\n");
  if (info->motions) motions_put(text, info->motions);
  if (!info->planned) return;

  /* Of a plan. */
  thr_text_printf(text, "untied      %d of %d joints", info->n_untied, frame->n_nodes);

  /* Names tell where to look, a number how much is loose. */
  int shown = 0;
  for (int v = 0; v < frame->n_nodes && shown < MOST_NAMES; v++)
    if (info->untied[v]) thr_text_printf(text, "%s%s", shown++ ? " " : ": ", frame->name[v]);
  thr_text_append(text, shown < info->n_untied ? " ..\n" : "\n");

  if (info->channels)
    thr_text_printf(text, "crossings   %" PRId64 " of two channels, inside %d of %d pieces\n",
                    info->crossings, info->crossed, frame->n_nodes);
  thr_text_append(text, "kit         ");
  kit_put(text, &info->kit);
}

/* Appends the range of covers or capacities of edges; 0 = none. */
static void put_range(thr_text *text, const char *what, const int *value, int n)
{
  int low = INT_MAX, high = 0;
  for (int e = 0; e < n; e++) {
    low = value[e] > 0 && value[e] < low ? value[e] : low;
    high = value[e] > high ? value[e] : high;
  }
  thr_text_printf(text, "%-12s%d to %d passes an edge, given by the file\n", what, low, high);
}

/* Returns where a property of the framework comes from. */
static const char *origin_words(thr_whence from)
{
  static const char *const words[] = {"assumed", "of the file's maker", "of the file",
                                      "as asked for"};
  return words[from];
}

void facts_put(thr_text *text, const thr_frame *frame, const frame_facts *info)
{
  thr_text_printf(text, "nodes       %d, a piece each with solid joints\n", frame->n_nodes);
  thr_text_printf(text, "edges       %d, interfaces of two pieces; with --joint tube a tube each\n",
                  frame->n_edges);

  thr_text_append(text, "degrees    ");
  for (int d = 0; d <= FACTS_DEGREES; d++)
    if (info->degree[d])
      thr_text_printf(text, " %d x %d%s", info->degree[d], d, d == FACTS_DEGREES ? " or more" : "");

  thr_text_printf(text, "\nodd nodes   %d%s\n", info->odd,
                  info->odd ? "" : " (one closed cord needs no overlap)");
  thr_text_printf(text, "components  %d\nbridges     %d%s\nfeet        %d\n", info->components,
                  info->bridges, info->bridges ? " (a closed cord passes each twice)" : "",
                  info->feet);

  /* Lengths and what the framework says of single edges. */
  thr_text_printf(text, "length      %.6f %s in all, edges from %.6g to %.6g%s\n",
                  thr_frame_total_length(frame), frame->units, info->shortest, info->longest,
                  frame->own_lengths ? " (given by the file)" : "");

  /* What the file says of single edges. */
  if (frame->cover) put_range(text, "covers", frame->cover, frame->n_edges);
  if (frame->capacity) put_range(text, "capacities", frame->capacity, frame->n_edges);
  thr_text_printf(text, "size        %.6g %s (diagonal of the bounding box)\n",
                  thr_frame_diagonal(frame), frame->units);

  put_rigidity(text, frame, info);
  thr_text_printf(text, "hash        %016" PRIx64 "\n\nread as\n", thr_frame_hash(frame));

  /* What the reader assumed, and why. */
  for (int i = 0; i < info->n_assumptions; i++) {
    const thr_assumption *row = &info->assumption[i];
    thr_text_printf(text, "%-11s %-11s %s%s%s\n", row->what, row->value, origin_words(row->from),
                    *row->why ? ": " : "", row->why);
  }
}

/* Writes the analysis of rigidity. */
static void put_rigidity_json(thr_writer *writer, const frame_facts *info)
{
  const thr_rigidity *rigidity = &info->rigidity;

  thr_write_object(writer, "rigidity");
  thr_write_int(writer, "rank", rigidity->rank);
  thr_write_int(writer, "rigid_motions", rigidity->rigid_motions);
  thr_write_int(writer, "motions", rigidity->motions);
  thr_write_int(writer, "self_stresses", rigidity->self_stresses);

  /* Null where the framework is not flat or has no feet. */
  thr_write_number(writer, "motions_within_plane",
                   rigidity->flat ? (double)rigidity->plane_motions : NAN);
  thr_write_number(writer, "motions_with_feet_held",
                   info->feet > 0 ? (double)rigidity->pinned : NAN);
  thr_write_bool(writer, "unclear", rigidity->unclear);
  thr_write_close(writer);
}

/* Writes the names of the joints that the cords of the plan do not tie. */
static void put_untied_json(thr_writer *writer, const thr_frame *frame, const frame_facts *info)
{
  thr_write_array(writer, "untied");
  for (int v = 0; v < frame->n_nodes; v++)
    if (info->untied[v]) thr_write_string(writer, NULL, frame->name[v]);
  thr_write_close(writer);
}

/* Writes the number of nodes of each degree; the last one counts all higher degrees, too. */
static void put_degrees_json(thr_writer *writer, const frame_facts *info)
{
  thr_write_object(writer, "degrees");
  for (int d = 0; d <= FACTS_DEGREES; d++) {
    char degree[16];
    snprintf(degree, sizeof degree, "%d", d);
    if (info->degree[d]) thr_write_int(writer, degree, info->degree[d]);
  }
  thr_write_close(writer);
}

void facts_put_json(thr_text *text, const thr_frame *frame, const frame_facts *info)
{
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);
  thr_write_int(&writer, "nodes", frame->n_nodes);
  thr_write_int(&writer, "edges", frame->n_edges);

  /* Counts. */
  put_degrees_json(&writer, info);
  thr_write_int(&writer, "odd_nodes", info->odd);
  thr_write_int(&writer, "components", info->components);
  thr_write_int(&writer, "bridges", info->bridges);
  thr_write_int(&writer, "feet", info->feet);

  /* Lengths in units of the framework. */
  thr_write_string(&writer, "units", frame->units);

  thr_write_number(&writer, "length", thr_frame_total_length(frame));
  thr_write_number(&writer, "shortest_edge", info->shortest);
  thr_write_number(&writer, "longest_edge", info->longest);
  thr_write_number(&writer, "diagonal", thr_frame_diagonal(frame));

  /* What was analysed. */
  if (info->analysed) put_rigidity_json(&writer, info);
  if (info->motions) motions_put_json(&writer, info->motions);
  if (info->planned) put_untied_json(&writer, frame, info);
  if (info->channels) {
    thr_write_int(&writer, "crossings", info->crossings);
    thr_write_int(&writer, "crossed_pieces", info->crossed);
  }
  if (info->planned) kit_put_json(&writer, &info->kit);

  /* What the file was read as. */
  thr_write_hash(&writer, "hash", thr_frame_hash(frame));
  thr_write_object(&writer, "read_as");
  for (int i = 0; i < info->n_assumptions; i++) {
    const thr_assumption *row = &info->assumption[i];
    thr_write_object(&writer, row->what);
    if (isnan(row->number))
      thr_write_string(&writer, "value", row->value);
    else
      thr_write_number(&writer, "value", row->number);
    thr_write_string(&writer, "from", thr_whence_name(row->from));
    if (*row->why) thr_write_string(&writer, "why", row->why);

    thr_write_close(&writer);
  }
  thr_write_close(&writer);
  answer_put_files(&writer);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}
