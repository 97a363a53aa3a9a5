#include "lacon/operators/calc_champ/calc_champ.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/static_problem.hpp"
#include "lacon/operators/fields/criteria.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/mechanics.hpp"
#include "lacon/operators/fields/selection.hpp"

namespace lacon {
namespace {

/// How a field comes from the one it is computed from.
enum class How {
  archived,
  same,
  strain,
  strain_green,
  stress_invariants,
  strain_invariants,
  to_cell_nodes,
  to_nodes,
  forces,
  reactions
};

struct FieldRow {
  std::string_view name, from;
  How how;
};

/// One row a field: what it is computed from, and how. Those that are archived come from the result itself.
constexpr std::array rows{
    FieldRow{"DEPL", "", How::archived},
    FieldRow{"SIEF_ELGA", "", How::archived},
    FieldRow{"SIEF_ELNO", "SIEF_ELGA", How::to_cell_nodes},
    FieldRow{"SIEF_NOEU", "SIEF_ELNO", How::to_nodes},
    FieldRow{"SIGM_ELGA", "SIEF_ELGA", How::same},
    FieldRow{"SIGM_ELNO", "SIGM_ELGA", How::to_cell_nodes},
    FieldRow{"SIGM_NOEU", "SIGM_ELNO", How::to_nodes},
    FieldRow{"EPSI_ELGA", "DEPL", How::strain},
    FieldRow{"EPSI_ELNO", "EPSI_ELGA", How::to_cell_nodes},
    FieldRow{"EPSI_NOEU", "EPSI_ELNO", How::to_nodes},
    FieldRow{"EPSG_ELGA", "DEPL", How::strain_green},
    FieldRow{"EPSG_ELNO", "EPSG_ELGA", How::to_cell_nodes},
    FieldRow{"EPSG_NOEU", "EPSG_ELNO", How::to_nodes},
    FieldRow{"SIEQ_ELGA", "SIEF_ELGA", How::stress_invariants},
    FieldRow{"SIEQ_ELNO", "SIGM_ELNO", How::stress_invariants},
    FieldRow{"SIEQ_NOEU", "SIEQ_ELNO", How::to_nodes},
    FieldRow{"EPEQ_ELGA", "EPSI_ELGA", How::strain_invariants},
    FieldRow{"EPEQ_ELNO", "EPSI_ELNO", How::strain_invariants},
    FieldRow{"EPEQ_NOEU", "EPEQ_ELNO", How::to_nodes},
    FieldRow{"EPGQ_ELGA", "EPSG_ELGA", How::strain_invariants},
    FieldRow{"EPGQ_ELNO", "EPSG_ELNO", How::strain_invariants},
    FieldRow{"EPGQ_NOEU", "EPGQ_ELNO", How::to_nodes},
    FieldRow{"VARI_ELGA", "", How::archived},
    FieldRow{"VARI_ELNO", "VARI_ELGA", How::to_cell_nodes},
    FieldRow{"VARI_NOEU", "VARI_ELNO", How::to_nodes},
    FieldRow{"FORC_NODA", "SIEF_ELGA", How::forces},
    FieldRow{"REAC_NODA", "FORC_NODA", How::reactions},
};

const FieldRow& row_of(std::string_view name) {
  return *std::find_if(rows.begin(), rows.end(), [&](const FieldRow& row) { return row.name == name; });
}

/// The fields of the result that a field is computed from in the end.
std::vector<std::string> roots_of(std::string_view name) {
  std::vector<std::string> roots;
  const FieldRow* row = &row_of(name);
  if (name == "REAC_NODA" || name == "FORC_NODA") roots.emplace_back("DEPL");
  while (!row->from.empty()) row = &row_of(row->from);
  roots.emplace_back(row->name);
  return roots;
}

bool has_field(const Result& result, const std::string& name, std::int64_t order) {
  const auto named = result.fields.find(name);
  return named != result.fields.end() && named->second.contains(order);
}

/// The cells whose stresses live on the current geometry: those of a DEFORMATION other than PETIT.
std::vector<char> cells_in_motion(const Mesh& mesh, const Result& result) {
  std::vector<char> moved(mesh.n_cells(), 0);
  const auto behaviours = nlohmann::json::parse(result.behaviour);
  if (!behaviours.is_array()) return moved;
  for (const auto& one : behaviours) {
    const char current = one.value("DEFORMATION", "PETIT") != "PETIT";
    for (std::size_t c = 0; c < moved.size() && !one.contains("GROUP_MA"); ++c) moved[c] = current;
    if (!one.contains("GROUP_MA")) continue;
    for (const auto& group : one.at("GROUP_MA"))
      for (const std::int32_t cell : cells_of_group(mesh, group.get<std::string>(), "COMPORTEMENT/GROUP_MA"))
        moved[static_cast<std::size_t>(cell)] = current;
  }
  return moved;
}

/// What the fields of all instants share.
class Setting {
 public:
  Setting(const Order& order, const Base& base, const Result& result)
      : order_(order),
        base_(base),
        result_(result),
        mesh_(base.mesh(result.mesh)),
        wanted_(selected_cells(mesh_, order.keywords)) {}

