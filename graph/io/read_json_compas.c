/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads frameworks of architects' programs in JSON: COMPAS 1.x and 2.x (networks and meshes), lists
 * of lines and polylines of COMPAS and Rhino, GeoJSON (RFC 7946), assembly_instances and conmech.
 *
 * Each of these has nodes by key or by number and edges that name two of them, or lines that repeat
 * coordinates. Nodes become those of the draft in the order of their keys, and keep the keys as
 * their names.
 *
 * Example of COMPAS 1.x, a triangle:
 *     {"node": {"0": {"x": 0}, "1": {"x": 20}, "2": {"y": 20}},
 *      "edge": {"0": {"1": {}, "2": {}}, "1": {"2": {}}}} */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A member of an object, for sorting by key. */
typedef struct {
  const char *key;
  const thr_json *value;
  int64_t number; /* of the key, if all keys are numbers */
  int index;      /* in the file */
} keyed_member;

/* Compares two members by the numbers of their keys, then by their place in the file. */
static int by_number(const void *pa, const void *pb)
{
  const keyed_member *a = pa, *b = pb;
  if (a->number != b->number) return a->number < b->number ? -1 : 1;
  return (a->index > b->index) - (a->index < b->index);
}

bool thr_json_parse_key(const char *key, int64_t *number)
{
  size_t n = strlen(key), digits = strspn(key + (*key == '-'), "0123456789");
  if (digits == 0 || digits > 18 || digits + (*key == '-') != n) return false;
  *number = strtoll(key, NULL, 10);
  return true;
}

/* Sets *foot if a value says yes. A list says yes if one of its values does: the list's values are
 * the directions in which a support holds the node. */
static thr_status take_truth(thr_json_reader *reader, const thr_json_where *at,
                             const thr_json *value, bool *foot)
{
  thr_status st = THR_OK;

  /* true, and numbers other than 0. */
  bool yes = thr_json_true(value);
  for (int i = 0; thr_json_is_array(value) && i < thr_json_size(value) && !st && !yes; i++) {
    thr_json_where here = {at, NULL, i};
    st = take_truth(reader, &here, thr_json_at(value, i), &yes);
  }

  /* Words in a few languages. */
  if (thr_json_string(value) &&
      !thr_span_truth(thr_span_trim(thr_span_of(thr_json_string(value))), &yes))
    st = thr_json_bad(reader, at, "does not say whether this is a foot; use true or false");
  *foot |= yes;

  return st;
}

/* Finds whether a support holds its node in any direction. A support that lists no directions
 * does. */
static thr_status take_directions(thr_json_reader *reader, const thr_json_where *at,
                                  const thr_json *support, bool *held)
{
  const char *key;
  const thr_json *directions = THR_JSON_MEMBER(support, &key, "condition", "fixities");
  thr_json_where here = {at, key, 0};
  *held = !thr_json_is_array(directions);
  return take_truth(reader, &here, directions, held);
}

/* Finds whether a node is a support: one of several words says so, and it is held in some
 * direction. */
thr_status thr_json_support(thr_json_reader *reader, const thr_json_where *at, const thr_json *node,
                            const thr_json *defaults, bool *foot)
{
  /* The words that COMPAS, its extensions and conmech use. */
  static const char *const said[] = {"is_support", "is_anchor", "is_fixed", "is_grounded", "foot"};
  thr_status st = THR_OK;
  bool held = true;
  *foot = false;

  /* A node's own word counts before the default of all nodes. */
  for (size_t i = 0; i < sizeof said / sizeof *said && !st; i++) {
    thr_json_where here = {at, said[i], 0};
    const thr_json *own = thr_json_get(node, said[i]);
    st = take_truth(reader, &here, own ? own : thr_json_get(defaults, said[i]), foot);
  }

  /* A support that lists only free directions is none. */
  if (!st && *foot) st = take_directions(reader, at, node, &held);
  *foot = *foot && held;
  return st;
}

