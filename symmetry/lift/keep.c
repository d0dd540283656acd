/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes the cords of a symmetric cover until they keep to what is asked of cords and not of
 * covers: how many there are in a component, how long they are, how hard to pull, and how many
 * different ones pass an edge.
 *
 * The cover's passes stay (but for cords of one edge that are added where there are too few); its
 * turns and ends change, orbit by orbit, so that what is made stays symmetric. Each step makes the
 * cords of up to MOST_TRIALS changes and takes the one that helps most (a steepest descent), until
 * the cords keep to what is asked or nothing helps.
 *
 * Example: a ring of six edges under C3 is one closed cord. For three cords with ends anywhere an
 * orbit of three turns becomes ends. */
#include "symmetry/lift/lift.h"
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TRIALS = 128 }; /* whose cords are made for each change */

/* ---- what is asked ---- */

bool thr_keep_asked(const thr_request *request)
{
  return thr_wants_symmetry(request) &&
         (request->symmetry.counted || request->max_length > 0 || request->max_pull > 0 ||
          request->distinct > 0 || thr_wants_balance(request));
}

/* Returns by which part a length exceeds the largest length that is asked for. */
static double length_beyond(const thr_request *request, double length)
{
  double limit = request->max_length * (1 + 1e-12);
  return request->max_length > 0 && length > limit ? length / request->max_length - 1 : 0;
}

/* Returns by which part the turning of a cord exceeds what the pull may overcome; if only straight
 * cords may be pulled, the turning in rad. */
static double turning_beyond(const thr_frame *frame, const thr_request *request,
                             const thr_cord *cord)
{
  double limit = thr_request_most_pulled(request);
  if (thr_cords_within_pull(frame, request, cord, 1)) return 0;
  double turning = thr_cord_pulled_turning(frame, cord);
  return limit > 0 ? turning / limit - 1 : turning;
}

/* By how much cords do not keep to what is asked: cords too few and too many, in all components
 * together; different cords that edges lack; the sum of the parts by which cords are too long or
 * pull too hard. And the longest cord. */
typedef struct {
  int few, many, lacking;
  double beyond, longest;
} cord_excess;

/* Counts the different cords that edges lack: each edge is to have `distinct`. */
static thr_status count_lacking(const thr_frame *frame, int distinct, const thr_cord *cord,
                                int n_cords, int *lacking, thr_err *err)
{
  /* The number of the cord that passed an edge last, from 1. */
  int *last = thr_calloc((size_t)frame->n_edges, sizeof *last);
  if (!last) return thr_nomem(err);
  *lacking = distinct * frame->n_edges;
  int *met = thr_calloc((size_t)frame->n_edges, sizeof *met);

  /* A cord counts once for an edge, and no edge lacks less than none. */
  for (int i = 0; i < n_cords && met; i++)
    for (int k = 0; k < cord[i].n_passes; k++) {
      const int e = cord[i].half[k] >> 1;
      if (last[e] == i + 1) continue;
      last[e] = i + 1;
      *lacking -= ++met[e] <= distinct;
    }

  const bool done = met != NULL;
  free(last);
  free(met);
  return done ? THR_OK : thr_nomem(err);
}

/* Computes by how much the cords do not keep to the request. */
static thr_status find_excess(const thr_frame *frame, const thr_request *request,
                              const int *component, const thr_cord *cord, int n_cords,
                              cord_excess *out, thr_err *err)
{
  int *count = thr_calloc((size_t)frame->n_nodes, sizeof *count), components = 0;
  *out = (cord_excess){0};
  if (!count) return thr_nomem(err);

  for (int v = 0; v < frame->n_nodes; v++)
    if (component[v] >= components) components = component[v] + 1;

  /* Lengths and pulls. */
  for (int i = 0; i < n_cords; i++) {
    double length = thr_cord_length(frame, &cord[i]);
    count[cord[i].component]++;
    out->beyond += length_beyond(request, length) + turning_beyond(frame, request, &cord[i]);
    out->longest = fmax(out->longest, length);
  }

  /* Numbers in every component. */
  for (int k = 0; k < components && request->symmetry.counted; k++) {
    if (count[k] < request->cords_least) out->few += request->cords_least - count[k];
    if (count[k] > request->cords) out->many += count[k] - request->cords;
  }

  free(count);
  return request->distinct > 0
             ? count_lacking(frame, request->distinct, cord, n_cords, &out->lacking, err)
             : THR_OK;
}

