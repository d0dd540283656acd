/* thread eval: how hard must one pull? */
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
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"
#include "graph/angle.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
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
    "                       drawn in, and which fails first\n" PULL_HELP(
        "holding pull") "      --tension        print the tension in every pass\n"
                        "  -o, --output FILE    write the plan with this evaluation in it (- = stdout)\n"
                        "      --plot FILE      write a plot of the tension along each cord, as SVG\n"
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

enum { OPTION_TENSION = OPTION_PULL_FREE, OPTION_PLOT, OPTION_STILL };
static const struct option table[] = {CLI_COMMON_OPTIONS,
                                      PULL_OPTIONS,
                                      GUARD_OPTIONS,
                                      {"tension", no_argument, NULL, OPTION_TENSION},
                                      {"output", required_argument, NULL, 'o'},
                                      {"plot", required_argument, NULL, OPTION_PLOT},
                                      {"still", required_argument, NULL, OPTION_STILL},
                                      {NULL, 0, NULL, 0}};

typedef struct {
  pull_args pull;
  guard_limits guard;
  bool tension;
  const char *path, *output, *plot, *still;
} arguments;

static int parse(int argc, char **argv, arguments *a)
{
  int done, option;
  bool ok;
  *a = (arguments){.guard = guard_limits_default()};
  pull_args_init(&a->pull, THR_CAPSTAN);
  while ((option = cli_physics_option(&a->pull.physics, argc, argv, "eval", ":" CLI_COMMON_LETTERS PULL_LETTERS "o:", table, help,
                                      &done)) != -1) {
    if (pull_option(&a->pull, "eval", option, optarg, &ok) || guard_option(&a->guard, "eval", option, optarg, &ok)) {
      if (!ok) return EXIT_USAGE;
      continue;
    }
    switch (option) {
    case OPTION_TENSION: a->tension = true; break;
    case 'o': a->output = optarg; break;
    case OPTION_PLOT: a->plot = optarg; break;
    case OPTION_STILL: a->still = optarg; break;
    }
    if (optarg && !*optarg) return cli_usage("eval", "an empty name is no place to write to");
  }
  if (done >= 0) return done;
  if (optind + 1 != argc)
    return cli_usage("eval", optind == argc ? "which plan?" : "one plan at a time; `thread compare` takes several");
  a->path = argv[optind];
  const char *const out[] = {a->output, a->plot, a->still};
  int to_stdout = a->pull.json;
  for (int i = 0; i < 3; i++)
    to_stdout += out[i] && strcmp(out[i], "-") == 0;
  if (to_stdout > 1) return cli_usage("eval", "only one of --json, -o -, --plot - and --still - can have stdout");
  if (pull_check(&a->pull, "eval")) return EXIT_USAGE;
  if (a->still && a->pull.method != THR_STRUCTURE) return cli_usage("eval", "--still needs --method structure");
  if (a->still && !a->pull.options.dynamics) return cli_usage("eval", "--still shows a simulation; take --no-dynamics away");
  return -1;
}

/* ---- text ---- */

static const char *method_words(const thr_evaluation *r, bool refused)
{
  switch (r->method) {
  case THR_JOINT:
    return refused ? "joints measured in simulation, some turns by closed form, composed along the path of the tight cord"
                   : "joints measured in simulation, composed along the path of the tight cord";
  case THR_STRUCTURE: return "structure: least pull at which rigid beads can stand while the cord is drawn in (limit analysis)";
  default:
    return r->law == THR_LAW_MITRE ? "mitred beads, closed form; --method joint measures joints in simulation"
                                   : "capstan law, closed form; --method joint measures joints in simulation";
  }
}

static void put_heading(thr_text *t, const thr_evaluation *r, bool refused, const char *pulled)
{
  const thr_physics *p = &r->physics;
  thr_text_printf(t, "%s\nmu = %g (band %g to %g), ", method_words(r, refused), p->mu, p->mu_low, p->mu_high);
  if (r->method == THR_STRUCTURE) {
    thr_text_printf(t, "bead on bead %g, foot on ground %g, ", p->mu_bead, p->mu_ground);
    if (p->bead_mass > 0)
      thr_text_printf(t, "beads of %g g, ", p->bead_mass);
    else
      thr_text_printf(t, "density %g g/cm3, ", p->density);
  } else {
    thr_text_printf(t, "seating tension %g N, ", p->seating);
  }
  if (r->method == THR_JOINT) thr_text_printf(t, "cord %.4g mm in bores of %.4g mm, ", p->cord_diameter, p->bore);
  thr_text_printf(t, "pulled at: %s\n\n", pulled);
}

