/* What thread eval says of a plan, whose evaluation is the plan's own: in words, and as JSON. */
#ifndef THR_EVAL_PRINT_H
#define THR_EVAL_PRINT_H

#include "eval/eval.h"
#include "eval/structure/erect.h"
#include "graph/plan/plan.h"
#include "graph/text.h"

/* What was asked for, beside the plan. */
typedef struct {
  const char *pulled; /* which ends, as given */
  double strength;    /* N, of the cord; 0 = not said */
  int knot;           /* at its ends, of thr_knots */
  bool tension;       /* every pass */
  bool loaded;        /* a load hangs on it */
  bool simulated;     /* the structure in simulation was asked for, too */
  bool stopped;       /* before all was known */
} eval_view;

void eval_put_text(thr_text *text, const eval_view *view, const thr_plan *plan, const thr_eval *eval);
/* With which counterweight it comes up: a sentence without a newline. */
void erect_put(thr_text *text, const thr_erect *erect);
void eval_put_json(thr_text *text, const thr_plan *plan, const thr_eval *eval, bool stopped);

#endif
