/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread eval: computes how hard the ends of a plan's cords must be pulled, and what the structure
 * holds.
 *
 * Three methods behind one interface (eval/eval.h) answer two questions that must not be mixed up
 * (docs/method.md, "Pull force"):
 *
 * capstan and joint: the seating pull, at which every pass has the seating tension T, N. Along a
 * cord that slides over a turn of theta rad, tension grows by exp(mu theta) (Euler-Eytelwein).
 * Capstan takes the turns through the centres of the beads; joint takes the path of the tight cord,
 * and measures what single turns cost in simulation.
 *
 * structure: the holding pull, N, below which the rigid beads have no equilibrium while the cords
 * are drawn in (limit analysis of blocks with friction), with a simulation as its witness. It grows
 * with the weight of the beads, not with T.
 *
 * This file parses the options, evaluates one plan in a guarded child process, puts the evaluation
 * into the plan, and writes the plan, pictures and a summary (cli/print/eval_text.c, eval_json.c).
 * With --calibrate there is no plan: weights at the bench become a file of frictions
 * (cli/commands/weighing.c).
 *
 * Example: `thread eval plan.json --mu 0.3 -o plan.json --plot tension.svg` stores the tension of
 * every pass in the plan and draws it along each cord. */
#include "cli/args/args.h"
#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread eval PLAN [options]: pull force, friction loss and tension along each cord\n\n"
    "Examples:\n"
    "  thread eval plan.json --mu 0.3 --seating 5    which pull leaves 5 N where it is slackest\n"
    "  thread eval plan.json --method joint          the same, joints measured in simulation\n"
    "  thread eval plan.json --method structure --still still.svg   which pull lets the whole "
    "stand\n"
    "  thread eval plan.json -o plan.json --plot tension.svg        keep it in the plan; draw it\n";
static const char outro[] =
    "Pull is the force at the pulled ends of a cord at which its slackest pass has the seating "
    "tension (capstan, joint), or at which the structure can just stand while the cord is drawn in "
    "(structure). These are different things. The closed form takes the cord through the middle of "
    "every bead; a cord thinner than the bore cuts corners, turns less and needs less: method "
    "joint knows.";

/* The command line. Strings point into argv. */
typedef struct {
  pull_args pull;
  guard_limits guard;
  load_args load;
  bool tension;
  const char *path, *output, *plot, *still, *stills;
  const char *schedule, *calibrate; /* as given; NULL: none */
  double strength;                  /* N, of the cord; 0 = not said */
  int knot;                         /* of thr_knots */
} eval_arguments;

/* Runs --calibrate, which needs no plan, and of cord and beads only the bore, in mm (2 if nothing
 * was said). Returns an exit code. */
static int calibrate(const eval_arguments *args, bool with_plan)
{
  thr_physics physics = thr_physics_default();
  if (with_plan) return cli_usage("eval", "--calibrate takes no plan");
  int code = cli_physics_apply(&args->pull.physics, &physics);
  return code ? code
              : calibrate_run(args->calibrate, physics.bore > 0 ? physics.bore : 2, args->output,
                              args->pull.json);
}

static const char *method_meaning(int method)
{
  static const char *const meaning[] = {
      [THR_CAPSTAN] = "closed form, force = seating tension x exp(mu x turning)",
      [THR_JOINT] = "each joint's friction measured in simulation, along the path the tight cord "
                    "takes",
      [THR_STRUCTURE] = "least pull at which the rigid beads have any equilibrium while the cord "
                        "is drawn in, and which fails first"};
  return meaning[method];
}

static bool take_hand(void *into, const cli_option *option, const char *value)
{
  (void)option;
  return cli_hand("eval", value, &((eval_arguments *)into)->pull.options.hand);
}

#define AT(member) .offset = offsetof(eval_arguments, member)

static const cli_option method_options[] = {{"method", .kind = CLI_WORD, AT(pull.method),
                                             .word = pull_method_name, .meaning = method_meaning,
                                             .n_words = THR_N_METHODS,
                                             .help = "how the pull is found (default: capstan)"},
                                            {0}};

