/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the title page: what is made and how large it is, what is needed, what is done in which
 * order and on which pages, what is proved of the plan, and pictures of the whole.
 *
 * Example: "49 pieces (4 L, 20 T, 25 X) that meet in 84 places, face to face; 4 feet; 1 cord, 86
 * passes, 1771 mm of cord." and "Goal: as little cord as possible; proved: with these options no
 * plan has less cord." */
#include "diagram/sheets/sheets_parts.h"
#include "graph/plan/request.h"

#include <math.h>
#include <stdio.h>

static const double COLUMN = 100; /* mm: width of the lists beside a picture */
static const double PICTURE = 68; /* mm: height of that picture, at most */
static const double INDENT = 4.5; /* mm: from the margin to an item's words */

/* Returns the ending of a plural. */
static const char *plural(int n)
{
  return n == 1 ? "" : "s";
}

/* Appends how large the thing is when it is finished: the box of all nodes, and an arm's width more
 * where that is known. In mm, of large things in m, or in units without a length. */
static void add_size(const thr_known *known, thr_text *words)
{
  const thr_frame *frame = known->f;
  const double mm = known->supplies.mm;
  double size[3], largest = 0;
  for (int k = 0; k < 3; k++) {
    double low = INFINITY, high = -INFINITY;
    for (int v = 0; v < frame->n_nodes; v++) {
      low = fmin(low, frame->xyz[v][k]);
      high = fmax(high, frame->xyz[v][k]);
    }
    size[k] = (high - low) * (mm > 0 ? mm : 1) + known->supplies.width;
    largest = fmax(largest, size[k]);
  }

  const bool large = mm > 0 && largest >= 3000;
  thr_text_append(words, " Finished: about ");
  for (int k = 0; k < 3; k++)
    thr_text_printf(words, "%s%.*f", k ? " x " : "",
                    large           ? 2
                    : largest >= 10 ? 0
                                    : 2,
                    size[k] / (large ? 1000 : 1));
  thr_text_printf(words, " %s (width x depth x height).",
                  large    ? "m"
                  : mm > 0 ? "mm"
                           : frame->units);
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
  add_size(known, &words);

  thr_sheets_put_text(flow, THR_BLOCK_PARAGRAPH, &words);
}

/* Writes what was minimised and what is proved of it: that no plan has less, or how much less is
 * perhaps possible. gap: share of the plan's value. */
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
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "Goal: %s; no plan can have more than %.0f %% less %s.", goal,
                   ceil(100 * gap - 1e-9), of_what);
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
              thr_wants_pull(asked) ? "the hardest pull as easy as possible"
                                    : "as little turning as possible of the cord that turns most",
              thr_wants_pull(asked) ? "turning on the way to it" : "turning of a cord",
              turning->present, turning->largest_optimal,
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

/* Writes an item of a list, behind a number, or behind a dash for 0. */
static void put_item(thr_flow *flow, double width, int number, thr_text *words)
{
  char mark[8] = "-";
  if (number) snprintf(mark, sizeof mark, "%d", number);
  if (words->failed) thr_nomem(&flow->why);
  if (!flow->why.code) {
    thr_svg_text(thr_sheets_out(flow), THR_SHEET_MARGIN, flow->y, THR_SHEET_TEXT,
                 number ? " font-weight=\"bold\"" : "", mark);
    flow->y = thr_sheets_text(flow, THR_SHEET_MARGIN + INDENT, flow->y, THR_SHEET_TEXT,
                              width - INDENT, "", words->data);
  }
  thr_text_destroy(words);
}

/* Writes what has to be at hand. Figures only where sizes in mm are known. */
static void put_needs(thr_flow *flow, const thr_known *known, double width, const int *first)
{
  const thr_supplies *supplies = &known->supplies;
  const bool sized = supplies->mm > 0;
  const int n = known->pieces.n, cords = known->plan->n_cords;
  thr_text words = {0};
  double cut = 0;
  for (int c = 0; c < cords; c++)
    cut += thr_supplies_cut(supplies, c).cut * supplies->mm / 1000;

  thr_sheets_put(flow, THR_BLOCK_TITLE, "You need");
  thr_text_printf(&words, "%d %s in %d kind%s by shape, %s", n, thr_pieces_word(known->plan, n),
                  known->pieces.n_kinds, plural(known->pieces.n_kinds),
                  known->o.too_large    ? "made by hand"
                  : known->pieces.solid ? "printed or made by hand"
                                        : "printed or cut");
  put_item(flow, width, 0, &words);

  thr_text_printf(&words, "%d cord%s", cords, plural(cords));
  if (sized)
    thr_text_printf(&words, ", %.3g mm thick, %.2f m in all with %s ends", supplies->cord, cut,
                    cords > 1 ? "their" : "its");
  put_item(flow, width, 0, &words);

  thr_text_append(&words, "a blunt needle");
  if (sized)
    thr_text_printf(&words,
                    " that with its cord goes through %.2f mm, and a stopper that does not slip "
                    "into %.2f mm",
                    thr_supplies_extreme_bore(supplies, true),
                    thr_supplies_extreme_bore(supplies, false));
  else
    thr_text_append(&words, ", and a stopper that is wider than the bores");
  put_item(flow, width, 0, &words);

  thr_text_printf(&words, "tape, scissors, a pencil%s",
                  first[THR_SHEET_NAMES] < 0 ? ""
                                             : "; glue for the names, unless they are engraved");
  put_item(flow, width, 0, &words);

  if (sized) {
    thr_text_append(&words, known->o.no_mat ? "the overview, a file of its own"
                                            : "the mat, a file of its own, printed true to size");
    put_item(flow, width, 0, &words);
  }
}

