/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of lp/matching share among each other: the state of the blossom method, candidate
 * pairs, hubs, and nested moats. */
#ifndef THR_BLOSSOM_PARTS_H
#define THR_BLOSSOM_PARTS_H

#include "graph/plan/plan.h"
#include "lp/matching/blossom.h"

/* ---- the state of the blossom method
 *
 * A blossom is an odd set of nodes: a node by itself (blossom v = node v) or a cycle of blossoms
 * joined by tight edges. Blossoms that are in no other are the top ones; they alone are matched,
 * labelled and changed. A dart is an edge in one direction: 2 * edge leaves edge[0], 2 * edge + 1
 * leaves edge[1]. All amounts are in halves of a weight. The moat of a node is the sum of the duals
 * of all blossoms round the node; an edge between two top blossoms is tight when the moats of its
 * ends meet: their sum is twice the weight of the edge.
 *
 * Alternating trees grow in time from exposed blossoms: outer ones widen at speed 1, inner ones
 * shrink at speed 1, free ones (in no tree) rest. Nothing is updated as time passes: moat, dual and
 * offset are stored relative to the time. */

typedef enum { FREE, OUTER, INNER } blossom_label;

/* A blossom; one line of the processor's cache. */
typedef struct {
  int64_t dual;   /* of an inner one: less the time; of an outer one: plus the time */
  int64_t offset; /* of a top one, to be added to the moats of its nodes; likewise less or plus the
                     time */
  blossom_label label;
  int match;       /* of a top one: matched dart that leaves the blossom, or -1 */
  int parent;      /* the blossom whose child this one is, or -1 */
  int child;       /* one blossom of the cycle; -1: a node */
  int size;        /* number of nodes; 0: not in use */
  int first, last; /* the nodes are a list by next, from first to last */
  int root;        /* representative of the nodes in the disjoint sets of nodes */
  int tree;        /* of an outer or inner one: number of the tree */
  union {
    int entry; /* of an inner one: the dart by which the tree came in */
    int mark;  /* of an outer one: stamp of the last search for a common blossom that passed */
  };
  union {
    int next;  /* of a child: the next one in the cycle */
    int after; /* of an outer or inner one: the next one in the list of the tree */
  };
  union {
    int link;   /* of a child: the dart to the next one */
    int before; /* of an outer or inner one: the one before in the list of the tree */
  };
} blossom;

/* A node as a member of the blossoms round it. */
typedef struct {
  int64_t moat;
  int up;   /* the nodes of a top blossom are one disjoint set: a node nearer to the representative;
               of the representative: ~blossom */
  int next; /* the next node in the lists of all blossoms round the node */
} blossom_node;

/* A dart in the list of the node that it leaves. */
typedef struct {
  int64_t weight; /* of the edge, in halves */
  int head, dart;
} blossom_arc;

/* What is due at a time: a dart to be followed, which is tight then; or ~b for a blossom b to be
 * expanded if inner, and made the root of a tree if exposed. */
typedef struct {
  int64_t time;
  int dart;
} blossom_event;

enum { BLOSSOM_BUCKETS = 64 };

/* The most that all duals together may be: no moat plus a gap plus a time passes 2^63 then. */
#define BLOSSOM_TOTAL_MOST (INT64_C(1) << 60)

typedef struct {
  blossom_event *event;
  int count, capacity;
} blossom_bucket;

struct thr_matching_state {
  const thr_matching_problem *p;
  const thr_limits *limits;
  int n_nodes, n_edges;
  const int *tail; /* [2 * n_edges] node that a dart leaves */
  thr_scratch own; /* the arrays that do not depend on the number of edges */
  int *first_arc;  /* [n_nodes + 1] */
  blossom_arc *arc;
  blossom_node *node;
  blossom *b; /* [n_nodes + n_nodes / 2] the nodes first */
  int *spare; /* [n_spare] blossoms not in use */
  int n_spare;
  int *tree;        /* [n_nodes] the first blossom in the list of each tree, or -1 */
  int n_planted;    /* number of trees so far in the search with all trees */
  int n_trees;      /* number of trees that grow now */
  int64_t heaviest; /* the greatest weight of an edge, in halves */
  int64_t total;    /* of all duals */
  int64_t time;
  int stamp; /* the last one given to marks */

