/* SPDX-License-Identifier: GPL-3.0-or-later */
/* glTF 2.0, as JSON or in one binary file: lines and triangles of all meshes of the scene, where
 * its nodes place them. Khronos, "glTF 2.0 Specification", 2021. Coordinates are in metres and y
 * points up. Buffers stand in the file, or in files beside it. */
#include "graph/io/read_parts.h"
#include "graph/os.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NESTED = 64, MOST_PLACED = 20000000, MOST_CORNERS = 100000000, MOST_ZEROS = 1000000 };
enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };
enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN };

/* x' = m[.][0 .. 2] x + m[.][3] */
typedef struct {
  double m[3][4];
} placing;

/* Scale, then rotation (a quaternion x, y, z, w), then translation. */
typedef struct {
  double t[3], q[4], s[3];
} moves;

static const moves still = {{0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1}};

/* The elements of an accessor in a buffer. */
typedef struct {
  const unsigned char *first; /* NULL: none were found */
  size_t stride;
  int count, type;
  bool normalized;
} elements;

typedef struct {
  const char *file;
  thr_json *doc;
  const unsigned char *chunk; /* of a binary file */
  size_t chunk_size;
  int n_buffers;
  thr_text *buffer; /* [n_buffers] bytes of those that are decoded or read; owned */
  unsigned char *
      *dense;      /* [accessors] elements of those that are sparse, once they were needed; owned */
  bool *entered;   /* [nodes] placed already; owned */
  thr_parts parts; /* nodes that have a mesh, called as they or it */
  int *part;       /* [nodes] -1 = has no mesh; owned */
  thr_sites sites;
  thr_faces faces;
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
} gltf;

static thr_status bad(const gltf *g, const char *list, int i, const char *what)
{
  return thr_fail(g->err, THR_EINPUT, "%s: %s[%d]: %s", g->file, list, i, what);
}

static int int_of(const thr_json *v, int otherwise)
{
  int64_t x;
  return thr_json_int(v, &x) && x >= 0 && x <= 2000000000 ? (int)x : otherwise;
}

static int member(const thr_json *object, const char *key, int otherwise)
{
  const thr_json *v = thr_json_get(object, key);
  return v ? int_of(v, -1) : otherwise;
}

static const thr_json *element(const gltf *g, const char *list, int i)
{
  return i < 0 ? NULL : thr_json_at(thr_json_get(g->doc, list), i);
}

/* ---- buffers ---- */

