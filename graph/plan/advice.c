/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of advice: pull, order, choice, and what buys nothing. */
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdlib.h>

const double thr_hand_most = 50, thr_hand_always = 10;

/* Factors by which rows are compared. */
static const double worth = 1.05;      /* a twentieth less pull is worth another cord */
static const double same = 1 + 1e-9;   /* as much */
static const double same_cord = 1.001; /* as much cord, to the eye */

void thr_advice_destroy(thr_advice *advice)
{
  for (int i = 0; i < advice->n; i++)
    thr_cords_destroy(advice->row[i].cord, advice->row[i].all);
  free(advice->row);
  *advice = (thr_advice){0};
}

void thr_advice_pulls(const thr_physics *physics, double reach, double pull[THR_ADVICE_PULLS])
{
  /* exp(690) is about 1e300: beyond that nothing can be computed. */
  const double mu[THR_ADVICE_PULLS] = {physics->mu_low, physics->mu, physics->mu_high};
  for (int i = 0; i < THR_ADVICE_PULLS; i++)
    pull[i] = mu[i] * reach > 690 ? INFINITY : physics->seating * exp(mu[i] * reach);
}

thr_physics thr_plan_pulls(const thr_plan *plan, double pull[THR_ADVICE_PULLS])
{
  thr_physics physics = {0};
  const bool fits =
      thr_physics_resolve(&plan->options.physics, &plan->frame, &physics, NULL) == THR_OK;
  const double reach = thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords);
  thr_advice_pulls(&physics, reach, pull);
  for (int i = 0; i < THR_ADVICE_PULLS && !fits; i++)
    pull[i] = INFINITY;
  return physics;
}

bool thr_advice_within(const thr_advice *advice, const thr_advice_row *row)
{
  return row->pull[THR_ADVICE_HIGH] <= advice->hand * same;
}

const char *thr_advice_ends(thr_ends ends)
{
  return ends == THR_ENDS_CLOSED ? "closed" : ends == THR_ENDS_FEET ? "at the feet" : "anywhere";
}

/* ---- order ---- */

/* Returns the place of a kind of ends in the table: closed, at the feet, anywhere. */
static int place_of(thr_ends ends)
{
  return ends == THR_ENDS_CLOSED ? 0 : ends == THR_ENDS_FEET ? 1 : 2;
}

/* Compares two rows by their ends, then by the number of cords. */
static int by_ends_and_cords(const void *a, const void *b)
{
  const thr_advice_row *row = a, *other = b;
  if (row->ends != other->ends) return place_of(row->ends) - place_of(other->ends);
  return (row->cords > other->cords) - (row->cords < other->cords);
}

/* ---- choice ---- */

/* Returns whether a row is a better choice: with fewer cords, then with ends at the feet, then with
 * less cord. */
static bool is_better(const thr_advice_row *row, const thr_advice_row *other)
{
  if (row->cords != other->cords) return row->cords < other->cords;
  if (row->ends != other->ends) return row->ends == THR_ENDS_FEET;
  return row->length < other->length;
}

/* Returns the row with the fewest cords that stays within the hand, of rows with ends at the feet
 * only or of all; -1 if there is none. */
static int fewest(const thr_advice *advice, bool feet)
{
  int chosen = -1;

  /* Rows that do not stay within the hand cannot be chosen. */
  for (int i = 0; i < advice->n; i++) {
    const thr_advice_row *row = &advice->row[i];
    if ((feet && row->ends != THR_ENDS_FEET) || !thr_advice_within(advice, row)) continue;
    if (chosen < 0 || is_better(row, &advice->row[chosen])) chosen = i;
  }

  return chosen;
}

/* Returns the recommended row, or -1. */
static int choose(const thr_advice *advice)
{
  const double most = 1.5; /* as much cord, for ends at the feet */
  const int feet = fewest(advice, true), all = fewest(advice, false);

  /* What `thread plan` alone makes. */
  for (int i = 0; i < advice->n && advice->hand == thr_hand_always; i++)
    if (advice->row[i].planned && thr_advice_within(advice, &advice->row[i])) return i;

  return feet >= 0 && advice->row[feet].length <= most * advice->row[all].length ? feet : all;
}

