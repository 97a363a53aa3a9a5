#pragma once
// A factor that processes share: each factorises its subtrees down to what they leave to the top, by the sequential MUMPS, and
// the first one adds that up and factorises the top. The same bits in every run: all sums have their order.
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lacon/assembly/mumps.hpp"
#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/assembly/tree/dense_factor.hpp"
#include "lacon/assembly/tree/exchange.hpp"
#include "lacon/assembly/tree/mumps_processes.hpp"
#include "lacon/assembly/tree/subtrees.hpp"

namespace lacon {

template <class Real>
class TreeMumps : public MumpsFactor<Real> {
 public:
  /// The processes must outlive this, and have no pieces of anything else meanwhile.
  TreeMumps(const MumpsSettings& settings, Subtrees subtrees, MumpsProcesses& processes);
  /// The processes forget their pieces.
  ~TreeMumps() override;
  TreeMumps(const TreeMumps&) = delete;
  TreeMumps& operator=(const TreeMumps&) = delete;

  MumpsForecast analyse(const MumpsPattern& pattern) override;
  Factorisation factorise(std::span<const Real> values) override;
  /// The same of a symmetric matrix of which the processes have entries (SparseMatrix::elsewhere), scaled from both sides.
  Factorisation factorise(const SparseMatrix& here, std::span<const double> scale);
  void substitute(std::span<Real> right_side) override;
  void substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index, std::span<const Real> value,
                  std::span<Real> solution) override;

 private:
  /// A subtree with its equations, and behind them its border: those of the top that they meet.
  struct Piece {
    std::vector<std::int32_t> own, border;  ///< equations of the matrix; numbers in the top
    std::int64_t n_entries = 0;
    std::size_t size() const { return own.size() + border.size(); }
  };
  /// The places of the top's entries by columns, where symmetric of the lower triangle: what MUMPS sees of it.
  struct TopPattern {
    std::vector<std::int64_t> offset{0};  ///< of each column
    std::vector<int> row, column, place;  ///< from 1
    std::vector<std::int64_t> own;        ///< places of the matrix's own entries, in their order
    std::int64_t entry(std::int32_t i, std::int32_t j) const {
      return std::lower_bound(row.begin() + offset[j], row.begin() + offset[j + 1], i + 1) - row.begin();
    }
  };
  /// Values of each piece, with room for its Schur complement, and of the top's own entries.
  struct Values {
    std::vector<SharedMemory> pieces;
    std::vector<Real> top;
  };
  std::vector<std::vector<double>> ask(const char* verb, const char* phase, std::span<const SharedMemory> memory,
                                       const std::function<void()>& meanwhile = {}, std::span<const SharedMemory> more = {},
                                       const std::function<void(std::size_t piece)>& answered = {});
  void number(const MumpsPattern& pattern);
  /// What the processes are told of each piece.
  void make_patterns();
  PieceMemory pattern_of(std::size_t piece) const { return PieceMemory::in(patterns_[piece]); }
  /// Call use(entry, row, column) for the pattern's entries in their order.
  template <class Use>
  void for_each_entry(const Use& use) const;
  /// The same of pieces, use(entry, piece, row, column) in their numbers, columns of a row ascending.
  template <class Use>
  void for_each_of_pieces(const Use& use) const;
  /// Of each piece: its number of an equation of the top, from 0.
  std::vector<std::vector<int>> borders() const;
  void number_top();
  /// Whether Schur complements fill it and no pivots are looked for in it. Half of its entries will do: as a sparse one it
  /// would be analysed entry by entry, and eliminated by one thread.
  bool has_full_top() const {
    constexpr std::size_t most = 8192;  // low-rank blocks are less work for larger ones
    std::size_t entries = 0;            // that Schur complements add to
    for (const Piece& piece : pieces_) entries += piece.border.size() * piece.border.size();
    return settings_.symmetric && settings_.as_ordered && top_.size() <= most && 2 * entries >= top_.size() * top_.size();
  }
  /// Numbered and analysed, if it has not been yet.
  void analyse_top();
  /// Of what is left of the matrix there.
  Factorisation factorise_top(Values& values);
  /// With the matrix's own entries.
  void make_full_top(const Values& values);
  Factorisation factorise_full_top();
  /// The Schur complement of a piece, by rows, the lower triangle alone where symmetric.
  std::span<const Real> schur_of(std::size_t piece, const Values& values) const {
    const std::size_t n = pieces_[piece].border.size(), first = values.pieces[piece].size() / sizeof(Real) - n * n;
    return {reinterpret_cast<const Real*>(values.pieces[piece].data()) + first, n * n};
  }
  /// Add the Schur complement of a piece.
  void add_to_top(const Piece& piece, std::span<const Real> schur, std::span<Real> values) const;
  /// The subtree that an entry belongs to; -1: the top.
  std::int32_t subtree_of(std::int32_t i, std::int32_t j) const { return std::max(subtrees_.of[i], subtrees_.of[j]); }
  using Fill = std::function<void(Values&)>;
  Factorisation factorise_filled(const Fill& fill);
  /// From the pattern's entries in their order.
  void fill_in_order(std::span<const Real> entries, Values& values) const;
  /// From what the processes have, and from what is here.
  void fill_from_all(const SparseMatrix& here, std::span<const double> scale, Values& values);
  /// Factorise pieces, and add those that are done to a full top; another one gets its analysis meanwhile.
  /// @param[out] values with the Schur complement of each  @return what was answered of each
  std::vector<std::vector<double>> factorise_pieces(const Fill& fill, Values& values);
  /// Equations whose pivots pieces cannot take. @return whether there are any
  bool leave_to_top(const std::vector<std::vector<double>>& found);
  /// Sparse right sides by pieces; those of the top go to `top`, (count, top). Each piece has an entry at least.
  std::vector<SharedMemory> shared_out(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                                       std::span<const Real> value, std::span<Real> top) const;
  /// Memory for the right sides of each piece and their borders.
  std::vector<SharedMemory> memory_of_sides(std::size_t count) const;
  /// From what pieces have left to their borders on. @param top right sides there, (count, top)
  void substitute_behind(std::vector<SharedMemory>& memory, std::span<Real> top, std::span<Real> solution);

  MumpsSettings settings_;
  Subtrees subtrees_;
  MumpsProcesses& processes_;
  MumpsPattern pattern_;
  std::vector<Piece> pieces_;
  std::vector<SharedMemory> patterns_;  ///< PieceMemory of each
  std::vector<std::int32_t> local_;     ///< of each equation: its number in its piece, or in the top
  std::vector<std::int32_t> top_;       ///< equations of the top
  TopPattern top_pattern_;
  std::unique_ptr<Mumps<Real>> top_factor_;  ///< where there is a top and its analysis
  std::unique_ptr<DenseFactor<Real>> full_top_;
};

extern template class TreeMumps<double>;
extern template class TreeMumps<float>;

}  // namespace lacon
