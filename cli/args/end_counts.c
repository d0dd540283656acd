/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parses `--ends NAME:N,..`, which says how many cord ends there are at each node, and computes how
 * many cords these are in each component: half as many as ends.
 *
 * Example: `--ends A:2,B:1,C:1` is two cords, if A, B and C are in one component. */
#include "cli/args/args.h"
#include "graph/status.h"
#include "lib/lib.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the node whose name is before the last colon of text[0 .. n - 1], or -1 if there is none;
 * number receives what is after the colon. Names may hold colons themselves: the name of a node as
 * a whole has no number. */
static int counted_node(const thr_frame *frame, const char *text, int n, char number[256])
{
  char word[256], *colon;
  if (n >= (int)sizeof word) return -1;
  snprintf(word, sizeof word, "%.*s", n, text);
  if (thr_frame_find(frame, word) >= 0 || !(colon = strrchr(word, ':'))) return -1;
  snprintf(number, 256, "%s", colon + 1);
  *colon = '\0';
  return thr_frame_find(frame, word);
}

int end_counts_parse(const thr_frame *frame, const char *ends, int *counts)
{
  const char *word = ends, *end, *alone = NULL;
  bool some = false;

  /* Words with commas between them; `alone` is the first one without a number. */
  for (bool more = *ends; more; word = end + 1) {
    char number[256], *rest;
    end = word + strcspn(word, ",");
    more = *end;

    int n = (int)(end - word), v = counted_node(frame, word, n, number);
    if (v < 0) {
      alone = alone ? alone : word;
      continue;
    }

    /* A number for a node that has none yet. */
    long count = strtol(number, &rest, 10);
    some = true;
    if (rest == number || *rest || count < 1 || count > 2 * THR_MOST_CORDS)
      return cli_usage("plan",
                       "--ends %.*s: expected a number of cord ends from 1 to %d after the colon",
                       n, word, 2 * THR_MOST_CORDS);
    if (counts[v]) return cli_usage("plan", "--ends %s: node %s comes twice", ends, frame->name[v]);
    counts[v] = (int)count;
  }

  /* Names without any number are nodes where ends may be; a mixture is refused. */
  if (!some) return -1;
  if (alone)
    return cli_usage(
        "plan",
        "--ends %s: %.*s is no node with a number of cord ends; give every node one, or none", ends,
        (int)strcspn(alone, ","), alone);

  return EXIT_OK;
}

int end_counts_cords(const thr_frame *frame, const int *counts, int *least, int *most)
{
  thr_err err = {0};
  return thr_end_counts_cords(frame, counts, least, most, &err) ? cli_fail(&err) : EXIT_OK;
}
