/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds feet, the nodes on which a framework stands and where cords may come out: its lowest nodes,
 * those below a height, or the rim of a shell.
 *
 * The rim is found from the graph alone, so that it may be as uneven as it likes. A panel is a
 * circuit that is the only shortest one round each of its corners: a pair of edges that follow each
 * other on it, at a node with more edges than these two. The shortest circuit round a corner is
 * found by breadth-first search between the two neighbours without the node. On a shell every edge
 * is a side of one panel, on the rim, or of two, but for edges that stick out, whose ends count as
 * rim. So does the edge of a hole unless it is as small as a panel.
 *
 * Example: on the 7 x 7 dome the 36 squares are panels. Along its edge a corner is round two
 * squares, a circuit of 6 edges, and not round the whole edge, of 24: this is its rim. */
#include "graph/arrays.h"
#include "graph/framework/frame.h"

#include <math.h>
#include <string.h>

/* Sides of a panel, at most. */
enum { MOST_SIDES = 64 };

/* ---- the lowest nodes, and those below a height ---- */

/* Marks the nodes whose z is at most `height`, and no others; returns how many. */
static int mark_below(const thr_frame *frame, double height, bool *foot)
{
  int n = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    foot[v] = frame->xyz[v][2] <= height;
    n += foot[v];
  }
  return n;
}

/* Returns z of the lowest node. */
static double lowest_of(const thr_frame *frame)
{
  double lowest = INFINITY;
  for (int v = 0; v < frame->n_nodes; v++)
    lowest = fmin(lowest, frame->xyz[v][2]);
  return lowest;
}

/* Marks the lowest nodes, and those less than a millionth of the size above them. */
static int mark_lowest(const thr_frame *frame, bool *foot)
{
  return mark_below(frame, lowest_of(frame) + 1e-6 * thr_frame_diagonal(frame), foot);
}

int thr_frame_feet(const thr_frame *frame)
{
  int n = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    n += frame->foot[v];
  return n;
}

int thr_frame_standing(const thr_frame *frame, bool *foot)
{
  const int n = thr_frame_feet(frame);
  if (n == 0) return mark_lowest(frame, foot);

  memcpy(foot, frame->foot, (size_t)frame->n_nodes * sizeof *foot);
  return n;
}

void thr_frame_feet_lowest(thr_frame *frame)
{
  mark_lowest(frame, frame->foot);
}

/* ---- the rim of a shell ---- */

typedef struct {
  const thr_frame *frame;
  int *queue, *distance, *way, *before; /* [n_nodes] of a search: nodes in the order in which they
                                           are met, edges to a node (-1: not met), shortest ways to
                                           it (2: several), and the half-edge that one arrives by */
  int *panels;                          /* [n_edges] that an edge is a side of */
} rim_search;

/* Adds the nodes that are met from v to the queue. */
static int meet_neighbours(rim_search *search, int v, int without, int n)
{
  const thr_frame *frame = search->frame;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    const int w = thr_head(frame, frame->half[i]);
    if (w == without) continue;

    /* A node is met again by as short a way, or it was not met before. */
    if (search->distance[w] == search->distance[v] + 1) search->way[w] = 2;
    if (search->distance[w] >= 0) continue;
    search->distance[w] = search->distance[v] + 1;
    search->way[w] = search->way[v];
    search->before[w] = frame->half[i];
    search->queue[n++] = w;
  }
  return n;
}

/* Finds the shortest circuit out of the node that two half-edges leave along the one and back along
 * the other. Returns its length in edges, 0 if there is none or several are as short, and fills
 * circuit[MOST_SIDES] with half-edges that follow each other, the first one `out`. */
static int shortest_round(rim_search *search, int out, int back, int *circuit)
{
  const thr_frame *frame = search->frame;
  const int v = thr_tail(frame, out), from = thr_head(frame, out), to = thr_head(frame, back);
  int n = 1, sides = 0;

  /* Breadth-first search until all nodes as near as `to` have been gone on from. */
  search->queue[0] = from;
  search->distance[from] = 0;
  search->way[from] = 1;
  for (int i = 0; i < n; i++) {
    const int w = search->queue[i],
              most = search->distance[to] >= 0 ? search->distance[to] - 1 : MOST_SIDES - 3;
    if (search->distance[w] > most) break;
    n = meet_neighbours(search, w, v, n);
  }

  /* The way back from `to` is the circuit. */
  if (search->distance[to] >= 0 && search->way[to] == 1) {
    sides = search->distance[to] + 2;
    circuit[0] = out;
    circuit[sides - 1] = back ^ 1;
    for (int w = to, k = sides - 2; w != from; w = thr_tail(frame, search->before[w]))
      circuit[k--] = search->before[w];
  }

  /* Only what was met is forgotten. */
  for (int i = 0; i < n; i++)
    search->distance[search->queue[i]] = -1;
  return sides;
}

/* Returns whether a circuit is a panel that was found at the first of its corners: from its lowest
 * node with more than two edges. */
