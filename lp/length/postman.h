/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shortest passes over all edges (route inspection, the Chinese postman), and the cords that
 * they are cut into.
 *
 * Read postman.c first: the shortest passes, by minimum T-joins, with certificates; postman_plan.c
 * makes a plan of one cord of them. Then cords.c: plans of several cords. Its parts are
 * decomposition.c (cutting open cords, evening out), decomposition_places.c (room for their ends),
 * decomposition_circuits.c, decomposition_chord.c and decomposition_tied.c (closed cords),
 * decomposition_table.c (small frameworks, exactly) and decomposition_prices.c (lower bounds).
 * cut_tour.c makes cords of limited length without a search. */
#ifndef THR_POSTMAN_H
#define THR_POSTMAN_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/threading.h"
#include "lp/matching/blossom.h"
#include "lp/tjoin/tjoin.h"

/* ---- postman.c: Route Inspection: the shortest cord that covers a framework (thesis, chapter 5
 * "Length"; Edmonds & Johnson 1973). */

/* Passes of the shortest cords that cover a framework, at most options.cords of them in every
 * component, before anything runs through them. */
typedef struct {
  int *passes; /* [n_edges] owned; only where a cord may end are they odd in number */
  int n_certificates;
  thr_certificate *certificate; /* one per component; owned */
  double length;                /* of these passes, in units */
  double lower_bound;           /* of the passes of any such cords */
  bool optimal;                 /* these are the shortest */
  thr_confirmations confirmed;  /* if the options ask for them */
} thr_shortest;

/* What optimal and lower_bound say is what graph/check/check.c verifies, never what the solver
 * hopes. THR_OK: optimal. THR_ELIMIT: out is valid and holds its bound. THR_EINFEASIBLE: a
 * component has no node where a cord end is allowed, or given ends that are no cords', or an edge
 * has no room (named). Otherwise out is empty. */
thr_status thr_postman_shortest(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, thr_shortest *out,
                                thr_err *err) THR_MUST_CHECK;
void thr_shortest_destroy(thr_shortest *shortest);

/* One cord per component through passes that leave at most two nodes of it with an odd number,
 * paired for little turning (graph/threading/tour.c). cord is allocated, [*n_cords] with their half
 * arrays, for the caller; NULL on failure. Near-linear in passes.
 */
thr_status thr_postman_cords(const thr_frame *frame, const thr_request *options, const int *passes,
                             thr_cord **cord, int *n_cords, thr_err *err) THR_MUST_CHECK;

/* What the certificates of shortest, which are moved, prove of these cords for the same framework
 * and options: fills proof with them, each join being that of the cords, and with what
 * graph/check/check.c says. On failure (THR_ENOMEM, or THR_ESOLVER for cords that do not pass the
 * check) proof can still be released. */
thr_status thr_postman_prove(const thr_frame *frame, const thr_request *options,
                             const thr_cord *cord, int n_cords, thr_shortest *shortest,
                             thr_length_proof *proof, thr_err *err) THR_MUST_CHECK;

/* Makes a plan: one shortest cord per component of the framework, its certificates, metrics and
 * proof. The options' end_node is copied. The proof is what graph/check/check.c verifies, never
 * what the solver hopes. THR_OK: optimal. THR_ELIMIT: plan is valid and holds its bound and gap.
 * THR_EINFEASIBLE: a component has no node where a cord end is allowed (named). THR_EINPUT: more
 * than one cord per component. Otherwise the plan is empty. */
