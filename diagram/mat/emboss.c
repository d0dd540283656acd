/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the names of all pieces as closed outlines, true to size, row by row.
 *
 * All names have the same height: as high as lets the longest one lie on the hub of a piece (a
 * square as wide as its arms), or along the shortest tube, and at most HIGH of the room across
 * it. */
#include "diagram/mat/mat.h"

#include "diagram/export/paper.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>

static const double WIDE = 0.9, HIGH = 0.6; /* of the room on a piece that a name takes */
static const double APART = 4, ROW = 200;   /* mm: between names; width of a row */
static const double PRINTED = 3;            /* mm: lower capitals come out of few printers */

/* The names to be written. */
typedef struct {
  const thr_plan *plan;
  thr_guide guide;
  thr_pieces pieces;
  thr_letters_set *letters;
  double room[2]; /* mm: on a piece, along its name and across it */
  double height, widest;
} name_sheet;

/* Writes the name of a piece into a new text, which the caller destroys. */
static thr_status name_of(const name_sheet *sheet, int piece, thr_text *name, thr_err *err)
{
  *name = (thr_text){0};
  thr_pieces_name(&sheet->pieces, (const char(*)[THR_LABEL])sheet->guide.label, piece, name);
  if (name->data && !name->failed) return THR_OK;
  thr_text_destroy(name);
  return thr_nomem(err);
}

/* Finds the room for a name on a piece, mm. THR_EINPUT: the unit has no known length. */
static thr_status find_room(name_sheet *sheet, thr_err *err)
{
  const thr_frame *frame = &sheet->plan->frame;
  thr_physics physics;
  double mm, shortest = HUGE_VAL;

  if (thr_units_in_mm(frame->units, &mm, NULL))
    return thr_fail(
        err, THR_EINPUT,
        "labels are of true size, and nobody knows the framework's unit: plan it with --units");

  /* The shortest tube decides; solid pieces have square hubs. */
  thr_status st = thr_physics_resolve(&sheet->plan->options.physics, frame, &physics, err);
  for (int e = 0; e < frame->n_edges; e++)
    shortest = fmin(shortest, frame->length[e] * mm);

  /* A tube is shorter than its edge by the bead's width, since other tubes meet it at its ends. */
  sheet->room[1] = physics.bead_diameter;
  sheet->room[0] =
      sheet->pieces.solid ? sheet->room[1] : fmax(sheet->room[1], shortest - sheet->room[1]);
  return st;
}

/* Finds the height of all names from the widest one. Widths are per height. */
static thr_status find_height(name_sheet *sheet, thr_err *err)
{
  thr_status st = THR_OK;

  for (int i = 0; i < sheet->pieces.n && !st; i++) {
    thr_text name;
    if ((st = name_of(sheet, i, &name, err))) break;
    sheet->widest = fmax(sheet->widest, thr_letters_width(sheet->letters, name.data));
    thr_text_destroy(&name);
  }

  /* Across, a name leaves some of the room; along, the widest name must fit. */
  sheet->height = fmin(HIGH * sheet->room[1], WIDE * sheet->room[0] / sheet->widest);
  return st;
}

/* Writes the document: each name in a cell of its own. */
static thr_status put_all(const name_sheet *sheet, thr_text *svg, thr_err *err)
{
  /* As many cells in a row as fit into ROW mm. */
  const double step[2] = {sheet->widest * sheet->height + APART, sheet->height + APART};
  const int columns = (int)fmax(1, floor((ROW - APART) / step[0])),
            rows = (sheet->pieces.n + columns - 1) / columns;

  /* Say how high they are, and whether a printer can raise them. */
  char words[240];
  snprintf(words, sizeof words, "Closed outlines in mm, capitals %.2f mm high%s.", sheet->height,
           sheet->height < PRINTED ? ": fine for engraving; few printers raise letters below 3 mm"
                                   : "");
  thr_svg_open(svg, APART + columns * step[0], APART + rows * step[1],
               "Names of the pieces, to emboss", words);

  /* The base line of a name lies at the foot of its cell. */
  for (int i = 0; i < sheet->pieces.n; i++) {
    const int row = i / columns;
    const double at[2] = {APART + i % columns * step[0], (1 + row) * step[1]};

    thr_text name;
    thr_status st = name_of(sheet, i, &name, err);
    if (st) return st;

    thr_text_append(svg, "<g id=\"label-");
    thr_text_xml(svg, name.data);
    thr_text_append(svg, "\"><path d=\"");
    thr_letters_put(sheet->letters, name.data, at, sheet->height, svg);
    thr_text_append(svg, "\"/></g>\n");
    thr_text_destroy(&name);
  }

  thr_text_append(svg, "</svg>\n");
  return svg->failed ? thr_nomem(err) : THR_OK;
}

thr_status thr_emboss_svg(const thr_plan *plan, thr_text *svg, thr_err *err)
{
  name_sheet sheet = {.plan = plan};

  /* Names, kinds and places are those of all other documents. */
  thr_status st = thr_guide_make(&sheet.guide, &plan->frame, NULL, err);
  if (!st) st = thr_pieces_make(&sheet.pieces, plan, 0, err);
  if (!st) st = find_room(&sheet, err);
  if (!st) st = thr_letters_open(&sheet.letters, err);
  if (!st) st = find_height(&sheet, err);
  if (!st) st = put_all(&sheet, svg, err);

  thr_letters_close(sheet.letters);
  thr_pieces_destroy(&sheet.pieces);
  thr_guide_destroy(&sheet.guide);
  return st;
}