static int base64_value(char c)
{
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

static void decode_base64(const char *c, thr_text *out)
{
  uint32_t bits = 0;
  for (int n = 0, value; (value = base64_value(*c)) >= 0; c++) {
    bits = bits << 6 | (uint32_t)value;
    n += 6;
    if (n < 8) continue;
    n -= 8;
    thr_text_byte(out, (char)(bits >> n & 255));
  }
}

static int hex_value(char c)
{
  static const char digits[] = "0123456789abcdef";
  const char *digit = c ? strchr(digits, tolower((unsigned char)c)) : NULL;
  return digit ? (int)(digit - digits) : -1;
}

/* Decodes the %XX of a uri into name, which has room for all of it. Where a % stands for no byte,
 * or for NUL, name is the uri. */
static void decode_percent(const char *uri, char *name)
{
  char *out = name;
  for (const char *c = uri; *c; c++, out++) {
    *out = *c;
    if (*c != '%') continue;
    const int high = hex_value(c[1]), low = high < 0 ? -1 : hex_value(c[2]);
    if (low < 0 || high + low == 0) {
      memcpy(name, uri, strlen(uri) + 1);
      return;
    }
    *out = (char)(16 * high + low);
    c += 2;
  }
  *out = '\0';
}

/* Reads a file beside the document's, called by the decoded uri; if there is none, by the uri as it
 * stands. */
static thr_status read_beside(gltf *g, int i, const char *uri)
{
  char name[1000], path[2200];
  const int folder = (int)(thr_os_name(g->file) - g->file);
  if (strlen(uri) >= sizeof name || folder >= 1200)
    return bad(g, "buffers", i, "the path is too long");
  decode_percent(uri, name);
  if (thr_os_is_separator(name[0]) || strstr(name, "..") || strchr(name, ':'))
    return bad(g, "buffers", i, "lies elsewhere; put its file beside this one, or save as .glb");
  thr_status st = THR_EIO;
  for (int k = 0; k < 2 && st && st != THR_ENOMEM; k++) {
    snprintf(path, sizeof path, "%.*s%s", folder, g->file, k ? uri : name);
    st = thr_text_read(&g->buffer[i], path, NULL);
  }
  if (st == THR_ENOMEM) return thr_nomem(g->err);
  if (!st) return THR_OK;
  return thr_fail(
      g->err, THR_EINPUT,
      "%s: buffers[%d]: its file '%.100s', which should lie beside this one, cannot be read",
      g->file, i, name);
}

static thr_status read_buffers(gltf *g)
{
  const thr_json *list = thr_json_get(g->doc, "buffers");
  g->n_buffers = thr_json_size(list);
  g->buffer = thr_calloc((size_t)g->n_buffers, sizeof *g->buffer);
  g->dense = thr_calloc((size_t)thr_json_size(thr_json_get(g->doc, "accessors")), sizeof *g->dense);
  if (!g->buffer || !g->dense) return thr_nomem(g->err);
  thr_status st = THR_OK;
  for (int i = 0; i < g->n_buffers && !st; i++) {
    const char *uri = thr_json_string(thr_json_get(thr_json_at(list, i), "uri")),
               *data = uri ? strstr(uri, ";base64,") : NULL;
    if (!uri && i == 0 && g->chunk) continue;
    if (!uri) return bad(g, "buffers", i, "has no uri, and there is no binary chunk for it");
    if (strncmp(uri, "data:", 5) != 0)
      st = read_beside(g, i, uri);
    else if (data)
      decode_base64(data + 8, &g->buffer[i]);
    if (!st && g->buffer[i].failed) st = thr_nomem(g->err);
  }
  return st;
}

static void bytes_of(const gltf *g, int i, const unsigned char **bytes, size_t *n)
{
  const bool chunk = i == 0 && g->chunk && !g->buffer[0].data;
  *bytes = chunk ? g->chunk : (const unsigned char *)g->buffer[i].data;
  *n = chunk ? g->chunk_size : g->buffer[i].length;
}

/* ---- accessors ---- */

static size_t size_of(int type)
{
  return type == BYTE || type == UBYTE     ? 1
         : type == SHORT || type == USHORT ? 2
         : type == UINT || type == FLOAT   ? 4
                                           : 0;
}

/* Finds the elements of accessor i, of size bytes each, in the view and from the byte that an
 * object names, itself or a part of it. Checks that they lie in their view, and the view in its
 * buffer. */
static thr_status find_in_view(const gltf *g, int i, const thr_json *object, size_t size,
                               elements *out)
{
  const int v = member(object, "bufferView", -1), at = member(object, "byteOffset", 0);
  const thr_json *view = element(g, "bufferViews", v);
  const unsigned char *bytes;
  size_t n_bytes;
  if (!view) return bad(g, "bufferViews", v, "is not there");
  const int buffer = member(view, "buffer", -1), offset = member(view, "byteOffset", 0),
            length = member(view, "byteLength", -1), stride = member(view, "byteStride", 0);
  if (buffer < 0 || buffer >= g->n_buffers || offset < 0 || length < 0 || at < 0 || stride < 0)
    return bad(g, "bufferViews", v, "has a number that cannot be");
  bytes_of(g, buffer, &bytes, &n_bytes);
  out->stride = stride ? (size_t)stride : size;
  if (!bytes || (size_t)offset + (size_t)length > n_bytes)
    return bad(g, "bufferViews", v, "is longer than its buffer");
  if (out->count && (size_t)at + (size_t)(out->count - 1) * out->stride + size > (size_t)length)
    return bad(g, "accessors", i, "is longer than its bufferView");
  out->first = bytes + offset + at;
  return THR_OK;
}

/* Component k of element i; bytes come with the least one first. */
static double component(const elements *e, int i, size_t k)
{
  const unsigned char *b = e->first + (size_t)i * e->stride + k * size_of(e->type);
  uint32_t bits = 0;
  float f;
  for (size_t j = size_of(e->type); j-- > 0;)
    bits = bits << 8 | b[j];
  switch (e->type) {
  case FLOAT: memcpy(&f, &bits, sizeof f); return (double)f;
  case BYTE: return e->normalized ? fmax((double)(int8_t)bits / 127, -1) : (double)(int8_t)bits;
  case SHORT:
    return e->normalized ? fmax((double)(int16_t)bits / 32767, -1) : (double)(int16_t)bits;
  case UBYTE: return (double)bits / (e->normalized ? 255 : 1);
  case USHORT: return (double)bits / (e->normalized ? 65535 : 1);
  default: return (double)bits;
  }
}

/* Copies the elements of a sparse accessor, of size bytes each or without a view zeros, and
 * replaces those that it lists. */
static thr_status fill_sparse(gltf *g, int i, const thr_json *sparse, size_t size, elements *all)
{
  const thr_json *places = thr_json_get(sparse, "indices"),
                 *values = thr_json_get(sparse, "values");
  elements index = {.count = member(sparse, "count", -1),
                    .type = member(places, "componentType", -1)},
           value = *all;
  value.count = index.count;
  if (index.count < 0 || !size_of(index.type))
    return bad(g, "accessors", i, "is sparse without a count or a type of indices");
  if (!all->first && all->count > MOST_ZEROS)
    return bad(g, "accessors", i, "has more than 1000000 elements without a bufferView");
  thr_status st = find_in_view(g, i, places, size_of(index.type), &index);
  if (!st) st = find_in_view(g, i, values, size, &value);
  if (st) return st;
  unsigned char *bytes = g->dense[i] = thr_calloc((size_t)all->count, size);
  if (!bytes) return thr_nomem(g->err);
  for (size_t k = 0; all->first && k < (size_t)all->count; k++)
    memcpy(bytes + k * size, all->first + k * all->stride, size);
  for (int k = 0; k < index.count; k++) {
    const double to = component(&index, k, 0);
    if (!(to >= 0 && to < all->count))
      return bad(g, "accessors", i, "is sparse with an index beyond its elements");
    memcpy(bytes + (size_t)to * size, value.first + (size_t)k * value.stride, size);
  }
  return THR_OK;
}

/* Finds the elements of an accessor, of n components each: 1, 3 or 4. */
static thr_status find_elements(gltf *g, int i, size_t n, elements *out)
{
  static const char *const wanted[] = {"", "SCALAR", "", "VEC3", "VEC4"};
  const thr_json *a = element(g, "accessors", i), *sparse = thr_json_get(a, "sparse");
  const char *type = thr_json_string(thr_json_get(a, "type"));
  if (!a) return bad(g, "accessors", i, "is not there");
  *out = (elements){.count = member(a, "count", -1),
                    .type = member(a, "componentType", -1),
                    .normalized = thr_json_true(thr_json_get(a, "normalized"))};
  const size_t size = n * size_of(out->type);
  if (out->count < 0 || !size)
    return bad(g, "accessors", i, "has no count or no component type that is known");
  if (type ? strcmp(type, wanted[n]) != 0 : sparse != NULL)
    return thr_fail(g->err, THR_EINPUT, "%s: accessors[%d]: is of type %.20s; %s is needed here",
                    g->file, i, type ? type : "none", wanted[n]);
  const bool has_view = thr_json_get(a, "bufferView") != NULL;
  if (!has_view && !sparse)
    return bad(g, "accessors", i,
               "has no bufferView: the mesh is compressed; export without compression");
  thr_status st = has_view ? find_in_view(g, i, a, size, out) : THR_OK;
  if (st || !sparse) return st;
  if (!g->dense[i]) st = fill_sparse(g, i, sparse, size, out);
  out->first = g->dense[i];
  out->stride = size;
  return st;
}

/* ---- meshes ---- */

static thr_status add_sites(gltf *g, const elements *position, const placing *p)
{
  thr_status st = THR_OK;
  for (int i = 0; i < position->count && !st; i++) {
    double at[3], out[3];
    for (size_t k = 0; k < 3; k++)
      at[k] = component(position, i, k);
    for (int k = 0; k < 3; k++) {
      out[k] = p->m[k][0] * at[0] + p->m[k][1] * at[1] + p->m[k][2] * at[2] + p->m[k][3];
      if (!isfinite(out[k]))
        return thr_fail(g->err, THR_EINPUT, "%s: a coordinate is not a finite number", g->file);
    }
    st = thr_sites_add(&g->sites, out, g->err);
  }
  return st;
}

/* The runs of a primitive of n corners, as its mode says. */
static thr_status add_runs(gltf *g, int mode, int n, const int *corner)
{
  thr_status st = THR_OK;
  const int size = mode <= LINE_STRIP ? 2 : 3, step = mode == LINES ? 2 : mode == TRIANGLES ? 3 : 1;
  for (int i = 0; i + size <= n && !st; i += step) {
    const int run[3] = {mode == TRIANGLE_FAN ? corner[0] : corner[i], corner[i + 1],
                        corner[i + size - 1]};
    st = thr_faces_add(&g->faces, run, size, g->err);
  }
  const int last[2] = {n ? corner[n - 1] : 0, n ? corner[0] : 0};
  if (!st && mode == LINE_LOOP && n > 2) st = thr_faces_add(&g->faces, last, 2, g->err);
  return st;
}

static thr_status read_primitive(gltf *g, int mesh, const thr_json *primitive, const placing *p)
{
  const int mode = member(primitive, "mode", TRIANGLES), indices = member(primitive, "indices", -1),
            base = g->sites.n;
  const int where = member(thr_json_get(primitive, "attributes"), "POSITION", -1);
  elements position = {0}, index = {0};
  if (mode < 0 || mode > TRIANGLE_FAN)
    return bad(g, "meshes", mesh, "a primitive of a mode that is not known");
  if (mode == POINTS || where < 0) {
    thr_report_skip(g->report, thr_span_of(mode == POINTS ? "points" : "primitive"));
    return THR_OK;
  }
  thr_status st = find_elements(g, where, 3, &position);
  if (!st && thr_json_get(primitive, "indices")) st = find_elements(g, indices, 1, &index);
  const int n = index.first ? index.count : position.count;
  if (!st && (base + (int64_t)position.count > MOST_PLACED ||
              g->faces.n_corners + 3 * (int64_t)n > MOST_CORNERS))
    st = thr_fail(g->err, THR_EINPUT,
                  "%s: more than %d points or %d corners with all nodes and instances", g->file,
                  MOST_PLACED, MOST_CORNERS);
  if (!st) st = add_sites(g, &position, p);
  if (st) return st;
  int *corner = thr_calloc((size_t)n, sizeof *corner);
  if (!corner) return thr_nomem(g->err);
  for (int i = 0; i < n && !st; i++) {
    const double k = index.first ? component(&index, i, 0) : i;
    if (k < position.count && k >= 0)
      corner[i] = base + (int)k;
    else
      st = bad(g, "meshes", mesh, "an index beyond the vertices");
  }
  if (!st) st = add_runs(g, mode, n, corner);
  free(corner);
  return st;
}

/* ---- nodes ---- */

/* Leaves out as it is where there are no such numbers. */
static bool numbers(const thr_json *object, const char *key, int n, double *out)
{
  const thr_json *list = thr_json_get(object, key);
  return thr_json_size(list) == n && thr_json_numbers(list, n, out);
}

/* Of node i, whose quaternion may have any length: quaternions of bytes are not exactly 1 long. */
static thr_status place_by(const gltf *g, int i, const moves *by, placing *out)
{
  const double x = by->q[0], y = by->q[1], z = by->q[2], w = by->q[3],
               square = x * x + y * y + z * z + w * w, c = 2 / square;
  const double r[3][3] = {{1 - c * (y * y + z * z), c * (x * y - z * w), c * (x * z + y * w)},
                          {c * (x * y + z * w), 1 - c * (x * x + z * z), c * (y * z - x * w)},
                          {c * (x * z - y * w), c * (y * z + x * w), 1 - c * (x * x + y * y)}};
  if (!(square > 1e-12 && square < 1e12))
    return bad(g, "nodes", i, "has a rotation that is no quaternion");
  for (int k = 0; k < 3; k++) {
    for (int j = 0; j < 3; j++)
      out->m[k][j] = r[k][j] * by->s[j];
    out->m[k][3] = by->t[k];
  }
  return THR_OK;
}

/* By its matrix, which stands in columns, or what it says of scale, rotation and translation. */
static thr_status place_node(const gltf *g, int i, const thr_json *node, placing *out)
{
  double m[16];
  if (!numbers(node, "matrix", 16, m)) {
    moves by = still;
    numbers(node, "scale", 3, by.s);
    numbers(node, "rotation", 4, by.q);
    numbers(node, "translation", 3, by.t);
    return place_by(g, i, &by, out);
  }
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 4; j++)
      out->m[k][j] = m[4 * j + k];
  return THR_OK;
}

