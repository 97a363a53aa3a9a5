#include "lacon/operators/macr_lign_coupe/macr_lign_coupe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "lacon/catalog/messages.hpp"
#include "lacon/operators/fields/axes.hpp"
#include "lacon/operators/fields/expected.hpp"
#include "lacon/operators/fields/extrapolation.hpp"
#include "lacon/operators/fields/layout.hpp"
#include "lacon/operators/fields/moved_places.hpp"
#include "lacon/operators/fields/selection.hpp"
#include "lacon/operators/fields/tensor.hpp"
#include "lacon/operators/macr_lign_coupe/lines.hpp"
#include "lacon/operators/macr_lign_coupe/sums.hpp"
#include "lacon/structures/vector.hpp"

namespace lacon {
namespace {

struct Named {
  std::string name, type;
  Table::Cell cell;
};
using Row = std::vector<Named>;

/// Add a row to a table; a column that it has not yet is missing in the rows before.
void add_row(Table& table, const Row& row) {
  const std::size_t n = table.n_rows();
  for (Table::Column& column : table.columns) column.cells.emplace_back();
  for (const Named& one : row) {
    auto column = std::find_if(table.columns.begin(), table.columns.end(), [&](const auto& c) { return c.name == one.name; });
    if (column == table.columns.end())
      column = table.columns.insert(column, {one.name, one.type, std::vector<Table::Cell>(n + 1)});
    column->cells.back() = one.cell;
  }
}

/// Looks at moved points; nullptr where there is no result.
using Moved = std::optional<MovedPlaces>;

/// The fields that the order means.
struct Subject {
  std::optional<Result> result;
  std::string name, mesh;
  std::vector<std::int64_t> orders{0};
};

Subject subject_of(const Base& base, const Keywords& keywords) {
  Subject subject;
  if (!keywords.has("RESULTAT")) {
    subject.name = base.label(keywords.concept_id("CHAM_GD"));
    subject.mesh = base.field(keywords.concept_id("CHAM_GD")).mesh;
    return subject;
  }
  subject.result = base.result(keywords.concept_id("RESULTAT"));
  subject.mesh = subject.result->mesh;
  subject.name = keywords.text("NOM_CHAM");
  subject.orders.clear();
  const auto files = subject.result->fields.find(subject.name);
  for (const std::int64_t o : selected_orders(base, *subject.result, keywords))
    if (names_instants(keywords) || (files != subject.result->fields.end() && files->second.contains(o)))
      subject.orders.push_back(o);
  if (subject.orders.empty())
    base.field(*subject.result, subject.name, subject.result->orders.empty() ? 0 : subject.result->orders.back());  // says why
  return subject;
}

/// A sum or product of unit vectors that is shorter has no direction.
constexpr double least_direction = 1e-6;

/// REPERE='LOCAL' at each point: X along the line, at a corner the mean of both directions; Y towards VECT_Y, without it in the
/// plane to the left of X. Throws LIGNCOUPE_10.
std::vector<Eigen::Matrix3d> local_axes(const Mesh& mesh, const Keywords& line, const std::vector<LinePoint>& points) {
  const auto refuse = [&] { fail("LIGNCOUPE_10", {{"keyword", line.path("VECT_Y")}}); };
  const auto unit = [&](const Eigen::Vector3d& vector) -> Eigen::Vector3d {
    if (!(vector.norm() > least_direction)) refuse();
    return vector.normalized();
  };
  const auto piece = [&](std::size_t i) {
    using Place = Eigen::Map<const Eigen::Vector3d>;
    const Eigen::Vector3d step = Place(points[i + 1].position.data()) - Place(points[i].position.data());
    if (step.isZero(0)) refuse();
    return Eigen::Vector3d(step.normalized());
  };
  const std::size_t last = points.size() - 1;
  if (last == 0) refuse();
  std::vector<Eigen::Vector3d> along;
  for (std::size_t i = 0; i <= last; ++i)
    along.push_back(unit((i > 0 ? piece(i - 1) : piece(0)) + (i < last ? piece(i) : piece(last - 1))));
  if (line.text("TYPE") == "ARC" && last > 1) {  // the tangents at both ends of a chord of a circle are images of each other
    const auto image = [](const Eigen::Vector3d& tangent, const Eigen::Vector3d& chord) -> Eigen::Vector3d {
      return 2 * tangent.dot(chord) * chord - tangent;
    };
    along[0] = image(along[1], piece(0));
    along[last] = image(along[last - 1], piece(last - 1));
  }
  Eigen::Vector3d towards = Eigen::Vector3d::Zero();
  if (line.has("VECT_Y")) {
    const std::vector<double> given = line.reals("VECT_Y");
    std::copy(given.begin(), given.end(), towards.data());
    towards = unit(towards);
  } else if (mesh.dimension == 3) {
    refuse();
  }
  std::vector<Eigen::Matrix3d> axes;
  for (const Eigen::Vector3d& x : along) {
    const Eigen::Vector3d z = line.has("VECT_Y") ? unit(x.cross(towards)) : Eigen::Vector3d::UnitZ();
    axes.emplace_back();
    axes.back() << x.transpose(), z.cross(x).transpose(), z.transpose();
  }
  return axes;
}

/// The field at the points of a line: a row of nodes stands for them.
Field at_points(const Mesh& mesh, const Field& field, const std::vector<LinePoint>& points) {
  Field made = field;
  made.support.clear();
  made.values.clear();
  made.present.clear();
  const std::vector<std::int64_t> row_of_node = places(field, mesh.n_nodes());
  for (std::size_t i = 0; i < points.size(); ++i) {
    made.support.push_back(static_cast<std::int32_t>(i));
    for (std::size_t c = 0; c < field.n_components(); ++c) {
      const auto [value, presence] = value_at(field, row_of_node, points[i].nodes, points[i].weights, c);
      made.values.push_back(value);
      made.present.push_back(presence);
    }
  }
  return made;
}

/// What REPERE makes of a field at the points of a line.
void turn_axes(const Mesh& mesh, const Keywords& line, const std::vector<LinePoint>& points, Moved& moved, Field& made) {
  const bool local = line.text("REPERE") == "LOCAL", polar = line.text("REPERE") == "POLAIRE";
  const std::vector<Eigen::Matrix3d> along = local ? local_axes(mesh, line, points) : std::vector<Eigen::Matrix3d>();
  std::optional<Frame> frame;
  nlohmann::json given = line.values();
  if (polar) given["AXE_Z"] = {0.0, 0.0, 1.0};
  if (!local) frame.emplace(mesh, Keywords(given, line.path("")), polar || line.text("REPERE") == "CYLINDRIQUE");
  const std::vector<Turned> parts = turned_components(made);
  if (moved && frame && frame->depends_on_place() && !parts.empty())
    if (const std::vector<double>& now = moved->at(made.order); !now.empty())
      moved->look_at_axes(line.path("REPERE"), made.instant, *frame, positions(points), positions_now(points, now));
  std::size_t lost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Matrix3d axes = local ? along[i] : frame->at(Eigen::Map<const Eigen::Vector3d>(points[i].position.data()), lost);
    if (polar && mesh.dimension == 3) axes.row(1).swap(axes.row(2));  // the tangential direction is the second one
    for (const Turned& part : parts) {
      const auto lacks = [&](int c) { return c >= 0 && !made.has(i, static_cast<std::size_t>(c)); };
      if (std::ranges::none_of(part.column, lacks)) {
        turn(made, i, part, axes);
        continue;
      }
      for (const int c : part.column)  // a vector that is not whole has no components in other axes
        if (c >= 0) made.present[i * made.n_components() + static_cast<std::size_t>(c)] = 0;
    }
  }
  if (lost) inform("MODIREPERE_4", {{"count", std::to_string(lost)}});
}

/// Unit vectors at the points: DIRECTION, or for TRAC_NOR the normal of the line, in the axes of the components.
std::vector<Eigen::Vector3d> directions(const Mesh& mesh, const Keywords& line, const std::vector<LinePoint>& points) {
  Eigen::Vector3d one = Eigen::Vector3d::UnitY();  // of REPERE='LOCAL'
  if (line.has("TRAC_DIR")) {
    const std::vector<double> given = line.reals("DIRECTION");
    one.setZero();
    std::copy(given.begin(), given.end(), one.data());
    if (one.isZero(0)) fail("LIGNCOUPE_11", {{"keyword", line.path("DIRECTION")}});
    one.normalize();
  }
  std::vector<Eigen::Vector3d> found(points.size(), one);
  if (line.has("TRAC_NOR") && line.text("REPERE") == "GLOBAL") {
    const std::vector<Eigen::Matrix3d> axes = local_axes(mesh, line, points);
    for (std::size_t i = 0; i < points.size(); ++i) found[i] = axes[i].row(1).transpose();
  }
  return found;
}

/// What is made of vectors or tensors at points.
struct Derived {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;  ///< one for each point, empty where the vector or tensor is not whole
};

/// INVARIANT of a tensor: VMIS, TRESCA, TRACE, DETER.
std::vector<double> invariants_of(const Eigen::Matrix3d& tensor) {
  const Eigen::Matrix3d deviator = tensor - tensor.trace() / 3 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d principal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues();
  return {std::sqrt(1.5) * deviator.norm(), principal(2) - principal(0), tensor.trace(), tensor.determinant()};
}

/// ELEM_PRINCIPAUX of a tensor: PRIN_1 <= PRIN_2 <= PRIN_3 and their unit vectors, whose component of largest magnitude is
/// positive.
std::vector<double> principals_of(const Eigen::Matrix3d& tensor) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
  std::vector<double> made(solver.eigenvalues().data(), solver.eigenvalues().data() + 3);
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector3d axis = solver.eigenvectors().col(k);
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis(largest) < 0) axis = -axis;
    made.insert(made.end(), axis.data(), axis.data() + 3);
  }
  return made;
}

