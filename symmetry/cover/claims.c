/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the bounds of a cover prove of threadings as a plan counts them. Internal.
 *
 * The programme of a cover differs from a plan (thr_symmetry_record, thr_metrics) in three ways. It
 * tells cords that run through the same nodes apart; it takes the two passes of a cord that turns
 * back over an edge which the group leaves where it is for images of each other, so that one is
 * learned with the other; and with ends anywhere it counts every turn of a closed cord, of which a
 * plan leaves one out. */
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* False of an aim and itself. */
static bool comes_before(const thr_cover_options *options, thr_aim a, thr_aim b)
{
  int k = 0;
  while (options->prefer[k] != a && options->prefer[k] != b)
    k++;
  return a != b && options->prefer[k] == a;
}

/* Does a plan count less of an aim before this one than the programme does? Then it may have this
 * at the price of that. */
static bool loosened(const thr_programme *p, thr_aim aim, bool repeats, bool retraces)
{
  bool turning = p->o->ends == THR_ENDS_ANY && !p->open;
  return ((repeats || retraces) && comes_before(p->o, THR_AIM_STEPS, aim)) ||
         (repeats && comes_before(p->o, THR_AIM_PATHS, aim)) ||
         (turning && comes_before(p->o, THR_AIM_TURNING, aim));
}

/* Tells whether a threading that is no worse than the cover in the aims before turning may pass the
 * edges of an orbit twice. */
static bool may_pass_twice(const thr_programme *p, const thr_cover *cover, int orbit)
{
  const double length = p->q->orbit_length[orbit];
  if (p->cover[orbit] > 1 || !comes_before(p->o, THR_AIM_OVERLAP, THR_AIM_TURNING)) return true;
  return length <= cover->value[THR_AIM_OVERLAP] + thr_programme_tolerance(p, THR_AIM_OVERLAP);
}

/* Sets repeats[component], for each component of the framework, where cords may run alike, and
 * returns whether there is one. */
static bool find_repeats(const thr_programme *p, const int *component, bool *repeats)
{
  const thr_frame *frame = p->q->f;
  bool any = false;
  for (int e = 0; e < frame->n_edges; e++)
    if (p->cover[p->q->edge_orbit[e]] > 1) any = repeats[component[frame->edge[e][0]]] = true;
  return any;
}

/* ---- learned steps ---- */

/* Computes what any threading has to learn of the edge orbits in components where cords may repeat
 * (all: in all components), each orbit once or, if an element turns its edges round, by half; and
 * what the cover has there. */
static void count_steps(const thr_programme *p, const thr_cover *cover, const int *component,
                        const bool *repeats, bool all, double *fewest, double *has)
{
  const thr_quotient *quotient = p->q;
  const thr_frame *frame = quotient->f;
  *fewest = *has = 0;
  for (int e = 0, orbit = 0; e < frame->n_edges; e++) {
    if (quotient->edge_orbit[e] != orbit)
      continue; /* orbits are numbered as their first edges come */
    orbit++;
    if (!all && !repeats[component[frame->edge[e][0]]]) continue;
    bool reversed = false;
    for (int i = 0; i < quotient->h->order && !reversed; i++)
      reversed =
          quotient->half_image[2 * ((size_t)i * (size_t)frame->n_edges + (size_t)e)] == 2 * e + 1;
    *fewest += reversed ? 0.5 : 1;
  }
  for (int k = 0; k < quotient->n_copies; k++)
    if (all || repeats[component[frame->edge[quotient->copy[k].edge][0]]])
      *has += cover->copies[k] * p->cost[THR_AIM_STEPS][k];
  for (int d = 0; d < quotient->n_darts; d++)
    if (all || repeats[component[frame->edge[quotient->dart[d].half >> 1][0]]])
      *has += cover->ends[d] * p->cost[THR_AIM_STEPS][p->first_end + d];
}

/* Are the aims before steps, and steps, as low as can be? Then so they are in each component and
 * its images. */
static bool steps_proved(const thr_programme *p, const thr_cover *cover)
{
  bool proved = true;
  for (int k = 0; proved; k++) {
    thr_aim aim = p->o->prefer[k];
    proved = cover->value[aim] <= cover->bound[aim] + thr_programme_tolerance(p, aim);
    if (aim == THR_AIM_STEPS) break;
  }
  return proved;
}

static double bound_steps(const thr_programme *p, const thr_cover *cover, const int *component,
                          const bool *repeats, bool any)
{
  double all, fewest, has, known;
  count_steps(p, cover, component, repeats, true, &all, &known);
  count_steps(p, cover, component, repeats, false, &fewest, &has);
  if (loosened(p, THR_AIM_STEPS, any, false) || (any && !steps_proved(p, cover))) return all;
  return fmax(all, (any ? cover->value : cover->bound)[THR_AIM_STEPS] - has + fewest);
}

/* ---- turning ---- */

/* The most that a plan leaves out of an orbit of closed cords: one turn of every cord. Cords
 * without folds are no more than the turns of an orbit, those with two folds no more than half of
 * them, or than the turns of a fold. Unless steps count before turning, what ends at all images of
 * a turn of cords without folds would save is in the programme's bound, for they make no path more:
 * then only what turns more in a warped framework than its images is left out. */
