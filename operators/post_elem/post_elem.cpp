#include "lacon/operators/post_elem/post_elem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/post_elem/energies.hpp"
#include "lacon/operators/post_elem/inertia.hpp"

namespace lacon {
namespace {

using Columns = std::vector<std::pair<std::string, std::string>>;

/// The fields that an occurrence means, one after the other, and the model whose elements integrate them.
class Subject {
 public:
  Subject(const Order& order, const Base& base, const Keywords& keywords) : base_(base), keywords_(keywords) {
    std::string model_id;
    if (keywords.has("RESULTAT")) {
      result_ = base.result(keywords.concept_id("RESULTAT"));
      model_id = result_->model;
      name_ = keywords.text("NOM_CHAM");
      for (const std::int64_t o : selected_orders(base, *result_, keywords))
        if (const auto files = result_->fields.find(name_);
            names_instants(keywords) || (files != result_->fields.end() && files->second.contains(o)))
          orders_.push_back(o);
      if (orders_.empty())
        base.field(*result_, name_, result_->orders.empty() ? 0 : result_->orders.back());  // says what there is
    } else {
      name_ = base.label(keywords.concept_id("CHAM_GD"));
      orders_.push_back(0);
    }
    if (const auto given = keywords.optional_concept("MODELE")) model_id = *given;
    if (model_id.empty()) fail("POSTELEM_1", {{"keyword", keywords.path("MODELE")}});
    model_ = base.model(model_id);
    mesh_ = base.mesh(model_.mesh);
    registry_ = std::make_unique<Registry>(order.plugins);
    points_.emplace(mesh_, model_, *registry_);
    ground_.emplace(mesh_, *points_);
  }

  const Keywords& keywords() const { return keywords_; }
  const Mesh& mesh() const { return mesh_; }
  const Ground& ground() const { return *ground_; }
  ModelPoints& points() { return *points_; }

  /// Head of the rows: which field it is.
  Columns columns() const {
    if (!result_) return {{"CHAM_GD", "K32"}};
    return {{"RESULTAT", "K32"}, {"NOM_CHAM", "K16"}, {"NUME_ORDRE", "I"}, {"INST", "R"}};
  }
  void each_field(const std::function<void(const Field&, std::vector<Table::Cell>)>& use) const {
    for (const std::int64_t o : orders_) {
      const Field field = result_ ? base_.field(*result_, name_, o) : base_.field(keywords_.concept_id("CHAM_GD"));
      check_same_mesh(base_, model_.mesh, field.mesh);
      if (field.quantity.ends_with("_F")) fail("CREACHAMP_12", {{"field", name_}, {"keyword", keywords_.path("CHAM_GD")}});
      if (result_)
        use(field, {result_->label, name_, o, field.instant});
      else
        use(field, {name_});
    }
  }

  /// The components that NOM_CMP names, or all.
  Field named_components(const Field& field) const {
    if (!keywords_.has("NOM_CMP")) return field;
    for (const std::string& component : keywords_.texts("NOM_CMP"))
      if (field.component(component) < 0)
        fail("CREACHAMP_14", {{"keyword", keywords_.path("NOM_CMP")},
                              {"component", component},
                              {"field", name_},
                              {"known", fmt::format("{}", fmt::join(field.components, ", "))}});
    return restrict_to_components(field, keywords_.texts("NOM_CMP"));
  }
  /// At integration points, whatever it was.
  Field at_points(const Field& field) const {
    return moved_to(*ground_, field, {"", Location::gauss_points, field.quantity}, false);
  }

  /// "TOUT" with the body cells, or each group with its cells.
  std::vector<std::pair<std::string, std::vector<char>>> places() const {
    std::vector<std::pair<std::string, std::vector<char>>> found;
    if (!keywords_.has("GROUP_MA")) {
      found.emplace_back("TOUT", std::vector<char>(mesh_.n_cells()));
      const bool any = keywords_.has("TYPE_MAILLE");  // of which integrated() takes some
      for (std::size_t c = 0; c < mesh_.n_cells(); ++c)
        found.back().second[c] = any ? points_->element(c) != nullptr : points_->is_solid(c);
    }
    for (const std::string& group : keywords_.texts("GROUP_MA")) {
      found.emplace_back(group, std::vector<char>(mesh_.n_cells()));
      for (const std::int32_t cell : cells_of_group(mesh_, group, keywords_.path("GROUP_MA")))
        found.back().second[static_cast<std::size_t>(cell)] = 1;
    }
    return found;
  }

