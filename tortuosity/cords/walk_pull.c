/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bounds from below the length of all cords together if each keeps to a limit on the pull, and the
 * number of cords that such a limit takes, by the programme over walks.
 *
 * The programme (walk_programme.c) has a column for every walk within the limit. The cost of a
 * column is the walk's length where the total length is bounded, or where few and short cords are
 * chosen, and 1 where the number of cords is bounded. The prices of the dual are the proof.
 *
 * Example: on a 7 x 7 dome 10 cords between its feet, none of which needs more than twice the
 * seating tension, are 2168.6 mm long at least, where 1995.2 mm is what any cords need. */
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROUNDS = 400, MOST_LOOKS = 8 };

/* Moves the best prices so far to the proof, unless they prove nothing. */
static thr_status take_proof(thr_walk_programme *programme, thr_walk_proof *proof, thr_err *err)
{
  thr_status st = programme->best > 0 ? thr_walk_programme_middle(programme, err) : THR_OK;
  return st || programme->best <= 0 ? st : thr_walk_take_proof(programme, proof, err);
}

/* Says whether a cord belongs to the programme's component. */
static bool is_of(const thr_walk_programme *programme, const thr_cord *cord)
{
  return programme->c->component[thr_cord_start(programme->c->f, cord)] == programme->component;
}

/* Returns the total length of the cords of the programme's component. */
static double length_of(const thr_walk_programme *programme, const thr_cord *cord, int n_cords)
{
  double sum = 0;
  for (int i = 0; i < n_cords; i++)
    if (is_of(programme, &cord[i])) sum += thr_cord_length(programme->c->f, &cord[i]);
  return sum;
}

/* Solves the programme with the plan's cords as its first walks. most_price: of a pass that no walk
 * makes. */
static thr_status look(thr_walk_programme *programme, const thr_cord *cord, int n_cords,
                       double most_price, thr_err *err)
{
  thr_status st = thr_walk_programme_begin(programme, programme->units, most_price, err);
  for (int i = 0; i < n_cords && !st; i++)
    if (is_of(programme, &cord[i])) st = thr_walk_programme_add(programme, &cord[i], err);
  return st ? st : thr_walk_programme_rounds(programme, MOST_ROUNDS, err);
}

/* Searches for the prices that prove the most, until they prove `enough`. A pass that no walk makes
 * costs most_price. While the optimum passes edges repeatedly, the walks remember these edges and
 * the programme is solved again; the best prices of all solves are kept. With what the walks
 * remember at the end they prove at least as much. */
static thr_status search(thr_walk_programme *programme, const thr_cord *cord, int n_cords,
                         double enough, double most_price, thr_err *err)
{
  double *kept = thr_calloc((size_t)programme->n_variables, sizeof *kept), best = 0;
  bool grown = true;

  thr_status st = kept ? THR_OK : thr_nomem(err);
  programme->to_exclude = true;
  programme->enough = enough;
  for (int i = 0; i < MOST_LOOKS && grown && !st && !thr_limits_stop(programme->limits); i++) {
    st = look(programme, cord, n_cords, most_price, err);
    if (!st && programme->best > best) {
      best = programme->best;
      memcpy(kept, programme->middle, (size_t)programme->n_variables * sizeof *kept);
    }

    /* Not enough yet: remember more, if the optimum goes round any edge. */
    grown = false;
    if (!st && !programme->excluded) st = thr_walk_remember(programme, &grown, err);
  }

  programme->best = best;
  if (!st) memcpy(programme->middle, kept, (size_t)programme->n_variables * sizeof *kept);
  free(kept);
  return st;
}

