/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CSV: tables of nodes and edges, or one edge per line as six coordinates (docs/formats.md, "CSV").
 */
#include "graph/io/read_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_FIELDS = 64 }; /* columns after these are not looked at */

typedef enum {
  ANY_TABLE,
  NODE_TABLE,
  EDGE_TABLE
} table_kind; /* what the caller knows of the text */
typedef enum {
  NO_ROWS,
  NODE_ROWS,
  EDGE_ROWS,
  LINE_ROWS,
  TEXT_ROWS
} row_kind; /* TEXT: lines as WKT */

/* Where things stand in a row; -1 = nowhere. */
typedef struct {
  row_kind kind;
  bool header;
  int width; /* fields in the row that this was learnt from */
  int id, xyz[6], foot, ends[2], length, cover, capacity, text;
  bool paired; /* the header says which columns the ends stand in */
} columns;

typedef struct {
  thr_scan scan;
  table_kind expected;
  char separator; /* 0 until the first row; ' ' = any run of blanks */
  columns c;
  thr_names names;  /* once edges begin */
  thr_text scratch; /* for one name at a time */
  thr_draft *d;
  thr_read_report *report;
  thr_err *err;
  bool has_z;  /* some node has a z */
  int empty_z; /* coordinates z that are left empty */
  bool plain;  /* some number has a dot that cannot part thousands */
  int n_fields;
  thr_span field[MAX_FIELDS];
} csv;

static thr_span field_at(const csv *t, int i)
{
  return i >= 0 && i < t->n_fields ? t->field[i] : (thr_span){"", 0};
}

/* A comma in quotes is decimal, too, unless it may part thousands. Grasshopper's panel puts braces
 * round three numbers. */
static bool number_at(const csv *t, int i, double *x)
{
  thr_span f = field_at(t, i);
  bool decimal_comma = t->separator == ';' || t->separator == '\t';
  size_t brace = f.n;
  while (brace > 0 && f.s[brace - 1] != '{')
    brace--;
  f = thr_span_trim((thr_span){f.s + brace, f.n - brace});
  if (f.n && f.s[f.n - 1] == '}') f = thr_span_trim((thr_span){f.s, f.n - 1});
  const char *comma = f.n ? memchr(f.s, ',', f.n) : NULL;
  if (comma && t->separator == ',') decimal_comma = f.s + f.n - comma != 4;
  return thr_span_number(f, decimal_comma, x);
}

/* ---- from line to fields ---- */

/* What kind of geometry a well-known text is, NULL if none: *rest receives its lists of points,
 * *measured whether a third number is a measure and no z. */
static const char *wkt_of(thr_span text, thr_span *rest, bool *measured)
{
  static const char *const kind[] = {"LINESTRING",   "MULTILINESTRING", "POLYGON",
                                     "MULTIPOLYGON", "POINT",           "MULTIPOINT"};
  const char *after = text.n && thr_span_starts(text, "SRID=") ? memchr(text.s, ';', text.n) : NULL;
  if (after) text = (thr_span){after + 1, text.n - (size_t)(after + 1 - text.s)};
  for (size_t i = 0; i < sizeof kind / sizeof *kind; i++) {
    const size_t n = strlen(kind[i]);
    if (text.n < n || !thr_span_is((thr_span){text.s, n}, kind[i])) continue;
    *rest = thr_span_trim((thr_span){text.s + n, text.n - n});
    size_t word = 0;
    while (word < rest->n && rest->s[word] != '(' && rest->s[word] != ' ')
      word++;
    const thr_span said = {rest->s, word};
    *rest = thr_span_trim((thr_span){rest->s + word, rest->n - word});
    *measured = thr_span_is(said, "M");
    if (thr_span_is(said, "EMPTY")) return kind[i];
    const bool known = word == 0 || *measured || thr_span_is(said, "Z") || thr_span_is(said, "ZM");
    return known && rest->n && (rest->s[0] == '(' || thr_span_is(*rest, "EMPTY")) ? kind[i] : NULL;
  }
  return NULL;
}

static bool is_line_text(thr_span text)
{
  thr_span rest;
  bool measured;
  const char *kind = wkt_of(text, &rest, &measured);
  return kind && strstr(kind, "LINE");
}

static char find_separator(thr_span line)
{
  if (is_line_text(line)) return ' '; /* see next_row */
  for (const char *wanted = ";\t,"; *wanted; wanted++) {
    bool quoted = false;
    for (size_t i = 0; i < line.n; i++) {
      if (line.s[i] == '"') quoted = !quoted;
      if (line.s[i] == *wanted && !quoted) return *wanted;
    }
  }
  return ' ';
}

static bool is_separator(const csv *t, char c)
{
  return c == t->separator || (t->separator == ' ' && c == '\t');
}

