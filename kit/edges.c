/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the two pieces of an edge agree on: directions, width, and where passes cross the face.
 *
 * Lanes stand in rings round the middle of a face. Of all ways to give lanes to the passes of an
 * edge the one is taken in which each is nearest to the arms that its cord comes from and goes to:
 * then channels bend least and seldom meet. */
#include "kit/kit.h"

#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Unit vector from the tail of a half-edge to its head. */
static void direction_of(const thr_frame *frame, int half, double out[3])
{
  thr_direction(frame, half, out);
  thr_normalize(out);
}

/* Sums the directions that look away from a node's arms: outwards where the framework is curved,
 * away from its centre where it is not. Names stand on that side: it is the one that the booklet
 * shows, which of a bowl is the inner one. */
static void outward(const thr_frame *frame, int v, const double centre[3], const double (*shown)[3],
                    double out[3])
{
  double sum[3] = {0, 0, 0};
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    double along[3];
    direction_of(frame, frame->half[i], along);
    for (int k = 0; k < 3; k++)
      sum[k] -= along[k];
  }
  thr_between(centre, frame->xyz[v], out);
  thr_normalize(out);
  if (thr_normalize(sum) > 0.2 && thr_dot(sum, out) > 0) memcpy(out, sum, sizeof sum);
  const bool is_back = shown && thr_dot(out, shown[v]) < 0;
  for (int k = 0; k < 3 && is_back; k++)
    out[k] = -out[k];
}

