#include "diagram/overview/crop.h"

#include "diagram/overview/svg.h"
#include "diagram/scene/outlines.h"
#include "graph/framework/frame.h"

#include <math.h>
#include <stdio.h>

static const double PITCH[THR_CROP_SCALES] = {40,   35, 31, 28, 25.5, 23, 21, 19, 17.5, 16,
                                              14.5, 13, 12, 11, 9.5,  8,  6,  4,  2,    1}; /* mm */
static const double RING = 0.85; /* pitches of context around what is drawn now */
static const double EDGE = 1;    /* mm of white around the whole */
static const double BETWEEN = 4; /* mm between two windows */
enum { BASE = 6 };               /* scale at which sizes are asked for first */

static void box_point(thr_box *box, const double at[2])
{
  thr_box_extend(box, (thr_box){at[0], at[1], at[0], at[1]});
}

void thr_crops_make(thr_crops *crops, const thr_plan *plan, const thr_layout *layout)
{
  thr_box all = {layout->xy[0][0], layout->xy[0][1], layout->xy[0][0], layout->xy[0][1]};
  for (int v = 1; v < layout->n_points; v++)
    box_point(&all, layout->xy[v]);
  *crops =
      (thr_crops){.plan = plan, .layout = layout, .slender = (all.y1 - all.y0) / fmax(all.x1 - all.x0, 1e-6 * (all.y1 - all.y0))};
}

void thr_crops_destroy(thr_crops *crops)
{
  for (int i = 0; i < THR_CROP_SCALES; i++)
    if (crops->made[i]) thr_scene_destroy(&crops->scene[i]);
  *crops = (thr_crops){0};
}

static thr_status make_scene(thr_crops *crops, int i, thr_err *err)
{
  thr_status st = crops->made[i] ? THR_OK : thr_scene_build(&crops->scene[i], crops->plan, crops->layout, PITCH[i], true, err);
  if (!st) crops->made[i] = true;
  return st;
}

/* ---- what is seen ---- */

int thr_crop_panel(const thr_scene *scene, int i)
{
  const thr_layout *layout = scene->layout;
  if (!layout->node) return 0;
  const thr_scene_pass *pass = &scene->pass[i];
  return 0.5 * (pass->from[0] + pass->to[0]) >
         (0.5 * (layout->middle[0][0] + layout->middle[1][0]) - scene->origin[0]) * scene->scale;
}

static void box_mark(thr_box *box, const thr_mark *mark)
{
  const double edge = 0.8;
  if (mark) thr_box_extend(box, thr_box_around(mark->at[0], mark->at[1], mark->half[0] + edge, mark->half[1] + edge));
}

/* Of the passes drawn now in a panel, with their turns and marks and a ring of context as far as there is any; false if there are
 * none. */
static bool box_of_view(const thr_scene *scene, const thr_crop *crop, int panel, thr_box *box)
{
  const double ring = RING * scene->size.pitch;
  const thr_box all = scene->extent;
  bool any = false;
  for (int k = 0; k < crop->n_now; k++) {
    int i = crop->now[k];
    const thr_scene_pass *pass = &scene->pass[i];
    if (thr_crop_panel(scene, i) != panel) continue;
    if (!any) *box = (thr_box){pass->from[0], pass->from[1], pass->from[0], pass->from[1]};
    any = true;
    box_point(box, pass->from);
    box_point(box, pass->to);
    box_point(box, thr_scene_turn_start(scene, i));
    box_mark(box, thr_scene_mark_before(scene, i));
    box_mark(box, thr_scene_mark_after(scene, i));
  }
  if (any)
    *box = (thr_box){fmax(box->x0 - ring, all.x0 - EDGE), fmax(box->y0 - ring, all.y0 - EDGE),
                     fmin(box->x1 + ring, all.x1 + EDGE), fmin(box->y1 + ring, all.y1 + EDGE)};
  return any;
}

/* Where a view as long as room, of something from low to high, begins so that it shows from .. to and little beyond the rest. */
static double slide(double from, double to, double room, double low, double high)
{
  double start = 0.5 * (from + to - room);
  if (high - low <= room) return 0.5 * (low + high - room);
  return fmin(fmax(start, low), high - room);
}

static thr_box window_of(const thr_scene *scene, const thr_crop *crop, const thr_crop_view *view, int k)
{
  thr_box box = {0}, all = scene->extent;
  double width = view->window[k][0], height = view->window[k][1];
  box_of_view(scene, crop, view->panel[k], &box);
  double x = slide(box.x0, box.x1, width, all.x0 - EDGE, all.x1 + EDGE),
         y = slide(box.y0, box.y1, height, all.y0 - EDGE, all.y1 + EDGE);
  return (thr_box){x, y, x + width, y + height};
}

