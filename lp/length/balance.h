/* Evening out the cords: exchanges until the longest cannot be made shorter (D. Ahr & G. Reinelt, "A tabu search
 * algorithm for the min-max k-Chinese postman problem", Computers & Operations Research 33, 2006, for closed tours from one
 * depot; here cords end where they may, and share nodes).
 *
 * Minimize the longest of K cords; no plan is below the total divided by K, or the least cord that passes any one edge.
 *
 * Example: cords of 3 and 9 that share a node exchange their tails and become 6 and 6. */
#ifndef THR_BALANCE_H
#define THR_BALANCE_H

#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/walks.h"
#include "lp/length/decomposition.h"

/* Cords on the way; all arrays are owned by whoever fills it. */
typedef struct {
  thr_decomposition *s;
  thr_junction_graphs *ties; /* tube joints: of these walks, which every change leaves tied; else NULL */
  double goal;               /* shorter than this the longest need not be */
  uint64_t random;           /* state */
  int64_t steps, budget;     /* left; what a search may cost that does not get the longest walk down */
  int *first;                /* [n_nodes] -1 between uses */
  int *stamp, stamps;        /* [n_nodes] the last walk that was there of those stamped, by its number; so many */
  int room;                  /* of merged */
  int *merged;               /* [passes of the two walks] of an exchange between cyclic walks */
  int *path;                 /* [n_nodes] of a detour */
} thr_balance;

/* Exchanges until no walk is longer than goal, none helps, or the limits stop it. Passes change
 * where cords take detours. With tube joints the walks tie all nodes before and after. Work in proportion
 * to passes, some thousand times as much, from every exchange on. The same input gives the same walks. Failure (THR_ENOMEM)
 * leaves valid walks. */
thr_status thr_balance_walks(thr_decomposition *decomposition, double goal, thr_err *err) THR_MUST_CHECK;

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

enum { THR_MOST_VISITS = 32 }; /* of a node, that each of its visits is compared with: hubs are not quadratic */

/* The exchange between two walks that leaves them most equal. */
thr_status thr_balance_find(thr_balance *balance, int p, int q, thr_balance_exchange *best, thr_err *err) THR_MUST_CHECK;

/* Makes it: right after it was found. */
thr_status thr_balance_make(thr_balance *balance, int p, int q, const thr_balance_exchange *x, thr_err *err) THR_MUST_CHECK;

/* Turns round random closed sections of a walk: its passes and ends stay, their order changes. */
thr_status thr_balance_shuffle(thr_balance *balance, int p, thr_err *err) THR_MUST_CHECK;

/* Walk p gives a section to walk q, which gets there over extra passes, if that leaves both shorter than below. */
thr_status thr_balance_detour(thr_balance *balance, int p, int q, double below, bool *made, thr_err *err) THR_MUST_CHECK;

#endif
