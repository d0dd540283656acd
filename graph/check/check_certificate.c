/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Certificates: odd cuts, added up over trees of nested sets. */
#include "graph/check/check_parts.h"

#include <inttypes.h>
#include <math.h>

typedef thr_wide wide;

int64_t thr_certificate_weight(const thr_frame *frame, const thr_certificate *certificate, int e)
{
  return (int64_t)nearbyint(frame->length[e] * certificate->scale);
}

/* Work space over the framework. Each component has one certificate: what is filled in at its nodes
 * and edges stays. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_check_walked *w;
  int *start, *node;      /* nodes of component k: node[start[k] .. start[k + 1] - 1] */
  int *edge_start, *edge; /* its edges likewise */
  int *cords;             /* [n_components] that a component has at most */
  bool *odd;              /* [n_nodes] */
  int *far_start, *far;   /* at v, the other ends of its edges to nodes with more edges: at most
                             sqrt(2 * n_edges) of them */
  int *far_edge;          /* those edges */
  wide *held;             /* [n_nodes] sum of the values of the sets that hold a node */
  wide *shared;           /* [n_edges] sum of the values of the sets that hold both ends */
  int *own; /* [n_nodes] cut of the present tree whose own node this is, else -1; no tree's between
               trees */
  int64_t *price;   /* [n_nodes] of a place for a cord end there */
  int *loop, *work; /* [n_edges] in the order of edge, once they are asked for: thr_prices_loops */
  thr_scratch scratch; /* the arrays */
} workspace;

/* The cuts of one certificate as a forest. Arrays of n_cuts. */
typedef struct {
  const thr_certificate *c;
  int *first, *next; /* at a root, first cut of its tree; next one of the same tree; -1 = none */
  int *root, *size;  /* last cut of its tree; cuts below it and itself */
  int *heavy, *head; /* child with the largest size, or -1; uppermost cut from which heavy children
                        lead here */
  wide *depth;       /* sum of the values from the root to here */
  bool *odd;         /* is the number of odd nodes in the set? */
  thr_scratch own;   /* the arrays */
} forest;

static void forest_destroy(forest *t)
{
  thr_scratch_free(&t->own);
}

static thr_status forest_init(forest *t, const thr_certificate *certificate, thr_err *err)
{
  size_t n = (size_t)certificate->n_cuts;
  *t = (forest){.c = certificate};
  t->first = thr_scratch_array(&t->own, n, sizeof *t->first);
  t->next = thr_scratch_array(&t->own, n, sizeof *t->next);
  t->root = thr_scratch_array(&t->own, n, sizeof *t->root);
  t->size = thr_scratch_array(&t->own, n, sizeof *t->size);
  t->heavy = thr_scratch_array(&t->own, n, sizeof *t->heavy);
  t->head = thr_scratch_array(&t->own, n, sizeof *t->head);
  t->depth = thr_scratch_array(&t->own, n, sizeof *t->depth);
  t->odd = thr_scratch_array(&t->own, n, sizeof *t->odd);
  if (thr_scratch_check(&t->own, err)) return THR_ENOMEM;
  for (int i = 0; i < certificate->n_cuts; i++)
    t->first[i] = t->next[i] = t->heavy[i] = -1;
  return THR_OK;
}

static thr_status check_cut(const workspace *k, const thr_certificate *certificate, int i,
                            thr_err *err)
{
  const thr_cut *cut = &certificate->cut[i];
  if (cut->value < 0)
    return thr_fail(err, THR_EVIOLATED,
                    "certificate of component %d, cut %d: multiplier %" PRId64 " is negative",
                    certificate->component, i, cut->value);
  if (cut->parent != -1 && (cut->parent <= i || cut->parent >= certificate->n_cuts))
    return thr_fail(err, THR_EVIOLATED,
                    "certificate of component %d, cut %d: its parent %d is not a later cut",
                    certificate->component, i, cut->parent);
  for (int j = 0; j < cut->n_nodes; j++) {
    int v = cut->node[j];
    if (j > 0 && v <= cut->node[j - 1])
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d, cut %d: nodes are not ascending at %d",
                      certificate->component, i, v);
    if (k->w->component[v] != certificate->component)
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d, cut %d: node %d is in component %d",
                      certificate->component, i, v, k->w->component[v]);
  }
  return THR_OK;
}

/* Children come before their parents: sizes and parities go up, roots, depths and heavy paths down.
 */
