/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adds copies to a first cover until every node of tube joints has turns enough to be tied.
 *
 * A node with d tubes needs d - 1 turns of two darts each. Greedily, the copies are added that
 * bring most of the lacking darts for their length, two orbits of a type where that keeps the
 * numbers of darts even. At first an edge gets no more than two passes beyond its cover, and more
 * only when nothing else is left: a tube that has more passes than all others of its node together
 * ties no more.
 *
 * Example: a node with three tubes that are passed once each lacks one dart; an edge that is passed
 * twice more serves both its ends. */
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"

#include <stdlib.h>

/* The copies so far, and what the stars lack. */
typedef struct {
  const thr_contraction *contraction;
  const thr_ties *ties;
  const bool *barred;
  int *small;
  long *lack;   /* [ties->n] darts that a star has too few; < 0: more than it needs */
  long *passes; /* [n_edge_orbits] */
  int beyond;   /* passes beyond its cover that an edge may have for now */
} copy_search;

/* Returns the darts at its star that one orbit of this dart type has. */
static int darts_of(const copy_search *search, int dart)
{
  return search->ties->star[dart] < 0 ? 0
                                      : search->contraction->whole->q->dart[dart].darts /
                                            search->ties->nodes[search->ties->star[dart]];
}

/* Computes what every star lacks, and the passes of every edge orbit. failed: stars that get one
 * more turn than they have, whatever that is; NULL = none. */
static void count_darts(copy_search *search, const bool *failed)
{
  const thr_contraction *contraction = search->contraction;
  const thr_quotient *quotient = contraction->whole->q;
  /* What is needed. */
  for (int i = 0; i < search->ties->n; i++)
    search->lack[i] = failed && failed[i] ? 2 : 2 * ((long)search->ties->degree[i] - 1);

  /* What the copies have. */
  for (int i = 0; i < 2 * quotient->n_copies; i++) {
    int dart = quotient->copy[i / 2].dart[i % 2];
    if (i % 2 == 0)
      search->passes[quotient->copy[i / 2].edge_orbit] +=
          (long)search->small[i / 2] * quotient->copy[i / 2].passes;
    if (dart < 0 || search->ties->star[dart] < 0 || (failed && failed[search->ties->star[dart]]))
      continue;
    search->lack[search->ties->star[dart]] -= (long)search->small[i / 2] * darts_of(search, dart);
  }

  /* An end is no turn. */
  for (int dart = 0; dart < quotient->n_darts; dart++)
    if (contraction->root[dart] == dart && search->ties->star[dart] >= 0 &&
        !(failed && failed[search->ties->star[dart]]))
      search->lack[search->ties->star[dart]] +=
          (long)search->small[contraction->p.first_end + contraction->becomes[dart]] *
          darts_of(search, dart);
}

/* Returns how many orbits of a copy type are added together: one keeps the number of darts in a
 * cell even if both ends are in it. */
static int step_of(const copy_search *search, int copy)
{
  const int *dart = search->contraction->whole->q->copy[copy].dart;
  return dart[1] >= 0 && search->contraction->root[dart[0]] == search->contraction->root[dart[1]]
             ? 1
             : 2;
}

/* Returns how many lacking darts a step of this copy type brings. */
static long gain_of(const copy_search *search, int copy)
{
  const int *dart = search->contraction->whole->q->copy[copy].dart;
  long gain = 0;
  /* Both ends at one star bring their darts together, and are counted once. */
  for (int i = 0; i < 2; i++) {
    if (dart[i] < 0 || search->ties->star[dart[i]] < 0) continue;
    int star = search->ties->star[dart[i]],
        twice = i == 0 && dart[1] >= 0 && search->ties->star[dart[1]] == star;

    long more = (long)step_of(search, copy) *
                (darts_of(search, dart[i]) + (twice ? darts_of(search, dart[1]) : 0)),
         lack = search->lack[star];
    if (lack > 0) gain += more < lack ? more : lack;
    if (twice) break;
  }

  return gain;
}

/* Tells whether a step of this copy type may be added: it is not barred, and fits the bound, the
 * capacity and the passes that are allowed for now. */
static bool fits(const copy_search *search, int copy)
{
  const thr_programme *programme = search->contraction->whole;
  const thr_copy_type *type = &programme->q->copy[copy];
  int step = step_of(search, copy);
  long passes = search->passes[type->edge_orbit] + (long)step * type->passes;
  return !search->barred[copy] && search->small[copy] <= programme->most[copy] - step &&
         passes <= programme->capacity[type->edge_orbit] &&

         passes <= programme->cover[type->edge_orbit] + search->beyond;
}

/* Adds a step of this copy type. */
static void add_copy(copy_search *search, int copy)
{
  const thr_copy_type *type = &search->contraction->whole->q->copy[copy];
  int step = step_of(search, copy);
  search->small[copy] += step;
  search->passes[type->edge_orbit] += (long)step * type->passes;
  for (int i = 0; i < 2; i++)
    if (type->dart[i] >= 0 && search->ties->star[type->dart[i]] >= 0)
      search->lack[search->ties->star[type->dart[i]]] -=
          (long)step * darts_of(search, type->dart[i]);
}

/* Adds copies until no star lacks darts. Returns false if nothing fits any more. */
static bool add_copies(copy_search *search)
{
  enum { MOST_BEYOND = 1 << 12 };
  const thr_programme *programme = search->contraction->whole;

  for (search->beyond = 2; search->beyond < MOST_BEYOND;) {
    int best = -1, stars = 0;
    double most = 0;

    /* Which stars lack darts? */
    for (int i = 0; i < search->ties->n; i++)
      stars += search->lack[i] > 0;
    if (stars == 0) return true;

    /* The copies that bring most for their length. */
    for (int copy = 0; copy < programme->first_pair; copy++) {
      double each = (double)gain_of(search, copy) /
                    (step_of(search, copy) * programme->cost[THR_AIM_OVERLAP][copy]);
      if (each <= most * (1 + 1e-9) || !fits(search, copy)) continue;
      most = each;
      best = copy;
    }

    /* If nothing fits, more passes are allowed. */
    if (best < 0)
      search->beyond *= 2;
    else
      add_copy(search, best);
  }
  return false;
}

thr_status thr_contraction_fasten(const thr_contraction *contraction, const bool *barred,
                                  const bool *failed, int *small, bool *found, thr_err *err)
{
  copy_search search = {.contraction = contraction,
                        .ties = contraction->whole->ties,
                        .barred = barred,
                        .small = small};
  search.lack = thr_calloc((size_t)search.ties->n, sizeof *search.lack);
  search.passes = thr_calloc((size_t)contraction->whole->q->n_edge_orbits, sizeof *search.passes);

  thr_status st = search.lack && search.passes ? THR_OK : thr_nomem(err);
  if (!st) {
    count_darts(&search, failed);
    *found = add_copies(&search);
  }

  free(search.lack);
  free(search.passes);
  return st;
}
