/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fuzzes the reader of plans and the checker: what parses is checked without a crash, and is
 * written and read again as the same bytes with the same verdict. What the checker lets through is
 * evaluated as well. */
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MUST(condition) ((condition) ? (void)0 : broken(__LINE__, #condition))

static void broken(int line, const char *condition)
{
  fprintf(stderr, "fuzz_plan.c:%d: broken: %s\n", line, condition);
  abort();
}

static bool one_line(const thr_err *err)
{
  return err->text[0] && !strchr(err->text, '\n');
}

/* Passes that run over edges of the framework, whatever their order. */
static void must_be_sound(const thr_plan *p)
{
  for (int i = 0; i < p->n_cords; i++) {
    MUST(p->cord[i].n_passes > 0);
    for (int k = 0; k < p->cord[i].n_passes; k++)
      MUST(p->cord[i].half[k] >= 0 && p->cord[i].half[k] / 2 < p->frame.n_edges);
  }
}

/* What is proved of the turning, whoever made up the multipliers, is less than the cords' own. */
static void must_bound(const thr_plan *p)
{
  const thr_turning_claim *c = &p->turning;
  double rounding = 1e-6 * (1 + c->price);
  if (!c->present) return;
  MUST(c->lower_bound <= c->price + rounding);
  MUST(c->largest_bound <= c->largest + rounding);
}

static void must_survive(const thr_plan *p, thr_status verdict)
{
  thr_text once = {0}, twice = {0};
  thr_plan back;
  thr_plan_write(p, &once);
  MUST(!once.failed);
  MUST(thr_plan_parse(&back, once.data, once.length, "again", NULL) == THR_OK);
  MUST(thr_check_plan(&back, NULL) == verdict);
  thr_plan_write(&back, &twice);
  MUST(once.length == twice.length && memcmp(once.data, twice.data, once.length) == 0);
  thr_plan_destroy(&back);
  thr_text_destroy(&once);
  thr_text_destroy(&twice);
}

static void must_pull(const thr_plan *p)
{
  thr_eval e;
  thr_limits none = {0};
  thr_eval_options o = thr_eval_options_default();
  thr_status st = thr_eval_plan(&p->frame, p->cord, p->n_cords, THR_CAPSTAN, &o, &none, &e, NULL);
  MUST(st == THR_OK || st == THR_EINPUT);
  for (int i = 0; i < e.record.n_cords; i++)
    MUST(e.record.cord[i].force >= o.physics.seating);
  thr_eval_destroy(&e);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  thr_plan p;
  thr_err err = {0};
  thr_status st = thr_plan_parse(&p, (const char *)data, size, "fuzz", &err);
  MUST(st == THR_OK ||
       ((st == THR_EINPUT || st == THR_EVIOLATED) && one_line(&err) && !p.cord && !p.frame.xyz));
  if (st == THR_OK) {
    must_be_sound(&p);
    st = thr_check_plan(&p, &err);
    MUST(st == THR_OK || (st == THR_EVIOLATED && one_line(&err)));
    must_survive(&p, st);
    if (st == THR_OK) {
      must_bound(&p);
      must_pull(&p);
    }
  }
  thr_plan_destroy(&p);
  return 0;
}
