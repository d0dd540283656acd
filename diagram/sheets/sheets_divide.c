/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the steps of a path end. */
#include "diagram/sheets/sheets_parts.h"
#include "graph/angle.h"

#include <math.h>
#include <stdlib.h>

enum { SMALLEST = 13 }; /* number of the least scale of a flat picture */
static const double TURNED =
    40; /* degrees: a cord that turns by more has come to the end of a run */
static const double STEP = 4, STRAIGHT = 20, NEW = 6,
                    SHORT = 4; /* prices: of a step, of one that ends badly, */
enum { FEW = 6 };              /* of each visit that it has less than so many */

bool thr_step_begins(const thr_sheets *sheets, int i)
{
  return i == 0 || sheets->move[i].part != sheets->move[i - 1].part;
}

bool thr_step_ends(const thr_sheets *sheets, int i)
{
  return i + 1 == sheets->n_visits || thr_step_begins(sheets, i + 1);
}

int thr_step_now(const thr_sheets *sheets, int first, int end, int *now)
{
  int n = 0;
  for (int i = first; i < end; i++) {
    const thr_visit *visit = &sheets->visit[i];
    if (visit->number) now[n++] = sheets->first_pass[visit->cord] + visit->number - 1;
  }
  return n;
}

/* The path that is divided, its visits counted from its first one. */
typedef struct {
  thr_sheets *sheets;
  int first, n;
  int *lines; /* [n + 1] of the rows before */
  int *reach; /* [n] the last end of a step that begins there */
  int view;   /* of pictures in space, from which the last was legible */
} path;

/* A step that is nothing but the start of a cord has no pass to draw. */
static int fewest(const path *p, int i)
{
  return p->sheets->visit[p->first + i].number || i + 1 == p->n ? 1 : 2;
}

/* Does a page take these visits, with every pass legible in the picture? */
static thr_status is_good(path *p, int i, int end, bool *good, thr_err *err)
{
  thr_sheets *sheets = p->sheets;
  int now[THR_STEP_VISITS];
  thr_crop crop = {.now = now, .n_now = thr_step_now(sheets, p->first + i, p->first + end, now)};
  crop.backward = sheets->move[p->first + i].needle == THR_NEEDLE_LEFT;
  double below =
      THR_STEP_LEGEND + thr_step_strip_height(end - i) +
      thr_step_words_height(thr_step_rows_height(p->lines[end] - p->lines[i], end - i), 1, 1);
  double room[2] = {thr_sheets_width(sheets),
                    thr_sheets_bottom(sheets) - THR_SHEET_MARGIN - THR_STEP_HEAD - below};
  thr_crop_view view;
  *good = room[1] >= THR_STEP_PICTURE[1];
  if (!*good) return THR_OK;
  if (sheets->in_space) {
    *good = thr_space_legible(&sheets->space, &crop, room, &p->view);
    return THR_OK;
  }
  thr_status st = thr_crop_fit(&sheets->crops, &crop, room, THR_STEP_PICTURE, &view, err);
  *good = view.scale <= SMALLEST;
  return st;
}

/* What is good stays good when its first visit goes: the last ends only grow. */
static thr_status find_reach(path *p, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0, end = 0; i < p->n && !st; i++) {
    bool good = true;
    if (end < i + fewest(p, i)) end = i + fewest(p, i);
    while (good && !st && end < p->n && end < i + THR_STEP_VISITS &&
           !thr_step_ends(p->sheets, p->first + end - 1)) {
      st = is_good(p, i, end + 1, &good, err);
      end += good;
    }
    p->reach[i] = end;
  }
  return st;
}

/* Price of ending a step behind a visit. */
static double price_of_end(const path *p, int last)
{
  const thr_sheets *sheets = p->sheets;
  const thr_visit *visit = &sheets->visit[p->first + last];
  if (thr_step_ends(sheets, p->first + last)) return 0;
  int out = sheets->visit[p->first + last + 1].in;
  bool turns = visit->number && thr_degrees(thr_turn_angle(sheets->f, visit->in, out)) > TURNED;
  return (turns ? 0 : STRAIGHT) + (visit->nth == 1 ? NEW : 0);
}

/* Cheapest ends: of all ways to divide the visits up to each. before[e]: where the step begins that
 * ends there. */
static void choose(const path *p, double *least, int *before)
{
  least[0] = 0;
  for (int e = 1; e <= p->n; e++)
    least[e] = HUGE_VAL;
  for (int i = 0; i < p->n; i++)
    for (int e = i + fewest(p, i); e <= p->reach[i]; e++) {
      double price =
          least[i] + STEP + price_of_end(p, e - 1) + (e - i < FEW ? (FEW - e + i) * SHORT : 0);
      if (price >= least[e]) continue;
      least[e] = price;
      before[e] = i;
    }
}

thr_status thr_step_divide(thr_sheets *sheets, int c, int **ends, int *n_steps, thr_err *err)
{
  path p = {.sheets = sheets,
            .first = sheets->first_visit[c],
            .n = thr_sheets_end(sheets, c) - sheets->first_visit[c]};
  size_t n = (size_t)p.n + 1;
  double *least = thr_calloc(n, sizeof *least);
  int *before = thr_calloc(n, sizeof *before), *end = *ends = thr_calloc(n, sizeof *end);
  p.lines = thr_calloc(n, sizeof *p.lines);
  p.reach = thr_calloc(n, sizeof *p.reach);
  thr_status st = least && before && end && p.lines && p.reach ? THR_OK : thr_nomem(err);
  for (int i = 0; i < p.n && !st; i++)
    p.lines[i + 1] = p.lines[i] + thr_step_row_lines(sheets, p.first + i);
  if (!st) st = sheets->st;
  if (!st) st = find_reach(&p, err);
  *n_steps = 0;
  if (!st) {
    choose(&p, least, before);
    for (int e = p.n; e > 0; e = before[e])
      ++*n_steps;
    for (int e = p.n, k = *n_steps; e > 0; e = before[e])
      end[--k] = p.first + e;
  }
  free(least);
  free(before);
  free(p.lines);
  free(p.reach);
  return st;
}
