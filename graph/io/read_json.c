/* JSON frameworks: our own, COMPAS 1.x and 2.x, assembly_instances, conmech, networkx node-link and adjacency, Cytoscape, sigma
 * (docs/formats.md). The kind is told by its members. A document may hold several, however deep: those that stand where the
 * first one stands, but for numbers in lists, are read as one. */
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/io/faces.h"
#include "graph/io/formats.h"
#include "graph/io/parts.h"
#include "graph/io/read.h"
#include "graph/io/scan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The way to a value, for messages: data.node["21"].x. It lives on the stack along the descent. */
typedef struct where {
  const struct where *up; /* NULL at the document itself */
  const char *key;        /* NULL: an array's element */
  int index;
} where;

typedef struct {
  const char *file;
  thr_draft *d;
  thr_read_report *report;
  thr_err *err;
  thr_names names;
  thr_faces faces;
  thr_text scratch; /* for one name at a time */
  bool has_z;       /* some point has a z of its own */
  uint64_t *place;  /* [n_found] of the frameworks of the document, where each stands but for numbers (place_of); owned */
  int n_found, found_capacity;
  thr_parts parts; /* the frameworks */
  int n_seen;      /* in the second walk through the document */
  int n_chosen;    /* how many are read */
} reader;

static size_t write_path(const where *at, char *out, size_t size)
{
  if (!at || !at->up) return 0;
  size_t n = write_path(at->up, out, size);
  bool plain = at->key && *at->key && strspn(at->key, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_") == strlen(at->key);
  int length = !at->key ? snprintf(out + n, size - n, "[%d]", at->index)
               : plain  ? snprintf(out + n, size - n, "%s%.60s", n ? "." : "", at->key)
                        : snprintf(out + n, size - n, "[\"%.60s\"]", at->key);
  if (length > 0) n += (size_t)length;
  return n < size ? n : size - 1;
}

static thr_status bad(reader *r, const where *at, const char *what)
{
  char path[240] = "";
  write_path(at, path, sizeof path);
  return thr_fail(r->err, THR_EINPUT, "%s: %s: %s", r->file, *path ? path : "document", what);
}

static bool is_array(const thr_json *v)
{
  return thr_json_typeof(v) == THR_JSON_ARRAY;
}
static bool is_object(const thr_json *v)
{
  return thr_json_typeof(v) == THR_JSON_OBJECT;
}

/* First of the members named, and which it was. */
static const thr_json *member(const thr_json *object, const char *const *keys, const char **which)
{
  *which = keys[0];
  for (; *keys; keys++) {
    const thr_json *v = thr_json_get(object, *keys);
    if (!v) continue;
    *which = *keys;
    return v;
  }
  return NULL;
}

#define MEMBER(o, which, ...) member(o, (const char *const[]){__VA_ARGS__, NULL}, which)

/* ---- values ---- */

static thr_status read_number(reader *r, const where *at, const thr_json *v, double *x)
{
  if (!v) return bad(r, at, "missing; give a number");
  if (!thr_json_number(v, x)) return bad(r, at, "not a number; give a decimal number");
  if (*x == 0) *x = 0; /* -0 and 0 are written alike */
  return THR_OK;
}

/* Coordinates as [x, y, z] or as members x, y, z in either case, where defaults may stand in; a missing z is 0. */
static thr_status read_point(reader *r, const where *at, const thr_json *v, const thr_json *defaults, double xyz[3])
{
  static const char *const letter[] = {"x", "y", "z"}, *const capital[] = {"X", "Y", "Z"};
  if (thr_json_numbers(v, 3, xyz)) {
    for (int i = 0; i < 3; i++)
      if (xyz[i] == 0) xyz[i] = 0; /* -0, as below */
    r->has_z = true;
    return THR_OK;
  }
  if (!is_array(v) && !is_object(v)) return bad(r, at, "no coordinates; give [x, y, z]");
  for (int i = 0; i < 3; i++) {
    const char *which = NULL;
    const thr_json *c = is_array(v) ? thr_json_at(v, i) : MEMBER(v, &which, letter[i], capital[i]);
    if (!c) c = thr_json_get(defaults, letter[i]);
    where here = {at, which, i};
    xyz[i] = 0;
    if (i == 2 && !c) continue;
    r->has_z |= i == 2;
    thr_status st = read_number(r, &here, c, &xyz[i]);
    if (st) return st;
  }
  return THR_OK;
}

static thr_status read_length(reader *r, const where *at, const thr_json *v, double *length)
{
  *length = 0;
  if (thr_json_typeof(v) == THR_JSON_NULL) return THR_OK;
  thr_status st = read_number(r, at, v, length);
  return st || *length > 0 ? st : bad(r, at, "a length that is not positive; leave it out for the distance of the two nodes");
}

static thr_status count_of(const thr_json *v, const char *what, int *count, thr_err *err)
{
  int64_t wide = 0;
  if (thr_json_typeof(v) != THR_JSON_NULL && (!thr_json_int(v, &wide) || wide < 0 || wide > 100))
    return thr_fail(err, THR_EINPUT, "a %s that is not a whole number up to 100", what);
  *count = (int)wide;
  return THR_OK;
}

thr_status thr_json_edge_passes(thr_draft *draft, const thr_json *cover, const thr_json *capacity, thr_err *err)
{
  int least = 0, most = 0;
  thr_status st = count_of(cover, "cover", &least, err);
  if (!st) st = count_of(capacity, "capacity", &most, err);
  return st ? st : thr_draft_edge_passes(draft, least, most, err);
}

static thr_status read_passes(reader *r, const where *at, const thr_json *cover, const thr_json *capacity)
{
  thr_err why = {0};
  thr_status st = thr_json_edge_passes(r->d, cover, capacity, &why);
  return st ? bad(r, at, why.text) : THR_OK;
}

/* Index into n things. */
static thr_status read_index(reader *r, const where *at, const thr_json *v, int n, int *index)
{
  int64_t i;
  if (!thr_json_int(v, &i)) return bad(r, at, "not a node number; count nodes from 0");
  if (i >= 0 && i < n) {
    *index = (int)i;
    return THR_OK;
  }
  char what[80];
  snprintf(what, sizeof what, "there is no node %lld; the %d nodes count from 0", (long long)i, n);
  return bad(r, at, what);
}

/* What is not there, or null, leaves the default. */
static thr_status read_units(reader *r, const where *up, const char *key, const thr_json *v)
{
  where here = {up, key, 0};
  thr_err why = {0};
  if (thr_json_typeof(v) == THR_JSON_NULL) return THR_OK;
  if (!thr_json_string(v)) return bad(r, &here, "not text; name a unit of length");
  return thr_draft_set_units(r->d, thr_json_string(v), &why) ? bad(r, &here, why.text) : THR_OK;
}

/* ---- names ---- */

/* Appends a name without the quotes of a Python string. */
static void append_key(thr_text *text, const char *key)
{
  size_t n = strlen(key);
  bool quoted = n >= 2 && (key[0] == '\'' || key[0] == '"') && key[n - 1] == key[0];
  thr_text_append_bytes(text, key + quoted, n - 2 * (size_t)quoted);
}

static void append_name(thr_text *text, const thr_json *v)
{
  int64_t whole;
  double x;
  if (thr_json_string(v))
    thr_text_append(text, thr_json_string(v));
  else if (thr_json_int(v, &whole))
    thr_text_printf(text, "%lld", (long long)whole);
  else if (thr_json_number(v, &x))
    thr_text_double(text, x);
}

/* What a value calls a node: a string, a number, or a tuple of these, written (a, b) as Python does. The result is
 * valid until the next call. */
static thr_status name_of(reader *r, const where *at, const thr_json *v, const char **name)
{
  thr_text *text = &r->scratch;
  text->length = 0;
  thr_text_append(text, "");
  if (is_array(v)) {
    thr_text_append(text, "(");
    for (int i = 0; i < thr_json_size(v); i++) {
      thr_text_append(text, i ? ", " : "");
      append_name(text, thr_json_at(v, i));
    }
    thr_text_append(text, ")");
  } else {
    append_name(text, v);
  }
  if (text->failed) return thr_nomem(r->err);
  thr_text_clean(text->data); /* as the draft keeps it */
  *name = text->data;
  return text->length ? THR_OK : bad(r, at, "not a node's name; use a string or a whole number");
}

static thr_status key_name(reader *r, const where *at, const char *key, const char **name)
{
  thr_text *text = &r->scratch;
  text->length = 0;
  thr_text_append(text, "");
  append_key(text, key);
  if (text->failed) return thr_nomem(r->err);
  thr_text_clean(text->data);
  *name = text->data;
  return text->length ? THR_OK : bad(r, at, "an empty name");
}

static thr_status find_node(reader *r, const where *at, const char *name, int *node)
{
  *node = thr_names_find(&r->names, thr_span_of(name));
  if (*node >= 0) return THR_OK;
  char what[120];
  snprintf(what, sizeof what, "there is no node '%.60s'", name);
  return bad(r, at, what);
}

static thr_status read_reference(reader *r, const where *at, const thr_json *v, int *node)
{
  const char *name;
  if (!v) return bad(r, at, "missing; name a node");
  thr_status st = name_of(r, at, v, &name);
  return st ? st : find_node(r, at, name, node);
}

/* ---- our own frame, and any lists of points and index pairs ---- */

/* An edge [a, b] or a face [a, b, c, ..] by node numbers. */
static thr_status read_polygon(reader *r, const where *at, const thr_json *v)
{
  int n = thr_json_size(v), few[4], *corner = n <= 4 ? few : thr_calloc((size_t)n, sizeof *corner);
  if (!corner) return thr_nomem(r->err);
  thr_status st = is_array(v) && n >= 2 ? THR_OK : bad(r, at, "not a face; list its node numbers");
  for (int i = 0; i < n && !st; i++) {
    where here = {at, NULL, i};
    st = read_index(r, &here, thr_json_at(v, i), r->d->n_nodes, &corner[i]);
  }
  if (!st) st = thr_faces_add(&r->faces, corner, n, r->err);
  if (corner != few) free(corner);
  return st;
}

static thr_status read_own_nodes(reader *r, const where *at, const thr_json *nodes, const thr_json *names)
{
  where list = {at->up, at->key, at->index}, name_list = {at->up, "names", 0};
  if (names && (!is_array(names) || thr_json_size(names) != thr_json_size(nodes)))
    return bad(r, &name_list, "not one name for each node");
  for (int i = 0; i < thr_json_size(nodes); i++) {
    where here = {&list, NULL, i}, name_here = {&name_list, NULL, i};
    double xyz[3];
    const char *name = NULL;
    thr_status st = read_point(r, &here, thr_json_at(nodes, i), NULL, xyz);
    if (names) name = thr_json_string(thr_json_at(names, i));
    if (!st && names && (!name || !*name)) st = name_of(r, &name_here, thr_json_at(names, i), &name);
    if (!st) st = thr_draft_add_node(r->d, xyz, name, false, r->err);
    if (st) return st;
  }
  return THR_OK;
}

/* The member of object that says something of every edge, if there is one. */
static thr_status edge_list(reader *r, const where *up, const thr_json *object, const char *key, int n_edges,
                            const thr_json **list)
{
  where here = {up, key, 0};
  *list = thr_json_get(object, key);
  if (!*list || (is_array(*list) && thr_json_size(*list) == n_edges)) return THR_OK;
  return bad(r, &here, "not one for each edge");
}

/* The two nodes of an edge. */
static thr_status read_pair(reader *r, const where *at, const thr_json *pair, int end[2])
{
  if (!is_array(pair) || thr_json_size(pair) != 2) return bad(r, at, "not an edge; give two node numbers");
  if (thr_json_indices(pair, 2, r->d->n_nodes, end)) return THR_OK;
  thr_status st = THR_OK;
  for (int i = 0; i < 2 && !st; i++) {
    where side = {at, NULL, i};
    st = read_index(r, &side, thr_json_at(pair, i), r->d->n_nodes, &end[i]);
  }
  return st;
}

static thr_status read_own_edges(reader *r, const where *up, const thr_json *object)
{
  const char *key;
  const thr_json *edges = MEMBER(object, &key, "edges", "lines"), *lengths, *covers, *capacities;
  where list = {up, key, 0}, length_list = {up, "lengths", 0};
  if (edges && !is_array(edges)) return bad(r, &list, "not a list of node pairs");
  thr_status listed = edge_list(r, up, object, "lengths", thr_json_size(edges), &lengths);
  if (!listed) listed = edge_list(r, up, object, "covers", thr_json_size(edges), &covers);
  if (!listed) listed = edge_list(r, up, object, "capacities", thr_json_size(edges), &capacities);
  if (listed) return listed;
  for (int e = 0; e < thr_json_size(edges); e++) {
    where here = {&list, NULL, e}, length_here = {&length_list, NULL, e};
    int end[2];
    double length = 0;
    thr_status st = read_pair(r, &here, thr_json_at(edges, e), end);
    if (!st && lengths) st = read_length(r, &length_here, thr_json_at(lengths, e), &length);
    if (!st) st = thr_draft_add_edge(r->d, end[0], end[1], length, r->err);
    if (!st && (covers || capacities)) st = read_passes(r, &here, thr_json_at(covers, e), thr_json_at(capacities, e));
    if (st) return st;
  }
  return THR_OK;
}

static thr_status read_feet(reader *r, const where *up, const thr_json *feet)
{
  where list = {up, "feet", 0};
  if (feet && !is_array(feet)) return bad(r, &list, "not a list of node numbers");
  for (int i = 0; i < thr_json_size(feet); i++) {
    where here = {&list, NULL, i};
    int v = 0;
    thr_status st = read_index(r, &here, thr_json_at(feet, i), r->d->n_nodes, &v);
    if (st) return st;
    r->d->node[v].foot = true;
  }
  return THR_OK;
}

static thr_status read_own(reader *r, const where *at, const thr_json *object)
{
  const char *node_key;
  const thr_json *nodes = MEMBER(object, &node_key, "nodes", "vertices");
  const thr_json *faces = thr_json_get(object, "faces");
  double version;
  where node_list = {at, node_key, 0}, face_list = {at, "faces", 0};
  if (thr_json_number(thr_json_get(object, "version"), &version) && version > 1 && thr_json_get(object, "format"))
    return bad(r, at, "written by a newer version of this program; this one reads version 1");
  if (!is_array(nodes)) return bad(r, &node_list, "not a list of points [x, y, z]");
  thr_status st = read_units(r, at, "units", thr_json_get(object, "units"));
  if (!st) st = read_own_nodes(r, &node_list, nodes, thr_json_get(object, "names"));
  if (!st) st = read_own_edges(r, at, object);
  for (int i = 0; i < thr_json_size(faces) && !st; i++) {
    where here = {&face_list, NULL, i};
    st = read_polygon(r, &here, thr_json_at(faces, i));
  }
  return st ? st : read_feet(r, at, thr_json_get(object, "feet"));
}

static thr_status read_plan(reader *r, const where *at, const thr_json *object)
{
  where here = {at, "framework", 0};
  const thr_json *frame = thr_json_get(object, "framework");
  return is_object(frame) ? read_own(r, &here, frame) : bad(r, &here, "missing from the plan");
}

/* ---- COMPAS ---- */

typedef struct {
  const char *key;
  const thr_json *value;
  int64_t number; /* of the key, if all keys are numbers */
  int index;      /* in the file */
} keyed;

static int by_number(const void *pa, const void *pb)
{
  const keyed *a = pa, *b = pb;
  if (a->number != b->number) return a->number < b->number ? -1 : 1;
  return (a->index > b->index) - (a->index < b->index);
}

static bool parse_key(const char *key, int64_t *number)
{
  size_t n = strlen(key), digits = strspn(key + (*key == '-'), "0123456789");
  if (digits == 0 || digits > 18 || digits + (*key == '-') != n) return false;
  *number = strtoll(key, NULL, 10);
  return true;
}

static bool is_support(const thr_json *node, const thr_json *defaults)
{
  static const char *const said[] = {"is_support", "is_anchor", "is_fixed", "is_grounded"};
  for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
    const thr_json *own = thr_json_get(node, said[i]);
    if (thr_json_true(own ? own : thr_json_get(defaults, said[i]))) return true;
  }
  return false;
}

