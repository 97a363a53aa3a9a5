#include "lacon/operators/extr_resu/extr_resu.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "extr_resu", "Takes instants and fields out of a result (command EXTR_RESU)",
                            lacon::extr_resu);
}
