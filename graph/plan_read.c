/* plan.json, read: docs/plan-format.md is the schema. Every accessor fails with "file: place: what". */
#include "graph/plan.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* A bound, a price or a part: never negative. */
static thr_status get_amount(const reader *r, const thr_json *o, const char *key, double *out)
{
  thr_status st = get_double(r, o, key, out);
  return !st && *out < 0 ? bad(r, key, "negative") : st;
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

/* Text that is one of n names; *out is its number. */
static thr_status name_of(const reader *r, const thr_json *v, const char *place, const char *key, int n, const char *(*name)(int),
                          int *out)
{
  char known[80] = "";
  const char *value = thr_json_string(v);
  for (*out = 0; *out < n; ++*out) {
    if (value && strcmp(value, name(*out)) == 0) return THR_OK;
    size_t length = strlen(known);
    snprintf(known + length, sizeof known - length, "%s%s", *out ? ", " : "", name(*out));
  }
  *out = 0;
  return thr_fail(r->err, r->code, "%s: %s.%s: this version knows %s only", r->name, place, key, known);
}

static thr_status get_name(const reader *r, const thr_json *o, const char *place, const char *key, int n,
                           const char *(*name)(int), int *out)
{
  return name_of(r, thr_json_get(o, key), place, key, n, name, out);
}

static const char *objective_name(int i)
{
  return thr_objective_name((thr_objective)i);
}
static const char *ends_name(int i)
{
  return thr_ends_name((thr_ends)i);
}
static const char *cost_name(int i)
{
  return thr_turn_cost_name((thr_turn_cost)i);
}
static const char *tour_name(int i)
{
  return thr_tour_name((thr_tour)i);
}
static const char *prefer_name(int i)
{
  return thr_aim_name((thr_aim)i);
}
static const char *joint_name(int i)
{
  return i == 0 ? "solid" : NULL;
}
static const char *aim_name(int i)
{
  return i ? "max-turning" : "turning";
}
static const char *pairings_name(int i)
{
  return i ? "ignore" : "keep";
}
static const char *status_name(int i)
{
  return i ? "optimal" : "bound";
}

/* A number >= 0, or null, which is -1. */
static thr_status get_or_null(const reader *r, const thr_json *o, const char *key, double *out)
{
  const thr_json *v = thr_json_get(o, key);
  *out = -1;
  if (v && thr_json_typeof(v) == THR_JSON_NULL) return THR_OK;
  return get_amount(r, o, key, out);
}

static thr_status read_turning_options(const reader *r, const thr_json *o, thr_turning_options *t)
{
  static const char *const known[] = {"cost", "length_slack", "minimize", "tour", "pairings", NULL};
  const thr_json *v;
  int cost, aim, tour, pairings;
  thr_status st = need(r, o, "turning", THR_JSON_OBJECT, &v);
  if (!st) st = only_members(r, v, "options.turning", known);
  if (!st) st = get_name(r, v, "options.turning", "cost", THR_N_TURN_COSTS, cost_name, &cost);
  if (!st) st = get_or_null(r, v, "length_slack", &t->length_slack);
  if (!st) st = get_name(r, v, "options.turning", "minimize", 2, aim_name, &aim);
  if (!st) st = get_name(r, v, "options.turning", "tour", THR_N_TOURS, tour_name, &tour);
  if (!st) st = get_name(r, v, "options.turning", "pairings", 2, pairings_name, &pairings);
  if (st) return st;
  t->cost = (thr_turn_cost)cost;
  t->largest = aim == 1;
  t->tour = (thr_tour)tour;
  t->ignore_pairings = pairings == 1;
  return THR_OK;
}

/* Every aim once. */
static thr_status read_prefer(const reader *r, const thr_json *o, thr_aim prefer[THR_N_AIMS])
{
  bool named[THR_N_AIMS] = {false};
  const thr_json *list;
  thr_status st = need(r, o, "prefer", THR_JSON_ARRAY, &list);
  if (!st && thr_json_size(list) != THR_N_AIMS) return bad(r, "options.symmetry.prefer", "not four aims");
  for (int i = 0, aim = 0; i < THR_N_AIMS && !st; i++) {
    st = name_of(r, thr_json_at(list, i), "options.symmetry", "prefer", THR_N_AIMS, prefer_name, &aim);
    if (!st && named[aim]) return bad(r, "options.symmetry.prefer", "names one aim twice");
    named[aim] = true;
    prefer[i] = (thr_aim)aim;
  }
  return st;
}

static thr_status read_symmetry_options(const reader *r, const thr_json *o, thr_symmetry_options *s)
{
  static const char *const known[] = {"group", "geometric", "prefer", NULL};
  const thr_json *v, *group;
  thr_status st = need(r, o, "symmetry", THR_JSON_OBJECT, &v);
  if (!st) st = only_members(r, v, "options.symmetry", known);
  if (st) return st;
  group = thr_json_get(v, "group");
  const char *name = thr_json_string(group);
  if (!group || (!name && thr_json_typeof(group) != THR_JSON_NULL) || (name && (!*name || strlen(name) >= sizeof s->group)))
    return bad(r, "options.symmetry.group", "neither null nor a text of 1 to 15 bytes");
  snprintf(s->group, sizeof s->group, "%s", name ? name : "");
  if ((st = get_or_null(r, v, "geometric", &s->geometric))) return st;
  return read_prefer(r, v, s->prefer);
}

/* Which options there are depends on the objective. */
static thr_status read_objective(const reader *r, const thr_json *v, thr_plan_options *o)
{
  static const char *const own[THR_N_OBJECTIVES] = {NULL, "turning", "symmetry"};
  const char *known[] = {"objective", "joint", "cover", "cords", "ends", "end_nodes", "time_limit", "physics", NULL, NULL};
  int objective, joint;
  thr_status st = get_name(r, v, "options", "objective", THR_N_OBJECTIVES, objective_name, &objective);
  if (st) return st;
  known[sizeof known / sizeof *known - 2] = own[objective];
  if ((st = only_members(r, v, "options", known))) return st;
  if ((st = get_name(r, v, "options", "joint", 1, joint_name, &joint))) return st;
  o->objective = (thr_objective)objective;
  if (objective == THR_TORTUOSITY) return read_turning_options(r, v, &o->turning);
  return objective == THR_SYMMETRY ? read_symmetry_options(r, v, &o->symmetry) : THR_OK;
}

static thr_status read_options(const reader *r, const thr_json *doc, const thr_frame *f, thr_plan_options *o)
{
  char place[256];
  const thr_json *v;
  thr_status st = need(r, doc, "options", THR_JSON_OBJECT, &v);
  if (st) return st;
  *o = thr_plan_options_default();
  if ((st = read_objective(r, v, o))) return st;
  if ((st = get_int(r, v, "cover", 1, 100, &o->cover))) return st;
  if ((st = get_int(r, v, "cords", 1, 1000, &o->cords))) return st;
  snprintf(place, sizeof place, "%.200s: options.physics", r->name);
  if ((st = thr_physics_from_json(&o->physics, thr_json_get(v, "physics"), place, r->err))) return st;
  if ((st = get_double(r, v, "time_limit", &o->time_limit))) return st;
  int kind;
  if ((st = get_name(r, v, "options", "ends", THR_ENDS_NODES + 1, ends_name, &kind))) return st;
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

/* A list of images of all nodes, one list of indices each. */
static thr_status read_images(const reader *r, const thr_json *o, const char *key, int n_nodes, int **image, int *count)
{
  const thr_json *list;
  char place[48];
  thr_status st = need(r, o, key, THR_JSON_ARRAY, &list);
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
      if ((st = index_at(r, thr_json_at(list, i), v, n_nodes, place, &(*image)[(size_t)i * (size_t)n_nodes + (size_t)v])))
        return st;
  }
  return THR_OK;
}

static thr_status read_copies(const reader *r, const thr_json *o, const thr_plan *p, thr_symmetry_record *s)
{
  static const char *const known[] = {"of", "image", NULL};
  const thr_json *list;
  thr_status st = need(r, o, "cords", THR_JSON_ARRAY, &list);
  if (st) return st;
  if (thr_json_size(list) != p->n_cords) return bad(r, "symmetry.cords", "not one per cord of the plan");
  s->unique = thr_calloc((size_t)p->n_cords, sizeof *s->unique);
  s->element = thr_calloc((size_t)p->n_cords, sizeof *s->element);
  if (!s->unique || !s->element) return thr_nomem(r->err);
  for (int i = 0; i < p->n_cords && !st; i++) {
    const thr_json *v = thr_json_at(list, i);
    st = only_members(r, v, "symmetry.cords", known);
    if (!st) st = get_int(r, v, "of", 0, p->n_cords - 1, &s->unique[i]);
    if (!st) st = get_int(r, v, "image", 0, s->n_images - 1, &s->element[i]);
  }
  return st;
}

/* There with the objective that asks for it, and nowhere else. */
static thr_status read_symmetry(const reader *r, const thr_json *doc, const thr_plan *p, thr_symmetry_record *s)
{
  static const char *const known[] = {"order", "name", "generators", "images", "cords", "steps", "unique_paths", NULL};
  const thr_json *v = thr_json_get(doc, "symmetry"), *name;
  if (p->options.objective != THR_SYMMETRY) return v ? bad(r, "symmetry", "only plans with this objective have it") : THR_OK;
  thr_status st = need(r, doc, "symmetry", THR_JSON_OBJECT, &v);
  if (!st) st = only_members(r, v, "symmetry", known);
  if (!st) st = get_int(r, v, "order", 1, 1024, &s->order);
  if (!st) st = need(r, v, "name", THR_JSON_STRING, &name);
  if (st) return st;
  if (strlen(thr_json_string(name)) >= sizeof s->name) return bad(r, "symmetry.name", "longer than 15 bytes");
  snprintf(s->name, sizeof s->name, "%s", thr_json_string(name));
  s->present = true;
  st = read_images(r, v, "generators", p->frame.n_nodes, &s->generator, &s->n_generators);
  if (!st) st = read_images(r, v, "images", p->frame.n_nodes, &s->image, &s->n_images);
  if (!st) st = read_copies(r, v, p, s);
  if (!st) st = get_double(r, v, "steps", &s->steps);
  if (!st) st = get_int(r, v, "unique_paths", 1, p->n_cords, &s->unique_paths);
  return st;
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
  if ((st = get_int(r, v, "slots", 0, 2000, &c->n_slots))) return st;
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

static thr_status get_status(const reader *r, const thr_json *v, const char *place, bool *optimal)
{
  int status;
  thr_status st = get_name(r, v, place, "status", 2, status_name, &status);
  *optimal = status == 1;
  return st;
}

static thr_status read_length_proof(const reader *r, const thr_json *v, const thr_frame *f, thr_length_proof *proof)
{
  static const char *const known[] = {"status", "lower_bound", "gap", "method", "certificate", NULL};
  const thr_json *list;
  thr_status st = only_members(r, v, "proof.length", known);
  if (!st) st = get_status(r, v, "proof.length", &proof->optimal);
  if (!st) st = get_amount(r, v, "lower_bound", &proof->lower_bound);
  if (!st) st = get_amount(r, v, "gap", &proof->gap);
  if (!st) st = need(r, v, "certificate", THR_JSON_ARRAY, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(proof->certificate = thr_calloc((size_t)n, sizeof *proof->certificate))) return thr_nomem(r->err);
  proof->n_certificates = n;
  proof->present = true;
  for (int i = 0; i < n; i++)
    if ((st = read_certificate(r, thr_json_at(list, i), f, &proof->certificate[i]))) return st;
  return THR_OK;
}

static thr_status read_largest(const reader *r, const thr_json *o, thr_turning_claim *c)
{
  static const char *const known[] = {"status", "price", "lower_bound", NULL};
  const thr_json *v;
  thr_status st = need(r, o, "largest", THR_JSON_OBJECT, &v);
  if (!st) st = only_members(r, v, "proof.turning.largest", known);
  if (!st) st = get_status(r, v, "proof.turning.largest", &c->largest_optimal);
  if (!st) st = get_amount(r, v, "price", &c->largest);
  if (!st) st = get_amount(r, v, "lower_bound", &c->largest_bound);
  return st;
}

static thr_status read_turning_claim(const reader *r, const thr_json *v, const thr_frame *f, thr_turning_claim *c)
{
  static const char *const known[] = {"status",       "price",  "lower_bound", "gap", "pairing_bound", "largest", "most_passes",
                                      "length_limit", "method", "proof",       NULL};
  char place[256];
  thr_status st = only_members(r, v, "proof.turning", known);
  if (!st) st = get_status(r, v, "proof.turning", &c->optimal);
  if (!st) st = get_amount(r, v, "price", &c->price);
  if (!st) st = get_amount(r, v, "lower_bound", &c->lower_bound);
  if (!st) st = get_amount(r, v, "gap", &c->gap);
  if (!st) st = get_amount(r, v, "pairing_bound", &c->pairing_bound);
  if (!st) st = read_largest(r, v, c);
  if (!st) st = get_int(r, v, "most_passes", 1, INT32_MAX, &c->most_passes);
  if (!st) st = get_or_null(r, v, "length_limit", &c->length_limit);
  if (st) return st;
  snprintf(place, sizeof place, "%.200s: proof.turning.proof", r->name);
  c->present = true;
  return thr_turning_proof_from_json(&c->tree, f, thr_json_get(v, "proof"), place, r->err);
}

/* A proof says that nothing with the plan's options is better: one of turning goes with the objective that asks for it. */
static thr_status read_proofs(const reader *r, const thr_json *doc, thr_plan *p)
{
  static const char *const of_length[] = {"length", NULL}, *const of_turning[] = {"length", "turning", NULL};
  const thr_json *all;
  thr_status st = need(r, doc, "proof", THR_JSON_OBJECT, &all);
  if (!st) st = only_members(r, all, "proof", p->options.objective == THR_TORTUOSITY ? of_turning : of_length);
  const thr_json *length = thr_json_get(all, "length"), *turning = thr_json_get(all, "turning");
  if (!st && length) st = read_length_proof(r, length, &p->frame, &p->proof);
  if (!st && turning) st = read_turning_claim(r, turning, &p->frame, &p->turning);
  return st;
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
  if ((st = read_symmetry(r, doc, p, &p->symmetry))) return st;
  if ((st = read_metrics(r, doc, &p->metrics))) return st;
  if ((st = read_evaluation(r, doc, p))) return st;
  return read_proofs(r, doc, p);
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
