/* thread eval: how hard must one pull? */
#include "cli/args/load_args.h"
#include "cli/calibrate.h"
#include "cli/print/load_words.h"
#include "cli/print/plain.h"
#include "cli/pull.h"
#include "diagram/overview/still.h"
#include "diagram/overview/tension.h"
#include "eval/eval.h"
#include "eval/joint/drag.h"
#include "eval/structure/holding.h"
#include "eval/structure/settle.h"
#include "graph/framework/frame.h"
#include "graph/framework/units.h"
#include "graph/io/writer.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/advice.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/schedule.h"
#include "graph/status.h"
#include "graph/text.h"
#include "graph/angle.h"
#include "eval/cord/history.h"
#include "eval/cord/profile.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help_method[] =
    "thread eval PLAN [options]: pull force, friction loss and tension along each cord\n\n"
    "Examples:\n"
    "  thread eval plan.json --mu 0.3 --seating 5         newtons at the pulled ends so that 5 N reaches every bead\n"
    "  thread eval plan.json --method joint               joints measured in simulation\n"
    "  thread eval plan.json --method structure --still still.svg   least pull at which the whole can stand\n"
    "  thread eval plan.json -o plan.json --plot tension.svg        keep it in the plan; draw it\n\n"
    "Options:\n"
    "      --method capstan|joint|structure\n"
    "                       capstan: closed form, force = seating tension x exp(mu x turning) (default)\n"
    "                       joint: each joint's friction measured in simulation, along the path the tight cord takes\n"
    "                       structure: least pull at which the rigid beads have any equilibrium while the cord is\n"
    "                       drawn in, and which fails first\n" PULL_HELP("holding pull");
static const char help_rest[] =
    "      --tension        print the tension in every pass\n"
    "      --hand N         the fewest grips with which no pull is above N newtons: where to grip, how hard\n"
    "      --schedule TEXT  what is done to the cords, in order, and the tension that it leaves; or a file "
    "of that:\n"
    "                       \"A: pull both 40; A: release end 5; B: grip 37 20 from start; all: knot both "
    "0.5\"\n"
    "                       (newtons; passes as in steps.txt, or two nodes; a knot may slip by mm: "
    "--stiffness)\n" LOAD_HELP CALIBRATE_HELP "  -o, --output FILE    write the plan with this evaluation in it (- = stdout)\n"
    "      --plot FILE      write a plot of the tension along each cord, as SVG: with a fan over the band of "
    "mu,\n"
    "                       and with lines at what a hand manages and at --cord-strength\n"
    "      --cord-strength N   newtons that the cord bears: says whether the pull would break it\n"
    "      --still FILE     structure: write a picture of the beads before and after the fall, as SVG\n"
    "      --json           everything as JSON\n"
    "  -q, --quiet          no notes and no progress       -h, --help\n\n"
    "Pull is the force at the pulled ends of a cord at which its slackest pass has the seating tension "
    "(capstan, joint), or at "
    "which\n"
    "the structure can just stand while the cord is drawn in (structure). These are different things. The "
    "closed form takes the cord "
    "through the middle of "
    "every\n"
    "bead; a cord thinner than the bore cuts corners, turns less and needs less: method joint knows.\n";

/* One text: as one literal it would be longer than C promises to take. */
static const char *help(void)
{
  static char text[sizeof help_method + sizeof help_rest];
  snprintf(text, sizeof text, "%s%s", help_method, help_rest);
  return text;
}

enum {
  OPTION_TENSION = OPTION_PULL_FREE,
  OPTION_PLOT,
  OPTION_STILL,
  OPTION_STRENGTH,
  OPTION_SCHEDULE,
  OPTION_HAND,
  OPTION_CALIBRATE
};
static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      PULL_OPTIONS,
                                      GUARD_OPTIONS,
                                      LOAD_OPTIONS,
                                      {"tension", no_argument, NULL, OPTION_TENSION},
                                      {"output", required_argument, NULL, 'o'},
                                      {"plot", required_argument, NULL, OPTION_PLOT},
                                      {"still", required_argument, NULL, OPTION_STILL},
                                      {"cord-strength", required_argument, NULL, OPTION_STRENGTH},
                                      {"schedule", required_argument, NULL, OPTION_SCHEDULE},
                                      {"hand", required_argument, NULL, OPTION_HAND},
                                      {"calibrate", required_argument, NULL, OPTION_CALIBRATE},
                                      {NULL, 0, NULL, 0}};

typedef struct {
  pull_args pull;
  guard_limits guard;
  load_args load;
  bool tension;
  const char *path, *output, *plot, *still;
  const char *schedule, *calibrate; /* as given; NULL: none */
  double strength;                  /* N, of the cord; 0 = not said */
} arguments;

