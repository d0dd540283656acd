/* Candidate layouts: projections, and the azimuthal-equidistant unrolling of domes and tubes about an axis, for which
 * the distance from the middle is the arc length along the mean meridian. */
#include "diagram/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double MAX_COORDINATE = 1e100; /* squares must stay finite */
static const double FLAT = 50;              /* a sphere this many diagonals in radius is a plane */

const char *thr_layout_name(thr_layout_kind kind)
{
  static const char *const name[THR_LAYOUT_KINDS] = {"plan",       "unrolled",   "front",  "side", "plane",
                                                     "unrolled-x", "unrolled-y", "spread", "drawn"};
  return (unsigned)kind < THR_LAYOUT_KINDS ? name[kind] : "?";
}

const char *thr_layout_words(thr_layout_kind kind)
{
  static const char *const words[THR_LAYOUT_KINDS] = {
      "Plan, seen from outside (from above).",
      "Unrolled from the crown in the middle outwards, seen from outside (from above); distances around the middle are "
      "stretched.",
      "Elevation, seen from outside (from the front: x to the right, z up).",
      "Elevation, seen from outside (from the side: y to the right, z up).",
      "Seen at right angles to the plane that fits best, with the higher nodes up the page.",
      "Unrolled about the x axis, seen from outside (from the +x end, which is in the middle); distances around it are "
      "stretched.",
      "Unrolled about the y axis, seen from outside (from the +y end, which is in the middle); distances around it are "
      "stretched.",
      "Closed shell, opened at the face opposite the middle and spread flat, seen from outside; beads far out look longer than "
      "they are.",
      "Schematic: which bead joins which is true, lengths and angles are not."};
  return (unsigned)kind < THR_LAYOUT_KINDS ? words[kind] : "";
}

bool thr_layout_to_scale(thr_layout_kind kind)
{
  return kind == THR_LAYOUT_PLAN || kind == THR_LAYOUT_FRONT || kind == THR_LAYOUT_SIDE || kind == THR_LAYOUT_PLANE;
}

void thr_layout_destroy(thr_layout *l)
{
  free(l->xy);
  *l = (thr_layout){0};
}

thr_status thr_layout_copy(thr_layout *to, const thr_layout *from, thr_err *err)
{
  thr_layout l = *from;
  l.xy = thr_calloc((size_t)from->n_nodes, sizeof *l.xy);
  if (!l.xy) return thr_nomem(err);
  if (from->n_nodes) memcpy(l.xy, from->xy, (size_t)from->n_nodes * sizeof *l.xy);
  *to = l;
  return THR_OK;
}

bool thr_layout_better(const thr_layout *a, const thr_layout *b)
{
  long faults_a = a->crossings + a->squeezed, faults_b = b->crossings + b->squeezed;
  if (a->capped != b->capped) return b->capped;
  if (faults_a != faults_b) return faults_a < faults_b;
  return a->ratio > 1.25 * b->ratio;
}

