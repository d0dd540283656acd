/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads our own frames and the frameworks of our plans, and any JSON with a list of points and
 * lists of index pairs or faces. Nodes and edges are numbered from 0 in the order of the file.
 *
 * Example:
 *     {"format": "thread-frame", "version": 1, "units": "mm",
 *      "nodes": [[0, 0, 0], [20, 0, 0]], "edges": [[0, 1]], "feet": [0]} */
#include "graph/io/read_parts.h"

#include <stdlib.h>

/* Reads an edge [a, b] or a face [a, b, c, ..] by node numbers. */
static thr_status read_polygon(thr_json_reader *reader, const thr_json_where *at,
                               const thr_json *value)
{
  /* Most faces have at most four corners, which need no allocation. */
  int n = thr_json_size(value), few[4],
      *corner = n <= 4 ? few : thr_calloc((size_t)n, sizeof *corner);
  if (!corner) return thr_nomem(reader->err);
  thr_status st = thr_json_is_array(value) && n >= 2
                      ? THR_OK
                      : thr_json_bad(reader, at, "not a face; list its node numbers");

  /* Corners are numbers of nodes. */
  for (int i = 0; i < n && !st; i++) {
    thr_json_where here = {at, NULL, i};
    st = thr_json_index(reader, &here, thr_json_at(value, i), reader->d->n_nodes, &corner[i]);
  }

  if (!st) st = thr_faces_add(&reader->faces, corner, n, reader->err);
  if (corner != few) free(corner);
  return st;
}

/* Reads the nodes; names is NULL or has one name for each of them. */
static thr_status read_own_nodes(thr_json_reader *reader, const thr_json_where *at,
                                 const thr_json *nodes, const thr_json *names)
{
  thr_json_where list = {at->up, at->key, at->index}, name_list = {at->up, "names", 0};

  if (names && (!thr_json_is_array(names) || thr_json_size(names) != thr_json_size(nodes)))
    return thr_json_bad(reader, &name_list, "not one name for each node");

  /* Nodes in the order of the list. */
  for (int i = 0; i < thr_json_size(nodes); i++) {
    /* A name is text, or anything that names a node elsewhere. */
    thr_json_where here = {&list, NULL, i}, name_here = {&name_list, NULL, i};
    double xyz[3];
    const char *name = NULL;
    thr_status st = thr_json_point(reader, &here, thr_json_at(nodes, i), NULL, xyz);
    if (names) name = thr_json_string(thr_json_at(names, i));
    if (!st && names && (!name || !*name))
      st = thr_json_name_of(reader, &name_here, thr_json_at(names, i), &name);
    if (!st) st = thr_draft_add_node(reader->d, xyz, name, false, reader->err);
    if (st) return st;
  }

  return THR_OK;
}

/* The member of object that says something of every edge, if there is one. */
static thr_status json_edge_list(thr_json_reader *reader, const thr_json_where *up,
                                 const thr_json *object, const char *key, int n_edges,
                                 const thr_json **list)
{
  thr_json_where here = {up, key, 0};
  *list = thr_json_get(object, key);
  if (!*list || (thr_json_is_array(*list) && thr_json_size(*list) == n_edges)) return THR_OK;
  return thr_json_bad(reader, &here, "not one for each edge");
}

/* Reads the two nodes of an edge. */
static thr_status read_pair(thr_json_reader *reader, const thr_json_where *at, const thr_json *pair,
                            int end[2])
{
  if (!thr_json_is_array(pair) || thr_json_size(pair) != 2)
    return thr_json_bad(reader, at, "not an edge; give two node numbers");

  /* Nearly always; else find out what is wrong and where. */
  if (thr_json_indices(pair, 2, reader->d->n_nodes, end)) return THR_OK;
  thr_status st = THR_OK;
  for (int i = 0; i < 2 && !st; i++) {
    thr_json_where side = {at, NULL, i};
    st = thr_json_index(reader, &side, thr_json_at(pair, i), reader->d->n_nodes, &end[i]);
  }

  return st;
}

