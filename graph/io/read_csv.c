/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads CSV: tables of nodes and edges, or one edge per line as six coordinates, or lines as
 * well-known text (docs/formats.md, "CSV").
 *
 * The first rows tell what the table holds: a header by its words (headers.c), rows without a
 * header by the number of their fields and by which of them are numbers. From then on each row is a
 * node or an edge, until a row says otherwise. A table of nodes may be followed by one of edges
 * that name the nodes.
 *
 * Example: three nodes and two edges.
 *     id,x,y,z
 *     a,0,0,0
 *     b,20,0,0
 *     c,20,20,0
 *     a,b
 *     b,c */
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

/* In which columns of a row the values are; -1 = in none. */
typedef struct {
  row_kind kind;
  bool header;
  int width; /* fields in the row that this was learnt from */
  int id, xyz[6], foot, ends[2], length, cover, capacity, text;
  bool paired; /* the header says which columns the ends stand in */
} columns;

/* The state of one reading: text, what the columns mean, and the current row. */
typedef struct {
  thr_scan scan;
  table_kind expected;
  char separator; /* 0 until the first row; ' ' = any run of blanks */
  columns columns;
  thr_names names;  /* once edges begin */
  thr_text scratch; /* for one name at a time */
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  bool has_z;  /* some node has a z */
  int empty_z; /* coordinates z that are left empty */
  bool plain;  /* some number has a dot that cannot part thousands */
  int n_fields;
  thr_span field[MAX_FIELDS];
} csv_reader;

/* Returns the field number i of the row, or an empty one if the row is shorter. */
static thr_span field_at(const csv_reader *table, int i)
{
  return i >= 0 && i < table->n_fields ? table->field[i] : (thr_span){"", 0};
}

/* Reads field i as a number; false if it is none. A comma in quotes is a decimal comma, too, unless
 * it may part thousands. Braces round three numbers, as Grasshopper's panel writes them, are left
 * out: "{1" and "3}". */
static bool number_at(const csv_reader *table, int i, double *x)
{
  thr_span text = field_at(table, i);

  /* Where fields are parted by semicolons or tabs, a comma can only be a decimal one. */
  bool decimal_comma = table->separator == ';' || table->separator == '\t';

  /* Drop what comes before an opening brace, and a closing one. */
  size_t brace = text.n;
  while (brace > 0 && text.s[brace - 1] != '{')
    brace--;

  text = thr_span_trim((thr_span){text.s + brace, text.n - brace});
  if (text.n && text.s[text.n - 1] == '}') text = thr_span_trim((thr_span){text.s, text.n - 1});

  /* In quotes between commas: "1,234" may be a thousand, "1,5" may not. */
  const char *comma = text.n ? memchr(text.s, ',', text.n) : NULL;
  if (comma && table->separator == ',') decimal_comma = text.s + text.n - comma != 4;
  return thr_span_number(text, decimal_comma, x);
}

/* ---- from line to fields ---- */

/* Returns what kind of geometry a well-known text is, NULL if none. *rest receives its lists of
 * points, *measured whether a third number is a measure and no z: "LINESTRING M (0 0 7)". */
