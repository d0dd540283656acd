/* Formats of framework files: what a file of graph/io/ says of the format that it reads. */
#ifndef THR_FORMATS_H
#define THR_FORMATS_H

#include "graph/io/scan.h"

/* A new format is one file, with its reader, perhaps its writer, and one of these, and its line in the table of formats.c. */
struct thr_format {
  const char *name;
  const char *ending[3]; /* of files' names, without the dot, NULL after the last; the first is the one that is written */
  /* Does a text of this format begin with such a line? Blank lines and # comments before it are left out. NULL: it is not
   * told by that; what begins like nothing else is CSV. */
  bool (*begins)(thr_span line);
  /* As thr_draft_parse, which clears the draft and the report after a failure. */
  thr_status (*parse)(thr_draft *d, thr_read_report *r, const char *text, size_t n, const char *name, thr_err *err);
  void (*write)(const thr_frame *f, thr_text *out); /* NULL: it is only read */
  bool pairs;                                       /* a second file may hold the edges (thr_csv_parse_pair) */
  bool (*is)(const char *text, size_t n);           /* is the whole text one of this format? NULL: it is not told by that */
};

/* What helps where a graph is in a format that is not read. */
#define THR_GRAPH_ADVICE "which is not read; write GraphML or node-link JSON with networkx or igraph, each node with x, y and z"

/* By the file's name: NULL if that says nothing; THR_EINPUT if it says a format that is not read. */
thr_status thr_format_by_name(const char *name, const thr_format **format, thr_err *err) THR_MUST_CHECK;

/* By the whole text or its first line that says anything: CSV if it is like nothing else. named: what the file's name says, which
 * counts unless the text is plainly of another format; NULL = nothing. THR_EINPUT if the text is of a format that is not read. */
thr_status thr_format_by_text(const char *text, size_t n, const char *name, const thr_format *named, const thr_format **format,
                              thr_err *err) THR_MUST_CHECK;

#endif
