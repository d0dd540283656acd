/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread eval: computes how hard the ends of a plan's cords must be pulled, and what the structure
 * holds.
 *
 * Three of the methods, behind one interface (eval/eval.h), answer two questions that must not be
 * mixed up (docs/method.md, "Pull force"):
 *
 * capstan and joint: the seating pull, at which every pass has the seating tension T, N. Along a
 * cord that slides over a turn of theta rad, tension grows by exp(mu theta) (Euler-Eytelwein).
 * Capstan takes the turns through the centres of the beads; joint takes the path of the tight cord,
 * and measures what single turns cost in simulation.
 *
 * structure: the holding pull, N, below which the rigid beads have no equilibrium while the cords
 * are drawn in (limit analysis of blocks with friction). It grows with the weight of the beads, not
 * with T.
 *
 * rise: whether loose pieces come up in simulation: `thread rise` (cmd_rise.c) with its defaults.
 *
 * This file parses the options, evaluates one plan in a guarded child process, puts the evaluation
 * into the plan, and writes the plan, pictures (eval_pictures.c) and a summary
 * (cli/print/eval_text.c, eval_json.c). With --calibrate there is no plan: weights at the bench
 * become a file of frictions (cli/commands/weighing.c).
 *
 * Example: `thread eval plan.json --mu 0.3 -o plan.json --plot tension.svg` stores the tension of
 * every pass in the plan and draws it along each cord. */
#include "cli/commands/commands.h"
#include "cli/print/print.h"
#include "eval/cord/profile.h"
#include "graph/arrays.h"
#include "graph/plan/physics.h"
#include "kit/kit.h"

#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread eval PLAN [options]: pull force, friction loss and tension along each cord\n\n"
    "Examples:\n"
    "  thread eval plan.json --mu 0.3 --seating 5    which pull leaves 5 N where it is slackest\n"
    "  thread eval plan.json --method joint          the same, joints measured in simulation\n"
    "  thread eval plan.json --method structure      which pull lets the whole stand\n"
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
  const char *path, *output, *plot;
  const char *schedule, *calibrate; /* as given; NULL: none */
  double strength;                  /* N, of the cord; 0 = not said */
  int knot;                         /* of thr_knots */
  int pieces;                       /* 1: those that are made */
  thr_kit_profile profile;
} eval_arguments;

static const char *pieces_name(int i)
{
  static const char *const name[] = {"ideal", "kit"};
  return name[i];
}

/* Runs --calibrate, which needs no plan, and of cord and beads only the bore, in mm (2 if nothing
 * was said). Returns an exit code. */
static int calibrate(const eval_arguments *args, bool with_plan)
{
  thr_physics physics = thr_physics_default();
  if (with_plan) return cli_usage("eval", "--calibrate takes no plan");
  int code = cli_physics_apply(&args->pull.physics, &physics);
  return code ? code
              : calibrate_run(args->calibrate, physics.bore > 0 ? physics.bore : 2, args->output);
}

static const char *method_meaning(int method)
{
  static const char *const meaning[] = {
      [THR_CAPSTAN] = "closed form, force = seating tension x exp(mu x turning)",
      [THR_JOINT] = "each joint's friction measured in simulation, along the path the tight cord "
                    "takes",
      [THR_STRUCTURE] = "least pull at which the rigid beads have any equilibrium while the cord "
                        "is drawn in, and which fails first",
      [THR_BY_RISE] =
          "whether loose pieces come up in simulation: `thread rise`, which has options, "
          "with its defaults"};
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
                                             .n_words = THR_BY_RISE + 1,
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
    {"pieces", .kind = CLI_WORD, AT(pieces), .word = pieces_name, .n_words = 2,
     .help = "structure: ideal ones, with square arms (default), or kit, those that `thread kit` "
             "makes: their masses, mass centres, faces and feet, with the pull of the ideal ones "
             "beside theirs"},
    {"profile", .kind = CLI_WORD, AT(profile), .word = thr_kit_profile_name,
     .n_words = THR_KIT_N_PROFILES, .help = "of the arms of --pieces kit (default: round)"},
    {"calibrate", .value = "HANG,IN,OUT", .kind = CLI_OUTPUT, AT(calibrate),
     .help = "no plan: friction from weights at the bench. HANG hangs from a cord that goes round "
             "90 degrees; IN at its other end just draws it up, OUT just lets it slip down. "
             "Several weighings with semicolons. With -o FILE it is kept for --physics FILE. "
             "bead=DEGREES,..: likewise, also together: a piece slides on others that lie on a "
             "board tilted by that (mu_bead); ground=DEGREES,..: on what the feet stand on "
             "(mu_ground). piece: a drawing of the piece to drill, true to size (SVG; -o FILE.stl: "
             "to print), by --bore mm"},
    {0}};

/* Refuses what does not go with pieces that are made: only the limit analysis knows them. */
static int check_pieces(const eval_arguments *args)
{
  const pull_args *pull = &args->pull;
  if (!args->pieces)
    return cli_given("profile") ? cli_usage("eval", "--profile is of --pieces kit") : EXIT_OK;
  if (pull->method != THR_STRUCTURE)
    return cli_usage("eval", "--pieces kit is of --method structure");
  if (args->output)
    return cli_usage("eval", "--pieces kit: plans keep only what is proved of ideal pieces; take "
                             "-o away (--json says everything)");
  return EXIT_OK;
}

