#pragma once
// Symmetric tensors in rows of a field: components named by a prefix and two axes, SIXX or EPXY.
#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "lacon/structures/field.hpp"

namespace lacon {

/// The axes of a component's name, in the order in which fields list components.
struct TensorAxes {
  std::string_view name;
  int i, j;
};
inline constexpr std::array<TensorAxes, 6> tensor_axes{
    {{"XX", 0, 0}, {"YY", 1, 1}, {"ZZ", 2, 2}, {"XY", 0, 1}, {"XZ", 0, 2}, {"YZ", 1, 2}}};

/// Reads tensors of a field; a component that a row does not have is 0.
class TensorRows {
 public:
  /// @param prefix "SI" or "EP"
  TensorRows(const Field& field, std::string_view prefix) : field_(field) {
    for (std::size_t k = 0; k < tensor_axes.size(); ++k)
      column_[k] = field.component(std::string(prefix) + std::string(tensor_axes[k].name));
  }
  Eigen::Matrix3d operator[](std::size_t row) const {
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < tensor_axes.size(); ++k)
      if (column_[k] >= 0 && field_.has(row, static_cast<std::size_t>(column_[k]))) {
        const double value = field_.at(row, static_cast<std::size_t>(column_[k]));
        tensor(tensor_axes[k].i, tensor_axes[k].j) = tensor(tensor_axes[k].j, tensor_axes[k].i) = value;
      }
    return tensor;
  }
  /// False where the row has none of the components.
  bool has(std::size_t row) const {
    for (const int column : column_)
      if (column >= 0 && field_.has(row, static_cast<std::size_t>(column))) return true;
    return false;
  }

 private:
  const Field& field_;
  std::array<int, 6> column_{};
};

}  // namespace lacon
