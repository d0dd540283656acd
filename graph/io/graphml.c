/* SPDX-License-Identifier: GPL-3.0-or-later */
/* GraphML, read and written: keys declare attributes, data give them to nodes and edges. U. Brandes
 * et al., "GraphML Progress Report", 2002; http://graphml.graphdrawing.org/specification.html. */
#include "graph/io/read_parts.h"

#include <string.h>

typedef enum { GRAPH, NODE, EDGE } owner_kind;

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
} graphml;

/* What the attribute with this id is called: itself if no key says. */
static const char *key_name(const graphml *g, const char *id)
{
  for (size_t at = 0; at < g->keys.length;) {
    const char *key = g->keys.data + at, *name = key + strlen(key) + 1;
    if (strcmp(key, id) == 0) return name;
    at = (size_t)(name - g->keys.data) + strlen(name) + 1;
  }
  return id;
}

static void add_key(graphml *g)
{
  static const char *const owner[] = {"graph", "node", "edge"};
  const bool said = thr_xml_attribute(&g->xml, "for", &g->value) && g->value.data;
  for (int i = GRAPH; i <= EDGE; i++)
    g->of[i] = !said || strcmp(g->value.data, "all") == 0 || strcmp(g->value.data, owner[i]) == 0;
  g->to.length = 0;
  if (!thr_xml_attribute(&g->xml, "id", &g->from)) return;
  if (!thr_xml_attribute(&g->xml, "attr.name", &g->to)) return;
  thr_text_append_bytes(&g->keys, g->from.data, g->from.length);
  thr_text_append_bytes(&g->keys, "", 1);
  thr_text_append_bytes(&g->keys, g->to.data, g->to.length);
  thr_text_append_bytes(&g->keys, "", 1);
}

static void begin_data(graphml *g)
{
  g->key.length = 0;
  if (thr_xml_attribute(&g->xml, "key", &g->value))
    thr_text_append(&g->key, key_name(g, g->value.data ? g->value.data : ""));
}

/* The name of the key that was opened last is still in to. */
static void begin_default(graphml *g)
{
  g->key.length = 0;
  thr_text_append_bytes(&g->key, g->to.data ? g->to.data : "", g->to.length);
}

/* Takes the text before the tag as the value of the open key: of the graph, or into what is said of
 * a node or an edge. */
static thr_status take_value(graphml *g, owner_kind owner, thr_said *said)
{
  const char *what = NULL;
  thr_err why = {0};
  g->value.length = 0;
  thr_span text = g->xml.text;
  while (text.n && (unsigned char)text.s[0] <= ' ')
    text = (thr_span){text.s + 1, text.n - 1};
  while (text.n && (unsigned char)text.s[text.n - 1] <= ' ')
    text.n--;
  thr_xml_plain(text, &g->value);
  if (g->value.failed) return thr_nomem(g->err);
  const thr_span key = {g->key.data, g->key.length};
  if (owner == GRAPH) {
    if (!thr_span_is(key, "units")) return THR_OK;
    return thr_draft_set_units(g->draft, g->value.data, &why)
               ? thr_scan_fail(&g->xml.scan, g->err, "%s", why.text)
               : THR_OK;
  }
  thr_said_take(said, key, thr_span_of(g->value.data), &what);
  if (!what) return THR_OK;
  return thr_scan_fail(&g->xml.scan, g->err, "%.*s '%.40s' is %s", thr_span_width(key), key.s,
                       g->value.data, what);
}

/* Ends what holds a value: data of the graph, a node or an edge, or the default of a key. */
static thr_status end_value(graphml *g, bool data)
{
  thr_status st = data ? take_value(g, g->owner, &g->said) : THR_OK;
  for (int owner = GRAPH; owner <= EDGE && !data && !st; owner++)
    if (g->of[owner]) st = take_value(g, (owner_kind)owner, &g->given[owner]);
  g->key.length = 0;
  return st;
}

static thr_status begin_owner(graphml *g, owner_kind owner)
{
  if (g->open)
    return thr_scan_fail(&g->xml.scan, g->err,
                         "a node or an edge inside another; graphs in nodes are not read");
  g->open = true;
  g->owner = owner;
  g->line = g->xml.scan.line;
  g->said = g->given[owner];
  if (owner == NODE && !thr_xml_attribute(&g->xml, "id", &g->name))
    return thr_scan_fail(&g->xml.scan, g->err, "a node without an id");
  if (owner == EDGE && (!thr_xml_attribute(&g->xml, "source", &g->from) ||
                        !thr_xml_attribute(&g->xml, "target", &g->to)))
    return thr_scan_fail(&g->xml.scan, g->err, "an edge without source and target");
  return g->name.failed || g->from.failed || g->to.failed ? thr_nomem(g->err) : THR_OK;
}

static thr_status end_owner(graphml *g)
{
  g->open = false;
  const owner_kind owner = g->owner;
  g->owner = GRAPH;
  if (owner == NODE)
    return thr_said_node(&g->said, g->draft, g->name.data, &g->has_z, &g->xml.scan, g->err);
  thr_status st = thr_links_add(&g->links, g->from.data, g->to.data, g->line, g->err);
  if (!st) thr_said_link(&g->said, &g->links);
  return st;
}

