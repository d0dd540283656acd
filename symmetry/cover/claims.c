/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what the bounds of a cover prove of threadings as a plan counts them.
 *
 * The programme of a cover counts otherwise than a plan (thr_symmetry_record, thr_metrics), in
 * three ways:
 *   - cords that run through the same nodes are different paths for the programme and one path in a
 * plan;
 *   - the two passes of a cord that turns back over an edge in a mirror are images of each other
 * for the programme, one learned with the other, but two steps in a plan;
 *   - with ends anywhere the programme counts every turn of a closed cord, of which a plan leaves
 * one out. So an aim's bound is lowered by what plans may count less, and where an earlier aim is
 * counted less in plans, that aim may be had at the price of this one: only bounds that hold
 * whatever the earlier aims remain.
 *
 * Example: every edge is needed twice. A plan may have two cords alike, and then learns one of them
 * only. */
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tells whether aim a is minimized before aim b; false of an aim and itself. */
static bool comes_before(const thr_cover_options *options, thr_aim a, thr_aim b)
{
  int k = 0;
  while (options->prefer[k] != a && options->prefer[k] != b)
    k++;
  return a != b && options->prefer[k] == a;
}

/* Tells whether a plan may count less of an aim before this one than the programme does. */
static bool is_loosened(const thr_programme *programme, thr_aim aim, bool repeats, bool retraces)
{
  bool turning = programme->o->ends == THR_ENDS_ANY && !programme->open;
  return ((repeats || retraces) && comes_before(programme->o, THR_AIM_STEPS, aim)) ||
         (repeats && comes_before(programme->o, THR_AIM_PATHS, aim)) ||
         (turning && comes_before(programme->o, THR_AIM_TURNING, aim));
}

/* Tells whether a threading that is no worse than the cover in the aims before turning may pass the
 * edges of an orbit more than once. */
static bool may_pass_twice(const thr_programme *programme, const thr_cover *cover, int orbit)
{
  const double length = programme->q->orbit_length[orbit];
  if (programme->cover[orbit] > 1 || !comes_before(programme->o, THR_AIM_OVERLAP, THR_AIM_TURNING))
    return true;
  return length <=
         cover->value[THR_AIM_OVERLAP] + thr_programme_tolerance(programme, THR_AIM_OVERLAP);
}

/* Sets repeats[component], for each component of the framework, where cords may run alike, which
 * needs edges with several passes. Returns whether there is one. */
static bool find_repeats(const thr_programme *programme, const int *component, bool *repeats)
{
  const thr_frame *frame = programme->q->f;
  bool any = false;
  for (int e = 0; e < frame->n_edges; e++)
    if (programme->cover[programme->q->edge_orbit[e]] > 1)
      any = repeats[component[frame->edge[e][0]]] = true;
  return any;
}

/* ---- learned steps ---- */

/* Computes what any threading has to learn of the edge orbits in components where cords may repeat
 * (all: in all components): each orbit once, or by half if an element turns its edges round. *has:
 * the steps of the cover there. */
static void count_steps(const thr_programme *programme, const thr_cover *cover,
                        const int *component, const bool *repeats, bool all, double *fewest,
                        double *has)
{
  const thr_quotient *quotient = programme->q;
  const thr_frame *frame = quotient->f;
  *fewest = *has = 0;

  /* Orbits are numbered as their first edges come. */
  for (int e = 0, orbit = 0; e < frame->n_edges; e++) {
    if (quotient->edge_orbit[e] != orbit) continue;
    orbit++;
    if (!all && !repeats[component[frame->edge[e][0]]]) continue;

    /* Half an edge is learned if some element turns it round. */
    bool reversed = false;
    for (int i = 0; i < quotient->h->order && !reversed; i++)
      reversed =
          quotient->half_image[2 * ((size_t)i * (size_t)frame->n_edges + (size_t)e)] == 2 * e + 1;
    *fewest += reversed ? 0.5 : 1;
  }

  /* What the cover has: copies, and ends with their steps. */
  for (int k = 0; k < quotient->n_copies; k++)
    if (all || repeats[component[frame->edge[quotient->copy[k].edge][0]]])
      *has += cover->copies[k] * programme->cost[THR_AIM_STEPS][k];
  for (int d = 0; d < quotient->n_darts; d++)
    if (all || repeats[component[frame->edge[quotient->dart[d].half >> 1][0]]])
      *has += cover->ends[d] * programme->cost[THR_AIM_STEPS][programme->first_end + d];
}

