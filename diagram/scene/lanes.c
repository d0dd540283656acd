/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses which lane each pass takes inside its bead, so that cords cross in few nodes.
 *
 * First every two passes of a bead are compared by following both cords to where they part: the one
 * that parts to the left keeps left all the way, so that a parallel run has at most one crossing
 * (as in metro maps: Bekos, Kaufmann, Potika, Symvonis 2008). The passes of a bead are sorted by
 * the sum of their comparisons. Then lanes are swapped while a swap lowers the number of crossings
 * inside the two nodes of a bead, in a few sweeps.
 *
 * Example: cords A and B share nine beads in a row; A parts to the left, so A lies left of B in all
 * nine. */
#include "diagram/scene/scene.h"

#include <math.h>
#include <stdlib.h>

/* Limits that keep the work on crowded edges and nodes small. */
enum {
  LOOK_AHEAD = 60, /* passes that two cords are followed */
  MAX_LANES = 24,  /* of a bead; lanes of fuller beads stay in the order of the passes */
  MAX_CHORDS = 40, /* through a node; crossings in fuller nodes are not counted */
  SWEEPS = 4       /* over all edges */
};

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

/* Returns the half-edge of the walker's pass in its direction. */
static int moving_half(const thr_scene *scene, walker walk)
{
  return walk.step > 0 ? scene->pass[walk.pass].half : scene->pass[walk.pass].half ^ 1;
}

/* Returns the angle at which the walker leaves the point ahead; *out: the half-edge that the walker
 * leaves by, -1 if to a mark. */
static double leave(const thr_scene *scene, walker walk, int *out)
{
  const thr_mark *mark = walk.step > 0 ? thr_scene_mark_after(scene, walk.pass)
                                       : thr_scene_mark_before(scene, walk.pass);

  /* At a mark the cord ends on paper. */
  if (mark) {
    *out = -1;
    return mark->angle;
  }
  *out = moving_half(scene, (walker){walk.pass + walk.step, walk.step});
  return scene->angle[*out];
}

/* Follows two walkers that move on one edge to the same node until they part. Returns 1 if the
 * first one then goes to the side of the edge's normal (seen in the direction of movement), -1 if
 * the second one does, 0 if no side can be told. */
static int part(const thr_scene *scene, walker first, walker second)
{
  for (int i = 0; i < LOOK_AHEAD; i++) {
    int first_out, second_out, h = moving_half(scene, first);

    double first_angle = leave(scene, first, &first_out),
           second_angle = leave(scene, second, &second_out), back = scene->angle[h ^ 1];

    /* A walker that turns back parts from the other to no side. */
    if (first_out == (h ^ 1) || second_out == (h ^ 1)) return 0;

    /* They part: the larger turn, counted from where they come from, lies towards the normal. */
    if (first_out != second_out || first_out < 0) {
      double first_turn = thr_scene_sweep(back, first_angle),
             second_turn = thr_scene_sweep(back, second_angle);
      return (first_turn > second_turn) - (first_turn < second_turn);
    }

    /* Go on together. */
    first.pass += first.step;
    second.pass += second.step;
  }

  return 0;
}

/* Returns 1 if pass i should lie further towards the normal of their edge than pass j > i, -1 if
 * less, 0 if both are as good. Walking with the earlier pass first gives the same answer all along
 * a parallel run. */
static int compare(const thr_scene *scene, int i, int j)
{
  bool same = scene->pass[i].half == scene->pass[j].half;
  int ahead = part(scene, (walker){i, 1}, (walker){j, same ? 1 : -1});
  int verdict = ahead ? ahead : -part(scene, (walker){i, -1}, (walker){j, same ? -1 : 1});
  return scene->pass[i].half & 1 ? -verdict : verdict;
}

/* Sorts the passes of edge e by the sum of their comparisons, which need not be transitive. */
static void order_edge(thr_scene *scene, int e)
{
  int *on = &scene->on[scene->first_on[e]], n = scene->first_on[e + 1] - scene->first_on[e],
      score[MAX_LANES] = {0};

  if (n < 2 || n > MAX_LANES) return;

  /* Each pass scores against each other. */
  for (int i = 0; i < n; i++)
    for (int j = i + 1; j < n; j++) {
      int order = compare(scene, on[i], on[j]);
      score[i] += order;
      score[j] -= order;
    }

  /* Insertion sort: stable, and short. */
  for (int i = 1; i < n; i++)
    for (int j = i; j > 0 && score[j] < score[j - 1]; j--) {
      int moved_score = score[j], moved = on[j];
      score[j] = score[j - 1];
      on[j] = on[j - 1];
      score[j - 1] = moved_score;
      on[j - 1] = moved;
    }
}

/* Numbers the lanes of every edge in the order of its passes. */
static void number_lanes(thr_scene *scene)
{
  for (int e = 0; e < scene->frame->n_edges; e++)
    for (int i = scene->first_on[e]; i < scene->first_on[e + 1]; i++)
      scene->pass[scene->on[i]].lane = i - scene->first_on[e];
}

/* ---- then swap lanes ---- */

/* Returns the place on the rim of its node of the lane of pass i, at its start (end = false) or its
 * end: the rank of the half-edge there, plus a part in (0, 1) by lane. */