/// Names of what a keyword makes of a tensor, or of a vector.
std::vector<std::string> derived_names(std::string_view keyword, bool tensor) {
  if (keyword == "INVARIANT") return {"VMIS", "TRESCA", "TRACE", "DETER"};
  if (keyword == "ELEM_PRINCIPAUX")
    return {"PRIN_1",   "PRIN_2",   "PRIN_3",   "VECT_1_X", "VECT_1_Y", "VECT_1_Z",
            "VECT_2_X", "VECT_2_Y", "VECT_2_Z", "VECT_3_X", "VECT_3_Y", "VECT_3_Z"};
  if (!tensor) return {std::string(keyword)};
  const std::string kind(keyword.substr(5));
  return {"TR_" + kind + "_1", "TR_" + kind + "_2", "TR_" + kind + "_3"};
}

/// The keyword of a line that asks for something else than components, or nothing.
std::string_view derives(const Keywords& line) {
  for (const char* const keyword : {"INVARIANT", "ELEM_PRINCIPAUX", "TRAC_DIR", "TRAC_NOR"})
    if (line.has(keyword)) return keyword;
  return {};
}

/// INVARIANT and ELEM_PRINCIPAUX of the tensor among these components; TRAC_DIR, TRAC_NOR: T d of the tensor, or v . d of the
/// vector; nothing where there is none.
Derived derive(const Mesh& mesh, const Keywords& line, const std::vector<LinePoint>& points, const Field& field) {
  const std::string_view keyword = derives(line);
  const bool trace = keyword.starts_with("TRAC");
  const std::vector<Turned> parts = turned_components(field);
  auto part = std::ranges::find_if(parts, &Turned::tensor);
  if (part == parts.end() && trace) part = parts.begin();
  if (part == parts.end()) return {};
  Derived made{derived_names(keyword, part->tensor), {}};
  const std::vector<Eigen::Vector3d> along = trace ? directions(mesh, line, points) : std::vector<Eigen::Vector3d>();
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<double>& row = made.rows.emplace_back();
    const auto lacks = [&](int c) { return c >= 0 && !field.has(i, static_cast<std::size_t>(c)); };
    if (std::ranges::any_of(part->column, lacks)) continue;
    const auto value = [&](std::size_t k) {
      return part->column[k] < 0 ? 0.0 : field.at(i, static_cast<std::size_t>(part->column[k]));
    };
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    if (part->tensor)
      for (std::size_t k = 0; k < tensor_axes.size(); ++k)
        tensor(tensor_axes[k].i, tensor_axes[k].j) = tensor(tensor_axes[k].j, tensor_axes[k].i) = value(k);
    if (keyword == "INVARIANT") {
      row = invariants_of(tensor);
    } else if (keyword == "ELEM_PRINCIPAUX") {
      row = principals_of(tensor);
    } else if (part->tensor) {
      const Eigen::Vector3d product = tensor * along[i];
      row.assign(product.data(), product.data() + 3);
    } else {
      row.push_back(Eigen::Vector3d(value(0), value(1), value(2)).dot(along[i]));
    }
  }
  return made;
}

