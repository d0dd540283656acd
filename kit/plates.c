/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces on the bed of a printer: how each of them stands, and where.
 *
 * A piece may stand on the face of an arm, on its foot, or in a direction that puts two of its arms
 * level, among others. Of these ways the one with the least overhang is taken, which is what needs
 * support; of equal ones the lowest. Then pieces are packed on shelves, the deepest first, each on
 * the first shelf with room (E. Coffman et al., "Performance bounds for level-oriented
 * two-dimensional packing algorithms", SIAM J. Comput. 9, 1980).
 *
 * Example: an X of four level arms lies on its side if its arms are square, and stands on a face if
 * they are round. */
#include "kit/files.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mm: free at the bed's edge, and between pieces. */
static const double MARGIN = 5, SPACING = 3;
/* Points so near to the lowest one are on the bed, mm. */
static const double LEVEL = 1e-3;

/* A mesh and the ways in which it may stand. */
typedef struct {
  const thr_kit_piece *piece;
  const thr_mesh *mesh;
  double (*normal)[4];   /* [n_triangles] unit normal, and area in mm2 */
  double (*in_plane)[2]; /* [n_points] where they are on the bed */
  thr_kit_stand *way;
  int n_ways, capacity;
} stander;

/* ---- ways to stand ---- */

/* Adds a direction, unless it is there already. arm: whose face then lies on the bed. */
static thr_status add_way(stander *work, const double down[3], int arm, thr_err *err)
{
  thr_kit_stand way = {.arm = arm};
  memcpy(way.down, down, sizeof way.down);
  if (thr_normalize(way.down) < 1e-6) return THR_OK;
  for (int i = 0; i < work->n_ways; i++)
    if (thr_dot(work->way[i].down, way.down) > 1 - 1e-9) return THR_OK;

  way.base = work->piece->foot && way.down[2] < -1 + 1e-9;
  thr_status st = thr_grow(&work->way, work->n_ways, &work->capacity, sizeof way, err);
  if (!st) work->way[work->n_ways++] = way;
  return st;
}

/* Adds a direction and its opposite. */
static thr_status add_both(stander *work, const double down[3], thr_err *err)
{
  const double up[3] = {-down[0], -down[1], -down[2]};
  thr_status st = add_way(work, down, -1, err);
  return st ? st : add_way(work, up, -1, err);
}

/* Adds all ways to stand: on the foot, on faces and cut ends, on the sides of arms, along an axis,
 * with two arms level. */
static thr_status find_ways(stander *work, thr_err *err)
{
  static const double axis[3][3] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  const thr_kit_piece *piece = work->piece;
  thr_status st = THR_OK;
  if (piece->foot) st = add_way(work, (double[]){0, 0, -1}, -1, err);

  for (int i = 0; i < piece->n_arms && !st; i++) {
    const thr_kit_arm *arm = &piece->arm[i];
    if (arm->n_mitres == 0 && !piece->rounded) st = add_way(work, arm->along, i, err);
    for (int k = 0; k < arm->n_mitres && !st; k++)
      st = add_way(work, arm->mitre[k], i, err);
  }

  /* Hexagonal arms have three pairs of sides, square ones two. */
  for (int i = 0; i < piece->n_arms && !st; i++)
    for (int k = 0; k < 6 && !st && piece->profile != THR_KIT_ROUND; k++) {
      const thr_kit_arm *arm = &piece->arm[i];
      double angle = THR_PI / (piece->profile == THR_KIT_HEX ? 3 : 2) * k, down[3];
      for (int l = 0; l < 3; l++)
        down[l] = cos(angle) * arm->up[l] + sin(angle) * arm->side[l];
      st = add_way(work, down, -1, err);
    }

  for (int k = 0; k < 3 && !st; k++)
    st = add_both(work, axis[k], err);
  for (int i = 0; i < piece->n_arms && !st; i++)
    for (int k = 0; k < i && !st; k++) {
      double normal[3];
      thr_cross(piece->arm[i].along, piece->arm[k].along, normal);
      st = add_both(work, normal, err);
    }
  return st;
}

/* Measures height, contact and overhang of a way to stand. */
static void measure(const stander *work, thr_kit_stand *way)
{
  const thr_mesh *mesh = work->mesh;
  double lowest = -INFINITY, highest = INFINITY; /* along `down` */
  for (int i = 0; i < mesh->n_points; i++) {
    double depth = thr_dot(mesh->point[i], way->down);
    lowest = depth > lowest ? depth : lowest;
    highest = depth < highest ? depth : highest;
  }
  way->size[2] = lowest - highest;

  /* Flanks of 45 degrees print without support. */
  const double steep = sqrt(0.5) + 1e-3;
  for (int t = 0; t < mesh->n_triangles; t++) {
    if (thr_dot(work->normal[t], way->down) <= steep) continue;
    bool lies = true;
    for (int k = 0; k < 3; k++)
      lies &= thr_dot(mesh->point[mesh->triangle[t][k]], way->down) > lowest - LEVEL;
    *(lies ? &way->contact : &way->overhang) += work->normal[t][3];
  }
}

/* Returns the best of the ways that were not refused: on a flat side that holds, then with the
 * least overhang, then the lowest. What differs by a fiftieth is equal, as meshes are not quite as
 * symmetric as pieces. Returns -1 if none is left. */
static int best_way(const stander *work, const bool *refused)
{
  double narrowest = INFINITY;
  for (int i = 0; i < work->piece->n_arms; i++)
    narrowest = fmin(narrowest, work->piece->arm[i].width);
  double enough = 0.1 * narrowest * narrowest;

  double least[2] = {INFINITY, INFINITY}; /* overhang of those that do not hold, that do */
  for (int i = 0; i < work->n_ways; i++) {
    bool holds = work->way[i].contact >= enough;
    if (!refused[i]) least[holds] = fmin(least[holds], work->way[i].overhang);
  }

  bool any_holds = least[1] < INFINITY;
  double most = 1.02 * least[any_holds] + 0.01 * narrowest * narrowest;
  int best = -1;
  for (int i = 0; i < work->n_ways; i++) {
    const thr_kit_stand *way = &work->way[i];
    if (refused[i] || (way->contact >= enough) != any_holds || way->overhang > most) continue;
    if (best < 0 || way->size[2] < 0.999 * work->way[best].size[2]) best = i;
  }
  return best;
}

/* ---- a way's place on the bed ---- */

/* Turns a way about the vertical, in steps of 5 degrees, until its box is smallest, of those that
 * fit on the bed if any do. Returns whether it fits. */
static bool turn_about(stander *work, thr_kit_stand *way, const double room[2])
{
  /* Two directions in the bed. */
  const thr_mesh *mesh = work->mesh;
  int across = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(way->down[k]) < fabs(way->down[across]) - 1e-6) across = k;
  double u[3] = {0, 0, 0}, v[3];
  const double up[3] = {-way->down[0], -way->down[1], -way->down[2]};
  for (int k = 0; k < 3; k++)
    u[k] = (k == across) - up[across] * up[k];
  thr_normalize(u);
  thr_cross(up, u, v);
  for (int i = 0; i < mesh->n_points; i++) {
    work->in_plane[i][0] = thr_dot(u, mesh->point[i]);
    work->in_plane[i][1] = thr_dot(v, mesh->point[i]);
  }

  bool fitted = false;
  double least = INFINITY;
  for (int step = 0; step < 36; step++) {
    double c = cos(step * THR_PI / 36), s = sin(step * THR_PI / 36);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < mesh->n_points; i++) {
      const double *p = work->in_plane[i];
      const double at[2] = {c * p[0] + s * p[1], c * p[1] - s * p[0]};
      for (int k = 0; k < 2; k++) {
        low[k] = at[k] < low[k] ? at[k] : low[k];
        high[k] = at[k] > high[k] ? at[k] : high[k];
      }
    }
    double width = high[0] - low[0], depth = high[1] - low[1];
    bool fits = width <= room[0] && depth <= room[1];
    /* The broad side is along the first axis, if the piece fits so. */
    double area = width * depth * (width < depth ? 1.001 : 1);
    if (fits < fitted || (fits == fitted && area >= least * (1 - 1e-9))) continue;
    fitted = fits;
    least = area;
    for (int k = 0; k < 2; k++) {
      way->low[k] = low[k];
      way->size[k] = high[k] - low[k];
    }
    for (int k = 0; k < 3; k++) {
      way->turn[k] = c * u[k] + s * v[k];
      way->turn[3 + k] = c * v[k] - s * u[k];
      way->turn[6 + k] = up[k];
    }
  }

  way->low[2] = INFINITY;
  for (int i = 0; i < mesh->n_points; i++)
    way->low[2] = fmin(way->low[2], thr_dot(up, mesh->point[i]));
  return fitted;
}

