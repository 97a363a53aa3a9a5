// pull FOLDER...: stretches one QUAD4 of the plug-ins in these folders and prints its stresses, SIXX SIYY SIZZ SIXY.
#include <cstdio>
#include <filesystem>
#include <lacon/catalog/messages.hpp>
#include <lacon/elements/reference.hpp>
#include <lacon/elements/registry.hpp>
#include <vector>

int main(int argc, char** argv) try {
  const std::vector<std::filesystem::path> folders(argv + 1, argv + argc);
  lacon::Registry registry(folders);
  const auto* element = registry.find_element("PLANE_STRESS/QUAD4");
  if (!element) return 1;
  const lacon_kernel& kernel = registry.kernel(*element, "ELAS/PETIT", LACON_SOLID);
  const auto table = lacon::tabulate(element->cell, lacon::integration_rule(lacon::Family::QUAD, element->points));

  // the unit square, u = (x / 100, 0), in all lanes; E = 300, nu = 0.5
  const double nodes[] = {0, 0, 1, 0, 1, 1, 0, 1};
  std::vector<double> x, u, p;
  for (int i = 0; i < 8; ++i) {
    x.insert(x.end(), LACON_LANES, nodes[i]);
    u.insert(u.end(), LACON_LANES, i % 2 == 0 ? nodes[i] / 100 : 0);
  }
  for (const double value : {300.0, 0.5}) p.insert(p.end(), LACON_LANES, value);
  std::vector<double> stress(4 * 4 * LACON_LANES);
  std::vector<std::int32_t> error(LACON_LANES);
  const lacon_solid_batch batch{sizeof batch,
                                1,
                                4,
                                2,
                                4,
                                4,
                                2,
                                table.shape.data(),
                                table.gradient.data(),
                                table.weight.data(),
                                x.data(),
                                u.data(),
                                p.data(),
                                nullptr,
                                nullptr,
                                stress.data(),
                                error.data()};
  kernel.solid(&batch);
  for (const std::int32_t e : error)
    if (e != LACON_FINE) return 1;
  for (int c = 0; c < 4; ++c) std::printf("%.12g%c", stress[static_cast<std::size_t>(c * LACON_LANES)], c == 3 ? '\n' : ' ');
  return 0;
} catch (const lacon::Error& error) {
  std::fprintf(stderr, "<%c> <%s> %s\n", error.message().severity, error.message().id.c_str(), error.message().text.c_str());
  return 2;
}
