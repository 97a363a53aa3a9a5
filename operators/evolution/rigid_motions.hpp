#pragma once
// Rigid motions of the bodies of a problem: what they move its degrees of freedom by.
#include <Eigen/Dense>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "lacon/operators/evolution/bodies.hpp"
#include "lacon/operators/evolution/static_problem.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {

/// x, y, z and turns about them, about the middle of a body and of its size: 1 moves no node by much more than 1.
using MotionVector = Eigen::Vector<double, 6>;

class RigidMotions {
 public:
  RigidMotions(const StaticProblem& problem, const Bodies& bodies);

  struct Row {
    std::int32_t body;  ///< Bodies::of
    MotionVector by;    ///< what each motion moves the degree of freedom by
  };
  /// On the initial geometry; nothing for what is no displacement of a body.
  std::optional<Row> row(std::int64_t dof) const;
  /// The motions that there are, of six.
  const std::vector<int>& kinds() const { return kinds_; }
  std::vector<std::int32_t> bodies() const;
  /// Of a positive matrix of `kinds()`: the motions that it does not resist, (6, n).
  Eigen::Matrix<double, 6, Eigen::Dynamic> free_of(const Eigen::Matrix<double, 6, 6>& gram) const;

 private:
  struct Box {
    Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  };

  const StaticProblem& problem_;
  const Bodies& bodies_;
  std::vector<int> kinds_;
  std::map<std::int32_t, Box> boxes_;
};

}  // namespace lacon
