/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the page "Before you begin": how pieces, needle and cord are handled, in 2 x 4 panels.
 *
 * Each panel has a title, a small picture drawn from lines, and a text of a few lines at its foot:
 * what is needed, laying a piece, starting, drawing the slack, undoing, joining a new length,
 * tightening, knots. Lengths, names of places and forces come from the plan, so that every sentence
 * is true of the framework at hand.
 *
 * Example: "8 Knots .. an overhand knot at each end (it takes 17 mm of the tail)", as a tight
 * overhand knot takes THR_SUPPLIES_KNOT = 16.4 diameters of a cord, here one of 1 mm. */
#include "diagram/sheets/sheets_parts.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
  COLUMNS = 2, /* of panels on the page */
  ROWS = 4,    /* of panels on the page */
  LINES = 5,   /* of text that a panel reserves at its foot */
  NAMED = 4    /* feet that the panel on joining names, at most */
};
static const double AIR = 3;                           /* mm between two panels */
static const double INDENT = 3;                        /* mm from the edge of a panel to its text */
static const double ARM = 5, CORD = 1.4, CASING = 2.4; /* mm: widths of the lines */
static const char *const OLD = "#d55e00";              /* colour of a cord */
static const char *const NEW = "#0072b2"; /* colour of a second cord that is tied to it */

/* A panel that is being filled. Drawing functions take offsets in mm from the middle of the panel's
 * picture, y downwards; those of lines, pieces and segments take points of the page. */
typedef struct {
  const thr_known *known;
  thr_text *out; /* SVG of the page */
  double x, y;   /* mm on the page: the middle of its picture */
} instruction_panel;

/* ---- what pictures are made of ---- */

/* Writes words centred at (x, y), where y is the base line. */
static void put_label(const instruction_panel *panel, double x, double y, const char *words)
{
  thr_svg_text(panel->out, panel->x + x, panel->y + y, THR_SHEET_SMALL, " text-anchor=\"middle\"",
               words);
}

/* Draws a straight line of a width in mm from (x0, y0) to (x1, y1). */
static void put_line(const instruction_panel *panel, double x0, double y0, double x1, double y1,
                     double width, const char *colour)
{
  thr_text_printf(
      panel->out,
      "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n",
      colour, width, x0, y0, x1, y1);
}

/* Draws a straight arrow from (x0, y0) to its tip at (x1, y1). The points must differ. */
static void put_arrow(const instruction_panel *panel, double x0, double y0, double x1, double y1)
{
  x0 += panel->x, x1 += panel->x;
  y0 += panel->y, y1 += panel->y;

  /* (dx, dy) is the length of the head along the shaft; 0.45 of it, turned by a right angle, is
   * half the head's width. */
  double length = hypot(x1 - x0, y1 - y0), dx = 2.2 * (x1 - x0) / length,
         dy = 2.2 * (y1 - y0) / length;

  put_line(panel, x0, y0, x1 - dx, y1 - dy, 0.5, "#222");
  thr_text_printf(panel->out, "<path fill=\"#222\" d=\"M%.2f %.2fL%.2f %.2fL%.2f %.2fz\"/>\n", x1,
                  y1, x1 - dx - 0.45 * dy, y1 - dy + 0.45 * dx, x1 - dx + 0.45 * dy,
                  y1 - dy - 0.45 * dx);
}

/* Draws a straight cord with a white casing, which separates it from what lies below. */
static void put_cord(const instruction_panel *panel, double x0, double y0, double x1, double y1)
{
  x0 += panel->x, x1 += panel->x;
  y0 += panel->y, y1 += panel->y;
  put_line(panel, x0, y0, x1, y1, CASING, "#fff");
  put_line(panel, x0, y0, x1, y1, CORD, OLD);
}

