/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a closed mesh of a solid that is given by a distance and a cut.
 *
 * A box round the solid is divided into cubes of six tetrahedra each. Tetrahedra near the surface
 * are bisected until they are small enough, and further ones until none has a corner in the middle
 * of another one's edge. Within a tetrahedron distance and cut count as linear, so the surface is a
 * polygon there, and polygons of neighbours share their sides: the mesh is closed whatever the
 * solid, without any computing with intersections, which fails where surfaces coincide.
 *
 * A corner on which the surface lies by chance would make triangles without area. So corners near
 * the cut are moved off it, across it, and points on edges keep a little away from the ends. */
#include "kit/mesh.h"
#include "graph/number.h"

#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* More corners than this are refused: a mesh of some hundred MB, and seconds. */
enum { MOST_CORNERS = 3000000 };

/* Of more cubes than this the first ones are larger, and parted near the surface only. */
enum { MOST_CUBES = 4096 };

/* Points on edges stay this part of the edge away from the ends. */
static const double MARGIN = 0.03;

/* Points on the cut too, but by less than what moving corners off it leaves: faces stay flat. */
static const double LEAST = 0.001;

/* Tetrahedra that show no surface at their corners may be larger by this factor. */
static const double UNSEEN = 1.4;

/* Distances below this part of an edge are near the surface. */
static const double NEARLY = 0.03;

/* Numbers pairs of numbers: a table with open addresses. */
typedef struct {
  uint64_t *key; /* [size] the pair + 1; 0 = free */
  int *value;
  int used, size; /* size: a power of two, or 0 */
} pairs;

/* A corner of tetrahedra. */
typedef struct {
  double at[3];
  double distance, cut, size;
  double across[3];
  double shortest; /* of the edges that meet here; 0 = not known */
} corner;

/* A tetrahedron, in the order of Maubach: it is bisected between its first corner and number
 * `tag`. */
typedef struct {
  int v[4];
  int tag;
} tetrahedron;

/* Everything while a mesh is made. */
typedef struct {
  const thr_solid *solid;
  const thr_limits *limits;
  thr_mesh *mesh;
  corner *corner;
  int n_corners, corners_capacity;
  int *pass; /* [n_corners] of refine: the last one in which an edge that ends here was bisected */
  int passes_capacity;
  tetrahedron *tet;
  int n_tets, tets_capacity;
  pairs middle;      /* the corner in the middle of an edge that was bisected */
  pairs section;     /* the point where the cut meets an edge: a corner */
  pairs crossed;     /* the point where the surface meets an edge: a point of the mesh */
  int first_section; /* corners from here on lie on the cut */
  bool *flat;        /* [triangles] does it lie on the cut? */
  int flat_capacity;
} mesher;

/* ---- pairs ---- */

static uint64_t pair_key(int a, int b)
{
  uint64_t low = (uint64_t)(a < b ? a : b), high = (uint64_t)(a < b ? b : a);
  return (low << 32 | high) + 1;
}

/* Returns where the key is in the table, or where it would be. */
static int pair_slot(const pairs *table, uint64_t key)
{
  uint64_t mixed = key * UINT64_C(0x9e3779b97f4a7c15);
  int slot = (int)(mixed >> 33) & (table->size - 1);
  while (table->key[slot] && table->key[slot] != key)
    slot = (slot + 1) & (table->size - 1);
  return slot;
}

/* Makes the table twice as large. */
static thr_status pairs_double(pairs *table, thr_err *err)
{
  pairs larger = {.size = table->size ? 2 * table->size : 1024, .used = table->used};
  larger.key = thr_calloc((size_t)larger.size, sizeof *larger.key);
  larger.value = thr_calloc((size_t)larger.size, sizeof *larger.value);
  if (!larger.key || !larger.value) {
    free(larger.key);
    free(larger.value);
    return thr_nomem(err);
  }

  for (int i = 0; i < table->size; i++) {
    if (!table->key[i]) continue;
    int slot = pair_slot(&larger, table->key[i]);
    larger.key[slot] = table->key[i];
    larger.value[slot] = table->value[i];
  }
  free(table->key);
  free(table->value);
  *table = larger;

  return THR_OK;
}

