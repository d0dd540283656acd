/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What pieces of a kit must not do: channels that cut each other, thin walls, arms of strangers
 * that meet; each measured here by brute force. */
#include "graph/framework/frame.h"
#include "graph/number.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "kit/kit.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static thr_plan plan_of(thr_shape shape, int size)
{
  thr_frame f = shape_make(shape, size, 3);
  thr_request o = thr_request_default();
  thr_plan p = plan_make(&f, &o);
  thr_frame_destroy(&f);
  return p;
}

/* Shapes only: no meshes. */
static thr_kit shapes_of(const thr_plan *p, const thr_kit_options *options, bool meshes)
{
  thr_err err = {0};
  thr_kit kit;
  const thr_limits limits = {.threads = 1};
  ck_assert_msg(thr_kit_make(&kit, p, options, NULL, meshes, &limits, &err) == THR_OK, "%s",
                err.text);
  return kit;
}

START_TEST(the_distance_of_segments_is_that_of_many_points)
{
  enum { STEPS = 200 };
  rng r = rng_make((uint64_t)_i + 1);
  double a[2][3], b[2][3], part[2], least = INFINITY;
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) {
      a[i][k] = rng_unit(&r);
      /* Some are parallel, some are points. */
      b[i][k] = _i % 5 == 0 ? a[i][k] + 0.3 * k : _i % 7 == 0 ? 0.4 : rng_unit(&r);
    }
  double found = thr_kit_segments((const double(*)[3])a, (const double(*)[3])b, part);
  for (int i = 0; i <= STEPS; i++)
    for (int j = 0; j <= STEPS; j++) {
      double p[3], q[3];
      for (int k = 0; k < 3; k++) {
        p[k] = a[0][k] + (a[1][k] - a[0][k]) * i / STEPS;
        q[k] = b[0][k] + (b[1][k] - b[0][k]) * j / STEPS;
      }
      least = fmin(least, thr_distance(p, q));
    }
  ck_assert_double_le(found, least + 1e-12);
  ck_assert_double_ge(found, least - 0.01);
}
END_TEST

/* The point of a channel at a part 0 .. 1 of it, and its radius there. */
static double point_of(const thr_kit_channel *channel, double part, double at[3])
{
  int i = (int)fmin(part * (channel->n - 1), channel->n - 2);
  double rest = part * (channel->n - 1) - i;
  for (int k = 0; k < 3; k++)
    at[k] = channel->point[i][k] + rest * (channel->point[i + 1][k] - channel->point[i][k]);
  return channel->radii[0] + part * (channel->radii[1] - channel->radii[0]);
}

/* The least material between two channels, by many points; below 0 where they cut each other. */
static double between(const thr_kit_channel *a, const thr_kit_channel *b)
{
  enum { STEPS = 180 };
  double least = INFINITY;
  for (int i = 0; i <= STEPS; i++)
    for (int j = 0; j <= STEPS; j++) {
      double p[3], q[3];
      double both = point_of(a, (double)i / STEPS, p) + point_of(b, (double)j / STEPS, q);
      least = fmin(least, thr_distance(p, q) - both);
    }
  return least;
}

/* Do two channels share a face at the same place, or a way out? */
static bool share(const thr_kit_channel *a, const thr_kit_channel *b)
{
  const int arms[2][2] = {{a->in, a->out}, {b->in, b->out}};
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      if (arms[0][i] == arms[1][j] &&
          thr_distance(a->point[i ? a->n - 1 : 0], b->point[j ? b->n - 1 : 0]) < 0.01)
        return true;
  return false;
}

