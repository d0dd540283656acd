/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the best symmetric cover for one group: how many orbits there are of each type of copies,
 * turns, ends and folds (symmetry/group/quotient.c), as an integer programme.
 *
 * Minimizes overlap, then steps, then paths, then turning (or in another order), subject to: every
 * edge orbit is passed often enough, the turns and ends of every dart type use up its darts, and
 * what is used hangs together. Three steps:
 *   1. a first cover by a minimum T-join, without any programme (start.c), which also bounds the
 * overlap (bounds.c), with a bound on the turning (turning_bound.c);
 *   2. the aims before turning by branch and cut in the contracted programme, whose solution is
 * lifted (contraction.c, symmetry/lift/lift.c);
 *   3. all aims by branch and cut in the whole programme (cover_search.c).
 * A search that is stopped has a cover from step 1 on, and bounds.
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

/* Fails with THR_EINFEASIBLE if cords must be open and a component of the framework has no node
 * where they may end. */
static thr_status check_ends(const thr_programme *programme, thr_err *err)
{
  const thr_quotient *quotient = programme->q;
  int count = 0, *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  bool *has_end = thr_calloc((size_t)quotient->f->n_nodes, sizeof *has_end);
  thr_status st = component && has_end ? thr_frame_components(quotient->f, component, &count, err)
                                       : thr_nomem(err);

  /* A dart type where trails may end serves the components of all its images. */
  for (int dart = 0; dart < quotient->n_darts && !st; dart++) {
    if (programme->most[programme->first_end + dart] == 0) continue;
    for (int i = 0; i < quotient->h->order; i++)
      has_end[component[thr_tail(quotient->f,
                                 quotient->half_image[(size_t)i * 2 * (size_t)quotient->f->n_edges +
                                                      (size_t)quotient->dart[dart].half])]] = true;
  }

  for (int node = 0; node < quotient->f->n_nodes && programme->open && !st; node++)
    if (!has_end[component[node]])
      st = thr_fail(err, THR_EINFEASIBLE,
                    "no cord may end in the component of node %s, with ends %s",
                    quotient->f->name[node], thr_ends_name(programme->o->ends));

  free(component);
  free(has_end);
  return st;
}

/* Makes a cover of the best solution of the search, with its bounds; frees nothing on failure. */
static thr_status fill_cover(thr_cover_search *search, thr_cover *out, thr_err *err)
{
  const thr_quotient *quotient = search->p->q;
  double quick;
  /* The quick bound on turning holds whatever the search has proved. */
  thr_status st = thr_turning_quick_bound(search->p, search->worth, &quick, err);
  if (st) return st;
  search->bound[THR_AIM_TURNING] = fmax(search->bound[THR_AIM_TURNING], quick);

  /* A value may be below its bound by rounding in an earlier aim. */
  memcpy(out->value, search->worth, sizeof out->value);
  for (int a = 0; a < THR_N_AIMS; a++)
    out->bound[a] = fmin(search->bound[a], search->worth[a]);

  out->copies = thr_calloc((size_t)quotient->n_copies, sizeof *out->copies);
  out->pairs = thr_calloc((size_t)quotient->n_pairs, sizeof *out->pairs);
  out->ends = thr_calloc((size_t)quotient->n_darts, sizeof *out->ends);
  if (!out->copies || !out->pairs || !out->ends) return thr_nomem(err);

  thr_programme_to_cover(search->p, search->best, out);
  return THR_OK;
}

/* Joins the connected sets of search->other, gives them ends, and offers the result. */
static thr_status offer_joined(thr_cover_search *search, thr_err *err)
{
  thr_status st = thr_programme_mend(search->p, search->other, err);
  if (!st) st = thr_programme_open(search->p, search->other, err);
  return st ? st : thr_cover_search_offer(search, err);
}

/* Lifts a first cover with tube joints: if the turns of some node cannot tie it, the node gets more
 * copies, and the cover is lifted again. *failed is 0 if a round succeeds. */
