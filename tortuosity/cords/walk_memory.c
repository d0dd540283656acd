/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the walks of a programme remember, so that they are not worth going round and round.
 * Internal to tortuosity/. */
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

/* *to: a copy, the caller's. */
static thr_status copy_memory(const thr_walk_memory *from, int n, thr_walk_memory **to,
                              thr_err *err)
{
  thr_walk_memory *made = thr_calloc((size_t)n, sizeof *made);
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

thr_status thr_walk_take_proof(thr_walk_programme *p, thr_walk_proof *proof, thr_err *err)
{
  thr_walk_memory *memory = NULL;
  thr_status st = copy_memory(p->memory, p->n_memories, &memory, err);
  if (st) return st;
  thr_walk_proof_destroy(proof);
  *proof = p->trial;
  proof->memory = memory;
  proof->n_memories = p->n_memories;
  p->trial = (thr_walk_proof){.unit = proof->unit, .bits = proof->bits, .pulled = proof->pulled};
  p->trial.edge = thr_calloc((size_t)p->c->f->n_edges, sizeof *p->trial.edge);
  p->trial.node = thr_calloc((size_t)p->c->f->n_nodes, sizeof *p->trial.node);
  return p->trial.edge && p->trial.node ? THR_OK : thr_nomem(err);
}

/* The list of an edge; begun if there is none. NULL: memory runs out. */
static thr_walk_memory *list_of(thr_walk_programme *p, int edge)
{
  int i = 0;
  while (i < p->n_memories && p->memory[i].edge < edge)
    i++;
  if (i < p->n_memories && p->memory[i].edge == edge) return &p->memory[i];
  thr_walk_memory *longer = thr_realloc(p->memory, (size_t)p->n_memories + 1, sizeof *longer);
  if (!longer) return NULL;
  memmove(longer + i + 1, longer + i, (size_t)(p->n_memories - i) * sizeof *longer);
  longer[i] = (thr_walk_memory){.edge = edge};
  p->memory = longer;
  p->n_memories++;
  return &longer[i];
}

/* *is_new: it was not there before. */
static thr_status add_place(thr_walk_memory *list, int place, bool *is_new, thr_err *err)
{
  int i = 0;
  while (i < list->n && list->place[i] < place)
    i++;
  *is_new = i == list->n || list->place[i] != place;
  if (!*is_new) return THR_OK;
  int *longer = thr_realloc(list->place, (size_t)list->n + 1, sizeof *longer);
  if (!longer) return thr_nomem(err);
  memmove(longer + i + 1, longer + i, (size_t)(list->n - i) * sizeof *longer);
  longer[i] = place;
  list->place = longer;
  list->n++;
  return THR_OK;
}

/* ---- rounds ---- */

/* The passes number from + 1 to to of a walk bring it back over the edge of number from. */
typedef struct {
  const int *half;
  int from, to;
  double weight; /* of the walk's column */
} around;

static int compare(const void *a, const void *b)
{
  const around *x = a, *y = b;
  const int more = (x->to - x->from) - (y->to - y->from);
  if (more) return more;
  if (x->weight != y->weight) return x->weight > y->weight ? -1 : 1;
  return (x->half[x->from] > y->half[y->from]) - (x->half[x->from] < y->half[y->from]);
}

/* Where a walk is after a pass. */
static int place_after(const thr_walk_programme *p, int half)
{
  return p->steps.measure == THR_WALK_LENGTH ? thr_head(p->c->f, half) : half;
}

/* Those of the walks in the last optimum, each from the last pass of an edge to the next; returns
 * their number. last: [n_edges]. list: NULL, or as many. */
static int find_rounds(const thr_walk_programme *p, int *last, around *list)
{
  const thr_search *search = &p->search;
  const double little = 1e-3;
  int n = 0;
  for (int i = 0; i < search->pool.count && i < search->n_dual; i++) {
    const thr_row *row = &search->pool.row[i];
    if (search->dual[i] < little) continue;
    for (int e = 0; e < p->c->f->n_edges; e++)
      last[e] = -1;
    for (int k = 0; k < row->n_members; k++) {
      const int e = row->member[k] >> 1, before = last[e];
      last[e] = k;
      if (before < 0 || p->c->cover[e] != 1) continue;
      if (list)
        list[n] = (around){.half = row->member, .from = before, .to = k, .weight = search->dual[i]};
      n++;
    }
  }
  return n;
}

/* Is there room at every place of a round? */
static bool has_room(const thr_walk_programme *p, const around *round, const int *there)
{
  for (int k = round->from; k < round->to; k++)
    if (there[place_after(p, round->half[k])] >= MOST_THERE) return false;
  return true;
}

/* *added grows by the places at which its edge is remembered now, and was not. */
static thr_status add_round(thr_walk_programme *p, const around *round, int *there, int *added,
                            thr_err *err)
{
  thr_walk_memory *list = list_of(p, round->half[round->from] >> 1);
  thr_status st = list ? THR_OK : thr_nomem(err);
  for (int k = round->from; k < round->to && !st; k++) {
    const int place = place_after(p, round->half[k]);
    bool is_new = false;
    st = add_place(list, place, &is_new, err);
    if (st || !is_new) continue;
    there[place]++;
    ++*added;
  }
  return st;
}

static thr_status add_rounds(thr_walk_programme *p, int *added, thr_err *err)
{
  thr_scratch own = {0};
  const size_t m = (size_t)p->c->f->n_edges, n = (size_t)p->c->f->n_nodes;
  int *last = thr_scratch_array(&own, m, sizeof *last),
      *there = thr_scratch_array(&own, 2 * m + n, sizeof *there);
  thr_status st = thr_scratch_check(&own, err);
  const int count = st ? 0 : find_rounds(p, last, NULL);
  around *list = thr_scratch_array(&own, (size_t)count, sizeof *list);
  if (!st) st = thr_scratch_check(&own, err);
  if (!st) find_rounds(p, last, list);
  if (!st && count > 0) qsort(list, (size_t)count, sizeof *list, compare);
  for (int i = 0; i < p->n_memories && !st; i++)
    for (int k = 0; k < p->memory[i].n; k++)
      there[p->memory[i].place[k]]++;
  for (int i = 0, rounds = 0; i < count && rounds < MOST_ROUNDS && !st; i++) {
    const int before = *added;
    if (has_room(p, &list[i], there)) st = add_round(p, &list[i], there, added, err);
    rounds += *added > before;
  }
  thr_scratch_free(&own);
  return st;
}

/* ---- the recursion anew ---- */

static bool has_table(const thr_walk_programme *p)
{
  const double steps = (double)p->units * p->steps.first[p->steps.n] * thr_walk_runs(&p->steps);
  const double tables = (double)thr_walk_tables(p->steps.measure);
  return tables * thr_walk_levels(p->most_units) * p->steps.n <= MOST_ENTRIES &&
         steps <= (p->steps.measure == THR_WALK_PULL ? most_pull_steps : most_steps);
}

/* Steps, and a table, with what is remembered now. THR_ELIMIT: they are too many. */
static thr_status make_steps(thr_walk_programme *p, thr_err *err)
{
  const thr_walk_measure measure = p->steps.measure;
  thr_err why = {0};
  thr_walk_steps steps;
  thr_status st = thr_walk_steps_init(&steps, p->c, measure, p->component, p->unit, err);
  if (st) return st;
  thr_walk_steps_destroy(&p->steps);
  p->steps = steps;
  st = thr_walk_steps_remember(&p->steps, p->memory, p->n_memories, &why);
  if (st == THR_EVIOLATED || (!st && !has_table(p)))
    return thr_fail(err, THR_ELIMIT, "walks remember too much");
  if (st) return thr_fail(err, st, "%s", why.text);
  int64_t *value = thr_calloc((size_t)thr_walk_levels(p->most_units) * (size_t)p->steps.n *
                                  thr_walk_tables(measure),
                              sizeof *value);
  if (!value) return thr_nomem(err);
  free(p->value);
  p->value = value;
  return THR_OK;
}

/* The rows of all known walks with the passes that count now. */
static thr_status count_anew(thr_walk_programme *p, thr_err *err)
{
  thr_pool counted;
  thr_status st = thr_pool_init(&counted, p->n_variables, err);
  for (int i = 0; i < p->walks.count && !st; i++) {
    const thr_row *row = &p->walks.row[i];
    thr_row anew = thr_walk_programme_row(p, &counted, row->member, row->n_members);
    anew.index = row->index;
    st = thr_pool_add(&counted, anew, err);
  }
  thr_pool_destroy(&p->walks);
  p->walks = counted;
  return st;
}

/* Without what was added: there is no room. */
static thr_status take_back(thr_walk_programme *p, thr_walk_memory **before, int n_before,
                            thr_err *err)
{
  thr_walk_memory *more = p->memory;
  const int n_more = p->n_memories;
  p->memory = *before;
  p->n_memories = n_before;
  *before = NULL;
  thr_walk_memory_free(more, n_more);
  return make_steps(p, err);
}

thr_status thr_walk_remember(thr_walk_programme *p, bool *grown, thr_err *err)
{
  thr_walk_memory *before = NULL;
  thr_err why = {0};
  const int n_before = p->n_memories;
  int added = 0;
  *grown = false;
  thr_status st = copy_memory(p->memory, n_before, &before, err);
  if (!st && p->search.outcome == THR_LP_OPTIMAL) st = add_rounds(p, &added, err);
  if (!st) st = thr_walk_programme_end(p, err);
  if (!st && added > 0) {
    st = make_steps(p, &why);
    *grown = !st;
    if (st == THR_ELIMIT)
      st = take_back(p, &before, n_before, err);
    else
      st = st ? thr_fail(err, st, "%s", why.text) : count_anew(p, err);
  }
  thr_walk_memory_free(before, n_before);
  return st;
}
