/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The string of pieces of a step: an icon each, in the order of threading. */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"
#include "graph/angle.h"
#include "graph/vector.h"

#include <math.h>
#include <stdio.h>

enum { FEW = 8, MANY = 12 }; /* icons in a row: of up to two rows of few, else of many */
static const double REACH[2] = {6.2, 5}; /* mm from a hub to the longest arm's end, in such rows */
static const double NAME = 4.2, AIR = 1.5; /* mm below an icon for its name; above the first row */
static const double ARM = 0.42, CORD = 0.14; /* widths, of the reach */
static const double CROWD = 0.8;             /* of the room between many arms that one takes */
static const double ASIDE[2] = {
    1.5, 2.6}; /* mm that an icon is off the middle of its place, for its number; of four digits */
static const double LINE[2] = {0.25, 0.5}; /* mm: outlines of pieces held and new */
enum { CROWDED = 8 };                      /* arms: more run together */

static int columns_of(int visits)
{
  return visits <= 2 * FEW ? FEW : MANY;
}

static double reach_of(int visits)
{
  return REACH[columns_of(visits) == MANY];
}

double thr_step_strip_height(int visits)
{
  int columns = columns_of(visits);
  return AIR + (visits + columns - 1) / columns * (2 * reach_of(visits) + NAME);
}

/* A half-edge on paper, in any unit: from the layout, or as a camera sees it. */
static void direction(const thr_sheets *sheets, const thr_camera *camera, int h, double d[2])
{
  const thr_frame *f = sheets->f, *paper = thr_layout_paper(&sheets->guide.layout, f);
  if (camera) {
    const double *a = f->xyz[thr_tail(f, h)], *b = f->xyz[thr_head(f, h)];
    double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    d[0] = thr_dot(along, camera->right);
    d[1] = -thr_dot(along, camera->up);
    return;
  }
  const double *a = sheets->guide.layout.xy[thr_tail(paper, h)],
               *b = sheets->guide.layout.xy[thr_head(paper, h)];
  d[0] = b[0] - a[0];
  d[1] = a[1] - b[1];
}

void thr_step_arms(const thr_sheets *sheets, const thr_camera *camera, int v, double reach,
                   thr_arms *arms, int half_in, int half_out, int *in, int *out)
{
  const thr_frame *f = sheets->f;
  double longest = 0;
  *in = *out = -1;
  for (int i = f->first[v]; i < f->first[v + 1] && arms->n < THR_ARMS; i++) {
    double *d = arms->end[arms->n];
    direction(sheets, camera, f->half[i], d);
    longest = fmax(longest, hypot(d[0], d[1]));
    if (half_in >= 0 && f->half[i] == (half_in ^ 1)) *in = arms->n;
    if (f->half[i] == half_out) *out = arms->n;
    arms->n++;
  }
  for (int i = 0; i < arms->n; i++)
    for (int k = 0; k < 2; k++)
      arms->end[i][k] = arms->hub[k] + (longest > 0 ? reach / longest * arms->end[i][k] : 0);
}

/* A tube: two arms from its middle. */
static void tube_of(const thr_sheets *sheets, const thr_camera *camera, int half, double reach,
                    thr_arms *arms, int *in, int *out)
{
  double d[2];
  direction(sheets, camera, half, d);
  double length = hypot(d[0], d[1]);
  for (int k = 0; k < 2 && length > 0; k++) {
    arms->end[0][k] = arms->hub[k] - reach / length * d[k];
    arms->end[1][k] = arms->hub[k] + reach / length * d[k];
  }
  arms->n = length > 0 ? 2 : 0;
  *in = arms->n ? 0 : -1;
  *out = arms->n ? 1 : -1;
}

/* What lies on what, in few elements for all icons: outlines and fills of pieces, held and new; the
 * cord. */
typedef struct {
  thr_text piece[2][2], way, tip, end;
} layers;

static void add_icon(const thr_sheets *sheets, int visit, const thr_camera *camera,
                     const double hub[2], double reach, layers *l)
{
  const thr_visit *v = &sheets->visit[visit];
  bool new = v->nth == 1;
  int in, out;
  thr_arms arms = {.hub = {hub[0], hub[1]}};
  if (sheets->pieces.solid)
    thr_step_arms(sheets, camera, v->piece, reach, &arms, v->in, v->out, &in, &out);
  else
    tube_of(sheets, camera, v->in, reach, &arms, &in, &out);
  for (int k = 0; k < 2; k++)
    thr_arms_strokes(&arms, k ? LINE[new] : 0, &l->piece[new][k]);
  thr_arms_way(&arms, in, out, CORD * reach, &l->way);
  if (out >= 0) thr_arms_tip(&arms, out, CORD * reach, &l->tip);
  if (in < 0 || out < 0)
    thr_text_printf(&l->end, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"#111\"/>\n", hub[0],
                    hub[1], 1.1 * CORD * reach);
}

static void put_path(thr_text *data, const char *fill, const char *stroke, double width,
                     thr_text *text)
{
  if (data->data && !data->failed)
    thr_text_printf(text,
                    "<path fill=\"%s\" stroke-linejoin=\"round\" stroke=\"%s\" "
                    "stroke-width=\"%.2f\" d=\"%s\"/>\n",
                    fill, stroke, width, data->data);
  text->failed |= data->failed;
  thr_text_destroy(data);
}

