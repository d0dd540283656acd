/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread rise: lets the pieces of a plan rise in simulation, as their cords are pulled
 * (eval/rise/rise.h), and says whether they come up, at what pull, and where they jam.
 *
 * Pieces are those of `thread kit`. Several seeds are several runs: one run is no fact.
 *
 * Example: `thread rise data/dome7-lines.json` lays 49 pieces flat on the ground, pulls 28 ends,
 * and the dome stands at some 1.3 N. */
#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "diagram/export/paper.h"
#include "diagram/overview/charts.h"
#include "diagram/scene/movement.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/io/read.h"
#include "graph/number.h"
#include "graph/plan/physics.h"
#include "graph/process/process.h"
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
    "  thread rise plan.json --let-down              and down again, until it falls\n"
    "  thread rise plan.json --stiffness 500 --schedule \"all: pull both 5; all: knot both\"\n"
    "                                                pulled, knotted: does it stand?\n"
    "  thread rise plan.json --play up.html          the viewer, which plays it\n";
static const char outro[] =
    "Exit codes: 0 all was seen, whether it comes up or not, 2 usage, 3 not a plan or nothing that "
    "can be simulated, 5 not done in the time or memory (what was seen is printed)";

enum { STILLS = 4 };
static const double SHAKEN = 3;                        /* s */
static const double MOST_SHAKE = 1000, MOST_BEAT = 50; /* mm, 1/s: as time steps can follow */
static const double LIFTING = 2; /* of the structure's weight, that a hand carries at most */

/* What was asked. */
typedef struct {
  thr_rise_options rise;
  thr_kit_options kit;
  guard_limits guard;
  const char *lift, *raise, *dent, *lay, *held, *shape, *slack;
  const char *output, *plot, *film, *frames, *play, *booklet;
  const char *path;
  const char *schedule;
  int seeds, first_seed, start, ends, feet, size[2], page;
  double time_step, iterations;
  double stiffness, gravity; /* N, m/s2; NAN: as the plan says */
  bool let_down, progress;
} rise_arguments;

#define AT(member) .offset = offsetof(rise_arguments, member)

/* Takes "640x480". */
static bool take_size(void *into, const cli_option *option, const char *value)
{
  return cli_pixels("rise", option->name, value, 64, 4000, ((rise_arguments *)into)->size);
}

/* Takes "5@8" or "5mm@8Hz". */
static bool take_shake(void *into, const cli_option *option, const char *value)
{
  thr_rise_options *rise = &((rise_arguments *)into)->rise;
  const char *at = strchr(value, '@');
  char far[40];
  (void)option;

  snprintf(far, sizeof far, "%.*s", at ? (int)(at - value) : 0, value);
  if (at && !thr_quantity_read(far, "mm", &rise->shake, NULL) &&
      !thr_quantity_read(at + 1, "Hz", &rise->beat, NULL) && rise->shake > 0 &&
      rise->shake <= MOST_SHAKE && rise->beat > 0 && rise->beat <= MOST_BEAT)
    return true;

  cli_usage("rise",
            "--shake %s: expected mm to and fro, up to %g, @ and times a second, up to %g, as "
            "5@8",
            value, MOST_SHAKE, MOST_BEAT);
  return false;
}

