/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Traces the cords of a symmetric cover, with copies as images of their unique paths, and makes the
 * record that says so.
 *
 * From every dart that is not walked yet a cord is followed over copies and turns
 * (symmetry/lift/strands.c). Its images under the group are cords, too, and the first of its orbit
 * is compared with the unique paths so far: cords that run through the same nodes are copies of one
 * path.
 *
 * Example: four cords that C4 maps to each other: the first is a unique path, and the others are
 * its images under three elements of the group. */
#include "graph/threading/threading.h"
#include "symmetry/lift/lift.h"

#include <stdlib.h>
#include <string.h>

/* A traced cord: the image of unique path `of` under an element of G. */
typedef struct {
  int *half;
  int n_passes, component, of, element;
  bool closed, round; /* round: it does not matter where it starts */
} traced;

/* The cords so far. */
typedef struct {
  thr_strands strands;
  const thr_frame *frame;
  bool open;            /* every cord is open: where a cord ends matters (thr_cover_all_open) */
  int end_steps;        /* of every end (thr_cover_steps_of_end) */
  const int *component; /* [n_nodes] */
  bool *walked;         /* [darts] of the cords so far */
  int *walk, *scratch;  /* [darts] the leaving darts of the cord at hand */
  traced *cord;
  int n_cords, capacity;
  int *unique; /* [n_unique] cord that is the first of its kind */
  int n_unique, unique_capacity;
} cord_tracer;

/* Returns the image of a half-edge under an element of H. */
static int half_image(const cord_tracer *tracer, int element, int half)
{
  return tracer->strands.q
      ->half_image[(size_t)tracer->strands.place[element] * 2 * (size_t)tracer->frame->n_edges +
                   (size_t)half];
}

/* ---- equal cords ---- */

/* Tells whether an element maps cord a to cord b, from pass `shift` of b on, forward or backward.
 */
static bool matches(const cord_tracer *tracer, const traced *a, int element, const traced *b,
                    int shift, bool reverse)
{
  int n = a->n_passes;
  for (int i = 0; i < n; i++) {
    /* A reversed pass is the other half-edge. */
    int k = reverse ? (shift + n - i) % n : (shift + i) % n;
    if (half_image(tracer, element, a->half[i]) != (b->half[k] ^ (int)reverse)) return false;
  }
  return true;
}

/* Returns in how many ways an element maps cord a to cord b as a path in the framework: forward or
 * reversed, and from any start if the cords run round. Stops counting at `enough`. */
static int count_ways(const cord_tracer *tracer, const traced *a, int element, const traced *b,
                      int enough)
{
  int n = a->n_passes, found = 0;
  if (n != b->n_passes || a->round != b->round) return 0;

  /* An open cord from either end. */
  if (!a->round)
    return matches(tracer, a, element, b, 0, false) + matches(tracer, a, element, b, n - 1, true);

  /* A cord that runs round from every pass, in either direction. */
  for (int shift = 0; shift < n && found < enough; shift++)
    found +=
        matches(tracer, a, element, b, shift, false) + matches(tracer, a, element, b, shift, true);
  return found;
}

/* Returns the lowest element that maps cord a to cord b, or -1. */
static int element_between(const cord_tracer *tracer, const traced *a, const traced *b)
{
  const thr_subgroup *subgroup = tracer->strands.q->h;
  for (int i = 0; i < subgroup->order; i++)
    if (count_ways(tracer, a, subgroup->element[i], b, 1) > 0) return subgroup->element[i];
  return -1;
}

/* Tells whether an element fixes every half-edge of a cord. */
static bool is_fixed_by(const cord_tracer *tracer, const traced *a, int element)
{
  for (int i = 0; i < a->n_passes; i++)
    if (half_image(tracer, element, a->half[i]) != a->half[i]) return false;
  return true;
}

/* Returns what has to be learned of a unique path: its passes and, unless it runs round, the steps
 * of its two ends, divided by the number of elements of H that map it to itself; elements that fix
 * all its half-edges count as one. */
