/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Estimates what a kit will be, so fast that every plan can say it: how many pieces and kinds, and
 * how much material.
 *
 * The pieces are made without meshes. The volume of a piece is that of the boxes around its arms
 * and its node, times the share of points in them that are inside the solid; a point in several
 * boxes counts once. The points are multiples, modulo 1, of the powers of one irrational number,
 * which spread more evenly than random ones (M. Roberts, "The unreasonable effectiveness of
 * quasirandom sequences", 2018), and every box goes on with the sequence where the one before it
 * ended, so that errors of boxes do not add up.
 *
 * Example: the 7 x 7 dome has 49 pieces of about 62 cm3, of which the meshes have 61.7 cm3. */
#include "kit/files.h"

#include "graph/number.h"

#include <math.h>

/* Points in all pieces together, by which their volume is known within 1 % (tests/unit/test_kit.c;
 * deviations from the meshes are 0.5 % and less), and of how many pieces and edges a kit is
 * estimated: they bound the time, to 0.2 s. */
enum { POINTS = 100000, MOST_PIECES = 1000, MOST_EDGES = 4000 };

/* Returns whether a point is inside the solid. */
static bool is_inside(thr_kit_solid *solid, const double at[3])
{
  /* Points outside are found without channels and letters. */
  if (thr_kit_body(solid->piece, at, NULL) >= 0) return false;
  thr_solid_sample sample;
  thr_kit_sample(solid, at, &sample);
  return sample.distance < 0 && sample.cut < 0;
}

/* A box in the frame of a piece. */
typedef struct {
  const double *axis[3]; /* unit vectors at right angles */
  double low[3], size[3];
} box;

/* Returns the number of boxes that hold a piece together: round each arm, and round the node. */
static int count_boxes(const thr_kit_piece *piece)
{
  return piece->n_arms + (piece->tube ? 0 : 1);
}

/* Returns box i of a piece. Fillets add no more than half of their radius to the arms. */
static box box_of(const thr_kit_piece *piece, int i)
{
  static const double unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double margin = piece->tube ? 0 : 0.5 * piece->fillet;

  if (i < piece->n_arms) {
    const thr_kit_arm *arm = &piece->arm[i];
    double corner =
        piece->profile == THR_KIT_HEX ? 2 / sqrt(3) : 1; /* of a hexagon round a circle */
    double half = 0.5 * corner * arm->width * fmax(piece->taper, 1) + margin;
    double back = piece->tube ? 0 : half;
    return (box){{arm->along, arm->up, arm->side},
                 {-back, -half, -half},
                 {back + arm->length + arm->tip + piece->key_height, 2 * half, 2 * half}};
  }

  double radius = piece->node_radius + margin;
  double wide = piece->foot ? fmax(radius, piece->pad + margin) : radius;
  double deep = piece->foot ? fmax(radius, piece->base) : radius;
  return (box){
      {unit[0], unit[1], unit[2]}, {-wide, -wide, -deep}, {2 * wide, 2 * wide, deep + radius}};
}

/* Returns the volume of a box in mm3. */
static double box_volume(const box *b)
{
  return b->size[0] * b->size[1] * b->size[2];
}

/* Returns how many boxes of a piece hold a point. */
static int boxes_around(const thr_kit_piece *piece, const double at[3])
{
  int n = 0;
  for (int i = 0; i < count_boxes(piece); i++) {
    const box b = box_of(piece, i);
    bool within = true;
    for (int k = 0; k < 3; k++) {
      double place = thr_dot(at, b.axis[k]) - b.low[k];
      within &= place >= 0 && place <= b.size[k];
    }
    n += within;
  }
  return n;
}

/* Estimates the part of a piece's volume that its box i stands for, in mm3, from n points. A point
 * in several boxes counts for each of them by its share. *number: of points so far. */
static double sample_box(thr_kit_solid *solid, int i, int n, int64_t *number)
{
  const thr_kit_piece *piece = solid->piece;
  static const double root = 1.22074408460575947536; /* of x^4 = x + 1 */
  const box b = box_of(piece, i);
  double inside = 0;

  for (int j = 0; j < n; j++, (*number)++) {
    double at[3] = {0, 0, 0}, step = 1;
    for (int k = 0; k < 3; k++) {
      step /= root;
      double place = 0.5 + step * (double)*number;
      place = b.low[k] + b.size[k] * (place - floor(place));
      thr_along(at, place, b.axis[k], at);
    }
    if (is_inside(solid, at)) inside += 1.0 / fmax(boxes_around(piece, at), 1);
  }

  return box_volume(&b) * inside / n;
}

/* Estimates the volume of a piece in mm3 from about n points, as many in each box as it is large.
 * *number: of points so far. */
static double sample_piece(thr_kit_solid *solid, int n, int64_t *number)
{
  const thr_kit_piece *piece = solid->piece;
  double all = 0, volume = 0;
  for (int i = 0; i < count_boxes(piece); i++) {
    const box b = box_of(piece, i);
    all += box_volume(&b);
  }
  for (int i = 0; i < count_boxes(piece); i++) {
    const box b = box_of(piece, i);
    volume += sample_box(solid, i, 1 + (int)(n * box_volume(&b) / all), number);
  }
  return volume;
}

thr_status thr_kit_sampled_volume(const thr_kit *kit, double *volume, thr_err *err)
{
  int64_t number = 0;
  thr_status st = THR_OK;
  *volume = 0;
  for (int p = 0; p < kit->n_pieces && !st; p++) {
    const thr_kit_piece *piece = &kit->piece[p];
    thr_kit_solid solid;
    if (piece->like != p) continue;
    st = thr_kit_solid_make(&solid, piece, err);
    if (!st) *volume += piece->count * sample_piece(&solid, POINTS / kit->n_meshes, &number);
    if (!st) st = thr_kit_solid_check(&solid, err);
    thr_kit_solid_destroy(&solid);
  }
  return st;
}

thr_status thr_kit_estimate_make(thr_kit_estimate *estimate, const thr_plan *plan, thr_err *err)
{
  *estimate = (thr_kit_estimate){0};
  thr_pieces pieces;
  thr_status st = thr_pieces_make(&pieces, plan, 0, err);
  estimate->pieces = pieces.n;
  estimate->shapes = pieces.n_kinds;
  estimate->solid = pieces.solid;
  thr_pieces_destroy(&pieces);
  estimate->physics = plan->options.physics;
  estimate->physics.bead_mass = 0;
  double mm;
  thr_err unknown;
  if (st || estimate->pieces > MOST_PIECES || plan->frame.n_edges > MOST_EDGES ||
      thr_units_in_mm(plan->frame.units, &mm, &unknown))
    return st;

  thr_kit kit;
  const thr_kit_options usual = {0};
  const thr_limits limits = {.threads = 1};
  st = thr_kit_make(&kit, plan, &usual, NULL, false, &limits, &estimate->refused);
  if (!st) {
    estimate->kinds = kit.n_unnamed_kinds;
    estimate->width = kit.options.width;
    st = thr_kit_sampled_volume(&kit, &estimate->volume, err);
    estimate->mass = estimate->volume * kit.options.density / 1000; /* mm3 and g/cm3 */
    if (!st) st = thr_kit_plates_check(&kit, &estimate->refused);
  }
  thr_kit_destroy(&kit);

  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

double thr_kit_weight(const thr_kit_estimate *estimate, const thr_physics *physics)
{
  const double mass = physics->bead_mass > 0 ? physics->bead_mass * estimate->pieces
                                             : estimate->volume * physics->density / 1000;
  return mass / 1000 * physics->gravity;
}
