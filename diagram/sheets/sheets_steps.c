/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of a path: some twenty passes each, as a picture, the string of pieces and rows to tick
 * off. A page takes as many steps as fit whole, and what room is left goes to their pictures. */
#include "diagram/sheets/sheets_parts.h"

#include <math.h>
#include <stdlib.h>

static const double BETWEEN = 5;           /* mm between two steps of a page */
static const double LOCATOR[2] = {44, 22}; /* mm: width and height of the small picture, at most */
static const double IN_SPACE = 9,
                    MOST = 110; /* mm: least height of a picture in space for each visit; in all */

/* Height of a step but for its picture, mm. */
static double height_beside(const thr_step *p)
{
  return THR_STEP_HEAD + THR_STEP_LEGEND + thr_step_strip_height(p->end - p->first) +
         thr_step_words_height(p->rows_height, p->lines_before, p->lines_after);
}

/* ---- pictures ---- */

static thr_crop crop_of(const thr_sheets *sheets, const thr_step *p, int *now)
{
  thr_crop crop = {.number = p->number, .now = now, .colour = thr_step_colour(sheets, p)};
  crop.n_now = thr_step_now(sheets, p->first, p->end, now);
  crop.backward = sheets->move[p->first].needle == THR_NEEDLE_LEFT;
  return crop;
}

/* How high its picture is at least. */
static thr_status find_height(thr_sheets *sheets, thr_step *p, thr_err *err)
{
  int now[THR_STEP_VISITS];
  thr_crop crop = crop_of(sheets, p, now);
  double room[2] = {thr_sheets_width(sheets),
                    thr_sheets_bottom(sheets) - THR_SHEET_MARGIN - height_beside(p)};
  room[1] = fmax(room[1], THR_STEP_PICTURE[1]);
  p->height = fmin(room[1], fmin(MOST, THR_STEP_PICTURE[1] + IN_SPACE * (p->end - p->first)));
  if (sheets->in_space) return THR_OK;
  thr_status st = thr_crop_fit(&sheets->crops, &crop, room, THR_STEP_PICTURE, &p->view, err);
  if (p->view.scale >= THR_CROP_SCALES) p->view.scale = THR_CROP_SCALES - 1;
  p->height = p->view.size[1];
  return st;
}

static thr_status put_flat(thr_sheets *sheets, thr_step *p, const thr_crop *crop,
                           const double room[2], double top, thr_err *err)
{
  thr_box shown, paper = {0, top, sheets->size[0] - THR_SHEET_MARGIN, top + LOCATOR[1]};
  paper.x0 = paper.x1 - LOCATOR[0];
  thr_crop_fill(&sheets->crops, &p->view, room);
  double at[2] = {0.5 * (sheets->size[0] - p->view.size[0]), top + THR_STEP_HEAD};
  thr_status st =
      thr_crop_draw(&sheets->crops, crop, &p->view, at, &shown, thr_sheets_out(sheets), err);
  if (!st) thr_crop_locate(&sheets->crops, crop, &p->view, shown, paper, thr_sheets_out(sheets));
  sheets->y = at[1] + p->view.size[1];
  double busy[2 * THR_STEP_VISITS][2];
  const thr_scene *scene = &sheets->crops.scene[p->view.scale];
  for (int i = 0; i < crop->n_now && !st; i++)
    for (int k = 0; k < 2; k++) {
      double corner = k ? shown.y0 : shown.x0;
      busy[2 * i][k] = at[k] + scene->pass[crop->now[i]].from[k] - corner;
      busy[2 * i + 1][k] = at[k] + scene->pass[crop->now[i]].to[k] - corner;
    }
  thr_box picture = {at[0], at[1], at[0] + p->view.size[0], sheets->y};
  if (!st)
    thr_step_put_hub(sheets, p, NULL, crop->colour, picture, (const double(*)[2])busy,
                     2 * crop->n_now);
  if (!st) thr_step_put_legend(sheets, sheets->y + 4, "step");
  sheets->y += THR_STEP_LEGEND;
  if (!st) thr_step_put_strip(sheets, p, NULL, crop->colour);
  return st;
}

