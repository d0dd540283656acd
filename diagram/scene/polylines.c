/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the cords as lines through the nodes, for CAD and for pictures made elsewhere: Wavefront
 * OBJ, DXF, COMPAS and glTF. Objects are called "cord-A" by the cord's id, as elements of the
 * overview are; docs/outputs.md says more. The same plan gives the same bytes.
 *
 * Every writer appends to out: a plan without cords, or cords that do not fit the framework, are
 * THR_EINPUT, and out is then unchanged. O(nodes + passes).
 *
 * Example, OBJ: "o cord-A", "l 1 2 5" for a cord from node 0 by 1 to 4. */
#include "diagram/scene/scene.h"

#include "graph/io/read.h"
#include "graph/io/json.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Checks that there is a cord and that all cords fit the framework; counts their passes. */
static thr_status check(const thr_plan *plan, int *n_passes, thr_err *err)
{
  thr_status st = thr_scene_check_cords(plan, n_passes, err);
  return !st && !plan->n_cords ? thr_fail(err, THR_EINPUT, "the plan has no cord to draw") : st;
}

/* Appends text to out, if all went well, and destroys text. */
static thr_status take_over(thr_text *text, thr_status st, thr_text *out, thr_err *err)
{
  if (!st && !text->failed) thr_text_append_bytes(out, text->data, text->length);
  if (!st && (text->failed || out->failed)) st = thr_nomem(err);
  thr_text_destroy(text);
  return st;
}

/* ---- OBJ ---- */

/* Appends an OBJ vertex. */
static void put_vertex(const double xyz[3], thr_text *out)
{
  thr_text_append(out, "v");
  for (int i = 0; i < 3; i++) {
    thr_text_byte(out, ' ');
    thr_text_double(out, xyz[i]);
  }
  thr_text_byte(out, '\n');
}

/* Begins an OBJ object for a cord. */
static void put_object(const thr_plan *plan, int c, thr_text *out)
{
  char id[12];
  thr_scene_cord_id(plan, c, id);
  thr_text_printf(out, "o cord-%s\n", id);
}

/* Writes each cord as one line through the nodes, which stand before all cords. If a cord passes an
 * edge again, it goes on to a vertex of its own: in a mesh of Blender two vertices have one edge at
 * most. last: [n_edges] zeros. */
static void put_passes(thr_cord_lines *lines, int *last, thr_text *out)
{
  const thr_plan *plan = lines->plan;
  int n_vertices = plan->frame.n_nodes;
  thr_text line = {0}; /* of the cord: its own vertices come before it */

  /* Vertices 1 .. n_nodes are the nodes; vertices of second passes come after them. */
  for (int c = 0; c < plan->n_cords; c++) {
    const thr_cord *cord = &plan->cord[c];
    thr_cord_lines_next(lines, c);
    put_object(plan, c, out);

    /* OBJ counts vertices from 1. */
    line.length = 0;
    thr_text_printf(&line, "l %d", thr_cord_start(&plan->frame, cord) + 1);
    for (int k = 0; k < cord->n_passes; k++) {
      const int e = cord->half[k] >> 1;
      int to = thr_head(&plan->frame, cord->half[k]) + 1;

      /* The cord has passed this edge before: a second vertex at the same place. */
      if (last[e] == c + 1) {
        put_vertex(lines->point[k + 1], out);
        to = ++n_vertices;
      }

      last[e] = c + 1;
      thr_text_printf(&line, " %d", to);
    }
    thr_text_append_bytes(out, line.data, line.length);
    thr_text_byte(out, '\n');
    out->failed |= line.failed;
  }
  thr_text_destroy(&line);
}

/* Writes each cord with vertices of its own, in the lanes. */
static void put_lanes(thr_cord_lines *lines, thr_text *out)
{
  for (int c = 0, first = 1; c < lines->plan->n_cords; c++) {
    thr_cord_lines_next(lines, c);
    put_object(lines->plan, c, out);

    /* Points, then a line through all of them. */
    for (int i = 0; i < lines->n_points; i++)
      put_vertex(lines->point[i], out);
    thr_text_append(out, "l");
    for (int i = 0; i < lines->n_points; i++)
      thr_text_printf(out, " %d", first + i);
    thr_text_byte(out, '\n');
    first += lines->n_points;
  }
}

