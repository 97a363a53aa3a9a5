#pragma once
// Rigid motions of bodies: what they move displacements by.
#include <Eigen/Dense>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "lacon/structures/vector.hpp"

namespace lacon {

/// x, y, z and turns about them, about the middle of a body and of its size: 1 moves no node by much more than 1.
using MotionVector = Eigen::Vector<double, 6>;

/// Where bodies are, at first.
struct BodyGeometry {
  int dimension = 3;
  bool is_of_revolution = false;
  std::span<const double> coordinates;  ///< (n_nodes, 3)
  std::vector<std::int32_t> body;       ///< (n_nodes): any number, the same one for all nodes of a body; -1: of none
};

class RigidMotions {
 public:
  /// @param geometry its coordinates must outlive it; a body is more than a point
  explicit RigidMotions(BodyGeometry geometry);

  struct Row {
    std::int32_t body;
    MotionVector by;  ///< what each motion moves the displacement by
  };
  /// Nothing for a node of no body.
  std::optional<Row> row(std::int64_t node, int axis) const;
  std::vector<std::int32_t> bodies() const;
  /// Of a positive matrix of motions: those that it does not resist, (6, n).
  Eigen::Matrix<double, 6, Eigen::Dynamic> free_of(const Eigen::Matrix<double, 6, 6>& gram) const;

 private:
  struct Box {
    Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  };

  BodyGeometry geometry_;
  std::vector<int> kinds_;  ///< the motions that there are, of six
  std::map<std::int32_t, Box> boxes_;
};

}  // namespace lacon
