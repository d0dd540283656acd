/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread compare: plans of one framework side by side, ranked by how hard they are to pull. */
#include "cli/args/load_args.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/io/writer.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/schedule.h"
#include "graph/process/threads.h"
#include "graph/status.h"
#include "graph/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread compare PLAN.. [options]: plans of one framework side by side; * marks the best of "
    "each row\n\n"
    "Examples:\n"
    "  thread compare closed.json feet.json --mu 0.3           ranked by pull, joints measured in "
    "simulation\n"
    "  thread compare closed.json feet.json --method capstan   the same by the closed form, at "
    "once\n"
    "  thread compare data/dome7-*.json --method all           closed form, joints, structure: do "
    "they agree?\n"
    "  thread compare data/dome7-*.json --method structure --load D4=1 --schedule \"all: pull both "
    "20\"\n"
    "                                                          by what they carry, drawn in and "
    "afterwards\n";
static const char outro[] =
    "A difference within the measured error is a tie. The simulation of the structure runs twice "
    "for each plan, the second\n"
    "time with half the time step; only what both runs and their errors tell apart is no tie. It "
    "takes minutes;\n"
    "--no-dynamics is fast; it knows no loads, leaning ground, held feet and schedules, and is "
    "left out with them.\n";

enum {
  CAPSTAN,
  JOINT,
  HOLDING,
  STANDING,
  AFTER,
  LOADED,
  CARRIED,
  CARRIED_AFTER,
  SIMULATION,
  N_RANKINGS
};

/* What is done to the structures beside pulling. */
typedef struct {
  load_args load;
  const char *schedule; /* as given; NULL: none */
} deeds;

typedef compare_entry entry;

/* Is method i part of this comparison? */
static bool wanted(const pull_args *a, thr_method i)
{
  return i == THR_CAPSTAN || a->method == (int)i || a->method == PULL_ALL_METHODS;
}

/* ---- rankings ---- */

/* A pull or a factor that is needed: from what is proved to what was found. */
static void rank_need(ranking *r, const thr_holding *holding, int i)
{
  r->value[i] = r->low[i] = holding->present ? holding->lower : NAN; /* INFINITY: none does */
  r->high[i] = holding->upper >= holding->lower ? holding->upper : INFINITY;
}

/* What is carried, the most first. */
static void rank_carry(ranking *r, const thr_carry *carry, int i)
{
  r->value[i] = r->high[i] = carry->first_bead < 0 ? NAN : -carry->carried;
  r->low[i] = -carry->beyond;
}

/* The values of plan i at both ends of a band of friction. */
static void rank_band(ranking *r, int band, const double value[2], int i)
{
  for (int end = 0; end < 2; end++)
    r->end[2 * band + end][i] = r->most ? -value[end] : value[end];
}

/* Fills what the frictions do to the value of plan i, as far as it is known. */
static void rank_bands(ranking *r, int by, const entry *e, int i)
{
  static const thr_asked of[N_RANKINGS] = {
      [HOLDING] = THR_ASKED_HOLDING, [STANDING] = THR_ASKED_ANY_STATE,
      [AFTER] = THR_ASKED_AFTER,     [LOADED] = THR_ASKED_LOADED,
      [CARRIED] = THR_ASKED_CARRIED, [CARRIED_AFTER] = THR_ASKED_CARRIED_AFTER};
  const thr_eval *structure = &e->eval[THR_STRUCTURE];
  if (by == CAPSTAN || by == JOINT) {
    if (!isnan(r->value[i]))
      rank_band(r, 0, e->eval[by == CAPSTAN ? THR_CAPSTAN : THR_JOINT].band, i);
  } else if (by == CARRIED) {
    if (structure->n_carries) rank_band(r, 1, structure->carries[0].band_beads, i);
  } else if (by != SIMULATION && structure->record.present) {
    rank_band(r, 1, structure->band_beads[of[by]], i);
    if (by == HOLDING || by == STANDING)
      rank_band(r, 0, by == HOLDING ? structure->band : structure->band_any, i);
  }
}

