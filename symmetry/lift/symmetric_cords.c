/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cords of a symmetric cover, copies as images of their unique paths, and the record that says
 * so. */
#include "graph/threading/euler.h"
#include "symmetry/lift/lift.h"

#include <stdlib.h>
#include <string.h>

/* A cord on its way into the plan: the image of unique path `of` under an element of G. */
typedef struct {
  int *half;
  int n_passes, component, of, element;
  bool closed, round; /* round: it does not matter where it starts */
} traced;

typedef struct {
  thr_strands s;
  const thr_frame *f;
  bool open;            /* every cord is open: where a cord ends matters (thr_cover_all_open) */
  int end_steps;        /* of every end (thr_cover_steps_of_end) */
  const int *component; /* [n_nodes] */
  bool *walked;         /* [darts] of the cords so far */
  int *walk, *scratch;  /* [darts] the leaving darts of the cord at hand */
  traced *cord;
  int n_cords, capacity;
  int *unique; /* [n_unique] cord that is the first of its kind */
  int n_unique, unique_capacity;
} tracer;

static int half_image(const tracer *t, int x, int h)
{
  return t->s.q->half_image[(size_t)t->s.place[x] * 2 * (size_t)t->f->n_edges + (size_t)h];
}

/* ---- equal cords ---- */

/* Is b what x makes of cord a, from pass `shift` of b on, forward or backward? */
static bool matches(const tracer *t, const traced *a, int x, const traced *b, int shift,
                    bool reverse)
{
  int n = a->n_passes;
  for (int i = 0; i < n; i++) {
    int k = reverse ? (shift + n - i) % n : (shift + i) % n;
    if (half_image(t, x, a->half[i]) != (b->half[k] ^ (int)reverse)) return false;
  }
  return true;
}

/* Returns in how many ways x maps cord a to b as a path in the framework: forward or reversed, one
 * that runs round from any start. Stops counting at `enough`. */
static int ways(const tracer *t, const traced *a, int x, const traced *b, int enough)
{
  int n = a->n_passes, found = 0;
  if (n != b->n_passes || a->round != b->round) return 0;
  if (!a->round) return matches(t, a, x, b, 0, false) + matches(t, a, x, b, n - 1, true);
  for (int shift = 0; shift < n && found < enough; shift++)
    found += matches(t, a, x, b, shift, false) + matches(t, a, x, b, shift, true);
  return found;
}

/* Lowest element that maps cord a to b, or -1. */
static int element_between(const tracer *t, const traced *a, const traced *b)
{
  const thr_subgroup *subgroup = t->s.q->h;
  for (int i = 0; i < subgroup->order; i++)
    if (ways(t, a, subgroup->element[i], b, 1) > 0) return subgroup->element[i];
  return -1;
}

static bool fixes(const tracer *t, const traced *a, int x)
{
  for (int i = 0; i < a->n_passes; i++)
    if (half_image(t, x, a->half[i]) != a->half[i]) return false;
  return true;
}

/* Returns what has to be learned of a unique path: its passes and, unless it runs round, the steps
 * of its two ends, over the number of elements of H that map it to itself. Those that fix all its
 * nodes do so alike. */
static double steps_of(const tracer *t, const traced *a)
{
  const thr_subgroup *subgroup = t->s.q->h;
  int mapped = 0, fixed = 0;
  for (int i = 0; i < subgroup->order; i++) {
    mapped += ways(t, a, subgroup->element[i], a, 1) > 0;
    fixed += fixes(t, a, subgroup->element[i]);
  }
  return (double)(a->n_passes + (a->round ? 0 : 2 * t->end_steps)) * fixed / mapped;
}

/* ---- tracing ---- */

/* Leaving darts from d on until the cord ends or comes back to d; returns how many. */
static int trace(tracer *t, int d)
{
  int n = 0, start = d;
  do {
    t->walk[n++] = d;
    d = thr_strands_mate(&t->s, thr_strands_across(&t->s, d));
  } while (d >= 0 && d != start);
  return n;
}

/* Turns the walk of a closed cord so that it starts where it turns most: its two ends come out
 * there instead of turning. */
static void start_sharpest(tracer *t, int n)
{
  for (int i = 0; i < n; i++)
    t->scratch[i] = thr_strands_half(&t->s, t->walk[i]);
  const int best = thr_tour_start(t->f, NULL, t->scratch, n);
  memcpy(t->scratch, t->walk, (size_t)n * sizeof *t->walk);
  for (int i = 0; i < n; i++)
    t->walk[i] = t->scratch[(best + i) % n];
}

