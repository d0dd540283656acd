/* Internal to the readers: the parts of a file that have names of their own, of which one may be asked for (--pick). First all
 * are named, then thr_parts_choose, then what belongs to a part that is not chosen is left out. */
#ifndef THR_PARTS_H
#define THR_PARTS_H

#include "graph/io/scan.h"

/* Begin with {.asked = draft->pick}. Where nothing is asked for nothing is kept, and every part is chosen. */
typedef struct {
  const char *asked; /* the name of a part, or its number from 1 in the order of the file; NULL = all of them; borrowed */
  thr_text names;    /* each with its NUL; owned */
  int n, n_chosen;
  bool *chosen; /* [n] owned */
} thr_parts;

/* Adds a part; its number, from 0, in *part. */
thr_status thr_parts_add(thr_parts *parts, thr_span name, int *part, thr_err *err) THR_MUST_CHECK;

/* The same of a part that may be known already, like the layer of a line. O(parts). */
thr_status thr_parts_find(thr_parts *parts, thr_span name, int *part, thr_err *err) THR_MUST_CHECK;

/* The parts of the name that is asked for; if none has it, the one of that number. THR_EINPUT if there is none: "file: there is
 * no layer 'dome'; did you mean Dome? there are: Dome, Feet". what: one of them, many: some of them. */
thr_status thr_parts_choose(thr_parts *parts, const char *file, const char *what, const char *many, thr_err *err) THR_MUST_CHECK;

static inline bool thr_parts_has(const thr_parts *parts, int part)
{
  return !parts->asked || (part >= 0 && part < parts->n && parts->chosen[part]);
}

/* How many there are and were read, for the notes; then releases everything. */
void thr_parts_finish(thr_parts *parts, thr_read_report *report);

#endif
