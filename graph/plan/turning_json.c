/* The turning proof as JSON: docs/plan-format.md. */
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/io/writer.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---- writing ---- */

static void put_multipliers(thr_writer *w, const char *key, const int64_t *value, int n)
{
  thr_write_row(w, key);
  for (int i = 0; i < n; i++)
    thr_write_int(w, NULL, value[i]);
  thr_write_close(w);
}

/* One of a list, each on its own line: an object with its value, open. */
static void begin_item(thr_writer *w, int64_t value)
{
  thr_write_line(w, 6);
  thr_write_object(w, NULL);
  thr_write_int(w, "value", value);
}

static void begin_list(thr_writer *w, const char *key)
{
  thr_write_line(w, 5);
  thr_write_array(w, key);
}

static void put_sets(thr_writer *w, const char *key, const thr_turning_set *set, int n)
{
  begin_list(w, key);
  for (int i = 0; i < n; i++) {
    begin_item(w, set[i].value);
    thr_write_ints(w, "members", set[i].member, set[i].n);
    thr_write_close(w);
  }
  thr_write_close(w);
}

static void put_partitions(thr_writer *w, const thr_turning_dual *d, int n_edges)
{
  begin_list(w, "partitions");
  for (int i = 0; i < d->n_partitions; i++) {
    begin_item(w, d->partition[i].value);
    thr_write_ints(w, "blocks", d->partition[i].block, n_edges);
    thr_write_close(w);
  }
  thr_write_close(w);
}

static void put_junctions(thr_writer *w, const thr_turning_dual *d, const thr_frame *f)
{
  begin_list(w, "junctions");
  for (int i = 0; i < d->n_junctions; i++) {
    const thr_turning_junction *p = &d->junction[i];
    begin_item(w, p->value);
    thr_write_int(w, "node", p->node);
    thr_write_ints(w, "blocks", p->block, thr_degree(f, p->node));
    thr_write_close(w);
  }
  thr_write_close(w);
}

static void put_dual(thr_writer *w, const thr_turning_dual *d, const thr_frame *f, int n_ends)
{
  thr_write_object(w, NULL);
  put_multipliers(w, "potentials", d->potential, 2 * f->n_edges);
  thr_write_line(w, 5);
  put_multipliers(w, "ends", d->ends, n_ends);
  thr_write_int(w, "length", d->length);
  put_sets(w, "odd_sets", d->odd, d->n_odd);
  put_sets(w, "groups", d->group, d->n_groups);
  put_partitions(w, d, f->n_edges);
  if (d->n_junctions) put_junctions(w, d, f);
  thr_write_close(w);
}

static void put_node(thr_writer *w, const thr_turning_node *n)
{
  thr_write_object(w, NULL);
  if (n->low) {
    thr_write_int(w, "low", n->low);
    thr_write_int(w, "high", n->high);
    thr_write_int(w, "a", n->a);
    thr_write_int(w, "b", n->b);
    thr_write_int(w, "value", n->value);
  } else {
    thr_write_int(w, "multipliers", n->dual);
  }
  thr_write_close(w);
}

void thr_turning_proof_write(const thr_turning_proof *p, const thr_frame *f, thr_writer *w, const char *key)
{
  thr_write_object(w, key);
  thr_write_array(w, "tree");
  for (int i = 0; i < p->n_nodes; i++) {
    thr_write_line(w, 4);
    put_node(w, &p->node[i]);
  }
  thr_write_close(w);
  thr_write_line(w, 3);
  thr_write_array(w, "multipliers");
  for (int i = 0; i < p->n_duals; i++) {
    thr_write_line(w, 4);
    put_dual(w, &p->dual[i], f, p->n_ends);
  }
  thr_write_close(w);
  thr_write_close(w);
}

/* ---- reading ---- */

typedef struct {
  const char *place;
  const thr_frame *f;
  int n_ends;
  thr_err *err;
} reader;

static thr_status bad(const reader *r, const char *key, const char *what)
{
  return thr_fail(r->err, THR_EVIOLATED, "%s.%s: %s", r->place, key, what);
}

/* Exactly the members named, and no other. known ends with NULL. */
static thr_status only_members(const reader *r, const thr_json *o, const char *const *known)
{
  if (thr_json_typeof(o) != THR_JSON_OBJECT) return thr_fail(r->err, THR_EVIOLATED, "%s: expected an object", r->place);
  for (int i = 0; known[i]; i++)
    if (!thr_json_get(o, known[i])) return bad(r, known[i], "missing");
  const char *key = thr_json_unknown(o, known);
  return key ? bad(r, key, "this version does not know it and cannot check it") : THR_OK;
}

