/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks certificates of a shortest length: odd cuts with multipliers, in exact integers.
 *
 * The least extra length is that of a shortest T-join, T being the nodes with an odd number of
 * needed passes. Its linear programming dual packs odd cuts: sets of nodes that hold an odd number
 * of T, with multipliers that add up to at most the weight of each edge they cross (J. Edmonds &
 * E. L. Johnson 1973). So the sum of the multipliers is a lower bound on the extra weight.
 *
 * The sets form forests. The load of an edge is the sum of the multipliers round one end plus that
 * round the other, less twice that of the sets round both; the latter is looked up at the lowest
 * common ancestor of the cuts in which the ends lie (heavy paths). Cord ends at free nodes add an
 * end price, which bounds the multipliers round such a node. Prices of places account for passes
 * that are only needed to hold as many cords as are asked for (graph/plan/plan_measures.h).
 *
 * Example: a path a-b-c of weights 2 and 3 with T = {a, c}: cuts {a} with 2 and {c} with 3 prove
 * that both edges need an extra pass. */
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
  const thr_frame *frame;
  const thr_request *request;
  const thr_check_walked *walked;
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
  const thr_certificate *certificate;
  int *first, *next; /* at a root, first cut of its tree; next one of the same tree; -1 = none */
  int *root, *size;  /* last cut of its tree; cuts below it and itself */
  int *heavy, *head; /* child with the largest size, or -1; uppermost cut from which heavy children
                        lead here */
  wide *depth;       /* sum of the values from the root to here */
  bool *odd;         /* is the number of odd nodes in the set? */
  thr_scratch own;   /* the arrays */
} forest;

/* Allocates the arrays of a forest; no cut is linked yet. Release own with
 * thr_scratch_free. */
static thr_status forest_init(forest *cuts, const thr_certificate *certificate, thr_err *err)
{
  size_t n = (size_t)certificate->n_cuts;
  *cuts = (forest){.certificate = certificate};

  cuts->first = thr_scratch_array(&cuts->own, n, sizeof *cuts->first);
  cuts->next = thr_scratch_array(&cuts->own, n, sizeof *cuts->next);
  cuts->root = thr_scratch_array(&cuts->own, n, sizeof *cuts->root);
  cuts->size = thr_scratch_array(&cuts->own, n, sizeof *cuts->size);
  cuts->heavy = thr_scratch_array(&cuts->own, n, sizeof *cuts->heavy);
  cuts->head = thr_scratch_array(&cuts->own, n, sizeof *cuts->head);
  cuts->depth = thr_scratch_array(&cuts->own, n, sizeof *cuts->depth);
  cuts->odd = thr_scratch_array(&cuts->own, n, sizeof *cuts->odd);

  if (thr_scratch_check(&cuts->own, err)) return THR_ENOMEM;

  for (int i = 0; i < certificate->n_cuts; i++)
    cuts->first[i] = cuts->next[i] = cuts->heavy[i] = -1;
  return THR_OK;
}

/* Checks cut number i by itself: multiplier, parent, and nodes in ascending order in the component.
 */
static thr_status check_cut(const workspace *work, const thr_certificate *certificate, int i,
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

  /* Ascending nodes cannot repeat. */
  for (int j = 0; j < cut->n_nodes; j++) {
    int v = cut->node[j];
    if (j > 0 && v <= cut->node[j - 1])
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d, cut %d: nodes are not ascending at %d",
                      certificate->component, i, v);

    if (work->walked->component[v] != certificate->component)
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d, cut %d: node %d is in component %d",
                      certificate->component, i, v, work->walked->component[v]);
  }

  return THR_OK;
}

/* Checks all cuts and links them to trees. Children come before their parents: sizes and parities
 * go up, roots, depths and heavy paths down. */
