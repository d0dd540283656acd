/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Other shapes of the pieces of a kit (rise_pieces.h): one that a cord closes, one that a rise
 * begins from.
 *
 * Example: a straight row of five cubes with two cords. Cord B's shape has the same nodes round a
 * corner: A, B, C in a line and D, E at right angles to it. D and E are turned, and C keeps the arm
 * that leads to B: cord B leaves C by its side, on which the face of D is seated (M. Nelson,
 * thesis, Cornell, Fig. 22). */
#include "graph/number.h"
#include "lib/rise_pieces.h"

#include <math.h>
#include <string.h>

static const double SAME = 1e-6;     /* rad between directions that are one */
static const double MEETS = 1e-3;    /* of the distance of two nodes: faces that meet */
static const double AS_DRAWN = 0.01; /* pull towards the drawn rotation where arms leave it open */

/* The unit vector from node a to node b of a framework; false: they are in one place. */
static bool direction(const thr_frame *shape, int a, int b, double out[3])
{
  thr_between(shape->xyz[a], shape->xyz[b], out);
  return thr_normalize(out) > 0;
}

/* Fills q with the smallest rotation that takes unit vector a to b. */
static void shortest_rotation(const double a[3], const double b[3], double q[4])
{
  double length = 0;
  thr_cross(a, b, q);
  q[3] = 1 + thr_dot(a, b);

  /* Opposite: half a turn about any axis across. */
  if (q[3] < 1e-12) {
    const int least = fabs(a[0]) < fabs(a[1]) ? (fabs(a[0]) < fabs(a[2]) ? 0 : 2)
                                              : (fabs(a[1]) < fabs(a[2]) ? 1 : 2);
    const double axis[3] = {least == 0, least == 1, least == 2};
    thr_cross(a, axis, q);
    q[3] = 0;
  }
  for (int k = 0; k < 4; k++)
    length += q[k] * q[k];
  for (int k = 0; k < 4; k++)
    q[k] /= sqrt(length);
}

static void turned(const double q[4], const double v[3], double out[3])
{
  double turn[9];
  thr_quaternion_turn(q, turn);
  for (int k = 0; k < 3; k++)
    out[k] = thr_dot(turn + 3 * k, v);
}

static void turned_back(const double q[4], const double v[3], double out[3])
{
  const double back[4] = {-q[0], -q[1], -q[2], q[3]};
  turned(back, v, out);
}

/* Refuses a framework that is no shape of the kit's pieces. */
static thr_status check_shape(const thr_kit *kit, const thr_frame *shape, thr_err *err)
{
  const thr_frame *frame = &kit->plan->frame;
  double ignored[3];
  if (shape->n_nodes != frame->n_nodes)
    return thr_fail(err, THR_EINPUT,
                    "a shape of these pieces has %d nodes in the same order, not %d",
                    frame->n_nodes, shape->n_nodes);
  for (int e = 0; e < frame->n_edges; e++)
    if (thr_frame_edge_between(shape, frame->edge[e][0], frame->edge[e][1]) < 0 ||
        !direction(shape, frame->edge[e][0], frame->edge[e][1], ignored))
      return thr_fail(err, THR_EINPUT,
                      "a shape of these pieces has their edges: there is none between %s and %s",
                      shape->name[frame->edge[e][0]], shape->name[frame->edge[e][1]]);
  return THR_OK;
}

/* How many arms of a piece are along the edges of a shape when it is turned by q. */
static int count_along(const thr_kit *kit, int p, const thr_frame *shape, const double q[4])
{
  const thr_kit_piece *piece = &kit->piece[p];
  int n = 0;
  for (int i = 0; i < piece->n_arms; i++) {
    double arm[3], edge[3];
    turned(q, piece->arm[i].along, arm);
    direction(shape, p, thr_head(&kit->plan->frame, piece->arm[i].half), edge);
    n += thr_angle_between(arm, edge) < SAME;
  }
  return n;
}

