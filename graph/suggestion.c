/* SPDX-License-Identifier: GPL-3.0-or-later */
/* "Did you mean": which word of those that there are is nearest to what was typed, by letters left
 * out, added, changed or swapped (Damerau & Levenshtein). */
#include "graph/text.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MOST = 63 }; /* letters of words that are compared */

static int least(int a, int b)
{
  return a < b ? a : b;
}

/* Letters left out, added, changed, or swapped with their neighbour. row[i][j]: the first i letters
 * of a and j of b. */
static int distance_of(const char *a, const char *b)
{
  int n = (int)strlen(a), m = (int)strlen(b), row[MOST + 1][MOST + 1];
  if (n > MOST || m > MOST) return n + m;
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= m; j++) {
      if (i == 0 || j == 0) {
        row[i][j] = i + j;
        continue;
      }
      row[i][j] = least(row[i - 1][j - 1] + (a[i - 1] != b[j - 1]),
                        1 + least(row[i - 1][j], row[i][j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[i][j] = least(row[i][j], row[i - 2][j - 2] + 1);
    }
  return row[n][m];
}

void thr_suggestion_try(thr_suggestion *suggestion, const char *candidate)
{
  size_t n = strlen(suggestion->word), m = strlen(candidate);
  int distance =
      strcasecmp(suggestion->word, candidate) == 0 ? 0 : distance_of(suggestion->word, candidate);
  if (3 * distance > (int)(n > m ? n : m) || (suggestion->best && distance >= suggestion->distance))
    return;
  suggestion->best = candidate;
  suggestion->distance = distance;
}

void thr_suggestion_ask(const thr_suggestion *suggestion, char question[THR_SUGGESTION_TEXT])
{
  question[0] = '\0';
  if (suggestion->best)
    snprintf(question, THR_SUGGESTION_TEXT, "; did you mean %.*s?", MOST, suggestion->best);
}
