/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scans text formats: lines, words and numbers, node names, what comments say of units.
 *
 * A span is a part of the file's text, neither copied nor NUL-terminated. All readers of text count
 * lines in the same way and name the line in their messages, "frame.obj:12: ..".
 *
 * Example: on the line " v 1,5 2", thr_span_word takes "v", then "1,5", which thr_span_number reads
 * as 1.5 if commas are decimal. */
#include "graph/io/read_parts.h"
#include "graph/number.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- lines ---- */

/* Starts before the first line, after a byte-order mark. */
thr_status thr_scan_start(thr_scan *scan, const char *text, size_t n, const char *name,
                          thr_err *err)
{
  *scan = (thr_scan){name, text, text, 1, 1};
  if (n == 0) return THR_OK; /* an empty file's text is NULL */
  scan->end += n;

  /* NUL bytes would end names and messages early; UTF-16 has one in every other byte. */
  const char *nul = memchr(scan->at, '\0', n);
  if (nul) {
    for (const char *c = scan->at; c < nul; c++)
      scan->line += *c == '\n';
    return thr_scan_fail(scan, err,
                         "a NUL byte, so this is not plain text; save the file as UTF-8 text");
  }

  /* A byte-order mark in UTF-8. */
  if (n >= 3 && memcmp(scan->at, "\xef\xbb\xbf", 3) == 0) scan->at += 3;
  return THR_OK;
}

/* Moves past the line at scan->at and returns its end. LF, CR and CRLF end a line. */
static const char *skip_line(thr_scan *scan)
{
  const char *c = scan->at;

  while (c < scan->end && *c != '\n' && *c != '\r')
    c++;

  /* CRLF is one end. */
  scan->at = c;
  if (scan->at < scan->end) scan->at += *c == '\r' && c + 1 < scan->end && c[1] == '\n' ? 2 : 1;
  scan->next++;

  return c;
}

bool thr_scan_line(thr_scan *scan, thr_span *line)
{
  if (scan->at >= scan->end) return false;
  scan->line = scan->next;
  line->s = scan->at;
  line->n = (size_t)(skip_line(scan) - line->s);
  return true;
}

bool thr_scan_extend(thr_scan *scan, thr_span *line)
{
  if (scan->at >= scan->end) return false;
  line->n = (size_t)(skip_line(scan) - line->s);
  return true;
}

thr_status thr_scan_fail(const thr_scan *scan, thr_err *err, const char *format, ...)
{
  /* The text first, so that the whole message is put together in one place. */
  char what[400];
  va_list args;
  va_start(args, format);
  vsnprintf(what, sizeof what, format, args);
  va_end(args);
  return thr_fail(err, THR_EINPUT, "%s:%d: %s", scan->name, scan->line, what);
}

/* ---- words and numbers ---- */

thr_span thr_span_of(const char *s)
{
  return (thr_span){s, strlen(s)};
}

/* Returns whether c is a blank or a tab. */
static bool is_blank(char c)
{
  return c == ' ' || c == '\t';
}

thr_span thr_span_trim(thr_span text)
{
  /* From the front, then from the back. */
  while (text.n && is_blank(text.s[0])) {
    text.s++;
    text.n--;
  }

  while (text.n && is_blank(text.s[text.n - 1]))
    text.n--;

  return text;
}

thr_span thr_span_word(thr_span *rest)
{
  thr_span text = thr_span_trim(*rest);
  size_t n = 0;

  /* No word is left. */
  if (text.n == 0) return *rest = text;
  while (n < text.n && !is_blank(text.s[n]))
    n++;
  *rest = (thr_span){text.s + n, text.n - n};

  return (thr_span){text.s, n};
}

