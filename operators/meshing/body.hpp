#pragma once
// Which body cell a skin cell belongs to, and from which side it is seen.
#include <bit>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lacon/structures/mesh.hpp"

namespace lacon {

/// Some of the nodes of a mesh, as bits: of a large mesh they stay in the processor's cache.
class NodeSet {
 public:
  NodeSet(std::size_t n_nodes, std::span<const std::int32_t> nodes);
  bool has(std::int32_t node) const { return (bits_[word(node)] >> bit(node) & 1) != 0; }
  /// How many of the set have a lower number; -1 for a node that is not in it.
  std::int32_t rank(std::int32_t node) const {
    const std::uint64_t lower = bits_[word(node)] & ((std::uint64_t{1} << bit(node)) - 1);
    return has(node) ? before_[word(node)] + std::popcount(lower) : -1;
  }
  std::size_t size() const { return size_; }

 private:
  static std::size_t word(std::int32_t node) { return static_cast<std::uint32_t>(node) / 64; }
  static std::uint32_t bit(std::int32_t node) { return static_cast<std::uint32_t>(node) % 64; }

  std::vector<std::uint64_t> bits_;
  std::vector<std::int32_t> before_;  ///< how many are in the words before each
  std::size_t size_ = 0;
};

/// The cells around each node.
class NodeCells {
 public:
  explicit NodeCells(const Mesh& mesh);
  /// The cells of one dimension around these nodes; other nodes have none.
  NodeCells(const Mesh& mesh, std::span<const std::int32_t> nodes, int dimension);
  std::span<const std::int32_t> operator[](std::size_t node) const;

 private:
  std::optional<NodeSet> nodes_;  ///< whose ranks are the rows of `cells_`; nothing: every node's number is its row
  Ragged<std::int32_t> cells_;
};

/// How a skin cell lies on a facet of a body cell.
struct FacetMatch {
  int facet;     ///< index into CellRow::facets
  int start;     ///< the facet's first vertex, seen from outside, is this vertex of the skin cell
  bool outward;  ///< the skin cell runs as the facet does (of a body cell of positive volume: its normal leaves the body)
};

/// The facet of the cell `type` with nodes `body` that has the vertices of the skin cell, or nothing. Only vertices count: the
/// types of facet and skin may differ.
std::optional<FacetMatch> match_facet(CellType type, std::span<const std::int32_t> body, CellType skin_type,
                                      std::span<const std::int32_t> skin);

struct BodyCell {
  std::int32_t cell;
  FacetMatch match;
};

/// Every cell of one dimension more that has the skin cell as a facet, by number.
std::vector<BodyCell> body_cells(const Mesh& mesh, const NodeCells& around, std::size_t skin_cell);

/// Refuse a skin cell between two body cells: DECOUPE_3. @param bodies those that have it as a facet
void refuse_inner(std::span<const BodyCell> bodies, std::int32_t skin_cell, const std::string& keyword,
                  const std::string& group);

/// The nodes of a cell in the order of the same cell turned inside out.
std::vector<std::int32_t> mirrored(CellType type, std::span<const std::int32_t> nodes);

/// Refuse a change of cells on a mesh that is cut for LAC: MESH1_12. @param what the keyword, for the message
/// @param label the variable of the study that holds the mesh; none: the mesh's own name
void refuse_cut_mesh(const Mesh& mesh, std::string_view what, std::string_view label = {});

}  // namespace lacon
