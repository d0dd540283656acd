/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares what the files of `thread info` share: the options and the making of --motions, and of
 * --turn, which needs no framework. */
#ifndef THR_INFO_PARTS_H
#define THR_INFO_PARTS_H

#include "cli/cli.h"
#include "cli/print/print.h"
#include "eval/rise/turn.h"
#include "graph/framework/frame.h"

/* What was asked of motions. Strings point into argv. */
typedef struct {
  bool wanted;
  const char *held, *cables, *picture, *play;
  int which; /* from 1; 0: not said */
} motion_arguments;

extern const cli_option motion_options[];

/* Returns whether any of the options was given. */
bool motions_asked(const motion_arguments *args);

/* Finds the motions of a framework, which was read from path, writes the picture, and follows the
 * motion that is to be played. frame and args stay while facts are used. Returns EXIT_OK, or prints
 * and returns the code. Release with motions_destroy whatever comes back. */
int motions_find(const char *path, const thr_frame *frame, const motion_arguments *args,
                 motion_facts *facts);
void motions_destroy(motion_facts *facts);

/* What was asked of two pieces on a cord. Strings point into argv. */
typedef struct {
  bool wanted;
  thr_turn_piece piece; /* lengths of 0: not said; tip in degrees */
  const char *plot;
} turn_arguments;

extern const cli_option turn_options[];

/* Prints how far two pieces can turn, in closed form and in simulation, and draws the plot. Returns
 * an exit code. */
int turn_print(const turn_arguments *args);

#endif
