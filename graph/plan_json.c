/* plan.json, written and read. docs/plan-format.md is the schema; both sides of each field stand next to each other. */
#include "graph/plan.h"
#include "graph/json.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- writing ---- */

static void put_key_double(thr_text *t, const char *key, double value, const char *after)
{
  thr_text_printf(t, "\"%s\": ", key);
  thr_text_double(t, value);
  thr_text_append(t, after);
}

/* Appends "[a, b, ..]" from n ints read by the caller's stride. */
static void put_ints(thr_text *t, const int *value, int n)
{
  thr_text_append(t, "[");
  for (int i = 0; i < n; i++)
    thr_text_printf(t, i ? ",%d" : "%d", value[i]);
  thr_text_append(t, "]");
}

static void put_marked(thr_text *t, const bool *mark, int n)
{
  bool some = false;
  thr_text_append(t, "[");
  for (int v = 0; v < n; v++)
    if (mark[v]) {
      thr_text_printf(t, some ? ",%d" : "%d", v);
      some = true;
    }
  thr_text_append(t, "]");
}

static void put_frame(thr_text *t, const thr_frame *f)
{
  thr_text_append(t, "\"framework\": {\n  \"units\": ");
  thr_text_json_string(t, f->units);
  thr_text_printf(t, ",\n  \"hash\": \"%016" PRIx64 "\",\n  \"nodes\": [", thr_frame_hash(f));
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++) {
      thr_text_append(t, i ? "," : v ? ",\n    [" : "\n    [");
      thr_text_double(t, f->xyz[v][i]);
      if (i == 2) thr_text_append(t, "]");
    }
  thr_text_append(t, "\n  ],\n  \"edges\": [");
  for (int e = 0; e < f->n_edges; e++)
    thr_text_printf(t, "%s[%d,%d]", e == 0 ? "" : e % 12 ? "," : ",\n    ", f->edge[e][0], f->edge[e][1]);
  thr_text_append(t, "],\n");
  if (f->own_lengths) {
    thr_text_append(t, "  \"lengths\": [");
    for (int e = 0; e < f->n_edges; e++) {
      if (e) thr_text_append(t, ",");
      thr_text_double(t, f->length[e]);
    }
    thr_text_append(t, "],\n");
  }
  if (!thr_frame_names_are_indices(f)) {
    thr_text_append(t, "  \"names\": [");
    for (int v = 0; v < f->n_nodes; v++) {
      if (v) thr_text_append(t, ",");
      thr_text_json_string(t, f->name[v]);
    }
    thr_text_append(t, "],\n");
  }
  thr_text_append(t, "  \"feet\": ");
  put_marked(t, f->foot, f->n_nodes);
  thr_text_append(t, "\n},\n");
}

static void put_options(thr_text *t, const thr_plan *p)
{
  const thr_plan_options *o = &p->options;
  thr_text_printf(t, "\"options\": {\"objective\": \"length\", \"joint\": \"solid\", \"cover\": %d, \"ends\": \"%s\", ", o->cover,
                  thr_ends_name(o->ends));
  if (o->ends == THR_ENDS_NODES) {
    thr_text_append(t, "\"end_nodes\": ");
    put_marked(t, o->end_node, p->frame.n_nodes);
    thr_text_append(t, ", ");
  }
  put_key_double(t, "time_limit", o->time_limit, ",");
  thr_text_append(t, "\n  \"physics\": ");
  thr_physics_write(&o->physics, t);
  thr_text_append(t, "},\n");
}

static void put_cords(thr_text *t, const thr_plan *p)
{
  thr_text_append(t, "\"cords\": [");
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    thr_text_append(t, i ? ",\n  {\"id\": " : "\n  {\"id\": ");
    thr_text_json_string(t, c->id);
    thr_text_printf(t, ", \"component\": %d, \"closed\": %s,\n   \"nodes\": [%d", c->component, c->closed ? "true" : "false",
                    thr_cord_start(&p->frame, c));
    for (int k = 0; k < c->n_passes; k++)
      thr_text_printf(t, ",%d", thr_head(&p->frame, c->half[k]));
    thr_text_append(t, "],\n   \"edges\": [");
    for (int k = 0; k < c->n_passes; k++)
      thr_text_printf(t, k ? ",%d" : "%d", c->half[k] >> 1);
    thr_text_append(t, "]}");
  }
  thr_text_append(t, "\n],\n");
}

