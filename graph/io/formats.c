/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lists the formats of framework files, and finds which one a file is in: by its name's ending or,
 * failing that, by its text.
 *
 * Files in formats that are not read are recognised as well, by their endings or by how they begin,
 * so that the message can say what to do: a Rhino model has to be exported, a spreadsheet saved as
 * CSV.
 *
 * A format is added by one file with its reader, perhaps a writer, and a thr_format, and by one
 * line in the table below. */
#include "graph/io/read_parts.h"
#include "graph/os.h"

#include <stdio.h>
#include <string.h>

extern const thr_format thr_json_format, thr_obj_format, thr_csv_format, thr_ply_format,
    thr_off_format, thr_vef_format, thr_stl_format, thr_dxf_format, thr_graphml_format,
    thr_gltf_format;

/* In the order in which texts are tried. */
static const thr_format *const formats[] = {&thr_json_format,
                                            &thr_obj_format,
                                            &thr_csv_format,
                                            &thr_ply_format,
                                            &thr_off_format,
                                            &thr_vef_format,
                                            &thr_stl_format,
                                            &thr_dxf_format,
                                            &thr_graphml_format,
                                            &thr_gltf_format,
                                            NULL};

const thr_format *thr_format_named(const char *name)
{
  for (int i = 0; formats[i]; i++)
    if (strcmp(formats[i]->name, name) == 0) return formats[i];
  return NULL;
}

const thr_format *thr_format_written(const char *name)
{
  const thr_format *format = thr_format_named(name);
  return format && format->write ? format : NULL;
}

void thr_formats_written(char *list, size_t size, const char *before, const char *between,
                         const char *last)
{
  const thr_format *const *format = formats;
  int left = 0;
  for (int i = 0; formats[i]; i++)
    left += formats[i]->write != NULL;

  /* The word between two names depends on how many are left. */
  for (size_t n = 0; *format && n < size; format++) {
    if (!(*format)->write) continue;
    left--;
    n += (size_t)snprintf(list + n, size - n, "%s%s%s", before, (*format)->name,
                          left > 1 ? between
                          : left   ? last
                                   : "");
  }
}

const char *thr_path_ending(const char *path)
{
  const char *dot = strrchr(thr_os_name(path), '.');
  return dot ? dot + 1 : "";
}

/* Returns the format whose files' names have this ending; NULL if there is none. */
static const thr_format *with_ending(thr_span ending)
{
  for (int i = 0; formats[i]; i++)
    for (const char *const *known = formats[i]->ending; *known; known++)
      if (thr_span_is(ending, *known)) return formats[i];
  return NULL;
}

/* Kinds of files that are not read, by what helps their users. */
typedef enum { MODEL, GRAPH, TABLE, PACKED, PICTURE, TEXT } foreign_kind;

static const char *const advice[] = {
    [MODEL] = "which is not read; export the lines or the mesh as OBJ, PLY, DXF, glTF or JSON",
    [GRAPH] = THR_GRAPH_ADVICE,
    [TABLE] = "which is not read; save the sheet as CSV",
    [PACKED] = "which is not read; unpack it, or save a spreadsheet as CSV",
    [PICTURE] = "which is no framework; export the model that it shows as OBJ, DXF or JSON",
    [TEXT] = ("which is no framework; export the model as OBJ, DXF or JSON, or its nodes and edges "
              "as CSV")};

/* A kind of file that is not read. start: how its name ends, or how its text begins. */
typedef struct {
  const char *start, *name;
  foreign_kind kind;
} foreign;

