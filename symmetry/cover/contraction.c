/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contracts the programme: the turns at most nodes are left out, so that its solutions say which
 * orbits of copies, ends and folds there are, but not who meets whom.
 *
 * A cell is a set of dart types at one node that turns join. Dart orbits of two different types of
 * a cell can always be paired, so all that most cells ask for is an even number; such a cell
 * becomes one dart type with one turn, to itself. Every solution of the whole programme is one of
 * the contracted programme, with the same overlap and steps and no more paths: its bounds hold.
 * symmetry/lift/lift.c finds the turns of a contracted solution.
 *
 * Example: a node whose six dart types all turn into each other has 15 turns; contracted it is one
 * type with one. */
#include "symmetry/cover/cover.h"
#include "graph/arrays.h"

#include <stdlib.h>
#include <string.h>

/* ---- making a contraction ---- */

/* Tells whether turns of this pair type may be used. */
static bool allowed(const thr_programme *programme, int pair)
{
  return programme->most[programme->first_pair + pair] != 0;
}

/* Finds the cells, each by its lowest dart type: how many types it has, and whether one turns into
 * itself. */
static void find_cells(thr_contraction *contraction, int *count, bool *loop)
{
  /* Cells are connected by turns. */
  const thr_quotient *quotient = contraction->whole->q;
  for (int dart = 0; dart < quotient->n_darts; dart++)
    contraction->root[dart] = dart;
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    if (allowed(contraction->whole, pair))
      thr_disjoint_join(contraction->root, quotient->pair[pair].dart[0],
                        quotient->pair[pair].dart[1]);

  for (int dart = 0; dart < quotient->n_darts; dart++)
    count[contraction->root[dart] = thr_disjoint_find(contraction->root, dart)]++;

  /* A type that turns into itself asks for no partner of another type. */
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    if (allowed(contraction->whole, pair) && !quotient->pair[pair].self &&
        quotient->pair[pair].dart[0] == quotient->pair[pair].dart[1])
      loop[contraction->root[quotient->pair[pair].dart[0]]] = true;
}

thr_status thr_contraction_init(thr_contraction *contraction, const thr_programme *whole, bool all,
                                thr_err *err)
{
  *contraction = (thr_contraction){.whole = whole};

  size_t n = (size_t)whole->q->n_darts;
  int *count = thr_calloc(n, sizeof *count);
  bool *loop = thr_calloc(n, sizeof *loop);
  contraction->root = thr_calloc(n, sizeof *contraction->root);
  contraction->keep = thr_calloc(n, sizeof *contraction->keep);
  contraction->becomes = thr_calloc(n, sizeof *contraction->becomes);
  contraction->pair = thr_calloc((size_t)whole->q->n_pairs, sizeof *contraction->pair);

  thr_status st = count && loop && contraction->root && contraction->keep && contraction->becomes &&
                          contraction->pair
                      ? THR_OK
                      : thr_nomem(err);

  /* Without such types, two types ask for equal numbers, and one for none at all: contracting would
   * lose that. */
  if (!st) {
    find_cells(contraction, count, loop);
    for (int dart = 0; dart < whole->q->n_darts; dart++)
      contraction->keep[dart] = !all && count[dart] < 3 && !loop[dart];
    st = thr_contraction_make(contraction, err);
  }

  free(count);
  free(loop);
  if (st) thr_contraction_destroy(contraction);
  return st;
}

/* Frees the contracted quotient and programme. */
static void clear_contracted(thr_contraction *contraction)
{
  thr_programme_destroy(&contraction->p);
  free(contraction->q.copy);
  free(contraction->q.dart);
  free(contraction->q.pair);
  contraction->q = (thr_quotient){0};
}

void thr_contraction_destroy(thr_contraction *contraction)
{
  clear_contracted(contraction);
  free(contraction->root);
  free(contraction->keep);
  free(contraction->becomes);
  free(contraction->pair);
  *contraction = (thr_contraction){0};
}

/* Contracts the pair types: a contracted cell has one turn and one self pair at most, where the
 * whole has any. made[2 * type + self] is 1 more than the number of that pair type, 0 = none yet.
 */
