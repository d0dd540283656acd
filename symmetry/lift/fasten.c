/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Copies for a start that has to tie tube joints. */
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"

#include <limits.h>
#include <stdlib.h>

typedef struct {
  const thr_contraction *c;
  const thr_ties *ties;
  const bool *barred;
  int *small;
  long *lack;   /* [ties->n] darts that a star has too few, < 0: more than it needs */
  long *passes; /* [n_edge_orbits] */
  int beyond; /* the cover an edge gets no more passes for now: a tube that has more than all others
                 together ties no more */
} fastening;

/* Darts at its star that one orbit of this dart type has. */
static int darts_of(const fastening *x, int d)
{
  return x->ties->star[d] < 0 ? 0
                              : x->c->whole->q->dart[d].darts / x->ties->nodes[x->ties->star[d]];
}

static void count_darts(fastening *x, const bool *failed)
{
  const thr_contraction *contraction = x->c;
  const thr_quotient *quotient = contraction->whole->q;
  for (int i = 0; i < x->ties->n; i++)
    x->lack[i] = failed && failed[i] ? 2 : 2 * ((long)x->ties->degree[i] - 1);
  for (int i = 0; i < 2 * quotient->n_copies; i++) {
    int d = quotient->copy[i / 2].dart[i % 2];
    if (i % 2 == 0)
      x->passes[quotient->copy[i / 2].edge_orbit] +=
          (long)x->small[i / 2] * quotient->copy[i / 2].passes;
    if (d < 0 || x->ties->star[d] < 0 || (failed && failed[x->ties->star[d]])) continue;
    x->lack[x->ties->star[d]] -= (long)x->small[i / 2] * darts_of(x, d);
  }
  for (int d = 0; d < quotient->n_darts; d++) /* an end is no turn */
    if (contraction->root[d] == d && x->ties->star[d] >= 0 && !(failed && failed[x->ties->star[d]]))
      x->lack[x->ties->star[d]] +=
          (long)x->small[contraction->p.first_end + contraction->becomes[d]] * darts_of(x, d);
}

/* How many at once: both ends in one cell keep its number even. */
static int step_of(const fastening *x, int k)
{
  const int *d = x->c->whole->q->copy[k].dart;
  return d[1] >= 0 && x->c->root[d[0]] == x->c->root[d[1]] ? 1 : 2;
}

/* Darts that this copy type brings where they are lacking. */
static long gain_of(const fastening *x, int k)
{
  const int *d = x->c->whole->q->copy[k].dart;
  long gain = 0;
  for (int i = 0; i < 2; i++) {
    if (d[i] < 0 || x->ties->star[d[i]] < 0) continue;
    int star = x->ties->star[d[i]], twice = i == 0 && d[1] >= 0 && x->ties->star[d[1]] == star;
    long more = (long)step_of(x, k) * (darts_of(x, d[i]) + (twice ? darts_of(x, d[1]) : 0)),
         lack = x->lack[star];
    if (lack > 0) gain += more < lack ? more : lack;
    if (twice) break;
  }
  return gain;
}

static bool fits(const fastening *x, int k)
{
  const thr_programme *p = x->c->whole;
  const thr_copy_type *type = &p->q->copy[k];
  int step = step_of(x, k);
  long passes = x->passes[type->edge_orbit] + (long)step * type->passes;
  return !x->barred[k] && x->small[k] <= p->most[k] - step &&
         passes <= p->capacity[type->edge_orbit] &&
         passes <= p->cover[type->edge_orbit] + x->beyond;
}

static void add_copy(fastening *x, int k)
{
  const thr_copy_type *type = &x->c->whole->q->copy[k];
  int step = step_of(x, k);
  x->small[k] += step;
  x->passes[type->edge_orbit] += (long)step * type->passes;
  for (int i = 0; i < 2; i++)
    if (type->dart[i] >= 0 && x->ties->star[type->dart[i]] >= 0)
      x->lack[x->ties->star[type->dart[i]]] -= (long)step * darts_of(x, type->dart[i]);
}

static bool add_copies(fastening *x)
{
  enum { MOST = 1 << 12 };
  const thr_programme *p = x->c->whole;
  for (x->beyond = 2; x->beyond < MOST;) {
    int best = -1, stars = 0;
    double most = 0;
    for (int i = 0; i < x->ties->n; i++)
      stars += x->lack[i] > 0;
    if (stars == 0) return true;
    for (int k = 0; k < p->first_pair; k++) {
      double each = (double)gain_of(x, k) / (step_of(x, k) * p->cost[THR_AIM_OVERLAP][k]);
      if (each <= most * (1 + 1e-9) || !fits(x, k)) continue;
      most = each;
      best = k;
    }
    if (best < 0)
      x->beyond *= 2;
    else
      add_copy(x, best);
  }
  return false;
}

thr_status thr_contraction_fasten(const thr_contraction *contraction, const bool *barred,
                                  const bool *failed, int *small, bool *found, thr_err *err)
{
  fastening x = {
      .c = contraction, .ties = contraction->whole->ties, .barred = barred, .small = small};
  x.lack = thr_calloc((size_t)x.ties->n, sizeof *x.lack);
  x.passes = thr_calloc((size_t)contraction->whole->q->n_edge_orbits, sizeof *x.passes);
  thr_status st = x.lack && x.passes ? THR_OK : thr_nomem(err);
  if (!st) {
    count_darts(&x, failed);
    *found = add_copies(&x);
  }
  free(x.lack);
  free(x.passes);
  return st;
}
