/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a hub of many arms alone and large, in a corner of a step's picture.
 *
 * The arms of such a hub run together in the picture and in an icon. The inset shows all of them
 * with one length, the two arms of the visit bold, and says by how many arms the needle goes on,
 * which can be counted on the piece in the hand: "out 4 on from in, clockwise". */
#include "diagram/sheets/sheets_parts.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

enum { MANY = 9 };               /* arms from which a piece is shown alone */
static const double SIDE = 56;   /* mm: the inset */
static const double REACH = 17;  /* mm from the hub to the ends of its arms */
static const double HEADING = 9; /* mm above the picture of the inset */
static const double THIN = 0.35; /* mm: width of an arm that the visit does not use */
static const double BOLD = 2.2;  /* mm: width of the two arms by which the needle comes and goes */
static const double CORD = 0.9;  /* mm: width of the cord */
static const double CLEAR = 8;   /* mm between the inset and the ends of the step's passes */

/* Returns the visit that passes through the piece with the most arms, at least MANY; -1 if there is
 * none. */
static int find_hub(const thr_known *known, const thr_step *step)
{
  int best = -1, most = MANY - 1;
  for (int i = step->first; i < step->end && known->pieces.solid; i++) {
    /* Tubes have no arms to tell apart. */
    const thr_visit *v = &known->visit[i];
    int arms = thr_degree(known->f, v->piece);

    /* Where a cord starts or ends there are no two arms to count between. */
    if (arms <= most || v->in < 0 || v->out < 0) continue;
    most = arms;
    best = i;
  }

  return best;
}

/* Returns the angle of arm i on paper, rad; y points down, so that angles grow clockwise. */
static double angle_of(const thr_arms *arms, int i)
{
  return atan2(arms->end[i][1] - arms->hub[1], arms->end[i][0] - arms->hub[0]);
}

/* Returns how many arms further than one arm another one is, clockwise on paper. */
static int count_clockwise(const thr_arms *arms, int from, int to)
{
  int n = 1;
  double wide = thr_scene_sweep(angle_of(arms, from), angle_of(arms, to));

  /* One more than the arms between both. */
  for (int i = 0; i < arms->n; i++)
    if (i != from && i != to) n += thr_scene_sweep(angle_of(arms, from), angle_of(arms, i)) < wide;
  return n;
}

/* Writes the name of the piece that arm i faces beyond the end of the arm. */
static void put_facing(const thr_known *known, const thr_arms *arms, int i, int node,
                       thr_text *text)
{
  double turn = angle_of(arms, i),
         half = 0.5 * thr_scene_text_width(known->guide.label[node], THR_SHEET_SMALL);

  /* The middle of the name is off the end by half the extent of the name in the arm's direction. */
  double reach = hypot(arms->end[i][0] - arms->hub[0], arms->end[i][1] - arms->hub[1]),
         far = reach + 1.5 + fabs(cos(turn)) * half + fabs(sin(turn)) * 0.5 * THR_SHEET_SMALL;
  thr_svg_text(text, arms->hub[0] + far * cos(turn),
               arms->hub[1] + far * sin(turn) + 0.36 * THR_SHEET_SMALL, THR_SHEET_SMALL,
               " font-weight=\"bold\" text-anchor=\"middle\"", known->guide.label[node]);
}

/* Draws the hub of a visit with all arms equally long, those with the cord bold, the cord with its
 * casing and arrow, and the names at both ends. */