/* Tells whether nothing exceeds what is asked. */
static bool is_kept(const cord_excess *excess)
{
  return excess->few == 0 && excess->many == 0 && excess->lacking == 0 && excess->beyond == 0;
}

bool thr_keep_does(const thr_frame *frame, const thr_request *request, const int *component,
                   const thr_cord *cord, int n_cords)
{
  cord_excess excess;

  return find_excess(frame, request, component, cord, n_cords, &excess, NULL) == THR_OK &&
         is_kept(&excess);
}

int thr_keep_fewest(const thr_quotient *quotient, const int *component)
{
  const thr_frame *frame = quotient->f;
  int fewest = 1, order = quotient->h->order;

  /* A cord over edge e is its own image under at most 2 * fixed elements. */
  for (int e = 0; e < frame->n_edges; e++) {
    /* Elements that leave the half-edge alone (the identity does), and images of the edge in its
     * component. */
    int fixed = 0, same = 0;
    for (int i = 0; i < order; i++) {
      int half = quotient->half_image[(size_t)i * 2 * (size_t)frame->n_edges + 2 * (size_t)e];
      fixed += half == 2 * e;
      same += component[thr_tail(frame, half)] == component[frame->edge[e][0]];
    }

    if (fixed == 0) continue; /* there are no elements */

    /* So the edge's images in the component are passed by so many cords at least. */
    int cords = (same + 2 * fixed - 1) / (2 * fixed);
    if (cords > fewest) fewest = cords;
  }

  return fewest;
}

/* ---- trials ---- */

/* The search for cords that keep to what is asked: the cover that is tried, the best one and its
 * cords. */
typedef struct {
  const thr_quotient *quotient;
  const thr_request *request;
  const thr_limits *limits;
  const int *component;
  thr_cover_options how;
  thr_programme programme;
  int *value, *best,
      *base; /* [programme.n] of the trial, of the best so far, and of what the trials start from */
  bool counting; /* trials are only counted; then those are made that are spread evenly, at being
                    the next */
  long n_trials, at;
  bool found, better;
  cord_excess excess;
  double worth[THR_N_AIMS]; /* of the best so far, as excess, cord and record are */
  thr_cord *cord;
  int n_cords;
  thr_symmetry_record record;
} cord_keeper;

static void drop_cords(cord_keeper *keeper)
{
  thr_cords_destroy(keeper->cord, keeper->n_cords);
  thr_symmetry_record_destroy(&keeper->record);
  keeper->cord = NULL;
  keeper->n_cords = 0;
}

static void keeper_destroy(cord_keeper *keeper)
{
  drop_cords(keeper);
  free(keeper->value);
  free(keeper->best);
  free(keeper->base);
  thr_programme_destroy(&keeper->programme);
}

/* Tells whether cords with this excess, of a cover with these values, are better than the best so
 * far: first by what exceeds the request, then, with balance, by the longest cord, then by the
 * aims. */
static bool is_better(const cord_keeper *keeper, const cord_excess *excess, const double *worth)
{
  if (!keeper->found) return true;
  double a = excess->few + excess->many + excess->lacking + excess->beyond,
         b = keeper->excess.few + keeper->excess.many + keeper->excess.lacking +
             keeper->excess.beyond;

  /* What exceeds the request, then the longest cord, then the aims. */
  if (fabs(a - b) > 1e-9) return a < b;
  if (thr_wants_balance(keeper->request) &&
      fabs(excess->longest - keeper->excess.longest) > 1e-9 * excess->longest)
    return excess->longest < keeper->excess.longest;
  return thr_programme_compare(&keeper->programme, worth, keeper->worth) < 0;
}

/* Makes the cords of keeper->value, and keeps them if they are the best so far. Covers that cannot
 * be made concrete are passed over. */
