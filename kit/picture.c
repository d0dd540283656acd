/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a kit: chooses where it is seen from, lays the cords along their channels, and draws band
 * by band of the picture, so that memory does not grow with its height.
 *
 * A piece's mesh is turned into the picture once for every band that it reaches. Normals at the
 * corners of triangles are means of those around, weighted by 1 - the cosine of their angles there
 * (by the angles: G. Thuermer and C. Wuethrich, "Computing vertex normals from polygonal facets",
 * J. Graphics Tools 3, 1998), but only of those that are turned by less than 40 degrees: rims stay
 * sharp. */
#include "kit/picture.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 64, SIDES = 16, SHADOW = 320, JOIN = 10, STEP = 24, MOST = 10000 };

static const double SMOOTH = 0.766;              /* cosine of 40 degrees */
static const double SLENDER = 0.15;              /* height of a triangle by its longest edge */
static const double RIM = 0.045;                 /* of the picture, on every side */
static const double DARKEST = 0.42;              /* of the ground below the pieces */
static const double NEAR_BY = 0.8, HOLLOW = 0.7; /* widths of an arm; how much hollows darken */
static const double TAIL = 2; /* of a node's radius: how far cords stick out of it */
static const double AZIMUTH = -1.05, ELEVATION = 0.4; /* as in the overview's picture */

/* A cord through a piece, or between two tubes. */
typedef struct {
  int first, n, colour; /* its points */
} strand;

/* While a picture is drawn. */
typedef struct {
  const thr_kit *kit;
  const thr_kit_view *asked;
  double explode, middle[3]; /* of all pieces */
  double out;                /* how far cords stick out of faces, in widths of arms */
  double cord;               /* diameter that cords are drawn with, mm */
  double (*place)[12];       /* [n_pieces] as in thr_kit_scene */
  thr_camera_view view;      /* mm become samples */
  double ground;             /* height of the lowest point, mm */
  double height;             /* of all pieces above it: what is higher darkens less */
  bool shaded;               /* is there a ground to draw a shadow on? */
  float *shadow;             /* [SHADOW * SHADOW] 0 to 1 */
  double corner[2], cell;    /* of the shadow's first cell, and the size of one, mm */
  double (*off)[3];          /* [passes] from the axis of its bore */
  double (*point)[3];
  strand *line;
  int n_points, points_capacity, n_lines, lines_capacity;
  double (*low)[3], (*high)[3]; /* [n_pieces] boxes in the picture: right, up, to the eye; mm */
  float **normal;               /* [n_pieces] of a mesh: [n_triangles][3][3] */
  thr_spot *spot;               /* [most points of a mesh] */
  thr_sample *middle_of;        /* [px] the sample in the middle of each */
  float *depth;                 /* [px] of its surface; -INFINITY: none */
  thr_band band;
  thr_look look;
  thr_scratch own;
} drawing;

/* Returns whether a piece is drawn. */
static bool is_drawn(const drawing *work, int piece)
{
  return work->asked->alone == 0 || work->asked->alone == piece + 1;
}

/* Fills shift with what a piece is moved by, mm. */
static void shift_of(const drawing *work, int piece, double shift[3])
{
  for (int k = 0; k < 3; k++)
    shift[k] = (work->explode - 1) * (work->kit->piece[piece].centre[k] - work->middle[k]);
}

/* ---- cords ---- */

/* Begins a strand of a cord, which pass k belongs to. */
static thr_status begin_strand(drawing *work, const thr_copy *copy, int c, int k, thr_err *err)
{
  thr_status st =
      thr_grow(&work->line, work->n_lines, &work->lines_capacity, sizeof *work->line, err);
  if (st) return st;
  int colour = work->kit->plan->n_cords == 1 ? k / THR_COLOUR_PASSES : copy[c].path;
  work->line[work->n_lines++] = (strand){.first = work->n_points, .colour = colour % THR_COLOURS};
  return THR_OK;
}

/* Adds a point to the last strand. */
static thr_status add_point(drawing *work, const double at[3], thr_err *err)
{
  thr_status st =
      thr_grow(&work->point, work->n_points, &work->points_capacity, sizeof *work->point, err);
  if (st) return st;
  memcpy(work->point[work->n_points++], at, sizeof *work->point);
  work->line[work->n_lines - 1].n++;
  return THR_OK;
}

/* Adds a strand along a channel, shifted at its ends by off[0] and off[1]. */
static thr_status follow(drawing *work, const thr_kit_piece *piece, const thr_kit_channel *channel,
                         const double *off[2], thr_err *err)
{
  double shift[3];
  shift_of(work, piece->piece, shift);
  for (int i = 0; i < channel->n; i++) {
    double part = fmin(fmax((i - 1.0) / (channel->n > 3 ? channel->n - 3 : 1), 0), 1), at[3];
    for (int k = 0; k < 3; k++)
      at[k] = channel->point[i][k] + (1 - part) * off[0][k] + part * off[1][k];
    /* Curves run straight on beyond faces: they end there, or where the neighbour's begins.
     * Outside, cords are cut off. */
    int arm = i == 0 ? channel->in : channel->out;
    if (i == 0 || i == channel->n - 1) {
      const double *along = arm >= 0 ? piece->arm[arm].along : at;
      double most = arm >= 0
                        ? work->explode * piece->arm[arm].length + work->out * piece->arm[arm].width
                        : TAIL * piece->node_radius;
      double length = arm >= 0 ? thr_dot(at, along) : sqrt(thr_dot(at, at));
      double unit = arm >= 0 || length <= 0 ? 1 : 1 / length;
      thr_along(at, fmin(most - length, 0) * unit, along, at);
    }
    if (piece->foot) at[2] = fmax(at[2], -piece->base);
    for (int k = 0; k < 3; k++)
      at[k] += piece->centre[k] + shift[k];
    thr_status st = add_point(work, at, err);
    if (st) return st;
  }
  return THR_OK;
}

