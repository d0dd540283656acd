/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lifts a solution of a contraction: finds the turns of the cells that were contracted; and
 * contracts a solution.
 *
 * In a cell, every orbit of darts gets a partner of a type that its own turns into. The type with
 * the most darts left gets the cheapest partner after which the rest can still be paired: no type
 * may have more darts than all others together. With tube joints turns that join tubes are taken
 * first, those that join most before others. Cells where this greedy search fails are kept in the
 * next contraction, which decides their turns itself.
 *
 * Example: three types with 2, 1 and 1 darts: the first is paired with both others, which could not
 * be if these were paired with each other first. */
#include "graph/arrays.h"
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"

#include <stdlib.h>
#include <string.h>

/* What is left to be paired, in the whole and in the present cell. */
typedef struct {
  const thr_contraction *contraction;
  int *value; /* of the whole programme */
  int *left;  /* [n_darts] orbits of darts without a partner */
  int *first,
      *types;   /* dart types of the cell with lowest type d: types[first[d] .. first[d + 1] - 1] */
  int *selves;  /* [n_darts] by lowest type: self pairs that are still to be taken */
  bool *failed; /* [n_darts] by lowest type */
  int n_types, *type; /* of the present cell */
  int *parent, *next; /* [ties->most] tubes of the present star, joined so far; scratch */
  bool stopped;       /* by the limits */
} cell_lifting;

/* Frees what lifting_init has allocated, all of it or a part. */
static void lifting_destroy(cell_lifting *lifting)
{
  free(lifting->left);
  free(lifting->first);
  free(lifting->types);
  free(lifting->selves);
  free(lifting->failed);
  free(lifting->parent);
  free(lifting->next);
}

/* Starts with the copies of the contracted solution, all of whose darts are left, and lists the
 * types of all cells; the caller destroys lifting also on failure. */
static thr_status lifting_init(cell_lifting *lifting, const thr_contraction *contraction,
                               const int *small, int *value, thr_err *err)
{
  const thr_quotient *quotient = contraction->whole->q;
  size_t n_darts = (size_t)quotient->n_darts,
         tubes = contraction->whole->ties ? (size_t)contraction->whole->ties->most : 0;
  /* Nothing is used or joined yet. */
  *lifting = (cell_lifting){.contraction = contraction,
                            .value = value,
                            .left = thr_calloc(n_darts, sizeof *lifting->left)};
  lifting->first = thr_calloc(n_darts + 2, sizeof *lifting->first);
  lifting->types = thr_calloc(n_darts, sizeof *lifting->types);
  lifting->selves = thr_calloc(n_darts, sizeof *lifting->selves);
  lifting->failed = thr_calloc(n_darts, sizeof *lifting->failed);
  lifting->parent = thr_calloc(tubes, sizeof *lifting->parent);
  lifting->next = thr_calloc(tubes, sizeof *lifting->next);

  if (!lifting->left || !lifting->first || !lifting->types || !lifting->selves ||
      !lifting->failed || !lifting->parent || !lifting->next)
    return thr_nomem(err);

  /* Copies, and their darts. */
  memset(value, 0, (size_t)contraction->whole->n * sizeof *value);
  for (int copy = 0; copy < quotient->n_copies; copy++) {
    value[copy] = small[copy];
    for (int i = 0; i < (quotient->copy[copy].fold ? 1 : 2); i++)
      lifting->left[quotient->copy[copy].dart[i]] += small[copy];
  }

  /* Types by cell: count, two places further on, and fill. */
  for (int dart = 0; dart < quotient->n_darts; dart++)
    lifting->first[contraction->root[dart] + 2]++;
  for (int dart = 1; dart < quotient->n_darts; dart++)
    lifting->first[dart + 1] += lifting->first[dart];
  for (int dart = 0; dart < quotient->n_darts; dart++)
    lifting->types[lifting->first[contraction->root[dart] + 1]++] = dart;

  return THR_OK;
}

