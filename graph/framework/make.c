/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Generates example frameworks. Each generator appends nodes and edges to an empty draft; lengths
 * are in mm.
 *
 * Every node is called by a letter (column, ring or row) and a number, as on a map. Coordinates
 * come from integers wherever possible, so that mirror images agree to the last digit: symmetries
 * are found exactly.
 *
 * Example: the dome of size 2 has nodes A1 to B2, one at each corner of a square of one pitch, and
 * four edges. */
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_NODES = 2000000 };

const char *thr_shape_name(int shape)
{
  static const char *const name[THR_N_SHAPES] = {"dome",      "geodesic", "tube", "sphere",
                                                 "honeycomb", "row",      "arch", "alternating"};
  return name[shape];
}

thr_make_options thr_make_options_default(thr_shape shape)
{
  static const int size[] = {[THR_MAKE_DOME] = 7,   [THR_MAKE_GEODESIC] = 4,   [THR_MAKE_TUBE] = 12,
                             [THR_MAKE_SPHERE] = 3, [THR_MAKE_HONEYCOMB] = 3,  [THR_MAKE_ROW] = 9,
                             [THR_MAKE_ARCH] = 9,   [THR_MAKE_ALTERNATING] = 8};
  return (thr_make_options){shape, size[shape], 7, 20, 0.5, 180};
}

/* Writes what a node is called: "A1" for letter 0, number 0; after Z comes AA. */
static void node_name(int letter, int number, char name[24])
{
  char letters[8];
  int n = 0;

  /* Digits to base 26 without a zero, the lowest first. */
  for (int rest = letter + 1; rest > 0; rest = (rest - 1) / 26)
    letters[n++] = (char)('A' + (rest - 1) % 26);
  for (int i = 0; i < n; i++)
    name[i] = letters[n - 1 - i];

  snprintf(name + n, 24 - (size_t)n, "%d", number + 1);
}

/* Appends a node with its name; lengths are in mm. */
static thr_status add_node(thr_draft *draft, double x, double y, double z, int letter, int number,
                           bool foot, thr_err *err)
{
  char name[24];
  node_name(letter, number, name);
  return thr_draft_add_node(draft, (double[3]){x, y, z}, name, foot, err);
}

/* ---- square-grid dome: z = crown * (1 - r^2 / R^2), zero at the four corners, which are the feet
 * ---- */

/* Makes the dome over a square grid of n x n nodes. */
static thr_status make_dome(thr_draft *draft, const thr_make_options *options, thr_err *err)
{
  int n = options->size,
      half = n - 1; /* in half pitches, so that even sides have integer places too */
  double crown = options->rise * 0.5 * half * options->pitch;
  thr_status st = THR_OK;

  for (int column = 0; column < n; column++)

    /* Twice the place in pitches, from the centre; the squares are integers. */
    for (int row = 0; row < n && !st; row++) {
      int x = 2 * column - half, y = 2 * row - half;
      bool corner = (column == 0 || column == n - 1) && (row == 0 || row == n - 1);
      double height = 1 - (double)(x * x + y * y) / (2.0 * half * half);
      st = add_node(draft, 0.5 * x * options->pitch, 0.5 * y * options->pitch, crown * height,
                    column, row, corner, err);
    }

  /* Edges to the next node of the column and of the row. */
  for (int v = 0; v < n * n && !st; v++) {
    if (v % n < n - 1) st = thr_draft_add_edge(draft, v, v + 1, 0, err);
    if (!st && v / n < n - 1) st = thr_draft_add_edge(draft, v, v + n, 0, err);
  }

  return st;
}

/* ---- circles ---- */

/* Computes point i of n on the unit circle. Angles are folded into the first octant, so that mirror
 * images are exact. */
