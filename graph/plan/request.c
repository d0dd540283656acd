/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads, writes and interprets what is asked of a plan: lists of aims, names of choices, and what
 * request and framework say together.
 *
 *   thr_request o = thr_request_default();
 *   thr_aims_parse("length+5%,turning:sine", &o, &err)
 *
 * asks for at most 5 % above the least length, and of such plans for the least turning, priced by
 * sin(angle / 2). */
#include "graph/plan/request.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

thr_request thr_request_default(void)
{
  /* One closed cord of the least length, once over every edge. */
  return (thr_request){.aims = thr_aims_shortest,
                       .cover = 1,
                       .cords = 1,
                       .cords_least = 1,
                       .turning = {.length_slack = -1},
                       .symmetry = {.geometric = -1},
                       .ends = THR_ENDS_CLOSED,
                       .gap = -1,
                       .order = THR_ORDER_STARTS,
                       .physics = thr_physics_default()};
}

/* ---- what the aims come to ---- */

const thr_aims thr_aims_shortest = {1, {THR_AIM_LENGTH}};
const thr_aims thr_aims_straightest = {1, {THR_AIM_TURNING}};
const thr_aims thr_aims_symmetric = {
    THR_N_AIMS, {THR_AIM_OVERLAP, THR_AIM_STEPS, THR_AIM_PATHS, THR_AIM_TURNING}};

thr_aims thr_aims_of(thr_objective objective)
{
  return objective == THR_SYMMETRY     ? thr_aims_symmetric
         : objective == THR_TORTUOSITY ? thr_aims_straightest
                                       : thr_aims_shortest;
}

/* Returns whether an aim is among those of the request. */
static bool aims_have(const thr_request *options, thr_aim aim)
{
  for (int i = 0; i < options->aims.n; i++)
    if (options->aims.aim[i] == aim) return true;
  return false;
}

thr_objective thr_aims_objective(const thr_request *options)
{
  if (aims_have(options, THR_AIM_STEPS) || aims_have(options, THR_AIM_PATHS)) return THR_SYMMETRY;
  return aims_have(options, THR_AIM_TURNING) || thr_wants_largest(options) ? THR_TORTUOSITY
                                                                           : THR_LENGTH;
}

bool thr_wants_length(const thr_request *options)
{
  return thr_aims_objective(options) == THR_LENGTH;
}

bool thr_wants_turning(const thr_request *options)
{
  return thr_aims_objective(options) == THR_TORTUOSITY;
}

bool thr_wants_symmetry(const thr_request *options)
{
  return thr_aims_objective(options) == THR_SYMMETRY;
}

bool thr_wants_balance(const thr_request *options)
{
  return aims_have(options, THR_AIM_LONGEST);
}

bool thr_wants_largest(const thr_request *options)
{
  return aims_have(options, THR_AIM_MAX_TURNING) || thr_wants_pull(options);
}

bool thr_wants_pull(const thr_request *options)
{
  return aims_have(options, THR_AIM_PULL);
}

/* Where cords end at few nodes only, all of them pass the few edges there. */
int thr_request_most_passes(const thr_frame *frame, const thr_request *options)
{
  const int usual = thr_turning_most_passes(frame, options->cover), room = 2 * options->cords;
  const bool few = options->ends != THR_ENDS_CLOSED && options->ends != THR_ENDS_ANY;
  return few && room > usual ? room : usual;
}

/* Completes the order of a symmetric plan's aims. */
void thr_aims_order(const thr_request *options, thr_aim order[THR_N_AIMS])
{
  bool taken[THR_N_AIMS] = {false};
  int n = 0;

  /* The aims that are named, in their order, then the others. */
  for (int i = 0; i < options->aims.n; i++) {
    thr_aim aim = options->aims.aim[i];
    if (aim < THR_N_AIMS) taken[order[n++] = aim] = true;
  }

  for (int aim = 0; aim < THR_N_AIMS; aim++)
    if (!taken[aim]) order[n++] = (thr_aim)aim;
}