/* Lists an object's members; keys that are all integers come in numeric order, so that node i is key i. */
static thr_status list_members(reader *r, const thr_json *object, keyed **list)
{
  keyed *k = *list = thr_calloc((size_t)thr_json_size(object), sizeof *k);
  if (!k) return thr_nomem(r->err);
  bool numbers = true;
  int n = 0;
  void *iter = NULL;
  for (const char *key; thr_json_next(object, &iter, &key, &k[n].value); n++) {
    k[n].key = key;
    k[n].index = n;
    numbers = numbers && parse_key(key, &k[n].number);
    if (n + 1 == thr_json_size(object)) break; /* no room to look for another */
  }
  if (numbers) qsort(k, (size_t)thr_json_size(object), sizeof *k, by_number);
  return THR_OK;
}

static thr_status read_compas_nodes(reader *r, const where *list, const thr_json *nodes, const thr_json *defaults)
{
  keyed *k;
  thr_status st = list_members(r, nodes, &k);
  for (int i = 0; i < thr_json_size(nodes) && !st; i++) {
    where here = {list, k[i].key, 0};
    double xyz[3];
    const char *name;
    st = read_point(r, &here, k[i].value, defaults, xyz);
    if (!st) st = key_name(r, &here, k[i].key, &name);
    if (!st) st = thr_draft_add_node(r->d, xyz, name, is_support(k[i].value, defaults), r->err);
  }
  free(k);
  return st;
}