/* Measured numbers get fewer digits. */
static int digits(thr_method method)
{
  return method == THR_JOINT ? 4 : 6;
}

static void put_cell(thr_text *t, int width, int n_digits, double value, bool there)
{
  char cell[40] = "-";
  if (there) snprintf(cell, sizeof cell, "%.*g", n_digits, value);
  thr_text_printf(t, " %*s", width, cell);
}

/* What would round to all of it is not all of it. */
static void put_loss(thr_text *t, double loss)
{
  if (loss >= 0.99995 && loss < 1)
    thr_text_append(t, "  >99.99 %");
  else
    thr_text_printf(t, " %7.2f %%", 100 * loss);
}

/* The error of the turns that were measured; if there are others, the pull's is more. */
static void put_error(thr_text *t, const thr_eval_cord *c)
{
  char cell[40];
  snprintf(cell, sizeof cell, "%s%.2f", c->refused > 0 ? ">" : "", pull_percent(c->error));
  thr_text_printf(t, " %6s %%", cell);
}

static void put_cord(thr_text *t, const char *id, const thr_eval_cord *c, thr_method method)
{
  thr_text_printf(t, "%-5s %8.1f deg", id, thr_degrees(c->turning));
  if (method == THR_JOINT) thr_text_printf(t, " %8.1f deg", thr_degrees(c->taut_turning));
  put_cell(t, 12, digits(method), c->force, true);
  put_cell(t, 13, digits(method), c->other_force, c->pull == THR_PULL_BOTH);
  put_loss(t, c->loss);
  thr_text_printf(t, " %10.4g J", c->work);
  if (method == THR_JOINT) put_error(t, c);
  thr_text_printf(t, "  %d of %d\n", c->slackest + 1, c->n_passes);
}

static void put_cords(thr_text *t, const thr_plan *p, const thr_evaluation *r)
{
  bool joint = r->method == THR_JOINT;
  thr_text_printf(t, "%-5s %12s%s %12s %13s %9s %12s%s  %s\n", "cord", "turning", joint ? "    when tight" : "", "pull (N)",
                  "other end (N)", "loss", "work per m", joint ? "   error +-" : "", "slackest pass");
  for (int i = 0; i < r->n_cords; i++) {
    if (r->cord[i].known)
      put_cord(t, p->cord[i].id, &r->cord[i], r->method);
    else
      thr_text_printf(t, "%-5s not known: stopped before\n", p->cord[i].id);
  }
}

static void put_band_end(thr_text *t, const thr_evaluation *r, double end, bool unit)
{
  bool mitre = r->method == THR_CAPSTAN && r->law == THR_LAW_MITRE;
  if (isfinite(end))
    thr_text_printf(t, unit ? " %.4g N" : " %.4g", end);
  else if (isnan(end))
    thr_text_append(t, " not decided");
  else
    thr_text_append(t, r->method == THR_STRUCTURE ? " no pull holds" : mitre ? " no pull, by the mitre law" : " over 1e300 N");
}

/* The largest pull over the band of mu; an end of it may be past what a number can hold, or hold nothing at any pull. */
static void put_band(thr_text *t, const thr_evaluation *r, const double band[2])
{
  const thr_physics *p = &r->physics;
  if (p->mu_low == p->mu_high) return;
  thr_text_printf(t, "between mu %g and %g (%s):", p->mu_low, p->mu_high,
                  r->method == THR_STRUCTURE ? "limit analysis" : "closed form");
  if (isnan(band[0]) && isnan(band[1])) {
    thr_text_append(t, " not known\n");
    return;
  }
  put_band_end(t, r, band[0], !isfinite(band[1]));
  thr_text_append(t, " ..");
  put_band_end(t, r, band[1], true);
  thr_text_append(t, "\n");
}

static void put_sums(thr_text *t, const thr_plan *p, const thr_eval *e)
{
  const thr_evaluation *r = &p->evaluation;
  thr_text_printf(t, "\nlargest pull %.*g N, all pulls together %.*g N", digits(r->method), r->largest, digits(r->method),
                  r->total);
  if (e->refused)
    thr_text_printf(t, ", error at least %.2f %%", pull_percent(e->error));
  else if (e->error > 0)
    thr_text_printf(t, ", error of each at most %.2f %%", pull_percent(e->error));
  thr_text_append(t, "\n");
  put_band(t, r, e->band);
  if (!e->complete) {
    thr_text_append(t, "stopped; not known: ");
    pull_unknown_cords(p, r, t);
    thr_text_append(t, "; the pulls above are those of the other cords\n");
  }
}

