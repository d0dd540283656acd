/* glTF 2.0, as JSON or in one binary file: lines and triangles of all meshes of the scene, where its nodes place them. Khronos,
 * "glTF 2.0 Specification", 2021. Coordinates are in metres and y points up. Buffers stand in the file, or in files beside it. */
#include "graph/framework/frame.h"
#include "graph/io/faces.h"
#include "graph/io/formats.h"
#include "graph/io/json.h"
#include "graph/io/parts.h"
#include "graph/io/scan.h"
#include "graph/io/sites.h"
#include "graph/os.h"
#include "graph/status.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NESTED = 64 };
enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };
enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN };

/* x' = m[.][0 .. 2] x + m[.][3] */
typedef struct {
  double m[3][4];
} placing;

/* The elements of an accessor in a buffer. */
typedef struct {
  const unsigned char *first; /* NULL: all are 0 */
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
  bool *entered;    /* [nodes] placed already; owned */
  thr_parts parts;  /* nodes that have a mesh, called as they or it */
  int *part;        /* [nodes] -1 = has no mesh; owned */
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

/* A file beside the document's. */
static thr_status read_beside(gltf *g, int i, const char *uri)
{
  char path[1200];
  if (thr_os_is_separator(uri[0]) || strstr(uri, "..") || strchr(uri, ':'))
    return bad(g, "buffers", i, "lies elsewhere; put its file beside this one, or save as .glb");
  const int n = snprintf(path, sizeof path, "%.*s%s", (int)(thr_os_name(g->file) - g->file), g->file, uri);
  if (n < 0 || (size_t)n >= sizeof path) return bad(g, "buffers", i, "the path is too long");
  const thr_status st = thr_text_read(&g->buffer[i], path, NULL);
  if (st == THR_ENOMEM) return thr_nomem(g->err);
  return st ? bad(g, "buffers", i, "its file, which should lie beside this one, cannot be read") : THR_OK;
}

static thr_status read_buffers(gltf *g)
{
  const thr_json *list = thr_json_get(g->doc, "buffers");
  g->n_buffers = thr_json_size(list);
  g->buffer = thr_calloc((size_t)g->n_buffers, sizeof *g->buffer);
  if (!g->buffer) return thr_nomem(g->err);
  thr_status st = THR_OK;
  for (int i = 0; i < g->n_buffers && !st; i++) {
    const char *uri = thr_json_string(thr_json_get(thr_json_at(list, i), "uri")), *data = uri ? strstr(uri, ";base64,") : NULL;
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
  return type == BYTE || type == UBYTE ? 1 : type == SHORT || type == USHORT ? 2 : type == UINT || type == FLOAT ? 4 : 0;
}

/* Checks that n components of every element lie in their view, and the view in its buffer. */
static thr_status find_elements(const gltf *g, int i, size_t n, elements *out)
{
  const thr_json *a = element(g, "accessors", i), *view;
  const unsigned char *bytes;
  size_t size;
  if (!a) return bad(g, "accessors", i, "is not there");
  *out = (elements){.count = member(a, "count", -1),
                    .type = member(a, "componentType", -1),
                    .normalized = thr_json_true(thr_json_get(a, "normalized"))};
  if (thr_json_get(a, "sparse")) return bad(g, "accessors", i, "sparse accessors are not read; export without them");
  if (out->count < 0 || !size_of(out->type)) return bad(g, "accessors", i, "has no count or no component type that is known");
  const int v = member(a, "bufferView", -1);
  if (v < 0) return bad(g, "accessors", i, "has no bufferView: the mesh is compressed; export without compression");
  if (!(view = element(g, "bufferViews", v))) return bad(g, "bufferViews", v, "is not there");
  const int buffer = member(view, "buffer", -1), offset = member(view, "byteOffset", 0), length = member(view, "byteLength", -1),
            at = member(a, "byteOffset", 0), stride = member(view, "byteStride", 0);
  if (buffer < 0 || buffer >= g->n_buffers || offset < 0 || length < 0 || at < 0 || stride < 0)
    return bad(g, "bufferViews", v, "has a number that cannot be");
  bytes_of(g, buffer, &bytes, &size);
  const size_t whole = n * size_of(out->type);
  out->stride = stride ? (size_t)stride : whole;
  out->first = bytes ? bytes + offset + at : NULL;
  if (!bytes || (size_t)offset + (size_t)length > size) return bad(g, "bufferViews", v, "is longer than its buffer");
  if (out->count && (size_t)at + (size_t)(out->count - 1) * out->stride + whole > (size_t)length)
    return bad(g, "accessors", i, "is longer than its bufferView");
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
  case BYTE: return (double)(int8_t)bits / (e->normalized ? 127 : 1);
  case SHORT: return (double)(int16_t)bits / (e->normalized ? 32767 : 1);
  case UBYTE: return (double)bits / (e->normalized ? 255 : 1);
  case USHORT: return (double)bits / (e->normalized ? 65535 : 1);
  default: return (double)bits;
  }
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
      if (!isfinite(out[k])) return thr_fail(g->err, THR_EINPUT, "%s: a coordinate is not a finite number", g->file);
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
    const int run[3] = {mode == TRIANGLE_FAN ? corner[0] : corner[i], corner[i + 1], corner[i + size - 1]};
    st = thr_faces_add(&g->faces, run, size, g->err);
  }
  const int last[2] = {n ? corner[n - 1] : 0, n ? corner[0] : 0};
  if (!st && mode == LINE_LOOP && n > 2) st = thr_faces_add(&g->faces, last, 2, g->err);
  return st;
}