/* Tells whether the limits of the programme say so; remembers that. */
static bool should_stop(cell_lifting *lifting)
{
  lifting->stopped =
      lifting->stopped || thr_programme_check_time(lifting->contraction->whole) != THR_OK;
  return lifting->stopped;
}

/* Makes this cell the present one. */
static void enter_cell(cell_lifting *lifting, int root)
{
  lifting->type = lifting->types + lifting->first[root];
  lifting->n_types = lifting->first[root + 1] - lifting->first[root];
}

/* ---- one cell ---- */

/* Returns the type of the cell with the most darts left, or -1 if none has any. */
static int most_left(const cell_lifting *lifting)
{
  int best = -1;
  for (int i = 0; i < lifting->n_types; i++)
    if (lifting->left[lifting->type[i]] > 0 &&
        (best < 0 || lifting->left[lifting->type[i]] > lifting->left[best]))
      best = lifting->type[i];
  return best;
}

/* Returns the column that ends one trail at this dart type, a cord end or the cheapest self pair,
 * or -1 if there is none. */
static int terminal_of(const thr_programme *programme, int dart, bool self)
{
  const double *cost = programme->cost[THR_AIM_TURNING];
  int best = -1;
  if (!self)
    return programme->most[programme->first_end + dart] != 0 ? programme->first_end + dart : -1;

  /* Of the self pairs the cheapest. */
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++) {
    const int j = programme->first_pair + programme->incident[k];
    if (programme->q->pair[programme->incident[k]].self && programme->most[j] != 0 &&
        (best < 0 || cost[j] < cost[best]))
      best = j;
  }
  return best;
}

/* Takes so many ends, or self pairs, always of the type with the most darts left. Returns false if
 * there are none. */
static bool take_terminals(cell_lifting *lifting, bool self, int count)
{
  const thr_programme *programme = lifting->contraction->whole;
  for (; count > 0; count--) {
    /* The type with the most darts left that may end. */
    int best = -1;
    for (int i = 0; i < lifting->n_types; i++) {
      int dart = lifting->type[i];
      if (lifting->left[dart] > 0 && terminal_of(programme, dart, self) >= 0 &&
          (best < 0 || lifting->left[dart] > lifting->left[best]))
        best = dart;
    }

    if (best < 0) return false;
    lifting->value[terminal_of(programme, best, self)]++;
    lifting->left[best]--;
  }
  return true;
}

/* Tells whether the rest can be paired: a type without a turn to itself may have no more darts than
 * all others and the self pairs together. */
static bool can_pair_rest(const cell_lifting *lifting)
{
  int sum = 0, selves = lifting->selves[lifting->contraction->root[lifting->type[0]]];

  for (int i = 0; i < lifting->n_types; i++)
    sum += lifting->left[lifting->type[i]];

  /* Is some type too many? */
  for (int i = 0; i < lifting->n_types; i++)
    if (2 * lifting->left[lifting->type[i]] > sum + selves &&
        !thr_programme_loop(lifting->contraction->whole, lifting->type[i]))
      return false;
  return (sum - selves) % 2 == 0;
}

/* Takes a pair column once more (sign 1), or once less (-1). */
static void use_pair(cell_lifting *lifting, int j, int sign)
{
  const int *type = lifting->contraction->whole->join[j];
  bool self = thr_programme_terminal(lifting->contraction->whole, j);
  lifting->value[j] += sign;
  lifting->left[type[0]] -= sign;
  if (self) lifting->selves[lifting->contraction->root[type[0]]] -= sign;
  if (!self) lifting->left[type[1]] -= sign;
}

/* Tells whether a pair column is allowed and has darts left for it. */
static bool is_usable(const cell_lifting *lifting, int j)
{
  int a = lifting->contraction->whole->join[j][0], b = lifting->contraction->whole->join[j][1];
  if (lifting->contraction->whole->most[j] == 0) return false;
  if (thr_programme_terminal(lifting->contraction->whole, j))
    return lifting->left[a] > 0 && lifting->selves[lifting->contraction->root[a]] > 0;
  return lifting->left[a] > (a == b) && lifting->left[b] > 0;
}

