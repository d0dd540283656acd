/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Route Inspection: the shortest cord that covers a framework (thesis, chapter 5 "Length"; Edmonds
 * & Johnson 1973).
 *
 * Length = cover x sum of all lengths + a minimum T-join of the nodes that these passes leave odd.
 * K cords have 2 K ends, which may take odd nodes out of T (lp/tjoin/endjoin.c).
 *
 * Example: a square with one diagonal of length d: two odd nodes. Closed: 4 + 2 d, the diagonal
 * twice; with two ends there: 4 + d. */
#include "lp/length/postman.h"
#include "graph/check/check.h"
#include "graph/disjoint.h"
#include "graph/scratch.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sum of the integer weights of a component with n edges: 2^44 to 2^45, and at least 2^30 an edge,
 * so that all roundings together stay below 1e-9 of the sum; at most 2^49, so that sums of
 * multipliers fit 64 bits. */
static double weight_sum(int n)
{
  return fmin(fmax(35184372088832.0, 2147483648.0 * n), 562949953421312.0);
}

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits;
  int n_components;
  thr_scratch own;        /* what is no result */
  int *component;         /* [n_nodes] */
  int *edge_start, *edge; /* edges of component k: edge[edge_start[k] .. edge_start[k + 1] - 1] */
  int *part;   /* [n_nodes] disjoint sets: nodes that edges with room for an extra pass join */
  int *domain; /* [n_nodes] disjoint sets: parts of a component where cords may end count as one */
  int *start, *node; /* nodes of domain d: node[start[d] .. start[d + 1] - 1] */
  int *local;        /* [n_nodes] position within the domain */
  int n_domains;     /* by lowest node */
  bool *odd; /* [n_nodes] is the number of passes that its edges need, and of its ends, if given? */
  int *passes;                  /* [n_edges] result */
  thr_certificate *certificate; /* [n_components] result */
  thr_confirmations confirmed;  /* result */
} postman;

/* Where confirmations are counted, if they are asked for. */
static thr_confirmations *counter(postman *m)
{
  m->confirmed.always = m->o->confirm == THR_CONFIRM_ALWAYS;
  bool asked = m->o->confirm != THR_CONFIRM_NEVER && thr_wants_length(m->o) &&
               m->o->joint == THR_JOINT_SOLID;
  return asked ? &m->confirmed : NULL;
}

/* Cord ends at allowed nodes, their number at each being free? */
static bool ends_free(const postman *m)
{
  return m->o->ends != THR_ENDS_CLOSED && m->o->ends != THR_ENDS_COUNTS;
}

static bool has_room(const postman *m, int e)
{
  return thr_plan_capacity(m->f, m->o, e) > thr_plan_cover(m->f, m->o, e);
}

/* The T-join problem of one domain, over the edges with room. */
typedef struct {
  thr_scratch own; /* the arrays */
  int n_nodes, n_edges;
  int (*edge)[2];
  int64_t *weight;
  bool *odd, *end_allowed;
  int *frame_edge; /* [n_edges] */
} instance;

/* Greatest length that all lengths are whole multiples of, as far as Euclid's algorithm can tell;
 * remainders far below the shortest length count as none. */
static double common_measure(const thr_frame *frame, const int *edge, int n)
{
  double measure = frame->length[edge[0]], shortest = measure;
  for (int i = 1; i < n; i++)
    shortest = fmin(shortest, frame->length[edge[i]]);
  for (int i = 1; i < n; i++)
    for (double a = frame->length[edge[i]], b = measure; b > 0;) {
      double r = fmod(a, b);
      if (r < 1e-6 * shortest || b - r < 1e-6 * shortest) r = 0;
      measure = a = b;
      b = r;
    }
  return measure;
}

/* A scale under which lengths round to integers. If the lengths have a common measure (all beads
 * equal: the normal case; or whole millimetres), it is the unit: then ties are exact and weights
 * small. Otherwise a power of 2 that gives the weights their sum: powers of 2 keep exact what is
 * exact. */
static double choose_scale(const thr_frame *frame, const int *edge, int n)
{
  double sum = 0, units = 0, measure = common_measure(frame, edge, n), most = weight_sum(n);
  for (int i = 0; i < n; i++) {
    sum += frame->length[edge[i]];
    units += nearbyint(frame->length[edge[i]] / measure);
  }
  double finest = exp2(floor(log2(most / sum))), scale = units / sum;
  if (units > most) return finest;
  for (int i = 0; i < n; i++) {
    double length = frame->length[edge[i]];
    if (fabs(length - nearbyint(length * scale) / scale) > 1e-12 * length) return finest;
  }
  return scale;
}