static bool is_panel(rim_search *search, const int *circuit, int sides)
{
  const thr_frame *frame = search->frame;
  const int first = thr_tail(frame, circuit[0]);
  int other[MOST_SIDES];

  for (int k = 1; k < sides; k++) {
    const int v = thr_tail(frame, circuit[k]);
    if (thr_degree(frame, v) == 2) continue;
    if (v < first || shortest_round(search, circuit[k], circuit[k - 1] ^ 1, other) != sides)
      return false;
  }
  return true;
}

/* Counts, for every edge, the panels that it is a side of. O(corners), as panels are small. */
static void count_panels(rim_search *search)
{
  const thr_frame *frame = search->frame;
  int circuit[MOST_SIDES];

  for (int v = 0; v < frame->n_nodes; v++) {
    if (thr_degree(frame, v) == 2) continue;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      for (int k = i + 1; k < frame->first[v + 1]; k++) {
        const int sides = shortest_round(search, frame->half[i], frame->half[k], circuit);
        if (sides == 0 || !is_panel(search, circuit, sides)) continue;
        for (int s = 0; s < sides; s++)
          search->panels[circuit[s] >> 1]++;
      }
    }
  }
}

/* Marks the nodes of edges that are a side of one panel, and the free ends of edges that stick out.
 * THR_EINPUT if there is no such side, or if another edge is no side, or one of more than two. */
static thr_status mark_rim(const thr_frame *frame, const int *panels, bool *rim, thr_err *err)
{
  int n_sides[3] = {0};
  for (int e = 0; e < frame->n_edges; e++) {
    const int *end = frame->edge[e];
    bool sticks_out = false;
    for (int k = 0; k < 2; k++) {
      const bool is_free = thr_degree(frame, end[k]) == 1;
      rim[end[k]] |= panels[e] == 1 || is_free;
      sticks_out |= is_free;
    }
    if (panels[e] > 2 || (panels[e] == 0 && !sticks_out))
      return thr_fail(
          err, THR_EINPUT,
          "rim: this is no shell, as the edge %.40s-%.40s is a side of %d panels, not of "
          "one or two; name the feet, or take lowest",
          frame->name[end[0]], frame->name[end[1]], panels[e]);
    n_sides[panels[e]]++;
  }
  return n_sides[1] > 0 ? THR_OK
                        : thr_fail(err, THR_EINPUT, "rim: %s; name the feet, or take lowest",
                                   n_sides[2] ? "this shell is closed, as every edge is a side of "
                                                "two panels"
                                              : "this is no shell, as it has no panels");
}

/* Makes the nodes on the rim the feet. */
static thr_status feet_rim(thr_frame *frame, thr_err *err)
{
  const size_t nodes = (size_t)frame->n_nodes;
  thr_scratch own = {0};
  rim_search search = {frame,
                       thr_scratch_array(&own, nodes, sizeof *search.queue),
                       thr_scratch_array(&own, nodes, sizeof *search.distance),
                       thr_scratch_array(&own, nodes, sizeof *search.way),
                       thr_scratch_array(&own, nodes, sizeof *search.before),
                       thr_scratch_array(&own, (size_t)frame->n_edges, sizeof *search.panels)};
  bool *rim = thr_scratch_array(&own, nodes, sizeof *rim);
  thr_status st = thr_scratch_check(&own, err);

  for (int v = 0; v < frame->n_nodes && !st; v++)
    search.distance[v] = -1;
  if (!st) count_panels(&search);
  if (!st) st = mark_rim(frame, search.panels, rim, err);
  if (!st) memcpy(frame->foot, rim, nodes * sizeof *rim);

  thr_scratch_free(&own);
  return st;
}

/* ---- by words ---- */

bool thr_feet_is_word(const char *words)
{
  return strcmp(words, "lowest") == 0 || strcmp(words, "rim") == 0 ||
         strncmp(words, "below=", 6) == 0 || strncmp(words, "below ", 6) == 0;
}

/* Makes the nodes up to a height the feet. text: the height, with its unit or in the framework's.
 */
static thr_status feet_below(thr_frame *frame, const char *text, thr_err *err)
{
  double height;
  thr_err why = {0};
  const double lowest = lowest_of(frame);
  thr_status st = thr_quantity_read(text, frame->units, &height, &why);

  /* Nothing changes unless there is such a node. */
  if (!st && height < lowest)
    st = thr_fail(&why, THR_EINPUT, "the lowest node is at %g %s", lowest, frame->units);
  if (st) return thr_fail(err, st, "below %.40s: %s", text, why.text);

  mark_below(frame, height, frame->foot);
  return THR_OK;
}

thr_status thr_frame_feet_where(thr_frame *frame, const char *words, thr_err *err)
{
  if (strcmp(words, "rim") == 0) return feet_rim(frame, err);
  if (strncmp(words, "below", 5) == 0 && thr_feet_is_word(words))
    return feet_below(frame, words + 6, err);
  if (strcmp(words, "lowest") != 0)
    return thr_fail(err, THR_EINPUT, "%.40s: expected lowest, rim or below=HEIGHT", words);

  thr_frame_feet_lowest(frame);
  return THR_OK;
}
