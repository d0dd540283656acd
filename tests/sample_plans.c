/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/sample_plans.h"

#include "symmetry/symmetry.h"
#include "tests/plans.h"

#include <stdio.h>

thr_plan plan_of(thr_frame f, thr_ends ends, int cover)
{
  thr_plan p = plan_simple(&f, ends, cover);
  thr_frame_destroy(&f);
  return p;
}

thr_plan symmetric_plan(thr_frame f, thr_ends ends, int cover, const char *group)
{
  thr_plan p = {0};
  thr_err err = {0};
  thr_limits none = {0};
  thr_request o = options_for(ends, cover);
  want(&o, "overlap,steps");
  snprintf(o.symmetry.group, sizeof o.symmetry.group, "%s", group);
  thr_status st = thr_symmetry_plan(&f, &o, &none, NULL, &p, &err);
  ck_assert_msg(st == THR_OK || (st == THR_ELIMIT && p.n_cords > 0), "%s",
                err.text); /* proved or not */
  thr_frame_destroy(&f);
  return p;
}

/* Takes the framework. */
static thr_plan three_cords(thr_frame f)
{
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.cords = o.cords_least = 3;
  thr_plan p = plan_of_cords(&f, &o);
  thr_frame_destroy(&f);
  return p;
}

thr_plan plan_number(int i)
{
  switch (i) {
  case 0: return plan_of(shape_make(THR_MAKE_DOME, 7, 0), THR_ENDS_FEET, 1);
  case 1: return plan_of(shape_make(THR_MAKE_TUBE, 9, 4), THR_ENDS_CLOSED, 1);
  case 2: return plan_of(shape_make(THR_MAKE_SPHERE, 3, 0), THR_ENDS_CLOSED, 1);
  case 3: return plan_of(shape_make(THR_MAKE_HONEYCOMB, 3, 0), THR_ENDS_ANY, 2);
  case 4: return plan_of(solid_make(DODECAHEDRON), THR_ENDS_CLOSED, 3);
  case 5: return plan_of(triangles_make(3), THR_ENDS_CLOSED, 1);
  case 6: return symmetric_plan(shape_make(THR_MAKE_DOME, 6, 0), THR_ENDS_FEET, 1, "");
  case 7: return symmetric_plan(shape_make(THR_MAKE_DOME, 6, 0), THR_ENDS_FEET, 1, "C4");
  case 8: return symmetric_plan(shape_make(THR_MAKE_TUBE, 8, 4), THR_ENDS_ANY, 1, "");
  case 9: return symmetric_plan(solid_make(CUBE), THR_ENDS_CLOSED, 1, "");
  case 10: return symmetric_plan(solid_make(ICOSAHEDRON), THR_ENDS_ANY, 1, "");
  case 11: return symmetric_plan(shape_make(THR_MAKE_DOME, 5, 0), THR_ENDS_CLOSED, 2, "");
  case 12: return symmetric_plan(solid_make(ICOSAHEDRON), THR_ENDS_CLOSED, 1, "");
  default: return three_cords(shape_make(THR_MAKE_DOME, 6, 0));
  }
}