static thr_status get_int(const reader *r, const thr_json *v, const char *key, int64_t low, int64_t high, int64_t *out)
{
  if (thr_json_int(v, out) && *out >= low && *out <= high) return THR_OK;
  return thr_fail(r->err, THR_EVIOLATED, "%s.%s: not an integer from %" PRId64 " to %" PRId64, r->place, key, low, high);
}

static thr_status get_array(const reader *r, const thr_json *o, const char *key, const thr_json **list)
{
  *list = thr_json_get(o, key);
  return thr_json_typeof(*list) == THR_JSON_ARRAY ? THR_OK : bad(r, key, "not a list");
}

static thr_status read_multipliers(const reader *r, const thr_json *o, const char *key, int n, int64_t **out)
{
  const thr_json *list;
  thr_status st = get_array(r, o, key, &list);
  if (st) return st;
  if (thr_json_size(list) != n) return thr_fail(r->err, THR_EVIOLATED, "%s.%s: expected %d numbers", r->place, key, n);
  if (!(*out = thr_calloc((size_t)n, sizeof **out))) return thr_nomem(r->err);
  for (int i = 0; i < n && !st; i++)
    st = get_int(r, thr_json_at(list, i), key, INT64_MIN, INT64_MAX, &(*out)[i]);
  return st;
}

static thr_status read_set(const reader *r, const thr_json *v, const char *key, int limit, thr_turning_set *set)
{
  static const char *const known[] = {"value", "members", NULL};
  const thr_json *list;
  thr_status st = only_members(r, v, known);
  if (!st) st = get_int(r, thr_json_get(v, "value"), key, 0, INT64_MAX, &set->value);
  if (!st) st = get_array(r, v, "members", &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(set->member = thr_calloc((size_t)n, sizeof *set->member))) return thr_nomem(r->err);
  set->n = n;
  for (int i = 0; i < n && !st; i++) {
    int64_t member = 0;
    st = get_int(r, thr_json_at(list, i), key, 0, limit - 1, &member);
    set->member[i] = (int)member;
  }
  return st;
}

static thr_status read_sets(const reader *r, const thr_json *o, const char *key, int limit, int *count, thr_turning_set **out)
{
  const thr_json *list;
  thr_status st = get_array(r, o, key, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(*out = thr_calloc((size_t)n, sizeof **out))) return thr_nomem(r->err);
  *count = n;
  for (int i = 0; i < n && !st; i++)
    st = read_set(r, thr_json_at(list, i), key, limit, &(*out)[i]);
  return st;
}

static thr_status read_partition(const reader *r, const thr_json *v, thr_turning_partition *p)
{
  static const char *const known[] = {"value", "blocks", NULL};
  const thr_json *list = NULL;
  int m = r->f->n_edges;
  thr_status st = only_members(r, v, known);
  if (!st) st = get_int(r, thr_json_get(v, "value"), "value", 0, INT64_MAX, &p->value);
  if (!st) st = get_array(r, v, "blocks", &list);
  if (!st && thr_json_size(list) != m) st = bad(r, "blocks", "not one per edge");
  if (!st && !(p->block = thr_calloc((size_t)m, sizeof *p->block))) st = thr_nomem(r->err);
  for (int e = 0; e < m && !st; e++) {
    int64_t block = 0;
    st = get_int(r, thr_json_at(list, e), "blocks", 0, m - 1, &block);
    p->block[e] = (int)block;
  }
  return st;
}

static thr_status read_partitions(const reader *r, const thr_json *o, thr_turning_dual *d)
{
  const thr_json *list;
  thr_status st = get_array(r, o, "partitions", &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(d->partition = thr_calloc((size_t)n, sizeof *d->partition))) return thr_nomem(r->err);
  d->n_partitions = n;
  for (int i = 0; i < n && !st; i++)
    st = read_partition(r, thr_json_at(list, i), &d->partition[i]);
  return st;
}

static thr_status read_junction(const reader *r, const thr_json *v, thr_turning_junction *p)
{
  static const char *const known[] = {"value", "node", "blocks", NULL};
  const thr_json *list = NULL;
  int64_t node = 0;
  thr_status st = only_members(r, v, known);
  if (!st) st = get_int(r, thr_json_get(v, "value"), "value", 0, INT64_MAX, &p->value);
  if (!st) st = get_int(r, thr_json_get(v, "node"), "node", 0, r->f->n_nodes - 1, &node);
  if (!st) st = get_array(r, v, "blocks", &list);
  if (st) return st;
  p->node = (int)node;
  int d = thr_degree(r->f, p->node);
  if (thr_json_size(list) != d) return bad(r, "blocks", "not one per edge of the node");
  if (!(p->block = thr_calloc((size_t)d, sizeof *p->block))) return thr_nomem(r->err);
  for (int k = 0; k < d && !st; k++) {
    int64_t block = 0;
    st = get_int(r, thr_json_at(list, k), "blocks", 0, d - 1, &block);
    p->block[k] = (int)block;
  }
  return st;
}

