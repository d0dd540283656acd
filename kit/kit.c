/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A kit from a plan: sizes, then edges, then the shape of every piece, then which pieces are alike,
 * then a mesh for each that is not like an earlier one.
 *
 * The pieces' local coordinates have the axes of the framework and the node, or the middle of the
 * edge, as their origin. */
#include "kit/files.h"
#include "kit/kit.h"

#include "diagram/overview/overview_parts.h"
#include "diagram/tables/tables.h"
#include "graph/plan/plan_measures.h"
#include "graph/process/process.h"
#include "graph/number.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Parts of the width of an arm, unless asked for otherwise. */
static const double FILLET = 0.15, NODE = 0.6, MOUTH = 0.08;
/* How far a foot's base lies below its node in widths of the widest arm: usually, and at most, so
 * that its disc still meets the ball of the node. */
static const double BASE = 0.75, DEEPEST = 0.95;
/* mm: of a wall, of letters, and how deep these are; of a key's play. */
static const double WALL = 1.2, LETTERS = 4, DEPTH = 0.6, PLAY = 0.15;
static const double THINNEST = 0.4; /* a line of the usual nozzle */
/* Longer arms are refused. */
enum { MOST_WIDTHS = 300 };
/* How far simplifying may move a surface, as a part of the narrowest arm and in mm: a tenth of what
 * a printer shows. */
static const double SIMPLE = 0.003, SIMPLEST = 0.02;
/* A knot is three cords thick (an overhand knot: C. Ashley, 1944). */
static const double KNOT = 3;

/* While the pieces are made. */
typedef struct {
  thr_kit *kit;
  const thr_frame *frame;
  thr_kit_sizes sizes;
  thr_guide guide;
  thr_pieces pieces;
  thr_channels channels;
  bool *foot;     /* [n_nodes] */
  int unnamed;    /* arms and pieces without room for a name */
  double letters; /* height that all of their names have room for */
  thr_scratch own;
} maker;

/* ---- words of options ---- */

const char *thr_kit_profile_name(int i)
{
  static const char *const name[] = {"round", "square", "hex"};
  return name[i];
}

const char *thr_kit_key_name(int i)
{
  static const char *const name[] = {"none", "cone", "pin"};
  return name[i];
}

const char *thr_kit_channels_name(int i)
{
  static const char *const name[] = {"bore", "lanes"};
  return name[i];
}

const char *thr_kit_crossings_name(int i)
{
  static const char *const name[] = {"meet", "apart"};
  return name[i];
}

const char *thr_kit_names_name(int i)
{
  static const char *const name[] = {"pieces", "kinds", "none"};
  return name[i];
}

const char *thr_kit_foot_name(int i)
{
  static const char *const name[] = {"hole", "hook"};
  return name[i];
}

const char *thr_kit_tube_ends_name(int i)
{
  static const char *const name[] = {"mitred", "rounded"};
  return name[i];
}

/* ---- sizes ---- */

/* Finds all sizes: as asked for, else as the plan was evaluated or asked for, else worked out. */
static thr_status find_sizes(maker *work, const thr_kit_options *asked, thr_err *err)
{
  thr_kit *kit = work->kit;
  const thr_plan *plan = kit->plan;
  double mm;
  thr_status st = thr_units_in_mm(plan->frame.units, &mm, err);
  if (st) return st;
  thr_physics physics = plan->evaluation.physics;
  if (!plan->evaluation.present)
    st = thr_physics_resolve(&plan->options.physics, &plan->frame, &physics, err);
  if (st) return st;

  thr_kit_options *options = &kit->options;
  *options = *asked;
  if (!(options->width > 0)) options->width = physics.bead_diameter;
  if (!(options->taper > 0)) options->taper = 1;
  if (options->fillet == 0) options->fillet = FILLET * options->width;
  if (!(options->density > 0)) options->density = physics.density;
  if (!(options->letters > 0)) options->letters = LETTERS;
  if (!(options->key_angle > 0))
    options->key_angle = (options->key == THR_KIT_PIN ? 5 : 45) * THR_PI / 180;
  for (int i = 0; i < 2; i++)
    if (!(options->bed[i] > 0)) options->bed[i] = 220;

  work->sizes = (thr_kit_sizes){.mm = mm,
                                .cord = physics.cord_diameter,
                                .width = options->width,
                                .wall = options->wall > 0 ? options->wall : WALL,
                                .node = NODE * options->taper,
                                .wall_given = options->wall > 0};
  kit->mm = mm;
  kit->cord = physics.cord_diameter;

  return THR_OK;
}

/* Sets the bore of every edge: wide enough for one cord in each lane, or for all. */
static thr_status set_bores(maker *work, thr_err *err)
{
  thr_kit *kit = work->kit;
  thr_supplies supplies = {0};
  thr_status st = thr_supplies_make(&supplies, kit->plan, err);
  if (!st) st = thr_supplies_find_sizes(&supplies, err);
  for (int e = 0; e < work->frame->n_edges && !st; e++) {
    bool lanes = kit->options.channels == THR_KIT_LANES;
    double bore = thr_supplies_bore_mm(&supplies, thr_supplies_bore(&supplies, e));
    /* With a lane for each pass the bore of the plan is that of one lane. */
    if (lanes && supplies.passes[e] > 1)
      bore = fmax(supplies.bore, 1.4 * supplies.cord); /* NFPA 70: one cord fills 0.53 of it */
    kit->edges.edge[e].bore = bore;
  }
  thr_supplies_destroy(&supplies);
  return st;
}

/* ---- the shape of a piece ---- */

/* Sets an arm from its edge, as seen from the tail of the half-edge. */
static void set_arm(const maker *work, thr_kit_arm *arm, int half)
{
  const thr_kit_edge *edge = &work->kit->edges.edge[half >> 1];
  double sign = half & 1 ? -1 : 1;
  *arm = (thr_kit_arm){.half = half, .width = edge->width, .key_out = !(half & 1)};
  memcpy(arm->up, edge->up, sizeof arm->up);
  for (int k = 0; k < 3; k++) {
    arm->along[k] = sign * edge->along[k];
    arm->side[k] = sign * edge->side[k];
  }
  arm->length = 0.5 * edge->length - 0.5 * work->kit->options.gap;
}

