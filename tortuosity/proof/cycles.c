/* Local search over extra passes. */
#include "tortuosity/proof/cycles.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/process/threads.h"
#include "graph/scratch.h"
#include "tortuosity/cords/short_cycles.h"
#include "tortuosity/proof/branch.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { AT_ONCE = 8, MOST_EACH = 8 }; /* attempts, and tries of each, between two looks at what they came to */

/* One try after another, with what it needs for itself. */
typedef struct {
  thr_branch own; /* takes the plan if it is better than the best one */
  int *trial;     /* [n_edges] passes */
  thr_path_finder finder;
  int *cycle, n_cycle; /* edges */
} attempt;

typedef struct {
  thr_branch *branch;
  thr_scratch own;
  int *passes, *ends;       /* of the best plan */
  int64_t price;            /* of that */
  int edge;                 /* that the next try's cycle is through */
  int unchanged, left;      /* tries since a better plan; left */
  int n, each;              /* tries at hand, of every attempt */
  attempt attempt[AT_ONCE]; /* try k of those at hand is of attempt k % AT_ONCE */
  atomic_int first;         /* lowest number of a try at hand that found a better plan; n = none */
} searcher;

static void searcher_destroy(searcher *s)
{
  if (!s) return;
  for (int k = 0; k < AT_ONCE; k++)
    thr_branch_destroy(&s->attempt[k].own);
  thr_scratch_free(&s->own);
  free(s);
}

/* The plan to go on from. */
static void load_best(searcher *s, const thr_branch *from)
{
  thr_branch_best(from, s->passes, s->ends);
  s->price = from->best_price;
  s->unchanged = 0;
  s->each = 1;
}

static thr_status searcher_create(thr_branch *branch, int most_tries, searcher **out, thr_err *err)
{
  const size_t n = (size_t)branch->c->f->n_nodes, m = (size_t)branch->c->f->n_edges;
  thr_status st = thr_branch_gather(branch, err);
  searcher *s = *out = st ? NULL : thr_calloc(1, sizeof *s);
  if (!s) return st ? st : thr_nomem(err);
  s->branch = branch;
  s->left = most_tries;
  s->passes = thr_scratch_array(&s->own, m, sizeof *s->passes);
  s->ends = thr_scratch_array(&s->own, n, sizeof *s->ends);
  for (int k = 0; k < AT_ONCE && !st; k++) {
    attempt *a = &s->attempt[k];
    a->trial = thr_scratch_array(&s->own, m, sizeof *a->trial);
    thr_path_finder_init(&a->finder, branch->c->f, &s->own);
    a->cycle = thr_scratch_array(&s->own, n + 1, sizeof *a->cycle);
    st = thr_branch_init(&a->own, branch->c, 1, &branch->quiet, err);
  }
  if (!st) st = thr_scratch_check(&s->own, err);
  if (!st) {
    load_best(s, branch);
    return THR_OK;
  }
  searcher_destroy(s);
  *out = NULL;
  return st;
}

/* A shortest cycle through an edge. None through a bridge: n_cycle = 0. */
static void find_cycle(attempt *s, const thr_frame *frame, int e)
{
  const int *end = frame->edge[e], path = thr_path_find(&s->finder, end[0], end[1], -1, e, frame->n_nodes, s->cycle);
  s->n_cycle = 0;
  if (path == 0) return;
  for (int i = 0; i < path; i++)
    s->cycle[i] >>= 1;
  s->cycle[path] = e;
  s->n_cycle = path + 1;
}

static thr_status try_cycle(const searcher *s, attempt *a, int edge, thr_err *err)
{
  const thr_frame *frame = s->branch->c->f;
  find_cycle(a, frame, edge);
  if (a->n_cycle == 0) return THR_OK;
  memcpy(a->trial, s->passes, (size_t)frame->n_edges * sizeof *a->trial);
  for (int i = 0; i < a->n_cycle; i++)
    a->trial[a->cycle[i]] += s->passes[a->cycle[i]] > s->branch->c->cover[a->cycle[i]] ? -1 : 1;
  return thr_branch_try(&a->own, a->trial, s->ends, err);
}

static bool all_tried(const searcher *s)
{
  return s->unchanged >= s->branch->c->f->n_edges || s->left <= 0 || thr_limits_stop(s->branch->limits);
}

