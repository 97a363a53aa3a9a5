#pragma once
// PRE_EPSI: strains that loads give to bodies, which make no stress, at integration points.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lacon/operators/fields/cell_points.hpp"
#include "lacon/operators/fields/timed_values.hpp"
#include "lacon/structures/base.hpp"

namespace lacon {

class InitialStrains {
 public:
  /// Add those of a load, times its function of time. @param points of its model
  void add(const Base& base, const ResultLoad& excit, const Mesh& mesh, ModelPoints& points);

  bool empty() const { return parts_.empty(); }
  bool concerns(std::int32_t cell) const;
  /// Components in the order of tensor_axes (tensor.hpp), those of shear as of a tensor: (cells, n_points, 6). @param cells of
  /// the same number of points
  std::vector<double> at(double instant, std::span<const std::int32_t> cells, int n_points) const;

 private:
  struct Part {
    std::optional<StudyFunction> multiplier;
    std::vector<std::int64_t> first;  ///< point of each cell of the mesh, -1 for none
    TimedValues values;               ///< (points, 6)
  };
  std::vector<Part> parts_;
};

}  // namespace lacon