static thr_status forest_fill(forest *cuts, const workspace *work, thr_err *err)
{
  const thr_certificate *certificate = cuts->certificate;
  for (int i = 0; i < certificate->n_cuts; i++) {
    thr_status st = check_cut(work, certificate, i, err);
    if (st) return st;

    /* Parity of the odd nodes in the set: its own nodes here, those of its children before. */
    int parent = certificate->cut[i].parent;
    for (int j = 0; j < certificate->cut[i].n_nodes; j++)
      cuts->odd[i] ^= work->odd[certificate->cut[i].node[j]];
    if (!cuts->odd[i])
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d, cut %d: holds an even number of odd nodes",
                      certificate->component, i);

    /* The parent holds all that its child holds. */
    cuts->size[i]++;
    if (parent < 0) continue;
    cuts->odd[parent] ^= true;
    cuts->size[parent] += cuts->size[i];
    if (cuts->heavy[parent] < 0 || cuts->size[i] > cuts->size[cuts->heavy[parent]])
      cuts->heavy[parent] = i;
  }

  /* Downwards: a heavy child continues the path of its parent. */
  for (int i = certificate->n_cuts - 1; i >= 0; i--) {
    int parent = certificate->cut[i].parent, root = parent < 0 ? i : cuts->root[parent];
    cuts->depth[i] = certificate->cut[i].value + (parent < 0 ? 0 : cuts->depth[parent]);
    cuts->head[i] = parent >= 0 && cuts->heavy[parent] == i ? cuts->head[parent] : i;
    cuts->root[i] = root;
    cuts->next[i] = cuts->first[root];
    cuts->first[root] = i;
  }
  return THR_OK;
}

/* Returns the lowest cut round both. Of two different heavy paths the one that starts earlier in
 * the list does not hold it. */
static int common_cut(const forest *cuts, int a, int b)
{
  while (cuts->head[a] != cuts->head[b]) {
    if (cuts->head[a] < cuts->head[b])
      a = cuts->certificate->cut[cuts->head[a]].parent;
    else
      b = cuts->certificate->cut[cuts->head[b]].parent;
  }
  return a > b ? a : b;
}

/* Notes for every node the cut of this tree that names it. Sets of one tree are disjoint or nested,
 * so that no node is named twice. */
static thr_status mark_tree(workspace *work, const forest *cuts, int root, thr_err *err)
{
  for (int i = cuts->first[root]; i >= 0; i = cuts->next[i])
    for (int j = 0; j < cuts->certificate->cut[i].n_nodes; j++) {
      int v = cuts->certificate->cut[i].node[j];
      if (work->own[v] >= 0)
        return thr_fail(
            err, THR_EVIOLATED,
            "certificate of component %d, cut %d: node %d is in cut %d, too, which is not inside",
            cuts->certificate->component, i, v, work->own[v]);
      work->own[v] = i;
    }
  return THR_OK;
}

/* Adds the values of a tree's cuts to the nodes in their sets, and to the edges inside them: both
 * ends of an edge are in the sets round the lowest one that holds them. A node may be in many
 * trees, so edges are looked at from the end with fewer of them. */
static void load_tree(workspace *work, const forest *cuts, int root)
{
  for (int i = cuts->first[root]; i >= 0; i = cuts->next[i])
    for (int j = 0; j < cuts->certificate->cut[i].n_nodes; j++) {
      int v = cuts->certificate->cut[i].node[j];
      work->held[v] += cuts->depth[i];

      /* Edges to nodes that the tree names, too, are shared by all sets round both. */
      for (int place = work->far_start[v]; place < work->far_start[v + 1]; place++) {
        int other = work->own[work->far[place]];
        if (other >= 0)
          work->shared[work->far_edge[place]] += cuts->depth[common_cut(cuts, i, other)];
      }
    }

  /* Leave no marks for the next tree. */
  for (int i = cuts->first[root]; i >= 0; i = cuts->next[i])
    for (int j = 0; j < cuts->certificate->cut[i].n_nodes; j++)
      work->own[cuts->certificate->cut[i].node[j]] = -1;
}