static const char *feet_meaning(int feet)
{
  static const char *const meaning[] = {"stand on the ground as all pieces do, slide, and lift off",
                                        "slide on the ground, but neither lift off nor tip",
                                        "stay where they are drawn"};
  return meaning[feet];
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
    {"ends", .kind = CLI_WORD, AT(ends), .word = thr_pull_name, .n_words = THR_PULL_NONE,
     .help = "which ends of every cord hands pull; the others are tied (default: both)"},
    {"rate", .value = "MM/S", .kind = CLI_AMOUNT, AT(rise.rate), .low = CLI_ABOVE_0, .high = 1e6,
     .help = "a hand draws in so many mm a second, and pulls as hard as that takes, but no harder "
             "than --pull"},
    {"spare", .value = "MM", .kind = CLI_AMOUNT, AT(rise.spare), .low = CLI_ABOVE_0, .high = 1e9,
     .help = "so much of every cord lies beyond its structure at the start, and hands give out no "
             "more (default: any)"},
    {"schedule", .value = "TEXT", .kind = CLI_OUTPUT, AT(schedule),
     .help = "what hands do to the cords, step after step, as for thread eval; or a file of that: "
             "\"all: pull both 5; A: release end 1; all: knot both\". Cords stretch then: "
             "--stiffness"},
    {"feet", .kind = CLI_WORD, AT(feet), .word = thr_rise_feet_name, .meaning = feet_meaning,
     .n_words = THR_RISE_N_FEET, .help = "what the plan's feet can do (default: free)"},
    {"stiffness", .value = "N", .kind = CLI_AMOUNT, AT(stiffness), .low = CLI_ABOVE_0, .high = 1e12,
     .help = "EA of the cords: the force that would stretch them to twice their length (default: "
             "as the plan says)"},
    {"gravity", .value = "M/S2", .kind = CLI_AMOUNT, AT(gravity), .low = 0, .high = 1000,
     .help = "0: only what begins in its shape (default: as the plan says)"},
    {"slower", .value = "X", .kind = CLI_AMOUNT, AT(rise.slower), .low = 0.01, .high = 1000,
     .help = "hands take X times as long"},
    {"let-down", .kind = CLI_FLAG, AT(rise.let_down),
     .help = "and let the cords go again, until it falls"},
    {"lift", .value = "NODE=N", .kind = CLI_TEXT, AT(lift),
     .help = "a counterweight lifts this piece with so many newtons"},
    {"raise", .value = "NODE", .kind = CLI_TEXT, AT(raise),
     .help = "a hand carries this piece to its height, and no higher"},
    {"dent", .value = "NODE=N", .kind = CLI_TEXT, AT(dent),
     .help = "while the pull is held, a hand pushes this piece inwards with so many newtons, and "
             "lets it go: how far the shape was dented, and is afterwards"},
    {"shake", .value = "MM@HZ", .kind = CLI_OTHER, .take = take_shake,
     .help = "once the pull is held, the ground and what is held go to and fro by so much, so many "
             "times a second, each time in a direction by chance"},
    {"shaking", .value = "S", .kind = CLI_AMOUNT, AT(rise.shaken), .low = CLI_ABOVE_0, .high = 1e4,
     .help = "for so many seconds, then all rests (default: 3)"},
    {"seeds", .value = "N", .kind = CLI_COUNT, AT(seeds), .low = 1, .high = THR_RISE_MOST_SEEDS,
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
    {"booklet", .value = "FILE.pdf", .kind = CLI_OUTPUT, AT(booklet),
     .help =
         "the step sheets with stills of it on the page that says how to pull tight; as HTML if "
         "FILE ends in .html"},
    {"page", .kind = CLI_WORD, AT(page), .word = thr_page_name, .n_words = THR_N_PAGES,
     .help = "paper of the booklet (default: a4)"},
    {"progress", .kind = CLI_FLAG, AT(progress),
     .help = "a line of JSON on stderr each time more is simulated or drawn"},
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
  thr_rise_pieces pieces;
  thr_rise_options options; /* of the first run */
  int n_runs;
  thr_rise_record *record; /* [seeds] of which n_runs are done; only the first has poses */
  thr_eval after;          /* what the closed form says that the schedule leaves */
} rise_runs;

/* The piece with this name, as documents call it or as the framework does; -1. */
static int piece_named(const thr_kit *kit, const char *name)
{
  for (int p = 0; p < kit->n_pieces; p++)
    if (strcmp(kit->name[p], name) == 0) return p;
  return thr_frame_find(&kit->plan->frame, name);
}

/* Reads a piece and, unless newton is NULL, a force from an option's "D4=2". Returns -1, or an exit
 * code. */
static int take_force(const char *option, const char *words, const thr_kit *kit, int *piece,
                      double *newton)
{
  char name[64];
  const char *equals = newton ? strrchr(words, '=') : words + strlen(words);
  if (!equals)
    return cli_usage("rise", "--%s %s: expected a piece and newtons, as D4=2", option, words);
  snprintf(name, sizeof name, "%.*s", (int)(equals - words), words);
  *piece = piece_named(kit, name);
  if (*piece < 0) return cli_usage("rise", "%s: the plan has no such piece", name);
  if (!newton) return -1;

  size_t n = strlen(equals + 1);
  if (n > 1 && equals[n] == 'N') n--;
  if (!thr_number_parse(equals + 1, n, newton) || !(*newton > 0))
    return cli_usage("rise", "--%s %s: expected newtons above 0 after the =, as D4=2", option,
                     words);
  return -1;
}

/* Reads which pieces hands lift and push. weight: N. Returns -1, or an exit code. */
static int take_hands(const rise_arguments *args, const thr_kit *kit, double weight,
                      thr_rise_options *options)
{
  int code = -1;
  options->carried = args->raise != NULL;
  if (args->raise) {
    options->lift = LIFTING * weight;
    code = take_force("raise", args->raise, kit, &options->lifted, NULL);
  }
  if (args->lift) code = take_force("lift", args->lift, kit, &options->lifted, &options->lift);
  if (code < 0 && args->dent)
    code = take_force("dent", args->dent, kit, &options->dented, &options->dent);
  return code;
}

/* ---- what is said ---- */

static double off_of(const thr_rise_record *record)
{
  return record->off;
}

static double dented_of(const thr_rise_record *record)
{
  return record->dented;
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
  double value[THR_RISE_MOST_SEEDS], spread[3];
  for (int i = 0; i < runs->n_runs; i++)
    value[i] = of(&runs->record[i]);
  thr_rise_spread(value, runs->n_runs, spread);

  char middle[THR_PLAIN_NUMBER], least[THR_PLAIN_NUMBER], most[THR_PLAIN_NUMBER];
  thr_plain_number(spread[runs->n_runs == 1 ? 0 : 1], 3, middle);
  if (runs->n_runs == 1)
    thr_text_printf(text, "%s %s", middle, unit);
  else
    thr_text_printf(text, "%s %s (%s to %s)", middle, unit, thr_plain_number(spread[0], 3, least),
                    thr_plain_number(spread[2], 3, most));
}

/* Appends how what has closed, but not come up, lies there; nothing if there is no such run. */
static void put_lying(const rise_runs *runs, thr_text *text)
{
  double tilt[THR_RISE_MOST_SEEDS], spread[3];
  int n = 0;
  for (int i = 0; i < runs->n_runs; i++) {
    const thr_rise_record *record = &runs->record[i];
    if (record->closed >= 0 && record->came_up < 0)
      tilt[n++] = thr_degrees(record->moment[record->held - 1].tilt);
  }
  if (n == 0) return;
  thr_rise_spread(tilt, n, spread);
  if (runs->n_runs > 1)
    thr_text_printf(text, "in %d %s all faces closed, but it does not stand upright: ", n,
                    cli_plural(n, "run", "runs"));
  else
    thr_text_printf(text, "all its faces closed, but it %s, ",
                    spread[0] < 60    ? "leans over"
                    : spread[0] < 120 ? "lies on its side"
                                      : "lies upside down");
  if (n == 1)
    thr_text_printf(text, "%.0f degrees over\n", spread[0]);
  else
    thr_text_printf(text, "%.0f (%.0f to %.0f) degrees over\n", spread[1], spread[0], spread[2]);
}

/* Appends whether it stands after the schedule, and what tension is left in each cord, beside what
 * the closed form says. */
static void put_after(const rise_runs *runs, thr_text *text)
{
  const thr_rise_record *record = &runs->record[0];
  const double *left = record->tension + (size_t)(record->n_frames - 1) * (size_t)record->n_passes;
  int standing = 0;
  if (!record->finished) {
    thr_text_append(text, "the schedule was not done to its end\n");
    return;
  }
  for (int i = 0; i < runs->n_runs; i++)
    standing += runs->record[i].stands;
  if (runs->n_runs > 1)
    thr_text_printf(text, "after the schedule it stands in %d of %d runs\n", standing,
                    runs->n_runs);
  else
    thr_text_printf(text, "after the schedule it %s\n", standing ? "stands" : "does not stand");

  for (int c = 0; c < runs->pieces.made.structure.n_cords; c++) {
    const thr_eval_cord *cord = &runs->after.record.cord[c];
    double range[2][2] = {{INFINITY, 0}, {INFINITY, 0}};
    for (int k = 0; k < cord->n_passes; k++)
      for (int i = 0; i < 2; i++) {
        const double tension = i ? cord->tension[k] : left[k];
        range[i][0] = fmin(range[i][0], tension);
        range[i][1] = fmax(range[i][1], tension);
      }
    thr_text_printf(text, "cord %s keeps %.3g to %.3g N; by the closed form %.3g to %.3g N\n",
                    runs->pieces.kit.plan->cord[c].id, range[0][0], range[0][1], range[1][0],
                    range[1][1]);
    left += cord->n_passes;
  }
}

/* Appends what rises and from where. */
static void put_title(const rise_runs *runs, thr_text *text)
{
  const thr_rise_structure *structure = &runs->pieces.made.structure;
  const thr_rise_record *record = &runs->record[0];
  const thr_rise_options *options = &runs->args->rise;
  char weight[THR_PLAIN_NUMBER];
  int ends = 0;
  for (int c = 0; c < structure->n_cords; c++)
    ends +=
        structure->cord[c].slack ? 0 : structure->cord[c].pulled[0] + structure->cord[c].pulled[1];
  thr_text_printf(text, "%d pieces that weigh %s N, %d %s ", structure->n_pieces,
                  thr_plain_newtons(record->weight, weight), structure->n_cords,
                  cli_plural(structure->n_cords, "cord", "cords"));
  if (runs->args->schedule)
    thr_text_append(text, "pulled by a schedule");
  else
    thr_text_printf(text, "pulled at %d %s", ends, cli_plural(ends, "end", "ends"));
  thr_text_printf(text, ", %s",
                  options->start == THR_RISE_FLAT   ? "from flat on the ground"
                  : options->start == THR_RISE_HEAP ? "from a heap"
                  : options->start == THR_RISE_LAID ? "from where it is laid"
                                                    : "from its shape");
  if (options->shaken > 0)
    thr_text_printf(text, ", then shaken for %.3g s by %.3g mm, %.3g times a second",
                    options->shaken, options->shake, options->beat);
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
    put_spread(runs, thr_rise_pull_up, "N", text);
    thr_text_append(text, runs->args->schedule                ? ", the largest pull by then"
                          : runs->args->rise.rate > 0         ? " at the end that is pulled hardest"
                          : runs->args->ends == THR_PULL_BOTH ? " at every end"
                                                              : " at one end of every cord");
  }
}