/* Replaces *best by *l when that is better; the loser is freed. */
static void keep_better(thr_layout *best, thr_layout *l)
{
  if (!best->xy || thr_layout_better(l, best)) {
    thr_layout t = *best;
    *best = *l;
    *l = t;
  }
  thr_layout_destroy(l);
}

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross_product(const double a[3], const double b[3], double c[3])
{
  for (int i = 0; i < 3; i++)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void mean_point(const thr_frame *f, double mean[3])
{
  mean[0] = mean[1] = mean[2] = 0;
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      mean[i] += f->xyz[v][i] / f->n_nodes;
}

static void project(thr_layout *l, const thr_frame *f, const double right[3], const double up[3])
{
  for (int v = 0; v < f->n_nodes; v++) {
    l->xy[v][0] = dot(f->xyz[v], right);
    l->xy[v][1] = dot(f->xyz[v], up);
  }
}

/* ---- best-fit plane ---- */

/* One Jacobi rotation that zeroes a[p][q] of a symmetric matrix; vec collects the eigenvectors as columns. */
static void rotate(double a[3][3], double vec[3][3], int p, int q)
{
  if (a[p][q] == 0) return;
  double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
  for (int k = 0; k < 3; k++) {
    double x = a[k][p], y = a[k][q];
    a[k][p] = c * x - s * y;
    a[k][q] = s * x + c * y;
  }
  for (int k = 0; k < 3; k++) {
    double x = a[p][k], y = a[q][k];
    a[p][k] = c * x - s * y;
    a[q][k] = s * x + c * y;
    x = vec[k][p], y = vec[k][q];
    vec[k][p] = c * x - s * y;
    vec[k][q] = s * x + c * y;
  }
}

/* Unit normal of the least-squares plane, towards the viewer: upwards, or for a wall from the front or the side. */
static void plane_normal(const thr_frame *f, double normal[3])
{
  double mean[3], a[3][3] = {{0}}, vec[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mean_point(f, mean);
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        a[i][j] += (f->xyz[v][i] - mean[i]) * (f->xyz[v][j] - mean[j]);
  for (int sweep = 0; sweep < 30; sweep++) {
    rotate(a, vec, 0, 1);
    rotate(a, vec, 0, 2);
    rotate(a, vec, 1, 2);
  }
  int least = 2;
  for (int i = 1; i >= 0; i--)
    if (a[i][i] < a[least][least]) least = i;
  for (int i = 0; i < 3; i++)
    normal[i] = vec[i][least];
  double sign = fabs(normal[2]) > 1e-6 ? normal[2] : fabs(normal[1]) > 1e-6 ? -normal[1] : normal[0];
  for (int i = 0; i < 3 && sign < 0; i++)
    normal[i] = -normal[i];
}

static void project_plane(thr_layout *l, const thr_frame *f)
{
  double n[3], up[3], right[3];
  plane_normal(f, n);
  /* near the horizontal, "higher up the page" would turn the sheet for a trifle: keep y up */
  const double top[3] = {0, n[2] > 0.95, n[2] <= 0.95};
  double along = dot(top, n);
  for (int i = 0; i < 3; i++)
    up[i] = top[i] - along * n[i];
  double size = sqrt(dot(up, up));
  for (int i = 0; i < 3; i++)
    up[i] /= size;
  cross_product(up, n, right);
  project(l, f, right, up);
}

/* ---- unrolling ---- */

/* Solves the symmetric 4 x 4 system in place by elimination with pivoting; false when it is singular. */
static bool solve4(double a[4][5])
{
  for (int k = 0; k < 4; k++) {
    int pivot = k;
    for (int i = k + 1; i < 4; i++)
      if (fabs(a[i][k]) > fabs(a[pivot][k])) pivot = i;
    if (!(fabs(a[pivot][k]) > 1e-9)) return false;
    for (int j = 0; j < 5; j++) {
      double t = a[k][j];
      a[k][j] = a[pivot][j];
      a[pivot][j] = t;
    }
    for (int i = 0; i < 4; i++) {
      double factor = a[i][k] / a[k][k];
      for (int j = k; j < 5 && i != k; j++)
        a[i][j] -= factor * a[k][j];
    }
  }
  return true;
}

/* Centre of the sphere that fits best (|p|^2 = 2 c.p + k, least squares), about the mean point and in units of the
 * diagonal so that the pivot test means something. False for flat frames. */
static bool fit_sphere(const thr_frame *f, double centre[3])
{
  double mean[3], a[4][5] = {{0}}, size = thr_frame_diagonal(f);
  mean_point(f, mean);
  if (!(size > 0)) return false;
  for (int v = 0; v < f->n_nodes; v++) {
    double row[5] = {0, 0, 0, 1, 0};
    for (int i = 0; i < 3; i++) {
      row[i] = (f->xyz[v][i] - mean[i]) / size;
      row[4] += row[i] * row[i];
    }
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 5; j++)
        a[i][j] += row[i] * row[j] / f->n_nodes;
  }
  if (!solve4(a)) return false;
  double radius2 = 0;
  for (int i = 0; i < 3; i++) {
    double c = a[i][4] / a[i][i] / 2;
    centre[i] = mean[i] + c * size;
    radius2 += c * c;
  }
  return radius2 < FLAT * FLAT;
}

/* A node in cylinder coordinates about the axis, and its polar angle from the crown seen from the sphere's centre. */
typedef struct {
  double theta, rho, height;
  double x, y; /* unit direction on paper; 0 on the axis */
  int node;
} polar;

static int by_theta(const void *a, const void *b)
{
  const polar *p = a, *q = b;
  if (p->theta != q->theta) return p->theta < q->theta ? -1 : 1;
  return p->node - q->node;
}

/* The mean meridian: n points, each the mean of the nodes in a band of polar angle, and the arc length up to it. */
typedef struct {
  double theta, rho, height, arc;
} station;

static int mean_meridian(const polar *p, int n, double band, station *s)
{
  int count = 0;
  for (int i = 0; i < n;) {
    station *now = &s[count];
    int from = i;
    *now = (station){0};
    for (; i < n && p[i].theta <= p[from].theta + band; i++) {
      now->theta += p[i].theta;
      now->rho += p[i].rho;
      now->height += p[i].height;
    }
    now->theta /= i - from;
    now->rho /= i - from;
    now->height /= i - from;
    now->arc = count ? s[count - 1].arc + hypot(now->rho - s[count - 1].rho, now->height - s[count - 1].height) : now->rho;
    count++;
  }
  return count;
}

/* Arc length at a polar angle: linear between stations and beyond the last, to 0 at the crown. *at is a cursor. */
static double arc_at(const station *s, int count, double theta, int *at)
{
  while (*at < count - 1 && s[*at].theta < theta)
    ++*at;
  const station *b = &s[*at], crown = {0}, *a = *at ? b - 1 : &crown;
  if (!(b->theta > a->theta)) return b->arc;
  return a->arc + (b->arc - a->arc) * (theta - a->theta) / (b->theta - a->theta);
}

static double mean_length(const thr_frame *f)
{
  double sum = 0;
  for (int e = 0; e < f->n_edges; e++) {
    const double *a = f->xyz[f->edge[e][0]], *b = f->xyz[f->edge[e][1]];
    double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    sum += sqrt(dot(d, d));
  }
  return sum / f->n_edges;
}

/* Nodes in polar coordinates about the axis, sorted from the crown, and the mean meridian through them. */
typedef struct {
  int n, n_stations;
  polar *node;
  station *station;
  double mean_length; /* of edges */
} meridian;

static thr_status make_meridian(meridian *m, const thr_frame *f, int axis, thr_err *err)
{
  int right = (axis + 1) % 3, up = (axis + 2) % 3;
  double centre[3], radius = 0;
  if (!fit_sphere(f, centre)) {
    if (axis != 2) return thr_fail(err, THR_EINPUT, "the framework is flat: there is nothing to unroll");
    /* seen from far below, the polar angle of a flat frame is its distance from the middle */
    mean_point(f, centre);
    centre[2] -= 2 * FLAT * thr_frame_diagonal(f);
  }
  m->n = f->n_nodes;
  m->node = thr_calloc((size_t)m->n, sizeof *m->node);
  m->station = thr_calloc((size_t)m->n, sizeof *m->station);
  if (!m->node || !m->station) return thr_nomem(err);
  for (int v = 0; v < m->n; v++) {
    double x = f->xyz[v][right] - centre[right], y = f->xyz[v][up] - centre[up], z = f->xyz[v][axis] - centre[axis];
    double rho = hypot(x, y);
    m->node[v] = (polar){atan2(rho, z), rho, z, rho > 0 ? x / rho : 0, rho > 0 ? y / rho : 0, v};
    radius += hypot(rho, z) / m->n;
  }
  qsort(m->node, (size_t)m->n, sizeof *m->node, by_theta);
  m->mean_length = mean_length(f);
  m->n_stations = mean_meridian(m->node, m->n, 0.5 * m->mean_length / (radius > 0 ? radius : 1), m->station);
  return THR_OK;
}

/* Lays the nodes at their arc lengths, all but a node at the crown itself pushed outwards by opening. */
static void lay_rings(thr_layout *l, const meridian *m, double opening)
{
  int at = 0;
  for (int i = 0; i < m->n; i++) {
    const polar *p = &m->node[i];
    double r = arc_at(m->station, m->n_stations, p->theta, &at);
    if (r > 0.1 * m->mean_length) r += opening;
    l->xy[p->node][0] = r * p->x;
    l->xy[p->node][1] = r * p->y;
  }
}

/* Azimuthal-equidistant about the axis (0 = x, 1 = y, 2 = z), seen from its positive end. Paper directions keep the frame
 * right-handed: x-y for z, y-z for x, z-x for y. Where many meridians meet at the crown its rings are opened up. */
static thr_status unroll(thr_layout *l, const thr_frame *f, int axis, thr_err *err)
{
  static const double opening[] = {0, 1, 2, 3};
  meridian m = {0};
  thr_layout best = {0}, now = {0};
  thr_status st = make_meridian(&m, f, axis, err);
  for (int i = 0; i < 4 && !st; i++) {
    lay_rings(l, &m, opening[i] * m.mean_length);
    st = thr_layout_measure(l, f, err);
    if (!st) st = thr_layout_copy(&now, l, err);
    if (!st) keep_better(&best, &now);
  }
  if (!st) memcpy(l->xy, best.xy, (size_t)f->n_nodes * sizeof *l->xy);
  thr_layout_destroy(&best);
  free(m.node);
  free(m.station);
  return st;
}

/* ---- spreading a closed shell ---- */

static const double PI = 3.14159265358979323846;

/* Cosine of the angle between direction d and the nearest node, all seen from the sphere's centre. */
static double nearest_node(const double (*unit)[3], int n, const double d[3])
{
  double most = -1;
  for (int v = 0; v < n; v++)
    most = fmax(most, dot(unit[v], d));
  return most;
}

/* Direction i of n on a Fibonacci lattice, from the lowest up: evenly spread over the sphere (Gonzalez 2010). */
static void lattice(int i, int n, double d[3])
{
  double z = (2.0 * i + 1) / n - 1, r = sqrt(1 - z * z), turn = i * PI * (3 - sqrt(5));
  d[0] = r * cos(turn);
  d[1] = r * sin(turn);
  d[2] = z;
}

/* Middle of the widest empty cap, the lowest of nearly equal ones: where the shell is opened. */
static void find_opening(const double (*unit)[3], int n, double best[3])
{
  int tries = n < 5000 ? 4000 : n < 50000 ? 400 : 60;
  double widest = 0, d[3];
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < tries; i++) {
      lattice(i, tries, d);
      double cap = acos(fmax(-1, fmin(1, nearest_node(unit, n, d))));
      if (pass == 0) widest = fmax(widest, cap);
      if (pass == 1 && cap >= 0.93 * widest) {
        memcpy(best, d, sizeof d);
        return;
      }
    }
}