static void put_piece(const thr_known *known, const thr_visit *visit, thr_arms *arms, int in,
                      int out, const char *colour, thr_text *text)
{
  /* Lengths carry no meaning here: only directions are counted. */
  for (int i = 0; i < arms->n; i++) {
    double turn = angle_of(arms, i);
    arms->end[i][0] = arms->hub[0] + REACH * cos(turn);
    arms->end[i][1] = arms->hub[1] + REACH * sin(turn);
  }

  /* All arms thin; then along the way of the cord its two arms bold, a white line, and the cord. */
  const struct {
    const char *colour;
    double width;
  } layer[3] = {{"#857a64", BOLD}, {"#ffffff", 1.6 * CORD}, {colour, CORD}};
  thr_text thin = {0}, tip = {0};
  thr_arms_strokes(arms, 0, &thin);
  thr_step_put_path(&thin, "none", "#857a64", THIN, text);
  for (int i = 0; i < 3; i++) {
    thr_text way = {0};
    thr_arms_way(arms, in, out, CORD, &way);
    thr_step_put_path(&way, "none", layer[i].colour, layer[i].width, text);
  }
  thr_arms_tip(arms, out, CORD, &tip);
  thr_step_put_path(&tip, colour, "#ffffff", 0.2, text);

  /* The names of the pieces that the needle comes from and goes to. */
  put_facing(known, arms, in, thr_tail(known->f, visit->in), text);
  put_facing(known, arms, out, thr_head(known->f, visit->out), text);
}

/* Finds a corner of the picture that is free of the points of the step: below before above, left
 * before right. Returns whether there is one. */
static bool find_corner(thr_box picture, const double (*busy)[2], int n, double corner[2])
{
  for (int k = 0; k < 4; k++) {
    bool free = true;

    /* k counts the corners: bit 0 is right, below 2 is the lower edge. */
    corner[0] = k % 2 ? picture.x1 - SIDE : picture.x0;
    corner[1] = k < 2 ? picture.y1 - SIDE : picture.y0;

    /* A point closer to the inset than CLEAR takes the corner. */
    for (int i = 0; i < n && free; i++)
      free = busy[i][0] < corner[0] - CLEAR || busy[i][0] > corner[0] + SIDE + CLEAR ||
             busy[i][1] < corner[1] - CLEAR || busy[i][1] > corner[1] + SIDE + CLEAR;
    if (free) return true;
  }
  return false;
}

void thr_step_put_hub(thr_flow *flow, const thr_known *known, const thr_step *step,
                      const thr_camera *camera, const char *colour, thr_box picture,
                      const double (*busy)[2], int n_busy)
{
  double corner[2];
  char line[96];
  int visit = find_hub(known, step), in, out;

  if (visit < 0 || flow->why.code || picture.x1 - picture.x0 < 2 * SIDE ||
      picture.y1 - picture.y0 < SIDE)
    return;

  if (!find_corner(picture, busy, n_busy, corner)) return;
  const thr_visit *stay = &known->visit[visit];
  double x = corner[0], y = corner[1];

  /* The hub is in the middle of what the heading leaves. */
  thr_arms arms = {.hub = {x + 0.5 * SIDE, y + HEADING + 0.5 * (SIDE - HEADING)}};

  thr_text *text = thr_sheets_out(flow);
  thr_step_arms(known, camera, stay->piece, REACH, &arms, stay->in, stay->out, &in, &out);
  if (in < 0 || out < 0) return; /* beyond the arms that are drawn */
  thr_sheets_frame(text, x, y, SIDE, SIDE, "fill=\"#fff\" stroke=\"#999\" stroke-width=\"0.25\"");

  /* Two lines of heading: which visit, and what to count. */
  snprintf(line, sizeof line, "%d: hub %.20s, %d arms", stay->number,
           known->guide.label[stay->piece], arms.n);
  thr_svg_text(text, x + 2, y + 4, THR_SHEET_SMALL, " font-weight=\"bold\"", line);
  snprintf(line, sizeof line, "out %d on from in, clockwise", count_clockwise(&arms, in, out));
  thr_svg_text(text, x + 2, y + 8, THR_SHEET_SMALL, "", line);

  put_piece(known, stay, &arms, in, out, colour, text);
}

void thr_step_put_example(const thr_known *known, int visit, const double hub[2], double reach,
                          const char *colour, thr_text *text)
{
  const thr_visit *stay = &known->visit[visit];
  thr_arms arms = {.hub = {hub[0], hub[1]}};
  int in, out;

  thr_step_arms(known, NULL, stay->piece, reach, &arms, stay->in, stay->out, &in, &out);
  thr_step_put_icon(known, visit, hub, reach, colour, text);
  put_facing(known, &arms, in, thr_tail(known->f, stay->in), text);
  put_facing(known, &arms, out, thr_head(known->f, stay->out), text);
}
