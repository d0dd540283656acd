/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads DXF, the drawing exchange format of AutoCAD, as text: LINE, LWPOLYLINE, POLYLINE (2-D, 3-D,
 * meshes and polyface meshes), 3DFACE, SPLINE, ARC and ELLIPSE, and INSERT of blocks, nested and in
 * arrays. Source: Autodesk, "DXF Reference".
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

/* Limits that keep a small malicious file from taking all memory and time. */
enum {
  MOST_NESTED = 16,        /* depth of blocks in blocks */
  MOST_INSERTED = 1000000, /* insertions of all blocks together */
  MOST_PLACED = 20000000   /* points, and entities, of all insertions together */
};

/* An affine map: x' = m x + t. */
typedef struct {
  double m[3][3], t[3];
} placing;

static const char binary[] = "AutoCAD Binary DXF"; /* how such files begin */

static const placing unmoved = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};

/* A group code and its value, without blanks at both ends. */
typedef struct {
  int code;
  thr_span value;
} pair;

/* PATH: an open run of points; RING: a closed one; INSERT: a block; UNUSED: a record of a type that
 * is not read; UNSEEN: one that is invisible or on paper. */
typedef enum { PATH, RING, INSERT, UNUSED, UNSEEN } shape_kind;

/* What a shape's layer may be besides a number: ON_ZERO, layer 0, which stands for the layer of the
 * INSERT when it is in a block; SHOWN, a layer that is not hidden. */
enum { ON_ZERO = -1, SHOWN = INT_MAX };

/* The points center + cos(t) major + sin(t) minor. */
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

/* A piece of a block, by kind. Records that are only counted are shapes as well, because they count
 * as often as their block is inserted. */
typedef struct {
  shape_kind kind;
  int first, last;     /* PATH, RING: points; INSERT: which of inserted; UNUSED: which of unused */
  double curve_length; /* PATH of two points: how long the curve between them is, 0 = straight */
  int curve;           /* the curve, if curve_length is not 0 */
  int layer; /* number of the part, or without --pick of the hidden layer, or SHOWN; ON_ZERO */
} shape;

/* A named group of shapes [first, last). */
typedef struct {
  thr_span name; /* empty: a section ENTITIES, whose shapes are the model's */
  double base[3];
  int first, last; /* shapes */
  bool external;   /* it stands for another file */
} block;

/* An INSERT: the block and the map from its coordinates, moved by its base, to those of the
 * inserter. */
typedef struct {
  thr_span block;
  placing place;
} insertion;

/* A layer that is not shown. An INSERT on a frozen layer is hidden as a whole; an INSERT on a layer
 * that is off hides only the shapes on layer 0 of the block, which take the layer of the INSERT. */
typedef struct {
  thr_span name;
  bool frozen;
  int n_edges; /* on it, left out */
} hidden_layer;

/* The state of one reading: text, entity being read, shapes of all blocks, and what has been
 * placed. */
typedef struct {
  thr_scan scan;
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  bool ended; /* next is 0 EOF */
  pair next;  /* looked at, not yet taken */
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
} dxf_reader;

/* ---- pairs and entities ---- */

/* Reads the next pair into reader->next. THR_EINPUT if the text ends before the pair 0 EOF: what is
 * missing may be edges, and the last number may have lost digits. */
static thr_status read_next_pair(dxf_reader *reader)
{
  thr_span code, value;
  int number;

  /* A blank line at the end belongs to no pair. */
  if (!thr_scan_line(&reader->scan, &code) ||
      (!thr_span_trim(code).n && reader->scan.at >= reader->scan.end))
    return thr_scan_fail(&reader->scan, reader->err,
                         "the file ends without EOF: it is cut off; export it again");

  /* A code that is no number means that the two lines of a pair are out of step. */
  if (!thr_span_int(thr_span_trim(code), &number))
    return thr_scan_fail(
        &reader->scan, reader->err,
        "'%.*s' is no group code; a DXF file is pairs of lines, a number and a value",
        thr_span_width(code), code.s);

  if (!thr_scan_line(&reader->scan, &value))
    return thr_scan_fail(&reader->scan, reader->err,
                         "the file ends in the middle of a pair: it is cut off; export it again");

  reader->next = (pair){number, thr_span_trim(value)};
  reader->ended = number == 0 && thr_span_is(reader->next.value, "EOF");
  return THR_OK;
}

/* Reads the entity that reader->next begins, as far as the next pair with code 0, into
 * reader->pair. */
static thr_status take_entity(dxf_reader *reader)
{
  reader->type = reader->next.value;
  reader->type_line = reader->scan.line;
  reader->n_pairs = 0;
  thr_status st = read_next_pair(reader);

  /* All pairs up to the next entity; their number is not known before. */
  while (!st && reader->next.code != 0) {
    st = thr_grow(&reader->pair, reader->n_pairs, &reader->pairs_capacity, sizeof *reader->pair,
                  reader->err);
    if (!st) reader->pair[reader->n_pairs++] = reader->next;
    if (!st) st = read_next_pair(reader);
  }

  return st;
}

/* Records THR_EINPUT with the type and the line of the entity being read. */
static thr_status fail(dxf_reader *reader, const char *what)
{
  reader->scan.line = reader->type_line;
  return thr_scan_fail(&reader->scan, reader->err, "this %.*s %s", thr_span_width(reader->type),
                       reader->type.s, what);
}

/* Returns the first pair with the code, or NULL if there is none. */
static const pair *find_pair(const dxf_reader *reader, int code)
{
  for (int i = 0; i < reader->n_pairs; i++)
    if (reader->pair[i].code == code) return &reader->pair[i];
  return NULL;
}

/* Reads a pair's value as a finite number. */
static thr_status number_of(dxf_reader *reader, const pair *found, double *x)
{
  return thr_span_number(found->value, false, x)
             ? THR_OK
             : fail(reader, "has a value that is not a finite number");
}

/* Reads the number with the code; *x becomes `otherwise` if the entity has no such pair. */
static thr_status read_number(dxf_reader *reader, int code, double otherwise, double *x)
{
  const pair *found = find_pair(reader, code);
  *x = otherwise;
  return found ? number_of(reader, found, x) : THR_OK;
}

/* Reads the integer with the code; *n becomes 0 if the entity has no such pair. */
static thr_status read_int(dxf_reader *reader, int code, int *n)
{
  const pair *found = find_pair(reader, code);
  *n = 0;
  return !found || thr_span_int(found->value, n)
             ? THR_OK
             : fail(reader, "has a value that is not a whole number");
}

/* Reads the point whose codes are code, code + 10 and code + 20. Coordinates that are missing are
 * 0. */