/* Lists an object's members in *list, which the caller frees, also on failure. Keys that are all
 * integers come in numeric order, so that node i is key i. */
static thr_status list_members(thr_json_reader *reader, const thr_json *object, keyed_member **list)
{
  keyed_member *member = *list = thr_calloc((size_t)thr_json_size(object), sizeof *member);

  if (!member) return thr_nomem(reader->err);
  bool numbers = true;
  int n = 0;
  void *iter = NULL;

  /* The value is written into the list at once, so the loop must end before the list does. */
  for (const char *key; thr_json_next(object, &iter, &key, &member[n].value); n++) {
    member[n].key = key;
    member[n].index = n;
    numbers = numbers && thr_json_parse_key(key, &member[n].number);
    if (n + 1 == thr_json_size(object)) break; /* no room to look for another */
  }

  if (numbers) qsort(member, (size_t)thr_json_size(object), sizeof *member, by_number);
  return THR_OK;
}

/* Appends the nodes of an object {key: attributes} to the draft. */
static thr_status read_compas_nodes(thr_json_reader *reader, const thr_json_where *list,
                                    const thr_json *nodes, const thr_json *defaults)
{
  keyed_member *member;
  thr_status st = list_members(reader, nodes, &member);

  for (int i = 0; i < thr_json_size(nodes) && !st; i++) {
    thr_json_where here = {list, member[i].key, 0};
    double xyz[3];
    bool foot;

    /* Where the node is, whether it is a support, and what it is called. */
    const char *name;
    st = thr_json_point(reader, &here, member[i].value, defaults, xyz);
    if (!st) st = thr_json_support(reader, &here, member[i].value, defaults, &foot);

    /* A node is called by its key. */
    if (!st) st = thr_json_key_name(reader, &here, member[i].key, &name);
    if (!st) st = thr_draft_add_node(reader->d, xyz, name, foot, reader->err);
  }

  free(member);
  return st;
}

/* Appends the edges of an object {u: {v: ..}}. both_ways: an adjacency list, which says each edge
 * from both ends; only one of the two counts. */
static thr_status read_compas_edges(thr_json_reader *reader, const thr_json_where *list,
                                    const thr_json *edges, bool both_ways)
{
  void *outer = NULL;
  const char *from, *to, *name;
  const thr_json *targets, *unused;

  while (thr_json_next(edges, &outer, &from, &targets)) {
    thr_json_where here = {list, from, 0};
    void *inner = NULL;
    int a, b;

    if (!thr_json_is_object(targets))
      return thr_json_bad(reader, &here, "not an object of neighbours");

    /* One end. */
    thr_status st = thr_json_key_name(reader, &here, from, &name);
    if (!st) st = thr_json_find_node(reader, &here, name, &a);

    /* Its neighbours are the other ends. */
    while (!st && thr_json_next(targets, &inner, &to, &unused)) {
      thr_json_where there = {&here, to, 0};
      st = thr_json_key_name(reader, &there, to, &name);
      if (!st) st = thr_json_find_node(reader, &there, name, &b);

      /* The edge comes from the lower end as well. */
      if (!st && both_ways && a > b && thr_json_get(thr_json_get(edges, to), from)) continue;
      if (!st) st = thr_draft_add_edge(reader->d, a, b, 0, reader->err);
    }
    if (st) return st;
  }

  return THR_OK;
}

/* Appends a face, which is a list of vertices, to reader->faces. */
static thr_status read_compas_face(thr_json_reader *reader, const thr_json_where *at,
                                   const thr_json *face)
{
  int n = thr_json_size(face), *corner = thr_calloc((size_t)n, sizeof *corner);

  if (!corner) return thr_nomem(reader->err);
  thr_status st =
      thr_json_is_array(face) ? THR_OK : thr_json_bad(reader, at, "not a face; list its vertices");

  /* Corners are named by the keys of the vertices. */
  for (int i = 0; i < n && !st; i++) {
    thr_json_where here = {at, NULL, i};
    st = thr_json_reference(reader, &here, thr_json_at(face, i), &corner[i]);
  }

  if (!st) st = thr_faces_add(&reader->faces, corner, n, reader->err);
  free(corner);
  return st;
}

