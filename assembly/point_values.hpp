#pragma once
// What the integration points of a solid set hold at an instant.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lacon/assembly/element_sets.hpp"

namespace lacon {

struct PointValues {
  std::vector<double> stress;    ///< (cells, points, components)
  std::vector<double> variable;  ///< (cells, points, internal variables)
  // strains without stress, and what temperatures do to the material; empty where there are none
  std::vector<double> thermal = {};    ///< (cells, points): thermal strain
  std::vector<double> parameter = {};  ///< (cells, parameters), where parameters follow the temperature
  std::vector<double> initial = {};    ///< (cells, points, 6): initial strains, as tensor_axes orders them
};

enum class PointQuantity { stress, variable, thermal, parameter, initial };

struct PointQuantityRow {
  PointQuantity quantity;
  const char* name;
  std::vector<double> PointValues::*values;
  bool is_given;  ///< by the instant alone: loads and temperatures say it, not the law
};
inline constexpr std::array<PointQuantityRow, 5> point_quantities{
    {{PointQuantity::stress, "stress", &PointValues::stress, false},
     {PointQuantity::variable, "variable", &PointValues::variable, false},
     {PointQuantity::thermal, "thermal", &PointValues::thermal, true},
     {PointQuantity::parameter, "parameter", &PointValues::parameter, true},
     {PointQuantity::initial, "initial", &PointValues::initial, true}}};

inline std::vector<double> PointValues::*member_of(PointQuantity quantity) {
  return point_quantities[static_cast<std::size_t>(quantity)].values;
}

constexpr std::size_t n_initial_strains = 6;  ///< of a point

/// Numbers that a cell of a set has.
inline std::size_t width_of(const ElementSet& set, PointQuantity quantity) {
  const auto n_points = static_cast<std::size_t>(set.tabulation.n_points);
  switch (quantity) {
    case PointQuantity::stress:
      return set.n_stress();
    case PointQuantity::variable:
      return set.n_variables();
    case PointQuantity::thermal:
      return n_points;
    case PointQuantity::parameter:
      return static_cast<std::size_t>(set.n_parameters);
    case PointQuantity::initial:
      return n_points * n_initial_strains;
  }
  return 0;
}

/// Stresses and variables zero, nothing else.
inline PointValues natural_points(const ElementSet& set) {
  return {std::vector<double>(set.cells.size() * set.n_stress(), 0.0),
          std::vector<double>(set.cells.size() * set.n_variables(), 0.0)};
}

}  // namespace lacon