/* Needs no plan, and nothing of cord and beads but the bore. */
static int calibrate(const arguments *a, bool with_plan)
{
  thr_physics physics = thr_physics_default();
  if (with_plan) return cli_usage("eval", "--calibrate takes no plan");
  int code = cli_physics_apply(&a->pull.physics, &physics);
  return code ? code : calibrate_run(a->calibrate, physics.bore > 0 ? physics.bore : 2, a->output, a->pull.json);
}

static int parse(int argc, char **argv, arguments *a)
{
  int done, option;
  bool ok;
  *a = (arguments){.guard = guard_limits_default()};
  pull_args_init(&a->pull, THR_CAPSTAN);
  while ((option = cli_physics_option(&a->pull.physics, argc, argv, "eval", ":" CLI_COMMON_LETTERS PULL_LETTERS "o:", table,
                                      help(), &done)) != -1) {
    if (pull_option(&a->pull, "eval", option, optarg, &ok) || guard_option(&a->guard, "eval", option, optarg, &ok) ||
        load_option(&a->load, "eval", option, optarg, &ok)) {
      if (!ok) return EXIT_USAGE;
      continue;
    }
    switch (option) {
    case OPTION_TENSION: a->tension = true; break;
    case 'o': a->output = optarg; break;
    case OPTION_PLOT: a->plot = optarg; break;
    case OPTION_STILL: a->still = optarg; break;
    case OPTION_STRENGTH:
      if (!cli_double("eval", "--cord-strength", optarg, 1e-6, 1e9, &a->strength)) return EXIT_USAGE;
      break;
    case OPTION_SCHEDULE: a->schedule = optarg; break;
    case OPTION_CALIBRATE: a->calibrate = optarg; break;
    case OPTION_HAND:
      if (!cli_double("eval", "--hand", optarg, 1e-6, 1e9, &a->pull.options.hand)) return EXIT_USAGE;
    }
    if (optarg && !*optarg) return cli_usage("eval", "an empty name is no place to write to");
  }
  if (done >= 0) return done;
  if (a->calibrate) return calibrate(a, optind < argc);
  if (optind + 1 != argc)
    return cli_usage("eval", optind == argc ? "which plan?" : "one plan at a time; `thread compare` takes several");
  a->path = argv[optind];
  const char *const out[] = {a->output, a->plot, a->still};
  int to_stdout = a->pull.json;
  for (int i = 0; i < 3; i++)
    to_stdout += out[i] && strcmp(out[i], "-") == 0;
  if (to_stdout > 1) return cli_usage("eval", "only one of --json, -o -, --plot - and --still - can have stdout");
  if (pull_check(&a->pull, "eval")) return EXIT_USAGE;
  if (a->schedule && a->pull.options.hand > 0) return cli_usage("eval", "--hand makes a schedule of its own: no --schedule");
  if (a->pull.options.hand > 0 && a->pull.method == THR_STRUCTURE)
    return cli_usage("eval", "--hand is of the methods capstan and joint; --schedule takes what it says");
  if (a->still && a->pull.method != THR_STRUCTURE) return cli_usage("eval", "--still needs --method structure");
  if (load_any(&a->load) && a->pull.method != THR_STRUCTURE)
    return cli_usage("eval", "--load, --tilt and --clamp-feet are of --method structure");
  if (a->load.rays && a->pull.method != THR_STRUCTURE) return cli_usage("eval", "--rays is of --method structure");
  if (a->load.n_pulls && !a->load.load) return cli_usage("eval", "--load-pulls needs --load");
  if (load_any(&a->load) && a->output)
    return cli_usage("eval", "a plan has no place for --load, --tilt and --clamp-feet: --json instead of -o");
  if (a->still && a->load.load) return cli_usage("eval", "--still shows a simulation, which knows no loads");
  if (a->still && !a->pull.options.dynamics) return cli_usage("eval", "--still shows a simulation; take --no-dynamics away");
  return -1;
}

/* ---- text ---- */

static const char *method_words(const thr_evaluation *evaluation, bool refused)
{
  switch (evaluation->method) {
  case THR_JOINT:
    return refused ? "joints measured in simulation, some turns by closed form, composed along the path of the tight cord"
                   : "joints measured in simulation, composed along the path of the tight cord";
  case THR_STRUCTURE: return "structure: least pull at which rigid beads can stand while the cord is drawn in (limit analysis)";
  default:
    return evaluation->law == THR_LAW_MITRE
               ? "mitred beads, by the closed form; --method joint measures the joints in simulation"
               : "by the closed form exp(mu x turning); --method joint measures the joints in simulation";
  }
}

