/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plan.json as a table of fields, and the request in it. */
#ifndef THR_PLAN_FIELDS_H
#define THR_PLAN_FIELDS_H

#include "graph/plan/plan.h"

/* ---- plan_fields.c: How plan.json is read: members of JSON objects, and what is wrong with them
 * as "file: place: what". */

typedef struct {
  const char *name; /* of the file, or of an object in it as "file: object" */
  thr_status code;  /* THR_EINPUT while the framework is read; a bad index in a cord or a proof is a
                       violation */
  thr_err *err;
  int without;    /* claims that are passed over: a sum of THR_CLAIM_ .. */
  bool in_object; /* name is that of an object: messages are "file: object.member: what" */
  bool all_there; /* a member that may not be left out is missed before anything is read */
} thr_field_reader;

/* Returns the reader of an object, place = "file: object", whose members violate its framework. */
thr_field_reader thr_field_reader_in(const char *place, thr_err *err);

/* All fail with field_reader->code, and leave *out for the caller not to use. */
thr_status thr_field_bad(const thr_field_reader *field_reader, const char *place, const char *what);
thr_status thr_field_need(const thr_field_reader *field_reader, const thr_json *object,
                          const char *key, thr_json_type type,
                          const thr_json **value) THR_MUST_CHECK;
thr_status thr_field_double(const thr_field_reader *field_reader, const thr_json *object,
                            const char *key, double *out) THR_MUST_CHECK;

/* A bound, a price or a part: never negative. */
thr_status thr_field_amount(const thr_field_reader *field_reader, const thr_json *object,
                            const char *key, double *out) THR_MUST_CHECK;

thr_status thr_field_int64_of(const thr_field_reader *field_reader, const thr_json *value,
                              const char *key, int64_t low, int64_t high,
                              int64_t *out) THR_MUST_CHECK;
thr_status thr_field_int64(const thr_field_reader *field_reader, const thr_json *object,
                           const char *key, int64_t low, int64_t high, int64_t *out) THR_MUST_CHECK;
thr_status thr_field_int(const thr_field_reader *field_reader, const thr_json *object,
                         const char *key, int low, int high, int *out) THR_MUST_CHECK;

/* Finds a member that is a list, and returns as many new elements of a size; NULL on failure. The
 * count is set then only, so that what fails later on finds them to release. */
void *thr_field_list(const thr_field_reader *field_reader, const thr_json *object, const char *key,
                     size_t size, int *count, const thr_json **list, thr_status *st) THR_MUST_CHECK;

/* Element i of a list of integers from 0 to limit - 1. place names the list. */
thr_status thr_field_index(const thr_field_reader *field_reader, const thr_json *list, int i,
                           int limit, const char *place, int *out) THR_MUST_CHECK;

/* n of them, all that there are. */
thr_status thr_field_indices(const thr_field_reader *field_reader, const thr_json *list, int n,
                             int limit, const char *place, int *out) THR_MUST_CHECK;

/* A member that this version does not know may be a claim that nobody checked. known ends with
 * NULL. place: of the object, NULL: the reader's own. */
thr_status thr_field_only(const thr_field_reader *field_reader, const thr_json *object,
                          const char *place, const char *const *known) THR_MUST_CHECK;

/* Text that is one of n names; *out is its number. */
thr_status thr_field_name_of(const thr_field_reader *field_reader, const thr_json *value,
                             const char *place, const char *key, int n, const char *(*name)(int),
                             int *out) THR_MUST_CHECK;
thr_status thr_field_name(const thr_field_reader *field_reader, const thr_json *object,
                          const char *place, const char *key, int n, const char *(*name)(int),
                          int *out) THR_MUST_CHECK;

/* ---- Tables of members: from one table an object is both read and written. */

typedef enum {
  THR_FIELD_OTHER,   /* a member that has functions of its own; its row says that it is known */
  THR_FIELD_COUNT,   /* an int from low to high */
  THR_FIELD_WHOLE,   /* an int64_t from low to high */
  THR_FIELD_NUMBER,  /* a finite double */
  THR_FIELD_AMOUNT,  /* a double of at least 0 */
  THR_FIELD_OR_NULL, /* the same; below 0, which is written as null, nothing is said */
  THR_FIELD_TRUTH,   /* a bool */
  THR_FIELD_STATUS,  /* a bool: "optimal" where a bound is attained, else "bound" */
  THR_FIELD_WORD,    /* an enumeration, by its names */
  THR_FIELD_OBJECT   /* members of the same struct, in an object of their own */
} thr_field_kind;