/* Returns the channel between the arms that two half-edges leave by, -1 = outside, and of several
 * that by which pass k of cord c goes on; NULL if there is none. *back receives whether its curve
 * runs from the second to the first. */
static const thr_kit_channel *find_channel(const thr_kit_piece *piece, int c, int k,
                                           const int half[2], bool *back)
{
  const thr_kit_channel *found = NULL;
  for (int i = 0; i < piece->n_channels; i++) {
    const thr_kit_channel *channel = &piece->channel[i];
    int from = channel->in < 0 ? -1 : piece->arm[channel->in].half;
    int to = channel->out < 0 ? -1 : piece->arm[channel->out].half;
    bool same = from == half[0] && to == half[1], turned = from == half[1] && to == half[0];
    if (!same && !turned) continue;
    *back = !same;
    found = channel;
    if (channel->cord == c && channel->pass == k) break;
  }
  return found;
}

/* Lays the cords through solid pieces: out of each pass into the next, at both ends from and to
 * outside, also where a closed cord is knotted. */
static thr_status lay_through_nodes(drawing *work, const thr_copy *copy, thr_err *err)
{
  const thr_kit *kit = work->kit;
  for (int c = 0; c < kit->plan->n_cords; c++) {
    const thr_cord *cord = &kit->plan->cord[c];
    for (int k = -1; k < cord->n_passes; k++) {
      bool begins = k < 0, ends = k == cord->n_passes - 1, back;
      const int half[2] = {begins ? -1 : cord->half[k] ^ 1, ends ? -1 : cord->half[k + 1]};
      const int node = thr_head(&kit->plan->frame, begins ? half[1] ^ 1 : cord->half[k]);
      const thr_kit_piece *piece = &kit->piece[node];
      const thr_kit_channel *channel = find_channel(piece, c, k, half, &back);
      if (!channel || !is_drawn(work, node)) continue;
      const double(*off_of)[3] = (const double(*)[3])work->off + kit->edges.first_pass[c];
      const double *in = off_of[begins ? 0 : k], *out = off_of[ends ? k : k + 1];
      const double *off[2] = {back ? out : in, back ? in : out};
      thr_status st = begin_strand(work, copy, c, begins ? 0 : k, err);
      if (!st) st = follow(work, piece, channel, off, err);
      if (st) return st;
    }
  }
  return THR_OK;
}

/* Where a pass leaves its tube: the end, and the direction there. */
typedef struct {
  double at[3], along[3];
} tube_end;

/* Finds both ends of a pass in its tube, in the direction of the needle. */
static void find_ends(const drawing *work, int c, int k, tube_end end[2])
{
  const thr_kit *kit = work->kit;
  int half = kit->plan->cord[c].half[k], pass = kit->edges.first_pass[c] + k;
  const thr_kit_piece *piece = &kit->piece[half >> 1];
  const thr_kit_edge *edge = &kit->edges.edge[half >> 1];
  const double *lane = edge->lane[edge->n_lanes > 1 ? kit->edges.lane[pass] : 0];
  double shift[3], sign = half & 1 ? -1 : 1;
  shift_of(work, piece->piece, shift);
  for (int i = 0; i < 2; i++) {
    const thr_kit_arm *arm = &piece->arm[(half & 1) ^ !i];
    double reach = fmax(arm->length - (piece->rounded ? 0 : 0.75 * arm->width), 0.5 * arm->length);
    for (int j = 0; j < 3; j++) {
      end[i].along[j] = sign * edge->along[j];
      end[i].at[j] = piece->centre[j] + shift[j] + work->off[pass][j] + reach * arm->along[j] +
                     lane[0] * edge->up[j] + lane[1] * edge->side[j];
    }
  }
}

/* Lays the cords through tubes, and from tube to tube by cubic curves. */
static thr_status lay_through_tubes(drawing *work, const thr_copy *copy, thr_err *err)
{
  const thr_kit *kit = work->kit;
  for (int c = 0; c < kit->plan->n_cords; c++) {
    const thr_cord *cord = &kit->plan->cord[c];
    for (int k = 0; k < cord->n_passes; k++) {
      tube_end end[2], next[2];
      if (!is_drawn(work, cord->half[k] >> 1)) continue;
      find_ends(work, c, k, end);
      thr_status st = begin_strand(work, copy, c, k, err);
      if (!st) st = add_point(work, end[0].at, err);
      if (!st) st = add_point(work, end[1].at, err);
      if (st) return st;

      if (k + 1 == cord->n_passes && !cord->closed) continue;
      find_ends(work, c, (k + 1) % cord->n_passes, next);
      double reach = 0.4 * thr_distance(end[1].at, next[0].at);
      for (int i = 1; i <= JOIN && !work->asked->alone; i++) {
        double t = (double)i / JOIN, u = 1 - t, at[3];
        for (int j = 0; j < 3; j++)
          at[j] = u * u * (u * end[1].at[j] + 3 * t * (end[1].at[j] + reach * end[1].along[j])) +
                  t * t * (t * next[0].at[j] + 3 * u * (next[0].at[j] - reach * next[0].along[j]));
        st = add_point(work, at, err);
        if (st) return st;
      }
    }
  }
  return THR_OK;
}

