/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads and writes PLY, the Stanford polygon format: ASCII and both binary byte orders, elements
 * and properties in any order. Vertices have x, y and z, edges vertex1 and vertex2, faces,
 * polylines and strips of triangles vertex_indices. Source: G. Turk, "The PLY Polygon File Format",
 * 1994.
 *
 * The header declares elements (how many vertices, edges, ..), and for each of them its properties:
 * numbers or lists of numbers. After the header come the items of each element in turn, each with
 * its properties in order. Without a correct header nothing after it makes sense, so anything left
 * over is an error.
 *
 * Example of a header:
 *     ply
 *     format ascii 1.0
 *     element vertex 2
 *     property double x
 *     property double y
 *     property double z
 *     element edge 1
 *     property int vertex1
 *     property int vertex2
 *     end_header */
#include "graph/io/read_parts.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The types of numbers. */
typedef enum {
  INT8,
  UINT8,
  INT16,
  UINT16,
  INT32,
  UINT32,
  INT64,
  UINT64,
  FLOAT32,
  FLOAT64,
  N_TYPES
} number_type;
/* What a property means; X .. VERTEX_2 are indices of an item's values, too. */
typedef enum { IGNORED, X, Y, Z, VERTEX_1, VERTEX_2, CORNERS } role;
typedef enum { ASCII, LITTLE, BIG } encoding;
typedef enum { OTHER, VERTEX, EDGE, FACE, LINE, STRIP } element_kind;

/* A property of an element: a number, or a list that begins with its length. */
typedef struct {
  bool list;
  number_type count, type; /* count: of a list's length */
  role role;
} property;

/* An element: a table of n items with the same properties. */
typedef struct {
  element_kind kind;
  char name[24];
  double n;        /* how many, a whole number */
  int first, last; /* its properties are first .. last - 1 */
} element;

/* The state of one reading. */
typedef struct {
  thr_scan scan; /* the header, then, if ascii, the rest */
  thr_span line; /* ascii: what is left of the current line */
  encoding encoding;
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  thr_faces faces;
  element *element; /* owned */
  int n_elements, elements_capacity;
  property *property; /* owned */
  int n_properties, properties_capacity;
  const element *now; /* the element being read, and which of its items, from 0 */
  double item;
  thr_span row; /* ascii: the line on which that item begins, if nothing stands before it */
  /* The first item that ends before its row does (ASCII), which is no fault of a stream without
   * rows. */
  const element *short_of; /* NULL: there is none */
  double short_item;
  int short_line, row_values, item_values;
} ply_reader;

/* Records THR_EINPUT: the row has more values than the header declares, which is why the numbers
 * after the row make no sense. */
static thr_status fail_at_long_row(ply_reader *reader)
{
  reader->scan.line = reader->short_line;
  return thr_scan_fail(
      &reader->scan, reader->err,
      "%s %.0f: the row has %d values, the header declares %d; correct the header or export again",
      reader->short_of->name, reader->short_item, reader->row_values, reader->item_values);
}

/* Records THR_EINPUT about the current item, with its line if the file is ASCII. */
static thr_status fail(ply_reader *reader, const char *what)
{
  /* The long row is the cause of what was found later. */
  if (reader->short_of) return fail_at_long_row(reader);
  if (reader->encoding == ASCII)
    return thr_scan_fail(&reader->scan, reader->err, "%s %.0f: %s", reader->now->name, reader->item,
                         what);
  return thr_fail(reader->err, THR_EINPUT, "%s: %s %.0f: %s", reader->scan.name, reader->now->name,
                  reader->item, what);
}

/* ---- the header ---- */

/* Returns the type with this name, or N_TYPES. */
static number_type type_named(thr_span word)
{
  static const char *const names[N_TYPES][2] = {
      {"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"}, {"ushort", "uint16"},
      {"int", "int32"},     {"uint", "uint32"},   {"long", "int64"},  {"ulong", "uint64"},
      {"float", "float32"}, {"double", "float64"}};
  number_type type = INT8;

  while (type < N_TYPES && !thr_span_is(word, names[type][0]) && !thr_span_is(word, names[type][1]))
    type++;

  return type;
}

