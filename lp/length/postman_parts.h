/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of lp/length/ share when they cut passes into cords of even lengths. */
#ifndef THR_POSTMAN_PARTS_H
#define THR_POSTMAN_PARTS_H

#include "lp/length/postman.h"

/* ---- balance.c: Evening out the cords: exchanges until the longest cannot be made shorter (D. Ahr
 * & G. Reinelt, "A tabu search algorithm for the min-max k-Chinese postman problem", Computers &
 * Operations Research 33, 2006, for closed tours from one depot; here cords end where they may, and
 * share nodes). */

/* Cords on the way; all arrays are owned by whoever fills it. */
typedef struct {
  thr_decomposition *s;
  thr_junction_graphs
      *ties;       /* tube joints: of these walks, which every change leaves tied; else NULL */
  double goal;     /* shorter than this the longest need not be */
  uint64_t random; /* state */
  int64_t steps, budget; /* left; what a search may cost that does not get the longest walk down */
  int *first;            /* [n_nodes] -1 between uses */
  int *stamp,
      stamps;  /* [n_nodes] the last walk that was there of those stamped, by its number; so many */
  int room;    /* of merged */
  int *merged; /* [passes of the two walks] of an exchange between cyclic walks */
  int *path;   /* [n_nodes] of a detour */
} thr_balance;

/* Exchanges until no walk is longer than goal, none helps, or the limits stop it. Passes change
 * where cords take detours. With tube joints the walks tie all nodes before and after. Work in
 * proportion to passes, some thousand times as much, from every exchange on. The same input gives
 * the same walks. Failure (THR_ENOMEM) leaves valid walks. */
thr_status thr_balance_walks(thr_decomposition *decomposition, double goal,
                             thr_err *err) THR_MUST_CHECK;

/* ---- internal to lp/balance*.c ---- */

/* How two walks exchange passes at a node where both are. */
typedef enum {
  THR_BALANCE_NONE,
  THR_BALANCE_TAILS,
  THR_BALANCE_CROSS,
  THR_BALANCE_GIVE,
  THR_BALANCE_JOIN,
  THR_BALANCE_SECTION
} thr_balance_kind;

typedef struct {
  thr_balance_kind kind;
  double longer; /* length of the longer of the two afterwards; INFINITY: no exchange */
  int i, j, k;   /* positions, see balance_exchange.c */
} thr_balance_exchange;

enum {
  THR_MOST_VISITS = 32
}; /* of a node, that each of its visits is compared with: hubs are not quadratic */

/* The exchange between two walks that leaves them most equal. */
thr_status thr_balance_find(thr_balance *balance, int p, int q, thr_balance_exchange *best,
                            thr_err *err) THR_MUST_CHECK;

/* Makes it: right after it was found. */
thr_status thr_balance_make(thr_balance *balance, int p, int q, const thr_balance_exchange *x,
                            thr_err *err) THR_MUST_CHECK;

/* Turns round random closed sections of a walk: its passes and ends stay, their order changes. */
thr_status thr_balance_shuffle(thr_balance *balance, int p, thr_err *err) THR_MUST_CHECK;

/* Walk p gives a section to walk q, which gets there over extra passes, if that leaves both shorter
 * than below. */
thr_status thr_balance_detour(thr_balance *balance, int p, int q, double below, bool *made,
                              thr_err *err) THR_MUST_CHECK;

/* ---- decomposition_prices.c: Proof that cords need as many passes as they have beyond a shortest
 * join, by prices of places (graph/plan/plan_measures.h). */

/* Where certificate, found without prices, proves less than these passes need for so many cords,
 * looks for prices that prove more: the bound is a concave function of the price, found between
 * prices of too few and of too many places, each by a minimum T-join. With ends free that closes
 * the gap (places are one degree constraint; Edmonds & Johnson 1973); with closed cords it need
 * not. certificate then has the best found. What the limits stop, or is too large, leaves
 * certificate as it is or better. About 10 T-joins. */
thr_status thr_decomposition_prices(const thr_decomposition *decomposition, int cords,
                                    thr_certificate *certificate, thr_err *err) THR_MUST_CHECK;

#endif
