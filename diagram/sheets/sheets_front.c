/* The title page of step sheets: counts, what the plan is good for, where things are, the picture of the whole. */
#include "diagram/overview/crop.h"
#include "diagram/scene/boxes.h"
#include "diagram/scene/copies.h"
#include "diagram/sheets/sheets_parts.h"
#include "diagram/overview/svg.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

#include <stdio.h>

static const char *plural(int n)
{
  return n == 1 ? "" : "s";
}

static void put_counts(thr_sheets *s)
{
  char line[320], length[64];
  const thr_frame *f = s->f;
  double total = 0;
  int feet = 0;
  for (int c = 0; c < s->plan->n_cords; c++)
    total += thr_cord_length(f, &s->plan->cord[c]);
  for (int v = 0; v < f->n_nodes; v++)
    feet += f->foot[v];
  thr_svg_length(total, f->units, length);
  snprintf(line, sizeof line, "%d beads (edges) between %d nodes, %d %s; %d cord%s, %d passes, %s of cord.", f->n_edges,
           f->n_nodes, feet, feet == 1 ? "foot" : "feet", s->plan->n_cords, plural(s->plan->n_cords), s->n_moves, length);
  thr_sheets_paragraph(s, 0, line);
}

/* What the plan says that is proved: "as little as possible", or how far from it. */
static void put_proof(char *line, size_t size, const char *of_what, bool present, bool optimal, double gap)
{
  if (!present)
    snprintf(line, size, "how little %s would do has not been worked out.", of_what);
  else if (optimal)
    snprintf(line, size, "proved: with these options no plan has less %s.", of_what);
  else
    snprintf(line, size, "at most %.3g %% of its %s could be saved.", 100 * gap, of_what);
}

static void put_goal(thr_sheets *s)
{
  const thr_plan *p = s->plan;
  char line[320], proof[128];
  if (thr_wants_turning(&p->options)) {
    put_proof(proof, sizeof proof, "turning", p->turning.present, p->turning.optimal, p->turning.gap);
    snprintf(line, sizeof line, "Goal: as little turning as possible; %s", proof);
  } else if (thr_wants_symmetry(&p->options)) {
    int paths = thr_copies_paths(s->copy, p->n_cords);
    put_proof(proof, sizeof proof, "cord", p->proof.present, p->proof.optimal, p->proof.gap);
    snprintf(line, sizeof line, "Goal: cords that repeat each other: %d path%s to learn, %d cop%s; %s", paths, plural(paths),
             p->n_cords - paths, p->n_cords - paths == 1 ? "y" : "ies", proof);
  } else {
    put_proof(proof, sizeof proof, "cord", p->proof.present, p->proof.optimal, p->proof.gap);
    snprintf(line, sizeof line, "Goal: as little cord as possible; %s", proof);
  }
  thr_sheets_paragraph(s, 0, line);
}

/* The title page is page 1. */
static void put_contents(thr_sheets *s, const int *first)
{
  char line[160];
  snprintf(line, sizeof line, "%d pages. Prepare first: from page %d. Steps: from page %d. Last: from page %d.", s->n_pages,
           first[THR_SHEET_PREPARE] + 2, first[THR_SHEET_STEPS] + 2, first[THR_SHEET_LAST] + 2);
  thr_sheets_paragraph(s, 0, line);
}

void thr_sheets_front(thr_sheets *s, const int *first)
{
  thr_sheets_page(s, "Step sheets", "");
  if (s->st) return;
  put_counts(s);
  put_goal(s);
  put_contents(s, first);
  if (s->plan->n_cords == 1) thr_sheets_paragraph(s, 0, "The colour changes every twenty passes, here and in the steps.");
  thr_box paper = {THR_SHEET_MARGIN, s->y, s->size[0] - THR_SHEET_MARGIN, thr_sheets_bottom(s)};
  thr_status st = thr_crop_whole(s->plan, &s->guide.layout, NULL, paper, s->limits, thr_sheets_out(s), &s->why);
  if (st) thr_sheets_fail(s, st, NULL);
}