/* No two nodes of a part are further apart than twice this: the longest path from its first node in
 * a breadth-first tree, of all parts of the domain. */
static thr_status radius(const postman *m, int d, const thr_certificate *c, int64_t *longest,
                         thr_err *err)
{
  int first = m->start[d], n = m->start[d + 1] - first;
  int *queue = thr_calloc((size_t)n, sizeof *queue);
  int64_t *far = thr_calloc((size_t)n, sizeof *far);
  thr_status st = queue && far ? THR_OK : thr_nomem(err);
  *longest = 0;
  for (int v = 0; v < n && !st; v++)
    far[v] = -1;
  for (int root = 0; root < n && !st; root++) {
    if (far[root] >= 0) continue;
    int tail = 0;
    queue[tail++] = root;
    far[root] = 0;
    for (int at = 0; at < tail; at++) {
      int v = m->node[first + queue[at]];
      for (int i = m->f->first[v]; i < m->f->first[v + 1]; i++) {
        int h = m->f->half[i], w = m->local[thr_head(m->f, h)];
        if (!has_room(m, h >> 1) || far[w] >= 0) continue;
        queue[tail++] = w;
        far[w] = far[queue[at]] + thr_certificate_weight(m->f, c, h >> 1);
        if (far[w] > *longest) *longest = far[w];
      }
    }
  }
  free(queue);
  free(far);
  return st;
}

static thr_status instance_init(const postman *m, int d, const thr_certificate *c, instance *in,
                                thr_err *err)
{
  const thr_frame *frame = m->f;
  int first = m->start[d], halves = 0;
  *in = (instance){.n_nodes = m->start[d + 1] - first};
  for (int j = 0; j < in->n_nodes; j++)
    halves += thr_degree(frame, m->node[first + j]);
  in->edge = thr_scratch_array(&in->own, (size_t)halves, sizeof *in->edge);
  in->weight = thr_scratch_array(&in->own, (size_t)halves, sizeof *in->weight);
  in->frame_edge = thr_scratch_array(&in->own, (size_t)halves, sizeof *in->frame_edge);
  in->odd = thr_scratch_array(&in->own, (size_t)in->n_nodes, sizeof *in->odd);
  in->end_allowed = thr_scratch_array(&in->own, (size_t)in->n_nodes, sizeof *in->end_allowed);
  thr_status st = thr_scratch_check(&in->own, err);
  if (st) return st;
  for (int j = 0; j < in->n_nodes; j++) {
    int v = m->node[first + j];
    in->odd[j] = m->odd[v];
    in->end_allowed[j] = ends_free(m) && thr_plan_end_allowed(frame, m->o, v);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int h = frame->half[i];
      if (h % 2 || !has_room(m, h >> 1)) continue; /* each edge once, from its first node */
      in->frame_edge[in->n_edges] = h / 2;
      in->weight[in->n_edges] = thr_certificate_weight(frame, c, h / 2);
      in->edge[in->n_edges][0] = j;
      in->edge[in->n_edges++][1] = m->local[thr_head(frame, h)];
    }
  }
  return THR_OK;
}

/* Adds cuts over the nodes of domain d, which are moved, to the certificate; times: their values in
 * its units. */
static thr_status take_cuts(const postman *m, int d, thr_cut **cut, int *n, int64_t times,
                            thr_certificate *c, thr_err *err)
{
  thr_cut *all = thr_realloc(c->cut, (size_t)c->n_cuts + (size_t)*n, sizeof *all);
  if (!all) return thr_nomem(err);
  c->cut = all;
  for (int i = 0; i < *n; i++) {
    thr_cut *to = &c->cut[c->n_cuts + i];
    *to = (*cut)[i];
    to->value *= times;
    if (to->parent >= 0) to->parent += c->n_cuts;
    for (int j = 0; j < to->n_nodes; j++)
      to->node[j] =
          m->node[m->start[d] + to->node[j]]; /* nodes ascend within a domain: still sorted */
    c->sum += to->value;
  }
  c->n_cuts += *n;
  free(*cut);
  *cut = NULL;
  *n = 0;
  return THR_OK;
}

static void take_join(postman *m, const instance *in, const bool *in_join, thr_certificate *c)
{
  assert(in_join);
  for (int i = 0; i < in->n_edges; i++)
    if (in_join[i]) {
      m->passes[in->frame_edge[i]]++;
      c->join += in->weight[i];
    }
}