/* Draws a stopper, an upright bar, centred at (x, y). */
static void put_stopper(const instruction_panel *panel, double x, double y)
{
  thr_text_printf(
      panel->out,
      "<rect x=\"%.2f\" y=\"%.2f\" width=\"2.4\" height=\"6\" rx=\"0.6\" fill=\"#222\"/>\n",
      panel->x + x - 1.2, panel->y + y - 3);
}

/* Draws a needle as a slender outline from its eye at (x, y) to its tip at (x + length, y). */
static void put_needle(const instruction_panel *panel, double x, double y, double length)
{
  x += panel->x;
  y += panel->y;
  thr_text_printf(panel->out,
                  "<path fill=\"#ddd\" stroke=\"#222\" stroke-width=\"0.3\" d=\"M%.2f %.2fL%.2f "
                  "%.2fL%.2f %.2fL%.2f %.2fz\"/>\n",
                  x, y - 0.7, x + 0.8 * length, y - 0.5, x + length, y, x + 0.8 * length, y + 0.7);
}

/* Draws a piece with its hub at (x, y) and n arms, all of one length in mm, at angles in rad
 * (counter-clockwise from the right). Wide dark lines first and narrower coloured ones above them
 * leave an outline around the union of the arms. */
static void put_piece(const instruction_panel *panel, double x, double y, int n,
                      const double *angle, double length, thr_piece_state state)
{
  double edge = state == THR_PIECE_NEW ? 1.2 : 0.8;
  const char *outline = state == THR_PIECE_LATER ? "#999" : "#222";
  const char *inside = state == THR_PIECE_NEW    ? "#ffe08a"
                       : state == THR_PIECE_HELD ? "#d3ccbf"
                                                 : "#fff";
  for (int above = 0; above < 2; above++) {
    double grow = above ? 0 : edge, tip = length + grow / 2;
    const char *colour = above ? inside : outline;

    /* The page's y axis points down, hence the minus sign before the sine. */
    for (int i = 0; i < n; i++)
      put_line(panel, x, y, x + tip * cos(angle[i]), y - tip * sin(angle[i]), ARM + grow, colour);

    /* Lines end square: a disc at the hub fills the notches between three and more arms. */
    if (n > 2)
      thr_text_printf(panel->out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"%s\"/>\n", x,
                      y, (ARM + grow) / 2, colour);
  }
}

/* Draws a row of pieces of the plan's kind from (x, y) to the right, gap mm apart: crosses of four
 * arms with solid joints, else tubes. looks: a letter for each, n(ew), h(eld) or l(ater). */
static void put_row(const instruction_panel *panel, double x, double y, const char *looks,
                    double gap)
{
  static const double cross[4] = {0, THR_PI / 2, THR_PI, -THR_PI / 2}, tube[2] = {0, THR_PI};
  bool solid = panel->known->pieces.solid;

  for (x += panel->x; *looks; looks++, x += 13 + gap)
    put_piece(panel, x + 6, panel->y + y, solid ? 4 : 2, solid ? cross : tube, 6,
              *looks == 'n'   ? THR_PIECE_NEW
              : *looks == 'h' ? THR_PIECE_HELD
                              : THR_PIECE_LATER);
}

/* ---- cords that cross ---- */

/* Most short segments in one picture. */
enum { MOST_SEGMENTS = 400 };

/* Short straight pieces of cords, painted from the lowest to the highest. */
typedef struct {
  double from[2], to[2], height;
  const char *colour;
} segment;

typedef struct {
  int n;
  double last[3]; /* the point that the list was led to, and its height */
  segment segment[MOST_SEGMENTS];
} segment_list;

/* Orders segments by height, the lowest first, for qsort. */
static int by_height(const void *a, const void *b)
{
  const segment *one = a, *other = b;
  return one->height < other->height ? -1 : one->height > other->height;
}

/* Leads the list to a point with a height z, by a segment from the last point or, if colour is
 * NULL, without one; a full list drops it. */
