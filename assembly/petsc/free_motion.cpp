#include "lacon/assembly/petsc/free_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace lacon {
namespace {

using Motions = Eigen::Vector<double, 6>;
using Gram = Eigen::Matrix<double, 6, 6>;

/// What resists a motion of displacements up to 1, summed up over the rows, squares of parts of their diagonals: below it,
/// there is but round-off.
constexpr double negligible = 1e-12;
/// Loose bodies that are looked at together.
constexpr std::size_t most_bodies = 200;

/// What the rigid motions of each body do to each row of displacements, up to 1.
class RigidMotions {
 public:
  RigidMotions(const BlockSystem& system, std::span<const std::int32_t> body)
      : system_(system),
        low_(n_bodies(body), Eigen::Vector3d::Constant(INFINITY)),
        high_(low_.size(), Eigen::Vector3d::Constant(-INFINITY)) {
    for (std::int64_t block = 0; block < system.sizes.n_blocks; ++block) {
      low_[body[block]] = low_[body[block]].cwiseMin(at(block));
      high_[body[block]] = high_[body[block]].cwiseMax(at(block));
    }
  }

  Motions of(std::int32_t row, std::int32_t body) const {
    const int dimension = system_.sizes.dimension, axis = row % dimension;
    const double size = std::max((high_[body] - low_[body]).norm(), 1e-300);
    const Eigen::Vector3d lever = (2 * at(row / dimension) - low_[body] - high_[body]) / size;
    Motions motions = Motions::Zero();
    motions[axis] = 1;
    for (int turn = dimension == 3 ? 0 : 2; turn < 3; ++turn) {
      const Eigen::Vector3d about = Eigen::Vector3d::Unit(turn);
      motions[3 + turn] = about.cross(lever)[axis];
    }
    return motions;
  }
  std::size_t n_bodies() const { return low_.size(); }

 private:
  static std::size_t n_bodies(std::span<const std::int32_t> body) {
    return 1 + static_cast<std::size_t>(*std::max_element(body.begin(), body.end()));
  }
  Eigen::Vector3d at(std::int64_t block) const {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int i = 0; i < system_.sizes.dimension; ++i) x[i] = system_.coordinates[block * system_.sizes.dimension + i];
    return x;
  }

  const BlockSystem& system_;
  std::vector<Eigen::Vector3d> low_, high_;
};

/// The matrix times all motions, the largest entry of a row being 1: of rows of displacements what their own body does to them,
/// and of all rows what others do.
class Resistance {
 public:
  Resistance(const BlockSystem& system, std::span<const std::int32_t> body, const RigidMotions& motions)
      : own(system.sizes.n_blocks * system.sizes.dimension, Motions::Zero()) {
    std::vector<double> largest(own.size(), 0.0), of_multiplier(system.sizes.n_multipliers, 0.0);
    const auto add = [&](std::int32_t row, std::int32_t column, double value) {
      double& most = row >= 0 ? largest[row] : of_multiplier[-1 - row];
      most = std::max(most, std::abs(value));
      if (column < 0) return;
      const std::int32_t dimension = system.sizes.dimension, moved = body[column / dimension];
      const Motions force = value * motions.of(column, moved);
      if (row >= 0 && body[row / dimension] == moved)
        own[row] += force;
      else
        others.try_emplace({row, moved}, Motions::Zero()).first->second += force;
    };
    for (std::int64_t i = 0; i < system.sizes.n; ++i)
      for (std::int64_t k = system.row[i]; k < system.row[i + 1]; ++k) {
        const std::int64_t j = system.column[k];
        add(system.place[i], system.place[j], system.value[k]);
        if (system.sizes.is_symmetric && i != j) add(system.place[j], system.place[i], system.value[k]);
      }
    for (std::size_t row = 0; row < own.size(); ++row)
      if (largest[row] > 0) own[row] /= largest[row];
    for (auto& [where, force] : others) {
      const double most = where.first >= 0 ? largest[where.first] : of_multiplier[-1 - where.first];
      if (most > 0) force /= most;
    }
  }

  std::vector<Motions> own;
  std::map<std::pair<std::int32_t, std::int32_t>, Motions> others;  ///< by row and body
};

/// The part of six motions that moves nothing: out of the plane, a turn of one node, what is imposed.
/// @param moved sum of motion motion^T over what they move
Gram of_no_motion(const Gram& moved) {
  const Eigen::SelfAdjointEigenSolver<Gram> parts(moved);
  Gram sum = Gram::Zero();
  for (int i = 0; i < 6; ++i)
    if (parts.eigenvalues()[i] <= negligible * std::max(1.0, parts.eigenvalues()[5]))
      sum += parts.eigenvectors().col(i) * parts.eigenvectors().col(i).transpose();
  return sum;
}

}  // namespace

bool has_free_motion(const BlockSystem& system, std::span<const std::int32_t> body) {
  if (body.empty()) return false;
  const RigidMotions motions(system, body);
  const Resistance resistance(system, body, motions);
  std::vector<Gram> alone(motions.n_bodies(), Gram::Zero()), moved(motions.n_bodies(), Gram::Zero());
  for (const std::int32_t row : system.place) {
    if (row < 0) continue;
    const std::int32_t of = body[row / system.sizes.dimension];
    alone[of] += resistance.own[row] * resistance.own[row].transpose();
    moved[of] += motions.of(row, of) * motions.of(row, of).transpose();
  }
  for (std::size_t b = 0; b < alone.size(); ++b) alone[b] += of_no_motion(moved[b]);

  // a body that is held alone need not be looked at any more
  std::map<std::int32_t, Eigen::Index> loose;
  for (std::size_t b = 0; b < alone.size(); ++b)
    if (Eigen::SelfAdjointEigenSolver<Gram>(alone[b], Eigen::EigenvaluesOnly).eigenvalues()[0] < negligible)
      loose.emplace(static_cast<std::int32_t>(b), 6 * static_cast<Eigen::Index>(loose.size()));
  if (loose.empty() || loose.size() > most_bodies) return false;
  const auto size = 6 * static_cast<Eigen::Index>(loose.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(size, size);
  for (const auto& [b, at] : loose) gram.block<6, 6>(at, at) = alone[b];
  const auto add = [&](const auto& x, const auto& y) {
    const auto i = loose.find(x.first), j = loose.find(y.first);
    if (i != loose.end() && j != loose.end()) gram.block<6, 6>(i->second, j->second) += x.second * y.second.transpose();
  };
  for (auto first = resistance.others.begin(); first != resistance.others.end();) {
    const std::int32_t row = first->first.first;
    std::vector<std::pair<std::int32_t, Motions>> forces;
    for (; first != resistance.others.end() && first->first.first == row; ++first)
      forces.emplace_back(first->first.second, first->second);
    const std::size_t n_others = forces.size();
    if (row >= 0) forces.emplace_back(body[row / system.sizes.dimension], resistance.own[row]);
    for (std::size_t i = 0; i < forces.size(); ++i)
      for (std::size_t j = 0; j < forces.size(); ++j)
        if (i < n_others || j < n_others) add(forces[i], forces[j]);  // what its own body does to a row is there
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram, Eigen::EigenvaluesOnly).eigenvalues()[0] < negligible;
}

}  // namespace lacon
