#include "lacon/assembly/element_sets.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string_view>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/parallel.hpp"

namespace lacon {
namespace {

constexpr int lanes = LACON_LANES;

/// A number of each lane, at a cache line of its own: kernels read and write arrays that start there faster.
struct alignas(lanes * sizeof(double)) LaneNumbers {
  double value[lanes];
};
using LaneArray = std::vector<LaneNumbers>;
double* numbers(LaneArray& array) { return array.empty() ? nullptr : array.front().value; }

/// Elements of a kernel call, a loop block: as many as keep their matrices in the cache.
std::size_t batch_size(std::size_t matrix_entries) {
  constexpr std::size_t cache_bytes = 1 << 18, most_blocks = 32;
  return lanes * std::clamp<std::size_t>(cache_bytes / (matrix_entries * sizeof(LaneNumbers)), 1, most_blocks);
}

/// The part that says it.
std::string_view reason(int error) {
  switch (error) {
    case LACON_BAD_JACOBIAN:
      return "bad_jacobian";
    case LACON_BAD_PARAMETER:
      return "bad_parameter";
    case LACON_BAD_BATCH:
      return "bad_kernel_row";
    case LACON_BAD_RADIUS:
      return "beyond_axis";
    case LACON_INSIDE_OUT:
      return "turned_inside_out";
    case LACON_BEYOND_CURVE:
      return "beyond_curve";
    default:
      return "not_finite";
  }
}

bool refused(std::int32_t error) { return error != LACON_FINE && error != LACON_INSIDE_OUT; }

/// @param first_cell of the set, that the first of the errors belongs to
[[noreturn]] void refuse_elements(const ElementSet& set, std::span<const std::int32_t> errors, std::size_t first_cell) {
  std::int64_t count = 0;
  std::size_t first = errors.size();
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (refused(errors[i])) {
      first = std::min(first, i);
      ++count;
    }
  fail("ELEMENT_1", {{"count", std::to_string(count)},
                     {"reason", part(reason(errors[first]))},
                     {"cell", cell_name(set.number(first_cell + first))},
                     {"element", std::string(set.row->name)}});
}

/// A batch of cells in lanes: block b, lane l is cells[b * lanes + l]; the last block repeats the last cell.
class Batch {
 public:
  Batch(const ElementSet& set, const Mesh& mesh, const LoopBlock& cells)
      : set_(set), mesh_(mesh), first_(cells.first), size_(cells.last - cells.first) {}

  std::size_t size() const { return size_; }
  std::size_t n_blocks() const { return (size_ + lanes - 1) / lanes; }
  std::size_t index(std::size_t i) const { return first_ + std::min(i, size_ - 1); }
  std::int32_t cell(std::size_t i) const { return set_.cells[index(i)]; }

  /// The kernel's unknowns, (n_blocks, n_nodes, n_unknowns, lanes), out of those of the mesh.
  void gather_unknowns(std::span<const double> nodal, LaneArray& out) const {
    gather(nodal, set_.n_components, set_.columns, out);
  }
  /// (n_blocks, n_nodes, dimension, lanes) out of (nodes, 3).
  void gather_points(std::span<const double> points, LaneArray& out) const {
    constexpr std::array axes{0, 1, 2};
    gather(points, 3, std::span(axes).first(static_cast<std::size_t>(set_.dimension())), out);
  }
  /// (n_blocks, width, lanes) out of values of each cell of the set (cells, width).
  void gather_cells(std::span<const double> values, std::size_t width, LaneArray& out) const {
    out.resize(n_blocks() * width);
    for (std::size_t i = 0; i < n_blocks() * lanes; ++i)
      for (std::size_t k = 0; k < width; ++k) out[i / lanes * width + k].value[i % lanes] = values[index(i) * width + k];
  }
  /// (elements of the batch, width) out of lanes.
  void scatter(const LaneArray& values, std::size_t width, std::span<double> out) const {
    for (std::size_t first = 0; first < size_; first += lanes) {
      const LaneNumbers* const block = values.data() + first / lanes * width;
      const std::size_t n = std::min<std::size_t>(lanes, size_ - first);
      double* const elements = out.data() + first * width;
      for (std::size_t k = 0; k < width; ++k)
        for (std::size_t l = 0; l < n; ++l) elements[l * width + k] = block[k].value[l];
    }
  }
  void scatter(const LaneArray& values, std::size_t width, std::vector<double>& out) const {
    out.resize(size_ * width);
    scatter(values, width, std::span(out));
  }
  /// Throws where a kernel refused an element. @return the first that is turned inside out
  std::optional<std::int32_t> check(std::span<const std::int32_t> errors) const {
    const auto own = errors.first(size_);
    if (std::any_of(own.begin(), own.end(), refused)) refuse_elements(set_, own, first_);
    const auto inverted = std::find(own.begin(), own.end(), LACON_INSIDE_OUT);
    if (inverted == own.end()) return std::nullopt;
    return set_.number(first_ + static_cast<std::size_t>(inverted - own.begin()));
  }