/* Appends the faces of a list (COMPAS 2) or an object (COMPAS 1). */
static thr_status read_compas_faces(thr_json_reader *reader, const thr_json_where *list,
                                    const thr_json *faces)
{
  thr_status st = THR_OK;

  /* In a list faces have no keys. */
  for (int i = 0; thr_json_is_array(faces) && i < thr_json_size(faces) && !st; i++) {
    thr_json_where here = {list, NULL, i};
    st = read_compas_face(reader, &here, thr_json_at(faces, i));
  }

  /* In an object each face has a key. */
  void *iter = NULL;
  const char *key;
  const thr_json *face;

  while (!st && thr_json_next(faces, &iter, &key, &face)) {
    thr_json_where here = {list, key, 0};
    st = read_compas_face(reader, &here, face);
  }

  return st;
}

/* Reads a COMPAS network or mesh. */
thr_status thr_json_read_compas(thr_json_reader *reader, const thr_json_where *at,
                                const thr_json *object)
{
  /* Networks have nodes and edges, meshes vertices and faces. */
  const char *node_key, *default_key, *edge_key;
  const thr_json *nodes = THR_JSON_MEMBER(object, &node_key, "node", "vertex");
  const thr_json *defaults = THR_JSON_MEMBER(object, &default_key, "default_node_attributes",
                                             "default_vertex_attributes", "dna", "dva");
  const thr_json *edges = THR_JSON_MEMBER(object, &edge_key, "edge", "adjacency"),
                 *faces = thr_json_get(object, "face");

  thr_json_where node_list = {at, node_key, 0}, face_list = {at, "face", 0};
  thr_status st = read_compas_nodes(reader, &node_list, nodes, defaults);
  if (!st) st = thr_names_build(&reader->names, reader->d, reader->file, reader->err);

  /* Only without edges and faces half-edges are read, because they repeat the sides of faces. */
  if (!st && thr_json_size(edges) == 0 && thr_json_size(faces) == 0)
    edges = THR_JSON_MEMBER(object, &edge_key, "adjacency", "halfedge");

  thr_json_where edge_list = {at, edge_key, 0};

  /* "edge" has each edge once. */
  bool both_ways = strcmp(edge_key, "edge") != 0;
  if (!st) st = read_compas_edges(reader, &edge_list, edges, both_ways);
  return st ? st : read_compas_faces(reader, &face_list, faces);
}

/* ---- lines: [[[x, y, z], [x, y, z]], ..] or COMPAS Line and Polyline objects, in a list or an
 * object ---- */

/* A list of points. */
const thr_json *thr_json_points_of_line(const thr_json *value, const char *const **end)
{
  static const char *const ends[][2] = {
      {"start", "end"}, {"From", "To"}, {"from", "to"}}; /* COMPAS; Rhino */
  const char *which;
  *end = ends[0];

  if (thr_json_is_array(value)) return value;

  /* COMPAS 1 wraps objects in "value", COMPAS 2 in "data". */
  const thr_json *data = THR_JSON_MEMBER(value, &which, "data", "value");
  if (!data) data = value;

  /* A polyline. */
  const thr_json *points = thr_json_get(data, "points");
  if (points) return points;

  /* A line, by the words of COMPAS or of Rhino. */
  for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
    if (!thr_json_get(data, ends[i][0]) || !thr_json_get(data, ends[i][1])) continue;
    *end = ends[i];
    return data;
  }

  return NULL;
}

/* Appends a line or polyline: each of its points becomes a node, to be welded later, and each two
 * consecutive points an edge. */