/* Returns what a property means, by the words that programs use. */
static role role_of(element_kind kind, bool list, thr_span name)
{
  static const struct {
    element_kind kind;
    bool list;
    const char *name;
    role role;
  } known[] = {{VERTEX, false, "x", X},
               {VERTEX, false, "y", Y},
               {VERTEX, false, "z", Z},
               {EDGE, false, "vertex1", VERTEX_1},
               {EDGE, false, "vertex2", VERTEX_2},
               {EDGE, false, "vertex_1", VERTEX_1},
               {EDGE, false, "vertex_2", VERTEX_2},
               {EDGE, false, "v1", VERTEX_1},
               {EDGE, false, "v2", VERTEX_2},
               {EDGE, false, "start", VERTEX_1},
               {EDGE, false, "end", VERTEX_2}};

  static const char *const corners[] = {"vertex_indices", "vertex_index", "vertex_ids", "vertices",
                                        "indices"};

  /* Numbers first, then lists of vertices, which all elements but vertices may have. */
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (known[i].kind == kind && known[i].list == list && thr_span_is(name, known[i].name))
      return known[i].role;

  for (size_t i = 0; i < sizeof corners / sizeof *corners && list && kind >= EDGE; i++)
    if (thr_span_is(name, corners[i])) return CORNERS;

  return IGNORED;
}

/* Returns the kind of an element by its name. */
static element_kind kind_named(thr_span word)
{
  static const struct {
    const char *name;
    element_kind kind;
  } known[] = {{"vertex", VERTEX}, {"edge", EDGE},      {"face", FACE},      {"polyline", LINE},
               {"line", LINE},     {"tristrip", STRIP}, {"tristrips", STRIP}};

  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(word, known[i].name)) return known[i].kind;

  return OTHER;
}

/* Reads "element vertex 12". */
static thr_status read_element(ply_reader *reader, thr_span rest)
{
  thr_span name = thr_span_word(&rest), count = thr_span_word(&rest);
  element table = {OTHER, "", 0, reader->n_properties, reader->n_properties};

  /* Numbers of 2^31 and more would not fit into the framework. */
  if (!name.n || !thr_span_number(count, false, &table.n) || table.n < 0 ||
      table.n != floor(table.n))
    return thr_scan_fail(&reader->scan, reader->err,
                         "an element needs a name and how many there are");

  if (table.n > INT_MAX)
    return thr_scan_fail(&reader->scan, reader->err, "more than %d are not read", INT_MAX);

  /* A table that is not used must still be read over. */
  table.kind = kind_named(name);
  snprintf(table.name, sizeof table.name, "%.*s", name.n < 20 ? (int)name.n : 20, name.s);
  thr_text_clean(table.name);
  if (table.kind == OTHER && table.n > 0) thr_report_skip(reader->report, name);
  thr_status st = thr_grow(&reader->element, reader->n_elements, &reader->elements_capacity,
                           sizeof *reader->element, reader->err);

  if (!st) reader->element[reader->n_elements++] = table;
  return st;
}

/* Reads "property float x" or "property list uchar int vertex_indices", of the element declared
 * last. */
