/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds automorphisms in a child process, which the limits can end: nauty takes no heed of time.
 *
 * The child sends a header, and of every generator the nodes that it moves with their images.
 *
 * Example: a generator (0 2 1 3) is sent as 2, then 1 2 and 2 1. */
#include "graph/process/process.h"
#include "graph/text.h"
#include "symmetry/group/group.h"

#include <string.h>

/* What the child is asked for. */
typedef struct {
  const thr_frame *frame;
  const thr_automorphism_options *options;
} automorphism_job;

/* What comes before the generators. Generators of large groups move few nodes, and all their images
 * would take a quarter of a gigabyte. */
typedef struct {
  int n_generators, exponent;
  double mantissa;
} answer_head;

/* Appends a generator: how many nodes it moves, and these with their images. */
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
  /* All nodes stay, but for the listed ones. */
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

/* Finds the automorphisms, and sends them: what the child does. */
static thr_status run_traces(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  (void)limits;
  const automorphism_job *job = user;
  thr_automorphisms automorphisms;
  thr_text text = {0};
  thr_status st = thr_automorphisms_find(job->frame, job->options, &automorphisms, err);
  const answer_head header = {automorphisms.n_generators, automorphisms.exponent,
                              automorphisms.mantissa};
  if (st) return st;

  /* Header and generators. */
  thr_text_append_bytes(&text, (const char *)&header, sizeof header);
  for (int generator = 0; generator < automorphisms.n_generators; generator++)
    put_generator(&text, automorphisms.generator + (size_t)generator * (size_t)automorphisms.n,
                  automorphisms.n);

  st = thr_child_send(to, &text, err);
  thr_text_destroy(&text);
  thr_automorphisms_destroy(&automorphisms);
  return st;
}

/* Fills *out with the child's answer; an empty one is the identity alone. */
static thr_status take_answer(const thr_text *text, const thr_frame *frame, thr_automorphisms *out,
                              thr_err *err)
{
  answer_head header = {0, 0, 1};
  /* The header. */
  if (text->length) memcpy(&header, text->data, sizeof header);
  thr_automorphisms automorphisms = {.n = frame->n_nodes,
                                     .n_generators = header.n_generators,
                                     .mantissa = header.mantissa,
                                     .exponent = header.exponent};
  size_t n = (size_t)automorphisms.n;
  const char *data = text->data + (text->length ? sizeof header : 0);

  /* The generators. */
  automorphisms.generator =
      thr_calloc((size_t)header.n_generators * n, sizeof *automorphisms.generator);
  for (int generator = 0; automorphisms.generator && generator < header.n_generators; generator++)
    data = take_generator(data, automorphisms.generator + (size_t)generator * n, automorphisms.n);
  thr_status st =
      automorphisms.generator ? thr_automorphisms_orbits(&automorphisms, err) : thr_nomem(err);

  if (st) thr_automorphisms_destroy(&automorphisms);
  *out = automorphisms;
  return st;
}

thr_status thr_automorphisms_within(const thr_frame *frame, const thr_automorphism_options *options,
                                    const thr_limits *limits, bool *all, thr_automorphisms *out,
                                    thr_err *err)
{
  automorphism_job job = {frame, options};
  const thr_child child = {.what = "automorphisms", .run = run_traces, .user = &job};
  thr_text answer = {0};
  thr_err why = {0};
  *all = true;
  *out = (thr_automorphisms){0};

  /* Without limits that stop anything no child is needed. */
  if (limits->deadline == 0 && !limits->interrupted)
    return thr_automorphisms_find(frame, options, out, err);

  thr_status st = thr_child_run(&child, limits, &answer, &why);

  /* Did the limits end the child? */
  *all = !(st == THR_ELIMIT && thr_limits_stop(limits));
  st = st && *all ? thr_fail(err, st, "%s", why.text) : take_answer(&answer, frame, out, err);
  thr_text_destroy(&answer);
  return st;
}
