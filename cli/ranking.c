/* Rankings with honest ties. */
#include "cli/ranking.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

thr_status ranking_init(ranking *r, int n, thr_err *err)
{
  size_t count = (size_t)n;
  r->value = thr_calloc(count, sizeof *r->value);
  r->low = thr_calloc(count, sizeof *r->low);
  r->high = thr_calloc(count, sizeof *r->high);
  r->order = thr_calloc(count, sizeof *r->order);
  r->rank = thr_calloc(count, sizeof *r->rank);
  if (!r->value || !r->low || !r->high || !r->order || !r->rank) {
    ranking_destroy(r);
    return thr_nomem(err);
  }
  r->n = n;
  for (int i = 0; i < n; i++)
    r->value[i] = NAN;
  return THR_OK;
}

void ranking_destroy(ranking *r)
{
  free(r->value);
  free(r->low);
  free(r->high);
  free(r->order);
  free(r->rank);
  *r = (ranking){0};
}

void ranking_make(ranking *r)
{
  r->n_ranked = 0;
  for (int i = 0; i < r->n; i++) {
    r->rank[i] = 0;
    if (isnan(r->value[i])) continue;
    int k = r->n_ranked++;
    for (; k > 0 && r->value[r->order[k - 1]] > r->value[i]; k--)
      r->order[k] = r->order[k - 1];
    r->order[k] = i;
  }
  for (int k = 0; k < r->n_ranked; k++) {
    bool tie = k > 0 && r->low[r->order[k]] <= r->high[r->order[k - 1]];
    r->rank[r->order[k]] = tie ? r->rank[r->order[k - 1]] : k + 1;
  }
}

static void put_interval(const ranking *r, int i, thr_text *t)
{
  if (r->error && r->value[i] > 0)
    thr_text_printf(t, " (+-%.2g %%)", 100 * (r->high[i] / r->value[i] - 1));
  else if (!r->error && r->high[i] > r->low[i] * (1 + 1e-5) && isfinite(r->high[i]))
    thr_text_printf(t, " (%.4g .. %.4g%s)", r->low[i], r->high[i], r->unit);
}

void ranking_put_text(const ranking *r, const char *const *name, thr_text *t)
{
  int widest = 0;
  for (int i = 0; i < r->n; i++)
    if ((int)strlen(name[i]) > widest) widest = (int)strlen(name[i]);
  thr_text_printf(t, "ranking by %s\n", r->title);
  for (int k = 0; k < r->n_ranked; k++) {
    int i = r->order[k];
    thr_text_printf(t, "  %d. %-*s %.4g%s", r->rank[i], widest, name[i], r->value[i], r->unit);
    put_interval(r, i, t);
    if (k > 0)
      thr_text_append(t, r->rank[i] == r->rank[r->order[k - 1]] ? "  tie with the one before" : "  more, beyond the error");
    thr_text_append(t, "\n");
  }
  for (int i = 0; i < r->n; i++)
    if (!r->rank[i]) thr_text_printf(t, "  -  %-*s not known\n", widest, name[i]);
}

static void put_number(thr_text *t, const char *before, double value)
{
  thr_text_append(t, before);
  if (isfinite(value))
    thr_text_double(t, value);
  else
    thr_text_append(t, "null");
}

void ranking_put_json(const ranking *r, const char *const *name, thr_text *t)
{
  thr_text_printf(t, "{\"by\": \"%s\", \"order\": [", r->key);
  for (int k = 0; k < r->n_ranked; k++) {
    int i = r->order[k];
    thr_text_append(t, k ? ", {\"plan\": " : "{\"plan\": ");
    thr_text_json_string(t, name[i]);
    put_number(t, ", \"value\": ", r->value[i]);
    put_number(t, ", \"low\": ", r->low[i]);
    put_number(t, ", \"high\": ", r->high[i]);
    thr_text_printf(t, ", \"rank\": %d}", r->rank[i]);
  }
  thr_text_append(t, "]}");
}

bool ranking_disagree(const ranking *a, const ranking *b, int pair[2])
{
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->n; k++) {
      bool all = a->rank[i] && a->rank[k] && b->rank[i] && b->rank[k];
      if (!all || a->rank[i] >= a->rank[k] || b->rank[i] <= b->rank[k]) continue;
      pair[0] = i;
      pair[1] = k;
      return true;
    }
  return false;
}
