/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranks plans by a value of which only an interval is known. Used by thread compare.
 *
 * Plan i is surely less than plan k if the interval of i ends before that of k begins. This is an
 * interval order (Fishburn 1970): the rank of a plan is 1 plus the number of plans that are surely
 * less, and plans whose intervals overlap tie. Ties are not transitive: of [1, 3], [2, 5], [4, 6]
 * the first and the last do not tie, though both tie with the middle one.
 *
 * Example: values 12.3, 12.4, 14.1 with an error of 1 % have the ranks 1, 1, 3.
 *
 * A ranking of the largest values first stores them negated, so that less always means better. */
#include "lib/comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const thr_ranking_bands[THR_RANKING_BANDS] = {"band", "band_beads"};

thr_status thr_ranking_init(thr_ranking *ranked, int n, thr_err *err)
{
  size_t count = (size_t)n;

  ranked->value = thr_calloc(count, sizeof *ranked->value);
  ranked->low = thr_calloc(count, sizeof *ranked->low);
  ranked->high = thr_calloc(count, sizeof *ranked->high);

  /* The values at the ends of the bands of friction. */
  bool there = true;
  for (int k = 0; k < THR_RANKING_ENDS; k++)
    there &= (ranked->end[k] = thr_calloc(count, sizeof *ranked->end[k])) != NULL;
  ranked->order = thr_calloc(count, sizeof *ranked->order);
  ranked->rank = thr_calloc(count, sizeof *ranked->rank);

  /* On failure nothing is left allocated. */
  if (!there || !ranked->value || !ranked->low || !ranked->high || !ranked->order ||
      !ranked->rank) {
    thr_ranking_destroy(ranked);
    return thr_nomem(err);
  }

  ranked->n = n;

  /* NAN: not known, until the caller fills it in. */
  for (int i = 0; i < n; i++)
    ranked->value[i] = NAN;
  for (int k = 0; k < THR_RANKING_ENDS; k++)
    for (int i = 0; i < n; i++)
      ranked->end[k][i] = NAN;

  return THR_OK;
}

void thr_ranking_destroy(thr_ranking *ranked)
{
  free(ranked->value);
  free(ranked->low);
  free(ranked->high);
  for (int k = 0; k < THR_RANKING_ENDS; k++)
    free(ranked->end[k]);
  free(ranked->order);
  free(ranked->rank);
  free(ranked->words);
  *ranked = (thr_ranking){0};
}

bool thr_ranking_tells_apart(const thr_ranking *ranked)
{
  /* The largest rank comes last. */
  return ranked->n_ranked > 1 && ranked->rank[ranked->order[ranked->n_ranked - 1]] > 1;
}

/* Returns whether a is less than b by more than rounding (a millionth): else the plans stay in the
 * order in which they were given. */
static bool is_less(double a, double b)
{
  const double alike = 1e-6;
  return a + alike * fabs(a) < b;
}

/* Returns whether the interval of plan i ends before that of plan k begins. */
static bool is_surely_less(const thr_ranking *ranked, int i, int k)
{
  return !isnan(ranked->value[i]) && !isnan(ranked->value[k]) && ranked->high[i] < ranked->low[k];
}

/* Returns whether plan i stands before plan k in the list: by rank, then by value. */
static bool is_before(const thr_ranking *ranked, int i, int k)
{
  return ranked->rank[i] < ranked->rank[k] ||
         (ranked->rank[i] == ranked->rank[k] && is_less(ranked->value[i], ranked->value[k]));
}

void thr_ranking_make(thr_ranking *ranked)
{
  ranked->n_ranked = 0;

  /* Ranks: 1 and one more for every plan that is surely less; 0 where nothing is known. */
  for (int i = 0; i < ranked->n; i++) {
    ranked->rank[i] = !isnan(ranked->value[i]);
    for (int k = 0; ranked->rank[i] && k < ranked->n; k++)
      ranked->rank[i] += is_surely_less(ranked, k, i);
  }

  /* The order: an insertion sort, which is stable. */
  for (int i = 0; i < ranked->n; i++) {
    if (!ranked->rank[i]) continue;

    /* Plan i is inserted before the first plan that it is better than. */
    int k = ranked->n_ranked++;
    for (; k > 0 && is_before(ranked, i, ranked->order[k - 1]); k--)
      ranked->order[k] = ranked->order[k - 1];
    ranked->order[k] = i;
  }
}

bool thr_ranking_is_tie(const thr_ranking *ranked, int i, int k)
{
  return ranked->rank[i] && ranked->rank[k] && ranked->low[i] <= ranked->high[k] &&
         ranked->low[k] <= ranked->high[i];
}

