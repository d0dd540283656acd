/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out the steps of a path: some twenty passes each, with a picture of these passes, the string
 * of pieces in the order of threading, and rows to tick off.
 *
 * A page takes as many whole steps as fit. Steps wait in sheets->waiting until the next one does
 * not fit any more; only then is the page drawn, and the height that is left is shared out among
 * the pictures. Where a step ends is chosen in sheets_divide.c; large frameworks have a page with a
 * map before each section (sheets_sections.c).
 *
 * Example: steps of 95, 88 and 80 mm least height on a page of 264 mm with 5 mm between them: the
 * first two fill a page, and each picture becomes 38 mm higher. */
#include "diagram/sheets/sheets_parts.h"

#include <math.h>
#include <stdlib.h>

static const double BETWEEN = 5;           /* mm between two steps of a page */
static const double LOCATOR[2] = {44, 22}; /* mm: width and height of the small picture, at most */
static const double IN_SPACE = 9; /* mm of height that a picture in space has for each visit */
static const double MOST = 110;   /* mm: more height than this no picture in space asks for */

/* Returns the height of a step without its picture, mm. */
static double height_beside(const thr_step *step)
{
  return THR_STEP_HEAD + THR_STEP_LEGEND + thr_step_strip_height(step->end - step->first) +
         thr_step_words_height(step->rows_height, step->lines_before, step->lines_after);
}

/* ---- pictures ---- */

/* Returns what the picture of a step shows. now[THR_STEP_VISITS] receives the passes that are drawn
 * now and must live as long as the result. */
static thr_crop crop_of(const thr_sheets *sheets, const thr_step *step, int *now)
{
  thr_crop crop = {.number = step->number, .now = now, .colour = thr_step_colour(sheets, step)};
  crop.n_now = thr_step_now(sheets, step->first, step->end, now);
  crop.backward = sheets->move[step->first].needle == THR_NEEDLE_LEFT;
  return crop;
}

/* Computes the least height of a step's picture, in mm, into step->height. A flat picture also gets
 * its view: scale and window in which every pass is legible. */
static thr_status find_height(thr_sheets *sheets, thr_step *step, thr_err *err)
{
  int now[THR_STEP_VISITS];
  thr_crop crop = crop_of(sheets, step, now);

  /* The most that a page of its own would leave for the picture. */
  double room[2] = {thr_sheets_width(sheets),
                    thr_sheets_bottom(sheets) - THR_SHEET_MARGIN - height_beside(step)};
  room[1] = fmax(room[1], THR_STEP_PICTURE[1]);

  /* In space any size can be drawn: some mm per visit do. */
  step->height =
      fmin(room[1], fmin(MOST, THR_STEP_PICTURE[1] + IN_SPACE * (step->end - step->first)));
  if (sheets->in_space) return THR_OK;

  /* A flat picture needs the window that its passes take at the largest scale that fits. */
  thr_status st = thr_crop_fit(&sheets->crops, &crop, room, THR_STEP_PICTURE, &step->view, err);
  step->height = step->view.size[1];

  return st;
}

/* Draws the flat picture of a step in room mm below its heading at height top, with the small
 * picture of the whole in the corner, a hub of many arms if there is one, legend and string of
 * pieces. */
static thr_status put_flat(thr_sheets *sheets, thr_step *step, const thr_crop *crop,
                           const double room[2], double top, thr_err *err)
{
  thr_box shown, paper = {0, top, sheets->size[0] - THR_SHEET_MARGIN, top + LOCATOR[1]};
  paper.x0 = paper.x1 - LOCATOR[0];

  /* The window grows into the height that was left over on the page. */
  thr_crop_fill(&sheets->crops, &step->view, room);
  double at[2] = {0.5 * (sheets->size[0] - step->view.size[0]), top + THR_STEP_HEAD};

  thr_status st =
      thr_crop_draw(&sheets->crops, crop, &step->view, at, &shown, thr_sheets_out(sheets), err);
  if (!st) thr_crop_locate(&sheets->crops, crop, &step->view, shown, paper, thr_sheets_out(sheets));
  sheets->y = at[1] + step->view.size[1];

  /* The ends of all passes drawn now, in mm on the page: an inset must not hide them. */
  double busy[2 * THR_STEP_VISITS][2];
  const thr_scene *scene = &sheets->crops.scene[step->view.scale];

  for (int i = 0; i < crop->n_now && !st; i++)
    for (int k = 0; k < 2; k++) {
      double corner = k ? shown.y0 : shown.x0;
      busy[2 * i][k] = at[k] + scene->pass[crop->now[i]].from[k] - corner;
      busy[2 * i + 1][k] = at[k] + scene->pass[crop->now[i]].to[k] - corner;
    }

  /* The inset, if there is one, lies on top of the picture. */
  thr_box picture = {at[0], at[1], at[0] + step->view.size[0], sheets->y};
  if (!st)
    thr_step_put_hub(sheets, step, NULL, crop->colour, picture, (const double(*)[2])busy,
                     2 * crop->n_now);

  if (!st) thr_step_put_legend(sheets, sheets->y + 4, "step");
  sheets->y += THR_STEP_LEGEND;
  if (!st) thr_step_put_strip(sheets, step, NULL, crop->colour);
  return st;
}

