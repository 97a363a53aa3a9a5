#pragma once
// The gap that flat facets leave between two curved skins, and what it does to pressures.
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "lacon/operators/contact/contact_state.hpp"
#include "lacon/operators/contact/facets.hpp"

namespace lacon {

struct FacetGap {
  double gap;  ///< that facets add on average: positive where they keep the skins apart
  /// Of the skins, one over the other, dents under few patches with it, or of bodies of their radius under the pressure: the
  /// larger one.
  double give;
};

/// The patch of a zone that overlaps its master deepest, where that is nothing but what facets leave of curved skins.
struct FacetOverlap {
  std::size_t patch;
  double depth;  ///< average, over h
};

/// Of zones at an instant. What facets leave is that of the mesh: bodies bend by themselves.
class FacetGaps {
 public:
  /// All arguments must outlive it.
  FacetGaps(const Mesh& mesh, const Contact& definition, const ContactState& contact)
      : mesh_(mesh), definition_(definition), contact_(contact) {}
  /// Bodies are elsewhere from now on.
  void renew() { of_patches_.clear(); }
  /// Averages over the patches that press, or would if skins were curved; nothing where these have no curves.
  /// @param displacement (n_nodes, dimension)
  std::optional<FacetGap> of(std::int32_t zone, const Patchwise& patches, std::span<const double> displacement);
  /// At the initial geometry, the patch that overlaps most: nothing where most of what overlaps does by more than its facets
  /// explain; patches without curves are passed over.
  std::optional<FacetOverlap> overlap(std::int32_t zone);
  /// Where few of the patches press that would lie as near to their master as these if skins were curved.
  std::optional<AlternatingPressures> few_press(std::int32_t zone, const Patchwise& patches);

 private:
  using Arcs = std::map<std::int32_t, FacetArc>;  ///< by cells of the mesh, without corners of bodies
  struct Curves {
    Arcs slave, master;
    std::set<std::int32_t> left_by;  ///< facets that leave enough of them to be worth an alarm: cells of the mesh
  };
  const Curves& curves(std::int32_t zone);
  /// Of each patch that meets curves: what facets add to its gap.
  const std::map<std::size_t, double>& of_patches(std::int32_t zone);

  const Mesh& mesh_;
  const Contact& definition_;
  const ContactState& contact_;
  std::map<std::int32_t, Curves> curves_;  ///< of zones that have been asked for
  std::map<std::int32_t, std::map<std::size_t, double>> of_patches_;
};

}  // namespace lacon
