/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Builds the overview picture before it is written: everything in mm on paper, x to the right, y
 * down, the nodes' bounding box at the origin.
 *
 * Built in steps, each in its own file: paper and beads (here), the S and E marks (marks.c), seams
 * between panels (seams.c), lanes (lanes.c), strands (scene_strands.c), numbers, arrows and names
 * (labels.c); if wanted, turns (turns.c). Each step tells the boxes (boxes.c) what it has drawn, so
 * that later ones keep off.
 *
 * Example: a pitch of 24 mm makes the median edge 24 mm, lanes 2.8 mm apart and cords 1.1 mm
 * wide. */
#include "diagram/scene/scene.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* mm; A0 is 1189 long, less margins and text */
static const double AUTO_PITCH = 24, MAX_WIDTH = 1130, MAX_HEIGHT = 1070;
static const double SHORT = 0.36; /* at most this share of an edge is left free at each end */

double thr_scene_text_width(const char *text, double font_size)
{
  /* Measured on DejaVu Sans, a wide face: digits 0.636 em, capitals 0.70 em in the mean, many of
   * the capitals in names 0.77 em. */
  int capitals = 0;
  for (const char *s = text; *s; s++)
    capitals += *s >= 'A' && *s <= 'Z';

  return font_size * (0.64 * thr_text_columns(text, SIZE_MAX) + 0.11 * capitals);
}

double thr_scene_pill_height(const thr_scene *scene)
{
  return 1.4 * scene->size.text;
}

double thr_scene_pill_width(const thr_scene *scene, const char *text)
{
  return fmax(thr_scene_text_width(text, scene->size.text) + 0.6 * scene->size.text,
              thr_scene_pill_height(scene));
}

void thr_scene_number(const thr_scene *scene, int pass, char text[32])
{
  const thr_scene_pass *scene_pass = &scene->pass[pass];
  thr_scene_pass_name(scene->plan, scene_pass->cord, scene_pass->number, text);
}

void thr_scene_pass_name(const thr_plan *plan, int c, int number, char text[32])
{
  char id[12] = "";
  if (plan->n_cords > 1) thr_scene_cord_id(plan, c, id);
  snprintf(text, 32, "%s%s%d", id, *id ? ":" : "", number);
}

double thr_scene_sweep(double a, double b)
{
  double d = fmod(b - a, 2 * THR_PI);
  return d < 0 ? d + 2 * THR_PI : d;
}

bool thr_scene_is_copy(const thr_scene *scene, int c)
{
  return scene->copy && scene->copy[c].of != c;
}

int thr_scene_hue(const thr_scene *scene, int c)
{
  return scene->copy ? scene->copy[c].path : c;
}

const char *thr_scene_cord_colour(const thr_scene *scene, int c)
{
  thr_colour colour = thr_palette(thr_scene_hue(scene, c));
  return thr_scene_is_copy(scene, c) ? colour.pale : colour.hex;
}

void thr_scene_colour(const thr_scene *scene, int i, char hex[8])
{
  const thr_scene_pass *pass = &scene->pass[i];

  /* The tensions of the pass's cord, if they are shown and known. */
  const thr_eval_cord *known = scene->tension && scene->tension->cord[pass->cord].known
                                   ? &scene->tension->cord[pass->cord]
                                   : NULL;

  /* Tension, else grey; grey under the colours of turns; else the cord's colour, or that of its
   * part. */
  if (known)
    thr_tension_colour(scene->tension_range, known->tension[pass->number - 1], hex);
  else if (scene->tension)
    snprintf(hex, 8, "#999999");
  else if (scene->turning && scene->plan->n_cords == 1)
    snprintf(hex, 8, "#666666");
  else
    snprintf(hex, 8, "%s",
             scene->plan->n_cords > 1 ? thr_scene_cord_colour(scene, pass->cord)
                                      : thr_palette((pass->number - 1) / THR_COLOUR_PASSES).hex);
}

bool thr_scene_rim(const thr_scene *scene, int c, const char *colour, char rim[8])
{
  return !scene->turning && !thr_scene_is_copy(scene, c) && thr_palette_rim(colour, rim);
}

const double *thr_scene_dash(const thr_scene *scene, int c)
{
  int hues =
      scene->copy ? thr_copies_paths(scene->copy, scene->plan->n_cords) : scene->plan->n_cords;
  return hues > THR_COLOURS ? thr_palette_dash(thr_scene_hue(scene, c) / THR_COLOURS) : NULL;
}

