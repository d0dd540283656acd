/* The checker. Nothing here trusts what a plan says about itself. With the code that makes plans it shares the framework, the
 * readers, and the one line that defines the weights (thr_certificate_weight). */
#include "graph/check_parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef __int128 wide; /* sums of hostile 64-bit multipliers cannot overflow it */

bool thr_check_close(double a, double b, double whole)
{
  return fabs(a - b) <= 1e-9 * whole;
}

double thr_check_angle(const thr_frame *f, int in, int out)
{
  double unit[2][3], sum = 0, difference = 0;
  for (int k = 0; k < 2; k++) {
    int h = k ? out : in;
    const double *from = f->xyz[thr_tail(f, h)], *to = f->xyz[thr_head(f, h)];
    double size = hypot(hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]);
    for (int i = 0; i < 3; i++)
      unit[k][i] = (to[i] - from[i]) / size;
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

static thr_status check_cover(const thr_frame *f, const thr_plan_options *o, const int *passes, thr_err *err)
{
  for (int e = 0; e < f->n_edges; e++)
    if (passes[e] < o->cover)
      return thr_fail(err, THR_EVIOLATED, "edge %d (nodes %d and %d): %d of %d passes", e, f->edge[e][0], f->edge[e][1],
                      passes[e], o->cover);
  return THR_OK;
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
  return check_cover(f, o, passes, err);
}

/* ---- one certificate ---- */

/* What it proves about the extra cord of its component. */
typedef struct {
  bool optimal;       /* the component's extra passes are a shortest join */
  double extra_bound; /* no plan has less extra cord in this component, in units of length */
} verdict;

int64_t thr_certificate_weight(const thr_frame *f, const thr_certificate *c, int e)
{
  return (int64_t)nearbyint(f->length[e] * c->scale);
}

/* Work space over framework and slots, all zero between certificates. */
typedef struct {
  const thr_frame *f;
  const thr_plan_options *o;
  const int *component;
  int *start, *node;      /* nodes of component k: node[start[k] .. start[k + 1] - 1] */
  int *edge_start, *edge; /* its edges likewise */
  const thr_certificate *c;
  wide *load;      /* [n_edges] */
  wide *held;      /* [n_nodes + 2 * cords] sum of the values of the sets that hold a node or slot */
  wide *held_both; /* [n_nodes + 2 * cords] of those that hold one slot as well, see check_slot */
  bool *member;    /* [n_nodes + 2 * cords] */
} certificate_check;

static bool is_odd(const certificate_check *k, int v)
{
  if (v >= k->f->n_nodes) return true; /* a slot */
  return (k->o->cover * thr_degree(k->f, v)) % 2 != 0;
}

static thr_status check_set(certificate_check *k, int i, thr_err *err)
{
  const thr_certificate *c = k->c;
  const thr_cut *cut = &c->cut[i];
  bool odd = false;
  if (cut->value < 0)
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d, cut %d: multiplier %" PRId64 " is negative", c->component,
                    i, cut->value);
  for (int j = 0; j < cut->n_nodes; j++) {
    int v = cut->node[j];
    if (j > 0 && v <= cut->node[j - 1])
      return thr_fail(err, THR_EVIOLATED, "certificate of component %d, cut %d: nodes are not ascending at %d", c->component, i,
                      v);
    if (v < k->f->n_nodes && k->component[v] != c->component)
      return thr_fail(err, THR_EVIOLATED, "certificate of component %d, cut %d: node %d is in component %d", c->component, i, v,
                      k->component[v]);
    odd ^= is_odd(k, v);
  }
  if (!odd)
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d, cut %d: holds an even number of odd nodes", c->component,
                    i);
  return THR_OK;
}

/* Adds the multiplier of a cut to the edges of the framework that leave its set, and to what its members count for check_slot. */
static void load_set(certificate_check *k, const thr_cut *cut)
{
  int n = k->f->n_nodes;
  for (int j = 0; j < cut->n_nodes; j++) {
    k->member[cut->node[j]] = true;
    k->held[cut->node[j]] += cut->value;
  }
  for (int j = 0; j < cut->n_nodes && cut->node[j] < n; j++) {
    int v = cut->node[j];
    for (int i = k->f->first[v]; i < k->f->first[v + 1]; i++)
      if (!k->member[thr_head(k->f, k->f->half[i])]) k->load[k->f->half[i] >> 1] += cut->value;
  }
  for (int j = 0; j < cut->n_nodes; j++)
    k->member[cut->node[j]] = false;
}