static void count(searcher *s, int tries)
{
  s->edge = (s->edge + tries) % s->branch->c->f->n_edges;
  s->left -= tries;
  s->unchanged += tries;
}

/* ---- at once ---- */

/* A job: an attempt's tries. What comes after a better plan is not needed, as the next tries begin with that. */
static thr_status try_cycles(void *user, int job, const thr_limits *limits, thr_err *err)
{
  searcher *s = user;
  attempt *a = &s->attempt[job];
  thr_status st = THR_OK;
  (void)limits;
  thr_branch_brief(&a->own, s->branch);
  for (int k = job; k < s->n && k < s->first && !st && !a->own.found; k += AT_ONCE) {
    if (thr_limits_stop(&s->branch->quiet)) break;
    st = try_cycle(s, a, (s->edge + k) % s->branch->c->f->n_edges, err);
    for (int first = s->first; a->own.found && k < first && !atomic_compare_exchange_weak(&s->first, &first, k);)
      ;
  }
  return st;
}

/* So many tries count: those up to the first that found a better plan. The more were in vain, the more come at once. */
static thr_status try_at_once(searcher *s, thr_err *err)
{
  const int rest = s->branch->c->f->n_edges - s->unchanged, wanted = rest < s->left ? rest : s->left;
  s->first = s->n = wanted < AT_ONCE * s->each ? wanted : AT_ONCE * s->each;
  thr_status st = thr_team_share(s->branch->team, s->n < AT_ONCE ? s->n : AT_ONCE, try_cycles, s, err);
  const int found = s->first;
  for (int k = 0; k < AT_ONCE; k++)
    if (st || found == s->n || k != found % AT_ONCE)
      thr_branch_forget(&s->attempt[k].own);
    else
      st = thr_branch_take(s->branch, &s->attempt[k].own, err);
  count(s, found < s->n ? found + 1 : s->n);
  if (s->each < MOST_EACH) s->each *= 2;
  if (!st && found < s->n) load_best(s, s->branch);
  return st;
}

static thr_status try_all(searcher *s, thr_err *err)
{
  thr_status st = THR_OK;
  while (!st && !all_tried(s))
    st = try_at_once(s, err);
  return st;
}

thr_status thr_cycles_improve(thr_branch *branch, int most_tries, thr_err *err)
{
  searcher *s;
  thr_status st = searcher_create(branch, most_tries, &s, err);
  if (!st) st = try_all(s, err);
  searcher_destroy(s);
  return st;
}

/* ---- beside something else ---- */

typedef struct {
  searcher *s;
  thr_cycles_other *other;
  void *user;
  atomic_bool enough; /* said by the other */
} pair;

static thr_status try_in_turn(searcher *s, const atomic_bool *enough, thr_err *err)
{
  attempt *a = &s->attempt[0];
  thr_status st = THR_OK;
  while (!st && !*enough && !all_tried(s)) {
    st = try_cycle(s, a, s->edge, err);
    count(s, 1);
    if (!st && a->own.best_price < s->price) load_best(s, &a->own);
  }
  return st;
}

static thr_status do_one(void *user, int job, const thr_limits *limits, thr_err *err)
{
  pair *p = user;
  (void)limits;
  if (job > 0) return try_in_turn(p->s, &p->enough, err);
  bool enough = false;
  const thr_status st = p->other(p->user, &enough, err);
  p->enough = enough;
  return st;
}

thr_status thr_cycles_beside(thr_branch *branch, int most_tries, thr_cycles_other *other, void *user, thr_err *err)
{
  pair p = {.other = other, .user = user};
  thr_status st = searcher_create(branch, most_tries, &p.s, err);
  if (st) return st;
  thr_branch_brief(&p.s->attempt[0].own, branch);
  st = thr_team_share(branch->team, 2, do_one, &p, err);
  if (!st && !p.enough) st = thr_branch_take(branch, &p.s->attempt[0].own, err);
  if (!st && !p.enough && branch->best_price < p.s->price) {
    load_best(p.s, branch);
    p.s->left = most_tries;
    st = try_all(p.s, err);
  }
  searcher_destroy(p.s);
  return st;
}
