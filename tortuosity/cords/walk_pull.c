/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How long all cords together must be if each keeps to a limit on the pull: the programme over
 * walks.
 *
 * Example: on a 7 x 7 dome 10 cords between its feet, none of which needs more than twice the
 * seating tension, are 2168.6 mm long at least, where 1995.2 mm is what any cords need. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROUNDS = 400, MOST_LOOKS = 8 };

/* The best prices that were looked at, as a proof. */
static thr_status take_proof(thr_walk_programme *p, thr_walk_proof *proof, thr_err *err)
{
  thr_status st = p->best > 0 ? thr_walk_programme_middle(p, err) : THR_OK;
  return st || p->best <= 0 ? st : thr_walk_take_proof(p, proof, err);
}

static bool is_of(const thr_walk_programme *p, const thr_cord *cord)
{
  return p->c->component[thr_cord_start(p->c->f, cord)] == p->component;
}

/* Length of the cords of the programme's component. */
static double length_of(const thr_walk_programme *p, const thr_cord *cord, int n_cords)
{
  double sum = 0;
  for (int i = 0; i < n_cords; i++)
    if (is_of(p, &cord[i])) sum += thr_cord_length(p->c->f, &cord[i]);
  return sum;
}

static thr_status look(thr_walk_programme *p, const thr_cord *cord, int n_cords, double most_worth,
                       thr_err *err)
{
  thr_status st = thr_walk_programme_begin(p, p->units, most_worth, err);
  for (int i = 0; i < n_cords && !st; i++)
    if (is_of(p, &cord[i])) st = thr_walk_programme_add(p, &cord[i], err);
  return st ? st : thr_walk_programme_rounds(p, MOST_ROUNDS, err);
}

/* Prices that prove the most from the walks of the cords on, until that is enough; a walk is worth
 * most_worth at most. Walks that go round and round remember it, and what they prove then is at
 * least as much. */
static thr_status search(thr_walk_programme *p, const thr_cord *cord, int n_cords, double enough,
                         double most_worth, thr_err *err)
{
  double *kept = thr_calloc((size_t)p->n_variables, sizeof *kept), best = 0;
  bool grown = true;
  thr_status st = kept ? THR_OK : thr_nomem(err);
  p->to_exclude = true;
  p->enough = enough;
  for (int i = 0; i < MOST_LOOKS && grown && !st && !thr_limits_stop(p->limits); i++) {
    st = look(p, cord, n_cords, most_worth, err);
    if (!st && p->best > best) {
      best = p->best;
      memcpy(kept, p->middle, (size_t)p->n_variables * sizeof *kept);
    }
    grown = false;
    if (!st && !p->excluded) st = thr_walk_remember(p, &grown, err);
  }
  p->best = best;
  if (!st) memcpy(p->middle, kept, (size_t)p->n_variables * sizeof *kept);
  free(kept);
  return st;
}

thr_status thr_walk_pull_length(const thr_turning_columns *columns, const thr_request *options,
                                const thr_cord *cord, int n_cords, int component,
                                const thr_limits *limits, thr_walk_proof *proof, double *bound,
                                thr_err *err)
{
  thr_walk_programme p;
  thr_err why = {0};
  *bound = 0;
  thr_status st = thr_walk_programme_init_pull(&p, columns, options, cord, n_cords, component, true,
                                               limits, &why);
  if (!st) st = search(&p, cord, n_cords, length_of(&p, cord, n_cords), p.dearest, &why);
  if (!st) st = take_proof(&p, proof, &why);
  if (!st) *bound = p.best;
  thr_walk_programme_destroy(&p);
  return st == THR_ELIMIT ? THR_OK : st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- few cords ---- */

/* Edges of the component. */
static int count_edges(const thr_turning_columns *columns, int component)
{
  int n = 0;
  for (int e = 0; e < columns->f->n_edges; e++)
    n += columns->component[columns->f->edge[e][0]] == component;
  return n;
}

static int count_cords(const thr_cord *cord, int most)
{
  int n = 0;
  while (n < most && cord[n].half)
    n++;
  return n;
}

thr_status thr_walk_pull_few(const thr_turning_columns *columns, const thr_request *options,
                             const thr_cord *some, int n_some, int component,
                             const thr_limits *limits, int most, thr_cord *cord, int *n,
                             thr_err *err)
{
  thr_walk_programme p;
  thr_err why = {0};
  bool found = false;
  *n = 0;
  thr_status st = thr_walk_programme_init_pull(&p, columns, options, some, n_some, component, true,
                                               limits, &why);
  if (!st) {
    p.cords = most;
    thr_walk_programme_round_up(&p, count_edges(columns, component));
    st = thr_walk_dive(&p, p.units, NULL, 0, cord, &found, &why);
  }
  if (!st && found) *n = count_cords(cord, most);
  thr_walk_programme_destroy(&p);
  return st == THR_ELIMIT ? THR_OK : st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- too few ---- */

thr_status thr_walk_pull_too_few(const thr_turning_columns *columns, const thr_request *options,
                                 const thr_cord *cord, int n_cords, int component, int known,
                                 int cords, const thr_limits *limits, thr_walk_proof *proof,
                                 int *excluded, thr_err *err)
{
  thr_walk_programme p;
  thr_err why = {0};
  double bound = 0;
  const bool within =
      thr_cords_within_pull(columns->f, options, cord, n_cords); /* their walks are columns */
  *excluded = 0;
  thr_status st = thr_walk_programme_init_pull(&p, columns, options, cord, n_cords, component,
                                               false, limits, &why);
  p.cords = cords;
  const double dearest =
      within ? 1
             : cords +
                   1; /* no walk is worth more than 1; but what none passes may be worth them all */
  if (!st) st = search(&p, cord, within ? n_cords : 0, known + 1, dearest, &why);
  const int number = (int)fmin(cords, ceil(p.best * (1 - 1e-9)) - 1);
  if (!st) st = take_proof(&p, proof, &why);
  if (!st && proof->unit && number > 0)
    st = thr_walk_pull_check(columns, options, proof, number, &bound, &why);
  if (bound > 0)
    *excluded = number;
  else
    thr_walk_proof_destroy(proof);
  thr_walk_programme_destroy(&p);
  return st == THR_ELIMIT || st == THR_EVIOLATED ? THR_OK
         : st                                    ? thr_fail(err, st, "%s", why.text)
                                                 : THR_OK;
}
