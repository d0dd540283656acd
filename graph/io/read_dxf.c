/* SPDX-License-Identifier: GPL-3.0-or-later */
/* DXF, the drawing exchange format of AutoCAD, as text: LINE, LWPOLYLINE, POLYLINE (2-D, 3-D,
 * meshes and polyface meshes), 3DFACE, SPLINE, ARC and ELLIPSE, and INSERT of blocks, nested and in
 * arrays. Autodesk, "DXF Reference".
 *
 * A drawing is pairs of lines, a group code and a value. Each entity is read as a whole into its
 * paths and faces, in the coordinates of its block; at the end the model's entities are placed,
 * with the blocks that they insert. */
#include "graph/number.h"
#include "graph/io/read_parts.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_NESTED = 16,
  MOST_INSERTED = 1000000,
  MOST_PLACED = 20000000
}; /* blocks in blocks; all blocks; all their points */

/* x' = m x + t */
typedef struct {
  double m[3][3], t[3];
} placing;

static const char binary[] = "AutoCAD Binary DXF"; /* how such files begin */

static const placing unmoved = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};

typedef struct {
  int code;
  thr_span value;
} pair;

typedef enum { PATH, RING, INSERT, UNUSED, UNSEEN } shape_kind;

/* Layer 0 is in a block that of the INSERT. */
enum { ON_ZERO = -1, SHOWN = INT_MAX };

typedef struct {
  double center[3], major[3], minor[3];
} ellipse;

/* A curve in the coordinates of its block: a part of an ellipse, or a spline, whose arrays are
 * owned. */
typedef struct {
  ellipse arc;
  double from, to; /* of arc */
  int degree, n;   /* of a spline; n = 0: it is an arc */
  double (*control)[3], *weight, *knot;
} curve;

/* A run of points: open, or a face; or a block inserted; or a record that is only counted, wherever
 * it is placed. */
typedef struct {
  shape_kind kind;
  int first, last;     /* PATH, RING: points; INSERT: which of inserted; UNUSED: which of unused */
  double curve_length; /* PATH of two points: how long the curve between them is, 0 = straight */
  int curve;           /* the curve, if curve_length is not 0 */
  int layer; /* number of the part, or without --pick of the hidden layer, or SHOWN; ON_ZERO */
} shape;

typedef struct {
  thr_span name; /* empty: a section ENTITIES, whose shapes are the model's */
  double base[3];
  int first, last; /* shapes */
  bool external;   /* it stands for another file */
} block;

typedef struct {
  thr_span block;
  placing place;
} insertion;

/* A layer that is not shown. What is inserted on one that is frozen is hidden as a whole, on one
 * that is off only what would take its layer from the insertion. */
typedef struct {
  thr_span name;
  bool frozen;
  int n_edges; /* on it, left out */
} hidden_layer;

typedef struct {
  thr_scan scan;
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  bool ended;
  pair next; /* looked at, not yet taken */
  pair *pair;
  int n_pairs, pairs_capacity; /* of the entity being read, without its 0 */
  thr_span type;               /* what its 0 says */
  int type_line;
  double (*point)[3];
  int n_points, points_capacity;
  shape *shape;
  int n_shapes, shapes_capacity;
  block *block;
  int n_blocks, blocks_capacity;
  curve *curve;
  int n_curves, curves_capacity;
  insertion *inserted;
  int n_inserted, inserted_capacity;
  thr_span *unused; /* names of records that are not used */
  int n_unused, unused_capacity;
  /* of the POLYLINE being read */
  double (*vertex)[3];
  double *bulge;
  int n_vertices, vertices_capacity, bulge_capacity;
  /* what is placed */
  thr_sites sites;
  thr_faces faces; /* runs of sites; lengths of those of two are in length */
  double *length;  /* of each run, 0 = straight */
  int n_placed;    /* insertions */
  int n_visited;   /* shapes, as often as they are placed or left out */
  thr_parts parts; /* layers */
  hidden_layer *hidden;
  int n_hidden, hidden_capacity;
  thr_span layer_name; /* of the entity read last, whose number is layer */
  int ground;          /* the number of layer 0 outside of blocks */
  int layer;           /* of the entity being read, as in shape */
  int length_capacity;
} dxf;

/* ---- pairs and entities ---- */

/* The next pair into d->next; at the end of the text a pair 0 EOF. */
static thr_status look(dxf *d)
{
  thr_span code, value;
  int number;
  if (!thr_scan_line(&d->scan, &code) || (!thr_span_trim(code).n && d->scan.at >= d->scan.end)) {
    d->ended = true;
    d->next = (pair){0, thr_span_of("EOF")};
    return THR_OK;
  }
  if (!thr_span_int(thr_span_trim(code), &number))
    return thr_scan_fail(
        &d->scan, d->err,
        "'%.*s' is no group code; a DXF file is pairs of lines, a number and a value",
        thr_span_width(code), code.s);
  if (!thr_scan_line(&d->scan, &value))
    return thr_scan_fail(&d->scan, d->err, "the file ends in the middle of a pair");
  d->next = (pair){number, thr_span_trim(value)};
  return THR_OK;
}

/* Reads the entity that d->next begins, as far as the next pair with code 0. */
static thr_status take_entity(dxf *d)
{
  d->type = d->next.value;
  d->type_line = d->scan.line;
  d->n_pairs = 0;
  thr_status st = look(d);
  while (!st && d->next.code != 0) {
    st = thr_grow(&d->pair, d->n_pairs, &d->pairs_capacity, sizeof *d->pair, d->err);
    if (!st) d->pair[d->n_pairs++] = d->next;
    if (!st) st = look(d);
  }
  return st;
}

static thr_status fail(dxf *d, const char *what)
{
  d->scan.line = d->type_line;
  return thr_scan_fail(&d->scan, d->err, "this %.*s %s", thr_span_width(d->type), d->type.s, what);
}

/* The first pair with the code, NULL if there is none. */
static const pair *find(const dxf *d, int code)
{
  for (int i = 0; i < d->n_pairs; i++)
    if (d->pair[i].code == code) return &d->pair[i];
  return NULL;
}