/* Lists which vertex is which place of the booklet, where places are not called by their numbers.
 */
static void put_places(const thr_plan *plan, const char (*label)[THR_LABEL], thr_text *out)
{
  enum { IN_LINE = 10 };
  char number[16];
  bool same = true;
  for (int v = 0; v < plan->frame.n_nodes; v++) {
    snprintf(number, sizeof number, "%d", v + 1);
    same &= strcmp(number, label[v]) == 0;
  }
  for (int v = 0; v < plan->frame.n_nodes && !same; v++)
    thr_text_printf(out, "%s%d = %s%s", v % IN_LINE ? ", " : "# places: ", v + 1, label[v],
                    v % IN_LINE + 1 == IN_LINE || v + 1 == plan->frame.n_nodes ? "\n" : "");
}

thr_status thr_polylines_obj(const thr_plan *plan, const thr_line_options *options, thr_text *out,
                             thr_err *err)
{
  int n;
  thr_text text = {0};
  thr_cord_lines lines;
  thr_status st = check(plan, &n, err);
  if (st) return st;

  int *last = thr_calloc((size_t)plan->frame.n_edges, sizeof *last);
  st = thr_cord_lines_begin(&lines, plan, options, err);
  if (!st && !last) st = thr_nomem(err);

  /* The head says which way is up and, without the nodes' own head, the units. */
  thr_text_printf(&text, "# thread plan: %d cord%s, %d passes\n", plan->n_cords,
                  plan->n_cords == 1 ? "" : "s", n);
  if (options->up_y) thr_text_append(&text, "# up: y\n");

  if (!st && options->lanes) {
    thr_text_append(&text, "# units: ");
    thr_text_append_clean(&text, plan->frame.units);
    thr_text_byte(&text, '\n');
    put_lanes(&lines, &text);
  } else if (!st) {
    thr_obj_write_nodes(&plan->frame, options->up_y, &text);
    if (options->label) put_places(plan, options->label, &text);
    put_passes(&lines, last, &text);
  }

  free(last);
  thr_cord_lines_end(&lines);
  return take_over(&text, st, out, err);
}

/* ---- DXF ---- */

/* Returns the index of AutoCAD's colours that is nearest to "#rrggbb", by the distance in RGB.
 *
 * Indices 10 to 249 are 24 hues in steps of 15 degrees, each in five shades; odd indices are half
 * as vivid. O(240). */
static int colour_index(const char *hex)
{
  static const double shade[] = {1, 0.65, 0.5, 0.3, 0.15};
  const long wanted = strtol(hex + 1, NULL, 16);
  const double rgb[3] = {(double)(wanted >> 16 & 255) / 255, (double)(wanted >> 8 & 255) / 255,
                         (double)(wanted & 255) / 255};

  int best = 7;
  double least = 3;
  for (int index = 10; index < 250; index++) {
    /* Hue in sixths of the circle, the largest component, the least component. */
    const double hue = (index / 10 - 1) / 4.0, value = shade[index % 10 / 2],
                 pale = index % 2 ? value / 2 : 0;

    /* A primary has its full value within a sixth of the circle from its hue, and the least value
     * from two sixths on. */
    double apart = 0;
    for (int k = 0; k < 3; k++) {
      double from = fabs(hue - 2 * k); /* sixths of the circle from red, green or blue */
      if (from > 3) from = 6 - from;
      const double part = fmin(fmax(2 - from, 0), 1), own = pale + (value - pale) * part;
      apart += (own - rgb[k]) * (own - rgb[k]);
    }

    if (apart < least) {
      least = apart;
      best = index;
    }
  }

  return best;
}

/* Returns the colour of a cord in the overview: copies have that of their unique path. */
static thr_colour colour_of(const thr_plan *plan, const thr_copy *copy, int c)
{
  return thr_palette(thr_copies_paths(copy, plan->n_cords) < plan->n_cords ? copy[c].path : c);
}

/* Writes a cord as a DXF polyline in space. The numbers are DXF's group codes: 66 says that
 * vertices follow, 70 the flags. */