static thr_status solve_closed(postman *m, int d, const instance *in, thr_certificate *c,
                               thr_err *err)
{
  thr_tjoin tjoin;
  thr_tjoin_problem tjoin_problem = {in->n_nodes, in->n_edges, (const int(*)[2])in->edge,
                                     in->weight,  in->odd,     0};
  thr_status st = thr_tjoin_minimum(&tjoin_problem, m->o->engine, m->limits, &tjoin, err),
             taken = THR_OK;
  if (!st) st = thr_confirmations_add(counter(m), &tjoin_problem, &tjoin, err);
  if (!st || st == THR_ELIMIT) {
    take_join(m, in, tjoin.in_join, c);
    taken =
        take_cuts(m, d, &tjoin.cut, &tjoin.n_cuts, c->denominator / THR_DUAL_DENOMINATOR, c, err);
  }
  thr_tjoin_destroy(&tjoin);
  return taken ? taken : st;
}

static thr_status solve_open(postman *m, int d, const instance *in, thr_certificate *c,
                             thr_err *err)
{
  thr_endjoin endjoin = {0};
  thr_endjoin_problem endjoin_problem = {
      .graph = {in->n_nodes, in->n_edges, (const int(*)[2])in->edge, in->weight, in->odd, 0},
      .end_allowed = in->end_allowed,
      .engine = m->o->engine,
      .count = counter(m),
      .n_ends = 2 * m->o->cords};
  thr_status st = radius(m, d, c, &endjoin_problem.far, err), taken = THR_OK;
  endjoin_problem.far++;
  if (!st) st = thr_endjoin_solve(&endjoin_problem, m->limits, &endjoin, err);
  if (!st || st == THR_ELIMIT) {
    take_join(m, in, endjoin.in_join, c);
    c->end_price = endjoin.end_price;
    taken = take_cuts(m, d, &endjoin.cut, &endjoin.n_cuts, 1, c, err);
  }
  thr_endjoin_destroy(&endjoin);
  return taken ? taken : st;
}

static thr_status solve_domain(postman *m, int d, thr_err *err)
{
  instance in;
  bool open = false;
  thr_certificate *c = &m->certificate[m->component[m->node[m->start[d]]]];
  thr_status st = instance_init(m, d, c, &in, err);
  for (int v = 0; v < in.n_nodes && !st; v++)
    open |= in.end_allowed[v];
  if (!st) st = open ? solve_open(m, d, &in, c, err) : solve_closed(m, d, &in, c, err);
  thr_scratch_free(&in.own);
  return st;
}

/* ---- what cannot be ---- */

static thr_status check_room(const postman *m, thr_err *err)
{
  const thr_frame *frame = m->f;
  for (int e = 0; e < frame->n_edges; e++) {
    int least = thr_plan_cover(frame, m->o, e), most = thr_plan_capacity(frame, m->o, e);
    if (least > most)
      return thr_fail(
          err, THR_EINFEASIBLE,
          "edge %s-%s needs %d passes, but only %d fit; lower --cover or raise its capacity",
          frame->name[frame->edge[e][0]], frame->name[frame->edge[e][1]], least, most);
  }
  return THR_OK;
}

/* A full edge that leaves the part, to be named. */
static thr_status no_room(const postman *m, int part, const char *why, thr_err *err)
{
  const thr_frame *frame = m->f;
  int e = 0;
  while (e + 1 < frame->n_edges &&
         (m->part[frame->edge[e][0]] == part) == (m->part[frame->edge[e][1]] == part))
    e++;
  return thr_fail(err, THR_EINFEASIBLE,
                  "edge %s-%s is full with %d %s, as is every edge out of the part with node %s, "
                  "which needs one more pass %s",
                  frame->name[frame->edge[e][0]], frame->name[frame->edge[e][1]],
                  thr_plan_cover(frame, m->o, e),
                  thr_plan_cover(frame, m->o, e) == 1 ? "pass" : "passes", frame->name[part], why);
}

/* Extra passes cannot leave a part: where the odd nodes in it are odd in number, a cord has to end.
 */
static thr_status check_parts(const postman *m, thr_err *err)
{
  const thr_frame *frame = m->f;
  size_t n = (size_t)frame->n_nodes;
  bool *odd = thr_calloc(n, sizeof *odd), *open = thr_calloc(n, sizeof *open);
  int *ends = thr_calloc(n, sizeof *ends);
  thr_status st = odd && open && ends ? THR_OK : thr_nomem(err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    odd[m->part[v]] ^= m->odd[v];
    open[m->part[v]] |= ends_free(m) && thr_plan_end_allowed(frame, m->o, v);
  }
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    if (!odd[v]) continue; /* only roots are marked */
    if (!open[v])
      st = no_room(m, v, "to make their number even", err);
    else if (++ends[m->component[v]] > 2 * m->o->cords)
      st = no_room(m, v, "or more cords to end there", err);
  }
  free(odd);
  free(open);
  free(ends);
  return st;
}

