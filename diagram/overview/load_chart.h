/* The picture of what a structure carries: load against pull. `thread eval --load .. --plot`. */
#ifndef THR_LOAD_CHART_H
#define THR_LOAD_CHART_H

#include "graph/plan/physics.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdbool.h>

/* At a pull of all ends. */
typedef struct {
  double pull;       /* N */
  bool decided;      /* else the rest is not known */
  double carried;    /* times the load: an equilibrium exists; 0 if it does not stand as it is */
  double beyond;     /* times the load: above it there is none; 0 if it does not stand as it is */
  const char *first; /* name of the piece that moves first then; borrowed */
} thr_load_mark;

typedef struct {
  const char *load;           /* in words, as it was asked for; borrowed */
  const thr_physics *physics; /* resolved */
  int n;
  const thr_load_mark *mark; /* [n] by ascending pull; borrowed */
} thr_load_chart;

/* Appends the picture to svg: times the load over the pull (its logarithm), the line of what is carried, a pale band up to what
 * is too much, at each pull a circle <circle id="point-1"> with the piece that moves first; below them a table. Sizes are
 * physical (mm); no text is under 7 pt. The same points give the same bytes. THR_EINPUT without a pull that is decided. svg is
 * unchanged on failure. O(n). */
thr_status thr_load_svg(const thr_load_chart *chart, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
