/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulated annealing of several cords, which makes the largest length, or the largest sum of
 * turns, of a cord small.
 *
 * Read anneal.c first: the runs, the temperatures and which changes are taken. Then anneal_walks.c:
 * the walks, what is known of them, and how a change is made. anneal_exchange.c and anneal_route.c
 * propose the changes: exchanges, which keep all passes, and routes, which do not. */
#ifndef THR_ANNEAL_H
#define THR_ANNEAL_H

#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/arrays.h"
#include "graph/threading/threading.h"

#include <stdint.h>

/* ---- walk_price.c: Computes what one cord counts for, by length, turning or pull. */

/* Returns the price of the turns of a cord, its pulled turning, or its length, as measure says; the
 * second one the number of the cord with the largest price, the first of equals. */
double thr_walk_price(const thr_turning_columns *columns, thr_walk_measure measure,
                      const thr_cord *cord);
int thr_walk_dearest(const thr_turning_columns *columns, thr_walk_measure measure,
                     const thr_cord *cord, int n_cords);

/* Return the summands of thr_walk_price: what the pass after number k adds, for k = -1 .. n - 1,
 * and this n. */
double thr_walk_pass_price(const thr_turning_columns *columns, thr_walk_measure measure,
                           const thr_cord *cord, int k);
int thr_walk_priced_passes(const thr_turning_columns *columns, thr_walk_measure measure,
                           const thr_cord *cord);

/* ---- anneal.c: Cords evened out by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P.
 * Vecchi 1983) that changes their passes, too. */

typedef struct {
  thr_walk_measure measure;
  int steps;         /* of a run at most: changes at random */
  int first, rounds; /* number of the first round, whose random numbers are others than those of the
                        rounds before; and how many */
  bool alone;        /* one run in a round instead of two: this thread has no other beside it */
  bool near; /* of turnings: every second run stays near the best cords, again and again, where the
                others forget them */
  double enough; /* largest price or length that need not become less */
} thr_anneal_task;

/* Lowers the largest price of the turns of n_cords cords, or their largest length, and replaces
 * them where it falls, as long as it is above enough: in rounds of two runs each from the best so
 * far (alone: of one; of lengths every second run begins hotter), until all rounds are done, or
 * several in turn were in vain, or the limits' time is up. Where
 * ends are counted at nodes they stay; with tube joints every node stays tied. Every edge keeps the
 * passes that the columns ask for, and has no more than they allow. *better: whether it fell. A
 * change that is not taken takes time that does not depend on the framework, one that is O(passes
 * of two cords). */
thr_status thr_anneal(const thr_turning_columns *columns, const thr_anneal_task *task,
                      const thr_limits *limits, thr_cord *cord, int n_cords, bool *better,
                      thr_err *err) THR_MUST_CHECK;

/* ---- The walks that are annealed, and changes of them. Internal to anneal*.c. */

/* A cord. An open one visits the nodes between its passes, number i ahead of pass i, for i = 1 .. n
 * - 1; a closed one also ahead of pass 0. */
typedef struct {
  int n, room, *half, *slot; /* [room]; slot: of visit i, in the list of its node */
  double *sum; /* [room] price as far as into pass i; of a closed one from pass 0 on */
  double total;
} thr_anneal_walk;

typedef struct {
  int cord, at;
} thr_anneal_visit;

/* A change of one cord or two, put together from sections of what there is and of new passes. */
typedef struct {
  int n_cords, cord[2];
  double total[2]; /* what the cords turn by afterwards */
  int n[2];        /* passes of each in made */
  bool keeps;      /* every edge keeps its passes */
} thr_anneal_change;

typedef struct {
  const thr_turning_columns *c;
  thr_walk_measure measure;
  bool closed;
  bool fixed;      /* open cords end where they do, as ends are counted at nodes */
  bool tube;       /* the turns tie the edges of every node together */
  thr_scratch own; /* all but the walks' arrays */
  int n_cords;
  thr_anneal_walk *walk; /* [n_cords] */
  int *pair_first;       /* [n_nodes] of the prices of the turns at a node */
  double *price; /* [sum of the squares of the degrees] by the numbers of both half-edges at their
                    node */
  int *tied;     /* tube: [2 * n_edges] half-edges of a node */
  int *turns; /* tube: [as price] how often cords turn from one of these half-edges to the other */
  double *end_price; /* [n_edges] of a cord end; lengths are half those of the passes before and
                        after a turn */
  double noise;      /* of the prices of a route */
  int *visit_first;  /* [n_nodes] of a node's visits */
  int *n_visits;     /* [n_nodes] */
  thr_anneal_visit *visit;  /* as many as there may be passes */
  int *passes;              /* [n_edges] */
  int *count;               /* [n_edges] zeros: passes of what is looked at */
  double extra, most_extra; /* length of the passes beyond the covers, and how much it may be */
  double *to_end; /* [2 * n_edges] open: least price of the turns from a half-edge to an end; */
  int *next;      /* [2 * n_edges] the half-edge after it on that way, -1: it ends there */
  int room;       /* of made, for each cord */
  int *made[2];   /* what a change makes of its cords */
  int *route, n_route; /* [room] new passes */
  double *reached;     /* [2 * n_edges] searches for routes */
  int *before, *hops, *stamp, *queue, search;
  uint64_t state; /* of the random numbers */
} thr_annealer;

