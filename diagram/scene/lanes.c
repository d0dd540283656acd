/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which lane each pass takes inside its bead, so that cords cross in few nodes.
 *
 * Two passes in a bead are first ordered by looking along both cords to where they part: the one
 * that parts to the left keeps left all the way, so a parallel run has at most one crossing (as in
 * metro maps: Bekos, Kaufmann, Potika, Symvonis 2008). Then lanes are swapped while that lowers the
 * number of crossings inside the two nodes of a bead. */
#include "diagram/scene/scene.h"

#include <math.h>
#include <stdlib.h>

enum { LOOK_AHEAD = 60, MAX_LANES = 24, MAX_CHORDS = 40, SWEEPS = 4 };

/* The way a strand goes through a node, as two ports on the node's rim: half-edge rank, then place
 * in the half-edge. */
typedef struct {
  double a, b;
} chord;

/* Strands by point: joint i is what pass i goes on to, the next pass or a mark; joint -1 - i is the
 * mark that pass i comes from.
 */
typedef struct {
  int *first; /* [points + 1] into joint */
  int *joint;
} joints;

/* ---- first order: look along the cords ---- */

/* A walk along a cord: standing on a pass, moving with it (step 1) or against it (step -1). */
typedef struct {
  int pass, step;
} walker;

static int moving_half(const thr_scene *scene, walker w)
{
  return w.step > 0 ? scene->pass[w.pass].half : scene->pass[w.pass].half ^ 1;
}

/* Angle at which the walker leaves the point ahead, and the half-edge it leaves by (-1: to a mark).
 */
static double leave(const thr_scene *scene, walker w, int *out)
{
  const thr_mark *mark =
      w.step > 0 ? thr_scene_mark_after(scene, w.pass) : thr_scene_mark_before(scene, w.pass);
  if (mark) {
    *out = -1;
    return mark->angle;
  }
  *out = moving_half(scene, (walker){w.pass + w.step, w.step});
  return scene->angle[*out];
}

/* Follows two walkers that stand on one edge and move to the same node until they part: 1 if p then
 * goes to the side of the edge's normal (seen in the direction of movement), -1 if q does, 0 if
 * that cannot be said. */
static int part(const thr_scene *scene, walker p, walker q)
{
  for (int i = 0; i < LOOK_AHEAD; i++) {
    int to_p, to_q, h = moving_half(scene, p);
    double a = leave(scene, p, &to_p), b = leave(scene, q, &to_q), back = scene->angle[h ^ 1];
    if (to_p == (h ^ 1) || to_q == (h ^ 1)) return 0;
    if (to_p != to_q || to_p < 0) {
      double turn_p = thr_scene_sweep(back, a), turn_q = thr_scene_sweep(back, b);
      return (turn_p > turn_q) - (turn_p < turn_q);
    }
    p.pass += p.step;
    q.pass += q.step;
  }
  return 0;
}

/* 1 if pass i should lie further towards the normal of their edge than pass j > i, -1 if less, 0 if
 * it does not matter. Walking with the earlier pass first gives the same answer all along a
 * parallel run. */
static int compare(const thr_scene *scene, int i, int j)
{
  bool same = scene->pass[i].half == scene->pass[j].half;
  int ahead = part(scene, (walker){i, 1}, (walker){j, same ? 1 : -1});
  int verdict = ahead ? ahead : -part(scene, (walker){i, -1}, (walker){j, same ? -1 : 1});
  return scene->pass[i].half & 1 ? -verdict : verdict;
}

/* Orders the passes of edge e by the sum of their comparisons. */
static void order_edge(thr_scene *scene, int e)
{
  int *on = &scene->on[scene->first_on[e]], n = scene->first_on[e + 1] - scene->first_on[e],
      score[MAX_LANES] = {0};
  if (n < 2 || n > MAX_LANES) return;
  for (int i = 0; i < n; i++)
    for (int j = i + 1; j < n; j++) {
      int c = compare(scene, on[i], on[j]);
      score[i] += c;
      score[j] -= c;
    }
  for (int i = 1; i < n; i++)
    for (int j = i; j > 0 && score[j] < score[j - 1]; j--) {
      int t = score[j], p = on[j];
      score[j] = score[j - 1];
      on[j] = on[j - 1];
      score[j - 1] = t;
      on[j - 1] = p;
    }
}

static void number_lanes(thr_scene *scene)
{
  for (int e = 0; e < scene->frame->n_edges; e++)
    for (int i = scene->first_on[e]; i < scene->first_on[e + 1]; i++)
      scene->pass[scene->on[i]].lane = i - scene->first_on[e];
}

/* ---- then swap lanes ---- */

/* Place on the rim of its node of the lane of pass i at its start (end = false) or its end. */
static double port(const thr_scene *scene, int i, bool end)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  int h = end ? scene_pass->half ^ 1 : scene_pass->half, e = h >> 1,
      n = scene->first_on[e + 1] - scene->first_on[e];
  /* seen from the node, the lanes lie by rising angle towards the normal of the outgoing direction
   */
  int place = h & 1 ? n - 1 - scene_pass->lane : scene_pass->lane;
  return scene->rank[h] + (place + 1.0) / (n + 2);
}