static void put_metrics(thr_text *t, const thr_metrics *m)
{
  thr_text_append(t, "\"metrics\": {");
  put_key_double(t, "length", m->length, ", ");
  put_key_double(t, "base_length", m->base_length, ", ");
  put_key_double(t, "overlap", m->overlap, ", ");
  thr_text_printf(t, "\"passes\": %d, \"most_passes\": %d,\n  ", m->passes, m->most_passes);
  put_key_double(t, "turning", m->turning, ", ");
  put_key_double(t, "max_turning", m->max_turning, ", ");
  put_key_double(t, "worst_turn", m->worst_turn, ", ");
  thr_text_printf(t, "\"u_turns\": %d},\n", m->u_turns);
}

static void put_certificate(thr_text *t, const thr_certificate *c)
{
  thr_text_printf(t, "{\"component\": %d, ", c->component);
  put_key_double(t, "scale", c->scale, ", ");
  thr_text_printf(t,
                  "\"denominator\": %" PRId64 ", \"slots\": %d, \"slot_cost\": %" PRId64 ", \"join\": %" PRId64
                  ", \"sum\": %" PRId64 ",\n    \"cuts\": [",
                  c->denominator, c->n_slots, c->slot_cost, c->join, c->sum);
  for (int k = 0; k < c->n_cuts; k++) {
    thr_text_printf(t, "%s      {\"value\": %" PRId64 ", \"nodes\": ", k ? ",\n" : "\n", c->cut[k].value);
    put_ints(t, c->cut[k].node, c->cut[k].n_nodes);
    thr_text_append(t, "}");
  }
  thr_text_append(t, "]}");
}

static void put_proof(thr_text *t, const thr_length_proof *proof)
{
  thr_text_append(t, "\"proof\": {");
  if (proof->present) {
    thr_text_printf(t, "\"length\": {\"status\": \"%s\", ", proof->optimal ? "optimal" : "bound");
    put_key_double(t, "lower_bound", proof->lower_bound, ", ");
    put_key_double(t, "gap", proof->gap, ",\n  \"method\": \"odd-cut packing (Edmonds & Johnson 1973)\",\n  \"certificate\": [");
    for (int i = 0; i < proof->n_certificates; i++) {
      thr_text_append(t, i ? ",\n    " : "\n    ");
      put_certificate(t, &proof->certificate[i]);
    }
    thr_text_append(t, "\n  ]}");
  }
  thr_text_append(t, "}\n}\n");
}

void thr_plan_write(const thr_plan *p, thr_text *t)
{
  thr_text_append(t, "{\n\"format\": \"thread-plan\",\n\"version\": 1,\n\"generator\": ");
  thr_text_json_string(t, p->generator ? p->generator : "");
  thr_text_append(t, ",\n");
  put_frame(t, &p->frame);
  put_options(t, p);
  put_cords(t, p);
  put_metrics(t, &p->metrics);
  if (p->evaluation.present) thr_evaluation_write(&p->evaluation, t);
  put_proof(t, &p->proof);
}

/* ---- reading: every accessor below fails with "file: place: what" ---- */

typedef struct {
  const char *name; /* of the file, for messages */
  thr_status code;  /* THR_EINPUT while the framework is read; a bad index in a cord or a proof is a violation */
  thr_err *err;
} reader;

static thr_status bad(const reader *r, const char *place, const char *what)
{
  return thr_fail(r->err, r->code, "%s: %s: %s", r->name, place, what);
}

