/* plan.json, read: what was asked for. */
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_fields.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <string.h>

static thr_status read_turning_options(const thr_field_reader *field_reader, const thr_json *object, thr_request *out)
{
  thr_turning_options *options = &out->turning;
  static const char *const known[] = {"cost", "length_slack", "minimize", "tour", "pairings", "nodes", NULL};
  const thr_json *value;
  int cost, aim, tour, pairings;
  thr_status st = thr_field_need(field_reader, object, "turning", THR_JSON_OBJECT, &value);
  if (!st) st = thr_field_only(field_reader, value, "options.turning", known);
  if (!st) st = thr_field_name(field_reader, value, "options.turning", "cost", THR_N_TURN_COSTS, thr_turn_cost_name, &cost);
  if (!st) st = thr_field_or_null(field_reader, value, "length_slack", &options->length_slack);
  if (!st) st = thr_field_name(field_reader, value, "options.turning", "minimize", THR_N_MINIMIZE, thr_minimize_name, &aim);
  if (!st) st = thr_field_name(field_reader, value, "options.turning", "tour", THR_N_TOURS, thr_tour_name, &tour);
  if (!st) st = thr_field_name(field_reader, value, "options.turning", "pairings", 2, thr_pairings_name, &pairings);
  if (!st && thr_json_get(value, "nodes")) st = thr_field_int(field_reader, value, "nodes", 1, INT32_MAX, &options->nodes);
  if (st) return st;
  options->cost = (thr_turn_cost)cost;
  out->aims = (thr_aims){1, {thr_minimize_aim(aim)}};
  if (thr_wants_pull(out) && options->cost != THR_TURN_ANGLE)
    return thr_field_bad(field_reader, "options.turning.cost", "a pull is of angles");
  options->tour = (thr_tour)tour;
  options->ignore_pairings = pairings == 1;
  return THR_OK;
}

/* Every aim once. */
static thr_status read_prefer(const thr_field_reader *field_reader, const thr_json *object, thr_aim prefer[])
{
  bool named[THR_N_AIMS] = {false};
  const thr_json *list;
  thr_status st = thr_field_need(field_reader, object, "prefer", THR_JSON_ARRAY, &list);
  if (!st && thr_json_size(list) != THR_N_AIMS) return thr_field_bad(field_reader, "options.symmetry.prefer", "not four aims");
  for (int i = 0, aim = 0; i < THR_N_AIMS && !st; i++) {
    st = thr_field_name_of(field_reader, thr_json_at(list, i), "options.symmetry", "prefer", THR_N_AIMS, thr_aim_name, &aim);
    if (!st && named[aim]) return thr_field_bad(field_reader, "options.symmetry.prefer", "names one aim twice");
    named[aim] = true;
    prefer[i] = (thr_aim)aim;
  }
  return st;
}

static thr_status read_symmetry_options(const thr_field_reader *field_reader, const thr_json *object, thr_request *out)
{
  thr_symmetry_options *options = &out->symmetry;
  static const char *const known[] = {"group", "geometric", "counted", "prefer", NULL};
  const thr_json *value, *group;
  thr_status st = thr_field_need(field_reader, object, "symmetry", THR_JSON_OBJECT, &value);
  if (!st) st = thr_field_only(field_reader, value, "options.symmetry", known);
  if (st) return st;
  group = thr_json_get(value, "group");
  const char *name = thr_json_string(group);
  if (!group || (!name && thr_json_typeof(group) != THR_JSON_NULL) || (name && (!*name || strlen(name) >= sizeof options->group)))
    return thr_field_bad(field_reader, "options.symmetry.group", "neither null nor a text of 1 to 15 bytes");
  snprintf(options->group, sizeof options->group, "%s", name ? name : "");
  thr_text_clean(options->group);
  if ((st = thr_field_or_null(field_reader, value, "geometric", &options->geometric))) return st;
  const thr_json *counted = thr_json_get(value, "counted");
  if (counted && thr_json_typeof(counted) != THR_JSON_BOOL)
    return thr_field_bad(field_reader, "options.symmetry.counted", "not true or false");
  options->counted = counted && thr_json_true(counted);
  out->aims.n = THR_N_AIMS;
  return read_prefer(field_reader, value, out->aims.aim);
}

