#pragma once
// How cells have moved: by what they have turned, and are strained and compressed.
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>

#include "lacon/operators/evolution/problem/static_problem.hpp"

namespace lacon {

/// The motion of a cell, at one of its points: the turn and the largest strain that small displacements make of it, and by what
/// its shortest length is less than it was.
struct CellMotion {
  std::int32_t cell;
  double turn, strain, shortening;
};

/// At a point of the cell set.cells[i]. @param displacement (n_nodes, set.n_components)
CellMotion motion_of(const ElementSet& set, std::size_t i, const Mesh& mesh, std::span<const double> displacement,
                     int point = 0);

/// Of a bar under the law of St. Venant and Kirchhoff: its force E (l^3 - l) / 2 at the stretch l is largest in compression at
/// 1 / sqrt(3), and falls beyond.
constexpr double most_shortened = 1 - 1 / std::numbers::sqrt3;

/// Whether elasticity under Green-Lagrange strains is the law of the set's cells.
bool softens_in_compression(const ElementSet& set);

/// The cell under such a law that is compressed most, if by more than most_shortened.
std::optional<CellMotion> most_softened(const StaticProblem& problem, std::span<const double> displacement);

}  // namespace lacon
