/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/frameworks.h"
#include "graph/number.h"
#include "graph/io/read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

thr_frame frame_make(int n, const double (*xyz)[3], int m, const int (*edge)[2],
                     const double *length, const int *feet)
{
  thr_draft d = {0};
  thr_frame f;
  thr_read_report report;
  thr_err err = {0};
  for (int v = 0; v < n; v++)
    ck_assert_int_eq(thr_draft_add_node(&d, xyz[v], NULL, false, NULL), THR_OK);
  for (int e = 0; e < m; e++)
    ck_assert_int_eq(thr_draft_add_edge(&d, edge[e][0], edge[e][1], length ? length[e] : 0, NULL),
                     THR_OK);
  for (int i = 0; feet && feet[i] >= 0; i++)
    d.node[feet[i]].foot = true;
  assert_ok(thr_draft_build(&d, 0, &f, &report, &err), &err);
  ck_assert_int_eq(f.n_nodes, n);
  ck_assert_int_eq(f.n_edges, m);
  thr_draft_destroy(&d);
  return f;
}

thr_frame frame_load(const char *path, const char *edges_path)
{
  thr_frame f;
  thr_read_report report;
  thr_err err = {0};
  thr_read_options o = thr_read_options_default();
  o.edges_path = edges_path;
  assert_ok(thr_frame_read(&f, &report, path, &o, NULL, 0, &err), &err);
  return f;
}

/* Joins the points that are nearest to each other and scales their distance to 1. */
static thr_frame nearest_frame(int n, double (*xyz)[3])
{
  int edge[64][2], m = 0;
  double near = INFINITY;
  for (int pass = 0; pass < 2; pass++)
    for (int a = 0; a < n; a++)
      for (int b = a + 1; b < n; b++) {
        double d =
            hypot(hypot(xyz[a][0] - xyz[b][0], xyz[a][1] - xyz[b][1]), xyz[a][2] - xyz[b][2]);
        if (pass == 0)
          near = fmin(near, d);
        else if (d < 1.001 * near)
          edge[m][0] = a, edge[m++][1] = b;
      }
  for (int v = 0; v < n; v++)
    for (int i = 0; i < 3; i++)
      xyz[v][i] /= near;
  return frame_make(n, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, NULL);
}

thr_frame solid_make(solid s)
{
  const double g = (1 + sqrt(5)) / 2;
  double xyz[20][3];
  int n = 0;
  if (s == TETRAHEDRON || s == CUBE || s == DODECAHEDRON)
    for (int i = 0; i < 8; i++) {
      double x = i & 1 ? 1 : -1, y = i & 2 ? 1 : -1, z = i & 4 ? 1 : -1;
      if (s == TETRAHEDRON && x * y * z < 0) continue;
      xyz[n][0] = x, xyz[n][1] = y, xyz[n++][2] = z;
    }
  if (s == OCTAHEDRON)
    for (int i = 0; i < 6; i++, n++)
      for (int k = 0; k < 3; k++)
        xyz[n][k] = k == i / 2 ? (i % 2 ? 1 : -1) : 0;
  if (s == DODECAHEDRON || s == ICOSAHEDRON)
    for (int i = 0; i < 12; i++, n++) {
      double a = i & 1 ? 1 : -1, b = i & 2 ? g : -g;
      if (s == DODECAHEDRON) a /= g;
      xyz[n][i / 4] = 0, xyz[n][(i / 4 + 1) % 3] = a, xyz[n][(i / 4 + 2) % 3] = b;
    }
  return nearest_frame(n, xyz);
}

/* Arrays of a generated framework, freed by finish. */
typedef struct {
  int n, m;
  double (*xyz)[3];
  int (*edge)[2];
  int *feet, n_feet;
} sketch;

static sketch sketch_make(int max_nodes, int max_edges)
{
  sketch s = {0};
  s.xyz = calloc((size_t)max_nodes, sizeof *s.xyz);
  s.edge = calloc((size_t)max_edges, sizeof *s.edge);
  s.feet = calloc((size_t)max_nodes + 1, sizeof *s.feet);
  ck_assert(s.xyz && s.edge && s.feet);
  return s;
}

static int put_node(sketch *s, double x, double y, double z)
{
  s->xyz[s->n][0] = x, s->xyz[s->n][1] = y, s->xyz[s->n][2] = z;
  return s->n++;
}

static void put_edge(sketch *s, int a, int b)
{
  s->edge[s->m][0] = a;
  s->edge[s->m++][1] = b;
}