static const cli_option own_options[] = {
    {"output", 'o', "FILE", "write the plan with this evaluation in it (- = stdout)",
     .kind = CLI_OUTPUT, AT(output)},
    {"tension", .kind = CLI_FLAG, AT(tension), .help = "print the tension in every pass"},
    {"hand", .value = "N", .kind = CLI_OTHER, .take = take_hand,
     .help = "where to grip the cord on the way, and how hard, so that no pull is above N newtons "
             "(one: 50, two: 100): the fewest grips"},
    {"schedule", .value = "TEXT", .kind = CLI_OUTPUT, AT(schedule),
     .help = "what is done to the cords, in order, and the tension that it leaves; or a file of "
             "that: \"A: pull both 40; A: release end 5; A: knot both 0.5; B: knot start; C: none; "
             "B: grip 37 20 from start; B: pull end 9\" (every cord has a step; newtons; passes as "
             "in steps.txt, or two "
             "nodes; a knot may slip by mm: --stiffness, which grips that are let go ask for, "
             "too)"},
    {"plot", .value = "FILE", .kind = CLI_OUTPUT, AT(plot),
     .help = "write a plot of the tension along each cord, as SVG: with a fan over the band of mu, "
             "and with lines at what a hand manages and at --cord-strength; with --load: what is "
             "carried against pull, and which piece moves first"},
    {"cord-strength", .value = "N", .kind = CLI_AMOUNT, AT(strength), .low = 1e-6, .high = 1e9,
     .help = "newtons that the straight cord bears: says whether the pull would break it, at its "
             "knots or over the edges of bores, which leave half of that; structure: knotted cords "
             "get no tighter"},
    {"knot", .value = "NAME", .kind = CLI_WORD, AT(knot), .word = thr_knot_name,
     .help = "that knot: overhand (the default, leaves 45 %), reef 45, figure-eight 48, bowline "
             "60, anchor 70, clove-hitch 75, two-half-hitches 75, eye-splice 95"},
    {"still", .value = "FILE", .kind = CLI_OUTPUT, AT(still),
     .help = "structure: write a picture of the beads before and after the fall, as SVG"},
    {"stills", .value = "FILE", .kind = CLI_OUTPUT, AT(stills),
     .help = "structure: how it comes up from slack as the cords are drawn in, in stills, as SVG, "
             "and the counterweight that takes (--pull A=both,B=none: by one cord alone); -o keeps "
             "their poses"},
    {"calibrate", .value = "HANG,IN,OUT", .kind = CLI_OUTPUT, AT(calibrate),
     .help = "no plan: friction from weights at the bench. HANG hangs from a cord that goes round "
             "90 degrees; IN at its other end just draws it up, OUT just lets it slip down. "
             "Several weighings with semicolons. With -o FILE it is kept for --physics FILE. "
             "bead=DEGREES,..: likewise, also together: a piece slides on others that lie on a "
             "board tilted by that (mu_bead); ground=DEGREES,..: on what the feet stand on "
             "(mu_ground). piece: a drawing of the piece to drill, true to size (SVG; -o FILE.stl: "
             "to print), by --bore mm"},
    {0}};

