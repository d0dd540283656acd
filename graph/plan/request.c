/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The request: what a plan is asked to be, and what it is to have little of, first, second, ...
 *
 *   thr_request o = thr_request_default();
 *   thr_aims_parse("length+5%,turning:sine", &o, &err)
 *
 * asks for at most 5 % above the least length, and of such plans for the least turning.
 *
 * What is asked of a plan: lists of aims, names, and what options and framework say together. */
#include "graph/plan/request.h"
#include "graph/number.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

thr_request thr_request_default(void)
{
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

bool thr_aims_have(const thr_request *options, thr_aim aim)
{
  for (int i = 0; i < options->aims.n; i++)
    if (options->aims.aim[i] == aim) return true;
  return false;
}

thr_objective thr_aims_objective(const thr_request *options)
{
  if (thr_aims_have(options, THR_AIM_STEPS) || thr_aims_have(options, THR_AIM_PATHS))
    return THR_SYMMETRY;
  return thr_aims_have(options, THR_AIM_TURNING) || thr_wants_largest(options) ? THR_TORTUOSITY
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
  return thr_aims_have(options, THR_AIM_LONGEST);
}

bool thr_wants_largest(const thr_request *options)
{
  return thr_aims_have(options, THR_AIM_MAX_TURNING) || thr_wants_pull(options);
}

bool thr_wants_pull(const thr_request *options)
{
  return thr_aims_have(options, THR_AIM_PULL);
}

int thr_request_most_passes(const thr_frame *frame, const thr_request *options)
{
  const int usual = thr_turning_most_passes(frame, options->cover), room = 2 * options->cords;
  const bool few = options->ends != THR_ENDS_CLOSED && options->ends != THR_ENDS_ANY;
  return few && room > usual ? room : usual;
}

void thr_aims_order(const thr_request *options, thr_aim order[THR_N_AIMS])
{
  bool taken[THR_N_AIMS] = {false};
  int n = 0;
  for (int i = 0; i < options->aims.n; i++) {
    thr_aim aim = options->aims.aim[i];
    if (aim < THR_N_AIMS) taken[order[n++] = aim] = true;
  }
  for (int aim = 0; aim < THR_N_AIMS; aim++)
    if (!taken[aim]) order[n++] = (thr_aim)aim;
}

/* ---- lists of aims ---- */

/* A list while it is read. */
typedef struct {
  bool named[THR_ALL_AIMS], priced, limited;
  thr_aims aims;
  thr_turn_cost cost;
  double slack; /* < 0 = none */
} list;

bool thr_slack_parse(const char *text, double *slack)
{
  char *end;
  const double percent = strtod(text, &end);
  *slack = percent / 100;
  return end != text && (*end == '\0' || strcmp(end, "%") == 0) && percent >= 0 && percent <= 1e6;
}

static bool read_cost(const char *name, thr_turn_cost *cost)
{
  for (int i = 0; i < THR_N_TURN_COSTS; i++)
    if (strcmp(thr_turn_cost_name(i), name) == 0) {
      *cost = (thr_turn_cost)i;
      return true;
    }
  return false;
}

/* word: one aim, which is taken apart. */
static thr_status read_aim(char *word, list *l, thr_err *err)
{
  char *more = strpbrk(word, "+:"), mark = more ? *more : '\0';
  int aim = 0;
  if (more) *more++ = '\0';
  while (aim < THR_ALL_AIMS && strcmp(word, thr_aim_name(aim)) != 0)
    aim++;
  if (aim == THR_ALL_AIMS)
    return thr_fail(err, THR_EINPUT,
                    "\"%s\" is no aim; there are length, longest, turning, max-turning, pull, "
                    "overlap, steps, paths",
                    word);
  if (l->named[aim]) return thr_fail(err, THR_EINPUT, "%s is there twice", word);
  l->named[aim] = true;
  l->aims.aim[l->aims.n++] = (thr_aim)aim;
  if (mark == '+') {
    if (aim != THR_AIM_LENGTH || !thr_slack_parse(more, &l->slack))
      return thr_fail(err, THR_EINPUT,
                      "%s+%s: only length takes a percentage, from 0 to 1e+06, like length+5%%",
                      word, more);
    l->limited = true;
  }
  if (mark != ':') return THR_OK;
  if ((aim != THR_AIM_TURNING && aim != THR_AIM_MAX_TURNING) || !read_cost(more, &l->cost))
    return thr_fail(err, THR_EINPUT,
                    "%s:%s: only turning and max-turning take a cost: " THR_TURN_COSTS, word, more);
  l->priced = true;
  return THR_OK;
}

static thr_status read_list(const char *text, list *l, thr_err *err)
{
  char word[64];
  const char *from = text, *end = text;
  thr_status st = THR_OK;
  for (bool more = true; more && !st; more = *end, from = end + 1) {
    end = from + strcspn(from, ",");
    snprintf(word, sizeof word, "%.*s", (int)(end - from), from);
    st = read_aim(word, l, err);
  }
  return st;
}

/* Takes an aim out of the list; false if it is not there. */
static bool take_out(thr_aims *a, thr_aim aim)
{
  int at = 0;
  while (at < a->n && a->aim[at] != aim)
    at++;
  if (at == a->n) return false;
  memmove(&a->aim[at], &a->aim[at + 1], (size_t)(--a->n - at) * sizeof *a->aim);
  return true;
}

/* Length and overlap are one but for a constant. */
static void rename_aim(list *l, thr_aim from, thr_aim to)
{
  for (int i = 0; i < l->aims.n; i++)
    if (l->aims.aim[i] == from) l->aims.aim[i] = to;
  l->named[to] |= l->named[from];
  l->named[from] = false;
}

static thr_status settle_symmetric(list *l, thr_request *options, thr_err *err)
{
  if (l->named[THR_AIM_MAX_TURNING] || l->named[THR_AIM_PULL])
    return thr_fail(
        err, THR_EINPUT,
        "symmetric plans, which steps and paths ask for, do not know %s: copies turn alike",
        thr_aim_name(l->named[THR_AIM_PULL] ? THR_AIM_PULL : THR_AIM_MAX_TURNING));
  if (l->named[THR_AIM_LONGEST] && l->aims.aim[0] != THR_AIM_LONGEST)
    return thr_fail(err, THR_EINPUT, "longest comes before the other aims of a symmetric plan");
  if (l->priced)
    return thr_fail(err, THR_EINPUT,
                    "of symmetric plans the turning is that of its angles: no cost of turns");
  rename_aim(l, THR_AIM_LENGTH, THR_AIM_OVERLAP);
  options->aims = l->aims;
  l->aims = (thr_aims){l->named[THR_AIM_LONGEST], {THR_AIM_LONGEST}};
  thr_aims_order(options, l->aims.aim + l->aims.n);
  l->aims.n += THR_N_AIMS;
  return THR_OK;
}

/* Length before turning is a limit on it; the longest cord is made short first. */
static thr_status settle_turning(list *l, thr_err *err)
{
  if (l->named[THR_AIM_TURNING] + l->named[THR_AIM_MAX_TURNING] + l->named[THR_AIM_PULL] > 1)
    return thr_fail(err, THR_EINPUT, "one of turning, max-turning and pull, not both");
  thr_aim last = l->aims.aim[l->aims.n - 1];
  if (last == THR_AIM_LENGTH || last == THR_AIM_LONGEST)
    return thr_fail(err, THR_EINPUT, "%s comes before turning, max-turning and pull",
                    thr_aim_name(last));
  if (take_out(&l->aims, THR_AIM_LENGTH) && l->slack < 0) l->slack = 0;
  return THR_OK;
}

static thr_status settle_length(list *l, thr_err *err)
{
  if (!l->named[THR_AIM_LENGTH]) l->aims.aim[l->aims.n++] = THR_AIM_LENGTH;
  if (l->named[THR_AIM_LONGEST] && l->aims.aim[0] != THR_AIM_LONGEST)
    return thr_fail(
        err, THR_EINPUT,
        "longest comes before length: the shortest longest cord, and then the least length");
  return THR_OK;
}

static thr_status settle(list *l, thr_request *options, thr_err *err)
{
  bool symmetric = l->named[THR_AIM_STEPS] || l->named[THR_AIM_PATHS];
  bool turning = !symmetric && (l->named[THR_AIM_TURNING] || l->named[THR_AIM_MAX_TURNING] ||
                                l->named[THR_AIM_PULL]);
  if (l->named[THR_AIM_LENGTH] && l->named[THR_AIM_OVERLAP])
    return thr_fail(err, THR_EINPUT, "length and overlap are the same aim");
  if (l->limited && !turning)
    return thr_fail(err, THR_EINPUT,
                    "length+%g%%: cord beyond the least length is for turning, max-turning or pull",
                    100 * l->slack);
  if (symmetric) return settle_symmetric(l, options, err);
  rename_aim(l, THR_AIM_OVERLAP, THR_AIM_LENGTH);
  return turning ? settle_turning(l, err) : settle_length(l, err);
}

thr_status thr_aims_parse(const char *text, thr_request *options, thr_err *err)
{
  list l = {.slack = -1};
  thr_request trial = *options;
  thr_status st = read_list(text, &l, err);
  if (!st) st = settle(&l, &trial, err);
  if (st) return st;
  options->aims = l.aims;
  options->turning.cost = l.cost;
  options->turning.length_slack = l.slack;
  return THR_OK;
}

void thr_aims_write(const thr_request *options, thr_text *out)
{
  bool turning = thr_wants_turning(options),
       limited = turning && options->turning.length_slack >= 0;
  if (limited && options->turning.length_slack > 0)
    thr_text_printf(out, "length+%.15g%%,", 100 * options->turning.length_slack);
  else if (limited)
    thr_text_append(out, "length,");
  for (int i = 0; i < options->aims.n; i++) {
    thr_text_printf(out, i ? ",%s" : "%s", thr_aim_name(options->aims.aim[i]));
    if (turning && options->aims.aim[i] != THR_AIM_LONGEST &&
        options->turning.cost != THR_TURN_ANGLE)
      thr_text_printf(out, ":%s", thr_turn_cost_name(options->turning.cost));
  }
}

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
  const double usual = 0.01;
  return options->gap >= 0 ? options->gap / 100 : thr_wants_length(options) ? 0 : usual;
}

