/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frameworks on which searches have been slow: hubs, dense graphs, long trees, many components,
 * symmetric meshes. */
#ifndef THR_WATCHDOG_FRAMES_H
#define THR_WATCHDOG_FRAMES_H

#include <stdbool.h>

/* Number of frameworks, and what each is called. */
int watchdog_frames(void);
const char *watchdog_frame_name(int i);

/* The first of its size: a wrong step shows within the time limit on every one, on these within a
 * selection's. */
bool watchdog_frame_selected(int i);

/* Writes framework i as OBJ lines; false if it cannot be written. */
bool watchdog_frame_write(int i, const char *path);

#endif