static thr_status read_point(dxf_reader *reader, int code, double xyz[3])
{
  thr_status st = THR_OK;
  for (int k = 0; k < 3 && !st; k++)
    st = read_number(reader, code + 10 * k, 0, &xyz[k]);
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

/* Returns whether two names of a table of the drawing are the same. Their letter case does not
 * matter. */
static bool same_name(thr_span a, thr_span b)
{
  bool same = a.n == b.n;
  for (size_t i = 0; i < a.n && same; i++) {
    /* The byte before tells whether this one is the second one of a letter. */
    const unsigned char before = i ? (unsigned char)a.s[i - 1] : 0;
    same = small(before, (unsigned char)a.s[i]) == small(before, (unsigned char)b.s[i]);
  }
  return same;
}

/* Returns whether the entity is on paper instead of in the model (code 67), or invisible (code
 * 60). */
static bool is_unseen(const dxf_reader *reader)
{
  const pair *paper = find_pair(reader, 67), *hidden = find_pair(reader, 60);
  return (paper && thr_span_is(paper->value, "1")) || (hidden && thr_span_is(hidden->value, "1"));
}

/* ---- coordinates ---- */

/* Computes out = m in: the image of a direction. in and out may be the same array. */
static void turn(const placing *place, const double in[3], double out[3])
{
  double r[3];
  for (int i = 0; i < 3; i++)
    r[i] = thr_dot(place->m[i], in);
  memcpy(out, r, sizeof r);
}

/* Computes out = m in + t: the image of a point. */
static void apply(const placing *place, const double in[3], double out[3])
{
  turn(place, in, out);
  for (int i = 0; i < 3; i++)
    out[i] += place->t[i];
}

/* Returns by what factor the map stretches all directions, mirrored or not, or 0 if the factors
 * differ. m stretches all alike if and only if m^T m is a multiple of the identity matrix. */
static double even_scale(const placing *place)
{
  double dot[3][3];

  /* dot = m^T m: the scalar products of the images of the axes. */
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      dot[i][j] = place->m[0][i] * place->m[0][j] + place->m[1][i] * place->m[1][j] +
                  place->m[2][i] * place->m[2][j];

  /* The images are equally long and pairwise orthogonal, up to rounding. */
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      if (!(fabs(dot[i][j] - (i == j ? dot[0][0] : 0)) <= 1e-12 * dot[0][0])) return 0;

  return sqrt(dot[0][0]);
}

/* Returns the composition of two maps: first b, then a. */
static placing after(const placing *a, const placing *b)
{
  placing both;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      both.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
    both.t[i] = thr_dot(a->m[i], b->t) + a->t[i];
  }
  return both;
}

/* Computes the map from an entity's own coordinates, which the direction of their z axis tells
 * (codes 210 to 230), to those of the block: the "arbitrary axis algorithm" of the DXF
 * Reference. */
static thr_status own_coordinates(dxf_reader *reader, placing *place)
{
  double z[3], x[3], y[3];
  *place = unmoved;

  /* Without a direction the entity's coordinates are the block's. */
  thr_status st = read_point(reader, 210, z);
  if (st || thr_normalize(z) == 0) return st;

  /* x is orthogonal to z and to the world's z axis, or to the world's y axis if z is close to the
   * world's z axis. */
  const double world_y[3] = {0, 1, 0}, world_z[3] = {0, 0, 1};
  thr_cross(fabs(z[0]) < 1. / 64 && fabs(z[1]) < 1. / 64 ? world_y : world_z, z, x);
  thr_normalize(x);
  thr_cross(z, x, y);

  /* The columns of m are the images of the three axes. */
  for (int i = 0; i < 3; i++) {
    place->m[i][0] = x[i];
    place->m[i][1] = y[i];
    place->m[i][2] = z[i];
  }

  return THR_OK;
}

/* ---- shapes ---- */

/* Appends a point, which has the coordinates xyz in place. */
static thr_status add_point(dxf_reader *reader, const placing *place, const double xyz[3])
{
  thr_status st = thr_grow(&reader->point, reader->n_points, &reader->points_capacity,
                           sizeof *reader->point, reader->err);
  if (!st) apply(place, xyz, reader->point[reader->n_points++]);
  return st;
}

/* Appends the shape whose points were added since first, on the layer of the entity being read. */
static thr_status add_shape(dxf_reader *reader, shape_kind kind, int first, int last,
                            double curve_length)
{
  thr_status st = thr_grow(&reader->shape, reader->n_shapes, &reader->shapes_capacity,
                           sizeof *reader->shape, reader->err);
  if (!st)
    reader->shape[reader->n_shapes++] =
        (shape){kind, first, last, curve_length, reader->n_curves - 1, reader->layer};
  return st;
}

/* Appends the entity as one that is not used, to be counted by its type, or by a name that says
 * more than the type. */
static thr_status leave_out(dxf_reader *reader, const char *name)
{
  thr_status st = thr_grow(&reader->unused, reader->n_unused, &reader->unused_capacity,
                           sizeof *reader->unused, reader->err);
  if (st) return st;
  reader->unused[reader->n_unused] = name ? thr_span_of(name) : reader->type;
  return add_shape(reader, UNUSED, reader->n_unused++, 0, 0);
}

/* Appends the edge from a to b. curve_length: 0 = straight. */
static thr_status add_segment(dxf_reader *reader, const placing *place, const double a[3],
                              const double b[3], double curve_length)
{
  int first = reader->n_points;
  thr_status st = add_point(reader, place, a);
  if (!st) st = add_point(reader, place, b);
  return st ? st : add_shape(reader, PATH, first, reader->n_points, curve_length);
}

/* ---- curves ---- */

/* Computes the point of an ellipse at the angle t (rad); a thr_curve_point. */
static void ellipse_point(const void *arc, double t, double xyz[3])
{
  const ellipse *e = arc;
  for (int k = 0; k < 3; k++)
    xyz[k] = e->center[k] + cos(t) * e->major[k] + sin(t) * e->minor[k];
}

/* Computes the length of an ellipse from one angle to another (rad). A circle's is radius times
 * angle. Others are summed by quarters, because a thin ellipse turns sharply between two
 * quarters. */
static double ellipse_length(const ellipse *e, double from, double to)
{
  double length = 0;
  const double square = thr_dot(e->major, e->major);

  if (thr_dot(e->major, e->minor) == 0 && thr_dot(e->minor, e->minor) == square)
    return sqrt(square) * (to - from);

  /* Each part is at most a quarter; 1e-9 keeps rounding from adding an empty one. */
  const int n = (int)ceil((to - from) / (THR_PI / 2) - 1e-9);
  for (int i = 0; i < n; i++)
    length += thr_curve_length(ellipse_point, e, from + (to - from) * i / n,
                               from + (to - from) * (i + 1) / n);

  return length;
}

/* Releases the arrays of a spline. */
static void free_curve(curve *spline)
{
  free(spline->control);
  free(spline->weight);
  free(spline->knot);
}

/* Returns the spline of a curve, which borrows its arrays. */
static thr_spline spline_of(const curve *spline)
{
  return (thr_spline){spline->degree, spline->n, (const double(*)[3])spline->control,
                      spline->weight, spline->knot};
}

/* Takes the curve over, also on failure, and appends the edge from a to b along the curve. */
static thr_status add_curve(dxf_reader *reader, const placing *place, const double a[3],
                            const double b[3], curve *taken, double length)
{
  thr_status st = thr_grow(&reader->curve, reader->n_curves, &reader->curves_capacity,
                           sizeof *reader->curve, reader->err);

  /* The caller need not know whether the curve was taken. */
  if (st) {
    free_curve(taken);
    return st;
  }

  reader->curve[reader->n_curves++] = *taken;
  return add_segment(reader, place, a, b, length);
}