static thr_status try_value(cord_keeper *keeper, thr_err *err)
{
  double worth[THR_N_AIMS];
  bool valid;
  cord_excess excess;
  thr_cord *cord = NULL;
  int n = 0;
  thr_symmetry_record record = {0};
  const thr_cover cover = {.copies = keeper->value,
                           .pairs = keeper->value + keeper->programme.first_pair,
                           .ends = keeper->value + keeper->programme.first_end};

  /* The cover, and its cords. */
  thr_status st = thr_programme_value(&keeper->programme, keeper->value, worth, &valid, err);
  if (st || !valid) return st;
  st = thr_cover_cords(keeper->quotient, &keeper->how, &cover, &cord, &n, &record, &(thr_err){0});
  if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;

  /* Circles that could be joined may be apart. */
  worth[THR_AIM_PATHS] = fmax(worth[THR_AIM_PATHS], record.unique_paths);

  /* Keep the best. */
  st = find_excess(keeper->quotient->f, keeper->request, keeper->component, cord, n, &excess, err);
  if (!st && is_better(keeper, &excess, worth)) {
    drop_cords(keeper);
    memcpy(keeper->best, keeper->value, (size_t)keeper->programme.n * sizeof *keeper->best);
    memcpy(keeper->worth, worth, sizeof worth);
    keeper->found = keeper->better = true;
    keeper->excess = excess;
    keeper->cord = cord;
    keeper->n_cords = n;
    keeper->record = record;
    return THR_OK;
  }

  /* Or free them. */
  thr_symmetry_record_destroy(&record);
  thr_cords_destroy(cord, n);
  return st;
}

/* ---- what may change ---- */

/* Counts a trial, or makes it if it is one of those that are spread evenly over all. */
static thr_status attempt_value(void *user, thr_err *err)
{
  cord_keeper *keeper = user;
  if (keeper->counting) {
    keeper->n_trials++;
    return THR_OK;
  }

  /* Of all trials every n_trials / MOST_TRIALS-th is made. */
  long i = keeper->at++;
  bool turn = keeper->n_trials <= MOST_TRIALS ||
              i * MOST_TRIALS / keeper->n_trials != (i + 1) * MOST_TRIALS / keeper->n_trials;
  return turn && !thr_limits_stop(keeper->limits) ? try_value(keeper, err) : THR_OK;
}

/* Replaces a turn of this pair type by ends (sign 1), or ends by the turn (-1). */
static void swap_ends(const cord_keeper *keeper, int pair, int sign)
{
  const thr_pair_type *type = &keeper->quotient->pair[pair];
  keeper->value[keeper->programme.first_pair + pair] -= sign;
  keeper->value[keeper->programme.first_end + type->dart[0]] += sign;
  if (!type->self) keeper->value[keeper->programme.first_end + type->dart[1]] += sign;
}

/* Tells whether a turn of this pair type can be replaced by ends (sign 1), or ends by the turn
 * (-1). */
static bool can_swap(const cord_keeper *keeper, int pair, int sign)
{
  const thr_pair_type *type = &keeper->quotient->pair[pair];
  const int *ends = keeper->base + keeper->programme.first_end, *dart = type->dart;

  /* The turn must be there, and its first type allow ends, which its second then does, too. */
  if (sign > 0)
    return keeper->base[keeper->programme.first_pair + pair] > 0 &&
           keeper->programme.most[keeper->programme.first_end + dart[0]] != 0;
  if (keeper->programme.most[keeper->programme.first_pair + pair] == 0) return false;

  /* The ends must be there: one, two of one type, or one of each type. */
  return type->self           ? ends[dart[0]] > 0
         : dart[0] == dart[1] ? ends[dart[0]] > 1
                              : ends[dart[0]] > 0 && ends[dart[1]] > 0;
}

/* ---- more cords ---- */

/* How an orbit of copies goes on at one of its dart types: its cord ends there (STOP), turns back
 * into its own image (FOLD), or into a second orbit (BACK). */
typedef enum { STOP, FOLD, BACK, N_GOING_ON } going_on;

/* Returns the column of a dart type for a way of going on, or -1 if there is none. */
static int column_of(const cord_keeper *keeper, int dart, going_on direction)
{
  const thr_programme *programme = &keeper->programme;
  /* An end. */
  if (direction == STOP)
    return programme->most[programme->first_end + dart] != 0 ? programme->first_end + dart : -1;

  /* Turns back, of one orbit or two. */
  for (int i = programme->first[dart]; i < programme->first[dart + 1]; i++) {
    const thr_pair_type *type = &keeper->quotient->pair[programme->incident[i]];
    const bool back = type->half[0] == type->half[1] && type->dart[0] == dart &&
                      (type->self || type->dart[1] == dart);
    if (back && type->self == (direction == FOLD) &&
        programme->most[programme->first_pair + programme->incident[i]] != 0)
      return programme->first_pair + programme->incident[i];
  }
  return -1;
}