/* Tells whether steps, and the aims before steps, are proved least; they are so in each component
 * and its images then. */
static bool steps_proved(const thr_programme *programme, const thr_cover *cover)
{
  bool proved = true;
  for (int k = 0; proved; k++) {
    thr_aim aim = programme->o->prefer[k];
    proved = cover->value[aim] <= cover->bound[aim] + thr_programme_tolerance(programme, aim);
    if (aim == THR_AIM_STEPS) break;
  }
  return proved;
}

/* Returns the least number of learned steps of plans. Where cords may run alike, the cover's steps
 * there are replaced by what has to be learned in any case. */
static double bound_steps(const thr_programme *programme, const thr_cover *cover,
                          const int *component, const bool *repeats, bool any)
{
  double all, fewest, has, known;
  count_steps(programme, cover, component, repeats, true, &all, &known);
  count_steps(programme, cover, component, repeats, false, &fewest, &has);

  /* Only what has to be learned in any case holds for certain. */
  if (is_loosened(programme, THR_AIM_STEPS, any, false) || (any && !steps_proved(programme, cover)))
    return all;
  return fmax(all, (any ? cover->value : cover->bound)[THR_AIM_STEPS] - has + fewest);
}

/* ---- turning ---- */

/* Returns the most that plans leave out of an orbit of closed cords: one turn of every cord. Cords
 * without folds are no more than the turns of an orbit; those with two folds are no more than half
 * of these, or than the turns of a fold. Unless steps count before turning, the programme's bound
 * has what ends at all images of a turn of cords without folds would save, for they make no path
 * more: then only what turns more than the mean of its images, in a warped framework, is left out.
 */
static double largest_turn_left_out(const thr_programme *programme, const thr_cover *cover)
{
  const bool ends_count = comes_before(programme->o, THR_AIM_STEPS, THR_AIM_TURNING);
  const thr_quotient *quotient = programme->q;
  double plain = 0, folded = 0;
  bool folds = false;

  /* May there be folds at all? */
  for (int k = 0; k < programme->first_pair; k++)
    folds = folds || (quotient->copy[k].fold && programme->most[k] != 0);

  /* The sharpest image of every turn that may be used. */
  for (int pair = 0; pair < quotient->n_pairs; pair++) {
    const thr_pair_type *type = &quotient->pair[pair];
    double sharpest = 0;
    const bool back = type->half[0] == type->half[1];
    if (programme->most[programme->first_pair + pair] == 0) continue;
    if (back && !may_pass_twice(programme, cover, quotient->edge_orbit[type->half[0] >> 1]))
      continue;
    folds = folds || type->self;

    /* Turns are counted by their mean angle; in a warped framework some image is sharper. */
    for (int i = 0; i < quotient->h->order; i++) {
      const int *image = &quotient->half_image[(size_t)i * 2 * (size_t)quotient->f->n_edges];
      sharpest = fmax(sharpest,
                      thr_turn_angle(quotient->f, image[type->half[0]] ^ 1, image[type->half[1]]));
    }

    /* Of closed cords without folds, and with. */
    if (!type->self) plain = fmax(plain, type->turns * (sharpest - (ends_count ? 0 : type->angle)));
    folded = fmax(folded, (type->self ? 1 : 0.5) * type->turns * sharpest);
  }

  return folds ? fmax(plain, folded) : plain;
}

/* Returns the least number of orbits of ends of covers with no more overlap than this one: steps
 * that copies cannot make up. With its bound on steps, every cover has at least as many steps;
 * copies that cover the edges, and those of the overlap, have at most so many. */
static double fewest_ends(const thr_programme *programme, const thr_cover *cover)
{
  const thr_quotient *quotient = programme->q;
  double steps = 0,
         beyond = 0; /* at most, of the passes that are needed and of a unit of overlap */

  /* Steps of a pass, by the copy type that has most of them. */
  for (int k = 0, end; k < quotient->n_copies; k = end) {
    const int orbit = quotient->copy[k].edge_orbit;
    double pass = 0;
    for (end = k; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[k].edge;
         end++)
      if (programme->most[end] != 0)
        pass = fmax(pass, programme->cost[THR_AIM_STEPS][end] / quotient->copy[end].passes);

    steps += programme->cover[orbit] * pass;
    beyond = fmax(beyond, pass / quotient->orbit_length[orbit]);
  }

  return fmax(
      0, ceil(cover->bound[THR_AIM_STEPS] - steps - cover->value[THR_AIM_OVERLAP] * beyond - 1e-4));
}