/* Plans and options of kits. */
static const struct {
  thr_shape shape;
  int size;
  thr_kit_options options;
} kits[] = {
    {THR_MAKE_DOME, 4, {.names = THR_KIT_NO_NAMES}},
    {THR_MAKE_DOME, 4, {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES}},
    {THR_MAKE_SPHERE, 1, {.names = THR_KIT_NO_NAMES}},
    {THR_MAKE_SPHERE, 1, {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES}},
    {THR_MAKE_DOME, 4, {.names = THR_KIT_NO_NAMES, .width = 14, .crossings = THR_KIT_APART}},
    {THR_MAKE_TUBE,
     5,
     {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES, .crossings = THR_KIT_APART}},
};
enum { KITS = sizeof kits / sizeof *kits };

START_TEST(pairs_of_channels_that_cut_each_other_are_counted)
{
  thr_plan p = plan_of(kits[_i].shape, kits[_i].size);
  thr_kit kit = shapes_of(&p, &kits[_i].options, false);
  for (int q = 0; q < kit.n_pieces; q++) {
    const thr_kit_piece *piece = &kit.piece[q];
    int sure = 0, doubtful = 0;
    for (int i = 0; i < piece->n_channels; i++)
      for (int j = 0; j < i; j++) {
        const thr_kit_channel *a = &piece->channel[i], *b = &piece->channel[j];
        if (share(a, b)) continue;
        double gap = between(a, b);
        sure += gap < -0.05;
        doubtful += gap >= -0.05 && gap < 0.05;
      }
    int found = piece->cuts + piece->crossings;
    ck_assert_msg(found >= sure && found <= sure + doubtful, "%s: %d, not %d to %d", kit.name[q],
                  found, sure, sure + doubtful);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(crossings_are_led_apart_where_there_is_room)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 4);
  thr_channels channels = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_channels_make(&channels, &p, &err), THR_OK);
  thr_kit_options options = {.names = THR_KIT_NO_NAMES, .width = 14};
  thr_kit meet = shapes_of(&p, &options, false);
  options.crossings = THR_KIT_APART;
  thr_kit apart = shapes_of(&p, &options, false);
  int crossings = 0;
  for (int q = 0; q < meet.n_pieces; q++) {
    const thr_kit_piece *before = &meet.piece[q], *after = &apart.piece[q];
    crossings += before->crossings;
    ck_assert_int_le(before->cuts, 0);
    ck_assert_int_le(after->cuts + after->crossings, 0);

    /* Mouths stay, and so do walls. */
    for (int i = 0; i < before->n_channels; i++) {
      const thr_kit_channel *a = &before->channel[i], *b = &after->channel[i];
      ck_assert_double_lt(thr_distance(a->point[0], b->point[0]), 1e-12);
      ck_assert_double_lt(thr_distance(a->point[a->n - 1], b->point[b->n - 1]), 1e-12);
      ck_assert_double_ge(b->wall, fmin(a->wall, 1.2) - 1e-9);
    }
  }
  ck_assert_int_gt(crossings, 0);
  ck_assert_int_le(crossings, (int)channels.crossings);
  thr_channels_destroy(&channels);
  thr_kit_destroy(&meet);
  thr_kit_destroy(&apart);
  thr_plan_destroy(&p);
}
END_TEST

/* Where a ray first meets the mesh beyond a distance, as a distance from its origin; INFINITY: not
 * at all (T. Moeller and B. Trumbore, 1997). */
static double ray_hit(const thr_mesh *mesh, const double from[3], const double along[3],
                      double beyond)
{
  double best = INFINITY;
  for (int t = 0; t < mesh->n_triangles; t++) {
    const double *a = mesh->point[mesh->triangle[t][0]];
    double e[3], f[3], to[3], p[3], q[3];
    for (int k = 0; k < 3; k++) {
      e[k] = mesh->point[mesh->triangle[t][1]][k] - a[k];
      f[k] = mesh->point[mesh->triangle[t][2]][k] - a[k];
      to[k] = from[k] - a[k];
    }
    thr_cross(along, f, p);
    thr_cross(to, e, q);
    double volume = thr_dot(e, p);
    if (fabs(volume) < 1e-14) continue;
    double u = thr_dot(to, p) / volume, v = thr_dot(along, q) / volume;
    double by = thr_dot(f, q) / volume;
    if (u >= 0 && v >= 0 && u + v <= 1 && by > beyond) best = fmin(best, by);
  }
  return best;
}

