/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Extra passes where cord ends need more of them: a perfect matching of ports. */
#include "graph/check/check.h"
#include "graph/scratch.h"
#include "lp/length/postman.h"

#include <limits.h>

enum { MOST_EDGES = 2000000 }; /* of a matching */

/* Every possible extra pass has a port at each of its nodes: the two are matched with each other if
 * the pass is made, else each with a core of its group. A group of p ports that needs d passes, or
 * 2, 4, .. more, has p - d cores, which may be matched with each other. A group is a node; or all
 * nodes where cords may end, if ends are free to be at any of them. */
typedef struct {
  const thr_decomposition *s;
  const thr_certificate *c;
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
} ports;

static int passes_at(const thr_frame *frame, const int *passes, int v)
{
  int sum = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    sum += passes[frame->half[i] >> 1];
  return sum;
}

static int covers_at(const thr_decomposition *decomposition, int v)
{
  int sum = 0;
  for (int i = decomposition->f->first[v]; i < decomposition->f->first[v + 1]; i++)
    sum += thr_plan_cover(decomposition->f, decomposition->o, decomposition->f->half[i] >> 1);
  return sum;
}

static bool enough_places(const thr_decomposition *decomposition, int n)
{
  int free_places = 0;
  for (int v = 0; v < decomposition->f->n_nodes; v++) {
    if (!thr_plan_end_allowed(decomposition->f, decomposition->o, v)) continue;
    int at = passes_at(decomposition->f, decomposition->passes, v);
    if (decomposition->o->ends == THR_ENDS_COUNTS && at < decomposition->o->end_count[v])
      return false;
    if (free_places < INT_MAX / 2) free_places += at;
  }
  return decomposition->o->ends == THR_ENDS_COUNTS || free_places >= 2 * n;
}

/* Groups, and the passes that they need beyond the cover. */
static void find_groups(ports *p, int n)
{
  const thr_decomposition *decomposition = p->s;
  bool counts = decomposition->o->ends == THR_ENDS_COUNTS;
  int joint = -1; /* the group of all places where ends are free to be */
  for (int v = 0; v < decomposition->f->n_nodes; v++) {
    bool end = thr_plan_end_allowed(decomposition->f, decomposition->o, v);
    int g = !counts && end && joint >= 0 ? joint : p->n_groups++;
    if (!counts && end && joint < 0) {
      joint = g;
      p->need[g] = 2 * n;
    } else if (counts) {
      p->need[g] = decomposition->o->end_count[v];
    }
    p->group[v] = g;
    p->need[g] -= covers_at(decomposition, v);
  }
  for (int g = 0; g < p->n_groups; g++)
    if (p->need[g] < 0) p->need[g] = -p->need[g] % 2;
}

/* More than so many extra passes of an edge are more than its groups need. */
static thr_status count_ports(ports *p, thr_err *err)
{
  const thr_decomposition *decomposition = p->s;
  int64_t edges = 0;
  for (int e = 0; e < decomposition->f->n_edges; e++) {
    int a = p->group[decomposition->f->edge[e][0]], b = p->group[decomposition->f->edge[e][1]];
    int most = a == b ? (p->need[a] + 1) / 2 : p->need[a] > p->need[b] ? p->need[a] : p->need[b];
    int room = thr_plan_capacity(decomposition->f, decomposition->o, e) -
               thr_plan_cover(decomposition->f, decomposition->o, e);
    if (most < 1) most = 1;
    p->copies[e] = most < room ? most : room;
    p->n_ports[a] += p->copies[e];
    p->n_ports[b] += p->copies[e];
    p->n_passes += p->copies[e];
  }
  for (int g = 0; g < p->n_groups; g++) {
    int64_t cores = p->n_ports[g] - p->need[g];
    if (cores >= 0) edges += cores * p->n_ports[g] + cores * (cores - 1) / 2;
  }
  if (edges + p->n_passes > MOST_EDGES)
    return thr_fail(
        err, THR_ELIMIT,
        "too many ends, at nodes with too many edges, to find the shortest extra passes for them");
  p->n_edges = (int)edges + p->n_passes;
  return THR_OK;
}