/* Place of a pass on the face of an arm, along the arm's own up and side. */
static void lane_of(const maker *work, int cord, int pass, int half, double lane[2])
{
  const thr_kit_edges *edges = &work->kit->edges;
  const thr_kit_edge *edge = &edges->edge[half >> 1];
  int number = edge->n_lanes > 1 ? edges->lane[edges->first_pass[cord] + pass] : 0;
  lane[0] = edge->lane[number][0];
  lane[1] = edge->lane[number][1] * (half & 1 ? -1 : 1);
}

/* Direction in which a cord's end leaves a piece: from a foot down, or to its hook; else away from
 * the arms. */
static void way_out(const thr_kit_piece *piece, double out[3])
{
  if (piece->hook_radius > 0) {
    memcpy(out, (double[]){piece->hook[1][0], piece->hook[1][1], 0}, 3 * sizeof *out);
    thr_normalize(out);
    return;
  }
  double sum[3] = {0, 0, 0};
  for (int i = 0; i < piece->n_arms; i++)
    for (int k = 0; k < 3; k++)
      sum[k] -= piece->arm[i].along[k];
  double length = thr_normalize(sum);
  memcpy(out, sum, sizeof sum);
  if (piece->foot || length < 0.1) {
    const double down[3] = {0, 0, -1};
    memcpy(out, piece->foot ? down : piece->arm[0].up, sizeof down);
  }
}

/* Adds a hollow for a knot where a cord's end leaves the piece. */
static thr_status add_pocket(const maker *work, thr_kit_piece *piece, const double out[3],
                             thr_err *err)
{
  int capacity = piece->n_pockets;
  thr_status st = thr_grow(&piece->pocket, piece->n_pockets, &capacity, sizeof *piece->pocket, err);
  if (st) return st;

  /* How far the surface is from the node in this direction. */
  double surface = 0, step = 0.05 * piece->node_radius;
  for (int i = 0; i < 200; i++, surface += step) {
    const double at[3] = {surface * out[0], surface * out[1], surface * out[2]};
    if (thr_kit_body(piece, at, NULL) >= 0) break;
  }
  if (piece->foot) surface = fmin(surface, piece->base);

  /* As deep as the knot is thick, but not through the middle. */
  double radius = fmin(0.5 * KNOT * work->kit->cord, 0.7 * piece->node_radius);
  double deep = fmax(surface - KNOT * work->kit->cord + radius, 0.5 * surface);
  double *pocket = piece->pocket[piece->n_pockets++];
  for (int k = 0; k < 3; k++) {
    pocket[k] = deep * out[k];
    pocket[3 + k] = (surface + 2 * radius) * out[k];
  }
  pocket[6] = radius;
  pocket[7] = 0;

  return THR_OK;
}

/* Returns the arm of a piece that a half-edge leaves by. */
static int arm_of(const thr_kit_piece *piece, int half)
{
  for (int i = 0; i < piece->n_arms; i++)
    if (piece->arm[i].half == half) return i;
  return -1;
}

/* Makes a channel, unless the piece has one between the same places already. */
static thr_status add_channel(const maker *work, thr_kit_piece *piece, int cord, int pass_in,
                              int half_in, int half_out, int pass_out, thr_err *err)
{
  thr_kit_channel channel = {.cord = cord,
                             .pass = pass_in,
                             .in = half_in < 0 ? -1 : arm_of(piece, half_in),
                             .out = half_out < 0 ? -1 : arm_of(piece, half_out)};
  double start[2] = {0, 0}, end[2] = {0, 0}, out[3];
  const thr_kit_edge *edge = work->kit->edges.edge;
  if (half_in >= 0) lane_of(work, cord, pass_in, half_in, start);
  if (half_out >= 0) lane_of(work, cord, pass_out, half_out, end);
  channel.radii[0] = 0.5 * edge[(half_in >= 0 ? half_in : half_out) >> 1].bore;
  channel.radii[1] = 0.5 * edge[(half_out >= 0 ? half_out : half_in) >> 1].bore;
  channel.radius = fmin(channel.radii[0], channel.radii[1]);
  way_out(piece, out);

  thr_status st = thr_kit_channel_make(piece, &channel, start, end, out, work->sizes.wall, err);
  if (st) return st;

  /* The same hollow twice is one. */
  for (int i = 0; i < piece->n_channels; i++) {
    const thr_kit_channel *other = &piece->channel[i];
    bool same[2] = {true, true};
    for (int k = 0; k < channel.n; k++) {
      same[0] &= thr_distance(channel.point[k], other->point[k]) < 1e-9;
      same[1] &= thr_distance(channel.point[k], other->point[channel.n - 1 - k]) < 1e-9;
    }
    if (!same[0] && !same[1]) continue;
    free(channel.point);
    return THR_OK;
  }
  piece->channel[piece->n_channels++] = channel;

  if (half_in >= 0 && half_out >= 0) return THR_OK;
  return work->kit->options.knot_pockets && piece->n_pockets == 0
             ? add_pocket(work, piece, out, err)
             : THR_OK;
}

