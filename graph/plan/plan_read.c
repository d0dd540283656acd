/* plan.json, read: docs/plan-format.md is the schema. Every accessor fails with "file: place: what". */
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_fields.h"
#include "graph/io/read.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static thr_status read_nodes(const thr_field_reader *r, const thr_json *o, thr_draft *d)
{
  const thr_json *nodes, *names = thr_json_get(o, "names");
  thr_status st = thr_field_need(r, o, "nodes", THR_JSON_ARRAY, &nodes);
  if (st) return st;
  int n = thr_json_size(nodes);
  if (n == 0) return thr_field_bad(r, "framework.nodes", "empty");
  if (names && (thr_json_typeof(names) != THR_JSON_ARRAY || thr_json_size(names) != n))
    return thr_field_bad(r, "framework.names", "not one name per node");
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
    if ((st = thr_field_index(r, feet, i, n, "framework.feet", &v))) return st;
    d->node[v].foot = true;
  }
  return THR_OK;
}

/* A list of the framework with one entry per edge, if it is there. */
static thr_status edge_list(const thr_field_reader *r, const thr_json *o, const char *key, int n, const thr_json **list)
{
  *list = thr_json_get(o, key);
  if (!*list || thr_json_size(*list) == n) return THR_OK;
  return thr_fail(r->err, r->code, "%s: framework.%s: not one per edge", r->name, key);
}

static thr_status read_edges(const thr_field_reader *r, const thr_json *o, thr_draft *d)
{
  const thr_json *edges, *lengths = NULL, *covers = NULL, *capacities = NULL;
  thr_status st = thr_field_need(r, o, "edges", THR_JSON_ARRAY, &edges);
  if (!st) st = edge_list(r, o, "lengths", thr_json_size(edges), &lengths);
  if (!st) st = edge_list(r, o, "covers", thr_json_size(edges), &covers);
  if (!st) st = edge_list(r, o, "capacities", thr_json_size(edges), &capacities);
  if (st) return st;
  for (int e = 0; e < thr_json_size(edges); e++) {
    int end[2] = {0, 0};
    double length = 0;
    char place[48];
    thr_err why = {0};
    snprintf(place, sizeof place, "framework.edges[%d]", e);
    for (int i = 0; i < 2; i++)
      if ((st = thr_field_index(r, thr_json_at(edges, e), i, d->n_nodes, place, &end[i]))) return st;
    if (lengths && (!thr_json_number(thr_json_at(lengths, e), &length) || !(length > 0)))
      return thr_fail(r->err, THR_EINPUT, "%s: framework.lengths[%d]: not a positive number", r->name, e);
    if ((st = thr_draft_add_edge(d, end[0], end[1], length, r->err))) return st;
    if ((st = thr_json_edge_passes(d, thr_json_at(covers, e), thr_json_at(capacities, e), &why)))
      return thr_fail(r->err, st, "%s: framework: %s", r->name, why.text);
  }
  return THR_OK;
}

static thr_status read_units(const thr_field_reader *r, const thr_json *v, thr_draft *d)
{
  thr_err why = {0};
  if (!v) return THR_OK;
  if (!thr_json_string(v)) return thr_field_bad(r, "framework.units", "not text");
  return thr_draft_set_units(d, thr_json_string(v), &why) ? thr_field_bad(r, "framework.units", why.text) : THR_OK;
}

static thr_status read_hash(const thr_field_reader *r, const thr_json *o, const thr_frame *f)
{
  char hash[20];
  const char *stated = thr_json_string(thr_json_get(o, "hash"));
  snprintf(hash, sizeof hash, "%016" PRIx64, thr_frame_hash(f));
  if (stated && strcmp(stated, hash) == 0) return THR_OK;
  return thr_fail(r->err, THR_EVIOLATED, "%s: framework.hash: the framework is not the one that was planned (its hash is %s)",
                  r->name, hash);
}