static void circle_point(int i, int n, double *x, double *y)
{
  int64_t part = i, whole = n; /* of a turn */
  bool left = false, below = false;

  /* Mirror the lower half up, then the left half over. */
  if (2 * part > whole) {
    part = whole - part;
    below = true;
  }

  if (4 * part > whole) {
    part = whole - 2 * part;
    whole *= 2;
    left = true;
  }

  /* In the second octant sine and cosine change places. */
  if (8 * part > whole) {
    *x = sin(2 * THR_PI * (double)(whole - 4 * part) / (double)(4 * whole));
    *y = cos(2 * THR_PI * (double)(whole - 4 * part) / (double)(4 * whole));
  } else {
    *x = cos(2 * THR_PI * (double)part / (double)whole);
    *y = sin(2 * THR_PI * (double)part / (double)whole);
  }

  if (left) *x = -*x;
  if (below) *y = -*y;
}

/* ---- tube: rings of nodes straight above each other; the lowest ring are the feet ---- */

/* Makes a tube around the z axis. */
static thr_status make_tube(thr_draft *draft, const thr_make_options *options, thr_err *err)
{
  int n = options->size;
  double radius =
      0.5 * options->pitch / sin(THR_PI / n); /* neighbours on a ring are one pitch apart */
  thr_status st = THR_OK;

  /* Nodes, ring by ring. */
  for (int ring = 0; ring < options->rings; ring++)
    for (int i = 0; i < n && !st; i++) {
      double x, y;
      circle_point(i, n, &x, &y);
      st = add_node(draft, radius * x, radius * y, ring * options->pitch, ring, i, ring == 0, err);
    }

  /* Edges around the ring, and to the ring above. */
  for (int ring = 0; ring < options->rings; ring++)
    for (int i = 0; i < n && !st; i++) {
      int v = ring * n + i;
      st = thr_draft_add_edge(draft, v, ring * n + (i + 1) % n, 0, err);
      if (!st && ring + 1 < options->rings) st = thr_draft_add_edge(draft, v, v + n, 0, err);
    }

  return st;
}

/* ---- alternating: a row of equal bends along the x axis, each of them turned about the edge
 * before it by the twist; the ends are feet ---- */

/* Turns v about the unit vector axis (Rodrigues). */
static void turn_about(const double axis[3], double cosine, double sine, double v[3])
{
  double across[3];
  const double along = thr_dot(axis, v) * (1 - cosine);
  thr_cross(axis, v, across);
  for (int k = 0; k < 3; k++)
    v[k] = cosine * v[k] + sine * across[k] + along * axis[k];
}

/* Fills the nodes of the row, wherever it leads. Lengths are in edges. */
static void bend_row(const thr_make_options *options, double (*node)[3])
{
  /* The tangent of half a bend is the rise; half turns are exact. */
  const double bend = 2 * atan(options->rise), angle = options->twist * THR_PI / 180;
  const double cosine = options->twist == 180  ? -1
                        : options->twist == 90 ? 0
                                               : cos(angle),
               sine = options->twist == 180 ? 0 : sin(angle);
  double along[3] = {1, 0, 0}, about[3] = {0, 0, 1};
  memset(node[0], 0, sizeof *node);
  for (int i = 1; i < options->size; i++) {
    for (int k = 0; k < 3; k++)
      node[i][k] = node[i - 1][k] + along[k];
    turn_about(about, cos(bend), sin(bend), along);
    turn_about(along, cosine, sine, about);
  }
}