/* Finds the number of a pair. A new pair receives `fresh`, and *found says which it was. */
static thr_status pairs_find(pairs *table, int a, int b, int fresh, int *value, bool *found,
                             thr_err *err)
{
  if (2 * (table->used + 1) > table->size) {
    thr_status st = pairs_double(table, err);
    if (st) return st;
  }

  uint64_t key = pair_key(a, b);
  int slot = pair_slot(table, key);
  *found = table->key[slot] != 0;
  if (!*found) {
    table->key[slot] = key;
    table->value[slot] = fresh;
    table->used++;
  }
  *value = table->value[slot];

  return THR_OK;
}

/* Returns the number of a pair, or -1. */
static int pairs_get(const pairs *table, int a, int b)
{
  if (!table->size) return -1;
  int slot = pair_slot(table, pair_key(a, b));
  return table->key[slot] ? table->value[slot] : -1;
}

static void pairs_free(pairs *table)
{
  free(table->key);
  free(table->value);
}

/* ---- corners ---- */

static thr_status add_corner(mesher *work, const double at[3], int *number, thr_err *err)
{
  if (work->n_corners >= MOST_CORNERS)
    return thr_fail(err, THR_EINPUT,
                    "a piece takes more than %d points of a mesh: its arms are too long for their "
                    "width and its details: a larger --width",
                    MOST_CORNERS);
  thr_status st =
      thr_grow(&work->corner, work->n_corners, &work->corners_capacity, sizeof *work->corner, err);
  if (!st)
    st = thr_grow(&work->pass, work->n_corners, &work->passes_capacity, sizeof *work->pass, err);
  if (st) return st;

  thr_solid_sample here = {0};
  work->solid->sample(work->solid->user, at, &here);
  corner *fresh = &work->corner[work->n_corners];
  *fresh = (corner){.distance = here.distance, .cut = here.cut, .size = here.size};
  memcpy(fresh->at, at, sizeof fresh->at);
  memcpy(fresh->across, here.across, sizeof fresh->across);
  work->pass[work->n_corners] = 0;
  *number = work->n_corners++;

  return THR_OK;
}

static double length_between(const mesher *work, int a, int b)
{
  const double *p = work->corner[a].at, *q = work->corner[b].at;
  return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
              (p[2] - q[2]) * (p[2] - q[2]));
}

/* ---- tetrahedra ---- */

static thr_status add_tetrahedron(mesher *work, const tetrahedron *tet, thr_err *err)
{
  thr_status st = thr_grow(&work->tet, work->n_tets, &work->tets_capacity, sizeof *work->tet, err);
  if (!st) work->tet[work->n_tets++] = *tet;
  return st;
}

/* Divides the box into cubes of six tetrahedra each, all of which have the cube's lowest and
 * highest corner (H. W. Kuhn, 1960). */