static thr_status overloaded(const certificate_check *k, const char *what, int at, thr_err *err)
{
  return thr_fail(err, THR_EVIOLATED, "certificate of component %d: the cuts over %s %d add up to more than its weight",
                  k->c->component, what, at);
}

static bool holds_slot(const thr_cut *cut, int slot)
{
  int j = cut->n_nodes; /* slots come last */
  while (j > 0 && cut->node[j - 1] > slot)
    j--;
  return j > 0 && cut->node[j - 1] == slot;
}

/* The edge between a slot and a node (or another slot) is loaded by the sets that hold one of them: all that hold the one and all
 * that hold the other, less twice those that hold both. */
static thr_status check_slot(certificate_check *k, int slot, thr_err *err)
{
  const thr_certificate *c = k->c;
  const thr_frame *f = k->f;
  const wide most = (wide)c->slot_cost * c->denominator;
  thr_status st = THR_OK;
  for (int pass = 0; pass < 2; pass++) { /* the second one clears */
    for (int i = 0; i < c->n_cuts && k->held[slot] > 0; i++) {
      const thr_cut *cut = &c->cut[i];
      if (!holds_slot(cut, slot)) continue;
      for (int j = 0; j < cut->n_nodes; j++)
        k->held_both[cut->node[j]] += pass ? -cut->value : cut->value;
    }
    if (pass) break;
    for (int j = k->start[c->component]; j < k->start[c->component + 1] && !st; j++) {
      int v = k->node[j];
      if (thr_plan_end_allowed(f, k->o, v) && k->held[slot] + k->held[v] - 2 * k->held_both[v] > most)
        st = overloaded(k, "the slot edge at node", v, err);
    }
    for (int other = f->n_nodes; other < f->n_nodes + c->n_slots && !st; other++)
      if (other != slot && k->held[slot] + k->held[other] - 2 * k->held_both[other] > 2 * most)
        st = overloaded(k, "an edge between the slots of component", c->component, err);
  }
  return st;
}

static thr_status check_loads(certificate_check *k, thr_err *err)
{
  const thr_certificate *c = k->c;
  thr_status st = THR_OK;
  bool idle = false; /* has a slot that no set of positive value holds been checked? They are all alike */
  for (int j = k->edge_start[c->component]; j < k->edge_start[c->component + 1]; j++) {
    int e = k->edge[j];
    if (k->load[e] > (wide)thr_certificate_weight(k->f, c, e) * c->denominator) return overloaded(k, "edge", e, err);
  }
  for (int slot = k->f->n_nodes; slot < k->f->n_nodes + c->n_slots && !st; slot++) {
    if (k->held[slot] == 0 && idle) continue;
    idle |= k->held[slot] == 0;
    st = check_slot(k, slot, err);
  }
  return st;
}

static void clear(certificate_check *k)
{
  int c = k->c->component;
  for (int j = k->edge_start[c]; j < k->edge_start[c + 1]; j++)
    k->load[k->edge[j]] = 0;
  for (int j = k->start[c]; j < k->start[c + 1]; j++)
    k->held[k->node[j]] = 0;
  memset(k->held + k->f->n_nodes, 0, 2 * (size_t)k->o->cords * sizeof *k->held);
}

