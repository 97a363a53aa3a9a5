#include "lacon/operators/affe_materiau/affe_materiau.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "affe_materiau", "Gives materials to the cells of a mesh (command AFFE_MATERIAU)",
                     [](const Order& order, const Base& base) { base.store(affe_materiau(base, order.keywords)); });
}
