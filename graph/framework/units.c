/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Units of length, and numbers with units: "90cm", "50 N", "5min". */
#include "graph/framework/frame.h"
#include "graph/number.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define KNOWN "um, mm, cm, dm, m, km, in, ft or yd"

/* The units; the short name comes first. */
static const struct {
  const char *name[8];
  double mm; /* 0: not known */
} units[] = {
    {{"mm", "millimeter", "millimeters", "millimetre", "millimetres"}, 1},
    {{"cm", "centimeter", "centimeters", "centimetre", "centimetres"}, 10},
    {{"m", "meter", "meters", "metre", "metres"}, 1000},
    {{"in", "inch", "inches"}, 25.4},
    {{"ft", "foot", "feet"}, 304.8},
    {{"um", "micrometer", "micrometers", "micrometre", "micrometres", "micron", "microns"}, 0.001},
    {{"dm", "decimeter", "decimeters", "decimetre", "decimetres"}, 100},
    {{"km", "kilometer", "kilometers", "kilometre", "kilometres"}, 1e6},
    {{"yd", "yard", "yards"}, 914.4},
    {{"mi", "mile", "miles"}, 1609344},
    {{"us-ft"}, 1200000. / 3937},
    {{"us-in"}, 100000. / 3937},
    {{"us-yd"}, 3600000. / 3937},
    {{"us-mi"}, 6336000000. / 3937},
    {{"mil"}, 0.0254},
    {{"uin", "microinch", "microinches"}, 2.54e-5},
    {{"nm", "nanometer", "nanometers", "nanometre", "nanometres"}, 1e-6},
    {{"angstrom", "angstroms"}, 1e-7},
    {{"dam", "decameter", "decameters", "decametre", "decametres"}, 1e4},
    {{"hm", "hectometer", "hectometers", "hectometre", "hectometres"}, 1e5},
    {{"Gm", "gigameter", "gigameters", "gigametre", "gigametres"}, 1e12},
    {{"au"}, 1.495978707e14},
    {{"ly"}, 9.4607304725808e18},
    {{"pc", "parsec", "parsecs"}, 3.0856775814913673e19},
    {{"unit", "units", "unitless", "unknown", "none"}, 0}};

enum {
  N_UNITS = sizeof units / sizeof *units,
  MOST_NAMES = sizeof units[0].name / sizeof *units[0].name
};

/* Returns the unit's place in the table, -1 if there is none. */
static int find(const char *word)
{
  for (int i = 0; i < N_UNITS; i++)
    for (int k = 0; k < MOST_NAMES && units[i].name[k]; k++)
      if (strcasecmp(word, units[i].name[k]) == 0) return i;
  return -1;
}

const char *thr_units_name(const char *word)
{
  int i = find(word);
  return i < 0 ? NULL : units[i].name[0];
}

thr_status thr_units_find(const char *word, const char **name, thr_err *err)
{
  *name = thr_units_name(word);
  if (*name) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "\"%.40s\" is no unit of length; expected " KNOWN ", or unit if none of them",
                  word);
}

thr_status thr_units_in_mm(const char *word, double *mm, thr_err *err)
{
  int i = find(word);
  *mm = i < 0 ? 0 : units[i].mm;
  if (*mm > 0) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "units: how long is one \"%.40s\"? Expected " KNOWN "; set them with --units",
                  word);
}

/* ---- numbers with units ---- */

