/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the shortest extra passes where cord ends need more passes: a minimum-weight perfect
 * matching of ports, after Edmonds and Johnson's reduction of degree constraints.
 *
 * Every possible extra pass has a port at each of its nodes. The two ports are matched with each
 * other if the pass is made, otherwise each one with a core of its group. A group of p ports that
 * needs d passes, or 2, 4, .. more, has p - d cores, which may be matched with each other. A group
 * is a node; or all nodes where cords may end, if ends are free to be at any of them.
 *
 * Example: a node with three ports that needs one pass has two cores: one port is left for its
 * pass, or all three, when the cores are matched with each other. */
#include "graph/check/check.h"
#include "graph/arrays.h"
#include "lp/length/postman.h"

#include <limits.h>

enum { MOST_EDGES = 2000000 }; /* of a matching */

/* The matching problem. */
typedef struct {
  const thr_decomposition *decomposition;
  const thr_certificate *certificate;
  thr_scratch own; /* the arrays */
  int n_groups;
  int *group;       /* [n_nodes] */
  int *need;        /* [n_groups] d */
  int *first, *top; /* [n_groups + 1] ports of a group are first .. first + n_ports - 1, then cores
                       to the next first; next port */
  int *n_ports;     /* [n_groups] */
  int *copies;      /* [n_edges] possible extra passes */
  int n_edges, n_passes;
  int (*edge)[2]; /* the passes come first */
  int64_t *weight;
} port_graph;

/* Returns the number of passes at a node. */
static int passes_at(const thr_frame *frame, const int *passes, int v)
{
  int sum = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    sum += passes[frame->half[i] >> 1];
  return sum;
}

/* Returns the sum of the covers of the edges at a node. */
static int covers_at(const thr_decomposition *decomposition, int v)
{
  int sum = 0;
  for (int i = decomposition->f->first[v]; i < decomposition->f->first[v + 1]; i++)
    sum += thr_plan_cover(decomposition->f, decomposition->o, decomposition->f->half[i] >> 1);
  return sum;
}

/* Returns whether the passes arrive often enough where cords may end for the ends of n cords. */
static bool enough_places(const thr_decomposition *decomposition, int n)
{
  int free_places = 0;
  for (int v = 0; v < decomposition->f->n_nodes; v++) {
    if (!thr_plan_end_allowed(decomposition->f, decomposition->o, v)) continue;

    /* Counted ends are needed at their nodes; free ones at any. */
    int at = passes_at(decomposition->f, decomposition->passes, v);
    if (decomposition->o->ends == THR_ENDS_COUNTS && at < decomposition->o->end_count[v])
      return false;
    if (free_places < INT_MAX / 2) free_places += at;
  }
  return decomposition->o->ends == THR_ENDS_COUNTS || free_places >= 2 * n;
}

/* Finds the groups, and the passes that they need beyond the cover for n cords. */
static void find_groups(port_graph *ports, int n)
{
  const thr_decomposition *decomposition = ports->decomposition;
  bool counts = decomposition->o->ends == THR_ENDS_COUNTS;
  int joint = -1; /* the group of all places where ends are free to be */
  for (int v = 0; v < decomposition->f->n_nodes; v++) {
    bool end = thr_plan_end_allowed(decomposition->f, decomposition->o, v);
    int group = !counts && end && joint >= 0 ? joint : ports->n_groups++;
    if (!counts && end && joint < 0) {
      joint = group;
      ports->need[group] = 2 * n;
    } else if (counts) {
      ports->need[group] = decomposition->o->end_count[v];
    }

    /* What the cover gives counts for the need. */
    ports->group[v] = group;
    ports->need[group] -= covers_at(decomposition, v);
  }

  /* A group with more than enough passes only has to keep their number even. */
  for (int group = 0; group < ports->n_groups; group++)
    if (ports->need[group] < 0) ports->need[group] = -ports->need[group] % 2;
}

/* Counts the ports of all groups. An edge has no more of them than its groups may need extra passes
 * of it. */
static thr_status count_ports(port_graph *ports, thr_err *err)
{
  const thr_decomposition *decomposition = ports->decomposition;
  int64_t edges = 0;
  for (int e = 0; e < decomposition->f->n_edges; e++) {
    int a = ports->group[decomposition->f->edge[e][0]],
        b = ports->group[decomposition->f->edge[e][1]];

    /* A pass between two nodes of one group serves the group twice. */
    int most = a == b                            ? (ports->need[a] + 1) / 2
               : ports->need[a] > ports->need[b] ? ports->need[a]
                                                 : ports->need[b];

    int room = thr_plan_capacity(decomposition->f, decomposition->o, e) -
               thr_plan_cover(decomposition->f, decomposition->o, e);

    /* One extra pass at least, for parity. */
    if (most < 1) most = 1;
    ports->copies[e] = most < room ? most : room;
    ports->n_ports[a] += ports->copies[e];
    ports->n_ports[b] += ports->copies[e];
    ports->n_passes += ports->copies[e];
  }

  /* The edges of the matching problem, which may become too many. */
  for (int group = 0; group < ports->n_groups; group++) {
    int64_t cores = ports->n_ports[group] - ports->need[group];
    if (cores >= 0) edges += cores * ports->n_ports[group] + cores * (cores - 1) / 2;
  }

  if (edges + ports->n_passes > MOST_EDGES)
    return thr_fail(
        err, THR_ELIMIT,
        "too many ends, at nodes with too many edges, to find the shortest extra passes for them");
  ports->n_edges = (int)edges + ports->n_passes;
  return THR_OK;
}