/* Says that a piece does not fit, and on which bed it would. */
static thr_status too_large(const thr_kit *kit, int p, const thr_kit_stand *way, thr_err *err)
{
  const double *bed = kit->options.bed;
  return thr_fail(
      err, THR_EINPUT,
      "piece %s (%s) is %.1f x %.1f x %.1f mm as it prints best, larger than the bed of "
      "%g x %g mm less %g mm around: --bed %gx%g would do",
      kit->name[p], kit->kind_name[kit->piece[p].kind], way->size[0], way->size[1], way->size[2],
      bed[0], bed[1], MARGIN, ceil(way->size[0] + 2 * MARGIN), ceil(way->size[1] + 2 * MARGIN));
}

/* Finds how a mesh stands. */
static thr_status choose(const thr_kit *kit, int p, thr_kit_stand *stand, thr_err *err)
{
  stander work = {.piece = &kit->piece[p], .mesh = &kit->mesh[p]};
  const thr_mesh *mesh = work.mesh;
  thr_scratch own = {0};
  work.normal = thr_scratch_array(&own, (size_t)mesh->n_triangles, sizeof *work.normal);
  work.in_plane = thr_scratch_array(&own, (size_t)mesh->n_points, sizeof *work.in_plane);
  thr_status st = thr_scratch_check(&own, err);
  for (int t = 0; t < mesh->n_triangles && !st; t++)
    work.normal[t][3] = thr_kit_normal(mesh, t, work.normal[t]);

  if (!st) st = find_ways(&work, err);
  bool *refused = thr_scratch_array(&own, (size_t)work.n_ways, sizeof *refused);
  if (!st) st = thr_scratch_check(&own, err);
  for (int i = 0; i < work.n_ways && !st; i++)
    measure(&work, &work.way[i]);

  /* The best way that fits on the bed. */
  const double room[2] = {kit->options.bed[0] - 2 * MARGIN, kit->options.bed[1] - 2 * MARGIN};
  int first = -1;
  for (bool fits = false; !fits && !st;) {
    int best = best_way(&work, refused);
    if (best < 0)
      st = too_large(kit, p, &work.way[first], err);
    else {
      fits = turn_about(&work, &work.way[best], room);
      refused[best] = true;
      if (first < 0) first = best;
      *stand = work.way[best];
    }
  }

  free(work.way);
  thr_scratch_free(&own);
  return st;
}

