/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The best symmetric cover for one group: how many orbits of each type of copies, turns, ends and
 * folds (symmetry/group/quotient.c), as an integer programme.
 *
 * Minimize overlap, then steps, then paths, subject to: every edge orbit is passed often enough,
 * the turns and ends of every dart type use up its darts, and what is chosen hangs together.
 *
 * Example: a ring of six edges under C6: one orbit of copies and one of turns make one closed cord.
 */
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_cover_destroy(thr_cover *cover)
{
  free(cover->copies);
  free(cover->pairs);
  free(cover->ends);
  *cover = (thr_cover){0};
}

/* A component of the framework without a node where its cords may end. */
static thr_status check_ends(const thr_programme *p, thr_err *err)
{
  const thr_quotient *quotient = p->q;
  int count = 0, *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  bool *has_end = thr_calloc((size_t)quotient->f->n_nodes, sizeof *has_end);
  thr_status st = component && has_end ? thr_frame_components(quotient->f, component, &count, err)
                                       : thr_nomem(err);
  for (int d = 0; d < quotient->n_darts && !st; d++) {
    if (p->most[p->first_end + d] == 0) continue;
    for (int i = 0; i < quotient->h->order; i++)
      has_end[component[thr_tail(quotient->f,
                                 quotient->half_image[(size_t)i * 2 * (size_t)quotient->f->n_edges +
                                                      (size_t)quotient->dart[d].half])]] = true;
  }
  for (int v = 0; v < quotient->f->n_nodes && p->open && !st; v++)
    if (!has_end[component[v]])
      st = thr_fail(err, THR_EINFEASIBLE,
                    "no cord may end in the component of node %s, with ends %s",
                    quotient->f->name[v], thr_ends_name(p->o->ends));
  free(component);
  free(has_end);
  return st;
}

static thr_status hand_over(thr_cover_search *s, thr_cover *out, thr_err *err)
{
  const thr_quotient *quotient = s->p->q;
  double quick;
  thr_status st = thr_turning_quick_bound(s->p, s->worth, &quick, err);
  if (st) return st;
  s->bound[THR_AIM_TURNING] = fmax(s->bound[THR_AIM_TURNING], quick);
  memcpy(out->value, s->worth, sizeof out->value);
  for (int a = 0; a < THR_N_AIMS; a++)
    out->bound[a] =
        fmin(s->bound[a], s->worth[a]); /* a later aim may win by rounding in an earlier one */
  out->copies = thr_calloc((size_t)quotient->n_copies, sizeof *out->copies);
  out->pairs = thr_calloc((size_t)quotient->n_pairs, sizeof *out->pairs);
  out->ends = thr_calloc((size_t)quotient->n_darts, sizeof *out->ends);
  if (!out->copies || !out->pairs || !out->ends) return thr_nomem(err);
  memcpy(out->copies, s->best, (size_t)quotient->n_copies * sizeof *s->best);
  if (quotient->n_pairs > 0)
    memcpy(out->pairs, s->best + s->p->first_pair, (size_t)quotient->n_pairs * sizeof *s->best);
  memcpy(out->ends, s->best + s->p->first_end, (size_t)quotient->n_darts * sizeof *s->best);
  return THR_OK;
}

/* Keeps a lifted solution, mended. */
static thr_status offer_joined(thr_cover_search *s, thr_err *err)
{
  thr_status st = thr_programme_mend(s->p, s->other, err);
  if (!st) st = thr_programme_open(s->p, s->other, err);
  return st ? st : thr_cover_search_offer(s, err);
}

/* The best so far with its turns as cheap as they can be and joined again, and then by exchanges
 * that leave it whole. */
static thr_status offer_improved(thr_cover_search *s, thr_err *err)
{
  const thr_limits limits = thr_limits_part(s->limits, 0.5);
  memcpy(s->other, s->best, (size_t)s->p->n * sizeof *s->best);
  thr_status st = thr_programme_straighten(s->p, &limits, s->other, err);
  if (!st) st = offer_joined(s, err);
  memcpy(s->other, s->best, (size_t)s->p->n * sizeof *s->best);
  if (!st) st = thr_programme_improve(s->p, &limits, s->other, err);
  return st ? st : thr_cover_search_offer(s, err);
}

/* Lifts a start with tube joints, for which it gets more copies where need be; *failed as
 * thr_contraction_lift has it. */