static int turns_of(const thr_plan *p)
{
  int n = 0;
  for (int i = 0; i < p->n_cords; i++)
    n += p->cord[i].n_passes - 1;
  return n;
}

static void put_reason(thr_text *t, int n, const char *why)
{
  if (n) thr_text_printf(t, "  %d: %s\n", n, why);
}

static void put_joint(thr_text *t, const thr_plan *p, const thr_eval *e)
{
  char sharp[80];
  snprintf(sharp, sizeof sharp, "sharper than %.0f degrees, the sharpest that was validated", thr_degrees(thr_drag_largest_turn));
  if (e->refused) thr_text_printf(t, "%d of %d turns by closed form, whose error is not known:\n", e->refused, turns_of(p));
  put_reason(t, e->refused_sharp, sharp);
  put_reason(t, e->refused_unsettled, "the cord did not slide steadily; try a smaller --time-step or more --iterations");
  put_reason(t, e->refused_outside, "out of the simulation's range; try a wider --bore or a smaller --mu");
  if (e->interpolation > 0)
    thr_text_printf(t, "measured angles, left out one by one, are predicted by their neighbours within %.2g %% of the exponent\n",
                    100 * e->interpolation);
}

static void put_settle(thr_text *t, const thr_plan *p, const thr_settle *s, double equilibrium)
{
  if (s->status == THR_SETTLE_CREPT) {
    thr_text_printf(t,
                    "simulation     a bead moved at a pull of more than %.6g N, at which an equilibrium exists: the contacts\n"
                    "               crept. No ranking index; try a smaller --start, or a smaller --time-step with more\n"
                    "               --iterations\n",
                    equilibrium);
    return;
  }
  if (s->status == THR_SETTLE_TOO_LARGE) {
    thr_text_printf(t, "simulation     left out: more than %d beads\n", thr_settle_largest);
    return;
  }
  if (s->status == THR_SETTLE_NEVER_SETTLED) {
    thr_text_append(t, "simulation     never came to rest under the pull at its start: nothing is known of the fall (nor with\n"
                       "               time step and iterations halved twice). Try a smaller --start, or a smaller --time-step\n"
                       "               with more --iterations\n");
    return;
  }
  if (s->status == THR_SETTLE_FELL && s->first_bead >= 0)
    thr_text_printf(t, "simulation     bead %s moves first; widest gap %.3g mm before, %.3g mm after\n",
                    p->frame.name[s->first_bead], s->gap_before, s->gap_after);
  else
    thr_text_printf(t, "simulation     stands until the pull is gone; widest gap %.3g mm\n", s->gap_before);
  if (s->finer < 1)
    thr_text_printf(t, "               it came to rest only with time step and iterations times %g: weaker evidence\n", s->finer);
  thr_text_printf(t,
                  "ranking index  %.3g of the pull at its start; only its order among plans that begin at one --start means\n"
                  "               anything: no newtons (friction contacts creep)\n",
                  s->index);
}

/* By itself only if an equilibrium without any pull was found. */
static void put_holding(thr_text *t, const thr_holding *h)
{
  if (h->lower > 0)
    thr_text_printf(t,
                    "\nholding pull   below %.6g N nothing can hold it while the cord is being drawn in (proved, residual %.1g)",
                    h->lower, h->residual);
  else if (h->upper == 0)
    thr_text_append(t, "\nholding pull   0 N: it stands by itself");
  else
    thr_text_append(t, "\nholding pull   it may stand by itself: not excluded, not shown");
  if (h->upper > 0 && isfinite(h->upper)) thr_text_printf(t, "; at %.6g N an equilibrium exists", h->upper);
  if (!isfinite(h->upper)) thr_text_append(t, "; no equilibrium was found at any pull");
  thr_text_append(t, "\n");
  if (h->lower > 0)
    thr_text_append(
        t, "               (a cord that was pulled and let go keeps tension inside: it may hold at a hundredth of it)\n");
}

static void put_structure(thr_text *t, const arguments *a, const thr_plan *p, const thr_eval *e, bool stopped)
{
  const thr_holding *h = &e->holding;
  if (!h->present) return;
  put_holding(t, h);
  if (h->first_bead >= 0)
    thr_text_printf(t, "just below     bead %s moves fastest (collapse mechanism)\n", p->frame.name[h->first_bead]);
  if (!a->pull.options.dynamics) return;
  if (e->settle.present)
    put_settle(t, p, &e->settle, h->upper);
  else if (p->frame.n_nodes > thr_settle_largest)
    thr_text_printf(t, "simulation     left out: more than %d beads\n", thr_settle_largest);
  else if (stopped)
    thr_text_append(t, "simulation     stopped: not known\n");
}

