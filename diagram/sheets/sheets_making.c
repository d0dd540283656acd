/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How pieces are handled, in eight panels: what is needed, laying a piece, starting, slack, a row
 * that went wrong, joining, tightening, knots. Lengths, places and forces are those of the plan. */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"
#include "graph/angle.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/schedule.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { COLUMNS = 2, ROWS = 4, LINES = 5, NAMED = 4 };  /* feet that are named */
static const double AIR = 3, INDENT = 3;               /* mm: between panels; of what is in one */
static const double ARM = 5, CORD = 1.4, CASING = 2.4; /* mm: widths */
static const char *const OLD = "#d55e00", *const NEW = "#0072b2"; /* cords of the pictures */

/* A panel being filled: the picture is around (x, y), which is its middle. */
typedef struct {
  thr_sheets *sheets;
  thr_text *out;
  double left, top, width, height;
  double x, y;
} panel;

/* ---- what pictures are made of ---- */

static void put_label(const panel *p, double x, double y, const char *words)
{
  thr_svg_text(p->out, x, y, THR_SHEET_SMALL, " text-anchor=\"middle\"", words);
}

static void put_line(const panel *p, double x0, double y0, double x1, double y1, double width,
                     const char *colour)
{
  thr_text_printf(
      p->out,
      "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n",
      colour, width, x0, y0, x1, y1);
}

/* A straight arrow to (x1, y1). */
static void put_arrow(const panel *p, double x0, double y0, double x1, double y1)
{
  double length = hypot(x1 - x0, y1 - y0), dx = 2.2 * (x1 - x0) / length,
         dy = 2.2 * (y1 - y0) / length;
  put_line(p, x0, y0, x1 - dx, y1 - dy, 0.5, "#222");
  thr_text_printf(p->out, "<path fill=\"#222\" d=\"M%.2f %.2fL%.2f %.2fL%.2f %.2fz\"/>\n", x1, y1,
                  x1 - dx - 0.45 * dy, y1 - dy + 0.45 * dx, x1 - dx + 0.45 * dy,
                  y1 - dy - 0.45 * dx);
}

static void put_cord(const panel *p, double x0, double y0, double x1, double y1, const char *colour)
{
  put_line(p, x0, y0, x1, y1, CASING, "#fff");
  put_line(p, x0, y0, x1, y1, CORD, colour);
}

static void put_stopper(const panel *p, double x, double y)
{
  thr_text_printf(
      p->out, "<rect x=\"%.2f\" y=\"%.2f\" width=\"2.4\" height=\"6\" rx=\"0.6\" fill=\"#222\"/>\n",
      x - 1.2, y - 3);
}

static void put_needle(const panel *p, double x, double y, double length)
{
  thr_text_printf(p->out,
                  "<path fill=\"#ddd\" stroke=\"#222\" stroke-width=\"0.3\" d=\"M%.2f %.2fL%.2f "
                  "%.2fL%.2f %.2fL%.2f %.2fz\"/>\n",
                  x, y - 0.7, x + 0.8 * length, y - 0.5, x + length, y, x + 0.8 * length, y + 0.7);
}

static const char *fill_of(thr_piece_state state)
{
  return state == THR_PIECE_NEW ? "#ffe08a" : state == THR_PIECE_HELD ? "#d3ccbf" : "#fff";
}

/* A piece with its hub at (x, y) and n arms of a length by their angles, as lines with a dark edge
 * below and their colour above.
 */
static void put_piece(const panel *p, double x, double y, int n, const double *angle, double length,
                      thr_piece_state state)
{
  double edge = state == THR_PIECE_NEW ? 1.2 : 0.8;
  for (int above = 0; above < 2; above++) {
    double grow = above ? 0 : edge, tip = length + grow / 2;
    const char *colour = above ? fill_of(state) : state == THR_PIECE_LATER ? "#999" : "#222";
    for (int i = 0; i < n; i++)
      put_line(p, x, y, x + tip * cos(angle[i]), y - tip * sin(angle[i]), ARM + grow, colour);
    if (n > 2)
      thr_text_printf(p->out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"%s\"/>\n", x, y,
                      (ARM + grow) / 2, colour);
  }
}