static thr_status need(const reader *r, const thr_json *o, const char *key, thr_json_type type, const thr_json **v)
{
  static const char *const article[] = {"null", "true or false", "a number", "text", "a list", "an object"};
  *v = thr_json_get(o, key);
  if (*v && thr_json_typeof(*v) == type) return THR_OK;
  return thr_fail(r->err, r->code, "%s: %s: %s; expected %s", r->name, key, *v ? "wrong type" : "missing", article[type]);
}

static thr_status get_double(const reader *r, const thr_json *o, const char *key, double *out)
{
  if (thr_json_number(thr_json_get(o, key), out)) return THR_OK;
  return bad(r, key, "missing or not a finite number");
}

static thr_status get_int64(const reader *r, const thr_json *o, const char *key, int64_t low, int64_t high, int64_t *out)
{
  if (thr_json_int(thr_json_get(o, key), out) && *out >= low && *out <= high) return THR_OK;
  return thr_fail(r->err, r->code, "%s: %s: missing or not an integer from %" PRId64 " to %" PRId64, r->name, key, low, high);
}

static thr_status get_int(const reader *r, const thr_json *o, const char *key, int low, int high, int *out)
{
  int64_t wide = 0;
  thr_status st = get_int64(r, o, key, low, high, &wide);
  *out = (int)wide;
  return st;
}

/* Element i of a list of integers from 0 to limit - 1. place names the list. */
static thr_status index_at(const reader *r, const thr_json *list, int i, int limit, const char *place, int *out)
{
  int64_t wide;
  const thr_json *v = thr_json_at(list, i);
  if (!thr_json_int(v, &wide)) return thr_fail(r->err, r->code, "%s: %s[%d]: not an integer", r->name, place, i);
  if (wide < 0 || wide >= limit)
    return thr_fail(r->err, r->code, "%s: %s[%d]: %" PRId64 " is out of range; expected 0 to %d", r->name, place, i, wide,
                    limit - 1);
  *out = (int)wide;
  return THR_OK;
}

/* A member that this version does not know may be a claim that nobody checked. known ends with NULL. */
static thr_status only_members(const reader *r, const thr_json *o, const char *place, const char *const *known)
{
  const char *key = thr_json_unknown(o, known);
  if (!key) return THR_OK;
  return thr_fail(r->err, THR_EVIOLATED, "%s: %s.%s: this version does not know it and cannot check it", r->name, place, key);
}

static thr_status read_nodes(const reader *r, const thr_json *o, thr_draft *d)
{
  const thr_json *nodes, *names = thr_json_get(o, "names");
  thr_status st = need(r, o, "nodes", THR_JSON_ARRAY, &nodes);
  if (st) return st;
  int n = thr_json_size(nodes);
  if (n == 0) return bad(r, "framework.nodes", "empty");
  if (names && (thr_json_typeof(names) != THR_JSON_ARRAY || thr_json_size(names) != n))
    return bad(r, "framework.names", "not one name per node");
  for (int v = 0; v < n; v++) {
    const thr_json *p = thr_json_at(nodes, v);
    double x[3];
    bool ok = thr_json_size(p) == 3;
    for (int i = 0; i < 3 && ok; i++)
      ok = thr_json_number(thr_json_at(p, i), &x[i]);
    if (!ok) return thr_fail(r->err, THR_EINPUT, "%s: framework.nodes[%d]: not three finite numbers", r->name, v);
    const char *name = thr_json_string(thr_json_at(names, v));
    if (names && !name) return thr_fail(r->err, THR_EINPUT, "%s: framework.names[%d]: not text", r->name, v);
    if ((st = thr_draft_add_node(d, x, name, false, r->err))) return st;
  }
  assert(d->node);
  const thr_json *feet = thr_json_get(o, "feet");
  for (int i = 0, v = 0; i < thr_json_size(feet); i++) {
    if ((st = index_at(r, feet, i, n, "framework.feet", &v))) return st;
    d->node[v].foot = true;
  }
  return THR_OK;
}

