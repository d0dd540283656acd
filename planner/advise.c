/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many cords, and from where: a plan for every number of cords and kind of ends that may be
 * worth it, and a choice among them.
 *
 *   thr_advice advice;
 *   thr_status st = thr_advise(&frame, &request, &(thr_advise_options){.hand = thr_hand_always},
 * &limits, &advice, &err); if (!st && advice.chosen >= 0) printf("%d cords\n",
 * advice.row[advice.chosen].cords); thr_advice_destroy(&advice);
 *
 * Rows of advice: plans for more and more cords, each from the cords of the plan with one, cut
 * evenly, or from symmetric cords.
 */
#include "graph/framework/components.h"
#include "graph/plan/physics.h"
#include "planner/planner_parts.h"
#include "symmetry/group/group.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the time that is left. */
static const double part_group = 0.05, part_symmetric = 0.15, part_first = 0.15, part_row = 0.1;

static const double little = 1.05;    /* less of the pull than this buys nothing */
static const double slack_pull = 1.1; /* over the seating tension: there is nothing left to win */

enum { MOST_ORDER = 240, IDLE = 2, TIMES = 4, MOST_SEARCHED = 5000 }; /* edges */

/* Plans with ends of one kind. */
typedef struct {
  thr_ends ends;
  thr_plan first; /* with one cord in every component */
  thr_parts cuts; /* of first, where no cord needs to be looked at; empty until it is asked for */
  thr_symmetries symmetries; /* with these ends */
  bool over;                 /* no more cords than were tried have a plan */
  double pull;               /* least so far, N at mu */
  int idle;                  /* numbers of cords in a row that bought nothing */
} kind;

typedef struct {
  const thr_frame *frame;
  thr_request request;
  const thr_limits *limits;
  const thr_advise_options *options;
  thr_group group; /* of automorphisms; of order 0 if it is not known */
  int room;        /* for rows */
  bool searches;   /* is the framework, of few components, small enough for searches? */
  thr_advice *out;
} adviser;

/* ---- learned steps ---- */

/* Does the image of cord a run as cord b does, one way or the other? The framework has one edge at
 * most between two nodes. */
static bool is_image(const thr_frame *frame, const int *image, const thr_cord *a, const thr_cord *b)
{
  int n = a->n_passes;
  if (b->n_passes != n) return false;
  bool forwards = image[thr_cord_start(frame, a)] == thr_cord_start(frame, b);
  bool backwards = image[thr_cord_start(frame, a)] == thr_cord_end(frame, b);
  for (int k = 0; k < n && (forwards || backwards); k++) {
    int node = image[thr_head(frame, a->half[k])];
    forwards &= node == thr_head(frame, b->half[k]);
    backwards &= node == thr_tail(frame, b->half[n - 1 - k]);
  }
  return forwards || backwards;
}

static bool is_copy(const adviser *x, const thr_cord *cord, const thr_cord *earlier)
{
  for (int g = 1; g < x->group.order; g++)
    if (is_image(x->frame, x->group.image + (size_t)g * (size_t)x->group.degree, earlier, cord))
      return true;
  return false;
}

/* Passes of the cords that are copies of none before them, and their ends where those may be
 * anywhere. */
static int learned(const adviser *x, const thr_plan *plan)
{
  const thr_cord *cord = plan->cord;
  const int n = plan->n_cords, ends = plan->options.ends == THR_ENDS_ANY ? 2 : 0;
  int steps = 0;
  for (int i = 0; i < n; i++) {
    bool copy = false;
    for (int j = 0; j < i && !copy; j++)
      copy = is_copy(x, &cord[i], &cord[j]);
    if (!copy) steps += cord[i].n_passes + (cord[i].closed ? 0 : ends);
  }
  return steps;
}

static thr_status find_group(adviser *x, thr_err *err)
{
  const thr_automorphism_options all_alike = {0};
  const thr_limits share = thr_limits_part(x->limits, part_group);
  thr_automorphisms found = {0};
  thr_err why = {0};
  bool all;
  thr_status st = thr_automorphisms_within(x->frame, &all_alike, &share, &all, &found, &why);
  if (!st && all && found.exponent == 0 && found.mantissa <= MOST_ORDER)
    st = thr_group_generate(found.n, found.generator, found.n_generators, MOST_ORDER, &x->group,
                            &why);
  thr_automorphisms_destroy(&found);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* without a group every cord is learned */
}

/* ---- rows ---- */

