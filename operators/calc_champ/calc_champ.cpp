#include "lacon/operators/calc_champ/calc_champ.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/evolution/problem/behaviours.hpp"
#include "lacon/operators/evolution/problem/static_problem.hpp"
#include "lacon/operators/fields/criteria.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/internal_variables.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/mechanics.hpp"
#include "lacon/operators/fields/plastic_strain.hpp"
#include "lacon/operators/fields/result_materials.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/fields/tensor.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

/// How a field comes from the one it is computed from.
enum class How {
  archived,
  same,
  strain,
  strain_green,
  strain_logarithmic,
  plastic,
  stress_invariants,
  strain_invariants,
  to_cell_nodes,
  to_nodes,
  forces,
  reactions,
  mechanical_strain,
  stress_energy,
  path_energy,
  integral
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
    FieldRow{"EPME_ELGA", "EPSI_ELGA", How::mechanical_strain},
    FieldRow{"EPME_ELNO", "EPME_ELGA", How::to_cell_nodes},
    FieldRow{"EPME_NOEU", "EPME_ELNO", How::to_nodes},
    FieldRow{"EPSG_ELGA", "DEPL", How::strain_green},
    FieldRow{"EPSG_ELNO", "EPSG_ELGA", How::to_cell_nodes},
    FieldRow{"EPSG_NOEU", "EPSG_ELNO", How::to_nodes},
    FieldRow{"EPMG_ELGA", "EPSG_ELGA", How::mechanical_strain},
    FieldRow{"EPMG_ELNO", "EPMG_ELGA", How::to_cell_nodes},
    FieldRow{"EPMG_NOEU", "EPMG_ELNO", How::to_nodes},
    FieldRow{"EPSL_ELGA", "DEPL", How::strain_logarithmic},
    FieldRow{"EPSL_ELNO", "EPSL_ELGA", How::to_cell_nodes},
    FieldRow{"EPSL_NOEU", "EPSL_ELNO", How::to_nodes},
    FieldRow{"EPSP_ELGA", "SIEF_ELGA", How::plastic},
    FieldRow{"EPSP_ELNO", "EPSP_ELGA", How::to_cell_nodes},
    FieldRow{"EPSP_NOEU", "EPSP_ELNO", How::to_nodes},
    FieldRow{"SIEQ_ELGA", "SIEF_ELGA", How::stress_invariants},
    FieldRow{"SIEQ_ELNO", "SIGM_ELNO", How::stress_invariants},
    FieldRow{"SIEQ_NOEU", "SIEQ_ELNO", How::to_nodes},
    FieldRow{"EPEQ_ELGA", "EPSI_ELGA", How::strain_invariants},
    FieldRow{"EPEQ_ELNO", "EPSI_ELNO", How::strain_invariants},
    FieldRow{"EPEQ_NOEU", "EPEQ_ELNO", How::to_nodes},
    FieldRow{"EPMQ_ELGA", "EPME_ELGA", How::strain_invariants},
    FieldRow{"EPMQ_ELNO", "EPME_ELNO", How::strain_invariants},
    FieldRow{"EPMQ_NOEU", "EPMQ_ELNO", How::to_nodes},
    FieldRow{"EPGQ_ELGA", "EPSG_ELGA", How::strain_invariants},
    FieldRow{"EPGQ_ELNO", "EPSG_ELNO", How::strain_invariants},
    FieldRow{"EPGQ_NOEU", "EPGQ_ELNO", How::to_nodes},
    FieldRow{"VARI_ELGA", "", How::archived},
    FieldRow{"VARI_ELNO", "VARI_ELGA", How::to_cell_nodes},
    FieldRow{"VARI_NOEU", "VARI_ELNO", How::to_nodes},
    FieldRow{"FORC_NODA", "SIEF_ELGA", How::forces},
    FieldRow{"REAC_NODA", "FORC_NODA", How::reactions},
    FieldRow{"ENEL_ELGA", "SIEF_ELGA", How::stress_energy},
    FieldRow{"ENEL_ELNO", "ENEL_ELGA", How::to_cell_nodes},
    FieldRow{"ENEL_NOEU", "ENEL_ELNO", How::to_nodes},
    FieldRow{"ENEL_ELEM", "ENEL_ELGA", How::integral},
    FieldRow{"ETOT_ELGA", "SIEF_ELGA", How::path_energy},
    FieldRow{"ETOT_ELNO", "ETOT_ELGA", How::to_cell_nodes},
    FieldRow{"ETOT_NOEU", "ETOT_ELNO", How::to_nodes},
    FieldRow{"ETOT_ELEM", "ETOT_ELGA", How::integral},
};

