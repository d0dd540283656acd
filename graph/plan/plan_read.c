/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads plan.json into a thr_plan: framework, options, cords, symmetry, metrics and evaluation.
 * docs/plan-format.md is the schema; proofs are read in plan_read_proof.c, options in
 * request_fields.c.
 *
 * A plan is input from anywhere, so that every index, size and type is checked before use. Errors
 * say "file: place: what". Up to the options an error is THR_EINPUT (the document is no plan); from
 * the cords on an error is THR_EVIOLATED (the plan claims what its framework contradicts). Members
 * that this version does not know are refused where they could be claims.
 *
 * Example: a cord whose pass 3 runs over edge 7, which does not join the nodes listed, gives
 * plan.json: cord A, pass 3: edge 7 joins nodes 2 and 5, but the cord goes from 2 to 4. */
#include "graph/io/read.h"
#include "graph/plan/plan_fields.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads nodes with names and feet into a draft of the framework. */
static thr_status read_nodes(const thr_field_reader *field_reader, const thr_json *object,
                             thr_draft *draft)
{
  const thr_json *nodes, *names = thr_json_get(object, "names");
  thr_status st = thr_field_need(field_reader, object, "nodes", THR_JSON_ARRAY, &nodes);
  if (st) return st;

  int n = thr_json_size(nodes);
  if (n == 0) return thr_field_bad(field_reader, "framework.nodes", "empty");
  if (names && (thr_json_typeof(names) != THR_JSON_ARRAY || thr_json_size(names) != n))
    return thr_field_bad(field_reader, "framework.names", "not one name per node");

  /* Coordinates, and a name unless nodes are named by their numbers. */
  for (int v = 0; v < n; v++) {
    const thr_json *point = thr_json_at(nodes, v);
    double xyz[3];
    thr_err why = {0};

    if (thr_json_size(point) != 3 || !thr_json_numbers(point, 3, xyz))
      return thr_fail(field_reader->err, THR_EINPUT,
                      "%s: framework.nodes[%d]: not three finite numbers", field_reader->name, v);

    const char *name = thr_json_string(thr_json_at(names, v));
    if (names && !name)
      return thr_fail(field_reader->err, THR_EINPUT, "%s: framework.names[%d]: not text",
                      field_reader->name, v);

    /* The draft refuses coordinates of 1e100 or more. */
    if ((st = thr_draft_add_node(draft, xyz, name, false, &why)))
      return thr_fail(field_reader->err, st, "%s: framework: %s", field_reader->name, why.text);
  }

  assert(draft->node);

  /* Feet are a list of nodes, and may be left out. */
  const thr_json *feet = thr_json_get(object, "feet");
  if (feet && thr_json_typeof(feet) != THR_JSON_ARRAY)
    return thr_field_bad(field_reader, "framework.feet", "not a list");
  for (int i = 0, v = 0; i < thr_json_size(feet); i++) {
    if ((st = thr_field_index(field_reader, feet, i, n, "framework.feet", &v))) return st;
    draft->node[v].foot = true;
  }

  return THR_OK;
}

/* Finds a list of the framework with one entry per edge; *list is NULL if there is none. */
static thr_status edge_list(const thr_field_reader *field_reader, const thr_json *object,
                            const char *key, int n, const thr_json **list)
{
  *list = thr_json_get(object, key);
  if (!*list || (thr_json_typeof(*list) == THR_JSON_ARRAY && thr_json_size(*list) == n))
    return THR_OK;
  return thr_fail(field_reader->err, field_reader->code, "%s: framework.%s: not one per edge",
                  field_reader->name, key);
}

/* Reads the two nodes of edge e. The place is only put into words after a failure, since this is
 * done for every edge of a large framework. */
static thr_status read_ends(const thr_field_reader *field_reader, const thr_json *pair, int e,
                            int n_nodes, int end[2])
{
  char place[48];
  if (thr_json_indices(pair, 2, n_nodes, end)) return THR_OK;
  snprintf(place, sizeof place, "framework.edges[%d]", e);
  return thr_field_indices(field_reader, pair, 2, n_nodes, place, end);
}

