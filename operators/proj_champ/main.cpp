#include "lacon/operators/program/program.hpp"
#include "lacon/operators/proj_champ/proj_champ.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "proj_champ", "Takes fields to another mesh (command PROJ_CHAMP)", lacon::proj_champ);
}
