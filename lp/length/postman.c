/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves Route Inspection: computes the shortest passes of cords that cover a framework (thesis,
 * chapter 5 "Length"; Edmonds & Johnson 1973).
 *
 * The length is cover x sum of all lengths + a minimum T-join of the nodes that these passes leave
 * odd. K cords have 2 K ends, which may take odd nodes out of T (lp/tjoin/endjoin.c). Edges that
 * are full divide a component into parts; parts in which cords may end belong together, as ends may
 * be in any of them. Each such domain is a T-join problem of its own.
 *
 * Example: a square with one diagonal of length d: two odd nodes. Closed: 4 + 2 d, the diagonal
 * twice; with two ends there: 4 + d. */
#include "lp/length/postman.h"
#include "graph/check/check.h"
#include "graph/arrays.h"
#include "graph/plan/physics.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Returns the sum that the integer weights of a component with n edges are given: 2^44 to 2^45, and
 * at least 2^30 an edge, so that all roundings together stay below 1e-9 of the sum; at most 2^49,
 * so that sums of multipliers fit 64 bits. */
static double weight_sum(int n)
{
  return fmin(fmax(35184372088832.0, 2147483648.0 * n), 562949953421312.0);
}

/* The whole problem: parts, domains and what is computed. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
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
} postman_problem;

/* Returns where confirmations are counted, or NULL if none are asked for. */
static thr_confirmations *counter(postman_problem *postman)
{
  postman->confirmed.always = postman->request->confirm == THR_CONFIRM_ALWAYS;
  bool asked = postman->request->confirm != THR_CONFIRM_NEVER &&
               thr_wants_length(postman->request) && postman->request->joint == THR_JOINT_SOLID;
  return asked ? &postman->confirmed : NULL;
}

/* Returns whether cords may end at allowed nodes, with any number of ends at each. */
static bool ends_free(const postman_problem *postman)
{
  return postman->request->ends != THR_ENDS_CLOSED && postman->request->ends != THR_ENDS_COUNTS;
}

/* Returns whether an edge may have more passes than its cover. */
static bool has_room(const postman_problem *postman, int e)
{
  return thr_plan_capacity(postman->frame, postman->request, e) >
         thr_plan_cover(postman->frame, postman->request, e);
}

/* The T-join problem of one domain, over the edges with room. */
typedef struct {
  thr_scratch own; /* the arrays */
  int n_nodes, n_edges;
  int (*edge)[2];
  int64_t *weight;
  bool *odd, *end_allowed;
  int *frame_edge; /* [n_edges] */
} domain_problem;

/* Returns the greatest length that all lengths are whole multiples of, as far as Euclid's algorithm
 * can tell; remainders far below the shortest length count as none. */
static double common_measure(const thr_frame *frame, const int *edge, int n)
{
  double measure = frame->length[edge[0]], shortest = measure;

  /* What is so much below the shortest length is rounding. */
  for (int i = 1; i < n; i++)
    shortest = fmin(shortest, frame->length[edge[i]]);

  /* Euclid's algorithm on the measure of the lengths so far and the next length. */
  for (int i = 1; i < n; i++)
    for (double a = frame->length[edge[i]], b = measure; b > 0;) {
      double remainder = fmod(a, b);
      if (remainder < 1e-6 * shortest || b - remainder < 1e-6 * shortest) remainder = 0;
      measure = a = b;
      b = remainder;
    }
  return measure;
}

/* Chooses a scale under which lengths round to integers. If the lengths have a common measure (all
 * beads equal: the normal case; or whole millimetres), it is the unit: then ties are exact and
 * weights small. Otherwise a power of 2 that gives the weights their sum: powers of 2 keep exact
 * what is exact. */
static double choose_scale(const thr_frame *frame, const int *edge, int n)
{
  double sum = 0, units = 0, measure = common_measure(frame, edge, n), most = weight_sum(n);

  /* All lengths together, in units of length and of the measure. */
  for (int i = 0; i < n; i++) {
    sum += frame->length[edge[i]];
    units += nearbyint(frame->length[edge[i]] / measure);
  }

  double finest = exp2(floor(log2(most / sum))), scale = units / sum;
  if (units > most) return finest;

  /* The unit only serves if every length is a whole multiple of it. */
  for (int i = 0; i < n; i++) {
    double length = frame->length[edge[i]];
    if (fabs(length - nearbyint(length * scale) / scale) > 1e-12 * length) return finest;
  }
  return scale;
}

