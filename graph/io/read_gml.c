/* GML: keys and values, which are numbers, strings or lists in brackets. M. Himsolt, "GML: A portable Graph File Format", 1997.
 * Nodes have attributes x, y, z, or graphics [ x y z ], or pos three times; edges have length, cover and capacity. */
#include "graph/framework/frame.h"
#include "graph/io/formats.h"
#include "graph/io/links.h"
#include "graph/io/scan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_NESTED = 64 };

typedef enum { WORD, STRING, OPEN, CLOSE, END } token;

typedef struct {
  thr_scan scan;
  const char *at;
  thr_draft *draft;
  thr_err *err;
  thr_links links;
  thr_text id, label, from, to; /* of the node or edge being read */
  thr_text labels;              /* of all nodes, each with its NUL */
  int n_labels;
  bool has_z, seen_graph;
} gml;

/* The next word, string or bracket; # begins a comment, at the start of a line. */
static thr_status next_token(gml *g, token *kind, thr_span *word)
{
  for (; g->at < g->scan.end; g->at++) {
    if (*g->at == '\n') g->scan.line++;
    if (*g->at == '#')
      while (g->at + 1 < g->scan.end && g->at[1] != '\n')
        g->at++;
    else if (!strchr(" \t\r\n", *g->at))
      break;
  }
  const char *from = g->at;
  *word = (thr_span){from, 0};
  *kind = END;
  if (g->at >= g->scan.end) return THR_OK;
  if (*from == '[' || *from == ']') {
    *kind = *from == '[' ? OPEN : CLOSE;
    g->at++;
  } else if (*from == '"') {
    *kind = STRING;
    for (g->at++; g->at < g->scan.end && *g->at != '"'; g->at++)
      g->scan.line += *g->at == '\n';
    if (g->at >= g->scan.end) return thr_scan_fail(&g->scan, g->err, "a string is not closed");
    *word = (thr_span){from + 1, (size_t)(g->at - from - 1)};
    g->at++;
  } else {
    *kind = WORD;
    while (g->at < g->scan.end && !strchr(" \t\r\n[]\"", *g->at))
      g->at++;
    *word = (thr_span){from, (size_t)(g->at - from)};
  }
  return THR_OK;
}

static void set(thr_text *text, thr_span word)
{
  text->length = 0;
  thr_text_append_bytes(text, word.s, word.n);
}

typedef thr_status take_value(gml *g, thr_said *said, int depth, thr_span key, token kind, thr_span value);

/* The members of a list that has been opened, with those of the lists in it unless take reads them itself. */
static thr_status read_list(gml *g, thr_said *said, int depth, take_value *take)
{
  token kind;
  thr_span key, value;
  if (depth > MOST_NESTED) return thr_scan_fail(&g->scan, g->err, "lists are nested deeper than %d", MOST_NESTED);
  for (;;) {
    thr_status st = next_token(g, &kind, &key);
    if (st || (kind == CLOSE && depth) || (kind == END && !depth)) return st;
    if (kind != WORD) return thr_scan_fail(&g->scan, g->err, "%s where a key was expected", kind == END ? "the end" : "a value");
    if ((st = next_token(g, &kind, &value))) return st;
    if (kind == CLOSE || kind == END) return thr_scan_fail(&g->scan, g->err, "'%.*s' has no value", thr_span_width(key), key.s);
    if ((st = take(g, said, depth, key, kind, value))) return st;
  }
}

static thr_status take_nothing(gml *g, thr_said *said, int depth, thr_span key, token kind, thr_span value)
{
  (void)key, (void)value;
  return kind == OPEN ? read_list(g, said, depth + 1, take_nothing) : THR_OK;
}

/* Of a node or an edge: its own attributes, and those in graphics. */
static thr_status take_attribute(gml *g, thr_said *said, int depth, thr_span key, token kind, thr_span value)
{
  const char *what = NULL;
  static const char *const axis[] = {"x", "y", "z"};
  if (kind == OPEN) return read_list(g, said, depth + 1, thr_span_is(key, "graphics") ? take_attribute : take_nothing);
  if (thr_span_is(key, "id")) set(&g->id, value);
  if (thr_span_is(key, "label")) set(&g->label, value);
  if (thr_span_is(key, "source")) set(&g->from, value);
  if (thr_span_is(key, "target")) set(&g->to, value);
  for (int i = 0; thr_span_is(key, "pos") && i < 3; i++)
    if (!said->has[i]) {
      key = thr_span_of(axis[i]);
      break;
    }
  thr_said_take(said, key, value, &what);
  if (!what) return THR_OK;
  return thr_scan_fail(&g->scan, g->err, "%.*s '%.*s' is %s", thr_span_width(key), key.s, thr_span_width(value), value.s, what);
}

