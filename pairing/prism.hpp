#pragma once
// What the normals of a convex piece of a slave may meet, however far they are followed in both directions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "lacon/structures/vector.hpp"

namespace lacon::space {

/// Walls around an outline, along its mean normal n, and how far the other normals lean over them. A point q = x + t m has the
/// height t = (q - x) . n over x if m is scaled to m . n = 1; then m leans by at most `lean` and q lies at most lean |t| beyond
/// the walls around the outline.
class Prism {
 public:
  /// Holds everything.
  Prism() = default;

  /// Walls through the edges of an outline, which is not behind them yet. @param outline (3 or 4), counter-clockwise around n,
  /// a unit normal
  Prism(std::span<const Vec3> outline, Vec3 n) : n_(n) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec3 out = cross(outline[(i + 1) % outline.size()] - outline[i], n);
      const double length = norm(out), scale = length > 0 ? 1 / length : 0;
      walls_.x[i] = scale * out.x, walls_.y[i] = scale * out.y, walls_.z[i] = scale * out.z;
      walls_.ax[i] = std::abs(walls_.x[i]), walls_.ay[i] = std::abs(walls_.y[i]), walls_.az[i] = std::abs(walls_.z[i]);
      walls_.offset[i] = -std::numeric_limits<double>::infinity();
    }
  }

  /// Normals start here, too.
  void hold(Vec3 x) {
    const FourWalls at = walls_.x * x.x + walls_.y * x.y + walls_.z * x.z;
    for (int i = 0; i < 4; ++i) walls_.offset[i] = std::max(walls_.offset[i], at[i]);
    height_ = std::max(height_, std::abs(dot(n_, x)));
  }

  /// A normal leans so, of any length but zero.
  void lean(Vec3 normal) {
    const double up = dot(normal, n_);
    lean_ = std::max(lean_, up > 0 ? norm(normal - up * n_) / up : std::numeric_limits<double>::infinity());
  }

  /// An allowance: walls go outward, and normals start as much higher and lower.
  void widen(double outward, double upward) {
    for (int i = 0; i < 4; ++i) walls_.offset[i] += outward;
    height_ += upward;
  }

  /// False only where no normal meets a box. @param half the halves of its sides
  bool touches(Vec3 centre, Vec3 half) const {
    const auto reach = [&](Vec3 d) { return half.x * std::abs(d.x) + half.y * std::abs(d.y) + half.z * std::abs(d.z); };
    const double leaning = lean_ > 0 ? lean_ * (std::abs(dot(centre, n_)) + reach(n_) + height_) : 0;
    const FourWalls beyond = walls_.x * centre.x + walls_.y * centre.y + walls_.z * centre.z -
                             (walls_.ax * half.x + walls_.ay * half.y + walls_.az * half.z) - walls_.offset;
    return !(std::max(std::max(beyond[0], beyond[1]), std::max(beyond[2], beyond[3])) > leaning);
  }

 private:
  /// A number of each wall, in vector registers.
  using FourWalls = double __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double))));
  /// Planes behind which normals start; out . x is nowhere larger than `offset` there. A triangle's fourth one is everywhere.
  struct Walls {
    FourWalls x{}, y{}, z{};     ///< out: unit, at a right angle to n
    FourWalls ax{}, ay{}, az{};  ///< |out|
    FourWalls offset{};
  } walls_;
  Vec3 n_{};
  double lean_ = 0;    ///< tangent of the largest angle between a normal and n, or infinity
  double height_ = 0;  ///< largest |n . x| where they start
};

}  // namespace lacon::space