static void put_heading(thr_text *text, const thr_evaluation *evaluation, bool refused, const char *pulled)
{
  const thr_physics *physics = &evaluation->physics;
  thr_text_printf(text, "%s\nfriction mu = %g (band %g to %g), ", method_words(evaluation, refused), physics->mu, physics->mu_low,
                  physics->mu_high);
  if (evaluation->method == THR_STRUCTURE) {
    thr_text_printf(text, "bead on bead %g, foot on ground %g, ", physics->mu_bead, physics->mu_ground);
    if (physics->bead_mass > 0)
      thr_text_printf(text, "beads of %g g, ", physics->bead_mass);
    else
      thr_text_printf(text, "density %g g/cm3, ", physics->density);
  } else {
    thr_text_printf(text, "seating tension %g N, ", physics->seating);
  }
  if (evaluation->method == THR_JOINT)
    thr_text_printf(text, "cord %.4g mm in bores of %.4g mm, ", physics->cord_diameter, physics->bore);
  thr_text_printf(text, "pulled at: %s\n\n", pulled);
}

/* Measured numbers get fewer digits. */
static int digits(thr_method method)
{
  return method == THR_JOINT ? 4 : 6;
}

static void put_cell(thr_text *text, int width, int n_digits, double value, bool there)
{
  char cell[40] = "-";
  if (there) snprintf(cell, sizeof cell, "%.*g", n_digits, value);
  thr_text_printf(text, " %*s", width, cell);
}

/* What would round to all of it is not all of it. */
static void put_loss(thr_text *text, double loss)
{
  if (loss >= 0.99995 && loss < 1)
    thr_text_append(text, "  >99.99 %");
  else
    thr_text_printf(text, " %7.2f %%", 100 * loss);
}

/* The error of the turns that were measured; if there are others, the pull's is more. */
static void put_error(thr_text *text, const thr_eval_cord *cord)
{
  char cell[40];
  snprintf(cell, sizeof cell, "%s%.2f", cord->refused > 0 ? ">" : "", pull_percent(cord->error));
  thr_text_printf(text, " %6s %%", cell);
}

static void put_cord(thr_text *text, const char *id, const thr_eval_cord *cord, thr_method method)
{
  thr_text_printf(text, "%-5s %8.1f deg", id, thr_degrees(cord->turning));
  if (method == THR_JOINT) thr_text_printf(text, " %8.1f deg", thr_degrees(cord->taut_turning));
  put_cell(text, 12, digits(method), cord->force, true);
  put_cell(text, 13, digits(method), cord->other_force, cord->pull == THR_PULL_BOTH);
  put_loss(text, cord->loss);
  thr_text_printf(text, " %10.4g J", cord->work);
  if (method == THR_JOINT) put_error(text, cord);
  if (cord->pull == THR_PULL_NONE)
    thr_text_append(text, "  not pulled\n");
  else
    thr_text_printf(text, "  %d of %d\n", cord->slackest + 1, cord->n_passes);
}

static void put_cords(thr_text *text, const thr_plan *plan, const thr_evaluation *evaluation)
{
  bool joint = evaluation->method == THR_JOINT;
  thr_text_printf(text, "%-5s %12s%s %12s %13s %9s %12s%s  %s\n", "cord", "turning", joint ? "    when tight" : "", "pull (N)",
                  "other end (N)", "loss", "work per m", joint ? "   error +-" : "", "slackest pass");
  for (int i = 0; i < evaluation->n_cords; i++) {
    if (evaluation->cord[i].known)
      put_cord(text, plan->cord[i].id, &evaluation->cord[i], evaluation->method);
    else
      thr_text_printf(text, "%-5s not known: stopped before\n", plan->cord[i].id);
  }
}

static void put_band_end(thr_text *text, const thr_evaluation *evaluation, double end, bool unit)
{
  bool mitre = evaluation->method == THR_CAPSTAN && evaluation->law == THR_LAW_MITRE;
  if (isfinite(end))
    thr_text_printf(text, unit ? " %.4g N" : " %.4g", end);
  else if (isnan(end))
    thr_text_append(text, " not decided");
  else
    thr_text_append(text, evaluation->method == THR_STRUCTURE ? " no pull holds"
                          : mitre                             ? " no pull, by the mitre law"
                                                              : " over 1e300 N");
}

/* The largest pull over the band of mu; an end of it may be past what a number can hold, or hold nothing at any pull. */
static void put_band(thr_text *text, const thr_evaluation *evaluation, const double band[2])
{
  const thr_physics *physics = &evaluation->physics;
  if (physics->mu_low == physics->mu_high) return;
  thr_text_printf(text, "between mu %g and %g (%s):", physics->mu_low, physics->mu_high,
                  evaluation->method == THR_STRUCTURE ? "limit analysis" : "closed form");
  if (isnan(band[0]) && isnan(band[1])) {
    thr_text_append(text, " not known\n");
    return;
  }
  put_band_end(text, evaluation, band[0], !isfinite(band[1]));
  thr_text_append(text, " ..");
  put_band_end(text, evaluation, band[1], true);
  thr_text_append(text, "\n");
}

