/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the reader fuzzers share: a draft that was read must weld into a sound framework that
 * survives being written and read again. Broken invariants abort. */
#ifndef THR_FUZZ_H
#define THR_FUZZ_H

#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MUST(condition) ((condition) ? (void)0 : broken(__LINE__, #condition))

static void broken(int line, const char *condition)
{
  fprintf(stderr, "fuzz.h:%d: broken: %s\n", line, condition);
  abort();
}

static void check_frame(const thr_frame *f, const thr_read_report *r)
{
  int degrees = 0;
  for (int v = 0; v < f->n_nodes; v++) {
    MUST(isfinite(f->xyz[v][0]) && isfinite(f->xyz[v][1]) && isfinite(f->xyz[v][2]));
    MUST(f->name[v] && f->name[v][0] && thr_degree(f, v) > 0);
    degrees += thr_degree(f, v);
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      MUST(thr_tail(f, f->half[i]) == v && (i == f->first[v] || f->half[i] > f->half[i - 1]));
  }
  MUST(degrees == 2 * f->n_edges && f->n_edges > 0);
  for (int e = 0; e < f->n_edges; e++) {
    MUST(f->edge[e][0] >= 0 && f->edge[e][0] < f->n_nodes && f->edge[e][1] >= 0 &&
         f->edge[e][1] < f->n_nodes);
    MUST(f->edge[e][0] != f->edge[e][1]);
    MUST(isfinite(f->length[e]) && f->length[e] > 0);
  }
  MUST(r->nodes_read == f->n_nodes + r->welded_nodes + r->isolated_nodes);
  MUST(r->edges_read == f->n_edges + r->duplicate_edges + r->zero_length_edges);
}

/* Writes, reads and compares: JSON keeps all, OBJ all but names, CSV the edges. The tolerance is
 * that of the first reading: the default one depends on the edges that are left, and may grow. */
static void check_round_trip(const thr_frame *f, double tolerance, const thr_format *format)
{
  thr_text text = {0};
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_frame g = {0};
  thr_frame_write(f, format, &text);
  MUST(!text.failed);
  MUST(thr_draft_parse(&d, &r, text.data, text.length, "again", format, NULL) == THR_OK);
  MUST(thr_draft_build(&d, tolerance, &g, &r, NULL) == THR_OK);
  MUST(g.n_nodes == f->n_nodes && g.n_edges == f->n_edges);
  if (format != thr_format_named("csv")) MUST(thr_frame_hash(&g) == thr_frame_hash(f));
  MUST(!g.cover == !f->cover && !g.capacity == !f->capacity);
  for (int e = 0; e < f->n_edges; e++)
    MUST((!f->cover || g.cover[e] == f->cover[e]) &&
         (!f->capacity || g.capacity[e] == f->capacity[e]));
  MUST(memcmp(g.length, f->length, (size_t)f->n_edges * sizeof *f->length) == 0);
  if (format != thr_format_named("csv")) MUST(strcmp(f->units, g.units) == 0);
  if (format == thr_format_named("json") || format == thr_format_named("graphml")) {
    for (int v = 0; v < f->n_nodes; v++)
      MUST(strcmp(f->name[v], g.name[v]) == 0);
  }
  thr_frame_destroy(&g);
  thr_draft_destroy(&d);
  thr_text_destroy(&text);
}

/* Whatever was read can be looked over, and cut where it touches itself. */
static void check_nearly(thr_frame *f)
{
  thr_near near;
  thr_read_report r = {0};
  int n_cut;
  thr_err err = {0};
  thr_status st = thr_frame_near(f, &near, &err);
  MUST(st == THR_OK || st == THR_EINPUT);
  const int on_edge = near.n_on_edge;
  st = thr_frame_split(f, &n_cut, &r, &err);
  MUST(st ? err.code == st : n_cut <= on_edge && f->n_edges > 0);
}

/* Takes over a draft that was read with status st. */
static void check_draft(thr_status st, thr_draft *d, thr_read_report *r, const thr_err *err)
{
  thr_frame f = {0};
  MUST(st == THR_OK || ((st == THR_EINPUT) && err->code == st && err->text[0] && d->n_nodes == 0 &&
                        d->n_edges == 0));
  if (st == THR_OK && thr_draft_build(d, -1, &f, r, NULL) == THR_OK) {
    check_frame(&f, r);
    check_round_trip(&f, r->weld_tolerance, thr_format_named("json"));
    if (!f.own_lengths && !f.cover && !f.capacity) /* which OBJ cannot say */
      check_round_trip(&f, r->weld_tolerance, thr_format_named("obj"));
    check_round_trip(&f, r->weld_tolerance, thr_format_named("csv"));
    check_round_trip(&f, r->weld_tolerance, thr_format_named("graphml"));
    check_nearly(&f);
  }
  thr_frame_destroy(&f);
  thr_draft_destroy(d);
}

static inline void fuzz_one(const uint8_t *data, size_t size, const thr_format *format)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  thr_status st = thr_draft_parse(&d, &r, (const char *)data, size, "fuzz", format, &err);
  check_draft(st, &d, &r, &err);
}

#endif