/* ---- before there are meshes ---- */

enum { AROUND = 8, CORE = 14 + AROUND + 2, MOST_POINTS = CORE + AROUND * THR_KIT_MOST_ARMS };

/* Fills point[MOST_POINTS] with points inside the convex hull of a piece's mesh, less what its
 * triangles may lack: round the ball of the node and the base, in the hook, on the rims of faces,
 * at the middles of cut ends. Returns how many. */
static int hull_points(const thr_kit_piece *piece, double (*point)[3])
{
  const double within = 0.99, corner = sqrt(1. / 3);
  int n = 0;
  for (int i = 0; i < 8; i++, n++)
    for (int k = 0; k < 3; k++)
      point[n][k] = within * piece->node_radius * (i >> k & 1 ? corner : -corner);
  for (int i = 0; i < 6; i++, n++)
    for (int k = 0; k < 3; k++)
      point[n][k] = within * piece->node_radius * (k == i / 2 ? 1 - 2 * (i % 2) : 0);

  for (int j = 0; j < AROUND && piece->foot; j++, n++) {
    const double angle = 2 * THR_PI / AROUND * j;
    point[n][0] = within * piece->pad * cos(angle);
    point[n][1] = within * piece->pad * sin(angle);
    point[n][2] = -within * piece->base;
  }
  for (int i = 1; i < 3 && piece->hook_radius > 0; i++)
    memcpy(point[n++], piece->hook[i], sizeof *point);

  for (int i = 0; i < piece->n_arms && i < THR_KIT_MOST_ARMS; i++) {
    const thr_kit_arm *arm = &piece->arm[i];
    const bool face = arm->n_mitres == 0 && !piece->rounded;
    double length = arm->length;
    for (int k = 0; k < arm->n_mitres; k++)
      length = fmin(length, fmax(arm->mitre[k][3] / thr_dot(arm->mitre[k], arm->along), 0));
    for (int j = 0; j < (face ? AROUND : 1); j++, n++) {
      const double angle = 2 * THR_PI / AROUND * j, radius = face ? 0.5 * arm->width : 0;
      for (int k = 0; k < 3; k++)
        point[n][k] = within * (length * arm->along[k] +
                                radius * (cos(angle) * arm->up[k] + sin(angle) * arm->side[k]));
    }
  }
  return n;
}

