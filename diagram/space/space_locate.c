/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the whole framework in small, from the same direction as a step's picture, with the step's
 * passes bold: where on the framework the step is. */
#include "diagram/space/space.h"

#include <math.h>
#include <stdlib.h>

/* Places all nodes in the upper right corner of the paper, as large as the paper takes; at: where
 * they are, mm. Returns the scale, mm per unit. */
static double place(const thr_space *space, const thr_camera *camera, thr_box paper,
                    double (*at)[3])
{
  thr_camera_view view = {.camera = *camera, .scale = 1};
  thr_box all = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  /* The nodes' bounding box at scale 1. */
  for (int v = 0; v < space->f->n_nodes; v++) {
    thr_camera_project(&view, space->f->xyz[v], at[v]);
    thr_box_extend(&all, (thr_box){at[v][0], at[v][1], at[v][0], at[v][1]});
  }

  /* A flat framework seen from its edge has no height, or no width. */
  double scale = fmin((paper.x1 - paper.x0) / fmax(all.x1 - all.x0, 1e-9 * space->pitch),
                      (paper.y1 - paper.y0) / fmax(all.y1 - all.y0, 1e-9 * space->pitch));

  for (int v = 0; v < space->f->n_nodes; v++) {
    at[v][0] = paper.x1 + scale * (at[v][0] - all.x1);
    at[v][1] = paper.y0 + scale * (at[v][1] - all.y0);
  }
  return scale;
}

thr_status thr_space_locate(const thr_space *space, const thr_space_step *step,
                            const thr_camera_view *view, thr_box paper, thr_text *text,
                            thr_err *err)
{
  const thr_frame *frame = space->f;
  double(*at)[3] = thr_calloc((size_t)frame->n_nodes, sizeof *at);
  if (!at) return thr_nomem(err);

  /* All edges, or their shadow if they are too close to each other. */
  double pitch = place(space, &view->camera, paper, at) * space->pitch;
  thr_shadow_edges(frame, at[0], 3, pitch, paper, text);

  /* The passes of the step as one line. */
  thr_text_printf(
      text,
      "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.70\" stroke-linejoin=\"round\" d=\"",
      step->colour);

  for (int i = 0; i < step->crop.n_now; i++) {
    int h = thr_space_half(space, &step->crop, step->crop.now[i]);
    if (!i) thr_svg_move(text, at[thr_tail(frame, h)]);
    thr_svg_line(text, at[thr_head(frame, h)]);
  }

  thr_text_append(text, "\"/>\n");
  free(at);
  return THR_OK;
}
