/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes multipliers of the turning proof from the moats of a matching of passes.
 *
 * The passes that must be made of a half-edge are alike, so the potential of the half-edge is the
 * mean of their duals. A blossom that has all of them, of every half-edge that it touches, is an
 * odd set. A blossom may have only some of those of a half-edge h; then the pass that is matched
 * out of the blossom is one of these, and the blossom's row is no more than a part of the equation
 * of h: the potential of h takes the blossom's value, divided by the cover. Cord ends are treated
 * as the passes of a half-edge are.
 *
 * Example: a half-edge passed twice whose passes have the duals 3 and 5 has the potential 4. */
#include "graph/arrays.h"
#include "tortuosity/proof/relax_parts.h"

#include <string.h>

/* ---- blossoms ---- */

/* The matching nodes of every blossom, as parts of one list: node[first[b]] .. node[first[b] +
 * size[b] - 1]. The part of a child is inside the part of its parent. */
typedef struct {
  int *first, *size; /* [n_blossoms] */
  int *node;
} blossom_list;

/* Fills out, whose sizes are 0. next: [n_blossoms] scratch. */
static void list_blossoms(const thr_matching *matching, int n_nodes, int *next, blossom_list *out)
{
  int n = 0;
  /* Sizes: own nodes, and those of children, which come before their parents. */
  for (int v = 0; v < n_nodes; v++)
    if (matching->node_blossom[v] >= 0) out->size[matching->node_blossom[v]]++;
  for (int b = 0; b < matching->n_blossoms; b++)
    if (matching->blossom_parent[b] >= 0) out->size[matching->blossom_parent[b]] += out->size[b];

  /* Parents first, each child takes the next places in its parent's part; own nodes take the rest.
   */
  for (int b = matching->n_blossoms - 1; b >= 0; b--) {
    int *at = matching->blossom_parent[b] >= 0 ? &next[matching->blossom_parent[b]] : &n;
    out->first[b] = next[b] = *at;
    *at += out->size[b];
  }

  for (int v = 0; v < n_nodes; v++)
    if (matching->node_blossom[v] >= 0) out->node[next[matching->node_blossom[v]]++] = v;
}

/* ---- sets ---- */

/* State for turning blossoms into odd sets. */
typedef struct {
  const thr_pass_matching *passes;
  int *home;     /* [nodes] place of a pass or end that must be, else -1 */
  int *count;    /* [n_places] those in the blossom; zeros between blossoms */
  int *touched;  /* [n_places] places with a count */
  int64_t *more; /* [n_places] what blossoms add to the sum of the duals of those that must be */
} blossom_sets;

/* Counts the required passes of the blossom node[n] at every place. Returns the number of places
 * touched. */
static int count_passes(blossom_sets *state, const int *node, int n)
{
  int touched = 0;
  for (int i = 0; i < n; i++) {
    int place = state->home[node[i]];
    if (place >= 0 && state->count[place]++ == 0) state->touched[touched++] = place;
  }
  return touched;
}

/* Keeps in state->touched the places all of whose required passes are in the blossom, and returns
 * their number, or 0 if they are an even set. The other places get the blossom's value. Clears the
 * counts of the n places touched. */
static int take_set(blossom_sets *state, int n, int64_t value)
{
  int kept = 0, odd = 0;
  for (int i = 0; i < n; i++) {
    int place = state->touched[i], has = state->count[place],
        needed = thr_pass_needed(state->passes, place);
    state->count[place] = 0;

    if (has < needed) {
      state->more[place] += value;
      continue;
    }

    state->touched[kept++] = place;
    odd ^= needed & 1;
  }
  return odd ? kept : 0;
}

/* Appends an odd set, for which dual->odd has space. */
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

/* Makes odd sets of all blossoms. Their values change from halves of the matching's unit into units
 * of prices. */
static thr_status take_sets(blossom_sets *state, const thr_matching *matching,
                            const blossom_list *list, thr_turning_dual *dual, thr_err *err)
{
  thr_status st = THR_OK;
  for (int b = 0; b < matching->n_blossoms && !st; b++) {
    int n = count_passes(state, list->node + list->first[b], list->size[b]);
    n = take_set(state, n, matching->blossom_dual[b]);
    int64_t value = matching->blossom_dual[b] * (INT64_C(1) << (state->passes->bits - 1));
    if (n > 0) st = add_set(dual, state->touched, n, value, err);
  }
  return st;
}