 private:
  /// (n_blocks, n_nodes, columns, lanes) out of some columns of nodal values (nodes, stride).
  void gather(std::span<const double> nodal, int stride, std::span<const int> columns, LaneArray& out) const {
    const std::size_t n = static_cast<std::size_t>(set_.n_nodes()), width = columns.size();
    out.resize(n_blocks() * n * width);
    for (std::size_t i = 0; i < n_blocks() * lanes; ++i) {
      const auto nodes = mesh_.cells[cell(i)];
      LaneNumbers* const block = out.data() + (i / lanes) * n * width;
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t c = 0; c < width; ++c)
          block[k * width + c].value[i % lanes] = nodal[static_cast<std::size_t>(nodes[k]) * stride + columns[c]];
    }
  }

  const ElementSet& set_;
  const Mesh& mesh_;
  std::size_t first_, size_;
};

/// @param unknowns of node_unknowns()
ElementSet make_set(const catalog::ElementRow& row, Registry& registry, std::string_view option, lacon_kernel_kind kind,
                    std::span<const std::string> unknowns) {
  ElementSet set;
  set.row = &row;
  set.kernel = &registry.kernel(row, option, kind);
  set.option = option;
  set.tabulation = tabulate(row.cell, integration_rule(catalog::cell(row.cell).family, row.points));
  set.n_components = static_cast<int>(unknowns.size());
  for (const std::string_view own : unknowns_of(row, *set.kernel))
    set.columns.push_back(static_cast<int>(std::find(unknowns.begin(), unknowns.end(), own) - unknowns.begin()));
  return set;
}

}  // namespace

std::vector<std::string> node_unknowns(const Model& model, const Registry& registry) {
  std::vector<std::string> unknowns;
  for (const std::string& name : model.elements) {
    const catalog::ElementRow* row = registry.find_element(name);
    if (!row) fail("PLUGIN_4", {{"element", name}});
    for (const std::string_view dof : row->dofs)  // displacements first, the same of every element
      if (std::find(unknowns.begin(), unknowns.end(), dof) == unknowns.end()) unknowns.emplace_back(dof);
  }
  return unknowns;
}

ElementSet solid_set(const catalog::ElementRow& row, Registry& registry, const std::string& option,
                     std::span<const std::string> unknowns) {
  ElementSet set = make_set(row, registry, option, LACON_SOLID, unknowns);
  set.linear = !set.kernel->nonlinear;
  set.n_parameters = n_names(set.kernel->parameters);
  set.n_point_variables = n_names(set.kernel->variables);
  return set;
}

void stop_flow(const ElementSet& set, std::span<double> variable) {
  const auto width = static_cast<std::size_t>(set.n_point_variables);
  for (std::size_t v = 0; v < width; ++v)
    if (std::string_view(set.kernel->variables[v]) == "INDIPLAS")
      for (std::size_t i = v; i < variable.size(); i += width) variable[i] = 0;
}

bool has_flowed(const ElementSet& set, std::span<const double> now, std::span<const double> before) {
  const auto width = static_cast<std::size_t>(set.n_point_variables);
  std::size_t telling = 0;  // behind them are elastic strains, which change without any flow
  while (telling < width && !std::string_view(set.kernel->variables[telling]).starts_with("EPSE")) ++telling;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (i % width < telling && now[i] != before[i]) return true;
  return false;
}

