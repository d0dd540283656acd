/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the blossom method share. */
#ifndef THR_BLOSSOM_PARTS_H
#define THR_BLOSSOM_PARTS_H

#include "graph/plan/plan.h"
#include "lp/matching/blossom.h"

/* ---- Inside of the matching engine: its state, and what its files call of each other.
 *
 * A blossom is an odd set of nodes: a node by itself (blossom v = node v) or a cycle of blossoms
 * joined by tight edges. Blossoms that are in no other are the top ones; they alone are matched,
 * labelled and changed. A dart is an edge in one direction: 2 * edge leaves edge[0], 2 * edge + 1
 * leaves edge[1]. All amounts are in halves of a weight. The moat of a node is the sum of the duals
 * of all blossoms round it; an edge between two top blossoms is tight when the moats of its ends
 * meet: their sum is twice its weight.
 *
 * Alternating trees grow in time from exposed blossoms: outer ones widen at speed 1, inner ones
 * shrink at speed 1, free ones (in no tree) rest. Nothing is touched as time passes: moat, dual and
 * offset are stored relative to it. */

typedef enum { FREE, OUTER, INNER } blossom_label;

/* One line of the cache. */
typedef struct {
  int64_t dual;   /* inner: time is to be taken away, outer: to be added */
  int64_t offset; /* of a top one, to be added to its nodes' moats; inner: and time taken away,
                     outer: and time added */
  blossom_label label;
  int match;       /* of a top one: matched dart that leaves it, or -1 */
  int parent;      /* the blossom that has it as a child, or -1 */
  int child;       /* one of its cycle; -1: a node */
  int size;        /* nodes in it; 0: not in use */
  int first, last; /* they are listed from first along their next to last */
  int root;        /* the node that stands for it in the disjoint sets of nodes */
  int tree;        /* outer, inner: number of the tree */
  union {
    int entry; /* of an inner one: the dart by which the tree came in */
    int mark;  /* of an outer one: the last walk that came by */
  };
  union {
    int next;  /* of a child: round the cycle */
    int after; /* outer, inner: in the list of the tree */
  };
  union {
    int link;   /* of a child: the dart to the next */
    int before; /* outer, inner: in the list of the tree */
  };
} blossom;

typedef struct {
  int64_t moat;
  int up;   /* the nodes of a top blossom are one disjoint set: another of them, nearer to its root;
               of the root: ~blossom */
  int next; /* in the list of nodes of each blossom round it */
} blossom_node;

typedef struct {
  int64_t weight; /* of the edge, in halves */
  int head, dart;
} blossom_arc;

/* What is due at a time: a dart to follow, tight then; or blossom ~dart: inner, to be expanded, or
 * exposed, to grow a tree. */
typedef struct {
  int64_t time;
  int dart;
} blossom_event;

enum { BLOSSOM_BUCKETS = 64 };

#define BLOSSOM_TOTAL_MOST                                                                         \
  (INT64_C(1) << 60) /* of all duals: so that no moat plus a gap plus a time passes 2^63 */

typedef struct {
  blossom_event *event;
  int count, capacity;
} blossom_bucket;

struct thr_matching_state {
  const thr_matching_problem *p;
  const thr_limits *limits;
  int n_nodes, n_edges;
  const int *tail; /* [2 * n_edges] node that a dart leaves */
  thr_scratch own; /* the arrays that stay as long as they are */
  int *first_arc;  /* [n_nodes + 1] */
  blossom_arc *arc;
  blossom_node *node;
  blossom *b; /* [n_nodes + n_nodes / 2] the nodes first */
  int *spare; /* [n_spare] blossoms not in use */
  int n_spare;
  int *tree;              /* [n_nodes] a blossom of each tree, or -1 */
  int n_planted, n_trees; /* trees so far in the search for all, and those that grow now */
  int64_t heaviest;       /* edge, in halves */
  int64_t total;          /* of all duals */
  int64_t time;
  int stamp; /* the last mark given */

  /* one tree grows, till end_time at most: when it meets an exposed blossom or itself, by end_dart
   * (-1: it will not) */
  bool half_integral;
  int64_t end_time;
  int end_dart;

  blossom_bucket bucket[BLOSSOM_BUCKETS]; /* see blossom_queue.c */
  int64_t queue_time; /* the clock of the queue: of the last event that was due */
  uint64_t filled;    /* bit k: bucket k is not empty */
  unsigned steps;
  thr_err *err;
  thr_status status; /* of the queues, which grow deep inside */
};

/* The top blossom round a node: the sets' union is by size (thr_blossom_shrink), so that opening a
 * blossom moves few nodes. */
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

/* ---- blossom_queue.c ---- */

/* Empties the queue and sets the clock to 0. */
void thr_blossom_reset(thr_matching_state *matching_state);

/* Events at matching_state->end_time or later are forgotten. Out of memory: matching_state->status.
 */
void thr_blossom_push(thr_matching_state *matching_state, int64_t time, int dart);

