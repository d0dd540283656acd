/* Turns that tie the nodes. */
#include "tortuosity/tie/tie.h"
#include "graph/disjoint.h"
#include "graph/framework/frame.h"

#include <stdlib.h>
#include <string.h>

int thr_tie_need(const thr_turning_columns *c, int v, const int *passes, const int *ends)
{
  const thr_frame *f = c->f;
  int z = ends ? ends[v] : 0, sum = 0, most = 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++) {
    int m = passes[f->half[i] >> 1];
    sum += m;
    if (m > most) most = m;
  }
  int few = 2 * (thr_degree(f, v) - 1) + z - sum, many = 2 * most - sum - z, need = few > many ? few : many;
  return need > 0 ? need : (sum + z) % 2;
}

/* Have the edges at every node room for the passes that tie them? */
static thr_status check_room(const thr_turning_columns *c, thr_err *err)
{
  const thr_frame *f = c->f;
  for (int v = 0; v < f->n_nodes; v++) {
    int64_t room = 0, needed = 2 * (thr_degree(f, v) - 1) + (c->task->end_count ? c->task->end_count[v] : 0);
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      room += c->most[f->half[i] >> 1];
    if (room < needed)
      return thr_fail(err, THR_EINFEASIBLE, "node %s: its edges have room for %d passes, but tying them together takes %d",
                      f->name[v], (int)room, (int)needed);
  }
  return THR_OK;
}

thr_status thr_tie_possible(const thr_turning_columns *c, thr_err *err)
{
  const thr_frame *f = c->f;
  int *loose = thr_calloc((size_t)c->n_ends, sizeof *loose); /* passes that end at nodes with one edge, by equation */
  if (!loose) return thr_nomem(err);
  thr_status st = THR_OK;
  for (int v = 0; v < f->n_nodes; v++)
    if (thr_degree(f, v) == 1) loose[c->end_group[v]] += c->cover[f->half[f->first[v]] >> 1];
  for (int v = 0; v < f->n_nodes && !st; v++) {
    int k = c->end_group[v];
    if (thr_degree(f, v) != 1) continue;
    if (c->end_column[f->half[f->first[v]]] < 0)
      st = thr_fail(err, THR_EINFEASIBLE, "node %s has one edge only: with tube joints a cord must end there, but none may",
                    f->name[v]);
    else if (loose[k] > c->supply[k][1])
      st = thr_fail(err, THR_EINFEASIBLE,
                    "nodes with one edge only, such as %s, take %d ends with tube joints, but there are no more than %d in their "
                    "component; ask for more --cords",
                    f->name[v], loose[k], c->supply[k][1]);
  }
  free(loose);
  return st ? st : check_room(c, err);
}

thr_status thr_tie_holds(const thr_turning_columns *c, const int *x, bool *tied, thr_err *err)
{
  const thr_frame *f = c->f;
  int *parent = thr_calloc(2 * (size_t)f->n_edges, sizeof *parent), apart = 0;
  if (!parent) return thr_nomem(err);
  for (int h = 0; h < 2 * f->n_edges; h++)
    parent[h] = h;
  for (int v = 0; v < f->n_nodes; v++)
    apart += thr_degree(f, v) - 1;
  for (int j = 0; j < c->first_extra; j++)
    if (x[j] > 0) apart -= thr_disjoint_join(parent, c->half[j][0], c->half[j][1]);
  *tied = apart == 0;
  free(parent);
  return THR_OK;
}

/* As many ends as there must be? */
static thr_status count_ends(const thr_turning_columns *c, const int *ends, bool *fit, thr_err *err)
{
  int *sum = thr_calloc((size_t)c->n_ends, sizeof *sum);
  if (!sum) return thr_nomem(err);
  *fit = true;
  for (int v = 0; v < c->f->n_nodes; v++) {
    int n = ends ? ends[v] : 0;
    sum[c->end_group[v]] += n;
    *fit &= n == 0 || c->end_column[c->f->half[c->f->first[v]]] >= 0;
  }
  for (int k = 0; k < c->n_ends; k++)
    *fit &= sum[k] >= c->supply[k][0] && sum[k] <= c->supply[k][1];
  free(sum);
  return THR_OK;
}

/* ---- all nodes ---- */

static int count_knot(const thr_turning_columns *c, int v, const int *passes, const int *ends)
{
  const thr_frame *f = c->f;
  int n = ends ? ends[v] : 0;
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    n += passes[f->half[i] >> 1];
  return n;
}

static void count_turns(const thr_knot *k, int *x)
{
  const int *half = k->c->f->half + k->c->f->first[k->at];
  for (int i = 0; i < k->n; i++) {
    int a = k->pair[i].a, b = k->pair[i].b;
    if (a == k->d || b == k->d)
      x[k->c->end_column[half[a == k->d ? b : a]]]++;
    else
      x[thr_turning_column(k->c, half[a], half[b])]++;
  }
}

thr_status thr_tie_pair(const thr_turning_columns *c, const int *passes, const int *ends, int *x, bool *found, thr_err *err)
{
  const thr_frame *f = c->f;
  thr_knot k = {0};
  int most = 0;
  thr_status st = count_ends(c, ends, found, err);
  for (int v = 0; v < f->n_nodes && !st && *found; v++) {
    int n = count_knot(c, v, passes, ends);
    if (n > most) most = n;
    *found = thr_tie_need(c, v, passes, ends) == 0;
  }
  if (st || !*found) return st;
  memset(x, 0, (size_t)c->first_extra * sizeof *x);
  memset(x + c->first_end, 0, (size_t)(c->n_columns - c->first_end) * sizeof *x);
  st = thr_knot_init(&k, c, most, err);
  for (int v = 0; v < f->n_nodes && !st && *found; v++) {
    *found = thr_knot_tie(&k, v, passes, ends);
    if (*found) count_turns(&k, x);
  }
  thr_knot_destroy(&k);
  return st;
}