static const char *wkt_of(thr_span text, thr_span *rest, bool *measured)
{
  static const char *const kind[] = {"LINESTRING",   "MULTILINESTRING", "POLYGON",
                                     "MULTIPOLYGON", "POINT",           "MULTIPOINT"};

  /* PostGIS writes the coordinate system before the geometry: "SRID=4326;". */
  const char *after = text.n && thr_span_starts(text, "SRID=") ? memchr(text.s, ';', text.n) : NULL;
  if (after) text = (thr_span){after + 1, text.n - (size_t)(after + 1 - text.s)};

  /* The kind, then perhaps Z, M or ZM, then the lists or EMPTY. */
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

/* Returns whether a text is a well-known text of lines. */
static bool is_line_text(thr_span text)
{
  thr_span rest;
  bool measured;
  const char *kind = wkt_of(text, &rest, &measured);
  return kind && strstr(kind, "LINE");
}

/* Returns the separator that a line's fields are parted by: the first of ; tab and , that stands
 * outside of quotes, else blanks. */
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

/* Returns whether c parts fields; where blanks do, a tab does as well. */
static bool is_separator(const csv_reader *table, char c)
{
  return c == table->separator || (table->separator == ' ' && c == '\t');
}

/* Takes one field and the separator after the field off the rest of the line. */
static thr_status take_field(csv_reader *table, thr_span *rest, thr_span *field)
{
  size_t i = 0, start, end;

  /* Blanks before a field do not belong to the field. */
  while (i < rest->n && (rest->s[i] == ' ' || (rest->s[i] == '\t' && table->separator != '\t')))
    i++;

  /* A quoted field ends at a quote that is not doubled. Other fields end at the separator. */
  if (i < rest->n && rest->s[i] == '"') {
    start = ++i;
    while (i < rest->n && (rest->s[i] != '"' || (i + 1 < rest->n && rest->s[i + 1] == '"')))
      i += rest->s[i] == '"' ? 2 : 1;
    if (i >= rest->n)
      return thr_scan_fail(&table->scan, table->err,
                           "a quote is not closed; close it on the same line");
    end = i++;
  } else {
    start = i;
    while (i < rest->n && !is_separator(table, rest->s[i]))
      i++;
    end = i;
  }

  /* What stands between a closing quote and the separator is dropped. */
  while (i < rest->n && !is_separator(table, rest->s[i]))
    i++;
  *field = thr_span_trim((thr_span){rest->s + start, end - start});

  if (i < rest->n) i++;
  *rest = (thr_span){rest->s + i, rest->n - i};
  return THR_OK;
}

/* Fills table->field from the next line that has something on it. Empty fields at the end do not
 * count, because spreadsheets pad rows. *more becomes false at the end of the text. */
static thr_status next_row(csv_reader *table, bool *more)
{
  thr_span line, rest;
  bool measured;

  while ((*more = thr_scan_line(&table->scan, &line))) {
    line = thr_span_trim(line);

    /* A comment may name the unit of length. */
    if (line.n && line.s[0] == '#') {
      thr_status st = thr_scan_units(&table->scan, (thr_span){line.s + 1, line.n - 1}, table->draft,
                                     table->err);
      if (st) return st;
    }
    if (line.n == 0 || line.s[0] == '#') continue;
    if (!table->separator && line.n == 5 && thr_span_starts(line, "sep=")) { /* as Excel says it */
      table->separator = line.s[4];
      continue;
    }

    /* The first row tells the separator of the table. */
    if (!table->separator) table->separator = find_separator(line);
    table->n_fields = 0;
    if (table->separator == ' ' && wkt_of(line, &rest, &measured)) { /* the line is one field */
      table->field[table->n_fields++] = line;
      return THR_OK;
    }

    /* Fields up to the last one that is not empty. */
    for (int i = 0; line.n && i < MAX_FIELDS; i++) {
      thr_status st = take_field(table, &line, &table->field[i]);
      if (st) return st;
      if (table->field[i].n) table->n_fields = i + 1;
    }
    if (table->n_fields) return THR_OK;
  }

  return THR_OK;
}

/* ---- names ---- */

/* Returns the name that a field means. Tables that went through floating point call node 7 "7.0".
 * An apostrophe keeps a spreadsheet from taking a name for a formula: '=A is =A. */
static thr_span plain_name(thr_span text)
{
  if (text.n > 1 && text.s[0] == '\'' && strchr("=+-@", text.s[1]))
    text = (thr_span){text.s + 1, text.n - 1};

  /* Strip zeros after the point of a whole number. */
  size_t n = text.n;
  while (n && text.s[n - 1] == '0')
    n--;

  int whole;
  if (n > 1 && n < text.n && text.s[n - 1] == '.' &&
      thr_span_int((thr_span){text.s, n - 1}, &whole))
    text.n = n - 1;

  return text;
}

/* Returns the name in a field as the draft keeps names, valid until the next call. */
static thr_status name_in(csv_reader *table, thr_span field, const char **name)
{
  field = plain_name(field);
  table->scratch.length = 0;
  thr_text_append_bytes(&table->scratch, field.s, field.n);
  if (table->scratch.failed) return thr_nomem(table->err);
  thr_text_clean(table->scratch.data);
  *name = table->scratch.data;
  return THR_OK;
}

/* Finds the node that a field names; *node becomes -1 if there is none. */
static thr_status node_in(csv_reader *table, thr_span field, int *node)
{
  const char *name;
  thr_status st = name_in(table, field, &name);
  if (!st) *node = thr_names_find(&table->names, thr_span_of(name));
  return st;
}

/* ---- headers ---- */

/* Returns the first column with one of the names, in the order of the names, or -1. */
static int column(const csv_reader *table, const char *const *names)
{
  for (; *names; names++)
    for (int i = 0; i < table->n_fields; i++)
      if (thr_span_is(table->field[i], *names)) return i;
  return -1;
}

#define COLUMN(table, ...) column(table, (const char *const[]){__VA_ARGS__, NULL})

/* Returns columns of a kind of which no meaning is known; ends are expected in the first two. */
static columns no_columns(const csv_reader *table, row_kind kind, bool header)
{
  return (columns){
      kind, header, table->n_fields, -1, {-1, -1, -1, -1, -1, -1}, -1, {0, 1}, -1, -1, -1,
      -1,   false};
}

/* Finds the columns that say more of an edge than its ends. */
static void find_edge_columns(const csv_reader *table, columns *meaning)
{
  meaning->length = COLUMN(table, "length");
  meaning->cover = COLUMN(table, "cover");
  meaning->capacity = COLUMN(table, "capacity");
}

/* Writes what the columns are called, for messages, as far as size bytes hold. */
static void list_columns(const csv_reader *table, char *out, size_t size)
{
  *out = '\0';
  for (int i = 0; i < table->n_fields && strlen(out) + 8 < size; i++) {
    const size_t n = strlen(out);
    snprintf(out + n, size - n, "%s%.*s", i ? ", " : "", thr_span_width(table->field[i]),
             table->field[i].s);
  }
  thr_text_clean(out);
}

/* Fills header[n_fields] with what the row says of its columns. Returns false if the row is no
 * header, because two fields are numbers. */
static bool read_headers(const csv_reader *table, thr_header *header)
{
  double x;
  int numbers = 0;

  /* Two numbers make it a row of values; one may be a name that looks like a number. */
  for (int i = 0; i < table->n_fields && numbers < 2; i++)
    numbers += number_at(table, i, &x);
  for (int i = 0; i < table->n_fields && numbers < 2; i++)
    header[i] = thr_header_of(table->field[i]);

  return numbers < 2;
}

/* Finds the columns of both ends of a line: x1, y1, z1, x2, y2, z2 or the same with another pair of
 * words. Returns false if one of the ends has no x or y. */
static bool find_line_columns(const csv_reader *table, const thr_header *header, columns *meaning)
{
  const char *word[2];

  for (int pair = 0; thr_header_pair(pair, word); pair++) {
    *meaning = no_columns(table, LINE_ROWS, true);

    /* Going backwards makes the first of several columns of one meaning count. */
    for (int i = table->n_fields - 1; i >= 0; i--)
      for (int end = 0; end < 2; end++) {
        const int axis = thr_header_end_axis(&header[i], word[end]);
        if (axis >= 0) meaning->xyz[3 * end + axis] = i;
      }
    if (meaning->xyz[0] >= 0 && meaning->xyz[1] >= 0 && meaning->xyz[3] >= 0 &&
        meaning->xyz[4] >= 0)
      return true;
  }

  return false;
}

/* Finds the columns of nodes: x, y, z, the feet and the name, which is the first column that means
 * a name or else the first of the table. Returns false if there is no x or no y. */
static bool find_node_columns(const csv_reader *table, const thr_header *header, columns *meaning)
{
  *meaning = no_columns(table, NODE_ROWS, true);
  for (int i = table->n_fields - 1; i >= 0; i--) {
    const int axis = thr_header_axis(&header[i]);
    if (axis >= 0) meaning->xyz[axis] = i;
    if (thr_header_feet(&header[i])) meaning->foot = i;
    if (thr_header_names_nodes(&header[i])) meaning->id = i;
  }

  /* The first column is the name unless it means something else. */
  if (meaning->id < 0 && meaning->xyz[0] && meaning->xyz[1] && meaning->xyz[2] && meaning->foot)
    meaning->id = 0;

  return meaning->xyz[0] >= 0 && meaning->xyz[1] >= 0;
}

/* Finds the column of lines as well-known text. */
static bool find_text_column(const csv_reader *table, const thr_header *header, columns *meaning)
{
  *meaning = no_columns(table, TEXT_ROWS, true);
  for (int i = table->n_fields - 1; i >= 0; i--)
    if (thr_header_lines(&header[i])) meaning->text = i;
  return meaning->text >= 0;
}

/* Takes the unit that the headers of coordinates and lengths name. THR_EINPUT if there are two
 * different units. */
static thr_status take_units(csv_reader *table, const thr_header *header)
{
  for (int i = 0; i < table->n_fields; i++) {
    /* Only columns that are read count; of edges by names that is the length alone. */
    bool used = i == table->columns.length;
    for (int k = 0; k < 6 && !used; k++)
      used = table->columns.kind != EDGE_ROWS && i == table->columns.xyz[k];
    if (!used || !header[i].unit[0]) continue;
    if (table->draft->units[0] && strcmp(table->draft->units, header[i].unit) != 0)
      return thr_scan_fail(&table->scan, table->err,
                           "lengths in %s and in %s; give all of them in one unit",
                           table->draft->units, header[i].unit);
    thr_status st = thr_draft_set_units(table->draft, header[i].unit, table->err);
    if (st) return st;
  }

  return THR_OK;
}

/* Returns whether a node read so far has this name. O(nodes): for the time before edges begin, when
 * there is no list by name. */
static bool is_node(const csv_reader *table, thr_span name)
{
  bool found = false;
  for (int v = 0; v < table->draft->n_nodes && !found; v++) {
    const char *own = thr_draft_name(table->draft, v);
    found = own && strlen(own) == name.n && memcmp(own, name.s, name.n) == 0;
  }
  return found;
}

/* Finds out whether this row is a header that names coordinates, and takes the columns from such a
 * header. */
static thr_status coordinate_header(csv_reader *table, bool *is)
{
  thr_header header[MAX_FIELDS];
  columns meaning;

  /* Headers are tried from the most specific to the least. */
  *is = read_headers(table, header) &&
        (find_line_columns(table, header, &meaning) || find_node_columns(table, header, &meaning) ||
         (table->columns.kind == NO_ROWS && find_text_column(table, header, &meaning)));

  /* A row of two fields that both name nodes is the first edge after the nodes, even if it reads
   * like a header. */
  if (*is && table->columns.kind == NODE_ROWS && table->n_fields == 2)
    *is = !is_node(table, table->field[0]) || !is_node(table, table->field[1]);
  if (!*is) return THR_OK;
  if (meaning.kind == LINE_ROWS) find_edge_columns(table, &meaning);
  table->columns = meaning;

  return take_units(table, header);
}

/* Sets the two columns of the ends to those that --columns asks for, by name or by number from
 * 1. */
static thr_status find_asked_ends(csv_reader *table)
{
  thr_span rest = thr_span_of(table->draft->columns);

  for (int end = 0; end < 2; end++) {
    const char *comma = end ? NULL : memchr(rest.s, ',', rest.n);
    const thr_span asked =
        thr_span_trim((thr_span){rest.s, comma ? (size_t)(comma - rest.s) : rest.n});

    /* A name counts before a number. */
    int number = 0, at = -1;
    for (int i = table->n_fields - 1; i >= 0 && table->columns.header; i--)
      if (thr_span_same(table->field[i], asked)) at = i;
    if (at < 0 && thr_span_int(asked, &number) && number >= 1 && number <= table->n_fields)
      at = number - 1;

    /* The message lists what could have been asked for. */
    if (at < 0) {
      char seen[160];
      list_columns(table, seen, sizeof seen);
      return thr_scan_fail(&table->scan, table->err,
                           "no column '%.*s', which --columns asks for, among %s",
                           thr_span_width(asked), asked.s,
                           table->columns.header ? seen : "the numbers of the columns");
    }
    table->columns.ends[end] = at;
    rest = comma ? (thr_span){comma + 1, rest.n - (size_t)(comma + 1 - rest.s)} : (thr_span){"", 0};
  }

  table->columns.paired = true;
  return THR_OK;
}

/* Marks the columns whose values all name nodes, in the rows that are left and, if there is no
 * header, in this one. *counts becomes whether the first column counts the rows, from 0 or 1. */
static thr_status find_naming_columns(const csv_reader *table, bool *names, bool *counts)
{
  csv_reader ahead = *table;
  bool more = true;
  int number, row = 0, first = 0, node;
  thr_status st = THR_OK;

  /* Read ahead with a copy of the state; it only needs a scratch of its own. */
  ahead.scratch = (thr_text){0};
  for (int i = 0; i < MAX_FIELDS; i++)
    names[i] = i < table->n_fields;
  *counts = true;

  if (table->columns.header) st = next_row(&ahead, &more);

  /* A column drops out with the first value that names no node. */
  for (; more && !st; row++) {
    for (int i = 0; i < table->n_fields && !st; i++) {
      if (!names[i]) continue;
      st = node_in(&ahead, field_at(&ahead, i), &node);
      names[i] = !st && node >= 0;
    }

    /* Row numbers go up by one from 0 or 1. */
    *counts = *counts && thr_span_int(plain_name(ahead.field[0]), &number) &&
              (row == 0 ? number == 0 || number == 1 : number == first + row);
    if (row == 0) first = number;
    if (!st) st = next_row(&ahead, &more);
  }

  /* One row counts nothing. */
  *counts = *counts && row > 1;
  thr_text_destroy(&ahead.scratch);
  return st;
}

/* Sets the two columns of the ends by their values, where the headers do not say them: the two
 * columns that always name nodes. A third such column is the number of the bar if its header says
 * so, or, if it is the first one, if it counts the rows. */
static thr_status find_ends_by_values(csv_reader *table, const thr_header *header)
{
  bool names[MAX_FIELDS], counts;
  int n = 0;

  if (table->draft->columns) return find_asked_ends(table);
  thr_status st = find_naming_columns(table, names, &counts);

  /* Drop numbers of bars as long as more than two columns name nodes. */
  for (int i = 0; i < table->n_fields; i++)
    n += names[i];
  for (int i = 0; i < table->n_fields && n > 2; i++)
    if (names[i] && (header ? thr_header_names_bars(&header[i]) : i == 0 && counts)) {
      names[i] = false;
      n--;
    }

  if (!st && n > 2)
    return thr_scan_fail(&table->scan, table->err,
                         "%d columns name nodes; say which two are the ends of an edge with "
                         "--columns 2,3 or a header a,b",
                         n);

  /* With exactly two columns nothing is left to choose; with fewer the first two columns stay, and
   * the rows will say what is wrong. */
  for (int i = 0, end = 0; i < table->n_fields && n == 2; i++)
    if (names[i]) table->columns.ends[end++] = i;

  return st;
}

/* Learns from the header of edges which columns the ends are in: those of a pair of words such as
 * "start" and "end". Of several pairs the first one whose values all name nodes counts. Without a
 * pair the values decide. */
static thr_status edge_header(csv_reader *table)
{
  thr_header header[MAX_FIELDS];
  bool names[MAX_FIELDS] = {false}, counts, found = false;
  const char *word[2];
  thr_status st = THR_OK;

  /* Which columns could name nodes is known only where the nodes are known. */
  table->columns = no_columns(table, EDGE_ROWS, true);
  for (int i = 0; i < table->n_fields; i++)
    header[i] = thr_header_of(table->field[i]);

  if (table->n_fields > 2 && table->draft->n_nodes) st = find_naming_columns(table, names, &counts);

  /* The first pair of columns in the order of the words is taken, and replaced by the first one
   * whose values name nodes. */
  for (int pair = 0; thr_header_pair(pair, word); pair++)
    for (int a = 0; a < table->n_fields; a++)
      for (int b = 0; b < table->n_fields; b++) {
        if (a == b || (found && !(names[a] && names[b])) ||
            !thr_header_ends(&header[a], &header[b], word))
          continue;
        if (found && names[table->columns.ends[0]] && names[table->columns.ends[1]]) continue;
        table->columns.ends[0] = a;
        table->columns.ends[1] = b;
        table->columns.paired = found = true;
      }

  /* --columns has the last word. */
  if (!st && table->draft->columns) st = find_asked_ends(table);
  if (!st && !table->columns.paired && table->n_fields > 2 && table->draft->n_nodes)
    st = find_ends_by_values(table, header);

  find_edge_columns(table, &table->columns);

  /* A column of the ends has no second meaning. */
  int *const named[] = {&table->columns.length, &table->columns.cover, &table->columns.capacity};
  for (int i = 0; i < 3; i++)
    if (*named[i] == table->columns.ends[0] || *named[i] == table->columns.ends[1]) *named[i] = -1;

  return st ? st : take_units(table, header);
}

/* Returns whether no field of the row is a number. */
static bool all_words(const csv_reader *table)
{
  double x;
  for (int i = 0; i < table->n_fields; i++)
    if (number_at(table, i, &x)) return false;
  return true;
}

/* ---- rows ---- */

/* Watches numbers with a dot where ';' parts the fields, because such a dot may part thousands:
 * 1.234 is 1234 in German. Keeps the first number whose dot may part thousands for a note, and
 * whether there is one whose dot cannot. Thousands are 1 to 3 digits, not 0 first, a dot and 3
 * digits. */
static void watch_dot(csv_reader *table, thr_span number)
{
  if (number.n && (number.s[0] == '-' || number.s[0] == '+'))
    number = (thr_span){number.s + 1, number.n - 1};

  if (table->separator != ';' || !number.n || !memchr(number.s, '.', number.n)) return;
  bool thousands =
      number.n >= 5 && number.n <= 7 && number.s[0] != '0' && number.s[number.n - 4] == '.';

  /* All but the dot are digits. */
  for (size_t i = 0; i < number.n && thousands; i++)
    thousands = i + 4 == number.n || (number.s[i] >= '0' && number.s[i] <= '9');

  table->plain |= !thousands;
  char *example = table->report->thousands;
  if (thousands && !*example)
    snprintf(example, sizeof table->report->thousands, "%.*s", (int)number.n, number.s);
}

/* Reads three coordinates from the columns at[3]. An empty z is 0 and is counted. */
static thr_status read_coordinates(csv_reader *table, const int *at, double xyz[3])
{
  /* Each coordinate must be a number, but for z. */
  for (int i = 0; i < 3; i++) {
    thr_span field = field_at(table, at[i]);
    xyz[i] = 0;
    if (i == 2 && field.n == 0) { /* flat frameworks have no z */
      table->empty_z++;
      continue;
    }
    table->has_z |= i == 2;
    if (field.n == 0)
      return thr_scan_fail(&table->scan, table->err, "no %c coordinate in column %d; give a number",
                           'x' + i, at[i] + 1);
    if (!number_at(table, at[i], &xyz[i]))
      return thr_scan_fail(
          &table->scan, table->err,
          "'%.*s' in column %d is not a finite number; give %c as a decimal number",
          thr_span_width(field), field.s, at[i] + 1, 'x' + i);
    watch_dot(table, field);
  }

  return THR_OK;
}

/* Reads whether the node is a foot. */
static thr_status read_foot(const csv_reader *table, bool *foot)
{
  thr_span field = field_at(table, table->columns.foot);
  if (!thr_span_truth(field, foot))
    return thr_scan_fail(&table->scan, table->err,
                         "'%.*s' in column %d does not say whether this is a foot; use 1 or 0",
                         thr_span_width(field), field.s, table->columns.foot + 1);
  return THR_OK;
}

/* Reads the length of an edge, in the units of the coordinates; 0 = the distance of its nodes. */
static thr_status read_length(csv_reader *table, double *length)
{
  thr_span field = field_at(table, table->columns.length);
  *length = 0;

  watch_dot(table, field);
  if (field.n == 0 || (number_at(table, table->columns.length, length) && *length > 0))
    return THR_OK;

  return thr_scan_fail(
      &table->scan, table->err,
      "length '%.*s' is not a positive number; leave it empty for the distance of the two nodes",
      thr_span_width(field), field.s);
}

/* Reads a whole number from 1; *count becomes 0 if the field is empty. */
static thr_status read_count(const csv_reader *table, int at, const char *what, int *count)
{
  thr_span field = field_at(table, at);
  *count = 0;
  if (field.n == 0 || (thr_span_int(plain_name(field), count) && *count >= 1)) return THR_OK;
  return thr_scan_fail(&table->scan, table->err,
                       "%s '%.*s' is not a whole number from 1 on; leave it empty if there is none",
                       what, thr_span_width(field), field.s);
}

/* Appends an edge from node a to node b with what its row says beside the ends. */
static thr_status finish_edge(csv_reader *table, int a, int b)
{
  double length;
  int cover, capacity;
  thr_err local = {0};
  thr_status st = read_length(table, &length);

  if (!st) st = read_count(table, table->columns.cover, "cover", &cover);
  if (!st) st = read_count(table, table->columns.capacity, "capacity", &capacity);
  if (!st) st = thr_draft_add_edge(table->draft, a, b, length, table->err);
  if (st) return st;

  /* The draft says what is wrong with the passes, the scanner where. */
  st = thr_draft_edge_passes(table->draft, cover, capacity, &local);
  return st ? thr_scan_fail(&table->scan, table->err, "%s", local.text) : THR_OK;
}

/* Appends the node of the row. Nodes without a name are called by their number, from 0. */
static thr_status add_node(csv_reader *table)
{
  double xyz[3];
  bool foot;
  thr_status st = read_coordinates(table, table->columns.xyz, xyz);

  if (!st) st = read_foot(table, &foot);
  if (st) return st;

  /* A column of names must have one for each node. */
  thr_span id = field_at(table, table->columns.id);
  if (table->columns.id >= 0 && id.n == 0)
    return thr_scan_fail(&table->scan, table->err, "the node has no name in column %d",
                         table->columns.id + 1);

  if (!thr_text_is_utf8(id.s, id.n))
    return thr_scan_fail(&table->scan, table->err,
                         "the node's name is not UTF-8; save the file as UTF-8 text");

  /* The name is copied like any other, so that messages find it. */
  char number[16];
  const char *name;
  snprintf(number, sizeof number, "%d", table->draft->n_nodes);
  st = name_in(table, table->columns.id < 0 ? thr_span_of(number) : id, &name);

  return st ? st : thr_draft_add_node(table->draft, xyz, name, foot, table->err);
}

/* Appends the edge of a row that names both ends. */
static thr_status add_edge(csv_reader *table)
{
  int end[2];

  /* The nodes must be known by now. */
  for (int i = 0; i < 2; i++) {
    thr_span id = field_at(table, table->columns.ends[i]);
    thr_status st = node_in(table, id, &end[i]);
    if (st) return st;
    if (end[i] < 0)
      return thr_scan_fail(&table->scan, table->err,
                           "there is no node '%.*s'; the nodes are called '%.40s' to '%.40s'",
                           thr_span_width(id), id.s, thr_draft_name(table->draft, 0),
                           thr_draft_name(table->draft, table->draft->n_nodes - 1));
  }

  return finish_edge(table, end[0], end[1]);
}

/* Appends the edge of a row of six coordinates. Nodes at one place are welded later. */
static thr_status add_line(csv_reader *table)
{
  double a[3], b[3];
  thr_status st = read_coordinates(table, table->columns.xyz, a);
  if (!st) st = read_coordinates(table, table->columns.xyz + 3, b);
  if (!st) st = thr_draft_add_node(table->draft, a, NULL, false, table->err);
  if (!st) st = thr_draft_add_node(table->draft, b, NULL, false, table->err);
  return st ? st : finish_edge(table, table->draft->n_nodes - 2, table->draft->n_nodes - 1);
}

/* Ends a point of a well-known text, with n numbers, and appends the edge to the point from the one
 * before, if *before >= 0. */
static thr_status end_point(csv_reader *table, const double *number, int n, bool measured,
                            int *before)
{
  const double xyz[3] = {number[0], number[1], n > 2 && !measured ? number[2] : 0};

  /* A second number after z is a measure, too. */
  table->has_z |= n > 2 && !measured;
  thr_status st = n < 2 ? thr_scan_fail(&table->scan, table->err,
                                        "a point of one number; give x and y or x, y and z")
                        : THR_OK;
  if (!st) st = thr_draft_add_node(table->draft, xyz, NULL, false, table->err);

  /* The first point of a line has none before it. */
  if (!st && *before >= 0)
    st = thr_draft_add_edge(table->draft, *before, table->draft->n_nodes - 1, 0, table->err);
  *before = table->draft->n_nodes - 1;

  return st;
}

/* Appends the lines of a well-known text, "LINESTRING Z (0 0 0, 20 0 0)": lists of points in
 * brackets. */
static thr_status add_text(csv_reader *table)
{
  const thr_span whole = field_at(table, table->columns.text);
  thr_span text = {"", 0};
  double number[4];
  int n_numbers = 0, depth = 0, before = -1;
  bool measured;

  if (whole.n == 0) return THR_OK;
  const char *kind = wkt_of(whole, &text, &measured);
  if (!kind)
    return thr_scan_fail(
        &table->scan, table->err,
        "'%.*s' in column %d is no line; write LINESTRING Z (0 0 0, 20 0 0), in quotes",
        thr_span_width(whole), whole.s, table->columns.text + 1);

  /* Points have no edges; the report counts them. */
  if (strstr(kind, "POINT")) thr_report_skip(table->report, thr_span_of(kind));
  if (strstr(kind, "POINT") || (text.n && text.s[0] != '(')) return THR_OK; /* EMPTY */

  /* A token is a bracket, a comma, a blank or a number. A comma or a closing bracket ends a point;
   * a closing bracket ends a line as well. */
  for (size_t i = 0, n; i < text.n; i += n) {
    for (n = 0; i + n < text.n && !strchr("(), 	", text.s[i + n]);)
      n++;
    thr_status st = THR_OK;
    if (n == 0 && text.s[i] == '(') {
      depth++;
    } else if (n == 0 && text.s[i] != ' ' && text.s[i] != '	') {
      if (n_numbers) st = end_point(table, number, n_numbers, measured, &before);
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

  return depth == 0
             ? THR_OK
             : thr_scan_fail(&table->scan, table->err, "'%.*s' is not lists of points in brackets",
                             thr_span_width(text), text.s);
}

/* ---- what kind of row ---- */

/* Makes this and the following rows edges, whose ends are in the first two columns. */
static thr_status begin_edges(csv_reader *table)
{
  table->columns = no_columns(table, EDGE_ROWS, false);
  return table->names.entry
             ? THR_OK
             : thr_names_build(&table->names, table->draft, table->scan.name, table->err);
}

/* Sets what the columns of rows without a header mean, by their number. */
static thr_status guess_columns(csv_reader *table)
{
  int n = table->n_fields;

  if (table->expected == EDGE_TABLE ? n >= 2 : table->expected == ANY_TABLE && n == 2) {
    thr_status st = begin_edges(table);
    return st || n == 2 ? st : find_ends_by_values(table, NULL);
  }

  /* Lines as text are told by their words. */
  for (int i = 0; i < n && table->expected == ANY_TABLE; i++)
    if (is_line_text(table->field[i])) {
      table->columns = no_columns(table, TEXT_ROWS, false);
      table->columns.text = i;
      return THR_OK;
    }

  /* Six columns are the two ends of a line. */
  if (table->expected == ANY_TABLE && n == 6) {
    table->columns = no_columns(table, LINE_ROWS, false);
    for (int i = 0; i < 6; i++)
      table->columns.xyz[i] = i;
    return THR_OK;
  }

  /* Three or four are a node. */
  if (table->expected == EDGE_TABLE || (n != 3 && n != 4))
    return thr_scan_fail(&table->scan, table->err, "a row of %d fields without a header; %s", n,
                         table->expected == EDGE_TABLE ? "an edge names two nodes"
                         : table->expected == NODE_TABLE
                             ? "a node is x,y,z or id,x,y,z"
                             : "an edge is x1,y1,z1,x2,y2,z2, a node x,y,z or id,x,y,z");

  table->columns = no_columns(table, NODE_ROWS, false);
  if (n == 4) table->columns.id = 0;
  for (int i = 0; i < 3; i++)
    table->columns.xyz[i] = n - 3 + i;

  return THR_OK;
}

/* Learns from a row what this row and those after it are. *used becomes true if the row was a
 * header. */
static thr_status learn(csv_reader *table, bool *used)
{
  bool nodes_open = table->columns.kind == NODE_ROWS, fresh = table->columns.kind == NO_ROWS;
  *used = false;

  if (table->columns.kind == EDGE_ROWS) return THR_OK;

  /* Edges are the last part of a table, so only rows before them can change the meaning of the
   * columns. */
  if (table->expected != EDGE_TABLE && (fresh || nodes_open)) {
    thr_status st = coordinate_header(table, used);
    if (st) return st;
  }

  if (*used) {
    if (table->columns.kind == NODE_ROWS || (table->expected == ANY_TABLE && fresh)) return THR_OK;
    return thr_scan_fail(
        &table->scan, table->err,
        "columns x1 to z2 make a table of their own; take them out of the table of nodes");
  }

  /* A row of words may be the header of edges, or the first edge itself if its words name nodes. */
  if ((fresh || nodes_open) && table->n_fields >= 2 && all_words(table)) {
    char seen[160];
    list_columns(table, seen, sizeof seen);
    if (table->expected == NODE_TABLE)
      return thr_scan_fail(&table->scan, table->err,
                           "the header names no columns x and y but %s; name the columns id,x,y,z",
                           seen);
    int a, b;
    thr_status st = begin_edges(table);
    if (!st) st = node_in(table, table->field[0], &a);
    if (!st) st = node_in(table, table->field[1], &b);
    if (st) return st;
    *used = a < 0 && b < 0;
    return *used                 ? edge_header(table)
           : table->n_fields > 2 ? find_ends_by_values(table, NULL)
                                 : THR_OK;
  }

  /* A short row after longer ones that were nodes begins the edges. */
  if (fresh) return guess_columns(table);
  if (nodes_open && table->expected == ANY_TABLE && table->n_fields == 2 &&
      table->columns.width > 2)
    return begin_edges(table);

  return THR_OK;
}

/* Notes the names of columns that mean nothing in the report, from the row that the columns were
 * learnt from. */
static void note_unused(csv_reader *table)
{
  const columns *meaning = &table->columns;

  for (int i = 0; i < table->n_fields; i++) {
    bool used = i == meaning->id || i == meaning->foot || i == meaning->length ||
                i == meaning->cover || i == meaning->capacity || i == meaning->text;

    /* In rows of edges the coordinates mean nothing, in other rows the ends. */
    for (int k = 0; k < 6; k++)
      used |= meaning->kind != EDGE_ROWS && i == meaning->xyz[k];
    for (int k = 0; k < 2; k++)
      used |= meaning->kind == EDGE_ROWS && i == meaning->ends[k];

    /* As many as fit. */
    const size_t n = strlen(table->report->unused), size = sizeof table->report->unused;
    if (used || n + 1 >= size) continue;
    const char *comma = n ? ", " : "";
    if (meaning->header && table->field[i].n)
      snprintf(table->report->unused + n, size - n, "%s%.*s", comma,
               thr_span_width(table->field[i]), table->field[i].s);
    else
      snprintf(table->report->unused + n, size - n, "%scolumn %d", comma, i + 1);
  }

  thr_text_clean(table->report->unused);
}

/* Appends what the row says. Rows without a header must be as long as the one that the columns were
 * learnt from. */
static thr_status add_row(csv_reader *table)
{
  /* Without a header the number of fields tells what a row is. */
  if (!table->columns.header && table->n_fields != table->columns.width &&
      !(table->expected == EDGE_TABLE && table->n_fields >= 2))
    return thr_scan_fail(&table->scan, table->err, "%d fields where the rows before have %d; %s",
                         table->n_fields, table->columns.width,
                         table->columns.kind == EDGE_ROWS
                             ? "nodes come before edges"
                             : "complete the row or put a header before it");

  switch (table->columns.kind) {
  case NODE_ROWS: return add_node(table);
  case EDGE_ROWS: return add_edge(table);
  case TEXT_ROWS: return add_text(table);
  default: return add_line(table);
  }
}

/* Compares two points by x, then y, then z, for qsort and bsearch. */
static int by_place(const void *pa, const void *pb)
{
  const double *a = pa, *b = pb;
  for (int i = 0; i < 3; i++)
    if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
  return 0;
}

/* Returns whether a vector has length 1, up to a thousandth. */
static bool has_length_one(const double *vector)
{
  return fabs(sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]) - 1) <=
         1e-3;
}

/* Checks that lines without a header are not points with their normals. THR_EINPUT if every second
 * point has length 1 and begins no line, and the first points neither are one point nor have length
 * 1, too: edges of a framework meet, and normals do not. O(n log n). */
static thr_status check_normals(const csv_reader *table)
{
  const int n = table->draft->n_nodes / 2;
  bool one_place = true, all_unit = true, joined = false;

  /* Every second point must have length 1, and some first point must differ. */
  for (int i = 0; i < n; i++) {
    const double *first = table->draft->node[2 * i].xyz;
    if (!has_length_one(table->draft->node[2 * i + 1].xyz)) return THR_OK;
    one_place = one_place && by_place(first, table->draft->node[0].xyz) == 0;
    all_unit = all_unit && has_length_one(first);
  }

  if (one_place || all_unit) return THR_OK;

  /* Sort the beginnings, and look for a line that ends at one of them. */
  double(*begins)[3] = thr_calloc((size_t)n, sizeof *begins);
  if (!begins) return thr_nomem(table->err);
  for (int i = 0; i < n; i++)
    memcpy(begins[i], table->draft->node[2 * i].xyz, sizeof *begins);

  qsort(begins, (size_t)n, sizeof *begins, by_place);
  for (int i = 0; i < n && !joined; i++)
    joined =
        bsearch(table->draft->node[2 * i + 1].xyz, begins, (size_t)n, sizeof *begins, by_place);

  free(begins);
  return joined ? THR_OK
                : thr_fail(table->err, THR_EINPUT,
                           "%s: six columns without a header look like points and their normals; "
                           "if they are edges, put the "
                           "header x1,y1,z1,x2,y2,z2 before them",
                           table->scan.name);
}

/* Reads one table into table->d. An edge table without nodes is not read further than its first
 * row. */
static thr_status read_table(csv_reader *table, const char *text, size_t n, const char *name,
                             thr_csv_content *content)
{
  bool more = true, used;
  *content = THR_CSV_WHOLE;
  thr_status st = thr_scan_start(&table->scan, text, n, name, table->err);

  /* Row by row; each may change what the next ones are. */
  while (!st && !(st = next_row(table, &more)) && more) {
    const row_kind before = table->columns.kind;
    if ((st = learn(table, &used))) break;
    if (used || table->columns.kind != before) note_unused(table);
    *content = table->columns.kind == NODE_ROWS ? THR_CSV_NODES_ONLY : THR_CSV_WHOLE;

    /* Edges without nodes: the caller looks for the nodes. */
    if (table->columns.kind == EDGE_ROWS && table->draft->n_nodes == 0) {
      *content = THR_CSV_EDGES_ONLY;
      break;
    }
    if (!used) st = add_row(table);
  }

  /* What is only known after the last row. */
  if (!st && table->columns.kind == NO_ROWS)
    st = thr_scan_fail(&table->scan, table->err, "the table has no rows");

  if (!st && table->columns.kind == LINE_ROWS && !table->columns.header) st = check_normals(table);
  if (table->plain) table->report->thousands[0] = '\0';
  return st;
}

/* Reports on the table that was read with this status, and frees what only the reading needed. */
static thr_status finish(csv_reader *table, thr_status st)
{
  table->report->no_z = !table->has_z;
  table->report->empty_z = table->has_z ? table->empty_z : 0;
  thr_names_destroy(&table->names);
  thr_text_destroy(&table->scratch);
  if (st) thr_draft_destroy(table->draft);
  return st;
}

thr_status thr_csv_scan(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_csv_content *content, thr_err *err)
{
  csv_reader table = {.expected = ANY_TABLE, .draft = draft, .report = report, .err = err};
  return finish(&table, read_table(&table, text, n, name, content));
}

/* Reads a text as thr_format.parse demands. Half of a pair is THR_EINPUT with advice. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  thr_csv_content content;
  csv_reader table = {.expected = ANY_TABLE, .draft = draft, .report = report, .err = err};
  char seen[160];
  thr_status st = finish(&table, read_table(&table, text, n, name, &content));
  if (st || content == THR_CSV_WHOLE) return st;

  /* The draft has half of a framework at most. */
  thr_draft_destroy(draft);
  list_columns(&table, seen, sizeof seen);

  /* What is missing decides what to advise. */
  if (content == THR_CSV_EDGES_ONLY && table.columns.header && !table.columns.paired)
    return thr_scan_fail(&table.scan, err,
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

/* Reads the table of nodes, then the table of edges, whose ends are looked up by name. */
thr_status thr_csv_parse_pair(thr_draft *draft, thr_read_report *report, const thr_text *nodes,
                              const char *nodes_name, const thr_text *edges, const char *edges_name,
                              thr_err *err)
{
  thr_csv_content content;
  csv_reader node_table = {.expected = NODE_TABLE, .draft = draft, .report = report, .err = err};
  csv_reader edge_table = {.expected = EDGE_TABLE, .draft = draft, .report = report, .err = err};

  /* Nodes first, so that the edges can be looked up by name. */
  thr_status st = read_table(&node_table, nodes->data, nodes->length, nodes_name, &content);
  report->no_z = !node_table.has_z;
  report->empty_z = node_table.has_z ? node_table.empty_z : 0;

  if (!st && draft->n_nodes == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no row with a node's coordinates", nodes_name);

  /* The edges see the nodes by their names. */
  if (!st) st = thr_names_build(&edge_table.names, draft, nodes_name, err);
  if (!st) st = read_table(&edge_table, edges->data, edges->length, edges_name, &content);
  thr_names_destroy(&node_table.names);
  thr_names_destroy(&edge_table.names);
  thr_text_destroy(&node_table.scratch);
  thr_text_destroy(&edge_table.scratch);
  if (st) thr_draft_destroy(draft);

  return st;
}

const thr_format thr_csv_format = {
    .name = "csv", .ending = {"csv", "tsv"}, .parse = parse, .write = thr_csv_write, .pairs = true};
