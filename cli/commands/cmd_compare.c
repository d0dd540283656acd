/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread compare: evaluates plans of one framework, prints them side by side and ranks them by how
 * hard they are to pull.
 *
 * A value of a plan is an interval: a measured pull has a relative error, a limit analysis proves a
 * lower and finds an upper pull. Two plans whose intervals overlap tie (cli/print/ranking.c). There
 * is one ranking for each question that was asked: the seating pull by the closed form and by
 * simulated joints, the holding pull, the force in any state, what is left after a schedule, what a
 * load needs and what is carried, and the fall in simulation (docs/method.md, "Comparing").
 *
 * Example: two plans with seating pulls of 12.3 N (+-0.4 %) and 12.33 N (+-0.5 %) tie; 12.3 N and
 * 14.1 N do not.
 *
 * Order of work: read all plans, refuse loads and schedules that do not fit one of them, evaluate
 * every method for every plan, simulate the structures twice, print. */
#include "cli/args/args.h"
#include "cli/print/print.h"
#include "diagram/overview/charts.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/process/process.h"
#include "graph/status.h"
#include "graph/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char intro[] =
    "thread compare PLAN.. [options]: plans of one framework side by side; * marks the best\n\n"
    "Examples:\n"
    "  thread compare closed.json feet.json --mu 0.3           by pull, joints measured in "
    "simulation\n"
    "  thread compare closed.json feet.json --method capstan   by the closed form, at once\n"
    "  thread compare data/dome7-*.json --method all           by either, and by when they stand\n"
    "  thread compare data/dome7-*.json --method structure --load D4=1   by what they carry\n";
static const char outro[] =
    "A difference within the measured error is a tie. The simulation of the structure runs twice "
    "for each plan, the second time with half the time step; only what both runs and their errors "
    "tell apart is no tie. It takes minutes; --no-dynamics is fast; it knows no loads, leaning "
    "ground, held feet and schedules, and is left out with them.";

/* Rankings, one for each question, in the order in which they are printed. CAPSTAN and JOINT:
 * seating pull. HOLDING to LOADED: least pull (or part of the tensions) of the limit analysis.
 * CARRIED, CARRIED_AFTER: multiple of the load. SIMULATION: pull at which the structure falls in
 * Bullet. */
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

/* What acts on the structures beside the pull: a load, leaning ground and the like, and a
 * schedule. */
typedef struct {
  load_args load;
  const char *schedule; /* as given; NULL: none */
} structure_actions;

/* A plan with its evaluations (cli/print/print.h). */
typedef compare_entry entry;

/* Returns whether a method is part of this comparison. The closed form always is. */
static bool wanted(const pull_args *args, thr_method method)
{
  return method == THR_CAPSTAN || args->method == (int)method || args->method == PULL_ALL_METHODS;
}

/* ---- rankings ---- */

/* Sets the interval of plan i from a pull, or a factor on tensions, that is needed: from the proved
 * lower bound to the smallest value at which an equilibrium was found (INFINITY: none was). */
static void rank_need(ranking *ranked, const thr_holding *holding, int i)
{
  ranked->value[i] = ranked->low[i] =
      holding->present ? holding->lower : NAN; /* INFINITY: none does */
  ranked->high[i] = holding->upper >= holding->lower ? holding->upper : INFINITY;
}

/* Sets the interval of plan i from the multiple of a load that is carried. Values are negative, so
 * that the largest multiple comes first. */
static void rank_carry(ranking *ranked, const thr_carry *carry, int i)
{
  ranked->value[i] = ranked->high[i] = carry->first_bead < 0 ? NAN : -carry->carried;
  ranked->low[i] = -carry->beyond;
}

/* Sets the values of plan i at both ends of a band of friction (0: of the cords, 1: of beads and
 * ground). */
static void rank_band(ranking *ranked, int band, const double value[2], int i)
{
  for (int end = 0; end < 2; end++)
    ranked->end[2 * band + end][i] = ranked->most ? -value[end] : value[end];
}

/* Fills in how the value of plan i depends on the frictions, as far as that is known. */
static void rank_bands(ranking *ranked, int question, const entry *candidate, int i)
{
  static const thr_asked of[N_RANKINGS] = {
      [HOLDING] = THR_ASKED_HOLDING, [STANDING] = THR_ASKED_ANY_STATE,
      [AFTER] = THR_ASKED_AFTER,     [LOADED] = THR_ASKED_LOADED,
      [CARRIED] = THR_ASKED_CARRIED, [CARRIED_AFTER] = THR_ASKED_CARRIED_AFTER};
  const thr_eval *structure = &candidate->eval[THR_STRUCTURE];

  /* Seating pulls depend on the friction of the cord only; all others on that of beads and ground,
   * and the pull while cords are drawn in and the force in any state on both. */
  if (question == CAPSTAN || question == JOINT) {
    if (!isnan(ranked->value[i]))
      rank_band(ranked, 0, candidate->eval[question == CAPSTAN ? THR_CAPSTAN : THR_JOINT].band, i);
  } else if (question == CARRIED) {
    if (structure->n_carries) rank_band(ranked, 1, structure->carries[0].band_beads, i);
  } else if (question != SIMULATION && structure->record.present) {
    rank_band(ranked, 1, structure->band_beads[of[question]], i);
    if (question == HOLDING || question == STANDING)
      rank_band(ranked, 0, question == HOLDING ? structure->band : structure->band_any, i);
  }
}