static thr_status number_of(dxf *d, const pair *p, double *x)
{
  return thr_span_number(p->value, false, x) ? THR_OK
                                             : fail(d, "has a value that is not a finite number");
}

static thr_status number(dxf *d, int code, double otherwise, double *x)
{
  const pair *p = find(d, code);
  *x = otherwise;
  return p ? number_of(d, p, x) : THR_OK;
}

static thr_status whole(dxf *d, int code, int *n)
{
  const pair *p = find(d, code);
  *n = 0;
  return !p || thr_span_int(p->value, n) ? THR_OK
                                         : fail(d, "has a value that is not a whole number");
}

/* The point whose codes are code, code + 10 and code + 20; what is missing is 0. */
static thr_status point_of(dxf *d, int code, double xyz[3])
{
  thr_status st = THR_OK;
  for (int k = 0; k < 3 && !st; k++)
    st = number(d, code + 10 * k, 0, &xyz[k]);
  return st;
}

/* Returns c, or the small letter of a capital one: of ASCII, and after the byte C3 of UTF-8 of
 * Latin-1. */
static unsigned char small(unsigned char before, unsigned char c)
{
  const bool capital =
      (c >= 'A' && c <= 'Z') || (before == 0xc3 && c >= 0x80 && c <= 0x9e && c != 0x97);
  return capital ? c + 32 : c;
}

/* Are two names of a table of the drawing the same? Their letter case does not matter. */
static bool same_name(thr_span a, thr_span b)
{
  bool same = a.n == b.n;
  for (size_t i = 0; i < a.n && same; i++) {
    const unsigned char before = i ? (unsigned char)a.s[i - 1] : 0;
    same = small(before, (unsigned char)a.s[i]) == small(before, (unsigned char)b.s[i]);
  }
  return same;
}

/* On paper instead of in the model, or hidden. */
static bool is_unseen(const dxf *d)
{
  const pair *paper = find(d, 67), *hidden = find(d, 60);
  return (paper && thr_span_is(paper->value, "1")) || (hidden && thr_span_is(hidden->value, "1"));
}

/* ---- coordinates ---- */

static void turn(const placing *p, const double in[3], double out[3])
{
  double r[3];
  for (int i = 0; i < 3; i++)
    r[i] = thr_dot(p->m[i], in);
  memcpy(out, r, sizeof r);
}

static void apply(const placing *p, const double in[3], double out[3])
{
  turn(p, in, out);
  for (int i = 0; i < 3; i++)
    out[i] += p->t[i];
}

/* Returns by what factor the placing stretches all directions, mirrored or not; 0 if not all alike.
 */
static double even_scale(const placing *p)
{
  double dot[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      dot[i][j] = p->m[0][i] * p->m[0][j] + p->m[1][i] * p->m[1][j] + p->m[2][i] * p->m[2][j];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      if (!(fabs(dot[i][j] - (i == j ? dot[0][0] : 0)) <= 1e-12 * dot[0][0])) return 0;
  return sqrt(dot[0][0]);
}

/* First b, then a. */
static placing after(const placing *a, const placing *b)
{
  placing c;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      c.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
    c.t[i] = thr_dot(a->m[i], b->t) + a->t[i];
  }
  return c;
}

static bool normalize(double v[3])
{
  double n = sqrt(thr_dot(v, v));
  for (int i = 0; i < 3; i++)
    v[i] /= n > 0 ? n : 1;
  return n > 0;
}

/* An entity's own coordinates, told by the direction of its z axis (codes 210 to 230): the
 * "arbitrary axis algorithm". */
static thr_status own_coordinates(dxf *d, placing *p)
{
  double z[3], x[3], y[3];
  *p = unmoved;
  thr_status st = point_of(d, 210, z);
  if (st || !normalize(z)) return st;
  const double world_y[3] = {0, 1, 0}, world_z[3] = {0, 0, 1};
  thr_cross(fabs(z[0]) < 1. / 64 && fabs(z[1]) < 1. / 64 ? world_y : world_z, z, x);
  normalize(x);
  thr_cross(z, x, y);
  for (int i = 0; i < 3; i++) {
    p->m[i][0] = x[i];
    p->m[i][1] = y[i];
    p->m[i][2] = z[i];
  }
  return THR_OK;
}

/* ---- shapes ---- */

static thr_status add_point(dxf *d, const placing *p, const double xyz[3])
{
  thr_status st = thr_grow(&d->point, d->n_points, &d->points_capacity, sizeof *d->point, d->err);
  if (!st) apply(p, xyz, d->point[d->n_points++]);
  return st;
}

/* Ends the shape whose points were added since first. */
static thr_status add_shape(dxf *d, shape_kind kind, int first, int last, double curve_length)
{
  thr_status st = thr_grow(&d->shape, d->n_shapes, &d->shapes_capacity, sizeof *d->shape, d->err);
  if (!st)
    d->shape[d->n_shapes++] = (shape){kind, first, last, curve_length, d->n_curves - 1, d->layer};
  return st;
}

/* Leaves out the entity as one that is not used, by its type or, if that says too little, another
 * name. */
static thr_status leave_out(dxf *d, const char *name)
{
  thr_status st = thr_grow(&d->unused, d->n_unused, &d->unused_capacity, sizeof *d->unused, d->err);
  if (st) return st;
  d->unused[d->n_unused] = name ? thr_span_of(name) : d->type;
  return add_shape(d, UNUSED, d->n_unused++, 0, 0);
}

static thr_status add_segment(dxf *d, const placing *p, const double a[3], const double b[3],
                              double curve_length)
{
  int first = d->n_points;
  thr_status st = add_point(d, p, a);
  if (!st) st = add_point(d, p, b);
  return st ? st : add_shape(d, PATH, first, d->n_points, curve_length);
}

