/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread info: computes what a framework is made of: degrees, odd nodes, components, bridges, feet,
 * lengths, and whether it is rigid; of a plan also which joints its cords do not tie, which
 * channels cross inside a piece, and what a kit of its pieces will be.
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
#include "cli/commands/info_parts.h"
#include "eval/structure/beads.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lib/lib.h"

#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread info FRAME [options]: nodes, edges, odd nodes, components, feet, rigidity\n\n"
    "Examples:\n"
    "  thread info dome.obj --feet lowest\n"
    "  thread info nodes.csv --edges edges.csv --json\n"
    "  thread info plan.json      the framework inside a plan, the joints that its cords do not "
    "tie,\n"
    "                             the channels that cross inside a piece, and the pieces to "
    "make\n"
    "  thread info arch.obj --motions --held feet --play arch.html\n"
    "  thread info prism.obj --cables 1-4,2-5,3-6     can pulling these edges move anything?\n"
    "  thread info --turn cone --tip 60 --plot a.svg  how far can two beads on a cord turn?\n\n"
    "The line `hinged` takes every node for a ball joint: can nodes move without an edge getting\n"
    "longer? What can move must be held by joints that lock. A joint is tied if the cord alone "
    "holds\n"
    "its edges together (--joint tube); joints of solid beads need not be.\n";

enum { MOST_BARS = 50000 };

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
  bool *bridge = thr_calloc((size_t)frame->n_edges, sizeof *bridge);
  thr_status st =
      bridge ? thr_frame_components(frame, NULL, &info->components, err) : thr_nomem(err);
  if (!st) st = thr_frame_bridges(frame, bridge, err);

  /* Nodes: degrees, odd ones, feet. */
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int d = thr_degree(frame, v);
    info->degree[d < FACTS_DEGREES ? d : FACTS_DEGREES]++;
    info->odd += d % 2;
    info->feet += frame->foot[v];
  }

  /* Edges: bridges and lengths. */
  for (int e = 0; e < frame->n_edges && !st; e++) {
    info->bridges += bridge[e];
    if (frame->length[e] < info->shortest) info->shortest = frame->length[e];
    if (frame->length[e] > info->longest) info->longest = frame->length[e];
  }
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
  if (!st) st = thr_kit_estimate_make(&info->kit, &plan, err);
  thr_plan_destroy(&plan);

  return st;
}

/* What was asked. */
typedef struct {
  cli_frame_args frame;
  guard_limits guard;
  motion_arguments motions;
  turn_arguments turn;
} info_arguments;

/* Reads a framework, finds its facts and prints them. Returns an exit code. */
static int print_facts(const char *path, const info_arguments *args)
{
  thr_frame frame;
  thr_read_report report;
  motion_facts motions = {0};
  int code = cli_read_frame_report(path, &args->frame, &frame, &report);

  if (code) return code;

  /* What the reader had to assume about units, axes and the like. */
  frame_facts info = {0};
  info.n_assumptions = thr_read_assumptions(&args->frame.read, &frame, &report, info.assumption);
  cli_step("finding out what can move", "");
  if (motions_asked(&args->motions)) {
    code = motions_find(path, &frame, &args->motions, &motions);
    info.motions = &motions;
  }

  thr_text text = {0};
  thr_err err = {0};

  /* A file that is a plan has more to say than a framework. */
  if (!code && (find_facts(&frame, &info, &err) || find_untied(path, &info, &err))) {
    code = cli_fail(&err);
  } else if (!code) {
    (cli_json ? facts_put_json : facts_put)(&text, &frame, &info);
    code = print_text(&text);
  }

  free(info.untied);
  motions_destroy(&motions);
  thr_frame_destroy(&frame);

  return code;
}

/* Runs `thread info` and returns the exit code. */
int cmd_info(int argc, char **argv)
{
  static const cli_syntax syntax = {"info", intro, NULL};
  info_arguments args = {.frame = cli_frame_args_default(), .guard = guard_limits_default()};
  guard_end end;
  const cli_group groups[] = {{"Options", guard_options, &args.guard},
                              {"Motions", motion_options, &args.motions},
                              {"Two pieces on a cord", turn_options, &args.turn},
                              {"Framework", cli_frame_options, &args.frame},
                              {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  /* One operand: the framework, or a plan that holds one. */
  if (args.turn.wanted && optind != argc)
    return cli_usage("info", "--turn asks about two pieces, and takes no FRAME");
  if (!args.turn.wanted && cli_given_of(turn_options))
    return cli_usage("info", "%s needs --turn", cli_given_of(turn_options));
  if (!args.turn.wanted && optind + 1 != argc)
    return cli_usage("info", optind == argc ? "which framework?" : "one framework at a time");

  /* The child does all of the work. */
  if (guard_fork(&args.guard, &end)) return guard_conclude(&end, "nothing is known");

  return args.turn.wanted ? turn_print(&args.turn) : print_facts(argv[optind], &args);
}
