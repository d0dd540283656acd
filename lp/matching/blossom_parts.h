/* Inside of the matching engine: its state, and what its files call of each other.
 *
 * A blossom is an odd set of nodes: a node by itself (blossom v = node v) or a cycle of blossoms joined by tight edges. Blossoms
 * that are in no other are the top ones; they alone are matched, labelled and changed. A dart is an edge in one direction:
 * 2 * edge leaves edge[0], 2 * edge + 1 leaves edge[1]. All amounts are in halves of a weight. The moat of a node is the sum of
 * the duals of all blossoms round it; an edge between two top blossoms is tight when the moats of its ends meet: their sum is
 * twice its weight.
 *
 * Alternating trees grow in time from exposed blossoms: outer ones widen at speed 1, inner ones shrink at speed 1, free ones (in
 * no tree) rest. Nothing is touched as time passes: moat, dual and offset are stored relative to it. */
#ifndef THR_BLOSSOM_PARTS_H
#define THR_BLOSSOM_PARTS_H

#include "graph/limits.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/matching/blossom.h"

typedef enum { FREE, OUTER, INNER } blossom_label;

/* One line of the cache. */
typedef struct {
  int64_t dual;   /* inner: time is to be taken away, outer: to be added */
  int64_t offset; /* of a top one, to be added to its nodes' moats; inner: and time taken away, outer: and time added */
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
  int up;   /* the nodes of a top blossom are one disjoint set: another of them, nearer to its root; of the root: ~blossom */
  int next; /* in the list of nodes of each blossom round it */
} blossom_node;

typedef struct {
  int64_t weight; /* of the edge, in halves */
  int head, dart;
} blossom_arc;

/* What is due at a time: a dart to follow, tight then; or blossom ~dart: inner, to be expanded, or exposed, to grow a tree. */
typedef struct {
  int64_t time;
  int dart;
} blossom_event;

enum { BLOSSOM_BUCKETS = 64 };

#define BLOSSOM_TOTAL_MOST (INT64_C(1) << 60) /* of all duals: so that no moat plus a gap plus a time passes 2^63 */

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

  /* one tree grows, till end_time at most: when it meets an exposed blossom or itself, by end_dart (-1: it will not) */
  bool half_integral;
  int64_t end_time;
  int end_dart;

  blossom_bucket bucket[BLOSSOM_BUCKETS]; /* see blossom_queue.c */
  int64_t queue_time;                     /* the clock of the queue: of the last event that was due */
  uint64_t filled;                        /* bit k: bucket k is not empty */
  unsigned steps;
  thr_err *err;
  thr_status status; /* of the queues, which grow deep inside */
};

/* The top blossom round a node: the sets' union is by size (thr_blossom_shrink), so that opening a blossom moves few nodes. */
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

/* Events at matching_state->end_time or later are forgotten. Out of memory: matching_state->status. */
void thr_blossom_push(thr_matching_state *matching_state, int64_t time, int dart);

/* When the next event is due, at most matching_state->end_time; if that is before matching_state->end_time, thr_blossom_pop takes
 * it. */
int64_t thr_blossom_due(thr_matching_state *matching_state);
int thr_blossom_pop(thr_matching_state *matching_state);

/* ---- blossom_search.c ---- */

/* A half-integral matching on top of the start's duals: grows a tree from each exposed node in turn, until it can be matched or
 * closes an odd cycle, which becomes an exposed blossom with dual 0. When another tree meets that, it is opened again. */
thr_status thr_blossom_match_halves(thr_matching_state *matching_state) THR_MUST_CHECK;

/* Grows trees from all exposed top blossoms at once until none is left. */
thr_status thr_blossom_match_all(thr_matching_state *matching_state) THR_MUST_CHECK;

/* ---- blossom_tree.c ---- */

/* A free top blossom becomes outer (not yet looking out; as many steps as it has nodes), or inner, entered by a dart. */
void thr_blossom_make_outer(thr_matching_state *matching_state, int b, int tree);
void thr_blossom_make_inner(thr_matching_state *matching_state, int b, int tree, int dart);

/* Frees an outer or inner blossom, with dual and offset as they are now; and takes it out of the list of its tree. */
void thr_blossom_settle(thr_matching_state *matching_state, int b);
void thr_blossom_leave(thr_matching_state *matching_state, int b);

/* Queues the darts that leave b, which is outer or has just become part of outer blossom top. */
void thr_blossom_look_out(thr_matching_state *matching_state, int b, int top);

/* Queues the darts that come from outer blossoms into b, which has just become free. */
void thr_blossom_look_back(thr_matching_state *matching_state, int b);

/* The free blossom that a dart leads to, and its mate, join the tree of the outer one that it leaves. */
void thr_blossom_attach(thr_matching_state *matching_state, int dart);

/* Matches an outer blossom by a dart (-1: exposes it) and changes over all pairs from there to the root. */
void thr_blossom_change_pairs(thr_matching_state *matching_state, int b, int dart);

/* ---- blossom_shrink.c ---- */

/* Makes one outer blossom of the cycle that a tight dart between two outer ones of a tree closes. Children that were inner keep
 * that label: their nodes have not looked out yet. */
int thr_blossom_shrink(thr_matching_state *matching_state, int dart);

/* Makes free top blossoms of the children of a free one with dual 0, matched as it is. */
void thr_blossom_open(thr_matching_state *matching_state, int b);

/* The same with an inner one: its children join the tree or become free. */
void thr_blossom_expand(thr_matching_state *matching_state, int b);

/* Pairs the other blossoms of base's cycle. */
void thr_blossom_match_children(thr_matching_state *matching_state, int base);

/* ---- blossom_start.c ---- */

/* Duals without blossoms that load no edge too much, and a matching along tight edges; near dual and mate, [n_nodes] of another
 * matching, where these are given. */
thr_status thr_blossom_start(thr_matching_state *matching_state, const int64_t *dual, const int *mate) THR_MUST_CHECK;

/* Makes room for an edge that may be loaded too much: opens what blossoms it must, lowers the moat of one end. O(depth and size
 * of those blossoms). */
thr_status thr_blossom_make_room(thr_matching_state *matching_state, int edge) THR_MUST_CHECK;

/* Failures with their texts. */
thr_status thr_blossom_infeasible(const thr_matching_state *matching_state);
thr_status thr_blossom_too_large(const thr_matching_state *matching_state);

#endif
