/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of length: which words a file may use for a unit, and how long a unit is in mm. */
#ifndef THR_UNITS_H
#define THR_UNITS_H

#include "graph/status.h"

#include <stddef.h>

/* The usual short name ("mm") of a unit called by that name, by its names in full ("Millimeters")
 * or by another short name, in either case; NULL if the word is none. "unit" is a length that
 * nobody knows. Static. */
const char *thr_units_name(const char *word);

/* THR_EINPUT if the word is no unit, with the word and those that are; *name as above. */
thr_status thr_units_find(const char *word, const char **name, thr_err *err) THR_MUST_CHECK;

/* Looks for the unit of length in a comment of a file (its n bytes without the sign that begins
 * it), as programs and people write it: "units: mm", "File units = inches", "Units [cm]", "1 unit =
 * 1 m", "This file uses centimeters as units for coordinates". *name is the unit's short name, NULL
 * if the comment names none. *wrong is NULL unless the comment begins with "units:" or "file units
 * =" before something else than a unit: then it points to that, inside the text. O(n). */
void thr_units_in_comment(const char *text, size_t n, const char **name, const char **wrong);

/* Millimetres in one unit, by its short name or any other; THR_EINPUT if it is none whose length is
 * known. */
thr_status thr_units_in_mm(const char *units, double *mm, thr_err *err) THR_MUST_CHECK;

#endif