/* Fills directions and lengths of all edges. */
static void set_directions(const thr_frame *frame, const double (*shown)[3], double mm,
                           thr_kit_edge *edge)
{
  double centre[3] = {0, 0, 0};
  for (int v = 0; v < frame->n_nodes; v++)
    for (int k = 0; k < 3; k++)
      centre[k] += frame->xyz[v][k] / frame->n_nodes;

  for (int e = 0; e < frame->n_edges; e++) {
    thr_kit_edge *here = &edge[e];
    const double *a = frame->xyz[frame->edge[e][0]], *b = frame->xyz[frame->edge[e][1]];
    double between[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    here->length = mm * thr_normalize(between);
    memcpy(here->along, between, sizeof between);

    double first[3], second[3];
    outward(frame, frame->edge[e][0], centre, shown, first);
    outward(frame, frame->edge[e][1], centre, shown, second);
    for (int k = 0; k < 3; k++)
      here->up[k] = first[k] + second[k];
    for (int attempt = 0; attempt < 3; attempt++) {
      double part = thr_dot(here->up, here->along);
      thr_along(here->up, -part, here->along, here->up);
      if (thr_normalize(here->up) > 1e-3) break;
      memcpy(here->up, attempt ? (double[]){1, 0, 0} : (double[]){0, 0, 1}, sizeof here->up);
    }
    thr_cross(here->up, here->along, here->side);
  }
}

/* Makes an edge narrower beside another one. */
static void narrow(thr_kit_edge *edge, int e, double most, int beside)
{
  if (most >= edge[e].width) return;
  edge[e].width = most;
  edge[e].beside = beside;
}

static const double APART = 0.96; /* of the width that two pieces would touch at */

/* Makes edges narrower that meet others at an acute angle, so that no face meets a neighbour's
 * arm. */
static void fit_neighbours(const thr_frame *frame, thr_kit_edge *edge)
{
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      for (int j = frame->first[v]; j < i; j++) {
        int e = frame->half[i] >> 1, f = frame->half[j] >> 1;
        double angle = THR_PI - thr_turn_angle(frame, frame->half[i] ^ 1, frame->half[j]);
        double shorter = 0.5 * fmin(edge[e].length, edge[f].length);
        double most = APART * 2 * shorter * tan(0.5 * fmin(angle, 0.5 * THR_PI));
        narrow(edge, e, most, f);
        narrow(edge, f, most, e);
      }
}

/* Returns the width at which two edges without a common node, or an edge and the node at one end of
 * another, would touch: their distance over the sum of their radii, as parts of the width. */
static double touching_width(const double a[2][3], const double b[2][3], double node)
{
  double part[2], parts = 0;
  double away = thr_kit_segments(a, b, part);
  for (int i = 0; i < 2; i++)
    parts += part[i] > 0 && part[i] < 1 ? 0.5 : node;
  return away / parts;
}

/* Makes edges narrower that come near edges of other nodes. They are compared in the order in which
 * their boxes begin along x, while the boxes meet. */
static thr_status fit_strangers(const thr_frame *frame, const thr_kit_sizes *sizes, bool tubes,
                                thr_kit_edge *edge, thr_err *err)
{
  int n = frame->n_edges;
  double node = tubes ? 0.5 : sizes->node;
  thr_scratch work = {0};
  thr_ranked *order = thr_scratch_array(&work, (size_t)n, sizeof *order);
  double(*end)[2][3] = thr_scratch_array(&work, (size_t)n, sizeof *end);
  thr_status st = thr_scratch_check(&work, err);
  for (int e = 0; e < n && !st; e++) {
    for (int i = 0; i < 2; i++)
      for (int k = 0; k < 3; k++)
        end[e][i][k] = sizes->mm * frame->xyz[frame->edge[e][i]][k];
    order[e] = (thr_ranked){fmin(end[e][0][0], end[e][1][0]), e};
  }
  if (!st) thr_sort_ranked(order, (size_t)n);

  double reach = 2 * fmax(node, 0.5) * sizes->width / APART;
  for (int i = 0; i < n && !st; i++) {
    int e = order[i].index;
    const double(*a)[3] = (const double(*)[3])end[e];
    double last = fmax(a[0][0], a[1][0]) + reach;
    for (int j = i + 1; j < n && order[j].key <= last; j++) {
      int f = order[j].index;
      const int *of_e = frame->edge[e], *of_f = frame->edge[f];
      const double(*b)[3] = (const double(*)[3])end[f];
      bool far = of_e[0] == of_f[0] || of_e[0] == of_f[1] || of_e[1] == of_f[0] ||
                 of_e[1] == of_f[1]; /* neighbours: see above */
      for (int k = 1; k < 3 && !far; k++)
        far = fmin(a[0][k], a[1][k]) > fmax(b[0][k], b[1][k]) + reach ||
              fmin(b[0][k], b[1][k]) > fmax(a[0][k], a[1][k]) + reach;
      if (far) continue;

      double most = touching_width(a, b, node);
      for (int k = 0; k < 2; k++) {
        const double tip[2][2][3] = {{{a[k][0], a[k][1], a[k][2]}, {a[k][0], a[k][1], a[k][2]}},
                                     {{b[k][0], b[k][1], b[k][2]}, {b[k][0], b[k][1], b[k][2]}}};
        most = fmin(most, touching_width(tip[0], b, node));
        most = fmin(most, touching_width(a, tip[1], node));
      }
      narrow(edge, e, APART * most, f);
      narrow(edge, f, APART * most, e);
    }
  }

  thr_scratch_free(&work);
  return st;
}

/* Radius of the circle that holds the middles of n lanes, with so much room for each. */
static double lanes_radius(int n, double room)
{
  if (n <= 1) return 0;
  if (n <= 6) return 0.5 * room / sin(THR_PI / n);
  return n <= 19 ? (n <= 7 ? room : 2 * room) : 3 * room;
}

/* Fills the places of n lanes: one in the middle, up to six in a ring, more in rings round the
 * middle. */
static void place_lanes(thr_kit_edge *edge, int n, double room)
{
  edge->n_lanes = n;
  edge->lane[0][0] = edge->lane[0][1] = 0;
  int ring = n > 6 ? 1 : 0, placed = n > 6 ? 1 : 0;
  if (n <= 1) return;
  while (placed < n) {
    int here = ring ? 6 * ring : n;
    if (here > n - placed) here = n - placed;
    double radius = ring ? ring * room : lanes_radius(n, room);
    for (int i = 0; i < here; i++) {
      double angle = 2 * THR_PI * (i + 0.5) / here;
      edge->lane[placed + i][0] = radius * sin(angle);
      edge->lane[placed + i][1] = radius * cos(angle);
    }
    placed += here;
    ring++;
  }
}

/* Where a pass would like to be on its face, along up and side: towards the arms before and after
 * it. */
static void wish_of(const thr_plan *plan, int c, int k, const thr_kit_edge *edge, double wish[2])
{
  const thr_frame *frame = &plan->frame;
  const thr_cord *cord = &plan->cord[c];
  bool round = thr_cord_turns(&plan->options, cord) == cord->n_passes;
  int n = cord->n_passes;
  int before = k > 0 ? cord->half[k - 1] ^ 1 : round ? cord->half[n - 1] ^ 1 : -1;
  int after = k + 1 < n ? cord->half[k + 1] : round ? cord->half[0] : -1;

  wish[0] = wish[1] = 0;
  for (int i = 0; i < 2; i++) {
    int half = i ? after : before;
    double along[3];
    if (half < 0) continue;
    direction_of(frame, half, along);
    wish[0] += thr_dot(along, edge->up);
    wish[1] += thr_dot(along, edge->side);
  }
}

/* Gives lanes to the passes of one edge, on[n]: exchanges two as long as that helps. */
static void give_lanes(const thr_plan *plan, const thr_kit_edge *edge, const int (*on)[2], int n,
                       const int *first_pass, int *lane)
{
  double wish[THR_KIT_MOST_LANES][2];
  int of[THR_KIT_MOST_LANES];
  for (int i = 0; i < n; i++) {
    wish_of(plan, on[i][0], on[i][1], edge, wish[i]);
    of[i] = i;
  }

  bool better = true;
  for (int round = 0; better && round < 2 * THR_KIT_MOST_LANES; round++) {
    better = false;
    for (int i = 0; i < n; i++)
      for (int j = 0; j < i; j++) {
        const double *a = edge->lane[of[i]], *b = edge->lane[of[j]];
        double gain =
            (wish[i][0] - wish[j][0]) * (b[0] - a[0]) + (wish[i][1] - wish[j][1]) * (b[1] - a[1]);
        if (gain <= 1e-9) continue;
        int exchanged = of[i];
        of[i] = of[j];
        of[j] = exchanged;
        better = true;
      }
  }
  for (int i = 0; i < n; i++)
    lane[first_pass[on[i][0]] + on[i][1]] = of[i];
}

/* Says that an edge has no room for its channels beside another one, and what would do. */
static thr_status fail_narrow(const thr_plan *plan, const thr_kit_sizes *sizes,
                              const thr_kit_edge *here, const thr_kit_edge *edge, int lanes,
                              const char (*label)[THR_LABEL], thr_err *err)
{
  const int *own = plan->frame.edge[here - edge], *other = plan->frame.edge[here->beside];
  if (here->width < 1e-6 * sizes->width)
    return thr_fail(err, THR_EINPUT, "%s-%s and %s-%s cross: they need a node where they do",
                    label[own[0]], label[own[1]], label[other[0]], label[other[1]]);

  /* A thinner cord, by as much as bore and lanes are to shrink; or thinner walls. */
  double spread = 2 * lanes_radius(lanes, 1); /* of the lanes, for each mm from lane to lane */
  double needed = spread * (here->bore + sizes->wall) + here->bore + 2 * sizes->wall;
  double least = sizes->wall_given ? sizes->wall : 0.06 * here->width; /* others give way */
  double bore = (here->width - (spread + 2) * least) / (spread + 1);
  double wall = (here->width - (spread + 1) * here->bore) / (spread + 2);
  double asked = plan->options.physics.bore, usual = asked > 0 ? asked : sizes->cord;
  char advice[2][40] = {"", ""};
  double cord = floor(100 * usual * bore / here->bore) / 100;
  if (cord >= 0.01)
    snprintf(advice[0], sizeof advice[0], "plan %s %.3g, ",
             asked > 0 ? "--bore" : "--cord-diameter", cord);
  if (wall >= 0.01) snprintf(advice[1], sizeof advice[1], "--wall %.3g, ", floor(100 * wall) / 100);
  return thr_fail(err, THR_EINPUT,
                  "%s-%s: there is room for an arm %.3g mm wide beside %s-%s; %d channel%s of "
                  "%.3g mm with walls of %.3g mm need%s %.3g: %s%s%sa larger framework for "
                  "the same cord",
                  label[own[0]], label[own[1]], here->width, label[other[0]], label[other[1]],
                  lanes, lanes == 1 ? "" : "s", here->bore, sizes->wall, lanes == 1 ? "s" : "",
                  needed, advice[0], advice[1], *advice[0] || *advice[1] ? "or " : "");
}

/* Returns the width that so many lanes and their walls need. */
static double needed_width(const thr_kit_edge *edge, int lanes, double wall)
{
  return 2 * lanes_radius(lanes, edge->bore + wall) + edge->bore + 2 * wall;
}

/* Checks that every edge is wide enough for its channels and walls. */
static thr_status check_widths(const thr_plan *plan, const thr_kit_options *options,
                               thr_kit_sizes *sizes, const thr_kit_edge *edge, const int *passes,
                               const char (*label)[THR_LABEL], thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  double asked = sizes->wall;
  for (int e = 0; e < frame->n_edges; e++) {
    int lanes = options->channels == THR_KIT_LANES ? passes[e] : 1;
    const char *a = label[frame->edge[e][0]], *b = label[frame->edge[e][1]];
    if (lanes > THR_KIT_MOST_LANES)
      return thr_fail(
          err, THR_EINPUT,
          "%s-%s: %d passes, but a face has at most %d lanes: --channels bore makes one "
          "channel for all",
          a, b, lanes, THR_KIT_MOST_LANES);
    double ring = lanes_radius(lanes, edge[e].bore + sizes->wall);
    double needed = needed_width(&edge[e], lanes, sizes->wall);
    if (edge[e].width >= needed) continue;

    /* A wall that nobody asked for gives way as far as half of what there is. */
    double room = edge[e].width - edge[e].bore - 2 * ring;
    if (!sizes->wall_given && room > 0.1 * edge[e].width) {
      sizes->wall = fmin(sizes->wall, 0.45 * room);
      e = -1; /* from the first one again: lanes are nearer to each other now */
      continue;
    }
    if (edge[e].width >= sizes->width * (1 - 1e-9))
      return thr_fail(err, THR_EINPUT,
                      "%s-%s: %d channel%s of %.3g mm with walls of %.3g mm %s arms %.3g mm wide, "
                      "not %.3g: --width %.3g or more",
                      a, b, lanes, lanes == 1 ? "" : "s", edge[e].bore, sizes->wall,
                      lanes == 1 ? "needs" : "need", needed, edge[e].width,
                      ceil(100 * needed) / 100);
    return fail_narrow(plan, sizes, &edge[e], edge, lanes, label, err);
  }

  /* The width that walls as asked for need, if neighbours leave it to every edge. */
  for (int e = 0; e < frame->n_edges; e++) {
    double needed =
        needed_width(&edge[e], options->channels == THR_KIT_LANES ? passes[e] : 1, asked);
    sizes->roomy = fmax(sizes->roomy, needed);
    if (needed > edge[e].width && edge[e].width < sizes->width * (1 - 1e-9)) {
      sizes->roomy = 0;
      break;
    }
  }
  return THR_OK;
}

/* Says how many edges are narrower than asked for. */
static void note_widths(const thr_frame *frame, const thr_kit_edge *edge, double width,
                        const char (*label)[THR_LABEL], thr_text *notes)
{
  int narrower = 0, least = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    narrower += edge[e].width < width * (1 - 1e-9);
    if (edge[e].width < edge[least].width) least = e;
  }
  if (narrower)
    thr_text_printf(notes,
                    "%d of %d arms are narrower than %.3g mm, since others are near: %s-%s is "
                    "%.3g mm wide beside %s-%s\n",
                    narrower, frame->n_edges, width, label[frame->edge[least][0]],
                    label[frame->edge[least][1]], edge[least].width,
                    label[frame->edge[edge[least].beside][0]],
                    label[frame->edge[edge[least].beside][1]]);
}