/* Is a point in a channel, or at its surface? */
static bool in_a_channel(const thr_kit_piece *piece, const double at[3])
{
  for (int c = 0; c < piece->n_channels; c++)
    for (double part = 0; part <= 1; part += 0.01) {
      double on[3], radius = point_of(&piece->channel[c], part, on);
      if (thr_distance(at, on) < radius + piece->mouth + 0.1) return true;
    }
  return false;
}

/* What the thinnest wall is measured in. */
static const struct {
  thr_kit_options options;
  double least; /* mm: walls are no thinner */
} walled[] = {{{.names = THR_KIT_NO_NAMES}, 1.2},
              {{.names = THR_KIT_NO_NAMES, .width = 5}, 1.2},
              {{.letters = 2}, 0.6},
              {{.names = THR_KIT_NO_NAMES, .profile = THR_KIT_SQUARE}, 1.2}};
enum { WALLED = sizeof walled / sizeof *walled };

START_TEST(the_thinnest_wall_is_that_of_the_mesh)
{
  enum { RAYS = 6 };
  thr_plan p = plan_of(THR_MAKE_DOME, 3);
  thr_kit kit = shapes_of(&p, &walled[_i].options, true);
  for (int q = 0; q < kit.n_pieces; q++) {
    const thr_kit_piece *piece = &kit.piece[q];
    const thr_mesh *mesh = &kit.mesh[q];
    double least = INFINITY;
    for (int c = 0; c < piece->n_channels && q < 4; c++) {
      const thr_kit_channel *channel = &piece->channel[c];
      if (channel->in < 0 || channel->out < 0) continue;
      for (double part = 0; part < 1; part += 0.04) {
        double at[3], next[3], along[3], side[3], up[3];
        double radius = point_of(channel, part, at);
        point_of(channel, part + 1e-3, next);
        for (int k = 0; k < 3; k++)
          along[k] = next[k] - at[k];
        thr_normalize(along);
        thr_cross(along, fabs(along[2]) < 0.7 ? (double[]){0, 0, 1} : (double[]){1, 0, 0}, side);
        thr_normalize(side);
        thr_cross(along, side, up);

        /* Well within the faces; where the ray begins in the channel's own wall. */
        bool within = true;
        for (int i = 0; i < piece->n_arms; i++)
          within &= thr_dot(at, piece->arm[i].along) < piece->arm[i].length - 2 * piece->mouth;
        for (int i = 0; i < RAYS && within; i++) {
          double angle = 2 * THR_PI * i / RAYS, out[3];
          for (int k = 0; k < 3; k++)
            out[k] = cos(angle) * side[k] + sin(angle) * up[k];
          double first = ray_hit(mesh, at, out, 0);
          if (first > radius + 0.1) continue; /* another channel begins here */
          double second = ray_hit(mesh, at, out, first + 1e-6), hit[3];
          for (int k = 0; k < 3; k++)
            hit[k] = at[k] + second * out[k];
          if (!in_a_channel(piece, hit)) least = fmin(least, second - first);
        }
      }
    }
    if (isfinite(least))
      ck_assert_msg(piece->thinnest < least + 0.15 &&
                        piece->thinnest > least - 0.35 - piece->letter_depth,
                    "%s: %g mm, by the mesh %g", kit.name[q], piece->thinnest, least);
    ck_assert_double_gt(piece->thinnest, 0.98 * walled[_i].least);
  }
  ck_assert_ptr_null(strstr(kit.notes.data ? kit.notes.data : "", "a wall thinner"));
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(a_wall_that_is_too_thin_is_said_by_name)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3);
  const thr_kit_options options = {.letters = 3, .wall = 2.2};
  thr_kit kit = shapes_of(&p, &options, true);
  int thin = 0;
  char words[100];
  for (int q = 0; q < kit.n_pieces; q++)
    thin += kit.piece[q].thinnest < 0.98 * 2.2;
  ck_assert_int_gt(thin, 0);
  snprintf(words, sizeof words, "%d pieces have a wall thinner than 2.2 mm", thin);
  ck_assert_msg(strstr(kit.notes.data, words) != NULL, "%s", kit.notes.data);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* A ring of six nodes in a plane, in mm: two runs of length 2 x 50 that are 8 apart; or, twisted,
 * one whose long sides cross. */