/* Fills in value and interval of plan i for one question; leaves the value NAN where it is not
 * known. */
static void rank_plan(ranking *ranked, int question, const entry *candidate, int i)
{
  const thr_eval *structure = &candidate->eval[THR_STRUCTURE];

  switch (question) {
  /* The closed form is exact but for rounding. */
  case CAPSTAN:
    ranked->value[i] = compare_largest(candidate, THR_CAPSTAN);
    ranked->low[i] = ranked->value[i] * (1 - 1e-6);
    ranked->high[i] = ranked->value[i] * (1 + 1e-6);
    break;

  /* A measured pull is right within a factor exp(+-error); turns that were refused have no known
   * error, so that the interval has no upper end. */
  case JOINT:
    ranked->value[i] = compare_largest(candidate, THR_JOINT);
    ranked->low[i] = ranked->value[i] * exp(-candidate->eval[THR_JOINT].error);
    ranked->high[i] = candidate->eval[THR_JOINT].refused
                          ? INFINITY
                          : ranked->value[i] * exp(candidate->eval[THR_JOINT].error);
    break;
  case HOLDING: rank_need(ranked, &structure->holding, i); break;
  case STANDING: rank_need(ranked, &structure->loosest, i); break;
  case AFTER: rank_need(ranked, &structure->after, i); break;
  case LOADED: rank_need(ranked, &structure->loaded, i); break;
  case CARRIED:
    if (structure->n_carries) rank_carry(ranked, &structure->carries[0].carry, i);
    break;
  case CARRIED_AFTER:
    if (structure->after.present) rank_carry(ranked, &structure->after_carries, i);
    break;

  /* The fall in simulation: the interval holds what both time steps say, each with its error. */
  default:
    ranked->value[i] = isnan(candidate->fall[1]) ? NAN : candidate->fall[0];
    ranked->low[i] = fmin(candidate->fall[0] - candidate->fall_error[0],
                          candidate->fall[1] - candidate->fall_error[1]);
    ranked->high[i] = fmax(candidate->fall[0] + candidate->fall_error[0],
                           candidate->fall[1] + candidate->fall_error[1]);
  }
}

/* Returns whether any plan fell in simulation. */
static bool simulated(const entry *entries, int n)
{
  for (int i = 0; i < n; i++)
    if (!isnan(entries[i].fall[0])) return true;
  return false;
}

/* Returns whether a question was asked of any plan. */
static bool asked(int question, const entry *entries, int n)
{
  if (question == SIMULATION) return simulated(entries, n);
  for (int i = 0; i < n; i++) {
    const thr_eval *structure = &entries[i].eval[THR_STRUCTURE];

    /* The closed form, the joints and the holding pull have no option of their own; any other
     * answer is there only if an option asked for it. */
    if (question < STANDING || (question == STANDING && structure->loosest.present) ||
        (question == AFTER && structure->after.present) ||
        ((question == LOADED || question == CARRIED) && structure->n_carries > 0) ||
        (question == CARRIED_AFTER && structure->after.present && structure->n_carries > 0))
      return true;
  }

  return false;
}

/* Fills `rankings` with those of the wanted methods and *count with their number. On failure the
 * rankings so far, and the one that failed, can be released. */
static thr_status make_rankings(const pull_args *args, const entry *entries, int n,
                                ranking *rankings, int *count, thr_err *err)
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

  /* A ranking for each question of the methods that are wanted, unless no plan was asked it. */
  bool all = args->method == PULL_ALL_METHODS;

  *count = 0;
  for (int question = 0; question < N_RANKINGS; question++) {
    const thr_method method = question == CAPSTAN ? THR_CAPSTAN
                              : question == JOINT ? THR_JOINT
                                                  : THR_STRUCTURE;
    if ((!all && args->method != (int)method) || !asked(question, entries, n)) continue;

    /* The ranking is counted only once it is complete. */
    rankings[*count] = kind[question];
    thr_status st = ranking_init(&rankings[*count], n, err);
    if (st) return st;

    for (int i = 0; i < n; i++) {
      rank_plan(&rankings[*count], question, &entries[i], i);
      rank_bands(&rankings[*count], question, &entries[i], i);
    }
    ranking_make(&rankings[(*count)++]);
  }

  return THR_OK;
}