/* ---- lists of aims ---- */

/* A list of aims while it is read. */
typedef struct {
  bool named[THR_ALL_AIMS], priced, limited;
  thr_aims aims;
  thr_turn_cost cost;
  double slack; /* < 0 = none */
} aim_list;

bool thr_slack_parse(const char *text, double *slack)
{
  char *end;
  const double percent = strtod(text, &end);
  *slack = percent / 100;
  return end != text && (*end == '\0' || strcmp(end, "%") == 0) && percent >= 0 && percent <= 1e6;
}

/* Reads the name of a cost of turns; returns false if there is none. */
static bool read_cost(const char *name, thr_turn_cost *cost)
{
  for (int i = 0; i < THR_N_TURN_COSTS; i++)
    if (strcmp(thr_turn_cost_name(i), name) == 0) {
      *cost = (thr_turn_cost)i;
      return true;
    }
  return false;
}

/* Reads one aim, such as "length+5%" or "turning:sine"; the word is cut at its sign. */
static thr_status read_aim(char *word, aim_list *list, thr_err *err)
{
  char *more = strpbrk(word, "+:"), mark = more ? *more : '\0';
  int aim = 0;

  /* Look for the name. */
  if (more) *more++ = '\0';
  while (aim < THR_ALL_AIMS && strcmp(word, thr_aim_name(aim)) != 0)
    aim++;

  if (aim == THR_ALL_AIMS)
    return thr_fail(err, THR_EINPUT,
                    "\"%s\" is no aim; there are length, longest, turning, max-turning, pull, "
                    "overlap, steps, paths",
                    word);

  if (list->named[aim]) return thr_fail(err, THR_EINPUT, "%s is there twice", word);
  list->named[aim] = true;
  list->aims.aim[list->aims.n++] = (thr_aim)aim;

  /* A percentage above the least. */
  if (mark == '+') {
    if (aim != THR_AIM_LENGTH || !thr_slack_parse(more, &list->slack))
      return thr_fail(err, THR_EINPUT,
                      "%s+%s: only length takes a percentage, from 0 to 1e+06, like length+5%%",
                      word, more);
    list->limited = true;
  }

  /* A cost of turns. */
  if (mark != ':') return THR_OK;
  if ((aim != THR_AIM_TURNING && aim != THR_AIM_MAX_TURNING) || !read_cost(more, &list->cost))
    return thr_fail(err, THR_EINPUT,
                    "%s:%s: only turning and max-turning take a cost: " THR_TURN_COSTS, word, more);

  list->priced = true;
  return THR_OK;
}

/* Reads all aims of a list with commas. */
static thr_status read_list(const char *text, aim_list *list, thr_err *err)
{
  char word[64];
  const char *from = text, *end = text;
  thr_status st = THR_OK;

  /* The last word ends at the NUL. */
  for (bool more = true; more && !st; more = *end, from = end + 1) {
    end = from + strcspn(from, ",");
    snprintf(word, sizeof word, "%.*s", (int)(end - from), from);
    st = read_aim(word, list, err);
  }

  return st;
}

/* Takes an aim out of the list; returns false if the list does not have it. */
static bool take_out(thr_aims *aims, thr_aim aim)
{
  int at = 0;

  while (at < aims->n && aims->aim[at] != aim)
    at++;

  /* The aims after it move up. */
  if (at == aims->n) return false;
  memmove(&aims->aim[at], &aims->aim[at + 1], (size_t)(--aims->n - at) * sizeof *aims->aim);
  return true;
}

/* Replaces an aim by another one that means the same: length and overlap differ by a constant. */
static void rename_aim(aim_list *list, thr_aim from, thr_aim to)
{
  for (int i = 0; i < list->aims.n; i++)
    if (list->aims.aim[i] == from) list->aims.aim[i] = to;
  list->named[to] |= list->named[from];
  list->named[from] = false;
}

