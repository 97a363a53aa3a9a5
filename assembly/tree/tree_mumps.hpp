#pragma once
// A factor that processes share: each factorises its subtrees down to what they leave to the top, by the sequential MUMPS, and
// the first one adds that up and factorises the top. The same bits in every run: all sums have their order.
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lacon/assembly/mumps.hpp"
#include "lacon/assembly/processes/companion.hpp"
#include "lacon/assembly/processes/shared_memory.hpp"
#include "lacon/assembly/tree/subtrees.hpp"

namespace lacon {

/// Processes of lacon_mumps, each with the pieces of a matrix that were given to it.
class MumpsProcesses {
 public:
  /// @param program lacon_mumps; empty: beside the program that runs
  MumpsProcesses(int n_processes, std::string program) : n_(n_processes), program_(std::move(program)) {}
  int size() const { return n_; }

  /// Where they do not run: not yet, or not any more. Throws SOLVER_8 where one cannot be started.
  void start();
  void forget() noexcept;
  struct Question {
    const char* verb;
    const char* phase;      ///< in words, where memory ends
    std::size_t equations;  ///< likewise
  };
  /// Ask about each piece, all before the first answer is waited for. @param process of each  @param rest of the line about it
  /// @param meanwhile what is done before answers are waited for; what it throws comes behind them
  /// @return the numbers of each answer  Throws SOLVER_2, SOLVER_8, std::runtime_error.
  std::vector<std::vector<double>> ask(const Question& question, std::span<const int> process,
                                       const std::function<std::string(std::size_t piece)>& rest,
                                       const std::function<void()>& meanwhile = {});

 private:
  int n_;
  std::string program_;
  std::vector<std::unique_ptr<Companion>> processes_;
};

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
  std::vector<std::vector<double>> ask(const char* verb, const char* phase, std::span<const SharedMemory> memory,
                                       const std::function<void()>& meanwhile = {}, std::span<const SharedMemory> more = {});
  void number(const MumpsPattern& pattern);
  /// What the processes are told of each piece.
  std::vector<SharedMemory> patterns() const;
  void number_top();
  /// Numbered and analysed, if it has not been yet.
  void analyse_top();
  /// Add the Schur complement of a piece.
  void add_to_top(const Piece& piece, std::span<const Real> schur, std::span<Real> values) const;
  /// The subtree that an entry of the matrix belongs to; -1: the top.
  std::int32_t subtree_of(std::size_t entry) const;
  /// Factorise pieces, and see that the top has its analysis, which takes the time of the largest of them anyway.
  /// @param[out] memory with the Schur complement of each  @return what was answered of each
  std::vector<std::vector<double>> factorise_pieces(std::span<const Real> values, std::vector<SharedMemory>& memory);
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
  std::span<const int> row_, column_;  ///< of it
  std::vector<Piece> pieces_;
  std::vector<std::int32_t> local_;  ///< of each equation: its number in its piece, or in the top
  std::vector<std::int32_t> top_;    ///< equations of the top
  TopPattern top_pattern_;
  std::unique_ptr<Mumps<Real>> top_factor_;  ///< where there is a top and its analysis
};

extern template class TreeMumps<double>;
extern template class TreeMumps<float>;

}  // namespace lacon