/* Finds the first two rankings that contradict each other, and a pair of plans that they order
 * differently. Returns false if all rankings agree. */
static bool find_disagreement(const ranking *rankings, int count, int which[2], int pair[2])
{
  for (which[0] = 0; which[0] < count; which[0]++)
    for (which[1] = which[0] + 1; which[1] < count; which[1]++)
      if (ranking_disagree(&rankings[which[0]], &rankings[which[1]], pair)) return true;
  return false;
}

/* Returns whether two rankings put the same plans in the same order with the same ranks. */
static bool same_order(const ranking *a, const ranking *b)
{
  if (a->n_ranked != b->n_ranked) return false;
  for (int k = 0; k < a->n_ranked; k++)
    if (a->order[k] != b->order[k] || a->rank[a->order[k]] != b->rank[b->order[k]]) return false;
  return true;
}

/* Appends each order once, with the rankings that have it: "lines.json, stairs.json = snake.json by
 * holding, carried". Rankings in which all plans tie are left out. */
static void put_orders(const ranking *rankings, int count, const char *const *name, thr_text *text)
{
  thr_text_append(text, "the rankings disagree:\n");
  for (int i = 0; i < count; i++) {
    /* Each order is printed with the first ranking that has it. */
    bool said = !ranking_tells_apart(&rankings[i]);
    for (int k = 0; k < i; k++)
      said |= same_order(&rankings[k], &rankings[i]);
    if (said) continue;

    /* The plans, with = between those that tie. */
    for (int k = 0; k < rankings[i].n_ranked; k++)
      thr_text_printf(text, "%s%s",
                      k == 0 ? "  "
                      : ranking_is_tie(&rankings[i], rankings[i].order[k - 1], rankings[i].order[k])
                          ? " = "
                          : ", ",
                      name[rankings[i].order[k]]);

    /* The rankings with this order. */
    for (int k = i; k < count; k++)
      if (same_order(&rankings[k], &rankings[i]))
        thr_text_printf(text, "%s%s", k == i ? "  by " : ", ", rankings[k].key);
    thr_text_append(text, "\n");
  }
}

/* Appends whether the rankings agree. If all of them are about the pull while cords are drawn in,
 * agreement says little, and the sentence says so. */
static void put_agreement(const ranking *rankings, int count, const char *const *name,
                          thr_text *text)
{
  /* Counts the rankings that tell any plans apart, and looks for one about cords that were let
   * go. */
  bool let_go = false;
  int orders = 0;

  for (int i = 0; i < count; i++) {
    const bool apart = ranking_tells_apart(&rankings[i]);
    orders += apart;
    let_go |=
        apart && (strcmp(rankings[i].key, "any_state") == 0 || strstr(rankings[i].key, "after"));
  }

  /* One ranking alone can agree with nothing. */
  int which[2], pair[2];
  if (orders < 2) return;
  if (find_disagreement(rankings, count, which, pair))
    put_orders(rankings, count, name, text);
  else
    thr_text_append(
        text,
        let_go
            ? "the rankings agree, while cords are drawn in and afterwards, ties aside\n"
            : "the rankings agree, ties aside; both ask for the pull while cords are drawn in\n");
}

/* ---- output ---- */

/* Appends the head of the columns: the plans' file names or, if one is wider than a column (16
 * letters), numbers whose meaning is listed above the table. */
static void put_names(thr_text *text, const entry *entries, int n)
{
  bool wide = false;

  for (int i = 0; i < n; i++)
    wide |= strlen(entries[i].path) > 16;

  /* The legend of the numbers. */
  for (int i = 0; i < n && wide; i++)
    thr_text_printf(text, "plan %d  %s\n", i + 1, entries[i].path);
  thr_text_printf(text, "%s%-32s", wide ? "\n" : "", "");

  for (int i = 0; i < n; i++) {
    char number[24];
    snprintf(number, sizeof number, "plan %d", i + 1);
    thr_text_printf(text, " %16s ", wide ? number : entries[i].path);
  }
}

/* Appends the rows that have words, not numbers: names, objective, ends, and whether the plan is on
 * the frontier. */
static void put_head(thr_text *text, const entry *entries, int n)
{
  put_names(text, entries, n);
  thr_text_printf(text, "\n%-32s", "objective");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, " %16s ",
                    thr_objective_name(thr_aims_objective(&entries[i].plan.options)));

  /* Where cords may end: at the feet, anywhere, or nowhere. */
  thr_text_printf(text, "\n%-32s", "ends");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, " %16s ", thr_ends_name(entries[i].plan.options.ends));

  /* A frontier needs something to be compared with. */
  if (n < 2) return;
  thr_text_printf(text, "\n%-32s", "on the frontier");
  for (int i = 0; i < n; i++)
    thr_text_printf(text, " %16s ", compare_on_frontier(entries, n, i) ? "yes" : "-");
}