thr_status thr_kit_edges_make(thr_kit_edges *edges, const thr_plan *plan,
                              const thr_kit_options *options, thr_kit_sizes *sizes,
                              const char (*label)[THR_LABEL], const double (*shown)[3],
                              thr_text *notes, thr_err *err)
{
  const thr_frame *frame = &plan->frame;
  thr_scratch work = {0};
  int total = 0;
  for (int c = 0; c < plan->n_cords; c++) {
    edges->first_pass[c] = total;
    total += plan->cord[c].n_passes;
  }
  edges->first_pass[plan->n_cords] = total;
  edges->lane = thr_scratch_array(&edges->own, (size_t)total, sizeof *edges->lane);

  /* The passes of every edge, edge after edge. */
  int *passes = thr_scratch_array(&work, (size_t)frame->n_edges, sizeof *passes);
  int *first = thr_scratch_array(&work, (size_t)frame->n_edges + 2, sizeof *first);
  int(*on)[2] = thr_scratch_array(&work, (size_t)total, sizeof *on);
  thr_status st = thr_scratch_check(&work, err);
  if (!st) st = thr_scratch_check(&edges->own, err);
  if (st) goto done;
  for (int c = 0; c < plan->n_cords; c++)
    for (int k = 0; k < plan->cord[c].n_passes; k++)
      first[(plan->cord[c].half[k] >> 1) + 2]++;
  for (int e = 0; e < frame->n_edges; e++) {
    passes[e] = first[e + 2];
    first[e + 2] += first[e + 1];
  }
  for (int c = 0; c < plan->n_cords; c++)
    for (int k = 0; k < plan->cord[c].n_passes; k++) {
      int *place = on[first[(plan->cord[c].half[k] >> 1) + 1]++];
      place[0] = c;
      place[1] = k;
    }

  set_directions(frame, shown, sizes->mm, edges->edge);
  for (int e = 0; e < frame->n_edges; e++)
    edges->edge[e].width = sizes->width;
  bool tubes = plan->options.joint != THR_JOINT_SOLID;
  if (!tubes) fit_neighbours(frame, edges->edge);
  st = fit_strangers(frame, sizes, tubes, edges->edge, err);
  if (!st) st = check_widths(plan, options, sizes, edges->edge, passes, label, err);
  if (st) goto done;
  note_widths(frame, edges->edge, sizes->width, label, notes);

  for (int e = 0; e < frame->n_edges; e++) {
    thr_kit_edge *edge = &edges->edge[e];
    bool lanes = options->channels == THR_KIT_LANES;
    place_lanes(edge, lanes ? passes[e] : passes[e] > 0, edge->bore + sizes->wall);
    if (lanes && passes[e] > 1)
      give_lanes(plan, edge, (const int(*)[2])on + first[e], passes[e], edges->first_pass,
                 edges->lane);
  }

done:
  thr_scratch_free(&work);
  return st;
}

