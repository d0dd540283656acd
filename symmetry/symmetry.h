/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objective "symmetry": learn a few paths, repeat them (thesis, chapter 5; docs/method.md).
 * Lists the groups of automorphisms that a framework has, finds the best symmetric threading under
 * each group, and chooses among the threadings.
 *
 * For every group H the best threading is the cover of least (overlap, steps, paths), in the order
 * asked for, among those that H maps to themselves; a step is a pass of a unique path.
 *
 * Read symmetry.c for the whole, then the folders in the order of the work: group/ lists the groups
 * and divides the framework into orbits, cover/ finds passes with the symmetry, and lift/ makes
 * cords of these passes.
 *
 * Example: a square dome under C4v has one path over an eighth of the dome, walked eight times,
 * each time turned or mirrored. */
#ifndef THR_SYMMETRY_H
#define THR_SYMMETRY_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"

enum {
  THR_SYMMETRY_CLASSES = 100, /* of subgroups; a group with more is too large to be listed */
  THR_SYMMETRY_EXTRA =
      16, /* subgroups of a group that is too large, beside those that are isometries */
  THR_SYMMETRY_EXTRA_ORDER = 64
};
extern const double thr_symmetry_near;  /* 0.05: residual up to which an automorphism is called a
                                           mirror, a rotation, .. */
extern const double thr_symmetry_slack; /* 0.10: cord that the default choice may use above the
                                           shortest, as a part of it */

/* One class of conjugate groups, and the best symmetric threading under one of them. */
typedef struct {
  int order;
  int conjugates;        /* groups in its class; 0 = not known */
  int group;             /* its elements are those of this group of the table */
  thr_subgroup elements; /* owned */
  char name[16];         /* point group (Schoenflies), or "" if some element is no isometry within
                            thr_symmetry_near */
  int kinds[THR_ISO_NONE + 1]; /* elements of each kind */
  double
      residual; /* of the element that is farthest from an isometry (symmetry/group/isometry.c) */
  /* THR_OK: best, proved. THR_ELIMIT: not proved, or none found in time (then n_cords = 0).
   * THR_EINFEASIBLE, THR_EINPUT, THR_ESOLVER: none, said why. code 0 and n_cords = 0: not asked
   * for, or left out (behind). */
  thr_err why;
  int behind;  /* number, from 1, of a row that is chosen rather than this one whatever threading it
                  has; 0 = none */
  bool solved; /* the programme was, to the end: if not THR_OK, it proves less than the best */
  double value[THR_N_AIMS], bound[THR_N_AIMS]; /* what the plan has; no threading under the group,
                                                  as plans count, has less with the aims before it
                                                  at these values (symmetry/cover/claims.c) */
  int n_cords;
  int least_copies,
      most_copies; /* cords of a unique path, itself among them: the fewest and the most */
  thr_cord *cord;  /* [n_cords] owned; NULL once a plan has taken them */
  thr_symmetry_record record; /* owned */
  thr_metrics metrics;
  double longest;   /* cord of it, if that is an aim; else 0 */
  int instructions; /* graph/plan/reading.c */
  double pulled;    /* rad, thr_cords_pulled_turning: what the hardest pull has to overcome */
} thr_symmetry_row;

/* A listed group that rows are subgroups of. */
typedef struct {
  thr_group all;
  thr_isometry *isometry; /* [all.order] owned */
} thr_symmetry_group;