/* Returns whether all properties of cord and beads are equal. */
static bool same_physics(const thr_physics *a, const thr_physics *b)
{
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (thr_physics_get(a, &thr_physics_fields[i]) != thr_physics_get(b, &thr_physics_fields[i]))
      return false;
  return true;
}

/* Fills at with words for the ends of the two bands of friction: numbers if all plans have the same
 * physics, else "the lower end of mu" and so on. The band of mu_bead is in proportion to that of
 * mu. */
static void name_ends(const thr_physics *physics, bool same, char at[RANKING_ENDS][40])
{
  const double mu[2] = {physics->mu_low, physics->mu_high};

  for (int end = 0; end < 2; end++) {
    const char *const which = end ? "upper" : "lower";

    /* The band of the cords. */
    if (same)
      snprintf(at[end], sizeof at[end], "mu %.3g", mu[end]);
    else
      snprintf(at[end], sizeof at[end], "the %s end of mu", which);

    /* The band of beads and ground. */
    if (same && physics->mu > 0)
      snprintf(at[2 + end], sizeof at[2 + end], "mu_bead %.3g",
               physics->mu_bead * mu[end] / physics->mu);
    else
      snprintf(at[2 + end], sizeof at[2 + end], "the %s end of mu_bead", which);
  }
}

/* Appends the table, what it was computed with, and the rankings with what the bands of friction
 * change about them. */
static void put_text(thr_text *text, const pull_args *args, const entry *entries, int n,
                     const ranking *rankings, int count, const char *const *name)
{
  const thr_physics *first = &entries[0].eval[THR_CAPSTAN].record.physics;
  bool same = true;

  /* The rows of wanted methods. Rows of machinery are for --verbose. */
  put_head(text, entries, n);
  for (int k = 0; k < compare_n_rows; k++) {
    if (!wanted(args, compare_rows[k].method) || !compare_is_shown(entries, n, &compare_rows[k]))
      continue;
    thr_text_printf(text, "\n%-32s", compare_rows[k].label);
    for (int i = 0; i < n; i++)
      compare_put_cell(text, &compare_rows[k], compare_rows[k].value(&entries[i]),
                       compare_is_best(entries, n, &compare_rows[k], i));
  }

  /* Seating tension, pulled ends and friction. */
  for (int i = 1; i < n; i++)
    same = same && same_physics(first, &entries[i].eval[THR_CAPSTAN].record.physics);
  thr_text_printf(text, "\n\n* best of the row. Pull: seating tension %g N, pulled at: %s, mu = ",
                  first->seating, args->pull);
  if (same)
    thr_text_printf(text, "%g\n", first->mu);
  else
    thr_text_append(text, "each plan's own\n");

  /* One plan alone has nothing to be ranked with. */
  if (n < 2) return;
  thr_text_append(text, "frontier: no other plan is as good in cord, number of cords and pull, and "
                        "better in one of them\n");
  thr_text_append(text, "\n");

  /* Rankings of two plans and more. */
  char at[RANKING_ENDS][40];
  name_ends(first, same, at);
  for (int k = 0; k < count; k++) {
    ranking_put_text(&rankings[k], name, text);
    ranking_put_bands(&rankings[k], name, at, text);
  }

  put_agreement(rankings, count, name, text);
}

/* Writes an object for plan i: what it is, its values, its band of pulls, and the rows in which it
 * is the best. */
static void put_plan_json(thr_writer *writer, const pull_args *args, const entry *entries, int n,
                          int i)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "plan", entries[i].path);
  thr_write_hash(writer, "framework", thr_frame_hash(&entries[i].plan.frame));
  thr_write_string(writer, "objective",
                   thr_objective_name(thr_aims_objective(&entries[i].plan.options)));
  thr_write_string(writer, "ends", thr_ends_name(entries[i].plan.options.ends));
  thr_physics_write(&entries[i].eval[THR_CAPSTAN].record.physics, writer, "physics");

  /* Members that are NAN are written as null. */
  for (int k = 0; k < compare_n_rows; k++)
    if (wanted(args, compare_rows[k].method))
      thr_write_number(writer, compare_rows[k].key, compare_rows[k].value(&entries[i]));
  thr_write_bool(writer, "frontier", compare_on_frontier(entries, n, i));
  thr_write_number(writer, "pull_low", entries[i].eval[THR_CAPSTAN].band[0]);
  thr_write_number(writer, "pull_high", entries[i].eval[THR_CAPSTAN].band[1]);

  thr_write_array(writer, "best");
  for (int k = 0; k < compare_n_rows; k++)
    if (compare_is_best(entries, n, &compare_rows[k], i))
      thr_write_string(writer, NULL, compare_rows[k].key);
  thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes the whole comparison: plans, rankings and whether these agree. */
