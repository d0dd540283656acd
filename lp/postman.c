/* Framework -> T-join problem per component -> multiplicities -> ends -> cords -> plan. */
#include "lp/postman.h"
#include "graph/check.h"
#include "graph/tour.h"
#include "lp/endjoin.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sum of the integer weights of a component with n edges: 2^44 to 2^45, and at least 2^30 an edge, so that all roundings together
 * stay below 1e-9 of the sum; at most 2^49, so that sums of multipliers fit 64 bits. */
static double weight_sum(int n)
{
  return fmin(fmax(35184372088832.0, 2147483648.0 * n), 562949953421312.0);
}

typedef struct {
  const thr_frame *f;
  const thr_plan_options *o;
  const thr_limits *limits;
  int n_components;
  int *component;               /* [n_nodes] */
  int *start, *node;            /* nodes of component k: node[start[k] .. start[k + 1] - 1] */
  int *local;                   /* [n_nodes] position within the component */
  int *passes;                  /* [n_edges] result */
  thr_certificate *certificate; /* [n_components] result */
} postman;

/* The T-join problem of one component; its edges are the component's, then the slots'. */
typedef struct {
  int n_nodes, n_edges, n_own; /* n_own: edges of the framework */
  int n_slots;                 /* last of the nodes: 0 or 2 */
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
  int *frame_edge; /* [n_own] */
} instance;

static void instance_destroy(instance *in)
{
  free(in->edge);
  free(in->weight);
  free(in->odd);
  free(in->frame_edge);
  *in = (instance){0};
}

/* Greatest length that all lengths are whole multiples of, as far as Euclid's algorithm can tell; remainders far below the
 * shortest length count as none. */
static double common_measure(const thr_frame *f, const instance *in)
{
  double measure = f->length[in->frame_edge[0]], shortest = measure;
  for (int i = 1; i < in->n_own; i++)
    shortest = fmin(shortest, f->length[in->frame_edge[i]]);
  for (int i = 1; i < in->n_own; i++)
    for (double a = f->length[in->frame_edge[i]], b = measure; b > 0;) {
      double r = fmod(a, b);
      if (r < 1e-6 * shortest || b - r < 1e-6 * shortest) r = 0;
      measure = a = b;
      b = r;
    }
  return measure;
}

/* A scale under which lengths round to integers. If the lengths have a common measure (all beads equal: the normal case; or
 * whole millimetres), it is the unit: then ties are exact and weights small. Otherwise a power of 2 that gives the weights
 * their sum: powers of 2 keep exact what is exact. */
static double choose_scale(const thr_frame *f, const instance *in)
{
  double sum = 0, units = 0, measure = common_measure(f, in), most = weight_sum(in->n_own);
  for (int i = 0; i < in->n_own; i++) {
    sum += f->length[in->frame_edge[i]];
    units += nearbyint(f->length[in->frame_edge[i]] / measure);
  }
  double finest = exp2(floor(log2(most / sum))), scale = units / sum;
  if (units > most) return finest;
  for (int i = 0; i < in->n_own; i++) {
    double length = f->length[in->frame_edge[i]];
    if (fabs(length - nearbyint(length * scale) / scale) > 1e-12 * length) return finest;
  }
  return scale;
}

static thr_status instance_allocate(instance *in, int n_end_nodes, thr_err *err)
{
  in->n_edges = in->n_own + (in->n_slots ? 1 + in->n_slots * n_end_nodes : 0);
  in->n_nodes += in->n_slots;
  in->edge = thr_calloc((size_t)in->n_edges, sizeof *in->edge);
  in->weight = thr_calloc((size_t)in->n_edges, sizeof *in->weight);
  in->odd = thr_calloc((size_t)in->n_nodes, sizeof *in->odd);
  in->frame_edge = thr_calloc((size_t)in->n_own, sizeof *in->frame_edge);
  return in->edge && in->weight && in->odd && in->frame_edge ? THR_OK : thr_nomem(err);
}

/* No two nodes of the component are further apart than twice this: the longest path from its first node in a
 * breadth-first tree. in->odd serves as the mark of visited nodes and is cleared again. */
