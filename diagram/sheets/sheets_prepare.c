/* What to prepare: cords to cut, beads to make, feet; and how the sheets are read. */
#include "diagram/sheets/sheets_parts.h"
#include "diagram/overview/svg.h"
#include "diagram/tables/supplies.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- cords ---- */

/* A length to a tenth of a mm, without its unit. */
static void put_length(const thr_sheets *sheets, double length, char cell[96])
{
  if (sheets->supplies.mm > 0)
    snprintf(cell, 96, "%.*f", 1 + (int)nearbyint(log10(sheets->supplies.mm)), length);
  else
    snprintf(cell, 96, "%.5g", length);
}

static void put_cord(thr_sheets *sheets, int c, const double *x)
{
  const thr_cord *cord = &sheets->plan->cord[c];
  char cell[9][96] = {""};
  thr_cut_length cut = thr_supplies_cut(&sheets->supplies, c);
  double fold = cut.tails / 2 + cut.knots / 2;
  for (int k = 0; k < sheets->fold[c]; k++)
    fold += sheets->f->length[cord->half[k] >> 1];
  thr_sheets_cord_words(sheets, c, cell[0]);
  snprintf(cell[1], 96, "%d", cord->n_passes);
  put_length(sheets, cut.length, cell[2]);
  for (int i = 3; i < 7; i++)
    snprintf(cell[i], 96, "-");
  if (sheets->supplies.mm > 0) {
    put_length(sheets, cut.tails, cell[3]);
    put_length(sheets, cut.knots, cell[4]);
    put_length(sheets, cut.turns, cell[5]);
    put_length(sheets, cut.cut, cell[6]);
  }
  if (sheets->fold[c]) put_length(sheets, fold, cell[7]);
  snprintf(cell[8], 96, "%.30s - %.30s", sheets->guide.label[thr_cord_start(sheets->f, cord)],
           sheets->guide.label[thr_cord_end(sheets->f, cord)]);
  thr_sheets_cells(sheets, 9, x, cell, false);
}

static void put_cords(thr_sheets *sheets)
{
  static const double x[9] = {0, -58, -75, -90, -104, -118, -134, -150, 153};
  char head[9][96] = {"cord", "passes", "length", "tails", "knots", "turns", "cut", "", "from - to"}, line[320], cord[32] = "";
  if (sheets->supplies.mm > 0) snprintf(cord, sizeof cord, ", %.3g mm thick", sheets->supplies.cord);
  snprintf(line, sizeof line, "Cut these cords (lengths in %s%s)", sheets->f->units, cord);
  thr_sheets_title(sheets, line);
  if (sheets->o.middle) snprintf(head[7], 96, "fold at");
  thr_sheets_cells(sheets, 9, x, head, true);
  for (int c = 0; c < sheets->plan->n_cords; c++)
    put_cord(sheets, c, x);
  sheets->y += 1;
  if (sheets->supplies.mm > 0)
    snprintf(line, sizeof line,
             "Cut = length through the middles of the beads + a tail of %.0f mm to hold at each end + an overhand knot at each "
             "end + what turns take at most where the cord lies at the outside of its bores.%s",
             THR_SUPPLIES_TAIL,
             sheets->o.middle ? " Fold at: from the end that comes out at the first place of the last column." : "");
  else
    snprintf(line, sizeof line, "The size of cord and beads is not known: add tails, knots and what turns take.");
  thr_sheets_paragraph(sheets, 0, line);
}

/* ---- beads ---- */

enum { CELLS = 5 };

/* How much cord a bore has to take, in diameters of it and, if known, in mm. */
static void put_bore(const thr_sheets *sheets, double cords, char cell[96])
{
  if (sheets->supplies.mm > 0)
    snprintf(cell, 96, "%.2f mm", thr_supplies_bore_mm(&sheets->supplies, cords));
  else
    snprintf(cell, 96, "%.2f cords", cords);
}

/* Rows in two columns, from left to right, then down. */
static void put_groups(thr_sheets *sheets, const thr_bead *g, int n, bool edges, char (*head)[96])
{
  static const double x[2 * CELLS] = {-8, -24, -46, -62, -84, -103, -119, -141, -157, -179};
  char cell[2 * CELLS][96];
  int filled = 0;
  for (int i = 0; i < 2 * CELLS; i++)
    snprintf(cell[i], 96, "%.95s", head[i % CELLS]);
  thr_sheets_cells(sheets, 2 * CELLS, x, cell, true);
  for (int i = 0, next; i < n; i = next) {
    char(*row)[96] = cell + filled;
    for (next = i + 1; next < n && g[next].kind == g[i].kind && g[next].passes == g[i].passes;)
      next++;
    thr_bead_name(g[i].kind, g[i].sort, row[0]);
    snprintf(row[1], 96, "%d", next - i);
    if (edges)
      put_length(sheets, sheets->f->length[g[i].item], row[2]);
    else
      snprintf(row[2], 96, "%d", thr_degree(sheets->f, g[i].item));
    snprintf(row[3], 96, "%d", g[i].passes);
    put_bore(sheets,
             edges ? thr_supplies_bore(&sheets->supplies, g[i].item) : thr_supplies_node_bore(&sheets->supplies, g[i].item),
             row[4]);
    filled = (filled + CELLS) % (2 * CELLS);
    if (!filled || next == n) thr_sheets_cells(sheets, filled ? CELLS : 2 * CELLS, x, cell, false);
  }
}

