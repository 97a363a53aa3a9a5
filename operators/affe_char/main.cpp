#include "lacon/operators/affe_char/affe_char.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "affe_char",
                     "Makes a load: imposed displacements, forces, pressures (AFFE_CHAR_CINE, AFFE_CHAR_MECA, and _F)",
                     [](const Order& order, const Base& base) {
                       const std::string model_id = order.keywords.concept_id("MODELE");
                       const Model model = base.model(model_id);
                       const Mesh mesh = base.mesh(model.mesh);
                       Registry registry(order.plugins);
                       Load load = affe_char(mesh, model, registry, base, order.keywords);
                       load.model = model_id;
                       load.kind = order.command.starts_with("AFFE_CHAR_CINE") ? "cine" : "meca";
                       base.store(load);
                     });
}
