/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes for every start of a closed cord how loose the chains of pieces are from there
 * (thr_starts_chains), and how hard the cord is then to pull (thr_starts_pulled).
 *
 * From one start to the next only a few pieces change, so the chains are kept in a window that
 * moves round the cord and are updated: a piece enters at one end, a piece leaves at the other,
 * and the fold moves on. Marks stand where a loose chain ends. */
#include "graph/plan/physics.h"
#include "planner/planner_parts.h"

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
} chain_window;

enum { NONE = -2 };

/* Releases the arrays of a window. */
static void window_destroy(chain_window *window)
{
  free(window->piece);
  free(window->next);
  free(window->before);
  free(window->left);
  free(window->right);
  free(window->along);
  free(window->count);
}

static bool is_marked(const chain_window *window, int p)
{
  return window->left[p + 1] != NONE;
}

/* Tells whether the piece at place p is on a cord already when the needle comes to it. */
static bool is_on(const chain_window *window, int p)
{
  int k = p % window->n;
  if (p == window->fold || thr_threaded_kept(window->threaded, window->piece[k])) return true;
  return p > window->fold ? p - window->before[k] >= window->fold
                          : p + window->next[k] <= window->last;
}

/* Counts the chain between marks from and to, or, with change = -1, no longer. */
static void count_chain(chain_window *window, int from, int to, int change)
{
  int loose = to - from - 1;
  if (loose <= 0) return;

  window->count[loose] += change;
  window->chains.squares += change * (int64_t)loose * loose;

  /* The longest chain is the largest length that is counted. */
  if (loose > window->chains.longest) window->chains.longest = loose;
  while (window->chains.longest > 0 && window->count[window->chains.longest] == 0)
    window->chains.longest--;
}

static void link_marks(chain_window *window, int a, int b)
{
  window->right[a + 1] = b;
  window->left[b + 1] = a;
}

/* Marks p, between left and the next mark. */
static void mark(chain_window *window, int p, int left)
{
  int right = window->right[left + 1];

  count_chain(window, left, right, -1);
  count_chain(window, left, p, 1);
  count_chain(window, p, right, 1);

  link_marks(window, left, p);
  link_marks(window, p, right);
}

/* Takes the mark at place p away: two chains become one. */
static void unmark(chain_window *window, int p)
{
  int left = window->left[p + 1], right = window->right[p + 1];

  count_chain(window, left, p, -1);
  count_chain(window, p, right, -1);
  count_chain(window, left, right, 1);

  link_marks(window, left, right);
  window->left[p + 1] = NONE;
}

static int mark_before(const chain_window *window, int p)
{
  while (!is_marked(window, --p)) {
  }
  return p;
}

/* ---- moving on ---- */

/* Moves the fold on by a place. Its piece is the left needle's now, and is not on the cord where
 * the right one comes by again. */
static void move_fold(chain_window *window)
{
  int old = window->fold++, again = old + window->next[old % window->n];

  if (!is_marked(window, window->fold)) mark(window, window->fold, old);
  if (!is_on(window, old)) unmark(window, old);
  if (again <= window->last && is_marked(window, again) && !is_on(window, again))
    unmark(window, again);
}

/* Moves the window on by a place; the fold is in it before and afterwards. */
static void move_window(chain_window *window)
{
  int last = ++window->last, earlier = last - window->before[last % window->n];

  /* The place that enters is marked at first, and loses the mark if its piece is loose. */
  window->right[last + 1] = window->left[last + 2] = NONE;
  link_marks(window, last, last + 1);
  if (!is_on(window, last)) unmark(window, last);

  /* The earlier visit of its piece finds the piece on the cord from now on. */
  if (earlier > window->first && earlier < window->fold && !is_marked(window, earlier))
    mark(window, earlier, mark_before(window, earlier));

  /* The first place leaves; the place before the window is always marked. */
  int outside = window->first - 1, first = window->first++;
  if (!is_marked(window, first)) mark(window, first, outside);
}

