#include "lacon/operators/crea_resu/crea_resu.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "crea_resu", "Makes a result out of fields (command CREA_RESU)", lacon::crea_resu);
}