/* Appends what the pull of the rise does, and why the plan has another one: that seats the cords of
 * the closed shape, and knows no weight. Nothing where the closed form is not known. */
static void put_pulls(const rise_runs *runs, thr_text *text)
{
  const thr_rise_pieces *pieces = &runs->pieces;
  const bool up = 2 * count_up(runs) > runs->n_runs,
             shape = runs->args->rise.start == THR_RISE_SHAPE;
  char seated[THR_PLAIN_NUMBER], force[THR_PLAIN_NUMBER];
  if (!(pieces->seated > 0 && isfinite(pieces->seated))) return;

  if (!runs->args->schedule) {
    if (up)
      put_spread(runs, thr_rise_pull_up, "N", text);
    else
      thr_text_printf(text, "%s N", thr_plain_newtons(runs->args->rise.pull, force));
    thr_text_printf(text, " %s the pieces, which weigh %s N; ",
                    shape ? (up ? "hold" : "do not hold")
                    : up  ? "lift and turn"
                          : "do not lift and turn all of",
                    thr_plain_newtons(runs->record[0].weight, force));
  }
  thr_text_printf(text,
                  "%s, %s N, leaves %.3g N in every pass once all is closed, against friction "
                  "alone (closed form)",
                  pieces->ends == THR_PULL_BOTH ? "the plan's pull" : "the pull that seats cords",
                  thr_plain_newtons(pieces->seated, seated),
                  pieces->made.structure.physics.seating);
  if (pieces->stands > 0 && isfinite(pieces->stands))
    thr_text_printf(text, "; below %s N it cannot stand while cords are drawn in (limit analysis)",
                    thr_plain_newtons(pieces->stands, force));
  thr_text_append(text, "\n");
}