/* Fails, and names a node of a group that has too few ports. */
static thr_status no_room(const port_graph *ports, int group, thr_err *err)
{
  int v = 0;
  while (ports->group[v] != group)
    v++;
  return thr_fail(err, THR_EINFEASIBLE,
                  "the edges at node %s%s have no room for enough passes: their capacity allows "
                  "fewer cord ends than asked for",
                  ports->decomposition->f->name[v],
                  ports->decomposition->o->ends == THR_ENDS_COUNTS
                      ? ""
                      : " and wherever else its cords may end");
}

/* Appends an edge of the matching problem. */
static void add_edge(port_graph *ports, int *n, int a, int b, int64_t weight)
{
  ports->edge[*n][0] = a;
  ports->edge[*n][1] = b;
  ports->weight[(*n)++] = weight;
}

/* Makes the matching problem: an edge for each pass, and for each core edges of weight 0 to the
 * ports and the cores before it. */
static thr_status build(port_graph *ports, thr_err *err)
{
  const thr_frame *frame = ports->decomposition->f;
  int n = 0;

  /* Number the ports and the cores of each group. */
  for (int group = 0; group < ports->n_groups; group++) {
    if (ports->n_ports[group] < ports->need[group]) return no_room(ports, group, err);
    ports->top[group] = ports->first[group];
    ports->first[group + 1] = ports->first[group] + 2 * ports->n_ports[group] - ports->need[group];
  }

  ports->edge = thr_scratch_array(&ports->own, (size_t)ports->n_edges, sizeof *ports->edge);
  ports->weight = thr_scratch_array(&ports->own, (size_t)ports->n_edges, sizeof *ports->weight);

  thr_status st = thr_scratch_check(&ports->own, err);
  if (st) return st;

  /* An edge of the matching for each possible pass. */
  for (int e = 0; e < frame->n_edges; e++)
    for (int i = 0; i < ports->copies[e]; i++) {
      int a = ports->top[ports->group[frame->edge[e][0]]]++,
          b = ports->top[ports->group[frame->edge[e][1]]]++;
      add_edge(ports, &n, a, b, thr_certificate_weight(frame, ports->certificate, e));
    }

  /* Each core with the ports, and with the cores before it. */
  for (int group = 0; group < ports->n_groups; group++)
    for (int core = ports->first[group] + ports->n_ports[group]; core < ports->first[group + 1];
         core++)
      for (int other = ports->first[group]; other < core; other++)
        add_edge(ports, &n, other, core, 0);
  return THR_OK;
}

/* Allocates the arrays and makes the matching problem for n cords. */
static thr_status ports_init(port_graph *ports, int n, thr_err *err)
{
  size_t nodes = (size_t)ports->decomposition->f->n_nodes;
  ports->group = thr_scratch_array(&ports->own, nodes, sizeof *ports->group);
  ports->need = thr_scratch_array(&ports->own, nodes, sizeof *ports->need);
  ports->first = thr_scratch_array(&ports->own, nodes + 1, sizeof *ports->first);
  ports->top = thr_scratch_array(&ports->own, nodes, sizeof *ports->top);
  ports->n_ports = thr_scratch_array(&ports->own, nodes, sizeof *ports->n_ports);
  ports->copies = thr_scratch_array(&ports->own, (size_t)ports->decomposition->f->n_edges,
                                    sizeof *ports->copies);

  thr_status st = thr_scratch_check(&ports->own, err);
  if (st) return st;

  /* Groups, ports and the edges between them. */
  find_groups(ports, n);
  st = count_ports(ports, err);
  return st ? st : build(ports, err);
}

/* Makes the passes that are matched, beyond the covers. */
static void take(const port_graph *ports, const thr_matching *matching,
                 thr_decomposition *decomposition)
{
  for (int e = 0, n = 0; e < decomposition->f->n_edges; e++) {
    decomposition->passes[e] = thr_plan_cover(decomposition->f, decomposition->o, e);
    for (int i = 0; i < ports->copies[e]; i++, n++)
      decomposition->passes[e] += matching->mate_edge[ports->edge[n][0]] == n;
  }
}

thr_status thr_decomposition_places(thr_decomposition *decomposition, int n,
                                    const thr_certificate *certificate, thr_err *err)
{
  port_graph ports = {.decomposition = decomposition, .certificate = certificate};
  thr_matching matching = {0};
  if (decomposition->o->ends == THR_ENDS_CLOSED || enough_places(decomposition, n)) return THR_OK;

  /* The matching may be too large, or not exist; the passes then stay. */
  thr_err why = {0};
  thr_status st = ports_init(&ports, n, &why);

  /* Match all ports and cores. */
  if (!st) {
    thr_matching_problem problem = {ports.first[ports.n_groups], ports.n_edges,
                                    (const int(*)[2])ports.edge, ports.weight};
    st = thr_matching_solve(&problem, decomposition->limits, &matching, &why);
    if (st == THR_EINFEASIBLE) why = (thr_err){0};
  }

  if (!st) take(&ports, &matching, decomposition);
  if (st == THR_EINFEASIBLE && !why.code)
    thr_fail(&why, st,
             "the capacities of the edges leave no room for as many cord ends as asked for");
  if (st) thr_fail(err, st, "%s", why.text);

  thr_matching_destroy(&matching);
  thr_scratch_free(&ports.own);
  return st;
}