/* Can hand and cord do it? */
static void put_hand(thr_text *text, double newton, double strength)
{
  char force[64];
  thr_text_printf(text, "%s is ", plain_force(newton, force));
  plain_put_hand(text, newton);
  thr_text_append(text, "\n");
  if (strength > 0)
    thr_text_printf(text, "a cord that bears %s %s\n", plain_force(strength, force), newton > strength ? "breaks" : "holds");
}

/* What is beyond a hand at once, grips on the way draw in, unless one turn alone is too much; more cords need less. */
static void put_grips(thr_text *text, const thr_plan *plan)
{
  thr_schedule schedule = {0};
  char force[64];
  if (plan->evaluation.largest <= thr_hand_most || plan->evaluation.schedule.n > 0) return;
  const thr_status st = thr_history_grips(plan->cord, thr_hand_most, &plan->evaluation, &schedule, NULL);
  const int grips = thr_schedule_grips(&schedule, -1);
  if (st == THR_OK)
    thr_text_printf(text, "with %d %s on the way no pull is above %s (--hand %g), and more cords need less (thread advise)\n",
                    grips, cli_plural(grips, "grip", "grips"), plain_force(thr_hand_most, force), thr_hand_most);
  else if (st == THR_EINPUT)
    thr_text_append(text, "one turn alone takes more than a hand: more cords, or a smoother cord, need less (thread advise)\n");
  else
    text->failed = true;
  thr_schedule_destroy(&schedule);
}

static void put_sums(thr_text *text, const thr_plan *plan, const thr_eval *eval, double strength)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  thr_text_printf(text, "\nlargest pull %.*g N, all pulls together %.*g N", digits(evaluation->method), evaluation->largest,
                  digits(evaluation->method), evaluation->total);
  if (eval->refused)
    thr_text_printf(text, ", error at least %.2f %%", pull_percent(eval->error));
  else if (eval->error > 0)
    thr_text_printf(text, ", error of each at most %.2f %%", pull_percent(eval->error));
  thr_text_append(text, "\n");
  if (evaluation->schedule.n == 0) put_band(text, evaluation, eval->band);
  if (eval->complete && evaluation->method != THR_STRUCTURE) put_hand(text, evaluation->largest, strength);
  if (eval->complete && evaluation->method != THR_STRUCTURE) put_grips(text, plan);
  if (!eval->complete) {
    thr_text_append(text, "stopped; not known: ");
    pull_unknown_cords(plan, evaluation, text);
    thr_text_append(text, "; the pulls above are those of the other cords\n");
  }
}

static int turns_of(const thr_plan *plan)
{
  int n = 0;
  for (int i = 0; i < plan->n_cords; i++)
    n += plan->cord[i].n_passes - 1;
  return n;
}

static void put_reason(thr_text *text, int n, const char *why)
{
  if (n) thr_text_printf(text, "  %d: %s\n", n, why);
}

static void put_joint(thr_text *text, const thr_plan *plan, const thr_eval *eval)
{
  char sharp[80];
  snprintf(sharp, sizeof sharp, "sharper than %.0f degrees, the sharpest that was validated", thr_degrees(thr_drag_largest_turn));
  if (eval->refused)
    thr_text_printf(text, "%d of %d turns by closed form, whose error is not known:\n", eval->refused, turns_of(plan));
  put_reason(text, eval->refused_sharp, sharp);
  put_reason(text, eval->refused_unsettled, "the cord did not slide steadily; try a smaller --time-step or more --iterations");
  put_reason(text, eval->refused_outside, "out of the simulation's range; try a wider --bore or a smaller --mu");
  if (eval->interpolation > 0)
    thr_text_printf(text,
                    "measured angles, left out one by one, are predicted by their neighbours within %.2g %% of the exponent\n",
                    100 * eval->interpolation);
}

static void put_settle(thr_text *text, const thr_plan *plan, const thr_settle *settle, double equilibrium)
{
  if (settle->status == THR_SETTLE_CREPT) {
    thr_text_printf(text,
                    "simulation     a bead moved at a pull of more than %.6g N, at which an equilibrium exists: the contacts\n"
                    "               crept. No ranking index; try a smaller --start, or a smaller --time-step with more\n"
                    "               --iterations\n",
                    equilibrium);
    return;
  }
  if (settle->status == THR_SETTLE_TOO_LARGE) {
    thr_text_printf(text, "simulation     left out: more than %d beads\n", thr_settle_largest);
    return;
  }
  if (settle->status == THR_SETTLE_NEVER_SETTLED) {
    thr_text_append(text,
                    "simulation     never came to rest under the pull at its start: nothing is known of the fall (nor with\n"
                    "               time step and iterations halved twice). Try a smaller --start, or a smaller --time-step\n"
                    "               with more --iterations\n");
    return;
  }
  if (settle->status == THR_SETTLE_FELL && settle->first_bead >= 0)
    thr_text_printf(text, "simulation     bead %s moves first; widest gap %.3g mm before, %.3g mm after\n",
                    plan->frame.name[settle->first_bead], settle->gap_before, settle->gap_after);
  else
    thr_text_printf(text, "simulation     stands until the pull is gone; widest gap %.3g mm\n", settle->gap_before);
  if (settle->finer < 1)
    thr_text_printf(text, "               it came to rest only with time step and iterations times %g: weaker evidence\n",
                    settle->finer);
  thr_text_printf(text,
                  "ranking index  %.3g of the pull at its start; only its order among plans that begin at one --start means\n"
                  "               anything: no newtons (friction contacts creep)\n",
                  settle->index);
}