static void put_json(thr_text *text, const pull_args *args, const entry *entries, int n,
                     const ranking *rankings, int count, const char *const *name)
{
  int which[2], pair[2];
  thr_writer writer = {.out = text};

  thr_write_object(&writer, NULL);

  thr_write_array(&writer, "plans");
  for (int i = 0; i < n; i++)
    put_plan_json(&writer, args, entries, n, i);

  thr_write_line(&writer, 0);
  thr_write_close(&writer);
  thr_write_line(&writer, 0);

  thr_write_array(&writer, "rankings");
  for (int k = 0; k < count; k++) {
    thr_write_line(&writer, 1);
    ranking_put_json(&rankings[k], name, &writer);
  }

  thr_write_line(&writer, 0);
  thr_write_close(&writer);
  thr_write_line(&writer, 0);

  /* Ties do not contradict each other. */
  thr_write_bool(&writer, "agree", !find_disagreement(rankings, count, which, pair));
  thr_write_close(&writer);
  thr_text_append(text, "\n");
}

/* Appends how the pulls of the picture were found: "Pull at both ends of every cord, so that 1 N is
 * left where it is slackest ..". */
static void put_note(thr_text *text, const pull_args *args, const entry *entries, int n)
{
  const thr_physics *physics = &entries[0].eval[THR_CAPSTAN].record.physics;
  bool same = true;

  for (int i = 1; i < n; i++)
    same = same && same_physics(physics, &entries[i].eval[THR_CAPSTAN].record.physics);

  /* Which ends: a list of cords is too long for a note. */
  thr_text_printf(text, "Pull at %s of every cord, ",
                  strcmp(args->pull, "both") == 0 ? "both ends"
                  : strchr(args->pull, '=')       ? "given ends"
                                                  : args->pull);

  /* With what friction. */
  if (same)
    thr_text_printf(text,
                    "so that %g N is left where it is slackest (closed form; mu = %g, the pale "
                    "bars its band from %g to %g).",
                    physics->seating, physics->mu, physics->mu_low, physics->mu_high);
  else
    thr_text_append(text, "by the closed form, each plan with its own cord and beads; the pale "
                          "bars are the bands of mu.");
}

/* Draws the plans side by side with pull, cord and number of cords, and writes the picture to path.
 * Returns an exit code. */
static int write_plot(const pull_args *args, const entry *entries, int n, const char *path)
{
  thr_err err = {0};
  thr_text svg = {0}, note = {0};
  thr_compare_column *column = thr_calloc((size_t)n, sizeof *column);
  thr_status st = column ? THR_OK : thr_nomem(&err);

  put_note(&note, args, entries, n);
  if (note.failed && !st) st = thr_nomem(&err);

  /* A column per plan, with the band of its pull by the closed form. */
  for (int i = 0; i < n && !st; i++) {
    const thr_eval *eval = &entries[i].eval[THR_CAPSTAN];
    column[i] = (thr_compare_column){
        .name = entries[i].path,
        .plan = &entries[i].plan,
        .pull = {eval->band[0], compare_largest(&entries[i], THR_CAPSTAN), eval->band[1]},
        .frontier = compare_on_frontier(entries, n, i)};
  }

  if (!st) st = thr_compare_svg(column, n, note.data, &svg, &err);
  free(column);
  thr_text_destroy(&note);

  return cli_write_drawn(st, &svg, path, &err);
}

/* ---- work ---- */

/* Reads the plans into entries[n]. Pulls can be compared on one framework only: another one is an
 * error. Returns an exit code. */
static int read_entries(char **path, int n, entry *entries)
{
  for (int i = 0; i < n; i++) {
    entries[i].path = path[i];
    entries[i].fall[0] = entries[i].fall[1] = NAN;
    int code = cli_read_plan(path[i], &entries[i].plan);
    if (code) return code;

    /* Frameworks are equal if their hashes are. */
    if (i == 0 || thr_frame_hash(&entries[i].plan.frame) == thr_frame_hash(&entries[0].plan.frame))
      continue;
    cli_error("%s is for another framework than %s: pulls can be compared on one framework only",
              path[i], path[0]);
    return EXIT_INPUT;
  }

  return EXIT_OK;
}

/* Turns loads and schedule into nodes and cords of one plan. *load receives newtons at each node,
 * or NULL; the caller frees it, and the schedule. */
static int read_actions(const structure_actions *actions, const entry *candidate,
                        thr_eval_options *options, thr_schedule *schedule, double (**load)[3])
{
  const int code = pull_read_schedule(actions->schedule, &candidate->plan, schedule);
  return code ? code : load_apply(&actions->load, &candidate->plan.frame, options, load);
}

/* Returns EXIT_OK if loads and schedule fit every plan, before any time is spent on evaluating
 * one. */
static int try_actions(const structure_actions *actions, const entry *entries, int n)
{
  int code = EXIT_OK;

  for (int i = 0; i < n && !code; i++) {
    thr_eval_options options = thr_eval_options_default();
    thr_schedule schedule = {0};
    double(*load)[3] = NULL;

    /* What they came to is not needed yet. */
    code = read_actions(actions, &entries[i], &options, &schedule, &load);
    thr_schedule_destroy(&schedule);
    free(load);
  }

  return code;
}

