/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the moats of a matching of passes to the multipliers of the turning proof.
 *
 * Passes that must be made are alike, so a potential is the mean of their duals. A blossom that has
 * all of them, of every half-edge that it touches, is an odd set. Where it has only some of those
 * of a half-edge h, the pass matched out of it is one of these, and its row is no more than a part
 * of the equation of h: then the potential takes its value, divided by the cover. With cord ends it
 * is the same. */
#include "graph/scratch.h"
#include "graph/sort.h"
#include "tortuosity/proof/relax_parts.h"

#include <stdlib.h>
#include <string.h>

/* ---- blossoms ---- */

/* Each blossom is a part of a list of matching nodes: node[first[b]] .. node[first[b] + size[b] -
 * 1]. */
typedef struct {
  int *first, *size; /* [n_blossoms] */
  int *node;
} blossom_list;

static void list_blossoms(const thr_matching *matching, int n_nodes, int *next, blossom_list *out)
{
  int n = 0;
  for (int v = 0; v < n_nodes; v++)
    if (matching->node_blossom[v] >= 0) out->size[matching->node_blossom[v]]++;
  for (int b = 0; b < matching->n_blossoms; b++) /* children before parents */
    if (matching->blossom_parent[b] >= 0) out->size[matching->blossom_parent[b]] += out->size[b];
  for (int b = matching->n_blossoms - 1; b >= 0; b--) {
    int *at = matching->blossom_parent[b] >= 0 ? &next[matching->blossom_parent[b]] : &n;
    out->first[b] = next[b] = *at;
    *at += out->size[b];
  }
  for (int v = 0; v < n_nodes; v++)
    if (matching->node_blossom[v] >= 0) out->node[next[matching->node_blossom[v]]++] = v;
}

/* ---- sets ---- */

typedef struct {
  const thr_pass_matching *passes;
  int *home;     /* [nodes] place of a pass or end that must be, else -1 */
  int *count;    /* [n_places] those in the blossom; zeros between blossoms */
  int *touched;  /* [n_places] places with a count */
  int64_t *more; /* [n_places] what blossoms add to the sum of the duals of those that must be */
} sets;

/* Counts the passes of a blossom; returns the number of places touched. */
static int count_passes(sets *s, const int *node, int n)
{
  int touched = 0;
  for (int i = 0; i < n; i++) {
    int place = s->home[node[i]];
    if (place >= 0 && s->count[place]++ == 0) s->touched[touched++] = place;
  }
  return touched;
}

/* Leaves the places of the odd set in touched, and returns their number; 0 if it is even. */
static int take_set(sets *s, int n, int64_t value)
{
  int kept = 0, odd = 0;
  for (int i = 0; i < n; i++) {
    int place = s->touched[i], has = s->count[place], needed = thr_pass_needed(s->passes, place);
    s->count[place] = 0;
    if (has < needed) {
      s->more[place] += value;
      continue;
    }
    s->touched[kept++] = place;
    odd ^= needed & 1;
  }
  return odd ? kept : 0;
}

static thr_status add_set(thr_turning_dual *dual, const int *member, int n, int64_t value,
                          thr_err *err)
{
  thr_turning_set *set = &dual->odd[dual->n_odd];
  if (!(set->member = thr_calloc((size_t)n, sizeof *set->member))) return thr_nomem(err);
  memcpy(set->member, member, (size_t)n * sizeof *member);
  thr_sort_ints(set->member, (size_t)n);
  set->n = n;
  set->value = value;
  dual->n_odd++;
  return THR_OK;
}

static thr_status take_sets(sets *s, const thr_matching *matching, const blossom_list *list,
                            thr_turning_dual *dual, thr_err *err)
{
  thr_status st = THR_OK;
  for (int b = 0; b < matching->n_blossoms && !st; b++) {
    int n = count_passes(s, list->node + list->first[b], list->size[b]);
    n = take_set(s, n, matching->blossom_dual[b]);
    int64_t value = matching->blossom_dual[b] * (INT64_C(1) << (s->passes->bits - 1));
    if (n > 0) st = add_set(dual, s->touched, n, value, err);
  }
  return st;
}

/* x / by, rounded down. */
static int64_t floor_div(int64_t x, int64_t by)
{
  return x >= 0 ? x / by : -((-x + by - 1) / by);
}

static void set_potentials(const sets *s, const thr_matching *matching, thr_turning_dual *dual)
{
  const thr_pass_matching *passes = s->passes;
  int halves = 2 * passes->c->f->n_edges;
  for (int i = 0; i < passes->n_places; i++) {
    int needed = thr_pass_needed(passes, i);
    int64_t sum = s->more[i];
    for (int k = 0; k < needed; k++)
      sum += matching->dual[passes->first[i] + k] - passes->lift;
    *(i < halves ? &dual->potential[i] : &dual->ends[i - halves]) =
        needed ? floor_div(sum * (INT64_C(1) << (passes->bits - 1)), needed) : 0;
  }
}

/* Where a cord may turn back, two passes of half-edge h pay for it, which as duals may be unequal:
 * two of the potential are made no more than its price, and the odd set of h alone takes the rest.
 */
static thr_status settle_backs(const thr_pass_matching *passes, const int64_t *price,
                               thr_turning_dual *dual, thr_err *err)
{
  const thr_turning_columns *c = passes->c;
  thr_status st = THR_OK;
  for (int j = c->first_back; j < c->n_columns && !st; j++) {
    int h = c->half[j][0];
    int64_t above = dual->potential[h] - floor_div(price[j], 2);
    if (above <= 0) continue;
    dual->potential[h] -= above;
    if (c->cover[h >> 1] % 2) st = add_set(dual, &h, 1, above, err);
  }
  return st;
}