  /* While one tree grows for the half-integral matching: the time when the tree meets an exposed
   * blossom or itself, and the dart that gets tight then (-1: none is known). */
  bool half_integral;
  int64_t end_time;
  int end_dart;

  blossom_bucket bucket[BLOSSOM_BUCKETS]; /* see blossom_queue.c */
  int64_t queue_time;                     /* the clock of the queue: when the last event was due */
  uint64_t filled;                        /* bit k: bucket k is not empty */
  unsigned steps;                         /* number of times that the clock was moved */
  thr_err *err;
  thr_status status; /* of the queue, where memory may run out in functions without a status */
};

/* Returns the top blossom round a node, and shortens the way there for the next time (path
 * halving). Sets are united by size (thr_blossom_shrink), so that opening a blossom moves few
 * nodes. */
static inline int top_of_node(thr_matching_state *matching_state, int v)
{
  blossom_node *node = matching_state->node;
  for (int up; (up = node[v].up) >= 0;) {
    if (node[up].up < 0) return ~node[up].up;
    v = node[v].up = node[up].up;
  }
  return ~node[v].up;
}

static inline bool is_top(const thr_matching_state *matching_state, int b)
{
  return matching_state->b[b].parent < 0;
}

/* ---- blossom_queue.c: events by time ---- */

/* Empties the queue and sets the clock to 0. */
void thr_blossom_reset(thr_matching_state *matching_state);

/* Queues an event. Events at matching_state->end_time or later are dropped. Out of memory:
 * matching_state->status. */
void thr_blossom_push(thr_matching_state *matching_state, int64_t time, int dart);

/* Returns when the next event is due, or matching_state->end_time if none is due before. In the
 * first case thr_blossom_pop takes the event, a dart or ~blossom. */
int64_t thr_blossom_due(thr_matching_state *matching_state);
int thr_blossom_pop(thr_matching_state *matching_state);

/* ---- blossom_search.c: the searches ---- */

/* Computes a half-integral matching on top of the start's duals: grows a tree from each exposed
 * node in turn, until the node can be matched or the tree closes an odd cycle, which becomes an
 * exposed blossom with dual 0. When another tree meets such a blossom, it is opened again. */
thr_status thr_blossom_match_halves(thr_matching_state *matching_state) THR_MUST_CHECK;

/* Computes the perfect matching: grows trees from all exposed top blossoms at the same time. */
thr_status thr_blossom_match_all(thr_matching_state *matching_state) THR_MUST_CHECK;

/* ---- blossom_tree.c: alternating trees ---- */

/* Makes a free top blossom outer, without queueing the darts that leave it, in as many steps as the
 * blossom has nodes; or inner, entered by a dart. */
void thr_blossom_make_outer(thr_matching_state *matching_state, int b, int tree);
void thr_blossom_make_inner(thr_matching_state *matching_state, int b, int tree, int dart);

/* Frees an outer or inner blossom, with dual and offset as they are now; thr_blossom_leave takes
 * the blossom out of the list of its tree, too. */
void thr_blossom_settle(thr_matching_state *matching_state, int b);
void thr_blossom_leave(thr_matching_state *matching_state, int b);

/* Queues the darts that leave b, which is outer or has just become a child of the outer blossom
 * top. */
void thr_blossom_look_out(thr_matching_state *matching_state, int b, int top);

/* Queues the darts that come from outer blossoms into b, which has just become free. */
void thr_blossom_look_back(thr_matching_state *matching_state, int b);

/* Adds the free blossom that a dart leads to, and its mate, to the tree of the outer blossom that
 * the dart leaves. */
void thr_blossom_attach(thr_matching_state *matching_state, int dart);

/* Matches an outer blossom by a dart (-1: exposes the blossom) and exchanges matched and unmatched
 * edges on the path from there to the root. */
void thr_blossom_change_pairs(thr_matching_state *matching_state, int b, int dart);

/* ---- blossom_shrink.c: odd cycles to blossoms and back ---- */

