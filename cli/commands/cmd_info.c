/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread info: what a framework is made of. */
#include "cli/cli.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lib/notes.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread info FRAME [options]: nodes, edges, odd nodes, components, feet, rigidity\n\n"
    "Examples:\n"
    "  thread info dome.obj --feet lowest\n"
    "  thread info nodes.csv --edges edges.csv --json\n"
    "  thread info plan.json                         the framework inside a plan, the joints that "
    "its cords do not tie, and\n"
    "                                                the channels that cross inside a piece\n\n"
    "The line `hinged` takes every node for a ball joint: can nodes move without an edge getting "
    "longer?\n"
    "What can move must be held by joints that lock. A joint is tied if the cord alone holds its "
    "edges\n"
    "together (--joint tube); joints of solid beads need not be.\n";

enum { MOST_DEGREES = 64, MOST_NAMES = 20, MOST_BARS = 50000 };

typedef struct {
  int degree[MOST_DEGREES + 1]; /* nodes of each degree; the last counts all higher ones too */
  int odd, components, bridges, feet;
  double shortest, longest;
  bool analysed;
  thr_rigidity rigidity;
  bool planned; /* the framework came in a plan */
  int n_untied;
  bool *untied;      /* [n_nodes] planned: owned */
  bool channels;     /* planned with solid joints: they run through pieces */
  int64_t crossings; /* of two channels in a piece */
  int crossed;       /* pieces with one */
  int n_assumptions;
  thr_assumption assumption[THR_ASSUMPTIONS];
} facts;

/* Is the rank of the rigidity matrix worked out within a second or so? It is sparse unless edges
 * are many for their nodes. */
static bool can_analyse(const thr_frame *frame)
{
  const double most_work = 2e9, columns = 3.0 * frame->n_nodes;
  return frame->n_edges <= MOST_BARS &&
         (frame->n_edges <= 20 * frame->n_nodes || frame->n_edges * columns * columns <= most_work);
}

static thr_status find_facts(const thr_frame *frame, facts *a, thr_err *err)
{
  a->shortest = frame->length[0];
  int *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  bool *bridge = thr_calloc((size_t)frame->n_edges, sizeof *bridge);
  thr_status st = component && bridge ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, component, &a->components, err);
  if (!st) st = thr_frame_bridges(frame, bridge, err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int d = thr_degree(frame, v);
    a->degree[d < MOST_DEGREES ? d : MOST_DEGREES]++;
    a->odd += d % 2;
    a->feet += frame->foot[v];
  }
  for (int e = 0; e < frame->n_edges && !st; e++) {
    a->bridges += bridge[e];
    if (frame->length[e] < a->shortest) a->shortest = frame->length[e];
    if (frame->length[e] > a->longest) a->longest = frame->length[e];
  }
  free(component);
  free(bridge);
  a->analysed = can_analyse(frame);
  return st || !a->analysed ? st : thr_rigidity_find(frame, &a->rigidity, err);
}

static thr_status count_crossings(const thr_plan *plan, facts *a, thr_err *err)
{
  thr_channels channels;
  thr_status st = thr_channels_make(&channels, plan, err);
  if (st) return st;
  a->channels = true;
  a->crossings = channels.crossings;
  a->crossed = channels.crossed;
  thr_channels_destroy(&channels);
  return THR_OK;
}

/* Joints that the cords of a plan do not tie, and channels that cross; nothing if the file is no
 * valid plan. stdin has been read already. */
static thr_status find_untied(const char *path, facts *a, thr_err *err)
{
  thr_plan plan;
  thr_err not_a_plan = {0};
  if (strcmp(path, "-") == 0) return THR_OK;
  thr_status st = thr_plan_read(&plan, path, &not_a_plan);
  if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
  if (!(a->untied = thr_calloc((size_t)plan.frame.n_nodes, sizeof *a->untied))) st = thr_nomem(err);
  if (!st)
    st = thr_junction_tied(&plan.frame, plan.cord, plan.n_cords,
                           plan.options.ends == THR_ENDS_CLOSED, a->untied, err);
  for (int v = 0; v < plan.frame.n_nodes && !st; v++)
    a->n_untied += a->untied[v] = !a->untied[v];
  a->planned = !st;
  if (!st && plan.options.joint == THR_JOINT_SOLID) st = count_crossings(&plan, a, err);
  thr_plan_destroy(&plan);
  return st;
}

