/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inside graph/io: what the readers of JSON frameworks share (values and names, with the place of
 * what is wrong), and those readers. read_json.c says which one reads what. All fail with
 * THR_EINPUT, which names the file, the way to the value and what to do.
 *
 * JSON frameworks: our own, COMPAS 1.x and 2.x, assembly_instances, conmech, networkx node-link and
 * adjacency (docs/formats.md). The kind is told by its members. A document may hold several,
 * however deep: those that stand where the first one stands, but for numbers in lists, are read as
 * one. */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef thr_status read_function(thr_json_reader *r, const thr_json_where *at, const thr_json *v);

static bool ends_in(const char *text, const char *end)
{
  const size_t n = strlen(text), m = strlen(end);
  return n >= m && strcmp(text + n - m, end) == 0;
}

/* Refuses the kinds of graphs that are told but not read. */
static thr_status refuse_graph(thr_json_reader *r, const thr_json_where *at, const thr_json *v)
{
  (void)at;
  return thr_fail(r->err, THR_EINPUT, "%s: this is %s JSON, " THR_GRAPH_ADVICE, r->file,
                  thr_json_get(v, "elements") ? "Cytoscape's" : "sigma's");
}

/* Coordinates, as a list or as members. */
static bool is_point(const thr_json *v)
{
  const char *key;
  double x;
  return thr_json_number(thr_json_at(v, 0), &x) || THR_JSON_MEMBER(v, &key, "x", "X");
}

/* A bare list of points is taken for a line only where lines are expected, and so is what only has
 * a start and an end. */
static bool is_line(const thr_json *v, bool expected)
{
  const char *const *end, *type = thr_json_string(thr_json_get(v, "dtype"));
  const thr_json *points = thr_json_points_of_line(v, &end);
  const bool rhino = thr_json_is_object(points) && is_point(thr_json_get(points, "From")) &&
                     is_point(thr_json_get(points, "To"));
  if (type ? !ends_in(type, "Line") && !ends_in(type, "/Polyline") : !expected && !rhino)
    return false;
  return thr_json_is_object(points) ||
         (thr_json_size(points) >= 2 && is_point(thr_json_at(points, 0)));
}

/* Lines are expected at the top of a document and in a member called lines; elsewhere only objects
 * that say what they are count. Of an object each member must be a line. */
static bool is_line_list(const thr_json_where *at, const thr_json *v)
{
  const bool expected = !at->up || (at->key && ends_in(at->key, "lines"));
  if (thr_json_is_array(v)) return is_line(thr_json_at(v, 0), expected);
  void *iter = NULL;
  const char *key;
  const thr_json *member;
  bool lines = thr_json_size(v) > 0;
  while (lines && thr_json_next(v, &iter, &key, &member))
    lines = is_line(member, expected && thr_json_is_object(member));
  return lines;
}

static read_function *recognise(const thr_json_where *at, const thr_json *v)
{
  if (thr_json_is_array(v)) return is_line_list(at, v) ? thr_json_read_lines : NULL;
  if (!thr_json_is_object(v)) return NULL;
  if (thr_json_is_geometry(v)) return thr_json_read_geometry;
  const char *format = thr_json_string(thr_json_get(v, "format"));
  if (format && strcmp(format, "thread-plan") == 0) return thr_json_read_plan;
  if (format && strcmp(format, "thread-frame") == 0) return thr_json_read_own;

  const char *key;
  const thr_json *nodes = THR_JSON_MEMBER(v, &key, "nodes", "vertices"),
                 *links = THR_JSON_MEMBER(v, &key, "links", "edges", "lines", "faces");
  const thr_json *elements = thr_json_get(v, "elements");
  if (thr_json_is_array(thr_json_get(v, "node_list")) &&
      thr_json_is_array(thr_json_get(v, "element_list")))
    return thr_json_read_assembly;
  if (thr_json_is_array(nodes) && thr_json_is_array(elements)) return thr_json_read_assembly;
  if (thr_json_is_array(nodes) && thr_json_is_array(links) &&
      thr_json_is_array(thr_json_at(nodes, 0)))
    return thr_json_read_own;
  if (thr_json_is_array(thr_json_get(v, "nodes")) && thr_json_is_object(thr_json_at(nodes, 0))) {
    if (thr_json_is_object(thr_json_get(thr_json_at(nodes, 0), "attributes"))) return refuse_graph;
    if (thr_json_is_array(links)) return thr_json_read_node_link;
    if (thr_json_is_array(thr_json_get(v, "adjacency"))) return thr_json_read_adjacency;
  }
  if (thr_json_is_array(thr_json_get(elements, "nodes")) ||
      thr_json_is_object(thr_json_get(thr_json_at(elements, 0), "data")))
    return refuse_graph;

  const thr_json *keyed_nodes = THR_JSON_MEMBER(v, &key, "node", "vertex");
  if (thr_json_is_object(keyed_nodes) &&
      THR_JSON_MEMBER(v, &key, "edge", "face", "adjacency", "halfedge"))
    return thr_json_read_compas;
  return is_line_list(at, v) ? thr_json_read_lines : NULL;
}

