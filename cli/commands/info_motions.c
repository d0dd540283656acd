/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread info --motions: finds the motions that keep all bars, says what pulling the cords moves,
 * and draws and plays one of them (eval/structure/bar_motions.c, pulling.c).
 *
 * Edges are bars between ball joints, but for those of --cables, which are cord alone. The cords
 * are those of the plan, if FRAME is one, and each slides freely through all that it passes; else
 * every edge of --cables is a cord of its own. */
#define _POSIX_C_SOURCE 200809L /* strtok_r */
#include "cli/commands/info_parts.h"

#include "diagram/export/paper.h"
#include "diagram/overview/overview.h"
#include "eval/structure/beads.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Frames of a path beyond the first, and how many of them move the fastest node by an edge. */
enum { FRAMES = 60, FRAMES_AN_EDGE = 30, TITLE = 96 };

#define AT(member) .offset = offsetof(motion_arguments, member)
const cli_option motion_options[] = {
    {"motions", .kind = CLI_FLAG, AT(wanted),
     .help = "the motions that keep the length of every edge, one by one; the options below ask "
             "for them, too"},
    {"held", .value = "NODES", .kind = CLI_TEXT, AT(held),
     .help =
         "nodes that stay in place: feet, names with commas, or a file of names (default: none, "
         "and motions are those besides moving and turning the whole)"},
    {"cables", .value = "EDGES", .kind = CLI_TEXT, AT(cables),
     .help = "edges that are cord without a bead, by their nodes: A1-B1,B1-B2; they may get "
             "shorter, not longer"},
    {"motion", .value = "K", .kind = CLI_COUNT, AT(which), .low = 1, .high = 1e9,
     .help = "which motion is drawn and played (default: what pulling moves, else 1)"},
    {"picture", .value = "FILE.svg", .kind = CLI_OUTPUT, AT(picture),
     .help = "draw the motion: an arrow at every node"},
    {"play", .value = "FILE.html", .kind = CLI_OUTPUT, AT(play),
     .help = "follow the motion as far as lengths can be kept, and play it in the viewer"},
    {0}};

bool motions_asked(const motion_arguments *args)
{
  return args->wanted || args->held || args->cables || args->which || args->picture || args->play;
}

/* Returns the edge whose name, "A1-B1", has these letters, or -1. Names of nodes may hold hyphens:
 * every one is tried. */
static int find_edge(const thr_frame *frame, const char *name)
{
  char first[256];
  for (const char *dash = strchr(name, '-'); dash; dash = strchr(dash + 1, '-')) {
    if ((size_t)(dash - name) >= sizeof first) return -1;
    snprintf(first, sizeof first, "%.*s", (int)(dash - name), name);
    int a = thr_frame_find(frame, first), b = thr_frame_find(frame, dash + 1);
    int e = a >= 0 && b >= 0 && a != b ? thr_frame_edge_between(frame, a, b) : -1;
    if (e >= 0) return e;
  }
  return -1;
}

/* Marks the edges of a list with commas. Returns an exit code. */
static int mark_edges(const thr_frame *frame, const char *list, bool *mark)
{
  thr_text text = {0};
  int code = EXIT_OK, n = 0;
  thr_text_append(&text, list);

  for (char *save = NULL, *name = text.data ? strtok_r(text.data, ", ;", &save) : NULL;
       name && !code; name = strtok_r(NULL, ", ;", &save), n++) {
    int e = find_edge(frame, name);
    if (e >= 0) {
      mark[e] = true;
      continue;
    }
    cli_error("--cables: there is no edge %s; the first edge is %s-%s", name,
              frame->name[frame->edge[0][0]], frame->name[frame->edge[0][1]]);
    code = EXIT_INPUT;
  }

  if (!code && n == 0) {
    cli_error("--cables %s: names no edge", list);
    code = EXIT_INPUT;
  }
  thr_text_destroy(&text);
  return code;
}