bool thr_scene_continues(const thr_scene *scene, int i)
{
  return i + 1 < scene->first_pass[scene->pass[i].cord + 1];
}

const thr_mark *thr_scene_mark_before(const thr_scene *scene, int i)
{
  const thr_scene_pass *pass = &scene->pass[i];
  if (pass->number == 1) return &scene->mark[pass->cord][0];
  return pass->seam >= 0 ? &scene->seam[pass->seam][1] : NULL;
}

const thr_mark *thr_scene_mark_after(const thr_scene *scene, int i)
{
  const thr_scene_pass *pass = &scene->pass[i];
  if (!thr_scene_continues(scene, i)) return &scene->mark[pass->cord][1];
  return pass[1].seam >= 0 ? &scene->seam[pass[1].seam][0] : NULL;
}

const double *thr_scene_turn_start(const thr_scene *scene, int i)
{
  const thr_mark *mark = thr_scene_mark_before(scene, i);
  return mark ? mark->at : scene->pass[i - 1].to;
}

void thr_scene_place_name(const thr_scene *scene, int point, char name[48])
{
  snprintf(name, 48, "%.47s", scene->label[thr_layout_node(scene->layout, point)]);
}

double thr_scene_edge_length(const thr_scene *scene, int e)
{
  const double *a = scene->at[scene->paper->edge[e][0]], *b = scene->at[scene->paper->edge[e][1]];
  return hypot(b[0] - a[0], b[1] - a[1]);
}

void thr_scene_direction(const thr_scene *scene, int h, double direction[2])
{
  const double *a = scene->at[thr_tail(scene->paper, h)], *b = scene->at[thr_head(scene->paper, h)];

  double length = hypot(b[0] - a[0], b[1] - a[1]);
  direction[0] = length > 0 ? (b[0] - a[0]) / length : h & 1 ? -1 : 1;
  direction[1] = length > 0 ? (b[1] - a[1]) / length : 0;
}

void thr_scene_destroy(thr_scene *scene)
{
  thr_places_destroy(&scene->places);
  thr_boxes_destroy(&scene->boxes);
  free(scene->copy);
  thr_scratch_free(&scene->own);
  free(scene->seam);
  free(scene->seam_labelled);
  *scene = (thr_scene){0};
}

/* Allocates the arrays of the scene, except those of seams, whose number is not known yet. */
static thr_status allocate(thr_scene *scene, thr_err *err)
{
  size_t n_points = (size_t)scene->layout->n_points, n_edges = (size_t)scene->frame->n_edges,
         n_cords = (size_t)scene->plan->n_cords, n_passes = (size_t)scene->n_passes;

  scene->at = thr_scratch_array(&scene->own, n_points, sizeof *scene->at);
  scene->twin = thr_scratch_array(&scene->own, n_points, sizeof *scene->twin);
  scene->angle = thr_scratch_array(&scene->own, 2 * n_edges, sizeof *scene->angle);
  scene->around = thr_scratch_array(&scene->own, 2 * n_edges, sizeof *scene->around);
  scene->rank = thr_scratch_array(&scene->own, 2 * n_edges, sizeof *scene->rank);
  scene->gap = thr_scratch_array(&scene->own, 2 * n_edges, sizeof *scene->gap);
  scene->lane = thr_scratch_array(&scene->own, n_edges, sizeof *scene->lane);
  scene->bead = thr_scratch_array(&scene->own, n_edges, sizeof *scene->bead);
  scene->pass = thr_scratch_array(&scene->own, n_passes, sizeof *scene->pass);
  scene->first_pass = thr_scratch_array(&scene->own, n_cords + 1, sizeof *scene->first_pass);
  scene->first_on = thr_scratch_array(&scene->own, n_edges + 2, sizeof *scene->first_on);
  scene->on = thr_scratch_array(&scene->own, n_passes, sizeof *scene->on);
  scene->mark = thr_scratch_array(&scene->own, n_cords, sizeof *scene->mark);
  scene->id = thr_scratch_array(&scene->own, n_cords, sizeof *scene->id);
  scene->named = thr_scratch_array(&scene->own, n_points, sizeof *scene->named);
  scene->name_at = thr_scratch_array(&scene->own, n_points, sizeof *scene->name_at);

  scene->label =
      thr_scratch_array(&scene->own, (size_t)scene->frame->n_nodes, sizeof *scene->label);
  return thr_scratch_check(&scene->own, err);
}

