#include "lacon/operators/evolution/observers/observation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>
#include <numeric>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/names.hpp"

namespace lacon {

// ---------------------------------------------------------------------------------------------- instants

ChosenInstants::ChosenInstants(const Keywords& keywords, const Base& base, std::string_view steps)
    : every_(keywords.has(steps) ? keywords.integer(steps) : 1),
      listed_(keywords.has("LIST_INST") || keywords.has("INST")),
      instants_(keywords.has("LIST_INST") ? base.list_of_reals(keywords.concept_id("LIST_INST")) : keywords.reals("INST")),
      precision_(keywords.real("PRECISION")),
      relative_(keywords.text("CRITERE") == "RELATIF") {}

bool ChosenInstants::has(double instant, std::int64_t step) const {
  if (!listed_) return step % every_ == 0;
  return std::any_of(instants_.begin(), instants_.end(), [&](double listed) { return is_at(instant, listed); });
}

bool ChosenInstants::is_at(double instant, double listed) const {
  return std::abs(instant - listed) <= precision_ * (relative_ ? std::abs(listed) : 1.0);
}

std::vector<double> ChosenInstants::missing(std::span<const double> steps) const {
  std::vector<double> found;
  std::ranges::copy_if(instants_, std::back_inserter(found), [&](double listed) {
    return listed > steps.front() && listed < steps.back() &&
           std::ranges::none_of(steps, [&](double instant) { return is_at(instant, listed); });
  });
  return found;
}

void tell_missing_instants(const Keywords& keywords, const Base& base, std::span<const double> steps) {
  for (const auto& [name, every] : {std::pair("ARCHIVAGE", "PAS_ARCH"), std::pair("OBSERVATION", "PAS_OBSE")})
    for (const Keywords& occurrence : keywords.factors(name)) {
      const std::vector<double> missing = ChosenInstants(occurrence, base, every).missing(steps);
      if (!missing.empty())
        inform("EVOLUTION_56", {{"keyword", occurrence.path(occurrence.has("INST") ? "INST" : "LIST_INST")},
                                {"count", std::to_string(missing.size())},
                                {"instant", fmt::format("{:.9g}", missing.front())}});
    }
}

// ---------------------------------------------------------------------------------------------- one observer

namespace {

/// What EVAL_CHAM and EVAL_ELGA make of several values.
double reduce(const std::string& how, const std::vector<double>& values) {
  const auto magnitude = [](double a, double b) { return std::abs(a) < std::abs(b); };
  if (how == "MIN") return *std::min_element(values.begin(), values.end());
  if (how == "MAX") return *std::max_element(values.begin(), values.end());
  if (how == "MINI_ABS") return std::abs(*std::min_element(values.begin(), values.end(), magnitude));
  if (how == "MAXI_ABS") return std::abs(*std::max_element(values.begin(), values.end(), magnitude));
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());  // MOY
}

/// One value for each component, in the order in which they appear; its place is `place`. Stand-ins only where nothing else is.
std::vector<Observer::Value> reduce_by_component(const std::string& how, const std::vector<Observer::Value>& values,
                                                 Observer::Value place) {
  struct Column {
    std::string component;
    std::vector<double> values, stand_ins;
  };
  std::vector<Column> columns;
  for (const Observer::Value& value : values) {
    auto column = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.component == value.component; });
    if (column == columns.end()) column = columns.insert(columns.end(), {value.component, {}, {}});
    (value.presence != Field::there ? column->stand_ins : column->values).push_back(value.value);
  }
  std::vector<Observer::Value> reduced;
  for (const Column& column : columns) {
    place.component = column.component;
    place.presence = column.values.empty() ? Field::stand_in : Field::there;
    place.value = reduce(how, column.values.empty() ? column.stand_ins : column.values);
    reduced.push_back(place);
  }
  return reduced;
}

/// One entry for each node (letter N) or cell (M): not 0 where the keyword names it.
void mark_names(const Mesh& mesh, const Keywords& keywords, std::string_view keyword, char letter, std::vector<char>& marked) {
  for (const std::string& name : keywords.texts(keyword)) {
    const auto number = find_by_name(mesh, name, letter == 'N' ? Entity::node : Entity::cell);
    if (!number)
      fail("OBSERVATION_5", {{"keyword", keywords.path(keyword)},
                             {"name", name},
                             {"last", fmt::format("{}{}", letter, marked.size())},
                             {"first", fmt::format("{}1", letter)}});
    marked[static_cast<std::size_t>(*number)] = 1;
  }
}

}  // namespace