/* {u: {v: ..}}. Adjacency lists say each edge from both ends: then only one of the two counts. */
static thr_status read_compas_edges(reader *r, const where *list, const thr_json *edges, bool both_ways)
{
  void *outer = NULL;
  const char *from, *to, *name;
  const thr_json *targets, *unused;
  while (thr_json_next(edges, &outer, &from, &targets)) {
    where here = {list, from, 0};
    void *inner = NULL;
    int a, b;
    if (!is_object(targets)) return bad(r, &here, "not an object of neighbours");
    thr_status st = key_name(r, &here, from, &name);
    if (!st) st = find_node(r, &here, name, &a);
    while (!st && thr_json_next(targets, &inner, &to, &unused)) {
      where there = {&here, to, 0};
      st = key_name(r, &there, to, &name);
      if (!st) st = find_node(r, &there, name, &b);
      if (!st && both_ways && a > b && thr_json_get(thr_json_get(edges, to), from)) continue;
      if (!st) st = thr_draft_add_edge(r->d, a, b, 0, r->err);
    }
    if (st) return st;
  }
  return THR_OK;
}

/* A face is a list of vertices. */
static thr_status read_compas_face(reader *r, const where *at, const thr_json *face)
{
  int n = thr_json_size(face), *corner = thr_calloc((size_t)n, sizeof *corner);
  if (!corner) return thr_nomem(r->err);
  thr_status st = is_array(face) ? THR_OK : bad(r, at, "not a face; list its vertices");
  for (int i = 0; i < n && !st; i++) {
    where here = {at, NULL, i};
    st = read_reference(r, &here, thr_json_at(face, i), &corner[i]);
  }
  if (!st) st = thr_faces_add(&r->faces, corner, n, r->err);
  free(corner);
  return st;
}

