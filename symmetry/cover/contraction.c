/* Cells of dart types: made and undone. */
#include "symmetry/cover/contraction.h"
#include "graph/disjoint.h"
#include "symmetry/cover/ties.h"

#include <stdlib.h>
#include <string.h>

/* ---- making ---- */

static bool allowed(const thr_programme *p, int pair)
{
  return p->most[p->first_pair + pair] != 0;
}

/* Types and turns of the cell with lowest type d: how many types, and does one turn into itself? */
static void find_cells(thr_contraction *c, int *count, bool *loop)
{
  const thr_quotient *q = c->whole->q;
  for (int d = 0; d < q->n_darts; d++)
    c->root[d] = d;
  for (int y = 0; y < q->n_pairs; y++)
    if (allowed(c->whole, y)) thr_disjoint_join(c->root, q->pair[y].dart[0], q->pair[y].dart[1]);
  for (int d = 0; d < q->n_darts; d++)
    count[c->root[d] = thr_disjoint_find(c->root, d)]++;
  for (int y = 0; y < q->n_pairs; y++)
    if (allowed(c->whole, y) && !q->pair[y].self && q->pair[y].dart[0] == q->pair[y].dart[1])
      loop[c->root[q->pair[y].dart[0]]] = true;
}

thr_status thr_contraction_init(thr_contraction *c, const thr_programme *whole, bool all, thr_err *err)
{
  *c = (thr_contraction){.whole = whole};
  size_t n = (size_t)whole->q->n_darts;
  int *count = thr_calloc(n, sizeof *count);
  bool *loop = thr_calloc(n, sizeof *loop);
  c->root = thr_calloc(n, sizeof *c->root);
  c->keep = thr_calloc(n, sizeof *c->keep);
  c->becomes = thr_calloc(n, sizeof *c->becomes);
  c->pair = thr_calloc((size_t)whole->q->n_pairs, sizeof *c->pair);
  thr_status st = count && loop && c->root && c->keep && c->becomes && c->pair ? THR_OK : thr_nomem(err);
  if (!st) {
    find_cells(c, count, loop);
    for (int d = 0; d < whole->q->n_darts; d++)
      c->keep[d] = !all && count[d] < 3 && !loop[d];
    st = thr_contraction_make(c, err);
  }
  free(count);
  free(loop);
  if (st) thr_contraction_destroy(c);
  return st;
}

static void unmake(thr_contraction *c)
{
  thr_programme_destroy(&c->p);
  free(c->q.copy);
  free(c->q.dart);
  free(c->q.pair);
  c->q = (thr_quotient){0};
}

void thr_contraction_destroy(thr_contraction *c)
{
  unmake(c);
  free(c->root);
  free(c->keep);
  free(c->becomes);
  free(c->pair);
  *c = (thr_contraction){0};
}

/* Of a contracted cell one turn and one self pair at most; made[2 * type + self] is 1 more than its number, 0 = none yet. */
static void contract_pairs(thr_contraction *c, int *made)
{
  const thr_quotient *q = c->whole->q;
  for (int y = 0; y < q->n_pairs; y++) {
    int root = c->root[q->pair[y].dart[0]], *known = &made[2 * root + q->pair[y].self];
    c->pair[y] = c->q.n_pairs;
    if (!c->keep[root]) {
      c->pair[y] = allowed(c->whole, y) ? (*known ? *known - 1 : c->q.n_pairs) : -1;
      if (c->pair[y] < c->q.n_pairs) continue;
      *known = c->q.n_pairs + 1;
    }
    thr_pair_type *t = &c->q.pair[c->q.n_pairs++];
    *t = q->pair[y];
    for (int i = 0; i < 2; i++)
      t->dart[i] = c->becomes[c->keep[root] ? t->dart[i] : root];
  }
}

/* The ties of the whole programme, as far as turns are kept. */
static thr_status contract_ties(thr_contraction *c, thr_err *err)
{
  const thr_quotient *q = c->whole->q;
  bool *keep = thr_calloc((size_t)q->n_pairs, sizeof *keep);
  c->p.ties = thr_calloc(1, sizeof *c->p.ties);
  thr_status st = keep && c->p.ties ? THR_OK : thr_nomem(err);
  for (int y = 0; y < q->n_pairs && !st; y++)
    keep[y] = c->keep[c->root[q->pair[y].dart[0]]];
  if (!st) st = thr_ties_contract(c->p.ties, c->whole->ties, q->n_pairs, &c->q, c->p.node_orbit, c->pair, keep, err);
  free(keep);
  return st;
}

thr_status thr_contraction_make(thr_contraction *c, thr_err *err)
{
  const thr_quotient *q = c->whole->q;
  unmake(c);
  c->q = *q;
  c->q.n_darts = c->q.n_pairs = 0;
  c->q.copy = thr_calloc((size_t)q->n_copies, sizeof *c->q.copy);
  c->q.dart = thr_calloc((size_t)q->n_darts, sizeof *c->q.dart);
  c->q.pair = thr_calloc((size_t)q->n_pairs, sizeof *c->q.pair);
  int *made = thr_calloc(2 * (size_t)q->n_darts, sizeof *made);
  thr_status st = c->q.copy && c->q.dart && c->q.pair && made ? THR_OK : thr_nomem(err);
  for (int d = 0; d < q->n_darts && !st; d++) {
    c->becomes[d] = c->keep[c->root[d]] || c->root[d] == d ? c->q.n_darts : c->becomes[c->root[d]];
    if (c->becomes[d] == c->q.n_darts) c->q.dart[c->q.n_darts++] = q->dart[d];
  }
  for (int k = 0; k < q->n_copies && !st; k++) {
    c->q.copy[k] = q->copy[k];
    for (int i = 0; i < (q->copy[k].fold ? 1 : 2); i++)
      c->q.copy[k].dart[i] = c->becomes[q->copy[k].dart[i]];
  }
  if (!st) contract_pairs(c, made);
  free(made);
  if (!st) st = thr_programme_init(&c->p, &c->q, c->whole->o, err);
  c->p.limits = c->whole->limits;
  if (!st && c->whole->ties) st = contract_ties(c, err);
  if (st) return st;
  memcpy(c->p.least, c->whole->least, (size_t)q->n_copies * sizeof *c->p.least); /* turns that are gone ruled some out */
  memcpy(c->p.most, c->whole->most, (size_t)q->n_copies * sizeof *c->p.most);
  return THR_OK;
}