/* Compares the stated sums with the true ones, and says what they prove. */
static thr_status judge(const certificate_check *k, wide sum, const int *passes, verdict *out, thr_err *err)
{
  const thr_certificate *c = k->c;
  bool extra = false, weightless = false; /* a scale may round what passes cost to nothing */
  wide join = 0, slots = (wide)c->n_slots * c->slot_cost;
  double rounding = 0, total = 0;
  for (int j = k->edge_start[c->component]; j < k->edge_start[c->component + 1]; j++) {
    int e = k->edge[j];
    int64_t w = thr_certificate_weight(k->f, c, e);
    join += (wide)w * (passes[e] - k->o->cover);
    extra |= passes[e] > k->o->cover;
    weightless |= passes[e] > k->o->cover && w == 0;
    rounding += fabs(k->f->length[e] - (double)w / c->scale) * fmax(1, passes[e] - k->o->cover);
    total += k->f->length[e];
  }
  if (sum != c->sum)
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d: the multipliers do not add up to the stated sum %" PRId64,
                    c->component, c->sum);
  if (join != c->join)
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d: the extra passes do not weigh the stated %" PRId64,
                    c->component, c->join);
  /* Cords are a T-join of weight join + slots, and weights are integers: nothing fits between the bound and the next one. */
  wide least = (sum + c->denominator - 1) / c->denominator - slots;
  double bound = (double)least / c->scale - rounding;
  out->extra_bound = bound > 0 ? bound : 0;
  out->optimal = !extra || (!weightless && sum > (join + slots - 1) * c->denominator && rounding <= 1e-9 * total);
  return THR_OK;
}

static thr_status check_numbers(const certificate_check *k, thr_err *err)
{
  const thr_certificate *c = k->c;
  if (!(c->scale > 0) || c->denominator < 1)
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d: scale and denominator must be positive", c->component);
  for (int j = k->edge_start[c->component]; j < k->edge_start[c->component + 1]; j++) {
    int e = k->edge[j];
    if (!(k->f->length[e] * c->scale < 1e18))
      return thr_fail(err, THR_EVIOLATED, "certificate of component %d: scale is too large for edge %d", c->component, e);
  }
  if (c->n_slots != (k->o->ends == THR_ENDS_CLOSED ? 0 : 2 * k->o->cords))
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d: %d slots do not fit ends %s and %d %s", c->component,
                    c->n_slots, thr_ends_name(k->o->ends), k->o->cords, k->o->cords == 1 ? "cord" : "cords");
  return THR_OK;
}

static thr_status run_certificate(certificate_check *k, const int *passes, verdict *out, thr_err *err)
{
  const thr_certificate *c = k->c;
  wide sum = 0;
  thr_status st = check_numbers(k, err);
  if (st) return st;
  for (int i = 0; i < c->n_cuts && !st; i++) {
    if ((st = check_set(k, i, err))) break;
    load_set(k, &c->cut[i]);
    sum += c->cut[i].value;
  }
  if (!st) st = check_loads(k, err);
  if (!st) st = judge(k, sum, passes, out, err);
  clear(k);
  return st;
}

static void certificate_check_destroy(certificate_check *k)
{
  free(k->start);
  free(k->node);
  free(k->edge_start);
  free(k->edge);
  free(k->load);
  free(k->held);
  free(k->held_both);
  free(k->member);
  *k = (certificate_check){0};
}

/* Groups nodes and edges by component: counting sort, shifted by one place so that filling leaves the starts right. */
static void group(certificate_check *k)
{
  const thr_frame *f = k->f;
  for (int v = 0; v < f->n_nodes; v++)
    k->start[k->component[v] + 2]++;
  for (int e = 0; e < f->n_edges; e++)
    k->edge_start[k->component[f->edge[e][0]] + 2]++;
  for (int i = 1; i <= f->n_nodes; i++) {
    k->start[i + 1] += k->start[i];
    k->edge_start[i + 1] += k->edge_start[i];
  }
  for (int v = 0; v < f->n_nodes; v++)
    k->node[k->start[k->component[v] + 1]++] = v;
  for (int e = 0; e < f->n_edges; e++)
    k->edge[k->edge_start[k->component[f->edge[e][0]] + 1]++] = e;
}

static thr_status certificate_check_init(certificate_check *k, const thr_frame *f, const thr_plan_options *o,
                                         const int *component, thr_err *err)
{
  size_t n = (size_t)f->n_nodes, m = (size_t)f->n_edges, all = n + 2 * (size_t)o->cords;
  *k = (certificate_check){.f = f, .o = o, .component = component};
  k->start = thr_calloc(n + 2, sizeof *k->start);
  k->node = thr_calloc(n, sizeof *k->node);
  k->edge_start = thr_calloc(n + 2, sizeof *k->edge_start);
  k->edge = thr_calloc(m, sizeof *k->edge);
  k->load = thr_calloc(m, sizeof *k->load);
  k->held = thr_calloc(all, sizeof *k->held);
  k->held_both = thr_calloc(all, sizeof *k->held_both);
  k->member = thr_calloc(all, sizeof *k->member);
  if (!k->start || !k->node || !k->edge_start || !k->edge || !k->load || !k->held || !k->held_both || !k->member) {
    certificate_check_destroy(k);
    return thr_nomem(err);
  }
  group(k);
  return THR_OK;
}

