/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the best cords that a search has found so far (lib/incumbent.c): hands them to the parent
 * process (cli/guard.c) as the text of a plan that claims nothing. */
#include "cli/cli.h"
#include "graph/os.h"
#include "lib/lib.h"

/* Hands a plan to the parent. Signature of thr_incumbent.keep. */
static void keep(void *user, const thr_plan *plan, const thr_text *text)
{
  (void)user;
  guard_keep(text);

  /* For programs and people that watch. */
  if (progress_wanted()) progress_plan(plan);
  cli_status_found(plan->n_cords);
  if (cli_verbose)
    cli_note("plan: length %.10g, turning %.10g rad, %.3f CPU s", plan->metrics.length,
             plan->metrics.turning, thr_os_processor_seconds());
}

static thr_incumbent best;

void best_begin(const thr_frame *frame, const thr_request *options, double hand)
{
  best = thr_incumbent_begin(frame, options, hand);
  best.keep = keep;
}

void best_found(void *user, const thr_cord *cord, int n_cords, const thr_symmetry_record *symmetry)
{
  (void)user;
  thr_incumbent_found(&best, cord, n_cords, symmetry);
}

void best_look(void)
{
  thr_incumbent_look(&best);
}

void best_end(const thr_plan *plan)
{
  thr_incumbent_end(&best, plan);
}