static thr_status forest_fill(forest *t, const workspace *k, thr_err *err)
{
  const thr_certificate *certificate = t->c;
  for (int i = 0; i < certificate->n_cuts; i++) {
    thr_status st = check_cut(k, certificate, i, err);
    if (st) return st;
    int p = certificate->cut[i].parent;
    for (int j = 0; j < certificate->cut[i].n_nodes; j++)
      t->odd[i] ^= k->odd[certificate->cut[i].node[j]];
    if (!t->odd[i])
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d, cut %d: holds an even number of odd nodes",
                      certificate->component, i);
    t->size[i]++;
    if (p < 0) continue;
    t->odd[p] ^= true;
    t->size[p] += t->size[i];
    if (t->heavy[p] < 0 || t->size[i] > t->size[t->heavy[p]]) t->heavy[p] = i;
  }
  for (int i = certificate->n_cuts - 1; i >= 0; i--) {
    int p = certificate->cut[i].parent, root = p < 0 ? i : t->root[p];
    t->depth[i] = certificate->cut[i].value + (p < 0 ? 0 : t->depth[p]);
    t->head[i] = p >= 0 && t->heavy[p] == i ? t->head[p] : i;
    t->root[i] = root;
    t->next[i] = t->first[root];
    t->first[root] = i;
  }
  return THR_OK;
}

/* Lowest cut round both. Of two heavy paths the one that starts earlier in the list does not hold
 * it. */
static int common_cut(const forest *t, int a, int b)
{
  while (t->head[a] != t->head[b]) {
    if (t->head[a] < t->head[b])
      a = t->c->cut[t->head[a]].parent;
    else
      b = t->c->cut[t->head[b]].parent;
  }
  return a > b ? a : b;
}

static thr_status mark_tree(workspace *k, const forest *t, int root, thr_err *err)
{
  for (int i = t->first[root]; i >= 0; i = t->next[i])
    for (int j = 0; j < t->c->cut[i].n_nodes; j++) {
      int v = t->c->cut[i].node[j];
      if (k->own[v] >= 0)
        return thr_fail(
            err, THR_EVIOLATED,
            "certificate of component %d, cut %d: node %d is in cut %d, too, which is not inside",
            t->c->component, i, v, k->own[v]);
      k->own[v] = i;
    }
  return THR_OK;
}

/* Adds the values of a tree's cuts to the nodes in their sets, and to the edges inside them: both
 * ends of an edge are in the sets round the lowest one that holds them. A node may be in many
 * trees, so edges are looked at from the end with fewer of them. */
static void load_tree(workspace *k, const forest *t, int root)
{
  for (int i = t->first[root]; i >= 0; i = t->next[i])
    for (int j = 0; j < t->c->cut[i].n_nodes; j++) {
      int v = t->c->cut[i].node[j];
      k->held[v] += t->depth[i];
      for (int x = k->far_start[v]; x < k->far_start[v + 1]; x++) {
        int other = k->own[k->far[x]];
        if (other >= 0) k->shared[k->far_edge[x]] += t->depth[common_cut(t, i, other)];
      }
    }
  for (int i = t->first[root]; i >= 0; i = t->next[i])
    for (int j = 0; j < t->c->cut[i].n_nodes; j++)
      k->own[t->c->cut[i].node[j]] = -1;
}

/* Edge number j of all, by component. */
static thr_priced priced(const workspace *k, const thr_certificate *certificate, int j)
{
  int e = k->edge[j];
  bool closed = k->o->ends == THR_ENDS_CLOSED;
  wide of = closed ? (certificate->n_prices ? certificate->place_price[0] : 0)
                   : (wide)k->price[k->f->edge[e][0]] + k->price[k->f->edge[e][1]];
  return thr_prices_edge(
      k->f, k->o, e, (wide)thr_certificate_weight(k->f, certificate, e) * certificate->denominator,
      of, closed && certificate->n_prices && k->loop ? k->loop[j] : 2); /* find_loops comes first */
}

/* Prices at nodes, the parity of nodes at these prices, and in *places, which is 0 before, what all
 * that adds to the bound. */
