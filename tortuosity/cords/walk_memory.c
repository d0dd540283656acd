/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the walks of a programme remember edges, so that a walk does not earn an edge's price again
 * and again by going round the edge. Internal to tortuosity/.
 *
 * The recursion over walks is a relaxation: a walk that passes an edge twice counts as two of the
 * passes that plans need, although an edge with one needed pass is served by the first. Where the
 * optimum uses such a walk, the edge is remembered from now on at all places between its two
 * passes, and the second pass does not earn anything there (ng-routes that grow: R. Roberti & A.
 * Mingozzi, Transportation Science 48, 2014; graph/plan/walk_proof.h). The recursion, its table and
 * the rows of all known walks are then made anew.
 *
 * Example: a walk passes the edges a b c a d. Edge a is remembered at the places after a, b and c,
 * and the second pass of a earns 0. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/walk_model.h"

#include <stdlib.h>
#include <string.h>

enum {
  MOST_ROUNDS = 60,      /* that one look adds */
  MOST_THERE = 8,        /* edges remembered at a place */
  MOST_ENTRIES = 1 << 24 /* of the recursion's table */
};
static const double most_steps = 4e8;       /* of all recursions for a look at the prices */
static const double most_pull_steps = 12e7; /* with a pull */

/* ---- lists ---- */

/* Copies n lists to *to, the caller's. */
static thr_status copy_memory(const thr_walk_memory *from, int n, thr_walk_memory **to,
                              thr_err *err)
{
  thr_walk_memory *made = thr_calloc((size_t)n, sizeof *made);

  /* Each list with its places; on failure those before it are freed. */
  for (int i = 0; i < n && made; i++) {
    made[i] = from[i];
    made[i].place = thr_calloc((size_t)from[i].n, sizeof *made[i].place);
    if (!made[i].place) {
      thr_walk_memory_free(made, i);
      return thr_nomem(err);
    }
    memcpy(made[i].place, from[i].place, (size_t)from[i].n * sizeof *made[i].place);
  }
  if (!made) return thr_nomem(err);
  *to = made;
  return THR_OK;
}

/* The prices and arrays of trial move to the proof; trial gets new arrays. */
thr_status thr_walk_take_proof(thr_walk_programme *programme, thr_walk_proof *proof, thr_err *err)
{
  thr_walk_memory *memory = NULL;
  thr_status st = copy_memory(programme->memory, programme->n_memories, &memory, err);
  if (st) return st;

  /* The programme keeps its own lists; the proof gets the copies. */
  thr_walk_proof_destroy(proof);
  *proof = programme->trial;
  proof->memory = memory;
  proof->n_memories = programme->n_memories;

  /* An empty trial with the same units. */
  programme->trial =
      (thr_walk_proof){.unit = proof->unit, .bits = proof->bits, .pulled = proof->pulled};
  programme->trial.edge =
      thr_calloc((size_t)programme->c->f->n_edges, sizeof *programme->trial.edge);
  programme->trial.node =
      thr_calloc((size_t)programme->c->f->n_nodes, sizeof *programme->trial.node);
  return programme->trial.edge && programme->trial.node ? THR_OK : thr_nomem(err);
}

/* Returns the list of an edge, in ascending order of edges; an empty list is inserted if there is
 * none. NULL: memory runs out. */
static thr_walk_memory *list_of(thr_walk_programme *programme, int edge)
{
  int i = 0;
  while (i < programme->n_memories && programme->memory[i].edge < edge)
    i++;
  if (i < programme->n_memories && programme->memory[i].edge == edge) return &programme->memory[i];

  /* Insert an empty list at i. */
  thr_walk_memory *longer =
      thr_realloc(programme->memory, (size_t)programme->n_memories + 1, sizeof *longer);
  if (!longer) return NULL;
  memmove(longer + i + 1, longer + i, (size_t)(programme->n_memories - i) * sizeof *longer);
  longer[i] = (thr_walk_memory){.edge = edge};
  programme->memory = longer;
  programme->n_memories++;
  return &longer[i];
}

/* Inserts a place into a list in ascending order. *is_new: the list did not hold the place before.
 */
static thr_status add_place(thr_walk_memory *list, int place, bool *is_new, thr_err *err)
{
  int i = 0;
  while (i < list->n && list->place[i] < place)
    i++;
  *is_new = i == list->n || list->place[i] != place;
  if (!*is_new) return THR_OK;

  /* Insert the place at i. */
  int *longer = thr_realloc(list->place, (size_t)list->n + 1, sizeof *longer);
  if (!longer) return thr_nomem(err);
  memmove(longer + i + 1, longer + i, (size_t)(list->n - i) * sizeof *longer);
  longer[i] = place;
  list->place = longer;
  list->n++;
  return THR_OK;
}

