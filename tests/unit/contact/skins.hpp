#pragma once
// Two skins of mixed cells, for the tests of contact geometry.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "lacon/operators/contact/contact_geometry.hpp"

namespace lacon {

/// Two skins of n x n and m x m squares, every other one cut in two triangles: the slave above, which looks down, and the
/// master.
struct Skins {
  Mesh mesh;
  Model model;
  Contact contact;
  std::vector<double> displacement;

  Skins(int n, int m, bool smooth) {
    mesh.dimension = 3;
    ContactZone zone;
    zone.slave = add(n, false, 0);
    zone.master = add(m, true, -0.1);
    zone.jacobian = "ACTUALISE";
    mesh.patches.emplace();
    for (const std::int32_t cell : zone.slave) {
      const auto patch = static_cast<std::int32_t>(mesh.patches->kind.size());
      zone.patches.push_back(patch);
      mesh.patches->kind.push_back(0);
      contact.slaves.push_back({cell, patch, 0, ""});
    }
    contact.smoothing = smooth;
    contact.zones.push_back(zone);
    model.elements = {"3D/QUAD4", "3D/TRIA3"};
    for (const CellType type : mesh.types) model.element.push_back(type == CellType::QUAD4 ? 0 : 1);
    displacement.assign(mesh.coordinates.size(), 0.0);
  }

  std::vector<std::int32_t> add(int n, bool up, double z) {
    const auto first = static_cast<std::int32_t>(mesh.n_nodes());
    std::vector<std::int32_t> cells;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
        mesh.coordinates.insert(mesh.coordinates.end(), {x, y, z});
      }
    const auto push = [&](std::vector<std::int32_t> nodes) {
      if (!up) std::reverse(nodes.begin(), nodes.end());
      cells.push_back(static_cast<std::int32_t>(mesh.types.size()));
      mesh.types.push_back(nodes.size() == 4 ? CellType::QUAD4 : CellType::TRIA3);
      mesh.cells.push_back(nodes);
    };
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const std::int32_t a = first + j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
        if ((i + j) % 2 == 0) {
          push({a, b, c, d});
        } else {
          push({a, b, c});
          push({a, c, d});
        }
      }
    return cells;
  }
};

}  // namespace lacon