static void lead_to(segment_list *segments, double x, double y, double z, const char *colour)
{
  const double *last = segments->last;
  if (colour && segments->n < MOST_SEGMENTS)
    segments->segment[segments->n++] =
        (segment){{last[0], last[1]}, {x, y}, (last[2] + z) / 2, colour};
  segments->last[0] = x;
  segments->last[1] = y;
  segments->last[2] = z;
}

/* Paints all segments from the lowest to the highest, each over a casing in white. A segment that
 * passes above another one cuts through its line, so that the picture shows which cord lies above
 * (the painter's algorithm). */
static void put_strands(const instruction_panel *panel, segment_list *segments)
{
  /* Height is that of the middle of each segment. */
  qsort(segments->segment, (size_t)segments->n, sizeof *segments->segment, by_height);

  /* Each segment has a casing with square ends and a core with round ones, which closes the
   * joints. */
  for (int i = 0; i < segments->n; i++)
    for (int above = 0; above < 2; above++)
      thr_text_printf(panel->out,
                      "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" "
                      "stroke-linecap=\"%s\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n",
                      above ? segments->segment[i].colour : "#fff", above ? CORD : CASING,
                      above ? "round" : "butt", segments->segment[i].from[0],
                      segments->segment[i].from[1], segments->segment[i].to[0],
                      segments->segment[i].to[1]);
}

/* Appends an overhand knot in the middle at (x, y): the trefoil (sin t + 2 sin 2t, cos t - 2 cos
 * 2t, -sin 3t), scaled by size in mm and opened at the lobe that points down. The two ends go on to
 * the left and to the right along a line below. */
static void add_overhand(segment_list *segments, double x, double y, double size)
{
  enum { N = 120 };

  /* The closed curve would run over 2 pi; 0.35 rad are left out on both sides of the lobe. */
  for (int i = 0; i <= N; i++) {
    double angle = THR_PI + 0.35 + (2 * THR_PI - 0.7) * i / N;
    lead_to(segments, x + size * (sin(angle) + 2 * sin(2 * angle)),
            y - size * (cos(angle) - 2 * cos(2 * angle)), -sin(3 * angle), i ? OLD : NULL);
  }

  /* Both ends: from the tip of the curve down to the line, then outwards along this line. */
  double low = y + 3.3 * size;
  for (int sign = -1; sign <= 1; sign += 2) { /* the curve ends on the left */
    lead_to(segments, x + sign * size * 0.945, y + size * 2.47, 0, NULL);
    lead_to(segments, x + sign * size * 1.8, low, 0, OLD);
    lead_to(segments, x + sign * size * 8, low, 0, OLD);
  }
}

/* Appends a helix of two turns about the line at height y, which begins at x and advances to the
 * right (dir = 1) or to the left (-1), and a short end that sticks out. Drawn together with the
 * cord along the line, this is one cord tied round the other. */
static void add_coil(segment_list *segments, double x, double y, double dir, const char *colour)
{
  enum { N = 60 };

  /* Height sin t: above the line's cord half of the time, below it the other half. */
  for (int i = 0; i <= N; i++) {
    double angle = 4 * THR_PI * i / N;
    lead_to(segments, x + dir * 0.45 * angle, y - 2.4 * cos(angle), sin(angle), i ? colour : NULL);
  }

  /* The free end leaves the last turn upwards. */
  lead_to(segments, segments->last[0] + dir * 3, segments->last[1] - 2.5, 1, colour);
}

/* Appends a straight cord at height 0, cut into short segments so that each is painted at the right
 * moment between the turns of a helix. */
static void add_straight(segment_list *segments, double x0, double x1, double y, const char *colour)
{
  enum { N = 40 };
  for (int i = 0; i <= N; i++)
    lead_to(segments, x0 + (x1 - x0) * i / N, y, 0, i ? colour : NULL);
}

/* ---- the panels: each a picture and words ---- */

