#include <fmt/format.h>

#include <map>
#include <set>
#include <sstream>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/formats/file_names.hpp"
#include "lacon/structures/formats/gmsh.hpp"

namespace lacon {
namespace {

/// Groups of each cell, by the numbers that gmsh gets for them (from 1).
std::vector<std::vector<std::size_t>> groups_of_cells(const Mesh& mesh) {
  std::vector<std::vector<std::size_t>> groups(mesh.n_cells());
  for (std::size_t g = 0; g < mesh.cell_groups.size(); ++g)
    for (const std::int32_t cell : mesh.cell_groups[g].members) groups[static_cast<std::size_t>(cell)].push_back(g + 1);
  return groups;
}

/// A view: of what section, its name, and rows of values by entity, (components of gmsh: 1 or 3).
void append_view(std::string& text, const char* section, const std::string& name, const Field& field, int width,
                 const std::vector<std::string>& rows) {
  if (rows.empty()) return;
  text +=
      fmt::format("${}\n1\n\"{}\"\n1\n{:.16g}\n3\n{}\n{}\n{}\n", section, name, field.instant, field.order, width, rows.size());
  for (const std::string& row : rows) text += row + '\n';
  text += fmt::format("$End{}\n", section);
}

/// The nodes of a cell, or values at them, in gmsh's order.
template <class T>
std::vector<T> in_gmsh_order(const catalog::CellRow& row, const std::vector<T>& own) {
  std::vector<T> sorted(own.size());
  for (std::size_t j = 0; j < own.size(); ++j) sorted[static_cast<std::size_t>(row.gmsh_permutation[j])] = own[j];
  return sorted;
}

/// What numbers in a text of version 2 mean, of a mesh with so many cells: the section of nodes, types and nodes of cells.
std::string numbering(const std::string& text, std::size_t n_cells) {
  std::istringstream lines(text);
  std::string found, line;
  std::set<std::string> cells;
  const auto find = [&](const char* section) {
    while (std::getline(lines, line))
      if (line == section) return;
  };
  find("$Nodes");
  while (std::getline(lines, line) && line != "$EndNodes") found += line + '\n';
  find("$Elements");
  std::getline(lines, line);  // how many lines
  while (std::getline(lines, line) && line != "$EndElements") {
    std::istringstream words(line);
    std::size_t number = 0, type = 0, n_tags = 0;
    std::string tag, nodes;
    words >> number >> type >> n_tags;
    for (std::size_t k = 0; k < n_tags; ++k) words >> tag;
    std::getline(words, nodes);
    const std::string cell = fmt::format("{}{}\n", type, nodes);
    if (number > n_cells && cells.contains(cell)) continue;  // once more, for another group
    cells.insert(cell);
    found += fmt::format("{} {}", number, cell);
  }
  return found;
}

}  // namespace

bool is_gmsh_text_of(const std::string& text, const Mesh& mesh) {
  return numbering(text, mesh.n_cells()) == numbering(gmsh_mesh_text(mesh), mesh.n_cells());
}

std::string gmsh_view_name(std::string& text, const std::string& name, const std::string& owner,
                           const std::filesystem::path& file) {
  const auto line_of = [](const std::string& candidate) { return "$Comments\nviews \"" + candidate + "\" of "; };
  const std::string chosen = free_name(name, [&](const std::string& candidate) {
    const std::string line = line_of(candidate);
    return text.find(line) == std::string::npos || text.find(line + owner + '\n') != std::string::npos;
  });
  const std::string own = line_of(chosen) + owner + '\n';
  if (text.find(own) != std::string::npos) return chosen;
  text += own + "$EndComments\n";
  if (chosen != name) inform("FORMAT_2", {{"file", file.string()}, {"name", name}, {"own", chosen}});
  return chosen;
}

std::string gmsh_mesh_text(const Mesh& mesh) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  std::map<std::pair<int, std::size_t>, std::string> names;  // by dimension and number
  for (std::size_t g = 0; g < mesh.cell_groups.size(); ++g)
    for (const std::int32_t cell : mesh.cell_groups[g].members)
      names[{mesh.row(static_cast<std::size_t>(cell)).dimension, g + 1}] = mesh.cell_groups[g].name;
  if (!names.empty()) {
    text += fmt::format("$PhysicalNames\n{}\n", names.size());
    for (const auto& [key, name] : names) text += fmt::format("{} {} \"{}\"\n", key.first, key.second, name);
    text += "$EndPhysicalNames\n";
  }
  text += fmt::format("$Nodes\n{}\n", mesh.n_nodes());
  for (std::size_t n = 0; n < mesh.n_nodes(); ++n) {
    const auto x = mesh.point(n);
    text += fmt::format("{} {:.17g} {:.17g} {:.17g}\n", n + 1, x[0], x[1], x[2]);
  }
  // a cell once for each of its groups, as version 2 has it: first all cells by number, so that fields find them, then again
  const std::vector<std::vector<std::size_t>> groups = groups_of_cells(mesh);
  std::string again;
  std::size_t tag = mesh.n_cells();
  std::string cells;
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const catalog::CellRow& row = mesh.row(c);
    const auto own = mesh.cells[c];
    std::string nodes;
    for (const std::int32_t n : in_gmsh_order(row, std::vector<std::int32_t>(own.begin(), own.end())))
      nodes += fmt::format(" {}", n + 1);
    const std::size_t first = groups[c].empty() ? 0 : groups[c][0];
    cells += fmt::format("{} {} 2 {} {}{}\n", c + 1, row.gmsh_type, first, first, nodes);
    for (std::size_t k = 1; k < groups[c].size(); ++k)
      again += fmt::format("{} {} 2 {} {}{}\n", ++tag, row.gmsh_type, groups[c][k], groups[c][k], nodes);
  }
  return text + fmt::format("$EndNodes\n$Elements\n{}\n", tag) + cells + again + "$EndElements\n";
}