/* Takes one field and the separator after it off the line. */
static thr_status take_field(csv *t, thr_span *rest, thr_span *field)
{
  size_t i = 0, start, end;
  while (i < rest->n && (rest->s[i] == ' ' || (rest->s[i] == '\t' && t->separator != '\t')))
    i++;
  if (i < rest->n && rest->s[i] == '"') {
    start = ++i;
    while (i < rest->n && (rest->s[i] != '"' || (i + 1 < rest->n && rest->s[i + 1] == '"')))
      i += rest->s[i] == '"' ? 2 : 1;
    if (i >= rest->n)
      return thr_scan_fail(&t->scan, t->err, "a quote is not closed; close it on the same line");
    end = i++;
  } else {
    start = i;
    while (i < rest->n && !is_separator(t, rest->s[i]))
      i++;
    end = i;
  }
  while (i < rest->n && !is_separator(t, rest->s[i]))
    i++; /* after a closing quote */
  *field = thr_span_trim((thr_span){rest->s + start, end - start});
  if (i < rest->n) i++;
  *rest = (thr_span){rest->s + i, rest->n - i};
  return THR_OK;
}

/* Fills t->field from the next line that has something on it; empty fields at the end do not count
 * (spreadsheets pad rows). *more is false at the end of the text. */
static thr_status next_row(csv *t, bool *more)
{
  thr_span line, rest;
  bool measured;
  while ((*more = thr_scan_line(&t->scan, &line))) {
    line = thr_span_trim(line);
    if (line.n && line.s[0] == '#') {
      thr_status st = thr_scan_units(&t->scan, (thr_span){line.s + 1, line.n - 1}, t->d, t->err);
      if (st) return st;
    }
    if (line.n == 0 || line.s[0] == '#') continue;
    if (!t->separator && line.n == 5 && thr_span_starts(line, "sep=")) { /* as Excel says it */
      t->separator = line.s[4];
      continue;
    }
    if (!t->separator) t->separator = find_separator(line);
    t->n_fields = 0;
    if (t->separator == ' ' && wkt_of(line, &rest, &measured)) { /* the line is one field */
      t->field[t->n_fields++] = line;
      return THR_OK;
    }
    for (int i = 0; line.n && i < MAX_FIELDS; i++) {
      thr_status st = take_field(t, &line, &t->field[i]);
      if (st) return st;
      if (t->field[i].n) t->n_fields = i + 1;
    }
    if (t->n_fields) return THR_OK;
  }
  return THR_OK;
}

/* ---- names ---- */

/* Tables that went through floating point call node 7 "7.0". An apostrophe keeps a spreadsheet from
 * taking a name for a formula.
 */
static thr_span plain_name(thr_span t)
{
  if (t.n > 1 && t.s[0] == '\'' && strchr("=+-@", t.s[1])) t = (thr_span){t.s + 1, t.n - 1};
  size_t n = t.n;
  while (n && t.s[n - 1] == '0')
    n--;
  int whole;
  if (n > 1 && n < t.n && t.s[n - 1] == '.' && thr_span_int((thr_span){t.s, n - 1}, &whole))
    t.n = n - 1;
  return t;
}

/* The name in a field as the draft keeps it, valid until the next call. */
static thr_status name_in(csv *t, thr_span field, const char **name)
{
  field = plain_name(field);
  t->scratch.length = 0;
  thr_text_append_bytes(&t->scratch, field.s, field.n);
  if (t->scratch.failed) return thr_nomem(t->err);
  thr_text_clean(t->scratch.data);
  *name = t->scratch.data;
  return THR_OK;
}

/* The node that a field names; -1 if there is none. */
static thr_status node_in(csv *t, thr_span field, int *node)
{
  const char *name;
  thr_status st = name_in(t, field, &name);
  if (!st) *node = thr_names_find(&t->names, thr_span_of(name));
  return st;
}

/* ---- headers ---- */

static int column(const csv *t, const char *const *names)
{
  for (; *names; names++)
    for (int i = 0; i < t->n_fields; i++)
      if (thr_span_is(t->field[i], *names)) return i;
  return -1;
}

#define COLUMN(t, ...) column(t, (const char *const[]){__VA_ARGS__, NULL})

static columns no_columns(const csv *t, row_kind kind, bool header)
{
  return (columns){kind, header, t->n_fields, -1,   {-1, -1, -1, -1, -1, -1}, -1, {0, 1}, -1,
                   -1,   -1,     -1,          false};
}

/* What a header may say of edges beside their ends. */
static void find_edge_columns(const csv *t, columns *c)
{
  c->length = COLUMN(t, "length");
  c->cover = COLUMN(t, "cover");
  c->capacity = COLUMN(t, "capacity");
}

/* Writes what the columns are called, for messages. */
static void list_columns(const csv *t, char *out, size_t size)
{
  *out = '\0';
  for (int i = 0; i < t->n_fields && strlen(out) + 8 < size; i++) {
    const size_t n = strlen(out);
    snprintf(out + n, size - n, "%s%.*s", i ? ", " : "", thr_span_width(t->field[i]),
             t->field[i].s);
  }
  thr_text_clean(out);
}

