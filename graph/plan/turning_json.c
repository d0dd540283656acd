/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes and reads proofs of least turning as JSON (docs/plan-format.md).
 *
 * A proof is a tree of bounds on single columns of the model in graph/plan/turning_proof.h. A leaf
 * names its multipliers by number; the multipliers (of equations, odd sets, groups, partitions,
 * ranks, junctions) follow as a second list, then symmetries and prices of walks, if there are any.
 * Reading only checks shapes and ranges; what a proof proves is the checker's business
 * (graph/check).
 *
 * Example: a tree of one branch has three nodes,
 * {"low": 1, "high": 2, "a": 4, "b": 9, "value": 0}, {"multipliers": 0}, {"multipliers": 1}. */
#include "graph/plan/plan_fields.h"

#include <limits.h>

/* ---- writing ---- */

/* Writes a list of n integers in one row. */
static void put_multipliers(thr_writer *writer, const char *key, const int64_t *value, int n)
{
  thr_write_row(writer, key);
  for (int i = 0; i < n; i++)
    thr_write_int(writer, NULL, value[i]);
  thr_write_close(writer);
}

/* Opens an item of a list, on a line of its own: an object that begins with its value. */
static void begin_item(thr_writer *writer, int64_t value)
{
  thr_write_line(writer, 6);
  thr_write_object(writer, NULL);
  thr_write_int(writer, "value", value);
}

/* Opens a list on a line of its own. */
static void begin_list(thr_writer *writer, const char *key)
{
  thr_write_line(writer, 5);
  thr_write_array(writer, key);
}

/* Writes odd sets or groups with their multipliers. */
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

/* Writes partitions of the edges, or ranks, with their multipliers. */
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