static placing compose(const placing *a, const placing *b)
{
  placing c;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) {
      c.m[i][j] = j == 3 ? a->m[i][3] : 0;
      for (int k = 0; k < 3; k++)
        c.m[i][j] += a->m[i][k] * b->m[k][j];
    }
  return c;
}

/* Finds how often node i has its mesh, and what each instance is moved by: translation, rotation,
 * scale. Those that the extension does not name have no first element. */
static thr_status find_instances(gltf *g, int i, const thr_json *extension, elements found[3],
                                 int *n)
{
  static const char *const names[] = {"TRANSLATION", "ROTATION", "SCALE"};
  const char *key, *first = NULL;
  const thr_json *value;
  thr_status st = THR_OK;
  for (void *iter = NULL;
       !st && thr_json_next(thr_json_get(extension, "attributes"), &iter, &key, &value);
       first = first ? first : key) {
    const int a = int_of(value, -1), count = member(element(g, "accessors", a), "count", -1);
    if (count < 0) return bad(g, "accessors", a, "is not there, or has no count");
    if (first && count != *n)
      return thr_fail(g->err, THR_EINPUT,
                      "%s: nodes[%d]: EXT_mesh_gpu_instancing has %d instances by %.40s and %d by "
                      "%.40s; export it again",
                      g->file, i, *n, first, count, key);
    *n = count;
    for (int k = 0; k < 3 && !st; k++)
      if (strcmp(key, names[k]) == 0) st = find_elements(g, a, k == 1 ? 4 : 3, &found[k]);
  }
  return st || first
             ? st
             : bad(g, "nodes", i, "EXT_mesh_gpu_instancing without attributes; export it again");
}

