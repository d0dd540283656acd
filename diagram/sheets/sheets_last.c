/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the page "Last": how to pull the cords tight, how the pieces come up meanwhile if that
 * was simulated, knots, and a check list for when all cords are through.
 *
 * The cord that is hardest to pull comes first, while the pieces still move. Hardness is the larger
 * force of a cord's two ends where the plan was evaluated (thread eval), else the cord's total
 * turning: by the capstan equation the force at the end grows as exp(mu * turning), so that the
 * order by turning is the order by force among cords that are pulled at one end. */
#include "diagram/sheets/sheets_parts.h"
#include "graph/number.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* How hard a cord is to pull, for sorting. */
typedef struct {
  int cord;
  bool known;      /* is the force known from an evaluation? */
  double hardness; /* N if the force is known, else turning in rad */
} cord_pull;

/* Orders cords for qsort: those with a known force first, the hardest first. */
static int by_hardness(const void *a, const void *b)
{
  const cord_pull *one = a, *other = b;
  if (one->known != other->known) return one->known ? -1 : 1;
  if (one->hardness != other->hardness) return one->hardness > other->hardness ? -1 : 1;
  return one->cord - other->cord;
}

/* Returns the total turning of cord c in rad; a closed cord turns from its end into its start,
 * too. */
static double turning_of(const thr_known *known, int c)
{
  return thr_cord_turning(known->f, &known->plan->cord[c],
                          known->plan->options.ends == THR_ENDS_CLOSED);
}

/* Returns what the evaluation says of cord c, or NULL if it says nothing. */
static const thr_eval_cord *evaluation_of(const thr_known *known, int c)
{
  const thr_evaluation *evaluation = known->evaluation;
  return evaluation->present && evaluation->cord[c].known ? &evaluation->cord[c] : NULL;
}

/* Returns whether a hand can pull what holds the pieces. Else hands seat the cords, and something
 * else carries the pieces. */
static bool is_held_by_hand(const thr_known *known)
{
  return known->o.holding > 1 && known->o.holding * known->evaluation->largest <= thr_hand_most;
}

double thr_sheets_pull(const thr_known *known, int c)
{
  const thr_eval_cord *found = &known->evaluation->cord[c];
  return fmax(found->force, found->other_force) * (is_held_by_hand(known) ? known->o.holding : 1);
}

/* Returns how hard cord c is to pull. */
static cord_pull pull_of(const thr_known *known, int c)
{
  const bool is_known = evaluation_of(known, c) != NULL;
  return (cord_pull){c, is_known, is_known ? thr_sheets_pull(known, c) : turning_of(known, c)};
}

int thr_sheets_hardest(const thr_known *known)
{
  cord_pull first = pull_of(known, 0);

  /* The first in the order of by_hardness, without sorting all. */
  for (int c = 1; c < known->plan->n_cords; c++) {
    cord_pull other = pull_of(known, c);
    if (by_hardness(&other, &first) < 0) first = other;
  }

  return first.cord;
}

void thr_sheets_too_hard(const thr_known *known, double newton, thr_text *words)
{
  char force[32];
  thr_svg_force(thr_hand_most, force);

  if (newton > thr_hand_most)
    thr_text_printf(words, ": too hard for a hand, which manages about %s", force);
  else if (known->o.holding > 1 && !is_held_by_hand(known))
    thr_text_append(words, ", while the pieces are supported");
}

/* Writes how many cords ask for a larger force than a hand has, and what helps; nothing if none
 * does. pulls: [n_cords] all cords. */
static void put_too_hard(thr_flow *flow, const thr_known *known, const cord_pull *pulls)
{
  thr_text words = {0};
  char force[32];
  int n = 0;

  /* Only forces compare with a hand; turning does not. */
  for (int i = 0; i < known->plan->n_cords; i++)
    n += pulls[i].known && pulls[i].hardness > thr_hand_most;
  if (!n) return;

  /* "The cord asks ..", "3 of 4 cords ask ..". */
  if (known->plan->n_cords == 1)
    thr_text_append(&words, "The cord");
  else
    thr_text_printf(&words, "%d of %d cords", n, known->plan->n_cords);
  thr_text_append(&words, n == 1 ? " asks for a pull that is" : " ask for a pull that is");

  thr_svg_force(thr_hand_most, force);
  thr_text_printf(&words,
                  " too hard for a hand, which manages about %s. Draw the slack pass by pass, grip "
                  "by grip, from its slackest "
                  "pass, or plan more cords.",
                  force);

  thr_sheets_put_text(flow, THR_BLOCK_WARNING, &words);
}

/* Writes the row of a cord in the table of pulls; column: the columns' places
 * (thr_sheets_cells). */