Observer::Observer(const Keywords& keywords, const Base& base, const Mesh& mesh, std::string name)
    : keywords_(keywords), name_(std::move(name)), nodes_(mesh.n_nodes(), 0), cells_(mesh.n_cells(), 0) {
  const bool somewhere =
      keywords.has("NOEUD") || keywords.has("GROUP_NO") || keywords.has("MAILLE") || keywords.has("GROUP_MA");
  mark_names(mesh, keywords, "NOEUD", 'N', nodes_);
  mark_names(mesh, keywords, "MAILLE", 'M', cells_);
  for (const std::string& group : keywords.texts("GROUP_NO"))
    for (const std::int32_t node : nodes_of_group(mesh, group, keywords.path("GROUP_NO"))) nodes_[node] = 1;
  for (const std::string& group : keywords.texts("GROUP_MA"))
    for (const std::int32_t cell : cells_of_group(mesh, group, keywords.path("GROUP_MA"))) cells_[cell] = 1;
  if (!somewhere) std::fill(cells_.begin(), cells_.end(), 1);
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
    if (cells_[cell])
      for (const std::int32_t node : mesh.cells[cell]) nodes_[node] = 1;
  if (keywords.text("EVAL_CMP") == "FORMULE") formula_.emplace(base, keywords.concept_id("FORMULE"));
}

void Observer::check_place(const Field& field) const {
  const bool on_nodes = field.location == Location::nodes;
  const auto refuse = [&](std::string_view keyword, const std::string& needed) {
    fail("OBSERVATION_3", {{"keyword", keywords_.path(keyword)}, {"field", field.name}, {"needed", needed}});
  };
  for (const std::string_view keyword : {"NOEUD", "GROUP_NO"})
    if (!on_nodes && keywords_.has(keyword)) refuse(keyword, part("cells_wanted"));
  if (field.offset.empty() && keywords_.has("POINT")) refuse("POINT", part("no_point_wanted"));
  if (!field.offset.empty() && !keywords_.has("POINT") && keywords_.text("EVAL_ELGA") == "VALE")
    refuse("EVAL_ELGA='VALE'", part("point_wanted"));
}

std::vector<std::size_t> Observer::components_of(const Field& field) const {
  std::vector<std::size_t> components;
  const std::vector<std::string>& wanted = formula_ ? formula_->parameters() : keywords_.texts("NOM_CMP");
  for (const std::string& name : wanted) {
    const int component = field.component(name);
    if (component < 0)
      fail("OBSERVATION_2", {{"keyword", keywords_.path(formula_ ? "FORMULE" : "NOM_CMP")},
                             {"field", field.name},
                             {"component", name},
                             {"known", fmt::format("{}", fmt::join(field.components, ", "))}});
    components.push_back(static_cast<std::size_t>(component));
  }
  return components;
}

void Observer::collect_row(const Field& field, const std::vector<std::size_t>& components, std::size_t row, const Value& place,
                           std::vector<Value>& values) const {
  const auto there = [&](std::size_t component) { return field.has(row, component); };
  if (formula_ && !std::all_of(components.begin(), components.end(), there)) return;  // a formula needs them all
  for (const std::size_t component : components)
    if (there(component)) {
      values.push_back(place);
      values.back().component = field.components[component];
      values.back().value = field.at(row, component);
      values.back().presence = field.presence(row, component);
    }
}

std::vector<Observer::Value> Observer::of_formula(const std::vector<Value>& values) const {
  const std::size_t width = formula_->parameters().size(), count = values.size() / width;
  std::vector<std::vector<double>> columns(width);
  for (std::size_t i = 0; i < values.size(); ++i) columns[i % width].push_back(values[i].value);
  std::vector<ParameterValues> parameters;
  for (std::size_t k = 0; k < width; ++k) parameters.push_back({formula_->parameters()[k], columns[k]});
  const std::vector<double> results = formula_->values(count, parameters);
  std::vector<Value> made;
  for (std::size_t i = 0; i < count; ++i) {
    made.push_back(values[i * width]);
    made.back().component.clear();
    made.back().value = results[i];
    for (std::size_t k = 0; k < width; ++k)
      made.back().presence = made_of(made.back().presence, values[i * width + k].presence);
  }
  return made;
}

