#include "lacon/operators/meshing/body.hpp"

#include <algorithm>
#include <ranges>

#include "lacon/catalog/messages.hpp"
#include "lacon/structures/known_size.hpp"

namespace lacon {

namespace {

/// The cells around each node of a row. @param row_of the row of a node, -1 for none @param candidates the cells that count
template <class RowOf, class Candidates>
Ragged<std::int32_t> cells_by_row(const Mesh& mesh, std::size_t n_rows, const RowOf& row_of, const Candidates& candidates) {
  Ragged<std::int32_t> cells;
  cells.offset.assign(n_rows + 1, 0);
  const auto each = [&](const auto& visit) {
    for (const std::size_t c : candidates)
      for (const std::int32_t node : mesh.cells[c])
        if (const std::int32_t row = row_of(node); row >= 0) visit(c, static_cast<std::size_t>(row));
  };
  each([&](std::size_t, std::size_t row) { ++cells.offset[row + 1]; });
  for (std::size_t n = 0; n < n_rows; ++n) cells.offset[n + 1] += cells.offset[n];
  cells.values.resize(static_cast<std::size_t>(cells.offset.back()));
  std::vector<std::int64_t> next(cells.offset.begin(), cells.offset.end() - 1);
  each([&](std::size_t c, std::size_t row) {
    cells.values[static_cast<std::size_t>(next[row]++)] = static_cast<std::int32_t>(c);
  });
  return cells;
}

}  // namespace

NodeSet::NodeSet(std::size_t n_nodes, std::span<const std::int32_t> nodes) : bits_(n_nodes / 64 + 1) {
  for (const std::int32_t node : nodes) bits_[word(node)] |= std::uint64_t{1} << bit(node);
  for (const std::uint64_t bits : bits_) {
    before_.push_back(static_cast<std::int32_t>(size_));
    size_ += static_cast<std::size_t>(std::popcount(bits));
  }
}

NodeCells::NodeCells(const Mesh& mesh)
    : cells_(cells_by_row(
          mesh, mesh.n_nodes(), [](std::int32_t node) { return node; }, std::views::iota(std::size_t{0}, mesh.n_cells()))) {}

NodeCells::NodeCells(const Mesh& mesh, std::span<const std::int32_t> nodes, int dimension)
    : nodes_(std::in_place, mesh.n_nodes(), nodes) {
  std::vector<std::size_t> candidates;
  for_each_run(mesh, [&](const catalog::CellRow& row, std::size_t first, std::size_t n_cells) {
    if (row.dimension != dimension) return;
    with_known_size(static_cast<std::size_t>(row.n_nodes), [&, own = mesh.cells[first].data()](const auto n) {
      for (std::size_t c = 0; c < n_cells; ++c) {
        bool near = false;
        for (std::size_t j = 0; j < n; ++j) near |= nodes_->has(own[c * n + j]);
        if (near) candidates.push_back(first + c);
      }
    });
  });
  cells_ = cells_by_row(
      mesh, nodes_->size(), [&](std::int32_t node) { return nodes_->rank(node); }, candidates);
}

std::span<const std::int32_t> NodeCells::operator[](std::size_t node) const {
  if (!nodes_) return cells_[node];
  const std::int32_t row = nodes_->rank(static_cast<std::int32_t>(node));
  return row < 0 ? std::span<const std::int32_t>{} : cells_[static_cast<std::size_t>(row)];
}

std::optional<FacetMatch> match_facet(CellType type, std::span<const std::int32_t> body, CellType skin_type,
                                      std::span<const std::int32_t> skin) {
  const catalog::CellRow& row = catalog::cell(type);
  const auto n = static_cast<std::size_t>(catalog::cell(skin_type).n_vertices);
  const auto vertex = [&](const catalog::FacetRow& facet, std::size_t i) {
    return body[static_cast<std::size_t>(facet.nodes[i])];
  };
  for (std::size_t f = 0; f < row.facets.size(); ++f) {
    const catalog::FacetRow& facet = row.facets[f];
    if (static_cast<std::size_t>(catalog::cell(facet.type).n_vertices) != n) continue;
    for (std::size_t start = 0; start < n; ++start) {
      if (vertex(facet, 0) != skin[start]) continue;
      const auto runs = [&](std::size_t step) {
        for (std::size_t i = 0; i < n; ++i)
          if (vertex(facet, i) != skin[(start + i * step) % n]) return false;
        return true;
      };
      const bool outward = runs(1) && (n != 2 || start == 0);  // an edge seen from outside starts at its first vertex
      if (outward || runs(n - 1)) return FacetMatch{static_cast<int>(f), static_cast<int>(start), outward};
    }
  }
  return std::nullopt;
}

std::vector<BodyCell> body_cells(const Mesh& mesh, const NodeCells& around, std::size_t skin_cell) {
  std::vector<BodyCell> found;
  const auto skin = mesh.cells[skin_cell];
  for (const std::int32_t candidate : around[static_cast<std::size_t>(skin[0])]) {
    const auto c = static_cast<std::size_t>(candidate);
    if (mesh.row(c).dimension != mesh.row(skin_cell).dimension + 1) continue;
    if (const auto match = match_facet(mesh.types[c], mesh.cells[c], mesh.types[skin_cell], skin))
      found.push_back({candidate, *match});
  }
  return found;
}

std::vector<std::int32_t> mirrored(CellType type, std::span<const std::int32_t> nodes) {
  std::vector<std::int32_t> turned;
  for (const std::int8_t n : catalog::cell(type).mirror) turned.push_back(nodes[static_cast<std::size_t>(n)]);
  return turned;
}

void refuse_inner(std::span<const BodyCell> bodies, std::int32_t skin_cell, const std::string& keyword,
                  const std::string& group) {
  if (bodies.size() > 1)
    fail("DECOUPE_3", {{"keyword", keyword},
                       {"group", group},
                       {"cell", cell_name(skin_cell)},
                       {"first", cell_name(bodies[0].cell)},
                       {"second", cell_name(bodies[1].cell)}});
}

void refuse_cut_mesh(const Mesh& mesh, std::string_view what, std::string_view label) {
  if (mesh.patches) fail("MESH1_12", {{"what", std::string(what)}, {"mesh", label.empty() ? mesh.name : std::string(label)}});
}

}  // namespace lacon