/* Returns what passes over edge number j (by component) cost at the prices of places. */
static thr_priced priced(const workspace *work, const thr_certificate *certificate, int j)
{
  int e = work->edge[j];
  bool closed = work->request->ends == THR_ENDS_CLOSED;

  /* A pass of an open cord has a place at either node; closed cords have one price for all places.
   */
  wide of = closed
                ? (certificate->n_prices ? certificate->place_price[0] : 0)
                : (wide)work->price[work->frame->edge[e][0]] + work->price[work->frame->edge[e][1]];

  return thr_prices_edge(
      work->frame, work->request, e,
      (wide)thr_certificate_weight(work->frame, certificate, e) * certificate->denominator, of,
      closed && certificate->n_prices && work->loop ? work->loop[j]
                                                    : 2); /* find_loops comes first */
}

/* Applies the prices of places: fills prices and parities of nodes, and adds to *places, which is 0
 * before, what all that adds to the bound. */
static thr_status apply_prices(workspace *work, const thr_certificate *certificate, wide *places,
                               thr_err *err)
{
  const thr_frame *frame = work->frame;
  const thr_request *options = work->request;
  int first = work->start[certificate->component],
      n = work->start[certificate->component + 1] - first;
  if (certificate->n_prices == 0) return THR_OK;

  if (certificate->n_prices != thr_prices_number(options, n))
    return thr_fail(err, THR_EVIOLATED, "certificate of component %d: %d place prices; expected %d",
                    certificate->component, certificate->n_prices, thr_prices_number(options, n));

  for (int i = 0; i < certificate->n_prices; i++)
    if (certificate->place_price[i] < 0)
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d: place price %" PRId64 " is negative",
                      certificate->component, certificate->place_price[i]);

  /* Prices of the nodes where cords may end, and those of all places that the cords need. */
  for (int i = 0; i < n && options->ends != THR_ENDS_CLOSED; i++) {
    int v = work->node[first + i];
    if (thr_plan_end_allowed(frame, options, v))
      work->price[v] = certificate->place_price[options->ends == THR_ENDS_COUNTS ? i : 0];
    if (options->ends == THR_ENDS_COUNTS) *places += (wide)work->price[v] * options->end_count[v];
  }

  if (options->ends != THR_ENDS_COUNTS)
    *places = 2 * (wide)options->cords_least * certificate->place_price[0];

  /* With prices an edge may be cheaper with an odd number of extra passes: its ends change their
   * parity. */
  for (int j = work->edge_start[certificate->component];
       j < work->edge_start[certificate->component + 1]; j++) {
    const int *end = frame->edge[work->edge[j]];
    thr_priced cost = priced(work, certificate, j);

    /* An edge whose passes cost less than their places would be passed without end. */
    if (cost.room && cost.endless)
      return thr_fail(
          err, THR_EVIOLATED,
          "certificate of component %d: place prices make edge %d cheaper the more it is passed",
          certificate->component, work->edge[j]);

    bool odd = cost.room && cost.odd < cost.even;
    *places += (odd ? cost.odd : cost.even) - cost.held;
    work->odd[end[0]] ^= odd;
    work->odd[end[1]] ^= odd;
  }
  return THR_OK;
}

/* Checks that no edge bears more than its weight (with prices: than one extra pass more costs), and
 * no node with a free cord end more than the end price. */
static thr_status check_loads(const workspace *work, const thr_certificate *certificate,
                              thr_err *err)
{
  for (int j = work->edge_start[certificate->component];
       j < work->edge_start[certificate->component + 1]; j++) {
    int e = work->edge[j];

    /* The load is the sum of the multipliers of the sets round exactly one end. */
    wide load = work->held[work->frame->edge[e][0]] + work->held[work->frame->edge[e][1]] -
                2 * work->shared[e];
    if (load <= 0) continue; /* bears any price */
    thr_priced cost = priced(work, certificate, j);
    if (cost.room && load > (cost.odd > cost.even ? cost.odd - cost.even : cost.even - cost.odd))
      return thr_fail(
          err, THR_EVIOLATED,
          "certificate of component %d: the cuts over edge %d add up to more than its weight",
          certificate->component, e);
  }

  /* A cord end at a node crosses every set round it. */
  if (!thr_check_ends_free(work->request)) return THR_OK;

  for (int j = work->start[certificate->component]; j < work->start[certificate->component + 1];
       j++) {
    int v = work->node[j];
    if (thr_plan_end_allowed(work->frame, work->request, v) &&
        work->held[v] > certificate->end_price)
      return thr_fail(
          err, THR_EVIOLATED,
          "certificate of component %d: the cuts round node %d add up to more than the end price",
          certificate->component, v);
  }
  return THR_OK;
}

