/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks the plans of `thread compare`, once for each question that was asked, and says whether the
 * rankings agree.
 *
 * A value of a plan is an interval (ranking.c): a measured pull has a relative error, and a limit
 * analysis proves a lower and finds an upper pull.
 *
 * Example: holding pulls of 4.14 .. 4.60 N and 4.30 .. 4.70 N tie; 4.14 .. 4.20 N is less than the
 * second, beyond the error. */
#include "eval/structure/beads.h"
#include "lib/comparison.h"

#include <math.h>
#include <string.h>

/* Rankings, one for each question, in the order in which they are printed. CAPSTAN and JOINT:
 * seating pull. HOLDING to LOADED: least pull (or part of the tensions) of the limit analysis.
 * CARRIED, CARRIED_AFTER: multiple of the load. RISE: what comes up in simulation. */
enum {
  CAPSTAN,
  JOINT,
  HOLDING,
  STANDING,
  AFTER,
  LOADED,
  CARRIED,
  CARRIED_AFTER,
  RISE,
  N_QUESTIONS
};
_Static_assert((int)N_QUESTIONS == (int)THR_COMPARE_RANKINGS, "a ranking for each question");

/* Sets the interval of plan i from a pull, or a factor on tensions, that is needed: from the proved
 * lower bound to the smallest value at which an equilibrium was found (INFINITY: none was). */
static void rank_need(thr_ranking *ranked, const thr_holding *holding, int i)
{
  ranked->value[i] = ranked->low[i] =
      holding->present ? holding->lower : NAN; /* INFINITY: none does */
  ranked->high[i] = holding->upper >= holding->lower ? holding->upper : INFINITY;
}

/* Sets the interval of plan i from the multiple of a load that is carried. Values are negative, so
 * that the largest multiple comes first. */
static void rank_carry(thr_ranking *ranked, const thr_carry *carry, int i)
{
  ranked->value[i] = ranked->high[i] = carry->first_bead < 0 ? NAN : -carry->carried;
  ranked->low[i] = -carry->beyond;
}

/* Sets the values of plan i at both ends of a band of friction (0: of the cords, 1: of beads and
 * ground). */
static void rank_band(thr_ranking *ranked, int band, const double value[2], int i)
{
  for (int end = 0; end < 2; end++)
    ranked->end[2 * band + end][i] = ranked->most ? -value[end] : value[end];
}

/* Fills in how the value of plan i depends on the frictions, as far as that is known. */
static void rank_bands(thr_ranking *ranked, int question, const thr_compare_entry *candidate, int i)
{
  static const thr_asked of[N_QUESTIONS] = {
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
  } else if (question != RISE && structure->record.present) {
    rank_band(ranked, 1, structure->band_beads[of[question]], i);
    if (question == HOLDING || question == STANDING)
      rank_band(ranked, 0, question == HOLDING ? structure->band : structure->band_any, i);
  }
}

/* Fills in value and interval of plan i for one question; leaves the value NAN where it is not
 * known. */
static void rank_plan(thr_ranking *ranked, int question, const thr_compare_entry *candidate, int i)
{
  const thr_eval *structure = &candidate->eval[THR_STRUCTURE];

  switch (question) {
  /* The closed form is exact but for rounding. */
  case CAPSTAN:
    ranked->value[i] = thr_compare_largest(candidate, THR_CAPSTAN);
    ranked->low[i] = ranked->value[i] * (1 - 1e-6);
    ranked->high[i] = ranked->value[i] * (1 + 1e-6);
    break;

  /* A measured pull is right within a factor exp(+-error); turns that were refused have no known
   * error, so that the interval has no upper end. */
  case JOINT:
    ranked->value[i] = thr_compare_largest(candidate, THR_JOINT);
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
  case RISE: break; /* compare_rises.c */
  default:
    if (structure->after.present) rank_carry(ranked, &structure->after_carries, i);
  }
}