/* Plans with tube joints only. */
static thr_status read_junctions(const reader *r, const thr_json *o, thr_turning_dual *d)
{
  const thr_json *list;
  if (!thr_json_get(o, "junctions")) return THR_OK;
  thr_status st = get_array(r, o, "junctions", &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(d->junction = thr_calloc((size_t)n, sizeof *d->junction))) return thr_nomem(r->err);
  d->n_junctions = n;
  for (int i = 0; i < n && !st; i++)
    st = read_junction(r, thr_json_at(list, i), &d->junction[i]);
  return st;
}

static thr_status read_dual(const reader *r, const thr_json *v, thr_turning_dual *d)
{
  static const char *const known[] = {"potentials", "ends", "length", "odd_sets", "groups", "partitions", "junctions", NULL},
                           *const solid[] = {"potentials", "ends", "length", "odd_sets", "groups", "partitions", NULL};
  int m = r->f->n_edges;
  thr_status st = only_members(r, v, thr_json_get(v, "junctions") ? known : solid);
  if (!st) st = read_multipliers(r, v, "potentials", 2 * m, &d->potential);
  if (!st) st = read_multipliers(r, v, "ends", r->n_ends, &d->ends);
  if (!st) st = get_int(r, thr_json_get(v, "length"), "length", 0, INT64_MAX, &d->length);
  if (!st) st = read_sets(r, v, "odd_sets", 2 * m + r->n_ends, &d->n_odd, &d->odd);
  if (!st) st = read_sets(r, v, "groups", m, &d->n_groups, &d->group);
  if (!st) st = read_partitions(r, v, d);
  if (!st) st = read_junctions(r, v, d);
  return st;
}

static thr_status read_node(const reader *r, const thr_json *v, thr_turning_node *n)
{
  static const char *const inner[] = {"low", "high", "a", "b", "value", NULL}, *const leaf[] = {"multipliers", NULL};
  int64_t number[5] = {0};
  bool is_leaf = thr_json_get(v, "multipliers") != NULL;
  const char *const *key = is_leaf ? leaf : inner;
  thr_status st = only_members(r, v, key);
  for (int i = 0; key[i] && !st; i++)
    st = get_int(r, thr_json_get(v, key[i]), key[i], i == 3 ? -1 : 0, INT_MAX, &number[i]);
  if (!st && !is_leaf && (number[0] == 0 || number[1] == 0)) return bad(r, "low", "a branch needs two nodes below it");
  *n = (thr_turning_node){.dual = -1};
  if (is_leaf)
    n->dual = (int)number[0];
  else
    n->low = (int)number[0], n->high = (int)number[1], n->a = (int)number[2], n->b = (int)number[3], n->value = (int)number[4];
  return st;
}

thr_status thr_turning_proof_from_json(thr_turning_proof *p, const thr_frame *f, const thr_json *v, const char *place,
                                       thr_err *err)
{
  static const char *const known[] = {"tree", "multipliers", NULL};
  reader r = {place, f, 0, err};
  const thr_json *tree, *duals;
  *p = (thr_turning_proof){0};
  thr_status st = only_members(&r, v, known);
  if (!st) st = get_array(&r, v, "tree", &tree);
  if (!st) st = get_array(&r, v, "multipliers", &duals);
  if (st) return st;
  int n_nodes = thr_json_size(tree), n_duals = thr_json_size(duals);
  p->n_ends = r.n_ends = thr_json_size(thr_json_get(thr_json_at(duals, 0), "ends"));
  p->node = thr_calloc((size_t)n_nodes, sizeof *p->node);
  p->dual = thr_calloc((size_t)n_duals, sizeof *p->dual);
  st = p->node && p->dual ? THR_OK : thr_nomem(err);
  if (!st) {
    p->n_nodes = n_nodes;
    p->n_duals = n_duals;
  }
  for (int i = 0; i < n_nodes && !st; i++)
    st = read_node(&r, thr_json_at(tree, i), &p->node[i]);
  for (int i = 0; i < n_duals && !st; i++)
    st = read_dual(&r, thr_json_at(duals, i), &p->dual[i]);
  if (st) thr_turning_proof_destroy(p);
  return st;
}
