#include "lacon/operators/macr_lign_coupe/macr_lign_coupe.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "macr_lign_coupe", "Values of nodal fields along lines, as a table",
                            lacon::macr_lign_coupe);
}