/* Evaluates one plan by one method. Loads and schedules are of method structure alone. Returns an
 * exit code. */
static int evaluate_one(const pull_args *args, const structure_actions *actions, thr_method method,
                        entry *candidate)
{
  pull_args plain = *args;
  thr_schedule schedule = {0};
  double(*load)[3] = NULL;
  int code = EXIT_OK;

  /* The simulation comes later, for all plans together (settle). */
  plain.options.dynamics = false;
  if (method == THR_STRUCTURE)
    code = read_actions(actions, candidate, &plain.options, &schedule, &load);
  if (schedule.n > 0) plain.options.schedule = &schedule;
  if (!code)
    code = pull_eval(&plain, candidate->path, &candidate->plan, method, &candidate->eval[method]);

  thr_schedule_destroy(&schedule);
  free(load);

  return code;
}

/* Evaluates every wanted method for every plan. One that fails for a plan leaves the values
 * unknown, its message printed; but nothing can be compared if not even the closed form is known,
 * or if the user has stopped the work. Returns the first exit code that is not EXIT_OK. */
static int evaluate(const pull_args *args, const structure_actions *actions, entry *entries, int n)
{
  int worst = EXIT_OK;

  for (int method = 0; method < THR_N_METHODS; method++)
    for (int i = 0; i < n && wanted(args, (thr_method)method); i++) {
      int code = evaluate_one(args, actions, (thr_method)method, &entries[i]);

      /* An interrupt, or a plan without even a closed form, ends the work. */
      if (code == EXIT_LIMIT || (code && method == THR_CAPSTAN)) return code;
      if (!worst) worst = code;

      /* Plans of different physics can be ranked, but the user should know. */
      if (i > 0 && method == THR_CAPSTAN &&
          !same_physics(&entries[i].eval[0].record.physics, &entries[0].eval[0].record.physics))
        cli_note("note: %s has its own cord and beads, other than %s: give --mu and the like to "
                 "compare like with like",
                 entries[i].path, entries[0].path);
    }

  return worst;
}

/* What every job of a simulation reads. */
typedef struct {
  const pull_args *args;
  const entry *entries;
  const int *plan; /* which are simulated */
  const thr_limits *limits;
} simulation;

/* What a job returns to its parent. */
typedef struct {
  double fall, error; /* N */
  int status;         /* thr_settle_status */
} settled;

/* Runs one job: job 2 k simulates plan[k], job 2 k + 1 the same with half the time step. Signature
 * of thr_work.run. */
static thr_status settle_plan(void *user, int job, void *result, thr_err *err)
{
  const simulation *setup = user;
  const entry *candidate = &setup->entries[setup->plan[job / 2]];
  const thr_evaluation *evaluation = &candidate->eval[THR_STRUCTURE].record;
  const thr_settle_options options = {.least = candidate->eval[THR_STRUCTURE].holding.lower,
                                      .equilibrium = candidate->eval[THR_STRUCTURE].holding.upper,
                                      .start = setup->args->options.start,
                                      .time_step =
                                          setup->args->options.time_step * (job & 1 ? 0.5 : 1),
                                      .iterations = setup->args->options.iterations,
                                      .seed = setup->args->options.seed};

  /* Tensions of a pull of 1 N: those of the limit analysis belong to its lower bound. */
  thr_beads beads = {0};
  thr_settle out = {0};
  double **tension = thr_calloc((size_t)evaluation->n_cords, sizeof *tension);
  thr_status st = tension
                      ? thr_beads_make(&candidate->plan.frame, &evaluation->physics, &beads, err)
                      : thr_nomem(err);

  for (int i = 0; i < evaluation->n_cords && !st; i++) { /* of a pull of 1 */
    if (!(tension[i] = thr_calloc((size_t)evaluation->cord[i].n_passes, sizeof **tension)))
      st = thr_nomem(err);
    for (int k = 0; k < evaluation->cord[i].n_passes && !st; k++)
      tension[i][k] = evaluation->cord[i].tension[k] / options.least;
  }

  /* Settles the structure at its start and lets off the pull until it falls. */
  if (!st)
    st = thr_settle_run(&beads, &candidate->plan.frame, candidate->plan.cord, evaluation->n_cords,
                        (const double *const *)tension, NULL, &evaluation->physics, &options,
                        setup->limits, &out, err);
  *(settled *)result = (settled){out.fall, out.error, out.status};

  thr_settle_destroy(&out);
  for (int i = 0; i < evaluation->n_cords && tension; i++)
    free(tension[i]);
  free(tension);
  thr_beads_destroy(&beads);

  return st;
}

/* Simulates the structures of plan[n] in parallel processes, with both time steps, and stores at
 * which pulls they fell. Notes what contradicts the limit analysis. */