/* Fills header[n_fields] with what the row says of its columns. False if it is none, because two
 * fields are numbers. */
static bool read_headers(const csv *t, thr_header *header)
{
  double x;
  int numbers = 0;
  for (int i = 0; i < t->n_fields && numbers < 2; i++)
    numbers += number_at(t, i, &x);
  for (int i = 0; i < t->n_fields && numbers < 2; i++)
    header[i] = thr_header_of(t->field[i]);
  return numbers < 2;
}

/* Finds the columns of both ends of a line: x1, y1, z1, x2, y2, z2 or the same with another pair of
 * words. */
static bool find_line_columns(const csv *t, const thr_header *header, columns *c)
{
  const char *word[2];
  for (int pair = 0; thr_header_pair(pair, word); pair++) {
    *c = no_columns(t, LINE_ROWS, true);
    for (int i = t->n_fields - 1; i >= 0; i--)
      for (int end = 0; end < 2; end++) {
        const int axis = thr_header_end_axis(&header[i], word[end]);
        if (axis >= 0) c->xyz[3 * end + axis] = i;
      }
    if (c->xyz[0] >= 0 && c->xyz[1] >= 0 && c->xyz[3] >= 0 && c->xyz[4] >= 0) return true;
  }
  return false;
}

/* Finds the columns of nodes: x, y, z, the feet and the name, which is the first column that means
 * one or else the first. */
static bool find_node_columns(const csv *t, const thr_header *header, columns *c)
{
  *c = no_columns(t, NODE_ROWS, true);
  for (int i = t->n_fields - 1; i >= 0; i--) {
    const int axis = thr_header_axis(&header[i]);
    if (axis >= 0) c->xyz[axis] = i;
    if (thr_header_feet(&header[i])) c->foot = i;
    if (thr_header_names_nodes(&header[i])) c->id = i;
  }
  if (c->id < 0 && c->xyz[0] && c->xyz[1] && c->xyz[2] && c->foot) c->id = 0;
  return c->xyz[0] >= 0 && c->xyz[1] >= 0;
}

/* Finds the column of lines as well-known text. */
static bool find_text_column(const csv *t, const thr_header *header, columns *c)
{
  *c = no_columns(t, TEXT_ROWS, true);
  for (int i = t->n_fields - 1; i >= 0; i--)
    if (thr_header_lines(&header[i])) c->text = i;
  return c->text >= 0;
}

/* Takes the unit that the headers of coordinates and lengths name. */
static thr_status take_units(csv *t, const thr_header *header)
{
  for (int i = 0; i < t->n_fields; i++) {
    bool used = i == t->c.length;
    for (int k = 0; k < 6 && !used; k++)
      used = t->c.kind != EDGE_ROWS && i == t->c.xyz[k];
    if (!used || !header[i].unit[0]) continue;
    if (t->d->units[0] && strcmp(t->d->units, header[i].unit) != 0)
      return thr_scan_fail(&t->scan, t->err,
                           "lengths in %s and in %s; give all of them in one unit", t->d->units,
                           header[i].unit);
    thr_status st = thr_draft_set_units(t->d, header[i].unit, t->err);
    if (st) return st;
  }
  return THR_OK;
}

/* Whether a node read so far has this name. O(nodes): before edges begin, while there is no list by
 * name. */
static bool is_node(const csv *t, thr_span name)
{
  bool found = false;
  for (int v = 0; v < t->d->n_nodes && !found; v++) {
    const char *own = thr_draft_name(t->d, v);
    found = own && strlen(own) == name.n && memcmp(own, name.s, name.n) == 0;
  }
  return found;
}

/* Is this row a header that names coordinates? Then it says where they are. */
static thr_status coordinate_header(csv *t, bool *is)
{
  thr_header header[MAX_FIELDS];
  columns c;
  *is = read_headers(t, header) &&
        (find_line_columns(t, header, &c) || find_node_columns(t, header, &c) ||
         (t->c.kind == NO_ROWS && find_text_column(t, header, &c)));
  if (*is && t->c.kind == NODE_ROWS && t->n_fields == 2)
    *is = !is_node(t, t->field[0]) || !is_node(t, t->field[1]);
  if (!*is) return THR_OK;
  if (c.kind == LINE_ROWS) find_edge_columns(t, &c);
  t->c = c;
  return take_units(t, header);
}

