/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A piece as a distance: how far a point is from its surface, and on which side.
 *
 * Arms are prisms with a profile, the node is a ball, a foot is a disc; where two of them meet, the
 * corner is filled by a fillet. Channels, pockets and letters are taken away. Faces are planes that
 * cut: they belong to the arm that is nearest. */
#include "kit/kit.h"

#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Signed distance from the outline of a profile, whose inner circle has the radius; corners are
 * rounded by a part of it. u, v: across the arm. */
static double profile_distance(thr_kit_profile profile, double radius, double u, double v)
{
  if (profile == THR_KIT_ROUND) return sqrt(u * u + v * v) - radius;

  double rounding = THR_KIT_ROUNDING * radius, inner = radius - rounding;
  double x = fabs(u), y = fabs(v);
  if (profile == THR_KIT_SQUARE) {
    double over_x = x - inner, over_y = y - inner;
    return hypot(fmax(over_x, 0), fmax(over_y, 0)) + fmin(fmax(over_x, over_y), 0) - rounding;
  }

  /* A hexagon with a flat side up: by symmetry the nearest side is one of two. */
  const double normal[2] = {0.86602540378443864676, 0.5};
  double side = fmax(y, normal[0] * x + normal[1] * y);
  if (side <= inner) return side - radius;

  /* Beyond a side: the distance to the segment of that side. */
  const double half = inner / sqrt(3);
  double along, off;
  if (y >= normal[0] * x + normal[1] * y) {
    along = x;
    off = y - inner;
  } else {
    along = fabs(-normal[1] * x + normal[0] * y);
    off = normal[0] * x + normal[1] * y - inner;
  }
  return hypot(off, fmax(along - half, 0)) - rounding;
}

/* Distance to an arm, infinite beyond its face, round before its beginning. */
static double arm_distance(const thr_kit_piece *piece, const thr_kit_arm *arm, const double at[3])
{
  double s = thr_dot(at, arm->along), u = thr_dot(at, arm->up), v = thr_dot(at, arm->side);
  double part = fmin(fmax(s / arm->length, 0), 1);
  double radius = 0.5 * arm->width * (piece->taper + (1 - piece->taper) * part);

  /* A rounded tube ends in a half ball before its length. */
  if (piece->rounded) {
    double over = s - (arm->length - radius);
    if (over > 0) return sqrt(u * u + v * v + over * over) - radius;
  }
  double across = profile_distance(piece->profile, radius, v, u);
  if (s >= 0) return across;
  return piece->tube ? hypot(fmax(across, 0), s)
                     : sqrt((across + radius) * (across + radius) + s * s) - radius;
}

/* Joins two distances, a <= b, with a fillet of about a radius between them. */
static double join(double a, double b, double radius)
{
  double reach = 2 * radius;
  if (b - a >= reach || reach <= 0) return a;
  double part = 1 - (b - a) / reach;
  return a - 0.25 * reach * part * part;
}

/* Distance from a segment. */
static double segment_distance(const double at[3], const double a[3], const double b[3],
                               double *part)
{
  double d[3], e[3];
  for (int k = 0; k < 3; k++) {
    d[k] = b[k] - a[k];
    e[k] = at[k] - a[k];
  }
  double length2 = thr_dot(d, d);
  *part = length2 > 0 ? fmin(fmax(thr_dot(e, d) / length2, 0), 1) : 0;
  thr_along(e, -*part, d, e);
  return sqrt(thr_dot(e, e));
}

/* The distances of the nearest part of a piece and of the second nearest, and which the nearest is.
 */
typedef struct {
  double least, second;
  int part;
} nearest_parts;

/* Counts a part in. */
static void rank(double distance, int part, nearest_parts *near)
{
  if (distance < near->least) {
    near->second = near->least;
    near->least = distance;
    near->part = part;
  } else if (distance < near->second)
    near->second = distance;
}

/* Distance to the surface without what is hollow. *corner: how much farther the second nearest part
 * is than the nearest: 0 where they meet. */
