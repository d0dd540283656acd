/* The checker. Nothing here trusts what a plan says about itself. With the code that makes plans it shares the framework, the
 * readers, and the one line that defines the weights (thr_certificate_weight). */
#include "graph/check/check_parts.h"
#include "graph/check/few_edges.h"
#include "graph/plan/distinct_needs.h"
#include "graph/plan/junction.h"
#include "graph/scratch.h"
#include "graph/vector.h"
#include "graph/plan/channels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool thr_check_close(double a, double b, double whole)
{
  return fabs(a - b) <= 1e-9 * whole;
}

/* Direction of a half-edge, of length 1. */
static void unit_direction(const thr_frame *frame, int half, double unit[3])
{
  thr_direction(frame, half, unit);
  double size = sqrt(thr_dot(unit, unit));
  for (int i = 0; i < 3; i++)
    unit[i] /= size;
}

static double angle_of_units(const double a[3], const double b[3])
{
  double sum = 0, difference = 0;
  for (int i = 0; i < 3; i++) {
    sum += (a[i] + b[i]) * (a[i] + b[i]);
    difference += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return 2 * atan2(sqrt(difference), sqrt(sum));
}

double thr_check_angle(const thr_frame *frame, int in, int out)
{
  double unit[2][3];
  unit_direction(frame, in, unit[0]);
  unit_direction(frame, out, unit[1]);
  return angle_of_units(unit[0], unit[1]);
}

/* ---- cords ---- */

static thr_status check_walk(const thr_frame *frame, const thr_cord *cord, thr_err *err)
{
  for (int i = 0; i + 1 < cord->n_passes; i++)
    if (thr_head(frame, cord->half[i]) != thr_tail(frame, cord->half[i + 1]))
      return thr_fail(err, THR_EVIOLATED, "cord %s, pass %d: ends at node %d, but pass %d starts at node %d", cord->id, i + 1,
                      thr_head(frame, cord->half[i]), i + 2, thr_tail(frame, cord->half[i + 1]));
  bool meets = thr_cord_start(frame, cord) == thr_cord_end(frame, cord);
  if (cord->closed != meets)
    return thr_fail(err, THR_EVIOLATED, "cord %s: said to be %s, but runs from node %d to node %d", cord->id,
                    cord->closed ? "closed" : "open", thr_cord_start(frame, cord), thr_cord_end(frame, cord));
  return THR_OK;
}

static thr_status check_ends(const thr_frame *frame, const thr_request *options, const thr_cord *cord, thr_err *err)
{
  if (options->ends == THR_ENDS_CLOSED && !cord->closed)
    return thr_fail(err, THR_EVIOLATED, "cord %s: open, but the plan's options say closed", cord->id);
  int end[2] = {thr_cord_start(frame, cord), thr_cord_end(frame, cord)};
  for (int i = 0; i < 2; i++)
    if (!thr_plan_end_allowed(frame, options, end[i]))
      return thr_fail(err, THR_EVIOLATED, "cord %s: %s at node %d, where no cord end is allowed", cord->id, i ? "ends" : "starts",
                      end[i]);
  return THR_OK;
}

/* Every edge has the passes that it needs, and no more than fit. */
static thr_status check_cover(const thr_frame *frame, const thr_request *options, const int *passes, thr_err *err)
{
  for (int e = 0; e < frame->n_edges; e++) {
    int least = thr_plan_cover(frame, options, e), most = thr_plan_capacity(frame, options, e);
    if (passes[e] < least)
      return thr_fail(err, THR_EVIOLATED, "edge %d (nodes %d and %d): %d of %d passes", e, frame->edge[e][0], frame->edge[e][1],
                      passes[e], least);
    if (passes[e] > most)
      return thr_fail(err, THR_EVIOLATED, "edge %d (nodes %d and %d): %d passes, but only %d fit", e, frame->edge[e][0],
                      frame->edge[e][1], passes[e], most);
  }
  return THR_OK;
}

/* THR_ENDS_COUNTS: at every node as many cord ends as asked for. */
static thr_status check_end_counts(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                                   thr_err *err)
{
  if (options->ends != THR_ENDS_COUNTS) return THR_OK;
  int *count = thr_calloc((size_t)frame->n_nodes, sizeof *count);
  thr_status st = count ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n_cords && !st; i++) {
    count[thr_cord_start(frame, &cord[i])]++;
    count[thr_cord_end(frame, &cord[i])]++;
  }
  for (int v = 0; v < frame->n_nodes && !st; v++)
    if (count[v] != options->end_count[v])
      st = thr_fail(err, THR_EVIOLATED, "node %d: has %d cord %s; the plan's options say %d", v, count[v],
                    count[v] == 1 ? "end" : "ends", options->end_count[v]);
  free(count);
  return st;
}