/// A field at the points of a line.
struct Values {
  std::vector<std::string> components;
  std::vector<std::vector<std::optional<double>>> at;  ///< (component, point)
  std::vector<std::vector<char>> marked;               ///< (component, point): a marker stands there; empty: nowhere
};

/// The field with these components alone.
Field with_components(const Field& field, const std::vector<std::string>& names) {
  Field made = field;
  made.components = names;
  made.values.clear();
  made.present.clear();
  for (std::size_t row = 0; row < field.n_rows(); ++row)
    for (const std::string& name : names) {
      const auto c = static_cast<std::size_t>(field.component(name));
      made.values.push_back(field.at(row, c));
      made.present.push_back(field.presence(row, c));
    }
  return made;
}

/// Stand-ins are no part of sums, but where nothing else is.
void leave_out_stand_ins(Field& field) {
  for (std::size_t c = 0; c < field.n_components(); ++c) {
    std::size_t counted = 0;
    for (std::size_t row = 0; row < field.n_rows(); ++row) counted += field.counts(row, c);
    for (std::size_t row = 0; row < field.n_rows() && counted > 0; ++row)
      if (!field.counts(row, c)) field.present[row * field.n_components() + c] = Field::absent;
  }
}

Values interpolate(const Mesh& mesh, const Keywords& line, const Field& field, const std::vector<LinePoint>& points,
                   const std::vector<std::string>& components, Moved& moved) {
  Field own = at_points(mesh, field, points);
  if (line.text("REPERE") != "GLOBAL") turn_axes(mesh, line, points, moved, own);
  own = with_components(own, components);
  if (line.has("RESULTANTE")) leave_out_stand_ins(own);
  Values values;
  if (const std::string_view keyword = derives(line); !keyword.empty()) {
    const Derived found = derive(mesh, line, points, own);
    if (found.names.empty())
      fail("LIGNCOUPE_12", {{"keyword", line.path(keyword)}, {"components", fmt::format("{}", fmt::join(components, ", "))}});
    values.components = found.names;
    for (std::size_t c = 0; c < found.names.size(); ++c) {
      std::vector<std::optional<double>>& column = values.at.emplace_back();
      for (const std::vector<double>& row : found.rows) column.push_back(row.empty() ? std::nullopt : std::optional(row[c]));
    }
    return values;
  }
  values.components = components;
  for (std::size_t c = 0; c < components.size(); ++c) {
    std::vector<std::optional<double>>& column = values.at.emplace_back();
    std::vector<char>& marked = values.marked.emplace_back();
    for (std::size_t i = 0; i < points.size(); ++i) {
      column.push_back(own.has(i, c) ? std::optional(own.at(i, c)) : std::nullopt);
      marked.push_back(own.presence(i, c) == Field::marker);
    }
  }
  return values;
}

