/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads and writes GraphML: keys declare attributes, data elements give attributes to nodes and
 * edges. Source: U. Brandes et al., "GraphML Progress Report", 2002;
 * http://graphml.graphdrawing.org/specification.html.
 *
 * Tags are read one after the other. Between the first and the last tag of a node or an edge, what
 * its data say is collected; with the last tag the node or edge is added. Edges are kept by the
 * names of their nodes until the end, because they may come first.
 *
 * Example of a node:
 *     <key id="d0" for="node" attr.name="x" attr.type="double"/>
 *     <node id="a"><data key="d0">1.5</data></node> */
#include "graph/io/read_parts.h"

#include <string.h>

/* What an attribute belongs to. */
typedef enum { GRAPH, NODE, EDGE } owner_kind;

/* The state of one reading. */
typedef struct {
  thr_xml xml;
  thr_draft *draft;
  thr_err *err;
  thr_links links;
  thr_text keys; /* id, NUL, attribute's name, NUL, .. */
  thr_text name, from, to, value;
  thr_text key; /* of the data that are open: what the attribute is called, empty = none */
  owner_kind owner;
  int line;
  thr_said said;
  thr_said given[3]; /* by owner: what the defaults of the keys say of each node and each edge */
  bool of[3];        /* by owner: whether the key that is open gives such attributes */
  bool open, has_z;  /* a node or an edge is open */
} graphml_reader;

/* Returns what the attribute with this id is called; the id itself if no key says. */
static const char *key_name(const graphml_reader *reader, const char *id)
{
  /* Pairs of texts follow one another: id and name. */
  for (size_t at = 0; at < reader->keys.length;) {
    const char *key = reader->keys.data + at, *name = key + strlen(key) + 1;
    if (strcmp(key, id) == 0) return name;
    at = (size_t)(name - reader->keys.data) + strlen(name) + 1;
  }
  return id;
}

/* Takes the tag of a key: for what, its id and its name. */
static void add_key(graphml_reader *reader)
{
  static const char *const owner[] = {"graph", "node", "edge"};

  /* A key without "for" is for everything. */
  const bool said = thr_xml_attribute(&reader->xml, "for", &reader->value) && reader->value.data;
  for (int i = GRAPH; i <= EDGE; i++)
    reader->of[i] = !said || strcmp(reader->value.data, "all") == 0 ||
                    strcmp(reader->value.data, owner[i]) == 0;

  reader->to.length = 0;

  /* Without a name the id is the name. */
  if (!thr_xml_attribute(&reader->xml, "id", &reader->from)) return;
  if (!thr_xml_attribute(&reader->xml, "attr.name", &reader->to)) return;
  thr_text_append_bytes(&reader->keys, reader->from.data, reader->from.length);
  thr_text_append_bytes(&reader->keys, "", 1);
  thr_text_append_bytes(&reader->keys, reader->to.data, reader->to.length);
  thr_text_append_bytes(&reader->keys, "", 1);
}

/* Begins the data of an element: finds the attribute. */
static void begin_data(graphml_reader *reader)
{
  reader->key.length = 0;
  if (thr_xml_attribute(&reader->xml, "key", &reader->value))
    thr_text_append(&reader->key, key_name(reader, reader->value.data ? reader->value.data : ""));
}

/* Begins the default of a key. The name of the key that was opened last is still in reader->to. */
static void begin_default(graphml_reader *reader)
{
  reader->key.length = 0;
  thr_text_append_bytes(&reader->key, reader->to.data ? reader->to.data : "", reader->to.length);
}

/* Takes the text before the tag as the value of the open key: of the graph, or into what is said of
 * a node or an edge. */
static thr_status take_value(graphml_reader *reader, owner_kind owner, thr_said *said)
{
  const char *what = NULL;
  thr_err why = {0};

  reader->value.length = 0;
  thr_span text = reader->xml.text;

  /* Blanks round a value, also of lines, do not belong to it. */
  while (text.n && (unsigned char)text.s[0] <= ' ')
    text = (thr_span){text.s + 1, text.n - 1};
  while (text.n && (unsigned char)text.s[text.n - 1] <= ' ')
    text.n--;

  /* Entities become letters. */
  thr_xml_plain(text, &reader->value);
  if (reader->value.failed) return thr_nomem(reader->err);
  const thr_span key = {reader->key.data, reader->key.length};

  /* The graph itself has one attribute that matters. */
  if (owner == GRAPH) {
    if (!thr_span_is(key, "units")) return THR_OK;
    return thr_draft_set_units(reader->draft, reader->value.data, &why)
               ? thr_scan_fail(&reader->xml.scan, reader->err, "%s", why.text)
               : THR_OK;
  }

  thr_said_take(said, key, thr_span_of(reader->value.data), &what);
  if (!what) return THR_OK;
  return thr_scan_fail(&reader->xml.scan, reader->err, "%.*s '%.40s' is %s", thr_span_width(key),
                       key.s, reader->value.data, what);
}