  /// Of the marked cells that have a field those that it is integrated over: of the dimension TYPE_MAILLE, otherwise of the
  /// highest one, for lengths do not add up to areas. POSTELEM_6 tells what that leaves out.
  std::vector<char> integrated(const Field& field, const std::string& place, const std::vector<char>& cells) {
    const auto dimension = [&](std::int32_t cell) { return mesh_.row(static_cast<std::size_t>(cell)).dimension; };
    int wanted = 0;
    for (const std::int32_t cell : field.support)
      if (cells[static_cast<std::size_t>(cell)]) wanted = std::max(wanted, dimension(cell));
    const bool asked = keywords_.has("TYPE_MAILLE");
    if (asked) wanted = keywords_.text("TYPE_MAILLE").front() - '0';
    std::vector<char> taken(cells.size(), 0);
    std::int64_t left = 0;
    for (const std::int32_t cell : field.support)
      if (const auto c = static_cast<std::size_t>(cell); cells[c]) {
        taken[c] = dimension(cell) == wanted;
        left += !taken[c];
      }
    if (left > 0 && !asked && told_.insert(place).second)
      inform("POSTELEM_6", {{"keyword", keywords_.path("")}, {"place", place}, {"count", std::to_string(left)}});
    return taken;
  }

  /// Whether the values of a field are integrals over its cells already, which add up. Throws POSTELEM_7, POSTELEM_8.
  bool is_integrated(const Field& field) const {
    const bool of_cells = field.location == Location::cells, said = keywords_.has("DEJA_INTEGRE"),
               adds_up = said && keywords_.text("DEJA_INTEGRE") == "OUI",
               known = name_ == "ENEL_ELEM" || name_ == "ETOT_ELEM";  // of CHAM_GD, means of cells too have this quantity
    const auto refuse = [&](const char* id) { fail(id, {{"keyword", keywords_.path("DEJA_INTEGRE")}, {"field", name_}}); };
    if (of_cells && field.quantity == "ENER_R" && (known ? !adds_up : !said)) refuse("POSTELEM_7");
    if (adds_up && (!of_cells || field.quantity == "CLAC_R")) refuse("POSTELEM_8");
    return adds_up;
  }

  /// Whether a component is one value for each patch, which some of its nodes keep: it has no values in cells. Throws
  /// POSTELEM_9 where it is named.
  bool is_of_patches(const Field& field, const std::string& component) const {
    if (field.location != Location::nodes || component != "LAGS_C") return false;
    if (keywords_.has("NOM_CMP")) fail("POSTELEM_9", {{"keyword", keywords_.path("NOM_CMP")}, {"field", name_}});
    return true;
  }

  /// Of the marked cells those with an element, of the dimension of the taken ones, where no node has a value.
  std::vector<std::int32_t> left_out(const std::vector<char>& marked, const std::vector<char>& taken) const {
    const auto one = std::ranges::find(taken, 1) - taken.begin();
    std::vector<std::int32_t> cells;
    for (std::size_t c = 0; c < marked.size() && one < std::ssize(taken); ++c)
      if (marked[c] && !taken[c] && points_->element(c) &&
          mesh_.row(c).dimension == mesh_.row(static_cast<std::size_t>(one)).dimension)
        cells.push_back(static_cast<std::int32_t>(c));
    return cells;
  }

  /// POSTELEM_10: nodes of some cells lack a component.
  void tell_missing(const std::string& place, const std::string& component, std::int64_t missing, std::int64_t count,
                    std::int32_t first) const {
    inform("POSTELEM_10", {{"keyword", keywords_.path("")},
                           {"place", place},
                           {"component", component},
                           {"field", name_},
                           {"missing", std::to_string(missing)},
                           {"count", std::to_string(count)},
                           {"cell", cell_name(first)}});
  }

  [[noreturn]] void refuse_place(const std::string& place) const {
    fail("POSTELEM_2", {{"keyword", keywords_.path("GROUP_MA")}, {"place", place}, {"field", name_}});
  }

 private:
  const Base& base_;
  const Keywords& keywords_;
  std::optional<Result> result_;
  std::string name_;
  std::vector<std::int64_t> orders_;
  Model model_;
  Mesh mesh_;
  std::unique_ptr<Registry> registry_;
  std::optional<ModelPoints> points_;
  std::optional<Ground> ground_;
  std::set<std::string> told_;  ///< places of POSTELEM_6
};

/// Call use(cell, its first row, its points) for the marked cells of a field at integration points. @return how many that is
std::size_t each_cell(Subject& subject, const Field& field, const std::vector<char>& cells,
                      const std::function<void(std::int32_t, std::size_t, const CellPoints&)>& use) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < field.support.size(); ++i) {
    const auto cell = static_cast<std::size_t>(field.support[i]);
    if (!cells[cell]) continue;
    ++count;
    use(field.support[i], field.first_row(i), subject.points()(cell, subject.mesh().coordinates));
  }
  return count;
}