/* Appends a part of an ellipse that lies in the coordinates `place` as one edge. */
static thr_status add_arc(dxf_reader *reader, const placing *place, const ellipse *e, double from,
                          double to, double length)
{
  double a[3], b[3];
  curve part = {.from = from, .to = to};

  /* The edge's ends are points; of the axes only directions and lengths are kept, which is all that
   * the length depends on. */
  ellipse_point(e, from, a);
  ellipse_point(e, to, b);
  turn(place, e->major, part.arc.major);
  turn(place, e->minor, part.arc.minor);

  return add_curve(reader, place, a, b, &part, length);
}

/* Appends a segment of a polyline. Its bulge is tan(angle / 4) of the arc's angle, 0 = straight,
 * positive = counterclockwise. halved: the arc becomes two edges that meet in its middle. */
static thr_status add_bulge(dxf_reader *reader, const placing *place, const double a[3],
                            const double b[3], double bulge, bool halved)
{
  const double angle = 4 * atan(fabs(bulge)), half = sin(angle / 2), way = bulge < 0 ? -1 : 1;

  if (bulge == 0 || half <= 0) return add_segment(reader, place, a, b, 0);

  /* The centre is on the chord's perpendicular bisector, to the left of the chord where the bulge
   * is between 0 and 1. The radius is chord / (2 sin(angle / 2)). */
  const double aside = (1 - bulge * bulge) / (4 * bulge),
               length = thr_distance(a, b) * angle / (2 * half);
  const double center[3] = {(a[0] + b[0]) / 2 - aside * (b[1] - a[1]),
                            (a[1] + b[1]) / 2 + aside * (b[0] - a[0]), a[2]};

  /* From the first end the arc turns the way that the bulge's sign says. */
  const double radius[2] = {a[0] - center[0], a[1] - center[1]};
  const ellipse e = {{center[0], center[1], center[2]},
                     {radius[0], radius[1], 0},
                     {-way * radius[1], way * radius[0], 0}};
  if (!halved) return add_arc(reader, place, &e, 0, angle, length);

  thr_status st = add_arc(reader, place, &e, 0, angle / 2, length / 2);
  return st ? st : add_arc(reader, place, &e, angle / 2, angle, length / 2);
}

/* Appends reader->vertex as segments. Two arcs between the same two vertices, like those of a
 * circle, would fall together as one edge, so both get a node in their middle. */
static thr_status add_polyline(dxf_reader *reader, const placing *place, bool closed)
{
  thr_status st = THR_OK;
  const int n = reader->n_vertices;
  const bool lens = closed && n == 2 && (reader->bulge[0] != 0 || reader->bulge[1] != 0);

  /* A closed polyline of two straight vertices has one side, not two. */
  for (int i = 0; i < (closed && (n > 2 || lens) ? n : n - 1) && !st; i++) {
    const double *a = reader->vertex[i], *b = reader->vertex[(i + 1) % n], bulge = reader->bulge[i];
    st = add_bulge(reader, place, a, b, bulge, lens);
  }

  return st;
}

/* Appends a vertex of the polyline being read, and the bulge of the segment after the vertex. */
static thr_status add_vertex(dxf_reader *reader, const double xyz[3], double bulge)
{
  thr_status st = thr_grow(&reader->vertex, reader->n_vertices, &reader->vertices_capacity,
                           sizeof *reader->vertex, reader->err);

  if (!st)
    st = thr_grow(&reader->bulge, reader->n_vertices, &reader->bulge_capacity,
                  sizeof *reader->bulge, reader->err);
  if (st) return st;
  memcpy(reader->vertex[reader->n_vertices], xyz, sizeof *reader->vertex);

  reader->bulge[reader->n_vertices++] = bulge;
  return THR_OK;
}

/* ---- the entities ---- */

/* Reads a LINE: one edge. */
static thr_status read_line(dxf_reader *reader)
{
  double a[3], b[3];
  thr_status st = read_point(reader, 10, a);
  if (!st) st = read_point(reader, 11, b);
  return st ? st : add_segment(reader, &unmoved, a, b, 0);
}

/* Reads a LWPOLYLINE, whose vertices are pairs of the entity itself: 10 begins a vertex, 20 and 42
 * add to it. */
static thr_status read_lwpolyline(dxf_reader *reader)
{
  placing own;
  double z, x;
  int flags = 0;

  reader->n_vertices = 0;

  /* The elevation (38) is the z of all vertices. */
  thr_status st = own_coordinates(reader, &own);
  if (!st) st = read_number(reader, 38, 0, &z);
  if (!st) st = read_int(reader, 70, &flags);

  /* The vertices, in the order of the pairs. */
  for (int i = 0; i < reader->n_pairs && !st; i++) {
    const int code = reader->pair[i].code;
    if (code != 10 && code != 20 && code != 42) continue;
    if (code != 10 && reader->n_vertices == 0)
      return fail(reader, "has a coordinate before its first vertex");
    st = number_of(reader, &reader->pair[i], &x);
    if (!st && code == 10) st = add_vertex(reader, (double[3]){x, 0, z}, 0);
    if (!st && code == 20) reader->vertex[reader->n_vertices - 1][1] = x;
    if (!st && code == 42) reader->bulge[reader->n_vertices - 1] = x;
  }

  return st ? st : add_polyline(reader, &own, flags & 1);
}

/* Reads a 3DFACE of three or four corners. Invisible sides (bits of code 70) are no edges; a face
 * without invisible sides counts as a face for --flat, too. The last side of a triangle is the
 * fourth side of a face whose third side has no length, so its bit is the fourth. */
static thr_status read_face(dxf_reader *reader)
{
  double corner[4][3];
  int hidden, n = 4;
  thr_status st = read_int(reader, 70, &hidden);

  for (int i = 0; i < 4 && !st; i++)
    st = read_point(reader, 10 + i, corner[i]);
  if (st) return st;

  /* A triangle repeats its third corner, or leaves out the fourth. */
  if (!find_pair(reader, 13) || (corner[2][0] == corner[3][0] && corner[2][1] == corner[3][1] &&
                                 corner[2][2] == corner[3][2]))
    n = 3;

  /* All sides visible: a face. */
  int first = reader->n_points;
  for (int i = 0; i < n && !st && !(hidden & 15); i++)
    st = add_point(reader, &unmoved, corner[i]);

  if (!(hidden & 15)) return st ? st : add_shape(reader, RING, first, reader->n_points, 0);

  /* Otherwise: its visible sides. */
  for (int i = 0; i < n && !st; i++)
    if (!(hidden >> (i == n - 1 ? 3 : i) & 1))
      st = add_segment(reader, &unmoved, corner[i], corner[(i + 1) % n], 0);

  return st;
}

/* Returns whether a curve ends where it begins. Such a curve leads from no node to another one. */
static bool is_closed(const double a[3], const double b[3], double length)
{
  return length > 0 && thr_distance(a, b) <= 1e-6 * length;
}

/* Appends a part of an ellipse as an edge, counterclockwise from one angle to the other (rad), less
 * than all of it. */
