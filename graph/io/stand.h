/* What a file may leave unsaid: which of its coordinates points up, and how large its numbers are meant. */
#ifndef THR_STAND_H
#define THR_STAND_H

#include "graph/framework/frame.h"
#include "graph/status.h"

/* AUTO: y if the file's maker is known to write that (Blender), else z. */
typedef enum { THR_UP_AUTO, THR_UP_Y, THR_UP_Z } thr_up;
const char *thr_up_name(int up); /* "auto", "y", "z" */

/* Turns the draft so that z points up and multiplies its coordinates and lengths by scale > 0; the report says if y was up,
 * whence that is known, and if it seems to lie. THR_EINPUT if a coordinate or a length leaves the range of numbers. O(nodes +
 * edges). */
thr_status thr_draft_stand(thr_draft *draft, thr_up up, double scale, thr_read_report *report, thr_err *err) THR_MUST_CHECK;

#endif