/* Sets the two columns of the ends to those that are asked for, by name or by number from 1. */
static thr_status find_asked_ends(csv *t)
{
  thr_span rest = thr_span_of(t->d->columns);
  for (int end = 0; end < 2; end++) {
    const char *comma = end ? NULL : memchr(rest.s, ',', rest.n);
    const thr_span asked =
        thr_span_trim((thr_span){rest.s, comma ? (size_t)(comma - rest.s) : rest.n});
    int number = 0, at = -1;
    for (int i = t->n_fields - 1; i >= 0 && t->c.header; i--)
      if (thr_span_same(t->field[i], asked)) at = i;
    if (at < 0 && thr_span_int(asked, &number) && number >= 1 && number <= t->n_fields)
      at = number - 1;
    if (at < 0) {
      char seen[160];
      list_columns(t, seen, sizeof seen);
      return thr_scan_fail(&t->scan, t->err, "no column '%.*s', which --columns asks for, among %s",
                           thr_span_width(asked), asked.s,
                           t->c.header ? seen : "the numbers of the columns");
    }
    t->c.ends[end] = at;
    rest = comma ? (thr_span){comma + 1, rest.n - (size_t)(comma + 1 - rest.s)} : (thr_span){"", 0};
  }
  t->c.paired = true;
  return THR_OK;
}

/* Marks the columns whose values all name nodes, in the rows that are left and, if there is no
 * header, in this one. *counts is set to whether the first column counts the rows, from 0 or 1. */
static thr_status find_naming_columns(const csv *t, bool *names, bool *counts)
{
  csv ahead = *t;
  bool more = true;
  int number, row = 0, first = 0, node;
  thr_status st = THR_OK;
  ahead.scratch = (thr_text){0};
  for (int i = 0; i < MAX_FIELDS; i++)
    names[i] = i < t->n_fields;
  *counts = true;
  if (t->c.header) st = next_row(&ahead, &more);
  for (; more && !st; row++) {
    for (int i = 0; i < t->n_fields && !st; i++) {
      if (!names[i]) continue;
      st = node_in(&ahead, field_at(&ahead, i), &node);
      names[i] = !st && node >= 0;
    }
    *counts = *counts && thr_span_int(plain_name(ahead.field[0]), &number) &&
              (row == 0 ? number == 0 || number == 1 : number == first + row);
    if (row == 0) first = number;
    if (!st) st = next_row(&ahead, &more);
  }
  *counts = *counts && row > 1;
  thr_text_destroy(&ahead.scratch);
  return st;
}

/* Sets the two columns of the ends by their values, where the headers do not say them: those two
 * that always name nodes. A third one that does is the number of the bar if its header says so or,
 * the first one, if it counts the rows. */
static thr_status find_ends_by_values(csv *t, const thr_header *header)
{
  bool names[MAX_FIELDS], counts;
  int n = 0;
  if (t->d->columns) return find_asked_ends(t);
  thr_status st = find_naming_columns(t, names, &counts);
  for (int i = 0; i < t->n_fields; i++)
    n += names[i];
  for (int i = 0; i < t->n_fields && n > 2; i++)
    if (names[i] && (header ? thr_header_names_bars(&header[i]) : i == 0 && counts)) {
      names[i] = false;
      n--;
    }
  if (!st && n > 2)
    return thr_scan_fail(&t->scan, t->err,
                         "%d columns name nodes; say which two are the ends of an edge with "
                         "--columns 2,3 or a header a,b",
                         n);
  for (int i = 0, end = 0; i < t->n_fields && n == 2; i++)
    if (names[i]) t->c.ends[end++] = i;
  return st;
}

/* Learns from the header of edges which columns their ends stand in: those of a pair of words, of
 * several pairs the first one whose values all name nodes; else by the values. */
static thr_status edge_header(csv *t)
{
  thr_header header[MAX_FIELDS];
  bool names[MAX_FIELDS] = {false}, counts, found = false;
  const char *word[2];
  thr_status st = THR_OK;
  t->c = no_columns(t, EDGE_ROWS, true);
  for (int i = 0; i < t->n_fields; i++)
    header[i] = thr_header_of(t->field[i]);
  if (t->n_fields > 2 && t->d->n_nodes) st = find_naming_columns(t, names, &counts);
  for (int pair = 0; thr_header_pair(pair, word); pair++)
    for (int a = 0; a < t->n_fields; a++)
      for (int b = 0; b < t->n_fields; b++) {
        if (a == b || (found && !(names[a] && names[b])) ||
            !thr_header_ends(&header[a], &header[b], word))
          continue;
        if (found && names[t->c.ends[0]] && names[t->c.ends[1]]) continue;
        t->c.ends[0] = a;
        t->c.ends[1] = b;
        t->c.paired = found = true;
      }
  if (!st && t->d->columns) st = find_asked_ends(t);
  if (!st && !t->c.paired && t->n_fields > 2 && t->d->n_nodes) st = find_ends_by_values(t, header);
  find_edge_columns(t, &t->c);
  int *const named[] = {&t->c.length, &t->c.cover, &t->c.capacity};
  for (int i = 0; i < 3; i++)
    if (*named[i] == t->c.ends[0] || *named[i] == t->c.ends[1]) *named[i] = -1;
  return st ? st : take_units(t, header);
}

static bool all_words(const csv *t)
{
  double x;
  for (int i = 0; i < t->n_fields; i++)
    if (number_at(t, i, &x)) return false;
  return true;
}

/* ---- rows ---- */

