/* Time of the T-joins of large frameworks, and the same instances as files for other codes.
 *
 *   matching FAMILY EDGES            one line: family, edges, odd nodes, CPU seconds, seconds of the matching alone on the first
 *                                    candidate pairs, rounds, peak MB, length
 *   matching FAMILY EDGES FOLDER     writes FOLDER/graph and FOLDER/pairs as well (bench/lemon.cpp reads them)
 *
 * Families: grid, geodesic, honeycomb (lengths even in 1/2 .. 3/2), honeycomb-equal (all lengths equal), planar (points at random
 * in the cells of a grid, joined along the grid and across some cells, some edges left out). */
#include "graph/limits.h"
#include "graph/framework/make.h"
#include "graph/random.h"
#include "lp/matching/blossom.h"
#include "lp/matching/candidates.h"
#include "lp/tjoin/engine.h"
#include "graph/framework/frame.h"
#include "graph/status.h"
#include "lp/matching/network.h"
#include "lp/tjoin/tjoin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

typedef struct {
  int n, m, capacity;
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
} graph;

static const double unit = 0x1p20;

static void *need(void *p)
{
  if (p) return p;
  fprintf(stderr, "matching: out of memory\n");
  exit(1);
}

static void add(graph *g, int a, int b, double length)
{
  if (g->m == g->capacity) {
    g->capacity = g->capacity ? 2 * g->capacity : 1024;
    g->edge = need(realloc(g->edge, (size_t)g->capacity * sizeof *g->edge));
    g->weight = need(realloc(g->weight, (size_t)g->capacity * sizeof *g->weight));
  }
  g->edge[g->m][0] = a;
  g->edge[g->m][1] = b;
  g->weight[g->m++] = (int64_t)fmax(1, nearbyint(length * unit));
}

static double even(uint64_t *random) /* in [0, 1) */
{
  return 0.5 + 0.5 * thr_random_disorder(random);
}

static void make_planar(graph *g, int edges, uint64_t *random)
{
  int side = (int)sqrt(edges / 2.3);
  double(*at)[2] = need(calloc((size_t)side * (size_t)side, sizeof *at));
  g->n = side * side;
  for (int v = 0; v < g->n; v++) {
    at[v][0] = v % side + even(random);
    at[v][1] = v / side + even(random);
  }
  for (int v = 0; v < g->n; v++) {
    bool right = v % side < side - 1, up = v + side < g->n;
    int across[2] = {v, v + side + 1};
    if (even(random) < 0.5) across[0] = v + 1, across[1] = v + side;
    if (right) add(g, v, v + 1, hypot(at[v][0] - at[v + 1][0], at[v][1] - at[v + 1][1]));
    if (up && (v % side == 0 || even(random) < 0.65))
      add(g, v, v + side, hypot(at[v][0] - at[v + side][0], at[v][1] - at[v + side][1]));
    if (right && up && even(random) < 0.65)
      add(g, across[0], across[1], hypot(at[across[0]][0] - at[across[1]][0], at[across[0]][1] - at[across[1]][1]));
  }
  free(at);
}

static void make_shape(graph *g, const char *family, int edges, uint64_t *random)
{
  bool honeycomb = strncmp(family, "honeycomb", 9) == 0, equal = strcmp(family, "honeycomb-equal") == 0;
  thr_make_options o = thr_make_options_default(honeycomb                         ? THR_MAKE_HONEYCOMB
                                                : strcmp(family, "geodesic") == 0 ? THR_MAKE_SPHERE
                                                                                  : THR_MAKE_DOME);
  o.size = (int)sqrt(o.shape == THR_MAKE_DOME ? edges / 2.0 : o.shape == THR_MAKE_SPHERE ? edges / 30.0 : edges / 9.0);
  thr_draft draft = {0};
  thr_frame f = {0};
  thr_read_report report;
  thr_err err = {0};
  if (thr_make(&draft, &o, &err) || thr_draft_build(&draft, -1, &f, &report, &err)) {
    fprintf(stderr, "matching: %s\n", err.text);
    exit(1);
  }
  g->n = f.n_nodes;
  for (int e = 0; e < f.n_edges; e++)
    add(g, f.edge[e][0], f.edge[e][1], equal ? 1 : honeycomb ? 0.5 + even(random) : f.length[e] / o.pitch);
  thr_frame_destroy(&f);
  thr_draft_destroy(&draft);
}