static thr_status add_ellipse(dxf_reader *reader, const placing *place, const ellipse *e,
                              double from, double to)
{
  double a[3], b[3];

  /* `to` is brought to at most one turn after `from`: (0, 2 pi]. */
  const double turns = (to - from) / (2 * THR_PI);
  if (!(turns > 0 && turns <= 1)) to = from + 2 * THR_PI * (turns - ceil(turns) + 1);
  const double length = ellipse_length(e, from, to);
  ellipse_point(e, from, a);
  ellipse_point(e, to, b);

  return is_closed(a, b, length) ? leave_out(reader, "a closed curve")
                                 : add_arc(reader, place, e, from, to, length);
}

/* Reads an ARC of a circle: centre 10, radius 40, from angle 50 to angle 51 (degrees),
 * counterclockwise. */
static thr_status read_arc(dxf_reader *reader)
{
  placing own;
  ellipse e = {0};
  double radius, from, to;
  thr_status st = own_coordinates(reader, &own);

  /* Centre, radius, and angles in degrees. */
  if (!st) st = read_point(reader, 10, e.center);
  if (!st) st = read_number(reader, 40, 0, &radius);
  if (!st) st = read_number(reader, 50, 0, &from);
  if (!st) st = read_number(reader, 51, 360, &to);
  if (st) return st;

  /* Beyond this an angle modulo 360 degrees has lost too many digits. */
  if (fabs(from) > 1e6 || fabs(to) > 1e6)
    return fail(reader, "has angles of more than a million degrees");

  /* A circle is an ellipse with equal axes. */
  e.major[0] = e.minor[1] = radius;
  return add_ellipse(reader, &own, &e, from * THR_PI / 180, to * THR_PI / 180);
}

/* Reads an ELLIPSE: centre 10, half of the major axis 11, ratio of the axes 40, from parameter 41
 * to 42 (rad). */
static thr_status read_ellipse(dxf_reader *reader)
{
  ellipse e = {0};
  double ratio, from, to, normal[3];
  thr_status st = read_point(reader, 10, e.center);

  /* Half of the major axis, the normal, the ratio of the axes, and the parameters in rad. */
  if (!st) st = read_point(reader, 11, e.major);
  if (!st) st = read_point(reader, 210, normal);
  if (!st) st = read_number(reader, 40, 1, &ratio);
  if (!st) st = read_number(reader, 41, 0, &from);
  if (!st) st = read_number(reader, 42, 2 * THR_PI, &to);
  if (st) return st;

  /* As of an ARC's angles. */
  if (fabs(from) > 1e6 || fabs(to) > 1e6)
    return fail(reader, "has parameters of more than a million");

  /* Without an extrusion direction the normal is the z axis. The minor axis is orthogonal to the
   * normal and to the major axis. */
  if (thr_normalize(normal) == 0) normal[2] = 1;
  thr_cross(normal, e.major, e.minor);
  for (int k = 0; k < 3; k++)
    e.minor[k] *= ratio;

  return add_ellipse(reader, &unmoved, &e, from, to);
}

/* Collects all values with the code in an array *out[*n], which the caller frees, also on
 * failure. */
static thr_status read_values(dxf_reader *reader, int code, double **out, int *n)
{
  thr_status st = THR_OK;
  *n = 0;

  /* No more values than pairs. */
  if (!(*out = thr_calloc((size_t)reader->n_pairs, sizeof **out))) return thr_nomem(reader->err);
  for (int i = 0; i < reader->n_pairs && !st; i++)
    if (reader->pair[i].code == code) st = number_of(reader, &reader->pair[i], &(*out)[(*n)++]);

  return st;
}

/* Appends a spline. Degree 1: a polyline through its control points. Higher: one edge from
 * beginning to end, as long as the curve, which is taken over and left without its arrays. */
static thr_status use_spline(dxf_reader *reader, curve *read, int n_knots, int n_weights)
{
  const thr_spline spline = spline_of(read);

  if (read->degree == 1) {
    thr_status st = THR_OK;
    for (int i = 0; i + 1 < read->n && !st; i++)
      st = add_segment(reader, &unmoved, read->control[i], read->control[i + 1], 0);
    return st;
  }

  /* A spline whose arrays do not fit together is counted as a record that is not used. */
  if (n_knots - read->n - 1 != read->degree || (n_weights && n_weights != read->n) ||
      !thr_spline_is_sound(&spline))
    return leave_out(reader, NULL);

  /* The ends of the parameter range are the knots number degree and n. */
  double a[3], b[3];
  thr_spline_point(&spline, spline.knot[spline.degree], a);
  thr_spline_point(&spline, spline.knot[spline.n], b);
  const double length = thr_spline_length(&spline);
  if (is_closed(a, b, length)) return leave_out(reader, "a closed curve");

  curve taken = *read;
  *read = (curve){0};
  return add_curve(reader, &unmoved, a, b, &taken, length);
}

/* Reads a SPLINE: degree 71, knots 40, weights 41, control points 10, 20, 30. */
static thr_status read_spline(dxf_reader *reader)
{
  double *value[3] = {0}; /* x, y, z */
  static const int code[3] = {10, 20, 30};
  curve read = {0};
  int n[3] = {0}, n_knots = 0, n_weights = 0;
  thr_status st = read_int(reader, 71, &read.degree);

  /* Each coordinate, the knots and the weights are a list of their own. */
  for (int i = 0; i < 3 && !st; i++)
    st = read_values(reader, code[i], &value[i], &n[i]);

  if (!st) st = read_values(reader, 40, &read.knot, &n_knots);
  if (!st) st = read_values(reader, 41, &read.weight, &n_weights);
  if (!find_pair(reader, 71)) read.degree = n_knots - n[0] - 1; /* trimesh does not say it */

  /* A spline may say only the points that it goes through (codes 11, 21, 31); these are not enough
   * here. */
  const bool controlled = n[0] >= 2 && n[1] == n[0] && (!n[2] || n[2] == n[0]);
  if (!st && !controlled) st = leave_out(reader, NULL);
  if (!st && controlled && !(read.control = thr_calloc((size_t)n[0], sizeof *read.control)))
    st = thr_nomem(reader->err);

  /* Pair up the coordinates; a spline without z lies at 0, one without weights is not rational. */
  if (!st && controlled) {
    for (int i = 0; i < n[0]; i++)
      for (int k = 0; k < 3; k++)
        read.control[i][k] = n[k] ? value[k][i] : 0;
    if (!n_weights) {
      free(read.weight);
      read.weight = NULL;
    }
    read.n = n[0];
    st = use_spline(reader, &read, n_knots, n_weights);
  }

  free_curve(&read);
  for (int i = 0; i < 3; i++)
    free(value[i]);

  return st;
}

/* ---- POLYLINE: its vertices are entities of their own ---- */

/* Bits of code 70 of a POLYLINE, and of a VERTEX. */
enum { CLOSED = 1, SPLINE_FIT = 4, SPACE = 8, MESH = 16, CLOSED_N = 32, POLYFACE = 64 };
enum { FRAME_POINT = 16, FACE_RECORD = 128, FACE_PLACE = 64 };

