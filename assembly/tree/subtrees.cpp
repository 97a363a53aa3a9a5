#include "lacon/assembly/tree/subtrees.hpp"

#include <algorithm>
#include <numeric>
#include <queue>
#include <utility>

namespace lacon {
namespace {

/// Smaller subtrees are not shared out but added to others, of all the work; and what another step down has to win.
constexpr double least_share = 1e-3, least_gain = 0.02;

/// The elimination tree of vertices, numbered in the order of elimination.
struct Tree {
  std::vector<std::int32_t> vertex;  ///< of the numbering
  std::vector<std::int32_t> parent;  ///< -1: a root
  std::vector<double> own;           ///< flops of a vertex
  EliminationCounts counts;

  Tree(const VertexGraph& of, std::span<const std::int32_t> order) {
    const Numbering& numbering = of.numbering;
    const Ragged<std::int32_t>& graph = of.neighbours;
    for (std::int32_t v = 0; v < numbering.n_vertices(); ++v)
      if (numbering.first[v + 1] > numbering.first[v]) vertex.push_back(v);
    std::sort(vertex.begin(), vertex.end(),
              [&](std::int32_t a, std::int32_t b) { return order[numbering.first[a]] < order[numbering.first[b]]; });
    const auto n = static_cast<std::int32_t>(vertex.size());
    std::vector<std::int32_t> number(numbering.n_vertices(), -1), seen_by(n, -1);
    std::vector<double> height(n, 0.0);  // of the columns of a vertex
    for (std::int32_t i = 0; i < n; ++i) number[vertex[i]] = i;
    parent.assign(n, -1);
    const auto weight = [&](std::int32_t i) {
      return static_cast<double>(numbering.first[vertex[i] + 1] - numbering.first[vertex[i]]);
    };
    for (std::int32_t i = 0; i < n; ++i) {  // row by row: the row of i has entries from its neighbours up to i
      height[i] += weight(i);
      seen_by[i] = i;
      for (const std::int32_t w : graph[vertex[i]])
        for (std::int32_t k = number[w]; k >= 0 && k < i && seen_by[k] != i; k = parent[k]) {
          if (parent[k] < 0) parent[k] = i;
          height[k] += weight(i);
          seen_by[k] = i;
        }
    }
    own.resize(n);
    for (std::int32_t i = 0; i < n; ++i) {
      own[i] = weight(i) * height[i] * height[i];
      counts.flops += own[i];
      counts.entries += weight(i) * height[i];
    }
  }
};

/// Work shared out, the largest first, each to the process that has the least.
struct Shares {
  std::vector<int> process;
  double most = 0;

  Shares(std::span<const double> work, int n_processes) : process(work.size()) {
    std::vector<double> load(static_cast<std::size_t>(n_processes), 0.0);
    std::vector<std::size_t> order(work.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
    for (const std::size_t i : order) {
      const auto least = std::min_element(load.begin(), load.end());
      process[i] = static_cast<int>(least - load.begin());
      *least += work[i];
    }
    most = *std::max_element(load.begin(), load.end());
  }
};

}  // namespace

EliminationCounts elimination_counts(const VertexGraph& graph, std::span<const std::int32_t> order) {
  return Tree(graph, order).counts;
}

Subtrees independent_subtrees(const VertexGraph& graph, std::span<const std::int32_t> order, int n_processes) {
  const Tree tree(graph, order);
  const auto n = static_cast<std::int32_t>(tree.vertex.size());
  std::vector<double> below = tree.own;  // flops of the subtree of each vertex
  std::vector<std::vector<std::int32_t>> child(tree.vertex.size());
  for (std::int32_t i = 0; i < n; ++i)
    if (const std::int32_t parent = tree.parent[i]; parent >= 0) {
      below[parent] += below[i];
      child[parent].push_back(i);
    }
  Subtrees best{.of = {}, .process = {}, .whole = tree.counts};
  std::vector<std::int32_t> best_roots;
  using Subtree = std::pair<double, std::int32_t>;  // flops, root
  std::vector<Subtree> now;                         // a heap
  double top = 0;
  const auto add = [&](std::int32_t root) {
    if (below[root] < least_share * best.whole.flops) {
      top += below[root];
      return;
    }
    now.emplace_back(below[root], root);
    std::push_heap(now.begin(), now.end());
  };
  const auto look = [&] {
    std::vector<double> work;
    for (const Subtree& s : now) work.push_back(s.first);
    const Shares shares(work, n_processes);
    if (!best_roots.empty() && top + shares.most > best.longest - least_gain * best.whole.flops) return;
    best.longest = top + shares.most;
    best.process = shares.process;
    best_roots.clear();
    for (const Subtree& s : now) best_roots.push_back(s.second);
  };
  for (std::int32_t i = 0; i < n; ++i)
    if (tree.parent[i] < 0) add(i);
  // down from the roots, into the largest subtree each time, until its halves would not matter
  for (look(); !now.empty() && top < best.longest;) {
    std::pop_heap(now.begin(), now.end());
    const std::int32_t root = now.back().second;
    now.pop_back();
    top += tree.own[root];
    const std::size_t before = now.size();
    for (const std::int32_t c : child[root]) add(c);
    if (now.size() > before + 1) look();
  }

  std::vector<std::int32_t> subtree(static_cast<std::size_t>(n), -1);
  std::vector<double> load(best_roots.size());
  for (std::size_t s = 0; s < best_roots.size(); ++s) {
    subtree[best_roots[s]] = static_cast<std::int32_t>(s);
    load[s] = below[best_roots[s]];
  }
  best.of.assign(order.size(), -1);
  for (std::int32_t i = n - 1; i >= 0; --i) {
    if (subtree[i] < 0 && tree.parent[i] >= 0) subtree[i] = subtree[tree.parent[i]];
    if (subtree[i] < 0 && !load.empty() && below[i] < least_share * best.whole.flops) {
      const auto least = std::min_element(load.begin(), load.end());
      subtree[i] = static_cast<std::int32_t>(least - load.begin());
      *least += below[i];
    }
    const std::int32_t v = tree.vertex[i];
    for (std::int64_t e = graph.numbering.first[v]; e < graph.numbering.first[v + 1]; ++e) best.of[e] = subtree[i];
  }
  return best;
}

}  // namespace lacon