static thr_advice_row *find_row(const adviser *x, const kind *k, int cords)
{
  for (int i = 0; i < x->out->n; i++)
    if (x->out->row[i].ends == k->ends && x->out->row[i].cords == cords) return &x->out->row[i];
  return NULL;
}

static thr_status new_row(adviser *x, thr_advice_row **row, thr_err *err)
{
  thr_advice *out = x->out;
  if (out->n == x->room) {
    int room = 2 * x->room + 16;
    thr_advice_row *more = thr_realloc(out->row, (size_t)room, sizeof *more);
    if (!more) return thr_nomem(err);
    out->row = more;
    x->room = room;
  }
  *row = &out->row[out->n++];
  **row = (thr_advice_row){.turning = INFINITY};
  return THR_OK;
}

/* Sets what the ends of the cord that is hardest to pull take. reach, other: rad that they have to
 * overcome. */
static void set_pulls(const adviser *x, double reach, double other, thr_advice_row *row)
{
  double pull[THR_ADVICE_PULLS];
  thr_advice_pulls(&x->out->physics, other, pull);
  row->other = pull[THR_ADVICE_MU];
  thr_advice_pulls(&x->out->physics, reach, row->pull);
}

static void measure_row(adviser *x, const kind *k, const thr_plan *plan, thr_advice_row *row)
{
  double other, reach = thr_cords_pulled_turnings(x->frame, plan->cord, plan->n_cords, &other);
  row->ends = k->ends;
  row->cords = plan->options.cords;
  row->all = plan->n_cords;
  row->length = plan->metrics.length;
  row->longest = thr_cords_longest(x->frame, plan->cord, plan->n_cords);
  row->turning = plan->metrics.max_turning;
  row->passes = plan->metrics.passes;
  row->steps = learned(x, plan);
  set_pulls(x, reach, other, row);
  x->out->base_length = plan->metrics.base_length;
}

/* The row of cuts->plan cut into so many: what measure_row would say of the cords, none of which is
 * a copy. */
static void measure_cuts(adviser *x, const kind *k, int cords, thr_advice_row *row)
{
  const thr_metrics *whole = &k->first.metrics;
  const thr_parts_measures m = thr_parts_measure(&k->cuts);
  const int ends = k->ends == THR_ENDS_ANY ? 2 * k->first.n_cords * cords : 0;
  *row = (thr_advice_row){.ends = k->ends,
                          .cords = cords,
                          .all = cords * k->first.n_cords,
                          .length = whole->length,
                          .longest = m.longest,
                          .turning = m.turning,
                          .passes = whole->passes,
                          .steps = whole->passes + ends};
  set_pulls(x, m.pulled, m.other, row);
}

/* Looks what the row buys, and tells it. */
static void settle_row(adviser *x, kind *k, bool added, thr_advice_row *row, const thr_plan *plan)
{
  row->optimal = row->turning <= row->bound * (1 + 1e-9);
  if (added) k->idle = row->pull[THR_ADVICE_MU] * little < k->pull ? 0 : k->idle + 1;
  k->pull = fmin(k->pull, row->pull[THR_ADVICE_MU]);
  if (x->options->row) x->options->row(x->options->user, row, plan);
}

/* A row for the cords of plan, or in the place of a row whose cord that turns most turns more.
 * claim: NULL = they were not searched. */
static thr_status set_row(adviser *x, kind *k, const thr_plan *plan, const thr_turning_claim *claim,
                          thr_err *err)
{
  thr_advice_row *row = find_row(x, k, plan->options.cords);
  bool added = !row;
  thr_status st = added ? new_row(x, &row, err) : THR_OK;
  if (st) return st;
  const bool better = plan->metrics.max_turning < row->turning;
  if (better) measure_row(x, k, plan, row);
  if (claim && claim->present) row->bound = fmax(row->bound, claim->largest_bound);
  row->searched |= claim != NULL;
  settle_row(x, k, added, row, better ? plan : NULL);
  return THR_OK;
}

/* The fewest cords that stay within the hand; 0 = none do. */
static int within(const adviser *x, const kind *k)
{
  int fewest = 0;
  for (int i = 0; i < x->out->n; i++) {
    const thr_advice_row *row = &x->out->row[i];
    if (row->ends == k->ends && thr_advice_within(x->out, row) && (!fewest || row->cords < fewest))
      fewest = row->cords;
  }
  return fewest;
}