static double steps_of(const cord_tracer *tracer, const traced *a)
{
  const thr_subgroup *subgroup = tracer->strands.q->h;
  int mapped = 0, fixed = 0;
  for (int i = 0; i < subgroup->order; i++) {
    mapped += count_ways(tracer, a, subgroup->element[i], a, 1) > 0;
    fixed += is_fixed_by(tracer, a, subgroup->element[i]);
  }

  return (double)(a->n_passes + (a->round ? 0 : 2 * tracer->end_steps)) * fixed / mapped;
}

/* ---- tracing ---- */

/* Follows the cord from this leaving dart until it ends or comes back: fills tracer->walk with
 * leaving darts, and returns how many there are. */
static int trace(cord_tracer *tracer, int dart)
{
  int n = 0, start = dart;
  do {
    tracer->walk[n++] = dart;
    dart = thr_strands_mate(&tracer->strands, thr_strands_across(&tracer->strands, dart));
  } while (dart >= 0 && dart != start);
  return n;
}

/* Rotates the walk of a closed cord so that it starts where it turns most: its two ends come out
 * there instead of turning. */
static void start_sharpest(cord_tracer *tracer, int n)
{
  for (int i = 0; i < n; i++)
    tracer->scratch[i] = thr_strands_half(&tracer->strands, tracer->walk[i]);
  const int best = thr_tour_start(tracer->frame, NULL, tracer->scratch, n);
  memcpy(tracer->scratch, tracer->walk, (size_t)n * sizeof *tracer->walk);
  for (int i = 0; i < n; i++)
    tracer->walk[i] = tracer->scratch[(best + i) % n];
}

/* Appends the image of a walk of n darts under an element as a cord. */
static thr_status add_cord(cord_tracer *tracer, const int *walk, int n, int element, thr_err *err)
{
  thr_status st =
      thr_grow(&tracer->cord, tracer->n_cords, &tracer->capacity, sizeof *tracer->cord, err);
  if (st) return st;

  traced added = {.half = thr_calloc((size_t)n, sizeof *added.half), .n_passes = n};
  if (!added.half) return thr_nomem(err);

  /* Its half-edges; its darts are walked now. */
  for (int i = 0; i < n; i++) {
    int dart = thr_strands_image(&tracer->strands, element, walk[i]);
    tracer->walked[dart] = tracer->walked[thr_strands_across(&tracer->strands, dart)] = true;
    added.half[i] = thr_strands_half(&tracer->strands, dart);
  }

  /* A closed cord may start anywhere, unless its ends matter. */
  added.closed =
      thr_tail(tracer->frame, added.half[0]) == thr_head(tracer->frame, added.half[n - 1]);
  added.round = added.closed && !tracer->open;
  added.component = tracer->component[thr_tail(tracer->frame, added.half[0])];
  tracer->cord[tracer->n_cords++] = added;
  return THR_OK;
}

/* Makes the last cord the image of unique path `of` under an element: it runs that way already, and
 * now starts and ends there, too. */
static void make_image(cord_tracer *tracer, int of, int element)
{
  traced *last = &tracer->cord[tracer->n_cords - 1];
  const traced *path = &tracer->cord[tracer->unique[of]];
  for (int i = 0; i < last->n_passes; i++)
    last->half[i] = half_image(tracer, element, path->half[i]);
  last->of = of;
  last->element = element;
}

/* Finds out whether the last cord, the first of its orbit, is a copy of an earlier unique path that
 * runs through the same nodes. If not it is a new unique path. */
static thr_status classify_last(cord_tracer *tracer, thr_err *err)
{
  traced *last = &tracer->cord[tracer->n_cords - 1];

  /* Does an earlier path run there? */
  for (int kind = 0; kind < tracer->n_unique; kind++) {
    int element = element_between(tracer, &tracer->cord[tracer->unique[kind]], last);
    if (element < 0) continue;
    make_image(tracer, kind, element);
    return THR_OK;
  }

  /* A new one. */
  thr_status st = thr_grow(&tracer->unique, tracer->n_unique, &tracer->unique_capacity,
                           sizeof *tracer->unique, err);
  if (st) return st;
  last->of = tracer->n_unique;
  tracer->unique[tracer->n_unique++] = tracer->n_cords - 1;
  return THR_OK;
}