/* Fills value and interval of plan i; leaves it unknown if it is. */
static void rank_plan(ranking *r, int by, const entry *e, int i)
{
  const thr_eval *structure = &e->eval[THR_STRUCTURE];
  switch (by) {
  case CAPSTAN:
    r->value[i] = compare_largest(e, THR_CAPSTAN);
    r->low[i] = r->value[i] * (1 - 1e-6);
    r->high[i] = r->value[i] * (1 + 1e-6);
    break;
  case JOINT:
    r->value[i] = compare_largest(e, THR_JOINT);
    r->low[i] = r->value[i] * exp(-e->eval[THR_JOINT].error);
    r->high[i] =
        e->eval[THR_JOINT].refused ? INFINITY : r->value[i] * exp(e->eval[THR_JOINT].error);
    break;
  case HOLDING: rank_need(r, &structure->holding, i); break;
  case STANDING: rank_need(r, &structure->loosest, i); break;
  case AFTER: rank_need(r, &structure->after, i); break;
  case LOADED: rank_need(r, &structure->loaded, i); break;
  case CARRIED:
    if (structure->n_carries) rank_carry(r, &structure->carries[0].carry, i);
    break;
  case CARRIED_AFTER:
    if (structure->after.present) rank_carry(r, &structure->after_carries, i);
    break;
  default:
    r->value[i] = isnan(e->fall[1]) ? NAN : e->fall[0];
    r->low[i] = fmin(e->fall[0] - e->fall_error[0], e->fall[1] - e->fall_error[1]);
    r->high[i] = fmax(e->fall[0] + e->fall_error[0], e->fall[1] + e->fall_error[1]);
  }
}

static bool simulated(const entry *e, int n)
{
  for (int i = 0; i < n; i++)
    if (!isnan(e[i].fall[0])) return true;
  return false;
}

/* Was this asked of any plan? */
static bool asked(int by, const entry *e, int n)
{
  if (by == SIMULATION) return simulated(e, n);
  for (int i = 0; i < n; i++) {
    const thr_eval *structure = &e[i].eval[THR_STRUCTURE];
    if (by < STANDING || (by == STANDING && structure->loosest.present) ||
        (by == AFTER && structure->after.present) ||
        ((by == LOADED || by == CARRIED) && structure->n_carries > 0) ||
        (by == CARRIED_AFTER && structure->after.present && structure->n_carries > 0))
      return true;
  }
  return false;
}

/* Those of the wanted methods, one after the other; *count of them. */
static thr_status make_rankings(const pull_args *a, const entry *e, int n, ranking *r, int *count,
                                thr_err *err)
{
  static const ranking kind[N_RANKINGS] = {
      [CAPSTAN] = {.title = "seating pull, closed form", .key = "capstan", .unit = " N"},
      [JOINT] = {.title = "seating pull, joints measured in simulation (+-: their scatter, drift "
                          "and interpolation; mu as given)",
                 .key = "joint",
                 .unit = " N",
                 .error = true,
                 .open = "some turns by closed form, their error is not known"},
      [HOLDING] = {.title = "holding pull while drawn in (below the first force nothing holds it, "
                            "at the second an equilibrium exists)",
                   .key = "holding",
                   .unit = " N"},
      [STANDING] = {.title = "force at all ends once the cords are in, in any state that friction "
                             "keeps (the same two forces)",
                    .key = "any_state",
                    .unit = " N"},
      [AFTER] = {.title = "part of the tensions after the schedule that would do (the same two, "
                          "over 1: it falls)",
                 .key = "after",
                 .unit = ""},
      [LOADED] = {.title = "pull at all ends that carries the load while the cords are drawn in "
                           "(the same two forces)",
                  .key = "loaded",
                  .unit = " N"},
      [CARRIED] = {.title = "load carried at the pull that was given, while the cords are drawn in "
                            "(at the first an equilibrium exists, above "
                            "the second nothing holds it)",
                   .key = "carried",
                   .unit = " x",
                   .most = true},
      [CARRIED_AFTER] = {.title = "load carried after the schedule (the same two)",
                         .key = "carried_after",
                         .unit = " x",
                         .most = true},
      [SIMULATION] = {.title = "pull at which the structure falls in simulation (from where it is "
                               "seen to where it begins, with both time "
                               "steps; nothing else is in it)",
                      .key = "simulation",
                      .unit = " N"}};
  bool all = a->method == PULL_ALL_METHODS;
  *count = 0;
  for (int by = 0; by < N_RANKINGS; by++) {
    const thr_method method = by == CAPSTAN ? THR_CAPSTAN : by == JOINT ? THR_JOINT : THR_STRUCTURE;
    if ((!all && a->method != (int)method) || !asked(by, e, n)) continue;
    r[*count] = kind[by];
    thr_status st = ranking_init(&r[*count], n, err);
    if (st) return st;
    for (int i = 0; i < n; i++) {
      rank_plan(&r[*count], by, &e[i], i);
      rank_bands(&r[*count], by, &e[i], i);
    }
    ranking_make(&r[(*count)++]);
  }
  return THR_OK;
}

