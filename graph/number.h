/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as text and back, through the C++ library: fewest digits, nearest double, whatever the
 * locale. */
#ifndef THR_NUMBER_H
#define THR_NUMBER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { THR_NUMBER_TEXT = 32, THR_INT_TEXT = 20 }; /* bytes that hold any number, any whole one */

/* The fewest decimal digits that read back as the same double, of these the nearest ones, laid out
 * as %g does with 15 digits or more: 0.1, 1e+15, 5.684341886080802e-14. -0 is written as 0. value
 * is finite. Returns the length; no NUL. O(1). */
size_t thr_number_print(double value, char out[THR_NUMBER_TEXT]);

/* The same of a whole number. */
size_t thr_int_print(int64_t value, char out[THR_INT_TEXT]);

/* The double nearest to the decimal number in s[0 .. n - 1]; what is too small is 0. false if that
 * is no number, as by the grammar of JSON, but that zeros may stand in front and digits be missing
 * on one side of the point; or if it is too large for a double. O(n). */
bool thr_number_parse(const char *s, size_t n, double *value);

#ifdef __cplusplus
}
#endif

#endif