/// Call use(row of the field, measure) at every integration point of the marked cells. @return how many cells that is
std::size_t each_point(Subject& subject, const Field& field, const std::vector<char>& cells,
                       const std::function<void(std::size_t, double)>& use) {
  return each_cell(subject, field, cells, [&](std::int32_t, std::size_t first, const CellPoints& at) {
    for (std::size_t p = 0; p < at.measure.size(); ++p) use(first + p, at.measure[p]);
  });
}

Columns joined(Columns first, const Columns& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

void add_row(Table& table, std::vector<Table::Cell> head, const std::vector<Table::Cell>& values) {
  head.insert(head.end(), values.begin(), values.end());
  table.add(std::move(head));
}

/// The factor of each component's square.
std::vector<double> norm_factors(const Subject& subject, const Field& field) {
  const Keywords& keywords = subject.keywords();
  if (keywords.has("COEF_MULT")) {
    const std::vector<double> factors = keywords.reals("COEF_MULT");
    if (factors.size() != field.n_components())
      fail("CREACHAMP_11", {{"keyword", keywords.path("COEF_MULT")},
                            {"found", std::to_string(factors.size())},
                            {"wanted", std::to_string(field.n_components())}});
    return factors;
  }
  std::vector<double> factors(field.n_components(), 1.0);
  if (keywords.text("TYPE_NORM") == "FROBENIUS")
    for (std::size_t c = 0; c < factors.size(); ++c)
      if (const std::string& name = field.components[c]; name.ends_with("XY") || name.ends_with("XZ") || name.ends_with("YZ"))
        factors[c] = 2.0;
  return factors;
}

Table norms(Subject& subject) {
  Table table = Table::of(joined(subject.columns(), {{"GROUP", "K32"}, {"TYPE_NORM", "K16"}, {"VALE_NORM", "R"}}));
  const auto places = subject.places();
  std::vector<char> cells(subject.mesh().n_cells(), 0);
  for (const auto& [name, marked] : places)
    for (std::size_t c = 0; c < cells.size(); ++c) cells[c] = cells[c] || marked[c];
  const std::string group = places.size() == 1 ? places.front().first : "UNION_GROUP_MA";
  subject.each_field([&](const Field& whole, const std::vector<Table::Cell>& head) {
    const Field field = subject.at_points(subject.named_components(whole));
    std::vector<double> factors = norm_factors(subject, field);
    for (std::size_t c = 0; c < factors.size(); ++c)
      if (subject.is_of_patches(whole, field.components[c])) factors[c] = 0;
    double sum = 0;
    const std::vector<char> taken = subject.integrated(field, group, cells);
    const std::size_t count = each_point(subject, field, taken, [&](std::size_t row, double measure) {
      for (std::size_t c = 0; c < factors.size(); ++c)
        if (field.counts(row, c)) sum += measure * factors[c] * field.at(row, c) * field.at(row, c);
    });
    if (count == 0) subject.refuse_place(group);
    add_row(table, head, {group, subject.keywords().text("TYPE_NORM"), std::sqrt(sum)});
  });
  return table;
}

/// What the cells of a group give for a component.
struct ComponentSum {
  double value = 0, over = 0;  ///< over: the measure of where it has values
  std::int64_t missing = 0;    ///< cells that do not have it throughout
  std::int32_t first_missing = -1;
};

Table integrals(Subject& subject) {
  std::optional<Table> table;
  subject.each_field([&](const Field& whole, const std::vector<Table::Cell>& head) {
    const Field field = subject.at_points(subject.named_components(whole));
    if (!table) {
      Columns columns = joined(subject.columns(), {{"GROUP_MA", "K32"}, {"VOL", "R"}});
      for (const char* prefix : {"INTE_", "MOYE_"})
        for (const std::string& component : field.components) columns.emplace_back(prefix + component, "R");
      table = Table::of(columns);
    }
    const bool adds_up = subject.is_integrated(whole), of_nodes = whole.location == Location::nodes;
    std::vector<char> of_patches;
    for (const std::string& component : field.components) of_patches.push_back(subject.is_of_patches(whole, component));
    for (const auto& [group, marked] : subject.places()) {
      const std::vector<char> cells = subject.integrated(field, group, marked);
      double volume = 0;
      std::vector<ComponentSum> sums(field.n_components());
      const auto add = [&](std::int32_t cell, std::size_t first, const CellPoints& at) {
        for (const double measure : at.measure) volume += measure;
        for (std::size_t c = 0; c < sums.size(); ++c) {
          bool is_whole = true;
          for (std::size_t p = 0; p < at.measure.size(); ++p) {
            if (!field.counts(first + p, c)) {
              is_whole = false;
              continue;
            }
            sums[c].over += at.measure[p];
            if (!adds_up) sums[c].value += at.measure[p] * field.at(first + p, c);
          }
          if (adds_up && field.counts(first, c)) sums[c].value += field.at(first, c);  // the same at all points
          if (!is_whole && sums[c].missing++ == 0) sums[c].first_missing = cell;
        }
      };
      const std::size_t count = each_cell(subject, field, cells, add);
      if (count == 0) subject.refuse_place(group);
      const std::vector<std::int32_t> left = of_nodes ? subject.left_out(marked, cells) : std::vector<std::int32_t>();
      // VOL is what integrals are over; where components differ in that, all of the place
      std::vector<double> over;
      for (std::size_t c = 0; c < sums.size(); ++c)
        if (!of_patches[c]) over.push_back(sums[c].over);
      const bool alike = !over.empty() && std::ranges::all_of(over, [&](double one) { return one == over.front(); });
      std::vector<Table::Cell> values{group, alike ? over.front() : volume};
      for (std::size_t c = 0; c < sums.size(); ++c)
        values.push_back(of_patches[c] ? Table::Cell() : Table::Cell(sums[c].value));
      for (std::size_t c = 0; c < sums.size(); ++c) {
        const bool has_mean = sums[c].over > 0 && !of_patches[c];
        values.push_back(has_mean ? Table::Cell(sums[c].value / sums[c].over) : Table::Cell());
        const std::int64_t missing = sums[c].missing + std::ssize(left);
        if (of_nodes && missing > 0 && !of_patches[c] && (has_mean || subject.keywords().has("NOM_CMP")))
          subject.tell_missing(group, field.components[c], missing, static_cast<std::int64_t>(count) + std::ssize(left),
                               sums[c].missing > 0 ? sums[c].first_missing : left.front());
      }
      add_row(*table, head, values);
    }
  });
  return *table;
}

Table extremes(Subject& subject) {
  std::optional<Table> table;
  subject.each_field([&](const Field& whole, const std::vector<Table::Cell>& head) {
    const Field field = subject.named_components(whole);
    const bool nodal = field.location == Location::nodes;
    if (!table) {
      Columns columns = joined(subject.columns(), {{"GROUP_MA", "K32"}});
      for (const char* which : {"MIN", "MAX"})
        for (const std::string& component : field.components) {
          columns.emplace_back(fmt::format("{}_{}", which, component), "R");
          columns.emplace_back(fmt::format("{}_{}_{}", nodal ? "NO" : "MA", which, component), "K16");
        }
      table = Table::of(columns);
    }
    for (const auto& [group, cells] : subject.places()) {
      const std::vector<char> wanted = nodal ? nodes_of_marked_cells(subject.mesh(), cells) : cells;
      std::vector<Table::Cell> values{group};
      for (const bool greatest : {false, true})
        for (std::size_t c = 0; c < field.n_components(); ++c) {
          const std::optional<Extreme> best = find_extreme(
              field, c, greatest, [&](std::size_t i) { return wanted[static_cast<std::size_t>(field.support[i])] != 0; });
          if (!best) subject.refuse_place(group);
          values.emplace_back(best->value);
          values.emplace_back(nodal ? node_name(field.support[best->place]) : cell_name(field.support[best->place]));
        }
      add_row(*table, head, values);
    }
  });
  return *table;
}

}  // namespace