/* Appends the image under x of the walk of n darts. */
static thr_status add_cord(tracer *t, const int *walk, int n, int x, thr_err *err)
{
  thr_status st = thr_grow(&t->cord, t->n_cords, &t->capacity, sizeof *t->cord, err);
  if (st) return st;
  traced c = {.half = thr_calloc((size_t)n, sizeof *c.half), .n_passes = n};
  if (!c.half) return thr_nomem(err);
  for (int i = 0; i < n; i++) {
    int d = thr_strands_image(&t->s, x, walk[i]);
    t->walked[d] = t->walked[thr_strands_across(&t->s, d)] = true;
    c.half[i] = thr_strands_half(&t->s, d);
  }
  c.closed = thr_tail(t->f, c.half[0]) == thr_head(t->f, c.half[n - 1]);
  c.round = c.closed && !t->open;
  c.component = t->component[thr_tail(t->f, c.half[0])];
  t->cord[t->n_cords++] = c;
  return THR_OK;
}

/* The last cord runs as the image of unique path `of` under x does, and now starts and ends as that
 * does, too. */
static void make_image(tracer *t, int of, int x)
{
  traced *last = &t->cord[t->n_cords - 1];
  const traced *path = &t->cord[t->unique[of]];
  for (int i = 0; i < last->n_passes; i++)
    last->half[i] = half_image(t, x, path->half[i]);
  last->of = of;
  last->element = x;
}

/* The last cord, the first of its orbit: a copy of an earlier unique path that runs through the
 * same nodes, or a new one. */
static thr_status classify_last(tracer *t, thr_err *err)
{
  traced *last = &t->cord[t->n_cords - 1];
  for (int u = 0; u < t->n_unique; u++) {
    int x = element_between(t, &t->cord[t->unique[u]], last);
    if (x < 0) continue;
    make_image(t, u, x);
    return THR_OK;
  }
  thr_status st = thr_grow(&t->unique, t->n_unique, &t->unique_capacity, sizeof *t->unique, err);
  if (st) return st;
  last->of = t->n_unique;
  t->unique[t->n_unique++] = t->n_cords - 1;
  return THR_OK;
}

/* A cord that is there already. */
static thr_status add_given(tracer *t, const thr_cord *cord, thr_err *err)
{
  thr_status st = thr_grow(&t->cord, t->n_cords, &t->capacity, sizeof *t->cord, err);
  if (st) return st;
  traced c = {.half = thr_calloc((size_t)cord->n_passes, sizeof *c.half),
              .n_passes = cord->n_passes};
  if (!c.half) return thr_nomem(err);
  memcpy(c.half, cord->half, (size_t)cord->n_passes * sizeof *c.half);
  c.closed = cord->closed;
  c.round = c.closed && !t->open;
  t->cord[t->n_cords++] = c;
  return classify_last(t, err);
}

/* The cord from dart d on and its images under H, unless it is walked already. */
static thr_status add_orbit(tracer *t, int d, bool open, thr_err *err)
{
  const thr_quotient *quotient = t->s.q;
  if (t->walked[d]) return THR_OK;
  int n = trace(t, d);
  if (!open) start_sharpest(t, n);
  thr_status st = add_cord(t, t->walk, n, 0, err);
  if (!st) st = classify_last(t, err);
  if (st) return st;
  int of = t->cord[t->n_cords - 1].of, element = t->cord[t->n_cords - 1].element;
  for (int i = 1; i < quotient->h->order && !st; i++) {
    int x = quotient->h->element[i];
    if (t->walked[thr_strands_image(&t->s, x, t->walk[0])]) continue;
    st = add_cord(t, t->walk, n, x, err);
    if (!st)
      make_image(
          t, of,
          quotient->group->product[(size_t)x * (size_t)quotient->group->order + (size_t)element]);
  }
  return st;
}

/* Where cords are looked for: component by component, first from the ends of open ones, by node and
 * half-edge. */
typedef struct {
  int component, inner, tail, half, dart;
} beginning;

static int by_place(const void *a, const void *b)
{
  const beginning *p = a, *q = b;
  const int x[] = {p->component, p->inner, p->tail, p->half, p->dart},
            y[] = {q->component, q->inner, q->tail, q->half, q->dart};
  for (int i = 0; i < 5; i++)
    if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
  return 0;
}