/* Adds a cord that is given, instead of traced. */
static thr_status add_given(cord_tracer *tracer, const thr_cord *cord, thr_err *err)
{
  thr_status st =
      thr_grow(&tracer->cord, tracer->n_cords, &tracer->capacity, sizeof *tracer->cord, err);
  if (st) return st;

  traced added = {.half = thr_calloc((size_t)cord->n_passes, sizeof *added.half),
                  .n_passes = cord->n_passes};
  if (!added.half) return thr_nomem(err);

  /* Its half-edges are copied. */
  memcpy(added.half, cord->half, (size_t)cord->n_passes * sizeof *added.half);
  added.closed = cord->closed;
  added.round = added.closed && !tracer->open;

  tracer->cord[tracer->n_cords++] = added;
  return classify_last(tracer, err);
}

/* Adds the cord from this dart on and its images under H, unless it is walked already. */
static thr_status add_orbit(cord_tracer *tracer, int dart, bool open, thr_err *err)
{
  const thr_quotient *quotient = tracer->strands.q;
  if (tracer->walked[dart]) return THR_OK;

  /* The cord itself. */
  int n = trace(tracer, dart);
  if (!open) start_sharpest(tracer, n);
  thr_status st = add_cord(tracer, tracer->walk, n, 0, err);
  if (!st) st = classify_last(tracer, err);
  if (st) return st;

  /* Its images, as images of the unique path. */
  int of = tracer->cord[tracer->n_cords - 1].of,
      element = tracer->cord[tracer->n_cords - 1].element;
  for (int i = 1; i < quotient->h->order && !st; i++) {
    int image = quotient->h->element[i];
    if (tracer->walked[thr_strands_image(&tracer->strands, image, tracer->walk[0])]) continue;
    st = add_cord(tracer, tracer->walk, n, image, err);
    if (!st)
      make_image(tracer, of,
                 quotient->group
                     ->product[(size_t)image * (size_t)quotient->group->order + (size_t)element]);
  }
  return st;
}

/* A dart where a cord may begin, and the key that all are sorted by: component by component, first
 * the ends of open cords, then by node and half-edge. */
typedef struct {
  int component, inner, tail, half, dart;
} beginning;

/* Compares beginnings by their keys. */
static int by_place(const void *a, const void *b)
{
  const beginning *first = a, *second = b;

  /* The first key that differs decides. */
  const int first_key[] = {first->component, first->inner, first->tail, first->half, first->dart},
            second_key[] = {second->component, second->inner, second->tail, second->half,
                            second->dart};
  for (int i = 0; i < 5; i++)
    if (first_key[i] != second_key[i]) return first_key[i] < second_key[i] ? -1 : 1;
  return 0;
}

/* Traces all cords, from every dart in the order of beginnings. */
static thr_status trace_all(cord_tracer *tracer, thr_err *err)
{
  int n = tracer->strands.n_darts;

  beginning *from = thr_calloc((size_t)n, sizeof *from);
  if (!from) return thr_nomem(err);
  /* The key of every dart. */
  for (int d = 0; d < n; d++) {
    int h = thr_strands_half(&tracer->strands, d), v = thr_tail(tracer->frame, h);
    from[d] =
        (beginning){tracer->component[v], thr_strands_mate(&tracer->strands, d) >= 0, v, h, d};
  }
  qsort(from, (size_t)n, sizeof *from, by_place);

  /* In the order of the keys. */
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    st = add_orbit(tracer, from[i].dart, !from[i].inner, err);
  free(from);
  return st;
}

/* ---- cords and record ---- */

/* Frees everything, also what tracer_init has left unfinished. */
static void tracer_destroy(cord_tracer *tracer)
{
  for (int i = 0; i < tracer->n_cords; i++)
    free(tracer->cord[i].half);
  free(tracer->cord);
  free(tracer->unique);
  free(tracer->walked);
  free(tracer->walk);
  free(tracer->scratch);
  thr_strands_destroy(&tracer->strands);
}