static double port(const thr_scene *scene, int i, bool end)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];

  int h = end ? scene_pass->half ^ 1 : scene_pass->half, e = h >> 1,
      n = scene->first_on[e + 1] - scene->first_on[e];

  /* Seen from the node, the lanes lie by rising angle towards the normal of the outgoing direction.
   */
  int place = h & 1 ? n - 1 - scene_pass->lane : scene_pass->lane;
  return scene->rank[h] + (place + 1.0) / (n + 2);
}

/* Returns the place on the rim of a mark: after the half-edge whose angle comes before the
 * mark's. */
static double mark_port(const thr_scene *scene, const thr_mark *mark)
{
  const thr_frame *frame = scene->paper;

  int first = frame->first[mark->point], rank = 0;
  for (int i = 0; i < thr_degree(frame, mark->point); i++)
    if (scene->angle[scene->around[first + i]] <= mark->angle) rank = i + 1;

  /* Marks in one sector are told apart by their angles. */
  return rank - 1 + 0.99 + 0.0001 * mark->angle;
}

/* Returns the chord of a joint through its node. */
static chord chord_of(const thr_scene *scene, int joint)
{
  if (joint < 0)
    return (chord){mark_port(scene, thr_scene_mark_before(scene, -1 - joint)),
                   port(scene, -1 - joint, false)};

  const thr_mark *mark = thr_scene_mark_after(scene, joint);
  return (chord){port(scene, joint, true),
                 mark ? mark_port(scene, mark) : port(scene, joint + 1, false)};
}

/* Returns the point where a joint is. */
static int joint_point(const thr_scene *scene, int joint)
{
  return joint < 0 ? thr_tail(scene->paper, scene->pass[-1 - joint].half)
                   : thr_head(scene->paper, scene->pass[joint].half);
}

static bool between(double x, chord c)
{
  return x > fmin(c.a, c.b) && x < fmax(c.a, c.b);
}

/* Returns the number of crossings of the chords at a point, each pair counted once. */
static int crossings_at(const thr_scene *scene, const joints *at, int v)
{
  chord chords[MAX_CHORDS];
  int n = at->first[v + 1] - at->first[v], count = 0;
  if (n > MAX_CHORDS) return 0;

  for (int i = 0; i < n; i++)
    chords[i] = chord_of(scene, at->joint[at->first[v] + i]);

  /* Two chords of a circle cross if exactly one end of one lies between the ends of the other. */
  for (int i = 0; i < n; i++)
    for (int j = 0; j < i; j++)
      count += between(chords[j].a, chords[i]) != between(chords[j].b, chords[i]);
  return count;
}

/* Returns the crossings at both ends of an edge. */
static int crossings_of_edge(const thr_scene *scene, const joints *at, int e)
{
  return crossings_at(scene, at, scene->paper->edge[e][0]) +
         crossings_at(scene, at, scene->paper->edge[e][1]);
}

/* Exchanges the lanes of the passes at places i and j of scene->on. */
static void swap_lanes(thr_scene *scene, int i, int j)
{
  int moved = scene->on[i], lane = scene->pass[moved].lane;
  scene->pass[moved].lane = scene->pass[scene->on[j]].lane;
  scene->pass[scene->on[j]].lane = lane;
  scene->on[i] = scene->on[j];
  scene->on[j] = moved;
}

/* Tries all swaps of two lanes of edge e, and keeps those that lower the number of crossings;
 * returns whether there were any. */
static bool improve_edge(thr_scene *scene, const joints *at, int e)
{
  int from = scene->first_on[e], to = scene->first_on[e + 1];
  bool better = false;
  if (to - from < 2 || to - from > MAX_LANES) return false;

  /* Only the two nodes of the edge change. */
  int now = crossings_of_edge(scene, at, e);
  for (int i = from; i < to && now; i++)
    for (int j = i + 1; j < to && now; j++) {
      swap_lanes(scene, i, j);
      int then = crossings_of_edge(scene, at, e);

      /* Keep the swap, or take it back. */
      if (then < now) {
        now = then;
        better = true;
      } else {
        swap_lanes(scene, i, j);
      }
    }
  return better;
}

/* Returns whether there is a joint of this number: every pass ends at one, and begins at one if it
 * comes from a mark. */
static bool is_joint(const thr_scene *scene, int joint)
{
  return joint >= 0 || thr_scene_mark_before(scene, -1 - joint);
}

/* Lists the joints of every point by a counting sort. */
static thr_status collect_joints(const thr_scene *scene, joints *at, thr_err *err)
{
  int n = scene->paper->n_nodes;

  /* One joint after each pass, and one before those that come from a mark. */
  at->first = thr_calloc((size_t)n + 2, sizeof *at->first);
  at->joint =
      thr_calloc((size_t)scene->n_passes + (size_t)scene->plan->n_cords + (size_t)scene->n_seams,
                 sizeof *at->joint);
  if (!at->first || !at->joint) return thr_nomem(err);

  /* Count, then sum, then fill. */
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
  /* Where strands go through nodes does not depend on their lanes. */
  joints at = {0};
  thr_status st = collect_joints(scene, &at, err);
  if (st) goto done;

  /* A first order from looking along the cords. */
  for (int e = 0; e < scene->frame->n_edges; e++)
    order_edge(scene, e);
  number_lanes(scene);

  /* Swaps, until a sweep brings nothing. */
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
