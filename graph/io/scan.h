/* Internal to the readers: lines, words and numbers of text formats, node names. */
#ifndef THR_SCAN_H
#define THR_SCAN_H

#include "graph/io/read.h"

/* Part of a text that somebody else owns; not NUL-terminated and without NUL bytes. */
typedef struct {
  const char *s;
  size_t n;
} thr_span;

typedef struct {
  const char *name;     /* of the text, for messages */
  const char *at, *end; /* what is left */
  int line, next;       /* number of the line given last, from 1, and of the one after it */
} thr_scan;

/* Starts at the text's first line, after a byte-order mark. THR_EINPUT if the text has NUL bytes. */
thr_status thr_scan_start(thr_scan *scan, const char *text, size_t n, const char *name, thr_err *err) THR_MUST_CHECK;
/* Next line without its end (LF, CRLF or CR); false at the end of the text. */
bool thr_scan_line(thr_scan *scan, thr_span *line);
/* Makes line longer by the line after it; scan->line stays. False at the end of the text. */
bool thr_scan_extend(thr_scan *scan, thr_span *line);
/* THR_EINPUT with "name:line: " before the text. */
thr_status thr_scan_fail(const thr_scan *scan, thr_err *err, const char *format, ...) THR_PRINTF(3, 4);

thr_span thr_span_of(const char *s);
thr_span thr_span_trim(thr_span t);                  /* without blanks at both ends */
thr_span thr_span_word(thr_span *rest);              /* takes the first word off, as far as a blank; n is 0 if there is none */
bool thr_span_is(thr_span t, const char *word);      /* equal but for ASCII case */
bool thr_span_same(thr_span a, thr_span b);          /* the same of two spans */
bool thr_span_starts(thr_span t, const char *start); /* case counts */
int thr_span_width(thr_span t);                      /* for "%.*s" in messages: at most 40 bytes */

/* A decimal number that is finite; -0 becomes 0 (writers do not tell them apart). decimal_comma: "1,5" is 1.5. */
bool thr_span_number(thr_span t, bool decimal_comma, double *x);
/* Whether a text says yes, in the words for it of a few languages or as a number; nothing at all is no. False if it says neither.
 */
bool thr_span_truth(thr_span t, bool *yes);
/* The same with a point, also as Fortran writes it: 1.5D+00. */
bool thr_span_real(thr_span t, double *x);
/* A decimal integer; beyond int it saturates. */
bool thr_span_int(thr_span t, int *x);

/* Node numbers by name. {0} is valid and empty. Valid as long as the draft's nodes stay. */
typedef struct {
  int n;
  struct thr_named {
    const char *name;
    int node;
  } * entry; /* by name; owned */
} thr_names;

/* Every node of the draft needs a name; THR_EINPUT if two have the same. O(n log n). */
thr_status thr_names_build(thr_names *names, const thr_draft *draft, const char *file, thr_err *err) THR_MUST_CHECK;
int thr_names_find(const thr_names *names, thr_span name); /* -1 if there is none. O(log n) */
void thr_names_destroy(thr_names *names);

/* Counts a record that is known or harmless but not used. */
void thr_report_skip(thr_read_report *report, thr_span keyword);

/* Takes the unit of length that a comment names, if it names one (thr_units_in_comment); the comment is without the sign that
 * begins it. THR_EINPUT if it says "units:" before something else than a unit. */
thr_status thr_scan_units(const thr_scan *scan, thr_span comment, thr_draft *draft, thr_err *err) THR_MUST_CHECK;

/* The words of a text whose lines say little. A comment, from # to the end of its line, is left out, what it says of units taken.
 * Begin with draft and err, then thr_scan_start on scan. */
typedef struct {
  thr_scan scan;
  thr_span line; /* what is left of the current line */
  thr_draft *draft;
  thr_err *err;
  thr_status status; /* of the comments */
} thr_words;

/* Moves to the next line; false at the end of the text and where a comment is wrong, which is in status then. */
bool thr_words_line(thr_words *words);
/* The next word; n is 0 where thr_words_line is false. */
thr_span thr_words_next(thr_words *words);
/* status, or THR_EINPUT with the line and what is wrong. */
thr_status thr_words_fail(const thr_words *words, const char *what);
/* The next word as a number of things or of a thing, from 0. */
thr_status thr_words_count(thr_words *words, int *n) THR_MUST_CHECK;

/* CSV with word of what the table lacks, so that the other half of a pair can be looked for. */
typedef enum { THR_CSV_WHOLE, THR_CSV_NODES_ONLY, THR_CSV_EDGES_ONLY } thr_csv_content;
thr_status thr_csv_scan(thr_draft *draft, thr_read_report *report, const char *text, size_t n, const char *name,
                        thr_csv_content *content, thr_err *err) THR_MUST_CHECK;

/* The writers of write.c and dxf.c. */
void thr_json_frame_write(const thr_frame *frame, thr_text *out);
void thr_obj_write(const thr_frame *frame, thr_text *out);
void thr_csv_write(const thr_frame *frame, thr_text *out);
void thr_dxf_write(const thr_frame *frame, thr_text *out);

#endif
