/* SPDX-License-Identifier: GPL-3.0-or-later */
// Other codes on the instances that bench/matching.c wrote: peers FILE prints processor seconds and length. One is defined of
//   LEMON_PAIRS   LEMON's perfect matching (liblemon-dev) of candidate pairs
//   LEMON_PORTS   the same of the port gadget of the whole graph: two nodes per edge, one more per odd node; an edge's two nodes
//                 matched: not in the join
//   BOOST         Boost's matching of greatest weight (libboost-graph-dev), of candidate pairs
//   BLOSSOM5      Blossom V by V. Kolmogorov (sources of your own), of candidate pairs
//   PYMATCHING    the sparse blossoms of PyMatching 2 (sources of your own), on the whole graph
// They are used by this comparison only.
#include <algorithm>
#include <cstdio>
#include <vector>

#include <sys/resource.h>

#if defined LEMON_PAIRS || defined LEMON_PORTS
#include <lemon/matching.h>
#include <lemon/smart_graph.h>
#elif defined BOOST
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/maximum_weighted_matching.hpp>
#elif defined BLOSSOM5
#include "PerfectMatching.h"
#elif defined PYMATCHING
#include "pymatching/sparse_blossom/matcher/mwpm.h"
#endif

struct edge {
  int a, b;
  long long weight;
};

struct instance {
  int n;
  std::vector<edge> list;
  std::vector<char> odd; // per node; of pairs all
};

static double start; // when the code was given the instance

static double processor_seconds() // clock() counts in steps of milliseconds under a limit of processor time
{
  struct rusage used;
  getrusage(RUSAGE_SELF, &used);
  return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

static void begin()
{
  start = processor_seconds();
}

#if defined LEMON_PAIRS || defined LEMON_PORTS
static long long solve(const instance &in)
{
  using lemon::SmartGraph;
  begin();
  SmartGraph g;
  SmartGraph::EdgeMap<long long> weight(g);
  auto join = [&](int a, int b, long long w) { weight[g.addEdge(g.nodeFromId(a), g.nodeFromId(b))] = -w; };
#ifdef LEMON_PAIRS
  for (int v = 0; v < in.n; v++)
    g.addNode();
  for (const edge &e : in.list)
    join(e.a, e.b, 2 * e.weight);
#else
  std::vector<std::vector<std::pair<int, long long>>> at(in.n); // ports and what the join pays for each: half its edge, doubled
  for (const edge &e : in.list) {
    int a = g.id(g.addNode()), b = g.id(g.addNode());
    at[e.a].push_back({a, e.weight});
    at[e.b].push_back({b, e.weight});
    join(a, b, 0);
  }
  for (int v = 0; v < in.n; v++) {
    if (in.odd[v]) at[v].push_back({g.id(g.addNode()), 0});
    for (size_t i = 0; i < at[v].size(); i++)
      for (size_t k = 0; k < i; k++)
        join(at[v][i].first, at[v][k].first, at[v][i].second + at[v][k].second);
  }
#endif
  lemon::MaxWeightedPerfectMatching<SmartGraph, SmartGraph::EdgeMap<long long>> matching(g, weight);
  return matching.run() ? -matching.matchingWeight() / 2 : -1;
}
#elif defined BOOST
static long long solve(const instance &in)
{
  using graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                                      boost::property<boost::edge_weight_t, long long>>;
  long long most = 0, length = 0;
  for (const edge &e : in.list)
    most = std::max(most, e.weight);
  most = most * in.n + 1; // one pair more is worth more than all weights
  begin();
  graph g(in.n);
  for (const edge &e : in.list)
    boost::add_edge(e.a, e.b, 2 * (most - e.weight), g);
  std::vector<boost::graph_traits<graph>::vertex_descriptor> mate(in.n);
  boost::maximum_weighted_matching(g, mate.data());
  std::vector<long long> least(in.n, -1); // of the pairs that are listed twice
  for (const edge &e : in.list)
    if (mate[e.a] == (size_t)e.b) {
      long long &own = least[std::min(e.a, e.b)];
      own = own < 0 ? e.weight : std::min(own, e.weight);
    }
  for (long long w : least)
    length += std::max(w, 0LL);
  return length;
}
#elif defined BLOSSOM5
static long long solve(const instance &in)
{
  long long length = 0;
  begin();
  PerfectMatching matching(in.n, (int)in.list.size());
  matching.options.verbose = false;
  for (const edge &e : in.list)
    matching.AddEdge(e.a, e.b, (int)e.weight);
  matching.Solve();
  for (size_t i = 0; i < in.list.size(); i++)
    if (matching.GetSolution((int)i)) length += in.list[i].weight;
  return length;
}
#elif defined PYMATCHING
static void add(auto &g, const edge &e) // weights must be even; newer versions take a fifth argument
{
  if constexpr (requires { g.add_edge(e.a, e.b, 2 * (int)e.weight, {}, {}); })
    g.add_edge(e.a, e.b, 2 * (int)e.weight, {}, {});
  else
    g.add_edge(e.a, e.b, 2 * (int)e.weight, {});
}

static long long solve(const instance &in)
{
  begin();
  pm::MatchingGraph graph(in.n, 1);
  for (const edge &e : in.list)
    add(graph, e);
  pm::Mwpm mwpm{pm::GraphFlooder(std::move(graph))};
  auto &nodes = mwpm.flooder.graph.nodes;
  pm::MatchingResult sum;
  for (int v = 0; v < in.n; v++)
    if (in.odd[v]) mwpm.create_detection_event(&nodes[v]);
  for (auto event = mwpm.flooder.run_until_next_mwpm_notification(); event.event_type != pm::NO_EVENT;
       event = mwpm.flooder.run_until_next_mwpm_notification())
    mwpm.process_event(event);
  for (int v = 0; v < in.n; v++)
    if (in.odd[v] && nodes[v].region_that_arrived)
      sum += mwpm.shatter_blossom_and_extract_matches(nodes[v].region_that_arrived_top);
  return sum.weight / 2;
}
#endif

int main(int argc, char **argv)
{
  instance in;
  int m;
  std::FILE *file = argc == 2 ? std::fopen(argv[1], "r") : nullptr;
  if (!file || std::fscanf(file, "%d %d", &in.n, &m) != 2) return 2;
  in.list.resize(m);
  for (edge &e : in.list)
    if (std::fscanf(file, "%d %d %lld", &e.a, &e.b, &e.weight) != 3) return 2;
  for (int v = 0, odd; v < in.n && std::fscanf(file, "%d", &odd) == 1; v++)
    in.odd.push_back((char)odd);
  std::fclose(file);
  long long length = solve(in);
  std::printf("%.6f %lld\n", processor_seconds() - start, length);
  return length < 0;
}