void add_values(Table& table, const Row& head, const std::vector<LinePoint>& points, const Values& values) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    Row row = head;
    row.push_back({"ABSC_CURV", "R", points[i].along});
    for (std::size_t d = 0; d < 3; ++d) row.push_back({fmt::format("COOR_{}", "XYZ"[d]), "R", points[i].position[d]});
    for (std::size_t c = 0; c < values.components.size(); ++c)
      row.push_back({values.components[c], "R", values.at[c][i] ? Table::Cell(*values.at[c][i]) : Table::Cell()});
    add_row(table, row);
  }
}

void add_means(Table& table, const Row& head, const std::vector<LinePoint>& points, const Values& values, const Keywords& line,
               const std::string& field) {
  if (points.back().along == 0) fail("LIGNCOUPE_6", {{"keyword", line.path("OPERATION")}});
  std::vector<std::array<std::optional<double>, 6>> columns;
  for (std::size_t c = 0; c < values.components.size(); ++c) {
    const std::vector<char> marked = values.marked.empty() ? std::vector<char>(points.size(), 0) : values.marked[c];
    const bool leaves_out = std::ranges::find(marked, 0) != marked.end();  // markers are looked at where nothing else is
    std::vector<std::optional<double>> f;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!values.at[c][i])
        fail("LIGNCOUPE_7", {{"keyword", line.path("OPERATION")},
                             {"component", values.components[c]},
                             {"field", field},
                             {"number", std::to_string(i + 1)}});
      f.push_back(leaves_out && marked[i] ? std::nullopt : values.at[c][i]);
    }
    columns.push_back(moments(points, f));
  }
  static constexpr std::array names{"MOMENT_0", "MOMENT_1", "MINIMUM", "MAXIMUM", "MOYE_INT", "MOYE_EXT"};
  for (std::size_t q = 0; q < names.size(); ++q) {
    Row row = head;
    row.push_back({"QUANTITE", "K16", names[q]});
    for (std::size_t c = 0; c < columns.size(); ++c)
      row.push_back({values.components[c], "R", columns[c][q] ? Table::Cell(*columns[c][q]) : Table::Cell()});
    add_row(table, row);
  }
}