/* ---- what buys nothing ---- */

bool thr_price_beats(const thr_price *other, const thr_price *one)
{
  /* Pulls that are not known cannot be compared. */
  if (isnan(other->pull) || isnan(one->pull)) return false;
  if (other->cords > one->cords || other->length > one->length * same ||
      other->pull > one->pull * same)
    return false;

  return other->cords < one->cords || other->length * same < one->length ||
         other->pull * same < one->pull;
}

/* Returns whether a row has no more of cords, cord and pull than another one, and less of one of
 * them. */
static bool dominates(const thr_advice_row *other, const thr_advice_row *row)
{
  return thr_price_beats(&(thr_price){other->cords, other->length, other->pull[THR_ADVICE_MU]},
                         &(thr_price){row->cords, row->length, row->pull[THR_ADVICE_MU]});
}

/* Returns whether a row is no better than another one with fewer cords, or with ends that are
 * easier to reach. Infinite pulls are equal: they do not tell rows apart. */
static bool buys_nothing(const thr_advice_row *row, const thr_advice_row *other)
{
  /* Ends at the feet may replace ends anywhere, and nothing else. */
  if (other->ends != row->ends && (other->ends != THR_ENDS_FEET || row->ends == THR_ENDS_CLOSED))
    return false;
  if (other->cords > row->cords || (other->cords == row->cords && other->ends == row->ends))
    return false;

  /* Little more pull, and as much cord to the eye. */
  return other->pull[THR_ADVICE_MU] <= row->pull[THR_ADVICE_MU] * worth &&
         other->length <= row->length * same_cord;
}

/* Drops rows that buy nothing, compared with the rows that stay. The chosen row stays in any
 * case. */
static void drop_rows(thr_advice *advice)
{
  int kept = 0, chosen = -1;

  for (int i = 0; i < advice->n; i++) {
    const thr_advice_row row = advice->row[i];
    bool useful = true;

    /* Compared with rows that stay, so that of two equal rows one stays. */
    for (int j = 0; j < kept && i != advice->chosen && !row.planned; j++)
      useful &= !buys_nothing(&row, &advice->row[j]);
    if (i == advice->chosen) chosen = kept;
    if (useful)
      advice->row[kept++] = row;
    else
      thr_cords_destroy(row.cord, row.all);
  }

  /* The chosen row has another place now. */
  advice->left_out += advice->n - kept;
  advice->n = kept;
  advice->chosen = chosen;
}

/* Drops rows of more cords whose longest cord is longer than that of fewer cords, unless they are
 * the first row within the hand. Rows must be sorted. */
static void drop_longer(thr_advice *advice)
{
  int kept = 0;
  double longest = INFINITY;
  bool within = false;

  for (int i = 0; i < advice->n; i++) {
    const thr_advice_row row = advice->row[i];

    /* Each kind of ends starts anew. */
    const bool first = i == 0 || row.ends != advice->row[kept - 1].ends,
               fits = thr_advice_within(advice, &row);
    if (first) longest = INFINITY;
    if (first) within = false;

    /* A row is of use if its longest cord is no longer, or if none before it was within the
     * hand. */
    const bool useful = row.longest <= longest * (1 + 1e-9) || (fits && !within) || row.planned;
    within |= fits;
    if (!useful) {
      thr_cords_destroy(row.cord, row.all);
      continue;
    }
    longest = row.longest;
    advice->row[kept++] = row;
  }

  advice->left_out += advice->n - kept;
  advice->n = kept;
}

/* Sorts by ends and cords, drops rows with longer cords, marks the frontier, chooses, and drops
 * what buys nothing. */
void thr_advice_settle(thr_advice *advice)
{
  if (advice->n > 0) qsort(advice->row, (size_t)advice->n, sizeof *advice->row, by_ends_and_cords);
  drop_longer(advice);

  /* The frontier is marked before rows are dropped. */
  for (int i = 0; i < advice->n; i++) {
    advice->row[i].frontier = true;
    for (int j = 0; j < advice->n; j++)
      advice->row[i].frontier &= !dominates(&advice->row[j], &advice->row[i]);
  }

  advice->chosen = choose(advice);
  drop_rows(advice);
}