static thr_status radius(const postman *m, int k, instance *in, int64_t *longest, thr_err *err)
{
  int first = m->start[k], n = m->start[k + 1] - first, tail = 0;
  int *queue = thr_calloc((size_t)n, sizeof *queue);
  int64_t *far = thr_calloc((size_t)n, sizeof *far);
  *longest = 0;
  if (queue && far) queue[tail++] = 0, in->odd[0] = true;
  for (int at = 0; at < tail; at++) {
    int v = m->node[first + queue[at]];
    for (int i = m->f->first[v]; i < m->f->first[v + 1]; i++) {
      int h = m->f->half[i], w = m->local[thr_head(m->f, h)];
      if (in->odd[w]) continue;
      in->odd[w] = true;
      queue[tail++] = w;
      far[w] = far[queue[at]] + thr_certificate_weight(m->f, &m->certificate[k], h >> 1);
      if (far[w] > *longest) *longest = far[w];
    }
  }
  memset(in->odd, 0, (size_t)n * sizeof *in->odd);
  thr_status st = queue && far ? THR_OK : thr_nomem(err);
  free(queue);
  free(far);
  return st;
}

/* Two more odd nodes, the slots, stand for the ends of one cord (docs/method.md). A path over a slot costs 2 * slot_cost, more
 * than any path inside the component, so in a shortest join each slot has one edge. */
static void add_slots(const postman *m, int k, instance *in, int64_t slot_cost)
{
  int slot = in->n_nodes - 2, n = in->n_own;
  in->odd[slot] = in->odd[slot + 1] = true;
  for (int j = m->start[k]; j < m->start[k + 1]; j++) {
    if (!thr_plan_end_allowed(m->f, m->o, m->node[j])) continue;
    for (int i = 0; i < 2; i++) {
      in->edge[n][0] = j - m->start[k];
      in->edge[n][1] = slot + i;
      in->weight[n++] = slot_cost;
    }
  }
  in->edge[n][0] = slot;
  in->edge[n][1] = slot + 1;
  in->weight[n] = 2 * slot_cost;
}

static void fill_own_edges(const postman *m, int k, instance *in)
{
  int n = 0;
  for (int j = m->start[k]; j < m->start[k + 1]; j++)
    for (int v = m->node[j], i = m->f->first[v]; i < m->f->first[v + 1]; i++) {
      int h = m->f->half[i];
      if (h % 2) continue; /* each edge once, from its first node */
      in->frame_edge[n] = h / 2;
      in->edge[n][0] = m->local[v];
      in->edge[n++][1] = m->local[thr_head(m->f, h)];
    }
}

static thr_status instance_init(const postman *m, int k, instance *in, thr_certificate *c, thr_err *err)
{
  const thr_frame *f = m->f;
  int degrees = 0, n_end_nodes = 0;
  c->component = k;
  c->denominator = THR_DUAL_DENOMINATOR;
  c->n_slots = m->o->ends == THR_ENDS_CLOSED ? 0 : 2 * m->o->cords;
  in->n_nodes = m->start[k + 1] - m->start[k];
  in->n_slots = c->n_slots == 2 ? 2 : 0;
  for (int j = m->start[k]; j < m->start[k + 1]; j++) {
    degrees += thr_degree(f, m->node[j]);
    n_end_nodes += thr_plan_end_allowed(f, m->o, m->node[j]);
  }
  in->n_own = degrees / 2;
  if (n_end_nodes == 0)
    return thr_fail(err, THR_EINFEASIBLE,
                    "piece %d (the one with node %s) has no node where a cord may end; name one with --feet (try --feet lowest) "
                    "or --ends, or use --ends closed",
                    k + 1, f->name[m->node[m->start[k]]]);
  thr_status st = instance_allocate(in, n_end_nodes, err);
  if (st) return st;
  fill_own_edges(m, k, in);
  c->scale = choose_scale(f, in);
  for (int i = 0; i < in->n_own; i++)
    in->weight[i] = thr_certificate_weight(f, c, in->frame_edge[i]);
  if (c->n_slots) {
    if ((st = radius(m, k, in, &c->slot_cost, err))) return st;
    c->slot_cost++;
    if (in->n_slots) add_slots(m, k, in, c->slot_cost);
  }
  for (int j = m->start[k]; j < m->start[k + 1]; j++)
    in->odd[m->local[m->node[j]]] = m->o->cover * thr_degree(f, m->node[j]) % 2 != 0;
  return THR_OK;
}