/* Parses the command line into *args. Returns -1 to go on, or the exit code of the command. */
static int parse(int argc, char **argv, eval_arguments *args)
{
  static const cli_syntax syntax = {"eval", intro, outro};
  static cli_option own[sizeof own_options / sizeof *own_options];
  *args = (eval_arguments){.guard = guard_limits_default()};
  pull_args_init(&args->pull, THR_CAPSTAN);
  memcpy(own, own_options, sizeof own_options);
  for (cli_option *option = own; option->name; option++) {
    if (option->word == thr_knot_name) {
      option->n_words = thr_n_knots;
    }
  }
  const cli_group groups[] = {{"Options", method_options, args},
                              {NULL, own, args},
                              {NULL, pull_options, &args->pull},
                              {NULL, cli_processes_options, NULL},
                              {NULL, pull_run_options, &args->pull},
                              {NULL, guard_options, &args->guard},
                              {"What acts on the structure", cli_load_options, &args->load},
                              {CLI_PHYSICS_HEADING, cli_physics_options(), &args->pull.physics},
                              {cli_tuned, pull_tuned, &args->pull},
                              {cli_tuned, cli_load_tuned, &args->load},
                              {NULL}};
  const int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  args->pull.options.erect = args->stills != NULL;
  if (args->calibrate) return calibrate(args, optind < argc);
  if (optind + 1 != argc)
    return cli_usage("eval", optind == argc ? "which plan?"
                                            : "one plan at a time; `thread compare` takes several");
  args->path = argv[optind];

  /* At most one of the outputs can have stdout. */
  const char *const out[] = {args->output, args->plot, args->still, args->stills};
  int to_stdout = args->pull.json;
  for (int i = 0; i < 4; i++)
    to_stdout += out[i] && strcmp(out[i], "-") == 0;
  if (to_stdout > 1)
    return cli_usage(
        "eval", "only one of --json, -o -, --plot -, --still - and --stills - can have stdout");

  /* Options that exclude or need each other: what would be ignored is refused. */
  if (args->output && cli_no_plan_name("eval", args->output)) return EXIT_USAGE;
  if (pull_check(&args->pull, "eval")) return EXIT_USAGE;

  /* --hand finds a schedule of its own. */
  if (args->schedule && args->pull.options.hand > 0)
    return cli_usage("eval", "--hand makes a schedule of its own: no --schedule");
  if (args->pull.options.hand > 0 && args->pull.method == THR_STRUCTURE)
    return cli_usage("eval",
                     "--hand is of the methods capstan and joint; --schedule takes what it says");

  /* What only method structure knows. */
  if ((args->still || args->stills) && args->pull.method != THR_STRUCTURE)
    return cli_usage("eval", "%s needs --method structure", args->still ? "--still" : "--stills");

  if (args->stills && args->schedule)
    return cli_usage("eval", "--stills draws the cords in; take --schedule away");
  if (load_any(&args->load) && args->pull.method != THR_STRUCTURE)
    return cli_usage("eval", "--load, --tilt and --clamp-feet are of --method structure");
  if ((args->load.rays || args->load.taut) && args->pull.method != THR_STRUCTURE)
    return cli_usage("eval", "%s is of --method structure",
                     args->load.rays ? "--tune rays" : "--taut");
  if (args->load.n_pulls && !args->load.load) return cli_usage("eval", "--load-pulls needs --load");

  /* Pictures of the simulation. */
  const char *shows = args->still ? "--still" : args->stills ? "--stills" : NULL;
  if (shows && args->load.load)
    return cli_usage("eval", "%s shows a simulation, which knows no loads", shows);
  if (shows && !args->pull.options.dynamics)
    return cli_usage("eval", "%s shows a simulation; take --no-dynamics away", shows);

  return -1;
}

/* ---- outputs ---- */

/* Evaluates the plan's cords again, pulled at the same ends, at another friction and by the closed
 * form: one edge of the fan of a tension plot. mu: of cord on bead. Release with
 * thr_eval_destroy. */
static thr_status eval_at(const thr_plan *plan, double mu, thr_eval *out, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_limits none = {0};
  thr_eval_options options = thr_eval_options_default();
  thr_pull *pull = thr_calloc((size_t)evaluation->n_cords, sizeof *pull);

  if (!pull) return thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords; i++)
    pull[i] = evaluation->cord[i].pull;

  /* The band of this evaluation is not asked for: 0 means that it follows from mu. */
  options.physics = evaluation->physics;
  options.physics.mu = mu;
  options.physics.mu_low = options.physics.mu_high = 0;
  options.law = evaluation->law;
  options.cord_pull = pull;

  thr_status st = thr_eval_plan(&plan->frame, plan->cord, plan->n_cords, THR_CAPSTAN, &options,
                                &none, out, err);
  free(pull);

  return st;
}

/* Draws the tension along each cord, N, with a fan from mu_low to mu_high where the method has one:
 * the limit analysis has none, a schedule neither, and beyond 1e300 N nothing is drawn. Lines show
 * what a hand manages and what the cord bears. strength: N that is left of the cord at its knots,
 * 0 = not known. Returns an exit code. */
static int write_plot(const thr_plan *plan, double strength, const char *path)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_physics *physics = &evaluation->physics;
  thr_err err = {0};
  thr_text svg = {0};
  thr_eval low = {0}, high = {0};
  thr_tension_options options = thr_tension_options_default();

  options.hand = evaluation->method != THR_STRUCTURE;
  options.strength = strength;

  /* The edges of the fan. */
  const bool fan = evaluation->method != THR_STRUCTURE && evaluation->schedule.n == 0;
  thr_status st = fan && physics->mu_low < physics->mu_high ? THR_OK : THR_EINFEASIBLE;
  if (!st) st = eval_at(plan, physics->mu_low, &low, &err);
  if (!st) st = eval_at(plan, physics->mu_high, &high, &err);
  options.low = st ? NULL : &low.record;
  options.high = st ? NULL : &high.record;

  /* Without a fan the picture is drawn all the same. */
  if (st != THR_ENOMEM) st = thr_tension_svg(plan, &options, &svg, &err);
  thr_eval_destroy(&low);
  thr_eval_destroy(&high);

  return cli_write_drawn(st, &svg, path, &err);
}

