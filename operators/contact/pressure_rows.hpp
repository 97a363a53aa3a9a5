#pragma once
// Pressures that go up and down along the rows that patches lie in.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacon/operators/contact/pressure_alternation.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

/// Quadrangles of a skin lie in rows through opposite sides, the patches of a line in one row; triangles in none
/// (pressure_alternation.hpp). Against straight facets of a coarser master pressures gather where these meet, and along a row
/// they go up and down. What a pressure differs by from the mean of both neighbours' then changes its sign from each patch to
/// the next; at the edges of bodies and of contacts, and where a load varies, it keeps it.
class PressureRows {
 public:
  /// @param nodes of each patch of a zone (others: none)  @param normals of each patch: a row ends at an edge of the body,
  /// where they turn by more than 60 degrees  @param shared how many nodes neighbours have in common: 1 in the plane, 2 or more
  /// in space
  PressureRows(const std::vector<std::vector<std::int32_t>>& nodes, const std::vector<Vec3>& normals, std::size_t shared);
  /// Nothing where too few patches in rows press.
  /// One or two open patches between pressed ones count as some without pressure.
  /// @param pressure, area of each patch  @param whole those that see a master everywhere  @param pressed those in contact
  std::optional<AlternatingPressures> measure(std::span<const double> pressure, std::span<const double> area,
                                              const std::vector<bool>& whole, const std::vector<bool>& pressed) const;
  /// The same, of some of the patches that have two others on all sides: beside a sharp edge, where pressures have no bound,
  /// the next patch has too little.
  /// @param counting which patches
  std::optional<AlternatingPressures> measure_inside(std::span<const double> pressure, std::span<const double> area,
                                                     const std::vector<bool>& whole, const std::vector<bool>& pressed,
                                                     const std::vector<bool>& counting) const;

 private:
  /// A patch between two others that lie on opposite sides of it.
  struct Three {
    std::size_t middle;
    std::array<std::size_t, 2> beside;
    std::array<std::optional<std::size_t>, 2> next;  ///< of threes_: those of the same row around these two
  };
  /// What the pressures in the middle of threes_ are, and differ from the line between both neighbours', halved; NaN where they
  /// are unknown.
  struct Waves {
    std::vector<double> pressure, difference;
  };
  Waves waves(std::span<const double> pressure, std::span<const double> area, const std::vector<bool>& whole,
              const std::vector<bool>& pressed) const;
  /// Of those of threes_ that count.
  std::optional<AlternatingPressures> measure(const Waves& waves, const std::vector<bool>& counting, AlternatingBy by) const;

  std::size_t directions_;  ///< in which a patch has neighbours on opposite sides
  std::vector<Three> threes_;
};

}  // namespace lacon