static thr_status read_frame(const thr_field_reader *r, const thr_json *doc, thr_frame *f)
{
  const thr_json *o;
  thr_draft d = {0};
  thr_read_report report = {0};
  thr_err why = {0};
  thr_status st = thr_field_need(r, doc, "framework", THR_JSON_OBJECT, &o);
  if (st) return st;
  if ((st = read_nodes(r, o, &d))) goto done;
  if ((st = read_edges(r, o, &d))) goto done;
  if ((st = read_units(r, thr_json_get(o, "units"), &d))) goto done;
  if ((st = thr_draft_build(&d, 0, f, &report, &why))) {
    thr_fail(r->err, st, "%s: framework: %s", r->name, why.text);
    goto done;
  }
  if (f->n_nodes != d.n_nodes || f->n_edges != d.n_edges)
    st = thr_field_bad(r, "framework", "has coincident nodes, isolated nodes, or an edge twice");
  else
    st = read_hash(r, o, f);
done:
  if (st) thr_frame_destroy(f);
  thr_draft_destroy(&d);
  return st;
}

/* Pass k of a cord runs over edge e from node a to node b. What a hand-edited plan gets wrong first, so say it well. */
static thr_status half_edge(const thr_field_reader *r, const thr_frame *f, const char *id, int k, int e, int a, int b, int *half)
{
  for (int s = 0; s < 2; s++)
    if (f->edge[e][s] == a && f->edge[e][1 - s] == b) {
      *half = 2 * e + s;
      return THR_OK;
    }
  return thr_fail(r->err, r->code, "%s: cord %s, pass %d: edge %d joins nodes %d and %d, but the cord goes from %d to %d",
                  r->name, id, k + 1, e, f->edge[e][0], f->edge[e][1], a, b);
}

static thr_status read_cord(const thr_field_reader *r, const thr_json *v, const thr_frame *f, int i, thr_cord *c)
{
  const thr_json *nodes, *edges, *id, *closed;
  thr_status st = thr_field_need(r, v, "id", THR_JSON_STRING, &id);
  if (st) return st;
  if (strlen(thr_json_string(id)) >= sizeof c->id) return thr_field_bad(r, "cords: id", "longer than 11 letters");
  snprintf(c->id, sizeof c->id, "%s", thr_json_string(id));
  thr_text_clean(c->id);
  if ((st = thr_field_int(r, v, "component", 0, f->n_nodes - 1, &c->component))) return st;
  if ((st = thr_field_need(r, v, "closed", THR_JSON_BOOL, &closed))) return st;
  if ((st = thr_field_need(r, v, "nodes", THR_JSON_ARRAY, &nodes))) return st;
  if ((st = thr_field_need(r, v, "edges", THR_JSON_ARRAY, &edges))) return st;
  c->closed = thr_json_true(closed);
  int n = thr_json_size(edges);
  char place[40];
  if (n < 1 || thr_json_size(nodes) != n + 1) {
    snprintf(place, sizeof place, "cords[%d]", i);
    return thr_field_bad(r, place, "needs at least one edge, and one node more than edges");
  }
  if (!(c->half = thr_calloc((size_t)n, sizeof *c->half))) return thr_nomem(r->err);
  c->n_passes = n;
  for (int k = 0; k < n; k++) {
    int e = 0, a = 0, b = 0;
    snprintf(place, sizeof place, "cords[%d].edges", i);
    if ((st = thr_field_index(r, edges, k, f->n_edges, place, &e))) return st;
    snprintf(place, sizeof place, "cords[%d].nodes", i);
    if ((st = thr_field_index(r, nodes, k, f->n_nodes, place, &a))) return st;
    if ((st = thr_field_index(r, nodes, k + 1, f->n_nodes, place, &b))) return st;
    if ((st = half_edge(r, f, c->id, k, e, a, b, &c->half[k]))) return st;
  }
  return THR_OK;
}