thr_status thr_postman_plan(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* ---- shortest_paths.c: Shortest paths from some nodes of a framework (Dijkstra), where there is
 * room for a cord. */

typedef struct {
  const thr_frame *f;
  double unit;     /* lengths in these steps order the queue */
  double *far;     /* [n_nodes] owned; INFINITY: not reached */
  int *over;       /* [n_nodes] owned; half-edge by which the path comes there, -1 at a start */
  thr_queue queue; /* entry is owned */
} thr_paths;

thr_status thr_paths_init(thr_paths *paths, const thr_frame *frame, thr_err *err) THR_MUST_CHECK;
void thr_paths_destroy(thr_paths *paths);

/* Removes all starts and paths. */
void thr_paths_clear(thr_paths *paths);
thr_status thr_paths_start(thr_paths *paths, int v, thr_err *err) THR_MUST_CHECK;

/* Computes the shortest paths from the starts, over edges whose capacity leaves room for so many
 * passes beyond passes[n_edges] (NULL: over all), no further than most. O(m log m).
 */
thr_status thr_paths_spread(thr_paths *paths, const thr_request *options, const int *passes,
                            int room, double most, thr_err *err) THR_MUST_CHECK;

/* The half-edges of the shortest path to v, walked back from v to node `to` on it (-1: to its
 * start), into half (NULL: they are only counted); returns how many. */
int thr_paths_back(const thr_paths *paths, int v, int to, int *half);

/* The half-edges of the shortest path to v, from its start on, into half[n_nodes]; returns how
 * many. */
int thr_paths_to(const thr_paths *paths, int v, int *half);

/* ---- decomposition.c: How the passes of a component are shared out among several cords
 * (docs/method.md). */

/* Cords on the way, of a framework of one component. */
typedef struct {
  const thr_frame *f;   /* these three are borrowed */
  const thr_request *o; /* covers, capacities, joint, ends */
  const thr_limits *limits;
  thr_walks walks; /* cyclic with THR_ENDS_CLOSED, else open */
  int *passes;     /* [n_edges] of these walks, or for walks to come; owned */
  bool least;      /* the passes are the shortest that hold the cords */
  bool certain;    /* the longest cord is as short as can be: the solver's word */
  bool asked;      /* options.max_length: the table was, for any number of cords */
  bool none;       /* and there are none */
} thr_decomposition;

/* No walks yet, and no passes. On failure it is to be destroyed too. */
thr_status thr_decomposition_init(thr_decomposition *decomposition, const thr_frame *frame,
                                  const thr_request *options, const thr_limits *limits,
                                  thr_err *err) THR_MUST_CHECK;
void thr_decomposition_destroy(thr_decomposition *decomposition);

/* Makes room for the ends of n cords: where the passes, the shortest, leave too few places for
 * them, they are replaced by the shortest ones of all that do not, as one perfect matching (Edmonds
 * & Johnson's reduction of degree constraints). certificate gives the weights. THR_EINFEASIBLE: no
 * passes within the capacities have as many (says where). THR_ELIMIT: stopped, or too large a
 * matching; then passes are as before. */
thr_status thr_decomposition_places(thr_decomposition *decomposition, int n,
                                    const thr_certificate *certificate,
                                    thr_err *err) THR_MUST_CHECK;

/* Cuts the walks (thr_walks_trace) into n cords, or as many more as must be: at the sharpest turns
 * where cords may end, or, even = true, so that no cord is much longer than the others. With
 * THR_ENDS_COUNTS the counts say how many. THR_EINFEASIBLE: there are fewer places
 * (thr_decomposition_places makes room for as many as are asked for). */
thr_status thr_decomposition_cut(thr_decomposition *decomposition, int n, bool even,
                                 thr_err *err) THR_MUST_CHECK;

/* The same with THR_ENDS_CLOSED: n closed walks. *enough false: these passes do not hold as many,
 * or so many were not found; there are then as many walks as were. */
thr_status thr_decomposition_circuits(thr_decomposition *decomposition, int n, bool even,
                                      bool *enough, thr_err *err) THR_MUST_CHECK;

/* Splits closed walks at nodes that one visits twice, without further passes, until there are n or
 * none can be: where that turns least, or, even = true, the longest in halves. ties: those of the
 * walks, which stay tied; or NULL. */
thr_status thr_decomposition_split(thr_decomposition *decomposition, int n, bool even,
                                   thr_junction_graphs *ties, thr_err *err) THR_MUST_CHECK;

/* The same for tube joints, with further passes where it must be: n closed walks that tie what the
 * walks, few of them, tie. even: from options.cords_least on no more than make the longest shorter.
 * *found false: the capacities leave no room for as many as must be among those that were looked
 * for; there are then as many as there was room for. */
thr_status thr_decomposition_tied(thr_decomposition *decomposition, int n, bool even, bool *found,
                                  thr_err *err) THR_MUST_CHECK;

/* What thr_decomposition_circuits did not find: pairs of passes over the shortest edges, until
 * there are n closed walks. *found false: the capacities leave no room. */
thr_status thr_decomposition_more(thr_decomposition *decomposition, int n, bool *found,
                                  thr_err *err) THR_MUST_CHECK;

/* Splits the longest closed walk, again and again, into two that both pass a path between two of
 * its nodes, or if that is no good into one for each of its edges, until there are n or none gets
 * shorter by it. O(n * passes of a walk * edges around it). */
thr_status thr_decomposition_chords(thr_decomposition *decomposition, int n,
                                    thr_err *err) THR_MUST_CHECK;

/* Closed walk i becomes two, its passes from .. end - 1 and the others, which both pass the path
 * path[n] between their ends: from the node before pass number from to that before number end.
 * ties: of the walks, or NULL. */
thr_status thr_decomposition_chord(thr_decomposition *decomposition, int i, int from, int end,
                                   const int *path, int n, thr_junction_graphs *ties,
                                   thr_err *err) THR_MUST_CHECK;

/* Makes the longest walk as short as annealing does it (graph/threading/anneal.c) and, where the
 * framework is small, as the table knows it. goal > 0: until none is longer than this, with the
 * fewest cords from then on. */
thr_status thr_decomposition_even(thr_decomposition *decomposition, double goal,
                                  thr_err *err) THR_MUST_CHECK;

static inline bool thr_decomposition_within(double length, double limit)
{
  return length <= limit * (1 + 1e-12);
}

/* ---- cords.c: The shortest plan with any number of cords: passes (lp/length/postman.h), shared
 * out among cords (lp/length/decomposition.c); for a length limit with more
 * and more cords until none is longer. */

/* What is known beyond what graph/check/check.c can verify, for the one who asked. */
typedef struct {
  bool passes_least;  /* these passes are the shortest that hold the cords: found by an exact method
                         whose proof is not recorded */
  bool longest_least; /* balance: with as many cords, no longest cord is shorter: the word of an
                         integer programme */
} thr_cords_word;

/* Plans options.cords_least .. options.cords cords (with THR_ENDS_COUNTS, as many as the counts
 * say) in a framework of one component, or one cord in each of several:
 * - usually the shortest passes of all, and the fewest cords through them, cut where they turn
 * most;
 * - balance: the longest cord is made as short as the search finds, extra passes included;
 * - max_length: the fewest cords none of which is longer, as far as the search finds them.
 * word may be NULL. THR_OK: what was asked to be least is proved to be. THR_ELIMIT: the plan is
 * valid and says its bounds. An empty plan, too: none was found. THR_EINFEASIBLE: there is none
 * (says why). Otherwise the plan is empty. */
thr_status thr_cords_plan(const thr_frame *frame, const thr_request *options,
                          const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                          thr_err *err) THR_MUST_CHECK;

/* ---- shared with tube joints, and with frameworks of several components (planner/length.c) ----
 */

/* THR_EINFEASIBLE, said: an edge that no cord within options.max_length can pass, coming from where
 * it may end and going where it may end. */
thr_status thr_cords_reach(const thr_frame *frame, const thr_request *options,
                           thr_err *err) THR_MUST_CHECK;

/* For a limit on the length: tries n cords, from the fewest that cords of this length together
 * leave possible up to options.cords, in larger steps after some, until *done. THR_EINFEASIBLE as
 * above. */
typedef thr_status thr_cords_try(thr_decomposition *decomposition, void *with, int n, bool *done,
                                 thr_err *err);
thr_status thr_cords_grow(thr_decomposition *decomposition, double length,
                          thr_cords_try *try_number, void *with, bool *done,
                          thr_err *err) THR_MUST_CHECK;

/* Is what was asked to be least proved to be, by the plan's claims? Else THR_ELIMIT, and how far it
 * may be off; unproved: what is to be said before that, if anything. */
thr_status thr_cords_judge(const thr_plan *plan, const thr_err *unproved,
                           thr_err *err) THR_MUST_CHECK;

/* ---- cut_tour.c: Cords of limited length at once: what there is before a search has found any. */

/* A thr_component_cords: one tour through a framework of one component, each edge an even number of
 * times, cut into sections; each is a cord together with the shortest paths from and to places
 * where cords may end, or back to its start, and none is longer than options.max_length (G. N.
 * Frederickson, M. S. Hecht & C. E. Kim, "Approximation algorithms for some routing problems", SIAM
 * J. Comput. 7, 1978). Capacities are not looked at, nor are passes. *n_cords = 0: not by this way,
 * which proves nothing. cord[*n_cords] is the caller's. Near-linear in passes for open cords; for
 * closed ones the paths from the start of each are looked for. */
thr_status thr_cut_tour(const thr_frame *frame, const thr_request *options, const int *passes,
                        thr_cord **cord, int *n_cords, thr_err *err) THR_MUST_CHECK;

/* ---- decomposition_table.c: The cords of a small framework by a table over subsets
 * (graph/threading/small_cords.c): exact. */

/* What is asked of the cords. */
typedef struct {
  int least, most; /* so many */
  bool even;       /* the longest as short as can be; then, and without it, little length in all */
  double limit;    /* of each cord, INFINITY = none: then the fewest */
} thr_decomposition_ask;

/* Puts such cords in place of the walks where those are worse, or are none: the options' ends,
 * covers, capacities, joint. Walks and passes become the best known; *certain: nothing is better,
 * or there is nothing (they are then as they were). Frameworks that are too large, and what the
 * limits stop, leave them as they are. */
thr_status thr_decomposition_table(thr_decomposition *decomposition,
                                   const thr_decomposition_ask *ask, bool *certain,
                                   thr_err *err) THR_MUST_CHECK;

#endif