/* The first two rankings that contradict each other, and about which plans; false if they all
 * agree. */
static bool find_disagreement(const ranking *r, int count, int which[2], int pair[2])
{
  for (which[0] = 0; which[0] < count; which[0]++)
    for (which[1] = which[0] + 1; which[1] < count; which[1]++)
      if (ranking_disagree(&r[which[0]], &r[which[1]], pair)) return true;
  return false;
}

static bool same_order(const ranking *a, const ranking *b)
{
  if (a->n_ranked != b->n_ranked) return false;
  for (int k = 0; k < a->n_ranked; k++)
    if (a->order[k] != b->order[k] || a->rank[a->order[k]] != b->rank[b->order[k]]) return false;
  return true;
}

/* Which rankings that tell plans apart have which order: "lines.json, stairs.json = snake.json  by
 * holding, carried". */
static void put_orders(const ranking *r, int count, const char *const *name, thr_text *text)
{
  thr_text_append(text, "the rankings disagree:\n");
  for (int i = 0; i < count; i++) {
    bool said = !ranking_tells_apart(&r[i]);
    for (int k = 0; k < i; k++)
      said |= same_order(&r[k], &r[i]);
    if (said) continue;
    for (int k = 0; k < r[i].n_ranked; k++)
      thr_text_printf(text, "%s%s",
                      k == 0                                                    ? "  "
                      : ranking_is_tie(&r[i], r[i].order[k - 1], r[i].order[k]) ? " = "
                                                                                : ", ",
                      name[r[i].order[k]]);
    for (int k = i; k < count; k++)
      if (same_order(&r[k], &r[i]))
        thr_text_printf(text, "%s%s", k == i ? "  by " : ", ", r[k].key);
    thr_text_append(text, "\n");
  }
}

/* Rankings that agree say little if all of them ask for the pull while cords are drawn in. */
static void put_agreement(const ranking *r, int count, const char *const *name, thr_text *text)
{
  bool let_go = false;
  int orders = 0; /* that tell any plans apart */
  for (int i = 0; i < count; i++) {
    const bool apart = ranking_tells_apart(&r[i]);
    orders += apart;
    let_go |= apart && (strcmp(r[i].key, "any_state") == 0 || strstr(r[i].key, "after"));
  }
  int which[2], pair[2];
  if (orders < 2) return;
  if (find_disagreement(r, count, which, pair))
    put_orders(r, count, name, text);
  else
    thr_text_append(
        text,
        let_go
            ? "the rankings agree, while cords are drawn in and afterwards, ties aside\n"
            : "the rankings agree, ties aside; both ask for the pull while cords are drawn in\n");
}

/* ---- output ---- */

/* Names that are wider than a column stand above the table, with numbers. */
static void put_names(thr_text *text, const entry *e, int n)
{
  bool wide = false;
  for (int i = 0; i < n; i++)
    wide |= strlen(e[i].path) > 16;
  for (int i = 0; i < n && wide; i++)
    thr_text_printf(text, "plan %d  %s\n", i + 1, e[i].path);
  thr_text_printf(text, "%s%-32s", wide ? "\n" : "", "");
  for (int i = 0; i < n; i++) {
    char number[24];
    snprintf(number, sizeof number, "plan %d", i + 1);
    thr_text_printf(text, " %16s ", wide ? number : e[i].path);
  }
}