static thr_status read_edges(const reader *r, const thr_json *o, thr_draft *d)
{
  const thr_json *edges, *lengths = thr_json_get(o, "lengths");
  thr_status st = need(r, o, "edges", THR_JSON_ARRAY, &edges);
  if (st) return st;
  if (lengths && thr_json_size(lengths) != thr_json_size(edges)) return bad(r, "framework.lengths", "not one length per edge");
  for (int e = 0; e < thr_json_size(edges); e++) {
    int end[2] = {0, 0};
    double length = 0;
    char place[48];
    snprintf(place, sizeof place, "framework.edges[%d]", e);
    for (int i = 0; i < 2; i++)
      if ((st = index_at(r, thr_json_at(edges, e), i, d->n_nodes, place, &end[i]))) return st;
    if (lengths && (!thr_json_number(thr_json_at(lengths, e), &length) || !(length > 0)))
      return thr_fail(r->err, THR_EINPUT, "%s: framework.lengths[%d]: not a positive number", r->name, e);
    if ((st = thr_draft_add_edge(d, end[0], end[1], length, r->err))) return st;
  }
  return THR_OK;
}

static thr_status read_hash(const reader *r, const thr_json *o, const thr_frame *f)
{
  char hash[20];
  const char *stated = thr_json_string(thr_json_get(o, "hash"));
  snprintf(hash, sizeof hash, "%016" PRIx64, thr_frame_hash(f));
  if (stated && strcmp(stated, hash) == 0) return THR_OK;
  return thr_fail(r->err, THR_EVIOLATED, "%s: framework.hash: the framework is not the one that was planned (its hash is %s)",
                  r->name, hash);
}

static thr_status read_frame(const reader *r, const thr_json *doc, thr_frame *f)
{
  const thr_json *o;
  thr_draft d = {0};
  thr_read_report report = {0};
  thr_status st = need(r, doc, "framework", THR_JSON_OBJECT, &o);
  if (st) return st;
  if ((st = read_nodes(r, o, &d))) goto done;
  if ((st = read_edges(r, o, &d))) goto done;
  const char *units = thr_json_string(thr_json_get(o, "units"));
  snprintf(d.units, sizeof d.units, "%s", units ? units : "");
  if ((st = thr_draft_build(&d, 0, f, &report, r->err))) goto done;
  if (f->n_nodes != d.n_nodes || f->n_edges != d.n_edges)
    st = bad(r, "framework", "has coincident nodes, isolated nodes, or an edge twice");
  else
    st = read_hash(r, o, f);
done:
  if (st) thr_frame_destroy(f);
  thr_draft_destroy(&d);
  return st;
}

/* A plan for another objective or joint may hold, but not by the rules that this version checks. */
static thr_status only_known(const reader *r, const thr_json *o, const char *key, const char *known)
{
  const char *value = thr_json_string(thr_json_get(o, key));
  if (value && strcmp(value, known) == 0) return THR_OK;
  return thr_fail(r->err, r->code, "%s: options.%s: this version knows %s only", r->name, key, known);
}

static thr_status read_options(const reader *r, const thr_json *doc, const thr_frame *f, thr_plan_options *o)
{
  char place[256];
  const thr_json *v;
  thr_status st = need(r, doc, "options", THR_JSON_OBJECT, &v);
  if (st) return st;
  *o = thr_plan_options_default();
  static const char *const known[] = {"objective", "joint", "cover", "ends", "end_nodes", "time_limit", "physics", NULL};
  if ((st = only_members(r, v, "options", known))) return st;
  if ((st = only_known(r, v, "objective", "length"))) return st;
  if ((st = only_known(r, v, "joint", "solid"))) return st;
  if ((st = get_int(r, v, "cover", 1, 100, &o->cover))) return st;
  snprintf(place, sizeof place, "%.200s: options.physics", r->name);
  if ((st = thr_physics_from_json(&o->physics, thr_json_get(v, "physics"), place, r->err))) return st;
  if ((st = get_double(r, v, "time_limit", &o->time_limit))) return st;
  const char *ends = thr_json_string(thr_json_get(v, "ends"));
  int kind = THR_ENDS_CLOSED;
  while (kind <= THR_ENDS_NODES && (!ends || strcmp(ends, thr_ends_name((thr_ends)kind)) != 0))
    kind++;
  if (kind > THR_ENDS_NODES) return bad(r, "options.ends", "expected closed, any, feet or nodes");
  o->ends = (thr_ends)kind;
  if (o->ends != THR_ENDS_NODES) return THR_OK;
  const thr_json *list;
  if ((st = need(r, v, "end_nodes", THR_JSON_ARRAY, &list))) return st;
  if (!(o->end_node = thr_calloc((size_t)f->n_nodes, sizeof *o->end_node))) return thr_nomem(r->err);
  for (int i = 0, node = 0; i < thr_json_size(list); i++) {
    if ((st = index_at(r, list, i, f->n_nodes, "options.end_nodes", &node))) return st;
    o->end_node[node] = true;
  }
  return THR_OK;
}

