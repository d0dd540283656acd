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

#include <limits.h>
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
static thr_crop crop_of(const thr_known *known, const thr_step *step, int *now)
{
  thr_crop crop = {.number = step->number, .now = now, .colour = thr_step_colour(known, step)};
  crop.n_now = thr_step_now(known, step->first, step->end, now);
  crop.backward = known->move[step->first].needle == THR_NEEDLE_LEFT;
  return crop;
}

/* Computes the least height of a step's picture, in mm, into step->height. A flat picture also gets
 * its view: scale and window in which every pass is legible. */
static void find_height(thr_sheets *sheets, thr_step *step)
{
  thr_flow *flow = &sheets->flow;
  int now[THR_STEP_VISITS];
  thr_crop crop = crop_of(&sheets->known, step, now);

  /* The most that a page of its own would leave for the picture. */
  double room[2] = {thr_sheets_width(flow),
                    thr_sheets_bottom(flow) - THR_SHEET_MARGIN - height_beside(step)};
  room[1] = fmax(room[1], THR_STEP_PICTURE[1]);

  /* In space any size can be drawn: some mm per visit do. */
  step->height =
      fmin(room[1], fmin(MOST, THR_STEP_PICTURE[1] + IN_SPACE * (step->end - step->first)));
  if (sheets->known.in_space || flow->why.code) return;

  /* A flat picture needs the window that its passes take at the largest scale that fits. */
  thr_sheets_fail(
      flow, thr_crop_fit(&sheets->crops, &crop, room, THR_STEP_PICTURE, &step->view, &flow->why));
  step->height = step->view.size[1];
}

/* A picture of a step that is drawn. */
typedef struct {
  double at[2], size[2];               /* mm: its upper left corner; width and height */
  double busy[2 * THR_STEP_VISITS][2]; /* mm on the page: the ends of all passes drawn now, which an
                                          inset must not hide */
  thr_camera_view view;                /* in space */
} step_picture;

/* Draws the flat picture of a step, which grows into a room in mm, with its upper edge at
 * picture->at[1], and the small picture of the whole in the corner. */
static thr_status put_flat(thr_sheets *sheets, thr_step *step, const thr_crop *crop,
                           const double room[2], thr_box corner, step_picture *picture)
{
  thr_flow *flow = &sheets->flow;
  thr_box shown;
  thr_text *text = thr_sheets_out(flow);

  thr_crop_fill(&sheets->crops, &step->view, room);
  picture->at[0] = 0.5 * (flow->size[0] - step->view.size[0]);
  thr_status st =
      thr_crop_draw(&sheets->crops, crop, &step->view, picture->at, &shown, text, &flow->why);
  if (st) return st;
  thr_crop_locate(&sheets->crops, crop, &step->view, shown, corner, text);

  const thr_scene *scene = &sheets->crops.scene[step->view.scale];
  const double origin[2] = {shown.x0, shown.y0};
  for (int k = 0; k < 2; k++) {
    picture->size[k] = step->view.size[k];
    for (int i = 0; i < crop->n_now; i++) {
      const thr_scene_pass *pass = &scene->pass[crop->now[i]];
      picture->busy[2 * i][k] = picture->at[k] + pass->from[k] - origin[k];
      picture->busy[2 * i + 1][k] = picture->at[k] + pass->to[k] - origin[k];
    }
  }
  return THR_OK;
}

/* Draws the picture of a step in space, seen from where its passes are most legible; all else as in
 * put_flat. */