/* Computes the longest path from the first node of a part in a breadth-first tree, of all parts of
 * a domain. No two nodes of a part are further apart than twice this. */
static thr_status radius(const postman_problem *postman, int number,
                         const thr_certificate *certificate, int64_t *longest, thr_err *err)
{
  int first = postman->start[number], n = postman->start[number + 1] - first;
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

    /* A breadth-first search in the part of the root. */
    for (int at = 0; at < tail; at++) {
      int v = postman->node[first + queue[at]];
      for (int i = postman->frame->first[v]; i < postman->frame->first[v + 1]; i++) {
        int h = postman->frame->half[i], other = postman->local[thr_head(postman->frame, h)];

        if (!has_room(postman, h >> 1) || far[other] >= 0) continue;
        queue[tail++] = other;
        far[other] = far[queue[at]] + thr_certificate_weight(postman->frame, certificate, h >> 1);
        if (far[other] > *longest) *longest = far[other];
      }
    }
  }

  free(queue);
  free(far);
  return st;
}

/* Makes the T-join problem of a domain, in the weights of the certificate. */
static thr_status instance_init(const postman_problem *postman, int number,
                                const thr_certificate *certificate, domain_problem *domain,
                                thr_err *err)
{
  const thr_frame *frame = postman->frame;
  int first = postman->start[number], halves = 0;
  *domain = (domain_problem){.n_nodes = postman->start[number + 1] - first};

  /* No more edges than half-edges. */
  for (int j = 0; j < domain->n_nodes; j++)
    halves += thr_degree(frame, postman->node[first + j]);

  domain->edge = thr_scratch_array(&domain->own, (size_t)halves, sizeof *domain->edge);
  domain->weight = thr_scratch_array(&domain->own, (size_t)halves, sizeof *domain->weight);
  domain->frame_edge = thr_scratch_array(&domain->own, (size_t)halves, sizeof *domain->frame_edge);
  domain->odd = thr_scratch_array(&domain->own, (size_t)domain->n_nodes, sizeof *domain->odd);
  domain->end_allowed =
      thr_scratch_array(&domain->own, (size_t)domain->n_nodes, sizeof *domain->end_allowed);

  thr_status st = thr_scratch_check(&domain->own, err);
  if (st) return st;

  /* Nodes in their order, and the edges between them that have room. */
  for (int j = 0; j < domain->n_nodes; j++) {
    int v = postman->node[first + j];
    domain->odd[j] = postman->odd[v];
    domain->end_allowed[j] = ends_free(postman) && thr_plan_end_allowed(frame, postman->request, v);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int h = frame->half[i];

      if (h % 2 || !has_room(postman, h >> 1)) continue; /* each edge once, from its first node */
      domain->frame_edge[domain->n_edges] = h / 2;
      domain->weight[domain->n_edges] = thr_certificate_weight(frame, certificate, h / 2);
      domain->edge[domain->n_edges][0] = j;
      domain->edge[domain->n_edges++][1] = postman->local[thr_head(frame, h)];
    }
  }
  return THR_OK;
}

/* Adds cuts over the nodes of a domain, which are moved, to the certificate; times: their values in
 * its units. */
static thr_status take_cuts(const postman_problem *postman, int number, thr_cut **cut, int *n,
                            int64_t times, thr_certificate *certificate, thr_err *err)
{
  thr_cut *all =
      thr_realloc(certificate->cut, (size_t)certificate->n_cuts + (size_t)*n, sizeof *all);
  if (!all) return thr_nomem(err);
  certificate->cut = all;

  /* Nodes of the domain become nodes of the framework. They ascend within a domain, hence stay
   * sorted. */
  for (int i = 0; i < *n; i++) {
    thr_cut *to = &certificate->cut[certificate->n_cuts + i];
    *to = (*cut)[i];
    to->value *= times;
    if (to->parent >= 0) to->parent += certificate->n_cuts;
    for (int j = 0; j < to->n_nodes; j++)
      to->node[j] = postman->node[postman->start[number] + to->node[j]];
    certificate->sum += to->value;
  }

  certificate->n_cuts += *n;
  free(*cut);
  *cut = NULL;
  *n = 0;
  return THR_OK;
}

