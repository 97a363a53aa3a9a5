#include <malloc.h>

#include <limits>

#include "lacon/operators/crea_maillage/crea_maillage.hpp"
#include "lacon/operators/crea_maillage/tool.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  // large arrays come and go: the next takes the pages of the one before, instead of new ones that the system must clear first
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  if (!takes_order(argc, argv)) return cut_med_file(argc, argv);
  return run_program(argc, argv, "crea_maillage", "Makes a mesh from another: cut for LAC, linear to quadratic or back",
                     [](const Order& order, const Base& base) {
                       Mesh mesh = [&] {
                         const Phase phase("read");
                         return base.mesh(order.keywords.concept_id("MAILLAGE"));
                       }();
                       const Mesh made = [&] {
                         const Phase phase("change");
                         return crea_maillage(std::move(mesh), order.keywords,
                                              base.label(order.keywords.concept_id("MAILLAGE")));
                       }();
                       const Phase phase("write");
                       base.store(made);
                     });
}