const FieldRow& row_of(std::string_view name) {
  return *std::find_if(rows.begin(), rows.end(), [&](const FieldRow& row) { return row.name == name; });
}

/// The fields of the result that a field is computed from in the end. @param zero no law has internal variables: V1 = 0
std::vector<std::string> roots_of(std::string_view name, bool zero) {
  std::vector<std::string> roots;
  const FieldRow* row = &row_of(name);
  if (name == "REAC_NODA" || name == "FORC_NODA" || name.starts_with("ETOT") || name.starts_with("EPSP"))
    roots.emplace_back("DEPL");
  while (!row->from.empty()) row = &row_of(row->from);
  roots.emplace_back(zero && row->name == "VARI_ELGA" ? "SIEF_ELGA" : row->name);
  return roots;
}

bool has_field(const Result& result, const std::string& name, std::int64_t order) {
  const auto named = result.fields.find(name);
  return named != result.fields.end() && named->second.contains(order);
}

/// One entry a cell: what its COMPORTEMENT means for fields computed from its stresses and displacements.
struct CellBehaviours {
  std::vector<char> moved;  ///< stresses live on the displaced geometry
  std::vector<char> green;  ///< Green-Lagrange strains
  std::vector<const catalog::RelationRow*> relation;
  std::vector<const catalog::DeformationRow*> deformation;
};