thr_status thr_kit_edges_share(const thr_kit_edges *edges, const thr_plan *plan, double cord,
                               double (*off)[3], thr_err *err)
{
  thr_scratch own = {0};
  size_t bores = (size_t)plan->frame.n_edges * THR_KIT_MOST_LANES;
  int *count = thr_scratch_array(&own, bores, sizeof *count);
  int *placed = thr_scratch_array(&own, bores, sizeof *placed);
  thr_status st = thr_scratch_check(&own, err);

  /* Count, then place. */
  for (int round = 0; round < 2 && !st; round++)
    for (int c = 0; c < plan->n_cords; c++)
      for (int k = 0; k < plan->cord[c].n_passes; k++) {
        int pass = edges->first_pass[c] + k, e = plan->cord[c].half[k] >> 1;
        const thr_kit_edge *edge = &edges->edge[e];
        int bore = e * THR_KIT_MOST_LANES + (edge->n_lanes > 1 ? edges->lane[pass] : 0);
        if (round == 0) {
          count[bore]++;
          continue;
        }
        int n = count[bore];
        double room = n > 1 ? fmax(0.5 * (edge->bore - cord), 0) : 0;
        double angle = 2 * THR_PI * placed[bore]++ / n;
        for (int i = 0; i < 3; i++)
          off[pass][i] = room * (cos(angle) * edge->up[i] + sin(angle) * edge->side[i]);
      }
  thr_scratch_free(&own);
  return st;
}
