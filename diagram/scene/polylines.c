/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cords as lines through the nodes, for CAD and for pictures made elsewhere. Objects are called
 * "cord-A" by the cord's id as elements of the overview are; docs/outputs.md says more. The same
 * plan gives the same bytes. THR_EINPUT for a plan without cords and for cords that do not fit the
 * framework; out is then unchanged. O(nodes + passes). */
#include "diagram/scene/scene.h"

#include "graph/framework/units.h"
#include "graph/io/read.h"
#include "graph/io/writer.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static thr_status check(const thr_plan *plan, int *n_passes, thr_err *err)
{
  thr_status st = thr_scene_check_cords(plan, n_passes, err);
  return !st && !plan->n_cords ? thr_fail(err, THR_EINPUT, "the plan has no cord to draw") : st;
}

/* Takes text over into out, if all went well. Destroys it. */
static thr_status take_over(thr_text *text, thr_status st, thr_text *out, thr_err *err)
{
  if (!st && !text->failed) thr_text_append_bytes(out, text->data, text->length);
  if (!st && (text->failed || out->failed)) st = thr_nomem(err);
  thr_text_destroy(text);
  return st;
}

/* ---- OBJ ---- */

static void put_vertex(const double xyz[3], thr_text *out)
{
  thr_text_append(out, "v");
  for (int i = 0; i < 3; i++) {
    thr_text_byte(out, ' ');
    thr_text_double(out, xyz[i]);
  }
  thr_text_byte(out, '\n');
}

static void put_object(const thr_plan *plan, int c, thr_text *out)
{
  char id[12];
  thr_scene_cord_id(plan, c, id);
  thr_text_printf(out, "o cord-%s\n", id);
}

/* Each cord through the nodes, which stand before all of them. Where it passes an edge again it
 * goes on to a vertex of its own: two vertices have one edge in a mesh of Blender. last: [n_edges]
 * zeros. */
static void put_passes(thr_cord_lines *lines, int *last, thr_text *out)
{
  const thr_plan *plan = lines->plan;
  int n_vertices = plan->frame.n_nodes;
  for (int c = 0; c < plan->n_cords; c++) {
    const thr_cord *cord = &plan->cord[c];
    thr_cord_lines_next(lines, c);
    put_object(plan, c, out);
    for (int k = 0, from = thr_cord_start(&plan->frame, cord) + 1, to; k < cord->n_passes;
         k++, from = to) {
      const int e = cord->half[k] >> 1;
      to = thr_head(&plan->frame, cord->half[k]) + 1;
      if (last[e] == c + 1) {
        put_vertex(lines->point[k + 1], out);
        to = ++n_vertices;
      }
      last[e] = c + 1;
      thr_text_printf(out, "l %d %d\n", from, to);
    }
  }
}

/* Each cord with vertices of its own. */
static void put_lanes(thr_cord_lines *lines, thr_text *out)
{
  for (int c = 0, first = 1; c < lines->plan->n_cords; c++) {
    thr_cord_lines_next(lines, c);
    put_object(lines->plan, c, out);
    for (int i = 0; i < lines->n_points; i++)
      put_vertex(lines->point[i], out);
    for (int i = 0; i + 1 < lines->n_points; i++)
      thr_text_printf(out, "l %d %d\n", first + i, first + i + 1);
    first += lines->n_points;
  }
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
    put_passes(&lines, last, &text);
  }
  free(last);
  thr_cord_lines_end(&lines);
  return take_over(&text, st, out, err);
}

/* ---- DXF ---- */

/* The index of AutoCAD's colours that is nearest to "#rrggbb": 10 to 249 are 24 hues in five
 * shades, full and half as vivid. */
static int colour_index(const char *hex)
{
  static const double shade[] = {1, 0.65, 0.5, 0.3, 0.15};
  const long wanted = strtol(hex + 1, NULL, 16);
  const double rgb[3] = {(double)(wanted >> 16 & 255) / 255, (double)(wanted >> 8 & 255) / 255,
                         (double)(wanted & 255) / 255};
  int best = 7;
  double least = 3;
  for (int i = 10; i < 250; i++) {
    const double hue = (i / 10 - 1) / 4.0, value = shade[i % 10 / 2], pale = i % 2 ? value / 2 : 0;
    double apart = 0;
    for (int k = 0; k < 3; k++) {
      double from = fabs(hue - 2 * k); /* sixths of the circle from red, green or blue */
      if (from > 3) from = 6 - from;
      const double part = fmin(fmax(2 - from, 0), 1), own = pale + (value - pale) * part;
      apart += (own - rgb[k]) * (own - rgb[k]);
    }
    if (apart < least) {
      least = apart;
      best = i;
    }
  }
  return best;
}

/* The colour of a cord in the overview. */
static thr_colour colour_of(const thr_plan *plan, const thr_copy *copy, int c)
{
  return thr_palette(thr_copies_paths(copy, plan->n_cords) < plan->n_cords ? copy[c].path : c);
}