/* Appends how the pieces are made and laid out: what is too large for a printer or for pages of
 * paper is not asked for. */
static void put_making(const thr_known *known, thr_text *words)
{
  const char *pieces = thr_pieces_word(known->plan, known->pieces.n);
  if (known->o.too_large)
    thr_text_printf(words,
                    "Have the %s made: some are larger than a printer's usual bed. A model at a "
                    "smaller scale can be printed first",
                    pieces);
  else
    thr_text_printf(words, "Print or make the %s", pieces);
  thr_text_append(words, known->o.no_mat      ? "; no mat of true size can be printed."
                         : known->o.too_large ? ". Print the mat."
                                              : ", and print the mat.");
}

/* Writes the order of work, with the pages that say how. */
static void put_order(thr_flow *flow, const thr_known *known, double width, const int *first)
{
  thr_text words = {0};
  int n = 0;

  /* Page numbers count the title page and begin with 1, hence + 2. */
  thr_sheets_put(flow, THR_BLOCK_TITLE, "In this order");
  thr_text_printf(&words, "Read how it is done: page %d.", first[THR_SHEET_PREPARE] + 2);
  put_item(flow, width, ++n, &words);
  put_making(known, &words);
  put_item(flow, width, ++n, &words);
  if (first[THR_SHEET_NAMES] >= 0) {
    thr_text_printf(&words, "Cut out the names of the pieces, if none is engraved: page %d.",
                    first[THR_SHEET_NAMES] + 2);
    put_item(flow, width, ++n, &words);
  }

  thr_text_printf(&words, "Cut the cord%s: page %d.", plural(known->plan->n_cords),
                  first[THR_SHEET_CUT] + 2);
  put_item(flow, width, ++n, &words);
  thr_text_printf(&words, "Lay the %s %s and thread step by step, %d pass%s: from page %d.",
                  thr_pieces_word(known->plan, known->pieces.n),
                  known->o.no_mat ? "out by the overview" : "on the mat", known->n_passes,
                  known->n_passes == 1 ? "" : "es", first[THR_SHEET_STEPS] + 2);
  put_item(flow, width, ++n, &words);
  thr_text_printf(&words, "Pull tight, knot, check: page %d.", first[THR_SHEET_LAST] + 2);
  put_item(flow, width, ++n, &words);
}

/* Draws the finished thing as it stands, in space, in a box of the page. */
static void put_finished(thr_sheets *sheets, thr_box paper)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  thr_space space = {0};
  thr_space_look look = thr_space_front();
  look.cords = look.plain = true;
  thr_status st = thr_space_make(&space, known->plan, thr_sheets_labels(known), NULL, &flow->why);
  if (!st) st = thr_space_whole(&space, &look, paper, thr_sheets_out(flow), &flow->why);
  thr_sheets_fail(flow, st);
  thr_space_destroy(&space);
}

void thr_sheets_front(thr_sheets *sheets, const int *first)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  const bool named = known->o.name != NULL;
  char heading[80] = "Step sheets";
  if (named) snprintf(heading, sizeof heading, "%s: step sheets", known->o.name);
  thr_sheets_page(flow, heading, "");
  if (flow->why.code) return;

  /* Words first: of the whole width, then beside the picture of a thing that is drawn flat below.
   */
  put_counts(flow, known);
  const double top = flow->y, width = known->in_space ? thr_sheets_width(flow) : COLUMN;
  put_needs(flow, known, width, first);
  put_order(flow, known, width, first);
  if (!known->in_space && !flow->why.code) {
    const double height = fmin(flow->y - top, PICTURE);
    put_finished(sheets, (thr_box){THR_SHEET_MARGIN + COLUMN + 4, top,
                                   flow->size[0] - THR_SHEET_MARGIN, top + height});
  }

  flow->y += 2;
  put_goal(flow, known);

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
