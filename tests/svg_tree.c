/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/svg_tree.h"

#include "graph/status.h"

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *copy_of(const char *s, size_t n)
{
  char *c = thr_calloc(n + 1, 1);
  ck_assert_ptr_nonnull(c);
  memcpy(c, s, n);
  return c;
}

/* Where the tag ends that starts at s: at its '>'. */
static const char *tag_end(const char *s)
{
  char quote = 0;
  for (; *s && (quote || *s != '>'); s++)
    if (*s == '"') quote = quote ? 0 : '"';
  ck_assert_msg(*s == '>', "a tag does not end");
  return s;
}

static void read_transform(svg_tree *t, int i)
{
  svg_element *e = &t->element[i];
  char value[256];
  double x = 0, y = 0;
  if (e->parent >= 0) memcpy(e->shift, t->element[e->parent].shift, sizeof e->shift);
  if (!svg_attribute(t, i, "transform", value)) return;
  ck_assert_int_ge(sscanf(value, "translate(%lf %lf) rotate(%lf)", &x, &y, &e->angle), 2);
  e->shift[0] += x;
  e->shift[1] += y;
}

static const svg_tree *sorting;

static int by_id(const void *a, const void *b)
{
  return strcmp(sorting->element[*(const int *)a].id, sorting->element[*(const int *)b].id);
}

static void index_ids(svg_tree *t)
{
  t->by_id = thr_calloc((size_t)t->n, sizeof *t->by_id);
  ck_assert_ptr_nonnull(t->by_id);
  for (int i = 0; i < t->n; i++) {
    char value[256];
    svg_attribute(t, i, "id", value);
    ck_assert_uint_lt(strlen(value), sizeof t->element[i].id);
    strcpy(t->element[i].id, value);
    if (*value) t->by_id[t->n_ids++] = i;
  }
  sorting = t;
  qsort(t->by_id, (size_t)t->n_ids, sizeof *t->by_id, by_id);
  for (int i = 1; i < t->n_ids; i++)
    ck_assert_str_ne(t->element[t->by_id[i - 1]].id, t->element[t->by_id[i]].id);
}

svg_tree svg_parse(const char *svg)
{
  svg_tree t = {0};
  int capacity = 0, open = -1;
  for (const char *s = strchr(svg, '<'); s; s = strchr(s, '<')) {
    const char *end = tag_end(s);
    size_t n = strcspn(s + 1, " />");
    if (s[1] == '?') {
      s = end;
      continue;
    }
    if (s[1] == '/') {
      ck_assert_int_ge(open, 0);
      n = strcspn(s + 2, ">");
      ck_assert_msg(strlen(t.element[open].name) == n &&
                        strncmp(t.element[open].name, s + 2, n) == 0,
                    "tags do not match");
      open = t.element[open].parent;
      s = end;
      continue;
    }
    ck_assert_int_eq(thr_grow(&t.element, t.n, &capacity, sizeof *t.element, NULL), THR_OK);
    svg_element *e = &t.element[t.n];
    *e = (svg_element){.parent = open};
    ck_assert_uint_lt(n, sizeof e->name);
    memcpy(e->name, s + 1, n);
    e->attributes = copy_of(s + 1 + n, (size_t)(end - s) - 1 - n);
    e->text = copy_of(end + 1, strcspn(end + 1, "<"));
    read_transform(&t, t.n++);
    if (end[-1] != '/') open = t.n - 1;
    s = end;
  }
  ck_assert_int_eq(open, -1);
  ck_assert_int_gt(t.n, 0);
  t.width = svg_number(&t, 0, "width");
  t.height = svg_number(&t, 0, "height");
  index_ids(&t);
  return t;
}

void svg_tree_destroy(svg_tree *t)
{
  for (int i = 0; i < t->n; i++) {
    free(t->element[i].attributes);
    free(t->element[i].text);
  }
  free(t->element);
  free(t->by_id);
  *t = (svg_tree){0};
}

bool svg_attribute(const svg_tree *t, int i, const char *name, char value[256])
{
  char key[40];
  snprintf(key, sizeof key, " %s=\"", name);
  const char *s = strstr(t->element[i].attributes, key);
  value[0] = '\0';
  if (!s) return false;
  s += strlen(key);
  snprintf(value, 256, "%.*s", (int)strcspn(s, "\""), s);
  return true;
}