/* Adds all channels of a node's piece. */
static thr_status add_channels(const maker *work, thr_kit_piece *piece, int v, thr_err *err)
{
  const thr_channels *all = &work->channels;
  int n = all->first[v + 1] - all->first[v];
  const thr_plan *plan = work->kit->plan;
  piece->channel = thr_calloc(2 * (size_t)n + 1, sizeof *piece->channel);
  if (!piece->channel) return thr_nomem(err);

  for (int i = all->first[v]; i < all->first[v + 1]; i++) {
    const thr_channel *c = &all->channel[i];
    const thr_cord *cord = &plan->cord[c->cord];
    int next = (c->pass + 1) % cord->n_passes;
    /* Where a closed cord begins, both of its ends come out and are knotted. */
    bool apart = cord->closed && c->in >= 0 && c->out >= 0 && c->pass == cord->n_passes - 1;
    thr_status st =
        add_channel(work, piece, c->cord, c->pass, c->in, apart ? -1 : c->out, next, err);
    if (!st && apart) st = add_channel(work, piece, c->cord, -1, -1, c->out, next, err);
    if (st) return st;
  }
  thr_kit_cuts(piece, all->rank, work->kit->options.crossings == THR_KIT_APART, work->sizes.wall);
  return THR_OK;
}

/* Engraves words on an arm, if there is room between `from` and its face. Returns whether there
 * was; *capacity: the room for strokes; *fits is raised to the height for which there is room. */
static thr_status engrave(thr_kit_piece *piece, int arm, const char *words, double height,
                          double from, bool below, int *capacity, bool *done, double *fits,
                          thr_err *err)
{
  double room;
  const thr_kit_arm *a = &piece->arm[arm];
  double free_length = a->length - piece->mouth - piece->letter_width - from;
  int n = piece->n_strokes, strokes = thr_kit_strokes(words, height, NULL, 0, &room);
  *fits = fmax(*fits, fmin(0.75 * a->width, height * free_length / room));
  *done = room <= free_length && height <= 0.75 * a->width;
  if (!*done) return THR_OK;

  while (*capacity < n + strokes) {
    thr_status st = thr_grow(&piece->stroke, *capacity, capacity, sizeof *piece->stroke, err);
    if (st) return st;
  }
  thr_kit_strokes(words, height, piece->stroke + n, strokes, &room);
  for (int i = n; i < n + strokes; i++) {
    thr_kit_stroke *stroke = &piece->stroke[i];
    stroke->arm = arm;
    stroke->below = below;
    stroke->from[0] += from + 0.5 * (free_length - room);
    stroke->to[0] += from + 0.5 * (free_length - room);
  }
  piece->n_strokes = n + strokes;

  return THR_OK;
}

/* Engraves names: on every arm that of the neighbour, with the piece's own before it where there is
 * room, "B5>B6", ">B6" or "B6"; else the piece's own name on the other side of an arm. Letters are
 * made smaller, down to the least that can be read, rather than left out. */
static thr_status add_names(maker *work, thr_kit_piece *piece, thr_err *err)
{
  const thr_kit_options *options = &work->kit->options;
  bool of_kinds = options->names == THR_KIT_OF_KINDS, own = false, done;
  int capacity = 0;
  if (options->names == THR_KIT_NO_NAMES) return THR_OK;
  piece->letter_width = options->letters / 6;
  piece->letter_depth = fmin(DEPTH, 0.5 * work->sizes.wall);

  thr_text name = {0};
  thr_pieces_name(&work->pieces, (const char(*)[THR_LABEL])work->guide.label, piece->piece, &name);
  char kind[24];
  thr_pieces_kind_name(&work->pieces, work->pieces.kind[piece->piece], kind);
  thr_status st = name.failed ? thr_nomem(err) : THR_OK;

  for (int i = 0; i < piece->n_arms && !st && !of_kinds; i++) {
    const char *to = work->guide.label[thr_head(work->frame, piece->arm[i].half)];
    double from = piece->tube ? 0 : 0.9 * piece->node_radius;
    char words[3][2 * THR_LABEL + 8];
    snprintf(words[0], sizeof words[0], "%s>%s", piece->tube ? "" : name.data, to);
    snprintf(words[1], sizeof words[1], ">%s", to);
    snprintf(words[2], sizeof words[2], "%s", to);
    done = false;
    double fits = 0;
    for (double height = options->letters; !done && !st && height > 0.6 * options->letters;
         height *= 0.8)
      for (int k = 0; k < 3 && !done && !st; k++) {
        st = engrave(piece, i, words[k], height, from, false, &capacity, &done, &fits, err);
        own |= done && k == 0;
      }
    work->unnamed += !done;
    if (!done) work->letters = fmin(work->letters, fits);
  }

  /* The piece's own name, or its kind. */
  double fits = 0;
  for (int i = 0; i < piece->n_arms && !own && !st; i++)
    for (double height = options->letters; !own && !st && height > 0.6 * options->letters;
         height *= 0.8)
      st = engrave(piece, i, of_kinds ? kind : name.data, height,
                   piece->tube ? 0 : 0.5 * piece->node_radius, !of_kinds, &capacity, &own, &fits,
                   err);
  work->unnamed += !own;
  if (!own) work->letters = fmin(work->letters, fits);
  thr_text_destroy(&name);

  return st;
}

/* Sets what all pieces have in common. */
static void set_common(const maker *work, thr_kit_piece *piece, double narrowest)
{
  const thr_kit_options *options = &work->kit->options;
  piece->profile = options->profile;
  piece->taper = options->taper;
  piece->fillet = fmin(fmax(options->fillet, 0), 0.5 * narrowest);
  piece->mouth = fmin(MOUTH * narrowest, 0.5 * work->kit->cord);
  piece->key = options->key;
  piece->wall = work->sizes.wall;
  piece->coarse = options->coarse > 0 ? options->coarse : 1;
  /* A hollow key leaves a wall round it, if there is room. */
  double room = 0.5 * narrowest - work->sizes.wall - PLAY;
  piece->key_radius = fmin(0.4 * narrowest, fmax(room, 0.3 * narrowest));
  piece->key_slope = 1 / tan(options->key_angle);
  piece->key_height = options->key == THR_KIT_PIN ? 0.2 * narrowest : 0.25 * narrowest;
  piece->key_play = PLAY;
}

/* Returns the radius of the disc that a foot stands on: within the faces of its arms, and apart
 * from the discs of other feet. */
