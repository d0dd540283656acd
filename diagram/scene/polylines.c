#include "diagram/scene/polylines.h"

#include "diagram/scene/copies.h"
#include "diagram/scene/palette.h"
#include "diagram/scene/scene.h"
#include "graph/framework/frame.h"
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

thr_status thr_polylines_obj(const thr_plan *plan, thr_text *out, thr_err *err)
{
  int n;
  thr_text text = {0};
  thr_status st = check(plan, &n, err);
  if (st) return st;
  thr_text_printf(&text, "# thread plan: %d cord%s, %d passes\n", plan->n_cords, plan->n_cords == 1 ? "" : "s", n);
  thr_obj_write_nodes(&plan->frame, &text);
  for (int c = 0; c < plan->n_cords; c++) {
    char id[12];
    thr_scene_cord_id(plan, c, id);
    thr_text_printf(&text, "o cord-%s\n", id);
    for (int k = 0; k < plan->cord[c].n_passes; k++)
      thr_text_printf(&text, "l %d %d\n", thr_tail(&plan->frame, plan->cord[c].half[k]) + 1,
                      thr_head(&plan->frame, plan->cord[c].half[k]) + 1);
  }
  return take_over(&text, THR_OK, out, err);
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
  const char four[4] = {letter[bits >> 18], letter[bits >> 12 & 63], letter[bits >> 6 & 63], letter[bits & 63]};
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

/* In metres, y upwards. */
static thr_status position(const thr_frame *frame, int v, double metres, float at[3], thr_err *err)
{
  const double *a = frame->xyz[v], turned[3] = {a[0] * metres, a[2] * metres, -a[1] * metres};
  for (int i = 0; i < 3; i++) {
    if (!(fabs(turned[i]) <= FLT_MAX))
      return thr_fail(err, THR_EINPUT, "node %d lies too far away for glTF's numbers; move the framework or set its --units", v);
    at[i] = turned[i] == 0 ? 0 : (float)turned[i];
  }
  return THR_OK;
}

/* A node has twelve bytes, full groups of three: base64 needs no padding. */
static thr_status put_strip(const thr_plan *plan, int c, double metres, base64 *b, strip *s, thr_err *err)
{
  const thr_cord *cord = &plan->cord[c];
  float at[3] = {0};
  *s = (strip){.count = cord->n_passes + 1};
  for (int k = 0; k < s->count; k++) {
    int v = k ? thr_head(&plan->frame, cord->half[k - 1]) : thr_cord_start(&plan->frame, cord);
    thr_status st = position(&plan->frame, v, metres, at, err);
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
  bool symmetric = thr_copies_paths(copy, plan->n_cords) < plan->n_cords;
  thr_colour colour = thr_palette(symmetric ? copy[c].path : c);
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
static void put_element(thr_writer *writer, const thr_plan *plan, const thr_copy *copy, list what, int c, const strip *s,
                        int64_t offset)
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

static void put_lists(thr_writer *writer, const thr_plan *plan, const thr_copy *copy, const strip *s)
{
  static const char *const key[N_LISTS] = {"nodes", "meshes", "materials", "accessors", "bufferViews"};
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

thr_status thr_polylines_gltf(const thr_plan *plan, thr_text *out, thr_err *err)
{
  int n;
  double mm;
  thr_text text = {0}, data = {0};
  thr_writer writer = {.out = &text};
  base64 bytes = {.out = &data};
  thr_status st = check(plan, &n, err);
  if (st) return st;
  thr_copy *copy = thr_calloc((size_t)plan->n_cords, sizeof *copy);
  strip *s = thr_calloc((size_t)plan->n_cords, sizeof *s);
  if (!copy || !s) st = thr_nomem(err);
  if (!st) st = thr_copies_find(plan, copy, err);
  double metres = thr_units_in_mm(plan->frame.units, &mm, NULL) ? 0.001 : mm / 1000;
  thr_text_append(&data, "data:application/octet-stream;base64,");
  for (int c = 0; c < plan->n_cords && !st; c++)
    st = put_strip(plan, c, metres, &bytes, &s[c], err);
  if (!st) {
    thr_write_object(&writer, NULL);
    put_head(&writer, plan, metres);
    put_lists(&writer, plan, copy, s);
    put_buffers(&writer, (int64_t)n + plan->n_cords, &data);
    thr_write_line(&writer, 0);
    thr_write_close(&writer);
    thr_text_append(&text, "\n");
  }
  thr_text_destroy(&data);
  free(copy);
  free(s);
  return take_over(&text, st, out, err);
}