/* Ends an element that holds a value: data of the graph, a node or an edge, or the default of a
 * key. */
static thr_status end_value(graphml_reader *reader, bool data)
{
  thr_status st = data ? take_value(reader, reader->owner, &reader->said) : THR_OK;

  /* A default counts for each kind of owner that the key is for. */
  for (int owner = GRAPH; owner <= EDGE && !data && !st; owner++)
    if (reader->of[owner]) st = take_value(reader, (owner_kind)owner, &reader->given[owner]);
  reader->key.length = 0;
  return st;
}

/* Begins a node or an edge: what is said of it starts from the defaults. */
static thr_status begin_owner(graphml_reader *reader, owner_kind owner)
{
  if (reader->open)
    return thr_scan_fail(&reader->xml.scan, reader->err,
                         "a node or an edge inside another; graphs in nodes are not read");

  /* What the keys' defaults say is the beginning. */
  reader->open = true;
  reader->owner = owner;
  reader->line = reader->xml.scan.line;
  reader->said = reader->given[owner];

  /* A node needs a name, an edge its two ends. */
  if (owner == NODE && !thr_xml_attribute(&reader->xml, "id", &reader->name))
    return thr_scan_fail(&reader->xml.scan, reader->err, "a node without an id");
  if (owner == EDGE && (!thr_xml_attribute(&reader->xml, "source", &reader->from) ||
                        !thr_xml_attribute(&reader->xml, "target", &reader->to)))
    return thr_scan_fail(&reader->xml.scan, reader->err, "an edge without source and target");

  return reader->name.failed || reader->from.failed || reader->to.failed ? thr_nomem(reader->err)
                                                                         : THR_OK;
}

/* Ends a node or an edge, which is added with what was said. */
static thr_status end_owner(graphml_reader *reader)
{
  /* What comes next belongs to the graph again. */
  reader->open = false;
  const owner_kind owner = reader->owner;
  reader->owner = GRAPH;

  /* A node is complete; an edge waits until all nodes are known. */
  if (owner == NODE)
    return thr_said_node(&reader->said, reader->draft, reader->name.data, &reader->has_z,
                         &reader->xml.scan, reader->err);

  thr_status st =
      thr_links_add(&reader->links, reader->from.data, reader->to.data, reader->line, reader->err);
  if (!st) thr_said_link(&reader->said, &reader->links);

  return st;
}

/* Does what a tag demands. An empty tag both begins and ends its element. */
static thr_status take_tag(graphml_reader *reader)
{
  const thr_span tag = reader->xml.name;
  const bool begins = reader->xml.kind != THR_XML_CLOSE, ends = reader->xml.kind != THR_XML_OPEN;
  const bool node = thr_span_is(tag, "node"), edge = thr_span_is(tag, "edge");
  const bool data = thr_span_is(tag, "data"), value = data || thr_span_is(tag, "default");
  thr_status st = THR_OK;

  /* What the tag begins. */
  if (begins && thr_span_is(tag, "key")) add_key(reader);
  if (begins && thr_span_is(tag, "hyperedge"))
    return thr_scan_fail(&reader->xml.scan, reader->err,
                         "hyperedges join more than two nodes and are not read");

  if (begins && (node || edge)) st = begin_owner(reader, node ? NODE : EDGE);
  if (!st && reader->xml.kind == THR_XML_OPEN && data) begin_data(reader);
  if (!st && reader->xml.kind == THR_XML_OPEN && value && !data) begin_default(reader);

  /* What the tag ends: a value before its owner. */
  if (!st && reader->xml.kind == THR_XML_CLOSE && value && reader->key.length)
    st = end_value(reader, data);

  if (reader->keys.failed || reader->key.failed) return thr_nomem(reader->err);
  if (!st && ends && (node || edge) && reader->open) st = end_owner(reader);
  return st;
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  graphml_reader reader = {.draft = draft, .err = err};
  bool graph = false;
  thr_status st = thr_xml_start(&reader.xml, text, n, name, err);

  /* Everything before the tag graphml is passed over. */
  while (!st && !(st = thr_xml_next(&reader.xml, err)) && reader.xml.kind != THR_XML_END) {
    graph |= thr_span_is(reader.xml.name, "graphml");
    if (graph) st = take_tag(&reader);
  }

  if (!st && !graph) st = thr_fail(err, THR_EINPUT, "%s: this XML is not GraphML", name);
  if (!st && !draft->n_nodes) st = thr_fail(err, THR_EINPUT, "%s: a graph without nodes", name);

  /* All nodes are known now. */
  if (!st) st = thr_links_finish(&reader.links, draft, name, err);
  if (!st && draft->n_edges == 0) st = thr_fail(err, THR_EINPUT, "%s: a graph without edges", name);
  report->no_z = !reader.has_z;
  thr_links_destroy(&reader.links);
  thr_text_destroy(&reader.keys);
  thr_text_destroy(&reader.key);
  thr_text_destroy(&reader.name);
  thr_text_destroy(&reader.from);
  thr_text_destroy(&reader.to);
  thr_text_destroy(&reader.value);

  return st;
}