/* Returns how far a piece may reach beyond these points at most: between them on rims and on the
 * ball, by the corners of arms that are no rounds, by keys and hooks. */
static double beyond_points(const thr_kit_piece *piece)
{
  const double corners = piece->profile == THR_KIT_ROUND ? 0.06 : 0.25;
  double beyond = 0.15 * piece->node_radius;
  for (int i = 0; i < piece->n_arms; i++) {
    const thr_kit_arm *arm = &piece->arm[i];
    beyond = fmax(beyond, corners * arm->width + 0.01 * arm->length + arm->tip);
  }
  if (piece->foot) beyond = fmax(beyond, 0.1 * piece->pad + piece->fillet);
  return beyond + (piece->key == THR_KIT_NO_KEY ? 0 : piece->key_height) + piece->hook_radius;
}

/* Fills size with the smallest rectangle that these points take in one of the ways in which the
 * mesh may stand; fits: whether it is no larger than room. */
static thr_status least_size(const thr_kit_piece *piece, const double room[2], double size[2],
                             bool *fits, thr_err *err)
{
  double point[MOST_POINTS][3], in_plane[MOST_POINTS][2];
  const thr_mesh hull = {.n_points = hull_points(piece, point), .point = point};
  stander work = {.piece = piece, .mesh = &hull, .in_plane = in_plane};
  thr_status st = find_ways(&work, err);

  *fits = false;
  size[0] = size[1] = INFINITY;
  for (int i = 0; i < work.n_ways && !*fits && !st; i++) {
    thr_kit_stand *way = &work.way[i];
    *fits = turn_about(&work, way, room);
    if (way->size[0] * way->size[1] < size[0] * size[1]) memcpy(size, way->size, 2 * sizeof *size);
  }

  free(work.way);
  return st;
}