static double cpu(void)
{
  return (double)clock() / CLOCKS_PER_SEC;
}

static void count_round(void *rounds, const char *what, double best, double bound)
{
  (void)what, (void)best, (void)bound;
  ++*(int *)rounds;
}

static void write_list(const char *folder, const char *name, int n, int m, const int (*edge)[2], const int64_t *weight,
                       const bool *odd)
{
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *out = need(fopen(path, "w"));
  fprintf(out, "%d %d\n", n, m);
  for (int e = 0; e < m; e++)
    fprintf(out, "%d %d %lld\n", edge[e][0], edge[e][1], (long long)weight[e]);
  for (int v = 0; odd && v < n; v++)
    fprintf(out, "%d\n", odd[v]);
  fclose(out);
}

/* Seconds of the matching alone, on the candidates of the first round. */
static double match_candidates(const thr_tjoin_problem *p, const char *folder, thr_err *err)
{
  thr_network net;
  thr_pairs pairs = {0};
  thr_matching matching = {0};
  thr_limits limits = {0};
  if (thr_network_init(&net, p, err)) return -1;
  int64_t *reach = need(calloc((size_t)net.n_odd + 1, sizeof *reach));
  thr_status st = thr_candidates_find(&net, &limits, &pairs, reach, err);
  if (!st && folder) write_list(folder, "pairs", net.n_odd, pairs.count, (const int(*)[2])pairs.end, pairs.weight, NULL);
  double start = cpu();
  thr_matching_problem q = {net.n_odd, pairs.count, (const int(*)[2])pairs.end, pairs.weight};
  if (!st) st = thr_matching_solve(&q, &limits, &matching, err);
  double seconds = cpu() - start;
  thr_matching_destroy(&matching);
  thr_pairs_destroy(&pairs);
  thr_network_destroy(&net);
  free(reach);
  return st ? -1 : seconds;
}

int main(int argc, char **argv)
{
  graph g = {0};
  uint64_t random = 1;
  int rounds = 0, odd = 0;
  if (argc < 3) return 2;
  if (strcmp(argv[1], "planar") == 0)
    make_planar(&g, atoi(argv[2]), &random);
  else
    make_shape(&g, argv[1], atoi(argv[2]), &random);
  g.odd = need(calloc((size_t)g.n, sizeof *g.odd));
  for (int e = 0; e < g.m; e++)
    for (int i = 0; i < 2; i++)
      g.odd[g.edge[e][i]] ^= true;
  for (int v = 0; v < g.n; v++)
    odd += g.odd[v];
  thr_tjoin_problem p = {.n_nodes = g.n, .n_edges = g.m, .edge = (const int(*)[2])g.edge, .weight = g.weight, .odd = g.odd};
  thr_limits limits = {.progress = count_round, .user = &rounds};
  thr_tjoin t;
  thr_err err = {0};
  double start = cpu();
  if (thr_tjoin_shrunk(&p, THR_ENGINE_MATCHING, &limits, &t, &err)) {
    fprintf(stderr, "matching: %s\n", err.text);
    return 1;
  }
  double seconds = cpu() - start;
  struct rusage used;
  getrusage(RUSAGE_SELF, &used);
  printf("%-16s %8d %8d %9.4f", argv[1], g.m, odd, seconds);
  if (argc > 3) write_list(argv[3], "graph", g.n, g.m, p.edge, p.weight, p.odd);
  printf(" %9.5f %6d %8ld %16lld\n", match_candidates(&p, argc > 3 ? argv[3] : NULL, &err), rounds, used.ru_maxrss >> 10,
         (long long)t.length);
  thr_tjoin_destroy(&t);
  free(g.edge);
  free(g.weight);
  free(g.odd);
  return 0;
}