/* By itself only if an equilibrium without any pull was found. */
static void put_bounds(thr_text *text, const thr_holding *holding, const char *when)
{
  if (holding->lower > 0)
    thr_text_printf(text, "below %.6g N %s nothing holds it (proved, residual %.1g)", holding->lower, when, holding->residual);
  else if (holding->upper == 0)
    thr_text_append(text, "0 N: it stands by itself");
  else
    thr_text_append(text, "it may stand by itself: not excluded, not shown");
  if (holding->upper > 0 && isfinite(holding->upper)) thr_text_printf(text, "; at %.6g N an equilibrium exists", holding->upper);
  if (!isfinite(holding->upper)) thr_text_append(text, "; no equilibrium was found at any pull");
  thr_text_append(text, "\n");
}

/* The three answers: while cords are drawn in, whatever was done to them, and after what was done. */
static void put_holding(thr_text *text, const thr_eval *eval)
{
  thr_text_append(text, "\nholding pull   ");
  put_bounds(text, &eval->holding, "at the harder ends, while the cords are being drawn in,");
  if (eval->holding.lower > 0 && eval->loosest.present) {
    if (eval->equal.present) {
      thr_text_append(text, "equal pulls    ");
      put_bounds(text, &eval->equal, "at all ends, while the cords are being drawn in,");
    }
    thr_text_append(text, "in any state   ");
    put_bounds(text, &eval->loosest, "at all ends, whatever was done to the cords before,");
  }
}

/* Does it stand after the schedule? */
static void put_after(thr_text *text, const thr_eval *eval)
{
  const thr_holding *after = &eval->after;
  if (!after->present) return;
  thr_text_append(text, "after it       ");
  if (after->upper <= 1)
    thr_text_printf(text, "it stands, and would with %.4g of the tensions", after->upper);
  else if (after->lower > 1)
    thr_text_printf(text, "it falls: %.4g times the tensions are needed (proved)", after->lower);
  else
    thr_text_printf(text, "it may stand or fall: between %.4g and %.4g of the tensions", after->lower, after->upper);
  if (isfinite(eval->let_down)) thr_text_printf(text, "; with all ends let down to %.3g N, too", eval->let_down);
  thr_text_append(text, "\n");
}

static void put_structure(thr_text *text, const arguments *a, const thr_plan *plan, const thr_eval *eval, bool stopped)
{
  const thr_holding *holding = &eval->holding;
  if (!holding->present) return;
  put_holding(text, eval);
  if (holding->first_bead >= 0)
    thr_text_printf(text, "just below     bead %s moves fastest (collapse mechanism)\n", plan->frame.name[holding->first_bead]);
  if (a->load.load) load_put(text, &plan->frame, eval);
  if (!a->pull.options.dynamics || a->load.load) return;
  if (eval->settle.present)
    put_settle(text, plan, &eval->settle, holding->upper);
  else if (plan->frame.n_nodes > thr_settle_largest)
    thr_text_printf(text, "simulation     left out: more than %d beads\n", thr_settle_largest);
  else if (stopped)
    thr_text_append(text, "simulation     stopped: not known\n");
}

static void put_tension(thr_text *text, const thr_plan *plan, const thr_evaluation *evaluation)
{
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];
    if (!evaluation->cord[i].known) continue;
    thr_text_printf(text, "\n%-5s %6s  %-12s %-12s %12s\n", "cord", "pass", "from", "to", "tension (N)");
    for (int k = 0; k < cord->n_passes; k++)
      thr_text_printf(text, "%-5s %6d  %-12s %-12s %12.6g\n", cord->id, k + 1,
                      plan->frame.name[thr_tail(&plan->frame, cord->half[k])],
                      plan->frame.name[thr_head(&plan->frame, cord->half[k])], evaluation->cord[i].tension[k]);
  }
}

/* ---- schedules ---- */