static thr_status check_lengths(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                                thr_err *err)
{
  for (int i = 0; i < n_cords && options->max_length > 0; i++) {
    double length = thr_cord_length(frame, &cord[i]);
    if (length > options->max_length && !thr_check_close(length, options->max_length, length))
      return thr_fail(err, THR_EVIOLATED, "cord %s: %.12g long; the plan's options allow %.12g", cord[i].id, length,
                      options->max_length);
  }
  return THR_OK;
}

/* THR_JOINT_TUBE: no cord turns back into its edge, and the turns tie the edges of every node together. */
static thr_status check_joints(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                               thr_err *err)
{
  if (options->joint != THR_JOINT_TUBE) return THR_OK;
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < thr_cord_turns(options, &cord[i]); k++)
      if (cord[i].half[(k + 1) % cord[i].n_passes] >> 1 == cord[i].half[k] >> 1)
        return thr_fail(err, THR_EVIOLATED, "cord %s, pass %d: turns back at node %d, which ties no tube joint", cord[i].id,
                        k + 1, thr_head(frame, cord[i].half[k]));
  bool *tied = thr_calloc((size_t)frame->n_nodes, sizeof *tied);
  thr_status st = tied ? thr_junction_tied(frame, cord, n_cords, options->ends == THR_ENDS_CLOSED, tied, err) : thr_nomem(err);
  for (int v = 0; v < frame->n_nodes && !st; v++)
    if (!tied[v])
      st = thr_fail(err, THR_EVIOLATED, "node %d: the cords do not tie its edges together, as the plan's tube joints need", v);
  free(tied);
  return st;
}

/* Counts the passes that the cords make. */
static thr_status check_cords(const thr_frame *frame, const thr_request *options, const int *component, const thr_cord *cord,
                              int n_cords, int *passes, thr_err *err)
{
  thr_status st;
  for (int i = 0; i < n_cords; i++) {
    const thr_cord *c = &cord[i];
    if ((st = check_walk(frame, c, err))) return st;
    if ((st = check_ends(frame, options, c, err))) return st;
    if (component[thr_cord_start(frame, c)] != c->component)
      return thr_fail(err, THR_EVIOLATED, "cord %s: said to be in component %d, but runs in component %d", c->id, c->component,
                      component[thr_cord_start(frame, c)]);
    for (int k = 0; k < c->n_passes; k++)
      passes[c->half[k] >> 1]++;
  }
  if ((st = check_cover(frame, options, passes, err))) return st;
  if ((st = check_end_counts(frame, options, cord, n_cords, err))) return st;
  if ((st = check_lengths(frame, options, cord, n_cords, err))) return st;
  if ((st = thr_check_pulls(frame, options, cord, n_cords, err))) return st;
  return check_joints(frame, options, cord, n_cords, err);
}

static void walked_destroy(thr_check_walked *check_walked)
{
  free(check_walked->component);
  free(check_walked->passes);
  free(check_walked->cords);
  *check_walked = (thr_check_walked){0};
}

/* Without passes yet. On failure check_walked is empty. */
static thr_status walked_init(thr_check_walked *check_walked, const thr_frame *frame, const thr_request *options, thr_err *err)
{
  *check_walked = (thr_check_walked){.component = thr_calloc((size_t)frame->n_nodes, sizeof *check_walked->component),
                                     .passes = thr_calloc((size_t)frame->n_edges, sizeof *check_walked->passes)};
  thr_status st = check_walked->component && check_walked->passes ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(frame, check_walked->component, &check_walked->n_components, err);
  if (!st && !(check_walked->cords = thr_calloc((size_t)check_walked->n_components, sizeof *check_walked->cords)))
    st = thr_nomem(err);
  for (int k = 0; k < check_walked->n_components && !st; k++)
    check_walked->cords[k] = options->cords;
  if (st) walked_destroy(check_walked);
  return st;
}

bool thr_check_fewest_first(const thr_request *options)
{
  return options->max_length > 0 && thr_plan_counted(options) && options->cords_least < options->cords;
}

static void count_cords(thr_check_walked *check_walked, const thr_cord *cord, int n_cords)
{
  for (int k = 0; k < check_walked->n_components; k++)
    check_walked->cords[k] = 0;
  for (int i = 0; i < n_cords; i++)
    check_walked->cords[cord[i].component]++;
}

