/* The checker. Nothing here trusts what a plan says about itself. With the code that makes plans it shares the framework, the
 * readers, and the one line that defines the weights (thr_certificate_weight). */
#include "graph/check/check_parts.h"
#include "graph/plan/junction.h"
#include "graph/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool thr_check_close(double a, double b, double whole)
{
  return fabs(a - b) <= 1e-9 * whole;
}

double thr_check_angle(const thr_frame *f, int in, int out)
{
  double unit[2][3], sum = 0, difference = 0;
  for (int k = 0; k < 2; k++) {
    thr_direction(f, k ? out : in, unit[k]);
    double size = sqrt(thr_dot(unit[k], unit[k]));
    for (int i = 0; i < 3; i++)
      unit[k][i] /= size;
  }
  for (int i = 0; i < 3; i++) {
    sum += (unit[0][i] + unit[1][i]) * (unit[0][i] + unit[1][i]);
    difference += (unit[0][i] - unit[1][i]) * (unit[0][i] - unit[1][i]);
  }
  return 2 * atan2(sqrt(difference), sqrt(sum));
}

/* ---- cords ---- */

static thr_status check_walk(const thr_frame *f, const thr_cord *c, thr_err *err)
{
  for (int i = 0; i + 1 < c->n_passes; i++)
    if (thr_head(f, c->half[i]) != thr_tail(f, c->half[i + 1]))
      return thr_fail(err, THR_EVIOLATED, "cord %s, pass %d: ends at node %d, but pass %d starts at node %d", c->id, i + 1,
                      thr_head(f, c->half[i]), i + 2, thr_tail(f, c->half[i + 1]));
  bool meets = thr_cord_start(f, c) == thr_cord_end(f, c);
  if (c->closed != meets)
    return thr_fail(err, THR_EVIOLATED, "cord %s: said to be %s, but runs from node %d to node %d", c->id,
                    c->closed ? "closed" : "open", thr_cord_start(f, c), thr_cord_end(f, c));
  return THR_OK;
}

static thr_status check_ends(const thr_frame *f, const thr_plan_options *o, const thr_cord *c, thr_err *err)
{
  if (o->ends == THR_ENDS_CLOSED && !c->closed)
    return thr_fail(err, THR_EVIOLATED, "cord %s: open, but the plan's options say closed", c->id);
  int end[2] = {thr_cord_start(f, c), thr_cord_end(f, c)};
  for (int i = 0; i < 2; i++)
    if (!thr_plan_end_allowed(f, o, end[i]))
      return thr_fail(err, THR_EVIOLATED, "cord %s: %s at node %d, where no cord end is allowed", c->id, i ? "ends" : "starts",
                      end[i]);
  return THR_OK;
}

/* Every edge has the passes that it needs, and no more than fit. */
static thr_status check_cover(const thr_frame *f, const thr_plan_options *o, const int *passes, thr_err *err)
{
  for (int e = 0; e < f->n_edges; e++) {
    int least = thr_plan_cover(f, o, e), most = thr_plan_capacity(f, o, e);
    if (passes[e] < least)
      return thr_fail(err, THR_EVIOLATED, "edge %d (nodes %d and %d): %d of %d passes", e, f->edge[e][0], f->edge[e][1],
                      passes[e], least);
    if (passes[e] > most)
      return thr_fail(err, THR_EVIOLATED, "edge %d (nodes %d and %d): %d passes, but only %d fit", e, f->edge[e][0],
                      f->edge[e][1], passes[e], most);
  }
  return THR_OK;
}

/* THR_ENDS_COUNTS: at every node as many cord ends as asked for. */
static thr_status check_end_counts(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_err *err)
{
  if (o->ends != THR_ENDS_COUNTS) return THR_OK;
  int *count = thr_calloc((size_t)f->n_nodes, sizeof *count);
  thr_status st = count ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n_cords && !st; i++) {
    count[thr_cord_start(f, &cord[i])]++;
    count[thr_cord_end(f, &cord[i])]++;
  }
  for (int v = 0; v < f->n_nodes && !st; v++)
    if (count[v] != o->end_count[v])
      st = thr_fail(err, THR_EVIOLATED, "node %d: has %d cord %s; the plan's options say %d", v, count[v],
                    count[v] == 1 ? "end" : "ends", o->end_count[v]);
  free(count);
  return st;
}