static const foreign foreign_files[] = {{"dwg", "a DWG drawing", MODEL},
                                        {"3dm", "a Rhino model", MODEL},
                                        {"blend", "a Blender file", MODEL},
                                        {"igs", "an IGES model", MODEL},
                                        {"iges", "an IGES model", MODEL},
                                        {"step", "a STEP model", MODEL},
                                        {"stp", "a STEP model", MODEL},
                                        {"ifc", "an IFC model", MODEL},
                                        {"fbx", "an FBX model", MODEL},
                                        {"dae", "a Collada model", MODEL},
                                        {"3mf", "a 3MF model", MODEL},
                                        {"skp", "a SketchUp model", MODEL},
                                        {"gh", "a Grasshopper definition", MODEL},
                                        {"ghx", "a Grasshopper definition", MODEL},
                                        {"vtk", "a VTK file", MODEL},
                                        {"vtu", "a VTK file", MODEL},
                                        {"msh", "a mesh of gmsh", MODEL},
                                        {"wrl", "a VRML scene", MODEL},
                                        {"x3d", "an X3D scene", MODEL},
                                        {"gexf", "GEXF", GRAPH},
                                        {"gml", "GML", GRAPH},
                                        {"net", "a Pajek network", GRAPH},
                                        {"paj", "a Pajek network", GRAPH},
                                        {"cyjs", "Cytoscape's JSON", GRAPH},
                                        {"dot", "a Graphviz graph", GRAPH},
                                        {"gv", "a Graphviz graph", GRAPH},
                                        {"xlsx", "a spreadsheet", TABLE},
                                        {"xls", "a spreadsheet", TABLE},
                                        {"ods", "a spreadsheet", TABLE},
                                        {"zip", "a zip archive", PACKED},
                                        {"gz", "a compressed file", PACKED},
                                        {"svg", "an SVG picture", PICTURE},
                                        {"png", "a PNG picture", PICTURE},
                                        {"jpg", "a JPEG picture", PICTURE},
                                        {"jpeg", "a JPEG picture", PICTURE},
                                        {"pdf", "a PDF document", PICTURE},
                                        {"mtl", "the materials of an OBJ file", MODEL},
                                        {"md", "Markdown", TEXT},
                                        {"html", "a web page", TEXT},
                                        {"py", "a Python program", TEXT}};

static const foreign foreign_texts[] = {{"<svg", "an SVG picture", PICTURE},
                                        {"<?xml", "XML", MODEL},
                                        {"<gexf", "GEXF", GRAPH},
                                        {"graph [", "GML", GRAPH},
                                        {"graph[", "GML", GRAPH},
                                        {"graph\n", "GML", GRAPH},
                                        {"graph\r", "GML", GRAPH},
                                        {"Creator ", "GML", GRAPH},
                                        {"*Vertices", "a Pajek network", GRAPH},
                                        {"*vertices", "a Pajek network", GRAPH},
                                        {"*Network", "a Pajek network", GRAPH},
                                        {"*network", "a Pajek network", GRAPH},
                                        {"<COLLADA", "a Collada model", MODEL},
                                        {"<X3D", "an X3D scene", MODEL},
                                        {"<VTKFile", "a VTK file", MODEL},
                                        {"<Archive", "a Grasshopper definition", MODEL},
                                        {"<!DOCTYPE html", "a web page", TEXT},
                                        {"<!doctype html", "a web page", TEXT},
                                        {"<html", "a web page", TEXT},
                                        {"3D Geometry File", "a Rhino model", MODEL},
                                        {"ISO-10303-21", "a STEP or IFC model", MODEL},
                                        {"AC10", "a DWG drawing", MODEL},
                                        {"Kaydara FBX", "an FBX model", MODEL},
                                        {"BLENDER", "a Blender file", MODEL},
                                        {"# vtk DataFile", "a VTK file", MODEL},
                                        {"$MeshFormat", "a mesh of gmsh", MODEL},
                                        {"#VRML", "a VRML scene", MODEL},
                                        {"*HEADING", "an Abaqus model", MODEL},
                                        {"*Heading", "an Abaqus model", MODEL},
                                        {"graph {", "a Graphviz graph", GRAPH},
                                        {"graph G {", "a Graphviz graph", GRAPH},
                                        {"digraph ", "a Graphviz graph", GRAPH},
                                        {"strict graph", "a Graphviz graph", GRAPH},
                                        {"PK\x03\x04", "a zip archive or a spreadsheet", PACKED},
                                        {"\x1f\x8b", "a compressed file", PACKED},
                                        {"(\xb5/\xfd", "a compressed file", PACKED},
                                        {"\xd0\xcf\x11\xe0", "a spreadsheet", TABLE},
                                        {"%PDF", "a PDF document", PICTURE},
                                        {"\x89PNG", "a PNG picture", PICTURE},
                                        {"\xff\xd8\xff", "a JPEG picture", PICTURE},
                                        {"GIF8", "a GIF picture", PICTURE}};

