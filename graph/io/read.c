/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads a framework from a file or a text: finds the format, lets its reader fill a draft, and
 * builds the framework. docs/formats.md describes every format by example.
 *
 * What the file leaves open (unit, direction upwards, scale) comes from the options. A CSV table
 * that holds only nodes or only edges needs a second file, which is found beside it by its name:
 * "dome_nodes.csv" needs "dome_edges.csv". */
#include "graph/io/read_parts.h"
#include "graph/os.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

thr_read_options thr_read_options_default(void)
{
  return (thr_read_options){.weld = -1, .scale = 1};
}

/* Returns an empty draft that tells the reader what the options ask of it. */
static thr_draft draft_asked(const thr_read_options *options)
{
  return (thr_draft){.flat = options->flat,
                     .pick = options->pick,
                     .columns = options->columns,
                     .all_layers = options->all_layers};
}

/* Finds the format: by the text, if it plainly says one, or else by the name. */
static thr_status find_format(const char *text, size_t n, const char *name,
                              const thr_format **format, thr_err *err)
{
  const thr_format *named;
  thr_status st = thr_format_by_name(name, &named, err);
  return st ? st : thr_format_by_text(text, n, name, named, format, err);
}

thr_status thr_draft_parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                           const char *name, const thr_format *format, thr_err *err)
{
  thr_status st = format ? THR_OK : find_format(text, n, name, &format, err);

  /* A failure must leave nothing behind. */
  if (!st && (st = format->parse(draft, report, text, n, name, err))) {
    thr_draft_destroy(draft);
    *report = (thr_read_report){0};
  }

  if (!st) report->format = format->name;
  return st;
}

/* ---- the other half of a CSV pair ---- */

/* Returns in *other a copy of the path with the last `have` of its file name replaced by `want`, or
 * NULL if there is none. The caller frees *other. */
static thr_status replace_word(const char *path, const char *have, const char *want, char **other,
                               thr_err *err)
{
  const char *found = NULL;

  /* Words in the folders' names do not matter. */
  for (const char *c = thr_os_name(path); (c = strstr(c, have)); c++)
    found = c;
  *other = NULL;

  if (!found) return THR_OK;
  size_t before = (size_t)(found - path), size = strlen(path) + strlen(want) + 1;
  if (!(*other = thr_calloc(size, 1))) return thr_nomem(err);
  snprintf(*other, size, "%.*s%s%s", (int)before, path, want, found + strlen(have));

  return THR_OK;
}

/* Finds the file with the other table, if it exists: *partner becomes its path, which the caller
 * frees, else NULL. */
static thr_status find_partner(const char *path, thr_csv_content content, char **partner,
                               thr_err *err)
{
  static const char *const word[][2] = {{"nodes", "edges"}, {"Nodes", "Edges"}, {"NODES", "EDGES"}};
  int have = content == THR_CSV_NODES_ONLY ? 0 : 1;
  *partner = NULL;

  /* The word as the file's name writes it. */
  for (size_t i = 0; i < sizeof word / sizeof *word; i++) {
    thr_status st = replace_word(path, word[i][have], word[i][1 - have], partner, err);
    if (st) return st;
    if (*partner && access(*partner, F_OK) == 0) return THR_OK;
    free(*partner);
    *partner = NULL;
  }

  return THR_OK;
}

/* Parses the nodes in one text and the edges in the file at other_path (nodes_first), or the other
 * way round. */
static thr_status parse_with(thr_draft *draft, thr_read_report *report, const thr_text *text,
                             const char *path, const char *other_path, bool nodes_first,
                             thr_err *err)
{
  thr_text other = {0};
  thr_status st = thr_text_read(&other, other_path, err);

  /* Nodes come first, whichever file was named. */
  if (!st && nodes_first)
    st = thr_csv_parse_pair(draft, report, text, path, &other, other_path, err);
  if (!st && !nodes_first)
    st = thr_csv_parse_pair(draft, report, &other, other_path, text, path, err);

  thr_text_destroy(&other);
  return st;
}

/* Parses a table, and a second file if the table has only nodes or only edges. pair_path receives
 * that file's path. */
static thr_status parse_csv_file(thr_draft *draft, thr_read_report *report,
                                 const thr_format *format, const thr_text *text, const char *path,
                                 const char *name, char *pair_path, size_t pair_size, thr_err *err)
{
  const thr_draft asked = *draft;
  thr_csv_content content;
  char *partner = NULL;
  thr_status st = thr_csv_scan(draft, report, text->data, text->length, name, &content, err);
  if (st || content == THR_CSV_WHOLE) return st;

  /* Half of a pair: forget what was read, because both tables are read together. */
  thr_draft_destroy(draft);
  *draft = asked;
  *report = (thr_read_report){0};

  /* The partner, if the name tells one. A table of three numbers in each row may be edges (a, b,
   * length) as well as nodes, where the name says so. */
  st = find_partner(path, content, &partner, err);
  if (!st && !partner &&
      content ==
          THR_CSV_NODES_ONLY) { /* three numbers may be an edge, too, where the name says so */
    content = THR_CSV_EDGES_ONLY;
    st = find_partner(path, content, &partner, err);
  }

  /* Without a partner the reader of tables says what is missing. */
  if (!st && partner) {
    if (pair_path) snprintf(pair_path, pair_size, "%s", partner);
    st = parse_with(draft, report, text, path, partner, content == THR_CSV_NODES_ONLY, err);
  } else if (!st) {
    st = format->parse(draft, report, text->data, text->length, name,
                       err); /* says what is missing */
  }

  free(partner);
  return st;
}