/* Returns the largest number of orbits of closed cords in a cover: copies allow no more, and, if
 * paths are limited, there are no more than paths that need no ends. */
static double most_closed(const thr_programme *programme, const thr_cover *cover, bool paths_known)
{
  double copies = 0, ends = 0;
  for (int k = 0; k < programme->first_pair; k++)
    copies += programme->most[k];

  if (!paths_known) return copies;

  if (comes_before(programme->o, THR_AIM_OVERLAP, THR_AIM_STEPS) &&
      comes_before(programme->o, THR_AIM_STEPS, THR_AIM_TURNING))
    ends = fewest_ends(programme, cover);

  return fmax(0, fmin(copies, cover->value[THR_AIM_PATHS] - ceil(ends / 2)));
}

/* Computes the least turning of plans. */
static thr_status bound_turning(const thr_programme *programme, const thr_cover *cover,
                                bool repeats, bool retraces, double *bound, thr_err *err)
{
  double without_limit[THR_N_AIMS];
  bool paths = comes_before(programme->o, THR_AIM_PATHS, THR_AIM_TURNING);
  *bound = cover->bound[THR_AIM_TURNING];
  /* Threadings with more paths in the programme count, too: a bound for any number of paths. */
  if (is_loosened(programme, THR_AIM_TURNING, repeats, retraces)) {
    memcpy(without_limit, cover->value, sizeof without_limit);
    without_limit[THR_AIM_PATHS] = 1e30;
    thr_status st = thr_turning_quick_bound(programme, without_limit, bound, err);
    if (st) return st;
  }

  /* A turn of every closed cord is left out. */
  if (programme->o->ends == THR_ENDS_ANY && !programme->open)
    *bound = fmax(0, *bound - most_closed(programme, cover, paths && !repeats && !retraces) *
                                  largest_turn_left_out(programme, cover));
  return THR_OK;
}

/* ---- all aims ---- */

/* Fills the bounds of all aims. Where a bound of the cover does not hold for plans, overlap and
 * paths get the bounds that hold whatever the other aims are. */
static thr_status make_all(const thr_programme *programme, const thr_cover *cover,
                           const int *component, bool *repeats, thr_claims *out, thr_err *err)
{
  memcpy(out->least, cover->bound, sizeof out->least);
  out->repeats = find_repeats(programme, component, repeats);
  out->least[THR_AIM_STEPS] = bound_steps(programme, cover, component, repeats, out->repeats);
  thr_status st = bound_turning(programme, cover, out->repeats, out->retraces,
                                &out->least[THR_AIM_TURNING], err);

  if (!st && is_loosened(programme, THR_AIM_OVERLAP, out->repeats, out->retraces)) {
    out->least[THR_AIM_OVERLAP] = 0;
    st = thr_bounds_overlap(programme, &(thr_limits){0}, &out->least[THR_AIM_OVERLAP], err);
  }

  if (!st && (out->repeats || is_loosened(programme, THR_AIM_PATHS, false, out->retraces))) {
    out->least[THR_AIM_PATHS] = 0;
    st = thr_bounds_paths(programme, &out->least[THR_AIM_PATHS], err);
  }
  return st;
}

thr_status thr_claims_make(const thr_quotient *quotient, const thr_cover_options *options,
                           const thr_cover *cover, double steps, thr_claims *out, thr_err *err)
{
  size_t n = (size_t)quotient->f->n_nodes;
  int count = 0, *component = thr_calloc(n, sizeof *component);
  bool *repeats = thr_calloc(n, sizeof *repeats);
  thr_programme programme = {0};
  *out = (thr_claims){.retraces = steps > cover->value[THR_AIM_STEPS] + 1e-6};
  thr_status st = component && repeats ? thr_frame_components(quotient->f, component, &count, err)
                                       : thr_nomem(err);

  if (!st) st = thr_programme_init(&programme, quotient, options, err);
  if (!st) st = make_all(&programme, cover, component, repeats, out, err);

  thr_programme_destroy(&programme);
  free(component);
  free(repeats);
  return st;
}
