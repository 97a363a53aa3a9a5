#pragma once
// Axes that differ from place to place, and vectors and tensors of fields in them: REPERE of MODI_REPERE and MACR_LIGN_COUPE.
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "lacon/structures/field.hpp"
#include "lacon/structures/mesh.hpp"
#include "lacon/structures/order.hpp"

namespace lacon {

/// Axes at any place, as unit vectors in the rows of a matrix.
class Frame {
 public:
  /// @param keywords where the axes are given: of `cylindrical` ones ORIGINE and in space AXE_Z (X radial, Y along the axis, Z
  /// tangential; in the plane X radial, Y tangential), else ANGL_NAUT in degrees (about Z, the new Y, the new X), or VECT_X and
  /// a vector VECT_Y in the new plane of X and Y. Throws MODIREPERE_5 where they are missing or are no axes.
  Frame(const Mesh& mesh, const Keywords& keywords, bool cylindrical);

  bool depends_on_place() const { return origin_.has_value(); }
  /// From the axis to a place, of axes that depend on it.
  Eigen::Vector3d radius(const Eigen::Vector3d& place) const;
  /// @param lost counts places on the axis itself, where any direction across it is taken for radial
  Eigen::Matrix3d at(const Eigen::Vector3d& place, std::size_t& lost) const;

 private:
  bool plane_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
  std::optional<Eigen::Vector3d> origin_;
  Eigen::Vector3d line_ = Eigen::Vector3d::UnitZ();
  double least_ = 0;
};

/// Which components of a field are those of one vector (X, Y, Z) or one tensor (XX, YY, ZZ, XY, XZ, YZ), -1 where it has none.
struct Turned {
  std::array<int, 6> column;
  bool tensor;
};

/// The vectors DX ..., FX ..., VX ... and tensors SIXX ..., EPXX ... of a field.
std::vector<Turned> turned_components(const Field& field);

/// The row in other axes A: A v, or A T A^T.
void turn(Field& field, std::size_t row, const Turned& what, const Eigen::Matrix3d& axes);

}  // namespace lacon
