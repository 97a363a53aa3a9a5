#pragma once
// The integrated gap of a contact cell as a function of the nodes: its first and second derivatives, exact for what is computed
// (METHOD.md 5.4 c). Images move along the master, corners of the polygon with the nodes that cut them out, normals and measure
// with the slave.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lacon/catalog/cells.hpp"
#include "lacon/pairing/pairing.hpp"

namespace lacon {

/// A contact cell as its integrated gap sees it. Its unknowns are the coordinates of the slave's nodes, then of the master's,
/// then of the nodes of other masters that bound the polygon, and behind them the nodal normals of the slave (LISSAGE).
struct ContactCellGeometry {
  CellType slave{}, master{};
  int dimension = 2;
  bool axis = false;              ///< half a plane through the axis of revolution: integrals have the factor r
  bool current_jacobian = false;  ///< TYPE_JACOBIEN='ACTUALISE'
  double steep = 0;               ///< steep_cosine() of the pairing: weights of points have the couple's share as factor
  std::span<const double> slave_initial, slave_nodes, master_nodes;  ///< (n, dimension)
  std::span<const double> other_nodes;                               ///< (n, dimension): further nodes that bound the polygon
  std::span<const double> slave_normals;                             ///< (n, dimension), nodal, or empty
  std::span<const double> slave_offset;                              ///< (n): by this gaps are smaller, or empty
  std::span<const double> slave_point, master_point, weight;         ///< of the integration points, as in ContactCells
  /// In the plane: the ends of the interval, and what they move with.
  struct End {
    double at;           ///< reference coordinate
    int node;            ///< behind which node its normal ends it: of the unknowns' nodes; -1: an end of the slave itself
    double crossing;     ///< where that normal crosses the slave
    bool still = false;  ///< derivatives take its place for fixed
  };
  End ends[2] = {{-1, -1, -1}, {1, -1, 1}};
  double fading = 0;  ///< PairingOptions::fading: how ends depend on these places where they differ
  /// In space: what the polygon hangs on, and of each of its lines the nodes of the master that it is drawn on: of the
  /// unknowns' nodes.
  const PolygonTrace* trace = nullptr;
  struct LineNodes {
    CellType type{};
    std::array<int, 9> node{};
    bool still = false;  ///< the line keeps its place on the slave
  };
  std::vector<LineNodes> lines;

  int n_nodes() const;     ///< slave, master and others
  int n_unknowns() const;  ///< with nodal normals
};

/// What derivatives leave out that take an end of the cover for still.
struct MovingEnd {
  double gap = 0;                ///< dG by its place
  std::vector<double> gradient;  ///< (n_unknowns): of the gradient of G by its place
  std::vector<double> place;     ///< (n_unknowns): of its place by the unknowns
};

/// Derivatives of G.
struct GapVariation {
  double gap = 0;                ///< G
  std::vector<double> gradient;  ///< (n_unknowns)
  std::vector<double> hessian;   ///< (n_unknowns, n_unknowns), symmetric; empty where it was not asked for
  std::vector<MovingEnd> ends;   ///< of ends that are still, in space three of each line; empty without second derivatives
};

/// @param second whether second derivatives are wanted  @param[out] variation its memory is used again
void vary_gap(const ContactCellGeometry& cell, bool second, GapVariation& variation);

}  // namespace lacon