/* Value and interval of a plan in the sense in which people count: without the sign of a ranking of
 * the largest values. */
typedef struct {
  double value, low, high;
} counted;

/* Returns what plan i has. A negated interval is turned round. */
static counted unsigned_values(const thr_ranking *ranked, int i)
{
  if (ranked->most) return (counted){-ranked->value[i], -ranked->high[i], -ranked->low[i]};
  return (counted){ranked->value[i], ranked->low[i], ranked->high[i]};
}

/* Appends the interval of plan i: "+-0.4 %", "from .. to", or "at least" where there is no upper
 * end. Nothing if it is no wider than its digits. */
static void put_interval(const thr_ranking *ranked, int i, thr_text *text)
{
  const double low = unsigned_values(ranked, i).low, high = unsigned_values(ranked, i).high;
  char from[THR_PLAIN_NUMBER], to[THR_PLAIN_NUMBER];

  /* Without an upper end, as an error, or as an interval. */
  if (!isfinite(high))
    thr_text_printf(text, " (at least %s%s%s%s)", thr_plain_number(low, 4, from), ranked->unit,
                    ranked->open ? ": " : "", ranked->open ? ranked->open : "");
  else if (ranked->error && ranked->value[i] > 0)
    thr_text_printf(text, " (+-%.3g %%)", 100 * (high / ranked->value[i] - 1));
  else if (!ranked->error && high > low * (1 + 1e-5))
    thr_text_printf(text, " (%s .. %s%s)", thr_plain_number(low, 4, from),
                    thr_plain_number(high, 4, to), ranked->unit);
}

/* Appends the value of plan i with its interval. INFINITY: proved that no value will do. */
static void put_value(const thr_ranking *ranked, int i, thr_text *text)
{
  char number[THR_PLAIN_NUMBER];

  if (ranked->words) {
    thr_text_append(text, ranked->words[i]);
    return;
  }

  /* A lower bound of INFINITY: no value will do. */
  if (isinf(ranked->value[i])) {
    thr_text_append(text, "none, proved");
    return;
  }
  thr_text_printf(text, "%s%s", thr_plain_number(unsigned_values(ranked, i).value, 4, number),
                  ranked->unit);
  put_interval(ranked, i, text);
}

/* Appends with which of the plans before it the plan at place k ties. Their names are given only
 * where it is not just the one before, or all. */
static void put_ties(const thr_ranking *ranked, int k, const char *const *name, thr_text *text)
{
  const char *overlap = ranked->words ? "the runs overlap" : "within the error";
  int ties = 0;

  for (int j = 0; j < k; j++)
    ties += thr_ranking_is_tie(ranked, ranked->order[j], ranked->order[k]);

  /* Told apart from all before, or with which of them it ties. */
  if (ties == 0 && ranked->words)
    return;
  else if (ties == 0)
    thr_text_append(text, ranked->most ? "  less, beyond the error" : "  more, beyond the error");
  else if (ties == 1 && thr_ranking_is_tie(ranked, ranked->order[k - 1], ranked->order[k]))
    thr_text_printf(text, "  tie, %s", overlap);
  else if (ties == k)
    thr_text_printf(text, "  tie with all before, %s", overlap);
  else {
    /* Some of the plans before: by name. */
    const char *with = "  tie with ";
    for (int j = 0; j < k; j++) {
      if (!thr_ranking_is_tie(ranked, ranked->order[j], ranked->order[k])) continue;
      thr_text_printf(text, "%s%s", with, name[ranked->order[j]]);
      with = ", ";
    }
    thr_text_printf(text, ", %s", overlap);
  }
}

void thr_ranking_put_text(const thr_ranking *ranked, const char *const *name, thr_text *text)
{
  int widest = 0;

  for (int i = 0; i < ranked->n; i++)
    if ((int)strlen(name[i]) > widest) widest = (int)strlen(name[i]);
  thr_text_printf(text, "ranking by %s\n", ranked->title);

  /* Plans with a rank. */
  for (int k = 0; k < ranked->n_ranked; k++) {
    int i = ranked->order[k];
    thr_text_printf(text, "  %d. %-*s ", ranked->rank[i], widest, name[i]);

    /* A value with its interval, and how it stands to those before. */
    put_value(ranked, i, text);
    if (k > 0) put_ties(ranked, k, name, text);
    thr_text_append(text, "\n");
  }

  /* Plans of which nothing is known. */
  for (int i = 0; i < ranked->n; i++)
    if (!ranked->rank[i]) thr_text_printf(text, "  -  %-*s not known\n", widest, name[i]);
}