/* The same from cords, which are checked on the way. */
static thr_status walked_from_cords(thr_check_walked *check_walked, const thr_frame *frame, const thr_request *options,
                                    const thr_cord *cord, int n_cords, thr_err *err)
{
  thr_status st = walked_init(check_walked, frame, options, err);
  if (!st) st = check_cords(frame, options, check_walked->component, cord, n_cords, check_walked->passes, err);
  if (!st) count_cords(check_walked, cord, n_cords);
  if (st) walked_destroy(check_walked);
  return st;
}

/* As many cords in every component as the options say; where they were not asked for, in the one that has most. */
static thr_status check_cord_count(const thr_check_walked *check_walked, const thr_request *options, thr_err *err)
{
  const int *count = check_walked->cords;
  thr_status st = THR_OK;
  bool counted = thr_plan_counted(options);
  int first = 0, end = check_walked->n_components, least = counted ? options->cords_least : options->cords;
  for (int k = 0; k < check_walked->n_components && !st && !counted; k++) {
    if (count[k] > count[first]) first = k;
    end = first + 1;
  }
  for (int k = first; k < end && !st; k++) {
    const char *cords = count[k] == 1 ? "cord" : "cords";
    if (count[k] >= least && count[k] <= options->cords) continue;
    if (least == options->cords)
      st = thr_fail(err, THR_EVIOLATED, "component %d: has %d %s; the plan's options say %d", k, count[k], cords, least);
    else
      st = thr_fail(err, THR_EVIOLATED, "component %d: has %d %s; the plan's options say %d to %d", k, count[k], cords, least,
                    options->cords);
  }
  return st;
}

static double length_of(const thr_frame *frame, const int *passes)
{
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++)
    sum += passes[e] * frame->length[e];
  return sum;
}

/* Edges that so many different cords pass. */
static thr_status count_different(const thr_frame *frame, int distinct, const thr_cord *cord, int n_cords, int *found,
                                  thr_err *err)
{
  int *cords = thr_calloc((size_t)frame->n_edges, sizeof *cords);
  bool *here = thr_calloc((size_t)frame->n_edges, sizeof *here);
  thr_status st = cords && here ? THR_OK : thr_nomem(err);
  *found = 0;
  for (int i = 0; i < n_cords && !st; i++) {
    for (int k = 0; k < cord[i].n_passes; k++) {
      cords[cord[i].half[k] >> 1] += !here[cord[i].half[k] >> 1];
      here[cord[i].half[k] >> 1] = true;
    }
    for (int k = 0; k < cord[i].n_passes; k++)
      here[cord[i].half[k] >> 1] = false;
  }
  for (int e = 0; e < frame->n_edges && !st; e++)
    *found += cords[e] >= distinct;
  free(cords);
  free(here);
  return st;
}

thr_status thr_check_different(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords, int *each,
                               thr_err *err)
{
  int found = 0;
  *each = 1;
  if (options->distinct < 2) return THR_OK;
  thr_status st = count_different(frame, options->distinct, cord, n_cords, &found, err);
  if (found == frame->n_edges) *each = options->distinct;
  return st;
}

/* Least length of the cords of each component by what their edges need and the verdicts: least[n_components], and of the passes
 * themselves, own[n_components]. */
static void take_verdicts(const thr_frame *frame, const thr_request *options, const thr_check_walked *check_walked,
                          const thr_check_verdict *verdict, double *least, double *own)
{
  for (int k = 0; k < check_walked->n_components; k++) {
    least[k] = verdict[k].extra;
    own[k] = 0;
  }
  for (int e = 0; e < frame->n_edges; e++) {
    const int k = check_walked->component[frame->edge[e][0]];
    least[k] += thr_plan_cover(frame, options, e) * frame->length[e];
    own[k] += check_walked->passes[e] * frame->length[e];
  }
}

/* What the verdicts prove of passes with this length; and, of cords (each > 0: so many different ones over every edge), what all
 * sets of few edges do, and prices of walks within a pull (NULL: none). Not where the length is limited to a part above the
 * least, which is then that of the certificates. */