/* Writes the blocks of edges at the nodes of tube joints, with their multipliers. */
static void put_junctions(thr_writer *writer, const thr_turning_dual *dual, const thr_frame *frame)
{
  /* One block number for each half-edge of the node, in their order. */
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

/* Members of a leaf's multipliers; that of the limit on length is a number. */
static const thr_field dual_fields[] = {
    {.key = "potentials"},
    {.key = "ends"},
    {"length", THR_FIELD_WHOLE, .offset = offsetof(thr_turning_dual, length)},
    {.key = "odd_sets"},
    {.key = "groups"},
    {.key = "partitions"},
    {.key = "ranks", .optional = true},
    {.key = "junctions", .optional = true},
    {0}};

/* Writes the multipliers of one leaf. Ranks and junctions are left out if there are none. */
static void put_dual(thr_writer *writer, const thr_turning_dual *dual, const thr_frame *frame,
                     int n_ends)
{
  thr_write_object(writer, NULL);

  /* Multipliers of the equations of half-edges and of ends, and of the limit on length. */
  put_multipliers(writer, "potentials", dual->potential, 2 * frame->n_edges);

  thr_write_line(writer, 5);
  put_multipliers(writer, "ends", dual->ends, n_ends);
  thr_fields_write(writer, dual_fields, dual);

  /* Multipliers of inequalities. */
  put_sets(writer, "odd_sets", dual->odd, dual->n_odd);
  put_sets(writer, "groups", dual->group, dual->n_groups);
  put_partitions(writer, "partitions", dual->partition, dual->n_partitions, frame->n_edges);
  if (dual->n_ranks) put_partitions(writer, "ranks", dual->rank, dual->n_ranks, frame->n_edges);
  if (dual->n_junctions) put_junctions(writer, dual, frame);
  thr_write_close(writer);
}

/* Members of a node of the tree. Member b may be -1: columns of ends have one half-edge only. */
static const thr_field branch_fields[] = {
    {"low", THR_FIELD_COUNT, .offset = offsetof(thr_turning_node, low)},
    {"high", THR_FIELD_COUNT, .offset = offsetof(thr_turning_node, high)},
    {"a", THR_FIELD_COUNT, .offset = offsetof(thr_turning_node, a)},
    {"b", THR_FIELD_COUNT, .offset = offsetof(thr_turning_node, b), .low = -1},
    {"value", THR_FIELD_COUNT, .offset = offsetof(thr_turning_node, value)},
    {.key = "orbit", .optional = true},
    {0}};
static const thr_field leaf_fields[] = {
    {"multipliers", THR_FIELD_COUNT, .offset = offsetof(thr_turning_node, dual)}, {0}};

/* Writes a node of the tree: a branch with its two children, or a leaf with the number of its
 * multipliers. */
static void put_node(thr_writer *writer, const thr_turning_node *node)
{
  thr_write_object(writer, NULL);

  /* No child is node 0, the root, so that low = 0 marks a leaf. */
  if (node->low) {
    thr_fields_write(writer, branch_fields, node);
    if (node->n_orbit) thr_write_ints(writer, "orbit", node->orbit, node->n_orbit);
  } else {
    thr_fields_write(writer, leaf_fields, node);
  }
  thr_write_close(writer);
}

/* Writes for each symmetry the images of the half-edges 2e; without any symmetry, nothing is
 * written. */
static void put_symmetries(thr_writer *writer, const thr_turning_proof *proof,
                           const thr_frame *frame)
{
  if (proof->n_symmetries == 0) return;

  thr_write_line(writer, 3);
  thr_write_array(writer, "symmetries");

  /* The rows of the table follow one another. */
  for (int i = 0; i < proof->n_symmetries; i++) {
    thr_write_line(writer, 4);
    thr_write_ints(writer, NULL, proof->symmetry + (size_t)i * (size_t)frame->n_edges,
                   frame->n_edges);
  }
  thr_write_close(writer);
}

/* Writes at which places walks remember an edge that they have passed; without any memory, nothing
 * is written. */
static void put_memory(thr_writer *writer, const thr_walk_proof *walks)
{
  if (walks->n_memories == 0) return;

  thr_write_line(writer, 4);
  thr_write_array(writer, "memory");

  /* For each remembering edge the places after it. */
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

  /* What the prices are measured in, and what all cords together pay. */
  thr_write_int(writer, "unit", walks->unit);
  thr_write_int(writer, "units", walks->units);
  thr_write_int(writer, all ? all : "bits", all ? walks->all : walks->bits);

  /* Prices of passes over edges and of visits of nodes, each in a line of its own. */
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

  /* The tree, a node in each line. */
  thr_write_array(writer, "tree");
  for (int i = 0; i < proof->n_nodes; i++) {
    thr_write_line(writer, 4);
    put_node(writer, &proof->node[i]);
  }
  thr_write_close(writer);

  /* The multipliers of the leaves. */
  thr_write_line(writer, 3);
  thr_write_array(writer, "multipliers");
  for (int i = 0; i < proof->n_duals; i++) {
    thr_write_line(writer, 4);
    put_dual(writer, &proof->dual[i], frame, proof->n_ends);
  }
  thr_write_close(writer);

  /* What a proof may have besides. */
  put_symmetries(writer, proof, frame);
  thr_walk_proof_write(&proof->walks, frame, proof->walks.pulled ? NULL : "turning", writer);
  thr_write_close(writer);
}

/* ---- reading ---- */

/* What is being read: members of the proof, its framework, and the sizes that later lists are
 * checked against. */
typedef struct {
  thr_field_reader fields;
  const thr_frame *frame;
  int n_ends, n_symmetries;
  thr_err *err;
} proof_reader;

/* Returns a reader of a proof, whose members may not be left out. */
static proof_reader reader_of(const char *place, const thr_frame *frame, thr_err *err)
{
  proof_reader reader = {.fields = thr_field_reader_in(place, err), .frame = frame, .err = err};
  reader.fields.all_there = true;
  return reader;
}

/* Records THR_EVIOLATED for a member, and what is wrong with it. */
static thr_status bad(const proof_reader *reader, const char *key, const char *what)
{
  return thr_field_bad(&reader->fields, key, what);
}

/* Checks that an object has exactly the members named. known ends with NULL. */
static thr_status only_members(const proof_reader *reader, const thr_json *object,
                               const char *const *known)
{
  if (thr_json_typeof(object) != THR_JSON_OBJECT)
    return thr_fail(reader->err, THR_EVIOLATED, "%s: expected an object", reader->fields.name);

  /* All of them must be there. */
  for (int i = 0; known[i]; i++)
    if (!thr_json_get(object, known[i])) return bad(reader, known[i], "missing");

  return thr_field_only(&reader->fields, object, NULL, known);
}

/* Reads an integer from low to high. key names it in messages. */
static thr_status get_int(const proof_reader *reader, const thr_json *value, const char *key,
                          int64_t low, int64_t high, int64_t *out)
{
  return thr_field_int64_of(&reader->fields, value, key, low, high, out);
}

/* Reads a list of n integers into a new array, which the proof owns. */
static thr_status read_multipliers(const proof_reader *reader, const thr_json *object,
                                   const char *key, int n, int64_t **out)
{
  const thr_json *list;
  thr_status st = thr_field_need(&reader->fields, object, key, THR_JSON_ARRAY, &list);
  if (st) return st;

  if (thr_json_size(list) != n)
    return thr_fail(reader->err, THR_EVIOLATED, "%s.%s: expected %d numbers", reader->fields.name,
                    key, n);

  if (!(*out = thr_calloc((size_t)n, sizeof **out))) return thr_nomem(reader->err);

  /* Multipliers may have any sign here; the checker asks for the sign that each needs. */
  for (int i = 0; i < n && !st; i++)
    st = get_int(reader, thr_json_at(list, i), key, INT64_MIN, INT64_MAX, &(*out)[i]);

  return st;
}

/* Reads a list of integers from 0 to limit - 1 into out, which has room for all of them. */
static thr_status read_ints(const proof_reader *reader, const thr_json *list, const char *key,
                            int limit, int *out)
{
  thr_status st = THR_OK;
  for (int i = 0; i < thr_json_size(list) && !st; i++) {
    int64_t value = 0;
    st = get_int(reader, thr_json_at(list, i), key, 0, limit - 1, &value);
    out[i] = (int)value;
  }
  return st;
}

/* Reads an odd set or a group: its multiplier, and members below limit. */
static thr_status read_set(const proof_reader *reader, const thr_json *value, const char *key,
                           int limit, thr_turning_set *set)
{
  static const char *const known[] = {"value", "members", NULL};
  const thr_json *list;
  thr_status st = only_members(reader, value, known);
  if (!st) st = get_int(reader, thr_json_get(value, "value"), key, 0, INT64_MAX, &set->value);
  if (!st)
    set->member =
        thr_field_list(&reader->fields, value, "members", sizeof *set->member, &set->n, &list, &st);

  return st ? st : read_ints(reader, list, key, limit, set->member);
}

/* Reads a list of odd sets or groups. *count is set before the items, so that a failure releases
 * them. */
static thr_status read_sets(const proof_reader *reader, const thr_json *object, const char *key,
                            int limit, int *count, thr_turning_set **out)
{
  const thr_json *list;
  thr_status st;

  *out = thr_field_list(&reader->fields, object, key, sizeof **out, count, &list, &st);
  for (int i = 0; i < *count && !st; i++)
    st = read_set(reader, thr_json_at(list, i), key, limit, &(*out)[i]);

  return st;
}

/* Reads a partition: its multiplier and the block of every edge. */
static thr_status read_partition(const proof_reader *reader, const thr_json *value,
                                 thr_turning_partition *partition)
{
  static const char *const known[] = {"value", "blocks", NULL};
  const thr_json *list = NULL;
  int n_edges = reader->frame->n_edges;

  thr_status st = only_members(reader, value, known);
  if (!st)
    st = get_int(reader, thr_json_get(value, "value"), "value", 0, INT64_MAX, &partition->value);
  if (!st) st = thr_field_need(&reader->fields, value, "blocks", THR_JSON_ARRAY, &list);
  if (!st && thr_json_size(list) != n_edges) st = bad(reader, "blocks", "not one per edge");

  /* Blocks are numbered below the number of edges. */
  if (!st && !(partition->block = thr_calloc((size_t)n_edges, sizeof *partition->block)))
    st = thr_nomem(reader->err);

  return st ? st : read_ints(reader, list, "blocks", n_edges, partition->block);
}

/* Reads a list of partitions or ranks. */
static thr_status read_partitions(const proof_reader *reader, const thr_json *object,
                                  const char *key, int *count, thr_turning_partition **out)
{
  const thr_json *list;
  thr_status st;

  *out = thr_field_list(&reader->fields, object, key, sizeof **out, count, &list, &st);
  for (int i = 0; i < *count && !st; i++)
    st = read_partition(reader, thr_json_at(list, i), &(*out)[i]);

  return st;
}

/* Reads a junction: its multiplier, its node, and the block of every edge at the node. */
static thr_status read_junction(const proof_reader *reader, const thr_json *value,
                                thr_turning_junction *turning_junction)
{
  static const char *const known[] = {"value", "node", "blocks", NULL};
  const thr_json *list = NULL;
  int64_t node = 0;

  thr_status st = only_members(reader, value, known);
  if (!st)
    st = get_int(reader, thr_json_get(value, "value"), "value", 0, INT64_MAX,
                 &turning_junction->value);
  if (!st)
    st = get_int(reader, thr_json_get(value, "node"), "node", 0, reader->frame->n_nodes - 1, &node);
  if (!st) st = thr_field_need(&reader->fields, value, "blocks", THR_JSON_ARRAY, &list);
  if (st) return st;

  /* The list has one block for each half-edge that leaves the node. */
  turning_junction->node = (int)node;
  int degree = thr_degree(reader->frame, turning_junction->node);
  if (thr_json_size(list) != degree) return bad(reader, "blocks", "not one per edge of the node");
  if (!(turning_junction->block = thr_calloc((size_t)degree, sizeof *turning_junction->block)))
    return thr_nomem(reader->err);

  return read_ints(reader, list, "blocks", degree, turning_junction->block);
}

/* Reads the junctions, which only plans with tube joints have. */
static thr_status read_junctions(const proof_reader *reader, const thr_json *object,
                                 thr_turning_dual *dual)
{
  const thr_json *list;
  thr_status st;
  if (!thr_json_get(object, "junctions")) return THR_OK;

  /* Each junction has its own array. */
  dual->junction = thr_field_list(&reader->fields, object, "junctions", sizeof *dual->junction,
                                  &dual->n_junctions, &list, &st);
  for (int i = 0; i < dual->n_junctions && !st; i++)
    st = read_junction(reader, thr_json_at(list, i), &dual->junction[i]);

  return st;
}

/* Reads the multipliers of one leaf. */
static thr_status read_dual(const proof_reader *reader, const thr_json *value,
                            thr_turning_dual *dual)
{
  const int n_edges = reader->frame->n_edges;
  thr_status st = thr_fields_read(&reader->fields, value, NULL, dual_fields, dual);

  /* Multipliers of equations. */
  if (!st) st = read_multipliers(reader, value, "potentials", 2 * n_edges, &dual->potential);
  if (!st) st = read_multipliers(reader, value, "ends", reader->n_ends, &dual->ends);

  /* Multipliers of inequalities. Members of odd sets are half-edges, then equations of ends. */
  if (!st)
    st = read_sets(reader, value, "odd_sets", 2 * n_edges + reader->n_ends, &dual->n_odd,
                   &dual->odd);
  if (!st) st = read_sets(reader, value, "groups", n_edges, &dual->n_groups, &dual->group);
  if (!st) st = read_partitions(reader, value, "partitions", &dual->n_partitions, &dual->partition);
  if (!st && thr_json_get(value, "ranks"))
    st = read_partitions(reader, value, "ranks", &dual->n_ranks, &dual->rank);
  if (!st) st = read_junctions(reader, value, dual);

  return st;
}

/* Reads which symmetries keep the bounds at a branch, by their numbers. */
static thr_status read_orbit(const proof_reader *reader, const thr_json *value,
                             thr_turning_node *node)
{
  const thr_json *list;
  thr_status st;
  if (!thr_json_get(value, "orbit")) return THR_OK;

  node->orbit = thr_field_list(&reader->fields, value, "orbit", sizeof *node->orbit, &node->n_orbit,
                               &list, &st);
  return st ? st : read_ints(reader, list, "orbit", reader->n_symmetries, node->orbit);
}

/* Reads a node of the tree, a branch or a leaf. */
static thr_status read_node(const proof_reader *reader, const thr_json *value,
                            thr_turning_node *node)
{
  const bool is_leaf = thr_json_get(value, "multipliers") != NULL;
  *node = (thr_turning_node){.dual = -1};

  /* A leaf has its own member; a branch may have an orbit. */
  thr_status st =
      thr_fields_read(&reader->fields, value, NULL, is_leaf ? leaf_fields : branch_fields, node);

  /* Node 0 is the root, and so no child. */
  if (!st && !is_leaf && (node->low == 0 || node->high == 0))
    return bad(reader, "low", "a branch needs two nodes below it");

  return st || is_leaf ? st : read_orbit(reader, value, node);
}

/* Reads the symmetries: for each the half-edge that every half-edge 2e is mapped to. */
static thr_status read_symmetries(proof_reader *reader, const thr_json *value,
                                  thr_turning_proof *proof)
{
  const thr_json *list;
  const int n_edges = reader->frame->n_edges;
  if (!thr_json_get(value, "symmetries")) return THR_OK;

  thr_status st;
  proof->symmetry =
      thr_field_list(&reader->fields, value, "symmetries",
                     (size_t)n_edges * sizeof *proof->symmetry, &proof->n_symmetries, &list, &st);
  reader->n_symmetries = proof->n_symmetries;

  for (int i = 0; i < proof->n_symmetries && !st; i++) {
    /* One image for each edge, which is a half-edge. */
    const thr_json *image = thr_json_at(list, i);
    if (thr_json_typeof(image) != THR_JSON_ARRAY || thr_json_size(image) != n_edges)
      return bad(reader, "symmetries", "not one per edge");
    st = read_ints(reader, image, "symmetries", 2 * n_edges,
                   proof->symmetry + (size_t)i * (size_t)n_edges);
  }

  return st;
}

/* Reads at which places walks remember edges. */
static thr_status read_memory(const proof_reader *reader, const thr_json *value,
                              thr_walk_proof *walks)
{
  static const char *const known[] = {"edge", "places", NULL};
  const int most = 2 * reader->frame->n_edges > reader->frame->n_nodes ? 2 * reader->frame->n_edges
                                                                       : reader->frame->n_nodes;
  const thr_json *list, *places = NULL;
  thr_status st;
  if (!thr_json_get(value, "memory")) return THR_OK;

  /* Places are half-edges or nodes, by the kind of the proof: both ranges are allowed here. */
  walks->memory = thr_field_list(&reader->fields, value, "memory", sizeof *walks->memory,
                                 &walks->n_memories, &list, &st);
  for (int i = 0; i < walks->n_memories && !st; i++) {
    thr_walk_memory *memory = &walks->memory[i];
    const thr_json *entry = thr_json_at(list, i);
    int64_t edge = 0;

    st = only_members(reader, entry, known);
    if (!st)
      st = get_int(reader, thr_json_get(entry, "edge"), "edge", 0, reader->frame->n_edges - 1,
                   &edge);
    if (!st)
      memory->place = thr_field_list(&reader->fields, entry, "places", sizeof *memory->place,
                                     &memory->n, &places, &st);
    if (!st) st = read_ints(reader, places, "places", most, memory->place);
    memory->edge = (int)edge;
  }

  return st;
}

thr_status thr_walk_proof_from_json(thr_walk_proof *walks, const thr_frame *frame, const char *all,
                                    const thr_json *value, const char *place, thr_err *err)
{
  const bool remembers = value && thr_json_get(value, "memory");
  const char *known[] = {
      "unit", "units", all ? all : "bits", "edges", "nodes", remembers ? "memory" : NULL, NULL};
  const proof_reader reader = reader_of(place, frame, err);
  int64_t units = 0, bits = 0;

  /* A plan may have no such proof. */
  *walks = (thr_walk_proof){.pulled = value && !all};
  if (!value) return THR_OK;

  /* The unit, and the price of all cords together or the bits of a pull. */
  thr_status st = only_members(&reader, value, known);
  if (!st) st = get_int(&reader, thr_json_get(value, "unit"), "unit", 1, INT64_MAX, &walks->unit);
  if (!st) st = get_int(&reader, thr_json_get(value, "units"), "units", 0, INT_MAX - 2, &units);
  if (!st && all) st = get_int(&reader, thr_json_get(value, all), all, 0, INT64_MAX, &walks->all);
  if (!st && !all)
    st = get_int(&reader, thr_json_get(value, "bits"), "bits", 0, THR_TURNING_BITS, &bits);

  /* The prices. */
  if (!st) st = read_multipliers(&reader, value, "edges", frame->n_edges, &walks->edge);
  if (!st) st = read_multipliers(&reader, value, "nodes", frame->n_nodes, &walks->node);
  if (!st) st = read_memory(&reader, value, walks);

  walks->units = (int)units;
  walks->bits = (int)bits;
  if (st) thr_walk_proof_destroy(walks);

  return st;
}

thr_status thr_turning_proof_from_json(thr_turning_proof *proof, const thr_frame *frame,
                                       const thr_json *value, const char *place, thr_err *err)
{
  static const thr_field known[] = {{.key = "tree"},
                                    {.key = "multipliers"},
                                    {.key = "symmetries", .optional = true},
                                    {.key = "walks", .optional = true},
                                    {0}};
  proof_reader reader = reader_of(place, frame, err);
  const thr_json *tree, *duals, *walks = thr_json_get(value, "walks");
  const char *all = walks && thr_json_get(walks, "bits") ? NULL : "turning";
  *proof = (thr_turning_proof){0};

  thr_status st = thr_fields_read(&reader.fields, value, NULL, known, proof);
  if (!st)
    proof->node = thr_field_list(&reader.fields, value, "tree", sizeof *proof->node,
                                 &proof->n_nodes, &tree, &st);
  if (!st)
    proof->dual = thr_field_list(&reader.fields, value, "multipliers", sizeof *proof->dual,
                                 &proof->n_duals, &duals, &st);

  /* The first leaf says how many equations of ends there are. Symmetries come before the tree,
   * whose orbits name them. */
  if (!st) {
    proof->n_ends = reader.n_ends = thr_json_size(thr_json_get(thr_json_at(duals, 0), "ends"));
    st = read_symmetries(&reader, value, proof);
  }

  /* The tree, then the multipliers of its leaves. */
  for (int i = 0; i < proof->n_nodes && !st; i++)
    st = read_node(&reader, thr_json_at(tree, i), &proof->node[i]);
  for (int i = 0; i < proof->n_duals && !st; i++)
    st = read_dual(&reader, thr_json_at(duals, i), &proof->dual[i]);

  if (!st) st = thr_walk_proof_from_json(&proof->walks, frame, all, walks, place, err);

  /* On failure nothing is left to the caller. */
  if (st) thr_turning_proof_destroy(proof);

  return st;
}
