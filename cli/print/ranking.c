/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An order of plans by a value of which more or less is known. Used by compare. */
#include "cli/print/print.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const ranking_bands[RANKING_BANDS] = {"band", "band_beads"};

thr_status ranking_init(ranking *r, int n, thr_err *err)
{
  size_t count = (size_t)n;
  r->value = thr_calloc(count, sizeof *r->value);
  r->low = thr_calloc(count, sizeof *r->low);
  r->high = thr_calloc(count, sizeof *r->high);
  bool there = true;
  for (int k = 0; k < RANKING_ENDS; k++)
    there &= (r->end[k] = thr_calloc(count, sizeof *r->end[k])) != NULL;
  r->order = thr_calloc(count, sizeof *r->order);
  r->rank = thr_calloc(count, sizeof *r->rank);
  if (!there || !r->value || !r->low || !r->high || !r->order || !r->rank) {
    ranking_destroy(r);
    return thr_nomem(err);
  }
  r->n = n;
  for (int i = 0; i < n; i++)
    r->value[i] = NAN;
  for (int k = 0; k < RANKING_ENDS; k++)
    for (int i = 0; i < n; i++)
      r->end[k][i] = NAN;
  return THR_OK;
}

void ranking_destroy(ranking *r)
{
  free(r->value);
  free(r->low);
  free(r->high);
  for (int k = 0; k < RANKING_ENDS; k++)
    free(r->end[k]);
  free(r->order);
  free(r->rank);
  *r = (ranking){0};
}

bool ranking_tells_apart(const ranking *r)
{
  /* The largest rank comes last. */
  return r->n_ranked > 1 && r->rank[r->order[r->n_ranked - 1]] > 1;
}

/* Values that differ in their last digits only stay in the order of the plans. */
static bool is_less(double a, double b)
{
  const double alike = 1e-6;
  return a + alike * fabs(a) < b;
}

static bool surely_less(const ranking *r, int i, int k)
{
  return !isnan(r->value[i]) && !isnan(r->value[k]) && r->high[i] < r->low[k];
}

static bool comes_before(const ranking *r, int i, int k)
{
  return r->rank[i] < r->rank[k] || (r->rank[i] == r->rank[k] && is_less(r->value[i], r->value[k]));
}

void ranking_make(ranking *r)
{
  r->n_ranked = 0;
  for (int i = 0; i < r->n; i++) {
    r->rank[i] = !isnan(r->value[i]);
    for (int k = 0; r->rank[i] && k < r->n; k++)
      r->rank[i] += surely_less(r, k, i);
  }
  for (int i = 0; i < r->n; i++) {
    if (!r->rank[i]) continue;
    int k = r->n_ranked++;
    for (; k > 0 && comes_before(r, i, r->order[k - 1]); k--)
      r->order[k] = r->order[k - 1];
    r->order[k] = i;
  }
}

bool ranking_is_tie(const ranking *r, int i, int k)
{
  return r->rank[i] && r->rank[k] && r->low[i] <= r->high[k] && r->low[k] <= r->high[i];
}

/* What plan i has, as people count it. */
typedef struct {
  double value, low, high;
} counted;

static counted count_of(const ranking *r, int i)
{
  if (r->most) return (counted){-r->value[i], -r->high[i], -r->low[i]};
  return (counted){r->value[i], r->low[i], r->high[i]};
}

/* +-0.4 %, or from .. to. */
static void put_interval(const ranking *r, int i, thr_text *text)
{
  const double low = count_of(r, i).low, high = count_of(r, i).high;
  if (!isfinite(high))
    thr_text_printf(text, " (at least %.4g%s%s%s)", low, r->unit, r->open ? ": " : "",
                    r->open ? r->open : "");
  else if (r->error && r->value[i] > 0)
    thr_text_printf(text, " (+-%.3g %%)", 100 * (high / r->value[i] - 1));
  else if (!r->error && high > low * (1 + 1e-5))
    thr_text_printf(text, " (%.4g .. %.4g%s)", low, high, r->unit);
}

static void put_value(const ranking *r, int i, thr_text *text)
{
  if (isinf(r->value[i])) {
    thr_text_append(text, "none, proved");
    return;
  }
  thr_text_printf(text, "%.4g%s", count_of(r, i).value, r->unit);
  put_interval(r, i, text);
}

/* With whom of those before it the plan in place k ties, named where it is not just the one before.
 */
