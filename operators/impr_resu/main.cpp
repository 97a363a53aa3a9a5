#include <iostream>

#include "lacon/operators/impr_resu/impr_resu.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  using namespace lacon;
  return run_program(argc, argv, "impr_resu", "Writes meshes and fields to MED, VTU or text files (command IMPR_RESU)",
                     [](const Order& order, const Base& base) {
                       const Phase phase("write");
                       for (const std::string& line : impr_resu(order, base)) std::cout << line << '\n';
                     });
}
