/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures how what is threaded holds together while it is being threaded. A loose chain is the
 * pieces that the cord picks up one after the other until it comes to a piece that is on a cord
 * already: so long is what swings. The piece that a cord begins with holds the cord, and is not
 * counted.
 *
 * A piece is a node with solid joints, and an edge with tube joints. A cord is threaded from its
 * start with one needle; or from its fold, near the middle, with two needles: first with the right
 * one to the end, then with the left one back to the start. Each needle draws through about half of
 * the cord then.
 *
 * Example: a cord through pieces 1 2 3 4 2 of which 4 is on a cord already: the loose chain 2 3,
 * which is 2 pieces long; then 2 is met again. */
#include "graph/plan/plan_measures.h"

#include <stdlib.h>

int thr_chains_compare(thr_chains a, thr_chains b)
{
  if (a.longest != b.longest) return a.longest < b.longest ? -1 : 1;
  return (a.squares > b.squares) - (a.squares < b.squares);
}

thr_chains thr_chains_together(thr_chains a, thr_chains b)
{
  return (thr_chains){a.longest > b.longest ? a.longest : b.longest, a.squares + b.squares};
}

thr_chains thr_chains_of(const int *chain, int n)
{
  thr_chains all = {0};
  for (int i = 0; i < n; i++)
    all = thr_chains_together(all, (thr_chains){chain[i], (int64_t)chain[i] * chain[i]});
  return all;
}

bool thr_cord_folded(int needles, const thr_cord *cord)
{
  return needles == 0 ? cord->closed && cord->n_passes >= THR_FOLD_LONG
                      : needles == 2 && cord->n_passes >= THR_FOLD_LEAST;
}

/* From the fold on, what is left is at most half of the cord. */
int thr_cord_fold(const thr_frame *frame, int needles, const thr_cord *cord)
{
  if (!thr_cord_folded(needles, cord)) return 0;
  const double whole = thr_cord_length(frame, cord) * (1 - THR_FOLD_ROUNDING);
  int k = 1;
  double here = frame->length[cord->half[0] >> 1], next = here + frame->length[cord->half[1] >> 1];

  /* here and next: where pass k begins, and where pass k + 1 does; twice their mean is compared
   * with the whole. */
  while (here + next < whole) {
    k++;
    here = next;
    next += frame->length[cord->half[k] >> 1];
  }

  return k;
}

/* ---- pieces ---- */

int thr_chains_pieces(const thr_frame *frame, thr_joint joint)
{
  return joint == THR_JOINT_TUBE ? frame->n_edges : frame->n_nodes;
}

int thr_cord_pieces(const thr_frame *frame, thr_joint joint, const thr_cord *cord, int *piece)
{
  int n = cord->n_passes;

  /* Before each pass a node, and one after the last; or the edges themselves. */
  for (int k = 0; k < n; k++)
    piece[k] = joint == THR_JOINT_TUBE ? cord->half[k] >> 1 : thr_tail(frame, cord->half[k]);

  if (joint == THR_JOINT_SOLID) piece[n++] = thr_cord_end(frame, cord);
  return n;
}

thr_status thr_threaded_init(thr_threaded *threaded, const thr_frame *frame, thr_joint joint,
                             thr_err *err)
{
  *threaded = (thr_threaded){
      .on = thr_calloc((size_t)thr_chains_pieces(frame, joint), sizeof *threaded->on)};
  return threaded->on ? THR_OK : thr_nomem(err);
}

void thr_threaded_destroy(thr_threaded *threaded)
{
  free(threaded->on);
  *threaded = (thr_threaded){0};
}

void thr_threaded_keep(thr_threaded *threaded, const int *piece, int n)
{
  for (int i = 0; i < n; i++)
    threaded->on[piece[i]] = THR_KEPT;
}

/* Puts a piece on the cord of the present trial; returns whether the piece was on a cord
 * already. */
static inline bool thread_piece(thr_threaded *threaded, int piece)
{
  int *on = &threaded->on[piece];
  if (*on == THR_KEPT || *on == threaded->trial) return true;
  *on = threaded->trial;
  return false;
}

/* Threads the pieces from .. end, without end, upwards or downwards. Appends the lengths of the
 * loose chains to chain, and returns their number. */
static int thread_row(thr_threaded *threaded, const int *piece, int from, int end, int *chain,
                      int chains)
{
  int loose = 0, step = from < end ? 1 : -1;

  /* A piece that is on a cord already ends the chain before it. */
  for (int k = from; k != end; k += step) {
    if (!thread_piece(threaded, piece[k])) {
      loose++;
    } else if (loose) {
      chain[chains++] = loose;
      loose = 0;
    }
  }

  /* The last chain ends with the cord. */
  if (loose) chain[chains++] = loose;
  return chains;
}

int thr_threaded_try(thr_threaded *threaded, const int *piece, int n, int fold, int *chain)
{
  /* The first piece holds the cord; from there one needle, then the other. */
  threaded->trial++;
  thread_piece(threaded, piece[fold]);
  int chains = thread_row(threaded, piece, fold + 1, n, chain, 0);
  return thread_row(threaded, piece, fold - 1, -1, chain, chains);
}

/* ---- plans ---- */

/* Lists each path, followed by its copies. */
void thr_plan_work(const thr_plan *plan, int *order)
{
  int n = 0;

  for (int path = 0; path < plan->n_cords; path++) {
    /* Without symmetry every cord is a path of its own. */
    const int *unique = plan->symmetry.present ? plan->symmetry.unique : NULL;
    if (unique && unique[path] != path) continue;
    order[n++] = path;
    for (int c = 0; unique && c < plan->n_cords; c++)
      if (c != path && unique[c] == path) order[n++] = c;
  }
}

/* Threads the plan's cords in their order of work, and adds up the loose chains: the longest one,
 * and the sum of squares of their lengths, which prefers many short ones. */
thr_status thr_plan_chains(const thr_plan *plan, int needles, thr_chains *chains, thr_err *err)
{
  thr_threaded threaded = {0};
  int most = 0;
  *chains = (thr_chains){0};

  /* The longest cord tells how much space is needed. */
  for (int c = 0; c < plan->n_cords; c++)
    most = plan->cord[c].n_passes > most ? plan->cord[c].n_passes : most;

  /* Space for the pieces of one cord. */
  int *order = thr_calloc((size_t)plan->n_cords + 1, sizeof *order),
      *piece = thr_calloc((size_t)most + 1, sizeof *piece),
      *chain = thr_calloc((size_t)most + 1, sizeof *chain);
  thr_status st = order && piece && chain
                      ? thr_threaded_init(&threaded, &plan->frame, plan->options.joint, err)
                      : thr_nomem(err);
  if (!st) thr_plan_work(plan, order);

  /* Cord after cord, as they are threaded; each one stays. */
  for (int i = 0; i < plan->n_cords && !st; i++) {
    const thr_cord *cord = &plan->cord[order[i]];
    int n = thr_cord_pieces(&plan->frame, plan->options.joint, cord, piece);
    int fold = thr_cord_fold(&plan->frame, needles, cord);
    *chains = thr_chains_together(
        *chains, thr_chains_of(chain, thr_threaded_try(&threaded, piece, n, fold, chain)));
    thr_threaded_keep(&threaded, piece, n);
  }

  thr_threaded_destroy(&threaded);
  free(order);
  free(piece);
  free(chain);

  return st;
}
