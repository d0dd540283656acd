/* Iterated greedy over walks. */
#include "tortuosity/cords/walk_cover.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/random.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/model/pool.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 20000, MOST_OUT = 5 };

typedef struct {
  int n, *walk; /* rows of the pool, with repeats */
  double cost;
} choice;

typedef struct {
  thr_walk_programme *p;
  thr_scratch own;
  int most;                  /* walks that a choice has room for */
  double *left;              /* [edge variables] passes that are missing; < 0: too many */
  int words;                 /* 0, or if every edge needs just one pass, of a set of edges: */
  uint64_t *edges, *missing; /* [walks][words] the edges of a walk; [words] those that lack their pass */
  choice now, try, best;
  uint64_t random;
} cover;

static double cost_of(const cover *x, int walk)
{
  return x->p->per_cord - x->p->walks.row[walk].lower;
}

/* Passes of a walk over the edge of its k-th column. */
static double passes(const thr_row *row, int k)
{
  return row->value ? -row->value[k] : -1;
}

static void put(cover *x, choice *c, int walk)
{
  const thr_row *row = &x->p->walks.row[walk];
  c->walk[c->n++] = walk;
  c->cost += cost_of(x, walk);
  for (int k = 0; k < row->n; k++)
    if (row->column[k] < x->p->n_edges) x->left[row->column[k]] -= passes(row, k);
}

static void take_out(cover *x, choice *c, int i)
{
  const thr_row *row = &x->p->walks.row[c->walk[i]];
  c->cost -= cost_of(x, c->walk[i]);
  for (int k = 0; k < row->n; k++)
    if (row->column[k] < x->p->n_edges) x->left[row->column[k]] += passes(row, k);
  c->walk[i] = c->walk[--c->n];
}

/* Missing passes that a walk makes; of those of a choice (chosen) that would be missing without it. */
static double serves(const cover *x, int walk, bool chosen)
{
  const thr_row *row = &x->p->walks.row[walk];
  double sum = 0;
  for (int k = 0; k < row->n; k++) {
    const int j = row->column[k];
    if (j >= x->p->n_edges || (x->left[j] <= 0 && !chosen)) continue;
    const double made = passes(row, k), missing = x->left[j] + (chosen ? made : 0);
    if (missing > 0) sum += missing < made ? missing : made;
  }
  return sum;
}

/* The same of walks that are not chosen: by sets, where one pass of an edge is all that counts. */
static double serves_now(const cover *x, int walk)
{
  const uint64_t *edges = x->edges + (size_t)walk * (size_t)x->words;
  int sum = 0;
  if (x->words == 0) return serves(x, walk, false);
  for (int k = 0; k < x->words; k++)
    sum += __builtin_popcountll(edges[k] & x->missing[k]);
  return sum;
}

static void fill_missing(cover *x)
{
  for (int k = 0; k < x->words; k++)
    x->missing[k] = 0;
  for (int j = 0; j < x->p->n_edges && x->words > 0; j++)
    if (x->left[j] > 0) x->missing[j / 64] |= UINT64_C(1) << j % 64;
}

static thr_status fill_edges(cover *x, thr_err *err)
{
  const thr_pool *walks = &x->p->walks;
  for (int j = 0; j < x->p->n_edges; j++)
    if (x->p->right[j] != 1) return THR_OK;
  x->words = (x->p->n_edges + 63) / 64;
  x->edges = thr_scratch_array(&x->own, (size_t)walks->count * (size_t)x->words, sizeof *x->edges);
  x->missing = thr_scratch_array(&x->own, (size_t)x->words, sizeof *x->missing);
  thr_status st = thr_scratch_check(&x->own, err);
  for (int i = 0; i < walks->count && !st; i++)
    for (int k = 0; k < walks->row[i].n; k++) {
      const int j = walks->row[i].column[k];
      if (j < x->p->n_edges) x->edges[(size_t)i * (size_t)x->words + (size_t)(j / 64)] |= UINT64_C(1) << j % 64;
    }
  return st;
}

