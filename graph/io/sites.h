/* Internal to the readers of formats whose lines and faces repeat coordinates: points at exactly one place are one node. */
#ifndef THR_SITES_H
#define THR_SITES_H

#include "graph/framework/frame.h"
#include "graph/status.h"

/* {0} is valid and empty. */
typedef struct {
  int n, capacity;
  double (*xyz)[3]; /* owned; never -0, so that equal places are equal bytes */
} thr_sites;

thr_status thr_sites_add(thr_sites *sites, const double xyz[3], thr_err *err) THR_MUST_CHECK;

/* Appends each different place to the draft as a node, in order of first appearance; node[i] receives that of site i. THR_EINPUT
 * if a coordinate is out of range. O(n log n). */
thr_status thr_sites_finish(const thr_sites *sites, int *node, thr_draft *draft, thr_err *err) THR_MUST_CHECK;

void thr_sites_destroy(thr_sites *sites);

#endif
