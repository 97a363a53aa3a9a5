#pragma once
// Solid elements for tests: rows, and a cell of each kind.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "lacon/elements/reference.hpp"
#include "lacon/elements/registry.hpp"

constexpr double eps = 2.3e-16;
constexpr double garbage = 7e7;  // what outputs hold before a kernel runs

inline lacon::Registry& registry() {
  static lacon::Registry all;
  return all;
}

inline std::size_t z(int i) { return static_cast<std::size_t>(i); }

inline lacon::Tabulation table_of(const lacon::catalog::ElementRow& row) {
  return lacon::tabulate(row.cell, lacon::integration_rule(lacon::catalog::cell(row.cell).family, row.points));
}

/// Coordinates (n_nodes, dimension) of a cell: straight-sided, its vertices shaken: no parallelogram, no plane face of four
/// vertices. Away from the axis.
inline std::vector<double> shaken(const lacon::catalog::CellRow& cell) {
  const int D = cell.dimension;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shake(-0.12, 0.12);
  const auto& linear = lacon::catalog::cell(cell.linear);
  std::vector<double> vertices(linear.nodes.begin(), linear.nodes.end()), points, shape(z(linear.n_nodes));
  for (double& coordinate : vertices) coordinate += shake(random);
  for (int a = 0; a < cell.n_nodes; ++a) {
    lacon::shape_functions(cell.linear, cell.nodes.subspan(z(a * D), z(D)), shape);
    for (int i = 0; i < D; ++i) {
      double value = i == 0 ? 2 : -1;
      for (int v = 0; v < linear.n_nodes; ++v) value += shape[z(v)] * vertices[z(v * D + i)];
      points.push_back(value);
    }
  }
  return points;
}

/// Rows of the catalogue for which `wanted` holds, less those with the kernels of one before: D_PLAN_SI/TRIA3.
template <class Wanted>
std::vector<const lacon::catalog::ElementRow*> rows_where(const Wanted& wanted) {
  std::vector<const lacon::catalog::ElementRow*> rows;
  for (const auto& row : lacon::catalog::elements()) {
    if (!wanted(row)) continue;
    const auto is_the_same = [&](const lacon::catalog::ElementRow* other) {
      return other->cell == row.cell && other->geometry == row.geometry && other->stress_state == row.stress_state &&
             row.name.starts_with(other->modelisation);
    };
    if (std::ranges::none_of(rows, is_the_same)) rows.push_back(&row);
  }
  return rows;
}

inline std::vector<const lacon::catalog::ElementRow*> solids() {
  return rows_where([](const auto& row) { return row.role == lacon::catalog::Role::solid; });
}

/// "D_PLAN_TRIA3"
inline std::string test_name(const lacon::catalog::ElementRow& row) {
  std::string name(row.name);
  name[name.find('/')] = '_';
  return name;
}