static double pad_of(const maker *work, const thr_kit_piece *piece, int v, double widest)
{
  double pad = 0.9 * widest;
  for (int i = 0; i < piece->n_arms; i++) {
    const thr_kit_arm *arm = &piece->arm[i];
    pad = fmin(pad, 0.96 * arm->length * hypot(arm->along[0], arm->along[1]) +
                        1.5 * widest * fabs(arm->along[2]));
  }
  for (int u = 0; u < work->frame->n_nodes && piece->foot; u++)
    if (u != v && work->foot[u])
      pad =
          fmin(pad, 0.48 * work->sizes.mm * thr_distance(work->frame->xyz[u], work->frame->xyz[v]));
  return fmax(pad, 0.5 * widest);
}

/* Returns the angle in the plane to which the widest sector without arms opens; of equal ones the
 * first from the first arm on. */
static double free_angle(const thr_kit_piece *piece)
{
  thr_ranked arm[THR_KIT_MOST_ARMS];
  int n = 0;
  for (int i = 0; i < piece->n_arms && n < THR_KIT_MOST_ARMS; i++) {
    const double *along = piece->arm[i].along;
    if (hypot(along[0], along[1]) > 0.1)
      arm[n++] = (thr_ranked){nearbyint(1e6 * atan2(along[1], along[0])) / 1e6, i};
  }
  if (n == 0) return 0;
  thr_sort_ranked(arm, (size_t)n);

  double widest = 0, angle = 0;
  for (int i = 0; i < n; i++) {
    double sector = (i + 1 < n ? arm[i + 1].key : arm[0].key + 2 * THR_PI) - arm[i].key;
    if (sector <= widest + 1e-5) continue;
    widest = sector;
    angle = arm[i].key + 0.5 * sector;
  }
  return angle;
}

/* Adds a hook to a foot where a cord ends: a bar along the ground, away from the arms, whose end
 * stands up beside the foot, lower than the cord comes out. */
static void add_hook(const maker *work, thr_kit_piece *piece, int v, double widest)
{
  bool ends = false;
  double bore = 0;
  for (int i = work->channels.first[v]; i < work->channels.first[v + 1]; i++) {
    const thr_channel *c = &work->channels.channel[i];
    const thr_cord *cord = &work->kit->plan->cord[c->cord];
    ends |= c->in < 0 || c->out < 0 || (cord->closed && c->pass == cord->n_passes - 1);
  }
  if (!ends) return;
  for (int i = 0; i < piece->n_arms; i++)
    bore = fmax(bore, work->kit->edges.edge[piece->arm[i].half >> 1].bore);

  double radius = 0.2 * widest, angle = free_angle(piece), low = 0.6 * radius - piece->base;
  double out = piece->pad + 1.2 * radius + piece->fillet + 1.6 * work->kit->cord;
  double top = -0.5 * bore - 0.05 * widest - radius;
  piece->hook_radius = radius;
  for (int i = 0; i < 3; i++) {
    piece->hook[i][0] = i ? out * cos(angle) : 0;
    piece->hook[i][1] = i ? out * sin(angle) : 0;
    piece->hook[i][2] = i < 2 ? low : fmax(top, low + 0.3 * radius);
  }
}

/* Returns how far below the node the arms of a piece reach. */
static double depth_of(const thr_kit_piece *piece)
{
  double deep = 0;
  for (int i = 0; i < piece->n_arms; i++) {
    const thr_kit_arm *arm = &piece->arm[i];
    deep = fmax(deep, fmax(-arm->along[2], 0) * arm->length +
                          0.5 * arm->width * hypot(arm->along[0], arm->along[1]));
  }
  return deep;
}

/* Makes the shape of a node's piece. */
static thr_status shape_node(maker *work, int v, thr_kit_piece *piece, thr_err *err)
{
  const thr_frame *frame = work->frame;
  int n = thr_degree(frame, v);
  piece->arm = thr_calloc((size_t)n, sizeof *piece->arm);
  if (!piece->arm) return thr_nomem(err);
  piece->n_arms = n;
  double widest = 0, narrowest = INFINITY, shortest = INFINITY;
  for (int i = 0; i < n; i++) {
    set_arm(work, &piece->arm[i], frame->half[frame->first[v] + i]);
    widest = fmax(widest, piece->arm[i].width);
    narrowest = fmin(narrowest, piece->arm[i].width);
    shortest = fmin(shortest, piece->arm[i].length);
  }
  for (int k = 0; k < 3; k++)
    piece->centre[k] = work->sizes.mm * frame->xyz[v][k];

  set_common(work, piece, narrowest);
  piece->node_radius = fmin(NODE * widest * piece->taper, fmax(0.9 * shortest, 0.5 * narrowest));
  /* A base below all arms; where one goes down beside the foot, a level base would cut it off. */
  const double deep = depth_of(piece);
  piece->foot = work->foot[v] && deep <= DEEPEST * widest;
  piece->base = fmax(BASE * widest, fmin(deep, DEEPEST * widest));
  piece->pad = pad_of(work, piece, v, widest);
  if (piece->foot && work->kit->options.foot == THR_KIT_HOOK) add_hook(work, piece, v, widest);

  return add_channels(work, piece, v, err);
}

/* Adds the planes that part a tube from those that it meets at one end. */
static thr_status add_mitres(const maker *work, thr_kit_arm *arm, int v, thr_err *err)
{
  const thr_frame *frame = work->frame;
  int degree = thr_degree(frame, v);
  arm->mitre = thr_calloc((size_t)degree + 1, sizeof *arm->mitre);
  if (!arm->mitre) return thr_nomem(err);
  double gap = 0.5 * work->kit->options.gap;

  for (int i = 0; i < degree; i++) {
    int half = frame->half[frame->first[v] + i];
    if (half >> 1 == arm->half >> 1) continue;
    double other[3], normal[3];
    thr_direction(frame, half, other);
    thr_normalize(other);
    /* Points nearer to the other tube are beyond the plane through the node; from the node the tube
     * itself runs against `along`. */
    for (int k = 0; k < 3; k++)
      normal[k] = other[k] + arm->along[k];
    if (thr_normalize(normal) < 1e-6) continue;
    double *plane = arm->mitre[arm->n_mitres++];
    memcpy(plane, normal, sizeof normal);
    double slope = thr_dot(normal, arm->along);
    plane[3] = slope * arm->length - gap;
    double tip = 0.5 * arm->width * sqrt(fmax(1 - slope * slope, 0)) / fmax(slope, 0.1);
    arm->tip = fmax(arm->tip, tip);
  }

  /* The end of a tube that meets none is cut square. */
  if (arm->n_mitres == 0) arm->length -= gap;
  return THR_OK;
}