static void put_motions(thr_text *text, const facts *a)
{
  const thr_rigidity *r = &a->rigidity;
  if (r->motions == 0)
    thr_text_printf(text, "hinged      rigid, %d %s more than it needs", r->self_stresses,
                    r->self_stresses == 1 ? "edge" : "edges");
  else
    thr_text_printf(text, "hinged      %d %s to move without stretching an edge", r->motions,
                    r->motions == 1 ? "way" : "ways");
  if (r->flat) thr_text_printf(text, "; %d within its plane", r->plane_motions);
  if (a->feet) thr_text_printf(text, "; %d with its feet held", r->pinned);
  thr_text_printf(text, "%s\n", r->unclear ? " (a close call: rounding decides)" : "");
}

static void put_rigidity(thr_text *text, const thr_frame *frame, const facts *a)
{
  if (a->analysed)
    put_motions(text, a);
  else
    thr_text_append(text, "hinged      not worked out for so many edges\n");
  if (!a->planned) return;
  thr_text_printf(text, "untied      %d of %d joints", a->n_untied, frame->n_nodes);
  int shown = 0;
  for (int v = 0; v < frame->n_nodes && shown < MOST_NAMES; v++)
    if (a->untied[v]) thr_text_printf(text, "%s%s", shown++ ? " " : ": ", frame->name[v]);
  thr_text_append(text, shown < a->n_untied ? " ..\n" : "\n");
  if (a->channels)
    thr_text_printf(text, "crossings   %" PRId64 " of two channels, inside %d of %d pieces\n",
                    a->crossings, a->crossed, frame->n_nodes);
}

/* Covers or capacities; 0 = none. */
static void put_range(thr_text *text, const char *what, const int *value, int n)
{
  int low = INT_MAX, high = 0;
  for (int e = 0; e < n; e++) {
    low = value[e] > 0 && value[e] < low ? value[e] : low;
    high = value[e] > high ? value[e] : high;
  }
  thr_text_printf(text, "%-12s%d to %d passes an edge, given by the file\n", what, low, high);
}

static const char *from_words(thr_whence from)
{
  static const char *const words[] = {"assumed", "of the file's maker", "of the file",
                                      "as asked for"};
  return words[from];
}

static void put_text(thr_text *text, const thr_frame *frame, const facts *a)
{
  thr_text_printf(text, "nodes       %d, a piece each with solid joints\n", frame->n_nodes);
  thr_text_printf(text, "edges       %d, interfaces of two pieces; with --joint tube a tube each\n",
                  frame->n_edges);
  thr_text_append(text, "degrees    ");
  for (int d = 0; d <= MOST_DEGREES; d++)
    if (a->degree[d])
      thr_text_printf(text, " %d x %d%s", a->degree[d], d, d == MOST_DEGREES ? " or more" : "");
  thr_text_printf(text, "\nodd nodes   %d%s\n", a->odd,
                  a->odd ? "" : " (one closed cord needs no overlap)");
  thr_text_printf(text, "components  %d\nbridges     %d%s\nfeet        %d\n", a->components,
                  a->bridges, a->bridges ? " (a closed cord passes each twice)" : "", a->feet);
  thr_text_printf(text, "length      %.6f %s in all, edges from %.6g to %.6g%s\n",
                  thr_frame_total_length(frame), frame->units, a->shortest, a->longest,
                  frame->own_lengths ? " (given by the file)" : "");
  if (frame->cover) put_range(text, "covers", frame->cover, frame->n_edges);
  if (frame->capacity) put_range(text, "capacities", frame->capacity, frame->n_edges);
  thr_text_printf(text, "size        %.6g %s (diagonal of the bounding box)\n",
                  thr_frame_diagonal(frame), frame->units);
  put_rigidity(text, frame, a);
  thr_text_printf(text, "hash        %016" PRIx64 "\n\nread as\n", thr_frame_hash(frame));
  for (int i = 0; i < a->n_assumptions; i++) {
    const thr_assumption *row = &a->assumption[i];
    thr_text_printf(text, "%-11s %-11s %s%s%s\n", row->what, row->value, from_words(row->from),
                    *row->why ? ": " : "", row->why);
  }
}

