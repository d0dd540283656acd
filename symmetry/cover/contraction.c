/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The programme without the turns at most nodes: which orbits of copies, ends and folds, but not
 * who meets whom. Internal.
 *
 * A cell is a set of dart types at one node that turns join. Dart orbits of two different types of
 * a cell can always be paired, so all that most cells ask for is an even number; a cell becomes one
 * dart type with one turn, to itself. Every solution of the whole programme is one of the
 * contracted programme, with the same overlap and steps and no more paths: its bounds hold. */
#include "symmetry/cover/cover.h"
#include "graph/disjoint.h"

#include <stdlib.h>
#include <string.h>

/* ---- making ---- */

static bool allowed(const thr_programme *p, int pair)
{
  return p->most[p->first_pair + pair] != 0;
}

/* Types and turns of the cell with lowest type d: how many types, and does one turn into itself? */
static void find_cells(thr_contraction *contraction, int *count, bool *loop)
{
  const thr_quotient *quotient = contraction->whole->q;
  for (int d = 0; d < quotient->n_darts; d++)
    contraction->root[d] = d;
  for (int y = 0; y < quotient->n_pairs; y++)
    if (allowed(contraction->whole, y))
      thr_disjoint_join(contraction->root, quotient->pair[y].dart[0], quotient->pair[y].dart[1]);
  for (int d = 0; d < quotient->n_darts; d++)
    count[contraction->root[d] = thr_disjoint_find(contraction->root, d)]++;
  for (int y = 0; y < quotient->n_pairs; y++)
    if (allowed(contraction->whole, y) && !quotient->pair[y].self &&
        quotient->pair[y].dart[0] == quotient->pair[y].dart[1])
      loop[contraction->root[quotient->pair[y].dart[0]]] = true;
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
  if (!st) {
    find_cells(contraction, count, loop);
    for (int d = 0; d < whole->q->n_darts; d++)
      contraction->keep[d] = !all && count[d] < 3 && !loop[d];
    st = thr_contraction_make(contraction, err);
  }
  free(count);
  free(loop);
  if (st) thr_contraction_destroy(contraction);
  return st;
}

static void unmake(thr_contraction *contraction)
{
  thr_programme_destroy(&contraction->p);
  free(contraction->q.copy);
  free(contraction->q.dart);
  free(contraction->q.pair);
  contraction->q = (thr_quotient){0};
}

void thr_contraction_destroy(thr_contraction *contraction)
{
  unmake(contraction);
  free(contraction->root);
  free(contraction->keep);
  free(contraction->becomes);
  free(contraction->pair);
  *contraction = (thr_contraction){0};
}

/* Of a contracted cell one turn and one self pair at most; made[2 * type + self] is 1 more than its
 * number, 0 = none yet. */
static void contract_pairs(thr_contraction *contraction, int *made)
{
  const thr_quotient *quotient = contraction->whole->q;
  for (int y = 0; y < quotient->n_pairs; y++) {
    int root = contraction->root[quotient->pair[y].dart[0]],
        *known = &made[2 * root + quotient->pair[y].self];
    contraction->pair[y] = contraction->q.n_pairs;
    if (!contraction->keep[root]) {
      contraction->pair[y] =
          allowed(contraction->whole, y) ? (*known ? *known - 1 : contraction->q.n_pairs) : -1;
      if (contraction->pair[y] < contraction->q.n_pairs) continue;
      *known = contraction->q.n_pairs + 1;
    }
    thr_pair_type *type = &contraction->q.pair[contraction->q.n_pairs++];
    *type = quotient->pair[y];
    for (int i = 0; i < 2; i++)
      type->dart[i] = contraction->becomes[contraction->keep[root] ? type->dart[i] : root];
    if (!contraction->keep[root]) type->half[1] = -1; /* it stands for several */
  }
}

/* The ties of the whole programme, as far as turns are kept. */
static thr_status contract_ties(thr_contraction *contraction, thr_err *err)
{
  const thr_quotient *quotient = contraction->whole->q;
  bool *keep = thr_calloc((size_t)quotient->n_pairs, sizeof *keep);
  contraction->p.ties = thr_calloc(1, sizeof *contraction->p.ties);
  thr_status st = keep && contraction->p.ties ? THR_OK : thr_nomem(err);
  for (int y = 0; y < quotient->n_pairs && !st; y++)
    keep[y] = contraction->keep[contraction->root[quotient->pair[y].dart[0]]];
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
  unmake(contraction);
  contraction->q = *quotient;
  contraction->q.n_darts = contraction->q.n_pairs = 0;
  contraction->q.copy = thr_calloc((size_t)quotient->n_copies, sizeof *contraction->q.copy);
  contraction->q.dart = thr_calloc((size_t)quotient->n_darts, sizeof *contraction->q.dart);
  contraction->q.pair = thr_calloc((size_t)quotient->n_pairs, sizeof *contraction->q.pair);
  int *made = thr_calloc(2 * (size_t)quotient->n_darts, sizeof *made);
  thr_status st = contraction->q.copy && contraction->q.dart && contraction->q.pair && made
                      ? THR_OK
                      : thr_nomem(err);
  for (int d = 0; d < quotient->n_darts && !st; d++) {
    contraction->becomes[d] = contraction->keep[contraction->root[d]] || contraction->root[d] == d
                                  ? contraction->q.n_darts
                                  : contraction->becomes[contraction->root[d]];
    if (contraction->becomes[d] == contraction->q.n_darts)
      contraction->q.dart[contraction->q.n_darts++] = quotient->dart[d];
  }
  for (int k = 0; k < quotient->n_copies && !st; k++) {
    contraction->q.copy[k] = quotient->copy[k];
    for (int i = 0; i < (quotient->copy[k].fold ? 1 : 2); i++)
      contraction->q.copy[k].dart[i] = contraction->becomes[quotient->copy[k].dart[i]];
  }
  if (!st) contract_pairs(contraction, made);
  free(made);
  if (!st) st = thr_programme_init(&contraction->p, &contraction->q, contraction->whole->o, err);
  contraction->p.limits = contraction->whole->limits;
  if (!st && contraction->whole->ties) st = contract_ties(contraction, err);
  if (st) return st;
  memcpy(contraction->p.least, contraction->whole->least,
         (size_t)quotient->n_copies *
             sizeof *contraction->p.least); /* turns that are gone ruled some out */
  memcpy(contraction->p.most, contraction->whole->most,
         (size_t)quotient->n_copies * sizeof *contraction->p.most);
  return THR_OK;
}