/* Returns the least weight of extra passes with so many cord ends, rounded up to the next integer,
 * as all weights are integers. */
static wide least_weight(const thr_certificate *certificate, wide places, int64_t ends)
{
  wide proved = certificate->sum + places - (wide)ends * certificate->end_price;
  return proved > 0 ? (proved + certificate->denominator - 1) / certificate->denominator : 0;
}

/* Returns the least weight of extra passes as a length, without what rounding may have added.
 * Passes x cost at least (1 - r) w x / scale less what rounding adds to each edge beyond its part
 * r, for any r; r = 0 and THR_CHECK_ROUNDING are tried. */
double thr_check_extra(const thr_certificate *certificate, const thr_check_verdict *check_verdict,
                       int64_t ends)
{
  double weight =
      (double)least_weight(certificate, check_verdict->places, ends) / certificate->scale;
  return fmax(0, fmax(weight - check_verdict->rounding,
                      weight * (1 - THR_CHECK_ROUNDING) - check_verdict->rounding_above));
}

/* Returns the largest number of extra passes of an edge in some shortest plan. Two passes less
 * leave parity and ends as they are; and where more than 2 passes a cord run over an edge, one cord
 * has three of them and can do without two. */
static int most_extra(const workspace *work, const thr_certificate *certificate, int e)
{
  int cover = thr_plan_cover(work->frame, work->request, e),
      capacity = thr_plan_capacity(work->frame, work->request, e) - cover;
  int most = certificate->n_prices > 0 && 2 * work->cords[certificate->component] - cover > 1
                 ? 2 * work->cords[certificate->component] - cover
                 : 1;
  return most < capacity ? most : capacity;
}

/* As fmax(0, x), in one instruction instead of a call. */
static inline double at_least_0(double x)
{
  return x > 0 ? x : 0;
}

/* Adds to out what rounding an edge's length up to its weight may add to a bound. */
static void charge_rounding(const workspace *work, const thr_certificate *certificate, int e,
                            int64_t units, thr_check_verdict *out)
{
  double weight = (double)units / certificate->scale, added = weight - work->frame->length[e];
  int most = most_extra(work, certificate, e);
  out->rounding += at_least_0(added) * most;
  out->rounding_above += at_least_0(added - THR_CHECK_ROUNDING * weight) * most;
}