/* Draws the picture of a step in space, seen from where its passes are most legible; all else as in
 * put_flat. */
static thr_status put_in_space(thr_sheets *sheets, const thr_step *step, const thr_crop *crop,
                               const double room[2], double top, thr_err *err)
{
  thr_box paper = {0, top, sheets->size[0] - THR_SHEET_MARGIN, top + LOCATOR[1]};
  paper.x0 = paper.x1 - LOCATOR[0];

  thr_space_step drawn = {.crop = *crop, .colour = crop->colour, .next = -1};
  thr_camera_view view = thr_space_fit(&sheets->space, crop, room);
  double at[2] = {THR_SHEET_MARGIN, top + THR_STEP_HEAD};

  /* The needle points on towards the next piece, unless the needle's part ends here. */
  if (!thr_step_ends(sheets, step->end - 1)) drawn.next = sheets->visit[step->end].in;
  thr_status st = thr_space_draw(&sheets->space, &drawn, &view, at, thr_sheets_out(sheets), err);
  if (!st) st = thr_space_locate(&sheets->space, &drawn, &view, paper, thr_sheets_out(sheets), err);

  sheets->y = at[1] + view.size[1];

  /* The ends of all passes drawn now, projected on to the page. */
  double busy[2 * THR_STEP_VISITS][2], seen[3];
  for (int i = 0; i < 2 * crop->n_now; i++) {
    int h = thr_space_half(&sheets->space, crop, crop->now[i / 2]);
    thr_camera_project(
        &view, sheets->f->xyz[i % 2 ? thr_head(sheets->f, h) : thr_tail(sheets->f, h)], seen);
    for (int k = 0; k < 2; k++)
      busy[i][k] = at[k] + seen[k];
  }

  /* The inset, if there is one, lies on top of the picture. */
  thr_box picture = {at[0], at[1], at[0] + view.size[0], sheets->y};
  if (!st)
    thr_step_put_hub(sheets, step, &view.camera, crop->colour, picture, (const double(*)[2])busy,
                     2 * crop->n_now);

  if (!st) thr_step_put_legend(sheets, sheets->y + 4, "step");
  sheets->y += THR_STEP_LEGEND;
  if (!st) thr_step_put_strip(sheets, step, &view.camera, crop->colour);
  return st;
}

/* Draws all pictures of a step whose heading begins at height top. extra: mm that the main picture
 * is higher than necessary. */
static thr_status put_pictures(thr_sheets *sheets, thr_step *step, double top, double extra,
                               thr_err *err)
{
  int now[THR_STEP_VISITS];
  unsigned char *state = thr_calloc((size_t)sheets->n_passes, sizeof *state);
  unsigned char *piece = thr_calloc((size_t)sheets->pieces.n, sizeof *piece);
  thr_status st = state && piece ? THR_OK : thr_nomem(err);

  /* Passes before the step are grey, later ones are not drawn. */
  for (int i = 0; i < sheets->n_passes && !st; i++)
    state[i] = sheets->visited[i] < step->first ? THR_DRAW_EARLIER
               : sheets->visited[i] < step->end ? THR_DRAW_NOW
                                                : THR_DRAW_HIDDEN;

  /* Pieces: on a cord already, picked up in this step, or waiting. */
  for (int i = 0; i < sheets->pieces.n && !st; i++)
    piece[i] = sheets->threaded[i] < step->first ? THR_PIECE_HELD
               : sheets->threaded[i] < step->end ? THR_PIECE_NEW
                                                 : THR_PIECE_LATER;

  thr_crop crop = crop_of(sheets, step, now);
  crop.state = state;
  crop.piece = piece;

  /* In space or flat, the same for all steps of a booklet. */
  double room[2] = {thr_sheets_width(sheets), step->height + extra};
  if (!st && sheets->in_space) st = put_in_space(sheets, step, &crop, room, top, err);
  if (!st && !sheets->in_space) st = put_flat(sheets, step, &crop, room, top, err);

  free(state);
  free(piece);
  return st;
}

/* ---- pages ---- */

/* Draws a whole step at height top. */
static void put_step(thr_sheets *sheets, thr_step *step, double top, double extra)
{
  thr_step_put_heading(sheets, step, top);
  thr_status st = sheets->st ? sheets->st : put_pictures(sheets, step, top, extra, &sheets->why);
  if (st)
    thr_sheets_fail(sheets, st, NULL);
  else
    thr_step_put_rows(sheets, step);
}