static thr_status lift_tied(thr_cover_search *search, thr_contraction *contraction,
                            const bool *barred, int *small, int *failed, thr_err *err)
{
  enum { ROUNDS = 8 };
  const thr_ties *ties = search->p->ties;
  bool *loose = thr_calloc((size_t)ties->n, sizeof *loose), enough = true;
  thr_status st = loose ? thr_contraction_fasten(contraction, barred, NULL, small, &enough, err)
                        : thr_nomem(err);

  /* Every round lifts all cells anew, with more copies at nodes that were not tied in the last one.
   */
  *failed = 1;
  for (int round = 0; round < ROUNDS && enough && *failed && !st; round++) {
    memset(contraction->keep, 0, (size_t)search->p->q->n_darts * sizeof *contraction->keep);
    if (round > 0) st = thr_contraction_fasten(contraction, barred, loose, small, &enough, err);
    if (!st && enough) st = thr_contraction_lift(contraction, small, search->other, failed, err);

    /* Cells that were not lifted: their nodes are not tied. */
    for (int i = 0; i < ties->n && !st; i++)
      loose[i] = false;
    for (int dart = 0; dart < search->p->q->n_darts && !st; dart++)
      if (contraction->keep[dart] && ties->star[dart] >= 0) loose[ties->star[dart]] = true;
  }

  free(loose);
  return st;
}

/* Makes a first cover of one kind in the contracted programme, lifts it and offers it.
 * search->lifted and search->valid say how far it came; contraction->keep is left empty. */
static thr_status try_start(thr_cover_search *search, thr_contraction *contraction,
                            thr_contraction_kind kind, const bool *barred, int *small, thr_err *err)
{
  bool made;
  int failed = 0;
  search->valid = search->lifted = false;
  thr_status st =
      thr_contraction_start(contraction, kind, barred, search->limits, small, &made, err);

  /* Find the turns. */
  if (!st && made && search->p->ties)
    st = lift_tied(search, contraction, barred, small, &failed, err);
  else if (!st && made)
    st = thr_contraction_lift(contraction, small, search->other, &failed, err);
  search->lifted = !st && made && !failed;
  if (search->lifted) st = offer_joined(search, err);

  memset(contraction->keep, 0, (size_t)search->p->q->n_darts * sizeof *contraction->keep);
  return st;
}

/* Tells whether no other copy type of the edge orbit that may be used has more passes, and so fewer
 * symmetries. */
static bool is_freest(const thr_programme *programme, int copy)
{
  const thr_copy_type *type = programme->q->copy;
  for (int k = copy - 1; k >= 0 && type[k].edge == type[copy].edge; k--)
    if (programme->most[k] != 0 && type[k].passes > type[copy].passes) return false;
  for (int k = copy + 1; k < programme->q->n_copies && type[k].edge == type[copy].edge; k++)
    if (programme->most[k] != 0 && type[k].passes > type[copy].passes) return false;
  return true;
}

/* Bars copy types for the next first cover: those used in connected sets of search->other that need
 * an end and have none, but for the freest of their edge orbit; if there are no such types, or all
 * is set, all but the freest. *more: were any barred? */
static thr_status bar_copies(thr_cover_search *search, bool all, bool *barred, bool *more,
                             thr_err *err)
{
  const thr_programme *programme = search->p;
  thr_programme_parts parts = {0};
  thr_status st = thr_programme_parts_init(&parts, programme, err);
  if (!st) thr_programme_parts_find(&parts, programme, search->other);

  /* First the sets that lack an end, then, if nothing came of it, every copy type. */
  *more = false;
  for (int every = all; every < 2 && !*more && !st; every++)
    for (int copy = 0; copy < programme->first_pair; copy++) {
      int root = parts.root[programme->join[copy][0]];
      bool lacks = every || (search->other[copy] > 0 && root >= 0 && parts.ends[root] == 0);
      if (!lacks || barred[copy] || programme->most[copy] == 0 || is_freest(programme, copy))
        continue;
      barred[copy] = *more = true;
    }

  thr_programme_parts_destroy(&parts);
  return st;
}

/* Makes covers without the programme, of the kinds of thr_contraction_start: with least overlap;
 * then, as long as cords would be closed that have to be open, without folds and with freer copies
 * there; then, if need be, with the freest copies twice, which can always be lifted. */
