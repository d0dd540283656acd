/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread info: computes what a framework is made of: degrees, odd nodes, components, bridges, feet,
 * lengths, and whether it is rigid; of a plan also which joints its cords do not tie, and which
 * channels cross inside a piece.
 *
 * Odd nodes and bridges tell what threading costs: a closed cord passes some edges twice between
 * odd nodes, in pairs, and every bridge twice.
 *
 * Rigidity takes every node for a ball joint and every edge for a bar (docs/method.md, "Rigidity").
 * Of 3 n coordinates the rank of the rigidity matrix and the 6 rigid motions are taken off; what is
 * left are motions without stretching an edge. Edges beyond the rank are self-stresses. The rank is
 * computed numerically; where rounding decides, the line says so.
 *
 * Example: the 7 x 7 dome has 49 nodes, 84 edges, 20 odd nodes and 57 such motions (3 x 49 - 84 -
 * 6). */
#include "cli/cli.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lib/lib.h"

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
    "  thread info plan.json      the framework inside a plan, the joints that its cords do not "
    "tie,\n"
    "                             and the channels that cross inside a piece\n\n"
    "The line `hinged` takes every node for a ball joint: can nodes move without an edge getting\n"
    "longer? What can move must be held by joints that lock. A joint is tied if the cord alone "
    "holds\n"
    "its edges together (--joint tube); joints of solid beads need not be.\n";

enum { MOST_DEGREES = 64, MOST_NAMES = 20, MOST_BARS = 50000 };
/* What was found out about a framework. */
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
} frame_facts;

/* Returns whether the rank of the rigidity matrix (edges x 3 nodes) is worked out within a second
 * or so. The matrix is sparse unless edges are many for their nodes; then work grows with edges x
 * columns^2. */
static bool can_analyse(const thr_frame *frame)
{
  const double most_work = 2e9, columns = 3.0 * frame->n_nodes;
  return frame->n_edges <= MOST_BARS &&
         (frame->n_edges <= 20 * frame->n_nodes || frame->n_edges * columns * columns <= most_work);
}

/* Counts nodes and edges, measures lengths, and analyses the rigidity where that takes no more than
 * a second or so. *info is {0} before; on failure what was found may be in it. */
static thr_status find_facts(const thr_frame *frame, frame_facts *info, thr_err *err)
{
  info->shortest = frame->length[0];

  /* One pass over nodes and edges each; the analysis of rigidity is a rank, which may take long. */
  int *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  bool *bridge = thr_calloc((size_t)frame->n_edges, sizeof *bridge);
  thr_status st = component && bridge ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, component, &info->components, err);
  if (!st) st = thr_frame_bridges(frame, bridge, err);

  /* Nodes: degrees, odd ones, feet. */
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int d = thr_degree(frame, v);
    info->degree[d < MOST_DEGREES ? d : MOST_DEGREES]++;
    info->odd += d % 2;
    info->feet += frame->foot[v];
  }

  /* Edges: bridges and lengths. */
  for (int e = 0; e < frame->n_edges && !st; e++) {
    info->bridges += bridge[e];
    if (frame->length[e] < info->shortest) info->shortest = frame->length[e];
    if (frame->length[e] > info->longest) info->longest = frame->length[e];
  }
  free(component);
  free(bridge);

  info->analysed = can_analyse(frame);

  return st || !info->analysed ? st : thr_rigidity_find(frame, &info->rigidity, err);
}

/* Counts pairs of channels that cross inside a piece. */
static thr_status count_crossings(const thr_plan *plan, frame_facts *info, thr_err *err)
{
  thr_channels channels;
  thr_status st = thr_channels_make(&channels, plan, err);

  if (st) return st;

  /* Pairs of channels, and pieces with at least one pair. */
  info->channels = true;
  info->crossings = channels.crossings;
  info->crossed = channels.crossed;
  thr_channels_destroy(&channels);

  return THR_OK;
}

/* Finds joints that the cords of a plan do not tie, and channels that cross. A joint is tied if
 * cords connect all of its edges by turns, so that it holds even if pieces are tubes. Nothing if
 * the file is no valid plan, or stdin, which has been read already. */