static thr_status read_property(ply_reader *reader, thr_span rest)
{
  property field = {0};
  thr_span word = thr_span_word(&rest);

  if (reader->n_elements == 0)
    return thr_scan_fail(&reader->scan, reader->err, "a property before the first element");

  element *table = &reader->element[reader->n_elements - 1];

  /* A list has a type for its length and one for its values. */
  field.list = thr_span_is(word, "list");
  if (field.list) {
    field.count = type_named(thr_span_word(&rest));
    word = thr_span_word(&rest);
  }

  field.type = type_named(word);
  word = thr_span_word(&rest);
  if (field.type == N_TYPES || field.count == N_TYPES || !word.n)
    return thr_scan_fail(
        &reader->scan, reader->err,
        "a property is a type (char .. double, int8 .. float64) or a list of one, and a name");

  /* Properties of one element follow one another. */
  field.role = role_of(table->kind, field.list, word);
  thr_status st = thr_grow(&reader->property, reader->n_properties, &reader->properties_capacity,
                           sizeof *reader->property, reader->err);
  if (st) return st;
  reader->property[reader->n_properties++] = field;

  table->last = reader->n_properties;
  return THR_OK;
}

/* Reads "format ascii 1.0". */
static thr_status read_format(ply_reader *reader, thr_span rest)
{
  static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  thr_span word = thr_span_word(&rest);

  /* The names are in the order of the encodings. */
  for (int i = ASCII; i <= BIG; i++)
    if (thr_span_is(word, names[i])) {
      reader->encoding = (encoding)i;
      return THR_OK;
    }

  return thr_scan_fail(
      &reader->scan, reader->err,
      "the format is '%.*s'; ascii, binary_little_endian and binary_big_endian are read",
      thr_span_width(word), word.s);
}

/* Returns whether the element has a property for each role from first to last. */
static bool has_roles(const ply_reader *reader, const element *table, role first, role last)
{
  for (role r = first; r <= last; r++) {
    bool found = false;
    for (int i = table->first; i < table->last; i++)
      found = found || reader->property[i].role == r;
    if (!found) return false;
  }
  return true;
}

/* Checks that elements which are used have all that they need; THR_EINPUT else. */
static thr_status check_header(ply_reader *reader)
{
  for (int i = 0; i < reader->n_elements; i++) {
    const element *table = &reader->element[i];
    const char *missing = NULL;

    /* What is needed depends on the kind; edges may have their ends as a list of two. */
    if (table->kind == VERTEX && !has_roles(reader, table, X, Z))
      missing = "vertices need the properties x, y and z";
    if (table->kind == EDGE && !has_roles(reader, table, VERTEX_1, VERTEX_2) &&
        !has_roles(reader, table, CORNERS, CORNERS))
      missing = "edges need the properties vertex1 and vertex2";
    if (table->kind > EDGE && !has_roles(reader, table, CORNERS, CORNERS))
      missing = "faces and lines need the property list vertex_indices";

    /* An element without items needs nothing. */
    if (table->n > 0 && missing)
      return thr_fail(reader->err, THR_EINPUT, "%s: %s; export it again with them",
                      reader->scan.name, missing);
  }

  return THR_OK;
}

/* Reads the header up to the line end_header. */
static thr_status read_header(ply_reader *reader)
{
  thr_span line;
  bool has_format = false;

  for (int i = 0; thr_scan_line(&reader->scan, &line); i++) {
    thr_span word = thr_span_word(&line);
    thr_status st = THR_OK;
    if (i == 0 && !thr_span_is(word, "ply")) break;

    /* By the keyword. Other lines do not matter. */
    if (thr_span_is(word, "format")) {
      st = read_format(reader, line);
      has_format = true;
    } else if (thr_span_is(word, "element")) {
      st = read_element(reader, line);
    } else if (thr_span_is(word, "property")) {
      st = read_property(reader, line);
    } else if (thr_span_is(word, "comment") || thr_span_is(word, "obj_info")) {
      st = thr_scan_units(&reader->scan, line, reader->draft, reader->err);
    } else if (thr_span_is(word, "end_header") && has_format) {
      return check_header(reader);
    }
    if (st) return st;
  }

  /* The loop ends early only without end_header. */
  return thr_fail(reader->err, THR_EINPUT,
                  "%s: the header has no %s, so this is not a whole PLY file", reader->scan.name,
                  has_format ? "line end_header" : "lines ply and format");
}