static thr_status run_simulations(const pull_args *args, entry *entries, const int *plan, int n,
                                  thr_err *err)
{
  const thr_limits limits = cli_limits(0);
  const thr_limits quiet = {.interrupted =
                                limits.interrupted}; /* in a child: only the parent draws the bar */
  simulation setup = {args, entries, plan, &quiet};

  /* Two jobs for each plan, in processes of their own: Bullet may crash, or take no heed of
   * time. */
  const thr_work work = {.n_jobs = 2 * n,
                         .result_size = sizeof(settled),
                         .run = settle_plan,
                         .user = &setup,
                         .what = "simulating structures",
                         .advice = "use --no-dynamics"};

  settled *found = thr_calloc(2 * (size_t)n, sizeof *found);
  bool *finished = thr_calloc(2 * (size_t)n, sizeof *finished);
  thr_status st = found && finished
                      ? thr_workers_run(&work, cli_processes(), &limits, found, finished, err)
                      : thr_nomem(err);

  /* Jobs that were not finished leave their values NAN. */
  for (int i = 0; i < 2 * n && found && finished; i++) {
    entry *of = &entries[plan[i / 2]];
    if (!finished[i]) continue;

    /* The first of the two jobs has the time step that was asked for. */
    if (found[i].fall > 0) {
      of->fall[i & 1] = found[i].fall;
      of->fall_error[i & 1] = found[i].error;
    }

    /* One note for each plan, whichever of its two runs contradicts. */
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

/* Simulates every structure twice, except where no pull is needed: then there is none to let off.
 * Returns an exit code. */
static int settle(const pull_args *args, entry *entries, int n)
{
  thr_err err = {0};
  int count = 0, *plan = thr_calloc((size_t)n, sizeof *plan);
  thr_status st = plan ? THR_OK : thr_nomem(&err);

  /* All plans have the same framework, so that one number of beads decides. */
  bool large = entries[0].plan.frame.n_nodes > thr_settle_largest(args->options.large);

  if (large)
    cli_note("note: no simulation of the structure: it has more than %d beads%s",
             thr_settle_largest(args->options.large),
             args->options.large ? "" : "; --dynamics takes more");

  /* Which plans can be let down. */
  for (int i = 0; i < n && plan && !large; i++) {
    double pull = compare_largest(&entries[i], THR_STRUCTURE);
    if (pull > 0) plan[count++] = i;
    if (pull <= 0)
      cli_note("note: %s is not simulated: it needs no pull, so that there is none to let off",
               entries[i].path);
  }

  if (count > 0) st = run_simulations(args, entries, plan, count, &err);
  free(plan);

  return st == THR_ELIMIT ? EXIT_LIMIT : st ? cli_fail(&err) : EXIT_OK;
}

/* Makes the rankings and prints the comparison to stdout, as text or JSON. Returns an exit code. */
static int print(const pull_args *args, const entry *entries, int n)
{
  thr_err err = {0};
  thr_text text = {0};
  ranking rankings[N_RANKINGS] = {{0}};
  int count = 0;
  const char **name = thr_calloc((size_t)n, sizeof *name);
  thr_status st = name ? make_rankings(args, entries, n, rankings, &count, &err) : thr_nomem(&err);

  /* Plans are named by their files. */
  if (!st) {
    for (int i = 0; i < n; i++)
      name[i] = entries[i].path;
    (args->json ? put_json : put_text)(&text, args, entries, n, rankings, count, name);
  }

  for (int i = 0; i < N_RANKINGS; i++)
    ranking_destroy(&rankings[i]);
  free(name);

  return st ? cli_fail(&err) : cli_write(&text, "-");
}

/* Does the work of the command. plot: where the picture goes, NULL = nowhere. Returns the exit
 * code: the first one of reading, evaluating and drawing, unless printing fails. */
static int compare(const pull_args *args, const structure_actions *actions, char **path, int n,
                   entry *entries, const char *plot)
{
  int code = read_entries(path, n, entries);

  if (code) return code;
  if ((code = try_actions(actions, entries, n))) return code;

  /* If the last plan has no closed form, nothing can be compared. */
  code = evaluate(args, actions, entries, n);
  if (code && code != EXIT_LIMIT && !entries[n - 1].eval[THR_CAPSTAN].record.present) return code;

  /* An interrupt ends the work; what is known is printed all the same. */
  if (code != EXIT_LIMIT && wanted(args, THR_STRUCTURE) && args->options.dynamics) {
    int ended = settle(args, entries, n);
    if (!code || ended == EXIT_LIMIT) code = ended;
  }

  for (int i = 0; i < n && !args->json; i++)
    thr_text_clean(path[i]); /* the files are read; what follows is for people */

  /* A picture on stdout leaves no place for the table. */
  int drawn = plot ? write_plot(args, entries, n, plot) : EXIT_OK;
  if (!code) code = drawn;
  int printed = plot && strcmp(plot, "-") == 0 ? EXIT_OK : print(args, entries, n);
  if (code == EXIT_LIMIT) cli_error("stopped: what is - above is not known");

  return printed ? printed : code;
}

/* Refuses options that would be ignored. Sets the default pull for a load (10 N), and leaves out
 * the simulation where it does not know what was asked: it knows only cords and weights. Returns an
 * exit code. */
static int check_actions(pull_args *args, structure_actions *actions)
{
  const bool structure = args->method == THR_STRUCTURE || args->method == PULL_ALL_METHODS,
             any = load_any(&actions->load) || actions->schedule;

  /* Options of method structure. */
  if (!structure && (any || actions->load.rays || actions->load.taut))
    return cli_usage("compare",
                     "--load, --tilt, --clamp-feet, --taut, --tune rays and --schedule are "
                     "of --method structure or all");

  if (actions->schedule && !*actions->schedule)
    return cli_usage("compare", "--schedule: an empty one does nothing");

  /* A load and the pull at which it hangs. */
  if (actions->load.n_pulls && !actions->load.load)
    return cli_usage("compare", "--load-pulls needs --load");
  if (actions->load.n_pulls > 1)
    return cli_usage("compare", "--load-pulls: one pull, to rank by what is carried at it");

  /* The simulation knows cords and weights only. */
  if (any && args->options.start > 0)
    return cli_usage("compare",
                     "--tune start is of the simulation, which knows no loads and schedules");

  if (actions->load.load && !actions->load.n_pulls)
    actions->load.pulls[actions->load.n_pulls++] = 10;
  if (any) args->options.dynamics = false;

  return EXIT_OK;
}

/* What was asked. */
typedef struct {
  pull_args pull;
  guard_limits guard;
  structure_actions actions;
  const char *plot;
} compare_arguments;

#define AT(member) .offset = offsetof(compare_arguments, member)

static const cli_option own_options[] = {
    {"method", .value = "joint|capstan|structure|all", .kind = CLI_WORD, AT(pull.method),
     .word = pull_method_name, .n_words = PULL_ALL_METHODS + 1,
     .help = "what to rank by (default: joint); the closed form is always shown beside it"},
    {"schedule", .value = "TEXT", .kind = CLI_TEXT, AT(actions.schedule),
     .help = "structure: and after what is done to the cords, as `thread eval` takes it"},
    {"plot", .value = "FILE", .kind = CLI_OUTPUT, AT(plot),
     .help = "write a picture as SVG: the plans side by side, small, with pull, cord and number of "
             "cords"},
    {0}};

/* Runs `thread compare`: parses the options, does the work in a guarded child process, and returns
 * the exit code. */
int cmd_compare(int argc, char **argv)
{
  static const cli_syntax syntax = {"compare", intro, outro};
  compare_arguments asked = {.guard = guard_limits_default()};
  guard_end end;
  pull_args_init(&asked.pull, THR_JOINT);
  const cli_group groups[] = {{"Options", own_options, &asked},
                              {NULL, pull_options, &asked.pull},
                              {NULL, cli_processes_options, NULL},
                              {NULL, pull_run_options, &asked.pull},
                              {NULL, guard_options, &asked.guard},
                              {"What acts on the structure, to rank by what the plans carry",
                               cli_load_options, &asked.actions.load},
                              {CLI_PHYSICS_HEADING, cli_physics_options(), &asked.pull.physics},
                              {cli_tuned, pull_tuned, &asked.pull},
                              {cli_tuned, cli_load_tuned, &asked.actions.load},
                              {NULL}};
  int code = cli_options(argc, argv, &syntax, groups);
  if (code >= 0) return code;

  /* Every operand is a plan. */
  int n = argc - optind;
  if (n < 1) return cli_usage("compare", "which plans?");
  if (asked.pull.json && asked.plot && strcmp(asked.plot, "-") == 0)
    return cli_usage("compare", "--json and --plot - both want stdout");

  code = pull_check(&asked.pull, "compare");
  if (!code) code = check_actions(&asked.pull, &asked.actions);
  if (code) return code;

  /* From here on in the child, whose time and memory are bounded. */
  if (guard_fork(&asked.guard, &end)) return guard_conclude(&end, "no comparison");
  entry *entries = thr_calloc((size_t)n, sizeof *entries);
  if (!entries) {
    cli_error("out of memory");
    return EXIT_INTERNAL;
  }

  code = compare(&asked.pull, &asked.actions, argv + optind, n, entries, asked.plot);

  /* Plans and evaluations that were never filled in are all 0, which is valid. */
  for (int i = 0; i < n; i++) {
    thr_plan_destroy(&entries[i].plan);
    for (int k = 0; k < THR_N_METHODS; k++)
      thr_eval_destroy(&entries[i].eval[k]);
  }

  free(entries);

  return code;
}