/* Marks what is held and what is cord alone. Returns an exit code. */
static int mark(const thr_frame *frame, const motion_arguments *args, motion_facts *facts)
{
  thr_err err = {0};
  facts->held = thr_calloc((size_t)frame->n_nodes, sizeof *facts->held);
  facts->cable = thr_calloc((size_t)frame->n_edges, sizeof *facts->cable);
  if (!facts->held || !facts->cable) {
    thr_status st = thr_nomem(&err);
    (void)st;
    return cli_fail(&err);
  }

  /* The feet, or nodes by their names. */
  facts->bars = (thr_bars){.frame = frame,
                           .held = args->held ? facts->held : NULL,
                           .cable = args->cables ? facts->cable : NULL};
  if (args->held && strcmp(args->held, "feet") == 0)
    memcpy(facts->held, frame->foot, (size_t)frame->n_nodes * sizeof *facts->held);
  else if (args->held && !cli_mark_nodes(frame, args->held, "--held", facts->held))
    return EXIT_INPUT;
  for (int v = 0; v < frame->n_nodes; v++)
    facts->n_held += facts->held[v];
  if (args->held && facts->n_held == 0) {
    cli_error("--held feet: the framework has no feet; --feet says which they are");
    return EXIT_INPUT;
  }

  return args->cables ? mark_edges(frame, args->cables, facts->cable) : EXIT_OK;
}

/* Makes a cord of every edge that is cord alone. */
static thr_status cords_of_edges(motion_facts *facts, thr_err *err)
{
  const thr_frame *frame = facts->bars.frame;
  facts->cord = thr_calloc((size_t)frame->n_edges, sizeof *facts->cord);
  if (!facts->cord) return thr_nomem(err);

  for (int e = 0; e < frame->n_edges; e++) {
    if (!facts->cable[e]) continue;
    thr_cord *cord = &facts->cord[facts->n_cords];
    if (!(cord->half = thr_calloc(1, sizeof *cord->half))) return thr_nomem(err);
    cord->half[0] = 2 * e;
    cord->n_passes = 1;
    facts->n_cords++;
  }
  return THR_OK;
}

/* Takes the cords out of a plan. THR_EINPUT if they do not fit the framework as it was read. */
static thr_status cords_of_plan(const thr_frame *frame, thr_plan *plan, motion_facts *facts,
                                thr_err *err)
{
  if (plan->frame.n_nodes != frame->n_nodes || plan->frame.n_edges != frame->n_edges ||
      memcmp(plan->frame.edge, frame->edge, (size_t)frame->n_edges * sizeof *frame->edge) != 0)
    return thr_fail(err, THR_EINPUT,
                    "the cords of the plan do not fit its framework as the options read it");

  facts->cord = plan->cord;
  facts->n_cords = plan->n_cords;
  plan->cord = NULL;
  plan->n_cords = 0;
  return THR_OK;
}

/* Finds the cords: those of the plan, or the edges that are cord alone. */
static thr_status find_cords(const char *path, const thr_frame *frame, motion_facts *facts,
                             thr_err *err)
{
  thr_plan plan = {0};
  thr_err not_a_plan = {0};
  thr_status st = strcmp(path, "-") == 0 ? THR_EINPUT : thr_plan_read(&plan, path, &not_a_plan);

  if (st == THR_ENOMEM) return thr_nomem(err);
  facts->planned = !st;
  if (st) return facts->bars.cable ? cords_of_edges(facts, err) : THR_OK;

  st = cords_of_plan(frame, &plan, facts, err);
  thr_plan_destroy(&plan);
  return st;
}

/* Finds the motions, and what pulling does. */
static thr_status analyse(motion_facts *facts, const thr_limits *limits, thr_err *err)
{
  thr_bar_motions kept = {0};
  thr_status st = thr_bar_motions_find(&facts->bars, NULL, 0, &facts->basis, err);
  if (st || facts->n_cords == 0) return st;

  /* Motions that change no cord are left where pulling moves nothing. */
  st = thr_pulling_find(&facts->bars, facts->cord, facts->n_cords, limits, &facts->pulling, err);
  if (!st) st = thr_bar_motions_find(&facts->bars, facts->cord, facts->n_cords, &kept, err);
  facts->n_left = kept.count;
  thr_bar_motions_destroy(&kept);
  return st;
}

/* Chooses the motion that is drawn and played. Returns an exit code. */
static int choose(motion_facts *facts, const motion_arguments *args)
{
  if (args->which > facts->basis.count) {
    cli_error("--motion %d: there %s %d %s", args->which, facts->basis.count == 1 ? "is" : "are",
              facts->basis.count, cli_plural(facts->basis.count, "motion", "motions"));
    return EXIT_INPUT;
  }
  if ((args->picture || args->play) && facts->basis.count == 0) {
    cli_error("nothing moves: there is no motion to draw");
    return EXIT_INFEASIBLE;
  }

  facts->which = args->which ? args->which : facts->pulling.moves ? 0 : 1;
  if (facts->basis.count)
    facts->chosen = facts->which ? (const double(*)[3])facts->basis.velocity +
                                       (size_t)(facts->which - 1) * (size_t)facts->basis.n_nodes
                                 : (const double(*)[3])facts->pulling.velocity;
  return EXIT_OK;
}