/* Returns half of the arms' width, or what their channels and walls leave of that, mm. */
static double narrower(const thr_kit *kit)
{
  double width = kit->options.width / 2;
  for (int e = 0; e < kit->plan->frame.n_edges; e++)
    width = fmax(width, kit->edges.edge[e].bore + 2 * kit->options.wall);
  return width;
}

/* Appends what may help in words, and as an option. */
static void put_remedy(const rise_runs *runs, const thr_rise_jam *jam, thr_rise_remedy remedy,
                       thr_text *text)
{
  const thr_kit *kit = &runs->pieces.kit;
  const double width = narrower(kit);
  char number[THR_PLAIN_NUMBER];
  thr_text_printf(text, "%s (", thr_rise_remedy_words(remedy));
  switch (remedy) {
  case THR_RISE_LIGHTER:
    if (width < kit->options.width && kit->options.channels == THR_KIT_BORE)
      thr_text_printf(text, "--width %s", thr_plain_number(1.01 * width, 3, number));
    else
      thr_text_append(text, "thread convert --scale");
    break;
  case THR_RISE_CARRY: thr_text_printf(text, "--raise %s", kit->name[jam->top]); break;
  case THR_RISE_MORE_CORDS:
    thr_text_printf(text, "thread plan --cords %d", 2 * kit->plan->n_cords);
    break;
  case THR_RISE_MORE_PULL:
    thr_text_printf(text, "--pull %s", thr_plain_number(3 * jam->pull, 3, number));
    break;
  case THR_RISE_SHAKE: thr_text_append(text, "--shake 3mm@10Hz"); break;
  case THR_RISE_ANOTHER_SEED: thr_text_append(text, "--seeds 5"); break;
  case THR_RISE_LAY_FLAT: thr_text_append(text, "--start flat"); break;
  }
  thr_text_append(text, ")\n");
}

/* Appends why the first run did not come up, and what may help; nothing if its faces closed. */
static void put_jam(const rise_runs *runs, thr_text *text)
{
  thr_rise_jam jam;
  char left[THR_PLAIN_NUMBER], pull[THR_PLAIN_NUMBER], each[THR_PLAIN_NUMBER];
  const thr_rise_record *record = &runs->record[0];
  if (!thr_rise_jam_find(&runs->pieces, record, &runs->options, &jam)) return;

  thr_text_printf(text, "in the end %d %s open", jam.open,
                  cli_plural(jam.open, "face is", "faces are"));
  if (runs->pieces.kit.plan->n_cords > 1)
    thr_text_printf(text, ", %d of them on cord %s", jam.on_cord,
                    runs->pieces.kit.plan->cord[jam.cord].id);
  thr_text_printf(
      text,
      "; of %s N at the ends %s N are left in the slackest of these, and a piece weighs "
      "%s N\n",
      thr_plain_newtons(jam.pull, pull), thr_plain_newtons(jam.tension, left),
      thr_plain_newtons(record->weight / record->n_pieces, each));
  for (int i = 0; i < jam.n; i++) {
    thr_text_append(text, i ? "or  " : "try ");
    put_remedy(runs, &jam, jam.remedy[i], text);
  }
}