/* The plan's own length is enough: no bound can be higher. */
thr_status thr_walk_pull_length(const thr_turning_columns *columns, const thr_request *options,
                                const thr_cord *cord, int n_cords, int component,
                                const thr_limits *limits, thr_walk_proof *proof, double *bound,
                                thr_err *err)
{
  thr_walk_programme programme;
  thr_err why = {0};
  *bound = 0;

  /* Walks cost their length. */
  thr_status st = thr_walk_programme_init_pull(&programme, columns, options, cord, n_cords,
                                               component, true, limits, &why);
  if (!st)
    st = search(&programme, cord, n_cords, length_of(&programme, cord, n_cords), programme.dearest,
                &why);

  /* The prices are the proof of the bound. */
  if (!st) st = take_proof(&programme, proof, &why);
  if (!st) *bound = programme.best;
  thr_walk_programme_destroy(&programme);
  return st == THR_ELIMIT ? THR_OK : st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- few cords ---- */

/* Counts the edges of a component. */
static int count_edges(const thr_turning_columns *columns, int component)
{
  int n = 0;
  for (int e = 0; e < columns->f->n_edges; e++)
    n += columns->component[columns->f->edge[e][0]] == component;
  return n;
}

/* Counts the cords at the front of cord[most]. */
static int count_cords(const thr_cord *cord, int most)
{
  int n = 0;
  while (n < most && cord[n].half)
    n++;
  return n;
}

/* A cord costs as much as all edges of the component together at their longest, so that fewer cords
 * come before shorter ones. */
thr_status thr_walk_pull_few(const thr_turning_columns *columns, const thr_request *options,
                             const thr_cord *some, int n_some, int component,
                             const thr_limits *limits, int most, thr_cord *cord, int *n,
                             thr_err *err)
{
  thr_walk_programme programme;
  thr_err why = {0};
  bool found = false;
  *n = 0;

  thr_status st = thr_walk_programme_init_pull(&programme, columns, options, some, n_some,
                                               component, true, limits, &why);

  /* Units are rounded up, so that the dive's cords keep to the limit for certain. */
  if (!st) {
    programme.cords = most;
    thr_walk_programme_round_up(&programme, count_edges(columns, component));
    st = thr_walk_dive(&programme, programme.units, cord, &found, &why);
  }
  if (!st && found) *n = count_cords(cord, most);
  thr_walk_programme_destroy(&programme);
  return st == THR_ELIMIT ? THR_OK : st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- too few ---- */

/* The proof is checked anew before anything is said. */
thr_status thr_walk_pull_too_few(const thr_turning_columns *columns, const thr_request *options,
                                 const thr_cord *cord, int n_cords, int component, int known,
                                 int cords, const thr_limits *limits, thr_walk_proof *proof,
                                 int *excluded, thr_err *err)
{
  thr_walk_programme programme;
  thr_err why = {0};
  double bound = 0;
  const bool within = thr_cords_within_pull(columns->f, options, cord, n_cords);

  /* Every walk costs 1. */
  *excluded = 0;
  thr_status st = thr_walk_programme_init_pull(&programme, columns, options, cord, n_cords,
                                               component, false, limits, &why);
  programme.cords = cords;

  /* The walks of cords within the pull are columns from the start, and then no price of a pass
   * exceeds 1. Without them an edge may lie on no known walk, and have a price above all cords. */
  const double most_price = within ? 1 : cords + 1;
  if (!st) st = search(&programme, cord, within ? n_cords : 0, known + 1, most_price, &why);

  /* One cord less than the prices prove is certainly too few. */
  const int number = (int)fmin(cords, ceil(programme.best * (1 - 1e-9)) - 1);
  if (!st) st = take_proof(&programme, proof, &why);
  if (!st && proof->unit && number > 0)
    st = thr_walk_pull_check(columns, options, proof, number, &bound, &why);

  if (bound > 0)
    *excluded = number;
  else
    thr_walk_proof_destroy(proof);
  thr_walk_programme_destroy(&programme);
  return st == THR_ELIMIT || st == THR_EVIOLATED ? THR_OK
         : st                                    ? thr_fail(err, st, "%s", why.text)
                                                 : THR_OK;
}
