/* What reading a framework merged, dropped or found odd, in words for its user. */
#ifndef THR_NOTES_H
#define THR_NOTES_H

#include "graph/framework/frame.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends a line for each; none where nothing is worth a word. THR_ENOMEM. As thr_frame_near. */
thr_status thr_read_notes(const thr_frame *frame, const thr_read_report *report, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