/* Returns the place of the fold of the cord begun at first, as thr_cord_fold does. */
static int fold_of(const chain_window *window, int first, bool folded)
{
  const double whole = window->along[window->n] * (1 - THR_FOLD_ROUNDING), *along = window->along;

  if (!folded) return first;

  int fold = first + 1 > window->fold ? first + 1 : window->fold;
  while (along[fold] + along[fold + 1] - 2 * along[first] < whole)
    fold++;
  return fold;
}

/* Marks the places of the first window. */
static void mark_all(chain_window *window)
{
  for (int p = 0; p < 2 * window->n + 2; p++)
    window->left[p] = window->right[p] = NONE;

  link_marks(window, window->first - 1, window->last + 1);
  count_chain(window, window->first - 1, window->last + 1, 1);

  for (int p = window->first, left = window->first - 1; p <= window->last; p++)
    if (is_on(window, p)) {
      mark(window, p, left);
      left = p;
    }
}

/* Distances to the next and the last visit, going round. */
static void find_visits(chain_window *window, int *seen)
{
  for (int p = 0; p < 2 * window->n; p++) {
    int k = p % window->n, last = seen[window->piece[k]] - 1;
    if (last >= 0) {
      window->before[k] = p - last;
      window->next[last % window->n] = p - last;
    }
    seen[window->piece[k]] = p + 1;
  }
}

/* Allocates a window, and marks the pieces of start 0. Release with window_destroy, after a failure
 * too. */
static thr_status window_init(chain_window *window, const thr_frame *frame,
                              const thr_request *request, const thr_cord *cord, thr_err *err)
{
  size_t n = (size_t)cord->n_passes;
  window->n = cord->n_passes;
  window->piece = thr_calloc(n + 1, sizeof *window->piece);
  window->next = thr_calloc(n, sizeof *window->next);
  window->before = thr_calloc(n, sizeof *window->before);
  window->left = thr_calloc(2 * n + 2, sizeof *window->left);
  window->right = thr_calloc(2 * n + 2, sizeof *window->right);
  window->along = thr_calloc(2 * n + 1, sizeof *window->along);
  window->count = thr_calloc(2 * n + 2, sizeof *window->count);

  int *seen = thr_calloc((size_t)thr_chains_pieces(frame, request->joint), sizeof *seen);
  bool all = window->piece && window->next && window->before && window->left && window->right &&
             window->along && window->count && seen;

  /* Fill the window of the start 0. */
  if (all) {
    window->last = thr_cord_pieces(frame, request->joint, cord, window->piece) - 1;
    for (int p = 0; p < 2 * window->n; p++)
      window->along[p + 1] = window->along[p] + frame->length[cord->half[p % window->n] >> 1];
    find_visits(window, seen);
    window->fold = fold_of(window, 0, thr_cord_folded(request->needles, cord));
    mark_all(window);
  }

  free(seen);
  return all ? THR_OK : thr_nomem(err);
}

thr_status thr_starts_chains(const thr_frame *frame, const thr_request *request,
                             const thr_cord *cord, const thr_threaded *threaded, thr_chains *chains,
                             thr_err *err)
{
  chain_window window = {.threaded = threaded};
  bool folded = thr_cord_folded(request->needles, cord);
  thr_status st = window_init(&window, frame, request, cord, err);

  for (int s = 0; s < cord->n_passes && !st; s++) {
    chains[s] = window.chains;
    if (s + 1 == cord->n_passes) break;

    /* Move on to the next start. */
    for (int fold = fold_of(&window, s + 1, folded); window.fold < fold;)
      move_fold(&window);
    move_window(&window);
  }

  window_destroy(&window);
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

  /* Sum up the turns over two rounds. */
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

/* Writes the passes of a closed cord begun with pass start, or run backwards from there. */
void thr_starts_turn(const thr_cord *cord, int start, bool backwards, int *half)
{
  int n = cord->n_passes;
  for (int k = 0; k < n; k++)
    half[k] = backwards ? cord->half[(start + n - 1 - k) % n] ^ 1 : cord->half[(start + k) % n];
}