/* ---- rounds ---- */

/* A part of a walk that comes back to an edge: passes number `from` and `to` are of the same edge.
 */
typedef struct {
  const int *half;
  int from, to;
  double weight; /* of the walk's column */
} walk_round;

/* Orders rounds: shortest first, then those of the largest column, then by their first edge. */
static int compare(const void *a, const void *b)
{
  const walk_round *first = a, *second = b;
  const int more = (first->to - first->from) - (second->to - second->from);
  if (more) return more;
  if (first->weight != second->weight) return first->weight > second->weight ? -1 : 1;
  return (first->half[first->from] > second->half[second->from]) -
         (first->half[first->from] < second->half[second->from]);
}

/* Returns the place of a walk after a pass: its node if lengths count, else its half-edge. */
static int place_after(const thr_walk_programme *programme, int half)
{
  return programme->steps.measure == THR_WALK_LENGTH ? thr_head(programme->c->f, half) : half;
}

/* Finds the rounds of the walks in the last optimum: from each pass of an edge to the next pass of
 * the same edge, for edges that need one pass. Returns their number. last: [n_edges] scratch. list:
 * NULL, or receives the rounds. */
static int find_rounds(const thr_walk_programme *programme, int *last, walk_round *list)
{
  const thr_search *search = &programme->search;
  const double little = 1e-3;
  int n = 0;

  for (int i = 0; i < search->pool.count && i < search->n_dual; i++) {
    const thr_row *row = &search->pool.row[i];
    if (search->dual[i] < little) continue;

    /* Along a walk that the optimum uses, keep each edge's last pass. */
    for (int e = 0; e < programme->c->f->n_edges; e++)
      last[e] = -1;
    for (int k = 0; k < row->n_members; k++) {
      const int e = row->member[k] >> 1, before = last[e];
      last[e] = k;
      if (before < 0 || programme->c->cover[e] != 1) continue;
      if (list)
        list[n] =
            (walk_round){.half = row->member, .from = before, .to = k, .weight = search->dual[i]};
      n++;
    }
  }
  return n;
}

/* Says whether every place of a round remembers fewer edges than it may; there[place]: their
 * number. */
static bool has_room(const thr_walk_programme *programme, const walk_round *round, const int *there)
{
  for (int k = round->from; k < round->to; k++)
    if (there[place_after(programme, round->half[k])] >= MOST_THERE) return false;
  return true;
}

/* Remembers the edge of a round at all of the round's places. *added grows by the number of places
 * that did not remember the edge before. */
static thr_status add_round(thr_walk_programme *programme, const walk_round *round, int *there,
                            int *added, thr_err *err)
{
  thr_walk_memory *list = list_of(programme, round->half[round->from] >> 1);
  thr_status st = list ? THR_OK : thr_nomem(err);

  /* From behind the first pass of the edge to before the second. */
  for (int k = round->from; k < round->to && !st; k++) {
    const int place = place_after(programme, round->half[k]);
    bool is_new = false;
    st = add_place(list, place, &is_new, err);
    if (st || !is_new) continue;
    there[place]++;
    ++*added;
  }
  return st;
}

/* Remembers the shortest rounds of the last optimum, at most MOST_ROUNDS, as far as their places
 * have room. */
static thr_status add_rounds(thr_walk_programme *programme, int *added, thr_err *err)
{
  thr_scratch own = {0};
  const size_t m = (size_t)programme->c->f->n_edges, n = (size_t)programme->c->f->n_nodes;
  int *last = thr_scratch_array(&own, m, sizeof *last),
      *there = thr_scratch_array(&own, 2 * m + n, sizeof *there);
  thr_status st = thr_scratch_check(&own, err);

  /* Count the rounds, then list and sort them. */
  const int count = st ? 0 : find_rounds(programme, last, NULL);
  walk_round *list = thr_scratch_array(&own, (size_t)count, sizeof *list);
  if (!st) st = thr_scratch_check(&own, err);
  if (!st) find_rounds(programme, last, list);
  if (!st && count > 0) qsort(list, (size_t)count, sizeof *list, compare);

  /* Number of edges that every place remembers already. */
  for (int i = 0; i < programme->n_memories && !st; i++)
    for (int k = 0; k < programme->memory[i].n; k++)
      there[programme->memory[i].place[k]]++;

  /* Rounds that are remembered already add nothing and do not count. */
  for (int i = 0, rounds = 0; i < count && rounds < MOST_ROUNDS && !st; i++) {
    const int before = *added;
    if (has_room(programme, &list[i], there))
      st = add_round(programme, &list[i], there, added, err);
    rounds += *added > before;
  }
  thr_scratch_free(&own);
  return st;
}

