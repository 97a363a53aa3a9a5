// count_nodes FILE: prints how many nodes the first mesh of a MED file has.
#include <cstdio>
#include <lacon/structures/formats/med.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 1;
  std::printf("%zu\n", lacon::read_med_mesh(argv[1]).n_nodes());
}
