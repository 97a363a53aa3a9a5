#include "lacon/operators/modi_maillage/deform.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

/// What tells coordinates from others: sums of each, of squares, and of products with the number of the node.
std::vector<double> sums(const Mesh& mesh) {
  std::vector<double> found(7, 0.0);
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n)
    for (std::size_t d = 0; d < 3; ++d) {
      const double x = mesh.coordinates[3 * n + d];
      found[d] += x;
      found[3 + d] += x * (1 + static_cast<double>(n) / static_cast<double>(mesh.n_nodes()));
      found[6] += x * x;
    }
  return found;
}

/// Remember where nodes were before a field moved them, until another one has brought them back.
void note_place(Mesh& mesh, const std::vector<double>& before) {
  constexpr double round_off = 1e-12;
  if (mesh.first_place.empty()) mesh.first_place = before;
  const std::vector<double> now = sums(mesh);
  const double size = std::sqrt(static_cast<double>(mesh.n_nodes()) * std::max(now[6], before[6]));  // of sums of coordinates
  bool is_back = std::abs(now[6] - mesh.first_place[6]) <= round_off * std::max(now[6], before[6]);
  for (std::size_t k = 0; k < 6; ++k) is_back = is_back && std::abs(now[k] - mesh.first_place[k]) <= round_off * size;
  if (is_back) mesh.first_place.clear();
}

}  // namespace

void deform(Mesh& mesh, const Keywords& factor, const Base& base, const std::string& mesh_id) {
  const Field displacement = base.field(factor.concept_id("DEPL"));
  const std::string label = base.label(factor.concept_id("DEPL"));
  if (displacement.mesh != mesh_id && base.mesh(displacement.mesh).coordinates != mesh.coordinates)
    fail("CREACHAMP_5", {{"first", base.label(mesh_id)}, {"second", base.label(displacement.mesh)}});
  if (displacement.location != Location::nodes || displacement.quantity != "DEPL_R")
    fail("CREACHAMP_9", {{"field", label},
                         {"type", std::string(location_name(displacement.location)) + "_" + displacement.quantity},
                         {"wanted", "NOEU_DEPL_R"}});
  const std::vector<double> before = sums(mesh);
  mesh.coordinates = displaced(mesh, displacement);
  note_place(mesh, before);
}

}  // namespace lacon
