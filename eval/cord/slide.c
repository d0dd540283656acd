/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets an elastic cord of fixed ends slide over its turns until every turn holds (profile.h).
 *
 * Where a turn between passes k and k + 1 does not hold, cord moves towards the tighter pass, over
 * this turn and over those beside it that then hold no longer. All turns that the cord moves over
 * hold as much as friction can, so that one tension says those of all their passes, and this
 * tension follows from the sum of the elongations, which is kept (pooling of adjacent violators, as
 * in isotonic regression: R. E. Barlow et al., 1972).
 *
 * Example: 9 and 1 N in two passes of one length, exponent ln 2: 20/3 and 10/3 N. */
#include "eval/cord/profile.h"

#include <math.h>

static const double SAME = 1e-12; /* relative: a tension that a turn just holds */

/* Returns whether turn k, between a tight and a slack pass, lets cord slide to the tight one. */
static bool slips(const thr_slide *cord, int k, double tight, double slack)
{
  if (k == cord->held || !(tight > 0)) return false;
  return tight > thr_friction_more(&cord->friction, fmax(slack, 0), cord->exponent[k]) * (1 + SAME);
}

/* Returns what pass i of a range, whose tight end is pass `from`, has of the tension there. */
static double within(const thr_slide *cord, int i, int from, double top)
{
  if (!(top > 0)) return top;
  return thr_friction_less(&cord->friction, top, fabs(cord->sum[i] - cord->sum[from]));
}

/* Returns tension x length of passes a .. b with the tension `top` at the tight end. */
static double sum_within(const thr_slide *cord, int a, int b, bool falling, double top)
{
  double sum = 0;
  for (int k = a; k <= b; k++)
    sum += cord->length[k] * within(cord, k, falling ? a : b, top);
  return sum;
}

/* Returns the tension at the tight end with which passes a .. b keep the sum of their elongations
 * although each turn between them holds no more than friction can. falling: a is the tight end. */
static double top_of(const thr_slide *cord, const double *tension, int a, int b, bool falling)
{
  double sum = 0, length = 0, low = 0, high = 0;

  /* EA is the same everywhere and cancels. */
  for (int k = a; k <= b; k++) {
    sum += cord->length[k] * tension[k];
    length += cord->length[k];
    high = fmax(high, tension[k]);
  }

  /* All of them become slack. */
  if (sum <= 0) return sum / length;

  /* By the capstan law tensions are proportional to the top. Other laws of friction need
   * bisection. */
  if (cord->friction.power == 1) return sum / sum_within(cord, a, b, falling, 1);
  for (double middle = high / 2; middle > low && middle < high; middle = (low + high) / 2) {
    if (sum_within(cord, a, b, falling, middle) < sum)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* Lets the cord slide over turn k, and over the turns beside it that then hold no longer. Extending
 * the range on one side never removes a reason for extending it on the other side, so that the
 * order does not matter. */
static void slide_over(const thr_slide *cord, double *tension, int k, bool falling)
{
  int a = k, b = k + 1;
  for (bool more = true; more;) {
    const double top = top_of(cord, tension, a, b, falling);
    const double first = within(cord, a, falling ? a : b, top),
                 last = within(cord, b, falling ? a : b, top);
    more = false;

    /* Extend the range by the pass before it if cord slides between the two, .. */
    if (a > 0) {
      more = falling ? slips(cord, a - 1, tension[a - 1], first)
                     : slips(cord, a - 1, first, tension[a - 1]);
      a -= more;
    }

    /* .. or by the pass behind it. */
    if (!more && b + 1 < cord->n) {
      more = falling ? slips(cord, b, last, tension[b + 1]) : slips(cord, b, tension[b + 1], last);
      b += more;
    }

    /* Nothing slides at the borders any more: the pooled tensions are the state. */
    for (int i = a; !more && i <= b; i++)
      tension[i] = within(cord, i, falling ? a : b, top);
  }
}

void thr_slide_relax(const thr_slide *cord, double *tension)
{
  for (int k = 0; k + 1 < cord->n; k++)
    for (int falling = 0; falling < 2; falling++) {
      const double tight = tension[falling ? k : k + 1], slack = tension[falling ? k + 1 : k];
      if (slips(cord, k, tight, slack)) slide_over(cord, tension, k, falling);
    }
}