/* Initializes tracer with the strands of a cover; the caller destroys it also on failure. */
static thr_status tracer_init(cord_tracer *tracer, const thr_quotient *quotient,
                              const thr_cover_options *options, const thr_cover *cover,
                              const int *component, thr_err *err)
{
  *tracer = (cord_tracer){.frame = quotient->f,
                          .open = thr_cover_all_open(options),
                          .end_steps = thr_cover_steps_of_end(options),
                          .component = component};

  /* The strands. */
  thr_status st = thr_strands_init(&tracer->strands, quotient, cover, tracer->open, component,
                                   options->most_closed, err);
  if (st) return st;

  /* Walks. */
  size_t n = (size_t)tracer->strands.n_darts;
  tracer->walked = thr_calloc(n, sizeof *tracer->walked);
  tracer->walk = thr_calloc(n, sizeof *tracer->walk);
  tracer->scratch = thr_calloc(n, sizeof *tracer->scratch);
  return tracer->walked && tracer->walk && tracer->scratch ? THR_OK : thr_nomem(err);
}

/* Orders the cords by component, and otherwise as they were found: place[i] of the i-th one found.
 * A unique path starts in the lowest component that its orbit reaches, and so stays the first of
 * its kind. */
static thr_status order_cords(const cord_tracer *tracer, int n_components, int **place,
                              thr_err *err)
{
  int *start = thr_calloc((size_t)n_components + 1, sizeof *start);
  *place = thr_calloc((size_t)tracer->n_cords, sizeof **place);
  thr_status st = start && *place ? THR_OK : thr_nomem(err);
  /* A counting sort. */
  for (int i = 0; i < tracer->n_cords && !st; i++)
    start[tracer->cord[i].component + 1]++;

  /* Places, component by component. */
  for (int k = 0; k < n_components && !st; k++)
    start[k + 1] += start[k];
  for (int i = 0; i < tracer->n_cords && !st; i++)
    (*place)[i] = start[tracer->cord[i].component]++;

  free(start);
  return st;
}

/* Copies the images of all nodes under an element. */
static void copy_image(const thr_quotient *quotient, int element, int *to)
{
  for (int v = 0; v < quotient->f->n_nodes; v++)
    to[v] = quotient->group->image[(size_t)element * (size_t)quotient->group->degree + (size_t)v];
}

/* Records the generators of H, and the elements that make copies: number[element] becomes the
 * number of its images. */
static thr_status record_elements(const cord_tracer *tracer, int *number,
                                  thr_symmetry_record *record, thr_err *err)
{
  const thr_quotient *quotient = tracer->strands.q;
  size_t n = (size_t)quotient->f->n_nodes;
  int generator[16];

  /* Elements in use, the identity among them, are numbered. */
  for (int i = 0; i < tracer->n_cords; i++)
    number[tracer->cord[i].element] = 1;
  number[0] = 1;
  for (int element = 0; element < quotient->group->order; element++)
    if (number[element]) number[element] = record->n_images++;

  /* Their images, and those of the generators. */
  record->order = quotient->h->order;
  record->n_generators = thr_subgroup_generators(quotient->group, quotient->h, generator);
  record->generator = thr_calloc((size_t)record->n_generators * n, sizeof *record->generator);
  record->image = thr_calloc((size_t)record->n_images * n, sizeof *record->image);
  if (!record->generator || !record->image) return thr_nomem(err);

  for (int i = 0; i < record->n_generators; i++)
    copy_image(quotient, generator[i], record->generator + (size_t)i * n);
  copy_image(quotient, 0, record->image);
  for (int element = 1; element < quotient->group->order; element++)
    if (number[element]) copy_image(quotient, element, record->image + (size_t)number[element] * n);
  return THR_OK;
}