/* ---- the whole proof ---- */

static thr_status sum_verdicts(certificate_check *k, const int *passes, const thr_certificate *certificate, int n, bool *optimal,
                               double *extra, thr_err *err)
{
  *optimal = true;
  *extra = 0;
  for (int i = 0; i < n; i++) {
    verdict v = {0};
    if (certificate[i].component != i)
      return thr_fail(err, THR_EVIOLATED, "certificate %d is for component %d; expected one per component in order", i,
                      certificate[i].component);
    k->c = &certificate[i];
    thr_status st = run_certificate(k, passes, &v, err);
    if (st) return st;
    *optimal &= v.optimal;
    *extra += v.extra_bound;
  }
  return THR_OK;
}

/* Cords and their components, worked out once for everything that is checked. */
typedef struct {
  int n_components;
  int *component; /* [n_nodes] */
  int *passes;    /* [n_edges] */
} walked;

static void walked_destroy(walked *w)
{
  free(w->component);
  free(w->passes);
  *w = (walked){0};
}

/* Without passes yet. On failure w is empty. */
static thr_status walked_init(walked *w, const thr_frame *f, thr_err *err)
{
  *w = (walked){.component = thr_calloc((size_t)f->n_nodes, sizeof *w->component),
                .passes = thr_calloc((size_t)f->n_edges, sizeof *w->passes)};
  thr_status st = w->component && w->passes ? THR_OK : thr_nomem(err);
  if (!st) st = thr_frame_components(f, w->component, &w->n_components, err);
  if (st) walked_destroy(w);
  return st;
}

/* The same from cords, which are checked on the way. */
static thr_status walked_from_cords(walked *w, const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords,
                                    thr_err *err)
{
  thr_status st = walked_init(w, f, err);
  if (!st) st = check_cords(f, o, w->component, cord, n_cords, w->passes, err);
  if (st) walked_destroy(w);
  return st;
}

/* As many cords in every component as the options say; of a symmetric plan, in the one that has most. */
static thr_status check_cord_count(const walked *w, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_err *err)
{
  int *count = thr_calloc((size_t)w->n_components, sizeof *count);
  thr_status st = count ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n_cords && !st; i++)
    count[cord[i].component]++;
  int first = 0, end = w->n_components;
  for (int k = 0; k < w->n_components && !st && o->objective == THR_SYMMETRY; k++) {
    if (count[k] > count[first]) first = k;
    end = first + 1;
  }
  for (int k = first; k < end && !st; k++)
    if (count[k] != o->cords)
      st = thr_fail(err, THR_EVIOLATED, "component %d: has %d %s; the plan's options say %d", k, count[k],
                    count[k] == 1 ? "cord" : "cords", o->cords);
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

/* Verifies the certificates for passes that were checked already and have this length. */
static thr_status check_proof(const thr_frame *f, const thr_plan_options *o, const walked *w, double length,
                              const thr_certificate *certificate, int n_certificates, bool *optimal, double *lower_bound,
                              thr_err *err)
{
  certificate_check k;
  double extra = 0;
  if (n_certificates != w->n_components)
    return thr_fail(err, THR_EVIOLATED, "%d certificates for %d components; expected one per component", n_certificates,
                    w->n_components);
  thr_status st = certificate_check_init(&k, f, o, w->component, err);
  if (!st) st = sum_verdicts(&k, w->passes, certificate, n_certificates, optimal, &extra, err);
  certificate_check_destroy(&k);
  if (st) return st;
  *lower_bound = *optimal ? length : fmin(length, o->cover * thr_frame_total_length(f) + extra);
  return THR_OK;
}

