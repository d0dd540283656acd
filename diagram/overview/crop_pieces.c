/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces in a part of a scene, all that look alike in one element. */
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"

#include <math.h>
#include <stdlib.h>

static bool touch(thr_box a, thr_box b)
{
  return a.x0 <= b.x1 && a.x1 >= b.x0 && a.y0 <= b.y1 && a.y1 >= b.y0;
}

/* Appends the data of a path to a picture, in the look of a state. Destroys them. */
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

static void put_solid(const thr_scene *scene, const unsigned char *state, thr_piece_state wanted,
                      const thr_box *window, thr_text *text)
{
  thr_text data = {0};
  for (int p = 0; p < scene->layout->n_points; p++) {
    int v = thr_layout_node(scene->layout, p);
    if ((state ? state[v] : THR_PIECE_PLAIN) == wanted && touch(thr_outline_box(scene, p), *window))
      thr_outline_solid(scene, p, &data);
  }
  put_path(scene, wanted, 0, &data, text);
}

/* ---- tubes: thick lines with round ends ---- */

typedef struct {
  int width; /* in tenths of a mm */
  thr_piece_state state;
  int edge;
  double end[2][2]; /* middles of its round ends, mm */
} capsule;

static int by_look(const void *a, const void *b)
{
  const capsule *p = a, *q = b;
  if (p->state != q->state) return p->state < q->state ? -1 : 1;
  return p->width != q->width ? p->width - q->width : p->edge - q->edge;
}

static capsule capsule_of(const thr_scene *scene, int e, thr_piece_state state)
{
  capsule c = {.width = (int)fmax(nearbyint(10 * scene->bead[e]), 1), .state = state, .edge = e};
  thr_outline_tube(scene, e, 0.1 * c.width, c.end);
  return c;
}

static bool is_seen(const capsule *c, const thr_box *box)
{
  double radius = 0.05 * c->width;
  return touch((thr_box){fmin(c->end[0][0], c->end[1][0]) - radius,
                         fmin(c->end[0][1], c->end[1][1]) - radius,
                         fmax(c->end[0][0], c->end[1][0]) + radius,
                         fmax(c->end[0][1], c->end[1][1]) + radius},
               *box);
}

static thr_status put_tubes(const thr_scene *scene, const unsigned char *state,
                            const thr_box *window, thr_text *text, thr_err *err)
{
  capsule *c = thr_calloc((size_t)scene->frame->n_edges, sizeof *c);
  int n = 0;
  if (!c) return thr_nomem(err);
  for (int e = 0; e < scene->frame->n_edges; e++) {
    c[n] = capsule_of(scene, e, state ? (thr_piece_state)state[e] : THR_PIECE_PLAIN);
    n += is_seen(&c[n], window);
  }
  qsort(c, (size_t)n, sizeof *c, by_look);
  for (int i = 0, next; i < n; i = next) {
    thr_text data = {0};
    for (next = i; next < n && c[next].state == c[i].state && c[next].width == c[i].width; next++) {
      thr_svg_move(&data, c[next].end[0]);
      thr_svg_line(&data, c[next].end[1]);
    }
    put_path(scene, c[i].state, 0.1 * c[i].width, &data, text);
  }
  free(c);
  return THR_OK;
}

thr_status thr_crop_pieces(const thr_scene *scene, const unsigned char *state,
                           const thr_box *window, thr_text *text, thr_err *err)
{
  for (int wanted = 0; wanted < THR_PIECE_STATES && scene->solid; wanted++)
    put_solid(scene, state, (thr_piece_state)wanted, window, text);
  thr_status st = scene->solid ? THR_OK : put_tubes(scene, state, window, text, err);
  return !st && text->failed ? thr_nomem(err) : st;
}