static void put_foot(sketch *s, int v)
{
  s->feet[s->n_feet++] = v;
}

static thr_frame sketch_finish(sketch *s, const double *length)
{
  s->feet[s->n_feet] = -1;
  thr_frame f =
      frame_make(s->n, (const double(*)[3])s->xyz, s->m, (const int(*)[2])s->edge, length, s->feet);
  free(s->xyz);
  free(s->edge);
  free(s->feet);
  return f;
}

thr_frame path_make(int n)
{
  sketch s = sketch_make(n, n);
  for (int v = 0; v < n; v++)
    put_node(&s, v, 0, 0);
  for (int v = 1; v < n; v++)
    put_edge(&s, v - 1, v);
  put_foot(&s, 0);
  return sketch_finish(&s, NULL);
}

static void put_rim(sketch *s, int n, double radius)
{
  for (int v = 0; v < n; v++)
    put_node(s, radius * cos(2 * THR_PI * v / n), radius * sin(2 * THR_PI * v / n), 0);
}

thr_frame chain_make(int n, const double *length)
{
  double xyz[9][3] = {{0}};
  int edge[8][2];
  ck_assert_int_le(n, 8);
  for (int e = 0; e < n; e++) {
    xyz[e + 1][0] = xyz[e][0] + length[e];
    edge[e][0] = e, edge[e][1] = e + 1;
  }
  return frame_make(n + 1, (const double(*)[3])xyz, n, (const int(*)[2])edge, NULL, NULL);
}

thr_frame ring_make(int n)
{
  sketch s = sketch_make(n, n);
  put_rim(&s, n, 0.5 / sin(THR_PI / n));
  for (int v = 0; v < n; v++)
    put_edge(&s, v, (v + 1) % n);
  put_foot(&s, 0);
  return sketch_finish(&s, NULL);
}

static thr_frame spokes(int n, bool rim)
{
  sketch s = sketch_make(n + 1, 2 * n);
  put_node(&s, 0, 0, 0);
  put_rim(&s, n, 1);
  for (int v = 1; v <= n; v++)
    put_edge(&s, 0, v);
  for (int v = 1; v <= n && rim; v++)
    put_edge(&s, v, v % n + 1);
  put_foot(&s, 1);
  return sketch_finish(&s, NULL);
}

thr_frame star_make(int n)
{
  return spokes(n, false);
}

thr_frame wheel_make(int n)
{
  return spokes(n, true);
}

thr_frame grid_make(int w, int h)
{
  sketch s = sketch_make(w * h, 2 * w * h);
  for (int y = 0; y < h; y++)
    for (int x = 0; x < w; x++) {
      int v = put_node(&s, x, y, 0);
      if (x > 0) put_edge(&s, v - 1, v);
      if (y > 0) put_edge(&s, v - w, v);
      if ((x == 0 || x == w - 1) && (y == 0 || y == h - 1)) put_foot(&s, v);
    }
  return sketch_finish(&s, NULL);
}

thr_frame triangles_make(int n)
{
  sketch s = sketch_make(3 * n, 3 * n);
  for (int i = 0; i < n; i++) {
    int a = put_node(&s, 2 * i, 0, 0), b = put_node(&s, 2 * i + 1, 0, 0),
        c = put_node(&s, 2 * i + 0.5, sqrt(0.75), 0);
    put_edge(&s, a, b);
    put_edge(&s, b, c);
    put_edge(&s, c, a);
    put_foot(&s, b);
  }
  return sketch_finish(&s, NULL);
}

thr_frame side_by_side(const thr_frame *a, const thr_frame *b)
{
  const thr_frame *part[] = {a, b};
  sketch s = sketch_make(a->n_nodes + b->n_nodes, a->n_edges + b->n_edges);
  for (int k = 0; k < 2; k++) {
    int first = s.n;
    for (int v = 0; v < part[k]->n_nodes; v++) {
      const double *x = part[k]->xyz[v];
      put_node(&s, x[0] + 1000 * k, x[1] + 1000 * k, x[2] + 1000 * k);
      if (part[k]->foot[v]) put_foot(&s, first + v);
    }
    for (int e = 0; e < part[k]->n_edges; e++)
      put_edge(&s, first + part[k]->edge[e][0], first + part[k]->edge[e][1]);
  }
  return sketch_finish(&s, NULL);
}

