/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Places numbers, arrows and names in the overview: each takes the first free place of a few, the
 * important ones first.
 *
 * Numbers of passes come first, by importance (first and last passes, then round numbers), each on
 * the straight part of its pass; then arrows, where no number hides them; then names of nodes,
 * between two beads; then captions over panels. What finds no place is left out and counted.
 *
 * Example: at a pitch of 24 mm every pass is numbered; at 10 mm every tenth one. */
#include "diagram/scene/scene.h"

#include <math.h>

enum { MAX_PLACES = 10 };

/* Along the straight part of a pass. Of a solid piece the number is on the arm by which the cord
 * comes in, the arrow on that by which it goes out: they say which piece they belong to, and the
 * hub stays free. */
static const double NUMBER_AT[2][MAX_PLACES] = {
    {0.30, 0.22, 0.38, 0.46, 0.14, 0.54, 0.62, 0.70, 0.80, 0.90},
    {0.76, 0.70, 0.82, 0.64, 0.88, 0.94, 0.58, 0.52, 0.40, 0.20}};
static const double ARROW_AT[2][MAX_PLACES] = {
    {0.68, 0.76, 0.60, 0.84, 0.52, 0.92, 0.44, 0.30, 0.20, 0.10},
    {0.32, 0.26, 0.38, 0.20, 0.44, 0.14, 0.50, 0.08, 0.60, 0.70}};

enum {
  TAKEN = THR_BOX_MARK | THR_BOX_NUMBER | THR_BOX_NAME
};                                 /* what a number may not cover, and what would hide an arrow */
static const double CAPTION = 1.4; /* size of captions, over that of numbers */
static const double MUCH = 1e6;    /* cost of a number on another, over that of one on arrows */
static const double SEEN = 0.2;    /* mm: smaller arrows are not drawn */
static const int STEPS[] = {1, 5, 10, 20, 50, 100, 200, 500, 1000};
enum { COPY_ARROWS = 4 }; /* a copy has an arrow on every so many passes, on the first one too */
enum { N_STEPS = sizeof STEPS / sizeof STEPS[0] };

/* Computes the point at t of the straight part of a pass. */
static void along(const thr_scene_pass *pass, double t, double at[2])
{
  for (int k = 0; k < 2; k++)
    at[k] = pass->from[k] + t * (pass->to[k] - pass->from[k]);
}

/* Returns the square that an arrow takes. */
static thr_box arrow_box(const double at[2], double size)
{
  return thr_box_around(at[0], at[1], 0.5 * size, 0.5 * size);
}

/* Returns the box of the number of pass i. */
static thr_box pill_box(const thr_scene *scene, int i, const double at[2])
{
  char text[32];
  thr_scene_number(scene, i, text);

  /* The same size as overview.c draws, with a hair of air. */
  return thr_box_around(at[0], at[1], 0.5 * thr_scene_pill_width(scene, text) + 0.15,
                        0.5 * thr_scene_pill_height(scene) + 0.15);
}

/* Returns the step from number to number: every pass from a pitch of 20 mm, every fifth from 12,
 * every tenth from 8; below that so many that numbers stay 80 mm of cord apart. */
static int choose_step(double pitch)
{
  if (pitch >= 20) return 1;
  if (pitch >= 12) return 5;
  int i = 2;
  while (i < N_STEPS - 1 && STEPS[i] * pitch < 80)
    i++;
  return STEPS[i];
}

/* Returns how important the number of pass i is: 0 (first and last passes of a cord) to 3; -1: the
 * pass has none, like all passes of copies. */
static int importance(const thr_scene *scene, int i)
{
  int number = scene->pass[i].number;

  if (thr_scene_is_copy(scene, scene->pass[i].cord)) return -1;
  if (number == 1 || !thr_scene_continues(scene, i)) return 0;

  if (number % scene->number_step) return -1;
  return number % (10 * scene->number_step) == 0  ? 1
         : number % (5 * scene->number_step) == 0 ? 2
                                                  : 3;
}

/* Moves a number that must be there off the pass to the nearest free place around, if there is one:
 * twelve directions in four rings. */
static void move_aside(thr_scene *scene, int i)
{
  thr_scene_pass *pass = &scene->pass[i];
  for (int ring = 1; ring <= 4; ring++)
    for (int k = 0; k < 12; k++) {
      /* Rings are ellipses, half as wide again as high, as numbers are. */
      double turn = k * 0.5235987755982988, reach = 0.6 * ring * thr_scene_pill_height(scene);
      double at[2] = {pass->pill[0] + 1.5 * reach * cos(turn), pass->pill[1] + reach * sin(turn)};

      if (thr_boxes_overlap(&scene->boxes, pill_box(scene, i, at), TAKEN, 1e-9) > 0) continue;
      pass->pill[0] = at[0];
      pass->pill[1] = at[1];
      return;
    }
}