/* Makes the shape of a tube along an edge: two halves from its middle. */
static thr_status shape_tube(maker *work, int e, thr_kit_piece *piece, thr_err *err)
{
  const thr_kit *kit = work->kit;
  const thr_kit_edge *edge = &kit->edges.edge[e];
  piece->tube = true;
  piece->rounded = kit->options.tube_ends == THR_KIT_ROUNDED;
  piece->n_arms = 2;
  piece->arm = thr_calloc(2, sizeof *piece->arm);
  piece->channel = thr_calloc((size_t)edge->n_lanes + 1, sizeof *piece->channel);
  if (!piece->arm || !piece->channel) return thr_nomem(err);
  set_common(work, piece, edge->width);
  piece->key = THR_KIT_NO_KEY;
  piece->node_radius = 0.5 * edge->width;

  for (int i = 0; i < 2; i++) {
    thr_kit_arm *arm = &piece->arm[i];
    int v = work->frame->edge[e][1 - i];
    set_arm(work, arm, 2 * e + i);
    arm->length = 0.5 * edge->length;
    if (!piece->rounded) {
      thr_status st = add_mitres(work, arm, v, err);
      if (st) return st;
    } else {
      /* Half balls of neighbours are not to meet: they stand back by what the sharpest angle asks
       * for. */
      double back = 0.5 * kit->options.gap;
      for (int k = work->frame->first[v]; k < work->frame->first[v + 1]; k++) {
        int half = work->frame->half[k];
        if (half >> 1 == e) continue;
        double angle = THR_PI - thr_turn_angle(work->frame, arm->half, half);
        double radius = 0.5 * edge->width;
        back = fmax(back, 0.5 * kit->options.gap + radius / sin(0.5 * fmax(angle, 0.05)) - radius);
      }
      arm->length -= back;
      if (arm->length < 0.5 * edge->width)
        return thr_fail(err, THR_EINPUT,
                        "tube %s-%s: nothing is left of it between rounded neighbours: a smaller "
                        "--width, or --tube-ends mitred",
                        work->guide.label[work->frame->edge[e][0]],
                        work->guide.label[work->frame->edge[e][1]]);
    }
    for (int k = 0; k < 3; k++)
      piece->centre[k] = 0.5 * work->sizes.mm *
                         (work->frame->xyz[work->frame->edge[e][0]][k] +
                          work->frame->xyz[work->frame->edge[e][1]][k]);
  }

  /* Straight channels from end to end. */
  for (int i = 0; i < edge->n_lanes; i++) {
    thr_kit_channel *channel = &piece->channel[piece->n_channels];
    *channel = (thr_kit_channel){.in = 1,
                                 .out = 0,
                                 .radius = 0.5 * edge->bore,
                                 .radii = {0.5 * edge->bore, 0.5 * edge->bore}};
    const double at_head[2] = {edge->lane[i][0], edge->lane[i][1]};
    const double at_tail[2] = {edge->lane[i][0], -edge->lane[i][1]};
    thr_status st = thr_kit_channel_make(piece, channel, at_tail, at_head, (double[]){0, 0, 1},
                                         work->sizes.wall, err);
    piece->n_channels++;
    if (st) return st;
    channel->mouth[0] = channel->mouth[1] = false;
  }
  return THR_OK;
}

/* ---- kinds ---- */

/* Finds for each piece the first one like it, and numbers the kinds. Only pieces of one kind in
 * all other documents are compared. */
static void find_alike(const maker *work)
{
  thr_kit *kit = work->kit;
  double tolerance = kit->options.kind_tolerance * kit->mm;
  if (!(tolerance > 0)) {
    double sum = 0;
    for (int e = 0; e < work->frame->n_edges; e++)
      sum += kit->edges.edge[e].length / work->frame->n_edges;
    tolerance = THR_KINDS_TOLERANCE * sum;
  }

  kit->n_kinds = kit->n_meshes = 0;
  kit->n_shapes = work->pieces.n_kinds;
  for (int p = 0; p < kit->n_pieces; p++) {
    thr_kit_piece *piece = &kit->piece[p];
    static const double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    piece->like = p;
    piece->count = 1;
    memcpy(piece->place, unit, sizeof unit);
    for (int q = 0; q < p && piece->like == p; q++) {
      thr_kit_piece *other = &kit->piece[q];
      if (other->like != q || work->pieces.kind[q] != work->pieces.kind[p]) continue;
      if (!thr_kit_alike(other, piece, tolerance, piece->place)) continue;
      piece->like = q;
      piece->kind = other->kind;
      piece->count = 0;
      other->count++;
    }
    if (piece->like != p) continue;
    memcpy(piece->place, unit, sizeof unit);
    piece->kind = ++kit->n_kinds;
    kit->n_meshes++;
  }
}

/* Names pieces and kinds as in all documents. Pieces of one kind that differ in their channels have
 * a letter behind it. */
