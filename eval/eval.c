/* One interface to the three methods: checks what is asked, prepares the record, calls the method, sums up. */
#include "eval/methods.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

thr_eval_options thr_eval_options_default(void)
{
  return (thr_eval_options){
      .physics = thr_physics_default(), .pull = THR_PULL_BOTH, .time_step = 1, .iterations = 1, .processes = 1, .dynamics = true};
}

void thr_eval_destroy(thr_eval *e)
{
  thr_evaluation_destroy(&e->record);
  thr_holding_destroy(&e->holding);
  thr_settle_destroy(&e->settle);
  *e = (thr_eval){0};
}

static thr_status check_options(const thr_eval_options *o, thr_err *err)
{
  static const uint64_t largest_seed = UINT64_C(1) << 53; /* JSON's numbers are doubles */
  if (!(o->time_step >= 0.01 && o->time_step <= 10))
    return thr_fail(err, THR_EINPUT, "time step: a factor of %g; expected 0.01 to 10 times the validated step", o->time_step);
  if (!(o->iterations >= 0.1 && o->iterations <= 100))
    return thr_fail(err, THR_EINPUT, "iterations: a factor of %g; expected 0.1 to 100 times the validated number", o->iterations);
  if (!(o->start >= 0) || !isfinite(o->start))
    return thr_fail(err, THR_EINPUT, "start: a pull of %g N; expected more than 0, or 0 for three times the holding pull",
                    o->start);
  if (o->processes < 1) return thr_fail(err, THR_EINPUT, "processes: %d; expected 1 or more", o->processes);
  if (o->seed > largest_seed)
    return thr_fail(err, THR_EINPUT, "seed: %" PRIu64 "; expected 0 to %" PRIu64, o->seed, largest_seed);
  return THR_OK;
}

static thr_status prepare(const thr_frame *f, const thr_cord *cord, int n_cords, thr_method method, const thr_eval_options *o,
                          thr_evaluation *r, thr_err *err)
{
  *r = (thr_evaluation){.present = true,
                        .method = method,
                        .law = method == THR_CAPSTAN ? o->law : THR_LAW_CAPSTAN,
                        .seed = o->seed,
                        .time_step = o->time_step,
                        .iterations = o->iterations};
  thr_status st = check_options(o, err);
  if (!st) st = thr_physics_resolve(&o->physics, f, &r->physics, err);
  if (st) return st;
  if (!(r->cord = thr_calloc((size_t)n_cords, sizeof *r->cord))) return thr_nomem(err);
  r->n_cords = n_cords;
  for (int i = 0; i < n_cords; i++) {
    r->cord[i].n_passes = cord[i].n_passes;
    r->cord[i].pull = o->cord_pull ? o->cord_pull[i] : o->pull;
  }
  return THR_OK;
}

static thr_status sum_up(thr_eval *e, thr_err *err)
{
  e->complete = true;
  for (int i = 0; i < e->record.n_cords; i++) {
    const thr_eval_cord *c = &e->record.cord[i];
    e->complete &= c->known;
    e->error = fmax(e->error, c->error);
    e->refused += c->refused;
  }
  thr_evaluation_sum(&e->record);
  if (isfinite(e->record.total)) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "all pulls together are past what a number can hold; use a smaller mu, or a plan with more cords");
}

thr_status thr_eval_plan(const thr_frame *f, const thr_cord *cord, int n_cords, thr_method method, const thr_eval_options *o,
                         const thr_limits *limits, thr_eval *out, thr_err *err)
{
  static thr_status (*const run[THR_N_METHODS])(const thr_frame *, const thr_cord *, const thr_eval_options *, const thr_limits *,
                                                thr_eval *, thr_err *) = {
      [THR_CAPSTAN] = thr_capstan_method, [THR_JOINT] = thr_joint_method, [THR_STRUCTURE] = thr_structure_method};
  thr_eval e = {.interpolation = NAN};
  *out = (thr_eval){0};
  thr_status st = prepare(f, cord, n_cords, method, o, &e.record, err);
  if (!st) st = run[method](f, cord, o, limits, &e, err);
  if (!st)
    st = sum_up(&e, err);
  else if (st == THR_ELIMIT)
    (void)sum_up(&e, NULL); /* what is complete stays, whatever it adds up to */
  if (st && st != THR_ELIMIT) thr_eval_destroy(&e);
  *out = e;
  return st;
}