/* Refuses what --method rise would ignore. */
static int check_rise(const eval_arguments *args)
{
  const cli_option *const table[] = {own_options, cli_load_options, cli_load_tuned,
                                     pull_run_options};
  const char *given = NULL;
  if (args->pull.method != THR_BY_RISE) return EXIT_OK;
  for (size_t i = 0; i < sizeof table / sizeof *table && !given; i++)
    given = cli_given_of(table[i]);
  if (!given && args->pull.options.iterations != 1) given = "--tune iterations";
  if (!given && args->pull.options.seed > 1000000000) given = "--seed above 1e9";
  if (given)
    return cli_usage("eval",
                     "%s: --method rise is `thread rise` with its defaults, and plans do not keep "
                     "what it sees; that command has options of its own",
                     given);
  return EXIT_OK;
}

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
  if (args->calibrate) return calibrate(args, optind < argc);
  if (optind + 1 != argc)
    return cli_usage("eval", optind == argc ? "which plan?"
                                            : "one plan at a time; `thread compare` takes several");
  args->path = argv[optind];

  /* At most one of the outputs can have stdout. */
  const char *const out[] = {args->output, args->plot};
  int to_stdout = cli_json;
  for (int i = 0; i < 2; i++)
    to_stdout += out[i] && strcmp(out[i], "-") == 0;
  if (to_stdout > 1)
    return cli_usage("eval", "only one of --json, -o - and --plot - can have stdout");

  /* Options that exclude or need each other: what would be ignored is refused. */
  if (check_rise(args)) return EXIT_USAGE;
  if (args->output && cli_no_plan_name("eval", args->output)) return EXIT_USAGE;
  if (pull_check(&args->pull, "eval")) return EXIT_USAGE;

  /* --hand finds a schedule of its own. */
  if (args->schedule && args->pull.options.hand > 0)
    return cli_usage("eval", "--hand makes a schedule of its own: no --schedule");
  if (args->pull.options.hand > 0 && args->pull.method == THR_STRUCTURE)
    return cli_usage("eval",
                     "--hand is of the methods capstan and joint; --schedule takes what it says");

  /* What only method structure knows. */
  if (load_any(&args->load) && args->pull.method != THR_STRUCTURE)
    return cli_usage("eval", "--load, --tilt and --clamp-feet are of --method structure");
  if ((args->load.rays || args->load.taut) && args->pull.method != THR_STRUCTURE)
    return cli_usage("eval", "%s is of --method structure",
                     args->load.rays ? "--tune rays" : "--taut");
  if (args->load.n_pulls && !args->load.load) return cli_usage("eval", "--load-pulls needs --load");

  if (check_pieces(args)) return EXIT_USAGE;

  return -1;
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
    code = eval_write_load_plot(plan, eval, args->load.load, args->plot);
  else if (!code && args->plot)
    code = eval_write_plot(plan, args->strength * thr_strength_left(args->knot), args->plot);

  /* The summary, where stdout is free. */
  const char *const out[] = {plan_path, args->plot};
  const eval_view view = {args->pull.pull,
                          args->strength,
                          args->knot,
                          args->tension,
                          args->load.load != NULL,
                          args->pieces ? thr_kit_profile_name(args->profile) : NULL,
                          stopped};
  for (int i = 0; i < 2; i++)
    if (out[i] && strcmp(out[i], "-") == 0) return code;

  answer_file(plan_path, "the plan with this evaluation");
  answer_file(args->plot, "the plot");
  if (cli_json)
    eval_put_json(&text, &view, plan, eval);
  else
    eval_put_text(&text, &view, plan, eval);
  int printed = print_text(&text);

  return code ? code : printed;
}

/* Makes the pieces of a plan, without names, of the cord and beads that the command line says, and
 * measures them. Returns an exit code. */
static int measure_pieces(const eval_arguments *args, const thr_plan *plan, thr_bodies *bodies)
{
  thr_err err = {0}, why = {0};
  thr_kit kit = {0};
  const thr_kit_options options = {.profile = args->profile, .names = THR_KIT_NO_NAMES};

  /* The kit takes its sizes from the evaluation of a plan, if there is one. */
  thr_plan asked = *plan;
  asked.evaluation = (thr_evaluation){0};
  int code = cli_physics_apply(&args->pull.physics, &asked.options.physics);
  if (code) return code;
  if (asked.options.physics.bead_mass > 0 || asked.options.physics.bead_strength > 0)
    return cli_usage("eval", "--pieces kit: masses follow from --density and faces are no squares; "
                             "--bead-mass 0 and --bead-strength 0 leave out what is said of them");

  thr_limits limits = cli_limits(0);
  limits.threads = cli_processes();
  thr_status st = thr_kit_make(&kit, &asked, &options, NULL, true, &limits, &why);
  const bool made = !st;
  if (made) st = thr_kit_bodies(&kit, bodies, &why);
  cli_progress_end();
  thr_kit_destroy(&kit);
  if (!st) return EXIT_OK;

  /* The kit's advice is in terms of its own options. */
  thr_fail(&err, st, made ? "%s: %s" : "%s: thread kit (whose --width is --bead-diameter here): %s",
           args->path, why.text);
  return cli_fail(&err);
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
  if (args.pull.method == THR_BY_RISE) {
    const rise_usual usual = {&args.pull.physics, &args.guard, args.pull.newtons,
                              args.pull.options.time_step,
                              cli_given("seed") ? (int)args.pull.options.seed : -1};
    return rise_as_usual(args.path, &usual);
  }

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
  thr_bodies bodies = {0};
  if (!code && args.pieces) code = measure_pieces(&args, &plan, &bodies);
  if (args.pieces) args.pull.options.bodies = &bodies;

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

  if (code == EXIT_LIMIT)
    cli_error(known ? "stopped: only a part is known" : "stopped before any cord was known");

  thr_schedule_destroy(&schedule);
  thr_scratch_free(&bodies.own);
  free(load);
  thr_eval_destroy(&eval);
  thr_plan_destroy(&plan);

  return code;
}