static thr_status check_lengths(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_err *err)
{
  for (int i = 0; i < n_cords && o->max_length > 0; i++) {
    double length = thr_cord_length(f, &cord[i]);
    if (length > o->max_length && !thr_check_close(length, o->max_length, length))
      return thr_fail(err, THR_EVIOLATED, "cord %s: %.12g long; the plan's options allow %.12g", cord[i].id, length,
                      o->max_length);
  }
  return THR_OK;
}

/* THR_JOINT_TUBE: no cord turns back into its edge, and the turns tie the edges of every node together. */
static thr_status check_joints(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_err *err)
{
  if (o->joint != THR_JOINT_TUBE) return THR_OK;
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < thr_cord_turns(o, &cord[i]); k++)
      if (cord[i].half[(k + 1) % cord[i].n_passes] >> 1 == cord[i].half[k] >> 1)
        return thr_fail(err, THR_EVIOLATED, "cord %s, pass %d: turns back at node %d, which ties no tube joint", cord[i].id,
                        k + 1, thr_head(f, cord[i].half[k]));
  bool *tied = thr_calloc((size_t)f->n_nodes, sizeof *tied);
  thr_status st = tied ? thr_junction_tied(f, cord, n_cords, o->ends == THR_ENDS_CLOSED, tied, err) : thr_nomem(err);
  for (int v = 0; v < f->n_nodes && !st; v++)
    if (!tied[v])
      st = thr_fail(err, THR_EVIOLATED, "node %d: the cords do not tie its edges together, as the plan's tube joints need", v);
  free(tied);
  return st;
}

/* Counts the passes that the cords make. */
static thr_status check_cords(const thr_frame *f, const thr_plan_options *o, const int *component, const thr_cord *cord,
                              int n_cords, int *passes, thr_err *err)
{
  thr_status st;
  for (int i = 0; i < n_cords; i++) {
    const thr_cord *c = &cord[i];
    if ((st = check_walk(f, c, err))) return st;
    if ((st = check_ends(f, o, c, err))) return st;
    if (component[thr_cord_start(f, c)] != c->component)
      return thr_fail(err, THR_EVIOLATED, "cord %s: said to be in component %d, but runs in component %d", c->id, c->component,
                      component[thr_cord_start(f, c)]);
    for (int k = 0; k < c->n_passes; k++)
      passes[c->half[k] >> 1]++;
  }
  if ((st = check_cover(f, o, passes, err))) return st;
  if ((st = check_end_counts(f, o, cord, n_cords, err))) return st;
  if ((st = check_lengths(f, o, cord, n_cords, err))) return st;
  return check_joints(f, o, cord, n_cords, err);
}

static void walked_destroy(thr_check_walked *w)
{
  free(w->component);
  free(w->passes);
  *w = (thr_check_walked){0};
}

/* Without passes yet. On failure w is empty. */
static thr_status walked_init(thr_check_walked *w, const thr_frame *f, thr_err *err)
{
  *w = (thr_check_walked){.component = thr_calloc((size_t)f->n_nodes, sizeof *w->component),
                          .passes = thr_calloc((size_t)f->n_edges, sizeof *w->passes)};
  thr_status st = w->component && w->passes ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(f, w->component, &w->n_components, err);
  if (st) walked_destroy(w);
  return st;
}

/* The same from cords, which are checked on the way. */
static thr_status walked_from_cords(thr_check_walked *w, const thr_frame *f, const thr_plan_options *o, const thr_cord *cord,
                                    int n_cords, thr_err *err)
{
  thr_status st = walked_init(w, f, err);
  if (!st) st = check_cords(f, o, w->component, cord, n_cords, w->passes, err);
  if (st) walked_destroy(w);
  return st;
}

