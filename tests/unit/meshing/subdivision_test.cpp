// What stands in the place of cells, and which nodes are in a set, against brute force.
#include "lacon/operators/meshing/subdivision.hpp"

#include <random>

#include "lacon/operators/meshing/body.hpp"
#include "meshes.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;

TEST(Heirs, are_those_of_a_list_of_all_cells) {
  std::mt19937 random(1);
  const auto number = [&](std::int32_t end) { return std::uniform_int_distribution<std::int32_t>(0, end - 1)(random); };
  for (int run = 0; run < 200; ++run) {
    const std::int32_t n = 1 + number(60);
    Heirs heirs;
    std::vector<Nodes> expected;  // of each cell
    std::int32_t next = 0;
    for (std::int32_t cell = 0; cell < n; ++cell) {
      const std::int32_t count = number(1 + run % 5) == 0 ? 1 + number(4) : 1;
      if (count > 1 || number(8) == 0) heirs.enter(cell, count);
      Nodes& own = expected.emplace_back();
      for (std::int32_t i = 0; i < count; ++i) own.push_back(next++);
    }
    // ascending; in any order; and with cells twice
    std::vector<Group> groups{{"ALL", {}}, {"NONE", {}}, {"SOME", {}}, {"MIXED", {}}};
    for (std::int32_t cell = 0; cell < n; ++cell) {
      groups[0].members.push_back(cell);
      if (number(3) == 0) groups[2].members.push_back(cell);
      groups[3].members.push_back(number(n));
    }
    std::vector<Group> wanted = groups;
    for (Group& group : wanted) {
      Nodes members;
      for (const std::int32_t cell : group.members)
        members.insert(members.end(), expected[static_cast<std::size_t>(cell)].begin(),
                       expected[static_cast<std::size_t>(cell)].end());
      group.members = members;
    }
    heirs.inherit(groups);
    for (std::size_t g = 0; g < groups.size(); ++g) EXPECT_EQ(groups[g].members, wanted[g].members) << wanted[g].name;
    for (std::int32_t cell = 0; cell < n; ++cell) {
      const Nodes& own = expected[static_cast<std::size_t>(cell)];
      EXPECT_EQ(heirs.of(cell).first, own.front());
      EXPECT_EQ(heirs.of(cell).count, static_cast<std::int32_t>(own.size()));
    }
    EXPECT_EQ(heirs.of(n).first, next);
  }
}

TEST(NodeSet, ranks_are_places_in_the_sorted_list) {
  std::mt19937 random(2);
  for (const std::int32_t n : {1, 63, 64, 65, 500}) {
    Nodes nodes;
    for (std::int32_t i = 0; i < n; ++i) nodes.push_back(std::uniform_int_distribution<std::int32_t>(0, n - 1)(random));
    const NodeSet set(static_cast<std::size_t>(n), nodes);
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    EXPECT_EQ(set.size(), nodes.size());
    for (std::int32_t node = 0; node < n; ++node) {
      const auto at = std::ranges::lower_bound(nodes, node);
      const bool inside = at != nodes.end() && *at == node;
      EXPECT_EQ(set.has(node), inside);
      EXPECT_EQ(set.rank(node), inside ? at - nodes.begin() : -1);
    }
  }
}

}  // namespace
