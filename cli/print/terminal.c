/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits what commands print to the width of the terminal: no line runs over its edge.
 *
 * Tables mark their cells: before each cell but the first stands PRINT_CELL and a digit, which says
 * how soon the column is left out where there is no room: 9 first, 1 last, 0 never. A table is what
 * stands from its first marked line, the head, to the next empty line. It is printed as it is if it
 * fits; else with columns no wider than their cells; else with fewer columns, and a line that names
 * those left out; and columns that may not be left out go on below, beside the first one once more.
 *
 * All other lines are wrapped at blanks, under the text behind their label ("length   577 mm ..").
 * Where no terminal is, only the marks go, so that files and pipes always hold the same.
 *
 * Example: printf("%-5s\v9%8s\v0%8s\n", "cord", "passes", "length") is a head whose second column
 * is the first to go. */
#include "cli/print/print.h"
#include "graph/os.h"

#include <ctype.h>
#include <string.h>
#include <unistd.h>

enum { CELLS = 48, NARROWEST = 30, LABEL = 14 };
enum { MARK = '\v' }; /* PRINT_CELL */

/* ---- cells ---- */

/* A cell of a line without its mark: bytes, and the digit of its column. */
typedef struct {
  const char *at;
  int n, digit;
} cell;

/* Returns the length of a line without its end. */
static int line_length(const char *line)
{
  return (int)strcspn(line, "\n");
}

/* Splits a line of n bytes at its marks. Returns the number of cells. */
static int split(const char *line, int n, cell out[CELLS])
{
  int count = 0;
  const char *end = line + n;

  out[count++] = (cell){line, 0, 0};
  while (line < end) {
    if (*line == MARK && count < CELLS) {
      out[count++] = (cell){line + 2, 0, line[1] - '0'};
      line += 2;
    } else {
      out[count - 1].n++;
      line++;
    }
  }

  return count;
}

static bool ends_blank(cell c)
{
  return c.n > 0 && c.at[c.n - 1] == ' ';
}

/* Returns the cell without blanks at its end, as the first column is printed. */
static cell without_end(cell c)
{
  while (ends_blank(c))
    c.n--;
  return c;
}

/* Returns the cell without blanks at both ends. */
static cell trimmed(cell c)
{
  while (c.n > 0 && *c.at == ' ')
    c.at++, c.n--;
  return without_end(c);
}

static int width_of(cell c)
{
  return thr_text_columns(c.at, (size_t)c.n);
}

/* ---- lines that are not of a table ---- */

/* Returns the column under which a line that is too long goes on: behind its label, or where it
 * begins. */
static int hanging_indent(const char *line, int n)
{
  int at = (int)strspn(line, " ");

  if (at > 0 || n == 0) return at < n ? at : 0;
  while (at < n && line[at] != ' ')
    at++;

  /* A label has two blanks behind it, or is a mark of one letter. */
  const int behind = at + (int)strspn(line + at, " ");
  const bool is_label = behind < n && behind <= LABEL &&
                        (behind >= at + 2 || (at == 1 && ispunct((unsigned char)*line)));

  return is_label ? behind : 0;
}

/* Appends a line of n bytes, wrapped. Commands to copy stay in one piece. */
static void put_prose(thr_text *out, const char *line, int n, int columns)
{
  static const char command[] = "  thread ";
  thr_text words = {0};

  if (thr_text_columns(line, (size_t)n) <= columns ||
      strncmp(line, command, strlen(command)) == 0) {
    thr_text_append_bytes(out, line, (size_t)n);
    thr_text_append(out, "\n");
    return;
  }

  const int indent = hanging_indent(line, n);
  thr_text_append_bytes(out, line, (size_t)indent);
  thr_text_append_bytes(&words, line + indent, (size_t)(n - indent));
  if (words.failed)
    out->failed = true;
  else
    cli_put_wrapped(out, words.data, indent, indent, columns);
  thr_text_destroy(&words);
}