/* FNV-1a of the way to a value without numbers, be they indices or keys. */
static uint64_t place_of(const thr_json_where *at)
{
  uint64_t hash = at->up ? place_of(at->up) : UINT64_C(0xcbf29ce484222325);
  int64_t number;
  const bool numbered = at->up && (!at->key || thr_json_parse_key(at->key, &number));
  for (const char *c = numbered || !at->key ? "*" : at->key; *c; c++)
    hash = (hash ^ (unsigned char)*c) * UINT64_C(0x100000001b3);
  return (hash ^ '/') * UINT64_C(0x100000001b3);
}

static const thr_json *value_at(const thr_json_reader *r, const thr_json_where *at)
{
  if (!at->up) return r->document;
  const thr_json *above = value_at(r, at->up);
  return at->key ? thr_json_get(above, at->key) : thr_json_at(above, at->index);
}

/* What a framework of the document is called: by its member name, or that of the object whose
 * member data it is, as in COMPAS; else by the nearest key above it. */
static thr_span called(const thr_json_reader *r, const thr_json_where *at)
{
  const char *name = thr_json_string(thr_json_get(value_at(r, at), "name"));
  for (; !name && at->up; at = at->up)
    if (at->key && strcmp(at->key, "data") == 0)
      name = thr_json_string(thr_json_get(value_at(r, at->up), "name"));
    else
      name = at->key;
  return thr_span_of(name ? name : "");
}

/* Notes where a framework of the document stands. */
static thr_status note_place(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                             read_function *read)
{
  (void)v;
  (void)read;
  int part;
  thr_status st = thr_grow(&r->place, r->n_found, &r->found_capacity, sizeof *r->place, r->err);
  if (st) return st;
  r->place[r->n_found++] = place_of(at);
  return thr_parts_add(&r->parts, called(r, at), &part, r->err);
}

static bool is_chosen(const thr_json_reader *r, int i)
{
  return r->d->pick ? thr_parts_has(&r->parts, i) : r->place[i] == r->place[0];
}

/* Reads a framework into a draft of its own and appends that, its nodes called by its number as
 * well: 3:17. */
static thr_status read_part(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                            read_function *read)
{
  thr_draft *whole = r->d, part = {.flat = whole->flat};
  char prefix[16];
  snprintf(prefix, sizeof prefix, "%d:", r->n_seen);
  r->d = &part;
  thr_status st = read(r, at, v);
  if (!st) st = thr_faces_finish(&r->faces, &part, r->file, r->err);
  if (!st && whole->units[0] && strcmp(whole->units, part.units) != 0)
    st = thr_json_bad(r, at, "in other units than the one before it; read one of them with --pick");
  if (!st) st = thr_draft_append(whole, &part, prefix, r->err);
  r->d = whole;
  thr_names_destroy(&r->names);
  thr_faces_destroy(&r->faces);
  thr_draft_destroy(&part);
  return st;
}

static thr_status read_chosen(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                              read_function *read)
{
  if (!is_chosen(r, r->n_seen++)) return THR_OK;
  return r->n_chosen > 1 ? read_part(r, at, v, read) : read(r, at, v);
}

/* Calls visit for each framework, which are not looked into. Depth is bounded by the JSON parser.
 */
static thr_status walk(thr_json_reader *r, const thr_json_where *at, const thr_json *v,
                       thr_status (*visit)(thr_json_reader *r, const thr_json_where *at,
                                           const thr_json *v, read_function *read))
{
  read_function *read = recognise(at, v);
  if (read) return visit(r, at, v, read);
  thr_status st = THR_OK;
  for (int i = 0; thr_json_is_array(v) && i < thr_json_size(v) && !st; i++) {
    thr_json_where here = {at, NULL, i};
    st = walk(r, &here, thr_json_at(v, i), visit);
  }
  void *iter = NULL;
  const char *key;
  const thr_json *value;
  while (!st && thr_json_next(v, &iter, &key, &value)) {
    thr_json_where here = {at, key, 0};
    st = walk(r, &here, value, visit);
  }
  return st;
}

static thr_status read_document(thr_json_reader *r, const thr_json *doc)
{
  thr_json_where top = {0};
  r->document = doc;
  thr_status st = walk(r, &top, doc, note_place);
  if (!st && !r->n_found)
    st = thr_fail(r->err, THR_EINPUT,
                  "%s: no framework in this JSON; docs/formats.md shows the forms that are read",
                  r->file);
  if (!st) st = thr_parts_choose(&r->parts, r->file, "framework", "frameworks", r->err);
  for (int i = 0; i < r->n_found && !st; i++)
    r->n_chosen += is_chosen(r, i);
  if (!st) st = walk(r, &top, doc, read_chosen);
  return st ? st : thr_faces_finish(&r->faces, r->d, r->file, r->err);
}

static thr_status parse(thr_draft *draft, thr_read_report *read_report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  thr_json *doc;
  thr_status st = thr_json_parse_python(&doc, text, n, name, err);
  if (st) return st;
  thr_json_reader reading = {
      .file = name, .d = draft, .report = read_report, .err = err, .parts = {.asked = draft->pick}};
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

const thr_format thr_json_format = {.name = "json",
                                    .ending = {"json"},
                                    .begins = begins,
                                    .parse = parse,
                                    .write = thr_json_frame_write};