static thr_status divide_box(mesher *work, thr_err *err)
{
  static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const thr_solid *solid = work->solid;
  double step = 0.5 * solid->coarsest / sqrt(3), many; /* the diagonal is the longest edge */
  int n[3];
  do {
    step *= 2;
    many = 1;
    for (int i = 0; i < 3; i++) {
      double cubes = ceil((solid->high[i] - solid->low[i]) / step);
      many *= cubes;
      n[i] = (int)fmin(cubes, MOST_CUBES);
    }
  } while (many > MOST_CUBES);

  /* The corners, x fastest. */
  for (int z = 0; z <= n[2]; z++)
    for (int y = 0; y <= n[1]; y++)
      for (int x = 0; x <= n[0]; x++) {
        double at[3] = {solid->low[0] + x * step, solid->low[1] + y * step,
                        solid->low[2] + z * step};
        int number;
        thr_status st = add_corner(work, at, &number, err);
        if (st) return st;
      }

  /* Each tetrahedron walks from the lowest corner to the highest along the axes in some order. */
  const int stride[3] = {1, n[0] + 1, (n[0] + 1) * (n[1] + 1)};
  for (int z = 0; z < n[2]; z++)
    for (int y = 0; y < n[1]; y++)
      for (int x = 0; x < n[0]; x++)
        for (int k = 0; k < 6; k++) {
          tetrahedron tet = {.tag = 3};
          tet.v[0] = x + y * stride[1] + z * stride[2];
          for (int i = 0; i < 3; i++)
            tet.v[i + 1] = tet.v[i] + stride[order[k][i]];
          thr_status st = add_tetrahedron(work, &tet, err);
          if (st) return st;
        }

  return THR_OK;
}

/* Returns whether a tetrahedron near the surface is larger than its corners' sizes. */
static bool too_large(const mesher *work, const tetrahedron *tet)
{
  double longest = length_between(work, tet->v[0], tet->v[tet->tag]);
  double nearest = INFINITY, size = INFINITY;
  bool inside = false, outside = false;

  for (int i = 0; i < 4; i++) {
    const corner *c = &work->corner[tet->v[i]];
    /* Far beyond a face another arm may be: large ones are parted wherever any body is near. */
    double solid = longest > 1.01 * work->solid->coarsest ? c->distance : fmax(c->distance, c->cut);
    nearest = fmin(nearest, fabs(solid));
    size = fmin(size, c->size);
    *(solid < 0 ? &inside : &outside) = true;
  }

  /* Where all corners are on one side, a surface within is no farther from one of them than half
   * the longest edge, and a part that none of them shows is less than is worth a corner. */
  return inside && outside ? longest > size : longest > UNSEEN * size && nearest < 0.5 * longest;
}

/* Returns whether an edge of the tetrahedron was bisected by another one, in the last pass or this
 * one. */
static bool hangs(const mesher *work, const tetrahedron *tet, int pass)
{
  int fresh = 0;
  for (int i = 0; i < 4; i++)
    fresh += work->pass[tet->v[i]] >= pass - 1;
  if (fresh < 2) return false;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < i; j++)
      if (pairs_get(&work->middle, tet->v[i], tet->v[j]) >= 0) return true;
  return false;
}

/* Bisects tetrahedron t: one half takes its place, the other one is the last. */
static thr_status bisect(mesher *work, int t, int pass, bool *fresh, thr_err *err)
{
  tetrahedron whole = work->tet[t];
  int tag = whole.tag, a = whole.v[0], b = whole.v[tag], middle;
  bool found;
  thr_status st = pairs_find(&work->middle, a, b, work->n_corners, &middle, &found, err);
  if (!st && !found) {
    double at[3];
    for (int i = 0; i < 3; i++)
      at[i] = 0.5 * (work->corner[a].at[i] + work->corner[b].at[i]);
    st = add_corner(work, at, &middle, err);
  }
  if (st) return st;
  *fresh = !found;
  if (!found) work->pass[a] = work->pass[b] = pass;

  /* Maubach's rule: the middle takes the place of the last, or of the first, which leaves. */
  tetrahedron first = {.tag = tag > 1 ? tag - 1 : 3}, second = first;
  for (int i = 0; i < 4; i++) {
    first.v[i] = i < tag ? whole.v[i] : i == tag ? middle : whole.v[i];
    second.v[i] = i < tag ? whole.v[i + 1] : i == tag ? middle : whole.v[i];
  }
  work->tet[t] = first;

  return add_tetrahedron(work, &second, err);
}

/* Bisects until all tetrahedra are small enough and no corner is in the middle of an edge. A
 * tetrahedron that was passed may be left with such a corner by a later one: passes go on until
 * nothing is new. */