static thr_status trace_all(tracer *t, thr_err *err)
{
  int n = t->s.n_darts;
  beginning *from = thr_calloc((size_t)n, sizeof *from);
  if (!from) return thr_nomem(err);
  for (int d = 0; d < n; d++) {
    int h = thr_strands_half(&t->s, d), v = thr_tail(t->f, h);
    from[d] = (beginning){t->component[v], thr_strands_mate(&t->s, d) >= 0, v, h, d};
  }
  qsort(from, (size_t)n, sizeof *from, by_place);
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    st = add_orbit(t, from[i].dart, !from[i].inner, err);
  free(from);
  return st;
}

/* ---- handing over ---- */

static void tracer_destroy(tracer *t)
{
  for (int i = 0; i < t->n_cords; i++)
    free(t->cord[i].half);
  free(t->cord);
  free(t->unique);
  free(t->walked);
  free(t->walk);
  free(t->scratch);
  thr_strands_destroy(&t->s);
}

static thr_status tracer_init(tracer *t, const thr_quotient *quotient,
                              const thr_cover_options *options, const thr_cover *cover,
                              const int *component, thr_err *err)
{
  *t = (tracer){.f = quotient->f,
                .open = thr_cover_all_open(options),
                .end_steps = thr_cover_steps_of_end(options),
                .component = component};
  thr_status st =
      thr_strands_init(&t->s, quotient, cover, t->open, component, options->most_closed, err);
  if (st) return st;
  size_t n = (size_t)t->s.n_darts;
  t->walked = thr_calloc(n, sizeof *t->walked);
  t->walk = thr_calloc(n, sizeof *t->walk);
  t->scratch = thr_calloc(n, sizeof *t->scratch);
  return t->walked && t->walk && t->scratch ? THR_OK : thr_nomem(err);
}

/* Cords by component, otherwise in the order in which they were found: place[i] of the i-th one
 * found. A unique path, which starts in the lowest of the components that its orbit reaches, stays
 * the first of its kind. */
static thr_status order_cords(const tracer *t, int n_components, int **place, thr_err *err)
{
  int *start = thr_calloc((size_t)n_components + 1, sizeof *start);
  *place = thr_calloc((size_t)t->n_cords, sizeof **place);
  thr_status st = start && *place ? THR_OK : thr_nomem(err);
  for (int i = 0; i < t->n_cords && !st; i++)
    start[t->cord[i].component + 1]++;
  for (int k = 0; k < n_components && !st; k++)
    start[k + 1] += start[k];
  for (int i = 0; i < t->n_cords && !st; i++)
    (*place)[i] = start[t->cord[i].component]++;
  free(start);
  return st;
}

static void copy_image(const thr_quotient *quotient, int x, int *to)
{
  for (int v = 0; v < quotient->f->n_nodes; v++)
    to[v] = quotient->group->image[(size_t)x * (size_t)quotient->group->degree + (size_t)v];
}

/* Generators of H, and the elements that make copies: number[x] becomes the image's number. */
static thr_status record_elements(const tracer *t, int *number, thr_symmetry_record *record,
                                  thr_err *err)
{
  const thr_quotient *quotient = t->s.q;
  size_t n = (size_t)quotient->f->n_nodes;
  int generator[16];
  for (int i = 0; i < t->n_cords; i++)
    number[t->cord[i].element] = 1;
  number[0] = 1;
  for (int x = 0; x < quotient->group->order; x++)
    if (number[x]) number[x] = record->n_images++;
  record->order = quotient->h->order;
  record->n_generators = thr_subgroup_generators(quotient->group, quotient->h, generator);
  record->generator = thr_calloc((size_t)record->n_generators * n, sizeof *record->generator);
  record->image = thr_calloc((size_t)record->n_images * n, sizeof *record->image);
  if (!record->generator || !record->image) return thr_nomem(err);
  for (int i = 0; i < record->n_generators; i++)
    copy_image(quotient, generator[i], record->generator + (size_t)i * n);
  copy_image(quotient, 0, record->image);
  for (int x = 1; x < quotient->group->order; x++)
    if (number[x]) copy_image(quotient, x, record->image + (size_t)number[x] * n);
  return THR_OK;
}