/* Records THR_EINPUT with the kind of file and what helps. */
static thr_status refuse(const foreign *found, const char *name, thr_err *err)
{
  return thr_fail(err, THR_EINPUT, "%s: this is %s, %s", name, found->name, advice[found->kind]);
}

thr_status thr_format_by_name(const char *name, const thr_format **format, thr_err *err)
{
  const thr_span ending = thr_span_of(thr_path_ending(name));
  *format = with_ending(ending);

  /* Only names that say no format are compared. */
  for (size_t i = 0; !*format && i < sizeof foreign_files / sizeof *foreign_files; i++)
    if (thr_span_is(ending, foreign_files[i].start)) return refuse(&foreign_files[i], name, err);
  return THR_OK;
}

/* Returns what a text is that begins like a foreign file; NULL if it is like none. */
static const foreign *foreign_of(const char *text, size_t n)
{
  thr_span rest = {text, n};

  /* A byte-order mark and blanks may come first. */
  if (thr_span_starts(rest, "\xef\xbb\xbf")) rest = (thr_span){rest.s + 3, rest.n - 3};
  while (rest.n &&
         (rest.s[0] == ' ' || rest.s[0] == '\t' || rest.s[0] == '\r' || rest.s[0] == '\n'))
    rest = (thr_span){rest.s + 1, rest.n - 1};

  for (size_t i = 0; i < sizeof foreign_texts / sizeof *foreign_texts; i++)
    if (thr_span_starts(rest, foreign_texts[i].start)) return &foreign_texts[i];

  return NULL;
}

/* Returns the format that a text plainly is of, NULL if it is of none. */
static const thr_format *format_said(const char *text, size_t n)
{
  /* By the whole text. */
  for (int i = 0; formats[i]; i++)
    if (formats[i]->is && formats[i]->is(text, n)) return formats[i];

  /* By the first line that is neither blank nor a comment. */
  const char *nul = n ? memchr(text, '\0', n) : NULL; /* only the head of a binary file is text */
  thr_scan scan;
  thr_span line = {0};
  if (thr_scan_start(&scan, text, nul ? (size_t)(nul - text) : n, "", NULL)) return NULL;

  while (thr_scan_line(&scan, &line)) {
    line = thr_span_trim(line);
    if (line.n == 0 || line.s[0] == '#') continue;

    /* Only this line counts. */
    for (int i = 0; formats[i]; i++)
      if (formats[i]->begins && formats[i]->begins(line)) return formats[i];
    return NULL;
  }

  return NULL;
}

thr_status thr_format_by_text(const char *text, size_t n, const char *name, const thr_format *named,
                              const thr_format **format, thr_err *err)
{
  const thr_format *said = format_said(text, n);

  /* A text that plainly is of another format than its name says is read as what it is, but for
   * names of formats that no first line tells. Text that is like nothing is CSV. */
  *format = said && (!named || named->begins) ? said : named ? named : &thr_csv_format;
  const foreign *found = said ? NULL : foreign_of(text, n);
  if (found) return refuse(found, name, err);
  return THR_OK;
}

const thr_format *thr_format_of_path(const char *path)
{
  const thr_format *format = with_ending(thr_span_of(thr_path_ending(path)));
  return format && format->write ? format : NULL;
}

void thr_frame_write(const thr_frame *frame, const thr_format *format, thr_text *out)
{
  (format ? format : &thr_json_format)->write(frame, out);
}