thr_status thr_pass_dual(const thr_pass_matching *passes, const thr_matching *matching,
                         const int64_t *price, thr_turning_dual *dual, thr_err *err)
{
  size_t places = (size_t)passes->n_places, nodes = (size_t)passes->first[places],
         blossoms = (size_t)matching->n_blossoms,
         backs = (size_t)(passes->c->n_columns - passes->c->first_back);
  thr_scratch own = {0};
  sets s = {.passes = passes,
            .home = thr_scratch_array(&own, nodes, sizeof *s.home),
            .count = thr_scratch_array(&own, places, sizeof *s.count),
            .touched = thr_scratch_array(&own, places, sizeof *s.touched),
            .more = thr_scratch_array(&own, places, sizeof *s.more)};
  blossom_list list = {.first = thr_scratch_array(&own, blossoms, sizeof *list.first),
                       .size = thr_scratch_array(&own, blossoms, sizeof *list.size),
                       .node = thr_scratch_array(&own, nodes, sizeof *list.node)};
  int *next = thr_scratch_array(&own, blossoms, sizeof *next);
  thr_status st = thr_scratch_check(&own, err);
  thr_turning_set *odd =
      st ? NULL : thr_realloc(dual->odd, (size_t)dual->n_odd + blossoms + backs, sizeof *odd);
  if (!st && !odd) st = thr_nomem(err);
  if (odd) dual->odd = odd;
  for (int i = 0; i < passes->n_places && !st; i++)
    for (int k = passes->first[i]; k < passes->first[i + 1]; k++)
      s.home[k] = k - passes->first[i] < thr_pass_needed(passes, i) ? i : -1;
  if (!st) list_blossoms(matching, (int)nodes, next, &list);
  if (!st) st = take_sets(&s, matching, &list, dual, err);
  if (!st) set_potentials(&s, matching, dual);
  if (!st) st = settle_backs(passes, price, dual, err);
  thr_scratch_free(&own);
  return st;
}

/* ---- what is left of prices ---- */

/* Gives the turns from half-edge h to later members of the marked set the value back that both
 * their half-edges pay. */
static void give_back(const thr_turning_columns *c, int h, const thr_turning_set *set,
                      const bool *member, int64_t *left)
{
  int v = thr_tail(c->f, h), halves = 2 * c->f->n_edges;
  if (set->n > thr_degree(c->f, v)) {
    for (int i = c->f->first[v]; i < c->f->first[v + 1]; i++)
      if (c->f->half[i] > h && member[c->f->half[i]])
        left[thr_turning_column(c, h, c->f->half[i])] += 2 * set->value;
    return;
  }
  for (int k = 0; k < set->n && set->member[k] < halves; k++)
    if (set->member[k] > h && thr_tail(c->f, set->member[k]) == v)
      left[thr_turning_column(c, h, set->member[k])] += 2 * set->value;
}

/* Of the columns at the set's half-edges; open: nodes whose turns are asked for; paid[2 n_edges]:
 * what all sets take off the turns of a half-edge, those within a set too. */
static void take_set_off(const thr_turning_columns *c, const thr_turning_set *set,
                         const bool *member, const bool *open, int64_t *paid, int64_t *left)
{
  int halves = 2 * c->f->n_edges;
  bool ends = set->member[set->n - 1] >= halves; /* members ascend */
  for (int j = c->first_end; ends && j < c->first_back; j++)
    if (member[halves + c->end_group[thr_tail(c->f, c->half[j][0])]] && !member[c->half[j][0]])
      left[j] -= set->value;
  for (int k = 0; k < set->n && set->member[k] < halves; k++) {
    int h = set->member[k], v = thr_tail(c->f, h);
    paid[h] += set->value;
    if (!member[h ^ 1]) left[c->first_extra + (h >> 1)] -= set->value;
    if (open[v]) give_back(c, h, set, member, left);
    if (c->end_column[h] >= 0 && !member[halves + c->end_group[v]])
      left[c->end_column[h]] -= set->value;
  }
}

thr_status thr_pass_left(const thr_pass_matching *passes, const int64_t *price,
                         const thr_turning_dual *dual, int first_odd, bool all, int64_t *left,
                         thr_err *err)
{
  const thr_turning_columns *c = passes->c;
  thr_scratch own = {0};
  bool *member = thr_scratch_array(&own, (size_t)passes->n_places, sizeof *member),
       *open = thr_scratch_array(&own, (size_t)c->f->n_nodes, sizeof *open);
  int64_t *paid = thr_scratch_array(&own, 2 * (size_t)c->f->n_edges, sizeof *paid);
  thr_status st = thr_scratch_check(&own, err);
  for (int j = 0; j < c->first_back && !st; j++) {
    int a = c->half[j][0], b = c->half[j][1];
    int64_t both = dual->potential[a] +
                   (b >= 0 ? dual->potential[b] : dual->ends[c->end_group[thr_tail(c->f, a)]]);
    left[j] = price[j] + (j >= c->first_extra && j < c->first_end ? both : -both);
    if (all || !passes->listed[j]) open[thr_tail(c->f, a)] = true;
  }
  for (int i = first_odd; i < dual->n_odd && !st; i++) {
    const thr_turning_set *set = &dual->odd[i];
    for (int k = 0; k < set->n; k++)
      member[set->member[k]] = true;
    take_set_off(c, set, member, open, paid, left);
    for (int k = 0; k < set->n; k++)
      member[set->member[k]] = false;
  }
  for (int j = 0; j < c->first_extra && !st; j++)
    left[j] -= paid[c->half[j][0]] + paid[c->half[j][1]];
  thr_scratch_free(&own);
  return st;
}