/* Reads passes and certificate of component k off the join. */
static void take_result(postman *m, int k, const instance *in, thr_tjoin *t)
{
  thr_certificate *c = &m->certificate[k];
  assert(t->in_join);
  for (int i = 0; i < in->n_own; i++)
    if (t->in_join[i]) {
      m->passes[in->frame_edge[i]]++;
      c->join += in->weight[i];
    }
  c->sum = t->sum;
  c->n_cuts = t->n_cuts;
  c->cut = t->cut;
  t->cut = NULL;
  t->n_cuts = 0;
  for (int i = 0; i < c->n_cuts; i++)
    for (int j = 0; j < c->cut[i].n_nodes; j++) {
      int v = c->cut[i].node[j], own = in->n_nodes - in->n_slots; /* nodes ascend within a component: still sorted */
      c->cut[i].node[j] = v < own ? m->node[m->start[k] + v] : m->f->n_nodes + v - own;
    }
}

/* The cuts of each slot alone, as in->n_nodes and on: they make up for a price of an end that is half a weight less than the
 * slots' cost. */
static thr_status add_slot_cuts(const instance *in, int n_slots, int64_t value, thr_tjoin *t, thr_err *err)
{
  thr_cut *all = thr_realloc(t->cut, (size_t)t->n_cuts + (size_t)n_slots, sizeof *all);
  if (!all) return thr_nomem(err);
  t->cut = all;
  for (int i = 0; i < n_slots; i++) {
    thr_cut *c = &t->cut[t->n_cuts];
    *c = (thr_cut){1, thr_calloc(1, sizeof *c->node), value};
    if (!c->node) return thr_nomem(err);
    c->node[0] = in->n_nodes + i;
    t->n_cuts++;
    t->sum += value;
  }
  return THR_OK;
}

/* The ends of several cords: slots for all of them would make the linear programme large, and one like the other. */
static thr_status solve_with_ends(postman *m, int k, const instance *in, thr_tjoin *t, thr_err *err)
{
  thr_certificate *c = &m->certificate[k];
  thr_endjoin j = {0};
  bool *end_allowed = thr_calloc((size_t)in->n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);
  for (int i = 0; i < in->n_nodes; i++)
    end_allowed[i] = thr_plan_end_allowed(m->f, m->o, m->node[m->start[k] + i]);
  thr_endjoin_problem p = {
      {in->n_nodes, in->n_edges, (const int(*)[2])in->edge, in->weight, in->odd, 0}, end_allowed, c->n_slots, c->slot_cost};
  thr_status st = thr_endjoin_solve(&p, m->limits, &j, err), added = THR_OK;
  free(end_allowed);
  if (st && st != THR_ELIMIT) return st;
  *t = (thr_tjoin){.in_join = j.in_join, .n_cuts = j.n_cuts, .cut = j.cut, .sum = j.sum};
  c->denominator = 2 * THR_DUAL_DENOMINATOR;
  c->slot_cost = (j.price + 1) / 2;
  if (j.price % 2) added = add_slot_cuts(in, c->n_slots, THR_DUAL_DENOMINATOR, t, err);
  return added ? added : st;
}

static thr_status solve_component(postman *m, int k, thr_err *err)
{
  instance in = {0};
  thr_tjoin t = {0};
  thr_status st = instance_init(m, k, &in, &m->certificate[k], err);
  if (!st && m->certificate[k].n_slots > 2) {
    st = solve_with_ends(m, k, &in, &t, err);
  } else if (!st) {
    thr_tjoin_problem p = {in.n_nodes, in.n_edges, (const int(*)[2])in.edge, in.weight, in.odd, in.n_slots};
    st = thr_tjoin_solve(&p, m->limits, &t, err);
  }
  if (!st || st == THR_ELIMIT) take_result(m, k, &in, &t);
  thr_tjoin_destroy(&t);
  instance_destroy(&in);
  return st;
}

static void postman_destroy(postman *m)
{
  for (int k = 0; m->certificate && k < m->n_components; k++)
    thr_certificate_destroy(&m->certificate[k]);
  free(m->certificate);
  free(m->component);
  free(m->start);
  free(m->node);
  free(m->local);
  free(m->passes);
}