static thr_status refine(mesher *work, thr_err *err)
{
  bool again = true;
  thr_status st = THR_OK;

  for (int pass = 2; again && !st; pass++) {
    int old = work->n_tets;
    again = false;
    for (int t = 0; t < work->n_tets && !st; t++) {
      /* What was small enough in an earlier pass still is. */
      bool look = pass == 2 || t >= old;
      while (!st &&
             ((look && too_large(work, &work->tet[t])) || hangs(work, &work->tet[t], pass))) {
        bool fresh = false;
        st = bisect(work, t, pass, &fresh, err);
        again |= fresh;
        look = true;
      }
      if (t % 4096 == 0 && thr_limits_stop(work->limits))
        st = thr_fail(err, THR_ELIMIT, "stopped while a mesh was made");
    }
  }

  return st;
}

/* ---- corners near the cut ---- */

/* Moves corners that are nearly on the cut away from it, across it, by less than a tetrahedron
 * bears. */
static void move_off_cut(mesher *work)
{
  const double most = 2 * MARGIN * work->solid->coarsest;
  for (int t = 0; t < work->n_tets; t++)
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        int v = work->tet[t].v[i];
        if (i == j || fabs(work->corner[v].cut) >= most) continue;
        double length = length_between(work, v, work->tet[t].v[j]);
        double *shortest = &work->corner[v].shortest;
        if (*shortest == 0 || length < *shortest) *shortest = length;
      }

  for (int v = 0; v < work->n_corners; v++) {
    corner *c = &work->corner[v];
    double least = 2 * MARGIN * c->shortest;
    if (fabs(c->cut) >= least) continue;

    double by = (c->cut < 0 ? -least : least) - c->cut;
    thr_along(c->at, by, c->across, c->at);
    thr_solid_sample here = {0};
    work->solid->sample(work->solid->user, c->at, &here);
    c->distance = here.distance;
    c->cut += by;
  }
}

/* ---- the surface in a tetrahedron ---- */

/* Finds the corner where the cut meets an edge. */
static thr_status section_of(mesher *work, int a, int b, int *number, thr_err *err)
{
  bool found;
  thr_status st = pairs_find(&work->section, a, b, work->n_corners, number, &found, err);
  if (st || found) return st;

  int low = a < b ? a : b, high = a < b ? b : a; /* the same point whoever asks */
  const corner *p = &work->corner[low], *q = &work->corner[high];
  double part = p->cut / (p->cut - q->cut), at[3];

  /* Where the cut leaps, the corner itself would be the point, and tetrahedra have no volume. */
  part = fmin(fmax(part, LEAST), 1 - LEAST);
  thr_mix(p->at, q->at, part, at);

  return add_corner(work, at, number, err);
}

/* Returns where a parabola is 0 near b, by two steps of Newton's: it has the values fa, fb and fc
 * at a < b < c. NAN if it is 0 there nowhere. */
static double parabola(double a, double b, double c, double fa, double fb, double fc)
{
  double before = (fb - fa) / (b - a), after = (fc - fb) / (c - b);
  double bend = (after - before) / (c - a), slope = before + bend * (b - a);
  double step = -fb / slope;
  return b + step - bend * step * step / (slope + 2 * bend * step);
}

/* Finds the point of the mesh where the surface meets an edge: where the distance is 0 if it
 * changes evenly, made better by what it is there. */