static thr_status read_compas_faces(reader *r, const where *list, const thr_json *faces)
{
  thr_status st = THR_OK;
  for (int i = 0; is_array(faces) && i < thr_json_size(faces) && !st; i++) {
    where here = {list, NULL, i};
    st = read_compas_face(r, &here, thr_json_at(faces, i));
  }
  void *iter = NULL;
  const char *key;
  const thr_json *face;
  while (!st && thr_json_next(faces, &iter, &key, &face)) {
    where here = {list, key, 0};
    st = read_compas_face(r, &here, face);
  }
  return st;
}

static thr_status read_compas(reader *r, const where *at, const thr_json *object)
{
  const char *node_key, *default_key, *edge_key;
  const thr_json *nodes = MEMBER(object, &node_key, "node", "vertex");
  const thr_json *defaults = MEMBER(object, &default_key, "default_node_attributes", "default_vertex_attributes", "dna", "dva");
  const thr_json *edges = MEMBER(object, &edge_key, "edge", "adjacency"), *faces = thr_json_get(object, "face");
  where node_list = {at, node_key, 0}, face_list = {at, "face", 0};
  thr_status st = read_compas_nodes(r, &node_list, nodes, defaults);
  if (!st) st = thr_names_build(&r->names, r->d, r->file, r->err);
  if (!st && thr_json_size(edges) == 0 && thr_json_size(faces) == 0) edges = MEMBER(object, &edge_key, "adjacency", "halfedge");
  where edge_list = {at, edge_key, 0};
  bool both_ways = strcmp(edge_key, "edge") != 0;
  if (!st) st = read_compas_edges(r, &edge_list, edges, both_ways);
  return st ? st : read_compas_faces(r, &face_list, faces);
}

