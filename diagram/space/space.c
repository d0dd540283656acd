/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prepares pictures of steps in space: the plan's passes by edge, the framework's size, and what a
 * camera is asked to show. */
#include "diagram/space/space.h"

#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_space_destroy(thr_space *space)
{
  free(space->half);
  free(space->cord);
  free(space->first_on);
  free(space->on);
  *space = (thr_space){0};
}

/* Finds the median edge, which is the pitch of pictures in space, and the mean of the nodes. */
static thr_status measure(thr_space *space, thr_err *err)
{
  const thr_frame *frame = space->f;

  /* The median needs a sorted copy. */
  double *length = thr_calloc((size_t)frame->n_edges, sizeof *length);
  if (!length) return thr_nomem(err);
  memcpy(length, frame->length, (size_t)frame->n_edges * sizeof *length);
  thr_sort_doubles(length, (size_t)frame->n_edges);

  /* A framework whose median edge has no length gets any pitch. */
  space->pitch = length[frame->n_edges / 2] > 0 ? length[frame->n_edges / 2] : 1;
  free(length);

  /* The mean of the nodes stands for the inside of a framework that is no shell. */
  for (int v = 0; v < frame->n_nodes; v++)
    for (int k = 0; k < 3; k++)
      space->middle[k] += frame->xyz[v][k] / frame->n_nodes;
  return THR_OK;
}

/* Lists the passes cord by cord, and by edge (a counting sort). */
static void collect(thr_space *space)
{
  int i = 0;

  /* first_on[e + 2] counts the passes on edge e. */
  for (int c = 0; c < space->plan->n_cords; c++)
    for (int k = 0; k < space->plan->cord[c].n_passes; k++, i++) {
      space->half[i] = space->plan->cord[c].half[k];
      space->cord[i] = c;
      space->first_on[(space->half[i] >> 1) + 2]++;
    }

  /* first_on[e + 1] becomes the place of the first pass on edge e. */
  for (int e = 0; e < space->f->n_edges; e++)
    space->first_on[e + 2] += space->first_on[e + 1];

  /* Fill; each place moves to the next one of its edge. */
  for (i = 0; i < space->n_passes; i++)
    space->on[space->first_on[(space->half[i] >> 1) + 1]++] = i;
}

thr_status thr_space_make(thr_space *space, const thr_plan *plan, const char (*label)[THR_LABEL],
                          const double (*outward)[3], thr_err *err)
{
  *space = (thr_space){.plan = plan,
                       .f = &plan->frame,
                       .label = label,
                       .outward = outward,
                       .solid = plan->options.joint == THR_JOINT_SOLID};

  thr_status st = thr_scene_check_cords(plan, &space->n_passes, err);
  if (st) return st;

  /* The passes cord by cord, and by edge. */
  space->half = thr_calloc((size_t)space->n_passes, sizeof *space->half);
  space->cord = thr_calloc((size_t)space->n_passes, sizeof *space->cord);
  space->on = thr_calloc((size_t)space->n_passes, sizeof *space->on);
  space->first_on = thr_calloc((size_t)space->f->n_edges + 2, sizeof *space->first_on);
  if (!space->half || !space->cord || !space->on || !space->first_on) return thr_nomem(err);

  collect(space);
  return measure(space, err);
}

int thr_space_half(const thr_space *space, const thr_crop *crop, int i)
{
  return space->half[i] ^ crop->backward;
}

/* Computes the direction to the outside at a pass, a unit vector or 0: on a shell the mean of its
 * nodes' directions, else the direction from the middle of all nodes to the pass. */
static void find_outward(const thr_space *space, int h, double outward[3])
{
  int tail = thr_tail(space->f, h), head = thr_head(space->f, h);
  for (int k = 0; k < 3; k++)
    outward[k] = space->outward
                     ? space->outward[tail][k] + space->outward[head][k]
                     : 0.5 * (space->f->xyz[tail][k] + space->f->xyz[head][k]) - space->middle[k];

  /* Too short a vector says nothing. */
  double length = sqrt(thr_dot(outward, outward)),
         least = space->outward ? 1e-6 : 1e-3 * space->pitch;
  for (int k = 0; k < 3; k++)
    outward[k] = length > least ? outward[k] / length : 0;
}

/* Computes the vector along a half-edge. */
static void find_along(const thr_frame *frame, int h, double along[3])
{
  const double *from = frame->xyz[thr_tail(frame, h)], *to = frame->xyz[thr_head(frame, h)];
  thr_between(from, to, along);
}

/* Adds the planes that a pass spans with the other edges at its ends. */
static void add_planes(const thr_space *space, int h, thr_camera_scene *scene)
{
  const thr_frame *frame = space->f;
  for (int end = 0; end < 2; end++) {
    const int own = h ^ end, v = thr_tail(frame, own);
    double along[3], other[3], normal[3];
    find_along(frame, own, along);

    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      if (frame->half[i] == own || scene->n_planes == THR_CAMERA_PLANES) continue;
      find_along(frame, frame->half[i], other);
      thr_cross(along, other, normal);

      /* Edges that go on straight span none. */
      const double size = sqrt(thr_dot(normal, normal)),
                   most = sqrt(thr_dot(along, along) * thr_dot(other, other));
      if (size < 0.1 * most || !(most > 0)) continue;
      for (int k = 0; k < 3; k++)
        scene->plane[scene->n_planes][k] = normal[k] / size;
      scene->n_planes++;
    }
  }
}

/* Describes what a camera is to show of a step: its passes in the direction of the needle. */
static void camera_scene(const thr_space *space, const thr_crop *crop, thr_camera_scene *scene)
{
  /* Steps have fewer passes than a camera takes. */
  scene->n = crop->n_now < THR_CAMERA_PASSES ? crop->n_now : THR_CAMERA_PASSES;
  scene->pitch = space->pitch;
  scene->shell = space->outward != NULL;
  scene->n_planes = 0;

  for (int i = 0; i < scene->n; i++) {
    int h = thr_space_half(space, crop, crop->now[i]);
    memcpy(scene->from[i], space->f->xyz[thr_tail(space->f, h)], sizeof scene->from[i]);
    memcpy(scene->to[i], space->f->xyz[thr_head(space->f, h)], sizeof scene->to[i]);
    find_outward(space, h, scene->outward[i]);
    if (!scene->shell) add_planes(space, h, scene);
  }
}

bool thr_space_legible(const thr_space *space, const thr_crop *crop, const double room[2],
                       int *first)
{
  thr_camera_scene scene;
  camera_scene(space, crop, &scene);
  return thr_camera_legible(&scene, room, first);
}

thr_camera_view thr_space_fit(const thr_space *space, const thr_crop *crop, const double room[2])
{
  thr_camera_scene scene;
  camera_scene(space, crop, &scene);
  return thr_camera_choose(&scene, room);
}
