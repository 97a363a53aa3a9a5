#pragma once
// Pressures of triangular patches that go up and down from each patch to the next.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lacon {

/// What pressures of a zone go up and down by: from triangle to triangle; with most patches open; from triangle to triangle of
/// curved skins, with or without a sense; from patch to patch of a row (pressure_rows.hpp), where facets of curved skins meet,
/// or along skins that have none.
enum class AlternatingBy { triangles, few_patches, scattered, facets, rows };

/// Pressures of a zone that alternate.
struct AlternatingPressures {
  double share;       ///< root of the mean product of neighbours' distances from smooth pressures, over that of the pressure
  std::size_t patch;  ///< furthest from its smooth pressure
  AlternatingBy by;
  double pressing = 1;  ///< part of the patches looked at
  double scatter = 0;   ///< root of the mean square of distances from smooth pressures, over that of the pressure; 0 of few
};

/// A skin of linear triangles has two patches for each of its vertices. Pressures that alternate from patch to patch press on
/// no vertex; nothing but the node inside each patch feels them, and that is stiff: small errors of the gap, as those against
/// a coarser master, become large pressures of this kind. The means over the patches around the vertices have no part of them,
/// so they are what pressures differ by from those means, where neighbours differ to opposite sides. At edges of bodies and of
/// contacts pressures vary too, but to the same side.
class PressureAlternation {
 public:
  /// @param corners vertices of each patch of a zone (others: none): nodes other than those that belong to the patch alone
  explicit PressureAlternation(const std::vector<std::vector<std::int32_t>>& corners);
  /// Over the patches whose vertices have nothing but whole triangles around, one of which is pressed; nothing where too few of
  /// them meet. Where open ones count, smooth pressures and their ends have less than 0.01 (edges of punches up to 0.4), and
  /// nine tenths press; of triangles that press alone, scattered among open ones, a third to a half does, and they have 0.25 to
  /// 0.6. The pressures of Hertz on 26 to 61 triangles have a scatter of 0.14 to 0.08; spheres of such triangles had 0.45 and
  /// more.
  /// @param pressure, area of each patch  @param whole those that count: all that see a master, or the pressed ones alone
  /// @param pressed those that are in contact
  std::optional<AlternatingPressures> measure(std::span<const double> pressure, std::span<const double> area,
                                              const std::vector<bool>& whole, const std::vector<bool>& pressed) const;

 private:
  struct Inner {
    std::size_t patch;
    std::size_t rings[3];
  };
  std::vector<std::vector<std::size_t>> rings_;               ///< the patches around each vertex that triangles close
  std::vector<Inner> inner_;                                  ///< patches that have three of these
  std::vector<std::pair<std::size_t, std::size_t>> couples_;  ///< of inner_, that share an edge
};

}  // namespace lacon