/* Tries one more orbit of cords that pass copies of this type alone and go on in these ways at both
 * ends; two orbits of copies if one turns back into the other. */
static thr_status attempt_more(cord_keeper *keeper, int copy, going_on first, going_on second,
                               thr_err *err)
{
  const thr_copy_type *type = &keeper->quotient->copy[copy];
  const going_on ways[2] = {first, second};
  const int n_ends = type->dart[1] < 0 ? 1 : 2,
            times = first == BACK || (n_ends == 2 && second == BACK) ? 2 : 1;
  int column[2];

  /* Do the copies fit, and are there columns? */
  if (keeper->programme.most[copy] >= 0 &&
      keeper->base[copy] + times > keeper->programme.most[copy])
    return THR_OK;
  for (int i = 0; i < n_ends; i++)
    if ((column[i] = column_of(keeper, type->dart[i], ways[i])) < 0) return THR_OK;

  /* Add the columns, try, and take them away again. */
  for (int i = 0; i < n_ends; i++)
    keeper->value[column[i]] += ways[i] == BACK ? 1 : times;
  keeper->value[copy] += times;
  thr_status st = attempt_value(keeper, err);
  keeper->value[copy] -= times;
  for (int i = 0; i < n_ends; i++)
    keeper->value[column[i]] -= ways[i] == BACK ? 1 : times;
  return st;
}

/* Tries more cords where there are too few: each a pass over one edge, or there and back. */
static thr_status attempt_additions(cord_keeper *keeper, thr_err *err)
{
  thr_status st = THR_OK;
  for (int copy = 0; copy < keeper->quotient->n_copies && keeper->excess.few > 0; copy++)
    for (int pair_of_ways = 0; pair_of_ways < N_GOING_ON * N_GOING_ON && !st; pair_of_ways++)
      if (keeper->quotient->copy[copy].dart[1] >= 0 || pair_of_ways < N_GOING_ON)
        st = attempt_more(keeper, copy, (going_on)(pair_of_ways % N_GOING_ON),
                          (going_on)(pair_of_ways / N_GOING_ON), err);
  return st;
}

/* Tries, or counts, all changes: more cords, exchanges of partners, turns into ends and ends into
 * turns. */
static thr_status attempt_all(cord_keeper *keeper, thr_err *err)
{
  /* More cords, and exchanges. */
  thr_status st = attempt_additions(keeper, err);
  if (!st)
    st =
        thr_programme_attempt(&keeper->programme, keeper->value, false, attempt_value, keeper, err);

  /* Turns into ends, and ends into turns. */
  for (int i = 0; i < 2 * keeper->quotient->n_pairs && !st; i++) {
    int sign = i % 2 ? -1 : 1;
    if (!can_swap(keeper, i / 2, sign)) continue;
    swap_ends(keeper, i / 2, sign);
    st = attempt_value(keeper, err);
    swap_ends(keeper, i / 2, -sign);
  }
  return st;
}

/* Returns in how many modes cords are made: if cords may be closed, closed cords may be few or
 * many. */
static int modes_of(const cord_keeper *keeper)
{
  return keeper->programme.open ? 1 : 2;
}

/* Makes the best change of one orbit of turns or ends. Too many trials are thinned out evenly. */
static thr_status change_one(cord_keeper *keeper, thr_err *err)
{
  /* Trials start from the best so far. */
  memcpy(keeper->base, keeper->best, (size_t)keeper->programme.n * sizeof *keeper->base);
  memcpy(keeper->value, keeper->best, (size_t)keeper->programme.n * sizeof *keeper->value);
  keeper->better = false;
  thr_status st = THR_OK;

  /* In each mode the trials are counted first, and then made. */
  for (int pass = 0; pass < 2 * modes_of(keeper) && !st; pass++) {
    keeper->counting = pass % 2 == 0;
    keeper->how.most_closed = pass / 2 ? keeper->request->cords : 0;
    if (keeper->counting) keeper->n_trials = keeper->at = 0;
    st = attempt_all(keeper, err);
  }
  return st;
}