thr_status thr_scene_check_cords(const thr_plan *plan, int *n_passes, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  long total = 0;

  for (int c = 0; c < plan->n_cords; c++) {
    const thr_cord *cord = &plan->cord[c];
    if (cord->n_passes < 1) return thr_fail(err, THR_EINPUT, "cord %.11s has no pass", cord->id);

    /* Every half-edge exists and begins where the one before ends. */
    for (int i = 0; i < cord->n_passes; i++) {
      int h = cord->half[i];
      if (h < 0 || h >= 2 * frame->n_edges)
        return thr_fail(err, THR_EINPUT, "cord %.11s: pass %d names edge %d, but there are %d",
                        cord->id, i + 1, h / 2, frame->n_edges);
      if (i && thr_head(frame, cord->half[i - 1]) != thr_tail(frame, h))
        return thr_fail(err, THR_EINPUT, "cord %.11s: pass %d does not start where pass %d ends",
                        cord->id, i + 1, i);
    }
    total += cord->n_passes;
  }

  /* Numbers of passes must fit an int with room. */
  if (total > 100000000) return thr_fail(err, THR_EINPUT, "%ld passes are too many to draw", total);
  *n_passes = (int)total;
  return THR_OK;
}

/* Finds which cords are copies; scene->copy stays NULL if there are none. */
static thr_status find_copies(thr_scene *scene, thr_err *err)
{
  int n = scene->plan->n_cords;
  thr_copy *copy = thr_calloc((size_t)n, sizeof *copy);

  if (!copy) return thr_nomem(err);
  thr_status st = thr_copies_find(scene->plan, copy, err);
  if (!st && thr_copies_paths(copy, n) < n)
    scene->copy = copy;
  else
    free(copy);
  return st;
}

void thr_scene_cord_id(const thr_plan *plan, int c, char id[12])
{
  size_t letters = strspn(plan->cord[c].id, "ABCDEFGHIJKLMNOPQRSTUVWXYZ");
  if (letters && !plan->cord[c].id[letters])
    snprintf(id, 12, "%.11s", plan->cord[c].id);
  else
    thr_cord_id(c, id);
}

/* Flattens the cords into passes, and sorts these by edge, within an edge by pass (a counting sort:
 * first_on and on). */
static void collect_passes(thr_scene *scene)
{
  int n = 0;

  /* Passes in the order of the cords; first_on[e + 2] counts those on edge e. */
  for (int c = 0; c < scene->plan->n_cords; c++) {
    const thr_cord *cord = &scene->plan->cord[c];
    scene->first_pass[c] = n;
    for (int i = 0; i < cord->n_passes; i++) {
      scene->pass[n++] =
          (thr_scene_pass){.cord = c, .number = i + 1, .half = cord->half[i], .seam = -1};
      scene->first_on[(cord->half[i] >> 1) + 2]++;
    }

    thr_scene_cord_id(scene->plan, c, scene->id[c]);
  }
  scene->first_pass[scene->plan->n_cords] = n;

  /* Running sums: first_on[e + 1] is where the passes on edge e begin. */
  for (int e = 0; e < scene->frame->n_edges; e++)
    scene->first_on[e + 2] += scene->first_on[e + 1];

  /* Filling moves each of them to its end, which is where the next edge's passes begin. */
  for (int i = 0; i < n; i++) {
    int *at = &scene->first_on[(scene->pass[i].half >> 1) + 1];
    scene->on[(*at)++] = i;
  }
}

/* Chooses the sizes from the pitch; on large sheets line widths, arrows and text stay readable
 * rather than grow. */
static void choose_sizes(thr_scene *scene)
{
  double pitch = scene->size.pitch;
  scene->size.lane = 0.115 * pitch;
  scene->size.cord = fmin(0.045 * pitch, 1.6);
  scene->size.casing = fmin(0.025 * pitch, 0.8);
  scene->size.bead = scene->solid ? 0.33 * pitch : 0.28 * pitch;
  scene->size.gap = 0.15 * pitch;
  scene->size.foot = fmax(scene->solid ? 0.26 * pitch : 0.16 * pitch, 0.5);
  scene->size.arrow = fmin(0.14 * pitch, 5);
  scene->size.text = pitch > 28 ? 3 : 2.5;
}

/* Chooses the scale and puts the nodes on paper. pitch_mm: of the median edge, <= 0: choose one.
 * THR_EINPUT: the sheet would be larger than 100 m. */
