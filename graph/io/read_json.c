/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads JSON frameworks of any kind: our own frames and plans, COMPAS 1.x and 2.x,
 * assembly_instances, conmech, networkx node-link and adjacency, GeoJSON, lists of lines
 * (docs/formats.md). All readers fail with THR_EINPUT, which names the file, the path to the value,
 * and what to do.
 *
 * The kind of a framework is told by its members (recognise). A document may hold several
 * frameworks, however deep. Those at the same path as the first one, but for numbers in the path,
 * are read as one framework; --pick reads another one. So the document is walked through twice: to
 * find all frameworks, and to read those that are chosen.
 *
 * Example: both frameworks of {"models": [{..}, {..}]} are read as one, because their paths
 * models[0] and models[1] only differ in a number. */
#include "graph/io/read_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A reader of one kind of framework. */
typedef thr_status read_function(thr_json_reader *reader, const thr_json_where *at,
                                 const thr_json *value);

/* Returns whether a text ends in another one. */
static bool ends_in(const char *text, const char *end)
{
  const size_t n = strlen(text), m = strlen(end);
  return n >= m && strcmp(text + n - m, end) == 0;
}

/* Refuses graphs of kinds that are recognised but not read: they have nodes without coordinates in
 * space. */
static thr_status refuse_graph(thr_json_reader *reader, const thr_json_where *at,
                               const thr_json *value)
{
  (void)at;
  return thr_fail(reader->err, THR_EINPUT, "%s: this is %s JSON, " THR_GRAPH_ADVICE, reader->file,
                  thr_json_get(value, "elements") ? "Cytoscape's" : "sigma's");
}

/* Returns whether a value looks like coordinates, as a list or as members. */
static bool is_point(const thr_json *value)
{
  const char *key;
  double x;
  return thr_json_number(thr_json_at(value, 0), &x) || THR_JSON_MEMBER(value, &key, "x", "X");
}

/* Returns whether a value looks like a line. Where no lines are expected, a bare list of points or
 * an object with only a start and an end may be anything, so that it must say what it is. */
static bool is_line(const thr_json *value, bool expected)
{
  const char *const *end, *type = thr_json_string(thr_json_get(value, "dtype"));
  const thr_json *points = thr_json_points_of_line(value, &end);

  /* Rhino's lines have points From and To. */
  const bool rhino = thr_json_is_object(points) && is_point(thr_json_get(points, "From")) &&
                     is_point(thr_json_get(points, "To"));

  /* COMPAS says the type: "compas.geometry/Line". */
  if (type ? !ends_in(type, "Line") && !ends_in(type, "/Polyline") : !expected && !rhino)
    return false;

  return thr_json_is_object(points) ||
         (thr_json_size(points) >= 2 && is_point(thr_json_at(points, 0)));
}

/* Returns whether a value is a list or an object of lines. Lines are expected at the top of a
 * document and in members whose names end in "lines"; elsewhere only objects count that say what
 * they are. In an object each member must be a line. */
static bool is_line_list(const thr_json_where *at, const thr_json *value)
{
  const bool expected = !at->up || (at->key && ends_in(at->key, "lines"));

  if (thr_json_is_array(value)) return is_line(thr_json_at(value, 0), expected);

  /* Of a list the first element decides; objects mix more. */
  void *iter = NULL;
  const char *key;
  const thr_json *member;
  bool lines = thr_json_size(value) > 0;

  while (lines && thr_json_next(value, &iter, &key, &member))
    lines = is_line(member, expected && thr_json_is_object(member));

  return lines;
}

/* Returns the reader for a value, or NULL if the value is no framework. The order matters: what is
 * more specific comes first. */