bool thr_plan_within_slack(const thr_request *options, double length, double least)
{
  bool asked = thr_wants_turning(options) && options->turning.length_slack >= 0;
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

bool thr_request_alike(const thr_frame *frame, const thr_request *options, thr_request *one)
{
  *one = *options;
  one->cover = one->cords = one->cords_least = 1;
  one->distinct = 0;
  return options->distinct > 0 && !thr_wants_symmetry(options) &&
         options->distinct == options->cords && options->cords == options->cords_least &&
         options->distinct == options->cover && !frame->cover && !frame->capacity &&
         options->capacity == 0 && options->joint == THR_JOINT_SOLID &&
         options->ends != THR_ENDS_COUNTS;
}

bool thr_plan_end_allowed(const thr_frame *frame, const thr_request *options, int v)
{
  switch (options->ends) {
  case THR_ENDS_FEET: return frame->foot[v];
  case THR_ENDS_NODES: return options->end_node[v];
  case THR_ENDS_COUNTS: return options->end_count[v] > 0;
  default: return true;
  }
}

thr_turning_task thr_turning_task_of(const thr_frame *frame, const thr_request *request,
                                     bool *end_allowed)
{
  const bool closed = request->ends == THR_ENDS_CLOSED;
  if (end_allowed)
    for (int v = 0; v < frame->n_nodes; v++)
      end_allowed[v] = thr_plan_end_allowed(frame, request, v);

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
