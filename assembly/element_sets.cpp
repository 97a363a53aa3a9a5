#include "lacon/assembly/element_sets.hpp"

#include <algorithm>
#include <map>

#include "lacon/assembly/hardening.hpp"
#include "lacon/catalog/messages.hpp"

namespace lacon {
namespace {

constexpr int lanes = LACON_LANES;
constexpr std::size_t batch_blocks = 32;  // blocks a kernel call: results stay in the cache

const char* reason(int error) {
  switch (error) {
    case LACON_BAD_JACOBIAN:
      return "the Jacobian is zero, negative or of mixed sign";
    case LACON_BAD_PARAMETER:
      return "a material parameter is out of its range";
    case LACON_BAD_BATCH:
      return "the kernel does not serve this kind of element: its catalogue row is wrong";
    case LACON_BAD_RADIUS:
      return "it reaches over the axis of revolution: DX is the radius, which must not be negative";
    case LACON_INSIDE_OUT:
      return "the displacement turns it inside out";
    case LACON_BEYOND_CURVE:
      return "the hardening curve ends before the strain that is reached";
    default:
      return "the result is not a finite number";
  }
}

bool refused(std::int32_t error) { return error != LACON_FINE && error != LACON_INSIDE_OUT; }

[[noreturn]] void refuse_elements(const ElementSet& set, std::span<const std::int32_t> errors,
                                  std::span<const std::int32_t> cells) {
  std::int64_t count = 0;
  std::size_t first = errors.size();
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (refused(errors[i])) {
      first = std::min(first, i);
      ++count;
    }
  fail("ELEMENT_1", {{"count", std::to_string(count)},
                     {"reason", reason(errors[first])},
                     {"cell", cell_name(cells[first])},
                     {"element", std::string(set.row->name)}});
}

/// A batch of cells in lanes: block b, lane l is cells[b * lanes + l]; the last block repeats the last cell.
class Batch {
 public:
  Batch(const ElementSet& set, const Mesh& mesh, std::size_t first, int dimension)
      : set_(set),
        mesh_(mesh),
        first_(first),
        size_(std::min(set.cells.size() - first, batch_blocks * lanes)),
        dimension_(dimension) {}

  std::size_t size() const { return size_; }
  std::size_t n_blocks() const { return (size_ + lanes - 1) / lanes; }
  std::size_t index(std::size_t i) const { return first_ + std::min(i, size_ - 1); }
  std::int32_t cell(std::size_t i) const { return set_.cells[index(i)]; }

  /// (n_blocks, n_nodes, dimension, lanes) out of nodal values (nodes, stride).
  void gather(std::span<const double> nodal, int stride, std::vector<double>& out) const {
    const int n = set_.n_nodes();
    out.resize(n_blocks() * n * dimension_ * lanes);
    for (std::size_t i = 0; i < n_blocks() * lanes; ++i) {
      const auto nodes = mesh_.cells[cell(i)];
      double* const block = out.data() + (i / lanes) * n * dimension_ * lanes + i % lanes;
      for (int k = 0; k < n; ++k)
        for (int d = 0; d < dimension_; ++d)
          block[(k * dimension_ + d) * lanes] = nodal[static_cast<std::size_t>(nodes[k]) * stride + d];
    }
  }
  /// (n_blocks, width, lanes) out of values of each cell of the set (cells, width).
  void gather_cells(std::span<const double> values, int width, std::vector<double>& out) const {
    out.resize(n_blocks() * width * lanes);
    for (std::size_t i = 0; i < n_blocks() * lanes; ++i)
      for (int k = 0; k < width; ++k) out[((i / lanes) * width + k) * lanes + i % lanes] = values[index(i) * width + k];
  }
  /// The `width` values of element i.
  void scatter(std::span<const double> values, std::size_t i, std::size_t width, std::vector<double>& out) const {
    out.resize(width);
    const double* const block = values.data() + (i / lanes) * width * lanes + i % lanes;
    for (std::size_t k = 0; k < width; ++k) out[k] = block[k * lanes];
  }
  /// Throws where a kernel refused an element. @return the first that is turned inside out
  std::optional<std::int32_t> check(std::span<const std::int32_t> errors) const {
    const auto own = errors.first(size_);
    if (std::any_of(own.begin(), own.end(), refused)) refuse_elements(set_, own, std::span(set_.cells).subspan(first_, size_));
    const auto inverted = std::find(own.begin(), own.end(), LACON_INSIDE_OUT);
    if (inverted == own.end()) return std::nullopt;
    return cell(static_cast<std::size_t>(inverted - own.begin()));
  }