/* Where ';' parts the fields, keeps the first number whose dot may part thousands for a note, and
 * whether there is one whose dot cannot: thousands are 1 to 3 digits, not 0 first, a dot and 3
 * digits. */
static void watch_dot(csv *t, thr_span f)
{
  if (f.n && (f.s[0] == '-' || f.s[0] == '+')) f = (thr_span){f.s + 1, f.n - 1};
  if (t->separator != ';' || !f.n || !memchr(f.s, '.', f.n)) return;
  bool thousands = f.n >= 5 && f.n <= 7 && f.s[0] != '0' && f.s[f.n - 4] == '.';
  for (size_t i = 0; i < f.n && thousands; i++)
    thousands = i + 4 == f.n || (f.s[i] >= '0' && f.s[i] <= '9');
  t->plain |= !thousands;
  char *example = t->report->thousands;
  if (thousands && !*example) snprintf(example, sizeof t->report->thousands, "%.*s", (int)f.n, f.s);
}

static thr_status read_coordinates(csv *t, const int *at, double xyz[3])
{
  for (int i = 0; i < 3; i++) {
    thr_span f = field_at(t, at[i]);
    xyz[i] = 0;
    if (i == 2 && f.n == 0) { /* flat frameworks have no z */
      t->empty_z++;
      continue;
    }
    t->has_z |= i == 2;
    if (f.n == 0)
      return thr_scan_fail(&t->scan, t->err, "no %c coordinate in column %d; give a number",
                           'x' + i, at[i] + 1);
    if (!number_at(t, at[i], &xyz[i]))
      return thr_scan_fail(
          &t->scan, t->err,
          "'%.*s' in column %d is not a finite number; give %c as a decimal number",
          thr_span_width(f), f.s, at[i] + 1, 'x' + i);
    watch_dot(t, f);
  }
  return THR_OK;
}

static thr_status read_foot(const csv *t, bool *foot)
{
  thr_span f = field_at(t, t->c.foot);
  if (!thr_span_truth(f, foot))
    return thr_scan_fail(&t->scan, t->err,
                         "'%.*s' in column %d does not say whether this is a foot; use 1 or 0",
                         thr_span_width(f), f.s, t->c.foot + 1);
  return THR_OK;
}

static thr_status read_length(csv *t, double *length)
{
  thr_span f = field_at(t, t->c.length);
  *length = 0;
  watch_dot(t, f);
  if (f.n == 0 || (number_at(t, t->c.length, length) && *length > 0)) return THR_OK;
  return thr_scan_fail(
      &t->scan, t->err,
      "length '%.*s' is not a positive number; leave it empty for the distance of the two nodes",
      thr_span_width(f), f.s);
}

/* A whole number from 1; 0 if the field is empty. */
static thr_status read_count(const csv *t, int at, const char *what, int *count)
{
  thr_span f = field_at(t, at);
  *count = 0;
  if (f.n == 0 || (thr_span_int(plain_name(f), count) && *count >= 1)) return THR_OK;
  return thr_scan_fail(&t->scan, t->err,
                       "%s '%.*s' is not a whole number from 1 on; leave it empty if there is none",
                       what, thr_span_width(f), f.s);
}

/* Adds an edge with what its row says beside the ends. */
static thr_status finish_edge(csv *t, int a, int b)
{
  double length;
  int cover, capacity;
  thr_err local = {0};
  thr_status st = read_length(t, &length);
  if (!st) st = read_count(t, t->c.cover, "cover", &cover);
  if (!st) st = read_count(t, t->c.capacity, "capacity", &capacity);
  if (!st) st = thr_draft_add_edge(t->d, a, b, length, t->err);
  if (st) return st;
  st = thr_draft_edge_passes(t->d, cover, capacity, &local);
  return st ? thr_scan_fail(&t->scan, t->err, "%s", local.text) : THR_OK;
}

static thr_status add_node(csv *t)
{
  double xyz[3];
  bool foot;
  thr_status st = read_coordinates(t, t->c.xyz, xyz);
  if (!st) st = read_foot(t, &foot);
  if (st) return st;

  thr_span id = field_at(t, t->c.id);
  if (t->c.id >= 0 && id.n == 0)
    return thr_scan_fail(&t->scan, t->err, "the node has no name in column %d", t->c.id + 1);
  if (!thr_text_is_utf8(id.s, id.n))
    return thr_scan_fail(&t->scan, t->err,
                         "the node's name is not UTF-8; save the file as UTF-8 text");
  char number[16];
  const char *name;
  snprintf(number, sizeof number, "%d", t->d->n_nodes);
  st = name_in(t, t->c.id < 0 ? thr_span_of(number) : id, &name);
  return st ? st : thr_draft_add_node(t->d, xyz, name, foot, t->err);
}