static void put_head(thr_text *text, const entry *e, int n)
{
  put_names(text, e, n);
  thr_text_printf(text, "\n%-32s", "objective");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, " %16s ", thr_objective_name(thr_aims_objective(&e[i].plan.options)));
  thr_text_printf(text, "\n%-32s", "ends");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, " %16s ", thr_ends_name(e[i].plan.options.ends));
  if (n < 2) return;
  thr_text_printf(text, "\n%-32s", "on the frontier");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, " %16s ", compare_on_frontier(e, n, i) ? "yes" : "-");
}

static bool same_physics(const thr_physics *a, const thr_physics *b)
{
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (thr_physics_get(a, &thr_physics_fields[i]) != thr_physics_get(b, &thr_physics_fields[i]))
      return false;
  return true;
}

/* Words for the ends of the bands of friction. */
static void name_ends(const thr_physics *physics, bool same, char at[RANKING_ENDS][40])
{
  const double mu[2] = {physics->mu_low, physics->mu_high};
  for (int end = 0; end < 2; end++) {
    const char *const which = end ? "upper" : "lower";
    if (same)
      snprintf(at[end], sizeof at[end], "mu %.3g", mu[end]);
    else
      snprintf(at[end], sizeof at[end], "the %s end of mu", which);
    if (same && physics->mu > 0)
      snprintf(at[2 + end], sizeof at[2 + end], "mu_bead %.3g",
               physics->mu_bead * mu[end] / physics->mu);
    else
      snprintf(at[2 + end], sizeof at[2 + end], "the %s end of mu_bead", which);
  }
}

static void put_text(thr_text *text, const pull_args *a, const entry *e, int n, const ranking *r,
                     int count, const char *const *name)
{
  const thr_physics *first = &e[0].eval[THR_CAPSTAN].record.physics;
  bool same = true;
  put_head(text, e, n);
  for (int k = 0; k < compare_n_rows; k++) {
    if (!wanted(a, compare_rows[k].method) || !compare_is_shown(e, n, &compare_rows[k])) continue;
    thr_text_printf(text, "\n%-32s", compare_rows[k].label);
    for (int i = 0; i < n; i++)
      compare_put_cell(text, &compare_rows[k], compare_rows[k].value(&e[i]),
                       compare_is_best(e, n, &compare_rows[k], i));
  }
  for (int i = 1; i < n; i++)
    same = same && same_physics(first, &e[i].eval[THR_CAPSTAN].record.physics);
  thr_text_printf(text, "\n\n* best of the row. Pull: seating tension %g N, pulled at: %s, mu = ",
                  first->seating, a->pull);
  if (same)
    thr_text_printf(text, "%g\n", first->mu);
  else
    thr_text_append(text, "each plan's own\n");
  if (n < 2) return;
  thr_text_append(text, "frontier: no other plan is as good in cord, number of cords and pull, and "
                        "better in one of them\n");
  thr_text_append(text, "\n");
  char at[RANKING_ENDS][40];
  name_ends(first, same, at);
  for (int k = 0; k < count; k++) {
    ranking_put_text(&r[k], name, text);
    ranking_put_bands(&r[k], name, at, text);
  }
  put_agreement(r, count, name, text);
}

static void put_plan_json(thr_writer *writer, const pull_args *a, const entry *e, int n, int i)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "plan", e[i].path);
  thr_write_hash(writer, "framework", thr_frame_hash(&e[i].plan.frame));
  thr_write_string(writer, "objective", thr_objective_name(thr_aims_objective(&e[i].plan.options)));
  thr_write_string(writer, "ends", thr_ends_name(e[i].plan.options.ends));
  thr_physics_write(&e[i].eval[THR_CAPSTAN].record.physics, writer, "physics");
  for (int k = 0; k < compare_n_rows; k++)
    if (wanted(a, compare_rows[k].method))
      thr_write_number(writer, compare_rows[k].key, compare_rows[k].value(&e[i]));
  thr_write_bool(writer, "frontier", compare_on_frontier(e, n, i));
  thr_write_number(writer, "pull_low", e[i].eval[THR_CAPSTAN].band[0]);
  thr_write_number(writer, "pull_high", e[i].eval[THR_CAPSTAN].band[1]);
  thr_write_array(writer, "best");
  for (int k = 0; k < compare_n_rows; k++)
    if (compare_is_best(e, n, &compare_rows[k], i))
      thr_write_string(writer, NULL, compare_rows[k].key);
  thr_write_close(writer);
  thr_write_close(writer);
}