/* As many cords in every component as the options say; of a symmetric plan, in the one that has most. */
static thr_status check_cord_count(const thr_check_walked *w, const thr_plan_options *o, const thr_cord *cord, int n_cords,
                                   thr_err *err)
{
  int *count = thr_calloc((size_t)w->n_components, sizeof *count);
  thr_status st = count ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n_cords && !st; i++)
    count[cord[i].component]++;
  int first = 0, end = w->n_components, least = thr_wants_symmetry(o) ? o->cords : o->cords_least;
  for (int k = 0; k < w->n_components && !st && thr_wants_symmetry(o); k++) {
    if (count[k] > count[first]) first = k;
    end = first + 1;
  }
  for (int k = first; k < end && !st; k++) {
    const char *cords = count[k] == 1 ? "cord" : "cords";
    if (count[k] >= least && count[k] <= o->cords) continue;
    if (least == o->cords)
      st = thr_fail(err, THR_EVIOLATED, "component %d: has %d %s; the plan's options say %d", k, count[k], cords, least);
    else
      st = thr_fail(err, THR_EVIOLATED, "component %d: has %d %s; the plan's options say %d to %d", k, count[k], cords, least,
                    o->cords);
  }
  free(count);
  return st;
}

static double length_of(const thr_frame *f, const int *passes)
{
  double sum = 0;
  for (int e = 0; e < f->n_edges; e++)
    sum += passes[e] * f->length[e];
  return sum;
}

static double base_length_of(const thr_frame *f, const thr_plan_options *o)
{
  double sum = 0;
  for (int e = 0; e < f->n_edges; e++)
    sum += thr_plan_cover(f, o, e) * f->length[e];
  return sum;
}

/* What the verdicts prove of passes with this length. */
static void sum_verdicts(const thr_frame *f, const thr_plan_options *o, const thr_check_verdict *verdict, int n, double length,
                         bool *optimal, double *lower_bound)
{
  double extra = 0;
  *optimal = true;
  for (int i = 0; i < n; i++) {
    *optimal &= verdict[i].optimal;
    extra += verdict[i].extra;
  }
  *lower_bound = *optimal ? length : fmin(length, base_length_of(f, o) + extra);
}

/* Verifies the certificates for passes that were checked already. *verdict is for the caller to free; NULL on failure. */
static thr_status judge_certificates(const thr_frame *f, const thr_plan_options *o, const thr_check_walked *w,
                                     const thr_certificate *certificate, int n, thr_check_verdict **verdict, thr_err *err)
{
  *verdict = thr_calloc((size_t)w->n_components, sizeof **verdict);
  if (!*verdict) return thr_nomem(err);
  thr_status st = thr_check_certificates(f, o, w, certificate, n, *verdict, err);
  if (st) {
    free(*verdict);
    *verdict = NULL;
  }
  return st;
}

/* For passes of this length. */
static thr_status check_proof(const thr_frame *f, const thr_plan_options *o, const thr_check_walked *w, double length,
                              const thr_certificate *certificate, int n, bool *optimal, double *lower_bound, thr_err *err)
{
  thr_check_verdict *verdict;
  thr_status st = judge_certificates(f, o, w, certificate, n, &verdict, err);
  if (!st) sum_verdicts(f, o, verdict, n, length, optimal, lower_bound);
  free(verdict);
  return st;
}

thr_status thr_check_length_proof(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords,
                                  const thr_certificate *certificate, int n_certificates, bool *optimal, double *lower_bound,
                                  thr_err *err)
{
  thr_check_walked w;
  double length = 0;
  thr_status st = walked_from_cords(&w, f, o, cord, n_cords, err);
  if (!st) st = check_cord_count(&w, o, cord, n_cords, err);
  for (int i = 0; i < n_cords; i++)
    length += thr_cord_length(f, &cord[i]);
  if (!st) st = check_proof(f, o, &w, length, certificate, n_certificates, optimal, lower_bound, err);
  walked_destroy(&w);
  return st;
}