/* Makes one more pass of every edge in the join. */
static void take_join(postman_problem *postman, const domain_problem *domain, const bool *in_join,
                      thr_certificate *certificate)
{
  assert(in_join);
  for (int i = 0; i < domain->n_edges; i++)
    if (in_join[i]) {
      postman->passes[domain->frame_edge[i]]++;
      certificate->join += domain->weight[i];
    }
}

/* Returns limits that tell of weights in units of length. */
static thr_limits limits_of(const postman_problem *postman, const thr_certificate *certificate)
{
  thr_limits limits = *postman->limits;
  limits.weight = 1 / certificate->scale;
  return limits;
}

/* Solves a domain where no cord may end freely: a minimum T-join. */
static thr_status solve_closed(postman_problem *postman, int number, const domain_problem *domain,
                               thr_certificate *certificate, thr_err *err)
{
  thr_tjoin tjoin;
  thr_tjoin_problem tjoin_problem = {
      domain->n_nodes, domain->n_edges, (const int(*)[2])domain->edge,
      domain->weight,  domain->odd,     0};

  const thr_limits limits = limits_of(postman, certificate);
  thr_status st = thr_tjoin_minimum(&tjoin_problem, postman->request->engine, &limits, &tjoin, err),
             taken = THR_OK;
  if (!st) st = thr_confirmations_add(counter(postman), &tjoin_problem, &tjoin, err);

  /* A join that is not proved is taken, too, with what its cuts prove. */
  if (!st || st == THR_ELIMIT) {
    take_join(postman, domain, tjoin.in_join, certificate);
    taken = take_cuts(postman, number, &tjoin.cut, &tjoin.n_cuts,
                      certificate->denominator / THR_DUAL_DENOMINATOR, certificate, err);
  }

  thr_tjoin_destroy(&tjoin);
  return taken ? taken : st;
}

/* Solves a domain where cords may end freely: a minimum join that may leave odd nodes as ends. */
static thr_status solve_open(postman_problem *postman, int number, const domain_problem *domain,
                             thr_certificate *certificate, thr_err *err)
{
  thr_endjoin endjoin = {0};
  thr_endjoin_problem endjoin_problem = {.graph = {domain->n_nodes, domain->n_edges,
                                                   (const int(*)[2])domain->edge, domain->weight,
                                                   domain->odd, 0},
                                         .end_allowed = domain->end_allowed,
                                         .engine = postman->request->engine,
                                         .count = counter(postman),
                                         .n_ends = 2 * postman->request->cords};

  thr_status st = radius(postman, number, certificate, &endjoin_problem.far, err), taken = THR_OK;
  endjoin_problem.far++;
  const thr_limits limits = limits_of(postman, certificate);
  if (!st) st = thr_endjoin_solve(&endjoin_problem, &limits, &endjoin, err);

  /* A join that is not proved is taken, too, with what its cuts prove. */
  if (!st || st == THR_ELIMIT) {
    take_join(postman, domain, endjoin.in_join, certificate);
    certificate->end_price = endjoin.end_price;
    taken = take_cuts(postman, number, &endjoin.cut, &endjoin.n_cuts, 1, certificate, err);
  }

  thr_endjoin_destroy(&endjoin);
  return taken ? taken : st;
}

/* Solves the T-join problem of a domain. The certificate of its component gets the cuts. */
static thr_status solve_domain(postman_problem *postman, int number, thr_err *err)
{
  domain_problem domain;
  bool open = false;
  thr_certificate *certificate =
      &postman->certificate[postman->component[postman->node[postman->start[number]]]];

  /* One node where a cord may end is enough to make the domain an open one. */
  thr_status st = instance_init(postman, number, certificate, &domain, err);
  for (int v = 0; v < domain.n_nodes && !st; v++)
    open |= domain.end_allowed[v];
  if (!st)
    st = open ? solve_open(postman, number, &domain, certificate, err)
              : solve_closed(postman, number, &domain, certificate, err);

  thr_scratch_free(&domain.own);
  return st;
}

/* ---- what cannot be ---- */

