/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads frameworks: one call for every format.
 *
 * The room graph/io reads and writes frameworks in ten formats, and JSON documents of any kind. The
 * text of a file goes through the reader of its format into a draft (graph/framework/frame.h),
 * which knows nothing of formats; thr_draft_build makes the framework. Readers trust nothing: each
 * number, index and size is checked where it is read, and a message says file, line, what is wrong
 * and what to do.
 *
 * Read first read.c (from file to framework), formats.c (which format a file has), scan.c (lines,
 * words, numbers) and read_off.c, the shortest reader. Then, as needed:
 *   tables    read_csv.c, headers.c
 *   meshes    read_obj.c, read_ply.c, read_stl.c, read_gltf.c, with faces.c and sites.c
 *   drawings  read_dxf.c, read_vef.c, with curve.c and parts.c
 *   graphs    graphml.c, xml.c, links.c
 *   JSON      json.c, read_json.c, read_json_values.c, then the other read_json_*.c
 *   writing   writer.c, write.c, dxf.c
 * What only the readers share is in read_parts.h. */
#ifndef THR_READ_H
#define THR_READ_H

#include "graph/framework/frame.h"
#include "graph/io/json.h"

/* ---- stand.c: What a file may leave unsaid: which of its coordinates points up, and how large its
 * numbers are meant. */

/* AUTO: y if the file's maker is known to write that (Blender), else z. */
typedef enum { THR_UP_AUTO, THR_UP_Y, THR_UP_Z } thr_up;
const char *thr_up_name(int up); /* "auto", "y", "z" */

/* Turns the draft so that z points up and multiplies its coordinates and lengths by scale > 0; the
 * report says if y was up, whence that is known, and if it seems to lie. THR_EINPUT if a coordinate
 * or a length leaves the range of numbers. O(nodes + edges). */
thr_status thr_draft_stand(thr_draft *draft, thr_up up, double scale, thr_read_report *report,
                           thr_err *err) THR_MUST_CHECK;

/* ---- read.c: Reading and writing frameworks. */

typedef struct thr_format thr_format; /* graph/io/formats.c */

/* "json", "obj", "csv", "ply", "off" or "stl"; NULL if there is none of that name. */
const thr_format *thr_format_named(const char *name);
const thr_format *thr_format_written(const char *name); /* of those that are written */

/* Lists the formats that are written: with ".", ", " and " or " as ".json, .obj or .csv". */
void thr_formats_written(char *list, size_t size, const char *before, const char *between,
                         const char *last);

typedef struct {
  const char *edges_path; /* second file of a CSV nodes + edges pair, or NULL */
  double weld;            /* weld tolerance in units, < 0 = 1e-6 of the bounding box's diagonal */
  const char *units;      /* overrides the file's, or NULL */
  thr_up up;              /* with y, a node at x, y, z stands at x, -z, y */
  double scale;           /* of all coordinates and lengths, > 0 */
  double flat; /* rad: two triangles that meet at less have no edge between them; 0 = all sides are
                  edges */
  const char *pick; /* of a file that holds several frameworks, objects or layers: the name or the
                       number of one of them, from 1; NULL = all of a list */
  bool all_layers;  /* of a drawing the layers that are off or frozen, too */
  const char *columns; /* of a table of edges: the two columns of their ends by name or number,
                          "a,b"; NULL = as it says */
  bool split;          /* an edge is cut where a node lies on it */
  bool parallel; /* of edges between the same two nodes all that differ in length are kept, parted
                    by a node each */
} thr_read_options;

thr_read_options thr_read_options_default(void);

/* Reads a framework ("-" is stdin) in the format that its extension or, failing that, its content
 * says. A nodes-only CSV whose name contains "nodes" finds the file named "edges" beside it (and
 * the other way round); pair_path (capacity pair_size, may be NULL) receives that file's name, else
 * "". Errors are "path:line: what; what to do". */
thr_status thr_frame_read(thr_frame *frame, thr_read_report *report, const char *path,
                          const thr_read_options *options, char *pair_path, size_t pair_size,
                          thr_err *err) THR_MUST_CHECK;

/* The same of a text in memory; its name only says the format, and is for messages. No pair of
 * files: options->edges_path does not count. */
thr_status thr_frame_parse(thr_frame *frame, thr_read_report *report, const char *text, size_t n,
                           const char *name, const thr_read_options *options,
                           thr_err *err) THR_MUST_CHECK;

/* Parses one text into a draft; format: NULL = the one that the name's ending or, failing that, the
 * text says. On failure the draft is empty. What the fuzzers call. CSV text with nodes only or
 * edges only gives THR_EINPUT that says so: use thr_csv_parse_pair. */
thr_status thr_draft_parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                           const char *name, const thr_format *format, thr_err *err) THR_MUST_CHECK;

/* CSV pair: a table of nodes (id, x, y, z by header or position) and a table of edges (two node ids
 * first). */
thr_status thr_csv_parse_pair(thr_draft *draft, thr_read_report *report, const thr_text *nodes,
                              const char *nodes_name, const thr_text *edges, const char *edges_name,
                              thr_err *err) THR_MUST_CHECK;

/* What a JSON document says of the edge added last: cover and capacity, NULL or null = nothing.
 * THR_EINPUT: why not, without the place. */
thr_status thr_json_edge_passes(thr_draft *draft, const thr_json *cover, const thr_json *capacity,
                                thr_err *err) THR_MUST_CHECK;

/* Appends the framework in a format; NULL is JSON (JSON: our own frame; OBJ: v + two-vertex l
 * records, feet as a comment line
 * "# feet: .." that thr_obj_parse reads back; CSV: six columns per edge). */
void thr_frame_write(const thr_frame *frame, const thr_format *format, thr_text *out);

/* Of an OBJ file the comments on units and feet and the v records: vertex v + 1 is node v; up_y: x,
 * y, z is written as x, z, -y.
 */
void thr_obj_write_nodes(const thr_frame *frame, bool up_y, thr_text *out);

/* What follows the last dot of the file's name, "" if nothing does; borrowed from the path. */
const char *thr_path_ending(const char *path);

/* The format that the path's ending says; NULL if it says none that can be written. */
const thr_format *thr_format_of_path(const char *path);

/* ---- dxf.c: Writing DXF: drawings in the sense of release 12 (AC1009), the oldest that everything
 * reads, with a unit. */

/* The unit of each code of $INSUNITS, NULL for 0 and where there is no such code. */
enum { THR_DXF_UNITS = 25 };
const char *thr_dxf_unit(int code);

typedef struct {
  char name[32];
  int colour; /* of AutoCAD's index */
} thr_dxf_layer;

void thr_dxf_pair(thr_text *out, int code, const char *value);
void thr_dxf_int(thr_text *out, int code, int value);
/* Codes 10 + first, 20 + first and 30 + first. */
void thr_dxf_point(thr_text *out, int first, const double xyz[3]);

/* All before the first entity: units, layers, and the begin of the entities; and what ends the
 * file. */
void thr_dxf_begin(thr_text *out, const char *units, const thr_dxf_layer *layer, int n_layers);
void thr_dxf_end(thr_text *out);

#endif
