/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords of a symmetric cover that keep to what is asked of cords and not of covers: how many there
 * are in a component, and how long they are. The cover's passes stay; its turns and ends change,
 * orbit by orbit, so that what is made stays symmetric.
 *
 * Example: a ring of six edges under C3 is one closed cord. For three cords with ends anywhere an
 * orbit of three turns becomes ends. */
#include "symmetry/lift/lift.h"
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TRIALS = 128 }; /* for each change */

/* ---- what is asked ---- */

bool thr_keep_asked(const thr_request *request)
{
  return thr_wants_symmetry(request) &&
         (request->symmetry.counted || request->max_length > 0 || request->max_pull > 0 ||
          request->distinct > 0 || thr_wants_balance(request));
}

static double length_beyond(const thr_request *request, double length)
{
  double limit = request->max_length * (1 + 1e-12);
  return request->max_length > 0 && length > limit ? length / request->max_length - 1 : 0;
}

/* In parts of the turning that the pull may overcome; of straight cords in rad. */
static double turning_beyond(const thr_frame *frame, const thr_request *request,
                             const thr_cord *cord)
{
  double limit = thr_request_most_pulled(request);
  if (thr_cords_within_pull(frame, request, cord, 1)) return 0;
  double turning = thr_cord_pulled_turning(frame, cord);
  return limit > 0 ? turning / limit - 1 : turning;
}

/* Cords too few and too many, in all components together, and different ones that edges lack; the
 * sum of the parts by which cords are too long or need too much pull, and the longest. */
typedef struct {
  int few, many, lacking;
  double beyond, longest;
} excess;

static thr_status count_lacking(const thr_frame *frame, int distinct, const thr_cord *cord,
                                int n_cords, int *lacking, thr_err *err)
{
  int *last = thr_calloc((size_t)frame->n_edges,
                         sizeof *last); /* the number of the last cord that came by, from 1 */
  if (!last) return thr_nomem(err);
  *lacking = distinct * frame->n_edges;
  int *met = thr_calloc((size_t)frame->n_edges, sizeof *met);
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

static thr_status find_excess(const thr_frame *frame, const thr_request *request,
                              const int *component, const thr_cord *cord, int n_cords, excess *out,
                              thr_err *err)
{
  int *count = thr_calloc((size_t)frame->n_nodes, sizeof *count), components = 0;
  *out = (excess){0};
  if (!count) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++)
    if (component[v] >= components) components = component[v] + 1;
  for (int i = 0; i < n_cords; i++) {
    double length = thr_cord_length(frame, &cord[i]);
    count[cord[i].component]++;
    out->beyond += length_beyond(request, length) + turning_beyond(frame, request, &cord[i]);
    out->longest = fmax(out->longest, length);
  }
  for (int k = 0; k < components && request->symmetry.counted; k++) {
    if (count[k] < request->cords_least) out->few += request->cords_least - count[k];
    if (count[k] > request->cords) out->many += count[k] - request->cords;
  }
  free(count);
  return request->distinct > 0
             ? count_lacking(frame, request->distinct, cord, n_cords, &out->lacking, err)
             : THR_OK;
}

static bool keeps(const excess *x)
{
  return x->few == 0 && x->many == 0 && x->lacking == 0 && x->beyond == 0;
}

bool thr_keep_does(const thr_frame *frame, const thr_request *request, const int *component,
                   const thr_cord *cord, int n_cords)
{
  excess x;
  return find_excess(frame, request, component, cord, n_cords, &x, NULL) == THR_OK && keeps(&x);
}

int thr_keep_fewest(const thr_quotient *quotient, const int *component)
{
  const thr_frame *frame = quotient->f;
  int fewest = 1, order = quotient->h->order;
  for (int e = 0; e < frame->n_edges; e++) {
    int fixed = 0, same = 0; /* elements that leave a half-edge (the identity is one), and the
                                component, where they are */
    for (int i = 0; i < order; i++) {
      int half = quotient->half_image[(size_t)i * 2 * (size_t)frame->n_edges + 2 * (size_t)e];
      fixed += half == 2 * e;
      same += component[thr_tail(frame, half)] == component[frame->edge[e][0]];
    }
    int cords = (same + 2 * fixed - 1) / (2 * fixed);
    if (cords > fewest) fewest = cords;
  }
  return fewest;
}

