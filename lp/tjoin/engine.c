/* Choice of the engine, shrinking round it. */
#include "lp/tjoin/engine.h"
#include "lp/matching/moat.h"
#include "lp/tjoin/shrink.h"

#include <stdlib.h>

static thr_status solve(const thr_tjoin_problem *tjoin_problem, thr_engine engine, const thr_limits *limits, thr_tjoin *out,
                        thr_err *err)
{
  return engine == THR_ENGINE_LP ? thr_tjoin_solve(tjoin_problem, limits, out, err)
                                 : thr_moat_solve(tjoin_problem, limits, out, err);
}

static thr_status choose(const thr_tjoin_problem *tjoin_problem, thr_engine *engine, thr_err *err)
{
  bool fits = true;
  thr_status st = *engine == THR_ENGINE_AUTO ? thr_moat_fits(tjoin_problem, &fits, err) : THR_OK;
  if (*engine == THR_ENGINE_AUTO) *engine = fits ? THR_ENGINE_MATCHING : THR_ENGINE_LP;
  return st;
}

/* Does the matching gain by shrinking? Nodes of degree 1 and 2 cost it little more than shrinking them does. */
static thr_status many_are_small(const thr_tjoin_problem *tjoin_problem, bool *many, thr_err *err)
{
  int *degree = thr_calloc((size_t)tjoin_problem->n_nodes, sizeof *degree), small = 0;
  if (!degree) return thr_nomem(err);
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    for (int i = 0; i < 2; i++)
      degree[tjoin_problem->edge[e][i]]++;
  for (int v = 0; v < tjoin_problem->n_nodes; v++)
    small += degree[v] <= 2;
  *many = small > tjoin_problem->n_nodes / 4;
  free(degree);
  return THR_OK;
}

thr_status thr_tjoin_shrunk(const thr_tjoin_problem *tjoin_problem, thr_engine engine, const thr_limits *limits, thr_tjoin *out,
                            thr_err *err)
{
  thr_shrinking shrinking;
  thr_tjoin small;
  thr_err stopped = {0};
  bool worth = true;
  *out = (thr_tjoin){0};
  thr_status st = choose(tjoin_problem, &engine, err), solved;
  if (!st && engine != THR_ENGINE_LP) st = many_are_small(tjoin_problem, &worth, err);
  if (st || !worth) return st ? st : solve(tjoin_problem, engine, limits, out, err);
  if ((st = thr_shrinking_init(&shrinking, tjoin_problem, err))) return st;
  solved = solve(&shrinking.reduced, engine, limits, &small, &stopped);
  if (!solved || solved == THR_ELIMIT) st = thr_shrinking_lift(&shrinking, &small, out, err);
  thr_shrinking_destroy(&shrinking);
  return st || !solved ? st : thr_fail(err, solved, "%s", stopped.text);
}