static thr_status put_in_space(thr_sheets *sheets, thr_step *step, const thr_crop *crop,
                               const double room[2], thr_box corner, step_picture *picture)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  thr_text *text = thr_sheets_out(flow);
  thr_space_step drawn = {.crop = *crop, .colour = crop->colour, .next = -1};
  picture->view = thr_space_fit(&sheets->space, crop, room);
  picture->at[0] = THR_SHEET_MARGIN;

  /* The needle points on towards the next piece, unless the needle's part ends here. */
  if (!thr_step_ends(known, step->end - 1)) drawn.next = known->visit[step->end].in;
  thr_status st =
      thr_space_draw(&sheets->space, &drawn, &picture->view, picture->at, text, &flow->why);
  if (!st) st = thr_space_locate(&sheets->space, &drawn, &picture->view, corner, text, &flow->why);

  for (int i = 0; i < 2 * crop->n_now; i++) {
    double seen[3];
    int h = thr_space_half(&sheets->space, crop, crop->now[i / 2]);
    thr_camera_project(&picture->view,
                       known->f->xyz[i % 2 ? thr_head(known->f, h) : thr_tail(known->f, h)], seen);
    for (int k = 0; k < 2; k++) {
      picture->busy[i][k] = picture->at[k] + seen[k];
      picture->size[k] = picture->view.size[k];
    }
  }
  return st;
}

/* Draws all pictures of a step whose heading begins at height top: in space or flat, the same for
 * all steps of a booklet, with a hub of many arms if there is one, legend and string of pieces.
 * extra: mm that the main picture is higher than necessary. */
static void put_pictures(thr_sheets *sheets, thr_step *step, double top, double extra)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  int now[THR_STEP_VISITS];
  unsigned char *piece = thr_sheets_piece_states(flow, known, step->first, step->end);
  unsigned char *state = thr_calloc((size_t)known->n_passes, sizeof *state);
  if (!state) thr_nomem(&flow->why);

  /* Passes before the step are grey, later ones are not drawn. */
  for (int i = 0; i < known->n_passes && state; i++)
    state[i] = known->visited[i] < step->first ? THR_DRAW_EARLIER
               : known->visited[i] < step->end ? THR_DRAW_NOW
                                               : THR_DRAW_HIDDEN;

  thr_crop crop = crop_of(known, step, now);
  crop.state = state;
  crop.piece = piece;

  const double room[2] = {thr_sheets_width(flow), step->height + extra},
               right = flow->size[0] - THR_SHEET_MARGIN;
  const thr_box corner = {right - LOCATOR[0], top, right, top + LOCATOR[1]};
  step_picture picture = {.at = {0, top + THR_STEP_HEAD}};
  if (!flow->why.code)
    thr_sheets_fail(flow, (known->in_space ? put_in_space : put_flat)(sheets, step, &crop, room,
                                                                      corner, &picture));
  free(state);
  free(piece);
  if (flow->why.code) return;

  /* The inset, if there is one, lies on top of the picture. */
  const thr_camera *camera = known->in_space ? &picture.view.camera : NULL;
  flow->y = picture.at[1] + picture.size[1];
  const thr_box frame = {picture.at[0], picture.at[1], picture.at[0] + picture.size[0], flow->y};
  thr_step_put_hub(flow, known, step, camera, crop.colour, frame, (const double(*)[2])picture.busy,
                   2 * crop.n_now);

  thr_step_put_legend(flow, flow->y + 4, "step");
  flow->y += THR_STEP_LEGEND;
  thr_step_put_strip(flow, known, step, camera, crop.colour);
}

/* ---- pages ---- */

/* Draws a whole step at height top. */
static void put_step(thr_sheets *sheets, thr_step *step, double top, double extra)
{
  thr_flow *flow = &sheets->flow;
  thr_step_put_heading(flow, &sheets->known, step, top);
  put_pictures(sheets, step, top, extra);
  if (!flow->why.code) thr_step_put_rows(flow, &sheets->known, step);
}

/* Draws a thin line between two steps at height y. */
static void put_rule(thr_flow *flow, double y)
{
  thr_text_printf(thr_sheets_out(flow),
                  "<path stroke=\"#999\" stroke-width=\"0.20\" d=\"M%.2f %.2fh%.2f\"/>\n",
                  THR_SHEET_MARGIN, y, thr_sheets_width(flow));
}

/* Returns the height of the steps that wait for a page, with BETWEEN after each, mm. */
static double height_waiting(const thr_sheets *sheets)
{
  double high = 0;
  for (int i = 0; i < sheets->n_waiting; i++)
    high += height_beside(&sheets->waiting[i]) + sheets->waiting[i].height + BETWEEN;
  return high;
}