/* The most cords that do not, of fewer than that. */
static int beyond(const adviser *x, const kind *k, int fewest)
{
  int most = 0;
  for (int i = 0; i < x->out->n; i++) {
    const thr_advice_row *row = &x->out->row[i];
    if (row->ends == k->ends && row->cords < fewest && row->cords > most) most = row->cords;
  }
  return most;
}

static thr_request request_of(const adviser *x, const kind *k, int cords)
{
  thr_request request = x->request;
  request.ends = k->ends;
  request.cords = request.cords_least = cords;
  return request;
}

/* The better of the cords cut from one, and of the symmetric ones if there are any of that number.
 * It may stay empty. */
static thr_status find_seed(const adviser *x, kind *k, const thr_request *request,
                            const thr_limits *limits, thr_plan *seed, thr_err *err)
{
  thr_plan symmetric = {0};
  thr_err why = {0};
  int row = thr_symmetries_even(&k->symmetries, request->cords);
  thr_request plain = *request;
  plain.aims = thr_aims_symmetric;
  thr_status st = request->cords > 1 ? thr_cut_seed(&k->first, request, seed, err) : THR_OK;
  if (!st && row >= 0)
    st = thr_symmetries_plan(&k->symmetries, row, x->frame, &plain, limits, &symmetric, &why);
  if (symmetric.n_cords > 0 && (seed->n_cords == 0 || symmetric.metrics.max_turning <=
                                                          seed->metrics.max_turning * (1 + 1e-9))) {
    thr_plan cut = *seed;
    *seed = symmetric;
    symmetric = cut;
  }
  thr_plan_destroy(&symmetric);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* A row without a search where no cords can be copies, or symmetric: without looking at the cords
 * themselves. */
static thr_status cut_large(adviser *x, kind *k, int cords, thr_err *err)
{
  const thr_request request = request_of(x, k, cords);
  thr_advice_row *row;
  thr_status st = k->cuts.plan ? THR_OK : thr_parts_open(&k->cuts, &k->first, &request, err);
  if (st || find_row(x, k, cords) || !thr_parts_into(&k->cuts, cords)) return st;
  if ((st = new_row(x, &row, err))) return st;
  measure_cuts(x, k, cords, row);
  settle_row(x, k, true, row, NULL);
  return THR_OK;
}

/* A row without a search, if there are cords for one. */
static thr_status cut_cords(adviser *x, kind *k, int cords, thr_err *err)
{
  if (!x->searches) return cut_large(x, k, cords, err);
  const thr_request request = request_of(x, k, cords);
  thr_plan seed = {0};
  thr_status st = find_seed(x, k, &request, x->limits, &seed, err);
  if (!st && seed.n_cords > 0) st = set_row(x, k, &seed, NULL, err);
  thr_plan_destroy(&seed);
  return st;
}

/* A row by a search, from the cords that there are without one. */
static thr_status search_cords(adviser *x, kind *k, int cords, double part, thr_err *err)
{
  const thr_request request = request_of(x, k, cords);
  const thr_limits share = thr_limits_part(x->limits, part);
  thr_plan seed = {0}, plan = {0};
  thr_err why = {0};
  thr_status st = find_seed(x, k, &request, &share, &seed, err);
  if (!st)
    st = thr_tortuosity_plan_from(x->frame, &request, seed.n_cords ? &seed : NULL, &share, &plan,
                                  &why);
  if (st == THR_ENOMEM)
    st = thr_nomem(err);
  else
    st = THR_OK;
  if (!st && plan.n_cords > 0) st = set_row(x, k, &plan, &plan.turning, err);
  thr_advice_row *row = find_row(x, k, cords);
  if (row) row->searched = true;
  k->over |= !row;
  if (!st && cords == 1 && plan.n_cords > 0) {
    k->first = plan;
    plan = (thr_plan){0};
  }
  thr_plan_destroy(&plan);
  thr_plan_destroy(&seed);
  return st;
}

/* ---- closed cords opened ---- */

/* The plan with one closed cord is one with both ends at a node: it takes the place of the first if
 * that turns more. */
static thr_status take_closed(adviser *x, kind *k, const thr_plan *closed, thr_err *err)
{
  const thr_request request = request_of(x, k, 1);
  thr_plan opened = {0};
  thr_status st = thr_cut_open(x->frame, &request, closed, &opened, err);
  if (!st && opened.n_cords > 0 &&
      (k->first.n_cords == 0 || opened.metrics.max_turning < k->first.metrics.max_turning)) {
    thr_plan before = k->first;
    k->first = opened;
    opened = before;
    st = set_row(x, k, &k->first, NULL, err);
  }
  thr_plan_destroy(&opened);
  return st;
}

/* ---- which ---- */

static thr_status find_symmetric(const adviser *x, kind *k, thr_err *err)
{
  const thr_limits share = thr_limits_part(x->limits, part_symmetric);
  thr_request request = request_of(x, k, 1);
  thr_err why = {0};
  request.aims = thr_aims_symmetric;
  thr_status st = thr_symmetries_find(x->frame, &request, false, &share, &k->symmetries, &why);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves no rows */
}

/* 1, 2, 3, 4, 6, 8, 12, 16, 24, .. */
static int next_number(int cords)
{
  int power = 1;
  while (2 * power <= cords)
    power *= 2;
  return cords < 4 ? cords + 1 : power == cords ? cords + cords / 2 : 2 * power;
}

static bool is_over(const adviser *x, const kind *k, int cords)
{
  int fewest = within(x, k);
  return k->over || k->idle >= IDLE || k->pull <= slack_pull * x->out->physics.seating ||
         cords > x->frame->n_edges || cords > THR_MOST_CORDS || (fewest && cords > TIMES * fewest);
}

/* The time is over: what was to be tried still is not. */
static bool stopped(adviser *x)
{
  bool stop = thr_limits_stop(x->limits);
  x->out->complete &= !stop;
  return stop;
}

/* Rows without a search: all numbers in turn, and where the hand is enough first, by halves. */
static thr_status cut_numbers(adviser *x, kind *k, thr_err *err)
{
  thr_status st = THR_OK;
  bool some = true;
  for (int cords = 2; !st && some && !is_over(x, k, cords); cords = next_number(cords)) {
    st = cut_cords(x, k, cords, err);
    some = find_row(x, k, cords) != NULL;
  }
  while (!st && some) {
    int fewest = within(x, k), most = beyond(x, k, fewest), cords = (fewest + most) / 2;
    if (fewest - most < 2) break;
    st = cut_cords(x, k, cords, err);
    some = find_row(x, k, cords) != NULL;
  }
  return st;
}

/* The fewest that stay within the hand, and one fewer as long as a search finds that they do, too.
 */
static thr_status search_fewest(adviser *x, kind *k, thr_err *err)
{
  int fewest = within(x, k);
  thr_status st = fewest > 1 ? search_cords(x, k, fewest, part_row, err) : THR_OK;
  for (int cords = fewest - 1; !st && cords > 1 && within(x, k) == cords + 1 && !stopped(x);
       cords--)
    st = search_cords(x, k, cords, part_row, err);
  return st;
}

/* Of rows that wait for a search, and of the time, so that each has as much. */
static double part_of_rows(const adviser *x)
{
  int waiting = 0;
  for (int i = 0; i < x->out->n; i++)
    waiting += !x->out->row[i].searched;
  return fmin(part_row, 1.0 / (waiting + 2));
}

/* Searches for all numbers that are not over, with ends of all kinds side by side. */
static thr_status search_numbers(adviser *x, kind *k, int n_kinds, thr_err *err)
{
  thr_status st = THR_OK;
  bool some = true;
  for (int cords = 2; !st && some; cords = next_number(cords)) {
    some = false;
    for (int i = 0; i < n_kinds && !st; i++) {
      const thr_advice_row *row = find_row(x, &k[i], cords);
      if (!row && is_over(x, &k[i], cords)) continue;
      some = true;
      if (row && (row->searched || row->optimal)) continue;
      if (stopped(x)) return THR_OK;
      st = search_cords(x, &k[i], cords, part_of_rows(x), err);
    }
  }
  return st;
}

static void kind_destroy(kind *k)
{
  thr_plan_destroy(&k->first);
  thr_parts_destroy(&k->cuts);
  thr_symmetries_destroy(&k->symmetries);
}

static thr_status try_first(adviser *x, kind *k, const thr_plan *closed, thr_err *err)
{
  thr_status st = search_cords(x, k, 1, part_first, err);
  if (!st) st = take_closed(x, k, closed, err);
  k->over = !find_row(x, k, 1);
  return !st && !k->over ? find_symmetric(x, k, err) : st;
}

static thr_status cut_plan(adviser *x, kind *k, const thr_plan *plan, thr_err *err)
{
  thr_status st = take_closed(x, k, plan, err);
  return st || !find_row(x, k, 1) ? st : cut_numbers(x, k, err);
}

static thr_status search_all(adviser *x, kind *k, int n_kinds, thr_err *err)
{
  kind closed = {.ends = THR_ENDS_CLOSED, .pull = INFINITY};
  thr_status st = find_group(x, err);
  if (!st) st = search_cords(x, &closed, 1, part_first, err);
  for (int i = 0; i < n_kinds && !st; i++)
    st = try_first(x, &k[i], &closed.first, err);
  for (int i = 0; i < n_kinds && !st; i++)
    st = cut_numbers(x, &k[i], err);
  for (int i = 0; i < n_kinds && !st; i++)
    st = search_fewest(x, &k[i], err);
  kind_destroy(&closed);
  return st ? st : search_numbers(x, k, n_kinds, err);
}

/* Of a framework that is too large for searches the shortest closed cords are cut. */
static thr_status cut_shortest(adviser *x, kind *k, int n_kinds, const thr_plan *plan, thr_err *err)
{
  thr_request request = x->request;
  thr_plan shortest = {0};
  request.aims = thr_aims_shortest;
  thr_status st =
      plan ? THR_OK : thr_plan_make(x->frame, &request, x->limits, &shortest, NULL, err);
  if (st == THR_ELIMIT && shortest.n_cords > 0) st = THR_OK; /* not proved, but cords */
  for (int i = 0; i < n_kinds && !st; i++)
    st = cut_plan(x, &k[i], plan ? plan : &shortest, err);
  thr_plan_destroy(&shortest);
  return st;
}

/* Appends the rows of a framework of one component, or of all components alike. */
static thr_status find_rows(const thr_frame *frame, const thr_request *request,
                            const thr_advise_options *options, bool searches,
                            const thr_limits *limits, thr_advice *out, thr_err *err)
{
  adviser x = {.frame = frame,
               .request = thr_request_default(),
               .limits = limits,
               .options = options,
               .out = out};
  kind k[2] = {{.ends = THR_ENDS_ANY, .pull = INFINITY}};
  int n_kinds = 1;
  bool feet = false;
  for (int v = 0; v < frame->n_nodes; v++)
    feet |= frame->foot[v];
  if (feet) {
    k[1] = k[0];
    k[0].ends = THR_ENDS_FEET;
    n_kinds = 2;
  }
  x.request.aims = (thr_aims){.n = 1, .aim = {THR_AIM_MAX_TURNING}};
  x.request.cover = request->cover;
  x.request.capacity = request->capacity;
  x.request.physics = request->physics;
  x.searches = searches && frame->n_edges <= MOST_SEARCHED;
  thr_status st = x.searches ? search_all(&x, k, n_kinds, err)
                             : cut_shortest(&x, k, n_kinds, options->plan, err);
  if (!st && out->n == 0)
    st = thr_fail(err, stopped(&x) ? THR_ELIMIT : THR_EINFEASIBLE,
                  "no threading with one cord or more was found");
  for (int i = 0; i < n_kinds; i++)
    kind_destroy(&k[i]);
  thr_group_destroy(&x.group);
  return st;
}

/* ---- several components ---- */

/* Returns the row of the least pull with no more cords than that, and that of the fewest cords with
 * no more pull; NULL: there is none. */
static const thr_advice_row *least_pull_row(const thr_advice *of, thr_ends ends, int cords)
{
  const thr_advice_row *best = NULL;
  for (int i = 0; i < of->n; i++) {
    const thr_advice_row *row = &of->row[i];
    if (row->ends != ends || row->cords > cords) continue;
    if (!best || row->pull[THR_ADVICE_MU] < best->pull[THR_ADVICE_MU]) best = row;
  }
  return best;
}

static const thr_advice_row *fewest_cords_row(const thr_advice *of, thr_ends ends, double pull)
{
  const thr_advice_row *best = NULL;
  for (int i = 0; i < of->n; i++) {
    const thr_advice_row *row = &of->row[i];
    if (row->ends != ends || row->pull[THR_ADVICE_MU] > pull * (1 + 1e-9)) continue;
    if (!best || row->cords < best->cords) best = row;
  }
  return best;
}

/* Adds what a component's row costs to that of all. */
static void add_to_row(thr_advice_row *sum, const thr_advice_row *row)
{
  sum->uneven |= sum->all > 0 && sum->cords != row->cords;
  sum->cords = row->cords > sum->cords ? row->cords : sum->cords;
  sum->all += row->all;
  sum->length += row->length;
  sum->longest = fmax(sum->longest, row->longest);
  sum->turning = fmax(sum->turning, row->turning);
  sum->bound = fmax(sum->bound, row->bound);
  sum->searched &= row->searched;
  sum->passes += row->passes;
  sum->steps += row->steps;
  if (row->pull[THR_ADVICE_MU] > sum->pull[THR_ADVICE_MU]) sum->other = row->other;
  for (int i = 0; i < THR_ADVICE_PULLS; i++)
    sum->pull[i] = fmax(sum->pull[i], row->pull[i]);
}

/* Makes the row of at most so many cords in every component: each has as few as the pull of the one
 * that is hardest allows. False: some component has no such cords. */
static bool join_row(const thr_advice *part, int n, thr_ends ends, int cords, thr_advice_row *sum)
{
  double pull = 0;
  *sum = (thr_advice_row){.ends = ends, .searched = true};
  for (int k = 0; k < n; k++) {
    const thr_advice_row *row = least_pull_row(&part[k], ends, cords);
    if (!row) return false;
    pull = fmax(pull, row->pull[THR_ADVICE_MU]);
  }
  for (int k = 0; k < n; k++)
    add_to_row(sum, fewest_cords_row(&part[k], ends, pull));
  sum->optimal = sum->turning <= sum->bound * (1 + 1e-9);
  return true;
}

/* Joins the rows of all components: one for every number of cords that some component has a row of.
 */
static thr_status join_rows(const thr_advice *part, int n, const thr_advise_options *options,
                            thr_advice *out, thr_err *err)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_FEET, THR_ENDS_ANY};
  bool *has = thr_calloc(THR_MOST_CORDS + 1, sizeof *has);
  adviser x = {.options = options, .out = out};
  thr_status st = has ? THR_OK : thr_nomem(err);
  for (int i = 0; i < 3 && !st; i++) {
    memset(has, 0, (THR_MOST_CORDS + 1) * sizeof *has);
    for (int k = 0; k < n; k++)
      for (int j = 0; j < part[k].n; j++)
        has[part[k].row[j].cords] |= part[k].row[j].ends == ends[i];
    int last = 0;
    for (int cords = 1; cords <= THR_MOST_CORDS && !st; cords++) {
      thr_advice_row sum, *row;
      if (!has[cords] || !join_row(part, n, ends[i], cords, &sum) || sum.cords == last) continue;
      if ((st = new_row(&x, &row, err))) break;
      *row = sum;
      last = sum.cords;
      if (options->row) options->row(options->user, row, NULL);
    }
  }
  free(has);
  return st;
}

