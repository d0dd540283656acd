/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Automorphisms in a child process, which can be ended: nauty takes no heed of time. */
#include "graph/process/process.h"
#include "graph/text.h"
#include "symmetry/group/group.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_frame *f;
  const thr_automorphism_options *o;
} job;

/* What comes before the generators: of each how many nodes it moves, and these with their images.
 * Generators of large groups move few, and all their images would be a quarter of a gigabyte. */
typedef struct {
  int n_generators, exponent;
  double mantissa;
} head;

static void put_generator(thr_text *text, const int *image, int n)
{
  int moved = 0;
  for (int v = 0; v < n; v++)
    moved += image[v] != v;
  thr_text_append_bytes(text, (const char *)&moved, sizeof moved);
  for (int v = 0; v < n; v++)
    if (image[v] != v)
      thr_text_append_bytes(text, (const char *)(const int[]){v, image[v]}, 2 * sizeof v);
}

/* Fills image[n] from what put_generator wrote; returns what follows. */
static const char *take_generator(const char *data, int *image, int n)
{
  int moved, pair[2];
  for (int v = 0; v < n; v++)
    image[v] = v;
  memcpy(&moved, data, sizeof moved);
  data += sizeof moved;
  for (; moved > 0; moved--, data += sizeof pair) {
    memcpy(pair, data, sizeof pair);
    image[pair[0]] = pair[1];
  }
  return data;
}

static thr_status run(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  (void)limits;
  const job *j = user;
  thr_automorphisms a;
  thr_text text = {0};
  thr_status st = thr_automorphisms_find(j->f, j->o, &a, err);
  const head h = {a.n_generators, a.exponent, a.mantissa};
  if (st) return st;
  thr_text_append_bytes(&text, (const char *)&h, sizeof h);
  for (int g = 0; g < a.n_generators; g++)
    put_generator(&text, a.generator + (size_t)g * (size_t)a.n, a.n);
  st = thr_child_send(to, &text, err);
  thr_text_destroy(&text);
  thr_automorphisms_destroy(&a);
  return st;
}

/* The answer of the child; an empty one is the identity alone. */
static thr_status take(const thr_text *text, const thr_frame *frame, thr_automorphisms *out,
                       thr_err *err)
{
  head h = {0, 0, 1};
  if (text->length) memcpy(&h, text->data, sizeof h);
  thr_automorphisms a = {.n = frame->n_nodes,
                         .n_generators = h.n_generators,
                         .mantissa = h.mantissa,
                         .exponent = h.exponent};
  size_t n = (size_t)a.n;
  const char *data = text->data + (text->length ? sizeof h : 0);
  a.generator = thr_calloc((size_t)h.n_generators * n, sizeof *a.generator);
  for (int g = 0; a.generator && g < h.n_generators; g++)
    data = take_generator(data, a.generator + (size_t)g * n, a.n);
  thr_status st = a.generator ? thr_automorphisms_orbits(&a, err) : thr_nomem(err);
  if (st) thr_automorphisms_destroy(&a);
  *out = a;
  return st;
}

thr_status thr_automorphisms_within(const thr_frame *frame, const thr_automorphism_options *options,
                                    const thr_limits *limits, bool *all, thr_automorphisms *out,
                                    thr_err *err)
{
  job j = {frame, options};
  const thr_child child = {.what = "automorphisms", .run = run, .user = &j};
  thr_text answer = {0};
  thr_err why = {0};
  *all = true;
  *out = (thr_automorphisms){0};
  if (limits->deadline == 0 && !limits->interrupted)
    return thr_automorphisms_find(frame, options, out, err);
  thr_status st = thr_child_run(&child, limits, &answer, &why);
  *all = !(st == THR_ELIMIT && thr_limits_stop(limits));
  st = st && *all ? thr_fail(err, st, "%s", why.text) : take(&answer, frame, out, err);
  thr_text_destroy(&answer);
  return st;
}