typedef struct {
  const char *title;
  void (*put)(instruction_panel *panel,
              thr_text *words); /* draws the picture and appends the text to words */
} panel_subject;

/* Fills the panel "What you need": cord, needle and stopper, with the lengths to cut and the bores
 * that needle and stopper have to fit. */
static void put_need(instruction_panel *panel, thr_text *words)
{
  const thr_known *known = panel->known;
  int n = known->plan->n_cords;
  double least = INFINITY, most = 0;
  char from[64], to[64];

  /* Shortest and longest cord to cut; where sizes in mm are unknown, without tails and knots. */
  for (int c = 0; c < n; c++) {
    const thr_cut_length length = thr_supplies_cut(&known->supplies, c);
    const double cut = known->supplies.mm > 0 ? length.cut : length.length;
    least = fmin(least, cut);
    most = fmax(most, cut);
  }

  thr_svg_length(least, known->f->units, from);
  thr_svg_length(most, known->f->units, to);

  /* The picture: cord, stopper and needle side by side. */
  put_cord(panel, -36, -3, -8, -3);
  put_label(panel, -22, 2, "cord");
  put_needle(panel, 12, -3, 22);
  put_label(panel, 23, 2, "needle, blunt");
  put_stopper(panel, 2, -3);
  put_label(panel, 2, 5, "stopper");

  /* The text. */
  thr_text_printf(words, "%d %s; %d cord%s of %s", known->pieces.n,
                  thr_pieces_word(known->plan, known->pieces.n), n, n == 1 ? "" : "s", from);
  if (most > least * (1 + 1e-9)) thr_text_printf(words, " to %s", to);
  thr_text_append(words, " (cut list); a needle");

  /* The needle must pass the narrowest bore, the stopper none. */
  if (known->supplies.mm > 0)
    thr_text_printf(
        words,
        " that with its cord goes through %.2f mm; a stopper that does not slip into %.2f mm",
        thr_supplies_extreme_bore(&known->supplies, true),
        thr_supplies_extreme_bore(&known->supplies, false));
  else
    thr_text_append(words, " thinner than the bores; a stopper wider than they are");

  thr_text_append(words, known->o.no_mat ? "; tape, scissors."
                                         : "; tape, scissors, and the mat to lay the pieces on, a "
                                           "file of its own.");
}

/* Returns the visit that explains best how a piece lies: the first one that picks up a piece,
 * comes in and goes out, and whose piece has the most arms, but no more than four; -1 if there
 * is none. */
static int example(const thr_known *known)
{
  int best = -1, arms = 0;
  for (int i = 0; i < known->n_visits; i++) {
    const thr_visit *visit = &known->visit[i];

    /* Four arms at most: more would not leave room for the names around them. */
    int n = thr_pieces_arms(&known->pieces, visit->piece);
    if (visit->nth > 1 || visit->in < 0 || visit->out < 0 || n > 4 || n <= arms) continue;
    arms = n;
    best = i;
  }

  return best;
}

/* Fills the panel "Laying a piece": which side up, and what "in by the arm that faces" means, shown
 * on a piece of this plan; for tubes a row of three with the cord through two. */
static void put_lay(instruction_panel *panel, thr_text *words)
{
  const thr_known *known = panel->known;
  int shown = known->pieces.solid ? example(known) : -1;

  /* A piece of this plan if one is simple enough, else three tubes. */
  if (shown >= 0) {
    const double hub[2] = {panel->x, panel->y};
    const int piece = known->visit[shown].piece;
    thr_step_put_example(known, shown, hub, 11, OLD, panel->out);
    thr_svg_text(panel->out, panel->x - 36, panel->y - 10, 3.4, " font-weight=\"bold\"",
                 known->guide.label[piece]);
  } else {
    put_row(panel, -20, 0, "hnl", 1.5);
    put_cord(panel, -28, 0, 5, 0);
  }

  const char *mat = known->o.no_mat ? "overview" : "mat";

  /* The text names the same piece, for the maker to find it in the overview. */
  if (shown >= 0) {
    thr_text_printf(words, "Lay each piece as the %s shows it: its name upright%s. ", mat,
                    known->in_space ? "" : " and on top (outside on a dome, inside in a bowl)");
    const thr_visit *visit = &known->visit[shown];
    thr_text_printf(words, "Here %s: in by the arm that faces %s, out by the one that faces %s.",
                    known->guide.label[visit->piece],
                    known->guide.label[thr_tail(known->f, visit->in)],
                    known->guide.label[thr_head(known->f, visit->out)]);
  } else
    thr_text_printf(words,
                    "Lay each piece where the %s has it, its name upright. Rows say by which of "
                    "its two ends the needle goes in.",
                    mat);
}