/* Completes the aims of a symmetric plan, which has all of overlap, steps, paths and turning in
 * some order, perhaps after the longest cord. */
static thr_status settle_symmetric(aim_list *list, thr_request *options, thr_err *err)
{
  /* What cannot be asked of symmetric plans. */
  if (list->named[THR_AIM_MAX_TURNING] || list->named[THR_AIM_PULL])
    return thr_fail(
        err, THR_EINPUT,
        "symmetric plans, which steps and paths ask for, do not know %s: copies turn alike",
        thr_aim_name(list->named[THR_AIM_PULL] ? THR_AIM_PULL : THR_AIM_MAX_TURNING));

  if (list->named[THR_AIM_LONGEST] && list->aims.aim[0] != THR_AIM_LONGEST)
    return thr_fail(err, THR_EINPUT, "longest comes before the other aims of a symmetric plan");
  if (list->priced)
    return thr_fail(err, THR_EINPUT,
                    "of symmetric plans the turning is that of its angles: no cost of turns");

  /* The named aims first, then the others in their usual order. */
  rename_aim(list, THR_AIM_LENGTH, THR_AIM_OVERLAP);
  options->aims = list->aims;
  list->aims = (thr_aims){list->named[THR_AIM_LONGEST], {THR_AIM_LONGEST}};
  thr_aims_order(options, list->aims.aim + list->aims.n);
  list->aims.n += THR_N_AIMS;

  return THR_OK;
}

/* Completes the aims of a plan that turns little. Length before turning becomes a limit on the
 * length; the longest cord may only come first. */
static thr_status settle_turning(aim_list *list, thr_err *err)
{
  /* One of them is minimized. */
  if (list->named[THR_AIM_TURNING] + list->named[THR_AIM_MAX_TURNING] + list->named[THR_AIM_PULL] >
      1)
    return thr_fail(err, THR_EINPUT, "one of turning, max-turning and pull, not both");

  /* What is limited, or made short first, comes first. */
  thr_aim last = list->aims.aim[list->aims.n - 1];
  if (last == THR_AIM_LENGTH || last == THR_AIM_LONGEST)
    return thr_fail(err, THR_EINPUT, "%s comes before turning, max-turning and pull",
                    thr_aim_name(last));

  /* Length alone allows no extra cord. */
  if (take_out(&list->aims, THR_AIM_LENGTH) && list->slack < 0) list->slack = 0;
  return THR_OK;
}

/* Completes the aims of a short plan: length is the last one. */
static thr_status settle_length(aim_list *list, thr_err *err)
{
  /* Length is the last aim, unless another place is named. */
  if (!list->named[THR_AIM_LENGTH]) list->aims.aim[list->aims.n++] = THR_AIM_LENGTH;
  if (list->named[THR_AIM_LONGEST] && list->aims.aim[0] != THR_AIM_LONGEST)
    return thr_fail(
        err, THR_EINPUT,
        "longest comes before length: the shortest longest cord, and then the least length");

  return THR_OK;
}

/* Decides which kind of plan the aims mean, and completes them. */
static thr_status settle(aim_list *list, thr_request *options, thr_err *err)
{
  bool symmetric = list->named[THR_AIM_STEPS] || list->named[THR_AIM_PATHS];
  bool turning = !symmetric && (list->named[THR_AIM_TURNING] || list->named[THR_AIM_MAX_TURNING] ||
                                list->named[THR_AIM_PULL]);

  /* What does not go together. */
  if (list->named[THR_AIM_LENGTH] && list->named[THR_AIM_OVERLAP])
    return thr_fail(err, THR_EINPUT, "length and overlap are the same aim");
  if (list->limited && !turning)
    return thr_fail(err, THR_EINPUT,
                    "length+%g%%: cord beyond the least length is for turning, max-turning or pull",
                    100 * list->slack);

  /* Each kind of plan has its own last aims. */
  if (symmetric) return settle_symmetric(list, options, err);
  rename_aim(list, THR_AIM_OVERLAP, THR_AIM_LENGTH);
  return turning ? settle_turning(list, err) : settle_length(list, err);
}

