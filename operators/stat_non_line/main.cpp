#include "lacon/operators/program/program.hpp"
#include "lacon/operators/stat_non_line/stat_non_line.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "stat_non_line", "Quasi-static equilibrium with contact (STAT_NON_LINE)",
                            lacon::stat_non_line);
}