/* Puts the number of pass i in the first place that is free, preferring one that hides no arrow. If
 * `must` is set and no place is free, takes the least bad one. */
static thr_status place_number(thr_scene *scene, int i, bool must, thr_err *err)
{
  thr_scene_pass *pass = &scene->pass[i];
  double least = HUGE_VAL, at[2];

  /* Covering a number costs more than covering any arrow. */
  for (int k = 0; k < MAX_PLACES && least > 0; k++) {
    along(pass, NUMBER_AT[scene->solid][k], at);

    thr_box box = pill_box(scene, i, at);
    double taken = thr_boxes_overlap(&scene->boxes, box, TAKEN, must ? HUGE_VAL : 1e-9);
    double cost = (taken > 0 ? MUCH + 1000 * taken : 0) +
                  thr_boxes_overlap(&scene->boxes, box, THR_BOX_ARROW, least);

    if (cost >= least || (taken > 0 && !must)) continue;
    least = cost;
    pass->pill[0] = at[0];
    pass->pill[1] = at[1];
    pass->numbered = true;
  }

  /* Last resort: off the cord. */
  if (must && least >= MUCH) move_aside(scene, i);
  if (!pass->numbered) scene->dropped++;
  return pass->numbered
             ? thr_boxes_add(&scene->boxes, pill_box(scene, i, pass->pill), THR_BOX_NUMBER, err)
             : THR_OK;
}

/* Returns whether pass i has an arrow: a copy has few. */
static bool wants_arrow(const thr_scene *scene, int i)
{
  const thr_scene_pass *pass = &scene->pass[i];
  return !thr_scene_is_copy(scene, pass->cord) || (pass->number - 1) % COPY_ARROWS == 0;
}

/* Puts the arrow of pass i where neither a number nor a mark hides it, as far as possible. */
static void place_arrow(thr_scene *scene, int i)
{
  thr_scene_pass *pass = &scene->pass[i];
  double least = HUGE_VAL, at[2],
         length = hypot(pass->to[0] - pass->from[0], pass->to[1] - pass->from[1]);

  /* Short passes have smaller arrows, and very short ones none. */
  pass->arrow_size = fmin(scene->size.arrow, 0.8 * length);
  if (pass->arrow_size < 0.4 * scene->size.arrow || pass->arrow_size < SEEN ||
      !wants_arrow(scene, i))
    pass->arrow_size = 0;
  if (pass->arrow_size == 0) return;

  /* The place that is hidden least. */
  for (int k = 0; k < MAX_PLACES && least > 0; k++) {
    along(pass, ARROW_AT[scene->solid][k], at);
    double hidden =
        thr_boxes_overlap(&scene->boxes, arrow_box(at, 0.9 * pass->arrow_size), TAKEN, least);

    if (hidden >= least) continue;
    least = hidden;
    pass->arrow[0] = at[0];
    pass->arrow[1] = at[1];
  }
}

/* Places numbers and arrows. */
static thr_status place_numbers(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;
  double at[2];

  scene->number_step = choose_step(scene->size.pitch);

  /* Reserve the usual place of every arrow, so that numbers prefer to leave it free. */
  for (int i = 0; i < scene->n_passes && scene->size.arrow >= SEEN && !st; i++) {
    along(&scene->pass[i], ARROW_AT[scene->solid][0], at);
    if (wants_arrow(scene, i))
      st = thr_boxes_add(&scene->boxes, arrow_box(at, scene->size.arrow), THR_BOX_ARROW, err);
  }

  /* Numbers by importance. */
  for (int level = 0; level < 4; level++)
    for (int i = 0; i < scene->n_passes && !st; i++)
      if (importance(scene, i) == level) st = place_number(scene, i, level == 0, err);

  /* Arrows where the numbers left them room. */
  for (int i = 0; i < scene->n_passes && !st; i++)
    place_arrow(scene, i);
  return st;
}

/* ---- names of nodes ---- */

/* Looks for room for the name at point v between its beads: at a share of the angle from each to
 * the next, at so many distances. */