/* When the next event is due, at most matching_state->end_time; if that is before
 * matching_state->end_time, thr_blossom_pop takes it. */
int64_t thr_blossom_due(thr_matching_state *matching_state);
int thr_blossom_pop(thr_matching_state *matching_state);

/* ---- blossom_search.c ---- */

/* A half-integral matching on top of the start's duals: grows a tree from each exposed node in
 * turn, until it can be matched or closes an odd cycle, which becomes an exposed blossom with dual
 * 0. When another tree meets that, it is opened again. */
thr_status thr_blossom_match_halves(thr_matching_state *matching_state) THR_MUST_CHECK;

/* Grows trees from all exposed top blossoms at once until none is left. */
thr_status thr_blossom_match_all(thr_matching_state *matching_state) THR_MUST_CHECK;

/* ---- blossom_tree.c ---- */

/* A free top blossom becomes outer (not yet looking out; as many steps as it has nodes), or inner,
 * entered by a dart. */
void thr_blossom_make_outer(thr_matching_state *matching_state, int b, int tree);
void thr_blossom_make_inner(thr_matching_state *matching_state, int b, int tree, int dart);

/* Frees an outer or inner blossom, with dual and offset as they are now; and takes it out of the
 * list of its tree. */
void thr_blossom_settle(thr_matching_state *matching_state, int b);
void thr_blossom_leave(thr_matching_state *matching_state, int b);

/* Queues the darts that leave b, which is outer or has just become part of outer blossom top. */
void thr_blossom_look_out(thr_matching_state *matching_state, int b, int top);

/* Queues the darts that come from outer blossoms into b, which has just become free. */
void thr_blossom_look_back(thr_matching_state *matching_state, int b);

/* The free blossom that a dart leads to, and its mate, join the tree of the outer one that it
 * leaves. */
void thr_blossom_attach(thr_matching_state *matching_state, int dart);

/* Matches an outer blossom by a dart (-1: exposes it) and changes over all pairs from there to the
 * root. */
void thr_blossom_change_pairs(thr_matching_state *matching_state, int b, int dart);

/* ---- blossom_shrink.c ---- */

/* Makes one outer blossom of the cycle that a tight dart between two outer ones of a tree closes.
 * Children that were inner keep that label: their nodes have not looked out yet. */
int thr_blossom_shrink(thr_matching_state *matching_state, int dart);

/* Makes free top blossoms of the children of a free one with dual 0, matched as it is. */
void thr_blossom_open(thr_matching_state *matching_state, int b);

/* The same with an inner one: its children join the tree or become free. */
void thr_blossom_expand(thr_matching_state *matching_state, int b);

/* Pairs the other blossoms of base's cycle. */
void thr_blossom_match_children(thr_matching_state *matching_state, int base);

/* ---- blossom_start.c ---- */

/* Duals without blossoms that load no edge too much, and a matching along tight edges; near dual
 * and mate, [n_nodes] of another matching, where these are given. */
thr_status thr_blossom_start(thr_matching_state *matching_state, const int64_t *dual,
                             const int *mate) THR_MUST_CHECK;

/* Makes room for an edge that may be loaded too much: opens what blossoms it must, lowers the moat
 * of one end. O(depth and size of those blossoms). */
thr_status thr_blossom_make_room(thr_matching_state *matching_state, int edge) THR_MUST_CHECK;

/* Failures with their texts. */
thr_status thr_blossom_infeasible(const thr_matching_state *matching_state);
thr_status thr_blossom_too_large(const thr_matching_state *matching_state);

/* ---- candidates.c: Pairs of odd places that a lightest perfect matching may use, and the shortest
 * paths between them. */

enum {
  THR_HUB_DEGREE = 64
}; /* a place with so many arcs is a hub (lp/matching/hub.h): no search for the nearest goes on from
      it */

/* Places i and j of net->odd, and the weight of a way between them, not always a shortest one. */
typedef struct {
  int count, capacity;
  int (*end)[2];   /* owned; end[0] < end[1] */
  int64_t *weight; /* [capacity] owned */
} thr_pairs;

thr_status thr_pairs_add(thr_pairs *pairs, int i, int j, int64_t weight,
                         thr_err *err) THR_MUST_CHECK;
void thr_pairs_destroy(thr_pairs *pairs);

/* Sorts the pairs from `from` on by their ends, n_odd = number of places, and keeps the lightest of
 * those with the same ends. O(pairs + n_odd). */
thr_status thr_pairs_tidy(thr_pairs *pairs, int from, int n_odd, thr_err *err) THR_MUST_CHECK;

/* Which odd place reaches a place first if all grow at the same speed, each from a depth of its own
 * (an additively weighted Voronoi diagram). */
typedef struct {
  int64_t *depth; /* [n_places] of its root, less twice the way from there; owned */
  int *root;  /* [n_places] position in net->odd, or -1: not reached; an odd place counts as its own
                 unless another one reaches  it at greater depth; owned */
  int *order; /* [n_reached] places reached above the floor, deepest first; owned */
  int n_reached;
} thr_flood;