/* Reads a face record of a polyface mesh: numbers of vertices from 1, negative where the side after
 * the vertex is hidden. */
static thr_status read_face_record(dxf_reader *reader)
{
  thr_status st = THR_OK;

  /* Zero stands for no vertex. */
  int corner[4] = {0}, n = 0;
  for (int i = 0; i < 4 && !st; i++) {
    int v;
    st = read_int(reader, 71 + i, &v);
    if (!st && v) corner[n++] = v;
  }

  /* Each visible side is an edge. */
  for (int i = 0; i < n && !st; i++) {
    int a = abs(corner[i]), b = abs(corner[(i + 1) % n]);
    if (a > reader->n_vertices || b > reader->n_vertices)
      return fail(reader, "names a vertex that does not exist");
    if (corner[i] > 0 && n > 1)
      st = add_segment(reader, &unmoved, reader->vertex[a - 1], reader->vertex[b - 1], 0);
  }

  return st;
}

/* Reads a VERTEX of a POLYLINE with these flags: a point, or a face of a polyface mesh. Control
 * points of a smoothed curve are left out. */
static thr_status read_vertex(dxf_reader *reader, int polyline_flags)
{
  double xyz[3], bulge;
  int flags;
  thr_status st = read_int(reader, 70, &flags);

  /* Points of the frame of a smoothed curve are not on the curve. */
  if (st || flags & FRAME_POINT) return st;

  if (polyline_flags & POLYFACE && flags & FACE_RECORD && !(flags & FACE_PLACE))
    return read_face_record(reader);

  /* Only vertices in the plane have a bulge. */
  st = read_point(reader, 10, xyz);
  if (!st) st = read_number(reader, 42, 0, &bulge);
  return st ? st : add_vertex(reader, xyz, polyline_flags & (SPACE | MESH | POLYFACE) ? 0 : bulge);
}

/* Appends the edges of an m x n mesh of vertices, row by row; a closed direction joins its last
 * line to its first one. Two lines are joined already, so closing them adds nothing. */
static thr_status add_mesh(dxf_reader *reader, int m, int n, bool closed_m, bool closed_n)
{
  thr_status st = THR_OK;

  if (m < 1 || n < 1 || (int64_t)m * n > reader->n_vertices)
    return fail(reader, "has fewer vertices than its mesh needs");

  /* From each vertex an edge to the next row and one to the next column. */
  for (int i = 0; i < m && !st; i++)
    for (int j = 0; j < n && !st; j++) {
      const double *here = reader->vertex[i * n + j];
      if (i + 1 < m || (closed_m && m > 2))
        st = add_segment(reader, &unmoved, here, reader->vertex[(i + 1) % m * n + j], 0);
      if (!st && (j + 1 < n || (closed_n && n > 2)))
        st = add_segment(reader, &unmoved, here, reader->vertex[i * n + (j + 1) % n], 0);
    }

  return st;
}

/* Reads a POLYLINE with the VERTEX entities that follow: a curve in the plane, one in space, a
 * mesh, or a polyface mesh. */
static thr_status read_polyline(dxf_reader *reader)
{
  placing own;
  int flags, m, n;
  double elevation;
  const pair *height = find_pair(reader, 30) ? find_pair(reader, 30) : find_pair(reader, 38);
  const bool unseen = is_unseen(reader);

  const int first_shape = reader->n_shapes;
  thr_status st = read_int(reader, 70, &flags);

  /* The vertices of a smoothed mesh that are not control points are a mesh of its own density. */
  const bool smooth = !st && (flags & (MESH | SPLINE_FIT)) == (MESH | SPLINE_FIT);
  if (!st) st = read_int(reader, smooth ? 73 : 71, &m);
  if (!st) st = read_int(reader, smooth ? 74 : 72, &n);

  /* The elevation of a 2-D polyline is the z of code 30, or 38. */
  elevation = 0;
  if (!st && height) st = number_of(reader, height, &elevation);
  if (!st) st = own_coordinates(reader, &own);

  /* The vertices up to SEQEND. */
  reader->n_vertices = 0;
  while (!st && thr_span_is(reader->next.value, "VERTEX")) {
    st = take_entity(reader);
    if (!st) st = read_vertex(reader, flags);
  }

  if (!st && thr_span_is(reader->next.value, "SEQEND")) st = take_entity(reader);

  /* All vertices of a 2-D polyline have its elevation. Where that is 0 those that say a height of
   * their own keep it. */
  for (int i = 0; i < reader->n_vertices && elevation != 0 && !(flags & (SPACE | MESH | POLYFACE));
       i++)
    reader->vertex[i][2] = elevation;

  /* Polyface meshes have added their edges face by face. */
  if (!st && flags & MESH)
    st = add_mesh(reader, m, n, flags & CLOSED, flags & CLOSED_N);
  else if (!st && !(flags & POLYFACE))
    st = add_polyline(reader, flags & SPACE ? &unmoved : &own, flags & CLOSED);

  /* The whole is unseen if its head is: drop what was added, and count it. */
  if (st || !unseen) return st;
  reader->n_shapes = first_shape;
  return add_shape(reader, UNSEEN, 0, 0, 0);
}

/* ---- blocks ---- */

/* Appends an INSERT of the named block at the place. */
static thr_status add_insertion(dxf_reader *reader, thr_span name, const placing *place)
{
  thr_status st = thr_grow(&reader->inserted, reader->n_inserted, &reader->inserted_capacity,
                           sizeof *reader->inserted, reader->err);
  if (st) return st;
  reader->inserted[reader->n_inserted] = (insertion){name, *place};
  return add_shape(reader, INSERT, reader->n_inserted++, 0, 0);
}

/* Reads an INSERT: the block is scaled (41 to 43), turned about z by an angle (50, degrees), moved
 * (10), and repeated in columns and rows (70, 71) at a distance (44, 45). */
static thr_status read_insert(dxf_reader *reader)
{
  placing own, local = unmoved;
  double scale[3], turn, step[2];
  int columns, rows;
  const pair *name = find_pair(reader, 2);

  if (!name) return fail(reader, "names no block");

  /* The parameters. */
  thr_status st = own_coordinates(reader, &own);
  if (!st) st = read_point(reader, 10, local.t);
  for (int k = 0; k < 3 && !st; k++)
    st = read_number(reader, 41 + k, 1, &scale[k]);

  if (!st) st = read_number(reader, 50, 0, &turn);
  if (!st) st = read_int(reader, 70, &columns);
  if (!st) st = read_int(reader, 71, &rows);
  if (!st) st = read_number(reader, 44, 0, &step[0]);
  if (!st) st = read_number(reader, 45, 0, &step[1]);
  if (st) return st;

  /* m = rotation times scales; z is only scaled. */
  const double cosine = cos(turn * THR_PI / 180), sine = sin(turn * THR_PI / 180),
               at[3] = {local.t[0], local.t[1], local.t[2]};
  const double turned[2][2] = {{cosine, -sine}, {sine, cosine}};

  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      local.m[i][j] = turned[i][j] * scale[j];

  local.m[2][2] = scale[2];
  columns = columns > 1 ? columns : 1;
  rows = rows > 1 ? rows : 1;
  if ((int64_t)columns * rows > 100000) return fail(reader, "is repeated more than 100,000 times");

  /* One insertion for each cell; columns and rows follow the turned axes but are not scaled. */
  for (int row = 0; row < rows && !st; row++)
    for (int column = 0; column < columns && !st; column++) {
      for (int i = 0; i < 2; i++)
        local.t[i] = at[i] + turned[i][0] * column * step[0] + turned[i][1] * row * step[1];
      const placing place = after(&own, &local);
      st = add_insertion(reader, name->value, &place);
    }

  return st;
}