static thr_status apply_prices(workspace *k, const thr_certificate *certificate, wide *places,
                               thr_err *err)
{
  const thr_frame *frame = k->f;
  const thr_request *options = k->o;
  int first = k->start[certificate->component], n = k->start[certificate->component + 1] - first;
  if (certificate->n_prices == 0) return THR_OK;
  if (certificate->n_prices != thr_prices_number(options, n))
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d: %d place prices; expected %d",
                    certificate->component, certificate->n_prices, thr_prices_number(options, n));
  for (int i = 0; i < certificate->n_prices; i++)
    if (certificate->place_price[i] < 0)
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d: place price %" PRId64 " is negative",
                      certificate->component, certificate->place_price[i]);
  for (int i = 0; i < n && options->ends != THR_ENDS_CLOSED; i++) {
    int v = k->node[first + i];
    if (thr_plan_end_allowed(frame, options, v))
      k->price[v] = certificate->place_price[options->ends == THR_ENDS_COUNTS ? i : 0];
    if (options->ends == THR_ENDS_COUNTS) *places += (wide)k->price[v] * options->end_count[v];
  }
  if (options->ends != THR_ENDS_COUNTS)
    *places = 2 * (wide)options->cords_least * certificate->place_price[0];
  for (int j = k->edge_start[certificate->component]; j < k->edge_start[certificate->component + 1];
       j++) {
    const int *end = frame->edge[k->edge[j]];
    thr_priced p = priced(k, certificate, j);
    if (p.room && p.endless)
      return thr_fail(
          err, THR_EVIOLATED,
          "certificate of component %d: place prices make edge %d cheaper the more it is passed",
          certificate->component, k->edge[j]);
    bool odd = p.room && p.odd < p.even;
    *places += (odd ? p.odd : p.even) - p.held;
    k->odd[end[0]] ^= odd;
    k->odd[end[1]] ^= odd;
  }
  return THR_OK;
}

static thr_status check_loads(const workspace *k, const thr_certificate *certificate, thr_err *err)
{
  for (int j = k->edge_start[certificate->component]; j < k->edge_start[certificate->component + 1];
       j++) {
    int e = k->edge[j];
    wide load = k->held[k->f->edge[e][0]] + k->held[k->f->edge[e][1]] - 2 * k->shared[e];
    if (load <= 0) continue; /* bears any price */
    thr_priced p = priced(k, certificate, j);
    if (p.room && load > (p.odd > p.even ? p.odd - p.even : p.even - p.odd))
      return thr_fail(
          err, THR_EVIOLATED,
          "certificate of component %d: the cuts over edge %d add up to more than its weight",
          certificate->component, e);
  }
  if (!thr_check_ends_free(k->o)) return THR_OK;
  for (int j = k->start[certificate->component]; j < k->start[certificate->component + 1]; j++) {
    int v = k->node[j];
    if (thr_plan_end_allowed(k->f, k->o, v) && k->held[v] > certificate->end_price)
      return thr_fail(
          err, THR_EVIOLATED,
          "certificate of component %d: the cuts round node %d add up to more than the end price",
          certificate->component, v);
  }
  return THR_OK;
}

/* Least weight of extra passes that leave so many ends; weights are integers, and nothing fits
 * between the bound and the next. */
static wide least_weight(const thr_certificate *certificate, wide places, int64_t ends)
{
  wide proved = certificate->sum + places - (wide)ends * certificate->end_price;
  return proved > 0 ? (proved + certificate->denominator - 1) / certificate->denominator : 0;
}

/* Least weight of extra passes that leave so many ends, as a length: what rounding may have added
 * is taken off. Passes x cost at least (1 - r) w x / scale less what each edge's rounding adds
 * above its part r, whatever r is; two of them are tried. */
double thr_check_extra(const thr_certificate *certificate, const thr_check_verdict *check_verdict,
                       int64_t ends)
{
  double weight =
      (double)least_weight(certificate, check_verdict->places, ends) / certificate->scale;
  return fmax(0, fmax(weight - check_verdict->rounding,
                      weight * (1 - THR_CHECK_ROUNDING) - check_verdict->rounding_above));
}

/* Extra passes of an edge in some shortest plan, at the most. Two passes less leave parity and ends
 * as they are; and where more passes than 2 cords run over an edge, one cord has three of them, and
 * can do without two. */
static int most_extra(const workspace *k, const thr_certificate *certificate, int e)
{
  int cover = thr_plan_cover(k->f, k->o, e), room = thr_plan_capacity(k->f, k->o, e) - cover;
  int most = certificate->n_prices > 0 && 2 * k->cords[certificate->component] - cover > 1
                 ? 2 * k->cords[certificate->component] - cover
                 : 1;
  return most < room ? most : room;
}

/* As fmax(0, x), in one instruction instead of a call. */
static inline double at_least_0(double x)
{
  return x > 0 ? x : 0;
}

/* What rounding an edge's length up to its weight may add to a bound. */
static void charge_rounding(const workspace *k, const thr_certificate *certificate, int e,
                            int64_t units, thr_check_verdict *out)
{
  double weight = (double)units / certificate->scale, added = weight - k->f->length[e];
  int most = most_extra(k, certificate, e);
  out->rounding += at_least_0(added) * most;
  out->rounding_above += at_least_0(added - THR_CHECK_ROUNDING * weight) * most;
}

