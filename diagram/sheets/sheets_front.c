/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the title page: counts of pieces and cords, what is proved of the plan, on which pages
 * the parts of the booklet begin, and the picture of the whole.
 *
 * Example: "49 pieces (4 L, 20 T, 25 X) that meet in 84 places, face to face; 4 feet; 1 cord, 86
 * passes, 1771 mm of cord." and "Goal: as little cord as possible; proved: with these options no
 * plan has less cord." */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"
#include "graph/plan/request.h"

#include <stdio.h>

/* Returns the ending of a plural. */
static const char *plural(int n)
{
  return n == 1 ? "" : "s";
}

/* Writes how many pieces, places, feet, cords and passes there are, and how much cord is on the
 * way. */
static void put_counts(thr_flow *flow, const thr_known *known)
{
  char length[64];
  thr_text words = {0};
  const thr_frame *frame = known->f;
  double total = 0;
  int feet = 0, n = known->pieces.n, cords = known->plan->n_cords;

  /* Cord through the middles of the pieces, without tails, knots and turns. */
  for (int c = 0; c < cords; c++)
    total += thr_cord_length(frame, &known->plan->cord[c]);
  for (int v = 0; v < frame->n_nodes; v++)
    feet += frame->foot[v];

  thr_svg_length(total, frame->units, length);
  thr_text_printf(&words, "%d %s", n, thr_pieces_word(known->plan, n));

  /* Solid pieces meet at the middles of edges, tubes at nodes. */
  if (known->pieces.solid) {
    thr_text_append(&words, " (");
    thr_pieces_shapes(&known->pieces, &words);
    thr_text_printf(&words, ") that meet in %d place%s, face to face", frame->n_edges,
                    plural(frame->n_edges));
  } else
    thr_text_printf(&words, " of %d length%s between %d places", known->pieces.n_kinds,
                    plural(known->pieces.n_kinds), frame->n_nodes);

  thr_text_printf(&words, "; %d %s; %d cord%s, %d pass%s, %s of cord.", feet,
                  feet == 1 ? "foot" : "feet", cords, plural(cords), known->n_passes,
                  known->n_passes == 1 ? "" : "es", length);

  thr_sheets_put_text(flow, THR_BLOCK_PARAGRAPH, &words);
}

/* Writes what was minimised and what is proved of it: that no plan has less, or how much less is
 * not ruled out. gap: share of the plan's value. */
static void put_proof(thr_flow *flow, const char *goal, const char *of_what, bool present,
                      bool optimal, double gap)
{
  if (!present)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "Goal: %s; how little %s would do has not been worked out.", goal, of_what);
  else if (optimal)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "Goal: %s; proved: with these options no plan has less %s.", goal, of_what);
  else
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH, "Goal: %s; at most %.3g %% less %s is not ruled out.",
                   goal, 100 * gap, of_what);
}

/* Writes the goal that was asked for, and what is proved of it: of the turning or the pull of the
 * cord that has most, of all turning, of the longest cord, of the cord that symmetry or nothing
 * else asks for; then the limits that no cord may exceed. */
static void put_goal(thr_flow *flow, const thr_known *known)
{
  const thr_plan *plan = known->plan;
  const thr_request *asked = &plan->options;
  const thr_turning_claim *turning = &plan->turning;
  const thr_cords_claim *cords = &plan->cords_claim;
  const int paths = thr_copies_paths(known->copy, plan->n_cords), copies = plan->n_cords - paths;
  char goal[128];

  if (thr_wants_turning(asked) && thr_wants_largest(asked))
    put_proof(flow,
              thr_wants_pull(asked)
                  ? "as little to overcome as possible at the end that is hardest "
                    "to pull"
                  : "as little turning as possible of the cord that turns most",
              thr_wants_pull(asked) ? "to overcome there" : "turning of a cord", turning->present,
              turning->largest_optimal,
              turning->largest > 0 ? 1 - turning->largest_bound / turning->largest : 0);
  else if (thr_wants_turning(asked))
    put_proof(flow, "as little turning as possible", "turning", turning->present, turning->optimal,
              turning->gap);
  else if (thr_wants_symmetry(asked)) {
    snprintf(goal, sizeof goal, "cords that repeat each other: %d path%s to learn, %d cop%s", paths,
             plural(paths), copies, copies == 1 ? "y" : "ies");
    put_proof(flow, goal, "cord", plan->proof.present, plan->proof.optimal, plan->proof.gap);
  } else if (thr_wants_balance(asked))
    put_proof(flow, "the longest cord as short as possible", "cord in its longest one",
              cords->present, cords->longest_optimal,
              cords->longest > 0 ? 1 - cords->longest_bound / cords->longest : 0);
  else
    put_proof(flow, "as little cord as possible", "cord", plan->proof.present, plan->proof.optimal,
              plan->proof.gap);

  if (asked->max_length > 0)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH, "No cord is longer than %g %s, as was asked.",
                   asked->max_length, known->f->units);
  if (asked->max_pull > 0)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "No end is pulled by more than %g N to seat its cord, as was asked.",
                   asked->max_pull * asked->physics.seating);
}

void thr_sheets_front(thr_sheets *sheets, const int *first)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  thr_sheets_page(flow, "Step sheets", "");
  if (flow->why.code) return;

  /* Words first. Page numbers count the title page and begin with 1, hence + 2. */
  put_counts(flow, known);
  put_goal(flow, known);
  thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                 "%d pages. Prepare first: from page %d. Steps: from page %d. Last: from page %d.",
                 flow->n_pages, first[THR_SHEET_PREPARE] + 2, first[THR_SHEET_STEPS] + 2,
                 first[THR_SHEET_LAST] + 2);

  /* A warning where sizes that were worked out look wrong. */
  char doubt[160];
  if (thr_supplies_doubt(&known->supplies, doubt))
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH, "%s", doubt);

  if (known->plan->n_cords == 1 && !known->in_space)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "In this picture the colour changes every twenty passes.");

  /* The picture takes what is left of the page. */
  thr_sheets_whole(sheets, known->in_space, NULL, NULL, thr_sheets_bottom(flow), NULL);
}