static thr_status read_line(thr_json_reader *reader, const thr_json_where *at,
                            const thr_json *value)
{
  const char *const *end;
  const thr_json *points = thr_json_points_of_line(value, &end);
  bool two = thr_json_is_object(points);
  int n = two ? 2 : thr_json_size(points);

  if (n < 2) return thr_json_bad(reader, at, "not a line; give at least two points");
  thr_status st = THR_OK;

  /* Points and edges in turn. */
  for (int i = 0; i < n && !st; i++) {
    thr_json_where here = {at, two ? end[i] : NULL, i};
    double xyz[3];
    st = thr_json_point(reader, &here, two ? thr_json_get(points, end[i]) : thr_json_at(points, i),
                        NULL, xyz);
    if (!st) st = thr_draft_add_node(reader->d, xyz, NULL, false, reader->err);
    if (!st && i)
      st = thr_draft_add_edge(reader->d, reader->d->n_nodes - 2, reader->d->n_nodes - 1, 0,
                              reader->err);
  }

  return st;
}

thr_status thr_json_read_lines(thr_json_reader *reader, const thr_json_where *at,
                               const thr_json *list)
{
  thr_status st = THR_OK;

  /* Lines in a list. */
  for (int i = 0; thr_json_is_array(list) && i < thr_json_size(list) && !st; i++) {
    thr_json_where here = {at, NULL, i};
    st = read_line(reader, &here, thr_json_at(list, i));
  }

  /* Lines in an object. */
  void *iter = NULL;
  const char *key;
  const thr_json *line;

  while (!st && thr_json_next(list, &iter, &key, &line)) {
    thr_json_where here = {at, key, 0};
    st = read_line(reader, &here, line);
  }

  return st;
}

/* ---- GeoJSON: RFC 7946, its coordinates taken as they are ---- */

/* Returns how deep lists of points are in the coordinates of a geometry: 1 for one line, 2 for a
 * list of lines and so on; 0 for points, which have no lines; -1 for anything else. */
static int depth_of_geometry(const thr_json *value)
{
  static const struct {
    const char *type;
    int depth;
  } known[] = {{"LineString", 1},   {"MultiLineString", 2}, {"Polygon", 2},
               {"MultiPolygon", 3}, {"Point", 0},           {"MultiPoint", 0}};

  const char *type = thr_json_string(thr_json_get(value, "type"));

  /* Only geometries with coordinates count. */
  for (size_t i = 0; type && thr_json_is_array(thr_json_get(value, "coordinates")) &&
                     i < sizeof known / sizeof *known;
       i++)
    if (strcmp(type, known[i].type) == 0) return known[i].depth;

  return -1;
}

bool thr_json_is_geometry(const thr_json *value)
{
  return depth_of_geometry(value) >= 0;
}

/* Appends the lines that are `depth` lists deep. */
static thr_status read_nested_lines(thr_json_reader *reader, const thr_json_where *at,
                                    const thr_json *value, int depth)
{
  if (depth == 1) return read_line(reader, at, value);
  thr_status st =
      thr_json_is_array(value) ? THR_OK : thr_json_bad(reader, at, "not a list of lines");

  for (int i = 0; i < thr_json_size(value) && !st; i++) {
    thr_json_where here = {at, NULL, i};
    st = read_nested_lines(reader, &here, thr_json_at(value, i), depth - 1);
  }

  return st;
}

thr_status thr_json_read_geometry(thr_json_reader *reader, const thr_json_where *at,
                                  const thr_json *object)
{
  thr_json_where here = {at, "coordinates", 0};
  const int depth = depth_of_geometry(object);

  /* Points are counted as not used. */
  if (depth > 0)
    return read_nested_lines(reader, &here, thr_json_get(object, "coordinates"), depth);

  thr_report_skip(reader->report, thr_span_of(thr_json_string(thr_json_get(object, "type"))));
  return THR_OK;
}

/* ---- assembly_instances (node_list) and conmech (nodes) ---- */

