#include "lacon/operators/macr_adap_mail/macr_adap_mail.hpp"
#include "lacon/operators/meshing/body.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "macr_adap_mail", "Refines a mesh uniformly: every edge is cut in two",
                     [](const Order& order, const Base& base) {
                       const Mesh mesh = base.mesh(order.keywords.concept_id("MAILLAGE_N"));
                       refuse_cut_mesh(mesh, order.command, base.label(order.keywords.concept_id("MAILLAGE_N")));
                       base.store(macr_adap_mail(mesh, order.keywords));
                     });
}
