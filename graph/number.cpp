/* SPDX-License-Identifier: GPL-3.0-or-later */
/* <charconv> behind number.h: the only file that knows it. */
#include "graph/number.h"

#include <charconv>
#include <cstring>
#include <version>
#ifndef __cpp_lib_to_chars
#include <cerrno>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#endif

namespace
{

#ifdef __cpp_lib_to_chars

// d.ddde+xx, the shortest digits that read back; returns their end.
const char *print_shortest(double value, char text[THR_NUMBER_TEXT])
{
  return std::to_chars(text, text + THR_NUMBER_TEXT, value, std::chars_format::scientific).ptr;
}

// Reads as std::from_chars does.
std::from_chars_result read_double(const char *s, const char *end, double &x)
{
  return std::from_chars(s, end, x);
}

#else // a C++ library that knows <charconv> for whole numbers only, such as libc++ before version 20

bool reads_back(const char *text, double value)
{
  return std::strtod(text, nullptr) == value;
}

// Adds 1 to the last digit before the exponent; false if it is a 9. Of a power of two the next number above is twice as far as
// the one below: the shortest decimal may be above, where the nearest one of as many digits is below and reads as another number.
bool step_up(char *text)
{
  char *last = std::strchr(text, 'e') - 1;
  if (*last < '0' || *last > '8') return false;
  ++*last;
  return true;
}

// The shortest digits that read back, by trying. A decimal of 15 digits reads back unless the number is denormal, so a shorter
// one is what 15 digits are without their zeros.
const char *print_shortest(double value, char text[THR_NUMBER_TEXT])
{
  const int whole = 15, most = 17;
  for (int n = value < DBL_MIN ? 1 : whole; n <= most; n++) {
    std::snprintf(text, THR_NUMBER_TEXT, "%.*e", n - 1, value);
    if (reads_back(text, value) || (step_up(text) && reads_back(text, value))) break;
  }
  char *exponent = std::strchr(text, 'e'), *last = exponent;
  while (std::strchr(text, '.') && last > text + 1 && last[-1] == '0')
    last--;
  if (last[-1] == '.') last--;
  const size_t n = std::strlen(exponent);
  std::memmove(last, exponent, n + 1);
  return last + n;
}

// Where a decimal number ends that begins at s: [-]digits[.digits][e[+-]digits]; s if there is none.
const char *end_of_number(const char *s, const char *end)
{
  const char *at = s + (s < end && *s == '-'), *mark;
  int digits = 0;
  for (bool point = false; at < end && ((*at >= '0' && *at <= '9') || (*at == '.' && !point)); at++) {
    point = point || *at == '.';
    digits += *at != '.';
  }
  if (digits == 0) return s;
  if (at == end || (*at != 'e' && *at != 'E')) return at;
  mark = at++;
  if (at < end && (*at == '+' || *at == '-')) at++;
  if (at == end || *at < '0' || *at > '9') return mark;
  while (at < end && *at >= '0' && *at <= '9')
    at++;
  return at;
}

// Reads as std::from_chars does, but for infinities and what is no number.
std::from_chars_result read_double(const char *s, const char *end, double &x)
{
  const char *stop = end_of_number(s, end);
  const size_t n = static_cast<size_t>(stop - s);
  char few[64], *text = n < sizeof few ? few : static_cast<char *>(std::malloc(n + 1));
  if (n == 0 || !text) return {s, std::errc::invalid_argument};
  std::memcpy(text, s, n);
  text[n] = '\0';
  errno = 0;
  const double read = std::strtod(text, nullptr);
  const bool out_of_range = errno == ERANGE && (read == 0 || std::isinf(read));
  if (text != few) std::free(text);
  if (!out_of_range) x = read;
  return {stop, out_of_range ? std::errc::result_out_of_range : std::errc()};
}

#endif

// Decimal digits without point, the first of them not 0, and the power of ten of the first.
struct decimal {
  char digit[20];
  int n, power;
};

decimal digits_of(double value)
{
  char text[THR_NUMBER_TEXT];
  decimal d = {};
  const char *end = print_shortest(value, text);
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
int64_t magnitude_of(const char *s, const char *end)
{
  int64_t power = 0, exponent = 0;
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
  const int64_t most = int64_t{1} << 40; // more digits than any text's length makes up for
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
  const std::from_chars_result read = read_double(s, s + n, x);
  if (read.ec == std::errc::invalid_argument || read.ptr != s + n) return false;
  if (read.ec == std::errc::result_out_of_range && magnitude_of(s, s + n) > 0) return false;
  *value = x;
  return true;
}