/* Reads edges into the draft, with their own lengths, covers and capacities if the framework states
 * them. */
static thr_status read_edges(const thr_field_reader *field_reader, const thr_json *object,
                             thr_draft *draft)
{
  const thr_json *edges, *lengths = NULL, *covers = NULL, *capacities = NULL;
  thr_status st = thr_field_need(field_reader, object, "edges", THR_JSON_ARRAY, &edges);
  if (!st) st = edge_list(field_reader, object, "lengths", thr_json_size(edges), &lengths);
  if (!st) st = edge_list(field_reader, object, "covers", thr_json_size(edges), &covers);
  if (!st) st = edge_list(field_reader, object, "capacities", thr_json_size(edges), &capacities);
  if (st) return st;

  /* The lists run in parallel. */
  for (int e = 0; e < thr_json_size(edges); e++) {
    int end[2] = {0, 0};
    double length = 0;
    thr_err why = {0};
    if ((st = read_ends(field_reader, thr_json_at(edges, e), e, draft->n_nodes, end))) return st;

    if (lengths && (!thr_json_number(thr_json_at(lengths, e), &length) || !(length > 0)))
      return thr_fail(field_reader->err, THR_EINPUT,
                      "%s: framework.lengths[%d]: not a positive number", field_reader->name, e);

    st = thr_draft_add_edge(draft, end[0], end[1], length, &why);

    /* A null in covers or capacities says nothing of the edge. */
    if (!st && (covers || capacities))
      st = thr_json_edge_passes(draft, thr_json_at(covers, e), thr_json_at(capacities, e), &why);
    if (st)
      return thr_fail(field_reader->err, st, "%s: framework: %s", field_reader->name, why.text);
  }

  return THR_OK;
}

/* Reads what one unit of the coordinates is called. */
static thr_status read_units(const thr_field_reader *field_reader, const thr_json *value,
                             thr_draft *draft)
{
  thr_err why = {0};
  if (!value) return THR_OK;

  if (!thr_json_string(value)) return thr_field_bad(field_reader, "framework.units", "not text");
  return thr_draft_set_units(draft, thr_json_string(value), &why)
             ? thr_field_bad(field_reader, "framework.units", why.text)
             : THR_OK;
}

/* Compares the hash that the plan states with that of the framework. An edited framework makes all
 * claims void. */
static thr_status read_hash(const thr_field_reader *field_reader, const thr_json *object,
                            const thr_frame *frame)
{
  char hash[20];
  const char *stated = thr_json_string(thr_json_get(object, "hash"));

  snprintf(hash, sizeof hash, "%016" PRIx64, thr_frame_hash(frame));
  if (stated && strcmp(stated, hash) == 0) return THR_OK;

  return thr_fail(
      field_reader->err, THR_EVIOLATED,
      "%s: framework.hash: the framework is not the one that was planned (its hash is %s)",
      field_reader->name, hash);
}

/* Builds the framework of a draft. If known is given, the draft must say the same as known, which
 * is moved to *frame instead. */
static thr_status take_frame(const thr_field_reader *field_reader, const thr_draft *draft,
                             thr_frame *known, thr_frame *frame)
{
  thr_read_report report = {0};
  thr_err why = {0};
  if (known && !thr_draft_says(draft, known))
    return thr_field_bad(field_reader, "framework", "is not the one that was written");

  /* Moving spares building a large framework twice. */
  if (known) {
    *frame = *known;
    *known = (thr_frame){0};
    return THR_OK;
  }

  /* Building must neither merge nor drop anything: the cords' indices would name other edges. */
  thr_status st = thr_draft_build(draft, 0, frame, &report, &why);
  if (st) return thr_fail(field_reader->err, st, "%s: framework: %s", field_reader->name, why.text);

  return frame->n_nodes == draft->n_nodes && frame->n_edges == draft->n_edges
             ? THR_OK
             : thr_field_bad(field_reader, "framework",
                             "has coincident nodes, isolated nodes, or an edge twice");
}