static thr_plan ring_of(bool twisted)
{
  const double xyz[6][3] = {{0, 0, 0}, {50, 0, 0}, {100, 0, 0}, {100, 8, 0}, {50, 8, 0}, {0, 8, 0}};
  const int plain[6][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 0}};
  const int crossed[6][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 4}, {4, 5}, {5, 0}};
  thr_frame f = frame_make(6, xyz, 6, twisted ? crossed : plain, NULL, (const int[]){0, -1});
  thr_request o = thr_request_default();
  o.physics.cord_diameter = 0.5;
  o.physics.bead_diameter = 7.5;
  thr_plan p = plan_make(&f, &o);
  thr_frame_destroy(&f);
  return p;
}

START_TEST(strangers_do_not_touch)
{
  thr_plan p = ring_of(false);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  thr_kit kit = shapes_of(&p, &options, false);

  /* Balls of nodes are 0.6 of a width in radius: two of them would touch at a width of 8 / 1.2. The
   * two short edges have no stranger near. */
  for (int e = 0; e < 6; e++)
    ck_assert_double_eq_tol(kit.edges.edge[e].width, e % 3 == 2 ? 7.5 : 0.96 * 8 / 1.2, 1e-9);
  for (int q = 0; q < 6; q++)
    for (int r = 0; r < q; r++)
      ck_assert_double_le(kit.piece[q].node_radius + kit.piece[r].node_radius,
                          thr_distance(p.frame.xyz[q], p.frame.xyz[r]));
  ck_assert_ptr_nonnull(strstr(kit.notes.data, "4 of 6 arms are narrower than 7.5 mm"));
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(edges_that_cross_are_named)
{
  thr_plan p = ring_of(true);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  const thr_limits limits = {.threads = 1};
  thr_err err = {0};
  thr_kit kit;
  for (int tubes = 0; tubes < 2; tubes++) {
    p.options.joint = tubes ? THR_JOINT_TUBE : THR_JOINT_SOLID;
    err = (thr_err){0};
    ck_assert_int_eq(thr_kit_make(&kit, &p, &options, NULL, false, &limits, &err), THR_EINPUT);
    assert_one_line(&err, "cross: they need a node");
    ck_assert_ptr_nonnull(strstr(err.text, " and "));
    thr_kit_destroy(&kit);
  }
  thr_plan_destroy(&p);
}
END_TEST

/* The number that a message gives for the cord does. */
START_TEST(the_cord_that_is_advised_fits)
{
  thr_plan p = ring_of(false);
  thr_kit_options options = {.names = THR_KIT_NO_NAMES, .wall = 1.5};
  const thr_limits limits = {.threads = 1};
  thr_err err = {0};
  thr_kit kit;
  p.options.physics.cord_diameter = 2.1;
  p.options.physics.bead_diameter = 9;
  options.channels = _i ? THR_KIT_LANES : THR_KIT_BORE;
  ck_assert_int_eq(thr_kit_make(&kit, &p, &options, NULL, false, &limits, &err), THR_EINPUT);
  thr_kit_destroy(&kit);
  const char *advice = strstr(err.text, "--cord-diameter ");
  ck_assert_msg(advice != NULL, "%s", err.text);
  p.options.physics.cord_diameter = strtod(advice + strlen("--cord-diameter "), NULL);
  kit = shapes_of(&p, &options, false);
  ck_assert_double_gt(p.options.physics.cord_diameter, 1);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* The number behind a word of the notes; 0 if the word is not there. */
static double advised(const thr_kit *kit, const char *word)
{
  const char *at = kit->notes.data ? strstr(kit->notes.data, word) : NULL;
  return at ? strtod(at + strlen(word), NULL) : 0;
}

START_TEST(numbers_that_notes_advise_do)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 4);
  thr_kit_options options = {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES};
  thr_kit kit = shapes_of(&p, &options, false);
  options.width = advised(&kit, "--width ");
  ck_assert_double_gt(options.width, kit.options.width);
  thr_kit_destroy(&kit);
  kit = shapes_of(&p, &options, false);
  ck_assert_double_eq(kit.options.wall, 1.2);
  ck_assert_double_eq(advised(&kit, "print well: --width "), 0);
  thr_kit_destroy(&kit);

  options = (thr_kit_options){.letters = 12};
  kit = shapes_of(&p, &options, false);
  options.letters = advised(&kit, "--letters ");
  ck_assert_double_gt(options.letters, 1);
  thr_kit_destroy(&kit);
  kit = shapes_of(&p, &options, false);
  ck_assert_double_eq(advised(&kit, "--letters "), 0);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* Every pair of points of strangers in a wide kit of a
 * round shape is farther apart than their arms are thick. */
START_TEST(arms_of_wide_kits_keep_apart)
{
  thr_plan p = plan_of(_i ? THR_MAKE_SPHERE : THR_MAKE_GEODESIC, 1);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES, .width = 40};
  thr_kit kit = shapes_of(&p, &options, false);
  const thr_frame *f = &p.frame;
  for (int e = 0; e < f->n_edges; e++)
    for (int g = 0; g < e; g++) {
      double least = INFINITY;
      bool neighbours = false;
      for (int i = 0; i < 4; i++)
        neighbours |= f->edge[e][i / 2] == f->edge[g][i % 2];
      if (neighbours) continue;
      for (int i = 0; i <= 40; i++)
        for (int j = 0; j <= 40; j++) {
          double a[3], b[3];
          for (int k = 0; k < 3; k++) {
            const double *from = f->xyz[f->edge[e][0]], *to = f->xyz[f->edge[e][1]];
            a[k] = kit.mm * (from[k] + (to[k] - from[k]) * i / 40);
            from = f->xyz[f->edge[g][0]], to = f->xyz[f->edge[g][1]];
            b[k] = kit.mm * (from[k] + (to[k] - from[k]) * j / 40);
          }
          least = fmin(least, thr_distance(a, b));
        }
      ck_assert_double_ge(least, 0.5 * (kit.edges.edge[e].width + kit.edges.edge[g].width));
    }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(a_hook_stands_where_a_cord_ends_at_a_foot)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3);
  thr_kit_options options = {.names = THR_KIT_NO_NAMES, .foot = THR_KIT_HOOK};
  thr_kit kit = shapes_of(&p, &options, true);
  int hooks = 0;
  for (int q = 0; q < kit.n_pieces; q++) {
    const thr_kit_piece *piece = &kit.piece[q];
    const thr_mesh_report *report = &kit.report[piece->like];
    bool open = false;
    for (int c = 0; c < piece->n_channels; c++)
      open |= piece->channel[c].in < 0 || piece->channel[c].out < 0;
    ck_assert_int_eq(piece->hook_radius > 0, open && piece->foot);
    ck_assert_int_eq(report->open_edges + report->crossings, 0);
    ck_assert_int_eq(report->parts, 1);
    if (!(piece->hook_radius > 0)) continue;
    hooks++;

    /* The piece still stands on its base, and reaches to the back of the hook. */
    double out = 0, farthest = 0, along[3] = {piece->hook[1][0], piece->hook[1][1], 0};
    out = thr_normalize(along);
    ck_assert_double_eq_tol(report->low[2], -piece->base, 1e-6);
    for (int i = 0; i < kit.mesh[q].n_points; i++)
      farthest = fmax(farthest, thr_dot(kit.mesh[q].point[i], along));
    ck_assert_double_eq_tol(farthest, out + piece->hook_radius, 0.1 * piece->hook_radius);

    /* The cord comes out level, above the hook, and has room between hook and foot. */
    for (int c = 0; c < piece->n_channels; c++) {
      const thr_kit_channel *channel = &piece->channel[c];
      if (channel->in >= 0 && channel->out >= 0) continue;
      const double *end = channel->point[channel->out < 0 ? channel->n - 1 : 0];
      ck_assert_double_eq_tol(end[2], 0, 1e-9);
      ck_assert_double_gt(thr_dot(end, along), 0);
      ck_assert_double_lt(piece->hook[2][2] + piece->hook_radius, -channel->radius);
    }
    double most = 0, above = piece->hook[0][2] + piece->hook_radius;
    ck_assert_double_gt(piece->hook[2][2] + piece->hook_radius, above + kit.cord);
    for (double by = piece->pad; by < out; by += 0.02) {
      const double at[3] = {by * along[0], by * along[1], above + 0.8 * kit.cord};
      most = fmax(most, thr_kit_body(piece, at, NULL));
    }
    ck_assert_double_gt(most, 0.5 * kit.cord);
  }
  ck_assert_int_gt(hooks, 0);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* Feet on a slope: where an arm goes down beside a foot there is no base to cut it off, and the kit
 * says so; where it hardly does, the base is deeper. */