static void put_json(thr_text *text, const pull_args *a, const entry *e, int n, const ranking *r,
                     int count, const char *const *name)
{
  int which[2], pair[2];
  thr_writer writer = {.out = text};
  thr_write_object(&writer, NULL);
  thr_write_array(&writer, "plans");
  for (int i = 0; i < n; i++)
    put_plan_json(&writer, a, e, n, i);
  thr_write_line(&writer, 0);
  thr_write_close(&writer);
  thr_write_line(&writer, 0);
  thr_write_array(&writer, "rankings");
  for (int k = 0; k < count; k++) {
    thr_write_line(&writer, 1);
    ranking_put_json(&r[k], name, &writer);
  }
  thr_write_line(&writer, 0);
  thr_write_close(&writer);
  thr_write_line(&writer, 0);
  thr_write_bool(&writer, "agree", !find_disagreement(r, count, which, pair));
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* "Pull at both ends of every cord, .. ": how the pulls of the picture were found. */
static void put_note(thr_text *text, const pull_args *a, const entry *e, int n)
{
  const thr_physics *physics = &e[0].eval[THR_CAPSTAN].record.physics;
  bool same = true;
  for (int i = 1; i < n; i++)
    same = same && same_physics(physics, &e[i].eval[THR_CAPSTAN].record.physics);
  thr_text_printf(text, "Pull at %s of every cord, ",
                  strcmp(a->pull, "both") == 0 ? "both ends"
                  : strchr(a->pull, '=')       ? "given ends"
                                               : a->pull);
  if (same)
    thr_text_printf(text,
                    "so that %g N is left where it is slackest (closed form; mu = %g, the pale "
                    "bars its band from %g to %g).",
                    physics->seating, physics->mu, physics->mu_low, physics->mu_high);
  else
    thr_text_append(text, "by the closed form, each plan with its own cord and beads; the pale "
                          "bars are the bands of mu.");
}

static int write_plot(const pull_args *a, const entry *e, int n, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0}, note = {0};
  thr_compare_column *column = thr_calloc((size_t)n, sizeof *column);
  thr_status st = column ? THR_OK : thr_nomem(&err);
  put_note(&note, a, e, n);
  if (note.failed && !st) st = thr_nomem(&err);
  for (int i = 0; i < n && !st; i++) {
    const thr_eval *eval = &e[i].eval[THR_CAPSTAN];
    column[i] = (thr_compare_column){
        .name = e[i].path,
        .plan = &e[i].plan,
        .pull = {eval->band[0], compare_largest(&e[i], THR_CAPSTAN), eval->band[1]},
        .frontier = compare_on_frontier(e, n, i)};
  }
  if (!st) st = thr_compare_svg(column, n, note.data, &svg, &err);
  free(column);
  thr_text_destroy(&note);
  return cli_write_drawn(st, &svg, path, &err);
}

/* ---- work ---- */

/* Pulls compare only on one framework and at one friction. */
static int read_entries(char **path, int n, entry *e)
{
  for (int i = 0; i < n; i++) {
    e[i].path = path[i];
    e[i].fall[0] = e[i].fall[1] = NAN;
    int code = cli_read_plan(path[i], &e[i].plan);
    if (code) return code;
    if (i == 0 || thr_frame_hash(&e[i].plan.frame) == thr_frame_hash(&e[0].plan.frame)) continue;
    cli_error("%s is for another framework than %s: pulls can be compared on one framework only",
              path[i], path[0]);
    return EXIT_INPUT;
  }
  return EXIT_OK;
}

/* Loads and schedule as nodes and cords of a plan. */
static int read_deeds(const deeds *d, const entry *e, thr_eval_options *options,
                      thr_schedule *schedule, double (**load)[3])
{
  const int code = pull_read_schedule(d->schedule, &e->plan, schedule);
  return code ? code : load_apply(&d->load, &e->plan.frame, options, load);
}

/* Do they fit every plan? */
static int try_deeds(const deeds *d, const entry *e, int n)
{
  int code = EXIT_OK;
  for (int i = 0; i < n && !code; i++) {
    thr_eval_options options = thr_eval_options_default();
    thr_schedule schedule = {0};
    double(*load)[3] = NULL;
    code = read_deeds(d, &e[i], &options, &schedule, &load);
    thr_schedule_destroy(&schedule);
    free(load);
  }
  return code;
}

