#include "lacon/operators/modi_maillage/modi_maillage.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "modi_maillage", "Changes a mesh in place: orients skins outward",
                     [](const Order& order, const Base& base) {
                       Mesh mesh = base.mesh(order.keywords.concept_id("MAILLAGE"));
                       modi_maillage(mesh, order.keywords);
                       base.store(mesh);
                     });
}