static double distance(const double a[3], const double b[3])
{
  const double v[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return sqrt(thr_dot(v, v));
}

/* ---- curves ---- */

static void ellipse_point(const void *arc, double t, double xyz[3])
{
  const ellipse *e = arc;
  for (int k = 0; k < 3; k++)
    xyz[k] = e->center[k] + cos(t) * e->major[k] + sin(t) * e->minor[k];
}

/* Computes the length of an arc of a circle, or sums by quarters, between which a thin ellipse
 * turns sharply. */
static double ellipse_length(const ellipse *e, double from, double to)
{
  double length = 0;
  const double square = thr_dot(e->major, e->major);
  if (thr_dot(e->major, e->minor) == 0 && thr_dot(e->minor, e->minor) == square)
    return sqrt(square) * (to - from);
  const int n = (int)ceil((to - from) / (THR_PI / 2) - 1e-9);
  for (int i = 0; i < n; i++)
    length += thr_curve_length(ellipse_point, e, from + (to - from) * i / n,
                               from + (to - from) * (i + 1) / n);
  return length;
}

static void free_curve(curve *c)
{
  free(c->control);
  free(c->weight);
  free(c->knot);
}

static thr_spline spline_of(const curve *c)
{
  return (thr_spline){c->degree, c->n, (const double(*)[3])c->control, c->weight, c->knot};
}

/* Takes the curve over and adds the segment that it leads along. */
static thr_status add_curve(dxf *d, const placing *p, const double a[3], const double b[3],
                            curve *c, double length)
{
  thr_status st = thr_grow(&d->curve, d->n_curves, &d->curves_capacity, sizeof *d->curve, d->err);
  if (st) {
    free_curve(c);
    return st;
  }
  d->curve[d->n_curves++] = *c;
  return add_segment(d, p, a, b, length);
}

/* Adds a part of an ellipse that lies in the coordinates p as one edge. */
static thr_status add_arc(dxf *d, const placing *p, const ellipse *e, double from, double to,
                          double length)
{
  double a[3], b[3];
  curve c = {.from = from, .to = to};
  ellipse_point(e, from, a);
  ellipse_point(e, to, b);
  turn(p, e->major, c.arc.major);
  turn(p, e->minor, c.arc.minor);
  return add_curve(d, p, a, b, &c, length);
}

/* Adds a segment of a polyline. Its bulge is the tangent of a quarter of its arc's angle, 0 =
 * straight. halved: the arc becomes two edges that meet in its middle. */
static thr_status add_bulge(dxf *d, const placing *p, const double a[3], const double b[3],
                            double bulge, bool halved)
{
  const double angle = 4 * atan(fabs(bulge)), half = sin(angle / 2), way = bulge < 0 ? -1 : 1;
  if (bulge == 0 || half <= 0) return add_segment(d, p, a, b, 0);

  /* The centre is to the left of the chord where the bulge is between 0 and 1. */
  const double aside = (1 - bulge * bulge) / (4 * bulge),
               length = distance(a, b) * angle / (2 * half);
  const double center[3] = {(a[0] + b[0]) / 2 - aside * (b[1] - a[1]),
                            (a[1] + b[1]) / 2 + aside * (b[0] - a[0]), a[2]};
  const double r[2] = {a[0] - center[0], a[1] - center[1]};
  const ellipse e = {
      {center[0], center[1], center[2]}, {r[0], r[1], 0}, {-way * r[1], way * r[0], 0}};
  if (!halved) return add_arc(d, p, &e, 0, angle, length);
  thr_status st = add_arc(d, p, &e, 0, angle / 2, length / 2);
  return st ? st : add_arc(d, p, &e, angle / 2, angle, length / 2);
}

/* Adds d->vertex as segments. Two arcs between the same two vertices, like those of a circle, would
 * be one edge: both get a node in their middle. */
static thr_status add_polyline(dxf *d, const placing *p, bool closed)
{
  thr_status st = THR_OK;
  const int n = d->n_vertices;
  const bool lens = closed && n == 2 && (d->bulge[0] != 0 || d->bulge[1] != 0);
  for (int i = 0; i < (closed && (n > 2 || lens) ? n : n - 1) && !st; i++) {
    const double *a = d->vertex[i], *b = d->vertex[(i + 1) % n], bulge = d->bulge[i];
    st = add_bulge(d, p, a, b, bulge, lens);
  }
  return st;
}

static thr_status add_vertex(dxf *d, const double xyz[3], double bulge)
{
  thr_status st =
      thr_grow(&d->vertex, d->n_vertices, &d->vertices_capacity, sizeof *d->vertex, d->err);
  if (!st) st = thr_grow(&d->bulge, d->n_vertices, &d->bulge_capacity, sizeof *d->bulge, d->err);
  if (st) return st;
  memcpy(d->vertex[d->n_vertices], xyz, sizeof *d->vertex);
  d->bulge[d->n_vertices++] = bulge;
  return THR_OK;
}

/* ---- the entities ---- */

static thr_status read_line(dxf *d)
{
  double a[3], b[3];
  thr_status st = point_of(d, 10, a);
  if (!st) st = point_of(d, 11, b);
  return st ? st : add_segment(d, &unmoved, a, b, 0);
}

static thr_status read_lwpolyline(dxf *d)
{
  placing own;
  double z, x;
  int flags = 0;
  d->n_vertices = 0;
  thr_status st = own_coordinates(d, &own);
  if (!st) st = number(d, 38, 0, &z);
  if (!st) st = whole(d, 70, &flags);
  for (int i = 0; i < d->n_pairs && !st; i++) {
    const int code = d->pair[i].code;
    if (code != 10 && code != 20 && code != 42) continue;
    if (code != 10 && d->n_vertices == 0)
      return fail(d, "has a coordinate before its first vertex");
    st = number_of(d, &d->pair[i], &x);
    if (!st && code == 10) st = add_vertex(d, (double[3]){x, 0, z}, 0);
    if (!st && code == 20) d->vertex[d->n_vertices - 1][1] = x;
    if (!st && code == 42) d->bulge[d->n_vertices - 1] = x;
  }
  return st ? st : add_polyline(d, &own, flags & 1);
}

/* Invisible sides (bits of 70) are no edges; a face with none of them is one for --flat as well.
 * The last side of a triangle is the fourth of a face whose third side has no length. */
static thr_status read_face(dxf *d)
{
  double corner[4][3];
  int hidden, n = 4;
  thr_status st = whole(d, 70, &hidden);
  for (int i = 0; i < 4 && !st; i++)
    st = point_of(d, 10 + i, corner[i]);
  if (st) return st;
  if (!find(d, 13) || (corner[2][0] == corner[3][0] && corner[2][1] == corner[3][1] &&
                       corner[2][2] == corner[3][2]))
    n = 3;
  int first = d->n_points;
  for (int i = 0; i < n && !st && !(hidden & 15); i++)
    st = add_point(d, &unmoved, corner[i]);
  if (!(hidden & 15)) return st ? st : add_shape(d, RING, first, d->n_points, 0);
  for (int i = 0; i < n && !st; i++)
    if (!(hidden >> (i == n - 1 ? 3 : i) & 1))
      st = add_segment(d, &unmoved, corner[i], corner[(i + 1) % n], 0);
  return st;
}

/* Does a curve end where it begins? Then it leads from no node to another. */
static bool is_closed(const double a[3], const double b[3], double length)
{
  return length > 0 && distance(a, b) <= 1e-6 * length;
}

/* Adds a part of an ellipse, less than all of it. */
static thr_status add_ellipse(dxf *d, const placing *p, const ellipse *e, double from, double to)
{
  double a[3], b[3];
  const double turns = (to - from) / (2 * THR_PI);
  if (!(turns > 0 && turns <= 1)) to = from + 2 * THR_PI * (turns - ceil(turns) + 1);
  const double length = ellipse_length(e, from, to);
  ellipse_point(e, from, a);
  ellipse_point(e, to, b);
  return is_closed(a, b, length) ? leave_out(d, "a closed curve")
                                 : add_arc(d, p, e, from, to, length);
}

static thr_status read_arc(dxf *d)
{
  placing own;
  ellipse e = {0};
  double radius, from, to;
  thr_status st = own_coordinates(d, &own);
  if (!st) st = point_of(d, 10, e.center);
  if (!st) st = number(d, 40, 0, &radius);
  if (!st) st = number(d, 50, 0, &from);
  if (!st) st = number(d, 51, 360, &to);
  if (st) return st;
  if (fabs(from) > 1e6 || fabs(to) > 1e6)
    return fail(d, "has angles of more than a million degrees");
  e.major[0] = e.minor[1] = radius;
  return add_ellipse(d, &own, &e, from * THR_PI / 180, to * THR_PI / 180);
}

static thr_status read_ellipse(dxf *d)
{
  ellipse e = {0};
  double ratio, from, to, z[3];
  thr_status st = point_of(d, 10, e.center);
  if (!st) st = point_of(d, 11, e.major);
  if (!st) st = point_of(d, 210, z);
  if (!st) st = number(d, 40, 1, &ratio);
  if (!st) st = number(d, 41, 0, &from);
  if (!st) st = number(d, 42, 2 * THR_PI, &to);
  if (st) return st;
  if (fabs(from) > 1e6 || fabs(to) > 1e6) return fail(d, "has parameters of more than a million");
  if (!normalize(z)) z[2] = 1;
  thr_cross(z, e.major, e.minor);
  for (int k = 0; k < 3; k++)
    e.minor[k] *= ratio;
  return add_ellipse(d, &unmoved, &e, from, to);
}

/* All values with the code, into an array that the caller frees. */
static thr_status values_of(dxf *d, int code, double **out, int *n)
{
  thr_status st = THR_OK;
  *n = 0;
  if (!(*out = thr_calloc((size_t)d->n_pairs, sizeof **out))) return thr_nomem(d->err);
  for (int i = 0; i < d->n_pairs && !st; i++)
    if (d->pair[i].code == code) st = number_of(d, &d->pair[i], &(*out)[(*n)++]);
  return st;
}

/* Degree 1: a polyline through its control points. Higher: one edge from beginning to end, as long
 * as the curve, which is taken over and left without its arrays. */
static thr_status use_spline(dxf *d, curve *c, int n_knots, int n_weights)
{
  const thr_spline s = spline_of(c);
  if (c->degree == 1) {
    thr_status st = THR_OK;
    for (int i = 0; i + 1 < c->n && !st; i++)
      st = add_segment(d, &unmoved, c->control[i], c->control[i + 1], 0);
    return st;
  }
  if (n_knots != c->n + c->degree + 1 || (n_weights && n_weights != c->n) ||
      !thr_spline_is_sound(&s))
    return leave_out(d, NULL);
  double a[3], b[3];
  thr_spline_point(&s, s.knot[s.degree], a);
  thr_spline_point(&s, s.knot[s.n], b);
  const double length = thr_spline_length(&s);
  if (is_closed(a, b, length)) return leave_out(d, "a closed curve");
  curve taken = *c;
  *c = (curve){0};
  return add_curve(d, &unmoved, a, b, &taken, length);
}

static thr_status read_spline(dxf *d)
{
  double *value[3] = {0}; /* x, y, z */
  static const int code[3] = {10, 20, 30};
  curve c = {0};
  int n[3] = {0}, n_knots = 0, n_weights = 0;
  thr_status st = whole(d, 71, &c.degree);
  for (int i = 0; i < 3 && !st; i++)
    st = values_of(d, code[i], &value[i], &n[i]);
  if (!st) st = values_of(d, 40, &c.knot, &n_knots);
  if (!st) st = values_of(d, 41, &c.weight, &n_weights);
  if (!find(d, 71)) c.degree = n_knots - n[0] - 1; /* trimesh does not say it */
  const bool controlled = n[0] >= 2 && n[1] == n[0] && (!n[2] || n[2] == n[0]);
  if (!st && !controlled) st = leave_out(d, NULL); /* it may have points to go through only */
  if (!st && controlled && !(c.control = thr_calloc((size_t)n[0], sizeof *c.control)))
    st = thr_nomem(d->err);
  if (!st && controlled) {
    for (int i = 0; i < n[0]; i++)
      for (int k = 0; k < 3; k++)
        c.control[i][k] = n[k] ? value[k][i] : 0;
    if (!n_weights) {
      free(c.weight);
      c.weight = NULL;
    }
    c.n = n[0];
    st = use_spline(d, &c, n_knots, n_weights);
  }
  free_curve(&c);
  for (int i = 0; i < 3; i++)
    free(value[i]);
  return st;
}

/* ---- POLYLINE: its vertices are entities of their own ---- */

enum {
  CLOSED = 1,
  SPLINE_FIT = 4,
  SPACE = 8,
  MESH = 16,
  CLOSED_N = 32,
  POLYFACE = 64
};                                                             /* code 70 of a POLYLINE */
enum { FRAME_POINT = 16, FACE_RECORD = 128, FACE_PLACE = 64 }; /* of a VERTEX */

/* A face record of a polyface mesh: numbers of vertices from 1, negative where the side after it is
 * hidden. */
static thr_status read_face_record(dxf *d)
{
  thr_status st = THR_OK;
  int corner[4] = {0}, n = 0;
  for (int i = 0; i < 4 && !st; i++) {
    int v;
    st = whole(d, 71 + i, &v);
    if (!st && v) corner[n++] = v;
  }
  for (int i = 0; i < n && !st; i++) {
    int a = abs(corner[i]), b = abs(corner[(i + 1) % n]);
    if (a > d->n_vertices || b > d->n_vertices)
      return fail(d, "names a vertex that does not exist");
    if (corner[i] > 0 && n > 1)
      st = add_segment(d, &unmoved, d->vertex[a - 1], d->vertex[b - 1], 0);
  }
  return st;
}

static thr_status read_vertex(dxf *d, int polyline_flags)
{
  double xyz[3], bulge;
  int flags;
  thr_status st = whole(d, 70, &flags);
  if (st || flags & FRAME_POINT) return st;
  if (polyline_flags & POLYFACE && flags & FACE_RECORD && !(flags & FACE_PLACE))
    return read_face_record(d);
  st = point_of(d, 10, xyz);
  if (!st) st = number(d, 42, 0, &bulge);
  return st ? st : add_vertex(d, xyz, polyline_flags & (SPACE | MESH | POLYFACE) ? 0 : bulge);
}

static thr_status add_mesh(dxf *d, int m, int n, bool closed_m, bool closed_n)
{
  thr_status st = THR_OK;
  if (m < 1 || n < 1 || (int64_t)m * n > d->n_vertices)
    return fail(d, "has fewer vertices than its mesh needs");
  for (int i = 0; i < m && !st; i++)
    for (int j = 0; j < n && !st; j++) {
      const double *here = d->vertex[i * n + j];
      if (i + 1 < m || (closed_m && m > 2))
        st = add_segment(d, &unmoved, here, d->vertex[(i + 1) % m * n + j], 0);
      if (!st && (j + 1 < n || (closed_n && n > 2)))
        st = add_segment(d, &unmoved, here, d->vertex[i * n + (j + 1) % n], 0);
    }
  return st;
}

static thr_status read_polyline(dxf *d)
{
  placing own;
  int flags, m, n;
  double elevation;
  const pair *height = find(d, 30) ? find(d, 30) : find(d, 38);
  const bool unseen = is_unseen(d);
  const int first_shape = d->n_shapes;
  thr_status st = whole(d, 70, &flags);

  /* The vertices of a smoothed mesh that are not control points are a mesh of its own density. */
  const bool smooth = !st && (flags & (MESH | SPLINE_FIT)) == (MESH | SPLINE_FIT);
  if (!st) st = whole(d, smooth ? 73 : 71, &m);
  if (!st) st = whole(d, smooth ? 74 : 72, &n);
  elevation = 0;
  if (!st && height) st = number_of(d, height, &elevation);
  if (!st) st = own_coordinates(d, &own);
  d->n_vertices = 0;
  while (!st && thr_span_is(d->next.value, "VERTEX")) {
    st = take_entity(d);
    if (!st) st = read_vertex(d, flags);
  }
  if (!st && thr_span_is(d->next.value, "SEQEND")) st = take_entity(d);

  /* All vertices of a 2-D polyline have its elevation. Where that is 0 those that say a height of
   * their own keep it. */
  for (int i = 0; i < d->n_vertices && elevation != 0 && !(flags & (SPACE | MESH | POLYFACE)); i++)
    d->vertex[i][2] = elevation;
  if (!st && flags & MESH)
    st = add_mesh(d, m, n, flags & CLOSED, flags & CLOSED_N);
  else if (!st && !(flags & POLYFACE))
    st = add_polyline(d, flags & SPACE ? &unmoved : &own, flags & CLOSED);
  if (st || !unseen) return st;
  d->n_shapes = first_shape;
  return add_shape(d, UNSEEN, 0, 0, 0);
}

/* ---- blocks ---- */

static thr_status add_insertion(dxf *d, thr_span name, const placing *place)
{
  thr_status st =
      thr_grow(&d->inserted, d->n_inserted, &d->inserted_capacity, sizeof *d->inserted, d->err);
  if (st) return st;
  d->inserted[d->n_inserted] = (insertion){name, *place};
  return add_shape(d, INSERT, d->n_inserted++, 0, 0);
}

/* Scaled, turned about z, moved; in rows and columns. */
static thr_status read_insert(dxf *d)
{
  placing own, local = unmoved;
  double scale[3], turn, step[2];
  int columns, rows;
  const pair *name = find(d, 2);
  if (!name) return fail(d, "names no block");
  thr_status st = own_coordinates(d, &own);
  if (!st) st = point_of(d, 10, local.t);
  for (int k = 0; k < 3 && !st; k++)
    st = number(d, 41 + k, 1, &scale[k]);
  if (!st) st = number(d, 50, 0, &turn);
  if (!st) st = whole(d, 70, &columns);
  if (!st) st = whole(d, 71, &rows);
  if (!st) st = number(d, 44, 0, &step[0]);
  if (!st) st = number(d, 45, 0, &step[1]);
  if (st) return st;
  const double c = cos(turn * THR_PI / 180), s = sin(turn * THR_PI / 180),
               at[3] = {local.t[0], local.t[1], local.t[2]};
  const double turned[2][2] = {{c, -s}, {s, c}};
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      local.m[i][j] = turned[i][j] * scale[j];
  local.m[2][2] = scale[2];
  columns = columns > 1 ? columns : 1;
  rows = rows > 1 ? rows : 1;
  if ((int64_t)columns * rows > 100000) return fail(d, "is repeated more than 100,000 times");
  for (int row = 0; row < rows && !st; row++)
    for (int column = 0; column < columns && !st; column++) {
      for (int i = 0; i < 2; i++)
        local.t[i] = at[i] + turned[i][0] * column * step[0] + turned[i][1] * row * step[1];
      const placing p = after(&own, &local);
      st = add_insertion(d, name->value, &p);
    }
  return st;
}

/* Returns the number of the hidden layer of a name, or SHOWN. */
static int find_hidden(const dxf *d, thr_span name)
{
  for (int i = 0; i < d->n_hidden; i++)
    if (same_name(d->hidden[i].name, name)) return i;
  return SHOWN;
}

/* Finds the layer of the entity that was taken: code 8. */
static thr_status find_layer(dxf *d)
{
  const pair *named = find(d, 8);
  const thr_span name = named ? named->value : thr_span_of("0"), last = d->layer_name;
  if (last.s && name.n == last.n && memcmp(name.s, last.s, name.n) == 0) return THR_OK;
  d->layer_name = name;
  d->layer = ON_ZERO;
  if (thr_span_is(name, "0")) return THR_OK;
  if (d->parts.asked) return thr_parts_find(&d->parts, name, &d->layer, d->err);
  d->layer = find_hidden(d, name);
  return THR_OK;
}

/* Keeps the layer of a table if it is hidden: off, which a negative colour says, or frozen. */
static thr_status read_layer(dxf *d)
{
  const pair *name = find(d, 2);
  int flags, colour;
  thr_status st = whole(d, 70, &flags);
  if (!st) st = whole(d, 62, &colour);
  if (st || !name || !((flags & 1) || colour < 0) || d->draft->all_layers || d->parts.asked)
    return st;
  st = thr_grow(&d->hidden, d->n_hidden, &d->hidden_capacity, sizeof *d->hidden, d->err);
  if (!st) d->hidden[d->n_hidden++] = (hidden_layer){name->value, flags & 1, 0};
  return st;
}

static thr_status read_tables(dxf *d)
{
  thr_status st = THR_OK;
  while (!st && !d->ended && !thr_span_is(d->next.value, "ENDSEC")) {
    st = take_entity(d);
    if (!st && thr_span_is(d->type, "LAYER")) st = read_layer(d);
  }
  return st;
}

static thr_status read_entity(dxf *d)
{
  static const struct {
    const char *type;
    thr_status (*read)(dxf *);
  } known[] = {{"LINE", read_line},    {"LWPOLYLINE", read_lwpolyline},
               {"3DFACE", read_face},  {"SPLINE", read_spline},
               {"ARC", read_arc},      {"ELLIPSE", read_ellipse},
               {"INSERT", read_insert}};
  thr_status st = take_entity(d);
  if (!st) st = find_layer(d);
  if (st) return st;
  if (thr_span_is(d->type, "POLYLINE")) return read_polyline(d);
  if (is_unseen(d)) return add_shape(d, UNSEEN, 0, 0, 0);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(d->type, known[i].type)) return known[i].read(d);
  return thr_span_is(d->type, "ATTRIB") || thr_span_is(d->type, "SEQEND") ? THR_OK
                                                                          : leave_out(d, NULL);
}

