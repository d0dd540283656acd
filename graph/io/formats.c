/* The table of formats, and which of them a file is in: by its name's ending or, failing that, by its first line. */
#include "graph/io/formats.h"
#include "graph/io/read.h"

#include <string.h>

extern const thr_format thr_json_format, thr_obj_format, thr_csv_format, thr_ply_format, thr_off_format, thr_stl_format,
    thr_dxf_format;

static const thr_format *const formats[] = {&thr_json_format, &thr_obj_format, &thr_csv_format, &thr_ply_format,
                                            &thr_off_format,  &thr_stl_format, &thr_dxf_format, NULL};

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

/* What follows the last dot of the file's name, "" if nothing does. */
static thr_span ending_of(const char *path)
{
  const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
  return thr_span_of(dot ? dot + 1 : "");
}

/* NULL if there is none. */
static const thr_format *with_ending(thr_span ending)
{
  for (int i = 0; formats[i]; i++)
    for (const char *const *known = formats[i]->ending; *known; known++)
      if (thr_span_is(ending, *known)) return formats[i];
  return NULL;
}

thr_status thr_format_by_name(const char *name, const thr_format **format, thr_err *err)
{
  static const char *const foreign[] = {"dwg", "3dm", "graphml", "gml", "gltf", "glb", "blend", "igs", "step", "stp"};
  const thr_span ending = ending_of(name);
  *format = with_ending(ending);
  for (size_t i = 0; !*format && i < sizeof foreign / sizeof *foreign; i++)
    if (thr_span_is(ending, foreign[i]))
      return thr_fail(err, THR_EINPUT, "%s: %s files are not read; export the lines or the mesh as OBJ, PLY, CSV or JSON", name,
                      foreign[i]);
  return THR_OK;
}

/* What begins so is of a format that others read. */
static const struct foreign {
  const char *start, *name;
} foreign_texts[] = {{"<svg", "an SVG picture"},
                     {"<?xml", "XML"},
                     {"<graphml", "GraphML"},
                     {"<gexf", "GEXF"},
                     {"<!DOCTYPE", "a web page"},
                     {"<html", "a web page"},
                     {"3D Geometry File", "a 3dm file"},
                     {"glTF", "a glb file"},
                     {"ISO-10303-21", "STEP"},
                     {"AC10", "a DWG drawing"},
                     {"%PDF", "a PDF document"},
                     {"PK\x03\x04", "a zip archive"},
                     {"BLENDER", "a Blender file"},
                     {"graph [", "GML"},
                     {"Creator \"", "GML"},
                     {"*Vertices", "a Pajek network"},
                     {"# vtk DataFile", "a VTK file"},
                     {"\x89PNG", "a PNG picture"}};

static const char *foreign_name(const char *text, size_t n)
{
  thr_span t = {text, n};
  while (t.n && (t.s[0] == ' ' || t.s[0] == '\t' || t.s[0] == '\r' || t.s[0] == '\n'))
    t = (thr_span){t.s + 1, t.n - 1};
  for (size_t i = 0; i < sizeof foreign_texts / sizeof *foreign_texts; i++)
    if (thr_span_starts(t, foreign_texts[i].start)) return foreign_texts[i].name;
  return NULL;
}

/* The format that the text says itself to be of, NULL if it says none. */
static const thr_format *format_said(const char *text, size_t n)
{
  for (int i = 0; formats[i]; i++)
    if (formats[i]->is && formats[i]->is(text, n)) return formats[i];
  const char *nul = n ? memchr(text, '\0', n) : NULL; /* only the head of a binary file is text */
  thr_scan scan;
  thr_span line = {0};
  if (thr_scan_start(&scan, text, nul ? (size_t)(nul - text) : n, "", NULL)) return NULL;
  while (thr_scan_line(&scan, &line)) {
    line = thr_span_trim(line);
    if (line.n == 0 || line.s[0] == '#') continue;
    for (int i = 0; formats[i]; i++)
      if (formats[i]->begins && formats[i]->begins(line)) return formats[i];
    return NULL;
  }
  return NULL;
}

thr_status thr_format_by_text(const char *text, size_t n, const char *name, const thr_format *named, const thr_format **format,
                              thr_err *err)
{
  const thr_format *said = format_said(text, n);
  *format = said && (!named || named->begins) ? said : named ? named : &thr_csv_format;
  const char *foreign = said ? NULL : foreign_name(text, n);
  if (foreign)
    return thr_fail(err, THR_EINPUT, "%s: this is %s, which is not read; export the lines or the mesh as OBJ, PLY, CSV or JSON",
                    name, foreign);
  return THR_OK;
}

const thr_format *thr_format_of_path(const char *path)
{
  const thr_format *format = with_ending(ending_of(path));
  return format && format->write ? format : NULL;
}

void thr_frame_write(const thr_frame *frame, const thr_format *format, thr_text *out)
{
  (format ? format : &thr_json_format)->write(frame, out);
}