static thr_status put_in_space(thr_sheets *sheets, const thr_step *p, const thr_crop *crop,
                               const double room[2], double top, thr_err *err)
{
  thr_box paper = {0, top, sheets->size[0] - THR_SHEET_MARGIN, top + LOCATOR[1]};
  paper.x0 = paper.x1 - LOCATOR[0];
  thr_space_step step = {.crop = *crop, .colour = crop->colour, .next = -1};
  thr_camera_view view = thr_space_fit(&sheets->space, crop, room);
  double at[2] = {THR_SHEET_MARGIN, top + THR_STEP_HEAD};
  if (!thr_step_ends(sheets, p->end - 1)) step.next = sheets->visit[p->end].in;
  thr_status st = thr_space_draw(&sheets->space, &step, &view, at, thr_sheets_out(sheets), err);
  if (!st) st = thr_space_locate(&sheets->space, &step, &view, paper, thr_sheets_out(sheets), err);
  sheets->y = at[1] + view.size[1];
  double busy[2 * THR_STEP_VISITS][2], seen[3];
  for (int i = 0; i < 2 * crop->n_now; i++) {
    int h = thr_space_half(&sheets->space, crop, crop->now[i / 2]);
    thr_camera_project(
        &view, sheets->f->xyz[i % 2 ? thr_head(sheets->f, h) : thr_tail(sheets->f, h)], seen);
    for (int k = 0; k < 2; k++)
      busy[i][k] = at[k] + seen[k];
  }
  thr_box picture = {at[0], at[1], at[0] + view.size[0], sheets->y};
  if (!st)
    thr_step_put_hub(sheets, p, &view.camera, crop->colour, picture, (const double(*)[2])busy,
                     2 * crop->n_now);
  if (!st) thr_step_put_legend(sheets, sheets->y + 4, "step");
  sheets->y += THR_STEP_LEGEND;
  if (!st) thr_step_put_strip(sheets, p, &view.camera, crop->colour);
  return st;
}

/* extra: mm that the picture is higher than it has to be. */
static thr_status put_pictures(thr_sheets *sheets, thr_step *p, double top, double extra,
                               thr_err *err)
{
  int now[THR_STEP_VISITS];
  unsigned char *state = thr_calloc((size_t)sheets->n_passes, sizeof *state);
  unsigned char *piece = thr_calloc((size_t)sheets->pieces.n, sizeof *piece);
  thr_status st = state && piece ? THR_OK : thr_nomem(err);
  for (int i = 0; i < sheets->n_passes && !st; i++)
    state[i] = sheets->visited[i] < p->first ? THR_DRAW_EARLIER
               : sheets->visited[i] < p->end ? THR_DRAW_NOW
                                             : THR_DRAW_HIDDEN;
  for (int i = 0; i < sheets->pieces.n && !st; i++)
    piece[i] = sheets->threaded[i] < p->first ? THR_PIECE_HELD
               : sheets->threaded[i] < p->end ? THR_PIECE_NEW
                                              : THR_PIECE_LATER;
  thr_crop crop = crop_of(sheets, p, now);
  crop.state = state;
  crop.piece = piece;
  double room[2] = {thr_sheets_width(sheets), p->height + extra};
  if (!st && sheets->in_space) st = put_in_space(sheets, p, &crop, room, top, err);
  if (!st && !sheets->in_space) st = put_flat(sheets, p, &crop, room, top, err);
  free(state);
  free(piece);
  return st;
}

/* ---- pages ---- */

static void put_step(thr_sheets *sheets, thr_step *p, double top, double extra)
{
  thr_step_put_heading(sheets, p, top);
  thr_status st = sheets->st ? sheets->st : put_pictures(sheets, p, top, extra, &sheets->why);
  if (st)
    thr_sheets_fail(sheets, st, NULL);
  else
    thr_step_put_rows(sheets, p);
}

/* A rule between two steps. */
static void put_rule(thr_sheets *sheets, double y)
{
  thr_text_printf(thr_sheets_out(sheets),
                  "<path stroke=\"#999\" stroke-width=\"0.20\" d=\"M%.2f %.2fh%.2f\"/>\n",
                  THR_SHEET_MARGIN, y, thr_sheets_width(sheets));
}