static void put_tension(thr_text *t, const thr_plan *p, const thr_evaluation *r)
{
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    if (!r->cord[i].known) continue;
    thr_text_printf(t, "\n%-5s %6s  %-12s %-12s %12s\n", "cord", "pass", "from", "to", "tension (N)");
    for (int k = 0; k < c->n_passes; k++)
      thr_text_printf(t, "%-5s %6d  %-12s %-12s %12.6g\n", c->id, k + 1, p->frame.name[thr_tail(&p->frame, c->half[k])],
                      p->frame.name[thr_head(&p->frame, c->half[k])], r->cord[i].tension[k]);
  }
}

static void put_text(thr_text *t, const arguments *a, const thr_plan *p, const thr_eval *e, bool stopped)
{
  const thr_evaluation *r = &p->evaluation;
  put_heading(t, r, e->refused > 0, a->pull.pull);
  put_cords(t, p, r);
  put_sums(t, p, e);
  if (r->method == THR_JOINT) put_joint(t, p, e);
  if (r->method == THR_STRUCTURE) put_structure(t, a, p, e, stopped);
  if (a->tension) put_tension(t, p, r);
}

/* ---- JSON ---- */

/* Its name, or null if there is none. */
static void put_bead(thr_writer *w, const char *key, const thr_frame *f, int bead)
{
  if (bead >= 0)
    thr_write_string(w, key, f->name[bead]);
  else
    thr_write_null(w, key);
}

static void put_json_holding(thr_writer *w, const thr_frame *f, const thr_holding *h)
{
  thr_write_line(w, 1);
  thr_write_object(w, "holding");
  thr_write_number(w, "lower", h->lower);
  thr_write_number(w, "upper", h->upper);
  thr_write_number(w, "residual", h->residual);
  put_bead(w, "first_bead", f, h->first_bead);
  thr_write_string(w, "holds", "while the cord is being drawn in");
  thr_write_close(w);
}

static void put_json_simulation(thr_writer *w, const thr_frame *f, const thr_settle *s)
{
  static const char *const status[] = {"fell", "held", "never settled", "too large", "crept"};
  const bool ranked = s->status == THR_SETTLE_FELL || s->status == THR_SETTLE_HELD;
  thr_write_line(w, 1);
  thr_write_object(w, "simulation");
  thr_write_string(w, "status", status[s->status]);
  thr_write_number(w, "ranking_index", ranked ? s->index : NAN);
  put_bead(w, "first_bead", f, s->first_bead);
  thr_write_number(w, "gap_before_mm", s->gap_before);
  thr_write_number(w, "gap_after_mm", s->gap_after);
  thr_write_number(w, "drift_mm", s->drift);
  thr_write_number(w, "finer", s->finer);
  thr_write_close(w);
}

static void put_json_joints(thr_writer *w, const thr_eval *e)
{
  thr_write_int(w, "refused_sharp", e->refused_sharp);
  thr_write_int(w, "refused_unsettled", e->refused_unsettled);
  thr_write_int(w, "refused_outside", e->refused_outside);
  thr_write_line(w, 1);
  thr_write_object(w, "joints");
  thr_write_int(w, "unsettled", e->joints_unsettled);
  thr_write_number(w, "interpolation", e->interpolation);
  thr_write_close(w);
}

static void put_json(thr_text *t, const thr_plan *p, const thr_eval *e, bool stopped)
{
  thr_writer w = {.out = t};
  thr_write_object(&w, NULL);
  thr_write_hash(&w, "framework", thr_frame_hash(&p->frame));
  thr_write_bool(&w, "complete", e->complete && !stopped);
  thr_evaluation_write(&p->evaluation, &w, "evaluation");
  thr_write_line(&w, 1);
  thr_write_array(&w, "band");
  thr_write_number(&w, NULL, e->band[0]);
  thr_write_number(&w, NULL, e->band[1]);
  thr_write_close(&w);
  thr_write_number(&w, "error", e->error);
  thr_write_int(&w, "refused", e->refused);
  if (p->evaluation.method == THR_JOINT) put_json_joints(&w, e);
  if (e->holding.present) put_json_holding(&w, &p->frame, &e->holding);
  if (e->holding.present && e->settle.present) put_json_simulation(&w, &p->frame, &e->settle);
  thr_write_close(&w);
  thr_text_append(t, "\n");
}

/* ---- outputs ---- */

static int write_plot(const thr_plan *p, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0};
  thr_tension_options o = thr_tension_options_default();
  return thr_tension_svg(p, &o, &svg, &err) ? cli_fail(&err) : cli_write(&svg, path);
}