static thr_status place_nodes(thr_scene *scene, double pitch_mm, thr_err *err)
{
  const thr_layout *layout = scene->layout;
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};

  /* The layout's bounding box. */
  for (int v = 0; v < layout->n_points; v++)
    thr_widen(low, high, layout->xy[v], 2);

  /* The length that becomes the pitch: the median edge, unless edges have no length. */
  double extent = fmax(high[0] - low[0], high[1] - low[1]);
  double unit =
      layout->median > 1e-9 * extent ? layout->median : extent / sqrt(scene->frame->n_edges);
  if (!(unit > 0)) unit = 1;

  /* A layout with many short edges gets a larger sheet, so that these have room too, and so does
   * one with many lanes. */
  double wanted = AUTO_PITCH * fmax(1, fmin(1.4, 0.6 / fmax(layout->ratio, 0.01)));
  wanted *= fmax(1, fmin(1.5, 0.8 + 0.17 * scene->n_passes / scene->frame->n_edges));

  /* A pitch that is not asked for is such that the sheet is no larger than A0. */
  double relative = fmax((high[0] - low[0]) / MAX_WIDTH, (high[1] - low[1]) / MAX_HEIGHT) / unit;
  scene->size.pitch = pitch_mm > 0 ? pitch_mm : fmin(wanted, relative > 0 ? 1 / relative : wanted);

  scene->scale = scene->size.pitch / unit;
  scene->width = (high[0] - low[0]) * scene->scale;
  scene->height = (high[1] - low[1]) * scene->scale;

  if (!(scene->width < 1e5 && scene->height < 1e5))
    return thr_fail(err, THR_EINPUT,
                    "a pitch of %g mm needs a sheet %.0f mm wide; choose a smaller one",
                    scene->size.pitch, fmax(scene->width, scene->height));

  /* Turn y down, with the greatest y at 0. */
  scene->origin[0] = low[0];
  scene->origin[1] = high[1];
  for (int v = 0; v < layout->n_points; v++) {
    scene->at[v][0] = (layout->xy[v][0] - low[0]) * scene->scale;
    scene->at[v][1] = (high[1] - layout->xy[v][1]) * scene->scale;
  }

  choose_sizes(scene);
  return THR_OK;
}

/* Sorts the half-edges around every point by angle, and numbers them there. */
static thr_status sort_around(thr_scene *scene, thr_err *err)
{
  const thr_frame *frame = scene->paper;

  for (int h = 0; h < 2 * frame->n_edges; h++) {
    double d[2];
    thr_scene_direction(scene, h, d);
    scene->angle[h] = atan2(d[1], d[0]);
  }

  thr_status st = thr_layout_around(frame, scene->angle, scene->around, err);
  for (int v = 0; v < frame->n_nodes && !st; v++)
    for (int i = 0; i < thr_degree(frame, v); i++)
      scene->rank[scene->around[frame->first[v] + i]] = i;
  return st;
}

/* Chooses the lanes' distance and the beads' width on each edge: lanes get closer where there are
 * many or the edge is short. */
static void size_beads(thr_scene *scene)
{
  for (int e = 0; e < scene->frame->n_edges; e++) {
    /* The lanes share what the pitch and the edge's length allow. */
    int n = scene->first_on[e + 1] - scene->first_on[e];
    double room = fmin(0.62 * scene->size.pitch,
                       fmax(0.6 * thr_scene_edge_length(scene, e), 0.2 * scene->size.pitch));
    scene->lane[e] = n > 1 ? fmin(scene->size.lane, room / (n - 1)) : scene->size.lane;

    /* The bead holds all lanes, and has a usual width unless the edge is short. */
    double wide = (n > 1 ? (n - 1) * scene->lane[e] : 0) + 0.2 * scene->size.pitch;
    scene->bead[e] = fmax(wide, fmin(scene->size.bead, fmax(0.55 * thr_scene_edge_length(scene, e),
                                                            0.17 * scene->size.pitch)));
  }
}

/* Returns how far from the node half-edge h may start, mm, so that its bead clears the bead of its
 * neighbour `other`.
 *
 * Two beads of half widths a and b at an angle t: the corner of bead h touches the side of the
 * other one at (b + a cos t) / sin t from the node. */
static double clearance(const thr_scene *scene, int h, int other)
{
  /* The angle between them, at most pi; nearly in line they do not meet, nearly parallel counts as
   * 0.05 rad. */
  double angle = thr_scene_sweep(scene->angle[h], scene->angle[other]);
  if (angle > THR_PI) angle = 2 * THR_PI - angle;
  if (angle > 2.6) return 0;
  if (angle < 0.05) angle = 0.05;
  return 0.5 * (scene->bead[other >> 1] + scene->bead[h >> 1] * cos(angle)) / sin(angle);
}

