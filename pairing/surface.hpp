#pragma once
// A skin as pairing sees it: cells, and where their nodes are now.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/catalog/cells.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

/// How a slave cell in space is cut into pieces. What its shape asks for changes by leaps, and integrals with it; where they
/// have to be smooth, a cell stays cut as finely as any shape has asked for before.
struct SlaveCut {
  std::uint8_t steps = 1;  ///< of a grid of triangles
  bool curved = false;     ///< its edges, at some time
  bool affine = false;     ///< its map nearly was, at some time
  bool kept = false;       ///< the present shape asks for less

  void refine(const SlaveCut& before) {
    kept = before.steps > steps || (before.curved && !curved) || (before.affine && !affine);
    steps = std::max(steps, before.steps);
    curved = curved || before.curved;
    affine = affine || before.affine;
  }
};

/// One side of a contact zone. Node numbers are rows of `coordinates` and `normals`, which the caller owns and may move between
/// two pairings. A skin is oriented outward: in 2D the body lies to the left of a cell, and n = (t_y, -t_x) leaves it.
struct Surface {
  int dimension = 2;                    ///< of the space
  std::vector<CellType> types;          ///< of each cell
  Ragged<std::int32_t> nodes;           ///< of each cell, in the order of catalog/cells.toml
  std::span<const double> coordinates;  ///< (n_nodes, 3), current; z = 0 in 2D
  std::span<const double> normals;      ///< (n_nodes, 3), unit, outward (LISSAGE='OUI'), or empty: normals of the cells
  std::span<const std::uint8_t> inner =
      {};  ///< (n_nodes): 1 for nodes inside of a patch of several cells; empty: there are none
  /// In space, of each cell of a master: bit i is set where the skin goes on a little beyond the edge from vertex i to the
  /// next, as by its image in a plane of symmetry; empty: nowhere.
  std::span<const std::uint8_t> mirrored = {};
  /// Of each cell of a master: bit i is set where the skin ends or folds at its end or edge i (free_ends.hpp); empty: unknown.
  std::span<const std::uint8_t> free_ends = {};
  /// (n_nodes, 3), where nodes were when the bodies last were in balance; empty: where they are now. Limits of distance and of
  /// depth (PairingOptions) give way by what a couple has moved since.
  std::span<const double> rest = {};
  /// (n_nodes, 3), where nodes were when it was decided which cells are walls (was_wall()); empty: rest.
  std::span<const double> walls = {};
  /// (n_nodes): the body of each, any number; empty: unknown. Of a couple of one body that lies deep at rest, one cell is seen
  /// through it.
  std::span<const std::int32_t> body = {};
  /// Of each cell how thick its body is there (thickness.hpp); empty: unknown.
  std::span<const double> thickness = {};
  /// In space, of each cell of a slave: how it was cut before, which pairing refines; empty: each as its shape asks for now.
  std::span<SlaveCut> cuts = {};

  std::size_t size() const { return types.size(); }
  void add_cell(CellType type, std::span<const std::int32_t> cell_nodes) {
    types.push_back(type);
    nodes.push_back(cell_nodes);
  }
};

/// Of a skin that has Surface::body.
inline std::int32_t body_of(const Surface& skin, std::size_t cell) {
  return skin.body[static_cast<std::size_t>(skin.nodes[cell][0])];
}

/// Outward, unit, of the vertices of a skin cell; zero where they have none. @param coordinates (n_nodes, 3)
Vec3 normal_of(CellType type, std::span<const std::int32_t> nodes, std::span<const double> coordinates);

/// The mean of nodes. @param coordinates (n_nodes, 3)
Vec3 middle_of(std::span<const std::int32_t> nodes, std::span<const double> coordinates);

/// The cells `cells` of a mesh as a surface; cell i of it is mesh cell cells[i]. @param coordinates (n_nodes, 3), current
Surface surface_of(const Mesh& mesh, std::span<const std::int32_t> cells, std::span<const double> coordinates);

}  // namespace lacon