/* Which options there are depends on the objective. */
static thr_status read_objective(const thr_field_reader *field_reader, const thr_json *value, thr_request *options)
{
  static const char *const own[THR_N_OBJECTIVES] = {"confirm", "turning", "symmetry"};
  const char *known[] = {"objective", "joint",   "cover", "capacity",  "distinct",   "cords",      "max_length",
                         "max_pull",  "balance", "ends",  "end_nodes", "end_counts", "time_limit", "physics",
                         "engine",    "needles", "order", "crossings", "gap",        NULL,         NULL};
  int objective, joint;
  thr_status st = thr_field_name(field_reader, value, "options", "objective", THR_N_OBJECTIVES, thr_objective_name, &objective);
  if (st) return st;
  known[sizeof known / sizeof *known - 2] = own[objective];
  if ((st = thr_field_only(field_reader, value, "options", known))) return st;
  if ((st = thr_field_name(field_reader, value, "options", "joint", 2, thr_joint_name, &joint))) return st;
  options->joint = (thr_joint)joint;
  if (objective == THR_TORTUOSITY) return read_turning_options(field_reader, value, options);
  return objective == THR_SYMMETRY ? read_symmetry_options(field_reader, value, options) : THR_OK;
}

/* A number: exactly so many; or least and most. */
static thr_status read_cord_range(const thr_field_reader *field_reader, const thr_json *object, thr_request *out)
{
  static const char *const known[] = {"least", "most", NULL};
  const thr_json *value = thr_json_get(object, "cords");
  if (!value || thr_json_typeof(value) != THR_JSON_OBJECT) {
    thr_status st = thr_field_int(field_reader, object, "cords", 1, THR_MOST_CORDS, &out->cords);
    out->cords_least = out->cords;
    return st;
  }
  thr_status st = thr_field_only(field_reader, value, "options.cords", known);
  if (!st) st = thr_field_int(field_reader, value, "most", 1, THR_MOST_CORDS, &out->cords);
  if (!st) st = thr_field_int(field_reader, value, "least", 1, out->cords, &out->cords_least);
  return st;
}

static void put_first(thr_aims *a, thr_aim aim)
{
  memmove(&a->aim[1], &a->aim[0], (size_t)a->n++ * sizeof *a->aim);
  a->aim[0] = aim;
}

/* What is not there is not asked for. */
static thr_status read_limits(const thr_field_reader *field_reader, const thr_json *value, thr_request *options)
{
  const thr_json *balance = thr_json_get(value, "balance");
  thr_status st = read_cord_range(field_reader, value, options);
  if (!st) st = thr_field_int(field_reader, value, "cover", 1, 100, &options->cover);
  if (!st && thr_json_get(value, "capacity"))
    st = thr_field_int(field_reader, value, "capacity", 1, INT32_MAX, &options->capacity);
  if (!st && thr_json_get(value, "distinct"))
    st = thr_field_int(field_reader, value, "distinct", 2, options->cover, &options->distinct);
  if (!st && thr_json_get(value, "max_length")) {
    st = thr_field_amount(field_reader, value, "max_length", &options->max_length);
    if (!st && options->max_length == 0) st = thr_field_bad(field_reader, "options.max_length", "not above 0");
  }
  if (!st && thr_json_get(value, "max_pull")) {
    st = thr_field_amount(field_reader, value, "max_pull", &options->max_pull);
    if (!st && options->max_pull < 1) st = thr_field_bad(field_reader, "options.max_pull", "below 1");
  }
  if (!st && balance && thr_json_typeof(balance) != THR_JSON_BOOL)
    st = thr_field_bad(field_reader, "options.balance", "not true or false");
  if (!st && balance && thr_json_true(balance)) put_first(&options->aims, THR_AIM_LONGEST);
  return st;
}

/* How it was found. What is not there was left to the program. */
static thr_status read_means(const thr_field_reader *field_reader, const thr_json *value, thr_request *options)
{
  int engine = THR_ENGINE_AUTO, confirm = THR_CONFIRM_AUTO, order = THR_ORDER_PLANNED, crossings = THR_CROSSINGS_ALLOW;
  thr_status st = thr_field_double(field_reader, value, "time_limit", &options->time_limit);
  options->gap = -1;
  if (!st && thr_json_get(value, "gap")) st = thr_field_amount(field_reader, value, "gap", &options->gap);
  if (!st && options->gap > 100) st = thr_field_bad(field_reader, "options.gap", "more than 100");
  if (!st && thr_json_get(value, "needles")) st = thr_field_int(field_reader, value, "needles", 1, 2, &options->needles);
  if (!st && thr_json_get(value, "order"))
    st = thr_field_name(field_reader, value, "options", "order", THR_N_ORDERS, thr_order_name, &order);
  if (!st && thr_json_get(value, "crossings"))
    st = thr_field_name(field_reader, value, "options", "crossings", THR_N_CROSSINGS, thr_crossings_name, &crossings);
  if (!st && crossings != THR_CROSSINGS_ALLOW && options->joint == THR_JOINT_TUBE)
    st = thr_field_bad(field_reader, "options.crossings", "goes with solid joints");
  if (!st && thr_json_get(value, "engine"))
    st = thr_field_name(field_reader, value, "options", "engine", 3, thr_engine_name, &engine);
  if (!st && thr_json_get(value, "confirm"))
    st = thr_field_name(field_reader, value, "options", "confirm", 3, thr_confirm_name, &confirm);
  options->order = (thr_order)order;
  options->crossings = (thr_crossings)crossings;
  options->engine = (thr_engine)engine;
  options->confirm = (thr_confirm)confirm;
  return st;
}