std::string gmsh_field_text(const Mesh& mesh, const Field& field, const std::string& name) {
  std::string text;
  const bool on_nodes = field.location == Location::nodes, at_nodes = field.location == Location::cell_nodes;
  const char* const section = on_nodes ? "NodeData" : at_nodes ? "ElementNodeData" : "ElementData";
  const int x = field.component("DX"), y = field.component("DY"), z = field.component("DZ");
  std::vector<std::vector<int>> views;  // components of each; -1: zero
  if (x >= 0 && y >= 0) views.push_back({x, y, z});
  for (int k = 0; k < static_cast<int>(field.n_components()); ++k)
    if (x < 0 || y < 0 || (k != x && k != y && k != z)) views.push_back({k});
  for (const std::vector<int>& view : views) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      const std::size_t first = field.first_row(i), end = field.first_row(i + 1);
      if (first == end || !field.has(first, static_cast<std::size_t>(view[0]))) continue;
      std::vector<std::string> values;  // of each row of the entity
      for (std::size_t row = first; row < end; ++row) {
        std::string one;
        for (const int k : view) one += fmt::format(" {:.17g}", k < 0 ? 0.0 : field.at(row, static_cast<std::size_t>(k)));
        values.push_back(one);
      }
      std::string line = fmt::format("{}", field.support[i] + 1);
      if (at_nodes) {
        line += fmt::format(" {}", values.size());
        for (const std::string& one : in_gmsh_order(mesh.row(static_cast<std::size_t>(field.support[i])), values)) line += one;
      } else if (field.location == Location::gauss_points) {
        for (const int k : view) {
          double sum = 0;
          for (std::size_t row = first; k >= 0 && row < end; ++row) sum += field.at(row, static_cast<std::size_t>(k));
          line += fmt::format(" {:.17g}", sum / static_cast<double>(end - first));
        }
      } else {
        line += values[0];
      }
      rows.push_back(line);
    }
    const std::string own = view.size() > 1 ? name : name + "_" + field.components[static_cast<std::size_t>(view[0])];
    append_view(text, section, own + (field.location == Location::gauss_points ? "_MEAN" : ""), field,
                static_cast<int>(view.size()), rows);
  }
  return text;
}

}  // namespace lacon
