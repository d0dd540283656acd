/* <charconv> behind number.h: the only file that knows it. */
#include "graph/number.h"

#include <charconv>
#include <cstring>

namespace
{

// Decimal digits without point, the first of them not 0, and the power of ten of the first.
struct decimal {
  char digit[20];
  int n, power;
};

// to_chars gives d.ddde+xx, the shortest digits that read back.
decimal digits_of(double value)
{
  char text[THR_NUMBER_TEXT];
  decimal d = {};
  const char *end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific).ptr;
  const char *at = text;
  for (; at < end && *at != 'e'; at++)
    if (*at != '.') d.digit[d.n++] = *at;
  at += at + 1 < end && at[1] == '+' ? 2 : 1;
  std::from_chars(at, end, d.power);
  return d;
}

char *put(char *out, const char *s, int n)
{
  std::memcpy(out, s, static_cast<size_t>(n));
  return out + n;
}

char *put_zeros(char *out, int n)
{
  std::memset(out, '0', static_cast<size_t>(n));
  return out + n;
}

// 1.25e-07: the exponent has two digits or more.
char *put_scientific(char *out, const decimal &d)
{
  out = put(out, d.digit, 1);
  if (d.n > 1) *out++ = '.';
  out = put(out, d.digit + 1, d.n - 1);
  *out++ = 'e';
  *out++ = d.power < 0 ? '-' : '+';
  const int power = d.power < 0 ? -d.power : d.power;
  if (power < 10) *out++ = '0';
  return std::to_chars(out, out + 4, power).ptr;
}

// 0.00125, 12.5 or 12500.
char *put_fixed(char *out, const decimal &d)
{
  if (d.power < 0) {
    out = put_zeros(out, 1);
    *out++ = '.';
    return put(put_zeros(out, -d.power - 1), d.digit, d.n);
  }
  const int whole = d.power + 1;
  if (d.n <= whole) return put_zeros(put(out, d.digit, d.n), whole - d.n);
  out = put(out, d.digit, whole);
  *out++ = '.';
  return put(out, d.digit + whole, d.n - whole);
}

// The power of ten above the first digit that is not 0, far from 0: of a number that no double holds.
long magnitude_of(const char *s, const char *end)
{
  long power = 0, exponent = 0;
  bool point = false, found = false;
  for (; s < end && *s != 'e' && *s != 'E'; s++) {
    if (*s == '.') point = true;
    if (*s < '0' || *s > '9') continue;
    found = found || *s != '0';
    if (!point && found) power++;
    if (point && !found) power--;
  }
  if (s == end) return power;
  const bool down = s[1] == '-';
  s += s[1] == '-' || s[1] == '+' ? 2 : 1;
  const long most = 1L << 40; // more digits than any text's length makes up for
  if (std::from_chars(s, end, exponent).ec != std::errc() || exponent > most) exponent = most;
  return power + (down ? -exponent : exponent);
}

} // namespace

size_t thr_number_print(double value, char out[THR_NUMBER_TEXT])
{
  const int few = 15; // digits up to which every decimal reads back: %g with as many turns to exponents from here on
  const double most = 1e15;
  char *at = out;
  if (value > -most && value < most && value == static_cast<double>(static_cast<int64_t>(value)))
    return thr_int_print(static_cast<int64_t>(value), out); // no fewer digits, as nothing shorter is as near
  if (value < 0) *at++ = '-';
  const decimal d = digits_of(value < 0 ? -value : value);
  const bool scientific = d.power < -4 || d.power >= (d.n > few ? d.n : few);
  at = scientific ? put_scientific(at, d) : put_fixed(at, d);
  return static_cast<size_t>(at - out);
}

size_t thr_int_print(int64_t value, char out[THR_INT_TEXT])
{
  return static_cast<size_t>(std::to_chars(out, out + THR_INT_TEXT, value).ptr - out);
}

bool thr_number_parse(const char *s, size_t n, double *value)
{
  double x = 0;
  const std::from_chars_result read = std::from_chars(s, s + n, x);
  if (read.ec == std::errc::invalid_argument || read.ptr != s + n) return false;
  if (read.ec == std::errc::result_out_of_range && magnitude_of(s, s + n) > 0) return false;
  *value = x;
  return true;
}