/* Reads the mesh of node i, which stands here, or all its instances. */
static thr_status read_mesh(gltf *g, int i, const thr_json *node, const placing *here)
{
  const int m = member(node, "mesh", -1);
  const thr_json *mesh = element(g, "meshes", m), *primitives = thr_json_get(mesh, "primitives");
  const thr_json *extension =
      thr_json_get(thr_json_get(node, "extensions"), "EXT_mesh_gpu_instancing");
  elements found[3] = {{0}};
  int n = 1;
  if (!mesh) return bad(g, "meshes", m, "is not there");
  if (!thr_parts_has(&g->parts, g->part[i])) return THR_OK;
  thr_status st = extension ? find_instances(g, i, extension, found, &n) : THR_OK;
  for (int k = 0; k < n && !st; k++) {
    moves by = still;
    placing own = {0}, p = {0};
    for (size_t j = 0; j < 4; j++) {
      if (found[0].first && j < 3) by.t[j] = component(&found[0], k, j);
      if (found[1].first) by.q[j] = component(&found[1], k, j);
      if (found[2].first && j < 3) by.s[j] = component(&found[2], k, j);
    }
    st = place_by(g, i, &by, &own);
    if (!st) p = compose(here, &own);
    for (int j = 0; j < thr_json_size(primitives) && !st; j++)
      st = read_primitive(g, m, thr_json_at(primitives, j), &p);
  }
  return st;
}