/* Depths in halves of a weight. start[n_odd]: of the odd places; places at or below the floor are
 * not reached and keep it as depth (INT64_MIN: all are reached). O(m log m). Release with
 * thr_flood_destroy. */
thr_status thr_flood_run(const thr_network *net, const int64_t *start, int64_t floor,
                         thr_flood *flood, thr_err *err) THR_MUST_CHECK;
void thr_flood_destroy(thr_flood *flood);

/* Candidates to begin with: of every odd place the nearest others; those whose Voronoi cells touch;
 * and pairs along a lightest spanning tree of these, which make a perfect matching (on a connected
 * graph). reach[n_odd] receives how far the nearest of each go, in halves of a weight (INT64_MAX:
 * there are few). THR_ELIMIT: pairs holds those whose cells touch and those along the tree, and so
 * the nearest of every odd place. Near-linear. */
thr_status thr_candidates_find(const thr_network *net, const thr_limits *limits, thr_pairs *pairs,
                               int64_t *reach, thr_err *err) THR_MUST_CHECK;

/* Pairs over a hub, a place with very many arcs, such as the one that stands for outside where cord
 * ends are allowed at every node: any two odd places that reach it can be paired over it, too many
 * pairs to list. Internal to lp/.
 *
 * A pair over the hub weighs d(u) + d(v), where d is the distance to the hub. Listed are the pairs
 * along two random circuits through all places whose moats reach so far; pricing asks again until
 * the moats pay for every pair.
 *
 * Example: four places a, b, c, d give ab, bc, cd, da in one circuit, of the six pairs that there
 * are. */
typedef struct {
  int count, n_odd;
  int64_t *way; /* [count * n_odd] weight of the shortest way from a hub to an odd place; owned */
} thr_hubs;

/* The places with most arcs, if they have many; few of them. O(m log m) each. Release with
 * thr_hubs_destroy. */
thr_status thr_hubs_find(const thr_network *net, thr_hubs *hubs, thr_err *err) THR_MUST_CHECK;
void thr_hubs_destroy(thr_hubs *hubs);

/* Adds pairs over each hub between odd places whose reach[n_odd] (halves of a weight) comes so far:
 * along two random rounds through all of them. Such a graph expands: moats that are too wide on one
 * side of it and too narrow on the other are worth less than even ones, so a few calls settle what
 * all pairs together demand. O(count * n_odd). */
thr_status thr_hubs_pairs(const thr_hubs *hubs, const int64_t *reach, uint64_t *random,
                          thr_pairs *pairs, thr_err *err) THR_MUST_CHECK;

/* ---- nest.c: The duals of a matching as nested moats: every odd place, and every blossom, is a
 * set with a moat of some width round it. */

/* Sets 0 .. n_odd - 1 are the odd places, then come the blossoms, children before parents. Widths
 * and depths in halves of a weight. A place's depth is the total width of the moats that it lies
 * inside of. */
typedef struct {
  int n_odd, n_sets;
  thr_scratch own; /* the arrays */
  int *parent;     /* [n_sets] the set right around, or -1 */
  int *jump;       /* [n_sets] some set around it that makes searches outwards logarithmic, or -1 */
  int *level;      /* [n_sets] number of sets around it */
  int64_t *width;  /* [n_sets] >= 0 */
  int64_t *outer;  /* [n_sets] depth just outside of its moat */
} thr_nest;

/* Negative widths, which no moat can have, are made 0: what place i lacks is taken from the moats
 * between it and its mate k, those around i first, from the inside outwards, then those around k
 * from the outside inwards. That spoils no pair (i, j) unless the duals were too large for (j, k)
 * by way of i already, the way over i being at least as long as the shortest. raised[n_odd]
 * receives what was changed. O(n_sets + the sets passed). */
thr_status thr_nest_init(thr_nest *nest, int n_odd, const thr_matching *matching, bool *raised,
                         thr_err *err) THR_MUST_CHECK;

/* Every odd place alone, with these widths. */
thr_status thr_nest_of_balls(thr_nest *nest, int n_odd, const int64_t *width,
                             thr_err *err) THR_MUST_CHECK;
void thr_nest_destroy(thr_nest *nest);

/* Depth of the innermost set that holds both odd places, inside its moat; 0 if there is none. O(log
 * n_sets). */
int64_t thr_nest_shared_depth(const thr_nest *nest, int i, int j);

/* start[n_odd]: depth of every odd place. */
void thr_nest_depths(const thr_nest *nest, int64_t *start);

/* The moats as odd cuts of the problem's nodes, in units of 1 / THR_DUAL_DENOMINATOR, from the
 * flood that starts at the odd places' depths with floor 0: a forest (thr_cut.parent) in which
 * every node is named once. O(nodes + cuts). On failure nothing is allocated. */
thr_status thr_nest_cuts(const thr_nest *nest, const thr_network *net, const thr_flood *flood,
                         thr_cut **cut, int *n_cuts, int64_t *sum, thr_err *err) THR_MUST_CHECK;

#endif