/* Returns whether a question was asked of any plan. */
static bool asked(int question, const thr_compare_entry *entries, int n)
{
  for (int i = 0; i < n; i++) {
    const thr_eval *structure = &entries[i].eval[THR_STRUCTURE];
    if (question == RISE && entries[i].rise.runs > 0) return true;

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

thr_status thr_compare_rank(int method, const thr_compare_entry *entries, int n,
                            thr_ranking *rankings, int *count, thr_err *err)
{
  static const thr_ranking kind[N_QUESTIONS] = {
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
      [RISE] = {.title = "rising in simulation (first what comes up in all runs, by the pull at "
                         "which it does; then by how many come up, and by closed faces)",
                .key = "rise",
                .unit = " N"}};

  /* A ranking for each question of the methods that are wanted, unless no plan was asked it. */
  bool all = method == THR_BY_ALL;

  *count = 0;
  for (int question = 0; question < N_QUESTIONS; question++) {
    const int needed = question == CAPSTAN ? THR_CAPSTAN
                       : question == JOINT ? THR_JOINT
                       : question == RISE  ? THR_BY_RISE
                                           : THR_STRUCTURE;
    if ((!all && method != needed) || !asked(question, entries, n)) continue;

    /* The ranking is counted only once it is complete. */
    rankings[*count] = kind[question];
    thr_status st = thr_ranking_init(&rankings[*count], n, err);
    if (st) return st;
    if (question == RISE && (st = thr_compare_rank_rises(&rankings[*count], entries, err)))
      return st;

    for (int i = 0; i < n; i++) {
      rank_plan(&rankings[*count], question, &entries[i], i);
      rank_bands(&rankings[*count], question, &entries[i], i);
    }
    thr_ranking_make(&rankings[(*count)++]);
  }

  return THR_OK;
}

bool thr_compare_agree(const thr_ranking *rankings, int count)
{
  int pair[2];

  for (int i = 0; i < count; i++)
    for (int k = i + 1; k < count; k++)
      if (thr_ranking_disagree(&rankings[i], &rankings[k], pair)) return false;
  return true;
}

/* Returns whether two rankings put the same plans in the same order with the same ranks. */
static bool same_order(const thr_ranking *a, const thr_ranking *b)
{
  if (a->n_ranked != b->n_ranked) return false;
  for (int k = 0; k < a->n_ranked; k++)
    if (a->order[k] != b->order[k] || a->rank[a->order[k]] != b->rank[b->order[k]]) return false;
  return true;
}

/* Appends each order once, with the rankings that have it: "lines.json, stairs.json = snake.json by
 * holding, carried". Rankings in which all plans tie are left out. */
static void put_orders(const thr_ranking *rankings, int count, const char *const *name,
                       thr_text *text)
{
  thr_text_append(text, "the rankings disagree:\n");
  for (int i = 0; i < count; i++) {
    /* Each order is printed with the first ranking that has it. */
    bool said = !thr_ranking_tells_apart(&rankings[i]);
    for (int k = 0; k < i; k++)
      said |= same_order(&rankings[k], &rankings[i]);
    if (said) continue;

    /* The plans, with = between those that tie. */
    for (int k = 0; k < rankings[i].n_ranked; k++)
      thr_text_printf(
          text, "%s%s",
          k == 0                                                                             ? "  "
          : thr_ranking_is_tie(&rankings[i], rankings[i].order[k - 1], rankings[i].order[k]) ? " = "
                                                                                             : ", ",
          name[rankings[i].order[k]]);

    /* The rankings with this order. */
    for (int k = i; k < count; k++)
      if (same_order(&rankings[k], &rankings[i]))
        thr_text_printf(text, "%s%s", k == i ? "  by " : ", ", rankings[k].key);
    thr_text_append(text, "\n");
  }
}

void thr_compare_put_agreement(const thr_ranking *rankings, int count, const char *const *name,
                               thr_text *text)
{
  /* Counts the rankings that tell any plans apart, and looks for one about cords that were let
   * go. */
  bool let_go = false;
  int orders = 0;

  for (int i = 0; i < count; i++) {
    const bool apart = thr_ranking_tells_apart(&rankings[i]);
    orders += apart;
    let_go |=
        apart && (strcmp(rankings[i].key, "any_state") == 0 || strstr(rankings[i].key, "after"));
  }

  /* One ranking alone can agree with nothing. */
  if (orders < 2) return;
  if (!thr_compare_agree(rankings, count))
    put_orders(rankings, count, name, text);
  else
    thr_text_append(
        text,
        let_go
            ? "the rankings agree, while cords are drawn in and afterwards, ties aside\n"
            : "the rankings agree, ties aside; both ask for the pull while cords are drawn in\n");
}