static thr_status read_node(gltf *g, int i, const placing *outer, int depth)
{
  const thr_json *node = element(g, "nodes", i), *children = thr_json_get(node, "children");
  placing own = {0}, here;
  if (!node) return bad(g, "nodes", i, "is not there");
  if (g->entered[i] || depth > MOST_NESTED)
    return bad(g, "nodes", i, "stands in more than one place, or too deep");
  g->entered[i] = true;
  thr_status st = place_node(g, i, node, &own);
  if (st) return st;
  here = compose(outer, &own);
  if (thr_json_get(node, "mesh")) st = read_mesh(g, i, node, &here);
  for (int k = 0; k < thr_json_size(children) && !st; k++)
    st = read_node(g, int_of(thr_json_at(children, k), -1), &here, depth + 1);
  return st;
}

/* The parts that may be asked for. */
static thr_status name_parts(gltf *g, const thr_json *nodes)
{
  const int n = thr_json_size(nodes);
  thr_status st = THR_OK;
  if (!(g->part = thr_calloc((size_t)n, sizeof *g->part))) return thr_nomem(g->err);
  for (int i = 0; i < n && !st; i++) {
    const thr_json *node = thr_json_at(nodes, i);
    const char *name = thr_json_string(thr_json_get(node, "name"));
    if (!name)
      name = thr_json_string(thr_json_get(element(g, "meshes", member(node, "mesh", -1)), "name"));
    g->part[i] = -1;
    if (thr_json_get(node, "mesh"))
      st = thr_parts_add(&g->parts, thr_span_of(name ? name : ""), &g->part[i], g->err);
  }
  return st ? st : thr_parts_choose(&g->parts, g->file, "object", "objects", g->err);
}