static thr_status read_cords(const thr_field_reader *r, const thr_json *doc, thr_plan *p)
{
  const thr_json *list;
  thr_status st = thr_field_need(r, doc, "cords", THR_JSON_ARRAY, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (n < 1) return thr_field_bad(r, "cords", "empty; a plan has at least one cord");
  if (!(p->cord = thr_calloc((size_t)n, sizeof *p->cord))) return thr_nomem(r->err);
  p->n_cords = n;
  for (int i = 0; i < n; i++)
    if ((st = read_cord(r, thr_json_at(list, i), &p->frame, i, &p->cord[i]))) return st;
  return THR_OK;
}

/* A list of images of all nodes, one list of indices each. */
static thr_status read_images(const thr_field_reader *r, const thr_json *o, const char *key, int n_nodes, int **image, int *count)
{
  const thr_json *list;
  char place[48];
  thr_status st = thr_field_need(r, o, key, THR_JSON_ARRAY, &list);
  if (st) return st;
  int n = thr_json_size(list);
  snprintf(place, sizeof place, "symmetry.%s", key);
  for (int i = 0; i < n; i++)
    if (thr_json_size(thr_json_at(list, i)) != n_nodes)
      return thr_fail(r->err, r->code, "%s: %s[%d]: not one image per node", r->name, place, i);
  if (!(*image = thr_calloc((size_t)n * (size_t)n_nodes, sizeof **image))) return thr_nomem(r->err);
  *count = n;
  for (int i = 0; i < n; i++) {
    snprintf(place, sizeof place, "symmetry.%s[%d]", key, i);
    for (int v = 0; v < n_nodes; v++)
      if ((st = thr_field_index(r, thr_json_at(list, i), v, n_nodes, place, &(*image)[(size_t)i * (size_t)n_nodes + (size_t)v])))
        return st;
  }
  return THR_OK;
}

static thr_status read_copies(const thr_field_reader *r, const thr_json *o, const thr_plan *p, thr_symmetry_record *s)
{
  static const char *const known[] = {"of", "image", NULL};
  const thr_json *list;
  thr_status st = thr_field_need(r, o, "cords", THR_JSON_ARRAY, &list);
  if (st) return st;
  if (thr_json_size(list) != p->n_cords) return thr_field_bad(r, "symmetry.cords", "not one per cord of the plan");
  s->unique = thr_calloc((size_t)p->n_cords, sizeof *s->unique);
  s->element = thr_calloc((size_t)p->n_cords, sizeof *s->element);
  if (!s->unique || !s->element) return thr_nomem(r->err);
  for (int i = 0; i < p->n_cords && !st; i++) {
    const thr_json *v = thr_json_at(list, i);
    st = thr_field_only(r, v, "symmetry.cords", known);
    if (!st) st = thr_field_int(r, v, "of", 0, p->n_cords - 1, &s->unique[i]);
    if (!st) st = thr_field_int(r, v, "image", 0, s->n_images - 1, &s->element[i]);
  }
  return st;
}

/* There with the objective that asks for it, and nowhere else. */
static thr_status read_symmetry(const thr_field_reader *r, const thr_json *doc, const thr_plan *p, thr_symmetry_record *s)
{
  static const char *const known[] = {"order", "name", "generators", "images", "cords", "steps", "unique_paths", NULL};
  const thr_json *v = thr_json_get(doc, "symmetry"), *name;
  if (!thr_wants_symmetry(&p->options))
    return v ? thr_field_bad(r, "symmetry", "only plans with this objective have it") : THR_OK;
  thr_status st = thr_field_need(r, doc, "symmetry", THR_JSON_OBJECT, &v);
  if (!st) st = thr_field_only(r, v, "symmetry", known);
  if (!st) st = thr_field_int(r, v, "order", 1, 1024, &s->order);
  if (!st) st = thr_field_need(r, v, "name", THR_JSON_STRING, &name);
  if (st) return st;
  if (strlen(thr_json_string(name)) >= sizeof s->name) return thr_field_bad(r, "symmetry.name", "longer than 15 bytes");
  snprintf(s->name, sizeof s->name, "%s", thr_json_string(name));
  thr_text_clean(s->name);
  s->present = true;
  st = read_images(r, v, "generators", p->frame.n_nodes, &s->generator, &s->n_generators);
  if (!st) st = read_images(r, v, "images", p->frame.n_nodes, &s->image, &s->n_images);
  if (!st) st = read_copies(r, v, p, s);
  if (!st) st = thr_field_double(r, v, "steps", &s->steps);
  if (!st) st = thr_field_int(r, v, "unique_paths", 1, p->n_cords, &s->unique_paths);
  return st;
}

static thr_status read_metrics(const thr_field_reader *r, const thr_json *doc, thr_metrics *m)
{
  const thr_json *v;
  static const char *const known[] = {"length",  "base_length", "overlap",    "passes",  "most_passes",
                                      "turning", "max_turning", "worst_turn", "u_turns", NULL};
  thr_status st = thr_field_need(r, doc, "metrics", THR_JSON_OBJECT, &v);
  if (!st) st = thr_field_only(r, v, "metrics", known);
  if (st) return st;
  if ((st = thr_field_double(r, v, "length", &m->length))) return st;
  if ((st = thr_field_double(r, v, "base_length", &m->base_length))) return st;
  if ((st = thr_field_double(r, v, "overlap", &m->overlap))) return st;
  if ((st = thr_field_int(r, v, "passes", 0, INT32_MAX, &m->passes))) return st;
  if ((st = thr_field_int(r, v, "most_passes", 0, INT32_MAX, &m->most_passes))) return st;
  if ((st = thr_field_double(r, v, "turning", &m->turning))) return st;
  if ((st = thr_field_double(r, v, "max_turning", &m->max_turning))) return st;
  if ((st = thr_field_double(r, v, "worst_turn", &m->worst_turn))) return st;
  return thr_field_int(r, v, "u_turns", 0, INT32_MAX, &m->u_turns);
}

/* One record per cord, one tension per pass: then code that reads them needs no other look. */
static thr_status read_evaluation(const thr_field_reader *r, const thr_json *doc, thr_plan *p)
{
  char place[256];
  const thr_json *v = thr_json_get(doc, "evaluation");
  if (!v) return THR_OK;
  snprintf(place, sizeof place, "%.200s: evaluation", r->name);
  thr_evaluation *e = &p->evaluation;
  thr_status st = thr_evaluation_from_json(e, v, place, r->err);
  if (st) return st;
  if (e->n_cords != p->n_cords) return thr_field_bad(r, "evaluation.cords", "not one per cord of the plan");
  for (int i = 0; i < e->n_cords; i++) {
    if (e->cord[i].known && e->cord[i].n_passes != p->cord[i].n_passes)
      return thr_fail(r->err, r->code, "%s: evaluation.cords[%d].tension: not one per pass of the cord (%d)", r->name, i,
                      p->cord[i].n_passes);
    e->cord[i].n_passes = p->cord[i].n_passes;
  }
  return THR_OK;
}

static thr_status read_document(thr_field_reader *r, const thr_json *doc, thr_plan *p)
{
  const char *format = thr_json_string(thr_json_get(doc, "format"));
  int version;
  if (!format || strcmp(format, "thread-plan") != 0)
    return thr_field_bad(r, "format", "not a thread plan; make one with `thread plan`");
  thr_status st = thr_field_int(r, doc, "version", 1, INT32_MAX, &version);
  if (st) return st;
  if (version != 1) return thr_field_bad(r, "version", "written by another version of thread; this one reads version 1");
  const char *generator = thr_json_string(thr_json_get(doc, "generator"));
  if (!(p->generator = thr_strdup(generator ? generator : ""))) return thr_nomem(r->err);
  thr_text_clean(p->generator);
  if ((st = read_frame(r, doc, &p->frame))) return st;
  if ((st = thr_plan_read_options(r, doc, &p->frame, &p->options))) return st;
  r->code = THR_EVIOLATED;
  if ((st = read_cords(r, doc, p))) return st;
  if ((st = read_symmetry(r, doc, p, &p->symmetry))) return st;
  if ((st = read_metrics(r, doc, &p->metrics))) return st;
  if ((st = read_evaluation(r, doc, p))) return st;
  return thr_plan_read_proofs(r, doc, p);
}

thr_status thr_plan_parse(thr_plan *p, const char *text, size_t n, const char *name, thr_err *err)
{
  thr_plan plan = {0};
  thr_json *doc;
  *p = plan;
  thr_status st = thr_json_parse(&doc, text, n, name, err);
  if (st) return st;
  st = read_document(&(thr_field_reader){name, THR_EINPUT, err}, doc, &plan);
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
