/* Which end of a cord is pulled. */
#ifndef THR_PULLED_H
#define THR_PULLED_H

typedef enum { THR_PULL_START, THR_PULL_END, THR_PULL_BOTH, THR_PULL_NONE, THR_N_PULLS } thr_pull;

const char *thr_pull_name(thr_pull p); /* "start", "end", "both", "none" */

/* The one with this name, or -1; NULL has none. */
int thr_pull_named(const char *name);

#endif