/* ---- tables ---- */

/* What is known of the columns of a table. */
typedef struct {
  int n, width[CELLS], digit[CELLS];
  bool left[CELLS]; /* the cells begin at the left edge, else they end at the right one */
  bool shown[CELLS];
} table_columns;

/* Measures the columns of a table of so many bytes, whose first line is its head. */
static table_columns measure(const char *table, const char *end)
{
  table_columns columns = {0};
  cell cells[CELLS];

  for (const char *line = table; line < end; line += line_length(line) + 1) {
    const int n = split(line, line_length(line), cells);
    if (line == table) columns.n = n;

    /* The last cell of a line with fewer cells may be a sentence. */
    for (int i = 0; i < n && i < columns.n && (n == columns.n || i < n - 1); i++) {
      const cell inner = i == 0 ? without_end(cells[i]) : trimmed(cells[i]);
      if (i + 1 < n && cells[i + 1].n == 0) break; /* a sentence in place of several cells */
      if (width_of(inner) > columns.width[i]) columns.width[i] = width_of(inner);
      if (line != table) continue;
      columns.digit[i] = cells[i].digit;
      const int before = (int)(inner.at - cells[i].at);
      columns.left[i] = i == 0 || (i == n - 1 ? before == 2 : before <= 2 && ends_blank(cells[i]));
      columns.shown[i] = true;
    }
  }

  return columns;
}

/* Returns the width of the columns that are shown. */
static int total_width(const table_columns *columns)
{
  int width = 0;
  for (int i = 0; i < columns->n; i++)
    width += columns->shown[i] ? columns->width[i] + (i > 0 ? 2 : 0) : 0;
  return width;
}

/* Leaves out columns until the others fit, those with the largest digits first. */
static void leave_out(table_columns *columns, int room)
{
  for (int digit = 9; digit > 0; digit--)
    for (int i = columns->n - 1; i > 0 && total_width(columns) > room; i--)
      if (columns->digit[i] == digit) columns->shown[i] = false;
}

/* Appends the head of a table, bold where the terminal has colours. */
static void put_head(thr_text *out, const thr_text *head)
{
  const bool bold = cli_is_coloured(STDOUT_FILENO);

  out->failed |= head->failed;
  if (bold) thr_text_append(out, "\033[1m");
  if (!head->failed) thr_text_append_bytes(out, head->data, head->length);
  thr_text_append(out, bold ? "\033[0m\n" : "\n");
}

/* Appends the table with the columns that are shown, no wider than they need. */
static void put_columns(thr_text *out, const char *table, const char *end,
                        const table_columns *columns, int room)
{
  cell cells[CELLS];

  for (const char *line = table; line < end; line += line_length(line) + 1) {
    const int n = split(line, line_length(line), cells);
    thr_text row = {0};

    if (n == 1) {
      put_prose(out, line, line_length(line), room);
      continue;
    }
    for (int i = 0; i < n; i++) {
      const bool is_sentence = i + 1 < n && cells[i + 1].n == 0;
      if ((i < columns->n && !columns->shown[i]) || (i > 0 && cells[i].n == 0)) continue;
      const cell inner = i == 0 ? without_end(cells[i]) : trimmed(cells[i]);
      const int space = i < columns->n ? columns->width[i] - width_of(inner) : 0;
      const bool left = is_sentence || i >= columns->n || columns->left[i] || n < columns->n;
      thr_text_printf(&row, "%s%*s", i > 0 ? "  " : "", left || space < 0 ? 0 : space, "");
      thr_text_append_bytes(&row, inner.at, (size_t)inner.n);
      if (left && space > 0 && i < n - 1 && !is_sentence) thr_text_printf(&row, "%*s", space, "");
    }
    if (line == table)
      put_head(out, &row);
    else if (row.failed)
      out->failed = true;
    else
      put_prose(out, row.data, (int)row.length, room);
    thr_text_destroy(&row);
  }
}