thr_status thr_check_length_proof(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords,
                                  const thr_certificate *certificate, int n_certificates, bool *optimal, double *lower_bound,
                                  thr_err *err)
{
  walked w;
  double length = 0;
  thr_status st = walked_from_cords(&w, f, o, cord, n_cords, err);
  if (!st) st = check_cord_count(&w, o, cord, n_cords, err);
  for (int i = 0; i < n_cords && !st; i++)
    length += thr_cord_length(f, &cord[i]);
  if (!st) st = check_proof(f, o, &w, length, certificate, n_certificates, optimal, lower_bound, err);
  walked_destroy(&w);
  return st;
}

/* Passes that cords can run through: every edge covered, and where they are odd in number a cord may end. */
static thr_status check_passes(const thr_frame *f, const thr_plan_options *o, const walked *w, thr_err *err)
{
  int most = o->ends == THR_ENDS_CLOSED ? 0 : 2 * o->cords;
  thr_status st = check_cover(f, o, w->passes, err);
  int *odd = thr_calloc((size_t)w->n_components, sizeof *odd);
  if (!st && !odd) st = thr_nomem(err);
  for (int v = 0; v < f->n_nodes && !st; v++) {
    int sum = 0;
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      sum += w->passes[f->half[i] >> 1];
    if (sum % 2 && (!thr_plan_end_allowed(f, o, v) || ++odd[w->component[v]] > most))
      st = thr_fail(err, THR_EVIOLATED, "node %d: %d passes, an odd number, but no cord can end there", v, sum);
  }
  free(odd);
  return st;
}

thr_status thr_check_length_of_passes(const thr_frame *f, const thr_plan_options *o, const int *passes,
                                      const thr_certificate *certificate, int n_certificates, bool *optimal, double *lower_bound,
                                      thr_err *err)
{
  walked w;
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
    m.base_length += f->length[e] * p->options.cover;
    m.overlap += f->length[e] * (passes[e] - p->options.cover);
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
static thr_status check_claim(const thr_plan *p, const walked *w, double *proved, thr_err *err)
{
  bool optimal = false;
  double lower_bound = 0;
  const thr_length_proof *claim = &p->proof;
  thr_status st = check_proof(&p->frame, &p->options, w, length_of(&p->frame, w->passes), claim->certificate,
                              claim->n_certificates, &optimal, &lower_bound, err);
  if (st) return st;
  *proved = lower_bound;
  if (claim->optimal && !optimal)
    return thr_fail(err, THR_EVIOLATED, "proof.length: says optimal, but the certificate only proves %.12g of %.12g", lower_bound,
                    p->metrics.length);
  if (claim->optimal && !thr_check_close(claim->lower_bound, p->metrics.length, p->metrics.length))
    return thr_fail(err, THR_EVIOLATED, "proof.length: says optimal, but its lower bound %.12g is not the length %.12g",
                    claim->lower_bound, p->metrics.length);
  if (claim->lower_bound > lower_bound && !thr_check_close(claim->lower_bound, lower_bound, p->metrics.length))
    return thr_fail(err, THR_EVIOLATED, "proof.length.lower_bound: stated %.12g, but the certificate proves %.12g",
                    claim->lower_bound, lower_bound);
  if (!thr_check_close(claim->gap, (p->metrics.length - claim->lower_bound) / p->metrics.length, 1))
    return thr_fail(err, THR_EVIOLATED, "proof.length.gap: stated %.12g, but length and lower bound give %.12g", claim->gap,
                    (p->metrics.length - claim->lower_bound) / p->metrics.length);
  return THR_OK;
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

thr_status thr_check_plan(const thr_plan *p, thr_err *err)
{
  walked w;
  double least_length = 0;
  thr_status st = check_names(p, err);
  if (st) return st;
  if ((st = walked_from_cords(&w, &p->frame, &p->options, p->cord, p->n_cords, err))) return st;
  if (p->proof.present || p->options.objective != THR_LENGTH) st = check_cord_count(&w, &p->options, p->cord, p->n_cords, err);
  if (!st) st = check_metrics(p, w.passes, err);
  if (!st && p->symmetry.present) st = thr_check_symmetry(p, err);
  if (!st && p->proof.present) st = check_claim(p, &w, &least_length, err);
  if (!st && p->turning.present) st = thr_check_turning_claim(p, least_length, err);
  if (!st && p->evaluation.present) st = thr_check_evaluation(p, err);
  walked_destroy(&w);
  return st;
}
