#include "lacon/operators/affe_cara_elem/affe_cara_elem.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "affe_cara_elem", "Gives springs to discrete elements (command AFFE_CARA_ELEM)",
                     [](const Order& order, const Base& base) {
                       const std::string model_id = order.keywords.concept_id("MODELE");
                       const Model model = base.model(model_id);
                       ElementCharacteristics made =
                           affe_cara_elem(base.mesh(model.mesh), model, Registry(order.plugins), order.keywords);
                       made.model = model_id;
                       base.store(made);
                     });
}
