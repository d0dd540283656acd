/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the edges of graphs by the names of their nodes until all nodes are known, because edges
 * may come first; and collects what attributes say of a node or an edge, in whatever words. */
#include "graph/io/read_parts.h"

#include <stdlib.h>

thr_status thr_links_add(thr_links *links, const char *from, const char *to, int line, thr_err *err)
{
  thr_status st = thr_grow(&links->link, links->n, &links->capacity, sizeof *links->link, err);
  if (st) return st;

  /* Names follow one another in one text, and the edge keeps where they begin. */
  struct thr_link link = {.line = line, .from = links->names.length};
  thr_text_append_clean(&links->names, from);
  thr_text_append_bytes(&links->names, "", 1);
  link.to = links->names.length;
  thr_text_append_clean(&links->names, to);
  thr_text_append_bytes(&links->names, "", 1);
  if (links->names.failed) return thr_nomem(err);

  links->link[links->n++] = link;

  return THR_OK;
}

/* Finds the node of a name; THR_EINPUT with the edge's line if there is none. */
static thr_status find(const thr_links *links, const thr_names *names, size_t at, int *node,
                       const thr_scan *scan, thr_err *err)
{
  const thr_span name = thr_span_of(links->names.data + at);
  *node = thr_names_find(names, name);
  return *node >= 0
             ? THR_OK
             : thr_scan_fail(scan, err, "there is no node '%.*s'", thr_span_width(name), name.s);
}

/* Looks up both nodes of every edge by name, and adds the edges in the order of the file. */
thr_status thr_links_finish(const thr_links *links, thr_draft *draft, const char *name,
                            thr_err *err)
{
  thr_names names = {0};
  thr_scan scan = {.name = name};
  thr_err why = {0};

  /* All nodes are there by now. */
  thr_status st = thr_names_build(&names, draft, name, err);

  /* Both ends, then the edge with its length and passes. */
  for (int i = 0; i < links->n && !st; i++) {
    const struct thr_link *link = &links->link[i];
    int a = 0, b = 0;
    scan.line = link->line;
    st = find(links, &names, link->from, &a, &scan, err);
    if (!st) st = find(links, &names, link->to, &b, &scan, err);
    if (!st) st = thr_draft_add_edge(draft, a, b, link->length, err);
    if (!st && thr_draft_edge_passes(draft, link->cover, link->passes, &why))
      st = thr_scan_fail(&scan, err, "%s", why.text);
  }

  thr_names_destroy(&names);
  return st;
}

void thr_links_destroy(thr_links *links)
{
  free(links->link);
  thr_text_destroy(&links->names);
  *links = (thr_links){0};
}

/* Reads a number; *what becomes why the value is none. */
static void take_number(thr_span value, double *x, bool *has, const char **what)
{
  *has = thr_span_number(value, false, x);
  if (!*has) *what = "not a finite number";
}

/* Reads a number of passes; nothing is 0. */
static void take_count(thr_span value, bool nothing, int *count, const char **what)
{
  *count = 0;
  if (nothing) return;
  if (!thr_span_int(value, count) || *count < 1 || *count > 100)
    *what = "not a whole number from 1 to 100";
}

/* Takes an attribute by its name; names that mean nothing here are left alone. */
void thr_said_take(thr_said *said, thr_span key, thr_span value, const char **what)
{
  static const char *const axis[] = {"x", "y", "z"}, *const foot[] = {"is_support", "is_grounded",
                                                                      "is_anchor", "is_fixed",
                                                                      "foot"};
  bool unused;

  value = thr_span_trim(value);

  /* A node's coordinates. */
  for (int i = 0; i < 3; i++)
    if (thr_span_is(key, axis[i])) take_number(value, &said->xyz[i], &said->has[i], what);

  /* igraph writes NaN where an edge does not have what others have. */
  const bool nothing = value.n == 0 || thr_span_is(value, "nan");

  /* Its foot. */
  for (size_t i = 0; i < sizeof foot / sizeof *foot; i++)
    if (thr_span_is(key, foot[i]) &&
        !thr_span_truth(nothing ? thr_span_of("") : value, &said->foot))
      *what = "neither true nor false";

  /* An edge's length and passes. */
  if (thr_span_is(key, "length")) {
    said->length = 0;
    if (!nothing) take_number(value, &said->length, &unused, what);
    if (!nothing && unused && !(said->length > 0)) *what = "not a positive number";
  }

  if (thr_span_is(key, "cover")) take_count(value, nothing, &said->cover, what);
  if (thr_span_is(key, "capacity")) take_count(value, nothing, &said->capacity, what);
}

thr_status thr_said_node(const thr_said *said, thr_draft *draft, const char *node, bool *has_z,
                         const thr_scan *scan, thr_err *err)
{
  /* Without x or y there is no place; z may be missing in flat drawings. */
  for (int i = 0; i < 2; i++)
    if (!said->has[i])
      return thr_scan_fail(scan, err, "node '%.40s' has no %c; nodes need attributes x, y and z",
                           node, 'x' + i);
  *has_z |= said->has[2];
  return thr_draft_add_node(draft, said->xyz, node, said->foot, err);
}

void thr_said_link(const thr_said *said, thr_links *links)
{
  struct thr_link *link = &links->link[links->n - 1];
  link->length = said->length;
  link->cover = said->cover;
  link->passes = said->capacity;
}