 private:
  const ElementSet& set_;
  const Mesh& mesh_;
  std::size_t first_, size_;
  int dimension_;
};

ElementSet make_set(const catalog::ElementRow& row, Registry& registry, std::string_view option, lacon_kernel_kind kind) {
  ElementSet set;
  set.row = &row;
  set.kernel = &registry.kernel(row, option, kind);
  set.tabulation = tabulate(row.cell, integration_rule(catalog::cell(row.cell).family, row.points));
  return set;
}

}  // namespace

const std::variant<double, std::string>* MaterialTable::look_up(std::int32_t cell, std::string_view path) const {
  const auto slash = path.find('/');
  const Material& material = materials_[field_->material[cell]];
  const auto law = material.laws.find(std::string(path.substr(0, slash)));
  if (law == material.laws.end()) return nullptr;
  const auto value = law->second.find(std::string(path.substr(slash + 1)));
  return value == law->second.end() ? nullptr : &value->second;
}

void MaterialTable::missing(std::int32_t cell, std::string_view path, std::string_view element) const {
  fail("ELEMENT_3", {{"material", label(cell)},
                     {"cell", cell_name(cell)},
                     {"parameter", std::string(path)},
                     {"element", std::string(element)}});
}

std::optional<double> MaterialTable::find(std::int32_t cell, std::string_view path) const {
  const auto* value = look_up(cell, path);
  if (!value || !std::holds_alternative<double>(*value)) return std::nullopt;
  return std::get<double>(*value);
}

double MaterialTable::parameter(std::int32_t cell, std::string_view path, std::string_view element) const {
  if (const auto value = find(cell, path)) return *value;
  missing(cell, path, element);
}

const Function& MaterialTable::function(std::int32_t cell, std::string_view path, std::string_view element) const {
  const auto* value = look_up(cell, path);
  const auto* id = value ? std::get_if<std::string>(value) : nullptr;
  const auto at = id ? functions_.find(*id) : functions_.end();
  if (at == functions_.end()) missing(cell, path, element);
  return at->second;
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
  std::vector<ElementSet> sets;
  for (auto& [kind, cells] : by_kind) {
    const catalog::ElementRow& row = *registry.find_element(model.elements[kind.element]);
    const std::string& option = behaviours.options[kind.behaviour];
    ElementSet set = make_set(row, registry, option, LACON_SOLID);
    set.cells = std::move(cells);
    set.linear = !set.kernel->nonlinear;
    if (set.kernel->takes_curve)
      set.curve = hardening_curve(materials, set.cells.front(), option.substr(0, option.find('/')), row.name);
    while (set.kernel->parameters[set.n_parameters]) ++set.n_parameters;
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
  std::vector<ElementSet> sets;
  position.clear();
  for (auto& [element, indices] : by_element) {
    const catalog::ElementRow* row = element < 0 ? nullptr : registry.find_element(model.elements[element]);
    if (!row)
      fail("PLUGIN_4",
           {{"element", element < 0 ? "none, on cell " + cell_name(cells[indices.front()]) : model.elements[element]}});
    ElementSet set = make_set(*row, registry, option, LACON_LOAD);
    for (const std::int32_t i : indices) set.cells.push_back(cells[i]);
    sets.push_back(std::move(set));
    position.push_back(std::move(indices));
  }
  return sets;
}

std::optional<std::int32_t> evaluate_solids(const ElementSet& set, const Mesh& mesh, int dimension, const SolidInput& input,
                                            SolidMatrix wanted, const std::function<void(const SolidValues&)>& use) {
  const int ndof = set.n_nodes() * dimension;
  const std::size_t n_lower = static_cast<std::size_t>(ndof) * (ndof + 1) / 2;
  const std::size_t n_stress = set.n_stress(), n_variables = set.n_variables();
  const bool with_matrix = wanted != SolidMatrix::none;
  std::vector<double> coordinates, u, parameters, from, from_stress, from_variable;
  std::vector<double> matrix, force, stress, variable, own_matrix, own_force, own_stress, own_variable;
  std::vector<std::int32_t> errors;
  std::optional<std::int32_t> inside_out;
  // what is left out, or does not exist, is a null pointer
  const auto pointer = [](std::vector<double>& values, bool given) { return given ? values.data() : nullptr; };
  for (std::size_t first = 0; first < set.cells.size(); first += batch_blocks * lanes) {
    const Batch batch(set, mesh, first, dimension);
    batch.gather(mesh.coordinates, 3, coordinates);
    batch.gather(input.displacement, dimension, u);
    batch.gather_cells(set.parameters, set.n_parameters, parameters);
    if (!input.previous_displacement.empty()) batch.gather(input.previous_displacement, dimension, from);
    if (!input.previous_stress.empty()) batch.gather_cells(input.previous_stress, n_stress, from_stress);
    if (!input.previous_variable.empty()) batch.gather_cells(input.previous_variable, n_variables, from_variable);
    const std::size_t padded = batch.n_blocks() * lanes;
    if (with_matrix) matrix.resize(padded * n_lower);
    force.resize(padded * ndof);
    stress.resize(padded * n_stress);
    variable.resize(padded * n_variables);
    errors.assign(padded, LACON_FINE);
    const lacon_solid_batch call{.struct_size = sizeof(lacon_solid_batch),
                                 .n_blocks = static_cast<std::int32_t>(batch.n_blocks()),
                                 .n_nodes = set.n_nodes(),
                                 .dimension = dimension,
                                 .n_points = set.tabulation.n_points,
                                 .n_stress = static_cast<std::int32_t>(set.row->stress.size()),
                                 .n_parameters = set.n_parameters,
                                 .shape = set.tabulation.shape.data(),
                                 .gradient = set.tabulation.gradient.data(),
                                 .weight = set.tabulation.weight.data(),
                                 .coordinates = coordinates.data(),
                                 .displacement = u.data(),
                                 .parameter = parameters.data(),
                                 .matrix = pointer(matrix, with_matrix),
                                 .force = force.data(),
                                 .stress = stress.data(),
                                 .error = errors.data(),
                                 .previous_displacement = pointer(from, !input.previous_displacement.empty()),
                                 .previous_stress = pointer(from_stress, !input.previous_stress.empty()),
                                 .previous_variable = pointer(from_variable, !input.previous_variable.empty()),
                                 .variable = pointer(variable, n_variables > 0),
                                 .curve = set.curve.data(),
                                 .n_curve = static_cast<std::int32_t>(set.curve.size() / 3),
                                 .n_variables = set.kernel->n_variables,
                                 .elastic_matrix = wanted == SolidMatrix::elastic,
                                 .stressless_matrix = wanted == SolidMatrix::stressless};
    set.kernel->solid(&call);
    const auto inverted = batch.check(errors);
    if (!inside_out) inside_out = inverted;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (with_matrix) batch.scatter(matrix, i, n_lower, own_matrix);
      batch.scatter(force, i, ndof, own_force);
      batch.scatter(stress, i, n_stress, own_stress);
      batch.scatter(variable, i, n_variables, own_variable);
      use({batch.cell(i), own_matrix, own_force, own_stress, own_variable});
    }
  }
  return inside_out;
}

int n_load_values(const lacon_kernel& kernel) {
  int count = 0;
  while (kernel.parameters[count]) ++count;
  return count;
}

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

void evaluate_loads(const ElementSet& set, const Mesh& mesh, int dimension, std::span<const double> coordinates,
                    std::span<const double> values, bool with_matrix, const std::function<void(const LoadValues&)>& use) {
  const std::size_t ndof = static_cast<std::size_t>(set.n_nodes()) * dimension, n_lower = ndof * (ndof + 1) / 2;
  const int n_values = n_load_values(*set.kernel), width = set.tabulation.n_points * n_values;
  std::vector<double> place, value, force, matrix, own_force, own_matrix;
  std::vector<std::int32_t> errors;
  for (std::size_t first = 0; first < set.cells.size(); first += batch_blocks * lanes) {
    const Batch batch(set, mesh, first, dimension);
    batch.gather(coordinates, 3, place);
    batch.gather_cells(values, width, value);
    const std::size_t padded = batch.n_blocks() * lanes;
    force.resize(padded * ndof);
    if (with_matrix) matrix.resize(padded * n_lower);
    errors.assign(padded, LACON_FINE);
    const lacon_load_batch call{.struct_size = sizeof(lacon_load_batch),
                                .n_blocks = static_cast<std::int32_t>(batch.n_blocks()),
                                .n_nodes = set.n_nodes(),
                                .dimension = dimension,
                                .n_points = set.tabulation.n_points,
                                .reference_dimension = set.tabulation.dimension,
                                .n_values = n_values,
                                .shape = set.tabulation.shape.data(),
                                .gradient = set.tabulation.gradient.data(),
                                .weight = set.tabulation.weight.data(),
                                .coordinates = place.data(),
                                .value = value.data(),
                                .force = force.data(),
                                .matrix = with_matrix ? matrix.data() : nullptr,
                                .error = errors.data()};
    set.kernel->load(&call);
    batch.check(errors);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      batch.scatter(force, i, ndof, own_force);
      if (with_matrix) batch.scatter(matrix, i, n_lower, own_matrix);
      use({batch.cell(i), own_force, own_matrix});
    }
  }
}

}  // namespace lacon