static void contract_pairs(thr_contraction *contraction, int *made)
{
  const thr_quotient *quotient = contraction->whole->q;
  for (int pair = 0; pair < quotient->n_pairs; pair++) {
    int root = contraction->root[quotient->pair[pair].dart[0]],
        *known = &made[2 * root + quotient->pair[pair].self];
    contraction->pair[pair] = contraction->q.n_pairs;

    /* The turns of a contracted cell become one, made when the first comes. */
    if (!contraction->keep[root]) {
      contraction->pair[pair] =
          allowed(contraction->whole, pair) ? (*known ? *known - 1 : contraction->q.n_pairs) : -1;
      if (contraction->pair[pair] < contraction->q.n_pairs) continue;
      *known = contraction->q.n_pairs + 1;
    }

    /* A new pair type. */
    thr_pair_type *type = &contraction->q.pair[contraction->q.n_pairs++];
    *type = quotient->pair[pair];
    for (int i = 0; i < 2; i++)
      type->dart[i] = contraction->becomes[contraction->keep[root] ? type->dart[i] : root];
    if (!contraction->keep[root]) type->half[1] = -1; /* the one turn has many partners */
  }
}

/* Contracts the ties: links of turns that are kept stay, other turns are only counted. */
static thr_status contract_ties(thr_contraction *contraction, thr_err *err)
{
  const thr_quotient *quotient = contraction->whole->q;
  bool *keep = thr_calloc((size_t)quotient->n_pairs, sizeof *keep);
  contraction->p.ties = thr_calloc(1, sizeof *contraction->p.ties);
  thr_status st = keep && contraction->p.ties ? THR_OK : thr_nomem(err);

  for (int pair = 0; pair < quotient->n_pairs && !st; pair++)
    keep[pair] = contraction->keep[contraction->root[quotient->pair[pair].dart[0]]];
  if (!st)
    st =
        thr_ties_contract(contraction->p.ties, contraction->whole->ties, quotient->n_pairs,
                          &contraction->q, contraction->p.node_orbit, contraction->pair, keep, err);

  free(keep);
  return st;
}

thr_status thr_contraction_make(thr_contraction *contraction, thr_err *err)
{
  const thr_quotient *quotient = contraction->whole->q;
  /* Copies stay in number; dart types and turns become fewer. */
  clear_contracted(contraction);
  contraction->q = *quotient;
  contraction->q.n_darts = contraction->q.n_pairs = 0;
  contraction->q.copy = thr_calloc((size_t)quotient->n_copies, sizeof *contraction->q.copy);
  contraction->q.dart = thr_calloc((size_t)quotient->n_darts, sizeof *contraction->q.dart);
  contraction->q.pair = thr_calloc((size_t)quotient->n_pairs, sizeof *contraction->q.pair);
  int *made = thr_calloc(2 * (size_t)quotient->n_darts, sizeof *made);
  thr_status st = contraction->q.copy && contraction->q.dart && contraction->q.pair && made
                      ? THR_OK
                      : thr_nomem(err);

  /* Dart types: all of a cell that is kept, or else its lowest. */
  for (int dart = 0; dart < quotient->n_darts && !st; dart++) {
    contraction->becomes[dart] =
        contraction->keep[contraction->root[dart]] || contraction->root[dart] == dart
            ? contraction->q.n_darts
            : contraction->becomes[contraction->root[dart]];
    if (contraction->becomes[dart] == contraction->q.n_darts)
      contraction->q.dart[contraction->q.n_darts++] = quotient->dart[dart];
  }

  /* Copies between contracted types. */
  for (int copy = 0; copy < quotient->n_copies && !st; copy++) {
    contraction->q.copy[copy] = quotient->copy[copy];
    for (int i = 0; i < (quotient->copy[copy].fold ? 1 : 2); i++)
      contraction->q.copy[copy].dart[i] = contraction->becomes[quotient->copy[copy].dart[i]];
  }

  /* Turns, and the programme of what there is now. */
  if (!st) contract_pairs(contraction, made);
  free(made);
  if (!st) st = thr_programme_init(&contraction->p, &contraction->q, contraction->whole->o, err);
  contraction->p.limits = contraction->whole->limits;
  if (!st && contraction->whole->ties) st = contract_ties(contraction, err);

  if (st) return st;

  /* Bounds of copies are those of the whole: turns that are left out ruled some copies out. */
  memcpy(contraction->p.least, contraction->whole->least,
         (size_t)quotient->n_copies * sizeof *contraction->p.least);
  memcpy(contraction->p.most, contraction->whole->most,
         (size_t)quotient->n_copies * sizeof *contraction->p.most);
  return THR_OK;
}
