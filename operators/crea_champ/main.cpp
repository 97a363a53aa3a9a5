#include "lacon/operators/crea_champ/crea_champ.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "crea_champ", "Makes a field out of values, functions, results and other fields",
                            lacon::crea_champ);
}