/* The walk that serves most for its cost, which chance makes up to a part larger; -1: none serves. */
static int best_walk(cover *x)
{
  const double part = .3;
  double most = 0;
  int best = -1;
  fill_missing(x);
  for (int i = 0; i < x->p->walks.count; i++) {
    const double worth = serves_now(x, i) / cost_of(x, i) * (1 + part * thr_random_unit(&x->random));
    if (worth > most) best = i;
    most = fmax(most, worth);
  }
  return best;
}

static bool is_covered(const cover *x)
{
  for (int j = 0; j < x->p->n_edges; j++)
    if (x->left[j] > 0) return false;
  return true;
}

/* Until every edge has its passes; then without the walks that are not needed. false: there is no room, or no walk. */
static bool complete(cover *x, choice *c)
{
  while (!is_covered(x)) {
    const int walk = c->n < x->most ? best_walk(x) : -1;
    if (walk < 0) return false;
    put(x, c, walk);
  }
  for (int i = c->n - 1; i >= 0; i--)
    if (serves(x, c->walk[i], true) == 0) take_out(x, c, i);
  return true;
}

static void copy(choice *to, const choice *from)
{
  to->n = from->n;
  to->cost = from->cost;
  memcpy(to->walk, from->walk, (size_t)from->n * sizeof *to->walk);
}

/* What is missing beside a choice. */
static void begin(cover *x, choice *c, const choice *from)
{
  c->n = 0;
  c->cost = 0;
  memcpy(x->left, x->p->right, (size_t)x->p->n_edges * sizeof *x->left);
  for (int i = 0; i < from->n; i++)
    put(x, c, from->walk[i]);
}

static void search(cover *x)
{
  const double each = 1e-7; /* seconds for a walk */
  const choice none = {0};
  begin(x, &x->now, &none);
  if (!complete(x, &x->now)) return;
  copy(&x->best, &x->now);
  for (int step = 0; step < STEPS && !thr_limits_stop(x->p->limits); step++) {
    begin(x, &x->try, &x->now);
    for (int out = 1 + thr_random_below(&x->random, MOST_OUT); out > 0 && x->try.n > 0; out--)
      take_out(x, &x->try, thr_random_below(&x->random, x->try.n));
    thr_limits_spend(x->p->limits, each * x->p->walks.count);
    if (!complete(x, &x->try) || x->try.cost > x->now.cost * (1 + 1e-12)) continue;
    copy(&x->now, &x->try);
    if (x->now.cost < x->best.cost * (1 - 1e-9)) copy(&x->best, &x->now);
  }
}

/* The best choice takes the place of cords that cost more. */
static thr_status replace(const cover *x, thr_cord *cord, thr_err *err)
{
  const thr_walk_programme *p = x->p;
  double cost = 0;
  for (int i = 0; i < p->cords; i++)
    cost += p->per_cord + thr_cord_length(p->c->f, &cord[i]) / p->longest;
  if (x->best.n == 0 || x->best.n > p->cords || x->best.cost >= cost * (1 - 1e-9)) return THR_OK;
  for (int i = 0; i < p->cords; i++) {
    free(cord[i].half);
    cord[i] = (thr_cord){0};
  }
  for (int i = 0; i < x->best.n; i++) {
    const thr_row *row = &p->walks.row[x->best.walk[i]];
    cord[i] = (thr_cord){.component = p->component, .n_passes = row->n_members};
    if (!(cord[i].half = thr_calloc((size_t)row->n_members, sizeof *cord[i].half))) return thr_nomem(err);
    memcpy(cord[i].half, row->member, (size_t)row->n_members * sizeof *cord[i].half);
  }
  return THR_OK;
}

thr_status thr_walk_cover(thr_walk_programme *p, thr_cord *cord, thr_err *err)
{
  cover x = {.p = p, .most = 3 * p->cords, .random = 1};
  choice *const all[] = {&x.now, &x.try, &x.best};
  for (int i = 0; i < 3; i++)
    all[i]->walk = thr_scratch_array(&x.own, (size_t)x.most + 1, sizeof *all[i]->walk);
  x.left = thr_scratch_array(&x.own, (size_t)p->n_edges, sizeof *x.left);
  thr_status st = thr_scratch_check(&x.own, err);
  if (!st) st = fill_edges(&x, err);
  if (!st) search(&x);
  if (!st) st = replace(&x, cord, err);
  thr_scratch_free(&x.own);
  return st;
}