/* Lays all cords. */
static thr_status lay_cords(drawing *work, thr_err *err)
{
  const thr_kit *kit = work->kit;
  size_t passes = (size_t)kit->edges.first_pass[kit->plan->n_cords];
  thr_copy *copy = thr_scratch_array(&work->own, (size_t)kit->plan->n_cords, sizeof *copy);
  work->off = thr_scratch_array(&work->own, passes + 1, sizeof *work->off);
  thr_status st = thr_scratch_check(&work->own, err);
  if (!st) st = thr_copies_find(kit->plan, copy, err);
  if (!st) st = thr_kit_edges_share(&kit->edges, kit->plan, kit->cord, work->off, err);
  if (!st)
    st = kit->piece[0].tube ? lay_through_tubes(work, copy, err)
                            : lay_through_nodes(work, copy, err);
  return st;
}

/* ---- the view ---- */

/* Returns the direction to look from: as asked for, or into the mouth with the most light. */
static thr_camera choose_camera(const drawing *work)
{
  const thr_kit_view *asked = work->asked;
  if (asked->from) return thr_camera_at(asked->azimuth, asked->elevation);
  if (!asked->alone) return thr_camera_at(AZIMUTH, ELEVATION);

  const thr_kit_piece *piece = &work->kit->piece[asked->alone - 1];
  const thr_kit_arm *widest = &piece->arm[0];
  double most = -1;
  for (int i = 0; i < piece->n_arms; i++) {
    int mouths = 0;
    for (int j = 0; j < piece->n_channels; j++)
      mouths += (piece->channel[j].in == i) + (piece->channel[j].out == i);
    double value = mouths + 0.5 * piece->arm[i].along[2];
    if (value <= most) continue;
    most = value;
    widest = &piece->arm[i];
  }
  double azimuth = atan2(widest->along[1], widest->along[0]);
  return thr_camera_at(azimuth - 0.55, fmin(fmax(asin(widest->along[2]) + 0.45, 0.35), 1.1));
}

/* Fills at with a point of a piece's mesh in the world, mm. */
static void place_point(const drawing *work, int piece, const double point[3], double at[3])
{
  const double *place = work->place[piece];
  for (int k = 0; k < 3; k++)
    at[k] = thr_dot(place + 3 * k, point) + place[9 + k];
}

/* Turns a mesh's point into the picture's directions, mm. */
static void look_at(const drawing *work, int piece, const double point[3], double at[3])
{
  double place[3];
  const thr_camera *camera = &work->view.camera;
  place_point(work, piece, point, place);
  at[0] = thr_dot(place, camera->right);
  at[1] = thr_dot(place, camera->up);
  at[2] = thr_dot(place, camera->eye);
}

/* Finds the boxes of all pieces in the picture. */
static void find_boxes(drawing *work)
{
  const thr_kit *kit = work->kit;
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_mesh *mesh = &kit->mesh[kit->piece[p].like];
    double at[3];
    for (int k = 0; k < 3; k++) {
      work->low[p][k] = HUGE_VAL;
      work->high[p][k] = -HUGE_VAL;
    }
    for (int i = 0; i < mesh->n_points && is_drawn(work, p); i++) {
      look_at(work, p, mesh->point[i], at);
      thr_widen(work->low[p], work->high[p], at, 3);
    }
  }
}

/* Finds the scale at which all is seen. */
static void fit(drawing *work, const int size[2])
{
  const thr_camera *camera = &work->view.camera;
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  find_boxes(work);
  for (int p = 0; p < work->kit->n_pieces; p++) {
    if (!is_drawn(work, p)) continue;
    for (int k = 0; k < 2; k++) {
      low[k] = fmin(low[k], work->low[p][k]);
      high[k] = fmax(high[k], work->high[p][k]);
    }

    /* Its shadow lies straight below: no lower than that of the box's far lower corner. */
    const double *box = work->low[p];
    const double above = box[1] * camera->up[2] + work->high[p][2] * camera->eye[2] - work->ground;
    if (work->shaded) low[1] = fmin(low[1], box[1] - above * camera->up[2]);
  }

  /* Cords stick out. */
  for (int i = 0; i < work->n_points; i++) {
    const double at[2] = {thr_dot(work->point[i], camera->right),
                          thr_dot(work->point[i], camera->up)};
    thr_widen(low, high, at, 2);
  }

  work->view.scale = HUGE_VAL;
  for (int k = 0; k < 2; k++) {
    work->view.size[k] = THR_SAMPLES * size[k];
    work->view.scale =
        fmin(work->view.scale, (1 - 2 * RIM) * work->view.size[k] / fmax(high[k] - low[k], 1e-6));
  }
  work->view.middle[0] = 0.5 * (low[0] + high[0]);
  work->view.middle[1] = -0.5 * (low[1] + high[1]);
}

/* ---- the shadow on the ground ---- */

/* Blurs the shadow once along rows or columns, over 2 radius + 1 cells. line: [SHADOW] */
static void blur(float *shadow, int radius, bool columns, float *line)
{
  size_t next = columns ? SHADOW : 1, other = columns ? 1 : SHADOW;
  for (size_t j = 0; j < SHADOW; j++) {
    float *row = shadow + j * other;
    double sum = 0;
    for (int i = -radius; i < SHADOW; i++) {
      if (i + radius < SHADOW) sum += row[(size_t)(i + radius) * next];
      if (i - radius > 0) sum -= row[(size_t)(i - radius - 1) * next];
      if (i >= 0) line[i] = (float)(sum / (2 * radius + 1));
    }
    for (size_t i = 0; i < SHADOW; i++)
      row[i * next] = line[i];
  }
}