static double body_distance(const thr_kit_piece *piece, const double at[3], int *arm,
                            double *corner)
{
  nearest_parts near = {INFINITY, INFINITY, -1};

  for (int i = 0; i < piece->n_arms; i++) {
    double here = arm_distance(piece, &piece->arm[i], at);
    rank(here, i, &near);
  }

  /* The ball of the node, and the foot's disc. Halves of a tube need no fillet between them. */
  if (!piece->tube) {
    double ball = sqrt(thr_dot(at, at)) - piece->node_radius;
    rank(ball, -1, &near);
  }
  if (piece->foot) {
    /* A disc with a round rim; its lower half is cut off at the base. */
    double rim = 0.4 * piece->base;
    double off = hypot(at[0], at[1]) - piece->pad + rim, over = fabs(at[2] + piece->base) - rim;
    double disc = hypot(fmax(off, 0), fmax(over, 0)) + fmin(fmax(off, over), 0) - rim;
    rank(disc, -2, &near);
  }
  if (piece->hook_radius > 0) {
    double part, hook = segment_distance(at, piece->hook[0], piece->hook[1], &part);
    hook = fmin(hook, segment_distance(at, piece->hook[1], piece->hook[2], &part));
    hook -= piece->hook_radius;
    rank(hook, -3, &near);
  }
  *arm = near.part;
  *corner = near.second - near.least;

  return piece->tube ? near.least : join(near.least, near.second, piece->fillet);
}

double thr_kit_body(const thr_kit_piece *piece, const double at[3], int *arm)
{
  int nearest;
  double corner, distance = body_distance(piece, at, &nearest, &corner);
  if (arm) *arm = nearest;
  return distance;
}

/* How much wider a channel is at a depth below its mouth: a quarter of a circle. */
static double flare(double mouth, double depth)
{
  if (depth >= mouth || mouth <= 0) return 0;
  double rest = mouth - fmax(depth, 0.02 * mouth);
  return mouth - sqrt(fmax(mouth * mouth - rest * rest, 0));
}

/* Distance from the mouth at one end of a channel, which is wider near its face; INFINITY where
 * there is none. */
static double mouth_distance(const thr_kit_piece *piece, const thr_kit_channel *channel, int end,
                             const double at[3])
{
  int number = end ? channel->out : channel->in;
  if (!channel->mouth[end] || number < 0) return INFINITY;
  const thr_kit_arm *arm = &piece->arm[number];
  double depth = arm->length - thr_dot(at, arm->along);
  if (depth > piece->mouth) return INFINITY;

  const double *mouth = channel->point[end ? channel->n - 1 : 0];
  const double off[3] = {at[0] - mouth[0], at[1] - mouth[1], at[2] - mouth[2]};
  double along = thr_dot(off, arm->along);
  double across = sqrt(fmax(thr_dot(off, off) - along * along, 0));
  return across - channel->radii[end] - flare(piece->mouth, depth);
}

/* Distance from the surface of what is hollow: channels and pockets. *radius: of the nearest
 * channel. */
static double hollow_distance(thr_kit_solid *solid, const double at[3], double *radius)
{
  const thr_kit_piece *piece = solid->piece;
  double best = INFINITY;
  int n, nearest = -1;
  const int *list = thr_capsules_list(&solid->hollow, at, &n);
  for (int i = 0; i < n; i++) {
    const thr_capsule *capsule = &solid->hollow.capsule[list[i]];
    double part, away = thr_capsule_distance(capsule, at, &part);
    double here = away - (capsule->radius[0] + part * (capsule->radius[1] - capsule->radius[0]));

    /* The first segment of a channel is in its arm, and the last one too. */
    if (capsule->more > 0)
      here = fmin(here, mouth_distance(piece, &piece->channel[capsule->of], capsule->last, at));
    if (here >= best) continue;
    best = here;
    nearest = capsule->of;
  }
  *radius = nearest < 0 ? INFINITY : piece->channel[nearest].radius;
  return best;
}

/* Distance from the strokes of letters on an arm, along its surface; INFINITY if there are none. */
static double letters_distance(thr_kit_solid *solid, const double at[3], int arm)
{
  if (arm < 0 || !solid->letters) return INFINITY;
  const thr_kit_piece *piece = solid->piece;
  const thr_kit_arm *on = &piece->arm[arm];
  double up = thr_dot(at, on->up), side = thr_dot(at, on->side);
  bool below = up < 0;
  thr_capsules *strokes = &solid->letters[2 * arm + below];
  if (strokes->n_capsules == 0 || up == 0) return INFINITY;
  if (below) up = -up, side = -side;
  double across = piece->profile == THR_KIT_ROUND ? atan2(side, up) * 0.5 * on->width : side;
  const double here[3] = {thr_dot(at, on->along), across, 0};

  double best = INFINITY, part;
  int n;
  const int *list = thr_capsules_list(strokes, here, &n);
  for (int i = 0; i < n; i++)
    best = fmin(best, thr_capsule_distance(&strokes->capsule[list[i]], here, &part));
  return best;
}

