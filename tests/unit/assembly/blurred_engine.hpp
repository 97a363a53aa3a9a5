#pragma once
// An engine whose factor is poor, for what is made of a factor that says little of its matrix.
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "lacon/assembly/mumps_engine.hpp"

namespace lacon::test {

/// MUMPS, but substitutions are those of a matrix whose entries are off by some share, as with blocks of low rank.
class BlurredEngine : public FactorEngine {
 public:
  /// @param tell what is said of the factor beside what is true of an exact one
  BlurredEngine(double share, std::function<void(Factorisation&)> tell) : share_(share), tell_(std::move(tell)) {}
  void analyse(const SparseMatrix& matrix) override {
    exact_.analyse(matrix);
    blurred_.analyse(matrix);
  }
  Factorisation factorise(const SparseMatrix& matrix) override {
    Factorisation found = exact_.factorise(matrix);
    std::vector<double> values(matrix.values().begin(), matrix.values().end());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] *= 1 + share_ * std::sin(static_cast<double>(k));
    copy_ = matrix;
    copy_->restore(values);
    blurred_.factorise(*copy_);
    tell_(found);
    return found;
  }
  Solution solve(std::span<double> right_side) override { return exact_.solve(right_side); }
  void substitute(std::span<double> right_side) override { blurred_.substitute(right_side); }
  std::vector<float> substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                std::span<const double> value) override {
    return blurred_.substitute(offset, index, value);
  }

 private:
  double share_;
  std::function<void(Factorisation&)> tell_;
  MumpsEngine exact_, blurred_;
  std::optional<SparseMatrix> copy_;
};

}  // namespace lacon::test