static thr_status make_record(const tracer *t, const int *place, thr_symmetry_record *record,
                              thr_err *err)
{
  size_t n = (size_t)t->n_cords;
  int *number = thr_calloc((size_t)t->s.q->group->order, sizeof *number);
  record->unique = thr_calloc(n, sizeof *record->unique);
  record->element = thr_calloc(n, sizeof *record->element);
  thr_status st = number && record->unique && record->element ? THR_OK : thr_nomem(err);
  if (!st) st = record_elements(t, number, record, err);
  for (int i = 0; i < t->n_cords && !st; i++) {
    record->unique[place[i]] = place[t->unique[t->cord[i].of]];
    record->element[place[i]] = number[t->cord[i].element];
  }
  for (int u = 0; u < t->n_unique && !st; u++) {
    const traced *path = &t->cord[t->unique[u]];
    const bool turns_back =
        path->round && path->half[0] >> 1 == path->half[path->n_passes - 1] >> 1;
    record->steps += steps_of(t, path);
    record->retraced =
        record->retraced || (turns_back && t->end_steps > 0) || ways(t, path, 0, path, 2) > 1;
  }
  record->unique_paths = t->n_unique;
  record->present = true;
  free(number);
  return st;
}

/* Moves the traced cords to their places. */
static thr_status make_cords(tracer *t, const int *place, thr_cord **cord, thr_err *err)
{
  if (!(*cord = thr_calloc((size_t)t->n_cords, sizeof **cord))) return thr_nomem(err);
  for (int i = 0; i < t->n_cords; i++) {
    traced *from = &t->cord[i];
    thr_cord *to = &(*cord)[place[i]];
    *to = (thr_cord){.component = from->component,
                     .closed = from->closed,
                     .n_passes = from->n_passes,
                     .half = from->half};
    thr_cord_id(place[i], to->id);
    from->half = NULL;
  }
  return THR_OK;
}

thr_status thr_cover_cords(const thr_quotient *quotient, const thr_cover_options *options,
                           const thr_cover *cover, thr_cord **cord, int *n_cords,
                           thr_symmetry_record *record, thr_err *err)
{
  int n_components, *place = NULL,
                    *component = thr_calloc((size_t)quotient->f->n_nodes, sizeof *component);
  tracer t = {0};
  *cord = NULL;
  *n_cords = 0;
  *record = (thr_symmetry_record){0};
  thr_status st =
      component ? thr_frame_components(quotient->f, component, &n_components, err) : thr_nomem(err);
  if (!st) st = tracer_init(&t, quotient, options, cover, component, err);
  if (!st) st = trace_all(&t, err);
  if (!st) st = order_cords(&t, n_components, &place, err);
  if (!st) st = make_record(&t, place, record, err);
  if (!st) st = make_cords(&t, place, cord, err);
  if (!st) *n_cords = t.n_cords;
  if (st) thr_symmetry_record_destroy(record);
  tracer_destroy(&t);
  free(place);
  free(component);
  return st;
}

thr_status thr_cords_alone(const thr_frame *frame, const thr_cover_options *options,
                           const thr_cord *cord, int n_cords, thr_symmetry_record *record,
                           thr_err *err)
{
  int identity = 0;
  const thr_subgroup alone = {1, &identity};
  thr_group group = {0};
  thr_quotient quotient = {.f = frame, .group = &group, .h = &alone};
  tracer t = {.f = frame,
              .open = thr_cover_all_open(options),
              .end_steps = thr_cover_steps_of_end(options),
              .s.q = &quotient,
              .s.place = thr_calloc(1, sizeof(int))};
  int *place = thr_calloc((size_t)n_cords, sizeof *place);
  *record = (thr_symmetry_record){0};
  quotient.half_image = thr_calloc(2 * (size_t)frame->n_edges, sizeof *quotient.half_image);
  thr_status st = place && quotient.half_image && t.s.place ? THR_OK : thr_nomem(err);
  if (!st) st = thr_group_generate(frame->n_nodes, NULL, 0, 1, &group, err);
  for (int h = 0; h < 2 * frame->n_edges && !st; h++)
    quotient.half_image[h] = h;
  for (int i = 0; i < n_cords && !st; i++) {
    place[i] = i;
    st = add_given(&t, &cord[i], err);
  }
  if (!st) st = make_record(&t, place, record, err);
  if (st) thr_symmetry_record_destroy(record);
  tracer_destroy(&t);
  thr_group_destroy(&group);
  free(quotient.half_image);
  free(place);
  return st;
}
