/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every start of a closed cord: how loose what is threaded is from there, and how hard the cord is
 * to pull. Private to planner/.
 *
 * A window that moves round a closed cord, and the pieces in it that are on the cord when they are
 * come to. */
#include "graph/plan/physics.h"
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>

/* Place p of the cord, gone round twice, is that of pass p (mod n): the window first .. last holds
 * the pieces from one start. Marked are those that are on a cord when the needle comes to them, the
 * fold, and the places before and behind the window: between two marks next to each other is a
 * loose chain. */
typedef struct {
  int n;                 /* passes */
  int first, fold, last; /* places */
  int *piece;            /* [n] owned */
  int *next,
      *before; /* [n] places to the next and to the last visit of the piece, going round; owned */
  int *left,
      *right; /* [2 n + 2] from place -1: the marks next to a mark, left NONE of no mark; owned */
  double *along; /* [2 n + 1] cord before the place; owned */
  int *count;    /* [2 n + 2] chains of each length; owned */
  thr_chains chains;
  const thr_threaded *threaded;
} window;

enum { NONE = -2 };

static void window_destroy(window *w)
{
  free(w->piece);
  free(w->next);
  free(w->before);
  free(w->left);
  free(w->right);
  free(w->along);
  free(w->count);
}

static bool is_marked(const window *w, int p)
{
  return w->left[p + 1] != NONE;
}

static bool is_on(const window *w, int p)
{
  int k = p % w->n;
  if (p == w->fold || thr_threaded_kept(w->threaded, w->piece[k])) return true;
  return p > w->fold ? p - w->before[k] >= w->fold : p + w->next[k] <= w->last;
}

static void count_chain(window *w, int from, int to, int change)
{
  int loose = to - from - 1;
  if (loose <= 0) return;
  w->count[loose] += change;
  w->chains.squares += change * (int64_t)loose * loose;
  if (loose > w->chains.longest) w->chains.longest = loose;
  while (w->chains.longest > 0 && w->count[w->chains.longest] == 0)
    w->chains.longest--;
}

static void link_marks(window *w, int a, int b)
{
  w->right[a + 1] = b;
  w->left[b + 1] = a;
}

/* Marks p, between left and the next mark. */
static void mark(window *w, int p, int left)
{
  int right = w->right[left + 1];
  count_chain(w, left, right, -1);
  count_chain(w, left, p, 1);
  count_chain(w, p, right, 1);
  link_marks(w, left, p);
  link_marks(w, p, right);
}

static void unmark(window *w, int p)
{
  int left = w->left[p + 1], right = w->right[p + 1];
  count_chain(w, left, p, -1);
  count_chain(w, p, right, -1);
  count_chain(w, left, right, 1);
  link_marks(w, left, right);
  w->left[p + 1] = NONE;
}

static int mark_before(const window *w, int p)
{
  while (!is_marked(w, --p)) {
  }
  return p;
}

/* ---- moving on ---- */

/* The fold moves on by a place. Its piece is the left needle's now, and is not on the cord where
 * the right one comes by again. */
static void move_fold(window *w)
{
  int old = w->fold++, again = old + w->next[old % w->n];
  if (!is_marked(w, w->fold)) mark(w, w->fold, old);
  if (!is_on(w, old)) unmark(w, old);
  if (again <= w->last && is_marked(w, again) && !is_on(w, again)) unmark(w, again);
}

/* The window moves on by a place; the fold is in it before and afterwards. */
static void move_window(window *w)
{
  int last = ++w->last, earlier = last - w->before[last % w->n];
  w->right[last + 1] = w->left[last + 2] = NONE;
  link_marks(w, last, last + 1);
  if (!is_on(w, last)) unmark(w, last);
  if (earlier > w->first && earlier < w->fold && !is_marked(w, earlier))
    mark(w, earlier, mark_before(w, earlier));
  int outside = w->first - 1, first = w->first++;
  if (!is_marked(w, first)) mark(w, first, outside);
}

/* Where the fold is of the cord begun at first: as thr_cord_fold says. */
static int fold_of(const window *w, int first, bool folded)
{
  const double whole = w->along[w->n] * (1 - THR_FOLD_ROUNDING), *along = w->along;
  if (!folded) return first;
  int fold = first + 1 > w->fold ? first + 1 : w->fold;
  while (along[fold] + along[fold + 1] - 2 * along[first] < whole)
    fold++;
  return fold;
}

