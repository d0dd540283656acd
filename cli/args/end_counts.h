/* `--ends NAME:N,..`: how many cord ends there are at each node. */
#ifndef THR_CLI_END_COUNTS_H
#define THR_CLI_END_COUNTS_H

#include "graph/framework/frame.h"

/* Reads "A:2,B:1" into counts[n_nodes]. Returns -1 if no node comes with a number; EXIT_OK; or prints what is wrong and returns
 * the exit code. */
int end_counts_parse(const thr_frame *frame, const char *ends, int *counts);

/* Finds the least and the most number of cords of any component that these ends make. Returns EXIT_OK, or prints and returns the
 * exit code if some component has no end or an odd number of them. */
int end_counts_cords(const thr_frame *frame, const int *counts, int *least, int *most);

#endif