/* Gives dart type a, which has the most darts left, the cheapest partner after which the rest can
 * be paired. Returns false if there is none. */
static bool pair_one(cell_lifting *lifting, int a)
{
  const thr_programme *programme = lifting->contraction->whole;
  const double *cost = programme->cost[THR_AIM_TURNING];
  int best = -1;

  /* Try each, and take it back. */
  for (int k = programme->first[a]; k < programme->first[a + 1]; k++) {
    int j = programme->first_pair + programme->incident[k];
    if (programme->q->pair[programme->incident[k]].self || !is_usable(lifting, j) ||
        (best >= 0 && cost[j] >= cost[best]))
      continue;
    use_pair(lifting, j, 1);
    if (can_pair_rest(lifting)) best = j;
    use_pair(lifting, j, -1);
  }

  if (best < 0) return false;
  use_pair(lifting, best, 1);
  return true;
}

/* Takes the cord ends of a cell, and counts its self pairs, which are taken later. Returns false if
 * the darts cannot be paired then. */
static bool end_trails(cell_lifting *lifting, const int *small)
{
  const thr_programme *programme = &lifting->contraction->p;
  int dart = lifting->contraction->becomes[lifting->type[0]],
      *selves = &lifting->selves[lifting->contraction->root[lifting->type[0]]];

  /* Self pairs, of the cell's one self pair type. */
  for (int k = programme->first[dart]; k < programme->first[dart + 1]; k++)
    if (programme->q->pair[programme->incident[k]].self)
      *selves += small[programme->first_pair + programme->incident[k]];

  return take_terminals(lifting, false, small[programme->first_end + dart]) &&
         can_pair_rest(lifting);
}

/* Takes the self pairs of a cell, and pairs what is left. Returns false if that fails. */
static bool pair_rest(cell_lifting *lifting)
{
  int *selves = &lifting->selves[lifting->contraction->root[lifting->type[0]]], count = *selves;
  *selves = 0;
  if (!take_terminals(lifting, true, count) || !can_pair_rest(lifting)) return false;

  for (int a; (a = most_left(lifting)) >= 0;)
    if (should_stop(lifting) || !pair_one(lifting, a)) return false;
  return true;
}

/* ---- tubes ---- */

/* Tells whether the cell of a pair type is kept. */
static bool cell_kept(const thr_contraction *contraction, int pair)
{
  return contraction->keep[contraction->root[contraction->whole->q->pair[pair].dart[0]]];
}

/* Joins the tubes that a turn of this pair type links; returns how many joins there were. */
static int join_tubes(const thr_ties *ties, int pair, int *parent)
{
  int joined = 0;
  for (int k = ties->join[pair]; k < ties->join[pair + 1]; k++)
    joined += thr_disjoint_join(parent, ties->link[k][0], ties->link[k][1]);
  return joined;
}

/* Tells whether a turn of this pair type can be taken: then all blocks of tubes must still be
 * connectable, each by some turn that is left, and the rest of the cell be paired. */