/* Moves a direction to the middle of its empty cap: a pattern search that maximizes the angle to the nearest node. */
static double centre_opening(const double (*unit)[3], int n, double d[3])
{
  double best = nearest_node(unit, n, d), step = 0.1;
  for (int i = 0; i < 60; i++) {
    bool moved = false;
    for (int k = 0; k < 6; k++) {
      double to[3] = {d[0], d[1], d[2]};
      to[k / 2] += k % 2 ? step : -step;
      double size = sqrt(dot(to, to));
      for (int j = 0; j < 3; j++)
        to[j] /= size;
      double near = nearest_node(unit, n, to);
      if (near >= best) continue;
      best = near;
      memcpy(d, to, sizeof to);
      moved = true;
    }
    if (!moved) step /= 2;
  }
  return best;
}

/* One way to flatten the sphere: the polar angle theta, measured from the point opposite the opening, goes to radius
 * sin(tame * theta) / (height + cos(tame * theta)). */
typedef struct {
  double tame;   /* 1; less draws the rim in, for shells with a wide hole */
  double height; /* of the eye over the sphere's centre towards the opening; 1 = on the sphere: stereographic */
} flattening;

/* Of a polyhedron inscribed in a sphere, seen from an eye beyond one face only, the edges do not cross (Schlegel). */
static void lay_spread(thr_layout *l, const double (*unit)[3], const double opening[3], flattening how)
{
  const double axis[3] = {-opening[0], -opening[1], -opening[2]}, top[3] = {0, fabs(axis[2]) > 0.7, fabs(axis[2]) <= 0.7};
  double up[3], along = dot(top, axis), size = 0, right[3];
  for (int i = 0; i < 3; i++)
    up[i] = top[i] - along * axis[i];
  size = sqrt(dot(up, up));
  for (int i = 0; i < 3; i++)
    up[i] /= size;
  cross_product(up, axis, right);
  for (int v = 0; v < l->n_nodes; v++) {
    double x = dot(unit[v], right), y = dot(unit[v], up), rho = hypot(x, y);
    double theta = how.tame * atan2(rho, dot(unit[v], axis)), r = sin(theta) / fmax(how.height + cos(theta), 1e-4);
    l->xy[v][0] = rho > 0 ? r * x / rho : 0;
    l->xy[v][1] = rho > 0 ? r * y / rho : 0;
  }
}

