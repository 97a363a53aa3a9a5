#pragma once
// Which cells a row of POST_ELEM is about.
#include <string>
#include <vector>

#include "lacon/operators/fields/cell_points.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// Entity and place are ENTITE and LIEU of the row; one entry of `cells` for each cell of the mesh.
struct Part {
  std::string entity, place;
  std::vector<char> cells;
};

/// "TOUT" and the body cells of the model, or each group of GROUP_MA and its cells. Throws MESH_1.
std::vector<Part> parts_of(const Mesh& mesh, const ModelPoints& points, const Keywords& factor);

}  // namespace lacon
