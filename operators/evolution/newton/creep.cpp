#include "lacon/operators/evolution/newton/creep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lacon/structures/displacement.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

constexpr double more = 4;                       // of the resistance, where it is too little
constexpr double eased = 0.3, most_eased = 0.1;  // what is left of it where the residual falls, and where it falls as steeply
constexpr double grown = 2;                      // at most, where the residual grows

/// Of the cells of bodies at each node, the mean; 0 elsewhere. A square or a cube has the length of its sides.
std::vector<double> cell_sizes(const StaticProblem& problem) {
  const Mesh& mesh = problem.mesh;
  std::vector<double> size(mesh.n_nodes(), 0.0), count(mesh.n_nodes(), 0.0);
  for (const ElementSet& set : problem.solids)
    for (const std::int32_t cell : set.cells) {
      const auto nodes = mesh.cells[static_cast<std::size_t>(cell)];
      const auto n = static_cast<double>(nodes.size());
      const auto place = [&](std::int32_t node) {
        const auto x = mesh.point(static_cast<std::size_t>(node));
        return Vec3{x[0], x[1], x[2]};
      };
      Vec3 middle{};
      for (const std::int32_t node : nodes) middle = middle + place(node) / n;
      double distance = 0;
      for (const std::int32_t node : nodes) distance += norm(place(node) - middle) / n;
      for (const std::int32_t node : nodes) {
        size[static_cast<std::size_t>(node)] += 2 * distance / std::sqrt(problem.dimension);
        count[static_cast<std::size_t>(node)] += 1;
      }
    }
  for (std::size_t node = 0; node < size.size(); ++node)
    if (count[node] > 0) size[node] /= count[node];
  return size;
}

}  // namespace

Creep::Creep(const StaticProblem& problem, const System& stiffness) {
  const std::vector<SparseMatrix::RowSize> rows = stiffness.matrix().row_sizes(stiffness.first_multiplier());
  const std::vector<double> sizes = cell_sizes(problem);
  const double length = extent(problem.mesh);
  const auto width = static_cast<std::size_t>(problem.n_components()), axes = static_cast<std::size_t>(problem.dimension);
  mass_.resize(rows.size());
  size_.resize(rows.size());
  for (std::size_t dof = 0; dof < problem.n_dofs(); ++dof) {
    const std::int64_t equation = problem.numbering.equation[dof];
    if (equation < 0 || dof % width >= axes) continue;
    const auto e = static_cast<std::size_t>(equation);
    size_[e] = sizes[dof / width];
    mass_[e] = rows[e].sum * size_[e] * size_[e] / (length * length);
  }
}

std::vector<double> Creep::resistance() const {
  std::vector<double> values = mass_;
  for (double& value : values) value *= factor_;
  return values;
}

double Creep::over_cells(std::span<const double> solution) const {
  double most = 0;
  for (std::size_t e = 0; e < size_.size(); ++e)
    if (size_[e] > 0) most = std::max(most, std::abs(solution[e]) / size_[e]);
  return most;
}

void Creep::raise() {
  factor_ *= more;
  raised_ = true;
}

void Creep::ease(double residual) {
  const double ratio = residual_ > 0 ? residual / residual_ : 1;
  residual_ = residual;
  if (std::exchange(raised_, false)) return;
  factor_ *= ratio > 1 ? std::min(ratio * ratio, grown) : std::clamp(ratio, most_eased, eased);
}

}  // namespace lacon