/* ---- lines: [[[x, y, z], [x, y, z]], ..] or COMPAS Line and Polyline objects, in a list or an object ---- */

/* Of a COMPAS Line the object with its start and end, of a Polyline the list of its points; NULL if it is neither. */
static const thr_json *points_of_line(const thr_json *v, const char **key)
{
  const char *which;
  *key = NULL;
  if (is_array(v)) return v;
  const thr_json *data = MEMBER(v, &which, "data", "value");
  if (!data) data = v;
  *key = "points";
  const thr_json *points = thr_json_get(data, "points");
  return points ? points : thr_json_get(data, "start") && thr_json_get(data, "end") ? data : NULL;
}

static thr_status read_line(reader *r, const where *at, const thr_json *v)
{
  static const char *const end[] = {"start", "end"};
  const char *key;
  const thr_json *points = points_of_line(v, &key);
  bool two = is_object(points);
  int n = two ? 2 : thr_json_size(points);
  if (n < 2) return bad(r, at, "not a line; give at least two points");
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++) {
    where here = {at, two ? end[i] : NULL, i};
    double xyz[3];
    st = read_point(r, &here, two ? thr_json_get(points, end[i]) : thr_json_at(points, i), NULL, xyz);
    if (!st) st = thr_draft_add_node(r->d, xyz, NULL, false, r->err);
    if (!st && i) st = thr_draft_add_edge(r->d, r->d->n_nodes - 2, r->d->n_nodes - 1, 0, r->err);
  }
  return st;
}

static thr_status read_lines(reader *r, const where *at, const thr_json *list)
{
  thr_status st = THR_OK;
  for (int i = 0; is_array(list) && i < thr_json_size(list) && !st; i++) {
    where here = {at, NULL, i};
    st = read_line(r, &here, thr_json_at(list, i));
  }
  void *iter = NULL;
  const char *key;
  const thr_json *line;
  while (!st && thr_json_next(list, &iter, &key, &line)) {
    where here = {at, key, 0};
    st = read_line(r, &here, line);
  }
  return st;
}

/* ---- assembly_instances (node_list) and conmech (nodes) ---- */

static thr_status read_assembly_nodes(reader *r, const where *list, const thr_json *nodes)
{
  for (int i = 0; i < thr_json_size(nodes); i++) {
    where here = {list, NULL, i}, point = {&here, "point", 0};
    const thr_json *node = thr_json_at(nodes, i);
    const char *id_key, *name;
    double xyz[3];
    thr_status st = read_point(r, &point, thr_json_get(node, "point"), NULL, xyz);
    if (st) return st;
    const thr_json *id = MEMBER(node, &id_key, "node_id", "node_ind");
    where id_here = {&here, id_key, 0};
    char number[16];
    snprintf(number, sizeof number, "%d", i);
    name = number;
    if (id) st = name_of(r, &id_here, id, &name);
    if (!st) st = thr_draft_add_node(r->d, xyz, name, is_support(node, NULL), r->err);
    if (st) return st;
  }
  return thr_names_build(&r->names, r->d, r->file, r->err);
}

static thr_status read_assembly_elements(reader *r, const where *list, const thr_json *elements)
{
  thr_status st = THR_OK;
  for (int e = 0; e < thr_json_size(elements) && !st; e++) {
    const char *key;
    const thr_json *ends = MEMBER(thr_json_at(elements, e), &key, "end_node_ids", "end_node_inds");
    where here = {list, NULL, e}, there = {&here, key, 0};
    if (!is_array(ends) || thr_json_size(ends) != 2) return bad(r, &there, "not two node numbers");
    int end[2] = {0, 0};
    for (int i = 0; i < 2 && !st; i++) {
      where side = {&there, NULL, i};
      st = read_reference(r, &side, thr_json_at(ends, i), &end[i]);
    }
    if (!st) st = thr_draft_add_edge(r->d, end[0], end[1], 0, r->err);
  }
  return st;
}