/* ---- numbers ---- */

/* Returns whether the word is one that programs write for a number that is not finite: nan, -inf,
 * 1.#QNAN. */
static bool is_not_finite(thr_span word)
{
  static const char *const known[] = {"nan",       "inf",     "infinity", "nan(ind)",
                                      "nan(snan)", "1.#qnan", "1.#inf",   "1.#ind"};
  if (word.n && (word.s[0] == '-' || word.s[0] == '+')) word = (thr_span){word.s + 1, word.n - 1};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(word, known[i])) return true;
  return false;
}

/* Reads the next number of an ASCII file, NaN for any word that is not finite. */
static thr_status next_text_number(ply_reader *reader, double *value)
{
  thr_span word;

  /* Rows do not matter: a number may be on a later line. */
  while (!(word = thr_span_word(&reader->line)).n)
    if (!thr_scan_line(&reader->scan, &reader->line))
      return fail(reader, "the file ends here; it is not whole");
  *value = NAN;

  if (thr_span_real(word, value) || is_not_finite(word)) return THR_OK;
  return fail(reader, "not a number");
}

/* Returns a number as a double; the first bytes of b[8] are the number in this machine's byte
 * order. */
static double number_of(const unsigned char *bytes, number_type type)
{
  union {
    uint64_t bits;
    unsigned char bytes[8];
    int8_t i8;
    int16_t i16;
    int32_t i32;
    uint16_t u16;
    uint32_t u32;
    int64_t i64;
    float f;
    double d;
  } number = {0};

  /* memcpy makes no assumption about alignment. */
  memcpy(number.bytes, bytes, 8);
  switch (type) {
  case INT8: return number.i8;
  case UINT8: return number.bytes[0];
  case INT16: return number.i16;
  case UINT16: return number.u16;
  case INT32: return number.i32;
  case UINT32: return number.u32;
  case INT64: return (double)number.i64;
  case UINT64: return (double)number.bits;
  case FLOAT32: return number.f;
  default: return number.d;
  }
}

/* Returns whether this machine stores the highest byte of a number first. */
static bool this_machine_is_big(void)
{
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 0;
}

/* Reads the next number of a binary file. */
static thr_status next_binary_number(ply_reader *reader, number_type type, double *value)
{
  static const unsigned char size[N_TYPES] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  unsigned char bytes[8] = {0};
  size_t n = size[type];

  if ((size_t)(reader->scan.end - reader->scan.at) < n)
    return fail(reader, "the file ends here; it is not whole");

  /* Turn the bytes round if the file's order is not this machine's. */
  const bool turn = (reader->encoding == BIG) != this_machine_is_big();
  for (size_t i = 0; i < n; i++)
    bytes[i] = (unsigned char)reader->scan.at[turn ? n - 1 - i : i];

  reader->scan.at += n;
  *value = number_of(bytes, type);
  return THR_OK;
}

/* Reads a number. A number that is used must be finite; others may be NaN or infinite. */
static thr_status next_number(ply_reader *reader, number_type type, bool used, double *value)
{
  thr_status st = reader->encoding == ASCII ? next_text_number(reader, value)
                                            : next_binary_number(reader, type, value);
  return st || !used || isfinite(*value) ? st : fail(reader, "not a finite number");
}

/* ---- items ---- */

/* Appends a corner to a face; to a polyline, the edge from the corner before; to a strip of
 * triangles, the triangle with the two corners before. run holds the last two corners, by parity,
 * of the *n since the list began or since the last -1, which begins a strip anew. */
