#include "lacon/operators/evolution/problem/dependent_relations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace lacon {
namespace {

constexpr double round_off = 1e-9;  // of the largest coefficient: what is left of a row that is a sum of others

/// Whether each row is independent for having an unknown to itself, or one that only such rows share besides.
std::vector<bool> with_an_unknown_of_their_own(std::span<const FreeRow> rows) {
  std::map<std::int64_t, std::vector<std::size_t>> rows_of;  // of an unknown
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const std::int64_t unknown : rows[r].unknowns) rows_of[unknown].push_back(r);
  std::map<std::int64_t, std::size_t> left;  // rows that are not independent for that
  std::vector<std::int64_t> alone;
  for (const auto& [unknown, of_it] : rows_of)
    if ((left[unknown] = of_it.size()) == 1) alone.push_back(unknown);
  std::vector<bool> independent(rows.size(), false);
  while (!alone.empty()) {
    const std::vector<std::size_t>& of_it = rows_of[alone.back()];
    alone.pop_back();
    const auto row = std::ranges::find_if(of_it, [&](std::size_t r) { return !independent[r]; });
    if (row == of_it.end()) continue;
    independent[*row] = true;
    for (const std::int64_t unknown : rows[*row].unknowns)
      if (--left[unknown] == 1) alone.push_back(unknown);
  }
  return independent;
}

using Sparse = std::map<std::int64_t, double>;

void add(Sparse& to, double factor, const Sparse& row) {
  for (const auto& [at, value] : row) to[at] += factor * value;
}

/// A row less what rows before it make of it, and how that came from the rows that were given.
struct Reduced {
  Sparse row, origin;
  std::int64_t pivot;
};

}  // namespace

std::vector<DependentRelation> dependent_relations(std::span<const FreeRow> rows) {
  // no sum of rows vanishes that has a part of one with an unknown to itself: the others are looked at alone
  const std::vector<bool> independent = with_an_unknown_of_their_own(rows);
  std::vector<DependentRelation> dependent;
  std::vector<Reduced> before;
  std::map<std::int64_t, std::size_t> before_with_pivot;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (independent[r]) continue;
    Reduced reduced{{}, {{static_cast<std::int64_t>(r), 1.0}}, -1};
    double scale = 0;
    for (std::size_t i = 0; i < rows[r].unknowns.size(); ++i) {
      reduced.row[rows[r].unknowns[i]] = rows[r].coefficients[i];
      scale = std::max(scale, std::abs(rows[r].coefficients[i]));
    }
    // a row has no pivot of those before it, so that taking it off brings back later ones alone
    std::set<std::size_t> to_take_off;
    const auto note = [&](const Sparse& row) {
      for (const auto& [unknown, value] : row)
        if (const auto of = before_with_pivot.find(unknown); of != before_with_pivot.end()) to_take_off.insert(of->second);
    };
    for (note(reduced.row); !to_take_off.empty(); to_take_off.erase(to_take_off.begin())) {
      const Reduced& other = before[*to_take_off.begin()];
      const auto entry = reduced.row.find(other.pivot);
      if (entry == reduced.row.end()) continue;
      const double factor = -entry->second / other.row.at(other.pivot);
      add(reduced.row, factor, other.row);
      add(reduced.origin, factor, other.origin);
      reduced.row.erase(other.pivot);
      note(other.row);
    }
    std::erase_if(reduced.row, [&](const auto& entry) { return std::abs(entry.second) <= round_off * scale; });
    if (reduced.row.empty()) {
      DependentRelation& follows = dependent.emplace_back(DependentRelation{r, {}});
      for (const auto& [other, factor] : reduced.origin)
        if (static_cast<std::size_t>(other) != r) follows.sum_of.emplace_back(other, -factor);
      continue;
    }
    reduced.pivot = std::ranges::max_element(reduced.row, {}, [](const auto& entry) { return std::abs(entry.second); })->first;
    before_with_pivot[reduced.pivot] = before.size();
    before.push_back(std::move(reduced));
  }
  return dependent;
}

}  // namespace lacon
