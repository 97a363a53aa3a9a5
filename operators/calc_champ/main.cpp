#include "lacon/operators/calc_champ/calc_champ.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "calc_champ",
                            "Adds fields to a result: stresses at integration points, nodes of cells, nodes",
                            lacon::calc_champ);
}