static thr_status give_names(maker *work, thr_err *err)
{
  thr_kit *kit = work->kit;
  kit->name = thr_calloc((size_t)kit->n_pieces, sizeof *kit->name);
  kit->kind_name = thr_calloc((size_t)kit->n_kinds + 1, sizeof *kit->kind_name);
  int *variants = thr_scratch_array(&work->own, (size_t)work->pieces.n_kinds + 1, sizeof *variants);
  int *number = thr_scratch_array(&work->own, (size_t)kit->n_kinds + 1, sizeof *number);
  thr_status st = kit->name && kit->kind_name ? thr_scratch_check(&work->own, err) : thr_nomem(err);
  if (st) return st;

  for (int p = 0; p < kit->n_pieces; p++)
    if (kit->piece[p].like == p) number[kit->piece[p].kind] = variants[work->pieces.kind[p]]++;
  for (int p = 0; p < kit->n_pieces && !st; p++) {
    thr_text name = {0};
    thr_pieces_name(&work->pieces, (const char(*)[THR_LABEL])work->guide.label, p, &name);
    if (name.failed)
      st = thr_nomem(err);
    else
      snprintf(kit->name[p], sizeof *kit->name, "%s", name.data);
    thr_text_destroy(&name);
    if (kit->piece[p].like != p) continue;

    int shape = work->pieces.kind[p], i = kit->piece[p].kind;
    char kind[24];
    thr_pieces_kind_name(&work->pieces, shape, kind);
    if (variants[shape] == 1)
      snprintf(kit->kind_name[i], sizeof *kit->kind_name, "%s", kind);
    else if (variants[shape] <= 26)
      snprintf(kit->kind_name[i], sizeof *kit->kind_name, "%.20s%c", kind, 'a' + number[i]);
    else
      snprintf(kit->kind_name[i], sizeof *kit->kind_name, "%.11s.%d", kind, number[i] + 1);
  }
  return st;
}

/* Finds the only piece that is wanted by its name. */
static thr_status find_only(thr_kit *kit, const char *name, thr_err *err)
{
  for (int p = 0; p < kit->n_pieces && name; p++)
    if (strcmp(kit->name[p], name) == 0) kit->only = p + 1;
  return name && !kit->only ? thr_fail(err, THR_EINPUT, "there is no piece %s, but %s to %s", name,
                                       kit->name[0], kit->name[kit->n_pieces - 1])
                            : THR_OK;
}

/* ---- meshes ---- */

/* Refuses arms that take minutes and that nobody can print. */
static thr_status check_lengths(const thr_kit *kit, thr_err *err)
{
  for (int p = 0; p < kit->n_pieces; p++)
    for (int i = 0; i < kit->piece[p].n_arms; i++) {
      const thr_kit_arm *arm = &kit->piece[p].arm[i];
      if (arm->length <= MOST_WIDTHS * arm->width) continue;
      return thr_fail(err, THR_EINPUT,
                      "piece %s: an arm of %.4g mm is %.3g mm wide, longer than %d widths: --width "
                      "%.3g if there is room, or shorter edges",
                      kit->name[p], arm->length, arm->width, MOST_WIDTHS,
                      1.01 * arm->length / MOST_WIDTHS);
    }
  return THR_OK;
}

/* Pieces whose meshes are made in threads. */
typedef struct {
  thr_kit *kit;
  atomic_int done; /* meshes so far */
} meshing;

/* Makes the mesh of a piece, unless it shares one, or the only one that is wanted does not share
 * it. */
static thr_status mesh_piece(void *user, int job, const thr_limits *limits, thr_err *err)
{
  meshing *work = user;
  thr_kit *kit = work->kit;
  thr_kit_piece *piece = &kit->piece[job];
  if (piece->like != job || (kit->only && kit->piece[kit->only - 1].like != job)) return THR_OK;

  thr_kit_solid body;
  thr_solid solid = {.sample = thr_kit_sample, .user = &body};
  double thickest = piece->node_radius, narrowest = INFINITY;
  for (int i = 0; i < piece->n_arms; i++) {
    thickest = fmax(thickest, 0.5 * piece->arm[i].width);
    narrowest = fmin(narrowest, piece->arm[i].width);
  }
  double margin = 0.5 * narrowest + piece->key_height;
  for (int k = 0; k < 3; k++) {
    solid.low[k] = -thickest;
    solid.high[k] = thickest;
    for (int i = 0; i < piece->n_arms; i++) {
      const thr_kit_arm *arm = &piece->arm[i];
      double tip = arm->along[k] * (arm->length + arm->tip);
      double round = 0.75 * arm->width * sqrt(fmax(1 - arm->along[k] * arm->along[k], 0));
      solid.low[k] = fmin(solid.low[k], tip - round);
      solid.high[k] = fmax(solid.high[k], tip + round);
    }
    if (piece->foot) {
      solid.low[k] = fmin(solid.low[k], k == 2 ? -piece->base : -piece->pad - piece->fillet);
      solid.high[k] = fmax(solid.high[k], k == 2 ? 0 : piece->pad + piece->fillet);
    }
    for (int i = 0; i < 3 && piece->hook_radius > 0; i++) {
      solid.low[k] = fmin(solid.low[k], piece->hook[i][k] - piece->hook_radius);
      solid.high[k] = fmax(solid.high[k], piece->hook[i][k] + piece->hook_radius);
    }
    /* Where the grid lies must not be where the piece has planes. */
    solid.low[k] -= margin * (1 + 0.013 * (k + 1));
    solid.high[k] += margin;
  }
  solid.coarsest = narrowest;
  solid.tolerance = fmin(SIMPLE * narrowest, SIMPLEST) * piece->coarse;

  thr_err why = {0};
  thr_status st = thr_kit_solid_make(&body, piece, &why);
  if (!st) st = thr_mesh_make(&kit->mesh[job], &solid, limits, &why);
  if (!st) st = thr_kit_solid_check(&body, &why);
  thr_kit_solid_destroy(&body);
  if (!st)
    st = thr_mesh_drop_crumbs(&kit->mesh[job], 2e-3 * narrowest * narrowest * narrowest, &why);
  if (!st) st = thr_mesh_examine(&kit->mesh[job], false, &kit->report[job], &why);
  if (!st) st = thr_kit_thinnest(piece, &piece->thinnest, &why);
  int done = atomic_fetch_add(&work->done, 1) + 1;
  if (limits->advance) limits->advance(limits->user, "pieces", (double)done / kit->n_meshes);

  return st ? thr_fail(err, st, "piece %s: %s", kit->name[job], why.text) : THR_OK;
}