/* ---- trials ---- */

typedef struct {
  const thr_quotient *q;
  const thr_request *o;
  const thr_limits *limits;
  const int *component;
  thr_cover_options how;
  thr_programme p;
  int *value, *best,
      *base;     /* [p.n] of the trial, of the best so far, and of what the trials differ from */
  bool counting; /* trials are only counted: n of them; then those are made that are spread evenly,
                    at being the next */
  long n, at;
  bool found, better;
  excess x;
  double worth[THR_N_AIMS];
  thr_cord *cord;
  int n_cords;
  thr_symmetry_record record;
} keeper;

static void drop_cords(keeper *k)
{
  thr_cords_destroy(k->cord, k->n_cords);
  thr_symmetry_record_destroy(&k->record);
  k->cord = NULL;
  k->n_cords = 0;
}

static void keeper_destroy(keeper *k)
{
  drop_cords(k);
  free(k->value);
  free(k->best);
  free(k->base);
  thr_programme_destroy(&k->p);
}

static bool is_better(const keeper *k, const excess *x, const double *worth)
{
  if (!k->found) return true;
  double a = x->few + x->many + x->lacking + x->beyond,
         b = k->x.few + k->x.many + k->x.lacking + k->x.beyond;
  if (fabs(a - b) > 1e-9) return a < b;
  if (thr_wants_balance(k->o) && fabs(x->longest - k->x.longest) > 1e-9 * x->longest)
    return x->longest < k->x.longest;
  return thr_programme_compare(&k->p, worth, k->worth) < 0;
}

/* Makes the cords of k->value, and keeps them if they are the best so far. */
static thr_status try_value(keeper *k, thr_err *err)
{
  double worth[THR_N_AIMS];
  bool valid;
  excess x;
  thr_cord *cord = NULL;
  int n = 0;
  thr_symmetry_record record = {0};
  const thr_cover cover = {
      .copies = k->value, .pairs = k->value + k->p.first_pair, .ends = k->value + k->p.first_end};
  thr_status st = thr_programme_value(&k->p, k->value, worth, &valid, err);
  if (st || !valid) return st;
  st = thr_cover_cords(k->q, &k->how, &cover, &cord, &n, &record, &(thr_err){0});
  if (st) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* no cords of this kind */
  worth[THR_AIM_PATHS] = fmax(worth[THR_AIM_PATHS],
                              record.unique_paths); /* circles that could be joined may be apart */
  st = find_excess(k->q->f, k->o, k->component, cord, n, &x, err);
  if (!st && is_better(k, &x, worth)) {
    drop_cords(k);
    memcpy(k->best, k->value, (size_t)k->p.n * sizeof *k->best);
    memcpy(k->worth, worth, sizeof worth);
    k->found = k->better = true;
    k->x = x;
    k->cord = cord;
    k->n_cords = n;
    k->record = record;
    return THR_OK;
  }
  thr_symmetry_record_destroy(&record);
  thr_cords_destroy(cord, n);
  return st;
}

/* ---- what may change ---- */

static thr_status attempt(void *user, thr_err *err)
{
  keeper *k = user;
  if (k->counting) {
    k->n++;
    return THR_OK;
  }
  long i = k->at++;
  bool turn = k->n <= MOST_TRIALS || i * MOST_TRIALS / k->n != (i + 1) * MOST_TRIALS / k->n;
  return turn && !thr_limits_stop(k->limits) ? try_value(k, err) : THR_OK;
}

/* Turns of pair column y become ends (sign 1), or ends such turns (-1). */
static void swap_ends(const keeper *k, int y, int sign)
{
  const thr_pair_type *type = &k->q->pair[y];
  k->value[k->p.first_pair + y] -= sign;
  k->value[k->p.first_end + type->dart[0]] += sign;
  if (!type->self) k->value[k->p.first_end + type->dart[1]] += sign;
}

