#pragma once
// One instance of MUMPS, in double or in single precision: its calls in C++, without a choice of its own. Nothing but
// mumps_engine.cpp includes it.
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "lacon/assembly/engine.hpp"

namespace lacon {

struct MumpsSettings {
  bool symmetric = true;
  int memory_margin = 20;     ///< percent
  double singular_pivot = 0;  ///< a pivot below this fraction of the scaled matrix is null
  double low_rank = 0;        ///< blocks are compressed to this fraction of the matrix; 0: they stay whole
  bool out_of_core = false;   ///< the factor is in files
  std::string folder;         ///< of these files
};

/// The places of entries and their order of elimination, numbered from 1. They must stay where they are.
struct MumpsPattern {
  std::span<int> row, column;
  std::span<int> place;  ///< of each equation
};

/// What the analysis foresees.
struct MumpsForecast {
  double flops = 0;
  double entries = 0;  ///< of the factor
  double bytes = 0;    ///< memory of the factorisation
};

/// @tparam Real double or float
template <class Real>
class Mumps {
 public:
  explicit Mumps(const MumpsSettings& settings);
  ~Mumps();
  Mumps(const Mumps&) = delete;
  Mumps& operator=(const Mumps&) = delete;

  /// Errors of all calls: SOLVER_2 where there is no memory, SOLVER_5 where files cannot be written, std::runtime_error.
  MumpsForecast analyse(const MumpsPattern& pattern);
  Factorisation factorise(std::span<const Real> values);
  /// x = A^-1 b in place.
  void substitute(std::span<Real> right_side);
  /// The same for a block of sparse right sides. @param offset (n + 1), index, value: entries of each
  /// @param[out] solution (n, size)
  void substitute(std::span<const std::int64_t> offset, std::span<const std::int32_t> index, std::span<const Real> value,
                  std::span<Real> solution);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

extern template class Mumps<double>;
extern template class Mumps<float>;

}  // namespace lacon