/* Returns the number of the hidden layer of this name, or SHOWN. */
static int find_hidden(const dxf_reader *reader, thr_span name)
{
  for (int i = 0; i < reader->n_hidden; i++)
    if (same_name(reader->hidden[i].name, name)) return i;
  return SHOWN;
}

/* Finds the layer of the entity that was taken (code 8), as reader->layer. */
static thr_status find_layer(dxf_reader *reader)
{
  const pair *named = find_pair(reader, 8);
  const thr_span name = named ? named->value : thr_span_of("0"), last = reader->layer_name;

  /* Consecutive entities mostly share a layer. */
  if (last.s && name.n == last.n && memcmp(name.s, last.s, name.n) == 0) return THR_OK;
  reader->layer_name = name;
  reader->layer = ON_ZERO;
  if (thr_span_is(name, "0")) return THR_OK;

  /* --pick asks for a layer by name, whether hidden or not. */
  if (reader->parts.asked) return thr_parts_find(&reader->parts, name, &reader->layer, reader->err);
  reader->layer = find_hidden(reader, name);
  return THR_OK;
}

/* Keeps a layer of the table if it is hidden: off, as a negative colour says, or frozen (bit 1 of
 * code 70). */
static thr_status read_layer(dxf_reader *reader)
{
  const pair *name = find_pair(reader, 2);
  int flags, colour;
  thr_status st = read_int(reader, 70, &flags);

  if (!st) st = read_int(reader, 62, &colour);

  /* A layer that is shown, or would be read anyway, needs no entry. */
  if (st || !name || !((flags & 1) || colour < 0) || reader->draft->all_layers ||
      reader->parts.asked)
    return st;

  st = thr_grow(&reader->hidden, reader->n_hidden, &reader->hidden_capacity, sizeof *reader->hidden,
                reader->err);
  if (!st) reader->hidden[reader->n_hidden++] = (hidden_layer){name->value, flags & 1, 0};

  return st;
}

/* Reads the section TABLES, of which only layers matter. */
static thr_status read_tables(dxf_reader *reader)
{
  thr_status st = THR_OK;
  while (!st && !reader->ended && !thr_span_is(reader->next.value, "ENDSEC")) {
    st = take_entity(reader);
    if (!st && thr_span_is(reader->type, "LAYER")) st = read_layer(reader);
  }
  return st;
}

/* Reads one entity by its type. */
static thr_status read_entity(dxf_reader *reader)
{
  static const struct {
    const char *type;
    thr_status (*read)(dxf_reader *);
  } known[] = {{"LINE", read_line},    {"LWPOLYLINE", read_lwpolyline},
               {"3DFACE", read_face},  {"SPLINE", read_spline},
               {"ARC", read_arc},      {"ELLIPSE", read_ellipse},
               {"INSERT", read_insert}};

  thr_status st = take_entity(reader);

  if (!st) st = find_layer(reader);
  if (st) return st;

  /* A POLYLINE is read even if unseen, because its vertices follow as entities of their own. */
  if (thr_span_is(reader->type, "POLYLINE")) return read_polyline(reader);
  if (is_unseen(reader)) return add_shape(reader, UNSEEN, 0, 0, 0);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(reader->type, known[i].type)) return known[i].read(reader);

  /* Attributes of an INSERT are text. Whatever else there is gets counted. */
  return thr_span_is(reader->type, "ATTRIB") || thr_span_is(reader->type, "SEQEND")
             ? THR_OK
             : leave_out(reader, NULL);
}

/* Reads entities up to the pair 0 that ends them. */
static thr_status read_entities(dxf_reader *reader, const char *end)
{
  thr_status st = THR_OK;
  while (!st && !reader->ended && !thr_span_is(reader->next.value, end))
    st = read_entity(reader);
  return st;
}

/* Reads a BLOCK up to its ENDBLK. */
static thr_status read_block(dxf_reader *reader)
{
  thr_status st = take_entity(reader);
  const pair *name = find_pair(reader, 2);
  int flags = 0;
  block read = {.name = name ? name->value : (thr_span){0}, .first = reader->n_shapes};

  if (!st) st = read_int(reader, 70, &flags);
  if (!st) st = read_point(reader, 10, read.base);

  /* Bits 4 and 8 mark an external reference and an overlay of one. */
  read.external = flags & (4 | 8);
  if (!st) st = read_entities(reader, "ENDBLK");
  if (read.name.n == 0) reader->n_shapes = read.first; /* nothing can insert it */
  read.last = reader->n_shapes;

  if (!st)
    st = thr_grow(&reader->block, reader->n_blocks, &reader->blocks_capacity, sizeof *reader->block,
                  reader->err);

  if (!st) reader->block[reader->n_blocks++] = read;
  if (!st && !reader->ended) st = take_entity(reader); /* ENDBLK */
  return st;
}

/* Reads the section BLOCKS. */
static thr_status read_blocks(dxf_reader *reader)
{
  thr_status st = THR_OK;
  while (!st && !reader->ended && !thr_span_is(reader->next.value, "ENDSEC"))
    st = thr_span_is(reader->next.value, "BLOCK") ? read_block(reader) : take_entity(reader);
  return st;
}

/* Reads the section HEADER, of which only the unit matters: code 70 after the variable
 * $INSUNITS. */
static thr_status read_header(dxf_reader *reader)
{
  int unit = 0;

  for (int i = 0; i + 1 < reader->n_pairs; i++)

    /* The code 9 names a variable; its value is the next pair. */
    if (reader->pair[i].code == 9 && thr_span_is(reader->pair[i].value, "$INSUNITS") &&
        reader->pair[i + 1].code == 70 && !thr_span_int(reader->pair[i + 1].value, &unit))
      return fail(reader, "has a $INSUNITS that is not a whole number");

  return thr_dxf_unit(unit) ? thr_draft_set_units(reader->draft, thr_dxf_unit(unit), reader->err)
                            : THR_OK;
}

/* Reads a section ENTITIES as a block without a name. A file may have several such sections. */
static thr_status read_model(dxf_reader *reader)
{
  block model = {.first = reader->n_shapes};
  thr_status st = read_entities(reader, "ENDSEC");

  model.last = reader->n_shapes;
  if (!st)
    st = thr_grow(&reader->block, reader->n_blocks, &reader->blocks_capacity, sizeof *reader->block,
                  reader->err);

  if (!st) reader->block[reader->n_blocks++] = model;
  return st;
}