static bool can_swap(const keeper *k, int y, int sign)
{
  const thr_pair_type *type = &k->q->pair[y];
  const int *ends = k->base + k->p.first_end, *d = type->dart;
  if (sign > 0) return k->base[k->p.first_pair + y] > 0 && k->p.most[k->p.first_end + d[0]] != 0;
  if (k->p.most[k->p.first_pair + y] == 0) return false;
  return type->self     ? ends[d[0]] > 0
         : d[0] == d[1] ? ends[d[0]] > 1
                        : ends[d[0]] > 0 && ends[d[1]] > 0;
}

/* ---- more cords ---- */

/* How an orbit of copies goes on at one of its dart types: its cord ends there, or turns back into
 * its own image or a second orbit. */
typedef enum { STOP, FOLD, BACK, N_WAYS } way;

/* Returns the column of dart type d for a way, or -1 if there is none. */
static int column_of(const keeper *k, int d, way w)
{
  const thr_programme *p = &k->p;
  if (w == STOP) return p->most[p->first_end + d] != 0 ? p->first_end + d : -1;
  for (int i = p->first[d]; i < p->first[d + 1]; i++) {
    const thr_pair_type *type = &k->q->pair[p->incident[i]];
    const bool back =
        type->half[0] == type->half[1] && type->dart[0] == d && (type->self || type->dart[1] == d);
    if (back && type->self == (w == FOLD) && p->most[p->first_pair + p->incident[i]] != 0)
      return p->first_pair + p->incident[i];
  }
  return -1;
}

/* Tries one more orbit of cords over copies of type c alone, which go on in these ways at both
 * ends: two orbits of copies where one turns back into the other. */
static thr_status attempt_more(keeper *k, int c, way first, way second, thr_err *err)
{
  const thr_copy_type *type = &k->q->copy[c];
  const way ways[2] = {first, second};
  const int n = type->dart[1] < 0 ? 1 : 2,
            times = first == BACK || (n == 2 && second == BACK) ? 2 : 1;
  int column[2];
  if (k->p.most[c] >= 0 && k->base[c] + times > k->p.most[c]) return THR_OK;
  for (int i = 0; i < n; i++)
    if ((column[i] = column_of(k, type->dart[i], ways[i])) < 0) return THR_OK;
  for (int i = 0; i < n; i++)
    k->value[column[i]] += ways[i] == BACK ? 1 : times;
  k->value[c] += times;
  thr_status st = attempt(k, err);
  k->value[c] -= times;
  for (int i = 0; i < n; i++)
    k->value[column[i]] -= ways[i] == BACK ? 1 : times;
  return st;
}

/* Tries more cords where there are too few: each a pass of one edge, or there and back over it. */
static thr_status attempt_additions(keeper *k, thr_err *err)
{
  thr_status st = THR_OK;
  for (int c = 0; c < k->q->n_copies && k->x.few > 0; c++)
    for (int w = 0; w < N_WAYS * N_WAYS && !st; w++)
      if (k->q->copy[c].dart[1] >= 0 || w < N_WAYS)
        st = attempt_more(k, c, (way)(w % N_WAYS), (way)(w / N_WAYS), err);
  return st;
}

static thr_status attempt_all(keeper *k, thr_err *err)
{
  thr_status st = attempt_additions(k, err);
  if (!st) st = thr_programme_attempt(&k->p, k->value, false, attempt, k, err);
  for (int i = 0; i < 2 * k->q->n_pairs && !st; i++) {
    int sign = i % 2 ? -1 : 1;
    if (!can_swap(k, i / 2, sign)) continue;
    swap_ends(k, i / 2, sign);
    st = attempt(k, err);
    swap_ends(k, i / 2, -sign);
  }
  return st;
}

/* Closed cords may be few or many. */
static int modes_of(const keeper *k)
{
  return k->p.open ? 1 : 2;
}

/* One orbit of turns or ends changed: the best of the trials, spread evenly over all if they are
 * too many. */
static thr_status change_one(keeper *k, thr_err *err)
{
  memcpy(k->base, k->best, (size_t)k->p.n * sizeof *k->base);
  memcpy(k->value, k->best, (size_t)k->p.n * sizeof *k->value);
  k->better = false;
  thr_status st = THR_OK;
  for (int pass = 0; pass < 2 * modes_of(k) && !st; pass++) {
    k->counting = pass % 2 == 0;
    k->how.most_closed = pass / 2 ? k->o->cords : 0;
    if (k->counting) k->n = k->at = 0;
    st = attempt_all(k, err);
  }
  return st;
}