static void put_rigidity_json(thr_writer *writer, const facts *a)
{
  const thr_rigidity *r = &a->rigidity;
  thr_write_object(writer, "rigidity");
  thr_write_int(writer, "rank", r->rank);
  thr_write_int(writer, "rigid_motions", r->rigid_motions);
  thr_write_int(writer, "motions", r->motions);
  thr_write_int(writer, "self_stresses", r->self_stresses);
  thr_write_number(writer, "motions_within_plane", r->flat ? (double)r->plane_motions : NAN);
  thr_write_number(writer, "motions_with_feet_held", a->feet > 0 ? (double)r->pinned : NAN);
  thr_write_bool(writer, "unclear", r->unclear);
  thr_write_close(writer);
}

static void put_untied_json(thr_writer *writer, const thr_frame *frame, const facts *a)
{
  thr_write_array(writer, "untied");
  for (int v = 0; v < frame->n_nodes; v++)
    if (a->untied[v]) thr_write_string(writer, NULL, frame->name[v]);
  thr_write_close(writer);
}

static void put_degrees_json(thr_writer *writer, const facts *a)
{
  thr_write_object(writer, "degrees");
  for (int d = 0; d <= MOST_DEGREES; d++) {
    char degree[16];
    snprintf(degree, sizeof degree, "%d", d);
    if (a->degree[d]) thr_write_int(writer, degree, a->degree[d]);
  }
  thr_write_close(writer);
}

static void put_json(thr_text *text, const thr_frame *frame, const facts *a)
{
  thr_writer writer = {.out = text};
  thr_write_object(&writer, NULL);
  thr_write_int(&writer, "nodes", frame->n_nodes);
  thr_write_int(&writer, "edges", frame->n_edges);
  put_degrees_json(&writer, a);
  thr_write_int(&writer, "odd_nodes", a->odd);
  thr_write_int(&writer, "components", a->components);
  thr_write_int(&writer, "bridges", a->bridges);
  thr_write_int(&writer, "feet", a->feet);
  thr_write_string(&writer, "units", frame->units);
  thr_write_number(&writer, "length", thr_frame_total_length(frame));
  thr_write_number(&writer, "shortest_edge", a->shortest);
  thr_write_number(&writer, "longest_edge", a->longest);
  thr_write_number(&writer, "diagonal", thr_frame_diagonal(frame));
  if (a->analysed) put_rigidity_json(&writer, a);
  if (a->planned) put_untied_json(&writer, frame, a);
  if (a->channels) {
    thr_write_int(&writer, "crossings", a->crossings);
    thr_write_int(&writer, "crossed_pieces", a->crossed);
  }
  thr_write_hash(&writer, "hash", thr_frame_hash(frame));
  thr_write_object(&writer, "read_as");
  for (int i = 0; i < a->n_assumptions; i++) {
    const thr_assumption *row = &a->assumption[i];
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
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

static int tell(const char *path, const cli_frame_args *args, bool json)
{
  thr_frame frame;
  thr_read_report report;
  int code = cli_read_frame_report(path, args, &frame, &report);
  if (code) return code;
  facts a = {0};
  a.n_assumptions = thr_read_assumptions(&args->read, &frame, &report, a.assumption);
  thr_text text = {0};
  thr_err err = {0};
  if (find_facts(&frame, &a, &err) || find_untied(path, &a, &err)) {
    code = cli_fail(&err);
  } else {
    (json ? put_json : put_text)(&text, &frame, &a);
    code = cli_write(&text, "-");
  }
  free(a.untied);
  thr_frame_destroy(&frame);
  return code;
}

/* What was asked. */
typedef struct {
  cli_frame_args frame;
  guard_limits guard;
  bool json;
} arguments;

static const cli_option own_options[] = {
    {"json", .kind = CLI_FLAG, .offset = offsetof(arguments, json), .help = "as JSON"}, {0}};

int cmd_info(int argc, char **argv)
{
  static const cli_syntax syntax = {"info", intro, NULL};
  arguments a = {.frame = cli_frame_args_default(), .guard = guard_limits_default()};
  guard_end end;
  const cli_group groups[] = {{"Options", own_options, &a},
                              {NULL, guard_options, &a.guard},
                              {"Framework", cli_frame_options, &a.frame},
                              {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  if (optind + 1 != argc)
    return cli_usage("info", optind == argc ? "which framework?" : "one framework at a time");
  if (guard_fork(&a.guard, &end)) return guard_conclude(&end, "nothing is known");
  return tell(argv[optind], &a.frame, a.json);
}