/* Pass k of a cord runs over edge e from node a to node b. What a hand-edited plan gets wrong first, so say it well. */
static thr_status half_edge(const reader *r, const thr_frame *f, const char *id, int k, int e, int a, int b, int *half)
{
  for (int s = 0; s < 2; s++)
    if (f->edge[e][s] == a && f->edge[e][1 - s] == b) {
      *half = 2 * e + s;
      return THR_OK;
    }
  return thr_fail(r->err, r->code, "%s: cord %s, pass %d: edge %d joins nodes %d and %d, but the cord goes from %d to %d",
                  r->name, id, k + 1, e, f->edge[e][0], f->edge[e][1], a, b);
}

static thr_status read_cord(const reader *r, const thr_json *v, const thr_frame *f, int i, thr_cord *c)
{
  const thr_json *nodes, *edges, *id, *closed;
  thr_status st = need(r, v, "id", THR_JSON_STRING, &id);
  if (st) return st;
  if (strlen(thr_json_string(id)) >= sizeof c->id) return bad(r, "cords: id", "longer than 11 letters");
  snprintf(c->id, sizeof c->id, "%s", thr_json_string(id));
  if ((st = get_int(r, v, "component", 0, f->n_nodes - 1, &c->component))) return st;
  if ((st = need(r, v, "closed", THR_JSON_BOOL, &closed))) return st;
  if ((st = need(r, v, "nodes", THR_JSON_ARRAY, &nodes))) return st;
  if ((st = need(r, v, "edges", THR_JSON_ARRAY, &edges))) return st;
  c->closed = thr_json_true(closed);
  int n = thr_json_size(edges);
  char place[40];
  if (n < 1 || thr_json_size(nodes) != n + 1) {
    snprintf(place, sizeof place, "cords[%d]", i);
    return bad(r, place, "needs at least one edge, and one node more than edges");
  }
  if (!(c->half = thr_calloc((size_t)n, sizeof *c->half))) return thr_nomem(r->err);
  c->n_passes = n;
  for (int k = 0; k < n; k++) {
    int e = 0, a = 0, b = 0;
    snprintf(place, sizeof place, "cords[%d].edges", i);
    if ((st = index_at(r, edges, k, f->n_edges, place, &e))) return st;
    snprintf(place, sizeof place, "cords[%d].nodes", i);
    if ((st = index_at(r, nodes, k, f->n_nodes, place, &a))) return st;
    if ((st = index_at(r, nodes, k + 1, f->n_nodes, place, &b))) return st;
    if ((st = half_edge(r, f, c->id, k, e, a, b, &c->half[k]))) return st;
  }
  return THR_OK;
}