static read_function *recognise(const thr_json_where *at, const thr_json *value)
{
  if (thr_json_is_array(value)) return is_line_list(at, value) ? thr_json_read_lines : NULL;
  if (!thr_json_is_object(value)) return NULL;
  if (thr_json_is_geometry(value)) return thr_json_read_geometry;
  const char *format = thr_json_string(thr_json_get(value, "format"));
  if (format && strcmp(format, "thread-plan") == 0) return thr_json_read_plan;

  if (format && strcmp(format, "thread-frame") == 0) return thr_json_read_own;

  /* Lists of nodes and of links or elements. */
  const char *key;
  const thr_json *nodes = THR_JSON_MEMBER(value, &key, "nodes", "vertices"),
                 *links = THR_JSON_MEMBER(value, &key, "links", "edges", "lines", "faces");
  const thr_json *elements = thr_json_get(value, "elements");

  if (thr_json_is_array(thr_json_get(value, "node_list")) &&
      thr_json_is_array(thr_json_get(value, "element_list")))
    return thr_json_read_assembly;

  if (thr_json_is_array(nodes) && thr_json_is_array(elements)) return thr_json_read_assembly;

  /* Nodes as bare coordinates. */
  if (thr_json_is_array(nodes) && thr_json_is_array(links) &&
      thr_json_is_array(thr_json_at(nodes, 0)))
    return thr_json_read_own;

  /* Nodes as objects: a graph. sigma puts what it knows of a node into "attributes". */
  if (thr_json_is_array(thr_json_get(value, "nodes")) &&
      thr_json_is_object(thr_json_at(nodes, 0))) {
    if (thr_json_is_object(thr_json_get(thr_json_at(nodes, 0), "attributes"))) return refuse_graph;
    if (thr_json_is_array(links)) return thr_json_read_node_link;
    if (thr_json_is_array(thr_json_get(value, "adjacency"))) return thr_json_read_adjacency;
  }

  /* Cytoscape. */
  if (thr_json_is_array(thr_json_get(elements, "nodes")) ||
      thr_json_is_object(thr_json_get(thr_json_at(elements, 0), "data")))
    return refuse_graph;

  /* Nodes by key: COMPAS. */
  const thr_json *keyed_nodes = THR_JSON_MEMBER(value, &key, "node", "vertex");
  if (thr_json_is_object(keyed_nodes) &&
      THR_JSON_MEMBER(value, &key, "edge", "face", "adjacency", "halfedge"))
    return thr_json_read_compas;

  return is_line_list(at, value) ? thr_json_read_lines : NULL;
}

/* Returns a hash (FNV-1a) of the path to a value without numbers, be they indices or keys. */
static uint64_t place_of(const thr_json_where *at)
{
  uint64_t hash = at->up ? place_of(at->up) : UINT64_C(0xcbf29ce484222325);
  int64_t number;
  const bool numbered = at->up && (!at->key || thr_json_parse_key(at->key, &number));

  /* A number in the path counts as "*". */
  for (const char *c = numbered || !at->key ? "*" : at->key; *c; c++)
    hash = (hash ^ (unsigned char)*c) * UINT64_C(0x100000001b3);

  return (hash ^ '/') * UINT64_C(0x100000001b3);
}

/* Returns the value at a path. */
static const thr_json *value_at(const thr_json_reader *reader, const thr_json_where *at)
{
  if (!at->up) return reader->document;
  const thr_json *above = value_at(reader, at->up);
  return at->key ? thr_json_get(above, at->key) : thr_json_at(above, at->index);
}

/* Returns what a framework of the document is called: its member "name", or that of the object
 * whose member "data" it is, as in COMPAS; else the nearest key above it. */
static thr_span called(const thr_json_reader *reader, const thr_json_where *at)
{
  const char *name = thr_json_string(thr_json_get(value_at(reader, at), "name"));

  /* COMPAS writes {"name": .., "data": {..}}. */
  for (; !name && at->up; at = at->up)
    if (at->key && strcmp(at->key, "data") == 0)
      name = thr_json_string(thr_json_get(value_at(reader, at->up), "name"));
    else
      name = at->key;

  return thr_span_of(name ? name : "");
}

/* Notes the path of a framework of the document, and its name for --pick. */
static thr_status note_place(thr_json_reader *reader, const thr_json_where *at,
                             const thr_json *value, read_function *read)
{
  (void)value;
  (void)read;
  int part;
  thr_status st = thr_grow(&reader->place, reader->n_found, &reader->found_capacity,
                           sizeof *reader->place, reader->err);
  if (st) return st;

  reader->place[reader->n_found++] = place_of(at);
  return thr_parts_add(&reader->parts, called(reader, at), &part, reader->err);
}