static void put_schedule(thr_text *text, const thr_plan *plan)
{
  const thr_schedule *schedule = &plan->evaluation.schedule;
  const int grips = thr_schedule_grips(schedule, -1);
  thr_text_append(text, "\nschedule");
  if (grips)
    thr_text_printf(text, ", with %d %s on the way (hold each until the next has taken its slack)", grips,
                    cli_plural(grips, "grip", "grips"));
  thr_text_append(text, "\n");
  for (int k = 0; k < schedule->n; k++) {
    thr_text_append(text, "  ");
    thr_schedule_put_step(plan, &schedule->step[k], text);
    thr_text_append(text, "\n");
  }
}

/* The least and largest tension that it leaves, of all cords. */
static void put_left(thr_text *text, const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  double least = INFINITY, most = 0;
  for (int i = 0; i < evaluation->n_cords; i++)
    for (int k = 0; evaluation->cord[i].known && k < evaluation->cord[i].n_passes; k++) {
      least = fmin(least, evaluation->cord[i].tension[k]);
      most = fmax(most, evaluation->cord[i].tension[k]);
    }
  thr_text_printf(text, "afterwards     %.4g to %.4g N in the passes; %s\n", least, most,
                  least >= evaluation->physics.seating * (1 - 1e-9) ? "every one is seated" : "not every one is seated");
}

/* Does a face bear what the cords press it with? */
static void put_pressure(thr_text *text, const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_frame *frame = &plan->frame;
  double pressure;
  int edge;
  if (evaluation->physics.bead_strength == 0) return;
  if (thr_profile_pressure(frame, plan->cord, evaluation, &pressure, &edge, NULL)) {
    text->failed = true;
    return;
  }
  thr_text_append(text, "pressed most   between ");
  thr_text_append_clean(text, frame->name[frame->edge[edge][0]]);
  thr_text_append(text, " and ");
  thr_text_append_clean(text, frame->name[frame->edge[edge][1]]);
  thr_text_printf(text, ": %.3g MPa, which beads that bear %.3g MPa %s\n", pressure, evaluation->physics.bead_strength,
                  pressure > evaluation->physics.bead_strength ? "do not stand: they are crushed" : "stand");
}

static void put_text(thr_text *text, const arguments *a, const thr_plan *plan, const thr_eval *eval, bool stopped)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  put_heading(text, evaluation, eval->refused > 0, evaluation->schedule.n > 0 ? "by the schedule below" : a->pull.pull);
  put_cords(text, plan, evaluation);
  put_sums(text, plan, eval, a->strength);
  put_pressure(text, plan);
  if (evaluation->schedule.n > 0) {
    put_schedule(text, plan);
    put_left(text, plan);
    put_after(text, eval);
  }
  if (evaluation->method == THR_JOINT) put_joint(text, plan, eval);
  if (evaluation->method == THR_STRUCTURE) put_structure(text, a, plan, eval, stopped);
  if (a->tension) put_tension(text, plan, evaluation);
}

/* ---- JSON ---- */

/* Its name, or null if there is none. */
static void put_bead(thr_writer *writer, const char *key, const thr_frame *frame, int bead)
{
  if (bead >= 0)
    thr_write_string(writer, key, frame->name[bead]);
  else
    thr_write_null(writer, key);
}

static void put_json_holding(thr_writer *writer, const thr_frame *frame, const char *key, const thr_holding *holding,
                             const char *when)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, key);
  thr_write_number(writer, "lower", holding->lower);
  thr_write_number(writer, "upper", holding->upper);
  thr_write_number(writer, "residual", holding->residual);
  put_bead(writer, "first_bead", frame, holding->first_bead);
  thr_write_string(writer, "holds", when);
  thr_write_close(writer);
}

/* The three answers of the limit analysis. */
static void put_json_answers(thr_writer *writer, const thr_frame *frame, const thr_eval *eval)
{
  put_json_holding(writer, frame, "holding", &eval->holding, "while the cord is being drawn in");
  if (eval->equal.present)
    put_json_holding(writer, frame, "equal_pulls", &eval->equal,
                     "while the cord is being drawn in, with equal pulls at all ends");
  if (eval->loosest.present)
    put_json_holding(writer, frame, "any_state", &eval->loosest, "force at all ends, whatever was done to the cords before");
  if (!eval->after.present) return;
  put_json_holding(writer, frame, "after", &eval->after, "factor on the tensions that the schedule leaves");
  thr_write_number(writer, "let_down", eval->let_down);
}

static void put_json_simulation(thr_writer *writer, const thr_frame *frame, const thr_settle *settle)
{
  static const char *const status[] = {"fell", "held", "never settled", "too large", "crept"};
  const bool ranked = settle->status == THR_SETTLE_FELL || settle->status == THR_SETTLE_HELD;
  thr_write_line(writer, 1);
  thr_write_object(writer, "simulation");
  thr_write_string(writer, "status", status[settle->status]);
  thr_write_number(writer, "ranking_index", ranked ? settle->index : NAN);
  put_bead(writer, "first_bead", frame, settle->first_bead);
  thr_write_number(writer, "gap_before_mm", settle->gap_before);
  thr_write_number(writer, "gap_after_mm", settle->gap_after);
  thr_write_number(writer, "drift_mm", settle->drift);
  thr_write_number(writer, "finer", settle->finer);
  thr_write_close(writer);
}

