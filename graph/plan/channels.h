/* Channels: the ways of the passes through the nodes, that is, with solid joints, through the pieces that a maker holds. */
#ifndef THR_CHANNELS_H
#define THR_CHANNELS_H

#include "graph/plan/plan.h"

/* From which arm to which arm. A channel in which a cord begins or ends has one arm only. */
typedef struct {
  int cord;
  int pass;    /* by which the cord comes in, from 0; -1 = it begins here */
  int in, out; /* half-edges that leave the node: the arms; -1 = none */
  int crosses; /* other channels of the node that it crosses */
} thr_channel;

/* {0} is valid and empty. Arrays are owned. */
typedef struct {
  int *rank;            /* [2 * n_edges] places of half-edges in `around` (thr_channels_around) */
  int *first;           /* [n_nodes + 1] */
  thr_channel *channel; /* those of node v: channel[first[v] .. first[v + 1] - 1], by cord and pass */
  int64_t crossings;    /* pairs of channels that cross, of all nodes */
  int crossed;          /* nodes with such a pair */
} thr_channels;

/* Lists the channels of all nodes. Two channels cross if their four arms are different and lie alternately around the node (see
 * thr_channels_around): no choice of lanes keeps them apart, one has to lie above the other. Where a cord is closed by its plan
 * (thr_cord_turns) the last pass leads on to the first. The cords fit the framework. O(n log n + pairs of channels of a node).
 * Release with thr_channels_destroy. */
thr_status thr_channels_make(thr_channels *channels, const thr_plan *plan, thr_err *err) THR_MUST_CHECK;
void thr_channels_destroy(thr_channels *channels);

/* In around[2 * n_edges] the half-edges that leave each node, as frame->half, but in cyclic order around its normal: the
 * direction in which its arms spread least. On a surface, or nearly so, that is the order in which one sees them; the sense of
 * rotation is that of no side. Arms in one line stand by ascending number. O(n log n). */
thr_status thr_channels_around(const thr_frame *frame, int *around, thr_err *err) THR_MUST_CHECK;

/* Do two channels of a node cross? rank: as in thr_channels. */
bool thr_channels_cross(const int *rank, const thr_channel *a, const thr_channel *b);

#endif