static void put_polyline(thr_cord_lines *lines, int c, const char *layer, thr_text *out)
{
  enum { IN_SPACE = 8, VERTEX_IN_SPACE = 32 };
  static const double origin[3] = {0, 0, 0};

  /* DXF wants a point of the polyline itself, which means nothing. */
  thr_cord_lines_next(lines, c);
  thr_dxf_pair(out, 0, "POLYLINE");
  thr_dxf_pair(out, 8, layer);
  thr_dxf_int(out, 66, 1);
  thr_dxf_point(out, 0, origin);
  thr_dxf_int(out, 70, IN_SPACE);

  /* The vertices, in the order of the passes. */
  for (int i = 0; i < lines->n_points; i++) {
    thr_dxf_pair(out, 0, "VERTEX");
    thr_dxf_pair(out, 8, layer);
    thr_dxf_point(out, 0, lines->point[i]);
    thr_dxf_int(out, 70, VERTEX_IN_SPACE);
  }

  thr_dxf_pair(out, 0, "SEQEND");
  thr_dxf_pair(out, 8, layer);
}

/* Writes the name of each node's place beside it, on a layer of their own: a quarter of the
 * shortest edge high. label[n_nodes]: the names. */
static void put_texts(const thr_plan *plan, const thr_line_options *options, const char *layer,
                      thr_text *out)
{
  const thr_frame *frame = &plan->frame;
  double shortest = INFINITY;
  for (int e = 0; e < frame->n_edges; e++)
    shortest = fmin(shortest, frame->length[e]);

  for (int v = 0; v < frame->n_nodes; v++) {
    double at[3];
    thr_cord_lines_turn(options, frame->xyz[v], at);
    thr_dxf_pair(out, 0, "TEXT");
    thr_dxf_pair(out, 8, layer);
    thr_dxf_point(out, 0, at);
    thr_text_append(out, "40\n");
    thr_text_double(out, 0.25 * shortest);
    thr_text_append(out, "\n");
    thr_dxf_pair(out, 1, options->label[v]);
  }
}

/* Names a cord's layer and chooses its colour. */
static void name_layer(const thr_plan *plan, const thr_copy *copy, int c, thr_dxf_layer *layer)
{
  char id[12];
  thr_scene_cord_id(plan, c, id);
  snprintf(layer->name, sizeof layer->name, "cord-%s", id);
  layer->colour = colour_index(colour_of(plan, copy, c).hex);
}

thr_status thr_polylines_dxf(const thr_plan *plan, const thr_line_options *options, thr_text *out,
                             thr_err *err)
{
  int n;
  thr_text text = {0};
  thr_cord_lines lines;
  thr_status st = check(plan, &n, err);
  if (st) return st;

  /* Colours depend on which cords are copies. */
  thr_copy *copy = thr_calloc((size_t)plan->n_cords, sizeof *copy);
  const int n_layers = plan->n_cords + (options->label != NULL);
  thr_dxf_layer *layer = thr_calloc((size_t)n_layers, sizeof *layer);
  st = thr_cord_lines_begin(&lines, plan, options, err);
  if (!st && (!copy || !layer)) st = thr_nomem(err);
  if (!st) st = thr_copies_find(plan, copy, err);

  /* DXF lists all layers before the first polyline; 7 is black on white, white on black. */
  for (int c = 0; c < plan->n_cords && !st; c++)
    name_layer(plan, copy, c, &layer[c]);
  if (!st && options->label) layer[plan->n_cords] = (thr_dxf_layer){"places", 7};
  if (!st) thr_dxf_begin(&text, plan->frame.units, layer, n_layers);

  for (int c = 0; c < plan->n_cords && !st; c++)
    put_polyline(&lines, c, layer[c].name, &text);
  if (!st && options->label) put_texts(plan, options, layer[plan->n_cords].name, &text);

  thr_dxf_end(&text);
  thr_cord_lines_end(&lines);
  free(copy);
  free(layer);
  return take_over(&text, st, out, err);
}

/* ---- COMPAS ---- */

/* Writes a cord as COMPAS stores a polyline: {"dtype": .., "name": .., "data": {"points":
 * [..]}}. */
