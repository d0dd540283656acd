#include "diagram/scene/polylines.h"

#include "diagram/scene/copies.h"
#include "diagram/scene/palette.h"
#include "diagram/scene/scene.h"
#include "graph/io/read.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static thr_status check(const thr_plan *p, int *n_passes, thr_err *err)
{
  thr_status st = thr_scene_check_cords(p, n_passes, err);
  return !st && !p->n_cords ? thr_fail(err, THR_EINPUT, "the plan has no cord to draw") : st;
}

/* Takes text over into out, if all went well. Destroys it. */
static thr_status take_over(thr_text *text, thr_status st, thr_text *out, thr_err *err)
{
  if (!st && !text->failed) thr_text_append_bytes(out, text->data, text->length);
  if (!st && (text->failed || out->failed)) st = thr_nomem(err);
  thr_text_destroy(text);
  return st;
}

thr_status thr_polylines_obj(const thr_plan *p, thr_text *out, thr_err *err)
{
  int n;
  thr_text t = {0};
  thr_status st = check(p, &n, err);
  if (st) return st;
  thr_text_printf(&t, "# thread plan: %d cord%s, %d passes\n", p->n_cords, p->n_cords == 1 ? "" : "s", n);
  thr_obj_write_nodes(&p->frame, &t);
  for (int c = 0; c < p->n_cords; c++) {
    char id[12];
    thr_scene_cord_id(p, c, id);
    thr_text_printf(&t, "o cord-%s\n", id);
    for (int k = 0; k < p->cord[c].n_passes; k++)
      thr_text_printf(&t, "l %d %d\n", thr_tail(&p->frame, p->cord[c].half[k]) + 1, thr_head(&p->frame, p->cord[c].half[k]) + 1);
  }
  return take_over(&t, THR_OK, out, err);
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
static thr_status position(const thr_frame *f, int v, double metres, float at[3], thr_err *err)
{
  const double *a = f->xyz[v], turned[3] = {a[0] * metres, a[2] * metres, -a[1] * metres};
  for (int i = 0; i < 3; i++) {
    if (!(fabs(turned[i]) <= FLT_MAX))
      return thr_fail(err, THR_EINPUT, "node %d lies too far away for glTF's numbers; move the framework or set its --units", v);
    at[i] = turned[i] == 0 ? 0 : (float)turned[i];
  }
  return THR_OK;
}

/* A node has twelve bytes, full groups of three: base64 needs no padding. */
static thr_status put_strip(const thr_plan *p, int c, double metres, base64 *b, strip *s, thr_err *err)
{
  const thr_cord *cord = &p->cord[c];
  float at[3] = {0};
  *s = (strip){.count = cord->n_passes + 1};
  for (int k = 0; k < s->count; k++) {
    int v = k ? thr_head(&p->frame, cord->half[k - 1]) : thr_cord_start(&p->frame, cord);
    thr_status st = position(&p->frame, v, metres, at, err);
    if (st) return st;
    for (int i = 0; i < 3; i++) {
      s->low[i] = k ? fminf(s->low[i], at[i]) : at[i];
      s->high[i] = k ? fmaxf(s->high[i], at[i]) : at[i];
      put_float(b, at[i]);
    }
  }
  return THR_OK;
}

static void put_corner(const char *key, const float corner[3], thr_text *t)
{
  thr_text_printf(t, ", \"%s\": [%.9g, %.9g, %.9g]", key, (double)corner[0], (double)corner[1], (double)corner[2]);
}

static double linear(const char *hex)
{
  char two[3] = {hex[0], hex[1]};
  double value = (double)strtol(two, NULL, 16) / 255;
  return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static void put_material(const thr_plan *p, const thr_copy *copy, int c, const char *id, thr_text *t)
{
  bool symmetric = thr_copies_paths(copy, p->n_cords) < p->n_cords;
  thr_colour colour = thr_palette(symmetric ? copy[c].path : c);
  const char *hex = copy[c].of == c ? colour.hex : colour.pale;
  thr_text_printf(t,
                  "{\"name\": \"cord-%s\", \"pbrMetallicRoughness\": {\"baseColorFactor\": [%.4f, %.4f, %.4f, 1], "
                  "\"metallicFactor\": 0, \"roughnessFactor\": 1}}",
                  id, linear(hex + 1), linear(hex + 3), linear(hex + 5));
}

typedef enum { NODES, MESHES, MATERIALS, ACCESSORS, VIEWS, N_LISTS } list;

/* One element per cord of a list; bytes before it in the buffer: offset. */
static void put_element(const thr_plan *p, const thr_copy *copy, list what, int c, const strip *s, size_t offset, thr_text *t)
{
  char id[12];
  thr_scene_cord_id(p, c, id);
  switch (what) {
  case NODES: thr_text_printf(t, "{\"name\": \"cord-%s\", \"mesh\": %d}", id, c); break;
  case MESHES:
    thr_text_printf(t,
                    "{\"name\": \"cord-%s\", \"primitives\": [{\"attributes\": {\"POSITION\": %d}, \"mode\": %d, "
                    "\"material\": %d}]}",
                    id, c, LINE_STRIP, c);
    break;
  case MATERIALS: put_material(p, copy, c, id, t); break;
  case ACCESSORS:
    thr_text_printf(t, "{\"bufferView\": %d, \"componentType\": %d, \"count\": %d, \"type\": \"VEC3\"", c, FLOAT, s->count);
    put_corner("min", s->low, t);
    put_corner("max", s->high, t);
    thr_text_append(t, "}");
    break;
  default:
    thr_text_printf(t, "{\"buffer\": 0, \"byteOffset\": %zu, \"byteLength\": %zu, \"target\": %d}", offset, 12 * (size_t)s->count,
                    ARRAY_BUFFER);
  }
}

static void put_lists(const thr_plan *p, const thr_copy *copy, const strip *s, thr_text *t)
{
  static const char *const key[N_LISTS] = {"nodes", "meshes", "materials", "accessors", "bufferViews"};
  for (int what = 0; what < N_LISTS; what++) {
    size_t offset = 0;
    thr_text_printf(t, "\"%s\": [\n", key[what]);
    for (int c = 0; c < p->n_cords; c++) {
      put_element(p, copy, (list)what, c, &s[c], offset, t);
      thr_text_append(t, c + 1 < p->n_cords ? ",\n" : "],\n");
      offset += 12 * (size_t)s[c].count;
    }
  }
}

static void put_head(const thr_plan *p, double metres, thr_text *t)
{
  thr_text_append(t, "{\n\"asset\": {\"version\": \"2.0\", \"generator\": \"thread\", \"extras\": {\"unit\": ");
  thr_text_json_string(t, p->frame.units);
  thr_text_append(t, ", \"metres_per_unit\": ");
  thr_text_double(t, metres);
  thr_text_append(t, "}},\n\"scene\": 0,\n\"scenes\": [{\"nodes\": [");
  for (int c = 0; c < p->n_cords; c++)
    thr_text_printf(t, c ? ", %d" : "%d", c);
  thr_text_append(t, "]}],\n");
}

thr_status thr_polylines_gltf(const thr_plan *p, thr_text *out, thr_err *err)
{
  int n;
  double mm;
  thr_text t = {0}, data = {0};
  base64 bytes = {.out = &data};
  thr_status st = check(p, &n, err);
  if (st) return st;
  thr_copy *copy = thr_calloc((size_t)p->n_cords, sizeof *copy);
  strip *s = thr_calloc((size_t)p->n_cords, sizeof *s);
  if (!copy || !s) st = thr_nomem(err);
  if (!st) st = thr_copies_find(p, copy, err);
  double metres = thr_units_in_mm(p->frame.units, &mm, NULL) ? 0.001 : mm / 1000;
  for (int c = 0; c < p->n_cords && !st; c++)
    st = put_strip(p, c, metres, &bytes, &s[c], err);
  if (!st) {
    put_head(p, metres, &t);
    put_lists(p, copy, s, &t);
    thr_text_printf(&t, "\"buffers\": [{\"byteLength\": %zu, \"uri\": \"data:application/octet-stream;base64,",
                    12 * ((size_t)n + (size_t)p->n_cords));
    if (data.data) thr_text_append_bytes(&t, data.data, data.length);
    thr_text_append(&t, "\"}]\n}\n");
    t.failed |= data.failed;
  }
  thr_text_destroy(&data);
  free(copy);
  free(s);
  return take_over(&t, st, out, err);
}
