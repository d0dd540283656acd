/* The table of formats, and which of them a file is in: by its name's ending or, failing that, by its first line. */
#include "graph/io/formats.h"
#include "graph/io/read.h"

#include <string.h>

extern const thr_format thr_json_format, thr_obj_format, thr_csv_format;

static const thr_format *const formats[] = {&thr_json_format, &thr_obj_format, &thr_csv_format, NULL};

const thr_format *thr_format_named(const char *name)
{
  for (int i = 0; formats[i]; i++)
    if (strcmp(formats[i]->name, name) == 0) return formats[i];
  return NULL;
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
  static const char *const foreign[] = {"dxf", "dwg",  "ply", "off",   "stl", "3dm",  "graphml",
                                        "gml", "gltf", "glb", "blend", "igs", "step", "stp"};
  const thr_span ending = ending_of(name);
  *format = with_ending(ending);
  for (size_t i = 0; !*format && i < sizeof foreign / sizeof *foreign; i++)
    if (thr_span_is(ending, foreign[i]))
      return thr_fail(err, THR_EINPUT, "%s: %s files are not read; export the lines as OBJ, CSV or JSON", name, foreign[i]);
  return THR_OK;
}

static const thr_format *beginning_with(thr_span line)
{
  for (int i = 0; formats[i]; i++)
    if (formats[i]->begins && formats[i]->begins(line)) return formats[i];
  return NULL;
}

const thr_format *thr_format_by_text(const char *text, size_t n)
{
  thr_scan scan;
  thr_span line = {0};
  /* a text with NUL bytes is left to the reader, who says so */
  if (thr_scan_start(&scan, text, n, "", NULL)) return &thr_csv_format;
  while (thr_scan_line(&scan, &line)) {
    line = thr_span_trim(line);
    if (line.n == 0 || line.s[0] == '#') continue;
    const thr_format *format = beginning_with(line);
    return format ? format : &thr_csv_format;
  }
  return &thr_csv_format;
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