/* Returns x / by, rounded down; by > 0. */
static int64_t floor_div(int64_t x, int64_t by)
{
  return x >= 0 ? x / by : -((-x + by - 1) / by);
}

/* Sets every potential, and multiplier of ends, to the mean of the required passes' duals, with
 * what blossoms have added. */
static void set_potentials(const blossom_sets *state, const thr_matching *matching,
                           thr_turning_dual *dual)
{
  const thr_pass_matching *passes = state->passes;
  int halves = 2 * passes->c->f->n_edges;
  for (int i = 0; i < passes->n_places; i++) {
    int needed = thr_pass_needed(passes, i);
    int64_t sum = state->more[i];
    for (int k = 0; k < needed; k++)
      sum += matching->dual[passes->first[i] + k] - passes->lift;
    *(i < halves ? &dual->potential[i] : &dual->ends[i - halves]) =
        needed ? floor_div(sum * (INT64_C(1) << (passes->bits - 1)), needed) : 0;
  }
}

/* Lowers potentials where a cord may turn back. Two passes of half-edge h pay for the turn back,
 * whose duals may be unequal: twice the potential is made no more than the price, and the odd set
 * of h alone takes the rest. */
static thr_status settle_backs(const thr_pass_matching *passes, const int64_t *price,
                               thr_turning_dual *dual, thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  thr_status st = THR_OK;
  for (int j = columns->first_back; j < columns->n_columns && !st; j++) {
    int h = columns->half[j][0];
    int64_t above = dual->potential[h] - floor_div(price[j], 2);
    if (above <= 0) continue;

    dual->potential[h] -= above;
    if (columns->cover[h >> 1] % 2) st = add_set(dual, &h, 1, above, err);
  }
  return st;
}

/* Appends the odd sets of a matching to the dual, and sets potentials and multipliers of ends. */
thr_status thr_pass_dual(const thr_pass_matching *passes, const thr_matching *matching,
                         const int64_t *price, thr_turning_dual *dual, thr_err *err)
{
  size_t places = (size_t)passes->n_places, nodes = (size_t)passes->first[places],
         blossoms = (size_t)matching->n_blossoms,
         backs = (size_t)(passes->c->n_columns - passes->c->first_back);

  thr_scratch own = {0};
  blossom_sets state = {.passes = passes,
                        .home = thr_scratch_array(&own, nodes, sizeof *state.home),
                        .count = thr_scratch_array(&own, places, sizeof *state.count),
                        .touched = thr_scratch_array(&own, places, sizeof *state.touched),
                        .more = thr_scratch_array(&own, places, sizeof *state.more)};
  blossom_list list = {.first = thr_scratch_array(&own, blossoms, sizeof *list.first),
                       .size = thr_scratch_array(&own, blossoms, sizeof *list.size),
                       .node = thr_scratch_array(&own, nodes, sizeof *list.node)};
  int *next = thr_scratch_array(&own, blossoms, sizeof *next);
  thr_status st = thr_scratch_check(&own, err);

  /* At most one odd set per blossom and per turn back. */
  thr_turning_set *odd =
      st ? NULL : thr_realloc(dual->odd, (size_t)dual->n_odd + blossoms + backs, sizeof *odd);
  if (!st && !odd) st = thr_nomem(err);
  if (odd) dual->odd = odd;

  /* The first passes of a place are those that must be made. */
  for (int i = 0; i < passes->n_places && !st; i++)
    for (int k = passes->first[i]; k < passes->first[i + 1]; k++)
      state.home[k] = k - passes->first[i] < thr_pass_needed(passes, i) ? i : -1;

  if (!st) list_blossoms(matching, (int)nodes, next, &list);
  if (!st) st = take_sets(&state, matching, &list, dual, err);
  if (!st) set_potentials(&state, matching, dual);
  if (!st) st = settle_backs(passes, price, dual, err);

  thr_scratch_free(&own);
  return st;
}

/* ---- what is left of prices ---- */

/* Gives turns between half-edge h and later members of the marked set the value back that both
 * their half-edges pay: such a turn does not leave the set. */