static thr_status make_first_cover(thr_cover_search *search, thr_err *err)
{
  const thr_programme *programme = search->p;
  thr_contraction contraction;
  thr_status st = thr_contraction_init(&contraction, programme, true, err);
  if (st) return st;

  /* Least overlap. */
  int *small = thr_calloc((size_t)contraction.p.n, sizeof *small);
  bool *barred = thr_calloc((size_t)programme->first_pair, sizeof *barred);
  st = small && barred ? try_start(search, &contraction, THR_CONTRACTION_LEAST, barred, small, err)
                       : thr_nomem(err);

  /* Without folds, and with more and more copy types barred. */
  for (bool more = !search->found ||
                   (programme->open && !thr_cover_search_beaten(search, THR_AIM_OVERLAP,
                                                                search->bound[THR_AIM_OVERLAP]));
       more && !st;) {
    st = try_start(search, &contraction, THR_CONTRACTION_PLAIN, barred, small, err);
    more = !search->valid;
    if (!st && more) st = bar_copies(search, !search->lifted, barred, &more, err);
  }

  /* The freest copies twice. */
  if (!search->found && !st)
    st = try_start(search, &contraction, THR_CONTRACTION_TWICE, barred, small, err);

  free(small);
  free(barred);
  thr_contraction_destroy(&contraction);
  return st;
}

/* Bounds overlap and paths without a cover. */
static thr_status bound_first(thr_cover_search *search, thr_err *err)
{
  thr_status st =
      thr_bounds_overlap(search->p, search->limits, &search->bound[THR_AIM_OVERLAP], err);
  return st ? st : thr_bounds_paths(search->p, &search->bound[THR_AIM_PATHS], err);
}

/* Bounds steps and paths if overlap comes first and is proved least: it may not grow for them. */
static thr_status bound_ties(thr_cover_search *search, thr_err *err)
{
  static const thr_aim tie[] = {THR_AIM_STEPS, THR_AIM_PATHS};
  thr_status st = THR_OK;
  if (search->p->o->prefer[0] != THR_AIM_OVERLAP ||
      !thr_cover_search_beaten(search, THR_AIM_OVERLAP, search->bound[THR_AIM_OVERLAP]))
    return THR_OK;

  for (size_t k = 0; k < sizeof tie / sizeof *tie && !st; k++)
    if (!thr_cover_search_beaten(search, tie[k], search->bound[tie[k]]))
      st = thr_bounds_tie(search->p, tie[k], search->worth[THR_AIM_OVERLAP], search->limits,
                          &search->bound[tie[k]], err);

  return st;
}

/* Takes over the bounds that the contracted programme has proved for the first n aims. A bound
 * holds with the aims before at their values: it counts as long as those are proved. */
static void take_bounds(thr_cover_search *search, const thr_cover_search *small, int n)
{
  for (int k = 0; k < n; k++) {
    thr_aim aim = search->p->o->prefer[k];
    search->bound[aim] = fmax(search->bound[aim], small->bound[aim]);
    if (!thr_cover_search_beaten(search, aim, search->bound[aim])) break;
  }
}

/* Gives the search of the contraction what is known of the whole programme: bounds, which hold
 * there, too, and the best cover. */
static thr_status inherit(thr_cover_search *small, const thr_cover_search *search,
                          const thr_contraction *contraction, thr_err *err)
{
  bool proved = true; /* are the aims before at their least? */
  for (int k = 0; k < THR_N_AIMS && proved && search->p->o->prefer[k] != THR_AIM_TURNING; k++) {
    thr_aim aim = search->p->o->prefer[k];
    small->bound[aim] = search->bound[aim];
    proved = thr_cover_search_beaten(search, aim, search->bound[aim]);
  }

  if (!search->found) return THR_OK;
  thr_contraction_lower(contraction, search->best, small->other);
  return thr_cover_search_offer(small, err);
}

/* Returns how many aims are minimized before turning. A quick search leaves out paths, and what
 * only paths come after. */
static int aims_before_turning(const thr_cover_options *options)
{
  int all = 0, quick = 0;
  for (; options->prefer[all] != THR_AIM_TURNING; all++)
    if (options->prefer[all] != THR_AIM_PATHS) quick = all + 1;
  return options->quick ? quick : all;
}

/* Minimizes the aims before turning in the contracted programme, and lifts the solution. Cells
 * where that fails are kept as they are, and the rest is contracted again, until it succeeds. */