/* Compares the stated sums with the true ones, and computes what they prove. */
static thr_status judge(const workspace *work, const thr_certificate *certificate, wide sum,
                        wide places, thr_check_verdict *out, thr_err *err)
{
  bool weightless = false; /* a scale may round what passes cost to nothing */
  wide join = 0;
  double total = 0, extra = 0;
  *out = (thr_check_verdict){.places = places};

  /* Weight and length of the extra passes of the plan. */
  for (int j = work->edge_start[certificate->component];
       j < work->edge_start[certificate->component + 1]; j++) {
    int e = work->edge[j],
        more = work->walked->passes[e] - thr_plan_cover(work->frame, work->request, e);
    int64_t weight = thr_certificate_weight(work->frame, certificate, e);
    join += (wide)weight * more;
    weightless |= more > 0 && weight == 0;
    extra += work->frame->length[e] * more;
    total += work->frame->length[e];
    charge_rounding(work, certificate, e, weight, out);
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

  /* Every free cord end may cross the sets round its node, at the end price. */
  int cords = thr_plan_fewest_first(work->request) ? work->walked->cords[certificate->component]
                                                   : work->request->cords;
  int64_t ends = thr_check_ends_free(work->request) ? 2 * (int64_t)cords : 0;

  /* The bound cannot exceed the weight of this plan. */
  if (least_weight(certificate, places, ends) > join)
    return thr_fail(
        err, THR_EVIOLATED,
        "certificate of component %d: its bound is above the weight of the plan's own extra passes",
        certificate->component);

  /* Optimal if nothing fits between the bound and the weight, and rounding hides nothing. */
  out->extra = thr_check_extra(certificate, out, ends);
  bool attained = !weightless && least_weight(certificate, places, ends) >= join;
  out->optimal = extra == 0 || (attained && extra - out->extra <= 1e-9 * total);
  return THR_OK;
}

/* Checks that the numbers of a certificate are in range, so that its weights fit 64 bits. */
static thr_status check_numbers(const workspace *work, const thr_certificate *certificate,
                                thr_err *err)
{
  if (!(certificate->scale > 0) || certificate->denominator < 1)
    return thr_fail(err, THR_EVIOLATED,
                    "certificate of component %d: scale and denominator must be positive",
                    certificate->component);

  /* Weights are lengths times the scale. */
  for (int j = work->edge_start[certificate->component];
       j < work->edge_start[certificate->component + 1]; j++) {
    int e = work->edge[j];
    if (!(work->frame->length[e] * certificate->scale < 1e18))
      return thr_fail(err, THR_EVIOLATED,
                      "certificate of component %d: scale is too large for edge %d",
                      certificate->component, e);
  }

  if (certificate->end_price < 0 ||
      (certificate->end_price > 0 && !thr_check_ends_free(work->request)))
    return thr_fail(err, THR_EVIOLATED,
                    "certificate of component %d: an end price of %" PRId64 " does not fit ends %s",
                    certificate->component, certificate->end_price,
                    thr_ends_name(work->request->ends));
  return THR_OK;
}

/* Finds how short closed cords over each edge of a component may be; the arrays are allocated once.
 */
static thr_status find_loops(workspace *work, int component, thr_err *err)
{
  const int first = work->edge_start[component], n = work->edge_start[component + 1] - first;
  if (!work->loop)
    work->loop =
        thr_scratch_array(&work->scratch, (size_t)work->frame->n_edges, sizeof *work->loop);
  if (!work->work)
    work->work =
        thr_scratch_array(&work->scratch, 2 * (size_t)work->frame->n_nodes, sizeof *work->work);

  if (thr_scratch_check(&work->scratch, err)) return THR_ENOMEM;
  thr_prices_loops(work->frame, work->edge + first, n, work->work, work->loop + first);
  return THR_OK;
}

/* Checks one certificate and computes its verdict. */
static thr_status run_certificate(workspace *work, const thr_certificate *certificate,
                                  thr_check_verdict *out, thr_err *err)
{
  forest cuts = {0};
  wide sum = 0, places = 0;

  /* Numbers and prices first. */
  thr_status st = check_numbers(work, certificate, err);
  if (!st && certificate->n_prices > 0 && work->request->ends == THR_ENDS_CLOSED)
    st = find_loops(work, certificate->component, err);
  if (!st) st = apply_prices(work, certificate, &places, err);

  /* Link the cuts, and add up their values tree by tree. */
  if (!st) st = forest_init(&cuts, certificate, err);
  if (!st) st = forest_fill(&cuts, work, err);
  for (int i = 0; i < certificate->n_cuts && !st; i++) {
    sum += certificate->cut[i].value;
    if (cuts.root[i] != i) continue;
    st = mark_tree(work, &cuts, i, err);
    if (!st) load_tree(work, &cuts, i);
  }

  if (!st) st = check_loads(work, certificate, err);
  if (!st) st = judge(work, certificate, sum, places, out, err);

  thr_scratch_free(&cuts.own);
  return st;
}

/* Groups nodes and edges by component: a counting sort, shifted by one place so that filling leaves
 * the starts right. */
static void group(workspace *work)
{
  const thr_frame *frame = work->frame;
  const int *component = work->walked->component;
  for (int v = 0; v < frame->n_nodes; v++)
    work->start[component[v] + 2]++;
  for (int e = 0; e < frame->n_edges; e++)
    work->edge_start[component[frame->edge[e][0]] + 2]++;

  /* Sizes become starts. */
  for (int i = 1; i <= frame->n_nodes; i++) {
    work->start[i + 1] += work->start[i];
    work->edge_start[i + 1] += work->edge_start[i];
  }

  for (int v = 0; v < frame->n_nodes; v++)
    work->node[work->start[component[v] + 1]++] = v;
  for (int e = 0; e < frame->n_edges; e++)
    work->edge[work->edge_start[component[frame->edge[e][0]] + 1]++] = e;
}

/* Lists every edge at its end with fewer edges; the smaller number decides between equal ones. */
static void point(workspace *work)
{
  const thr_frame *frame = work->frame;
  for (int v = 0, n = 0; v < frame->n_nodes; v++) {
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int other = thr_head(frame, frame->half[i]),
          more = thr_degree(frame, other) - thr_degree(frame, v);

      if (more < 0 || (more == 0 && other < v)) continue;
      work->far[n] = other;
      work->far_edge[n++] = frame->half[i] >> 1;
    }

    work->far_start[v + 1] = n;
  }
}