/* Appends the names of the columns that are left out. */
static void put_left_out(thr_text *out, const char *table, const table_columns *columns, int room)
{
  cell cells[CELLS];
  const int n = split(table, line_length(table), cells);
  thr_text line = {0};

  for (int i = 1; i < n && i < columns->n; i++) {
    const cell inner = trimmed(cells[i]);
    if (columns->shown[i] || columns->digit[i] == 0) continue;
    thr_text_append(&line, line.length ? "; " : "(no room for: ");
    thr_text_append_bytes(&line, inner.at, (size_t)inner.n);
  }
  if (line.length) {
    thr_text_append(&line, ")");
    if (line.failed)
      out->failed = true;
    else
      put_prose(out, line.data, (int)line.length, room);
  }
  thr_text_destroy(&line);
}

/* Returns whether every line of a table fits as it is. */
static bool fits(const char *table, const char *end, int room)
{
  cell cells[CELLS];

  for (const char *line = table; line < end; line += line_length(line) + 1) {
    int width = 0;
    for (int i = 0, n = split(line, line_length(line), cells); i < n; i++)
      width += width_of(cells[i]);
    if (width > room) return false;
  }

  return true;
}

/* Appends lines without their marks. */
static void put_unmarked(thr_text *out, const char *lines, const char *end)
{
  while (lines < end) {
    const char *mark = memchr(lines, MARK, (size_t)(end - lines));
    thr_text_append_bytes(out, lines, (size_t)((mark ? mark : end) - lines));
    lines = mark ? mark + 2 : end;
  }
}

/* Appends a table, in as many parts below each other as it takes. */
static void put_table(thr_text *out, const char *table, const char *end, int room)
{
  if (fits(table, end, room)) {
    const char *rest = table + line_length(table);
    thr_text head = {0};
    put_unmarked(&head, table, rest);
    put_head(out, &head);
    thr_text_destroy(&head);
    if (rest < end) put_unmarked(out, rest + 1, end);
    return;
  }

  table_columns columns = measure(table, end);
  leave_out(&columns, room);
  const table_columns kept = columns;

  /* A part has the first column and what else fits, at least one column. */
  for (int from = 1; from < kept.n;) {
    int to = from;
    for (int i = 1; i < kept.n; i++)
      columns.shown[i] = false;
    while (to < kept.n) {
      columns.shown[to] = kept.shown[to];
      if (to > from && total_width(&columns) > room) {
        columns.shown[to] = false;
        break;
      }
      to++;
    }
    if (from > 1) thr_text_append(out, "\n");
    put_columns(out, table, end, &columns, room);
    from = to;
  }

  put_left_out(out, table, &kept, room);
}

/* Returns where the table that begins here ends: before an empty line, or with the text. */
static const char *end_of_table(const char *line)
{
  const char *end = line;
  while (*end && *end != '\n') {
    end += line_length(end);
    end += *end == '\n';
  }
  return end;
}

void print_fit(thr_text *text, int columns)
{
  thr_text out = {0};

  if (!text->data || text->failed) return;
  if (columns > 0 && columns < NARROWEST) columns = NARROWEST;

  const char *end = text->data + text->length;
  if (columns == 0) put_unmarked(&out, text->data, end);
  for (const char *line = text->data; columns > 0 && line < end;) {
    const int n = line_length(line);
    const bool is_table = memchr(line, MARK, (size_t)n) != NULL;
    const char *next = is_table ? end_of_table(line) : line + n + 1;
    if (is_table)
      put_table(&out, line, next, columns);
    else
      put_prose(&out, line, n, columns);
    line = next;
  }

  out.failed |= text->failed;
  thr_text_destroy(text);
  *text = out;
}

int print_text(thr_text *text)
{
  if (!cli_json) print_fit(text, thr_os_columns(STDOUT_FILENO));
  return cli_write(text, "-");
}