/* What windows of these sizes in pitches take up at a pitch, side by side or above each other. Returns whether that fits. */
static bool arrange(thr_crop_view *crop_view, double (*pitches)[2], double pitch, const double room[2], const double least[2],
                    bool stacked)
{
  crop_view->stacked = stacked;
  crop_view->size[0] = crop_view->size[1] = 0;
  for (int k = 0; k < crop_view->n_windows; k++)
    for (int i = 0; i < 2; i++) {
      double wanted = fmax(pitches[k][i] * pitch, least[i]), already = k ? crop_view->size[i] + BETWEEN : 0;
      crop_view->window[k][i] =
          fmax(pitches[k][i] * pitch, fmin(wanted, (room[i] - BETWEEN * (crop_view->n_windows - 1)) / crop_view->n_windows));
      crop_view->size[i] = i == stacked ? already + crop_view->window[k][i] : fmax(crop_view->size[i], crop_view->window[k][i]);
    }
  return crop_view->size[0] <= room[0] && crop_view->size[1] <= room[1];
}

thr_status thr_crop_fit(thr_crops *crops, const thr_crop *crop, const double room[2], const double least[2],
                        thr_crop_view *crop_view, thr_err *err)
{
  double pitches[2][2];
  thr_status st = make_scene(crops, BASE, err);
  *crop_view = (thr_crop_view){.scale = 0};
  if (st) return st;
  for (int panel = 0; panel < 2; panel++) {
    thr_box box;
    if (!box_of_view(&crops->scene[BASE], crop, panel, &box)) continue;
    crop_view->panel[crop_view->n_windows] = panel;
    pitches[crop_view->n_windows][0] = (box.x1 - box.x0) / PITCH[BASE];
    pitches[crop_view->n_windows++][1] = (box.y1 - box.y0) / PITCH[BASE];
  }
  while (crop_view->scale < THR_CROP_SCALES && !arrange(crop_view, pitches, PITCH[crop_view->scale], room, least, false) &&
         !(crop_view->n_windows > 1 && arrange(crop_view, pitches, PITCH[crop_view->scale], room, least, true)))
    crop_view->scale++;
  return THR_OK;
}

/* ---- pictures ---- */

static void put_frame(thr_box at, const char *colour, double width, thr_text *text)
{
  thr_text_printf(
      text, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\"/>\n",
      at.x0, at.y0, at.x1 - at.x0, at.y1 - at.y0, colour, width);
}

thr_status thr_crop_draw(thr_crops *crops, const thr_crop *crop, const thr_crop_view *view, const double at[2], thr_box shown[2],
                         thr_text *text, thr_err *err)
{
  thr_scene *scene = &crops->scene[view->scale];
  thr_status st = make_scene(crops, view->scale, err);
  char scope[32];
  snprintf(scope, sizeof scope, "view-%d", crop->number);
  if (!st) thr_draw_css(scene, scope, text);
  thr_text_printf(text, "<g class=\"%s\">\n", scope);
  double corner[2] = {at[0], at[1]};
  for (int k = 0; k < view->n_windows && !st; k++) {
    shown[k] = window_of(scene, crop, view, k);
    if ((st = thr_crop_label(scene, crop, view->panel[k], shown[k], err))) break;
    thr_box paper = {corner[0], corner[1], corner[0] + view->window[k][0], corner[1] + view->window[k][1]};
    thr_draw_style style = {.state = crop->state, .window = &shown[k], .anonymous = true, .no_pieces = true};
    thr_text_printf(text, "<clipPath id=\"%s-%d\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/></clipPath>\n",
                    scope, k, paper.x0, paper.y0, paper.x1 - paper.x0, paper.y1 - paper.y0);
    thr_text_printf(text, "<g clip-path=\"url(#%s-%d)\"><g transform=\"translate(%.2f %.2f)\">\n", scope, k,
                    thr_svg_round(paper.x0 - shown[k].x0), thr_svg_round(paper.y0 - shown[k].y0));
    thr_draw_feet(scene, &style, text);
    st = thr_crop_pieces(scene, crop->piece, &shown[k], text, err);
    thr_draw_scene(scene, &style, NULL, text);
    thr_text_append(text, "</g></g>\n");
    put_frame(paper, "#999", 0.25, text);
    corner[view->stacked] += view->window[k][view->stacked] + BETWEEN;
  }
  thr_text_append(text, "</g>\n");
  return st;
}

/* How far the piece at a point reaches from its hub, mm. */
static double reach_of(const thr_scene *scene, int point)
{
  thr_box box = thr_outline_box(scene, point);
  return 0.5 * (box.x1 - box.x0);
}

