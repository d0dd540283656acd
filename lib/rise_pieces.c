/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes of a kit what can rise (rise_pieces.h). */
#include "lib/rise_pieces.h"
#include "diagram/layout/layout.h"
#include "eval/cord/profile.h"
#include "graph/number.h"
#include "kit/film.h"

#include <math.h>
#include <string.h>

static const double SPREAD = 1.15; /* of the shortest edges of what lies flat: faces are apart */
static const double UP = 0.1;      /* of the width: so much higher is up */
enum { ROUND = 8, MOST_SIDES = ROUND }; /* corners of what stands for a circle */

/* Fills the corners of a prism with n sides round an axis, from one end to the other. Corners are
 * `radius` from the axis, the first at `first` rad from `up`. Returns their number. */
static int prism(const double along[3], const double up[3], const double side[3], double from,
                 double to, double radius, int n, double first, double (*corner)[3])
{
  for (int end = 0; end < 2; end++)
    for (int i = 0; i < n; i++) {
      const double angle = first + 2 * THR_PI * i / n;
      for (int k = 0; k < 3; k++)
        corner[end * n + i][k] =
            (end ? to : from) * along[k] + radius * (cos(angle) * up[k] + sin(angle) * side[k]);
    }
  return 2 * n;
}

int thr_rise_section(thr_kit_profile profile, double *radius, double *first)
{
  *first = 0;
  switch (profile) {
  case THR_KIT_SQUARE:
    *radius = sqrt(0.5);
    *first = THR_PI / 4;
    return 4;
  case THR_KIT_HEX: *radius = 1 / sqrt(3); return 6;
  default: *radius = 0.5; return ROUND;
  }
}

/* Fills a piece from that of a kit. */
static void make_piece(const thr_kit *kit, int p, int *n_corners, double (*corner)[3],
                       thr_rise_piece *out)
{
  const thr_kit_piece *piece = &kit->piece[p];
  double radius, first, volume = 0, moment = 0, centre[3] = {0, 0, 0};
  const int sides = thr_rise_section(piece->profile, &radius, &first);
  int n = 0;
  *out = (thr_rise_piece){.n_corners = n_corners, .corner = (const double(*)[3])corner};
  memcpy(out->centre, piece->centre, sizeof out->centre);

  for (int i = 0; i < piece->n_arms; i++) {
    const thr_kit_arm *arm = &piece->arm[i];
    n_corners[out->n_parts++] = 2 * sides;
    n += prism(arm->along, arm->up, arm->side, 0, arm->length, radius * arm->width, sides, first,
               corner + n);

    /* Behind the node of a piece with one arm is half a ball, whose circle at 45 degrees stands for
     * it: a box would fall over without it. There is room: it has no foot. */
    if (piece->n_arms == 1 && !piece->foot && piece->profile == THR_KIT_SQUARE) {
      const double back = sqrt(0.5) * piece->node_radius;
      double ring[2 * MOST_SIDES][3];
      prism(arm->along, arm->up, arm->side, -back, -back, back, sides, first, ring);
      memcpy(corner + n, ring, (size_t)sides * sizeof *ring);
      n_corners[out->n_parts - 1] += sides;
      n += sides;
    }

    /* An arm of length a and width w has, for its mass, a^2 / 3 + w^2 / 6 about the node. */
    const double length = arm->length, share = length * arm->width * arm->width;
    volume += share;
    moment += share * (length * length / 3 + arm->width * arm->width / 6);
    thr_along(centre, share * 0.5 * length, arm->along, centre);
  }
  if (piece->foot) {
    const double down[3] = {0, 0, -1}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0};
    n_corners[out->n_parts++] = 2 * ROUND;
    prism(down, x, y, 0, piece->base, piece->pad, ROUND, THR_PI / ROUND, corner + n);
  }
  for (int k = 0; k < 3; k++)
    out->mass_centre[k] = centre[k] / volume;

  /* What is printed, if that is known. */
  const thr_mesh_report *report = &kit->report[piece->like];
  const double around = piece->profile == THR_KIT_ROUND ? THR_PI / 4 : 1;
  double solid = around * volume;
  if (report->volume > 0) {
    double place[3];
    solid = report->volume;
    thr_kit_place(piece, report->centre, place);
    thr_between(piece->centre, place, out->mass_centre);
  }
  out->mass = solid * kit->options.density / 1000;
  const double off = thr_dot(out->mass_centre, out->mass_centre);
  double least = INFINITY;
  for (int i = 0; i < piece->n_arms; i++)
    least = fmin(least, piece->arm[i].width);
  out->moment = out->mass * 2. / 3 * fmax(moment / volume - off, least * least / 6);
}

