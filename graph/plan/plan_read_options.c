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

static thr_status read_turning_options(const thr_field_reader *r, const thr_json *o, thr_plan_options *out)
{
  thr_turning_options *t = &out->turning;
  static const char *const known[] = {"cost", "length_slack", "minimize", "tour", "pairings", NULL};
  const thr_json *v;
  int cost, aim, tour, pairings;
  thr_status st = thr_field_need(r, o, "turning", THR_JSON_OBJECT, &v);
  if (!st) st = thr_field_only(r, v, "options.turning", known);
  if (!st) st = thr_field_name(r, v, "options.turning", "cost", THR_N_TURN_COSTS, thr_turn_cost_name, &cost);
  if (!st) st = thr_field_or_null(r, v, "length_slack", &t->length_slack);
  if (!st) st = thr_field_name(r, v, "options.turning", "minimize", 2, thr_minimize_name, &aim);
  if (!st) st = thr_field_name(r, v, "options.turning", "tour", THR_N_TOURS, thr_tour_name, &tour);
  if (!st) st = thr_field_name(r, v, "options.turning", "pairings", 2, thr_pairings_name, &pairings);
  if (st) return st;
  t->cost = (thr_turn_cost)cost;
  out->aims = (thr_aims){1, {aim == 1 ? THR_AIM_MAX_TURNING : THR_AIM_TURNING}};
  t->tour = (thr_tour)tour;
  t->ignore_pairings = pairings == 1;
  return THR_OK;
}

/* Every aim once. */
static thr_status read_prefer(const thr_field_reader *r, const thr_json *o, thr_aim prefer[])
{
  bool named[THR_N_AIMS] = {false};
  const thr_json *list;
  thr_status st = thr_field_need(r, o, "prefer", THR_JSON_ARRAY, &list);
  if (!st && thr_json_size(list) != THR_N_AIMS) return thr_field_bad(r, "options.symmetry.prefer", "not four aims");
  for (int i = 0, aim = 0; i < THR_N_AIMS && !st; i++) {
    st = thr_field_name_of(r, thr_json_at(list, i), "options.symmetry", "prefer", THR_N_AIMS, thr_aim_name, &aim);
    if (!st && named[aim]) return thr_field_bad(r, "options.symmetry.prefer", "names one aim twice");
    named[aim] = true;
    prefer[i] = (thr_aim)aim;
  }
  return st;
}

static thr_status read_symmetry_options(const thr_field_reader *r, const thr_json *o, thr_plan_options *out)
{
  thr_symmetry_options *s = &out->symmetry;
  static const char *const known[] = {"group", "geometric", "prefer", NULL};
  const thr_json *v, *group;
  thr_status st = thr_field_need(r, o, "symmetry", THR_JSON_OBJECT, &v);
  if (!st) st = thr_field_only(r, v, "options.symmetry", known);
  if (st) return st;
  group = thr_json_get(v, "group");
  const char *name = thr_json_string(group);
  if (!group || (!name && thr_json_typeof(group) != THR_JSON_NULL) || (name && (!*name || strlen(name) >= sizeof s->group)))
    return thr_field_bad(r, "options.symmetry.group", "neither null nor a text of 1 to 15 bytes");
  snprintf(s->group, sizeof s->group, "%s", name ? name : "");
  thr_text_clean(s->group);
  if ((st = thr_field_or_null(r, v, "geometric", &s->geometric))) return st;
  out->aims.n = THR_N_AIMS;
  return read_prefer(r, v, out->aims.aim);
}

/* Which options there are depends on the objective. */
static thr_status read_objective(const thr_field_reader *r, const thr_json *v, thr_plan_options *o)
{
  static const char *const own[THR_N_OBJECTIVES] = {"confirm", "turning", "symmetry"};
  const char *known[] = {"objective", "joint",      "cover",      "capacity", "cords",  "max_length", "balance", "ends",
                         "end_nodes", "end_counts", "time_limit", "physics",  "engine", NULL,         NULL};
  int objective, joint;
  thr_status st = thr_field_name(r, v, "options", "objective", THR_N_OBJECTIVES, thr_objective_name, &objective);
  if (st) return st;
  known[sizeof known / sizeof *known - 2] = own[objective];
  if ((st = thr_field_only(r, v, "options", known))) return st;
  if ((st = thr_field_name(r, v, "options", "joint", 2, thr_joint_name, &joint))) return st;
  o->joint = (thr_joint)joint;
  if (objective == THR_TORTUOSITY) return read_turning_options(r, v, o);
  return objective == THR_SYMMETRY ? read_symmetry_options(r, v, o) : THR_OK;
}

/* A number: exactly so many; or least and most. */
static thr_status read_cord_range(const thr_field_reader *r, const thr_json *o, thr_plan_options *out)
{
  static const char *const known[] = {"least", "most", NULL};
  const thr_json *v = thr_json_get(o, "cords");
  if (!v || thr_json_typeof(v) != THR_JSON_OBJECT) {
    thr_status st = thr_field_int(r, o, "cords", 1, 1000, &out->cords);
    out->cords_least = out->cords;
    return st;
  }
  thr_status st = thr_field_only(r, v, "options.cords", known);
  if (!st) st = thr_field_int(r, v, "most", 1, 1000, &out->cords);
  if (!st) st = thr_field_int(r, v, "least", 1, out->cords, &out->cords_least);
  return st;
}

