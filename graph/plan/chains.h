/* How what is threaded holds together while it is threaded. A loose chain is what the cord picks up, piece after piece, until it
 * comes to a piece that is on a cord already: so long it swings. The piece that a cord begins with holds it, and is not counted.
 *
 * A piece is a node with solid joints, and an edge with tube joints. A cord is threaded from its start with one needle; or from
 * its fold, near the middle, with two: with the right one first, to the end, then with the left one back to the start. Each
 * needle draws through about half of the cord then. */
#ifndef THR_CHAINS_H
#define THR_CHAINS_H

#include "graph/plan/plan.h"

typedef struct {
  int longest;     /* pieces */
  int64_t squares; /* sum over all loose chains */
} thr_chains;

/* -1, 0 or 1: a shorter longest chain comes before smaller squares. */
int thr_chains_compare(thr_chains a, thr_chains b);

/* Of the work one part after the other. */
thr_chains thr_chains_together(thr_chains a, thr_chains b);

/* Passes: shorter cords are threaded from their end, with two needles too; closed cords from THR_FOLD_LONG on, two steps of the
 * booklet, with two needles if nothing else is said: each draws through half as much cord, half as often. */
enum { THR_FOLD_LEAST = 24, THR_FOLD_LONG = 48 };
static const double THR_FOLD_ROUNDING = 1e-9; /* of the length of a cord: so much nearer to its middle is no nearer */

/* Is it threaded from its fold? needles: 1, 2, or 0: as is usual. */
bool thr_cord_folded(int needles, const thr_cord *cord);

/* The pass that the right needle begins with: that at whose start the way along the cord is nearest to half of it, of two the
 * earlier; 0 of a cord that is not folded. O(passes). */
int thr_cord_fold(const thr_frame *frame, int needles, const thr_cord *cord);

/* Pieces in the order of the passes: n_passes with tube joints, one more with solid ones. item: that many. */
int thr_cord_pieces(const thr_frame *frame, thr_joint joint, const thr_cord *cord, int *piece);

/* Pieces that are on cords. {0} is empty. */
typedef struct {
  int *on;   /* [pieces] on a cord that was kept, on that of the present trial, or neither; owned */
  int trial; /* >= 1 */
} thr_threaded;

enum { THR_KEPT = -1 };

thr_status thr_threaded_init(thr_threaded *threaded, const thr_frame *frame, thr_joint joint, thr_err *err) THR_MUST_CHECK;
void thr_threaded_destroy(thr_threaded *threaded);

/* Pieces that a framework has, and whether piece is on a cord that was kept. */
int thr_chains_pieces(const thr_frame *frame, thr_joint joint);
static inline bool thr_threaded_kept(const thr_threaded *threaded, int piece)
{
  return threaded->on[piece] == THR_KEPT;
}

/* Threads the pieces piece[n] from number fold on, then those before it backwards, as a trial: chain[n] receives the lengths of
 * the loose chains, whose number is returned. O(n). */
int thr_threaded_try(thr_threaded *threaded, const int *piece, int n, int fold, int *chain);

/* The pieces stay. */
void thr_threaded_keep(thr_threaded *threaded, const int *piece, int n);

thr_chains thr_chains_of(const int *chain, int n);

/* The order in which cords are threaded: as they are numbered, but the copies of a path right after it. order: [n_cords]. */
void thr_plan_work(const thr_plan *plan, int *order);

/* The loose chains of a plan threaded with so many needles (thr_cord_folded). O(passes). */
thr_status thr_plan_chains(const thr_plan *plan, int needles, thr_chains *chains, thr_err *err) THR_MUST_CHECK;

#endif