static const double CROSS[4] = {0, THR_PI / 2, THR_PI, -THR_PI / 2};

/* A row of n pieces like those of the plan, from (x, y) to the right: crosses, or tubes. */
static double put_row(const panel *p, double x, double y, int n, double gap,
                      const thr_piece_state *state)
{
  bool solid = p->sheets->pieces.solid;
  static const double tube[2] = {0, THR_PI};
  for (int i = 0; i < n; i++, x += 13 + gap)
    put_piece(p, x + 6, y, solid ? 4 : 2, solid ? CROSS : tube, 6, state[i]);
  return x;
}

/* ---- cords that cross ---- */

enum { MOST_BITS = 400 };

/* Short straight pieces of cords, painted from the lowest to the highest. */
typedef struct {
  double from[2], to[2], height;
  const char *colour;
} bit;

typedef struct {
  int n;
  bit bit[MOST_BITS];
} strands;

static int by_height(const void *a, const void *b)
{
  const bit *p = a, *q = b;
  return p->height < q->height ? -1 : p->height > q->height;
}

static void add_bit(strands *s, const double from[3], const double to[3], const char *colour)
{
  if (s->n < MOST_BITS)
    s->bit[s->n++] = (bit){{from[0], from[1]}, {to[0], to[1]}, (from[2] + to[2]) / 2, colour};
}

static void put_strands(const panel *p, strands *s)
{
  qsort(s->bit, (size_t)s->n, sizeof *s->bit, by_height);
  for (int i = 0; i < s->n; i++)
    for (int above = 0; above < 2; above++)
      thr_text_printf(p->out,
                      "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" "
                      "stroke-linecap=\"%s\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n",
                      above ? s->bit[i].colour : "#fff", above ? CORD : CASING,
                      above ? "round" : "butt", s->bit[i].from[0], s->bit[i].from[1],
                      s->bit[i].to[0], s->bit[i].to[1]);
}

/* An overhand knot: a trefoil, opened at the lobe that points down; its ends go on to the left and
 * to the right along a line. */
static void add_overhand(strands *s, double x, double y, double size)
{
  enum { N = 120 };
  double before[3] = {0};
  for (int i = 0; i <= N; i++) {
    double t = THR_PI + 0.35 + (2 * THR_PI - 0.7) * i / N;
    double at[3] = {x + size * (sin(t) + 2 * sin(2 * t)), y - size * (cos(t) - 2 * cos(2 * t)),
                    -sin(3 * t)};
    if (i) add_bit(s, before, at, OLD);
    for (int k = 0; k < 3; k++)
      before[k] = at[k];
  }
  double low = y + 3.3 * size;
  for (int side = 0; side < 2; side++) { /* the end of the curve is on the left */
    double sign = side ? 1 : -1;
    const double tip[3] = {x + sign * size * 0.945, y + size * 2.47, 0},
                 bend[3] = {x + sign * size * 1.8, low, 0};
    const double far[3] = {x + sign * size * 8, low, 0};
    add_bit(s, tip, bend, OLD);
    add_bit(s, bend, far, OLD);
  }
}

/* Two turns about a line from x on, and a short end. */
static void add_coil(strands *s, double x, double y, double dir, const char *colour)
{
  enum { N = 60 };
  double before[3] = {0};
  for (int i = 0; i <= N; i++) {
    double t = 4 * THR_PI * i / N;
    double at[3] = {x + dir * 0.45 * t, y - 2.4 * cos(t), sin(t)};
    if (i) add_bit(s, before, at, colour);
    for (int k = 0; k < 3; k++)
      before[k] = at[k];
  }
  double end[3] = {before[0] + dir * 3, before[1] - 2.5, 1};
  add_bit(s, before, end, colour);
}

static void add_straight(strands *s, double x0, double x1, double y, const char *colour)
{
  enum { N = 40 };
  for (int i = 0; i < N; i++) {
    double from[3] = {x0 + (x1 - x0) * i / N, y, 0}, to[3] = {x0 + (x1 - x0) * (i + 1) / N, y, 0};
    add_bit(s, from, to, colour);
  }
}