/* Fills the panel "How to start": stopper, tail and needle on the first piece of the first part. */
static void put_start(instruction_panel *panel, thr_text *words)
{
  const thr_known *known = panel->known;
  const thr_part *part = &known->part[0];
  char tail[32];

  /* The picture: a piece on the cord between stopper and needle. */
  put_row(panel, -2, 0, "n", 0);
  put_cord(panel, -34, 0, 18, 0);
  put_stopper(panel, -5, 0);
  put_needle(panel, 18, 0, 18);
  put_label(panel, -5, -5, "stopper");
  snprintf(tail, sizeof tail, "tail %.0f mm", thr_supplies_tail(&known->supplies));
  put_label(panel, -24, 5, known->fold[part->cord] ? "other half" : tail);
  put_label(panel, 27, 5, "needle");

  /* The text. A cord that is threaded from its fold has no tail yet: its other half waits there. */
  thr_text_append(words, "Thread the needle, fold the end of the cord back and tape it flat. ");

  /* Where the cord starts, or what to do with the fold. */
  if (known->fold[part->cord])
    thr_text_append(words, "A cord that is threaded from its middle has the stopper at its fold "
                           "(cut list), until the left needle's turn.");
  else {
    thr_text_printf(
        words,
        "Put the stopper %.0f mm from the other end%s: that tail is to hold and for the knot. Cord "
        "%s starts at ",
        thr_supplies_tail(&known->supplies), known->supplies.mm > 0 ? "" : " and a knot's length",
        known->plan->cord[part->cord].id);
    thr_guide_place(&known->guide, thr_cord_start(known->f, &known->plan->cord[part->cord]), words);
    thr_text_append(words, "; the first piece goes up to the stopper.");
  }
}

/* Fills the panel "Drawing the slack": hold the pieces that sit, draw, and the gap closes. */
static void put_slack(instruction_panel *panel, thr_text *words)
{
  /* The picture: two pairs of pieces with a gap between them. */
  put_row(panel, -29, 0, "hh", 0.5);
  put_row(panel, 2, 0, "nn", 0.5);
  put_cord(panel, -33, 0, 36, 0);
  put_stopper(panel, -33, 0);

  /* The needle's end is drawn, the pieces on the left are held. */
  put_arrow(panel, 30, -4, 38, -4);
  put_label(panel, 34, -6.5, "draw");
  put_label(panel, -23, -9, "hold");
  put_label(panel, 0, 10, "this gap closes");
  put_arrow(panel, -1, 7, -1, 2);

  thr_text_append(words, "Draw the slack every few rows, and at every check: hold the last piece "
                         "that sits, draw the cord until ");
  thr_text_append(words, panel->known->pieces.solid ? "the faces touch" : "the tubes meet");
  thr_text_append(
      words,
      ", go on to the next one, from the stopper to the needle. Never a long way in one pull.");
}