/* Units of other kinds, in the first one of their row. */
static const struct {
  const char *kind;
  struct {
    const char *name;
    double factor;
  } unit[9];
} others[] = {{"force",
               {{"N", 1},
                {"kN", 1e3},
                {"mN", 1e-3},
                {"kg", 9.80665},
                {"kgf", 9.80665},
                {"lbf", 4.4482216152605}}},
              {"time", {{"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}}},
              {"angle", {{"deg", 1}, {"degrees", 1}, {"\302\260", 1}, {"rad", 180 / THR_PI}}},
              {"mass", {{"g", 1}, {"mg", 1e-3}, {"kg", 1e3}, {"lb", 453.59237}}},
              {"density", {{"g/cm3", 1}, {"kg/m3", 1e-3}}},
              {"pressure", {{"MPa", 1}, {"N/mm2", 1}, {"GPa", 1e3}, {"kPa", 1e-3}, {"Pa", 1e-6}}},
              {"speed", {{"mm/s", 1}, {"cm/s", 10}, {"m/s", 1e3}}},
              {"acceleration", {{"m/s2", 1}, {"mm/s2", 1e-3}}},
              {"turning", {{"rad/m", 1}, {"rad/mm", 1e3}}},
              {"frequency", {{"Hz", 1}}},
              {"a part", {{"%", 1}}}};

enum { N_OTHERS = sizeof others / sizeof *others, MOST_OF_KIND = 9 };

/* Returns how many of the one unit are in the other, which is called `word`; 0 if that is no unit
 * of the same kind, and *kind and the text `some` say what could be. */
static double factor_of(const char *unit, const char *word, const char **kind, char some[64])
{
  size_t length = 0;

  /* The row in which the unit comes first. */
  for (int i = 0; i < N_OTHERS; i++) {
    if (strcmp(others[i].unit[0].name, unit) != 0) continue;
    *kind = others[i].kind;
    for (int k = 0; k < MOST_OF_KIND && others[i].unit[k].name; k++) {
      if (strcmp(word, others[i].unit[k].name) == 0) return others[i].unit[k].factor;
      length += (size_t)snprintf(some + length, 64 - length, "%s%s", k ? ", " : "",
                                 others[i].unit[k].name);
    }
    return 0;
  }

  /* Else a length. */
  double of = 0, in = 0;
  *kind = "length";
  snprintf(some, 64, "%s", KNOWN);
  if (strcmp(word, unit) == 0) return 1;
  if (thr_units_in_mm(word, &of, NULL) || thr_units_in_mm(unit, &in, NULL)) return 0;
  return of / in;
}

thr_status thr_quantity_read(const char *text, const char *unit, double *value, thr_err *err)
{
  char *word, some[64];
  const char *kind;
  const double number = strtod(text, &word);

  if (word == text || !isfinite(number))
    return thr_fail(err, THR_EINPUT, "expected a number%s%s", *unit ? " of " : "", unit);
  *value = number;
  while (*word == ' ')
    word++;
  if (!*word) return THR_OK;

  /* What stands behind the number is a unit, if there can be any. */
  const double factor = *unit ? factor_of(unit, word, &kind, some) : 0;
  if (!*unit) return thr_fail(err, THR_EINPUT, "expected a number and nothing behind it");
  if (!(factor > 0))
    return thr_fail(err, THR_EINPUT,
                    "\"%.20s\" is no unit of %s here; expected a number of %s (%s)", word, kind,
                    unit, some);
  *value = number * factor;
  return THR_OK;
}

/* ---- comments ---- */

/* A word of a comment, copied, and what comes before the word. */
typedef struct {
  char text[24];
  const char *at;
  bool set_off, rate; /* rate: a stroke or a power stands before it, as in mm/s */
} comment_word;

enum { MOST_WORDS = 24 };

/* Takes the next word off the text; returns false if there is none. A word that is longer than any
 * unit's name is cut. */
static bool next_word(const char **at, const char *end, comment_word *word)
{
  *word = (comment_word){0};
  const char *c = *at;

  /* What sets words off from each other, of which some letters mean more. */
  for (; c < end && !isalnum((unsigned char)*c) && (unsigned char)*c < 0x80; c++) {
    word->set_off |= *c && strchr(":=[(", *c);
    word->rate |= *c == '/' || *c == '^';
  }

  word->at = c;
  size_t n = 0;

  /* The word: letters, digits, other languages' letters, and what may be inside. */
  for (; c < end &&
         (isalnum((unsigned char)*c) || (unsigned char)*c >= 0x80 || (*c && strchr("._-", *c)));
       c++)
    if (n + 1 < sizeof word->text) word->text[n++] = *c;

  /* A full stop is no part of the word. */
  while (n > 1 && word->text[n - 1] == '.')
    n--;

  word->text[n] = '\0';
  *at = c;
  return n > 0;
}

/* Returns whether a word is in a list that NULL ends. */
static bool is_among(const char *word, const char *const *list)
{
  for (; *list; list++)
    if (strcasecmp(word, *list) == 0) return true;
  return false;
}

/* Returns whether a word is "unit" or "units". */
static bool is_unit_word(const comment_word *word)
{
  return is_among(word->text, (const char *const[]){"unit", "units", NULL});
}

/* Returns the unit at word i of n, NULL if the word is no unit or only part of a rate (mm/s, mm per
 * pixel). */
static const char *unit_at(const comment_word *word, int i, int n)
{
  if (i >= n || (i + 1 < n && (word[i + 1].rate || strcasecmp(word[i + 1].text, "per") == 0)))
    return NULL;
  return is_unit_word(&word[i]) && !word[i].set_off ? NULL : thr_units_name(word[i].text);
}

/* Returns the unit that the words after "units", which is word i, or those before it name; NULL if
 * there is none. "in" is an inch only where it is set off and no unit follows: "units: in". */
static const char *unit_beside(const comment_word *word, int i, int n)
{
  static const char *const between[] = {"is",          "are",  "in", "of",  "length",
                                        "measurement", "used", "1",  "1.0", NULL};
  const char *inch = NULL;

  /* After it, with small words between: "units of length are mm". */
  int k = i + 1;
  for (; k < n && is_among(word[k].text, between); k++)
    if (word[k].set_off && strcasecmp(word[k].text, "in") == 0) inch = unit_at(word, k, n);

  if (unit_at(word, k, n)) return unit_at(word, k, n);

  if (inch) return inch;

  /* Before it: "centimeters as units", "cm units". */
  if (i >= 2 && strcasecmp(word[i - 1].text, "as") == 0) return unit_at(word, i - 2, n);
  return i >= 1 && strcasecmp(word[i - 1].text, "in") != 0 ? unit_at(word, i - 1, n) : NULL;
}

/* Looks beside every word "units" of the comment. */
void thr_units_in_comment(const char *text, size_t n, const char **name, const char **wrong)
{
  comment_word word[MOST_WORDS];
  const char *at = text;
  int n_words = 0;
  *name = *wrong = NULL;

  /* Split the comment into words. */
  while (n_words < MOST_WORDS && next_word(&at, text + n, &word[n_words]))
    n_words++;

  /* The first "units" that has a unit beside it counts. What follows "units:" and is no unit is
   * wrong, if nothing is right. */
  for (int i = 0; i < n_words; i++) {
    if (!is_unit_word(&word[i])) continue;
    if ((*name = unit_beside(word, i, n_words))) return;
    const bool first = i == 0 || (i == 1 && strcasecmp(word[0].text, "file") == 0);
    if (first && i + 1 < n_words && word[i + 1].set_off) *wrong = word[i + 1].at;
  }
}