static void mark_all(window *w)
{
  for (int p = 0; p < 2 * w->n + 2; p++)
    w->left[p] = w->right[p] = NONE;
  link_marks(w, w->first - 1, w->last + 1);
  count_chain(w, w->first - 1, w->last + 1, 1);
  for (int p = w->first, left = w->first - 1; p <= w->last; p++)
    if (is_on(w, p)) {
      mark(w, p, left);
      left = p;
    }
}

/* Distances to the next and the last visit, going round. */
static void find_visits(window *w, int *seen)
{
  for (int p = 0; p < 2 * w->n; p++) {
    int k = p % w->n, last = seen[w->piece[k]] - 1;
    if (last >= 0) {
      w->before[k] = p - last;
      w->next[last % w->n] = p - last;
    }
    seen[w->piece[k]] = p + 1;
  }
}

static thr_status window_init(window *w, const thr_frame *frame, const thr_request *request,
                              const thr_cord *cord, thr_err *err)
{
  size_t n = (size_t)cord->n_passes;
  w->n = cord->n_passes;
  w->piece = thr_calloc(n + 1, sizeof *w->piece);
  w->next = thr_calloc(n, sizeof *w->next);
  w->before = thr_calloc(n, sizeof *w->before);
  w->left = thr_calloc(2 * n + 2, sizeof *w->left);
  w->right = thr_calloc(2 * n + 2, sizeof *w->right);
  w->along = thr_calloc(2 * n + 1, sizeof *w->along);
  w->count = thr_calloc(2 * n + 2, sizeof *w->count);
  int *seen = thr_calloc((size_t)thr_chains_pieces(frame, request->joint), sizeof *seen);
  bool all =
      w->piece && w->next && w->before && w->left && w->right && w->along && w->count && seen;
  if (all) {
    w->last = thr_cord_pieces(frame, request->joint, cord, w->piece) - 1;
    for (int p = 0; p < 2 * w->n; p++)
      w->along[p + 1] = w->along[p] + frame->length[cord->half[p % w->n] >> 1];
    find_visits(w, seen);
    w->fold = fold_of(w, 0, thr_cord_folded(request->needles, cord));
    mark_all(w);
  }
  free(seen);
  return all ? THR_OK : thr_nomem(err);
}

thr_status thr_starts_chains(const thr_frame *frame, const thr_request *request,
                             const thr_cord *cord, const thr_threaded *threaded, thr_chains *chains,
                             thr_err *err)
{
  window w = {.threaded = threaded};
  bool folded = thr_cord_folded(request->needles, cord);
  thr_status st = window_init(&w, frame, request, cord, err);
  for (int s = 0; s < cord->n_passes && !st; s++) {
    chains[s] = w.chains;
    if (s + 1 == cord->n_passes) break;
    for (int fold = fold_of(&w, s + 1, folded); w.fold < fold;)
      move_fold(&w);
    move_window(&w);
  }
  window_destroy(&w);
  return st;
}

/* ---- pull ---- */

thr_status thr_starts_pulled(const thr_frame *frame, const thr_cord *cord, double *pulled,
                             thr_err *err)
{
  int n = cord->n_passes;
  double *turned = thr_calloc(2 * (size_t)n + 1,
                              sizeof *turned); /* up to before the turn into pass p, going round */
  if (!turned) return thr_nomem(err);
  for (int p = 0; p < 2 * n; p++)
    turned[p + 1] =
        turned[p] + thr_turn_angle(frame, cord->half[(p + n - 1) % n], cord->half[p % n]);
  for (int s = 0; s < n;
       s++) { /* begun with pass s, the cord turns into the passes s + 1 .. s + n - 1 */
    const thr_parting parting = thr_least_pull(turned + 1, s, s + n - 1);
    pulled[s] = thr_parting_larger(&parting);
  }
  free(turned);
  return THR_OK;
}

void thr_starts_turn(const thr_cord *cord, int start, bool backwards, int *half)
{
  int n = cord->n_passes;
  for (int k = 0; k < n; k++)
    half[k] = backwards ? cord->half[(start + n - 1 - k) % n] ^ 1 : cord->half[(start + k) % n];
}