/* Depth of the groove at a distance from its middle: round at the bottom and at its rims, which a
 * mesh shows better than an edge. */
static double groove(const thr_kit_piece *piece, double off)
{
  double part = off / (0.7 * piece->letter_width);
  return part < 1 ? piece->letter_depth * (1 - part * part) * (1 - part * part) : 0;
}

/* Height of a key at a distance from the axis of its face; of a hollow one below 0, with play. Both
 * rims of the flank are rounded. */
static double key_height(const thr_kit_piece *piece, bool out, double off)
{
  if (piece->key == THR_KIT_NO_KEY) return 0;
  double radius = piece->key_radius + (out ? 0 : piece->key_play);
  double most = piece->key_height + (out ? 0 : piece->key_play);
  double round = 0.2 * most, flank = (radius - off) * piece->key_slope;
  double height = flank < -round         ? 0
                  : flank < round        ? (flank + round) * (flank + round) / (4 * round)
                  : flank < most - round ? flank
                  : flank < most + round
                      ? most - (most + round - flank) * (most + round - flank) / (4 * round)
                      : most;
  return out ? height : -height;
}

/* Adds the segments of a channel to what is hollow. */
static thr_status add_channel(thr_kit_solid *solid, int number, thr_err *err)
{
  const thr_kit_channel *channel = &solid->piece->channel[number];
  thr_status st = THR_OK;
  for (int i = 0; i + 1 < channel->n && !st; i++) {
    thr_capsule capsule = {.of = number};
    for (int end = 0; end < 2; end++) {
      double along = (double)(i + end) / (channel->n - 1);
      capsule.radius[end] = channel->radii[0] + along * (channel->radii[1] - channel->radii[0]);
    }
    capsule.last = i > 0;
    bool at_end = i == 0 || i + 2 == channel->n;
    if (at_end && channel->mouth[capsule.last]) capsule.more = 2 * solid->piece->mouth;
    st = thr_capsules_add(&solid->hollow, channel->point[i], channel->point[i + 1], &capsule, err);
  }
  return st;
}

/* Makes the trees of the strokes on every arm and either side. */
static thr_status add_letters(thr_kit_solid *solid, thr_err *err)
{
  const thr_kit_piece *piece = solid->piece;
  size_t sides = 2 * (size_t)piece->n_arms;
  thr_status st = THR_OK;
  solid->letters = thr_calloc(sides, sizeof *solid->letters);
  if (!solid->letters) return thr_nomem(err);

  for (int i = 0; i < piece->n_strokes && !st; i++) {
    const thr_kit_stroke *stroke = &piece->stroke[i];
    const double from[3] = {stroke->from[0], stroke->from[1], 0};
    const double to[3] = {stroke->to[0], stroke->to[1], 0};
    const thr_capsule thin = {.of = i};
    st = thr_capsules_add(&solid->letters[2 * stroke->arm + stroke->below], from, to, &thin, err);
  }
  for (int i = 0; i < 2 * piece->n_arms && !st; i++) {
    const thr_kit_arm *arm = &piece->arm[i / 2];
    double half = 0.25 * THR_PI * arm->width;
    if (solid->letters[i].n_capsules)
      st = thr_capsules_make(&solid->letters[i], 2, (double[]){-half, -half},
                             (double[]){arm->length + half, half}, piece->letter_width, err);
  }
  return st;
}

thr_status thr_kit_solid_make(thr_kit_solid *solid, const thr_kit_piece *piece, thr_err *err)
{
  *solid = (thr_kit_solid){.piece = piece, .thinnest = INFINITY};
  double reach = piece->node_radius;
  for (int i = 0; i < piece->n_arms; i++) {
    solid->thinnest = fmin(solid->thinnest, piece->arm[i].width);
    reach = fmax(reach, piece->arm[i].length + piece->arm[i].width);
  }

  thr_status st = THR_OK;
  for (int i = 0; i < piece->n_channels && !st; i++)
    st = add_channel(solid, i, err);
  for (int i = 0; i < piece->n_pockets && !st; i++) {
    const double *pocket = piece->pocket[i];
    const thr_capsule round = {.radius = {pocket[6], pocket[6]}, .of = -1};
    st = thr_capsules_add(&solid->hollow, pocket, pocket + 3, &round, err);
  }
  if (!st)
    st = thr_capsules_make(&solid->hollow, 3, (double[]){-reach, -reach, -reach},
                           (double[]){reach, reach, reach}, 0.2 * solid->thinnest, err);
  if (!st && piece->n_strokes) st = add_letters(solid, err);
  if (st) thr_kit_solid_destroy(solid);
  return st;
}