std::vector<Observer::Value> Observer::of_cell(const Field& field, const std::vector<std::size_t>& components,
                                               std::size_t i) const {
  const std::int32_t cell = field.support[i];
  const std::int64_t n_points = field.offset[i + 1] - field.offset[i];
  const std::vector<std::int64_t> points = keywords_.integers("POINT");
  std::vector<Value> values;
  const auto add = [&](std::int64_t point) {
    const Value place{.cell = cell, .point = static_cast<std::int32_t>(point), .value = 0};
    collect_row(field, components, static_cast<std::size_t>(field.offset[i] + point), place, values);
  };
  for (const std::int64_t point : points) {
    if (point > n_points)
      fail("OBSERVATION_6", {{"keyword", keywords_.path("POINT")},
                             {"point", std::to_string(point)},
                             {"field", field.name},
                             {"cell", cell_name(cell)},
                             {"count", std::to_string(n_points)}});
    add(point - 1);
  }
  for (std::int64_t point = 0; points.empty() && point < n_points; ++point) add(point);
  if (formula_ && !values.empty()) values = of_formula(values);
  const std::string how = keywords_.text("EVAL_ELGA");
  return how == "VALE" || how == "EACH" ? values : reduce_by_component(how, values, {.cell = cell, .value = 0});
}

std::vector<Observer::Value> Observer::collect(const Field& field) const {
  const std::vector<std::size_t> components = components_of(field);
  const bool on_nodes = field.location == Location::nodes;
  std::vector<Value> values;
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    const std::int32_t entity = field.support[i];
    if (!(on_nodes ? nodes_ : cells_)[static_cast<std::size_t>(entity)]) continue;
    if (field.offset.empty()) {
      const Value place =
          on_nodes ? Value{.component = {}, .node = entity, .value = 0} : Value{.component = {}, .cell = entity, .value = 0};
      collect_row(field, components, i, place, values);
    } else {
      const std::vector<Value> found = of_cell(field, components, i);
      values.insert(values.end(), found.begin(), found.end());
    }
  }
  return formula_ && field.offset.empty() && !values.empty() ? of_formula(values) : values;
}

std::vector<Observer::Value> Observer::look(const FieldMakers& fields) const {
  const std::string name = keywords_.text("NOM_CHAM");
  const auto maker = fields.find(name);
  if (maker == fields.end()) {
    std::vector<std::string> known;
    for (const auto& [field, make] : fields) known.push_back(field);
    fail("OBSERVATION_1",
         {{"keyword", keywords_.path("NOM_CHAM")}, {"field", name}, {"known", fmt::format("{}", fmt::join(known, ", "))}});
  }
  const Field field = maker->second().whole();
  check_place(field);
  std::vector<Value> values = collect(field);
  if (values.empty()) fail("OBSERVATION_4", {{"keyword", keywords_.path("NOM_CHAM")}, {"field", name}});
  const std::string how = keywords_.text("EVAL_CHAM");
  return how == "VALE" ? values : reduce_by_component(how, values, {.value = 0});
}

void Observer::add_rows(Table& table, const std::vector<Value>& values, std::int64_t number, double instant) const {
  const auto name_or_none = [](bool there, const std::string& name) { return there ? Table::Cell(name) : Table::Cell(); };
  const auto number_or_none = [](std::int32_t index) {
    return index < 0 ? Table::Cell() : Table::Cell(std::int64_t{index} + 1);
  };
  for (const Value& value : values) {
    const bool node = value.node >= 0;
    table.add({name_, name_or_none(node || value.cell >= 0, node ? "NOEUD" : "MAILLE"), std::int64_t{0}, number, instant,
               keywords_.text("NOM_CHAM"), keywords_.text("EVAL_CHAM"), name_or_none(!value.component.empty(), value.component),
               Table::Cell(), keywords_.text("EVAL_CMP"), name_or_none(node, node_name(value.node)),
               name_or_none(value.cell >= 0, cell_name(value.cell)),
               name_or_none(keywords_.has("POINT") || keywords_.text("EVAL_ELGA") != "VALE", keywords_.text("EVAL_ELGA")),
               number_or_none(value.point), Table::Cell(), value.value, number_or_none(value.node)});
  }
}

