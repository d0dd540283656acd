/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchanges at the nodes of a whole solution: two turns of one node exchange partners, or a turn
 * and an end or fold do. An exchange keeps the copies, and with them overlap and the steps over
 * edges; it may join connected sets, or lower the turning.
 *
 * Exchanges are visited turn by turn, and a visitor says what becomes of each: thr_programme_mend
 * lists them, cheapest turning first, to join sets that lack a terminal; thr_programme_attempt only
 * tries them.
 *
 * Example: of the turns a-b and c-d, between four dart types of one node, there can be made a-c and
 * b-d. */
#include "graph/arrays.h"
#include "symmetry/cover/cover.h"

#include <stdlib.h>

/* An exchange: one less of the columns out[], one more of the columns in[]. */
typedef struct {
  int out[2], in[2];
  int type[2];    /* dart types of the two turns that are broken up */
  double turning; /* what it adds to the turning */
} node_exchange;

/* Returns the pair column between dart types a and b with the least turning, of self pairs if self;
 * -1 = none. */
static int pair_between(const thr_programme *programme, int a, int b, bool self)
{
  int best = -1;
  for (int k = programme->first[a]; k < programme->first[a + 1]; k++) {
    const thr_pair_type *pair_type = &programme->q->pair[programme->incident[k]];
    int j = programme->first_pair + programme->incident[k];
    if (programme->most[j] == 0 || pair_type->self != self ||
        pair_type->dart[0] + pair_type->dart[1] != a + b ||
        (pair_type->dart[0] != a && pair_type->dart[1] != a))
      continue;

    if (best < 0 || programme->cost[THR_AIM_TURNING][j] < programme->cost[THR_AIM_TURNING][best])
      best = j;
  }
  return best;
}

/* Applies an exchange (sign 1), or takes it back (-1). */
static void apply_exchange(const node_exchange *exchange, int sign, int *value)
{
  for (int i = 0; i < 2; i++) {
    value[exchange->out[i]] -= sign;
    value[exchange->in[i]] += sign;
  }
}

/* Tells whether value has what an exchange takes out, and, with tube joints, whether the node stays
 * tied if it was. parent: [programme->ties->most] scratch. */
static bool is_possible(const thr_programme *programme, const node_exchange *exchange, int *value,
                        int *parent)
{
  if (value[exchange->out[0]] <= 0 ||
      value[exchange->out[1]] <= (exchange->out[0] == exchange->out[1]))
    return false;

  /* Only the node of these dart types can become untied. */
  int star = programme->ties ? programme->ties->star[exchange->type[0]] : -1;
  if (star < 0 || !thr_ties_tied(programme->ties, star, value + programme->first_pair, parent))
    return true;

  /* Try it. */
  apply_exchange(exchange, 1, value);
  bool tied = thr_ties_tied(programme->ties, star, value + programme->first_pair, parent);
  apply_exchange(exchange, -1, value);
  return tied;
}

/* Visits exchanges: visit returns false to end those of the present turn. */
typedef struct exchange_visitor {
  bool (*visit)(struct exchange_visitor *visitor, const node_exchange *exchange, thr_err *err,
                thr_status *st);
  const thr_programme *programme;
  int *value;
  int *parent; /* scratch of is_possible() */
  thr_programme_parts parts;
  /* mending */
  node_exchange *list;
  int n, capacity;
  /* trying */
  bool level; /* only what turns no more */
  thr_status (*attempt)(void *user, thr_err *err);
  void *user;
} exchange_visitor;

/* Allocates what every visitor needs. */
static thr_status visitor_init(exchange_visitor *visitor, thr_err *err)
{
  visitor->parent =
      thr_calloc(visitor->programme->ties ? (size_t)visitor->programme->ties->most : 0,
                 sizeof *visitor->parent);
  return visitor->parent ? THR_OK : thr_nomem(err);
}

/* Visits one exchange, of columns out0 and out1 for in0 and in1 (-1: there are none), if it is
 * possible. a, third: dart types of the two turns. Returns false to end the exchanges of this turn.
 */
static bool offer_exchange(exchange_visitor *visitor, int out0, int out1, int in0, int in1, int a,
                           int third, thr_err *err, thr_status *st)
{
  const double *cost = visitor->programme->cost[THR_AIM_TURNING];
  if (in0 < 0 || in1 < 0) return true;

  node_exchange exchange = {
      {out0, out1}, {in0, in1}, {a, third}, cost[in0] + cost[in1] - cost[out0] - cost[out1]};
  return !is_possible(visitor->programme, &exchange, visitor->value, visitor->parent) ||
         visitor->visit(visitor, &exchange, err, st);
}