/* Fills a cord. */
static void make_cord(const thr_kit *kit, int c, thr_pull pull, const thr_physics *physics,
                      int *piece, double (*mouth)[3], double (*along)[3], double *wobble,
                      thr_rise_cord *out)
{
  const thr_frame *frame = &kit->plan->frame;
  const thr_cord *cord = &kit->plan->cord[c];
  *out = (thr_rise_cord){.n_passes = cord->n_passes,
                         .piece = piece,
                         .mouth = (const double(*)[3])mouth,
                         .along = (const double(*)[3])along,
                         .wobble = wobble,
                         .pulled = {pull == THR_PULL_START || pull == THR_PULL_BOTH,
                                    pull == THR_PULL_END || pull == THR_PULL_BOTH}};

  for (int k = 0; k < cord->n_passes; k++) {
    const int half = cord->half[k];
    const thr_kit_edge *edge = &kit->edges.edge[half >> 1];
    const int lane = edge->n_lanes > 1 ? kit->edges.lane[kit->edges.first_pass[c] + k] : 0;
    piece[k] = thr_tail(frame, half);
    piece[k + 1] = thr_head(frame, half);
    const double *node = kit->piece[frame->edge[half >> 1][0]].centre;
    for (int i = 0; i < 3; i++) {
      mouth[k][i] = node[i] + 0.5 * edge->length * edge->along[i] +
                    edge->lane[lane][0] * edge->up[i] + edge->lane[lane][1] * edge->side[i];
      along[k][i] = half & 1 ? -edge->along[i] : edge->along[i];
    }
    if (k) wobble[k - 1] = thr_profile_wobble(frame, physics, cord, k - 1, physics->mu);
  }
}

const char *thr_rise_feet_name(int feet)
{
  static const char *const name[] = {"free", "ground", "held"};
  return feet >= 0 && feet < THR_RISE_N_FEET ? name[feet] : NULL;
}

/* Turns piece p from how it is drawn so that its edges lie on paper as well as they can. */
static thr_status turn_flat(const thr_kit *kit, const thr_layout *layout, int p, double q[4],
                            thr_err *err)
{
  const thr_frame *frame = &kit->plan->frame;
  const int n = frame->first[p + 1] - frame->first[p];
  thr_scratch work = {0};
  double(*drawn)[3] = thr_scratch_array(&work, 2 * ((size_t)n + 1), sizeof *drawn);
  double(*flat)[3] = thr_scratch_array(&work, 2 * ((size_t)n + 1), sizeof *flat);
  thr_status st = thr_scratch_check(&work, err);

  /* Edges both ways, so that the piece turns about its node; what they leave open stays upright. */
  for (int i = 0; i <= n && !st; i++) {
    double *one = drawn[2 * i], *other = flat[2 * i];
    one[2] = other[2] = 1e-3;
    if (i < n) {
      const int half = frame->half[frame->first[p] + i], head = thr_head(frame, half);
      for (int k = 0; k < 3; k++) {
        one[k] = kit->piece[head].centre[k] - kit->piece[p].centre[k];
        other[k] = k < 2 ? layout->xy[head][k] - layout->xy[p][k] : 0;
      }
      thr_normalize(one);
      thr_normalize(other);
    }
    for (int k = 0; k < 3; k++) {
      drawn[2 * i + 1][k] = -one[k];
      flat[2 * i + 1][k] = -other[k];
    }
  }
  if (!st)
    thr_fit_points((const double(*)[3])drawn, (const double(*)[3])flat, 2 * (n + 1), q, NULL);
  thr_scratch_free(&work);
  return st;
}

