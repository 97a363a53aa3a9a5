#include "lacon/operators/meca_statique/meca_statique.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "meca_statique", "Linear static equilibrium at instants (MECA_STATIQUE)",
                            lacon::meca_statique);
}