/* Allocates the work space and fills what no certificate changes. Release scratch with
 * thr_scratch_free. */
static thr_status workspace_init(workspace *work, const thr_frame *frame,
                                 const thr_request *options, const thr_check_walked *check_walked,
                                 thr_err *err)
{
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  *work = (workspace){.frame = frame, .request = options, .walked = check_walked};
  work->start = thr_scratch_array(&work->scratch, n + 2, sizeof *work->start);
  work->node = thr_scratch_array(&work->scratch, n, sizeof *work->node);
  work->edge_start = thr_scratch_array(&work->scratch, n + 2, sizeof *work->edge_start);
  work->edge = thr_scratch_array(&work->scratch, m, sizeof *work->edge);
  work->cords =
      thr_scratch_array(&work->scratch, (size_t)check_walked->n_components, sizeof *work->cords);
  work->odd = thr_scratch_array(&work->scratch, n, sizeof *work->odd);
  work->far_start = thr_scratch_array(&work->scratch, n + 1, sizeof *work->far_start);
  work->far = thr_scratch_array(&work->scratch, m, sizeof *work->far);
  work->far_edge = thr_scratch_array(&work->scratch, m, sizeof *work->far_edge);
  work->held = thr_scratch_array(&work->scratch, n, sizeof *work->held);
  work->shared = thr_scratch_array(&work->scratch, m, sizeof *work->shared);
  work->own = thr_scratch_array(&work->scratch, n, sizeof *work->own);
  work->price = thr_scratch_array(&work->scratch, n, sizeof *work->price);

  if (thr_scratch_check(&work->scratch, err)) return THR_ENOMEM;

  /* Order by component, edges at one end each. */
  group(work);
  point(work);
  thr_check_most_cords(frame, options, check_walked, work->cords);

  /* Nodes with an odd number of needed passes and given ends. */
  for (int v = 0; v < frame->n_nodes; v++) {
    work->own[v] = -1;
    work->odd[v] = options->ends == THR_ENDS_COUNTS && options->end_count[v] % 2;
  }
  for (int e = 0; e < frame->n_edges; e++)
    for (int i = 0; i < 2; i++)
      work->odd[frame->edge[e][i]] ^= thr_plan_cover(frame, options, e) % 2;
  return THR_OK;
}

thr_status thr_check_certificates(const thr_frame *frame, const thr_request *options,
                                  const thr_check_walked *check_walked,
                                  const thr_certificate *certificate, int n,
                                  thr_check_verdict *verdict, thr_err *err)
{
  workspace work;
  if (n != check_walked->n_components)
    return thr_fail(err, THR_EVIOLATED,
                    "%d certificates for %d components; expected one per component", n,
                    check_walked->n_components);

  thr_status st = workspace_init(&work, frame, options, check_walked, err);
  for (int i = 0; i < n && !st; i++) {
    if (certificate[i].component != i)
      st = thr_fail(err, THR_EVIOLATED,
                    "certificate %d is for component %d; expected one per component in order", i,
                    certificate[i].component);
    else
      st = run_certificate(&work, &certificate[i], &verdict[i], err);
  }

  thr_scratch_free(&work.scratch);
  return st;
}