static thr_status make_alternating(thr_draft *draft, const thr_make_options *options, thr_err *err)
{
  const int n = options->size;
  thr_scratch work = {0};
  double(*node)[3] = thr_scratch_array(&work, (size_t)n, sizeof *node);
  thr_status st = thr_scratch_check(&work, err);
  if (st) goto done;
  bend_row(options, node);

  /* The x axis leads from end to end, the first bend is as level as that leaves it, and the lowest
   * node is on the ground. */
  double axis[3][3] = {{0}, {0}, {0, 0, 1}}, low = INFINITY;
  memcpy(axis[0], node[n - 1], sizeof axis[0]);
  thr_normalize(axis[0]);
  const double slope = thr_dot(axis[0], axis[2]);
  thr_along(axis[2], -slope, axis[0], axis[2]);
  thr_normalize(axis[2]);
  thr_cross(axis[2], axis[0], axis[1]);
  for (int i = 0; i < n; i++)
    low = fmin(low, thr_dot(axis[2], node[i]));

  for (int i = 0; i < n && !st; i++)
    st = add_node(draft, options->pitch * thr_dot(axis[0], node[i]),
                  options->pitch * thr_dot(axis[1], node[i]),
                  options->pitch * (thr_dot(axis[2], node[i]) - low), 0, i, i == 0 || i == n - 1,
                  err);
  for (int i = 1; i < n && !st; i++)
    st = thr_draft_add_edge(draft, i - 1, i, 0, err);

done:
  thr_scratch_free(&work);
  return st;
}

/* ---- geodesic: an icosahedron with a corner up, each side cut into f parts and pushed out to the
 * sphere. Its nodes lie in rows 0 .. 3f from the north pole N over the upper corners U_0 .. U_4
 * (row f) and the lower ones L_0 .. L_4 (row 2f) to the south pole S; row r has row_size nodes in
 * five equal sectors ---- */

/* Returns the number of nodes in row r at frequency f: five sectors that grow, stay and shrink. */
static int row_size(int frequency, int row)
{
  int per_sector = row <= frequency ? row : row <= 2 * frequency ? frequency : 3 * frequency - row;
  return per_sector ? 5 * per_sector : 1;
}

/* The corners of an icosahedron on the unit sphere. */
typedef struct {
  double north[3], south[3], upper[5][3], lower[5][3];
} icosahedron;

/* Makes the icosahedron with corners at the poles. The others are at heights +-1 / sqrt 5, in turn
 * around the axis. */
static icosahedron make_icosahedron(void)
{
  icosahedron solid = {.north = {0, 0, 1}, .south = {0, 0, -1}};
  double z = 1 / sqrt(5), radius = 2 / sqrt(5);

  /* Upper and lower corners are turned against each other by a tenth of a turn. */
  for (int i = 0; i < 5; i++) {
    double x, y;
    circle_point(2 * i, 10, &x, &y);
    solid.upper[i][0] = radius * x;
    solid.upper[i][1] = radius * y;
    solid.upper[i][2] = z;
    circle_point(2 * i + 1, 10, &x, &y);
    solid.lower[i][0] = radius * x;
    solid.lower[i][1] = radius * y;
    solid.lower[i][2] = -z;
  }

  return solid;
}

/* Computes the point of the unit sphere over wa * a + wb * b + wc * c of a flat face. The sum of b
 * and c comes first, so that exchanging them changes nothing. */
static void on_sphere(const double a[3], int wa, const double b[3], int wb, const double c[3],
                      int wc, double xyz[3])
{
  double norm = 0;

  for (int i = 0; i < 3; i++) {
    xyz[i] = wa * a[i] + (wb * b[i] + wc * c[i]);
    norm += xyz[i] * xyz[i];
  }

  thr_divide(xyz, sqrt(norm));
}

/* Computes the place of node i of row r. In its sector the node is on a face of the icosahedron,
 * with the integer weights of the face's corners. */
static void row_point(const icosahedron *solid, int frequency, int row, int i, double xyz[3])
{
  /* The sector, and the place in it. */
  int per_sector = row_size(frequency, row) / 5, sector = per_sector ? i / per_sector : 0,
      place = per_sector ? i % per_sector : 0;
  const double *u0 = solid->upper[sector], *u1 = solid->upper[(sector + 1) % 5],
               *l0 = solid->lower[sector], *l1 = solid->lower[(sector + 1) % 5];

  /* The cap at the north pole, the one at the south pole, and the two triangles between. */
  if (row <= frequency)
    on_sphere(solid->north, frequency - row, u0, row - place, u1, place, xyz);
  else if (row >= 2 * frequency)
    on_sphere(solid->south, row - 2 * frequency, l0, 3 * frequency - row - place, l1, place, xyz);
  else if (place < 2 * frequency - row) /* row r - f of the triangle U_s, U_s+1, L_s */
    on_sphere(l0, row - frequency, u0, 2 * frequency - row - place, u1, place, xyz);
  else /* of the triangle U_s+1, L_s, L_s+1 */
    on_sphere(u1, 2 * frequency - row, l0, frequency - place, l1, place - (2 * frequency - row),
              xyz);
}

