#include "lacon/operators/calc_pression/calc_pression.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/fields/tensor.hpp"
#include "lacon/pairing/normals.hpp"
#include "lacon/structures/displacement.hpp"

namespace lacon {
namespace {

/// The name of the field that holds, or gives, the stresses at nodes of an order; empty where there is none.
std::string stress_name(const Result& result, std::int64_t order) {
  for (const char* name : {"SIEF_NOEU", "SIGM_NOEU", "SIEF_ELGA"}) {
    const auto named = result.fields.find(name);
    if (named != result.fields.end() && named->second.contains(order)) return name;
  }
  return {};
}

Field stress_at_nodes(const Base& base, const Result& result, const Mesh& mesh, std::int64_t order) {
  Field stress = base.field(result, stress_name(result, order), order);
  if (stress.location == Location::nodes) return stress;
  return cell_nodes_to_nodes(mesh, gauss_points_to_cell_nodes(mesh, stress, "SIEF_ELNO"), "SIEF_NOEU");
}

/// PRES_NOEU out of stresses and normals. @param normals (n_nodes of the mesh, 3)
Field pressure(const Mesh& mesh, const Field& stress, const std::vector<std::int32_t>& skin, std::span<const double> normals) {
  Field field = field_like(stress, "PRES_NOEU", Location::nodes);
  field.quantity = "PRES_R";
  field.components = {"PRES", "CISA", "VX", "VY"};
  if (mesh.dimension == 3) field.components.emplace_back("VZ");
  std::vector<std::int64_t> row(mesh.n_nodes(), -1);
  for (std::size_t i = 0; i < stress.support.size(); ++i)
    row[static_cast<std::size_t>(stress.support[i])] = static_cast<std::int64_t>(i);
  const TensorRows tensors(stress, "SI");
  for (const std::int32_t node : nodes_of_cells(mesh, skin)) {
    const std::int64_t at = row[static_cast<std::size_t>(node)];
    if (at < 0 || !tensors.has(static_cast<std::size_t>(at))) continue;
    const Eigen::Map<const Eigen::Vector3d> normal(normals.data() + 3 * static_cast<std::ptrdiff_t>(node));
    if (normal.isZero(0)) fail("CALCPRES_2", {{"node", node_name(node)}});
    const Eigen::Vector3d traction = tensors[static_cast<std::size_t>(at)] * normal;
    const double pressure = normal.dot(traction);
    const Eigen::Vector3d shear = traction - pressure * normal;
    field.support.push_back(node);
    field.values.insert(field.values.end(), {pressure, shear.norm()});
    field.values.insert(field.values.end(), shear.data(), shear.data() + mesh.dimension);
  }
  return field;
}

}  // namespace

void calc_pression(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Result from = base.result(keywords.concept_id("RESULTAT"));
  if (const auto given = keywords.optional_concept("MAILLAGE"); given && *given != from.mesh)
    fail("CALCPRES_3", {{"mesh", base.label(*given)}, {"label", from.label}, {"own", base.label(from.mesh)}});
  check_own_mesh(base, from.mesh, keywords, "", "MODELE");
  const Mesh mesh = base.mesh(from.mesh);
  const std::vector<std::int32_t> skin = selected_skin(mesh, keywords);
  const bool deformed = keywords.text("GEOMETRIE") == "DEFORMEE";

  std::vector<std::int64_t> orders = selected_orders(base, from, keywords);
  const auto lacks = [&](std::int64_t o) { return stress_name(from, o).empty(); };
  const auto missing = std::find_if(orders.begin(), orders.end(), lacks);
  if (missing != orders.end() && (names_instants(keywords) || std::all_of(orders.begin(), orders.end(), lacks)))
    fail("CALCCHAMP_1",
         {{"label", from.label}, {"order", std::to_string(*missing)}, {"source", "SIEF_ELGA"}, {"field", "PRES_NOEU"}});
  std::erase_if(orders, lacks);

  std::vector<Field> fields;
  for (const std::int64_t o : orders) {
    const Field stress = stress_at_nodes(base, from, mesh, o);
    const std::vector<double> coordinates = deformed ? displaced(mesh, base.field(from, "DEPL", o)) : mesh.coordinates;
    fields.push_back(pressure(mesh, stress, skin, nodal_normals(surface_of(mesh, skin, coordinates))));
    if (fields.back().support.empty())
      fail("CALCCHAMP_2", {{"groups", fmt::format("{}", fmt::join(keywords.texts("GROUP_MA"), ", "))},
                           {"label", from.label},
                           {"field", "SIEF_NOEU"}});
  }
  Result to = order.reuse ? from : part_of(from, orders);
  for (Field& field : fields) base.add_field(to, std::move(field));
  base.store(to);
}

}  // namespace lacon
