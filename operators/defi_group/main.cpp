#include "lacon/operators/defi_group/defi_group.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "defi_group", "Adds groups of cells and nodes to a mesh, or removes them",
                     [](const Order& order, const Base& base) {
                       Mesh mesh = base.mesh(order.keywords.concept_id("MAILLAGE"));
                       defi_group(mesh, order.keywords);
                       base.store(mesh);
                     });
}