/* Finds rows component by component, as one needs more cords than another. */
static thr_status find_by_components(const thr_components *components, const thr_request *request,
                                     const thr_advise_options *options, const thr_limits *limits,
                                     thr_advice *out, thr_err *err)
{
  enum { MOST_COMPONENTS = 20 }; /* that are searched */
  const thr_advise_options quiet = {.hand = options->hand};
  const int n = components->n, *first = components->first_edge;
  thr_advice *part = thr_calloc((size_t)n, sizeof *part);
  thr_status st = part ? THR_OK : thr_nomem(err);
  for (int k = 0; k < n && !st; k++) {
    const thr_limits share =
        thr_limits_part(limits, (double)(first[k + 1] - first[k]) / (first[n] - first[k]));
    thr_plan asked;
    if ((st = thr_component_take(components, k, &asked, err))) break;
    part[k] = (thr_advice){.physics = out->physics, .hand = options->hand, .complete = true};
    st = find_rows(&asked.frame, request, &quiet, n <= MOST_COMPONENTS, &share, &part[k], err);
    out->base_length += part[k].base_length;
    out->complete &= part[k].complete;
    thr_plan_destroy(&asked);
  }
  if (!st) st = join_rows(part, n, options, out, err);
  for (int k = 0; part && k < n; k++)
    thr_advice_destroy(&part[k]);
  free(part);
  return st;
}

thr_status thr_advise(const thr_frame *frame, const thr_request *request,
                      const thr_advise_options *options, const thr_limits *limits, thr_advice *out,
                      thr_err *err)
{
  thr_components components = {0};
  *out = (thr_advice){.hand = options->hand, .complete = true, .chosen = -1};
  thr_status st = thr_physics_resolve(&request->physics, frame, &out->physics, err);
  if (!st) st = thr_components_init(&components, frame, request, err);
  if (!st && components.n == 1)
    st = find_rows(frame, request, options, true, limits, out, err);
  else if (!st)
    st = find_by_components(&components, request, options, limits, out, err);
  if (!st) thr_advice_settle(out);
  thr_components_destroy(&components);
  if (st) thr_advice_destroy(out);
  return st;
}