/* Entities up to the pair 0 that ends them. */
static thr_status read_entities(dxf *d, const char *end)
{
  thr_status st = THR_OK;
  while (!st && !d->ended && !thr_span_is(d->next.value, end))
    st = read_entity(d);
  return st;
}

static thr_status read_block(dxf *d)
{
  thr_status st = take_entity(d);
  const pair *name = find(d, 2);
  int flags = 0;
  block b = {.name = name ? name->value : (thr_span){0}, .first = d->n_shapes};
  if (!st) st = whole(d, 70, &flags);
  if (!st) st = point_of(d, 10, b.base);
  b.external = flags & (4 | 8); /* an external reference, or an overlay */
  if (!st) st = read_entities(d, "ENDBLK");
  if (b.name.n == 0) d->n_shapes = b.first; /* nothing can insert it */
  b.last = d->n_shapes;
  if (!st) st = thr_grow(&d->block, d->n_blocks, &d->blocks_capacity, sizeof *d->block, d->err);
  if (!st) d->block[d->n_blocks++] = b;
  if (!st) st = take_entity(d); /* ENDBLK */
  return st;
}

static thr_status read_blocks(dxf *d)
{
  thr_status st = THR_OK;
  while (!st && !d->ended && !thr_span_is(d->next.value, "ENDSEC"))
    st = thr_span_is(d->next.value, "BLOCK") ? read_block(d) : take_entity(d);
  return st;
}