static void put_json_joints(thr_writer *writer, const thr_eval *eval)
{
  thr_write_int(writer, "refused_sharp", eval->refused_sharp);
  thr_write_int(writer, "refused_unsettled", eval->refused_unsettled);
  thr_write_int(writer, "refused_outside", eval->refused_outside);
  thr_write_line(writer, 1);
  thr_write_object(writer, "joints");
  thr_write_int(writer, "unsettled", eval->joints_unsettled);
  thr_write_number(writer, "interpolation", eval->interpolation);
  thr_write_close(writer);
}

static void put_json(thr_text *text, const thr_plan *plan, const thr_eval *eval, bool stopped)
{
  thr_writer writer = {.out = text};
  thr_write_object(&writer, NULL);
  thr_write_hash(&writer, "framework", thr_frame_hash(&plan->frame));
  thr_write_bool(&writer, "complete", eval->complete && !stopped);
  thr_evaluation_write(&plan->evaluation, &writer, "evaluation");
  thr_write_line(&writer, 1);
  thr_write_array(&writer, "band");
  thr_write_number(&writer, NULL, eval->band[0]);
  thr_write_number(&writer, NULL, eval->band[1]);
  thr_write_close(&writer);
  thr_write_number(&writer, "error", eval->error);
  thr_write_int(&writer, "refused", eval->refused);
  if (plan->evaluation.method == THR_JOINT) put_json_joints(&writer, eval);
  if (eval->holding.present) put_json_answers(&writer, &plan->frame, eval);
  if (eval->n_carries) load_put_json(&writer, &plan->frame, eval);
  if (eval->holding.present && eval->settle.present) put_json_simulation(&writer, &plan->frame, &eval->settle);
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* ---- outputs ---- */

/* The plan's cords pulled as they were, at another mu, by the closed form. */
static thr_status eval_at(const thr_plan *plan, double mu, thr_eval *out, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_limits none = {0};
  thr_eval_options options = thr_eval_options_default();
  thr_pull *pull = thr_calloc((size_t)evaluation->n_cords, sizeof *pull);
  if (!pull) return thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords; i++)
    pull[i] = evaluation->cord[i].pull;
  options.physics = evaluation->physics;
  options.physics.mu = mu;
  options.physics.mu_low = options.physics.mu_high = 0; /* as they follow from mu */
  options.law = evaluation->law;
  options.cord_pull = pull;
  thr_status st = thr_eval_plan(&plan->frame, plan->cord, plan->n_cords, THR_CAPSTAN, &options, &none, out, err);
  free(pull);
  return st;
}

/* With a fan where the method has one: the limit analysis has none, and beyond 1e300 N nothing is drawn. */
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
  const bool fan = evaluation->method != THR_STRUCTURE && evaluation->schedule.n == 0;
  thr_status st = fan && physics->mu_low < physics->mu_high ? THR_OK : THR_EINFEASIBLE;
  if (!st) st = eval_at(plan, physics->mu_low, &low, &err);
  if (!st) st = eval_at(plan, physics->mu_high, &high, &err);
  options.low = st ? NULL : &low.record;
  options.high = st ? NULL : &high.record;
  if (st != THR_ENOMEM) st = thr_tension_svg(plan, &options, &svg, &err);
  thr_eval_destroy(&low);
  thr_eval_destroy(&high);
  return cli_write_drawn(st, &svg, path, &err);
}

/* Poses come in m and with the ground at 0; the picture wants units of the framework. */
static thr_status draw_still(const thr_plan *plan, const thr_settle *settle, thr_text *svg, thr_err *err)
{
  double mm = 1;
  size_t n = (size_t)settle->n_beads;
  double(*pose)[7] = thr_calloc(2 * n, sizeof *pose);
  thr_status st = pose ? thr_units_in_mm(plan->frame.units, &mm, err) : thr_nomem(err);
  for (size_t v = 0; v < 2 * n && !st; v++) {
    memcpy(pose[v], v < n ? settle->before[v] : settle->after[v - n], sizeof *pose);
    for (int k = 0; k < 3; k++)
      pose[v][k] *= 1000 / mm;
  }
  char note[160];
  snprintf(note, sizeof note, "%s",
           settle->status == THR_SETTLE_HELD ? "It stands until the pull is gone."
                                             : "Before: under the pull at the start. After: the pull let off until it fell.");
  const thr_still still = {.title = "The structure in simulation",
                           .note = note,
                           .width = plan->evaluation.physics.bead_diameter / mm,
                           .before = (const double(*)[7])pose,
                           .after = (const double(*)[7])(pose ? pose + n : NULL),
                           .first_bead = settle->first_bead,
                           .gap_before = settle->gap_before,
                           .gap_after = settle->gap_after};
  if (!st) st = thr_still_svg(&plan->frame, &still, svg, err);
  free(pose);
  return st;
}

