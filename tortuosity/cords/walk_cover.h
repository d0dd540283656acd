/* Cords chosen among the walks of a programme that prices cords (tortuosity/cords/walk_programme.h). Internal to tortuosity/.
 *
 * That is a weighted set cover: iterated greedy (R. Ruiz & T. Stuetzle 2007) takes some of the walks out, puts those that serve
 * most for what they cost in their place until every edge has its passes, and goes on from there unless it costs more. */
#ifndef THR_WALK_COVER_H
#define THR_WALK_COVER_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "tortuosity/cords/walk_programme.h"

/* cord[programme->cords]: cords that do, and in their place those that cost least, if fewer with nothing after them. Work is
 * counted. */
thr_status thr_walk_cover(thr_walk_programme *programme, thr_cord *cord, thr_err *err) THR_MUST_CHECK;

#endif
