/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the string of pieces of a step: an icon of each piece in the order of threading, with the
 * way of the cord through it, the number of the pass above and the name below.
 *
 * Each icon shows the arms of the piece as they lie in the step's picture, so that the maker turns
 * the piece in the hand until it looks alike. All icons of a row share a few SVG elements, one per
 * layer: one element per stroke would make the booklet several times larger.
 *
 * Example: 17 visits make two rows of MANY = 12 places, the second with five icons. */
#include "diagram/sheets/sheets_parts.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

/* Icons in a row: FEW large ones if two such rows are enough, else MANY smaller ones. */
enum { FEW = 8, MANY = 12 };
/* mm from a hub to the end of the longest arm, of large and small icons. */
static const double REACH[2] = {6.2, 5};
static const double NAME = 4.2;              /* mm below an icon for its name */
static const double AIR = 1.5;               /* mm above the first row */
static const double ARM = 0.42, CORD = 0.14; /* widths of an arm and of the cord, times the reach */
static const double CROWD = 0.8; /* an arm takes at most this share of its part of the circle */
/* mm that an icon is right of the middle of its place, for a number of up to three, of four
 * digits. */
static const double ASIDE[2] = {1.5, 2.6};
static const double LINE[2] = {0.25, 0.5}; /* mm: outlines of pieces on a cord, and of new ones */
enum { CROWDED = 8 };                      /* a piece of more arms does not make all arms thinner */

/* Returns how many icons a row holds. */
static int columns_of(int visits)
{
  return visits <= 2 * FEW ? FEW : MANY;
}

/* Returns the length of the longest arm of an icon, mm. */
static double reach_of(int visits)
{
  return REACH[columns_of(visits) == MANY];
}

double thr_step_strip_height(int visits)
{
  int columns = columns_of(visits);

  return AIR + (visits + columns - 1) / columns * (2 * reach_of(visits) + NAME);
}

/* Computes the direction of half-edge h on paper, y downwards, in any unit: as the camera sees the
 * edge or, if there is no camera, as the layout draws it. */
static void direction(const thr_known *known, const thr_camera *camera, int h, double vector[2])
{
  const thr_frame *frame = known->f, *paper = thr_layout_paper(&known->guide.layout, frame);

  /* Coordinates along the camera's axes to the right and up. */
  if (camera) {
    const double *tail = frame->xyz[thr_tail(frame, h)], *head = frame->xyz[thr_head(frame, h)];
    double along[3] = {head[0] - tail[0], head[1] - tail[1], head[2] - tail[2]};
    vector[0] = thr_dot(along, camera->right);
    vector[1] = -thr_dot(along, camera->up);
    return;
  }

  /* The layout may cut the framework open: its own frame knows where each end is drawn. */
  const double *tail = known->guide.layout.xy[thr_tail(paper, h)],
               *head = known->guide.layout.xy[thr_head(paper, h)];
  vector[0] = head[0] - tail[0];
  vector[1] = tail[1] - head[1];
}

void thr_step_arms(const thr_known *known, const thr_camera *camera, int v, double reach,
                   thr_arms *arms, int half_in, int half_out, int *in, int *out)
{
  const thr_frame *frame = known->f;
  double longest = 0;
  *in = *out = -1;

  /* All arms at their own lengths; in comes from outside, so the arm is the opposite half-edge. */
  for (int i = frame->first[v]; i < frame->first[v + 1] && arms->n < THR_ARMS; i++) {
    double *vector = arms->end[arms->n];
    direction(known, camera, frame->half[i], vector);
    longest = fmax(longest, hypot(vector[0], vector[1]));
    if (half_in >= 0 && frame->half[i] == (half_in ^ 1)) *in = arms->n;
    if (frame->half[i] == half_out) *out = arms->n;
    arms->n++;
  }

  /* Scale them so that the longest one reaches as far as wanted. */
  for (int i = 0; i < arms->n; i++)
    for (int k = 0; k < 2; k++)
      arms->end[i][k] = arms->hub[k] + (longest > 0 ? reach / longest * arms->end[i][k] : 0);
}

/* Fills the arms of a tube that a needle passes along half-edge half: two from its middle, which
 * lie in one line; none if the tube points at the viewer. */