static bool keeps_feasible(cell_lifting *lifting, int star, int pair)
{
  const thr_programme *programme = lifting->contraction->whole;
  const thr_ties *ties = programme->ties;
  int blocks = 0, open = 0;

  /* The blocks with this turn. */
  memcpy(lifting->next, lifting->parent, (size_t)ties->degree[star] * sizeof *lifting->next);
  join_tubes(ties, pair, lifting->next);
  for (int i = 0; i < ties->degree[star]; i++)
    blocks += lifting->next[i] == i;

  /* Marks the root of every block that a turn which is still possible leads to another block. */
  use_pair(lifting, programme->first_pair + pair, 1);
  bool good = can_pair_rest(lifting);
  for (int i = ties->first[star]; i < ties->first[star + 1] && good && blocks > 1; i++) {
    int other = ties->pair[i], j = programme->first_pair + other;
    if (cell_kept(lifting->contraction, other) || !is_usable(lifting, j)) continue;
    for (int k = ties->join[other]; k < ties->join[other + 1]; k++) {
      /* A marked root is -1 - root. */
      int first = ties->link[k][0], second = ties->link[k][1];
      while (lifting->next[first] >= 0 && lifting->next[first] != first)
        first = lifting->next[first];
      while (lifting->next[second] >= 0 && lifting->next[second] != second)
        second = lifting->next[second];
      if (first == second) continue;
      lifting->next[first] = -1 - first;
      lifting->next[second] = -1 - second;
    }
  }

  /* Is every block marked? Then take the turn back. */
  for (int i = 0; i < ties->degree[star]; i++)
    open += lifting->next[i] < 0;
  use_pair(lifting, programme->first_pair + pair, -1);
  return good && (blocks == 1 || open == blocks);
}

/* Returns how many joins of tubes a turn of this pair type would add. */
static int count_joins(cell_lifting *lifting, int star, int pair)
{
  const thr_ties *ties = lifting->contraction->whole->ties;
  bool any = false;
  /* Does it join any two blocks at all? */
  for (int k = ties->join[pair]; k < ties->join[pair + 1]; k++)
    any = any || thr_disjoint_find(lifting->parent, ties->link[k][0]) !=
                     thr_disjoint_find(lifting->parent, ties->link[k][1]);

  if (!any) return 0;
  memcpy(lifting->next, lifting->parent, (size_t)ties->degree[star] * sizeof *lifting->next);
  return join_tubes(ties, pair, lifting->next);
}

/* Joins the tubes of a star with turns of the cells that are not kept: those that join the most
 * tubes, of several the cheapest, until no turn joins any. */
static void tie_star(cell_lifting *lifting, int star, const int *small)
{
  const thr_contraction *contraction = lifting->contraction;
  const thr_programme *programme = contraction->whole;
  const thr_ties *ties = programme->ties;
  const double *cost = programme->cost[THR_AIM_TURNING] + programme->first_pair;

  /* Tubes that the turns so far join. */
  for (int i = 0; i < ties->degree[star]; i++)
    lifting->parent[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int pair = ties->pair[i];
    if ((cell_kept(contraction, pair) ? small[contraction->p.first_pair + contraction->pair[pair]]
                                      : lifting->value[programme->first_pair + pair]) > 0)
      join_tubes(ties, pair, lifting->parent);
  }

  /* One more turn, as long as one joins tubes. */
  for (int best = 0; best >= 0;) {
    int most = 0;
    best = -1;
    for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
      int pair = ties->pair[i], j = programme->first_pair + pair;
      if (cell_kept(contraction, pair) || !is_usable(lifting, j)) continue;

      /* It has to join tubes, no fewer and not at a higher price than the best so far. */
      int joins = count_joins(lifting, star, pair);
      if (joins == 0 || joins < most || (joins == most && cost[pair] >= cost[best])) continue;
      if (should_stop(lifting)) return;

      enter_cell(lifting, contraction->root[programme->q->pair[pair].dart[0]]);
      if (!keeps_feasible(lifting, star, pair)) continue;

      most = joins;
      best = pair;
    }

    if (best < 0) break;
    use_pair(lifting, programme->first_pair + best, 1);
    join_tubes(ties, best, lifting->parent);
  }
}