static thr_status lift_tied(thr_cover_search *s, thr_contraction *contraction, const bool *barred,
                            int *small, int *failed, thr_err *err)
{
  enum { ROUNDS = 8 };
  const thr_ties *ties = s->p->ties;
  bool *loose = thr_calloc((size_t)ties->n, sizeof *loose), enough = true;
  thr_status st = loose ? thr_contraction_fasten(contraction, barred, NULL, small, &enough, err)
                        : thr_nomem(err);
  *failed = 1;
  for (int round = 0; round < ROUNDS && enough && *failed && !st; round++) {
    memset(contraction->keep, 0, (size_t)s->p->q->n_darts * sizeof *contraction->keep);
    if (round > 0) st = thr_contraction_fasten(contraction, barred, loose, small, &enough, err);
    if (!st && enough) st = thr_contraction_lift(contraction, small, s->other, failed, err);
    for (int i = 0; i < ties->n && !st; i++)
      loose[i] = false;
    for (int d = 0; d < s->p->q->n_darts && !st; d++)
      if (contraction->keep[d] && ties->star[d] >= 0) loose[ties->star[d]] = true;
  }
  free(loose);
  return st;
}

static thr_status try_start(thr_cover_search *s, thr_contraction *contraction,
                            thr_contraction_kind kind, const bool *barred, int *small, thr_err *err)
{
  bool made;
  int failed = 0;
  s->valid = s->lifted = false;
  thr_status st = thr_contraction_start(contraction, kind, barred, s->limits, small, &made, err);
  if (!st && made && s->p->ties)
    st = lift_tied(s, contraction, barred, small, &failed, err);
  else if (!st && made)
    st = thr_contraction_lift(contraction, small, s->other, &failed, err);
  s->lifted = !st && made && !failed;
  if (s->lifted) st = offer_joined(s, err);
  memset(contraction->keep, 0, (size_t)s->p->q->n_darts * sizeof *contraction->keep);
  return st;
}

static bool is_freest(const thr_programme *p, int copy)
{
  const thr_copy_type *type = p->q->copy;
  for (int k = copy - 1; k >= 0 && type[k].edge == type[copy].edge; k--)
    if (p->most[k] != 0 && type[k].passes > type[copy].passes) return false;
  for (int k = copy + 1; k < p->q->n_copies && type[k].edge == type[copy].edge; k++)
    if (p->most[k] != 0 && type[k].passes > type[copy].passes) return false;
  return true;
}

/* Bars the copies in sets of s->other that need an end and have none, the freest excepted; if there
 * are none of them, or all is asked for, all but the freest. *more: are any barred that were not?
 */
static thr_status bar(thr_cover_search *s, bool all, bool *barred, bool *more, thr_err *err)
{
  const thr_programme *p = s->p;
  thr_programme_parts parts = {0};
  thr_status st = thr_programme_parts_init(&parts, p, err);
  if (!st) thr_programme_parts_find(&parts, p, s->other);
  *more = false;
  for (int every = all; every < 2 && !*more && !st; every++)
    for (int k = 0; k < p->first_pair; k++) {
      int root = parts.root[p->join[k][0]];
      bool lacks = every || (s->other[k] > 0 && root >= 0 && parts.ends[root] == 0);
      if (!lacks || barred[k] || p->most[k] == 0 || is_freest(p, k)) continue;
      barred[k] = *more = true;
    }
  thr_programme_parts_destroy(&parts);
  return st;
}

/* Covers that need no programme: with the least copies; where cords would be closed that may not
 * be, with freer ones there; and if need be, which serves always, with the freest twice. The best
 * is improved. */
static thr_status start(thr_cover_search *s, thr_err *err)
{
  const thr_programme *p = s->p;
  thr_contraction contraction;
  thr_status st = thr_contraction_init(&contraction, p, true, err);
  if (st) return st;
  int *small = thr_calloc((size_t)contraction.p.n, sizeof *small);
  bool *barred = thr_calloc((size_t)p->first_pair, sizeof *barred);
  st = small && barred ? try_start(s, &contraction, THR_CONTRACTION_LEAST, barred, small, err)
                       : thr_nomem(err);
  for (bool more = !s->found || (p->open && !thr_cover_search_beaten(s, THR_AIM_OVERLAP,
                                                                     s->bound[THR_AIM_OVERLAP]));
       more && !st;) {
    st = try_start(s, &contraction, THR_CONTRACTION_PLAIN, barred, small, err);
    more = !s->valid;
    if (!st && more) st = bar(s, !s->lifted, barred, &more, err);
  }
  if (!s->found && !st) st = try_start(s, &contraction, THR_CONTRACTION_TWICE, barred, small, err);
  if (s->found && !st && !p->o->quick) st = offer_improved(s, err);
  free(small);
  free(barred);
  thr_contraction_destroy(&contraction);
  return st;
}

/* What is known of overlap and paths without a cover. */
static thr_status bound_first(thr_cover_search *s, thr_err *err)
{
  thr_status st = thr_bounds_overlap(s->p, s->limits, &s->bound[THR_AIM_OVERLAP], err);
  return st ? st : thr_bounds_paths(s->p, &s->bound[THR_AIM_PATHS], err);
}

