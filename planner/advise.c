/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Advises how many cords to take, and where they should end: makes a plan for every number of
 * cords and kind of ends that may pay, as rows of a table, and chooses one of the rows
 * (graph/plan/plan_measures.h).
 *
 * Each row starts from the plan with one cord in every component, cut evenly, or from symmetric
 * cords; these rows take a tenth of the time and are told first. Then comes the plan that is
 * recommended, and then a search for every row as far as the time allows. Numbers grow as 1, 2, 3,
 * 4, 6, 8, 12, .. until more cords no longer lower the pull. Frameworks of many edges or components
 * are cut only. Several components get rows of their own, which are joined: each component takes as
 * few cords as the pull of the hardest one allows.
 *
 * Example: thr_advise(&frame, &request, &(thr_advise_options){.hand = thr_hand_always}, &limits,
 * &advice, &err) leaves the chosen row in advice.row[advice.chosen], or advice.chosen = -1 where
 * there is none; release with thr_advice_destroy(&advice). */
#include "graph/framework/components.h"
#include "graph/plan/physics.h"
#include "planner/planner_parts.h"
#include "symmetry/group/group.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double thr_advise_work = 0.3;

/* Of the time that is left. */
static const double part_group = 0.05, part_symmetric = 0.15, part_first = 0.15, part_row = 0.1;

static const double little = 1.05;    /* less of the pull than this buys nothing */
static const double slack_pull = 1.1; /* over the seating tension: there is nothing left to win */

enum { MOST_ORDER = 240, IDLE = 2, TIMES = 4, MOST_SEARCHED = 5000 }; /* edges */

/* Plans with ends of one kind. */
typedef struct {
  thr_ends ends;
  thr_plan first;            /* with one cord in every component */
  thr_symmetries symmetries; /* with these ends */
  bool over;                 /* no more cords than were tried have a plan */
  double pull;               /* least so far, N at mu */
  int idle;                  /* numbers of cords in a row that bought nothing */
} ends_kind;

typedef struct {
  const thr_frame *frame;
  thr_request request;
  const thr_limits *limits;
  const thr_advise_options *options;
  thr_group group; /* of automorphisms; of order 0 if it is not known */
  int room;        /* for rows */
  bool searches;   /* is the framework, of few components, small enough for searches? */
  thr_advice *out;
  thr_plan *promised; /* what is recommended, empty until it is made (make_promised); borrowed */
} advice_search;

/* Returns what rows ask for: little turning of the cord that turns most. Of the request only cover,
 * capacity and physics count. */
static thr_request row_request(const thr_request *request)
{
  thr_request asked = thr_request_default();
  asked.aims = (thr_aims){.n = 1, .aim = {THR_AIM_MAX_TURNING}};
  asked.cover = request->cover;
  asked.capacity = request->capacity;
  asked.physics = request->physics;
  return asked;
}

/* ---- learned steps ---- */

/* Does the image of cord a run as cord b does, one way or the other? The framework has one edge at
 * most between two nodes. */
static bool is_image(const thr_frame *frame, const int *image, const thr_cord *a, const thr_cord *b)
{
  int n = a->n_passes;
  if (b->n_passes != n) return false;

  bool forwards = image[thr_cord_start(frame, a)] == thr_cord_start(frame, b);
  bool backwards = image[thr_cord_start(frame, a)] == thr_cord_end(frame, b);

  /* Follow both cords pass by pass, as long as one of the two directions still agrees. */
  for (int k = 0; k < n && (forwards || backwards); k++) {
    int node = image[thr_head(frame, a->half[k])];
    forwards &= node == thr_head(frame, b->half[k]);
    backwards &= node == thr_tail(frame, b->half[n - 1 - k]);
  }
  return forwards || backwards;
}

/* Tells whether cord is the image of the earlier cord under one of the automorphisms. */
static bool is_copy(const advice_search *adviser, const thr_cord *cord, const thr_cord *earlier)
{
  for (int g = 1; g < adviser->group.order; g++)
    if (is_image(adviser->frame, adviser->group.image + (size_t)g * (size_t)adviser->group.degree,
                 earlier, cord))
      return true;
  return false;
}

/* Counts the steps to learn: the passes of the cords that are copies of none before them, and their
 * ends where cords may end anywhere. */
