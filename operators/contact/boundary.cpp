#include "lacon/operators/contact/boundary.hpp"

#include <set>
#include <vector>

#include "lacon/catalog/cells.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/meshing/open_facets.hpp"

namespace lacon {

Surface boundary_of(const Mesh& mesh, const Model& model, const Contact& contact, std::span<const std::int32_t> body,
                    std::span<const double> coordinates) {
  const auto body_of_cell = [&](std::size_t cell) { return body[static_cast<std::size_t>(mesh.cells[cell][0])]; };
  std::set<std::int32_t> touching;
  for (const ContactZone& zone : contact.zones)
    for (const std::vector<std::int32_t>* side : {&zone.slave, &zone.master})
      for (const std::int32_t cell : *side) touching.insert(body_of_cell(static_cast<std::size_t>(cell)));
  std::vector<char> counts(mesh.n_cells());
  for (std::size_t cell = 0; cell < counts.size(); ++cell)
    counts[cell] = model.element[cell] >= 0 && touching.contains(body_of_cell(cell));

  Surface boundary{.dimension = mesh.dimension, .coordinates = coordinates, .body = body};
  std::vector<std::int32_t> nodes;
  for (const OpenFacet& open : open_facets(mesh, mesh.dimension, counts)) {
    const auto cell = mesh.cells[static_cast<std::size_t>(open.cell)];
    const auto& facet =
        catalog::cell(mesh.types[static_cast<std::size_t>(open.cell)]).facets[static_cast<std::size_t>(open.facet)];
    nodes.clear();
    for (const auto node : facet.nodes) nodes.push_back(cell[static_cast<std::size_t>(node)]);
    // a cell of the mesh may be inside out
    const Vec3 away = middle_of(nodes, coordinates) - middle_of(cell, coordinates);
    if (dot(normal_of(facet.type, nodes, coordinates), away) < 0) nodes = mirrored(facet.type, nodes);
    boundary.add_cell(facet.type, nodes);
  }
  return boundary;
}

}  // namespace lacon
