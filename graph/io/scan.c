/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Internal to the readers: lines, words and numbers of text formats, node names. */
#include "graph/io/read_parts.h"
#include "graph/framework/frame.h"
#include "graph/number.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- lines ---- */

thr_status thr_scan_start(thr_scan *scan, const char *text, size_t n, const char *name,
                          thr_err *err)
{
  *scan = (thr_scan){name, text, text, 1, 1};
  if (n == 0) return THR_OK; /* an empty file's text is NULL */
  scan->end += n;
  const char *nul = memchr(scan->at, '\0', n);
  if (nul) {
    for (const char *c = scan->at; c < nul; c++)
      scan->line += *c == '\n';
    return thr_scan_fail(scan, err,
                         "a NUL byte, so this is not plain text; save the file as UTF-8 text");
  }
  if (n >= 3 && memcmp(scan->at, "\xef\xbb\xbf", 3) == 0) scan->at += 3;
  return THR_OK;
}

/* Moves past the line at scan->at and returns its end. */
static const char *skip_line(thr_scan *scan)
{
  const char *c = scan->at;
  while (c < scan->end && *c != '\n' && *c != '\r')
    c++;
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

static bool is_blank(char c)
{
  return c == ' ' || c == '\t';
}

thr_span thr_span_trim(thr_span t)
{
  while (t.n && is_blank(t.s[0])) {
    t.s++;
    t.n--;
  }
  while (t.n && is_blank(t.s[t.n - 1]))
    t.n--;
  return t;
}

thr_span thr_span_word(thr_span *rest)
{
  thr_span t = thr_span_trim(*rest);
  size_t n = 0;
  if (t.n == 0) return *rest = t;
  while (n < t.n && !is_blank(t.s[n]))
    n++;
  *rest = (thr_span){t.s + n, t.n - n};
  return (thr_span){t.s, n};
}

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

bool thr_span_is(thr_span t, const char *word)
{
  return thr_span_same(t, thr_span_of(word));
}

bool thr_span_starts(thr_span t, const char *start)
{
  size_t n = strlen(start);
  return t.n >= n && memcmp(t.s, start, n) == 0;
}

int thr_span_width(thr_span t)
{
  return t.n < 40 ? (int)t.n : 40;
}

static bool is_digit(char c)
{
  return c >= '0' && c <= '9';
}

bool thr_span_number(thr_span t, bool decimal_comma, double *x)
{
  char copy[128]; /* with a point; no sane number is longer */
  if (t.n == 0 || t.n >= sizeof copy) return false;
  for (size_t i = 0; i < t.n; i++) {
    char c = t.s[i];
    bool comma = decimal_comma && c == ',' && i > 0 && i + 1 < t.n && is_digit(t.s[i - 1]) &&
                 is_digit(t.s[i + 1]);
    if (!is_digit(c) && c != '+' && c != '-' && c != '.' && c != 'e' && c != 'E' && !comma)
      return false; /* inf, nan, hex */
    copy[i] = comma ? '.' : c;
  }
  const size_t plus = copy[0] == '+';
  double value;
  if (plus && t.n > 1 && copy[1] == '-') return false;
  if (!thr_number_parse(copy + plus, t.n - plus, &value)) return false;
  *x = value == 0 ? 0 : value;
  return true;
}

bool thr_span_truth(thr_span t, bool *yes)
{
  static const char *const affirmative[] = {"true",      "yes",       "x",    "t",         "y",
                                            "wahr",      "ja",        "vrai", "oui",       "si",
                                            "s\xc3\xac", "s\xc3\xad", "vero", "verdadero", "fixed"},
                           *const negative[] = {"",     "false", "no",  "f",     "n",   "falsch",
                                                "nein", "faux",  "non", "falso", "free"};
  double number;
  *yes = false;
  if (thr_span_number(t, true, &number)) {
    *yes = number != 0;
    return true;
  }
  for (size_t i = 0; i < sizeof affirmative / sizeof *affirmative && !*yes; i++)
    *yes = thr_span_is(t, affirmative[i]);
  for (size_t i = 0; i < sizeof negative / sizeof *negative && !*yes; i++)
    if (thr_span_is(t, negative[i])) return true;
  return *yes;
}

bool thr_span_real(thr_span t, double *x)
{
  char copy[64];
  if (thr_span_number(t, false, x)) return true;
  if (t.n >= sizeof copy) return false;
  for (size_t i = 0; i < t.n; i++)
    copy[i] = t.s[i] == 'D' || t.s[i] == 'd' ? 'e' : t.s[i];
  return thr_span_number((thr_span){copy, t.n}, false, x);
}

bool thr_span_int(thr_span t, int *x)
{
  bool negative = t.n && t.s[0] == '-';
  size_t i = t.n && (t.s[0] == '-' || t.s[0] == '+') ? 1 : 0;
  if (i == t.n) return false;
  int64_t value = 0;
  for (; i < t.n; i++) {
    if (!is_digit(t.s[i])) return false;
    value = 10 * value + (t.s[i] - '0');
    if (value > INT_MAX) value = INT_MAX;
  }
  *x = (int)(negative ? -value : value);
  return true;
}

/* ---- names ---- */

static int by_name(const void *pa, const void *pb)
{
  const struct thr_named *a = pa, *b = pb;
  int order = strcmp(a->name, b->name);
  return order ? order : (a->node > b->node) - (a->node < b->node);
}

thr_status thr_names_build(thr_names *names, const thr_draft *draft, const char *file, thr_err *err)
{
  struct thr_named *entry = thr_calloc((size_t)draft->n_nodes, sizeof *entry);
  if (!entry) return thr_nomem(err);
  for (int v = 0; v < draft->n_nodes; v++)
    entry[v] = (struct thr_named){thr_draft_name(draft, v), v};
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
  if (report->skipped_records++) return;
  snprintf(report->skipped_kind, sizeof report->skipped_kind, "%.*s",
           keyword.n < 31 ? (int)keyword.n : 31, keyword.s);
  thr_text_clean(report->skipped_kind);
}

thr_status thr_scan_units(const thr_scan *scan, thr_span comment, thr_draft *draft, thr_err *err)
{
  const char *name, *wrong;
  thr_units_in_comment(comment.s, comment.n, &name, &wrong);
  if (!name && wrong) {
    const thr_span word = thr_span_trim((thr_span){wrong, (size_t)(comment.s + comment.n - wrong)});
    return thr_scan_fail(
        scan, err, "this comment's '%.*s' is no unit of length; correct or delete the comment",
        thr_span_width(word), word.s);
  }
  if (!name) return THR_OK;
  if (draft->units[0] && strcmp(draft->units, name) != 0)
    snprintf(draft->other, sizeof draft->other, "%s", draft->units);
  snprintf(draft->units, sizeof draft->units, "%s", name);
  return THR_OK;
}

/* ---- words of a whole text ---- */

bool thr_words_line(thr_words *words)
{
  if (words->status || !thr_scan_line(&words->scan, &words->line)) return false;
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
  if (thr_span_int(word, n) && *n >= 0 && *n < INT_MAX) return THR_OK;
  return thr_scan_fail(&words->scan, words->err,
                       "'%.*s' is not a number of vertices, faces or corners", thr_span_width(word),
                       word.s);
}
