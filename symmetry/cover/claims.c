/* Bounds on what is counted in a plan, from bounds on what is counted in the programme. */
#include "symmetry/cover/claims.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "symmetry/cover/bounds.h"
#include "symmetry/cover/programme.h"
#include "symmetry/cover/turning_bound.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What cords can do in a component: never run alike; only go along it, and perhaps back (one edge; a path that closed cords pass
 * there and back), which is learned once; or anything. */
typedef enum { PLAIN, ALONG, REPEATS } manner;

/* False of an aim and itself. */
static bool comes_before(const thr_cover_options *options, thr_aim a, thr_aim b)
{
  int k = 0;
  while (options->prefer[k] != a && options->prefer[k] != b)
    k++;
  return a != b && options->prefer[k] == a;
}

/* Does a plan count less of an aim before this one than the programme does? Then it may have this at the price of that. */
static bool loosened(const thr_programme *p, thr_aim aim, bool repeats)
{
  bool turning = p->o->ends == THR_ENDS_ANY && !p->open;
  return (repeats && (comes_before(p->o, THR_AIM_STEPS, aim) || comes_before(p->o, THR_AIM_PATHS, aim))) ||
         (turning && comes_before(p->o, THR_AIM_TURNING, aim));
}

/* Sets manner[component], for each component of the framework. scratch: [n_nodes] zeros. */
static void find_manners(const thr_programme *p, const int *component, int count, int *scratch, manner *m)
{
  const thr_frame *frame = p->q->f;
  int *nodes = scratch, least = p->o->ends == THR_ENDS_CLOSED ? 2 : 1; /* an end, or two nodes to turn back at */
  for (int v = 0; v < frame->n_nodes; v++)
    nodes[component[v]]++;
  for (int k = 0; k < count; k++)
    m[k] = nodes[k] == 2 ? ALONG : PLAIN;
  memset(scratch, 0, (size_t)count * sizeof *scratch);
  for (int v = 0; v < frame->n_nodes; v++)
    if (thr_degree(frame, v) == 1 && !thr_programme_end_allowed(p, v) && ++scratch[component[v]] >= least &&
        m[component[v]] == PLAIN)
      m[component[v]] = REPEATS;
  for (int k = 0; k < count; k++)
    if (m[k] == REPEATS && p->o->ends == THR_ENDS_CLOSED) m[k] = ALONG;
  for (int v = 0; v < frame->n_nodes; v++)
    if (thr_degree(frame, v) > 2 && m[component[v]] == ALONG) m[component[v]] = REPEATS;
  for (int e = 0; e < frame->n_edges; e++)
    if (p->cover[p->q->edge_orbit[e]] > 1) m[component[frame->edge[e][0]]] = REPEATS;
}

/* ---- learned steps ---- */

/* Of edge orbits in components that are not plain: what any threading has to learn, each orbit once or, if an element turns its
 * edges round, by half, with the ends of a cord that has but this edge; and what the cover has there. */
static void count_steps(const thr_programme *p, const thr_cover *cover, const int *component, const manner *m, bool plain,
                        double *fewest, double *has)
{
  const thr_quotient *quotient = p->q;
  const thr_frame *frame = quotient->f;
  *fewest = *has = 0;
  for (int e = 0, orbit = 0; e < frame->n_edges; e++) {
    if (quotient->edge_orbit[e] != orbit) continue; /* orbits are numbered as their first edges come */
    orbit++;
    if (!plain && m[component[frame->edge[e][0]]] == PLAIN) continue;
    bool reversed = false;
    for (int i = 0; i < quotient->h->order && !reversed; i++)
      reversed = quotient->half_image[2 * ((size_t)i * (size_t)frame->n_edges + (size_t)e)] == 2 * e + 1;
    const bool alone = m[component[frame->edge[e][0]]] == ALONG;
    *fewest += (reversed ? 0.5 : 1) * (1 + (alone ? 2 * thr_cover_steps_of_end(p->o) : 0));
  }
  for (int k = 0; k < quotient->n_copies; k++)
    if (plain || m[component[frame->edge[quotient->copy[k].edge][0]]] != PLAIN)
      *has += cover->copies[k] * p->cost[THR_AIM_STEPS][k];
  for (int d = 0; d < quotient->n_darts; d++)
    if (plain || m[component[frame->edge[quotient->dart[d].half >> 1][0]]] != PLAIN)
      *has += cover->ends[d] * p->cost[THR_AIM_STEPS][p->first_end + d];
}

/* Are the aims before steps, and steps, as low as can be? Then so they are in each component and its images. */
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

static double bound_steps(const thr_programme *p, const thr_cover *cover, const int *component, const manner *m, bool repeats)
{
  double all, fewest, has, known;
  count_steps(p, cover, component, m, true, &all, &known);
  count_steps(p, cover, component, m, false, &fewest, &has);
  if (loosened(p, THR_AIM_STEPS, repeats) || (repeats && !steps_proved(p, cover))) return all;
  return fmax(all, (repeats ? cover->value : cover->bound)[THR_AIM_STEPS] - has + fewest);
}

/* ---- turning ---- */

/* The most that a plan leaves out of an orbit of closed cords: one turn of every cord. Cords without folds are no more than the
 * turns of an orbit, those with two folds no more than half of them, or than the turns of a fold. Unless steps count before
 * turning, what ends at all images of a turn of cords without folds would save is in the programme's bound, for they make no
 * path more: then only what turns more in a warped framework than its images is left out. */