static thr_status read_end_nodes(const thr_field_reader *field_reader, const thr_json *value, const thr_frame *frame,
                                 bool **end_node)
{
  const thr_json *list;
  thr_status st = thr_field_need(field_reader, value, "end_nodes", THR_JSON_ARRAY, &list);
  if (st) return st;
  if (!(*end_node = thr_calloc((size_t)frame->n_nodes, sizeof **end_node))) return thr_nomem(field_reader->err);
  for (int i = 0, node = 0; i < thr_json_size(list); i++) {
    if ((st = thr_field_index(field_reader, list, i, frame->n_nodes, "options.end_nodes", &node))) return st;
    (*end_node)[node] = true;
  }
  return THR_OK;
}

/* Pairs of a node and the number of cord ends there. */
static thr_status read_end_counts(const thr_field_reader *field_reader, const thr_json *value, const thr_frame *frame,
                                  int **end_count)
{
  const thr_json *list;
  thr_status st = thr_field_need(field_reader, value, "end_counts", THR_JSON_ARRAY, &list);
  if (st) return st;
  if (!(*end_count = thr_calloc((size_t)frame->n_nodes, sizeof **end_count))) return thr_nomem(field_reader->err);
  for (int i = 0; i < thr_json_size(list); i++) {
    const thr_json *pair = thr_json_at(list, i);
    int64_t count;
    int node = 0;
    if (thr_json_size(pair) != 2) return thr_field_bad(field_reader, "options.end_counts", "not pairs of a node and a number");
    if ((st = thr_field_index(field_reader, pair, 0, frame->n_nodes, "options.end_counts", &node))) return st;
    if (!thr_json_int(thr_json_at(pair, 1), &count) || count < 1 || count > 2000 || (*end_count)[node] > 0)
      return thr_fail(field_reader->err, field_reader->code,
                      "%s: options.end_counts[%d]: not a number from 1 to 2000, or the node comes twice", field_reader->name, i);
    (*end_count)[node] = (int)count;
  }
  return THR_OK;
}

thr_status thr_plan_read_options(const thr_field_reader *field_reader, const thr_json *doc, const thr_frame *frame,
                                 thr_request *options)
{
  char place[256];
  const thr_json *value;
  int kind;
  thr_status st = thr_field_need(field_reader, doc, "options", THR_JSON_OBJECT, &value);
  if (st) return st;
  *options = thr_request_default();
  if ((st = read_objective(field_reader, value, options))) return st;
  if ((st = read_limits(field_reader, value, options))) return st;
  snprintf(place, sizeof place, "%.200s: options.physics", field_reader->name);
  if ((st = thr_physics_from_json(&options->physics, thr_json_get(value, "physics"), place, field_reader->err))) return st;
  if ((st = read_means(field_reader, value, options))) return st;
  if ((st = thr_field_name(field_reader, value, "options", "ends", THR_ENDS_COUNTS + 1, thr_ends_name, &kind))) return st;
  options->ends = (thr_ends)kind;
  if (options->distinct > (thr_plan_counted(options) ? options->cords_least : options->cords))
    return thr_field_bad(field_reader, "options.distinct", "more than the cords");
  if (options->distinct > 0 && thr_wants_turning(options) && options->turning.tour != THR_TOUR_LEAST)
    return thr_field_bad(field_reader, "options.distinct", "not with a classical tour");
  if (thr_json_get(value, "end_nodes") && options->ends != THR_ENDS_NODES)
    return thr_field_bad(field_reader, "options.end_nodes", "only with ends `nodes`");
  if (thr_json_get(value, "end_counts") && options->ends != THR_ENDS_COUNTS)
    return thr_field_bad(field_reader, "options.end_counts", "only with ends `counts`");
  if (options->ends == THR_ENDS_NODES) return read_end_nodes(field_reader, value, frame, &options->end_node);
  return options->ends == THR_ENDS_COUNTS ? read_end_counts(field_reader, value, frame, &options->end_count) : THR_OK;
}