static void put_cord(thr_flow *flow, const thr_known *known, int c, const double *column)
{
  const thr_cord *cord = &known->plan->cord[c];
  const thr_eval_cord *found = evaluation_of(known, c);
  const char(*label)[THR_LABEL] = thr_sheets_labels(known);
  const char *start = label[thr_cord_start(known->f, cord)],
             *end = label[thr_cord_end(known->f, cord)];
  char words[96], at[96], force[32], other[32], forces[96] = "", lost[32] = "", slackest[96] = "";

  /* Which end the evaluation pulls; both where it says nothing. */
  switch (found ? found->pull : THR_PULL_BOTH) {
  case THR_PULL_START: snprintf(at, sizeof at, "start, at %.40s", start); break;
  case THR_PULL_END: snprintf(at, sizeof at, "end, at %.40s", end); break;
  case THR_PULL_NONE: snprintf(at, sizeof at, "not pulled"); break;
  default: snprintf(at, sizeof at, "both, at %.30s and %.30s", start, end);
  }

  /* Two forces where both ends are pulled. Slack is drawn from the pass with the least tension. */
  if (found) {
    int h = cord->half[found->slackest];
    /* An end that is pulled has the tension of its own first pass. */
    const bool both = found->pull == THR_PULL_BOTH, known_on_way = both && found->tension;
    thr_svg_force(known_on_way ? found->tension[0] : found->force, force);
    thr_svg_force(known_on_way ? found->tension[cord->n_passes - 1] : found->other_force, other);
    snprintf(forces, sizeof forces, "%s%s%s", force, both ? " and " : "", both ? other : "");
    snprintf(lost, sizeof lost, "%.1f %%", 100 * found->loss);
    snprintf(slackest, sizeof slackest, "pass %d, %.20s - %.20s", found->slackest + 1,
             label[thr_tail(known->f, h)], label[thr_head(known->f, h)]);
  } else if (known->evaluation->present) {
    /* A plan may be evaluated while one of its cords could not be. */
    snprintf(forces, sizeof forces, "not known");
  }

  thr_sheets_cord_words(known, c, words);
  thr_sheets_cells(flow, column, false, "%s\t%s\t%s\t%s\t%s\t%.0f", words, at, forces, lost,
                   slackest, thr_degrees(turning_of(known, c)));
}

/* Writes from which pull on the pieces hold together while the cords are drawn in, if the pulls of
 * the table do not do. */
static void put_holding(thr_flow *flow, const thr_known *known)
{
  const double times = known->o.holding;
  char hardest[32], weight[32], heavy[96] = "";
  if (!(times > 1)) return;

  /* What holds is in proportion to the weight. */
  thr_svg_force(times * known->evaluation->largest, hardest);
  thr_svg_force(known->o.weight, weight);
  if (known->o.weight > 0)
    snprintf(heavy, sizeof heavy, ", as the pieces weigh about %s in all if they are solid",
             weight);

  if (isfinite(times) && is_held_by_hand(known))
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "These forces seat the cords, but while they are drawn in the pieces hold only "
                   "from %.3g times that, %s at the hardest end: pull that much.",
                   times, hardest);
  else if (isfinite(times))
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "These forces seat the cords. To hold the pieces while they are drawn in takes "
                   "%s at the hardest end%s: more than hands pull, so support the pieces, and hold "
                   "the feet, until all knots are tied.",
                   hardest, heavy);
  else
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "These forces seat the cords, but no pull holds the pieces while they are drawn "
                   "in: support what gives way until all knots are tied.");
}

/* Writes in which order and how the cords are pulled tight. pulls: [n_cords], receives the
 * cords in this order. */
static void put_pulling(thr_flow *flow, const thr_known *known, cord_pull *pulls)
{
  static const double column[] = {0, 38, -116, -130, 134, -186};
  const thr_evaluation *evaluation = known->evaluation;
  int n = known->plan->n_cords;

  /* Sort the cords by hardness. */
  for (int c = 0; c < n; c++)
    pulls[c] = pull_of(known, c);
  qsort(pulls, (size_t)n, sizeof *pulls, by_hardness);

  thr_sheets_put(flow, THR_BLOCK_TITLE,
                 n > 1 ? "Pull the cords tight, in this order" : "Pull the cord tight");

  /* What the figures rest on: method, friction, tension wanted. */
  if (evaluation->present)
    thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                   "Forces were worked out by method %s for friction mu = %.3g, so that a tension "
                   "of %.3g N reaches the slackest pass. Lost: what friction takes off on the way "
                   "there. Hardest first.",
                   thr_method_name(evaluation->method), evaluation->physics.mu,
                   evaluation->physics.seating);
  else
    thr_sheets_put(
        flow, THR_BLOCK_PARAGRAPH,
        "Forces are not known: nobody has worked them out. Friction grows with the turning "
        "of a cord; the cord that turns most is the first in the list. "
        "Pulling at both ends halves the way that slack has to go.");

  thr_sheets_put(
      flow, THR_BLOCK_PARAGRAPH,
      "How cords that share pieces hinder each other has not been worked out. Turning in degrees.");

  /* The table itself. Columns of forces have headings only if there are forces. */
  flow->y += 1.5;
  thr_sheets_cells(flow, column, true,
                   evaluation->present ? "cord\tpull at its\tforce\tlost\tslackest\tturning"
                                       : "cord\tpull at its\t\t\t\tturning");
  for (int i = 0; i < n; i++)
    put_cord(flow, known, pulls[i].cord, column);

  put_holding(flow, known);
  put_too_hard(flow, known, pulls);
}