static thr_status add_edge(csv *t)
{
  int end[2];
  for (int i = 0; i < 2; i++) {
    thr_span id = field_at(t, t->c.ends[i]);
    thr_status st = node_in(t, id, &end[i]);
    if (st) return st;
    if (end[i] < 0)
      return thr_scan_fail(&t->scan, t->err,
                           "there is no node '%.*s'; the nodes are called '%.40s' to '%.40s'",
                           thr_span_width(id), id.s, thr_draft_name(t->d, 0),
                           thr_draft_name(t->d, t->d->n_nodes - 1));
  }
  return finish_edge(t, end[0], end[1]);
}

static thr_status add_line(csv *t)
{
  double a[3], b[3];
  thr_status st = read_coordinates(t, t->c.xyz, a);
  if (!st) st = read_coordinates(t, t->c.xyz + 3, b);
  if (!st) st = thr_draft_add_node(t->d, a, NULL, false, t->err);
  if (!st) st = thr_draft_add_node(t->d, b, NULL, false, t->err);
  return st ? st : finish_edge(t, t->d->n_nodes - 2, t->d->n_nodes - 1);
}

/* Ends a point of a well-known text, and the edge to it from the point before, if there is one. */
static thr_status end_point(csv *t, const double *number, int n, bool measured, int *before)
{
  const double xyz[3] = {number[0], number[1], n > 2 && !measured ? number[2] : 0};
  t->has_z |= n > 2 && !measured;
  thr_status st =
      n < 2 ? thr_scan_fail(&t->scan, t->err, "a point of one number; give x and y or x, y and z")
            : THR_OK;
  if (!st) st = thr_draft_add_node(t->d, xyz, NULL, false, t->err);
  if (!st && *before >= 0) st = thr_draft_add_edge(t->d, *before, t->d->n_nodes - 1, 0, t->err);
  *before = t->d->n_nodes - 1;
  return st;
}

/* Adds the lines of a well-known text, "LINESTRING Z (0 0 0, 20 0 0)": lists of points in brackets.
 */
static thr_status add_text(csv *t)
{
  const thr_span whole = field_at(t, t->c.text);
  thr_span text = {"", 0};
  double number[4];
  int n_numbers = 0, depth = 0, before = -1;
  bool measured;
  if (whole.n == 0) return THR_OK;
  const char *kind = wkt_of(whole, &text, &measured);
  if (!kind)
    return thr_scan_fail(
        &t->scan, t->err,
        "'%.*s' in column %d is no line; write LINESTRING Z (0 0 0, 20 0 0), in quotes",
        thr_span_width(whole), whole.s, t->c.text + 1);
  if (strstr(kind, "POINT")) thr_report_skip(t->report, thr_span_of(kind));
  if (strstr(kind, "POINT") || (text.n && text.s[0] != '(')) return THR_OK; /* EMPTY */

  for (size_t i = 0, n; i < text.n; i += n) {
    for (n = 0; i + n < text.n && !strchr("(), 	", text.s[i + n]);)
      n++;
    thr_status st = THR_OK;
    if (n == 0 && text.s[i] == '(') {
      depth++;
    } else if (n == 0 && text.s[i] != ' ' && text.s[i] != '	') {
      if (n_numbers) st = end_point(t, number, n_numbers, measured, &before);
      if (text.s[i] == ')') before = -1;
      depth -= text.s[i] == ')';
      n_numbers = 0;
    } else if (n && (depth < 1 || n_numbers == 4 ||
                     !thr_span_number((thr_span){text.s + i, n}, false, &number[n_numbers++]))) {
      depth = -1;
    }
    if (st) return st;
    if (depth < 0) break;
    n += n == 0;
  }
  return depth == 0 ? THR_OK
                    : thr_scan_fail(&t->scan, t->err, "'%.*s' is not lists of points in brackets",
                                    thr_span_width(text), text.s);
}

/* ---- what kind of row ---- */

static thr_status begin_edges(csv *t)
{
  t->c = no_columns(t, EDGE_ROWS, false);
  return t->names.entry ? THR_OK : thr_names_build(&t->names, t->d, t->scan.name, t->err);
}

/* Sets the columns of rows without a header by their number. */
static thr_status guess_columns(csv *t)
{
  int n = t->n_fields;
  if (t->expected == EDGE_TABLE ? n >= 2 : t->expected == ANY_TABLE && n == 2) {
    thr_status st = begin_edges(t);
    return st || n == 2 ? st : find_ends_by_values(t, NULL);
  }
  for (int i = 0; i < n && t->expected == ANY_TABLE; i++)
    if (is_line_text(t->field[i])) {
      t->c = no_columns(t, TEXT_ROWS, false);
      t->c.text = i;
      return THR_OK;
    }
  if (t->expected == ANY_TABLE && n == 6) {
    t->c = no_columns(t, LINE_ROWS, false);
    for (int i = 0; i < 6; i++)
      t->c.xyz[i] = i;
    return THR_OK;
  }
  if (t->expected == EDGE_TABLE || (n != 3 && n != 4))
    return thr_scan_fail(&t->scan, t->err, "a row of %d fields without a header; %s", n,
                         t->expected == EDGE_TABLE ? "an edge names two nodes"
                         : t->expected == NODE_TABLE
                             ? "a node is x,y,z or id,x,y,z"
                             : "an edge is x1,y1,z1,x2,y2,z2, a node x,y,z or id,x,y,z");
  t->c = no_columns(t, NODE_ROWS, false);
  if (n == 4) t->c.id = 0;
  for (int i = 0; i < 3; i++)
    t->c.xyz[i] = n - 3 + i;
  return THR_OK;
}