static thr_status sum_verdicts(const thr_frame *frame, const thr_request *options, const thr_check_walked *check_walked, int each,
                               const thr_check_verdict *verdict, const thr_walk_proof *pulled, double length, bool *optimal,
                               double *lower_bound, thr_err *err)
{
  const int n = check_walked->n_components;
  const bool slack = thr_wants_turning(options) && options->turning.length_slack >= 0;
  thr_scratch scratch = {0};
  double *least = thr_scratch_array(&scratch, (size_t)n, sizeof *least),
         *own = thr_scratch_array(&scratch, (size_t)n, sizeof *own), *few = thr_scratch_array(&scratch, (size_t)n, sizeof *few),
         sum = 0;
  thr_status st = thr_scratch_check(&scratch, err);
  *optimal = true;
  for (int k = 0; k < n && !st; k++)
    *optimal &= verdict[k].optimal;
  if (!st) take_verdicts(frame, options, check_walked, verdict, least, own);
  if (!st && !*optimal && each > 0 && !slack)
    st = thr_few_edges_lengths(frame, options, check_walked->component, n,
                               thr_check_fewest_first(options) ? check_walked->cords : NULL, each, few, err);
  if (!st && pulled && pulled->unit && each > 0 && !slack)
    st = thr_check_pulled_length(frame, options, check_walked, pulled, few, err);
  *optimal = true;
  for (int k = 0; k < n && !st; k++) {
    *optimal &= verdict[k].optimal || few[k] >= own[k] * (1 - 1e-9);
    sum += fmax(least[k], few[k]);
  }
  *lower_bound = *optimal ? length : fmin(length, sum);
  thr_scratch_free(&scratch);
  return st;
}

/* Verifies the certificates for passes that were checked already. *verdict is for the caller to free; NULL on failure. */
static thr_status judge_certificates(const thr_frame *frame, const thr_request *options, const thr_check_walked *check_walked,
                                     const thr_certificate *certificate, int n, thr_check_verdict **verdict, thr_err *err)
{
  *verdict = thr_calloc((size_t)check_walked->n_components, sizeof **verdict);
  if (!*verdict) return thr_nomem(err);
  thr_status st = thr_check_certificates(frame, options, check_walked, certificate, n, *verdict, err);
  if (st) {
    free(*verdict);
    *verdict = NULL;
  }
  return st;
}

/* For passes of this length, or cords. */
static thr_status check_proof(const thr_frame *frame, const thr_request *options, const thr_check_walked *check_walked, int each,
                              double length, const thr_certificate *certificate, int n, const thr_walk_proof *pulled,
                              bool *optimal, double *lower_bound, thr_err *err)
{
  thr_check_verdict *verdict;
  thr_status st = judge_certificates(frame, options, check_walked, certificate, n, &verdict, err);
  if (!st) st = sum_verdicts(frame, options, check_walked, each, verdict, pulled, length, optimal, lower_bound, err);
  free(verdict);
  return st;
}

thr_status thr_check_length_proof(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                                  const thr_certificate *certificate, int n_certificates, bool *optimal, double *lower_bound,
                                  thr_err *err)
{
  return thr_check_length_within(frame, options, cord, n_cords, certificate, n_certificates, NULL, optimal, lower_bound, err);
}

thr_status thr_check_length_within(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                                   const thr_certificate *certificate, int n_certificates, const thr_walk_proof *pulled,
                                   bool *optimal, double *lower_bound, thr_err *err)
{
  thr_check_walked check_walked;
  double length = 0;
  int each = 1;
  thr_status st = walked_from_cords(&check_walked, frame, options, cord, n_cords, err);
  if (!st) st = check_cord_count(&check_walked, options, err);
  if (!st) st = thr_check_different(frame, options, cord, n_cords, &each, err);
  for (int i = 0; i < n_cords; i++)
    length += thr_cord_length(frame, &cord[i]);
  if (!st)
    st = check_proof(frame, options, &check_walked, each, length, certificate, n_certificates, pulled, optimal, lower_bound, err);
  walked_destroy(&check_walked);
  return st;
}

thr_status thr_check_cords(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                           const thr_certificate *certificate, int n_certificates, const thr_walk_proof *walks,
                           thr_cords_claim *found, thr_err *err)
{
  thr_check_walked check_walked;
  thr_check_verdict *verdict = NULL;
  *found = (thr_cords_claim){0};
  thr_status st = walked_from_cords(&check_walked, frame, options, cord, n_cords, err);
  if (!st) st = check_cord_count(&check_walked, options, err);
  if (!st && certificate) st = judge_certificates(frame, options, &check_walked, certificate, n_certificates, &verdict, err);
  if (!st) st = thr_check_several(frame, options, &check_walked, cord, n_cords, certificate, verdict, NULL, walks, found, err);
  free(verdict);
  walked_destroy(&check_walked);
  return st;
}

thr_status thr_check_component_least(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                                     const thr_certificate *certificate, int n_certificates, int component, double *least,
                                     thr_err *err)
{
  thr_check_walked check_walked;
  thr_check_verdict *verdict = NULL;
  thr_status st = walked_from_cords(&check_walked, frame, options, cord, n_cords, err);
  if (!st && certificate) st = judge_certificates(frame, options, &check_walked, certificate, n_certificates, &verdict, err);
  if (!st) st = thr_check_least_of(frame, options, &check_walked, certificate, verdict, component, least, err);
  free(verdict);
  walked_destroy(&check_walked);
  return st;
}

