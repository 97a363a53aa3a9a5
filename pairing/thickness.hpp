#pragma once
// How thick bodies are behind their skins, and what lies on the way through them.
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "lacon/pairing/box_tree.hpp"
#include "lacon/pairing/surface.hpp"

namespace lacon {

/// Straight ways through bodies, as far as skins of them are given; facets are taken as flat. The surfaces, which must have
/// Surface::body, must outlive it.
class WaysThrough {
 public:
  explicit WaysThrough(std::vector<const Surface*> skins);
  /// How far it is from a point to where a way leaves a body, infinite where it does not through what is known of its skin.
  /// @param along unit
  double to_leave(std::int32_t body, Vec3 from, Vec3 along) const;

 private:
  struct Cell {
    std::int32_t skin, cell;
    Vec3 normal;
  };
  std::vector<const Surface*> skins_;
  std::vector<Cell> cells_;
  BoxTree<3> tree_;
};

/// Likewise at the present coordinates, made when the first one asks, whichever thread it is: few pairings do.
class WaysWhenAsked {
 public:
  explicit WaysWhenAsked(std::vector<const Surface*> skins) : skins_(std::move(skins)) {}
  const WaysThrough& operator()() const {
    std::call_once(asked_, [&] { ways_.emplace(skins_); });
    return *ways_;
  }

 private:
  std::vector<const Surface*> skins_;
  mutable std::once_flag asked_;
  mutable std::optional<WaysThrough> ways_;
};

/// Of each cell of a skin how far it is from its middle, against its normal, to where that leaves the body again, at the
/// present coordinates; infinite where it does not, as in a body without its far side in the skins that are known. The skin
/// must have Surface::body.
std::vector<double> thickness(const Surface& skin, const WaysThrough& ways);

}  // namespace lacon