static thr_status no_room(const ports *p, int g, thr_err *err)
{
  int v = 0;
  while (p->group[v] != g)
    v++;
  return thr_fail(err, THR_EINFEASIBLE,
                  "the edges at node %s%s have no room for enough passes: their capacity allows "
                  "fewer cord ends than asked for",
                  p->s->f->name[v],
                  p->s->o->ends == THR_ENDS_COUNTS ? "" : " and wherever else its cords may end");
}

static void add_edge(ports *p, int *n, int a, int b, int64_t weight)
{
  p->edge[*n][0] = a;
  p->edge[*n][1] = b;
  p->weight[(*n)++] = weight;
}

static thr_status build(ports *p, thr_err *err)
{
  const thr_frame *frame = p->s->f;
  int n = 0;
  for (int g = 0; g < p->n_groups; g++) {
    if (p->n_ports[g] < p->need[g]) return no_room(p, g, err);
    p->top[g] = p->first[g];
    p->first[g + 1] = p->first[g] + 2 * p->n_ports[g] - p->need[g];
  }
  p->edge = thr_scratch_array(&p->own, (size_t)p->n_edges, sizeof *p->edge);
  p->weight = thr_scratch_array(&p->own, (size_t)p->n_edges, sizeof *p->weight);
  thr_status st = thr_scratch_check(&p->own, err);
  if (st) return st;
  for (int e = 0; e < frame->n_edges; e++)
    for (int i = 0; i < p->copies[e]; i++) {
      int a = p->top[p->group[frame->edge[e][0]]]++, b = p->top[p->group[frame->edge[e][1]]]++;
      add_edge(p, &n, a, b, thr_certificate_weight(frame, p->c, e));
    }
  for (int g = 0; g < p->n_groups; g++)
    for (int core = p->first[g] + p->n_ports[g]; core < p->first[g + 1]; core++)
      for (int other = p->first[g]; other < core; other++)
        add_edge(p, &n, other, core, 0);
  return THR_OK;
}

static thr_status ports_init(ports *p, int n, thr_err *err)
{
  size_t nodes = (size_t)p->s->f->n_nodes;
  p->group = thr_scratch_array(&p->own, nodes, sizeof *p->group);
  p->need = thr_scratch_array(&p->own, nodes, sizeof *p->need);
  p->first = thr_scratch_array(&p->own, nodes + 1, sizeof *p->first);
  p->top = thr_scratch_array(&p->own, nodes, sizeof *p->top);
  p->n_ports = thr_scratch_array(&p->own, nodes, sizeof *p->n_ports);
  p->copies = thr_scratch_array(&p->own, (size_t)p->s->f->n_edges, sizeof *p->copies);
  thr_status st = thr_scratch_check(&p->own, err);
  if (st) return st;
  find_groups(p, n);
  st = count_ports(p, err);
  return st ? st : build(p, err);
}

static void take(const ports *p, const thr_matching *matching, thr_decomposition *decomposition)
{
  for (int e = 0, n = 0; e < decomposition->f->n_edges; e++) {
    decomposition->passes[e] = thr_plan_cover(decomposition->f, decomposition->o, e);
    for (int i = 0; i < p->copies[e]; i++, n++)
      decomposition->passes[e] += matching->mate_edge[p->edge[n][0]] == n;
  }
}

thr_status thr_decomposition_places(thr_decomposition *decomposition, int n,
                                    const thr_certificate *certificate, thr_err *err)
{
  ports p = {.s = decomposition, .c = certificate};
  thr_matching matching = {0};
  if (decomposition->o->ends == THR_ENDS_CLOSED || enough_places(decomposition, n)) return THR_OK;
  thr_err why = {0};
  thr_status st = ports_init(&p, n, &why);
  if (!st) {
    thr_matching_problem problem = {p.first[p.n_groups], p.n_edges, (const int(*)[2])p.edge,
                                    p.weight};
    st = thr_matching_solve(&problem, decomposition->limits, &matching, &why);
    if (st == THR_EINFEASIBLE) why = (thr_err){0};
  }
  if (!st) take(&p, &matching, decomposition);
  if (st == THR_EINFEASIBLE && !why.code)
    thr_fail(&why, st,
             "the capacities of the edges leave no room for as many cord ends as asked for");
  if (st) thr_fail(err, st, "%s", why.text);
  thr_matching_destroy(&matching);
  thr_scratch_free(&p.own);
  return st;
}