/* In every component cords can end somewhere; ends that are given have their cords. */
static thr_status check_ends(const postman *m, thr_err *err)
{
  const thr_frame *frame = m->f;
  int *ends = thr_calloc((size_t)m->n_components, sizeof *ends),
      *first = thr_calloc((size_t)m->n_components, sizeof *first);
  thr_status st = ends && first ? THR_OK : thr_nomem(err);
  for (int v = frame->n_nodes - 1; v >= 0 && !st; v--) {
    first[m->component[v]] = v;
    ends[m->component[v]] +=
        m->o->ends == THR_ENDS_COUNTS ? m->o->end_count[v] : thr_plan_end_allowed(frame, m->o, v);
  }
  for (int k = 0; k < m->n_components && !st; k++) {
    const char *name = frame->name[first[k]];
    if (ends[k] == 0)
      st = thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s has no node where a cord may end; name one with "
                    "--feet (try --feet lowest) or "
                    "--ends, or use "
                    "--ends closed",
                    name);
    else if (m->o->ends == THR_ENDS_COUNTS &&
             (ends[k] % 2 || ends[k] / 2 > m->o->cords || ends[k] / 2 < m->o->cords_least))
      st = thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s: %d cord ends do not make %d %s; each has two",
                    name, ends[k], m->o->cords, m->o->cords == 1 ? "cord" : "cords");
  }
  free(ends);
  free(first);
  return st;
}

static void postman_destroy(postman *m)
{
  for (int k = 0; m->certificate && k < m->n_components; k++)
    thr_certificate_destroy(&m->certificate[k]);
  free(m->certificate);
  thr_confirmations_destroy(&m->confirmed);
  free(m->passes);
  thr_scratch_free(&m->own);
}

/* Counting sort of items by key, from start[keys + 2], which is all 0: shifted by one place so that
 * filling leaves the starts right. */
static void group(int n_items, const int *key, int n_keys, int *start, int *item)
{
  for (int i = 0; i < n_items; i++)
    start[key[i] + 2]++;
  for (int i = 1; i <= n_keys; i++)
    start[i + 1] += start[i];
  for (int i = 0; i < n_items; i++)
    item[start[key[i] + 1]++] = i;
}

/* Parts and domains; leaves in key[n_nodes] the number of each node's domain. */
static void find_domains(postman *m, int *key)
{
  const thr_frame *frame = m->f;
  for (int v = 0; v < frame->n_nodes; v++)
    m->part[v] = m->domain[v] = v;
  for (int e = 0; e < frame->n_edges; e++) {
    if (!has_room(m, e)) continue;
    thr_disjoint_join(m->part, frame->edge[e][0], frame->edge[e][1]);
    thr_disjoint_join(m->domain, frame->edge[e][0], frame->edge[e][1]);
  }
  for (int k = 0; k < m->n_components; k++)
    key[k] = -1; /* a node of this component where cords may end */
  for (int v = 0; v < frame->n_nodes && ends_free(m); v++) {
    if (!thr_plan_end_allowed(frame, m->o, v)) continue;
    int *end = &key[m->component[v]];
    if (*end >= 0) thr_disjoint_join(m->domain, *end, v);
    *end = v;
  }
  for (int v = 0; v < frame->n_nodes; v++) {
    m->part[v] = thr_disjoint_find(m->part, v);
    int root = thr_disjoint_find(m->domain, v); /* the lowest: it has its number already */
    key[v] = root == v ? m->n_domains++ : key[root];
  }
}

static thr_status postman_allocate(postman *m, thr_err *err)
{
  size_t n = (size_t)m->f->n_nodes, e = (size_t)m->f->n_edges, k = (size_t)m->n_components;
  m->edge_start = thr_scratch_array(&m->own, k + 2, sizeof *m->edge_start);
  m->edge = thr_scratch_array(&m->own, e, sizeof *m->edge);
  m->part = thr_scratch_array(&m->own, n, sizeof *m->part);
  m->domain = thr_scratch_array(&m->own, n, sizeof *m->domain);
  m->start = thr_scratch_array(&m->own, n + 2, sizeof *m->start);
  m->node = thr_scratch_array(&m->own, n, sizeof *m->node);
  m->local = thr_scratch_array(&m->own, n, sizeof *m->local);
  m->odd = thr_scratch_array(&m->own, n, sizeof *m->odd);
  m->passes = thr_calloc(e, sizeof *m->passes);
  m->certificate = thr_calloc(k, sizeof *m->certificate);
  return m->passes && m->certificate ? thr_scratch_check(&m->own, err) : thr_nomem(err);
}

