/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes small pieces of SVG: numbers, text, paths, and the words and ticks of axes.
 *
 * All coordinates are mm on paper with two decimals, which is finer than any printer. Numbers are
 * rounded before they are used (thr_svg_round) where differences between them matter, so that parts
 * meet exactly.
 *
 * Example: thr_svg_move to (1.5, 2) and thr_svg_line to (3, 2) append "M1.50 2.00L3.00 2.00". */
#include "diagram/overview/overview.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Rounds to what is printed. -0.00 would be another text than 0.00, and becomes 0. */
double thr_svg_round(double value)
{
  value = round(value * 100) / 100;
  return value == 0 ? 0 : value;
}

/* Appends the head of a document: physical size, coordinates in mm, title and description for
 * screen readers. */
void thr_svg_open(thr_text *text, double width, double height, const char *title,
                  const char *description)
{
  thr_text_printf(text,
                  "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg "
                  "xmlns=\"http://www.w3.org/2000/svg\" class=\"thread\" "
                  "width=\"%.2fmm\" height=\"%.2fmm\" viewBox=\"0 0 %.2f %.2f\" role=\"img\" "
                  "aria-labelledby=\"title "
                  "desc\">\n<title id=\"title\">",
                  width, height, width, height);

  /* Both are foreign text and are escaped. */
  thr_text_xml(text, title);
  thr_text_append(text, "</title>\n<desc id=\"desc\">");
  thr_text_xml(text, description);
  thr_text_append(text, "</desc>\n");
}

/* Appends text at a baseline point. */
void thr_svg_text(thr_text *text, double x, double y, double size, const char *attributes,
                  const char *words)
{
  thr_text_printf(text, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"%.2f\"%s>", thr_svg_round(x),
                  thr_svg_round(y), size, attributes);
  thr_text_xml(text, words);
  thr_text_append(text, "</text>\n");
}

/* Returns whether the words on both sides of a space belong together, as in "mu = 0.2", "1 N." and
 * "5 mm", so that a line must not be broken there. */
static bool is_tied(const char *words, int space)
{
  /* What stands before the space, and how long the word after it is without punctuation. */
  const char *next = words + space + 1;
  char last = space > 0 ? words[space - 1] : ' ';
  size_t unit = strcspn(next, " .,;:)");
  bool measure = (unit == 1 && strchr("N%m", *next)) || (unit == 2 && next[1] == 'm');

  return last == '=' || (*next == '=' && unit == 1) || (last >= '0' && last <= '9' && measure);
}

/* Appends words in lines of at most width mm; returns the y of the next line. A letter is taken to
 * be 0.58 of the font size wide, as in a wide face. */
double thr_svg_wrap(thr_text *text, double x, double y, double size, double width,
                    const char *attributes, const char *words)
{
  char line[512];

  int n = 0, fits = (int)(width / (0.58 * size));
  while (*words) {
    /* As many characters as fit, and where a line may be broken among them: at a space, or behind a
     * slash. */
    n = 0;
    int last_space = -1, slash = 0, wide = 0;
    while (n < 500 && words[n]) {
      wide += !thr_text_is_inside(words[n]);
      if (wide > fits && n) break;
      if (words[n] == ' ' && !is_tied(words, n)) last_space = n;
      n++;
      if (words[n - 1] == '/') slash = n;
    }

    /* The rest of the words does not fit: break at the last space, else behind the last slash, else
     * anywhere. */
    if (words[n] && (words[n] != ' ' || is_tied(words, n)))
      n = last_space > 0 ? last_space : slash > 0 ? slash : n;

    /* Never cut a character of several bytes in two. */
    while (n > 1 && thr_text_is_inside(words[n]))
      n--;

    /* Write the line; the next one begins with a word. */
    snprintf(line, sizeof line, "%.*s", n, words);
    thr_svg_text(text, x, y, size, attributes, line);
    y += 1.45 * size;

    words += n;
    while (*words == ' ')
      words++;
  }
  return y;
}

enum { NUMBER = THR_INT_TEXT + 4 };

/* Appends a number as "%.2f" of thr_svg_round does. Most of a picture is such numbers, and printf
 * takes most of its time for them. Returns false, and appends nothing, if the number is beyond any
 * picture. */