/* Place on the rim of a mark: after the half-edge whose angle comes before it. */
static double mark_port(const thr_scene *scene, const thr_mark *mark)
{
  const thr_frame *frame = scene->paper;
  int first = frame->first[mark->point], rank = 0;
  for (int i = 0; i < thr_degree(frame, mark->point); i++)
    if (scene->angle[scene->around[first + i]] <= mark->angle) rank = i + 1;
  return rank - 1 + 0.99 + 0.0001 * mark->angle;
}

static chord chord_of(const thr_scene *scene, int joint)
{
  if (joint < 0)
    return (chord){mark_port(scene, thr_scene_mark_before(scene, -1 - joint)),
                   port(scene, -1 - joint, false)};
  const thr_mark *mark = thr_scene_mark_after(scene, joint);
  return (chord){port(scene, joint, true),
                 mark ? mark_port(scene, mark) : port(scene, joint + 1, false)};
}

static int joint_point(const thr_scene *scene, int joint)
{
  return joint < 0 ? thr_tail(scene->paper, scene->pass[-1 - joint].half)
                   : thr_head(scene->paper, scene->pass[joint].half);
}

static bool between(double x, chord c)
{
  return x > fmin(c.a, c.b) && x < fmax(c.a, c.b);
}

/* Crossings of the chords at a point, each pair once. */
static int crossings_at(const thr_scene *scene, const joints *at, int v)
{
  chord c[MAX_CHORDS];
  int n = at->first[v + 1] - at->first[v], count = 0;
  if (n > MAX_CHORDS) return 0;
  for (int i = 0; i < n; i++)
    c[i] = chord_of(scene, at->joint[at->first[v] + i]);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      count += between(c[j].a, c[i]) != between(c[j].b, c[i]);
  return count;
}

static int crossings_of_edge(const thr_scene *scene, const joints *at, int e)
{
  return crossings_at(scene, at, scene->paper->edge[e][0]) +
         crossings_at(scene, at, scene->paper->edge[e][1]);
}

static void swap_lanes(thr_scene *scene, int i, int j)
{
  int t = scene->on[i], lane = scene->pass[t].lane;
  scene->pass[t].lane = scene->pass[scene->on[j]].lane;
  scene->pass[scene->on[j]].lane = lane;
  scene->on[i] = scene->on[j];
  scene->on[j] = t;
}

/* Tries all swaps of two lanes of edge e; true if one was kept. */
static bool improve_edge(thr_scene *scene, const joints *at, int e)
{
  int from = scene->first_on[e], to = scene->first_on[e + 1];
  bool better = false;
  if (to - from < 2 || to - from > MAX_LANES) return false;
  int now = crossings_of_edge(scene, at, e);
  for (int i = from; i < to && now; i++)
    for (int j = i + 1; j < to && now; j++) {
      swap_lanes(scene, i, j);
      int then = crossings_of_edge(scene, at, e);
      if (then < now) {
        now = then;
        better = true;
      } else {
        swap_lanes(scene, i, j);
      }
    }
  return better;
}

/* Is there a joint of this number? */
static bool is_joint(const thr_scene *scene, int joint)
{
  return joint >= 0 || thr_scene_mark_before(scene, -1 - joint);
}

/* Lists the joints of every point by counting. */
static thr_status collect_joints(const thr_scene *scene, joints *at, thr_err *err)
{
  int n = scene->paper->n_nodes;
  at->first = thr_calloc((size_t)n + 2, sizeof *at->first);
  at->joint =
      thr_calloc((size_t)scene->n_passes + (size_t)scene->plan->n_cords + (size_t)scene->n_seams,
                 sizeof *at->joint);
  if (!at->first || !at->joint) return thr_nomem(err);
  for (int i = -scene->n_passes; i < scene->n_passes; i++)
    if (is_joint(scene, i)) at->first[joint_point(scene, i) + 2]++;
  for (int v = 0; v < n; v++)
    at->first[v + 2] += at->first[v + 1];
  for (int i = -scene->n_passes; i < scene->n_passes; i++)
    if (is_joint(scene, i)) at->joint[at->first[joint_point(scene, i) + 1]++] = i;
  return THR_OK;
}

thr_status thr_scene_order_lanes(thr_scene *scene, thr_err *err)
{
  joints at = {0};
  thr_status st = collect_joints(scene, &at, err);
  if (st) goto done;
  for (int e = 0; e < scene->frame->n_edges; e++)
    order_edge(scene, e);
  number_lanes(scene);
  bool better = true;
  for (int sweep = 0; sweep < SWEEPS && better; sweep++) {
    better = false;
    for (int e = 0; e < scene->frame->n_edges; e++)
      better |= improve_edge(scene, &at, e);
  }
done:
  free(at.first);
  free(at.joint);
  return st;
}
