/* Tube joints (graph/plan/junction.h) in the programme of a symmetric cover: at every node the turns, as edges between its tubes,
 * connect them all. Internal.
 *
 * A symmetric threading ties all nodes of an orbit or none, so one node stands for each: its star. A turn column joins, there,
 * every two tubes that one of its turns goes between. Where it is not known which (symmetry/cover/contraction.h), its turns are
 * only counted: between b blocks of tubes there are b - 1. */
#ifndef THR_TIES_H
#define THR_TIES_H

#include "graph/status.h"
#include "symmetry/group/quotient.h"

typedef struct {
  int n;          /* stars: orbits of nodes with several tubes */
  int *node;      /* [n] lowest node of the orbit */
  int *degree;    /* [n] */
  int *nodes;     /* [n] in the orbit */
  int *star;      /* [n_darts] of a dart type; -1 = its node has one tube */
  int *first;     /* [n + 1] turn columns of star i: pair[first[i]] .. pair[first[i + 1] - 1], as pair types */
  int *pair;      /* [n_pairs] */
  int *turns;     /* [n_pairs] turns at the star's node in one orbit of turns */
  int *join;      /* [n_pairs + 1] pair type y joins tubes link[join[y]] .. link[join[y + 1] - 1], by place at the node */
  int (*link)[2]; /* distinct; of a pair type that is only counted none */
  int most;       /* largest degree */
} thr_ties;

/* node_orbit: [n_nodes] the lowest node of each node's orbit. O(order * (pair types * degree + nodes)). */
thr_status thr_ties_init(thr_ties *ties, const thr_quotient *quotient, const int *node_orbit, thr_err *err) THR_MUST_CHECK;
void thr_ties_destroy(thr_ties *ties);

/* Of a contraction quotient: pair type y of the whole becomes pair[y] (-1: none), whose links are known if keep[y]; node_orbit as
 * above.
 */
thr_status thr_ties_contract(thr_ties *ties, const thr_ties *whole, int whole_pairs, const thr_quotient *quotient,
                             const int *node_orbit, const int *pair, const bool *keep, thr_err *err) THR_MUST_CHECK;

/* Blocks of a star's tubes that known turns join of which there are more than `least`; value[n_pairs]: of the pair types.
 * block[degree] receives 0 .. blocks - 1. Returns their number. */
int thr_ties_blocks(const thr_ties *ties, int star, const double *value, double least, int *block);

/* Turns in one orbit of pair type y that go between different blocks; all that are only counted. */
int thr_ties_between(const thr_ties *ties, int y, const int *block);

/* Is the star tied by whole numbers of turns, as far as is known? parent: [ties->most] scratch. */
bool thr_ties_tied(const thr_ties *ties, int star, const int *value, int *parent);

#endif