std::vector<ElementSet> solid_sets(const Mesh& mesh, const Model& model, Registry& registry, const MaterialTable& materials,
                                   const Behaviours& behaviours) {
  struct Kind {
    std::int32_t element, behaviour, material;  // material: -1 where it makes no difference
    auto operator<=>(const Kind&) const = default;
  };
  std::map<Kind, std::vector<std::int32_t>> by_kind;
  std::vector<std::int32_t> bare;  // without material
  for (std::size_t c = 0; c < mesh.n_cells(); ++c) {
    const std::int32_t element = model.element[c], behaviour = behaviours.of_cell[c], cell = static_cast<std::int32_t>(c);
    if (element < 0) continue;
    const catalog::ElementRow* row = registry.find_element(model.elements[element]);
    if (!row) fail("PLUGIN_4", {{"element", model.elements[element]}});
    if (row->role != catalog::Role::solid) continue;
    if (!registry.has_kernel(*row, behaviours.options[behaviour]))
      fail("BEHAVIOUR_1",
           {{"behaviour", behaviours.options[behaviour]}, {"element", std::string(row->name)}, {"cell", cell_name(cell)}});
    if (!materials.has(cell)) {
      bare.push_back(cell);
      continue;
    }
    const bool takes_curve = registry.kernel(*row, behaviours.options[behaviour], LACON_SOLID).takes_curve;
    by_kind[{element, behaviour, takes_curve ? materials.of(cell) : -1}].push_back(cell);
  }
  if (!bare.empty())
    fail("ELEMENT_2", {{"cell", cell_name(bare.front())},
                       {"element", model.elements[model.element[bare.front()]]},
                       {"count", std::to_string(bare.size())}});
  const std::vector<std::string> unknowns = node_unknowns(model, registry);
  std::vector<ElementSet> sets;
  for (auto& [kind, cells] : by_kind) {
    const catalog::ElementRow& row = *registry.find_element(model.elements[kind.element]);
    const std::string& option = behaviours.options[kind.behaviour];
    ElementSet set = solid_set(row, registry, option, unknowns);
    set.cells = std::move(cells);
    if (set.kernel->takes_curve) {
      const catalog::RelationRow* relation = registry.find_relation(option.substr(0, option.find('/')));
      set.curve = hardening_curve(materials, set.cells.front(), relation ? relation->hardening : "", row.name);
    }
    for (const std::int32_t cell : set.cells)
      for (int p = 0; p < set.n_parameters; ++p)
        set.parameters.push_back(materials.parameter(cell, set.kernel->parameters[p], row.name));
    sets.push_back(std::move(set));
  }
  return sets;
}

std::vector<ElementSet> load_sets(const Model& model, Registry& registry, std::string_view option,
                                  std::span<const std::int32_t> cells, std::vector<std::vector<std::int32_t>>& position) {
  std::map<std::int32_t, std::vector<std::int32_t>> by_element;
  for (std::size_t i = 0; i < cells.size(); ++i) by_element[model.element[cells[i]]].push_back(static_cast<std::int32_t>(i));
  const std::vector<std::string> unknowns = node_unknowns(model, registry);
  std::vector<ElementSet> sets;
  position.clear();
  for (auto& [element, indices] : by_element) {
    const catalog::ElementRow* row = element < 0 ? nullptr : registry.find_element(model.elements[element]);
    if (!row)
      fail("PLUGIN_4",
           {{"element", element < 0 ? "none, on cell " + cell_name(cells[indices.front()]) : model.elements[element]}});
    ElementSet set = make_set(*row, registry, option, LACON_LOAD, unknowns);
    for (const std::int32_t i : indices) set.cells.push_back(cells[i]);
    sets.push_back(std::move(set));
    position.push_back(std::move(indices));
  }
  return sets;
}

namespace {

/// One thread's part of a loop over elements, with the batch that it has in hand.
class ElementBatches {
 public:
  ElementBatches(const ElementSet& set, const Mesh& mesh, bool with_matrix, bool symmetric = true)
      : set_(set), mesh_(mesh), with_matrix_(with_matrix), symmetric_(symmetric) {}

  std::size_t n_dofs() const { return static_cast<std::size_t>(set_.n_nodes()) * set_.columns.size(); }
  std::size_t n_entries() const { return symmetric_ ? n_dofs() * (n_dofs() + 1) / 2 : n_dofs() * n_dofs(); }  ///< of a matrix
  std::optional<std::int32_t> inside_out() const { return inside_out_; }  ///< the first such cell of the batch in hand

  void hand_over(const LoopBlock& cells, const std::function<void(const ElementValues&)>& use) const {
    const std::span<const double> forces = own_force_, matrices = own_matrix_;
    std::vector<std::int64_t> dofs;
    for (std::size_t i = cells.first; i < cells.last; ++i) {
      const std::size_t own = i - cells.first;
      dofs.clear();
      for (const std::int32_t node : mesh_.cells[set_.cells[i]])
        for (const int column : set_.columns) dofs.push_back(std::int64_t{node} * set_.n_components + column);
      use({set_.cells[i], dofs, forces.subspan(own * n_dofs(), n_dofs()),
           with_matrix_ ? matrices.subspan(own * n_entries(), n_entries()) : matrices, symmetric_});
    }
  }