/* Reads all sections up to EOF. */
static thr_status read_sections(dxf_reader *reader)
{
  thr_status st = read_next_pair(reader);

  while (!st && !reader->ended) {
    st = take_entity(reader);

    /* Code 2 of SECTION names the section. */
    const pair *said = thr_span_is(reader->type, "SECTION") ? find_pair(reader, 2) : NULL;
    if (st || !said) continue;
    const thr_span name = said->value;
    if (thr_span_is(name, "HEADER")) st = read_header(reader);
    if (!st && thr_span_is(name, "TABLES")) st = read_tables(reader);

    if (!st && thr_span_is(name, "BLOCKS")) st = read_blocks(reader);
    if (!st && thr_span_is(name, "ENTITIES")) st = read_model(reader);
  }

  return st;
}

/* ---- placing ---- */

/* Counts an insertion of a block that the file does not hold, and keeps the first one's name. */
static void miss_block(dxf_reader *reader, thr_span name)
{
  thr_read_report *report = reader->report;

  /* One name is enough for a note. */
  if (report->missing_blocks++) return;
  snprintf(report->missing_block, sizeof report->missing_block, "%.*s",
           name.n < 31 ? (int)name.n : 31, name.s);
  thr_text_clean(report->missing_block);
}

/* Finds the block of a name in the same letter case, else in any. *found is NULL if there is none.
 * THR_EINPUT if two such blocks are not empty. */
static thr_status find_block(const dxf_reader *reader, thr_span name, const block **found)
{
  bool exact = false, twice = false;
  *found = NULL;

  /* A block with shapes is better than an empty one; an exact name is better than one in another
   * case. */
  for (const block *b = reader->block; b < reader->block + reader->n_blocks; b++) {
    if (name.n == 0 || !same_name(b->name, name)) continue;
    const bool same = memcmp(b->name.s, name.s, name.n) == 0,
               better = !*found || (*found)->first == (*found)->last;
    if (exact && !same) continue;
    twice = same == exact && !better && b->first < b->last;
    if (same > exact || better) *found = b;
    exact |= same;
    if (twice) break;
  }

  /* Nobody can know which of two blocks is meant. */
  if (!twice) return THR_OK;
  return thr_fail(reader->err, THR_EINPUT,
                  "%s: two blocks are called '%.*s', and it is inserted; rename one of them",
                  reader->scan.name, thr_span_width(name), name.s);
}

/* Computes how long a curve is after the map: an ellipse stays an ellipse, and a spline moves with
 * its control points. */
static thr_status placed_length(dxf_reader *reader, const shape *piece, const placing *place,
                                double *length)
{
  const double scale = even_scale(place);
  const curve *original = &reader->curve[piece->curve];
  *length = piece->curve_length * scale;

  /* Similarities scale all lengths alike. */
  if (scale > 0) return THR_OK;
  if (original->n == 0) {
    ellipse e = {0};
    turn(place, original->arc.major, e.major);
    turn(place, original->arc.minor, e.minor);
    *length = ellipse_length(&e, original->from, original->to);
    return THR_OK;
  }

  /* Integrate again along the moved control points. */
  curve moved = *original;
  if (!(moved.control = thr_calloc((size_t)original->n, sizeof *moved.control)))
    return thr_nomem(reader->err);

  for (int i = 0; i < original->n; i++)
    turn(place, original->control[i], moved.control[i]);

  const thr_spline spline = spline_of(&moved);
  *length = thr_spline_length(&spline);
  free(moved.control);
  return THR_OK;
}

/* Appends the points of a path or ring, after the map, as a run of sites, with the length of the
 * run. */
static thr_status place_run(dxf_reader *reader, const shape *piece, const placing *place)
{
  double at[3];
  thr_status st = THR_OK;

  /* Blocks may be inserted in each other, so that a small file makes many points, or huge ones. */
  for (int i = piece->first; i < piece->last && !st; i++) {
    if (reader->sites.n >= MOST_PLACED)
      return thr_fail(reader->err, THR_EINPUT, "%s: more than %d points with all inserted blocks",
                      reader->scan.name, MOST_PLACED);
    apply(place, reader->point[i], at);
    if (!isfinite(at[0]) || !isfinite(at[1]) || !isfinite(at[2]))
      return thr_fail(reader->err, THR_EINPUT, "%s: an inserted block leaves the range of numbers",
                      reader->scan.name);
    st = thr_faces_corner(&reader->faces, reader->sites.n, reader->err);
    if (!st) st = thr_sites_add(&reader->sites, at, reader->err);
  }

  /* The length of the run that is about to be closed. */
  if (!st)
    st = thr_grow(&reader->length, reader->faces.n, &reader->length_capacity,
                  sizeof *reader->length, reader->err);
  if (st) return st;
  reader->length[reader->faces.n] = 0;

  /* A curve may be stretched. */
  if (piece->curve_length > 0)
    st = placed_length(reader, piece, place, &reader->length[reader->faces.n]);
  if (st) return st;

  if (!isfinite(reader->length[reader->faces.n]))
    return thr_fail(reader->err, THR_EINPUT, "%s: an inserted block leaves the range of numbers",
                    reader->scan.name);

  return thr_faces_close(&reader->faces, reader->err);
}

/* Places a path or ring, or counts a record that is left out. */
static thr_status place_one(dxf_reader *reader, const shape *piece, const placing *place)
{
  if (piece->kind == UNUSED) thr_report_skip(reader->report, reader->unused[piece->first]);
  reader->report->unseen_records += piece->kind == UNSEEN;
  return piece->kind == PATH || piece->kind == RING ? place_run(reader, piece, place) : THR_OK;
}

/* Places the shapes [first, last) and, recursively, the blocks that they insert. layer: the layer
 * of shapes on layer 0; frozen: the layer that hides them all, or SHOWN; depth: of the insertions
 * round them. */
static thr_status place_shapes(dxf_reader *reader, int first, int last, const placing *place,
                               int layer, int frozen, int depth)
{
  thr_status st = THR_OK;

  for (int i = first; i < last && !st; i++) {
    const shape *piece = &reader->shape[i];
    const int own = piece->layer >= 0 ? piece->layer : layer,
              hiding = frozen < reader->n_hidden ? frozen : own;

    /* What is left out counts as well, so that time is limited. */
    if (++reader->n_visited > MOST_PLACED)
      return thr_fail(reader->err, THR_EINPUT, "%s: more than %d entities with all inserted blocks",
                      reader->scan.name, MOST_PLACED);

    /* Hidden edges are counted by layer, for the report. */
    if (piece->kind != INSERT) {
      if (hiding >= 0 && hiding < reader->n_hidden)
        reader->hidden[hiding].n_edges +=
            piece->kind == RING ? piece->last - piece->first : piece->kind == PATH;
      else if (thr_parts_has(&reader->parts, own))
        st = place_one(reader, piece, place);
      continue;
    }

    /* The block may be in another file, or in none. */
    const insertion *inserted = &reader->inserted[piece->first];
    const block *inserted_block;
    st = find_block(reader, inserted->block, &inserted_block);
    if (st) return st;
    if (!inserted_block ||
        (inserted_block->external && inserted_block->first == inserted_block->last)) {
      miss_block(reader, inserted->block);
      continue;
    }
    if (depth == MOST_NESTED || ++reader->n_placed > MOST_INSERTED)
      return thr_fail(reader->err, THR_EINPUT,
                      "%s: blocks are nested more than %d deep, or inserted more than %d times",
                      reader->scan.name, MOST_NESTED, MOST_INSERTED);

    /* The block's base comes to lie on the insertion point, then the maps of all insertions apply
     * from the inside outwards. */
    placing base = unmoved;
    for (int k = 0; k < 3; k++)
      base.t[k] = -inserted_block->base[k];
    placing inner = after(&inserted->place, &base);
    inner = after(place, &inner);

    /* Only a frozen layer hides shapes on layers other than 0. */
    const bool freezes = hiding >= 0 && hiding < reader->n_hidden && reader->hidden[hiding].frozen;
    st = place_shapes(reader, inserted_block->first, inserted_block->last, &inner, own,
                      freezes ? hiding : SHOWN, depth + 1);
  }

  return st;
}