/* Orders points of a load's picture by ascending pull. Signature of qsort. */
static int compare_pulls(const void *a, const void *b)
{
  const double x = ((const thr_load_mark *)a)->pull, y = ((const thr_load_mark *)b)->pull;
  return (x > y) - (x < y);
}

/* Draws what of the load is carried against the pull at all ends, N: from the multiple at which an
 * equilibrium was found to the one above which none exists, and which piece moves first. load: as
 * given. Returns an exit code. */
static int write_load_plot(const thr_plan *plan, const thr_eval *eval, const char *load,
                           const char *path)
{
  thr_err err = {0};
  thr_text svg = {0}, words = {0};
  thr_load_mark *mark = thr_calloc((size_t)eval->n_carries, sizeof *mark);
  thr_status st = mark ? THR_OK : thr_nomem(&err);

  /* A mark for each pull that was asked for, or chosen by the method. */
  for (int i = 0; i < eval->n_carries && !st; i++) {
    const thr_load_point *point = &eval->carries[i];
    /* Where no equilibrium was found, only what is too much is known, which is no band. */
    const bool decided = point->carry.first_bead >= 0 && isfinite(point->carry.carried);
    mark[i] = (thr_load_mark){.pull = point->pull,
                              .decided = decided,
                              .carried = point->carry.carried,
                              .beyond = point->carry.beyond,
                              .first = decided ? plan->frame.name[point->carry.first_bead] : NULL};
  }

  /* Marks are joined by lines from left to right. */
  if (!st) qsort(mark, (size_t)eval->n_carries, sizeof *mark, compare_pulls);
  thr_text_printf(&words, "--load %s: newtons at the pieces named", load);

  const thr_load_chart chart = {words.data ? words.data : "", &plan->evaluation.physics,
                                eval->n_carries, mark};
  if (!st) st = thr_load_svg(&chart, &svg, &err);

  thr_text_destroy(&words);
  free(mark);

  return cli_write_drawn(st, &svg, path, &err);
}

/* Returns a copy of n poses whose positions are in units of the framework instead of metres. mm:
 * millimetres in a unit. NULL when memory runs out; the caller frees it. */
static double (*scale_poses(const double (*from)[7], size_t n, double mm))[7]
{
  double(*pose)[7] = thr_calloc(n, sizeof *pose);
  for (size_t i = 0; i < n && pose; i++) {
    memcpy(pose[i], from[i], sizeof *pose);
    for (int k = 0; k < 3; k++)
      pose[i][k] *= 1000 / mm;
  }
  return pose;
}

/* Draws the beads before and after the fall, side by side, with the widest gap of each in mm. What
 * the picture shows depends on how the simulation ended: the beads fell where the limit analysis
 * expects a fall, or elsewhere, or not at all. */
static thr_status draw_still(const thr_plan *plan, const thr_settle *settle, thr_text *svg,
                             thr_err *err)
{
  const size_t n = (size_t)settle->n_beads;
  double mm = 1;
  thr_status st = thr_units_in_mm(plan->frame.units, &mm, err);

  if (st) return st;
  double(*before)[7] = scale_poses((const double(*)[7])settle->before, n, mm),
  (*after)[7] = scale_poses((const double(*)[7])settle->after, n, mm);

  /* Words for the two panels and below them. */
  char caption[2][160], first[80] = "";
  if (settle->first_bead >= 0)
    snprintf(first, sizeof first, "; bead %.60s moved first", plan->frame.name[settle->first_bead]);
  snprintf(caption[0], sizeof caption[0], "Before: widest gap %.3g mm", settle->gap_before);
  snprintf(caption[1], sizeof caption[1], "After: widest gap %.3g mm%s", settle->gap_after, first);
  const thr_still_panel panel[] = {{"before", caption[0], (const double(*)[7])before},
                                   {"after", caption[1], (const double(*)[7])after}};
  const char *note =
      settle->status == THR_SETTLE_FELL
          ? "Before: under the pull at the start. After: the pull let off until it fell."
      : settle->status == THR_SETTLE_HELD ? "It stands until the pull is gone."
      : settle->fall > 0 ? "Before: under the pull at the start. After: it fell outside the pulls "
                           "that the limit analysis leaves open."
                         : "No fall was seen, though nothing holds it there (proved): what is seen "
                           "here was too slow.";

  const thr_still still = {.title = "The structure in simulation",
                           .note = note,
                           .width = plan->evaluation.physics.bead_diameter / mm,
                           .n_panels = 2,
                           .panel = panel,
                           .first_bead = settle->first_bead};
  st = before && after ? thr_still_svg(&plan->frame, &still, svg, err) : thr_nomem(err);
  free(before);
  free(after);

  return st;
}