static thr_status find_untied(const char *path, frame_facts *info, thr_err *err)
{
  thr_plan plan;
  thr_err not_a_plan = {0};

  if (strcmp(path, "-") == 0) return THR_OK;
  thr_status st = thr_plan_read(&plan, path, &not_a_plan);
  if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;

  /* thr_junction_tied says which joints are tied; the others are what is told. */
  if (!(info->untied = thr_calloc((size_t)plan.frame.n_nodes, sizeof *info->untied)))
    st = thr_nomem(err);
  if (!st)
    st = thr_junction_tied(&plan.frame, plan.cord, plan.n_cords,
                           plan.options.ends == THR_ENDS_CLOSED, info->untied, err);
  for (int v = 0; v < plan.frame.n_nodes && !st; v++)
    info->n_untied += info->untied[v] = !info->untied[v];

  info->planned = !st;
  if (!st && plan.options.joint == THR_JOINT_SOLID) st = count_crossings(&plan, info, err);
  thr_plan_destroy(&plan);

  return st;
}

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

/* Appends all facts as text, and as what the file was read. */
static void put_text(thr_text *text, const thr_frame *frame, const frame_facts *info)
{
  thr_text_printf(text, "nodes       %d, a piece each with solid joints\n", frame->n_nodes);
  thr_text_printf(text, "edges       %d, interfaces of two pieces; with --joint tube a tube each\n",
                  frame->n_edges);

  thr_text_append(text, "degrees    ");
  for (int d = 0; d <= MOST_DEGREES; d++)
    if (info->degree[d])
      thr_text_printf(text, " %d x %d%s", info->degree[d], d, d == MOST_DEGREES ? " or more" : "");

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
  for (int d = 0; d <= MOST_DEGREES; d++) {
    char degree[16];
    snprintf(degree, sizeof degree, "%d", d);
    if (info->degree[d]) thr_write_int(writer, degree, info->degree[d]);
  }
  thr_write_close(writer);
}

/* Writes all facts as JSON. */
static void put_json(thr_text *text, const thr_frame *frame, const frame_facts *info)
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
  if (info->planned) put_untied_json(&writer, frame, info);
  if (info->channels) {
    thr_write_int(&writer, "crossings", info->crossings);
    thr_write_int(&writer, "crossed_pieces", info->crossed);
  }

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
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* Reads a framework, finds its facts and prints them. Returns an exit code. */
static int print_facts(const char *path, const cli_frame_args *args, bool json)
{
  thr_frame frame;
  thr_read_report report;
  int code = cli_read_frame_report(path, args, &frame, &report);

  if (code) return code;

  /* What the reader had to assume about units, axes and the like. */
  frame_facts info = {0};
  info.n_assumptions = thr_read_assumptions(&args->read, &frame, &report, info.assumption);

  thr_text text = {0};
  thr_err err = {0};

  /* A file that is a plan has more to say than a framework. */
  if (find_facts(&frame, &info, &err) || find_untied(path, &info, &err)) {
    code = cli_fail(&err);
  } else {
    (json ? put_json : put_text)(&text, &frame, &info);
    code = cli_write(&text, "-");
  }

  free(info.untied);
  thr_frame_destroy(&frame);

  return code;
}

/* What was asked. */
typedef struct {
  cli_frame_args frame;
  guard_limits guard;
  bool json;
} info_arguments;

static const cli_option own_options[] = {
    {"json", .kind = CLI_FLAG, .offset = offsetof(info_arguments, json), .help = "as JSON"}, {0}};

/* Runs `thread info` and returns the exit code. */
int cmd_info(int argc, char **argv)
{
  static const cli_syntax syntax = {"info", intro, NULL};
  info_arguments args = {.frame = cli_frame_args_default(), .guard = guard_limits_default()};
  guard_end end;
  const cli_group groups[] = {{"Options", own_options, &args},
                              {NULL, guard_options, &args.guard},
                              {"Framework", cli_frame_options, &args.frame},
                              {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  /* One operand: the framework, or a plan that holds one. */
  if (optind + 1 != argc)
    return cli_usage("info", optind == argc ? "which framework?" : "one framework at a time");

  /* The child does all of the work. */
  if (guard_fork(&args.guard, &end)) return guard_conclude(&end, "nothing is known");

  return print_facts(argv[optind], &args.frame, args.json);
}
