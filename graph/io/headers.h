/* Internal to the reader of tables: what the columns of a table mean, by the words in their headers. */
#ifndef THR_HEADERS_H
#define THR_HEADERS_H

#include "graph/io/scan.h"

enum { THR_HEADER_LENGTH = 48 };

/* A header without case, accents, blanks and punctuation ("Node_I" is nodei), and the unit that it names ("X [mm]"), "" if none.
 */
typedef struct {
  char word[THR_HEADER_LENGTH];
  const char *unit;
} thr_header;

thr_header thr_header_of(thr_span field);

/* Returns 0, 1, 2 for x, y, z, in whatever words stand beside the letter; -1 for anything else. */
int thr_header_axis(const thr_header *header);

/* Whether the header means a name or number of nodes; the same for bars. */
bool thr_header_names_nodes(const thr_header *header);
bool thr_header_names_bars(const thr_header *header);

/* Whether the header means nodes where cord ends may come out. */
bool thr_header_feet(const thr_header *header);

/* Whether the header means a text of lines, as geographic systems write them. */
bool thr_header_lines(const thr_header *header);

/* Pairs of words for the two ends of an edge, from 0 on; false after the last one. */
bool thr_header_pair(int pair, const char *word[2]);

/* Whether two headers are alike but for the two words of a pair, and otherwise only say that they are about nodes. */
bool thr_header_ends(const thr_header *a, const thr_header *b, const char *const word[2]);

/* The axis of a coordinate of the end that a word means: 0, 1, 2 for x1, y1, z1 with the word "1"; -1 for anything else. */
int thr_header_end_axis(const thr_header *header, const char *word);

#endif
