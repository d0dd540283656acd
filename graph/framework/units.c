/* Units of length. */
#include "graph/framework/units.h"

#include <strings.h>

#define KNOWN "um, mm, cm, dm, m, km, in, ft or yd"

/* The short name comes first. A foot and a yard are the international ones of 1959. */
static const struct {
  const char *name[8];
  double mm; /* 0: not known */
} units[] = {{{"mm", "millimeter", "millimeters", "millimetre", "millimetres"}, 1},
             {{"cm", "centimeter", "centimeters", "centimetre", "centimetres"}, 10},
             {{"m", "meter", "meters", "metre", "metres"}, 1000},
             {{"in", "inch", "inches"}, 25.4},
             {{"ft", "foot", "feet"}, 304.8},
             {{"um", "micrometer", "micrometers", "micrometre", "micrometres", "micron", "microns"}, 0.001},
             {{"dm", "decimeter", "decimeters", "decimetre", "decimetres"}, 100},
             {{"km", "kilometer", "kilometers", "kilometre", "kilometres"}, 1e6},
             {{"yd", "yard", "yards"}, 914.4},
             {{"unit", "units"}, 0}};

enum { N_UNITS = sizeof units / sizeof *units, MOST_NAMES = sizeof units[0].name / sizeof *units[0].name };

/* Place in the table, -1 if there is none. */
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
  return thr_fail(err, THR_EINPUT, "\"%.40s\" is no unit of length; expected " KNOWN ", or unit if none of them", word);
}

thr_status thr_units_in_mm(const char *word, double *mm, thr_err *err)
{
  int i = find(word);
  *mm = i < 0 ? 0 : units[i].mm;
  if (*mm > 0) return THR_OK;
  return thr_fail(err, THR_EINPUT, "units: how long is one \"%.40s\"? Expected " KNOWN "; set them with --units", word);
}
