/* Beads as capsules: thick lines with round ends, all of a width in one element. */
#include "diagram/overview/crop.h"
#include "diagram/overview/draw.h"
#include "diagram/overview/svg.h"
#include "diagram/scene/boxes.h"
#include "diagram/scene/scene.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  int width; /* in tenths of a mm */
  bool filled;
  int edge;
  double end[2][2]; /* middles of its round ends, mm */
} capsule;

static int by_look(const void *a, const void *b)
{
  const capsule *p = a, *q = b;
  if (p->filled != q->filled) return p->filled - q->filled;
  return p->width != q->width ? p->width - q->width : p->edge - q->edge;
}

static capsule capsule_of(const thr_scene *scene, int e, bool filled)
{
  capsule c = {.width = (int)fmax(nearbyint(10 * scene->bead[e]), 1), .filled = filled, .edge = e};
  double along[2], length = thr_scene_edge_length(scene, e), near = scene->gap[2 * e], far = scene->gap[2 * e + 1],
                   radius = 0.05 * c.width;
  const double *a = scene->at[scene->paper->edge[e][0]];
  thr_scene_direction(scene, 2 * e, along);
  double reach = fmax(0.5 * (length - near - far) - radius, 0), middle = 0.5 * (length + near - far);
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++)
      c.end[k][i] = a[i] + (middle + (k ? reach : -reach)) * along[i];
  return c;
}

static bool is_seen(const capsule *c, const thr_box *box)
{
  double radius = 0.05 * c->width;
  return fmin(c->end[0][0], c->end[1][0]) - radius <= box->x1 && fmax(c->end[0][0], c->end[1][0]) + radius >= box->x0 &&
         fmin(c->end[0][1], c->end[1][1]) - radius <= box->y1 && fmax(c->end[0][1], c->end[1][1]) + radius >= box->y0;
}

thr_status thr_crop_beads(const thr_scene *scene, const bool *filled, const thr_box *window, thr_text *text, thr_err *err)
{
  capsule *c = thr_calloc((size_t)scene->frame->n_edges, sizeof *c);
  int n = 0;
  if (!c) return thr_nomem(err);
  for (int e = 0; e < scene->frame->n_edges; e++) {
    c[n] = capsule_of(scene, e, filled && filled[e]);
    n += is_seen(&c[n], window);
  }
  qsort(c, (size_t)n, sizeof *c, by_look);
  thr_status st = THR_OK;
  for (int i = 0, next; i < n && !st; i = next) {
    thr_text data = {0};
    for (next = i; next < n && c[next].filled == c[i].filled && c[next].width == c[i].width; next++) {
      thr_svg_move(&data, c[next].end[0]);
      thr_svg_line(&data, c[next].end[1]);
    }
    if (data.failed)
      st = thr_nomem(err);
    else
      thr_draw_capsules(scene, 0.1 * c[i].width, c[i].filled, data.data, text);
    thr_text_destroy(&data);
  }
  free(c);
  return st;
}
