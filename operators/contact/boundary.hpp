#pragma once
// The skin of the bodies that take part in contact, of which zones have a part alone.
#include "lacon/pairing/surface.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

/// The facets of the model's cells that no second one has, of bodies that have cells in a zone, oriented outward.
/// @param body (n_nodes): Bodies::of  @param coordinates (n_nodes, 3), current; as `body` the caller owns them
Surface boundary_of(const Mesh& mesh, const Model& model, const Contact& contact, std::span<const std::int32_t> body,
                    std::span<const double> coordinates);

}  // namespace lacon