void thr_sheets_flush(thr_sheets *sheets)
{
  thr_flow *flow = &sheets->flow;
  const double room = thr_sheets_bottom(flow) - THR_SHEET_MARGIN;
  double y = THR_SHEET_MARGIN;
  int n = sheets->n_waiting;
  if (!n) return;
  if (!flow->why.code) thr_sheets_page(flow, "", "");

  /* What the page has beyond the height that all waiting steps need is shared equally. */
  double extra = fmax(room - (height_waiting(sheets) - BETWEEN), 0) / n;

  /* One step below the other; their texts are released when they are on paper. */
  for (int i = 0; i < n; i++) {
    thr_step *step = &sheets->waiting[i];
    if (i && !flow->why.code) put_rule(flow, y - 0.5 * BETWEEN);
    if (!flow->why.code) put_step(sheets, step, y, extra);
    y += height_beside(step) + step->height + extra + BETWEEN;
    thr_step_destroy_text(step);
  }
  sheets->n_waiting = 0;
}

/* Tells the caller how far the work is and stops where the caller asks for it; called before each
 * step. */
static void poll(thr_flow *flow, const thr_known *known, int first)
{
  const thr_limits *limits = flow->limits;

  /* Progress by visits: pages are not counted before. */
  if (limits->advance)
    limits->advance(limits->user, "pages of the step sheets", (double)first / known->n_visits);

  if (thr_limits_stop(limits))
    thr_fail(&flow->why, THR_ELIMIT, "interrupted at page %d of the step sheets",
             flow->n_pages + 1);
}

/* Appends the step of visits first .. end - 1 to the page that is waiting. If there is no room for
 * the step, that page is drawn first. */
static void wait(thr_sheets *sheets, int first, int end)
{
  thr_flow *flow = &sheets->flow;
  thr_step step = {.number = ++sheets->n_steps, .first = first, .end = end};

  /* Rows of later steps refer to this number. */
  for (int i = first; i < end; i++)
    sheets->step[i] = step.number;

  thr_step_find_text(sheets, &step);
  find_height(sheets, &step);
  if (height_waiting(sheets) + height_beside(&step) + step.height >
      thr_sheets_bottom(flow) - THR_SHEET_MARGIN)
    thr_sheets_flush(sheets);
  thr_sheets_fail(flow, thr_grow(&sheets->waiting, sheets->n_waiting, &sheets->waiting_capacity,
                                 sizeof *sheets->waiting, &flow->why));

  /* The page takes over the texts. */
  if (flow->why.code)
    thr_step_destroy_text(&step);
  else
    sheets->waiting[sheets->n_waiting++] = step;
}

void thr_sheets_steps(thr_sheets *sheets, int c)
{
  const thr_known *known = &sheets->known;
  thr_flow *flow = &sheets->flow;
  int *end = NULL, n = 0;
  const int begin = known->first_visit[c];

  if (flow->why.code) return;
  thr_sheets_fail(flow, thr_step_divide(sheets, c, &end, &n, &flow->why));

  /* Sections share the pieces that this path picks up equally: section s of m ends with the step at
   * whose end s / m of them are threaded; the last one takes all steps left. */
  const int sections = n ? thr_sheets_sections(known, begin, end[n - 1]) : 0,
            all = n ? thr_sheets_count_new(known, begin, end[n - 1]) : 0;

  /* next: the step before which the next section begins. */
  for (int i = 0, first = begin, next = 0, section = 0; i < n && !flow->why.code;
       first = end[i++]) {
    poll(flow, known, first);

    if (i == next && section < sections && !flow->why.code) {
      const int share = ++section < sections ? all * section / sections : INT_MAX;
      for (next = i + 1; next < n; next++)
        if (thr_sheets_count_new(known, begin, end[next - 1]) >= share) break;
      thr_sheets_section(sheets, section, sections, first, end[next - 1], next - i);
    }

    if (!flow->why.code) wait(sheets, first, end[i]);
  }

  free(end);
}
