/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads glTF 2.0, as JSON or in one binary file (.glb): lines and triangles of all meshes of the
 * scene, where the scene's nodes place them. Source: Khronos, "glTF 2.0 Specification", 2021.
 * Coordinates are in metres and y points up.
 *
 * A scene is a forest of nodes. A node has a place relative to its parent and perhaps a mesh; a
 * mesh is a list of primitives; a primitive has positions and indices, each in an accessor: a table
 * of numbers in a view of a buffer. Buffers are in the document as base64, in the binary chunk, or
 * in files beside the document. All numbers of the file are checked against the sizes of what they
 * refer to before anything is read.
 *
 * Example of a primitive: positions in accessor 0, indices in accessor 1, drawn as lines:
 *     {"attributes": {"POSITION": 0}, "indices": 1, "mode": 1} */
#include "graph/io/read_parts.h"
#include "graph/os.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Limits that keep a small malicious file from taking all memory and time. */
enum { MOST_NESTED = 64, MOST_PLACED = 20000000, MOST_CORNERS = 100000000, MOST_ZEROS = 1000000 };
/* Component types of accessors, and modes of primitives, as the specification numbers them. */
enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };
enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN };

/* An affine map: x' = m[.][0 .. 2] x + m[.][3]. */
typedef struct {
  double m[3][4];
} placing;

/* Scale s, then rotation by the quaternion q = (x, y, z, w), then translation t. */
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

/* The state of one reading: the document, its buffers, and what has been placed. */
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
} gltf_reader;

/* Records THR_EINPUT about element i of one of the document's lists. */
static thr_status bad(const gltf_reader *reader, const char *list, int i, const char *what)
{
  return thr_fail(reader->err, THR_EINPUT, "%s: %s[%d]: %s", reader->file, list, i, what);
}

/* Returns a value as a number from 0 to 2e9, or `otherwise` if the value is none. The bound keeps
 * sums of two such numbers within 32 bits without sign. */
static int int_of(const thr_json *value, int otherwise)
{
  int64_t x;
  return thr_json_int(value, &x) && x >= 0 && x <= 2000000000 ? (int)x : otherwise;
}

/* Returns the member of an object as a number, -1 if the member is no number from 0 to 2e9, and
 * `otherwise` if there is no such member. */
static int member(const thr_json *object, const char *key, int otherwise)
{
  const thr_json *value = thr_json_get(object, key);
  return value ? int_of(value, -1) : otherwise;
}

/* Returns element i of one of the document's lists; NULL if there is none. */
static const thr_json *element(const gltf_reader *reader, const char *list, int i)
{
  return i < 0 ? NULL : thr_json_at(thr_json_get(reader->doc, list), i);
}

/* ---- buffers ---- */

/* Returns the six bits of a letter of base64, also in the alphabet for addresses (- and _); -1 for
 * any other letter. */
