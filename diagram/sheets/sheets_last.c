/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the page "Last": how to pull the cords tight, knots, and a check list for when all cords
 * are through.
 *
 * The cord that is hardest to pull comes first, while the pieces still move. Hardness is the larger
 * force of a cord's two ends where the plan was evaluated (thread eval), else the cord's total
 * turning: by the capstan equation the force at the end grows as exp(mu * turning), so that the
 * order by turning is the order by force among cords that are pulled at one end. */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"
#include "graph/number.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/evaluation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CELLS = 6 };

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
static double turning_of(const thr_sheets *sheets, int c)
{
  return thr_cord_turning(sheets->f, &sheets->plan->cord[c],
                          sheets->plan->options.ends == THR_ENDS_CLOSED);
}

/* Returns what the evaluation says of cord c, or NULL if it says nothing. */
static const thr_eval_cord *known_of(const thr_sheets *sheets, int c)
{
  const thr_evaluation *evaluation = &sheets->plan->evaluation;
  return evaluation->present && evaluation->cord[c].known ? &evaluation->cord[c] : NULL;
}

/* Returns how hard cord c is to pull. */
static cord_pull pull_of(const thr_sheets *sheets, int c)
{
  const thr_eval_cord *known = known_of(sheets, c);
  double force = known ? fmax(known->force, known->other_force) : turning_of(sheets, c);
  return (cord_pull){c, known != NULL, force};
}

int thr_sheets_hardest(const thr_sheets *sheets)
{
  cord_pull first = pull_of(sheets, 0);

  /* The first in the order of by_hardness, without sorting all. */
  for (int c = 1; c < sheets->plan->n_cords; c++) {
    cord_pull other = pull_of(sheets, c);
    if (by_hardness(&other, &first) < 0) first = other;
  }

  return first.cord;
}

void thr_sheets_too_hard(double newton, thr_text *words)
{
  char force[32];
  thr_svg_force(thr_hand_most, force);

  if (newton > thr_hand_most)
    thr_text_printf(words, ": too hard for a hand, which manages about %s", force);
}

/* Writes how many cords ask for a larger force than a hand has, and what helps; nothing if none
 * does. pulls: [n_cords] all cords. */
static void put_too_hard(thr_sheets *sheets, const cord_pull *pulls)
{
  thr_text words = {0};
  char force[32];
  int n = 0;

  /* Only forces compare with a hand; turning does not. */
  for (int i = 0; i < sheets->plan->n_cords; i++)
    n += pulls[i].known && pulls[i].hardness > thr_hand_most;
  if (!n) return;

  /* "The cord asks ..", "3 of 4 cords ask ..". */
  if (sheets->plan->n_cords == 1)
    thr_text_append(&words, "The cord");
  else
    thr_text_printf(&words, "%d of %d cords", n, sheets->plan->n_cords);
  thr_text_append(&words, n == 1 ? " asks for a pull that is" : " ask for a pull that is");

  thr_svg_force(thr_hand_most, force);
  thr_text_printf(&words,
                  " too hard for a hand, which manages about %s. Draw the slack pass by pass, grip "
                  "by grip, from its slackest "
                  "pass, or plan more cords (thread advise).",
                  force);

  /* Bold letters are wider than the measure assumes: the line is 8 % shorter. */
  if (words.failed)
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  else
    sheets->y =
        thr_sheets_text(sheets, THR_SHEET_MARGIN, sheets->y + 1, THR_SHEET_TEXT,
                        0.92 * thr_sheets_width(sheets), " font-weight=\"bold\"", words.data);

  thr_text_destroy(&words);
}

/* Fills the cells "pull at its", "force" and "lost" of a cord that was evaluated. */
static void put_force(const thr_sheets *sheets, const thr_eval_cord *known, int start, int end,
                      char (*cell)[96])
{
  const char *from = sheets->guide.label[start], *to = sheets->guide.label[end];
  char force[32], other[32];

  thr_svg_force(known->force, force);
  thr_svg_force(known->other_force, other);

  /* Which end the evaluation pulls, or both. */
  switch (known->pull) {
  case THR_PULL_START: snprintf(cell[1], 96, "start, at %.40s", from); break;
  case THR_PULL_END: snprintf(cell[1], 96, "end, at %.40s", to); break;
  case THR_PULL_NONE: snprintf(cell[1], 96, "not pulled"); break;
  default: snprintf(cell[1], 96, "both, at %.30s and %.30s", from, to);
  }

  /* Two forces where both ends are pulled. */
  if (known->pull == THR_PULL_BOTH)
    snprintf(cell[2], 96, "%s and %s", force, other);
  else
    snprintf(cell[2], 96, "%s", force);

  snprintf(cell[3], 96, "%.1f %%", 100 * known->loss);
}

/* Writes the row of a cord in the table of pulls; column: the columns' places
 * (thr_sheets_cells). */