 protected:
  void make_room(const Batch& batch) {
    force_.resize(batch.n_blocks() * n_dofs());
    if (with_matrix_) matrix_.resize(batch.n_blocks() * n_entries());
    errors_.assign(batch.n_blocks() * lanes, LACON_FINE);
  }
  /// What the kernel has left in force_, matrix_ and errors_.
  void take_results(const Batch& batch) {
    inside_out_ = batch.check(errors_);
    batch.scatter(force_, n_dofs(), own_force_);
    if (with_matrix_) batch.scatter(matrix_, n_entries(), own_matrix_);
  }

  const ElementSet& set_;
  const Mesh& mesh_;
  bool with_matrix_, symmetric_;
  LaneArray force_, matrix_;
  std::vector<std::int32_t> errors_;

 private:
  std::vector<double> own_force_, own_matrix_;  // element by element
  std::optional<std::int32_t> inside_out_;
};

/// Evaluate the elements of a set by workers that copy `first`, and hand them over in turn. @return as evaluate_solids()
template <class Batches>
std::optional<std::int32_t> evaluate_in_turn(const ElementSet& set, const Batches& first,
                                             const std::function<void(const ElementValues&)>& use) {
  std::optional<std::int32_t> inside_out;
  parallel_in_turn(set.cells.size(), batch_size(first.n_entries()), [&] {
    const auto batches = std::make_shared<Batches>(first);
    return LoopWorker{[batches](const LoopBlock& cells) { batches->evaluate(cells); },
                      [batches, &use, &inside_out](const LoopBlock& cells) {
                        if (!inside_out) inside_out = batches->inside_out();
                        batches->hand_over(cells, use);
                      }};
  });
  return inside_out;
}

class SolidBatches : public ElementBatches {
 public:
  SolidBatches(const ElementSet& set, const Mesh& mesh, const SolidInput& input, SolidMatrix wanted, const SolidOutput& output)
      : ElementBatches(set, mesh, wanted != SolidMatrix::none, wanted != SolidMatrix::whole || !set.kernel->unsymmetric),
        input_(input),
        wanted_(wanted),
        output_(output) {}

  void evaluate(const LoopBlock& cells) {
    const Batch batch(set_, mesh_, cells);
    const std::size_t n_stress = set_.n_stress(), n_variables = set_.n_variables(),
                      n_points = static_cast<std::size_t>(set_.tabulation.n_points);
    // what is left out, or does not exist, is a null pointer
    const auto nodal = [&](std::span<const double> values, LaneArray& array) -> const double* {
      if (values.empty()) return nullptr;
      batch.gather_unknowns(values, array);
      return numbers(array);
    };
    const auto of_cells = [&](std::span<const double> values, std::size_t width, LaneArray& array) -> const double* {
      if (values.empty()) return nullptr;
      batch.gather_cells(values, width, array);
      return numbers(array);
    };
    const auto wanted = [&](std::span<const double> values, std::size_t width, LaneArray& array) -> double* {
      if (values.empty()) return nullptr;
      array.resize(batch.n_blocks() * width);
      return numbers(array);
    };
    make_room(batch);
    batch.gather_points(mesh_.coordinates, coordinates_);
    const lacon_solid_batch call{.struct_size = sizeof(lacon_solid_batch),
                                 .n_blocks = static_cast<std::int32_t>(batch.n_blocks()),
                                 .n_nodes = set_.n_nodes(),
                                 .dimension = set_.dimension(),
                                 .n_points = set_.tabulation.n_points,
                                 .n_stress = static_cast<std::int32_t>(set_.row->stress.size()),
                                 .n_parameters = set_.n_parameters,
                                 .shape = set_.tabulation.shape.data(),
                                 .gradient = set_.tabulation.gradient.data(),
                                 .weight = set_.tabulation.weight.data(),
                                 .coordinates = numbers(coordinates_),
                                 .displacement = nodal(input_.displacement, displacement_),
                                 .parameter = of_cells(input_.parameters.empty() ? set_.parameters : input_.parameters,
                                                       static_cast<std::size_t>(set_.n_parameters), parameters_),
                                 .matrix = symmetric_ ? numbers(matrix_) : nullptr,
                                 .force = numbers(force_),
                                 .stress = wanted(output_.stress, n_stress, stress_),
                                 .error = errors_.data(),
                                 .previous_displacement = nodal(input_.previous_displacement, from_),
                                 .previous_stress = of_cells(input_.previous_stress, n_stress, from_stress_),
                                 .previous_variable = of_cells(input_.previous_variable, n_variables, from_variable_),
                                 .variable = wanted(output_.variable, n_variables, variable_),
                                 .curve = set_.curve.data(),
                                 .n_curve = static_cast<std::int32_t>(set_.curve.size() / 3),
                                 .n_variables = set_.n_point_variables,
                                 .elastic_matrix = wanted_ == SolidMatrix::elastic,
                                 .stressless_matrix = wanted_ == SolidMatrix::stressless,
                                 .n_unknowns = set_.n_unknowns(),
                                 .whole_matrix = symmetric_ ? nullptr : numbers(matrix_),
                                 .thermal_strain = of_cells(input_.thermal, n_points, thermal_),
                                 .previous_thermal_strain = of_cells(input_.previous_thermal, n_points, from_thermal_)};
    set_.kernel->solid(&call);
    take_results(batch);
    if (call.stress) batch.scatter(stress_, n_stress, output_.stress.subspan(cells.first * n_stress));
    if (call.variable) batch.scatter(variable_, n_variables, output_.variable.subspan(cells.first * n_variables));
  }