/* Finds the ground below all pieces where they are: a rim of a fifth is left for the blur. */
static void find_ground(drawing *work)
{
  const thr_kit *kit = work->kit;
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_mesh *mesh = &kit->mesh[kit->piece[p].like];
    double at[3];
    for (int i = 0; i < mesh->n_points && is_drawn(work, p); i++) {
      place_point(work, p, mesh->point[i], at);
      thr_widen(low, high, at, 3);
    }
  }
  double wide = fmax(high[0] - low[0], high[1] - low[1]);
  work->cell = 1.4 * wide / SHADOW;
  for (int k = 0; k < 2; k++)
    work->corner[k] = 0.5 * (low[k] + high[k]) - 0.7 * wide;
  work->ground = low[2];
  work->height = high[2] - low[2];
}

/* Darkens the ground below all pieces: what is higher darkens less. */
static void cast_shadow(drawing *work)
{
  const thr_kit *kit = work->kit;
  float line[SHADOW];
  memset(work->shadow, 0, sizeof *work->shadow * SHADOW * SHADOW);
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_mesh *mesh = &kit->mesh[kit->piece[p].like];
    double at[3];
    for (int i = 0; i < mesh->n_points && is_drawn(work, p); i++) {
      place_point(work, p, mesh->point[i], at);
      int x = (int)((at[0] - work->corner[0]) / work->cell);
      int y = (int)((at[1] - work->corner[1]) / work->cell);
      if (x < 0 || x >= SHADOW || y < 0 || y >= SHADOW) continue;
      float *here = &work->shadow[y * SHADOW + x];
      double up = fmax(at[2] - work->ground, 0); /* a moving piece may sink in a little */
      double part = exp(-up / (0.45 * work->height + kit->options.width));
      *here = fmaxf(*here, (float)part);
    }
  }
  for (int i = 0; i < 6; i++)
    blur(work->shadow, SHADOW / 64, i & 1, line);
}

/* Returns how bright the ground is that sample x, y sees. */
static double ground_at(const drawing *work, double x, double y)
{
  const thr_camera_view *view = &work->view;
  const thr_camera *camera = &view->camera;
  if (!work->shaded) return 1;

  /* The point of the plane of view, then along the ray to the ground. */
  double right = (x - 0.5 * view->size[0]) / view->scale + view->middle[0];
  double up = -(y - 0.5 * view->size[1]) / view->scale - view->middle[1];
  double at[3];
  for (int k = 0; k < 3; k++)
    at[k] = right * camera->right[k] + up * camera->up[k];
  double far = (work->ground - at[2]) / camera->eye[2];
  double cell[2], part[2];
  int first[2];
  for (int k = 0; k < 2; k++) {
    cell[k] = (at[k] + far * camera->eye[k] - work->corner[k]) / work->cell - 0.5;
    if (!(cell[k] >= 0 && cell[k] < SHADOW - 1)) return 1;
    first[k] = (int)cell[k];
    part[k] = cell[k] - first[k];
  }
  const float *four = &work->shadow[first[1] * SHADOW + first[0]];
  double dark = (1 - part[1]) * ((1 - part[0]) * four[0] + part[0] * four[1]) +
                part[1] * ((1 - part[0]) * four[SHADOW] + part[0] * four[SHADOW + 1]);
  return 1 - DARKEST * dark;
}

/* ---- normals ---- */

/* Gives a triangle that is almost a line the normal of its neighbour at the longest edge, as its
 * own is but noise. at[first[p] .. first[p + 1] - 1]: corners at point p, three to a triangle. */
static void borrow_normal(const thr_mesh *mesh, int t, const int *first, const int *at,
                          double (*face)[3])
{
  const int *corner = mesh->triangle[t];
  double length[3], cross[3], side[2][3];
  int longest = 0;
  for (int i = 0; i < 3; i++) {
    length[i] = thr_distance(mesh->point[corner[i]], mesh->point[corner[(i + 1) % 3]]);
    if (length[i] > length[longest]) longest = i;
  }
  int from = corner[longest], to = corner[(longest + 1) % 3];
  for (int k = 0; k < 3; k++) {
    side[0][k] = mesh->point[corner[1]][k] - mesh->point[corner[0]][k];
    side[1][k] = mesh->point[corner[2]][k] - mesh->point[corner[0]][k];
  }
  thr_cross(side[0], side[1], cross);
  if (sqrt(thr_dot(cross, cross)) > SLENDER * length[longest] * length[longest]) return;

  for (int j = first[to]; j < first[to + 1]; j++)
    if (at[j] / 3 != t && mesh->triangle[at[j] / 3][(at[j] % 3 + 1) % 3] == from)
      memcpy(face[t], face[at[j] / 3], sizeof *face);
}

/* Fills the normal of a triangle and the weight of each corner: 1 - the cosine of its angle. */
static void weigh_corners(const thr_mesh *mesh, int triangle, double normal[3], double weight[3])
{
  double side[3][3], length[3];
  for (int i = 0; i < 3; i++) {
    const double *from = mesh->point[mesh->triangle[triangle][i]];
    const double *to = mesh->point[mesh->triangle[triangle][(i + 1) % 3]];
    thr_between(from, to, side[i]);
    length[i] = sqrt(thr_dot(side[i], side[i]));
  }
  thr_cross(side[0], side[1], normal);
  thr_normalize(normal);
  for (int i = 0; i < 3; i++) {
    int before = (i + 2) % 3;
    double product = length[i] * length[before];
    weight[i] = product > 0 ? 1 + thr_dot(side[i], side[before]) / product : 0;
  }
}

