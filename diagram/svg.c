#include "diagram/svg.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

double thr_svg_round(double value)
{
  value = round(value * 100) / 100;
  return value == 0 ? 0 : value;
}

/* Length of the UTF-8 sequence at s if it is valid and its character is allowed in XML 1.0, else 0. */
static int utf8_length(const unsigned char *s)
{
  if (s[0] < 0x80) return 1;
  int n = s[0] >= 0xC2 && s[0] < 0xE0 ? 2 : s[0] >= 0xE0 && s[0] < 0xF0 ? 3 : s[0] >= 0xF0 && s[0] < 0xF5 ? 4 : 0;
  unsigned c = n ? s[0] & (0xFFu >> (n + 1)) : 0;
  for (int i = 1; i < n; i++) {
    if ((s[i] & 0xC0) != 0x80) return 0;
    c = c << 6 | (s[i] & 0x3F);
  }
  if (n == 2 && c < 0xA0) return 0; /* C1 control characters */
  if (n == 3 && (c < 0x800 || (c >= 0xD800 && c < 0xE000) || c >= 0xFFFE)) return 0;
  if (n == 4 && (c < 0x10000 || c > 0x10FFFF)) return 0;
  return n;
}

void thr_svg_escape(thr_text *t, const char *s)
{
  while (*s) {
    char one[5] = {0};
    int n = utf8_length((const unsigned char *)s);
    memcpy(one, s, (size_t)(n ? n : 1));
    thr_text_xml(t, n ? one : "\xEF\xBF\xBD");
    s += n ? n : 1;
  }
}

void thr_svg_text(thr_text *t, double x, double y, double size, const char *attributes, const char *s)
{
  thr_text_printf(t, "<text x=\"%.2f\" y=\"%.2f\" font-size=\"%.2f\"%s>", thr_svg_round(x), thr_svg_round(y), size, attributes);
  thr_svg_escape(t, s);
  thr_text_append(t, "</text>\n");
}

void thr_svg_move(thr_text *t, const double at[2])
{
  thr_text_printf(t, "M%.2f %.2f", thr_svg_round(at[0]), thr_svg_round(at[1]));
}

void thr_svg_line(thr_text *t, const double at[2])
{
  thr_text_printf(t, "L%.2f %.2f", thr_svg_round(at[0]), thr_svg_round(at[1]));
}

void thr_svg_curve(thr_text *t, const double a[2], const double b[2], const double at[2])
{
  thr_text_printf(t, "C%.2f %.2f %.2f %.2f %.2f %.2f", thr_svg_round(a[0]), thr_svg_round(a[1]), thr_svg_round(b[0]),
                  thr_svg_round(b[1]), thr_svg_round(at[0]), thr_svg_round(at[1]));
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
