#include "lacon/operators/evolution/newton/convergence.hpp"

#include <algorithm>
#include <cmath>

namespace lacon {
namespace {

double share_of(double unbalanced, double reference) {
  return unbalanced > 0 && std::isfinite(unbalanced) ? unbalanced / reference : unbalanced;
}

/// The longest of the vectors that components `first` to `last` of nodes make.
double longest_vector(std::span<const double> values, std::size_t n_components, std::size_t first, std::size_t last) {
  double largest = 0;
  for (std::size_t node = 0; node < values.size(); node += n_components) {
    double square = 0;
    for (std::size_t c = first; c < last; ++c) square += values[node + c] * values[node + c];
    largest = std::max(largest, square);
  }
  return std::sqrt(largest);
}

}  // namespace

double largest_entry(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double longest_displacement(std::span<const double> values, std::size_t n_components, std::size_t dimension) {
  return longest_vector(values, n_components, 0, dimension);
}

double longest_force(std::span<const double> values, std::size_t n_components, std::size_t dimension) {
  return std::max(longest_vector(values, n_components, 0, dimension),
                  longest_vector(values, n_components, dimension, n_components));
}

void judge_forces(const ConvergenceCriteria& criteria, const ForceFigures& forces, IterationReport& report) {
  report.maxi = forces.unbalanced;
  report.worst_dof = forces.worst_dof;
  report.rela = share_of(forces.unbalanced, forces.reference);
  report.longest = forces.unbalanced_vector;
  report.longest_share = share_of(forces.unbalanced_vector, forces.reference_vector);
  const bool small = !criteria.resi_glob_rela || report.rela <= *criteria.resi_glob_rela;
  report.round_off = !small && forces.significant == 0 && forces.felt > 0;
  report.rela_met = small || (forces.significant == 0 && (!report.round_off || report.rela <= near_balance));
  report.maxi_met = !criteria.resi_glob_maxi || report.maxi <= *criteria.resi_glob_maxi;
  report.refe = forces.over_own;
  report.refe_met = !criteria.resi_refe_rela || report.refe <= *criteria.resi_refe_rela;
}

double forces_over_asked(const ConvergenceCriteria& criteria, const IterationReport& report) {
  return std::max({criteria.resi_glob_rela ? report.rela / *criteria.resi_glob_rela : 0,
                   criteria.resi_glob_maxi ? report.maxi / *criteria.resi_glob_maxi : 0,
                   criteria.resi_refe_rela ? report.refe / *criteria.resi_refe_rela : 0});
}

void judge_contact(const ConvergenceCriteria& criteria, const MotionFigures& motion, double constraint,
                   IterationReport& report) {
  report.geometry = motion.increment == 0 ? 0 : motion.increment / std::max(motion.whole, motion.vanishing);
  report.geometry_met = report.geometry <= criteria.resi_geom;
  report.constraint = constraint;
  report.constraint_met = report.constraint <= criteria.constraint;
}

}  // namespace lacon