static double most_left_out(const thr_programme *p, const thr_cover *cover)
{
  const bool ends_count = comes_before(p->o, THR_AIM_STEPS, THR_AIM_TURNING);
  const thr_quotient *quotient = p->q;
  double plain = 0, folded = 0;
  bool folds = false;
  for (int k = 0; k < p->first_pair; k++)
    folds = folds || (quotient->copy[k].fold && p->most[k] != 0);
  for (int y = 0; y < quotient->n_pairs; y++) {
    const thr_pair_type *type = &quotient->pair[y];
    double sharpest = 0;
    const bool back = type->half[0] == type->half[1];
    if (p->most[p->first_pair + y] == 0) continue;
    if (back && !may_pass_twice(p, cover, quotient->edge_orbit[type->half[0] >> 1])) continue;
    folds = folds || type->self;
    for (int i = 0; i < quotient->h->order; i++) {
      const int *to = &quotient->half_image[(size_t)i * 2 * (size_t)quotient->f->n_edges];
      sharpest =
          fmax(sharpest, thr_turn_angle(quotient->f, to[type->half[0]] ^ 1, to[type->half[1]]));
    }
    if (!type->self) plain = fmax(plain, type->turns * (sharpest - (ends_count ? 0 : type->angle)));
    folded = fmax(folded, (type->self ? 1 : 0.5) * type->turns * sharpest);
  }
  return folds ? fmax(plain, folded) : plain;
}

/* Orbits of ends of any cover with no more overlap than this one: the steps that are none of its
 * copies'. */
static double fewest_ends(const thr_programme *p, const thr_cover *cover)
{
  const thr_quotient *quotient = p->q;
  double steps = 0, beyond = 0; /* the most of the passes that are needed; of a unit of overlap */
  for (int k = 0, end; k < quotient->n_copies; k = end) {
    const int orbit = quotient->copy[k].edge_orbit;
    double pass = 0;
    for (end = k; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[k].edge;
         end++)
      if (p->most[end] != 0)
        pass = fmax(pass, p->cost[THR_AIM_STEPS][end] / quotient->copy[end].passes);
    steps += p->cover[orbit] * pass;
    beyond = fmax(beyond, pass / quotient->orbit_length[orbit]);
  }
  return fmax(
      0, ceil(cover->bound[THR_AIM_STEPS] - steps - cover->value[THR_AIM_OVERLAP] * beyond - 1e-4));
}

/* Orbits of closed cords that a cover has at most: as many as paths that need no ends, or as its
 * copies could make. */
static double most_closed(const thr_programme *p, const thr_cover *cover, bool paths_known)
{
  double copies = 0, ends = 0;
  for (int k = 0; k < p->first_pair; k++)
    copies += p->most[k];
  if (!paths_known) return copies;
  if (comes_before(p->o, THR_AIM_OVERLAP, THR_AIM_STEPS) &&
      comes_before(p->o, THR_AIM_STEPS, THR_AIM_TURNING))
    ends = fewest_ends(p, cover);
  return fmax(0, fmin(copies, cover->value[THR_AIM_PATHS] - ceil(ends / 2)));
}

static thr_status bound_turning(const thr_programme *p, const thr_cover *cover, bool repeats,
                                bool retraces, double *bound, thr_err *err)
{
  double any[THR_N_AIMS];
  bool paths = comes_before(p->o, THR_AIM_PATHS, THR_AIM_TURNING);
  *bound = cover->bound[THR_AIM_TURNING];
  if (loosened(p, THR_AIM_TURNING, repeats,
               retraces)) { /* threadings with more of them in the programme count, too */
    memcpy(any, cover->value, sizeof any);
    any[THR_AIM_PATHS] = 1e30;
    thr_status st = thr_turning_quick_bound(p, any, bound, err);
    if (st) return st;
  }
  if (p->o->ends == THR_ENDS_ANY && !p->open)
    *bound = fmax(0, *bound - most_closed(p, cover, paths && !repeats && !retraces) *
                                  most_left_out(p, cover));
  return THR_OK;
}

/* ---- all ---- */

static thr_status make(const thr_programme *p, const thr_cover *cover, const int *component,
                       bool *repeats, thr_claims *out, thr_err *err)
{
  memcpy(out->least, cover->bound, sizeof out->least);
  out->repeats = find_repeats(p, component, repeats);
  out->least[THR_AIM_STEPS] = bound_steps(p, cover, component, repeats, out->repeats);
  thr_status st =
      bound_turning(p, cover, out->repeats, out->retraces, &out->least[THR_AIM_TURNING], err);
  if (!st && loosened(p, THR_AIM_OVERLAP, out->repeats, out->retraces)) {
    out->least[THR_AIM_OVERLAP] = 0;
    st = thr_bounds_overlap(p, &(thr_limits){0}, &out->least[THR_AIM_OVERLAP], err);
  }
  if (!st && (out->repeats || loosened(p, THR_AIM_PATHS, false, out->retraces))) {
    out->least[THR_AIM_PATHS] = 0;
    st = thr_bounds_paths(p, &out->least[THR_AIM_PATHS], err);
  }
  return st;
}

thr_status thr_claims_make(const thr_quotient *quotient, const thr_cover_options *options,
                           const thr_cover *cover, double steps, thr_claims *out, thr_err *err)
{
  size_t n = (size_t)quotient->f->n_nodes;
  int count = 0, *component = thr_calloc(n, sizeof *component);
  bool *repeats = thr_calloc(n, sizeof *repeats);
  thr_programme p = {0};
  *out = (thr_claims){.retraces = steps > cover->value[THR_AIM_STEPS] + 1e-6};
  thr_status st = component && repeats ? thr_frame_components(quotient->f, component, &count, err)
                                       : thr_nomem(err);
  if (!st) st = thr_programme_init(&p, quotient, options, err);
  if (!st) st = make(&p, cover, component, repeats, out, err);
  thr_programme_destroy(&p);
  free(component);
  free(repeats);
  return st;
}
