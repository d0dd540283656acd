/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread rise: lets the pieces of a plan rise in simulation, as their cords are pulled
 * (eval/rise/rise.h), and says whether they come up, at what pull, and where they jam.
 *
 * Pieces are those of `thread kit`. Several seeds are several runs: one run is no fact.
 *
 * Example: `thread rise data/dome7-lines.json` lays 49 pieces flat on the ground, pulls 28 ends,
 * and the dome stands at some 1.3 N. */
#include "cli/args/args.h"
#include "cli/cli.h"
#include "cli/commands/commands.h"
#include "diagram/overview/charts.h"
#include "diagram/scene/movement.h"
#include "eval/eval.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/number.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/process/process.h"
#include "graph/text.h"
#include "kit/files.h"
#include "kit/film.h"
#include "kit/kit.h"
#include "lib/lib.h"
#include "lib/rise_pieces.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread rise PLAN [options]: loose pieces, pulled cords: does it rise, and at what pull?\n\n"
    "Examples:\n"
    "  thread rise plan.json                         from flat on the ground\n"
    "  thread rise plan.json --start heap --seeds 5  dropped in a heap, five times\n"
    "  thread rise plan.json --raise D4              a hand carries piece D4 to its height\n"
    "  thread rise plan.json --let-down              and down again, until it falls\n";
static const char outro[] =
    "Exit codes: 0 all was seen, whether it comes up or not, 2 usage, 3 not a plan or nothing that "
    "can be simulated, 5 not done in the time or memory (what was seen is printed)";

enum { MOST_SEEDS = 1000, MOST_MOMENTS = 4000 };
static const double HAND = 50;    /* N, the most that a hand pulls once */
static const double COARSE = 2.2; /* factor on the triangles of pieces in films */
static const double LIFTING = 2;  /* of the structure's weight, that a hand carries at most */

/* What was asked. */
typedef struct {
  thr_rise_options rise;
  thr_kit_options kit;
  guard_limits guard;
  const char *lift, *raise, *lay, *held, *shape, *slack, *output, *plot, *film, *frames, *play;
  const char *path;
  int seeds, first_seed, start, size[2];
  double time_step, iterations;
  bool json, let_down;
} rise_arguments;

#define AT(member) .offset = offsetof(rise_arguments, member)

/* Takes "640x480". */
static bool take_size(void *into, const cli_option *option, const char *value)
{
  int *size = ((rise_arguments *)into)->size, end = 0;
  (void)option;
  if (sscanf(value, "%4dx%4d%n", &size[0], &size[1], &end) == 2 && !value[end] && size[0] >= 64 &&
      size[1] >= 64 && size[0] <= 4000 && size[1] <= 4000)
    return true;
  cli_usage("rise", "--size %s: expected width x height in px, 64 to 4000, as 640x480", value);
  return false;
}