/* Fills the panel "When a row went wrong": the cord is drawn back to the last check that held. */
static void put_wrong(instruction_panel *panel, thr_text *words)
{
  /* The picture: two pieces up to the check, two more from which the cord was drawn. */
  put_row(panel, -29, 0, "hhll", 0.5);
  put_cord(panel, -33, 0, -1.5, 0);
  put_line(panel, panel->x - 2, panel->y - 8, panel->x - 2, panel->y + 8, 0.8, "#009e73");
  put_label(panel, -2, -9.5, "last check");

  /* The cord goes back the way it came. */
  put_arrow(panel, 28, -8, 12, -8);
  put_label(panel, 20, -10, "back, one by one");

  thr_text_append(words,
                  "A row went wrong: take the needle off the cord. Draw the bare cord back by "
                  "hand, piece by piece, as "
                  "far as the last check that held. "
                  "Lay the pieces back in their places, untick the rows, begin again from there.");
}

/* Fills the panel "Joining a new length": a fisherman's knot, each end wound round the other cord.
 * A knot between two faces keeps them apart, and one in a tube stops the cord, so the text names
 * the feet. */
static void put_join(instruction_panel *panel, thr_text *words)
{
  const thr_frame *frame = panel->known->f;
  const double x = panel->x, y = panel->y;
  segment_list segments = {0};
  int feet = 0;

  /* Old cord from the left, new length from the right; they overlap in the middle, where each is
   * wound round the other. */
  add_straight(&segments, x - 36, x + 6, y + 1, OLD);
  add_straight(&segments, x - 6, x + 36, y - 1, NEW);
  add_coil(&segments, x + 6, y, 1, OLD);
  add_coil(&segments, x - 6, y, -1, NEW);
  put_strands(panel, &segments);

  /* Which cord is which, and how both knots are drawn together. */
  put_label(panel, -29, 6, "old cord");
  put_label(panel, 29, 6, "new length");
  put_arrow(panel, -12, 7, -4, 7);
  put_arrow(panel, 12, 7, 4, 7);

  thr_text_append(
      words,
      "To join a new length, tie each end round the other cord and draw both knots together. ");
  thr_text_append(words, panel->known->pieces.solid
                             ? "Join only at a foot or where a hub is open"
                             : "Join only at a foot or where tubes leave room");

  /* The first few feet by name, or that there is none. */
  for (int v = 0; v < frame->n_nodes; v++)
    if (frame->foot[v] && feet++ < NAMED)
      thr_text_printf(words, "%s%s", feet > 1 ? ", " : " (feet: ", panel->known->guide.label[v]);

  thr_text_append(words, feet > NAMED ? ", ..)" : feet ? ")" : "; this frame has no foot");
  thr_text_append(words, panel->known->pieces.solid ? ": a knot between two faces keeps them apart."
                                                    : ": a knot in a tube stops the cord.");
}

/* Draws an arrow outwards at one end of the row (side = -1: left, 1: right) and names the place. */
static void put_pull(const instruction_panel *panel, double side, const char *place)
{
  char words[THR_LABEL + 16];

  put_arrow(panel, side * 30, -4.5, side * 38, -4.5);
  snprintf(words, sizeof words, "at %.12s", place);
  put_label(panel, side * 33, 5, words);
}

/* Appends how cord c is tightened by the plan's schedule: the largest pull and the first few grips
 * by their places; steps.txt lists all of them. */
static void put_schedule(const thr_known *known, int c, thr_text *words)
{
  enum { FEW = 4 };
  const thr_schedule *schedule = &known->evaluation->schedule;
  const thr_cord *cord = &known->plan->cord[c];
  const int grips = thr_schedule_grips(schedule, c);
  char force[32];
  int n = 0;

  /* The hardest pull comes first: a maker sees whether a hand can do it. */
  thr_svg_force(thr_schedule_hardest(schedule, c), force);
  thr_text_printf(words, "No pull above %s. ", force);

  /* Only grips of this cord; draws and other cords' steps are left out. */
  for (int k = 0; k < schedule->n && n < FEW; k++) {
    const thr_schedule_step *step = &schedule->step[k];
    if (step->cord != c || step->deed != THR_DEED_GRIP) continue;
    const int half = cord->half[step->pass];
    thr_text_printf(words, "%s%s and %s (pass %d)", n++ ? ", " : "Grip it between ",
                    known->guide.label[thr_tail(known->f, half)],
                    known->guide.label[thr_head(known->f, half)], step->pass + 1);
  }

  /* What the list leaves out, and what to do between two grips. */
  if (grips > n) thr_text_printf(words, " and at %d more places (steps.txt)", grips - n);
  thr_text_append(words, grips ? ", last pull its end: each time draw the slack of the part "
                                 "before, and hold until the next grip has taken it."
                               : "Pull as steps.txt says.");
}