/* Appends the lines for people. */
static void put_text(const rise_runs *runs, thr_text *text)
{
  const thr_rise_record *record = &runs->record[0];
  const thr_rise_moment *last = &record->moment[record->held ? record->held - 1 : 0];
  char height[THR_PLAIN_NUMBER], drawn[THR_PLAIN_NUMBER];
  put_title(runs, text);
  thr_text_append(text, "\n");
  put_outcome(runs, text);
  thr_text_printf(
      text, "\n%d of %d faces closed%s, one a pass, highest node at %s mm, %s mm of cord %s\n",
      record->most_closed, record->n_counted,
      record->most_closed < record->n_counted ? " at best" : "",
      thr_plain_number(last->height, 3, height), thr_plain_number(fabs(last->drawn), 3, drawn),
      last->drawn < 0 ? "given out" : "drawn in");
  put_lying(runs, text);
  if (record->most_closed < record->n_counted) {
    const char *name[2] = {"", ""};
    thr_rise_pass_names(&runs->pieces, record->loosest, name);
    thr_text_printf(text, "the widest gap stays between %s and %s\n", name[0], name[1]);
  }
  put_jam(runs, text);
  put_pulls(runs, text);
  if (runs->args->dent) {
    thr_text_append(text, "dented, it differed from the drawn shape by ");
    put_spread(runs, dented_of, "mm at most", text);
    thr_text_append(text, "; let go, it ");
  }
  thr_text_append(text, "differs from the drawn shape by ");
  put_spread(runs, off_of, "mm at most", text);
  thr_text_append(text, "\n");
  if (runs->args->schedule) put_after(runs, text);
  if (runs->args->rise.let_down) {
    if (record->fell >= 0) {
      thr_text_append(text, "let down, it falls below ");
      put_spread(runs, thr_rise_pull_down, "N", text);
      thr_text_append(text, "\n");
    } else
      thr_text_append(text, "let down, it does not fall\n");
  }
}

/* Appends everything as JSON, and with `motion` the place of every piece. */
static void put_json(const rise_runs *runs, bool motion, thr_text *text)
{
  const rise_arguments *args = runs->args;
  const thr_rise_seen seen = {.pieces = &runs->pieces,
                              .after = args->schedule ? &runs->after : NULL,
                              .options = &runs->options,
                              .dented = args->dent != NULL,
                              .motion = motion,
                              .first_seed = args->first_seed,
                              .n = runs->n_runs,
                              .record = runs->record};
  thr_writer writer = {.out = text};
  thr_write_object(&writer, NULL);
  thr_rise_put_json(&writer, &seen);
  if (!motion) answer_put_files(&writer);
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
  const thr_rise_chart chart = {name,
                                &runs->pieces.made.structure.physics,
                                runs->pieces.seated,
                                runs->pieces.stands,
                                runs->n_runs,
                                line};
  if (!st) st = thr_rise_svg(&chart, &svg, &err);
  thr_scratch_free(&own);
  return cli_write_drawn(st, &svg, runs->args->plot, &err);
}

/* Writes the first run as a film: of finer meshes than those that rise, whose slivers would be seen
 * as specks. Returns an exit code. */
static int write_film(const rise_runs *runs)
{
  const rise_arguments *args = runs->args;
  const thr_limits limits = cli_limits(0);
  const thr_film_options options = {.size = {args->size[0], args->size[1]}};
  thr_kit_options finer = runs->pieces.kit.options;
  thr_err err = {0};
  thr_kit shown;
  thr_movement movement = {0};
  thr_film *film = NULL;
  thr_text png = {0};
  const int code = args->frames ? cli_make_folder(args->frames) : EXIT_SUCCESS;
  if (code) return code;

  finer.coarse = 1;
  thr_status st = thr_kit_make(&shown, runs->pieces.kit.plan, &finer, NULL, true, &limits, &err);
  if (!st) st = thr_rise_movement(&movement, &shown, &runs->record[0], &err);
  if (!st) st = thr_film_open(&film, &shown, &movement, &options, &err);
  if (!st) st = thr_film_write(film, args->frames, args->film ? &png : NULL, &limits, &err);
  cli_progress_end();
  thr_film_close(film);
  thr_movement_destroy(&movement);
  thr_kit_destroy(&shown);
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

  thr_status st = thr_rise_movement(&movement, &runs->pieces.kit, &runs->record[0], &err);
  if (!st && (title.failed || note.failed)) st = thr_nomem(&err);
  if (!st) st = thr_kit_moves(&runs->pieces.kit, &movement, title.data, note.data, &moves, &err);
  if (!st) thr_kit_viewer(&runs->pieces.kit, &moves, &pieces);
  if (!st && pieces.failed) st = thr_nomem(&err);
  const thr_document_options how = {.kit = &pieces,
                                    .kind_tolerance = runs->args->kit.kind_tolerance};
  if (!st)
    st = thr_document_make(runs->pieces.kit.plan, thr_document_find("html"), &how, &limits, &page,
                           &err);
  cli_progress_end();
  thr_movement_destroy(&movement);
  thr_text_destroy(&title);
  thr_text_destroy(&note);
  thr_text_destroy(&moves);
  thr_text_destroy(&pieces);
  return cli_write_drawn(st, &page, runs->args->play, &err);
}