thr_status thr_kit_solid_check(const thr_kit_solid *solid, thr_err *err)
{
  bool failed = solid->hollow.failure.text[0] != '\0';
  for (int i = 0; solid->letters && i < 2 * solid->piece->n_arms; i++)
    failed |= solid->letters[i].failure.text[0] != '\0';
  return failed ? thr_nomem(err) : THR_OK;
}

void thr_kit_solid_destroy(thr_kit_solid *solid)
{
  thr_capsules_destroy(&solid->hollow);
  for (int i = 0; solid->letters && i < 2 * solid->piece->n_arms; i++)
    thr_capsules_destroy(&solid->letters[i]);
  free(solid->letters);
  *solid = (thr_kit_solid){0};
}

void thr_kit_sample(void *user, const double at[3], thr_solid_sample *out)
{
  thr_kit_solid *solid = user;
  const thr_kit_piece *piece = solid->piece;
  int nearest;
  double corner, radius, body = body_distance(piece, at, &nearest, &corner);
  double hollow = hollow_distance(solid, at, &radius);

  /* Sizes: a third of an arm, finer at channels and letters. */
  double thinnest = solid->thinnest, size = 0.38 * thinnest;
  if (!piece->tube) size = fmin(size, 1.2 * piece->fillet + 0.15 * thinnest + 0.5 * corner);
  if (nearest == -3) size = fmin(size, 0.8 * piece->hook_radius);
  size = fmin(size, 1.2 * radius + 0.7 * fabs(hollow));
  /* Thin walls are not to fall between the corners of tetrahedra. */
  size = fmin(size, fmax(0.8 * (fabs(body) + fabs(hollow)),
                         fmax(0.7 * piece->wall, isfinite(radius) ? 0.2 * radius : 0)));
  if (piece->n_strokes && body > -2 * piece->letter_depth && body < size) {
    double letters = letters_distance(solid, at, nearest);
    body += groove(piece, letters);
    /* As fine as strokes are wide in the groove; coarser beside it, and below. */
    double beside = fmax(letters - 0.7 * piece->letter_width, 0);
    double below = fmax(fabs(body) - 0.5 * piece->letter_depth, 0);
    size = fmin(size, 0.8 * piece->letter_width + 1.2 * (beside + below));
  }
  out->distance = fmax(body, -hollow);
  out->size = size * piece->coarse;

  /* The cut of the nearest arm, or of the base. */
  out->cut = -1e3 * thinnest;
  memset(out->across, 0, sizeof out->across);
  for (int i = 0; nearest == -1 && i < piece->n_arms; i++) {
    /* The ball of a node may reach beyond the faces of short arms. */
    double here = thr_dot(at, piece->arm[i].along) - piece->arm[i].length;
    if (here <= out->cut) continue;
    out->cut = here;
    memcpy(out->across, piece->arm[i].along, sizeof out->across);
  }
  if (nearest >= 0 && !piece->rounded) {
    const thr_kit_arm *arm = &piece->arm[nearest];
    double s = thr_dot(at, arm->along);
    if (arm->n_mitres == 0) {
      double off = sqrt(fmax(thr_dot(at, at) - s * s, 0));
      out->cut = s - arm->length - key_height(piece, arm->key_out, off);
      memcpy(out->across, arm->along, sizeof out->across);
      /* Flanks of keys are no planes. */
      if (piece->key != THR_KIT_NO_KEY && off < piece->key_radius + size &&
          fabs(s - arm->length) < size + piece->key_height)
        out->size = fmin(out->size, 0.16 * arm->width);
    }
    if (arm->n_mitres > 0) out->cut = s - arm->length - arm->tip; /* whatever its mitres leave */
    for (int i = 0; i < arm->n_mitres; i++) {
      double here = thr_dot(at, arm->mitre[i]) - arm->mitre[i][3];
      if (here <= out->cut) continue;
      out->cut = here;
      memcpy(out->across, arm->mitre[i], sizeof out->across);
    }
  }
  if (piece->foot && -at[2] - piece->base > out->cut) {
    out->cut = -at[2] - piece->base;
    memcpy(out->across, (double[]){0, 0, -1}, sizeof out->across);
  }
}