static thr_status spread(thr_layout *l, const thr_frame *f, thr_err *err)
{
  /* the eye on the sphere, or a part of the way down to the nearest nodes */
  static const double tame[] = {0.7, 0.8, 0.9, 1, 1, 1, 1}, sunk[] = {0, 0, 0, 0, 0.1, 0.25, 0.5};
  double centre[3], opening[3] = {0, 0, -1};
  thr_layout best = {0}, now = {0};
  thr_status st = THR_OK;
  if (!fit_sphere(f, centre)) return thr_fail(err, THR_EINPUT, "the framework is flat: there is nothing to spread");
  double(*unit)[3] = thr_calloc((size_t)f->n_nodes, sizeof *unit);
  if (!unit) return thr_nomem(err);
  for (int v = 0; v < f->n_nodes; v++) {
    double d[3] = {f->xyz[v][0] - centre[0], f->xyz[v][1] - centre[1], f->xyz[v][2] - centre[2]}, size = sqrt(dot(d, d));
    for (int i = 0; i < 3; i++)
      unit[v][i] = size > 0 ? d[i] / size : 0;
  }
  find_opening((const double(*)[3])unit, f->n_nodes, opening);
  double edge = centre_opening((const double(*)[3])unit, f->n_nodes, opening);
  for (int i = 0; i < 7 && !st; i++) {
    flattening how = {tame[i], 1 - sunk[i] * (1 - edge)};
    lay_spread(l, (const double(*)[3])unit, opening, how);
    st = thr_layout_measure(l, f, err);
    if (!st) st = thr_layout_copy(&now, l, err);
    if (!st) keep_better(&best, &now);
  }
  if (!st) memcpy(l->xy, best.xy, (size_t)f->n_nodes * sizeof *l->xy);
  thr_layout_destroy(&best);
  free(unit);
  return st;
}

