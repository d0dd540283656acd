/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Letter and number places of grid-like pictures: column letters from left to right, row numbers
 * from the bottom up. */
#include "diagram/scene/scene.h"
#include "graph/sort.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_LINES = 700 }; /* columns up to "ZZ" */

void thr_places_destroy(thr_places *p)
{
  free(p->x);
  free(p->y);
  free(p->letter);
  free(p->number);
  free(p->column);
  free(p->row);
  *p = (thr_places){0};
}

/* Clusters one coordinate: line[v] = cluster of node v, centre[] their means; returns how many, or
 * 0 if a cluster is wider than a tenth of the median. A gap of a quarter of the median starts a new
 * one. */
static int cluster(const double (*xy)[2], int n, int axis, double median, thr_ranked *k, int *line,
                   double *centre)
{
  for (int v = 0; v < n; v++)
    k[v] = (thr_ranked){xy[v][axis], v};
  thr_sort_ranked(k, (size_t)n);
  int count = 0;
  for (int i = 0; i < n;) {
    int from = i;
    double sum = 0;
    if (count == MAX_LINES) return 0;
    do {
      sum += k[i].key - k[from].key;
      line[k[i].index] = count;
      i++;
    } while (i < n && k[i].key - k[i - 1].key <= 0.25 * median);
    if (k[i - 1].key - k[from].key > 0.1 * median) return 0;
    centre[count++] = k[from].key + sum / (i - from);
  }
  return count;
}

/* Nine of ten edges along a row or a column, and every place taken once. */
static bool grid_like(const thr_places *p, const thr_frame *frame, bool *taken)
{
  int along = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    int a = frame->edge[e][0], b = frame->edge[e][1];
    along += p->column[a] == p->column[b] || p->row[a] == p->row[b];
  }
  for (int v = 0; v < frame->n_nodes; v++) {
    bool *t = &taken[p->row[v] * p->n_columns + p->column[v]];
    if (*t) return false;
    *t = true;
  }
  return along * 10L >= frame->n_edges * 9L;
}

/* Splits "AB12" into letters and digits; false for anything else or longer than 7 bytes of either.
 */
static bool split_name(const char *name, char letter[8], char number[8])
{
  size_t n = strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZ"), m = strspn(name + n, "0123456789");
  if (!n || !m || n > 7 || m > 7 || name[n + m]) return false;
  memcpy(letter, name, n);
  letter[n] = '\0';
  memcpy(number, name + n, m + 1);
  return true;
}

/* Takes letters and numbers from the nodes' names if all of them agree with rows and columns. */
static bool take_names(thr_places *p, const thr_frame *frame)
{
  for (int v = 0; v < frame->n_nodes; v++) {
    char letter[8], number[8], *l = p->letter[p->column[v]], *n = p->number[p->row[v]];
    if (!frame->name || !frame->name[v] || !split_name(frame->name[v], letter, number))
      return false;
    if ((*l && strcmp(l, letter) != 0) || (*n && strcmp(n, number) != 0)) return false;
    snprintf(l, 8, "%s", letter);
    snprintf(n, 8, "%s", number);
  }
  return true;
}

static void make_names(thr_places *p)
{
  for (int c = 0; c < p->n_columns; c++) {
    if (c < 26)
      snprintf(p->letter[c], 8, "%c", 'A' + c);
    else
      snprintf(p->letter[c], 8, "%c%c", 'A' + (c / 26 - 1) % 26, 'A' + c % 26);
  }
  for (int r = 0; r < p->n_rows; r++)
    snprintf(p->number[r], 8, "%d", (r + 1) % 1000); /* at most MAX_LINES */
}

static thr_status allocate(thr_places *p, int n, thr_err *err)
{
  size_t lines = n < MAX_LINES ? (size_t)n : MAX_LINES;
  p->x = thr_calloc(lines, sizeof *p->x);
  p->y = thr_calloc(lines, sizeof *p->y);
  p->letter = thr_calloc(lines, sizeof *p->letter);
  p->number = thr_calloc(lines, sizeof *p->number);
  p->column = thr_calloc((size_t)n, sizeof *p->column);
  p->row = thr_calloc((size_t)n, sizeof *p->row);
  return p->x && p->y && p->letter && p->number && p->column && p->row ? THR_OK : thr_nomem(err);
}

thr_status thr_places_find(thr_places *out, const thr_frame *frame, const double (*xy)[2],
                           double median, thr_err *err)
{
  thr_places p = {0};
  bool found = false, *taken = NULL;
  thr_ranked *k = thr_calloc((size_t)frame->n_nodes, sizeof *k);
  thr_status st = k ? allocate(&p, frame->n_nodes, err) : thr_nomem(err);
  if (st) goto done;
  p.n_columns = cluster(xy, frame->n_nodes, 0, median, k, p.column, p.x);
  p.n_rows = p.n_columns > 1 ? cluster(xy, frame->n_nodes, 1, median, k, p.row, p.y) : 0;
  if (p.n_rows < 2 || (long)p.n_rows * p.n_columns > 3L * frame->n_nodes) goto done;
  taken = thr_calloc((size_t)p.n_rows * (size_t)p.n_columns, sizeof *taken);
  if (!taken) {
    st = thr_nomem(err);
    goto done;
  }
  found = grid_like(&p, frame, taken);
  if (found && !take_names(&p, frame)) make_names(&p);
done:
  free(k);
  free(taken);
  if (st || !found) thr_places_destroy(&p);
  *out = p;
  return st;
}

void thr_places_name(const thr_places *p, const thr_frame *frame, int v, char name[48])
{
  if (p->n_columns)
    snprintf(name, 48, "%s%s", p->letter[p->column[v]], p->number[p->row[v]]);
  else if (frame->name && frame->name[v])
    thr_text_copy_clean(name, 41, frame->name[v]);
  else
    snprintf(name, 48, "%d", v);
}

/* ---- labels ---- */

typedef struct {
  const char *label;
  int node;
} named;

static int by_label(const void *a, const void *b)
{
  const named *p = a, *q = b;
  int order = strcmp(p->label, q->label);
  return order ? order : p->node - q->node;
}

/* Adds the node's number to each of those that share a label. */
static void tell_apart(char (*label)[THR_LABEL], named *k, int n)
{
  for (int v = 0; v < n; v++)
    k[v] = (named){label[v], v};
  qsort(k, (size_t)n, sizeof *k, by_label);
  for (int i = 0, next; i < n; i = next) {
    for (next = i + 1; next < n && strcmp(k[next].label, k[i].label) == 0;)
      next++;
    for (int j = i; j < next && next - i > 1; j++) {
      char *own = label[k[j].node];
      size_t length = strlen(own);
      snprintf(own + length, THR_LABEL - length, "#%d", k[j].node);
    }
  }
}

thr_status thr_places_labels(const thr_places *p, const thr_frame *frame, char (*label)[THR_LABEL],
                             thr_err *err)
{
  named *k = thr_calloc((size_t)frame->n_nodes, sizeof *k);
  if (!k) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++) {
    thr_places_name(p, frame, v, label[v]);
    for (char *c = label[v]; *c; c++)
      if (isspace((unsigned char)*c)) *c = '_';
  }
  tell_apart(label, k, frame->n_nodes);
  free(k);
  return THR_OK;
}
