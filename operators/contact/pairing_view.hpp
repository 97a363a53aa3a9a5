#pragma once
// A look at the pairing of an instant: contact cells, integration points, covered fractions and rejected couples as meshes with
// fields on their cells, and as lines of text.
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacon/elements/registry.hpp"
#include "lacon/operators/contact/kept_pairing.hpp"
#include "lacon/pairing/pairing.hpp"
#include "lacon/structures/base.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {

/// A mesh made for looking, and fields of one component (TO_MASTER: a vector) on its cells. Numbers of cells, patches and zones
/// in fields count from 1, as in M12.
struct PairingLayer {
  std::string name;
  Mesh mesh;
  std::vector<Field> fields;
};

struct PairingView {
  /// Those that have cells, of
  ///   PAIRS     the clipped polygons on the slave (segments in the plane): ZONE, PATCH, SLAVE, MASTER, GAP, MEASURE, FRACTION
  ///   (of
  ///             the patch); a polygon of more than four corners is a fan of triangles, which share these values
  ///   SKINS     the slave and master cells where they are now, with groups by role: ZONE, CELL, COUPLES, REJECTED; on slave
  ///   cells PATCH,
  ///             COVERAGE and GAP of the patch; with a result STATUS and PRESSURE
  ///   POINTS    the integration points on the slave: ZONE, PATCH, SLAVE, MASTER, GAP, WEIGHT, TO_MASTER
  ///   REJECTED  a line from the slave's middle to the master's for each rejected couple (a point for a degenerate cell), a
  ///             group for each reason: ZONE, SLAVE, MASTER, REASON
  std::vector<PairingLayer> layers;
  /// For each zone what is covered and rejected; the patches that are covered least, with their couples and rejected couples.
  std::vector<std::string> report;
};

/// When a pairing is looked at: by default before any instant.
struct ViewedInstant {
  std::vector<double> displacement = {};          ///< (n_nodes, mesh.dimension), empty for the initial geometry
  std::vector<HeldDirection> held = {};           ///< by loads, ContactGeometry::find_ends
  std::vector<std::vector<double>> offsets = {};  ///< of the skins, ContactOffsets::at
  std::optional<Field> cont_elem = {};            ///< of a result
  KeptPairing kept = {};                          ///< likewise, beside it
};

/// Pair on the geometry at an instant. Throws EVOLUTION_3 for a slave cell without normal, EVOLUTION_8 for one beyond the axis.
PairingView view_pairing(const Mesh& mesh, const Model& model, const Contact& contact, Registry& registry,
                         const ViewedInstant& instant);

/// Why a couple was rejected, in the user's language.
std::string rejection_words(Rejection rejection);

}  // namespace lacon
