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
static void put_length(const thr_sheets *s, double length, char cell[96])
{
  if (s->supplies.mm > 0)
    snprintf(cell, 96, "%.*f", 1 + (int)nearbyint(log10(s->supplies.mm)), length);
  else
    snprintf(cell, 96, "%.5g", length);
}

static void put_cord(thr_sheets *s, int c, const double *x)
{
  const thr_cord *cord = &s->plan->cord[c];
  char cell[9][96] = {""};
  thr_cut_length cut = thr_supplies_cut(&s->supplies, c);
  double fold = cut.tails / 2 + cut.knots / 2;
  for (int k = 0; k < s->fold[c]; k++)
    fold += s->f->length[cord->half[k] >> 1];
  thr_sheets_cord_words(s, c, cell[0]);
  snprintf(cell[1], 96, "%d", cord->n_passes);
  put_length(s, cut.length, cell[2]);
  for (int i = 3; i < 7; i++)
    snprintf(cell[i], 96, "-");
  if (s->supplies.mm > 0) {
    put_length(s, cut.tails, cell[3]);
    put_length(s, cut.knots, cell[4]);
    put_length(s, cut.turns, cell[5]);
    put_length(s, cut.cut, cell[6]);
  }
  if (s->fold[c]) put_length(s, fold, cell[7]);
  snprintf(cell[8], 96, "%.30s - %.30s", s->guide.label[thr_cord_start(s->f, cord)], s->guide.label[thr_cord_end(s->f, cord)]);
  thr_sheets_cells(s, 9, x, cell, false);
}

static void put_cords(thr_sheets *s)
{
  static const double x[9] = {0, -58, -75, -90, -104, -118, -134, -150, 153};
  char head[9][96] = {"cord", "passes", "length", "tails", "knots", "turns", "cut", "", "from - to"}, line[320], cord[32] = "";
  if (s->supplies.mm > 0) snprintf(cord, sizeof cord, ", %.3g mm thick", s->supplies.cord);
  snprintf(line, sizeof line, "Cut these cords (lengths in %s%s)", s->f->units, cord);
  thr_sheets_title(s, line);
  if (s->o.middle) snprintf(head[7], 96, "fold at");
  thr_sheets_cells(s, 9, x, head, true);
  for (int c = 0; c < s->plan->n_cords; c++)
    put_cord(s, c, x);
  s->y += 1;
  if (s->supplies.mm > 0)
    snprintf(line, sizeof line,
             "Cut = length through the middles of the beads + a tail of %.0f mm to hold at each end + an overhand knot at each "
             "end + what turns take at most where the cord lies at the outside of its bores.%s",
             THR_SUPPLIES_TAIL,
             s->o.middle ? " Fold at: from the end that comes out at the first place of the last column." : "");
  else
    snprintf(line, sizeof line, "The size of cord and beads is not known: add tails, knots and what turns take.");
  thr_sheets_paragraph(s, 0, line);
}

/* ---- beads ---- */

enum { CELLS = 5 };

/* How much cord a bore has to take, in diameters of it and, if known, in mm. */
static void put_bore(const thr_sheets *s, double cords, char cell[96])
{
  if (s->supplies.mm > 0)
    snprintf(cell, 96, "%.2f mm", thr_supplies_bore_mm(&s->supplies, cords));
  else
    snprintf(cell, 96, "%.2f cords", cords);
}

/* Rows in two columns, from left to right, then down. */
static void put_groups(thr_sheets *s, const thr_bead *g, int n, bool edges, char (*head)[96])
{
  static const double x[2 * CELLS] = {-8, -24, -46, -62, -84, -103, -119, -141, -157, -179};
  char cell[2 * CELLS][96];
  int filled = 0;
  for (int i = 0; i < 2 * CELLS; i++)
    snprintf(cell[i], 96, "%.95s", head[i % CELLS]);
  thr_sheets_cells(s, 2 * CELLS, x, cell, true);
  for (int i = 0, next; i < n; i = next) {
    char(*row)[96] = cell + filled;
    for (next = i + 1; next < n && g[next].kind == g[i].kind && g[next].passes == g[i].passes;)
      next++;
    thr_bead_name(g[i].kind, g[i].sort, row[0]);
    snprintf(row[1], 96, "%d", next - i);
    if (edges)
      put_length(s, s->f->length[g[i].item], row[2]);
    else
      snprintf(row[2], 96, "%d", thr_degree(s->f, g[i].item));
    snprintf(row[3], 96, "%d", g[i].passes);
    put_bore(s, edges ? thr_supplies_bore(&s->supplies, g[i].item) : thr_supplies_node_bore(&s->supplies, g[i].item), row[4]);
    filled = (filled + CELLS) % (2 * CELLS);
    if (!filled || next == n) thr_sheets_cells(s, filled ? CELLS : 2 * CELLS, x, cell, false);
  }
}

