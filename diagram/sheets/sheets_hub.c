/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hub of many arms, which run together in the picture and in an icon, alone and large in a corner
 * of the picture. */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"
#include "graph/angle.h"

#include <math.h>
#include <stdio.h>

enum { MANY = 9 }; /* arms from which a piece is shown alone */
static const double SIDE = 56, REACH = 17,
                    HEADING = 9; /* mm: of the inset; from the hub to the ends; above it */
static const double THIN = 0.35, BOLD = 2.2,
                    CORD = 0.9; /* mm: an arm without cord and with it; the cord */
static const double CLEAR = 8;  /* mm between the inset and what is of the step */

/* The visit that passes through the piece of most arms, at least MANY; -1 = none. */
static int find_hub(const thr_sheets *sheets, const thr_step *step)
{
  int best = -1, most = MANY - 1;
  for (int i = step->first; i < step->end && sheets->pieces.solid; i++) {
    const thr_visit *v = &sheets->visit[i];
    int arms = thr_degree(sheets->f, v->piece);
    if (arms <= most || v->in < 0 || v->out < 0) continue;
    most = arms;
    best = i;
  }
  return best;
}

static double angle_of(const thr_arms *arms, int i)
{
  return atan2(arms->end[i][1] - arms->hub[1], arms->end[i][0] - arms->hub[0]);
}

/* Arms from one to another, clockwise on paper, where y goes down. */
static int count_clockwise(const thr_arms *arms, int from, int to)
{
  int n = 1;
  double wide = thr_scene_sweep(angle_of(arms, from), angle_of(arms, to));
  for (int i = 0; i < arms->n; i++)
    if (i != from && i != to) n += thr_scene_sweep(angle_of(arms, from), angle_of(arms, i)) < wide;
  return n;
}

static void put_arm(const thr_arms *arms, int i, double width, const char *colour, thr_text *text)
{
  thr_text_printf(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"", colour,
                  width);
  thr_svg_move(text, arms->hub);
  thr_svg_line(text, arms->end[i]);
  thr_text_append(text, "\"/>\n");
}

static void put_facing(const thr_sheets *sheets, const thr_arms *arms, int i, int node,
                       thr_text *text)
{
  double turn = angle_of(arms, i),
         half = 0.5 * thr_scene_text_width(sheets->guide.label[node], THR_SHEET_SMALL);
  double far = REACH + 1.5 + fabs(cos(turn)) * half + fabs(sin(turn)) * 0.5 * THR_SHEET_SMALL;
  thr_svg_text(text, arms->hub[0] + far * cos(turn),
               arms->hub[1] + far * sin(turn) + 0.36 * THR_SHEET_SMALL, THR_SHEET_SMALL,
               " font-weight=\"bold\" text-anchor=\"middle\"", sheets->guide.label[node]);
}

/* All arms as long as each other, those with the cord bold. */
static void put_piece(const thr_sheets *sheets, const thr_visit *v, thr_arms *arms, int in, int out,
                      const char *colour, thr_text *text)
{
  for (int i = 0; i < arms->n; i++) {
    double turn = angle_of(arms, i);
    arms->end[i][0] = arms->hub[0] + REACH * cos(turn);
    arms->end[i][1] = arms->hub[1] + REACH * sin(turn);
  }
  for (int i = 0; i < arms->n; i++)
    if (i != in && i != out) put_arm(arms, i, THIN, "#857a64", text);
  put_arm(arms, in, BOLD, "#857a64", text);
  put_arm(arms, out, BOLD, "#857a64", text);
  for (int casing = 1; casing >= 0; casing--) {
    thr_text_printf(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"",
                    casing ? "#ffffff" : colour, casing ? 1.6 * CORD : CORD);
    thr_arms_way(arms, in, out, CORD, text);
    thr_text_append(text, "\"/>\n");
  }
  thr_text_printf(text, "<path fill=\"%s\" stroke=\"#ffffff\" stroke-width=\"0.20\" d=\"", colour);
  thr_arms_tip(arms, out, CORD, text);
  thr_text_append(text, "\"/>\n");
  put_facing(sheets, arms, in, thr_tail(sheets->f, v->in), text);
  put_facing(sheets, arms, out, thr_head(sheets->f, v->out), text);
}

/* The corner of the picture, of those in which nothing of the step is, that comes first; false if
 * there is none. */
static bool find_corner(thr_box picture, const double (*busy)[2], int n, double corner[2])
{
  for (int k = 0; k < 4; k++) {
    bool free = true;
    corner[0] = k % 2 ? picture.x1 - SIDE : picture.x0;
    corner[1] = k < 2 ? picture.y1 - SIDE : picture.y0;
    for (int i = 0; i < n && free; i++)
      free = busy[i][0] < corner[0] - CLEAR || busy[i][0] > corner[0] + SIDE + CLEAR ||
             busy[i][1] < corner[1] - CLEAR || busy[i][1] > corner[1] + SIDE + CLEAR;
    if (free) return true;
  }
  return false;
}

void thr_step_put_hub(thr_sheets *sheets, const thr_step *step, const thr_camera *camera,
                      const char *colour, thr_box picture, const double (*busy)[2], int n_busy)
{
  double corner[2];
  char line[96];
  int visit = find_hub(sheets, step), in, out;
  if (visit < 0 || sheets->st || picture.x1 - picture.x0 < 2 * SIDE ||
      picture.y1 - picture.y0 < SIDE)
    return;
  if (!find_corner(picture, busy, n_busy, corner)) return;
  const thr_visit *v = &sheets->visit[visit];
  double x = corner[0], y = corner[1];
  thr_arms arms = {.hub = {x + 0.5 * SIDE, y + HEADING + 0.5 * (SIDE - HEADING)}};
  thr_text *text = thr_sheets_out(sheets);
  thr_step_arms(sheets, camera, v->piece, REACH, &arms, v->in, v->out, &in, &out);
  if (in < 0 || out < 0) return; /* beyond the arms that are drawn */
  thr_text_printf(
      text,
      "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"#fff\" stroke=\"#999\" "
      "stroke-width=\"0.25\"/>\n",
      x, y, SIDE, SIDE);
  snprintf(line, sizeof line, "%d: hub %.20s, %d arms", v->number, sheets->guide.label[v->piece],
           arms.n);
  thr_svg_text(text, x + 2, y + 4, THR_SHEET_SMALL, " font-weight=\"bold\"", line);
  snprintf(line, sizeof line, "out %d on from in, clockwise", count_clockwise(&arms, in, out));
  thr_svg_text(text, x + 2, y + 8, THR_SHEET_SMALL, "", line);
  put_piece(sheets, v, &arms, in, out, colour, text);
}