static void put_polyline(thr_cord_lines *lines, int c, const char *layer, thr_text *out)
{
  enum { IN_SPACE = 8, VERTEX_IN_SPACE = 32 };
  static const double origin[3] = {0, 0, 0};
  thr_cord_lines_next(lines, c);
  thr_dxf_pair(out, 0, "POLYLINE");
  thr_dxf_pair(out, 8, layer);
  thr_dxf_int(out, 66, 1);
  thr_dxf_point(out, 0, origin);
  thr_dxf_int(out, 70, IN_SPACE);
  for (int i = 0; i < lines->n_points; i++) {
    thr_dxf_pair(out, 0, "VERTEX");
    thr_dxf_pair(out, 8, layer);
    thr_dxf_point(out, 0, lines->point[i]);
    thr_dxf_int(out, 70, VERTEX_IN_SPACE);
  }
  thr_dxf_pair(out, 0, "SEQEND");
  thr_dxf_pair(out, 8, layer);
}

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
  thr_copy *copy = thr_calloc((size_t)plan->n_cords, sizeof *copy);
  thr_dxf_layer *layer = thr_calloc((size_t)plan->n_cords, sizeof *layer);
  st = thr_cord_lines_begin(&lines, plan, options, err);
  if (!st && (!copy || !layer)) st = thr_nomem(err);
  if (!st) st = thr_copies_find(plan, copy, err);
  for (int c = 0; c < plan->n_cords && !st; c++)
    name_layer(plan, copy, c, &layer[c]);
  if (!st) thr_dxf_begin(&text, plan->frame.units, layer, plan->n_cords);
  for (int c = 0; c < plan->n_cords && !st; c++)
    put_polyline(&lines, c, layer[c].name, &text);
  thr_dxf_end(&text);
  thr_cord_lines_end(&lines);
  free(copy);
  free(layer);
  return take_over(&text, st, out, err);
}

/* ---- COMPAS ---- */

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
  for (int i = 0; i < lines->n_points; i++) {
    thr_write_row(writer, NULL);
    for (int k = 0; k < 3; k++)
      thr_write_number(writer, NULL, lines->point[i][k]);
    thr_write_close(writer);
  }
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

enum { ARRAY_BUFFER = 34962, FLOAT = 5126, LINE_STRIP = 3 };

/* A cord's nodes in the buffer. */
typedef struct {
  float low[3], high[3];
  int count;
} strip;

/* Bytes of the buffer, as they come. */
typedef struct {
  thr_text *out;
  unsigned char waiting[3];
  int n;
} base64;

static void put_byte(base64 *b, unsigned char byte)
{
  static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  b->waiting[b->n++] = byte;
  if (b->n < 3) return;
  unsigned bits = (unsigned)b->waiting[0] << 16 | (unsigned)b->waiting[1] << 8 | b->waiting[2];
  const char four[4] = {letter[bits >> 18], letter[bits >> 12 & 63], letter[bits >> 6 & 63],
                        letter[bits & 63]};
  thr_text_append_bytes(b->out, four, 4);
  b->n = 0;
}

/* Little endian, whatever this machine is. */
static void put_float(base64 *b, float value)
{
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 4; i++)
    put_byte(b, (unsigned char)(bits >> 8 * i & 255));
}

/* In metres. */
static thr_status position(const double at[3], double metres, float out[3], thr_err *err)
{
  for (int i = 0; i < 3; i++) {
    const double x = at[i] * metres;
    if (!(fabs(x) <= FLT_MAX))
      return thr_fail(
          err, THR_EINPUT,
          "a node lies too far away for glTF's numbers; move the framework or set its --units");
    out[i] = x == 0 ? 0 : (float)x;
  }
  return THR_OK;
}

/* A point has twelve bytes, full groups of three: base64 needs no padding. */
static thr_status put_strip(thr_cord_lines *lines, int c, double metres, base64 *b, strip *s,
                            thr_err *err)
{
  float at[3] = {0};
  thr_cord_lines_next(lines, c);
  *s = (strip){.count = lines->n_points};
  for (int k = 0; k < s->count; k++) {
    thr_status st = position(lines->point[k], metres, at, err);
    if (st) return st;
    for (int i = 0; i < 3; i++) {
      s->low[i] = k ? fminf(s->low[i], at[i]) : at[i];
      s->high[i] = k ? fmaxf(s->high[i], at[i]) : at[i];
      put_float(b, at[i]);
    }
  }
  return THR_OK;
}

static void put_corner(thr_writer *writer, const char *key, const float corner[3])
{
  thr_write_array(writer, key);
  for (int i = 0; i < 3; i++)
    thr_write_printf(writer, NULL, "%.9g", (double)corner[i]);
  thr_write_close(writer);
}