/* Returns the price of a turn from half-edge in to half-edge out; THR_FORBIDDEN: such a turn is not
 * allowed. */
static inline double thr_anneal_turn(const thr_annealer *annealer, int in, int out)
{
  const thr_turning_columns *c = annealer->c;
  const int v = c->f->edge[out >> 1][out & 1];
  const int degree = c->f->first[v + 1] - c->f->first[v];
  return annealer->price[annealer->pair_first[v] + c->position[in ^ 1] * degree + c->position[out]];
}

/* Copies the cords as walks into an annealer. The state of the random numbers becomes 1. On failure
 * the annealer is to be destroyed too. O(passes + turns). */
thr_status thr_annealer_init(thr_annealer *annealer, const thr_turning_columns *columns,
                             thr_walk_measure measure, const thr_cord *cord, int n_cords,
                             thr_err *err) THR_MUST_CHECK;
void thr_annealer_destroy(thr_annealer *annealer);

/* Makes a change, unless edges would no longer keep to their covers and limits, or tube joints
 * would no longer be tied. O(passes of its cords, and the squares of the degrees where turns go).
 */
thr_status thr_anneal_make(thr_annealer *annealer, const thr_anneal_change *change,
                           thr_err *err) THR_MUST_CHECK;

/* Appends the passes from .. end - 1 of half[], turned round if backwards, to what is made of a
 * change's cord i. */
void thr_anneal_put(thr_annealer *annealer, thr_anneal_change *change, int i, const int *half,
                    int from, int end, bool backwards);

/* Computes the price of the passes that are made for cord i of a change; THR_FORBIDDEN or more:
 * they have a turn that is not allowed. O(passes). */
double thr_anneal_total(const thr_annealer *annealer, const thr_anneal_change *change, int i);

/* Returns whether every edge keeps its cover without the passes from .. end - 1 of a cord. */
bool thr_anneal_spare(thr_annealer *annealer, const thr_anneal_walk *walk, int from, int end);

/* An exchange of sections whose totals are known from running sums; thr_anneal_build puts the walks
 * together if the exchange is taken. */
typedef struct {
  thr_anneal_change change;
  enum { THR_ANNEAL_TAILS, THR_ANNEAL_REVERSE, THR_ANNEAL_LOOP, THR_ANNEAL_MIDDLES } kind;
  int i, i2, j, j2, m; /* places on both cords; of a loop, where it is entered */
  bool turned;         /* the part of the second cord, or the loop, runs backwards */
} thr_anneal_exchange;

/* Each proposes a change of cord number `cord` and returns whether there is one. All but
 * thr_anneal_exchanges have put the walks together when they return. */
bool thr_anneal_exchanges(thr_annealer *annealer, int cord, thr_anneal_exchange *exchange);
void thr_anneal_build(thr_annealer *annealer, thr_anneal_exchange *exchange);
bool thr_anneal_drop_loop(thr_annealer *annealer, int cord, thr_anneal_change *change);
bool thr_anneal_end_elsewhere(thr_annealer *annealer, int cord, thr_anneal_change *change);
bool thr_anneal_reroute(thr_annealer *annealer, int cord, thr_anneal_change *change);

/* Returns a visit to a node, drawn from all of them; cord -1: there is none. */
thr_anneal_visit thr_anneal_visit_at(thr_annealer *annealer, int node);

/* Makes one run of a task, with random numbers of its own. Of lengths odd ones begin hotter, and
 * pass over more of what is good to get there; of turnings even ones stay near the best cords if
 * the task says so. */
thr_status thr_anneal_run(const thr_turning_columns *columns, const thr_anneal_task *task,
                          int number, const thr_limits *limits, thr_cord *cord, int n_cords,
                          bool *better, thr_err *err) THR_MUST_CHECK;

#endif