/* On failure the request stays as it was. */
thr_status thr_aims_parse(const char *text, thr_request *options, thr_err *err)
{
  aim_list list = {.slack = -1};
  thr_request trial = *options;
  thr_status st = read_list(text, &list, err);

  if (!st) st = settle(&list, &trial, err);
  if (st) return st;

  /* Lists that are wrong have changed nothing so far. */
  options->aims = list.aims;
  options->turning.cost = list.cost;
  options->turning.length_slack = list.slack;

  return THR_OK;
}

/* Writes the list that thr_aims_parse reads as the same request. */
/* ---- names ---- */

const char *thr_objective_name(int o)
{
  static const char *const name[] = {"length", "tortuosity", "symmetry"};
  return name[o];
}

const char *thr_tour_name(int t)
{
  static const char *const name[] = {"least", "fleury", "hierholzer"};
  return name[t];
}

const char *thr_aim_name(int a)
{
  static const char *const name[] = {"overlap", "steps",   "paths",       "turning",
                                     "length",  "longest", "max-turning", "pull"};
  return name[a];
}

thr_aim thr_minimize_aim(int i)
{
  static const thr_aim aim[THR_N_MINIMIZE] = {THR_AIM_TURNING, THR_AIM_MAX_TURNING, THR_AIM_PULL};
  return aim[i];
}

const char *thr_minimize_name(int i)
{
  return thr_aim_name(thr_minimize_aim(i));
}

const char *thr_largest_name(const thr_request *options)
{
  return thr_wants_pull(options) ? "the largest turning before an end that is pulled"
                                 : "the largest turning of a cord";
}

const char *thr_pairings_name(int p)
{
  return p == THR_PAIRINGS_IGNORE ? "ignore" : "keep";
}

const char *thr_ends_name(int e)
{
  static const char *const name[] = {"closed", "any", "feet", "nodes", "counts"};
  return name[e];
}

const char *thr_joint_name(int j)
{
  return j == THR_JOINT_TUBE ? "tube" : "solid";
}

const char *thr_crossings_name(int c)
{
  static const char *const name[THR_N_CROSSINGS] = {"allow", "price", "forbid"};
  return name[c];
}

const char *thr_order_name(int o)
{
  static const char *const name[] = {
      [THR_ORDER_PLANNED] = "planned", [THR_ORDER_STARTS] = "starts", [THR_ORDER_HAND] = "hand"};
  return name[o];
}

const char *thr_engine_name(int e)
{
  static const char *const name[] = {
      [THR_ENGINE_AUTO] = "auto", [THR_ENGINE_LP] = "lp", [THR_ENGINE_MATCHING] = "matching"};
  return name[e];
}

const char *thr_confirm_name(int c)
{
  static const char *const name[] = {
      [THR_CONFIRM_AUTO] = "auto", [THR_CONFIRM_ALWAYS] = "always", [THR_CONFIRM_NEVER] = "never"};
  return name[c];
}

/* ---- options and framework together ---- */

double thr_request_gap(const thr_request *options)
{
  /* Searches for least turning end at a hundredth above the bound unless asked otherwise. */
  const double usual = 0.01;
  return options->gap >= 0 ? options->gap / 100 : thr_wants_length(options) ? 0 : usual;
}

bool thr_plan_within_slack(const thr_request *options, double length, double least)
{
  bool asked = thr_wants_turning(options) && options->turning.length_slack >= 0;

  /* 2e-9: what the lengths and the bound may lose to rounding. */
  return !asked || length <= (1 + options->turning.length_slack) * least * (1 + 2e-9);
}