START_TEST(a_base_cuts_off_no_arm)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3);
  for (int v = 0; v < p.frame.n_nodes; v++)
    p.frame.xyz[v][2] = (_i ? 0.7 : 0.1) * p.frame.xyz[v][0];
  thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  thr_kit kit = shapes_of(&p, &options, true);
  int feet = 0, bases = 0;
  for (int q = 0; q < kit.n_pieces; q++) {
    const thr_kit_piece *piece = &kit.piece[q];
    double deep = 0;
    if (!p.frame.foot[q]) continue;
    feet++;
    bases += piece->foot;
    for (int i = 0; i < piece->n_arms; i++)
      deep = fmax(deep, -piece->arm[i].along[2] * piece->arm[i].length);
    if (piece->foot) ck_assert_double_ge(piece->base, deep);
    if (piece->like == q) ck_assert_double_lt(kit.report[q].low[2], -deep);
    ck_assert_int_eq(kit.report[piece->like].open_edges, 0);
  }
  ck_assert_int_gt(bases, 0);
  ck_assert_int_eq(bases < feet, _i);
  ck_assert_int_eq(kit.notes.data && strstr(kit.notes.data, "no base, since an arm") != NULL, _i);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("kit_fit");
  ADD_LOOP(s, 60, a_base_cuts_off_no_arm, 0, 2);
  ADD_LOOP(s, 30, the_distance_of_segments_is_that_of_many_points, 0, 40);
  ADD_LOOP(s, 120, pairs_of_channels_that_cut_each_other_are_counted, 0, KITS);
  ADD_TEST(s, 60, crossings_are_led_apart_where_there_is_room);
  ADD_LOOP(s, 300, the_thinnest_wall_is_that_of_the_mesh, 0, WALLED);
  ADD_TEST(s, 60, a_wall_that_is_too_thin_is_said_by_name);
  ADD_TEST(s, 60, a_hook_stands_where_a_cord_ends_at_a_foot);
  ADD_TEST(s, 30, strangers_do_not_touch);
  ADD_TEST(s, 30, edges_that_cross_are_named);
  ADD_LOOP(s, 30, the_cord_that_is_advised_fits, 0, 2);
  ADD_TEST(s, 30, numbers_that_notes_advise_do);
  ADD_LOOP(s, 30, arms_of_wide_kits_keep_apart, 0, 2);
  return run_suite(s);
}
