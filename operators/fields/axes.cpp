#include "lacon/operators/fields/axes.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/tensor.hpp"

namespace lacon {
namespace {

using Vector = Eigen::Vector3d;
using Axes = Eigen::Matrix3d;  // unit vectors as rows

constexpr double on_axis = 1e-10;  // of the distance from the origin of the mesh's farthest node

/// Numbers of a keyword as a vector of space, at least `least` of them; those that are not given are 0.
Vector vector(const Keywords& keywords, const char* keyword, int least) {
  const std::vector<double> given = keywords.reals(keyword);
  if (given.size() < static_cast<std::size_t>(least))
    fail("MODIREPERE_5", {{"keyword", keywords.path(keyword)}, {"expected", fmt::format("{} numbers", least)}});
  Vector made = Vector::Zero();
  for (std::size_t k = 0; k < given.size() && k < 3; ++k) made[static_cast<Eigen::Index>(k)] = given[k];
  return made;
}

Vector unit(const Keywords& keywords, const char* keyword, const Vector& given) {
  if (!(given.norm() > 0))
    fail("MODIREPERE_5", {{"keyword", keywords.path(keyword)}, {"expected", "a direction that is not zero"}});
  return given.normalized();
}

/// Axes turned by alpha about Z, then beta about the new Y, then gamma about the new X; degrees.
Axes nautical(const Vector& degrees) {
  const Vector a = degrees * std::numbers::pi / 180;
  return (Eigen::AngleAxisd(a[0], Vector::UnitZ()) * Eigen::AngleAxisd(a[1], Vector::UnitY()) *
          Eigen::AngleAxisd(a[2], Vector::UnitX()))
      .toRotationMatrix()
      .transpose();
}

}  // namespace

Frame::Frame(const Mesh& mesh, const Keywords& keywords, bool cylindrical) : plane_(mesh.dimension == 2) {
  if (cylindrical) {
    origin_ = vector(keywords, "ORIGINE", mesh.dimension);
    line_ = plane_ ? Vector(Vector::UnitZ()) : unit(keywords, "AXE_Z", vector(keywords, "AXE_Z", 3));
    double farthest = 0;
    for (std::size_t n = 0; n < mesh.n_nodes(); ++n)
      farthest = std::max(farthest, (Eigen::Map<const Vector>(mesh.coordinates.data() + 3 * n) - *origin_).norm());
    least_ = on_axis * farthest;
  } else if (keywords.has("ANGL_NAUT")) {
    axes_ = nautical(vector(keywords, "ANGL_NAUT", 1));
  } else {
    const Vector x = unit(keywords, "VECT_X", vector(keywords, "VECT_X", mesh.dimension)),
                 y = vector(keywords, "VECT_Y", mesh.dimension);
    axes_.row(0) = x;
    axes_.row(1) = unit(keywords, "VECT_Y", y - y.dot(x) * x);
    axes_.row(2) = x.cross(Vector(axes_.row(1)));
  }
  if (plane_ && std::abs(axes_(2, 2) - 1) > 1e-12)
    fail("MODIREPERE_5", {{"keyword", keywords.path(keywords.has("ANGL_NAUT") ? "ANGL_NAUT" : "VECT_Y")},
                          {"expected", "axes that leave the plane where it is: one angle, or VECT_Y at the left of VECT_X"}});
}

Vector Frame::radius(const Vector& place) const {
  const Vector from_origin = place - *origin_;
  return from_origin - from_origin.dot(line_) * line_;
}

Axes Frame::at(const Vector& place, std::size_t& lost) const {
  if (!origin_) return axes_;
  Vector radial = radius(place);
  if (!(radial.norm() > least_)) {
    ++lost;
    Eigen::Index across = 0;
    line_.cwiseAbs().minCoeff(&across);
    radial = Vector::Unit(across) - line_[across] * line_;
  }
  radial.normalize();
  Axes axes;
  axes.row(0) = radial;
  axes.row(plane_ ? 1 : 2) = line_.cross(radial);
  axes.row(plane_ ? 2 : 1) = line_;
  return axes;
}

std::vector<Turned> turned_components(const Field& field) {
  std::vector<Turned> found;
  for (const std::string prefix : {"D", "F", "V", "SI", "EP"}) {
    Turned one{{-1, -1, -1, -1, -1, -1}, prefix.size() == 2};
    for (std::size_t k = 0; k < (one.tensor ? 6 : 3); ++k)
      one.column[k] = field.component(prefix + (one.tensor ? std::string(tensor_axes[k].name) : std::string(1, "XYZ"[k])));
    if (std::ranges::any_of(one.column, [](int c) { return c >= 0; })) found.push_back(one);
  }
  return found;
}

void turn(Field& field, std::size_t row, const Turned& what, const Axes& axes) {
  const auto entry = [&](int k) -> double& {
    return field.at(row, static_cast<std::size_t>(what.column[static_cast<std::size_t>(k)]));
  };
  const auto there = [&](int k) { return what.column[static_cast<std::size_t>(k)] >= 0; };
  if (!what.tensor) {
    Vector value = Vector::Zero();
    for (int k = 0; k < 3; ++k)
      if (there(k)) value[k] = entry(k);
    value = axes * value;
    for (int k = 0; k < 3; ++k)
      if (there(k)) entry(k) = value[k];
    return;
  }
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 6; ++k) {
    const TensorAxes& at = tensor_axes[static_cast<std::size_t>(k)];
    if (there(k)) tensor(at.i, at.j) = tensor(at.j, at.i) = entry(k);
  }
  tensor = axes * tensor * axes.transpose();
  for (int k = 0; k < 6; ++k)
    if (there(k)) entry(k) = tensor(tensor_axes[static_cast<std::size_t>(k)].i, tensor_axes[static_cast<std::size_t>(k)].j);
}

}  // namespace lacon