thr_status thr_check_tied_cords(const thr_frame *frame, const thr_request *options, const thr_cord *cord, int n_cords,
                                const thr_turning_proof *tied, thr_cords_claim *found, thr_err *err)
{
  thr_check_walked check_walked;
  *found = (thr_cords_claim){0};
  thr_status st = walked_from_cords(&check_walked, frame, options, cord, n_cords, err);
  if (!st) st = check_cord_count(&check_walked, options, err);
  if (!st) st = thr_check_several(frame, options, &check_walked, cord, n_cords, NULL, NULL, tied, NULL, found, err);
  walked_destroy(&check_walked);
  return st;
}

/* Passes that cords can run through: every edge covered with room, and where they are odd in number a cord may end. */
static thr_status check_passes(const thr_frame *frame, const thr_request *options, const thr_check_walked *check_walked,
                               thr_err *err)
{
  int most = options->ends == THR_ENDS_CLOSED ? 0 : 2 * options->cords;
  thr_status st = check_cover(frame, options, check_walked->passes, err);
  int *odd = thr_calloc((size_t)check_walked->n_components, sizeof *odd);
  if (!st && !odd) st = thr_nomem(err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    int sum = 0, ends = options->ends == THR_ENDS_COUNTS ? options->end_count[v] : 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += check_walked->passes[frame->half[i] >> 1];
    if (options->ends == THR_ENDS_COUNTS && (sum - ends) % 2)
      st = thr_fail(err, THR_EVIOLATED, "node %d: %d passes do not go with %d cord %s", v, sum, ends, ends == 1 ? "end" : "ends");
    else if (options->ends != THR_ENDS_COUNTS && sum % 2 &&
             (!thr_plan_end_allowed(frame, options, v) || ++odd[check_walked->component[v]] > most))
      st = thr_fail(err, THR_EVIOLATED, "node %d: %d passes, an odd number, but no cord can end there", v, sum);
  }
  free(odd);
  return st;
}

thr_status thr_check_length_of_passes(const thr_frame *frame, const thr_request *options, const int *passes,
                                      const thr_certificate *certificate, int n_certificates, bool *optimal, double *lower_bound,
                                      thr_err *err)
{
  thr_check_walked check_walked;
  thr_status st = walked_init(&check_walked, frame, options, err);
  if (st) return st;
  memcpy(check_walked.passes, passes, (size_t)frame->n_edges * sizeof *passes);
  st = check_passes(frame, options, &check_walked, err);
  if (!st)
    st = check_proof(frame, options, &check_walked, 0, length_of(frame, check_walked.passes), certificate, n_certificates, NULL,
                     optimal, lower_bound, err);
  walked_destroy(&check_walked);
  return st;
}

/* ---- the whole plan ---- */

static thr_status metric(const char *name, double stated, double found, double whole, thr_err *err)
{
  if (thr_check_close(stated, found, whole)) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "metrics.%s: stated %.12g, but the cords give %.12g", name, stated, found);
}

/* Metrics from the cords alone; passes[n_edges] as check_cords counted them. */
static thr_metrics recompute(const thr_plan *plan, const int *passes)
{
  const thr_frame *frame = &plan->frame;
  thr_metrics metrics = {0};
  for (int e = 0; e < frame->n_edges; e++) {
    int cover = thr_plan_cover(frame, &plan->options, e);
    metrics.base_length += frame->length[e] * cover;
    metrics.overlap += frame->length[e] * (passes[e] - cover);
    metrics.length += frame->length[e] * passes[e];
    metrics.passes += passes[e];
    if (passes[e] > metrics.most_passes) metrics.most_passes = passes[e];
  }
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];
    const int first = plan->options.ends == THR_ENDS_CLOSED ? 0 : 1;
    double turning = 0, unit[2][3]; /* of pass k at k % 2 */
    unit_direction(frame, cord->half[first ? 0 : cord->n_passes - 1], unit[1 - first]);
    for (int k = first; k < cord->n_passes; k++) {
      int in = cord->half[k ? k - 1 : cord->n_passes - 1], out = cord->half[k];
      unit_direction(frame, out, unit[k % 2]);
      double angle = angle_of_units(unit[1 - k % 2], unit[k % 2]);
      turning += angle;
      metrics.worst_turn = fmax(metrics.worst_turn, angle);
      metrics.u_turns += in >> 1 == out >> 1;
    }
    metrics.turning += turning;
    metrics.max_turning = fmax(metrics.max_turning, turning);
  }
  return metrics;
}

