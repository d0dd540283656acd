/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says which of several plans to take, and why.
 *
 * The order is that of `thread advise`: first what a hand manages again and again (thr_hand_always
 * at the upper end of the band of friction; after simulations: what came up in all runs), of that
 * the fewest cords, of so many the shortest. Of plans that no hand manages the least pull comes
 * first.
 *
 * Example: 4 cords at 3.5 N and 4 cords at 8.1 N, 12 % shorter, which rougher cord makes 23 N: take
 * the first, "3.5 N a cord instead of 8.1 N, 12 % more cord; with rougher cord no hand pulls the
 * other". */
#include "graph/plan/plan_measures.h"
#include "lib/comparison.h"

#include <math.h>
#include <stdlib.h>

static const double tells_apart = 1e-6; /* part by which two values differ */

/* Returns whether a hand manages a plan: by simulation where that was asked for. */
static bool is_managed(const thr_compare_entry *e, int method)
{
  if (method == THR_BY_RISE) return e->rise.runs > 0 && e->rise.up == e->rise.runs;
  return e->eval[THR_CAPSTAN].band[1] <= thr_hand_always;
}

/* Returns the sign of a - b; 0 if they differ by no more than a part. What is not known is most. */
static int compare_values(double a, double b, double part)
{
  if (isnan(a) || isnan(b)) return isnan(a) - isnan(b);
  return fabs(a - b) <= part * fabs(b) ? 0 : a < b ? -1 : 1;
}

/* Returns whether plan i is to be taken rather than plan k. */
static bool is_better(const thr_compare_entry *entries, int n, int method, int i, int k)
{
  const thr_price mine = thr_compare_price(entries, n, i), other = thr_compare_price(entries, n, k);
  const bool managed = is_managed(&entries[i], method);
  const int by_pull = compare_values(mine.pull, other.pull, tells_apart);
  if (managed != is_managed(&entries[k], method)) return managed;

  const int order[] = {managed ? 0 : by_pull, mine.cords - other.cords,
                       compare_values(mine.length, other.length, tells_apart), by_pull, i - k};
  for (size_t rule = 0; rule < sizeof order / sizeof *order; rule++)
    if (order[rule]) return order[rule] < 0;
  return false;
}

int thr_compare_take(const thr_compare_entry *entries, int n, int method, int without)
{
  int taken = without == 0;
  for (int i = taken + 1; i < n; i++)
    if (i != without && is_better(entries, n, method, i, taken)) taken = i;
  return taken;
}

/* Appends in what a plan differs from another one: "2 cords instead of 4, 8.1 N a cord .., 12 %
 * less cord". Returns whether it does. */
static bool put_differences(const thr_price *mine, const thr_price *other, thr_text *text)
{
  char number[2][THR_PLAIN_NUMBER];
  const char *comma = "";
  if (mine->cords != other->cords) {
    thr_text_printf(text, "%d cord%s instead of %d", mine->cords, mine->cords == 1 ? "" : "s",
                    other->cords);
    comma = ", ";
  }

  /* Differences that a hand or a reel notices. */
  if (compare_values(mine->pull, other->pull, 0.01)) {
    thr_text_printf(text, "%s%s N a cord instead of %s N", comma,
                    thr_plain_newtons(mine->pull, number[0]),
                    thr_plain_newtons(other->pull, number[1]));
    comma = ", ";
  }
  const double more = 100 * (mine->length / other->length - 1);
  if (fabs(more) >= 0.1) {
    thr_text_printf(text, "%s%s %% %s cord", comma, thr_plain_number(fabs(more), 2, number[0]),
                    more > 0 ? "more" : "less");
    comma = ", ";
  }
  if (!*comma) thr_text_append(text, "the same in cords, pull and length");
  return *comma;
}

bool thr_compare_put_why(const thr_compare_entry *entries, int n, int method, thr_text *text)
{
  const int taken = thr_compare_take(entries, n, method, -1),
            next = thr_compare_take(entries, n, method, taken);
  const thr_price mine = thr_compare_price(entries, n, taken),
                  other = thr_compare_price(entries, n, next);
  const bool rose = method == THR_BY_RISE, differs = put_differences(&mine, &other, text);

  /* What decided it; where both would do, that the other would. */
  if (!is_managed(&entries[taken], method))
    thr_text_append(text, rose ? "; none comes up in every run"
                               : "; in rougher cord more than a hand's 10 N: try more cords");
  else if (!is_managed(&entries[next], method))
    thr_text_append(text, rose ? "; the other does not come up in every run"
                               : "; the other takes more than a hand's 10 N in rougher cord");
  else if (differs && !thr_price_beats(&mine, &other))
    thr_text_append(text, "; a matter of taste, as a hand manages both");
  return differs;
}