/* Visits the exchanges of pair column j, between dart types a and b, with everything that dart type
 * `third` does: a gets `third` as partner, and b what that had. */
static bool visit_partners(exchange_visitor *visitor, int j, int a, int b, int third, thr_err *err,
                           thr_status *st)
{
  const thr_programme *programme = visitor->programme;
  int with = pair_between(programme, a, third, false), end = programme->first_end + third;
  if (with < 0) return true;

  /* Turns of the third dart type. */
  for (int k = programme->first[third]; k < programme->first[third + 1]; k++) {
    int pair = programme->first_pair + programme->incident[k];
    const thr_pair_type *pair_type = &programme->q->pair[programme->incident[k]];
    if (visitor->value[pair] <= 0) continue;
    int in = pair_type->self ? pair_between(programme, b, b, true)
                             : pair_between(programme, b,
                                            pair_type->dart[0] + pair_type->dart[1] - third, false);
    if (!offer_exchange(visitor, j, pair, with, in, a, third, err, st)) return false;
  }

  /* Ends of it. */
  return visitor->value[end] <= 0 || programme->most[programme->first_end + b] == 0 ||
         offer_exchange(visitor, j, end, with, programme->first_end + b, a, third, err, st);
}

/* Visits the exchanges of a turn with everything at its node that either of its dart types can turn
 * into. A self pair has none of its own. */
static thr_status visit_turn(exchange_visitor *visitor, int pair, thr_err *err)
{
  const thr_programme *programme = visitor->programme;
  const thr_pair_type *pair_type = &programme->q->pair[pair];
  thr_status st = THR_OK;
  bool go_on = !pair_type->self;
  /* Each dart type of the turn, with each type that it can turn into. */
  for (int i = 0; i < 2 && go_on; i++) {
    int own = pair_type->dart[i], partner = pair_type->dart[1 - i], last = -1;
    for (int k = programme->first[own]; k < programme->first[own + 1] && go_on; k++) {
      const thr_pair_type *other = &programme->q->pair[programme->incident[k]];
      int third = other->dart[0] + other->dart[1] - own;
      if (other->self || third == last)
        continue; /* pair types of two dart types follow each other */
      last = third;
      go_on = visit_partners(visitor, programme->first_pair + pair, own, partner, third, err, &st);
    }
  }

  return st;
}

/* ---- mending ---- */

/* Tells whether a connected set needs a terminal (an end, if every cord is open). */
static bool in_need(const exchange_visitor *visitor, int root)
{
  return (visitor->programme->open ? visitor->parts.ends : visitor->parts.terminals)[root] == 0;
}

/* Lists an exchange that would join two sets (a visit). */
static bool collect(exchange_visitor *visitor, const node_exchange *exchange, thr_err *err,
                    thr_status *st)
{
  const int *root = visitor->parts.root;
  if (root[exchange->type[1]] < 0 || root[exchange->type[1]] == root[exchange->type[0]])
    return true;
  *st = thr_grow(&visitor->list, visitor->n, &visitor->capacity, sizeof *visitor->list, err);
  if (!*st) visitor->list[visitor->n++] = *exchange;
  return !*st;
}

/* Compares exchanges by turning, then by their columns, so that the order is the same everywhere.
 */
static int by_turning(const void *a, const void *b)
{
  const node_exchange *first = a, *second = b;
  if (first->turning < second->turning || first->turning > second->turning)
    return first->turning < second->turning ? -1 : 1;

  for (int i = 0; i < 2; i++) {
    if (first->out[i] != second->out[i]) return first->out[i] < second->out[i] ? -1 : 1;
    if (first->in[i] != second->in[i]) return first->in[i] < second->in[i] ? -1 : 1;
  }
  return 0;
}

/* Applies an exchange that joins two sets if one of them needs a terminal. The sums of both stay
 * with the root. */
static void join_sets(exchange_visitor *visitor, const node_exchange *exchange)
{
  thr_programme_parts *parts = &visitor->parts;
  int first_set = thr_disjoint_find(parts->root, exchange->type[0]),
      second_set = thr_disjoint_find(parts->root, exchange->type[1]);
  if (first_set == second_set ||
      !is_possible(visitor->programme, exchange, visitor->value, visitor->parent) ||
      (!in_need(visitor, first_set) && !in_need(visitor, second_set)))
    return;

  /* Join the sets, and add up what they have. */
  int terminals = parts->terminals[first_set] + parts->terminals[second_set],
      ends = parts->ends[first_set] + parts->ends[second_set];
  apply_exchange(exchange, 1, visitor->value);
  thr_disjoint_join(parts->root, first_set, second_set);
  first_set = thr_disjoint_find(parts->root, first_set);
  parts->terminals[first_set] = terminals;
  parts->ends[first_set] = ends;
}