/* ---- the recursion anew ---- */

/* Says whether the recursion with its memory is small enough, in entries of its table and in steps.
 */
static bool has_table(const thr_walk_programme *programme)
{
  const double steps = (double)programme->units * programme->steps.first[programme->steps.n] *
                       thr_walk_runs(&programme->steps);
  const double tables = (double)thr_walk_tables(programme->steps.measure);
  return tables * thr_walk_levels(programme->most_units) * programme->steps.n <= MOST_ENTRIES &&
         steps <= (programme->steps.measure == THR_WALK_PULL ? most_pull_steps : most_steps);
}

/* Makes the recursion's steps and table anew with what is remembered now. THR_ELIMIT: they would be
 * too large. */
static thr_status make_steps(thr_walk_programme *programme, thr_err *err)
{
  const thr_walk_measure measure = programme->steps.measure;
  thr_err why = {0};
  thr_walk_steps steps;
  thr_status st = thr_walk_steps_init(&steps, programme->c, measure, programme->component,
                                      programme->unit, err);
  if (st) return st;

  thr_walk_steps_destroy(&programme->steps);
  programme->steps = steps;

  /* A text about the memory is for the caller only if it is not a matter of size. */
  st = thr_walk_steps_remember(&programme->steps, programme->memory, programme->n_memories, &why);
  if (st == THR_EVIOLATED || (!st && !has_table(programme)))
    return thr_fail(err, THR_ELIMIT, "walks remember too much");
  if (st) return thr_fail(err, st, "%s", why.text);

  /* The table. */
  int64_t *value = thr_calloc((size_t)thr_walk_levels(programme->most_units) *
                                  (size_t)programme->steps.n * thr_walk_tables(measure),
                              sizeof *value);
  if (!value) return thr_nomem(err);
  free(programme->value);
  programme->value = value;
  return THR_OK;
}

/* Makes the rows of all known walks anew: passes that are remembered now do not count any more. */
static thr_status count_anew(thr_walk_programme *programme, thr_err *err)
{
  thr_pool counted;
  thr_status st = thr_pool_init(&counted, programme->n_variables, err);
  for (int i = 0; i < programme->walks.count && !st; i++) {
    const thr_row *row = &programme->walks.row[i];

    /* The walk's half-edges stay; its coefficients are counted again. */
    thr_row anew = thr_walk_programme_row(programme, &counted, row->member, row->n_members);
    anew.index = row->index;
    st = thr_pool_add(&counted, anew, err);
  }
  thr_pool_destroy(&programme->walks);
  programme->walks = counted;
  return st;
}

/* Restores the memory before the last addition, for which there is no room. */
static thr_status take_back(thr_walk_programme *programme, thr_walk_memory **before, int n_before,
                            thr_err *err)
{
  thr_walk_memory *more = programme->memory;

  const int n_more = programme->n_memories;
  programme->memory = *before;
  programme->n_memories = n_before;
  *before = NULL;

  /* The steps follow the memory. */
  thr_walk_memory_free(more, n_more);
  return make_steps(programme, err);
}

/* If the larger recursion is too large, the memory stays as it was and *grown is false. */
thr_status thr_walk_remember(thr_walk_programme *programme, bool *grown, thr_err *err)
{
  thr_walk_memory *before = NULL;
  thr_err why = {0};
  const int n_before = programme->n_memories;
  int added = 0;
  *grown = false;
  thr_status st = copy_memory(programme->memory, n_before, &before, err);

  /* The optimum is needed for the rounds; after that the search ends. */
  if (!st && programme->search.outcome == THR_LP_OPTIMAL) st = add_rounds(programme, &added, err);
  if (!st) st = thr_walk_programme_end(programme, err);

  /* The recursion follows the memory, and so do the known walks. */
  if (!st && added > 0) {
    st = make_steps(programme, &why);
    *grown = !st;
    if (st == THR_ELIMIT)
      st = take_back(programme, &before, n_before, err);
    else
      st = st ? thr_fail(err, st, "%s", why.text) : count_anew(programme, err);
  }
  thr_walk_memory_free(before, n_before);
  return st;
}
