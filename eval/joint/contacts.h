/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves one step of rigid bodies in contact, with the friction of limit analysis, as a convex
 * problem.
 *
 * The impulse of each contact lies in its cone, and what slides opens by mu times its slide: so the
 * velocities after the step are, of all that no contact forbids, those nearest to what they would
 * be without contacts (M. Anitescu & A. Tasora 2010),
 *
 *   minimize 1/2 d^T M d  so that  J d - t lies in the cones' duals,
 *
 * d: what contacts change of the velocities. By an augmented Lagrangian (R. T. Rockafellar 1976),
 * whose problem without constraints Newton's method solves; its impulses go on from those of the
 * last step, mostly the answer already. So a structure that stands has no velocity, however hard
 * its faces are pressed; iterations contact by contact leave some there.
 *
 * Example: a box of mass 1 that would fall at 0.06 within the step, on one contact: t = 0.06
 * upwards, the impulse is 0.06. */
#ifndef THR_CONTACTS_H
#define THR_CONTACTS_H

#ifdef __cplusplus
extern "C" {
#endif

#include "graph/status.h"

typedef struct thr_contacts thr_contacts;

/* A contact point of two bodies. */
typedef struct {
  int body[2];              /* -1: what does not move */
  double jacobian[3][2][6]; /* velocities along the normal and two directions across it, of either
                               body's velocity and spin */
  double target[3];         /* that contacts are to change these by, or more of the first */
  double mu;
  double impulse[3]; /* to begin with; then the answer */
} thr_cone_contact;

thr_status thr_contacts_create(thr_contacts **cones, thr_err *err) THR_MUST_CHECK;
void thr_contacts_destroy(thr_contacts *cones);

/* Computes the impulses of all contacts. mass[n_bodies]: mass and moment of inertia. No velocity is
 * wrong by more than still, but after `most` linear systems it is what it is. Faster when the same
 * bodies touch as the last time. */
thr_status thr_contacts_solve(thr_contacts *cones, int n_bodies, const double (*mass)[2],
                              int n_contacts, thr_cone_contact *contact, double still, int most,
                              thr_err *err) THR_MUST_CHECK;

#ifdef __cplusplus
}
#endif

#endif
