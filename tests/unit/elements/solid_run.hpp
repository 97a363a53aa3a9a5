#pragma once
// One solid element under a behaviour, for tests of measures of strain and laws.
#include <cmath>
#include <functional>
#include <random>

#include "solids.hpp"

using Numbers = std::vector<double>;
using lacon::catalog::ElementRow;

constexpr double young = 200, poisson = 0.3, mu = young / (2 * (1 + poisson)), lambda = 2 * mu * poisson / (1 - 2 * poisson);
inline const Numbers linear_hardening = {0, 1, 20};                     // yield stress 1, slope 20
inline const Numbers pieces = {0, 1, 40, 0.01, 1.4, 10, 0.05, 1.8, 0};  // three straight pieces, the last one flat

struct State {
  Numbers displacement, stress, variable;
  double thermal = 0;  ///< strain, the same at all points
};

struct Answer {
  Numbers matrix, whole_matrix, force;
  State state;
  int error = -1;
};

/// Name of a test whose parameter is an element and an option, "ELAS/PETIT".
inline const auto case_name = [](const auto& given) {
  std::string name = test_name(*std::get<0>(given.param)) + "_" + std::get<1>(given.param);
  for (char& c : name)
    if (c == '/') c = '_';
  return name;
};

/// One element, in every lane. @param x, u (n_nodes, dimension)  @param from the last state; empty vectors: natural
inline Answer run(const ElementRow& row, const std::string& option, const Numbers& x, const Numbers& u, const State& from,
                  const Numbers& curve = linear_hardening, bool elastic_matrix = false, bool stressless_matrix = false,
                  double thermal = 0) {
  const auto table = table_of(row);
  const lacon_kernel& kernel = registry().kernel(row, option, LACON_SOLID);
  const auto spread = [](const Numbers& values) {
    Numbers all;
    for (const double value : values) all.insert(all.end(), LACON_LANES, value);
    return all;
  };
  const Numbers xs = spread(x), us = spread(u), material = spread({young, poisson}), before = spread(from.displacement),
                before_stress = spread(from.stress), before_variable = spread(from.variable);
  const std::size_t n = x.size(), points = z(table.n_points);
  Numbers matrix(n * (n + 1) / 2 * LACON_LANES, garbage), whole_matrix(kernel.unsymmetric ? n * n * LACON_LANES : 0, garbage),
      force(n * LACON_LANES, garbage), stress(points * row.stress.size() * LACON_LANES, garbage),
      variable(points * z(lacon::n_names(kernel.variables)) * LACON_LANES, garbage);
  std::vector<std::int32_t> error(LACON_LANES, -1);
  lacon_solid_batch batch{};
  batch.struct_size = sizeof batch;
  batch.n_blocks = 1;
  batch.n_nodes = table.n_nodes;
  batch.dimension = static_cast<int>(row.dofs.size());
  batch.n_points = table.n_points;
  batch.n_stress = static_cast<int>(row.stress.size());
  batch.n_parameters = 2;
  batch.shape = table.shape.data();
  batch.gradient = table.gradient.data();
  batch.weight = table.weight.data();
  batch.coordinates = xs.data();
  batch.displacement = us.data();
  batch.parameter = material.data();
  batch.matrix = matrix.data();
  batch.force = force.data();
  batch.stress = stress.data();
  batch.error = error.data();
  batch.previous_displacement = before.empty() ? nullptr : before.data();
  batch.previous_stress = before_stress.empty() ? nullptr : before_stress.data();
  batch.previous_variable = before_variable.empty() ? nullptr : before_variable.data();
  batch.variable = variable.data();
  batch.curve = curve.data();
  batch.n_curve = static_cast<int>(curve.size() / 3);
  batch.n_variables = lacon::n_names(kernel.variables);
  batch.elastic_matrix = elastic_matrix;
  batch.stressless_matrix = stressless_matrix;
  batch.whole_matrix = whole_matrix.empty() ? nullptr : whole_matrix.data();
  const Numbers thermal_strain(points * LACON_LANES, thermal), before_thermal(points * LACON_LANES, from.thermal);
  if (thermal != 0) batch.thermal_strain = thermal_strain.data();
  if (from.thermal != 0) batch.previous_thermal_strain = before_thermal.data();
  kernel.solid(&batch);
  const auto first = [](const Numbers& lanes) {
    Numbers values;
    for (std::size_t i = 3; i < lanes.size(); i += LACON_LANES) values.push_back(lanes[i]);  // of lane 3
    return values;
  };
  return {first(matrix), first(whole_matrix), first(force), {u, first(stress), first(variable), thermal}, error[3]};
}

/// u = gradient x, in three dimensions or two.
inline Numbers linear_field(const Numbers& x, int dimension, const double (&gradient)[3][3]) {
  Numbers u;
  for (std::size_t a = 0; a < x.size(); a += z(dimension))
    for (int i = 0; i < dimension; ++i) {
      double value = 0;
      for (int k = 0; k < dimension; ++k) value += gradient[i][k] * x[a + z(k)];
      u.push_back(value);
    }
  return u;
}

/// A displacement that bends every line, of a given size; the same sequence for the same seed.
inline Numbers shaken_displacement(std::size_t n, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Numbers u(n);
  for (double& value : u) value = number(random);
  return u;
}

/// Solve f(t) = 0 for an increasing f.
inline double root(double low, double high, const std::function<double(double)>& f) {
  for (int i = 0; i < 200; ++i) (f((low + high) / 2) > 0 ? high : low) = (low + high) / 2;
  return (low + high) / 2;
}