static void put_cord(thr_sheets *sheets, const cord_pull *row, const double *column)
{
  char cell[CELLS][96] = {""};
  const thr_cord *cord = &sheets->plan->cord[row->cord];
  const thr_eval_cord *known = known_of(sheets, row->cord);
  int start = thr_cord_start(sheets->f, cord), end = thr_cord_end(sheets->f, cord);

  thr_sheets_cord_words(sheets, row->cord, cell[0]);

  /* Where slack is drawn from: the pass with the least tension. */
  if (known) {
    put_force(sheets, known, start, end, cell);
    int h = cord->half[known->slackest];
    snprintf(cell[4], 96, "pass %d, %.20s - %.20s", known->slackest + 1,
             sheets->guide.label[thr_tail(sheets->f, h)],
             sheets->guide.label[thr_head(sheets->f, h)]);
  } else {
    /* A plan may be evaluated while one of its cords could not be. */
    if (sheets->plan->evaluation.present) snprintf(cell[2], 96, "not known");
    snprintf(cell[1], 96, "both, at %.30s and %.30s", sheets->guide.label[start],
             sheets->guide.label[end]);
  }

  snprintf(cell[5], 96, "%.0f", thr_degrees(turning_of(sheets, row->cord)));

  thr_sheets_cells(sheets, CELLS, column, cell, false);
}

/* Writes in which order and how the cords are pulled tight. pulls: [n_cords], receives the
 * cords in this order. */
static void put_pulling(thr_sheets *sheets, cord_pull *pulls)
{
  static const double column[CELLS] = {0, 38, -116, -130, 134, -186};
  const thr_evaluation *evaluation = &sheets->plan->evaluation;
  char line[320], head[CELLS][96] = {"cord", "pull at its", "", "", "", "turning"};
  int n = sheets->plan->n_cords;

  /* Sort the cords by hardness. */
  for (int c = 0; c < n; c++)
    pulls[c] = pull_of(sheets, c);
  qsort(pulls, (size_t)n, sizeof *pulls, by_hardness);

  thr_sheets_title(sheets, n > 1 ? "Pull the cords tight, in this order" : "Pull the cord tight");

  /* Columns of forces have headings only if there are forces. */
  for (int i = 2; evaluation->present && i < 5; i++)
    snprintf(head[i], 96, "%s", (const char *const[]){"force", "lost", "slackest"}[i - 2]);

  /* What the figures rest on: method, friction, tension wanted. */
  if (evaluation->present)
    snprintf(line, sizeof line,
             "Forces were worked out by method %s for friction mu = %.3g, so that a tension of "
             "%.3g N reaches the slackest pass. "
             "Lost: what friction takes off on the way there. Hardest first.",
             thr_method_name(evaluation->method), evaluation->physics.mu,
             evaluation->physics.seating);
  else
    snprintf(line, sizeof line,
             "Forces are not known: the plan was not evaluated (thread eval). Friction grows with "
             "the turning of a cord; the "
             "cord that "
             "turns most is the first in the list. Pulling at both ends halves the way that slack "
             "has to go.");

  thr_sheets_paragraph(sheets, 0, line);
  thr_sheets_paragraph(
      sheets, 0,
      "How cords that share pieces hinder each other has not been worked out. Turning in degrees.");

  /* The table itself. */
  sheets->y += 1.5;
  thr_sheets_cells(sheets, CELLS, column, head, true);
  for (int i = 0; i < n; i++)
    put_cord(sheets, &pulls[i], column);

  put_too_hard(sheets, pulls);
}

/* Writes which knot ends a cord and how much cord it takes, in mm if the cord's size is known. */
static void put_knots(thr_sheets *sheets)
{
  char line[320];
  thr_sheets_title(sheets, "Knots");

  /* A knot takes a length that is proportional to the cord's diameter. */
  if (sheets->supplies.mm > 0)
    snprintf(line, sizeof line,
             "An overhand knot at each end, drawn up to its piece; it takes %.0f mm of this cord. "
             "Cut the tails only when all "
             "cords are "
             "tight.",
             ceil(THR_SUPPLIES_KNOT * sheets->supplies.cord));
  else
    snprintf(line, sizeof line,
             "An overhand knot at each end, drawn up to its piece. Cut the tails only when all "
             "cords are tight.");

  thr_sheets_paragraph(sheets, 0, line);
}

/* Writes the check list: pieces, ends, cords per arm, slack. */
static void put_checks(thr_sheets *sheets)
{
  char line[320];
  int most = 0;

  /* The largest number of cords in one arm or tube bounds what channels.csv says. */
  for (int e = 0; e < sheets->f->n_edges; e++)
    most = sheets->supplies.passes[e] > most ? sheets->supplies.passes[e] : most;

  thr_sheets_title(sheets, "Check list");
  snprintf(line, sizeof line, "All %d %s are on a cord, none is left over.", sheets->pieces.n,
           thr_pieces_word(sheets->plan, sheets->pieces.n));
  thr_sheets_tick(sheets, line);

  /* A closed cord has two ends as well, which meet at one place. */
  snprintf(line, sizeof line, "All %d ends of cord come out where the cut list says.",
           2 * sheets->plan->n_cords);
  thr_sheets_tick(sheets, line);

  snprintf(line, sizeof line,
           "No %s holds fewer or more cords than channels.csv says (%d at most).",
           sheets->pieces.solid ? "arm" : "tube", most);
  thr_sheets_tick(sheets, line);

  thr_sheets_tick(sheets, "No cord can be drawn further at its ends; no piece turns or gapes; all "
                          "knots sit on their pieces.");
}

void thr_sheets_last(thr_sheets *sheets)
{
  cord_pull *pulls = thr_calloc((size_t)sheets->plan->n_cords, sizeof *pulls);

  if (!pulls) {
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
    return;
  }

  /* In the order of work. */
  thr_sheets_page(sheets, "Last", "Last (continued)");
  put_pulling(sheets, pulls);
  put_knots(sheets);
  put_checks(sheets);
  free(pulls);
}