/* Fills q with the rotation of a piece that has most of its arms along the edges of a shape: that
 * of the first arm by which it does. */
static void turn_exactly(const thr_kit *kit, int p, const thr_frame *shape, double q[4])
{
  const thr_kit_piece *piece = &kit->piece[p];
  int most = 0;
  memcpy(q, (const double[4]){0, 0, 0, 1}, 4 * sizeof *q);
  for (int i = 0; i < piece->n_arms; i++) {
    double edge[3], try[4];
    direction(shape, p, thr_head(&kit->plan->frame, piece->arm[i].half), edge);
    shortest_rotation(piece->arm[i].along, edge, try);
    const int n = count_along(kit, p, shape, try);
    if (n > most) {
      most = n;
      memcpy(q, try, sizeof try);
    }
  }
}

/* Fills q with the rotation that has the arms of a piece nearest to the edges of a shape, by least
 * squares of opposite pairs of points, and near to the drawn one where they leave it open. */
static void turn_nearly(const thr_kit *kit, int p, const thr_frame *shape, double q[4])
{
  const thr_kit_piece *piece = &kit->piece[p];
  double from[2 * (THR_KIT_MOST_ARMS + 3)][3] = {{0}}, to[2 * (THR_KIT_MOST_ARMS + 3)][3] = {{0}};
  int n = 0;
  for (int i = 0; i < piece->n_arms + 3; i++)
    for (int side = -1; side <= 1; side += 2, n++) {
      double edge[3] = {i == piece->n_arms, i == piece->n_arms + 1, i == piece->n_arms + 2};
      const double *arm = i < piece->n_arms ? piece->arm[i].along : edge;
      for (int k = 0; k < 3; k++)
        from[n][k] = side * arm[k] * (i < piece->n_arms ? 1 : AS_DRAWN);
      if (i < piece->n_arms)
        direction(shape, p, thr_head(&kit->plan->frame, piece->arm[i].half), edge);
      for (int k = 0; k < 3; k++)
        to[n][k] = side * edge[k] * (i < piece->n_arms ? 1 : AS_DRAWN);
    }
  thr_fit_points((const double(*)[3])from, (const double(*)[3])to, n, q, NULL);
}

/* Fills place[n_pieces] with the pieces in a shape, mm. */
static void place_pieces(const thr_kit *kit, const thr_frame *shape,
                         void (*turn)(const thr_kit *, int, const thr_frame *, double[4]),
                         double (*place)[7])
{
  const double mm = kit->mm;
  for (int p = 0; p < kit->n_pieces; p++) {
    for (int k = 0; k < 3; k++)
      place[p][k] = mm * shape->xyz[p][k];
    turn(kit, p, shape, place[p] + 3);
  }
}

thr_status thr_rise_kit_lay(thr_rise_kit *made, const thr_kit *kit, const thr_frame *shape,
                            thr_err *err)
{
  double(*place)[7] = thr_scratch_array(&made->own, (size_t)kit->n_pieces, sizeof *place);
  thr_status st = thr_scratch_check(&made->own, err);
  if (!st) st = check_shape(kit, shape, err);
  if (st) return st;
  place_pieces(kit, shape, turn_nearly, place);
  made->structure.laid = (const double(*)[7])place;
  return THR_OK;
}

/* Returns how far a ray from the node of a piece leads before it leaves the arms, mm; *arm: the arm
 * whose face it leaves by, -1: a side. */