/* Fills the panel "Tightening" for the cord that is tightened first: where it is gripped, towards
 * which ends it is drawn, how hard. Of an evaluated plan with a schedule the schedule says so; of
 * one without a schedule the slack starts at its slackest pass; else in the middle. */
static void put_tighten(instruction_panel *panel, thr_text *words)
{
  const thr_known *known = panel->known;
  int c = thr_sheets_hardest(known);
  const thr_cord *cord = &known->plan->cord[c];
  const thr_evaluation *evaluation = known->evaluation;
  const char *start = known->guide.label[thr_cord_start(known->f, cord)],
             *end = known->guide.label[thr_cord_end(known->f, cord)];

  /* The picture: a row of pieces on the cord, to which the cases below add arrows. */
  put_row(panel, -27, 0, "hhhh", 0.5);
  put_cord(panel, -36, 0, 36, 0);

  thr_text_printf(words, "%sord %s%s. ",
                  known->plan->n_cords > 1 ? "The order is on the page \"Last\": first c" : "C",
                  cord->id, known->plan->n_cords > 1 ? "" : " is tightened when all is threaded");

  bool from_start = true, from_end = true,
       evaluated = evaluation->present && evaluation->cord[c].known &&
                   evaluation->cord[c].pull != THR_PULL_NONE;

  if (evaluated) {
    put_label(panel, 0, 10, "first grip");
    put_arrow(panel, -1, 7.5, -1, 3.5);
  }

  /* A schedule replaces everything below. */
  if (evaluated && evaluation->schedule.n > 0) {
    put_schedule(known, c, words);
    put_pull(panel, 1, end);
    return;
  }

  /* Without a schedule the cord is drawn from its slackest pass towards the ends that were
   * evaluated. */
  if (evaluated) {
    int pull = evaluation->cord[c].pull, half = cord->half[evaluation->cord[c].slackest];
    from_start = pull != THR_PULL_END;
    from_end = pull != THR_PULL_START;
    thr_text_printf(words,
                    "Its slackest pass is %d, %s to %s: grip the pieces on both sides of it, draw, "
                    "then grip by grip to ",
                    evaluation->cord[c].slackest + 1, known->guide.label[thr_tail(known->f, half)],
                    known->guide.label[thr_head(known->f, half)]);
  } else
    thr_text_append(words, "Draw the slack from its middle pass, grip by grip, to ");

  /* Towards which places the cord is drawn; a closed cord has both ends at one. */
  if (from_start && from_end && cord->closed)
    thr_text_printf(words, "both ends, at %s", start);
  else if (from_start && from_end)
    thr_text_printf(words, "both ends, at %s and %s", start, end);
  else
    thr_text_printf(words, "its %s, at %s", from_start ? "start" : "end", from_start ? start : end);

  /* How hard: the larger pull of both ends. */
  if (evaluated) {
    char force[32];
    double pull = thr_sheets_pull(known, c);
    thr_svg_force(pull, force);
    thr_text_printf(words, ", with %s at most", force);
    thr_sheets_too_hard(known, pull, words);
  }

  thr_text_append(words, ". Then once more.");

  /* An arrow at each end that is drawn. */
  if (from_start) put_pull(panel, -1, start);
  if (from_end) put_pull(panel, 1, end);
}