/* ---- writing ---- */

/* Writes the key of an attribute, whose id is its name. */
static void put_key(thr_text *out, const char *id, const char *owner, const char *type)
{
  thr_text_printf(out, " <key id=\"%s\" for=\"%s\" attr.name=\"%s\" attr.type=\"%s\"/>\n", id,
                  owner, id, type);
}

/* Writes a number as data. */
static void put_number(thr_text *out, const char *key, double value)
{
  thr_text_printf(out, "<data key=\"%s\">", key);
  thr_text_double(out, value);
  thr_text_append(out, "</data>");
}

/* Writes the nodes with what is said of them. */
static void write_nodes(const thr_frame *frame, thr_text *out)
{
  static const char *const axis[] = {"x", "y", "z"};

  /* Each node is a line. */
  for (int v = 0; v < frame->n_nodes; v++) {
    thr_text_append(out, "  <node id=\"");
    thr_text_xml(out, frame->name[v]);
    thr_text_append(out, "\">");
    for (int i = 0; i < 3; i++)
      put_number(out, axis[i], frame->xyz[v][i]);
    if (frame->foot[v]) thr_text_append(out, "<data key=\"foot\">true</data>");
    thr_text_append(out, "</node>\n");
  }
}

/* Writes the edges with what is said of them, by the names of their nodes. */
static void write_edges(const thr_frame *frame, thr_text *out)
{
  for (int e = 0; e < frame->n_edges; e++) {
    thr_text_append(out, "  <edge source=\"");
    thr_text_xml(out, frame->name[frame->edge[e][0]]);
    thr_text_append(out, "\" target=\"");
    thr_text_xml(out, frame->name[frame->edge[e][1]]);
    thr_text_append(out, "\">");

    /* Lengths that are distances, and capacities without limit, need no word. */
    if (frame->own_lengths) put_number(out, "length", frame->length[e]);
    if (frame->cover) thr_text_printf(out, "<data key=\"cover\">%d</data>", frame->cover[e]);
    if (frame->capacity && frame->capacity[e])
      thr_text_printf(out, "<data key=\"capacity\">%d</data>", frame->capacity[e]);
    thr_text_append(out, "</edge>\n");
  }
}

/* Writes a framework; keys are declared only if they are used. */
static void write(const thr_frame *frame, thr_text *out)
{
  thr_text_append(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml "
                       "xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n");

  /* Each attribute needs a key. */
  put_key(out, "units", "graph", "string");
  put_key(out, "x", "node", "double");
  put_key(out, "y", "node", "double");
  put_key(out, "z", "node", "double");
  put_key(out, "foot", "node", "boolean");
  if (frame->own_lengths) put_key(out, "length", "edge", "double");
  if (frame->cover) put_key(out, "cover", "edge", "int");
  if (frame->capacity) put_key(out, "capacity", "edge", "int");

  /* The graph, with its unit. */
  thr_text_append(out, " <graph edgedefault=\"undirected\">\n  <data key=\"units\">");
  thr_text_xml(out, frame->units);
  thr_text_append(out, "</data>\n");
  write_nodes(frame, out);
  write_edges(frame, out);

  thr_text_append(out, " </graph>\n</graphml>\n");
}

/* Returns whether a line begins as GraphML. */
static bool begins(thr_span line)
{
  return thr_span_starts(line, "<graphml");
}

/* Returns whether graphml is the first tag, whatever instructions and comments come before it. */
static bool is(const char *text, size_t n)
{
  thr_xml xml;
  thr_span rest = {text, n};

  while (rest.n &&
         (rest.s[0] <= ' ' || (unsigned char)rest.s[0] >= 0x80)) /* blanks and a byte-order mark */
    rest = (thr_span){rest.s + 1, rest.n - 1};

  if (!rest.n || rest.s[0] != '<' || thr_xml_start(&xml, rest.s, rest.n, "", NULL) ||
      thr_xml_next(&xml, NULL))
    return false;

  return xml.kind != THR_XML_END && thr_span_is(xml.name, "graphml");
}

const thr_format thr_graphml_format = {.name = "graphml",
                                       .ending = {"graphml"},
                                       .begins = begins,
                                       .parse = parse,
                                       .write = write,
                                       .is = is};