/* ---- candidates ---- */

static thr_status place(thr_layout *l, const thr_frame *f, thr_err *err)
{
  static const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
  switch (l->kind) {
  case THR_LAYOUT_PLAN: project(l, f, x, y); return THR_OK;
  case THR_LAYOUT_FRONT: project(l, f, x, z); return THR_OK;
  case THR_LAYOUT_SIDE: project(l, f, y, z); return THR_OK;
  case THR_LAYOUT_PLANE: project_plane(l, f); return THR_OK;
  case THR_LAYOUT_UNROLLED_X: return unroll(l, f, 0, err);
  case THR_LAYOUT_UNROLLED_Y: return unroll(l, f, 1, err);
  case THR_LAYOUT_UNROLLED_Z: return unroll(l, f, 2, err);
  case THR_LAYOUT_SPREAD: return spread(l, f, err);
  default: return thr_fail(err, THR_EINPUT, "layout kind %d cannot be made from coordinates", (int)l->kind);
  }
}

thr_status thr_layout_make(thr_layout *out, const thr_frame *f, thr_layout_kind kind, thr_err *err)
{
  thr_layout l = {.n_nodes = f->n_nodes, .kind = kind};
  for (int v = 0; v < f->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      if (!(fabs(f->xyz[v][i]) < MAX_COORDINATE))
        return thr_fail(err, THR_EINPUT, "node %d lies at %g: too far to be drawn", v, f->xyz[v][i]);
  l.xy = thr_calloc((size_t)f->n_nodes, sizeof *l.xy);
  if (!l.xy) return thr_nomem(err);
  thr_status st = place(&l, f, err);
  if (!st) st = thr_layout_measure(&l, f, err);
  if (st) thr_layout_destroy(&l);
  *out = l;
  return st;
}

thr_status thr_layout_adopt(thr_layout *out, const thr_frame *f, const double (*xy)[2], thr_err *err)
{
  thr_layout l = {.n_nodes = f->n_nodes, .kind = THR_LAYOUT_DRAWN};
  for (int v = 0; v < f->n_nodes; v++)
    if (!(fabs(xy[v][0]) < MAX_COORDINATE && fabs(xy[v][1]) < MAX_COORDINATE))
      return thr_fail(err, THR_EINPUT, "node %d of the layout has no finite place on paper", v);
  l.xy = thr_calloc((size_t)f->n_nodes, sizeof *l.xy);
  if (!l.xy) return thr_nomem(err);
  if (f->n_nodes) memcpy(l.xy, xy, (size_t)f->n_nodes * sizeof *l.xy);
  thr_status st = thr_layout_measure(&l, f, err);
  if (st) thr_layout_destroy(&l);
  *out = l;
  return st;
}

thr_status thr_layout_choose(thr_layout *out, const thr_frame *f, const thr_layout *extra, int n_extra, thr_err *err)
{
  thr_layout best = {0}, l = {0};
  thr_status st = THR_OK;
  for (int kind = THR_LAYOUT_PLAN; kind < THR_LAYOUT_DRAWN; kind++) {
    thr_err flat = {0};
    st = thr_layout_make(&l, f, (thr_layout_kind)kind, kind == THR_LAYOUT_PLAN ? err : &flat);
    if (st == THR_EINPUT && kind != THR_LAYOUT_PLAN) continue;
    if (st) {
      st = kind == THR_LAYOUT_PLAN ? st : thr_fail(err, st, "%s", flat.text);
      goto done;
    }
    keep_better(&best, &l);
    if (kind == THR_LAYOUT_PLAN && best.crossings == 0 && best.ratio >= 0.5) break;
  }
  st = THR_OK;
  for (int i = 0; i < n_extra; i++) {
    if (!thr_layout_better(&extra[i], &best)) continue;
    st = thr_layout_copy(&l, &extra[i], err);
    if (st) goto done;
    keep_better(&best, &l);
  }
done:
  if (st) thr_layout_destroy(&best);
  *out = best;
  return st;
}