/* Shrinks the cycle that a tight dart between two outer blossoms of one tree closes to an outer
 * blossom, and returns this one. Children that were inner keep this label: the darts that leave
 * their nodes have not been queued yet. */
int thr_blossom_shrink(thr_matching_state *matching_state, int dart);

/* Replaces a free blossom with dual 0 by its children as free top blossoms, matched as the cycle
 * and the blossom's mate say. */
void thr_blossom_open(thr_matching_state *matching_state, int b);

/* Replaces an inner blossom with dual 0 by its children, which join the tree or become free. */
void thr_blossom_expand(thr_matching_state *matching_state, int b);

/* Matches all children of a cycle but base in pairs. */
void thr_blossom_match_children(thr_matching_state *matching_state, int base);

/* ---- blossom_start.c: the start of the searches ---- */

/* Computes duals without blossoms that overload no edge, and a matching along tight edges; if dual
 * and mate are given, [n_nodes] of another matching, close to these. */
thr_status thr_blossom_start(thr_matching_state *matching_state, const int64_t *dual,
                             const int *mate) THR_MUST_CHECK;

/* Lowers duals until an edge is not overloaded any more: opens blossoms round one end as far as
 * needed, and lowers the moat of this end. O(depth and size of these blossoms). */
thr_status thr_blossom_make_room(thr_matching_state *matching_state, int edge) THR_MUST_CHECK;

/* Record a failure and its text. */
thr_status thr_blossom_infeasible(const thr_matching_state *matching_state);
thr_status thr_blossom_too_large(const thr_matching_state *matching_state);

/* ---- candidates.c: candidate pairs of odd places for a minimum-weight perfect matching ---- */

/* A place with so many arcs is a hub (hub.c): no search for near places goes on from there. */
enum { THR_HUB_DEGREE = 64 };

/* Pairs of places i and j in net->odd, with the weight of a path between them, not always the
 * shortest. */
typedef struct {
  int count, capacity;
  int (*end)[2];   /* owned; end[0] < end[1] */
  int64_t *weight; /* [capacity] owned */
} thr_pairs;

/* Appends a pair. */
thr_status thr_pairs_add(thr_pairs *pairs, int i, int j, int64_t weight,
                         thr_err *err) THR_MUST_CHECK;
void thr_pairs_destroy(thr_pairs *pairs);

/* Sorts the pairs from number `from` on by their ends, and keeps the lightest of several with the
 * same ends. n_odd: number of odd places. O(pairs + n_odd). */
thr_status thr_pairs_tidy(thr_pairs *pairs, int from, int n_odd, thr_err *err) THR_MUST_CHECK;

/* An additively weighted Voronoi diagram: which odd place reaches a place first if all of them grow
 * at the same speed, each from a depth of its own. */
typedef struct {
  int64_t *depth; /* [n_places] depth of the root, less twice the length of the path from there;
                     owned */
  int *root;      /* [n_places] position of the odd place in net->odd, or -1: not reached; an odd
                     place is its own root unless another one reaches it at greater depth; owned */
  int *order;     /* [n_reached] places reached above the floor, deepest first; owned */
  int n_reached;
} thr_flood;

/* Computes the diagram. Depths are in halves of a weight. start[n_odd]: depths of the odd places.
 * Places at or below the floor are not reached and keep the floor as depth (INT64_MIN: all places
 * are reached). O(m log m). Release with thr_flood_destroy. */
thr_status thr_flood_run(const thr_network *net, const int64_t *start, int64_t floor,
                         thr_flood *flood, thr_err *err) THR_MUST_CHECK;
void thr_flood_destroy(thr_flood *flood);

/* Finds the first candidates: for every odd place the nearest others; every two whose Voronoi cells
 * touch; and pairs along a minimum spanning tree of these, which contain a perfect matching (on a
 * connected graph). reach[n_odd] receives the distance of the last of the nearest, in halves of a
 * weight (INT64_MAX: there are few). THR_ELIMIT: pairs holds those whose cells touch and those
 * along the tree, and so the nearest of every odd place. Near-linear. */
thr_status thr_candidates_find(const thr_network *net, const thr_limits *limits, thr_pairs *pairs,
                               int64_t *reach, thr_err *err) THR_MUST_CHECK;