/* Learns from a row what it and those after it are; *used if the row was a header. */
static thr_status learn(csv *t, bool *used)
{
  bool nodes_open = t->c.kind == NODE_ROWS, fresh = t->c.kind == NO_ROWS;
  *used = false;
  if (t->c.kind == EDGE_ROWS) return THR_OK;
  if (t->expected != EDGE_TABLE && (fresh || nodes_open)) {
    thr_status st = coordinate_header(t, used);
    if (st) return st;
  }
  if (*used) {
    if (t->c.kind == NODE_ROWS || (t->expected == ANY_TABLE && fresh)) return THR_OK;
    return thr_scan_fail(
        &t->scan, t->err,
        "columns x1 to z2 make a table of their own; take them out of the table of nodes");
  }
  if ((fresh || nodes_open) && t->n_fields >= 2 && all_words(t)) {
    char seen[160];
    list_columns(t, seen, sizeof seen);
    if (t->expected == NODE_TABLE)
      return thr_scan_fail(&t->scan, t->err,
                           "the header names no columns x and y but %s; name the columns id,x,y,z",
                           seen);
    int a, b;
    thr_status st = begin_edges(t);
    if (!st) st = node_in(t, t->field[0], &a);
    if (!st) st = node_in(t, t->field[1], &b);
    if (st) return st;
    *used = a < 0 && b < 0;
    return *used ? edge_header(t) : t->n_fields > 2 ? find_ends_by_values(t, NULL) : THR_OK;
  }
  if (fresh) return guess_columns(t);
  if (nodes_open && t->expected == ANY_TABLE && t->n_fields == 2 && t->c.width > 2)
    return begin_edges(t);
  return THR_OK;
}

/* Columns that mean nothing go into the report by name, of the row that the columns were learnt
 * from. */
static void note_unused(csv *t)
{
  const columns *c = &t->c;
  for (int i = 0; i < t->n_fields; i++) {
    bool used = i == c->id || i == c->foot || i == c->length || i == c->cover || i == c->capacity ||
                i == c->text;
    for (int k = 0; k < 6; k++)
      used |= c->kind != EDGE_ROWS && i == c->xyz[k];
    for (int k = 0; k < 2; k++)
      used |= c->kind == EDGE_ROWS && i == c->ends[k];
    const size_t n = strlen(t->report->unused), size = sizeof t->report->unused;
    if (used || n + 1 >= size) continue;
    const char *comma = n ? ", " : "";
    if (c->header && t->field[i].n)
      snprintf(t->report->unused + n, size - n, "%s%.*s", comma, thr_span_width(t->field[i]),
               t->field[i].s);
    else
      snprintf(t->report->unused + n, size - n, "%scolumn %d", comma, i + 1);
  }
  thr_text_clean(t->report->unused);
}

static thr_status add_row(csv *t)
{
  if (!t->c.header && t->n_fields != t->c.width && !(t->expected == EDGE_TABLE && t->n_fields >= 2))
    return thr_scan_fail(&t->scan, t->err, "%d fields where the rows before have %d; %s",
                         t->n_fields, t->c.width,
                         t->c.kind == EDGE_ROWS ? "nodes come before edges"
                                                : "complete the row or put a header before it");
  switch (t->c.kind) {
  case NODE_ROWS: return add_node(t);
  case EDGE_ROWS: return add_edge(t);
  case TEXT_ROWS: return add_text(t);
  default: return add_line(t);
  }
}

static int by_place(const void *pa, const void *pb)
{
  const double *a = pa, *b = pb;
  for (int i = 0; i < 3; i++)
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  return 0;
}

static bool has_length_one(const double *p)
{
  return fabs(sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 1) <= 1e-3;
}

/* THR_EINPUT if lines without a header seem to be points with their normals: every second point has
 * length 1 and begins no line, and the first ones neither are one point nor have length 1, too. O(n
 * log n). */