static int learned(const advice_search *adviser, const thr_plan *plan)
{
  const thr_cord *cord = plan->cord;
  const int n = plan->n_cords, ends = plan->options.ends == THR_ENDS_ANY ? 2 : 0;
  int steps = 0;

  for (int i = 0; i < n; i++) {
    bool copy = false;
    for (int j = 0; j < i && !copy; j++)
      copy = is_copy(adviser, &cord[i], &cord[j]);
    if (!copy) steps += cord[i].n_passes + (cord[i].closed ? 0 : ends);
  }
  return steps;
}

/* Finds the group of all automorphisms if the group is small; else every cord counts as learned. */
static thr_status find_group(advice_search *adviser, thr_err *err)
{
  const thr_automorphism_options all_alike = {0};
  const thr_limits share = thr_limits_part(adviser->limits, part_group);
  thr_automorphisms found = {0};
  thr_err why = {0};
  bool all;

  thr_status st = thr_automorphisms_within(adviser->frame, &all_alike, &share, &all, &found, &why);
  if (!st && all && found.exponent == 0 && found.mantissa <= MOST_ORDER)
    st = thr_group_generate(found.n, found.generator, found.n_generators, MOST_ORDER,
                            &adviser->group, &why);

  thr_automorphisms_destroy(&found);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* without a group every cord is learned */
}

/* ---- rows ---- */

static thr_advice_row *find_row(const advice_search *adviser, const ends_kind *kind, int cords)
{
  for (int i = 0; i < adviser->out->n; i++)
    if (adviser->out->row[i].ends == kind->ends && adviser->out->row[i].cords == cords)
      return &adviser->out->row[i];
  return NULL;
}

/* Appends an empty row, and makes space for more rows where the array is full. */
static thr_status new_row(advice_search *adviser, thr_advice_row **row, thr_err *err)
{
  thr_advice *out = adviser->out;

  if (out->n == adviser->room) {
    int room = 2 * adviser->room + 16;
    thr_advice_row *more = thr_realloc(out->row, (size_t)room, sizeof *more);
    if (!more) return thr_nomem(err);
    out->row = more;
    adviser->room = room;
  }

  *row = &out->row[out->n++];
  **row = (thr_advice_row){.turning = INFINITY};
  return THR_OK;
}

/* Fills a row with the cords of the plan and with what they measure. */
static thr_status measure_row(advice_search *adviser, const ends_kind *kind, const thr_plan *plan,
                              thr_advice_row *row, thr_err *err)
{
  double other, pull[THR_ADVICE_PULLS];
  const double reach = thr_cords_pulled_turnings(adviser->frame, plan->cord, plan->n_cords, &other);

  thr_cords_destroy(row->cord, row->all);
  const thr_status st = thr_cords_copy(plan->cord, plan->n_cords, &row->cord, err);
  if (st) return st;

  row->ends = kind->ends;
  row->cords = plan->options.cords;
  row->all = plan->n_cords;
  row->length = plan->metrics.length;
  row->longest = thr_cords_longest(adviser->frame, plan->cord, plan->n_cords);
  row->turning = plan->metrics.max_turning;
  row->passes = plan->metrics.passes;
  row->steps = learned(adviser, plan);

  /* What the ends of the cord take that is hardest to pull. */
  thr_advice_pulls(&adviser->out->physics, other, pull);
  row->other = pull[THR_ADVICE_MU];
  thr_advice_pulls(&adviser->out->physics, reach, row->pull);
  adviser->out->base_length = plan->metrics.base_length;
  return THR_OK;
}

/* Looks what the row buys, and tells it. */
static void settle_row(advice_search *adviser, ends_kind *kind, bool added, thr_advice_row *row)
{
  row->optimal = row->turning <= row->bound * (1 + 1e-9);

  /* Count the rows in sequence that lowered the pull too little. */
  if (added) kind->idle = row->pull[THR_ADVICE_MU] * little < kind->pull ? 0 : kind->idle + 1;
  kind->pull = fmin(kind->pull, row->pull[THR_ADVICE_MU]);
  if (adviser->options->row) adviser->options->row(adviser->options->user, row);
}

/* Adds a row for the cords of plan, or improves the row of this number if the cord that turns most
 * turns less, by a larger part than all cords are longer. Cords without overlap give way to no
 * others. claim: NULL = the cords were not searched. */
