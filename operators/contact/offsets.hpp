#pragma once
// DIST_ESCL and DIST_MAIT: by these the skins stand out of their cells.
#include <memory>
#include <vector>

#include "lacon/operators/program/study_function.hpp"
#include "lacon/structures/concepts.hpp"

namespace lacon {

/// What gaps are smaller by, at the nodes of the slave skins: the sum of both offsets. A function is one of the slave's places
/// on the initial geometry, as code_aster takes both at the slave's point; within a cell it is interpolated.
class ContactOffsets {
 public:
  ContactOffsets(const Mesh& mesh, const Contact& contact, const Base& base);

  /// For each zone (n_nodes of the mesh), 0 away from its slave skin; empty for a zone without offset.
  std::vector<std::vector<double>> at(double instant) const;

 private:
  struct Offset {
    std::size_t zone;
    std::vector<std::int32_t> nodes;
    std::vector<double> x, y, z;  ///< of these, where there is a function
    double number;
    std::unique_ptr<const StudyFunction> function;  ///< or nothing: the number counts
  };
  std::size_t n_nodes_, n_zones_;
  std::vector<Offset> offsets_;
};

}  // namespace lacon
