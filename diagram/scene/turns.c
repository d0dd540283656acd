/* Turns of the cords: their angles in space, and where sharp ones are marked. */
#include "diagram/scene/boxes.h"
#include "diagram/scene/scene.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

#include <math.h>

enum { MAX_PLACES = 5 };
static const double SHARP_AT[MAX_PLACES] = {0.5, 0.4, 0.6, 0.3, 0.7}; /* along the curve */
static const double SEEN = 0.3;                                       /* mm: smaller signs are not drawn */

double thr_scene_turn_after(const thr_scene *s, int i)
{
  return s->pass[thr_scene_continues(s, i) ? i + 1 : s->first_pass[s->pass[i].cord]].turned;
}

double thr_scene_sharp_size(const thr_scene *s)
{
  return 1.15 * s->size.cord;
}

static void measure_turns(thr_scene *s, int c)
{
  const thr_cord *cord = &s->plan->cord[c];
  int turns = thr_cord_turns(&s->plan->options, cord);
  for (int k = 0; k < cord->n_passes; k++) {
    int next = (k + 1) % cord->n_passes;
    s->pass[s->first_pass[c] + next].turned = k < turns ? thr_turn_angle(s->frame, cord->half[k], cord->half[next]) : -1;
  }
}

/* Marks the turn to pass i on its curve, unless something that is to be read lies everywhere along it. */
static thr_status place_sign(thr_scene *s, int i, thr_err *err)
{
  thr_scene_pass *p = &s->pass[i];
  double half = thr_scene_sharp_size(s);
  for (int k = 0; k < MAX_PLACES; k++) {
    thr_scene_curve_at(thr_scene_turn_start(s, i), p->turn[0], p->turn[1], p->from, SHARP_AT[k], p->sharp_at);
    thr_box box = thr_box_around(p->sharp_at[0], p->sharp_at[1], half, half);
    if (thr_boxes_overlap(&s->boxes, box, THR_BOX_MARK | THR_BOX_NUMBER | THR_BOX_NAME | THR_BOX_TURN, 1e-9) > 0) continue;
    p->sharp = true;
    return thr_boxes_add(&s->boxes, box, THR_BOX_TURN, err);
  }
  return THR_OK;
}

thr_status thr_scene_find_turns(thr_scene *s, thr_err *err)
{
  thr_status st = THR_OK;
  s->turning = true;
  for (int c = 0; c < s->plan->n_cords; c++)
    measure_turns(s, c);
  for (int i = 0; i < s->n_passes && thr_scene_sharp_size(s) >= SEEN && !st; i++)
    if (s->pass[i].number > 1 && thr_turn_over(s->pass[i].turned, THR_SCENE_SHARP)) st = place_sign(s, i, err);
  return st;
}
