#include "lacon/operators/affe_modele/affe_modele.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "affe_modele", "Gives finite elements to the cells of a mesh (command AFFE_MODELE)",
                     [](const Order& order, const Base& base) {
                       const std::string mesh_id = order.keywords.concept_id("MAILLAGE");
                       const Mesh mesh = base.mesh(mesh_id);
                       Model model = affe_modele(mesh, Registry(order.plugins), order.keywords);
                       model.mesh = mesh_id;
                       base.store(model);
                     });
}