/* Draws in six stills how the structure comes up from slack: sunk down, drawn in by a half, once
 * and twice the pull under a counterweight, let alone, at rest (eval/structure/erect.c). */
static thr_status draw_stills(const thr_plan *plan, const thr_erect *erect, thr_text *svg,
                              thr_err *err)
{
  static const char *const id[THR_ERECT_STILLS] = {"slack", "half",  "once",
                                                   "twice", "alone", "rested"};
  static const char *const when[THR_ERECT_STILLS] = {
      "Slack", "Drawn in", "Drawn in", "Drawn in", "Without counterweight", "At rest"};
  thr_still_panel panel[THR_ERECT_STILLS];
  char caption[THR_ERECT_STILLS][200];
  thr_text note = {0};
  double mm = 1;
  thr_status st = thr_units_in_mm(plan->frame.units, &mm, err);

  if (st) return st;

  /* Poses of all stills stand in one array, still by still. */
  double(*pose)[7] =
      scale_poses((const double(*)[7])erect->pose, THR_ERECT_STILLS * (size_t)erect->n_beads, mm);

  /* A panel for each still. */
  for (int i = 0; i < THR_ERECT_STILLS; i++) {
    const thr_erect_still *moment = &erect->still[i];
    snprintf(
        caption[i], sizeof caption[i],
        "%s: %.3g N at the harder ends, counterweight %.3g N; %d of %d gaps closed, %.3g mm high",
        when[i], moment->pull, moment->lift * erect->weight, moment->closed, erect->n_gaps,
        moment->height);
    panel[i] = (thr_still_panel){id[i], caption[i],
                                 (const double(*)[7])(pose ? pose + i * erect->n_beads : NULL)};
  }

  /* Below them the counterweight that it takes. */
  erect_put(&note, erect);
  const thr_still still = {.title = "How the structure comes up",
                           .note = note.data,
                           .width = plan->evaluation.physics.bead_diameter / mm,
                           .n_panels = THR_ERECT_STILLS,
                           .panel = panel,
                           .first_bead = -1};
  st = pose && !note.failed ? thr_still_svg(&plan->frame, &still, svg, err) : thr_nomem(err);

  thr_text_destroy(&note);
  free(pose);

  return st;
}

/* Writes the picture of how the structure comes up. stopped: the user or a limit ended the work,
 * which is no error of this picture. Returns an exit code. */
static int write_stills(const thr_plan *plan, const thr_erect *erect, bool stopped,
                        const char *path)
{
  thr_err err = {0};
  thr_text svg = {0};

  if (!erect->present) {
    cli_error(stopped ? "%s: not written: stopped before the simulation was done"
                      : "%s: nothing to draw: there was no simulation",
              path);
    return stopped ? EXIT_OK : EXIT_INPUT; /* what stopped it has a code of its own */
  }

  return draw_stills(plan, erect, &svg, &err) ? cli_fail(&err) : cli_write(&svg, path);
}

/* Writes the picture of the fall, unless there is nothing to draw. stopped: as for write_stills.
 * Returns an exit code. */
static int write_still(const thr_plan *plan, const thr_settle *settle, bool stopped,
                       const char *path)
{
  thr_err err = {0};
  thr_text svg = {0};

  if (stopped && !settle->present) {
    cli_error("%s: not written: stopped before the simulation was done", path);
    return EXIT_OK; /* what stopped it has a code of its own */
  }

  /* Where the structure did not come to rest, there is no state before the fall. */
  if (!settle->present || !settle->before || !settle->after ||
      settle->status == THR_SETTLE_TOO_LARGE || settle->status == THR_SETTLE_NEVER_SETTLED) {
    cli_error("%s: nothing to draw: %s", path,
              settle->present && settle->status == THR_SETTLE_NEVER_SETTLED
                  ? "the simulation never came to rest"
                  : "there was no simulation");
    return EXIT_INPUT;
  }

  return draw_still(plan, settle, &svg, &err) ? cli_fail(&err) : cli_write(&svg, path);
}

/* Writes the plan with its evaluation, the pictures and, unless one of these goes to stdout, the
 * summary. stopped: not all is known. Returns the first exit code that is not EXIT_OK. */
