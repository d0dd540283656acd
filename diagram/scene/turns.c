/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the turns of the cords, their angles in space in rad, and where sharp ones are marked on
 * paper: on the curve of the turn, where neither text nor another sign is covered. Turns sharper
 * than THR_SCENE_SHARP, 90 degrees, are sharp. */
#include "diagram/scene/scene.h"

enum { MAX_PLACES = 5 };

static const double SHARP_AT[MAX_PLACES] = {0.5, 0.4, 0.6, 0.3, 0.7}; /* along the curve */
static const double SEEN = 0.3; /* mm: smaller signs are not drawn */

double thr_scene_turn_after(const thr_scene *scene, int i)
{
  return scene->pass[thr_scene_continues(scene, i) ? i + 1 : scene->first_pass[scene->pass[i].cord]]
      .turned;
}

double thr_scene_sharp_size(const thr_scene *scene)
{
  return 1.15 * scene->size.cord;
}

/* Stores the angle of the turn to each pass of cord c; that of a closed cord's first pass closes
 * the cord. -1: there is no turn. */
static void measure_turns(thr_scene *scene, int c)
{
  const thr_cord *cord = &scene->plan->cord[c];
  int turns = thr_cord_turns(&scene->plan->options, cord);

  /* A closed cord has as many turns as passes, an open one a turn less. */
  for (int k = 0; k < cord->n_passes; k++) {
    int next = (k + 1) % cord->n_passes;
    scene->pass[scene->first_pass[c] + next].turned =
        k < turns ? thr_turn_angle(scene->frame, cord->half[k], cord->half[next]) : -1;
  }
}

/* Marks the turn to pass i on its curve, unless all places along the curve are covered by something
 * that is to be read. */
static thr_status place_sign(thr_scene *scene, int i, thr_err *err)
{
  thr_scene_pass *pass = &scene->pass[i];
  double half = thr_scene_sharp_size(scene);

  /* From the middle outwards. */
  for (int k = 0; k < MAX_PLACES; k++) {
    thr_scene_curve_at(thr_scene_turn_start(scene, i), pass->turn[0], pass->turn[1], pass->from,
                       SHARP_AT[k], pass->sharp_at);

    thr_box box = thr_box_around(pass->sharp_at[0], pass->sharp_at[1], half, half);
    if (thr_boxes_overlap(&scene->boxes, box,
                          THR_BOX_MARK | THR_BOX_NUMBER | THR_BOX_NAME | THR_BOX_TURN, 1e-9) > 0)
      continue;

    pass->sharp = true;
    return thr_boxes_add(&scene->boxes, box, THR_BOX_TURN, err);
  }

  return THR_OK;
}

thr_status thr_scene_find_turns(thr_scene *scene, thr_err *err)
{
  thr_status st = THR_OK;

  /* All angles first: drawings colour every turn, also those without a sign. */
  scene->turning = true;
  for (int c = 0; c < scene->plan->n_cords; c++)
    measure_turns(scene, c);

  /* Signs that are large enough to be seen. */
  for (int i = 0; i < scene->n_passes && thr_scene_sharp_size(scene) >= SEEN && !st; i++)
    if (scene->pass[i].number > 1 && thr_turn_over(scene->pass[i].turned, THR_SCENE_SHARP))
      st = place_sign(scene, i, err);
  return st;
}