/* Steps and paths, where overlap is first and least for certain: it may not grow for them. */
static thr_status bound_ties(thr_cover_search *s, thr_err *err)
{
  static const thr_aim tie[] = {THR_AIM_STEPS, THR_AIM_PATHS};
  thr_status st = THR_OK;
  if (s->p->o->prefer[0] != THR_AIM_OVERLAP ||
      !thr_cover_search_beaten(s, THR_AIM_OVERLAP, s->bound[THR_AIM_OVERLAP]))
    return THR_OK;
  for (size_t k = 0; k < sizeof tie / sizeof *tie && !st; k++)
    if (!thr_cover_search_beaten(s, tie[k], s->bound[tie[k]]))
      st = thr_bounds_tie(s->p, tie[k], s->worth[THR_AIM_OVERLAP], s->limits, &s->bound[tie[k]],
                          err);
  return st;
}

/* Bounds of the contracted programme: with the aims before at the same values. */
static void take_bounds(thr_cover_search *s, const thr_cover_search *small, int n)
{
  for (int k = 0; k < n; k++) {
    thr_aim aim = s->p->o->prefer[k];
    s->bound[aim] = fmax(s->bound[aim], small->bound[aim]);
    if (!thr_cover_search_beaten(s, aim, s->bound[aim])) break;
  }
}

/* What the best so far turns at least, with the aims before turning as they are, in half the time
 * that is left. small: a search of the contraction, whose programme goes on if it keeps no aim
 * lower than that. */
static thr_status bound_turning(thr_cover_search *s, const thr_contraction *contraction,
                                thr_cover_search *small, thr_err *err)
{
  const thr_limits limits = thr_limits_part(s->limits, 0.5);
  thr_relaxation own = {0};
  bool fits = true;
  for (int k = 0; k < small->kept; k++) {
    thr_aim aim = s->p->o->prefer[k];
    fits = fits && s->worth[aim] <= small->worth[aim] + thr_programme_tolerance(s->p, aim);
  }
  thr_status st = thr_turning_bound(contraction, fits ? &small->r : &own, fits ? small->kept : 0,
                                    s->best, s->worth, &limits, &s->bound[THR_AIM_TURNING], err);
  thr_relaxation_destroy(&own);
  return st == THR_ELIMIT ? THR_OK : st;
}

/* What is known of the whole programme: the best cover, and bounds, which hold for the contracted
 * one, too. */
static thr_status begin_with(thr_cover_search *small, const thr_cover_search *s,
                             const thr_contraction *contraction, thr_err *err)
{
  bool same = true; /* are the aims before at their least for certain? */
  for (int k = 0; k < THR_N_AIMS && same && s->p->o->prefer[k] != THR_AIM_TURNING; k++) {
    thr_aim aim = s->p->o->prefer[k];
    small->bound[aim] = s->bound[aim];
    same = thr_cover_search_beaten(s, aim, s->bound[aim]);
  }
  if (!s->found) return THR_OK;
  thr_contraction_lower(contraction, s->best, small->other);
  return thr_cover_search_offer(small, err);
}

/* How many aims come before turning; a quick search leaves out what comes after steps, and paths.
 */
static int aims_before_turning(const thr_cover_options *options)
{
  int all = 0, quick = 0;
  for (; options->prefer[all] != THR_AIM_TURNING; all++)
    if (options->prefer[all] != THR_AIM_PATHS) quick = all + 1;
  return options->quick ? quick : all;
}

/* The aims before turning in the contracted programme, whose cells are left as they are where its
 * solution cannot be lifted. */
static thr_status search_contracted(thr_cover_search *s, thr_err *err)
{
  static const double part = 0.7; /* of the time: the rest is for lifting and for turning */
  thr_contraction contraction;
  const thr_limits limits = thr_limits_part(s->limits, part);
  const bool quick = s->p->o->quick;
  int n = aims_before_turning(s->p->o), failed = 1;
  thr_status st = thr_contraction_init(&contraction, s->p, false, err);
  if (st) return st;
  while (failed > 0 && !st) {
    thr_cover_search small;
    st = thr_cover_search_init(&small, &contraction.p, &limits, err);
    if (st) break;
    st = begin_with(&small, s, &contraction, err);
    small.extra = contraction.p.q->n_darts; /* for the bound on turning */
    thr_status searched = st ? st : thr_cover_search_aims(&small, n, err);
    if (searched && searched != THR_ELIMIT) st = searched;
    failed = 0;
    if (!st && small.found)
      st = thr_contraction_lift(&contraction, small.best, s->other, &failed, err);
    if (!st && small.found && !failed) st = offer_joined(s, err);
    if (!st && !failed) take_bounds(s, &small, n);
    if (!st && !failed && s->found && !quick) st = bound_turning(s, &contraction, &small, err);
    if (!st && s->found && !failed && !quick) st = offer_improved(s, err);
    thr_cover_search_destroy(&small);
    if (!st && failed) st = thr_contraction_make(&contraction, err);
  }
  thr_contraction_destroy(&contraction);
  return st;
}