static thr_status check_normals(const csv *t)
{
  const int n = t->d->n_nodes / 2;
  bool one_place = true, all_unit = true, joined = false;
  for (int i = 0; i < n; i++) {
    const double *first = t->d->node[2 * i].xyz;
    if (!has_length_one(t->d->node[2 * i + 1].xyz)) return THR_OK;
    one_place = one_place && by_place(first, t->d->node[0].xyz) == 0;
    all_unit = all_unit && has_length_one(first);
  }
  if (one_place || all_unit) return THR_OK;

  double(*begins)[3] = thr_calloc((size_t)n, sizeof *begins);
  if (!begins) return thr_nomem(t->err);
  for (int i = 0; i < n; i++)
    memcpy(begins[i], t->d->node[2 * i].xyz, sizeof *begins);
  qsort(begins, (size_t)n, sizeof *begins, by_place);
  for (int i = 0; i < n && !joined; i++)
    joined = bsearch(t->d->node[2 * i + 1].xyz, begins, (size_t)n, sizeof *begins, by_place);
  free(begins);
  return joined ? THR_OK
                : thr_fail(t->err, THR_EINPUT,
                           "%s: six columns without a header look like points and their normals; "
                           "if they are edges, put the "
                           "header x1,y1,z1,x2,y2,z2 before them",
                           t->scan.name);
}

/* Reads one table into t->d. An edge table without nodes is not read further than its first row. */
static thr_status read_table(csv *t, const char *text, size_t n, const char *name,
                             thr_csv_content *content)
{
  bool more = true, used;
  *content = THR_CSV_WHOLE;
  thr_status st = thr_scan_start(&t->scan, text, n, name, t->err);
  while (!st && !(st = next_row(t, &more)) && more) {
    const row_kind before = t->c.kind;
    if ((st = learn(t, &used))) break;
    if (used || t->c.kind != before) note_unused(t);
    *content = t->c.kind == NODE_ROWS ? THR_CSV_NODES_ONLY : THR_CSV_WHOLE;
    if (t->c.kind == EDGE_ROWS && t->d->n_nodes == 0) {
      *content = THR_CSV_EDGES_ONLY;
      break;
    }
    if (!used) st = add_row(t);
  }
  if (!st && t->c.kind == NO_ROWS) st = thr_scan_fail(&t->scan, t->err, "the table has no rows");
  if (!st && t->c.kind == LINE_ROWS && !t->c.header) st = check_normals(t);
  if (t->plain) t->report->thousands[0] = '\0';
  return st;
}

/* Reports on the table that was read with this status, and frees what only reading needed. */
static thr_status finish(csv *t, thr_status st)
{
  t->report->no_z = !t->has_z;
  t->report->empty_z = t->has_z ? t->empty_z : 0;
  thr_names_destroy(&t->names);
  thr_text_destroy(&t->scratch);
  if (st) thr_draft_destroy(t->d);
  return st;
}

thr_status thr_csv_scan(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_csv_content *content, thr_err *err)
{
  csv t = {.expected = ANY_TABLE, .d = draft, .report = report, .err = err};
  return finish(&t, read_table(&t, text, n, name, content));
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  thr_csv_content content;
  csv t = {.expected = ANY_TABLE, .d = draft, .report = report, .err = err};
  char seen[160];
  thr_status st = finish(&t, read_table(&t, text, n, name, &content));
  if (st || content == THR_CSV_WHOLE) return st;
  thr_draft_destroy(draft);
  list_columns(&t, seen, sizeof seen);
  if (content == THR_CSV_EDGES_ONLY && t.c.header && !t.c.paired)
    return thr_scan_fail(&t.scan, err,
                         "columns %s: no coordinates (x,y,z or x1,y1,z1,x2,y2,z2) and no two ends "
                         "of edges (a,b or start,end) are "
                         "among them",
                         seen);
  return content == THR_CSV_NODES_ONLY
             ? thr_fail(err, THR_EINPUT,
                        "%s: nodes but no edges; add rows that name two nodes, or give the table "
                        "of edges too",
                        name)
             : thr_fail(err, THR_EINPUT,
                        "%s: edges but no columns x and y before them; give the table of nodes too",
                        name);
}

thr_status thr_csv_parse_pair(thr_draft *draft, thr_read_report *report, const thr_text *nodes,
                              const char *nodes_name, const thr_text *edges, const char *edges_name,
                              thr_err *err)
{
  thr_csv_content content;
  csv n = {.expected = NODE_TABLE, .d = draft, .report = report, .err = err};
  csv e = {.expected = EDGE_TABLE, .d = draft, .report = report, .err = err};
  thr_status st = read_table(&n, nodes->data, nodes->length, nodes_name, &content);
  report->no_z = !n.has_z;
  report->empty_z = n.has_z ? n.empty_z : 0;
  if (!st && draft->n_nodes == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no row with a node's coordinates", nodes_name);
  if (!st) st = thr_names_build(&e.names, draft, nodes_name, err);
  if (!st) st = read_table(&e, edges->data, edges->length, edges_name, &content);
  thr_names_destroy(&n.names);
  thr_names_destroy(&e.names);
  thr_text_destroy(&n.scratch);
  thr_text_destroy(&e.scratch);
  if (st) thr_draft_destroy(draft);
  return st;
}

const thr_format thr_csv_format = {
    .name = "csv", .ending = {"csv", "tsv"}, .parse = parse, .write = thr_csv_write, .pairs = true};