/* Returns the small letter of a capital ASCII letter, any other byte as it is. */
static char lower(char c)
{
  return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

bool thr_span_same(thr_span a, thr_span b)
{
  size_t i = 0;
  while (i < a.n && i < b.n && lower(a.s[i]) == lower(b.s[i]))
    i++;
  return i == a.n && i == b.n;
}

bool thr_span_is(thr_span text, const char *word)
{
  return thr_span_same(text, thr_span_of(word));
}

bool thr_span_starts(thr_span text, const char *start)
{
  size_t n = strlen(start);
  return text.n >= n && memcmp(text.s, start, n) == 0;
}

int thr_span_width(thr_span text)
{
  return text.n < 40 ? (int)text.n : 40;
}

/* Returns whether c is a decimal digit. */
static bool is_digit(char c)
{
  return c >= '0' && c <= '9';
}

/* Copies the number with a point and without a plus, and lets graph/number.h read it exactly. */
bool thr_span_number(thr_span text, bool decimal_comma, double *number)
{
  char copy[128]; /* with a point; no sane number is longer */

  if (text.n == 0 || text.n >= sizeof copy) return false;

  /* Only the letters of decimal numbers: this keeps out inf, nan and hexadecimal numbers, which the
   * parser would take. */
  for (size_t i = 0; i < text.n; i++) {
    char c = text.s[i];

    /* A comma is decimal only between two digits. */
    bool comma = decimal_comma && c == ',' && i > 0 && i + 1 < text.n && is_digit(text.s[i - 1]) &&
                 is_digit(text.s[i + 1]);
    if (!is_digit(c) && c != '+' && c != '-' && c != '.' && c != 'e' && c != 'E' && !comma)
      return false; /* inf, nan, hex */
    copy[i] = comma ? '.' : c;
  }

  /* The parser takes no plus. */
  const size_t plus = copy[0] == '+';
  double value;
  if (plus && text.n > 1 && copy[1] == '-') return false;
  if (!thr_number_parse(copy + plus, text.n - plus, &value)) return false;

  /* Makes 0 of -0. */
  *number = value == 0 ? 0 : value;
  return true;
}

/* Reads a number, or looks for the word in lists. */
bool thr_span_truth(thr_span text, bool *yes)
{
  static const char *const affirmative[] = {"true",      "yes",       "x",    "t",         "y",
                                            "wahr",      "ja",        "vrai", "oui",       "si",
                                            "s\xc3\xac", "s\xc3\xad", "vero", "verdadero", "fixed"},
                           *const negative[] = {"",     "false", "no",  "f",     "n",   "falsch",
                                                "nein", "faux",  "non", "falso", "free"};

  double number;
  *yes = false;

  /* A number says yes unless it is 0. */
  if (thr_span_number(text, true, &number)) {
    *yes = number != 0;
    return true;
  }

  /* Words in English, German, French, Italian and Spanish, and those of supports. */
  for (size_t i = 0; i < sizeof affirmative / sizeof *affirmative && !*yes; i++)
    *yes = thr_span_is(text, affirmative[i]);
  for (size_t i = 0; i < sizeof negative / sizeof *negative && !*yes; i++)
    if (thr_span_is(text, negative[i])) return true;

  return *yes;
}

bool thr_span_real(thr_span text, double *number)
{
  char copy[64];

  if (thr_span_number(text, false, number)) return true;
  if (text.n >= sizeof copy) return false;

  /* Fortran's double precision: 1.5D+00. */
  for (size_t i = 0; i < text.n; i++)
    copy[i] = text.s[i] == 'D' || text.s[i] == 'd' ? 'e' : text.s[i];

  return thr_span_number((thr_span){copy, text.n}, false, number);
}

bool thr_span_int(thr_span text, int *number)
{
  bool negative = text.n && text.s[0] == '-';
  size_t i = text.n && (text.s[0] == '-' || text.s[0] == '+') ? 1 : 0;

  if (i == text.n) return false;

  /* Saturate, so that any number of digits is allowed. */
  int64_t value = 0;
  for (; i < text.n; i++) {
    if (!is_digit(text.s[i])) return false;
    value = 10 * value + (text.s[i] - '0');
    if (value > INT_MAX) value = INT_MAX;
  }
  *number = (int)(negative ? -value : value);

  return true;
}

/* ---- names ---- */

/* Compares two names as bytes, then by node. */
static int by_name(const void *pa, const void *pb)
{
  const struct thr_named *a = pa, *b = pb;
  int order = strcmp(a->name, b->name);
  return order ? order : (a->node > b->node) - (a->node < b->node);
}

/* Sorts the nodes by name, so that names can be found by halving. */
thr_status thr_names_build(thr_names *names, const thr_draft *draft, const char *file, thr_err *err)
{
  struct thr_named *entry = thr_calloc((size_t)draft->n_nodes, sizeof *entry);

  if (!entry) return thr_nomem(err);

  /* Sort by name; equal names are neighbours then. */
  for (int v = 0; v < draft->n_nodes; v++)
    entry[v] = (struct thr_named){thr_draft_name(draft, v), v};

  /* The message counts nodes from 1. */
  qsort(entry, (size_t)draft->n_nodes, sizeof *entry, by_name);
  for (int i = 1; i < draft->n_nodes; i++)
    if (strcmp(entry[i - 1].name, entry[i].name) == 0) {
      thr_status st = thr_fail(
          err, THR_EINPUT,
          "%s: two nodes are called '%.40s' (number %d and number %d); give each its own name",
          file, entry[i].name, entry[i - 1].node + 1, entry[i].node + 1);
      free(entry);
      return st;
    }
  *names = (thr_names){draft->n_nodes, entry};

  return THR_OK;
}

int thr_names_find(const thr_names *names, thr_span name)
{
  int low = 0, high = names->n;

  /* Binary search. The name looked for has no NUL: a longer name in the list with the same
   * beginning comes after it. */
  while (low < high) {
    int middle = low + (high - low) / 2;
    const char *here = names->entry[middle].name;
    int order = strncmp(here, name.s, name.n);
    if (order == 0 && here[name.n]) order = 1;
    if (order == 0) return names->entry[middle].node;
    if (order < 0)
      low = middle + 1;
    else
      high = middle;
  }

  return -1;
}

void thr_names_destroy(thr_names *names)
{
  free(names->entry);
  *names = (thr_names){0};
}

/* ---- draft and report ---- */

void thr_report_skip(thr_read_report *report, thr_span keyword)
{
  /* The first one's keyword, cut to the space that there is. */
  if (report->skipped_records++) return;
  snprintf(report->skipped_kind, sizeof report->skipped_kind, "%.*s",
           keyword.n < 31 ? (int)keyword.n : 31, keyword.s);
  thr_text_clean(report->skipped_kind);
}

/* Takes the unit that a comment names, and keeps an earlier one that differs. */
thr_status thr_scan_units(const thr_scan *scan, thr_span comment, thr_draft *draft, thr_err *err)
{
  const char *name, *wrong;

  thr_units_in_comment(comment.s, comment.n, &name, &wrong);

  /* The comment says units: of something else. */
  if (!name && wrong) {
    const thr_span word = thr_span_trim((thr_span){wrong, (size_t)(comment.s + comment.n - wrong)});
    return thr_scan_fail(
        scan, err, "this comment's '%.*s' is no unit of length; correct or delete the comment",
        thr_span_width(word), word.s);
  }

  if (!name) return THR_OK;

  /* The last unit counts; an earlier, different one is kept for a note. */
  if (draft->units[0] && strcmp(draft->units, name) != 0)
    snprintf(draft->other, sizeof draft->other, "%s", draft->units);

  snprintf(draft->units, sizeof draft->units, "%s", name);
  return THR_OK;
}

/* ---- words of a whole text ---- */

bool thr_words_line(thr_words *words)
{
  if (words->status || !thr_scan_line(&words->scan, &words->line)) return false;

  /* What is after # is a comment. */
  const char *sign = memchr(words->line.s, '#', words->line.n);
  if (!sign) return true;
  const thr_span comment = {sign + 1, (size_t)(words->line.s + words->line.n - sign) - 1};
  words->line.n = (size_t)(sign - words->line.s);
  words->status = thr_scan_units(&words->scan, comment, words->draft, words->err);

  return !words->status;
}

thr_span thr_words_next(thr_words *words)
{
  thr_span word;

  /* Lines without words are passed over. */
  while (!(word = thr_span_word(&words->line)).n && thr_words_line(words)) {
  }
  return word;
}

thr_status thr_words_fail(const thr_words *words, const char *what)
{
  return words->status ? words->status : thr_scan_fail(&words->scan, words->err, "%s", what);
}

thr_status thr_words_count(thr_words *words, int *n)
{
  thr_span word = thr_words_next(words);

  if (!word.n) return thr_words_fail(words, "the file ends here; it is not whole");

  /* INT_MAX may be a number that was too large. */
  if (thr_span_int(word, n) && *n >= 0 && *n < INT_MAX) return THR_OK;
  return thr_scan_fail(&words->scan, words->err,
                       "'%.*s' is not a number of vertices, faces or corners", thr_span_width(word),
                       word.s);
}