/* One plan by one method; loads and schedules are of the structure alone. */
static int evaluate_one(const pull_args *a, const deeds *d, thr_method method, entry *e)
{
  pull_args plain = *a;
  thr_schedule schedule = {0};
  double(*load)[3] = NULL;
  int code = EXIT_OK;
  plain.options.dynamics = false; /* the simulation follows */
  if (method == THR_STRUCTURE) code = read_deeds(d, e, &plain.options, &schedule, &load);
  if (schedule.n > 0) plain.options.schedule = &schedule;
  if (!code) code = pull_eval(&plain, e->path, &e->plan, method, &e->eval[method]);
  thr_schedule_destroy(&schedule);
  free(load);
  return code;
}

/* Every method for every plan. One that fails for a plan leaves it unknown, its message printed;
 * but nothing compares if not even the closed form is known, or if the user has stopped it. */
static int evaluate(const pull_args *a, const deeds *d, entry *e, int n)
{
  int worst = EXIT_OK;
  for (int method = 0; method < THR_N_METHODS; method++)
    for (int i = 0; i < n && wanted(a, (thr_method)method); i++) {
      int code = evaluate_one(a, d, (thr_method)method, &e[i]);
      if (code == EXIT_LIMIT || (code && method == THR_CAPSTAN)) return code;
      if (!worst) worst = code;
      if (i > 0 && method == THR_CAPSTAN &&
          !same_physics(&e[i].eval[0].record.physics, &e[0].eval[0].record.physics))
        cli_note("note: %s has its own cord and beads, other than %s: give --mu and the like to "
                 "compare like with like",
                 e[i].path, e[0].path);
    }
  return worst;
}

typedef struct {
  const pull_args *args;
  const entry *e;
  const int *plan; /* which are simulated */
  const thr_limits *limits;
} simulation;

typedef struct {
  double fall, error; /* N */
  int status;         /* thr_settle_status */
} settled;

/* Job 2 k simulates plan[k], job 2 k + 1 the same with half the time step. */
static thr_status settle_plan(void *user, int job, void *result, thr_err *err)
{
  const simulation *s = user;
  const entry *e = &s->e[s->plan[job / 2]];
  const thr_evaluation *evaluation = &e->eval[THR_STRUCTURE].record;
  const thr_settle_options options = {.least = e->eval[THR_STRUCTURE].holding.lower,
                                      .equilibrium = e->eval[THR_STRUCTURE].holding.upper,
                                      .start = s->args->options.start,
                                      .time_step = s->args->options.time_step * (job & 1 ? 0.5 : 1),
                                      .iterations = s->args->options.iterations,
                                      .seed = s->args->options.seed};
  thr_beads beads = {0};
  thr_settle out = {0};
  double **tension = thr_calloc((size_t)evaluation->n_cords, sizeof *tension);
  thr_status st =
      tension ? thr_beads_make(&e->plan.frame, &evaluation->physics, &beads, err) : thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords && !st; i++) { /* of a pull of 1 */
    if (!(tension[i] = thr_calloc((size_t)evaluation->cord[i].n_passes, sizeof **tension)))
      st = thr_nomem(err);
    for (int k = 0; k < evaluation->cord[i].n_passes && !st; k++)
      tension[i][k] = evaluation->cord[i].tension[k] / options.least;
  }
  if (!st)
    st = thr_settle_run(&beads, &e->plan.frame, e->plan.cord, evaluation->n_cords,
                        (const double *const *)tension, NULL, &evaluation->physics, &options,
                        s->limits, &out, err);
  *(settled *)result = (settled){out.fall, out.error, out.status};
  thr_settle_destroy(&out);
  for (int i = 0; i < evaluation->n_cords && tension; i++)
    free(tension[i]);
  free(tension);
  thr_beads_destroy(&beads);
  return st;
}