/* Reads the framework, and checks its hash. */
static thr_status read_frame(const thr_field_reader *field_reader, const thr_json *doc,
                             thr_frame *known, thr_frame *frame)
{
  const thr_json *object;
  thr_draft draft = {0};
  thr_status st = thr_field_need(field_reader, doc, "framework", THR_JSON_OBJECT, &object);
  if (st) return st;

  /* All parts go into one draft. */
  if ((st = read_nodes(field_reader, object, &draft))) goto done;
  if ((st = read_edges(field_reader, object, &draft))) goto done;
  if ((st = read_units(field_reader, thr_json_get(object, "units"), &draft))) goto done;

  if (!(st = take_frame(field_reader, &draft, known, frame)))
    st = read_hash(field_reader, object, frame);
done:
  if (st) thr_frame_destroy(frame);
  thr_draft_destroy(&draft);

  return st;
}

/* Turns *half, which holds the edge of pass k of a cord, into the half-edge from node a to node b.
 * A hand-edited plan fails here first, and so the text says all that is known. */
static thr_status half_edge(const thr_field_reader *field_reader, const thr_frame *frame,
                            const char *id, int k, int a, int b, int *half)
{
  const int e = *half;

  /* The edge may be passed either way. */
  for (int side = 0; side < 2; side++)
    if (frame->edge[e][side] == a && frame->edge[e][1 - side] == b) {
      *half = 2 * e + side;
      return THR_OK;
    }

  return thr_fail(
      field_reader->err, field_reader->code,
      "%s: cord %s, pass %d: edge %d joins nodes %d and %d, but the cord goes from %d to %d",
      field_reader->name, id, k + 1, e, frame->edge[e][0], frame->edge[e][1], a, b);
}

/* Reads the n passes of cord i from its lists of edges and of nodes; the latter has n + 1. */
static thr_status read_passes(const thr_field_reader *field_reader, const thr_json *nodes,
                              const thr_json *edges, int n, const thr_frame *frame, int i,
                              thr_cord *cord)
{
  char place[40];
  int *node = thr_calloc((size_t)n + 1, sizeof *node);
  thr_status st = node ? THR_OK : thr_nomem(field_reader->err);

  /* Edges first, then the nodes that say which way each is passed. */
  snprintf(place, sizeof place, "cords[%d].edges", i);
  if (!st) st = thr_field_indices(field_reader, edges, n, frame->n_edges, place, cord->half);
  snprintf(place, sizeof place, "cords[%d].nodes", i);
  if (!st) st = thr_field_indices(field_reader, nodes, n + 1, frame->n_nodes, place, node);

  /* The two lists have to agree. */
  for (int k = 0; k < n && !st; k++)
    st = half_edge(field_reader, frame, cord->id, k, node[k], node[k + 1], &cord->half[k]);
  free(node);

  return st;
}

/* Reads cord i. */
static thr_status read_cord(const thr_field_reader *field_reader, const thr_json *value,
                            const thr_frame *frame, int i, thr_cord *cord)
{
  const thr_json *nodes, *edges, *id, *closed;
  thr_status st = thr_field_need(field_reader, value, "id", THR_JSON_STRING, &id);
  if (st) return st;

  /* The id is printed often, and so kept short and clean. */
  if (strlen(thr_json_string(id)) >= sizeof cord->id)
    return thr_field_bad(field_reader, "cords: id", "longer than 11 letters");
  snprintf(cord->id, sizeof cord->id, "%s", thr_json_string(id));
  thr_text_clean(cord->id);

  /* Component, ends, and the two lists. */
  if ((st = thr_field_int(field_reader, value, "component", 0, frame->n_nodes - 1,
                          &cord->component)))
    return st;
  if ((st = thr_field_need(field_reader, value, "closed", THR_JSON_BOOL, &closed))) return st;
  if ((st = thr_field_need(field_reader, value, "nodes", THR_JSON_ARRAY, &nodes))) return st;
  if ((st = thr_field_need(field_reader, value, "edges", THR_JSON_ARRAY, &edges))) return st;

  cord->closed = thr_json_true(closed);

  /* A cord of n passes visits n + 1 nodes. */
  int n = thr_json_size(edges);
  char place[40];
  if (n < 1 || thr_json_size(nodes) != n + 1) {
    snprintf(place, sizeof place, "cords[%d]", i);
    return thr_field_bad(field_reader, place,
                         "needs at least one edge, and one node more than edges");
  }

  if (!(cord->half = thr_calloc((size_t)n, sizeof *cord->half)))
    return thr_nomem(field_reader->err);
  cord->n_passes = n;

  return read_passes(field_reader, nodes, edges, n, frame, i, cord);
}

