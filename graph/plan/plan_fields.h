/* How plan.json is read: members of JSON objects, and what is wrong with them as "file: place: what". Private to
 * graph/plan_read*.c.
 */
#ifndef THR_PLAN_FIELDS_H
#define THR_PLAN_FIELDS_H

#include "graph/plan/plan.h"

typedef struct {
  const char *name; /* of the file, for messages */
  thr_status code;  /* THR_EINPUT while the framework is read; a bad index in a cord or a proof is a violation */
  thr_err *err;
  int without; /* claims that are passed over: a sum of THR_CLAIM_ .. */
} thr_field_reader;

/* All fail with field_reader->code, and leave *out for the caller not to use. */
thr_status thr_field_bad(const thr_field_reader *field_reader, const char *place, const char *what);
thr_status thr_field_need(const thr_field_reader *field_reader, const thr_json *object, const char *key, thr_json_type type,
                          const thr_json **value) THR_MUST_CHECK;
thr_status thr_field_double(const thr_field_reader *field_reader, const thr_json *object, const char *key,
                            double *out) THR_MUST_CHECK;

/* A bound, a price or a part: never negative. */
thr_status thr_field_amount(const thr_field_reader *field_reader, const thr_json *object, const char *key,
                            double *out) THR_MUST_CHECK;

/* A number >= 0, or null, which is -1. */
thr_status thr_field_or_null(const thr_field_reader *field_reader, const thr_json *object, const char *key,
                             double *out) THR_MUST_CHECK;
thr_status thr_field_int64(const thr_field_reader *field_reader, const thr_json *object, const char *key, int64_t low,
                           int64_t high, int64_t *out) THR_MUST_CHECK;
thr_status thr_field_int(const thr_field_reader *field_reader, const thr_json *object, const char *key, int low, int high,
                         int *out) THR_MUST_CHECK;

/* Element i of a list of integers from 0 to limit - 1. place names the list. */
thr_status thr_field_index(const thr_field_reader *field_reader, const thr_json *list, int i, int limit, const char *place,
                           int *out) THR_MUST_CHECK;

/* n of them, all that there are. */
thr_status thr_field_indices(const thr_field_reader *field_reader, const thr_json *list, int n, int limit, const char *place,
                             int *out) THR_MUST_CHECK;

/* A member that this version does not know may be a claim that nobody checked. known ends with NULL. */
thr_status thr_field_only(const thr_field_reader *field_reader, const thr_json *object, const char *place,
                          const char *const *known) THR_MUST_CHECK;

/* Text that is one of n names; *out is its number. */
thr_status thr_field_name_of(const thr_field_reader *field_reader, const thr_json *value, const char *place, const char *key,
                             int n, const char *(*name)(int), int *out) THR_MUST_CHECK;
thr_status thr_field_name(const thr_field_reader *field_reader, const thr_json *object, const char *place, const char *key, int n,
                          const char *(*name)(int), int *out) THR_MUST_CHECK;

/* The parts of a plan, each with the file it is in; what they have read so far is for thr_plan_destroy to release. */
thr_status thr_plan_read_options(const thr_field_reader *field_reader, const thr_json *doc, const thr_frame *frame,
                                 thr_request *request) THR_MUST_CHECK; /* request_fields.c */
thr_status thr_plan_read_proofs(const thr_field_reader *field_reader, const thr_json *doc,
                                thr_plan *plan) THR_MUST_CHECK; /* plan_read_proof.c */

#endif
