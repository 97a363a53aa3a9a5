#include "lacon/operators/crea_champ/crea_champ.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/crea_champ/field_of_table.hpp"
#include "lacon/operators/fields/course.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/internal_variables.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/program/study_function.hpp"
#include "lacon/pairing/normals.hpp"

namespace lacon {
namespace {

/// What an order is about: the field's type, and the mesh and model it is on.
class Task {
 public:
  Task(const Order& order, const Base& base)
      : order_(order), base_(base), type_(field_type(order.keywords.text("TYPE_CHAM"))) {}

  const Keywords& keywords() const { return order_.keywords; }
  const Base& base() const { return base_; }
  const FieldType& type() const { return type_; }
  bool zero_elsewhere() const {
    return keywords().yes("PROL_ZERO") && type_.location != Location::nodes && !type_.of_functions();
  }

  /// The mesh and the model that the keywords name; with neither, the mesh `otherwise`. Throws CREACHAMP_5 where they differ.
  const Ground& ground(const std::string& otherwise = {}) {
    if (ground_) return *ground_;
    const auto mesh = keywords().optional_concept("MAILLAGE"), model = keywords().optional_concept("MODELE");
    if (model) model_ = base_.model(*model);
    mesh_id_ = model ? model_.mesh : mesh ? *mesh : otherwise;
    if (mesh_id_.empty()) fail("CREACHAMP_6", {{"operation", keywords().text("OPERATION")}});
    for (const std::string& other : {mesh.value_or(mesh_id_), otherwise.empty() ? mesh_id_ : otherwise})
      check_same_mesh(base_, mesh_id_, other);
    mesh_ = base_.mesh(mesh_id_);
    if (model) {
      registry_ = std::make_unique<Registry>(order_.plugins);
      points_.emplace(mesh_, model_, *registry_);
      ground_.emplace(mesh_, *points_);
    } else {
      ground_.emplace(mesh_);
    }
    return *ground_;
  }
  const std::string& mesh_id() const { return mesh_id_; }

  /// A field that a keyword names; it must be on the ground's mesh.
  Field field(const Keywords& at, std::string_view keyword) {
    const std::string id = at.concept_id(keyword);
    Field found = base_.field(id);
    ground(found.mesh);
    check_same_mesh(base_, mesh_id_, found.mesh);
    found.name = base_.label(id);
    return found;
  }

  /// Whether the field is VARI_ELGA, and a result of stresses has none because its laws have no internal variables.
  bool has_zero_variables(const Result& result, const std::string& name) const {
    if (name != "VARI_ELGA" || result.fields.contains(name) || !result.fields.contains("SIEF_ELGA")) return false;
    Registry registry(order_.plugins);
    return !laws_have_variables(base_, result, registry);
  }

  /// One entry a node or cell: 1 where an occurrence means it.
  std::vector<char> selected(const Keywords& factor) {
    return selected_places(ground().mesh(), factor, type_.location, type_.text);
  }

