/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes the components of a framework apart, each as a plan of its own with what is asked of it,
 * and puts the plans' cords together again.
 *
 * Nodes and edges are sorted by component once; then a component of m edges is taken in O(m).
 * Half-edge h of a component is half-edge 2 edge[..] + (h & 1) of the whole (thr_component_half),
 * because edges keep their direction.
 *
 * Example: edges 0-1, 2-3, 1-4 are the components {0, 1, 4} with edges 0 and 2, and {2, 3} with
 * edge 1. */
#include "graph/framework/components.h"

#include <stdlib.h>
#include <string.h>

void thr_components_destroy(thr_components *components)
{
  free(components->component);
  free(components->local);
  free(components->first_node);
  free(components->node);
  free(components->first_edge);
  free(components->edge);
  *components = (thr_components){0};
}

/* Sorts items by their keys 0 .. n - 1 (counting sort): those with key k become item[first[k]] ..
 * item[first[k + 1] - 1], in ascending order. */
static void sort_by(const int *key, int n_items, int *first, int n, int *item)
{
  /* Count, sum up, and fill. */
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

/* Sorts nodes and edges by component, and numbers the nodes of each. */
static thr_status sort_all(thr_components *components, thr_err *err)
{
  const thr_frame *frame = components->f;
  size_t n = (size_t)components->n + 1;
  int *of_edge = thr_calloc((size_t)frame->n_edges, sizeof *of_edge);

  components->first_node = thr_calloc(n, sizeof *components->first_node);
  components->first_edge = thr_calloc(n, sizeof *components->first_edge);
  components->node = thr_calloc((size_t)frame->n_nodes, sizeof *components->node);
  components->edge = thr_calloc((size_t)frame->n_edges, sizeof *components->edge);
  components->local = thr_calloc((size_t)frame->n_nodes, sizeof *components->local);

  thr_status st = of_edge && components->first_node && components->first_edge && components->node &&
                          components->edge && components->local
                      ? THR_OK
                      : thr_nomem(err);

  if (!st) {
    /* An edge belongs to the component of its ends. */
    for (int e = 0; e < frame->n_edges; e++)
      of_edge[e] = components->component[frame->edge[e][0]];

    sort_by(components->component, frame->n_nodes, components->first_node, components->n,
            components->node);
    sort_by(of_edge, frame->n_edges, components->first_edge, components->n, components->edge);

    /* A node's number in its component is its place in the component's list. */
    for (int i = 0; i < frame->n_nodes; i++)
      components->local[components->node[i]] =
          i - components->first_node[components->component[components->node[i]]];
  }

  free(of_edge);
  return st;
}

thr_status thr_components_init(thr_components *components, const thr_frame *frame,
                               const thr_request *options, thr_err *err)
{
  *components = (thr_components){
      .f = frame,
      .o = options,
      .component = thr_calloc((size_t)frame->n_nodes, sizeof *components->component)};
  thr_status st = components->component
                      ? thr_frame_components(frame, components->component, &components->n, err)
                      : thr_nomem(err);

  /* The rest depends on the number of components. */
  if (!st) st = sort_all(components, err);
  if (st) thr_components_destroy(components);
  return st;
}

/* ---- taking one out ---- */

/* Allocates the arrays of a component's framework, and those of its request that the whole request
 * has. */
static thr_status allocate(const thr_components *components, thr_frame *frame, thr_request *options,
                           thr_err *err)
{
  /* What every framework has. */
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges;
  bool good = (frame->xyz = thr_calloc(n, sizeof *frame->xyz)) &&
              (frame->foot = thr_calloc(n, sizeof *frame->foot)) &&
              (frame->name = thr_calloc(n, sizeof *frame->name)) &&
              (frame->first = thr_calloc(n + 1, sizeof *frame->first)) &&
              (frame->edge = thr_calloc(m, sizeof *frame->edge)) &&
              (frame->length = thr_calloc(m, sizeof *frame->length)) &&
              (frame->half = thr_calloc(2 * m, sizeof *frame->half));

  /* Covers and the like, where the whole has them. */
  if (components->f->cover) good = good && (frame->cover = thr_calloc(m, sizeof *frame->cover));
  if (components->f->capacity)
    good = good && (frame->capacity = thr_calloc(m, sizeof *frame->capacity));

  if (components->o->end_node)
    good = good && (options->end_node = thr_calloc(n, sizeof *options->end_node));
  if (components->o->end_count)
    good = good && (options->end_count = thr_calloc(n, sizeof *options->end_count));

  return good ? THR_OK : thr_nomem(err);
}

/* Copies the nodes of component k, with what is asked of them. */
static thr_status copy_nodes(const thr_components *components, int k, thr_frame *frame,
                             thr_request *options, thr_err *err)
{
  thr_text names = {0};

  /* Nodes keep their order, so their names follow one another, too. */
  for (int i = 0; i < frame->n_nodes; i++) {
    int v = components->node[components->first_node[k] + i];
    memcpy(frame->xyz[i], components->f->xyz[v], sizeof frame->xyz[i]);
    frame->foot[i] = components->f->foot[v];
    if (options->end_node) options->end_node[i] = components->o->end_node[v];
    if (options->end_count) options->end_count[i] = components->o->end_count[v];
    thr_text_append_bytes(&names, components->f->name[v], strlen(components->f->name[v]) + 1);
  }

  return thr_frame_take_names(frame, &names, err);
}

/* Copies the edges of component k. */
static void copy_edges(const thr_components *components, int k, thr_frame *frame)
{
  for (int i = 0; i < frame->n_edges; i++) {
    /* The ends by their numbers in the component. */
    int e = components->edge[components->first_edge[k] + i];
    for (int side = 0; side < 2; side++)
      frame->edge[i][side] = components->local[components->f->edge[e][side]];
    frame->length[i] = components->f->length[e];
    if (frame->cover) frame->cover[i] = components->f->cover[e];
    if (frame->capacity) frame->capacity[i] = components->f->capacity[e];
  }
}

/* Copies a component: sizes first, then nodes with their names, then edges, then the index of
 * half-edges. */
thr_status thr_component_take(const thr_components *components, int k, thr_plan *out, thr_err *err)
{
  /* The request is the whole one, but for what it says of nodes. */
  *out = (thr_plan){.options = *components->o};
  out->options.end_node = NULL;
  out->options.end_count = NULL;
  thr_frame *frame = &out->frame;

  /* Sizes and units are known before the arrays are allocated. */
  frame->n_nodes = components->first_node[k + 1] - components->first_node[k];
  frame->n_edges = components->first_edge[k + 1] - components->first_edge[k];
  frame->own_lengths = components->f->own_lengths;
  memcpy(frame->units, components->f->units, sizeof frame->units);
  thr_status st = allocate(components, frame, &out->options, err);

  if (!st) st = copy_nodes(components, k, frame, &out->options, err);
  if (st) {
    thr_plan_destroy(out);
    return st;
  }

  copy_edges(components, k, frame);
  thr_frame_index(frame);
  return THR_OK;
}

/* ---- putting them together ---- */

/* Moves the cords of component k into those of the whole. */
static void give_cords(const thr_components *components, int k, thr_plan *component,
                       thr_plan *whole)
{
  for (int i = 0; i < component->n_cords; i++) {
    thr_cord *cord = &whole->cord[whole->n_cords];

    /* The array of half-edges is taken over. */
    *cord = component->cord[i];
    component->cord[i].half = NULL;
    cord->component = k;
    thr_cord_id(whole->n_cords++, cord->id);

    /* Half-edges of the whole instead of the component. */
    for (int j = 0; j < cord->n_passes; j++)
      cord->half[j] = thr_component_half(components, k, cord->half[j]);
  }
}

/* Counts the cords, then moves them one component after the other. */
thr_status thr_components_join(const thr_components *components, thr_plan *component,
                               thr_plan *whole, thr_err *err)
{
  /* All components' cords. */
  size_t n = 0;
  for (int k = 0; k < components->n; k++)
    n += (size_t)component[k].n_cords;

  if (!(whole->cord = thr_calloc(n, sizeof *whole->cord))) return thr_nomem(err);
  for (int k = 0; k < components->n; k++)
    give_cords(components, k, &component[k], whole);

  return THR_OK;
}

/* Makes the cords of component k as a plan; its passes are taken from those of the whole. */
static thr_status make_cords(const thr_components *components, int k, const int *passes,
                             thr_component_cords *make, thr_plan *made, thr_err *err)
{
  thr_status st = thr_component_take(components, k, made, err);
  if (st) return st;
  int *part = thr_calloc((size_t)made->frame.n_edges, sizeof *part);
  if (!part) return thr_nomem(err);

  /* Passes of the component's edges. */
  for (int e = 0; passes && e < made->frame.n_edges; e++)
    part[e] = passes[components->edge[components->first_edge[k] + e]];

  st = make(&made->frame, &made->options, passes ? part : NULL, &made->cord, &made->n_cords, err);
  free(part);
  return st;
}

/* Makes cords component by component, until one of them has none, and joins them. */
thr_status thr_components_cords(const thr_frame *frame, const thr_request *options,
                                const int *passes, thr_component_cords *make, thr_cord **cord,
                                int *n_cords, thr_err *err)
{
  thr_components components;
  thr_plan whole = {0}, *made = NULL;
  bool all = true;
  *cord = NULL;
  *n_cords = 0;
  thr_status st = thr_components_init(&components, frame, options, err);

  /* A connected framework needs no copies. */
  if (!st && components.n == 1) {
    thr_components_destroy(&components);
    return make(frame, options, passes, cord, n_cords, err);
  }

  if (!st && !(made = thr_calloc((size_t)components.n, sizeof *made))) st = thr_nomem(err);

  /* A component without cords makes the whole one impossible, so the rest need not be tried. */
  for (int k = 0; k < components.n && !st && all; k++) {
    st = make_cords(&components, k, passes, make, &made[k], err);
    all = made[k].n_cords > 0;
  }

  if (!st && all) st = thr_components_join(&components, made, &whole, err);
  *cord = whole.cord;
  *n_cords = whole.n_cords;

  /* The cords have been moved out of the plans. */
  for (int k = 0; made && k < components.n; k++)
    thr_plan_destroy(&made[k]);

  free(made);
  thr_components_destroy(&components);
  return st;
}

/* Moves the one certificate of a component's plan, and renames the nodes of its cuts. */
void thr_component_give_certificate(const thr_components *components, int k, thr_plan *component,
                                    thr_certificate *certificate)
{
  if (component->proof.n_certificates != 1) return;
  thr_certificate *own = &component->proof.certificate[0];
  thr_certificate_destroy(certificate);
  *certificate = *own;
  *own = (thr_certificate){0};
  certificate->component = k;

  /* Cuts name nodes by their numbers in the whole. */
  for (int i = 0; i < certificate->n_cuts; i++)
    for (int j = 0; j < certificate->cut[i].n_nodes; j++)
      certificate->cut[i].node[j] =
          components->node[components->first_node[k] + certificate->cut[i].node[j]];
}