/// RESULTANTE: the sums over the points under their names; with MOMENT under those of axes, with moments about POINT.
void add_resultant(Table& table, Row row, const std::vector<LinePoint>& points, const Values& values, const Keywords& line,
                   const Field& field, Moved& moved) {
  if (line.text("TYPE") == "SEGMENT" || line.text("TYPE") == "ARC")
    inform("LIGNCOUPE_13", {{"keyword", line.path("RESULTANTE")}, {"count", std::to_string(points.size())}});
  std::vector<double> origin = line.has("POINT") ? line.reals("POINT") : std::vector<double>();
  origin.resize(3, 0.0);
  const Resultant sum = resultant(positions(points), values.components, values.at, origin);
  if (moved && line.has("MOMENT"))
    if (const std::vector<double>& now = moved->at(field.order); !now.empty()) {
      const MovedPlaces::Places then = positions_now(points, now);
      moved->look_at_moment(line.path("MOMENT"), field.instant, origin, positions(points), then, sum.magnitude, sum.moment,
                            resultant(then, values.components, values.at, origin).moment);
    }
  for (std::size_t c = 0; c < values.components.size() && !line.has("MOMENT"); ++c)
    row.push_back({values.components[c], "R", sum.components[c]});
  for (std::size_t d = 0; d < 3 && line.has("MOMENT"); ++d)
    if (sum.along[d]) row.push_back({fmt::format("RESULT_{}", "XYZ"[d]), "R", sum.force[d]});
  for (std::size_t d = 0; d < 3 && line.has("MOMENT"); ++d)
    row.push_back({fmt::format("MOMENT_{}", "XYZ"[d]), "R", sum.moment[d]});
  add_row(table, row);
}

/// What the rows of a line are called: INTITULE, the group, or its number.
std::string title(const Keywords& line, std::size_t number) {
  for (const char* keyword : {"INTITULE", "GROUP_NO", "GROUP_MA"})
    if (line.has(keyword)) return line.text(keyword);
  return fmt::format("l.coupe{}", number);
}