/* Returns what a name of a booklet ends in: 1 = .html, 0 = .pdf, -1 = neither. */
static int booklet_kind(const char *name)
{
  const char *ending = thr_path_ending(name);
  return strcmp(ending, "html") == 0 ? 1 : strcmp(ending, "pdf") == 0 ? 0 : -1;
}

/* Finds the moments that a booklet shows: the first, those where a third and two thirds of the
 * faces are closed, and the one where it is up or most are closed. Returns how many. */
static int find_stills(const thr_rise_record *record, int frame[STILLS])
{
  int n = 0, thirds = 0, last = record->came_up;
  for (int f = 0; f < record->held && last < 0; f++)
    if (record->moment[f].closed == record->most_closed) last = f;
  for (int f = 0; f < last && thirds < 3; f++) {
    if (3 * record->moment[f].closed < thirds * record->n_counted) continue;
    frame[n++] = f;
    while (3 * record->moment[f].closed >= thirds * record->n_passes)
      thirds++;
  }
  frame[n++] = last < 0 ? 0 : last;
  return n;
}

/* Appends what hands do besides pulling, for the booklet: rise off the table and lock, or carry the
 * weight where that does not happen by itself. */
static void put_hands(const rise_runs *runs, thr_text *text)
{
  const thr_rise_options *options = &runs->options;
  const bool helped = options->lift > 0;
  char weight[32];
  thr_svg_force(runs->record[0].weight, weight);

  if (helped)
    thr_text_printf(text, " Meanwhile a %s piece %s; all weigh %s.",
                    options->carried ? "hand carries up" : "counterweight lifts",
                    runs->pieces.kit.name[options->lifted], weight);
  if (options->start == THR_RISE_SHAPE)
    thr_text_append(text, " Hold the cords drawn in until all knots are tied.");
  else if (2 * count_up(runs) > runs->n_runs)
    thr_text_append(text, " Rise off the table and lock: draw in all cords together until the "
                          "faces are closed, and hold them so until all knots are tied.");
  else
    thr_text_printf(text,
                    " %s it does not rise: carry its %s from below, with hands, a cushion or a "
                    "ball, while the cords are drawn in, until the faces are closed and all knots "
                    "are tied.",
                    helped ? "Even so" : "By itself", weight);
}

/* Writes the booklet with stills of the first run. Returns an exit code. */
static int write_booklet(const rise_runs *runs)
{
  static const char *const id[STILLS] = {"rise-1", "rise-2", "rise-3", "rise-4"};
  const thr_rise_record *record = &runs->record[0];
  const thr_limits limits = cli_limits(0);
  const int n_pieces = record->n_pieces;
  int frame[STILLS];
  char caption[STILLS][96];
  thr_still_panel panel[STILLS];
  thr_err err = {0};
  thr_text note = {0}, pages = {0};
  thr_still still = {.title = "How it comes up",
                     .width = runs->pieces.kit.options.width / runs->pieces.kit.mm,
                     .n_panels = find_stills(record, frame),
                     .panel = panel,
                     .first_bead = -1};
  double(*pose)[7] = thr_calloc((size_t)still.n_panels * (size_t)n_pieces, sizeof *pose);
  thr_text_append(&note, "In simulation: ");
  put_title(runs, &note);
  thr_text_append(&note, "; ");
  put_outcome(runs, &note);
  thr_text_append(&note, ". Openings that show are pale.");
  put_hands(runs, &note);

  /* Places in units of the framework. */
  for (int i = 0; i < still.n_panels && pose; i++) {
    const thr_rise_moment *moment = &record->moment[frame[i]];
    double(*own)[7] = pose + i * n_pieces;
    memcpy(own, record->pose + frame[i] * n_pieces, (size_t)n_pieces * sizeof *own);
    for (int v = 0; v < n_pieces; v++)
      thr_divide(own[v], runs->pieces.kit.mm);
    snprintf(caption[i], sizeof *caption, "%d of %d faces closed, %.3g N at every end",
             moment->closed, record->n_counted, moment->pull);
    panel[i] = (thr_still_panel){id[i], caption[i], (const double(*)[7])own};
  }

  still.note = note.data;
  char name[64];
  const thr_document_options how = {.name = cli_thing(runs->args->path, name),
                                    .rise = &still,
                                    .page = runs->args->page,
                                    .kind_tolerance = runs->args->kit.kind_tolerance};
  const int kind =
      thr_document_find(booklet_kind(runs->args->booklet) == 1 ? "sheets.html" : "pdf");
  thr_status st = pose && !note.failed ? THR_OK : thr_nomem(&err);
  if (!st) st = thr_document_make(runs->pieces.kit.plan, kind, &how, &limits, &pages, &err);
  cli_progress_end();
  free(pose);
  thr_text_destroy(&note);
  return cli_write_drawn(st, &pages, runs->args->booklet, &err);
}