/* Returns whether two plans, of which i is surely less, change places at an end of a band of
 * friction. */
static bool is_swapped(const thr_ranking *ranked, int end, int i, int k)
{
  return is_surely_less(ranked, i, k) && is_less(ranked->end[end][k], ranked->end[end][i]);
}

/* Returns whether the values of two plans and more are known at both ends of a band. */
static bool is_banded(const thr_ranking *ranked, int band)
{
  int known = 0;
  for (int i = 0; i < ranked->n; i++)
    known +=
        ranked->rank[i] && !isnan(ranked->end[2 * band][i]) && !isnan(ranked->end[2 * band + 1][i]);
  return known > 1;
}

/* Returns how many pairs of plans change places at either end of a band. */
static int count_swaps(const thr_ranking *ranked, int band)
{
  int n = 0;
  for (int end = 2 * band; end < 2 * band + 2; end++)
    for (int i = 0; i < ranked->n; i++)
      for (int k = 0; k < ranked->n; k++)
        n += is_swapped(ranked, end, i, k);
  return n;
}

void thr_ranking_put_bands(const thr_ranking *ranked, const char *const *name,
                           char at[THR_RANKING_ENDS][40], thr_text *text)
{
  enum { MOST = 3 };

  if (!thr_ranking_tells_apart(ranked)) return;

  for (int band = 0; band < THR_RANKING_BANDS; band++) {
    /* -1: the values at the ends of this band are not known. */
    const int all = is_banded(ranked, band) ? count_swaps(ranked, band) : -1;
    int said = 0;

    /* Either nothing changes, or the first three pairs that change places are named. */
    if (all == 0)
      thr_text_printf(text, "     the same order at %s and at %s\n", at[2 * band],
                      at[2 * band + 1]);

    for (int end = 2 * band; end < 2 * band + 2 && all > 0; end++)
      for (int i = 0; i < ranked->n; i++)
        for (int k = 0; k < ranked->n; k++)
          if (is_swapped(ranked, end, i, k) && said++ < MOST)
            thr_text_printf(text, "     at %s: %s before %s\n", at[end], name[k], name[i]);

    if (said > MOST) thr_text_printf(text, "     and %d more change places\n", said - MOST);
  }
}

void thr_ranking_put_json(const thr_ranking *ranked, const char *const *name, thr_writer *writer)
{
  thr_write_object(writer, NULL);
  thr_write_string(writer, "by", ranked->key);
  thr_write_string(writer, "first", ranked->most ? "most" : "least");

  thr_write_array(writer, "order");
  for (int k = 0; k < ranked->n_ranked; k++) {
    int i = ranked->order[k];
    thr_write_object(writer, NULL);
    thr_write_string(writer, "plan", name[i]);
    const bool known = !ranked->words || ranked->value[i] < thr_ranking_order;
    thr_write_number(writer, "value", known ? unsigned_values(ranked, i).value : NAN);
    thr_write_number(writer, "low", known ? unsigned_values(ranked, i).low : NAN);
    thr_write_number(writer, "high", known ? unsigned_values(ranked, i).high : NAN);
    thr_write_int(writer, "rank", ranked->rank[i]);

    /* The values at the ends of each band. */
    for (int band = 0; band < THR_RANKING_BANDS; band++) {
      if (!is_banded(ranked, band)) continue;
      thr_write_array(writer, thr_ranking_bands[band]);
      for (int end = 2 * band; end < 2 * band + 2; end++)
        thr_write_number(writer, NULL, ranked->most ? -ranked->end[end][i] : ranked->end[end][i]);
      thr_write_close(writer);
    }
    thr_write_close(writer);
  }
  thr_write_close(writer);

  /* Whether the order is the same at the ends of each band. */
  for (int band = 0; band < THR_RANKING_BANDS; band++)
    if (is_banded(ranked, band))
      thr_write_bool(writer, band ? "same_over_band_beads" : "same_over_band",
                     count_swaps(ranked, band) == 0);
  thr_write_close(writer);
}

bool thr_ranking_disagree(const thr_ranking *a, const thr_ranking *b, int pair[2])
{
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->n; k++) {
      /* Ties contradict nothing: both rankings must tell the two plans apart. */
      if (!is_surely_less(a, i, k) || !is_surely_less(b, k, i)) continue;

      pair[0] = i;
      pair[1] = k;
      return true;
    }

  return false;
}