static thr_status point_of(mesher *work, int a, int b, int *number, thr_err *err)
{
  bool found;
  thr_mesh *mesh = work->mesh;
  thr_status st = pairs_find(&work->crossed, a, b, mesh->n_points, number, &found, err);
  if (st || found) return st;

  int low = a < b ? a : b, high = a < b ? b : a;
  const corner *p = &work->corner[low], *q = &work->corner[high];
  double from = 0, to = 1, at_from = p->distance, at_to = q->distance, part = 0.5, at[3];
  double length = length_between(work, low, high);
  for (int round = 0; round < 2; round++) {
    part = at_from / (at_from - at_to);
    part = from + (to - from) * (isfinite(part) ? part : 0.5);
    thr_mix(p->at, q->at, part, at);
    thr_solid_sample here = {0};
    work->solid->sample(work->solid->user, at, &here);

    /* Near the surface a parabola through the three is better than another sample. */
    bool near = fabs(here.distance) < NEARLY * length;
    double better = near ? parabola(from, part, to, at_from, here.distance, at_to) : part;
    if ((here.distance < 0) == (at_from < 0)) {
      from = part;
      at_from = here.distance;
    } else {
      to = part;
      at_to = here.distance;
    }
    if (near && better > from && better < to) {
      part = better;
      break;
    }
    part = from + (to - from) * (at_from / (at_from - at_to));
  }
  if (!isfinite(part)) part = 0.5;
  part = fmin(fmax(part, MARGIN), 1 - MARGIN);

  st = thr_grow(&mesh->point, mesh->n_points, &mesh->points_capacity, sizeof *mesh->point, err);
  if (st) return st;
  thr_mix(p->at, q->at, part, mesh->point[mesh->n_points]);
  mesh->n_points++;

  return THR_OK;
}

/* Adds a corner of the cut's face itself to the mesh, once. */
static thr_status point_at(mesher *work, int v, int *number, thr_err *err)
{
  bool found;
  thr_mesh *mesh = work->mesh;
  thr_status st = pairs_find(&work->crossed, v, v, mesh->n_points, number, &found, err);
  if (st || found) return st;
  st = thr_grow(&mesh->point, mesh->n_points, &mesh->points_capacity, sizeof *mesh->point, err);
  if (!st) memcpy(mesh->point[mesh->n_points++], work->corner[v].at, sizeof *mesh->point);
  return st;
}

static thr_status add_triangle(mesher *work, int a, int b, int c, bool flat, thr_err *err)
{
  thr_mesh *mesh = work->mesh;
  thr_status st = thr_grow(&mesh->triangle, mesh->n_triangles, &mesh->triangles_capacity,
                           sizeof *mesh->triangle, err);
  if (!st)
    st = thr_grow(&work->flat, mesh->n_triangles, &work->flat_capacity, sizeof *work->flat, err);
  if (st) return st;
  work->flat[mesh->n_triangles] = flat;
  int *corners = mesh->triangle[mesh->n_triangles++];
  corners[0] = a;
  corners[1] = b;
  corners[2] = c;
  return THR_OK;
}

static bool within(const mesher *work, int v)
{
  return work->corner[v].distance < 0;
}

/* Adds the part of a triangle on the cut that is within the solid, a polygon of up to four
 * corners. */
static thr_status add_face(mesher *work, const int v[3], thr_err *err)
{
  int polygon[4], n = 0;
  thr_status st = THR_OK;

  for (int i = 0; i < 3 && !st; i++) {
    int here = v[i], next = v[(i + 1) % 3];
    if (within(work, here)) st = point_at(work, here, &polygon[n++], err);
    if (!st && within(work, here) != within(work, next))
      st = point_of(work, here, next, &polygon[n++], err);
  }
  for (int i = 2; i < n && !st; i++)
    st = add_triangle(work, polygon[0], polygon[i - 1], polygon[i], true, err);

  return st;
}