static thr_status corner(ply_reader *reader, double value, int run[2], int *n)
{
  /* A -1 is no vertex. */
  if (value == -1 && reader->now->kind == STRIP) {
    *n = 0;
    return THR_OK;
  }

  /* Vertices are counted from 0. Whether they exist is checked at the end. */
  if (value != floor(value) || value < 0 || value > INT_MAX)
    return fail(reader, "a vertex number must be a whole number from 0");

  if (reader->now->kind == FACE) return thr_faces_corner(&reader->faces, (int)value, reader->err);

  /* Each corner after the first k completes an edge (k = 1) or a triangle (k = 2). */
  const int needed = reader->now->kind == STRIP ? 2 : 1;
  thr_status st = THR_OK;
  if (*n >= needed) {
    const int corners[3] = {run[(*n - needed) % 2], run[(*n - 1) % 2], (int)value};
    st = needed == 2 ? thr_faces_add(&reader->faces, corners, 3, reader->err)
                     : thr_faces_add(&reader->faces, corners + 1, 2, reader->err);
  }

  run[(*n)++ % 2] = (int)value;
  return st;
}

/* Reads a list: its length, then its values, which count as corners if the property says so. */
static thr_status read_list(ply_reader *reader, const property *field)
{
  double length, value;
  int run[2], n_run = 0;
  thr_status st = next_number(reader, field->count, true, &length);

  /* NaN has been refused, so the loop ends. */
  if (!st && (length < 0 || length != floor(length)))
    return fail(reader, "the length of a list must be a whole number from 0");
  for (double i = 0; !st && i < length; i++) {
    st = next_number(reader, field->type, field->role == CORNERS, &value);
    if (!st && field->role == CORNERS) st = corner(reader, value, run, &n_run);
  }

  return st;
}

/* Reads one item of the current element: all its properties, then what they make. */
static thr_status read_item(ply_reader *reader)
{
  double value[CORNERS] = {0};
  thr_status st = THR_OK;

  /* Values by role; those of IGNORED properties overwrite each other. */
  for (int i = reader->now->first; i < reader->now->last && !st; i++) {
    const property *field = &reader->property[i];
    double number = 0;
    if (field->list) {
      st = read_list(reader, field);
      continue;
    }
    st = next_number(reader, field->type, field->role != IGNORED, &number);
    if (!st) value[field->role] = number;
  }

  if (!st && reader->now->kind == VERTEX) {
    /* Adding 0. makes 0 of -0. */
    const double xyz[3] = {value[X] + 0., value[Y] + 0., value[Z] + 0.};
    st = thr_draft_add_node(reader->draft, xyz, NULL, false, reader->err);
  }

  /* An edge is a polyline of two corners. Lists have made their corners already. */
  int run[2], n_run = 0;
  if (!st && reader->now->kind == EDGE && has_roles(reader, reader->now, VERTEX_1, VERTEX_2))
    st = corner(reader, value[VERTEX_1], run, &n_run);

  if (!st && n_run) st = corner(reader, value[VERTEX_2], run, &n_run);
  return st ? st : thr_faces_close(&reader->faces, reader->err);
}

/* Returns the number of words of a line. */
static int count_words(thr_span line)
{
  int n = 0;
  while (thr_span_word(&line).n)
    n++;
  return n;
}

/* Moves to the next line that is not blank, if the current one is used up. */
static void begin_row(ply_reader *reader)
{
  reader->row = (thr_span){0};
  if (reader->encoding != ASCII || thr_span_trim(reader->line).n) return;
  while (!thr_span_trim(reader->line).n && thr_scan_line(&reader->scan, &reader->line)) {
  }
  reader->row = thr_span_trim(reader->line); /* ends where the words do */
}

/* Remembers the first item that leaves values of its row over. */
static void end_row(ply_reader *reader)
{
  /* Only rows that the item began count: what is left must be the end of the same row. */
  if (reader->short_of || !reader->row.n || !thr_span_trim(reader->line).n ||
      reader->line.s + reader->line.n != reader->row.s + reader->row.n)
    return;

  reader->short_of = reader->now;
  reader->short_item = reader->item;
  reader->short_line = reader->scan.line;
  reader->row_values = count_words(reader->row);
  reader->item_values = reader->row_values - count_words(reader->line);
}

