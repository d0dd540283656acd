/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cords as lines: OBJ read back by the reader of frameworks and record by record, glTF decoded
 * byte by byte. */
#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "graph/io/json.h"
#include "graph/io/read.h"
#include "tests/plans.h"
#include "tests/sample_plans.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef thr_status writer(const thr_plan *p, const thr_line_options *options, thr_text *out,
                          thr_err *err);
static const thr_line_options plain, lanes = {.lanes = true}, upright = {.up_y = true};
static writer *const writers[] = {thr_polylines_obj, thr_polylines_gltf, thr_polylines_dxf,
                                  thr_polylines_compas};
enum { N_WRITERS = 4 };

static thr_text text_of(const thr_plan *p, writer *write)
{
  thr_text t = {0}, again = {0};
  thr_err err = {0};
  assert_ok(write(p, &plain, &t, &err), &err);
  ck_assert_int_eq(write(p, &plain, &again, &err), THR_OK);
  assert_same_text(&t, &again);
  thr_text_destroy(&again);
  return t;
}

/* ---- OBJ ---- */

START_TEST(obj_is_read_back)
{
  thr_plan p = plan_number(_i);
  thr_text t = text_of(&p, thr_polylines_obj);
  thr_draft d = {0};
  thr_read_report report = {0};
  thr_frame f = {0};
  thr_err err = {0};
  assert_ok(thr_draft_parse(&d, &report, t.data, t.length, "cords.obj", NULL, &err), &err);
  ck_assert_int_eq(thr_draft_build(&d, 0, &f, &report, &err), THR_OK);
  ck_assert_int_eq(report.edges_read, p.metrics.passes);
  ck_assert_int_eq(f.n_nodes, p.frame.n_nodes);
  ck_assert_int_eq(f.n_edges, p.frame.n_edges);
  ck_assert_str_eq(f.units, p.frame.units);
  ck_assert_mem_eq(f.xyz, p.frame.xyz, (size_t)f.n_nodes * sizeof *f.xyz);
  ck_assert_mem_eq(f.foot, p.frame.foot, (size_t)f.n_nodes * sizeof *f.foot);
  for (int e = 0; e < f.n_edges; e++)
    ck_assert_int_ge(thr_frame_edge_between(&p.frame, f.edge[e][0], f.edge[e][1]), 0);
  thr_draft_destroy(&d);
  thr_frame_destroy(&f);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* Does the vertex stand at the node? */
static bool stands_at(const thr_plan *p, double (*vertex)[3], int i, int node)
{
  return memcmp(vertex[i - 1], p->frame.xyz[node], sizeof *vertex) == 0;
}

/* One object per cord with one line through a vertex per pass, in order, no step of it twice. */
START_TEST(obj_has_the_passes_in_order)
{
  thr_plan p = plan_number(_i);
  thr_text t = text_of(&p, thr_polylines_obj);
  const int most = p.frame.n_nodes + p.metrics.passes;
  int c = -1, k = 0, a, b, used, n = 0,
      (*line_of)[2] = calloc((size_t)p.metrics.passes, sizeof *line_of);
  double(*vertex)[3] = calloc((size_t)most, sizeof *vertex);
  for (const char *line = t.data; *line; line = strchr(line, '\n') + 1) {
    char name[16];
    if (sscanf(line, "o cord-%15s", name) == 1) {
      if (c >= 0) ck_assert_int_eq(k, p.cord[c].n_passes);
      ck_assert_str_eq(name, p.cord[++c].id);
      k = 0;
    } else if (*line == 'v') {
      ck_assert_int_lt(n, most);
      ck_assert_int_eq(sscanf(line, "v %lf %lf %lf", &vertex[n][0], &vertex[n][1], &vertex[n][2]),
                       3);
      n++;
    } else if (*line == 'l') {
      ck_assert_int_eq(k, 0); /* the only one of its cord */
      ck_assert_int_eq(sscanf(line, "l %d%n", &a, &used), 1);
      for (const char *next = line + used; *next != '\n'; next += used, a = b, k++) {
        ck_assert_int_eq(sscanf(next, " %d%n", &b, &used), 1);
        ck_assert_int_lt(k, p.cord[c].n_passes);
        ck_assert(a >= 1 && a <= n && b >= 1 && b <= n);
        ck_assert(stands_at(&p, vertex, a, thr_tail(&p.frame, p.cord[c].half[k])));
        ck_assert(stands_at(&p, vertex, b, thr_head(&p.frame, p.cord[c].half[k])));
        for (int i = 0; i < k; i++)
          ck_assert((line_of[i][0] != a || line_of[i][1] != b) &&
                    (line_of[i][0] != b || line_of[i][1] != a));
        line_of[k][0] = a;
        line_of[k][1] = b;
      }
    } else
      ck_assert_int_eq(*line, '#');
  }
  free(vertex);
  free(line_of);
  ck_assert_int_eq(c, p.n_cords - 1);
  ck_assert_int_eq(k, p.cord[c].n_passes);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- glTF ---- */

static const thr_json *member(const thr_json *doc, const char *list, int i, const char *key)
{
  const thr_json *v = thr_json_get(thr_json_at(thr_json_get(doc, list), i), key);
  ck_assert_msg(v != NULL, "%s[%d].%s", list, i, key);
  return v;
}

static int integer(const thr_json *v)
{
  int64_t i;
  ck_assert(thr_json_int(v, &i));
  return (int)i;
}

static double number(const thr_json *v)
{
  double x;
  ck_assert(thr_json_number(v, &x));
  return x;
}

/* RFC 4648, one letter at a time. */
static unsigned char *decode(const char *s, size_t *n)
{
  static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  unsigned char *bytes = malloc(strlen(s) + 1);
  unsigned bits = 0;
  int held = 0;
  ck_assert(bytes && strlen(s) % 4 == 0);
  *n = 0;
  for (; *s && *s != '='; s++) {
    const char *at = strchr(letters, *s);
    ck_assert_ptr_nonnull(at);
    bits = bits << 6 | (unsigned)(at - letters);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes[(*n)++] = (unsigned char)(bits >> held & 255);
  }
  return bytes;
}

static double float_at(const unsigned char *b)
{
  uint32_t bits =
      (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
  float value;
  memcpy(&value, &bits, sizeof value);
  return (double)value;
}

static int node_of(const thr_plan *p, int c, int k)
{
  return k < p->cord[c].n_passes ? thr_tail(&p->frame, p->cord[c].half[k])
                                 : thr_head(&p->frame, p->cord[c].half[k - 1]);
}

/* The strip of cord c, wherever the document says that it lies; marks its bytes. */
static void assert_strip(const thr_json *doc, const thr_plan *p, int c, double metres,
                         const unsigned char *data, bool *taken)
{
  const thr_json *primitive =
      thr_json_at(member(doc, "meshes", integer(member(doc, "nodes", c, "mesh")), "primitives"), 0);
  int accessor = integer(thr_json_get(thr_json_get(primitive, "attributes"), "POSITION"));
  int view = integer(member(doc, "accessors", accessor, "bufferView")),
      count = integer(member(doc, "accessors", accessor, "count"));
  int offset = integer(member(doc, "bufferViews", view, "byteOffset"));
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  ck_assert_int_eq(integer(thr_json_get(primitive, "mode")), 3);
  ck_assert_int_eq(count, p->cord[c].n_passes + 1);
  ck_assert_str_eq(thr_json_string(member(doc, "accessors", accessor, "type")), "VEC3");
  ck_assert_int_eq(integer(member(doc, "accessors", accessor, "componentType")), 5126);
  ck_assert_int_eq(integer(member(doc, "bufferViews", view, "byteLength")), 12 * count);
  ck_assert_int_eq(offset % 4, 0);
  for (int i = 0; i < 12 * count; i++) {
    ck_assert(!taken[offset + i]);
    taken[offset + i] = true;
  }
  for (int k = 0; k < count; k++) {
    const double *node = p->frame.xyz[node_of(p, c, k)];
    const double want[3] = {node[0], node[2], -node[1]};
    for (int i = 0; i < 3; i++) {
      double got = float_at(data + offset + 12 * k + 4 * i);
      ck_assert_double_eq_tol(got, metres * want[i], fabs(metres * want[i]) * 1e-7 + 1e-12);
      low[i] = fmin(low[i], got);
      high[i] = fmax(high[i], got);
    }
  }
  for (int i = 0; i < 3; i++) {
    ck_assert_double_eq(
        low[i], (double)(float)number(thr_json_at(member(doc, "accessors", accessor, "min"), i)));
    ck_assert_double_eq(
        high[i], (double)(float)number(thr_json_at(member(doc, "accessors", accessor, "max"), i)));
  }
}

/* Linear light back to "#rrggbb". */
static void assert_colour(const thr_json *doc, int c, const char *hex)
{
  const thr_json *primitive = thr_json_at(member(doc, "meshes", c, "primitives"), 0);
  int material = integer(thr_json_get(primitive, "material"));
  const thr_json *factor =
      thr_json_get(member(doc, "materials", material, "pbrMetallicRoughness"), "baseColorFactor");
  char text[8] = "#";
  for (int i = 0; i < 3; i++) {
    double light = number(thr_json_at(factor, i));
    double value = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
    snprintf(text + 1 + 2 * i, 3, "%02X", (unsigned)lround(255 * value) & 255);
  }
  ck_assert_str_eq(text, hex);
}

START_TEST(gltf_runs_through_the_nodes)
{
  static const char prefix[] = "data:application/octet-stream;base64,";
  thr_plan p = plan_number(_i);
  bool metre = _i % 2;
  snprintf(p.frame.units, sizeof p.frame.units, metre ? "m" : "mm");
  thr_text t = text_of(&p, thr_polylines_gltf);
  thr_json *doc;
  size_t n;
  ck_assert_int_eq(thr_json_parse(&doc, t.data, t.length, "gltf", NULL), THR_OK);
  ck_assert_str_eq(thr_json_string(thr_json_get(thr_json_get(doc, "asset"), "version")), "2.0");
  const char *uri = thr_json_string(member(doc, "buffers", 0, "uri"));
  ck_assert_int_eq(strncmp(uri, prefix, strlen(prefix)), 0);
  unsigned char *data = decode(uri + strlen(prefix), &n);
  bool *taken = calloc(n, sizeof *taken);
  ck_assert_ptr_nonnull(taken);
  ck_assert_int_eq(integer(member(doc, "buffers", 0, "byteLength")), (int)n);
  ck_assert_int_eq(thr_json_size(member(doc, "scenes", 0, "nodes")), p.n_cords);
  for (int c = 0; c < p.n_cords; c++) {
    char name[32];
    snprintf(name, sizeof name, "cord-%s", p.cord[c].id);
    ck_assert_int_eq(integer(thr_json_at(member(doc, "scenes", 0, "nodes"), c)), c);
    ck_assert_str_eq(thr_json_string(member(doc, "nodes", c, "name")), name);
    assert_strip(doc, &p, c, metre ? 1 : 0.001, data, taken);
  }
  for (size_t i = 0; i < n; i++)
    ck_assert(taken[i]);
  free(taken);
  free(data);
  thr_json_destroy(doc);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* Of a symmetric plan a path is strong and its copies are pale, in the path's hue; of others every
 * cord has its own. */
START_TEST(colours_are_the_palettes)
{
  thr_plan p = plan_number(_i ? 7 : 13);
  thr_text t = text_of(&p, thr_polylines_gltf);
  thr_json *doc;
  ck_assert_int_eq(p.symmetry.present, _i);
  ck_assert_int_eq(thr_json_parse(&doc, t.data, t.length, "gltf", NULL), THR_OK);
  for (int c = 0; c < p.n_cords; c++)
    if (_i)
      assert_colour(doc, c, p.symmetry.unique[c] == c ? thr_palette(0).hex : thr_palette(0).pale);
    else
      assert_colour(doc, c, thr_palette(c).hex);
  ck_assert_int_eq(p.symmetry.unique_paths, _i); /* one path: one hue */
  thr_json_destroy(doc);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* Units are the user's words. */
START_TEST(units_break_no_line)
{
  thr_plan p = plan_number(0);
  snprintf(p.frame.units, sizeof p.frame.units, "\"\nv 1 2 3");
  thr_text obj = text_of(&p, thr_polylines_obj), gltf = text_of(&p, thr_polylines_gltf);
  thr_json *doc;
  ck_assert_ptr_null(strstr(obj.data, "\nv 1 2 3"));
  ck_assert_int_eq(thr_json_parse(&doc, gltf.data, gltf.length, "gltf", NULL), THR_OK);
  const thr_json *extras = thr_json_get(thr_json_get(doc, "asset"), "extras");
  ck_assert_str_eq(thr_json_string(thr_json_get(extras, "unit")), p.frame.units);
  ck_assert_double_eq(number(thr_json_get(extras, "metres_per_unit")), 0.001);
  thr_json_destroy(doc);
  thr_text_destroy(&obj);
  thr_text_destroy(&gltf);
  thr_plan_destroy(&p);
}
END_TEST

/* ---- DXF and COMPAS, pair by pair and member by member ---- */

/* The next group code and value of a drawing. */
static bool next_pair(const char **at, int *code, char value[64])
{
  int n = 0;
  if (sscanf(*at, " %d %63[^\n]%n", code, value, &n) != 2) return false;
  *at += n;
  return true;
}

/* A text beside every node, on a layer of their own. */
START_TEST(dxf_names_the_places)
{
  thr_plan p = plan_number(0);
  thr_guide guide;
  thr_text t = {0};
  assert_ok(thr_guide_make(&guide, &p.frame, NULL, NULL), NULL);
  const thr_line_options options = {.label = (const char(*)[THR_LABEL])guide.label};
  assert_ok(thr_polylines_dxf(&p, &options, &t, NULL), NULL);
  const char *at = t.data;
  int code, v = 0;
  bool text = false;
  char value[64];
  while (next_pair(&at, &code, value)) {
    if (code == 0) text = strcmp(value, "TEXT") == 0;
    if (text && code == 8) ck_assert_str_eq(value, "places");
    if (text && code == 10) ck_assert(strtod(value, NULL) == p.frame.xyz[v][0]);
    if (text && code == 1) ck_assert_str_eq(value, guide.label[v++]);
  }
  ck_assert_int_eq(v, p.frame.n_nodes);
  thr_text_destroy(&t);
  thr_guide_destroy(&guide);
  thr_plan_destroy(&p);
}
END_TEST

/* Each cord on a layer that the table has, its vertices the nodes in the order of the passes. */
START_TEST(dxf_runs_through_the_nodes)
{
  thr_plan p = plan_number(_i);
  thr_text t = text_of(&p, thr_polylines_dxf);
  const char *at = t.data;
  int code, cord = -1, k = -1, n_layers = 0, axis = 0;
  bool vertex = false;
  char value[64], layer[64] = "";
  while (next_pair(&at, &code, value)) {
    n_layers += code == 0 && strcmp(value, "LAYER") == 0;
    if (code == 0 && strcmp(value, "POLYLINE") == 0) {
      if (cord >= 0) ck_assert_int_eq(k, p.cord[cord].n_passes);
      cord++;
      k = -1;
    }
    if (code == 0) vertex = strcmp(value, "VERTEX") == 0;
    if (code == 0 && vertex) k++;
    if (code == 8) snprintf(layer, sizeof layer, "cord-%s", p.cord[cord].id);
    if (code == 8) ck_assert_str_eq(value, layer);
    if (vertex && (code == 10 || code == 20 || code == 30)) {
      const int v = k ? thr_head(&p.frame, p.cord[cord].half[k - 1])
                      : thr_cord_start(&p.frame, &p.cord[cord]);
      axis = code / 10 - 1;
      ck_assert(strtod(value, NULL) == p.frame.xyz[v][axis]);
    }
  }
  ck_assert_str_eq(value, "EOF");
  ck_assert_int_eq(cord + 1, p.n_cords);
  ck_assert_int_eq(n_layers, p.n_cords);
  ck_assert_int_eq(k, p.cord[cord].n_passes);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(compas_runs_through_the_nodes)
{
  thr_plan p = plan_number(_i);
  thr_text t = text_of(&p, thr_polylines_compas);
  thr_json *doc;
  ck_assert_int_eq(thr_json_parse(&doc, t.data, t.length, "compas", NULL), THR_OK);
  ck_assert_str_eq(thr_json_string(thr_json_get(doc, "units")), p.frame.units);
  ck_assert_int_eq(thr_json_size(thr_json_get(doc, "cords")), p.n_cords);
  for (int c = 0; c < p.n_cords; c++) {
    const thr_json *cord = thr_json_at(thr_json_get(doc, "cords"), c),
                   *points = thr_json_get(thr_json_get(cord, "data"), "points");
    ck_assert_str_eq(thr_json_string(thr_json_get(cord, "dtype")), "compas.geometry/Polyline");
    ck_assert_int_eq(thr_json_size(points), p.cord[c].n_passes + 1);
    for (int k = 0; k <= p.cord[c].n_passes; k++) {
      double xyz[3];
      const int v =
          k ? thr_head(&p.frame, p.cord[c].half[k - 1]) : thr_cord_start(&p.frame, &p.cord[c]);
      ck_assert(thr_json_numbers(thr_json_at(points, k), 3, xyz));
      ck_assert(memcmp(xyz, p.frame.xyz[v], sizeof xyz) == 0);
    }
  }
  thr_json_destroy(doc);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

/* A pass that is alone on its edge runs from node to node; of others the straight part in its lane
 * is 70 % of the edge, no two of them coincide, and those of an edge are parallel. */
START_TEST(lanes_do_not_coincide)
{
  thr_plan p = plan_number(_i);
  thr_cord_lines l;
  int n = 0;
  double(*part)[2][3] = calloc((size_t)p.metrics.passes, sizeof *part);
  ck_assert_int_eq(thr_cord_lines_begin(&l, &p, &lanes, NULL), THR_OK);
  for (int c = 0; c < p.n_cords; c++) {
    thr_cord_lines_next(&l, c);
    int at = 0;
    for (int k = 0; k < p.cord[c].n_passes; k++) {
      const int h = p.cord[c].half[k];
      const double *a = p.frame.xyz[thr_tail(&p.frame, h)], *b = p.frame.xyz[thr_head(&p.frame, h)];
      if (l.passes[h >> 1] == 1) {
        at += k > 0 && l.passes[p.cord[c].half[k - 1] >> 1] > 1;
        ck_assert_mem_eq(l.point[at++], a, sizeof l.point[0]);
        ck_assert_mem_eq(l.point[at], b, sizeof l.point[0]);
        continue;
      }
      memcpy(part[n], l.point[at + 1], sizeof part[n]);
      at += 2;
      for (int i = 0; i < 3; i++) /* along the pass, in its sense */
        ck_assert_double_eq_tol(part[n][1][i] - part[n][0][i], 0.7 * (b[i] - a[i]),
                                1e-9 * (1 + fabs(b[i] - a[i])));
      for (int j = 0; j < n; j++)
        for (int end = 0; end < 2; end++) {
          double apart = 0;
          for (int i = 0; i < 3; i++)
            apart += (part[n][0][i] - part[j][end][i]) * (part[n][0][i] - part[j][end][i]);
          ck_assert(apart > 1e-12 * l.spacing * l.spacing);
        }
      n++;
    }
  }
  thr_cord_lines_end(&l);
  free(part);
  thr_plan_destroy(&p);
}
END_TEST

/* Written with y up and read again, the framework stands as it did. */
START_TEST(up_is_said)
{
  thr_plan p = plan_number(_i);
  thr_text t = {0};
  thr_frame f;
  thr_read_report r = {0};
  thr_read_options o = thr_read_options_default();
  o.weld = 0;
  ck_assert_int_eq(thr_polylines_obj(&p, &upright, &t, NULL), THR_OK);
  ck_assert_int_eq(thr_frame_parse(&f, &r, t.data, t.length, "cords.obj", &o, NULL), THR_OK);
  ck_assert_mem_eq(f.xyz, p.frame.xyz, (size_t)f.n_nodes * sizeof *f.xyz);
  thr_frame_destroy(&f);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(broken_plans_are_refused)
{
  for (int w = 0; w < N_WRITERS; w++) {
    thr_plan p = plan_number(0);
    thr_text t = {0};
    thr_err err = {0};
    int half = p.cord[0].half[2], n = p.n_cords;
    p.cord[0].half[2] = 1000;
    assert_status(writers[w](&p, &plain, &t, &err), THR_EINPUT, &err, "edge 500");
    p.cord[0].half[2] = half;
    p.n_cords = 0;
    assert_status(writers[w](&p, &plain, &t, &err), THR_EINPUT, &err, "no cord");
    p.n_cords = n;
    for (int v = 0; v < p.frame.n_nodes; v++)
      p.frame.xyz[v][2] += 1e50;
    const bool gltf = writers[w] == thr_polylines_gltf;
    ck_assert_int_eq(writers[w](&p, &plain, &t, &err), gltf ? THR_EINPUT : THR_OK);
    if (gltf) assert_one_line(&err, "too far");
    ck_assert(!gltf || t.length == 0);
    thr_text_destroy(&t);
    thr_plan_destroy(&p);
  }
}
END_TEST

typedef struct {
  thr_plan plan;
  writer *write;
} wanted;

static thr_status write_wanted(const void *user, thr_text *t, thr_err *err)
{
  const wanted *w = user;
  return w->write(&w->plan, &lanes, t, err);
}

START_TEST(every_allocation_may_fail)
{
  wanted w = {plan_number(7), writers[_i]};
  assert_allocations_may_fail(write_wanted, &w, 1000);
  thr_plan_destroy(&w.plan);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("polylines");
  ADD_LOOP(s, 30, obj_is_read_back, 0, N_PLANS);
  ADD_LOOP(s, 30, obj_has_the_passes_in_order, 0, N_PLANS);
  ADD_LOOP(s, 30, gltf_runs_through_the_nodes, 0, N_PLANS);
  ADD_LOOP(s, 30, dxf_runs_through_the_nodes, 0, N_PLANS);
  ADD_TEST(s, 30, dxf_names_the_places);
  ADD_LOOP(s, 30, compas_runs_through_the_nodes, 0, N_PLANS);
  ADD_LOOP(s, 30, lanes_do_not_coincide, 0, N_PLANS);
  ADD_LOOP(s, 30, up_is_said, 0, N_PLANS);
  ADD_LOOP(s, 20, colours_are_the_palettes, 0, 2);
  ADD_TEST(s, 20, units_break_no_line);
  ADD_TEST(s, 20, broken_plans_are_refused);
  ADD_LOOP(s, 20, every_allocation_may_fail, 0, N_WRITERS);
  return run_suite(s);
}
