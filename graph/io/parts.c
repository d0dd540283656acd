/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses the part of a file that --pick asks for: an object, a layer, a solid, a framework in a
 * list. First the reader names all parts, then thr_parts_choose finds the one, then the reader
 * leaves out what belongs to parts that are not chosen. If nothing is asked for, no names are
 * kept. */
#include "graph/io/read_parts.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_LISTED = 12 };

thr_status thr_parts_add(thr_parts *parts, thr_span name, int *part, thr_err *err)
{
  *part = 0;

  /* Names are needed only for choosing. */
  if (!parts->asked) return THR_OK;
  *part = parts->n++;
  thr_text_append_bytes(&parts->names, name.s, name.n);
  thr_text_byte(&parts->names, '\0');

  return parts->names.failed ? thr_nomem(err) : THR_OK;
}

thr_status thr_parts_find(thr_parts *parts, thr_span name, int *part, thr_err *err)
{
  const char *known = parts->names.data;

  /* Names follow one another, each with its NUL. */
  for (int i = 0; i < parts->n; i++, known += strlen(known) + 1)
    if (name.n == strlen(known) && memcmp(name.s, known, name.n) == 0) {
      *part = i;
      return THR_OK;
    }

  return thr_parts_add(parts, name, part, err);
}

/* Appends "; did you mean Dome? there are: Dome, Feet" to a message. */
static void list(const thr_parts *parts, thr_text *out)
{
  thr_suggestion near = {.word = parts->asked};
  char question[THR_SUGGESTION_TEXT];
  const char *name = parts->names.data;

  /* The name that is most like the one asked for. */
  for (int i = 0; i < parts->n; i++, name += strlen(name) + 1)
    thr_suggestion_try(&near, name);

  thr_suggestion_ask(&near, question);
  thr_text_printf(out, "%s there are: ", *question ? question : ";");

  /* The first names; a part without one is called by its number. */
  name = parts->names.data;
  for (int i = 0; i < parts->n && i < MOST_LISTED; i++, name += strlen(name) + 1)
    *name ? thr_text_printf(out, "%s%.40s", i ? ", " : "", name)
          : thr_text_printf(out, "%snumber %d", i ? ", " : "", i + 1);

  if (parts->n > MOST_LISTED) thr_text_printf(out, " and %d more", parts->n - MOST_LISTED);
}

/* Records THR_EINPUT: there is no such part; and which there are. */
static thr_status refuse(const thr_parts *parts, const char *file, const char *what,
                         const char *many, thr_err *err)
{
  thr_text names = {0};

  /* Either the file has no parts at all, or others. */
  if (!parts->n)
    return thr_fail(err, THR_EINPUT, "%s: there is no %s '%.40s'; the file has no %s", file, what,
                    parts->asked, many);

  list(parts, &names);
  thr_status st = names.failed ? thr_nomem(err)
                               : thr_fail(err, THR_EINPUT, "%s: there is no %s '%.40s'%s", file,
                                          what, parts->asked, names.data);
  thr_text_destroy(&names);

  return st;
}

/* Compares names first, then tries a number. */
thr_status thr_parts_choose(thr_parts *parts, const char *file, const char *what, const char *many,
                            thr_err *err)
{
  int number;

  if (!parts->asked) return THR_OK;
  if (!(parts->chosen = thr_calloc((size_t)parts->n, sizeof *parts->chosen))) return thr_nomem(err);

  /* Several parts may have the name: all of them are chosen. */
  const char *name = parts->names.data;
  for (int i = 0; i < parts->n; i++, name += strlen(name) + 1)
    parts->n_chosen += parts->chosen[i] = strcmp(name, parts->asked) == 0;

  /* A number counts only if it is no name. */
  if (!parts->n_chosen && thr_span_int(thr_span_of(parts->asked), &number) && number >= 1 &&
      number <= parts->n)
    parts->n_chosen += parts->chosen[number - 1] = true;

  return parts->n_chosen ? THR_OK : refuse(parts, file, what, many, err);
}

void thr_parts_finish(thr_parts *parts, thr_read_report *report)
{
  if (parts->asked) {
    report->frameworks = parts->n;
    report->frameworks_read = parts->n_chosen;
  }
  thr_text_destroy(&parts->names);
  free(parts->chosen);
  parts->chosen = NULL;
}