  const Base& base() const { return base_; }
  const Result& result() const { return result_; }
  const Mesh& mesh() const { return mesh_; }
  const std::vector<char>& wanted() const { return wanted_; }
  bool has_part() const { return order_.keywords.has("GROUP_MA"); }
  std::string groups() const { return fmt::format("{}", fmt::join(order_.keywords.texts("GROUP_MA"), ", ")); }
  const std::vector<char>& moved() {
    if (!moved_) moved_ = cells_in_motion(mesh_, result_);
    return *moved_;
  }
  ModelPoints& points() {
    if (!points_) {
      model_ = base_.model(result_.model);
      registry_ = std::make_unique<Registry>(order_.plugins);
      points_.emplace(mesh_, model_, *registry_);
    }
    return *points_;
  }
  double poisson(std::int32_t cell) {
    if (!materials_) {
      material_field_ = base_.material_field(result_.material_field);
      std::vector<Material> materials;
      std::vector<std::string> labels;
      for (const std::string& id : material_field_.materials) {
        materials.push_back(base_.material(id));
        labels.push_back(base_.label(id));
      }
      materials_.emplace(material_field_, std::move(materials), std::move(labels));
    }
    return materials_->parameter(cell, "ELAS/NU", points().element(static_cast<std::size_t>(cell))->name);
  }
  /// @param displacement (n_nodes, dimension), which following pressures act on
  std::vector<double> external_force(double instant, std::span<const double> displacement) {
    if (!loads_) loads_ = read_loads(order_, base_, result_);
    return loads_->external_force(instant, displacement);
  }

 private:
  const Order& order_;
  const Base& base_;
  const Result& result_;
  Mesh mesh_;
  std::vector<char> wanted_;
  std::optional<std::vector<char>> moved_;
  Model model_;
  std::unique_ptr<Registry> registry_;
  std::optional<ModelPoints> points_;
  MaterialField material_field_;
  std::optional<MaterialTable> materials_;
  std::optional<StaticProblem> loads_;
};

/// The fields of one instant, each computed once, on the cells that are meant.
class Instant {
 public:
  Instant(Setting& setting, std::int64_t order) : setting_(setting), order_(order) {}

  const Field& operator()(std::string_view name) {
    const auto found = fields_.find(name);
    if (found != fields_.end()) return found->second;
    return fields_.emplace(name, make(row_of(name))).first->second;
  }

 private:
  Field make(const FieldRow& row) {
    const Mesh& mesh = setting_.mesh();
    std::string name(row.name);
    switch (row.how) {
      case How::archived: {
        Field field = setting_.base().field(setting_.result(), name, order_);
        return field.location == Location::nodes ? field : on_wanted_cells(std::move(field));
      }
      case How::same: {
        Field field = (*this)(row.from);
        field.name = name;
        return field;
      }
      case How::strain:
      case How::strain_green: {
        Field field = strains(mesh, setting_.points(), (*this)(row.from), setting_.wanted(),
                              row.how == How::strain ? Strain::small : Strain::green_lagrange, name,
                              [&](std::int32_t cell) { return setting_.poisson(cell); });
        return on_wanted_cells(std::move(field));
      }
      case How::stress_invariants:
        return equivalent_stress((*this)(row.from), name);
      case How::strain_invariants:
        return equivalent_strain((*this)(row.from), name);
      case How::to_cell_nodes:
        return gauss_points_to_cell_nodes(mesh, (*this)(row.from), name);
      case How::to_nodes:
        return cell_nodes_to_nodes(mesh, (*this)(row.from), name);
      case How::forces:
        return forces((*this)(row.from), name);
      case How::reactions:
        return reactions(name);
    }
    throw std::logic_error("a field without rule");
  }