static void tube_of(const thr_known *known, const thr_camera *camera, int half, double reach,
                    thr_arms *arms, int *in, int *out)
{
  double vector[2];
  direction(known, camera, half, vector);

  /* As long as the reach on both sides, whatever the tube's length is. */
  double length = hypot(vector[0], vector[1]);

  /* The needle comes in behind and goes out in front. */
  for (int k = 0; k < 2 && length > 0; k++) {
    arms->end[0][k] = arms->hub[k] - reach / length * vector[k];
    arms->end[1][k] = arms->hub[k] + reach / length * vector[k];
  }

  arms->n = length > 0 ? 2 : 0;
  *in = arms->n ? 0 : -1;
  *out = arms->n ? 1 : -1;
}

/* The drawing of a row of icons in layers, a single SVG path or group each, from the lowest up. */
typedef struct {
  thr_text piece[2][2]; /* [on a cord, new][outline, fill]: path data of the arms */
  thr_text way;         /* path data of the cord through the pieces */
  thr_text tip;         /* path data of the arrows at which the cord leaves */
  thr_text end;         /* elements: discs where a cord starts or ends */
} icon_layers;

/* Appends the icon of a visit, with its hub at a point of the page, to the layers of its row. */
static void add_icon(const thr_known *known, int visit, const thr_camera *camera,
                     const double hub[2], double reach, icon_layers *row)
{
  const thr_visit *stay = &known->visit[visit];
  bool new = stay->nth == 1;
  int in, out;
  thr_arms arms = {.hub = {hub[0], hub[1]}};

  if (known->pieces.solid)
    thr_step_arms(known, camera, stay->piece, reach, &arms, stay->in, stay->out, &in, &out);
  else
    tube_of(known, camera, stay->in, reach, &arms, &in, &out);

  /* The fill ends before the outline does, by the width of the outline. */
  for (int k = 0; k < 2; k++)
    thr_arms_strokes(&arms, k ? LINE[new] : 0, &row->piece[new][k]);

  /* The cord goes on with an arrow; where it starts or ends a disc marks the hub. */
  thr_arms_way(&arms, in, out, CORD * reach, &row->way);
  if (out >= 0) thr_arms_tip(&arms, out, CORD * reach, &row->tip);
  if (in < 0 || out < 0)
    thr_text_printf(&row->end, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"#111\"/>\n",
                    hub[0], hub[1], 1.1 * CORD * reach);
}

void thr_step_put_path(thr_text *data, const char *fill, const char *stroke, double width,
                       thr_text *text)
{
  if (data->data && !data->failed)
    thr_text_printf(text,
                    "<path fill=\"%s\" stroke-linejoin=\"round\" stroke=\"%s\" "
                    "stroke-width=\"%.2f\" d=\"%s\"/>\n",
                    fill, stroke, width, data->data);

  /* A failure while the data were made is kept. */
  text->failed |= data->failed;
  thr_text_destroy(data);
}

/* Appends all layers from the lowest up and releases them. width: of an arm, mm. */
static void put_layers(icon_layers *row, double width, double reach, const char *colour,
                       thr_text *text)
{
  static const char *const look[2][2] = {{"#857a64", "#d5ccb8"}, {"#5c4600", "#ffdf8c"}};

  /* Outlines below fills, pieces on a cord below new ones. */
  for (int state = 0; state < 2; state++)
    for (int k = 0; k < 2; k++)
      thr_step_put_path(&row->piece[state][k], "none", look[state][k],
                        width + (k ? -1 : 1) * LINE[state], text);

  /* The cord over a white casing, then discs and arrows. */
  thr_text casing = {0};
  if (row->way.data) thr_text_append(&casing, row->way.data);
  thr_step_put_path(&casing, "none", "#ffffff", 1.8 * CORD * reach, text);
  thr_step_put_path(&row->way, "none", colour, CORD * reach, text);

  if (row->end.data) thr_text_append(text, row->end.data);
  text->failed |= row->end.failed;
  thr_text_destroy(&row->end);

  thr_step_put_path(&row->tip, colour, "#ffffff", 0.2, text);
}

/* Returns the width of an arm in mm, narrower where a piece of the step has many arms. */
static double arm_width(const thr_known *known, const thr_step *step, double reach)
{
  int most = 2;

  /* n arms at a distance r from the hub have 2 pi r / n of the circle each. */
  for (int i = step->first; i < step->end && known->pieces.solid; i++) {
    int arms = thr_degree(known->f, known->visit[i].piece);
    if (arms > most && arms <= CROWDED) most = arms;
  }

  return reach * fmin(ARM, CROWD * 2 * THR_PI / most);
}

