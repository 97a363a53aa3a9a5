#pragma once
// The gap that straight edges leave between two curved skins, against what these give way by.
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/operators/contact/facets.hpp"

namespace lacon {

struct FacetGap {
  double gap;   ///< that edges add on average: positive where they keep the skins apart
  double give;  ///< of the skins, one over the other, or of bodies of their radius under the pressure: the larger one
};

/// Of zones at an instant. What edges leave is that of the mesh: bodies bend by themselves.
class FacetGaps {
 public:
  /// All arguments must outlive it.
  FacetGaps(const Mesh& mesh, const Contact& definition, const ContactState& contact)
      : mesh_(mesh), definition_(definition), contact_(contact) {}
  /// Medians over the patches that press, or would if edges were curved; nothing where these have no curves.
  /// @param displacement (n_nodes, dimension)
  std::optional<FacetGap> of(std::int32_t zone, const Patchwise& patches, std::span<const double> displacement);

 private:
  using Bulges = std::map<std::int32_t, Bulge>;  ///< by cells of the mesh
  /// Of both skins, without cells at corners.
  const Bulges& bulges(std::int32_t zone);

  const Mesh& mesh_;
  const Contact& definition_;
  const ContactState& contact_;
  std::map<std::int32_t, Bulges> bulges_;  ///< of zones that have been asked for
};

}  // namespace lacon