/* Draws a thin line between two steps at height y. */
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

  /* The height that all waiting steps need; what the page has beyond is shared equally. */
  for (int i = 0; i < n; i++)
    high += BETWEEN + height_beside(&sheets->waiting[i]) + sheets->waiting[i].height;

  double extra = fmax(thr_sheets_bottom(sheets) - THR_SHEET_MARGIN - high, 0) / n;

  /* One step below the other. */
  for (int i = 0; i < n && !sheets->st; i++) {
    thr_step *step = &sheets->waiting[i];
    if (i) put_rule(sheets, y - 0.5 * BETWEEN);
    put_step(sheets, step, y, extra);
    y += height_beside(step) + step->height + extra + BETWEEN;
  }

  /* The steps are on paper now: their texts are released. */
  for (int i = 0; i < n; i++)
    thr_step_destroy_text(&sheets->waiting[i]);
  sheets->n_waiting = 0;
}

/* Returns whether another step fits on the page that is waiting. */
static bool has_room(const thr_sheets *sheets, const thr_step *step)
{
  double high = height_beside(step) + step->height;

  for (int i = 0; i < sheets->n_waiting; i++)
    high += BETWEEN + height_beside(&sheets->waiting[i]) + sheets->waiting[i].height;

  return high <= thr_sheets_bottom(sheets) - THR_SHEET_MARGIN;
}

/* Tells the caller how far the work is and stops where the caller asks for it; called before each
 * step. */
static void poll(thr_sheets *sheets, int first)
{
  const thr_limits *limits = sheets->limits;

  /* Progress by visits: pages are not counted before. */
  if (limits->advance)
    limits->advance(limits->user, "pages of the step sheets", (double)first / sheets->n_visits);

  if (thr_limits_stop(limits))
    thr_sheets_fail(sheets,
                    thr_fail(&sheets->why, THR_ELIMIT, "interrupted at page %d of the step sheets",
                             sheets->n_pages + 1),
                    NULL);
}

/* Appends the step of visits first .. end - 1 to the page that is waiting. If there is no room for
 * the step, that page is drawn first. */
static thr_status wait(thr_sheets *sheets, int first, int end, thr_err *err)
{
  thr_step step = {.number = ++sheets->n_steps, .first = first, .end = end};

  /* Rows of later steps refer to this number. */
  for (int i = first; i < end; i++)
    sheets->step[i] = step.number;

  thr_step_find_text(sheets, &step);
  thr_status st = sheets->st ? sheets->st : find_height(sheets, &step, err);

  if (!st && !has_room(sheets, &step)) thr_sheets_flush(sheets);
  if (!st)
    st = thr_grow(&sheets->waiting, sheets->n_waiting, &sheets->waiting_capacity,
                  sizeof *sheets->waiting, err);

  /* The page takes over the texts. */
  if (st)
    thr_step_destroy_text(&step);
  else
    sheets->waiting[sheets->n_waiting++] = step;

  return st;
}

/* Returns how many of n steps belong to the section that begins with step i: up to the first step
 * at whose end at least `share` pieces of the path are on the cord. new: pieces picked up before
 * step i. */
static int steps_of_section(const thr_sheets *sheets, const int *end, int n, int i, int new,
                            int share)
{
  int first = i ? end[i - 1] : sheets->first_visit[sheets->visit[end[0] - 1].cord], steps = 0;

  for (int k = first; i + steps < n; k++) {
    new += sheets->visit[k].nth == 1;

    /* Only the end of a step can be the end of a section. */
    if (k + 1 < end[i + steps]) continue;
    steps++;
    if (new >= share) break;
  }

  return steps;
}

void thr_sheets_steps(thr_sheets *sheets, int c)
{
  int *end = NULL, n = 0, first = sheets->first_visit[c];
  int next = 0, section = 0; /* the step before which the next section begins; sections so far */
  int new = 0;               /* pieces picked up so far */
  thr_status st = sheets->st ? sheets->st : thr_step_divide(sheets, c, &end, &n, &sheets->why);
  if (st) thr_sheets_fail(sheets, st, NULL);

  /* Sections share the pieces that this path picks up equally. */
  int sections = n ? thr_sheets_sections(sheets, first, end[n - 1]) : 0, all = 0;
  for (int i = first; n && i < end[n - 1]; i++)
    all += sheets->visit[i].nth == 1;

  for (int i = 0; i < n && !sheets->st; first = end[i++]) {
    poll(sheets, first);

    /* Section s of m ends when s / m of all pieces are threaded; the last one takes all steps
     * left. */
    if (!sheets->st && i == next && section < sections) {
      int steps = section + 1 < sections
                      ? steps_of_section(sheets, end, n, i, new, all * (section + 1) / sections)
                      : n - i;
      thr_sheets_section(sheets, ++section, sections, first, end[i + steps - 1], steps);
      next = i + steps;
    }

    /* Passes of this step go to the page that is waiting. */
    for (int k = first; k < end[i]; k++)
      new += sheets->visit[k].nth == 1;
    st = sheets->st ? sheets->st : wait(sheets, first, end[i], &sheets->why);
    if (st) thr_sheets_fail(sheets, st, NULL);
  }

  free(end);
}