/* A member of an object. Example: {"steps", THR_FIELD_NUMBER, offsetof(thr_record, steps)} */
typedef struct thr_field {
  const char *key; /* NULL ends a table */
  thr_field_kind kind;
  size_t offset;     /* of the value in the struct */
  int64_t low, high; /* both inclusive; high 0: whatever the type holds */
  size_t below;      /* of an int in the struct, which was read before, that is above; 0: none */
  const char *(*name)(int);
  int n_names;                      /* of a word: name(0) .. name(n_names - 1) */
  const struct thr_field *fields;   /* of an object */
  int line;                         /* > 0: begins a new line, with so many blanks */
  bool optional;                    /* left out unless the value is finite and above */
  double unsaid;                    /* this one; what is left out is not changed by reading */
  bool (*when)(const void *object); /* the member is written then only; NULL: always */
  const char *with;  /* it has to be there then, and then only, else it is refused in these words */
  const char *wrong; /* refuses a bad value, NULL: in the words of its kind */
} thr_field;

/* The first member that is in no row; NULL: there is none. */
const char *thr_fields_unknown(const thr_json *object, const thr_field *fields);

/* Reads the members of a table into a struct, row by row, and refuses all others. place: of the
 * object, for messages; NULL: the reader's own. */
thr_status thr_fields_read(const thr_field_reader *field_reader, const thr_json *object,
                           const char *place, const thr_field *fields, void *to) THR_MUST_CHECK;
void thr_fields_write(thr_writer *writer, const thr_field *fields, const void *from);

/* One row of a table, and its value in a struct as a number, of a word its number. */
thr_status thr_field_read(const thr_field_reader *field_reader, const thr_json *object,
                          const char *place, const thr_field *field, void *to) THR_MUST_CHECK;
double thr_field_number(const thr_field *field, const void *from);

/* What plans call a bound that is not attained (0), or one that is (1). */
const char *thr_status_name(int optimal);

/* Tables of a thr_plan and of its certificates. */
extern const thr_field thr_metrics_fields[], thr_turning_claim_fields[], thr_cords_claim_fields[],
    thr_certificate_fields[];

/* The parts of a plan, each with the file it is in; what they have read so far is for
 * thr_plan_destroy to release. */
thr_status thr_plan_read_options(const thr_field_reader *field_reader, const thr_json *doc,
                                 const thr_frame *frame,
                                 thr_request *request) THR_MUST_CHECK; /* request_fields.c */
thr_status thr_plan_read_proofs(const thr_field_reader *field_reader, const thr_json *doc,
                                thr_plan *plan) THR_MUST_CHECK; /* plan_read_proof.c */

/* ---- request_fields.c: The table of a request: every member of `options` in plan.json, with its
 * kind, its range and its place in thr_request. */

typedef enum {
  THR_ASKS_COUNT = THR_FIELD_COUNT,
  THR_ASKS_AMOUNT = THR_FIELD_AMOUNT,
  THR_ASKS_AMOUNT_OR_NULL = THR_FIELD_OR_NULL, /* below 0, it is not asked for */
  THR_ASKS_WORD = THR_FIELD_WORD,
  THR_ASKS_OTHER = THR_FIELD_OTHER /* a shape of its own, with functions that write and read it */
} thr_asks;

/* A request while it is read from `options`. */
typedef struct {
  const thr_field_reader *fields;
  const thr_frame *frame;
  thr_request *request;
} thr_request_reader;

typedef struct {
  const char *key;    /* the member */
  const char *option; /* on the command line; NULL: the key */
  const char
      *in; /* the member of `options` that has it: "turning", "symmetry"; NULL: `options` itself */
  thr_asks kind;
  size_t offset;    /* of the value in thr_request */
  double low, high; /* of a value that is asked for, both inclusive */
  const char *(*name)(int);
  int n_names;              /* of a word: name(0) .. name(n_names - 1) */
  const char *value, *help; /* of the option: what its value is called (NULL: its words), and what
                               it does; help NULL: no option of its own */
  bool tuned;               /* the option is for developers */
  bool always;              /* written, and needed, where it is the default, too */
  void (*write)(thr_writer *writer, const thr_plan *plan);
  thr_status (*read)(thr_request_reader *reader, const thr_json *object);
} thr_request_field;

extern const thr_request_field thr_request_fields[];
extern const int thr_request_n_fields;

/* Writes `options` of a plan: all that was asked for. */
void thr_request_write(thr_writer *writer, const thr_plan *plan);

#endif