void Observer::print(std::ostream& out, const std::vector<Value>& values) const {
  for (const Value& value : values) {
    std::string place = value.node >= 0 ? node_name(value.node) : value.cell >= 0 ? cell_name(value.cell) : "";
    if (value.point >= 0) place += " point " + std::to_string(value.point + 1);
    const std::string how = keywords_.text("EVAL_CHAM");
    out << fmt::format(" {:<16} {} {} {}{}{:.9g}\n", name_, keywords_.text("NOM_CHAM"),
                       value.component.empty() ? "FORMULE" : value.component, how == "VALE" ? "" : how + " ",
                       place.empty() ? "" : place + " ", value.value);
  }
  out.flush();
}

// ---------------------------------------------------------------------------------------------- all of them

Observations::Observations(const Keywords& keywords, const Base& base, const Mesh& mesh, FieldMakers fields)
    : fields_(std::move(fields)) {
  const auto named = [](const Keywords& occurrence, const std::string& otherwise) {
    const std::vector<std::string> title = occurrence.texts("TITRE");
    return title.empty() ? otherwise : fmt::format("{}", fmt::join(title, " "));
  };
  int number = 0;
  for (const Keywords& occurrence : keywords.factors("OBSERVATION"))
    watches_.push_back({Observer(occurrence, base, mesh, named(occurrence, fmt::format("OBSERVATION_{}", ++number))),
                        ChosenInstants(occurrence, base, "PAS_OBSE"), occurrence.yes("OBSE_ETAT_INIT")});
  number = 0;
  for (const Keywords& occurrence : keywords.factors("SUIVI_DDL"))
    watches_.push_back(
        {Observer(occurrence, base, mesh, named(occurrence, fmt::format("SUIVI_{}", ++number))), std::nullopt, true});
  if (keywords.has("OBSERVATION"))
    table_ = Table::of({{"NOM_OBSERVATION", "K16"},
                        {"TYPE_OBJET", "K16"},
                        {"NUME_REUSE", "I"},
                        {"NUME_OBSE", "I"},
                        {"INST", "R"},
                        {"NOM_CHAM", "K16"},
                        {"EVAL_CHAM", "K8"},
                        {"NOM_CMP", "K8"},
                        {"NOM_VARI", "K16"},
                        {"EVAL_CMP", "K8"},
                        {"NOEUD", "K8"},
                        {"MAILLE", "K8"},
                        {"EVAL_ELGA", "K8"},
                        {"POINT", "I"},
                        {"SOUS_POINT", "I"},
                        {"VALE", "R"},
                        {"NUME_GLOBAL_NOEUD", "I"}});
}

void Observations::record(Watch& watch, double instant) {
  const std::vector<Observer::Value> values = watch.observer.look(fields_);
  if (watch.instants)
    watch.observer.add_rows(*table_, values, watch.count++, instant);
  else
    watch.observer.print(std::cout, values);
}

void Observations::start(double instant) {
  for (Watch& watch : watches_) {
    if (watch.initial)
      record(watch, instant);
    else if (!watch.observer.has_formula())  // which need not have a value before any load
      watch.observer.look(fields_);
  }
}

void Observations::accept(const SolvedInstant& solved) {
  for (Watch& watch : watches_)
    if (!watch.instants || watch.instants->has(solved.instant, solved.step)) record(watch, solved.instant);
}

void Observations::save(const hdf5::Group& group) const {
  std::vector<std::int64_t> counts;
  for (const Watch& watch : watches_) counts.push_back(watch.count);
  group.write("count", counts);
  if (table_) write_table(group.create("table"), *table_);
}

void Observations::resume(const hdf5::Group& group) {
  const auto counts = group.read<std::int64_t>("count");
  for (std::size_t w = 0; w < watches_.size(); ++w) watches_[w].count = counts.at(w);
  if (table_) table_ = read_table(group.open("table"));
}

}  // namespace lacon