/* The crossings that are stated, and that there are none where none are allowed. */
static thr_status check_crossings(const thr_plan *plan, thr_err *err)
{
  thr_channels channels;
  if (plan->options.crossings == THR_CROSSINGS_ALLOW) return THR_OK;
  thr_status st = thr_channels_make(&channels, plan, err);
  if (st) return st;
  double found = (double)channels.crossings;
  thr_channels_destroy(&channels);
  if (plan->options.crossings == THR_CROSSINGS_FORBID && found > 0)
    return thr_fail(err, THR_EVIOLATED, "options.crossings: forbidden, but the cords cross %.0f times inside pieces", found);
  return metric("crossings", plan->metrics.crossings, found, 0, err);
}

static thr_status check_metrics(const thr_plan *plan, const int *passes, thr_err *err)
{
  thr_metrics metrics = recompute(plan, passes);
  const thr_metrics *s = &plan->metrics;
  thr_status st;
  if ((st = metric("length", s->length, metrics.length, metrics.length, err))) return st;
  if ((st = metric("base_length", s->base_length, metrics.base_length, metrics.length, err))) return st;
  if ((st = metric("overlap", s->overlap, metrics.overlap, metrics.length, err))) return st;
  if ((st = metric("passes", s->passes, metrics.passes, 0, err))) return st;
  if ((st = metric("most_passes", s->most_passes, metrics.most_passes, 0, err))) return st;
  if ((st = metric("turning", s->turning, metrics.turning, 1 + metrics.turning, err))) return st;
  if ((st = metric("max_turning", s->max_turning, metrics.max_turning, 1 + metrics.turning, err))) return st;
  if ((st = metric("worst_turn", s->worst_turn, metrics.worst_turn, 1 + metrics.turning, err))) return st;
  if ((st = metric("u_turns", s->u_turns, metrics.u_turns, 0, err))) return st;
  return check_crossings(plan, err);
}

/* *proved: no cords with these options are shorter. */
static thr_status check_length_claim(const thr_plan *plan, const thr_check_walked *check_walked, const thr_check_verdict *verdict,
                                     double *proved, thr_err *err)
{
  bool optimal;
  double lower_bound, length = length_of(&plan->frame, check_walked->passes);
  const thr_length_proof *claim = &plan->proof;
  if (plan->options.joint == THR_JOINT_TUBE) {
    thr_status st = thr_tied_least(&plan->frame, &plan->options, &claim->tied, &lower_bound, err);
    if (st) return st;
    if (lower_bound > length && !thr_check_close(lower_bound, length, length))
      return thr_fail(err, THR_EVIOLATED, "proof.length: the tree proves %.12g, which is more than the length %.12g", lower_bound,
                      length);
    optimal = thr_check_close(lower_bound, length, length);
  } else {
    int each = 1;
    thr_status st = thr_check_different(&plan->frame, &plan->options, plan->cord, plan->n_cords, &each, err);
    if (!st)
      st = sum_verdicts(&plan->frame, &plan->options, check_walked, each, verdict, &claim->pulled, length, &optimal, &lower_bound,
                        err);
    if (st) return st;
  }
  *proved = lower_bound;
  if (!claim->slack_open && !thr_plan_within_slack(&plan->options, length, lower_bound))
    return thr_fail(err, THR_EVIOLATED,
                    "options.turning.length_slack: at most %.12g above the least length, but the cords are %.12g long and only "
                    "%.12g is proved",
                    plan->options.turning.length_slack, length, lower_bound);
  if (claim->optimal && !optimal)
    return thr_fail(err, THR_EVIOLATED, "proof.length: says optimal, but the certificate only proves %.12g of %.12g", lower_bound,
                    plan->metrics.length);
  if (claim->optimal && !thr_check_close(claim->lower_bound, plan->metrics.length, plan->metrics.length))
    return thr_fail(err, THR_EVIOLATED, "proof.length: says optimal, but its lower bound %.12g is not the length %.12g",
                    claim->lower_bound, plan->metrics.length);
  const double least = optimal ? fmax(lower_bound, length) : lower_bound; /* its own rounding is the length's */
  if (claim->lower_bound > least && !thr_check_close(claim->lower_bound, least, least))
    return thr_fail(err, THR_EVIOLATED, "proof.length.lower_bound: stated %.12g, but the certificate proves %.12g",
                    claim->lower_bound, lower_bound);
  if (!thr_check_close(claim->gap, (plan->metrics.length - claim->lower_bound) / plan->metrics.length, 1))
    return thr_fail(err, THR_EVIOLATED, "proof.length.gap: stated %.12g, but length and lower bound give %.12g", claim->gap,
                    (plan->metrics.length - claim->lower_bound) / plan->metrics.length);
  return THR_OK;
}

