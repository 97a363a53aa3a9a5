#include "lacon/operators/fields/initial_strains.hpp"

#include <algorithm>
#include <map>

#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/tensor.hpp"

namespace lacon {
namespace {

constexpr std::size_t width = tensor_axes.size();

/// A field of strains of cells at the integration points. Throws CREACHAMP_4 where it has others than the model's elements.
Field at_points(const Base& base, const std::string& id, const Ground& ground) {
  Field field = base.field(id);
  field.name = base.label(id);
  return moved_to(ground, field, field_type("ELGA_EPSI_R"), false);
}

}  // namespace

void InitialStrains::add(const Base& base, const ResultLoad& excit, const Mesh& mesh, ModelPoints& points) {
  std::vector<LoadTerm> terms = base.load(excit.load).strain;
  const auto fields = std::stable_partition(terms.begin(), terms.end(), [](const LoadTerm& term) { return term.place >= 0; });
  for (auto term = fields; term != terms.end(); ++term) {
    Part part;
    const Field field = at_points(base, term->value.function, Ground(mesh, points));
    if (!excit.function.empty()) part.multiplier.emplace(base, excit.function);
    part.first.assign(mesh.n_cells(), -1);
    for (std::size_t i = 0; i < field.support.size(); ++i)
      part.first[static_cast<std::size_t>(field.support[i])] = static_cast<std::int64_t>(field.first_row(i));
    part.values = TimedValues(field.n_rows() * width);
    const TensorRows tensors(field, "EP");
    for (std::size_t row = 0; row < field.n_rows(); ++row) {
      const Eigen::Matrix3d tensor = tensors[row];
      for (std::size_t k = 0; k < width; ++k) part.values.set(row * width + k, tensor(tensor_axes[k].i, tensor_axes[k].j));
    }
    part.values.settle();
    parts_.push_back(std::move(part));
  }
  terms.erase(fields, terms.end());
  if (terms.empty()) return;
  Part part;
  if (!excit.function.empty()) part.multiplier.emplace(base, excit.function);
  part.first.assign(mesh.n_cells(), -1);
  std::int64_t n_points = 0;
  for (const LoadTerm& term : terms) {
    std::int64_t& first = part.first[static_cast<std::size_t>(term.place)];
    if (first >= 0) continue;
    first = n_points;
    n_points += points.n_points(static_cast<std::size_t>(term.place));
  }
  part.values = TimedValues(static_cast<std::size_t>(n_points) * width);
  std::map<std::string, std::shared_ptr<const StudyFunction>> functions;
  for (const LoadTerm& term : terms) {
    const auto cell = static_cast<std::size_t>(term.place);
    const auto component =
        static_cast<std::size_t>(std::find_if(tensor_axes.begin(), tensor_axes.end(),
                                              [&](const TensorAxes& a) { return term.component.ends_with(a.name); }) -
                                 tensor_axes.begin());
    const std::size_t first = static_cast<std::size_t>(part.first[cell]) * width + component;
    const CellPoints& there = points(cell, mesh.coordinates);
    for (std::size_t p = 0; p < static_cast<std::size_t>(there.n_points); ++p) {
      if (term.value.function.empty()) {
        part.values.set(first + p * width, term.value.value);
        continue;
      }
      auto& function = functions[term.value.function];
      if (!function) function = std::make_shared<StudyFunction>(base, term.value.function);
      part.values.set(first + p * width, function, std::span(there.position).subspan(3 * p, 3));
    }
  }
  part.values.settle();
  parts_.push_back(std::move(part));
}

bool InitialStrains::concerns(std::int32_t cell) const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return part.first[static_cast<std::size_t>(cell)] >= 0; });
}

std::vector<double> InitialStrains::at(double instant, std::span<const std::int32_t> cells, int n_points) const {
  const std::size_t of_cell = static_cast<std::size_t>(n_points) * width;
  std::vector<double> strains(cells.size() * of_cell, 0.0);
  for (const Part& part : parts_) {
    const double factor = part.multiplier ? part.multiplier->value("INST", instant) : 1.0;
    const std::vector<double> values = part.values.at(instant);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::int64_t first = part.first[static_cast<std::size_t>(cells[i])];
      for (std::size_t k = 0; first >= 0 && k < of_cell; ++k)
        strains[i * of_cell + k] += factor * values[static_cast<std::size_t>(first) * width + k];
    }
  }
  return strains;
}

}  // namespace lacon