static const cli_option own_options[] = {
    {"start", .kind = CLI_WORD, AT(start), .word = thr_rise_start_name, .n_words = THR_RISE_LAID,
     .help = "where pieces begin: flat on the ground, slack (default), in a heap, or closed in "
             "their shape"},
    {"lay", .value = "FRAME", .kind = CLI_TEXT, AT(lay),
     .help = "pieces begin where this framework has the same nodes"},
    {"held", .value = "NODE,..", .kind = CLI_TEXT, AT(held),
     .help = "these pieces cannot move from where they begin"},
    {"shape", .value = "CORD=FRAME,..", .kind = CLI_TEXT, AT(shape),
     .help = "a cord closes its faces towards this framework, which has the same nodes at other "
             "places"},
    {"slack", .value = "CORD,..", .kind = CLI_TEXT, AT(slack), .help = "nobody pulls these cords"},
    {"pull", .value = "N", .kind = CLI_AMOUNT, AT(rise.pull), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "hands pull every end with more and more, up to so much (default: 50, the most of a "
             "hand)"},
    {"slower", .value = "X", .kind = CLI_AMOUNT, AT(rise.slower), .low = 0.01, .high = 1000,
     .help = "hands take X times as long"},
    {"let-down", .kind = CLI_FLAG, AT(rise.let_down),
     .help = "and let the cords go again, until it falls"},
    {"lift", .value = "NODE=N", .kind = CLI_TEXT, AT(lift),
     .help = "a counterweight lifts this piece with so many newtons"},
    {"raise", .value = "NODE", .kind = CLI_TEXT, AT(raise),
     .help = "a hand carries this piece to its height, and no higher"},
    {"seeds", .value = "N", .kind = CLI_COUNT, AT(seeds), .low = 1, .high = MOST_SEEDS,
     .help = "so many runs, each from another disorder: median and range (default: 1)"},
    {"seed", .value = "N", .kind = CLI_COUNT, AT(first_seed), .low = 0, .high = 1e9,
     .help = "of the first run (default: 1)"},
    {"output", 'o', .value = "FILE", .kind = CLI_OUTPUT, AT(output),
     .help = "write what was seen, with the place of every piece, as JSON"},
    {"plot", .value = "FILE.svg", .kind = CLI_OUTPUT, AT(plot),
     .help = "draw pull and closed faces against the cord that is drawn in"},
    {"film", .value = "FILE.png", .kind = CLI_OUTPUT, AT(film),
     .help = "a picture that moves (APNG), which every browser plays"},
    {"frames", .value = "FOLDER", .kind = CLI_TEXT, AT(frames),
     .help = "the same as numbered pictures, frame-0001.png and so on"},
    {"size", .value = "WxH", .kind = CLI_OTHER, .take = take_size,
     .help = "of film and frames in pixels (default: 640x480)"},
    {"play", .value = "FILE.html", .kind = CLI_OUTPUT, AT(play),
     .help = "the viewer, which plays it: one file for any browser"},
    {"json", .kind = CLI_FLAG, AT(json), .help = "print the answers as JSON"},
    {0}};

static const cli_option shape_options[] = {
    {"width", .value = "MM", .kind = CLI_AMOUNT, AT(kit.width), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "of the pieces' arms, as for thread kit (default: the bead diameter of the plan)"},
    {"profile", .kind = CLI_WORD, AT(kit.profile), .word = thr_kit_profile_name,
     .n_words = THR_KIT_N_PROFILES, .help = "cross-section of arms, as for thread kit"},
    {"channels", .kind = CLI_WORD, AT(kit.channels), .word = thr_kit_channels_name,
     .n_words = THR_KIT_N_CHANNELS, .help = "one bore, or a lane for each cord, as for thread kit"},
    {"density", .value = "G", .kind = CLI_AMOUNT, AT(kit.density), .low = CLI_ABOVE_0, .high = 100,
     .help = "of the material in g/cm3 (default: as the plan says)"},
    {0}};

static const cli_option tuned_options[] = {
    {"time-step", .kind = CLI_AMOUNT, AT(rise.time_step), .low = 0.01, .high = 4},
    {"iterations", .kind = CLI_AMOUNT, AT(iterations), .low = 1, .high = 10000},
    {0}};

/* All that a run needs. */
typedef struct {
  const rise_arguments *args;
  const thr_kit *kit;
  thr_rise_kit made;
  thr_rise_options options; /* of the first run */
  int n_runs;
  thr_rise_record *record; /* [seeds] of which n_runs are done; only the first has poses */
  double seated, stands;   /* N, by the closed form and by limit analysis; NAN: not known */
} rise_runs;

/* What a process returns of a run. */
typedef struct {
  thr_rise_record record; /* without its arrays */
  thr_rise_moment moment[MOST_MOMENTS];
  double angle[]; /* [2 n_passes] kinks, twists */
} rise_result;

/* The size of such a result. */
static size_t result_size(const rise_runs *runs)
{
  return sizeof(rise_result) + 2 * sizeof(double) * (size_t)runs->record[0].n_passes;
}

/* The piece with this name, as documents call it or as the framework does; -1. */
static int piece_named(const thr_kit *kit, const char *name)
{
  for (int p = 0; p < kit->n_pieces; p++)
    if (strcmp(kit->name[p], name) == 0) return p;
  return thr_frame_find(&kit->plan->frame, name);
}