static void put_ties(const ranking *r, int k, const char *const *name, thr_text *text)
{
  int ties = 0;
  for (int j = 0; j < k; j++)
    ties += ranking_is_tie(r, r->order[j], r->order[k]);
  if (ties == 0)
    thr_text_append(text, r->most ? "  less, beyond the error" : "  more, beyond the error");
  else if (ties == 1 && ranking_is_tie(r, r->order[k - 1], r->order[k]))
    thr_text_append(text, "  tie, within the error");
  else if (ties == k)
    thr_text_append(text, "  tie with all before, within the error");
  else {
    const char *with = "  tie with ";
    for (int j = 0; j < k; j++) {
      if (!ranking_is_tie(r, r->order[j], r->order[k])) continue;
      thr_text_printf(text, "%s%s", with, name[r->order[j]]);
      with = ", ";
    }
    thr_text_append(text, ", within the error");
  }
}

void ranking_put_text(const ranking *r, const char *const *name, thr_text *text)
{
  int widest = 0;
  for (int i = 0; i < r->n; i++)
    if ((int)strlen(name[i]) > widest) widest = (int)strlen(name[i]);
  thr_text_printf(text, "ranking by %s\n", r->title);
  for (int k = 0; k < r->n_ranked; k++) {
    int i = r->order[k];
    thr_text_printf(text, "  %d. %-*s ", r->rank[i], widest, name[i]);
    put_value(r, i, text);
    if (k > 0) put_ties(r, k, name, text);
    thr_text_append(text, "\n");
  }
  for (int i = 0; i < r->n; i++)
    if (!r->rank[i]) thr_text_printf(text, "  -  %-*s not known\n", widest, name[i]);
}

/* Do two plans, of which i is surely less, change places at an end of a band? */
static bool swaps(const ranking *r, int end, int i, int k)
{
  return surely_less(r, i, k) && is_less(r->end[end][k], r->end[end][i]);
}

/* Is the order of any two plans known at both ends of a band? */
static bool is_banded(const ranking *r, int band)
{
  int known = 0;
  for (int i = 0; i < r->n; i++)
    known += r->rank[i] && !isnan(r->end[2 * band][i]) && !isnan(r->end[2 * band + 1][i]);
  return known > 1;
}

/* Counts plans that change places at either end of a band. */
static int count_swaps(const ranking *r, int band)
{
  int n = 0;
  for (int end = 2 * band; end < 2 * band + 2; end++)
    for (int i = 0; i < r->n; i++)
      for (int k = 0; k < r->n; k++)
        n += swaps(r, end, i, k);
  return n;
}

void ranking_put_bands(const ranking *r, const char *const *name, char at[RANKING_ENDS][40],
                       thr_text *text)
{
  enum { MOST = 3 };
  if (!ranking_tells_apart(r)) return;
  for (int band = 0; band < RANKING_BANDS; band++) {
    const int all = is_banded(r, band) ? count_swaps(r, band) : -1;
    int said = 0;
    if (all == 0)
      thr_text_printf(text, "     the same order at %s and at %s\n", at[2 * band],
                      at[2 * band + 1]);
    for (int end = 2 * band; end < 2 * band + 2 && all > 0; end++)
      for (int i = 0; i < r->n; i++)
        for (int k = 0; k < r->n; k++)
          if (swaps(r, end, i, k) && said++ < MOST)
            thr_text_printf(text, "     at %s: %s before %s\n", at[end], name[k], name[i]);
    if (said > MOST) thr_text_printf(text, "     and %d more change places\n", said - MOST);
  }
}

void ranking_put_json(const ranking *r, const char *const *name, thr_writer *writer)
{
  thr_write_object(writer, NULL);
  thr_write_string(writer, "by", r->key);
  thr_write_string(writer, "first", r->most ? "most" : "least");
  thr_write_array(writer, "order");
  for (int k = 0; k < r->n_ranked; k++) {
    int i = r->order[k];
    thr_write_object(writer, NULL);
    thr_write_string(writer, "plan", name[i]);
    thr_write_number(writer, "value", count_of(r, i).value);
    thr_write_number(writer, "low", count_of(r, i).low);
    thr_write_number(writer, "high", count_of(r, i).high);
    thr_write_int(writer, "rank", r->rank[i]);
    for (int band = 0; band < RANKING_BANDS; band++) {
      if (!is_banded(r, band)) continue;
      thr_write_array(writer, ranking_bands[band]);
      for (int end = 2 * band; end < 2 * band + 2; end++)
        thr_write_number(writer, NULL, r->most ? -r->end[end][i] : r->end[end][i]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);
  for (int band = 0; band < RANKING_BANDS; band++)
    if (is_banded(r, band))
      thr_write_bool(writer, band ? "same_over_band_beads" : "same_over_band",
                     count_swaps(r, band) == 0);
  thr_write_close(writer);
}

bool ranking_disagree(const ranking *a, const ranking *b, int pair[2])
{
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->n; k++) {
      if (!surely_less(a, i, k) || !surely_less(b, k, i)) continue;
      pair[0] = i;
      pair[1] = k;
      return true;
    }
  return false;
}