/* Do all places lie on a straight line? */
static bool is_row(const double (*laid)[7], int n)
{
  double mean[2] = {0, 0}, xx = 0, xy = 0, yy = 0;
  for (int p = 0; p < n; p++)
    for (int k = 0; k < 2; k++)
      mean[k] += laid[p][k] / n;
  for (int p = 0; p < n; p++) {
    const double x = laid[p][0] - mean[0], y = laid[p][1] - mean[1];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  return xx * yy - xy * xy < 1e-6 * (xx + yy) * (xx + yy);
}

/* Fills where pieces lie when all is laid out as the overview of a plan shows it, so large that no
 * edge is shorter than SPREAD times what it is when it is closed. *known: false for what is shown
 * from the side or in a row, as an arch, whose pieces stand in their places on the ground. */
static thr_status lay_flat(const thr_kit *kit, double (*laid)[7], bool *known, thr_err *err)
{
  const thr_frame *frame = &kit->plan->frame;
  thr_layout layout = {0};
  double largest = 0, middle[2] = {0, 0};
  thr_status st = thr_layout_choose(&layout, frame, NULL, 0, err);
  for (int e = 0; e < frame->n_edges && !st; e++) {
    const int *end = frame->edge[e];
    const double *one = layout.xy[end[0]], *other = layout.xy[end[1]],
                 paper = hypot(one[0] - other[0], one[1] - other[1]);
    if (paper > 0)
      largest =
          fmax(largest, thr_distance(kit->piece[end[0]].centre, kit->piece[end[1]].centre) / paper);
  }
  for (int p = 0; p < frame->n_nodes && !st; p++)
    for (int k = 0; k < 2; k++)
      middle[k] += layout.xy[p][k] / frame->n_nodes;
  for (int p = 0; p < frame->n_nodes && !st; p++) {
    for (int k = 0; k < 2; k++)
      laid[p][k] = SPREAD * largest * (layout.xy[p][k] - middle[k]);
    st = turn_flat(kit, &layout, p, laid[p] + 3, err);
  }
  *known = !st && layout.kind != THR_LAYOUT_FRONT && layout.kind != THR_LAYOUT_SIDE &&
           layout.kind != THR_LAYOUT_PLANE && !is_row((const double(*)[7])laid, frame->n_nodes);
  thr_layout_destroy(&layout);
  return st;
}

/* Do feet below all else carry the shape, so that it has a side that is up? Rows and flat grids
 * have none. */
static bool stands_up(const thr_kit *kit, const bool *foot)
{
  /* The least and the largest height of feet, and of other pieces. */
  double height[2][2] = {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}};
  for (int p = 0; p < kit->n_pieces; p++) {
    double *range = height[!foot[p]];
    range[0] = fmin(range[0], kit->piece[p].centre[2]);
    range[1] = fmax(range[1], kit->piece[p].centre[2]);
  }
  const double over = UP * kit->options.width;
  return height[0][0] <= height[1][0] + over && height[0][1] < height[1][1] - over;
}

/* Fills made, whether or not its pieces overlap. */
static thr_status make_all(thr_rise_kit *made, const thr_kit *kit, const thr_pull *pull,
                           thr_rise_feet feet, const thr_physics *physics, thr_err *err)
{
  const thr_plan *plan = kit->plan;
  if (plan->options.joint != THR_JOINT_SOLID)
    return thr_fail(err, THR_EINPUT,
                    "rise: pieces that are tubes cannot be simulated: solid "
                    "joints only (plan --joint solid)");

  /* All arrays, one after the other. */
  size_t parts = 0, passes = 0, next = 0, pass = 0;
  int n_feet = 0;
  bool known = false;
  for (int p = 0; p < kit->n_pieces; p++)
    parts += (size_t)kit->piece[p].n_arms + 1;
  for (int c = 0; c < plan->n_cords; c++)
    passes += (size_t)plan->cord[c].n_passes;
  thr_rise_piece *piece = thr_scratch_array(&made->own, (size_t)kit->n_pieces, sizeof *piece);
  thr_rise_cord *cord = thr_scratch_array(&made->own, (size_t)plan->n_cords, sizeof *cord);
  int *n_corners = thr_scratch_array(&made->own, parts, sizeof *n_corners);
  double(*corner)[3] = thr_scratch_array(&made->own, parts * 2 * MOST_SIDES, sizeof *corner);
  int *visited = thr_scratch_array(&made->own, passes + (size_t)plan->n_cords, sizeof *visited);
  double(*mouth)[3] = thr_scratch_array(&made->own, passes, sizeof *mouth);
  double(*along)[3] = thr_scratch_array(&made->own, passes, sizeof *along);
  double *wobble = thr_scratch_array(&made->own, passes, sizeof *wobble);
  double(*laid)[7] = thr_scratch_array(&made->own, (size_t)kit->n_pieces, sizeof *laid);
  thr_status st = thr_scratch_check(&made->own, err);
  if (!st) st = lay_flat(kit, laid, &known, err);
  if (st) return st;

  for (int p = 0; p < kit->n_pieces; p++) {
    make_piece(kit, p, n_corners + next, corner + next * 2 * MOST_SIDES, &piece[p]);
    piece[p].held = feet == THR_RISE_HELD && plan->frame.foot[p];
    piece[p].down = feet == THR_RISE_GROUND && plan->frame.foot[p];
    n_feet += plan->frame.foot[p];
    next += (size_t)kit->piece[p].n_arms + 1;
  }
  if (n_feet == 0 && feet != THR_RISE_FREE)
    return thr_fail(err, THR_EINPUT, "rise: the plan has no feet, which could be %s",
                    feet == THR_RISE_HELD ? "held" : "kept on the ground");
  for (int c = 0; c < plan->n_cords; c++) {
    make_cord(kit, c, pull[c], physics, visited + pass + (size_t)c, mouth + pass, along + pass,
              wobble + pass, &cord[c]);
    pass += (size_t)plan->cord[c].n_passes;
  }

  made->piece = piece;
  made->cord = cord;
  made->structure = (thr_rise_structure){.n_pieces = kit->n_pieces,
                                         .n_cords = plan->n_cords,
                                         .piece = piece,
                                         .cord = cord,
                                         .mat = known ? (const double(*)[7])laid : NULL,
                                         .width = kit->options.width,
                                         .stands_up = stands_up(kit, plan->frame.foot),
                                         .mouth_depth = kit->cord,
                                         .physics = *physics};
  return THR_OK;
}

