/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fuzzes the reader of physics (config files, options.physics of plans) and what is made of it:
 * what parses is in range, survives being written and read again, and resolves against a framework
 * to sizes that fit, or is refused. */
#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/plan/physics.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MUST(condition) ((condition) ? (void)0 : broken(__LINE__, #condition))

static void broken(int line, const char *condition)
{
  fprintf(stderr, "fuzz_physics.c:%d: broken: %s\n", line, condition);
  abort();
}

static bool one_line(const thr_err *err)
{
  return err->text[0] && !strchr(err->text, '\n');
}

static thr_status parse(const char *text, size_t n, thr_physics *p, thr_err *err)
{
  thr_json *doc;
  thr_status st = thr_json_parse(&doc, text, n, "fuzz", err);
  if (!st) st = thr_physics_from_json(p, doc, "fuzz", err);
  thr_json_destroy(doc);
  return st;
}

static bool same(const thr_physics *a, const thr_physics *b)
{
  bool equal = strcmp(a->preset, b->preset) == 0;
  for (int i = 0; i < thr_physics_n_fields; i++)
    equal &=
        thr_physics_get(a, &thr_physics_fields[i]) == thr_physics_get(b, &thr_physics_fields[i]);
  return equal;
}

static void must_be_in_range(const thr_physics *p)
{
  for (int i = 0; i < thr_physics_n_fields; i++) {
    const thr_physics_field *f = &thr_physics_fields[i];
    double value = thr_physics_get(p, f);
    MUST(value >= f->low && value <= f->high && (value > 0 || !f->positive));
  }
}

static void must_survive(const thr_physics *p)
{
  thr_text t = {0};
  thr_physics back = thr_physics_default();
  thr_physics_write(p, &(thr_writer){.out = &t}, NULL);
  MUST(!t.failed);
  MUST(parse(t.data, t.length, &back, NULL) == THR_OK && same(p, &back));
  thr_text_destroy(&t);
}

/* Three edges of 10, 20 and 40 mm. */
static void must_resolve(const thr_physics *p)
{
  double xyz[4][3] = {{0, 0, 0}, {10, 0, 0}, {10, 20, 0}, {10, 20, 40}};
  int edge[3][2] = {{0, 1}, {1, 2}, {2, 3}};
  char *name[4] = {"a", "b", "c", "d"};
  const thr_frame f = {
      .n_nodes = 4, .n_edges = 3, .xyz = xyz, .edge = edge, .name = name, .units = "mm"};
  thr_physics r, again;
  thr_err err = {0};
  thr_status st = thr_physics_resolve(p, &f, &r, &err);
  MUST(st == THR_OK || (st == THR_EINPUT && one_line(&err)));
  if (st) return;
  must_be_in_range(&r);
  MUST(0 < r.cord_diameter && r.cord_diameter < r.bore && r.bore < r.bead_diameter && r.bore < 10);
  MUST(r.mu_low <= r.mu && r.mu <= r.mu_high && r.density + r.bead_mass > 0);
  MUST(thr_physics_resolve(&r, &f, &again, NULL) == THR_OK && same(&r, &again));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  thr_physics p = thr_physics_default(), before = p;
  thr_err err = {0};
  thr_status st = parse((const char *)data, size, &p, &err);
  MUST(st == THR_OK || (st == THR_EINPUT && one_line(&err) && same(&p, &before)));
  must_be_in_range(&p);
  must_survive(&p);
  must_resolve(&p);
  return 0;
}