/* Reads which piece a hand lifts, and how. Returns -1, or an exit code. */
static int take_lift(const rise_arguments *args, const thr_kit *kit, double weight,
                     thr_rise_options *options)
{
  char name[64];
  const char *words = args->raise ? args->raise : args->lift;
  if (!words) return -1;
  const char *equals = args->raise ? words + strlen(words) : strrchr(words, '=');
  if (!equals) return cli_usage("rise", "--lift %s: expected a piece and newtons, as D4=2", words);
  snprintf(name, sizeof name, "%.*s", (int)(equals - words), words);
  options->lifted = piece_named(kit, name);
  options->carried = args->raise != NULL;
  options->lift = LIFTING * weight;
  if (options->lifted < 0) return cli_usage("rise", "%s: the plan has no such piece", name);
  if (args->raise) return -1;

  size_t n = strlen(equals + 1);
  if (n > 1 && equals[n] == 'N') n--;
  if (!thr_number_parse(equals + 1, n, &options->lift) || !(options->lift > 0))
    return cli_usage("rise", "--lift %s: expected newtons above 0 after the =, as D4=2", words);
  return -1;
}

/* ---- what is said ---- */

/* The pull at which a run came up, N; infinite if it did not. */
static double pull_up(const thr_rise_record *record)
{
  return record->came_up >= 0 ? record->moment[record->came_up].pull : INFINITY;
}

static double pull_down(const thr_rise_record *record)
{
  return record->fell >= 0 ? record->moment[record->fell].pull : 0;
}

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The least, the middle and the largest of what is read off all runs. */
static void spread_of(const rise_runs *runs, double (*of)(const thr_rise_record *), double out[3])
{
  double value[MOST_SEEDS];
  for (int i = 0; i < runs->n_runs; i++)
    value[i] = of(&runs->record[i]);
  qsort(value, (size_t)runs->n_runs, sizeof *value, ascending);
  out[0] = value[0];
  out[1] = value[(runs->n_runs - 1) / 2];
  out[2] = value[runs->n_runs - 1];
}

static double off_of(const thr_rise_record *record)
{
  return record->off;
}

/* How many runs came up. */
static int count_up(const rise_runs *runs)
{
  int n = 0;
  for (int i = 0; i < runs->n_runs; i++)
    n += runs->record[i].came_up >= 0;
  return n;
}

/* Appends "1.3 N", or "1.1 to 1.5 N, half of the runs within 1.3" for several runs. */
static void put_spread(const rise_runs *runs, double (*of)(const thr_rise_record *),
                       const char *unit, thr_text *text)
{
  double value[3];
  spread_of(runs, of, value);
  if (runs->n_runs == 1)
    thr_text_printf(text, "%.3g %s", value[0], unit);
  else
    thr_text_printf(text, "%.3g %s (%.3g to %.3g)", value[1], unit, value[0], value[2]);
}

/* The names of the two pieces of a pass, counted over all cords. */
static void pieces_of(const rise_runs *runs, int pass, const char *name[2])
{
  for (int c = 0; c < runs->made.structure.n_cords; c++) {
    const thr_rise_cord *cord = &runs->made.structure.cord[c];
    if (pass >= cord->n_passes) {
      pass -= cord->n_passes;
      continue;
    }
    name[0] = runs->kit->name[cord->piece[pass]];
    name[1] = runs->kit->name[cord->piece[pass + 1]];
    return;
  }
}

/* Appends what rises and from where. */
static void put_title(const rise_runs *runs, thr_text *text)
{
  const thr_rise_structure *structure = &runs->made.structure;
  const thr_rise_record *record = &runs->record[0];
  const thr_rise_options *options = &runs->args->rise;
  int ends = 0;
  for (int c = 0; c < structure->n_cords; c++)
    ends +=
        structure->cord[c].slack ? 0 : structure->cord[c].pulled[0] + structure->cord[c].pulled[1];
  thr_text_printf(text, "%d pieces, %.3g N in all, %d %s pulled at %d %s, %s", structure->n_pieces,
                  record->weight, structure->n_cords,
                  cli_plural(structure->n_cords, "cord", "cords"), ends,
                  cli_plural(ends, "end", "ends"),
                  options->start == THR_RISE_FLAT   ? "from flat on the ground"
                  : options->start == THR_RISE_HEAP ? "from a heap"
                  : options->start == THR_RISE_LAID ? "from where it is laid"
                                                    : "from its shape");
}

