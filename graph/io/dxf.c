/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes DXF: drawings in the sense of release 12 (AC1009), the oldest release that everything
 * reads, with a unit. Source: Autodesk, "DXF Reference".
 *
 * A drawing is pairs of lines, a code and a value. The header says version and unit, the tables
 * list the layers, then come the entities. */

#include "graph/io/read_parts.h"

#include <string.h>

const char *thr_dxf_unit(int code)
{
  static const char *const units[THR_DXF_UNITS] = {
      NULL, "in", "ft",  "mi", "mm", "cm", "m",  "km", "uin",   "mil",   "yd",    "angstrom", "nm",
      "um", "dm", "dam", "hm", "Gm", "au", "ly", "pc", "us-ft", "us-in", "us-yd", "us-mi"};
  return code > 0 && code < THR_DXF_UNITS ? units[code] : NULL;
}

void thr_dxf_pair(thr_text *out, int code, const char *value)
{
  thr_text_printf(out, "%d\n", code);
  thr_text_append_clean(out, value);
  thr_text_append(out, "\n");
}

void thr_dxf_int(thr_text *out, int code, int value)
{
  thr_text_printf(out, "%d\n%d\n", code, value);
}

void thr_dxf_point(thr_text *out, int first, const double xyz[3])
{
  for (int i = 0; i < 3; i++) {
    thr_text_printf(out, "%d\n", 10 * (i + 1) + first);
    thr_text_double(out, xyz[i]);
    thr_text_append(out, "\n");
  }
}

/* Returns the code of $INSUNITS for a unit, by its short name; 0 if there is none. */
static int code_of(const char *units)
{
  for (int code = 1; code < THR_DXF_UNITS; code++)
    if (thr_dxf_unit(code) && strcmp(thr_dxf_unit(code), units) == 0) return code;
  return 0;
}

/* Writes how a section begins. */
static void begin_section(thr_text *out, const char *name)
{
  thr_dxf_pair(out, 0, "SECTION");
  thr_dxf_pair(out, 2, name);
}

/* Writes the table of layers, which readers need before the entities on them. */
static void put_layers(thr_text *out, const thr_dxf_layer *layer, int n)
{
  begin_section(out, "TABLES");
  thr_dxf_pair(out, 0, "TABLE");
  thr_dxf_pair(out, 2, "LAYER");
  thr_dxf_int(out, 70, n);

  /* Name, no flags, colour, line type. */
  for (int i = 0; i < n; i++) {
    thr_dxf_pair(out, 0, "LAYER");
    thr_dxf_pair(out, 2, layer[i].name);
    thr_dxf_int(out, 70, 0);
    thr_dxf_int(out, 62, layer[i].colour);
    thr_dxf_pair(out, 6, "CONTINUOUS");
  }

  /* Both the table and its section end. */
  thr_dxf_pair(out, 0, "ENDTAB");
  thr_dxf_pair(out, 0, "ENDSEC");
}

void thr_dxf_begin(thr_text *out, const char *units, const thr_dxf_layer *layer, int n_layers)
{
  /* The header. */
  begin_section(out, "HEADER");
  thr_dxf_pair(out, 9, "$ACADVER");
  thr_dxf_pair(out, 1, "AC1009");
  thr_dxf_pair(out, 9, "$INSUNITS");
  thr_dxf_int(out, 70, code_of(units));

  thr_dxf_pair(out, 0, "ENDSEC");
  put_layers(out, layer, n_layers);
  begin_section(out, "ENTITIES");
}

void thr_dxf_end(thr_text *out)
{
  thr_dxf_pair(out, 0, "ENDSEC");
  thr_dxf_pair(out, 0, "EOF");
}

void thr_dxf_write(const thr_frame *frame, thr_text *out)
{
  static const thr_dxf_layer layer = {"framework", 7};

  thr_dxf_begin(out, frame->units, &layer, 1);

  /* Each edge is a LINE, whatever its own length. */
  for (int e = 0; e < frame->n_edges; e++) {
    thr_dxf_pair(out, 0, "LINE");
    thr_dxf_pair(out, 8, layer.name);
    thr_dxf_point(out, 0, frame->xyz[frame->edge[e][0]]);
    thr_dxf_point(out, 1, frame->xyz[frame->edge[e][1]]);
  }

  thr_dxf_end(out);
}