/* The scene that is shown, else the first one, else every node that no other one has for a child.
 */
static thr_status read_scene(gltf *g)
{
  static const placing unmoved = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  const thr_json *nodes = thr_json_get(g->doc, "nodes");
  const thr_json *roots = thr_json_get(element(g, "scenes", member(g->doc, "scene", 0)), "nodes");
  const int n = thr_json_size(nodes);
  thr_status st = name_parts(g, nodes);
  bool *child = thr_calloc((size_t)n, sizeof *child);
  g->entered = thr_calloc((size_t)n, sizeof *g->entered);
  if (!st && (!child || !g->entered)) st = thr_nomem(g->err);
  for (int i = 0; i < n && !st && !roots; i++) {
    const thr_json *children = thr_json_get(thr_json_at(nodes, i), "children");
    for (int k = 0; k < thr_json_size(children); k++) {
      const int c = int_of(thr_json_at(children, k), n);
      if (c < n) child[c] = true;
    }
  }
  for (int i = 0; i < thr_json_size(roots) && !st; i++)
    st = read_node(g, int_of(thr_json_at(roots, i), -1), &unmoved, 0);
  for (int i = 0; i < n && !st && !roots; i++)
    if (!child[i]) st = read_node(g, i, &unmoved, 0);
  free(child);
  return st;
}

/* ---- documents ---- */

static uint32_t little(const char *b)
{
  const unsigned char *u = (const unsigned char *)b;
  return (uint32_t)u[0] | (uint32_t)u[1] << 8 | (uint32_t)u[2] << 16 | (uint32_t)u[3] << 24;
}

/* Finds the document and the binary chunk of a .glb file: a head of 12 bytes, then chunks of a
 * length, a type and bytes. */
static thr_status open_binary(gltf *g, const char *text, size_t n, thr_span *json)
{
  *json = (thr_span){text, n};
  if (n < 4 || memcmp(text, "glTF", 4) != 0) return THR_OK;
  if (n < 20 || little(text + 4) != 2)
    return thr_fail(g->err, THR_EINPUT, "%s: a glb file of another version than 2, or cut off",
                    g->file);
  json->n = 0;
  for (size_t at = 12; n - at >= 8;) {
    const size_t size = little(text + at);
    if (size > n - at - 8)
      return thr_fail(g->err, THR_EINPUT, "%s: the file ends in the middle of a chunk", g->file);
    if (memcmp(text + at + 4, "JSON", 4) == 0) *json = (thr_span){text + at + 8, size};
    if (memcmp(text + at + 4, "BIN", 4) == 0) { /* with its NUL */
      g->chunk = (const unsigned char *)text + at + 8;
      g->chunk_size = size;
    }
    at += 8 + size;
  }
  return json->n ? THR_OK
                 : thr_fail(g->err, THR_EINPUT, "%s: a glb file without its JSON chunk", g->file);
}

/* Can what requires an extension be read? Besides the two that are implemented: those that are
 * about looks or notes, by the beginnings of their names. */
static bool is_read(const char *extension)
{
  static const char *const looks[] = {"KHR_materials_",  "KHR_texture_", "KHR_lights_",
                                      "KHR_xmp_json_ld", "EXT_texture_", "EXT_lights_",
                                      "MSFT_texture_"};
  for (size_t i = 0; i < sizeof looks / sizeof *looks; i++)
    if (strncmp(extension, looks[i], strlen(looks[i])) == 0) return true;
  return strcmp(extension, "EXT_mesh_gpu_instancing") == 0 ||
         strcmp(extension, "KHR_mesh_quantization") == 0;
}