/* Compares the stated sums with the true ones, and says what they prove. */
static thr_status judge(const workspace *k, const thr_certificate *certificate, wide sum,
                        wide places, thr_check_verdict *out, thr_err *err)
{
  bool weightless = false; /* a scale may round what passes cost to nothing */
  wide join = 0;
  double total = 0, extra = 0;
  *out = (thr_check_verdict){.places = places};
  for (int j = k->edge_start[certificate->component]; j < k->edge_start[certificate->component + 1];
       j++) {
    int e = k->edge[j], more = k->w->passes[e] - thr_plan_cover(k->f, k->o, e);
    int64_t weight = thr_certificate_weight(k->f, certificate, e);
    join += (wide)weight * more;
    weightless |= more > 0 && weight == 0;
    extra += k->f->length[e] * more;
    total += k->f->length[e];
    charge_rounding(k, certificate, e, weight, out);
  }
  if (sum != certificate->sum)
    return thr_fail(
        err, THR_EVIOLATED,
        "certificate of component %d: the multipliers do not add up to the stated sum %" PRId64,
        certificate->component, certificate->sum);
  if (join != certificate->join)
    return thr_fail(
        err, THR_EVIOLATED,
        "certificate of component %d: the extra passes do not weigh the stated %" PRId64,
        certificate->component, certificate->join);
  int cords = thr_plan_fewest_first(k->o) ? k->w->cords[certificate->component] : k->o->cords;
  int64_t ends = thr_check_ends_free(k->o) ? 2 * (int64_t)cords : 0;
  if (least_weight(certificate, places, ends) > join)
    return thr_fail(
        err, THR_EVIOLATED,
        "certificate of component %d: its bound is above the weight of the plan's own extra passes",
        certificate->component);
  out->extra = thr_check_extra(certificate, out, ends);
  bool attained = !weightless && least_weight(certificate, places, ends) >= join;
  out->optimal = extra == 0 || (attained && extra - out->extra <= 1e-9 * total);
  return THR_OK;
}

static thr_status check_numbers(const workspace *k, const thr_certificate *certificate,
                                thr_err *err)
{
  if (!(certificate->scale > 0) || certificate->denominator < 1)
    return thr_fail(err, THR_EVIOLATED,
                    "certificate of component %d: scale and denominator must be positive",
                    certificate->component);
  for (int j = k->edge_start[certificate->component]; j < k->edge_start[certificate->component + 1];
       j++) {
    int e = k->edge[j];
    if (!(k->f->length[e] * certificate->scale < 1e18))
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d: scale is too large for edge %d",
                      certificate->component, e);
  }
  if (certificate->end_price < 0 || (certificate->end_price > 0 && !thr_check_ends_free(k->o)))
    return thr_fail(err, THR_EVIOLATED,
                    "certificate of component %d: an end price of %" PRId64 " does not fit ends %s",
                    certificate->component, certificate->end_price, thr_ends_name(k->o->ends));
  return THR_OK;
}

static thr_status find_loops(workspace *k, int component, thr_err *err)
{
  const int first = k->edge_start[component], n = k->edge_start[component + 1] - first;
  if (!k->loop) k->loop = thr_scratch_array(&k->scratch, (size_t)k->f->n_edges, sizeof *k->loop);
  if (!k->work)
    k->work = thr_scratch_array(&k->scratch, 2 * (size_t)k->f->n_nodes, sizeof *k->work);
  if (thr_scratch_check(&k->scratch, err)) return THR_ENOMEM;
  thr_prices_loops(k->f, k->edge + first, n, k->work, k->loop + first);
  return THR_OK;
}

static thr_status run_certificate(workspace *k, const thr_certificate *certificate,
                                  thr_check_verdict *out, thr_err *err)
{
  forest t = {0};
  wide sum = 0, places = 0;
  thr_status st = check_numbers(k, certificate, err);
  if (!st && certificate->n_prices > 0 && k->o->ends == THR_ENDS_CLOSED)
    st = find_loops(k, certificate->component, err);
  if (!st) st = apply_prices(k, certificate, &places, err);
  if (!st) st = forest_init(&t, certificate, err);
  if (!st) st = forest_fill(&t, k, err);
  for (int i = 0; i < certificate->n_cuts && !st; i++) {
    sum += certificate->cut[i].value;
    if (t.root[i] != i) continue;
    st = mark_tree(k, &t, i, err);
    if (!st) load_tree(k, &t, i);
  }
  if (!st) st = check_loads(k, certificate, err);
  if (!st) st = judge(k, certificate, sum, places, out, err);
  forest_destroy(&t);
  return st;
}