static thr_status read_assembly(reader *r, const where *at, const thr_json *object)
{
  const char *node_key, *element_key, *unit_key;
  const thr_json *nodes = MEMBER(object, &node_key, "node_list", "nodes");
  const thr_json *elements = MEMBER(object, &element_key, "element_list", "elements"),
                 *supports = thr_json_get(object, "supports");
  const thr_json *units = MEMBER(object, &unit_key, "unit", "units");
  where node_list = {at, node_key, 0}, element_list = {at, element_key, 0}, support_list = {at, "supports", 0};
  thr_status st = read_units(r, at, unit_key, units);
  if (!st) st = read_assembly_nodes(r, &node_list, nodes);
  if (!st) st = read_assembly_elements(r, &element_list, elements);
  for (int i = 0; i < thr_json_size(supports) && !st; i++) {
    where here = {&support_list, NULL, i}, id = {&here, "node_ind", 0};
    int v = 0;
    st = read_reference(r, &id, thr_json_get(thr_json_at(supports, i), "node_ind"), &v);
    if (!st) r->d->node[v].foot = true;
  }
  return st;
}

/* ---- networkx, Cytoscape, sigma: lists of nodes and of links, each an object ---- */

/* What is said of a node or a link: in its member data (Cytoscape) or attributes (graphology, sigma), or beside its name. */
static const thr_json *said_of(const thr_json *item)
{
  const char *key;
  const thr_json *said = MEMBER(item, &key, "data", "attributes");
  return is_object(said) ? said : item;
}

/* First of an item's members that says something, in what is said of it or beside that. */
static const thr_json *said(const thr_json *item, const char *const *keys, const char **which)
{
  const thr_json *v = member(said_of(item), keys, which);
  return v ? v : member(item, keys, which);
}

#define SAID(item, which, ...) said(item, (const char *const[]){__VA_ARGS__, NULL}, which)

static thr_status read_link(reader *r, const where *at, const thr_json *link)
{
  const char *key;
  where source = {at, "source", 0}, target = {at, "target", 0}, length_here = {at, "length", 0};
  int a = 0, b = 0;
  double length;
  thr_status st = read_reference(r, &source, SAID(link, &key, "source"), &a);
  if (!st) st = read_reference(r, &target, SAID(link, &key, "target"), &b);
  if (!st) st = read_length(r, &length_here, SAID(link, &key, "length"), &length);
  if (!st) st = thr_draft_add_edge(r->d, a, b, length, r->err);
  return st ? st : read_passes(r, at, SAID(link, &key, "cover"), SAID(link, &key, "capacity"));
}

/* A node's place: pos, else x and y, else position (where Cytoscape has drawn it). */
static thr_status read_graph_node(reader *r, const where *at, const thr_json *node, int i)
{
  const char *key, *x_key, *id_key;
  const thr_json *pos = SAID(node, &key, "pos"), *x = SAID(node, &x_key, "x", "X"), *id = SAID(node, &id_key, "id", "key");
  if (!pos && !x) pos = SAID(node, &key, "position");
  if (!pos) pos = thr_json_get(said_of(node), x_key) ? said_of(node) : node;
  where pos_here = {at, key, 0}, id_here = {at, id_key, 0};
  double xyz[3];
  char number[16];
  snprintf(number, sizeof number, "%d", i);
  const char *name = number;
  thr_status st = read_point(r, x || strcmp(key, "pos") == 0 ? at : &pos_here, pos, NULL, xyz);
  if (!st && id) st = name_of(r, &id_here, id, &name);
  return st ? st : thr_draft_add_node(r->d, xyz, name, is_support(said_of(node), node), r->err);
}

static thr_status read_graph_nodes(reader *r, const where *list, const thr_json *nodes)
{
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(nodes) && !st; i++) {
    where here = {list, NULL, i};
    st = read_graph_node(r, &here, thr_json_at(nodes, i), i);
  }
  return st ? st : thr_names_build(&r->names, r->d, r->file, r->err);
}

static thr_status read_node_link(reader *r, const where *at, const thr_json *object)
{
  const char *link_key;
  const thr_json *nodes = thr_json_get(object, "nodes"), *links = MEMBER(object, &link_key, "links", "edges");
  where node_list = {at, "nodes", 0}, link_list = {at, link_key, 0};
  thr_status st = read_graph_nodes(r, &node_list, nodes);
  for (int i = 0; i < thr_json_size(links) && !st; i++) {
    where here = {&link_list, NULL, i};
    st = read_link(r, &here, thr_json_at(links, i));
  }
  return st;
}

/* Cytoscape: {"elements": {"nodes": .., "edges": ..}}, or one list of both in which links name a source. */
static thr_status read_cytoscape(reader *r, const where *at, const thr_json *object)
{
  const thr_json *elements = thr_json_get(object, "elements");
  const char *key;
  where here = {at, "elements", 0};
  thr_status st = THR_OK;
  if (is_object(elements)) return read_node_link(r, &here, elements);
  for (int i = 0; i < thr_json_size(elements) && !st; i++) {
    where item = {&here, NULL, i};
    if (!SAID(thr_json_at(elements, i), &key, "source")) st = read_graph_node(r, &item, thr_json_at(elements, i), r->d->n_nodes);
  }
  if (!st) st = thr_names_build(&r->names, r->d, r->file, r->err);
  for (int i = 0; i < thr_json_size(elements) && !st; i++) {
    where item = {&here, NULL, i};
    if (SAID(thr_json_at(elements, i), &key, "source")) st = read_link(r, &item, thr_json_at(elements, i));
  }
  return st;
}