void thr_sheets_beads(const thr_sheets *sheets, thr_bead *b)
{
  for (int e = 0; e < sheets->f->n_edges; e++)
    b[e] = (thr_bead){.kind = sheets->edge_kind[e], .passes = sheets->supplies.passes[e], .item = e};
  thr_beads_sort(b, sheets->f->n_edges);
}

static void put_beads(thr_sheets *sheets, thr_bead *g)
{
  char edge_head[CELLS][96] = {"kind", "pieces", "length", "cords", "bore"}, line[200];
  thr_sheets_beads(sheets, g);
  snprintf(line, sizeof line, "Beads: %d in %d kind%s by length (in %s), by the cords that each will hold", sheets->f->n_edges,
           sheets->edge_kinds, sheets->edge_kinds == 1 ? "" : "s", sheets->f->units);
  thr_sheets_title(sheets, line);
  put_groups(sheets, g, sheets->f->n_edges, true, edge_head);
}

/* Most passes of an edge at node v. */
static int most_passes(const thr_sheets *sheets, int v)
{
  int most = 0;
  for (int i = sheets->f->first[v]; i < sheets->f->first[v + 1]; i++) {
    int n = sheets->supplies.passes[sheets->f->half[i] >> 1];
    most = n > most ? n : most;
  }
  return most;
}

static void put_joints(thr_sheets *sheets, thr_bead *g)
{
  char node_head[CELLS][96] = {"kind", "pieces", "arms", "cords", "bore"}, line[200];
  for (int v = 0; v < sheets->f->n_nodes; v++)
    g[v] = (thr_bead){.kind = sheets->node_kind[v], .passes = most_passes(sheets, v), .item = v};
  thr_beads_sort(g, sheets->f->n_nodes);
  snprintf(line, sizeof line, "Node beads: %d in %d kind%s by their arms, by the most cords that an arm will hold",
           sheets->f->n_nodes, sheets->node_kinds, sheets->node_kinds == 1 ? "" : "s");
  thr_sheets_title(sheets, line);
  put_groups(sheets, g, sheets->f->n_nodes, false, node_head);
}

static void put_feet(thr_sheets *sheets)
{
  thr_text words = {0};
  int n = 0;
  for (int v = 0; v < sheets->f->n_nodes; v++) {
    if (!sheets->f->foot[v]) continue;
    if (n++) thr_text_append(&words, "  ");
    thr_text_append(&words, sheets->guide.label[v]);
  }
  thr_text_append(&words, n ? "." : "None.");
  if (words.failed)
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  else {
    thr_sheets_title(sheets, "Feet");
    thr_sheets_paragraph(sheets, 0, words.data);
  }
  thr_text_destroy(&words);
}

/* ---- how to read ---- */

static void put_reading(thr_sheets *sheets)
{
  thr_sheets_title(sheets, "How to read the steps");
  thr_sheets_paragraph(
      sheets, 0,
      "Each row is one go of the needle: the passes with their numbers in the picture, how the first of them goes on "
      "from the pass before, every place that the needle comes to, and what it does with the beads between these "
      "places. Pick up: a new bead goes on the cord. Pass through: it holds cord already, and the needle goes the way "
      "it went there last. Pass back through: against that way.");
  thr_sheets_paragraph(sheets, 0,
                       sheets->guide.sides
                           ? "Left and right are meant as seen in the pictures, going with the needle. Straight on: a turn of "
                             "less than 15 degrees. Over the curve: ahead, where the surface bends."
                           : "Turns have no left and right here: in this view beads cross that do not in space. Straight on: "
                             "a turn of less than 15 degrees.");
  thr_sheets_paragraph(
      sheets, 0,
      "In the pictures darker beads hold cord already, grey lines are earlier passes, coloured ones those of the step. "
      "The small picture shows where they are. S: a cord starts. E: it ends.");
  if (sheets->o.middle)
    thr_sheets_paragraph(
        sheets, 0,
        "Cords are threaded from their middle with a needle at each end: first the right needle, to the end of the "
        "cord, then the left needle from the fold back to its start, with falling numbers.");
}

void thr_sheets_prepare(thr_sheets *sheets)
{
  int most = sheets->f->n_edges > sheets->f->n_nodes ? sheets->f->n_edges : sheets->f->n_nodes;
  thr_bead *g = thr_calloc((size_t)most, sizeof *g);
  if (!g) {
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
    return;
  }
  thr_sheets_page(sheets, "Prepare first", "Prepare first (continued)");
  put_reading(sheets);
  put_cords(sheets);
  put_feet(sheets);
  put_beads(sheets, g);
  if (sheets->plan->options.joint == THR_JOINT_SOLID) put_joints(sheets, g);
  sheets->y += 1;
  thr_sheets_paragraph(sheets, 0,
                       "A letter tells beads of a kind apart that are bored for different numbers of cords. The steps say the "
                       "kinds, with these letters, of the beads that they pick up. Which bead is of which kind: beads.csv.");
  free(g);
}