static thr_status check_cords_claim(const thr_plan *plan, const thr_check_walked *check_walked, const thr_check_verdict *verdict,
                                    thr_err *err)
{
  const thr_cords_claim *claim = &plan->cords_claim;
  thr_cords_claim found;
  const thr_turning_proof *tied = plan->options.joint == THR_JOINT_TUBE && plan->proof.present ? &plan->proof.tied : NULL;
  thr_status st = thr_check_several(&plan->frame, &plan->options, check_walked, plan->cord, plan->n_cords,
                                    plan->proof.certificate, verdict, tied, &plan->proof.walks, &found, err);
  if (st) return st;
  const double whole = found.longest;
  if (!thr_check_close(claim->longest, found.longest, whole))
    return thr_fail(err, THR_EVIOLATED, "proof.cords.longest.length: stated %.12g, but the longest cord is %.12g long",
                    claim->longest, found.longest);
  if (claim->longest_bound > found.longest_bound &&
      !thr_check_close(claim->longest_bound, found.longest_bound, found.longest_bound))
    return thr_fail(err, THR_EVIOLATED, "proof.cords.longest.lower_bound: stated %.12g, but only %.12g is proved",
                    claim->longest_bound, found.longest_bound);
  if (claim->longest_optimal && !(found.longest_optimal && thr_check_close(claim->longest_bound, found.longest, whole)))
    return thr_fail(err, THR_EVIOLATED, "proof.cords.longest: says optimal, but only %.12g of %.12g is proved",
                    fmin(claim->longest_bound, found.longest_bound), found.longest);
  if (claim->fewest > found.fewest)
    return thr_fail(err, THR_EVIOLATED, "proof.cords.fewest.lower_bound: stated %d, but only %d is proved", claim->fewest,
                    found.fewest);
  if (claim->fewest_optimal && (claim->fewest != plan->n_cords || claim->fewest == 0))
    return thr_fail(err, THR_EVIOLATED, "proof.cords.fewest: says optimal, but there are %d cords and its bound is %d",
                    plan->n_cords, claim->fewest);
  return THR_OK;
}

/* *proved: as for check_length_claim; left alone without one. */
static thr_status check_claims(const thr_plan *plan, const thr_check_walked *check_walked, double *proved, thr_err *err)
{
  thr_check_verdict *verdict = NULL;
  thr_status st = THR_OK;
  if (plan->proof.present && (plan->options.joint == THR_JOINT_TUBE) != (plan->proof.tied.n_nodes > 0))
    return thr_fail(err, THR_EVIOLATED, "proof.length: has a %s, but the plan's joints are %s",
                    plan->proof.tied.n_nodes > 0 ? "proof" : "certificate", thr_joint_name(plan->options.joint));
  if (plan->proof.present && plan->options.joint == THR_JOINT_SOLID)
    st = judge_certificates(&plan->frame, &plan->options, check_walked, plan->proof.certificate, plan->proof.n_certificates,
                            &verdict, err);
  if (!st && plan->proof.present) st = check_length_claim(plan, check_walked, verdict, proved, err);
  if (!st && plan->cords_claim.present) st = check_cords_claim(plan, check_walked, verdict, err);
  free(verdict);
  return st;
}

static thr_status check_names(const thr_plan *plan, thr_err *err)
{
  for (int i = 0; i < plan->n_cords; i++) {
    char id[12];
    thr_cord_id(i, id);
    if (strcmp(plan->cord[i].id, id) != 0)
      return thr_fail(err, THR_EVIOLATED, "cord number %d is called %s; expected %s", i + 1, plan->cord[i].id, id);
  }
  return THR_OK;
}

thr_status thr_check_own(thr_status st, const thr_err *found, thr_err *err)
{
  if (st == THR_EVIOLATED) return thr_fail(err, THR_ESOLVER, "the plan does not pass its own check: %s", found->text);
  return st ? thr_fail(err, st, "%s", found->text) : THR_OK;
}

/* Without enough different cords over all edges nothing is optimal. */
static thr_status check_distinct(const thr_plan *plan, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  int found = 0;
  thr_status st = count_different(frame, plan->options.distinct, plan->cord, plan->n_cords, &found, err);
  if (!st) st = metric("distinct", plan->metrics.distinct, found, 0, err);
  bool optimal = plan->proof.optimal || plan->cords_claim.longest_optimal || plan->cords_claim.fewest_optimal ||
                 plan->pull_claim.optimal || plan->turning.optimal || plan->turning.largest_optimal;
  if (!st && optimal && found < frame->n_edges)
    st = thr_fail(err, THR_EVIOLATED, "proof: says optimal, but only %d of %d edges are passed by %d different cords", found,
                  frame->n_edges, plan->options.distinct);
  return st;
}