/* Fills normal[3 * 3 * n_triangles] of a mesh's corners. */
static thr_status smooth(const thr_mesh *mesh, float *normal, thr_err *err)
{
  thr_scratch own = {0};
  int n = mesh->n_triangles;
  double(*face)[3] = thr_scratch_array(&own, (size_t)n + 1, sizeof *face);
  double *weight = thr_scratch_array(&own, 3 * (size_t)n + 1, sizeof *weight);
  int *first = thr_scratch_array(&own, (size_t)mesh->n_points + 2, sizeof *first);
  int *at = thr_scratch_array(&own, 3 * (size_t)n + 1, sizeof *at);
  thr_status st = thr_scratch_check(&own, err);
  if (st) {
    thr_scratch_free(&own);
    return st;
  }

  /* Corners by point (a counting sort). */
  for (int t = 0; t < n; t++)
    weigh_corners(mesh, t, face[t], weight + 3 * (size_t)t);
  for (int i = 0; i < 3 * n; i++)
    first[mesh->triangle[i / 3][i % 3] + 2]++;
  for (int p = 0; p < mesh->n_points; p++)
    first[p + 2] += first[p + 1];
  for (int i = 0; i < 3 * n; i++)
    at[first[mesh->triangle[i / 3][i % 3] + 1]++] = i;

  for (int t = 0; t < n; t++)
    borrow_normal(mesh, t, first, at, face);

  for (int i = 0; i < 3 * n; i++) {
    int p = mesh->triangle[i / 3][i % 3];
    const double *own_face = face[i / 3];
    double sum[3] = {0, 0, 0};
    for (int j = first[p]; j < first[p + 1]; j++) {
      const double *other = face[at[j] / 3];
      if (thr_dot(own_face, other) < SMOOTH) continue;
      thr_along(sum, weight[at[j]], other, sum);
    }
    if (thr_normalize(sum) <= 0) memcpy(sum, own_face, sizeof sum);
    for (int k = 0; k < 3; k++)
      normal[3 * i + k] = (float)sum[k];
  }
  thr_scratch_free(&own);
  return THR_OK;
}

/* ---- drawing ---- */

/* Places a corner in the picture: a point in the picture's directions, mm. */
static void put_spot(const drawing *work, const double at[3], thr_spot *spot)
{
  const thr_camera_view *view = &work->view;
  double x = 0.5 * view->size[0] + view->scale * (at[0] - view->middle[0]);
  double y = 0.5 * view->size[1] + view->scale * (-at[1] - view->middle[1]);
  spot->at[0] = (int)floor(THR_SAMPLE_PARTS * (x - 0.5) + 0.5);
  spot->at[1] = (int)floor(THR_SAMPLE_PARTS * (y - 0.5) + 0.5);
  spot->depth = (float)at[2];
}

/* Returns whether what lies between two heights in the picture, mm, is in the band. */
static bool in_band(const drawing *work, double low, double high)
{
  const thr_camera_view *view = &work->view;
  double top = 0.5 * view->size[1] + view->scale * (-high - view->middle[1]);
  double bottom = 0.5 * view->size[1] + view->scale * (-low - view->middle[1]);
  return bottom >= work->band.begin - 1 && top <= work->band.end + 1;
}

/* Draws a piece into the band. */
static void draw_piece(drawing *work, int p)
{
  int like = work->kit->piece[p].like;
  const thr_mesh *mesh = &work->kit->mesh[like];
  const float *normal = work->normal[like];
  const double *place = work->place[p];
  const thr_camera *camera = &work->view.camera;
  double middle[3], turn[3][3];
  int begin = THR_SAMPLE_PARTS * (work->band.begin - 1);
  int end = THR_SAMPLE_PARTS * (work->band.end + 1);

  /* From the mesh into the picture's directions. */
  const double *axis[3] = {camera->right, camera->up, camera->eye};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      turn[i][j] = axis[i][0] * place[j] + axis[i][1] * place[3 + j] + axis[i][2] * place[6 + j];
  look_at(work, p, (const double[]){0, 0, 0}, middle);
  for (int i = 0; i < mesh->n_points; i++) {
    double at[3];
    for (int k = 0; k < 3; k++)
      at[k] = middle[k] + thr_dot(turn[k], mesh->point[i]);
    put_spot(work, at, &work->spot[i]);
  }

  for (int t = 0; t < mesh->n_triangles; t++) {
    thr_spot spot[3];
    int above = 0, below = 0;
    for (int i = 0; i < 3; i++) {
      spot[i] = work->spot[mesh->triangle[t][i]];
      above += spot[i].at[1] < begin;
      below += spot[i].at[1] > end;
    }
    if (above == 3 || below == 3) continue;
    if (work->look.opaque && !thr_is_front(spot)) continue;
    for (int i = 0; i < 3; i++) {
      const float *from = &normal[9 * (size_t)t + 3 * (size_t)i];
      const double of_mesh[3] = {from[0], from[1], from[2]};
      for (int k = 0; k < 3; k++)
        spot[i].normal[k] = (float)thr_dot(turn[k], of_mesh);
    }
    thr_band_fill(&work->band, spot, p, 0);
  }
}

/* Closes the end of a tube: a fan. ahead: does the curve end here? */
static void close_end(drawing *work, const thr_spot *ring, const double along[3], bool ahead,
                      int colour)
{
  const thr_camera *camera = &work->view.camera;
  const double *axis[3] = {camera->right, camera->up, camera->eye};
  for (int s = 1; s + 1 < SIDES; s++) {
    thr_spot fan[3] = {ring[0], ring[ahead ? s + 1 : s], ring[ahead ? s : s + 1]};
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++)
        fan[i].normal[k] = (float)((ahead ? 1 : -1) * thr_dot(along, axis[k]));
    thr_band_fill(&work->band, fan, -1, colour);
  }
}

