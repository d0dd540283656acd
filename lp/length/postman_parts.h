/* What the files of the postman share. Private to them. */
#ifndef THR_POSTMAN_PARTS_H
#define THR_POSTMAN_PARTS_H

#include "graph/status.h"
#include "lp/length/postman.h"

/* What the checker, which said found, means of a certificate, in the words of a solver that made it. */
thr_status thr_postman_own_check(thr_status st, const thr_err *found, thr_err *err) THR_MUST_CHECK;

#endif