typedef struct {
  double mantissa; /* order of the group that the rows are taken from: mantissa * 10^exponent, exact
                      below 10^15 */
  int exponent;
  int node_orbits, edge_orbits; /* under it */
  double keep_lengths[2]; /* with options.symmetry.geometric: mantissa and exponent of the order of
                             the group of automorphisms that keep edge lengths within it, of which
                             the isometries are a part */
  bool listed;            /* the rows are all its subgroups up to conjugacy */
  char note[256];         /* if not: what the rows are */
  int n_groups;
  thr_symmetry_group *group; /* [n_groups] owned */
  int n;
  thr_symmetry_row *row; /* [n] by descending order; users count them from 1; owned */
  double shortest; /* units: cord that the shortest plan needs with these ends and one cord per
                      component (or as many as capacities, or with tube joints anything, ask
                      for), or the plan that keeps to what is asked of cords */
  bool shortest_optimal; /* false: the shortest that was found in time */
  double longest; /* of that plan the longest cord, if that is an aim (INFINITY without the plan);
                     else 0 */
  int chosen;     /* row, -1 = none has a threading */
  bool within; /* it needs at most thr_symmetry_slack more than shortest, as its longest cord than
                  longest */
} thr_symmetries;

/* Groups and threadings for the options' cover, ends and symmetry. Every group is one of
 * automorphisms that keep feet and allowed end nodes. All automorphisms by nauty; if they are more
 * than THR_GROUP_CAP, or have too many subgroups, the isometries within thr_symmetry_near and small
 * groups of one or two of nauty's generators. options.symmetry.geometric: only what isometries
 * within it make, among the automorphisms that keep edge lengths (thr_length_colours).
 * options.symmetry.group: only the rows of that number or name are solved, and the best of them is
 * chosen. Otherwise the default choice: least learned steps among the rows with at most
 * thr_symmetry_slack more cord than the shortest plan, or if there is none the least cord; ties by
 * the longest cord if that is an aim, instructions (graph/plan/reading.c), overlap, cords, turning,
 * number. Threadings keep to the
 * numbers (if options.symmetry.counted) and the largest length of cords that are asked for, as
 * symmetry/lift/keep.c makes them; a row without such a threading has none. Time is shared as
 * symmetry/cover/solve.c says. only_choice: as soon as the choice is proved, rows that are not
 * needed for it are left out. THR_OK: every other row that was asked for is solved. THR_ELIMIT:
 * some are not (their row says so); out holds the rest. THR_EINPUT: no row of that number or name,
 * or numbers of ends are asked for. THR_EINFEASIBLE: no threading with these ends. Otherwise out is
 * empty. */
thr_status thr_symmetries_find(const thr_frame *frame, const thr_request *options, bool only_choice,
                               const thr_limits *limits, thr_symmetries *out,
                               thr_err *err) THR_MUST_CHECK;
void thr_symmetries_destroy(thr_symmetries *symmetries);

/* The plan of a row that has cords, which it takes out of the table: with its record, metrics and,
 * with solid beads, the proof of length for as many cords in every component as are asked for, or
 * else as the component with most has (with tube joints it is the caller's to add), and what that
 * proves of the cords if something is asked of them. THR_OK or THR_ELIMIT (the row is not proved
 * best for its group); otherwise the plan is empty. */
thr_status thr_symmetries_plan(thr_symmetries *symmetries, int row, const thr_frame *frame,
                               const thr_request *options, const thr_limits *limits, thr_plan *plan,
                               thr_err *err) THR_MUST_CHECK;

/* Both, only as far as the choice needs: the plan of the chosen row; table (NULL = not wanted)
 * receives the table, without that row's cords. THR_ELIMIT also if not every row was solved, so
 * that another might be chosen; with an empty plan if no row has a threading yet. */
thr_status thr_symmetry_plan(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, thr_symmetries *table, thr_plan *plan,
                             thr_err *err) THR_MUST_CHECK;

/* The same beside a plan (NULL = none) of the least length, or longest cord, that keeps to what is
 * asked of cords: rows are measured by it. */
thr_status thr_symmetry_plan_from(const thr_frame *frame, const thr_request *options,
                                  const thr_plan *shortest, const thr_limits *limits,
                                  thr_symmetries *table, thr_plan *plan,
                                  thr_err *err) THR_MUST_CHECK;

/* The row with exactly `cords` cords in every component whose cord that turns most turns least; -1
 * = none. */
int thr_symmetries_even(const thr_symmetries *symmetries, int cords);

#endif
