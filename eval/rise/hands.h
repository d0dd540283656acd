/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What hands do at the cords while time passes. Only rise.c uses this.
 *
 * Without a schedule all pulled ends have one pull: hands wait until all lies, pull more and more,
 * hold, and let down. With a schedule they take its steps one after the other, those of one "all"
 * together: each time they pull more and more, or let down, to the force of the step, and wait
 * until nothing moves. Between steps the ends of a cord are held where they are, and the cord
 * stretches. */
#ifndef THR_RISE_HANDS_H
#define THR_RISE_HANDS_H

#include "eval/rise/cable.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"

/* The ends of a cord. */
typedef struct {
  bool free[2];              /* nobody has pulled, let down or tied this one yet */
  bool moves[2];             /* in the steps under way */
  double before[2], goal[2]; /* N of hands at ends that move, first and last */
  double wound;              /* mm that hands have drawn in at their rate */
} thr_hands_cord;

typedef struct {
  const thr_rise_structure *structure;
  const thr_rise_options *options;
  thr_cable *cable;     /* [n_cords] borrowed */
  thr_hands_cord *cord; /* [n_cords] */
  thr_friction friction;
  double edge;                            /* mm */
  double settle, full, hold;              /* s */
  double up, down;                        /* s in which the pull changes by a factor e */
  double gentle, most;                    /* N */
  double quiet, patience;                 /* s */
  double still;                           /* mm/s: slower is quiet */
  double closed_since, moved_last, began; /* s; began: the steps under way */
  double ramp;                            /* s that these take */
  int first, next;                        /* the steps under way: [first, next) */
  bool over;
} thr_hands;

/* Begins: nobody pulls yet. scale: by how much everything is slower than with small edges; edge:
 * mean, mm; weight: N. Arrays belong to own. THR_ENOMEM. */
thr_status thr_hands_make(thr_hands *hands, const thr_rise_structure *structure,
                          const thr_rise_options *options, thr_cable *cable, double scale,
                          double edge, double weight, thr_scratch *own,
                          thr_err *err) THR_MUST_CHECK;

/* Refuses what hands cannot do. THR_EINPUT. */
thr_status thr_hands_check(const thr_rise_structure *structure, const thr_rise_options *options,
                           thr_err *err) THR_MUST_CHECK;

/* Sets which ends are pulled at a time, and with what force, for dt s. drawn: [n_cords] mm that
 * each cord has given out since the start. Returns the largest force, N. */
double thr_hands_pull(thr_hands *hands, double time, double dt, const double *drawn);

/* Looks at what has come of it: are all faces closed, and how fast is the fastest piece, mm/s? Goes
 * on to the next steps if these are done. */
void thr_hands_watch(thr_hands *hands, double time, bool closed, double speed);

/* Has all been done? Do hands pull or hold still, not let down? */
bool thr_hands_are_done(const thr_hands *hands, double time);
bool thr_hands_hold(const thr_hands *hands, double time);

/* The part of all that is done, roughly. */
double thr_hands_part(const thr_hands *hands, double time);

#endif