bool thr_plan_counted(const thr_request *options)
{
  return !thr_wants_symmetry(options) || options->symmetry.counted;
}

int thr_plan_cords_least(const thr_request *options)
{
  return thr_plan_counted(options) ? options->cords_least : 1;
}

bool thr_plan_fewest_first(const thr_request *options)
{
  return options->max_length > 0 && thr_plan_counted(options) &&
         options->cords_least < options->cords;
}

double thr_request_most_pulled(const thr_request *options)
{
  bool limited = options->max_pull > 0 && options->physics.mu > 0;
  return limited ? log(options->max_pull) / options->physics.mu : INFINITY;
}

double thr_request_most_turning(const thr_request *options)
{
  return 2 * thr_request_most_pulled(options) + (options->old_pull ? 0 : THR_PI);
}

/* Reduces a request for several cords that are all alike to a request for one of them. */
bool thr_request_alike(const thr_frame *frame, const thr_request *options, thr_request *one)
{
  *one = *options;

  /* One of the cords, as if it were the only one. */
  one->cover = one->cords = one->cords_least = 1;
  one->distinct = 0;

  /* Every cord passes every edge if there are as many cords as must pass each edge, and each edge
   * has one pass of every cord. */
  return options->distinct > 0 && !thr_wants_symmetry(options) &&
         options->distinct == options->cords && options->cords == options->cords_least &&
         options->distinct == options->cover && !frame->cover && !frame->capacity &&
         options->capacity == 0 && options->joint == THR_JOINT_SOLID &&
         options->ends != THR_ENDS_COUNTS;
}

bool thr_plan_end_allowed(const thr_frame *frame, const thr_request *options, int v)
{
  /* Feet are the framework's, other nodes the user's. */
  switch (options->ends) {
  case THR_ENDS_FEET: return frame->foot[v];
  case THR_ENDS_NODES: return options->end_node[v];
  case THR_ENDS_COUNTS: return options->end_count[v] > 0;
  default: return true;
  }
}

/* Translates a request into the task of the programme for least turning. */
thr_turning_task thr_turning_task_of(const thr_frame *frame, const thr_request *request,
                                     bool *end_allowed)
{
  const bool closed = request->ends == THR_ENDS_CLOSED;

  /* Closed cords have no ends. */
  if (end_allowed)
    for (int v = 0; v < frame->n_nodes; v++)
      end_allowed[v] = thr_plan_end_allowed(frame, request, v);

  /* Any length is allowed here; searches narrow the task. */
  return (thr_turning_task){.cover = request->cover,
                            .capacity = request->capacity,
                            .tube = request->joint == THR_JOINT_TUBE,
                            .most_passes = thr_turning_most_passes(frame, request->cover),
                            .cords = request->cords,
                            .cords_least = request->cords_least,
                            .end_allowed = closed ? NULL : end_allowed,
                            .end_count =
                                request->ends == THR_ENDS_COUNTS ? request->end_count : NULL,
                            .cost = request->turning.cost,
                            .extra_limit = -1};
}

thr_status thr_request_fit_bore(thr_request *request, thr_err *err)
{
  const thr_physics *physics = &request->physics;
  if (physics->bore == 0 || physics->cord_diameter == 0 || thr_wants_symmetry(request))
    return THR_OK;
  const int fit = thr_bore_fits(physics->bore, physics->cord_diameter);

  /* Fewer than the cover needs: no plan exists. */
  if (fit < request->cover)
    return thr_fail(err, THR_EINFEASIBLE,
                    "%d %s of a cord of %g mm %s through a bore of %g mm with ease; --cover asks "
                    "for %d",
                    fit, fit == 1 ? "pass" : "passes", physics->cord_diameter,
                    fit == 1 ? "goes" : "go", physics->bore, request->cover);

  /* The tighter of the two limits holds. */
  if (request->capacity == 0 || fit < request->capacity) request->capacity = fit;
  return THR_OK;
}
