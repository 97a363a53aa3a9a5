#include "lacon/operators/affe_cara_elem/affe_cara_elem.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

using Matrix = std::array<double, 6>;  // Spring::stiffness

constexpr double same_stiffness = 1e-12;  ///< of the largest value

/// One occurrence of DISCRET or DISCRET_2D.
struct Discrete {
  Keywords keywords;
  int dimension;
};

/// Place of the entry (i, j), j <= i, in a lower triangle.
std::size_t entry(int i, int j) { return static_cast<std::size_t>(i * (i + 1) / 2 + j); }

/// What K_T_L says of both nodes is a spring between them, which a motion of both leaves alone: S, -S and S are its blocks.
/// Throws DISCRET_5 for any other matrix.
Matrix matrix_of_link(const Discrete& discrete, const std::vector<double>& values) {
  const int d = discrete.dimension;
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  Matrix matrix{};
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j) {
      const double first = values[i < j ? entry(j, i) : entry(i, j)], between = values[entry(d + i, j)],
                   second = values[i < j ? entry(d + j, d + i) : entry(d + i, d + j)];
      if (std::max(std::abs(first + between), std::abs(first - second)) > same_stiffness * largest)
        fail("DISCRET_5", {{"keyword", discrete.keywords.path("VALE")}});
      if (j <= i) matrix[entry(i, j)] = first;
    }
  return matrix;
}

/// The values as a matrix: those of a diagonal, or an upper triangle column by column, which is a lower one row by row.
Matrix matrix_of(const Discrete& discrete) {
  const std::vector<double> values = discrete.keywords.reals("VALE");
  const std::string kind = discrete.keywords.text("CARA");
  const int d = discrete.dimension;
  const bool whole = kind == "K_T_N", link = kind == "K_T_L";
  const auto wanted = static_cast<std::size_t>(link ? d * (2 * d + 1) : whole ? d * (d + 1) / 2 : d);
  if (values.size() != wanted)
    fail("DISCRET_3", {{"keyword", discrete.keywords.path("VALE")},
                       {"count", std::to_string(values.size())},
                       {"wanted", std::to_string(wanted)},
                       {"kind", kind}});
  if (link) return matrix_of_link(discrete, values);
  Matrix matrix{};
  for (std::size_t i = 0; i < wanted; ++i) matrix[whole ? i : entry(static_cast<int>(i), static_cast<int>(i))] = values[i];
  return matrix;
}

/// The stiffness along a direction, and another one across it, in the axes of the mesh.
Matrix turned(const Vec3& along, double stiffness, double across, int dimension) {
  Matrix matrix{};
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j <= i; ++j)
      matrix[entry(i, j)] = (stiffness - across) * component(along, i) * component(along, j) + (i == j ? across : 0);
  return matrix;
}

/// The matrix in the axes of the cell: its first direction is along the cell, the others are alike.
Matrix along_the_cell(const Discrete& discrete, const Mesh& mesh, std::int32_t cell, const Matrix& given) {
  const auto nodes = mesh.cells[static_cast<std::size_t>(cell)];
  const double* const x = mesh.coordinates.data();
  const Vec3 way = vector_at(x + 3 * std::ptrdiff_t{nodes.back()}) - vector_at(x + 3 * std::ptrdiff_t{nodes.front()});
  const double length = norm(way);
  const bool diagonal = given[entry(1, 0)] == 0 && given[entry(2, 0)] == 0 && given[entry(2, 1)] == 0;
  if (nodes.size() < 2 || !(length > 0) || !diagonal || (discrete.dimension == 3 && given[entry(1, 1)] != given[entry(2, 2)]))
    fail("DISCRET_4", {{"keyword", discrete.keywords.path("REPERE")}, {"cell", cell_name(cell)}});
  return turned(way / length, given[entry(0, 0)], given[entry(1, 1)], discrete.dimension);
}

/// Throws DISCRET_1, DISCRET_2.
void check_cell(const Discrete& discrete, const Mesh& mesh, const Model& model, const Registry& registry, std::int32_t cell) {
  const std::string cara = discrete.keywords.text("CARA"), type(mesh.row(static_cast<std::size_t>(cell)).name);
  const std::int32_t element = model.element[static_cast<std::size_t>(cell)];
  const catalog::ElementRow* const row =
      element < 0 ? nullptr : registry.find_element(model.elements[static_cast<std::size_t>(element)]);
  if (!row || row->role != catalog::Role::discrete || catalog::dimension_of(row->geometry) != discrete.dimension)
    fail("DISCRET_1", {{"keyword", discrete.keywords.path("GROUP_MA")},
                       {"cell", cell_name(cell)},
                       {"type", type},
                       {"element", row ? std::string(row->name) : part("none")},
                       {"modelisation", discrete.dimension == 3 ? "DIS_T" : "2D_DIS_T"}});
  if (cara.ends_with("_L") != (row->cell == CellType::SEG2))
    fail("DISCRET_2", {{"keyword", discrete.keywords.path("CARA")}, {"kind", cara}, {"cell", cell_name(cell)}, {"type", type}});
}

}  // namespace

ElementCharacteristics affe_cara_elem(const Mesh& mesh, const Model& model, const Registry& registry,
                                      const Keywords& keywords) {
  std::vector<Discrete> occurrences;
  for (const Keywords& factor : keywords.factors("DISCRET")) occurrences.push_back({factor, 3});
  for (const Keywords& factor : keywords.factors("DISCRET_2D")) occurrences.push_back({factor, 2});
  std::map<std::int32_t, Spring> of_cell;
  for (const Discrete& discrete : occurrences) {
    const Matrix given = matrix_of(discrete);
    for (const std::string& group : discrete.keywords.texts("GROUP_MA"))
      for (const std::int32_t cell : cells_of_group(mesh, group, discrete.keywords.path("GROUP_MA"))) {
        check_cell(discrete, mesh, model, registry, cell);
        const auto nodes = mesh.cells[static_cast<std::size_t>(cell)];
        Spring& spring = of_cell[cell] = {.first = nodes[0]};
        if (nodes.size() > 1) spring.second = nodes[1];
        spring.stiffness = discrete.keywords.text("REPERE") == "LOCAL" ? along_the_cell(discrete, mesh, cell, given) : given;
      }
  }
  ElementCharacteristics characteristics;
  characteristics.mesh = model.mesh;
  for (const auto& [cell, spring] : of_cell) characteristics.springs.push_back(spring);
  fmt::print("  {} springs\n", characteristics.springs.size());
  return characteristics;
}

}  // namespace lacon