/* Does the list of neighbours name node v? */
static thr_status lists_node(reader *r, const where *at, const thr_json *neighbours, int v, bool *lists)
{
  *lists = false;
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(neighbours) && !st && !*lists; i++) {
    where here = {at, NULL, i};
    int to = -1;
    st = read_reference(r, &here, thr_json_get(thr_json_at(neighbours, i), "id"), &to);
    *lists = to == v;
  }
  return st;
}

/* networkx adjacency data: for each node the list of its neighbours. An edge that both ends list counts once. */
static thr_status read_adjacency(reader *r, const where *at, const thr_json *object)
{
  const thr_json *nodes = thr_json_get(object, "nodes"), *adjacency = thr_json_get(object, "adjacency");
  where node_list = {at, "nodes", 0}, list = {at, "adjacency", 0};
  if (thr_json_size(adjacency) != thr_json_size(nodes)) return bad(r, &list, "not one list of neighbours for each node");
  thr_status st = read_graph_nodes(r, &node_list, nodes);
  for (int v = 0; v < thr_json_size(adjacency) && !st; v++) {
    const thr_json *neighbours = thr_json_at(adjacency, v);
    where here = {&list, NULL, v};
    for (int i = 0; i < thr_json_size(neighbours) && !st; i++) {
      const thr_json *item = thr_json_at(neighbours, i);
      where there = {&here, NULL, i}, back = {&list, NULL, 0}, length_here = {&there, "length", 0};
      int to = 0;
      bool twice = false;
      double length;
      st = read_reference(r, &there, thr_json_get(item, "id"), &to);
      back.index = to;
      if (!st && to < v) st = lists_node(r, &back, thr_json_at(adjacency, to), v, &twice);
      if (!st) st = read_length(r, &length_here, thr_json_get(item, "length"), &length);
      if (st || twice) continue;
      st = thr_draft_add_edge(r->d, v, to, length, r->err);
      if (!st) st = read_passes(r, &there, thr_json_get(item, "cover"), thr_json_get(item, "capacity"));
    }
  }
  return st;
}

/* ---- which one is it? ---- */

typedef thr_status read_function(reader *r, const where *at, const thr_json *v);

static bool ends_in(const char *text, const char *end)
{
  const size_t n = strlen(text), m = strlen(end);
  return n >= m && strcmp(text + n - m, end) == 0;
}

/* A bare list of points is taken for a line only where lines are expected. */
static bool is_line(const thr_json *v, bool expected)
{
  const char *key, *type = thr_json_string(thr_json_get(v, "dtype"));
  double x;
  if (type ? !ends_in(type, "Line") && !ends_in(type, "/Polyline") : !expected) return false;
  const thr_json *points = points_of_line(v, &key);
  return is_object(points) || (thr_json_size(points) >= 2 && thr_json_number(thr_json_at(thr_json_at(points, 0), 0), &x)) ||
         (is_object(v) && is_object(thr_json_at(points, 0)));
}

/* Lines are expected at the top of a document and in a member called lines; elsewhere only objects that say what they are count.
 * Of an object each member must be a line. */
static bool is_line_list(const where *at, const thr_json *v)
{
  const bool expected = !at->up || (at->key && ends_in(at->key, "lines"));
  if (is_array(v)) return is_line(thr_json_at(v, 0), expected);
  void *iter = NULL;
  const char *key;
  const thr_json *member;
  bool lines = thr_json_size(v) > 0;
  while (lines && thr_json_next(v, &iter, &key, &member))
    lines = is_line(member, expected && is_object(member));
  return lines;
}

static read_function *recognise(const where *at, const thr_json *v)
{
  if (is_array(v)) return is_line_list(at, v) ? read_lines : NULL;
  if (!is_object(v)) return NULL;
  const char *format = thr_json_string(thr_json_get(v, "format"));
  if (format && strcmp(format, "thread-plan") == 0) return read_plan;
  if (format && strcmp(format, "thread-frame") == 0) return read_own;

  const char *key;
  const thr_json *nodes = MEMBER(v, &key, "nodes", "vertices"), *links = MEMBER(v, &key, "links", "edges", "lines", "faces");
  const thr_json *elements = thr_json_get(v, "elements");
  if (is_array(thr_json_get(v, "node_list")) && is_array(thr_json_get(v, "element_list"))) return read_assembly;
  if (is_array(nodes) && is_array(elements)) return read_assembly;
  if (is_array(nodes) && is_array(links) && is_array(thr_json_at(nodes, 0))) return read_own;
  if (is_array(thr_json_get(v, "nodes")) && is_object(thr_json_at(nodes, 0))) {
    if (is_array(links)) return read_node_link;
    if (is_array(thr_json_get(v, "adjacency"))) return read_adjacency;
  }
  if (is_array(thr_json_get(elements, "nodes")) || is_object(thr_json_get(thr_json_at(elements, 0), "data")))
    return read_cytoscape;

  const thr_json *keyed_nodes = MEMBER(v, &key, "node", "vertex");
  if (is_object(keyed_nodes) && MEMBER(v, &key, "edge", "face", "adjacency", "halfedge")) return read_compas;
  return is_line_list(at, v) ? read_lines : NULL;
}

