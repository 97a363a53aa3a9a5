#include "lacon/assembly/petsc/aggregates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace lacon {
namespace {

/// A lattice of n^3 nodes of which each has all those around it. @param are_linked  of two planes of it, one above the other
template <class AreLinked>
NodeGraph lattice(int n, const AreLinked& are_linked) {
  NodeGraph graph;
  const int size = n * n * n;
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      const int above = j / (n * n) - i / (n * n);
      if (std::abs(above) <= 1 && std::abs(j / n % n - i / n % n) <= 1 && std::abs(j % n - i % n) <= 1 &&
          are_linked(i / (n * n), j / (n * n)))
        graph.node.push_back(j);
    }
    graph.offset.push_back(std::ssize(graph.node));
  }
  return graph;
}
constexpr auto takes_all = [](int, int) { return true; };

std::map<std::int32_t, std::set<std::int32_t>> nodes_of(const Aggregates& aggregates) {
  std::map<std::int32_t, std::set<std::int32_t>> nodes;
  for (std::size_t i = 0; i < aggregates.of_node.size(); ++i) nodes[aggregates.of_node[i]].insert(static_cast<std::int32_t>(i));
  return nodes;
}

// Of two nodes along the sides where the first node is.
TEST(Aggregates, OfALatticeAreCubesOfThreeNodes) {
  const Aggregates found = aggregated(lattice(8, takes_all), std::vector<std::uint8_t>(512, 1));
  EXPECT_EQ(found.count, 27);
  const auto place = [](int i) { return (i + 1) / 3; };
  for (int i = 0; i < 512; ++i) EXPECT_EQ(found.of_node[i], place(i / 64) * 9 + place(i / 8 % 8) * 3 + place(i % 8)) << i;
}

TEST(Aggregates, AreConnectedAndHaveEachNodeOnce) {
  const int n = 7;  // the last ones are left over
  const NodeGraph graph = lattice(n, takes_all);
  const Aggregates found = aggregated(graph, std::vector<std::uint8_t>(n * n * n, 1));
  const auto nodes = nodes_of(found);
  EXPECT_EQ(std::ssize(nodes), found.count);
  EXPECT_EQ(nodes.begin()->first, 0);  // none is left out
  EXPECT_EQ(found.count, 27);
  for (const auto& [aggregate, own] : nodes) {
    std::set<std::int32_t> reached{*own.begin()};
    for (std::size_t before = 0; before < reached.size();) {
      before = reached.size();
      for (const std::int32_t i : std::set(reached))
        for (const std::int32_t j : graph.of(i))
          if (own.contains(j)) reached.insert(j);
    }
    EXPECT_EQ(reached, own) << aggregate;
  }
}

TEST(Aggregates, DoNotReachAcrossBodies) {
  const int n = 6;
  const Aggregates found = aggregated(lattice(n, [](int below, int above) { return below / 2 == above / 2; }),
                                      std::vector<std::uint8_t>(n * n * n, 1));  // three slices of two planes
  for (const auto& [aggregate, own] : nodes_of(found))
    EXPECT_EQ(*own.begin() / (2 * n * n), *own.rbegin() / (2 * n * n)) << aggregate;
}

TEST(Aggregates, LeaveOutWhatDoesNotMove) {
  const int n = 6;
  std::vector<std::uint8_t> moves(n * n * n, 1);
  std::fill_n(moves.begin(), n * n, 0);  // a side that is held
  const Aggregates found = aggregated(lattice(n, takes_all), moves);
  for (int i = 0; i < n * n * n; ++i) EXPECT_EQ(found.of_node[i] == -1, i < n * n) << i;
}

TEST(Aggregates, OfNodesWithoutOthersAreThoseNodes) {
  NodeGraph graph;
  for (int i = 0; i < 3; ++i) {
    graph.node.push_back(i);
    graph.offset.push_back(i + 1);
  }
  EXPECT_EQ(aggregated(graph, std::vector<std::uint8_t>(3, 1)).of_node, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(aggregated({}, {}).count, 0);
}

}  // namespace
}  // namespace lacon