static void start_certificates(postman *m)
{
  for (int k = 0; k < m->n_components; k++) {
    thr_certificate *c = &m->certificate[k];
    c->component = k;
    c->denominator = ends_free(m) ? 2 * THR_DUAL_DENOMINATOR : THR_DUAL_DENOMINATOR;
    c->scale =
        choose_scale(m->f, m->edge + m->edge_start[k], m->edge_start[k + 1] - m->edge_start[k]);
  }
}

static thr_status postman_init(postman *m, thr_err *err)
{
  const thr_frame *frame = m->f;
  size_t most = (size_t)(frame->n_nodes > frame->n_edges ? frame->n_nodes : frame->n_edges);
  int *key = thr_calloc(most, sizeof *key);
  m->component = thr_scratch_array(&m->own, (size_t)frame->n_nodes, sizeof *m->component);
  thr_status st = key && m->component
                      ? thr_frame_components(frame, m->component, &m->n_components, err)
                      : thr_nomem(err);
  if (!st) st = postman_allocate(m, err);
  if (!st) {
    for (int e = 0; e < frame->n_edges; e++)
      key[e] = m->component[frame->edge[e][0]];
    group(frame->n_edges, key, m->n_components, m->edge_start, m->edge);
    find_domains(m, key);
    group(frame->n_nodes, key, m->n_domains, m->start, m->node);
    for (int d = 0; d < m->n_domains; d++)
      for (int j = m->start[d]; j < m->start[d + 1]; j++)
        m->local[m->node[j]] = j - m->start[d];
    for (int v = 0; v < frame->n_nodes; v++)
      m->odd[v] = m->o->ends == THR_ENDS_COUNTS && m->o->end_count[v] % 2;
    for (int e = 0; e < frame->n_edges; e++) {
      m->passes[e] = thr_plan_cover(frame, m->o, e);
      for (int i = 0; i < 2; i++)
        m->odd[frame->edge[e][i]] ^= m->passes[e] % 2 != 0;
    }
    start_certificates(m);
  }
  free(key);
  return st;
}

static thr_status judge(postman *m, thr_shortest *out, thr_err *err)
{
  thr_err found = {0};
  *out = (thr_shortest){.passes = m->passes,
                        .n_certificates = m->n_components,
                        .certificate = m->certificate,
                        .confirmed = m->confirmed};
  m->passes = NULL;
  m->certificate = NULL;
  for (int e = 0; e < m->f->n_edges; e++)
    out->length += out->passes[e] * m->f->length[e];
  return thr_check_own(thr_check_length_of_passes(m->f, m->o, out->passes, out->certificate,
                                                  out->n_certificates, &out->optimal,
                                                  &out->lower_bound, &found),
                       &found, err);
}

thr_status thr_postman_shortest(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, thr_shortest *out, thr_err *err)
{
  postman m = {.f = frame, .o = options, .limits = limits};
  *out = (thr_shortest){0};
  thr_err unproved = {0}; /* why the first unproved domain is not proved */
  thr_status st = postman_init(&m, err);
  if (!st) st = check_room(&m, err);
  if (!st) st = check_ends(&m, err);
  if (!st) st = check_parts(&m, err);
  for (int d = 0; d < m.n_domains && !st; d++) {
    thr_err local = {0};
    st = solve_domain(&m, d, &local);
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", local.text);
    if (st != THR_ELIMIT) continue;
    thr_fail(&unproved, st, "%s", local.text);
    st = THR_OK; /* the others still get their (quick) best */
  }
  if (!st) st = thr_confirmations_run(counter(&m), limits, err);
  if (!st) st = judge(&m, out, err);
  if (!st && !out->optimal) {
    char what[sizeof unproved.text + 20];
    snprintf(what, sizeof what, "%s: the cord's length",
             unproved.code ? unproved.text : "too many edges to round their lengths finely enough");
    st = thr_not_proved(err, what, out->length, out->lower_bound);
  }
  if (st && st != THR_ELIMIT) thr_shortest_destroy(out);
  postman_destroy(&m);
  return st;
}

void thr_shortest_destroy(thr_shortest *shortest)
{
  for (int k = 0; shortest->certificate && k < shortest->n_certificates; k++)
    thr_certificate_destroy(&shortest->certificate[k]);
  free(shortest->certificate);
  free(shortest->passes);
  *shortest = (thr_shortest){0};
}