/* Appends whether it comes up, and at what pull. */
static void put_outcome(const rise_runs *runs, thr_text *text)
{
  const int up = count_up(runs);
  if (runs->n_runs > 1)
    thr_text_printf(text, "comes up in %d of %d runs", up, runs->n_runs);
  else
    thr_text_append(text, up ? "comes up" : "does not come up");
  if (2 * up > runs->n_runs) {
    thr_text_append(text, runs->args->rise.start == THR_RISE_SHAPE ? ": it stands at " : " at ");
    put_spread(runs, pull_up, "N", text);
    thr_text_append(text, " at every end");
  }
}

/* Appends the lines for people. */
static void put_text(const rise_runs *runs, thr_text *text)
{
  const thr_rise_record *record = &runs->record[0];
  const thr_rise_moment *last = &record->moment[record->held ? record->held - 1 : 0];
  put_title(runs, text);
  thr_text_append(text, "\n");
  put_outcome(runs, text);
  thr_text_printf(text,
                  "\n%d of %d faces closed, highest node at %.3g mm, %.3g mm of cord drawn in\n",
                  record->most_closed, record->n_counted, last->height, last->drawn);
  if (record->most_closed < record->n_counted) {
    const char *name[2] = {"", ""};
    pieces_of(runs, record->loosest, name);
    thr_text_printf(text, "the widest gap stays between %s and %s\n", name[0], name[1]);
  }
  if (runs->seated > 0 && isfinite(runs->seated))
    thr_text_printf(text, "by the closed form %.3g N seat every pass", runs->seated);
  if (runs->stands > 0 && isfinite(runs->stands))
    thr_text_printf(text, "; by limit analysis it stands from %.3g N on", runs->stands);
  if (runs->seated > 0) thr_text_append(text, "\n");
  thr_text_append(text, "differs from the drawn shape by ");
  put_spread(runs, off_of, "mm at most", text);
  thr_text_append(text, "\n");
  if (runs->args->rise.let_down) {
    if (record->fell >= 0) {
      thr_text_append(text, "let down, it falls below ");
      put_spread(runs, pull_down, "N", text);
      thr_text_append(text, "\n");
    } else
      thr_text_append(text, "let down, it does not fall\n");
  }
}

/* Writes angles in degrees. */
static void write_degrees(thr_writer *writer, const char *key, const double *angle, int n)
{
  thr_write_row(writer, key);
  for (int i = 0; i < n; i++)
    thr_write_printf(writer, NULL, "%.4g", angle[i] * 180 / THR_PI);
  thr_write_close(writer);
}