/* Draws how the pieces come up as the cords are pulled, on one page, or says that it is not known.
 */
static void put_rise(thr_flow *flow, const thr_known *known)
{
  static const double ROW = 58; /* mm: two pictures beside each other, and their captions */
  const thr_still *rise = known->o.rise;
  const int rows = rise ? (rise->n_panels + 1) / 2 : 0;
  if (!rise) {
    thr_sheets_put(
        flow, THR_BLOCK_PARAGRAPH,
        "Whether the pieces come up by themselves as the cords are pulled has not been "
        "simulated. If they do not, carry their weight from below, with a hand, a cushion "
        "or a ball, until the faces are closed.");
    return;
  }

  thr_sheets_room(flow, ROW * rows + 6 * THR_SHEET_LINE);
  thr_sheets_put(flow, THR_BLOCK_TITLE, "%s", rise->title);
  thr_sheets_put(flow, THR_BLOCK_PARAGRAPH, "%s", rise->note);
  if (flow->why.code) return;
  const thr_box paper = {THR_SHEET_MARGIN, flow->y, flow->size[0] - THR_SHEET_MARGIN,
                         flow->y + ROW * rows};
  thr_sheets_fail(
      flow, thr_still_panels(known->f, rise, paper, &flow->y, thr_sheets_out(flow), &flow->why));
}

/* Writes which knot ends a cord and how much cord it takes, in mm if the cord's size is known: a
 * length that is proportional to the cord's diameter. */
static void put_knots(thr_flow *flow, const thr_known *known)
{
  char taken[64] = ".";

  thr_sheets_put(flow, THR_BLOCK_TITLE, "Knots");
  if (known->supplies.mm > 0)
    snprintf(taken, sizeof taken, "; it takes %.0f mm of the tail.",
             ceil(THR_SUPPLIES_KNOT * known->supplies.cord));
  thr_sheets_put(flow, THR_BLOCK_PARAGRAPH,
                 "An overhand knot at each end, drawn up to its piece%s Cut the tails only when "
                 "all cords are tight.",
                 taken);
}

/* Writes the check list: pieces, ends, cords per arm, slack. */
static void put_checks(thr_flow *flow, const thr_known *known)
{
  int most = 0;

  /* The largest number of cords in one arm or tube bounds what the steps say. */
  for (int e = 0; e < known->f->n_edges; e++)
    most = known->supplies.passes[e] > most ? known->supplies.passes[e] : most;

  thr_sheets_put(flow, THR_BLOCK_TITLE, "Check list");
  thr_sheets_put(flow, THR_BLOCK_TICK, "All %d %s are on a cord, none is left over.",
                 known->pieces.n, thr_pieces_word(known->plan, known->pieces.n));

  /* A closed cord has two ends as well, which meet at one place. */
  thr_sheets_put(flow, THR_BLOCK_TICK, "All %d ends of cord come out where the cut list says.",
                 2 * known->plan->n_cords);
  thr_sheets_put(flow, THR_BLOCK_TICK,
                 "Through every %s go as many cords as the steps lead there (%d at most).",
                 known->pieces.solid ? "arm" : "tube", most);
  thr_sheets_put(flow, THR_BLOCK_TICK,
                 "No cord can be drawn further at its ends; no piece turns or gapes; all knots sit "
                 "on their pieces.");
}

void thr_sheets_last(thr_flow *flow, const thr_known *known)
{
  cord_pull *pulls = thr_calloc((size_t)known->plan->n_cords, sizeof *pulls);

  if (!pulls) {
    thr_nomem(&flow->why);
    return;
  }

  /* In the order of work. */
  thr_sheets_page(flow, "Last", "Last (continued)");
  put_pulling(flow, known, pulls);
  put_rise(flow, known);
  put_knots(flow, known);
  put_checks(flow, known);
  free(pulls);
}
