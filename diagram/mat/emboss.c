/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "diagram/mat/emboss.h"

#include "diagram/export/paper.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/framework/units.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>

static const double WIDE = 0.9, HIGH = 0.6; /* of the room on a piece that a name takes */
static const double APART = 4, ROW = 200;   /* mm: between names; width of a row */
static const double PRINTED = 3;            /* mm: lower capitals come out of few printers */

typedef struct {
  const thr_plan *plan;
  thr_guide guide;
  thr_pieces pieces;
  thr_letters_set *letters;
  double room[2]; /* mm: on a piece, along its name and across it */
  double height, widest;
} embossed;

static thr_status name_of(const embossed *l, int piece, thr_text *name, thr_err *err)
{
  *name = (thr_text){0};
  thr_pieces_name(&l->pieces, (const char(*)[THR_LABEL])l->guide.label, piece, name);
  if (name->data && !name->failed) return THR_OK;
  thr_text_destroy(name);
  return thr_nomem(err);
}

static thr_status find_room(embossed *l, thr_err *err)
{
  const thr_frame *f = &l->plan->frame;
  thr_physics physics;
  double mm, shortest = HUGE_VAL;
  if (thr_units_in_mm(f->units, &mm, NULL))
    return thr_fail(
        err, THR_EINPUT,
        "labels are of true size, and nobody knows the framework's unit: plan it with --units");
  thr_status st = thr_physics_resolve(&l->plan->options.physics, f, &physics, err);
  for (int e = 0; e < f->n_edges; e++)
    shortest = fmin(shortest, f->length[e] * mm);
  l->room[1] = physics.bead_diameter;
  l->room[0] = l->pieces.solid ? l->room[1] : fmax(l->room[1], shortest - l->room[1]);
  return st;
}

static thr_status find_height(embossed *l, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < l->pieces.n && !st; i++) {
    thr_text name;
    if ((st = name_of(l, i, &name, err))) break;
    l->widest = fmax(l->widest, thr_letters_width(l->letters, name.data));
    thr_text_destroy(&name);
  }
  l->height = fmin(HIGH * l->room[1], WIDE * l->room[0] / l->widest);
  return st;
}

static thr_status put_all(const embossed *l, thr_text *svg, thr_err *err)
{
  const double step[2] = {l->widest * l->height + APART, l->height + APART};
  const int columns = (int)fmax(1, floor((ROW - APART) / step[0])),
            rows = (l->pieces.n + columns - 1) / columns;
  char words[240];
  snprintf(words, sizeof words, "Closed outlines in mm, capitals %.2f mm high%s.", l->height,
           l->height < PRINTED ? ": fine for engraving; few printers raise letters below 3 mm"
                               : "");
  thr_svg_open(svg, APART + columns * step[0], APART + rows * step[1],
               "Names of the pieces, to emboss", words);
  for (int i = 0; i < l->pieces.n; i++) {
    const int row = i / columns;
    const double at[2] = {APART + i % columns * step[0], (1 + row) * step[1]};
    thr_text name;
    thr_status st = name_of(l, i, &name, err);
    if (st) return st;
    thr_text_append(svg, "<g id=\"label-");
    thr_text_xml(svg, name.data);
    thr_text_append(svg, "\"><path d=\"");
    thr_letters_put(l->letters, name.data, at, l->height, svg);
    thr_text_append(svg, "\"/></g>\n");
    thr_text_destroy(&name);
  }
  thr_text_append(svg, "</svg>\n");
  return svg->failed ? thr_nomem(err) : THR_OK;
}

thr_status thr_emboss_svg(const thr_plan *plan, thr_text *svg, thr_err *err)
{
  embossed l = {.plan = plan};
  thr_status st = thr_guide_make(&l.guide, &plan->frame, NULL, err);
  if (!st) st = thr_pieces_make(&l.pieces, plan, 0, err);
  if (!st) st = find_room(&l, err);
  if (!st) st = thr_letters_open(&l.letters, err);
  if (!st) st = find_height(&l, err);
  if (!st) st = put_all(&l, svg, err);
  thr_letters_close(l.letters);
  thr_pieces_destroy(&l.pieces);
  thr_guide_destroy(&l.guide);
  return st;
}