void thr_sheets_beads(const thr_sheets *s, thr_bead *b)
{
  for (int e = 0; e < s->f->n_edges; e++)
    b[e] = (thr_bead){.kind = s->edge_kind[e], .passes = s->supplies.passes[e], .item = e};
  thr_beads_sort(b, s->f->n_edges);
}

static void put_beads(thr_sheets *s, thr_bead *g)
{
  char edge_head[CELLS][96] = {"kind", "pieces", "length", "cords", "bore"}, line[200];
  thr_sheets_beads(s, g);
  snprintf(line, sizeof line, "Beads: %d in %d kind%s by length (in %s), by the cords that each will hold", s->f->n_edges,
           s->edge_kinds, s->edge_kinds == 1 ? "" : "s", s->f->units);
  thr_sheets_title(s, line);
  put_groups(s, g, s->f->n_edges, true, edge_head);
}

/* Most passes of an edge at node v. */
static int most_passes(const thr_sheets *s, int v)
{
  int most = 0;
  for (int i = s->f->first[v]; i < s->f->first[v + 1]; i++) {
    int n = s->supplies.passes[s->f->half[i] >> 1];
    most = n > most ? n : most;
  }
  return most;
}

static void put_joints(thr_sheets *s, thr_bead *g)
{
  char node_head[CELLS][96] = {"kind", "pieces", "arms", "cords", "bore"}, line[200];
  for (int v = 0; v < s->f->n_nodes; v++)
    g[v] = (thr_bead){.kind = s->node_kind[v], .passes = most_passes(s, v), .item = v};
  thr_beads_sort(g, s->f->n_nodes);
  snprintf(line, sizeof line, "Node beads: %d in %d kind%s by their arms, by the most cords that an arm will hold", s->f->n_nodes,
           s->node_kinds, s->node_kinds == 1 ? "" : "s");
  thr_sheets_title(s, line);
  put_groups(s, g, s->f->n_nodes, false, node_head);
}

static void put_feet(thr_sheets *s)
{
  thr_text words = {0};
  int n = 0;
  for (int v = 0; v < s->f->n_nodes; v++) {
    if (!s->f->foot[v]) continue;
    if (n++) thr_text_append(&words, "  ");
    thr_text_append(&words, s->guide.label[v]);
  }
  thr_text_append(&words, n ? "." : "None.");
  if (words.failed)
    thr_sheets_fail(s, thr_nomem(&s->why), NULL);
  else {
    thr_sheets_title(s, "Feet");
    thr_sheets_paragraph(s, 0, words.data);
  }
  thr_text_destroy(&words);
}

/* ---- how to read ---- */

static void put_reading(thr_sheets *s)
{
  thr_sheets_title(s, "How to read the steps");
  thr_sheets_paragraph(
      s, 0,
      "Each row is one go of the needle: the passes with their numbers in the picture, how the first of them goes on "
      "from the pass before, every place that the needle comes to, and what it does with the beads between these "
      "places. Pick up: a new bead goes on the cord. Pass through: it holds cord already, and the needle goes the way "
      "it went there last. Pass back through: against that way.");
  thr_sheets_paragraph(s, 0,
                       s->guide.sides
                           ? "Left and right are meant as seen in the pictures, going with the needle. Straight on: a turn of "
                             "less than 15 degrees. Over the curve: ahead, where the surface bends."
                           : "Turns have no left and right here: in this view beads cross that do not in space. Straight on: "
                             "a turn of less than 15 degrees.");
  thr_sheets_paragraph(
      s, 0,
      "In the pictures darker beads hold cord already, grey lines are earlier passes, coloured ones those of the step. "
      "The small picture shows where they are. S: a cord starts. E: it ends.");
  if (s->o.middle)
    thr_sheets_paragraph(
        s, 0,
        "Cords are threaded from their middle with a needle at each end: first the right needle, to the end of the "
        "cord, then the left needle from the fold back to its start, with falling numbers.");
}

void thr_sheets_prepare(thr_sheets *s)
{
  int most = s->f->n_edges > s->f->n_nodes ? s->f->n_edges : s->f->n_nodes;
  thr_bead *g = thr_calloc((size_t)most, sizeof *g);
  if (!g) {
    thr_sheets_fail(s, thr_nomem(&s->why), NULL);
    return;
  }
  thr_sheets_page(s, "Prepare first", "Prepare first (continued)");
  put_reading(s);
  put_cords(s);
  put_feet(s);
  put_beads(s, g);
  if (s->plan->options.joint == THR_JOINT_SOLID) put_joints(s, g);
  s->y += 1;
  thr_sheets_paragraph(s, 0,
                       "A letter tells beads of a kind apart that are bored for different numbers of cords. The steps say the "
                       "kinds, with these letters, of the beads that they pick up. Which bead is of which kind: beads.csv.");
  free(g);
}