/* width: of an arm. */
static void put_layers(layers *l, double width, double reach, const char *colour, thr_text *text)
{
  static const char *const look[2][2] = {{"#857a64", "#d5ccb8"}, {"#5c4600", "#ffdf8c"}};
  for (int new = 0; new < 2; new ++)
    for (int k = 0; k < 2; k++)
      put_path(&l->piece[new][k], "none", look[new][k], width + (k ? -1 : 1) * LINE[new], text);
  thr_text casing = {0};
  if (l->way.data) thr_text_append(&casing, l->way.data);
  put_path(&casing, "none", "#ffffff", 1.8 * CORD * reach, text);
  put_path(&l->way, "none", colour, CORD * reach, text);
  if (l->end.data) thr_text_append(text, l->end.data);
  text->failed |= l->end.failed;
  thr_text_destroy(&l->end);
  put_path(&l->tip, colour, "#ffffff", 0.2, text);
}

/* Arms are narrower where a piece has many. */
static double arm_width(const thr_sheets *sheets, const thr_step *step, double reach)
{
  int most = 2;
  for (int i = step->first; i < step->end && sheets->pieces.solid; i++) {
    int arms = thr_degree(sheets->f, sheets->visit[i].piece);
    if (arms > most && arms <= CROWDED) most = arms;
  }
  return reach * fmin(ARM, CROWD * 2 * THR_PI / most);
}

/* "X-10 B5" in bold letters of what is picked up, "F5" of what is on a cord already. */
static void put_name(thr_sheets *sheets, int visit, double x, double y, double width)
{
  const thr_visit *v = &sheets->visit[visit];
  const thr_pieces *pieces = &sheets->pieces;
  bool new = v->nth == 1;
  char kind[24] = "", words[128], attributes[96];
  thr_text name = {0};
  thr_pieces_name(pieces, thr_sheets_labels(sheets), v->piece, &name);
  if (new && pieces->solid && pieces->members[pieces->kind[v->piece]] > 1)
    thr_pieces_kind_name(pieces, pieces->kind[v->piece], kind);
  snprintf(words, sizeof words, "%s%s%.90s", kind, *kind ? " " : "", name.data ? name.data : "");
  if (name.failed) thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  if (*kind && thr_scene_text_width(words, THR_SHEET_SMALL) > width)
    snprintf(words, sizeof words, "%.90s", name.data);
  thr_text_destroy(&name);
  snprintf(attributes, sizeof attributes, " text-anchor=\"middle\"%s",
           new ? " font-weight=\"bold\"" : " style=\"fill:#444\"");
  if (thr_scene_text_width(words, THR_SHEET_SMALL) <= width)
    thr_svg_text(thr_sheets_out(sheets), x, y, THR_SHEET_SMALL, attributes, words);
}

/* Of the pass by which the needle comes in, above the icon. */
static void put_number(thr_sheets *sheets, int visit, double x, double y)
{
  char count[16] = "S";
  if (sheets->visit[visit].number) snprintf(count, sizeof count, "%d", sheets->visit[visit].number);
  thr_svg_text(thr_sheets_out(sheets), x, y, THR_SHEET_SMALL, " font-weight=\"bold\"", count);
}

void thr_step_put_strip(thr_sheets *sheets, const thr_step *step, const thr_camera *camera,
                        const char *colour)
{
  int visits = step->end - step->first, columns = columns_of(visits);
  double reach = reach_of(visits), high = 2 * reach + NAME,
         width = thr_sheets_width(sheets) / columns;
  const double aside = ASIDE[sheets->n_passes > 999];
  thr_text *text = thr_sheets_out(sheets);
  for (int first = 0; first < visits; first += columns) {
    int n = visits - first < columns ? visits - first : columns;
    double y = sheets->y + AIR + first / columns * high + reach;
    thr_text_printf(text,
                    "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.50\" "
                    "stroke-dasharray=\"1.00 1.00\" d=\"",
                    colour);
    thr_svg_move(text, (const double[]){THR_SHEET_MARGIN, y});
    thr_svg_line(text, (const double[]){THR_SHEET_MARGIN + n * width, y});
    thr_text_append(text, "\"/>\n");
    layers l = {0};
    for (int i = 0; i < n && !sheets->st; i++) {
      const double hub[2] = {THR_SHEET_MARGIN + (i + 0.5) * width + aside, y};
      add_icon(sheets, step->first + first + i, camera, hub, reach, &l);
      put_name(sheets, step->first + first + i, hub[0], y + reach + 3.2, width - 0.5);
    }
    put_layers(&l, arm_width(sheets, step, reach), reach, colour, text);
    thr_text_printf(text, "<g fill=\"%s\">\n", colour);
    for (int i = 0; i < n; i++)
      put_number(sheets, step->first + first + i, THR_SHEET_MARGIN + i * width, y - reach + 2);
    thr_text_append(text, "</g>\n");
  }
  sheets->y += thr_step_strip_height(visits);
}
