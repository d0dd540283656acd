/* Pajek networks: *Vertices with places, *Edges and *Arcs, *Edgeslist and *Arcslist. A. Mrvar and V. Batagelj, "Pajek: Reference
 * Manual". Edges have values, which are no lengths. */
#include "graph/framework/frame.h"
#include "graph/io/formats.h"
#include "graph/io/links.h"
#include "graph/io/scan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>

typedef enum { NOTHING, VERTICES, PAIRS, LISTS } section;

typedef struct {
  thr_scan scan;
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  section section;
  thr_text word;
  bool has_z;
} pajek;

/* The next word, or what stands between quotes, into p->word. */
static bool next_word(pajek *p, thr_span *rest)
{
  thr_span t = thr_span_trim(*rest), word;
  p->word.length = 0;
  thr_text_append(&p->word, "");
  if (t.n && t.s[0] == '"') {
    size_t n = 1;
    while (n < t.n && t.s[n] != '"')
      n++;
    word = (thr_span){t.s + 1, n - 1};
    n += n < t.n;
    *rest = (thr_span){t.s + n, t.n - n};
  } else {
    word = thr_span_word(rest);
    if (!word.n) return false;
  }
  thr_text_append_bytes(&p->word, word.s, word.n);
  return true;
}

/* number "label" x y z, and words in pairs such as z 0.5 after a shape. */
static thr_status read_vertex(pajek *p, thr_span rest)
{
  thr_said said = {0};
  const char *what = NULL;
  char label[256], number[16];
  int id, axis = 0;
  thr_span word = thr_span_word(&rest);
  if (!thr_span_int(word, &id) || id != p->draft->n_nodes + 1)
    return thr_scan_fail(&p->scan, p->err, "'%.*s' where vertex %d comes next", thr_span_width(word), word.s,
                         p->draft->n_nodes + 1);
  snprintf(number, sizeof number, "%d", id);
  snprintf(label, sizeof label, "%s", next_word(p, &rest) && !p->word.failed && p->word.length ? p->word.data : number);
  while ((word = thr_span_word(&rest)).n) {
    if (axis < 3 && thr_span_number(word, false, &said.xyz[axis])) {
      said.has[axis++] = true;
      continue;
    }
    axis = 3;
    if (thr_span_is(word, "z")) thr_said_take(&said, word, thr_span_word(&rest), &what);
  }
  if (what) return thr_scan_fail(&p->scan, p->err, "z is %s", what);
  thr_status st = thr_said_node(&said, p->draft, label, &p->has_z, &p->scan, p->err);
  return st;
}

static thr_status read_number(pajek *p, thr_span word, int *node)
{
  int number;
  if (!thr_span_int(word, &number) || number < 1 || number > p->draft->n_nodes)
    return thr_scan_fail(&p->scan, p->err, "'%.*s' is no vertex; they are 1 to %d", thr_span_width(word), word.s,
                         p->draft->n_nodes);
  *node = number - 1;
  return THR_OK;
}

/* Two numbers and a value, or a number and all its neighbours. */
static thr_status read_edges(pajek *p, thr_span rest)
{
  int from = 0, to = 0;
  thr_span word = thr_span_word(&rest);
  thr_status st = read_number(p, word, &from);
  word = thr_span_word(&rest);
  if (!st && !word.n) return thr_scan_fail(&p->scan, p->err, "an edge has two ends");
  for (; !st && word.n; word = thr_span_word(&rest)) {
    st = read_number(p, word, &to);
    if (!st) st = thr_draft_add_edge(p->draft, from, to, 0, p->err);
    if (p->section == PAIRS) break;
  }
  return st;
}

static thr_status begin_section(pajek *p, thr_span line)
{
  const thr_span word = thr_span_word(&line);
  p->section = thr_span_is(word, "*vertices")                                      ? VERTICES
               : thr_span_is(word, "*edges") || thr_span_is(word, "*arcs")         ? PAIRS
               : thr_span_is(word, "*edgeslist") || thr_span_is(word, "*arcslist") ? LISTS
                                                                                   : NOTHING;
  if (thr_span_is(word, "*matrix")) return thr_scan_fail(&p->scan, p->err, "edges as a matrix are not read; save them as *Edges");
  if (p->section == VERTICES && p->draft->n_nodes)
    return thr_scan_fail(&p->scan, p->err, "a second network in the file; keep one in it");
  if (p->section == NOTHING && !thr_span_is(word, "*network")) thr_report_skip(p->report, word);
  return THR_OK;
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n, const char *name, thr_err *err)
{
  pajek p = {.draft = draft, .report = report, .err = err};
  thr_span line;
  thr_status st = thr_scan_start(&p.scan, text, n, name, err);
  while (!st && thr_scan_line(&p.scan, &line)) {
    line = thr_span_trim(line);
    if (!line.n || line.s[0] == '%') continue;
    if (line.s[0] == '*')
      st = begin_section(&p, line);
    else if (p.section == VERTICES)
      st = read_vertex(&p, line);
    else if (p.section != NOTHING)
      st = read_edges(&p, line);
  }
  if (!st && draft->n_edges == 0) st = thr_fail(err, THR_EINPUT, "%s: a network without edges", name);
  report->no_z = !p.has_z;
  thr_text_destroy(&p.word);
  return st;
}

static bool begins(thr_span line)
{
  const thr_span word = thr_span_word(&line);
  return thr_span_is(word, "*vertices") || thr_span_is(word, "*network");
}

const thr_format thr_pajek_format = {.name = "pajek", .ending = {"net", "paj"}, .begins = begins, .parse = parse};