static thr_status search_contracted(thr_cover_search *search, thr_err *err)
{
  static const double part = 0.7; /* of the time: the rest is for lifting */
  thr_contraction contraction;
  const thr_limits limits = thr_limits_part(search->limits, part);
  int n_aims = aims_before_turning(search->p->o), failed = 1;
  thr_status st = thr_contraction_init(&contraction, search->p, false, err);
  if (st) return st;

  /* Each round contracts fewer cells. */
  while (failed > 0 && !st) {
    thr_cover_search small;
    st = thr_cover_search_init(&small, &contraction.p, &limits, err);
    if (st) break;
    st = inherit(&small, search, &contraction, err);

    /* Branch and cut. */
    thr_status searched = st ? st : thr_cover_search_aims(&small, n_aims, err);
    if (searched && searched != THR_ELIMIT) st = searched;

    /* Lift what was found, and join it. */
    failed = 0;
    if (!st && small.found)
      st = thr_contraction_lift(&contraction, small.best, search->other, &failed, err);
    if (!st && small.found && !failed) st = offer_joined(search, err);
    if (!st && !failed) take_bounds(search, &small, n_aims);

    /* Some cells could not be lifted: keep them. */
    thr_cover_search_destroy(&small);
    if (!st && failed) st = thr_contraction_make(&contraction, err);
  }

  thr_contraction_destroy(&contraction);
  return st;
}

/* Minimizes all aims in the whole programme, those before turning in at most 0.8 of the time. */
static thr_status search_whole(thr_cover_search *search, thr_err *err)
{
  static const double part = 0.8;
  const thr_limits *all = search->limits, most = thr_limits_part(search->limits, part);
  int n_aims = aims_before_turning(search->p->o);

  /* The aims before turning, then all. */
  search->limits = &most;
  thr_status st = thr_cover_search_aims(search, n_aims, err);
  search->limits = all;
  return st ? st : thr_cover_search_aims(search, THR_N_AIMS, err);
}

/* Begins with what was found and proved before (known), or else with a first cover and first
 * bounds. */
static thr_status begin_search(thr_cover_search *search, const thr_cover *known, thr_err *err)
{
  /* Nothing is known. */
  if (!known->copies) {
    thr_status st = bound_first(search, err);
    if (!st) st = make_first_cover(search, err);
    return !st && search->found ? bound_ties(search, err) : st;
  }

  /* Take over bounds and cover. */
  memcpy(search->bound, known->bound, sizeof search->bound);
  thr_programme_from_cover(search->p, known, search->other);
  return thr_cover_search_offer(search, err);
}

/* Fails with THR_ELIMIT, saying why the search did not do what it was to do. */
static thr_status fail_stopped(const thr_cover_search *search, const char *what, thr_err *err)
{
  const thr_limits *limits = search->limits;
  const char *why = limits->interrupted && *limits->interrupted
                        ? "the search was stopped before it could"
                    : limits->work ? "the work allowed was too little to"
                                   : "the time was too short to";
  return thr_fail(err, THR_ELIMIT, "%s %s", why, what);
}

/* Does all steps of the search, and fills *out. THR_ELIMIT: stopped, with the best cover so far, or
 * without any. */
static thr_status search_all(thr_cover_search *search, const thr_cover *known, thr_cover *out,
                             thr_err *err)
{
  thr_status st = begin_search(search, known, err);
  if (!st) st = search_contracted(search, err);

  /* A quick search ends with a cover, which is not proved best. */
  if (!st && search->p->o->quick && search->found)
    st = THR_ELIMIT;
  else if (!st)
    st = search_whole(search, err);

  /* Hand over the best, and say if it is not proved. */
  if (st && st != THR_ELIMIT) return st;
  if (!search->found) return fail_stopped(search, "find a symmetric threading", err);
  out->optimal = !st;
  thr_status given = fill_cover(search, out, err);
  if (given || !st) return given;
  return fail_stopped(search, "prove that no symmetric threading is better", err);
}

thr_status thr_cover_improve(const thr_quotient *quotient, const thr_cover_options *options,
                             const thr_limits *limits, thr_cover *known, thr_err *err)
{
  thr_programme programme = {0};
  thr_cover cover = {0};
  thr_cover_search search = {0};
  thr_limits first = *limits;
  /* The programme. A first cover may take time after the deadline. */
  thr_status st = thr_programme_init(&programme, quotient, options, err);
  if (first.deadline > 0) first.deadline = fmax(first.deadline, options->start_by);
  programme.limits = &first;
  if (!st) st = check_ends(&programme, err);
  if (!st && options->tube) st = thr_programme_tie(&programme, err);

  /* The search. */
  if (!st) st = thr_cover_search_init(&search, &programme, limits, err);
  if (!st) st = search_all(&search, known, &cover, err);

  /* What was known before is replaced, whatever comes of the search. */
  thr_cover_search_destroy(&search);
  thr_programme_destroy(&programme);
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