void thr_sheets_flush(thr_sheets *sheets)
{
  double high = -BETWEEN, y = THR_SHEET_MARGIN;
  int n = sheets->n_waiting;
  if (!n) return;
  if (!sheets->st) thr_sheets_page(sheets, "", "");
  for (int i = 0; i < n; i++)
    high += BETWEEN + height_beside(&sheets->waiting[i]) + sheets->waiting[i].height;
  double extra = fmax(thr_sheets_bottom(sheets) - THR_SHEET_MARGIN - high, 0) / n;
  for (int i = 0; i < n && !sheets->st; i++) {
    thr_step *p = &sheets->waiting[i];
    if (i) put_rule(sheets, y - 0.5 * BETWEEN);
    put_step(sheets, p, y, extra);
    y += height_beside(p) + p->height + extra + BETWEEN;
  }
  for (int i = 0; i < n; i++)
    thr_step_destroy_text(&sheets->waiting[i]);
  sheets->n_waiting = 0;
}

/* Has the page that is waiting room for another step? */
static bool has_room(const thr_sheets *sheets, const thr_step *step)
{
  double high = height_beside(step) + step->height;
  for (int i = 0; i < sheets->n_waiting; i++)
    high += BETWEEN + height_beside(&sheets->waiting[i]) + sheets->waiting[i].height;
  return high <= thr_sheets_bottom(sheets) - THR_SHEET_MARGIN;
}

/* Before each step: it may be stopped there. */
static void poll(thr_sheets *sheets, int first)
{
  const thr_limits *limits = sheets->limits;
  if (limits->advance)
    limits->advance(limits->user, "pages of the step sheets", (double)first / sheets->n_visits);
  if (thr_limits_stop(limits))
    thr_sheets_fail(sheets,
                    thr_fail(&sheets->why, THR_ELIMIT, "interrupted at page %d of the step sheets",
                             sheets->n_pages + 1),
                    NULL);
}

/* Takes a step on to the page that is waiting. */
static thr_status wait(thr_sheets *sheets, int first, int end, thr_err *err)
{
  thr_step step = {.number = ++sheets->n_steps, .first = first, .end = end};
  for (int i = first; i < end; i++)
    sheets->step[i] = step.number;
  thr_step_find_text(sheets, &step);
  thr_status st = sheets->st ? sheets->st : find_height(sheets, &step, err);
  if (!st && !has_room(sheets, &step)) thr_sheets_flush(sheets);
  if (!st)
    st = thr_grow(&sheets->waiting, sheets->n_waiting, &sheets->waiting_capacity,
                  sizeof *sheets->waiting, err);
  if (st)
    thr_step_destroy_text(&step);
  else
    sheets->waiting[sheets->n_waiting++] = step;
  return st;
}

/* Where the section ends that begins with step i of n: that many steps, of which the last has
 * picked up its share. */
static int steps_of_section(const thr_sheets *sheets, const int *end, int n, int i, int new,
                            int share)
{
  int first = i ? end[i - 1] : sheets->first_visit[sheets->visit[end[0] - 1].cord], steps = 0;
  for (int k = first; i + steps < n; k++) {
    new += sheets->visit[k].nth == 1;
    if (k + 1 < end[i + steps]) continue;
    steps++;
    if (new >= share) break;
  }
  return steps;
}

void thr_sheets_steps(thr_sheets *sheets, int c)
{
  int *end = NULL, n = 0, first = sheets->first_visit[c], next = 0, section = 0, new = 0;
  thr_status st = sheets->st ? sheets->st : thr_step_divide(sheets, c, &end, &n, &sheets->why);
  if (st) thr_sheets_fail(sheets, st, NULL);
  int sections = n ? thr_sheets_sections(sheets, first, end[n - 1]) : 0, all = 0;
  for (int i = first; n && i < end[n - 1]; i++)
    all += sheets->visit[i].nth == 1;
  for (int i = 0; i < n && !sheets->st; first = end[i++]) {
    poll(sheets, first);
    if (!sheets->st && i == next && section < sections) {
      int steps = section + 1 < sections
                      ? steps_of_section(sheets, end, n, i, new, all * (section + 1) / sections)
                      : n - i;
      thr_sheets_section(sheets, ++section, sections, first, end[i + steps - 1], steps);
      next = i + steps;
    }
    for (int k = first; k < end[i]; k++)
      new += sheets->visit[k].nth == 1;
    st = sheets->st ? sheets->st : wait(sheets, first, end[i], &sheets->why);
    if (st) thr_sheets_fail(sheets, st, NULL);
  }
  free(end);
}