thr_status thr_check_cords(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords,
                           const thr_certificate *certificate, int n_certificates, thr_cords_claim *found, thr_err *err)
{
  thr_check_walked w;
  thr_check_verdict *verdict = NULL;
  *found = (thr_cords_claim){0};
  thr_status st = walked_from_cords(&w, f, o, cord, n_cords, err);
  if (!st) st = check_cord_count(&w, o, cord, n_cords, err);
  if (!st && certificate) st = judge_certificates(f, o, &w, certificate, n_certificates, &verdict, err);
  if (!st) st = thr_check_several(f, o, &w, cord, n_cords, certificate, verdict, NULL, found, err);
  free(verdict);
  walked_destroy(&w);
  return st;
}

thr_status thr_check_tied_cords(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords,
                                const thr_turning_proof *tied, thr_cords_claim *found, thr_err *err)
{
  thr_check_walked w;
  *found = (thr_cords_claim){0};
  thr_status st = walked_from_cords(&w, f, o, cord, n_cords, err);
  if (!st) st = check_cord_count(&w, o, cord, n_cords, err);
  if (!st) st = thr_check_several(f, o, &w, cord, n_cords, NULL, NULL, tied, found, err);
  walked_destroy(&w);
  return st;
}

/* Passes that cords can run through: every edge covered with room, and where they are odd in number a cord may end. */
static thr_status check_passes(const thr_frame *f, const thr_plan_options *o, const thr_check_walked *w, thr_err *err)
{
  int most = o->ends == THR_ENDS_CLOSED ? 0 : 2 * o->cords;
  thr_status st = check_cover(f, o, w->passes, err);
  int *odd = thr_calloc((size_t)w->n_components, sizeof *odd);
  if (!st && !odd) st = thr_nomem(err);
  for (int v = 0; v < f->n_nodes && !st; v++) {
    int sum = 0, ends = o->ends == THR_ENDS_COUNTS ? o->end_count[v] : 0;
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      sum += w->passes[f->half[i] >> 1];
    if (o->ends == THR_ENDS_COUNTS && (sum - ends) % 2)
      st = thr_fail(err, THR_EVIOLATED, "node %d: %d passes do not go with %d cord %s", v, sum, ends, ends == 1 ? "end" : "ends");
    else if (o->ends != THR_ENDS_COUNTS && sum % 2 && (!thr_plan_end_allowed(f, o, v) || ++odd[w->component[v]] > most))
      st = thr_fail(err, THR_EVIOLATED, "node %d: %d passes, an odd number, but no cord can end there", v, sum);
  }
  free(odd);
  return st;
}

thr_status thr_check_length_of_passes(const thr_frame *f, const thr_plan_options *o, const int *passes,
                                      const thr_certificate *certificate, int n_certificates, bool *optimal, double *lower_bound,
                                      thr_err *err)
{
  thr_check_walked w;
  thr_status st = walked_init(&w, f, err);
  if (st) return st;
  memcpy(w.passes, passes, (size_t)f->n_edges * sizeof *passes);
  st = check_passes(f, o, &w, err);
  if (!st) st = check_proof(f, o, &w, length_of(f, w.passes), certificate, n_certificates, optimal, lower_bound, err);
  walked_destroy(&w);
  return st;
}

/* ---- the whole plan ---- */

static thr_status metric(const char *name, double stated, double found, double whole, thr_err *err)
{
  if (thr_check_close(stated, found, whole)) return THR_OK;
  return thr_fail(err, THR_EVIOLATED, "metrics.%s: stated %.12g, but the cords give %.12g", name, stated, found);
}