static double most_left_out(const thr_programme *p)
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
    if (p->most[p->first_pair + y] == 0) continue;
    folds = folds || type->self;
    for (int i = 0; i < quotient->h->order; i++) {
      const int *to = &quotient->half_image[(size_t)i * 2 * (size_t)quotient->f->n_edges];
      sharpest = fmax(sharpest, thr_turn_angle(quotient->f, to[type->half[0]] ^ 1, to[type->half[1]]));
    }
    if (!type->self) plain = fmax(plain, type->turns * (sharpest - (ends_count ? 0 : type->angle)));
    folded = fmax(folded, (type->self ? 1 : 0.5) * type->turns * sharpest);
  }
  return folds ? fmax(plain, folded) : plain;
}

/* Orbits of ends of any cover with no more overlap than this one: the steps that are none of its copies'. */
static double fewest_ends(const thr_programme *p, const thr_cover *cover)
{
  const thr_quotient *quotient = p->q;
  double steps = 0, beyond = 0; /* the most of the passes that are needed; of a unit of overlap */
  for (int k = 0, end; k < quotient->n_copies; k = end) {
    const int orbit = quotient->copy[k].edge_orbit;
    double pass = 0;
    for (end = k; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[k].edge; end++)
      if (p->most[end] != 0) pass = fmax(pass, p->cost[THR_AIM_STEPS][end] / quotient->copy[end].passes);
    steps += p->cover[orbit] * pass;
    beyond = fmax(beyond, pass / quotient->orbit_length[orbit]);
  }
  return fmax(0, ceil(cover->bound[THR_AIM_STEPS] - steps - cover->value[THR_AIM_OVERLAP] * beyond - 1e-4));
}

/* Orbits of closed cords that a cover has at most: as many as paths that need no ends, or as its copies could make. */
static double most_closed(const thr_programme *p, const thr_cover *cover, bool paths_known)
{
  double copies = 0, ends = 0;
  for (int k = 0; k < p->first_pair; k++)
    copies += p->most[k];
  if (!paths_known) return copies;
  if (comes_before(p->o, THR_AIM_OVERLAP, THR_AIM_STEPS) && comes_before(p->o, THR_AIM_STEPS, THR_AIM_TURNING))
    ends = fewest_ends(p, cover);
  return fmax(0, fmin(copies, cover->value[THR_AIM_PATHS] - ceil(ends / 2)));
}

static thr_status bound_turning(const thr_programme *p, const thr_cover *cover, bool repeats, double *bound, thr_err *err)
{
  double any[THR_N_AIMS];
  bool paths = comes_before(p->o, THR_AIM_PATHS, THR_AIM_TURNING);
  *bound = cover->bound[THR_AIM_TURNING];
  if (loosened(p, THR_AIM_TURNING, repeats)) { /* threadings with more of them in the programme count, too */
    memcpy(any, cover->value, sizeof any);
    any[THR_AIM_PATHS] = 1e30;
    thr_status st = thr_turning_quick_bound(p, any, bound, err);
    if (st) return st;
  }
  if (p->o->ends == THR_ENDS_ANY && !p->open)
    *bound = fmax(0, *bound - most_closed(p, cover, paths && !repeats) * most_left_out(p));
  return THR_OK;
}

/* ---- all ---- */

static thr_status make(const thr_programme *p, const thr_cover *cover, const int *component, int count, manner *m, int *scratch,
                       thr_claims *out, thr_err *err)
{
  find_manners(p, component, count, scratch, m);
  memcpy(out->least, cover->bound, sizeof out->least);
  for (int k = 0; k < count; k++)
    out->repeats = out->repeats || m[k] == REPEATS;
  out->least[THR_AIM_STEPS] = bound_steps(p, cover, component, m, out->repeats);
  thr_status st = bound_turning(p, cover, out->repeats, &out->least[THR_AIM_TURNING], err);
  if (!st && loosened(p, THR_AIM_OVERLAP, out->repeats)) {
    out->least[THR_AIM_OVERLAP] = 0;
    st = thr_bounds_overlap(p, &(thr_limits){0}, &out->least[THR_AIM_OVERLAP], err);
  }
  if (!st && (out->repeats || loosened(p, THR_AIM_PATHS, false))) {
    out->least[THR_AIM_PATHS] = 0;
    st = thr_bounds_paths(p, &out->least[THR_AIM_PATHS], err);
  }
  return st;
}

thr_status thr_claims_make(const thr_quotient *quotient, const thr_cover_options *options, const thr_cover *cover,
                           thr_claims *out, thr_err *err)
{
  size_t n = (size_t)quotient->f->n_nodes;
  int count = 0, *component = thr_calloc(n, sizeof *component), *scratch = thr_calloc(n, sizeof *scratch);
  manner *m = thr_calloc(n, sizeof *m);
  thr_programme p = {0};
  *out = (thr_claims){0};
  thr_status st = component && scratch && m ? thr_frame_components(quotient->f, component, &count, err) : thr_nomem(err);
  if (!st) st = thr_programme_init(&p, quotient, options, err);
  if (!st) st = make(&p, cover, component, count, m, scratch, out, err);
  thr_programme_destroy(&p);
  free(component);
  free(scratch);
  free(m);
  return st;
}
