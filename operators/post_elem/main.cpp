#include "lacon/operators/post_elem/post_elem.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "post_elem", "Norms, integrals and extreme values of fields, as a table",
                            lacon::post_elem);
}