static void put_first(thr_aims *a, thr_aim aim)
{
  memmove(&a->aim[1], &a->aim[0], (size_t)a->n++ * sizeof *a->aim);
  a->aim[0] = aim;
}

/* What is not there is not asked for. */
static thr_status read_limits(const thr_field_reader *r, const thr_json *v, thr_plan_options *o)
{
  const thr_json *balance = thr_json_get(v, "balance");
  thr_status st = read_cord_range(r, v, o);
  if (!st) st = thr_field_int(r, v, "cover", 1, 100, &o->cover);
  if (!st && thr_json_get(v, "capacity")) st = thr_field_int(r, v, "capacity", 1, INT32_MAX, &o->capacity);
  if (!st && thr_json_get(v, "max_length")) {
    st = thr_field_amount(r, v, "max_length", &o->max_length);
    if (!st && o->max_length == 0) st = thr_field_bad(r, "options.max_length", "not above 0");
  }
  if (!st && balance && thr_json_typeof(balance) != THR_JSON_BOOL) st = thr_field_bad(r, "options.balance", "not true or false");
  if (!st && balance && thr_json_true(balance)) put_first(&o->aims, THR_AIM_LONGEST);
  return st;
}

/* How it was found. What is not there was left to the program. */
static thr_status read_means(const thr_field_reader *r, const thr_json *v, thr_plan_options *o)
{
  int engine = THR_ENGINE_AUTO, confirm = THR_CONFIRM_AUTO;
  thr_status st = thr_field_double(r, v, "time_limit", &o->time_limit);
  if (!st && thr_json_get(v, "engine")) st = thr_field_name(r, v, "options", "engine", 3, thr_engine_name, &engine);
  if (!st && thr_json_get(v, "confirm")) st = thr_field_name(r, v, "options", "confirm", 3, thr_confirm_name, &confirm);
  o->engine = (thr_engine)engine;
  o->confirm = (thr_confirm)confirm;
  return st;
}

static thr_status read_end_nodes(const thr_field_reader *r, const thr_json *v, const thr_frame *f, bool **end_node)
{
  const thr_json *list;
  thr_status st = thr_field_need(r, v, "end_nodes", THR_JSON_ARRAY, &list);
  if (st) return st;
  if (!(*end_node = thr_calloc((size_t)f->n_nodes, sizeof **end_node))) return thr_nomem(r->err);
  for (int i = 0, node = 0; i < thr_json_size(list); i++) {
    if ((st = thr_field_index(r, list, i, f->n_nodes, "options.end_nodes", &node))) return st;
    (*end_node)[node] = true;
  }
  return THR_OK;
}

/* Pairs of a node and the number of cord ends there. */
static thr_status read_end_counts(const thr_field_reader *r, const thr_json *v, const thr_frame *f, int **end_count)
{
  const thr_json *list;
  thr_status st = thr_field_need(r, v, "end_counts", THR_JSON_ARRAY, &list);
  if (st) return st;
  if (!(*end_count = thr_calloc((size_t)f->n_nodes, sizeof **end_count))) return thr_nomem(r->err);
  for (int i = 0; i < thr_json_size(list); i++) {
    const thr_json *pair = thr_json_at(list, i);
    int64_t count;
    int node = 0;
    if (thr_json_size(pair) != 2) return thr_field_bad(r, "options.end_counts", "not pairs of a node and a number");
    if ((st = thr_field_index(r, pair, 0, f->n_nodes, "options.end_counts", &node))) return st;
    if (!thr_json_int(thr_json_at(pair, 1), &count) || count < 1 || count > 2000 || (*end_count)[node] > 0)
      return thr_fail(r->err, r->code, "%s: options.end_counts[%d]: not a number from 1 to 2000, or the node comes twice",
                      r->name, i);
    (*end_count)[node] = (int)count;
  }
  return THR_OK;
}

thr_status thr_plan_read_options(const thr_field_reader *r, const thr_json *doc, const thr_frame *f, thr_plan_options *o)
{
  char place[256];
  const thr_json *v;
  int kind;
  thr_status st = thr_field_need(r, doc, "options", THR_JSON_OBJECT, &v);
  if (st) return st;
  *o = thr_plan_options_default();
  if ((st = read_objective(r, v, o))) return st;
  if ((st = read_limits(r, v, o))) return st;
  snprintf(place, sizeof place, "%.200s: options.physics", r->name);
  if ((st = thr_physics_from_json(&o->physics, thr_json_get(v, "physics"), place, r->err))) return st;
  if ((st = read_means(r, v, o))) return st;
  if ((st = thr_field_name(r, v, "options", "ends", THR_ENDS_COUNTS + 1, thr_ends_name, &kind))) return st;
  o->ends = (thr_ends)kind;
  if (thr_json_get(v, "end_nodes") && o->ends != THR_ENDS_NODES)
    return thr_field_bad(r, "options.end_nodes", "only with ends `nodes`");
  if (thr_json_get(v, "end_counts") && o->ends != THR_ENDS_COUNTS)
    return thr_field_bad(r, "options.end_counts", "only with ends `counts`");
  if (o->ends == THR_ENDS_NODES) return read_end_nodes(r, v, f, &o->end_node);
  return o->ends == THR_ENDS_COUNTS ? read_end_counts(r, v, f, &o->end_count) : THR_OK;
}
