/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the places of grid-like pictures, whose columns have letters and whose rows have numbers,
 * and the names of nodes in all documents.
 *
 * A framework is grid-like on paper if its x and its y coordinates fall into narrow clusters and
 * almost all edges stay in a row or in a column. If its nodes are named so, too, as on a chessboard
 * ("C4"), columns and rows are marked at the picture's rim. A place has one name everywhere, on
 * paper and on screen: that of its node in the file, or its number. */
#include "diagram/scene/scene.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINES = 700 }; /* columns up to "ZZ" */

void thr_places_destroy(thr_places *places)
{
  free(places->x);
  free(places->y);
  free(places->letter);
  free(places->number);
  free(places->column);
  free(places->row);
  *places = (thr_places){0};
}

/* Clusters one coordinate: line[v] = cluster of node v, centre[]: means of the clusters. A gap of a
 * quarter of the median starts a new cluster. Returns how many, or 0 if a cluster is wider than a
 * tenth of the median or there are too many. O(n log n). */
static int cluster(const double (*xy)[2], int n, int axis, double median, thr_ranked *ranked,
                   int *line, double *centre)
{
  for (int v = 0; v < n; v++)
    ranked[v] = (thr_ranked){xy[v][axis], v};
  thr_sort_ranked(ranked, (size_t)n);

  /* Walk through the sorted coordinates; each cluster ends at a gap. */
  int count = 0;
  for (int i = 0; i < n;) {
    int from = i;
    double sum = 0;
    if (count == MAX_LINES) return 0;

    /* The sum of differences keeps its digits far from the origin. */
    do {
      sum += ranked[i].key - ranked[from].key;
      line[ranked[i].index] = count;
      i++;
    } while (i < n && ranked[i].key - ranked[i - 1].key <= 0.25 * median);

    if (ranked[i - 1].key - ranked[from].key > 0.1 * median) return 0;
    centre[count++] = ranked[from].key + sum / (i - from);
  }

  return count;
}

/* Returns whether nine of ten edges go along a row or a column, and no two nodes share a place.
 * taken: [rows x columns] zeros. */
static bool grid_like(const thr_places *places, const thr_frame *frame, bool *taken)
{
  /* Edges along a row or a column. */
  int along = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    int tail = frame->edge[e][0], head = frame->edge[e][1];
    along += places->column[tail] == places->column[head] || places->row[tail] == places->row[head];
  }

  /* Places with two nodes. */
  for (int v = 0; v < frame->n_nodes; v++) {
    bool *place = &taken[places->row[v] * places->n_columns + places->column[v]];
    if (*place) return false;
    *place = true;
  }

  return along * 10L >= frame->n_edges * 9L;
}

/* Splits "AB12" into letters and digits. Returns false for anything else, or for more than 7 bytes
 * of either. */
static bool split_name(const char *name, char letter[8], char number[8])
{
  size_t n_letters = strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZ"),
         n_digits = strspn(name + n_letters, "0123456789");
  if (!n_letters || !n_digits || n_letters > 7 || n_digits > 7 || name[n_letters + n_digits])
    return false;

  memcpy(letter, name, n_letters);
  letter[n_letters] = '\0';
  memcpy(number, name + n_letters, n_digits + 1);
  return true;
}

/* Takes letters and numbers from the nodes' names. Returns false unless every name agrees with the
 * other names in its column and in its row. */
static bool take_names(thr_places *places, const thr_frame *frame)
{
  for (int v = 0; v < frame->n_nodes; v++) {
    char letter[8], number[8], *column_letter = places->letter[places->column[v]],
                               *row_number = places->number[places->row[v]];

    if (!frame->name || !frame->name[v] || !split_name(frame->name[v], letter, number))
      return false;

    /* The column's letter and the row's number are those of the first node there. */
    if ((*column_letter && strcmp(column_letter, letter) != 0) ||
        (*row_number && strcmp(row_number, number) != 0))
      return false;
    snprintf(column_letter, 8, "%s", letter);
    snprintf(row_number, 8, "%s", number);
  }

  return true;
}