static thr_status read_cords(const reader *r, const thr_json *doc, thr_plan *p)
{
  const thr_json *list;
  thr_status st = need(r, doc, "cords", THR_JSON_ARRAY, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (n < 1) return bad(r, "cords", "empty; a plan has at least one cord");
  if (!(p->cord = thr_calloc((size_t)n, sizeof *p->cord))) return thr_nomem(r->err);
  p->n_cords = n;
  for (int i = 0; i < n; i++)
    if ((st = read_cord(r, thr_json_at(list, i), &p->frame, i, &p->cord[i]))) return st;
  return THR_OK;
}

static thr_status read_metrics(const reader *r, const thr_json *doc, thr_metrics *m)
{
  const thr_json *v;
  static const char *const known[] = {"length",  "base_length", "overlap",    "passes",  "most_passes",
                                      "turning", "max_turning", "worst_turn", "u_turns", NULL};
  thr_status st = need(r, doc, "metrics", THR_JSON_OBJECT, &v);
  if (!st) st = only_members(r, v, "metrics", known);
  if (st) return st;
  if ((st = get_double(r, v, "length", &m->length))) return st;
  if ((st = get_double(r, v, "base_length", &m->base_length))) return st;
  if ((st = get_double(r, v, "overlap", &m->overlap))) return st;
  if ((st = get_int(r, v, "passes", 0, INT32_MAX, &m->passes))) return st;
  if ((st = get_int(r, v, "most_passes", 0, INT32_MAX, &m->most_passes))) return st;
  if ((st = get_double(r, v, "turning", &m->turning))) return st;
  if ((st = get_double(r, v, "max_turning", &m->max_turning))) return st;
  if ((st = get_double(r, v, "worst_turn", &m->worst_turn))) return st;
  return get_int(r, v, "u_turns", 0, INT32_MAX, &m->u_turns);
}

/* One record per cord, one tension per pass: then code that reads them needs no other look. */
static thr_status read_evaluation(const reader *r, const thr_json *doc, thr_plan *p)
{
  char place[256];
  const thr_json *v = thr_json_get(doc, "evaluation");
  if (!v) return THR_OK;
  snprintf(place, sizeof place, "%.200s: evaluation", r->name);
  thr_evaluation *e = &p->evaluation;
  thr_status st = thr_evaluation_from_json(e, v, place, r->err);
  if (st) return st;
  if (e->n_cords != p->n_cords) return bad(r, "evaluation.cords", "not one per cord of the plan");
  for (int i = 0; i < e->n_cords; i++) {
    if (e->cord[i].known && e->cord[i].n_passes != p->cord[i].n_passes)
      return thr_fail(r->err, r->code, "%s: evaluation.cords[%d].tension: not one per pass of the cord (%d)", r->name, i,
                      p->cord[i].n_passes);
    e->cord[i].n_passes = p->cord[i].n_passes;
  }
  return THR_OK;
}

static thr_status read_cut(const reader *r, const thr_json *v, int limit, thr_cut *cut)
{
  const thr_json *nodes;
  thr_status st = get_int64(r, v, "value", INT64_MIN, INT64_MAX, &cut->value); /* the checker says what a negative one means */
  if (st) return st;
  if ((st = need(r, v, "nodes", THR_JSON_ARRAY, &nodes))) return st;
  int n = thr_json_size(nodes);
  if (!(cut->node = thr_calloc((size_t)n, sizeof *cut->node))) return thr_nomem(r->err);
  cut->n_nodes = n;
  for (int i = 0; i < n; i++)
    if ((st = index_at(r, nodes, i, limit, "proof.length.certificate: cuts: nodes", &cut->node[i]))) return st;
  return THR_OK;
}

static thr_status read_certificate(const reader *r, const thr_json *v, const thr_frame *f, thr_certificate *c)
{
  const thr_json *cuts;
  thr_status st = get_int(r, v, "component", 0, f->n_nodes - 1, &c->component);
  if (st) return st;
  if ((st = get_double(r, v, "scale", &c->scale))) return st;
  if ((st = get_int64(r, v, "denominator", 1, INT64_C(1) << 40, &c->denominator))) return st;
  if ((st = get_int(r, v, "slots", 0, 2, &c->n_slots))) return st;
  if ((st = get_int64(r, v, "slot_cost", 0, INT64_C(1) << 60, &c->slot_cost))) return st;
  if ((st = get_int64(r, v, "join", 0, INT64_C(1) << 60, &c->join))) return st;
  if ((st = get_int64(r, v, "sum", 0, INT64_MAX, &c->sum))) return st;
  if ((st = need(r, v, "cuts", THR_JSON_ARRAY, &cuts))) return st;
  int n = thr_json_size(cuts);
  if (!(c->cut = thr_calloc((size_t)n, sizeof *c->cut))) return thr_nomem(r->err);
  c->n_cuts = n;
  for (int i = 0; i < n; i++)
    if ((st = read_cut(r, thr_json_at(cuts, i), f->n_nodes + c->n_slots, &c->cut[i]))) return st;
  return THR_OK;
}

static thr_status read_proof(const reader *r, const thr_json *doc, const thr_frame *f, thr_length_proof *proof)
{
  const thr_json *all, *list;
  static const char *const claims[] = {"length", NULL};
  static const char *const known[] = {"status", "lower_bound", "gap", "method", "certificate", NULL};
  thr_status st = need(r, doc, "proof", THR_JSON_OBJECT, &all);
  if (!st) st = only_members(r, all, "proof", claims);
  if (!st) st = only_members(r, thr_json_get(all, "length"), "proof.length", known);
  if (st) return st;
  const thr_json *v = thr_json_get(all, "length");
  if (!v) return THR_OK;
  proof->present = true;
  const char *status = thr_json_string(thr_json_get(v, "status"));
  if (!status || (strcmp(status, "optimal") != 0 && strcmp(status, "bound") != 0))
    return bad(r, "proof.length.status", "expected optimal or bound");
  proof->optimal = strcmp(status, "optimal") == 0;
  if ((st = get_double(r, v, "lower_bound", &proof->lower_bound))) return st;
  if ((st = get_double(r, v, "gap", &proof->gap))) return st;
  if ((st = need(r, v, "certificate", THR_JSON_ARRAY, &list))) return st;
  int n = thr_json_size(list);
  if (!(proof->certificate = thr_calloc((size_t)n, sizeof *proof->certificate))) return thr_nomem(r->err);
  proof->n_certificates = n;
  for (int i = 0; i < n; i++)
    if ((st = read_certificate(r, thr_json_at(list, i), f, &proof->certificate[i]))) return st;
  return THR_OK;
}

static thr_status read_document(reader *r, const thr_json *doc, thr_plan *p)
{
  const char *format = thr_json_string(thr_json_get(doc, "format"));
  int version;
  if (!format || strcmp(format, "thread-plan") != 0) return bad(r, "format", "not a thread plan; make one with `thread plan`");
  thr_status st = get_int(r, doc, "version", 1, INT32_MAX, &version);
  if (st) return st;
  if (version != 1) return bad(r, "version", "written by another version of thread; this one reads version 1");
  const char *generator = thr_json_string(thr_json_get(doc, "generator"));
  if (!(p->generator = thr_strdup(generator ? generator : ""))) return thr_nomem(r->err);
  if ((st = read_frame(r, doc, &p->frame))) return st;
  if ((st = read_options(r, doc, &p->frame, &p->options))) return st;
  r->code = THR_EVIOLATED;
  if ((st = read_cords(r, doc, p))) return st;
  if ((st = read_metrics(r, doc, &p->metrics))) return st;
  if ((st = read_evaluation(r, doc, p))) return st;
  return read_proof(r, doc, &p->frame, &p->proof);
}

thr_status thr_plan_parse(thr_plan *p, const char *text, size_t n, const char *name, thr_err *err)
{
  thr_plan plan = {0};
  thr_json *doc;
  *p = plan;
  thr_status st = thr_json_parse(&doc, text, n, name, err);
  if (st) return st;
  st = read_document(&(reader){name, THR_EINPUT, err}, doc, &plan);
  thr_json_destroy(doc);
  if (st) thr_plan_destroy(&plan);
  *p = plan;
  return st;
}

thr_status thr_plan_read(thr_plan *p, const char *path, thr_err *err)
{
  thr_text text = {0};
  *p = (thr_plan){0};
  thr_status st = thr_text_read(&text, path, err);
  if (st) return st;
  st = thr_plan_parse(p, text.data, text.length, strcmp(path, "-") == 0 ? "stdin" : path, err);
  thr_text_destroy(&text);
  return st;
}