void thr_step_put_icon(const thr_known *known, int visit, const double hub[2], double reach,
                       const char *colour, thr_text *text)
{
  icon_layers row = {0};

  add_icon(known, visit, NULL, hub, reach, &row);
  put_layers(&row, ARM * reach, reach, colour, text);
}

/* Writes the name of a visit's piece below its icon, centred at x: in bold "X-10 B5", its kind and
 * place, if the piece is picked up; "F5" if the piece is on a cord already. */
static void put_name(thr_flow *flow, const thr_known *known, int visit, double x, double y,
                     double width)
{
  const thr_visit *stay = &known->visit[visit];
  const thr_pieces *pieces = &known->pieces;
  bool new = stay->nth == 1;
  char kind[24] = "", words[128], attributes[96];
  thr_text name = {0};

  thr_pieces_name(pieces, thr_sheets_labels(known), stay->piece, &name);

  /* The kind, if it is one of those that are called by their numbers. */
  if (new && pieces->solid && !thr_pieces_alone(pieces, pieces->kind[stay->piece]))
    thr_pieces_kind_name(pieces, pieces->kind[stay->piece], kind);

  snprintf(words, sizeof words, "%s%s%.90s", kind, *kind ? " " : "", name.data ? name.data : "");
  if (name.failed) thr_nomem(&flow->why);

  /* What does not fit loses first the kind, then everything. */
  if (*kind && thr_scene_text_width(words, THR_SHEET_SMALL) > width)
    snprintf(words, sizeof words, "%.90s", name.data);
  thr_text_destroy(&name);

  /* What is picked up is bold, what is passed through is grey. */
  snprintf(attributes, sizeof attributes, " text-anchor=\"middle\"%s",
           new ? " font-weight=\"bold\"" : " style=\"fill:#444\"");
  if (thr_scene_text_width(words, THR_SHEET_SMALL) <= width)
    thr_svg_text(thr_sheets_out(flow), x, y, THR_SHEET_SMALL, attributes, words);
}

/* Writes the number of the pass by which the needle comes in, "S" where the cord starts, at the
 * upper left of an icon. */
static void put_number(thr_flow *flow, const thr_known *known, int visit, double x, double y)
{
  char count[16] = "S";
  if (known->visit[visit].number) snprintf(count, sizeof count, "%d", known->visit[visit].number);

  thr_svg_text(thr_sheets_out(flow), x, y, THR_SHEET_SMALL, " font-weight=\"bold\"", count);
}

void thr_step_put_strip(thr_flow *flow, const thr_known *known, const thr_step *step,
                        const thr_camera *camera, const char *colour)
{
  int visits = step->end - step->first, columns = columns_of(visits);
  double reach = reach_of(visits), high = 2 * reach + NAME,
         width = thr_sheets_width(flow) / columns;
  const double aside = ASIDE[known->n_passes > 999];

  thr_text *text = thr_sheets_out(flow);

  /* Row by row; y is the height of the hubs. */
  for (int first = 0; first < visits; first += columns) {
    int n = visits - first < columns ? visits - first : columns;
    double y = flow->y + AIR + first / columns * high + reach;

    /* The dashed line from icon to icon shows the order. */
    thr_text_printf(text,
                    "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.50\" "
                    "stroke-dasharray=\"1.00 1.00\" d=\"",
                    colour);
    thr_svg_move(text, (const double[]){THR_SHEET_MARGIN, y});
    thr_svg_line(text, (const double[]){THR_SHEET_MARGIN + n * width, y});
    thr_text_append(text, "\"/>\n");

    /* Icons gather in layers, names are written at once. */
    icon_layers row = {0};
    for (int i = 0; i < n && !flow->why.code; i++) {
      const double hub[2] = {THR_SHEET_MARGIN + (i + 0.5) * width + aside, y};
      add_icon(known, step->first + first + i, camera, hub, reach, &row);
      put_name(flow, known, step->first + first + i, hub[0], y + reach + 3.2, width - 0.5);
    }

    put_layers(&row, arm_width(known, step, reach), reach, colour, text);

    /* Numbers lie above everything. */
    thr_text_printf(text, "<g fill=\"%s\">\n", colour);
    for (int i = 0; i < n; i++)
      put_number(flow, known, step->first + first + i, THR_SHEET_MARGIN + i * width, y - reach + 2);
    thr_text_append(text, "</g>\n");
  }

  flow->y += thr_step_strip_height(visits);
}