/* The unit, code 70 after the variable $INSUNITS. */
static thr_status read_header(dxf *d)
{
  int unit = 0;
  for (int i = 0; i + 1 < d->n_pairs; i++)
    if (d->pair[i].code == 9 && thr_span_is(d->pair[i].value, "$INSUNITS") &&
        d->pair[i + 1].code == 70 && !thr_span_int(d->pair[i + 1].value, &unit))
      return fail(d, "has a $INSUNITS that is not a whole number");
  return thr_dxf_unit(unit) ? thr_draft_set_units(d->draft, thr_dxf_unit(unit), d->err) : THR_OK;
}

/* Reads a section ENTITIES as a block without a name. A file may have several of them. */
static thr_status read_model(dxf *d)
{
  block model = {.first = d->n_shapes};
  thr_status st = read_entities(d, "ENDSEC");
  model.last = d->n_shapes;
  if (!st) st = thr_grow(&d->block, d->n_blocks, &d->blocks_capacity, sizeof *d->block, d->err);
  if (!st) d->block[d->n_blocks++] = model;
  return st;
}

static thr_status read_sections(dxf *d)
{
  thr_status st = look(d);
  while (!st && !d->ended && !thr_span_is(d->next.value, "EOF")) {
    st = take_entity(d);
    const pair *said = thr_span_is(d->type, "SECTION") ? find(d, 2) : NULL;
    if (st || !said) continue;
    const thr_span name = said->value;
    if (thr_span_is(name, "HEADER")) st = read_header(d);
    if (!st && thr_span_is(name, "TABLES")) st = read_tables(d);
    if (!st && thr_span_is(name, "BLOCKS")) st = read_blocks(d);
    if (!st && thr_span_is(name, "ENTITIES")) st = read_model(d);
  }
  return st;
}