/* ---- the panels: each a picture and words ---- */

typedef struct {
  const char *title;
  void (*put)(panel *p, thr_text *words); /* draws, and says */
} subject;

static double widest_bore(const thr_sheets *sheets, bool narrowest)
{
  double found = 0;
  for (int e = 0; e < sheets->f->n_edges; e++) {
    double bore = thr_supplies_bore(&sheets->supplies, e);
    if (bore > 0 && (found == 0 || (narrowest ? bore < found : bore > found))) found = bore;
  }
  return thr_supplies_bore_mm(&sheets->supplies, found);
}

static void put_need(panel *p, thr_text *words)
{
  thr_sheets *sheets = p->sheets;
  int n = sheets->plan->n_cords;
  double least = INFINITY, most = 0;
  char from[64], to[64];
  for (int c = 0; c < n; c++) {
    double cut = thr_supplies_cut(&sheets->supplies, c).cut;
    if (!(sheets->supplies.mm > 0)) cut = thr_supplies_cut(&sheets->supplies, c).length;
    least = fmin(least, cut);
    most = fmax(most, cut);
  }
  thr_svg_length(least, sheets->f->units, from);
  thr_svg_length(most, sheets->f->units, to);
  put_cord(p, p->x - 36, p->y - 3, p->x - 8, p->y - 3, OLD);
  put_label(p, p->x - 22, p->y + 2, "cord");
  put_needle(p, p->x + 12, p->y - 3, 22);
  put_label(p, p->x + 23, p->y + 2, "needle, blunt");
  put_stopper(p, p->x + 2, p->y - 3);
  put_label(p, p->x + 2, p->y + 5, "stopper");
  thr_text_printf(words, "%d %s; %d cord%s of %s", sheets->pieces.n,
                  thr_pieces_word(sheets->plan, sheets->pieces.n), n, n == 1 ? "" : "s", from);
  if (most > least * (1 + 1e-9)) thr_text_printf(words, " to %s", to);
  thr_text_append(words, " (cut list); a needle");
  if (sheets->supplies.mm > 0)
    thr_text_printf(
        words,
        " that with its cord goes through %.2f mm; a stopper that does not slip into %.2f mm",
        widest_bore(sheets, true), widest_bore(sheets, false));
  else
    thr_text_append(words, " thinner than the bores; a stopper wider than they are");
  thr_text_append(words, "; tape, scissors, and overview.svg to lay the pieces on.");
}

/* The first stay of a needle in a new piece that it comes into and leaves, with as many arms as can
 * be: -1 = none. */
static int example(const thr_sheets *sheets)
{
  int best = -1, arms = 0;
  for (int i = 0; i < sheets->n_visits; i++) {
    const thr_visit *visit = &sheets->visit[i];
    int n = thr_pieces_arms(&sheets->pieces, visit->piece);
    if (visit->nth > 1 || visit->in < 0 || visit->out < 0 || n > 4 || n <= arms) continue;
    arms = n;
    best = i;
  }
  return best;
}

/* Direction in which a half-edge leaves its place in the pictures. */
static double direction(const thr_sheets *sheets, int half)
{
  const thr_layout *layout = &sheets->guide.layout;
  const thr_frame *paper = thr_layout_paper(layout, sheets->f);
  const double *from = layout->xy[thr_tail(paper, half)], *to = layout->xy[thr_head(paper, half)];
  return atan2(to[1] - from[1], to[0] - from[0]);
}

/* The middle of the widest gap between arms: the name goes there. */
static double widest_gap(int n, const double *angle)
{
  double best = 0, widest = 0;
  for (int i = 0; i < n; i++) {
    double gap = 2 * THR_PI;
    for (int k = 0; k < n; k++) {
      double sweep = thr_scene_sweep(angle[i], angle[k]);
      if (sweep > 0 && sweep < gap) gap = sweep;
    }
    if (gap > widest + 1e-9) {
      widest = gap;
      best = angle[i] + gap / 2;
    }
  }
  return best;
}

/* The cord from the hub out of an arm, and what that arm faces: beside the end of a steep arm,
 * beyond that of a flat one. */
