#include "lacon/operators/modi_repere/modi_repere.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/axes.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/moved_places.hpp"
#include "lacon/operators/fields/selection.hpp"

namespace lacon {
namespace {

/// The components that an occurrence of MODI_CHAM means. @param dimension of the mesh
Turned turned(const Field& field, const Keywords& keywords, int dimension) {
  if (!keywords.text("TYPE_CHAM").ends_with(fmt::format("{}D", dimension)))
    fail("MODIREPERE_5", {{"keyword", keywords.path("TYPE_CHAM")},
                          {"expected", fmt::format("VECT_{0}D or TENS_{0}D, as the mesh has {0} dimensions", dimension)}});
  const bool tensor = keywords.text("TYPE_CHAM").starts_with("TENS");
  const auto wanted = static_cast<std::size_t>(!tensor ? dimension : dimension == 2 ? 4 : 6);
  const std::vector<std::string> names = keywords.texts("NOM_CMP");
  if (names.empty())
    for (const Turned& one : turned_components(field))
      if (one.tensor == tensor &&
          static_cast<std::size_t>(std::ranges::count_if(one.column, [](int c) { return c >= 0; })) == wanted)
        return one;
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

class Repere {
 public:
  Repere(const Order& order, const Base& base, const Result& result)
      : mesh_(base.mesh(result.mesh)),
        model_(model_of(base, result)),
        registry_(order.plugins),
        points_(mesh_, model_, registry_),
        affe_(order.keywords.factors("AFFE")),
        moved_(base, result, mesh_) {
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
    if (moving) look_at_moved(field, frame);
    if (moving && field.location == Location::cells) fail("MODIREPERE_2", {{"field", field.name}});
    if (moving && field.location == Location::gauss_points && !coordinates_) coordinates_ = coordinates_of_points();
    std::vector<std::int64_t> place;
    if (moving && field.location == Location::gauss_points) place = places(*coordinates_, mesh_.n_cells());
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      const auto owner = static_cast<std::size_t>(field.support[i]);
      if (frame[owner] < 0) continue;
      for (std::size_t row = field.first_row(i); row < field.first_row(i + 1); ++row) {
        if (!has_all(field, row, what)) continue;
        Eigen::Vector3d at = Eigen::Vector3d::Zero();
        const std::size_t k = row - field.first_row(i);
        if (!place.empty()) {
          const std::size_t from = coordinates_->first_row(static_cast<std::size_t>(place[owner])) + k;
          for (std::size_t d = 0; d < coordinates_->n_components(); ++d)
            at[static_cast<Eigen::Index>(d)] = coordinates_->at(from, d);
        } else if (field.location != Location::cells) {
          const auto node = field.location == Location::nodes ? owner : static_cast<std::size_t>(mesh_.cells[owner][k]);
          at = Eigen::Map<const Eigen::Vector3d>(mesh_.coordinates.data() + 3 * node);
        }
        turn(field, row, what, frames_[static_cast<std::size_t>(frame[owner])].at(at, lost_));
      }
    }
    return field;
  }

  std::size_t lost() const { return lost_; }
  const MovedPlaces& moved() const { return moved_; }

 private:
  /// The nodes of what is turned, now and in the mesh. @param frame of each node or cell, -1 for none
  void look_at_moved(const Field& field, const std::vector<int>& frame) {
    const std::vector<double>& now = moved_.at(field.order);
    for (std::size_t f = 0; f < frames_.size() && !now.empty(); ++f) {
      std::vector<char> wanted(mesh_.n_nodes(), 0);
      for (const std::int32_t owner : field.support) {
        const auto i = static_cast<std::size_t>(owner);
        if (frame[i] != static_cast<int>(f)) continue;
        if (field.location == Location::nodes)
          wanted[i] = 1;
        else
          for (const std::int32_t node : mesh_.cells[i]) wanted[static_cast<std::size_t>(node)] = 1;
      }
      MovedPlaces::Places before, after;
      for (std::size_t n = 0; n < wanted.size(); ++n)
        if (wanted[n]) {
          before.push_back({mesh_.coordinates[3 * n], mesh_.coordinates[3 * n + 1], mesh_.coordinates[3 * n + 2]});
          after.push_back({now[3 * n], now[3 * n + 1], now[3 * n + 2]});
        }
      moved_.look_at_axes(affe_[f].path("ORIGINE"), field.instant, frames_[f], before, after);
    }
  }

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
  MovedPlaces moved_;
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
  repere.moved().tell();
  base.store(to);
}

}  // namespace lacon