/* Records which cord is a copy of which, and what is to be learned. */
static thr_status make_record(const cord_tracer *tracer, const int *place,
                              thr_symmetry_record *record, thr_err *err)
{
  size_t n = (size_t)tracer->n_cords;
  int *number = thr_calloc((size_t)tracer->strands.q->group->order, sizeof *number);
  record->unique = thr_calloc(n, sizeof *record->unique);
  record->element = thr_calloc(n, sizeof *record->element);
  thr_status st = number && record->unique && record->element ? THR_OK : thr_nomem(err);
  if (!st) st = record_elements(tracer, number, record, err);

  /* Copies. */
  for (int i = 0; i < tracer->n_cords && !st; i++) {
    record->unique[place[i]] = place[tracer->unique[tracer->cord[i].of]];
    record->element[place[i]] = number[tracer->cord[i].element];
  }

  /* Steps of the unique paths. Such a path may be walked in more than one way, or turn back where
   * it comes out. */
  for (int kind = 0; kind < tracer->n_unique && !st; kind++) {
    const traced *path = &tracer->cord[tracer->unique[kind]];
    const bool turns_back =
        path->round && path->half[0] >> 1 == path->half[path->n_passes - 1] >> 1;
    record->steps += steps_of(tracer, path);
    record->retraced = record->retraced || (turns_back && tracer->end_steps > 0) ||
                       count_ways(tracer, path, 0, path, 2) > 1;
  }

  record->unique_paths = tracer->n_unique;
  record->present = true;
  free(number);
  return st;
}

/* Moves the traced cords to their places. */
static thr_status make_cords(cord_tracer *tracer, const int *place, thr_cord **cord, thr_err *err)
{
  if (!(*cord = thr_calloc((size_t)tracer->n_cords, sizeof **cord))) return thr_nomem(err);
  /* Half-edges change hands. */
  for (int i = 0; i < tracer->n_cords; i++) {
    traced *from = &tracer->cord[i];
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

  cord_tracer tracer = {0};
  *cord = NULL;
  *n_cords = 0;
  *record = (thr_symmetry_record){0};

  thr_status st =
      component ? thr_frame_components(quotient->f, component, &n_components, err) : thr_nomem(err);

  /* Trace, order and record. */
  if (!st) st = tracer_init(&tracer, quotient, options, cover, component, err);
  if (!st) st = trace_all(&tracer, err);
  if (!st) st = order_cords(&tracer, n_components, &place, err);
  if (!st) st = make_record(&tracer, place, record, err);
  if (!st) st = make_cords(&tracer, place, cord, err);

  if (!st) *n_cords = tracer.n_cords;
  if (st) thr_symmetry_record_destroy(record);

  tracer_destroy(&tracer);
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
  /* A quotient by the identity, without types. */
  thr_group group = {0};
  thr_quotient quotient = {.f = frame, .group = &group, .h = &alone};
  cord_tracer tracer = {.frame = frame,
                        .open = thr_cover_all_open(options),
                        .end_steps = thr_cover_steps_of_end(options),
                        .strands.q = &quotient,
                        .strands.place = thr_calloc(1, sizeof(int))};
  int *place = thr_calloc((size_t)n_cords, sizeof *place);
  *record = (thr_symmetry_record){0};
  quotient.half_image = thr_calloc(2 * (size_t)frame->n_edges, sizeof *quotient.half_image);
  thr_status st = place && quotient.half_image && tracer.strands.place ? THR_OK : thr_nomem(err);

  /* Given cords instead of traced ones. */
  if (!st) st = thr_group_generate(frame->n_nodes, NULL, 0, 1, &group, err);
  for (int h = 0; h < 2 * frame->n_edges && !st; h++)
    quotient.half_image[h] = h;
  for (int i = 0; i < n_cords && !st; i++) {
    place[i] = i;
    st = add_given(&tracer, &cord[i], err);
  }

  /* The record. */
  if (!st) st = make_record(&tracer, place, record, err);
  if (st) thr_symmetry_record_destroy(record);
  tracer_destroy(&tracer);
  thr_group_destroy(&group);
  free(quotient.half_image);
  free(place);
  return st;
}