static double reach_of(const thr_kit_piece *piece, const double ray[3], int *arm)
{
  double radius, first, most = 0;
  const int sides = thr_rise_section(piece->profile, &radius, &first);
  *arm = -1;
  for (int i = 0; i < piece->n_arms; i++) {
    const thr_kit_arm *a = &piece->arm[i];
    const double forward = thr_dot(ray, a->along);
    if (forward < -SAME) continue;
    double reach = forward > SAME ? a->length / forward : INFINITY;
    bool face = true;

    /* The planes of the sides. */
    for (int s = 0; s < sides; s++) {
      const double angle = first + (2 * s + 1) * THR_PI / sides;
      const double across = cos(angle) * thr_dot(ray, a->up) + sin(angle) * thr_dot(ray, a->side);
      if (across <= SAME) continue;
      const double side = a->width * radius * cos(THR_PI / sides) / across;
      if (side < reach) {
        reach = side;
        face = false;
      }
    }
    if (reach > most) {
      most = reach;
      *arm = face && forward > 1 - SAME ? i : -1;
    }
  }
  return most;
}

/* Fills mouth and along of pass k of a cord in its shape. */
static thr_status seat_pass(const thr_kit *kit, int c, int k, const double (*place)[7],
                            double mouth[3], double along[3], thr_err *err)
{
  const thr_cord *cord = &kit->plan->cord[c];
  const int half = cord->half[k], e = half >> 1;
  const int piece[2] = {thr_tail(&kit->plan->frame, half), thr_head(&kit->plan->frame, half)};
  double reach[2];
  int arm[2];

  thr_between(place[piece[0]], place[piece[1]], along);
  const double distance = thr_normalize(along);
  for (int end = 0; end < 2; end++) {
    const double out[3] = {end ? -along[0] : along[0], end ? -along[1] : along[1],
                           end ? -along[2] : along[2]};
    double ray[3];
    turned_back(place[piece[end]] + 3, out, ray);
    reach[end] = reach_of(&kit->piece[piece[end]], ray, &arm[end]);
  }
  char id[12];
  thr_cord_id(c, id);
  if (fabs(reach[0] + reach[1] - distance) > MEETS * distance)
    return thr_fail(err, THR_EINPUT,
                    "in the shape of cord %s the faces of %s and %s do not meet: their nodes are "
                    "%.4g mm from each other, their faces meet at %.4g mm",
                    id, kit->name[piece[0]], kit->name[piece[1]], distance, reach[0] + reach[1]);

  /* The lane is that of a face of an arm, turned with its piece. */
  const int with = arm[0] >= 0 ? 0 : 1;
  const thr_kit_edge *edge = &kit->edges.edge[e];
  const int lane = edge->n_lanes > 1 ? kit->edges.lane[kit->edges.first_pass[c] + k] : 0;
  double off[3] = {0}, beside[3];
  for (int i = 0; i < 3 && arm[with] >= 0; i++)
    off[i] = edge->lane[lane][0] * edge->up[i] + edge->lane[lane][1] * edge->side[i];
  turned(place[piece[with]] + 3, off, beside);
  for (int i = 0; i < 3; i++)
    mouth[i] = place[piece[0]][i] + reach[0] * along[i] + beside[i];
  return THR_OK;
}

thr_status thr_rise_kit_shape(thr_rise_kit *made, const thr_kit *kit, int cord,
                              const thr_frame *shape, thr_err *err)
{
  thr_rise_cord *out = &made->cord[cord];
  const size_t passes = (size_t)out->n_passes;
  double(*place)[7] = thr_scratch_array(&made->own, (size_t)kit->n_pieces, sizeof *place);
  double(*mouth)[3] = thr_scratch_array(&made->own, passes, sizeof *mouth);
  double(*along)[3] = thr_scratch_array(&made->own, passes, sizeof *along);
  thr_status st = thr_scratch_check(&made->own, err);
  if (!st) st = check_shape(kit, shape, err);
  if (st) return st;

  place_pieces(kit, shape, turn_exactly, place);
  for (int k = 0; k < out->n_passes && !st; k++)
    st = seat_pass(kit, cord, k, (const double(*)[7])place, mouth[k], along[k], err);
  if (st) return st;
  out->place = (const double(*)[7])place;
  out->mouth = (const double(*)[3])mouth;
  out->along = (const double(*)[3])along;
  return THR_OK;
}
