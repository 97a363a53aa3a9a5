#include "lacon/operators/post_elem/energies.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/mechanics.hpp"
#include "lacon/operators/fields/result_materials.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/post_elem/parts.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

/// The result that POST_ELEM names, with all that its fields are integrated by.
struct Subject {
  Subject(const Order& order, const Base& base)
      : result(with_model(base, base.result(order.keywords.concept_id("RESULTAT")), order.keywords)),
        model(model_of(base, result)),
        mesh(base.mesh(model.mesh)),
        registry(order.plugins),
        points(mesh, model, registry),
        materials(base, result, mesh, points) {
    const std::vector<std::int64_t> chosen = selected_orders(base, result, order.keywords);
    for (std::size_t k = 0; k < result.orders.size(); ++k)
      if (std::find(chosen.begin(), chosen.end(), result.orders[k]) != chosen.end()) orders.push_back(k);
  }
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  Result result;
  Model model;
  Mesh mesh;
  Registry registry;
  ModelPoints points;
  ResultMaterials materials;
  std::vector<std::size_t> orders;  ///< places in result.orders
};

void refuse_large_strain(const Result& result, const std::string& keyword) {
  for (const ResultStage& stage : result.stages)
    for (const auto& behaviour : nlohmann::json::parse(stage.behaviour))
      if (const std::string deformation = behaviour.value("DEFORMATION", "PETIT"); deformation != "PETIT")
        fail("POSTELEM_4", {{"keyword", keyword}, {"deformation", deformation}, {"label", result.label}});
}

}  // namespace

Table energies(const Order& order, const Base& base, const std::string& keyword) {
  Subject subject(order, base);
  refuse_large_strain(subject.result, keyword);
  Table table =
      Table::of({{"NUME_ORDRE", "I"}, {"INST", "R"}, {"LIEU", "K24"}, {"ENTITE", "K8"}, {"TOTALE", "R"}, {"POUR_CENT", "R"}});
  const std::vector<char> everywhere(subject.mesh.n_cells(), 1);
  for (const std::size_t k : subject.orders) {
    const std::int64_t number = subject.result.orders[k];
    const Field energy = [&] {
      if (keyword == "ENER_ELAS")
        return energy_of_stress(base.field(subject.result, "SIEF_ELGA", number), "ENEL_ELGA", subject.materials);
      Field strain = strains(subject.mesh, subject.points, base.field(subject.result, "DEPL", number), everywhere,
                             Strain::small, "EPSI_ELGA");
      subject.materials.set_strain_across(strain);
      return energy_of_strain(strain, "EPOT_ELGA", subject.materials);
    }();
    const Field sums = cell_integrals(subject.mesh, subject.points, energy, "ENEL_ELEM");
    double whole = 0;
    for (const double value : sums.values) whole += value;
    for (const Keywords& factor : order.keywords.factors(keyword))
      for (const Part& part : parts_of(subject.mesh, subject.points, factor)) {
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < sums.support.size(); ++i) {
          if (!part.cells[static_cast<std::size_t>(sums.support[i])]) continue;
          sum += sums.values[i];
          ++count;
        }
        if (count == 0)
          fail("POSTELEM_2", {{"keyword", factor.path("GROUP_MA")}, {"place", part.place}, {"field", energy.name}});
        table.add({number, subject.result.instants[k], part.place, part.entity, sum, whole != 0 ? 100 * sum / whole : 0.0});
      }
  }
  return table;
}

Table external_work(const Order& order, const Base& base) {
  Subject subject(order, base);
  refuse_large_strain(subject.result, "TRAV_EXT");
  Table table = Table::of({{"NUME_ORDRE", "I"}, {"INST", "R"}, {"TRAV_ELAS", "R"}, {"TRAV_REEL", "R"}});
  const int dimension = subject.mesh.dimension;
  const std::vector<char> fixed(subject.mesh.n_cells(), 0);
  std::vector<double> last_force, last_motion;
  double done = 0;
  for (std::size_t k = 0; k < subject.result.orders.size(); ++k) {
    const std::int64_t number = subject.result.orders[k];
    const Field stress = base.field(subject.result, "SIEF_ELGA", number);
    const std::vector<double> ones(stress.n_rows(), 1.0),
        motion = nodal_displacements(subject.mesh, base.field(subject.result, "DEPL", number), dimension),
        force = nodal_displacements(
            subject.mesh,
            nodal_forces(subject.mesh, subject.points, stress, fixed, subject.mesh.coordinates, ones, "FORC_NODA"), dimension);
    double elastic = 0;
    for (std::size_t i = 0; i < motion.size(); ++i) {
      elastic += force[i] * motion[i] / 2;
      const double before = last_force.empty() ? 0.0 : last_force[i], from = last_motion.empty() ? 0.0 : last_motion[i];
      done += (force[i] + before) * (motion[i] - from) / 2;
    }
    last_force = force;
    last_motion = motion;
    if (std::find(subject.orders.begin(), subject.orders.end(), k) != subject.orders.end())
      table.add({number, subject.result.instants[k], elastic, done});
  }
  return table;
}

}  // namespace lacon