/* Joins a row of 5 per_sector nodes (0: the pole) to the row of 5 (per_sector + 1) nodes beside it,
 * which is farther from the pole. near, far: the first node of either row. */
static thr_status join_growing(thr_draft *draft, int near, int per_sector, int far, thr_err *err)
{
  int n = 5 * (per_sector + 1);
  thr_status st = THR_OK;

  /* The pole is joined to all. */
  for (int i = 0; per_sector == 0 && i < n && !st; i++)
    st = thr_draft_add_edge(draft, near, far + i, 0, err);

  /* Others to two nodes, corners of the icosahedron to three. */
  for (int i = 0; i < 5 * per_sector && !st; i++) {
    int here =
        i / per_sector * (per_sector + 1) + i % per_sector; /* same place in the same sector */
    if (i % per_sector == 0)
      st = thr_draft_add_edge(draft, near + i, far + (here + n - 1) % n, 0, err);
    if (!st) st = thr_draft_add_edge(draft, near + i, far + here, 0, err);
    if (!st) st = thr_draft_add_edge(draft, near + i, far + here + 1, 0, err);
  }

  return st;
}

/* Joins two rows of n nodes each; the far row is turned by half a node. */
static thr_status join_equal(thr_draft *draft, int near, int far, int n, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++) {
    st = thr_draft_add_edge(draft, near + i, far + (i + n - 1) % n, 0, err);
    if (!st) st = thr_draft_add_edge(draft, near + i, far + i, 0, err);
  }
  return st;
}