 private:
  const Order& order_;
  const Base& base_;
  FieldType type_;
  std::string mesh_id_;
  Mesh mesh_;
  Model model_;
  std::unique_ptr<Registry> registry_;
  std::optional<ModelPoints> points_;
  std::optional<Ground> ground_;
};

std::string place_name(const Field& field, std::size_t i) {
  return field.location == Location::nodes ? "node " + node_name(field.support[i]) : "cell " + cell_name(field.support[i]);
}

void set_presence(Field& field, std::size_t row, std::size_t component, Field::Presence presence = Field::there) {
  field.present[row * field.n_components() + component] = presence;
}

[[noreturn]] void refuse_type(const Field& field, const FieldType& wanted) {
  fail("CREACHAMP_9", {{"field", field.name}, {"type", type_of(field)}, {"wanted", wanted.text}});
}

void check_type(const Field& field, const FieldType& wanted) {
  if (field.location != wanted.location || field.quantity != wanted.quantity) refuse_type(field, wanted);
}

/// What is made piece by piece: 0 on all the model where that is asked for, else without what nothing was said about.
Field finished(const Task& task, Field&& field) {
  if (task.zero_elsewhere()) zero_where_absent(field);
  return without_empty_rows(field);
}

/// The components of all occurrences, in the order in which they first appear.
void add_names(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& name : more)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::size_t column(const Field& field, std::string_view component) {
  return static_cast<std::size_t>(field.component(component));
}

/// A field of vectors at nodes. @param values (n_nodes of the mesh, 3)
Field geometry(const Mesh& mesh, std::vector<std::int32_t> nodes, std::span<const double> values) {
  Field field{.quantity = "GEOM_R", .location = Location::nodes, .components = {"X", "Y"}, .support = std::move(nodes)};
  if (mesh.dimension == 3) field.components.emplace_back("Z");
  for (const std::int32_t node : field.support)
    for (std::size_t axis = 0; axis < field.n_components(); ++axis)
      field.values.push_back(values[static_cast<std::size_t>(node) * 3 + axis]);
  return field;
}

/// Calls use(row, component) for every value that exists.
void each_value(const Field& field, const std::function<void(std::size_t, std::size_t)>& use) {
  for (std::size_t row = 0; row < field.n_rows(); ++row)
    for (std::size_t c = 0; c < field.n_components(); ++c)
      if (field.has(row, c)) use(row, c);
}

/// What TYPE_MAXI compares: one measure a value, the largest of which counts.
std::vector<double> measures(const Field& field, const std::string& kind) {
  std::vector<double> found(field.values.size());
  const double sign = kind.starts_with("MINI") ? -1 : 1;
  for (std::size_t k = 0; k < found.size(); ++k)
    found[k] = sign * (kind.ends_with("_ABS") ? std::abs(field.values[k]) : field.values[k]);
  if (kind != "NORM_TRAN") return found;
  for (std::size_t row = 0; row < field.n_rows(); ++row) {
    double square = 0;
    for (const char* axis : {"DX", "DY", "DZ"})
      if (const int c = field.component(axis); c >= 0 && field.has(row, static_cast<std::size_t>(c)))
        square += field.at(row, static_cast<std::size_t>(c)) * field.at(row, static_cast<std::size_t>(c));
    std::fill_n(found.begin() + static_cast<std::ptrdiff_t>(row * field.n_components()), field.n_components(), square);
  }
  return found;
}

void check_same_places(const Field& field, const Field& other, const Result& result, const std::string& name) {
  if (!on_the_same_places(field, other))
    fail("CREACHAMP_16", {{"field", name}, {"label", result.label}, {"order", std::to_string(field.order)}});
}

/// The extreme of each value over the instants, the first of several; a stand-in only where it is one at every instant.
Field extreme(Task& task, const Result& result, const std::vector<std::int64_t>& orders, const std::string& name) {
  const std::string kind = task.keywords().text("TYPE_MAXI");
  const bool instants = task.keywords().text("TYPE_RESU") == "INST";
  Field best = task.base().field(result, name, orders.empty() ? 0 : orders.front());
  if (kind == "NORM_TRAN" && best.component("DX") < 0)
    fail("CREACHAMP_14", {{"keyword", "TYPE_MAXI"},
                          {"component", "DX"},
                          {"field", name},
                          {"known", fmt::format("{}", fmt::join(best.components, ", "))}});
  std::vector<double> largest(best.values.size(), -std::numeric_limits<double>::infinity());
  best.present.assign(best.values.size(), 0);
  for (const std::int64_t order : orders) {
    const Field field = task.base().field(result, name, order);
    check_same_places(field, best, result, name);
    const std::vector<double> measure = measures(field, kind);
    each_value(field, [&](std::size_t row, std::size_t c) {
      const std::size_t k = row * field.n_components() + c;
      const Field::Presence presence = field.presence(row, c), so_far = static_cast<Field::Presence>(best.present[k]);
      if (so_far == presence ? !(measure[k] > largest[k]) : so_far != Field::absent && so_far < presence) return;
      largest[k] = measure[k];
      best.values[k] = instants ? field.instant : kind.ends_with("_ABS") ? std::abs(field.values[k]) : field.values[k];
      set_presence(best, row, c, presence);
    });
  }
  put_markers(best);
  return best;
}

/// INTERPOL='LIN': on the line between the instants beside INST that have the field; nothing where INST is one of them, or not
/// between any.
std::optional<Field> interpolated(Task& task, const Result& result, const std::string& name) {
  const Keywords& keywords = task.keywords();
  if (keywords.text("INTERPOL") != "LIN" || !keywords.has("INST") || keywords.has("TYPE_MAXI")) return std::nullopt;
  const double wanted = keywords.reals("INST").front(), precision = keywords.real("PRECISION"),
               slack = keywords.text("CRITERE") == "RELATIF" ? precision * std::abs(wanted) : precision;
  const std::vector<FieldInstant> course = course_of(result, name);
  if (std::ranges::any_of(course, [&](const FieldInstant& one) { return std::abs(one.instant - wanted) <= slack; }))
    return std::nullopt;
  const auto behind = std::ranges::lower_bound(course, wanted, {}, &FieldInstant::instant);
  if (behind == course.begin() || behind == course.end()) return std::nullopt;
  const FieldInstant before = *(behind - 1);
  Field field = task.base().field(result, name, before.order);
  const Field next = task.base().field(result, name, behind->order);
  check_same_places(next, field, result, name);
  return between(std::move(field), next, (wanted - before.instant) / (behind->instant - before.instant));
}

/// A field of a result: at one instant, between two, or extremes over several.
Field of_result(Task& task, const Result& result, const std::string& name) {
  const Keywords& keywords = task.keywords();
  if (std::optional<Field> between = interpolated(task, result, name)) return std::move(*between);
  std::vector<std::int64_t> orders;
  if (names_instants(keywords))
    orders = selected_orders(task.base(), result, keywords);
  else if (const auto files = result.fields.find(name); files != result.fields.end())
    for (const auto& [order, file] : files->second) orders.push_back(order);
  if (keywords.has("TYPE_MAXI")) return extreme(task, result, orders, name);
  if (orders.size() > 1)
    fail("CREACHAMP_8", {{"field", name}, {"label", result.label}, {"orders", fmt::format("{}", fmt::join(orders, ", "))}});
  return task.base().field(result, name, orders.empty() ? 0 : orders.front());
}

Field extract(Task& task) {
  const Keywords& keywords = task.keywords();
  if (keywords.has("TABLE"))
    return finished(task, field_of_table(task.base().table(keywords.concept_id("TABLE")), task.ground(), task.type()));
  const std::string name = keywords.text("NOM_CHAM");
  Field field;
  if (!keywords.has("RESULTAT")) {
    if (name != "GEOMETRIE") fail("CREACHAMP_6", {{"operation", "EXTR of " + name}});
    const Mesh& mesh = task.ground().mesh();
    field = geometry(mesh, Ground(mesh).rows(Location::nodes).first, mesh.coordinates);
    field.name = name;
  } else {
    const Result result = task.base().result(keywords.concept_id("RESULTAT"));
    const bool zero = task.has_zero_variables(result, name);
    field = of_result(task, result, zero ? "SIEF_ELGA" : name);
    if (zero) field = zero_variables(std::move(field));
    task.ground(field.mesh);
  }
  check_type(field, task.type());
  return field;
}

Field affect(Task& task) {
  const std::vector<Keywords> factors = task.keywords().factors("AFFE");
  const bool functions = task.type().of_functions();
  std::vector<std::string> names;
  for (const Keywords& one : factors) {
    for (const std::string& name : one.texts("NOM_CMP")) check_component(task.type(), name, one.path("NOM_CMP"));
    add_names(names, one.texts("NOM_CMP"));
    if (one.has("VALE_F") != functions)
      fail("CREACHAMP_10", {{"keyword", one.path(functions ? "VALE" : "VALE_F")}, {"type", task.type().text}});
    const std::size_t count = functions ? one.concept_ids("VALE_F").size() : one.reals("VALE").size();
    if (count != one.texts("NOM_CMP").size())
      fail("CREACHAMP_11", {{"keyword", one.path(functions ? "VALE_F" : "VALE")},
                            {"found", std::to_string(count)},
                            {"wanted", std::to_string(one.texts("NOM_CMP").size())}});
  }
  Field field = empty_field(task.ground(), task.type(), names);
  for (const Keywords& one : factors) {
    std::vector<double> values;
    if (functions)
      for (const std::string& id : one.concept_ids("VALE_F")) {
        const auto at = std::find(field.functions.begin(), field.functions.end(), id);
        values.push_back(static_cast<double>(at - field.functions.begin()));
        if (at == field.functions.end()) field.functions.push_back(id);
      }
    else
      values = one.reals("VALE");
    const std::vector<char> wanted = task.selected(one);
    const std::vector<std::string> components = one.texts("NOM_CMP");
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      if (!wanted[static_cast<std::size_t>(field.support[i])]) continue;
      for (std::size_t row = field.first_row(i); row < field.first_row(i + 1); ++row)
        for (std::size_t k = 0; k < components.size(); ++k) {
          const std::size_t c = column(field, components[k]);
          field.at(row, c) = values[k];
          set_presence(field, row, c);
        }
    }
  }
  return finished(task, std::move(field));
}

/// A component of the parameters' fields, found by the place it is asked for at.
struct Parameter {
  const Field* field;
  std::size_t component;
  std::vector<std::int64_t> place;
};

Field evaluate(Task& task) {
  const Field functions = task.field(task.keywords(), "CHAM_F");
  const Mesh& mesh = task.ground().mesh();
  if (functions.functions.empty() && !functions.quantity.ends_with("_F"))
    fail("CREACHAMP_12", {{"field", functions.name}, {"keyword", "CHAM_F"}});
  if (functions.location != task.type().location) refuse_type(functions, task.type());
  std::vector<Field> given;
  for (const std::string& id : task.keywords().concept_ids("CHAM_PARA")) {
    given.push_back(task.base().field(id));
    given.back().name = task.base().label(id);
    check_same_mesh(task.base(), functions.mesh, given.back().mesh);
    if (given.back().location != functions.location || given.back().quantity.ends_with("_F"))
      fail("CREACHAMP_12", {{"field", given.back().name}, {"keyword", "CHAM_PARA"}});
  }
  const std::size_t count = functions.location == Location::nodes ? mesh.n_nodes() : mesh.n_cells();
  std::map<std::string, Parameter> parameters;
  for (const Field& field : given)
    for (std::size_t c = 0; c < field.n_components(); ++c)
      parameters.try_emplace(field.components[c], Parameter{&field, c, places(field, count)});

  Field result = functions;
  std::vector<std::size_t> stand_ins;  // values of `result` that come of one
  result.functions.clear();
  result.quantity = task.type().quantity;
  for (const std::string& name : result.components) check_component(task.type(), name, "CHAM_F");
  for (std::size_t f = 0; f < functions.functions.size(); ++f) {
    const StudyFunction function(task.base(), functions.functions[f]);
    std::vector<std::string_view> known;
    for (const auto& [name, parameter] : parameters) known.push_back(name);
    function.check_parameters(known, "CHAM_PARA");
    std::vector<std::pair<std::size_t, std::size_t>> cells;  // row and component in `result`
    std::vector<std::vector<double>> columns(function.parameters().size());
    for (std::size_t i = 0; i < functions.support.size(); ++i)
      for (std::size_t row = functions.first_row(i); row < functions.first_row(i + 1); ++row)
        for (std::size_t c = 0; c < functions.n_components(); ++c) {
          if (!functions.has(row, c) || functions.at(row, c) != static_cast<double>(f)) continue;
          cells.emplace_back(row, c);
          for (std::size_t p = 0; p < columns.size(); ++p) {
            const Parameter& parameter = parameters.at(function.parameters()[p]);
            const std::int64_t at = parameter.place[static_cast<std::size_t>(functions.support[i])];
            const std::size_t source =
                at < 0 ? 0 : parameter.field->first_row(static_cast<std::size_t>(at)) + row - functions.first_row(i);
            if (at < 0 || source >= parameter.field->first_row(static_cast<std::size_t>(at) + 1) ||
                !parameter.field->has(source, parameter.component))
              fail("CREACHAMP_13", {{"function", function.label()},
                                    {"parameter", function.parameters()[p]},
                                    {"place", place_name(functions, i)}});
            columns[p].push_back(parameter.field->at(source, parameter.component));
            if (!parameter.field->counts(source, parameter.component)) stand_ins.push_back(row * result.n_components() + c);
          }
        }
    std::vector<ParameterValues> values;
    for (std::size_t p = 0; p < columns.size(); ++p) values.push_back({function.parameters()[p], columns[p]});
    const std::vector<double> found = function.values(cells.size(), values);
    for (std::size_t k = 0; k < cells.size(); ++k) result.at(cells[k].first, cells[k].second) = found[k];
  }
  if (!stand_ins.empty() && result.present.empty()) result.present.assign(result.values.size(), Field::there);
  for (const std::size_t k : stand_ins) result.present[k] = Field::stand_in;
  return result;
}

Field assemble(Task& task) {
  struct Part {
    Field field;
    std::vector<std::pair<std::size_t, std::string>> columns;  ///< component of the field, name in the result
  };
  const std::vector<Keywords> factors = task.keywords().factors("ASSE");
  std::vector<Part> parts;
  std::vector<std::string> names;
  for (const Keywords& one : factors) {
    Part part{task.field(one, "CHAM_GD"), {}};
    const std::vector<std::string> from = one.has("NOM_CMP") ? one.texts("NOM_CMP") : part.field.components;
    const std::vector<std::string> to = one.has("NOM_CMP_RESU") ? one.texts("NOM_CMP_RESU") : from;
    if (to.size() != from.size())
      fail("CREACHAMP_11", {{"keyword", one.path("NOM_CMP_RESU")},
                            {"found", std::to_string(to.size())},
                            {"wanted", std::to_string(from.size())}});
    if (part.field.location != task.type().location &&
        !(part.field.location == Location::cells && task.type().location != Location::nodes))
      refuse_type(part.field, task.type());
    if (part.field.quantity.ends_with("_F"))
      fail("CREACHAMP_12", {{"field", part.field.name}, {"keyword", one.path("CHAM_GD")}});
    for (std::size_t k = 0; k < from.size(); ++k) {
      const int at = part.field.component(from[k]);
      if (at < 0)
        fail("CREACHAMP_14", {{"keyword", one.path("NOM_CMP")},
                              {"component", from[k]},
                              {"field", part.field.name},
                              {"known", fmt::format("{}", fmt::join(part.field.components, ", "))}});
      check_component(task.type(), to[k], one.path("NOM_CMP_RESU"));
      part.columns.emplace_back(static_cast<std::size_t>(at), to[k]);
    }
    add_names(names, to);
    parts.push_back(std::move(part));
  }
  Field field = empty_field(task.ground(), task.type(), names);
  const std::size_t count = field.location == Location::nodes ? task.ground().mesh().n_nodes() : task.ground().mesh().n_cells();
  for (std::size_t f = 0; f < factors.size(); ++f) {
    const Field& from = parts[f].field;
    const bool one_row = from.location == Location::cells;
    const std::vector<std::int64_t> place = places(from, count);
    const std::vector<char> wanted = task.selected(factors[f]);
    const double factor = factors[f].real("COEF_R");
    const bool adds = factors[f].yes("CUMUL");
    for (std::size_t i = 0; i < field.support.size(); ++i) {
      const auto owner = static_cast<std::size_t>(field.support[i]);
      if (!wanted[owner] || place[owner] < 0) continue;
      const std::size_t first = from.first_row(static_cast<std::size_t>(place[owner]));
      const std::size_t rows = field.first_row(i + 1) - field.first_row(i);
      if (!one_row && from.first_row(static_cast<std::size_t>(place[owner]) + 1) - first != rows)
        fail("CREACHAMP_4", {{"field", from.name}, {"cell", cell_name(field.support[i])}});
      for (std::size_t k = 0; k < rows; ++k)
        for (const auto& [component, name] : parts[f].columns) {
          const std::size_t source = one_row ? first : first + k, row = field.first_row(i) + k, c = column(field, name);
          if (!from.has(source, component)) continue;
          const Field::Presence added = taken(from.presence(source, component), factor);
          field.at(row, c) = (adds ? field.at(row, c) : 0.0) + factor * from.at(source, component);
          set_presence(field, row, c, adds && field.has(row, c) ? made_of(field.presence(row, c), added) : added);
        }
    }
  }
  put_markers(field);
  return finished(task, std::move(field));
}

Field discretise(Task& task) {
  const Field from = task.field(task.keywords(), "CHAM_GD");
  if (from.quantity != task.type().quantity || from.quantity.ends_with("_F")) refuse_type(from, task.type());
  return moved_to(task.ground(), from, task.type(), task.zero_elsewhere());
}

bool exist_alike(const Field& a, const Field& b) {
  if (a.present == b.present) return true;
  for (std::size_t row = 0; row < a.n_rows(); ++row)
    for (std::size_t c = 0; c < a.n_components(); ++c)
      if (a.has(row, c) != b.has(row, c)) return false;
  return true;
}

/// The fields of COMB must have the first one's quantity, location, components and rows. With a stand-in or a marker a sum is
/// one.
Field combine(Task& task) {
  Field sum;
  bool first = true;
  for (const Keywords& one : task.keywords().factors("COMB")) {
    Field field = task.field(one, "CHAM_GD");
    const double factor = one.real("COEF_R");
    for (std::uint8_t& presence : field.present) presence = taken(static_cast<Field::Presence>(presence), factor);
    if (first) {
      check_type(field, task.type());
      sum = field;
      for (double& value : sum.values) value *= factor;
      first = false;
      continue;
    }
    if (field.location != sum.location || field.quantity != sum.quantity || field.components != sum.components ||
        field.support != sum.support || field.offset != sum.offset || !exist_alike(field, sum))
      fail("CREACHAMP_15", {{"keyword", one.path("CHAM_GD")}, {"field", field.name}, {"first", sum.name}});
    if (sum.present.empty()) sum.present = field.present;
    for (std::size_t k = 0; k < field.present.size(); ++k)
      sum.present[k] = made_of(static_cast<Field::Presence>(sum.present[k]), static_cast<Field::Presence>(field.present[k]));
    for (std::size_t k = 0; k < sum.values.size(); ++k) sum.values[k] += factor * field.values[k];
  }
  put_markers(sum);
  return sum;
}

Field normals(Task& task) {
  const Mesh& mesh = task.ground().mesh();
  const std::vector<std::int32_t> skin = selected_skin(mesh, task.keywords());
  Field field = geometry(mesh, nodes_of_cells(mesh, skin), nodal_normals(surface_of(mesh, skin, mesh.coordinates)));
  field.name = "NORMALE";
  check_type(field, task.type());
  return field;
}

}  // namespace

void crea_champ(const Order& order, const Base& base) {
  static const std::map<std::string, Field (*)(Task&)> operations{{"EXTR", extract},   {"AFFE", affect},     {"EVAL", evaluate},
                                                                  {"ASSE", assemble},  {"DISC", discretise}, {"COMB", combine},
                                                                  {"NORMALE", normals}};
  Task task(order, base);
  Field field = operations.at(order.keywords.text("OPERATION"))(task);
  field.name = order.result_label;
  field.mesh = task.mesh_id();
  base.store(field);
}

}  // namespace lacon