/* Writes the moments of a run, and with `motion` the place of every piece. */
static void write_run(thr_writer *writer, const rise_runs *runs, int i, bool motion)
{
  const thr_rise_record *record = &runs->record[i];
  thr_write_object(writer, NULL);
  thr_write_int(writer, "seed", runs->args->first_seed + i);
  thr_write_bool(writer, "came_up", record->came_up >= 0);
  if (record->came_up >= 0) thr_write_number(writer, "pull_up", pull_up(record));
  if (record->fell >= 0) thr_write_number(writer, "pull_down", pull_down(record));
  thr_write_int(writer, "most_closed", record->most_closed);
  thr_write_number(writer, "off", record->off);
  write_degrees(writer, "kink", record->kink, record->n_passes);
  write_degrees(writer, "twist", record->twist, record->n_passes);

  thr_write_array(writer, "moments");
  for (int f = 0; f < record->n_frames; f++) {
    const thr_rise_moment *moment = &record->moment[f];
    thr_write_row(writer, NULL);
    thr_write_printf(writer, NULL, "%.6g", moment->time);
    thr_write_printf(writer, NULL, "%.6g", moment->pull);
    thr_write_printf(writer, NULL, "%.6g", moment->drawn);
    thr_write_int(writer, NULL, moment->closed);
    thr_write_printf(writer, NULL, "%.6g", moment->height);
    thr_write_printf(writer, NULL, "%.6g", moment->lift);
    thr_write_close(writer);
  }
  thr_write_close(writer);

  if (motion && record->pose) {
    thr_write_array(writer, "frames");
    for (int f = 0; f < record->n_frames; f++) {
      const double *pose = record->pose[(size_t)f * (size_t)record->n_pieces];
      thr_write_row(writer, NULL);
      for (int k = 0; k < 7 * record->n_pieces; k++)
        thr_write_printf(writer, NULL, "%.6g", pose[k]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

/* Appends everything as JSON. */
static void put_json(const rise_runs *runs, bool motion, thr_text *text)
{
  const thr_rise_record *record = &runs->record[0];
  thr_writer writer = {.out = text};
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "start", thr_rise_start_name(runs->args->rise.start));
  thr_write_int(&writer, "pieces", record->n_pieces);
  thr_write_int(&writer, "faces", record->n_counted);
  thr_write_number(&writer, "weight", record->weight);
  thr_write_number(&writer, "seconds_a_frame", record->between);
  thr_write_number(&writer, "closed_form", runs->seated);
  thr_write_number(&writer, "limit_analysis", runs->stands);
  thr_write_array(&writer, "runs");
  for (int i = 0; i < runs->n_runs; i++)
    write_run(&writer, runs, i, motion);
  thr_write_close(&writer);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* Draws the plot. */
static int write_plot(const rise_runs *runs, const char *name)
{
  thr_err err = {0};
  thr_text svg = {0};
  thr_scratch own = {0};
  thr_rise_line *line = thr_scratch_array(&own, (size_t)runs->n_runs, sizeof *line);
  thr_status st = thr_scratch_check(&own, &err);
  for (int r = 0; r < runs->n_runs && !st; r++) {
    const thr_rise_record *record = &runs->record[r];
    const size_t n = (size_t)record->n_frames;
    double *value = thr_scratch_array(&own, 3 * n, sizeof *value);
    st = thr_scratch_check(&own, &err);
    if (st) break;
    line[r] = (thr_rise_line){record->held, value, value + n, value + 2 * n};
    for (size_t i = 0; i < n; i++) {
      value[i] = record->moment[i].drawn;
      value[n + i] = record->moment[i].pull;
      value[2 * n + i] = (double)record->moment[i].closed / record->n_counted;
    }
  }
  const thr_rise_chart chart = {
      name, &runs->made.structure.physics, runs->seated, runs->stands, runs->n_runs, line};
  if (!st) st = thr_rise_svg(&chart, &svg, &err);
  thr_scratch_free(&own);
  return cli_write_drawn(st, &svg, runs->args->plot, &err);
}

/* Writes the first run as a film. Returns an exit code. */
static int write_film(const rise_runs *runs)
{
  const rise_arguments *args = runs->args;
  const thr_limits limits = cli_limits(0);
  const thr_film_options options = {.size = {args->size[0], args->size[1]}};
  thr_err err = {0};
  thr_movement movement;
  thr_film *film = NULL;
  thr_text png = {0};
  const int code = args->frames ? cli_make_folder(args->frames) : EXIT_SUCCESS;
  if (code) return code;

  thr_status st = thr_rise_movement(&movement, runs->kit, &runs->record[0], &err);
  if (!st) st = thr_film_open(&film, runs->kit, &movement, &options, &err);
  if (!st) st = thr_film_write(film, args->frames, args->film ? &png : NULL, &limits, &err);
  cli_progress_end();
  thr_film_close(film);
  thr_movement_destroy(&movement);
  if (args->film) return cli_write_drawn(st, &png, args->film, &err);
  return st ? cli_fail(&err) : EXIT_SUCCESS;
}

/* Writes the viewer that plays the first run. Returns an exit code. */
static int write_viewer(const rise_runs *runs)
{
  const thr_limits limits = cli_limits(0);
  thr_err err = {0};
  thr_movement movement;
  thr_text title = {0}, note = {0}, moves = {0}, pieces = {0}, page = {0};
  put_title(runs, &title);
  put_outcome(runs, &note);

  thr_status st = thr_rise_movement(&movement, runs->kit, &runs->record[0], &err);
  if (!st && (title.failed || note.failed)) st = thr_nomem(&err);
  if (!st) st = thr_kit_moves(runs->kit, &movement, title.data, note.data, &moves, &err);
  if (!st) thr_kit_viewer(runs->kit, &moves, &pieces);
  if (!st && pieces.failed) st = thr_nomem(&err);
  const thr_document_options how = {.kit = &pieces,
                                    .kind_tolerance = runs->args->kit.kind_tolerance};
  if (!st)
    st = thr_document_make(runs->kit->plan, thr_document_find("html"), &how, &limits, &page, &err);
  cli_progress_end();
  thr_movement_destroy(&movement);
  thr_text_destroy(&title);
  thr_text_destroy(&note);
  thr_text_destroy(&moves);
  thr_text_destroy(&pieces);
  return cli_write_drawn(st, &page, runs->args->play, &err);
}

/* Prints and writes what was seen. Returns an exit code. */
static int tell(const rise_runs *runs)
{
  thr_err err = {0};
  thr_text text = {0};
  int code = EXIT_SUCCESS;
  if (runs->args->output) {
    put_json(runs, true, &text);
    code = cli_write_drawn(THR_OK, &text, runs->args->output, &err);
    if (code) return code;
  }
  if (runs->args->plot) {
    code = write_plot(runs, runs->args->path);
    if (code) return code;
  }
  if (runs->args->film || runs->args->frames) {
    code = write_film(runs);
    if (code) return code;
  }
  if (runs->args->play) {
    code = write_viewer(runs);
    if (code) return code;
  }
  text = (thr_text){0};
  if (runs->args->json)
    put_json(runs, false, &text);
  else
    put_text(runs, &text);
  return cli_write(&text, "-");
}

/* ---- the runs ---- */

/* Runs seed first_seed + 1 + job in a process of its own. Signature of thr_work.run. */
static thr_status run_job(void *user, int job, void *result, thr_err *err)
{
  const rise_runs *runs = user;
  rise_result *out = result;
  thr_rise_options options = runs->options;
  thr_rise_record record;
  options.seed += (uint64_t)job + 1;
  thr_status st = thr_rise_simulate(&runs->made.structure, &options, NULL, &record, err);
  if (!st) {
    out->record = record;
    if (record.n_frames > MOST_MOMENTS) out->record.n_frames = MOST_MOMENTS;
    memcpy(out->moment, record.moment, (size_t)out->record.n_frames * sizeof *out->moment);
    for (int i = 0; i < record.n_passes; i++) {
      out->angle[i] = record.kink[i];
      out->angle[record.n_passes + i] = record.twist[i];
    }
    out->record.kink = out->record.twist = NULL;
    out->record.moment = NULL;
    out->record.pose = NULL;
    out->record.tension = NULL;
  }
  thr_rise_record_destroy(&record);
  return st;
}

/* Runs all seeds but the first in parallel processes. Those that are finished follow each other. */
static thr_status run_others(rise_runs *runs, const thr_limits *limits, thr_err *err)
{
  const int n = runs->args->seeds - 1;
  const thr_work work = {.n_jobs = n,
                         .result_size = result_size(runs),
                         .run = run_job,
                         .user = runs,
                         .what = "simulating",
                         .advice = "fewer --seeds"};
  char *result = thr_calloc((size_t)n, result_size(runs));
  bool *finished = thr_calloc((size_t)n, sizeof *finished);
  thr_status st = result && finished
                      ? thr_workers_run(&work, cli_processes(), limits, result, finished, err)
                      : thr_nomem(err);
  for (int i = 0; i < n && result && finished; i++) {
    thr_rise_record *record = &runs->record[runs->n_runs];
    if (!finished[i]) continue;
    const rise_result *seen = (const void *)(result + (size_t)i * result_size(runs));
    const size_t frames = (size_t)seen->record.n_frames, passes = (size_t)seen->record.n_passes;
    *record = seen->record;
    record->moment = thr_calloc(frames, sizeof *record->moment);
    record->kink = thr_calloc(passes, sizeof *record->kink);
    record->twist = thr_calloc(passes, sizeof *record->twist);
    if (!record->moment || !record->kink || !record->twist) {
      thr_rise_record_destroy(record);
      st = thr_nomem(err);
      break;
    }
    memcpy(record->moment, seen->moment, frames * sizeof *record->moment);
    memcpy(record->kink, seen->angle, passes * sizeof *record->kink);
    memcpy(record->twist, seen->angle + passes, passes * sizeof *record->twist);
    runs->n_runs++;
  }
  free(result);
  free(finished);
  return st;
}

/* What the closed form says of the cords, and the limit analysis of these very pieces in their
 * closed shape, N at every end. */
static void foretell(rise_runs *runs, const thr_plan *plan, const thr_limits *limits)
{
  thr_err err = {0};
  thr_bodies bodies;
  const bool known = !thr_kit_bodies(runs->kit, &bodies, &err);
  err = (thr_err){0};
  runs->seated = runs->stands = NAN;
  for (int method = 0; method < 2; method++) {
    thr_eval eval;
    thr_eval_options options = thr_eval_options_default();
    options.physics = plan->options.physics;
    options.pull = THR_PULL_BOTH;
    options.dynamics = false;
    if (method == 1 && (!known || plan->frame.n_nodes > THR_HOLDS_LARGEST)) break;
    if (method == 1) options.bodies = &bodies;
    if (!thr_eval_plan(&plan->frame, plan->cord, plan->n_cords,
                       method ? THR_STRUCTURE : THR_CAPSTAN, &options, limits, &eval, &err)) {
      if (method)
        runs->stands = eval.equal.present ? eval.equal.lower : eval.holding.lower;
      else
        runs->seated = eval.record.largest;
    }
    thr_eval_destroy(&eval);
    err = (thr_err){0};
  }
  thr_scratch_free(&bodies.own);
}

/* Runs all seeds, and tells what was seen. Returns an exit code. */
static int run_all(rise_runs *runs, const thr_plan *plan)
{
  const rise_arguments *args = runs->args;
  thr_err err = {0};
  thr_limits limits = cli_limits(0);
  double weight = 0;
  for (int p = 0; p < runs->made.structure.n_pieces; p++)
    weight += 1e-3 * runs->made.structure.piece[p].mass * runs->made.structure.physics.gravity;
  runs->options = args->rise;
  runs->options.seed = (uint64_t)args->first_seed;
  int code = take_lift(args, runs->kit, weight, &runs->options);
  if (code >= 0) return code;

  foretell(runs, plan, &limits);
  thr_status st =
      thr_rise_simulate(&runs->made.structure, &runs->options, &limits, &runs->record[0], &err);
  if (!st || (st == THR_ELIMIT && runs->record[0].held)) runs->n_runs = 1;
  if (!st && args->seeds > 1) st = run_others(runs, &limits, &err);
  cli_progress_end();
  if (runs->n_runs == 0) return cli_fail(&err);
  code = tell(runs);
  if (!st) return code;
  const int failed = cli_fail(&err);
  return code ? code : failed;
}

/* The next word of a list with commas, which is cut up; NULL: there is none. */
static char *next_word(char **rest)
{
  char *word = *rest, *comma = word ? strchr(word, ',') : NULL;
  if (comma) *comma = 0;
  *rest = comma ? comma + 1 : NULL;
  return word;
}

/* The cord of this name; -1, and prints so. */
static int cord_named(const thr_plan *plan, const char *option, const char *name)
{
  char id[12];
  for (int c = 0; c < plan->n_cords; c++) {
    thr_cord_id(c, id);
    if (strcmp(id, name) == 0) return c;
  }
  cli_usage("rise", "--%s %s: the plan has no such cord", option, name);
  return -1;
}

/* Does one word of what --slack, --held, --shape or --lay lists. Returns EXIT_SUCCESS or prints and
 * returns an exit code. */
static int take_word(rise_runs *runs, const char *option, char *word)
{
  thr_err err = {0};
  char *file = strcmp(option, "shape") == 0 ? strchr(word, '=') : NULL;
  const bool lay = strcmp(option, "lay") == 0;
  int which = 0;
  if (file) *file++ = 0;
  if (!file && strcmp(option, "shape") == 0)
    return cli_usage("rise", "--shape %s: expected a cord and a framework, as B=corner.json", word);
  if (strcmp(option, "held") == 0) {
    which = piece_named(runs->kit, word);
    if (which < 0) return cli_usage("rise", "--held %s: the plan has no such piece", word);
    runs->made.piece[which].held = true;
    return EXIT_SUCCESS;
  }
  if (!lay && (which = cord_named(runs->kit->plan, option, word)) < 0) return EXIT_USAGE;
  if (!lay && !file) {
    runs->made.cord[which].slack = true;
    return EXIT_SUCCESS;
  }

  const cli_frame_args usual = cli_frame_args_default();
  thr_frame frame;
  const int code = cli_read_frame(lay ? word : file, &usual, &frame);
  if (code) return code;
  const thr_status st = lay ? thr_rise_kit_lay(&runs->made, runs->kit, &frame, &err)
                            : thr_rise_kit_shape(&runs->made, runs->kit, which, &frame, &err);
  thr_frame_destroy(&frame);
  return st ? cli_fail(&err) : EXIT_SUCCESS;
}

/* Does what --slack, --held, --shape and --lay say of single cords and pieces. Returns EXIT_SUCCESS
 * or prints and returns an exit code. */
static int take_lists(rise_runs *runs)
{
  const struct {
    const char *option, *text;
  } list[] = {{"slack", runs->args->slack},
              {"held", runs->args->held},
              {"shape", runs->args->shape},
              {"lay", runs->args->lay}};
  int code = EXIT_SUCCESS;
  for (size_t i = 0; i < sizeof list / sizeof *list && !code; i++) {
    thr_text text = {0};
    if (!list[i].text) continue;
    thr_text_append(&text, list[i].text);
    char *rest = text.data;
    if (text.failed) {
      thr_err err = {0};
      thr_nomem(&err);
      code = cli_fail(&err);
    }
    for (char *word = next_word(&rest); word && !code; word = next_word(&rest))
      code = take_word(runs, list[i].option, word);
    thr_text_destroy(&text);
  }
  return code;
}

/* Makes the kit of a plan, and what rises from it. Returns an exit code. */
static int make_and_run(const rise_arguments *args, const thr_plan *plan)
{
  thr_err err = {0};
  thr_kit kit;
  rise_runs runs = {.args = args, .kit = &kit};
  thr_physics physics;
  thr_limits limits = cli_limits(0);
  thr_pull *pull = thr_calloc((size_t)plan->n_cords, sizeof *pull);
  runs.record = thr_calloc((size_t)args->seeds, sizeof *runs.record);
  for (int c = 0; c < plan->n_cords && pull; c++)
    pull[c] = THR_PULL_BOTH;

  thr_status st = thr_kit_make(&kit, plan, &args->kit, NULL, true, &limits, &err);
  if (!st && (!pull || !runs.record)) st = thr_nomem(&err);
  if (!st) st = thr_physics_resolve(&plan->options.physics, &plan->frame, &physics, &err);
  if (!st) st = thr_rise_kit_make(&runs.made, &kit, pull, &physics, &err);
  int code = st ? cli_fail(&err) : take_lists(&runs);
  if (!code) code = run_all(&runs, plan);

  for (int i = 0; i < args->seeds && runs.record; i++)
    thr_rise_record_destroy(&runs.record[i]);
  free(runs.record);
  free(pull);
  thr_rise_kit_destroy(&runs.made);
  thr_kit_destroy(&kit);
  return code;
}

/* Runs `thread rise` and returns the exit code. */
int cmd_rise(int argc, char **argv)
{
  static const cli_syntax syntax = {"rise", intro, outro};
  rise_arguments asked = {.guard = guard_limits_default(),
                          .rise = {.pull = HAND},
                          .kit = {.names = THR_KIT_NO_NAMES, .coarse = COARSE},
                          .seeds = 1,
                          .first_seed = 1};
  guard_end end;
  const cli_group groups[] = {
      {"Options", own_options, &asked},    {"Shape", shape_options, &asked},
      {NULL, guard_options, &asked.guard}, {NULL, cli_processes_options, NULL},
      {cli_tuned, tuned_options, &asked},  {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  if (optind + 1 != argc)
    return cli_usage("rise", optind == argc ? "which plan?" : "one plan at a time");
  if (asked.lift && asked.raise) return cli_usage("rise", "--lift or --raise, not both");
  asked.path = argv[optind];
  asked.rise.start = asked.lay ? THR_RISE_LAID : (thr_rise_start)asked.start;
  asked.rise.iterations = (int)asked.iterations;

  /* The child does all of the work. */
  if (guard_fork(&asked.guard, &end)) return guard_conclude(&end, "nothing was seen");

  thr_plan plan;
  code = cli_read_plan(argv[optind], &plan);
  if (code) return code;
  code = make_and_run(&asked, &plan);
  thr_plan_destroy(&plan);
  return code;
}