thr_status thr_kit_plates_check(const thr_kit *kit, thr_err *err)
{
  const double *bed = kit->options.bed;
  const double room[2] = {bed[0] - 2 * MARGIN, bed[1] - 2 * MARGIN};
  double least[2] = {0, 0}, need[2] = {0, 0};
  int n = 0, largest = 0;

  for (int p = 0; p < kit->n_pieces; p++) {
    double size[2];
    bool fits;
    if (kit->piece[p].like != p) continue;
    thr_status st = least_size(&kit->piece[p], room, size, &fits, err);
    if (st) return st;
    for (int k = 0; k < 2; k++)
      need[k] = fmax(need[k], ceil(size[k] + 2 * (MARGIN + beyond_points(&kit->piece[p]))));
    if (fits) continue;
    n++;
    if (size[0] * size[1] <= least[0] * least[1]) continue;
    memcpy(least, size, sizeof least);
    largest = p;
  }
  if (!n) return THR_OK;

  return thr_fail(err, THR_EINPUT,
                  "piece %s (%s) takes at least %.0f x %.0f mm however it is laid, more than the "
                  "bed of %g x %g mm less %g mm around: --bed %gx%g would do, or a smaller "
                  "framework (--scale)",
                  kit->name[largest], kit->kind_name[kit->piece[largest].kind], least[0], least[1],
                  bed[0], bed[1], MARGIN, need[0], need[1]);
}

/* ---- shelves ---- */

/* A shelf across a bed. */
typedef struct {
  int plate;
  double from, used; /* where it begins, and how much of its length is used */
} shelf;

/* Gives every piece its place. Where pieces stand, the spacing behind and beside them counts. */
static thr_status pack(thr_kit_plates *plates, thr_err *err)
{
  const thr_kit *kit = plates->kit;
  size_t n = (size_t)kit->n_pieces;
  thr_scratch own = {0};
  thr_ranked *order = thr_scratch_array(&own, n, sizeof *order);
  shelf *shelves = thr_scratch_array(&own, n, sizeof *shelves);
  double *used = thr_scratch_array(&own, n, sizeof *used); /* of the depth of a plate */
  thr_status st = thr_scratch_check(&own, err);
  if (st) {
    thr_scratch_free(&own);
    return st;
  }
  for (int p = 0; p < kit->n_pieces; p++)
    order[p] = (thr_ranked){.key = -plates->stand[kit->piece[p].like].size[1], .index = p};
  thr_sort_ranked(order, n);

  int n_shelves = 0;
  double room[2];
  for (int k = 0; k < 2; k++)
    room[k] = kit->options.bed[k] - 2 * MARGIN + SPACING * (1 + 1e-9);
  for (int i = 0; i < kit->n_pieces; i++) {
    int p = order[i].index, on = 0;
    const double *size = plates->stand[kit->piece[p].like].size;
    while (on < n_shelves && shelves[on].used + size[0] + SPACING > room[0])
      on++;

    /* No shelf has room: another one, on the first plate that has. */
    if (on == n_shelves) {
      int plate = 0;
      while (plate < plates->n_plates && used[plate] + size[1] + SPACING > room[1])
        plate++;
      if (plate == plates->n_plates) plates->n_plates++;
      shelves[n_shelves++] = (shelf){.plate = plate, .from = used[plate]};
      used[plate] += size[1] + SPACING;
    }
    plates->plate[p] = shelves[on].plate;
    plates->at[p][0] = MARGIN + shelves[on].used;
    plates->at[p][1] = MARGIN + shelves[on].from;
    shelves[on].used += size[0] + SPACING;
  }
  thr_scratch_free(&own);
  return THR_OK;
}

thr_status thr_kit_plates_make(thr_kit_plates *plates, const thr_kit *kit, thr_err *err)
{
  size_t n = (size_t)kit->n_pieces;
  *plates = (thr_kit_plates){.kit = kit,
                             .stand = thr_calloc(n, sizeof *plates->stand),
                             .plate = thr_calloc(n, sizeof *plates->plate),
                             .at = thr_calloc(n, sizeof *plates->at)};
  thr_status st = plates->stand && plates->plate && plates->at ? THR_OK : thr_nomem(err);
  for (int p = 0; p < kit->n_pieces && !st; p++)
    if (kit->piece[p].like == p) st = choose(kit, p, &plates->stand[p], err);
  return st ? st : pack(plates, err);
}

void thr_kit_plates_destroy(thr_kit_plates *plates)
{
  free(plates->stand);
  free(plates->plate);
  free(plates->at);
  *plates = (thr_kit_plates){0};
}