/* ---- placing ---- */

/* Counts an insertion of a block that the file does not hold. */
static void miss_block(dxf *d, thr_span name)
{
  thr_read_report *r = d->report;
  if (r->missing_blocks++) return;
  snprintf(r->missing_block, sizeof r->missing_block, "%.*s", name.n < 31 ? (int)name.n : 31,
           name.s);
  thr_text_clean(r->missing_block);
}

/* Finds the block of a name in the same letter case, else in any. *found is NULL if there is none;
 * THR_EINPUT if there are two that are not empty. */
static thr_status find_block(const dxf *d, thr_span name, const block **found)
{
  bool exact = false, twice = false;
  *found = NULL;
  for (const block *b = d->block; b < d->block + d->n_blocks; b++) {
    if (name.n == 0 || !same_name(b->name, name)) continue;
    const bool same = memcmp(b->name.s, name.s, name.n) == 0,
               better = !*found || (*found)->first == (*found)->last;
    if (exact && !same) continue;
    twice = same == exact && !better && b->first < b->last;
    if (same > exact || better) *found = b;
    exact |= same;
    if (twice) break;
  }
  if (!twice) return THR_OK;
  return thr_fail(d->err, THR_EINPUT,
                  "%s: two blocks are called '%.*s', and it is inserted; rename one of them",
                  d->scan.name, thr_span_width(name), name.s);
}