/* Twice three times the volume of a tetrahedron, positive if its corners stand right-handed. */
static double volume_of(const mesher *work, const int v[4])
{
  const double *o = work->corner[v[0]].at;
  double e[3][3];
  for (int i = 0; i < 3; i++)
    thr_between(o, work->corner[v[i + 1]].at, e[i]);
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
         e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/* Adds what the surface is in a tetrahedron that the cut leaves: a polygon where the distance is 0,
 * and those of its faces that lie on the cut. */
static thr_status add_surface(mesher *work, const int corners[4], thr_err *err)
{
  int v[4], n_within = 0;
  memcpy(v, corners, sizeof v);
  if (volume_of(work, v) < 0) {
    int swapped = v[2];
    v[2] = v[3];
    v[3] = swapped;
  }
  for (int i = 0; i < 4; i++)
    n_within += within(work, v[i]);
  if (n_within == 0) return THR_OK;

  /* Faces on the cut, seen from outside: opposite each corner in an even order. */
  static const int even[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}};
  for (int i = 0; i < 4; i++) {
    int face[3] = {v[even[i][1]], v[even[i][2]], v[even[i][3]]};
    if (face[0] < work->first_section || face[1] < work->first_section ||
        face[2] < work->first_section)
      continue;
    thr_status st = add_face(work, face, err);
    if (st) return st;
  }
  if (n_within == 4) return THR_OK;

  /* One corner apart: a triangle round it. */
  int point[4];
  thr_status st = THR_OK;
  if (n_within != 2) {
    int apart = 0;
    while (within(work, v[apart]) != (n_within == 1))
      apart++;
    const int *order = even[apart];
    for (int i = 0; i < 3 && !st; i++)
      st = point_of(work, v[apart], v[order[i + 1]], &point[i], err);
    if (st) return st;
    return n_within == 1 ? add_triangle(work, point[0], point[1], point[2], false, err)
                         : add_triangle(work, point[2], point[1], point[0], false, err);
  }

  /* Two and two: a quadrilateral between the pairs, a b inside, c d outside, in an even order. */
  static const int pairs_of[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                     {2, 3, 0, 1}, {3, 1, 0, 2}, {1, 2, 0, 3}};
  int k = 0;
  while (!within(work, v[pairs_of[k][0]]) || !within(work, v[pairs_of[k][1]]))
    k++;
  int a = v[pairs_of[k][0]], b = v[pairs_of[k][1]], c = v[pairs_of[k][2]], d = v[pairs_of[k][3]];
  st = point_of(work, a, c, &point[0], err);
  if (!st) st = point_of(work, a, d, &point[1], err);
  if (!st) st = point_of(work, b, d, &point[2], err);
  if (!st) st = point_of(work, b, c, &point[3], err);
  if (!st) st = add_triangle(work, point[0], point[1], point[2], false, err);
  if (!st) st = add_triangle(work, point[0], point[2], point[3], false, err);

  return st;
}

/* Adds the surface in a prism of two triangles, a over b: three tetrahedra. Each of the prism's
 * quadrilaterals is divided from its corner of lowest number, as by the neighbour. */
static thr_status add_prism(mesher *work, const int a[3], const int b[3], thr_err *err)
{
  /* Turn and flip the prism until the corner of lowest number is the first one. */
  int low = 0;
  bool flipped = false;
  for (int i = 0; i < 3; i++) {
    if (a[i] < (flipped ? b[low] : a[low])) low = i, flipped = false;
    if (b[i] < (flipped ? b[low] : a[low])) low = i, flipped = true;
  }
  int p[3], q[3];
  for (int i = 0; i < 3; i++) {
    p[i] = flipped ? b[(low + i) % 3] : a[(low + i) % 3];
    q[i] = flipped ? a[(low + i) % 3] : b[(low + i) % 3];
  }

  /* From it two quadrilaterals and the far triangle are seen; the third one has a diagonal too. */
  int far_face[4] = {p[0], q[0], q[1], q[2]};
  int first_p = p[1] < p[2] ? p[1] : p[2], first_q = q[1] < q[2] ? q[1] : q[2];
  int first = first_p < first_q ? first_p : first_q;
  bool straight = first == p[1] || first == q[2]; /* the diagonal is p1 q2, else p2 q1 */
  int one[4] = {p[0], p[1], p[2], straight ? q[2] : q[1]};
  int two[4] = {p[0], straight ? p[1] : p[2], q[1], q[2]};

  thr_status st = add_surface(work, far_face, err);
  if (!st) st = add_surface(work, one, err);
  if (!st) st = add_surface(work, two, err);

  return st;
}