/* Scales the unit sphere's draft so that the mean edge is one pitch long. */
static void scale_to_pitch(thr_draft *draft, double pitch)
{
  double sum = 0;

  /* The sum of the lengths of all edges. */
  for (int e = 0; e < draft->n_edges; e++) {
    const double *a = draft->node[draft->edge[e].a].xyz, *b = draft->node[draft->edge[e].b].xyz;
    sum += thr_distance(a, b);
  }

  /* The unit sphere's edges are sum / n_edges long on average. */
  double radius = pitch / (sum / draft->n_edges);
  for (int v = 0; v < draft->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      draft->node[v].xyz[i] *= radius;
}

/* Makes rows 0 .. last of the geodesic sphere; the last row are the feet, unless it is the south
 * pole. */
static thr_status make_rows(thr_draft *draft, const thr_make_options *options, int last,
                            thr_err *err)
{
  const icosahedron solid = make_icosahedron();
  int frequency = options->size, start = 0, before = 0;
  thr_status st = THR_OK;

  for (int row = 0; row <= last && !st; before = start, start += row_size(frequency, row), row++) {
    int n = row_size(frequency, row), per_sector = n / 5;

    /* Nodes, and edges around the row. */
    for (int i = 0; i < n && !st; i++) {
      double xyz[3];
      row_point(&solid, frequency, row, i, xyz);
      st = add_node(draft, xyz[0], xyz[1], xyz[2], row, i, row == last && row < 3 * frequency, err);
    }
    for (int i = 0; i < n && n > 1 && !st; i++)
      st = thr_draft_add_edge(draft, start + i, start + (i + 1) % n, 0, err);

    /* Edges to the row before: the far one is the longer one. */
    if (st || row == 0) continue;
    if (row <= frequency)
      st = join_growing(draft, before, per_sector - 1, start, err);
    else if (row <= 2 * frequency)
      st = join_equal(draft, before, start, n, err);
    else
      st = join_growing(draft, start, per_sector, before, err);
  }

  if (!st) scale_to_pitch(draft, options->pitch);
  return st;
}

/* ---- honeycomb dome: hexagons with a corner up in rings round one. 2R zigzag rows; row k < R has
 * 2R + 1 + 2k nodes with both ends low, the rest mirrors it. Places are integers: x in sqrt(3)/2
 * pitches, y in half pitches ---- */

/* Returns the number of nodes of zigzag row k. */
static int zigzag_size(int rings, int k)
{
  return 2 * rings + 1 + 2 * (k < rings ? k : 2 * rings - 1 - k);
}

/* Computes where the node at a place of row k is, in integers: x in sqrt(3)/2 pitches, y in half
 * pitches. The lower half mirrors the upper one. */
static void zigzag_place(int rings, int k, int place, int *x, int *y)
{
  bool upper = k < rings;
  int mirrored = upper ? k : 2 * rings - 1 - k, low = 3 * (rings - 1 - mirrored) + 1;
  *x = place - (zigzag_size(rings, k) - 1) / 2;
  *y = low + place % 2;
  if (!upper) *y = -*y;
}

/* Returns the square of the distance from the axis, in square half pitches. */
static int64_t zigzag_square(int x, int y)
{
  return 3 * (int64_t)x * x + (int64_t)y * y;
}

/* Makes the honeycomb dome: z falls with the square of the distance from the axis, to 0 at the
 * farthest nodes, which are the feet. */
static thr_status make_honeycomb(thr_draft *draft, const thr_make_options *options, thr_err *err)
{
  int rings = options->size, x, y, start = 0;
  int64_t rim = 0;
  thr_status st = THR_OK;

  zigzag_place(rings, 0, 1, &x, &y); /* the top row's first peak is one of the farthest nodes */
  rim = zigzag_square(x, y);
  double crown = options->rise * 0.5 * sqrt((double)rim) * options->pitch;

  /* Nodes, row by row. */
  for (int k = 0; k < 2 * rings; k++)
    for (int place = 0; place < zigzag_size(rings, k) && !st; place++) {
      zigzag_place(rings, k, place, &x, &y);
      int64_t square = zigzag_square(x, y);
      double height = 1 - (double)square / (double)rim;
      st = add_node(draft, 0.5 * sqrt(3) * x * options->pitch, 0.5 * y * options->pitch,
                    crown * height, k, place, square == rim, err);
    }

  /* Edges along the zigzag, and from its low nodes to the next row. */
  for (int k = 0; k < 2 * rings; start += zigzag_size(rings, k), k++) {
    int n = zigzag_size(rings, k), next = k + 1 < 2 * rings ? zigzag_size(rings, k + 1) : 0;
    for (int place = 0; place < n && !st; place++) {
      if (place + 1 < n) st = thr_draft_add_edge(draft, start + place, start + place + 1, 0, err);
      bool low = (place % 2 == 0) == (k < rings);
      int below = place + (next - n) / 2; /* same x in the next row */
      if (!st && low && next)
        st = thr_draft_add_edge(draft, start + place, start + n + below, 0, err);
    }
  }

  return st;
}

/* ---- rows and arches: equal edges in the plane y = 0, straight or round a circle ---- */

/* Makes a path of `size` nodes. A row lies along x. The nodes of an arch are on a circle: with f
 * the angle at its centre from the crown to a foot, the rise is tan(f / 2) half spans. Node i is as
 * far from the crown as its mirror image, to the last digit. */
static thr_status make_path(thr_draft *draft, const thr_make_options *options, thr_err *err)
{
  const int n = options->size, half = n - 1;
  const bool arch = options->shape == THR_MAKE_ARCH;
  const double foot = arch ? 2 * atan(options->rise) : 0, /* rad from the crown */
      radius = foot > 0 ? 0.5 * options->pitch / sin(foot / half) : 0;
  thr_status st = THR_OK;

  for (int i = 0; i < n && !st; i++) {
    const int place = 2 * i - half; /* from the middle, in half edges */
    const double angle = foot * place / half, straight = 0.5 * options->pitch * place;
    st = add_node(draft, foot > 0 ? radius * sin(angle) : straight, 0,
                  radius * (cos(angle) - cos(foot)), i, 0, arch && (i == 0 || i == half), err);
  }
  for (int i = 0; i < half && !st; i++)
    st = thr_draft_add_edge(draft, i, i + 1, 0, err);
  return st;
}

/* ---- all of them ---- */

/* Checks a size; THR_EINPUT with what it is. */
static thr_status check_size(const char *what, int size, int least, int most, thr_err *err)
{
  if (size >= least && size <= most) return THR_OK;
  return thr_fail(err, THR_EINPUT, "%s is %d; it must be %d to %d for this shape", what, size,
                  least, most);
}

/* Checks the options of a shape. */
static thr_status check_options(const thr_make_options *options, thr_err *err)
{
  /* the largest sizes within MAX_NODES: n^2, 5f^2 + 5f + 1 or so, 10f^2 + 2, 6R^2 nodes */
  static const struct {
    int least, most;
  } size[] = {[THR_MAKE_DOME] = {2, 1414},          [THR_MAKE_GEODESIC] = {1, 630},
              [THR_MAKE_TUBE] = {3, MAX_NODES / 2}, [THR_MAKE_SPHERE] = {1, 447},
              [THR_MAKE_HONEYCOMB] = {1, 577},      [THR_MAKE_ROW] = {2, MAX_NODES},
              [THR_MAKE_ARCH] = {3, MAX_NODES},     [THR_MAKE_ALTERNATING] = {2, MAX_NODES}};

  /* Which sizes are used depends on the shape. */
  thr_status st =
      check_size("size", options->size, size[options->shape].least, size[options->shape].most, err);
  if (!st && options->shape == THR_MAKE_TUBE)
    st = check_size("rings", options->rings, 2, MAX_NODES / options->size, err);

  if (!st && !(options->pitch > 0 && isfinite(options->pitch)))
    st = thr_fail(err, THR_EINPUT, "pitch is %g; it must be a positive length in mm",
                  options->pitch);

  if (!st && !(options->rise >= 0 && isfinite(options->rise)))
    st =
        thr_fail(err, THR_EINPUT,
                 "rise is %g; it must be 0 or more, as a fraction of the half span", options->rise);

  /* Bends that are sharper, or all to one side, would lead the row through itself. */
  if (!st && options->shape == THR_MAKE_ALTERNATING &&
      !(options->rise <= 1 && options->twist >= 60 && options->twist <= 180))
    st = thr_fail(err, THR_EINPUT,
                  "rise is %g and twist %g; they must be at most 1, and within 60 to 180 degrees, "
                  "for this shape",
                  options->rise, options->twist);

  return st;
}

thr_status thr_make(thr_draft *draft, const thr_make_options *options, thr_err *err)
{
  thr_status st = check_options(options, err);
  if (st) return st;

  /* A geodesic dome ends halfway between the upper and the lower corners. */
  snprintf(draft->units, sizeof draft->units, "mm");
  switch (options->shape) {
  case THR_MAKE_DOME: st = make_dome(draft, options, err); break;
  case THR_MAKE_TUBE: st = make_tube(draft, options, err); break;
  case THR_MAKE_GEODESIC:
    st = make_rows(draft, options, options->size + (options->size + 1) / 2, err);
    break;
  case THR_MAKE_SPHERE: st = make_rows(draft, options, 3 * options->size, err); break;
  case THR_MAKE_ROW:
  case THR_MAKE_ARCH: st = make_path(draft, options, err); break;
  case THR_MAKE_ALTERNATING: st = make_alternating(draft, options, err); break;
  default: st = make_honeycomb(draft, options, err);
  }

  if (st) thr_draft_destroy(draft);
  return st;
}