/* Fills the panel "Knots": an overhand knot with its tail, up against the last piece. */
static void put_knot(instruction_panel *panel, thr_text *words)
{
  segment_list segments = {0};
  /* The picture: a piece, and the knot on the cord that comes out of it. */
  put_row(panel, -32, 4, "h", 0);
  add_overhand(&segments, panel->x, panel->y - 4.58, 2.6);
  put_strands(panel, &segments);
  put_label(panel, 14, 9, "tail");
  put_arrow(panel, -4, 8, -14, 8);

  thr_text_append(words, "When all cords are tight, an overhand knot at each end");

  /* How much cord it takes, if the cord's diameter is known. */
  if (panel->known->supplies.mm > 0)
    thr_text_printf(words, " (it takes %.0f mm of the tail)",
                    ceil(THR_SUPPLIES_KNOT * panel->known->supplies.cord));

  thr_text_append(words,
                  ", drawn up to its piece with the needle's tip in the loop. Two ends that come "
                  "out at one place may be tied together. "
                  "Look at the cords once more, then trim to 10 mm and push the ends into a bore.");
}

/* ---- the page ---- */

/* Draws a panel of a width and height in mm with its upper left corner at (left, top): frame,
 * title, picture and text. number: from 0, row by row. */
static void put_panel(thr_flow *flow, const thr_known *known, int number,
                      const panel_subject *about, double left, double top, double width,
                      double height)
{
  const double size = THR_SHEET_SMALL, high = 1.45 * size, head = 7, room = width - 2 * INDENT;
  char title[96];
  thr_text words = {0};

  /* The picture's middle is halfway between title and text. */
  instruction_panel panel = {known, thr_sheets_out(flow), left + width / 2,
                             top + head + (height - head - LINES * high) / 2};

  /* The frame and the numbered title. */
  thr_sheets_frame(panel.out, left, top, width, height,
                   "rx=\"2\" fill=\"#fcfcf9\" stroke=\"#bbb\" stroke-width=\"0.3\"");
  snprintf(title, sizeof title, "%d  %s", number + 1, about->title);
  thr_svg_text(panel.out, left + INDENT, top + 5.2, 3.4, " font-weight=\"bold\"", title);

  /* The picture is drawn at once; the text comes back and is set from the panel's foot upwards. */
  about->put(&panel, &words);
  if (words.failed)
    thr_nomem(&flow->why);
  else
    thr_sheets_text(flow, left + INDENT,
                    top + height - 2 - (thr_sheets_lines(words.data, room, size) - 1) * high, size,
                    room, "", words.data);
  thr_text_destroy(&words);
}

void thr_sheets_making(thr_flow *flow, const thr_known *known)
{
  /* In reading order, row by row. */
  static const panel_subject subjects[COLUMNS * ROWS] = {
      {"What you need", put_need},          {"Laying a piece", put_lay},
      {"How to start", put_start},          {"Drawing the slack", put_slack},
      {"When a row went wrong", put_wrong}, {"Joining a new length", put_join},
      {"Tightening", put_tighten},          {"Knots", put_knot}};

  thr_sheets_page(flow, "Before you begin", "Before you begin (continued)");
  if (flow->why.code) return;

  /* All panels are equally large, and together as large as the page, which they fill row by row. */
  double height = (thr_sheets_bottom(flow) - flow->y - (ROWS - 1) * AIR) / ROWS,
         width = (thr_sheets_width(flow) - AIR) / COLUMNS;
  for (int i = 0; i < COLUMNS * ROWS && !flow->why.code; i++) {
    const int row = i / COLUMNS, column = i % COLUMNS;
    put_panel(flow, known, i, &subjects[i], THR_SHEET_MARGIN + column * (width + AIR),
              flow->y + row * (height + AIR), width, height);
  }
}
