#include "lacon/operators/post_elem/inertia.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/fields/thermal.hpp"
#include "lacon/operators/post_elem/parts.hpp"

namespace lacon {
namespace {

/// Integrals of density, of density times place, of density times place times place.
struct Moments {
  double mass = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void add(double mass_there, const Eigen::Vector3d& place) {
    mass += mass_there;
    first += mass_there * place;
    second += mass_there * place * place.transpose();
  }
  /// The mass of one radian at (radius, height), turned about the axis, which is Y: what is even in cos and sin is left.
  void add_ring(double mass_of_radian, double radius, double height) {
    const double whole = 2 * std::numbers::pi * mass_of_radian;
    mass += whole;
    first.y() += whole * height;
    second.diagonal() += whole * Eigen::Vector3d(radius * radius / 2, height * height, radius * radius / 2);
  }
};

/// The tensor of inertia of second moments: trace - second.
Eigen::Matrix3d tensor(const Eigen::Matrix3d& second) { return second.trace() * Eigen::Matrix3d::Identity() - second; }

/// IX, IY, IZ and the products of inertia IXY, IXZ, IYZ, integrals of density times x y and so on.
void put_moments(std::vector<Table::Cell>& row, const Eigen::Matrix3d& second) {
  const Eigen::Matrix3d about = tensor(second);
  for (const double value : {about(0, 0), about(1, 1), about(2, 2), second(0, 1), second(0, 2), second(1, 2)})
    row.emplace_back(value);
}

/// Principal moments, increasing; in the plane the two of the plane, and the one across it.
Eigen::Vector3d principal(const Eigen::Matrix3d& second, int dimension) {
  const Eigen::Matrix3d about = tensor(second);
  if (dimension == 3) return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(about).eigenvalues();
  const Eigen::Matrix2d plane = about.topLeftCorner<2, 2>();
  const Eigen::Vector2d found = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(plane).eigenvalues();
  return {found[0], found[1], about(2, 2)};
}

}  // namespace

Table inertia(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  Result bodies;  // what is given counts, beside a result's own too
  if (keywords.has("RESULTAT")) bodies = base.result(keywords.concept_id("RESULTAT"));
  bodies.model = keywords.optional_concept("MODELE").value_or(bodies.model);
  bodies.material_field = keywords.optional_concept("CHAM_MATER").value_or(bodies.material_field);
  const Model model = model_of(base, bodies);
  bodies.mesh = model.mesh;
  const MaterialField field = materials_of(base, bodies);
  const Mesh mesh = base.mesh(model.mesh);
  const Registry registry(order.plugins);
  ModelPoints points(mesh, model, registry);
  const MaterialTemperatures temperatures = read_temperatures(base, bodies.material_field, mesh);
  const MaterialTable materials = read_materials(base, field, temperatures);

  // of instants that are named the same rows for each: mass and initial geometry do not change
  const bool of_instants = names_instants(keywords) || keywords.has("TOUT_ORDRE");
  std::vector<std::vector<Table::Cell>> heads(1);
  std::vector<std::pair<std::string, std::string>> columns;
  if (of_instants) {
    columns = {{"NUME_ORDRE", "I"}, {"INST", "R"}};
    heads.clear();
    const std::vector<std::int64_t> chosen = selected_orders(base, bodies, keywords);
    for (std::size_t k = 0; k < bodies.orders.size(); ++k)
      if (std::find(chosen.begin(), chosen.end(), bodies.orders[k]) != chosen.end())
        heads.push_back({bodies.orders[k], bodies.instants[k]});
  }
  columns.insert(columns.end(), {{"LIEU", "K24"}, {"ENTITE", "K8"}, {"MASSE", "R"}});
  for (const char* name :
       {"CDG_X",     "CDG_Y", "CDG_Z", "IX_G", "IY_G", "IZ_G", "IXY_G", "IXZ_G", "IYZ_G", "IX_PRIN_G", "IY_PRIN_G",
        "IZ_PRIN_G", "X_P",   "Y_P",   "Z_P",  "IX_P", "IY_P", "IZ_P",  "IXY_P", "IXZ_P", "IYZ_P"})
    columns.emplace_back(name, "R");
  Table table = Table::of(columns);
  std::vector<std::vector<Table::Cell>> rows;
  for (const Keywords& factor : keywords.factors("MASS_INER")) {
    for (const Part& part : parts_of(mesh, points, factor)) {
      Moments moments;
      for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
        if (!part.cells[cell] || !points.is_solid(cell)) continue;
        const double density = materials.parameter(static_cast<std::int32_t>(cell), "ELAS/RHO", points.element(cell)->name);
        const bool turned = points.is_axisymmetric(cell);
        const CellPoints& at = points(cell, mesh.coordinates);
        for (std::size_t p = 0; p < static_cast<std::size_t>(at.n_points); ++p) {
          const Eigen::Vector3d place = Eigen::Map<const Eigen::Vector3d>(at.position.data() + 3 * p);
          if (turned)
            moments.add_ring(density * at.measure[p], place.x(), place.y());
          else
            moments.add(density * at.measure[p], place);
        }
      }
      if (moments.mass == 0) fail("POSTELEM_5", {{"keyword", factor.path("GROUP_MA")}, {"place", part.place}});
      const Eigen::Vector3d centre = moments.first / moments.mass;
      const Eigen::Matrix3d about_centre = moments.second - moments.mass * centre * centre.transpose();
      std::vector<Table::Cell> row{part.place, part.entity, moments.mass, centre.x(), centre.y(), centre.z()};
      put_moments(row, about_centre);
      for (const double value : principal(about_centre, mesh.dimension)) row.emplace_back(value);
      if (factor.has("ORIG_INER")) {
        std::vector<double> origin = factor.reals("ORIG_INER");
        origin.resize(3, 0.0);
        const Eigen::Vector3d point(origin[0], origin[1], origin[2]), arm = centre - point;
        for (const double value : point) row.emplace_back(value);
        put_moments(row, about_centre + moments.mass * arm * arm.transpose());
      }
      row.resize(columns.size() - heads.front().size());
      rows.push_back(std::move(row));
    }
  }
  for (const std::vector<Table::Cell>& head : heads)
    for (const std::vector<Table::Cell>& row : rows) {
      std::vector<Table::Cell> whole = head;
      whole.insert(whole.end(), row.begin(), row.end());
      table.add(std::move(whole));
    }
  return table;
}

}  // namespace lacon