static thr_status check_document(const gltf *g)
{
  const char *version = thr_json_string(thr_json_get(thr_json_get(g->doc, "asset"), "version"));
  const thr_json *required = thr_json_get(g->doc, "extensionsRequired");
  thr_text names = {0};
  int n = 0, n_named = 0;
  if (!version || version[0] != '2')
    return thr_fail(g->err, THR_EINPUT,
                    "%s: this is no glTF of version 2; export it as glTF 2.0 or GLB", g->file);
  if (required && thr_json_typeof(required) != THR_JSON_ARRAY)
    return thr_fail(g->err, THR_EINPUT, "%s: extensionsRequired: is no list of names", g->file);
  for (int i = 0; i < thr_json_size(required); i++) {
    const char *name = thr_json_string(thr_json_at(required, i));
    if (name && is_read(name)) continue;
    if (names.length < 300 && ++n_named)
      thr_text_printf(&names, "%s%.60s", n ? ", " : "", name ? name : "(no name)");
    n++;
  }
  if (n > n_named) thr_text_printf(&names, " and %d more", n - n_named);
  thr_status st = names.failed ? thr_nomem(g->err) : THR_OK;
  if (n && !st)
    st = thr_fail(g->err, THR_EINPUT,
                  "%s: requires the extension%s %s, which %s not read; export without %s", g->file,
                  n == 1 ? "" : "s", names.data, n == 1 ? "is" : "are", n == 1 ? "it" : "them");
  thr_text_destroy(&names);
  return st;
}

static thr_status place(gltf *g)
{
  int *node = thr_calloc((size_t)g->sites.n, sizeof *node);
  if (!node) return thr_nomem(g->err);
  thr_status st = thr_sites_finish(&g->sites, node, g->draft, g->err);
  for (int i = 0; i < g->faces.n_corners && !st; i++)
    g->faces.corner[i] = node[g->faces.corner[i]];
  free(node);
  if (!st) st = thr_faces_finish(&g->faces, g->draft, g->file, g->err);
  if (!st) st = thr_draft_set_units(g->draft, "m", g->err);
  g->draft->up_is_y = true;
  if (!st && g->draft->n_edges == 0)
    st = thr_fail(g->err, THR_EINPUT, "%s: no lines and no triangles in the scene", g->file);
  return st;
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  gltf g = {
      .file = name, .draft = draft, .report = report, .err = err, .parts = {.asked = draft->pick}};
  thr_span json;
  thr_status st = open_binary(&g, text, n, &json);
  if (!st) st = thr_json_parse(&g.doc, json.s, json.n, name, err);
  if (!st) st = check_document(&g);
  if (!st) st = read_buffers(&g);
  if (!st) st = read_scene(&g);
  if (!st) st = place(&g);
  for (int i = 0; i < g.n_buffers && g.buffer; i++)
    thr_text_destroy(&g.buffer[i]);
  for (int i = 0; i < thr_json_size(thr_json_get(g.doc, "accessors")) && g.dense; i++)
    free(g.dense[i]);
  free(g.buffer);
  free(g.dense);
  free(g.entered);
  free(g.part);
  thr_parts_finish(&g.parts, report);
  thr_sites_destroy(&g.sites);
  thr_faces_destroy(&g.faces);
  thr_json_destroy(g.doc);
  return st;
}

static bool holds(const char *text, size_t n, const char *word)
{
  const size_t m = strlen(word);
  for (const char *c = text; n >= m && (c = memchr(c, word[0], n - m + 1 - (size_t)(c - text)));
       c++) {
    if (memcmp(c, word, m) == 0) return true;
    if ((size_t)(c + 1 - text) > n - m) break;
  }
  return false;
}

/* A binary file, or JSON with the two members that every glTF file with a mesh has. */
static bool is(const char *text, size_t n)
{
  if (n >= 4 && memcmp(text, "glTF", 4) == 0) return true;
  size_t i = 0;
  while (i < n && (text[i] == ' ' || text[i] == '\n' || text[i] == '\r' || text[i] == '\t'))
    i++;
  return i < n && text[i] == '{' && holds(text, n, "\"asset\"") &&
         holds(text, n, "\"bufferViews\"");
}

const thr_format thr_gltf_format = {
    .name = "gltf", .ending = {"gltf", "glb"}, .parse = parse, .is = is};
