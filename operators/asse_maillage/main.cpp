#include "lacon/operators/asse_maillage/asse_maillage.hpp"
#include "lacon/operators/program/program.hpp"

int main(int argc, char** argv) {
  return lacon::run_program(argc, argv, "asse_maillage", "Two meshes in one", lacon::asse_maillage);
}