static thr_status run_simulations(const pull_args *a, entry *e, const int *plan, int n,
                                  thr_err *err)
{
  const thr_limits limits = cli_limits(0);
  const thr_limits quiet = {.interrupted =
                                limits.interrupted}; /* in a child: only the parent draws the bar */
  simulation s = {a, e, plan, &quiet};
  const thr_work work = {.n_jobs = 2 * n,
                         .result_size = sizeof(settled),
                         .run = settle_plan,
                         .user = &s,
                         .what = "simulating structures",
                         .advice = "use --no-dynamics"};
  settled *found = thr_calloc(2 * (size_t)n, sizeof *found);
  bool *finished = thr_calloc(2 * (size_t)n, sizeof *finished);
  thr_status st = found && finished
                      ? thr_workers_run(&work, cli_processes(), &limits, found, finished, err)
                      : thr_nomem(err);
  for (int i = 0; i < 2 * n && found && finished; i++) {
    entry *of = &e[plan[i / 2]];
    if (!finished[i]) continue;
    if (found[i].fall > 0) {
      of->fall[i & 1] = found[i].fall;
      of->fall_error[i & 1] = found[i].error;
    }
    if (found[i].status != THR_SETTLE_FELL && !(i & 1 && of->contradicted)) {
      of->contradicted = true;
      cli_note("note: %s: the simulation %s; `thread eval --method structure` says more", of->path,
               found[i].status == THR_SETTLE_NEVER_SETTLED
                   ? "never came to rest under the pull at its start"
               : found[i].fall > 0
                   ? "falls where the limit analysis says otherwise, or at a pull not well known"
                   : "did not fall");
    }
  }
  free(found);
  free(finished);
  cli_progress_end();
  return st;
}

/* Each twice; not where no pull is needed, since then there is none to let off. */
static int settle(const pull_args *a, entry *e, int n)
{
  thr_err err = {0};
  int count = 0, *plan = thr_calloc((size_t)n, sizeof *plan);
  thr_status st = plan ? THR_OK : thr_nomem(&err);
  bool large = e[0].plan.frame.n_nodes > thr_settle_largest(a->options.large);
  if (large)
    cli_note("note: no simulation of the structure: it has more than %d beads%s",
             thr_settle_largest(a->options.large),
             a->options.large ? "" : "; --dynamics takes more");
  for (int i = 0; i < n && plan && !large; i++) {
    double pull = compare_largest(&e[i], THR_STRUCTURE);
    if (pull > 0) plan[count++] = i;
    if (pull <= 0)
      cli_note("note: %s is not simulated: it needs no pull, so that there is none to let off",
               e[i].path);
  }
  if (count > 0) st = run_simulations(a, e, plan, count, &err);
  free(plan);
  return st == THR_ELIMIT ? EXIT_LIMIT : st ? cli_fail(&err) : EXIT_OK;
}

static int print(const pull_args *a, const entry *e, int n)
{
  thr_err err = {0};
  thr_text text = {0};
  ranking r[N_RANKINGS] = {{0}};
  int count = 0;
  const char **name = thr_calloc((size_t)n, sizeof *name);
  thr_status st = name ? make_rankings(a, e, n, r, &count, &err) : thr_nomem(&err);
  if (!st) {
    for (int i = 0; i < n; i++)
      name[i] = e[i].path;
    (a->json ? put_json : put_text)(&text, a, e, n, r, count, name);
  }
  for (int i = 0; i < N_RANKINGS; i++)
    ranking_destroy(&r[i]);
  free(name);
  return st ? cli_fail(&err) : cli_write(&text, "-");
}

/* plot: where the picture goes, NULL = nowhere. */
static int compare(const pull_args *a, const deeds *d, char **path, int n, entry *e,
                   const char *plot)
{
  int code = read_entries(path, n, e);
  if (code) return code;
  if ((code = try_deeds(d, e, n))) return code;
  code = evaluate(a, d, e, n);
  if (code && code != EXIT_LIMIT && !e[n - 1].eval[THR_CAPSTAN].record.present) return code;
  if (code != EXIT_LIMIT && wanted(a, THR_STRUCTURE) && a->options.dynamics) {
    int ended = settle(a, e, n);
    if (!code || ended == EXIT_LIMIT) code = ended;
  }
  for (int i = 0; i < n && !a->json; i++)
    thr_text_clean(path[i]); /* the files are read; what follows is for people */
  int drawn = plot ? write_plot(a, e, n, plot) : EXIT_OK;
  if (!code) code = drawn;
  int printed = plot && strcmp(plot, "-") == 0 ? EXIT_OK : print(a, e, n);
  if (code == EXIT_LIMIT) cli_error("stopped: what is - above is not known");
  return printed ? printed : code;
}