/* Returns whether framework i is read: as --pick asks, or if it has the path of the first one. */
static bool is_chosen(const thr_json_reader *reader, int i)
{
  return reader->d->pick ? thr_parts_has(&reader->parts, i) : reader->place[i] == reader->place[0];
}

/* Reads a framework into a draft of its own and appends the draft to the whole one. Nodes get the
 * framework's number before their names: 3:17. */
static thr_status read_part(thr_json_reader *reader, const thr_json_where *at,
                            const thr_json *value, read_function *read)
{
  thr_draft *whole = reader->d, part = {.flat = whole->flat};
  char prefix[16];

  snprintf(prefix, sizeof prefix, "%d:", reader->n_seen);

  /* The readers fill reader->d. */
  reader->d = &part;
  thr_status st = read(reader, at, value);
  if (!st) st = thr_faces_finish(&reader->faces, &part, reader->file, reader->err);

  /* Units cannot be mixed in one framework. */
  if (!st && whole->units[0] && strcmp(whole->units, part.units) != 0)
    st = thr_json_bad(reader, at,
                      "in other units than the one before it; read one of them with --pick");

  if (!st) st = thr_draft_append(whole, &part, prefix, reader->err);
  reader->d = whole;

  /* Names and faces belong to the part alone. */
  thr_names_destroy(&reader->names);
  thr_faces_destroy(&reader->faces);
  thr_draft_destroy(&part);

  return st;
}

/* Reads a framework if it is chosen, directly into the draft if it is the only one. */
static thr_status read_chosen(thr_json_reader *reader, const thr_json_where *at,
                              const thr_json *value, read_function *read)
{
  if (!is_chosen(reader, reader->n_seen++)) return THR_OK;
  return reader->n_chosen > 1 ? read_part(reader, at, value, read) : read(reader, at, value);
}

/* Calls visit for each framework; inside of a framework others are not looked for. The JSON parser
 * bounds the depth of the recursion. */
static thr_status walk(thr_json_reader *reader, const thr_json_where *at, const thr_json *value,
                       thr_status (*visit)(thr_json_reader *reader, const thr_json_where *at,
                                           const thr_json *value, read_function *read))
{
  read_function *read = recognise(at, value);

  if (read) return visit(reader, at, value, read);

  /* Otherwise look into all elements or members. */
  thr_status st = THR_OK;
  for (int i = 0; thr_json_is_array(value) && i < thr_json_size(value) && !st; i++) {
    thr_json_where here = {at, NULL, i};
    st = walk(reader, &here, thr_json_at(value, i), visit);
  }

  void *iter = NULL;
  const char *key;
  const thr_json *member;

  /* An object: so may its members. */
  while (!st && thr_json_next(value, &iter, &key, &member)) {
    thr_json_where here = {at, key, 0};
    st = walk(reader, &here, member, visit);
  }

  return st;
}

/* Reads a document: finds the frameworks, chooses, and reads. */
static thr_status read_document(thr_json_reader *reader, const thr_json *doc)
{
  thr_json_where top = {0};

  reader->document = doc;

  /* First walk: where are the frameworks? */
  thr_status st = walk(reader, &top, doc, note_place);
  if (!st && !reader->n_found)
    st = thr_fail(reader->err, THR_EINPUT,
                  "%s: no framework in this JSON; docs/formats.md shows the forms that are read",
                  reader->file);

  if (!st)
    st = thr_parts_choose(&reader->parts, reader->file, "framework", "frameworks", reader->err);

  /* How many are chosen decides whether names get numbers. */
  for (int i = 0; i < reader->n_found && !st; i++)
    reader->n_chosen += is_chosen(reader, i);

  /* Second walk: read those that are chosen. */
  if (!st) st = walk(reader, &top, doc, read_chosen);
  return st ? st : thr_faces_finish(&reader->faces, reader->d, reader->file, reader->err);
}

/* Reads a text as thr_format.parse demands. Python's NaN and Infinity are read, as values that are
 * no numbers. */
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

  /* What was found and read goes into the report. */
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

/* Returns whether a text begins as JSON of a framework. */
static bool begins(thr_span line)
{
  return line.s[0] == '{' || line.s[0] == '[';
}

const thr_format thr_json_format = {.name = "json",
                                    .ending = {"json"},
                                    .begins = begins,
                                    .parse = parse,
                                    .write = thr_json_frame_write};