static int write_outputs(const eval_arguments *args, const thr_plan *plan, const thr_eval *eval,
                         bool stopped)
{
  thr_text text = {0};
  const char *plan_path = args->output;
  int code = EXIT_OK;

  /* The plan first: it took long to compute. */
  if (plan_path) {
    thr_plan_write(plan, &text);
    code = cli_write_kept(&text, &plan_path);
  }

  /* Pictures. */
  if (!code && args->plot && eval->n_carries > 0)
    code = write_load_plot(plan, eval, args->load.load, args->plot);
  else if (!code && args->plot)
    code = write_plot(plan, args->strength * thr_strength_left(args->knot), args->plot);
  if (!code && args->still) code = write_still(plan, &eval->settle, stopped, args->still);
  if (!code && args->stills) code = write_stills(plan, &eval->erect, stopped, args->stills);

  /* The summary, where stdout is free. */
  const char *const out[] = {plan_path, args->plot, args->still, args->stills};
  const eval_view view = {
      args->pull.pull, args->strength,          args->knot,
      args->tension,   args->load.load != NULL, args->pull.options.dynamics && !args->load.load,
      stopped};
  for (int i = 0; i < 4; i++)
    if (out[i] && strcmp(out[i], "-") == 0) return code;

  if (args->pull.json)
    eval_put_json(&text, plan, eval, stopped);
  else
    eval_put_text(&text, &view, plan, eval);
  int printed = cli_write(&text, "-");

  return code ? code : printed;
}

/* Returns whether the evaluation of any cord is known. */
static bool is_any_known(const thr_evaluation *evaluation)
{
  for (int i = 0; i < evaluation->n_cords; i++)
    if (evaluation->cord[i].known) return true;
  return false;
}

/* Runs `thread eval` and returns the exit code: EXIT_LIMIT if only a part is known, EXIT_INFEASIBLE
 * if no pull holds the structure. */
int cmd_eval(int argc, char **argv)
{
  eval_arguments args;
  thr_plan plan;
  thr_eval eval = {0};
  guard_end end;
  int code = parse(argc, argv, &args);

  if (code >= 0) return code;

  /* The child does all of the work. */
  if (guard_fork(&args.guard, &end)) return guard_conclude(&end, "no result");
  if ((code = cli_read_plan(args.path, &plan))) return code;

  /* What is done to the cords and hangs on the structure, in terms of this plan. */
  thr_schedule schedule = {0};
  double(*load)[3] = NULL;
  code = pull_read_schedule(args.schedule, &plan, &schedule);
  if (!code) code = load_apply(&args.load, &plan.frame, &args.pull.options, &load);
  if (schedule.n > 0) args.pull.options.schedule = &schedule;
  args.pull.options.strength = args.strength * thr_strength_left(args.knot);

  /* An evaluation that was stopped is worth printing if a single cord is known. */
  if (!code) code = pull_eval(&args.pull, args.path, &plan, (thr_method)args.pull.method, &eval);
  bool known = (code == EXIT_OK || code == EXIT_LIMIT) && is_any_known(&eval.record);
  if (known) { /* the plan takes the record over, so that one thing is written, drawn and printed */
    if (thr_plan_take_evaluation(&plan, &eval.record) && args.output)
      cli_note("note: what the plan proves within its limit on the pull is by the definition of "
               "plans of version 1; it is left out");

    int written = write_outputs(&args, &plan, &eval, code == EXIT_LIMIT);
    if (written) code = written;

    /* Where the joints come from is told on stderr, since results do not depend on the cache. */
    if (plan.evaluation.method == THR_JOINT && code == EXIT_OK)
      cli_note("note: %d %s measured, %d from the cache", eval.joints_measured,
               cli_plural(eval.joints_measured, "joint", "joints"), eval.joints_cached);
  }

  /* No pull holds the structure: what is left is how it was drawn in, a heap. */
  if (code == EXIT_INFEASIBLE && eval.erect.present) {
    plan.evaluation.physics = eval.record.physics;
    const int written = write_stills(&plan, &eval.erect, false, args.stills);
    if (written) code = written;
  }

  if (code == EXIT_LIMIT)
    cli_error(known ? "stopped: only a part is known" : "stopped before any cord was known");

  thr_schedule_destroy(&schedule);
  free(load);
  thr_eval_destroy(&eval);
  thr_plan_destroy(&plan);

  return code;
}