static int write_still(const thr_plan *plan, const thr_settle *settle, bool stopped, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0};
  if (stopped && !settle->present) {
    cli_error("%s: not written: stopped before the simulation was done", path);
    return EXIT_OK; /* what stopped it has a code of its own */
  }
  if (!settle->present || !settle->before || !settle->after || settle->status == THR_SETTLE_TOO_LARGE ||
      settle->status == THR_SETTLE_NEVER_SETTLED) {
    cli_error("%s: nothing to draw: %s", path,
              settle->present && settle->status == THR_SETTLE_NEVER_SETTLED ? "the simulation never came to rest"
                                                                            : "there was no simulation");
    return EXIT_INPUT;
  }
  return draw_still(plan, settle, &svg, &err) ? cli_fail(&err) : cli_write(&svg, path);
}

static int write_outputs(const arguments *a, const thr_plan *plan, const thr_eval *eval, bool stopped)
{
  thr_text text = {0};
  int code = EXIT_OK;
  if (a->output) {
    thr_plan_write(plan, &text);
    code = cli_write(&text, a->output);
  }
  if (!code && a->plot) code = write_plot(plan, a->strength, a->plot);
  if (!code && a->still) code = write_still(plan, &eval->settle, stopped, a->still);
  const char *const out[] = {a->output, a->plot, a->still};
  for (int i = 0; i < 3; i++)
    if (out[i] && strcmp(out[i], "-") == 0) return code;
  if (a->pull.json)
    put_json(&text, plan, eval, stopped);
  else
    put_text(&text, a, plan, eval, stopped);
  int printed = cli_write(&text, "-");
  return code ? code : printed;
}

/* A value with a colon is the schedule itself, another one the name of a file of it. EXIT_OK, or printed. */
static int read_schedule(const char *value, const thr_plan *plan, thr_schedule *schedule)
{
  thr_text text = {0};
  thr_err err = {0};
  if (!value) return EXIT_OK;
  const bool file = !strchr(value, ':');
  thr_status st = file ? thr_text_read(&text, value, &err) : THR_OK;
  if (!file) thr_text_append(&text, value);
  if (!st && text.failed) st = thr_nomem(&err);
  if (!st) st = thr_schedule_parse(schedule, plan, text.data, text.length, file ? value : "--schedule", &err);
  thr_text_destroy(&text);
  return st ? cli_fail(&err) : EXIT_OK;
}

static bool any_known(const thr_evaluation *evaluation)
{
  for (int i = 0; i < evaluation->n_cords; i++)
    if (evaluation->cord[i].known) return true;
  return false;
}

int cmd_eval(int argc, char **argv)
{
  arguments a;
  thr_plan plan;
  thr_eval eval = {0};
  guard_end end;
  int code = parse(argc, argv, &a);
  if (code >= 0) return code;
  if (guard_fork(&a.guard, &end)) return guard_conclude(&end, "no result");
  if ((code = cli_read_plan(a.path, &plan))) return code;
  thr_schedule schedule = {0};
  double(*load)[3] = NULL;
  code = read_schedule(a.schedule, &plan, &schedule);
  if (!code) code = load_apply(&a.load, &plan.frame, &a.pull.options, &load);
  if (schedule.n > 0) a.pull.options.schedule = &schedule;
  if (!code) code = pull_eval(&a.pull, a.path, &plan, (thr_method)a.pull.method, &eval);
  bool known = (code == EXIT_OK || code == EXIT_LIMIT) && any_known(&eval.record);
  if (known) { /* the plan takes the record over, so that one thing is written, drawn and printed */
    thr_evaluation_destroy(&plan.evaluation);
    plan.evaluation = eval.record;
    eval.record = (thr_evaluation){0};
    int written = write_outputs(&a, &plan, &eval, code == EXIT_LIMIT);
    if (written) code = written;
    if (plan.evaluation.method == THR_JOINT && code == EXIT_OK) /* on stderr: results do not depend on it */
      cli_note("note: %d %s measured, %d from the cache", eval.joints_measured,
               cli_plural(eval.joints_measured, "joint", "joints"), eval.joints_cached);
  }
  if (code == EXIT_LIMIT) cli_error(known ? "stopped: only a part is known" : "stopped before any cord was known");
  thr_schedule_destroy(&schedule);
  free(load);
  thr_eval_destroy(&eval);
  thr_plan_destroy(&plan);
  return code;
}