/* Counts the connected sets that need a terminal. */
static int count_in_need(const exchange_visitor *visitor)
{
  int n = 0;
  for (int d = 0; d < visitor->programme->q->n_darts; d++)
    n += visitor->parts.root[d] == d && in_need(visitor, d);
  return n;
}

/* Joins connected sets until every set has what it needs. A set without terminals stays connected
 * when a turn in it is broken up, so that its sets are certain to join. A set with folds may fall
 * apart and leave as many sets in need as before: then this ends. */
thr_status thr_programme_mend(const thr_programme *programme, int *value, thr_err *err)
{
  exchange_visitor visitor = {.visit = collect, .programme = programme, .value = value};
  thr_status st = visitor_init(&visitor, err);
  if (!st) st = thr_programme_parts_init(&visitor.parts, programme, err);

  /* Each round joins what it can. */
  for (int before = -1; !st;) {
    thr_programme_parts_find(&visitor.parts, programme, value);
    int now = count_in_need(&visitor);
    if (now == 0 || (before >= 0 && now >= before)) break;
    before = now;

    /* List the exchanges of the turns in sets that need a terminal, and apply them by ascending
     * turning. */
    visitor.n = 0;
    for (int pair = 0; pair < programme->q->n_pairs && !st; pair++) {
      int root = visitor.parts.root[programme->q->pair[pair].dart[0]];
      if (value[programme->first_pair + pair] > 0 && in_need(&visitor, root))
        st = visit_turn(&visitor, pair, err);
    }
    if (visitor.n > 0) qsort(visitor.list, (size_t)visitor.n, sizeof *visitor.list, by_turning);
    for (int i = 0; i < visitor.n && !st; i++)
      join_sets(&visitor, &visitor.list[i]);
  }

  thr_programme_parts_destroy(&visitor.parts);
  free(visitor.list);
  free(visitor.parent);
  return st;
}

thr_status thr_programme_open(const thr_programme *programme, int *value, thr_err *err)
{
  exchange_visitor visitor = {.programme = programme, .value = value};
  thr_programme_parts *parts = &visitor.parts;
  thr_status st = visitor_init(&visitor, err);
  if (!st) st = thr_programme_parts_init(parts, programme, err);
  if (!st) thr_programme_parts_find(parts, programme, value);

  /* One turn of each set without ends becomes two ends, where they are allowed. */
  for (int pair = 0; pair < programme->q->n_pairs && programme->open && !st; pair++) {
    const int *dart = programme->q->pair[pair].dart;
    int root = parts->root[dart[0]], star = programme->ties ? programme->ties->star[dart[0]] : -1,
        end[2] = {programme->first_end + dart[0], programme->first_end + dart[1]};
    if (value[programme->first_pair + pair] == 0 || programme->q->pair[pair].self ||
        parts->ends[root] > 0 || programme->most[end[0]] == 0)
      continue;

    value[programme->first_pair + pair]--;
    /* With tube joints only if the node stays tied without the turn. */
    if (star >= 0 &&
        !thr_ties_tied(programme->ties, star, value + programme->first_pair, visitor.parent)) {
      value[programme->first_pair + pair]++;
      continue;
    }

    value[end[0]]++;
    value[end[1]]++;
    parts->ends[root] += 2;
  }

  thr_programme_parts_destroy(parts);
  free(visitor.parent);
  return st;
}

/* ---- attempts ---- */

/* Calls the caller's function with the exchange applied, and takes it back (a visit). */
static bool call_attempt(exchange_visitor *visitor, const node_exchange *exchange, thr_err *err,
                         thr_status *st)
{
  if (visitor->level &&
      exchange->turning > thr_programme_tolerance(visitor->programme, THR_AIM_TURNING))
    return true;
  apply_exchange(exchange, 1, visitor->value);
  *st = visitor->attempt(visitor->user, err);
  apply_exchange(exchange, -1, visitor->value);
  return !*st;
}

thr_status thr_programme_attempt(const thr_programme *programme, int *value, bool level,
                                 thr_status (*attempt_one)(void *user, thr_err *err), void *user,
                                 thr_err *err)
{
  exchange_visitor visitor = {.visit = call_attempt,
                              .programme = programme,
                              .value = value,
                              .level = level,
                              .attempt = attempt_one,
                              .user = user};
  thr_status st = visitor_init(&visitor, err);

  for (int pair = 0; pair < programme->q->n_pairs && !st; pair++)
    if (value[programme->first_pair + pair] > 0) st = visit_turn(&visitor, pair, err);

  free(visitor.parent);
  return st;
}
