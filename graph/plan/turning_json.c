/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The turning proof as JSON: docs/plan-format.md. */
#include "graph/plan/turning_proof.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---- writing ---- */

static void put_multipliers(thr_writer *writer, const char *key, const int64_t *value, int n)
{
  thr_write_row(writer, key);
  for (int i = 0; i < n; i++)
    thr_write_int(writer, NULL, value[i]);
  thr_write_close(writer);
}

/* One of a list, each on its own line: an object with its value, open. */
static void begin_item(thr_writer *writer, int64_t value)
{
  thr_write_line(writer, 6);
  thr_write_object(writer, NULL);
  thr_write_int(writer, "value", value);
}

static void begin_list(thr_writer *writer, const char *key)
{
  thr_write_line(writer, 5);
  thr_write_array(writer, key);
}

static void put_sets(thr_writer *writer, const char *key, const thr_turning_set *set, int n)
{
  begin_list(writer, key);
  for (int i = 0; i < n; i++) {
    begin_item(writer, set[i].value);
    thr_write_ints(writer, "members", set[i].member, set[i].n);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

static void put_partitions(thr_writer *writer, const char *key,
                           const thr_turning_partition *partition, int n, int n_edges)
{
  begin_list(writer, key);
  for (int i = 0; i < n; i++) {
    begin_item(writer, partition[i].value);
    thr_write_ints(writer, "blocks", partition[i].block, n_edges);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

static void put_junctions(thr_writer *writer, const thr_turning_dual *dual, const thr_frame *frame)
{
  begin_list(writer, "junctions");
  for (int i = 0; i < dual->n_junctions; i++) {
    const thr_turning_junction *turning_junction = &dual->junction[i];
    begin_item(writer, turning_junction->value);
    thr_write_int(writer, "node", turning_junction->node);
    thr_write_ints(writer, "blocks", turning_junction->block,
                   thr_degree(frame, turning_junction->node));
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

static void put_dual(thr_writer *writer, const thr_turning_dual *dual, const thr_frame *frame,
                     int n_ends)
{
  thr_write_object(writer, NULL);
  put_multipliers(writer, "potentials", dual->potential, 2 * frame->n_edges);
  thr_write_line(writer, 5);
  put_multipliers(writer, "ends", dual->ends, n_ends);
  thr_write_int(writer, "length", dual->length);
  put_sets(writer, "odd_sets", dual->odd, dual->n_odd);
  put_sets(writer, "groups", dual->group, dual->n_groups);
  put_partitions(writer, "partitions", dual->partition, dual->n_partitions, frame->n_edges);
  if (dual->n_ranks) put_partitions(writer, "ranks", dual->rank, dual->n_ranks, frame->n_edges);
  if (dual->n_junctions) put_junctions(writer, dual, frame);
  thr_write_close(writer);
}

static void put_node(thr_writer *writer, const thr_turning_node *node)
{
  thr_write_object(writer, NULL);
  if (node->low) {
    thr_write_int(writer, "low", node->low);
    thr_write_int(writer, "high", node->high);
    thr_write_int(writer, "a", node->a);
    thr_write_int(writer, "b", node->b);
    thr_write_int(writer, "value", node->value);
    if (node->n_orbit) thr_write_ints(writer, "orbit", node->orbit, node->n_orbit);
  } else {
    thr_write_int(writer, "multipliers", node->dual);
  }
  thr_write_close(writer);
}

/* A proof with none has no member for them. */
static void put_symmetries(thr_writer *writer, const thr_turning_proof *proof,
                           const thr_frame *frame)
{
  if (proof->n_symmetries == 0) return;
  thr_write_line(writer, 3);
  thr_write_array(writer, "symmetries");
  for (int i = 0; i < proof->n_symmetries; i++) {
    thr_write_line(writer, 4);
    thr_write_ints(writer, NULL, proof->symmetry + (size_t)i * (size_t)frame->n_edges,
                   frame->n_edges);
  }
  thr_write_close(writer);
}

/* Where walks remember edges, if they do. */
static void put_memory(thr_writer *writer, const thr_walk_proof *walks)
{
  if (walks->n_memories == 0) return;
  thr_write_line(writer, 4);
  thr_write_array(writer, "memory");
  for (int i = 0; i < walks->n_memories; i++) {
    thr_write_object(writer, NULL);
    thr_write_int(writer, "edge", walks->memory[i].edge);
    thr_write_ints(writer, "places", walks->memory[i].place, walks->memory[i].n);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

void thr_walk_proof_write(const thr_walk_proof *walks, const thr_frame *frame, const char *all,
                          thr_writer *writer)
{
  if (walks->unit == 0) return;
  thr_write_line(writer, 3);
  thr_write_object(writer, "walks");
  thr_write_int(writer, "unit", walks->unit);
  thr_write_int(writer, "units", walks->units);
  thr_write_int(writer, all ? all : "bits", all ? walks->all : walks->bits);
  thr_write_line(writer, 4);
  put_multipliers(writer, "edges", walks->edge, frame->n_edges);
  thr_write_line(writer, 4);
  put_multipliers(writer, "nodes", walks->node, frame->n_nodes);
  put_memory(writer, walks);
  thr_write_close(writer);
}

void thr_turning_proof_write(const thr_turning_proof *proof, const thr_frame *frame,
                             thr_writer *writer, const char *key)
{
  thr_write_object(writer, key);
  thr_write_array(writer, "tree");
  for (int i = 0; i < proof->n_nodes; i++) {
    thr_write_line(writer, 4);
    put_node(writer, &proof->node[i]);
  }
  thr_write_close(writer);
  thr_write_line(writer, 3);
  thr_write_array(writer, "multipliers");
  for (int i = 0; i < proof->n_duals; i++) {
    thr_write_line(writer, 4);
    put_dual(writer, &proof->dual[i], frame, proof->n_ends);
  }
  thr_write_close(writer);
  put_symmetries(writer, proof, frame);
  thr_walk_proof_write(&proof->walks, frame, proof->walks.pulled ? NULL : "turning", writer);
  thr_write_close(writer);
}

/* ---- reading ---- */

typedef struct {
  const char *place;
  const thr_frame *f;
  int n_ends, n_symmetries;
  thr_err *err;
} reader;

static thr_status bad(const reader *r, const char *key, const char *what)
{
  return thr_fail(r->err, THR_EVIOLATED, "%s.%s: %s", r->place, key, what);
}

/* Exactly the members named, and no other. known ends with NULL. */
static thr_status only_members(const reader *r, const thr_json *object, const char *const *known)
{
  if (thr_json_typeof(object) != THR_JSON_OBJECT)
    return thr_fail(r->err, THR_EVIOLATED, "%s: expected an object", r->place);
  for (int i = 0; known[i]; i++)
    if (!thr_json_get(object, known[i])) return bad(r, known[i], "missing");
  const char *key = thr_json_unknown(object, known);
  return key ? bad(r, key, "this version does not know it and cannot check it") : THR_OK;
}

static thr_status get_int(const reader *r, const thr_json *value, const char *key, int64_t low,
                          int64_t high, int64_t *out)
{
  if (thr_json_int(value, out) && *out >= low && *out <= high) return THR_OK;
  return thr_fail(r->err, THR_EVIOLATED, "%s.%s: not an integer from %" PRId64 " to %" PRId64,
                  r->place, key, low, high);
}

static thr_status get_array(const reader *r, const thr_json *object, const char *key,
                            const thr_json **list)
{
  *list = thr_json_get(object, key);
  return thr_json_typeof(*list) == THR_JSON_ARRAY ? THR_OK : bad(r, key, "not a list");
}

static thr_status read_multipliers(const reader *r, const thr_json *object, const char *key, int n,
                                   int64_t **out)
{
  const thr_json *list;
  thr_status st = get_array(r, object, key, &list);
  if (st) return st;
  if (thr_json_size(list) != n)
    return thr_fail(r->err, THR_EVIOLATED, "%s.%s: expected %d numbers", r->place, key, n);
  if (!(*out = thr_calloc((size_t)n, sizeof **out))) return thr_nomem(r->err);
  for (int i = 0; i < n && !st; i++)
    st = get_int(r, thr_json_at(list, i), key, INT64_MIN, INT64_MAX, &(*out)[i]);
  return st;
}

/* A list of integers from 0 to limit - 1. */
static thr_status read_ints(const reader *r, const thr_json *list, const char *key, int limit,
                            int *out)
{
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(list) && !st; i++) {
    int64_t value = 0;
    st = get_int(r, thr_json_at(list, i), key, 0, limit - 1, &value);
    out[i] = (int)value;
  }
  return st;
}

static thr_status read_set(const reader *r, const thr_json *value, const char *key, int limit,
                           thr_turning_set *set)
{
  static const char *const known[] = {"value", "members", NULL};
  const thr_json *list;
  thr_status st = only_members(r, value, known);
  if (!st) st = get_int(r, thr_json_get(value, "value"), key, 0, INT64_MAX, &set->value);
  if (!st) st = get_array(r, value, "members", &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(set->member = thr_calloc((size_t)n, sizeof *set->member))) return thr_nomem(r->err);
  set->n = n;
  return read_ints(r, list, key, limit, set->member);
}

static thr_status read_sets(const reader *r, const thr_json *object, const char *key, int limit,
                            int *count, thr_turning_set **out)
{
  const thr_json *list;
  thr_status st = get_array(r, object, key, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(*out = thr_calloc((size_t)n, sizeof **out))) return thr_nomem(r->err);
  *count = n;
  for (int i = 0; i < n && !st; i++)
    st = read_set(r, thr_json_at(list, i), key, limit, &(*out)[i]);
  return st;
}

static thr_status read_partition(const reader *r, const thr_json *value,
                                 thr_turning_partition *partition)
{
  static const char *const known[] = {"value", "blocks", NULL};
  const thr_json *list = NULL;
  int m = r->f->n_edges;
  thr_status st = only_members(r, value, known);
  if (!st) st = get_int(r, thr_json_get(value, "value"), "value", 0, INT64_MAX, &partition->value);
  if (!st) st = get_array(r, value, "blocks", &list);
  if (!st && thr_json_size(list) != m) st = bad(r, "blocks", "not one per edge");
  if (!st && !(partition->block = thr_calloc((size_t)m, sizeof *partition->block)))
    st = thr_nomem(r->err);
  return st ? st : read_ints(r, list, "blocks", m, partition->block);
}

static thr_status read_partitions(const reader *r, const thr_json *object, const char *key,
                                  int *count, thr_turning_partition **out)
{
  const thr_json *list;
  thr_status st = get_array(r, object, key, &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(*out = thr_calloc((size_t)n, sizeof **out))) return thr_nomem(r->err);
  *count = n;
  for (int i = 0; i < n && !st; i++)
    st = read_partition(r, thr_json_at(list, i), &(*out)[i]);
  return st;
}

static thr_status read_junction(const reader *r, const thr_json *value,
                                thr_turning_junction *turning_junction)
{
  static const char *const known[] = {"value", "node", "blocks", NULL};
  const thr_json *list = NULL;
  int64_t node = 0;
  thr_status st = only_members(r, value, known);
  if (!st)
    st = get_int(r, thr_json_get(value, "value"), "value", 0, INT64_MAX, &turning_junction->value);
  if (!st) st = get_int(r, thr_json_get(value, "node"), "node", 0, r->f->n_nodes - 1, &node);
  if (!st) st = get_array(r, value, "blocks", &list);
  if (st) return st;
  turning_junction->node = (int)node;
  int d = thr_degree(r->f, turning_junction->node);
  if (thr_json_size(list) != d) return bad(r, "blocks", "not one per edge of the node");
  if (!(turning_junction->block = thr_calloc((size_t)d, sizeof *turning_junction->block)))
    return thr_nomem(r->err);
  return read_ints(r, list, "blocks", d, turning_junction->block);
}

/* Plans with tube joints only. */
static thr_status read_junctions(const reader *r, const thr_json *object, thr_turning_dual *dual)
{
  const thr_json *list;
  if (!thr_json_get(object, "junctions")) return THR_OK;
  thr_status st = get_array(r, object, "junctions", &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(dual->junction = thr_calloc((size_t)n, sizeof *dual->junction))) return thr_nomem(r->err);
  dual->n_junctions = n;
  for (int i = 0; i < n && !st; i++)
    st = read_junction(r, thr_json_at(list, i), &dual->junction[i]);
  return st;
}

static thr_status read_dual(const reader *r, const thr_json *value, thr_turning_dual *dual)
{
  static const char *const optional[] = {"ranks", "junctions"};
  const char *known[9] = {"potentials", "ends", "length", "odd_sets", "groups", "partitions"};
  for (int i = 0, n = 6; i < 2; i++)
    if (thr_json_get(value, optional[i])) known[n++] = optional[i];
  int m = r->f->n_edges;
  thr_status st = only_members(r, value, known);
  if (!st) st = read_multipliers(r, value, "potentials", 2 * m, &dual->potential);
  if (!st) st = read_multipliers(r, value, "ends", r->n_ends, &dual->ends);
  if (!st) st = get_int(r, thr_json_get(value, "length"), "length", 0, INT64_MAX, &dual->length);
  if (!st) st = read_sets(r, value, "odd_sets", 2 * m + r->n_ends, &dual->n_odd, &dual->odd);
  if (!st) st = read_sets(r, value, "groups", m, &dual->n_groups, &dual->group);
  if (!st) st = read_partitions(r, value, "partitions", &dual->n_partitions, &dual->partition);
  if (!st && thr_json_get(value, "ranks"))
    st = read_partitions(r, value, "ranks", &dual->n_ranks, &dual->rank);
  if (!st) st = read_junctions(r, value, dual);
  return st;
}

static thr_status read_orbit(const reader *r, const thr_json *value, thr_turning_node *node)
{
  const thr_json *list;
  if (!thr_json_get(value, "orbit")) return THR_OK;
  thr_status st = get_array(r, value, "orbit", &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(node->orbit = thr_calloc((size_t)n, sizeof *node->orbit))) return thr_nomem(r->err);
  node->n_orbit = n;
  return read_ints(r, list, "orbit", r->n_symmetries, node->orbit);
}

static thr_status read_node(const reader *r, const thr_json *value, thr_turning_node *node)
{
  static const char *const inner[] = {"low", "high", "a", "b", "value", NULL}, *const leaf[] = {
                                                                                   "multipliers",
                                                                                   NULL};
  static const char *const at_once[] = {"low", "high", "a", "b", "value", "orbit", NULL};
  int64_t number[5] = {0};
  bool is_leaf = thr_json_get(value, "multipliers") != NULL;
  const char *const *key = is_leaf ? leaf : inner;
  thr_status st = only_members(r, value, thr_json_get(value, "orbit") && !is_leaf ? at_once : key);
  for (int i = 0; key[i] && !st; i++)
    st = get_int(r, thr_json_get(value, key[i]), key[i], i == 3 ? -1 : 0, INT_MAX, &number[i]);
  if (!st && !is_leaf && (number[0] == 0 || number[1] == 0))
    return bad(r, "low", "a branch needs two nodes below it");
  *node = (thr_turning_node){.dual = -1};
  if (is_leaf)
    node->dual = (int)number[0];
  else
    node->low = (int)number[0], node->high = (int)number[1], node->a = (int)number[2],
    node->b = (int)number[3], node->value = (int)number[4];
  return st || is_leaf ? st : read_orbit(r, value, node);
}

static thr_status read_symmetries(reader *r, const thr_json *value, thr_turning_proof *proof)
{
  const thr_json *list;
  const int m = r->f->n_edges;
  if (!thr_json_get(value, "symmetries")) return THR_OK;
  thr_status st = get_array(r, value, "symmetries", &list);
  if (st) return st;
  int n = thr_json_size(list);
  if (!(proof->symmetry = thr_calloc((size_t)n * (size_t)m, sizeof *proof->symmetry)))
    return thr_nomem(r->err);
  proof->n_symmetries = r->n_symmetries = n;
  for (int i = 0; i < n && !st; i++) {
    const thr_json *image = thr_json_at(list, i);
    if (thr_json_typeof(image) != THR_JSON_ARRAY || thr_json_size(image) != m)
      return bad(r, "symmetries", "not one per edge");
    st = read_ints(r, image, "symmetries", 2 * m, proof->symmetry + (size_t)i * (size_t)m);
  }
  return st;
}

static thr_status read_memory(const reader *r, const thr_json *value, thr_walk_proof *walks)
{
  static const char *const known[] = {"edge", "places", NULL};
  const int most = 2 * r->f->n_edges > r->f->n_nodes ? 2 * r->f->n_edges : r->f->n_nodes;
  const thr_json *list, *places = NULL;
  if (!thr_json_get(value, "memory")) return THR_OK;
  thr_status st = get_array(r, value, "memory", &list);
  if (st) return st;
  const int n = thr_json_size(list);
  if (!(walks->memory = thr_calloc((size_t)n, sizeof *walks->memory))) return thr_nomem(r->err);
  walks->n_memories = n;
  for (int i = 0; i < n && !st; i++) {
    thr_walk_memory *memory = &walks->memory[i];
    const thr_json *entry = thr_json_at(list, i);
    int64_t edge = 0;
    st = only_members(r, entry, known);
    if (!st) st = get_int(r, thr_json_get(entry, "edge"), "edge", 0, r->f->n_edges - 1, &edge);
    if (!st) st = get_array(r, entry, "places", &places);
    if (st) break;
    memory->edge = (int)edge;
    memory->n = thr_json_size(places);
    memory->place = thr_calloc((size_t)memory->n, sizeof *memory->place);
    st = memory->place ? read_ints(r, places, "places", most, memory->place) : thr_nomem(r->err);
  }
  return st;
}

thr_status thr_walk_proof_from_json(thr_walk_proof *walks, const thr_frame *frame, const char *all,
                                    const thr_json *value, const char *place, thr_err *err)
{
  const bool remembers = value && thr_json_get(value, "memory");
  const char *known[] = {
      "unit", "units", all ? all : "bits", "edges", "nodes", remembers ? "memory" : NULL, NULL};
  const reader r = {.place = place, .f = frame, .err = err};
  int64_t units = 0, bits = 0;
  *walks = (thr_walk_proof){.pulled = value && !all};
  if (!value) return THR_OK;
  thr_status st = only_members(&r, value, known);
  if (!st) st = get_int(&r, thr_json_get(value, "unit"), "unit", 1, INT64_MAX, &walks->unit);
  if (!st) st = get_int(&r, thr_json_get(value, "units"), "units", 0, INT_MAX - 2, &units);
  if (!st && all) st = get_int(&r, thr_json_get(value, all), all, 0, INT64_MAX, &walks->all);
  if (!st && !all)
    st = get_int(&r, thr_json_get(value, "bits"), "bits", 0, THR_TURNING_BITS, &bits);
  if (!st) st = read_multipliers(&r, value, "edges", frame->n_edges, &walks->edge);
  if (!st) st = read_multipliers(&r, value, "nodes", frame->n_nodes, &walks->node);
  if (!st) st = read_memory(&r, value, walks);
  walks->units = (int)units;
  walks->bits = (int)bits;
  if (st) thr_walk_proof_destroy(walks);
  return st;
}

thr_status thr_turning_proof_from_json(thr_turning_proof *proof, const thr_frame *frame,
                                       const thr_json *value, const char *place, thr_err *err)
{
  static const char *const optional[] = {"symmetries", "walks"};
  const char *known[5] = {"tree", "multipliers"};
  reader r = {.place = place, .f = frame, .err = err};
  const thr_json *tree, *duals, *walks = thr_json_get(value, "walks");
  const char *all = walks && thr_json_get(walks, "bits") ? NULL : "turning";
  *proof = (thr_turning_proof){0};
  for (int i = 0, n = 2; i < 2; i++)
    if (thr_json_get(value, optional[i])) known[n++] = optional[i];
  thr_status st = only_members(&r, value, known);
  if (!st) st = get_array(&r, value, "tree", &tree);
  if (!st) st = get_array(&r, value, "multipliers", &duals);
  if (st) return st;
  int n_nodes = thr_json_size(tree), n_duals = thr_json_size(duals);
  proof->n_ends = r.n_ends = thr_json_size(thr_json_get(thr_json_at(duals, 0), "ends"));
  proof->node = thr_calloc((size_t)n_nodes, sizeof *proof->node);
  proof->dual = thr_calloc((size_t)n_duals, sizeof *proof->dual);
  st = proof->node && proof->dual ? THR_OK : thr_nomem(err);
  if (!st) {
    proof->n_nodes = n_nodes;
    proof->n_duals = n_duals;
    st = read_symmetries(&r, value, proof);
  }
  for (int i = 0; i < n_nodes && !st; i++)
    st = read_node(&r, thr_json_at(tree, i), &proof->node[i]);
  for (int i = 0; i < n_duals && !st; i++)
    st = read_dual(&r, thr_json_at(duals, i), &proof->dual[i]);
  if (!st) st = thr_walk_proof_from_json(&proof->walks, frame, all, walks, place, err);
  if (st) thr_turning_proof_destroy(proof);
  return st;
}