/* Says which files were written. */
static void note_written(const rise_arguments *args)
{
  const struct {
    const char *path, *what;
  } file[] = {{args->output, "what was seen"},
              {args->plot, "pull against cord"},
              {args->film, "the film"},
              {args->frames, "the film as pictures"},
              {args->play, "the viewer, to play"},
              {args->booklet, "the step sheets"}};
  thr_text names = {0};
  for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
    if (!file[i].path) continue;
    thr_text_printf(&names, "%s%s", names.data ? ", " : "", file[i].path);
    answer_file(file[i].path, file[i].what);
  }
  if (names.data && !names.failed) cli_note("written to %s", names.data);
  thr_text_destroy(&names);
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
  if (runs->args->booklet) {
    code = write_booklet(runs);
    if (code) return code;
  }
  note_written(runs->args);
  text = (thr_text){0};
  if (cli_json)
    put_json(runs, false, &text);
  else
    put_text(runs, &text);
  return print_text(&text);
}

/* ---- the runs ---- */

/* Runs all seeds but the first in parallel processes. Those that are finished follow each other. */
static thr_status run_others(rise_runs *runs, const thr_limits *limits, thr_err *err)
{
  const int n = runs->args->seeds - 1;
  thr_rise_job *job = thr_calloc((size_t)n, sizeof *job);
  if (!job) return thr_nomem(err);
  for (int i = 0; i < n; i++) {
    job[i].structure = &runs->pieces.made.structure;
    job[i].options = runs->options;
    job[i].options.seed += (uint64_t)i + 1;
  }
  thr_status st = thr_rise_jobs_run(job, n, cli_processes(), limits, err);
  for (int i = 0; i < n; i++) {
    if (job[i].done) runs->record[runs->n_runs++] = job[i].record;
    if (job[i].status && !st) st = thr_fail(err, job[i].status, "%s", job[i].why.text);
  }
  free(job);
  return st;
}

/* Computes what the closed form says that the schedule leaves, and refuses what that refuses. */
static thr_status foretell_left(rise_runs *runs, const thr_limits *limits, thr_err *err)
{
  const thr_plan *plan = runs->pieces.kit.plan;
  thr_eval_options options = thr_eval_options_default();
  options.physics = runs->pieces.made.structure.physics;
  options.pull = THR_PULL_BOTH;
  options.schedule = runs->options.schedule;
  return thr_eval_plan(&plan->frame, plan->cord, plan->n_cords, THR_CAPSTAN, &options, limits,
                       &runs->after, err);
}

/* Runs all seeds, and tells what was seen. Returns an exit code. */
static int run_all(rise_runs *runs)
{
  const rise_arguments *args = runs->args;
  thr_err err = {0};
  thr_limits limits = cli_limits(0);
  double weight = 0;
  for (int p = 0; p < runs->pieces.made.structure.n_pieces; p++)
    weight += 1e-3 * runs->pieces.made.structure.piece[p].mass *
              runs->pieces.made.structure.physics.gravity;
  runs->options.seed = (uint64_t)args->first_seed;
  int code = take_hands(args, &runs->pieces.kit, weight, &runs->options);
  if (code >= 0) return code;

  thr_rise_foretell(&runs->pieces, &limits);
  thr_status st = args->schedule ? foretell_left(runs, &limits, &err) : THR_OK;
  if (!st)
    st = thr_rise_simulate(&runs->pieces.made.structure, &runs->options, &limits, &runs->record[0],
                           &err);
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
    which = piece_named(&runs->pieces.kit, word);
    if (which < 0) return cli_usage("rise", "--held %s: the plan has no such piece", word);
    runs->pieces.made.piece[which].held = true;
    return EXIT_SUCCESS;
  }
  if (!lay && (which = cord_named(runs->pieces.kit.plan, option, word)) < 0) return EXIT_USAGE;
  if (!lay && !file) {
    runs->pieces.made.cord[which].slack = true;
    return EXIT_SUCCESS;
  }

  const cli_frame_args usual = cli_frame_args_default();
  thr_frame frame;
  const int code = cli_read_frame(lay ? word : file, &usual, &frame);
  if (code) return code;
  const thr_status st =
      lay ? thr_rise_kit_lay(&runs->pieces.made, &runs->pieces.kit, &frame, &err)
          : thr_rise_kit_shape(&runs->pieces.made, &runs->pieces.kit, which, &frame, &err);
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