thr_status thr_crop_piece(thr_crops *crops, int node, const double at[2], double room, const thr_scene **scene, int *point,
                          thr_text *text, thr_err *err)
{
  thr_text data = {0};
  thr_status st = make_scene(crops, BASE, err);
  if (st) return st;
  int twin = crops->scene[BASE].twin[node], i = 0;
  const thr_frame *paper = crops->scene[BASE].paper;
  *point = twin >= 0 && thr_degree(paper, twin) > thr_degree(paper, node) ? twin : node;
  double pitches = reach_of(&crops->scene[BASE], *point) / PITCH[BASE];
  while (i < THR_CROP_SCALES - 1 && pitches * PITCH[i] > room)
    i++;
  if ((st = make_scene(crops, i, err))) return st;
  *scene = &crops->scene[i];
  thr_outline_solid(*scene, *point, &data);
  thr_text_printf(text, "<g transform=\"translate(%.2f %.2f)\">", thr_svg_round(at[0] - (*scene)->at[*point][0]),
                  thr_svg_round(at[1] - (*scene)->at[*point][1]));
  if (data.data && !data.failed) thr_draw_outlines(*scene, THR_PIECE_NEW, data.data, text);
  thr_text_append(text, "</g>\n");
  if (data.failed) st = thr_nomem(err);
  thr_text_destroy(&data);
  return st;
}

/* A line for every edge, or for the passes drawn now; passes that follow each other are one line. */
static void put_lines(const thr_scene *scene, const thr_crop *crop, bool now, const double map[3], thr_text *text)
{
  int last = -1;
  for (int k = 0; k < (now ? crop->n_now : scene->n_passes); k++) {
    int i = !now ? k : crop->now[crop->backward ? crop->n_now - 1 - k : k];
    int h = scene->pass[i].half, from = thr_tail(scene->paper, h), to = thr_head(scene->paper, h);
    if (!now && scene->pass[i].lane != 0) continue;
    if (from != last)
      thr_svg_move(text, (const double[]){map[0] * scene->at[from][0] + map[1], map[0] * scene->at[from][1] + map[2]});
    thr_svg_line(text, (const double[]){map[0] * scene->at[to][0] + map[1], map[0] * scene->at[to][1] + map[2]});
    last = to;
  }
}

void thr_crop_locate(const thr_crops *crops, const thr_crop *crop, const thr_crop_view *view, const thr_box shown[2],
                     thr_box paper, thr_text *text)
{
  const thr_scene *scene = &crops->scene[view->scale];
  const thr_box all = scene->extent;
  double k = fmin((paper.x1 - paper.x0) / (all.x1 - all.x0), (paper.y1 - paper.y0) / (all.y1 - all.y0));
  const double map[3] = {k, paper.x1 - k * all.x1, paper.y0 - k * all.y0}, out = 1;
  char colour[8];
  thr_scene_colour(scene, crop->now[0], colour);
  for (int now = 0; now < 2; now++) {
    thr_text_printf(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%s\" d=\"", now ? colour : "#bbb",
                    now ? "0.60" : "0.20");
    put_lines(scene, crop, now, map, text);
    thr_text_append(text, "\"/>\n");
  }
  for (int i = 0; i < view->n_windows; i++) {
    thr_box frame = {fmax(k * shown[i].x0 + map[1], paper.x0 - out), fmax(k * shown[i].y0 + map[2], paper.y0 - out),
                     fmin(k * shown[i].x1 + map[1], paper.x1 + out), fmin(k * shown[i].y1 + map[2], paper.y1 + out)};
    put_frame(frame, "#D55E00", 0.5, text);
  }
}

thr_status thr_crop_whole(const thr_plan *plan, const thr_layout *layout, const unsigned char *state, thr_box paper,
                          const thr_limits *limits, thr_text *text, thr_err *err)
{
  enum { ATTEMPTS = 8 };
  thr_scene scene = {0};
  thr_status st = THR_OK;
  double room[2] = {paper.x1 - paper.x0, paper.y1 - paper.y0}, pitch = PITCH[0], over = 2;
  for (int i = 0; i < ATTEMPTS && over > 1; i++) {
    thr_scene_destroy(&scene);
    if (thr_limits_stop(limits)) return thr_fail(err, THR_ELIMIT, "interrupted at a picture of the whole");
    if ((st = thr_scene_build(&scene, plan, layout, pitch, true, err))) return st;
    double border = scene.places.n_columns ? 18 : 0; /* letters and numbers of places, on both sides */
    over =
        fmax((scene.extent.x1 - scene.extent.x0) / (room[0] - border), (scene.extent.y1 - scene.extent.y0) / (room[1] - border));
    pitch *= over > 1 ? 0.98 / over : 1;
  }
  double x = 0.5 * (paper.x0 + paper.x1 - scene.extent.x0 - scene.extent.x1),
         y = 0.5 * (paper.y0 + paper.y1 - scene.extent.y0 - scene.extent.y1);
  thr_draw_style style = {.state = state, .anonymous = true, .no_pieces = true};
  thr_draw_css(&scene, "thread", text);
  thr_text_printf(text, "<g transform=\"translate(%.2f %.2f)\">\n", thr_svg_round(x), thr_svg_round(y));
  thr_draw_feet(&scene, &style, text);
  st = thr_crop_pieces(&scene, NULL, &scene.extent, text, err);
  thr_draw_scene(&scene, &style, &scene.extent, text);
  thr_text_append(text, "</g>\n");
  thr_scene_destroy(&scene);
  return st;
}