/* Places the blocks without names, and sums up what hidden layers have left out. */
static thr_status place_model(dxf_reader *reader)
{
  thr_status st = THR_OK;

  for (int i = 0; i < reader->n_blocks && !st; i++)
    if (reader->block[i].name.n == 0)
      st = place_shapes(reader, reader->block[i].first, reader->block[i].last, &unmoved,
                        reader->ground, SHOWN, 0);

  /* Layers that hide no edge are not worth a note. */
  for (int i = 0; i < reader->n_hidden; i++) {
    reader->report->hidden_edges += reader->hidden[i].n_edges;
    reader->report->hidden_layers += reader->hidden[i].n_edges > 0;
  }

  return st;
}

/* Fills the draft: sites at one place become one node, runs of two an edge, rings the sides of a
 * face. */
static thr_status fill_draft(dxf_reader *reader)
{
  /* Nothing was placed: say why. */
  if (reader->faces.n == 0 && reader->report->hidden_edges)
    return thr_fail(reader->err, THR_EINPUT,
                    "%s: all its edges are on hidden layers; --layers all reads them",
                    reader->scan.name);

  if (reader->faces.n == 0)
    return thr_fail(
        reader->err, THR_EINPUT,
        "%s: no lines, polylines, faces or open curves in its model%s%s%s%s%s; draw its edges as "
        "lines, or explode what has them",
        reader->scan.name, reader->report->skipped_records ? ", but others: " : "",
        reader->report->skipped_kind,
        reader->report->unseen_records ? "; what is on paper or marked invisible is not read" : "",
        reader->report->missing_blocks ? "; a block that is not in the file: " : "",
        reader->report->missing_block);

  /* Corners become nodes instead of sites. */
  thr_faces rings = {0};
  int *node = thr_calloc((size_t)reader->sites.n, sizeof *node);
  thr_status st = node ? thr_sites_finish(&reader->sites, node, reader->draft, reader->err)
                       : thr_nomem(reader->err);

  /* Runs of two are edges of their own length, longer ones faces. */
  for (int i = 0; i < reader->faces.n && !st; i++) {
    int first = i ? reader->faces.end[i - 1] : 0, n = reader->faces.end[i] - first;
    int *corner = reader->faces.corner + first;
    for (int k = 0; k < n; k++)
      corner[k] = node[corner[k]];
    st = n == 2 ? thr_draft_add_edge(reader->draft, corner[0], corner[1], reader->length[i],
                                     reader->err)
                : thr_faces_add(&rings, corner, n, reader->err);
  }

  if (!st) st = thr_faces_finish(&rings, reader->draft, reader->scan.name, reader->err);
  thr_faces_destroy(&rings);
  free(node);

  return st;
}

/* Decides which layers are read (--pick). Layer 0 gets a number last and only if the model itself
 * has shapes on it: elsewhere shapes on layer 0 belong to the layer of the INSERT. */
static thr_status choose_layers(dxf_reader *reader)
{
  bool grounded = false;
  thr_status st = THR_OK;

  reader->ground = reader->parts.asked ? -1 : find_hidden(reader, thr_span_of("0"));

  /* Does a shape of the model itself lie on layer 0? */
  for (int b = 0; b < reader->n_blocks; b++)
    for (int i = reader->block[b].first; i < reader->block[b].last && reader->block[b].name.n == 0;
         i++)
      grounded |= reader->shape[i].layer < 0 && reader->shape[i].kind < UNUSED;

  if (grounded && reader->parts.asked)
    st = thr_parts_find(&reader->parts, thr_span_of("0"), &reader->ground, reader->err);

  return st ? st
            : thr_parts_choose(&reader->parts, reader->scan.name, "layer", "layers", reader->err);
}

/* Releases all arrays. */
static void destroy(dxf_reader *reader)
{
  free(reader->pair);
  free(reader->point);
  free(reader->shape);
  free(reader->block);

  for (int i = 0; i < reader->n_curves; i++)
    free_curve(&reader->curve[i]);

  free(reader->curve);
  free(reader->inserted);
  free(reader->unused);
  free(reader->hidden);
  free(reader->vertex);
  free(reader->bulge);
  free(reader->length);
  thr_sites_destroy(&reader->sites);
  thr_faces_destroy(&reader->faces);
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  dxf_reader reader = {.draft = draft,
                       .report = report,
                       .err = err,
                       .parts = {.asked = draft->pick},
                       .layer_name = thr_span_of("0"),
                       .layer = ON_ZERO};

  /* A binary file would fail anyway, but with a less helpful text. */
  thr_status st = THR_OK;
  if (n >= sizeof binary - 1 && memcmp(text, binary, sizeof binary - 1) == 0)
    st = thr_fail(err, THR_EINPUT, "%s: binary DXF is not read; export it as text", name);

  /* Read everything, then place: layers and blocks may be used before they are known. */
  if (!st) st = thr_scan_start(&reader.scan, text, n, name, err);
  if (!st) st = read_sections(&reader);
  if (!st) st = choose_layers(&reader);
  if (!st) st = place_model(&reader);
  if (!st) st = fill_draft(&reader);

  thr_parts_finish(&reader.parts, report);
  destroy(&reader);
  return st;
}

/* Returns whether the text begins with a section, after comments (code 999), or is binary DXF,
 * which only fails with a better text. */
static bool is_dxf(const char *text, size_t n)
{
  thr_scan scan;
  thr_span code = {0}, value = {0};

  if (n >= sizeof binary - 1 && memcmp(text, binary, sizeof binary - 1) == 0) return true;

  /* Binary parts after the beginning do not matter. */
  const char *nul = n ? memchr(text, '\0', n) : NULL;
  if (thr_scan_start(&scan, text, nul ? (size_t)(nul - text) : n, "", NULL)) return false;
  while (thr_scan_line(&scan, &code) && thr_scan_line(&scan, &value) &&
         thr_span_is(thr_span_trim(code), "999")) {
  }

  return thr_span_is(thr_span_trim(code), "0") && thr_span_is(thr_span_trim(value), "SECTION");
}

const thr_format thr_dxf_format = {
    .name = "dxf", .ending = {"dxf"}, .parse = parse, .is = is_dxf, .write = thr_dxf_write};
