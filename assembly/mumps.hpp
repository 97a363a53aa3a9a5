#pragma once
// One instance of MUMPS, in double or in single precision: its calls in C++, without a choice of its own. Behind the engine
// (mumps_engine.cpp), where processes share a factor in each of them (tree/).
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "lacon/assembly/engine.hpp"

namespace lacon {

struct MumpsSettings {
  bool symmetric = true;
  int memory_margin = 20;     ///< percent
  double singular_pivot = 0;  ///< a pivot below this fraction of the scaled matrix is null; negative: below its magnitude
  bool scaled = false;        ///< the matrix is scaled already
  double low_rank = 0;        ///< blocks are compressed to this fraction of the matrix; 0: they stay whole
  bool as_ordered = false;    ///< of a symmetric matrix: pivots are taken as they come, none is looked for
  bool out_of_core = false;   ///< the factor is in files
  std::string folder;         ///< of these files
};

/// The places of entries and their order of elimination, numbered from 1. They must stay where they are; those of entries are
/// read again by each factorisation.
struct MumpsPattern {
  std::span<int> row, column;
  std::span<int> place;                ///< of each equation
  std::span<int> block;                ///< the first equation of each block whose equations have one pattern, and behind them
  std::span<int> border;               ///< equations, the last ones in this order, that are left: those of the Schur complement
  const VertexGraph* graph = nullptr;  ///< where entries are not listed: those behind it
};

/// What the analysis foresees.
struct MumpsForecast {
  double flops = 0;
  double entries = 0;  ///< of the factor
  double bytes = 0;    ///< memory of the factorisation
};

/// A factor, wherever it is. Errors of all calls: SOLVER_2 where there is no memory, SOLVER_5 where files cannot be written,
/// std::runtime_error.
/// @tparam Real double or float
template <class Real>
class MumpsFactor {
 public:
  virtual ~MumpsFactor() = default;

  virtual MumpsForecast analyse(const MumpsPattern& pattern) = 0;
  /// The places of entries, the same ones, are there from now on.
  virtual void move_entries(std::span<int> /*row*/, std::span<int> /*column*/) {}
  virtual Factorisation factorise(std::span<const Real> values) = 0;
  /// x = A^-1 b in place, of one right side or of some, one after the other.
  virtual void substitute(std::span<Real> right_side) = 0;
  /// The same for a block of sparse right sides. @param offset (n + 1), index, value: entries of each
  /// @param[out] solution (n, size)
  virtual void substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index,
                          std::span<const Real> value, std::span<Real> solution) = 0;
};

template <class Real>
class Mumps : public MumpsFactor<Real> {
 public:
  explicit Mumps(const MumpsSettings& settings);
  ~Mumps() override;
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  MumpsForecast analyse(const MumpsPattern& pattern) override;
  void move_entries(std::span<int> row, std::span<int> column) override;
  Factorisation factorise(std::span<const Real> values) override;
  /// Of a matrix with a border. @param[out] schur (border, border), by rows, where symmetric the lower triangle alone is set
  Factorisation factorise(std::span<const Real> values, std::span<Real> schur);
  void substitute(std::span<Real> right_side) override;
  void substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index, std::span<const Real> value,
                  std::span<Real> solution) override;
  /// With a border, a block of right sides after another: what they leave to the border, and then from the solution there the
  /// whole one. @param sides (n, size)  @param[out] border (n, border)
  void reduce(std::span<Real> sides, std::span<Real> border);
  /// The same where right sides are sparse; `sides` are theirs alone until they are expanded, what is there does not matter.
  void reduce(std::span<const std::int64_t> offset, std::span<const std::int32_t> index, std::span<const Real> value,
              std::span<Real> sides, std::span<Real> border);
  void expand(std::span<Real> border, std::span<Real> sides);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

extern template class Mumps<double>;
extern template class Mumps<float>;

}  // namespace lacon
