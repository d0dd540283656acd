/* Joints that were measured before, one small text file each in a folder. A file that is corrupt, truncated, of another key or
 * unreadable counts as absent: it is measured again. Private to eval/. */
#ifndef THR_CACHE_H
#define THR_CACHE_H

#include "eval/joint/drag.h"
#include "graph/text.h"

/* Everything that a measurement depends on, in plain text: the protocol, Bullet's version, and all of drag (n_turns must be 1).
 */
void thr_cache_key(const thr_drag *drag, thr_text *key);

/* A file's contents: the key, the values with as many digits as reading them back exactly needs, and a checksum. */
void thr_cache_write(const thr_text *key, const thr_drag_result *result, thr_text *out);

/* Reads n bytes back. False, and *out unchanged, unless they are exactly what thr_cache_write makes of this key and some finite
 * result. */
bool thr_cache_parse(const char *text, size_t n, const thr_text *key, thr_drag_result *out);

/* False if the folder holds no sound file for drag. */
bool thr_cache_load(const char *folder, const thr_drag *drag, thr_drag_result *out);

/* Makes the folder if need be and writes the file whole or not at all. THR_EIO if it cannot; THR_EINPUT for a result that is not
 * finite. */
thr_status thr_cache_store(const char *folder, const thr_drag *drag, const thr_drag_result *result, thr_err *err) THR_MUST_CHECK;

#endif