static thr_status search(keeper *k, thr_err *err)
{
  thr_status st = try_value(k, err);
  if (!st && k->found && modes_of(k) > 1 && (k->x.few > 0 || k->x.lacking > 0 || k->x.beyond > 0)) {
    k->how.most_closed = k->o->cords;
    st = try_value(k, err);
  }
  k->better = k->found;
  while (!st && k->better && !keeps(&k->x) && !thr_limits_stop(k->limits))
    st = change_one(k, err);
  return st;
}

/* ---- the cover of the cords ---- */

/* Values of the cords. A bound holds with the aims before it no higher than they were; where one
 * is, what is known of any. */
static thr_status restate(const keeper *k, thr_cover *cover, thr_err *err)
{
  double quick;
  bool same = true, at_bounds = true;
  thr_status st = thr_turning_quick_bound(&k->p, k->worth, &quick, err);
  for (int i = 0; i < THR_N_AIMS && !st; i++) {
    thr_aim aim = k->how.prefer[i];
    if (!same) cover->bound[aim] = aim == THR_AIM_TURNING ? quick : aim == THR_AIM_PATHS;
    if (k->worth[aim] > cover->value[aim] + thr_programme_tolerance(&k->p, aim)) same = false;
    at_bounds =
        at_bounds && k->worth[aim] <= cover->bound[aim] + thr_programme_tolerance(&k->p, aim);
    cover->value[aim] = k->worth[aim];
    cover->bound[aim] = fmin(cover->bound[aim], cover->value[aim]);
  }
  cover->optimal = cover->optimal && at_bounds;
  if (cover->copies && k->q->n_copies > 0)
    memcpy(cover->copies, k->best, (size_t)k->q->n_copies * sizeof *k->best);
  if (k->q->n_pairs > 0)
    memcpy(cover->pairs, k->best + k->p.first_pair, (size_t)k->q->n_pairs * sizeof *k->best);
  memcpy(cover->ends, k->best + k->p.first_end, (size_t)k->q->n_darts * sizeof *k->best);
  return st;
}

static thr_status keeper_init(keeper *k, const thr_cover *cover, thr_err *err)
{
  thr_status st = thr_programme_init(&k->p, k->q, &k->how, err);
  if (!st && k->how.tube) st = thr_programme_tie(&k->p, err);
  if (st) return st;
  k->value = thr_calloc((size_t)k->p.n, sizeof *k->value);
  k->best = thr_calloc((size_t)k->p.n, sizeof *k->best);
  k->base = thr_calloc((size_t)k->p.n, sizeof *k->base);
  if (!k->value || !k->best || !k->base) return thr_nomem(err);
  memcpy(k->value, cover->copies, (size_t)k->q->n_copies * sizeof *k->value);
  if (k->q->n_pairs > 0)
    memcpy(k->value + k->p.first_pair, cover->pairs, (size_t)k->q->n_pairs * sizeof *k->value);
  memcpy(k->value + k->p.first_end, cover->ends, (size_t)k->q->n_darts * sizeof *k->value);
  return THR_OK;
}

thr_status thr_keep_cords(const thr_quotient *quotient, const thr_cover_options *options,
                          const thr_request *request, const thr_limits *limits, thr_cover *cover,
                          thr_cord **cord, int *n_cords, thr_symmetry_record *record, bool *kept,
                          thr_err *err)
{
  int n, *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  keeper k = {
      .q = quotient, .o = request, .limits = limits, .component = component, .how = *options};
  thr_status st =
      component ? thr_frame_components(quotient->f, component, &n, err) : thr_nomem(err);
  if (!st) st = keeper_init(&k, cover, err);
  if (!st) st = search(&k, err);
  if (!st && !k.found) st = thr_fail(err, THR_ESOLVER, "no cords can be made of the cover");
  if (!st) st = restate(&k, cover, err);
  if (!st) {
    *kept = keeps(&k.x);
    *cord = k.cord;
    *n_cords = k.n_cords;
    *record = k.record;
    k.cord = NULL;
    k.n_cords = 0;
    k.record = (thr_symmetry_record){0};
  }
  keeper_destroy(&k);
  free(component);
  return st;
}