/* Does what the options ask of all formats (unit, direction upwards, scale, splitting), and builds
 * the framework. Messages begin with the file's name. */
static thr_status build(const thr_read_options *options, const char *name, thr_draft *draft,
                        thr_frame *frame, thr_read_report *report, thr_err *err)
{
  thr_err why = {0};
  thr_status st = THR_OK;

  /* The user's word on units counts, then the file's. */
  report->units_from = options->units    ? THR_FROM_USER
                       : draft->units[0] ? THR_FROM_FILE
                                         : THR_FROM_NOBODY;

  memcpy(report->units_of_file, draft->units, sizeof report->units_of_file);
  if (options->units) st = thr_draft_set_units(draft, options->units, &why);
  if (strcmp(draft->units, report->units_of_file) == 0) report->units_of_file[0] = '\0';
  if (!options->units && draft->other[0])
    st = thr_fail(&why, THR_EINPUT,
                  "comments name two units of length, %s and %s; say which with --units",
                  draft->other, draft->units);

  /* In this order: scale first, so that tolerances are in the units that the user sees. */
  if (!st) st = thr_draft_stand(draft, options->up, options->scale, report, &why);
  if (!st && options->parallel) st = thr_draft_keep_parallel(draft, options->weld, &why);
  if (!st) st = thr_draft_build(draft, options->weld, frame, report, &why);
  if (!st && options->split) st = thr_frame_split(frame, &report->split_edges, report, &why);
  if (!st) return THR_OK;

  /* The text of the failure lacks the file. */
  thr_frame_destroy(frame);
  return thr_fail(err, st, "%s: %s", name, why.text);
}

/* Checks that the options ask for columns only of tables, and for a part only of files that have
 * parts. THR_EINPUT else. */
static thr_status check_asked(const thr_read_options *options, const thr_read_report *report,
                              const thr_format *format, const char *name, thr_err *err)
{
  if (options->columns && !format->pairs)
    return thr_fail(err, THR_EINPUT, "%s: --columns is for tables; this file is read as %s", name,
                    format->name);

  /* Part 1 is all of a file that holds one framework. */
  if (!options->pick || strcmp(options->pick, "1") == 0 || report->frameworks) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "%s: there is no part '%.40s' to pick; the file holds one framework", name,
                  options->pick);
}

thr_status thr_frame_parse(thr_frame *frame, thr_read_report *report, const char *text, size_t n,
                           const char *name, const thr_read_options *options, thr_err *err)
{
  thr_draft draft = draft_asked(options);
  *frame = (thr_frame){0};
  thr_status st = thr_draft_parse(&draft, report, text, n, name, NULL, err);

  if (!st) st = check_asked(options, report, thr_format_named(report->format), name, err);
  if (!st) st = build(options, name, &draft, frame, report, err);
  if (st) *report = (thr_read_report){0};
  thr_draft_destroy(&draft);

  return st;
}

/* ---- files ---- */

/* Reads a file: refuses by the name, reads the text, finds the format, fills a draft and builds. */
thr_status thr_frame_read(thr_frame *frame, thr_read_report *report, const char *path,
                          const thr_read_options *options, char *pair_path, size_t pair_size,
                          thr_err *err)
{
  thr_text text = {0};
  thr_draft draft = draft_asked(options);
  const thr_format *format = NULL;
  const char *name = strcmp(path, "-") == 0 ? "stdin" : path;
  *frame = (thr_frame){0};
  *report = (thr_read_report){0};

  if (pair_path && pair_size) *pair_path = '\0';

  thr_status st = thr_format_by_name(name, &format, err); /* refuses before it reads */
  if (!st) st = thr_text_read(&text, path, err);
  if (!st) st = find_format(text.data, text.length, name, &format, err);
  if (st) goto done;

  /* Two tables are given; or one that may need a partner; or any other format. */
  if (options->edges_path)
    st = parse_with(&draft, report, &text, name, options->edges_path, true, err);
  else if (format->pairs)
    st = parse_csv_file(&draft, report, format, &text, path, name, pair_path, pair_size, err);
  else
    st = format->parse(&draft, report, text.data, text.length, name, err);

  if (!st) st = check_asked(options, report, format, name, err);
  if (st) goto done;

  /* The text may be larger than the framework: it is released first. */
  thr_text_destroy(&text);
  report->format = format->name;
  st = build(options, name, &draft, frame, report, err);
done:
  if (st) *report = (thr_read_report){0};

  thr_draft_destroy(&draft);
  thr_text_destroy(&text);
  return st;
}
