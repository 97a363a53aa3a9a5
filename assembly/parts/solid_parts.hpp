#pragma once
// Solid elements whose cells processes have: each evaluates its own, keeps their states and its rows of the matrix
// (element_part.hpp). The operator sees vectors of nodal values, in memory that all of them see.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lacon/assembly/block_numbering.hpp"
#include "lacon/assembly/element_sets.hpp"
#include "lacon/assembly/parts/board.hpp"
#include "lacon/assembly/parts/kept_points.hpp"
#include "lacon/assembly/parts/part_cells.hpp"
#include "lacon/assembly/parts/part_processes.hpp"
#include "lacon/assembly/parts/partition.hpp"
#include "lacon/assembly/sparse_matrix.hpp"

namespace lacon {

/// What cells are handed out of.
struct PartSource {
  const Mesh& mesh;
  std::span<const ElementSet> sets;  ///< of elements that know displacements alone
  const Numbering& numbering;
  const Partition& partition;  ///< of the cells of all sets, one set behind the other
  const BlockNumbering& blocks;
};
/// What a process gets: its cells, and those of others that meet its nodes; without unknowns and plug-ins.
PartCells cells_of_part(const PartSource& source, int part);

/// Calls throw SOLVER_8 where the processes have ended.
class SolidParts : public RowsElsewhere, public std::enable_shared_from_this<SolidParts> {
 public:
  /// Hand the cells out. @param sets of elements that know displacements alone, and meet them as `unknowns` says
  /// @param plugins folders of the registry  Mesh, sets and numbering must outlive it. Throws SOLVER_6.
  SolidParts(std::shared_ptr<PartProcesses> processes, const Mesh& mesh, std::span<const ElementSet> sets,
             const Numbering& numbering, std::span<const std::string> unknowns, std::span<const std::filesystem::path> plugins);

  /// Where laws start from.
  struct Start {
    std::span<const double> displacement;
    const KeptPoints* points = nullptr;  ///< nothing: the natural state
  };
  /// Evaluate all elements; the matrix is that of the last evaluation that wanted one. @return the first cell that is turned
  /// inside out  Throws ELEMENT_1.
  std::optional<std::int32_t> evaluate(std::span<const double> displacement, SolidMatrix wanted, const Start& previous,
                                       const Start& origin);
  /// Of the last evaluation, (n_nodes, dimension), until anything else is asked for.
  std::span<const double> force() const { return board_.force; }

  KeptState keep() const;  ///< that of the last evaluation
  KeptState natural() const;
  KeptState at_rest(const KeptPoints& state) const;
  /// Hand a state out. @param points of each set
  KeptState put(std::span<const PointValues> points) const;
  /// A state with what temperatures do at another instant. @param points of each set, of which thermal strains and parameters
  /// are taken
  KeptState heated(const KeptPoints& state, std::span<const PointValues> points) const;
  /// What temperatures and initial strains do, from the next evaluation on. @param points of each set
  void strain(std::span<const PointValues> points);
  void strain_as(const KeptPoints& state);
  /// Whether a law flows in the last evaluation.
  bool flows(const KeptPoints& since) const;
  /// Of some cells of each set. @param number -1: that of the last evaluation
  std::vector<std::vector<double>> values(std::int64_t number, PointQuantity quantity, std::span<const CellRange> cells) const;

  std::int64_t version() const override { return version_; }
  std::span<const double> product(std::span<const double> x, bool magnitudes) const override;
  void products(int n_columns, const std::function<void(std::span<double>)>& fill,
                const std::function<void(std::span<const double>)>& use) const override;
  Sizes row_sizes() const override;
  std::span<const double> diagonal() const override;
  std::span<const double> row_maxima(std::span<const double> d) const override;
  void remember() const override;
  double change() const override;
  Ragged<std::int32_t> graph(const SparseMatrix& here) const override;
  SparseMatrix whole(const SparseMatrix& here) const override;

  const BlockNumbering& blocks() const { return blocks_; }
  std::size_t n_sets() const { return sets_.size(); }
  std::int64_t n_cells() const { return n_cells_; }
  std::int64_t n_shared() const { return n_shared_; }  ///< evaluations of cells beside those

 private:
  friend KeptPoints;
  void ask(const std::string& line) const;
  /// Put what the points of each set hold of a quantity into a state of the processes. @param holdings of that state
  void put(std::int64_t number, std::span<const PointValues> points, const PointQuantityRow& quantity,
           Holdings& holdings) const;
  /// "put" or "collect" values of some cells of each set, one set behind the other.
  void exchange(const char* verb, std::int64_t number, PointQuantity quantity, std::span<const CellRange> cells,
                const SharedMemory& memory) const;
  /// Ask for a state that is kept. @param more behind its number
  std::int64_t kept(const std::string& verb, const std::string& more = {}) const;
  KeptState shared(std::int64_t number, Holdings holdings) const;
  Holdings natural_holdings() const;

  std::shared_ptr<PartProcesses> processes_;
  const Mesh& mesh_;
  std::span<const ElementSet> sets_;
  const Numbering& numbering_;
  Partition partition_;  ///< cells of all sets, one set behind the other
  BlockNumbering blocks_;
  std::optional<SharedMemory> memory_;
  Board board_;
  Holdings holdings_;  ///< of the present state
  std::int64_t n_cells_ = 0, n_shared_ = 0;
  std::int64_t version_ = 0;                   ///< of the matrix
  mutable std::int64_t last_ = 0;              ///< number of a kept state
  mutable std::vector<std::int64_t> dropped_;  ///< that nobody needs any more
};

}  // namespace lacon