static thr_status take_tag(graphml *g)
{
  const thr_span tag = g->xml.name;
  const bool begins = g->xml.kind != THR_XML_CLOSE, ends = g->xml.kind != THR_XML_OPEN;
  const bool node = thr_span_is(tag, "node"), edge = thr_span_is(tag, "edge");
  const bool data = thr_span_is(tag, "data"), value = data || thr_span_is(tag, "default");
  thr_status st = THR_OK;
  if (begins && thr_span_is(tag, "key")) add_key(g);
  if (begins && thr_span_is(tag, "hyperedge"))
    return thr_scan_fail(&g->xml.scan, g->err,
                         "hyperedges join more than two nodes and are not read");
  if (begins && (node || edge)) st = begin_owner(g, node ? NODE : EDGE);
  if (!st && g->xml.kind == THR_XML_OPEN && data) begin_data(g);
  if (!st && g->xml.kind == THR_XML_OPEN && value && !data) begin_default(g);
  if (!st && g->xml.kind == THR_XML_CLOSE && value && g->key.length) st = end_value(g, data);
  if (g->keys.failed || g->key.failed) return thr_nomem(g->err);
  if (!st && ends && (node || edge) && g->open) st = end_owner(g);
  return st;
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  graphml g = {.draft = draft, .err = err};
  bool graph = false;
  thr_status st = thr_xml_start(&g.xml, text, n, name, err);
  while (!st && !(st = thr_xml_next(&g.xml, err)) && g.xml.kind != THR_XML_END) {
    graph |= thr_span_is(g.xml.name, "graphml");
    if (graph) st = take_tag(&g);
  }
  if (!st && !graph) st = thr_fail(err, THR_EINPUT, "%s: this XML is not GraphML", name);
  if (!st && !draft->n_nodes) st = thr_fail(err, THR_EINPUT, "%s: a graph without nodes", name);
  if (!st) st = thr_links_finish(&g.links, draft, name, err);
  if (!st && draft->n_edges == 0) st = thr_fail(err, THR_EINPUT, "%s: a graph without edges", name);
  report->no_z = !g.has_z;
  thr_links_destroy(&g.links);
  thr_text_destroy(&g.keys);
  thr_text_destroy(&g.key);
  thr_text_destroy(&g.name);
  thr_text_destroy(&g.from);
  thr_text_destroy(&g.to);
  thr_text_destroy(&g.value);
  return st;
}

/* ---- writing ---- */

static void put_key(thr_text *out, const char *id, const char *owner, const char *type)
{
  thr_text_printf(out, " <key id=\"%s\" for=\"%s\" attr.name=\"%s\" attr.type=\"%s\"/>\n", id,
                  owner, id, type);
}

static void put_number(thr_text *out, const char *key, double x)
{
  thr_text_printf(out, "<data key=\"%s\">", key);
  thr_text_double(out, x);
  thr_text_append(out, "</data>");
}

static void write_nodes(const thr_frame *frame, thr_text *out)
{
  static const char *const axis[] = {"x", "y", "z"};
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

static void write_edges(const thr_frame *frame, thr_text *out)
{
  for (int e = 0; e < frame->n_edges; e++) {
    thr_text_append(out, "  <edge source=\"");
    thr_text_xml(out, frame->name[frame->edge[e][0]]);
    thr_text_append(out, "\" target=\"");
    thr_text_xml(out, frame->name[frame->edge[e][1]]);
    thr_text_append(out, "\">");
    if (frame->own_lengths) put_number(out, "length", frame->length[e]);
    if (frame->cover) thr_text_printf(out, "<data key=\"cover\">%d</data>", frame->cover[e]);
    if (frame->capacity && frame->capacity[e])
      thr_text_printf(out, "<data key=\"capacity\">%d</data>", frame->capacity[e]);
    thr_text_append(out, "</edge>\n");
  }
}

static void write(const thr_frame *frame, thr_text *out)
{
  thr_text_append(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml "
                       "xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n");
  put_key(out, "units", "graph", "string");
  put_key(out, "x", "node", "double");
  put_key(out, "y", "node", "double");
  put_key(out, "z", "node", "double");
  put_key(out, "foot", "node", "boolean");
  if (frame->own_lengths) put_key(out, "length", "edge", "double");
  if (frame->cover) put_key(out, "cover", "edge", "int");
  if (frame->capacity) put_key(out, "capacity", "edge", "int");
  thr_text_append(out, " <graph edgedefault=\"undirected\">\n  <data key=\"units\">");
  thr_text_xml(out, frame->units);
  thr_text_append(out, "</data>\n");
  write_nodes(frame, out);
  write_edges(frame, out);
  thr_text_append(out, " </graph>\n</graphml>\n");
}

static bool begins(thr_span line)
{
  return thr_span_starts(line, "<graphml");
}

/* Is <graphml the first tag, whatever instructions and comments stand before it? */
static bool is(const char *text, size_t n)
{
  thr_xml xml;
  thr_span t = {text, n};
  while (t.n && (t.s[0] <= ' ' || (unsigned char)t.s[0] >= 0x80)) /* blanks and a byte-order mark */
    t = (thr_span){t.s + 1, t.n - 1};
  if (!t.n || t.s[0] != '<' || thr_xml_start(&xml, t.s, t.n, "", NULL) || thr_xml_next(&xml, NULL))
    return false;
  return xml.kind != THR_XML_END && thr_span_is(xml.name, "graphml");
}

const thr_format thr_graphml_format = {.name = "graphml",
                                       .ending = {"graphml"},
                                       .begins = begins,
                                       .parse = parse,
                                       .write = write,
                                       .is = is};
