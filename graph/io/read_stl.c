/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads STL: triangles, as text or binary. Corners at exactly one place are one node; sides that
 * two triangles share are one edge.
 *
 * A binary file is 80 bytes of anything, the number of triangles, then 50 bytes for each: twelve
 * floats (normal and three corners, little-endian) and two bytes. */
#include "graph/io/read_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sizes in bytes: what comes before the triangles, a triangle, and the normal before its first
 * corner. */
enum { HEAD = 84, TRIANGLE = 50, FIRST_CORNER = 12 };

/* ---- binary ---- */

/* Returns four bytes as a little-endian number. */
static uint32_t little32(const char *at)
{
  const unsigned char *b = (const unsigned char *)at;
  return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* Returns four bytes as a little-endian float. */
static double little_float(const char *at)
{
  uint32_t bits = little32(at);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* Returns whether the text is exactly as long as its number of triangles says. Nothing else tells,
 * because a binary file may begin with "solid", too. */
static bool is_binary(const char *text, size_t n)
{
  return n >= HEAD && n == HEAD + (size_t)TRIANGLE * little32(text + HEAD - 4);
}

/* Reads the corners of a binary file. */
static thr_status read_binary(thr_sites *corners, thr_draft *draft, const char *text, size_t n,
                              const char *name, thr_err *err)
{
  /* The head may name the unit. */
  const thr_scan head = {name, text, text + n, 1, 1};
  thr_status st = thr_scan_units(&head, (thr_span){text, HEAD - 4}, draft, err);
  for (const char *triangle = text + HEAD; triangle < text + n && !st; triangle += TRIANGLE)

    /* Corners as the file has them; the normal does not matter. */
    for (int i = 0; i < 3 && !st; i++) {
      double xyz[3];
      for (int j = 0; j < 3; j++)
        xyz[j] = little_float(triangle + FIRST_CORNER + 12 * i + 4 * j);
      if (!isfinite(xyz[0]) || !isfinite(xyz[1]) || !isfinite(xyz[2]))
        return thr_fail(err, THR_EINPUT, "%s: triangle %ld has a corner that is not finite", name,
                        (long)((triangle - text - HEAD) / TRIANGLE + 1));
      st = thr_sites_add(corners, xyz, err);
    }

  return st;
}

/* Records THR_EINPUT about a binary file that is not as long as it announces: how many triangles
 * fit into it. */
static thr_status fail_length(const char *text, size_t n, const char *name, thr_err *err)
{
  /* Without a whole head there is no number of triangles. */
  if (n < HEAD)
    return thr_fail(err, THR_EINPUT,
                    "%s: a binary STL of %zu bytes is not whole; its head alone has 84", name, n);

  const size_t fit = (n - HEAD) / TRIANGLE, left = (n - HEAD) % TRIANGLE;
  return thr_fail(err, THR_EINPUT,
                  "%s: this binary STL announces %u triangles; %zu fit into its %zu bytes, and %zu "
                  "bytes are left; export it again",
                  name, (unsigned)little32(text + HEAD - 4), fit, n, left);
}

/* ---- text ---- */

/* Reads "vertex 0 0 0" as a corner. */
static thr_status read_vertex(const thr_scan *scan, thr_sites *corners, thr_span rest, thr_err *err)
{
  double xyz[3];

  /* Fortran's notation is read, too. */
  for (int i = 0; i < 3; i++) {
    thr_span word = thr_span_word(&rest);
    if (!thr_span_real(word, &xyz[i]))
      return thr_scan_fail(scan, err, "a vertex needs x, y and z; '%.*s' is not a finite number",
                           thr_span_width(word), word.s);
  }

  return thr_sites_add(corners, xyz, err);
}

/* Numbers the solids of a file, of which --pick may ask for one. */
static thr_status name_parts(thr_parts *parts, const char *text, size_t n, const char *name,
                             thr_err *err)
{
  thr_scan scan;
  thr_span line;
  int part;
  thr_status st = thr_scan_start(&scan, text, n, name, err);

  /* Names are kept only if one of them is asked for. */
  while (!st && parts->asked && thr_scan_line(&scan, &line))
    if (thr_span_is(thr_span_word(&line), "solid"))
      st = thr_parts_add(parts, thr_span_trim(line), &part, err);

  return st ? st : thr_parts_choose(parts, name, "solid", "solids", err);
}

/* Reads the corners of a text. Solids that are not chosen are passed over. */
static thr_status read_text(thr_sites *corners, thr_draft *draft, thr_parts *parts,
                            const char *text, size_t n, const char *name, thr_err *err)
{
  thr_scan scan;
  thr_span line;
  int part = -1, facet = 0; /* facet: where it begins in corners */
  thr_status st = name_parts(parts, text, n, name, err);

  if (!st) st = thr_scan_start(&scan, text, n, name, err);
  while (!st && thr_scan_line(&scan, &line)) {
    /* The name of a solid may contain the unit. */
    thr_span word = thr_span_word(&line);
    part += thr_span_is(word, "solid");
    if (thr_span_is(word, "solid")) st = thr_scan_units(&scan, line, draft, err);
    if (!thr_parts_has(parts, part)) continue;

    /* Each facet has three vertices. */
    if (!st && thr_span_is(word, "vertex")) st = read_vertex(&scan, corners, line, err);
    if (thr_span_is(word, "facet")) facet = corners->n;
    if (!st && thr_span_is(word, "endfacet") && corners->n - facet != 3)
      st = thr_scan_fail(&scan, err,
                         "a facet needs three vertices, this one has %d; export triangles",
                         corners->n - facet);
  }

  if (!st && corners->n % 3)
    st = thr_scan_fail(&scan, err, "the file ends inside a facet; it is not whole");

  return st;
}

/* ---- the draft ---- */

/* Fills the draft: corners become nodes, and each three corners a face. */
static thr_status fill_draft(const thr_sites *corners, thr_draft *draft, const char *name,
                             thr_err *err)
{
  thr_faces faces = {0};

  /* An empty file is more likely a wrong one. */
  if (corners->n < 3)
    return thr_fail(err, THR_EINPUT, "%s: no triangles; this is an empty STL file, or none", name);

  int *node = thr_calloc((size_t)corners->n, sizeof *node);
  if (!node) return thr_nomem(err);
  thr_status st = thr_sites_finish(corners, node, draft, err);

  /* Corners of facets follow one another. */
  for (int i = 0; i + 2 < corners->n && !st; i += 3) {
    for (int j = 0; j < 3 && !st; j++)
      st = thr_faces_corner(&faces, node[i + j], err);
    if (!st) st = thr_faces_close(&faces, err);
  }

  if (!st) st = thr_faces_finish(&faces, draft, name, err);
  thr_faces_destroy(&faces);
  free(node);

  return st;
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  thr_sites corners = {0};
  thr_parts solids = {.asked = draft->pick};
  thr_status st = THR_OK;

  /* NUL bytes are only in binary files. */
  if (is_binary(text, n))
    st = read_binary(&corners, draft, text, n, name, err);
  else if (n && memchr(text, '\0', n))
    st = fail_length(text, n, name, err);
  else
    st = read_text(&corners, draft, &solids, text, n, name, err);

  /* Both kinds are lists of corners now. */
  if (!st) st = fill_draft(&corners, draft, name, err);
  thr_parts_finish(&solids, report);
  thr_sites_destroy(&corners);

  return st;
}

/* Returns whether a line begins a text file. */
static bool begins(thr_span line)
{
  return thr_span_starts(line, "solid ") || thr_span_is(line, "solid");
}

const thr_format thr_stl_format = {
    .name = "stl", .ending = {"stl"}, .begins = begins, .parse = parse, .is = is_binary};
