// CPU seconds and length of LEMON's perfect matching on an instance that bench/matching.c wrote:
//   lemon pairs FILE     on candidate pairs of odd nodes
//   lemon ports FILE     on the port gadget of the whole graph: two nodes per edge, one more per odd node; an edge's two nodes
//                        matched: not in the join
// LEMON (liblemon-dev) is used by this comparison only.
#include <lemon/matching.h>
#include <lemon/smart_graph.h>

#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

using lemon::SmartGraph;

int main(int argc, char **argv)
{
  int n, m;
  std::FILE *in = argc == 3 ? std::fopen(argv[2], "r") : nullptr;
  if (!in || std::fscanf(in, "%d %d", &n, &m) != 2) return 2;
  struct edge {
    int a, b;
    long long weight;
  };
  std::vector<edge> list(m);
  for (edge &e : list)
    if (std::fscanf(in, "%d %d %lld", &e.a, &e.b, &e.weight) != 3) return 2;
  bool ports = !std::strcmp(argv[1], "ports");
  std::vector<int> odd(n);
  for (int v = 0; ports && v < n; v++)
    if (std::fscanf(in, "%d", &odd[v]) != 1) return 2;
  std::fclose(in);
  double start = (double)std::clock() / CLOCKS_PER_SEC;
  SmartGraph g;
  SmartGraph::EdgeMap<long long> weight(g);
  auto join = [&](int a, int b, long long w) { weight[g.addEdge(g.nodeFromId(a), g.nodeFromId(b))] = -w; };
  if (!ports) {
    for (int v = 0; v < n; v++)
      g.addNode();
    for (const edge &e : list)
      join(e.a, e.b, e.weight);
  } else {
    std::vector<std::vector<std::pair<int, long long>>> at(n); // ports and what the join pays for each: half its edge, doubled
    for (const edge &e : list) {
      int a = g.id(g.addNode()), b = g.id(g.addNode());
      at[e.a].push_back({a, e.weight});
      at[e.b].push_back({b, e.weight});
      join(a, b, 0);
    }
    for (int v = 0; v < n; v++) {
      if (odd[v]) at[v].push_back({g.id(g.addNode()), 0});
      for (size_t i = 0; i < at[v].size(); i++)
        for (size_t k = 0; k < i; k++)
          join(at[v][i].first, at[v][k].first, at[v][i].second + at[v][k].second);
    }
  }
  lemon::MaxWeightedPerfectMatching<SmartGraph, SmartGraph::EdgeMap<long long>> matching(g, weight);
  if (!matching.run()) return 1;
  std::printf("%.4f %lld\n", (double)std::clock() / CLOCKS_PER_SEC - start, -matching.matchingWeight() / (ports ? 2 : 1));
}
