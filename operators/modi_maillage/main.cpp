#include "lacon/operators/meshing/checks.hpp"
#include "lacon/operators/modi_maillage/deform.hpp"
#include "lacon/operators/modi_maillage/modi_maillage.hpp"
#include "lacon/operators/program/program.hpp"

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