/* Returns what makes a piece wider: --width, unless other edges are in the way. */
static const char *what_widens(const thr_kit *kit, int p)
{
  for (int i = 0; i < kit->piece[p].n_arms; i++)
    if (kit->piece[p].arm[i].width < kit->options.width * (1 - 1e-9))
      return "a larger framework for the same cord";
  return "wider arms (--width)";
}

/* Says which finished pieces have a wall that is thinner than planned; two parts in a hundred are
 * rounding. */
static void note_walls(thr_kit *kit)
{
  int thin = 0, at = 0;
  for (int p = 0; p < kit->n_pieces; p++) {
    kit->piece[p].thinnest = kit->piece[kit->piece[p].like].thinnest;
    thin += kit->piece[p].thinnest < 0.98 * kit->options.wall;
    if (kit->piece[p].thinnest < kit->piece[at].thinnest) at = p;
  }
  if (thin)
    thr_text_printf(&kit->notes,
                    "%d %s a wall thinner than %.3g mm: that of %s is %.2g mm%s; %s would make it "
                    "thicker\n",
                    thin, thin == 1 ? "piece has" : "pieces have", kit->options.wall, kit->name[at],
                    kit->piece[at].thinnest,
                    kit->piece[at].thinnest < THINNEST ? ", too thin to print" : "",
                    what_widens(kit, at));
}

/* Adds up volumes, and says which meshes do not print as one piece. */
static void sum_up(thr_kit *kit)
{
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_mesh_report *report = &kit->report[kit->piece[p].like];
    kit->volume += report->volume;
    if (kit->piece[p].like != p) continue;
    if (report->parts != 1)
      thr_text_printf(&kit->notes, "piece %s falls into %d parts: a larger %s\n", kit->name[p],
                      report->parts, what_widens(kit, p));
    if (report->open_edges || report->crossings)
      thr_text_printf(&kit->notes,
                      "piece %s: its mesh has %d open edges and %d triangles that cross: an error "
                      "of this program\n",
                      kit->name[p], report->open_edges, report->crossings);
  }
  kit->mass = kit->volume * kit->options.density / 1000; /* mm3 and g/cm3 */
}

/* Says which channels cut each other where they need not, or where they were to be led apart. */
static void note_cuts(thr_kit *kit)
{
  bool apart = kit->options.crossings == THR_KIT_APART;
  for (int i = 0; i < (apart ? 2 : 1); i++) {
    int pairs = 0, pieces = 0, most = 0, where = 0;
    for (int p = 0; p < kit->n_pieces; p++) {
      int here = i ? kit->piece[p].crossings : kit->piece[p].cuts;
      pairs += here;
      pieces += here > 0;
      if (here > most) most = here, where = p;
    }
    if (pairs)
      thr_text_printf(&kit->notes,
                      "%d %s of channels cut each other in %d %s %s: %d in %s; a larger %s may "
                      "part them\n",
                      pairs, pairs == 1 ? "pair" : "pairs", pieces,
                      pieces == 1 ? "piece" : "pieces",
                      i ? "where the plan has a crossing" : "though the plan has no crossing there",
                      most, kit->name[where], what_widens(kit, where));
  }
}

/* Says what does not go as well as it might: walls as planned, names, sharp bends. */
static void note_channels(const maker *work)
{
  thr_kit *kit = work->kit;
  int sharp = 0, where = 0;
  double sharpest = INFINITY;
  for (int p = 0; p < kit->n_pieces; p++)
    for (int i = 0; i < kit->piece[p].n_channels; i++) {
      const thr_kit_channel *channel = &kit->piece[p].channel[i];
      sharp += channel->bend < 2 * kit->cord;
      if (channel->bend < sharpest) sharpest = channel->bend, where = p;
    }
  if (work->sizes.wall < WALL && !work->sizes.wall_given)
    thr_text_printf(&kit->notes,
                    work->sizes.roomy > 0
                        ? "walls are %.2g mm, thinner than the %.2g mm that print "
                          "well: arms of --width %.4g or more\n"
                        : "walls are %.2g mm, thinner than the %.2g mm that print "
                          "well: a thinner cord, or a larger framework for it\n",
                    work->sizes.wall, WALL, ceil(100 * work->sizes.roomy) / 100);
  if (work->unnamed)
    thr_text_printf(&kit->notes, "%d %s found no room", work->unnamed,
                    work->unnamed == 1 ? "name" : "names");
  if (work->unnamed && work->letters >= 1)
    thr_text_printf(&kit->notes, ": --letters %.3g or less would do\n",
                    floor(100 * work->letters) / 100);
  else if (work->unnamed)
    thr_text_append(&kit->notes, ", whatever the --letters\n");
  if (sharp)
    thr_text_printf(&kit->notes, "%d %s with a radius below two cords (%.3g mm): %s with %.2g mm\n",
                    sharp, sharp == 1 ? "channel bends" : "channels bend", 2 * kit->cord,
                    kit->name[where], sharpest);
}

/* Says which feet have no base to stand on. */
static void note_feet(const maker *work)
{
  thr_kit *kit = work->kit;
  int n = 0, where = 0;
  for (int v = work->frame->n_nodes - 1; v >= 0; v--)
    if (work->foot[v] && !kit->piece[v].foot) n++, where = v;
  if (n)
    thr_text_printf(&kit->notes,
                    "%d %s no base, since an arm goes down beside it, the first is %s: what it "
                    "stands on must hold it\n",
                    n, n == 1 ? "foot has" : "feet have", kit->name[where]);
}

