/* Motions of a framework onto itself, for those who bound what cords cost (tortuosity/proof/orbits.h). Private to planner/. */
#ifndef THR_IMAGES_H
#define THR_IMAGES_H

#include "tortuosity/proof/orbits.h"

/* All of them, if they are not very many: to rounding; or to a ten-thousandth of the framework's size, as coordinates in files
 * are rounded, too. */
thr_orbits_motions thr_planner_motions;
thr_orbits_motions thr_planner_near_motions;

#endif