/* All that is proved of cords that were checked already. */
static thr_status check_proofs(const thr_plan *plan, const thr_check_walked *check_walked, thr_err *err)
{
  double least_length = 0;
  thr_status st = check_claims(plan, check_walked, &least_length, err);
  if (!st && plan->pull_claim.present) st = thr_check_pull_claim(plan, check_walked, err);
  if (!st && plan->turning.present) st = thr_check_turning_claim(plan, least_length, err);
  return st;
}

/* The proofs of cords over every edge by several different ones: about passes that bridges need for that, if the plan has them
 * everywhere. */
static thr_status check_needed(const thr_plan *plan, const thr_check_walked *check_walked, thr_err *err)
{
  thr_plan needed = *plan;
  int *needs = NULL;
  bool all = true;
  thr_status st = plan->options.distinct > 0 ? thr_distinct_needs(&plan->frame, &plan->options, &needs, err) : THR_OK;
  for (int e = 0; needs && e < plan->frame.n_edges; e++)
    all = all && check_walked->passes[e] >= needs[e];
  if (needs && all) needed.frame.cover = needs;
  if (!st) st = check_proofs(&needed, check_walked, err);
  free(needs);
  return st;
}

/* Takes the next cord of every component, after the numbers next[n_components], and the part of the claims that is about these.
 */
static void take_round(const thr_plan *plan, int n_components, int *next, thr_plan *part)
{
  const int rounds = plan->options.distinct;
  part->n_cords = 0;
  part->metrics.length = 0;
  for (int c = 0; c < n_components; c++) {
    while (plan->cord[next[c]].component != c)
      next[c]++;
    part->metrics.length += thr_cord_length(&plan->frame, &plan->cord[next[c]]);
    part->cord[part->n_cords++] = plan->cord[next[c]++];
  }
  part->proof.lower_bound = plan->proof.lower_bound / rounds;
  part->turning.price = plan->turning.price / rounds;
  part->turning.lower_bound = plan->turning.lower_bound / rounds;
  part->turning.pairing_bound = plan->turning.pairing_bound / rounds;
  if (plan->turning.length_limit > 0) part->turning.length_limit = plan->turning.length_limit / rounds;
}

/* Every cord passes every edge (thr_request_alike): the claims hold of a cord of every component by itself, whichever it is, in
 * equal parts. */
static thr_status check_alike(const thr_plan *plan, const thr_request *one, int n_components, thr_err *err)
{
  thr_plan part = *plan;
  int *next = thr_calloc((size_t)n_components, sizeof *next);
  part.options = *one;
  part.cord = thr_calloc((size_t)n_components, sizeof *part.cord); /* whose passes are plan's */
  thr_status st = next && part.cord ? THR_OK : thr_nomem(err);
  for (int i = 0; i < plan->options.distinct && !st; i++) {
    thr_check_walked round;
    take_round(plan, n_components, next, &part);
    st = walked_from_cords(&round, &part.frame, one, part.cord, part.n_cords, err);
    if (st) break;
    st = check_proofs(&part, &round, err);
    walked_destroy(&round);
  }
  free(next);
  free(part.cord);
  return st;
}

thr_status thr_check_plan(const thr_plan *plan, thr_err *err)
{
  thr_check_walked check_walked;
  thr_request one;
  thr_status st = check_names(plan, err);
  if (st) return st;
  if ((st = walked_from_cords(&check_walked, &plan->frame, &plan->options, plan->cord, plan->n_cords, err))) return st;
  if (plan->proof.present || plan->cords_claim.present || plan->options.distinct > 0 || !thr_wants_length(&plan->options))
    st = check_cord_count(&check_walked, &plan->options, err);
  if (!st) st = check_metrics(plan, check_walked.passes, err);
  if (!st && plan->options.distinct > 0) st = check_distinct(plan, err);
  if (!st && plan->symmetry.present) st = thr_check_symmetry(plan, err);
  bool whole = plan->metrics.distinct == plan->frame.n_edges;
  if (!st && whole && thr_request_alike(&plan->frame, &plan->options, &one))
    st = check_alike(plan, &one, check_walked.n_components, err);
  else if (!st)
    st = check_needed(plan, &check_walked, err);
  if (!st && plan->evaluation.present) st = thr_check_evaluation(plan, err);
  walked_destroy(&check_walked);
  return st;
}