 private:
  SolidInput input_;
  SolidMatrix wanted_;
  SolidOutput output_;
  LaneArray coordinates_, displacement_, parameters_, from_, from_stress_, from_variable_, thermal_, from_thermal_, stress_,
      variable_;
};

class LoadBatches : public ElementBatches {
 public:
  LoadBatches(const ElementSet& set, const Mesh& mesh, std::span<const double> coordinates, std::span<const double> values,
              bool with_matrix)
      : ElementBatches(set, mesh, with_matrix), coordinates_(coordinates), values_(values) {}

  void evaluate(const LoopBlock& cells) {
    const int n_values = n_load_values(*set_.kernel);
    const Batch batch(set_, mesh_, cells);
    make_room(batch);
    batch.gather_points(coordinates_, place_);
    batch.gather_cells(values_, static_cast<std::size_t>(set_.tabulation.n_points * n_values), value_);
    const lacon_load_batch call{.struct_size = sizeof(lacon_load_batch),
                                .n_blocks = static_cast<std::int32_t>(batch.n_blocks()),
                                .n_nodes = set_.n_nodes(),
                                .dimension = set_.dimension(),
                                .n_points = set_.tabulation.n_points,
                                .reference_dimension = set_.tabulation.dimension,
                                .n_values = n_values,
                                .shape = set_.tabulation.shape.data(),
                                .gradient = set_.tabulation.gradient.data(),
                                .weight = set_.tabulation.weight.data(),
                                .coordinates = numbers(place_),
                                .value = numbers(value_),
                                .force = numbers(force_),
                                .matrix = numbers(matrix_),
                                .error = errors_.data(),
                                .n_unknowns = set_.n_unknowns()};
    set_.kernel->load(&call);
    take_results(batch);
  }

 private:
  std::span<const double> coordinates_, values_;
  LaneArray place_, value_;
};

}  // namespace

std::optional<std::int32_t> evaluate_solids(const ElementSet& set, const Mesh& mesh, const SolidInput& input,
                                            SolidMatrix matrix, const SolidOutput& output,
                                            const std::function<void(const ElementValues&)>& use) {
  return evaluate_in_turn(set, SolidBatches(set, mesh, input, matrix, output), use);
}

void evaluate_loads(const ElementSet& set, const Mesh& mesh, std::span<const double> coordinates,
                    std::span<const double> values, bool with_matrix, const std::function<void(const ElementValues&)>& use) {
  evaluate_in_turn(set, LoadBatches(set, mesh, coordinates, values, with_matrix), use);
}

int n_load_values(const lacon_kernel& kernel) { return n_names(kernel.parameters); }

std::vector<double> integration_points(const ElementSet& set, const Mesh& mesh, std::span<const double> coordinates) {
  const Tabulation& table = set.tabulation;
  std::vector<double> points(set.cells.size() * table.n_points * 3, 0.0);
  std::size_t at = 0;
  for (const std::int32_t cell : set.cells) {
    const auto nodes = mesh.cells[cell];
    for (int p = 0; p < table.n_points; ++p, at += 3)
      for (int a = 0; a < table.n_nodes; ++a)
        for (int d = 0; d < 3; ++d)
          points[at + d] += table.shape[p * table.n_nodes + a] * coordinates[3 * static_cast<std::size_t>(nodes[a]) + d];
  }
  return points;
}

}  // namespace lacon