static thr_status postman_init(postman *m, thr_err *err)
{
  size_t n = (size_t)m->f->n_nodes;
  if (!(m->component = thr_calloc(n, sizeof *m->component))) return thr_nomem(err);
  thr_status st = thr_frame_components(m->f, m->component, &m->n_components, err);
  if (st) return st;
  size_t k = (size_t)m->n_components;
  m->start = thr_calloc(k + 2, sizeof *m->start);
  m->node = thr_calloc(n, sizeof *m->node);
  m->local = thr_calloc(n, sizeof *m->local);
  m->passes = thr_calloc((size_t)m->f->n_edges, sizeof *m->passes);
  m->certificate = thr_calloc(k, sizeof *m->certificate);
  if (!m->start || !m->node || !m->local || !m->passes || !m->certificate) return thr_nomem(err);
  for (int e = 0; e < m->f->n_edges; e++)
    m->passes[e] = m->o->cover;
  for (size_t v = 0; v < n; v++)
    m->start[m->component[v] + 2]++;
  for (size_t i = 1; i <= k; i++)
    m->start[i + 1] += m->start[i];
  for (int v = 0; v < m->f->n_nodes; v++) {
    int *next = &m->start[m->component[v] + 1];
    m->node[*next] = v;
    ++*next;
  }
  for (int i = 0; i < m->n_components; i++)
    for (int j = m->start[i]; j < m->start[i + 1]; j++)
      m->local[m->node[j]] = j - m->start[i];
  return THR_OK;
}

/* What the checker says of a certificate, in the words of a solver that made it. */
static thr_status own_check(thr_status st, const thr_err *found, thr_err *err)
{
  if (st == THR_EVIOLATED) return thr_fail(err, THR_ESOLVER, "the plan does not pass its own check: %s", found->text);
  return st ? thr_fail(err, st, "%s", found->text) : THR_OK;
}

static thr_status judge(postman *m, thr_shortest *out, thr_err *err)
{
  thr_err found = {0};
  *out = (thr_shortest){.passes = m->passes, .n_certificates = m->n_components, .certificate = m->certificate};
  m->passes = NULL;
  m->certificate = NULL;
  for (int e = 0; e < m->f->n_edges; e++)
    out->length += out->passes[e] * m->f->length[e];
  return own_check(thr_check_length_of_passes(m->f, m->o, out->passes, out->certificate, out->n_certificates, &out->optimal,
                                              &out->lower_bound, &found),
                   &found, err);
}

thr_status thr_postman_shortest(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_shortest *out,
                                thr_err *err)
{
  postman m = {.f = f, .o = o, .limits = limits};
  *out = (thr_shortest){0};
  thr_err unproved = {0}; /* why the first unproved component is not proved */
  thr_status st = postman_init(&m, err);
  for (int k = 0; k < m.n_components && !st; k++) {
    thr_err local = {0};
    st = solve_component(&m, k, &local);
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", local.text);
    if (st != THR_ELIMIT) continue;
    thr_fail(&unproved, st, "%s", local.text);
    st = THR_OK; /* the other components still get their (quick) best */
  }
  if (!st) st = judge(&m, out, err);
  if (!st && !out->optimal)
    st = thr_fail(err, THR_ELIMIT, "%s: the cord is proved to be within %.3g %% of the shortest",
                  unproved.code ? unproved.text : "too many edges to round their lengths finely enough",
                  100 * (out->length - out->lower_bound) / out->length);
  if (st && st != THR_ELIMIT) thr_shortest_destroy(out);
  postman_destroy(&m);
  return st;
}

void thr_shortest_destroy(thr_shortest *s)
{
  for (int k = 0; s->certificate && k < s->n_certificates; k++)
    thr_certificate_destroy(&s->certificate[k]);
  free(s->certificate);
  free(s->passes);
  *s = (thr_shortest){0};
}

/* ---- proof of cords ---- */

/* The certificates' joins: what these cords weigh beyond the cover. */
static thr_status weigh_joins(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_shortest *s,
                              thr_err *err)
{
  int n_components, *component = thr_calloc((size_t)f->n_nodes, sizeof *component);
  thr_status st = component ? thr_frame_components(f, component, &n_components, err) : thr_nomem(err);
  for (int k = 0; k < s->n_certificates; k++)
    s->certificate[k].join = 0;
  for (int e = 0; e < f->n_edges && !st; e++) {
    thr_certificate *c = &s->certificate[component[f->edge[e][0]]];
    c->join -= o->cover * thr_certificate_weight(f, c, e);
  }
  for (int i = 0; i < n_cords && !st; i++)
    for (int k = 0; k < cord[i].n_passes; k++) {
      thr_certificate *c = &s->certificate[cord[i].component];
      c->join += thr_certificate_weight(f, c, cord[i].half[k] >> 1);
    }
  free(component);
  return st;
}