static thr_status read_primitive(gltf *g, int mesh, const thr_json *primitive, const placing *p)
{
  const int mode = member(primitive, "mode", TRIANGLES), indices = member(primitive, "indices", -1), base = g->sites.n;
  const int where = member(thr_json_get(primitive, "attributes"), "POSITION", -1);
  elements position, index = {0};
  if (mode < 0 || mode > TRIANGLE_FAN) return bad(g, "meshes", mesh, "a primitive of a mode that is not known");
  if (mode == POINTS || where < 0) {
    thr_report_skip(g->report, thr_span_of(mode == POINTS ? "points" : "primitive"));
    return THR_OK;
  }
  thr_status st = find_elements(g, where, 3, &position);
  if (!st && thr_json_get(primitive, "indices")) st = find_elements(g, indices, 1, &index);
  if (!st) st = add_sites(g, &position, p);
  if (st) return st;
  const int n = index.first ? index.count : position.count;
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

/* Its matrix (by columns), or scale, then rotation (a quaternion x, y, z, w), then translation. */
static placing placing_of(const thr_json *node)
{
  placing p = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  double m[16], s[3] = {1, 1, 1}, q[4] = {0, 0, 0, 1}, t[3] = {0, 0, 0};
  if (numbers(node, "matrix", 16, m)) {
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++)
        p.m[i][j] = m[4 * j + i];
    return p;
  }
  numbers(node, "scale", 3, s);
  numbers(node, "rotation", 4, q);
  numbers(node, "translation", 3, t);
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      p.m[i][j] = r[i][j] * s[j];
    p.m[i][3] = t[i];
  }
  return p;
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

