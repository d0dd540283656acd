/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The time of the T-join of a framework (the edges that a closed cord passes once more), apart from all else that a plan takes:
 *
 *   matching FRAME FOLDER
 *
 * prints processor seconds of the whole (searches, matching, pricing, moats) and its length, the same of the matching
 * alone on the first candidate pairs, and odd nodes; and writes the instance for other codes: FOLDER/graph (nodes and edges, the
 * edges with integer weights, per node whether it is odd) and FOLDER/pairs (the candidate pairs of odd nodes). bench/peers.cpp
 * reads them. */
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "lp/matching/blossom.h"
#include "lp/matching/blossom_parts.h"
#include "lp/tjoin/tjoin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/time.h>

static const double finest = 0x1p20; /* integer weight of the longest edge */

static void *need(void *p)
{
  if (p) return p;
  fprintf(stderr, "matching: out of memory\n");
  exit(1);
}

static void demand(thr_status st, const thr_err *err)
{
  if (!st) return;
  fprintf(stderr, "matching: %s\n", err->text);
  exit(1);
}

static double processor_seconds(void)
{
  struct rusage used;
  getrusage(RUSAGE_SELF, &used);
  return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/* weight and odd: of f->n_edges and f->n_nodes. */
static thr_tjoin_problem problem_of(const thr_frame *f, int64_t *weight, bool *odd)
{
  double longest = 0;
  for (int e = 0; e < f->n_edges; e++)
    longest = fmax(longest, f->length[e]);
  for (int e = 0; e < f->n_edges; e++) {
    weight[e] = (int64_t)fmax(1, nearbyint(f->length[e] / longest * finest));
    for (int i = 0; i < 2; i++)
      odd[f->edge[e][i]] ^= true;
  }
  return (thr_tjoin_problem){
      .n_nodes = f->n_nodes, .n_edges = f->n_edges, .edge = (const int(*)[2])f->edge, .weight = weight, .odd = odd};
}

static void write_list(const char *folder, const char *name, const thr_tjoin_problem *p)
{
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *out = need(fopen(path, "w"));
  fprintf(out, "%d %d\n", p->n_nodes, p->n_edges);
  for (int e = 0; e < p->n_edges; e++)
    fprintf(out, "%d %d %lld\n", p->edge[e][0], p->edge[e][1], (long long)p->weight[e]);
  for (int v = 0; p->odd && v < p->n_nodes; v++)
    fprintf(out, "%d\n", p->odd[v]);
  fclose(out);
}

/* The matching alone, on the candidates of the first round, which are written. */
static void match_candidates(const thr_tjoin_problem *p, const char *folder, thr_err *err)
{
  thr_network net;
  thr_pairs pairs = {0};
  thr_matching matching = {0};
  thr_limits limits = {0};
  demand(thr_network_init(&net, p, err), err);
  int64_t *reach = need(calloc((size_t)net.n_odd + 1, sizeof *reach));
  demand(thr_candidates_find(&net, &limits, &pairs, reach, err), err);
  thr_tjoin_problem listed = {
      .n_nodes = net.n_odd, .n_edges = pairs.count, .edge = (const int(*)[2])pairs.end, .weight = pairs.weight};
  write_list(folder, "pairs", &listed);
  thr_matching_problem q = {net.n_odd, pairs.count, (const int(*)[2])pairs.end, pairs.weight};
  double start = processor_seconds();
  demand(thr_matching_solve(&q, &limits, &matching, err), err);
  printf(" %.6f %lld %d\n", processor_seconds() - start, (long long)matching.weight, net.n_odd);
  thr_matching_destroy(&matching);
  thr_pairs_destroy(&pairs);
  thr_network_destroy(&net);
  free(reach);
}

int main(int argc, char **argv)
{
  if (argc != 3) return 2;
  thr_frame f;
  thr_read_report report;
  thr_tjoin join;
  thr_err err = {0};
  thr_read_options how = thr_read_options_default();
  demand(thr_frame_read(&f, &report, argv[1], &how, NULL, 0, &err), &err);
  int64_t *weight = need(calloc((size_t)f.n_edges, sizeof *weight));
  bool *odd = need(calloc((size_t)f.n_nodes, sizeof *odd));
  thr_tjoin_problem p = problem_of(&f, weight, odd);
  thr_limits limits = {0};
  write_list(argv[2], "graph", &p);
  double start = processor_seconds();
  demand(thr_tjoin_minimum(&p, THR_ENGINE_MATCHING, &limits, &join, &err), &err);
  printf("%.6f %lld", processor_seconds() - start, (long long)join.length);
  match_candidates(&p, argv[2], &err);
  thr_tjoin_destroy(&join);
  thr_frame_destroy(&f);
  free(weight);
  free(odd);
  return 0;
}