/* Starts with the cover as it is, and changes it until its cords keep to what is asked, nothing
 * helps, or the limits stop the search. */
static thr_status search_changes(cord_keeper *keeper, thr_err *err)
{
  thr_status st = try_value(keeper, err);

  /* More closed cords may do already. */
  if (!st && keeper->found && modes_of(keeper) > 1 &&
      (keeper->excess.few > 0 || keeper->excess.lacking > 0 || keeper->excess.beyond > 0)) {
    keeper->how.most_closed = keeper->request->cords;
    st = try_value(keeper, err);
  }

  keeper->better = keeper->found;
  while (!st && keeper->better && !is_kept(&keeper->excess) && !thr_limits_stop(keeper->limits))
    st = change_one(keeper, err);
  return st;
}

/* ---- the cover of the cords ---- */

/* Makes the cover that of the cords, with their values. A bound holds with the aims before it no
 * higher than they were; once one is higher, only what is known of any cover remains. */
static thr_status restate(const cord_keeper *keeper, thr_cover *cover, thr_err *err)
{
  double quick;
  bool same = true, at_bounds = true;
  thr_status st = thr_turning_quick_bound(&keeper->programme, keeper->worth, &quick, err);

  /* Values and bounds in the order of the aims. */
  for (int i = 0; i < THR_N_AIMS && !st; i++) {
    thr_aim aim = keeper->how.prefer[i];
    if (!same) cover->bound[aim] = aim == THR_AIM_TURNING ? quick : aim == THR_AIM_PATHS;
    if (keeper->worth[aim] > cover->value[aim] + thr_programme_tolerance(&keeper->programme, aim))
      same = false;
    at_bounds = at_bounds && keeper->worth[aim] <= cover->bound[aim] + thr_programme_tolerance(
                                                                           &keeper->programme, aim);
    cover->value[aim] = keeper->worth[aim];
    cover->bound[aim] = fmin(cover->bound[aim], cover->value[aim]);
  }

  cover->optimal = cover->optimal && at_bounds;

  /* The numbers of orbits. */
  if (!st) thr_programme_to_cover(&keeper->programme, keeper->best, cover);
  return st;
}

/* Makes the programme, and starts from the cover; the caller destroys keeper also on failure. */
static thr_status keeper_init(cord_keeper *keeper, const thr_cover *cover, thr_err *err)
{
  thr_status st = thr_programme_init(&keeper->programme, keeper->quotient, &keeper->how, err);
  if (!st && keeper->how.tube) st = thr_programme_tie(&keeper->programme, err);
  if (st) return st;

  /* The cover is the first trial. */
  keeper->value = thr_calloc((size_t)keeper->programme.n, sizeof *keeper->value);
  keeper->best = thr_calloc((size_t)keeper->programme.n, sizeof *keeper->best);
  keeper->base = thr_calloc((size_t)keeper->programme.n, sizeof *keeper->base);
  if (!keeper->value || !keeper->best || !keeper->base) return thr_nomem(err);

  thr_programme_from_cover(&keeper->programme, cover, keeper->value);
  return THR_OK;
}

thr_status thr_keep_cords(const thr_quotient *quotient, const thr_cover_options *options,
                          const thr_request *request, const thr_limits *limits, thr_cover *cover,
                          thr_cord **cord, int *n_cords, thr_symmetry_record *record, bool *kept,
                          thr_err *err)
{
  int n, *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  cord_keeper keeper = {.quotient = quotient,
                        .request = request,
                        .limits = limits,
                        .component = component,
                        .how = *options};

  /* Search from the cover as it is. */
  thr_status st =
      component ? thr_frame_components(quotient->f, component, &n, err) : thr_nomem(err);
  if (!st) st = keeper_init(&keeper, cover, err);
  if (!st) st = search_changes(&keeper, err);
  if (!st && !keeper.found) st = thr_fail(err, THR_ESOLVER, "no cords can be made of the cover");
  if (!st) st = restate(&keeper, cover, err);

  /* Hand over the cords. */
  if (!st) {
    *kept = is_kept(&keeper.excess);
    *cord = keeper.cord;
    *n_cords = keeper.n_cords;
    *record = keeper.record;
    keeper.cord = NULL;
    keeper.n_cords = 0;
    keeper.record = (thr_symmetry_record){0};
  }

  keeper_destroy(&keeper);
  free(component);

  return st;
}