CellBehaviours behaviours_of(const Mesh& mesh, const ResultStage& stage, const Registry& registry) {
  std::vector<Keywords> occurrences;
  for (const auto& occurrence : nlohmann::json::parse(stage.behaviour)) occurrences.emplace_back(occurrence, "COMPORTEMENT/");
  const Behaviours behaviours = read_behaviours(mesh, occurrences);
  std::vector<BehaviourRows> known;
  for (const std::string& option : behaviours.options) known.push_back(behaviour_rows(registry, option));
  CellBehaviours found;
  for (const std::int32_t behaviour : behaviours.of_cell) {
    const auto& [relation, deformation] = known[static_cast<std::size_t>(behaviour)];
    found.moved.push_back(deformation.stress_geometry == catalog::StressGeometry::displaced);
    found.green.push_back(deformation.strain == catalog::StrainMeasure::green_lagrange);
    found.relation.push_back(&relation);
    found.deformation.push_back(&deformation);
  }
  return found;
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
  /// Whether the result has no internal variables because its laws have none.
  bool has_zero_variables() {
    if (!zero_variables_) {
      Registry laws(order_.plugins);
      zero_variables_ = !result_.fields.contains("VARI_ELGA") && !laws_have_variables(base_, result_, laws);
    }
    return *zero_variables_;
  }
  bool has_part() const { return order_.keywords.has("GROUP_MA"); }
  std::string groups() const { return fmt::format("{}", fmt::join(order_.keywords.texts("GROUP_MA"), ", ")); }
  const CellBehaviours& behaviours(std::int64_t order) {
    const ResultStage& stage = result_.stage(order);
    const auto known = behaviours_.find(stage.first);
    if (known != behaviours_.end()) return known->second;
    return behaviours_.emplace(stage.first, behaviours_of(mesh_, stage, registry())).first->second;
  }
  ModelPoints& points() {
    if (!points_) {
      model_ = model_of(base_, result_);
      points_.emplace(mesh_, model_, registry());
    }
    return *points_;
  }
  ResultMaterials& materials() {
    if (!materials_) materials_.emplace(base_, result_, mesh_, points());
    return *materials_;
  }
  /// The energy of the path up to the latest order that it was computed for.
  std::optional<std::pair<std::int64_t, Field>>& path_energy() { return path_energy_; }
  /// @param displacement (n_nodes, dimension), which following pressures act on @return (n_nodes, n_components)
  std::vector<double> external_force(std::int64_t order, double instant, std::span<const double> displacement) {
    const ResultStage& stage = result_.stage(order);
    if (!loads_ || loads_->first != stage.first) loads_.emplace(stage.first, read_loads(order_, base_, result_, stage));
    return loads_->second.external_force(instant, displacement);
  }

 private:
  const Registry& registry() {
    if (!registry_) registry_ = std::make_unique<Registry>(order_.plugins);
    return *registry_;
  }

  const Order& order_;
  const Base& base_;
  const Result& result_;
  Mesh mesh_;
  std::vector<char> wanted_;
  std::map<std::int64_t, CellBehaviours> behaviours_;  ///< by the first order of their stage
  Model model_;
  std::unique_ptr<Registry> registry_;
  std::optional<bool> zero_variables_;
  std::optional<ModelPoints> points_;
  std::optional<ResultMaterials> materials_;
  std::optional<std::pair<std::int64_t, Field>> path_energy_;
  std::optional<std::pair<std::int64_t, StaticProblem>> loads_;  ///< of a stage, by its first order
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
        const bool zero = name == "VARI_ELGA" && setting_.has_zero_variables();
        Field field = setting_.base().field(setting_.result(), zero ? "SIEF_ELGA" : name, order_);
        if (zero) field = zero_variables(std::move(field));
        return field.location == Location::nodes ? field : on_wanted_cells(std::move(field));
      }
      case How::same: {
        Field field = (*this)(row.from);
        field.name = name;
        return field;
      }
      case How::strain:
        return on_wanted_cells(strain(Strain::small, setting_.wanted(), name));
      case How::strain_green:
        return on_wanted_cells(strain(Strain::green_lagrange, setting_.wanted(), name));
      case How::strain_logarithmic:
        return on_wanted_cells(strain(Strain::logarithmic, setting_.wanted(), name));
      case How::plastic:
        return plastic((*this)(row.from), name);
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
      case How::mechanical_strain:
        return mechanical_strain((*this)(row.from), name);
      case How::stress_energy:
        refuse_large_strain((*this)(row.from), name);
        return energy_of_stress((*this)(row.from), name, setting_.materials());
      case How::path_energy:
        return path_energy((*this)(row.from), name);
      case How::integral:
        return cell_integrals(mesh, setting_.points(), (*this)(row.from), name);
    }
    throw std::logic_error("a field without rule");
  }

  Field on_wanted_cells(Field&& field) const {
    if (setting_.has_part()) field = restrict_to_cells(field, setting_.wanted());
    if (field.support.empty())
      fail("CALCCHAMP_2", {{"groups", setting_.groups()}, {"label", setting_.result().label}, {"field", field.name}});
    return std::move(field);
  }

  Field strain(Strain measure, const std::vector<char>& wanted, std::string name) {
    Field field = strains(setting_.mesh(), setting_.points(), (*this)("DEPL"), wanted, measure, std::move(name));
    const auto across = [&](std::int32_t cell, catalog::TransverseStrain follows) {
      const auto c = static_cast<std::size_t>(cell);
      return setting_.points().is_plane_stress(c) && setting_.behaviours(order_).relation[c]->transverse_strain == follows;
    };
    for (const std::int32_t cell : field.support)
      if (across(cell, catalog::TransverseStrain::unknown))
        fail("CALCCHAMP_4",
             {{"cell", cell_name(cell)},
              {"label", setting_.result().label},
              {"relation", std::string(setting_.behaviours(order_).relation[static_cast<std::size_t>(cell)]->name)}});
    const auto is_plastic = [&](std::int32_t cell) { return across(cell, catalog::TransverseStrain::isochoric); };
    setting_.materials().set_strain_across(field);
    if (std::none_of(field.support.begin(), field.support.end(), is_plastic)) return field;
    if (measure != Strain::small)
      fail("CALCCHAMP_3", {{"cell", cell_name(*std::find_if(field.support.begin(), field.support.end(), is_plastic))},
                           {"label", setting_.result().label}});
    // plastic strain keeps the volume: the trace of the strain is the elastic one, (1 - 2 nu) / E times that of the stress
    const Field stress = setting_.base().field(setting_.result(), "SIEF_ELGA", order_);
    const std::vector<std::int64_t> place = places(stress, setting_.mesh().n_cells());
    const TensorRows tensors(stress, "SI"), own(field, "EP");
    const std::vector<Eigen::Matrix3d> free = setting_.materials().free_strains(field);
    const std::vector<double> moduli = setting_.materials().moduli(field);
    const auto zz = static_cast<std::size_t>(field.component("EPZZ"));
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      const std::int32_t cell = field.support[i];
      if (!is_plastic(cell) || place[static_cast<std::size_t>(cell)] < 0) continue;
      const double young = moduli[2 * i], nu = moduli[2 * i + 1];
      const std::size_t first = stress.first_row(static_cast<std::size_t>(place[static_cast<std::size_t>(cell)]));
      for (std::size_t row = field.first_row(i); row < field.first_row(i + 1); ++row) {
        const Eigen::Matrix3d in_plane = own[row];
        field.at(row, zz) = free[row].trace() + (1 - 2 * nu) / young * tensors[first + row - field.first_row(i)].trace() -
                            in_plane(0, 0) - in_plane(1, 1);
      }
    }
    return field;
  }

  /// Less the strains without stress.
  Field mechanical_strain(const Field& whole, std::string name) {
    Field field = whole;
    field.name = std::move(name);
    const std::vector<Eigen::Matrix3d> free = setting_.materials().free_strains(field);
    for (const TensorAxes& axes : tensor_axes)
      if (const int column = field.component("EP" + std::string(axes.name)); column >= 0)
        for (std::size_t row = 0; row < free.size(); ++row)
          field.at(row, static_cast<std::size_t>(column)) -= free[row](axes.i, axes.j);
    return field;
  }

  /// What has flowed. Throws CALCCHAMP_7 under a measure of strain that does not say so.
  Field plastic(const Field& stress, const std::string& name) {
    const CellBehaviours& behaviours = setting_.behaviours(order_);
    std::vector<catalog::PlasticStrain> measure(setting_.mesh().n_cells(), catalog::PlasticStrain::unknown);
    bool stretches = false;
    for (const std::int32_t cell : stress.support) {
      const auto c = static_cast<std::size_t>(cell);
      measure[c] = plastic_measure(*behaviours.relation[c], *behaviours.deformation[c]);
      if (measure[c] == catalog::PlasticStrain::unknown)
        fail("CALCCHAMP_7", {{"field", name},
                             {"cell", cell_name(cell)},
                             {"label", setting_.result().label},
                             {"deformation", std::string(behaviours.deformation[c]->name)}});
      stretches = stretches || measure[c] == catalog::PlasticStrain::stretches;
    }
    const FlownState state{(*this)("EPSI_ELGA"), stress, (*this)("DEPL"), stretches ? &(*this)("VARI_ELGA") : nullptr};
    return plastic_strain(setting_.mesh(), setting_.points(), state, measure, name, setting_.materials());
  }

  /// CALCCHAMP_5: energies are those of small strains.
  void refuse_large_strain(const Field& field, const std::string& name) {
    for (const std::int32_t cell : field.support)
      if (setting_.behaviours(order_).moved[static_cast<std::size_t>(cell)])
        fail("CALCCHAMP_5", {{"field", name}, {"cell", cell_name(cell)}, {"label", setting_.result().label}});
  }

  /// Work of the stresses since the first instant of the result, by trapezia; no more than two instants are in memory.
  Field path_energy(const Field& stress, const std::string& name) {
    refuse_large_strain(stress, name);
    auto& known = setting_.path_energy();
    if (known && known->first > order_) known.reset();
    std::optional<Instant> last;
    if (known) last.emplace(setting_, known->first);
    const auto add = [&](Instant& now) {
      std::optional<StateOfPoints> then;
      if (last) then.emplace((*last)("SIEF_ELGA"), (*last)("EPSI_ELGA"));
      known.emplace(now.order_, energy_of_path({now("SIEF_ELGA"), now("EPSI_ELGA")}, then ? &*then : nullptr,
                                               known ? &known->second : nullptr, name));
    };
    for (const std::int64_t o : setting_.result().orders) {
      if (o >= order_ || (known && o <= known->first)) continue;
      if (!has_field(setting_.result(), "SIEF_ELGA", o) || !has_field(setting_.result(), "DEPL", o)) continue;
      Instant now(setting_, o);
      now.refuse_large_strain(now("SIEF_ELGA"), name);
      add(now);
      last.emplace(std::move(now));
    }
    if (!known || known->first < order_) add(*this);
    return known->second;
  }

  /// Of each row of a field of stresses: how thick a plate of thickness 1 is now, sqrt(1 + 2 E_zz) with Green-Lagrange.
  std::vector<double> thickness(const Field& stress) {
    const auto changes = [&](std::size_t cell) {
      return setting_.behaviours(order_).green[cell] && setting_.points().is_plane_stress(cell);
    };
    std::vector<char> wanted(setting_.mesh().n_cells(), 0);
    for (const std::int32_t cell : stress.support)
      wanted[static_cast<std::size_t>(cell)] = changes(static_cast<std::size_t>(cell));
    std::vector<double> factors(stress.n_rows(), 1.0);
    if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) return factors;
    const Field green = strain(Strain::green_lagrange, wanted, "EPSG_ELGA");
    const std::vector<std::int64_t> place = places(green, wanted.size());
    const auto zz = static_cast<std::size_t>(green.component("EPZZ"));
    for (std::size_t i = 0; i < stress.support.size(); ++i) {
      const std::int64_t at = place[static_cast<std::size_t>(stress.support[i])];
      for (std::size_t row = stress.first_row(i); at >= 0 && row < stress.first_row(i + 1); ++row)
        factors[row] =
            std::sqrt(1 + 2 * green.at(green.first_row(static_cast<std::size_t>(at)) + row - stress.first_row(i), zz));
    }
    return factors;
  }

  Field forces(const Field& stress, std::string name) {
    return nodal_forces(setting_.mesh(), setting_.points(), stress, setting_.behaviours(order_).moved,
                        displaced(setting_.mesh(), (*this)("DEPL")), thickness(stress), std::move(name));
  }

  /// What holds the nodes: forces of all stresses less the loads. With GROUP_MA on the nodes of these cells.
  Field reactions(std::string name) {
    const Mesh& mesh = setting_.mesh();
    Field field = forces(setting_.base().field(setting_.result(), "SIEF_ELGA", order_), std::move(name));
    const std::size_t width = field.n_components();
    const std::vector<double> displacement = nodal_displacements(mesh, (*this)("DEPL"), static_cast<int>(width)),
                              external = setting_.external_force(order_, field.instant, displacement);
    const std::size_t n_unknowns = external.size() / mesh.n_nodes();  // of a node, displacements first
    for (std::size_t i = 0; i < field.support.size(); ++i)
      for (std::size_t d = 0; d < width; ++d)
        field.at(i, d) -= external[static_cast<std::size_t>(field.support[i]) * n_unknowns + d];
    return setting_.has_part() ? restrict_to_nodes(field, nodes_of_marked_cells(mesh, setting_.wanted())) : field;
  }

  Setting& setting_;
  std::int64_t order_;
  std::map<std::string, Field, std::less<>> fields_;
};

