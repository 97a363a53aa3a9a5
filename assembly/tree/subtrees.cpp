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

/// Cuts the elimination tree into subtrees and what is above them, the top. Operations are counted as `flops`.
class Cutter {
 public:
  Cutter(const Tree& tree, int n_processes)
      : tree_(tree), n_processes_(n_processes), below_(tree.own), child_(tree.vertex.size()) {
    for (std::int32_t i = 0; i < size(); ++i)
      if (const std::int32_t parent = tree.parent[i]; parent >= 0) {
        below_[parent] += below_[i];
        child_[parent].push_back(i);
      }
  }

  /// Down from the roots, into the largest subtree each time, until its halves would not matter.
  void search() {
    for (std::int32_t i = 0; i < size(); ++i)
      if (tree_.parent[i] < 0) add(i);
    for (look(); !heap_.empty() && top_ < longest_;) {
      std::pop_heap(heap_.begin(), heap_.end());
      const std::int32_t root = heap_.back().second;
      heap_.pop_back();
      top_ += tree_.own[root];
      const std::size_t before = heap_.size();
      for (const std::int32_t c : child_[root]) add(c);
      if (heap_.size() > before + 1) look();
    }
  }

  double longest() const { return longest_; }
  /// Of the best cut's subtrees: the processes that they are for.
  const std::vector<int>& processes() const { return processes_; }

  /// The best cut's subtree of each vertex of the tree, -1 in the top; small ones beside it go where there is least to do.
  std::vector<std::int32_t> subtrees() const {
    std::vector<std::int32_t> subtree(tree_.vertex.size(), -1);
    std::vector<double> load(roots_.size());
    for (std::size_t s = 0; s < roots_.size(); ++s) {
      subtree[roots_[s]] = static_cast<std::int32_t>(s);
      load[s] = below_[roots_[s]];
    }
    for (std::int32_t i = size() - 1; i >= 0; --i) {
      if (subtree[i] < 0 && tree_.parent[i] >= 0) subtree[i] = subtree[tree_.parent[i]];
      if (subtree[i] >= 0 || load.empty() || !is_small(i)) continue;
      const auto least = std::min_element(load.begin(), load.end());
      subtree[i] = static_cast<std::int32_t>(least - load.begin());
      *least += below_[i];
    }
    return subtree;
  }

 private:
  std::int32_t size() const { return static_cast<std::int32_t>(tree_.vertex.size()); }
  bool is_small(std::int32_t root) const { return below_[root] < least_share * tree_.counts.flops; }

  void add(std::int32_t root) {
    if (is_small(root)) {
      top_ += below_[root];
      return;
    }
    heap_.emplace_back(below_[root], root);
    std::push_heap(heap_.begin(), heap_.end());
  }

  /// Keep the present cut where it is better than the best one.
  void look() {
    std::vector<double> work;
    for (const auto& [flops, root] : heap_) work.push_back(flops);
    const Shares shares(work, n_processes_);
    if (!roots_.empty() && top_ + shares.most > longest_ - least_gain * tree_.counts.flops) return;
    longest_ = top_ + shares.most;
    processes_ = shares.process;
    roots_.clear();
    for (const auto& [flops, root] : heap_) roots_.push_back(root);
  }

  const Tree& tree_;
  int n_processes_;
  std::vector<double> below_;                          ///< flops of the subtree of each vertex
  std::vector<std::vector<std::int32_t>> child_;       ///< of each vertex
  std::vector<std::pair<double, std::int32_t>> heap_;  ///< the present subtrees: flops, root
  double top_ = 0;                                     ///< flops of the present top
  double longest_ = 0;                                 ///< of the best cut: flops of the busiest process and of the top
  std::vector<int> processes_;
  std::vector<std::int32_t> roots_;
};

}  // namespace

EliminationCounts elimination_counts(const VertexGraph& graph, std::span<const std::int32_t> order) {
  return Tree(graph, order).counts;
}

Subtrees independent_subtrees(const VertexGraph& graph, std::span<const std::int32_t> order, int n_processes) {
  const Tree tree(graph, order);
  Cutter cutter(tree, n_processes);
  cutter.search();
  Subtrees made{.of = std::vector<std::int32_t>(order.size(), -1), .process = cutter.processes(), .whole = tree.counts};
  made.longest = cutter.longest();
  const std::vector<std::int32_t> subtree = cutter.subtrees();
  for (std::size_t i = 0; i < subtree.size(); ++i) {
    const std::int32_t v = tree.vertex[i];
    for (std::int64_t e = graph.numbering.first[v]; e < graph.numbering.first[v + 1]; ++e) made.of[e] = subtree[i];
  }
  return made;
}

}  // namespace lacon
