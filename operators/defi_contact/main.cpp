#include "lacon/operators/defi_contact/defi_contact.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "defi_contact", "Defines contact zones and their slave elements (command DEFI_CONTACT)",
                     [](const Order& order, const Base& base) {
                       const std::string model_id = order.keywords.concept_id("MODELE");
                       const Model model = base.model(model_id);
                       const Mesh mesh = base.mesh(model.mesh);
                       const Registry registry(order.plugins);
                       Contact contact = defi_contact(mesh, model, registry, base, order.keywords);
                       contact.model = model_id;
                       base.store(contact);
                     });
}