static thr_status place_name(thr_scene *scene, int v, double share, int distances, thr_err *err)
{
  const thr_frame *frame = scene->paper;
  char name[48];

  thr_scene_place_name(scene, v, name);
  double half_width = 0.5 * thr_scene_text_width(name, scene->size.text),
         half_height = 0.42 * scene->size.text;
  int first = frame->first[v], degree = thr_degree(frame, v);

  /* The direction, and half the name's extent along it. */
  for (int i = 0; i < degree; i++) {
    int h = scene->around[first + i], next = scene->around[first + (i + 1) % degree];
    double wide = degree > 1 ? thr_scene_sweep(scene->angle[h], scene->angle[next]) : 6.28,
           off = scene->angle[h] + share * wide;
    double cosine = cos(off), sine = sin(off);

    /* From near to far, up to 0.6 of the pitch. */
    for (int k = 0; k < distances; k++) {
      double distance =
          (0.14 + 0.08 * k) * scene->size.pitch +
          fmin(half_width / fmax(fabs(cosine), 1e-9), half_height / fmax(fabs(sine), 1e-9));

      thr_box box = thr_box_around(scene->at[v][0] + distance * cosine,
                                   scene->at[v][1] + distance * sine, half_width, half_height);
      if (distance > 0.6 * scene->size.pitch + half_width ||
          thr_boxes_overlap(&scene->boxes, box, ~0, 1e-9) > 0)
        continue;

      scene->named[v] = true;
      scene->name_at[v][0] = scene->at[v][0] + distance * cosine;
      scene->name_at[v][1] = scene->at[v][1] + distance * sine;
      return thr_boxes_add(&scene->boxes, box, THR_BOX_NAME, err);
    }
  }

  return THR_OK;
}

/* Places the names of nodes: near the middle between two beads first, then where there is any room.
 * Nodes with two points have been named by seams.c. */
static thr_status place_names(thr_scene *scene, thr_err *err)
{
  static const double share[] = {0.5, 0.5, 0.35, 0.65, 0.2, 0.8};

  /* Names keep off the cords' curves through nodes. */
  thr_status st = scene->layout->node ? THR_OK : thr_scene_box_strands(scene, err);

  for (int k = 0; k < 6; k++)
    for (int v = 0; v < scene->layout->n_points && !st; v++)
      if (scene->twin[v] < 0 && !scene->named[v])
        st = place_name(scene, v, share[k], k ? 9 : 4, err);

  /* Nodes without a name are counted for the legend. */
  scene->nameless = 0;
  for (int v = 0; v < scene->layout->n_nodes; v++)
    scene->nameless += !scene->named[v];
  return st;
}

/* Computes the extent of all boxes, and of the beads at the border. */
static void measure_extent(thr_scene *scene)
{
  scene->extent = (thr_box){0, 0, scene->width, scene->height};
  for (int i = 0; i < scene->boxes.n_boxes; i++)
    thr_box_extend(&scene->extent, scene->boxes.item[i].box);

  double edge = 0.5 * scene->size.bead;
  scene->extent.x0 -= edge;
  scene->extent.y0 -= edge;
  scene->extent.x1 += edge;
  scene->extent.y1 += edge;
}

const char *thr_scene_caption(const thr_scene *scene, int panel)
{
  static const char *const words[3][2] = {{"from the +x end", "from the -x end"},
                                          {"from the +y end", "from the -y end"},
                                          {"from above", "from below"}};
  return words[scene->layout->axis][panel];
}

/* Places a caption over each panel, above everything else. */
static thr_status place_captions(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;
  double top = scene->extent.y0 - 2 * scene->size.text;

  /* Over the panel's middle. */
  for (int panel = 0; panel < 2 && !st; panel++) {
    scene->caption[panel][0] = (scene->layout->middle[panel][0] - scene->origin[0]) * scene->scale;
    scene->caption[panel][1] = top;

    double half_width =
        0.5 * thr_scene_text_width(thr_scene_caption(scene, panel), CAPTION * scene->size.text);
    st = thr_boxes_add(
        &scene->boxes,
        thr_box_around(scene->caption[panel][0], top, half_width, CAPTION * scene->size.text),
        THR_BOX_NAME, err);
  }

  /* The captions are a part of the picture. */
  measure_extent(scene);
  return st;
}

thr_status thr_scene_place_labels(thr_scene *scene, thr_err *err)
{
  /* Grids name their columns and rows instead of nodes. */
  thr_status st = place_numbers(scene, err);
  if (!st && !scene->places.n_columns && scene->size.pitch >= THR_SCENE_NAMED)
    st = place_names(scene, err);

  if (!st) measure_extent(scene);
  return !st && scene->layout->node ? place_captions(scene, err) : st;
}