/* Reads the edges, with lengths, covers and capacities if there are such lists. */
static thr_status read_own_edges(thr_json_reader *reader, const thr_json_where *up,
                                 const thr_json *object)
{
  const char *key;
  const thr_json *edges = THR_JSON_MEMBER(object, &key, "edges", "lines"), *lengths, *covers,
                 *capacities;
  thr_json_where list = {up, key, 0}, length_list = {up, "lengths", 0};

  if (edges && !thr_json_is_array(edges))
    return thr_json_bad(reader, &list, "not a list of node pairs");

  /* A list must have one value for each edge. */
  thr_status listed = json_edge_list(reader, up, object, "lengths", thr_json_size(edges), &lengths);
  if (!listed) listed = json_edge_list(reader, up, object, "covers", thr_json_size(edges), &covers);

  if (!listed)
    listed = json_edge_list(reader, up, object, "capacities", thr_json_size(edges), &capacities);

  if (listed) return listed;

  /* Edge by edge, so that messages can name the place. */
  for (int e = 0; e < thr_json_size(edges); e++) {
    thr_json_where here = {&list, NULL, e}, length_here = {&length_list, NULL, e};
    int end[2] = {0, 0};
    double length = 0;
    thr_status st = read_pair(reader, &here, thr_json_at(edges, e), end);
    if (!st && lengths)
      st = thr_json_length(reader, &length_here, thr_json_at(lengths, e), &length);
    if (!st) st = thr_draft_add_edge(reader->d, end[0], end[1], length, reader->err);
    if (!st && (covers || capacities))
      st = thr_json_passes(reader, &here, thr_json_at(covers, e), thr_json_at(capacities, e));
    if (st) return st;
  }

  return THR_OK;
}

/* Marks the nodes that are feet. */
static thr_status read_feet(thr_json_reader *reader, const thr_json_where *up, const thr_json *feet)
{
  thr_json_where list = {up, "feet", 0};

  if (feet && !thr_json_is_array(feet))
    return thr_json_bad(reader, &list, "not a list of node numbers");

  /* Nodes are named by their numbers. */
  for (int i = 0; i < thr_json_size(feet); i++) {
    thr_json_where here = {&list, NULL, i};
    int v = 0;
    thr_status st = thr_json_index(reader, &here, thr_json_at(feet, i), reader->d->n_nodes, &v);
    if (st) return st;
    reader->d->node[v].foot = true;
  }

  return THR_OK;
}

/* Reads nodes, edges, faces and feet, in this order, because each names what came before. */
thr_status thr_json_read_own(thr_json_reader *reader, const thr_json_where *at,
                             const thr_json *object)
{
  const char *node_key;
  const thr_json *nodes = THR_JSON_MEMBER(object, &node_key, "nodes", "vertices");
  const thr_json *faces = thr_json_get(object, "faces");
  double version;
  thr_json_where node_list = {at, node_key, 0}, face_list = {at, "faces", 0};

  /* A newer version may mean other things by the same words. */
  if (thr_json_number(thr_json_get(object, "version"), &version) && version > 1 &&
      thr_json_get(object, "format"))
    return thr_json_bad(reader, at,
                        "written by a newer version of this program; this one reads version 1");

  if (!thr_json_is_array(nodes))
    return thr_json_bad(reader, &node_list, "not a list of points [x, y, z]");

  /* Units and nodes first, because the rest names nodes. */
  thr_status st = thr_json_units(reader, at, "units", thr_json_get(object, "units"));
  if (!st) st = read_own_nodes(reader, &node_list, nodes, thr_json_get(object, "names"));
  if (!st) st = read_own_edges(reader, at, object);

  for (int i = 0; i < thr_json_size(faces) && !st; i++) {
    thr_json_where here = {&face_list, NULL, i};
    st = read_polygon(reader, &here, thr_json_at(faces, i));
  }

  return st ? st : read_feet(reader, at, thr_json_get(object, "feet"));
}

thr_status thr_json_read_plan(thr_json_reader *reader, const thr_json_where *at,
                              const thr_json *object)
{
  thr_json_where here = {at, "framework", 0};
  const thr_json *frame = thr_json_get(object, "framework");
  return thr_json_is_object(frame) ? thr_json_read_own(reader, &here, frame)
                                   : thr_json_bad(reader, &here, "missing from the plan");
}
