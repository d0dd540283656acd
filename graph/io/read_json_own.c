/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Our own frames and plans, and any JSON with lists of points and index pairs. */
#include "graph/io/read_parts.h"

#include <stdlib.h>

/* An edge [a, b] or a face [a, b, c, ..] by node numbers. */
static thr_status read_polygon(thr_json_reader *r, const thr_json_where *at, const thr_json *v)
{
  int n = thr_json_size(v), few[4], *corner = n <= 4 ? few : thr_calloc((size_t)n, sizeof *corner);
  if (!corner) return thr_nomem(r->err);
  thr_status st = thr_json_is_array(v) && n >= 2
                      ? THR_OK
                      : thr_json_bad(r, at, "not a face; list its node numbers");
  for (int i = 0; i < n && !st; i++) {
    thr_json_where here = {at, NULL, i};
    st = thr_json_index(r, &here, thr_json_at(v, i), r->d->n_nodes, &corner[i]);
  }
  if (!st) st = thr_faces_add(&r->faces, corner, n, r->err);
  if (corner != few) free(corner);
  return st;
}

static thr_status read_own_nodes(thr_json_reader *r, const thr_json_where *at,
                                 const thr_json *nodes, const thr_json *names)
{
  thr_json_where list = {at->up, at->key, at->index}, name_list = {at->up, "names", 0};
  if (names && (!thr_json_is_array(names) || thr_json_size(names) != thr_json_size(nodes)))
    return thr_json_bad(r, &name_list, "not one name for each node");
  for (int i = 0; i < thr_json_size(nodes); i++) {
    thr_json_where here = {&list, NULL, i}, name_here = {&name_list, NULL, i};
    double xyz[3];
    const char *name = NULL;
    thr_status st = thr_json_point(r, &here, thr_json_at(nodes, i), NULL, xyz);
    if (names) name = thr_json_string(thr_json_at(names, i));
    if (!st && names && (!name || !*name))
      st = thr_json_name_of(r, &name_here, thr_json_at(names, i), &name);
    if (!st) st = thr_draft_add_node(r->d, xyz, name, false, r->err);
    if (st) return st;
  }
  return THR_OK;
}

thr_status thr_json_edge_list(thr_json_reader *r, const thr_json_where *up, const thr_json *object,
                              const char *key, int n_edges, const thr_json **list)
{
  thr_json_where here = {up, key, 0};
  *list = thr_json_get(object, key);
  if (!*list || (thr_json_is_array(*list) && thr_json_size(*list) == n_edges)) return THR_OK;
  return thr_json_bad(r, &here, "not one for each edge");
}

/* The two nodes of an edge. */
static thr_status read_pair(thr_json_reader *r, const thr_json_where *at, const thr_json *pair,
                            int end[2])
{
  if (!thr_json_is_array(pair) || thr_json_size(pair) != 2)
    return thr_json_bad(r, at, "not an edge; give two node numbers");
  if (thr_json_indices(pair, 2, r->d->n_nodes, end)) return THR_OK;
  thr_status st = THR_OK;
  for (int i = 0; i < 2 && !st; i++) {
    thr_json_where side = {at, NULL, i};
    st = thr_json_index(r, &side, thr_json_at(pair, i), r->d->n_nodes, &end[i]);
  }
  return st;
}

static thr_status read_own_edges(thr_json_reader *r, const thr_json_where *up,
                                 const thr_json *object)
{
  const char *key;
  const thr_json *edges = THR_JSON_MEMBER(object, &key, "edges", "lines"), *lengths, *covers,
                 *capacities;
  thr_json_where list = {up, key, 0}, length_list = {up, "lengths", 0};
  if (edges && !thr_json_is_array(edges)) return thr_json_bad(r, &list, "not a list of node pairs");
  thr_status listed = thr_json_edge_list(r, up, object, "lengths", thr_json_size(edges), &lengths);
  if (!listed) listed = thr_json_edge_list(r, up, object, "covers", thr_json_size(edges), &covers);
  if (!listed)
    listed = thr_json_edge_list(r, up, object, "capacities", thr_json_size(edges), &capacities);
  if (listed) return listed;
  for (int e = 0; e < thr_json_size(edges); e++) {
    thr_json_where here = {&list, NULL, e}, length_here = {&length_list, NULL, e};
    int end[2] = {0, 0};
    double length = 0;
    thr_status st = read_pair(r, &here, thr_json_at(edges, e), end);
    if (!st && lengths) st = thr_json_length(r, &length_here, thr_json_at(lengths, e), &length);
    if (!st) st = thr_draft_add_edge(r->d, end[0], end[1], length, r->err);
    if (!st && (covers || capacities))
      st = thr_json_passes(r, &here, thr_json_at(covers, e), thr_json_at(capacities, e));
    if (st) return st;
  }
  return THR_OK;
}

static thr_status read_feet(thr_json_reader *r, const thr_json_where *up, const thr_json *feet)
{
  thr_json_where list = {up, "feet", 0};
  if (feet && !thr_json_is_array(feet)) return thr_json_bad(r, &list, "not a list of node numbers");
  for (int i = 0; i < thr_json_size(feet); i++) {
    thr_json_where here = {&list, NULL, i};
    int v = 0;
    thr_status st = thr_json_index(r, &here, thr_json_at(feet, i), r->d->n_nodes, &v);
    if (st) return st;
    r->d->node[v].foot = true;
  }
  return THR_OK;
}

thr_status thr_json_read_own(thr_json_reader *r, const thr_json_where *at, const thr_json *object)
{
  const char *node_key;
  const thr_json *nodes = THR_JSON_MEMBER(object, &node_key, "nodes", "vertices");
  const thr_json *faces = thr_json_get(object, "faces");
  double version;
  thr_json_where node_list = {at, node_key, 0}, face_list = {at, "faces", 0};
  if (thr_json_number(thr_json_get(object, "version"), &version) && version > 1 &&
      thr_json_get(object, "format"))
    return thr_json_bad(r, at,
                        "written by a newer version of this program; this one reads version 1");
  if (!thr_json_is_array(nodes))
    return thr_json_bad(r, &node_list, "not a list of points [x, y, z]");
  thr_status st = thr_json_units(r, at, "units", thr_json_get(object, "units"));
  if (!st) st = read_own_nodes(r, &node_list, nodes, thr_json_get(object, "names"));
  if (!st) st = read_own_edges(r, at, object);
  for (int i = 0; i < thr_json_size(faces) && !st; i++) {
    thr_json_where here = {&face_list, NULL, i};
    st = read_polygon(r, &here, thr_json_at(faces, i));
  }
  return st ? st : read_feet(r, at, thr_json_get(object, "feet"));
}

thr_status thr_json_read_plan(thr_json_reader *r, const thr_json_where *at, const thr_json *object)
{
  thr_json_where here = {at, "framework", 0};
  const thr_json *frame = thr_json_get(object, "framework");
  return thr_json_is_object(frame) ? thr_json_read_own(r, &here, frame)
                                   : thr_json_bad(r, &here, "missing from the plan");
}