static void put_arm(const panel *p, int half, bool out)
{
  double a = direction(p->sheets, half), x = cos(a), y = -sin(a),
         far = fabs(y) > 0.4 ? 13 * fmin(fabs(y), 1) : 0;
  char words[THR_LABEL + 16];
  put_cord(p, p->x, p->y, p->x + 11.5 * x, p->y + 11.5 * y, OLD);
  if (out) put_arrow(p, p->x + 9 * x, p->y + 9 * y, p->x + 14 * x, p->y + 14 * y);
  snprintf(words, sizeof words, "%s %.20s", out ? "out to" : "in from",
           p->sheets->guide.label[thr_head(p->sheets->f, half)]);
  put_label(p, p->x + (x < -0.1 ? -1 : 1) * (fabs(24 * x) + (far > 0 ? far - 10 * fabs(x) : 0)),
            p->y + 11 * y + 1, words);
}

static void put_example(const panel *p, const thr_visit *visit)
{
  const thr_frame *frame = p->sheets->f;
  int v = visit->piece, n = 0;
  double angle[4] = {0};
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    angle[n++] = direction(p->sheets, frame->half[i]);
  put_piece(p, p->x, p->y, n, angle, 8, THR_PIECE_NEW);
  put_arm(p, visit->in ^ 1, false);
  put_arm(p, visit->out, true);
  double name = widest_gap(n, angle);
  thr_svg_text(p->out, p->x + 7.5 * cos(name), p->y - 7.5 * sin(name) + 1, THR_SHEET_SMALL,
               " text-anchor=\"middle\" font-weight=\"bold\"", p->sheets->guide.label[v]);
}

static void put_lay(panel *p, thr_text *words)
{
  const thr_sheets *sheets = p->sheets;
  int i = sheets->pieces.solid ? example(sheets) : -1;
  if (i >= 0)
    put_example(p, &sheets->visit[i]);
  else {
    static const thr_piece_state state[3] = {THR_PIECE_HELD, THR_PIECE_NEW, THR_PIECE_LATER};
    put_row(p, p->x - 20, p->y, 3, 1.5, state);
    put_cord(p, p->x - 28, p->y, p->x + 5, p->y, OLD);
  }
  if (i >= 0) {
    thr_text_append(
        words, "Lay each piece as the overview shows it: its outer side up, its name upright. ");
    const thr_visit *visit = &sheets->visit[i];
    thr_text_printf(words, "Here %s: in by the arm that faces %s, out by the one that faces %s.",
                    sheets->guide.label[visit->piece],
                    sheets->guide.label[thr_tail(sheets->f, visit->in)],
                    sheets->guide.label[thr_head(sheets->f, visit->out)]);
  } else
    thr_text_append(words, "Lay each piece where the overview has it, its name upright. Rows say "
                           "by which of its two ends the needle goes in.");
}

static void put_start(panel *p, thr_text *words)
{
  const thr_sheets *sheets = p->sheets;
  const thr_part *part = &sheets->part[0];
  static const thr_piece_state state[1] = {THR_PIECE_NEW};
  put_row(p, p->x - 2, p->y, 1, 0, state);
  put_cord(p, p->x - 34, p->y, p->x + 18, p->y, OLD);
  put_stopper(p, p->x - 5, p->y);
  put_needle(p, p->x + 18, p->y, 18);
  put_label(p, p->x - 5, p->y - 5, "stopper");
  put_label(p, p->x - 24, p->y + 5, sheets->fold[part->cord] ? "other half" : "tail 150 mm");
  put_label(p, p->x + 27, p->y + 5, "needle");
  thr_text_append(words, "Thread the needle, fold the end of the cord back and tape it flat. ");
  if (sheets->fold[part->cord])
    thr_text_append(words, "A cord that is threaded from its middle has the stopper at its fold "
                           "(cut list), until the left needle's turn.");
  else {
    thr_text_printf(
        words,
        "Put the stopper %.0f mm from the other end: that tail is for the knot. Cord %s starts at ",
        THR_SUPPLIES_TAIL, sheets->plan->cord[part->cord].id);
    thr_guide_place(&sheets->guide, thr_cord_start(sheets->f, &sheets->plan->cord[part->cord]),
                    words);
    thr_text_append(words, "; the first piece goes up to the stopper.");
  }
}

