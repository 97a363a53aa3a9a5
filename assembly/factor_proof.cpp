#include "lacon/assembly/factor_proof.hpp"

#include <algorithm>
#include <cmath>

#include "lacon/assembly/any_signs.hpp"

namespace lacon {
namespace {

constexpr double most_left = 0.3;
constexpr int most_looks = 3;

}  // namespace

double scaled_norm(std::span<const double> scale, std::span<const double> residual) {
  double sum = 0;
  for (std::size_t i = 0; i < residual.size(); ++i) sum += scale[i] * residual[i] * scale[i] * residual[i];
  return std::sqrt(sum);
}

double residual_share(const SparseMatrix& matrix, std::span<const double> scale, std::span<const double> residual,
                      std::span<const double> x, std::span<const double> right_side) {
  std::vector<double> sums(x.size());
  matrix.multiply_magnitudes(x, sums);
  double most = 0, error = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sums[i] = scale[i] * (sums[i] + std::abs(right_side[i]));
    most = std::max(most, sums[i]);
  }
  if (most == 0) return 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double now = scale[i] * std::abs(residual[i]) / (sums[i] + 1e-6 * most);
    error = now <= error ? error : now;  // what is no number stays
  }
  return error;
}

FactorProof::FactorProof(const SparseMatrix& matrix, std::span<const double> scale)
    : matrix_(matrix), scale_(scale), left_(any_signs(scale.size())) {
  for (std::size_t i = 0; i < left_.size(); ++i) left_[i] /= scale[i];
  size_ = scaled_norm(scale, left_);
}

std::optional<std::vector<double>> FactorProof::next() const {
  if (looks_ == most_looks || !(size_ > 0)) return std::nullopt;
  return left_;
}

bool FactorProof::look(std::span<const double> x) {
  std::vector<double> image(x.size());
  matrix_.multiply(x, image);
  for (std::size_t i = 0; i < x.size(); ++i) left_[i] -= image[i];
  const double now = scaled_norm(scale_, left_), share = now / size_;
  error_ = share <= error_ ? error_ : share;  // what is no number stays
  size_ = now;
  ++looks_;
  return error_ <= most_left;
}

}  // namespace lacon