void post_elem(const Order& order, const Base& base) {
  for (const char* const keyword : {"ENER_ELAS", "ENER_POT"})
    if (order.keywords.has(keyword)) return base.store(energies(order, base, keyword));
  if (order.keywords.has("TRAV_EXT")) return base.store(external_work(order, base));
  if (order.keywords.has("MASS_INER")) return base.store(inertia(order, base));
  static const std::vector<std::pair<const char*, Table (*)(Subject&)>> kinds{
      {"NORME", norms}, {"INTEGRALE", integrals}, {"MINMAX", extremes}};
  std::optional<Table> table;
  for (const auto& [keyword, make] : kinds)
    for (const Keywords& one : order.keywords.factors(keyword)) {
      Subject subject(order, base, one);
      Table part = make(subject);
      if (!table) {
        table = std::move(part);
        continue;
      }
      for (std::size_t c = 0; c < table->columns.size(); ++c)
        if (part.columns.size() != table->columns.size() || part.columns[c].name != table->columns[c].name)
          fail("POSTELEM_3", {{"keyword", one.path("")}});
      for (std::size_t row = 0; row < part.n_rows(); ++row) {
        std::vector<Table::Cell> cells;
        for (const Table::Column& column : part.columns) cells.push_back(column.cells[row]);
        table->add(std::move(cells));
      }
    }
  base.store(*table);
}

}  // namespace lacon