static int base64_value(char c)
{
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

/* Appends the bytes that base64 means, up to its end or padding. */
static void decode_base64(const char *c, thr_text *out)
{
  /* Bits wait in the low end until a byte is full. */
  uint32_t bits = 0;
  for (int n = 0, value; (value = base64_value(*c)) >= 0; c++) {
    bits = bits << 6 | (uint32_t)value;
    n += 6;
    if (n < 8) continue;
    n -= 8;
    thr_text_byte(out, (char)(bits >> n & 255));
  }
}

/* Returns the value of a hexadecimal digit, or -1. */
static int hex_value(char c)
{
  static const char digits[] = "0123456789abcdef";
  const char *digit = c ? strchr(digits, tolower((unsigned char)c)) : NULL;
  return digit ? (int)(digit - digits) : -1;
}

/* Decodes the %XX of a uri into name, which must have as many bytes as the uri. If a % is followed
 * by no byte, or by NUL, name becomes the uri itself. */
static void decode_percent(const char *uri, char *name)
{
  char *out = name;

  for (const char *c = uri; *c; c++, out++) {
    *out = *c;
    if (*c != '%') continue;

    /* Two digits; 00 would end the name. */
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

/* Reads a buffer from a file beside the document, called by the decoded uri; if there is none, by
 * the uri itself. */
static thr_status read_beside(gltf_reader *reader, int i, const char *uri)
{
  char name[1000], path[2200];

  /* Only the file's folder, and a name that does not leave the folder, is used: a document must not
   * read files elsewhere. */
  const int folder = (int)(thr_os_name(reader->file) - reader->file);
  if (strlen(uri) >= sizeof name || folder >= 1200)
    return bad(reader, "buffers", i, "the path is too long");

  decode_percent(uri, name);
  if (thr_os_is_separator(name[0]) || strstr(name, "..") || strchr(name, ':'))
    return bad(reader, "buffers", i,
               "lies elsewhere; put its file beside this one, or save as .glb");

  /* First the decoded name, then the uri. */
  thr_status st = THR_EIO;
  for (int k = 0; k < 2 && st && st != THR_ENOMEM; k++) {
    snprintf(path, sizeof path, "%.*s%s", folder, reader->file, k ? uri : name);
    st = thr_text_read(&reader->buffer[i], path, NULL);
  }
  if (st == THR_ENOMEM) return thr_nomem(reader->err);

  if (!st) return THR_OK;
  return thr_fail(
      reader->err, THR_EINPUT,
      "%s: buffers[%d]: its file '%.100s', which should lie beside this one, cannot be read",
      reader->file, i, name);
}

/* Reads all buffers that are not the binary chunk. */
static thr_status read_buffers(gltf_reader *reader)
{
  const thr_json *list = thr_json_get(reader->doc, "buffers");

  reader->n_buffers = thr_json_size(list);
  reader->buffer = thr_calloc((size_t)reader->n_buffers, sizeof *reader->buffer);

  /* Sparse accessors are filled in only when a primitive needs them. */
  reader->dense = thr_calloc((size_t)thr_json_size(thr_json_get(reader->doc, "accessors")),
                             sizeof *reader->dense);
  if (!reader->buffer || !reader->dense) return thr_nomem(reader->err);
  thr_status st = THR_OK;

  for (int i = 0; i < reader->n_buffers && !st; i++) {
    const char *uri = thr_json_string(thr_json_get(thr_json_at(list, i), "uri")),
               *data = uri ? strstr(uri, ";base64,") : NULL;

    /* In a binary file, buffer 0 without a uri is the chunk. */
    if (!uri && i == 0 && reader->chunk) continue;
    if (!uri) return bad(reader, "buffers", i, "has no uri, and there is no binary chunk for it");

    /* A data address without base64 stays empty, and what refers to its bytes is an error later. */
    if (strncmp(uri, "data:", 5) != 0)
      st = read_beside(reader, i, uri);
    else if (data)
      decode_base64(data + 8, &reader->buffer[i]);
    if (!st && reader->buffer[i].failed) st = thr_nomem(reader->err);
  }

  return st;
}

/* Returns the bytes of buffer i, which may be the binary chunk. */
static void bytes_of(const gltf_reader *reader, int i, const unsigned char **bytes, size_t *n)
{
  const bool chunk = i == 0 && reader->chunk && !reader->buffer[0].data;
  *bytes = chunk ? reader->chunk : (const unsigned char *)reader->buffer[i].data;
  *n = chunk ? reader->chunk_size : reader->buffer[i].length;
}

/* ---- accessors ---- */

/* Returns the size in bytes of a component type; 0 if there is no such type. */
static size_t size_of(int type)
{
  return type == BYTE || type == UBYTE     ? 1
         : type == SHORT || type == USHORT ? 2
         : type == UINT || type == FLOAT   ? 4
                                           : 0;
}

/* Finds the elements of accessor i, of size bytes each, in the view and from the byte that `object`
 * names (the accessor itself or a part of a sparse one). Checks that the elements are inside of the
 * view, and the view inside of the buffer. out->count must be set. */
static thr_status find_in_view(const gltf_reader *reader, int i, const thr_json *object,
                               size_t size, elements *out)
{
  const int v = member(object, "bufferView", -1), at = member(object, "byteOffset", 0);
  const thr_json *view = element(reader, "bufferViews", v);
  const unsigned char *bytes;
  size_t n_bytes;

  if (!view) return bad(reader, "bufferViews", v, "is not there");

  /* int_of has limited each number to 2e9, so that sums do not overflow size_t. */
  const int buffer = member(view, "buffer", -1), offset = member(view, "byteOffset", 0),
            length = member(view, "byteLength", -1), stride = member(view, "byteStride", 0);
  if (buffer < 0 || buffer >= reader->n_buffers || offset < 0 || length < 0 || at < 0 || stride < 0)
    return bad(reader, "bufferViews", v, "has a number that cannot be");

  /* Elements follow one another unless the view says a distance. */
  bytes_of(reader, buffer, &bytes, &n_bytes);
  out->stride = stride ? (size_t)stride : size;
  if (!bytes || (size_t)offset + (size_t)length > n_bytes)
    return bad(reader, "bufferViews", v, "is longer than its buffer");

  if (out->count && (size_t)at + (size_t)(out->count - 1) * out->stride + size > (size_t)length)
    return bad(reader, "accessors", i, "is longer than its bufferView");

  out->first = bytes + offset + at;
  return THR_OK;
}

/* Returns component k of element i as a number. Bytes are little-endian. Normalized integers mean 0
 * .. 1, or -1 .. 1 with a sign, as the specification defines them. */
static double component(const elements *list, int i, size_t k)
{
  const unsigned char *bytes = list->first + (size_t)i * list->stride + k * size_of(list->type);
  uint32_t bits = 0;
  float real;

  /* From the last byte, the highest one, to the first. */
  for (size_t j = size_of(list->type); j-- > 0;)
    bits = bits << 8 | bytes[j];

  /* By type; normalized numbers are scaled. */
  switch (list->type) {
  case FLOAT: memcpy(&real, &bits, sizeof real); return (double)real;
  case BYTE: return list->normalized ? fmax((double)(int8_t)bits / 127, -1) : (double)(int8_t)bits;
  case SHORT:
    return list->normalized ? fmax((double)(int16_t)bits / 32767, -1) : (double)(int16_t)bits;
  case UBYTE: return (double)bits / (list->normalized ? 255 : 1);
  case USHORT: return (double)bits / (list->normalized ? 65535 : 1);
  default: return (double)bits;
  }
}

/* Makes the elements of sparse accessor i in g->dense[i]: copies its elements of size bytes each,
 * or zeros if it has no view, and replaces those that it lists by index. */
static thr_status fill_sparse(gltf_reader *reader, int i, const thr_json *sparse, size_t size,
                              elements *all)
{
  const thr_json *places = thr_json_get(sparse, "indices"),
                 *values = thr_json_get(sparse, "values");
  elements index = {.count = member(sparse, "count", -1),
                    .type = member(places, "componentType", -1)},
           value = *all;

  value.count = index.count;

  if (index.count < 0 || !size_of(index.type))
    return bad(reader, "accessors", i, "is sparse without a count or a type of indices");

  /* Without a view, nothing else bounds the number of elements. */
  if (!all->first && all->count > MOST_ZEROS)
    return bad(reader, "accessors", i, "has more than 1000000 elements without a bufferView");

  /* The list: an index and a value for each replaced element. */
  thr_status st = find_in_view(reader, i, places, size_of(index.type), &index);
  if (!st) st = find_in_view(reader, i, values, size, &value);
  if (st) return st;
  unsigned char *bytes = reader->dense[i] = thr_calloc((size_t)all->count, size);
  if (!bytes) return thr_nomem(reader->err);

  /* All elements, then the replaced ones. */
  for (size_t k = 0; all->first && k < (size_t)all->count; k++)
    memcpy(bytes + k * size, all->first + k * all->stride, size);
  for (int k = 0; k < index.count; k++) {
    const double to = component(&index, k, 0);
    if (!(to >= 0 && to < all->count))
      return bad(reader, "accessors", i, "is sparse with an index beyond its elements");
    memcpy(bytes + (size_t)to * size, value.first + (size_t)k * value.stride, size);
  }

  return THR_OK;
}

/* Finds the elements of accessor i, of n components each: 1, 3 or 4. */
static thr_status find_elements(gltf_reader *reader, int i, size_t n, elements *out)
{
  static const char *const wanted[] = {"", "SCALAR", "", "VEC3", "VEC4"};
  const thr_json *accessor = element(reader, "accessors", i),
                 *sparse = thr_json_get(accessor, "sparse");
  const char *type = thr_json_string(thr_json_get(accessor, "type"));

  if (!accessor) return bad(reader, "accessors", i, "is not there");

  /* What the accessor says of its elements. */
  *out = (elements){.count = member(accessor, "count", -1),
                    .type = member(accessor, "componentType", -1),
                    .normalized = thr_json_true(thr_json_get(accessor, "normalized"))};
  const size_t size = n * size_of(out->type);
  if (out->count < 0 || !size)
    return bad(reader, "accessors", i, "has no count or no component type that is known");

  /* A wrong type would make vectors of unrelated numbers. Some writers leave the type out; a sparse
   * accessor needs it. */
  if (type ? strcmp(type, wanted[n]) != 0 : sparse != NULL)
    return thr_fail(reader->err, THR_EINPUT,
                    "%s: accessors[%d]: is of type %.20s; %s is needed here", reader->file, i,
                    type ? type : "none", wanted[n]);

  /* Compressed meshes (Draco, meshopt) have accessors without data. */
  const bool has_view = thr_json_get(accessor, "bufferView") != NULL;
  if (!has_view && !sparse)
    return bad(reader, "accessors", i,
               "has no bufferView: the mesh is compressed; export without compression");

  thr_status st = has_view ? find_in_view(reader, i, accessor, size, out) : THR_OK;

  /* A sparse accessor is filled in once. */
  if (st || !sparse) return st;
  if (!reader->dense[i]) st = fill_sparse(reader, i, sparse, size, out);
  out->first = reader->dense[i];
  out->stride = size;

  return st;
}

/* ---- meshes ---- */

/* Appends the positions as sites, where the map places them. */
static thr_status add_sites(gltf_reader *reader, const elements *position, const placing *place)
{
  thr_status st = THR_OK;

  for (int i = 0; i < position->count && !st; i++) {
    double at[3], out[3];

    /* Transform in double precision, whatever the file's type. */
    for (size_t k = 0; k < 3; k++)
      at[k] = component(position, i, k);

    /* The place is an affine map. */
    for (int k = 0; k < 3; k++) {
      out[k] =
          place->m[k][0] * at[0] + place->m[k][1] * at[1] + place->m[k][2] * at[2] + place->m[k][3];
      if (!isfinite(out[k]))
        return thr_fail(reader->err, THR_EINPUT, "%s: a coordinate is not a finite number",
                        reader->file);
    }
    st = thr_sites_add(&reader->sites, out, reader->err);
  }

  return st;
}

/* Appends the runs of a primitive of n corners, as its mode says: pairs for lines, triples for
 * triangles, each from every corner on (strips and fans) or from every second or third one. */
static thr_status add_runs(gltf_reader *reader, int mode, int n, const int *corner)
{
  thr_status st = THR_OK;

  /* All triangles of a fan share corner 0. */
  const int size = mode <= LINE_STRIP ? 2 : 3, step = mode == LINES ? 2 : mode == TRIANGLES ? 3 : 1;
  for (int i = 0; i + size <= n && !st; i += step) {
    const int run[3] = {mode == TRIANGLE_FAN ? corner[0] : corner[i], corner[i + 1],
                        corner[i + size - 1]};
    st = thr_faces_add(&reader->faces, run, size, reader->err);
  }

  /* A loop ends with the segment from its last corner to its first. */
  const int last[2] = {n ? corner[n - 1] : 0, n ? corner[0] : 0};
  if (!st && mode == LINE_LOOP && n > 2) st = thr_faces_add(&reader->faces, last, 2, reader->err);
  return st;
}

/* Reads a primitive of a mesh, whose node is placed by the map. */
static thr_status read_primitive(gltf_reader *reader, int mesh, const thr_json *primitive,
                                 const placing *place)
{
  const int mode = member(primitive, "mode", TRIANGLES), indices = member(primitive, "indices", -1),
            base = reader->sites.n;
  const int where = member(thr_json_get(primitive, "attributes"), "POSITION", -1);
  elements position = {0}, index = {0};

  if (mode < 0 || mode > TRIANGLE_FAN)
    return bad(reader, "meshes", mesh, "a primitive of a mode that is not known");

  /* Points have no edges; a primitive without positions cannot be placed. */
  if (mode == POINTS || where < 0) {
    thr_report_skip(reader->report, thr_span_of(mode == POINTS ? "points" : "primitive"));
    return THR_OK;
  }

  /* Without indices the corners are the positions in order. */
  thr_status st = find_elements(reader, where, 3, &position);
  if (!st && thr_json_get(primitive, "indices")) st = find_elements(reader, indices, 1, &index);
  const int n = index.first ? index.count : position.count;

  /* The limits hold for all instances together. */
  if (!st && (base + (int64_t)position.count > MOST_PLACED ||
              reader->faces.n_corners + 3 * (int64_t)n > MOST_CORNERS))
    st = thr_fail(reader->err, THR_EINPUT,
                  "%s: more than %d points or %d corners with all nodes and instances",
                  reader->file, MOST_PLACED, MOST_CORNERS);

  if (!st) st = add_sites(reader, &position, place);
  if (st) return st;

  /* Corners become numbers of sites, which this primitive's begin at base. */
  int *corner = thr_calloc((size_t)n, sizeof *corner);
  if (!corner) return thr_nomem(reader->err);
  for (int i = 0; i < n && !st; i++) {
    const double k = index.first ? component(&index, i, 0) : i;
    if (k < position.count && k >= 0)
      corner[i] = base + (int)k;
    else
      st = bad(reader, "meshes", mesh, "an index beyond the vertices");
  }

  if (!st) st = add_runs(reader, mode, n, corner);
  free(corner);
  return st;
}

/* ---- nodes ---- */

/* Reads a list of n numbers; returns false, and leaves out as it is, if the member is no such
 * list. */
static bool numbers(const thr_json *object, const char *key, int n, double *out)
{
  const thr_json *list = thr_json_get(object, key);
  return thr_json_size(list) == n && thr_json_numbers(list, n, out);
}

/* Computes the map of node i from scale, rotation and translation. The quaternion may have any
 * length, because quaternions of bytes are not exactly 1 long: R = I + 2 / |q|^2 (..). */
static thr_status place_by(const gltf_reader *reader, int i, const moves *by, placing *out)
{
  const double x = by->q[0], y = by->q[1], z = by->q[2], w = by->q[3],
               square = x * x + y * y + z * z + w * w, factor = 2 / square;
  const double rotation[3][3] = {
      {1 - factor * (y * y + z * z), factor * (x * y - z * w), factor * (x * z + y * w)},
      {factor * (x * y + z * w), 1 - factor * (x * x + z * z), factor * (y * z - x * w)},
      {factor * (x * z - y * w), factor * (y * z + x * w), 1 - factor * (x * x + y * y)}};

  /* NaN fails this test, too. */
  if (!(square > 1e-12 && square < 1e12))
    return bad(reader, "nodes", i, "has a rotation that is no quaternion");

  /* Columns are scaled before they are rotated. */
  for (int k = 0; k < 3; k++) {
    for (int j = 0; j < 3; j++)
      out->m[k][j] = rotation[k][j] * by->s[j];
    out->m[k][3] = by->t[k];
  }

  return THR_OK;
}

/* Computes the map of node i relative to its parent, from its matrix, which is stored by columns,
 * or from what it says of scale, rotation and translation. */
static thr_status place_node(const gltf_reader *reader, int i, const thr_json *node, placing *out)
{
  double matrix[16];

  if (!numbers(node, "matrix", 16, matrix)) {
    moves by = still;
    numbers(node, "scale", 3, by.s);
    numbers(node, "rotation", 4, by.q);
    numbers(node, "translation", 3, by.t);
    return place_by(reader, i, &by, out);
  }

  /* The fourth row of the matrix is 0 0 0 1. */
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 4; j++)
      out->m[k][j] = matrix[4 * j + k];

  return THR_OK;
}

/* Returns the composition of two maps: first the inner one, then the outer one. */
static placing compose(const placing *outer, const placing *inner)
{
  placing both;

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) {
      /* The inner translation is mapped by the outer map, too. */
      both.m[i][j] = j == 3 ? outer->m[i][3] : 0;
      for (int k = 0; k < 3; k++)
        both.m[i][j] += outer->m[i][k] * inner->m[k][j];
    }

  return both;
}

/* Finds how often node i has its mesh (EXT_mesh_gpu_instancing), and what each instance is moved
 * by: found[0] translation, found[1] rotation, found[2] scale. Those that the extension does not
 * name have no first element. */
static thr_status find_instances(gltf_reader *reader, int i, const thr_json *extension,
                                 elements found[3], int *n)
{
  static const char *const names[] = {"TRANSLATION", "ROTATION", "SCALE"};
  const char *key, *first = NULL;
  const thr_json *value;
  thr_status st = THR_OK;

  /* All attributes must have as many elements as the first one, even those that are not used
   * here. */
  for (void *iter = NULL;
       !st && thr_json_next(thr_json_get(extension, "attributes"), &iter, &key, &value);
       first = first ? first : key) {
    const int accessor = int_of(value, -1),
              count = member(element(reader, "accessors", accessor), "count", -1);
    if (count < 0) return bad(reader, "accessors", accessor, "is not there, or has no count");
    if (first && count != *n)
      return thr_fail(reader->err, THR_EINPUT,
                      "%s: nodes[%d]: EXT_mesh_gpu_instancing has %d instances by %.40s and %d by "
                      "%.40s; export it again",
                      reader->file, i, *n, first, count, key);

    /* Translation, rotation and scale are used, with 3, 4 and 3 components. */
    *n = count;
    for (int k = 0; k < 3 && !st; k++)
      if (strcmp(key, names[k]) == 0)
        st = find_elements(reader, accessor, k == 1 ? 4 : 3, &found[k]);
  }

  return st || first ? st
                     : bad(reader, "nodes", i,
                           "EXT_mesh_gpu_instancing without attributes; export it again");
}

/* Reads the mesh of node i, which is placed by `here`, or all instances of the mesh. */
static thr_status read_mesh(gltf_reader *reader, int i, const thr_json *node, const placing *here)
{
  const int number = member(node, "mesh", -1);
  const thr_json *mesh = element(reader, "meshes", number),
                 *primitives = thr_json_get(mesh, "primitives");
  const thr_json *extension =
      thr_json_get(thr_json_get(node, "extensions"), "EXT_mesh_gpu_instancing");
  elements found[3] = {{0}};

  int n = 1;

  if (!mesh) return bad(reader, "meshes", number, "is not there");

  /* --pick may have chosen other objects. */
  if (!thr_parts_has(&reader->parts, reader->part[i])) return THR_OK;
  thr_status st = extension ? find_instances(reader, i, extension, found, &n) : THR_OK;

  /* Without instances this is one that is not moved. */
  for (int k = 0; k < n && !st; k++) {
    moves by = still;
    placing own = {0}, placed = {0};
    for (size_t j = 0; j < 4; j++) {
      if (found[0].first && j < 3) by.t[j] = component(&found[0], k, j);
      if (found[1].first) by.q[j] = component(&found[1], k, j);
      if (found[2].first && j < 3) by.s[j] = component(&found[2], k, j);
    }

    /* An instance is moved relative to its node. */
    st = place_by(reader, i, &by, &own);
    if (!st) placed = compose(here, &own);
    for (int j = 0; j < thr_json_size(primitives) && !st; j++)
      st = read_primitive(reader, number, thr_json_at(primitives, j), &placed);
  }

  return st;
}

/* Reads node i and its children; outer is the map of its parent. */
static thr_status read_node(gltf_reader *reader, int i, const placing *outer, int depth)
{
  const thr_json *node = element(reader, "nodes", i), *children = thr_json_get(node, "children");
  placing own = {0}, here;

  if (!node) return bad(reader, "nodes", i, "is not there");

  /* In a forest every node is entered once; this also stops cycles. */
  if (reader->entered[i] || depth > MOST_NESTED)
    return bad(reader, "nodes", i, "stands in more than one place, or too deep");

  reader->entered[i] = true;
  thr_status st = place_node(reader, i, node, &own);
  if (st) return st;
  here = compose(outer, &own);

  /* Its mesh, then its children, all placed by the node. */
  if (thr_json_get(node, "mesh")) st = read_mesh(reader, i, node, &here);

  for (int k = 0; k < thr_json_size(children) && !st; k++)
    st = read_node(reader, int_of(thr_json_at(children, k), -1), &here, depth + 1);

  return st;
}

/* Numbers the nodes that have a mesh as the parts that --pick may ask for, by the node's name or
 * else the mesh's. */
static thr_status name_parts(gltf_reader *reader, const thr_json *nodes)
{
  const int n = thr_json_size(nodes);
  thr_status st = THR_OK;

  if (!(reader->part = thr_calloc((size_t)n, sizeof *reader->part))) return thr_nomem(reader->err);

  /* Nodes without a mesh are no parts. */
  for (int i = 0; i < n && !st; i++) {
    const thr_json *node = thr_json_at(nodes, i);
    const char *name = thr_json_string(thr_json_get(node, "name"));
    if (!name)
      name = thr_json_string(
          thr_json_get(element(reader, "meshes", member(node, "mesh", -1)), "name"));
    reader->part[i] = -1;
    if (thr_json_get(node, "mesh"))
      st = thr_parts_add(&reader->parts, thr_span_of(name ? name : ""), &reader->part[i],
                         reader->err);
  }

  return st ? st : thr_parts_choose(&reader->parts, reader->file, "object", "objects", reader->err);
}

/* Reads the scene that is shown, else the first one, else every tree of nodes: those that are no
 * node's child are roots. */
static thr_status read_scene(gltf_reader *reader)
{
  static const placing unmoved = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  const thr_json *nodes = thr_json_get(reader->doc, "nodes");
  const thr_json *roots =
      thr_json_get(element(reader, "scenes", member(reader->doc, "scene", 0)), "nodes");
  const int n = thr_json_size(nodes);

  thr_status st = name_parts(reader, nodes);
  bool *child = thr_calloc((size_t)n, sizeof *child);

  reader->entered = thr_calloc((size_t)n, sizeof *reader->entered);
  if (!st && (!child || !reader->entered)) st = thr_nomem(reader->err);

  /* Without scenes: mark all children. */
  for (int i = 0; i < n && !st && !roots; i++) {
    const thr_json *children = thr_json_get(thr_json_at(nodes, i), "children");
    for (int k = 0; k < thr_json_size(children); k++) {
      const int c = int_of(thr_json_at(children, k), n);
      if (c < n) child[c] = true;
    }
  }

  /* Place the scene's roots, or all roots. */
  for (int i = 0; i < thr_json_size(roots) && !st; i++)
    st = read_node(reader, int_of(thr_json_at(roots, i), -1), &unmoved, 0);
  for (int i = 0; i < n && !st && !roots; i++)
    if (!child[i]) st = read_node(reader, i, &unmoved, 0);

  free(child);
  return st;
}

/* ---- documents ---- */

/* Returns four bytes as a little-endian number. */
static uint32_t little(const char *b)
{
  const unsigned char *u = (const unsigned char *)b;
  return (uint32_t)u[0] | (uint32_t)u[1] << 8 | (uint32_t)u[2] << 16 | (uint32_t)u[3] << 24;
}

/* Finds the document and the binary chunk of a .glb file: a head of 12 bytes, then chunks of a
 * length, a type and bytes. Other text is the document itself. */
static thr_status open_binary(gltf_reader *reader, const char *text, size_t n, thr_span *json)
{
  *json = (thr_span){text, n};

  /* Magic number, version, length. */
  if (n < 4 || memcmp(text, "glTF", 4) != 0) return THR_OK;
  if (n < 20 || little(text + 4) != 2)
    return thr_fail(reader->err, THR_EINPUT, "%s: a glb file of another version than 2, or cut off",
                    reader->file);

  json->n = 0;

  /* Take the chunks in turn; unknown ones are passed over, as the specification demands. */
  for (size_t at = 12; n - at >= 8;) {
    const size_t size = little(text + at);
    if (size > n - at - 8)
      return thr_fail(reader->err, THR_EINPUT, "%s: the file ends in the middle of a chunk",
                      reader->file);
    if (memcmp(text + at + 4, "JSON", 4) == 0) *json = (thr_span){text + at + 8, size};
    if (memcmp(text + at + 4, "BIN", 4) == 0) { /* with its NUL */
      reader->chunk = (const unsigned char *)text + at + 8;
      reader->chunk_size = size;
    }
    at += 8 + size;
  }

  return json->n ? THR_OK
                 : thr_fail(reader->err, THR_EINPUT, "%s: a glb file without its JSON chunk",
                            reader->file);
}

/* Returns whether a file that requires the extension can be read: the two extensions that are
 * implemented, and those that are about looks or notes, told by the beginnings of their names. */
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

/* Checks that the document is glTF of version 2 and requires only extensions that can be read. */
static thr_status check_document(const gltf_reader *reader)
{
  const char *version =
      thr_json_string(thr_json_get(thr_json_get(reader->doc, "asset"), "version"));
  const thr_json *required = thr_json_get(reader->doc, "extensionsRequired");
  thr_text names = {0};
  int n = 0, n_named = 0;

  /* Version 1 is another format. */
  if (!version || version[0] != '2')
    return thr_fail(reader->err, THR_EINPUT,
                    "%s: this is no glTF of version 2; export it as glTF 2.0 or GLB", reader->file);

  if (required && thr_json_typeof(required) != THR_JSON_ARRAY)
    return thr_fail(reader->err, THR_EINPUT, "%s: extensionsRequired: is no list of names",
                    reader->file);

  /* Collect the names of all others, as many as fit in a message. */
  for (int i = 0; i < thr_json_size(required); i++) {
    const char *name = thr_json_string(thr_json_at(required, i));
    if (name && is_read(name)) continue;
    if (names.length < 300 && ++n_named)
      thr_text_printf(&names, "%s%.60s", n ? ", " : "", name ? name : "(no name)");
    n++;
  }

  /* One message names them all. */
  if (n > n_named) thr_text_printf(&names, " and %d more", n - n_named);
  thr_status st = names.failed ? thr_nomem(reader->err) : THR_OK;
  if (n && !st)
    st = thr_fail(reader->err, THR_EINPUT,
                  "%s: requires the extension%s %s, which %s not read; export without %s",
                  reader->file, n == 1 ? "" : "s", names.data, n == 1 ? "is" : "are",
                  n == 1 ? "it" : "them");

  thr_text_destroy(&names);
  return st;
}

/* Fills the draft: sites at one place become one node, triangles their sides. */
static thr_status place(gltf_reader *reader)
{
  int *node = thr_calloc((size_t)reader->sites.n, sizeof *node);

  if (!node) return thr_nomem(reader->err);

  /* A site's node is known only when all sites are. */
  thr_status st = thr_sites_finish(&reader->sites, node, reader->draft, reader->err);
  for (int i = 0; i < reader->faces.n_corners && !st; i++)
    reader->faces.corner[i] = node[reader->faces.corner[i]];

  free(node);
  if (!st) st = thr_faces_finish(&reader->faces, reader->draft, reader->file, reader->err);

  /* Units and the direction upwards are the format's. */
  if (!st) st = thr_draft_set_units(reader->draft, "m", reader->err);
  reader->draft->up_is_y = true;
  if (!st && reader->draft->n_edges == 0)
    st = thr_fail(reader->err, THR_EINPUT, "%s: no lines and no triangles in the scene",
                  reader->file);

  return st;
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  gltf_reader reader = {
      .file = name, .draft = draft, .report = report, .err = err, .parts = {.asked = draft->pick}};
  thr_span json;
  thr_status st = open_binary(&reader, text, n, &json);

  /* The document first: everything else refers to it. */
  if (!st) st = thr_json_parse(&reader.doc, json.s, json.n, name, err);
  if (!st) st = check_document(&reader);
  if (!st) st = read_buffers(&reader);
  if (!st) st = read_scene(&reader);
  if (!st) st = place(&reader);

  /* Arrays may be missing after a failure. */
  for (int i = 0; i < reader.n_buffers && reader.buffer; i++)
    thr_text_destroy(&reader.buffer[i]);
  for (int i = 0; i < thr_json_size(thr_json_get(reader.doc, "accessors")) && reader.dense; i++)
    free(reader.dense[i]);

  free(reader.buffer);
  free(reader.dense);
  free(reader.entered);
  free(reader.part);
  thr_parts_finish(&reader.parts, report);
  thr_sites_destroy(&reader.sites);
  thr_faces_destroy(&reader.faces);
  thr_json_destroy(reader.doc);

  return st;
}

/* Returns whether a text of n bytes holds a word. */
static bool holds(const char *text, size_t n, const char *word)
{
  const size_t length = strlen(word);

  /* Look for the first letter, as long as the word fits in what is left. */
  for (const char *c = text;
       n >= length && (c = memchr(c, word[0], n - length + 1 - (size_t)(c - text))); c++) {
    if (memcmp(c, word, length) == 0) return true;
    if ((size_t)(c + 1 - text) > n - length) break;
  }

  return false;
}

/* Returns whether a text is a binary file, or JSON with the two members that every glTF file with a
 * mesh has. */
static bool is(const char *text, size_t n)
{
  if (n >= 4 && memcmp(text, "glTF", 4) == 0) return true;

  /* No first line tells glTF from other JSON. */
  size_t start = 0;
  while (start < n &&
         (text[start] == ' ' || text[start] == '\n' || text[start] == '\r' || text[start] == '\t'))
    start++;

  return start < n && text[start] == '{' && holds(text, n, "\"asset\"") &&
         holds(text, n, "\"bufferViews\"");
}

const thr_format thr_gltf_format = {
    .name = "gltf", .ending = {"gltf", "glb"}, .parse = parse, .is = is};
