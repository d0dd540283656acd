/* SPDX-License-Identifier: GPL-3.0-or-later */
/* "did you mean": the word among those that there are which is nearest to what was typed. */
#ifndef THR_THR_SUGGESTION_H
#define THR_THR_SUGGESTION_H

enum { THR_SUGGESTION_TEXT = 96 };

/* {word} is the beginning: no word is near. */
typedef struct {
  const char *word; /* what was typed */
  const char *best; /* borrowed; NULL = none is near */
  int distance;     /* of the best */
} thr_suggestion;

/* Looks at a word that there is. Words that differ only in the case of their letters are as near as
 * can be; else letters left out, added, changed or swapped count (Damerau & Levenshtein), at most
 * one in three of the longer word. Of equally near ones the first stays. O(letters of one x letters
 * of the other). */
void thr_suggestion_try(thr_suggestion *suggestion, const char *candidate);

/* "; did you mean plan?", or "" where none is near. */
void thr_suggestion_ask(const thr_suggestion *suggestion, char question[THR_SUGGESTION_TEXT]);

#endif