/* Finds the widest arms with which the pieces of a kit do not overlap, mm, by bisection; 0: none
 * found. */
static double width_that_fits(const thr_kit *kit, const thr_pull *pull, thr_rise_feet feet,
                              const thr_physics *physics)
{
  enum { STEPS = 7 };
  double fits = 0, narrow = 0, wide = kit->options.width;
  for (int i = 0; i < STEPS; i++) {
    const double width = 0.5 * (narrow + wide);
    int ignored[2];
    double depth = INFINITY;
    thr_err err = {0};
    thr_kit thin;
    thr_rise_kit trial = {0};
    thr_kit_options options = kit->options;
    options.width = width;
    thr_status st = thr_kit_make(&thin, kit->plan, &options, NULL, false, NULL, &err);
    if (!st) st = make_all(&trial, &thin, pull, feet, physics, &err);
    if (!st) st = thr_rise_overlap(&trial.structure, ignored, &depth, &err);
    thr_rise_kit_destroy(&trial);
    thr_kit_destroy(&thin);

    /* What has no room for its channels is too thin. */
    if (st == THR_ENOMEM) return 0;
    *(depth == 0 || st ? &narrow : &wide) = width;
    if (!st && depth == 0) fits = width;
  }

  /* Three digits, and no more than was tried. */
  const double digit = fits > 0 ? pow(10, floor(log10(fits)) - 2) : 1;
  return digit * floor(fits / digit);
}

thr_status thr_rise_kit_make(thr_rise_kit *made, const thr_kit *kit, const thr_pull *pull,
                             thr_rise_feet feet, const thr_physics *physics, thr_err *err)
{
  int piece[2] = {0, 0};
  double depth = 0;
  *made = (thr_rise_kit){0};
  thr_status st = make_all(made, kit, pull, feet, physics, err);
  if (!st) st = thr_rise_overlap(&made->structure, piece, &depth, err);
  if (st || depth == 0) return st;

  const double width = width_that_fits(kit, pull, feet, physics);
  return thr_fail(err, THR_EINPUT,
                  width > 0 ? "rise: pieces %s and %s are %.2g mm in each other when closed: "
                              "narrower arms fit, --width %.3g"
                            : "rise: pieces %s and %s are %.2g mm in each other when closed",
                  kit->name[piece[0]], kit->name[piece[1]], depth, width);
}

void thr_rise_kit_destroy(thr_rise_kit *made)
{
  thr_scratch_free(&made->own);
  *made = (thr_rise_kit){0};
}

thr_status thr_rise_movement(thr_movement *movement, const thr_kit *kit,
                             const thr_rise_record *record, thr_err *err)
{
  const thr_plan *plan = kit->plan;
  thr_status st = thr_film_movement(movement, kit, record->n_frames, err);
  if (st) return st;
  movement->seconds = record->between;
  movement->floor = 0;
  movement->n_faces = record->n_counted;
  memcpy(movement->pose, record->pose,
         (size_t)record->n_frames * (size_t)record->n_pieces * sizeof *movement->pose);

  for (int f = 0; f < record->n_frames; f++) {
    const thr_rise_moment *moment = &record->moment[f];
    movement->state[f] =
        (thr_movement_state){moment->time, moment->pull, moment->drawn, moment->closed};
    const double *from = record->tension + (size_t)f * (size_t)record->n_passes;
    double *to = movement->tension + (size_t)f * (size_t)movement->first[plan->n_cords];

    /* Between the mouths of a pass its tension; inside a piece that of the pass before; in a tail,
     * the pull. */
    for (int c = 0; c < plan->n_cords; c++) {
      double *piece = to + movement->first[c];
      const int open = plan->cord[c].closed ? 0 : 1;
      if (open) piece[0] = from[0];
      for (int k = 0; k < plan->cord[c].n_passes; k++) {
        piece[open + 2 * k] = from[k];
        piece[open + 2 * k + 1] = from[k];
      }
      from += plan->cord[c].n_passes;
    }
  }
  return THR_OK;
}