/* Computes how long a curve is where it is placed: an ellipse stays one, a spline moves with its
 * control points. */
static thr_status placed_length(dxf *d, const shape *s, const placing *p, double *length)
{
  const double scale = even_scale(p);
  const curve *c = &d->curve[s->curve];
  *length = s->curve_length * scale;
  if (scale > 0) return THR_OK;
  if (c->n == 0) {
    ellipse e = {0};
    turn(p, c->arc.major, e.major);
    turn(p, c->arc.minor, e.minor);
    *length = ellipse_length(&e, c->from, c->to);
    return THR_OK;
  }
  curve moved = *c;
  if (!(moved.control = thr_calloc((size_t)c->n, sizeof *moved.control))) return thr_nomem(d->err);
  for (int i = 0; i < c->n; i++)
    turn(p, c->control[i], moved.control[i]);
  const thr_spline spline = spline_of(&moved);
  *length = thr_spline_length(&spline);
  free(moved.control);
  return THR_OK;
}

/* Places a run of points. */
static thr_status place_run(dxf *d, const shape *s, const placing *p)
{
  double at[3];
  thr_status st = THR_OK;
  for (int i = s->first; i < s->last && !st; i++) {
    if (d->sites.n >= MOST_PLACED)
      return thr_fail(d->err, THR_EINPUT, "%s: more than %d points with all inserted blocks",
                      d->scan.name, MOST_PLACED);
    apply(p, d->point[i], at);
    if (!isfinite(at[0]) || !isfinite(at[1]) || !isfinite(at[2]))
      return thr_fail(d->err, THR_EINPUT, "%s: an inserted block leaves the range of numbers",
                      d->scan.name);
    st = thr_faces_corner(&d->faces, d->sites.n, d->err);
    if (!st) st = thr_sites_add(&d->sites, at, d->err);
  }
  if (!st) st = thr_grow(&d->length, d->faces.n, &d->length_capacity, sizeof *d->length, d->err);
  if (st) return st;
  d->length[d->faces.n] = 0;
  if (s->curve_length > 0) st = placed_length(d, s, p, &d->length[d->faces.n]);
  if (st) return st;
  if (!isfinite(d->length[d->faces.n]))
    return thr_fail(d->err, THR_EINPUT, "%s: an inserted block leaves the range of numbers",
                    d->scan.name);
  return thr_faces_close(&d->faces, d->err);
}

/* Places a run of points, or counts a record that is left out. */
static thr_status place_one(dxf *d, const shape *s, const placing *p)
{
  if (s->kind == UNUSED) thr_report_skip(d->report, d->unused[s->first]);
  d->report->unseen_records += s->kind == UNSEEN;
  return s->kind == PATH || s->kind == RING ? place_run(d, s, p) : THR_OK;
}

/* Places shapes. layer: that of those on layer 0; frozen: the layer that hides them all, or SHOWN.
 */
static thr_status place_shapes(dxf *d, int first, int last, const placing *p, int layer, int frozen,
                               int depth)
{
  thr_status st = THR_OK;
  for (int i = first; i < last && !st; i++) {
    const shape *s = &d->shape[i];
    const int own = s->layer >= 0 ? s->layer : layer, hiding = frozen < d->n_hidden ? frozen : own;
    if (++d->n_visited > MOST_PLACED)
      return thr_fail(d->err, THR_EINPUT, "%s: more than %d entities with all inserted blocks",
                      d->scan.name, MOST_PLACED);
    if (s->kind != INSERT) {
      if (hiding >= 0 && hiding < d->n_hidden)
        d->hidden[hiding].n_edges += s->kind == RING ? s->last - s->first : s->kind == PATH;
      else if (thr_parts_has(&d->parts, own))
        st = place_one(d, s, p);
      continue;
    }
    const insertion *in = &d->inserted[s->first];
    const block *b;
    st = find_block(d, in->block, &b);
    if (st) return st;
    if (!b || (b->external && b->first == b->last)) {
      miss_block(d, in->block);
      continue;
    }
    if (depth == MOST_NESTED || ++d->n_placed > MOST_INSERTED)
      return thr_fail(d->err, THR_EINPUT,
                      "%s: blocks are nested more than %d deep, or inserted more than %d times",
                      d->scan.name, MOST_NESTED, MOST_INSERTED);
    placing base = unmoved;
    for (int k = 0; k < 3; k++)
      base.t[k] = -b->base[k];
    placing q = after(&in->place, &base);
    q = after(p, &q);
    const bool freezes = hiding >= 0 && hiding < d->n_hidden && d->hidden[hiding].frozen;
    st = place_shapes(d, b->first, b->last, &q, own, freezes ? hiding : SHOWN, depth + 1);
  }
  return st;
}