/* Makes the pieces of a plan, and lets them rise. Returns an exit code. */
static int make_and_run(const rise_arguments *args, const thr_plan *plan)
{
  thr_err err = {0};
  const thr_limits limits = cli_limits(0);
  rise_runs runs = {.args = args, .options = args->rise};
  thr_schedule schedule = {0};
  cli_step("laying out the pieces", "");
  const int read = pull_read_schedule(args->schedule, plan, &schedule);
  if (read) return read;
  if (args->schedule) runs.options.schedule = &schedule;

  thr_physics asked = plan->options.physics;
  if (isfinite(args->stiffness)) asked.stiffness = args->stiffness;
  if (isfinite(args->gravity)) asked.gravity = args->gravity;
  const thr_rise_setting setting = {(thr_pull)args->ends, (thr_rise_feet)args->feet, &asked};
  runs.record = thr_calloc((size_t)args->seeds, sizeof *runs.record);

  thr_status st = thr_rise_pieces_make(&runs.pieces, plan, &args->kit, &setting, &limits, &err);
  if (!st && !runs.record) st = thr_nomem(&err);
  int code = st ? cli_fail(&err) : take_lists(&runs);
  if (!code) code = run_all(&runs);

  for (int i = 0; i < args->seeds && runs.record; i++)
    thr_rise_record_destroy(&runs.record[i]);
  free(runs.record);
  thr_schedule_destroy(&schedule);
  thr_eval_destroy(&runs.after);
  thr_rise_pieces_destroy(&runs.pieces);
  return code;
}

/* What `thread rise` does without options. */
static rise_arguments usual_arguments(void)
{
  return (rise_arguments){.guard = guard_limits_default(),
                          .rise = {.pull = thr_rise_hand},
                          .kit = {.names = THR_KIT_NO_NAMES, .coarse = thr_rise_coarse},
                          .seeds = 1,
                          .ends = THR_PULL_BOTH,
                          .stiffness = NAN,
                          .gravity = NAN,
                          .first_seed = 1};
}

int rise_apply_physics(const cli_physics *physics, thr_plan *plan)
{
  const int code = cli_physics_apply(physics, &plan->options.physics);
  if (!code && cli_given_of(cli_physics_options())) {
    thr_evaluation_destroy(&plan->evaluation);
    plan->evaluation = (thr_evaluation){0};
  }
  return code;
}

/* Reads the plan and does all of the work in a child. physics: what is said of cord and beads;
 * NULL: nothing. Returns the exit code. */
static int run_guarded(const rise_arguments *args, const cli_physics *physics)
{
  guard_end end;
  thr_plan plan;
  if (guard_fork(&args->guard, &end)) return guard_conclude(&end, "nothing was seen");

  int code = cli_read_plan(args->path, &plan);
  if (code) return code;
  if (physics) code = rise_apply_physics(physics, &plan);
  if (!code) code = make_and_run(args, &plan);
  thr_plan_destroy(&plan);
  return code;
}

int rise_as_usual(const char *path, const rise_usual *asked)
{
  rise_arguments args = usual_arguments();
  args.path = path;
  args.guard = *asked->guard;
  args.rise.time_step = asked->time_step;
  if (asked->newtons > 0) args.rise.pull = asked->newtons;
  if (asked->seed >= 0) args.first_seed = asked->seed;
  return run_guarded(&args, asked->physics);
}

/* Runs `thread rise` and returns the exit code. */
int cmd_rise(int argc, char **argv)
{
  static const cli_syntax syntax = {"rise", intro, outro};
  rise_arguments asked = usual_arguments();
  const cli_group groups[] = {
      {"Options", own_options, &asked},    {"Shape", shape_options, &asked},
      {NULL, guard_options, &asked.guard}, {NULL, cli_processes_options, NULL},
      {cli_tuned, tuned_options, &asked},  {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  if (optind + 1 != argc)
    return cli_usage("rise", optind == argc ? "which plan?" : "one plan at a time");
  const char *clash = !asked.schedule       ? NULL
                      : asked.rise.let_down ? "--let-down"
                      : cli_given("ends")   ? "--ends"
                      : cli_given("pull")   ? "--pull"
                                            : NULL;
  if (clash) return cli_usage("rise", "--schedule says who pulls how hard: no %s", clash);
  const char *still = asked.schedule ? "--schedule" : asked.dent ? "--dent" : NULL;
  if (asked.rise.shake > 0 && still) return cli_usage("rise", "--shake or %s, not both", still);
  if (cli_given("shaking") && !(asked.rise.shake > 0))
    return cli_usage("rise", "--shaking: how far, and how often? --shake MM@HZ");
  if (asked.rise.shake > 0 && !cli_given("shaking")) asked.rise.shaken = SHAKEN;
  if (asked.lift && asked.raise) return cli_usage("rise", "--lift or --raise, not both");
  if (asked.booklet && booklet_kind(asked.booklet) < 0)
    return cli_usage("rise", "--booklet %s: expected a name ending in .pdf or .html",
                     asked.booklet);
  asked.path = argv[optind];
  asked.rise.start = asked.lay ? THR_RISE_LAID : (thr_rise_start)asked.start;
  asked.rise.iterations = (int)asked.iterations;
  if (asked.progress) progress_begin();

  return run_guarded(&asked, NULL);
}