static void workspace_destroy(workspace *k)
{
  thr_scratch_free(&k->scratch);
}

/* Groups nodes and edges by component: counting sort, shifted by one place so that filling leaves
 * the starts right. */
static void group(workspace *k)
{
  const thr_frame *frame = k->f;
  const int *component = k->w->component;
  for (int v = 0; v < frame->n_nodes; v++)
    k->start[component[v] + 2]++;
  for (int e = 0; e < frame->n_edges; e++)
    k->edge_start[component[frame->edge[e][0]] + 2]++;
  for (int i = 1; i <= frame->n_nodes; i++) {
    k->start[i + 1] += k->start[i];
    k->edge_start[i + 1] += k->edge_start[i];
  }
  for (int v = 0; v < frame->n_nodes; v++)
    k->node[k->start[component[v] + 1]++] = v;
  for (int e = 0; e < frame->n_edges; e++)
    k->edge[k->edge_start[component[frame->edge[e][0]] + 1]++] = e;
}

/* Every edge at its end with fewer edges. */
static void point(workspace *k)
{
  const thr_frame *frame = k->f;
  for (int v = 0, n = 0; v < frame->n_nodes; v++) {
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int other = thr_head(frame, frame->half[i]),
          more = thr_degree(frame, other) - thr_degree(frame, v);
      if (more < 0 || (more == 0 && other < v)) continue;
      k->far[n] = other;
      k->far_edge[n++] = frame->half[i] >> 1;
    }
    k->far_start[v + 1] = n;
  }
}

static thr_status workspace_init(workspace *k, const thr_frame *frame, const thr_request *options,
                                 const thr_check_walked *check_walked, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  *k = (workspace){.f = frame, .o = options, .w = check_walked};
  k->start = thr_scratch_array(&k->scratch, n + 2, sizeof *k->start);
  k->node = thr_scratch_array(&k->scratch, n, sizeof *k->node);
  k->edge_start = thr_scratch_array(&k->scratch, n + 2, sizeof *k->edge_start);
  k->edge = thr_scratch_array(&k->scratch, m, sizeof *k->edge);
  k->cords = thr_scratch_array(&k->scratch, (size_t)check_walked->n_components, sizeof *k->cords);
  k->odd = thr_scratch_array(&k->scratch, n, sizeof *k->odd);
  k->far_start = thr_scratch_array(&k->scratch, n + 1, sizeof *k->far_start);
  k->far = thr_scratch_array(&k->scratch, m, sizeof *k->far);
  k->far_edge = thr_scratch_array(&k->scratch, m, sizeof *k->far_edge);
  k->held = thr_scratch_array(&k->scratch, n, sizeof *k->held);
  k->shared = thr_scratch_array(&k->scratch, m, sizeof *k->shared);
  k->own = thr_scratch_array(&k->scratch, n, sizeof *k->own);
  k->price = thr_scratch_array(&k->scratch, n, sizeof *k->price);
  if (thr_scratch_check(&k->scratch, err)) return THR_ENOMEM;
  group(k);
  point(k);
  thr_check_most_cords(frame, options, check_walked, k->cords);
  for (int v = 0; v < frame->n_nodes; v++) {
    k->own[v] = -1;
    k->odd[v] = options->ends == THR_ENDS_COUNTS && options->end_count[v] % 2;
  }
  for (int e = 0; e < frame->n_edges; e++)
    for (int i = 0; i < 2; i++)
      k->odd[frame->edge[e][i]] ^= thr_plan_cover(frame, options, e) % 2;
  return THR_OK;
}

thr_status thr_check_certificates(const thr_frame *frame, const thr_request *options,
                                  const thr_check_walked *check_walked,
                                  const thr_certificate *certificate, int n,
                                  thr_check_verdict *verdict, thr_err *err)
{
  workspace k;
  if (n != check_walked->n_components)
    return thr_fail(err, THR_EVIOLATED,
                    "%d certificates for %d components; expected one per component", n,
                    check_walked->n_components);
  thr_status st = workspace_init(&k, frame, options, check_walked, err);
  for (int i = 0; i < n && !st; i++) {
    if (certificate[i].component != i)
      st = thr_fail(err, THR_EVIOLATED,
                    "certificate %d is for component %d; expected one per component in order", i,
                    certificate[i].component);
    else
      st = run_certificate(&k, &certificate[i], &verdict[i], err);
  }
  workspace_destroy(&k);
  return st;
}