/* Reads all cords. */
static thr_status read_cords(const thr_field_reader *field_reader, const thr_json *doc,
                             thr_plan *plan)
{
  const thr_json *list;
  thr_status st = thr_field_need(field_reader, doc, "cords", THR_JSON_ARRAY, &list);
  if (st) return st;

  int n = thr_json_size(list);
  if (n < 1) return thr_field_bad(field_reader, "cords", "empty; a plan has at least one cord");
  if (!(plan->cord = thr_calloc((size_t)n, sizeof *plan->cord)))
    return thr_nomem(field_reader->err);

  /* The count is set before the cords, so that a failure releases those read so far. */
  plan->n_cords = n;
  for (int i = 0; i < n; i++)
    if ((st = read_cord(field_reader, thr_json_at(list, i), &plan->frame, i, &plan->cord[i])))
      return st;

  return THR_OK;
}

/* Reads a list of images of all nodes into a new array [*count * n_nodes], which the record
 * owns. */
static thr_status read_images(const thr_field_reader *field_reader, const thr_json *object,
                              const char *key, int n_nodes, int **image, int *count)
{
  const thr_json *list;
  char place[48];
  thr_status st = thr_field_need(field_reader, object, key, THR_JSON_ARRAY, &list);
  if (st) return st;

  int n = thr_json_size(list);
  snprintf(place, sizeof place, "symmetry.%s", key);

  /* Sizes are checked before anything is allocated. */
  for (int i = 0; i < n; i++)
    if (thr_json_size(thr_json_at(list, i)) != n_nodes)
      return thr_fail(field_reader->err, field_reader->code, "%s: %s[%d]: not one image per node",
                      field_reader->name, place, i);

  if (!(*image = thr_calloc((size_t)n * (size_t)n_nodes, sizeof **image)))
    return thr_nomem(field_reader->err);
  *count = n;

  /* Row i of the array is image i. */
  for (int i = 0; i < n; i++) {
    snprintf(place, sizeof place, "symmetry.%s[%d]", key, i);
    st = thr_field_indices(field_reader, thr_json_at(list, i), n_nodes, n_nodes, place,
                           *image + (size_t)i * (size_t)n_nodes);
    if (st) return st;
  }

  return THR_OK;
}

/* Reads which cord each cord is a copy of, and the image that makes it so. */
static thr_status read_copies(const thr_field_reader *field_reader, const thr_json *object,
                              const thr_plan *plan, thr_symmetry_record *record)
{
  static const char *const known[] = {"of", "image", NULL};
  const thr_json *list;
  thr_status st = thr_field_need(field_reader, object, "cords", THR_JSON_ARRAY, &list);
  if (st) return st;

  if (thr_json_size(list) != plan->n_cords)
    return thr_field_bad(field_reader, "symmetry.cords", "not one per cord of the plan");

  record->unique = thr_calloc((size_t)plan->n_cords, sizeof *record->unique);
  record->element = thr_calloc((size_t)plan->n_cords, sizeof *record->element);
  if (!record->unique || !record->element) return thr_nomem(field_reader->err);

  /* Whether each copy is one is for the checker to say. */
  for (int i = 0; i < plan->n_cords && !st; i++) {
    const thr_json *value = thr_json_at(list, i);
    st = thr_field_only(field_reader, value, "symmetry.cords", known);
    if (!st)
      st = thr_field_int(field_reader, value, "of", 0, plan->n_cords - 1, &record->unique[i]);
    if (!st)
      st =
          thr_field_int(field_reader, value, "image", 0, record->n_images - 1, &record->element[i]);
  }

  return st;
}