/* Allocates for n nodes. On failure places may be half made. */
static thr_status allocate(thr_places *places, int n, thr_err *err)
{
  size_t lines = n < MAX_LINES ? (size_t)n : MAX_LINES;

  /* There are no more columns or rows than nodes. */
  places->x = thr_calloc(lines, sizeof *places->x);
  places->y = thr_calloc(lines, sizeof *places->y);
  places->letter = thr_calloc(lines, sizeof *places->letter);
  places->number = thr_calloc(lines, sizeof *places->number);
  places->column = thr_calloc((size_t)n, sizeof *places->column);
  places->row = thr_calloc((size_t)n, sizeof *places->row);

  return places->x && places->y && places->letter && places->number && places->column && places->row
             ? THR_OK
             : thr_nomem(err);
}

thr_status thr_places_find(thr_places *out, const thr_frame *frame, const double (*xy)[2],
                           double median, thr_err *err)
{
  thr_places places = {0};
  bool found = false, *taken = NULL;
  thr_ranked *ranked = thr_calloc((size_t)frame->n_nodes, sizeof *ranked);
  thr_status st = ranked ? allocate(&places, frame->n_nodes, err) : thr_nomem(err);
  if (st) goto done;

  /* Columns and rows; at least a third of the places must be taken. */
  places.n_columns = cluster(xy, frame->n_nodes, 0, median, ranked, places.column, places.x);
  places.n_rows = places.n_columns > 1
                      ? cluster(xy, frame->n_nodes, 1, median, ranked, places.row, places.y)
                      : 0;
  if (places.n_rows < 2 || (long)places.n_rows * places.n_columns > 3L * frame->n_nodes) goto done;

  /* One node at most in each place. */
  taken = thr_calloc((size_t)places.n_rows * (size_t)places.n_columns, sizeof *taken);
  if (!taken) {
    st = thr_nomem(err);
    goto done;
  }

  found = grid_like(&places, frame, taken) && take_names(&places, frame);
done:
  free(ranked);
  free(taken);
  if (st || !found) thr_places_destroy(&places);
  *out = places;
  return st;
}

void thr_places_name(const thr_places *places, const thr_frame *frame, int v, char name[48])
{
  if (places->n_columns)
    snprintf(name, 48, "%s%s", places->letter[places->column[v]], places->number[places->row[v]]);
  else if (frame->name && frame->name[v])
    thr_text_copy_clean(name, 41, frame->name[v]);
  else
    snprintf(name, 48, "%d", v);
}

/* ---- labels ---- */

/* A node with its label, to be sorted. */
typedef struct {
  const char *label;
  int node;
} named;

/* Compares labels, then nodes. */
static int by_label(const void *a, const void *b)
{
  const named *first = a, *second = b;
  int order = strcmp(first->label, second->label);
  return order ? order : first->node - second->node;
}

/* Adds the node's number to each of those labels that several nodes share: "x#17". */
static void tell_apart(char (*label)[THR_LABEL], named *sorted, int n)
{
  /* Equal labels stand together once sorted. */
  for (int v = 0; v < n; v++)
    sorted[v] = (named){label[v], v};
  qsort(sorted, (size_t)n, sizeof *sorted, by_label);

  for (int i = 0, next; i < n; i = next) {
    for (next = i + 1; next < n && strcmp(sorted[next].label, sorted[i].label) == 0;)
      next++;

    /* Labels may be extended now that the run has been found. */
    for (int j = i; j < next && next - i > 1; j++) {
      char *own = label[sorted[j].node];
      size_t length = strlen(own);
      snprintf(own + length, THR_LABEL - length, "#%d", sorted[j].node);
    }
  }
}

thr_status thr_places_labels(const thr_places *places, const thr_frame *frame,
                             char (*label)[THR_LABEL], thr_err *err)
{
  /* Names, or numbers without names. */
  named *sorted = thr_calloc((size_t)frame->n_nodes, sizeof *sorted);
  if (!sorted) return thr_nomem(err);

  /* Blanks would end a name in some formats. */
  for (int v = 0; v < frame->n_nodes; v++) {
    thr_places_name(places, frame, v, label[v]);
    for (char *c = label[v]; *c; c++)
      if (isspace((unsigned char)*c)) *c = '_';
  }

  tell_apart(label, sorted, frame->n_nodes);
  free(sorted);
  return THR_OK;
}