static bool joined(const sketch *s, int a, int b)
{
  for (int e = 0; e < s->m; e++)
    if ((s->edge[e][0] == a && s->edge[e][1] == b) || (s->edge[e][0] == b && s->edge[e][1] == a))
      return true;
  return false;
}

/* Nodes of odd degree into list; how many. */
static int odd_nodes(const sketch *s, int *list)
{
  int count = 0;
  for (int v = 0; v < s->n; v++) {
    int degree = 0;
    for (int e = 0; e < s->m; e++)
      degree += (s->edge[e][0] == v) + (s->edge[e][1] == v);
    if (degree % 2) list[count++] = v;
  }
  return count;
}

static void join_odd_nodes(rng *r, sketch *s, int most_odd)
{
  int *list = calloc((size_t)s->n, sizeof *list), k;
  ck_assert(list != NULL);
  for (int tries = 0; tries < 4 * s->n && (k = odd_nodes(s, list)) > most_odd; tries++) {
    int a = list[rng_below(r, k)], b = list[rng_below(r, k)];
    if (a != b && !joined(s, a, b)) put_edge(s, a, b);
  }
  free(list);
}

thr_frame random_frame(rng *r, int n, int extra, length_kind kind)
{
  return random_frame_few_odd(r, n, extra, kind, n);
}

thr_frame random_frame_few_odd(rng *r, int n, int extra, length_kind kind, int most_odd)
{
  int room = 2 * n + extra; /* joining takes at most n / 2 */
  sketch s = sketch_make(n, room);
  double *length = calloc((size_t)room, sizeof *length);
  ck_assert(length);
  for (int v = 0; v < n; v++)
    put_node(&s, 100 * rng_unit(r), 100 * rng_unit(r), 100 * rng_unit(r));
  for (int v = 1; v < n; v++)
    put_edge(&s, rng_below(r, v), v);
  for (int i = 0; i < extra; i++) {
    int a = rng_below(r, n), b = rng_below(r, n);
    if (a != b && !joined(&s, a, b)) put_edge(&s, a, b);
  }
  join_odd_nodes(r, &s, most_odd);
  for (int e = 0; e < s.m; e++)
    length[e] = kind == LENGTHS_EQUAL            ? 7.3
                : kind == LENGTHS_SMALL_INTEGERS ? rng_between(r, 1, 4)
                : kind == LENGTHS_RANDOM         ? 0.01 + 10 * rng_unit(r)
                : kind == LENGTHS_SURDS
                    ? rng_between(r, 1, 3) * sqrt(rng_between(r, 1, 3)) /* no common measure */
                    : 0;
  int some = rng_below(r, n);
  for (int v = 0; v < n; v++)
    if (v == some || rng_below(r, 4) == 0) put_foot(&s, v);
  thr_frame f = sketch_finish(&s, length);
  free(length);
  return f;
}

thr_frame shuffled_frame(rng *r, const thr_frame *f, int *to)
{
  sketch s = sketch_make(f->n_nodes, f->n_edges);
  int *order = calloc((size_t)f->n_edges, sizeof *order);
  double *length = calloc((size_t)f->n_edges, sizeof *length);
  ck_assert(order && length);
  for (int v = 0; v < f->n_nodes; v++)
    to[v] = v;
  for (int e = 0; e < f->n_edges; e++)
    order[e] = e;
  rng_shuffle(r, to, f->n_nodes);
  rng_shuffle(r, order, f->n_edges);
  s.n = f->n_nodes;
  for (int v = 0; v < f->n_nodes; v++) {
    memcpy(s.xyz[to[v]], f->xyz[v], sizeof *s.xyz);
    if (f->foot[v]) put_foot(&s, to[v]);
  }
  for (int e = 0; e < f->n_edges; e++) {
    int flip = rng_below(r, 2), old = order[e];
    length[e] = f->own_lengths ? f->length[old] : 0;
    put_edge(&s, to[f->edge[old][flip]], to[f->edge[old][1 - flip]]);
  }
  thr_frame g = sketch_finish(&s, length);
  free(order);
  free(length);
  return g;
}

void name_nodes(thr_frame *f, const char *const *name, int n)
{
  thr_text names = {0};
  for (int v = 0; v < f->n_nodes; v++) {
    const char *own = name[v % n] ? name[v % n] : f->name[v];
    thr_text_append_bytes(&names, own, strlen(own) + 1);
  }
  ck_assert_int_eq(thr_frame_take_names(f, &names, NULL), THR_OK);
}
