#pragma once
// Solid elements from one state to the next: laws see strains without stress (thermal ones, initial ones) in the stress that
// they start from.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lacon/assembly/element_sets.hpp"
#include "lacon/assembly/point_values.hpp"

namespace lacon {

/// Where E and NU of ELAS stand among the parameters of a set's kernel.
struct ElasticParameters {
  std::size_t young, poisson;
};
/// Nothing where the kernel does not take both.
std::optional<ElasticParameters> elastic_parameters(const ElementSet& set);

/// Where a parameter of ECRO_LINE or another keyword stands among them: "ECRO_LINE/D_SIGM_EPSI".
std::optional<std::size_t> parameter_place(const ElementSet& set, std::string_view path);

/// A state from which a step starts.
struct SolidStart {
  std::span<const double> displacement = {};
  const PointValues* points = nullptr;  ///< of the set; nothing: the natural state at the reference temperature
};

/// Evaluate the elements of a set (evaluate_solids) at a displacement of the mesh.
/// @param now the strains without stress and the parameters of the step; stresses and variables that are found are put there
std::optional<std::int32_t> evaluate_step(const ElementSet& set, const Mesh& mesh, std::span<const double> displacement,
                                          PointValues& now, const SolidStart& start, SolidMatrix wanted,
                                          const std::function<void(const ElementValues&)>& use);

}  // namespace lacon