  Field on_wanted_cells(Field&& field) const {
    if (setting_.has_part()) field = restrict_to_cells(field, setting_.wanted());
    if (field.support.empty())
      fail("CALCCHAMP_2", {{"groups", setting_.groups()}, {"label", setting_.result().label}, {"field", field.name}});
    return std::move(field);
  }

  Field forces(const Field& stress, std::string name) {
    return nodal_forces(setting_.mesh(), setting_.points(), stress, setting_.moved(),
                        displaced(setting_.mesh(), (*this)("DEPL")), std::move(name));
  }

  /// What holds the nodes: forces of all stresses less the loads. With GROUP_MA on the nodes of these cells.
  Field reactions(std::string name) {
    const Mesh& mesh = setting_.mesh();
    Field field = forces(setting_.base().field(setting_.result(), "SIEF_ELGA", order_), std::move(name));
    const std::size_t width = field.n_components();
    const std::vector<double> current = displaced(mesh, (*this)("DEPL"));  // coordinates
    std::vector<double> displacement;
    for (std::size_t node = 0; node < mesh.n_nodes(); ++node)
      for (std::size_t d = 0; d < width; ++d) displacement.push_back(current[3 * node + d] - mesh.coordinates[3 * node + d]);
    const std::vector<double> external = setting_.external_force(field.instant, displacement);
    for (std::size_t i = 0; i < field.support.size(); ++i)
      for (std::size_t d = 0; d < width; ++d)
        field.at(i, d) -= external[static_cast<std::size_t>(field.support[i]) * width + d];
    return setting_.has_part() ? restrict_to_nodes(field, nodes_of_marked_cells(mesh, setting_.wanted())) : field;
  }

  Setting& setting_;
  std::int64_t order_;
  std::map<std::string, Field, std::less<>> fields_;
};

}  // namespace

void calc_champ(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Result from = base.result(keywords.concept_id("RESULTAT"));
  std::vector<std::string> asked;
  for (const char* family : {"CONTRAINTE", "DEFORMATION", "CRITERES", "VARI_INTERNE", "FORCE"})
    for (const std::string& name : keywords.texts(family)) asked.push_back(name);
  Setting setting(order, base, from);

  // without a choice of instants, those that a field cannot be computed at are left alone as long as others have it
  const std::vector<std::int64_t> orders = selected_orders(base, from, keywords);
  std::vector<std::pair<std::int64_t, std::string>> fields;
  for (const std::int64_t o : orders)
    for (const std::string& name : asked) {
      const std::vector<std::string> roots = roots_of(name);
      const auto missing =
          std::find_if(roots.begin(), roots.end(), [&](const auto& root) { return !has_field(from, root, o); });
      if (missing == roots.end())
        fields.emplace_back(o, name);
      else if (names_instants(keywords) || !from.fields.contains(*missing))
        fail("CALCCHAMP_1", {{"label", from.label}, {"order", std::to_string(o)}, {"source", *missing}, {"field", name}});
    }

  Result to = order.reuse ? from : part_of(from, orders);
  std::optional<std::pair<std::int64_t, Instant>> instant;
  for (const auto& [o, name] : fields) {
    if (!instant || instant->first != o) instant.emplace(o, Instant(setting, o));
    // what is archived is in a result that is enriched already, on all cells
    if (!order.reuse || row_of(name).how != How::archived) base.add_field(to, instant->second(name));
  }
  base.store(to);
}

}  // namespace lacon