/* Makes room for the pieces, edges and feet. THR_ENOMEM. */
static thr_status make_room(maker *work, thr_err *err)
{
  thr_kit *kit = work->kit;
  const thr_plan *plan = kit->plan;
  kit->n_pieces = thr_pieces_count(plan);
  size_t n = (size_t)kit->n_pieces;
  thr_kit_edges *edges = &kit->edges;
  edges->edge = thr_scratch_array(&edges->own, (size_t)work->frame->n_edges, sizeof *edges->edge);
  edges->first_pass =
      thr_scratch_array(&edges->own, (size_t)plan->n_cords + 1, sizeof *edges->first_pass);
  kit->piece = thr_calloc(n, sizeof *kit->piece);
  kit->mesh = thr_calloc(n, sizeof *kit->mesh);
  kit->report = thr_calloc(n, sizeof *kit->report);
  work->foot = thr_scratch_array(&work->own, (size_t)work->frame->n_nodes, sizeof *work->foot);
  thr_status st = kit->piece && kit->mesh && kit->report ? THR_OK : thr_nomem(err);
  if (!st) st = thr_scratch_check(&edges->own, err);
  return st ? st : thr_scratch_check(&work->own, err);
}

/* Finds what all pieces need to know: sizes, bores, labels, kinds, channels, edges and feet. */
static thr_status find_common(maker *work, const thr_kit_options *options, const thr_layout *layout,
                              thr_err *err)
{
  thr_kit *kit = work->kit;
  const thr_plan *plan = kit->plan;
  thr_status st = find_sizes(work, options, err);
  if (!st) st = set_bores(work, err);
  if (!st) st = thr_guide_make(&work->guide, work->frame, layout, err);
  if (!st) st = thr_pieces_make(&work->pieces, plan, options->kind_tolerance, err);
  if (!st) st = thr_channels_make(&work->channels, plan, err);
  if (!st)
    st = thr_kit_edges_make(
        &kit->edges, plan, &kit->options, &work->sizes, (const char(*)[THR_LABEL])work->guide.label,
        work->guide.flat ? (const double(*)[3])work->guide.outward : NULL, &kit->notes, err);
  if (st) return st;

  /* What lies flat stands on nothing in particular. */
  if (2 * thr_frame_standing(work->frame, work->foot) > work->frame->n_nodes)
    memset(work->foot, 0, (size_t)work->frame->n_nodes * sizeof *work->foot);
  kit->options.wall = work->sizes.wall;
  return THR_OK;
}

/* Shapes all pieces, finds their kinds and gives them names. Kinds are found a second time because
 * names that are engraved make pieces differ. */
static thr_status make_pieces(maker *work, bool solid, thr_err *err)
{
  thr_kit *kit = work->kit;
  thr_status st = THR_OK;
  for (int p = 0; p < kit->n_pieces && !st; p++) {
    kit->piece[p].piece = p;
    st =
        solid ? shape_node(work, p, &kit->piece[p], err) : shape_tube(work, p, &kit->piece[p], err);
  }
  if (st) return st;

  find_alike(work);
  kit->n_unnamed_kinds = kit->n_kinds;
  for (int p = 0; p < kit->n_pieces && !st; p++)
    st = add_names(work, &kit->piece[p], err);
  if (st) return st;
  find_alike(work);
  return give_names(work, err);
}

/* Makes the meshes of all pieces, or of the only one that is wanted, and adds up their volumes. */
static thr_status make_meshes(thr_kit *kit, const thr_limits *limits, thr_err *err)
{
  meshing meshed = {.kit = kit};
  thr_status st = check_lengths(kit, err);
  if (!st && kit->options.to_print) st = thr_kit_plates_check(kit, err);
  if (!st) st = thr_threads_run(kit->n_pieces, mesh_piece, &meshed, limits, err);
  if (st) return st;
  note_walls(kit);
  sum_up(kit);
  return THR_OK;
}

thr_status thr_kit_make(thr_kit *kit, const thr_plan *plan, const thr_kit_options *options,
                        const thr_layout *layout, bool meshes, const thr_limits *limits,
                        thr_err *err)
{
  *kit = (thr_kit){.plan = plan};
  maker work = {.kit = kit, .frame = &plan->frame, .letters = INFINITY};
  bool solid = plan->options.joint == THR_JOINT_SOLID;
  thr_status st = make_room(&work, err);
  if (!st) st = find_common(&work, options, layout, err);
  if (!st) st = make_pieces(&work, solid, err);
  if (!st) st = find_only(kit, options->only, err);

  if (!st) {
    note_channels(&work);
    note_cuts(kit);
    if (solid) note_feet(&work);
    if (meshes) st = make_meshes(kit, limits, err);
  }
  if (!st && kit->notes.failed) st = thr_nomem(err);

  thr_channels_destroy(&work.channels);
  thr_pieces_destroy(&work.pieces);
  thr_guide_destroy(&work.guide);
  thr_scratch_free(&work.own);
  return st;
}

void thr_kit_destroy(thr_kit *kit)
{
  for (int p = 0; p < kit->n_pieces; p++) {
    thr_kit_piece *piece = kit->piece ? &kit->piece[p] : NULL;
    if (kit->mesh) thr_mesh_destroy(&kit->mesh[p]);
    if (!piece) continue;
    for (int i = 0; i < piece->n_arms && piece->arm; i++)
      free(piece->arm[i].mitre);
    for (int i = 0; i < piece->n_channels; i++)
      free(piece->channel[i].point);
    free(piece->arm);
    free(piece->channel);
    free(piece->stroke);
    free(piece->pocket);
  }
  free(kit->piece);
  free(kit->mesh);
  free(kit->report);
  free(kit->name);
  free(kit->kind_name);
  thr_text_destroy(&kit->notes);
  thr_scratch_free(&kit->edges.own);
  *kit = (thr_kit){0};
}

void thr_kit_place(const thr_kit_piece *piece, const double at[3], double place[3])
{
  for (int i = 0; i < 3; i++)
    place[i] = piece->centre[i] + thr_dot(&piece->place[3 * i], at);
}
