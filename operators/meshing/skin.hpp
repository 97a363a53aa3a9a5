#pragma once
// On which side of a skin cell its body lies, and whether it has any.
#include "lacon/operators/meshing/body.hpp"

namespace lacon {

enum class Side {
  outward,  ///< the normal leaves the body
  inward,   ///< the normal looks into the body
  alone,    ///< no cell has this facet, or only one without volume
  between   ///< two bodies share the facet
};

/// Tells by geometry: a body cell that is inside out counts with the sign of its volume.
class SkinSides {
 public:
  explicit SkinSides(const Mesh& mesh) : mesh_(mesh), around_(mesh) {}
  Side operator[](std::int32_t skin_cell) const { return seen_from(bodies(skin_cell)); }
  /// The same where only some of the cells that have it as a facet count.
  Side seen_from(std::span<const BodyCell> bodies) const;
  /// The cells that have it as a facet.
  std::vector<BodyCell> bodies(std::int32_t skin_cell) const {
    return body_cells(mesh_, around_, static_cast<std::size_t>(skin_cell));
  }

 private:
  const Mesh& mesh_;
  NodeCells around_;
};

/// What a skin of this mesh is made of, for a message.
std::string skin_cells(const Mesh& mesh);

/// Refuse skin cells without length or area, which have no normal: SKIN_1. A length counts by the extent of them all, an area
/// by the longest distance in its cell, as pairing judges them.
void refuse_degenerate(const Mesh& mesh, std::span<const std::int32_t> cells, const std::string& keyword,
                       const std::string& group);

}  // namespace lacon