thr_status thr_postman_prove(const thr_frame *f, const thr_plan_options *o, const thr_cord *cord, int n_cords, thr_shortest *s,
                             thr_length_proof *proof, thr_err *err)
{
  thr_err found = {0};
  double length = 0;
  *proof = (thr_length_proof){.present = true};
  thr_status st = weigh_joins(f, o, cord, n_cords, s, err);
  if (st) return st;
  proof->certificate = s->certificate;
  proof->n_certificates = s->n_certificates;
  s->certificate = NULL;
  s->n_certificates = 0;
  for (int i = 0; i < n_cords; i++)
    length += thr_cord_length(f, &cord[i]);
  st = own_check(thr_check_length_proof(f, o, cord, n_cords, proof->certificate, proof->n_certificates, &proof->optimal,
                                        &proof->lower_bound, &found),
                 &found, err);
  proof->gap = (length - proof->lower_bound) / length;
  return st;
}

/* ---- one cord per component ---- */

/* Where the passes leave an odd number: the two ends of each component's cord, else -1 and -1. */
static void find_ends(const thr_frame *f, const int *component, int n_components, const int *passes, int (*ends)[2])
{
  for (int k = 0; k < n_components; k++)
    ends[k][0] = ends[k][1] = -1;
  for (int v = 0; v < f->n_nodes; v++) {
    int sum = 0, *end = ends[component[v]];
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      sum += passes[f->half[i] >> 1];
    if (sum % 2) end[end[0] >= 0] = v;
  }
}

thr_status thr_postman_cords(const thr_frame *f, const thr_plan_options *o, const int *passes, thr_cord **cord, int *n_cords,
                             thr_err *err)
{
  int n_components = 0, *component = thr_calloc((size_t)f->n_nodes, sizeof *component), (*ends)[2] = NULL;
  *cord = NULL;
  *n_cords = 0;
  thr_status st = component ? thr_frame_components(f, component, &n_components, err) : thr_nomem(err);
  if (!st && !(ends = thr_calloc((size_t)n_components, sizeof *ends))) st = thr_nomem(err);
  if (!st && !(*cord = thr_calloc((size_t)n_components, sizeof **cord))) st = thr_nomem(err);
  if (!st) {
    find_ends(f, component, n_components, passes, ends);
    st = thr_tour_cords(f, o, component, n_components, passes, (const int(*)[2])ends, *cord, err);
  }
  if (!st) {
    *n_cords = n_components;
  } else {
    free(*cord);
    *cord = NULL;
  }
  free(component);
  free(ends);
  return st;
}

/* Cords through the passes; then metrics, and the proof as far as the checker follows it. */
static thr_status assemble(const thr_frame *f, const thr_plan_options *o, thr_shortest *s, thr_plan *plan, thr_err *err)
{
  thr_status st = thr_plan_request(plan, f, o, err);
  if (!st) st = thr_postman_cords(&plan->frame, &plan->options, s->passes, &plan->cord, &plan->n_cords, err);
  if (!st) st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics, err);
  if (!st) st = thr_postman_prove(&plan->frame, &plan->options, plan->cord, plan->n_cords, s, &plan->proof, err);
  return st;
}

thr_status thr_postman_plan(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  thr_shortest s = {0};
  thr_err local = {0};
  *plan = (thr_plan){0};
  if (o->cords > 1) return thr_fail(err, THR_EINPUT, "--cords above 1 needs --objective tortuosity in this version");
  thr_status proved = thr_postman_shortest(f, o, limits, &s, &local), st = THR_OK;
  if (!proved || proved == THR_ELIMIT) st = assemble(f, o, &s, plan, err);
  if (!st && proved) st = thr_fail(err, proved, "%s", local.text);
  if (st && st != THR_ELIMIT) thr_plan_destroy(plan);
  thr_shortest_destroy(&s);
  return st;
}