/* Draws a strand into the band as a tube. */
static void draw_strand(drawing *work, const strand *line)
{
  const thr_camera *camera = &work->view.camera;
  const double(*point)[3] = (const double(*)[3])work->point + line->first;
  double radius = 0.5 * work->cord, up[3] = {0.31, 0.17, 0.93};
  thr_spot ring[2][SIDES];

  for (int i = 0; i < line->n; i++) {
    /* A ring at right angles to the curve, turned as little as can be against the one before. */
    const double *before = point[i > 0 ? i - 1 : 0], *after = point[i + 1 < line->n ? i + 1 : i];
    double along[3], side[3];
    thr_between(before, after, along);
    thr_normalize(along);
    thr_cross(along, up, side);
    if (thr_normalize(side) < 1e-6) {
      const double other[3] = {along[1], along[2], -along[0]};
      thr_cross(along, other, side);
      thr_normalize(side);
    }
    thr_cross(side, along, up);

    for (int s = 0; s < SIDES; s++) {
      double angle = 2 * THR_PI * s / SIDES, off[3], at[3];
      for (int k = 0; k < 3; k++)
        off[k] = cos(angle) * up[k] - sin(angle) * side[k];
      double place[3];
      thr_along(point[i], radius, off, place);
      at[0] = thr_dot(place, camera->right);
      at[1] = thr_dot(place, camera->up);
      at[2] = thr_dot(place, camera->eye);
      put_spot(work, at, &ring[i & 1][s]);
      ring[i & 1][s].normal[0] = (float)thr_dot(off, camera->right);
      ring[i & 1][s].normal[1] = (float)thr_dot(off, camera->up);
      ring[i & 1][s].normal[2] = (float)thr_dot(off, camera->eye);
    }
    for (int s = 0; s < SIDES && i > 0; s++) {
      const thr_spot *last = ring[(i - 1) & 1], *this = ring[i & 1];
      int t = (s + 1) % SIDES;
      thr_band_fill(&work->band, (thr_spot[]){last[s], this[t], last[t]}, -1, line->colour);
      thr_band_fill(&work->band, (thr_spot[]){last[s], this[s], this[t]}, -1, line->colour);
    }
    if (i == 0 || i == line->n - 1) close_end(work, ring[i & 1], along, i > 0, line->colour);
  }
}

/* Returns whether nothing is drawn in the samples of a pixel, nor beside them. */
static bool is_empty(const thr_band *band, int x, int y)
{
  const thr_sample *corner = band->sample + (size_t)(y - 1 - band->begin) * (size_t)band->width + x;
  int first = x > 0 ? -1 : 0, last = x + THR_SAMPLES < band->width ? THR_SAMPLES : THR_SAMPLES - 1;
  for (int i = 0; i < THR_SAMPLES + 2; i++, corner += band->width)
    for (int k = first; k <= last; k++)
      if (corner[k].piece >= 0 || corner[k].colour >= 0) return false;
  return true;
}

/* Draws rows y .. y + ROWS - 1 of pixels. */
static void draw_rows(drawing *work, int y, const int size[2], unsigned char *pixel)
{
  thr_band *band = &work->band;
  int rows = size[1] - y < ROWS ? size[1] - y : ROWS;
  /* Lines look at the neighbours of samples. */
  band->begin = THR_SAMPLES * y - 1;
  band->end = THR_SAMPLES * (y + rows) + 1;
  for (int i = 0; i < band->width * (band->end - band->begin); i++)
    band->sample[i] =
        (thr_sample){.cord = -INFINITY, .surface = -INFINITY, .piece = -1, .colour = -1};

  for (int i = 0; i < work->n_lines; i++) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k < work->line[i].n; k++) {
      double up = thr_dot(work->point[work->line[i].first + k], work->view.camera.up);
      low = fmin(low, up - work->cord);
      high = fmax(high, up + work->cord);
    }
    if (in_band(work, low, high)) draw_strand(work, &work->line[i]);
  }
  for (int p = 0; p < work->kit->n_pieces; p++)
    if (is_drawn(work, p) && in_band(work, work->low[p][1], work->high[p][1])) draw_piece(work, p);

  for (int row = y; row < y + rows; row++)
    for (int x = 0; x < size[0]; x++) {
      double sum[3] = {0, 0, 0}, n = THR_SAMPLES * THR_SAMPLES;
      double ground = ground_at(work, THR_SAMPLES * (x + 0.5), THR_SAMPLES * (row + 0.5));
      bool empty = is_empty(band, THR_SAMPLES * x, THR_SAMPLES * row);
      for (size_t k = 0; k < 3 && empty; k++)
        sum[k] = n * fmin(ground, 1);
      for (int i = 0; i < THR_SAMPLES * THR_SAMPLES && !empty; i++)
        thr_look_at(&work->look, band, THR_SAMPLES * x + i % THR_SAMPLES,
                    THR_SAMPLES * row + i / THR_SAMPLES, ground, sum);
      size_t at = (size_t)row * (size_t)size[0] + (size_t)x;
      for (size_t k = 0; k < 3; k++)
        pixel[3 * at + k] = (unsigned char)(255 * sum[k] / n + 0.5);
      work->middle_of[at] =
          band->sample[(THR_SAMPLES * (row - y) + 2) * band->width + THR_SAMPLES * x + 1];
    }
}

/* Darkens hollows and corners, where little of the sky is seen: the mean over points around of how
 * far the surface rises there above the plane that touches it here (M. Mittring, "Finding next gen:
 * CryEngine 2", SIGGRAPH 2007 courses). */