/* Chooses the gap at each half-edge's tail: the bead clears its two neighbours by angle, within the
 * pitch and a share of the edge's length. */
static void size_gaps(thr_scene *scene)
{
  const thr_frame *frame = scene->paper;
  for (int v = 0; v < frame->n_nodes; v++) {
    int first = frame->first[v], degree = thr_degree(frame, v);

    for (int i = 0; i < degree; i++) {
      int h = scene->around[first + i];
      double gap = scene->size.gap;

      /* The neighbours before and behind, round the node. */
      if (degree > 1) {
        gap = fmax(gap, 0.95 * clearance(scene, h, scene->around[first + (i + 1) % degree]));
        gap =
            fmax(gap, 0.95 * clearance(scene, h, scene->around[first + (i + degree - 1) % degree]));
      }

      scene->gap[h] =
          fmin(fmin(gap, scene->size.pitch), SHORT * thr_scene_edge_length(scene, h >> 1));
    }
  }
}

/* Tells the boxes where tubes and arms are: small squares along each, at most 64. The squares are a
 * little narrower than the bead: names may touch the sides. */
static thr_status box_beads(thr_scene *scene, thr_err *err)
{
  double pitch = scene->size.pitch, seen = scene->solid ? 0.75 : 0.9;

  /* Cells as large as half a pitch keep a few boxes each. */
  thr_status st = thr_boxes_init(
      &scene->boxes, (thr_box){-pitch, -pitch, scene->width + pitch, scene->height + pitch},
      fmax(0.5 * pitch, 4), err);

  /* The visible part of each bead, between the gaps. */
  for (int e = 0; e < scene->frame->n_edges && !st; e++) {
    double direction[2],
        half = 0.5 * scene->bead[e],
        length = thr_scene_edge_length(scene, e) - scene->gap[2 * e] - scene->gap[2 * e + 1];

    const double *tail = scene->at[scene->paper->edge[e][0]];
    thr_scene_direction(scene, 2 * e, direction);

    /* Squares whose centres are evenly spaced, the outer ones at the ends. */
    int n = (int)fmin(ceil(length / scene->bead[e]) + 1, 64);
    for (int i = 0; i < n && !st; i++) {
      double along = scene->gap[2 * e] +
                     (n > 1 ? fmin(half, 0.5 * length) + i * fmax(length - 2 * half, 0) / (n - 1)
                            : 0.5 * length);
      st = thr_boxes_add(&scene->boxes,
                         thr_box_around(tail[0] + along * direction[0],
                                        tail[1] + along * direction[1], seen * half, seen * half),
                         THR_BOX_BEAD, err);
    }
  }

  return st;
}

thr_status thr_scene_build(thr_scene *scene, const thr_plan *plan, const thr_layout *layout,
                           double pitch_mm, bool pale_copies, thr_err *err)
{
  /* The framework on paper is cut into panels by some layouts. */
  *scene = (thr_scene){.plan = plan,
                       .frame = &plan->frame,
                       .layout = layout,
                       .paper = thr_layout_paper(layout, &plan->frame)};
  scene->solid = plan->options.joint == THR_JOINT_SOLID;

  thr_status st = thr_scene_check_cords(plan, &scene->n_passes, err);
  if (!st) st = allocate(scene, err);
  if (!st && pale_copies) st = find_copies(scene, err);
  if (st) goto done;

  /* Passes, scale and points. */
  collect_passes(scene);
  if ((st = place_nodes(scene, pitch_mm, err))) goto done;

  /* Places are letters and numbers only where the picture is to scale. */
  if (thr_layout_to_scale(layout->kind))
    st = thr_places_find(&scene->places, scene->frame, (const double(*)[2])layout->xy,
                         layout->median, err);
  if (!st) st = thr_places_labels(&scene->places, scene->frame, scene->label, err);
  if (st) goto done;

  /* Sizes of beads. */
  if ((st = sort_around(scene, err))) goto done;
  size_beads(scene);
  size_gaps(scene);
  if ((st = box_beads(scene, err))) goto done;

  /* Marks, seams and lanes decide where the strands run. */
  if ((st = thr_scene_place_marks(scene, err))) goto done;
  if ((st = thr_scene_place_seams(scene, err))) goto done;
  if ((st = thr_scene_order_lanes(scene, err))) goto done;

  thr_scene_lay_strands(scene);

  /* What is written comes last, in the room that is left. */
  if ((st = thr_scene_name_seams(scene, err))) goto done;
  st = thr_scene_place_labels(scene, err);
done:
  if (st) thr_scene_destroy(scene);
  return st;
}