double svg_number(const svg_tree *t, int i, const char *name)
{
  char value[256];
  ck_assert_msg(svg_attribute(t, i, name, value), "<%s%s> has no %s", t->element[i].name,
                t->element[i].attributes, name);
  return strtod(value, NULL);
}

bool svg_has_class(const svg_tree *t, int i, const char *word)
{
  char value[256];
  size_t n = strlen(word);
  svg_attribute(t, i, "class", value);
  for (const char *s = value; *s; s += strcspn(s, " "), s += strspn(s, " "))
    if (strncmp(s, word, n) == 0 && (s[n] == ' ' || !s[n])) return true;
  return false;
}

int svg_by_id(const svg_tree *t, const char *id)
{
  int low = 0, high = t->n_ids;
  while (low < high) {
    int middle = (low + high) / 2, order = strcmp(t->element[t->by_id[middle]].id, id);
    if (order == 0) return t->by_id[middle];
    if (order < 0)
      low = middle + 1;
    else
      high = middle;
  }
  return -1;
}

bool svg_inside(const svg_tree *t, int i, int ancestor)
{
  while (i > ancestor)
    i = t->element[i].parent;
  return i == ancestor;
}

/* Width of a text in DejaVu Sans, in em, a little more than less: digits are exact, letters a mean.
 */
static double text_width(const char *s)
{
  double width = 0;
  while (*s) {
    width += *s >= '0' && *s <= '9'   ? 0.636
             : *s >= 'A' && *s <= 'Z' ? 0.7
             : *s >= 'a' && *s <= 'z' ? 0.58
                                      : 0.4;
    if (*s == '&') s += strcspn(s, ";");
    for (s++; ((unsigned char)*s & 0xC0) == 0x80;)
      s++;
  }
  return width;
}

void svg_box(const svg_tree *t, int i, double box[4])
{
  const svg_element *e = &t->element[i];
  ck_assert_double_eq(e->angle, 0);
  if (strcmp(e->name, "circle") == 0) {
    double r = svg_number(t, i, "r");
    box[2] = 2 * r, box[3] = 2 * r, box[0] = svg_number(t, i, "cx") - r,
    box[1] = svg_number(t, i, "cy") - r;
  } else if (strcmp(e->name, "text") == 0) {
    double size = svg_number(t, i, "font-size");
    box[2] = (svg_has_class(t, i, "seam") ? 1.09 : 1) * size *
             text_width(e->text); /* bold digits: 0.696 em */
    box[3] = 0.73 * size;
    box[0] = svg_number(t, i, "x") - (svg_has_class(t, i, "middle") ? 0.5
                                      : svg_has_class(t, i, "end")  ? 1
                                                                    : 0) *
                                         box[2];
    box[1] = svg_number(t, i, "y") - box[3];
  } else {
    ck_assert_str_eq(e->name, "rect");
    box[0] = svg_number(t, i, "x"), box[1] = svg_number(t, i, "y");
    box[2] = svg_number(t, i, "width"), box[3] = svg_number(t, i, "height");
  }
  for (int k = 0; k < 2; k++) {
    box[k] += e->shift[k];
    box[2 + k] += box[k];
  }
}

bool svg_overlap(const double a[4], const double b[4], double air)
{
  return a[0] < b[2] + air && b[0] < a[2] + air && a[1] < b[3] + air && b[1] < a[3] + air;
}

int svg_path(const svg_tree *t, int i, char *letter, double (*at)[2], int most)
{
  const char *s = strstr(t->element[i].attributes, " d=\"");
  int n = 0;
  char now = 0;
  ck_assert_ptr_nonnull(s);
  for (s += 4; *s != '"';) {
    if (strchr("MLC", *s)) now = *s++;
    char *end, *second;
    double x = strtod(s, &end), y = strtod(end, &second);
    ck_assert_msg(now && end > s && second > end && n < most, "path %s", t->element[i].attributes);
    at[n][0] = x + t->element[i].shift[0];
    at[n][1] = y + t->element[i].shift[1];
    letter[n++] = now;
    s = second + strspn(second, " ");
  }
  return n;
}