/// The cells in which points are sought: those of VIS_A_VIS, or all.
std::vector<std::int32_t> searched_cells(const Mesh& mesh, const Keywords& keywords) {
  std::vector<std::int32_t> cells;
  for (const Keywords& facing : keywords.factors("VIS_A_VIS"))
    for (const std::string& group : facing.texts("GROUP_MA_1")) {
      const auto members = cells_of_group(mesh, group, facing.path("GROUP_MA_1"));
      cells.insert(cells.end(), members.begin(), members.end());
    }
  if (!keywords.has("VIS_A_VIS")) {
    cells.resize(mesh.n_cells());
    std::iota(cells.begin(), cells.end(), 0);
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// The components of RESULTANTE, or of NOM_CMP, of the line or of all lines; without them all.
std::vector<std::string> wanted_components(const Field& field, const std::string& name, const Keywords& keywords,
                                           const Keywords& line) {
  const bool whole = line.has("INVARIANT") || line.has("ELEM_PRINCIPAUX");  // they are those of the whole tensor
  const std::pair<const Keywords*, const char*> choices[] = {{&line, "RESULTANTE"}, {&line, "NOM_CMP"}, {&keywords, "NOM_CMP"}};
  for (const auto& [given, keyword] : choices) {
    if (whole || !given->has(keyword)) continue;
    for (const std::string& component : given->texts(keyword))
      if (field.component(component) < 0)
        fail("CREACHAMP_14", {{"keyword", given->path(keyword)},
                              {"component", component},
                              {"field", name},
                              {"known", fmt::format("{}", fmt::join(field.components, ", "))}});
    return given->texts(keyword);
  }
  return field.components;
}

}  // namespace

void macr_lign_coupe(const Order& order, const Base& base) {
  const Keywords& keywords = order.keywords;
  const Subject subject = subject_of(base, keywords);
  check_own_mesh(base, subject.mesh, keywords, "", "MODELE");
  const Mesh mesh = base.mesh(subject.mesh);
  const CellLocator locator(mesh, searched_cells(mesh, keywords));
  Table table;
  Moved moved;
  if (subject.result) moved.emplace(base, *subject.result, mesh);
  std::size_t number = 0;
  for (const Keywords& line : keywords.factors("LIGN_COUPE")) {
    check_own_mesh(base, subject.mesh, line, "MAILLAGE", "");
    const std::vector<LinePoint> points = line_points(mesh, locator, line);
    const Row name{{"INTITULE", "K24", title(line, ++number)}};
    if (line.text("OPERATION") == "MOYENNE") tell_of_turns(points, line);
    for (const std::int64_t o : subject.orders) {
      Field field = subject.result ? base.field(*subject.result, subject.name, o) : base.field(keywords.concept_id("CHAM_GD"));
      if (field.location == Location::gauss_points)
        fail("LIGNCOUPE_5", {{"field", subject.name}, {"location", std::string(location_name(field.location))}});
      const std::string keyword = subject.result ? "NOM_CHAM" : "CHAM_GD";
      if (field.quantity.ends_with("_F")) fail("CREACHAMP_12", {{"field", subject.name}, {"keyword", keyword}});
      if (field.location != Location::nodes) field = cell_nodes_to_nodes(mesh, field, field.name);
      Row head = name;
      if (subject.result)
        head.insert(head.end(), {{"RESU", "K8", subject.result->label},
                                 {"NOM_CHAM", "K16", subject.name},
                                 {"NUME_ORDRE", "I", o},
                                 {"INST", "R", field.instant}});
      else
        head.push_back({"CHAM_GD", "K8", subject.name});
      const Values values =
          interpolate(mesh, line, field, points, wanted_components(field, subject.name, keywords, line), moved);
      if (std::ranges::none_of(
              values.at, [](const auto& c) { return std::ranges::any_of(c, [](const auto& v) { return v.has_value(); }); }))
        fail("LIGNCOUPE_9", {{"keyword", line.path("TYPE")},
                             {"field", subject.name},
                             {"components", fmt::format("{}", fmt::join(values.components, ", "))}});
      if (line.has("RESULTANTE"))
        add_resultant(table, head, points, values, line, field, moved);
      else if (line.text("OPERATION") == "MOYENNE")
        add_means(table, head, points, values, line, subject.name);
      else
        add_values(table, head, points, values);
    }
  }
  if (moved) moved->tell();
  base.store(table);
}

}  // namespace lacon