/* Sets failed for the cells of a star whose turns do not tie it. */
static void check_star(cell_lifting *lifting, int star, const int *small)
{
  const thr_contraction *contraction = lifting->contraction;
  const thr_ties *ties = contraction->whole->ties;
  bool tied = true;

  /* Tubes that the turns join. */
  for (int i = 0; i < ties->degree[star]; i++)
    lifting->parent[i] = i;
  for (int i = ties->first[star]; i < ties->first[star + 1]; i++) {
    int pair = ties->pair[i];
    if ((cell_kept(contraction, pair) ? small[contraction->p.first_pair + contraction->pair[pair]]
                                      : lifting->value[contraction->whole->first_pair + pair]) > 0)
      join_tubes(ties, pair, lifting->parent);
  }

  /* Are they all connected? */
  for (int i = 1; i < ties->degree[star]; i++)
    tied = tied && thr_disjoint_find(lifting->parent, i) == thr_disjoint_find(lifting->parent, 0);
  for (int i = ties->first[star]; i < ties->first[star + 1] && !tied; i++)
    lifting->failed[contraction->root[contraction->whole->q->pair[ties->pair[i]].dart[0]]] = true;
}

/* ---- the whole solution ---- */

/* Copies the turns and ends of cells that are kept: the contracted solution has them. */
static void copy_kept(const thr_contraction *contraction, const int *small, int *value)
{
  const thr_quotient *quotient = contraction->whole->q;
  /* Turns. */
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    if (contraction->keep[contraction->root[quotient->pair[pair].dart[0]]])
      value[contraction->whole->first_pair + pair] =
          small[contraction->p.first_pair + contraction->pair[pair]];

  /* Ends. */
  for (int dart = 0; dart < quotient->n_darts; dart++)
    if (contraction->keep[contraction->root[dart]])
      value[contraction->whole->first_end + dart] =
          small[contraction->p.first_end + contraction->becomes[dart]];
}

void thr_contraction_lower(const thr_contraction *contraction, const int *value, int *small)
{
  const thr_quotient *quotient = contraction->whole->q;
  memset(small, 0, (size_t)contraction->p.n * sizeof *small);
  memcpy(small, value, (size_t)quotient->n_copies * sizeof *small);

  /* Turns and ends of all types that became one. */
  for (int pair = 0; pair < quotient->n_pairs; pair++)
    if (contraction->pair[pair] >= 0)
      small[contraction->p.first_pair + contraction->pair[pair]] +=
          value[contraction->whole->first_pair + pair];
  for (int dart = 0; dart < quotient->n_darts; dart++)
    small[contraction->p.first_end + contraction->becomes[dart]] +=
        value[contraction->whole->first_end + dart];
}

thr_status thr_contraction_lift(thr_contraction *contraction, const int *small, int *value,
                                int *kept, thr_err *err)
{
  const int n_darts = contraction->whole->q->n_darts,
            stars = contraction->whole->ties ? contraction->whole->ties->n : 0;
  cell_lifting lifting;
  *kept = 0;
  thr_status st = lifting_init(&lifting, contraction, small, value, err);

  /* Ends first, in all cells. */
  for (int dart = 0; dart < n_darts && !st; dart++) {
    enter_cell(&lifting, dart);
    if (!contraction->keep[dart] && lifting.n_types > 0)
      lifting.failed[dart] = !end_trails(&lifting, small);
  }

  /* Tie. */
  for (int i = 0; i < stars && !st; i++)
    tie_star(&lifting, i, small);

  /* Pair what is left. */
  for (int dart = 0; dart < n_darts && !st; dart++) {
    enter_cell(&lifting, dart);
    if (!contraction->keep[dart] && lifting.n_types > 0)
      lifting.failed[dart] = lifting.failed[dart] || !pair_rest(&lifting);
  }

  /* Are the nodes tied? */
  for (int i = 0; i < stars && !st; i++)
    check_star(&lifting, i, small);

  /* Cells that failed are kept from now on. */
  for (int dart = 0; dart < n_darts && !st; dart++) {
    if (contraction->keep[dart] || !lifting.failed[dart]) continue;
    contraction->keep[dart] = true;
    ++*kept;
  }

  /* Only a solution without failures is whole. */
  if (lifting.stopped && !st) st = THR_ELIMIT;
  if (!st && *kept == 0) copy_kept(contraction, small, value);

  lifting_destroy(&lifting);
  return st;
}