static double linear(const char *hex)
{
  char two[3] = {hex[0], hex[1]};
  double value = (double)strtol(two, NULL, 16) / 255;
  return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static void put_material(thr_writer *writer, const thr_plan *plan, const thr_copy *copy, int c)
{
  const thr_colour colour = colour_of(plan, copy, c);
  const char *hex = copy[c].of == c ? colour.hex : colour.pale;
  thr_write_object(writer, "pbrMetallicRoughness");
  thr_write_array(writer, "baseColorFactor");
  for (int i = 1; i < 7; i += 2)
    thr_write_printf(writer, NULL, "%.4f", linear(hex + i));
  thr_write_int(writer, NULL, 1);
  thr_write_close(writer);
  thr_write_int(writer, "metallicFactor", 0);
  thr_write_int(writer, "roughnessFactor", 1);
  thr_write_close(writer);
}

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

static void put_accessor(thr_writer *writer, int c, const strip *s)
{
  thr_write_int(writer, "bufferView", c);
  thr_write_int(writer, "componentType", FLOAT);
  thr_write_int(writer, "count", s->count);
  thr_write_string(writer, "type", "VEC3");
  put_corner(writer, "min", s->low);
  put_corner(writer, "max", s->high);
}

static void put_view(thr_writer *writer, const strip *s, int64_t offset)
{
  thr_write_int(writer, "buffer", 0);
  thr_write_int(writer, "byteOffset", offset);
  thr_write_int(writer, "byteLength", 12 * (int64_t)s->count);
  thr_write_int(writer, "target", ARRAY_BUFFER);
}

typedef enum { NODES, MESHES, MATERIALS, ACCESSORS, VIEWS, N_LISTS } list;

/* One element per cord of a list; bytes before it in the buffer: offset. */
static void put_element(thr_writer *writer, const thr_plan *plan, const thr_copy *copy, list what,
                        int c, const strip *s, int64_t offset)
{
  char id[12], name[24];
  thr_scene_cord_id(plan, c, id);
  snprintf(name, sizeof name, "cord-%s", id);
  thr_write_line(writer, 0);
  thr_write_object(writer, NULL);
  if (what <= MATERIALS) thr_write_string(writer, "name", name);
  switch (what) {
  case NODES: thr_write_int(writer, "mesh", c); break;
  case MESHES: put_primitive(writer, c); break;
  case MATERIALS: put_material(writer, plan, copy, c); break;
  case ACCESSORS: put_accessor(writer, c, s); break;
  default: put_view(writer, s, offset);
  }
  thr_write_close(writer);
}

static void put_members(thr_writer *writer, const thr_plan *plan, const thr_copy *copy,
                        const strip *s)
{
  static const char *const key[N_LISTS] = {"nodes", "meshes", "materials", "accessors",
                                           "bufferViews"};
  for (int what = 0; what < N_LISTS; what++) {
    int64_t offset = 0;
    thr_write_line(writer, 0);
    thr_write_array(writer, key[what]);
    for (int c = 0; c < plan->n_cords; c++) {
      put_element(writer, plan, copy, (list)what, c, &s[c], offset);
      offset += 12 * (int64_t)s[c].count;
    }
    thr_write_close(writer);
  }
}

static void put_head(thr_writer *writer, const thr_plan *plan, double metres)
{
  thr_write_line(writer, 0);
  thr_write_object(writer, "asset");
  thr_write_string(writer, "version", "2.0");
  thr_write_string(writer, "generator", "thread");
  thr_write_object(writer, "extras");
  thr_write_string(writer, "unit", plan->frame.units);
  thr_write_number(writer, "metres_per_unit", metres);
  thr_write_close(writer);
  thr_write_close(writer);
  thr_write_line(writer, 0);
  thr_write_int(writer, "scene", 0);
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

/* Takes over the address of the n points. */
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
  thr_copy *copy = thr_calloc((size_t)plan->n_cords, sizeof *copy);
  strip *s = thr_calloc((size_t)plan->n_cords, sizeof *s);
  const thr_line_options turned = {options->lanes, true};
  st = thr_cord_lines_begin(&lines, plan, &turned, err);
  if (!st && (!copy || !s)) st = thr_nomem(err);
  if (!st) st = thr_copies_find(plan, copy, err);
  double metres = thr_units_in_mm(plan->frame.units, &mm, NULL) ? 0.001 : mm / 1000;
  thr_text_append(&data, "data:application/octet-stream;base64,");
  for (int c = 0; c < plan->n_cords && !st; c++) {
    st = put_strip(&lines, c, metres, &bytes, &s[c], err);
    n_points += s[c].count;
  }
  thr_cord_lines_end(&lines);
  if (!st) {
    thr_write_object(&writer, NULL);
    put_head(&writer, plan, metres);
    put_members(&writer, plan, copy, s);
    put_buffers(&writer, n_points, &data);
    thr_write_line(&writer, 0);
    thr_write_close(&writer);
    thr_text_append(&text, "\n");
  }
  thr_text_destroy(&data);
  free(copy);
  free(s);
  return take_over(&text, st, out, err);
}
