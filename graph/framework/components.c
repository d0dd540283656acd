/* Components of a framework, and plans of them put together again. */
#include "graph/framework/components.h"

#include <stdlib.h>
#include <string.h>

void thr_components_destroy(thr_components *p)
{
  free(p->component);
  free(p->local);
  free(p->first_node);
  free(p->node);
  free(p->first_edge);
  free(p->edge);
  *p = (thr_components){0};
}

/* Items in order of their keys, of which there are n: a counting sort. */
static void sort_by(const int *key, int n_items, int *first, int n, int *item)
{
  for (int i = 0; i < n_items; i++)
    first[key[i] + 1]++;
  for (int k = 0; k < n; k++)
    first[k + 1] += first[k];
  for (int i = 0; i < n_items; i++)
    item[first[key[i]]++] = i;
  for (int k = n; k > 0; k--) /* the loop above moved each start to its end */
    first[k] = first[k - 1];
  first[0] = 0;
}

static thr_status sort_all(thr_components *p, thr_err *err)
{
  const thr_frame *f = p->f;
  size_t n = (size_t)p->n + 1;
  int *of_edge = thr_calloc((size_t)f->n_edges, sizeof *of_edge);
  p->first_node = thr_calloc(n, sizeof *p->first_node);
  p->first_edge = thr_calloc(n, sizeof *p->first_edge);
  p->node = thr_calloc((size_t)f->n_nodes, sizeof *p->node);
  p->edge = thr_calloc((size_t)f->n_edges, sizeof *p->edge);
  p->local = thr_calloc((size_t)f->n_nodes, sizeof *p->local);
  thr_status st = of_edge && p->first_node && p->first_edge && p->node && p->edge && p->local ? THR_OK : thr_nomem(err);
  if (!st) {
    for (int e = 0; e < f->n_edges; e++)
      of_edge[e] = p->component[f->edge[e][0]];
    sort_by(p->component, f->n_nodes, p->first_node, p->n, p->node);
    sort_by(of_edge, f->n_edges, p->first_edge, p->n, p->edge);
    for (int i = 0; i < f->n_nodes; i++)
      p->local[p->node[i]] = i - p->first_node[p->component[p->node[i]]];
  }
  free(of_edge);
  return st;
}

thr_status thr_components_init(thr_components *p, const thr_frame *f, const thr_plan_options *o, thr_err *err)
{
  *p = (thr_components){.f = f, .o = o, .component = thr_calloc((size_t)f->n_nodes, sizeof *p->component)};
  thr_status st = p->component ? thr_frame_components(f, p->component, &p->n, err) : thr_nomem(err);
  if (!st) st = sort_all(p, err);
  if (st) thr_components_destroy(p);
  return st;
}

/* ---- taking one out ---- */

static thr_status allocate(const thr_components *p, thr_frame *t, thr_plan_options *o, thr_err *err)
{
  size_t n = (size_t)t->n_nodes, m = (size_t)t->n_edges;
  bool good = (t->xyz = thr_calloc(n, sizeof *t->xyz)) && (t->foot = thr_calloc(n, sizeof *t->foot)) &&
              (t->name = thr_calloc(n, sizeof *t->name)) && (t->first = thr_calloc(n + 1, sizeof *t->first)) &&
              (t->edge = thr_calloc(m, sizeof *t->edge)) && (t->length = thr_calloc(m, sizeof *t->length)) &&
              (t->half = thr_calloc(2 * m, sizeof *t->half));
  if (p->f->cover) good = good && (t->cover = thr_calloc(m, sizeof *t->cover));
  if (p->f->capacity) good = good && (t->capacity = thr_calloc(m, sizeof *t->capacity));
  if (p->o->end_node) good = good && (o->end_node = thr_calloc(n, sizeof *o->end_node));
  if (p->o->end_count) good = good && (o->end_count = thr_calloc(n, sizeof *o->end_count));
  return good ? THR_OK : thr_nomem(err);
}

static thr_status copy_nodes(const thr_components *p, int k, thr_frame *t, thr_plan_options *o, thr_err *err)
{
  for (int i = 0; i < t->n_nodes; i++) {
    int v = p->node[p->first_node[k] + i];
    memcpy(t->xyz[i], p->f->xyz[v], sizeof t->xyz[i]);
    t->foot[i] = p->f->foot[v];
    if (o->end_node) o->end_node[i] = p->o->end_node[v];
    if (o->end_count) o->end_count[i] = p->o->end_count[v];
    if (!(t->name[i] = thr_strdup(p->f->name[v]))) return thr_nomem(err);
  }
  return THR_OK;
}

static void copy_edges(const thr_components *p, int k, thr_frame *t)
{
  for (int i = 0; i < t->n_edges; i++) {
    int e = p->edge[p->first_edge[k] + i];
    for (int side = 0; side < 2; side++)
      t->edge[i][side] = p->local[p->f->edge[e][side]];
    t->length[i] = p->f->length[e];
    if (t->cover) t->cover[i] = p->f->cover[e];
    if (t->capacity) t->capacity[i] = p->f->capacity[e];
  }
}

thr_status thr_component_take(const thr_components *p, int k, thr_plan *out, thr_err *err)
{
  *out = (thr_plan){.options = *p->o};
  out->options.end_node = NULL;
  out->options.end_count = NULL;
  thr_frame *t = &out->frame;
  t->n_nodes = p->first_node[k + 1] - p->first_node[k];
  t->n_edges = p->first_edge[k + 1] - p->first_edge[k];
  t->own_lengths = p->f->own_lengths;
  memcpy(t->units, p->f->units, sizeof t->units);
  thr_status st = allocate(p, t, &out->options, err);
  if (!st) st = copy_nodes(p, k, t, &out->options, err);
  if (st) {
    thr_plan_destroy(out);
    return st;
  }
  copy_edges(p, k, t);
  thr_frame_index(t);
  return THR_OK;
}

/* ---- putting them together ---- */

static void give_cords(const thr_components *p, int k, thr_plan *component, thr_plan *whole)
{
  for (int i = 0; i < component->n_cords; i++) {
    thr_cord *c = &whole->cord[whole->n_cords];
    *c = component->cord[i];
    component->cord[i].half = NULL;
    c->component = k;
    thr_cord_id(whole->n_cords++, c->id);
    for (int j = 0; j < c->n_passes; j++)
      c->half[j] = 2 * p->edge[p->first_edge[k] + (c->half[j] >> 1)] + (c->half[j] & 1);
  }
}

thr_status thr_components_join(const thr_components *p, thr_plan *component, thr_plan *whole, thr_err *err)
{
  size_t n = 0;
  for (int k = 0; k < p->n; k++)
    n += (size_t)component[k].n_cords;
  if (!(whole->cord = thr_calloc(n, sizeof *whole->cord))) return thr_nomem(err);
  for (int k = 0; k < p->n; k++)
    give_cords(p, k, &component[k], whole);
  return THR_OK;
}

void thr_component_give_certificate(const thr_components *p, int k, thr_plan *component, thr_certificate *c)
{
  if (component->proof.n_certificates != 1) return;
  thr_certificate *own = &component->proof.certificate[0];
  thr_certificate_destroy(c);
  *c = *own;
  *own = (thr_certificate){0};
  c->component = k;
  for (int i = 0; i < c->n_cuts; i++)
    for (int j = 0; j < c->cut[i].n_nodes; j++)
      c->cut[i].node[j] = p->node[p->first_node[k] + c->cut[i].node[j]];
}