/* Writes what lets no more passes into an edge: its bore, the framework, or --capacity. */
static void say_limit(const postman_problem *postman, int e, char out[96])
{
  const thr_request *request = postman->request;
  const thr_physics *physics = &request->physics;
  const int most = thr_plan_capacity(postman->frame, request, e);

  if (request->capacity != most)
    snprintf(out, 96, "capacity of the framework");
  else if (physics->bore > 0 && physics->cord_diameter > 0 &&
           thr_bore_fits(physics->bore, physics->cord_diameter) == most)
    snprintf(out, 96, "a bore of %.4g mm holds %d %s of %.4g mm: --bore, --cord-diameter",
             physics->bore, most, most == 1 ? "cord" : "cords", physics->cord_diameter);
  else
    snprintf(out, 96, "--capacity");
}

/* Fails if an edge has a capacity below its cover. */
static thr_status check_room(const postman_problem *postman, thr_err *err)
{
  const thr_frame *frame = postman->frame;
  for (int e = 0; e < frame->n_edges; e++) {
    int least = thr_plan_cover(frame, postman->request, e),
        most = thr_plan_capacity(frame, postman->request, e);
    if (least > most) {
      char limit[96];
      say_limit(postman, e, limit);
      return thr_fail(
          err, THR_EINFEASIBLE,
          "edge %s-%s needs %d passes, but only %d fit (%s); lower --cover or raise its capacity",
          frame->name[frame->edge[e][0]], frame->name[frame->edge[e][1]], least, most, limit);
    }
  }
  return THR_OK;
}

/* Fails, and names a full edge that leaves a part. */
static thr_status no_room(const postman_problem *postman, int part, const char *why, thr_err *err)
{
  const thr_frame *frame = postman->frame;
  int e = 0;
  while (e + 1 < frame->n_edges &&
         (postman->part[frame->edge[e][0]] == part) == (postman->part[frame->edge[e][1]] == part))
    e++;

  char limit[96];
  say_limit(postman, e, limit);
  return thr_fail(
      err, THR_EINFEASIBLE,
      "edge %s-%s is full with %d %s (%s), as is every edge out of the part with node %s, "
      "which needs one more pass %s",
      frame->name[frame->edge[e][0]], frame->name[frame->edge[e][1]],
      thr_plan_cover(frame, postman->request, e),
      thr_plan_cover(frame, postman->request, e) == 1 ? "pass" : "passes", limit, frame->name[part],
      why);
}

/* Fails where the odd nodes of a part are odd in number and no cord may end there, as extra passes
 * cannot leave a part; or where more cords would have to end than there are. */
static thr_status check_parts(const postman_problem *postman, thr_err *err)
{
  const thr_frame *frame = postman->frame;
  size_t n = (size_t)frame->n_nodes;
  bool *odd = thr_calloc(n, sizeof *odd), *open = thr_calloc(n, sizeof *open);
  int *ends = thr_calloc(n, sizeof *ends);
  thr_status st = odd && open && ends ? THR_OK : thr_nomem(err);

  /* Each part: whether its number of odd nodes is odd, and whether a cord may end there. */
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    odd[postman->part[v]] ^= postman->odd[v];
    open[postman->part[v]] |=
        ends_free(postman) && thr_plan_end_allowed(frame, postman->request, v);
  }

  /* A part that is odd takes one end. */
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    if (!odd[v]) continue; /* only roots are marked */
    if (!open[v])
      st = no_room(postman, v, "to make their number even", err);
    else if (++ends[postman->component[v]] > 2 * postman->request->cords)
      st = no_room(postman, v, "or more cords to end there", err);
  }

  free(odd);
  free(open);
  free(ends);
  return st;
}

/* Fails if cords can end nowhere in a component, or if the ends that are given are not those of as
 * many cords as asked for. */
static thr_status check_ends(const postman_problem *postman, thr_err *err)
{
  const thr_frame *frame = postman->frame;
  int *ends = thr_calloc((size_t)postman->n_components, sizeof *ends),
      *first = thr_calloc((size_t)postman->n_components, sizeof *first);
  thr_status st = ends && first ? THR_OK : thr_nomem(err);

  /* How many ends there can be, or are given, in each component. */
  for (int v = frame->n_nodes - 1; v >= 0 && !st; v--) {
    first[postman->component[v]] = v;
    ends[postman->component[v]] += postman->request->ends == THR_ENDS_COUNTS
                                       ? postman->request->end_count[v]
                                       : thr_plan_end_allowed(frame, postman->request, v);
  }

  /* Counted ends have to be two for each of as many cords as asked for. */
  for (int k = 0; k < postman->n_components && !st; k++) {
    const char *name = frame->name[first[k]];
    if (ends[k] == 0)
      st = thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s has no node where a cord may end; name one with "
                    "--feet (try --feet lowest) or "
                    "--ends, or use "
                    "--ends closed",
                    name);
    else if (postman->request->ends == THR_ENDS_COUNTS &&
             (ends[k] % 2 || ends[k] / 2 > postman->request->cords ||
              ends[k] / 2 < postman->request->cords_least))
      st = thr_fail(err, THR_EINFEASIBLE,
                    "the component with node %s: %d cord ends do not make %d %s; each has two",
                    name, ends[k], postman->request->cords,
                    postman->request->cords == 1 ? "cord" : "cords");
  }

  free(ends);
  free(first);
  return st;
}

