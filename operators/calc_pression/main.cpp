#include "lacon/operators/calc_pression/calc_pression.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "calc_pression", "Adds to a result what its stresses exert on skins (PRES_NOEU)",
                            lacon::calc_pression);
}