static void put_slack(panel *p, thr_text *words)
{
  static const thr_piece_state state[4] = {THR_PIECE_HELD, THR_PIECE_HELD, THR_PIECE_NEW,
                                           THR_PIECE_NEW};
  put_row(p, p->x - 29, p->y, 2, 0.5, state);
  put_row(p, p->x + 2, p->y, 2, 0.5, state + 2);
  put_cord(p, p->x - 33, p->y, p->x + 36, p->y, OLD);
  put_stopper(p, p->x - 33, p->y);
  put_arrow(p, p->x + 30, p->y - 4, p->x + 38, p->y - 4);
  put_label(p, p->x + 34, p->y - 6.5, "draw");
  put_label(p, p->x - 23, p->y - 9, "hold");
  put_label(p, p->x, p->y + 10, "this gap closes");
  put_arrow(p, p->x - 1, p->y + 7, p->x - 1, p->y + 2);
  thr_text_append(words, "Draw the slack every few rows, and at every check: hold the last piece "
                         "that sits, draw the cord until ");
  thr_text_append(words, p->sheets->pieces.solid ? "the faces touch" : "the tubes meet");
  thr_text_append(
      words,
      ", go on to the next one, from the stopper to the needle. Never a long way in one pull.");
}

static void put_wrong(panel *p, thr_text *words)
{
  static const thr_piece_state state[4] = {THR_PIECE_HELD, THR_PIECE_HELD, THR_PIECE_LATER,
                                           THR_PIECE_LATER};
  put_row(p, p->x - 29, p->y, 4, 0.5, state);
  put_cord(p, p->x - 33, p->y, p->x - 1.5, p->y, OLD);
  put_line(p, p->x - 2, p->y - 8, p->x - 2, p->y + 8, 0.8, "#009e73");
  put_label(p, p->x - 2, p->y - 9.5, "last check");
  put_arrow(p, p->x + 28, p->y - 8, p->x + 12, p->y - 8);
  put_label(p, p->x + 20, p->y - 10, "back, one by one");
  thr_text_append(words,
                  "A row went wrong: take the needle off the cord. Draw the bare cord back by "
                  "hand, piece by piece, as "
                  "far as the last check that held. "
                  "Lay the pieces back in their places, untick the rows, begin again from there.");
}

static void put_join(panel *p, thr_text *words)
{
  const thr_frame *frame = p->sheets->f;
  strands s = {0};
  int feet = 0;
  add_straight(&s, p->x - 36, p->x + 6, p->y + 1, OLD);
  add_straight(&s, p->x - 6, p->x + 36, p->y - 1, NEW);
  add_coil(&s, p->x + 6, p->y, 1, OLD);
  add_coil(&s, p->x - 6, p->y, -1, NEW);
  put_strands(p, &s);
  put_label(p, p->x - 29, p->y + 6, "old cord");
  put_label(p, p->x + 29, p->y + 6, "new length");
  put_arrow(p, p->x - 12, p->y + 7, p->x - 4, p->y + 7);
  put_arrow(p, p->x + 12, p->y + 7, p->x + 4, p->y + 7);
  thr_text_append(
      words,
      "To join a new length, tie each end round the other cord and draw both knots together. ");
  thr_text_append(words, p->sheets->pieces.solid ? "Join only at a foot or where a hub is open"
                                                 : "Join only at a foot or where tubes leave room");
  for (int v = 0; v < frame->n_nodes; v++)
    if (frame->foot[v] && feet++ < NAMED)
      thr_text_printf(words, "%s%s", feet > 1 ? ", " : " (feet: ", p->sheets->guide.label[v]);
  thr_text_append(words, feet > NAMED ? ", ..)" : feet ? ")" : "; this frame has no foot");
  thr_text_append(words, p->sheets->pieces.solid ? ": a knot between two faces keeps them apart."
                                                 : ": a knot in a tube stops the cord.");
}