static bool print_number(double value, char **to)
{
  static const double most = 1e12;
  if (!(value < most && value > -most)) return false;

  /* Whole hundredths, and their size without sign. */
  int64_t hundredths = (int64_t)round(value * 100),
          size = hundredths < 0 ? -hundredths : hundredths;
  char *at = *to;
  if (hundredths < 0) *at++ = '-';

  /* Digits before the point; one digit is the most frequent case. */
  if (size < 1000)
    *at++ = (char)('0' + size / 100);
  else
    at += thr_int_print(size / 100, at);

  /* Two digits after the point. */
  *at++ = '.';
  *at++ = (char)('0' + size % 100 / 10);
  *at++ = (char)('0' + size % 10);

  *to = at;
  return true;
}

/* Appends a letter and a point: "M1.50 2.00". */
static void put_point(thr_text *text, char before, const double at[2])
{
  char printed[2 * NUMBER + 2], *end = printed;

  *end++ = before;
  bool fits = print_number(at[0], &end);
  *end++ = ' ';
  fits = fits && print_number(at[1], &end);

  /* Beyond any picture printf is fast enough. */
  if (fits)
    thr_text_append_bytes(text, printed, (size_t)(end - printed));
  else
    thr_text_printf(text, "%c%.2f %.2f", before, at[0], at[1]);
}

void thr_svg_move(thr_text *text, const double at[2])
{
  put_point(text, 'M', at);
}

void thr_svg_line(thr_text *text, const double at[2])
{
  put_point(text, 'L', at);
}

/* Appends a Bezier curve: a and b are its control points, at is its end. */
void thr_svg_curve(thr_text *text, const double a[2], const double b[2], const double at[2])
{
  put_point(text, 'C', a);
  put_point(text, ' ', b);
  put_point(text, ' ', at);
}

/* Writes a length with about four digits, and its unit. */
void thr_svg_length(double value, const char *units, char text[64])
{
  double size = fabs(value);
  int decimals = size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : 3;

  /* Lengths without a sensible number of decimals have a power of ten. */
  if (size >= 1e9 || (size > 0 && size < 0.01))
    snprintf(text, 64, "%.4g %.15s", value, units);
  else
    snprintf(text, 64, "%.*f %.15s", decimals, value, units);
}

/* Writes a force with about three digits. */
void thr_svg_force(double newton, char text[32])
{
  double size = fabs(newton);
  int decimals = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;

  /* Large forces are rounded, those without a sensible number of decimals have a power of ten. */
  char number[THR_PLAIN_NUMBER];
  if (newton >= 1000)
    snprintf(text, 32, "%s N", thr_plain_newtons(newton, number));
  else if (size >= 1e6 || (size > 0 && size < 0.01))
    snprintf(text, 32, "%.2e N", newton);
  else
    snprintf(text, 32, "%.*f N", decimals, newton);
}

/* Lists powers of ten from low to high, every so many that no more than `most` fit; or all of them
 * with their 2 and 5 fold, if these fit. Returns their number. */
static int log_ticks(double low, double high, int most, double *tick)
{
  int first = (int)floor(log10(low) + 1e-9), last = (int)ceil(log10(high) - 1e-9), n = 0;
  bool fine = 3 * (last - first) + 1 <= most;
  int step = (last - first + most - 1) / most;

  /* The first and the last decade may reach beyond low .. high, so each value is compared. */
  for (int k = first; k <= last; k += step > 1 ? step : 1)
    for (int i = 0; i < (fine ? 3 : 1); i++) {
      static const double fold[] = {1, 2, 5};
      double value = fold[i] * pow(10, k);
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9) && n < most) tick[n++] = value;
    }

  return n;
}

/* Lists round values of an axis: one of 1, 2, 5 and 10 times a power of ten apart, as near as
 * `most` allows. */
int thr_svg_ticks(double low, double high, bool logarithmic, int most, double *tick)
{
  /* Without a range there is one value to name. */
  if (!(high > low)) {
    tick[0] = low;
    return 1;
  }

  /* A logarithmic axis, unless there are fewer than two powers of ten on it. */
  if (logarithmic) {
    int n = log_ticks(low, high, most, tick);
    if (n > 1) return n;
  }

  /* The smallest round step with which no more than `most` values fit. */
  static const double fold[] = {1, 2, 5, 10};
  double unit = pow(10, floor(log10((high - low) / (most - 1)))), step = unit;
  int n = 0;

  for (int i = 0; i < 4; i++) {
    step = fold[i] * unit;
    if (floor(high / step + 1e-9) - ceil(low / step - 1e-9) + 1 <= most) break;
  }

  /* Multiples of the step; 0 is never -0. */
  for (double k = ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && n < most; k++)
    tick[n++] = k == 0 ? 0 : k * step;
  return n;
}
