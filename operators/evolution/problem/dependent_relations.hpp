#pragma once
// Relations that say nothing new.
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lacon {

/// A relation's row on the displacements that are free: unknowns and coefficients.
struct FreeRow {
  std::vector<std::int64_t> unknowns;  ///< each once
  std::vector<double> coefficients;
};

/// A relation that follows from others before it: its row is a sum of theirs.
struct DependentRelation {
  std::size_t relation;
  std::vector<std::pair<std::size_t, double>> sum_of;  ///< relations that are none of these, and factors
};

/// Those that rows before them, and imposed displacements, make: a rigid face that planes of symmetry hold too, a tie said
/// twice. With a multiplier each the system would be singular. In the order of the relations.
std::vector<DependentRelation> dependent_relations(std::span<const FreeRow> rows);

}  // namespace lacon