/// EXCIT: the loads of the result at an instant, each with its function, in any order. Throws CALCCHAMP_6.
void check_loads(const Base& base, const Result& from, std::int64_t order, const Keywords& keywords) {
  if (!keywords.has("EXCIT")) return;
  using Loads = std::vector<std::pair<std::string, std::string>>;
  const auto labels = [&](Loads loads) {
    std::sort(loads.begin(), loads.end());
    std::vector<std::string> names;
    for (const auto& [load, function] : loads)
      names.push_back(base.label(load) + (function.empty() ? "" : " with " + base.label(function)));
    return fmt::format("{}", fmt::join(names, ", "));
  };
  Loads given, own;
  for (const Keywords& factor : keywords.factors("EXCIT"))
    given.emplace_back(factor.concept_id("CHARGE"), factor.optional_concept("FONC_MULT").value_or(""));
  for (const ResultLoad& load : from.stage(order).loads) own.emplace_back(load.load, load.function);
  if (std::is_permutation(given.begin(), given.end(), own.begin(), own.end())) return;
  fail("CALCCHAMP_6",
       {{"keyword", keywords.path("EXCIT")}, {"given", labels(given)}, {"label", from.label}, {"own", labels(own)}});
}

}  // namespace

void calc_champ(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Result from = with_model(base, base.result(keywords.concept_id("RESULTAT")), keywords);
  std::vector<std::string> asked;
  for (const char* family : {"CONTRAINTE", "DEFORMATION", "CRITERES", "VARI_INTERNE", "FORCE", "ENERGIE"})
    for (const std::string& name : keywords.texts(family)) asked.push_back(name);
  Setting setting(order, base, from);

  // without a choice of instants, those that a field cannot be computed at are left alone as long as others have it
  const std::vector<std::int64_t> orders = selected_orders(base, from, keywords);
  for (const std::int64_t o : orders) check_loads(base, from, o, keywords);
  std::vector<std::pair<std::int64_t, std::string>> fields;
  for (const std::int64_t o : orders)
    for (const std::string& name : asked) {
      const std::vector<std::string> roots =
          roots_of(name, !keywords.texts("VARI_INTERNE").empty() && setting.has_zero_variables());
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
    if (!order.reuse || row_of(name).how != How::archived || (name == "VARI_ELGA" && setting.has_zero_variables()))
      base.add_field(to, instant->second(name));
  }
  base.store(to);
}

}  // namespace lacon