static void put_pull(const panel *p, double side, const char *place)
{
  char words[THR_LABEL + 16];
  put_arrow(p, p->x + side * 30, p->y - 4.5, p->x + side * 38, p->y - 4.5);
  snprintf(words, sizeof words, "at %.12s", place);
  put_label(p, p->x + side * 33, p->y + 5, words);
}

/* The grips of cord c in the schedule, the first few by their places; all stand in steps.txt. */
static void put_schedule(const thr_sheets *sheets, int c, thr_text *words)
{
  enum { FEW = 4 };
  const thr_schedule *schedule = &sheets->plan->evaluation.schedule;
  const thr_cord *cord = &sheets->plan->cord[c];
  const int grips = thr_schedule_grips(schedule, c);
  char force[32];
  int n = 0;
  thr_svg_force(thr_schedule_hardest(schedule, c), force);
  thr_text_printf(words, "No pull above %s. ", force);
  for (int k = 0; k < schedule->n && n < FEW; k++) {
    const thr_schedule_step *step = &schedule->step[k];
    if (step->cord != c || step->deed != THR_DEED_GRIP) continue;
    const int half = cord->half[step->pass];
    thr_text_printf(words, "%s%s and %s (pass %d)", n++ ? ", " : "Grip it between ",
                    sheets->guide.label[thr_tail(sheets->f, half)],
                    sheets->guide.label[thr_head(sheets->f, half)], step->pass + 1);
  }
  if (grips > n) thr_text_printf(words, " and at %d more places (steps.txt)", grips - n);
  thr_text_append(words, grips ? ", last pull its end: each time draw the slack of the part "
                                 "before, and hold until the next grip has taken it."
                               : "Pull as steps.txt says.");
}

/* Which cord is first, where it is held and where it is drawn: of an evaluated plan the slack
 * starts where it is slackest. */
static void put_tighten(panel *p, thr_text *words)
{
  const thr_sheets *sheets = p->sheets;
  int c = thr_sheets_hardest(sheets);
  const thr_cord *cord = &sheets->plan->cord[c];
  const thr_evaluation *evaluation = &sheets->plan->evaluation;
  const char *start = sheets->guide.label[thr_cord_start(sheets->f, cord)],
             *end = sheets->guide.label[thr_cord_end(sheets->f, cord)];
  static const thr_piece_state state[4] = {THR_PIECE_HELD, THR_PIECE_HELD, THR_PIECE_HELD,
                                           THR_PIECE_HELD};
  put_row(p, p->x - 27, p->y, 4, 0.5, state);
  put_cord(p, p->x - 36, p->y, p->x + 36, p->y, OLD);
  thr_text_printf(words, "%sord %s%s. ",
                  sheets->plan->n_cords > 1 ? "The order is on the page \"Last\": first c" : "C",
                  cord->id, sheets->plan->n_cords > 1 ? "" : " is tightened when all is threaded");
  bool from_start = true, from_end = true,
       known = evaluation->present && evaluation->cord[c].known &&
               evaluation->cord[c].pull != THR_PULL_NONE;
  if (known && evaluation->schedule.n > 0) {
    put_schedule(sheets, c, words);
    put_label(p, p->x, p->y + 10, "first grip");
    put_arrow(p, p->x - 1, p->y + 7.5, p->x - 1, p->y + 3.5);
    put_pull(p, 1, end);
    return;
  }
  if (known) {
    int pull = evaluation->cord[c].pull, half = cord->half[evaluation->cord[c].slackest];
    from_start = pull != THR_PULL_END;
    from_end = pull != THR_PULL_START;
    thr_text_printf(words,
                    "Its slackest pass is %d, %s to %s: grip the pieces on both sides of it, draw, "
                    "then grip by grip to ",
                    evaluation->cord[c].slackest + 1,
                    sheets->guide.label[thr_tail(sheets->f, half)],
                    sheets->guide.label[thr_head(sheets->f, half)]);
    put_label(p, p->x, p->y + 10, "first grip");
    put_arrow(p, p->x - 1, p->y + 7.5, p->x - 1, p->y + 3.5);
  } else
    thr_text_append(words, "Draw the slack from its middle pass, grip by grip, to ");
  if (from_start && from_end && cord->closed)
    thr_text_printf(words, "both ends, at %s", start);
  else if (from_start && from_end)
    thr_text_printf(words, "both ends, at %s and %s", start, end);
  else
    thr_text_printf(words, "its %s, at %s", from_start ? "start" : "end", from_start ? start : end);
  if (known) {
    char force[32];
    double pull = fmax(evaluation->cord[c].force, evaluation->cord[c].other_force);
    thr_svg_force(pull, force);
    thr_text_printf(words, ", with %s at most", force);
    thr_sheets_too_hard(pull, words);
  }
  thr_text_append(words, ". Then once more.");
  if (from_start) put_pull(p, -1, start);
  if (from_end) put_pull(p, 1, end);
}