/* Releases what is not moved to the results. */
static void postman_destroy(postman_problem *postman)
{
  for (int k = 0; postman->certificate && k < postman->n_components; k++)
    thr_certificate_destroy(&postman->certificate[k]);
  free(postman->certificate);
  thr_confirmations_destroy(&postman->confirmed);
  free(postman->passes);
  thr_scratch_free(&postman->own);
}

/* Sorts items by key (counting sort). start[keys + 2] is all 0: it is shifted by one place so that
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

/* Finds parts and domains; leaves in key[n_nodes] the number of each node's domain. */
static void find_domains(postman_problem *postman, int *key)
{
  const thr_frame *frame = postman->frame;

  for (int v = 0; v < frame->n_nodes; v++)
    postman->part[v] = postman->domain[v] = v;

  /* Edges with room join the nodes of a part. */
  for (int e = 0; e < frame->n_edges; e++) {
    if (!has_room(postman, e)) continue;
    thr_disjoint_join(postman->part, frame->edge[e][0], frame->edge[e][1]);
    thr_disjoint_join(postman->domain, frame->edge[e][0], frame->edge[e][1]);
  }

  /* Nodes of a component where cords may end belong to one domain. */
  for (int k = 0; k < postman->n_components; k++)
    key[k] = -1; /* a node of this component where cords may end */
  for (int v = 0; v < frame->n_nodes && ends_free(postman); v++) {
    if (!thr_plan_end_allowed(frame, postman->request, v)) continue;
    int *end = &key[postman->component[v]];
    if (*end >= 0) thr_disjoint_join(postman->domain, *end, v);
    *end = v;
  }

  /* Number the domains by their lowest nodes. */
  for (int v = 0; v < frame->n_nodes; v++) {
    postman->part[v] = thr_disjoint_find(postman->part, v);
    int root = thr_disjoint_find(postman->domain, v); /* the lowest: it has its number already */
    key[v] = root == v ? postman->n_domains++ : key[root];
  }
}

/* Allocates the arrays. */
static thr_status postman_allocate(postman_problem *postman, thr_err *err)
{
  size_t n = (size_t)postman->frame->n_nodes, e = (size_t)postman->frame->n_edges,
         k = (size_t)postman->n_components;
  postman->edge_start = thr_scratch_array(&postman->own, k + 2, sizeof *postman->edge_start);
  postman->edge = thr_scratch_array(&postman->own, e, sizeof *postman->edge);
  postman->part = thr_scratch_array(&postman->own, n, sizeof *postman->part);
  postman->domain = thr_scratch_array(&postman->own, n, sizeof *postman->domain);
  postman->start = thr_scratch_array(&postman->own, n + 2, sizeof *postman->start);
  postman->node = thr_scratch_array(&postman->own, n, sizeof *postman->node);
  postman->local = thr_scratch_array(&postman->own, n, sizeof *postman->local);
  postman->odd = thr_scratch_array(&postman->own, n, sizeof *postman->odd);

  /* Results, which are moved out. */
  postman->passes = thr_calloc(e, sizeof *postman->passes);
  postman->certificate = thr_calloc(k, sizeof *postman->certificate);
  return postman->passes && postman->certificate ? thr_scratch_check(&postman->own, err)
                                                 : thr_nomem(err);
}

/* Starts the certificate of each component, with the scale of its weights. */
static void start_certificates(postman_problem *postman)
{
  for (int k = 0; k < postman->n_components; k++) {
    thr_certificate *certificate = &postman->certificate[k];
    certificate->component = k;
    certificate->denominator = ends_free(postman) ? 2 * THR_DUAL_DENOMINATOR : THR_DUAL_DENOMINATOR;
    certificate->scale = choose_scale(postman->frame, postman->edge + postman->edge_start[k],
                                      postman->edge_start[k + 1] - postman->edge_start[k]);
  }
}

