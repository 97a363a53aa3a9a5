// What a degree of quadrature leaves of the patch test: a table in Markdown for docs/verification.md.
#include <cstdio>

#include "../unit/pairing/skins_in_space.hpp"

namespace {

using namespace lacon;
using namespace lacon::test;

struct Column {
  std::string name;
  Skin3 slave, master;
};

/// The smallest of |sin| at the corners: the scaled Jacobian of a skin.
double scaled_jacobian(const Skin3& skin) {
  double least = 1;
  for (std::size_t c = 0; c < skin.surface.size(); ++c)
    for (int i = 0; i < 4; ++i) {
      const auto at = [&](int k) { return skin.node(skin.surface.nodes[c][k % 4]); };
      const Vec3 a = at(i + 1) - at(i), b = at(i + 3) - at(i);
      least = std::min(least, std::abs(cross(a, b).z) / (norm(a) * norm(b)));
    }
  return least;
}

}  // namespace

int main() {
  std::vector<Column> columns;
  std::mt19937 random(31);
  for (const CellType type : {CellType::QUAD4, CellType::QUAD8, CellType::QUAD9}) {
    const std::string name(catalog::cell(type).name);
    columns.push_back({"E1 to E4, " + name, hexahedron_cut(type, false, 0.5),
                       mesh({4, 3, CellType::TRIA3, true, 0.24, -1, 1, -1, 1}, plane(0), random)});
  }
  for (const CellType type : {CellType::QUAD4, CellType::QUAD8, CellType::QUAD9}) {
    Skin3 slave = mesh({4, 4, type, false, 0.33}, plane(0), random), master = mesh({5, 3, type, true, 0.33}, plane(0), random);
    char quality[8];
    std::snprintf(quality, sizeof quality, "%.2f", std::min(scaled_jacobian(slave), scaled_jacobian(master)));
    columns.push_back({"distorted " + std::string(catalog::cell(type).name) + " (" + quality + ")", slave, master});
  }
  std::printf("| degree |");
  for (const Column& column : columns) std::printf(" %s |", column.name.c_str());
  std::printf("\n| --- |");
  for (std::size_t i = 0; i < columns.size(); ++i) std::printf(" --- |");
  for (const int degree : {4, 6, 8, 10, 12, 14, 18, 22, 26, 30, 0}) {
    if (degree > 0)
      std::printf("\n| %d |", degree);
    else
      std::printf("\n| as chosen |");
    for (Column& column : columns) std::printf(" %.0e |", patch_error(column.slave, column.master, {.degree = degree}));
  }
  std::printf("\n");
}
