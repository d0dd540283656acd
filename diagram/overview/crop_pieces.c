/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the pieces in a window of a scene, all that look alike in one element.
 *
 * A document with an element per piece takes readers ten times as long. So pieces in the same
 * state, and tubes of the same width too, share one path: solid pieces as closed outlines, tubes as
 * thick lines with round ends.
 *
 * Example: 40 plain tubes of 3.1 mm and 2 new ones are 2 x 2 elements, since each tube is drawn as
 * a wide line and a narrower one on it. */
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"

#include <math.h>
#include <stdlib.h>

/* Appends path data as an element in the look of a state: tubes if width > 0, mm, else outlines.
 * Destroys data. */
static void put_path(const thr_scene *scene, thr_piece_state state, double width, thr_text *data,
                     thr_text *text)
{
  if (data->failed) text->failed = true;
  if (data->data && !data->failed && width > 0)
    thr_draw_capsules(scene, width, state, data->data, text);
  else if (data->data && !data->failed)
    thr_draw_outlines(scene, state, data->data, text);
  thr_text_destroy(data);
}

/* ---- solid pieces: outlines ---- */

/* Appends the outlines of all solid pieces of one state that touch the window. */
static void put_solid(const thr_scene *scene, const unsigned char *state, thr_piece_state wanted,
                      const thr_box *window, thr_text *text)
{
  /* Points, not nodes: a node with two points has arms on both panels. */
  thr_text data = {0};
  for (int point = 0; point < scene->layout->n_points; point++) {
    int v = thr_layout_node(scene->layout, point);
    if ((state ? state[v] : THR_PIECE_PLAIN) == wanted &&
        thr_box_touch(thr_outline_box(scene, point), *window))
      thr_outline_solid(scene, point, &data);
  }

  put_path(scene, wanted, 0, &data, text);
}

/* ---- tubes: thick lines with round ends ---- */

/* A tube and what decides whether others look like it. */
typedef struct {
  int width; /* in tenths of a mm */
  thr_piece_state state;
  int edge;
  double end[2][2]; /* middles of its round ends, mm */
} tube_look;

/* Compares two tubes for qsort by state, width and edge. Later states lie on earlier ones. */
static int by_look(const void *a, const void *b)
{
  const tube_look *first = a, *second = b;
  if (first->state != second->state) return first->state < second->state ? -1 : 1;
  return first->width != second->width ? first->width - second->width : first->edge - second->edge;
}

/* Returns the tube of an edge. Widths are rounded to tenths of a mm, so that few differ. */
static tube_look capsule_of(const thr_scene *scene, int e, thr_piece_state state)
{
  tube_look tube = {
      .width = (int)fmax(nearbyint(10 * scene->bead[e]), 1), .state = state, .edge = e};
  thr_outline_tube(scene, e, 0.1 * tube.width, tube.end);
  return tube;
}

/* Returns whether any of a tube is in a window. */
static bool is_seen(const tube_look *tube, const thr_box *box)
{
  /* Half the width, in mm: width counts tenths. */
  double radius = 0.05 * tube->width;
  return thr_box_touch((thr_box){fmin(tube->end[0][0], tube->end[1][0]) - radius,
                                 fmin(tube->end[0][1], tube->end[1][1]) - radius,
                                 fmax(tube->end[0][0], tube->end[1][0]) + radius,
                                 fmax(tube->end[0][1], tube->end[1][1]) + radius},
                       *box);
}

/* Appends all tubes in the window, an element or two for each look. */
static thr_status put_tubes(const thr_scene *scene, const unsigned char *state,
                            const thr_box *window, thr_text *text, thr_err *err)
{
  tube_look *tube = thr_calloc((size_t)scene->frame->n_edges, sizeof *tube);
  int n = 0;
  if (!tube) return thr_nomem(err);

  /* Keep the tubes in the window. */
  for (int e = 0; e < scene->frame->n_edges; e++) {
    tube[n] = capsule_of(scene, e, state ? (thr_piece_state)state[e] : THR_PIECE_PLAIN);
    n += is_seen(&tube[n], window);
  }

  /* Tubes that look alike lie one after the other then. */
  qsort(tube, (size_t)n, sizeof *tube, by_look);
  for (int i = 0, next; i < n; i = next) {
    thr_text data = {0};

    /* The run of tubes with the look of tube i is one path. */
    for (next = i;
         next < n && tube[next].state == tube[i].state && tube[next].width == tube[i].width;
         next++) {
      thr_svg_move(&data, tube[next].end[0]);
      thr_svg_line(&data, tube[next].end[1]);
    }
    put_path(scene, tube[i].state, 0.1 * tube[i].width, &data, text);
  }

  free(tube);
  return THR_OK;
}

/* Draws solid pieces by state, or tubes by state and width. */
thr_status thr_crop_pieces(const thr_scene *scene, const unsigned char *state,
                           const thr_box *window, thr_text *text, thr_err *err)
{
  /* Later states lie on earlier ones, so that outlines of new pieces are whole. */
  for (int wanted = 0; wanted < THR_PIECE_STATES && scene->solid; wanted++)
    put_solid(scene, state, (thr_piece_state)wanted, window, text);

  thr_status st = scene->solid ? THR_OK : put_tubes(scene, state, window, text, err);
  return !st && text->failed ? thr_nomem(err) : st;
}