static void give_back(const thr_turning_columns *columns, int h, const thr_turning_set *set,
                      const bool *member, int64_t *left)
{
  int v = thr_tail(columns->f, h), halves = 2 * columns->f->n_edges;

  /* Go through the node's edges or the set, whichever is shorter. */
  if (set->n > thr_degree(columns->f, v)) {
    for (int i = columns->f->first[v]; i < columns->f->first[v + 1]; i++)
      if (columns->f->half[i] > h && member[columns->f->half[i]])
        left[thr_turning_column(columns, h, columns->f->half[i])] += 2 * set->value;
    return;
  }

  for (int k = 0; k < set->n && set->member[k] < halves; k++)
    if (set->member[k] > h && thr_tail(columns->f, set->member[k]) == v)
      left[thr_turning_column(columns, h, set->member[k])] += 2 * set->value;
}

/* Subtracts a set's value from the columns at its half-edges that leave the set. open[n_nodes]
 * marks nodes whose turns are asked for; paid[2 n_edges] collects what all sets take off the turns
 * of a half-edge, including turns within a set. */
static void take_set_off(const thr_turning_columns *columns, const thr_turning_set *set,
                         const bool *member, const bool *open, int64_t *paid, int64_t *left)
{
  int halves = 2 * columns->f->n_edges;
  bool ends = set->member[set->n - 1] >= halves; /* members ascend */

  /* A set that holds ends is left by all ends of the group at other half-edges. */
  for (int j = columns->first_end; ends && j < columns->first_back; j++)
    if (member[halves + columns->end_group[thr_tail(columns->f, columns->half[j][0])]] &&
        !member[columns->half[j][0]])
      left[j] -= set->value;

  /* Turns, extra passes and ends at the set's half-edges. */
  for (int k = 0; k < set->n && set->member[k] < halves; k++) {
    int h = set->member[k], v = thr_tail(columns->f, h);
    paid[h] += set->value;
    if (!member[h ^ 1]) left[columns->first_extra + (h >> 1)] -= set->value;
    if (open[v]) give_back(columns, h, set, member, left);
    if (columns->end_column[h] >= 0 && !member[halves + columns->end_group[v]])
      left[columns->end_column[h]] -= set->value;
  }
}

/* Computes the reduced prices that potentials and the odd sets from first_odd on leave. */
thr_status thr_pass_left(const thr_pass_matching *passes, const int64_t *price,
                         const thr_turning_dual *dual, int first_odd, bool all, int64_t *left,
                         thr_err *err)
{
  const thr_turning_columns *columns = passes->c;
  thr_scratch own = {0};
  bool *member = thr_scratch_array(&own, (size_t)passes->n_places, sizeof *member),
       *open = thr_scratch_array(&own, (size_t)columns->f->n_nodes, sizeof *open);
  int64_t *paid = thr_scratch_array(&own, 2 * (size_t)columns->f->n_edges, sizeof *paid);
  thr_status st = thr_scratch_check(&own, err);

  /* What the equations leave. Nodes whose turns are all listed are not looked at further. */
  for (int j = 0; j < columns->first_back && !st; j++) {
    int a = columns->half[j][0], b = columns->half[j][1];
    int64_t both =
        dual->potential[a] +
        (b >= 0 ? dual->potential[b] : dual->ends[columns->end_group[thr_tail(columns->f, a)]]);
    left[j] = price[j] + (j >= columns->first_extra && j < columns->first_end ? both : -both);

    if (all || !passes->listed[j]) open[thr_tail(columns->f, a)] = true;
  }

  /* What the odd sets take off; turns are charged at the end, for both their half-edges. */
  for (int i = first_odd; i < dual->n_odd && !st; i++) {
    const thr_turning_set *set = &dual->odd[i];
    for (int k = 0; k < set->n; k++)
      member[set->member[k]] = true;

    take_set_off(columns, set, member, open, paid, left);
    for (int k = 0; k < set->n; k++)
      member[set->member[k]] = false;
  }

  for (int j = 0; j < columns->first_extra && !st; j++)
    left[j] -= paid[columns->half[j][0]] + paid[columns->half[j][1]];
  thr_scratch_free(&own);
  return st;
}