static void put_compas(thr_cord_lines *lines, int c, thr_writer *writer)
{
  char id[12], name[24];
  thr_scene_cord_id(lines->plan, c, id);
  snprintf(name, sizeof name, "cord-%s", id);

  thr_cord_lines_next(lines, c);

  thr_write_line(writer, 0);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "dtype", "compas.geometry/Polyline");
  thr_write_string(writer, "name", name);
  thr_write_object(writer, "data");
  thr_write_array(writer, "points");

  /* One row of three numbers for each point. */
  for (int i = 0; i < lines->n_points; i++)
    thr_write_numbers(writer, NULL, lines->point[i], 3);

  thr_write_close(writer);
  thr_write_close(writer);
  thr_write_close(writer);
}

thr_status thr_polylines_compas(const thr_plan *plan, const thr_line_options *options,
                                thr_text *out, thr_err *err)
{
  int n;
  thr_text text = {0};
  thr_writer writer = {.out = &text};
  thr_cord_lines lines;

  thr_status st = check(plan, &n, err);
  if (st) return st;
  st = thr_cord_lines_begin(&lines, plan, options, err);

  /* Units and direction first, so that a script can convert. */
  thr_write_object(&writer, NULL);
  thr_write_string(&writer, "units", plan->frame.units);
  thr_write_string(&writer, "up", options->up_y ? "y" : "z");
  thr_write_array(&writer, "cords");

  for (int c = 0; c < plan->n_cords && !st; c++)
    put_compas(&lines, c, &writer);

  thr_write_close(&writer);
  thr_write_close(&writer);
  thr_text_append(&text, "\n");
  thr_cord_lines_end(&lines);
  return take_over(&text, st, out, err);
}

/* ---- glTF ---- */

/* Constants of the glTF 2.0 specification. */
enum { ARRAY_BUFFER = 34962, FLOAT = 5126, LINE_STRIP = 3 };

/* The points of a cord in the buffer: how many, and their bounding box. */
typedef struct {
  float low[3], high[3];
  int count;
} strip;

/* A buffer's bytes as base64, as they come: up to two bytes wait for a group of three. */
typedef struct {
  thr_text *out;
  unsigned char waiting[3];
  int n;
} base64;

/* Appends a byte; a full group of three becomes four letters. */
static void put_byte(base64 *buffer, unsigned char byte)
{
  buffer->waiting[buffer->n++] = byte;
  if (buffer->n < 3) return;
  thr_text_base64(buffer->out, buffer->waiting);
  buffer->n = 0;
}

/* Appends a number in little endian, whatever this machine is. */
static void put_float(base64 *buffer, float value)
{
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 4; i++)
    put_byte(buffer, (unsigned char)(bits >> 8 * i & 255));
}

/* Converts a point to metres in 32 bits. THR_EINPUT: the point does not fit. */
static thr_status position(const double at[3], double metres, float out[3], thr_err *err)
{
  for (int i = 0; i < 3; i++) {
    const double value = at[i] * metres;
    if (!(fabs(value) <= FLT_MAX))
      return thr_fail(
          err, THR_EINPUT,
          "a node lies too far away for glTF's numbers; move the framework or set its --units");

    /* No negative zero: the same point gives the same bytes. */
    out[i] = value == 0 ? 0 : (float)value;
  }

  return THR_OK;
}

/* Appends the points of a cord to the buffer. A point has twelve bytes, full groups of three:
 * base64 needs no padding. */
static thr_status put_strip(thr_cord_lines *lines, int c, double metres, base64 *buffer,
                            strip *cord_strip, thr_err *err)
{
  float at[3] = {0};

  thr_cord_lines_next(lines, c);
  *cord_strip = (strip){.count = lines->n_points};

  for (int k = 0; k < cord_strip->count; k++) {
    thr_status st = position(lines->point[k], metres, at, err);
    if (st) return st;

    /* The accessor must say the bounding box. */
    for (int i = 0; i < 3; i++) {
      cord_strip->low[i] = k ? fminf(cord_strip->low[i], at[i]) : at[i];
      cord_strip->high[i] = k ? fmaxf(cord_strip->high[i], at[i]) : at[i];
      put_float(buffer, at[i]);
    }
  }

  return THR_OK;
}