/* Poses come in m and with the ground at 0; the picture wants units of the framework. */
static thr_status draw_still(const thr_plan *p, const thr_settle *s, thr_text *svg, thr_err *err)
{
  double mm = 1;
  size_t n = (size_t)s->n_beads;
  double(*pose)[7] = thr_calloc(2 * n, sizeof *pose);
  thr_status st = pose ? thr_units_in_mm(p->frame.units, &mm, err) : thr_nomem(err);
  for (size_t v = 0; v < 2 * n && !st; v++) {
    memcpy(pose[v], v < n ? s->before[v] : s->after[v - n], sizeof *pose);
    for (int k = 0; k < 3; k++)
      pose[v][k] *= 1000 / mm;
  }
  char note[160];
  snprintf(note, sizeof note, "%s",
           s->status == THR_SETTLE_HELD ? "It stands until the pull is gone."
                                        : "Before: under the pull at the start. After: the pull let off until it fell.");
  const thr_still still = {.title = "The structure in simulation",
                           .note = note,
                           .width = p->evaluation.physics.bead_diameter / mm,
                           .before = (const double(*)[7])pose,
                           .after = (const double(*)[7])(pose ? pose + n : NULL),
                           .first_bead = s->first_bead,
                           .gap_before = s->gap_before,
                           .gap_after = s->gap_after};
  if (!st) st = thr_still_svg(&p->frame, &still, svg, err);
  free(pose);
  return st;
}

static int write_still(const thr_plan *p, const thr_settle *s, bool stopped, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0};
  if (stopped && !s->present) {
    cli_error("%s: not written: stopped before the simulation was done", path);
    return EXIT_OK; /* what stopped it has a code of its own */
  }
  if (!s->present || !s->before || !s->after || s->status == THR_SETTLE_TOO_LARGE || s->status == THR_SETTLE_NEVER_SETTLED) {
    cli_error("%s: nothing to draw: %s", path,
              s->present && s->status == THR_SETTLE_NEVER_SETTLED ? "the simulation never came to rest"
                                                                  : "there was no simulation");
    return EXIT_INPUT;
  }
  return draw_still(p, s, &svg, &err) ? cli_fail(&err) : cli_write(&svg, path);
}

static int write_outputs(const arguments *a, const thr_plan *p, const thr_eval *e, bool stopped)
{
  thr_text t = {0};
  int code = EXIT_OK;
  if (a->output) {
    thr_plan_write(p, &t);
    code = cli_write(&t, a->output);
  }
  if (!code && a->plot) code = write_plot(p, a->plot);
  if (!code && a->still) code = write_still(p, &e->settle, stopped, a->still);
  const char *const out[] = {a->output, a->plot, a->still};
  for (int i = 0; i < 3; i++)
    if (out[i] && strcmp(out[i], "-") == 0) return code;
  if (a->pull.json)
    put_json(&t, p, e, stopped);
  else
    put_text(&t, a, p, e, stopped);
  int printed = cli_write(&t, "-");
  return code ? code : printed;
}

static bool any_known(const thr_evaluation *e)
{
  for (int i = 0; i < e->n_cords; i++)
    if (e->cord[i].known) return true;
  return false;
}

int cmd_eval(int argc, char **argv)
{
  arguments a;
  thr_plan p;
  thr_eval e;
  guard_end end;
  int code = parse(argc, argv, &a);
  if (code >= 0) return code;
  if (guard_fork(&a.guard, &end)) return guard_conclude(&end, "no result");
  if ((code = cli_read_plan(a.path, &p))) return code;
  code = pull_eval(&a.pull, a.path, &p, (thr_method)a.pull.method, &e);
  bool known = (code == EXIT_OK || code == EXIT_LIMIT) && any_known(&e.record);
  if (known) { /* the plan takes the record over, so that one thing is written, drawn and printed */
    thr_evaluation_destroy(&p.evaluation);
    p.evaluation = e.record;
    e.record = (thr_evaluation){0};
    int written = write_outputs(&a, &p, &e, code == EXIT_LIMIT);
    if (written) code = written;
    if (p.evaluation.method == THR_JOINT && code == EXIT_OK) /* on stderr: results do not depend on it */
      cli_note("note: %d %s measured, %d from the cache", e.joints_measured, cli_plural(e.joints_measured, "joint", "joints"),
               e.joints_cached);
  }
  if (code == EXIT_LIMIT) cli_error(known ? "stopped: only a part is known" : "stopped before any cord was known");
  thr_eval_destroy(&e);
  thr_plan_destroy(&p);
  return code;
}