static thr_status place_model(dxf *d)
{
  thr_status st = THR_OK;
  for (int i = 0; i < d->n_blocks && !st; i++)
    if (d->block[i].name.n == 0)
      st = place_shapes(d, d->block[i].first, d->block[i].last, &unmoved, d->ground, SHOWN, 0);
  for (int i = 0; i < d->n_hidden; i++) {
    d->report->hidden_edges += d->hidden[i].n_edges;
    d->report->hidden_layers += d->hidden[i].n_edges > 0;
  }
  return st;
}

/* The runs of two as edges, the rings as sides of faces. */
static thr_status fill_draft(dxf *d)
{
  if (d->faces.n == 0 && d->report->hidden_edges)
    return thr_fail(d->err, THR_EINPUT,
                    "%s: all its edges are on hidden layers; --layers all reads them",
                    d->scan.name);
  if (d->faces.n == 0)
    return thr_fail(
        d->err, THR_EINPUT,
        "%s: no lines, polylines, faces or open curves in its model%s%s%s%s%s; draw its edges as "
        "lines, or explode what has them",
        d->scan.name, d->report->skipped_records ? ", but others: " : "", d->report->skipped_kind,
        d->report->unseen_records ? "; what is on paper or marked invisible is not read" : "",
        d->report->missing_blocks ? "; a block that is not in the file: " : "",
        d->report->missing_block);
  thr_faces rings = {0};
  int *node = thr_calloc((size_t)d->sites.n, sizeof *node);
  thr_status st = node ? thr_sites_finish(&d->sites, node, d->draft, d->err) : thr_nomem(d->err);
  for (int i = 0; i < d->faces.n && !st; i++) {
    int first = i ? d->faces.end[i - 1] : 0, n = d->faces.end[i] - first;
    int *corner = d->faces.corner + first;
    for (int k = 0; k < n; k++)
      corner[k] = node[corner[k]];
    st = n == 2 ? thr_draft_add_edge(d->draft, corner[0], corner[1], d->length[i], d->err)
                : thr_faces_add(&rings, corner, n, d->err);
  }
  if (!st) st = thr_faces_finish(&rings, d->draft, d->scan.name, d->err);
  thr_faces_destroy(&rings);
  free(node);
  return st;
}

/* Layer 0 comes last: what stands on it is counted only where it is placed. */
static thr_status choose_layers(dxf *d)
{
  bool grounded = false;
  thr_status st = THR_OK;
  d->ground = d->parts.asked ? -1 : find_hidden(d, thr_span_of("0"));
  for (int b = 0; b < d->n_blocks; b++)
    for (int i = d->block[b].first; i < d->block[b].last && d->block[b].name.n == 0; i++)
      grounded |= d->shape[i].layer < 0 && d->shape[i].kind < UNUSED;
  if (grounded && d->parts.asked)
    st = thr_parts_find(&d->parts, thr_span_of("0"), &d->ground, d->err);
  return st ? st : thr_parts_choose(&d->parts, d->scan.name, "layer", "layers", d->err);
}

static void destroy(dxf *d)
{
  free(d->pair);
  free(d->point);
  free(d->shape);
  free(d->block);
  for (int i = 0; i < d->n_curves; i++)
    free_curve(&d->curve[i]);
  free(d->curve);
  free(d->inserted);
  free(d->unused);
  free(d->hidden);
  free(d->vertex);
  free(d->bulge);
  free(d->length);
  thr_sites_destroy(&d->sites);
  thr_faces_destroy(&d->faces);
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  dxf d = {.draft = draft,
           .report = report,
           .err = err,
           .parts = {.asked = draft->pick},
           .layer_name = thr_span_of("0"),
           .layer = ON_ZERO};
  thr_status st = THR_OK;
  if (n >= sizeof binary - 1 && memcmp(text, binary, sizeof binary - 1) == 0)
    st = thr_fail(err, THR_EINPUT, "%s: binary DXF is not read; export it as text", name);
  if (!st) st = thr_scan_start(&d.scan, text, n, name, err);
  if (!st) st = read_sections(&d);
  if (!st) st = choose_layers(&d);
  if (!st) st = place_model(&d);
  if (!st) st = fill_draft(&d);
  thr_parts_finish(&d.parts, report);
  destroy(&d);
  return st;
}

/* Does the text begin with a section, after comments? */
static bool is_dxf(const char *text, size_t n)
{
  thr_scan scan;
  thr_span code = {0}, value = {0};
  if (n >= sizeof binary - 1 && memcmp(text, binary, sizeof binary - 1) == 0) return true;
  const char *nul = n ? memchr(text, '\0', n) : NULL;
  if (thr_scan_start(&scan, text, nul ? (size_t)(nul - text) : n, "", NULL)) return false;
  while (thr_scan_line(&scan, &code) && thr_scan_line(&scan, &value) &&
         thr_span_is(thr_span_trim(code), "999")) {
  }
  return thr_span_is(thr_span_trim(code), "0") && thr_span_is(thr_span_trim(value), "SECTION");
}

const thr_format thr_dxf_format = {
    .name = "dxf", .ending = {"dxf"}, .parse = parse, .is = is_dxf, .write = thr_dxf_write};
