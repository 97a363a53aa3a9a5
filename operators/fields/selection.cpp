#include "lacon/operators/fields/selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

/// The order whose instant is `instant`. A relative precision of an instant 0 means exactly 0, as with the peer.
/// @param lenient an instant that is not there is nothing, with an alarm
std::optional<std::int64_t> order_at(const Result& result, double instant, double tolerance, const std::string& keyword,
                                     bool lenient) {
  std::vector<std::int64_t> found;
  for (std::size_t k = 0; k < result.orders.size(); ++k)
    if (std::abs(result.instants[k] - instant) <= tolerance) found.push_back(result.orders[k]);
  if (found.empty()) {
    const Message missing =
        message(lenient ? "FIELDS_5" : "FIELDS_2", {{"keyword", keyword},
                                                    {"label", result.label},
                                                    {"instant", fmt::format("{}", instant)},
                                                    {"known", fmt::format("{}", fmt::join(result.instants, ", "))}});
    if (!lenient) throw Error(missing);
    inform(missing);
    return std::nullopt;
  }
  if (found.size() > 1)
    fail("FIELDS_3", {{"keyword", keyword},
                      {"label", result.label},
                      {"instant", fmt::format("{}", instant)},
                      {"orders", fmt::format("{}", fmt::join(found, ", "))}});
  return found.front();
}

}  // namespace

bool names_instants(const Keywords& keywords) {
  return keywords.has("NUME_ORDRE") || keywords.has("INST") || keywords.has("LIST_INST");
}

std::vector<std::int64_t> selected_orders(const Base& base, const Result& result, const Keywords& keywords) {
  if (!names_instants(keywords)) return result.orders;
  std::vector<std::int64_t> orders;
  if (keywords.has("NUME_ORDRE")) {
    orders = keywords.integers("NUME_ORDRE");
    for (const std::int64_t order : orders)
      if (std::find(result.orders.begin(), result.orders.end(), order) == result.orders.end())
        fail("FIELDS_1", {{"keyword", keywords.path("NUME_ORDRE")},
                          {"label", result.label},
                          {"order", std::to_string(order)},
                          {"known", fmt::format("{}", fmt::join(result.orders, ", "))}});
  } else {
    const bool list = keywords.has("LIST_INST");
    const std::vector<double> instants = list ? base.list_of_reals(keywords.concept_id("LIST_INST")) : keywords.reals("INST");
    const double precision = keywords.real("PRECISION");
    const bool relative = keywords.text("CRITERE") == "RELATIF";
    const auto find = [&](double instant, bool lenient) {
      return order_at(result, instant, relative ? precision * std::abs(instant) : precision,
                      keywords.path(list ? "LIST_INST" : "INST"), lenient);
    };
    for (const double instant : instants)
      if (const auto order = find(instant, list)) orders.push_back(*order);
    if (orders.empty()) find(instants.front(), false);
  }
  std::sort(orders.begin(), orders.end());
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
  return orders;
}

Result part_of(const Result& result, const std::vector<std::int64_t>& orders) {
  Result part = result;
  part.fields.clear();
  part.orders.clear();
  part.instants.clear();
  for (auto& [name, values] : part.parameters) values.clear();
  for (std::size_t k = 0; k < result.orders.size(); ++k) {
    if (std::find(orders.begin(), orders.end(), result.orders[k]) == orders.end()) continue;
    part.orders.push_back(result.orders[k]);
    part.instants.push_back(result.instants[k]);
    for (auto& [name, values] : part.parameters) values.push_back(result.parameters.at(name)[k]);
  }
  while (part.stages.size() > 1 && (part.orders.empty() || part.stages.back().first > part.orders.back()))
    part.stages.pop_back();
  return part;
}

std::vector<char> selected_cells(const Mesh& mesh, const Keywords& keywords) {
  if (!keywords.has("GROUP_MA")) return std::vector<char>(mesh.n_cells(), 1);
  std::vector<char> wanted(mesh.n_cells(), 0);
  for (const std::string& group : keywords.texts("GROUP_MA"))
    for (const std::int32_t cell : cells_of_group(mesh, group, keywords.path("GROUP_MA")))
      wanted[static_cast<std::size_t>(cell)] = 1;
  return wanted;
}

std::vector<std::int32_t> selected_skin(const Mesh& mesh, const Keywords& keywords) {
  const std::vector<char> wanted = selected_cells(mesh, keywords);
  std::vector<std::int32_t> cells;
  for (std::size_t c = 0; c < wanted.size(); ++c) {
    if (!wanted[c]) continue;
    if (mesh.row(c).dimension != mesh.dimension - 1)
      fail("CALCPRES_1", {{"keyword", keywords.path("GROUP_MA")},
                          {"cell", cell_name(static_cast<std::int64_t>(c))},
                          {"type", std::string(mesh.row(c).name)},
                          {"groups", fmt::format("{}", fmt::join(keywords.texts("GROUP_MA"), ", "))}});
    cells.push_back(static_cast<std::int32_t>(c));
  }
  return cells;
}

std::vector<char> nodes_of_marked_cells(const Mesh& mesh, const std::vector<char>& cells) {
  std::vector<char> marked(mesh.n_nodes(), 0);
  for (std::size_t c = 0; c < mesh.n_cells(); ++c)
    if (cells[c])
      for (const std::int32_t node : mesh.cells[c]) marked[static_cast<std::size_t>(node)] = 1;
  return marked;
}

std::vector<char> selected_places(const Mesh& mesh, const Keywords& keywords, Location location, const std::string& name) {
  const bool nodal = location == Location::nodes;
  if (keywords.has("GROUP_NO") && !nodal) fail("CREACHAMP_7", {{"keyword", keywords.path("GROUP_NO")}, {"type", name}});
  const std::vector<char> cells = selected_cells(mesh, keywords);
  if (!nodal) return cells;
  std::vector<char> nodes(mesh.n_nodes(), keywords.has("TOUT") || (!keywords.has("GROUP_MA") && !keywords.has("GROUP_NO")));
  if (keywords.has("GROUP_MA")) nodes = nodes_of_marked_cells(mesh, cells);
  for (const std::string& group : keywords.texts("GROUP_NO"))
    for (const std::int32_t node : nodes_of_group(mesh, group, keywords.path("GROUP_NO")))
      nodes[static_cast<std::size_t>(node)] = 1;
  return nodes;
}

}  // namespace lacon