/* ---- hub.c: pairs over hubs ---- */

/* The distances from hubs. A hub is a place with very many arcs, such as the one that stands for
 * the outside where cord ends are allowed at every node. Any two odd places near a hub can be
 * paired over the hub, which makes too many pairs to list. Such a pair weighs d(u) + d(v), where d
 * is the distance from the hub. Listed are the pairs along two random circuits through all places
 * whose moats reach the hub; pricing asks for further ones until no pair is violated.
 *
 * Example: four places a, b, c, d give ab, bc, cd, da in one circuit, of the six pairs that there
 * are. */
typedef struct {
  int count, n_odd;
  int64_t *way; /* [count * n_odd] length of the shortest path from a hub to an odd place; owned */
} thr_hubs;

/* Finds the few places with most arcs, if they have many, and computes the distances from each. O(m
 * log m) per hub. Release with thr_hubs_destroy. */
thr_status thr_hubs_find(const thr_network *net, thr_hubs *hubs, thr_err *err) THR_MUST_CHECK;
void thr_hubs_destroy(thr_hubs *hubs);

/* Adds pairs over each hub of the odd places whose reach[n_odd] (in halves of a weight) comes as
 * far as the hub: along two random circuits through all of them. Such a graph is an expander: moats
 * that are too wide on one side and too narrow on the other have a smaller sum than even ones, so
 * that a few calls settle what all pairs together demand. O(count * n_odd). */
thr_status thr_hubs_pairs(const thr_hubs *hubs, const int64_t *reach, uint64_t *random,
                          thr_pairs *pairs, thr_err *err) THR_MUST_CHECK;

/* ---- nest.c: the duals of a matching as nested moats ---- */

/* Sets 0 .. n_odd - 1 are the odd places, then come the blossoms, children before parents. Widths
 * and depths are in halves of a weight. The depth of a place is the total width of the moats that
 * the place lies inside of. */
typedef struct {
  int n_odd, n_sets;
  thr_scratch own; /* the arrays */
  int *parent;     /* [n_sets] the smallest set round the set, or -1 */
  int *jump;       /* [n_sets] some set round the set that makes searches outwards logarithmic, or
                      -1 */
  int *level;      /* [n_sets] number of sets round the set */
  int64_t *width;  /* [n_sets] >= 0 */
  int64_t *outer;  /* [n_sets] depth just outside of the set's moat */
} thr_nest;

/* Makes a nest of the duals of a matching. Negative widths, which no moat can have, become 0: what
 * place i lacks is taken from the moats between i and its mate k, those round i first, from the
 * inside outwards, then those round k from the outside inwards. This makes no pair (i, j) violated
 * unless the duals were too large for (j, k) on the path over i already, which is at least as long
 * as the shortest one. raised[n_odd] receives which places had a negative width. O(n_sets + the
 * sets passed). */
thr_status thr_nest_init(thr_nest *nest, int n_odd, const thr_matching *matching, bool *raised,
                         thr_err *err) THR_MUST_CHECK;

/* Makes a nest of single odd places with these widths. */
thr_status thr_nest_of_balls(thr_nest *nest, int n_odd, const int64_t *width,
                             thr_err *err) THR_MUST_CHECK;
void thr_nest_destroy(thr_nest *nest);

/* Returns the depth inside the moat of the innermost set that holds both odd places, or 0 if there
 * is none. O(log n_sets). */
int64_t thr_nest_shared_depth(const thr_nest *nest, int i, int j);

/* Fills start[n_odd] with the depths of the odd places. */
void thr_nest_depths(const thr_nest *nest, int64_t *start);

/* Turns the moats into odd cuts of the problem's nodes, with values in units of 1 /
 * THR_DUAL_DENOMINATOR. flood must start at the depths of the odd places and have floor 0. The cuts
 * are a forest (thr_cut.parent) in which every node is named once at most. O(nodes + cuts). On
 * failure nothing is allocated. */
thr_status thr_nest_cuts(const thr_nest *nest, const thr_network *net, const thr_flood *flood,
                         thr_cut **cut, int *n_cuts, int64_t *sum, thr_err *err) THR_MUST_CHECK;

#endif