static thr_status read_node(gltf *g, int i, const placing *outer, int depth)
{
  const thr_json *node = element(g, "nodes", i), *children = thr_json_get(node, "children");
  if (!node) return bad(g, "nodes", i, "is not there");
  if (g->entered[i] || depth > MOST_NESTED) return bad(g, "nodes", i, "stands in more than one place, or too deep");
  g->entered[i] = true;
  const placing own = placing_of(node), here = compose(outer, &own);
  const int m = member(node, "mesh", -1);
  const thr_json *mesh = element(g, "meshes", m), *primitives = thr_json_get(mesh, "primitives");
  thr_status st = thr_json_get(node, "mesh") && !mesh ? bad(g, "meshes", m, "is not there") : THR_OK;
  for (int k = 0; k < thr_json_size(primitives) && !st && thr_parts_has(&g->parts, g->part[i]); k++)
    st = read_primitive(g, m, thr_json_at(primitives, k), &here);
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
    if (!name) name = thr_json_string(thr_json_get(element(g, "meshes", member(node, "mesh", -1)), "name"));
    g->part[i] = -1;
    if (thr_json_get(node, "mesh")) st = thr_parts_add(&g->parts, thr_span_of(name ? name : ""), &g->part[i], g->err);
  }
  return st ? st : thr_parts_choose(&g->parts, g->file, "object", "objects", g->err);
}

/* The scene that is shown, else the first one, else every node that no other one has for a child. */
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

/* Finds the document and the binary chunk of a .glb file: a head of 12 bytes, then chunks of a length, a type and bytes. */
static thr_status open_binary(gltf *g, const char *text, size_t n, thr_span *json)
{
  *json = (thr_span){text, n};
  if (n < 4 || memcmp(text, "glTF", 4) != 0) return THR_OK;
  if (n < 20 || little(text + 4) != 2)
    return thr_fail(g->err, THR_EINPUT, "%s: a glb file of another version than 2, or cut off", g->file);
  json->n = 0;
  for (size_t at = 12; n - at >= 8;) {
    const size_t size = little(text + at);
    if (size > n - at - 8) return thr_fail(g->err, THR_EINPUT, "%s: the file ends in the middle of a chunk", g->file);
    if (memcmp(text + at + 4, "JSON", 4) == 0) *json = (thr_span){text + at + 8, size};
    if (memcmp(text + at + 4, "BIN", 4) == 0) { /* with its NUL */
      g->chunk = (const unsigned char *)text + at + 8;
      g->chunk_size = size;
    }
    at += 8 + size;
  }
  return json->n ? THR_OK : thr_fail(g->err, THR_EINPUT, "%s: a glb file without its JSON chunk", g->file);
}

static thr_status check_document(const gltf *g)
{
  const char *version = thr_json_string(thr_json_get(thr_json_get(g->doc, "asset"), "version"));
  const thr_json *required = thr_json_get(g->doc, "extensionsRequired");
  if (!version || version[0] != '2') return thr_fail(g->err, THR_EINPUT, "%s: not glTF 2", g->file);
  for (int i = 0; i < thr_json_size(required); i++) {
    const char *name = thr_json_string(thr_json_at(required, i));
    if (name && (strstr(name, "compression") || strstr(name, "draco")))
      return thr_fail(g->err, THR_EINPUT, "%s: compressed with %.60s, which is not read; export without compression", g->file,
                      name);
  }
  return THR_OK;
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
  if (!st && g->draft->n_edges == 0) st = thr_fail(g->err, THR_EINPUT, "%s: no lines and no triangles in the scene", g->file);
  return st;
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n, const char *name, thr_err *err)
{
  gltf g = {.file = name, .draft = draft, .report = report, .err = err, .parts = {.asked = draft->pick}};
  thr_span json;
  thr_status st = open_binary(&g, text, n, &json);
  if (!st) st = thr_json_parse(&g.doc, json.s, json.n, name, err);
  if (!st) st = check_document(&g);
  if (!st) st = read_buffers(&g);
  if (!st) st = read_scene(&g);
  if (!st) st = place(&g);
  for (int i = 0; i < g.n_buffers && g.buffer; i++)
    thr_text_destroy(&g.buffer[i]);
  free(g.buffer);
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
  for (const char *c = text; n >= m && (c = memchr(c, word[0], n - m + 1 - (size_t)(c - text))); c++) {
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
  return i < n && text[i] == '{' && holds(text, n, "\"asset\"") && holds(text, n, "\"bufferViews\"");
}

const thr_format thr_gltf_format = {.name = "gltf", .ending = {"gltf", "glb"}, .parse = parse, .is = is};