/* Writes which motion it is. */
static void title_of(const motion_facts *facts, char title[TITLE])
{
  if (facts->which)
    snprintf(title, TITLE, "Motion %d of %d", facts->which, facts->basis.count);
  else
    snprintf(title, TITLE, "What pulling the cords moves");
}

/* Draws the chosen motion. Returns an exit code. */
static int draw(const motion_facts *facts, const char *path)
{
  const thr_frame *frame = facts->bars.frame;
  char title[TITLE], note[200];
  thr_text svg = {0};
  thr_err err = {0};

  title_of(facts, title);
  snprintf(note, sizeof note,
           "Every bar keeps its length. Arrows are velocities, the longest one at node %.40s.%s%s",
           frame->name[thr_motion_fastest(facts->chosen, frame->n_nodes)],
           facts->bars.cable ? " Dashed: cord without a bead." : "",
           facts->n_held ? " Squares: held." : "");

  const thr_motion_picture picture = {.frame = frame,
                                      .velocity = facts->chosen,
                                      .held = facts->bars.held,
                                      .cable = facts->bars.cable,
                                      .title = title,
                                      .note = note};
  thr_status st = thr_motion_svg(&picture, &svg, &err);
  return cli_write_drawn(st, &svg, path, &err);
}

/* Follows the chosen motion. */
static thr_status follow(motion_facts *facts, const thr_limits *limits, thr_err *err)
{
  const thr_frame *frame = facts->bars.frame;
  double mean = 0;
  for (int e = 0; e < frame->n_edges; e++)
    mean += frame->length[e] / frame->n_edges;

  /* Pulling goes on until a cord would get longer; other motions mind no cord. */
  return thr_motion_follow(&facts->bars, facts->cord, facts->which ? 0 : facts->n_cords,
                           facts->chosen, mean / FRAMES_AN_EDGE, FRAMES + 1, limits, &facts->path,
                           err);
}

/* Writes the viewer with the motion that was followed. Returns an exit code. */
static int play(const motion_facts *facts, const char *path)
{
  static const char *const end[] = {
      "Every bar keeps its length.",
      "Every bar keeps its length. The motion ends where a bar would have to change.",
      "Every bar keeps its length. The motion ends where it is none any more.",
      "Every bar keeps its length. The motion ends where a cord would get longer."};
  char title[TITLE];
  thr_text html = {0};
  thr_err err = {0};

  title_of(facts, title);
  const thr_viewer_moves moves = {.n_frames = facts->path.n_frames,
                                  .at = (const double(*)[3])facts->path.at,
                                  .cable = facts->bars.cable,
                                  .title = title,
                                  .note = end[facts->path.end]};
  thr_status st = thr_viewer_moves_html(facts->bars.frame, &moves, &html, &err);
  return cli_write_drawn(st, &html, path, &err);
}

int motions_find(const char *path, const thr_frame *frame, const motion_arguments *args,
                 motion_facts *facts)
{
  thr_err err = {0};
  const thr_limits limits = cli_limits(0);
  int code = mark(frame, args, facts);
  if (code) return code;

  thr_status st = find_cords(path, frame, facts, &err);
  if (!st) st = analyse(facts, &limits, &err);
  if (!st && (code = choose(facts, args))) return code;
  if (!st && args->play) st = follow(facts, &limits, &err);
  cli_progress_end();
  if (st) return cli_fail(&err);

  answer_file(args->picture, "the motion as a picture");
  answer_file(args->play, "the motion in the viewer");
  if (args->picture) code = draw(facts, args->picture);
  return !code && args->play ? play(facts, args->play) : code;
}

void motions_destroy(motion_facts *facts)
{
  for (int c = 0; c < facts->n_cords; c++)
    free(facts->cord[c].half);
  free(facts->cord);
  free(facts->held);
  free(facts->cable);
  thr_bar_motions_destroy(&facts->basis);
  thr_pulling_destroy(&facts->pulling);
  thr_path_destroy(&facts->path);
}