/* Finds components, parts, domains and odd nodes, with the covers as passes. */
static thr_status postman_init(postman_problem *postman, thr_err *err)
{
  const thr_frame *frame = postman->frame;

  size_t most = (size_t)(frame->n_nodes > frame->n_edges ? frame->n_nodes : frame->n_edges);

  int *key = thr_calloc(most, sizeof *key);
  postman->component =
      thr_scratch_array(&postman->own, (size_t)frame->n_nodes, sizeof *postman->component);
  thr_status st = key && postman->component
                      ? thr_frame_components(frame, postman->component, &postman->n_components, err)
                      : thr_nomem(err);

  if (!st) st = postman_allocate(postman, err);
  if (!st) {
    /* Edges by component. */
    for (int e = 0; e < frame->n_edges; e++)
      key[e] = postman->component[frame->edge[e][0]];
    group(frame->n_edges, key, postman->n_components, postman->edge_start, postman->edge);

    /* Nodes by domain, and the position of each in its domain. */
    find_domains(postman, key);
    group(frame->n_nodes, key, postman->n_domains, postman->start, postman->node);
    for (int d = 0; d < postman->n_domains; d++)
      for (int j = postman->start[d]; j < postman->start[d + 1]; j++)
        postman->local[postman->node[j]] = j - postman->start[d];

    /* A counted end makes its node odd, and so does each pass of a cover. */
    for (int v = 0; v < frame->n_nodes; v++)
      postman->odd[v] =
          postman->request->ends == THR_ENDS_COUNTS && postman->request->end_count[v] % 2;
    for (int e = 0; e < frame->n_edges; e++) {
      postman->passes[e] = thr_plan_cover(frame, postman->request, e);
      for (int i = 0; i < 2; i++)
        postman->odd[frame->edge[e][i]] ^= postman->passes[e] % 2 != 0;
    }

    start_certificates(postman);
  }
  free(key);
  return st;
}

/* Moves the results out, and lets the checker say what the certificates prove. */
static thr_status judge(postman_problem *postman, thr_shortest *out, thr_err *err)
{
  thr_err found = {0};
  *out = (thr_shortest){.passes = postman->passes,
                        .n_certificates = postman->n_components,
                        .certificate = postman->certificate,
                        .confirmed = postman->confirmed};

  /* They are the caller's from here on. */
  postman->passes = NULL;
  postman->certificate = NULL;

  for (int e = 0; e < postman->frame->n_edges; e++)
    out->length += out->passes[e] * postman->frame->length[e];
  return thr_check_own(thr_check_length_of_passes(postman->frame, postman->request, out->passes,
                                                  out->certificate, out->n_certificates,
                                                  &out->optimal, &out->lower_bound, &found),
                       &found, err);
}

thr_status thr_postman_shortest(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, thr_shortest *out, thr_err *err)
{
  postman_problem postman = {.frame = frame, .request = options, .limits = limits};
  *out = (thr_shortest){0};
  thr_err unproved = {0}; /* why the first unproved domain is not proved */
  thr_status st = postman_init(&postman, err);
  if (!st) st = check_room(&postman, err);
  if (!st) st = check_ends(&postman, err);
  if (!st) st = check_parts(&postman, err);

  /* Domains that are not proved to be shortest still leave their best passes. */
  for (int d = 0; d < postman.n_domains && !st; d++) {
    thr_err local = {0};
    st = solve_domain(&postman, d, &local);
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", local.text);

    if (st != THR_ELIMIT) continue;
    thr_fail(&unproved, st, "%s", local.text);
    st = THR_OK; /* the others still get their (quick) best */
  }

  if (!st) st = thr_confirmations_run(counter(&postman), limits, err);
  if (!st) st = judge(&postman, out, err);

  /* Say what is proved of passes that may not be the shortest. */
  if (!st && !out->optimal) {
    char what[sizeof unproved.text + 20];
    snprintf(what, sizeof what, "%s: the cord's length",
             unproved.code ? unproved.text : "too many edges to round their lengths finely enough");
    st = thr_not_proved(err, what, out->length, out->lower_bound);
  }

  if (st && st != THR_ELIMIT) thr_shortest_destroy(out);
  postman_destroy(&postman);
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