/* Metrics from the cords alone; passes[n_edges] as check_cords counted them. */
static thr_metrics recompute(const thr_plan *p, const int *passes)
{
  const thr_frame *f = &p->frame;
  thr_metrics m = {0};
  for (int e = 0; e < f->n_edges; e++) {
    int cover = thr_plan_cover(f, &p->options, e);
    m.base_length += f->length[e] * cover;
    m.overlap += f->length[e] * (passes[e] - cover);
    m.length += f->length[e] * passes[e];
    m.passes += passes[e];
    if (passes[e] > m.most_passes) m.most_passes = passes[e];
  }
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    double turning = 0;
    for (int k = p->options.ends == THR_ENDS_CLOSED ? 0 : 1; k < c->n_passes; k++) {
      int in = c->half[k ? k - 1 : c->n_passes - 1], out = c->half[k];
      double angle = thr_check_angle(f, in, out);
      turning += angle;
      m.worst_turn = fmax(m.worst_turn, angle);
      m.u_turns += in >> 1 == out >> 1;
    }
    m.turning += turning;
    m.max_turning = fmax(m.max_turning, turning);
  }
  return m;
}

static thr_status check_metrics(const thr_plan *p, const int *passes, thr_err *err)
{
  thr_metrics m = recompute(p, passes);
  const thr_metrics *s = &p->metrics;
  thr_status st;
  if ((st = metric("length", s->length, m.length, m.length, err))) return st;
  if ((st = metric("base_length", s->base_length, m.base_length, m.length, err))) return st;
  if ((st = metric("overlap", s->overlap, m.overlap, m.length, err))) return st;
  if ((st = metric("passes", s->passes, m.passes, 0, err))) return st;
  if ((st = metric("most_passes", s->most_passes, m.most_passes, 0, err))) return st;
  if ((st = metric("turning", s->turning, m.turning, 1 + m.turning, err))) return st;
  if ((st = metric("max_turning", s->max_turning, m.max_turning, 1 + m.turning, err))) return st;
  if ((st = metric("worst_turn", s->worst_turn, m.worst_turn, 1 + m.turning, err))) return st;
  return metric("u_turns", s->u_turns, m.u_turns, 0, err);
}

/* *proved: no cords with these options are shorter. */
static thr_status check_length_claim(const thr_plan *p, const thr_check_walked *w, const thr_check_verdict *verdict,
                                     double *proved, thr_err *err)
{
  bool optimal;
  double lower_bound, length = length_of(&p->frame, w->passes);
  const thr_length_proof *claim = &p->proof;
  if (p->options.joint == THR_JOINT_TUBE) {
    thr_status st = thr_tied_least(&p->frame, &p->options, &claim->tied, &lower_bound, err);
    if (st) return st;
    if (lower_bound > length && !thr_check_close(lower_bound, length, length))
      return thr_fail(err, THR_EVIOLATED, "proof.length: the tree proves %.12g, which is more than the length %.12g", lower_bound,
                      length);
    optimal = thr_check_close(lower_bound, length, length);
  } else {
    sum_verdicts(&p->frame, &p->options, verdict, w->n_components, length, &optimal, &lower_bound);
  }
  *proved = lower_bound;
  if (!claim->slack_open && !thr_plan_within_slack(&p->options, length, lower_bound))
    return thr_fail(err, THR_EVIOLATED,
                    "options.turning.length_slack: at most %.12g above the least length, but the cords are %.12g long and only "
                    "%.12g is proved",
                    p->options.turning.length_slack, length, lower_bound);
  if (claim->optimal && !optimal)
    return thr_fail(err, THR_EVIOLATED, "proof.length: says optimal, but the certificate only proves %.12g of %.12g", lower_bound,
                    p->metrics.length);
  if (claim->optimal && !thr_check_close(claim->lower_bound, p->metrics.length, p->metrics.length))
    return thr_fail(err, THR_EVIOLATED, "proof.length: says optimal, but its lower bound %.12g is not the length %.12g",
                    claim->lower_bound, p->metrics.length);
  if (claim->lower_bound > lower_bound && !thr_check_close(claim->lower_bound, lower_bound, lower_bound))
    return thr_fail(err, THR_EVIOLATED, "proof.length.lower_bound: stated %.12g, but the certificate proves %.12g",
                    claim->lower_bound, lower_bound);
  if (!thr_check_close(claim->gap, (p->metrics.length - claim->lower_bound) / p->metrics.length, 1))
    return thr_fail(err, THR_EVIOLATED, "proof.length.gap: stated %.12g, but length and lower bound give %.12g", claim->gap,
                    (p->metrics.length - claim->lower_bound) / p->metrics.length);
  return THR_OK;
}