static thr_status set_row(advice_search *adviser, ends_kind *kind, const thr_plan *plan,
                          const thr_turning_claim *claim, thr_err *err)
{
  thr_advice_row *row = find_row(adviser, kind, plan->options.cords);
  bool added = !row;

  thr_status st = added ? new_row(adviser, &row, err) : THR_OK;
  if (st) return st;

  /* The row keeps the better cords, and the better of the bounds. */
  const thr_metrics *metrics = &plan->metrics;
  const bool bare = row->length <= metrics->base_length * (1 + 1e-9);
  const bool better =
      added || ((!bare || metrics->length <= row->length * (1 + 1e-9)) &&
                metrics->max_turning * metrics->length < row->turning * row->length);
  if (better && (st = measure_row(adviser, kind, plan, row, err))) return st;
  if (claim && claim->present) row->bound = fmax(row->bound, claim->largest_bound);
  row->searched |= claim != NULL;

  settle_row(adviser, kind, added, row);
  return THR_OK;
}

/* Returns the fewest cords that stay within the hand's force; 0 = none do. */
static int within(const advice_search *adviser, const ends_kind *kind)
{
  int fewest = 0;
  for (int i = 0; i < adviser->out->n; i++) {
    const thr_advice_row *row = &adviser->out->row[i];
    if (row->ends == kind->ends && thr_advice_within(adviser->out, row) &&
        (!fewest || row->cords < fewest))
      fewest = row->cords;
  }
  return fewest;
}

/* Returns the most cords, fewer than `fewest`, that have a row. */
static int beyond(const advice_search *adviser, const ends_kind *kind, int fewest)
{
  int most = 0;
  for (int i = 0; i < adviser->out->n; i++) {
    const thr_advice_row *row = &adviser->out->row[i];
    if (row->ends == kind->ends && row->cords < fewest && row->cords > most) most = row->cords;
  }
  return most;
}

static thr_request request_of(const advice_search *adviser, const ends_kind *kind, int cords)
{
  thr_request request = adviser->request;
  request.ends = kind->ends;
  request.cords = request.cords_least = cords;
  return request;
}

/* Takes the better of the cords cut from one cord, and of the symmetric ones if there are any of
 * this number. seed may stay empty. */