/* Adds the surface in a tetrahedron, of which the cut may leave a part: a tetrahedron or a prism.
 */
static thr_status add_part(mesher *work, const tetrahedron *tet, thr_err *err)
{
  int kept[4], gone[4], n_kept = 0, n_gone = 0;
  bool any = false;
  for (int i = 0; i < 4; i++) {
    int v = tet->v[i];
    any |= work->corner[v].distance < 0;
    if (work->corner[v].cut < 0)
      kept[n_kept++] = v;
    else
      gone[n_gone++] = v;
  }
  if (n_kept == 0) return THR_OK;
  if (n_kept == 4) return any ? add_surface(work, kept, err) : THR_OK;

  int at[4][4];
  for (int i = 0; i < n_kept; i++)
    for (int j = 0; j < n_gone; j++) {
      thr_status st = section_of(work, kept[i], gone[j], &at[i][j], err);
      if (st) return st;
    }

  if (n_kept == 1) return add_surface(work, (int[]){kept[0], at[0][0], at[0][1], at[0][2]}, err);
  if (n_kept == 3) return add_prism(work, kept, (int[]){at[0][0], at[1][0], at[2][0]}, err);
  return add_prism(work, (int[]){kept[0], at[0][0], at[0][1]}, (int[]){kept[1], at[1][0], at[1][1]},
                   err);
}

/* Simplifies the mesh, unless two of its triangles cross then: simplifying looks at neighbours
 * only. */
static thr_status simplify(mesher *work, thr_err *err)
{
  thr_mesh *mesh = work->mesh, whole = *mesh;
  size_t points = (size_t)mesh->n_points, triangles = (size_t)mesh->n_triangles;
  whole.point = thr_calloc(points, sizeof *whole.point);
  whole.triangle = thr_calloc(triangles, sizeof *whole.triangle);
  thr_status st = whole.point && whole.triangle ? THR_OK : thr_nomem(err);
  whole.points_capacity = whole.n_points;
  whole.triangles_capacity = whole.n_triangles;
  if (!st) memcpy(whole.point, mesh->point, points * sizeof *whole.point);
  if (!st) memcpy(whole.triangle, mesh->triangle, triangles * sizeof *whole.triangle);

  thr_mesh_report report = {0};
  if (!st) st = thr_mesh_simplify(mesh, work->flat, work->solid->tolerance, err);
  if (!st) st = thr_mesh_examine(mesh, true, &report, err);
  if (report.crossings) {
    thr_mesh simple = *mesh;
    *mesh = whole;
    whole = simple;
  }
  thr_mesh_destroy(&whole);
  return st;
}

thr_status thr_mesh_make(thr_mesh *mesh, const thr_solid *solid, const thr_limits *limits,
                         thr_err *err)
{
  mesher work = {.solid = solid, .limits = limits, .mesh = mesh};
  *mesh = (thr_mesh){0};

  thr_status st = divide_box(&work, err);
  if (!st) st = refine(&work, err);
  if (!st) move_off_cut(&work);
  work.first_section = work.n_corners;

  for (int t = 0; t < work.n_tets && !st; t++)
    st = add_part(&work, &work.tet[t], err);
  if (!st && mesh->n_triangles == 0) st = thr_fail(err, THR_EINPUT, "nothing is left of a piece");
  if (!st && solid->tolerance > 0) st = simplify(&work, err);

  free(work.corner);
  free(work.pass);
  free(work.flat);
  free(work.tet);
  pairs_free(&work.middle);
  pairs_free(&work.section);
  pairs_free(&work.crossed);
  if (st) thr_mesh_destroy(mesh);

  return st;
}