/* FNV-1a of the way to a value without numbers, be they indices or keys. */
static uint64_t place_of(const where *at)
{
  uint64_t hash = at->up ? place_of(at->up) : UINT64_C(0xcbf29ce484222325);
  int64_t number;
  const bool numbered = at->up && (!at->key || parse_key(at->key, &number));
  for (const char *c = numbered || !at->key ? "*" : at->key; *c; c++)
    hash = (hash ^ (unsigned char)*c) * UINT64_C(0x100000001b3);
  return (hash ^ '/') * UINT64_C(0x100000001b3);
}

/* What a framework of the document is called: by its member name, else by the nearest key above it. */
static thr_span called(const where *at, const thr_json *v)
{
  const char *name = is_object(v) ? thr_json_string(thr_json_get(v, "name")) : NULL;
  for (; !name && at; at = at->up)
    if (at->key) name = at->key;
  return thr_span_of(name ? name : "");
}

/* Notes where a framework of the document stands. */
static thr_status note_place(reader *r, const where *at, const thr_json *v, read_function *read)
{
  (void)read;
  int part;
  thr_status st = thr_grow(&r->place, r->n_found, &r->found_capacity, sizeof *r->place, r->err);
  if (st) return st;
  r->place[r->n_found++] = place_of(at);
  return thr_parts_add(&r->parts, called(at, v), &part, r->err);
}

static bool is_chosen(const reader *r, int i)
{
  return r->d->pick ? thr_parts_has(&r->parts, i) : r->place[i] == r->place[0];
}

/* Reads a framework into a draft of its own and appends that, its nodes called by its number as well: 3:17. */
static thr_status read_part(reader *r, const where *at, const thr_json *v, read_function *read)
{
  thr_draft *whole = r->d, part = {.flat = whole->flat};
  char prefix[16];
  snprintf(prefix, sizeof prefix, "%d:", r->n_seen);
  r->d = &part;
  thr_status st = read(r, at, v);
  if (!st) st = thr_faces_finish(&r->faces, &part, r->file, r->err);
  if (!st && whole->units[0] && strcmp(whole->units, part.units) != 0)
    st = bad(r, at, "in other units than the one before it; read one of them with --pick");
  if (!st) st = thr_draft_append(whole, &part, prefix, r->err);
  r->d = whole;
  thr_names_destroy(&r->names);
  thr_faces_destroy(&r->faces);
  thr_draft_destroy(&part);
  return st;
}

static thr_status read_chosen(reader *r, const where *at, const thr_json *v, read_function *read)
{
  if (!is_chosen(r, r->n_seen++)) return THR_OK;
  return r->n_chosen > 1 ? read_part(r, at, v, read) : read(r, at, v);
}

/* Calls visit for each framework, which are not looked into. Depth is bounded by the JSON parser. */
static thr_status walk(reader *r, const where *at, const thr_json *v,
                       thr_status (*visit)(reader *r, const where *at, const thr_json *v, read_function *read))
{
  read_function *read = recognise(at, v);
  if (read) return visit(r, at, v, read);
  thr_status st = THR_OK;
  for (int i = 0; is_array(v) && i < thr_json_size(v) && !st; i++) {
    where here = {at, NULL, i};
    st = walk(r, &here, thr_json_at(v, i), visit);
  }
  void *iter = NULL;
  const char *key;
  const thr_json *value;
  while (!st && thr_json_next(v, &iter, &key, &value)) {
    where here = {at, key, 0};
    st = walk(r, &here, value, visit);
  }
  return st;
}

static thr_status read_document(reader *r, const thr_json *doc)
{
  where top = {0};
  thr_status st = walk(r, &top, doc, note_place);
  if (!st && !r->n_found)
    st = thr_fail(r->err, THR_EINPUT, "%s: no framework in this JSON; docs/formats.md shows the forms that are read", r->file);
  if (!st) st = thr_parts_choose(&r->parts, r->file, "framework", "frameworks", r->err);
  for (int i = 0; i < r->n_found && !st; i++)
    r->n_chosen += is_chosen(r, i);
  if (!st) st = walk(r, &top, doc, read_chosen);
  return st ? st : thr_faces_finish(&r->faces, r->d, r->file, r->err);
}

static thr_status parse(thr_draft *draft, thr_read_report *read_report, const char *text, size_t n, const char *name,
                        thr_err *err)
{
  thr_json *doc;
  thr_status st = thr_json_parse(&doc, text, n, name, err);
  if (st) return st;
  reader reading = {.file = name, .d = draft, .report = read_report, .err = err, .parts = {.asked = draft->pick}};
  st = read_document(&reading, doc);
  thr_parts_finish(&reading.parts, read_report);
  read_report->frameworks = reading.n_found;
  read_report->frameworks_read = reading.n_chosen;
  read_report->no_z = !reading.has_z;
  thr_names_destroy(&reading.names);
  thr_faces_destroy(&reading.faces);
  thr_text_destroy(&reading.scratch);
  free(reading.place);
  thr_json_destroy(doc);
  return st;
}

static bool begins(thr_span line)
{
  return line.s[0] == '{' || line.s[0] == '[';
}

const thr_format thr_json_format = {
    .name = "json", .ending = {"json"}, .begins = begins, .parse = parse, .write = thr_json_frame_write};