static void darken_hollows(const drawing *work, const int size[2], unsigned char *pixel)
{
  enum { POINTS = 48 };
  double reach = NEAR_BY * work->kit->options.width, px = work->view.scale / THR_SAMPLES;
  int off[POINTS][2];
  double right[POINTS], up[POINTS], away[POINTS];
  for (int i = 0; i < POINTS; i++) {
    /* A sunflower's seeds. */
    double radius = reach * px * sqrt((i + 0.5) / POINTS), angle = i * THR_PI * (3 - sqrt(5));
    off[i][0] = (int)lround(radius * cos(angle));
    off[i][1] = (int)lround(radius * sin(angle));
    right[i] = off[i][0] / px;
    up[i] = -off[i][1] / px;
    away[i] = hypot(right[i], up[i]);
  }

  /* Heights by themselves are read faster than samples. */
  for (size_t i = 0; i < (size_t)size[0] * (size_t)size[1]; i++)
    work->depth[i] = work->middle_of[i].piece < 0 ? -INFINITY : work->middle_of[i].surface;

  for (int y = 0; y < size[1]; y++)
    for (int x = 0; x < size[0]; x++) {
      size_t at = (size_t)y * (size_t)size[0] + (size_t)x;
      const thr_sample *here = &work->middle_of[at];
      if (here->piece < 0 || here->normal[2] <= 0) continue;
      double steep = fmax(here->normal[2], 20), dark = 0;
      double slope[2] = {here->normal[0] / steep, here->normal[1] / steep};
      for (int i = 0; i < POINTS; i++) {
        int u = x + off[i][0], v = y + off[i][1];
        if (u < 0 || u >= size[0] || v < 0 || v >= size[1] || away[i] <= 0) continue;
        double there = work->depth[(size_t)v * (size_t)size[0] + (size_t)u];
        double rise = there - here->surface + slope[0] * right[i] + slope[1] * up[i];
        if (rise <= 0.2 * away[i]) continue; /* what is not drawn, too */
        /* What is far in front takes no light away. */
        double fade = rise > reach ? reach / rise : 1, steepness = rise / away[i] - 0.2;
        dark += fade * fade * (steepness < 1.5 ? steepness : 1.5) / POINTS;
      }
      for (size_t k = 0; k < 3; k++)
        pixel[3 * at + k] = (unsigned char)(pixel[3 * at + k] * (1 - fmin(HOLLOW * dark, 0.6)));
    }
}

/* Takes memory for pictures of a size. */
static thr_status make_room(drawing *work, const int size[2], thr_err *err)
{
  const thr_kit *kit = work->kit;
  size_t n = (size_t)kit->n_pieces, most = 1;
  for (int p = 0; p < kit->n_pieces; p++)
    if ((size_t)kit->mesh[p].n_points > most) most = (size_t)kit->mesh[p].n_points;
  work->low = thr_scratch_array(&work->own, n, sizeof *work->low);
  work->high = thr_scratch_array(&work->own, n, sizeof *work->high);
  work->place = thr_scratch_array(&work->own, n, sizeof *work->place);
  work->normal = thr_scratch_array(&work->own, n, sizeof *work->normal);
  work->spot = thr_scratch_array(&work->own, most, sizeof *work->spot);
  work->shadow = thr_scratch_array(&work->own, SHADOW * SHADOW, sizeof *work->shadow);
  work->band.width = THR_SAMPLES * size[0];
  work->band.sample = thr_scratch_array(
      &work->own, (size_t)work->band.width * (THR_SAMPLES * ROWS + 2), sizeof *work->band.sample);
  work->middle_of =
      thr_scratch_array(&work->own, (size_t)size[0] * (size_t)size[1], sizeof *work->middle_of);
  work->depth =
      thr_scratch_array(&work->own, (size_t)size[0] * (size_t)size[1], sizeof *work->depth);
  return thr_scratch_check(&work->own, err);
}

/* Fills the normals of the meshes that are drawn. */
static thr_status find_normals(drawing *work, thr_err *err)
{
  const thr_kit *kit = work->kit;
  thr_status st = THR_OK;
  for (int p = 0; p < kit->n_pieces && !st; p++) {
    int like = kit->piece[p].like;
    if (!is_drawn(work, p) || work->normal[like]) continue;
    size_t corners = 9 * (size_t)kit->mesh[like].n_triangles;
    work->normal[like] = thr_scratch_array(&work->own, corners + 1, sizeof(float));
    st = thr_scratch_check(&work->own, err);
    if (!st) st = smooth(&kit->mesh[like], work->normal[like], err);
  }
  return st;
}

/* Prepares everything that all bands need. */
static thr_status prepare(drawing *work, const int size[2], thr_err *err)
{
  const thr_kit *kit = work->kit;
  thr_status st = make_room(work, size, err);
  if (st) return st;

  for (int p = 0; p < kit->n_pieces; p++)
    for (int k = 0; k < 3; k++)
      work->middle[k] += kit->piece[p].centre[k] / kit->n_pieces;
  for (int p = 0; p < kit->n_pieces; p++) {
    double shift[3];
    shift_of(work, p, shift);
    memcpy(work->place[p], kit->piece[p].place, sizeof kit->piece[p].place);
    for (int k = 0; k < 3; k++)
      work->place[p][9 + k] = kit->piece[p].centre[k] + shift[k];
  }
  work->cord = kit->cord;
  st = lay_cords(work, err);
  if (st) return st;

  work->view.camera = choose_camera(work);
  work->shaded = !work->asked->alone && work->view.camera.eye[2] > 0.1;
  if (work->shaded) {
    find_ground(work);
    cast_shadow(work);
  }
  fit(work, size);
  return find_normals(work, err);
}

/* Tells which part of the rows is drawn. */
static void tell(const thr_kit_view *view, double done)
{
  if (view->limits && view->limits->advance)
    view->limits->advance(view->limits->user, "drawing the pieces", done);
}