static thr_status check_cords_claim(const thr_plan *p, const thr_check_walked *w, const thr_check_verdict *verdict, thr_err *err)
{
  const thr_cords_claim *claim = &p->cords_claim;
  thr_cords_claim found;
  const thr_turning_proof *tied = p->options.joint == THR_JOINT_TUBE && p->proof.present ? &p->proof.tied : NULL;
  thr_status st =
      thr_check_several(&p->frame, &p->options, w, p->cord, p->n_cords, p->proof.certificate, verdict, tied, &found, err);
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
  if (claim->fewest_optimal && (claim->fewest != p->n_cords || claim->fewest == 0))
    return thr_fail(err, THR_EVIOLATED, "proof.cords.fewest: says optimal, but there are %d cords and its bound is %d",
                    p->n_cords, claim->fewest);
  return THR_OK;
}

/* *proved: as for check_length_claim; left alone without one. */
static thr_status check_claims(const thr_plan *p, const thr_check_walked *w, double *proved, thr_err *err)
{
  thr_check_verdict *verdict = NULL;
  thr_status st = THR_OK;
  if (p->proof.present && (p->options.joint == THR_JOINT_TUBE) != (p->proof.tied.n_nodes > 0))
    return thr_fail(err, THR_EVIOLATED, "proof.length: has a %s, but the plan's joints are %s",
                    p->proof.tied.n_nodes > 0 ? "proof" : "certificate", thr_joint_name(p->options.joint));
  if (p->proof.present && p->options.joint == THR_JOINT_SOLID)
    st = judge_certificates(&p->frame, &p->options, w, p->proof.certificate, p->proof.n_certificates, &verdict, err);
  if (!st && p->proof.present) st = check_length_claim(p, w, verdict, proved, err);
  if (!st && p->cords_claim.present) st = check_cords_claim(p, w, verdict, err);
  free(verdict);
  return st;
}

static thr_status check_names(const thr_plan *p, thr_err *err)
{
  for (int i = 0; i < p->n_cords; i++) {
    char id[12];
    thr_cord_id(i, id);
    if (strcmp(p->cord[i].id, id) != 0)
      return thr_fail(err, THR_EVIOLATED, "cord number %d is called %s; expected %s", i + 1, p->cord[i].id, id);
  }
  return THR_OK;
}

thr_status thr_check_own(thr_status st, const thr_err *found, thr_err *err)
{
  if (st == THR_EVIOLATED) return thr_fail(err, THR_ESOLVER, "the plan does not pass its own check: %s", found->text);
  return st ? thr_fail(err, st, "%s", found->text) : THR_OK;
}

thr_status thr_check_plan(const thr_plan *p, thr_err *err)
{
  thr_check_walked w;
  double least_length = 0;
  thr_status st = check_names(p, err);
  if (st) return st;
  if ((st = walked_from_cords(&w, &p->frame, &p->options, p->cord, p->n_cords, err))) return st;
  if (p->proof.present || p->cords_claim.present || !thr_wants_length(&p->options))
    st = check_cord_count(&w, &p->options, p->cord, p->n_cords, err);
  if (!st) st = check_metrics(p, w.passes, err);
  if (!st && p->symmetry.present) st = thr_check_symmetry(p, err);
  if (!st) st = check_claims(p, &w, &least_length, err);
  if (!st && p->turning.present) st = thr_check_turning_claim(p, least_length, err);
  if (!st && p->evaluation.present) st = thr_check_evaluation(p, err);
  walked_destroy(&w);
  return st;
}
