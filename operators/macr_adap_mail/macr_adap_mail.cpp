#include "lacon/operators/macr_adap_mail/macr_adap_mail.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/meshing/refine.hpp"

namespace lacon {

Mesh macr_adap_mail(const Mesh& mesh, const Keywords& keywords) {
  if (keywords.text("ADAPTATION") != "RAFFINEMENT_UNIFORME")
    fail("KEYWORD_18", {{"keyword", "ADAPTATION"}, {"expected", "RAFFINEMENT_UNIFORME"}});
  RefinementReport report;
  Mesh made = refine(mesh, keywords.texts("GROUP_MA"), keywords.path("GROUP_MA"), report);
  fmt::print("  refined {:>8} cells, {} of them facets and edges of the others\n", report.refined, report.attached);
  fmt::print("  nodes {:>8} -> {:>8}\n  cells {:>8} -> {:>8}\n", mesh.n_nodes(), made.n_nodes(), mesh.n_cells(),
             made.n_cells());
  if (!report.node_groups.empty())
    inform("RAFFINE_3", {{"groups", fmt::format("'{}'", fmt::join(report.node_groups, "', '"))}});
  return made;
}

}  // namespace lacon