/* Writes a corner of a bounding box. */
static void put_corner(thr_writer *writer, const char *key, const float corner[3])
{
  thr_write_array(writer, key);
  for (int i = 0; i < 3; i++)
    thr_write_printf(writer, NULL, "%.9g", (double)corner[i]);
  thr_write_close(writer);
}

/* Returns a component of a colour, two hexadecimal digits of sRGB, as linear light (IEC
 * 61966-2-1). */
static double linear(const char *hex)
{
  char two[3] = {hex[0], hex[1]};
  double value = (double)strtol(two, NULL, 16) / 255;
  return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

/* Writes a cord's material: its colour in the overview, matt. */
static void put_material(thr_writer *writer, const thr_plan *plan, const thr_copy *copy, int c)
{
  const thr_colour colour = colour_of(plan, copy, c);

  /* Copies are pale. */
  const char *hex = copy[c].of == c ? colour.hex : colour.pale;

  thr_write_object(writer, "pbrMetallicRoughness");
  thr_write_array(writer, "baseColorFactor");

  /* Linear light, opacity 1. */
  for (int i = 1; i < 7; i += 2)
    thr_write_printf(writer, NULL, "%.4f", linear(hex + i));
  thr_write_int(writer, NULL, 1);
  thr_write_close(writer);

  /* Neither metal nor gloss. */
  thr_write_int(writer, "metallicFactor", 0);
  thr_write_int(writer, "roughnessFactor", 1);
  thr_write_close(writer);
}

/* Writes a mesh's only primitive: the line strip of accessor c in material c. */
static void put_primitive(thr_writer *writer, int c)
{
  thr_write_array(writer, "primitives");
  thr_write_object(writer, NULL);

  thr_write_object(writer, "attributes");
  thr_write_int(writer, "POSITION", c);
  thr_write_close(writer);

  thr_write_int(writer, "mode", LINE_STRIP);
  thr_write_int(writer, "material", c);
  thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes the accessor of a cord: how its part of the buffer is read. */
static void put_accessor(thr_writer *writer, int c, const strip *cord_strip)
{
  thr_write_int(writer, "bufferView", c);
  thr_write_int(writer, "componentType", FLOAT);
  thr_write_int(writer, "count", cord_strip->count);
  thr_write_string(writer, "type", "VEC3");
  put_corner(writer, "min", cord_strip->low);
  put_corner(writer, "max", cord_strip->high);
}

/* Writes the view of a cord: which bytes of the buffer are its. */
static void put_view(thr_writer *writer, const strip *cord_strip, int64_t offset)
{
  thr_write_int(writer, "buffer", 0);
  thr_write_int(writer, "byteOffset", offset);
  thr_write_int(writer, "byteLength", 12 * (int64_t)cord_strip->count);
  thr_write_int(writer, "target", ARRAY_BUFFER);
}

/* The lists of a glTF file that have one element for each cord. */
typedef enum { NODES, MESHES, MATERIALS, ACCESSORS, VIEWS, N_LISTS } list;

/* Writes the element of cord c in a list. offset: bytes of the buffer before the cord's. */
static void put_element(thr_writer *writer, const thr_plan *plan, const thr_copy *copy, list what,
                        int c, const strip *cord_strip, int64_t offset)
{
  char id[12], name[24];

  thr_scene_cord_id(plan, c, id);
  snprintf(name, sizeof name, "cord-%s", id);

  thr_write_line(writer, 0);
  thr_write_object(writer, NULL);
  if (what <= MATERIALS) thr_write_string(writer, "name", name);

  /* Element c belongs to cord c, and refers to elements c of other lists. */
  switch (what) {
  case NODES: thr_write_int(writer, "mesh", c); break;
  case MESHES: put_primitive(writer, c); break;
  case MATERIALS: put_material(writer, plan, copy, c); break;
  case ACCESSORS: put_accessor(writer, c, cord_strip); break;
  default: put_view(writer, cord_strip, offset);
  }

  thr_write_close(writer);
}

/* Writes all lists, each with an element for each cord. */
static void put_members(thr_writer *writer, const thr_plan *plan, const thr_copy *copy,
                        const strip *strips)
{
  static const char *const key[N_LISTS] = {"nodes", "meshes", "materials", "accessors",
                                           "bufferViews"};

  for (int what = 0; what < N_LISTS; what++) {
    int64_t offset = 0;
    thr_write_line(writer, 0);
    thr_write_array(writer, key[what]);

    /* The strips follow each other in the buffer. */
    for (int c = 0; c < plan->n_cords; c++) {
      put_element(writer, plan, copy, (list)what, c, &strips[c], offset);
      offset += 12 * (int64_t)strips[c].count;
    }
    thr_write_close(writer);
  }
}

/* Writes what comes before the lists: the asset, and a scene of all nodes. */
static void put_head(thr_writer *writer, const thr_plan *plan, double metres)
{
  thr_write_line(writer, 0);
  thr_write_object(writer, "asset");
  thr_write_string(writer, "version", "2.0");
  thr_write_string(writer, "generator", "thread");

  /* The unit of the framework is lost in metres: extras keep it. */
  thr_write_object(writer, "extras");
  thr_write_string(writer, "unit", plan->frame.units);
  thr_write_number(writer, "metres_per_unit", metres);
  thr_write_close(writer);
  thr_write_close(writer);

  thr_write_line(writer, 0);
  thr_write_int(writer, "scene", 0);

  /* The only scene. */
  thr_write_line(writer, 0);
  thr_write_array(writer, "scenes");
  thr_write_object(writer, NULL);
  thr_write_array(writer, "nodes");

  for (int c = 0; c < plan->n_cords; c++)
    thr_write_int(writer, NULL, c);

  thr_write_close(writer);
  thr_write_close(writer);
  thr_write_close(writer);
}

/* Writes the only buffer, of n points. Takes over its address, the data themselves. */
static void put_buffers(thr_writer *writer, int64_t n, thr_text *address)
{
  thr_write_line(writer, 0);
  thr_write_array(writer, "buffers");

  thr_write_object(writer, NULL);
  thr_write_int(writer, "byteLength", 12 * n);
  thr_write_words(writer, "uri", address);
  thr_write_close(writer);
  thr_write_close(writer);
}

thr_status thr_polylines_gltf(const thr_plan *plan, const thr_line_options *options, thr_text *out,
                              thr_err *err)
{
  int n;
  double mm;
  int64_t n_points = 0;
  thr_text text = {0}, data = {0};
  thr_writer writer = {.out = &text};
  base64 bytes = {.out = &data};
  thr_cord_lines lines;

  thr_status st = check(plan, &n, err);
  if (st) return st;

  /* Colours depend on which cords are copies. */
  thr_copy *copy = thr_calloc((size_t)plan->n_cords, sizeof *copy);
  strip *strips = thr_calloc((size_t)plan->n_cords, sizeof *strips);

  /* In glTF y points up, whatever the options say. */
  const thr_line_options turned = {.lanes = options->lanes, .up_y = true};
  st = thr_cord_lines_begin(&lines, plan, &turned, err);
  if (!st && (!copy || !strips)) st = thr_nomem(err);
  if (!st) st = thr_copies_find(plan, copy, err);

  /* Units of no known length count as mm. */
  double metres = thr_units_in_mm(plan->frame.units, &mm, NULL) ? 0.001 : mm / 1000;
  thr_text_append(&data, "data:application/octet-stream;base64,");

  /* The points first: the lists need their bounding boxes. */
  for (int c = 0; c < plan->n_cords && !st; c++) {
    st = put_strip(&lines, c, metres, &bytes, &strips[c], err);
    n_points += strips[c].count;
  }

  thr_cord_lines_end(&lines);

  /* Head, lists, buffer. */
  if (!st) {
    thr_write_object(&writer, NULL);
    put_head(&writer, plan, metres);
    put_members(&writer, plan, copy, strips);
    put_buffers(&writer, n_points, &data);
    thr_write_line(&writer, 0);
    thr_write_close(&writer);
    thr_text_append(&text, "\n");
  }

  thr_text_destroy(&data);
  free(copy);
  free(strips);
  return take_over(&text, st, out, err);
}