static thr_status read_node(gml *g, int depth)
{
  thr_said said = {0};
  g->id.length = g->label.length = 0;
  thr_status st = read_list(g, &said, depth, take_attribute);
  if (st) return st;
  if (g->id.failed || g->label.failed) return thr_nomem(g->err);
  if (!g->id.length) return thr_scan_fail(&g->scan, g->err, "a node without an id");
  if (g->label.length) {
    g->n_labels++;
    thr_text_append_clean(&g->labels, g->label.data);
  }
  thr_text_append_bytes(&g->labels, "", 1);
  if (g->labels.failed) return thr_nomem(g->err);
  return thr_said_node(&said, g->draft, g->id.data, &g->has_z, &g->scan, g->err);
}

static thr_status read_edge(gml *g, int depth)
{
  thr_said said = {0};
  const int line = g->scan.line;
  g->from.length = g->to.length = 0;
  thr_status st = read_list(g, &said, depth, take_attribute);
  if (st) return st;
  if (g->from.failed || g->to.failed) return thr_nomem(g->err);
  if (!g->from.length || !g->to.length) return thr_scan_fail(&g->scan, g->err, "an edge without source and target");
  st = thr_links_add(&g->links, g->from.data, g->to.data, line, g->err);
  if (!st) thr_said_link(&said, &g->links);
  return st;
}

static thr_status take_graph(gml *g, thr_said *said, int depth, thr_span key, token kind, thr_span value)
{
  if (kind == OPEN && thr_span_is(key, "node")) return read_node(g, depth + 1);
  if (kind == OPEN && thr_span_is(key, "edge")) return read_edge(g, depth + 1);
  return take_nothing(g, said, depth, key, kind, value);
}

static thr_status take_top(gml *g, thr_said *said, int depth, thr_span key, token kind, thr_span value)
{
  if (kind != OPEN || !thr_span_is(key, "graph")) return take_nothing(g, said, depth, key, kind, value);
  if (g->seen_graph) return thr_scan_fail(&g->scan, g->err, "a second graph in the file; keep one in it");
  g->seen_graph = true;
  return read_list(g, said, depth + 1, take_graph);
}

/* Nodes are called by their labels, if each has one of its own. */
static thr_status name_nodes(gml *g)
{
  thr_draft *d = g->draft;
  thr_names names = {0};
  thr_err twice = {0};
  if (g->n_labels < d->n_nodes || d->n_nodes == 0) return THR_OK;
  int *old = thr_calloc((size_t)d->n_nodes, sizeof *old);
  if (!old) return thr_nomem(g->err);
  const size_t base = d->names.length;
  thr_text_append_bytes(&d->names, g->labels.data, g->labels.length);
  thr_status st = d->names.failed ? thr_nomem(g->err) : THR_OK;
  for (int v = 0, at = 0; v < d->n_nodes; v++, at += (int)strlen(g->labels.data + at) + 1) {
    old[v] = d->node[v].name;
    if (!st) d->node[v].name = (int)base + at;
  }
  if (!st) st = thr_names_build(&names, d, g->scan.name, &twice);
  if (st == THR_EINPUT) {
    st = THR_OK;
    for (int v = 0; v < d->n_nodes; v++)
      d->node[v].name = old[v];
  } else if (st) {
    st = thr_nomem(g->err);
  }
  thr_names_destroy(&names);
  free(old);
  return st;
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n, const char *name, thr_err *err)
{
  gml g = {.draft = draft, .err = err};
  thr_said unused = {0};
  thr_status st = thr_scan_start(&g.scan, text, n, name, err);
  g.at = g.scan.at;
  if (!st) st = read_list(&g, &unused, 0, take_top);
  if (!st && !draft->n_nodes) st = thr_fail(err, THR_EINPUT, "%s: no graph with nodes", name);
  if (!st) st = thr_links_finish(&g.links, draft, name, err);
  if (!st && draft->n_edges == 0) st = thr_fail(err, THR_EINPUT, "%s: a graph without edges", name);
  if (!st) st = name_nodes(&g);
  report->no_z = !g.has_z;
  thr_links_destroy(&g.links);
  thr_text_destroy(&g.id);
  thr_text_destroy(&g.label);
  thr_text_destroy(&g.from);
  thr_text_destroy(&g.to);
  thr_text_destroy(&g.labels);
  return st;
}

static bool begins(thr_span line)
{
  const thr_span word = thr_span_word(&line), next = thr_span_word(&line);
  return thr_span_is(word, "graph") ? next.n == 0 || next.s[0] == '['
                                    : thr_span_is(word, "graph[") || (thr_span_is(word, "creator") && next.n && next.s[0] == '"');
}

const thr_format thr_gml_format = {.name = "gml", .ending = {"gml"}, .begins = begins, .parse = parse};