/* Refuses a file in which anything but blanks is left after the items that its header declares:
 * then the rows have more values than the header says, and every item after the first one may be
 * wrong. */
static thr_status check_end(ply_reader *reader)
{
  /* ASCII: the next row. */
  if (reader->encoding == ASCII) {
    begin_row(reader);
    if (!thr_span_trim(reader->line).n) return THR_OK;
    if (reader->short_of) return fail_at_long_row(reader);
    return thr_scan_fail(
        &reader->scan, reader->err,
        "this is left after all that the header declares; correct the header or export again");
  }

  /* Binary: the bytes that are left. */
  const size_t left = (size_t)(reader->scan.end - reader->scan.at);
  size_t blanks = 0;
  while (blanks < left && strchr(" \t\r\n", reader->scan.at[blanks]) && reader->scan.at[blanks])
    blanks++;

  if (blanks == left) return THR_OK;

  /* Say what the header declares, so that the user finds what is missing. */
  char rows[160] = "";
  for (int i = 0, at = 0; i < reader->n_elements && at < (int)sizeof rows; i++)
    at += snprintf(rows + at, sizeof rows - (size_t)at, "%s%.0f %s with %d", i ? ", " : "",
                   reader->element[i].n, reader->element[i].name,
                   reader->element[i].last - reader->element[i].first);

  return thr_fail(reader->err, THR_EINPUT,
                  "%s: %zu bytes are left after the values that the header declares (%s); correct "
                  "the header or export again",
                  reader->scan.name, left, rows);
}

/* Reads all items of all elements. */
static thr_status read_items(ply_reader *reader)
{
  thr_status st = THR_OK;

  for (int i = 0; i < reader->n_elements && !st; i++) {
    /* An element without properties takes no bytes. */
    reader->now = &reader->element[i];
    if (reader->now->first == reader->now->last) continue; /* nothing is written of these */
    for (reader->item = 0; reader->item < reader->now->n && !st; reader->item++) {
      begin_row(reader);
      st = read_item(reader);
      if (!st) end_row(reader);
    }
  }

  return st ? st : check_end(reader);
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  ply_reader reader = {
      .scan = {name, text, text + n, 1, 1}, .draft = draft, .report = report, .err = err};
  thr_status st =
      n ? read_header(&reader) : thr_fail(err, THR_EINPUT, "%s: the file is empty", name);

  /* Nodes may be named before they come, so edges are made last. */
  if (!st) st = read_items(&reader);
  if (!st) st = thr_faces_finish(&reader.faces, draft, name, err);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT,
                  "%s: no edges and no faces, only %d points; export the lines or the mesh", name,
                  draft->n_nodes);

  thr_faces_destroy(&reader.faces);
  free(reader.element);
  free(reader.property);

  return st;
}

/* Returns whether a text begins as PLY. */
static bool begins(thr_span line)
{
  return thr_span_is(line, "ply");
}

/* Writes a framework. Feet and lengths of their own are lost, because PLY has no words for them. */
static void write(const thr_frame *frame, thr_text *out)
{
  /* The header. */
  thr_text_append(out, "ply\nformat ascii 1.0\ncomment units: ");
  thr_text_append_clean(out, frame->units);
  thr_text_printf(out,
                  "\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\n",
                  frame->n_nodes);

  thr_text_printf(out, "element edge %d\nproperty int vertex1\nproperty int vertex2\nend_header\n",
                  frame->n_edges);

  /* The items: vertices, then edges. */
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++) {
      thr_text_double(out, frame->xyz[v][i]);
      thr_text_byte(out, i < 2 ? ' ' : '\n');
    }

  for (int e = 0; e < frame->n_edges; e++)
    thr_text_printf(out, "%d %d\n", frame->edge[e][0], frame->edge[e][1]);
}

const thr_format thr_ply_format = {
    .name = "ply", .ending = {"ply"}, .begins = begins, .parse = parse, .write = write};