/* Appends the nodes of a list; a node without an id is called by its number. */
static thr_status read_assembly_nodes(thr_json_reader *reader, const thr_json_where *list,
                                      const thr_json *nodes)
{
  for (int i = 0; i < thr_json_size(nodes); i++) {
    thr_json_where here = {list, NULL, i}, point = {&here, "point", 0};
    const thr_json *node = thr_json_at(nodes, i);
    const char *id_key, *name;
    double xyz[3];
    bool foot;

    /* Place and support. */
    thr_status st = thr_json_point(reader, &point, thr_json_get(node, "point"), NULL, xyz);
    if (!st) st = thr_json_support(reader, &here, node, NULL, &foot);
    if (st) return st;

    /* Its name. */
    const thr_json *id = THR_JSON_MEMBER(node, &id_key, "node_id", "node_ind");
    thr_json_where id_here = {&here, id_key, 0};
    char number[16];
    snprintf(number, sizeof number, "%d", i);
    name = number;
    if (id) st = thr_json_name_of(reader, &id_here, id, &name);
    if (!st) st = thr_draft_add_node(reader->d, xyz, name, foot, reader->err);
    if (st) return st;
  }

  return thr_names_build(&reader->names, reader->d, reader->file, reader->err);
}

/* Appends the edges of a list, each with the ids of two nodes. */
static thr_status read_assembly_elements(thr_json_reader *reader, const thr_json_where *list,
                                         const thr_json *elements)
{
  thr_status st = THR_OK;

  for (int e = 0; e < thr_json_size(elements) && !st; e++) {
    const char *key;
    const thr_json *ends =
        THR_JSON_MEMBER(thr_json_at(elements, e), &key, "end_node_ids", "end_node_inds");
    thr_json_where here = {list, NULL, e}, there = {&here, key, 0};

    /* Exactly two ends. */
    if (!thr_json_is_array(ends) || thr_json_size(ends) != 2)
      return thr_json_bad(reader, &there, "not two node numbers");

    /* Nodes are named by their ids. */
    int end[2] = {0, 0};
    for (int i = 0; i < 2 && !st; i++) {
      thr_json_where side = {&there, NULL, i};
      st = thr_json_reference(reader, &side, thr_json_at(ends, i), &end[i]);
    }
    if (!st) st = thr_draft_add_edge(reader->d, end[0], end[1], 0, reader->err);
  }

  return st;
}

/* Reads nodes, elements and supports, each of them a list. */
thr_status thr_json_read_assembly(thr_json_reader *reader, const thr_json_where *at,
                                  const thr_json *object)
{
  const char *node_key, *element_key, *unit_key;
  const thr_json *nodes = THR_JSON_MEMBER(object, &node_key, "node_list", "nodes");
  const thr_json *elements = THR_JSON_MEMBER(object, &element_key, "element_list", "elements"),
                 *supports = thr_json_get(object, "supports");
  const thr_json *units = THR_JSON_MEMBER(object, &unit_key, "unit", "units");
  thr_json_where node_list = {at, node_key, 0}, element_list = {at, element_key, 0},
                 support_list = {at, "supports", 0};

  /* Nodes first, so that the elements can name them. */
  thr_status st = thr_json_units(reader, at, unit_key, units);
  if (!st) st = read_assembly_nodes(reader, &node_list, nodes);
  if (!st) st = read_assembly_elements(reader, &element_list, elements);

  /* conmech lists the supports by themselves. */
  for (int i = 0; i < thr_json_size(supports) && !st; i++) {
    thr_json_where here = {&support_list, NULL, i}, id = {&here, "node_ind", 0};
    int v = 0;
    bool held;
    st = thr_json_reference(reader, &id, thr_json_get(thr_json_at(supports, i), "node_ind"), &v);
    if (!st) st = take_directions(reader, &here, thr_json_at(supports, i), &held);
    if (!st) reader->d->node[v].foot |= held;
  }

  return st;
}
