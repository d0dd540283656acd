/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small pieces of SVG: numbers, text, paths. Private to diagram/. */
#include "diagram/overview/overview.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

double thr_svg_round(double value)
{
  value = round(value * 100) / 100;
  return value == 0 ? 0 : value;
}

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
  thr_text_xml(text, title);
  thr_text_append(text, "</title>\n<desc id=\"desc\">");
  thr_text_xml(text, description);
  thr_text_append(text, "</desc>\n");
}

void thr_svg_text(thr_text *text, double x, double y, double size, const char *attributes,
                  const char *s)
{
  thr_text_printf(text, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"%.2f\"%s>", thr_svg_round(x),
                  thr_svg_round(y), size, attributes);
  thr_text_xml(text, s);
  thr_text_append(text, "</text>\n");
}

/* Do the words on both sides of this space belong together, as in "mu = 0.2", "1 N." and "5 mm"? */
static bool is_tied(const char *words, int space)
{
  const char *next = words + space + 1;
  char last = space > 0 ? words[space - 1] : ' ';
  size_t unit = strcspn(next, " .,;:)");
  bool measure = (unit == 1 && strchr("N%m", *next)) || (unit == 2 && next[1] == 'm');
  return last == '=' || (*next == '=' && unit == 1) || (last >= '0' && last <= '9' && measure);
}

double thr_svg_wrap(thr_text *text, double x, double y, double size, double width,
                    const char *attributes, const char *words)
{
  char line[512];
  int n = 0, fits = (int)(width / (0.58 * size));
  while (*words) {
    n = 0;
    int last_space = -1, slash = 0, wide = 0; /* in characters */
    while (n < 500 && words[n]) {
      wide += !thr_text_is_inside(words[n]);
      if (wide > fits && n) break;
      if (words[n] == ' ' && !is_tied(words, n)) last_space = n;
      n++;
      if (words[n - 1] == '/') slash = n;
    }
    if (words[n] && (words[n] != ' ' || is_tied(words, n)))
      n = last_space > 0 ? last_space : slash > 0 ? slash : n;
    /* never cut a character in two */
    while (n > 1 && thr_text_is_inside(words[n]))
      n--;
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

/* As "%.2f" of thr_svg_round: most of a picture is such numbers, and printf takes most of its time
 * for them. False: it is beyond any picture. */
static bool print_number(double value, char **to)
{
  static const double most = 1e12;
  if (!(value < most && value > -most)) return false;
  int64_t hundredths = (int64_t)round(value * 100),
          size = hundredths < 0 ? -hundredths : hundredths;
  char *at = *to;
  if (hundredths < 0) *at++ = '-';
  if (size < 1000)
    *at++ = (char)('0' + size / 100);
  else
    at += thr_int_print(size / 100, at);
  *at++ = '.';
  *at++ = (char)('0' + size % 100 / 10);
  *at++ = (char)('0' + size % 10);
  *to = at;
  return true;
}

static void put_point(thr_text *text, char before, const double at[2])
{
  char s[2 * NUMBER + 2], *end = s;
  *end++ = before;
  bool fits = print_number(at[0], &end);
  *end++ = ' ';
  fits = fits && print_number(at[1], &end);
  if (fits)
    thr_text_append_bytes(text, s, (size_t)(end - s));
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

void thr_svg_curve(thr_text *text, const double a[2], const double b[2], const double at[2])
{
  put_point(text, 'C', a);
  put_point(text, ' ', b);
  put_point(text, ' ', at);
}

void thr_svg_length(double value, const char *units, char text[64])
{
  double size = fabs(value);
  int decimals = size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : 3;
  if (size >= 1e9 || (size > 0 && size < 0.01))
    snprintf(text, 64, "%.4g %.15s", value, units);
  else
    snprintf(text, 64, "%.*f %.15s", decimals, value, units);
}

void thr_svg_force(double newton, char text[32])
{
  double size = fabs(newton);
  int decimals = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
  if (size >= 1e6 || (size > 0 && size < 0.01))
    snprintf(text, 32, "%.2e N", newton);
  else
    snprintf(text, 32, "%.*f N", decimals, newton);
}

/* Powers of ten, every so many that no more than most fit; or with their 2 and 5 fold. */
static int log_ticks(double low, double high, int most, double *tick)
{
  int first = (int)floor(log10(low) + 1e-9), last = (int)ceil(log10(high) - 1e-9), n = 0;
  bool fine = 3 * (last - first) + 1 <= most;
  int step = (last - first + most - 1) / most;
  for (int k = first; k <= last; k += step > 1 ? step : 1)
    for (int i = 0; i < (fine ? 3 : 1); i++) {
      static const double fold[] = {1, 2, 5};
      double value = fold[i] * pow(10, k);
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9) && n < most) tick[n++] = value;
    }
  return n;
}

int thr_svg_ticks(double low, double high, bool logarithmic, int most, double *tick)
{
  if (!(high > low)) {
    tick[0] = low;
    return 1;
  }
  if (logarithmic) {
    int n = log_ticks(low, high, most, tick);
    if (n > 1) return n;
  }
  static const double fold[] = {1, 2, 5, 10};
  double unit = pow(10, floor(log10((high - low) / (most - 1)))), step = unit;
  int n = 0;
  for (int i = 0; i < 4; i++) {
    step = fold[i] * unit;
    if (floor(high / step + 1e-9) - ceil(low / step - 1e-9) + 1 <= most) break;
  }
  for (double k = ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && n < most; k++)
    tick[n++] = k == 0 ? 0 : k * step;
  return n;
}