/* What would be ignored is refused; the simulation knows only cords and weights. */
static int check_deeds(pull_args *a, deeds *d)
{
  const bool structure = a->method == THR_STRUCTURE || a->method == PULL_ALL_METHODS,
             any = load_any(&d->load) || d->schedule;
  if (!structure && (any || d->load.rays || d->load.taut))
    return cli_usage("compare",
                     "--load, --tilt, --clamp-feet, --taut, --tune rays and --schedule are "
                     "of --method structure or all");
  if (d->schedule && !*d->schedule)
    return cli_usage("compare", "--schedule: an empty one does nothing");
  if (d->load.n_pulls && !d->load.load) return cli_usage("compare", "--load-pulls needs --load");
  if (d->load.n_pulls > 1)
    return cli_usage("compare", "--load-pulls: one pull, to rank by what is carried at it");
  if (any && a->options.start > 0)
    return cli_usage("compare",
                     "--tune start is of the simulation, which knows no loads and schedules");
  if (d->load.load && !d->load.n_pulls) d->load.pulls[d->load.n_pulls++] = 10;
  if (any) a->options.dynamics = false;
  return EXIT_OK;
}

/* What was asked. */
typedef struct {
  pull_args pull;
  guard_limits guard;
  deeds deeds;
  const char *plot;
} arguments;

#define AT(member) .offset = offsetof(arguments, member)

static const cli_option own_options[] = {
    {"method", .value = "joint|capstan|structure|all", .kind = CLI_WORD, AT(pull.method),
     .word = pull_method_name, .n_words = PULL_ALL_METHODS + 1,
     .help = "what to rank by (default: joint); the closed form is always shown beside it"},
    {"schedule", .value = "TEXT", .kind = CLI_TEXT, AT(deeds.schedule),
     .help = "structure: and after what is done to the cords, as `thread eval` takes it"},
    {"plot", .value = "FILE", .kind = CLI_OUTPUT, AT(plot),
     .help = "write a picture as SVG: the plans side by side, small, with pull, cord and number of "
             "cords"},
    {0}};

int cmd_compare(int argc, char **argv)
{
  static const cli_syntax syntax = {"compare", intro, outro};
  arguments asked = {.guard = guard_limits_default()};
  guard_end end;
  pull_args_init(&asked.pull, THR_JOINT);
  const cli_group groups[] = {{"Options", own_options, &asked},
                              {NULL, pull_options, &asked.pull},
                              {NULL, cli_processes_options, NULL},
                              {NULL, pull_run_options, &asked.pull},
                              {NULL, guard_options, &asked.guard},
                              {"What acts on the structure, to rank by what the plans carry",
                               cli_load_options, &asked.deeds.load},
                              {CLI_PHYSICS_HEADING, cli_physics_options(), &asked.pull.physics},
                              {cli_tuned, pull_tuned, &asked.pull},
                              {cli_tuned, cli_load_tuned, &asked.deeds.load},
                              {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;
  const int n = argc - optind;
  if (n < 1) return cli_usage("compare", "which plans?");
  if (asked.pull.json && asked.plot && strcmp(asked.plot, "-") == 0)
    return cli_usage("compare", "--json and --plot - both want stdout");
  code = pull_check(&asked.pull, "compare");
  if (!code) code = check_deeds(&asked.pull, &asked.deeds);
  if (code) return code;
  if (guard_fork(&asked.guard, &end)) return guard_conclude(&end, "no comparison");
  entry *e = thr_calloc((size_t)n, sizeof *e);
  if (!e) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }
  code = compare(&asked.pull, &asked.deeds, argv + optind, n, e, asked.plot);
  for (int i = 0; i < n; i++) {
    thr_plan_destroy(&e[i].plan);
    for (int k = 0; k < THR_N_METHODS; k++)
      thr_eval_destroy(&e[i].eval[k]);
  }
  free(e);
  return code;
}