/* Reads how the cords of a symmetric plan are copies of each other. Other plans must not have this
 * member. */
static thr_status read_symmetry(const thr_field_reader *field_reader, const thr_json *doc,
                                const thr_plan *plan, thr_symmetry_record *record)
{
  static const char *const known[] = {"order", "name",     "generators",   "images", "cords",
                                      "steps", "retraced", "unique_paths", NULL};
  const thr_json *value = thr_json_get(doc, "symmetry"), *name;

  if (!thr_wants_symmetry(&plan->options))
    return value ? thr_field_bad(field_reader, "symmetry", "only plans with this objective have it")
                 : THR_OK;

  /* The group: its order and its name. */
  thr_status st = thr_field_need(field_reader, doc, "symmetry", THR_JSON_OBJECT, &value);
  if (!st) st = thr_field_only(field_reader, value, "symmetry", known);
  if (!st) st = thr_field_int(field_reader, value, "order", 1, 1024, &record->order);
  if (!st) st = thr_field_need(field_reader, value, "name", THR_JSON_STRING, &name);
  if (st) return st;

  if (strlen(thr_json_string(name)) >= sizeof record->name)
    return thr_field_bad(field_reader, "symmetry.name", "longer than 15 bytes");
  snprintf(record->name, sizeof record->name, "%s", thr_json_string(name));
  thr_text_clean(record->name);

  /* Images of the nodes: generators of the group, and the elements that make copies. */
  record->present = true;
  st = read_images(field_reader, value, "generators", plan->frame.n_nodes, &record->generator,
                   &record->n_generators);
  if (!st)
    st = read_images(field_reader, value, "images", plan->frame.n_nodes, &record->image,
                     &record->n_images);

  /* Copies and what is to be learned. `retraced` is missing in older plans. */
  if (!st) st = read_copies(field_reader, value, plan, record);
  if (!st) st = thr_field_double(field_reader, value, "steps", &record->steps);
  const thr_json *retraced = thr_json_get(value, "retraced");
  if (!st && retraced && thr_json_typeof(retraced) != THR_JSON_BOOL)
    return thr_field_bad(field_reader, "symmetry.retraced", "not true or false");
  record->retraced = retraced && thr_json_true(retraced);
  if (!st)
    st =
        thr_field_int(field_reader, value, "unique_paths", 1, plan->n_cords, &record->unique_paths);

  return st;
}

/* Reads the evaluation, if there is one, and checks that it has one record per cord and one tension
 * per pass, so that later code needs no further check. */
