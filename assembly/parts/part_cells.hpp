#pragma once
// What a process gets of a problem: its cells, and those of others that meet its nodes.
#include <cstdint>
#include <string>
#include <vector>

namespace lacon {

/// Cells of an ElementSet, in its order.
struct PartSet {
  std::string element, option;
  std::vector<std::int32_t> number;  ///< of each cell, in the whole mesh
  std::vector<std::int32_t> at;      ///< its place in the whole set
  std::vector<std::uint8_t> is_own;  ///< it belongs to no other process
  std::vector<std::int32_t> nodes;   ///< (cells, nodes of a cell): places in PartCells::node
  std::vector<double> parameters, curve;

  template <class Parcel>
  void parcel(Parcel& pack) {
    pack(element)(option)(number)(at)(is_own)(nodes)(parameters)(curve);
  }
};

struct PartCells {
  int dimension = 3;
  std::vector<std::string> plugins, unknowns;
  std::vector<std::int32_t> node;             ///< in the whole mesh: own ones, then those of others, ascending both
  std::int64_t n_own = 0;                     ///< nodes, all cells of which are here
  std::vector<double> coordinates;            ///< (nodes, 3)
  std::vector<std::int32_t> equation, place;  ///< (nodes, dimension): -1 where one is imposed; BlockNumbering::place
  std::vector<PartSet> sets;

  template <class Parcel>
  void parcel(Parcel& pack) {
    pack(dimension)(plugins)(unknowns)(node)(n_own)(coordinates)(equation)(place)(sets);
  }
};

}  // namespace lacon
