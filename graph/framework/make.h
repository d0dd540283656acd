/* Generators of example frameworks. Each appends nodes and edges to an empty draft; lengths in mm. */
#ifndef THR_MAKE_H
#define THR_MAKE_H

#include "graph/framework/frame.h"

typedef enum { THR_MAKE_DOME, THR_MAKE_GEODESIC, THR_MAKE_TUBE, THR_MAKE_SPHERE, THR_MAKE_HONEYCOMB, THR_N_SHAPES } thr_shape;
const char *thr_shape_name(int shape); /* "dome", "geodesic", "tube", "sphere", "honeycomb" */

typedef struct {
  thr_shape shape;
  int size;     /* dome: nodes per side (>= 2); geodesic, sphere: frequency (>= 1); tube: nodes around (>= 3);
                   honeycomb: rings of hexagons (>= 1) */
  int rings;    /* tube: rings of nodes along the axis (>= 2) */
  double pitch; /* mm between neighbouring nodes (dome: in plan; others: nominal), > 0 */
  double rise;  /* dome, honeycomb: height of the crown over the feet as a fraction of the half span, >= 0 */
} thr_make_options;

thr_make_options thr_make_options_default(thr_shape shape);

/* THR_EINPUT with the option's name for a size out of range; at most 2 million nodes. */
thr_status thr_make(thr_draft *draft, const thr_make_options *options, thr_err *err) THR_MUST_CHECK;

#endif