static thr_status read_evaluation(const thr_field_reader *field_reader, const thr_json *doc,
                                  thr_plan *plan)
{
  char place[256];
  const thr_json *value = thr_json_get(doc, "evaluation");
  if (!value) return THR_OK;

  snprintf(place, sizeof place, "%.200s: evaluation", field_reader->name);
  thr_evaluation *evaluation = &plan->evaluation;
  thr_status st = thr_evaluation_from_json(evaluation, value, place, field_reader->err);
  if (st) return st;

  if (evaluation->n_cords != plan->n_cords)
    return thr_field_bad(field_reader, "evaluation.cords", "not one per cord of the plan");

  /* A cord that is not known has no tensions. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    if (evaluation->cord[i].known && evaluation->cord[i].n_passes != plan->cord[i].n_passes)
      return thr_fail(field_reader->err, field_reader->code,
                      "%s: evaluation.cords[%d].tension: not one per pass of the cord (%d)",
                      field_reader->name, i, plan->cord[i].n_passes);
    evaluation->cord[i].n_passes = plan->cord[i].n_passes;
  }

  return THR_OK;
}

/* Reads all parts of a plan in the order in which they refer to each other. known: as in
 * take_frame. */
static thr_status read_document(thr_field_reader *field_reader, const thr_json *doc,
                                thr_frame *known, thr_plan *plan)
{
  const char *format = thr_json_string(thr_json_get(doc, "format"));
  int version;

  /* Refuse other documents, and plans of the future. */
  if (!format || strcmp(format, "thread-plan") != 0)
    return thr_field_bad(field_reader, "format", "not a thread plan; make one with `thread plan`");
  thr_status st = thr_field_int(field_reader, doc, "version", 1, INT32_MAX, &version);
  if (st) return st;
  if (version > 2)
    return thr_field_bad(field_reader, "version",
                         "written by a newer version of thread; this one reads versions 1 and 2");

  /* Who wrote the plan is printed, and so cleaned. */
  const char *generator = thr_json_string(thr_json_get(doc, "generator"));
  if (!generator && thr_json_get(doc, "generator"))
    return thr_field_bad(field_reader, "generator", "not text");
  if (!(plan->generator = thr_strdup(generator ? generator : "")))
    return thr_nomem(field_reader->err);
  thr_text_clean(plan->generator);

  /* The input: framework and options. Version 1 defines the limit on the pull otherwise. */
  if ((st = read_frame(field_reader, doc, known, &plan->frame))) return st;
  if ((st = thr_plan_read_options(field_reader, doc, &plan->frame, &plan->options))) return st;
  plan->options.old_pull = version == 1;

  /* The claims: what is wrong from here on contradicts the framework. */
  field_reader->code = THR_EVIOLATED;
  if ((st = read_cords(field_reader, doc, plan))) return st;
  if ((st = read_symmetry(field_reader, doc, plan, &plan->symmetry))) return st;

  /* The sums over the cords, which the checker computes again. */
  const thr_json *metrics;
  st = thr_field_need(field_reader, doc, "metrics", THR_JSON_OBJECT, &metrics);
  if (!st) st = thr_fields_read(field_reader, metrics, "metrics", thr_metrics_fields, plan);
  if (st) return st;
  if ((st = read_evaluation(field_reader, doc, plan))) return st;

  return thr_plan_read_proofs(field_reader, doc, plan);
}

/* Reads a plan from a parsed document, which is destroyed. known: the framework that the plan must
 * have, which is moved into the plan; NULL: any. without: claims that are passed over. On failure
 * the plan is empty. */
static thr_status take_document(thr_json *doc, const char *name, thr_frame *known, int without,
                                thr_plan *plan, thr_err *err)
{
  thr_field_reader reader = {.name = name, .code = THR_EINPUT, .err = err, .without = without};
  thr_status st = read_document(&reader, doc, known, plan);
  thr_json_destroy(doc);
  if (st) thr_plan_destroy(plan);
  return st;
}

thr_status thr_plan_parse_without(thr_plan *plan, const char *text, size_t n, const char *name,
                                  int claims, thr_err *err)
{
  thr_json *doc;
  *plan = (thr_plan){0};
  thr_status st = thr_json_parse(&doc, text, n, name, err);
  return st ? st : take_document(doc, name, NULL, claims, plan, err);
}

thr_status thr_plan_parse(thr_plan *plan, const char *text, size_t n, const char *name,
                          thr_err *err)
{
  return thr_plan_parse_without(plan, text, n, name, 0, err);
}

thr_status thr_plan_parse_back(thr_plan *plan, const char *text, size_t n, const char *name,
                               thr_err *err)
{
  thr_json *doc;

  /* The framework survives the plan. */
  thr_frame known = plan->frame;
  plan->frame = (thr_frame){0};
  thr_plan_destroy(plan); /* first: a large document takes much memory */

  thr_status st = thr_json_parse(&doc, text, n, name, err);
  if (!st) st = take_document(doc, name, &known, 0, plan, err);
  thr_frame_destroy(&known);

  return st;
}

thr_status thr_plan_read(thr_plan *plan, const char *path, thr_err *err)
{
  const char *name = strcmp(path, "-") == 0 ? "stdin" : path;
  thr_text text = {0};
  thr_json *doc = NULL;
  *plan = (thr_plan){0};

  /* The text is released before the plan grows: both may be large. */
  thr_status st = thr_text_read(&text, path, err);
  if (!st) st = thr_json_parse(&doc, text.data, text.length, name, err);
  thr_text_destroy(&text);

  return st ? st : take_document(doc, name, NULL, 0, plan, err);
}