/* Draws all rows. pixel: as for thr_kit_pixels. */
static void draw(drawing *work, const int size[2], unsigned char *pixel)
{
  for (int y = 0; y < size[1]; y += ROWS) {
    tell(work->asked, (double)y / size[1]);
    draw_rows(work, y, size, pixel);
  }
  darken_hollows(work, size, pixel);
}

thr_status thr_kit_pixels(const thr_kit *kit, const thr_kit_view *view, unsigned char **pixel,
                          int size[2], thr_err *err)
{
  *pixel = NULL;
  for (int k = 0; k < 2; k++) {
    size[k] = view->size[k] ? view->size[k] : k ? 900 : 1200;
    if (size[k] < 16 || size[k] > MOST)
      return thr_fail(err, THR_EINPUT, "a picture is 16 to %d px wide and high, not %d", MOST,
                      size[k]);
  }
  if (view->alone < 0 || view->alone > kit->n_pieces)
    return thr_fail(err, THR_EINPUT, "the kit has %d pieces, not a piece %d", kit->n_pieces,
                    view->alone);

  drawing work = {.kit = kit, .asked = view, .explode = view->explode > 0 ? view->explode : 1};
  work.out = view->alone ? 0.3 : 0;
  double colour[THR_COLOURS][3];
  for (int i = 0; i < THR_COLOURS; i++) {
    long value = strtol(thr_palette(i).hex + 1, NULL, 16);
    for (int k = 0; k < 3; k++)
      colour[i][k] = (double)(value >> (16 - 8 * k) & 255) / 255;
  }

  tell(view, 0);
  thr_status st = prepare(&work, size, err);
  if (!st) *pixel = thr_calloc((size_t)size[0] * (size_t)size[1], 3);
  if (!st && !*pixel) st = thr_nomem(err);
  if (!st) {
    work.look.colour = (const double(*)[3])colour;
    work.look.opaque = view->opaque;
    work.look.width = kit->options.width;
    thr_look_make(&work.look, (const double[]){0, work.view.camera.up[2], work.view.camera.eye[2]});
    draw(&work, size, *pixel);
  }

  free(work.point);
  free(work.line);
  thr_scratch_free(&work.own);
  return st;
}

thr_status thr_kit_picture(const thr_kit *kit, const thr_kit_view *view, thr_text *png,
                           thr_err *err)
{
  unsigned char *pixel;
  int size[2];
  thr_status st = thr_kit_pixels(kit, view, &pixel, size, err);
  if (!st) st = thr_png_write(pixel, size, png, err);
  free(pixel);
  return st;
}

/* ---- stages ---- */

struct thr_kit_stage {
  thr_kit_view asked; /* {0}: all pieces */
  drawing work;
  int size[2]; /* px */
};

void thr_kit_stage_close(thr_kit_stage *stage)
{
  if (!stage) return;
  free(stage->work.point);
  free(stage->work.line);
  thr_scratch_free(&stage->work.own);
  free(stage);
}

thr_status thr_kit_stage_open(thr_kit_stage **stage, const thr_kit *kit,
                              const thr_kit_stage_options *options, thr_err *err)
{
  thr_kit_stage *made = thr_calloc(1, sizeof *made);
  *stage = NULL;
  if (!made) return thr_nomem(err);
  drawing *work = &made->work;
  work->kit = kit;
  work->asked = &made->asked;
  work->explode = 1;
  work->cord = options->cord;
  work->view = options->view;
  work->view.scale *= THR_SAMPLES;
  for (int k = 0; k < 2; k++) {
    made->size[k] = (int)options->view.size[k];
    work->view.size[k] *= THR_SAMPLES;
    work->corner[k] = options->corner[k];
  }
  work->shaded = work->view.camera.eye[2] > 0.1;
  work->ground = options->floor;
  work->height = options->height;
  work->cell = options->wide / SHADOW;
  thr_status st = make_room(work, made->size, err);
  if (!st) st = find_normals(work, err);
  if (st) {
    thr_kit_stage_close(made);
    return st;
  }

  work->look.colour = options->colour;
  work->look.opaque = options->opaque;
  work->look.marked = options->marked;
  work->look.width = kit->options.width;
  thr_look_make(&work->look,
                (const double[]){0, work->view.camera.up[2], work->view.camera.eye[2]});
  *stage = made;
  return THR_OK;
}

/* Lays a straight part of a cord as a strand of short steps, since what is filled of a triangle is
 * searched for in its box. */
static thr_status lay_line(drawing *work, const double line[2][3], int colour, thr_err *err)
{
  thr_status st =
      thr_grow(&work->line, work->n_lines, &work->lines_capacity, sizeof *work->line, err);
  if (st) return st;
  work->line[work->n_lines++] = (strand){.first = work->n_points, .colour = colour};
  int n = (int)ceil(fmax(thr_distance(line[0], line[1]) * work->view.scale / STEP, 1));
  for (int i = 0; i <= n && !st; i++) {
    double at[3];
    for (int k = 0; k < 3; k++)
      at[k] = line[0][k] + i * (line[1][k] - line[0][k]) / n;
    st = add_point(work, at, err);
  }
  return st;
}

thr_status thr_kit_stage_draw(thr_kit_stage *stage, const thr_kit_scene *scene,
                              unsigned char *pixel, thr_err *err)
{
  drawing *work = &stage->work;
  memcpy(work->place, scene->place, (size_t)work->kit->n_pieces * sizeof *work->place);

  work->n_points = work->n_lines = 0;
  for (int i = 0; i < scene->n_lines; i++) {
    thr_status st = lay_line(work, scene->line[i], scene->colour[i], err);
    if (st) return st;
  }

  find_boxes(work);
  if (work->shaded) cast_shadow(work);
  draw(work, stage->size, pixel);
  return THR_OK;
}
