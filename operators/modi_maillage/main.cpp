#include "lacon/operators/modi_maillage/modi_maillage.hpp"

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/meshing/checks.hpp"
#include "lacon/operators/program/program.hpp"
#include "lacon/structures/displacement.hpp"

namespace {

/// DEFORME: the nodes move by a field of displacements on this mesh, or on another with the same nodes at the same places
/// (COPIER).
void deform(lacon::Mesh& mesh, const lacon::Keywords& factor, const lacon::Base& base, const std::string& mesh_id) {
  const lacon::Field displacement = base.field(factor.concept_id("DEPL"));
  const std::string label = base.label(factor.concept_id("DEPL"));
  if (displacement.mesh != mesh_id && base.mesh(displacement.mesh).coordinates != mesh.coordinates)
    lacon::fail("CREACHAMP_5", {{"first", base.label(mesh_id)}, {"second", base.label(displacement.mesh)}});
  if (displacement.location != lacon::Location::nodes || displacement.quantity != "DEPL_R")
    lacon::fail("CREACHAMP_9",
                {{"field", label},
                 {"type", std::string(lacon::location_name(displacement.location)) + "_" + displacement.quantity},
                 {"wanted", "NOEU_DEPL_R"}});
  mesh.coordinates = lacon::displaced(mesh, displacement);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "modi_maillage", "Changes a mesh in place: orients skins outward, moves nodes",
                     [](const Order& order, const Base& base) {
                       const std::string id = order.keywords.concept_id("MAILLAGE");
                       Mesh mesh = base.mesh(id);
                       for (const Keywords& factor : order.keywords.factors("DEFORME")) deform(mesh, factor, base, id);
                       modi_maillage(mesh, order.keywords);
                       check_places(mesh);
                       base.store(mesh);
                     });
}
