#include "lacon/operators/modi_maillage/modi_maillage.hpp"

#include <fmt/core.h>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/operators/meshing/orientation.hpp"
#include "lacon/operators/modi_maillage/transform.hpp"

namespace lacon {

void modi_maillage(Mesh& mesh, const Keywords& keywords) {
  if (transform(mesh, keywords)) return;
  for (const Keywords& factor : keywords.factors("ORIE_PEAU")) {
    std::vector<std::int32_t> inside;
    for (const std::string& group : factor.texts("GROUP_MA_INTERNE")) {
      const auto members = cells_of_group(mesh, group, factor.path("GROUP_MA_INTERNE"));
      inside.insert(inside.end(), members.begin(), members.end());
    }
    for (const std::string& group : factor.texts("GROUP_MA_PEAU")) {
      const OrientationReport report = orient_skin(mesh, group, inside, factor.path("GROUP_MA_PEAU"));
      fmt::print("  ORIE_PEAU {:<24} {:>8} {}\n", group, report.turned, part("cells_turned"));
      if (!report.without_body.empty())
        inform("ORIE_4", {{"count", std::to_string(report.without_body.size())},
                          {"group", group},
                          {"cell", cell_name(report.without_body[0])}});
    }
  }
}

}  // namespace lacon
