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
  static const char *const name[THR_LAYOUT_KINDS] = {"plan",  "unrolled",   "front",      "side",
                                                     "plane", "unrolled-x", "unrolled-y", "drawn"};
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

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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
  for (int i = 0; i < 3; i++)
    right[i] = up[(i + 1) % 3] * n[(i + 2) % 3] - up[(i + 2) % 3] * n[(i + 1) % 3];
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

/* Azimuthal-equidistant about the axis (0 = x, 1 = y, 2 = z), seen from its positive end. */
static thr_status unroll(thr_layout *l, const thr_frame *f, int axis, thr_err *err)
{
  /* paper directions that keep the frame right-handed: plan for z, y-z for x, z-x for y */
  int right = (axis + 1) % 3, up = (axis + 2) % 3, n = f->n_nodes;
  double centre[3];
  if (!fit_sphere(f, centre)) return thr_fail(err, THR_EINPUT, "the framework is flat: there is nothing to unroll");
  polar *p = thr_calloc((size_t)n, sizeof *p);
  station *s = thr_calloc((size_t)n, sizeof *s);
  thr_status st = p && s ? THR_OK : thr_nomem(err);
  if (st) goto done;
  double radius = 0;
  for (int v = 0; v < n; v++) {
    double x = f->xyz[v][right] - centre[right], y = f->xyz[v][up] - centre[up], z = f->xyz[v][axis] - centre[axis];
    p[v] = (polar){atan2(hypot(x, y), z), hypot(x, y), z, v};
    radius += hypot(hypot(x, y), z) / n;
    l->xy[v][0] = x;
    l->xy[v][1] = y;
  }
  qsort(p, (size_t)n, sizeof *p, by_theta);
  int count = mean_meridian(p, n, 0.5 * mean_length(f) / (radius > 0 ? radius : 1), s), at = 0;
  for (int i = 0; i < n; i++) {
    double *xy = l->xy[p[i].node], stretch = p[i].rho > 0 ? arc_at(s, count, p[i].theta, &at) / p[i].rho : 0;
    xy[0] *= stretch;
    xy[1] *= stretch;
  }
done:
  free(p);
  free(s);
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
