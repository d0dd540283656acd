/* Letter and number places of grid-like pictures: column letters from left to right, row numbers from the bottom up. */
#ifndef THR_PLACES_H
#define THR_PLACES_H

#include "graph/framework/frame.h"
#include "graph/status.h"

/* {0} is valid and means: not a grid, places are called by the nodes' names. Arrays are owned. */
typedef struct {
  int n_columns, n_rows;
  double *x, *y;                   /* [n_columns], [n_rows] mean coordinates, ascending */
  char (*letter)[8], (*number)[8]; /* [n_columns], [n_rows] */
  int *column, *row;               /* [n_nodes] */
} thr_places;

/* Finds the grid in xy[frame->n_nodes] (+y up, median edge length given). Grid-like: coordinates fall into clusters no wider
 * than a tenth of the median, nine of ten edges stay in a row or column, no two nodes share a place, and at least a
 * third of the places is taken; otherwise places is {0}. Names like "C4" that agree with the picture are taken over. O(n log n).
 */
thr_status thr_places_find(thr_places *p, const thr_frame *frame, const double (*xy)[2], double median,
                           thr_err *err) THR_MUST_CHECK;
void thr_places_destroy(thr_places *p);

/* "C4" on a grid, else the node's name, cut to 40 bytes. */
void thr_places_name(const thr_places *p, const thr_frame *frame, int v, char name[48]);

/* What the nodes are called in all documents, in label[n_nodes]: as above, blanks as "_", and names that are there several times
 * with the node's number, "x#17". O(n log n). */
enum { THR_LABEL = 64 };
thr_status thr_places_labels(const thr_places *p, const thr_frame *frame, char (*label)[THR_LABEL], thr_err *err) THR_MUST_CHECK;

#endif