/* All aims in the whole programme. If that ends early with a cover that the bound on turning does
 * not hold for, it gets one. */
static thr_status search_whole(thr_cover_search *s, thr_err *err)
{
  static const double part = 0.8;
  const thr_limits *all = s->limits, most = thr_limits_part(s->limits, part);
  thr_contraction contraction;
  thr_cover_search none = {0};
  int n = aims_before_turning(s->p->o);
  s->limits = &most;
  thr_status st = thr_cover_search_aims(s, n, err);
  s->limits = all;
  if (!st) return thr_cover_search_aims(s, THR_N_AIMS, err);
  if (st != THR_ELIMIT || !s->found || s->bound[THR_AIM_TURNING] > 0) return st;
  thr_status made = thr_contraction_init(&contraction, s->p, false, err);
  if (made) return made;
  made = bound_turning(s, &contraction, &none, err);
  thr_relaxation_destroy(&none.r);
  thr_contraction_destroy(&contraction);
  return made ? made : st;
}

/* What was found and proved before, or a first cover. */
static thr_status begin(thr_cover_search *s, const thr_cover *known, thr_err *err)
{
  const thr_quotient *quotient = s->p->q;
  thr_status st = THR_OK;
  if (!known->copies) {
    st = bound_first(s, err);
    if (!st) st = start(s, err);
    return !st && s->found ? bound_ties(s, err) : st;
  }
  memcpy(s->bound, known->bound, sizeof s->bound);
  memcpy(s->other, known->copies, (size_t)quotient->n_copies * sizeof *s->other);
  if (quotient->n_pairs > 0)
    memcpy(s->other + s->p->first_pair, known->pairs, (size_t)quotient->n_pairs * sizeof *s->other);
  memcpy(s->other + s->p->first_end, known->ends, (size_t)quotient->n_darts * sizeof *s->other);
  st = thr_cover_search_offer(s, err);
  return !st && s->found && !s->p->o->quick ? offer_improved(s, err) : st;
}

/* Why the search has not done what it was to do. */
static thr_status stopped(const thr_cover_search *s, const char *what, thr_err *err)
{
  const thr_limits *limits = s->limits;
  const char *why = limits->interrupted && *limits->interrupted
                        ? "the search was stopped before it could"
                    : limits->work ? "the work allowed was too little to"
                                   : "the time was too short to";
  return thr_fail(err, THR_ELIMIT, "%s %s", why, what);
}

static thr_status search_all(thr_cover_search *s, const thr_cover *known, thr_cover *out,
                             thr_err *err)
{
  thr_status st = begin(s, known, err);
  if (!st) st = search_contracted(s, err);
  if (!st && s->p->o->quick && s->found)
    st = THR_ELIMIT;
  else if (!st)
    st = search_whole(s, err);
  if (st && st != THR_ELIMIT) return st;
  if (!s->found) return stopped(s, "find a symmetric cover", err);
  out->optimal = !st;
  thr_status given = hand_over(s, out, err);
  if (given || !st) return given;
  return stopped(s, "prove that no symmetric cover is better", err);
}

thr_status thr_cover_improve(const thr_quotient *quotient, const thr_cover_options *options,
                             const thr_limits *limits, thr_cover *known, thr_err *err)
{
  thr_programme p = {0};
  thr_cover cover = {0};
  thr_cover_search s = {0};
  thr_limits first = *limits;
  thr_status st = thr_programme_init(&p, quotient, options, err);
  if (first.deadline > 0) first.deadline = fmax(first.deadline, options->start_by);
  p.limits = &first;
  if (!st) st = check_ends(&p, err);
  if (!st && options->tube) st = thr_programme_tie(&p, err);
  if (!st) st = thr_cover_search_init(&s, &p, limits, err);
  if (!st) st = search_all(&s, known, &cover, err);
  thr_cover_search_destroy(&s);
  thr_programme_destroy(&p);
  if (st && st != THR_ELIMIT) thr_cover_destroy(&cover);
  thr_cover_destroy(known);
  *known = cover;
  return st;
}

thr_status thr_cover_find(const thr_quotient *quotient, const thr_cover_options *options,
                          const thr_limits *limits, thr_cover *out, thr_err *err)
{
  *out = (thr_cover){0};
  return thr_cover_improve(quotient, options, limits, out, err);
}