static thr_status find_seed(const advice_search *adviser, ends_kind *kind,
                            const thr_request *request, const thr_limits *limits, thr_plan *seed,
                            thr_err *err)
{
  thr_plan symmetric = {0};
  thr_err why = {0};

  int row = thr_symmetries_even(&kind->symmetries, request->cords);
  thr_request plain = *request;
  plain.aims = thr_aims_symmetric;

  /* Cut the plan with one cord evenly, and take the symmetric row of this number. */
  thr_status st = request->cords > 1 ? thr_cut_seed(&kind->first, request, seed, err) : THR_OK;
  if (!st && row >= 0)
    st = thr_symmetries_plan(&kind->symmetries, row, adviser->frame, &plain, limits, &symmetric,
                             &why);

  /* The symmetric cords win ties, because they are easier to learn. */
  if (symmetric.n_cords > 0 && (seed->n_cords == 0 || symmetric.metrics.max_turning <=
                                                          seed->metrics.max_turning * (1 + 1e-9))) {
    thr_plan cut = *seed;
    *seed = symmetric;
    symmetric = cut;
  }

  thr_plan_destroy(&symmetric);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Adds a row without a search, if there are cords for one. */
static thr_status cut_cords(advice_search *adviser, ends_kind *kind, int cords, thr_err *err)
{
  const thr_request request = request_of(adviser, kind, cords);
  thr_plan seed = {0};
  thr_status st = find_seed(adviser, kind, &request, adviser->limits, &seed, err);
  if (!st && seed.n_cords > 0) st = set_row(adviser, kind, &seed, NULL, err);
  thr_plan_destroy(&seed);
  return st;
}

/* Adds a row by a search, which begins with the cords that need no search. */
static thr_status search_cords(advice_search *adviser, ends_kind *kind, int cords, double part,
                               thr_err *err)
{
  const thr_request request = request_of(adviser, kind, cords);

  const thr_limits share = thr_limits_part(adviser->limits, part);
  thr_plan seed = {0}, plan = {0};
  thr_err why = {0};

  /* Search, from the cords that need no search if there are some. */
  thr_status st = find_seed(adviser, kind, &request, &share, &seed, err);
  if (!st)
    st = thr_tortuosity_plan_from(adviser->frame, &request, seed.n_cords ? &seed : NULL, &share,
                                  &plan, &why);
  if (st == THR_ENOMEM)
    st = thr_nomem(err);
  else
    st = THR_OK;

  /* The row notes the search even where the search has found nothing. */
  if (!st && plan.n_cords > 0) st = set_row(adviser, kind, &plan, &plan.turning, err);
  thr_advice_row *row = find_row(adviser, kind, cords);
  if (row) row->searched = true;
  kind->over |= !row;

  /* The plan with one cord is what other numbers are cut from. */
  if (!st && cords == 1 && plan.n_cords > 0) {
    kind->first = plan;
    plan = (thr_plan){0};
  }

  thr_plan_destroy(&plan);
  thr_plan_destroy(&seed);
  return st;
}

/* ---- closed cords opened ---- */

/* Opens the plan with one closed cord to one with both ends at a node, which takes the place of the
 * first plan if that turns more. */
static thr_status take_closed(advice_search *adviser, ends_kind *kind, const thr_plan *closed,
                              thr_err *err)
{
  const thr_request request = request_of(adviser, kind, 1);

  thr_plan opened = {0};
  thr_status st = thr_cut_open(adviser->frame, &request, closed, &opened, err);

  /* The opened cord becomes the plan with one cord if it turns less. */
  if (!st && opened.n_cords > 0 &&
      (kind->first.n_cords == 0 || opened.metrics.max_turning < kind->first.metrics.max_turning)) {
    thr_plan before = kind->first;
    kind->first = opened;
    opened = before;
    st = set_row(adviser, kind, &kind->first, NULL, err);
  }

  thr_plan_destroy(&opened);
  return st;
}

/* ---- which ---- */

/* Finds symmetric threadings with these ends, from which rows of several numbers may be taken. */
static thr_status find_symmetric(const advice_search *adviser, ends_kind *kind, thr_err *err)
{
  const thr_limits share = thr_limits_part(adviser->limits, part_symmetric);

  thr_request request = request_of(adviser, kind, 1);
  thr_err why = {0};
  request.aims = thr_aims_symmetric;
  thr_status st =
      thr_symmetries_find(adviser->frame, &request, false, &share, &kind->symmetries, &why);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves no rows */
}

/* Returns the number to try after this one: 1, 2, 3, 4, 6, 8, 12, 16, 24, .. */
static int next_number(int cords)
{
  int power = 1;
  while (2 * power <= cords)
    power *= 2;
  return cords < 4 ? cords + 1 : power == cords ? cords + cords / 2 : 2 * power;
}

static bool is_over(const advice_search *adviser, const ends_kind *kind, int cords)
{
  int fewest = within(adviser, kind);
  return kind->over || kind->idle >= IDLE ||
         kind->pull <= slack_pull * adviser->out->physics.seating ||
         cords > adviser->frame->n_edges || cords > THR_MOST_CORDS ||
         (fewest && cords > TIMES * fewest);
}

/* Tells whether the time is over; what was to be tried is then left out. */
static bool stopped(advice_search *adviser)
{
  bool stop = thr_limits_stop(adviser->limits);
  adviser->out->complete &= !stop;
  return stop;
}

/* Adds rows without a search: all numbers in turn, and then by halves down to the fewest cords
 * within the hand's force. */
static thr_status cut_numbers(advice_search *adviser, ends_kind *kind, thr_err *err)
{
  thr_status st = THR_OK;
  bool some = true;

  /* Upwards until more cords no longer pay, or none are found. */
  for (int cords = 2; !st && some && !is_over(adviser, kind, cords); cords = next_number(cords)) {
    st = cut_cords(adviser, kind, cords, err);
    some = find_row(adviser, kind, cords) != NULL;
  }

  /* Halve the interval between the numbers within the hand's force and those beyond. */
  while (!st && some) {
    int fewest = within(adviser, kind), most = beyond(adviser, kind, fewest),
        cords = (fewest + most) / 2;
    if (fewest - most < 2) break;
    st = cut_cords(adviser, kind, cords, err);
    some = find_row(adviser, kind, cords) != NULL;
  }
  return st;
}

/* Searches for the fewest cords that stay within the hand's force, and for one fewer as long as a
 * search finds that these do, too. */
static thr_status search_fewest(advice_search *adviser, ends_kind *kind, thr_err *err)
{
  int fewest = within(adviser, kind);
  thr_status st = fewest > 1 ? search_cords(adviser, kind, fewest, part_row, err) : THR_OK;

  /* Down one by one, as long as each number stays within the hand's force. */
  for (int cords = fewest - 1;
       !st && cords > 1 && within(adviser, kind) == cords + 1 && !stopped(adviser); cords--)
    st = search_cords(adviser, kind, cords, part_row, err);
  return st;
}

/* Returns the part of the time for one row, so that all rows that wait for a search have as
 * much. */
static double part_of_rows(const advice_search *adviser)
{
  int waiting = 0;
  for (int i = 0; i < adviser->out->n; i++)
    waiting += !adviser->out->row[i].searched;
  return fmin(part_row, 1.0 / (waiting + 2));
}

/* Searches for all numbers that are not over, with ends of all kinds side by side. */
static thr_status search_numbers(advice_search *adviser, ends_kind *kinds, int n_kinds,
                                 thr_err *err)
{
  thr_status st = THR_OK;
  bool some = true;

  /* Alternate the kinds of ends, so that no kind takes all of the time. */
  for (int cords = 2; !st && some; cords = next_number(cords)) {
    some = false;
    for (int i = 0; i < n_kinds && !st; i++) {
      const thr_advice_row *row = find_row(adviser, &kinds[i], cords);
      if (!row && is_over(adviser, &kinds[i], cords)) continue;
      some = true;

      if (row && (row->searched || row->optimal)) continue;
      if (stopped(adviser)) return THR_OK;
      st = search_cords(adviser, &kinds[i], cords, part_of_rows(adviser), err);
    }
  }
  return st;
}

/* ---- without overlap ---- */

/* Adds a row of as few cords as need no overlap, where their ends may be: one from odd node to odd
 * node for every two of them. *added becomes true if there is such a plan. */
static thr_status add_bare(advice_search *adviser, ends_kind *kind, bool *added, thr_err *err)
{
  thr_request request = request_of(adviser, kind, 1);
  thr_plan plan = {0};
  int cords;
  request.aims = (thr_aims){1, {THR_AIM_PULL}};
  request.turning.length_slack = 0;

  thr_status st = thr_planner_bare_cords(adviser->frame, &request, &cords, err);
  if (!st && cords > 1)
    st = thr_planner_try_cords(adviser->frame, &request, cords, adviser->limits, &plan, NULL, err);
  if (!st && plan.n_cords > 0) st = set_row(adviser, kind, &plan, NULL, err);
  *added = plan.n_cords > 0;
  thr_plan_destroy(&plan);
  return st;
}

/* ---- what is promised ---- */

/* Makes the plan that is recommended (recommend.c), as `thread plan` alone does for what a hand
 * always manages. */
static thr_status make_promised(const advice_search *adviser, thr_plan *plan, thr_err *err)
{
  const thr_recommend_options options = {.hand = adviser->out->hand};
  thr_limits limits = *adviser->limits;
  thr_report report = {0};
  thr_err why = {0};

  /* Nothing was counted before the command, and nobody hears of its cords. */
  limits.work = NULL;
  limits.usual = true;
  limits.found = NULL;
  const thr_status st = thr_plan_recommended(adviser->frame, &adviser->request, &options, &limits,
                                             plan, &report, &why);

  thr_report_destroy(&report);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails promises nothing */
}

static bool is_promise(const thr_plan *plan)
{
  return plan->n_cords > 0 && plan->options.ends != THR_ENDS_CLOSED;
}

/* Fills a row with the plan that is recommended, keeps the bound that the row had, and tells it. */
static thr_status tell_promised(advice_search *adviser, const thr_plan *plan, thr_advice_row *row,
                                thr_err *err)
{
  const ends_kind kind = {.ends = plan->options.ends};
  const double base_length = adviser->out->base_length;

  const thr_status st = measure_row(adviser, &kind, plan, row, err);
  row->planned = true;
  row->searched = adviser->frame->n_edges <= MOST_SEARCHED;
  row->optimal = row->turning <= row->bound * (1 + 1e-9);
  adviser->out->base_length = base_length;
  if (!st && adviser->options->row) adviser->options->row(adviser->options->user, row);
  return st;
}

/* Makes the plan that is recommended, and tells it before all rows are there. */
static thr_status promise_early(advice_search *adviser, thr_err *err)
{
  thr_advice_row row = {0};
  thr_plan *plan = adviser->promised;
  if (!plan || plan->n_cords > 0) return THR_OK;

  thr_status st = make_promised(adviser, plan, err);
  if (st || !is_promise(plan)) return st;
  st = tell_promised(adviser, plan, &row, err);
  if (!st && adviser->options->recommended && thr_advice_within(adviser->out, &row))
    adviser->options->recommended(adviser->options->user, &row, plan);
  thr_cords_destroy(row.cord, row.all);
  return st;
}

/* ---- the order of work ---- */

static void kind_destroy(ends_kind *kind)
{
  thr_plan_destroy(&kind->first);
  thr_symmetries_destroy(&kind->symmetries);
}

/* Searches for the row of one cord, and for the symmetric rows. */
static thr_status try_first(advice_search *adviser, ends_kind *kind, const thr_plan *closed,
                            thr_err *err)
{
  thr_status st = search_cords(adviser, kind, 1, part_first, err);
  if (!st) st = take_closed(adviser, kind, closed, err);
  kind->over = !find_row(adviser, kind, 1);
  return !st && !kind->over ? find_symmetric(adviser, kind, err) : st;
}

static thr_status cut_plan(advice_search *adviser, ends_kind *kind, const thr_plan *plan,
                           thr_err *err)
{
  thr_status st = take_closed(adviser, kind, plan, err);
  return st || !find_row(adviser, kind, 1) ? st : cut_numbers(adviser, kind, err);
}

/* Searches for the rows of one cord, cuts them into more, and finds symmetric ones. */
static thr_status begin_searches(advice_search *adviser, ends_kind *kinds, int n_kinds,
                                 thr_err *err)
{
  ends_kind closed = {.ends = THR_ENDS_CLOSED, .pull = INFINITY};
  thr_status st = find_group(adviser, err);
  if (!st) st = search_cords(adviser, &closed, 1, part_first, err);

  for (int i = 0; i < n_kinds && !st; i++)
    st = try_first(adviser, &kinds[i], &closed.first, err);
  for (int i = 0; i < n_kinds && !st; i++)
    st = cut_numbers(adviser, &kinds[i], err);
  kind_destroy(&closed);
  return st;
}

/* Cuts the shortest closed cords of a framework that is too large for searches. */
static thr_status cut_shortest(advice_search *adviser, ends_kind *kinds, int n_kinds, thr_err *err)
{
  thr_request request = adviser->request;
  thr_plan shortest = {0};
  request.aims = thr_aims_shortest;

  thr_status st = thr_plan_make(adviser->frame, &request, adviser->limits, &shortest, NULL, err);
  if (st == THR_ELIMIT && shortest.n_cords > 0) st = THR_OK; /* not proved, but cords */

  for (int i = 0; i < n_kinds && !st; i++)
    st = cut_plan(adviser, &kinds[i], &shortest, err);
  thr_plan_destroy(&shortest);
  return st;
}

/* Appends the rows of a framework of one component, or of all components alike, in the order of
 * their use: cut and symmetric cords, what is recommended, cords without overlap, the fewest cords
 * within the hand's force, all others. By the clock, first those of the work that is counted where
 * no time is given, on which more time improves: its searches take other ways, and may lead to more
 * cord. promised: receives what is recommended, unless it has done;
 * NULL: nobody asks. */
static thr_status find_rows(const thr_frame *frame, const thr_request *request,
                            const thr_advise_options *options, bool searches,
                            const thr_limits *limits, thr_plan *promised, thr_advice *out,
                            thr_err *err)
{
  advice_search adviser = {.frame = frame,
                           .request = row_request(request),
                           .limits = limits,
                           .options = options,
                           .room = out->n,
                           .out = out,
                           .searches = searches && frame->n_edges <= MOST_SEARCHED,
                           .promised = promised};

  double work = thr_advise_work;
  const thr_limits counted = thr_limits_counted(limits, &work);
  thr_err why = {0};

  if (!limits->work && adviser.searches) {
    if (find_rows(frame, request, options, true, &counted, promised, out, &why) == THR_ENOMEM)
      return thr_nomem(err);
    for (int i = 0; i < out->n; i++)
      out->row[i].searched = false;
    out->complete = true;
    adviser.room = out->n;
  }

  /* Ends anywhere are one kind; ends at feet come first where the framework has feet. */
  ends_kind kinds[2] = {{.ends = THR_ENDS_ANY, .pull = INFINITY}};
  int n_kinds = 1;
  bool added = false;
  if (thr_frame_feet(frame) > 0) {
    kinds[1] = kinds[0];
    kinds[0].ends = THR_ENDS_FEET;
    n_kinds = 2;
  }

  thr_status st = adviser.searches ? begin_searches(&adviser, kinds, n_kinds, err)
                                   : cut_shortest(&adviser, kinds, n_kinds, err);
  if (!st) st = promise_early(&adviser, err);
  for (int i = 0; i < n_kinds && !st && !added && adviser.searches; i++)
    st = add_bare(&adviser, &kinds[i], &added, err);
  for (int i = 0; i < n_kinds && !st && adviser.searches; i++)
    st = search_fewest(&adviser, &kinds[i], err);
  if (!st && adviser.searches) st = search_numbers(&adviser, kinds, n_kinds, err);
  if (!st && out->n == 0)
    st = thr_fail(err, stopped(&adviser) ? THR_ELIMIT : THR_EINFEASIBLE,
                  "no threading with one cord or more was found");

  for (int i = 0; i < n_kinds; i++)
    kind_destroy(&kinds[i]);
  thr_group_destroy(&adviser.group);
  return st;
}

/* ---- several components ---- */

/* Returns the row of the least pull among those with at most so many cords; NULL: there is none. */
static const thr_advice_row *least_pull_row(const thr_advice *advice, thr_ends ends, int cords)
{
  const thr_advice_row *best = NULL;
  for (int i = 0; i < advice->n; i++) {
    const thr_advice_row *row = &advice->row[i];
    if (row->ends != ends || row->cords > cords) continue;
    if (!best || row->pull[THR_ADVICE_MU] < best->pull[THR_ADVICE_MU]) best = row;
  }
  return best;
}

/* Returns the row of the fewest cords that needs no more than pull, N at mu; NULL: there is
 * none. */
static const thr_advice_row *fewest_cords_row(const thr_advice *advice, thr_ends ends, double pull)
{
  const thr_advice_row *best = NULL;
  for (int i = 0; i < advice->n; i++) {
    const thr_advice_row *row = &advice->row[i];
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

/* Gathers the cords of a joined row, which become those of the whole framework. */
static thr_status gather_cords(const thr_components *components, const thr_advice *part,
                               thr_advice_row *sum, thr_err *err)
{
  int n = 0;
  sum->cord = thr_calloc((size_t)sum->all, sizeof *sum->cord);
  if (!sum->cord) return thr_nomem(err);

  for (int k = 0; k < components->n; k++) {
    const thr_advice_row *row = fewest_cords_row(&part[k], sum->ends, sum->pull[THR_ADVICE_MU]);
    for (int i = 0; i < row->all; i++) {
      thr_cord *cord = &sum->cord[n];
      *cord = row->cord[i];
      cord->component = k;
      thr_cord_id(n++, cord->id);
      cord->half = thr_calloc((size_t)cord->n_passes, sizeof *cord->half);
      if (!cord->half) return thr_nomem(err);
      for (int j = 0; j < cord->n_passes; j++)
        cord->half[j] = thr_component_half(components, k, row->cord[i].half[j]);
    }
  }
  return THR_OK;
}

/* Makes the row of at most so many cords in every component: each has as few as the pull of the one
 * that is hardest allows. False: some component has no such cords. */
static bool join_row(const thr_advice *part, int n, thr_ends ends, int cords, thr_advice_row *sum)
{
  double pull = 0;
  *sum = (thr_advice_row){.ends = ends, .searched = true};

  /* The pull of all is at least that of the hardest component. */
  for (int k = 0; k < n; k++) {
    const thr_advice_row *row = least_pull_row(&part[k], ends, cords);
    if (!row) return false;
    pull = fmax(pull, row->pull[THR_ADVICE_MU]);
  }

  /* No component needs more cords than that pull asks for. */
  for (int k = 0; k < n; k++)
    add_to_row(sum, fewest_cords_row(&part[k], ends, pull));

  sum->optimal = sum->turning <= sum->bound * (1 + 1e-9);
  return true;
}

/* Joins the rows of all components: one for every number of cords that some component has a row of.
 */
static thr_status join_rows(const thr_components *components, const thr_advice *part,
                            const thr_advise_options *options, thr_advice *out, thr_err *err)
{
  const int n = components->n;
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_FEET, THR_ENDS_ANY};
  bool *has = thr_calloc(THR_MOST_CORDS + 1, sizeof *has);
  advice_search adviser = {.options = options, .out = out};
  thr_status st = has ? THR_OK : thr_nomem(err);

  /* For every kind of ends mark the numbers that some component has a row of. */
  for (int i = 0; i < 3 && !st; i++) {
    memset(has, 0, (THR_MOST_CORDS + 1) * sizeof *has);
    for (int k = 0; k < n; k++)
      for (int j = 0; j < part[k].n; j++)
        has[part[k].row[j].cords] |= part[k].row[j].ends == ends[i];

    /* Join one row for each marked number, unless it is the row before once more. */
    int last = 0;
    for (int cords = 1; cords <= THR_MOST_CORDS && !st; cords++) {
      thr_advice_row sum, *row;
      if (!has[cords] || !join_row(part, n, ends[i], cords, &sum) || sum.cords == last) continue;

      if ((st = new_row(&adviser, &row, err))) break;
      *row = sum;
      last = sum.cords;
      st = gather_cords(components, part, row, err);
      if (!st && options->row) options->row(options->user, row);
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

  /* Each component gets the share of the time that its edges have of those left. */
  for (int k = 0; k < n && !st; k++) {
    const thr_limits share =
        thr_limits_part(limits, (double)(first[k + 1] - first[k]) / (first[n] - first[k]));

    thr_plan asked;
    if ((st = thr_component_take(components, k, &asked, err))) break;
    part[k] = (thr_advice){.physics = out->physics, .hand = options->hand, .complete = true};

    st =
        find_rows(&asked.frame, request, &quiet, n <= MOST_COMPONENTS, &share, NULL, &part[k], err);
    out->base_length += part[k].base_length;
    out->complete &= part[k].complete;
    thr_plan_destroy(&asked);
  }

  if (!st) st = join_rows(components, part, options, out, err);
  for (int k = 0; part && k < n; k++)
    thr_advice_destroy(&part[k]);
  free(part);
  return st;
}

/* ---- all of it ---- */

/* Puts the plan that is recommended in the place of the row of its number, and orders all rows. */
static thr_status promise(advice_search *adviser, const thr_plan *plan, thr_err *err)
{
  thr_advice *out = adviser->out;
  thr_status st = THR_OK;

  if (is_promise(plan)) {
    const ends_kind kind = {.ends = plan->options.ends};
    adviser->room = out->n;
    thr_advice_row *row = find_row(adviser, &kind, plan->options.cords);
    if (!row) st = new_row(adviser, &row, err);
    if (!st) st = tell_promised(adviser, plan, row, err);
  }
  if (!st) thr_advice_settle(out);
  return st;
}

/* Tells which row is recommended where it is another than was told early. */
static thr_status tell_chosen(const thr_advice *advice, const thr_frame *frame,
                              const thr_request *request, const thr_advise_options *options,
                              thr_err *err)
{
  const thr_advice_row *row = &advice->row[advice->chosen];
  thr_plan plan = {0};
  if (advice->chosen < 0 || row->planned || !options->recommended) return THR_OK;

  const thr_status st = thr_advice_plan(frame, request, row, &plan, err);
  if (!st) options->recommended(options->user, row, &plan);
  thr_plan_destroy(&plan);
  return st;
}

thr_status thr_advice_plan(const thr_frame *frame, const thr_request *request,
                           const thr_advice_row *row, thr_plan *plan, thr_err *err)
{
  thr_request asked = row_request(request);
  *plan = (thr_plan){0};
  asked.ends = row->ends;
  asked.cords = row->cords;
  asked.cords_least = row->uneven ? 1 : row->cords;

  thr_status st = thr_plan_request(plan, frame, &asked, err);
  if (!st) st = thr_cords_copy(row->cord, row->all, &plan->cord, err);
  if (!st) plan->n_cords = row->all;
  if (!st)
    st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                          err);
  if (st) thr_plan_destroy(plan);
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

  /* What is recommended is what its command makes. */
  advice_search promising = {.frame = frame,
                             .request = row_request(request),
                             .limits = limits,
                             .options = options,
                             .out = out};
  if (!st && frame->n_edges <= MOST_SEARCHED) st = find_group(&promising, err);

  /* Of several components, whose rows come last, it is told first. */
  thr_plan plan = {0};
  promising.promised = &plan;
  if (!st && components.n == 1)
    st = find_rows(frame, request, options, true, limits, &plan, out, err);
  else if (!st && !(st = promise_early(&promising, err)))
    st = find_by_components(&components, request, options, limits, out, err);

  if (!st) st = promise(&promising, &plan, err);
  if (!st) st = tell_chosen(out, frame, request, options, err);
  thr_plan_destroy(&plan);
  thr_group_destroy(&promising.group);
  thr_components_destroy(&components);
  if (st) thr_advice_destroy(out);
  return st;
}
