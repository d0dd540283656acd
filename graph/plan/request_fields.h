/* The table of a request: every member of `options` in plan.json, with its kind, its range and its place in thr_request.
 *
 * From this one table plan.json is written and read (graph/plan/request_fields.c), and `thread plan` takes its options that are
 * numbers or words (cli/args/request_args.c). A new wish that is a number or a word is one row here; what it does is the
 * planner's, and what it means is the checker's.
 *
 *   {"cover", .kind = THR_ASKS_COUNT, AT(cover), .low = 1, .high = 100, .always = true}
 *
 * writes and reads "cover": 2, and makes `--cover 0` a usage error. */
#ifndef THR_REQUEST_FIELDS_H
#define THR_REQUEST_FIELDS_H

#include "graph/plan/plan_fields.h"

#include <stddef.h>

typedef enum {
  THR_ASKS_COUNT,          /* an int */
  THR_ASKS_AMOUNT,         /* a double */
  THR_ASKS_AMOUNT_OR_NULL, /* a double; below 0, which is written as null, it is not asked for */
  THR_ASKS_WORD,           /* an enumeration, by its names */
  THR_ASKS_OTHER           /* a shape of its own, with functions that write and read it */
} thr_asks;

/* A request while it is read from `options`. */
typedef struct {
  const thr_field_reader *fields;
  const thr_frame *frame;
  thr_request *request;
} thr_request_reader;

typedef struct {
  const char *key;    /* the member */
  const char *option; /* on the command line; NULL: the key with dashes for underscores */
  const char *in;     /* the member of `options` that has it: "turning", "symmetry"; NULL: `options` itself */
  thr_asks kind;
  size_t offset;    /* of the value in thr_request */
  double low, high; /* of a value that is asked for, both inclusive */
  const char *(*name)(int);
  int n_names; /* of a word: name(0) .. name(n_names - 1) */
  bool always; /* written, and needed, where it is the default, too */
  void (*write)(thr_writer *writer, const thr_plan *plan);
  thr_status (*read)(thr_request_reader *reader, const thr_json *object);
} thr_request_field;

extern const thr_request_field thr_request_fields[];
extern const int thr_request_n_fields;

/* Returns the row of an option of the command line ("max-length"), or NULL. O(rows). */
const thr_request_field *thr_request_find(const char *option);

/* Returns where the value of a row is in a request: an int, a double or an enumeration. */
void *thr_request_value(thr_request *request, const thr_request_field *field);

/* Writes `options` of a plan: all that was asked for. */
void thr_request_write(thr_writer *writer, const thr_plan *plan);

#endif
