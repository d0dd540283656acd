/* Internal to the readers of meshes: faces, which may be named before their nodes are there, and their sides as edges. */
#ifndef THR_FACES_H
#define THR_FACES_H

#include "graph/framework/frame.h"
#include "graph/status.h"

/* Runs of node numbers from 0, each a polygon of three and more or an edge of two. {0} is valid and empty. */
typedef struct {
  int n, n_corners, capacity, corners_capacity;
  int *end;    /* [n] where the run ends in corner; owned */
  int *corner; /* [n_corners]; owned */
} thr_faces;

/* Appends a node to the run that is being written. */
thr_status thr_faces_corner(thr_faces *faces, int node, thr_err *err) THR_MUST_CHECK;
/* Ends that run; one of fewer than two nodes is left out. */
thr_status thr_faces_close(thr_faces *faces, thr_err *err) THR_MUST_CHECK;
/* Both, for a whole run. */
thr_status thr_faces_add(thr_faces *faces, const int *corner, int n, thr_err *err) THR_MUST_CHECK;

/* Appends the sides of all runs to the draft, each different side once (most belong to two faces, which is no oddity to report),
 * in order of first appearance; of two triangles that meet at less than draft->flat not the side between them. THR_EINPUT with
 * the text's name if a run names a node that the draft has not. O(n log n). */
thr_status thr_faces_finish(const thr_faces *faces, thr_draft *draft, const char *name, thr_err *err) THR_MUST_CHECK;

void thr_faces_destroy(thr_faces *faces);

#endif
