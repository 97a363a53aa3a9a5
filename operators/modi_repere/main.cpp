#include "lacon/operators/modi_repere/modi_repere.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "modi_repere", "Makes a result of another one's fields in other axes",
                            lacon::modi_repere);
}