static void put_knot(panel *p, thr_text *words)
{
  strands s = {0};
  static const thr_piece_state state[1] = {THR_PIECE_HELD};
  put_row(p, p->x - 32, p->y + 4, 1, 0, state);
  add_overhand(&s, p->x, p->y - 4.58, 2.6);
  put_strands(p, &s);
  put_label(p, p->x + 14, p->y + 9, "tail");
  put_arrow(p, p->x - 4, p->y + 8, p->x - 14, p->y + 8);
  thr_text_append(words, "When all cords are tight, an overhand knot at each end");
  if (p->sheets->supplies.mm > 0)
    thr_text_printf(words, " (it takes %.0f mm of this cord)",
                    ceil(THR_SUPPLIES_KNOT * p->sheets->supplies.cord));
  thr_text_append(words,
                  ", drawn up to its piece with the needle's tip in the loop. Two ends that come "
                  "out at one place may be tied together. "
                  "Look at the cords once more, then trim to 10 mm and push the ends into a bore.");
}

/* ---- the page ---- */

static void put_panel(thr_sheets *sheets, int number, const subject *about, double height)
{
  double width = (thr_sheets_width(sheets) - AIR) / COLUMNS;
  panel p = {.sheets = sheets, .out = thr_sheets_out(sheets), .width = width, .height = height};
  p.left = THR_SHEET_MARGIN + number % COLUMNS * (width + AIR);
  p.top = sheets->y + number / COLUMNS * (height + AIR);
  double words_height = LINES * 1.45 * THR_SHEET_SMALL, head = 7;
  p.x = p.left + width / 2;
  p.y = p.top + head + (height - head - words_height) / 2;
  char title[96];
  thr_text words = {0};
  thr_text_printf(p.out,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"2\" "
                  "fill=\"#fcfcf9\" stroke=\"#bbb\" "
                  "stroke-width=\"0.3\"/>\n",
                  p.left, p.top, width, height);
  snprintf(title, sizeof title, "%d  %s", number + 1, about->title);
  thr_svg_text(p.out, p.left + INDENT, p.top + 5.2, 3.4, " font-weight=\"bold\"", title);
  about->put(&p, &words);
  if (words.failed)
    thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  else {
    double size = THR_SHEET_SMALL, room = width - 2 * INDENT;
    int lines = thr_sheets_lines(words.data, room, size);
    thr_sheets_text(sheets, p.left + INDENT, p.top + height - 2 - (lines - 1) * 1.45 * size, size,
                    room, "", words.data);
  }
  thr_text_destroy(&words);
}

void thr_sheets_making(thr_sheets *sheets)
{
  static const subject subjects[COLUMNS * ROWS] = {
      {"What you need", put_need},          {"Laying a piece", put_lay},
      {"How to start", put_start},          {"Drawing the slack", put_slack},
      {"When a row went wrong", put_wrong}, {"Joining a new length", put_join},
      {"Tightening", put_tighten},          {"Knots", put_knot}};
  thr_sheets_page(sheets, "Before you begin", "Before you begin (continued)");
  if (sheets->st) return;
  double height = (thr_sheets_bottom(sheets) - sheets->y - (ROWS - 1) * AIR) / ROWS;
  for (int i = 0; i < COLUMNS * ROWS && !sheets->st; i++)
    put_panel(sheets, i, &subjects[i], height);
}
