#include "lacon/operators/modi_repere/modi_repere.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/selection.hpp"
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
    fail("ORDER_4", {{"keyword", keywords.path(keyword)}, {"expected", fmt::format("{} numbers", least)}});
  Vector made = Vector::Zero();
  for (std::size_t k = 0; k < given.size() && k < 3; ++k) made[static_cast<Eigen::Index>(k)] = given[k];
  return made;
}

Vector unit(const Keywords& keywords, const char* keyword, const Vector& given) {
  if (!(given.norm() > 0)) fail("ORDER_4", {{"keyword", keywords.path(keyword)}, {"expected", "a direction that is not zero"}});
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

/// The axes of one AFFE, at any place.
class Frame {
 public:
  Frame(const Mesh& mesh, const Keywords& keywords, bool cylindrical) : plane_(mesh.dimension == 2) {
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
      fail("ORDER_4", {{"keyword", keywords.path(keywords.has("ANGL_NAUT") ? "ANGL_NAUT" : "VECT_Y")},
                       {"expected", "axes that leave the plane where it is: one angle, or VECT_Y at the left of VECT_X"}});
  }

  bool depends_on_place() const { return origin_.has_value(); }
  /// @param lost counts places on the line itself, where any direction across it is taken for radial
  Axes at(const Vector& place, std::size_t& lost) const {
    if (!origin_) return axes_;
    Vector radial = place - *origin_;
    radial -= radial.dot(line_) * line_;
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

 private:
  bool plane_;
  Axes axes_ = Axes::Identity();
  std::optional<Vector> origin_;
  Vector line_ = Vector::UnitZ();
  double least_ = 0;
};

/// One MODI_CHAM: a field, and which of its components are those of a vector or a tensor, -1 where it has none.
struct Turned {
  std::array<int, 6> column;
  bool tensor;
};

Turned turned(const Field& field, const Keywords& keywords, int dimension) {
  if (!keywords.text("TYPE_CHAM").ends_with(fmt::format("{}D", dimension)))
    fail("ORDER_4", {{"keyword", keywords.path("TYPE_CHAM")},
                     {"expected", fmt::format("VECT_{0}D or TENS_{0}D, as the mesh has {0} dimensions", dimension)}});
  const bool tensor = keywords.text("TYPE_CHAM").starts_with("TENS");
  const std::size_t wanted = tensor                                       ? (keywords.text("TYPE_CHAM").ends_with("2D") ? 4 : 6)
                             : keywords.text("TYPE_CHAM").ends_with("2D") ? 2
                                                                          : 3;
  std::vector<std::string> names = keywords.texts("NOM_CMP");
  if (names.empty()) {
    for (const std::string prefix : {"D", "F", "V", "SI", "EP"}) {
      const bool fits = (prefix.size() == 2) == tensor && field.component(prefix + (tensor ? "XX" : "X")) >= 0;
      for (std::size_t k = 0; fits && k < wanted; ++k)
        names.push_back(prefix + (tensor ? std::string(tensor_axes[k].name) : std::string(1, "XYZ"[k])));
    }
  }
  if (names.size() != wanted)
    fail("MODIREPERE_1", {{"keyword", keywords.path("NOM_CMP")},
                          {"type", keywords.text("TYPE_CHAM")},
                          {"wanted", std::to_string(wanted)},
                          {"known", fmt::format("{}", fmt::join(field.components, ", "))}});
  Turned made{{-1, -1, -1, -1, -1, -1}, tensor};
  for (std::size_t k = 0; k < wanted; ++k) {
    made.column[k] = field.component(names[k]);
    if (made.column[k] < 0)
      fail("CREACHAMP_14", {{"keyword", keywords.path("NOM_CMP")},
                            {"component", names[k]},
                            {"field", field.name},
                            {"known", fmt::format("{}", fmt::join(field.components, ", "))}});
  }
  return made;
}

/// The row in other axes: A v, or A T A^T.
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

class Repere {
 public:
  Repere(const Order& order, const Base& base, const Result& result)
      : mesh_(base.mesh(result.mesh)),
        model_(base.model(result.model)),
        registry_(order.plugins),
        points_(mesh_, model_, registry_),
        affe_(order.keywords.factors("AFFE")) {
    for (const Keywords& one : affe_) frames_.emplace_back(mesh_, one, order.keywords.text("REPERE") == "CYLINDRIQUE");
  }

  /// The field in the axes of each place.
  Field operator()(Field field, const Keywords& modi_cham) {
    const Turned what = turned(field, modi_cham, mesh_.dimension);
    std::vector<int> frame(field.location == Location::nodes ? mesh_.n_nodes() : mesh_.n_cells(), -1);
    for (std::size_t f = 0; f < affe_.size(); ++f) {
      const std::vector<char> wanted = selected_places(mesh_, affe_[f], field.location, field.name);
      for (std::size_t i = 0; i < frame.size(); ++i)
        if (wanted[i]) frame[i] = static_cast<int>(f);
    }
    const bool moving = std::ranges::any_of(frames_, &Frame::depends_on_place);
    if (moving && field.location == Location::cells) fail("MODIREPERE_2", {{"field", field.name}});
    if (moving && field.location == Location::gauss_points && !coordinates_) coordinates_ = coordinates_of_points();
    std::vector<std::int64_t> place;
    if (moving && field.location == Location::gauss_points) place = places(*coordinates_, mesh_.n_cells());
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      const auto owner = static_cast<std::size_t>(field.support[i]);
      if (frame[owner] < 0) continue;
      for (std::size_t row = field.first_row(i); row < field.first_row(i + 1); ++row) {
        if (!has_all(field, row, what)) continue;
        Vector at = Vector::Zero();
        const std::size_t k = row - field.first_row(i);
        if (!place.empty()) {
          const std::size_t from = coordinates_->first_row(static_cast<std::size_t>(place[owner])) + k;
          for (std::size_t d = 0; d < coordinates_->n_components(); ++d)
            at[static_cast<Eigen::Index>(d)] = coordinates_->at(from, d);
        } else if (field.location != Location::cells) {
          const auto node = field.location == Location::nodes ? owner : static_cast<std::size_t>(mesh_.cells[owner][k]);
          at = Eigen::Map<const Vector>(mesh_.coordinates.data() + 3 * node);
        }
        turn(field, row, what, frames_[static_cast<std::size_t>(frame[owner])].at(at, lost_));
      }
    }
    return field;
  }

  std::size_t lost() const { return lost_; }

 private:
  /// True where a row has all components, false where it has none. Throws MODIREPERE_3 where one is missing.
  bool has_all(const Field& field, std::size_t row, const Turned& what) const {
    std::size_t wanted = 0, found = 0;
    for (const int column : what.column)
      if (column >= 0) {
        ++wanted;
        found += field.has(row, static_cast<std::size_t>(column));
      }
    if (found != 0 && found != wanted) fail("MODIREPERE_3", {{"field", field.name}, {"order", std::to_string(field.order)}});
    return found != 0;
  }

  Field coordinates_of_points() {
    const Ground ground(mesh_, points_);
    Field nodes{.quantity = "GEOM_R", .location = Location::nodes, .components = {"X", "Y", "Z"}};
    nodes.values = mesh_.coordinates;
    for (std::size_t n = 0; n < mesh_.n_nodes(); ++n) nodes.support.push_back(static_cast<std::int32_t>(n));
    return moved_to(ground, nodes, {"ELGA_GEOM_R", Location::gauss_points, "GEOM_R"}, false);
  }

  Mesh mesh_;
  Model model_;
  Registry registry_;
  ModelPoints points_;
  std::vector<Keywords> affe_;
  std::vector<Frame> frames_;
  std::optional<Field> coordinates_;
  std::size_t lost_ = 0;
};

}  // namespace

void modi_repere(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Result from = base.result(keywords.concept_id("RESULTAT"));
  const std::vector<std::int64_t> orders = selected_orders(base, from, keywords);
  Repere repere(order, base, from);
  Result to = part_of(from, orders);
  for (const Keywords& one : keywords.factors("MODI_CHAM")) {
    const std::string name = one.text("NOM_CHAM");
    const auto files = from.fields.find(name);
    for (const std::int64_t o : orders)
      // without a choice of instants, those that do not have the field are left alone
      if (names_instants(keywords) || files == from.fields.end() || files->second.contains(o))
        base.add_field(to, repere(base.field(from, name, o), one));
  }
  if (repere.lost()) inform("MODIREPERE_4", {{"count", std::to_string(repere.lost())}});
  base.store(to);
}

}  // namespace lacon
