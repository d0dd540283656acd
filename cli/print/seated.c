/* The gaps that are seated, in words. */
#include "cli/print/seated.h"

#include "graph/plan/evaluation.h"
#include "graph/plan/seating.h"
#include "graph/status.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { MOST_ALONE = 8 }; /* cords, a line each */

/* How many gaps each cord seats while the others are slack, and the pull that takes. */
static thr_status put_alone(thr_text *text, const thr_plan *plan, double *pull)
{
  thr_status st = THR_OK;
  for (int i = 0; i < plan->n_cords && !st; i++) {
    int n = 0, seated = 0;
    if (plan->evaluation.cord[i].pull == THR_PULL_NONE) continue;
    st = thr_seating_pulls(&plan->frame, plan->cord, &plan->evaluation, i, pull, &n, NULL);
    while (seated < n && isfinite(pull[seated]))
      seated++;
    thr_text_printf(text, "  cord %s alone, the others slack: %d of %d gaps, the last at %.4g N\n", plan->cord[i].id, seated, n,
                    seated > 0 ? pull[seated - 1] : 0);
  }
  return st;
}

/* The pulls, in ascending order, up to which parts of the gaps are seated. */
static void put_parts(thr_text *text, const double *pull, int n, double seating)
{
  static const int percent[] = {25, 50, 75, 100};
  int said = 0;
  thr_text_printf(text, "gaps seated (pressed by %g N), with equal pulls at all pulled ends:", seating);
  for (size_t k = 0; k < sizeof percent / sizeof *percent; k++) {
    const int needed = (int)(((long)percent[k] * n + 99) / 100);
    if (isfinite(pull[needed - 1])) thr_text_printf(text, "%s %d %% at %.4g N", said++ ? "," : "", percent[k], pull[needed - 1]);
  }
  if (!isfinite(pull[n - 1])) thr_text_printf(text, "%s only slack cords go through the others", said ? ";" : "");
  thr_text_append(text, "\n");
}

void seated_put(thr_text *text, const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const double seating = evaluation->physics.seating;
  if (!evaluation->seated_known) return;
  if (evaluation->schedule.n > 0) {
    thr_text_printf(text, "gaps seated (pressed by %g N): %.4g %%\n", seating, 100 * evaluation->seated);
    return;
  }
  int n = 0, pulled = 0;
  double *pull = thr_calloc((size_t)plan->frame.n_edges + 1, sizeof *pull);
  for (int i = 0; i < evaluation->n_cords; i++)
    pulled += evaluation->cord[i].pull != THR_PULL_NONE;
  thr_status st = pull ? thr_seating_pulls(&plan->frame, plan->cord, evaluation, -1, pull, &n, NULL) : THR_ENOMEM;
  if (!st && n > 0) put_parts(text, pull, n, seating);
  if (!st && pulled > 1 && pulled <= MOST_ALONE) st = put_alone(text, plan, pull);
  if (st) text->failed = true;
  free(pull);
}
